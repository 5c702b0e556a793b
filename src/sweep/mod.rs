//! The block Thomas recursion in relative coordinates.
//!
//! Nodes carry a small vector d, elements an energy. Sweeping from left to right, all that lies to the
//! left of a node is condensed into 1/2 d'S d - b'd. Let T be the rigid motion that moves an element's
//! right end to its left one and
//!
//! ```text
//!     e = d_left - T d_right
//! ```
//!
//! the part of the left end's motion that deforms the element. With an element energy
//! 1/2 e'A_ee e + e'A_er d + 1/2 d'A_rr d - f_e'e - f_r'd in (e, d = d_right) the elimination of e reads
//!
//! ```text
//!     A  = S + A_ee                                       pivot
//!     S' = T'S T + A_rr - (T'S + A_re) A^-1 (S T + A_er)
//!     b' = T'b + f_r    - (T'S + A_re) A^-1 (b + f_e)
//!     e  = A^-1 (b + f_e) - A^-1 (S T + A_er) d           back substitution
//! ```
//!
//! The usual recursion in nodal values subtracts numbers of size C/h^3 to obtain one of size C/x^3; here
//! the element's own stiffness enters the pivot only, and no such difference is formed. Three things keep
//! the digits. S is stored symmetric where the problem is: rounding makes an antisymmetric part that
//! T'S T never damps. The relative unknown e is primary: it is stored, and forces are computed from it,
//! never from differences of nodal values. And where a stiff left part meets a soft element (a short
//! element before a long one; a clamp, in the limit) T'S T - T'S A^-1 S T would cancel, so the same
//! elimination is written with d_left = e + T d_right as the eliminated unknown:
//!
//! ```text
//!     S' = R - L A^-1 U,  R = T'A_ee T - T'A_er - A_re T + A_rr,  U = A_er - A_ee T,  L = A_re - T'A_ee
//!     b' = f_r - T'f_e - L A^-1 (b + f_e)
//!     d_left = A^-1 (b + f_e) - A^-1 U d
//! ```
//!
//! *From the right.* Condensing from the right end is the same elimination of a mirrored element: with
//! e^ = d_right - T^-1 d_left = -T^-1 e the roles of the nodes change and T^-1, the rigid motion over -h,
//! takes T's place ([`Stamp::mirrored`]). Both sweeps meet at any node, where S + S^ and b + b^ give its
//! unknowns; two short chains instead of one long one, and a change in the middle leaves both ends as they
//! are.
//!
//! The recursion is written once, for blocks of any size; [`pair`] is the symmetric 2x2 block of bending,
//! [`quad`] the general 4x4 block of the coupled system.

pub(crate) mod pair;
pub(crate) mod quad;

#[cfg(test)]
pub(crate) mod fault;
#[cfg(test)]
mod oracle;

use crate::real::Field;

/// The algebra of one nodal block: its vectors, its matrices, and how an element's rigid motion acts.
pub(crate) trait Block<T: Field>: Copy {
    /// Unknowns of a node.
    type Vector: Copy
        + Default
        + core::fmt::Debug
        + core::ops::Add<Output = Self::Vector>
        + core::ops::Sub<Output = Self::Vector>;
    /// A general block.
    type Matrix: Copy + core::fmt::Debug + core::ops::Add<Output = Self::Matrix>;
    /// A block of an energy: symmetric where the problem is.
    type Energy: Copy + core::fmt::Debug + core::ops::Add<Output = Self::Energy>;
    /// Which of an end's unknowns are held.
    type Held: Copy;

    /// No matrix.
    const NONE: Self::Matrix;
    /// No energy.
    const NOTHING: Self::Energy;

    /// An energy as a general block
    fn of_energy(s: &Self::Energy) -> Self::Matrix;
    /// T v
    fn carry(h: T, v: Self::Vector) -> Self::Vector;
    /// T'v
    fn carry_back(h: T, v: Self::Vector) -> Self::Vector;
    /// S T
    fn carry_right(s: &Self::Energy, h: T) -> Self::Matrix;
    /// T'S, given S T (whose transposed it is where S is symmetric)
    fn carry_left(s: &Self::Energy, h: T, right: &Self::Matrix) -> Self::Matrix;
    /// T'S T
    fn congruence(s: &Self::Energy, h: T) -> Self::Energy;
    /// T'M, for a general block
    fn carry_matrix(h: T, m: &Self::Matrix) -> Self::Matrix;
    /// M T
    fn matrix_carry(m: &Self::Matrix, h: T) -> Self::Matrix;
    /// S v
    fn energy_times(s: &Self::Energy, v: Self::Vector) -> Self::Vector;
    /// M v
    fn times(m: &Self::Matrix, v: Self::Vector) -> Self::Vector;
    /// -M
    fn negate(m: &Self::Matrix) -> Self::Matrix;
    /// A^-1 B and A^-1 v; `None` where the pivot is singular, indefinite (symmetric case) or not finite.
    fn divide(a: &Self::Energy, b: &Self::Matrix, v: Self::Vector) -> Option<(Self::Matrix, Self::Vector)>;
    /// As [`Block::divide`], restricted to the unknowns that are not held; zero rows for the others.
    fn divide_free(
        a: &Self::Energy,
        b: &Self::Matrix,
        v: Self::Vector,
        held: Self::Held,
    ) -> Option<(Self::Matrix, Self::Vector)>;
    /// Is any unknown held?
    fn holds(held: Self::Held) -> bool;
    /// S - L G, where the product is known to be an energy
    fn reduce(s: &Self::Energy, left: &Self::Matrix, gain: &Self::Matrix) -> Self::Energy;
    /// R of the module's documentation: the element's energy in (d_left, d_right) seen from d_right.
    fn far_end(stamp: &Stamp<T, Self>, h: T) -> Self::Energy;
    /// A_re, given A_er
    fn lower(stamp: &Stamp<T, Self>) -> Self::Matrix;
    /// Is S so much stiffer than the element that e would cancel?
    fn outweighs(s: &Self::Energy, element: &Self::Energy) -> bool;
}

/// One element's energy in (e, d_right): matrices and loads.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stamp<T: Field, B: Block<T>> {
    pub(crate) ee: B::Energy,
    pub(crate) er: B::Matrix,
    /// A_re where it is not the transposed of A_er; unused by symmetric blocks.
    pub(crate) re: B::Matrix,
    pub(crate) rr: B::Energy,
    pub(crate) fe: B::Vector,
    pub(crate) fr: B::Vector,
    /// A_er, A_re and A_rr are zero: nothing but bending.
    pub(crate) free: bool,
}

/// All that lies to the left of a node: 1/2 d'S d - b'd.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Condensed<T: Field, B: Block<T>> {
    pub(crate) s: B::Energy,
    pub(crate) b: B::Vector,
}

/// An end of the beam: some unknowns are held at a value, on the rest it acts as the energy
/// 1/2 d'S d - b'd. A clamp holds all; a free end none, with no energy; springs are in S.
#[derive(Clone, Copy, Debug)]
pub(crate) struct End<T: Field, B: Block<T>> {
    pub(crate) held: B::Held,
    /// Values of the held unknowns; zero for the others.
    pub(crate) value: B::Vector,
    pub(crate) condensed: Condensed<T, B>,
}

impl<T: Field, B: Block<T>> End<T, B> {
    /// The first element joins this end on its left; `before` is the end's energy.
    #[inline]
    pub(crate) fn join(
        &self,
        before: &Condensed<T, B>,
        element: &Stamp<T, B>,
        h: T,
    ) -> Option<(Condensed<T, B>, Factor<T, B>)> {
        #[cfg(test)]
        fault::strike()?;
        if !B::holds(self.held) {
            // An end on springs, or free, is a part like any other; as soft as it is, d_left would cancel.
            return before.absorb(element, h);
        }
        let a = before.s + element.ee;
        let upper = upper::<T, B>(element, h);
        let load = before.b + element.fe - B::energy_times(&a, self.value);
        let (gain, free) = B::divide_free(&a, &upper, load, self.held)?;
        Some(Condensed::from_nodal(element, h, gain, self.value + free))
    }

    /// The last node's unknowns, where all elements were condensed from the other side.
    #[inline]
    pub(crate) fn close(&self, part: &Condensed<T, B>) -> Option<B::Vector> {
        #[cfg(test)]
        fault::strike()?;
        let a = part.s + self.condensed.s;
        let load = part.b + self.condensed.b - B::energy_times(&a, self.value);
        let (_, free) = B::divide_free(&a, &B::NONE, load, self.held)?;
        Some(self.value + free)
    }
}

/// What back substitution needs of an element: unknown = constant - gain d_right.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Factor<T: Field, B: Block<T>> {
    gain: B::Matrix,
    constant: B::Vector,
    /// The eliminated unknown is d_left instead of e.
    nodal: bool,
}

impl<T: Field, B: Block<T>> Stamp<T, B> {
    /// The element seen from its left node: its energy in (e^, d_left), to be swept over -h.
    #[inline(always)]
    pub(crate) fn mirrored(&self, h: T) -> Self {
        // e = -T e^ and d_right = T^-1 d_left + e^, put into the energy.
        let (fe, fr) = (self.fr - B::carry_back(h, self.fe), B::carry_back(-h, self.fr));
        if self.free {
            return Self { ee: B::congruence(&self.ee, h), fe, fr, ..*self };
        }
        let cross = B::of_energy(&self.rr) + B::negate(&B::carry_matrix(h, &self.er));
        let cross_low = B::of_energy(&self.rr) + B::negate(&B::matrix_carry(&B::lower(self), h));
        Self {
            ee: B::far_end(self, h),
            er: B::matrix_carry(&cross, -h),
            re: B::carry_matrix(-h, &cross_low),
            rr: B::congruence(&self.rr, -h),
            fe,
            fr,
            free: false,
        }
    }
}

impl<T: Field, B: Block<T>> Default for Condensed<T, B> {
    fn default() -> Self {
        Self { s: B::NOTHING, b: B::Vector::default() }
    }
}

impl<T: Field, B: Block<T>> Default for Factor<T, B> {
    fn default() -> Self {
        Self { gain: B::NONE, constant: B::Vector::default(), nodal: false }
    }
}

impl<T: Field, B: Block<T>> Condensed<T, B> {
    /// The element to the right of this node joins; `None` if its pivot breaks down.
    #[inline(always)]
    pub(crate) fn absorb(&self, element: &Stamp<T, B>, h: T) -> Option<(Self, Factor<T, B>)> {
        #[cfg(test)]
        fault::strike()?;
        if B::outweighs(&self.s, &element.ee) {
            return self.absorb_nodal(*element, h);
        }
        self.absorb_relative(element, h)
    }

    /// The same where the part is no stiffer than the element, or not much.
    #[inline(always)]
    pub(crate) fn absorb_relative(&self, element: &Stamp<T, B>, h: T) -> Option<(Self, Factor<T, B>)> {
        let a = self.s + element.ee;
        let load = self.b + element.fe;
        let mut right = B::carry_right(&self.s, h);
        let mut left = B::carry_left(&self.s, h, &right);
        let mut whole = B::congruence(&self.s, h);
        if !element.free {
            right = right + element.er;
            left = left + B::lower(element);
            whole = whole + element.rr;
        }
        let (gain, constant) = B::divide(&a, &right, load)?;
        let s = B::reduce(&whole, &left, &gain);
        let b = B::carry_back(h, self.b) + element.fr - B::times(&left, constant);
        Some((Self { s, b }, Factor { gain, constant, nodal: false }))
    }

    /// The same with d_left as the eliminated unknown. By value, and out of line: it is rare, and the rest is to stay in
    /// registers.
    #[cold]
    #[inline(never)]
    fn absorb_nodal(self, element: Stamp<T, B>, h: T) -> Option<(Self, Factor<T, B>)> {
        let (a, upper) = (self.s + element.ee, upper::<T, B>(&element, h));
        let (gain, constant) = B::divide(&a, &upper, self.b + element.fe)?;
        Some(Self::from_nodal(&element, h, gain, constant))
    }

    /// The unknowns of the node between this part and `other`.
    #[inline]
    pub(crate) fn meet(&self, other: &Self) -> Option<B::Vector> {
        #[cfg(test)]
        fault::strike()?;
        let (_, d) = B::divide(&(self.s + other.s), &B::NONE, self.b + other.b)?;
        Some(d)
    }

    /// The unknowns jump by `jump` across the node: d = d_new + jump. (A kink of the gap.)
    #[inline(always)]
    pub(crate) fn shift(&self, jump: B::Vector) -> Self {
        Self { s: self.s, b: self.b - B::energy_times(&self.s, jump) }
    }

    #[inline]
    fn from_nodal(element: &Stamp<T, B>, h: T, gain: B::Matrix, constant: B::Vector) -> (Self, Factor<T, B>) {
        let ee_t = B::carry_right(&element.ee, h);
        let left = B::lower(element) + B::negate(&B::carry_left(&element.ee, h, &ee_t));
        let s = B::reduce(&B::far_end(element, h), &left, &gain);
        let b = element.fr - B::carry_back(h, element.fe) - B::times(&left, constant);
        (Self { s, b }, Factor { gain, constant, nodal: true })
    }
}

/// U = A_er - A_ee T
#[inline]
fn upper<T: Field, B: Block<T>>(element: &Stamp<T, B>, h: T) -> B::Matrix {
    element.er + B::negate(&B::carry_right(&element.ee, h))
}

impl<T: Field, B: Block<T>> Factor<T, B> {
    /// From its parts, as [`Factor::parts`] gives them.
    #[cfg(feature = "alloc")]
    #[inline(always)]
    pub(crate) fn of((gain, constant, nodal): (B::Matrix, B::Vector, bool)) -> Self {
        Self { gain, constant, nodal }
    }

    /// Its parts, for who stores them apart.
    #[cfg(feature = "alloc")]
    #[inline(always)]
    pub(crate) fn parts(self) -> (B::Matrix, B::Vector, bool) {
        (self.gain, self.constant, self.nodal)
    }

    /// (e, d_left) of the element whose right node moves by `d`.
    #[inline(always)]
    pub(crate) fn substitute(&self, d: B::Vector, h: T) -> (B::Vector, B::Vector) {
        let unknown = self.constant - B::times(&self.gain, d);
        let rigid = B::carry(h, d);
        if self.nodal { (unknown - rigid, unknown) } else { (unknown, rigid + unknown) }
    }
}
