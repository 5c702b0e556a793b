//! Extremes of bending and contact, of meshes and of input.

use super::known::{free, halves_free, halves_rigid, pressed, suite, supported};
use super::scenes::{C, F, elastic, elastic_halves, electric, halves, polynomial, steps, turned};
use super::{Case, Expected, Group, Reference};
use crate::scene_file::{ProfileSpec, SceneFile};

pub(super) fn groups() -> Vec<Group> {
    vec![
        foundation(),
        bending(),
        sizes(),
        loads(),
        numbers(),
        exponents(),
        tangent(),
        preload(),
        patches(),
        tips(),
        jumps(),
        neighbours(),
        few(),
        refusals(),
    ]
}

/// The same scene in other units: `bending` is what its bending is multiplied with.
fn scaled(what: &'static str, scene: SceneFile, bending: f64) -> Reference {
    Reference::Other { what, scene: Box::new(scene), bending }
}

/// Sixteen digits of the paper's beam under turned load, where there are some.
fn turned_reference(k: f64) -> Reference {
    match k {
        1.0 => suite!("sweep-1e00"),
        1e4 => suite!("sweep-1e04"),
        1e8 => suite!("sweep-1e08"),
        1e12 => suite!("sweep-1e12"),
        1e16 => suite!("sweep-1e16"),
        _ => halves_rigid(C, F),
    }
}

/// Visits allowed where no mesh here resolves the foundation: tried as it is, then taken as rigid.
fn beyond(k: f64) -> (usize, usize) {
    if k > 1e16 { (150, 20_000) } else { (20, 6000) }
}

fn foundation() -> Group {
    let soft = |k: f64| {
        let case = Case::new(format!("k = {k:.0e}, turned load"), halves(k)).against(turned_reference(k));
        case.within(1e-5).single(2e-3)
    };
    let rigid = |k: f64| {
        let case = Case::new(format!("k = {k:.0e}, turned load"), halves(k)).against(turned_reference(k));
        let (per_element, beside) = beyond(k);
        let case = case.falling(4e-3, 3).visits(per_element, beside);
        if k <= 1e30 { case.single(1e-2) } else { case }
    };
    let elastic_rigid = |k: f64| {
        let case = Case::new(format!("k = {k:.0e}, turned load, bending alone"), elastic_halves(k));
        let (per_element, beside) = beyond(k);
        case.against(turned_reference(k)).falling(4e-3, 3).visits(per_element, beside)
    };
    let flat = |k: f64, at_100: f64| {
        let scene = elastic(C).on(k).under(F);
        let case = Case::new(format!("k = {k:.0e}, pressed down everywhere"), scene);
        let (per_element, beside) = beyond(k);
        let case = case.against(pressed(C, k, F)).falling(at_100, 2).visits(per_element, beside);
        if k > 1e16 { case.or_at_the_floor() } else { case }
    };
    let none = Case::new("k = 0, turned load, bending alone", elastic_halves(0.0)).against(halves_free(C, F));
    let mut cases = vec![none.flat(1e-11).single(1e-4)];
    cases.extend([1.0, 1e4, 1e8].map(soft));
    cases.extend([1e12, 1e16, 1e20, 1e30, 1e100, 1e300].map(rigid));
    cases.extend([1e12, 1e16, 1e20, 1e30, 1e100, 1e300].map(elastic_rigid));
    cases.extend([(1e12, 0.01), (1e16, 1.0), (1e30, 1.0), (1e300, 1.0)].map(|(k, at_100)| flat(k, at_100)));
    Group {
        name: "stiffness of the foundation",
        comment: "From no foundation to one that nothing can press in. From 1e20 on the bending is compared with \
                  the closed form of the rigid limit, from which that of a stiffness k is off by some (C/k)^(3/4), \
                  1e-11 of it at 1e20. The layer at the contact's edge is (C/k)^(1/4) wide: from 1e16 on no mesh here \
                  resolves it, and what is left is the mesh's own error. Pressed down everywhere, all of the \
                  bending is f/k and the layers at the clamps are most of its error. Where \
                  the edge of the contact is not found for so stiff a foundation in a bounded share of the work, it \
                  is taken as one that is just rigid to the elements, with a warning that says so.",
        cases,
    }
}

fn bending() -> Group {
    let alike = |s: f64| {
        let scene = elastic(C * s).on(1e8 * s).under(turned(F * s));
        let case = Case::new(format!("C = {:.0e}, k and loads alike", C * s), scene);
        let case = case.against(scaled("exact scaling", elastic_halves(1e8), 1.0)).within(1e-5);
        if s.abs().log10().abs() <= 24.0 { case.single(2e-3) } else { case }
    };
    // Over a foundation this stiff or soft beside the beam the limits are exact to rounding.
    let alone = |c: f64| {
        let scene = elastic(c).on(1e8).under(turned(F));
        let case = Case::new(format!("C = {c:.0e}, k = 1e8, f = 1e6"), scene).visits(150, 20_000);
        if c > 1.0 {
            case.against(halves_free(c, F)).flat(1e-6)
        } else {
            case.against(halves_rigid(c, F)).falling(4e-3, 3)
        }
    };
    let mut cases: Vec<_> = [1e-34, 1e-20, 1e20, 1e26].map(alike).into();
    cases.extend([1e-30, 1e-15, 1e15, 1e30].map(alone));
    Group {
        name: "stiffness of the beam",
        comment: "With stiffness of the foundation and loads scaled alike nothing may change but units. Alone, a \
                  beam of 1e-30 N m^2 hangs over the foundation's edge by 1e35 m, which is the rigid limit again; \
                  one of 1e30 does not feel the foundation.",
        cases,
    }
}

fn sizes() -> Group {
    let bowl = |depth: f64, length: f64| {
        let c = 16.0 * depth / length / length;
        polynomial(&[0.0, 0.0, c, -2.0 * c / length, c / length / length])
    };
    let micro = electric()
        .but(|s| {
            s.length = 1e-4;
            s.beam.bending = 1.3e-13.into();
            s.beam.axial = Some(1.6.into());
            s.beam.piezo = Some(1e-9.into());
            s.beam.permittivity = Some(1e-18.into());
            s.load.axial = None;
        })
        .on(1e7)
        .gap(bowl(1e-11, 1e-4))
        .conducting(1e-3, 1e-6, 1e-9)
        .under(1e-5)
        .between(5.0, 0.0);
    let mems = electric()
        .but(|s| {
            s.length = 5e-4;
            s.beam.bending = 5.6e-12.into();
            s.beam.axial = Some(16.9.into());
            s.beam.piezo = Some(1e-9.into());
            s.beam.permittivity = Some(1e-18.into());
            s.load.axial = None;
        })
        .on(1e6)
        .gap(polynomial(&[0.0, 0.0, 256.0, -1_024_000.0, 1_024_000_000.0]))
        .conducting(1e-3, 1e-6, 1e-6)
        .under(steps(&[2e-4, 3e-4], &[0.0, 1.5, 0.0]))
        .between(5.0, 0.0);
    let pipe = |length: f64, gap: f64| {
        SceneFile::beam(length, 1.7e8.into()).on(1e6).gap(bowl(gap, length)).under(2e3)
    };
    Group {
        name: "sizes",
        comment: "Scenes of real sizes, in one unit system, without any scaling by the caller.",
        cases: vec![
            Case::new("100 um, 1 nN, a gap of 10 pm", micro).within(1e-4).single(1e-2),
            Case::new("500 um, 150 uN, a gap of 4 um", mems)
                .against(suite!("mems"))
                .within(1e-4)
                .single(1e-2),
            Case::new("a pipe of 100 m over a trench of 0.5 m", pipe(100.0, 0.5)).within(1e-5).single(2e-3),
            Case::new("a pipe of 10 km over a hollow of 5 m", pipe(1e4, 5.0))
                .falling(0.1, 3)
                .visits(20, 6000),
        ],
    }
}

fn loads() -> Group {
    let scene = |f: f64| elastic(C).on(1e8).under(turned(f));
    let exact = |f: f64| Case::new(format!("f = {f:.0e}"), scene(f)).within(1e-5);
    let case = |f: f64| exact(f).against(scaled("exact scaling", elastic_halves(1e8), f / F));
    let single = |f: f64| case(f).single(2e-3);
    let gap = |f: f64| {
        let at = |f: f64| scene(f).gap(polynomial(&[0.0, 0.0, 1e-6 * f, -1e-6 * f]));
        let case = Case::new(format!("f = {f:.0e}, with a gap of 1e-7 f"), at(f)).within(1e-5);
        case.against(scaled("exact scaling", at(F), f / F))
    };
    let tiny = elastic(C * 1e-8).on(1.0).under(turned(1e-300));
    let tiny = Case::new("f = 1e-300, C = 5e-5, k = 1", tiny).within(1e-5);
    let mut cases: Vec<_> = [1e-150, 1e150, 1e300].map(case).into();
    cases.push(tiny.against(scaled("exact scaling", elastic_halves(1e8), 1e-298)));
    cases.push(case(1e-300).on(&[100]));
    cases.extend([1e-25, 1.0, 1e25].map(single));
    cases.extend([1e-290, 1e290].map(gap));
    Group {
        name: "size of the load",
        comment: "Without a gap the bending is homogeneous of degree one in the load, however small or large; with \
                  one it is so in load and gap together. A load of 1e-300 on the paper's beam leaves a penetration of \
                  1e-308, where numbers have no full digits any more: on finer meshes than this the residual shows \
                  that.",
        cases,
    }
}

fn numbers() -> Group {
    let all = |s: f64| {
        let scene = halves(1e8 * s)
            .but(|e| {
                e.beam.bending = (C * s).into();
                e.beam.axial = Some((1e5 * s).into());
                e.beam.piezo = Some((100.0 * s).into());
                e.beam.permittivity = Some(s.into());
                e.load.axial = Some((1e6 * s).into());
            })
            .conducting(s, s, 1.0)
            .under(turned(F * s));
        let case = Case::new(format!("all data but length and potentials times {s:.0e}"), scene);
        case.against(suite!("sweep-1e08")).within(1e-5)
    };
    let long = |length: f64| {
        let c = C * length.powi(4);
        let half = 0.5 * length;
        let scene = SceneFile::beam(length, c.into()).on(1e8).under(steps(&[half], &[F, -F]));
        let case = Case::new(format!("L = {length:.0e}, C = 5000 L^4"), scene).within(1e-5);
        case.against(scaled("exact scaling", elastic_halves(1e8), 1.0))
    };
    let everything = |s: f64| {
        let scene = SceneFile::beam(s, s.into()).on(s).under(s);
        Case::new(format!("L, C, k and f all {s:.0e}"), scene)
    };
    let mut cases: Vec<_> = [1e-105, 1e-80, 1e80, 1e105].map(all).into();
    cases.extend([1e-12, 1e12].map(all).map(|case| case.single(2e-3)));
    cases.extend([1e-60, 1e-20, 1e20, 1e60].map(long));
    cases.push(everything(1e-105).refused("length"));
    cases.push(everything(1e105).fails().visits(400, 100_000));
    Group {
        name: "size of the numbers",
        comment: "All data times the same number change no field. Where the fields themselves leave the number \
                  format (f L^4 / C is 1e420 where all are 1e105) nothing can be computed, and the solve has to \
                  say so; elements whose cube is below it are refused.",
        cases,
    }
}

fn exponents() -> Group {
    let power = |a: f64| elastic_halves(1e8).exponent(a);
    let full = |a: f64| halves(1e8).exponent(a);
    Group {
        name: "exponent of the law",
        comment: "p = k r^a. A penetration of centimetres to the power 1000 is zero in any format, and the beam is \
                  free; one of metres is beyond it, which is the law's fault and said so.",
        cases: vec![
            Case::new("a = 1 + 1e-12 against a = 1", full(1.0 + 1e-12))
                .against(suite!("sweep-1e08"))
                .within(1e-5),
            Case::new("a = 1.5", full(1.5)).against(suite!("hertz")).within(1e-4).single(2e-3),
            Case::new("a = 3", power(3.0)).within(1e-5).single(2e-3),
            Case::new("a = 10", power(10.0)).within(1e-5),
            Case::new("a = 100", power(100.0)).within(1e-4),
            Case::new("a = 1000", power(1000.0)).against(halves_free(C, F)).flat(1e-11),
            Case::new("a = 1000, a preload of 10 m", power(1000.0).gap(-10.0)).ends("law_not_finite"),
        ],
    }
}

fn tangent() -> Group {
    let most = F / (384.0 * C);
    let touching = |k: f64, curve: f64, shift: f64| {
        let w = F / (24.0 * C);
        let gap = [0.25 * curve + shift * most, -curve, w + curve, -2.0 * w, w];
        elastic(C).on(k).gap(polynomial(&gap)).under(F)
    };
    let case = |(k, curve, shift): (f64, f64, f64)| {
        let what = format!("k = {k:.0e}, gap {curve:.0e} (x - 1/2)^2 beside it, {shift:.0e} apart");
        Case::new(what, touching(k, curve, shift)).against(free(C, F, 1.0)).flat(1e-10)
    };
    let apart = |k: f64, curve: f64| [-1e-12, 0.0, 1e-12].map(|shift| case((k, curve, shift)));
    let soft = apart(1e8, 1.0).into_iter().chain(apart(1e8, 0.0)).map(|case| case.single(1e-3));
    Group {
        name: "a gap tangent to the free beam",
        comment: "The free beam touches the gap in one point, or misses it, or enters it, by 1e-12 of the largest \
                  bending; where the gap is 0 (x - 1/2)^2 beside it, along the whole of it. Whether there is contact is then a matter \
                  of rounding; the bending must not be.",
        cases: soft.chain(apart(1e20, 1.0)).collect(),
    }
}

fn preload() -> Group {
    let scene = |k: f64, gap: f64, f: f64| elastic(C).on(k).gap(gap).under(f);
    let case = |(k, gap, f, at_100): (f64, f64, f64, f64)| {
        let what = format!("k = {k:.0e}, s = {gap:.0e}, f = {f:.0e}");
        Case::new(what, scene(k, gap, f)).falling(at_100, 3).visits(40, 10_000)
    };
    let moderate = [(1e4, -1.0, F, 1e-5), (1e8, -1e-3, F, 1e-5), (1e8, -1.0, F, 1e-4), (1e8, -1e6, F, 1e-4)];
    let rigid = [(1e12, -1e-3, F, 1e-1), (1e16, -1e-3, F, 3.0), (1e12, -1.0, 0.0, 1e-1)];
    let bent = elastic(C).on(1e8).gap(polynomial(&[-0.1, 0.05, 0.3])).under(turned(F));
    let electric = halves(1e8).gap(-0.01);
    let mut cases: Vec<_> = moderate.map(case).map(|case| case.single(2e-2)).into();
    cases.extend(rigid.map(case));
    cases.push(case((1e20, -1e-3, F, 0.0)).flat(10.0));
    cases.push(Case::new("k = 1e8, s = -0.1 + 0.05 x + 0.3 x^2, turned load", bent).within(1e-4));
    cases.push(
        Case::new("k = 1e8, s = -0.01, all parts, turned load", electric).within(1e-4).visits(16, 3000),
    );
    Group {
        name: "preload",
        comment: "A foundation that stands above the beam at rest. At the clamps the penetration is the preload \
                  itself whatever the stiffness, so that the layers there carry all of the load; meshes that do not \
                  resolve them (1e16 on 100 elements) have no digit right, and are only asked to converge.",
        cases,
    }
}

fn patches() -> Group {
    let two = halves(1e9).under(steps(&[0.35, 0.65], &[1e6, -1.2e6, 1.5e6]));
    let load = steps(&[0.25, 0.4, 0.6, 0.75], &[4e6, -2e6, 3e6, -2e6, 4e6]);
    let three = |k: f64| elastic(C).on(k).under(load.clone());
    Group {
        name: "several contact zones",
        comment: "Zones that appear and join on the way to the solution; their number is checked too.",
        cases: vec![
            Case::new("two, k = 1e9", two).against(suite!("patches")).within(1e-4).zones(2).single(2e-3),
            Case::new("three, k = 1e10", three(1e10)).within(1e-4).zones(3).single(2e-3),
            Case::new("three that have joined, k = 1e8", three(1e8)).within(1e-4).zones(1).single(2e-3),
            Case::new("three, k = 1e13", three(1e13)).within(1e-2).zones(3).visits(20, 6000),
        ],
    }
}

fn tips() -> Group {
    // A tent on the middle of the foundation, so wide at its foot.
    let tip = |width: f64, k: f64| {
        let (a, b) = (0.5 - 0.5 * width, 0.5 + 0.5 * width);
        let tent =
            ProfileSpec::Table { x: vec![0.0, a, 0.5, b, 1.0], y: vec![0.05, 0.05, 0.005, 0.05, 0.05] };
        elastic(C).on(k).gap(tent).under(2e4)
    };
    let case = |(width, k): (f64, f64)| {
        Case::new(format!("a tip {width:.0e} wide, k = {k:.0e}"), tip(width, k)).zones(1).visits(20, 6000)
    };
    let held = || supported(C, 2e4, 0.005);
    let mut cases: Vec<_> = [(1e-1, 1e8), (1e-2, 1e8), (1e-2, 1e12)].map(case).into();
    cases.push(case((1e-6, 1e20)).against(held()).flat(1e-3));
    let needle = |width| case((width, 1e30)).against(held()).flat(1e-6).visits(150, 20_000).or_at_the_floor();
    cases.extend([1e-6, 1e-9].map(needle));
    Group {
        name: "contact at a point",
        comment: "A tip of the foundation that props the beam at its middle. The narrower and stiffer it is the more \
                  it is a point support, whose closed form it is compared with; the contact is 1e-16 m wide in the \
                  end, less than neighbouring numbers x differ by, and rounding may not let the residual become as small \
                  as asked for.",
        cases,
    }
}

fn jumps() -> Group {
    let step = |at: f64, value: f64, factor: f64| steps(&[at], &[value, value * factor]);
    let case = |what: &str, at: f64, scene: SceneFile| {
        Case::new(format!("{what} at x = {at}"), scene).within(1e-4).visits(20, 6000).single(1e-2)
    };
    let base = || halves(1e8);
    let cases = [0.5, 0.312_345_6].into_iter().flat_map(|at| {
        let conduction = |s: &mut SceneFile, mu1: ProfileSpec, mu2: ProfileSpec| {
            if let Some(table) = &mut s.conduction {
                (table.mu1, table.mu2) = (Some(mu1), Some(mu2));
            }
        };
        [
            case("C times 1e6", at, base().but(|s| s.beam.bending = step(at, C, 1e6))),
            case("C times 1e-3", at, base().but(|s| s.beam.bending = step(at, C, 1e-3))),
            case("EA times 1e6", at, base().but(|s| s.beam.axial = Some(step(at, 1e5, 1e6)))),
            case("P times -1e3", at, base().but(|s| s.beam.piezo = Some(step(at, 100.0, -1e3)))),
            case("eps times 1e6", at, base().but(|s| s.beam.permittivity = Some(step(at, 1.0, 1e6)))),
            case("k times 1e6", at, base().on(step(at, 1e8, 1e6))),
            case("k from 1e8 to 0", at, base().on(step(at, 1e8, 0.0))),
            case(
                "mu1 and mu2 times 1e3",
                at,
                base().but(|s| conduction(s, step(at, 1.0, 1e3), step(at, 1.0, 1e3))),
            ),
            case("f times -1e3", at, base().under(step(at, F, -1e3))),
            case("axial load times -1e3", at, base().but(|s| s.load.axial = Some(step(at, 1e6, -1e3)))),
            case(
                "all of them, by 1e3,",
                at,
                base()
                    .but(|s| {
                        s.beam.bending = step(at, C, 1e3);
                        s.beam.axial = Some(step(at, 1e5, 1e3));
                        s.beam.piezo = Some(step(at, 100.0, 1e3));
                        s.beam.permittivity = Some(step(at, 1.0, 1e3));
                        s.load.axial = Some(step(at, 1e6, -1e3));
                        conduction(s, step(at, 1.0, 1e3), step(at, 1.0, 1e3));
                    })
                    .on(step(at, 1e8, 1e3))
                    .under(step(at, F, -1e3)),
            ),
        ]
    });
    let hinge = elastic(steps(&[0.5], &[1e-6, 1e6])).under(1.0);
    Group {
        name: "jumps of coefficients",
        comment: "Each coefficient jumps, at a node of the uniform mesh and between two; nodes are set at breaks. \
                  The meshes that are compared differ in all other nodes.",
        cases: cases
            .chain([Case::new("C times 1e12 at x = 0.5, no foundation", hinge).flat(1e-10)])
            .collect(),
    }
}

fn neighbours() -> Group {
    let among = |base: u32, at: &[(f64, f64)]| {
        let mut nodes: Vec<f64> = (0..=base).map(|i| f64::from(i) / f64::from(base)).collect();
        nodes.extend(at.iter().map(|(x, beside)| x + beside));
        nodes.sort_by(f64::total_cmp);
        nodes
    };
    let halving = || {
        let mut nodes: Vec<f64> = (0..40).map(|i| 0.5_f64.powi(i)).chain([0.0]).collect();
        nodes.reverse();
        nodes
    };
    let mesh = |scene: SceneFile, nodes: Vec<f64>| scene.nodes(nodes);
    let loose = || elastic(C).under(F);
    let case = |what: &str, scene: SceneFile, reference: Reference| {
        Case::new(what, scene).against(reference).on(&[]).flat(1e-11)
    };
    let slivers = [(0.2, 1e-14), (0.5, 5e-15), (0.5, -5e-15), (0.77, 2e-14)];
    let small = [(0.2, 1e-9), (0.5, 1e-8), (0.7, 1e-12), (0.9, -1e-6)];
    Group {
        name: "lengths of neighbouring elements",
        comment: "Nodes 1e-14 apart among elements of 0.01 and 0.5. Relative unknowns keep short elements' digits; \
                  only nodes within 16 units in the last place of L are taken for one. In single precision they are \
                  the same number, and refused.",
        cases: vec![
            case("1 to 5e11, free", mesh(loose(), among(2, &[(0.5, 1e-12)])), free(C, F, 1.0)),
            Case {
                single: Some(Expected::Refused("mesh.nodes")),
                ..case("1 to 1e12, free", mesh(loose(), among(100, &slivers)), free(C, F, 1.0))
            },
            case("1 to 1e12, k = 1e8", mesh(halves(1e8), among(100, &slivers)), suite!("sweep-1e08"))
                .flat(1e-6),
            case("1 to 1e10, k = 1e8", mesh(halves(1e8), among(100, &small)), suite!("sweep-1e08"))
                .flat(1e-6),
            case("1 to 1e12, k = 1e16", mesh(halves(1e16), among(100, &slivers)), suite!("sweep-1e16"))
                .flat(1e-3)
                .visits(20, 6000),
            case("each twice the one before, 40 of them, free", mesh(loose(), halving()), free(C, F, 1.0)),
            case(
                "each twice the one before, 40 of them, k = 1e4",
                mesh(halves(1e4), halving()),
                suite!("sweep-1e04"),
            )
            .flat(1e-2),
        ],
    }
}

fn few() -> Group {
    let on = [1, 2, 3];
    let loose =
        Case::new("free", elastic(C).under(F)).against(free(C, F, 1.0)).on(&on).flat(1e-12).single(1e-5);
    let point = elastic(C).on(1e8).gap(1.0).under(F);
    let pressed = |k: f64| Case::new(format!("k = {k:.0e}, pressed down"), elastic(C).on(k).under(F)).on(&on);
    let split = |k: f64| Case::new(format!("k = {k:.0e}, turned load"), halves(k)).on(&on[1..]);
    let (per_element, beside) = beyond(1e30);
    let (soft, stiff, rigid) = (split(1e4), split(1e8), split(1e30).visits(per_element, beside));
    Group {
        name: "one, two, three elements",
        comment: "One element clamped at both ends has no unknown at all; its fields follow from equilibrium. With \
                  contact they can only be as good as a cubic.",
        cases: vec![
            loose,
            Case::new("a gap never reached", point).against(free(C, F, 1.0)).on(&on).flat(1e-12).single(1e-5),
            pressed(1e4).flat(0.05).single(0.05),
            pressed(1e8).on(&on[1..]).flat(0.5).single(0.5),
            soft.against(suite!("sweep-1e04")).flat(0.05).single(0.05),
            stiff.against(suite!("sweep-1e08")).flat(0.5).single(0.5),
            rigid.against(halves_rigid(C, F)).flat(0.9).or_at_the_floor(),
        ],
    }
}

fn refusals() -> Group {
    let nan = f64::NAN;
    let base = || halves(1e8);
    let nodes = |nodes: &[f64]| base().nodes(nodes.to_vec());
    let cases = vec![
        Case::new("L = 0", base().but(|s| s.length = 0.0)).refused("length"),
        Case::new("C = 0", base().but(|s| s.beam.bending = 0.0.into())).refused("beam.bending"),
        Case::new("C = 1e305", base().but(|s| s.beam.bending = 1e305.into())).refused("beam.bending"),
        Case::new("C = 5e-324", base().but(|s| s.beam.bending = 5e-324.into())).refused("beam.bending"),
        Case::new("EA = -1", base().but(|s| s.beam.axial = Some((-1.0).into()))).refused("beam.axial"),
        Case::new("P not a number", base().but(|s| s.beam.piezo = Some(nan.into()))).refused("beam.piezo"),
        Case::new("no eps", base().but(|s| s.beam.permittivity = None)).refused("beam.permittivity"),
        Case::new("k = -1", base().on(-1.0)).refused("foundation.stiffness"),
        Case::new("k infinite", base().on(f64::INFINITY)).refused("foundation.stiffness"),
        Case::new("a = 0.5", base().exponent(0.5)).refused("foundation.exponent"),
        Case::new("s jumps", base().gap(steps(&[0.5], &[0.0, 1.0]))).refused("foundation.gap"),
        Case::new("mu1 = -1", base().conducting(-1.0, 1.0, 1.0)).refused("conduction.mu1"),
        Case::new("M = 0", base().conducting(1.0, 1.0, 0.0)).refused("conduction.truncation"),
        Case::new("f infinite", base().under(f64::INFINITY)).refused("load.transverse"),
        Case::new("q not a number", base().between(nan, 0.0)).refused("potential.left"),
        Case::new("no elements", base()).refused("mesh.elements").on(&[0]),
        Case::new("nodes that do not increase", nodes(&[0.0, 0.5, 0.5, 1.0])).refused("mesh.nodes").on(&[]),
    ];
    Group {
        name: "what is refused",
        comment: "Data without a meaning: each is refused by an error that names the field, what was expected and \
                  what was found.",
        cases,
    }
}
