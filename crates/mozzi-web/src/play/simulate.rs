//! A few steps of a simulation, between two pictures.

use super::close::within;
use super::entry::number;
use super::motors::motors;
use super::push::Push;
use crate::robot::Robot;
use mozzi::{FrameId, Wrench};
use mozzi_sim::{ContactForce, ContactPoint, Contacts, Error, Input, Method, Options, Plane, Policy, Simulation};
use serde_json::{Value, json};

/// Motors, and the mouse if it pushes.
struct Both<'a>(Box<dyn Input + 'a>, Option<Push<'a>>);

impl Input for Both<'_> {
    fn torque(&mut self, t: f64, theta: &[f64], dtheta: &[f64], tau: &mut [f64]) -> Result<(), Error> {
        self.0.torque(t, theta, dtheta, tau)
    }

    fn applied(
        &mut self,
        t: f64,
        theta: &[f64],
        dtheta: &[f64],
        wrenches: &mut Vec<(FrameId, Wrench)>,
    ) -> Result<(), Error> {
        self.1.as_mut().map_or(Ok(()), |push| push.applied(t, theta, dtheta, wrenches))
    }

    fn gains(&self, stiffness: &mut [f64], damping: &mut [f64]) {
        self.0.gains(stiffness, damping);
    }
}

/// Steps from the state in the inputs; the new state, θ̈ and τ go there. Returns energies, contacts and the push.
pub fn step(robot: &mut Robot, command: &Value) -> Result<Value, String> {
    let (length, steps) = (number(command, "step")?, number(command, "steps")?);
    let steps = steps as usize;
    let [mut theta, dtheta] = [robot.theta().to_vec(), robot.dtheta().to_vec()];
    if steps > 0 && robot.settings.limits == Policy::Respect {
        within(robot.model(), &mut theta);
    }
    let (model, settings) = (robot.model(), &robot.settings);
    let target = if settings.target.is_empty() { &theta } else { &settings.target };
    let push = Push::parse(model, command)?;
    let input = || Ok::<_, String>(Both(motors(model, settings.kind, &settings.gains, target)?, push.clone()));
    let options = Options {
        joint_limits: if steps > 0 { settings.limits } else { Policy::Ignore },
        record_every: steps.max(1),
        ..Options::new(length * steps as f64, steps.max(1))
    };
    let mut simulation = Simulation::new(options);
    if let Some([mu, restitution]) = settings.ground {
        let point = |point: &ContactPoint| ContactPoint { mu, restitution, ..point.clone() };
        let points = settings.points.iter().map(point).collect();
        simulation.contacts = Contacts { points, planes: vec![Plane::ground()] };
    }
    let within_ground = |error: Error| match &error {
        Error::Model(mozzi::Error::BadArgument { what: "the start", found, .. })
            if found.starts_with("contact point") && !model.is_floating() =>
        {
            format!("{found}, the ground: with a floating base the robot is put on it")
        }
        _ => error.to_string(),
    };
    // the smooth method as long as no stop acts in this picture, and there is no dry friction
    let smooth = Simulation::new(Options { method: Method::RungeKutta4, ..options });
    let by_smooth = match simulation.contacts.is_empty() {
        true => smooth.run(model, &theta, &dtheta, input()?).ok(),
        false => None,
    };
    let run = match by_smooth {
        Some(run) => run,
        None => simulation.run(model, &theta, &dtheta, input()?).map_err(within_ground)?,
    };
    let (first, last) = (run.motion.sample(0), run.motion.last());
    let contacts = &simulation.contacts;
    let touch = |&ContactForce { pair, f }: &ContactForce| {
        let p = contacts.frame(model, 0.0, last.theta, pair).p;
        json!({ "frame": model.frame_name(contacts.point(pair).frame), "p": p.0, "f": f.0 })
    };
    let touches: Value = last.contact_forces.iter().map(touch).collect();
    let pushed = match &push {
        Some(push) => Some(push.force(last.theta, last.dtheta).map_err(|error| error.to_string())?),
        None => None,
    };
    let (energy, drift) = (last.energy, last.energy.drift_since(&first.energy));
    let account = &mut robot.settings;
    account.time += last.t;
    account.drift += drift;
    account.works.motor_work += energy.motor_work;
    account.works.friction_loss += energy.friction_loss;
    account.works.applied_work += energy.applied_work;
    let answer = json!({
        "time": account.time, "kinetic": energy.kinetic, "potential": energy.potential, "total": energy.total(),
        "motorWork": account.works.motor_work, "frictionLoss": account.works.friction_loss,
        "appliedWork": account.works.applied_work, "drift": account.drift,
        "touches": touches, "push": pushed.map(|(p, f)| json!({ "p": p.0, "f": f.0 })),
        "method": run.method.name(), "limits": run.stops.iter().map(|stop| &stop.joint).collect::<Vec<_>>(),
    });
    let [theta, dtheta] = [last.theta.to_vec(), last.dtheta.to_vec()];
    let [ddtheta, tau] = [last.ddtheta.to_vec(), last.tau.to_vec()];
    for (name, numbers) in [("theta", theta), ("dtheta", dtheta), ("ddtheta", ddtheta), ("tau", tau)] {
        robot.put(name, &numbers);
    }
    Ok(answer)
}
