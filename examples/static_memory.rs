//! A solve in memory of a fixed size: no heap, no features but elementary functions
//! (`cargo run --example static_memory --no-default-features --features libm`).

use piezobeam::{Beam, Error, Foundation, Linear, Load, Mesh, Problem, Scene, Settings, Status, Workspace};

/// A beam that bends, on a foundation, under a load per length.
type Simple = Scene<f64, Beam<f64>, Foundation<Linear<f64>>, (), Load<f64>>;

/// 60 elements, a third of that for the coarser meshes, and some to spare for the mesh's own nodes.
type Memory = Workspace<f64, Simple, 88>;

// Known when the program is built, so that it can be held against what a device has.
const _: () = assert!(size_of::<Memory>() == 88 * Memory::BYTES_PER_ELEMENT);
const _: () = assert!(size_of::<Memory>() <= 48 * 1024);

fn main() -> Result<(), Error> {
    let scene = Scene::new(1.0, Beam::elastic(5e3))
        .foundation(Foundation { law: Linear(3.2e5), gap: () })
        .load(Load { transverse: 1e6, axial: (), points: () });
    let problem = Problem::new(scene, Mesh::uniform(60))?;
    let mut memory = Memory::new();
    let solution = problem.solve(&mut memory, &Settings::default())?;
    assert_eq!(solution.report().status, Status::Converged);

    // All of the beam is in contact, so that it is one on an elastic foundation: with b^4 = k / (4 C) and
    // b L = 2 the middle is at f / k (1 - 2 (cosh 1 sin 1 + sinh 1 cos 1) / (sinh 2 + sin 2)).
    let deflection = solution.at(0.5).bending;
    let exact = 0.461_097_024_911_755;
    assert!((deflection / exact - 1.0).abs() < 1e-8, "{deflection} instead of {exact}");

    // A mesh that the memory has no room for is refused.
    let finer = Problem::new(*problem.scene(), Mesh::uniform(89))?;
    let refused = finer.solve(&mut Memory::new(), &Settings::default()).err();
    assert_eq!(refused, Some(Error::Capacity { needed: 89, available: 88 }));

    println!("{} bytes, deflection in the middle {deflection} m", size_of::<Memory>());
    Ok(())
}

#[test]
fn holds() -> Result<(), Error> {
    main()
}
