//! Newton's method on one mesh for several scenes in lockstep: the same sweeps as [`crate::newton`]'s, from one end to the
//! other, by the same kernels, with a number of each scene in each lane.
//!
//! Which elements touch, and how, differs from lane to lane: free elements are those of stiffness zero, and the few
//! with an edge of contact in them are integrated lane by lane.

use super::lanes::{Lanes, Two};
use crate::element::Element;
use crate::element::contact::{Blocks, Contact, Tangent, uniform};
use crate::element::hermite::Motion;
use crate::law::Compliance;
use crate::newton::Residual;
use crate::profile::{Piece, Profile};
use crate::real::{Field, Pair, Real, Square, Sum};
use crate::scene::Model;
use crate::storage::{Place, State};
use crate::sweep::pair::{Bending, Symmetric};
use crate::sweep::{Block, Condensed, End, Factor, Stamp};

/// What a law without one stiffness on an element has for it.
const VARIED: f64 = -1.0;

/// An element of several scenes, its state and its part of the sweep.
///
/// Sweeps are as fast as memory gives them these, so that there is nothing in them twice.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(super) struct Slot<T: Real, const L: usize> {
    /// Finer elements that this one stands for.
    children: u8,
    h: T,
    bending: Symmetric<Lanes<T, L>>,
    fe: Two<Lanes<T, L>>,
    fr: Two<Lanes<T, L>>,
    /// The gap's bend, and its kink at the left node.
    bend: Two<Lanes<T, L>>,
    kink: Lanes<T, L>,
    /// The law's stiffness \[N/m^2\], or [`VARIED`].
    law: Lanes<T, L>,
    pub(super) state: State<Lanes<T, L>>,
    /// The parts of the sweep's factor.
    gain: <Lanes<T, L> as Field>::Mat2,
    constant: Two<Lanes<T, L>>,
    nodal: bool,
}

impl<T: Real, const L: usize> Default for Slot<T, L> {
    fn default() -> Self {
        Self {
            children: 1,
            h: T::one(),
            bending: Symmetric::default(),
            fe: Two::default(),
            fr: Two::default(),
            bend: Two::default(),
            kink: Lanes::default(),
            law: Lanes::default(),
            state: State::default(),
            gain: Square::ZERO,
            constant: Two::default(),
            nodal: false,
        }
    }
}

impl<T: Real, const L: usize> Slot<T, L> {
    /// Takes `element` for that of lane l.
    pub(super) fn pack<M: Model<T>>(&mut self, l: usize, element: &Element<T, M>) {
        (self.children, self.h) = (element.children, element.h);
        let bending = &element.bending;
        self.bending.xx.set(l, bending.xx);
        self.bending.xy.set(l, bending.xy);
        self.bending.yy.set(l, bending.yy);
        self.fe.set(l, element.fe);
        self.fr.set(l, element.fr);
        if M::Gap::PRESENT {
            self.bend.set(l, element.gap.bend::<T>());
            self.kink.set(l, element.gap.kink::<T>().y());
        }
        let uniform = if M::Law::LINEAR { element.law.constant() } else { None };
        self.law.set(l, uniform.unwrap_or(T::of(VARIED)));
    }

    /// Force and moment at the left end by the deformation, less the load.
    #[inline(always)]
    fn deforming_force<M: Model<T>>(&self, e: Two<Lanes<T, L>>) -> Two<Lanes<T, L>> {
        let bend = if M::Gap::PRESENT { e + self.bend } else { e };
        self.bending.times(bend) - self.fe
    }

    /// The larger one of the moments at both ends by force and moment at the left one.
    #[inline(always)]
    fn moments(&self, force: Two<Lanes<T, L>>) -> Lanes<T, L> {
        let far = force.y() - Lanes::splat(self.h) * force.x();
        force.y().size().larger(far.size())
    }

    /// Jump of the penetration's slope at the left node, seen from right to left.
    #[inline(always)]
    fn kink(&self) -> Two<Lanes<T, L>> {
        Two::of(Lanes::default(), self.kink)
    }

    #[inline(always)]
    fn keep(&mut self, factor: Factor<Lanes<T, L>, Bending>) {
        (self.gain, self.constant, self.nodal) = factor.parts();
    }

    #[inline(always)]
    fn factor(&self) -> Factor<Lanes<T, L>, Bending> {
        Factor::of((self.gain, self.constant, self.nodal))
    }

    #[inline(always)]
    fn motion(&self) -> Motion<Lanes<T, L>> {
        Motion::new(Lanes::splat(self.h), self.state.e, self.state.d)
    }
}

/// Several scenes on one mesh.
pub(super) struct Lockstep<'a, T: Real, M: Model<T>, const L: usize> {
    /// Of each lane.
    pub(super) scenes: [&'a M; L],
    pub(super) places: [&'a [Place<T, M>]; L],
    pub(super) left: End<Lanes<T, L>, Bending>,
    pub(super) right: End<Lanes<T, L>, Bending>,
    pub(super) slots: &'a mut [Slot<T, L>],
    /// Lanes that a law's fault or a sweep's breakdown has spoilt.
    pub(super) spoilt: [bool; L],
}

impl<T: Real, M: Model<T>, const L: usize> Lockstep<'_, T, M, L> {
    /// A full Newton step; by how much it moves the beam, relative to its moments. `touches`: with the foundation's law.
    #[inline(never)]
    pub(super) fn step(&mut self, touches: bool) -> Option<Lanes<T, L>> {
        let mut part = Condensed::default();
        self.join(0, &mut part, touches)?;
        for i in 1..self.slots.len() {
            let stamp = self.stamp(i, touches);
            let slot = self.slots.get_mut(i)?;
            if Bending::outweighs(&part.s, &stamp.ee) {
                self.join(i, &mut part, touches)?;
                continue;
            }
            if M::Gap::PRESENT {
                part = part.shift(slot.kink());
            }
            let (next, factor) = part.absorb_relative(&stamp, Lanes::splat(slot.h))?;
            slot.keep(factor);
            part = next;
        }
        let mut near = self.right.close(&part)?;
        let (mut moved, mut size) = (Lanes::default(), Lanes::default());
        for slot in self.slots.iter_mut().rev() {
            let (e, far) = slot.factor().substitute(near, Lanes::splat(slot.h));
            moved = slot.moments(slot.bending.times(e - slot.state.e)).larger(moved);
            size = slot.moments(slot.deforming_force::<M>(e)).larger(size);
            slot.state = State { e, d: near };
            near = if M::Gap::PRESENT { far + slot.kink() } else { far };
        }
        Some(moved.with(size, |moved, size| if moved == T::ZERO { moved } else { moved / size }))
    }

    /// Condenses element i into the part on its left, the first one into the clamp.
    #[inline(never)]
    fn join(&mut self, i: usize, part: &mut Condensed<Lanes<T, L>, Bending>, touches: bool) -> Option<()> {
        let stamp = self.stamp(i, touches);
        let slot = self.slots.get_mut(i)?;
        let (h, before) =
            (Lanes::splat(slot.h), if M::Gap::PRESENT { part.shift(slot.kink()) } else { *part });
        let joined = if i == 0 { self.left.join(&before, &stamp, h) } else { before.absorb(&stamp, h) };
        let (next, factor) = joined?;
        slot.keep(factor);
        *part = next;
        Some(())
    }

    /// The part of element i in a sweep.
    #[inline(always)]
    fn stamp(&mut self, i: usize, touches: bool) -> Stamp<Lanes<T, L>, Bending> {
        let contact = if touches { self.contact(i) } else { None };
        let blank = Slot::default();
        let slot = self.slots.get(i).unwrap_or(&blank);
        let (mut ee, mut fe, mut fr, free) = (slot.bending, slot.fe, slot.fr, contact.is_none());
        if M::Gap::PRESENT {
            fe = fe - slot.bending.times(slot.bend);
        }
        let none = <Lanes<T, L> as Field>::Mat2::ZERO;
        let (mut er, mut rr) = (none, Symmetric::default());
        if let Some(Touching { blocks, offset: (oe, or) }) = contact {
            (ee, er, rr) = (ee + blocks.0, blocks.1, blocks.2);
            (fe, fr) = (fe + oe, fr + or);
        }
        Stamp { ee, er, re: none, rr, fe, fr, free }
    }

    /// The contact of element i; `None` where it is free in all lanes.
    #[inline(always)]
    fn contact(&mut self, i: usize) -> Option<Touching<T, L>> {
        let slot = self.slots.get(i)?;
        let (motion, law, h) = (slot.motion(), slot.law, Lanes::splat(slot.h));
        let eta = motion.cubic();
        // As `Cubic::side`: what may be rounding is on neither side.
        let noise = eta.noise();
        let [b0, b1, b2, b3] = eta.control(Lanes::default());
        let least = b0.smaller(b1).smaller(b2.smaller(b3)) + noise;
        let most = b0.larger(b1).larger(b2.larger(b3)) - noise;
        let zero = T::ZERO;
        if most.0.iter().fold(true, |free, most| free & (*most <= zero)) {
            return None;
        }
        let whole = least.with(law, |least, law| if least > zero { law } else { zero });
        let mut touching = Touching { blocks: uniform(whole * h, h), offset: Default::default() };
        // Neither free nor whole, or no number.
        let parts: [bool; L] = core::array::from_fn(|l| {
            let (least, most, law) = (least.lane(l), most.lane(l), law.lane(l));
            !((most <= zero) | ((least > zero) & (law >= zero)))
        });
        if parts.iter().fold(false, |any, part| any | part) {
            for l in (0..L).filter(|&l| parts.get(l) == Some(&true)) {
                self.touch_partly(i, l, &motion, &mut touching);
            }
        }
        Some(touching)
    }

    /// The contact of element i in one lane, by quadrature.
    #[inline(never)]
    fn touch_partly(
        &mut self,
        i: usize,
        l: usize,
        motion: &Motion<Lanes<T, L>>,
        touching: &mut Touching<T, L>,
    ) {
        let (Some(scene), Some(place)) =
            (self.scenes.get(l), self.places.get(l).and_then(|lane| lane.get(i)))
        else {
            return;
        };
        let element = &place.element;
        let motion = Motion::new(element.h, motion.e.lane(l), motion.d.lane(l));
        match Contact::split(*scene, element, &motion.cubic(), None, T::one(), Tangent::Whole) {
            Ok(contact) => touching.set(l, &contact, element.h),
            Err(_) => {
                if let Some(spoilt) = self.spoilt.get_mut(l) {
                    *spoilt = true;
                }
            }
        }
    }

    /// The residuals by statics (see [`crate::newton`]), with the sizes `quiet` that moments are compared with at least.
    #[inline(never)]
    pub(super) fn balance(&mut self, quiet: Lanes<T, L>, length: T) -> Option<[Residual<T>; L]> {
        let zero = Lanes::<T, L>::default();
        // The largest deflection and slope of a node, and of what the largest moment can bend an element by.
        let (mut largest, mut softest, mut lengths) =
            (zero, self.slots.first()?.bending.yy, (T::one(), T::one()));
        let (mut mismatch, mut size, mut load, mut sum) = (zero, zero, zero, zero);
        let (mut rest, mut pushed) = (zero, zero);
        let (mut force, mut moment) = (Sum::<Lanes<T, L>>::default(), Sum::<Lanes<T, L>>::default());
        for i in 0..self.slots.len() {
            let contact = self.contact(i);
            let slot = self.slots.get_mut(i)?;
            let (h, State { e, d }) = (Lanes::splat(slot.h), slot.state);
            let (mut held, mut cd) = (slot.deforming_force::<M>(e), Two::default());
            if let Some(Touching { blocks: (ee, er, rr), offset: (oe, or) }) = contact {
                held += ee.times(e) + er * d - oe;
                cd = er.turned() * e + rr.times(d) - or;
                load = load + cd.x().size() + or.x().size();
            }
            if i == 0 {
                (force, moment) = (Sum::from(-held.x()), Sum::from(-held.y()));
            }
            // The factor is spent: its room holds what is missing of equilibrium.
            let open = Two::of(force.plus(held.x()), moment.plus(held.y()));
            slot.constant = open;
            rest = open.y() - h * open.x();
            let carried = cd - slot.fr;
            size = held.y().size().larger(size);
            largest = d.x().size().larger(d.y().size()).larger(largest);
            softest = slot.bending.yy.smaller(softest);
            lengths = (lengths.0.min(slot.h), lengths.1.max(slot.h));
            load = load + slot.fr.x().size();
            pushed = slot.fr.x().size().larger(pushed);
            moment.add(-(h * force.value()));
            moment.add(carried.y());
            force.add(carried.x());
        }
        let last = self.slots.last()?;
        size = last.moments(last.deforming_force::<M>(last.state.e)).larger(size);
        let slip = rest / Lanes::splat(length);
        let mut right = zero;
        for slot in self.slots.iter() {
            let open = slot.constant + Two::of(slip, -(slip * right));
            let far = open.y() - Lanes::splat(slot.h) * open.x();
            mismatch = open.y().size().larger(far.size()).larger(mismatch);
            sum = sum + far;
            right = right + Lanes::splat(slot.h);
        }
        // As `Place::is_finite`: fields are to be well inside the number format, loads within a 64th of it.
        let pushed = pushed / Lanes::splat(lengths.0) * Lanes::splat(T::of(64e-8));
        let bent = size / softest * Lanes::splat(lengths.1 + T::of(2.0) / lengths.0);
        sum = sum
            + (largest + bent + pushed)
                .map(|field| if (field * T::of(1e8)).is_finite() { T::ZERO } else { T::infinity() });
        let size = size.larger(quiet);
        Some(core::array::from_fn(|l| {
            Residual::of(mismatch.lane(l), size.lane(l), load.lane(l) * length, sum.lane(l))
        }))
    }
}

/// What of a contact a sweep needs.
#[derive(Clone, Copy)]
struct Touching<T: Real, const L: usize> {
    blocks: Blocks<Lanes<T, L>>,
    offset: (Two<Lanes<T, L>>, Two<Lanes<T, L>>),
}

impl<T: Real, const L: usize> Touching<T, L> {
    /// Sets what one lane has of it.
    fn set(&mut self, l: usize, contact: &Contact<T>, h: T) {
        let Some((ee, er, rr)) = contact.tangent(h) else { return };
        let put = |to: &mut Symmetric<Lanes<T, L>>, from: &Symmetric<T>| {
            to.xx.set(l, from.xx);
            to.xy.set(l, from.xy);
            to.yy.set(l, from.yy);
        };
        put(&mut self.blocks.0, &ee);
        put(&mut self.blocks.2, &rr);
        let mut columns = self.blocks.1.columns();
        for (column, from) in columns.iter_mut().zip(er.columns()) {
            for (to, from) in column.iter_mut().zip(from) {
                to.set(l, from);
            }
        }
        self.blocks.1 = Square::of(columns);
        if let Some((oe, or)) = contact.offset(h) {
            self.offset.0.set(l, oe);
            self.offset.1.set(l, or);
        }
    }
}

/// The state of a coarser mesh, on the next finer one: the same cubics.
pub(super) fn prolong<T: Real, const L: usize>(fine: &mut [Slot<T, L>], coarse: &[Slot<T, L>]) {
    let mut parts = fine.iter_mut();
    for slot in coarse {
        let whole = slot.motion();
        let mut right = T::one();
        for _ in 0..slot.children {
            let Some(part) = parts.next() else { return };
            let share = part.h / slot.h;
            right = (right - share).max(T::zero());
            let motion = whole.part(Lanes::splat(right), Lanes::splat(share));
            part.state = State { e: motion.e, d: motion.d };
        }
    }
}
