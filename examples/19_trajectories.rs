//! Trajectories (Modern Robotics, chapter 9): a path θ(s) and a time scaling s(t) give
//!
//! > θ̇ = θ′ṡ,  θ̈ = θ″ṡ² + θ′s̈,  τ = M(θ)θ′ s̈ + (M(θ)θ″ + c(θ, θ′)) ṡ² + g(θ)
//!
//! so that along a path every limit is linear in s̈ and ṡ². The first part compares the fastest swing of a pendulum
//! with its closed-form solution: full motor torque forwards up to a switching point, and full torque backwards from
//! there,
//!
//! > ½Iθ̇² = τθ + mgl(cos θ − 1) up to where it meets ½Iθ̇² = τ(θ₁ − θ) + mgl(cos θ − cos θ₁).
//!
//! Then the UR5: a path through via points, timed by four profiles under the same limits; and its tool along a straight
//! line.

use mozzi::model::description::{Joint, JointKind};
use mozzi::{Description, SE3, ScrewAxis, SpatialInertia, Vec3};
use mozzi_motion::trajectories::{
    Cartesian, Ends, Limits, Line, Profile, Reference, Shape, Spline, Timed, stretched, time_optimal,
};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    pendulum()?;
    let ur5 = mozzi_urdf::open("ur5")?.build()?;
    let points = [
        [0.0, -1.5, 1.5, 0.0, 0.5, 0.0],
        [0.5, -1.0, 0.8, 0.5, 1.0, 0.7],
        [1.5, -1.2, 1.0, -0.4, 0.2, 1.0],
        [1.0, -0.6, 0.4, 0.0, 0.0, 0.0],
    ];
    let spline = Spline::through(&ur5, &points.map(|p| p.to_vec()), Ends::Natural)?;
    let limits = Limits { acceleration: vec![15.0; 6], ..Limits::of(&ur5) };
    println!("\nUR5 through {} points, within its velocities and torques and 15 rad/s²:", points.len());
    let fastest = time_optimal(&ur5, &spline, &limits, 300)?;
    println!("  as fast as can be   {:.4} s", fastest.duration());
    let shapes = [
        ("trapezoidal", Profile::trapezoidal_in(1.0, 0.25)?),
        ("cubic", Profile::cubic(1.0)?),
        ("quintic", Profile::quintic(1.0)?),
    ];
    for (name, shape) in shapes {
        let profile = stretched(&ur5, &spline, &shape, &limits, 600)?;
        println!("  {name:19} {:.4} s", profile.duration());
        assert!(profile.duration() > fastest.duration());
    }
    let motion = Timed::new(&spline, fastest);
    let mut most = [0.0_f64; 3];
    for (_, now) in motion.sampled(600) {
        let tau = ur5.inverse_dynamics(&now.theta, &now.dtheta, &now.ddtheta, &ur5.environment())?;
        for j in 0..6 {
            most[0] = most[0].max(now.dtheta[j].abs() / limits.velocity[j]);
            most[1] = most[1].max(now.ddtheta[j].abs() / limits.acceleration[j]);
            most[2] = most[2].max(tau[j].abs() / limits.torque[j]);
        }
    }
    println!("  the fastest uses {:.1?} % of velocity, acceleration and torque", most.map(|x| 100.0 * x));
    assert!(most.iter().all(|&x| x < 1.02) && most.iter().any(|&x| x > 0.98));

    let (from, tool) = ([0.0, -1.2, 1.5, 0.3, 1.1, 0.0], ur5.end_effector()?);
    let start = ur5.forward_kinematics(&from, tool)?;
    let goal = SE3::new(start.R, start.p + Vec3([-0.1, 0.3, -0.1]));
    let line = Cartesian::new(&ur5, tool, &from, goal, Shape::Straight, 1e-6)?;
    println!("\nits tool along a line of 0.33 m: {} solutions, {:.1e} off it between them", line.knots, line.deviation);
    let profile = time_optimal(&ur5, &line, &limits, 300)?;
    println!("  as fast as can be   {:.4} s", profile.duration());
    Ok(())
}

fn pendulum() -> Result<(), Box<dyn Error>> {
    let (m, l, tau, end) = (1.5, 0.6, 12.0, 2.5_f64);
    let axis = JointKind::Screw(ScrewAxis::new([0.0, 1.0, 0.0], [0.0; 3])?);
    let robot = Description::new("pendulum")
        .link("base", SpatialInertia::zero())
        .link("bob", SpatialInertia::point_mass(m, Vec3([0.0, 0.0, -l])))
        .joint(Joint::new("pivot", "base", "bob", SE3::identity(), axis))
        .build()?;
    let limits = Limits { torque: vec![tau], ..Limits::none(&robot) };
    let swing = time_optimal(&robot, &Line::new(&robot, &[0.0], &[end])?, &limits, 500)?;
    // T = ∫ dθ/θ̇, with the substitution θ = θ₁ sin²(x/2), which removes the square-root singularities at both ends
    let weight = |q: f64| m * 9.81 * l * q.cos();
    let speed = |q: f64| {
        let (rise, fall) = (tau * q + weight(q) - weight(0.0), tau * (end - q) + weight(q) - weight(end));
        (2.0 * rise.min(fall) / (m * l * l)).sqrt()
    };
    let parts = 20_000;
    let step = std::f64::consts::PI / f64::from(parts);
    let T: f64 = (0..parts)
        .map(|k| (f64::from(k) + 0.5) * step)
        .map(|x| 0.5 * end * x.sin() * step / speed(end * (0.5 * x).sin().powi(2)))
        .sum();
    println!("pendulum to {end} rad by at most {tau} N m: {:.5} s, by its energy {T:.5} s", swing.duration());
    assert!((swing.duration() / T - 1.0).abs() < 2e-3);
    Ok(())
}
