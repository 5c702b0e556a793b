//! From a scene to a solution: validation, sampling, solve.

use crate::error::Error;
use crate::mesh::Mesh;
use crate::newton::nested::{self, Answer, Levels};
use crate::newton::{Report, Settings};
use crate::real::Real;
use crate::scene::{self, Model};
use crate::solution::Solution;
use crate::storage::{Place, Storage, Work, Workspace};

/// A checked scene on a mesh. Immutable: any number of solves may share it, each with its own memory.
///
/// ```
/// use piezobeam::{Beam, Load, Mesh, Problem, Scene, Settings, Status};
///
/// let scene = Scene::new(1.0_f64, Beam::elastic(5000.0))
///     .load(Load { transverse: 1e6, axial: (), points: () });
/// let problem = Problem::new(scene, Mesh::uniform(10))?;
/// let mut memory = problem.workspace::<16>();
/// let solution = problem.solve(&mut memory, &Settings::default())?;
/// assert_eq!(solution.report().status, Status::Converged);
/// // f L^4 / (384 C)
/// assert!((solution.at(0.5).bending - 1e6 / (384.0 * 5000.0)).abs() < 1e-12);
/// # Ok::<(), piezobeam::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Problem<'a, T, M> {
    scene: M,
    pub(crate) mesh: Mesh<'a, T>,
}

impl<'a, T: Real, M: Model<T>> Problem<'a, T, M> {
    /// Checks the scene and the mesh.
    ///
    /// # Errors
    /// The first field that is wrong, where in it, what was expected and what was found. Values of
    /// profiles are checked where they are sampled, when the scene is laid into memory.
    pub fn new(scene: M, mesh: Mesh<'a, T>) -> Result<Self, Error> {
        scene::validate(&scene)?;
        mesh.validate(scene.length())?;
        Ok(Self { scene, mesh })
    }

    /// The scene.
    pub fn scene(&self) -> &M {
        &self.scene
    }

    /// The same scene on another mesh.
    ///
    /// # Errors
    /// What is wrong with the mesh.
    pub fn on(self, mesh: Mesh<'_, T>) -> Result<Problem<'_, T, M>, Error> {
        mesh.validate(self.scene.length())?;
        Ok(Problem { scene: self.scene, mesh })
    }

    /// Memory for `N` elements of this kind of scene (see [`Workspace`] for what to add for the coarser
    /// meshes).
    #[must_use]
    pub fn workspace<const N: usize>(&self) -> Workspace<T, M, N> {
        Workspace::new()
    }

    /// Lays the mesh into memory and samples the scene on it.
    ///
    /// # Errors
    /// A profile's value out of its range, with its place; too little memory.
    ///
    /// # Cost
    /// Four evaluations of each profile per element (and three more of a gap). A heap workspace allocates
    /// here, if at all.
    pub fn prepare<'s, S: Storage<T, M> + ?Sized>(
        &'s self,
        memory: &'s mut S,
    ) -> Result<Prepared<'s, T, M>, Error> {
        let (places, levels) = lay(&self.scene, &self.mesh, memory)?;
        Ok(Prepared { scene: &self.scene, places, levels, answer: None })
    }

    /// [`Problem::prepare`] and [`Prepared::solve`] in one.
    ///
    /// # Errors
    /// As [`Problem::prepare`], and settings out of range. Not converging is no error but a
    /// [`Status`](crate::Status) in the solution's report.
    pub fn solve<'s, S: Storage<T, M> + ?Sized>(
        &'s self,
        memory: &'s mut S,
        settings: &Settings<T>,
    ) -> Result<Solution<'s, T, M>, Error> {
        self.prepare(memory)?.into_solution(settings)
    }
}

/// Places that a scene was laid into, and where each mesh lies in them.
type Laid<'m, T, M> = (&'m mut [Place<T, M>], Levels);

/// Samples `scene` on `mesh`, and the coarser meshes behind it.
pub(crate) fn lay<'s, T: Real, M: Model<T>, S: Storage<T, M> + ?Sized>(
    scene: &M,
    mesh: &Mesh<'_, T>,
    memory: &'s mut S,
) -> Result<Laid<'s, T, M>, Error> {
    let (elements, places) = room(mesh, scene, memory)?;
    let mut free = places.iter_mut();
    mesh.lay(scene, |left, right, stop| {
        if let Some(place) = free.next() {
            place.work = Work::default();
            place.element.lay(scene, left, right, stop)?;
        }
        Ok(())
    })?;
    let levels = nested::coarsen(scene, places, elements);
    Ok((places, levels))
}

/// A number of elements, and room for them.
type Room<'m, T, M> = (usize, &'m mut [Place<T, M>]);

/// The elements of a mesh, and room for them and the coarser meshes.
pub(crate) fn room<'m, T: Real, M: Model<T>, S: Storage<T, M> + ?Sized>(
    mesh: &Mesh<'_, T>,
    scene: &M,
    memory: &'m mut S,
) -> Result<Room<'m, T, M>, Error> {
    // Count first, so that memory that grows does so once.
    let needed = mesh.count(scene)?;
    let places = memory.places(needed);
    let available = places.len();
    if needed > available { Err(Error::Capacity { needed, available }) } else { Ok((needed, places)) }
}

/// A scene laid into memory, ready to be solved, again and again.
pub struct Prepared<'s, T: Real, M: Model<T>> {
    pub(crate) scene: &'s M,
    pub(crate) places: &'s mut [Place<T, M>],
    levels: Levels,
    /// Where the last solve left its answer.
    pub(crate) answer: Option<Answer<T, M>>,
}

impl<'s, T: Real, M: Model<T>> Prepared<'s, T, M> {
    /// Elements of the mesh.
    #[must_use]
    pub fn elements(&self) -> usize {
        self.levels.first().map_or(0, |&(_, len)| len)
    }

    /// Solves from nothing.
    ///
    /// # Errors
    /// Settings out of range.
    ///
    /// # Cost
    /// A few sweeps over the mesh, whatever the stiffness; no allocation, no panic; bounded by
    /// [`Settings::max_visits`].
    pub fn solve(&mut self, settings: &Settings<T>) -> Result<Report<T>, Error> {
        self.run(settings).map(|answer| answer.report)
    }

    /// Solves from nothing and gives the fields.
    ///
    /// # Errors
    /// Settings out of range.
    pub fn solution(&mut self, settings: &Settings<T>) -> Result<Solution<'_, T, M>, Error> {
        let answer = self.run(settings)?;
        let places = self.places.get(..self.elements()).unwrap_or_default();
        Ok(Solution::new(self.scene, places, answer))
    }

    fn into_solution(mut self, settings: &Settings<T>) -> Result<Solution<'s, T, M>, Error> {
        let answer = self.run(settings)?;
        let elements = self.elements();
        Ok(Solution::new(self.scene, self.places.get(..elements).unwrap_or_default(), answer))
    }

    /// Forgets the last solve, and what it did to the law.
    pub(crate) fn restore(&mut self) {
        if self.answer.take().is_some_and(|last| last.rigid) {
            nested::harden(self.scene, self.places, &self.levels);
        }
    }

    pub(crate) fn run(&mut self, settings: &Settings<T>) -> Result<Answer<T, M>, Error> {
        self.restore();
        let answer = nested::solve(self.scene, self.places, &self.levels, settings)?;
        self.answer = Some(answer);
        Ok(answer)
    }
}
