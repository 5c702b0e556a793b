//! The paper's own methods beside the solver's: what they find, what it costs them, and how each end is called.
//!
//! `cargo run --release --example methods`

use piezobeam::{
    Beam, BermudezMoreno, Error, Foundation, HeapWorkspace, Linear, Load, Mesh, Method, Model, Problem,
    Report, Scene, Settings, Steps,
};

/// The paper's methods with their names; `None` is the solver's own.
const METHODS: [(&str, Option<Method<f64>>); 4] = [
    ("kinks exact", None),
    ("Gauss points", Some(Method::Gauss)),
    ("by elements", Some(Method::Elementwise)),
    ("Bermúdez-Moreno", Some(Method::BermudezMoreno(BermudezMoreno { omega: None, mu: None, rho: None }))),
];

/// The report, the lowest contact pressure, and the bending at k L / 8, k = 1 .. 7.
fn solved(
    scene: &impl Model<f64>,
    elements: usize,
    method: Option<Method<f64>>,
) -> Result<(Report<f64>, f64, [f64; 7]), Error> {
    let problem = Problem::new(scene, Mesh::uniform(elements))?;
    let mut memory = HeapWorkspace::new();
    let mut beam = problem.prepare(&mut memory)?;
    let settings = Settings::default();
    let (report, lowest) = match method {
        None => (beam.solve(&settings)?, 0.0),
        Some(method) => {
            let found = beam.solve_by(&method, &settings)?;
            (found.report, found.lowest_pressure)
        }
    };
    let at = |k: u32| beam.last().map_or(f64::NAN, |solution| solution.at(f64::from(k) / 8.0).bending);
    Ok((report, lowest, [1, 2, 3, 4, 5, 6, 7].map(at)))
}

fn main() -> Result<(), Error> {
    println!("A load of 1e6 N/m that presses the left half and lifts the right half, C = 5000 N m^2\n");
    println!(
        "| method | k [N/m^2] | elements | iterations | xi(L/2) [m] | residual | lowest pressure [N/m] | status |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for (k, elements) in [(1e8, 96), (1e12, 24), (1e12, 96), (1e16, 96)] {
        let transverse = Steps { breaks: &[0.5], values: &[1e6, -1e6] };
        let scene = Scene::new(1.0, Beam::elastic(5000.0))
            .foundation(Foundation { law: Linear(k), gap: () })
            .load(Load { transverse, axial: (), points: () });
        for (name, method) in METHODS {
            let (report, lowest, xi) = solved(&scene, elements, method)?;
            println!(
                "| {name} | {k:.0e} | {elements} | {} | {:.8} | {:.0e} | {lowest:.0e} | {} |",
                report.iterations,
                xi[3],
                report.residual,
                report.status.name()
            );
        }
    }

    println!(
        "\nError of xi at k L / 8 over its maximum: a load of 2e6 N/m over a gap of 0.3 m, k = 1e9 N/m^2\n"
    );
    let scene = Scene::new(1.0, Beam::elastic(5000.0))
        .foundation(Foundation { law: Linear(1e9), gap: 0.3 })
        .load(Load { transverse: 2e6, axial: (), points: () });
    let (_, _, exact) = solved(&scene, 4096, None)?;
    let size = exact.iter().fold(0.0_f64, |most, xi| most.max(xi.abs()));
    println!("| elements | {} |", METHODS.map(|(name, _)| name).join(" | "));
    println!("|---|---|---|---|---|");
    for elements in [8, 16, 32, 64, 128, 256, 512] {
        let mut errors = Vec::new();
        for (_, method) in METHODS {
            let (report, _, xi) = solved(&scene, elements, method)?;
            let error = xi.iter().zip(exact).fold(0.0_f64, |most, (got, want)| most.max((got - want).abs()));
            errors.push(format!("{:.0e} ({})", error / size, report.iterations));
        }
        println!("| {elements} | {} |", errors.join(" | "));
    }
    Ok(())
}
