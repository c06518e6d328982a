//! Simulation (Modern Robotics, section 8.5): Euler's method against Runge-Kutta's, on a falling double pendulum.
//!
//! With q1 = θ and q2 = θ̇ the equation of motion is q̇1 = q2, q̇2 = FD(q1, q2, τ, F_tip). Euler's method with N
//! steps δt:
//!
//! > θ[k+1] = θ[k] + θ̇[k]δt,  θ̇[k+1] = θ̇[k] + θ̈[k]δt,  θ̈[k] = FD(θ[k], θ̇[k], τ(kδt), F_tip(kδt))
//!
//! A step leaves out the terms of the Taylor series from δt² on; N = t_f/δt steps accumulate an error proportional to
//! δt: order 1. Semi-implicit Euler uses the new θ̇ for the step of θ: order 1 too, but no steady gain of energy. The
//! Runge-Kutta method calls FD four times in each step, and its error is proportional to δt⁴. The observed order is
//! log2 of the ratio of the errors with N and 2N steps. Without motors or friction the energy 𝒦 + 𝒫 should be constant:
//! its drift is a second check.

use mozzi::Model;
use mozzi_examples::{agree, difference, row};
use mozzi_sim::{Method, Options, Zero};
use std::error::Error;

const DURATION: f64 = 2.0;
const START: [f64; 2] = [1.2, 0.5];

fn main() -> Result<(), Box<dyn Error>> {
    let model = mozzi_urdf::open("double_pendulum")?.build()?;
    let run = |method, steps| {
        mozzi_sim::simulate(&model, &START, &[0.0; 2], Zero, &Options { method, ..Options::new(DURATION, steps) })
    };

    // the book's algorithm by hand
    let (theta, dtheta) = euler(&model, 1000)?;
    let found = run(Method::Euler, 1000)?;
    println!("Double pendulum, let go at θ = {START:?} rad, after {DURATION} s by 1000 steps of Euler's method:");
    println!("  θ = [{}] rad, θ̇ = [{}] rad/s", row(&theta), row(&dtheta));
    agree("θ, by hand and by the library", found.last().theta, &theta, 1e-10);
    agree("θ̇", found.last().dtheta, &dtheta, 1e-10);

    // the reference: Runge-Kutta with steps so small that only rounding errors remain
    let reference = run(Method::RungeKutta4, 16_000)?;
    println!("\nwith Runge-Kutta's, 16000 steps: θ = [{}] rad\n", row(reference.last().theta));

    println!(
        "{:20} {:>7} {:>9} {:>14} {:>16} {:>7}",
        "method", "steps", "calls FD", "error of θ", "energy drift", "order"
    );
    for (method, fewest, calls) in
        [(Method::Euler, 4000, 1), (Method::SemiImplicitEuler, 4000, 1), (Method::RungeKutta4, 1000, 4)]
    {
        let mut before: Option<f64> = None;
        for steps in [fewest, 2 * fewest, 4 * fewest] {
            let found = run(method, steps)?;
            let error = difference(found.last().theta, reference.last().theta);
            let order = before.map(|before| (before / error).log2());
            println!(
                "{:20} {steps:7} {:9} {:>10.2e} rad {:>14.2e} J {}",
                method.name(),
                calls * steps,
                error,
                found.largest_drift(),
                order.map_or(String::new(), |order| format!("{order:7.2}")),
            );
            if let Some(order) = order {
                assert!((order - f64::from(method.order())).abs() < 0.2, "{}: order {order}", method.name());
            }
            before = Some(error);
        }
    }
    println!("\n(the largest kinetic energy on the way was {:.2} J)", reference.largest_kinetic_energy());
    assert!(reference.largest_drift() < 1e-10 * reference.largest_kinetic_energy());
    Ok(())
}

/// The book's "Euler integration algorithm for forward dynamics", with τ = 0 and no wrench at the tip.
fn euler(model: &Model, N: usize) -> Result<([f64; 2], [f64; 2]), mozzi::Error> {
    let dt = DURATION / N as f64;
    let (mut theta, mut dtheta) = (START, [0.0; 2]);
    for _ in 0..N {
        let ddtheta = model.forward_dynamics(&theta, &dtheta, &[0.0; 2], &model.environment())?;
        for i in 0..2 {
            theta[i] += dtheta[i] * dt;
            dtheta[i] += ddtheta[i] * dt;
        }
    }
    Ok((theta, dtheta))
}
