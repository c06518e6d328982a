//! Directional derivatives of programs (forward mode): a program evaluated on dual numbers while another is recorded.

use crate::arguments::Rates;
use crate::program::Program;
use crate::record::record;
use crate::traced::Traced;
use mozzi::{Dual, Freedom, Model, SO3, Vec3};

/// The name of an array's rate.
pub fn rate_of(name: &str) -> String {
    format!("{name}_rate")
}

/// The program and its derivative along a direction, with a rate for some inputs and for each output but pivots, which
/// come last. The rate of `theta` is along the velocities.
pub fn with_rates(program: &Program, model: &Model, rates: Rates) -> Program {
    let is_theta = |name: &str| name == "theta";
    let own = program.inputs().iter().map(|array| (array.name.clone(), array.length));
    let moving = program.inputs().iter().enumerate().filter(|&(k, _)| rates.has(k)).map(|(_, array)| {
        let length = if is_theta(&array.name) { model.n() } else { array.length };
        (rate_of(&array.name), length)
    });
    let inputs: Vec<(String, usize)> = own.chain(moving).collect();
    let inputs: Vec<(&str, usize)> = inputs.iter().map(|(name, length)| (name.as_str(), *length)).collect();
    let names: Vec<&str> = program.outputs().iter().map(|output| output.name.as_str()).collect();
    let pivots = names.iter().position(|name| name.ends_with("pivots")).unwrap_or(names.len());
    let of_rates: Vec<String> = names[..pivots].iter().map(|name| rate_of(name)).collect();
    record(&format!("{}_jvp", program.name()), &inputs, |arrays| {
        let (values, given) = arrays.split_at(program.inputs().len());
        let mut given = given.iter();
        let mut seeded: Vec<Vec<Dual<Traced>>> = Vec::with_capacity(values.len());
        for (k, (array, x)) in program.inputs().iter().zip(values).enumerate() {
            let rate = if rates.has(k) { given.next() } else { None };
            seeded.push(match rate {
                None => Dual::constants(x),
                Some(rate) if is_theta(&array.name) => positions(model, x, rate),
                Some(rate) => Dual::list(x, rate),
            });
        }
        let found = program.evaluate(&seeded.iter().map(Vec::as_slice).collect::<Vec<_>>());
        let of = |part: fn(&Dual<Traced>) -> Traced| move |x: &Vec<Dual<Traced>>| x.iter().map(part).collect();
        let values: Vec<(&str, Vec<Traced>)> = names.iter().copied().zip(found.iter().map(of(|x| x.value))).collect();
        let derivatives = of_rates.iter().map(String::as_str).zip(found.iter().map(of(|x| x.derivative)));
        let (own, pivots) = values.split_at(pivots);
        own.iter().cloned().chain(derivatives).chain(pivots.iter().cloned()).collect()
    })
}

/// θ with its rate along the velocities: q̇ = ½ q ω of a quaternion, ṗ = R v of an origin, θ̇ of any other joint.
fn positions(model: &Model, theta: &[Traced], velocities: &[Traced]) -> Vec<Dual<Traced>> {
    let mut moving = Dual::constants(theta);
    for place in model.configuration_space().places() {
        let (moving, theta, v) =
            (&mut moving[place.positions()], &theta[place.positions()], &velocities[place.velocities()]);
        if place.freedom == Freedom::One {
            moving[0].derivative = v[0];
            continue;
        }
        let (w, q, omega) = (theta[0], Vec3([theta[1], theta[2], theta[3]]), Vec3([v[0], v[1], v[2]]));
        let half = omega * Traced::from(0.5);
        let turned = half * w + q.cross(half);
        moving[0].derivative = -q.dot(half);
        (0..3).for_each(|k| moving[1 + k].derivative = turned.0[k]);
        if place.freedom == Freedom::Free {
            let shifted = SO3::from_quaternion(w, q) * Vec3([v[3], v[4], v[5]]);
            (0..3).for_each(|k| moving[4 + k].derivative = shifted.0[k]);
        }
    }
    moving
}
