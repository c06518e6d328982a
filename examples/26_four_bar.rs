//! A four-bar linkage two ways (Modern Robotics, section 8.7): by multipliers, τ = Mθ̈ + h + Aᵀλ with Aθ̈ + Ȧθ̇ = 0, in
//! three coordinates; and by reduction, Nᵀτ = (NᵀMN)u̇ + Nᵀ(h + Mn₀), in the crank's angle alone. Both give the same
//! motion.

use mozzi::model::description::{Anchor, Constraint, Joint, JointKind};
use mozzi::nalgebra::DVector;
use mozzi::{Description, Error, Model, SE3, ScrewAxis, Solid, SpatialInertia, Twist, Vec3};
use mozzi_sim::{Options, Simulation, Zero};
use std::f64::consts::FRAC_PI_2;

/// Lengths of ground, crank, coupler and rocker, m; the rods have 1 kg/m.
const LENGTHS: [f64; 4] = [0.9, 0.3, 0.8, 0.6];

fn four_bar() -> Result<Model, Error> {
    let [ground, crank, coupler, rocker] = LENGTHS;
    let rod = |length: f64| Solid::Box([length, 0.02, 0.02]).inertia(length);
    let along = |x: f64| SE3::translation([x, 0.0, 0.0]);
    // a link's frame is in the middle of its rod; joints turn about −y, so that positive angles lift the rods
    let joint = |name: &str, parent: &str, at: f64, child: &str, length: f64| {
        let axis = ScrewAxis::from_line([0.0, -1.0, 0.0], [-length / 2.0, 0.0, 0.0], 0.0).expect("a unit axis");
        Joint::new(name, parent, child, along(at + length / 2.0), JointKind::Screw(axis))
    };
    // a hinge turns about its anchors' z-axes
    let z_along_y = SE3::exp(Twist { w: Vec3([FRAC_PI_2, 0.0, 0.0]), v: Vec3([0.0; 3]) });
    let end = |link: &str, length: f64| Anchor::frame(link).at(along(length / 2.0) * z_along_y);
    Description::new("four-bar")
        .link("ground", SpatialInertia::zero())
        .link("crank", rod(crank))
        .link("coupler", rod(coupler))
        .link("rocker", rod(rocker))
        .joint(joint("crank_pivot", "ground", 0.0, "crank", crank))
        .joint(joint("coupler_pivot", "crank", crank / 2.0, "coupler", coupler))
        .joint(joint("rocker_pivot", "ground", ground, "rocker", rocker))
        .constraint(Constraint::hinge("loop", end("coupler", coupler), end("rocker", rocker)))
        .build()
}

/// u̇ of the crank without torque, at a θ that nearly closes the loop.
fn reduced(model: &Model, theta: &mut Vec<f64>, angle: f64, rate: f64) -> Result<f64, Error> {
    theta[0] = angle;
    *theta = model.assemble(theta, &["crank_pivot"])?;
    let dtheta = model.assemble_velocities(theta, &[rate, 0.0, 0.0], &["crank_pivot"])?;
    let own = model.reduce(theta, &dtheta, &["crank_pivot"], &model.environment())?;
    Ok(-own.h[0] / own.M[(0, 0)])
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let model = four_bar()?;
    let theta = model.assemble(&[1.0, -0.6, 1.6], &["crank_pivot"])?;
    let dtheta = model.assemble_velocities(&theta, &[1.5, 0.0, 0.0], &["crank_pivot"])?;
    let rank = model.constraint_rank(&theta)?;
    println!("the loop: {} rows of rank {}, redundant: {}", rank.rows, rank.rank, rank.redundant.join(", "));
    println!("closed at θ = {theta:.6?}, moving with θ̇ = {dtheta:.6?}\n");

    // the whole mechanism
    let options = Options { record_every: 200, ..Options::new(2.0, 2000) };
    let run = Simulation::new(options).run(&model, &theta, &dtheta, Zero)?;

    // its crank alone, by the Runge-Kutta method
    let (mut u, mut near) = ([theta[0], dtheta[0]], theta.clone());
    let h = 0.001;
    let mut rate = |[angle, rate]: [f64; 2]| Ok::<_, Error>([rate, reduced(&model, &mut near, angle, rate)?]);
    println!("  t [s]   crank, by multipliers   by reduction   force in the loop [N]");
    let mut worst = 0.0_f64;
    for sample in run.motion.samples() {
        let found = model.constrained_forward_dynamics(sample.theta, sample.dtheta, &[0.0; 3], &model.environment())?;
        let force = DVector::from_column_slice(&found.wrenches[0].1.f.0).norm();
        println!("  {:5.2}   {:21.9}   {:12.9}   {force:21.3}", sample.t, sample.theta[0], u[0]);
        worst = worst.max((sample.theta[0] - u[0]).abs());
        for _ in 0..200 {
            let add = |u: [f64; 2], k: [f64; 2], h: f64| [u[0] + h * k[0], u[1] + h * k[1]];
            let k1 = rate(u)?;
            let k2 = rate(add(u, k1, h / 2.0))?;
            let k3 = rate(add(u, k2, h / 2.0))?;
            let k4 = rate(add(u, k3, h))?;
            u = [0, 1].map(|i| u[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
        }
    }
    println!(
        "\nthe two motions differ by at most {worst:.1e} rad; energy drifts by {:.1e} J; the loop stays closed to {:.1e} m",
        run.motion.largest_drift(),
        run.closing.residual
    );
    assert!(worst < 1e-7 && run.motion.largest_drift() < 1e-8 && run.closing.residual < 1e-13);
    Ok(())
}
