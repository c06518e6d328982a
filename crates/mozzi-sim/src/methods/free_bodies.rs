//! Floating bodies in a step of Moreau and Jean's: their origins move straight, not on screws.

use super::moreau::Phase;
use alloc::vec;
use alloc::vec::Vec;
use mozzi::lie::SO3;
use mozzi::linalg::Vec3;
use mozzi::model::integrate;
use mozzi::model::{Freedom, Model, Place};

fn vector(x: &[f64], at: usize) -> Vec3 {
    Vec3([x[at], x[at + 1], x[at + 2]])
}

/// The places that move freely: a floating base, free joints.
fn free_places(model: &Model) -> impl Iterator<Item = &Place> {
    model.configuration_space().places().iter().filter(|place| place.freedom == Freedom::Free)
}

/// θ ← θ ⊕ hθ̇, where the origins of floating bodies move straight, not on screws: a wheel that rolls has velocities
/// that turn in its own axes.
pub(super) fn straight(model: &Model, theta: &mut [f64], dtheta: &[f64], h: f64) {
    let starts: Vec<(usize, Vec3)> =
        free_places(model).map(|place| (place.q, origin(theta, place, dtheta, h))).collect();
    integrate(model, theta, dtheta, h);
    for (q, p) in starts {
        theta[q + 4..q + 7].copy_from_slice(&p.0);
    }
}

/// p + h R v.
fn origin(theta: &[f64], place: &Place, dtheta: &[f64], h: f64) -> Vec3 {
    let q = &theta[place.q..];
    let R = SO3::from_quaternion(q[0], vector(q, 1));
    vector(q, 4) + R * vector(dtheta, place.j + 3) * h
}

/// x with the linear velocities of floating bodies in axes that are turned by h ω.
pub(super) fn turned(model: &Model, x: &[f64], omega: &[f64], h: f64) -> Vec<f64> {
    let mut x = x.to_vec();
    for place in free_places(model) {
        let v = SO3::exp(vector(omega, place.j) * h) * vector(&x, place.j + 3);
        x[place.j + 3..place.j + 6].copy_from_slice(&v.0);
    }
    x
}

/// θ̈ of floating bodies whose linear velocities are constant in axes that do not turn: v̇ = −ω × v.
pub(super) fn frame_rates(model: &Model, dtheta: &[f64]) -> Vec<f64> {
    let mut rates = vec![0.0; dtheta.len()];
    for place in free_places(model) {
        let v = vector(dtheta, place.j + 3).cross(vector(dtheta, place.j));
        rates[place.j + 3..place.j + 6].copy_from_slice(&v.0);
    }
    rates
}

/// The end of a step: from the velocities at both ends in the axes of the middle.
pub(super) fn end_of(model: &Model, state: &Phase, v: &[f64], after: &[f64], h: f64, to: &mut Phase) {
    let mean: Vec<f64> = v.iter().zip(after).map(|(a, b)| 0.5 * (a + b)).collect();
    to.theta.copy_from_slice(&state.theta);
    integrate(model, &mut to.theta, &mean, h);
    to.dtheta.copy_from_slice(after);
    for place in free_places(model) {
        let turn = |theta: &[f64]| SO3::from_quaternion(theta[place.q], vector(theta, place.q + 1));
        let middle = turn(&state.theta) * SO3::exp(vector(&state.dtheta, place.j) * (0.5 * h));
        let p = vector(&state.theta, place.q + 4) + middle * vector(&mean, place.j + 3) * h;
        to.theta[place.q + 4..place.q + 7].copy_from_slice(&p.0);
        let v = turn(&to.theta).inverse() * (middle * vector(after, place.j + 3));
        to.dtheta[place.j + 3..place.j + 6].copy_from_slice(&v.0);
    }
}
