//! Inertia of homogeneous solids about their centre (Modern Robotics, figure 8.5 and exercise 8.1).

use super::SpatialInertia;
use crate::linalg::{Sym3, Vec3};
use core::f64::consts::PI;

/// A homogeneous solid, centred at its frame's origin. Metres. A composite body is a sum of solids, each seen from the
/// composite's frame: `solid.inertia(m).transformed(T_whole_solid) + …`.
///
/// ```
/// use mozzi::{SE3, Solid};
/// // a dumbbell: the exercise 8.2
/// let ball = Solid::Sphere { radius: 0.1 }.of_density(7500.0);
/// let bar = Solid::Cylinder { radius: 0.02, length: 0.2 }.of_density(7500.0);
/// // the balls stand at z = ±0.2
/// let [above, below] = [0.2, -0.2].map(|z| ball.transformed(SE3::translation([0.0, 0.0, z])));
/// let whole = bar + above + below;
/// assert!((whole.mass - 64.717).abs() < 1e-3);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Solid {
    /// A box with these edge lengths along x, y, z.
    Box([f64; 3]),
    /// A cylinder along z with a half ball on either end.
    Capsule {
        /// m.
        radius: f64,
        /// The length of the cylinder alone: m.
        length: f64,
    },
    /// A circular cylinder along z.
    Cylinder {
        /// m.
        radius: f64,
        /// m.
        length: f64,
    },
    /// An ellipsoid with these semi-axes along x, y, z.
    Ellipsoid([f64; 3]),
    /// A ball.
    Sphere {
        /// m.
        radius: f64,
    },
}

impl Solid {
    /// In m³.
    pub fn volume(self) -> f64 {
        match self {
            Solid::Box([x, y, z]) => x * y * z,
            Solid::Capsule { radius, length } => PI * radius * radius * (length + 4.0 / 3.0 * radius),
            Solid::Cylinder { radius, length } => PI * radius * radius * length,
            Solid::Ellipsoid([a, b, c]) => 4.0 / 3.0 * PI * a * b * c,
            Solid::Sphere { radius } => 4.0 / 3.0 * PI * radius * radius * radius,
        }
    }

    /// The inertia at this mass in kg: block-diagonal, since the frame is at the centre of mass.
    pub fn inertia(self, mass: f64) -> SpatialInertia {
        // means of x², y², z² over the solid
        let [x, y, z] = match self {
            Solid::Box(edges) => edges.map(|e| e * e / 12.0),
            Solid::Capsule { radius, length } => {
                // volume fractions (a whole of 1 avoids 0/0 for an empty solid); for a half ball, z has the mean 3r/8
                // and z² the mean r²/5
                let (cylinder, ball) = (length, 4.0 / 3.0 * radius);
                let whole = if cylinder + ball > 0.0 { cylinder + ball } else { 1.0 };
                let half = length / 2.0;
                let mean = |in_cylinder: f64, in_ball: f64| (cylinder * in_cylinder + ball * in_ball) / whole;
                let x = mean(radius * radius / 4.0, radius * radius / 5.0);
                let ends = half * half + 0.75 * half * radius + radius * radius / 5.0;
                [x, x, mean(half * half / 3.0, ends)]
            }
            Solid::Cylinder { radius, length } => {
                [radius * radius / 4.0, radius * radius / 4.0, length * length / 12.0]
            }
            Solid::Ellipsoid(axes) => axes.map(|a| a * a / 5.0),
            Solid::Sphere { radius } => [radius * radius / 5.0; 3],
        };
        SpatialInertia::new(mass, Vec3::zero(), Sym3::diagonal(y + z, x + z, x + y) * mass)
    }

    /// The inertia at this density in kg/m³.
    pub fn of_density(self, density: f64) -> SpatialInertia {
        self.inertia(density * self.volume())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ∫ over the solid by the midpoint rule on k³ cells of its bounding box: an independent second way.
    fn integrate(bounds: [f64; 3], inside: impl Fn(f64, f64, f64) -> bool, k: usize) -> (f64, [f64; 3]) {
        let cell = bounds.map(|b| 2.0 * b / k as f64);
        let at = |axis: usize, i: usize| (i as f64 + 0.5) * cell[axis] - bounds[axis];
        let (mut volume, mut I, d) = (0.0, [0.0; 3], cell[0] * cell[1] * cell[2]);
        for i in 0..k {
            for j in 0..k {
                for l in 0..k {
                    let (x, y, z) = (at(0, i), at(1, j), at(2, l));
                    if inside(x, y, z) {
                        volume += d;
                        I = [I[0] + d * (y * y + z * z), I[1] + d * (x * x + z * z), I[2] + d * (x * x + y * y)];
                    }
                }
            }
        }
        (volume, I)
    }

    #[test]
    fn against_the_integrals() {
        type Inside = fn(f64, f64, f64) -> bool;
        let cases: [(Solid, [f64; 3], Inside); 6] = [
            (Solid::Box([0.2, 0.4, 0.6]), [0.1, 0.2, 0.3], |_, _, _| true),
            (Solid::Capsule { radius: 0.3, length: 1.0 }, [0.3, 0.3, 0.8], |x, y, z| {
                x * x + y * y + (z.abs() - 0.5).max(0.0).powi(2) <= 0.09
            }),
            (Solid::Cylinder { radius: 0.3, length: 1.0 }, [0.3, 0.3, 0.5], |x, y, _| x * x + y * y <= 0.09),
            (Solid::Ellipsoid([0.3, 0.2, 0.5]), [0.3, 0.2, 0.5], |x, y, z| {
                x * x / 0.09 + y * y / 0.04 + z * z / 0.25 <= 1.0
            }),
            (Solid::Sphere { radius: 0.4 }, [0.4; 3], |x, y, z| x * x + y * y + z * z <= 0.16),
            (Solid::Capsule { radius: 0.4, length: 0.0 }, [0.4; 3], |x, y, z| x * x + y * y + z * z <= 0.16),
        ];
        for (solid, bounds, inside) in cases {
            let (volume, I) = integrate(bounds, inside, 120);
            assert!((solid.volume() / volume - 1.0).abs() < 2e-3, "{solid:?}");
            let G = solid.of_density(1.0);
            for (found, integral) in [G.I.xx, G.I.yy, G.I.zz].into_iter().zip(I) {
                assert!((found / integral - 1.0).abs() < 2e-3, "{solid:?} {found} {integral}");
            }
            assert!(G.verdict().is_physical());
        }
    }
}
