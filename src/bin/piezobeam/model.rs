//! From a scene file to the library's types: what the file lacks is left out of the type, so that the solver
//! that runs was compiled without it.

use crate::cli::Precision;
use crate::profile::Shape;
use crate::scene_file::{ConductionTable, ProfileSpec, SceneFile};
use piezobeam::{
    Beam, Conduction, Error, Foundation, Linear, Load, Mesh, Model, PointLoad, Potential, Power, Problem,
    Profile, Real, Scene, Smooth,
};

/// Something to do with a scene, whatever its types are.
pub trait Task {
    type Output;
    /// Is it worth a solver of its own for coefficients that are constant between breaks? It solves the same, faster;
    /// every solver takes seconds to compile.
    const LEAN: bool = false;
    fn run<T: Real, M: Model<T>>(self, problem: Problem<'_, T, M>) -> Result<Self::Output, Error>;
}

/// Elements where neither the file nor the command line says.
const ELEMENTS: usize = 200;

/// Does `task` with the scene of `file`.
pub fn with<K: Task>(
    file: &SceneFile,
    elements: Option<usize>,
    precision: Precision,
    task: K,
) -> Result<K::Output, Error> {
    let flat = || {
        let beam = &file.beam;
        let foundation = file.foundation.as_ref();
        let conduction = file.conduction.as_ref();
        let all = [
            beam.axial.as_ref(),
            beam.piezo.as_ref(),
            beam.permittivity.as_ref(),
            foundation.map(|f| &f.stiffness),
            conduction.and_then(|c| c.mu1.as_ref()),
            conduction.and_then(|c| c.mu2.as_ref()),
        ];
        all.into_iter().flatten().all(|profile| profile.stepwise())
    };
    match precision {
        Precision::F64 if K::LEAN && flat() => Typed::<f64, true>::of(file, elements).dispatch(task),
        Precision::F64 => Typed::<f64, false>::of(file, elements).dispatch(task),
        Precision::F32 => Typed::<f32, false>::of(file, elements).dispatch(task),
    }
}

struct Typed<'f, T, const FLAT: bool> {
    file: &'f SceneFile,
    elements: Option<usize>,
    length: T,
}

/// No conduction: mu1 = mu2 = 0, with any truncation.
const NO_CONDUCTION: ConductionTable =
    ConductionTable { mu1: None, mu2: None, truncation: 1.0, potential_truncation: None };

impl<'f, T: Real, const FLAT: bool> Typed<'f, T, FLAT>
where
    Shape<T, FLAT>: Profile<T> + Smooth<T>,
    Shape<T, false>: Profile<T> + Smooth<T>,
{
    fn of(file: &'f SceneFile, elements: Option<usize>) -> Self {
        Self { file, elements, length: T::of(file.length) }
    }

    fn dispatch<K: Task>(&self, task: K) -> Result<K::Output, Error> {
        let file = self.file;
        let (beam, conduction) = (&file.beam, file.conduction.as_ref());
        // A potential is solved for where something asks for it.
        let asks = [
            ("potential", file.potential.is_some()),
            ("conduction", conduction.is_some()),
            ("beam.piezo", beam.piezo.is_some()),
        ];
        let electric = asks.iter().find(|(_, asks)| *asks).map(|(by, _)| *by);
        let missing = |field, needed_by| Err(Error::Missing { field, needed_by });
        match (electric, &beam.axial, &beam.permittivity) {
            (Some(by), _, None) => return missing("beam.permittivity", by),
            _ if beam.axial.is_none() && beam.piezo.is_some() => {
                return missing("beam.axial", "beam.piezo");
            }
            _ if beam.axial.is_none() && file.load.axial.is_some() => {
                return missing("beam.axial", "load.axial");
            }
            _ => {}
        }
        let bending = Shape::<T, false>::new(&beam.bending);
        let shape = |spec| Shape::<T, FLAT>::or_zero(spec);
        let (axial, permittivity) = (beam.axial.as_ref(), beam.permittivity.as_ref());
        match (axial, electric.and(permittivity)) {
            (None, None) => {
                let scene = Scene::new(self.length, Beam::elastic(bending));
                self.on_foundation(scene, (), task)
            }
            (Some(_), None) => {
                let beam = Beam { bending, axial: shape(axial), piezo: (), permittivity: () };
                self.on_foundation(Scene::new(self.length, beam), shape(file.load.axial.as_ref()), task)
            }
            (None, Some(_)) => {
                let permittivity = shape(permittivity);
                let beam = Beam { bending, axial: (), piezo: (), permittivity };
                let scene = Scene::new(self.length, beam).potential(self.ends());
                self.on_foundation(scene.conduction(self.conduction()), (), task)
            }
            (Some(_), Some(_)) => {
                let (axial, permittivity) = (shape(axial), shape(permittivity));
                let piezo = shape(beam.piezo.as_ref());
                let beam = Beam { bending, axial, piezo, permittivity };
                let scene = Scene::new(self.length, beam).potential(self.ends());
                let load = shape(file.load.axial.as_ref());
                self.on_foundation(scene.conduction(self.conduction()), load, task)
            }
        }
    }

    fn conduction(&self) -> Conduction<T, Shape<T, FLAT>, Shape<T, FLAT>> {
        let table = self.file.conduction.as_ref().unwrap_or(&NO_CONDUCTION);
        let potential = table.potential_truncation.unwrap_or(table.truncation);
        Conduction {
            mu1: Shape::or_zero(table.mu1.as_ref()),
            mu2: Shape::or_zero(table.mu2.as_ref()),
            truncation: T::of(table.truncation),
            potential_truncation: T::of(potential),
        }
    }

    fn ends(&self) -> Potential<T> {
        let (left, right) = self.file.potential.as_ref().map_or((0.0, 0.0), |p| (p.left, p.right));
        Potential { left: T::of(left), right: T::of(right) }
    }

    fn on_foundation<K: Task, B, Q, V, A>(
        &self,
        scene: Scene<T, B, (), Q, (), V>,
        axial: A,
        task: K,
    ) -> Result<K::Output, Error>
    where
        B: piezobeam::BeamPart<T>,
        Q: piezobeam::ConductionPart<T>,
        V: piezobeam::PotentialPart<T>,
        A: Profile<T>,
    {
        let mut points: Vec<PointLoad<T>> = (self.file.load.points.iter())
            .map(|p| PointLoad { x: T::of(p.x), force: T::of(p.force), moment: T::of(p.moment) })
            .collect();
        points.sort_by(|a, b| a.x.f64().total_cmp(&b.x.f64()));
        let transverse = Shape::<T, false>::or_zero(self.file.load.transverse.as_ref());
        let scene = scene.load(Load { transverse, axial, points: points.as_slice() });
        let Some(table) = &self.file.foundation else { return self.finish(scene, task) };
        let stiffness = Shape::<T, FLAT>::new(&table.stiffness);
        // A gap that is zero is left out of the type only where that is worth a solver.
        let lean = |gap: &&ProfileSpec| !K::LEAN || !gap.is_zero();
        let gap = table.gap.as_ref().filter(lean).map(Shape::<T, false>::new);
        let exponent = T::of(table.exponent);
        match (exponent == T::one(), gap) {
            (true, None) if K::LEAN => {
                self.finish(scene.foundation(Foundation { law: Linear(stiffness), gap: () }), task)
            }
            (true, gap) => {
                let gap = gap.unwrap_or_else(|| Shape::or_zero(None));
                self.finish(scene.foundation(Foundation { law: Linear(stiffness), gap }), task)
            }
            (false, gap) => {
                let law = Power { stiffness, exponent };
                let gap = gap.unwrap_or_else(|| Shape::or_zero(None));
                self.finish(scene.foundation(Foundation { law, gap }), task)
            }
        }
    }

    fn finish<K: Task, M: Model<T>>(&self, scene: M, task: K) -> Result<K::Output, Error> {
        let mesh = &self.file.mesh;
        let nodes: Vec<T>;
        let mesh = match (self.elements, &mesh.nodes) {
            (None, Some(given)) => {
                nodes = given.iter().map(|&x| T::of(x)).collect();
                Mesh::Nodes(&nodes)
            }
            (elements, _) => Mesh::uniform(elements.or(mesh.elements).unwrap_or(ELEMENTS)),
        };
        task.run(Problem::new(scene, mesh)?)
    }
}
