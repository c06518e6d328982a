//! A wheeled base: two driven wheels that roll without slipping (Modern Robotics, sections 8.7 and 13.3). Their
//! constraints are Pfaffian: they restrict velocities but not positions. With equal constant wheel speeds the base
//! drives straight, with different ones along a circle, in agreement with the kinematics of a unicycle.

use mozzi::model::description::{Anchor, Constraint, Joint, JointKind};
use mozzi::{Description, Error, Model, SE3, SO3, ScrewAxis, Solid, SpatialInertia, Vec3};
use mozzi_sim::{Options, Simulation, torque};
use std::f64::consts::FRAC_PI_2;

/// Radius of the wheels and half of their distance, m.
const RADIUS: f64 = 0.1;
const HALF_TRACK: f64 = 0.2;

fn base() -> Result<Model, Error> {
    let slide = |axis: [f64; 3]| JointKind::Screw(ScrewAxis::prismatic(axis).expect("a unit axis"));
    let turn = |axis: [f64; 3]| JointKind::Screw(ScrewAxis::new(axis, [0.0; 3]).expect("a unit axis"));
    let up = SE3::translation([0.0, 0.0, RADIUS]);
    let mut robot = Description::new("wheeled base")
        .link("floor", SpatialInertia::zero())
        .link("slide", SpatialInertia::zero())
        .link("turntable", SpatialInertia::zero())
        .link("chassis", Solid::Box([0.5, 0.3, 0.1]).inertia(8.0))
        .joint(Joint::new("x", "floor", "slide", up, slide([1.0, 0.0, 0.0])))
        .joint(Joint::new("y", "slide", "turntable", SE3::identity(), slide([0.0, 1.0, 0.0])))
        .joint(Joint::new("heading", "turntable", "chassis", SE3::identity(), turn([0.0, 0.0, 1.0])));
    for (name, side) in [("left", HALF_TRACK), ("right", -HALF_TRACK)] {
        // the wheel's own z-axis is its axle, along y of the chassis
        let axle = SE3 { R: SO3::from_rpy(-FRAC_PI_2, 0.0, 0.0), p: Vec3([0.0, side, 0.0]) };
        let wheel = Solid::Cylinder { radius: RADIUS, length: 0.04 }.inertia(0.5);
        robot = robot
            .link(name, wheel)
            .joint(Joint::new(format!("{name}_axle"), "chassis", name, axle, turn([0.0, 0.0, 1.0])))
            .constraint(Constraint::rolling(format!("{name} rolls"), "floor", Anchor::frame(name), RADIUS));
    }
    robot.motors = Some(vec!["left_axle".into(), "right_axle".into()]);
    robot.build()
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let model = base()?;
    let theta = [0.0; 5];
    let rank = model.constraint_rank(&theta)?;
    println!("{} rows of rank {} leave {} degrees of freedom of velocity", rank.rows, rank.rank, rank.freedom);
    println!("redundant: {}\n", rank.redundant.join(", "));
    assert_eq!((rank.rank, rank.freedom), (3, 2));

    // wheel speeds 4 and 6 rad/s; without drive or brakes the motion is steady
    let wheels = ["left_axle", "right_axle"];
    let dtheta = model.assemble_velocities(&theta, &[0.0, 0.0, 0.0, 4.0, 6.0], &wheels)?;
    let speed = RADIUS * (4.0 + 6.0) / 2.0;
    let turning = RADIUS * (6.0 - 4.0) / (2.0 * HALF_TRACK);
    println!("unicycle: {speed} m/s, {turning} rad/s; the constraints: {:.6} m/s, {:.6} rad/s", dtheta[0], dtheta[2]);
    let options = Options { record_every: 500, ..Options::new(4.0, 4000) };
    let coast = Simulation::new(options).run(&model, &theta, &dtheta, mozzi_sim::Zero)?;
    println!("\n  t [s]       x [m]       y [m]   heading    on the circle to [m]");
    let mut worst = 0.0_f64;
    for sample in coast.motion.samples() {
        let angle = turning * sample.t;
        let circle = [speed / turning * angle.sin(), speed / turning * (1.0 - angle.cos())];
        let off = (sample.theta[0] - circle[0]).hypot(sample.theta[1] - circle[1]);
        worst = worst.max(off);
        println!(
            "  {:5.2}  {:10.6}  {:10.6}  {:8.4}    {off:.1e}",
            sample.t, sample.theta[0], sample.theta[1], sample.theta[2]
        );
    }
    assert!(worst < 1e-9, "{worst:e}");

    // equal torques from rest: straight motion that accelerates the total mass and both wheels' inertia
    let push = torque(|_, _, _, tau: &mut [f64]| (tau[3], tau[4]) = (0.2, 0.2));
    let straight = Simulation::new(options).run(&model, &theta, &[0.0; 5], push)?;
    let wheel = 0.5 * 0.5 * RADIUS * RADIUS; // of a disc
    let acceleration = 2.0 * 0.2 / RADIUS / (8.0 + 2.0 * 0.5 + 2.0 * wheel / (RADIUS * RADIUS));
    let expected = 0.5 * acceleration * 16.0;
    let end = straight.motion.last();
    println!("\nstraight on: {:.9} m in 4 s, expected {expected:.9}", end.theta[0]);
    assert!((end.theta[0] - expected).abs() < 1e-9 && end.theta[1].abs() < 1e-12);
    Ok(())
}
