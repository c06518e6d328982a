//! A random case from a seed.

use crate::campaign::case::{Case, Motion};
use crate::campaign::parts;
use mozzi::model::description::{Anchor, Closure, Constraint, Gear, Joint, JointKind, Mimic, Rotor};
use mozzi::random::Random;
use mozzi::{Base, Description, SE3, TaskFrame, Twist, Vec3};
use std::f64::consts::FRAC_PI_2;

/// Largest number of joints.
const MOST_JOINTS: usize = 12;

/// True with probability 1/n.
pub(crate) fn one_in(n: usize, random: &mut Random) -> bool {
    random.below(n) == 0
}

/// The case of this seed. Most robots are small: the number of joints is the smaller of two between 0 and 12.
pub fn case(seed: u64) -> Case {
    let mut random = Random(Random(seed).bits());
    let robot = robot(&mut random);
    let mut motions = std::collections::BTreeMap::new();
    let [is_at_zero, is_at_rest, is_square] = [10, 10, 16].map(|n| one_in(n, &mut random));
    let size = if one_in(12, &mut random) { 300.0 } else { 3.0 };
    for name in std::iter::once("").chain(robot.joints.iter().map(|joint| joint.name.as_str())) {
        let angle = f64::from((size * random.next()) as f32); // f32 has the same angle
        let quarter = FRAC_PI_2 * (random.below(9) as f64 - 4.0);
        let pose = SE3::exp(Twist::from_array(random.array()) * 2.0).to_pose();
        let speeds = if is_at_rest { [0.0, 5.0, 2.0] } else { [2.0, 5.0, 2.0] };
        let rates = speeds.map(|speed| random.array::<6>().map(|x| speed * x));
        let angle = if is_square { f64::from(quarter as f32) } else { angle };
        let motion = match is_at_zero {
            true => Motion { angle: 0.0, pose: SE3::identity().to_pose(), rates },
            false => Motion { angle, pose, rates },
        };
        motions.insert(name.to_string(), motion);
    }
    let frames: Vec<String> = names(&robot);
    let is_alone = one_in(2, &mut random);
    let mut six = |size: f64| random.array::<6>().map(|x| if is_alone { 0.0 } else { size * x });
    let (base_twist, base_acceleration) = (six(1.0), six(1.0));
    let mut applied = Vec::new();
    if !is_alone {
        for _ in 0..random.below(3) {
            let name = frames[random.below(frames.len())].clone();
            if applied.iter().all(|(other, _)| *other != name) {
                applied.push((name, random.array::<6>().map(|x| 3.0 * x)));
            }
        }
    }
    let first = random.below(6);
    let rows = (0..6).filter(|&row| row == first || one_in(4, &mut random)).collect();
    Case {
        frame: frames[random.below(frames.len())].clone(),
        coordinates: if one_in(2, &mut random) { TaskFrame::Body } else { TaskFrame::Space },
        rows,
        point: Vec3(random.array()),
        gravity: (!is_alone).then(|| random.array::<3>().map(|x| 9.0 * x)),
        base_twist,
        base_acceleration,
        applied,
        w: random.array(),
        motions,
        robot,
    }
}

/// Links and further frames.
fn names(robot: &Description) -> Vec<String> {
    let links = robot.links.iter().map(|link| link.name.clone());
    links.chain(robot.frames.iter().map(|frame| frame.name.clone())).collect()
}

fn robot(random: &mut Random) -> Description {
    let count = random.below(MOST_JOINTS + 1).min(random.below(MOST_JOINTS + 1));
    let decades = if one_in(6, random) { 4.0 } else { 1.0 };
    let is_aligned = one_in(3, random);
    let is_chain = one_in(2, random);
    let mut robot = Description::new("r").link("l0", parts::inertia(random, decades, is_aligned));
    if one_in(3, random) {
        robot.base = Base::Floating;
    }
    for i in 1..=count {
        let parent = if is_chain { i - 1 } else { random.below(i) };
        let (kind, origin) = (parts::kind(random, is_aligned), parts::pose(random, is_aligned));
        let mut joint = Joint::new(format!("j{i}"), format!("l{parent}"), format!("l{i}"), origin, kind);
        add_forces(&mut joint, random);
        let sources: Vec<&Joint> =
            robot.joints.iter().filter(|joint| matches!(joint.kind, JointKind::Screw(_))).collect();
        if matches!(joint.kind, JointKind::Screw(_)) && !sources.is_empty() && one_in(6, random) {
            let source = sources[random.below(sources.len())].name.clone();
            let ratio = if one_in(8, random) { 0.0 } else { 1.5 * random.next() };
            joint.mimic = Some(Mimic { joint: source, ratio, offset: random.next() });
        }
        let inertia = if one_in(16, random) {
            mozzi::SpatialInertia::zero()
        } else {
            parts::inertia(random, decades, is_aligned)
        };
        robot = robot.link(format!("l{i}"), inertia).joint(joint);
    }
    robot = robot.frame("f", format!("l{}", random.below(count + 1)), parts::pose(random, false));
    robot.gravity = if one_in(2, random) { [0.0, 0.0, -9.81] } else { random.array::<3>().map(|x| 9.0 * x) };
    if one_in(4, random) {
        add_rotor(&mut robot, random);
    }
    if one_in(4, random) {
        for k in 0..=random.below(3) {
            add_constraint(&mut robot, k, random);
        }
    }
    robot
}

fn add_forces(joint: &mut Joint, random: &mut Random) {
    if joint.kind == JointKind::Fixed {
        return;
    }
    let positive = |random: &mut Random| 0.6 + 0.5 * random.next();
    if one_in(3, random) {
        joint.damping = positive(random);
    }
    if one_in(3, random) {
        joint.friction = positive(random);
    }
    if one_in(3, random) {
        joint.armature = positive(random) * 0.3;
    }
    if one_in(3, random) && joint.kind != JointKind::Free {
        joint.stiffness = 5.0 * positive(random);
        if matches!(joint.kind, JointKind::Screw(_)) {
            joint.spring_reference = random.next();
        }
    }
}

/// The joints of one axis.
fn of_one_axis(robot: &Description) -> Vec<String> {
    let joints = robot.joints.iter().filter(|joint| matches!(joint.kind, JointKind::Screw(_)));
    joints.map(|joint| joint.name.clone()).collect()
}

fn add_rotor(robot: &mut Description, random: &mut Random) {
    let mut gears = Vec::new();
    for joint in of_one_axis(robot) {
        if gears.len() < 3 && one_in(2, random) {
            gears.push(Gear { joint, ratio: 2.0 * random.next() });
        }
    }
    if !gears.is_empty() {
        robot.rotors.push(Rotor { name: "rotor".into(), armature: 0.5 + 0.4 * random.next(), gears });
    }
}

/// Adds a closure between random anchors or a polynomial of two joints, unless the robot is refused with it: anchors on
/// one body, for instance. It need not be satisfied at the state.
fn add_constraint(robot: &mut Description, k: usize, random: &mut Random) {
    let (frames, joints, name) = (names(robot), of_one_axis(robot), format!("c{k}"));
    let length = 0.6 + 0.5 * random.next();
    let anchor = |random: &mut Random| {
        let T = parts::pose(random, false);
        let world = robot.base == Base::Floating && one_in(3, random);
        if world { Anchor::world(T) } else { Anchor::frame(&frames[random.below(frames.len())]).at(T) }
    };
    let (a, b) = (anchor(random), anchor(random));
    let closure = [Closure::Point, Closure::Weld, Closure::Hinge, Closure::Distance(length), Closure::Rolling(length)]
        [random.below(5)];
    let polynomial = random.array::<5>().map(|x| 0.5 * x);
    let constraint = match (joints.len(), one_in(4, random)) {
        (2.., true) => {
            let i = random.below(joints.len() - 1);
            Constraint::joint(name, &joints[i], &joints[i + 1 + random.below(joints.len() - 1 - i)], polynomial)
        }
        _ => Constraint::new(name, a, b, closure),
    };
    let with = robot.clone().constraint(constraint);
    let is_sound = |model: &mozzi::Model| model.constraint_rows() <= model.n();
    if with.clone().build().is_ok_and(|model| is_sound(&model)) {
        *robot = with;
    }
}
