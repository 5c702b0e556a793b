//! What a user would write around a linear algebra library: cubic Hermite elements for the penetration, P1 elements for
//! u and q, contact decided at four Gauss points per element, a semismooth Newton method nested with the (u, q) system.

use crate::cholesky::{Cholesky, NotDefinite, Pattern};
use crate::scene::{
    ALONG, AXIAL, BENDING, MU1, MU2, PERMITTIVITY, PIEZO, POTENTIAL, Scene, TRANSVERSE, TRUNCATION,
};

/// Largest relative move of a field between two iterates that have converged.
const STOP: f64 = 1e-10;
/// Newton steps between two renewals of u and q, and renewals.
const CAP: usize = 200;

/// Abscissae and weights on [0, 1].
const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_1),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_1),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

/// The lower triangle of a symmetric 4x4 matrix.
const TRIANGLE: [(usize, usize); 10] =
    [(0, 0), (1, 0), (2, 0), (3, 0), (1, 1), (2, 1), (3, 1), (2, 2), (3, 2), (3, 3)];

/// A Gauss point's part of an element.
struct Point {
    t: f64,
    weight: f64,
    /// Shape functions of (w, theta) left and right.
    shape: [f64; 4],
    curvature: [f64; 4],
    mass: [f64; 10],
}

#[derive(Clone, Copy, Default, PartialEq)]
enum Branch {
    #[default]
    Free,
    Contact,
    Truncated,
}

/// How a solve ended.
pub struct End {
    pub converged: bool,
    pub steps: usize,
}

pub struct Peer<C> {
    scene: Scene,
    elements: usize,
    points: [Point; 4],
    stiffness: [f64; 10],
    load: Vec<f64>,
    /// Of each element's triangle in `values`; clamped entries go to one more at the end.
    slots: Vec<[usize; 10]>,
    values: Vec<f64>,
    side: Vec<f64>,
    bending: C,
    laplace: C,
    branches: Vec<[Branch; 4]>,
    /// (w, theta) of the penetration at each node.
    eta: Vec<f64>,
    u: Vec<f64>,
    q: Vec<f64>,
}

impl<C: Cholesky> Peer<C> {
    /// What no iterate changes: shapes, loads, patterns, the Laplace operator of u and q.
    pub fn new(scene: Scene, elements: usize) -> Self {
        let h = 1.0 / elements as f64;
        let points = GAUSS.map(|(t, weight)| {
            let shape = [
                1.0 - t * t * (3.0 - 2.0 * t),
                h * t * (1.0 - t) * (1.0 - t),
                t * t * (3.0 - 2.0 * t),
                h * t * t * (t - 1.0),
            ];
            let curvature = [
                (12.0 * t - 6.0) / (h * h),
                (6.0 * t - 4.0) / h,
                (6.0 - 12.0 * t) / (h * h),
                (6.0 * t - 2.0) / h,
            ];
            let weight = weight * h;
            Point { t, weight, shape, curvature, mass: TRIANGLE.map(|(i, j)| weight * shape[i] * shape[j]) }
        });
        let stiffness = TRIANGLE
            .map(|(i, j)| points.iter().map(|p| BENDING * p.weight * p.curvature[i] * p.curvature[j]).sum());
        let mut load = vec![0.0; 2 * (elements + 1)];
        for element in 0..elements {
            for p in &points {
                let [_, _, bend] = scene.gap((element as f64 + p.t) * h);
                for i in 0..4 {
                    load[2 * element + i] +=
                        p.weight * (TRANSVERSE * p.shape[i] - BENDING * bend * p.curvature[i]);
                }
            }
        }
        let pattern = Pattern::block_tridiagonal(elements - 1, 2, C::ROOM);
        let room = pattern.rows.len();
        let slot = |element: usize, (row, column): (usize, usize)| {
            let free = |i: usize| (2 * element + i).checked_sub(2).filter(|&i| i < pattern.order());
            free(row).zip(free(column)).map_or(room, |(row, column)| pattern.slot(row, column))
        };
        let slots = (0..elements).map(|e| TRIANGLE.map(|entry| slot(e, entry))).collect();
        let line = Pattern::block_tridiagonal(elements - 1, 1, C::ROOM);
        let mut values = vec![-1.0 / h; line.rows.len()];
        (0..elements - 1).for_each(|i| values[line.slot(i, i)] = 2.0 / h);
        let mut laplace = C::new(&line);
        laplace.factor(&values).expect("a definite matrix");
        Self {
            scene,
            elements,
            points,
            stiffness,
            slots,
            values: vec![0.0; room + 1],
            side: load.clone(),
            bending: C::new(&pattern),
            laplace,
            branches: vec![Default::default(); elements],
            eta: vec![0.0; load.len()],
            load,
            u: vec![0.0; elements + 1],
            q: vec![POTENTIAL; elements + 1],
        }
    }

    /// Bending, u and q at each node.
    pub fn answer(&self) -> Vec<[f64; 3]> {
        let bending = |node| self.eta[2 * node] + self.scene.gap(node as f64 / self.elements as f64)[0];
        (0..=self.elements).map(|node| [bending(node), self.u[node], self.q[node]]).collect()
    }

    /// From nothing.
    pub fn solve(&mut self) -> End {
        self.eta.fill(0.0);
        self.u.fill(0.0);
        self.q.fill(POTENTIAL);
        let mut end = End { converged: false, steps: 0 };
        for _ in 0..CAP {
            let before = self.eta.clone();
            if !self.bend(&mut end.steps).unwrap_or(false) {
                break;
            }
            let stayed = self.conduct();
            if stayed && settled(&before, &self.eta, 2) {
                end.converged = true;
                break;
            }
        }
        end
    }

    /// Newton's method for bending at the last q: has it converged?
    fn bend(&mut self, steps: &mut usize) -> Result<bool, NotDefinite> {
        let inner = 2..2 * self.elements;
        for step in 0..CAP {
            // The law is linear by parts: if all points stay in theirs the last step was exact.
            if !self.assemble() && step > 0 {
                return Ok(true);
            }
            *steps += 1;
            let room = self.values.len() - 1;
            self.bending.factor(&self.values[..room])?;
            self.bending.solve(&mut self.side[inner.clone()]);
            let done = settled(&self.eta[inner.clone()], &self.side[inner.clone()], 2);
            self.eta[inner.clone()].copy_from_slice(&self.side[inner.clone()]);
            if done {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Matrix and right-hand side of the next step: has any point changed its branch?
    fn assemble(&mut self) -> bool {
        self.values.fill(0.0);
        self.side.copy_from_slice(&self.load);
        let mut changed = false;
        for (element, branches) in self.branches.iter_mut().enumerate() {
            let mut matrix = self.stiffness;
            let ends = &self.eta[2 * element..2 * element + 4];
            for (p, branch) in self.points.iter().zip(branches) {
                let eta: f64 = p.shape.iter().zip(ends).map(|(n, d)| n * d).sum();
                let now = match eta {
                    _ if eta <= 0.0 => Branch::Free,
                    _ if eta < TRUNCATION => Branch::Contact,
                    _ => Branch::Truncated,
                };
                changed |= std::mem::replace(branch, now) != now;
                if now == Branch::Free {
                    continue;
                }
                let q = self.q[element] * (1.0 - p.t) + self.q[element + 1] * p.t;
                let current = MU1 * q.clamp(-TRUNCATION, TRUNCATION);
                let mut tangent = self.scene.stiffness;
                if now == Branch::Contact {
                    tangent += current;
                } else {
                    for (side, n) in self.side[2 * element..].iter_mut().zip(p.shape) {
                        *side -= p.weight * current * TRUNCATION * n;
                    }
                }
                for (entry, mass) in matrix.iter_mut().zip(p.mass) {
                    *entry += tangent * mass;
                }
            }
            for (&slot, entry) in self.slots[element].iter().zip(matrix) {
                self.values[slot] += entry;
            }
        }
        changed
    }

    /// Renews u and q: have they stayed? With constant coefficients the 2x2 block of the system comes off as a factor,
    /// and the ends' potential is a constant.
    fn conduct(&mut self) -> bool {
        let n = self.elements - 1;
        let sides = &mut self.side[..2 * n];
        let (force, charge) = sides.split_at_mut(n);
        force.fill(ALONG / self.elements as f64);
        charge.fill(0.0);
        for element in 0..self.elements {
            let ends = &self.eta[2 * element..2 * element + 4];
            for p in &self.points {
                let eta: f64 = p.shape.iter().zip(ends).map(|(n, d)| n * d).sum();
                let source = p.weight * MU2 * eta.clamp(0.0, TRUNCATION).powi(2);
                if element > 0 {
                    charge[element - 1] += source * (1.0 - p.t);
                }
                if element < n {
                    charge[element] += source * p.t;
                }
            }
        }
        let determinant = AXIAL * PERMITTIVITY + PIEZO * PIEZO;
        for (f, c) in force.iter_mut().zip(charge) {
            let (a, b) = (PERMITTIVITY * *f + PIEZO * *c, AXIAL * *c - PIEZO * *f);
            (*f, *c) = (a / determinant, b / determinant);
        }
        self.laplace.solve(sides);
        let (u, q) = sides.split_at_mut(n);
        q.iter_mut().for_each(|q| *q += POTENTIAL);
        let stayed = settled(&self.u[1..=n], u, 1) && settled(&self.q[1..=n], q, 1);
        self.u[1..=n].copy_from_slice(u);
        self.q[1..=n].copy_from_slice(q);
        stayed
    }
}

/// Has every `stride`th entry moved by no more than the largest of them times [`STOP`]? What is no number has moved.
fn settled(old: &[f64], new: &[f64], stride: usize) -> bool {
    let size = new.iter().step_by(stride).fold(0.0, |most: f64, b| most.max(b.abs()));
    old.iter().zip(new).step_by(stride).all(|(a, b)| (a - b).abs() <= STOP * size)
}
