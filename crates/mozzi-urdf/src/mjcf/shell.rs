//! `shellinertia`: the inertia of a thin surface of even thickness, by MuJoCo's formulas.

use core::f64::consts::PI;
use mozzi::linalg::Sym3;
use mozzi::{Solid, SpatialInertia, Vec3};

/// The surface's area; an ellipsoid's by Thomsen's approximation.
pub(crate) fn area(solid: Solid) -> f64 {
    match solid {
        Solid::Box([x, y, z]) => 2.0 * (x * y + y * z + z * x),
        Solid::Capsule { radius, length } => 4.0 * PI * radius * radius + 2.0 * PI * radius * length,
        Solid::Cylinder { radius, length } => 2.0 * PI * radius * (radius + length),
        Solid::Ellipsoid([a, b, c]) => {
            let p = 1.6075;
            let mean = ((a * b).powf(p) + (b * c).powf(p) + (c * a).powf(p)) / 3.0;
            4.0 * PI * mean.powf(1.0 / p)
        }
        Solid::Sphere { radius } => 4.0 * PI * radius * radius,
    }
}

/// The surface's inertia at a mass. For an ellipsoid it is, as in MuJoCo, the inertia of the layer between it and an
/// ellipsoid that is 1 µm larger in all directions.
pub(crate) fn inertia(solid: Solid, mass: f64) -> SpatialInertia {
    // means of x², y², z² over the surface
    let [x, y, z] = match solid {
        Solid::Box([a, b, c]) => {
            let sides = [b * c, a * c, a * b];
            let whole: f64 = sides.iter().sum();
            let edges = [a, b, c];
            // the pair across axis k is at ± e/2, the two others spread over e²/12
            [0, 1, 2].map(|k| edges[k] * edges[k] * (sides[k] / 4.0 + (whole - sides[k]) / 12.0) / whole)
        }
        Solid::Capsule { radius: r, length: l } => {
            let (ball, side) = (2.0 * r, l); // areas over 2πr
            let half = l / 2.0;
            let mean = |on_ball: f64, on_side: f64| (ball * on_ball + side * on_side) / (ball + side);
            let x = mean(r * r / 3.0, r * r / 2.0);
            // over a half sphere z has the mean r/2 and z² the mean r²/3
            [x, x, mean(half * half + half * r + r * r / 3.0, half * half / 3.0)]
        }
        Solid::Cylinder { radius: r, length: l } => {
            let (ends, side) = (r, l); // areas over 2πr
            let mean = |on_ends: f64, on_side: f64| (ends * on_ends + side * on_side) / (ends + side);
            let x = mean(r * r / 4.0, r * r / 2.0);
            [x, x, mean(l * l / 4.0, l * l / 12.0)]
        }
        Solid::Ellipsoid(axes) => {
            let more = axes.map(|a| a + 1e-6);
            let volume = |axes: [f64; 3]| axes.iter().product::<f64>();
            let (inner, outer) = (volume(axes), volume(more));
            [0, 1, 2].map(|k| (outer * more[k] * more[k] - inner * axes[k] * axes[k]) / (5.0 * (outer - inner)))
        }
        Solid::Sphere { radius } => [radius * radius / 3.0; 3],
    };
    SpatialInertia::new(mass, Vec3::zero(), Sym3::diagonal(y + z, x + z, x + y) * mass)
}
