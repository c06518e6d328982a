//! Numbers that sliders set: positions, and for orientations a rotation vector.

use super::{Call, Drawn, output};
use crate::request::Output;
use mozzi::{Error, Freedom, Place, SO3, Vec3};

/// n numbers x: a joint's position; the rotation vector of a ball; the rotation vector and the origin of a free joint
/// and a floating base.
pub const COORDINATES: Drawn = Drawn {
    name: "coordinates",
    formula: "x(θ): positions, and of orientations the rotation vector",
    inputs: &["theta"],
    of_frame: false,
    outputs: |model| of_length("x", model.n()),
    compute: coordinates,
};

/// θ(x), the inverse of [`COORDINATES`]; a ball turns no farther than its limit.
pub const CONFIGURATION: Drawn = Drawn {
    name: "configuration",
    formula: "θ(x), x being the coordinates; a ball's angle is at most its limit",
    inputs: &["x"],
    of_frame: false,
    outputs: |model| of_length("theta", model.nq()),
    compute: configuration,
};

/// θ with unit quaternions.
pub const UNIT_CONFIGURATION: Drawn = Drawn {
    name: "unit_configuration",
    formula: "θ with its quaternions made unit",
    inputs: &["theta"],
    of_frame: false,
    outputs: |model| of_length("theta", model.nq()),
    compute: unit_configuration,
};

fn of_length(name: &'static str, length: usize) -> Vec<Output> {
    vec![output(name, [length], "rad or m")]
}

fn coordinates(call: &Call) -> Result<Vec<f64>, Error> {
    let mut x = vec![0.0; call.model.n()];
    for place in call.model.configuration_space().places() {
        let (own, x) = (&call.inputs[0][place.positions()], &mut x[place.velocities()]);
        match (place.freedom, own) {
            (Freedom::Ball | Freedom::Free, &[w, i, j, k, ref origin @ ..]) => {
                let (turn, rest) = x.split_at_mut(3);
                turn.copy_from_slice(&SO3::from_quaternion(w, Vec3([i, j, k])).log().0);
                rest.copy_from_slice(origin);
            }
            _ => x.copy_from_slice(own),
        }
    }
    Ok(x)
}

fn configuration(call: &Call) -> Result<Vec<f64>, Error> {
    let (model, x) = (call.model, call.inputs[0]);
    let mut theta = vec![0.0; model.nq()];
    let has_base = usize::from(model.is_floating());
    let limits = std::iter::repeat_n(None, has_base).chain(model.joints().map(|joint| joint.limits.position));
    for (place, limits) in model.configuration_space().places().iter().zip(limits) {
        let (own, x) = (&mut theta[place.positions()], &x[place.velocities()]);
        match (place.freedom, x) {
            (Freedom::Ball | Freedom::Free, &[a, b, c, ref origin @ ..]) => {
                let (turn, rest) = own.split_at_mut(4);
                let (w, v) = SO3::exp(shortened(Vec3([a, b, c]), limits.map(|[_, most]| most))).quaternion();
                turn.copy_from_slice(&[w, v.0[0], v.0[1], v.0[2]]);
                rest.copy_from_slice(origin);
            }
            _ => own.copy_from_slice(x),
        }
    }
    Ok(theta)
}

/// A vector of at most this length.
fn shortened(x: Vec3, most: Option<f64>) -> Vec3 {
    match most {
        Some(most) if x.norm() > most => x * (most / x.norm()),
        _ => x,
    }
}

fn unit_configuration(call: &Call) -> Result<Vec<f64>, Error> {
    let mut theta = call.inputs[0].to_vec();
    let turns = |place: &&Place| place.freedom != Freedom::One;
    for place in call.model.configuration_space().places().iter().filter(turns) {
        let quaternion = &mut theta[place.q..place.q + 4];
        let size = quaternion.iter().map(|x| x * x).sum::<f64>().sqrt();
        if size > 0.0 {
            quaternion.iter_mut().for_each(|x| *x /= size);
        }
    }
    Ok(theta)
}
