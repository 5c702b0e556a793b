//! Stretching and potential (2)-(3) of the whole beam by sums of fluxes: no factorisation.
//!
//! With F and G the integrals of the axial load and of the conduction current from the left end, the fluxes
//! are sigma = sigma_0 - F and D = D_0 - G. The end values of u and q give a 2x2 system for the two
//! constants, and u and q at nodes are sums again. Sums carry their rounding along, so that a million
//! elements are as exact as ten.
//!
//! Where the coefficients are constant a uniform field bends the potential but stretches nothing: sigma and
//! P q' cancel. To keep u's digits then, the flux tau = sigma + r D is used instead of sigma, with the ratio
//! r = uq / uu of the first element. In
//!
//! ```text
//!     u' = uu tau + z D,   q' = (qq + r uq) D - uq tau,   z = uq - r uu
//! ```
//!
//! z is exactly zero where the ratio is the same, and nothing cancels.

use crate::cubic::Cubic;
use crate::element::Element;
use crate::element::hermite::Motion;
use crate::element::linear::{Flexibility, Inverse, current};
use crate::profile::{Profile, Slot};
use crate::real::{Real, Sum};
use crate::scene::Model;
use crate::storage::{Node, Place};

/// Has the scene a stretching or a potential?
pub(crate) const fn present<T: Real, M: Model<T>>() -> bool {
    M::Axial::PRESENT || M::Permittivity::PRESENT
}

/// The ratio r of a beam: P / eps of one element.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ratio<T> {
    uu: T,
    uq: T,
    r: T,
    /// 1 / uu
    axial: T,
}

impl<T: Real> Ratio<T> {
    pub(crate) fn of<M: Model<T>>(first: &Element<T, M>) -> Self {
        let Inverse { uu, uq, .. } = first.flexibility.mean();
        let r = if M::Piezo::PRESENT { uq / uu } else { T::zero() };
        Self { uu, uq, r, axial: T::one() / uu }
    }

    /// sigma from tau and D.
    #[inline(always)]
    pub(crate) fn sigma(&self, tau: T, displacement: T) -> T {
        tau - self.r * displacement
    }

    /// What a current G adds to F in tau.
    pub(crate) fn charge(&self, current: T) -> T {
        self.r * current
    }

    /// z = uq - r uu, exactly zero for the ratio's own element.
    #[inline(always)]
    fn excess(&self, k: &Inverse<T>) -> T {
        (k.uq * self.uu - k.uu * self.uq) * self.axial
    }

    /// u' and q' from tau and D.
    #[inline(always)]
    pub(crate) fn gradients<M: Model<T>>(&self, k: &Inverse<T>, tau: T, d: T) -> (T, T) {
        if M::Piezo::PRESENT {
            (k.uu * tau + self.excess(k) * d, (k.qq + self.r * k.uq) * d - k.uq * tau)
        } else {
            (k.uu * tau, k.qq * d)
        }
    }
}

impl<T: Real> Ratio<T> {
    /// A bound of all that the gradients are sums of, whatever P is: uu is at most 1 / EA, qq 1 / eps and uq half of the
    /// root of both.
    pub(crate) fn most<M: Model<T>>(&self, axial: T, permittivity: T, tau: T, d: T) -> T {
        let part = |present: bool, value: T| if present { value.recip() } else { T::zero() };
        let (uu, qq) = (part(M::Axial::PRESENT, axial), part(M::Permittivity::PRESENT, permittivity));
        let uq = if M::Piezo::PRESENT { T::of(0.5) * uu.sqrt() * qq.sqrt() } else { T::zero() };
        let r = self.r.abs();
        tau.abs() * (uu + uq) + d.abs() * (uq + r * uu + qq + r * uq)
    }
}

/// Integrals from the left end of what multiplies tau and D in u' and q'.
#[derive(Clone, Copy, Default)]
pub(crate) struct Reach<T, const EXACT: bool> {
    pub(crate) uu: Sum<T, EXACT>,
    pub(crate) z: Sum<T, EXACT>,
    pub(crate) uq: Sum<T, EXACT>,
    pub(crate) qq: Sum<T, EXACT>,
}

impl<T: Real, const EXACT: bool> Reach<T, EXACT> {
    #[inline(always)]
    pub(crate) fn extend<M: Model<T>>(&mut self, h: T, flexibility: &Flexibility<T, M>, ratio: &Ratio<T>) {
        let mean = flexibility.mean();
        if M::Axial::PRESENT {
            self.uu.add(h * mean.uu);
        }
        if M::Piezo::PRESENT {
            self.z.add(h * ratio.excess(&mean));
            self.uq.add(h * mean.uq);
        }
        if M::Permittivity::PRESENT {
            self.qq.add(h * (mean.qq + ratio.r * mean.uq));
        }
    }
}

/// Solves for u, q and the fluxes at nodes, given the penetration in state number `state`; returns the left
/// end. `EXACT`: with compensated sums.
#[inline(never)]
pub(crate) fn solve<T: Real, M: Model<T>, const EXACT: bool>(
    model: &M,
    places: &mut [Place<T, M>],
    state: usize,
) -> Node<T, M> {
    let ends = model.potential();
    let mut left = Node::default();
    let ratio = match places.first() {
        Some(first) if present::<T, M>() => Ratio::of(&first.element),
        _ => return left,
    };
    // First pass: what the loads alone do across each element, kept at its node until the constants are known.
    let mut reach = Reach::<T, EXACT>::default();
    let (mut load, mut charge) = (Sum::<T, EXACT>::default(), Sum::<T, EXACT>::default());
    let (mut slack_u, mut slack_q) = (Sum::<T, EXACT>::default(), Sum::<T, EXACT>::default());
    for Place { element, work } in &mut *places {
        let mean = element.flexibility.mean();
        let h = element.h;
        let (mut u, mut q) = (T::zero(), T::zero());
        if M::Axial::PRESENT {
            let axial = element.axial.get();
            let before = load.value();
            u = h * mean.uu * before + axial.stretch;
            if M::Piezo::PRESENT {
                q = -(h * mean.uq * before + axial.charge);
            }
            load.add(axial.total);
        }
        if M::Permittivity::PRESENT && M::Mu2::PRESENT {
            let source = current(model, element, &motion(element, work.states[state]));
            let before = charge.value();
            q = q + (h * mean.qq * before + source.charge);
            if M::Piezo::PRESENT {
                u = u + (h * mean.uq * before + source.stretch);
            }
            charge.add(source.total);
        }
        slack_u.add(u);
        slack_q.add(q);
        reach.extend(h, &element.flexibility, &ratio);
        work.node.u = Slot::of(u);
        work.node.q = Slot::of(q);
        work.node.tau = Slot::of(load.value() + ratio.r * charge.value());
        work.node.charge = Slot::of(charge.value());
    }
    // [uu z; -uq qq] (tau_0, D_0)' = (U, drop + V)'; one of the rows may be absent.
    let lack = slack_u.value();
    let drop = ends.right - ends.left + slack_q.value();
    let Reach { uu, z, uq, qq } = reach;
    let (tau, displacement) = match (M::Axial::PRESENT, M::Permittivity::PRESENT) {
        (true, true) => {
            let share = uq.value() / uu.value();
            let displacement = (drop + share * lack) / (qq.value() + share * z.value());
            ((lack - z.value() * displacement) / uu.value(), displacement)
        }
        (true, false) => (lack / uu.value(), T::zero()),
        _ => (T::zero(), drop / qq.value()),
    };
    left.u = Slot::of(T::zero());
    left.q = Slot::of(ends.left);
    left.tau = Slot::of(tau);
    left.charge = Slot::of(displacement);

    // Second pass: the fields.
    let (mut u, mut q) = (Sum::<T, EXACT>::default(), Sum::<T, EXACT>::from(ends.left));
    for Place { element, work } in &mut *places {
        let node = &mut work.node;
        let (by_u, by_q) = ratio.gradients::<M>(&element.flexibility.mean(), tau, displacement);
        if M::Axial::PRESENT {
            u.add(element.h * by_u - node.u.get());
            node.u = Slot::of(u.value());
            node.tau = Slot::of(tau - node.tau.get());
        }
        if M::Permittivity::PRESENT {
            q.add(element.h * by_q - node.q.get());
            node.q = Slot::of(q.value());
            node.charge = Slot::of(displacement - node.charge.get());
        }
    }
    if let Some(Place { work, .. }) = places.last_mut() {
        // Prescribed, so not left to rounding.
        work.node.u = Slot::of(T::zero());
        work.node.q = Slot::of(ends.right);
    }
    left
}

/// What rounding may have left in the potential at nodes, over the largest one. Where P^2 is larger than EA eps by many
/// orders q' is a difference of D / eps and P u' / eps, in tau and D as well.
/// Zero where it is not so many that more than `stop` could be lost.
pub(crate) fn rounding<T: Real, M: Model<T>>(places: &[Place<T, M>], left: &Node<T, M>, stop: T) -> T {
    let Some(first) = places.first().filter(|_| M::Piezo::PRESENT) else { return T::zero() };
    let ratio = Ratio::of(&first.element);
    let most = T::of(0.25) * stop / T::epsilon();
    let few = |Place { element, .. }: &Place<T, M>| {
        let Inverse { uq, qq, .. } = element.flexibility.mean();
        (ratio.r * uq).abs() <= most * qq
    };
    if places.iter().all(few) {
        return T::zero();
    }
    let (mut parts, mut most) = (T::zero(), left.q.get().abs());
    for Place { element, work } in places {
        let Inverse { uq, qq, .. } = element.flexibility.mean();
        let Node { tau, q, charge, .. } = work.node;
        parts = parts + element.h * (((qq + ratio.r * uq) * charge.get()).abs() + (uq * tau.get()).abs());
        most = most.max(q.get().abs());
    }
    if parts == T::zero() { parts } else { T::epsilon() * parts / most }
}

/// What is lost below the normal numbers, where rounding is no part of a number's size: of u and q at nodes, each over its
/// largest value, of the fluxes by what u and q miss at the end of the beam, and of the flexibilities between nodes.
/// Zero where by the first element's coefficients it is nothing to speak of.
pub(crate) fn faint<T: Real, M: Model<T>>(places: &[Place<T, M>], left: &Node<T, M>, length: T) -> T {
    let Some(first) = places.first().filter(|_| present::<T, M>()) else { return T::zero() };
    let ratio = Ratio::of(&first.element);
    let elements = T::from(places.len()).unwrap_or(T::one());
    let unit = T::of(4.0) * elements * T::min_positive_value() * T::epsilon();
    // A current per length acts on the length.
    let flux = unit * (T::one() + length);
    // What units of both fluxes and of the gradients make of u' and q'.
    let made = |k: &Inverse<T>| {
        let of_u = k.uu + ratio.excess(k).abs();
        [unit + flux * of_u, unit + flux * (k.qq + (ratio.r * k.uq).abs() + k.uq.abs())]
    };
    let over = |part: T, whole: T| if whole == T::zero() { T::zero() } else { part / whole };
    let (k, least) = (first.element.flexibility.mean(), T::min_positive_value());
    let ([of_u, of_q], fluxes) = (made(&k), unit * (left.tau.get().abs() + left.charge.get().abs()));
    if (of_u + of_q) * length + fluxes <= least
        && over(unit, k.uu * length) + over(unit, k.qq * length) <= least / T::epsilon()
    {
        return T::zero();
    }
    let zero = [T::zero(); 2];
    let (mut lost, mut reach, mut most, mut fluxes) = (zero, zero, zero, zero);
    let mut see = |node: &Node<T, M>| {
        most = [most[0].max(node.u.get().abs()), most[1].max(node.q.get().abs())];
        fluxes = [fluxes[0].max(node.tau.get().abs()), fluxes[1].max(node.charge.get().abs())];
    };
    see(left);
    for Place { element, work } in places {
        let (h, k) = (element.h, element.flexibility.mean());
        let [of_u, of_q] = made(&k);
        lost = [lost[0] + h * of_u, lost[1] + h * of_q];
        reach = [reach[0] + h * k.uu, reach[1] + h * k.qq];
        see(&work.node);
    }
    let all = unit * (fluxes[0] + fluxes[1]);
    let of = |i: usize| {
        let missed = over(unit, reach[i]);
        over(lost[i] + all, most[i]).max(over(missed + flux, fluxes[i])).max(missed)
    };
    of(0).max(of(1))
}

fn motion<T: Real, M: Model<T>>(element: &Element<T, M>, state: crate::storage::State<T>) -> Motion<T> {
    Motion::new(element.h, state.e, state.d)
}

/// The potential inside an element as the cubic through its values and slopes at the nodes, which the
/// fluxes give: of order h^4, where the P1 interpolant would drop bending to order h^2.
#[inline(always)]
pub(crate) fn potential<T: Real, M: Model<T>>(
    element: &Element<T, M>,
    left: &Node<T, M>,
    right: &Node<T, M>,
    ratio: &Ratio<T>,
) -> Cubic<T> {
    let slope = |t: T, node: &Node<T, M>| {
        let k = element.flexibility.at(t);
        -(element.h * ratio.gradients::<M>(&k, node.tau.get(), node.charge.get()).1)
    };
    Cubic::hermite(right.q.get(), slope(T::zero(), right), left.q.get(), slope(T::one(), left))
}

/// mu2 is there and not zero everywhere.
pub(crate) fn conducts_into<T: Real, M: Model<T>>(places: &[Place<T, M>]) -> bool {
    places.iter().any(|p| p.element.conducts_into())
}

/// mu1 is there and not zero everywhere.
pub(crate) fn conducts_onto<T: Real, M: Model<T>>(places: &[Place<T, M>]) -> bool {
    places.iter().any(|p| p.element.conducts_onto())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]
    use super::*;
    use crate::storage::State;
    use crate::{Beam, Conduction, Foundation, Function, Linear, Load, Mesh, Potential, Scene};
    use glam::DVec2;
    use std::vec::Vec;

    const ENDS: Potential<f64> = Potential { left: -0.5, right: 1.25 };

    /// u, q, sigma and D.
    type Values = [f64; 4];

    /// The penetration as a cubic of x on [0, 1], positive from 0.25 on.
    fn penetration(x: f64) -> [f64; 2] {
        [(x - 0.25) * (1.0 + x * x), 1.0 + x * x + 2.0 * x * (x - 0.25)]
    }

    /// Places on `mesh` in the state of [`penetration`].
    fn places<M: Model<f64>>(model: &M, mesh: Mesh<'_, f64>) -> Vec<Place<f64, M>> {
        let mut places = Vec::new();
        mesh.lay(model, |left, right, stop| {
            let element = Element::sample(model, left, right, stop)?;
            let mut place = Place { element, ..Place::default() };
            let h = element.h;
            let ([wl, tl], [wr, tr]) = (penetration(left), penetration(right));
            let d = DVec2::new(wr, tr);
            place.work.states[1] = State { e: DVec2::new(wl - (wr - h * tr), tl - tr), d };
            places.push(place);
            Ok(())
        })
        .unwrap();
        places
    }

    /// The left end and all nodes, with their x.
    fn solution<M: Model<f64>>(model: &M, mesh: Mesh<'_, f64>) -> Vec<(f64, Values)> {
        let mut places = places(model, mesh);
        let left = solve::<f64, M, true>(model, &mut places, 1);
        let ratio = Ratio::of(&places[0].element);
        let values = |node: &Node<f64, M>| {
            let charge = node.charge.get();
            [node.u.get(), node.q.get(), ratio.sigma(node.tau.get(), charge), charge]
        };
        let mut list = std::vec![(0.0, values(&left))];
        list.extend(places.iter().map(|place| (place.element.right, values(&place.work.node))));
        list
    }

    fn axial(x: f64) -> f64 {
        2.0 + (3.0 * x).sin()
    }
    fn piezo(x: f64) -> f64 {
        0.7 - 1.1 * x
    }
    fn permittivity(x: f64) -> f64 {
        0.5 + 0.2 * (2.0 * x).cos()
    }
    fn stretching(x: f64) -> f64 {
        3.0 * (4.0 * x).cos()
    }
    fn current(x: f64) -> f64 {
        1.5 * (0.5 * x).exp()
    }

    /// The same by the textbook: the ends' conditions on two constants, and integrals by the fourth-order
    /// rule of Runge and Kutta. With neither axial stiffness nor permittivity the other is left.
    fn reference(has: (bool, bool, bool), conducts: bool, steps: u32) -> impl Fn(f64) -> Values {
        let inverse = |x: f64| {
            let (a, p, e) = (axial(x), if has.1 { piezo(x) } else { 0.0 }, permittivity(x));
            let det = a * e + p * p;
            match has {
                (true, _, false) => (1.0 / a, 0.0, 0.0),
                (false, _, true) => (0.0, 0.0, 1.0 / e),
                _ => (e / det, p / det, a / det),
            }
        };
        // F, G, what the loads do to u and q, and the integrals of uu, uq, qq.
        let slope = move |x: f64, y: &[f64; 7]| {
            let (uu, uq, qq) = inverse(x);
            let r = penetration(x)[0].max(0.0);
            let source = if conducts { current(x) * r * r } else { 0.0 };
            let (f, g) = (y[0], y[1]);
            [stretching(x), source, -(uu * f + uq * g), uq * f - qq * g, uu, uq, qq]
        };
        let h = 1.0 / f64::from(steps);
        let mut path = std::vec![[0.0; 7]];
        for i in 0..steps {
            let (x, y) = (f64::from(i) * h, path[path.len() - 1]);
            let along = |k: &[f64; 7], by: f64| core::array::from_fn(|j| y[j] + by * k[j]);
            let k1 = slope(x, &y);
            let k2 = slope(x + h / 2.0, &along(&k1, h / 2.0));
            let k3 = slope(x + h / 2.0, &along(&k2, h / 2.0));
            let k4 = slope(x + h, &along(&k3, h));
            path.push(core::array::from_fn(|j| y[j] + h / 6.0 * (k1[j] + 2.0 * k2[j] + 2.0 * k3[j] + k4[j])));
        }
        let [_, _, u, q, uu, uq, qq] = path[path.len() - 1];
        // uu sigma_0 + uq D_0 = -u, -uq sigma_0 + qq D_0 = drop - q
        let drop = ENDS.right - ENDS.left - q;
        let (sigma, charge) = match has {
            (true, _, false) => (-u / uu, 0.0),
            (false, _, true) => (0.0, drop / qq),
            _ => {
                let det = uu * qq + uq * uq;
                ((-u * qq - drop * uq) / det, (uu * drop - uq * u) / det)
            }
        };
        move |x: f64| {
            let i = (x * f64::from(steps)).round();
            assert!((i / f64::from(steps) - x).abs() < 1e-12, "{x} is no node of the reference");
            let [f, g, u, q, uu, uq, qq] = path[i as usize];
            let q = if has.2 { ENDS.left + q - uq * sigma + qq * charge } else { 0.0 };
            let displacement = if has.2 { charge - g } else { 0.0 };
            [u + uu * sigma + uq * charge, q, if has.0 { sigma - f } else { 0.0 }, displacement]
        }
    }

    /// The largest difference at nodes, of each field over its largest value.
    fn error(got: &[(f64, Values)], want: impl Fn(f64) -> Values) -> f64 {
        let want: Vec<Values> = got.iter().map(|(x, _)| want(*x)).collect();
        (0..4).fold(0.0, |worst: f64, field| {
            let size = want.iter().fold(0.0_f64, |m, v| m.max(v[field].abs()));
            let differ =
                got.iter().zip(&want).fold(0.0_f64, |m, (g, w)| m.max((g.1[field] - w[field]).abs()));
            worst.max(if differ == 0.0 { 0.0 } else { differ / size })
        })
    }

    macro_rules! scene {
        ($axial:expr, $piezo:expr, $permittivity:expr, $load:expr, $mu2:expr) => {
            Scene::new(1.0, Beam { bending: 1.0, axial: $axial, piezo: $piezo, permittivity: $permittivity })
                .foundation(Foundation { law: Linear(1.0), gap: () })
                .conduction(Conduction::new((), $mu2, 100.0))
                .load(Load { transverse: (), axial: $load, points: () })
                .potential(ENDS)
        };
    }

    const STEPS: u32 = 7680;

    #[test]
    fn nodes_are_exact_with_coefficients_that_vary() {
        let scene = scene!(
            Function(axial),
            Function(piezo),
            Function(permittivity),
            Function(stretching),
            Function(current)
        );
        let want = reference((true, true, true), true, STEPS);
        let errors = [4, 8, 16, 64].map(|n| error(&solution(&scene, Mesh::uniform(n)), &want));
        // Order h^8, down to rounding.
        assert!(errors[0] < 1e-6, "{errors:?}");
        assert!(errors[1] < errors[0] / 100.0, "{errors:?}");
        assert!(errors[2] < errors[1] / 100.0, "{errors:?}");
        assert!(errors[3] < 3e-14, "{errors:?}");
        let nodes = [0.0, 0.0125, 0.1, 0.2, 0.25, 0.3, 0.375, 0.5, 0.5125, 0.7, 0.85, 1.0];
        let uneven = error(&solution(&scene, Mesh::Nodes(&nodes)), &want);
        assert!(uneven < 1e-8, "{uneven:e}");
    }

    #[test]
    fn a_penetration_that_is_truncated_is_exact_at_nodes_too() {
        let mut scene = scene!(Function(axial), Function(piezo), Function(permittivity), (), 2.0);
        // Both kinks lie inside elements.
        scene.conduction.truncation = 0.5;
        let fine: Vec<_> = solution(&scene, Mesh::uniform(4096));
        let at = |x: f64| fine[(x * 4096.0) as usize].1;
        let coarse = error(&solution(&scene, Mesh::uniform(64)), at);
        assert!(coarse < 1e-11, "{coarse:e}");
    }

    #[test]
    fn an_absent_piezo_coefficient_is_one_that_is_zero() {
        let permittivity = Function(permittivity);
        let (axial, load, current) = (Function(axial), Function(stretching), Function(current));
        let absent = scene!(axial, (), permittivity, load, current);
        let zero = scene!(axial, 0.0, permittivity, load, current);
        let (absent, zero) = (solution(&absent, Mesh::uniform(32)), solution(&zero, Mesh::uniform(32)));
        let differ = error(&absent, |x| zero.iter().find(|(at, _)| *at == x).unwrap().1);
        assert!(differ < 1e-15, "{differ:e}");
        let wrong = error(&absent, reference((true, false, true), true, STEPS));
        assert!(wrong < 1e-11, "{wrong:e}");
    }

    #[test]
    fn a_beam_may_stretch_without_a_potential() {
        let scene = scene!(Function(axial), (), (), Function(stretching), ());
        let got = solution(&scene, Mesh::uniform(32));
        let wrong = error(&got, reference((true, false, false), false, STEPS));
        assert!(wrong < 1e-11, "{wrong:e}");
        assert!(got.iter().all(|(_, [_, q, _, charge])| *q == 0.0 && *charge == 0.0));
    }

    #[test]
    fn a_beam_may_have_a_potential_and_not_stretch() {
        let scene = scene!((), (), Function(permittivity), (), Function(current));
        let got = solution(&scene, Mesh::uniform(32));
        let wrong = error(&got, reference((false, false, true), true, STEPS));
        assert!(wrong < 1e-11, "{wrong:e}");
        assert!(got.iter().all(|(_, [u, _, sigma, _])| *u == 0.0 && *sigma == 0.0));
    }

    #[test]
    fn a_uniform_field_stretches_nothing() {
        let (a, p, e) = (3.0, 0.7, 0.2);
        let drop = ENDS.right - ENDS.left;
        for (x, [u, q, sigma, charge]) in solution(&scene!(a, p, e, (), ()), Mesh::uniform(37)) {
            assert_eq!(u, 0.0);
            assert!((q - (ENDS.left + drop * x)).abs() < 1e-15);
            assert!((sigma + p * drop).abs() < 1e-14 && (charge - e * drop).abs() < 1e-15);
        }
    }

    #[test]
    fn constant_coefficients_have_the_closed_form() {
        let (a, p, e, f) = (3.0, 0.7, 0.2, 5.0);
        let det = a * e + p * p;
        let drop = ENDS.right - ENDS.left;
        // -(a u' - p q')' = f, (p u' + e q')' = 0: parabolas u = e f x (1 - x) / 2 det, and -p of it in q.
        for (x, [u, q, sigma, charge]) in solution(&scene!(a, p, e, f, ()), Mesh::uniform(10)) {
            let bump = f * x * (1.0 - x) / (2.0 * det);
            assert!((u - e * bump).abs() < 1e-14);
            assert!((q - (ENDS.left + drop * x - p * bump)).abs() < 1e-14);
            assert!((sigma - (f * (0.5 - x) - p * drop)).abs() < 1e-14);
            assert!((charge - e * drop).abs() < 1e-14);
        }
    }

    #[test]
    fn ends_are_as_prescribed_to_the_last_bit() {
        let scene =
            scene!(Function(axial), Function(piezo), Function(permittivity), Function(stretching), 2.0);
        let got = solution(&scene, Mesh::uniform(7));
        let (first, last) = (got[0].1, got[got.len() - 1].1);
        assert_eq!((first[0], first[1]), (0.0, ENDS.left));
        assert_eq!((last[0], last[1]), (0.0, ENDS.right));
    }

    #[test]
    fn a_million_elements_are_as_exact_as_ten() {
        let scene = scene!(3.0, 0.7, 0.2, 5.0, ());
        let got = solution(&scene, Mesh::uniform(1_000_000));
        let det = 3.0 * 0.2 + 0.7 * 0.7;
        let worst = got.iter().fold(0.0_f64, |worst, (x, [u, ..])| {
            worst.max((u - 0.2 * 5.0 * x * (1.0 - x) / (2.0 * det)).abs())
        });
        assert!(worst < 1e-15, "{worst:e}");
    }

    #[test]
    fn the_potential_inside_an_element_is_of_fourth_order() {
        let scene =
            scene!(Function(axial), Function(piezo), Function(permittivity), Function(stretching), ());
        let want = reference((true, true, true), false, STEPS);
        let worst = |n: usize| {
            let mut places = places(&scene, Mesh::uniform(n));
            let mut left = solve::<f64, _, true>(&scene, &mut places, 1);
            let ratio = Ratio::of(&places[0].element);
            places.iter().fold(0.0_f64, |worst, Place { element, work }| {
                let q = potential(element, &left, &work.node, &ratio);
                left = work.node;
                [0.25, 0.5, 0.75]
                    .iter()
                    .fold(worst, |worst, &t| worst.max((q.at(t) - want(element.x(t))[1]).abs()))
            })
        };
        let (coarse, fine) = (worst(8), worst(32));
        assert!(coarse < 2e-4 && fine < coarse / 150.0, "{coarse:e} {fine:e}");
    }

    #[test]
    fn coefficients_that_are_zero_conduct_nothing() {
        let none = scene!(3.0, 0.7, 0.2, 5.0, 0.0);
        let some = scene!(3.0, 0.7, 0.2, 5.0, 1.0);
        assert!(!conducts_into(&places(&none, Mesh::uniform(4))));
        assert!(conducts_into(&places(&some, Mesh::uniform(4))));
        assert!(!conducts_onto(&places(&some, Mesh::uniform(4))));
        let absent = scene!(3.0, 0.7, 0.2, 5.0, ());
        assert_eq!(solution(&none, Mesh::uniform(4)), solution(&absent, Mesh::uniform(4)));
    }
}
