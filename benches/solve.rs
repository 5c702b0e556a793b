//! Processor times of whole solves from nothing, of a step of a `History`, and of what is done before and after a solve.
#![allow(missing_docs, reason = "criterion's macros write functions without any")]
#![allow(clippy::expect_used, reason = "a benchmark of a scene that is refused has nothing to measure")]

mod scenes;

use cpu_time::ThreadTime;
use criterion::measurement::{Measurement, ValueFormatter, WallTime};
use criterion::{BenchmarkGroup, BenchmarkId, Throughput, criterion_group, criterion_main};
use piezobeam::{HeapWorkspace, History, Mesh, Model, Output, Parameter, Problem, Real, Settings, Status};
use scenes::Visit;
use std::hint::black_box;
use std::time::Duration;

const SIZES: [usize; 3] = [100, 1000, 10_000];

type Criterion = criterion::Criterion<Processor>;
type Group<'a> = BenchmarkGroup<'a, Processor>;

/// Time of this thread on its processor: other programs may share the machine.
struct Processor;

impl Measurement for Processor {
    type Intermediate = ThreadTime;
    type Value = Duration;

    fn start(&self) -> ThreadTime {
        ThreadTime::now()
    }

    fn end(&self, start: ThreadTime) -> Duration {
        start.elapsed()
    }

    fn add(&self, a: &Duration, b: &Duration) -> Duration {
        *a + *b
    }

    fn zero(&self) -> Duration {
        Duration::ZERO
    }

    fn to_f64(&self, value: &Duration) -> f64 {
        WallTime.to_f64(value)
    }

    fn formatter(&self) -> &dyn ValueFormatter {
        WallTime.formatter()
    }
}

/// A group whose times settle quickly: solves have no noise of their own.
fn group<'a>(criterion: &'a mut Criterion, name: &str) -> Group<'a> {
    let mut group = criterion.benchmark_group(name);
    group.sample_size(20).warm_up_time(Duration::from_millis(200)).measurement_time(Duration::from_secs(1));
    group
}

fn double(criterion: &mut Criterion) {
    scenes::each_and_rigid(&mut Solves(criterion));
}

fn single(criterion: &mut Criterion) {
    scenes::each::<f32>(&mut Solves(criterion));
}

/// Solves from nothing.
struct Solves<'a>(&'a mut Criterion);

impl<T: Real> Visit<T> for Solves<'_> {
    fn visit<M: Model<T>>(&mut self, name: &str, scene: M) {
        let mut group = group(self.0, &format!("{name}/{}", core::any::type_name::<T>()));
        let mut problem = Problem::new(scene, Mesh::uniform(1)).expect("a scene");
        for elements in SIZES {
            problem = problem.on(Mesh::uniform(elements)).expect("a mesh");
            let mut memory = HeapWorkspace::new();
            let mut prepared = problem.prepare(&mut memory).expect("profiles");
            let settings = Settings::default();
            let report = prepared.solve(&settings).expect("settings");
            assert_eq!(report.status, Status::Converged, "{name} on {elements}: {report:?}");
            group.throughput(Throughput::Elements(elements as u64));
            group.bench_function(BenchmarkId::from_parameter(elements), |b| {
                b.iter(|| black_box(&mut prepared).solve(black_box(&settings)));
            });
        }
    }
}

fn step(criterion: &mut Criterion) {
    let mut group = group(criterion, "step");
    for elements in SIZES {
        let mut memory = HeapWorkspace::new();
        let mut history = History::new(Mesh::uniform(elements), &mut memory);
        let mut turn = 0;
        group.throughput(Throughput::Elements(elements as u64));
        group.bench_function(BenchmarkId::from_parameter(elements), |b| {
            b.iter(|| {
                turn += 1;
                let scene = scenes::step(turn);
                let solution = history.solve(black_box(&scene), &Settings::default()).expect("a scene");
                assert_eq!(solution.report().status, Status::Converged);
            });
        });
    }
}

fn around(criterion: &mut Criterion) {
    scenes::each::<f64>(&mut Around(criterion));
}

/// What is done before and after a solve, on 1000 elements: sampling the scene, fields, resultants, derivatives,
/// the error.
struct Around<'a>(&'a mut Criterion);

impl Visit<f64> for Around<'_> {
    fn visit<M: Model<f64>>(&mut self, name: &str, scene: M) {
        let mut group = group(self.0, &format!("around {name}"));
        let problem = Problem::new(scene, Mesh::uniform(1000)).expect("a scene");
        let mut memory = HeapWorkspace::new();
        group.bench_function("prepare", |b| {
            b.iter(|| problem.prepare(black_box(&mut memory)).expect("profiles").elements());
        });
        let mut prepared = problem.prepare(&mut memory).expect("profiles");
        let settings = Settings::default();
        let solution = prepared.solution(&settings).expect("settings");
        assert_eq!(solution.report().status, Status::Converged, "{name}");
        let mut x = 0.0;
        group.bench_function("fields at a point", |b| {
            b.iter(|| {
                // The golden section's multiples visit the beam evenly, never twice the same point.
                x += 0.618_033_988_749_894_9;
                x -= f64::floor(x);
                solution.at(black_box(x))
            });
        });
        group.bench_function("resultants", |b| b.iter(|| black_box(&solution).resultants()));
        let mut finer = HeapWorkspace::new();
        group.bench_function("certify", |b| {
            b.iter(|| solution.certify(black_box(&mut finer), &settings).expect("a finer mesh"));
        });
        group.bench_function("tangent", |b| {
            b.iter(|| {
                let tangent = black_box(&mut prepared).tangent(Parameter::Bending).expect("a derivative");
                tangent.of(Output::LeftMoment)
            });
        });
        group.bench_function("adjoint", |b| {
            b.iter(|| {
                let adjoint = black_box(&mut prepared).adjoint(Output::LeftMoment).expect("a derivative");
                adjoint.to(Parameter::Bending)
            });
        });
    }
}

criterion_group! {
    name = benches;
    config = criterion::Criterion::default().with_measurement(Processor);
    targets = double, single, step, around
}
criterion_main!(benches);
