//! How a robot of the playground is simulated.

use super::entry::{number, numbers, text};
use super::motors::{Kind, gains};
use crate::robot::Robot;
use mozzi_motion::controllers::Gains;
use mozzi_sim::{ContactPoint, Energy, Policy};
use serde_json::{Value, json};

/// Motors, contacts and limits, and the account of the energies since the last reset.
#[derive(Debug)]
pub struct Settings {
    /// Points that can touch the ground.
    pub points: Vec<ContactPoint>,
    pub kind: Kind,
    pub gains: Gains,
    /// The motors' goal, nq numbers.
    pub target: Vec<f64>,
    /// The coefficients of friction and restitution of the ground z = 0, if there is one.
    pub ground: Option<[f64; 2]>,
    pub limits: Policy,
    /// Seconds, works in joules, and the energy that the method made.
    pub time: f64,
    pub works: Energy,
    pub drift: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            points: Vec::new(),
            kind: Kind::Off,
            gains: Gains::uniform(0, 0.0, 0.0),
            target: Vec::new(),
            ground: None,
            limits: Policy::Respect,
            time: 0.0,
            works: Energy::default(),
            drift: 0.0,
        }
    }
}

/// Takes the settings that a command names; the others stay. Returns the gains.
pub fn set(robot: &mut Robot, command: &Value) -> Result<Value, String> {
    let theta = robot.theta().to_vec();
    let has = |key: &str| !command[key].is_null();
    if has("target") {
        let target = numbers(command, "target")?;
        robot.model().check_configuration(&target).map_err(|error| error.to_string())?;
        robot.settings.target = target;
    }
    if robot.settings.target.is_empty() {
        robot.settings.target.clone_from(&theta);
    }
    if has("motors") {
        let kind = Kind::named(text(command, "motors")?)?;
        let (omega, zeta) = (number(command, "omega")?, number(command, "zeta")?);
        robot.settings.gains = gains(robot.model(), kind, &theta, omega, zeta).map_err(|error| error.to_string())?;
        robot.settings.kind = kind;
    }
    if let Some(ground) = command.get("ground") {
        robot.settings.ground = match ground {
            Value::Null => None,
            _ => Some([number(ground, "friction")?, number(ground, "restitution")?]),
        };
    }
    if let Some(limits) = command["limits"].as_bool() {
        robot.settings.limits = if limits { Policy::Respect } else { Policy::Ignore };
    }
    if command["reset"] == true {
        let settings = &mut robot.settings;
        (settings.time, settings.works, settings.drift) = (0.0, Energy::default(), 0.0);
    }
    if has("account") {
        let of = |key: &str| number(&command["account"], key);
        let settings = &mut robot.settings;
        (settings.time, settings.drift) = (of("time")?, of("drift")?);
        settings.works.motor_work = of("motorWork")?;
        settings.works.friction_loss = of("frictionLoss")?;
        settings.works.applied_work = of("appliedWork")?;
    }
    let Gains { p, d } = &robot.settings.gains;
    Ok(json!({ "p": p, "d": d, "points": robot.settings.points.len() }))
}
