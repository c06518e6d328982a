//! Spatial inertia of a rigid body.

use super::{ArticulatedInertia, Twist, Wrench};
use crate::lie::{Adjoint, SE3};
use crate::linalg::{Mat3, Skew, Sym3, Vec3, linear_space};
use crate::scalar::Scalar;
use core::fmt;
use core::ops::Mul;

/// 𝒢 = `[[I, [mc]], [−[mc], m]]` : se(3) → se(3)*, as ten numbers: mass m, first moment of mass mc (c the centre of
/// mass), and rotational inertia I about the frame's origin. kg, kg m, kg m². At the centre of mass it is the book's
/// block-diagonal 𝒢_b.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct SpatialInertia<S = f64> {
    /// m.
    pub mass: S,
    /// m c.
    pub mc: Vec3<S>,
    /// I, about the origin.
    pub I: Sym3<S>,
}
linear_space!(SpatialInertia { mass, mc, I });

impl<S: Scalar> SpatialInertia<S> {
    /// 0.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn zero() -> Self {
        SpatialInertia { mass: S::zero(), mc: Vec3::zero(), I: Sym3::zero() }
    }

    /// From the mass, the centre of mass, and the rotational inertia about the centre of mass, all in this frame's axes
    /// (Steiner: I = I_c − m `[c]`²).
    pub fn new(mass: S, c: Vec3<S>, I_c: Sym3<S>) -> Self {
        let at_c = SpatialInertia { mass, mc: Vec3::zero(), I: I_c };
        at_c.congruence(SE3 { p: -c, ..SE3::identity() }.Ad())
    }

    /// All mass in one point.
    pub fn point_mass(mass: S, at: Vec3<S>) -> Self {
        Self::new(mass, at, Sym3::zero())
    }

    /// `[Ad_T]`ᵀ 𝒢 `[Ad_T]`: with T = `T_ba` and 𝒢 in {b}, the same body's inertia in {a}; the general Steiner theorem
    /// (Modern Robotics 8.42).
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn congruence(self, Ad: Adjoint<S>) -> Self {
        self.congruence_add(Ad, SpatialInertia::zero())
    }

    /// `[Ad_T]`ᵀ 𝒢 `[Ad_T]` + `to`.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn congruence_add(self, Ad: Adjoint<S>, to: Self) -> Self {
        let (SE3 { R, p }, Rt) = (Ad.0, Ad.0.R.matrix().transpose());
        let about = self.about(p);
        SpatialInertia {
            mass: about.mass + to.mass,
            mc: R.matrix().transpose_mul_add(about.mc, to.mc),
            I: about.I.congruence_add(Rt, to.I),
        }
    }

    /// The body's inertia about the point p, in the same axes (parallel-axis theorem).
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn about(self, p: Vec3<S>) -> Self {
        let mc = p.mul_add(-self.mass, self.mc);
        // I about p: I + [mc − mp][p] + [p][mc], whose upper triangle is taken
        let steiner = Skew(mc) * Skew(p) + Skew(p) * Skew(self.mc);
        SpatialInertia { mass: self.mass, mc, I: self.I + Sym3::upper(steiner) }
    }

    /// The body's inertia in the frame {a}, from this one in {b} and T = `T_ab`.
    pub fn transformed(self, T_ab: SE3<S>) -> Self {
        self.congruence(T_ab.inverse().Ad())
    }

    /// The rate of 𝒢, in the coordinates of a frame at rest that the body's frame passes at the twist V:
    /// −𝒢`[ad_V]` − `[ad_V]`ᵀ𝒢. Its mass is 0 and its first moment the body's linear momentum.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn rate(self, V: Twist<S>) -> Self {
        let (W, I, v, mc) = (Skew(V.w), self.I.to_mat3(), Skew(V.v), Skew(self.mc));
        SpatialInertia { mass: S::zero(), mc: (self * V).f, I: Sym3::upper(W * I - I * W - (v * mc + mc * v)) }
    }

    /// The 6 × 6 matrix, as rows, angular first.
    pub fn to_matrix(self) -> [[S; 6]; 6] {
        ArticulatedInertia::from(self).to_matrix()
    }

    /// Each number by f.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn map<U>(self, f: impl Fn(S) -> U + Copy) -> SpatialInertia<U> {
        SpatialInertia { mass: f(self.mass), mc: self.mc.map(f), I: self.I.map(f) }
    }
}

/// 𝒢V: the momentum (or, for an acceleration, the wrench).
impl<S: Scalar> Mul<Twist<S>> for SpatialInertia<S> {
    type Output = Wrench<S>;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn mul(self, V: Twist<S>) -> Wrench<S> {
        Wrench { m: self.mc.cross_add(V.v, self.I * V.w), f: V.v.mul_add(self.mass, V.w.cross(self.mc)) }
    }
}

impl<S: Scalar + PartialEq> SpatialInertia<S> {
    /// c; the origin for a massless body.
    pub fn center_of_mass(&self) -> Vec3<S> {
        if self.mass == S::zero() { Vec3::zero() } else { self.mc.map(|x| x / self.mass) }
    }
}

/// Error: the matrix is not a spatial inertia.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NotASpatialInertia {
    row: usize,
    column: usize,
    found: f64,
    expected: f64,
}

impl core::fmt::Display for NotASpatialInertia {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let NotASpatialInertia { row, column, found, expected } = self;
        if !found.is_finite() {
            return write!(f, "not a spatial inertia: entry ({row}, {column}) is {found}, expected a finite number");
        }
        write!(
            f,
            "not a spatial inertia: entry ({row}, {column}) is {found}, expected {expected} (the form is [[I, [mc]], [−[mc], m]])"
        )
    }
}

impl core::error::Error for NotASpatialInertia {}

impl SpatialInertia<f64> {
    /// From a 6 × 6 matrix, as rows, angular first: the book's block-diagonal 𝒢_b, or one whose frame is not at the
    /// centre of mass.
    ///
    /// # Errors
    /// When it is not of the form `[[I, [mc]], [−[mc], m]]` with I symmetric, to 10⁻¹² of its largest entry.
    pub fn from_matrix(G: [[f64; 6]; 6]) -> Result<Self, NotASpatialInertia> {
        let block =
            |r: usize, c: usize| Mat3::from_rows([0, 1, 2].map(|i| [G[r + i][c], G[r + i][c + 1], G[r + i][c + 2]]));
        let this = SpatialInertia { mass: G[3][3], mc: block(0, 3).vee(), I: Sym3::upper(block(0, 0)) };
        let largest = G.as_flattened().iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        for (row, (found, expected)) in G.iter().zip(this.to_matrix()).enumerate() {
            for column in 0..6 {
                let (found, expected) = (found[column], expected[column]);
                if !largest.is_finite() && found.is_finite() {
                    continue; // the entry that is not finite is named
                }
                if !((found - expected).abs() <= 1e-12 * largest) {
                    return Err(NotASpatialInertia { row, column, found, expected });
                }
            }
        }
        Ok(this)
    }

    /// The rotational inertia about the centre of mass, in this frame's axes.
    pub fn about_center_of_mass(&self) -> Sym3 {
        self.congruence(SE3 { p: self.center_of_mass(), ..SE3::identity() }.Ad()).I
    }

    /// Whether a body with this inertia can exist, with the numbers behind the verdict; rods and point masses are
    /// valid.
    pub fn verdict(&self) -> InertiaVerdict {
        let principal_moments = eigenvalues(self.about_center_of_mass());
        let [a, b, c] = principal_moments;
        // rounding of the shift to the centre of mass, and of the numbers themselves
        let rounding = 1e-12 * (self.I.trace().abs() + a.abs() + b.abs() + c.abs());
        let finite = self.to_matrix().as_flattened().iter().all(|x| x.is_finite());
        let problem = if !finite {
            Some(InertiaProblem::NotFinite)
        } else if self.mass < 0.0 {
            Some(InertiaProblem::NegativeMass)
        } else if a < -rounding {
            Some(InertiaProblem::NegativeMoment)
        } else if a + b < c - rounding {
            Some(InertiaProblem::Triangle)
        } else {
            None
        };
        InertiaVerdict { mass: self.mass, principal_moments, problem }
    }
}

/// The result of [`SpatialInertia::verdict`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InertiaVerdict {
    /// m in kg.
    pub mass: f64,
    /// The principal moments about the centre of mass in kg m², smallest first.
    pub principal_moments: [f64; 3],
    problem: Option<InertiaProblem>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum InertiaProblem {
    NotFinite,
    NegativeMass,
    NegativeMoment,
    Triangle,
}

impl InertiaVerdict {
    /// True if a body with this inertia can exist.
    pub fn is_physical(&self) -> bool {
        self.problem.is_none()
    }
}

impl fmt::Display for InertiaVerdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [a, b, c] = self.principal_moments.map(Rounded);
        match self.problem {
            None => write!(f, "physical: mass {} kg, principal moments {a}, {b}, {c} kg m²", self.mass),
            Some(InertiaProblem::NotFinite) => write!(f, "not finite"),
            Some(InertiaProblem::NegativeMass) => write!(f, "the mass is {} kg, expected at least 0", self.mass),
            Some(InertiaProblem::NegativeMoment) => {
                write!(f, "the smallest principal moment about the centre of mass is {a} kg m², expected at least 0")
            }
            Some(InertiaProblem::Triangle) => write!(
                f,
                "the principal moments about the centre of mass, {a}, {b} and {c} kg m², break the triangle inequality: \
                 the largest exceeds the sum of the others by {}",
                Rounded(c.0 - (a.0 + b.0))
            ),
        }
    }
}

/// A number for display: six digits, with an exponent if there would be many zeros.
pub struct Rounded(pub f64);

impl fmt::Display for Rounded {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rounded = alloc::format!("{:.5e}", self.0).parse::<f64>().unwrap_or(self.0);
        let is_plain = rounded == 0.0 || (1e-4..1e6).contains(&rounded.abs());
        if is_plain { write!(f, "{rounded}") } else { write!(f, "{rounded:e}") }
    }
}

/// Eigenvalues of a symmetric matrix, smallest first, by Jacobi's rotations.
fn eigenvalues(s: Sym3) -> [f64; 3] {
    let mut m = s.to_mat3().rows();
    for _ in 0..16 {
        for (i, j) in [(0, 1), (0, 2), (1, 2)] {
            let off = m[i][j];
            if off == 0.0 || !off.is_finite() {
                continue;
            }
            // tan of the angle that makes m[i][j] zero, the smaller of two
            let ratio = (m[j][j] - m[i][i]) / (2.0 * off);
            let t = ratio.signum() / (ratio.abs() + Scalar::sqrt(ratio * ratio + 1.0));
            let cos = 1.0 / Scalar::sqrt(t * t + 1.0);
            let sin = t * cos;
            for row in &mut m {
                (row[i], row[j]) = (cos * row[i] - sin * row[j], sin * row[i] + cos * row[j]);
            }
            for k in 0..3 {
                (m[i][k], m[j][k]) = (cos * m[i][k] - sin * m[j][k], sin * m[i][k] + cos * m[j][k]);
            }
        }
    }
    let mut values = [m[0][0], m[1][1], m[2][2]];
    values.sort_unstable_by(f64::total_cmp);
    values
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{inertia, twist};

    fn product(A: [[f64; 6]; 6], B: [[f64; 6]; 6]) -> [[f64; 6]; 6] {
        core::array::from_fn(|i| core::array::from_fn(|j| (0..6).map(|k| A[i][k] * B[k][j]).sum()))
    }
    fn transpose(A: [[f64; 6]; 6]) -> [[f64; 6]; 6] {
        core::array::from_fn(|i| core::array::from_fn(|j| A[j][i]))
    }
    fn difference(A: [[f64; 6]; 6], B: [[f64; 6]; 6]) -> f64 {
        A.as_flattened().iter().zip(B.as_flattened()).fold(0.0, |m, (a, b)| m.max((a - b).abs()))
    }

    #[test]
    fn congruence_and_rate_equal_their_matrix_forms() {
        let (G, T, V) = (inertia(1), SE3::exp(twist(2)), twist(3));
        let Ad = T.Ad().to_matrix();
        let dense = product(transpose(Ad), product(G.to_matrix(), Ad));
        assert!(difference(G.congruence(T.Ad()).to_matrix(), dense) < 1e-13);

        let (GV, ad) = (product(G.to_matrix(), V.ad().to_matrix()), V.ad().to_matrix());
        let adG = product(transpose(ad), G.to_matrix());
        let dense = core::array::from_fn(|i| core::array::from_fn(|j| -GV[i][j] - adG[i][j]));
        assert!(difference(G.rate(V).to_matrix(), dense) < 1e-13);
    }

    #[test]
    fn a_matrix_gives_the_inertia_back_or_is_refused() {
        let G = inertia(5);
        assert!(
            SpatialInertia::from_matrix(G.to_matrix())
                .is_ok_and(|back| difference(back.to_matrix(), G.to_matrix()) < 1e-15)
        );
        let mut wrong = G.to_matrix();
        wrong[4][4] += 1.0; // an invalid mass that depends on the direction
        let message = SpatialInertia::from_matrix(wrong).expect_err("two masses").to_string();
        assert!(message.contains("entry (4, 4)"), "{message}");
    }

    #[test]
    fn verdicts() {
        let at =
            |c: [f64; 3], I: [f64; 3]| SpatialInertia::new(2.0, Vec3(c), Sym3::diagonal(I[0], I[1], I[2])).verdict();
        assert!(at([0.3, -4.0, 100.0], [0.0, 0.0, 0.0]).is_physical(), "a point mass far away");
        assert!(at([1.0, 2.0, 3.0], [0.0, 1.0, 1.0]).is_physical(), "a rod");
        assert!(at([0.0; 3], [1.0, 2.0, 3.0]).is_physical(), "a plate");
        let text = |v: InertiaVerdict| alloc::format!("{v}");
        assert!(text(at([0.0; 3], [1.0, 2.0, 3.1])).contains("exceeds the sum of the others by 0.1"));
        assert!(text(at([0.0; 3], [-1e-6, 1.0, 1.0])).contains("is -1e-6 kg m²"));
        assert!(!SpatialInertia::point_mass(-1.0, Vec3::zero()).verdict().is_physical());
        assert!(!SpatialInertia::point_mass(f64::NAN, Vec3::zero()).verdict().is_physical());
    }

    #[test]
    fn eigenvalues_of_a_turned_diagonal() {
        let R = crate::SO3::exp(Vec3([0.4, 1.0, -2.0])).matrix();
        let found = eigenvalues(Sym3::diagonal(3.0, 1.0, 1e-9).congruence(R));
        for (found, expected) in found.into_iter().zip([1e-9, 1.0, 3.0]) {
            assert!((found - expected).abs() < 4.0 * f64::EPSILON * 3.0);
        }
    }
}
