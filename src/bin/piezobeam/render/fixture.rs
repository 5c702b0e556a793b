//! Solutions made up for the tests of the renderers: smooth, of the right size and shape, not computed.

use std::f64::consts::PI;

use crate::report::{
    CONVERGED, Contact, Method, Output, Parameter, Picture, Reaction, Report, Resultants, Samples,
    Sensitivities, Uniqueness,
};

const POINTS: usize = 129;

/// sin²(pi (x - a) / (b - a)) between a and b, zero outside.
fn hump(x: f64, a: f64, b: f64) -> f64 {
    if (a..=b).contains(&x) { (PI * (x - a) / (b - a)).sin().powi(2) } else { 0.0 }
}

fn base(title: &str, length: f64, bending: impl Fn(f64) -> f64) -> Picture {
    let sample = |f: &dyn Fn(f64) -> f64| -> Vec<f64> {
        (0..POINTS).map(|i| f(length * i as f64 / (POINTS - 1) as f64)).collect()
    };
    let h = 1e-3 * length;
    let slope = |x: f64| (bending(x + h) - bending(x - h)) / (2.0 * h);
    Picture {
        report: Report {
            status: CONVERGED.into(),
            reason: None,
            iterations: 7,
            element_visits: 812,
            elements: 100,
            residual: 3.2e-13,
            error_bound: Some(2.9e-4),
            error_estimate: Some(1.2e-8),
            electric_error_bound: None,
            stretching_error_estimate: None,
            potential_error_estimate: None,
            adaptive: None,
            warnings: vec![],
            samples: Samples {
                x: sample(&|x| x),
                bending: Some(sample(&bending)),
                slope: Some(sample(&slope)),
                ..Samples::default()
            },
            contact: None,
            uniqueness: Uniqueness { certified: true, ..Uniqueness::default() },
            resultants: Resultants::default(),
            precision: "f64".into(),
            method: Method { name: "newton", ..Method::default() },
            sensitivities: None,
        },
        title: title.into(),
        length,
        gap: None,
        facts: vec![("length".into(), super::quantity(length, "m", 6))],
    }
}

impl Picture {
    fn set(&mut self, pick: impl Fn(&mut Samples) -> &mut Option<Vec<f64>>, f: impl Fn(f64) -> f64) {
        let values = self.report.samples.x.iter().map(|&x| f(x)).collect();
        *pick(&mut self.report.samples) = Some(values);
    }
}

/// Pressed on the left, lifted on the right, with the large stretching and potential of the paper's data.
pub fn partial() -> Picture {
    let mut p = base("half pushed, half pulled", 1.0, |x| {
        if x < 0.3185 { 0.0099 * hump(x, 0.0, 0.3185) } else { -0.0637 * hump(x, 0.3185, 1.0) }
    });
    p.set(|s| &mut s.moment, |x| -17.8e3 * (2.0 * PI * x).cos() - 19.1e3 * x * x);
    p.set(|s| &mut s.shear, |x| 168.9e3 * (2.0 * PI * x).sin() - 330.0e3 * x.powi(3));
    p.set(|s| &mut s.stretching, |x| 4.545 * x * (1.0 - x));
    p.set(|s| &mut s.potential, |x| 1.0 - 454.4 * x * (1.0 - x));
    p.set(|s| &mut s.axial_force, |x| 5e5 - 1e6 * x);
    p.set(|s| &mut s.electric_displacement, |_| 0.0);
    p.gap = Some(vec![0.0; POINTS]);
    p.report.contact = Some(Contact { zones: vec![[0.0, 0.3185]], force: 187_038.541_4 });
    p.report.uniqueness.margin_bending = Some(2.5e6);
    p.report.uniqueness.margin_electric = Some(8.37);
    p.report.resultants = Resultants {
        left: Reaction { force: -168.9e3, moment: -17.8e3 },
        right: Reaction { force: 355.9e3, moment: -36.9e3 },
        bending_energy: 2210.4,
        equilibrium_error: 4e-15,
    };
    p.facts.push(("bending stiffness".into(), "5000 N m²".into()));
    p.facts.push(("foundation stiffness".into(), "100 MN/m²".into()));
    p
}

/// A microbridge, half a millimetre long, pulled through a gap of micrometres; its stretching is far below an atom.
pub fn mems() -> Picture {
    let l = 5e-4;
    let mut p = base("microbridge <Si & \"ZnO\">", l, |x| 4.8e-6 * hump(x, 0.0, 5e-4));
    p.set(|s| &mut s.moment, |x| -2.5e-9 * (2.0 * PI * x / l).cos());
    p.set(|s| &mut s.shear, |x| 3.58e-5 * (2.0 * PI * x / l).sin());
    p.set(|s| &mut s.stretching, |x| 4.2e-19 * hump(x, 0.0, l));
    p.set(|s| &mut s.potential, |x| 5.0 - 5.0 * x / l);
    let gap = |x: f64| 4e-6 * (4.0 * (x / l) * (1.0 - x / l)).powi(2);
    p.gap = Some(p.report.samples.x.iter().map(|&x| gap(x)).collect());
    p.report.contact = Some(Contact { zones: vec![[1.1635e-4, 3.8365e-4]], force: 1.1518e-4 });
    p
}

/// Bending alone, no foundation.
pub fn free() -> Picture {
    let mut p = base("free span", 2.0, |x| 0.521 * hump(x, 0.0, 2.0));
    p.set(|s| &mut s.moment, |x| -4.17e4 * (PI * x).cos());
    p.set(|s| &mut s.shear, |x| 5e5 * (1.0 - x));
    p
}

/// No load: every field is zero.
pub fn zero() -> Picture {
    let mut p = base("at rest", 1.0, |_| 0.0);
    p.set(|s| &mut s.moment, |_| 0.0);
    p.set(|s| &mut s.shear, |_| 0.0);
    p.set(|s| &mut s.stretching, |_| 0.0);
    p.set(|s| &mut s.potential, |_| 0.0);
    p.gap = Some(vec![0.0; POINTS]);
    p.report.contact = Some(Contact::default());
    p
}

/// A few derivatives of [`partial`].
pub fn sensitivities() -> Sensitivities {
    let parameter = |name: &str, x, unit| Parameter { name: name.into(), x, unit };
    Sensitivities {
        meaning: "what a number means",
        error: None,
        warning: Some("the beam only touches".into()),
        parameters: vec![
            parameter("beam.bending", None, None),
            parameter("load.points.force", Some(0.3), Some("N")),
        ],
        outputs: vec![
            Output { name: "bending", x: Some(0.5), unit: "m", derivatives: vec![0.0624, -1.25e-6] },
            Output { name: "contact force", x: None, unit: "N", derivatives: vec![-1234.5, 0.5] },
        ],
    }
}

/// A made-up measurement.
pub fn timing() -> crate::report::Timing {
    crate::report::Timing {
        status: "converged".into(),
        elements: 100,
        iterations: 8,
        element_visits: 406,
        precision: "f64".into(),
        repeat: 3,
        best_ns: 81.2e3,
        median_ns: 90e3,
        worst_ns: 100e3,
        bytes_per_element: 400,
    }
}
