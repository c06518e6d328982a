//! The identified robot in the words of simulators: `--write`.

use crate::text::{Page, table};
use clap::ValueEnum;
use mozzi::Description;
use mozzi::model::description::{Joint, JointKind};
use mozzi::spatial::Rounded;
use mozzi_identify::{Identification, Servo};
use mozzi_report::escaped;

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Simulator {
    /// MuJoCo's XML: attributes of joints, and actuators
    Mjcf,
    /// mjlab's actuators, Python
    Mjlab,
    /// Isaac Lab's actuators, Python
    Isaac,
    /// URDF's <dynamics>
    Urdf,
}

/// One joint with its motor.
struct Motor<'r> {
    joint: &'r Joint,
    servo: Option<&'r Servo>,
}

impl Motor<'_> {
    fn is_linear(&self) -> bool {
        matches!(self.joint.kind, JointKind::Screw(A) if A.is_prismatic())
    }

    /// The effort limit, if there is one.
    fn effort(&self) -> Option<f64> {
        self.joint.limits.effort.filter(|effort| effort.is_finite() && *effort > 0.0)
    }
}

/// The text to paste, and the place of each parameter.
pub fn page(to: Simulator, found: &Identification<'_>, robot: &Description, servos: &[Servo]) -> String {
    let names: Vec<&str> = found.setup.columns.model.joint_names().collect();
    let motors: Vec<Motor> = robot
        .joints
        .iter()
        .filter(|joint| names.contains(&joint.name.as_str()))
        .map(|joint| Motor { joint, servo: servos.iter().find(|servo| servo.joint == joint.name) })
        .collect();
    let (what, lines) = match to {
        Simulator::Mjcf => ("MJCF", mjcf(&motors)),
        Simulator::Mjlab => ("mjlab", mjlab(&motors)),
        Simulator::Isaac => ("Isaac Lab", isaac(&motors)),
        Simulator::Urdf => ("URDF", urdf(&motors)),
    };
    let mut page = Page::default();
    page.title(&format!("{what}: to paste"));
    lines.iter().for_each(|line| {
        page.verbatim(line);
    });
    let has_gains = motors.iter().any(|motor| motor.servo.is_some());
    let head = ["parameter", "where it went"].map(str::to_string).to_vec();
    let places = places(to, has_gains).into_iter().map(|(a, b)| vec![a.to_string(), b.to_string()]);
    let rows: Vec<Vec<String>> = std::iter::once(head).chain(places).collect();
    page.title("parameter → where it went").lines(&table(&rows, "ll"));
    page.end()
}

/// A physics step, s, that is short enough for all.
const STEP: f64 = 0.001;

/// Attributes that are not 0.
fn attributes(list: &[(&str, f64)]) -> String {
    list.iter().filter(|(_, x)| *x != 0.0).map(|(name, x)| format!(" {name}=\"{}\"", Rounded(*x))).collect()
}

fn mjcf(motors: &[Motor]) -> Vec<String> {
    let mut all =
        vec!["<!-- attributes of the joints; --out NAME.xml writes them, and <inertial>, into an MJCF -->".into()];
    for Motor { joint, .. } in motors {
        let own = [
            ("armature", joint.armature),
            ("damping", joint.damping),
            ("frictionloss", joint.friction),
            ("stiffness", joint.stiffness),
        ];
        all.push(format!("<joint name=\"{}\"{}/>", escaped(&joint.name), attributes(&own)));
    }
    if motors.iter().any(|motor| motor.servo.is_some()) {
        all.push("<actuator>".into());
        for motor in motors {
            let Some(servo) = motor.servo else { continue };
            let name = escaped(&motor.joint.name);
            let gains = attributes(&[("kp", servo.stiffness[0]), ("kv", servo.damping[0])]);
            let range = motor.effort().map_or(String::new(), |f| format!(" forcerange=\"-{0} {0}\"", Rounded(f)));
            let late = [("delay", servo.delay), ("nsample", (servo.delay / STEP).ceil() + 2.0)];
            let late = if servo.delay > 1e-5 { attributes(&late) } else { String::new() };
            all.push(format!("  <position name=\"{name}\" joint=\"{name}\"{gains}{range}{late}/>"));
        }
        all.push("</actuator>".into());
    }
    if delay(motors).is_some() {
        all.push(format!("<!-- delay and nsample are of recent MuJoCo (4.0 has them); nsample suffices for timestep={STEP} or longer -->"));
    }
    all
}

fn urdf(motors: &[Motor]) -> Vec<String> {
    let one = |motor: &Motor| {
        let Joint { name, damping, friction, .. } = motor.joint;
        let own = [("damping", *damping), ("friction", *friction)];
        format!("<joint name=\"{}\" …> <dynamics{}/> </joint>", escaped(name), attributes(&own))
    };
    motors.iter().map(one).collect()
}

/// The delay of all joints.
fn delay(motors: &[Motor]) -> Option<f64> {
    motors.iter().find_map(|motor| motor.servo).map(|servo| servo.delay)
}

/// A name as Python's regular expression.
fn expression(name: &str) -> String {
    let mut text = String::from("r\"");
    for c in name.chars() {
        if !c.is_alphanumeric() && !matches!(c, '_' | '-' | '/') {
            text.push('\\');
        }
        text.push(c);
    }
    text + "\""
}

fn mjlab(motors: &[Motor]) -> Vec<String> {
    let kind = |motor: &Motor| if motor.servo.is_some() { "Position" } else { "Motor" };
    let mut kinds: Vec<String> = motors.iter().map(|motor| format!("Builtin{}ActuatorCfg", kind(motor))).collect();
    kinds.sort_unstable();
    kinds.dedup();
    let mut all = vec![format!("from mjlab.actuator import {}", kinds.join(", "))];
    if let Some(delay) = delay(motors) {
        all.push(format!("lag = round({} / 0.005)  # the delay over the physics step, s", Rounded(delay)));
    }
    all.push("actuators = (".into());
    for motor in motors {
        let joint = motor.joint;
        let mut values = vec![format!("target_names_expr=({},)", expression(&joint.name))];
        let mut add = |name: &str, x: f64| values.push(format!("{name}={}", Rounded(x)));
        if let Some(servo) = motor.servo {
            add("stiffness", servo.stiffness[0]);
            add("damping", servo.damping[0]);
        }
        motor.effort().into_iter().for_each(|effort| add("effort_limit", effort));
        add("armature", joint.armature);
        add("frictionloss", joint.friction);
        if motor.servo.is_some() {
            values.push("delay_min_lag=lag, delay_max_lag=lag".into());
        }
        all.push(format!("    Builtin{}ActuatorCfg({}),", kind(motor), values.join(", ")));
    }
    all.push(")".into());
    all
}

fn isaac(motors: &[Motor]) -> Vec<String> {
    let has_gains = motors.iter().any(|motor| motor.servo.is_some());
    let class = if has_gains { "DelayedPDActuatorCfg" } else { "ImplicitActuatorCfg" };
    let mut all = vec![format!("from isaaclab.actuators import {class}")];
    if let Some(delay) = delay(motors) {
        all.push(format!("lag = round({} / 0.005)  # the delay over the physics step, s", Rounded(delay)));
    }
    let dictionary = |name: &str, of: &dyn Fn(&Motor) -> Option<f64>| {
        let entries: Vec<String> = motors
            .iter()
            .filter_map(|motor| Some(format!("{}: {}", expression(&motor.joint.name), Rounded(of(motor)?))))
            .collect();
        (!entries.is_empty()).then(|| format!("    {name}={{{}}},", entries.join(", ")))
    };
    let names: Vec<String> = motors.iter().map(|motor| expression(&motor.joint.name)).collect();
    all.push(format!("actuators = {{\"identified\": {class}("));
    all.push(format!("    joint_names_expr=[{}],", names.join(", ")));
    let gain = |servo: Option<&Servo>, of: fn(&Servo) -> f64| Some(servo.map_or(0.0, of));
    type Value<'v> = &'v dyn Fn(&Motor) -> Option<f64>;
    let rows: [(&str, Value); 7] = [
        ("stiffness", &|motor| gain(motor.servo, |servo| servo.stiffness[0])),
        ("damping", &|motor| gain(motor.servo, |servo| servo.damping[0])),
        ("effort_limit", &|motor| motor.effort()),
        ("armature", &|motor| Some(motor.joint.armature)),
        ("friction", &|motor| Some(motor.joint.friction)),
        ("dynamic_friction", &|motor| Some(motor.joint.friction)),
        ("viscous_friction", &|motor| Some(motor.joint.damping)),
    ];
    all.extend(rows.iter().filter_map(|(name, of)| dictionary(name, of)));
    if has_gains {
        all.push("    min_delay=lag, max_delay=lag,".into());
    }
    all.push(")}".into());
    if motors.iter().any(Motor::is_linear) {
        all.push("# prismatic joints: N/m, N s/m, kg, N".into());
    }
    all
}

/// Each parameter's place.
fn places(to: Simulator, has_gains: bool) -> Vec<(&'static str, &'static str)> {
    let gains = |kp, kd, delay| match has_gains {
        true => [("kp", kp), ("kd", kd), ("delay", delay)],
        false => [("kp", NO_TARGETS), ("kd", NO_TARGETS), ("delay", NO_TARGETS)],
    };
    const NO_TARGETS: &str = "not estimated: no targets logged";
    let (own, gains) = match to {
        Simulator::Mjcf => (
            [
                ("mass, centre of mass, moments", "<inertial> of --out NAME.xml"),
                ("rotor inertia", "joint armature"),
                ("viscous friction", "joint damping"),
                ("Coulomb friction", "joint frictionloss"),
            ],
            gains("position kp", "position kv", "position delay, with nsample (recent MuJoCo)"),
        ),
        Simulator::Mjlab => (
            [
                ("mass, centre of mass, moments", "<inertial> of the MJCF that spec_fn loads"),
                ("rotor inertia", "actuator armature"),
                ("viscous friction", "joint damping of the MJCF (--write mjcf)"),
                ("Coulomb friction", "actuator frictionloss"),
            ],
            gains("actuator stiffness", "actuator damping", "delay_min_lag, delay_max_lag, physics steps"),
        ),
        Simulator::Isaac => (
            [
                ("mass, centre of mass, moments", "<inertial> of --out NAME.urdf, which the importer reads"),
                ("rotor inertia", "actuator armature"),
                ("viscous friction", "actuator viscous_friction (Isaac Sim 5)"),
                ("Coulomb friction", "actuator friction and dynamic_friction (Isaac Sim 5: efforts)"),
            ],
            gains("actuator stiffness", "actuator damping", "min_delay, max_delay, physics steps"),
        ),
        Simulator::Urdf => (
            [
                ("mass, centre of mass, moments", "<inertial> of --out NAME.urdf"),
                ("rotor inertia", "none in URDF: --write mjcf, mjlab or isaac"),
                ("viscous friction", "<dynamics damping>"),
                ("Coulomb friction", "<dynamics friction>"),
            ],
            gains("none in URDF", "none in URDF", "none in URDF"),
        ),
    };
    let rest = [
        ("offset of a force", "none: a sensor's or a cable's"),
        ("apparent inertia and damping", "none: no robot has them; predictions do"),
    ];
    own.into_iter().chain(gains).chain(rest).collect()
}
