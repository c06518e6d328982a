//! The forces that an estimate predicts: by inverse dynamics of the identified robot, not by the equations that were
//! fitted.

use crate::Error;
use crate::columns::{Columns, Kind};
use crate::payload::{Carried, robot_of};
use crate::signals::Samples;
use mozzi::quantities::{InverseDynamics, Query};
use mozzi::{Environment, Model, fast};

/// The robot's [`parameters`](Model::parameters) with the unknowns in their places. A payload is added to the link that
/// carries it; offsets, Stribeck friction, apparent inertia and drive gains are not among them.
///
/// # Errors
/// [`Error::Model`].
pub fn parameters(columns: &Columns<'_>, x: &[f64]) -> Result<Vec<f64>, Error> {
    let mut pi = columns.model.parameters();
    let mut payload = [0.0; 10];
    for (unknown, &value) in columns.unknowns.iter().zip(x) {
        match unknown.kind {
            Kind::Link(k) | Kind::Armature(k) | Kind::Viscous(k) | Kind::Coulomb(k) | Kind::Stiffness(k) => {
                pi[k] = value
            }
            Kind::Payload(k) => payload[k] = value,
            Kind::Stribeck(_) | Kind::Offset(_) | Kind::Gain(_) | Kind::Apparent(_) => {}
            Kind::RotorViscous(_) | Kind::RotorCoulomb(_) => {}
        }
    }
    if let Some(frame) = columns.choice.payload {
        Carried::new(columns.model, frame)?.add(&mut pi, &payload);
    }
    Ok(pi)
}

/// The identified robot: [`parameters`] in the model. Its Coulomb friction is μ sgn θ̇.
///
/// # Errors
/// [`Error::Model`].
pub fn identified(columns: &Columns<'_>, x: &[f64]) -> Result<Model, Error> {
    Ok(columns.model.with_parameters(&parameters(columns, x)?))
}

/// Predicted forces of all samples, N × n; currents, if drive gains are estimated.
///
/// # Errors
/// [`Error::Model`].
pub fn predict(columns: &Columns<'_>, x: &[f64], samples: &Samples) -> Result<Vec<f64>, Error> {
    predict_some(columns, x, samples, 0..samples.count())
}

/// Predicted forces of a range of samples.
///
/// # Errors
/// [`Error::Model`].
pub(crate) fn predict_some(
    columns: &Columns<'_>,
    x: &[f64],
    samples: &Samples,
    range: core::ops::Range<usize>,
) -> Result<Vec<f64>, Error> {
    let model = columns.model;
    let (n, nq) = (model.n(), model.nq());
    let mut pi = parameters(columns, x)?;
    // Coulomb friction is smooth here
    let names = model.parameter_names();
    let places = model.places();
    let mut mu = vec![0.0; n];
    for (place, joint) in places.iter().zip(model.joint_names()) {
        if let Some(k) = names.iter().position(|name| name.strip_suffix(".friction") == Some(joint)) {
            place.velocities().for_each(|j| mu[j] = pi[k]);
            pi[k] = 0.0;
        }
    }
    let mut of_rotors = vec![[0.0; 2]; columns.rotors.len()];
    let (mut offset, mut stribeck, mut gain) = (vec![0.0; n], vec![0.0; n], vec![1.0; n]);
    for (unknown, &value) in columns.unknowns.iter().zip(x) {
        match unknown.kind {
            Kind::Offset(j) => offset[j] = value,
            Kind::Gain(j) => gain[j] = value,
            Kind::Stribeck(place) => places[place].velocities().for_each(|j| stribeck[j] = value),
            Kind::Apparent(k) => pi[k] += value,
            Kind::RotorViscous(r) => of_rotors[r][0] = value,
            Kind::RotorCoulomb(r) => of_rotors[r][1] = value,
            _ => {}
        }
    }
    let robot = robot_of(model, pi, samples)?;
    let shape = columns.choice.shape();
    let (query, mut workspace) = (Query::from(InverseDynamics), fast::Workspace::new(&robot));
    let mut all = vec![0.0; range.len() * n];
    for (k, tau) in range.zip(all.chunks_mut(n)) {
        let (theta, row) = (&samples.theta[k * nq..][..nq], k * n..(k + 1) * n);
        let (dtheta, ddtheta) = (&samples.dtheta[row.clone()], &samples.ddtheta[row]);
        let environment = Environment { applied: &samples.applied(k), ..robot.environment() };
        fast::evaluate(&query, &robot, &[theta, dtheta, ddtheta], &environment, &mut workspace, &mut [tau]);
        let of = |given: &Option<Vec<f64>>, entry: usize, of_one: f64| {
            given.as_ref().map_or(of_one, |table| table[k * (n + columns.rotors.len()) + entry])
        };
        for (r, (J, [d, mu])) in columns.rotors.iter().zip(&of_rotors).enumerate() {
            let omega = crate::rotors::rate(J, dtheta);
            let force = d * omega + mu * of(&samples.coulomb, n + r, shape.coulomb(omega));
            tau.iter_mut().zip(J).for_each(|(tau, J)| *tau += J * force);
        }
        for j in 0..n {
            let coulomb = of(&samples.coulomb, j, shape.coulomb(dtheta[j]));
            let friction = mu[j] * coulomb + stribeck[j] * of(&samples.stribeck, j, shape.stribeck(dtheta[j]));
            tau[j] = (tau[j] + friction + offset[j]) / gain[j];
        }
    }
    Ok(all)
}
