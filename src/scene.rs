//! The model as types: beam, foundation, conduction, loads, end potentials.
//!
//! A [`Scene`] is put together from parts; what a scene lacks is the part `()`, which costs no byte and no
//! instruction. Parts hold [profiles](crate::profile); nothing is checked here:
//! [`Problem::new`](crate::Problem::new) checks the whole.

use crate::error::{Error, Place, expect};
use crate::law::Compliance;
use crate::profile::{Profile, Smooth};
use crate::real::Real;

/// The beam's coefficients (the paper's C, C with a bar, P and eps).
#[derive(Clone, Copy, Debug)]
pub struct Beam<C, A = (), P = (), E = ()> {
    /// Bending stiffness C = EI > 0 \[N m^2\].
    pub bending: C,
    /// Axial stiffness EA > 0 \[N\]; `()`: no stretching.
    pub axial: A,
    /// Piezoelectric coefficient P \[N m/V\]; `()`: stretching and potential do not see each other.
    pub piezo: P,
    /// Electric permittivity eps > 0 \[N m^2/V^2\]; `()`: no potential.
    pub permittivity: E,
}

/// What the beam may touch.
#[derive(Clone, Copy, Debug)]
pub struct Foundation<W, G = ()> {
    /// Normal compliance p(x, r).
    pub law: W,
    /// Initial gap s \[m\], with two derivatives; `()`: zero. It may be negative (a preload) and need not
    /// vanish at the clamps, but must not jump.
    pub gap: G,
}

/// Conduction through the contact: mu1 R(q) R~(eta) on the beam, mu2 R~(eta)^2 into the potential.
#[derive(Clone, Copy, Debug)]
pub struct Conduction<T, U, V> {
    /// mu1 >= 0 \[N/(V m^2)\]; `()`: zero.
    pub mu1: U,
    /// mu2 >= 0 \[N/(V m^2)\]; `()`: zero.
    pub mu2: V,
    /// Truncation M > 0 of the penetration \[m\].
    pub truncation: T,
    /// Truncation of the potential \[V\]; the paper uses the same number M.
    pub potential_truncation: T,
}

impl<T: Real, U, V> Conduction<T, U, V> {
    /// Both truncations by the one number M, as in the paper.
    pub fn new(mu1: U, mu2: V, truncation: T) -> Self {
        Self { mu1, mu2, truncation, potential_truncation: truncation }
    }
}

/// Forces on the beam.
#[derive(Clone, Copy, Debug)]
pub struct Load<F, A = (), P = ()> {
    /// Transverse load per length \[N/m\], positive towards the foundation.
    pub transverse: F,
    /// Axial load per length \[N/m\].
    pub axial: A,
    /// Concentrated forces and moments: a list of [`PointLoad`]s, ascending in x.
    pub points: P,
}

/// A concentrated transverse force and moment; a node stands under it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointLoad<T> {
    /// Where, strictly inside (0, L) \[m\].
    pub x: T,
    /// Force, positive towards the foundation \[N\].
    pub force: T,
    /// Moment, positive where it turns the slope up \[N m\].
    pub moment: T,
}

/// Prescribed potentials at the ends \[V\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Potential<T> {
    /// At x = 0.
    pub left: T,
    /// At x = L.
    pub right: T,
}

/// A beam on [0, L], clamped at both ends, and what acts on it.
///
/// ```
/// use piezobeam::{Beam, Foundation, Linear, Load, Scene};
/// let scene = Scene::new(1.0_f64, Beam::elastic(5000.0))
///     .foundation(Foundation { law: Linear(1e8), gap: () })
///     .load(Load { transverse: 1e6, axial: (), points: () });
/// # let _ = scene;
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Scene<T, B, F = (), Q = (), L = (), V = ()> {
    /// Length L > 0 \[m\].
    pub length: T,
    /// The beam.
    pub beam: B,
    /// What it may touch.
    pub foundation: F,
    /// Conduction through the contact.
    pub conduction: Q,
    /// Forces.
    pub load: L,
    /// Potentials at the ends; `()`: both zero.
    pub potential: V,
}

impl<C> Beam<C> {
    /// A beam that only bends.
    pub fn elastic(bending: C) -> Self {
        Self { bending, axial: (), piezo: (), permittivity: () }
    }
}

impl<T, B> Scene<T, B> {
    /// A beam alone.
    pub fn new(length: T, beam: B) -> Self {
        Self { length, beam, foundation: (), conduction: (), load: (), potential: () }
    }
}

impl<T, B, F, Q, L, V> Scene<T, B, F, Q, L, V> {
    /// The same scene on this foundation.
    pub fn foundation<F2>(self, foundation: F2) -> Scene<T, B, F2, Q, L, V> {
        let Self { length, beam, conduction, load, potential, .. } = self;
        Scene { length, beam, foundation, conduction, load, potential }
    }

    /// The same scene with this conduction.
    pub fn conduction<Q2>(self, conduction: Q2) -> Scene<T, B, F, Q2, L, V> {
        let Self { length, beam, foundation, load, potential, .. } = self;
        Scene { length, beam, foundation, conduction, load, potential }
    }

    /// The same scene under this load.
    pub fn load<L2>(self, load: L2) -> Scene<T, B, F, Q, L2, V> {
        let Self { length, beam, foundation, conduction, potential, .. } = self;
        Scene { length, beam, foundation, conduction, load, potential }
    }

    /// The same scene between these potentials.
    pub fn potential<V2>(self, potential: V2) -> Scene<T, B, F, Q, L, V2> {
        let Self { length, beam, foundation, conduction, load, .. } = self;
        Scene { length, beam, foundation, conduction, load, potential }
    }
}

/// Concentrated loads: a slice, an array, or `()`.
pub trait Points<T> {
    /// The loads, ascending in x.
    fn list(&self) -> &[PointLoad<T>];
}

impl<T> Points<T> for () {
    fn list(&self) -> &[PointLoad<T>] {
        &[]
    }
}

impl<T> Points<T> for &[PointLoad<T>] {
    fn list(&self) -> &[PointLoad<T>] {
        self
    }
}

impl<T, const N: usize> Points<T> for [PointLoad<T>; N] {
    fn list(&self) -> &[PointLoad<T>] {
        self
    }
}

/// The parts of a scene, absent ones filled in by `()`: what the solver reads. Every [`Scene`] whose parts
/// fit together implements it.
pub trait Model<T: Real> {
    /// Profile of the bending stiffness.
    type Bending: Profile<T>;
    /// Profile of the axial stiffness.
    type Axial: Profile<T>;
    /// Profile of the piezoelectric coefficient.
    type Piezo: Profile<T>;
    /// Profile of the permittivity.
    type Permittivity: Profile<T>;
    /// Compliance law.
    type Law: Compliance<T>;
    /// Profile of the gap.
    type Gap: Smooth<T>;
    /// Profile of mu1.
    type Mu1: Profile<T>;
    /// Profile of mu2.
    type Mu2: Profile<T>;
    /// Profile of the transverse load.
    type Transverse: Profile<T>;
    /// Profile of the axial load.
    type AxialLoad: Profile<T>;

    /// Length \[m\].
    fn length(&self) -> T;
    /// Coefficients of the beam.
    fn beam(&self) -> Beam<&Self::Bending, &Self::Axial, &Self::Piezo, &Self::Permittivity>;
    /// Law and gap.
    fn foundation(&self) -> Foundation<&Self::Law, &Self::Gap>;
    /// Conduction coefficients and truncations.
    fn conduction(&self) -> Conduction<T, &Self::Mu1, &Self::Mu2>;
    /// Forces.
    fn load(&self) -> Load<&Self::Transverse, &Self::AxialLoad, &[PointLoad<T>]>;
    /// End potentials.
    fn potential(&self) -> Potential<T>;
}

/// A part that may be a beam.
pub trait BeamPart<T: Real> {
    /// Profile of the bending stiffness.
    type Bending: Profile<T>;
    /// Profile of the axial stiffness.
    type Axial: Profile<T>;
    /// Profile of the piezoelectric coefficient.
    type Piezo: Profile<T>;
    /// Profile of the permittivity.
    type Permittivity: Profile<T>;
    /// The coefficients.
    fn part(&self) -> Beam<&Self::Bending, &Self::Axial, &Self::Piezo, &Self::Permittivity>;
}

impl<T: Real, C: Profile<T>, A: Profile<T>, P: Profile<T>, E: Profile<T>> BeamPart<T> for Beam<C, A, P, E> {
    type Bending = C;
    type Axial = A;
    type Piezo = P;
    type Permittivity = E;
    #[inline(always)]
    fn part(&self) -> Beam<&C, &A, &P, &E> {
        Beam {
            bending: &self.bending,
            axial: &self.axial,
            piezo: &self.piezo,
            permittivity: &self.permittivity,
        }
    }
}

/// A part that may be a foundation.
pub trait FoundationPart<T: Real> {
    /// Compliance law.
    type Law: Compliance<T>;
    /// Profile of the gap.
    type Gap: Smooth<T>;
    /// Law and gap.
    fn part(&self) -> Foundation<&Self::Law, &Self::Gap>;
}

impl<T: Real, W: Compliance<T>, G: Smooth<T>> FoundationPart<T> for Foundation<W, G> {
    type Law = W;
    type Gap = G;
    #[inline(always)]
    fn part(&self) -> Foundation<&W, &G> {
        Foundation { law: &self.law, gap: &self.gap }
    }
}

impl<T: Real> FoundationPart<T> for () {
    type Law = ();
    type Gap = ();
    #[inline(always)]
    fn part(&self) -> Foundation<&(), &()> {
        Foundation { law: &(), gap: &() }
    }
}

/// A part that may be the conduction.
pub trait ConductionPart<T: Real> {
    /// Profile of mu1.
    type Mu1: Profile<T>;
    /// Profile of mu2.
    type Mu2: Profile<T>;
    /// Coefficients and truncations.
    fn part(&self) -> Conduction<T, &Self::Mu1, &Self::Mu2>;
}

impl<T: Real, U: Profile<T>, V: Profile<T>> ConductionPart<T> for Conduction<T, U, V> {
    type Mu1 = U;
    type Mu2 = V;
    #[inline(always)]
    fn part(&self) -> Conduction<T, &U, &V> {
        let Self { truncation, potential_truncation, .. } = *self;
        Conduction { mu1: &self.mu1, mu2: &self.mu2, truncation, potential_truncation }
    }
}

impl<T: Real> ConductionPart<T> for () {
    type Mu1 = ();
    type Mu2 = ();
    #[inline(always)]
    fn part(&self) -> Conduction<T, &(), &()> {
        Conduction::new(&(), &(), T::one())
    }
}

/// A part that may be a load.
pub trait LoadPart<T: Real> {
    /// Profile of the transverse load.
    type Transverse: Profile<T>;
    /// Profile of the axial load.
    type AxialLoad: Profile<T>;
    /// The loads.
    fn part(&self) -> Load<&Self::Transverse, &Self::AxialLoad, &[PointLoad<T>]>;
}

impl<T: Real, F: Profile<T>, A: Profile<T>, P: Points<T>> LoadPart<T> for Load<F, A, P> {
    type Transverse = F;
    type AxialLoad = A;
    #[inline(always)]
    fn part(&self) -> Load<&F, &A, &[PointLoad<T>]> {
        Load { transverse: &self.transverse, axial: &self.axial, points: self.points.list() }
    }
}

impl<T: Real> LoadPart<T> for () {
    type Transverse = ();
    type AxialLoad = ();
    #[inline(always)]
    fn part(&self) -> Load<&(), &(), &[PointLoad<T>]> {
        Load { transverse: &(), axial: &(), points: &[] }
    }
}

/// A part that may be the end potentials.
pub trait PotentialPart<T: Real> {
    /// The potentials.
    fn part(&self) -> Potential<T>;
}

impl<T: Real> PotentialPart<T> for Potential<T> {
    #[inline(always)]
    fn part(&self) -> Potential<T> {
        *self
    }
}

impl<T: Real> PotentialPart<T> for () {
    #[inline(always)]
    fn part(&self) -> Potential<T> {
        Potential { left: T::zero(), right: T::zero() }
    }
}

impl<T, B, F, Q, L, V> Model<T> for Scene<T, B, F, Q, L, V>
where
    T: Real,
    B: BeamPart<T>,
    F: FoundationPart<T>,
    Q: ConductionPart<T>,
    L: LoadPart<T>,
    V: PotentialPart<T>,
{
    type Bending = B::Bending;
    type Axial = B::Axial;
    type Piezo = B::Piezo;
    type Permittivity = B::Permittivity;
    type Law = F::Law;
    type Gap = F::Gap;
    type Mu1 = Q::Mu1;
    type Mu2 = Q::Mu2;
    type Transverse = L::Transverse;
    type AxialLoad = L::AxialLoad;

    #[inline(always)]
    fn length(&self) -> T {
        self.length
    }
    #[inline(always)]
    fn beam(&self) -> Beam<&B::Bending, &B::Axial, &B::Piezo, &B::Permittivity> {
        self.beam.part()
    }
    #[inline(always)]
    fn foundation(&self) -> Foundation<&F::Law, &F::Gap> {
        self.foundation.part()
    }
    #[inline(always)]
    fn conduction(&self) -> Conduction<T, &Q::Mu1, &Q::Mu2> {
        self.conduction.part()
    }
    #[inline(always)]
    fn load(&self) -> Load<&L::Transverse, &L::AxialLoad, &[PointLoad<T>]> {
        self.load.part()
    }
    #[inline(always)]
    fn potential(&self) -> Potential<T> {
        self.potential.part()
    }
}

impl<T: Real, M: Model<T>> Model<T> for &M {
    type Bending = M::Bending;
    type Axial = M::Axial;
    type Piezo = M::Piezo;
    type Permittivity = M::Permittivity;
    type Law = M::Law;
    type Gap = M::Gap;
    type Mu1 = M::Mu1;
    type Mu2 = M::Mu2;
    type Transverse = M::Transverse;
    type AxialLoad = M::AxialLoad;

    #[inline(always)]
    fn length(&self) -> T {
        M::length(self)
    }
    #[inline(always)]
    fn beam(&self) -> Beam<&M::Bending, &M::Axial, &M::Piezo, &M::Permittivity> {
        M::beam(self)
    }
    #[inline(always)]
    fn foundation(&self) -> Foundation<&M::Law, &M::Gap> {
        M::foundation(self)
    }
    #[inline(always)]
    fn conduction(&self) -> Conduction<T, &M::Mu1, &M::Mu2> {
        M::conduction(self)
    }
    #[inline(always)]
    fn load(&self) -> Load<&M::Transverse, &M::AxialLoad, &[PointLoad<T>]> {
        M::load(self)
    }
    #[inline(always)]
    fn potential(&self) -> Potential<T> {
        M::potential(self)
    }
}

/// The first break after x of any part, or the beam's end. Breaks closer than rounding are one.
pub(crate) fn next_break<T: Real, M: Model<T>>(model: &M, x: T) -> T {
    let length = model.length();
    let tiny = T::of(16.0) * T::epsilon() * length;
    let mut next = length;
    let mut see = |breaks: &[T]| {
        if let Some(&b) = breaks.get(breaks.partition_point(|&b| b <= x + tiny)) {
            next = next.min(b);
        }
    };
    let (beam, foundation) = (model.beam(), model.foundation());
    let (conduction, load) = (model.conduction(), model.load());
    see(beam.bending.breaks());
    see(beam.axial.breaks());
    see(beam.piezo.breaks());
    see(beam.permittivity.breaks());
    see(foundation.law.breaks());
    see(foundation.gap.breaks());
    see(conduction.mu1.breaks());
    see(conduction.mu2.breaks());
    see(load.transverse.breaks());
    see(load.axial.breaks());
    if let Some(point) = load.points.get(load.points.partition_point(|point| point.x <= x + tiny)) {
        next = next.min(point.x);
    }
    if next > length - tiny { length } else { next }
}

/// The concentrated loads of the node at `right`, each of one node alone: those within rounding of it, as [`next_break`]
/// has it, but not of the node before it, at `left`.
pub(crate) fn points_at<T: Real, M: Model<T>>(
    model: &M,
    left: T,
    right: T,
) -> impl Iterator<Item = &PointLoad<T>> {
    let tiny = T::of(16.0) * T::epsilon() * model.length();
    let points = model.load().points;
    let first = points.partition_point(|point| point.x <= left + tiny || right - point.x > tiny);
    points.iter().skip(first).take_while(move |point| point.x - right <= tiny)
}

/// Shapes, signs and finiteness of all that needs no mesh.
pub(crate) fn validate<T: Real, M: Model<T>>(model: &M) -> Result<(), Error> {
    let positive = "a finite number > 0";
    let whole = Place::Whole;
    let length = model.length();
    expect(length > T::zero() && length.is_finite(), "length", whole, positive, length)?;

    let beam = model.beam();
    beam.bending.validate("beam.bending", length)?;
    beam.axial.validate("beam.axial", length)?;
    beam.piezo.validate("beam.piezo", length)?;
    beam.permittivity.validate("beam.permittivity", length)?;
    if M::Piezo::PRESENT && !M::Axial::PRESENT {
        return Err(Error::Missing { field: "beam.axial", needed_by: "beam.piezo" });
    }
    if M::Piezo::PRESENT && !M::Permittivity::PRESENT {
        return Err(Error::Missing { field: "beam.permittivity", needed_by: "beam.piezo" });
    }

    let foundation = model.foundation();
    foundation.law.validate(length)?;
    foundation.gap.validate("foundation.gap", length)?;
    continuous(foundation.gap, length)?;

    let conduction = model.conduction();
    conduction.mu1.validate("conduction.mu1", length)?;
    conduction.mu2.validate("conduction.mu2", length)?;
    let (m, mq) = (conduction.truncation, conduction.potential_truncation);
    expect(m > T::zero() && m.is_finite(), "conduction.truncation", whole, positive, m)?;
    let field = "conduction.potential_truncation";
    expect(mq > T::zero() && mq.is_finite(), field, whole, positive, mq)?;
    if (M::Mu1::PRESENT || M::Mu2::PRESENT) && !M::Permittivity::PRESENT {
        return Err(Error::Missing { field: "beam.permittivity", needed_by: "conduction" });
    }

    let load = model.load();
    load.transverse.validate("load.transverse", length)?;
    load.axial.validate("load.axial", length)?;
    if M::AxialLoad::PRESENT && !M::Axial::PRESENT {
        return Err(Error::Missing { field: "beam.axial", needed_by: "load.axial" });
    }
    let mut last = T::zero();
    for (i, point) in load.points.iter().enumerate() {
        let ok = point.x >= last && point.x > T::zero() && point.x < length;
        let what = "positions in ascending order strictly inside (0, length)";
        expect(ok, "load.points", Place::Index(i), what, point.x)?;
        for number in [point.force, point.moment] {
            expect(number.is_finite(), "load.points", Place::Index(i), "finite numbers", number)?;
        }
        last = point.x;
    }

    let ends = model.potential();
    expect(ends.left.is_finite(), "potential.left", whole, "a finite number", ends.left)?;
    expect(ends.right.is_finite(), "potential.right", whole, "a finite number", ends.right)
}

/// A gap must not jump, beyond what rounding of its own numbers explains.
fn continuous<T: Real, G: Smooth<T>>(gap: &G, length: T) -> Result<(), Error> {
    let breaks = gap.breaks();
    for (i, &x) in breaks.iter().enumerate() {
        let before = if i == 0 { T::zero() } else { breaks[i - 1] };
        let after = breaks.get(i + 1).map_or(length, |&b| b);
        let half = T::of(0.5);
        let left = gap.value(x, half * (before + x));
        let right = gap.value(x, half * (x + after));
        // Coefficients given to a few digits less than the scalar has still meet.
        let slack = T::of(1024.0) * T::epsilon() * (left.abs() + right.abs() + gap_size(gap, length));
        if (left - right).abs() > slack {
            let (x, left, right) = (x.f64(), left.f64(), right.f64());
            return Err(Error::Jump { field: "foundation.gap", x, left, right });
        }
    }
    Ok(())
}

/// A size to compare jumps of the gap with.
fn gap_size<T: Real, G: Smooth<T>>(gap: &G, length: T) -> T {
    let mut size = T::zero();
    let mut from = T::zero();
    for &to in gap.breaks().iter().chain(core::iter::once(&length)) {
        let mid = T::of(0.5) * (from + to);
        size = size.max(gap.value(mid, mid).abs());
        from = to;
    }
    size
}
