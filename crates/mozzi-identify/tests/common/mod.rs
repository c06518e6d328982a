//! Simulated logs, and the real ones.
#![allow(dead_code)] // each test uses some of it

use mozzi::Model;
use mozzi::random::Random;
use mozzi_identify::signals::{Acceleration, Cutoff, Filter, Shape};
use mozzi_identify::{Choice, Columns, Equations, Kind, Log, Sensor};

/// No filter.
pub const UNFILTERED: Filter = Filter {
    cutoff: Cutoff::None,
    order: 4,
    acceleration: Acceleration::Differences,
    friction: Shape { width: 0.05, stribeck: None },
};

/// An embedded robot.
pub fn robot(name: &str) -> Model {
    mozzi_urdf::open(name).expect("embedded").description.build().expect("sound")
}

/// Another robot: links by up to 30 % heavier or lighter, friction and offsets.
pub fn truth(columns: &Columns<'_>, seed: u64) -> Vec<f64> {
    let mut random = Random(seed);
    let mut x = columns.prior();
    for first in columns.bodies() {
        let factor = 1.0 + 0.3 * random.next();
        x[first..first + 10].iter_mut().for_each(|x| *x *= factor);
    }
    for (k, unknown) in columns.unknowns.iter().enumerate() {
        match unknown.kind {
            Kind::Offset(_) => x[k] = 0.5 * random.next(),
            Kind::Armature(_) => x[k] = 0.1 + 0.05 * random.next(),
            kind if kind.is_positive() => x[k] = 1.0 + 0.5 * random.next(),
            _ => {}
        }
    }
    x
}

/// A random number of the normal distribution, of deviation 1.
pub fn normal(random: &mut Random) -> f64 {
    let [u, v] = random.array::<2>().map(|x| 0.5 * (x + 1.0));
    (-2.0 * (1.0 - u).ln()).sqrt() * (core::f64::consts::TAU * v).cos()
}

/// A motion of each joint by five sines, at `rate` for `duration` seconds, with exact velocities and accelerations; no
/// forces.
pub fn motion(model: &Model, duration: f64, rate: f64, amplitude: f64, seed: u64) -> Log {
    let (n, mut random) = (model.n(), Random(seed));
    let N = (duration * rate) as usize;
    let sines: Vec<Vec<[f64; 3]>> = (0..n)
        .map(|_| {
            let one =
                |k: usize| [amplitude * random.next() / (k + 1) as f64, 1.3 * (k + 1) as f64, 3.0 * random.next()];
            (0..5).map(one).collect()
        })
        .collect();
    let mut log = Log { name: "simulated".into(), ..Log::default() };
    let (mut dtheta, mut ddtheta) = (Vec::new(), Vec::new());
    for k in 0..N {
        let t = k as f64 / rate;
        log.t.push(t);
        for of in &sines {
            let sum = |f: fn(f64, f64) -> f64| of.iter().map(|[a, w, p]| a * f(*w, w * t + p)).sum::<f64>();
            log.theta.push(sum(|_, x| x.sin()));
            dtheta.push(sum(|w, x| w * x.cos()));
            ddtheta.push(sum(|w, x| -w * w * x.sin()));
        }
    }
    (log.dtheta, log.ddtheta) = (Some(dtheta), Some(ddtheta));
    log
}

/// Adds the forces of these unknowns, and noise of a deviation for each force.
pub fn with_forces(log: &Log, model: &Model, choice: &Choice, x: &[f64], noise: &[f64], random: &mut Random) -> Log {
    let columns = Columns::new(model, choice.clone()).expect("columns");
    let mut equations = Equations::new(&columns, &mozzi_identify::signals::Samples::default()).expect("equations");
    let (n, nq, P) = (model.n(), model.nq(), columns.count());
    let (mut A, mut b, zeros) = (vec![0.0; n * P], vec![0.0; n], vec![0.0; n]);
    let mut log = log.clone();
    log.tau.clear();
    for k in 0..log.rows() {
        let row = |table: &Option<Vec<f64>>| table.as_ref().expect("a table")[k * n..(k + 1) * n].to_vec();
        let (dtheta, ddtheta) = (row(&log.dtheta), row(&log.ddtheta));
        equations.at([&log.theta[k * nq..(k + 1) * nq], &dtheta, &ddtheta, &zeros], &mut A, &mut b);
        for j in 0..n {
            let force: f64 = (0..P).map(|c| A[j * P + c] * x[c]).sum();
            log.tau.push(force - b[j] + noise[j] * normal(random)); // b is minus the forces of what is not estimated
        }
    }
    log
}

/// A log without accelerations, whose rows of positions, velocities and forces are changed.
pub fn edited(log: &Log, n: usize, edit: impl Fn(&mut [f64], &mut [f64], &mut [f64])) -> Log {
    let mut log = log.clone();
    log.ddtheta = None;
    let mut dtheta = log.dtheta.take().expect("velocities");
    for k in 0..log.rows() {
        let row = k * n..(k + 1) * n;
        edit(&mut log.theta[row.clone()], &mut dtheta[row.clone()], &mut log.tau[row]);
    }
    log.dtheta = Some(dtheta);
    log
}

/// A UR5 whose masses differ from the file's by up to 20 %.
pub fn simulated() -> (Model, Log) {
    let model = mozzi_urdf::open("ur5").expect("embedded").description.build().expect("sound");
    let choice = Choice::all(Sensor::Link);
    let columns = Columns::new(&model, choice.clone()).expect("columns");
    let mut random = Random(4);
    let mut x = columns.prior();
    for first in columns.bodies() {
        let factor = 1.0 + 0.2 * random.next();
        x[first..first + 10].iter_mut().for_each(|x| *x *= factor);
    }
    for (k, unknown) in columns.unknowns.iter().enumerate().filter(|(_, u)| u.kind.is_positive()) {
        x[k] = 1.0 + unknown.prior;
    }
    let log = motion(&model, 20.0, 100.0, 1.0, 3);
    let log = with_forces(&log, &model, &choice, &x, &[0.3, 0.3, 0.2, 0.05, 0.05, 0.05], &mut random);
    (model, log)
}

/// The folder of real logs, and that of the robots.
pub fn real() -> Option<(String, String)> {
    let data = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data/identification");
    let Ok(robots) = std::env::var("MOZZI_ROBOTS") else {
        eprintln!("skipped: MOZZI_ROBOTS does not name the folder of example-robot-data");
        return None;
    };
    if !std::path::Path::new(data).exists() {
        eprintln!("skipped: no shared data");
        return None;
    }
    Some((data.to_string(), robots))
}

/// A robot, its log, and the cut-off.
pub struct Case {
    pub name: &'static str,
    pub model: Model,
    pub log: Log,
    pub cutoff: f64,
}

/// The Panda and the UR10, if they are at hand.
pub fn cases() -> Vec<Case> {
    let Some((data, robots)) = real() else { return Vec::new() };
    let model = |file: &str, locked: &[(&str, f64)]| {
        let loaded = mozzi_urdf::open_with(&format!("{robots}/{file}"), mozzi_urdf::Policy::Lenient).expect("a robot");
        let model = loaded.description.build().expect("sound");
        if locked.is_empty() { model } else { model.with_locked_joints(locked).expect("its joints") }
    };
    let panda = model("panda_description/urdf/panda.urdf", &[("panda_finger_joint1", 0.0)]);
    let ur10 = model("ur_description/urdf/ur10_robot.urdf", &[]);
    vec![
        Case { name: "Panda", log: log(&format!("{data}/panda.csv"), panda.n()), model: panda, cutoff: 4.0 },
        Case { name: "UR10", log: log(&format!("{data}/ur10.csv"), ur10.n()), model: ur10, cutoff: 10.0 },
    ]
}

/// Columns t, θ, θ̇, τ.
fn log(file: &str, n: usize) -> Log {
    let text = std::fs::read_to_string(file).expect("a file");
    let mut log = Log { name: file.rsplit('/').next().unwrap_or_default().into(), ..Log::default() };
    let mut dtheta = Vec::new();
    for line in text.lines().skip(1) {
        let row: Vec<f64> = line.split(',').map(|x| x.parse().expect("a number")).collect();
        log.t.push(row[0]);
        log.theta.extend(&row[1..=n]);
        dtheta.extend(&row[n + 1..=2 * n]);
        log.tau.extend(&row[2 * n + 1..=3 * n]);
    }
    log.dtheta = Some(dtheta);
    log
}

/// A floating humanoid of 30 joints: two legs of six, two arms of seven, a waist and a neck of two.
pub fn humanoid() -> Model {
    use mozzi::model::description::{Joint, JointKind};
    use mozzi::{Description, SE3, ScrewAxis, Solid};
    let mut robot = Description::new("humanoid").link("pelvis", Solid::Box([0.2, 0.3, 0.2]).inertia(10.0)).floating();
    let mut limb = |name: &str, from: &str, at: [f64; 3], axes: &[usize], length: f64, mass: f64| {
        let mut parent = from.to_string();
        for (k, &axis) in axes.iter().enumerate() {
            let child = format!("{name}{}", k + 1);
            let direction = core::array::from_fn(|i| if i == axis { 1.0 } else { 0.0 });
            let axis = ScrewAxis::new(direction, [0.0; 3]).expect("unit");
            let place = if k == 0 { at } else { [0.01, 0.0, length] };
            let body = Solid::Box([0.08, 0.1, length.abs().max(0.05)]).inertia(mass / (1 + k) as f64);
            let body = body.transformed(SE3::translation([0.01, 0.005, 0.5 * length]));
            let taken = std::mem::replace(&mut robot, Description::new(""));
            robot = taken.link(&child, body).joint(Joint::new(
                format!("{child}_joint"),
                &parent,
                &child,
                SE3::translation(place),
                JointKind::Screw(axis),
            ));
            parent = child;
        }
    };
    limb("waist", "pelvis", [0.0, 0.0, 0.1], &[2, 1], 0.15, 8.0);
    for (side, y) in [("left", 0.15), ("right", -0.15)] {
        limb(&format!("{side}_leg"), "pelvis", [0.0, y, -0.1], &[2, 0, 1, 1, 1, 0], -0.2, 6.0);
        limb(&format!("{side}_arm"), "waist2", [0.0, 1.5 * y, 0.25], &[1, 0, 1], -0.25, 3.0);
    }
    robot.build().expect("sound")
}

/// A motion of a floating robot with exact velocities and accelerations, whose base is turned by its twist.
pub fn floating_motion(model: &Model, duration: f64, rate: f64, seed: u64) -> Log {
    let (n, N, mut random) = (model.n(), (duration * rate) as usize, Random(seed));
    let sines: Vec<[f64; 3]> =
        (0..n).map(|_| [random.next(), 2.0 + 3.0 * random.next(), 3.0 * random.next()]).collect();
    let mut log = Log { name: "floating".into(), ..Log::default() };
    let (mut dtheta, mut ddtheta, mut theta) = (Vec::new(), Vec::new(), model.neutral_configuration::<f64>());
    for k in 0..N {
        let t = k as f64 / rate;
        let velocity: Vec<f64> = sines.iter().map(|[a, w, p]| a * w * (w * t + p).cos()).collect();
        log.t.push(t);
        log.theta.extend(&theta);
        ddtheta.extend(sines.iter().map(|[a, w, p]| -a * w * w * (w * t + p).sin()));
        let half: Vec<f64> = sines.iter().map(|[a, w, p]| a * w * (w * (t + 0.5 / rate) + p).cos()).collect();
        mozzi::model::integrate(model, &mut theta, &half, 1.0 / rate);
        dtheta.extend(velocity);
    }
    (log.dtheta, log.ddtheta) = (Some(dtheta), Some(ddtheta));
    log
}
