//! The scenes that are timed and whose instructions are counted.

use piezobeam::{
    Beam, Conduction, Curve, Foundation, Linear, Load, Model, Potential, Profile, Real, Scene, Smooth, Steps,
};

/// A number that is a scalar of the solver and a profile.
pub(crate) trait Number: Real + Smooth<Self> + Profile<Self> {
    /// Down on the left half, up on the right one.
    const HALVES: Steps<'static, Self>;
}

impl Number for f32 {
    const HALVES: Steps<'static, f32> = Steps { breaks: &[0.5], values: &[1e6, -1e6] };
}

impl Number for f64 {
    const HALVES: Steps<'static, f64> = Steps { breaks: &[0.5], values: &[1e6, -1e6] };
}

/// What is done with each scene.
pub(crate) trait Visit<T: Real> {
    fn visit<M: Model<T>>(&mut self, name: &str, scene: M);
}

/// One after another with more in it, under the load by halves; then the paper's, in full contact and with a gap.
pub(crate) fn each<T: Number>(visitor: &mut impl Visit<T>) {
    let [bending, axial, piezo] = [5e3, 1e5, 100.0].map(T::of);
    let (one, million) = (T::one(), T::of(1e6));
    let flat = Foundation { law: Linear(T::of(1e8)), gap: () };
    let gap = Foundation { law: Linear(T::of(1e8)), gap: Curve(wave::<T>) };
    let halves = Load { transverse: T::HALVES, axial: (), points: () };
    let both = Load { transverse: T::HALVES, axial: million, points: () };
    let plain = Scene::new(one, Beam::elastic(bending)).load(halves);
    visitor.visit("bending", plain);
    visitor.visit("contact", plain.foundation(flat));
    let beam = Beam { bending, axial, piezo: (), permittivity: () };
    visitor.visit("stretching", Scene::new(one, beam).foundation(flat).load(both));
    let paper = Scene::new(one, Beam { bending, axial, piezo, permittivity: one })
        .conduction(Conduction::new(one, one, one))
        .potential(Potential { left: one, right: one });
    visitor.visit("full", paper.foundation(flat).load(both));
    let paper = paper.load(Load { transverse: million, axial: million, points: () });
    visitor.visit("paper", paper.foundation(flat));
    visitor.visit("gap", paper.foundation(gap));
}

/// [`each`], and what only `f64` resolves: a foundation that is all but rigid.
pub(crate) fn each_and_rigid(visitor: &mut impl Visit<f64>) {
    each(visitor);
    let load = Load { transverse: f64::HALVES, axial: (), points: () };
    let foundation = Foundation { law: Linear(1e16), gap: () };
    visitor.visit("rigid", Scene::new(1.0, Beam::elastic(5e3)).foundation(foundation).load(load));
}

/// A control loop: the load on 2 % of the beam moves to and fro, and with it the contact's edge.
pub(crate) fn step(turn: usize) -> impl Model<f64> {
    const LOADS: [[f64; 3]; 2] = [[1e6, 1e6, -1e6], [1e6, 0.9e6, -1e6]];
    let transverse = Steps { breaks: &[0.4, 0.42], values: &LOADS[turn % 2] };
    Scene::new(1.0, Beam::elastic(5e3)).foundation(Foundation { law: Linear(1e8), gap: () }).load(Load {
        transverse,
        axial: (),
        points: (),
    })
}

/// 0.4 sin^2(pi x), its slope and its curvature.
fn wave<T: Real>(x: T) -> [T; 3] {
    let rate = T::of(2.0 * core::f64::consts::PI);
    let (sin, cos) = (rate * x).sin_cos();
    let depth = T::of(0.2);
    [depth * (T::one() - cos), depth * rate * sin, depth * rate * rate * cos]
}
