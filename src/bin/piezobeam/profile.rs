//! Profiles of a scene file as profiles of the library.

use crate::scene_file::ProfileSpec;
use piezobeam::{Cubic, Error, Flat, Profile, Real, Smooth};

/// A profile of a scene file. With `FLAT` it is known to be constant between its breaks, so that an element
/// keeps one number of it instead of four.
#[derive(Clone, Debug)]
pub struct Shape<T, const FLAT: bool> {
    spec: ProfileSpec,
    breaks: Vec<T>,
}

impl<T: Real, const FLAT: bool> Shape<T, FLAT> {
    pub fn new(spec: &ProfileSpec) -> Self {
        Self { spec: spec.clone(), breaks: spec.breaks().iter().map(|&b| T::of(b)).collect() }
    }

    /// What is absent from the file but has to be there for the rest of it.
    pub fn or_zero(spec: Option<&ProfileSpec>) -> Self {
        Self::new(spec.unwrap_or(&ProfileSpec::Number(0.0)))
    }
}

macro_rules! profile {
    ($flat:literal, $piece:ident) => {
        impl<T: Real> Profile<T> for Shape<T, $flat> {
            type Piece = $piece<T>;
            type Slot = Flat<T>;
            fn value(&self, x: T, mid: T) -> T {
                T::of(self.spec.value(x.f64(), mid.f64()))
            }
            fn breaks(&self) -> &[T] {
                &self.breaks
            }
            // Lengths and breaks were checked when the file was read.
            fn validate(&self, _: &'static str, _: T) -> Result<(), Error> {
                Ok(())
            }
        }
        impl<T: Real> Smooth<T> for Shape<T, $flat> {
            fn jet(&self, x: T, mid: T) -> [T; 3] {
                self.spec.jet(x.f64(), mid.f64()).map(T::of)
            }
        }
    };
}

profile!(true, Flat);
profile!(false, Cubic);
