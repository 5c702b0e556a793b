//! Whole solves from nothing, and the fields of a solution.
#![allow(missing_docs, reason = "criterion's macros write functions without any")]
#![allow(clippy::expect_used, reason = "a benchmark of a scene that is refused has nothing to measure")]

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use piezobeam::{
    Beam, Conduction, Foundation, HeapWorkspace, Linear, Load, Mesh, Model, Potential, Problem, Profile,
    Real, Scene, Settings, Smooth, Status, Steps,
};
use std::hint::black_box;

/// A number that is a scalar of the solver and a profile.
trait Number: Real + Smooth<Self> + Profile<Self> {}
impl Number for f32 {}
impl Number for f64 {}

fn beam<T: Number>() -> Scene<T, Beam<T>, (), (), Load<T>> {
    Scene::new(T::one(), Beam::elastic(T::of(5e3))).load(Load {
        transverse: T::of(1e6),
        axial: (),
        points: (),
    })
}

fn law<T: Number>() -> Linear<T> {
    Linear(T::of(1e8))
}

/// A parabola of height 1 mm in the middle.
fn gap<T: Number>(x: T) -> [T; 3] {
    let depth = T::of(4e-3);
    [depth * x * (T::one() - x), depth * (T::one() - x - x), -(depth + depth)]
}

fn full<T: Number>() -> impl Model<T> {
    Scene::new(
        T::one(),
        Beam { bending: T::of(5e3), axial: T::of(1e5), piezo: T::of(100.0), permittivity: T::one() },
    )
    .foundation(Foundation { law: law::<T>(), gap: () })
    .conduction(Conduction::new(T::one(), T::one(), T::one()))
    .load(Load { transverse: T::of(1e6), axial: T::of(1e6), points: () })
    .potential(Potential { left: T::one(), right: T::one() })
}

/// Down on the left half, up on the right one, on a foundation that is all but rigid.
fn halves() -> impl Model<f64> {
    Scene::new(1.0, Beam::elastic(5e3)).foundation(Foundation { law: Linear(1e16), gap: () }).load(Load {
        transverse: Steps { breaks: &[0.5], values: &[1e6, -1e6] },
        axial: (),
        points: (),
    })
}

fn scenes<T: Number>(criterion: &mut Criterion) {
    let scalar = core::any::type_name::<T>();
    let contact = || beam::<T>().foundation(Foundation { law: law::<T>(), gap: () });
    let gap = || beam::<T>().foundation(Foundation { law: law::<T>(), gap: piezobeam::Curve(gap::<T>) });
    solves(criterion, &format!("bending/{scalar}"), beam::<T>);
    solves(criterion, &format!("contact/{scalar}"), contact);
    solves(criterion, &format!("contact and gap/{scalar}"), gap);
    solves(criterion, &format!("full/{scalar}"), full::<T>);
}

fn solves<T: Number, M: Model<T>>(criterion: &mut Criterion, name: &str, scene: impl Fn() -> M) {
    let mut group = criterion.benchmark_group(name);
    for elements in [100, 1000] {
        let problem = Problem::new(scene(), Mesh::uniform(elements)).expect("a scene");
        let mut memory = HeapWorkspace::new();
        let mut prepared = problem.prepare(&mut memory).expect("a mesh");
        let settings = Settings::default();
        let report = prepared.solve(&settings).expect("settings");
        assert_eq!(report.status, Status::Converged, "{name}: {report:?}");
        group.throughput(Throughput::Elements(elements as u64));
        group.bench_function(BenchmarkId::from_parameter(elements), |b| {
            b.iter(|| black_box(&mut prepared).solve(black_box(&settings)));
        });
    }
    group.finish();
}

fn double(criterion: &mut Criterion) {
    scenes::<f64>(criterion);
}

fn single(criterion: &mut Criterion) {
    scenes::<f32>(criterion);
}

fn stiff(criterion: &mut Criterion) {
    solves(criterion, "halves, k = 1e16/f64", halves);
}

fn fields(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("fields at a point");
    sample(&mut group, "bending", beam::<f64>());
    sample(&mut group, "contact", beam::<f64>().foundation(Foundation { law: law::<f64>(), gap: () }));
    sample(&mut group, "full", full::<f64>());
    group.finish();
}

type Group<'a> = criterion::BenchmarkGroup<'a, criterion::measurement::WallTime>;

fn sample<M: Model<f64>>(group: &mut Group<'_>, name: &str, scene: M) {
    let problem = Problem::new(scene, Mesh::uniform(1000)).expect("a scene");
    let mut memory = HeapWorkspace::new();
    let solution = problem.solve(&mut memory, &Settings::default()).expect("a solve");
    let mut x = 0.0;
    group.bench_function(name, |b| {
        b.iter(|| {
            // The golden section's multiples visit the beam evenly, never twice the same point.
            x += 0.618_033_988_749_894_9;
            x -= f64::floor(x);
            solution.at(black_box(x))
        });
    });
}

criterion_group!(benches, double, single, stiff, fields);
criterion_main!(benches);
