//! What a solution says, computed anew from its public fields alone, by none of the solver's code.
//!
//! Statics: from the left clamp's reaction, loads and contact forces give the moment and shear everywhere; the moment that
//! the solver reports in an element comes from how that element is deformed. Compatibility: curvatures
//! integrate to slopes and deflections, strains to u and q, and these end where the other clamp stands. All
//! sums are plain ones over Gauss points between the kinks of the forces.

use super::tolerances as tol;
use piezobeam::{Compliance, Model, Profile, Real, Smooth, Solution, Warning};
use std::cell::Cell;

/// Departures, each relative to the size of what cancels in it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Departure {
    /// All fields at the points looked at are numbers.
    pub finite: bool,
    /// Moments by deformation and by statics, over the largest moment.
    pub moment: f64,
    /// Deflection by curvatures, over the largest one that its parts could make.
    pub bending: f64,
    /// Fluxes by their sources.
    pub flux: f64,
    /// u and q by strains.
    pub electric: f64,
    /// Reported pressure and that of the law at the reported penetration, where it is not negative.
    pub law: f64,
    /// Largest tension of the contact \[N/m\].
    pub tension: f64,
}

/// Nodes and weights of Gauss's rule of five points on [0, 1].
const GAUSS: [[f64; 2]; 5] = [
    [0.046_910_077_030_668, 0.118_463_442_528_094_54],
    [0.230_765_344_947_158_45, 0.239_314_335_249_683_23],
    [0.5, 0.284_444_444_444_444_44],
    [0.769_234_655_052_841_6, 0.239_314_335_249_683_23],
    [0.953_089_922_969_332, 0.118_463_442_528_094_54],
];

/// Strains u' and q', the sizes of their parts, and those of the fluxes' parts.
struct Strains {
    du: f64,
    dq: f64,
    size_u: f64,
    size_q: f64,
    flux: [f64; 2],
}

/// The cubic on [0, 1] with these values and slopes at its ends.
#[derive(Clone, Copy)]
struct Hermite {
    ends: [f64; 2],
    slopes: [f64; 2],
}

impl Hermite {
    fn at(&self, t: f64) -> f64 {
        let Self { ends: [a, b], slopes: [da, db] } = *self;
        let s = 1.0 - t;
        a + (b - a) * t * t * (3.0 - 2.0 * t) + da * t * s * s - db * t * t * s
    }

    /// A bound of its size.
    fn largest(&self) -> f64 {
        let Self { ends: [a, b], slopes: [da, db] } = *self;
        a.abs().max(b.abs()) + da.abs().max(db.abs())
    }

    /// Where the cubic crosses `level` between `from` and `to`, by bisection between 64 points.
    fn crossings(&self, level: f64, [from, to]: [f64; 2], found: &mut Vec<f64>) {
        let above = |t: f64| self.at(t) > level;
        let point = |i: u32| from + (to - from) * (f64::from(i) / 64.0);
        for i in 0..64_u32 {
            let (mut a, mut b) = (point(i), point(i + 1));
            let side = above(a);
            if above(b) == side {
                continue;
            }
            for _ in 0..60 {
                let middle = 0.5 * (a + b);
                if above(middle) == side { a = middle } else { b = middle }
            }
            found.push(a);
        }
    }
}

/// Finite, in equilibrium, in one piece, and nowhere pulled by the foundation.
pub fn check<T: Real, M: Model<T>>(solution: &Solution<'_, T, M>) -> Result<(), String> {
    let report = solution.report();
    let found = departure(solution);
    let allowed = tol::HONEST.max(tol::HONEST_RESIDUALS * report.residual.max(report.floor).f64());
    // A foundation that was taken as rigid has another law than the scene's, and a warning.
    let rigid = solution.warnings().iter().any(|w| matches!(w, Warning::Rigid { .. }));
    let law = if rigid { 0.0 } else { found.law };
    let worst = [found.moment, found.bending, found.flux, found.electric, law];
    let ok = found.finite && found.tension <= 0.0 && worst.into_iter().all(|departure| departure <= allowed);
    if ok { Ok(()) } else { Err(format!("{found:?}, {report:?}")) }
}

/// The departures of a solution.
pub fn departure<T: Real, M: Model<T>>(solution: &Solution<'_, T, M>) -> Departure {
    let scene = solution.scene();
    let number = |x: f64| T::of(x);
    let finite = Cell::new(true);
    let at = |x: f64| {
        let f = solution.at(number(x));
        let always = [f.bending, f.slope, f.moment, f.shear].map(Some);
        let perhaps = [f.stretching, f.potential, f.axial_force, f.electric_displacement, f.gap, f.pressure];
        let all = always.into_iter().chain(perhaps).flatten().all(T::is_finite);
        finite.set(finite.get() && all);
        f
    };
    let (beam, conduction) = (scene.beam(), scene.conduction());
    let (foundation, load) = (scene.foundation(), scene.load());
    let (most, most_q) = (conduction.truncation.f64(), conduction.potential_truncation.f64());
    let clamp = |z: f64, m: f64| z.clamp(-m, m);
    let nodes: Vec<f64> = solution.nodes().map(Real::f64).collect();
    let zones: Vec<f64> = {
        let mut ends = Vec::new();
        solution.for_each_zone(|a, b| ends.extend([a.f64(), b.f64()]));
        ends
    };
    let resultants = solution.resultants();
    let first = at(0.0);
    let or = |x: Option<T>| x.map_or(0.0, Real::f64);

    let (mut moment, mut shear) = (resultants.left_moment.f64(), resultants.left_force.f64());
    let (mut w, mut theta) = (0.0, 0.0);
    let (mut sigma, mut charge) = (or(first.axial_force), or(first.electric_displacement));
    let (mut u, mut q) = (0.0, scene.potential().left.f64());
    let mut sizes = [moment.abs(), 0.0, 0.0, sigma.abs(), charge.abs(), 0.0, q.abs()];
    let mut worst = [0.0_f64; 7];
    let mut found = Departure::default();
    let (mut lost, mut faint, mut sag) = (0.0, 0.0, 0.0);
    // The reaction is a difference of moments over the length of an element, the longest in the left half or half of it.
    let half = 0.5 * scene.length().f64();
    let halves = nodes.windows(2).take_while(|pair| pair[0] < half);
    let longest = halves.fold(0.0_f64, |most, pair| most.max(pair[1] - pair[0]));
    let [deflected, bent] = nodes
        .windows(2)
        .flat_map(|pair| [pair[0], 0.5 * (pair[0] + pair[1]), pair[1]])
        .map(at)
        .fold([0.0_f64; 2], |[w, m], f| [w.max(f.bending.f64().abs()), m.max(f.moment.f64().abs())]);
    let mut drift = 4.0 * (T::epsilon() + solution.report().residual).f64() * bent / (0.5 * longest);
    // The field is a difference of potentials over the length.
    let ends = scene.potential().left.f64().abs() + scene.potential().right.f64().abs();
    let permittivity = beam.permittivity.value(number(0.0), number(nodes[1])).f64();
    let mut leak = 16.0 * T::epsilon().f64() * permittivity * ends / scene.length().f64();
    // Forces that no mesh resolves may overflow between nodes that are in order, and no naive program sums them.
    let mut resolved = true;
    // The unknown is the penetration: a gap's rounding is in the bending, and what bends the beam so in the moment.
    let length = scene.length().f64();
    let blur = nodes.windows(2).map(|pair| {
        let mid = number(0.5 * (pair[0] + pair[1]));
        let gap = foundation.gap.value(number(pair[1]), mid).f64().abs();
        // Of what is below the normal numbers, too.
        let least = if gap == 0.0 { 0.0 } else { T::min_positive_value().f64() * T::epsilon().f64() };
        let gap = least.max(gap * 256.0 * T::epsilon().f64());
        [gap, gap * (beam.bending.value(mid, mid).f64() / length / length)]
    });
    let blur = blur.fold([0.0_f64; 2], |m, b| [m[0].max(b[0]), m[1].max(b[1])]);
    // So is that of the largest deflection in a small one.
    let blunt = blur[0].max(64.0 * T::epsilon().f64() * deflected);
    // Such bending is nothing but rounding.
    resolved = resolved && (deflected > blur[0] || blur[0] == 0.0);
    let see = |worst: &mut f64, a: f64, b: f64, slack: f64| {
        let slack = slack + T::min_positive_value().f64() / T::epsilon().f64();
        let difference = (a - b).abs();
        *worst = if difference.is_nan() { f64::INFINITY } else { worst.max(difference - slack) };
    };

    for pair in nodes.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let h = b - a;
        let mid = number(a + 0.5 * h);
        let inside = |x: f64| number(x);
        // Strains u' and q' of the fluxes, and the sizes of what cancels in them and in the fluxes.
        let strains = |x: f64, sigma: f64, charge: f64| {
            let value = |v: T| v.f64();
            let (ea, p, eps) = (
                value(beam.axial.value(inside(x), mid)),
                value(beam.piezo.value(inside(x), mid)),
                value(beam.permittivity.value(inside(x), mid)),
            );
            // Elimination by the coupling where its square is above EA eps, else by EA: nothing cancels, and no
            // determinant over- or underflows.
            let [du, dq, size_u, size_q] = match (M::Axial::PRESENT, M::Permittivity::PRESENT) {
                (true, true) if (p / ea).is_finite() && p.abs() / ea <= eps / p.abs() => {
                    let ratio = p / ea;
                    let under = eps + ratio * p;
                    let dq = (charge - ratio * sigma) / under;
                    let size_q = (charge.abs() + (ratio * sigma).abs()) / under;
                    [(sigma + p * dq) / ea, dq, (sigma.abs() + (p * size_q).abs()) / ea, size_q]
                }
                (true, true) => {
                    let ratio = ea / p;
                    let under = ratio * eps + p;
                    let dq = (ratio * charge - sigma) / under;
                    let size_q = ((ratio * charge).abs() + sigma.abs()) / under.abs();
                    [(charge - eps * dq) / p, dq, (charge.abs() + eps * size_q) / p.abs(), size_q]
                }
                (true, false) => [sigma / ea, 0.0, (sigma / ea).abs(), 0.0],
                (false, true) => [0.0, charge / eps, 0.0, (charge / eps).abs()],
                (false, false) => [0.0; 4],
            };
            let mut flux = [(ea * du).abs() + (p * dq).abs(), (p * du).abs() + eps * dq.abs()];
            if M::Axial::PRESENT && M::Permittivity::PRESENT {
                // The solver carries sigma + r D, r = P / eps, and takes it apart again: a documented limit.
                flux[0] += (p / eps * charge).abs();
            }
            Strains { du, dq, size_u, size_q, flux }
        };
        let [fa, fb] = [at(a), at(b)];
        let eta = |x: f64, f: &piezobeam::Fields<T>| {
            let [s, turn, _] = foundation.gap.jet(number(x), mid).map(Real::f64);
            (f.bending.f64() - s, (f.slope.f64() - turn) * h)
        };
        let (ends, slopes) = {
            let ((a0, a1), (b0, b1)) = (eta(a, &fa), eta(b, &fb));
            ([a0, b0], [a1, b1])
        };
        let penetration = Hermite { ends, slopes };
        let slope_q = |x: f64, f: &piezobeam::Fields<T>| {
            h * strains(x, or(f.axial_force), or(f.electric_displacement)).dq
        };
        let potential = Hermite {
            ends: [or(fa.potential), or(fb.potential)],
            slopes: [slope_q(a, &fa), slope_q(b, &fb)],
        };
        let mut splits: Vec<f64> =
            zones.iter().map(|x| (x - a) / h).filter(|t| *t > 0.0 && *t < 1.0).collect();
        if M::Mu1::PRESENT || M::Mu2::PRESENT {
            // Between a truncation's kinks there has to be something for bisection to find.
            let narrow = |most: f64, cubic: &Hermite| most < 1e-9 * cubic.largest();
            let attraction = conduction.mu1.value(mid, mid).f64() * potential.largest().min(most_q);
            let stiff = attraction * h * h * h * h > 1e9 * beam.bending.value(mid, mid).f64();
            resolved = resolved && !stiff && !narrow(most, &penetration) && !narrow(most_q, &potential);
            // A short zone has its own.
            let bounds: Vec<f64> = [0.0].into_iter().chain(splits.clone()).chain([1.0]).collect();
            for part in bounds.windows(2).map(|pair| [pair[0], pair[1]]) {
                penetration.crossings(0.0, part, &mut splits);
                penetration.crossings(most, part, &mut splits);
                potential.crossings(most_q, part, &mut splits);
                potential.crossings(-most_q, part, &mut splits);
            }
        }
        // A crossing within rounding of a node is at it.
        let near = 1e-12_f64.max(8.0 * T::epsilon().f64() * b / h);
        splits.retain(|t| *t > near && 1.0 - *t > near);
        splits.extend([0.0, 1.0]);
        splits.sort_by(f64::total_cmp);
        for part in splits.windows(2) {
            let (from, to) = (part[0], part[1]);
            // A part is so short that rounding of its ends is all there is to it.
            if to - from < 1e-12 {
                continue;
            }
            let (x0, span) = (a + h * from, h * (to - from));
            // Sources at the points and their first and second integrals up to the part's end.
            let (mut force, mut lever, mut current) = (0.0, 0.0, 0.0);
            let (k1, k2) = (conduction.mu1.value(mid, mid).f64(), conduction.mu2.value(mid, mid).f64());
            // What rounding of the penetration, a difference here, makes of the conduction.
            drift += span * k1 * most_q.min(potential.largest()) * blunt.min(most);
            let most_r = blunt + penetration.largest();
            leak += span * k2 * blunt.min(most) * most_r.min(most);
            let fields = GAUSS.map(|[t, _]| at(x0 + span * t));
            for ([t, weight], f) in GAUSS.into_iter().zip(fields) {
                let here = from + (to - from) * t;
                let x = x0 + span * t;
                let p = or(f.pressure);
                found.tension = found.tension.max(-p);
                let r = penetration.at(here).clamp(0.0, most);
                let mu1 = conduction.mu1.value(number(x), mid).f64();
                // Without truncations to speak of the product may be infinite where nothing conducts.
                let drive = if mu1 == 0.0 { mu1 } else { mu1 * (clamp(potential.at(here), most_q) * r) };
                let net = load.transverse.value(number(x), mid).f64() - p - drive;
                force += weight * span * net;
                lever += weight * span * net * (1.0 - t) * span;
                current += weight * span * (conduction.mu2.value(number(x), mid).f64() * r * r);
                drift += 16.0 * T::epsilon().f64() * weight * span * (p.abs() + drive.abs());
                if !M::Law::LINEAR && r > 0.0 {
                    // What is small beside the rest of the element's penetration is its rounding.
                    drift += weight * span * (p / r) * (64.0 * T::epsilon().f64() * penetration.largest());
                }
            }
            // Not beyond the node, where a concentrated load makes a step.
            let end = if to == 1.0 { b } else { x0 + span };
            moment += shear * span + lever;
            shear += force;
            let field = at(end);
            see(&mut worst[0], moment, field.moment.f64(), blur[1] + drift * length);
            sizes[0] = sizes[0].max(field.moment.f64().abs());
            // Moments inside are taken as reported: they have just been compared at both ends of the part.
            let (mut turn, mut lift) = (0.0, 0.0);
            let (mut du, mut dq) = (0.0, 0.0);
            for ([t, weight], f) in GAUSS.into_iter().zip(fields) {
                let x = x0 + span * t;
                let curvature = f.moment.f64() / beam.bending.value(number(x), mid).f64();
                resolved = resolved && (curvature * length * length).is_finite();
                turn += weight * span * curvature;
                // Rounding of the moments bends, too.
                sag += weight * span * (drift * length / beam.bending.value(number(x), mid).f64()) * length;
                lift += weight * span * curvature * (1.0 - t) * span;
                let s = strains(x, or(f.axial_force), or(f.electric_displacement));
                // Below the normal numbers coefficients and fluxes have no digits.
                let tiny = 16.0 * T::min_positive_value().f64() * T::epsilon().f64();
                lost += span * tiny * (1.0 + s.size_q) / beam.axial.value(number(x), mid).f64();
                // Nor has P / EA, which acts on q by the axial force.
                faint += span * tiny * sigma.abs() / beam.permittivity.value(number(x), mid).f64();
                du += weight * span * s.du;
                dq += weight * span * s.dq;
                sizes[1] += weight * span * curvature.abs() * length;
                sizes[3] = sizes[3].max(s.flux[0]);
                sizes[4] = sizes[4].max(s.flux[1]);
                sizes[5] += weight * span * s.size_u;
                sizes[6] += weight * span * s.size_q;
            }
            w += theta * span + lift;
            theta += turn;
            let axial: f64 = GAUSS
                .iter()
                .map(|[t, weight]| weight * span * load.axial.value(number(x0 + span * t), mid).f64())
                .sum();
            sizes[3] += axial.abs();
            sizes[4] += current.abs();
            sigma -= axial;
            charge -= current;
            u += du;
            q += dq;
            see(&mut worst[3], sigma, or(field.axial_force), 0.0);
            see(&mut worst[4], charge, or(field.electric_displacement), leak);
        }
        let field = at(b);
        see(&mut worst[1], w, field.bending.f64(), blur[0] + sag);
        see(&mut worst[5], u, or(field.stretching), lost);
        see(&mut worst[6], q, or(field.potential), faint);
        // A load within rounding of a node acts at it, and at no other.
        let near = 16.0 * T::epsilon().f64() * scene.length().f64();
        let here = |p: &&piezobeam::PointLoad<T>| p.x.f64() > a + near && (p.x.f64() - b).abs() <= near;
        // Loads at one place are one load: their moments may cancel.
        let acting = || load.points.iter().filter(here);
        shear += acting().map(|p| p.force.f64()).sum::<f64>();
        moment -= acting().map(|p| p.moment.f64()).sum::<f64>();
        if M::Law::PRESENT && penetration.ends[1] >= 0.0 {
            let k = foundation.law.coefficient(number(b), mid);
            let r = penetration.ends[1];
            let (p, slope) = foundation.law.pressure(k, number(b), number(r));
            // The slope may not be that of the law, and the law may fall.
            let steep = slope.f64().abs().max(p.f64().abs() / r);
            let rounding = steep * (field.bending.f64().abs() + or(field.gap).abs());
            let size = p.f64().abs().max(or(field.pressure)) + rounding;
            if size > 0.0 {
                // What is small beside the rest of the element's penetration is its rounding.
                let slack = steep * (64.0 * T::epsilon().f64() * penetration.largest());
                let difference = ((p.f64() - or(field.pressure)).abs() - slack).max(0.0);
                found.law = found.law.max(difference / size);
            }
        }
    }
    // The other end is clamped, too.
    see(&mut worst[1], w, 0.0, blur[0] + sag);
    see(&mut worst[5], u, 0.0, lost);
    if M::Permittivity::PRESENT {
        see(&mut worst[6], q, scene.potential().right.f64(), faint);
    }
    let relative = |i: usize| if worst[i] == 0.0 { 0.0 } else { worst[i] / sizes[i] };
    found.finite = finite.get();
    if !resolved {
        return found;
    }
    found.moment = relative(0);
    found.bending = relative(1);
    found.flux = if M::Axial::PRESENT { relative(3) } else { 0.0 };
    found.flux = found.flux.max(if M::Permittivity::PRESENT { relative(4) } else { 0.0 });
    found.electric = if M::Axial::PRESENT { relative(5) } else { 0.0 };
    found.electric = found.electric.max(if M::Permittivity::PRESENT { relative(6) } else { 0.0 });
    found
}
