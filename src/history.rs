//! Scenes one after the other: each solve starts from the last solution.

use crate::element::Element;
use crate::error::Error;
use crate::mesh::Mesh;
use crate::newton::nested::{self, Last};
use crate::newton::{Settings, Status};
use crate::problem::room;
use crate::real::Real;
use crate::scene::{self, Model};
use crate::solution::Solution;
use crate::storage::{Place, Storage};
use core::marker::PhantomData;
use core::ops::Range;

/// A history of scenes on one mesh in one memory: loads, gaps, potentials or stiffnesses that change from
/// step to step, in a control loop or along a path of loads.
///
/// Each solve starts from the last solution and visits only what lies between the outermost elements that
/// changed, by their data or by their contact, and all of them once to check the residual. Where that does
/// not converge, or the nodes or the gap at a clamp are others, it starts from nothing. So every scene ends as it would alone: under
/// (2.15) in the same solution, up to the tolerance; where there are several, in one near the last.
///
/// Nodes stand at breaks and under concentrated loads. For a load that travels, keep the breaks or places and
/// change the values: a break or a concentrated load that moves makes other nodes.
///
/// ```
/// use piezobeam::{Beam, Foundation, HeapWorkspace, History, Linear, Load, Mesh, Scene, Settings, Status};
///
/// let beam = Scene::new(1.0_f64, Beam::elastic(5000.0)).foundation(Foundation { law: Linear(1e8), gap: 1e-3 });
/// let mut memory = HeapWorkspace::new();
/// let mut history = History::new(Mesh::uniform(100), &mut memory);
/// let mut contact = 0.0;
/// for load in [1e6, 1.1e6, 1.2e6] {
///     let scene = beam.load(Load { transverse: load, axial: (), points: () });
///     let solution = history.solve(&scene, &Settings::default())?;
///     assert_eq!(solution.report().status, Status::Converged);
///     assert!(solution.resultants().contact_force > contact);
///     contact = solution.resultants().contact_force;
/// }
/// # Ok::<(), piezobeam::Error>(())
/// ```
pub struct History<'s, T: Real, M: Model<T>, S: Storage<T, M> + ?Sized> {
    mesh: Mesh<'s, T>,
    memory: &'s mut S,
    /// Of the last solve, if it converged, and its number of elements.
    last: Option<(usize, Last<T, M>)>,
    scenes: PhantomData<fn(&M)>,
}

impl<'s, T: Real, M: Model<T>, S: Storage<T, M> + ?Sized> History<'s, T, M, S> {
    /// No scene yet.
    pub fn new(mesh: Mesh<'s, T>, memory: &'s mut S) -> Self {
        Self { mesh, memory, last: None, scenes: PhantomData }
    }

    /// Forgets the last solution: the next solve starts from nothing.
    pub fn forget(&mut self) {
        self.last = None;
    }

    /// The next scene.
    ///
    /// # Errors
    /// As [`Problem::new`](crate::Problem::new), [`Problem::prepare`](crate::Problem::prepare) and
    /// [`Problem::solve`](crate::Problem::solve). The next solve then starts from nothing.
    ///
    /// # Cost
    /// The scene's profiles are sampled on all elements; see [`History`] for the visits. No allocation where the
    /// memory is large enough.
    pub fn solve<'a>(
        &'a mut self,
        scene: &'a M,
        settings: &Settings<T>,
    ) -> Result<Solution<'a, T, M>, Error> {
        let last = self.last.take();
        settings.validate()?;
        scene::validate(scene)?;
        self.mesh.validate(scene.length())?;
        let (elements, places) = room(&self.mesh, scene, self.memory)?;
        let mesh = places.get_mut(..elements).unwrap_or_default();
        let last = last.filter(|(before, _)| *before == elements).map(|(_, last)| last);
        let changed = lay(&self.mesh, scene, mesh, last.is_some())?;
        let mut wasted = 0;
        let mut answer = None;
        if let (Some(last), Some(changed)) = (last, changed) {
            match nested::follow(scene, mesh, &last, changed, settings) {
                Some(followed) if followed.report.status == Status::Converged => answer = Some(followed),
                Some(followed) => wasted = followed.report.element_visits,
                None => {}
            }
        }
        let answer = match answer {
            Some(answer) => answer,
            None => {
                for place in mesh {
                    *place = Place { element: place.element, ..Place::default() };
                }
                let levels = nested::coarsen(scene, places, elements);
                let most = nested::budget(settings, elements).most_visits;
                let rest = Settings { max_visits: Some(most - wasted), ..*settings };
                let mut answer = nested::solve(scene, places, &levels, &rest)?;
                answer.report.element_visits += wasted;
                answer
            }
        };
        let places = places.get(..elements).unwrap_or_default();
        if answer.report.status == Status::Converged {
            self.last = Some((elements, Last::of(&answer, scene, places)));
        }
        Ok(Solution::new(scene, places, answer))
    }
}

/// Samples `scene` into `places`; with `compare` the range of elements whose bending it changes, or `None` if
/// the nodes are others.
fn lay<T: Real, M: Model<T>>(
    mesh: &Mesh<'_, T>,
    scene: &M,
    places: &mut [Place<T, M>],
    compare: bool,
) -> Result<Option<Range<usize>>, Error> {
    let mut same = compare;
    let mut changed: Option<Range<usize>> = None;
    let mut free = places.iter_mut().enumerate();
    let mut element = Element::blank();
    mesh.lay(scene, |left, right, stop| {
        if let Some((i, place)) = free.next() {
            element.lay(scene, left, right, stop)?;
            same = same && element.covers(&place.element);
            if !element.bends_like(&place.element) {
                changed = Some(changed.as_ref().map_or(i, |range| range.start)..i + 1);
            }
            place.element = element;
        }
        Ok(())
    })?;
    Ok(same.then(|| changed.unwrap_or(0..0)))
}
