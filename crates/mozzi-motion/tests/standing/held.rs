//! The controller that stands on given feet.

use crate::anymal::{anymal, feet, mass, start};
use mozzi::{SE3, Vec3, Wrench};
use mozzi_motion::controllers::{Gains, Standing};
use mozzi_motion::trajectories::Hold;
use mozzi_sim::{Contacts, Input, Options, Plane, Simulation, Support, applied};

#[test]
fn it_stands_within_its_cones_and_is_pushed() {
    let model = anymal(0.0);
    let contacts = feet(&model, 0.6);
    let theta = start(&model, &contacts, 0.0);
    let still = vec![0.0; model.n()];
    let hold = Hold::new(&theta, model.n());
    let points = contacts.points.clone();
    let mut standing =
        Standing::new(&model, &hold, Gains::critical(model.n(), 10.0), points.clone(), SE3::identity()).expect("sound");
    let mut tau = still.clone();
    standing.torque(0.0, &theta, &still, &mut tau).expect("forces");
    // at rest: the feet carry the weight, and the robot does not accelerate
    let weight: f64 = standing.forces.iter().map(|f| f[0]).sum();
    println!("carried {weight:.9} of {:.9} N, τ {tau:.3?}", mass(&model) * 9.81);
    assert!((weight - mass(&model) * 9.81).abs() < 1e-5 && tau[..6].iter().all(|x| *x == 0.0));

    // pushed sideways by 100 N for 0.1 s at the base: the robot applies −100 N
    let base = model.frame("base").expect("there");
    let push = applied(base, |t, _, _| {
        let size = if (0.5..0.6).contains(&t) { -100.0 } else { 0.0 };
        Wrench::from_array([0.0, 0.0, 0.0, 0.0, size, 0.0])
    });
    let contacts = Contacts { points, planes: vec![Plane::ground()] };
    let options = Options::with_step(4.0, 2e-3).expect("fits");
    let run = Simulation { contacts, ..Simulation::new(options) }
        .run(&model, &theta, &still, (&mut standing, push))
        .expect("a motion");
    let most = run.motion.samples().map(|row| (row.theta[5] - theta[5]).abs()).fold(0.0, f64::max);
    let last = run.motion.last();
    let left = (0..model.nq()).map(|i| (last.theta[i] - theta[i]).abs()).fold(0.0, f64::max);
    let account = run.one_sided.expect("contacts");
    println!(
        "pushed {most:.4} m aside, {left:.1e} from the pose at the end, {:?}, {account:?}",
        run.contact_events.len()
    );
    assert!(most > 1e-3 && left < 1e-4 && account.unsolved == 0);
    // forces stay within the cones
    for row in run.motion.samples() {
        for force in row.contact_forces {
            let f = force.f.0;
            assert!(f[2] <= 1e-9 && f[0].hypot(f[1]) <= 0.6 * -f[2] + 1e-6);
        }
    }
}

#[test]
fn a_ball_is_held_at_the_point_that_touches() {
    let model = anymal(0.0).with_gravity([2.5, 0.0, -9.48]).expect("sound");
    let contacts = feet(&model, 0.6);
    let theta = start(&model, &contacts, 0.0);
    let (hold, still) = (Hold::new(&theta, model.n()), vec![0.0; model.n()]);
    let torques = |radius: f64| {
        let mut points = contacts.points.clone();
        for point in &mut points {
            let up =
                model.forward_kinematics(&theta, point.frame).expect("lengths").R.inverse_mul(Vec3([0.0, 0.0, 1.0]));
            (point.center, point.support) = (up * radius, Support::Sphere { radius });
        }
        let gains = Gains::critical(model.n(), 10.0);
        let mut tau = still.clone();
        let mut standing = Standing::new(&model, &hold, gains, points, SE3::identity()).expect("sound");
        standing.torque(0.0, &theta, &still, &mut tau).expect("forces");
        tau
    };
    for (ball, point) in torques(0.1).iter().zip(torques(0.0)) {
        assert!((ball - point).abs() < 1e-4, "{ball} {point}");
    }
}
