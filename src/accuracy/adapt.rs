//! A mesh for an accuracy that is asked for.
//!
//! Each element has its share of the error ([`super::share`]); elements are divided where it is large and joined where it
//! is small, until the shares are alike and their sum is what is asked for.
//!
//! The estimate is calibrated: after each pass the deflection at the nodes of the mesh before is known better, and tells
//! what its error was.

use super::divide::{self, Shares};
use crate::element::Element;
use crate::error::{self, Error, expect};
use crate::mesh::Mesh;
use crate::newton::nested::{self, Answer};
use crate::newton::{Settings, Status};
use crate::problem::{self, Problem};
use crate::real::{Pair, Real};
use crate::scene::{self, Model};
use crate::solution::Solution;
use crate::storage::{self, Place, States, Storage};
use core::fmt;
use core::marker::PhantomData;

/// How a solve to an accuracy ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Reached {
    /// The estimate of the error is at most what was asked for.
    Tolerance,
    /// Rounding keeps the error above what was asked for.
    Floor,
    /// The memory holds no more elements.
    Capacity,
    /// The solve on the last mesh has not converged; its status says why.
    Unsolved,
}

/// A solution on a mesh that was made for it.
pub struct Adapted<'s, T: Real, M: Model<T>> {
    /// The solution.
    pub solution: Solution<'s, T, M>,
    /// How the search for the mesh ended.
    pub reached: Reached,
    /// Estimate of the largest error of bending over the largest bending: by the shares of the elements and what the
    /// meshes before had of it, where there were any. [`Solution::certify`] gives a better one.
    pub estimate: T,
    /// Meshes solved on. The visits of elements on all of them are in the solution's report.
    pub passes: usize,
}

/// Meshes at most.
const PASSES: usize = 24;
/// A pass asks for so much less error than there is: what a mesh says of the solution is as coarse as the mesh.
const STRIDE: f64 = 100.0;
/// Share of the tolerance that the estimate may take.
const MARGIN: f64 = 0.3;
/// Points at which the deflection is compared between passes.
const COMPARED: usize = 17;
/// Rounding leaves so many units in the last place of the largest deflection, however fine the mesh.
const FLOOR: f64 = 16.0;
/// Relative residual asked for on a mesh, over the error that it is made for.
const ROUGH: f64 = 1e-2;

impl<T: Real, M: Model<T>> Problem<'_, T, M> {
    /// Solves to a relative accuracy of bending, in the maximum norm, on a mesh made for it: the problem's own mesh is
    /// where it starts, a dozen elements are a good one.
    ///
    /// ```
    /// use piezobeam::{Beam, Foundation, HeapWorkspace, Linear, Load, Mesh, Problem, Reached, Scene, Settings, Steps};
    ///
    /// // All but rigid: a uniform mesh needs 1800 elements for this accuracy.
    /// let scene = Scene::new(1.0_f64, Beam::elastic(5000.0))
    ///     .foundation(Foundation { law: Linear(1e16), gap: () })
    ///     .load(Load { transverse: Steps { breaks: &[0.5], values: &[1e6, -1e6] }, axial: (), points: () });
    /// let problem = Problem::new(scene, Mesh::uniform(16))?;
    /// let mut memory = HeapWorkspace::new();
    /// let found = problem.solve_to(&mut memory, 1e-10, &Settings::default())?;
    /// assert_eq!(found.reached, Reached::Tolerance);
    /// assert!(found.solution.report().elements < 200);
    /// assert!((found.solution.at(0.5).bending + 0.069178756).abs() < 1e-9);
    /// # Ok::<(), piezobeam::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`Problem::solve`]; a tolerance that is not between 0 and 1; a profile's value out of its range at a point of
    /// a finer mesh.
    ///
    /// # Cost
    /// Four to eight visits of each element of the last mesh, those on the meshes before it included, and the cold solve
    /// on the first. Memory for the last mesh.
    pub fn solve_to<'s, S: Storage<T, M> + ?Sized>(
        &'s self,
        memory: &'s mut S,
        tolerance: T,
        settings: &Settings<T>,
    ) -> Result<Adapted<'s, T, M>, Error> {
        check(tolerance)?;
        let scene = self.scene();
        let start = begin(scene, &self.mesh, memory, settings)?;
        run(scene, memory, start, tolerance, settings)
    }
}

/// A history of scenes, each solved to an accuracy on a mesh that follows it: a warm start divides the last mesh where
/// the new scene needs it and joins elements where it does not.
///
/// ```
/// use piezobeam::{Adaptive, Beam, Foundation, HeapWorkspace, Linear, Load, Mesh, Reached, Scene, Settings};
///
/// let beam = Scene::new(1.0_f64, Beam::elastic(5000.0)).foundation(Foundation { law: Linear(1e10), gap: 1e-3 });
/// let mut memory = HeapWorkspace::new();
/// let mut adaptive = Adaptive::new(Mesh::uniform(16), &mut memory);
/// for load in [1e6, 1.1e6, 1.2e6] {
///     let scene = beam.load(Load { transverse: load, axial: (), points: () });
///     let found = adaptive.solve(&scene, 1e-8, &Settings::default())?;
///     assert_eq!(found.reached, Reached::Tolerance);
/// }
/// # Ok::<(), piezobeam::Error>(())
/// ```
pub struct Adaptive<'s, T: Real, M: Model<T>, S: Storage<T, M> + ?Sized> {
    mesh: Mesh<'s, T>,
    memory: &'s mut S,
    /// Elements of the last mesh and the number of their states, if that solve converged.
    last: Option<(usize, usize)>,
    scenes: PhantomData<fn(&M)>,
}

impl Reached {
    /// Lower case, for machines.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Tolerance => "tolerance",
            Self::Floor => "floor",
            Self::Capacity => "capacity",
            Self::Unsolved => "unsolved",
        }
    }
}

impl fmt::Display for Reached {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Tolerance => "the error is estimated to be what was asked for at most",
            Self::Floor => "rounding keeps the error above what was asked for",
            Self::Capacity => "the memory holds no finer mesh, or too many would be needed",
            Self::Unsolved => "the solve on the last mesh has not converged",
        })
    }
}

impl<'s, T: Real, M: Model<T>, S: Storage<T, M> + ?Sized> Adaptive<'s, T, M, S> {
    /// No scene yet; a cold solve starts on `mesh`.
    pub fn new(mesh: Mesh<'s, T>, memory: &'s mut S) -> Self {
        Self { mesh, memory, last: None, scenes: PhantomData }
    }

    /// Forgets the last solution: the next solve starts from nothing.
    pub fn forget(&mut self) {
        self.last = None;
    }

    /// The next scene. It starts from nothing where the last mesh has no node at one of its breaks or concentrated
    /// loads, or where what it starts from does not lead to it.
    ///
    /// # Errors
    /// As [`Problem::solve_to`]. The next solve then starts from nothing.
    pub fn solve<'a>(
        &'a mut self,
        scene: &'a M,
        tolerance: T,
        settings: &Settings<T>,
    ) -> Result<Adapted<'a, T, M>, Error> {
        let last = self.last.take();
        check(tolerance)?;
        scene::validate(scene)?;
        self.mesh.validate(scene.length())?;
        settings.validate()?;
        let mut start = None;
        if let Some((elements, state)) = last {
            let places = storage::first(self.memory, elements);
            if carry_over(scene, places, state)? {
                let answer = nested::sharpen(scene, places, false, T::infinity(), settings);
                let visits = answer.report.element_visits;
                if answer.report.status == Status::Converged {
                    start = Some(Start { elements, answer, visits, warm: true });
                }
            }
        }
        let start = match start {
            Some(start) => start,
            None => begin(scene, &self.mesh, self.memory, settings)?,
        };
        let found = run(scene, self.memory, start, tolerance, settings)?;
        if found.solution.report().status == Status::Converged {
            self.last = Some((found.solution.report().elements, found.solution.state));
        }
        Ok(found)
    }
}

/// Samples `scene` on the mesh in `places`; whether that has nodes where the scene needs them. The elements' states
/// stay.
fn carry_over<T: Real, M: Model<T>>(
    scene: &M,
    places: &mut [Place<T, M>],
    state: usize,
) -> Result<bool, Error> {
    let tiny = T::of(16.0) * T::epsilon() * scene.length();
    if places.last().is_none_or(|last| last.element.right != scene.length()) {
        return Ok(false);
    }
    let mut left = T::zero();
    for place in places {
        let (right, stop) = (place.element.right, scene::next_break(scene, left));
        if stop < right - tiny {
            return Ok(false);
        }
        let last = place.work.states[state];
        *place = Place::default();
        place.element = Element::sample(scene, left, right, stop <= right + tiny)?;
        place.work.states = States::both(last);
        left = right;
    }
    Ok(true)
}

/// Is it one that can be asked for?
fn check<T: Real>(tolerance: T) -> Result<(), Error> {
    let ok = tolerance > T::zero() && tolerance < T::one();
    expect(ok, "tolerance", error::Place::Whole, "a number between 0 and 1", tolerance)
}

/// A solution on a first mesh.
struct Start<T: Real, M: Model<T>> {
    elements: usize,
    answer: Answer<T, M>,
    visits: usize,
    /// From another scene's mesh.
    warm: bool,
}

/// From nothing, on `mesh`.
fn begin<T: Real, M: Model<T>, S: Storage<T, M> + ?Sized>(
    scene: &M,
    mesh: &Mesh<'_, T>,
    memory: &mut S,
    settings: &Settings<T>,
) -> Result<Start<T, M>, Error> {
    let (places, levels) = problem::lay(scene, mesh, memory)?;
    let answer = nested::solve(scene, places, &levels, settings)?;
    let report = answer.report;
    Ok(Start { elements: report.elements, answer, visits: report.element_visits, warm: false })
}

/// From a solution on a first mesh to one of the accuracy asked for.
fn run<'s, T: Real, M: Model<T>, S: Storage<T, M> + ?Sized>(
    scene: &'s M,
    memory: &'s mut S,
    start: Start<T, M>,
    tolerance: T,
    settings: &Settings<T>,
) -> Result<Adapted<'s, T, M>, Error> {
    let Start { mut elements, mut answer, mut visits, warm } = start;
    let rigid = answer.rigid;
    let (asked, floor) = (tolerance, T::of(FLOOR) * T::epsilon());
    let tolerance = asked.max(floor);
    // What a mesh is solved to, when `target` is the error that it is made for.
    let solved_to = |target: T, visits: usize| {
        let last = target <= tolerance;
        let stop = if last { settings.stop } else { settings.stop.max(T::of(ROUGH) * target) };
        let units =
            if last { (T::of(ROUGH) * tolerance / T::epsilon()).max(T::of(128.0)) } else { T::infinity() };
        (Settings { stop, max_visits: settings.max_visits.map(|most| most.saturating_sub(visits)) }, units)
    };
    let (mut passes, mut finished) = (1, true);
    let mut last: Option<Pass<T>> = None;
    let mut calibration = T::one();
    let (estimate, mut reached) = loop {
        let places = storage::first(memory, elements);
        let pass = Pass::of(scene, places, &answer);
        visits += elements;
        if let Some(last) = last {
            calibration = last.calibrate(&pass).unwrap_or(calibration);
        }
        let estimate = calibration * pass.modelled;
        let good = estimate <= T::of(MARGIN) * tolerance;
        let target = tolerance.max(estimate / T::of(STRIDE));
        let allowed = T::of(0.5 * MARGIN) * target * pass.most / calibration;
        let wanted = Shares { places, shares: 1 - answer.state, join: true }.plan(allowed, usize::MAX);
        if good && !(warm && passes == 1 && wanted.elements < elements - elements / 4) {
            break (estimate, Reached::Tolerance);
        }
        if !answer.report.is_solved() && passes > 1 {
            break (estimate, Reached::Unsolved);
        }
        let room = memory.places(wanted.elements.max(elements)).len();
        let shares =
            Shares { places: storage::first(memory, elements), shares: 1 - answer.state, join: true };
        let plan = if wanted.elements > room { shares.plan(allowed, room) } else { wanted };
        if passes == PASSES || (wanted.elements > room && !(elements + 1..=room).contains(&plan.elements)) {
            break (estimate, Reached::Capacity);
        }
        divide::remesh(scene, memory, elements, answer.state, plan)?;
        elements = plan.elements;
        let (settings, units) = solved_to(target, visits);
        let places = storage::first(memory, elements);
        answer = nested::sharpen(scene, places, rigid, units, &settings);
        visits += answer.report.element_visits;
        (passes, finished, last) = (passes + 1, target <= tolerance, Some(pass));
    };
    let places = storage::first(memory, elements);
    if !finished && reached != Reached::Unsolved {
        for place in places.iter_mut() {
            place.work.states = States::both(place.work.states[answer.state]);
        }
        let (settings, units) = solved_to(tolerance, visits);
        answer = nested::sharpen(scene, places, rigid, units, &settings);
        visits += answer.report.element_visits;
    }
    let report = &mut answer.report;
    report.element_visits = visits;
    if report.status != Status::Converged {
        reached = Reached::Unsolved;
    } else if reached == Reached::Tolerance && report.residual.max(floor) > asked {
        reached = Reached::Floor;
    }
    let estimate = estimate.max(report.residual).max(floor);
    Ok(Adapted { solution: Solution::new(scene, places, answer), reached, estimate, passes })
}

/// What one mesh says of the error.
#[derive(Clone, Copy)]
struct Pass<T> {
    /// Sum of all shares over the largest deflection.
    modelled: T,
    /// The largest deflection \[m\].
    most: T,
    /// Deflections to compare.
    points: [T; COMPARED],
}

impl<T: Real> Pass<T> {
    /// Each element's share goes into its spare state.
    fn of<M: Model<T>>(scene: &M, places: &mut [Place<T, M>], answer: &Answer<T, M>) -> Self {
        let solution = Solution::new(scene, &*places, *answer);
        let number = |i: usize| T::from(i).unwrap_or(T::one());
        let points = core::array::from_fn(|i| {
            solution.at(scene.length() * number(2 * i + 1) / number(2 * COMPARED)).bending
        });
        let most = points.iter().fold(T::zero(), |m: T, b: &T| m.max(b.abs()));
        let load = nested::compliance(scene, places, answer, most);
        let spare = 1 - answer.state;
        let mut sum = T::zero();
        for i in 0..places.len() {
            let moved = places[i].work.states[spare];
            let solution = Solution::new(scene, &*places, *answer);
            let share = solution.solved(i).share(load.unwrap_or(T::one()), &moved);
            sum = sum + share.error;
            places[i].work.states[spare].e = T::Vec2::of(share.error, share.stiff);
        }
        let modelled = if sum == T::zero() { sum } else { sum / most };
        Self { modelled, most, points }
    }

    /// The error that this mesh had, as the next one knows it, over what was modelled.
    fn calibrate(&self, next: &Self) -> Option<T> {
        let apart = self.points.iter().zip(&next.points).fold(T::zero(), |m, (a, b)| m.max((*a - *b).abs()));
        let less = self.modelled - next.modelled;
        (less > T::of(0.5) * self.modelled)
            .then(|| (apart / next.most / less).max(T::of(0.25)).min(T::of(1e2)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_estimate_is_corrected_by_the_next_mesh_where_that_is_much_better() {
        let pass = |modelled: f64, most: f64, value: f64| Pass { modelled, most, points: [value; COMPARED] };
        // Off by 0.6 of 2 where 3.6 less is modelled; a 12th is less than the quarter that a correction is at least.
        let (before, after) = (pass(4.0, 2.0, 1.0), pass(0.4, 2.0, 0.4));
        let found = before.calibrate(&after).unwrap_or(f64::NAN);
        assert!((found - 0.25).abs() < 1e-15, "{found}");
        let found = before.calibrate(&pass(0.4, 0.25, 0.4)).unwrap_or(f64::NAN);
        assert!((found - 0.6 / 0.25 / 3.6).abs() < 1e-15, "{found}");
        assert_eq!(before.calibrate(&pass(3.0, 2.0, 0.4)), None, "a quarter better says nothing");
    }
}
