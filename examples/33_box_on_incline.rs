//! A box on an incline with Coulomb friction: it sticks at 20°, slides at 35°, and thrown across the slope it comes to
//! rest where the differential equation of a sliding point predicts. Four corners share the force: their single forces
//! are not unique, their sum is.

use mozzi::{Description, SE3, SO3, Solid, Vec3};
use mozzi_sim::{ContactPoint, Contacts, Options, Plane, Run, Simulation, Zero};

const SIZE: [f64; 3] = [0.3, 0.2, 0.1];
const MU: f64 = 0.5;
const G: f64 = 9.81;

/// A motion on a slope, from a velocity along it, and the way of the box along the slope.
fn on_slope(angle: f64, v: [f64; 2], duration: f64) -> Result<(Run, Vec3), mozzi_sim::Error> {
    let model = Description::new("box").link("box", Solid::Box(SIZE).inertia(4.0)).floating().build()?;
    let frame = model.frame("box")?;
    let corner = |x: f64, y: f64| Vec3([x * 0.5 * SIZE[0], y * 0.5 * SIZE[1], -0.5 * SIZE[2]]);
    let corners = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
    let points = corners.map(|(x, y)| ContactPoint::new("corner", frame, corner(x, y), MU)).to_vec();
    let slope = SE3::new(SO3::exp(Vec3([0.0, angle, 0.0])), Vec3::zero());
    let start = slope * SE3::translation([0.0, 0.0, 0.5 * SIZE[2]]);
    let contacts = Contacts { points, planes: vec![Plane::fixed("slope", slope)] };
    let simulation = Simulation { contacts, ..Simulation::new(Options::with_step(duration, 1e-3)?) };
    let run = simulation.run(&model, &start.to_pose(), &[0.0, 0.0, 0.0, v[0], v[1], 0.0], Zero)?;
    let last = SE3::from_pose(std::array::from_fn(|k| run.motion.last().theta[k]));
    let way = (start.inverse() * last).p;
    Ok((run, way))
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (run, way) = on_slope(20_f64.to_radians(), [0.0; 2], 1.0)?;
    println!("20°: by {}, the box moves {:.1e} m in 1 s", run.method.name(), way.norm());
    assert!(way.norm() < 1e-12);

    let angle = 35_f64.to_radians();
    let (run, way) = on_slope(angle, [0.0; 2], 1.0)?;
    let expected = 0.5 * G * (angle.sin() - MU * angle.cos());
    let energy = run.motion.last().energy;
    println!("35°: it slides {:.6} m, ½at² = {expected:.6} m; friction takes {:.4} J", way.0[0], energy.friction_loss);
    assert!((way.0[0] - expected).abs() < 1e-12 && run.motion.largest_drift() < 1e-10);

    let (run, way) = on_slope(15_f64.to_radians(), [-1.0, 1.5], 1.2)?;
    println!("15°, thrown upwards and across: it rests at {:.6}, {:.6} m", way.0[0], way.0[1]);
    println!(
        "contacts change {} times; the laws hold to {:.0e} m/s",
        run.contact_events.len(),
        run.one_sided.map_or(0.0, |account| account.largest_residual)
    );
    assert!((way.0[0] + 0.098_304).abs() < 1e-5 && (way.0[1] - 0.261_755).abs() < 1e-5);
    Ok(())
}
