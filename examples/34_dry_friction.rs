//! A mass on a spring with dry friction: its peaks fall by 2μ/k each half cycle, until friction holds the spring. Steps
//! of any length find the peaks, because a step ends where the mass comes to rest. Smooth methods refuse such a robot.

use mozzi::model::description::{Joint, JointKind};
use mozzi::{Description, SE3, ScrewAxis, Solid, SpatialInertia};
use mozzi_sim::{Method, Options, Simulation, Zero};

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
    println!("step [s]   rest [m]   error [m]   energy's error [J]");
    for step in [0.02, 0.005, 0.001] {
        let run = Simulation::new(Options::with_step(12.0, step)?).run(&model, &[1.0], &[0.0], Zero)?;
        let rest = run.motion.last().theta[0].abs();
        let (error, drift) = ((rest - expected).abs(), run.motion.largest_drift());
        println!("{step:8}   {rest:.6}   {error:9.1e}   {drift:9.1e}");
        assert!(run.method == Method::MoreauJean && error < 1e-8 && run.motion.last().dtheta[0].abs() < 1e-9);
    }
    let smooth = Options { method: Method::RungeKutta4, ..Options::with_step(12.0, 0.001)? };
    let refusal = Simulation::new(smooth).run(&model, &[1.0], &[0.0], Zero).expect_err("dry friction");
    println!("\n{refusal}");
    Ok(())
}
