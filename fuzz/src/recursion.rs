//! The block recursion, through the library, against dense elimination in nodal unknowns, which needs more digits.

use crate::exact::{Exact, double, exact};
use arbitrary::{Arbitrary, Unstructured};
use piezobeam::{
    Beam, Foundation, HeapWorkspace, Linear, Load, Mesh, Model, PointLoad, Problem, Profile, Scene, Settings,
    Status, Steps,
};

/// An element: its length, stiffness and load in quarters of a decade off 1, and the load at its right node.
#[derive(Arbitrary, Clone, Copy, Debug)]
struct Part {
    length: i8,
    bending: i8,
    load: i8,
    force: i8,
    moment: i8,
    stiffness: u8,
}

#[derive(Arbitrary, Debug)]
struct Input {
    parts: Vec<Part>,
    /// All of the beam is pressed into a foundation.
    pressed: bool,
}

/// 10 to the power of so many quarters, within `decades`.
fn off(quarters: i8, decades: f64) -> f64 {
    10f64.powf(f64::from(quarters) / 128.0 * decades)
}

/// The nodes' deflections and slopes as the dense solution has them, and no tension.
pub fn recursion(data: &[u8]) {
    let Ok(input) = Input::arbitrary(&mut Unstructured::new(data)) else { return };
    let parts = &input.parts[..input.parts.len().min(10)];
    if parts.len() < 2 {
        return;
    }
    let mut nodes = vec![0.0];
    for part in parts {
        nodes.push(nodes[nodes.len() - 1] + off(part.length, 2.0));
    }
    let length = nodes[nodes.len() - 1];
    let inner = &nodes[1..nodes.len() - 1];
    let bending: Vec<f64> = parts.iter().map(|p| off(p.bending, 3.0)).collect();
    let load: Vec<f64> = parts.iter().map(|p| f64::from(p.load)).collect();
    let points: Vec<PointLoad<f64>> = parts
        .iter()
        .zip(inner)
        .map(|(p, &x)| PointLoad {
            x,
            force: f64::from(p.force) * length,
            moment: f64::from(p.moment) * length,
        })
        .collect();
    let soft = bending.iter().copied().fold(f64::INFINITY, f64::min) / length.powi(4);
    let stiffness: Vec<f64> = parts.iter().map(|p| soft * off((p.stiffness / 2) as i8, 4.0)).collect();
    let free = dense(&nodes, &bending, &load, &points, None);
    let size = free.iter().map(|d| d[0].abs().max(d[1].abs() * length)).fold(0.0, f64::max);
    let depth = 4.0 * size;
    let scene = Scene::new(length, Beam::elastic(Steps { breaks: inner, values: &bending })).load(Load {
        transverse: Steps { breaks: inner, values: &load },
        axial: (),
        points: points.as_slice(),
    });
    if input.pressed {
        let want = dense(&nodes, &bending, &load, &points, Some((&stiffness, depth)));
        let law = Linear(Steps { breaks: inner, values: &stiffness });
        let scene = scene.foundation(Foundation { law, gap: -depth });
        compare(&scene, &nodes, &want, 8.0 * size.max(depth));
    } else {
        compare(&scene, &nodes, &free, size);
    }
}

fn compare<M: Model<f64> + std::fmt::Debug>(scene: &M, nodes: &[f64], want: &[[f64; 2]], size: f64) {
    let problem = Problem::new(scene, Mesh::Nodes(nodes)).expect("a scene without mistakes");
    let mut memory = HeapWorkspace::new();
    let solution = problem.solve(&mut memory, &Settings::default()).expect("settings in range");
    let report = solution.report();
    let status = report.status;
    assert!(matches!(status, Status::Converged | Status::ToleranceBelowFloor), "{report:?} {scene:?}");
    let length = scene.length();
    // Where the foundation has pushed the beam off, the dense system is another one.
    let zones = solution.zones();
    if M::Gap::PRESENT && zones != [[0.0, length]] {
        return;
    }
    for (&x, [w, theta]) in nodes.iter().zip(want) {
        let f = solution.at(x);
        let departure = (f.bending - w).abs().max((f.slope - theta).abs() * length);
        assert!(departure <= 1e-7 * size, "{f:?}, {w:e}, {theta:e}: {report:?} {scene:?}");
        assert!(f.pressure.is_none_or(|p| p >= 0.0), "{f:?}: {scene:?}");
    }
}

/// Deflection and slope at all nodes by Gauss's elimination of the nodal system.
fn dense(
    nodes: &[f64],
    bending: &[f64],
    load: &[f64],
    points: &[PointLoad<f64>],
    ground: Option<(&[f64], f64)>,
) -> Vec<[f64; 2]> {
    let n = 2 * nodes.len();
    let mut a = vec![vec![exact(0.0); n + 1]; n];
    for (i, pair) in nodes.windows(2).enumerate() {
        let h = exact(pair[1]) - exact(pair[0]);
        let c = exact(bending[i]) / (&h * &h * &h);
        let units = [exact(1.0), h.clone(), exact(1.0), h.clone()];
        // Textbook matrices in (w, h theta) of both ends.
        const BEND: [[f64; 4]; 4] =
            [[12., 6., -12., 6.], [6., 4., -6., 2.], [-12., -6., 12., -6.], [6., 2., -6., 4.]];
        const LIE: [[f64; 4]; 4] =
            [[156., 22., 54., -13.], [22., 4., 13., -3.], [54., 13., 156., -22.], [-13., -3., -22., 4.]];
        const PRESS: [f64; 4] = [6., 1., 6., -1.];
        let (stiffness, depth) = ground.map_or((0.0, 0.0), |(k, depth)| (k[i], depth));
        let lie = exact(stiffness) * &h / exact(420.0);
        let push = (exact(load[i]) - exact(stiffness) * exact(depth)) * &h / exact(12.0);
        for r in 0..4 {
            for s in 0..4 {
                let entry = &c * exact(BEND[r][s]) + &lie * exact(LIE[r][s]);
                a[2 * i + r][2 * i + s] += entry * &units[r] * &units[s];
            }
            a[2 * i + r][n] += &push * exact(PRESS[r]) * &units[r];
        }
    }
    for (i, point) in points.iter().enumerate() {
        a[2 * i + 2][n] += exact(point.force);
        a[2 * i + 3][n] += exact(point.moment);
    }
    for held in [0, 1, n - 2, n - 1] {
        a[held] = vec![exact(0.0); n + 1];
        a[held][held] = exact(1.0);
    }
    for pivot in 0..n {
        // Symmetric and positive definite, but for the rows that are held: any pivot does.
        let above = a[pivot].clone();
        for row in a.iter_mut().skip(pivot + 1) {
            let factor = &row[pivot] / &above[pivot];
            for (entry, of) in row.iter_mut().zip(&above).skip(pivot) {
                *entry -= &factor * of;
            }
        }
    }
    let mut x: Vec<Exact> = vec![exact(0.0); n];
    for row in (0..n).rev() {
        let rest = (row + 1..n).fold(a[row][n].clone(), |sum, column| sum - &a[row][column] * &x[column]);
        x[row] = rest / &a[row][row];
    }
    x.chunks(2).map(|d| [double(&d[0]), double(&d[1])]).collect()
}
