//! What has to hold of any scene.

use crate::honest;
use piezobeam::{
    Compliance, Error, Fields, HeapWorkspace, Law, Mesh, Model, Problem, Profile, Real, Settings, Solution,
    Status,
};
use std::fmt::{self, Debug, Formatter};

/// A law as a closure, with the numbers in it to print.
pub struct Named<F, T>(pub Law<F>, pub [T; 2]);

impl<F, T: Debug> Debug for Named<F, T> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let [k, slope] = &self.1;
        write!(f, "Law(|_, r| ({k:?} * r, {slope:?}))")
    }
}

impl<T: Real, F: Fn(T, T) -> (T, T)> Compliance<T> for Named<F, T> {
    type Piece = ();
    fn coefficient(&self, _: T, _: T) -> T {
        T::zero()
    }
    fn pressure(&self, k: T, x: T, r: T) -> (T, T) {
        self.0.pressure(k, x, r)
    }
    fn validate(&self, length: T) -> Result<(), Error> {
        Compliance::<T>::validate(&self.0, length)
    }
}

/// What else to look at of a solution that is called converged.
#[derive(Clone, Copy)]
pub struct Also {
    /// The sums of [`honest`], whose rule has to be exact for the law.
    pub sums: bool,
    /// Bounds of the error, which have to be numbers that could be.
    pub bounds: bool,
}

/// A refused input or a status; after `Converged` a residual at most `stop`, finite fields, no tension in the
/// contact, clamps where they were, and what [`honest`] says; visits within their cap whatever happened.
pub fn check<T: Real, M: Model<T> + Debug>(scene: M, mesh: Mesh<'_, T>, settings: &Settings<T>, also: Also) {
    let Ok(problem) = Problem::new(scene, mesh) else { return };
    let mut memory = HeapWorkspace::new();
    let Ok(solution) = problem.solve(&mut memory, settings) else { return };
    let report = solution.report();
    let said = || format!("{} {mesh:?} {settings:?}\n{:?}\n{report:?}", kind::<T>(), problem.scene());

    let cap = settings.max_visits.unwrap_or(400 * report.elements + 100_000);
    assert!(report.element_visits <= cap, "more visits than {cap}\n{}", said());
    // Whatever the status, these return.
    let (_, _, _) = (solution.resultants(), solution.uniqueness(), solution.warnings());
    let (zones, length) = (solution.zones(), problem.scene().length());
    let fields = sample(&solution, length);
    if report.status != Status::Converged {
        return;
    }
    assert!(report.residual.is_finite() && report.residual <= settings.stop, "residual\n{}", said());
    let mut last = T::zero();
    for [a, b] in zones {
        assert!(last <= a && a <= b && b <= length, "zones: {a:?} to {b:?} after {last:?}\n{}", said());
        last = b;
    }
    for f in fields {
        assert!(finite(&f), "not finite: {f:?}\n{}", said());
        assert!(f.pressure.is_none_or(|p| p >= T::zero()), "tension: {f:?}\n{}", said());
    }
    // Conduction stronger than (2.15) allows is more than a few elements resolve.
    if also.sums
        && solution.uniqueness().certified
        && let Err(what) = honest::check(&solution)
    {
        panic!("{what}\n{}", said());
    }
    if also.bounds
        && let Ok(found) = solution.certify(&mut HeapWorkspace::new(), settings)
    {
        let cap = settings.max_visits.unwrap_or(400 * 4 * report.elements + 100_000);
        let (visits, elements) = (found.report.element_visits, found.report.elements);
        assert!(visits <= cap && elements <= (4 * report.elements).max(cap / 16), "{found:?}\n{}", said());
        let bounds = [found.bending_bound, found.electric_bound].into_iter().flatten();
        assert!({ bounds }.all(|bound| bound >= T::zero()), "{found:?}\n{}", said());
    }
    // Both ends are clamped, to half the digits of what cancels there.
    let middle = T::of(0.5) * length;
    let flexible = length * length / problem.scene().beam().bending.value(middle, middle);
    let nodes: Vec<_> = solution.nodes().collect();
    let inside = nodes.windows(2).map(|pair| pair[0] + T::of(0.5) * (pair[1] - pair[0]));
    let all = nodes.iter().copied().chain(inside).map(|x| solution.at(x));
    let size = all.chain(fields).fold(T::zero(), |m, f| {
        let gap = f.gap.map_or(m, T::abs);
        m.max(f.bending.abs()).max(gap).max(f.moment.abs() * flexible)
    });
    for f in [fields[0], fields[8]] {
        let slack = T::epsilon().sqrt() * size + T::min_positive_value();
        assert!(f.bending.abs() <= slack, "a clamp has moved: {f:?}\n{}", said());
    }
}

fn kind<T: Real>() -> &'static str {
    core::any::type_name::<T>()
}

fn sample<T: Real, M: Model<T>>(solution: &Solution<'_, T, M>, length: T) -> [Fields<T>; 9] {
    std::array::from_fn(|i| solution.at(length * T::of(i as f64 / 8.0)))
}

fn finite<T: Real>(f: &Fields<T>) -> bool {
    let always = [f.x, f.bending, f.slope, f.moment, f.shear];
    let perhaps = [f.stretching, f.potential, f.axial_force, f.electric_displacement, f.gap, f.pressure];
    always.into_iter().chain(perhaps.into_iter().flatten()).all(T::is_finite)
}
