//! Extremes of stretching, potential and conduction.

use super::known::{stretched, suite};
use super::scenes::{C, F, elastic, electric, halves};
use super::{Case, Group, Reference};
use crate::scene_file::{ProfileSpec, SceneFile};

pub(super) fn groups() -> Vec<Group> {
    vec![coupling(), conduction(), truncation(), potentials()]
}

/// The paper's beam with these EA, P and eps, without contact, and its closed form.
fn loose(axial: f64, piezo: f64, permittivity: f64, ends: [f64; 2]) -> (SceneFile, Reference) {
    let scene = electric().under(F).between(ends[0], ends[1]);
    let scene = coefficients(scene, axial, piezo, permittivity);
    (scene, stretched(C, F, [axial, piezo, permittivity, 1e6], ends))
}

fn coefficients(scene: SceneFile, axial: f64, piezo: f64, permittivity: f64) -> SceneFile {
    scene.but(|s| {
        s.beam.axial = Some(axial.into());
        s.beam.piezo = Some(piezo.into());
        s.beam.permittivity = Some(permittivity.into());
    })
}

fn coupling() -> Group {
    let (ea, eps) = (1e5, 1.0);
    let alone = |(ea, ratio, eps): (f64, f64, f64)| {
        let piezo = (ratio * ea * eps).sqrt();
        let (scene, known) = loose(ea, piezo, eps, [1.0, 2.0]);
        let what = format!("EA = {ea:.0e}, eps = {eps:.0e}, P^2 = {ratio:.0e} EA eps, no contact");
        Case::new(what, scene).against(known).flat(1e-11)
    };
    let touching = |(ea, ratio, eps): (f64, f64, f64)| {
        let piezo = (ratio * ea * eps).sqrt();
        let scene = coefficients(halves(1e8), ea, piezo, eps);
        let what = format!("EA = {ea:.0e}, eps = {eps:.0e}, P^2 = {ratio:.0e} EA eps, contact, mu = 1");
        Case::new(what, scene).within(1e-4)
    };
    let data = [
        (ea, 1e-12, eps),
        (ea, 1e12, eps),
        (ea, 1e24, eps),
        (1e-30, 1.0, eps),
        (1e-30, 1e12, eps),
        (ea, 1.0, 1e-30),
        (ea, 1e12, 1e-30),
        (1e-30, 1.0, 1e-30),
        (1e30, 1.0, 1e30),
    ];
    let mut cases: Vec<_> = data.map(alone).into();
    cases.extend(data[..3].iter().copied().map(touching));
    cases.push(touching((1e-30, 1.0, eps)));
    cases.push(touching((ea, 1.0, 1e-30)));
    cases.push(touching((ea, 1.0, 1e30)));
    Group {
        name: "coupling of stretching and potential",
        comment: "Coupling from nothing to P^2 = 1e24 EA eps, and stiffness and permittivity of 1e-30. Without contact \
                  all fields have closed forms. With contact and eps = 1e-30 the least current through the contact \
                  raises the potential beyond its truncation.",
        cases,
    }
}

fn conduction() -> Group {
    let with = |(mu1, mu2, q): (f64, f64, f64)| {
        let scene = halves(1e8).conducting(mu1, mu2, 1.0).between(q, q);
        Case::new(format!("mu1 = {mu1:.0e}, mu2 = {mu2:.0e}, q = {q} at both ends"), scene)
            .within(1e-4)
            .visits(60, 20_000)
    };
    let pushed = |(mu1, mu2): (f64, f64)| {
        let scene = halves(1e8).conducting(mu1, mu2, 1.0).but(|s| s.load.axial = None);
        let what = format!("mu1 = {mu1:.0e}, mu2 = {mu2:.0e}, no axial load, q >= 1");
        Case::new(what, scene).within(1e-4).visits(60, 20_000)
    };
    let none = halves(1e8).conducting(0.0, 0.0, 1.0);
    let plain = Reference::Other { what: "no conduction", scene: Box::new(unconducted()), bending: 1.0 };
    Group {
        name: "conduction",
        comment: "One way, both ways, and so strong that the conduction force exceeds the foundation's. Without \
                  axial load the potential is positive and the force pushes. With it the potential is negative but \
                  at the ends, and the force pulls the beam in until the truncation; the problem is then not \
                  monotone, and uniqueness is lost: the reference is our own solution on a finer mesh, which may \
                  be another.",
        cases: vec![
            Case::new("mu1 = mu2 = 0", none).against(plain).within(1e-5),
            pushed((1e9, 0.0)),
            pushed((1e9, 1.0)),
            pushed((1e9, 1e9)),
            with((0.0, 1e9, 1.0)),
            with((1.0, 1e9, 1.0)),
            with((1e3, 1e3, -1.0)),
            with((1e9, 0.0, 1.0)),
            with((1e9, 1.0, 1.0)),
            with((1e9, 1e9, 1.0)),
            with((1e9, 0.0, -1.0)),
            with((1e9, 1e9, -1.0)),
            Case::new("mu1 = 400, mu2 = 200 on a soft beam", soft(400.0, 200.0, 420.0, [0.4, 0.6]))
                .against(suite!("beyond"))
                .within(1e-4)
                .visits(60, 20_000),
            Case::new("mu1 = 300, mu2 = 40, q = -0.8 on a soft beam", soft(300.0, 40.0, 300.0, [-0.8, -0.8]))
                .against(suite!("stubborn"))
                .within(1e-4)
                .visits(60, 20_000),
        ],
    }
}

/// A beam of unit coefficients on a soft foundation, as the reference suite has it.
fn soft(mu1: f64, mu2: f64, f: f64, ends: [f64; 2]) -> SceneFile {
    let scene = coefficients(electric(), 1.0, 0.5, 1.0).on(1.0).conducting(mu1, mu2, 1.0).under(f);
    scene.between(ends[0], ends[1]).but(|s| {
        s.beam.bending = 1.0.into();
        s.load.axial = Some(1.0.into());
    })
}

/// The turned load, and no conduction at all.
fn unconducted() -> SceneFile {
    halves(1e8).but(|s| s.conduction = None)
}

fn truncation() -> Group {
    let with = |m: f64| halves(1e8).conducting(1.0, 1.0, m);
    let other = |what, scene: SceneFile| Reference::Other { what, scene: Box::new(scene), bending: 1.0 };
    Group {
        name: "truncation",
        comment: "A truncation of 1e-300 switches conduction off, one of 1e300 is never reached.",
        cases: vec![
            Case::new("M = 1e-300", with(1e-300)).against(other("no conduction", unconducted())).within(1e-5),
            Case::new("M = 1e300", with(1e300)).against(other("M = 1000", with(1000.0))).within(1e-5),
            Case::new("M = 1e-30", with(1e-30))
                .against(other("no conduction", unconducted()))
                .within(1e-5)
                .single(2e-3),
        ],
    }
}

fn potentials() -> Group {
    let ends = |left: f64, right: f64| {
        let scene = halves(1e8).between(left, right);
        Case::new(format!("q = {left:e} and {right:e}"), scene).within(1e-4).visits(20, 6000)
    };
    let open = |left: f64, right: f64| {
        let scene = halves(1e8).between(left, right).but(|s| {
            if let Some(table) = &mut s.conduction {
                table.potential_truncation = Some(1e9);
            }
        });
        Case::new(format!("q = {left:e} and {right:e}, truncated at 1e9"), scene)
            .within(1e-4)
            .visits(20, 6000)
    };
    let crossing = coefficients(electric(), 1.0, 0.5, 1.0).on(50.0).conducting(20.0, 4.0, 1.0).under(200.0);
    let crossing = crossing.between(-2.0, 2.0).but(|s| {
        s.beam.bending = ProfileSpec::Number(1.0);
        s.load.axial = Some(1.0.into());
    });
    let alone = |q: f64| {
        let scene = elastic(C).but(|s| s.beam.permittivity = Some(1.0.into())).under(F).between(-q, q);
        Case::new(format!("q = -{q:.0e} and {q:.0e}, no contact"), scene)
    };
    Group {
        name: "end potentials",
        comment: "Of either sign and up to 1e6 V, truncated or not: the conduction force is then up to 1e6 N/m per \
                  metre of penetration, a hundredth of the foundation's. Fields within 1e8 of the largest number there is \
                  count as beyond it.",
        cases: vec![
            ends(1.0, 1.0).against(suite!("sweep-1e08")).single(2e-3),
            ends(-1.0, -1.0).single(2e-3),
            ends(-1.0, 1.0),
            ends(1e6, 1e6),
            ends(-1e6, -1e6),
            ends(-1e6, 1e6),
            open(1e6, 1e6),
            open(-1e6, -1e6),
            open(-1e6, 1e6),
            Case::new("q = -2 and 2, mu1 = 20, on a soft beam", crossing)
                .against(suite!("sign-change"))
                .within(1e-4),
            alone(1e290).flat(1e-11),
            alone(1e300).ends("numerical_breakdown"),
        ],
    }
}
