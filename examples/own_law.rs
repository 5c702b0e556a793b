//! A compliance law of one's own: a foundation that hardens exponentially, p = a (exp(r / b) - 1).

use piezobeam::{
    Beam, Compliance, Error, Foundation, HeapWorkspace, Load, Mesh, Place, Problem, Profile, Scene, Settings,
    Status,
};

/// Penetration over b from where on the law is straight: iterates on the way to a solution may be far deeper in
/// the foundation than any solution is, and the law has to be finite there, too.
const STRAIGHT: f64 = 30.0;

/// p = a(x) (exp(r / b) - 1).
#[derive(Clone, Copy, Debug)]
struct Exponential<A> {
    /// Pressure a [N/m], any profile.
    pressure: A,
    /// Penetration b in which the stiffness grows e-fold [m].
    depth: f64,
}

impl<A: Profile<f64>> Compliance<f64> for Exponential<A> {
    type Piece = A::Piece;

    fn coefficient(&self, x: f64, mid: f64) -> f64 {
        self.pressure.value(x, mid)
    }

    fn breaks(&self) -> &[f64] {
        self.pressure.breaks()
    }

    fn pressure(&self, a: f64, _: f64, r: f64) -> (f64, f64) {
        let depths = r / self.depth;
        let slope = depths.min(STRAIGHT).exp();
        // Beyond, the tangent goes on.
        let growth = depths.min(STRAIGHT).exp_m1() + (depths - STRAIGHT).max(0.0) * slope;
        (a * growth, a / self.depth * slope)
    }

    /// Its slope has no bound.
    fn is_lipschitz(&self) -> bool {
        false
    }

    fn validate(&self, length: f64) -> Result<(), Error> {
        if !(self.depth > 0.0 && self.depth.is_finite()) {
            let (place, expected) = (Place::Whole, "a finite number > 0");
            return Err(Error::Value { field: "foundation.depth", place, expected, found: self.depth });
        }
        self.pressure.validate("foundation.pressure", length)
    }
}

fn main() -> Result<(), Error> {
    let law = Exponential { pressure: 1e5, depth: 1e-3 };
    let scene = Scene::new(1.0, Beam::elastic(50.0)).foundation(Foundation { law, gap: () }).load(Load {
        transverse: 1e6,
        axial: (),
        points: (),
    });
    let problem = Problem::new(scene, Mesh::uniform(1000))?;
    let mut memory = HeapWorkspace::new();
    let solution = problem.solve(&mut memory, &Settings::default())?;
    assert_eq!(solution.report().status, Status::Converged);

    // The clamps are felt over (4 C / p')^(1/4), 2 cm. Far from them the foundation alone bears the load:
    // a (exp(r / b) - 1) = f.
    let penetration = solution.at(0.5).bending;
    let exact = law.depth * (1e6 / law.pressure).ln_1p();
    assert!((penetration / exact - 1.0).abs() < 1e-8, "{penetration} instead of {exact}");
    println!("penetration in the middle {penetration} m, {} iterations", solution.report().iterations);
    Ok(())
}

#[test]
fn holds() -> Result<(), Error> {
    main()
}
