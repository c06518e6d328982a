//! One second of a fixed arm with braking motors, step after step: each step waits for the one before, unlike
//! evaluations at known states.

use crate::contestant::Contestant;
use crate::motion::{BRAKE, STEP, STEPS};
use crate::peer::Peer;
use crate::race::{LARGEST_DIFFERENCE, Time, of_runs};
use crate::states::States;
use mozzi::Model;
use mozzi::quantities::ForwardDynamics;
use mozzi_engine::{Compiled, compile};
use mozzi_sim::{Method, Options, torque};
use std::time::{Duration, Instant};

/// The methods whose loop is timed.
pub const METHODS: [Method; 2] = [Method::Euler, Method::RungeKutta4];

/// One robot: nanoseconds for each step, by method and contestant; the first is mozzi.
pub struct Simulated {
    pub robot: String,
    pub columns: Vec<(String, [Option<Time>; 2])>,
}

/// (θ, θ̇) after one second, in place; none if it cannot.
type Run<'a> = Box<dyn FnMut(Method, [&mut [f64]; 2]) -> Option<()> + 'a>;

struct Simulator<'a> {
    column: String,
    algorithm: String,
    run: Run<'a>,
    times: [Vec<f64>; 2],
}

impl<'a> Simulator<'a> {
    fn new(column: &str, algorithm: &str, run: Run<'a>) -> Self {
        Simulator { column: column.into(), algorithm: algorithm.into(), run, times: Default::default() }
    }
}

fn by_mozzi<'a>(model: &'a Model, robot: Option<&'a Compiled>) -> Run<'a> {
    Box::new(move |method, [theta, dtheta]| {
        let brake = torque(|_, _, dtheta, tau| tau.iter_mut().zip(dtheta).for_each(|(tau, rate)| *tau = -BRAKE * rate));
        let options = Options { method, record_every: STEPS, ..Options::new(STEPS as f64 * STEP, STEPS) };
        let motion = match robot {
            Some(robot) => robot.simulate(theta, dtheta, brake, &options),
            None => mozzi_sim::simulate(model, theta, dtheta, brake, &options),
        };
        let motion = motion.ok()?;
        theta.copy_from_slice(motion.last().theta);
        dtheta.copy_from_slice(motion.last().dtheta);
        Some(())
    })
}

/// Times all contestants in turn, repeatedly, after checking that all end in the same state.
pub fn simulate(title: &str, slug: &str, model: &Model, peers: &[Peer], time: Duration) -> Result<Simulated, String> {
    let n = model.n();
    let robot = compile(model, &[ForwardDynamics.into()]).map_err(|error| error.to_string())?;
    let states = States::new(model, 1);
    let mut simulators = vec![Simulator::new("mozzi", "", by_mozzi(model, None))];
    if robot.simulator().is_some() {
        simulators.push(Simulator::new("compiled", "", by_mozzi(model, Some(&robot))));
    }
    for peer in peers {
        let Some(algorithms) = peer.robot(slug, model, &states)?.map(|robot| robot.algorithms()) else { continue };
        for (k, (quantity, name)) in algorithms.into_iter().enumerate() {
            if quantity != ForwardDynamics.into() {
                continue;
            }
            let Some(mut robot) = peer.robot(slug, model, &states)? else { continue };
            simulators.push(Simulator::new(
                &peer.name,
                &name,
                Box::new(move |method, state| robot.simulate(k, method, state)),
            ));
        }
    }

    let start = || (vec![0.5; n], vec![0.0; n]);
    let end = |simulator: &mut Simulator, method| {
        let (mut theta, mut dtheta) = start();
        (simulator.run)(method, [&mut theta, &mut dtheta]).map(|()| [theta, dtheta].concat())
    };
    for method in METHODS {
        let reference = end(&mut simulators[0], method).ok_or("mozzi does not simulate")?;
        let size = reference.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        for simulator in &mut simulators {
            let Some(found) = end(simulator, method) else { continue };
            let difference = found.iter().zip(&reference).fold(0.0, |m: f64, (a, b)| m.max((a - b).abs())) / size;
            if !(difference <= LARGEST_DIFFERENCE) {
                let Simulator { column, algorithm, .. } = simulator;
                let name = method.name();
                return Err(format!("{title}: {name} by {column} ({algorithm}) ends {difference:.1e} from mozzi's"));
            }
        }
    }
    let begin = Instant::now();
    while begin.elapsed() < time || simulators[0].times[0].len() < 10 {
        for (k, method) in METHODS.into_iter().enumerate() {
            for simulator in &mut simulators {
                let start = Instant::now();
                if end(simulator, method).is_some() {
                    simulator.times[k].push(start.elapsed().as_secs_f64() * 1e9 / STEPS as f64);
                }
            }
        }
    }
    let mut columns: Vec<(String, [Option<Time>; 2])> = Vec::new();
    for Simulator { column, algorithm, times, .. } in simulators {
        let [euler, rk4] = times.map(|times| of_runs(&algorithm, None, times));
        match columns.iter_mut().find(|(name, _)| *name == column) {
            None => columns.push((column, [euler, rk4])),
            Some((_, known)) => {
                for (known, time) in known.iter_mut().zip([euler, rk4]) {
                    let both = known.take().into_iter().chain(time);
                    *known = both.min_by(|a, b| a.least.total_cmp(&b.least));
                }
            }
        }
    }
    Ok(Simulated { robot: title.into(), columns })
}
