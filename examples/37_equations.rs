//! The equations of exercises 8.4, 8.6 and 8.7 (Modern Robotics) in symbols: the Furuta pendulum's M, c and g, the
//! derivatives of a Jacobian's columns, the rate of a mass matrix, and the Newton-Euler recursion link by link.
//!
//! > M11 = (𝔪1 + 𝔪2)L1² + I1 + (𝔪2L2² + I2) sin² θ2,  M12 = −𝔪2L1L2 cos θ2,  M22 = 𝔪2L2² + I2
//! > ∂J_i/∂θ_j = [ad_{J_j}] J_i for j < i (space)
//! > Ṁ11 = −2𝔪2L1L2 sin θ2 θ̇2,  Ṁ12 = −𝔪2L1L2 sin θ2 θ̇2 (planar arm)

use mozzi::Model;
use mozzi::quantities::{Of, Query};
use mozzi_symbolic::{Equal, Language, Options, Rational, Symbols, derive, steps};
use std::error::Error;

const OPTIONS: Options =
    Options { symbols: Symbols::ALL, equal: Equal::OfLink, collect: mozzi_symbolic::Collect::Shortest, names: false };

/// Prints a quantity, and returns its first output at a state, with the file's numbers.
fn print(model: &Model, text: &str, name: &str, state: &[&[f64]]) -> Result<Vec<f64>, Box<dyn Error>> {
    let mut query = Query::named(name)?;
    if query.declaration().of == Of::Frame {
        query = query.of(model.end_effector()?);
    }
    let found = derive(model, Some(text), query, &OPTIONS)?;
    println!("{}", found.print(Language::Text));
    let inputs = &state[..query.declaration().inputs.len()];
    let value = found.evaluate(inputs, Rational::to_f64, std::f64::consts::PI).swap_remove(0);
    let expected = model.compute(query, inputs, &model.environment())?.swap_remove(0);
    assert!(value.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-12), "{name}: {value:?} {expected:?}");
    Ok(value)
}

fn main() -> Result<(), Box<dyn Error>> {
    let (theta, dtheta) = ([0.4, 0.9], [0.7, -1.2]);
    let state = [&theta[..], &dtheta[..]];

    println!("Exercise 8.4: the Furuta pendulum\n");
    let text = mozzi_urdf::embedded::text("furuta_pendulum").ok_or("embedded")?;
    let furuta = mozzi_urdf::open("furuta_pendulum")?.build()?;
    let M = print(&furuta, text, "mass_matrix", &state)?;
    let (s, c) = theta[1].sin_cos();
    let by_hand = [8.0 + 6.0 * s * s, -2.0 * c, -2.0 * c, 6.0];
    assert!(M.iter().zip(by_hand).all(|(a, b)| (a - b).abs() < 1e-12));
    print(&furuta, text, "velocity_product", &state)?;
    print(&furuta, text, "gravity_forces", &state)?;

    println!("Exercise 8.6: derivatives of the columns of a space Jacobian\n");
    let text = mozzi_urdf::embedded::text("two_link_planar").ok_or("embedded")?;
    let arm = mozzi_urdf::open("two_link_planar")?.build()?;
    print(&arm, text, "space_jacobian_derivative", &state)?;

    println!("Exercise 8.7: the rate of the mass matrix\n");
    print(&arm, text, "mass_matrix_rate", &state)?;

    println!("Section 8.3: the recursion\n");
    let recursion = steps(&arm, Some(text), &OPTIONS)?;
    println!("{}", recursion.print(Language::Text).unwrap_or_default());
    Ok(())
}
