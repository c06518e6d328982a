//! A mass on a spring with dry friction: its peaks fall by 2μ/k each half cycle, until friction holds the spring. Steps
//! of any length find the peaks, because a step ends where the mass comes to rest; so do adaptive steps between events.

use mozzi::model::description::{Joint, JointKind};
use mozzi::simulation::{Method, Options, Simulation, Zero};
use mozzi::{Description, SE3, ScrewAxis, Solid, SpatialInertia};

const STIFFNESS: f64 = 100.0;
const FRICTION: f64 = 2.3;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let slide = JointKind::Screw(ScrewAxis::prismatic([1.0, 0.0, 0.0])?);
    let slide = Joint::new("slide", "wall", "mass", SE3::identity(), slide);
    let model = Description::new("spring and mass")
        .link("wall", SpatialInertia::zero())
        .link("mass", Solid::Box([0.1; 3]).inertia(1.0))
        .joint(Joint { stiffness: STIFFNESS, friction: FRICTION, ..slide })
        .build()?;

    // after k half cycles |x| = 1 − 2kμ/k: 0.034 m after 21, which friction does not hold, then 0.012 m
    let loss = 2.0 * FRICTION / STIFFNESS;
    let expected = (1.0 - 22.0 * loss).abs();
    println!("it should rest at {expected:.3} m, within μ/k = {:.3} m\n", FRICTION / STIFFNESS);
    println!("method                step [s]   rest [m]   error [m]   energy's error [J]");
    for (method, step) in [
        (Method::MoreauJean, 0.02),
        (Method::MoreauJean, 0.001),
        (Method::RungeKutta4, 0.001),
        (Method::DormandPrince { tolerance: 1e-10 }, 0.02),
    ] {
        let options = Options { method, ..Options::with_step(12.0, step)? };
        let run = Simulation::new(options).run(&model, &[1.0], &[0.0], Zero)?;
        let rest = run.motion.last().theta[0].abs();
        let (error, drift) = ((rest - expected).abs(), run.motion.largest_drift());
        println!("{:20} {step:9}   {rest:.6}   {error:9.1e}   {drift:9.1e}", method.name());
        let bound = if method == Method::RungeKutta4 { 2e-5 } else { 1e-8 };
        assert!(error < bound && run.motion.last().dtheta[0].abs() < 1e-9);
    }
    Ok(())
}
