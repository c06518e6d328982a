//! A box on an incline, with 4 and with 8 contact points.

use super::robots::by;
use mozzi::{Description, Model, SE3, SO3, Solid, Vec3, Wrench};
use mozzi_sim::{ContactPoint, Contacts, Method, Plane, Run, Simulation, Zero, applied};

const SIZE: [f64; 3] = [0.3, 0.2, 0.1];
const G: f64 = 9.81;

/// A box of 4 kg that floats.
fn free_box() -> Model {
    Description::new("box").link("box", Solid::Box(SIZE).inertia(4.0)).floating().build().expect("sound")
}

/// The corners of its lower face, and the middles of the edges.
fn contacts(model: &Model, points: usize, mu: f64, angle: f64) -> Contacts<'static> {
    let [x, y, z] = SIZE.map(|x| 0.5 * x);
    let corners = [[x, y], [x, -y], [-x, y], [-x, -y], [x, 0.0], [-x, 0.0], [0.0, y], [0.0, -y]];
    let frame = model.frame("box").expect("there");
    let points = corners.iter().take(points).enumerate();
    Contacts {
        points: points.map(|(k, &[x, y])| ContactPoint::new(format!("p{k}"), frame, Vec3([x, y, -z]), mu)).collect(),
        planes: vec![Plane::fixed("slope", slope(angle))],
    }
}

/// z = 0 turned about y: x points down the slope.
fn slope(angle: f64) -> SE3 {
    SE3::new(SO3::exp(Vec3([0.0, angle, 0.0])), Vec3([0.2, -0.1, 0.4]))
}

/// A motion on the slope from a velocity along it; returns the path and the velocity along the slope at the end.
pub fn on_slope(
    points: usize,
    angle: f64,
    v: [f64; 2],
    method: Method,
    [duration, step]: [f64; 2],
) -> (Run, [f64; 2], f64) {
    let model = free_box();
    let T = slope(angle);
    let start = T * SE3::translation([0.0, 0.0, 0.5 * SIZE[2]]);
    let theta = start.to_pose();
    let simulation =
        Simulation { contacts: contacts(&model, points, 0.5, angle), ..Simulation::new(by(method, duration, step)) };
    let run = simulation.run(&model, &theta, &[0.0, 0.0, 0.0, v[0], v[1], 0.0], Zero).expect("a motion");
    let end = SE3::from_pose(std::array::from_fn(|k| run.motion.last().theta[k]));
    let way = start.inverse() * end;
    let gaps = contacts(&model, points, 0.5, angle).gaps(&model, duration, run.motion.last().theta);
    let gap = gaps.iter().fold(0.0_f64, |most, gap| most.max(gap.abs()));
    (run, [way.p.0[0], way.p.0[1]], gap)
}

#[test]
fn a_box_sticks() {
    for points in [4, 8] {
        {
            let method = Method::MoreauJean;
            let (run, way, gap) = on_slope(points, 20_f64.to_radians(), [0.0, 0.0], method, [1.0, 1e-3]);
            let moved = way[0].hypot(way[1]);
            let account = run.one_sided.expect("contacts");
            println!("{points} points, {:20}: moved {moved:.1e} m, gap {gap:.1e} m, {account:?}", method.name());
            assert!(moved <= 1e-12 && gap < 1e-12 && account.largest_residual < 1e-9);
            let force = run.motion.last().total_contact_force();
            assert!((force - Vec3([0.0, 0.0, -4.0 * G])).norm() < 1e-9 * 4.0 * G, "{force:?}");
        }
    }
}

#[test]
fn a_box_slides_straight() {
    let angle = 35_f64.to_radians();
    let a = G * (angle.sin() - 0.5 * angle.cos());
    for points in [4, 8] {
        {
            let (method, bound) = (Method::MoreauJean, 1e-12);
            let (run, way, gap) = on_slope(points, angle, [0.0, 0.0], method, [1.0, 1e-3]);
            let error = (way[0] - 0.5 * a).hypot(way[1]);
            let account = run.one_sided.expect("contacts");
            let energy = run.motion.last().energy;
            let lost = 0.5 * 4.0 * G * angle.cos() * 0.5 * a;
            println!(
                "{points} points, {:20}: error {error:.1e} of {:.3} m, gap {gap:.1e}, loss error {:.1e} J, drift {:.1e} J, {account:?}",
                method.name(),
                0.5 * a,
                energy.friction_loss - lost,
                run.motion.largest_drift()
            );
            assert!(error < bound && gap < 1e-12);
        }
    }
}

#[test]
fn a_sliding_box_is_not_thrown_upwards() {
    // a convexified cone lifts it at μ times its speed in the first step
    let (run, _, gap) = on_slope(4, 35_f64.to_radians(), [1.0, 0.0], Method::MoreauJean, [1e-3, 1e-3]);
    let lift = run.motion.last().dtheta[5];
    println!("normal velocity after the first step {lift:.1e} m/s, gap {gap:.1e} m");
    assert!(lift.abs() < 1e-12);
}

/// x, y where a point with Coulomb friction comes to rest on the slope: by Runge-Kutta of order 4 over the angle of the
/// velocity (the speed as a function of the direction is known), to 1e-13.
fn rest(angle: f64, v: [f64; 2], mu: f64) -> [f64; 2] {
    let f = |y: [f64; 4]| {
        let n = y[2].hypot(y[3]).max(1e-300);
        let friction = mu * G * angle.cos() / n;
        [y[2], y[3], G * angle.sin() - friction * y[2], -friction * y[3]]
    };
    // steps that shrink with the speed, which falls to 0 linearly
    let mut y = [0.0, 0.0, v[0], v[1]];
    while y[2].hypot(y[3]) > 1e-9 {
        let h = 2e-4 * y[2].hypot(y[3]);
        let at = |k: [f64; 4], s: f64| std::array::from_fn(|i| y[i] + s * k[i]);
        let k1 = f(y);
        let k2 = f(at(k1, 0.5 * h));
        let k3 = f(at(k2, 0.5 * h));
        let k4 = f(at(k3, h));
        y = std::array::from_fn(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
    }
    [y[0], y[1]]
}

#[test]
fn a_box_thrown_across_the_slope_rests_where_it_should() {
    let angle = 15_f64.to_radians();
    let expected = rest(angle, [-1.0, 1.5], 0.5);
    for points in [4, 8] {
        for (step, bound) in [(2e-3, 1e-6), (1e-3, 2e-7), (5e-4, 5e-8)] {
            let (run, way, gap) = on_slope(points, angle, [-1.0, 1.5], Method::MoreauJean, [1.2, step]);
            let error = (way[0] - expected[0]).hypot(way[1] - expected[1]);
            let account = run.one_sided.expect("contacts");
            println!("{points} points, {step:e} s: rest at {way:?}, error {error:.1e} m, gap {gap:.1e} m, {account:?}");
            assert!(error < bound && gap < 1e-12);
        }
    }
}

/// A box on the ground that turns and slides, or is thrown.
fn thrown(seed: u64, is_thrown: bool, mu: f64) -> (Run, f64) {
    let model = free_box();
    let mut random = mozzi::random::Random(seed);
    let (mut theta, [w, v]) =
        (SE3::translation([0.0, 0.0, 0.5 * SIZE[2]]).to_pose(), [random.array::<3>(), random.array::<3>()]);
    let mut dtheta = [0.0, 0.0, 3.0 * w[2], v[0], v[1], 0.0];
    if is_thrown {
        let R = SO3::exp(Vec3(random.array::<3>()) * 3.0);
        theta = SE3::new(R, Vec3([0.0, 0.0, 0.3])).to_pose();
        dtheta = [4.0 * w[0], 4.0 * w[1], 4.0 * w[2], v[0], v[1], v[2]];
    }
    let z = 0.5 * SIZE[2];
    let frame = model.frame("box").expect("there");
    let corners =
        [-1.0, 1.0].into_iter().flat_map(|a| [-1.0, 1.0].into_iter().flat_map(move |b| [[a, b, -1.0], [a, b, 1.0]]));
    let point = |(k, [a, b, c]): (usize, [f64; 3])| {
        ContactPoint::new(format!("p{k}"), frame, Vec3([0.5 * SIZE[0] * a, 0.5 * SIZE[1] * b, z * c]), mu)
    };
    let contacts = Contacts { points: corners.enumerate().map(point).collect(), planes: vec![Plane::ground()] };
    let simulation =
        Simulation { contacts, ..Simulation::new(by(Method::Automatic, if is_thrown { 3.0 } else { 2.0 }, 1e-3)) };
    let run = simulation.run(&model, &theta, &dtheta, Zero).expect("a motion");
    let last = run.motion.last();
    let force = last.total_contact_force();
    let error = (force - Vec3([0.0, 0.0, -4.0 * G])).norm() / (4.0 * G);
    (run, error)
}

#[test]
fn boxes_come_to_rest() {
    for (is_thrown, seed) in [false, true].into_iter().flat_map(|thrown| (0..20).map(move |seed| (thrown, seed))) {
        let (run, error) = thrown(seed, is_thrown, 0.5);
        let speed = run.motion.last().dtheta.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let late = run.contact_events.iter().filter(|event| event.t > run.motion.last().t - 1.0).count();
        let size = run.motion.largest_kinetic_energy();
        let account = run.one_sided.expect("contacts");
        println!(
            "thrown {is_thrown} {seed}: speed {speed:.1e}, force {error:.1e}, {late} of {} events late, drift {:.1e} of {size:.2} J, \
             lifted {:.1e}, {account:?}",
            run.contact_events.len(),
            run.motion.largest_drift() / size,
            account.lifted / size,
        );
        assert!(speed <= 1e-9 && error < 1e-6 && late == 0, "{speed} {error} {late}");
    }
}

#[test]
fn friction_of_any_size_is_solved() {
    for (mu, seed) in [1e3, 1e4, 1e6].into_iter().flat_map(|mu| (0..4).map(move |seed| (mu, seed))) {
        let (run, error) = thrown(seed, true, mu);
        let account = run.one_sided.expect("contacts");
        let lowest = run.motion.samples().map(|row| row.theta[6]).fold(f64::INFINITY, f64::min);
        println!("μ {mu:e} {seed}: force {error:.1e}, lowest {lowest:.4} m, {account:?}");
        // next to a jam an impulse of p_n = 1e-7 N s decides
        assert!(account.unsolved <= if mu > 1e3 { 30 } else { 0 }, "{mu} {seed}: {account:?}");
        assert!(lowest > 0.49 * SIZE[2] && error < 1e-6, "{mu} {seed}: {lowest} {error}");
    }
}

/// A plate on 20 feet, of which eight act: always the same ones.
#[test]
fn a_body_at_rest_stays_on_its_points() {
    let model = free_box();
    let frame = model.frame("box").expect("there");
    let foot = |k: usize| Vec3([0.03 * ((k % 5) as f64 - 2.0), 0.04 * ((k / 5) as f64 - 1.5), -0.5 * SIZE[2]]);
    let points = (0..20).map(|k| ContactPoint::new(format!("p{k}"), frame, foot(k), 0.5)).collect();
    let contacts = Contacts { points, planes: vec![Plane::ground()] };
    let simulation = Simulation { contacts, ..Simulation::new(by(Method::MoreauJean, 1.0, 1e-3)) };
    let start = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.5 * SIZE[2]];
    let run = simulation.run(&model, &start, &[0.0; 6], Zero).expect("a motion");
    let forces = |k: usize| run.motion.sample(k).contact_forces;
    let apart = |k: usize| (0..8).map(|c| (forces(k)[c].f - forces(k - 1)[c].f).norm()).fold(0.0, f64::max);
    let change = (10..run.motion.len()).map(apart).fold(0.0, f64::max);
    println!("{} events, forces change by at most {change:.1e} N in a step", run.contact_events.len());
    assert!(run.contact_events.len() == 8 && change < 1e-3 && (10..run.motion.len()).all(|k| forces(k).len() == 8));
}

/// A box that is lifted from where it stuck, carried and let go stays where it lands: its points have forgotten where
/// they were.
#[test]
fn a_box_that_is_carried_away_stays_where_it_is_put() {
    let model = free_box();
    let contacts = Contacts { planes: vec![Plane::ground()], ..contacts(&model, 4, 0.8, 0.0) };
    let frame = model.frame("box").expect("there");
    let weight = 4.0 * G;
    // at rest for 0.1 s; up, down and at rest within 0.4 s, and along y likewise
    let crane = applied(frame, move |t, _, _| {
        let [along, up] = match t {
            t if t < 0.1 => [0.0, 0.0],
            t if t < 0.3 => [8.0, weight + 8.0],
            t if t < 0.5 => [-8.0, weight - 8.0],
            _ => [0.0, 0.0],
        };
        Wrench { m: Vec3::zero(), f: Vec3([0.0, -along, -up]) } // what the box applies
    });
    let simulation = Simulation { contacts, ..Simulation::new(by(Method::MoreauJean, 1.5, 1e-3)) };
    let start = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.5 * SIZE[2]];
    let run = simulation.run(&model, &start, &[0.0; 6], crane).expect("a motion");
    let last = run.motion.last();
    let way = 8.0 / 4.0 * 0.2 * 0.2; // ½ a t² twice
    println!("carried by {:.6} m, expected {way}, now {:.1e} m high", last.theta[5], last.theta[6] - 0.5 * SIZE[2]);
    assert!((last.theta[5] - way).abs() < 1e-3 && last.theta[4].abs() < 1e-9, "{:?}", last.theta);
    assert!((last.theta[6] - 0.5 * SIZE[2]).abs() < 1e-9 && last.dtheta.iter().all(|x| x.abs() < 1e-9));
}
