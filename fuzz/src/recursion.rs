//! The block recursion, through the library, against Gauss's elimination in nodal unknowns, which needs more digits.

use crate::exact::{Digits, Double, Exact};
use arbitrary::{Arbitrary, Unstructured};
use piezobeam::{
    Beam, Foundation, HeapWorkspace, Linear, Load, Mesh, Model, PointLoad, Problem, Profile, Scene, Settings,
    Status, Steps,
};
use std::fmt::Debug;

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

/// The nodes' deflections and slopes as the elimination has them, and no tension.
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
    let chain = Chain { nodes: &nodes, bending: &bending, load: &load, points: &points };
    let free = chain.solve::<Double>(None);
    let size = free.iter().map(|d| d[0].abs().max(d[1].abs() * length)).fold(0.0, f64::max);
    let depth = 4.0 * size;
    let scene = Scene::new(length, Beam::elastic(Steps { breaks: inner, values: &bending })).load(Load {
        transverse: Steps { breaks: inner, values: &load },
        axial: (),
        points: points.as_slice(),
    });
    if input.pressed {
        let ground = Some((stiffness.as_slice(), depth));
        let law = Linear(Steps { breaks: inner, values: &stiffness });
        let scene = scene.foundation(Foundation { law, gap: -depth });
        compare(&scene, &chain, ground, 8.0 * size.max(depth));
    } else {
        compare(&scene, &chain, None, size);
    }
}

fn compare<M: Model<f64> + Debug>(scene: &M, chain: &Chain<'_>, ground: Ground<'_>, size: f64) {
    let problem = Problem::new(scene, Mesh::Nodes(chain.nodes)).expect("a scene without mistakes");
    let mut memory = HeapWorkspace::new();
    let solution = problem.solve(&mut memory, &Settings::default()).expect("settings in range");
    let report = solution.report();
    let status = report.status;
    assert!(matches!(status, Status::Converged | Status::ToleranceBelowFloor), "{report:?} {scene:?}");
    let length = scene.length();
    // Where the foundation has pushed the beam off, the nodal system is another one.
    let zones = solution.zones();
    if M::Gap::PRESENT && zones != [[0.0, length]] {
        return;
    }
    let fields: Vec<_> = chain.nodes.iter().map(|&x| solution.at(x)).collect();
    assert!(fields.iter().all(|f| f.pressure.is_none_or(|p| p >= 0.0)), "tension: {fields:?} {scene:?}");
    let agree = |want: &[[f64; 2]]| {
        fields
            .iter()
            .zip(want)
            .all(|(f, [w, theta])| (f.bending - w).abs().max((f.slope - theta).abs() * length) <= 1e-7 * size)
    };
    // 106 bits agree but for chains that cost them 80; then 160 decide.
    if !agree(&chain.solve::<Double>(ground)) {
        let want = chain.solve::<Exact>(ground);
        assert!(agree(&want), "{fields:?} {want:?}: {report:?} {scene:?}");
    }
}

/// Stiffnesses of a foundation, and how deep it is pressed in.
type Ground<'a> = Option<(&'a [f64], f64)>;

/// A chain of elements.
struct Chain<'a> {
    nodes: &'a [f64],
    bending: &'a [f64],
    load: &'a [f64],
    points: &'a [PointLoad<f64>],
}

/// How far apart nodal unknowns of one element are.
const BAND: usize = 4;

impl Chain<'_> {
    /// Deflection and slope at all nodes by Gauss's elimination of the nodal system.
    fn solve<D: Digits>(&self, ground: Ground<'_>) -> Vec<[f64; 2]> {
        let n = 2 * self.nodes.len();
        let of = D::of;
        // Row r has its columns r - 3 to r + 3, and the right side at the end.
        let none: [D; 2 * BAND] = std::array::from_fn(|_| of(0.0));
        let place = |row: usize, column: usize| BAND - 1 + column - row;
        let mut a = vec![none.clone(); n];
        for (i, pair) in self.nodes.windows(2).enumerate() {
            let h = of(pair[1]) - of(pair[0]);
            let c = of(self.bending[i]) / (h.clone() * h.clone() * h.clone());
            let units = [of(1.0), h.clone(), of(1.0), h.clone()];
            // Textbook matrices in (w, h theta) of both ends.
            const BEND: [[f64; 4]; 4] =
                [[12., 6., -12., 6.], [6., 4., -6., 2.], [-12., -6., 12., -6.], [6., 2., -6., 4.]];
            const LIE: [[f64; 4]; 4] =
                [[156., 22., 54., -13.], [22., 4., 13., -3.], [54., 13., 156., -22.], [-13., -3., -22., 4.]];
            const PRESS: [f64; 4] = [6., 1., 6., -1.];
            let (stiffness, depth) = ground.map_or((0.0, 0.0), |(k, depth)| (k[i], depth));
            let lie = of(stiffness) * h.clone() / of(420.0);
            let push = (of(self.load[i]) - of(stiffness) * of(depth)) * h / of(12.0);
            for r in 0..4 {
                for s in 0..4 {
                    let entry = c.clone() * of(BEND[r][s]) + lie.clone() * of(LIE[r][s]);
                    add(&mut a[2 * i + r][place(r, s)], entry * units[r].clone() * units[s].clone());
                }
                add(&mut a[2 * i + r][2 * BAND - 1], push.clone() * of(PRESS[r]) * units[r].clone());
            }
        }
        for (i, point) in self.points.iter().enumerate() {
            add(&mut a[2 * i + 2][2 * BAND - 1], of(point.force));
            add(&mut a[2 * i + 3][2 * BAND - 1], of(point.moment));
        }
        for held in [0, 1, n - 2, n - 1] {
            a[held] = none.clone();
            a[held][place(held, held)] = of(1.0);
        }
        for pivot in 0..n {
            // Symmetric and positive definite, but for the rows that are held: any pivot does.
            let above = a[pivot].clone();
            let end = n.min(pivot + BAND);
            for row in pivot + 1..end {
                let factor = a[row][place(row, pivot)].clone() / above[place(pivot, pivot)].clone();
                for column in pivot..end {
                    let part = factor.clone() * above[place(pivot, column)].clone();
                    take(&mut a[row][place(row, column)], part);
                }
                take(&mut a[row][2 * BAND - 1], factor * above[2 * BAND - 1].clone());
            }
        }
        let mut x: Vec<D> = vec![of(0.0); n];
        for row in (0..n).rev() {
            let rest = (row + 1..n.min(row + BAND)).fold(a[row][2 * BAND - 1].clone(), |sum, column| {
                sum - a[row][place(row, column)].clone() * x[column].clone()
            });
            x[row] = rest / a[row][place(row, row)].clone();
        }
        x.chunks(2).map(|d| [d[0].near(), d[1].near()]).collect()
    }
}

fn add<D: Digits>(sum: &mut D, part: D) {
    *sum = sum.clone() + part;
}

fn take<D: Digits>(sum: &mut D, part: D) {
    *sum = sum.clone() - part;
}
