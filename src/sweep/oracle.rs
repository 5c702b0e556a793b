//! Dense oracle for the recursion.
//!
//! The nodal system of a whole chain, assembled from the elements' energies and solved by Gaussian
//! elimination, as a textbook would. It subtracts what the recursion takes care not to subtract, so it
//! computes with twice the digits of `f64`.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use super::pair::{Bending, Symmetric};
use super::quad::Coupled;
use super::{Block, Condensed, End, Factor, Stamp};
use core::ops::{Add, Div, Mul, Neg, Sub};
use glam::{DMat2, DMat4, DVec2, DVec4};
use proptest::prelude::*;
use std::vec;
use std::vec::Vec;

/// The unevaluated sum of two numbers: about 32 digits.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Twofold {
    high: f64,
    low: f64,
}

impl Twofold {
    const ZERO: Self = Self { high: 0.0, low: 0.0 };
    const ONE: Self = Self { high: 1.0, low: 0.0 };

    fn sum(a: f64, b: f64) -> Self {
        let high = a + b;
        let shadow = high - a;
        Self { high, low: (a - (high - shadow)) + (b - shadow) }
    }

    fn product(a: f64, b: f64) -> Self {
        let high = a * b;
        Self { high, low: a.mul_add(b, -high) }
    }
}

impl From<f64> for Twofold {
    fn from(high: f64) -> Self {
        Self { high, low: 0.0 }
    }
}
impl Add for Twofold {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let (high, low) = (Self::sum(self.high, other.high), Self::sum(self.low, other.low));
        let once = Self::sum(high.high, high.low + low.high);
        Self::sum(once.high, once.low + low.low)
    }
}
impl Neg for Twofold {
    type Output = Self;
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}
impl Sub for Twofold {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}
impl Mul for Twofold {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let high = Self::product(self.high, other.high);
        Self::sum(high.high, high.low + (self.high * other.low + self.low * other.high))
    }
}
impl Div for Twofold {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let mut rest = self;
        let mut quotient = Self::ZERO;
        for _ in 0..3 {
            let digit = Self::from(rest.high / other.high);
            rest = rest - other * digit;
            quotient = quotient + digit;
        }
        quotient
    }
}

type Rows = Vec<Vec<Twofold>>;

/// a x = b by Gaussian elimination with partial pivoting, rows first scaled to size one.
fn gauss(mut a: Rows, mut b: Vec<Twofold>) -> Vec<Twofold> {
    let n = b.len();
    for (row, b) in a.iter_mut().zip(&mut b) {
        let size = row.iter().fold(0.0_f64, |m, x| m.max(x.high.abs()));
        assert!(size > 0.0, "a row of zeros");
        let scale = Twofold::from(size.log2().round().exp2());
        row.iter_mut().for_each(|x| *x = *x / scale);
        *b = *b / scale;
    }
    for i in 0..n {
        let best = (i..n).max_by(|&r, &s| a[r][i].high.abs().total_cmp(&a[s][i].high.abs())).unwrap_or(i);
        a.swap(i, best);
        b.swap(i, best);
        assert!(a[i][i].high != 0.0, "singular at {i}");
        let (head, tail) = a.split_at_mut(i + 1);
        for (row, r) in tail.iter_mut().zip(i + 1..) {
            if row[i] != Twofold::ZERO {
                let ratio = row[i] / head[i][i];
                for j in i..n {
                    row[j] = row[j] - ratio * head[i][j];
                }
                b[r] = b[r] - ratio * b[i];
            }
        }
    }
    for i in (0..n).rev() {
        for j in i + 1..n {
            b[i] = b[i] - a[i][j] * b[j];
        }
        b[i] = b[i] / a[i][i];
    }
    b
}

fn multiply(a: &Rows, b: &Rows) -> Rows {
    let column = |j: usize| b.iter().map(move |row| row[j]);
    let dot = |row: &[Twofold], j| row.iter().zip(column(j)).fold(Twofold::ZERO, |s, (x, y)| s + *x * y);
    a.iter().map(|row| (0..b[0].len()).map(|j| dot(row, j)).collect()).collect()
}

fn turned(a: &Rows) -> Rows {
    (0..a[0].len()).map(|j| a.iter().map(|row| row[j]).collect()).collect()
}

/// A block whose numbers can be laid out and put together.
trait Dense: Block<f64> + core::fmt::Debug {
    const SIZE: usize;
    fn rows(m: &Self::Matrix) -> Vec<Vec<f64>>;
    fn list(v: Self::Vector) -> Vec<f64>;
    fn vector(f: impl Fn(usize) -> f64) -> Self::Vector;
    fn matrix(f: impl Fn(usize, usize) -> f64) -> Self::Matrix;
    fn energy(f: impl Fn(usize, usize) -> f64) -> Self::Energy;
    fn hold(f: impl Fn(usize) -> bool) -> Self::Held;
    fn is_held(held: Self::Held, i: usize) -> bool;
}

impl Dense for Bending {
    const SIZE: usize = 2;
    fn rows(m: &DMat2) -> Vec<Vec<f64>> {
        m.transpose().to_cols_array_2d().map(Vec::from).into()
    }
    fn list(v: DVec2) -> Vec<f64> {
        v.to_array().into()
    }
    fn vector(f: impl Fn(usize) -> f64) -> DVec2 {
        DVec2::new(f(0), f(1))
    }
    fn matrix(f: impl Fn(usize, usize) -> f64) -> DMat2 {
        DMat2::from_cols_array_2d(&[0, 1].map(|j| [0, 1].map(|i| f(i, j))))
    }
    fn energy(f: impl Fn(usize, usize) -> f64) -> Symmetric<f64> {
        Symmetric::of(f(0, 0), f(0, 1), f(1, 1))
    }
    fn hold(f: impl Fn(usize) -> bool) -> [bool; 2] {
        [f(0), f(1)]
    }
    fn is_held(held: [bool; 2], i: usize) -> bool {
        held[i]
    }
}

impl Dense for Coupled {
    const SIZE: usize = 4;
    fn rows(m: &DMat4) -> Vec<Vec<f64>> {
        m.transpose().to_cols_array_2d().map(Vec::from).into()
    }
    fn list(v: DVec4) -> Vec<f64> {
        v.to_array().into()
    }
    fn vector(f: impl Fn(usize) -> f64) -> DVec4 {
        DVec4::from_array([0, 1, 2, 3].map(f))
    }
    fn matrix(f: impl Fn(usize, usize) -> f64) -> DMat4 {
        let all = [0, 1, 2, 3];
        DMat4::from_cols_array_2d(&all.map(|j| all.map(|i| f(i, j))))
    }
    fn energy(f: impl Fn(usize, usize) -> f64) -> DMat4 {
        Self::matrix(f)
    }
    fn hold(f: impl Fn(usize) -> bool) -> [bool; 4] {
        [0, 1, 2, 3].map(f)
    }
    fn is_held(held: [bool; 4], i: usize) -> bool {
        held[i]
    }
}

/// Elements between two ends; where `jump` is not zero the unknowns jump at the element's left node.
struct Chain<B: Dense> {
    elements: Vec<Link<B>>,
    left: End<f64, B>,
    right: End<f64, B>,
}

#[derive(Clone, Copy)]
struct Link<B: Dense> {
    h: f64,
    stamp: Stamp<f64, B>,
    jump: B::Vector,
}

type Steps<B> = Vec<(Condensed<f64, B>, Factor<f64, B>)>;

/// An element's unknowns.
#[derive(Clone, Debug)]
struct Shape {
    left: Vec<f64>,
    e: Vec<f64>,
    right: Vec<f64>,
}

impl<B: Dense> Link<B> {
    /// [[A_ee, A_er], [A_re, A_rr]] and (f_e, f_r).
    fn whole(&self) -> (Vec<Vec<f64>>, Vec<f64>) {
        let Stamp { ee, er, rr, fe, fr, .. } = &self.stamp;
        let join = |a: Vec<Vec<f64>>, b: Vec<Vec<f64>>| {
            a.into_iter().zip(b).map(|(a, b)| [a, b].concat()).collect::<Vec<_>>()
        };
        let mut rows = join(B::rows(&B::of_energy(ee)), B::rows(er));
        rows.extend(join(B::rows(&B::lower(&self.stamp)), B::rows(&B::of_energy(rr))));
        (rows, [B::list(*fe), B::list(*fr)].concat())
    }

    /// The map from (d_left, d_right) to (e, d_right).
    fn relative(&self) -> Rows {
        let n = B::SIZE;
        let mut map = vec![vec![Twofold::ZERO; 2 * n]; 2 * n];
        for (i, row) in map.iter_mut().enumerate() {
            row[i] = Twofold::ONE;
            if i < n {
                row[n + i] = -Twofold::ONE;
            }
        }
        map[0][n + 1] = Twofold::from(self.h);
        map
    }

    /// The energy 1/2 (e, d)'A(e, d) of a shape.
    fn energy(&self, shape: &Shape) -> f64 {
        let both = [shape.e.clone(), shape.right.clone()].concat();
        let (rows, _) = self.whole();
        0.5 * rows
            .iter()
            .zip(&both)
            .map(|(row, x)| x * row.iter().zip(&both).map(|(a, y)| a * y).sum::<f64>())
            .sum::<f64>()
    }
}

impl<B: Dense> Chain<B> {
    /// The oracle.
    fn dense(&self) -> Vec<Shape> {
        let n = B::SIZE;
        let size = n * (self.elements.len() + 1);
        let mut a = vec![vec![Twofold::ZERO; size]; size];
        let mut b = vec![Twofold::ZERO; size];
        for (node, link) in self.elements.iter().enumerate() {
            let (rows, load) = link.whole();
            let map = link.relative();
            let rows: Rows =
                rows.iter().map(|row| row.iter().copied().map(Twofold::from).collect()).collect();
            let load: Rows = load.into_iter().map(|f| vec![Twofold::from(f)]).collect();
            let k = multiply(&turned(&map), &multiply(&rows, &map));
            let f = multiply(&turned(&map), &load);
            let jump = B::list(link.jump);
            for i in 0..2 * n {
                for j in 0..2 * n {
                    a[node * n + i][node * n + j] = a[node * n + i][node * n + j] + k[i][j];
                }
                b[node * n + i] = b[node * n + i] + f[i][0];
                for j in 0..n {
                    b[node * n + i] = b[node * n + i] + k[i][j] * Twofold::from(jump[j]);
                }
            }
        }
        for (end, from) in [(&self.left, 0), (&self.right, size - n)] {
            let s = B::rows(&B::of_energy(&end.condensed.s));
            let (load, value) = (B::list(end.condensed.b), B::list(end.value));
            for i in 0..n {
                for j in 0..n {
                    a[from + i][from + j] = a[from + i][from + j] + Twofold::from(s[i][j]);
                }
                b[from + i] = b[from + i] + Twofold::from(load[i]);
            }
            for i in 0..n {
                if B::is_held(end.held, i) {
                    a[from + i].fill(Twofold::ZERO);
                    a[from + i][from + i] = Twofold::ONE;
                    b[from + i] = Twofold::from(value[i]);
                }
            }
        }
        let x = gauss(a, b);
        let shape = |(node, link): (usize, &Link<B>)| {
            let jump = B::list(link.jump);
            let mut both: Rows = x[node * n..(node + 2) * n].iter().map(|&x| vec![x]).collect();
            for i in 0..n {
                both[i][0] = both[i][0] - Twofold::from(jump[i]);
            }
            let relative = multiply(&link.relative(), &both);
            let list = |part: &[Vec<Twofold>]| part.iter().map(|x| x[0].high).collect();
            Shape { left: list(&both[..n]), e: list(&relative[..n]), right: list(&both[n..]) }
        };
        self.elements.iter().enumerate().map(shape).collect()
    }

    /// The first `meeting` elements condensed from the left, the others from the right.
    fn recursion(&self, meeting: usize) -> Option<Vec<Shape>> {
        let (from_left, from_right) = (self.swept_right(meeting)?, self.swept_left(meeting)?);
        let (west, east) = self.elements.split_at(meeting);
        let jump = |link: Option<&Link<B>>| link.map_or(B::Vector::default(), |link| link.jump);
        // Of the left part at the node where the parts meet.
        let d = match (from_left.last(), from_right.first()) {
            (Some((left, _)), Some((right, _))) => {
                left.meet(&right.shift(B::Vector::default() - jump(east.first())))?
            }
            (Some((left, _)), None) => self.right.close(left)?,
            (None, Some((right, _))) => self.left.close(right)?,
            (None, None) => return Some(Vec::new()),
        };
        let mut shapes = Vec::new();
        let mut near = d;
        for (link, (_, factor)) in west.iter().zip(&from_left).rev() {
            let (e, far) = factor.substitute(near, link.h);
            shapes.push(Shape { left: B::list(far), e: B::list(e), right: B::list(near) });
            near = far + link.jump;
        }
        shapes.reverse();
        let mut near = d;
        for (link, (_, factor)) in east.iter().zip(&from_right) {
            near = near - link.jump;
            let (mirrored, far) = factor.substitute(near, -link.h);
            let e = B::Vector::default() - B::carry(link.h, mirrored);
            shapes.push(Shape { left: B::list(near), e: B::list(e), right: B::list(far) });
            near = far;
        }
        Some(shapes)
    }

    /// The first `until` elements condensed, from left to right.
    fn swept_right(&self, until: usize) -> Option<Steps<B>> {
        let mut steps: Vec<(Condensed<f64, B>, _)> = Vec::new();
        for link in &self.elements[..until] {
            steps.push(match steps.last() {
                None => self.left.join(&self.left.condensed, &link.stamp, link.h)?,
                Some((part, _)) => part.shift(link.jump).absorb(&link.stamp, link.h)?,
            });
        }
        Some(steps)
    }

    /// Those after the first `from` condensed from right to left, in the order of the elements.
    fn swept_left(&self, from: usize) -> Option<Steps<B>> {
        let mut steps: Vec<(Condensed<f64, B>, _)> = Vec::new();
        for (i, link) in self.elements.iter().enumerate().skip(from).rev() {
            let stamp = link.stamp.mirrored(link.h);
            steps.push(match steps.last() {
                None => self.right.join(&self.right.condensed, &stamp, -link.h)?,
                Some((part, _)) => {
                    part.shift(B::Vector::default() - self.elements[i + 1].jump).absorb(&stamp, -link.h)?
                }
            });
        }
        steps.reverse();
        Some(steps)
    }

    /// Distance of two states: the larger of the relative error in energy norm of what deforms, and that
    /// of each unknown at nodes.
    fn distance(&self, got: &[Shape], want: &[Shape]) -> (f64, f64) {
        assert_eq!(got.len(), want.len());
        let minus = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<_>>();
        let (mut wrong, mut whole) = (0.0, 0.0);
        let mut nodes = 0.0_f64;
        let size = |i: usize| {
            want.iter().map(|s| s.left[i].abs().max(s.right[i].abs())).fold(f64::MIN_POSITIVE, f64::max)
        };
        let mut sizes: Vec<f64> = (0..B::SIZE).map(size).collect();
        // A slope that turns the whole chain counts as a deflection, and the other way round.
        let length: f64 = self.elements.iter().map(|link| link.h).sum();
        sizes[0] = sizes[0].max(length * sizes[1]);
        sizes[1] = sizes[1].max(sizes[0] / length);
        for ((got, want), link) in got.iter().zip(want).zip(&self.elements) {
            let still = vec![0.0; B::SIZE];
            let error = Shape { left: still.clone(), e: minus(&got.e, &want.e), right: still };
            wrong += link.energy(&error);
            whole += link.energy(want);
            for (i, size) in sizes.iter().enumerate() {
                let worst = (got.left[i] - want.left[i]).abs().max((got.right[i] - want.right[i]).abs());
                nodes = nodes.max(worst / size);
            }
        }
        for (end, d) in
            [(&self.left, want.first().map(|s| &s.left)), (&self.right, want.last().map(|s| &s.right))]
        {
            let d = B::vector(|i| d.map_or(0.0, |d| d[i]));
            let force = B::list(B::energy_times(&end.condensed.s, d));
            whole += 0.5 * force.iter().zip(B::list(d)).map(|(f, d)| f * d).sum::<f64>();
        }
        ((wrong / whole.max(f64::MIN_POSITIVE)).max(0.0).sqrt(), nodes)
    }
}

/// Energies that a random chain is made of.
trait Mechanics: Dense {
    /// The energy of deformation of an element of length `h`, from numbers in (-1, 1).
    fn deformation(h: f64, random: &[f64]) -> Vec<Vec<f64>>;
    /// Sizes of the unknowns against each other, for an element of length `h`.
    fn units(h: f64) -> Vec<f64>;
    /// An antisymmetric part of energies, where the block can hold one.
    const SKEW: f64;
}

impl Mechanics for Bending {
    const SKEW: f64 = 0.0;
    fn deformation(h: f64, random: &[f64]) -> Vec<Vec<f64>> {
        let c = 10f64.powf(random[0]);
        vec![vec![12.0 * c / h / h / h, 6.0 * c / h / h], vec![6.0 * c / h / h, 4.0 * c / h]]
    }
    fn units(h: f64) -> Vec<f64> {
        vec![1.0, h]
    }
}

/// One volt moves as much as a thousandth of a metre.
const VOLT: f64 = 1e-3;

impl Mechanics for Coupled {
    const SKEW: f64 = 1.0;
    fn deformation(h: f64, random: &[f64]) -> Vec<Vec<f64>> {
        let bending = Bending::deformation(h, random);
        let (axial, permittivity) = (10f64.powf(random[1]) / h, 10f64.powf(random[2]) * VOLT * VOLT / h);
        let piezo = random[3] * VOLT / h;
        vec![
            vec![bending[0][0], bending[0][1], 0.0, 0.0],
            vec![bending[1][0], bending[1][1], 0.0, 0.0],
            vec![0.0, 0.0, axial, -piezo],
            vec![0.0, 0.0, piezo, permittivity],
        ]
    }
    fn units(h: f64) -> Vec<f64> {
        vec![1.0, h, 1.0, VOLT]
    }
}

/// Numbers of which one element is made.
#[derive(Clone, Debug)]
struct Recipe {
    /// Length, as a power of ten.
    decade: f64,
    /// Stiffness of a foundation under it, as a power of ten; none below -4.
    foundation: f64,
    jumps: bool,
    random: Vec<f64>,
}

impl Recipe {
    fn link<B: Mechanics>(&self) -> Link<B> {
        let n = B::SIZE;
        let h = 10f64.powf(self.decade);
        let units = [B::units(h), B::units(h)].concat();
        let mut a = vec![vec![0.0; 2 * n]; 2 * n];
        for (row, deformation) in a.iter_mut().zip(B::deformation(h, &self.random)) {
            row[..n].copy_from_slice(&deformation);
        }
        if self.foundation > -4.0 {
            let k = 10f64.powf(self.foundation) * h;
            for (a, (row, unit)) in a.iter_mut().zip(form::<B>(2 * n, &self.random[8..]).iter().zip(&units)) {
                for (a, (x, other)) in a.iter_mut().zip(row.iter().zip(&units)) {
                    *a += k * x * unit * other;
                }
            }
        }
        let load = &self.random[72..];
        let stamp = Stamp {
            ee: B::energy(|i, j| a[i][j]),
            er: B::matrix(|i, j| a[i][n + j]),
            re: B::matrix(|i, j| a[n + i][j]),
            rr: B::energy(|i, j| a[n + i][n + j]),
            fe: B::vector(|i| h * units[i] * load[i]),
            fr: B::vector(|i| h * units[i] * load[n + i]),
            free: false,
        };
        let jump = if self.jumps {
            B::vector(|i| 0.1 * B::units(1.0)[i] * load[2 * n + i])
        } else {
            B::Vector::default()
        };
        Link { h, stamp, jump }
    }
}

/// A random positive definite form, with an antisymmetric part where blocks can hold it.
fn form<B: Mechanics>(n: usize, random: &[f64]) -> Vec<Vec<f64>> {
    let g = |i: usize, j: usize| random[i * n + j];
    let entry = |i: usize, j: usize| {
        let symmetric: f64 = (0..n).map(|k| g(k, i) * g(k, j)).sum();
        let floor = if i == j { 0.3 } else { 0.0 };
        symmetric + floor + 0.2 * B::SKEW * (g(i, j) - g(j, i))
    };
    (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect()
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Hold {
    Clamped,
    /// Springs of all unknowns.
    Elastic,
    Free,
    /// Deflection held.
    Pinned,
    /// Slope held.
    Guided,
    /// Deflection held, springs on the rest.
    Hinged,
}

fn end<B: Mechanics>(hold: Hold, random: &[f64]) -> End<f64, B> {
    let n = B::SIZE;
    let held = |i: usize| match hold {
        Hold::Clamped => true,
        Hold::Elastic | Hold::Free => false,
        // What is not bending is held with the deflection.
        Hold::Pinned | Hold::Hinged => i != 1,
        Hold::Guided => i != 0,
    };
    let (units, springs) = (B::units(1.0), form::<B>(n, &random[8..]));
    let mut condensed = Condensed::default();
    if hold == Hold::Elastic || hold == Hold::Hinged {
        let k = 10f64.powf(3.0 * random[0]);
        condensed.s = B::energy(|i, j| k * springs[i][j] / units[i] / units[j]);
        condensed.b = B::vector(|i| random[24 + i] / units[i]);
    }
    let value = B::vector(|i| if held(i) { random[28 + i] * units[i] } else { 0.0 });
    End { held: B::hold(held), value, condensed }
}

fn chain<B: Mechanics>(recipes: &[Recipe], holds: (Hold, Hold), random: &[f64]) -> Chain<B> {
    let mut elements: Vec<Link<B>> = recipes.iter().map(Recipe::link).collect();
    if let Some(first) = elements.first_mut() {
        first.jump = B::Vector::default();
    }
    Chain { elements, left: end(holds.0, random), right: end(holds.1, &random[32..]) }
}

/// Pairs of ends that leave no rigid motion.
fn holds() -> impl Strategy<Value = (Hold, Hold)> {
    use Hold::{Clamped, Elastic, Free, Guided, Hinged, Pinned};
    let firm = prop::sample::select(vec![Clamped, Elastic, Hinged]);
    let other = prop::sample::select(vec![Clamped, Elastic, Free, Pinned, Guided, Hinged]);
    prop_oneof![
        4 => (firm, other, any::<bool>()).prop_map(|(a, b, swap)| if swap { (b, a) } else { (a, b) }),
        1 => prop::sample::select(vec![(Pinned, Pinned), (Pinned, Guided), (Guided, Pinned)]),
    ]
}

fn numbers(n: usize) -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(-1.0..1.0_f64, n)
}

/// What a random chain may be made of, as powers of ten.
#[derive(Clone, Copy, Debug)]
struct Range {
    /// Of the shortest element's length; the longest may have length 1.
    shortest: f64,
    /// Of the stiffest foundation.
    foundation: f64,
    /// By how much the beam's coefficients differ from 1.
    coefficients: f64,
}

/// Lengths that differ by up to a hundred, on soft and on nearly rigid foundations.
const USUAL: Range = Range { shortest: -2.0, foundation: 6.0, coefficients: 1.0 };
/// Lengths that differ by up to a million.
const LEAPS: Range = Range { shortest: -6.0, foundation: 0.0, coefficients: 0.3 };

type Ingredients = (Vec<Recipe>, (Hold, Hold), Vec<f64>);

/// Chains of up to twelve elements.
fn ingredients(range: Range) -> impl Strategy<Value = Ingredients> {
    let foundation = -8.0..range.foundation;
    let element = (range.shortest..0.0, foundation, prop::bool::weighted(0.25), numbers(90)).prop_map(
        move |(decade, foundation, jumps, mut random)| {
            random[..3].iter_mut().for_each(|x| *x *= range.coefficients);
            Recipe { decade, foundation, jumps, random }
        },
    );
    (prop::collection::vec(element, 1..=12), holds(), numbers(64))
}

/// The largest distance from the oracle, over all nodes where the sweeps may meet.
fn worst<B: Mechanics>(chain: &Chain<B>) -> (f64, f64) {
    let want = chain.dense();
    (0..=chain.elements.len()).fold((0.0, 0.0), |worst: (f64, f64), meeting| {
        let Some(got) = chain.recursion(meeting) else { return (f64::INFINITY, f64::INFINITY) };
        let (e, d) = chain.distance(&got, &want);
        (worst.0.max(e), worst.1.max(d))
    })
}

const CLAMPS: (Hold, Hold) = (Hold::Clamped, Hold::Clamped);

/// Ends that do not move, nor jump the unknowns: what is left are the loads.
fn loads_only((recipes, _, random): &mut Ingredients) {
    recipes.iter_mut().for_each(|recipe| recipe.jumps = false);
    random[28..32].fill(0.0);
    random[60..].fill(0.0);
}

/// A clamped chain and the energies left of each node, as far as `until`.
fn energies<B: Mechanics>(chain: &Chain<B>, until: usize) -> Vec<B::Energy> {
    chain.swept_right(until).unwrap().iter().map(|(part, _)| part.s).collect()
}

/// v'S v
fn twice_energy(s: &Symmetric<f64>, v: DVec2) -> f64 {
    v.dot(s.times(v))
}

#[test]
fn the_oracle_knows_a_cantilever() {
    // F h^3 / 3C and F h^2 / 2C under a force at the tip.
    let (c, h, force) = (3.0, 0.5, 7.0);
    let stamp = Stamp {
        ee: Symmetric::of(12.0 * c / (h * h * h), 6.0 * c / (h * h), 4.0 * c / h),
        er: DMat2::ZERO,
        re: DMat2::ZERO,
        rr: Symmetric::default(),
        fe: DVec2::ZERO,
        fr: DVec2::new(force, 0.0),
        free: false,
    };
    let random = [0.0; 64];
    let (left, right) = (end(Hold::Clamped, &random), end(Hold::Free, &random[32..]));
    let chain: Chain<Bending> = Chain { elements: vec![Link { h, stamp, jump: DVec2::ZERO }], left, right };
    let tip = &chain.dense()[0].right;
    assert!((tip[0] - force * h * h * h / (3.0 * c)).abs() < 1e-16);
    assert!((tip[1] - force * h * h / (2.0 * c)).abs() < 1e-15);
    let third = Twofold::ONE / Twofold::from(3.0);
    let rest = third + third + third - Twofold::ONE;
    assert!(rest.high.abs() < 1e-31 && third.low != 0.0);
}

proptest! {
    #[test]
    fn bending_between_clamps_is_the_dense_solution_wherever_the_sweeps_meet(x in ingredients(USUAL)) {
        let (e, d) = worst(&chain::<Bending>(&x.0, CLAMPS, &x.2));
        prop_assert!(e < 1e-8 && d < 1e-8, "{e:e} {d:e}");
    }

    #[test]
    fn coupled_chains_between_clamps_are_the_dense_solution_wherever_the_sweeps_meet(x in ingredients(USUAL)) {
        let (e, d) = worst(&chain::<Coupled>(&x.0, CLAMPS, &x.2));
        prop_assert!(e < 1e-8 && d < 1e-8, "{e:e} {d:e}");
    }

    #[test]
    fn bending_with_any_ends_is_the_dense_solution(x in ingredients(Range { shortest: -1.0, ..USUAL })) {
        let (e, d) = worst(&chain::<Bending>(&x.0, x.1, &x.2));
        prop_assert!(e < 1e-7 && d < 1e-7, "{e:e} {d:e}");
    }

    #[test]
    fn coupled_chains_with_any_ends_are_the_dense_solution(x in ingredients(Range { shortest: -1.0, ..USUAL })) {
        let (e, d) = worst(&chain::<Coupled>(&x.0, x.1, &x.2));
        prop_assert!(e < 1e-7 && d < 1e-7, "{e:e} {d:e}");
    }

    #[test]
    fn leaps_of_length_cost_bending_no_digits(mut x in ingredients(LEAPS)) {
        loads_only(&mut x);
        let (e, d) = worst(&chain::<Bending>(&x.0, CLAMPS, &x.2));
        prop_assert!(e < 1e-9 && d < 1e-9, "{e:e} {d:e}");
    }

    #[test]
    fn leaps_of_length_cost_coupled_chains_few_digits(mut x in ingredients(LEAPS)) {
        loads_only(&mut x);
        let (e, d) = worst(&chain::<Coupled>(&x.0, CLAMPS, &x.2));
        prop_assert!(e < 1e-5 && d < 1e-5, "{e:e} {d:e}");
    }

    #[test]
    fn what_is_condensed_stays_positive_definite(x in ingredients(LEAPS)) {
        let chain = chain::<Bending>(&x.0, CLAMPS, &x.2);
        let from_right: Vec<_> = chain.swept_left(0).unwrap().iter().map(|(part, _)| part.s).collect();
        for s in energies(&chain, chain.elements.len()).iter().chain(&from_right) {
            prop_assert!(s.xx > 0.0 && s.yy > 0.0 && s.xx * s.yy > s.xy * s.xy, "{s:?}");
        }
    }

    #[test]
    fn a_foundation_under_one_more_element_softens_nothing(
        mut x in ingredients(USUAL),
        which in any::<prop::sample::Index>(),
        stiffness in -3.0..6.0_f64,
        v in numbers(2),
    ) {
        let n = x.0.len();
        let which = which.index(n);
        x.0[which].foundation = -8.0;
        let soft = energies(&chain::<Bending>(&x.0, CLAMPS, &x.2), n);
        x.0[which].foundation = stiffness;
        let firm = energies(&chain::<Bending>(&x.0, CLAMPS, &x.2), n);
        let v = DVec2::new(v[0], v[1]);
        for (i, (soft, firm)) in soft.iter().zip(&firm).enumerate() {
            let (soft, firm) = (twice_energy(soft, v), twice_energy(firm, v));
            prop_assert!(firm >= soft * (1.0 - 1e-8), "node {i}: {firm:e} {soft:e}");
            prop_assert!(i >= which || firm == soft);
        }
    }

    #[test]
    fn a_symmetric_chain_is_the_same_in_the_general_block(x in ingredients(USUAL)) {
        let narrow = chain::<Bending>(&x.0, CLAMPS, &x.2);
        let wide = |s: DMat2, rest: f64| Coupled::matrix(|i, j| match (i, j) {
            (0 | 1, 0 | 1) => s.col(j)[i],
            _ if i == j => rest,
            _ => 0.0,
        });
        let vector = |v: DVec2| DVec4::new(v.x, v.y, 0.0, 0.0);
        let elements = narrow.elements.iter().map(|&Link { h, stamp, jump }| {
            let energy = |s: &Symmetric<f64>, rest| wide(Bending::of_energy(s), rest);
            let stamp = Stamp {
                ee: energy(&stamp.ee, 1.0),
                er: wide(stamp.er, 0.0),
                re: wide(stamp.er.transpose(), 0.0),
                rr: energy(&stamp.rr, 0.0),
                fe: vector(stamp.fe),
                fr: vector(stamp.fr),
                free: false,
            };
            Link { h, stamp, jump: vector(jump) }
        });
        let widened = |end: &End<f64, Bending>| End {
            held: [true; 4],
            value: vector(end.value),
            condensed: Condensed::default(),
        };
        let general: Chain<Coupled> =
            Chain { elements: elements.collect(), left: widened(&narrow.left), right: widened(&narrow.right) };
        let n = narrow.elements.len();
        let sizes = |s: &Symmetric<f64>| [s.xx, s.yy].map(f64::sqrt);
        for (s, g) in energies(&narrow, n).iter().zip(energies(&general, n)) {
            let size = sizes(s);
            for (i, j, want) in [(0, 0, s.xx), (0, 1, s.xy), (1, 0, s.xy), (1, 1, s.yy)] {
                let got = g.col(j)[i];
                prop_assert!((got - want).abs() < 1e-8 * size[i] * size[j], "{i}{j}: {got:e} {want:e}");
            }
            prop_assert!(g.col(2)[0] == 0.0 && g.col(1)[3] == 0.0);
        }
    }
}

/// f L^4 / 384 C in the middle of a uniform beam: relative errors of the recursion in nodal values,
/// S' = K22 - K21 (S + K11)^-1 K12, and of the one in relative unknowns.
fn errors_in_the_middle(n: usize) -> (f64, f64) {
    let h = 1.0 / f64::from(u32::try_from(n).unwrap());
    let (c, f) = (5000.0, 1e6);
    let (force, moment) = (f * h / 2.0, f * h * h / 12.0);
    let want = f / (384.0 * c);

    let (w, wt, t) = (12.0 * c / (h * h * h), 6.0 * c / (h * h), 4.0 * c / h);
    let matrix = |a: f64, b: f64, c: f64, d: f64| DMat2::from_cols(DVec2::new(a, c), DVec2::new(b, d));
    let k11 = matrix(w, wt, wt, t);
    let k12 = matrix(-w, wt, -wt, t / 2.0);
    let k22 = matrix(w, -wt, -wt, t);
    let (f1, f2) = (DVec2::new(force, moment), DVec2::new(force, -moment));
    let (mut s, mut b) = (k22, f2);
    for _ in 1..n / 2 {
        let inverse = (s + k11).inverse();
        b = f2 - k12.transpose() * (inverse * (b + f1));
        s = k22 - k12.transpose() * (inverse * k12);
    }
    // The other half is the mirror image.
    let turn = matrix(1.0, 0.0, 0.0, -1.0);
    let middle = (s + turn * s * turn).inverse() * (b + turn * b);
    let naive = (middle.x / want - 1.0).abs();

    // Of e = (1, 0), (0, 1) against the rigid motion with the right node.
    let stamp: Stamp<f64, Bending> = Stamp {
        ee: Symmetric::of(w, wt, t),
        er: DMat2::ZERO,
        re: DMat2::ZERO,
        rr: Symmetric::default(),
        fe: f1,
        fr: DVec2::new(f * h, -f * h * h / 2.0),
        free: false,
    };
    let link = Link { h, stamp, jump: DVec2::ZERO };
    let random = [0.0; 64];
    let (left, right) = (end(Hold::Clamped, &random), end(Hold::Clamped, &random[32..]));
    let chain: Chain<Bending> = Chain { elements: vec![link; n], left, right };
    let ours = (chain.recursion(n / 2).unwrap()[n / 2].left[0] / want - 1.0).abs();
    (naive, ours)
}

#[test]
fn relative_unknowns_keep_the_digits_that_nodal_values_lose() {
    for n in [1000, 10_000] {
        let (naive, ours) = errors_in_the_middle(n);
        assert!(ours < 1e-12, "{n}: {ours:e}");
        assert!(naive > 1e3 * ours.max(f64::EPSILON), "{n}: {naive:e} against {ours:e}");
    }
}
/// Clamp, a sliver, an element whose own stiffness in rotation hides the leap, a sliver, clamp.
#[test]
fn a_leap_is_seen_in_deflections_too() {
    let beam = |h: f64, c: f64| {
        let (w, wt, t) = (12.0 * c / (h * h * h), 6.0 * c / (h * h), 4.0 * c / h);
        let stamp: Stamp<f64, Bending> = Stamp {
            ee: Symmetric::of(w, wt, t),
            er: DMat2::ZERO,
            re: DMat2::ZERO,
            rr: Symmetric::default(),
            fe: DVec2::new(h / 2.0, h * h / 12.0),
            fr: DVec2::new(h, -h * h / 2.0),
            free: false,
        };
        Link { h, stamp, jump: DVec2::ZERO }
    };
    let random = [0.0; 64];
    let (left, right) = (end(Hold::Clamped, &random), end(Hold::Clamped, &random[32..]));
    for (h, c) in [(1e-2, 13.0), (1e-3, 130.0), (1e-4, 1.3e3), (1e-5, 1.3e4), (1e-6, 1.3e5)] {
        let chain: Chain<Bending> =
            Chain { elements: vec![beam(h, 1.0), beam(1.0, c), beam(1.0, c)], left, right };
        let (e, d) = worst(&chain);
        assert!(e < 1e-9 && d < 1e-9, "h {h:e}: {e:e} {d:e}");
    }
}

proptest! {
    #[test]
    fn elastic_ends_cost_no_digits(mut x in ingredients(Range { shortest: -4.0, ..LEAPS })) {
        loads_only(&mut x);
        x.0.iter_mut().for_each(|recipe| recipe.foundation = -8.0);
        let (e, d) = worst(&chain::<Bending>(&x.0, (Hold::Elastic, Hold::Elastic), &x.2));
        prop_assert!(e < 1e-9 && d < 1e-9, "{e:e} {d:e}");
    }
}
