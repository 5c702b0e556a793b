//! Scenes with a closed form, and relations between scenes that hold exactly.
#![allow(clippy::expect_used, reason = "a test that cannot go on fails")]

mod common;

use common::{fields, plain, points, relative, solved, tolerances as tol};
use piezobeam::{
    Beam, Conduction, Fields, Foundation, Linear, Load, Mesh, Model, PointLoad, Polynomial, Potential, Power,
    Real, Report, Scene, Status, Steps, Table,
};

fn converged<T: Real>(report: &Report<T>) {
    assert_eq!(report.status, Status::Converged, "{report:?}");
}

fn bending(at: &[Fields<f64>]) -> Vec<f64> {
    at.iter().map(|f| f.bending).collect()
}

/// Load f on a free clamped beam of stiffness C and length L.
fn free_beam(f: f64, c: f64, length: f64) -> impl Fn(f64) -> f64 {
    move |x| f * x * x * (length - x) * (length - x) / (24.0 * c)
}

#[test]
fn a_free_beam_is_exact_at_every_node_up_to_a_million_elements() {
    let (f, c, length) = (1e6, 5000.0, 1.0);
    let exact = free_beam(f, c, length);
    let most = exact(0.5 * length);
    for n in [10_usize, 100, 1000, 10_000, 100_000, 1_000_000] {
        let error = solved(Scene::new(length, Beam::elastic(c)).load(plain(f)), Mesh::uniform(n), |s| {
            converged(s.report());
            let stride = (n / 1000).max(1);
            s.nodes().step_by(stride).map(|x| (s.at(x).bending - exact(x)).abs()).fold(0.0, f64::max)
        });
        assert!(error <= tol::FREE * most, "N = {n}: {:.1e}", error / most);
    }
}

#[test]
fn one_or_three_elements_are_exact_between_nodes_too() {
    few_elements_are_exact(&[1, 3, 4, 5]);
}

#[test]
fn two_elements_are_exact_between_nodes_too() {
    few_elements_are_exact(&[2]);
}

fn few_elements_are_exact(counts: &[usize]) {
    let (f, c, length) = (-3.0, 7.0, 2.5);
    let exact = free_beam(f, c, length);
    for &n in counts {
        let x = points(50, length);
        let (report, at) = fields(Scene::new(length, Beam::elastic(c)).load(plain(f)), Mesh::uniform(n), &x);
        converged(&report);
        assert_eq!(report.elements, n);
        let want: Vec<f64> = x.iter().map(|&x| exact(x)).collect();
        assert!(relative(&bending(&at), &want) <= tol::EXACT);
        let moment: Vec<f64> = at.iter().map(|f| f.moment).collect();
        let shear: Vec<f64> = at.iter().map(|f| f.shear).collect();
        let of = |g: &dyn Fn(f64) -> f64| x.iter().map(|&x| g(x)).collect::<Vec<_>>();
        assert!(
            relative(&moment, &of(&|x| f * (length * length / 12.0 - 0.5 * x * (length - x)))) <= tol::EXACT
        );
        assert!(relative(&shear, &of(&|x| f * (x - 0.5 * length))) <= tol::EXACT);
    }
}

#[test]
fn a_graded_mesh_is_exact_too() {
    graded_is_exact(&[1.0, 10.0, 1e-3, 1e3]);
}

#[test]
fn a_steeply_graded_mesh_is_exact_too() {
    graded_is_exact(&[1e6, 1e-6]);
}

fn graded_is_exact(ratios: &[f64]) {
    let (f, c, l) = (1.0, 1.0, 1.0);
    let (x, exact) = (points(32, l), free_beam(f, c, l));
    let want: Vec<f64> = x.iter().map(|&x| exact(x)).collect();
    for &ratio in ratios {
        for elements in [4, 10, 100] {
            let mesh = Mesh::Graded { elements, ratio };
            let (report, at) = fields(Scene::new(l, Beam::elastic(c)).load(plain(f)), mesh, &x);
            assert!(relative(&bending(&at), &want) <= tol::EXACT, "{ratio:e}, {elements}");
            converged(&report);
        }
    }
}

#[test]
fn breaks_that_crowd_are_no_harm() {
    let breaks: Vec<f64> = (1..50).map(|i| 0.5 + 1e-14 * f64::from(i)).collect();
    let values: Vec<f64> = (0..50).map(|i| if i % 2 == 0 { 2.0 } else { -1.0 }).collect();
    let load = Steps { breaks: &breaks, values: &values };
    let half = Steps { breaks: &[0.5], values: &[2.0, -1.0] };
    let x = points(20, 1.0);
    for n in [4, 10, 100] {
        let on = Scene::new(1.0, Beam::elastic(1.0));
        let (report, got) = fields(on.load(plain(load)), Mesh::uniform(n), &x);
        converged(&report);
        let (_, want) = fields(on.load(plain(half)), Mesh::uniform(n), &x);
        assert!(relative(&bending(&got), &bending(&want)) <= tol::CROWD, "N = {n}");
    }
}

/// Deflection at x by a force 1 at a, and its derivative in a: that by a moment 1.
fn influence(x: f64, a: f64, c: f64, l: f64) -> [f64; 2] {
    if x > a {
        let [force, moment] = influence(l - x, l - a, c, l);
        return [force, -moment];
    }
    let (b, shape) = (l - a, 3.0 * a * l - x * (2.0 * a + l));
    let factor = x * x / (6.0 * c * l * l * l);
    [factor * b * b * shape, factor * b * (b * (3.0 * l - 2.0 * x) - 2.0 * shape)]
}

#[test]
fn concentrated_forces_and_moments_act_where_they_stand() {
    concentrated_loads_are_exact(&[7, 100, 1000], &INSIDE);
    concentrated_loads_are_exact(&[100, 1000], &NEAR_CLAMPS);
}

#[test]
fn concentrated_forces_and_moments_act_on_two_or_three_elements() {
    concentrated_loads_are_exact(&[1, 2, 3], &INSIDE);
}

#[test]
fn concentrated_forces_and_moments_act_beside_a_clamp_on_few_elements() {
    concentrated_loads_are_exact(&[3, 7], &NEAR_CLAMPS);
}

const INSIDE: [f64; 4] = [0.2, 0.1 + 0.2, 0.75, std::f64::consts::FRAC_1_SQRT_2];
const NEAR_CLAMPS: [f64; 2] = [1e-3, 1.4999];

fn concentrated_loads_are_exact(counts: &[usize], places: &[f64]) {
    let (c, l) = (3.0, 1.5);
    let x = points(40, l);
    for &a in places {
        for &n in counts {
            for (force, moment) in [(2.0, 0.0), (0.0, -3.0), (1.0, 0.5)] {
                let load = Load { transverse: (), axial: (), points: [PointLoad { x: a, force, moment }] };
                let (report, at) = fields(Scene::new(l, Beam::elastic(c)).load(load), Mesh::uniform(n), &x);
                converged(&report);
                let deflection = |&x: &f64| {
                    let [by_force, by_moment] = influence(x, a, c, l);
                    force * by_force + moment * by_moment
                };
                let want: Vec<f64> = x.iter().map(deflection).collect();
                let error = relative(&bending(&at), &want);
                assert!(error <= tol::POINT, "a = {a}, N = {n}, {force} {moment}: {error:.1e}");
            }
        }
    }
}

#[test]
fn a_load_within_rounding_of_given_nodes_counts_once() {
    let (c, l) = (1.0, 1.0);
    let a: f64 = 0.3;
    let load = Load { transverse: (), axial: (), points: [PointLoad { x: a, force: 1.0, moment: 0.0 }] };
    // 0.1 + 0.2 is the number above 0.3.
    let nodes = [0.0, 0.1 + 0.2, 0.7, 1.0];
    let scene = Scene::new(l, Beam::elastic(c)).load(load);
    let (sum, report) = solved(scene, Mesh::Nodes(&nodes), |s| (s.resultants().load, *s.report()));
    converged(&report);
    assert_eq!(sum, 1.0);
}

/// w / (f L^4 / C) at z = x / L - 1/2 of a clamped beam on springs, K = k L^4 / C.
fn winkler(z: f64, stiffness: f64) -> f64 {
    if stiffness < 100.0 {
        // Power series, without the difference of nearly equal numbers that the closed form is here.
        let series = |z: f64, first: u32| {
            let mut term = (1..=first).fold(1.0, |t, j| t * z / f64::from(j));
            let (mut sum, mut slope, mut power) = (0.0, 0.0, first);
            for _ in 0..30 {
                sum += term;
                slope += if z == 0.0 { 0.0 } else { term * f64::from(power) / z };
                term *= -stiffness * z.powi(4) / (1..=4).map(|j| f64::from(power + j)).product::<f64>();
                power += 4;
            }
            (sum, slope)
        };
        let [(p, dp), (u, du), (v, dv)] = [4, 0, 2].map(|first| series(0.5, first));
        let det = u * dv - v * du;
        let (a, b) = ((v * dp - p * dv) / det, (p * du - u * dp) / det);
        return series(z, 4).0 + a * series(z, 0).0 + b * series(z, 2).0;
    }
    let beta = (0.25 * stiffness).powf(0.25);
    let (end, here) = (0.5 * beta, beta * z);
    let (sn, cs, sh, ch) = (end.sin(), end.cos(), end.sinh(), end.cosh());
    let det = 0.5 * ((2.0 * end).sin() + (2.0 * end).sinh());
    let (a, b) = ((ch * sn + sh * cs) / det, (ch * sn - sh * cs) / det);
    (1.0 - a * here.cosh() * here.cos() - b * here.sinh() * here.sin()) / stiffness
}

#[test]
fn the_closed_form_of_full_contact_is_the_same_both_ways() {
    // Where the series and the hyperbolic functions meet.
    for z in [0.0, 0.1, 0.25, 0.4, 0.49] {
        let (series, closed) = (winkler(z, 99.999_999_999), winkler(z, 100.000_000_001));
        assert!((series - closed).abs() < 1e-12, "{z}: {series} {closed}");
    }
}

#[test]
fn full_contact_is_a_beam_on_springs() {
    let (c, l, f, n) = (2.0, 3.0, 5.0, 1000_u32);
    let x = points(100, l);
    for exponent in -3..=6 {
        let stiffness = 10.0_f64.powi(exponent);
        let k = stiffness * c / l.powi(4);
        let scene =
            Scene::new(l, Beam::elastic(c)).foundation(Foundation { law: Linear(k), gap: () }).load(plain(f));
        let (report, at) = fields(scene, Mesh::uniform(n as usize), &x);
        converged(&report);
        let want: Vec<f64> = x.iter().map(|x| f * l.powi(4) / c * winkler(x / l - 0.5, stiffness)).collect();
        let error = relative(&bending(&at), &want);
        let order = tol::WINKLER_ORDER * stiffness / f64::from(n).powi(4);
        assert!(error <= tol::WINKLER + order, "K = {stiffness:e}: {error:.1e}");
    }
}

#[test]
fn a_beam_does_not_sag_between_nodes_into_a_foundation_stiffer_than_its_elements() {
    let (f, x) = (1e6, points(1000, 1.0));
    for k in [1e14, 1e16, 1e20] {
        let scene = Scene::new(1.0, Beam::elastic(5000.0))
            .foundation(Foundation { law: Linear(k), gap: () })
            .load(plain(f));
        let (report, at) = fields(scene, Mesh::uniform(50), &x);
        converged(&report);
        for at in at {
            // Everywhere as deep as the pressure says, which the mesh resolves to a factor beside the clamps.
            let pressure = at.pressure.unwrap_or(f64::NAN);
            assert!((at.bending - pressure / k).abs() <= 1e-12 * f / k, "k = {k:e}: {at:?}");
            assert!((-1e-12 * f / k..=3.0 * f / k).contains(&at.bending), "k = {k:e}: {at:?}");
        }
    }
}

#[test]
fn a_preload_in_full_contact_is_a_shift_of_the_load() {
    preload_shifts_the_load(10, &[(1.0, 0.0), (100.0, 0.5), (1e4, 5.0)]);
    preload_shifts_the_load(100, &[(100.0, 0.5), (1e4, 5.0), (1e6, 500.0)]);
}

#[test]
fn a_preload_in_full_contact_is_a_shift_of_the_load_on_fine_meshes_too() {
    preload_shifts_the_load(1000, &[(1.0, 0.0), (100.0, 0.5), (1e4, 5.0), (1e6, 500.0)]);
}

fn preload_shifts_the_load(n: u32, scenes: &[(f64, f64)]) {
    let (c, l, preload) = (2.0, 3.0, 0.01);
    let x = points(100, l);
    for &(stiffness, f) in scenes {
        let k: f64 = stiffness * c / l.powi(4);
        let scene = Scene::new(l, Beam::elastic(c))
            .foundation(Foundation { law: Linear(k), gap: -preload })
            .load(plain(f));
        let (report, at) = fields(scene, Mesh::uniform(n as usize), &x);
        converged(&report);
        assert!(at.iter().all(|f| f.pressure > Some(0.0)), "contact everywhere");
        let net = f - k * preload;
        let want: Vec<f64> =
            x.iter().map(|x| net * l.powi(4) / c * winkler(x / l - 0.5, stiffness)).collect();
        let error = relative(&bending(&at), &want);
        let order = tol::WINKLER_ORDER * stiffness / f64::from(n).powi(4);
        assert!(error <= tol::WINKLER + order, "K = {stiffness:e}: {error:.1e}");
    }
}

#[test]
fn a_gap_out_of_reach_changes_nothing() {
    out_of_reach(&[3, 5, 128]);
}

#[test]
fn a_gap_out_of_reach_changes_nothing_on_one_element() {
    out_of_reach(&[1]);
}

#[test]
fn a_gap_out_of_reach_changes_nothing_on_fine_meshes() {
    out_of_reach(&[200, 1000]);
}

fn out_of_reach(counts: &[usize]) {
    let (c, l, f) = (5.0, 1.0, 3.0);
    let x = points(64, l);
    let free = Scene::new(l, Beam::elastic(c)).load(plain(f));
    let far = free.foundation(Foundation { law: Linear(1e12), gap: 0.1 });
    for &n in counts {
        let (_, want) = fields(free, Mesh::uniform(n), &x);
        let (report, got) = fields(far, Mesh::uniform(n), &x);
        converged(&report);
        assert!(relative(&bending(&got), &bending(&want)) <= tol::EXACT);
        assert!(got.iter().all(|f| f.pressure == Some(0.0)));
        let (zones, sum) = solved(far, Mesh::uniform(n), |s| (s.zones(), s.resultants()));
        assert!(zones.is_empty() && sum.contact_force == 0.0, "N = {n}: {zones:?}");
    }
}

/// A scene with everything in it and contact in part, or its mirror image.
fn with_everything(mirror: bool) -> impl Model<f64> {
    let sign = if mirror { -1.0 } else { 1.0 };
    let [b0, b1]: [&'static [f64]; 2] = if mirror { [&[0.4], &[0.25, 0.5]] } else { [&[0.6], &[0.5, 0.75]] };
    let f: &'static [f64] = if mirror { &[-400.0, 300.0] } else { &[300.0, -400.0] };
    let c: &'static [f64] = if mirror { &[1.0, 4.0, 2.0] } else { &[2.0, 4.0, 1.0] };
    let (left, right) = if mirror { (0.9, 0.2) } else { (0.2, 0.9) };
    let beam =
        Beam { bending: Steps { breaks: b1, values: c }, axial: 1.0, piezo: 0.5 * sign, permittivity: 1.0 };
    Scene::new(1.0, beam)
        .foundation(Foundation { law: Power { stiffness: 50.0, exponent: 1.5 }, gap: 0.01 })
        .conduction(Conduction::new(10.0, 4.0, 0.05))
        .load(Load { transverse: Steps { breaks: b0, values: f }, axial: sign, points: () })
        .potential(Potential { left, right })
}

#[test]
fn a_mirrored_scene_has_mirrored_fields() {
    let x = points(60, 1.0);
    // Meshes that are mirror images themselves: breaks on them or halfway at most.
    for n in [20, 60, 100, 500] {
        let (report, here) = fields(with_everything(false), Mesh::uniform(n), &x);
        converged(&report);
        let (report, mut there) = fields(with_everything(true), Mesh::uniform(n), &x);
        converged(&report);
        there.reverse();
        type Get = fn(&Fields<f64>) -> f64;
        let columns: [(Get, f64); 8] = [
            (|f| f.bending, 1.0),
            (|f| f.slope, -1.0),
            (|f| f.moment, 1.0),
            (|f| f.shear, -1.0),
            (|f| f.stretching.expect("u"), -1.0),
            (|f| f.potential.expect("q"), 1.0),
            (|f| f.axial_force.expect("sigma"), 1.0),
            (|f| f.electric_displacement.expect("D"), -1.0),
        ];
        for (i, (get, sign)) in columns.into_iter().enumerate() {
            let want: Vec<f64> = here.iter().map(get).collect();
            let got: Vec<f64> = there.iter().map(|f| sign * get(f)).collect();
            assert!(
                relative(&got, &want) <= tol::MIRROR,
                "column {i}, N = {n}: {:.1e}",
                relative(&got, &want)
            );
        }
    }
}

#[test]
fn without_contact_solutions_add_up() {
    let x = points(50, 1.0);
    let beam = Beam {
        bending: Polynomial(&[3.0, 1.0]),
        axial: 2.0,
        piezo: 0.7,
        permittivity: Polynomial(&[1.0, 0.5]),
    };
    let scene = |a: f64, b: f64| {
        Scene::new(1.0, beam)
            .load(Load {
                transverse: Table { x: &[0.0, 0.3, 1.0], y: &[1.0, -2.0, 3.0] },
                axial: a,
                points: [PointLoad { x: 0.55, force: 5.0 * a, moment: -b }],
            })
            .potential(Potential { left: b, right: -a })
    };
    let (_, one) = fields(scene(1.0, 2.0), Mesh::uniform(40), &x);
    let (_, two) = fields(scene(-0.5, 4.0), Mesh::uniform(40), &x);
    let (_, mean) = fields(scene(0.25, 3.0), Mesh::uniform(40), &x);
    let column = |f: &[Fields<f64>], get: fn(&Fields<f64>) -> f64| f.iter().map(get).collect::<Vec<f64>>();
    for get in [
        (|f| f.bending) as fn(&Fields<f64>) -> f64,
        |f| f.moment,
        |f| f.stretching.expect("u"),
        |f| f.potential.expect("q"),
    ] {
        let half: Vec<f64> =
            column(&one, get).iter().zip(column(&two, get)).map(|(a, b)| 0.5 * (a + b)).collect();
        assert!(relative(&column(&mean, get), &half) <= tol::SUPERPOSITION);
    }
}

/// A scene with everything in it, in units 2^m of length, 2^n of force and 2^v of voltage.
fn in_units(m: i32, n: i32, v: i32, exponent: i32, nodes: usize) -> (Report<f64>, Vec<[f64; 8]>) {
    let of = |x: f64, e: i32| x * 2.0_f64.powi(e);
    let beam = Beam {
        bending: of(1.5, n + 2 * m),
        axial: of(1.0, n),
        piezo: of(0.5, n + m - v),
        permittivity: of(1.0, n + 2 * m - 2 * v),
    };
    let mut conduction = Conduction::new(of(10.0, n - v - 2 * m), of(4.0, n - v - 2 * m), of(0.05, m));
    conduction.potential_truncation = of(0.75, v);
    let (breaks, values) = ([of(0.6, m)], [of(300.0, n - m), of(-400.0, n - m)]);
    let law = Power { stiffness: of(50.0, n - m * (1 + exponent)), exponent: f64::from(exponent) };
    let scene = Scene::new(of(1.0, m), beam)
        .foundation(Foundation { law, gap: of(0.01, m) })
        .conduction(conduction)
        .load(Load {
            transverse: Steps { breaks: &breaks, values: &values },
            axial: of(1.0, n - m),
            points: [PointLoad { x: of(0.3, m), force: of(7.0, n), moment: of(-2.0, n + m) }],
        })
        .potential(Potential { left: of(0.2, v), right: of(0.9, v) });
    let (report, at) = fields(scene, Mesh::uniform(nodes), &points(32, of(1.0, m)));
    let plain = |f: &Fields<f64>| {
        [
            of(f.bending, -m),
            f.slope,
            of(f.moment, -n - m),
            of(f.shear, -n),
            of(f.stretching.expect("u"), -m),
            of(f.potential.expect("q"), -v),
            of(f.axial_force.expect("sigma"), -n),
            of(f.pressure.expect("p"), m - n),
        ]
    };
    (report, at.iter().map(plain).collect())
}

#[test]
fn units_that_are_powers_of_two_change_no_bit() {
    for exponent in [1, 2] {
        for nodes in [5, 64, 200] {
            let (report, want) = in_units(0, 0, 0, exponent, nodes);
            converged(&report);
            for (m, n, v) in
                [(1, 0, 0), (0, 1, 0), (0, 0, 1), (-10, 3, 7), (20, -30, 5), (-60, 40, -25), (60, 90, 60)]
            {
                let (scaled, got) = in_units(m, n, v, exponent, nodes);
                assert_eq!(got, want, "2^{m} m, 2^{n} N, 2^{v} V, exponent {exponent}, N = {nodes}");
                assert_eq!(scaled, report);
            }
        }
    }
}

#[test]
fn a_stiffness_that_varies_is_as_good_on_few_elements_as_on_many() {
    let beam = Beam::elastic(Polynomial(&[1.0, 3.0, -2.0, 5.0]));
    let scene = Scene::new(1.0, beam)
        .foundation(Foundation { law: Linear(Polynomial(&[2e3, -1e3])), gap: () })
        .load(plain(Polynomial(&[50.0, -30.0])));
    let x = points(32, 1.0);
    let (report, coarse) = fields(scene, Mesh::uniform(64), &x);
    converged(&report);
    let (report, fine) = fields(scene, Mesh::uniform(2048), &x);
    converged(&report);
    let error = relative(&bending(&coarse), &bending(&fine));
    assert!(error <= tol::VARIABLE, "{error:.1e}");
}

#[test]
fn a_step_in_the_stiffness_by_ten_powers_of_ten_is_exact() {
    // Rigid right half: the left half is a clamped beam of half the length under its share of the load.
    let (f, soft, rigid) = (3.0, 1.0, 1e10);
    let values = [soft, rigid];
    let beam = Beam::elastic(Steps { breaks: &[0.5], values: &values });
    let x = points(32, 0.5);
    for n in [3, 4, 10, 1000] {
        let (report, at) = fields(Scene::new(1.0, beam).load(plain(f)), Mesh::uniform(n), &x);
        converged(&report);
        let exact = free_beam(f, soft, 0.5);
        let want: Vec<f64> = x.iter().map(|&x| exact(x)).collect();
        let error = relative(&bending(&at), &want);
        assert!(error <= tol::STEPPED.max(1e3 * soft / rigid), "N = {n}: {error:.1e}");
    }
}

#[test]
fn single_precision_keeps_its_digits_up_to_five_thousand_elements() {
    single_precision(&[3, 10, 100, 1000, 5000]);
}

#[test]
fn single_precision_keeps_its_digits_up_to_ten_thousand_elements() {
    single_precision(&[10_000]);
}

fn single_precision(counts: &[u16]) {
    let (f, c) = (3.0_f32, 5.0_f32);
    for &n in counts {
        let scene = Scene::new(1.0_f32, Beam::elastic(c)).load(plain(f));
        let worst = solved(scene, Mesh::uniform(n.into()), |s| {
            converged(s.report());
            let exact = |x: f32| f * x * x * (1.0 - x) * (1.0 - x) / (24.0 * c);
            s.nodes().map(|x| (s.at(x).bending - exact(x)).abs()).fold(0.0, f32::max) / exact(0.5)
        });
        let bound = tol::SINGLE_UNITS * f32::EPSILON;
        assert!(worst <= bound, "N = {n}: {worst:.1e}, allowed {bound:.1e}");
    }
}

/// (2.15) with the constants of Poincaré's inequality for a clamped beam, 4.73^2 / L^2, and for H^1_0, pi / L.
#[test]
fn the_margins_of_uniqueness_are_those_of_their_formula() {
    let (length, c, eps): (f64, f64, f64) = (2.0, 3.0, 5.0);
    let (mu1, mu2, most, most_q) = (0.7, 0.2, 0.3, 0.4);
    let margins = |mu1: f64, mu2: f64| {
        let conduction = Conduction { mu1, mu2, truncation: most, potential_truncation: most_q };
        let scene = Scene::new(length, Beam { bending: c, axial: (), piezo: (), permittivity: eps })
            .conduction(conduction)
            .potential(Potential { left: 1.0, right: 1.0 });
        let found = solved(scene, Mesh::uniform(4), |solution| solution.uniqueness());
        (found.certified, found.margin_bending, found.margin_electric)
    };
    let bent = c * (4.730_040_744_862_704 / length).powi(4) / (mu1 * (most_q + 0.5 * most) + mu2 * most);
    let charged = eps * (std::f64::consts::PI / length).powi(2) / (mu1 * 0.5 * most + mu2 * most);
    let near = |got: Option<f64>, want: f64| got.is_some_and(|got| (got - want).abs() <= 1e-14 * want);
    let (certified, bending, electric) = margins(mu1, mu2);
    assert!(certified && near(bending, bent) && near(electric, charged), "{bending:?} {electric:?}");
    // The potential's condition fails first, between these factors.
    assert!(margins(0.99 * charged * mu1, 0.99 * charged * mu2).0);
    assert!(!margins(1.01 * charged * mu1, 1.01 * charged * mu2).0);
    assert_eq!(margins(0.0, 0.0), (true, None, None));
}
