//! A Delta robot under computed torque. Three motor-driven arms are mounted on a ring; two rods of equal length connect
//! each elbow to the platform and keep it parallel to the ring, so that it can only translate. Each pair of rods is a
//! `distance` constraint between elbow and platform, with half of its mass at either end (Codourey 1998). The numbers
//! are our own, of the size of a pick-and-place machine.
//!
//! Only the three arms have motors: the torques come from constrained inverse dynamics.

use mozzi::model::description::{Anchor, Constraint, Joint, JointKind};
use mozzi::{Description, Error, Model, SE3, SO3, ScrewAxis, Solid, SpatialInertia, Vec3};
use mozzi_motion::controllers::{ComputedTorque, Gains};
use mozzi_motion::trajectories::{Desired, Reference};
use mozzi_sim::{Options, Simulation};
use std::f64::consts::TAU;

/// Radii of the ring and of the platform, lengths of an arm and of its rods, m.
const RING: f64 = 0.2;
const PLATFORM: f64 = 0.05;
const ARM: f64 = 0.25;
const RODS: f64 = 0.55;
/// Masses of an arm, of a pair of rods, of the platform with its load, kg.
const MASSES: [f64; 3] = [0.4, 0.15, 0.5];

fn delta() -> Result<Model, Error> {
    let [arm, rods, platform] = MASSES;
    let slide = |axis: [f64; 3]| JointKind::Screw(ScrewAxis::prismatic(axis).expect("a unit axis"));
    let mut robot = Description::new("delta").link("ring", SpatialInertia::zero());
    // the platform
    let mut parent = "ring".to_string();
    for (name, axis) in [("x", [1.0, 0.0, 0.0]), ("y", [0.0, 1.0, 0.0]), ("z", [0.0, 0.0, 1.0])] {
        let mass = if name == "z" { platform + 1.5 * rods } else { 0.0 };
        let child = if name == "z" { "platform".to_string() } else { format!("slide_{name}") };
        robot = robot.link(&child, SpatialInertia::point_mass(mass, Vec3([0.0; 3]))).joint(Joint::new(
            name,
            &parent,
            &child,
            SE3::identity(),
            slide(axis),
        ));
        parent = child;
    }
    // the arms: in its own axes, each arm points along x and turns about y
    for k in 1..=3 {
        let turn = SE3 { R: SO3::from_rpy(0.0, 0.0, TAU / 3.0 * f64::from(k)), p: Vec3([0.0; 3]) };
        let out = |x: f64| SE3::translation([x, 0.0, 0.0]);
        let rod = Solid::Box([ARM, 0.03, 0.03]).inertia(arm).transformed(out(ARM / 2.0));
        let inertia = rod + SpatialInertia::point_mass(rods / 2.0, Vec3([ARM, 0.0, 0.0]));
        let pivot = JointKind::Screw(ScrewAxis::new([0.0, 1.0, 0.0], [0.0; 3]).expect("a unit axis"));
        let (motor, link) = (format!("motor{k}"), format!("arm{k}"));
        robot = robot.link(&link, inertia).joint(Joint::new(motor, "ring", &link, turn * out(RING), pivot));
        let elbow = Anchor::frame(&link).at(out(ARM));
        let below = Anchor::frame("platform").at(turn * out(PLATFORM));
        robot = robot.constraint(Constraint::distance(format!("rods{k}"), elbow, below, RODS));
    }
    robot.motors = Some((1..=3).map(|k| format!("motor{k}")).collect());
    robot.build()
}

/// A circle of the platform, and the corresponding joint motion.
struct Circle<'m> {
    model: &'m Model,
    start: Vec<f64>,
}

impl Reference for Circle<'_> {
    fn at(&self, t: f64) -> Desired {
        let (radius, turns) = (0.08, 2.0); // m, per second
        let w = TAU * turns;
        let (sin, cos) = (w * t).sin_cos();
        let platform = ["x", "y", "z"];
        let solve = || -> Result<Desired, Error> {
            let mut theta = self.start.clone();
            theta[..3].copy_from_slice(&[radius * cos, radius * sin, self.start[2]]);
            let theta = self.model.assemble(&theta, &platform)?;
            let rates = [-radius * w * sin, radius * w * cos, 0.0, 0.0, 0.0, 0.0];
            let dtheta = self.model.assemble_velocities(&theta, &rates, &platform)?;
            let rates = [-radius * w * w * cos, -radius * w * w * sin, 0.0, 0.0, 0.0, 0.0];
            let ddtheta = self.model.assemble_accelerations(&theta, &dtheta, &rates, &platform)?;
            Ok(Desired { theta, dtheta, ddtheta })
        };
        solve().expect("a circle within reach")
    }

    fn duration(&self) -> f64 {
        1.0
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let model = delta()?;
    let start = model.assemble(&[0.08, 0.0, -0.45, 0.3, 0.3, 0.3], &["x", "y", "z"])?;
    let rank = model.constraint_rank(&start)?;
    println!("{} velocities, {} constraint rows: {} degrees of freedom", model.n(), rank.rows, rank.freedom);

    let circle = Circle { model: &model, start: start.clone() };
    let begin = circle.at(0.0);
    let held =
        model.constrained_inverse_dynamics(&begin.theta, &begin.dtheta, &begin.ddtheta, &model.environment(), None)?;
    println!(
        "torques at the start: {:.3?} N m; rods pull with {:.2?} N",
        &held.tau.as_slice()[3..],
        held.lambda.as_slice()
    );

    // 5 mm off the circle; the error decays according to ë + K_d ė + K_p e = 0
    let mut beside = begin.theta.clone();
    beside[0] += 0.005;
    let beside = model.assemble(&beside, &["x", "y", "z"])?;
    let rates = model.assemble_velocities(&beside, &begin.dtheta, &["x", "y", "z"])?;
    let control = ComputedTorque::new(&model, circle, Gains::critical(model.n(), 20.0))?;
    let options = Options { record_every: 100, ..Options::new(1.0, 1000) };
    let run = Simulation::new(options).run(&model, &beside, &rates, control)?;
    println!("\n  t [s]    error of the platform [mm]    torques of the motors [N m]");
    let circle = Circle { model: &model, start };
    let mut error = 0.0;
    for sample in run.motion.samples() {
        let desired = circle.at(sample.t);
        error = (0..3).map(|k| (sample.theta[k] - desired.theta[k]).powi(2)).sum::<f64>().sqrt();
        println!("  {:5.2}    {:26.6}    {:8.3?}", sample.t, 1e3 * error, &sample.tau[3..]);
    }
    println!("\nthe rods keep their lengths to {:.1e} m", run.closing.residual);
    assert!(error < 1e-6 && run.closing.residual < 1e-12, "{error} {:?}", run.closing);
    Ok(())
}
