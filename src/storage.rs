//! Memory for a solve: of a fixed size, where the caller puts it, or on the heap; never more than the caller gave.
//!
//! A mesh of N elements needs N places, and the coarser meshes that give a solve its start take what room
//! is left: N / 3 places and some dozen more are enough for all of them. Without them the solver works on the mesh asked
//! for alone and needs more iterations where the foundation is stiff.

use crate::electric::Ratio;
use crate::element::Element;
use crate::element::contact::Touch;
use crate::element::linear::Flexibility;
use crate::law::Compliance;
use crate::profile::{Piece, Profile, Room, Slot};
use crate::real::{Field, Pair, Real};
use crate::scene::Model;
use crate::sweep::pair::Bending;
use crate::sweep::quad::Coupled;
use crate::sweep::{Condensed, Factor};
use core::ops::{Index, IndexMut};

/// Fields at a node: u, q and the fluxes. What the scene lacks takes no room.
pub(crate) struct Node<T: Real, M: Model<T>> {
    pub(crate) u: <M::Axial as Profile<T>>::Slot,
    /// sigma + r D (see [`crate::electric`]).
    pub(crate) tau: <M::Axial as Profile<T>>::Slot,
    pub(crate) q: <M::Permittivity as Profile<T>>::Slot,
    pub(crate) charge: <M::Permittivity as Profile<T>>::Slot,
}

impl<T: Real, M: Model<T>> Clone for Node<T, M> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<T: Real, M: Model<T>> Copy for Node<T, M> {}

impl<T: Real, M: Model<T>> Default for Node<T, M> {
    fn default() -> Self {
        let zero = T::zero();
        Self { u: Slot::of(zero), tau: Slot::of(zero), q: Slot::of(zero), charge: Slot::of(zero) }
    }
}

impl<T: Real, M: Model<T>> Node<T, M> {
    /// The sum of the sizes of all fields.
    fn size(&self, ratio: &Ratio<T>) -> T {
        let (tau, charge) = (self.tau.get(), self.charge.get());
        let sigma = ratio.sigma(tau, charge);
        self.u.get().abs() + tau.abs() + self.q.get().abs() + charge.abs() + sigma.abs()
    }

    /// Are the fields well inside the number format?
    pub(crate) fn is_finite(&self, ratio: &Ratio<T>) -> bool {
        (self.size(ratio) * T::of(1e8)).is_finite()
    }
}

/// An element's deformation: relative unknowns e and the right node's d, both of the penetration.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct State<T: Field> {
    pub(crate) e: T::Vec2,
    pub(crate) d: T::Vec2,
}

impl<T: Field> State<T> {
    /// The state (e, d), or the one that the step (e, d) leads to from here.
    #[inline(always)]
    pub(crate) fn then(self, step: bool, e: T::Vec2, d: T::Vec2) -> Self {
        if step { Self { e: self.e + e, d: self.d + d } } else { Self { e, d } }
    }

    /// The state a share t of the step `step` away.
    #[inline(always)]
    pub(crate) fn plus(self, step: Self, t: T) -> Self {
        Self { e: self.e + step.e * t, d: self.d + step.d * t }
    }

    /// The state at the share t of the way to `other`.
    #[inline(always)]
    pub(crate) fn toward(self, other: Self, t: T) -> Self {
        Self { e: self.e + (other.e - self.e) * t, d: self.d + (other.d - self.d) * t }
    }
}

/// The current iterate and the best one so far. The last bit of an index tells them apart, so that none is out of
/// bounds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct States<T: Real>([State<T>; 2]);

impl<T: Real> States<T> {
    /// The same state twice.
    pub(crate) fn both(state: State<T>) -> Self {
        Self([state; 2])
    }
}

impl<T: Real> Index<usize> for States<T> {
    type Output = State<T>;
    #[inline(always)]
    fn index(&self, which: usize) -> &State<T> {
        &self.0[which & 1]
    }
}

impl<T: Real> IndexMut<usize> for States<T> {
    #[inline(always)]
    fn index_mut(&mut self, which: usize) -> &mut State<T> {
        &mut self.0[which & 1]
    }
}

/// What the monolithic sweep keeps of an element (see [`crate::newton`]).
#[derive(Clone, Copy, Default)]
pub(crate) struct Link<T: Real> {
    /// The Newton step.
    pub(crate) step: State<T>,
    pub(crate) factor: Factor<T, Coupled>,
}

type RoomOf<T, P, X> = <<P as Profile<T>>::Slot as Slot<T>>::Room<X>;

/// Where the potential acts on bending, and only there, a [`Link`].
type Linked<T, M> = RoomOf<T, <M as Model<T>>::Mu1, Link<T>>;

/// What the sweeps keep of an element and its right node.
pub(crate) struct Work<T: Real, M: Model<T>> {
    /// All to the left of the right node.
    pub(crate) condensed: Condensed<T, Bending>,
    pub(crate) factor: Factor<T, Bending>,
    /// Which is which, the iteration knows.
    pub(crate) states: States<T>,
    /// How it touched when it was swept last.
    pub(crate) swept: Touch,
    /// How it touches, where the iteration has looked.
    touch: Touch,
    /// What is missing of equilibrium: differences of force and moment at the left end.
    pub(crate) open: T::Vec2,
    pub(crate) node: Node<T, M>,
    linked: Linked<T, M>,
}

impl<T: Real, M: Model<T>> Work<T, M> {
    /// How the element touches; free without a foundation, which the compiler then knows.
    #[inline(always)]
    pub(crate) fn touch(&self) -> Touch {
        if Touch::possible::<T, M>() { self.touch } else { Touch::Free }
    }

    #[inline(always)]
    pub(crate) fn set_touch(&mut self, touch: Touch) {
        self.touch = touch;
    }

    #[inline(always)]
    pub(crate) fn link(&self) -> Option<&Link<T>> {
        self.linked.look()
    }

    #[inline(always)]
    pub(crate) fn link_mut(&mut self) -> Option<&mut Link<T>> {
        self.linked.open()
    }
}

impl<T: Real, M: Model<T>> Clone for Work<T, M> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<T: Real, M: Model<T>> Copy for Work<T, M> {}

impl<T: Real, M: Model<T>> Default for Work<T, M> {
    fn default() -> Self {
        Self {
            condensed: Condensed::default(),
            factor: Factor::default(),
            states: States::default(),
            swept: Touch::Free,
            touch: Touch::Free,
            open: T::Vec2::default(),
            node: Node::default(),
            linked: Linked::<T, M>::default(),
        }
    }
}

/// A place for one element: its samples and its part of the sweeps.
///
/// Memory is made of these; its size per element is
/// [`Workspace::BYTES_PER_ELEMENT`] and depends on what the scene has.
pub struct Place<T: Real, M: Model<T>> {
    pub(crate) element: Element<T, M>,
    pub(crate) work: Work<T, M>,
}

impl<T: Real, M: Model<T>> Place<T, M> {
    /// Are the fields of the element well inside the number format? Moments may balance where they are not.
    pub(crate) fn is_finite(&self, model: &M, state: usize, ratio: &Ratio<T>) -> bool {
        let State { e, d } = self.work.states[state];
        // Fields inside are integrals of the curvature, some slopes over the length.
        let (slope, h) = (self.element.deforming_force(e).y() / self.element.bending.yy, self.element.h);
        let bending = d.x().abs() + d.y().abs() + slope.abs() * (T::one() + h + T::one() / h);
        let sum = bending + self.work.node.size(ratio) + self.gradients(model, e, ratio);
        let forces = || self.has_finite_forces(e) && self.has_finite_pressures(model, state);
        (sum * T::of(1e8)).is_finite() && (!Touch::possible::<T, M>() || forces())
    }

    /// Are load, shear and moment within a 64th of the largest number? A pressure is larger than the load somewhere,
    /// conduction may all but cancel it, and their sum between the points where it is integrated be none.
    fn has_finite_forces(&self, e: T::Vec2) -> bool {
        let (held, most) = (self.element.deforming_force(e), T::max_value() / T::of(64.0));
        self.element.fr.x().abs() <= self.element.h * most && held.x().abs() + held.y().abs() <= most
    }

    /// So of the pressure of a linear law at both nodes: over a short element its force is a number where it is none itself,
    /// and that closed form is all that was asked for. Other laws were asked at points, and ended the solve.
    fn has_finite_pressures(&self, model: &M, state: usize) -> bool {
        if !M::Law::LINEAR {
            return true;
        }
        let (element, law, most) = (&self.element, model.foundation().law, T::max_value() / T::of(64.0));
        let State { e, d } = self.work.states[state];
        let fits = |t: T, r: T| r <= T::zero() || law.pressure(element.law.at(t), element.x(t), r).0 <= most;
        fits(T::zero(), d.x()) && fits(T::one(), d.x() - element.h * d.y() + e.x())
    }

    /// Sizes of curvature, u' and q' by the coefficients at both ends of the element, where profiles may be far from
    /// what they are inside.
    fn gradients(&self, model: &M, e: T::Vec2, ratio: &Ratio<T>) -> T {
        let (beam, element) = (model.beam(), &self.element);
        let (mut sum, mid) = (T::zero(), element.x(T::of(0.5)));
        for x in [element.right - element.h, element.right] {
            if !<M::Bending as Profile<T>>::Piece::FLAT {
                let curvature = element.largest_moment(e) / beam.bending.value(x, mid);
                sum = sum + curvature.abs() * (T::one() + element.h * (T::one() + element.h));
            }
            if Flexibility::<T, M>::VARIES {
                let (axial, permittivity) = (beam.axial.value(x, mid), beam.permittivity.value(x, mid));
                let Node { tau, charge, .. } = self.work.node;
                let most = ratio.most::<M>(axial, permittivity, tau.get(), charge.get());
                sum = sum + most * (T::one() + element.h);
            }
        }
        sum
    }

    /// Is the beam bent in the element?
    pub(crate) fn is_bent(&self, state: usize) -> bool {
        self.work.states[state].e + self.element.gap.bend::<T>() != T::Vec2::default()
    }
}

impl<T: Real, M: Model<T>> AsRef<Element<T, M>> for Place<T, M> {
    #[inline(always)]
    fn as_ref(&self) -> &Element<T, M> {
        &self.element
    }
}

impl<T: Real, M: Model<T>> Clone for Place<T, M> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<T: Real, M: Model<T>> Copy for Place<T, M> {}

impl<T: Real, M: Model<T>> Default for Place<T, M> {
    fn default() -> Self {
        Self { element: Element::blank(), work: Work::default() }
    }
}

/// Memory for scenes of type `M` with up to `N` elements, coarser meshes included, without an allocator.
pub struct Workspace<T: Real, M: Model<T>, const N: usize> {
    places: [Place<T, M>; N],
}

impl<T: Real, M: Model<T>, const N: usize> Workspace<T, M, N> {
    /// Memory per element in bytes.
    pub const BYTES_PER_ELEMENT: usize = size_of::<Place<T, M>>();

    /// Empty memory.
    #[must_use]
    pub fn new() -> Self {
        const { assert!(N > 0, "a workspace holds one element at least") };
        Self { places: [Place::default(); N] }
    }
}

impl<T: Real, M: Model<T>, const N: usize> Default for Workspace<T, M, N> {
    fn default() -> Self {
        Self::new()
    }
}

/// Memory that a solve can use.
pub trait Storage<T: Real, M: Model<T>> {
    /// Room for `elements` of the mesh and the coarser meshes, if it can be had; else what there is.
    fn places(&mut self, elements: usize) -> &mut [Place<T, M>];
}

impl<T: Real, M: Model<T>, const N: usize> Storage<T, M> for Workspace<T, M, N> {
    fn places(&mut self, _: usize) -> &mut [Place<T, M>] {
        &mut self.places
    }
}

impl<T: Real, M: Model<T>> Storage<T, M> for [Place<T, M>] {
    fn places(&mut self, _: usize) -> &mut Self {
        self
    }
}

/// Memory on the heap, which grows when a scene is laid into it and never during a solve. Where it cannot grow, that is
/// [`Error::Capacity`](crate::Error::Capacity).
#[cfg(feature = "alloc")]
pub struct HeapWorkspace<T: Real, M: Model<T>> {
    places: alloc::vec::Vec<Place<T, M>>,
}

#[cfg(feature = "alloc")]
impl<T: Real, M: Model<T>> HeapWorkspace<T, M> {
    /// Memory per element in bytes.
    pub const BYTES_PER_ELEMENT: usize = size_of::<Place<T, M>>();

    /// Empty memory.
    #[must_use]
    pub fn new() -> Self {
        Self { places: alloc::vec::Vec::new() }
    }
}

#[cfg(feature = "alloc")]
impl<T: Real, M: Model<T>> Default for HeapWorkspace<T, M> {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(feature = "alloc")]
impl<T: Real, M: Model<T>> Storage<T, M> for HeapWorkspace<T, M> {
    fn places(&mut self, elements: usize) -> &mut [Place<T, M>] {
        let room = elements.saturating_add(elements / 3).saturating_add(64);
        let lacks = room.saturating_sub(self.places.len());
        // Memory that cannot be had is an error of who asked for it, not the end of the program.
        if lacks > 0 && self.places.try_reserve_exact(lacks).is_ok() {
            self.places.resize(room, Place::default());
        }
        &mut self.places
    }
}

/// The first `elements` places of `memory`, as many as it has.
pub(crate) fn first<T: Real, M: Model<T>, S: Storage<T, M> + ?Sized>(
    memory: &mut S,
    elements: usize,
) -> &mut [Place<T, M>] {
    let places = memory.places(elements);
    let held = elements.min(places.len());
    places.get_mut(..held).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Mesh;
    use crate::newton::nested::{self, Answer};
    use crate::problem::Problem;
    use crate::profile::Flat;
    use crate::scene::{Beam, Scene};
    use crate::{Error, Settings};

    /// Cloned as a generic container would.
    fn cloned<X: Clone>(x: &X) -> X {
        x.clone()
    }

    #[test]
    fn what_is_copied_is_cloned_the_same() {
        type Whole = Scene<f64, Beam<f64, f64, f64, f64>>;
        let scene = Scene::new(1.0, Beam { bending: 5.0, axial: 4.0, piezo: 3.0, permittivity: 2.0 });
        let element = Element::sample(&scene, 0.0, 0.5, false).unwrap();
        let mean = |element: &Element<f64, Whole>| {
            let mean = element.flexibility.mean();
            [mean.uu, mean.uq, mean.qq]
        };
        assert_eq!(mean(&cloned(&element)), mean(&element));
        assert_eq!(cloned(&element.flexibility).uq, element.flexibility.uq);
        assert!(cloned(&element).bends_like(&element) && cloned(&element).covers(&element));
        let _ = cloned(&element.axial);
        let node = cloned(&Node::<f64, Whole> { u: Flat(3.0), ..Node::default() });
        assert_eq!(Slot::<f64>::get(node.u), 3.0);
        let mut place = Place::<f64, Whole>::default();
        place.work.states[1].e = Pair::of(1.0, 2.0);
        assert_eq!(cloned(&place.work).states[1].e, place.work.states[1].e);
        let problem = Problem::new(scene, Mesh::uniform(2)).unwrap();
        let mut memory = problem.workspace::<8>();
        let mut prepared = problem.prepare(&mut memory).unwrap();
        let report = prepared.solve(&Settings::default()).unwrap();
        assert_eq!(cloned(&prepared.answer.unwrap()).report, report);
    }

    #[test]
    fn no_place_at_all_is_an_error() {
        let scene = Scene::new(1.0, Beam::elastic(1.0));
        let nothing = nested::solve(&scene, &mut [], &nested::Levels::new(), &Settings::default());
        assert_eq!(nothing.map(|_: Answer<_, _>| ()), Err(Error::Capacity { needed: 1, available: 0 }));
    }
}
