//! ANYmal drops on its feet, stands, and is pushed. A controller chooses torques so that the feet's forces stay within
//! their friction cones, by a small quadratic program; the ground carries exactly its weight.

use mozzi::{SE3, Vec3, Wrench};
use mozzi_motion::controllers::{Gains, Standing};
use mozzi_motion::trajectories::Hold;
use mozzi_sim::{ContactPoint, Contacts, Options, Plane, Simulation, applied};

const FEET: [&str; 4] = ["LF_FOOT", "RF_FOOT", "LH_FOOT", "RH_FOOT"];
const POSE: [f64; 12] = [0.0, 0.7, -1.0, 0.0, 0.7, -1.0, 0.0, -0.7, 1.0, 0.0, -0.7, 1.0];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let model = mozzi_urdf::open("anymal")?.description.floating().build()?;
    let points: Vec<ContactPoint> = FEET
        .iter()
        .map(|name| Ok(ContactPoint::new(*name, model.frame(name)?, Vec3::zero(), 0.6)))
        .collect::<Result<_, mozzi::Error>>()?;
    let contacts = Contacts { points: points.clone(), planes: vec![Plane::ground()] };
    let mut pose = model.neutral_configuration::<f64>();
    pose[7..].copy_from_slice(&POSE);
    pose[6] -= contacts.gaps(&model, 0.0, &pose).into_iter().fold(f64::INFINITY, f64::min);
    let mut start = pose.clone();
    start[6] += 0.02; // it drops 2 cm

    let hold = Hold::new(&pose, model.n());
    let mut standing = Standing::new(&model, &hold, Gains::critical(model.n(), 12.0), points, SE3::identity())?;
    // from 1.5 s on something pushes the base with 150 N along y for 0.1 s: the robot applies −150 N
    let push = applied(model.frame("base")?, |t, _, _| Wrench {
        m: Vec3::zero(),
        f: Vec3([0.0, if (1.5..1.6).contains(&t) { -150.0 } else { 0.0 }, 0.0]),
    });
    let options = Options { record_every: 125, ..Options::with_step(4.0, 2e-3)? };
    let run = Simulation { contacts, ..Simulation::new(options) }.run(
        &model,
        &start,
        &vec![0.0; model.n()],
        (&mut standing, push),
    )?;

    println!("  t [s]   base y [m]   base z [m]   force on the ground [N]");
    for row in run.motion.samples() {
        let down = -row.total_contact_force().0[2];
        println!("{:7.2}   {:10.5}   {:10.5}   {down:10.3}", row.t, row.theta[5], row.theta[6]);
    }
    for event in run.contact_events.iter().take(8) {
        println!("{} {} at {:.3} s", event.contact, event.change.name(), event.t);
    }
    let account = run.one_sided.ok_or("no contacts")?;
    println!("the laws of friction hold to {:.0e} m/s in every step", account.largest_residual);
    let last = run.motion.last();
    let weight = -last.total_contact_force().0[2];
    let mass = model.mass_matrix(&pose)?[(3, 3)];
    println!("at the end the ground carries {weight:.6} N, the weight is {:.6} N", mass * 9.81);
    // the feet slid by a millimetre when they touched down; after the push the base returns to where it stood before
    let before = run.motion.samples().filter(|row| row.t <= 1.5).last().ok_or("no row before the push")?;
    assert!((weight / (mass * 9.81) - 1.0).abs() < 1e-4 && (last.theta[5] - before.theta[5]).abs() < 1e-3);
    assert!(account.unsolved == 0);
    Ok(())
}
