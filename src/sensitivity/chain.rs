//! The tangent system at a solution and its transposed, each solved for one load.
//!
//! With A the tangent of bending where the potential rests, B that of the conduction force in the potential's
//! rates, and E(.) the sums of the fluxes, rates obey
//!
//! ```text
//!     A d(eta) = load - B d(q),      d(u, q) = E(current's rate by d(eta), direct part)
//! ```
//!
//! and weights the transposed, in the opposite order. A is symmetric: one recursion serves both. Without
//! conduction in both directions one of the two is known first and one sweep of bending solves the system. With
//! it d(eta) moves the potential that loads it, and that part of u and q is among the sweep's unknowns
//! ([`crate::element::coupled`]); what u and q do while bending rests is a load, as it is in one direction. So
//! the order is always the same: the fluxes while bending rests, one sweep of bending, the fluxes again.
//!
//! Nothing is allocated: rates of (e, d) go where the solve keeps its spare state, rates at nodes into the room of
//! the elements' factors, which are spent after back substitution. The solution stays as it is.

use super::rate::{Direction, Flow, Rate, Variation, charging, conduction};
use super::{Output, Parameter, SensitivityError};
use crate::electric::{self, Ratio, Reach};
use crate::element::contact::Fault;
use crate::element::coupled::Coupling;
use crate::element::hermite::Motion;
use crate::newton::nested::Answer;
use crate::profile::{Profile, Smooth};
use crate::real::{Pair, Quad, Real, Sum};
use crate::scene::Model;
use crate::solution::{Solution, Solved};
use crate::storage::{Place, State, Work};
use crate::sweep::pair::Bending;
use crate::sweep::quad::Coupled;
use crate::sweep::{Block, Condensed, End, Factor, Stamp};

/// What the system is solved for.
#[derive(Clone, Copy, Debug)]
pub(super) enum Task<T> {
    /// The rates along a direction.
    Rates(Direction<T>),
    /// The weights in an output.
    Weights(Output<T>),
}

/// A solved scene, whose tangent can be swept.
pub(super) struct System<'p, T: Real, M: Model<T>> {
    pub(super) scene: &'p M,
    pub(super) places: &'p mut [Place<T, M>],
    pub(super) answer: Answer<T, M>,
    /// Numbers of the left end, as the places keep those of their right nodes.
    pub(super) left: [T; 4],
    /// Weights of the potentials at both ends in the output.
    pub(super) ends: [T; 2],
}

/// What a place keeps between sweeps: rates at the right node, or the weights of the fluxes.
fn kept<T: Real, M: Model<T>>(places: &[Place<T, M>], i: usize) -> [T; 4] {
    places.get(i).map_or([T::zero(); 4], |place| place.work.factor.kept())
}

/// An element's state among those of the rates.
pub(super) fn moved<T: Real, M: Model<T>>(view: &Solution<'_, T, M>, i: usize) -> State<T> {
    view.places[i].work.states[1 - view.state]
}

/// Rates of all that element i sees, as the sweeps left them.
pub(super) fn variation<T: Real, M: Model<T>>(
    view: &Solution<'_, T, M>,
    i: usize,
    left: [T; 4],
) -> Variation<T> {
    let State { e, d } = moved(view, i);
    let near = i.checked_sub(1).map_or(left, |before| kept(view.places, before));
    Variation { e, d, left: Flow::of(near), right: Flow::of(kept(view.places, i)) }
}

/// The load of element i on (e, d), where the fluxes' rates or weights are `near` and `far`.
fn load<T: Real, M: Model<T>>(
    view: &Solution<'_, T, M>,
    solved: &Solved<'_, T, M>,
    task: Task<T>,
    i: usize,
    [near, far]: [[T; 4]; 2],
) -> (T::Vec2, T::Vec2) {
    match task {
        Task::Rates(along) => {
            let (left, right) = (Flow::of(near), Flow::of(far));
            let by = Variation { left, right, ..Variation::default() };
            let (e, d) = Rate::new(solved, i, along, by).residual();
            (-e, -d)
        }
        // What the penetration weighs in the output itself, and by way of the current.
        Task::Weights(output) => {
            let [m_u, m_q, _, r] = far;
            let (mut e, mut d) = charging(solved, [m_u, m_q, r]);
            if output.concerns(view, i) {
                let weights = Rate::weights(solved, i, output);
                (e, d) = (e + weights.e, d + weights.d);
            }
            (e, d)
        }
    }
}

/// The unknowns of a sweep: those of bending, or these with u and q.
trait Swept<T: Real>: Block<T> {
    /// All of a node's unknowns are held.
    const ALL: Self::Held;

    fn of(pair: T::Vec2) -> Self::Vector;
    fn pair(v: Self::Vector) -> T::Vec2;
    /// The element's tangent, or its transposed.
    fn stamp<M: Model<T>>(solved: &Solved<'_, T, M>, transposed: bool) -> Result<Stamp<T, Self>, Fault>;
    /// Where the element's factor is kept, which there is wherever u and q are swept.
    fn factor<M: Model<T>>(work: &mut Work<T, M>) -> Option<&mut Factor<T, Self>>;
}

impl<T: Real> Swept<T> for Bending {
    const ALL: [bool; 2] = [true; 2];

    fn of(pair: T::Vec2) -> T::Vec2 {
        pair
    }

    fn pair(v: T::Vec2) -> T::Vec2 {
        v
    }

    fn stamp<M: Model<T>>(solved: &Solved<'_, T, M>, _: bool) -> Result<Stamp<T, Self>, Fault> {
        Ok(solved.contact()?.stamp(solved.element))
    }

    fn factor<M: Model<T>>(work: &mut Work<T, M>) -> Option<&mut Factor<T, Self>> {
        Some(&mut work.factor)
    }
}

impl<T: Real> Swept<T> for Coupled {
    const ALL: [bool; 4] = [true; 4];

    fn of(pair: T::Vec2) -> T::Vec4 {
        T::Vec4::of([pair.x(), pair.y(), T::zero(), T::zero()])
    }

    fn pair(v: T::Vec4) -> T::Vec2 {
        let [w, theta, ..] = v.array();
        T::Vec2::of(w, theta)
    }

    fn stamp<M: Model<T>>(solved: &Solved<'_, T, M>, transposed: bool) -> Result<Stamp<T, Self>, Fault> {
        let Solved { scene, element, eta, q, .. } = solved;
        let stamp =
            Coupling::at(*scene, element, eta, q).stamp(element, &solved.contact()?, T::Vec2::default());
        Ok(if transposed { stamp.turned() } else { stamp })
    }

    fn factor<M: Model<T>>(work: &mut Work<T, M>) -> Option<&mut Factor<T, Self>> {
        work.link_mut().map(|link| &mut link.factor)
    }
}

impl<T: Real, M: Model<T>> System<'_, T, M> {
    pub(super) fn view(&self) -> Solution<'_, T, M> {
        Solution::new(self.scene, self.places, self.answer)
    }

    /// Solves the tangent system, or its transposed, for one load.
    pub(super) fn solve(&mut self, task: Task<T>) -> Result<(), SensitivityError> {
        let onto = electric::conducts_onto(self.places);
        let into = electric::conducts_into(self.places);
        // What the sweep needs of the fluxes, while bending rests.
        let first = match task {
            Task::Rates(_) => onto,
            Task::Weights(_) => into,
        };
        if first {
            self.fluxes(task, false);
        }
        if onto && into { self.bend::<Coupled>(task, first) } else { self.bend::<Bending>(task, first) }?;
        self.fluxes(task, true);
        Ok(())
    }

    fn fluxes(&mut self, task: Task<T>, moving: bool) {
        if !electric::present::<T, M>() {
            return;
        }
        match task {
            Task::Rates(along) => self.flux_rates(along, moving),
            Task::Weights(output) => self.flux_weights(output, moving),
        }
    }

    /// One sweep of bending over all elements.
    fn bend<B: Swept<T>>(&mut self, task: Task<T>, flowing: bool) -> Result<(), SensitivityError> {
        let n = self.places.len();
        let spare = 1 - self.answer.state;
        let transposed = matches!(task, Task::Weights(_));
        // The gap moves the penetration at the clamps, and its kinks.
        let with_gap = matches!(task, Task::Rates(along) if along.parameter == Some(Parameter::Gap));
        let clamp = End { held: B::ALL, value: B::Vector::default(), condensed: Condensed::default() };
        let (mut left, mut right) = (clamp, clamp);
        if M::Gap::PRESENT && with_gap {
            let [from, to] = ends_of_gap(&self.view());
            (left.value, right.value) = (B::of(-from), B::of(-to));
        }
        let mut part: Condensed<T, B> = left.condensed;
        let mut near = self.left;
        for i in 0..n {
            let far = kept(self.places, i);
            let flows = if flowing { [near, far] } else { [[T::zero(); 4]; 2] };
            near = far;
            let view = self.view();
            let solved = view.solved(i);
            let mut stamp = B::stamp(&solved, transposed).map_err(|fault| match fault {
                Fault::NotFinite | Fault::NotMonotone => SensitivityError::Law { element: i },
            })?;
            let (fe, fr) = load(&view, &solved, task, i, flows);
            (stamp.fe, stamp.fr) = (B::of(fe), B::of(fr));
            let Place { element, work } = &mut self.places[i];
            let h = element.h;
            if M::Gap::PRESENT && with_gap {
                part = part.shift(B::of(element.gap.kink::<T>()));
            }
            let absorbed = if i == 0 { left.join(&part, &stamp, h) } else { part.absorb(&stamp, h) };
            let Some((absorbed, room)) = absorbed.zip(B::factor(work)) else {
                return Err(SensitivityError::Breakdown { element: i });
            };
            (part, *room) = absorbed;
        }
        let breakdown = SensitivityError::Breakdown { element: n - 1 };
        let mut near = right.close(&part).ok_or(breakdown)?;
        for Place { element, work } in self.places.iter_mut().rev() {
            let (e, far) = B::factor(work).ok_or(breakdown)?.substitute(near, element.h);
            let (e, d) = (B::pair(e), B::pair(near));
            if !(d.x().is_finite() && d.y().is_finite()) {
                return Err(breakdown);
            }
            work.states[spare] = State { e, d };
            near = if M::Gap::PRESENT && with_gap { far + B::of(element.gap.kink::<T>()) } else { far };
        }
        Ok(())
    }

    /// Rates of u, q and the fluxes: the sums of [`electric::solve`] with their derivatives for loads.
    fn flux_rates(&mut self, along: Direction<T>, moving: bool) {
        let (zero, one) = (T::zero(), T::one());
        let (rise, fall) = match along.parameter {
            Some(Parameter::LeftPotential) => (one, zero),
            Some(Parameter::RightPotential) => (zero, one),
            _ => (zero, zero),
        };
        let ratio = Ratio::of(&self.places[0].element);
        let mut reach = Reach::<T, true>::default();
        let (mut load, mut current) = (Sum::<T>::default(), Sum::<T>::default());
        let (mut slack_u, mut slack_q) = (Sum::<T>::default(), Sum::<T>::default());
        for i in 0..self.places.len() {
            let view = self.view();
            let mut by = Variation::default();
            if moving {
                let State { e, d } = moved(&view, i);
                (by.e, by.d) = (e, d);
            }
            let source = Rate::new(&view.solved(i), i, along, by).source();
            let Place { element, work } = &mut self.places[i];
            let (h, mean) = (element.h, element.flexibility.mean());
            let (f, g) = (load.value(), current.value());
            slack_u.add(h * (mean.uu * f + mean.uq * g));
            slack_u.add(-source.u);
            slack_q.add(h * (mean.qq * g - mean.uq * f));
            slack_q.add(-source.q);
            load.add(source.load);
            current.add(source.current);
            reach.extend(h, &element.flexibility, &ratio);
            let through = load.value() + ratio.charge(current.value());
            work.factor.keep([slack_u.value(), slack_q.value(), through, current.value()]);
        }
        let lack = slack_u.value();
        let drop = fall - rise + slack_q.value();
        let [uu, z, uq, qq] = [reach.uu, reach.z, reach.uq, reach.qq].map(Sum::value);
        let (tau, charge) = if !M::Axial::PRESENT {
            (zero, drop / qq)
        } else if !M::Permittivity::PRESENT {
            (lack / uu, zero)
        } else {
            let charge = (drop + uq / uu * lack) / (qq + uq / uu * z);
            ((lack - z * charge) / uu, charge)
        };
        self.left = [zero, rise, tau, charge];
        let mut reach = Reach::<T, true>::default();
        let last = self.places.len() - 1;
        for (i, Place { element, work }) in self.places.iter_mut().enumerate() {
            reach.extend(element.h, &element.flexibility, &ratio);
            let [slack_u, slack_q, through, current] = work.factor.kept();
            let [uu, z, uq, qq] = [reach.uu, reach.z, reach.uq, reach.qq].map(Sum::value);
            let mut u = tau * uu + charge * z - slack_u;
            let mut q = rise + (charge * qq - tau * uq - slack_q);
            if i == last {
                (u, q) = (zero, fall);
            }
            work.factor.keep([u, q, tau - through, charge - current]);
        }
    }

    /// Weights of the fluxes in an output, the transposed of [`System::flux_rates`].
    ///
    /// With weights alpha, beta, of u and q and those of tau and D at nodes, the output is the sum over x of
    /// what happens there: a rate of u' weighs -m_u, one of q' -m_q, both constant between nodes; an axial load
    /// v = integral of (m_u uu - m_q uq) from there to the right end, less the weights of tau beyond; a current
    /// r = integral of (m_u uq + m_q qq), less those of D and ratio times tau's. Places keep m_u, m_q inside the
    /// element, v and r at its right node.
    fn flux_weights(&mut self, output: Output<T>, moving: bool) {
        let zero = T::zero();
        let ratio = Ratio::of(&self.places[0].element);
        let mut reach = Reach::<T, true>::default();
        let (mut first, mut second) = (Sum::<T>::default(), Sum::<T>::default());
        let mut potentials = Sum::<T>::default();
        let n = self.places.len();
        for i in 0..n {
            let (left, right) = self.flow_weights(output, i, moving);
            let mut see = |flow: Flow<T>, reach: &Reach<T, true>| {
                let [uu, z, uq, qq] = [reach.uu, reach.z, reach.uq, reach.qq].map(Sum::value);
                first.add(flow.u * uu - flow.q * uq);
                first.add(flow.tau);
                second.add(flow.u * z + flow.q * qq);
                second.add(flow.charge);
                potentials.add(flow.q);
            };
            see(left, &reach);
            reach.extend(self.places[i].element.h, &self.places[i].element.flexibility, &ratio);
            see(right, &reach);
        }
        let [uu, z, uq, qq] = [reach.uu, reach.z, reach.uq, reach.qq].map(Sum::value);
        let (y_u, y_q) = if !M::Axial::PRESENT {
            (zero, second.value() / qq)
        } else if !M::Permittivity::PRESENT {
            (first.value() / uu, zero)
        } else {
            let y_q = (second.value() - z / uu * first.value()) / (qq + uq * z / uu);
            ((first.value() + uq * y_q) / uu, y_q)
        };
        let (mut m_u, mut m_q) = (Sum::<T>::from(y_u), Sum::<T>::from(y_q));
        let (mut v, mut r) = (Sum::<T>::default(), Sum::<T>::default());
        let mut beyond = Flow::default();
        for i in (0..n).rev() {
            let (left, right) = self.flow_weights(output, i, moving);
            let flow = right.plus(beyond);
            m_u.add(-flow.u);
            m_q.add(-flow.q);
            v.add(-flow.tau);
            r.add(-flow.charge);
            r.add(-ratio.charge(flow.tau));
            let Place { element, work } = &mut self.places[i];
            let (m, n) = (m_u.value(), m_q.value());
            work.factor.keep([m, n, v.value(), r.value()]);
            let (h, mean) = (element.h, element.flexibility.mean());
            v.add(h * (m * mean.uu - n * mean.uq));
            r.add(h * (m * mean.uq + n * mean.qq));
            beyond = left;
        }
        self.ends = [potentials.value() - y_q, y_q];
    }

    /// Weights of the rates at both nodes of element i: in the output itself, and by way of bending.
    fn flow_weights(&self, output: Output<T>, i: usize, moving: bool) -> (Flow<T>, Flow<T>) {
        let view = self.view();
        let solved = view.solved(i);
        let (mut left, mut right) = (Flow::default(), Flow::default());
        if output.concerns(&view, i) {
            let weights = Rate::weights(&solved, i, output);
            (left, right) = (weights.left, weights.right);
        }
        if moving && M::Mu1::PRESENT {
            let State { e, d } = moved(&view, i);
            let (near, far) = conduction(&solved, &Motion::new(solved.element.h, e, d).cubic());
            (left, right) = (left.plus(near), right.plus(far));
        }
        (left, right)
    }
}

/// Gap and its slope at both ends.
fn ends_of_gap<T: Real, M: Model<T>>(view: &Solution<'_, T, M>) -> [T::Vec2; 2] {
    let gap = view.scene.foundation().gap;
    let last = view.places.len() - 1;
    let [s, slope, _] = gap.jet(T::zero(), view.solved(0).mid);
    let [far, far_slope, _] = gap.jet(view.scene.length(), view.solved(last).mid);
    [T::Vec2::of(s, slope), T::Vec2::of(far, far_slope)]
}

/// What the output weighs of the gap's motion at the clamps and at its kinks, where the weights do not satisfy
/// the conditions that the penetration's rates do: the forces that hold the weights there, times the motion.
pub(super) fn held_by_gap<T: Real, M: Model<T>>(view: &Solution<'_, T, M>, output: Output<T>) -> T {
    let forces = |i: usize| {
        let State { e, d } = moved(view, i);
        let solved = view.solved(i);
        let by = Variation { e, d, ..Variation::default() };
        let (on_e, on_d) = Rate::new(&solved, i, Direction::rest(), by).residual();
        let far = kept(view.places, i);
        let (e, d) = load(view, &solved, Task::Weights(output), i, [far; 2]);
        (on_e - e, on_d - d, solved.element.h)
    };
    let [from, to] = ends_of_gap(view);
    let last = view.places.len() - 1;
    let mut sum = Sum::<T>::default();
    sum.add(forces(0).0.times(from));
    let (on_e, on_d, h) = forces(last);
    sum.add((on_d - Bending::carry_back(h, on_e)).times(to));
    for i in 1..=last {
        let kink = view.places[i].element.gap.kink::<T>();
        if kink != T::Vec2::default() {
            sum.add(forces(i).0.times(kink));
        }
    }
    sum.value()
}
