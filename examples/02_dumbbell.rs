//! Rotational inertias of solids (Modern Robotics, exercises 8.1 and 8.2).
//!
//! **Exercise 8.1.** About the centre of a homogeneous solid of mass m, I_xx = ∫ρ(y² + z²)dV = m(⟨y²⟩ + ⟨z²⟩), where
//! ⟨x²⟩ is the mean of x² over the solid. Cut it into slabs across x, of area a(x): ⟨x²⟩ = ∫x²a dx / ∫a dx.
//!
//! > box with edges e:            a constant            ⟨x²⟩ = e_x²/12
//! > cylinder (r, l) along z:     a ∝ √(r² − x²)        ⟨x²⟩ = ⟨y²⟩ = r²/4, ⟨z²⟩ = l²/12
//! > ellipsoid with semi-axes s:  a ∝ 1 − x²/s_x²       ⟨x²⟩ = s_x²(1/3 − 1/5)/(1 − 1/3) = s_x²/5
//!
//! hence the book's table: I_xx = m(h² + l²)/12 of a box, m(3r² + l²)/12 and m r²/2 of a cylinder, m(b² + c²)/5 of an
//! ellipsoid.
//!
//! **Exercise 8.2.** A dumbbell of cast iron, 7500 kg/m³: two balls of ⌀ 20 cm on a bar of ⌀ 4 cm, 20 cm long; {b} at
//! the centre, z along the bar. The balls' centres are d = 10 + 10 cm from it; by Steiner's theorem
//!
//! > I_xx = I_yy = m_c(3r² + l²)/12 + 2(2m_sR²/5 + m_sd²),  I_zz = m_cr²/2 + 2 · 2m_sR²/5
//!
//! and 𝒢_b = diag(I_xx, I_yy, I_zz, m, m, m) with m = m_c + 2m_s.

use mozzi::SE3;
use mozzi::spatial::solids::Solid;
use mozzi_examples::{agree, row};
use nalgebra::{DMatrix, DVector};
use std::f64::consts::PI;

/// ⟨x²⟩ of a solid from −h to h, cut into slabs of area a(x): the midpoint rule.
fn mean_square(h: f64, area: impl Fn(f64) -> f64) -> f64 {
    let n = 100_000;
    let slabs = (0..n).map(|k| ((k as f64 + 0.5) * 2.0 / n as f64 - 1.0) * h).map(|x| (x, area(x)));
    let (moment, volume) = slabs.fold((0.0, 0.0), |(moment, volume), (x, a)| (moment + x * x * a, volume + a));
    moment / volume
}

fn main() {
    println!("Exercise 8.1: solids of 1 kg, (I_xx, I_yy, I_zz) in kg m²\n");
    let across_cylinder = mean_square(0.3, |x: f64| (0.09 - x * x).sqrt());
    let semi_axis = |s: f64| mean_square(s, |x| 1.0 - x * x / (s * s));
    let edge = |e: f64| mean_square(e / 2.0, |_| 1.0);
    for (solid, [x, y, z]) in [
        (Solid::Box([0.2, 0.4, 0.6]), [edge(0.2), edge(0.4), edge(0.6)]),
        (Solid::Cylinder { radius: 0.3, length: 1.0 }, [across_cylinder, across_cylinder, edge(1.0)]),
        (Solid::Ellipsoid([0.3, 0.2, 0.5]), [semi_axis(0.3), semi_axis(0.2), semi_axis(0.5)]),
        (Solid::Sphere { radius: 0.4 }, [semi_axis(0.4); 3]),
    ] {
        let I = solid.inertia(1.0).I;
        println!("{solid:?}: [{}]", row(&[I.xx, I.yy, I.zz]));
        agree("its slabs and the library", &[I.xx, I.yy, I.zz], &[y + z, x + z, x + y], 1e-6);
    }

    // by hand
    let (density, R, r, l) = (7500.0, 0.1, 0.02, 0.2);
    let (m_s, m_c, d) = (density * 4.0 / 3.0 * PI * R * R * R, density * PI * r * r * l, l / 2.0 + R);
    let across = m_c * (3.0 * r * r + l * l) / 12.0 + 2.0 * (0.4 * m_s * R * R + m_s * d * d);
    let along = m_c * r * r / 2.0 + 2.0 * 0.4 * m_s * R * R;
    let m = m_c + 2.0 * m_s;
    let by_hand = DMatrix::from_diagonal(&DVector::from_vec(vec![across, across, along, m, m, m]));

    // by the library: a sum of solids, each moved to its place; `congruence` takes {b} seen from the ball
    let (ball, bar) = (Solid::Sphere { radius: R }.of_density(density), Solid::Cylinder { radius: r, length: l });
    let at = |z: f64| ball.congruence(SE3::translation([0.0, 0.0, z]).inverse().Ad());
    let dumbbell = bar.of_density(density) + at(d) + at(-d);

    println!("\nExercise 8.2: the dumbbell weighs {m_c:.3} + 2 × {m_s:.3} = {m:.3} kg");
    println!("I_xx = I_yy = {:.4} kg m², I_zz = {:.4} kg m²", dumbbell.I.xx, dumbbell.I.zz);
    println!("{}", dumbbell.verdict());
    agree("𝒢_b, by hand and by the library", dumbbell.to_matrix().as_flattened(), &by_hand, 1e-14);
}
