//! Balls that bounce, wheels and balls that roll, planes that move.

use super::robots::by;
use mozzi::{Description, Model, SE3, Solid, SpatialInertia, Sym3, Twist, Vec3};
use mozzi_sim::{
    ContactPoint, Contacts, Method, Options, Plane, PlaneMotion, Run, Simulation, Support, Thinned, Trajectory, Zero,
};

const G: f64 = 9.81;
pub const RADIUS: f64 = 0.1;

/// A solid ball of 0.5 kg that floats.
pub fn ball() -> Model {
    Description::new("ball")
        .link("ball", Solid::Sphere { radius: RADIUS }.inertia(0.5))
        .floating()
        .build()
        .expect("sound")
}

fn contact(model: &Model, link: &str, support: Support, mu: f64, restitution: f64) -> ContactPoint {
    let point = ContactPoint::new(link, model.frame(link).expect("there"), Vec3::zero(), mu);
    ContactPoint { support, restitution, ..point }
}

pub fn rolling(
    model: &Model,
    plane: Plane<'static>,
    mu: f64,
    restitution: f64,
    start: [[f64; 3]; 3],
    options: Options,
) -> Run {
    let contacts = Contacts {
        points: vec![contact(model, "ball", Support::Sphere { radius: RADIUS }, mu, restitution)],
        planes: vec![plane],
    };
    let [p, w, v] = start;
    let theta = [1.0, 0.0, 0.0, 0.0, p[0], p[1], p[2]];
    let dtheta = [w, v].concat();
    Simulation { contacts, ..Simulation::new(options) }.run(model, &theta, &dtheta, Zero).expect("a motion")
}

/// Height of a ball dropped from 1 m with restitution e.
pub fn bounced(t: f64, e: f64) -> f64 {
    let fall = (2.0 / G).sqrt();
    if t < fall {
        return 1.0 - 0.5 * G * t * t;
    }
    let (mut t, mut v) = (t - fall, e * (2.0 * G).sqrt());
    while v > 1e-12 {
        if t < 2.0 * v / G {
            return v * t - 0.5 * G * t * t;
        }
        t -= 2.0 * v / G;
        v *= e;
    }
    0.0
}

#[test]
fn rows_keep_the_forces_that_act() {
    let model = ball();
    let plane = |name, z| Plane::fixed(name, SE3::translation([0.0, 0.0, z]));
    let point = contact(&model, "ball", Support::Sphere { radius: RADIUS }, 0.5, 0.0);
    let contacts = Contacts { points: vec![point], planes: vec![plane("far below", -5.0), plane("ground", 0.0)] };
    let start = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, RADIUS + 0.01];
    let simulation = Simulation { contacts, ..Simulation::new(by(Method::MoreauJean, 0.2, 1e-3)) };
    let mut both = (Thinned::new(&model, 30), Trajectory::new(&model));
    let going = |_| std::ops::ControlFlow::Continue(());
    simulation.stream(&model, &start, &[0.0; 6], Zero, &mut both, going).expect("a motion");
    let (thinned, whole) = (both.0.into_trajectory(), both.1);
    let stride = mozzi_sim::stride(whole.len(), 30);
    assert!(thinned.samples().eq(whole.samples().step_by(stride)) && thinned.len() > 10);
    assert_eq!((whole.carrying(), whole.sample(0).contact_forces.len()), (vec![1], 0));
    let last = thinned.last();
    assert_eq!(last.forces_of([0, 1]), [[0.0; 3], last.total_contact_force().0].concat());
    assert!((last.total_contact_force() + Vec3([0.0, 0.0, 0.5 * G])).norm() < 1e-9);
}

#[test]
fn a_ball_bounces() {
    let model = ball();
    for step in [1e-3, 1e-4] {
        let start = [[0.0, 0.0, 1.0 + RADIUS], [0.0; 3], [0.0; 3]];
        let run = rolling(&model, Plane::ground(), 0.5, 0.8, start, by(Method::MoreauJean, 6.0, step));
        let mut worst = 0.0_f64;
        for row in run.motion.samples().step_by(10) {
            worst = worst.max((row.theta[6] - RADIUS - bounced(row.t, 0.8)).abs());
        }
        let last = run.motion.last();
        println!(
            "{step:e} s: largest error {worst:.1e} m, at the end gap {:.1e} m, speed {:.1e} m/s, {:?}",
            last.theta[6] - RADIUS,
            last.dtheta[5],
            run.one_sided.expect("contacts")
        );
        assert!(worst < 50.0 * step * step && last.dtheta[5].abs() < 1e-10);
    }
}

#[test]
fn a_ball_that_loses_nothing_bounces_as_high_for_ever() {
    for step in [1e-3, 3e-3] {
        let start = [[0.0, 0.0, 0.03 + RADIUS], [0.0; 3], [0.0; 3]];
        let run = rolling(&ball(), Plane::ground(), 0.5, 1.0, start, by(Method::MoreauJean, 20.0, step));
        let total = |k: usize| run.motion.energy[k].kinetic + run.motion.energy[k].potential;
        let change = (0..run.motion.len()).map(|k| (total(k) - total(0)).abs()).fold(0.0, f64::max);
        println!(
            "{step:e} s: energy changes by at most {change:.1e} J of {:.2} J",
            run.motion.largest_kinetic_energy()
        );
        assert!(change < 1e-9 * run.motion.largest_kinetic_energy());
    }
}

#[test]
fn a_ball_begins_to_roll() {
    // it slides until v = ωr, at 5/7 of its first speed, after 2v₀/(7μg)
    let (model, v, mu) = (ball(), 1.4, 0.2);
    let start = [[0.0, 0.0, RADIUS], [0.0; 3], [v, 0.0, 0.0]];
    let rolls = 2.0 * v / (7.0 * mu * G);
    for (step, bound) in [(1e-3, 2e-6), (5e-4, 1e-6)] {
        let run = rolling(&model, Plane::ground(), mu, 0.0, start, by(Method::MoreauJean, 1.0, step));
        let last = run.motion.last();
        let way = v * rolls - 0.5 * mu * G * rolls * rolls + 5.0 / 7.0 * v * (1.0 - rolls);
        let twist = &last.dtheta;
        let speed = (twist[3].powi(2) + twist[4].powi(2) + twist[5].powi(2)).sqrt();
        let lost = 0.5 * 0.5 * v * v * 2.0 / 7.0;
        println!(
            "{step:e} s: way error {:.1e} m, speed error {:.1e} m/s, height {:.1e} m, loss error {:.1e} J",
            last.theta[4] - way,
            speed - 5.0 / 7.0 * v,
            last.theta[6] - RADIUS,
            last.energy.friction_loss - lost
        );
        assert!((last.theta[4] - way).abs() < bound && (speed - 5.0 / 7.0 * v).abs() < bound);
        assert!((last.theta[6] - RADIUS).abs() < 1e-12 && (last.energy.friction_loss - lost).abs() < 1e-5);
    }
}

/// A ball that lands sideways and spinning loses the velocity of its lowest point at once where friction suffices: it
/// never slides on, nor back.
#[test]
fn a_ball_that_lands_rolls_at_once() {
    let model = ball();
    for k in 0..40 {
        let part = |a: f64| (a * f64::from(k)).sin();
        let (w, v) = ([5.0 * part(0.7), 5.0 * part(1.3), 5.0 * part(1.9)], [part(2.3), part(3.1), 0.0]);
        let start = [[0.0, 0.0, RADIUS + 0.1], w, v];
        let run = rolling(&model, Plane::ground(), 0.7, 0.0, start, by(Method::MoreauJean, 0.2, 1e-3));
        let slip = [v[0] - RADIUS * w[1], v[1] + RADIUS * w[0]];
        let rows: Vec<_> = run.motion.samples().collect();
        for (before, after) in rows[150..].iter().zip(&rows[151..]) {
            for i in 0..2 {
                let rate = (after.theta[4 + i] - before.theta[4 + i]) / 1e-3;
                let expected = v[i] - 2.0 / 7.0 * slip[i];
                assert!((rate - expected).abs() < 1e-5, "{k}: {rate} {expected} at {}", after.t);
            }
        }
    }
}

#[test]
fn a_wheel_rolls_down_inside_the_cone_and_slides_outside() {
    // a thin wheel, I = ½mr² about its axis y, on a slope: it rolls with ⅔ g sin α as long as tan α ≤ 3μ
    let across = 0.5 * RADIUS * RADIUS;
    let wheel = SpatialInertia::new(1.0, Vec3::zero(), Sym3::diagonal(0.5 * across, across, 0.5 * across));
    let model = Description::new("wheel").link("wheel", wheel).floating().build().expect("sound");
    let angle = 20_f64.to_radians();
    let turn = mozzi::SO3::exp(Vec3([0.0, angle, 0.0]));
    for (mu, a) in [(0.2, 2.0 / 3.0 * G * angle.sin()), (0.1, G * (angle.sin() - 0.1 * angle.cos()))] {
        let support = Support::Disc { axis: Vec3([0.0, 1.0, 0.0]), radius: RADIUS, turn: 0.0 };
        let contacts = Contacts {
            points: vec![contact(&model, "wheel", support, mu, 0.0)],
            planes: vec![Plane::fixed("slope", SE3::new(turn, Vec3::zero()))],
        };
        let theta = SE3::new(turn, turn * Vec3([0.0, 0.0, RADIUS])).to_pose();
        let simulation = Simulation { contacts, ..Simulation::new(by(Method::Automatic, 1.0, 1e-3)) };
        let run = simulation.run(&model, &theta, &[0.0; 6], Zero).expect("a motion");
        let way = turn.inverse_mul(Vec3(std::array::from_fn(|k| run.motion.last().theta[4 + k])));
        let twist = run.motion.last().dtheta;
        // the velocity of the wheel's lowest point, in the axes of the slope
        let speed = (twist[3].powi(2) + twist[5].powi(2)).sqrt();
        println!(
            "μ {mu}: way error {:.1e} m, height {:.1e}, slip {:.1e} m/s",
            way.0[0] - 0.5 * a,
            way.0[2] - RADIUS,
            speed - RADIUS * twist[1]
        );
        assert!((way.0[0] - 0.5 * a).abs() < 1e-9 && (way.0[2] - RADIUS).abs() < 1e-10);
        let slip = speed - RADIUS * twist[1];
        assert!(if mu == 0.2 { slip.abs() < 1e-10 } else { slip > 0.1 });
    }
}

#[test]
fn an_ellipsoid_rocks_at_the_frequency_of_its_curvature() {
    // at its lowest point the section has radius of curvature ρ = a²/c: (I + mc²)φ̈ = −mg(ρ − c)φ for rolling
    let [a, b, c] = [0.3, 0.2, 0.1];
    let I = Sym3::diagonal(b * b + c * c, a * a + c * c, a * a + b * b);
    let inertia = SpatialInertia::new(1.0, Vec3::zero(), I.map(|x| 0.2 * x));
    let model = Description::new("egg").link("egg", inertia).floating().build().expect("sound");
    let frequency = (G * (a * a / c - c) / (0.2 * (a * a + c * c) + c * c)).sqrt();
    let tilt: f64 = 1e-3;
    let turn = mozzi::SO3::exp(Vec3([0.0, tilt, 0.0]));
    let height = ((a * tilt.sin()).powi(2) + (c * tilt.cos()).powi(2)).sqrt();
    let theta = SE3::new(turn, Vec3([0.0, 0.0, height])).to_pose();
    let support = Support::Ellipsoid { axes: mozzi::SO3::identity(), radii: [a, b, c] };
    let contacts = Contacts { points: vec![contact(&model, "egg", support, 1.0, 0.0)], planes: vec![Plane::ground()] };
    let gaps = contacts.gaps(&model, 0.0, &theta);
    assert!(gaps[0].abs() < 1e-15, "{gaps:?}");
    let quarter = 0.5 * std::f64::consts::PI / frequency;
    let simulation = Simulation { contacts, ..Simulation::new(by(Method::Automatic, quarter, quarter / 500.0)) };
    let run = simulation.run(&model, &theta, &[0.0; 6], Zero).expect("a motion");
    let last = run.motion.last();
    let (rate, expected) = (-last.dtheta[1], tilt * frequency);
    println!("ellipsoid: rate {rate:.9}, of small motions {expected:.9} rad/s; tilt {:.1e}", last.theta[2]);
    assert!((rate / expected - 1.0).abs() < 1e-4 && (2.0 * last.theta[2]).abs() < 1e-4 * tilt);
}

#[test]
fn planes_move() {
    let model = ball();
    // a lift that accelerates carries the ball
    let lift = PlaneMotion::Moving(Box::new(|t: f64| {
        (SE3::translation([0.0, 0.0, 0.5 * t * t]), Twist { w: Vec3::zero(), v: Vec3([0.0, 0.0, t]) })
    }));
    let plane = Plane { name: "lift".into(), motion: lift };
    let start = [[0.0, 0.0, RADIUS], [0.0; 3], [0.0; 3]];
    let run = rolling(&model, plane, 0.5, 0.0, start, by(Method::Automatic, 1.0, 1e-3));
    let last = run.motion.last();
    let weight = -last.total_contact_force().0[2];
    println!(
        "lift: height error {:.1e} m, speed error {:.1e} m/s, force error {:.1e} N, work {:.6} J",
        last.theta[6] - RADIUS - 0.5,
        last.dtheta[5] - 1.0,
        weight - 0.5 * (G + 1.0),
        last.energy.applied_work
    );
    assert!((last.theta[6] - RADIUS - 0.5).abs() < 1e-9 && (weight - 0.5 * (G + 1.0)).abs() < 1e-6);
    // −½ v² m − m g z
    assert!((last.energy.applied_work + 0.25 + 0.5 * G * 0.5).abs() < 1e-4 && run.motion.largest_drift() < 1e-4);

    // a belt at 1 m/s below a box that does not roll: it slides until it moves along
    let model =
        Description::new("box").link("ball", Solid::Box([0.2; 3]).inertia(0.5)).floating().build().expect("sound");
    let frame = model.frame("ball").expect("there");
    let points = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]];
    let points = points.map(|[x, y]| ContactPoint::new("corner", frame, Vec3([0.1 * x, 0.1 * y, -0.1]), 0.3));
    let belt = Plane { name: "belt".into(), motion: PlaneMotion::Belt(SE3::identity(), Vec3([1.0, 0.0, 0.0])) };
    let contacts = Contacts { points: points.to_vec(), planes: vec![belt] };
    let simulation = Simulation { contacts, ..Simulation::new(by(Method::Automatic, 2.0, 1e-3)) };
    let run = simulation.run(&model, &[1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.1], &[0.0; 6], Zero).expect("a motion");
    let last = run.motion.last();
    let slips = 1.0 / (0.3 * G);
    println!(
        "belt: way error {:.1e} m, speed error {:.1e} m/s",
        last.theta[4] - (2.0 - 0.5 * slips),
        last.dtheta[3] - 1.0
    );
    assert!((last.theta[4] - (2.0 - 0.5 * slips)).abs() < 1e-6 && (last.dtheta[3] - 1.0).abs() < 1e-9);
}
