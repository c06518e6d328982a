//! The book's stacked closed form (Modern Robotics, section 8.4): dense, for reading and comparison. It is computed
//! independently of the kernels, from the screws in the centre-of-mass frames.

use super::armature::{add_coriolis_blocks, set_armature};
use super::joint_friction::joint_friction;
use super::spring_forces::spring_forces;
use crate::kinematics::base_pose;
use crate::lie::SE3;
use crate::model::{Environment, Error, Model, Motion};
use crate::scalar::{Real, Scalar};
use crate::spatial::{Twist, Wrench};
use alloc::vec;
use nalgebra::{ClosedAddAssign, ClosedMulAssign, ClosedSubAssign, DMatrix, DVector};
use num_traits::{One, Zero};

/// A scalar type for which nalgebra has matrices: `f64`, [`Dual`](crate::Dual), a wide number.
pub trait Entry:
    Real + Into<f64> + nalgebra::Scalar + Zero + One + ClosedAddAssign + ClosedSubAssign + ClosedMulAssign
{
}
impl<S: Real + Into<f64> + nalgebra::Scalar + Zero + One + ClosedAddAssign + ClosedSubAssign + ClosedMulAssign> Entry
    for S
{
}

/// Every stacked vector and matrix of the closed form at one state, for N moving links and n velocities. Frame {i} is
/// at the centre of mass of link i, oriented as the link's; blocks are base to tips, angular first. A floating base is
/// the first of the N moving links, with the axes I, in the base link's own frame. A ball is three links and a free
/// joint six, massless but for the last. Their frames have their own axes and are fixed in the last link, so the whole
/// joint's twist is in the first link's block of [ad_𝒜θ̇], and the others' blocks are 0.
///
/// > 𝒱 = 𝒲𝒱 + 𝒜θ̇ + 𝒱_base, 𝒱̇ = 𝒲𝒱̇ + 𝒜θ̈ − [ad_𝒜θ̇](𝒲𝒱 + 𝒱_base) + 𝒱̇_base,
/// > 𝓕 = 𝒲ᵀ𝓕 + 𝒢𝒱̇ − `[ad_𝒱]`ᵀ𝒢𝒱 + 𝓕_tip, τ = 𝒜ᵀ𝓕
#[derive(Clone, Debug)]
pub struct ClosedForm<S = f64> {
    /// 𝒜, 6N × n: the screw axes on the block diagonal; a mimic joint's is in its source joint's column, times its
    /// ratio.
    pub A: DMatrix<S>,
    /// 𝒢, 6N × 6N: the spatial inertias.
    pub G: DMatrix<S>,
    /// 𝒲(θ), 6N × 6N: `[Ad_T_ip]` in the block of link i and its parent p. Nilpotent of the tree's depth.
    pub W: DMatrix<S>,
    /// ℒ(θ) = (I − 𝒲)⁻¹ = I + 𝒲 + 𝒲² + …, 6N × 6N.
    pub L: DMatrix<S>,
    /// `[ad_𝒱]`, 6N × 6N.
    pub ad_V: DMatrix<S>,
    /// `[ad_𝒜θ̇]`, 6N × 6N.
    pub ad_Adtheta: DMatrix<S>,
    /// 𝒱 = ℒ(𝒜θ̇ + 𝒱_base), 6N.
    pub V: DVector<S>,
    /// 𝒱_base, 6N: `[Ad_T_i0]` 𝒱₀ for the links on the base.
    pub V_base: DVector<S>,
    /// 𝒱̇_base, 6N: `[Ad_T_i0]` 𝒱̇₀ for the links on the base, gravity in it.
    pub dV_base: DVector<S>,
    /// 𝓕_tip, 6N: the wrench that each link applies to the environment.
    pub F_tip: DVector<S>,
    /// θ̇.
    pub dtheta: DVector<S>,
    /// The rotors' inertia, n × n: armature on the diagonal, and a JᵀJ of a rotor that several joints turn.
    pub armature: DMatrix<S>,
    /// The armature's part of C, n × n: `a[ω]` for a free joint with armature, else 0.
    pub armature_coriolis: DMatrix<S>,
    /// f(θ̇), the friction in the joints.
    pub friction: DVector<S>,
    /// f_s(θ) = k(θ − θ₀), the springs in the joints.
    pub springs: DVector<S>,
}

impl<S: Entry> Model<S> {
    /// The stacked closed form at (θ, θ̇). O(N³): for reading and comparison.
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn closed_form(&self, theta: &[S], dtheta: &[S], environment: &Environment<S>) -> Result<ClosedForm<S>, Error> {
        self.check_lengths(theta, [("dtheta", dtheta)])?;
        self.check_environment(environment)?;
        let (n, base) = (self.n(), usize::from(self.is_floating()));
        let N = base + self.links.len();
        let mut form = ClosedForm {
            A: DMatrix::zeros(6 * N, n),
            G: DMatrix::zeros(6 * N, 6 * N),
            W: DMatrix::zeros(6 * N, 6 * N),
            L: DMatrix::identity(6 * N, 6 * N),
            ad_V: DMatrix::zeros(6 * N, 6 * N),
            ad_Adtheta: DMatrix::zeros(6 * N, 6 * N),
            V: DVector::zeros(6 * N),
            V_base: DVector::zeros(6 * N),
            dV_base: DVector::zeros(6 * N),
            F_tip: DVector::zeros(6 * N),
            dtheta: DVector::from_column_slice(dtheta),
            armature: DMatrix::zeros(n, n),
            armature_coriolis: DMatrix::zeros(n, n),
            friction: DVector::from_fn(n, |j, _| joint_friction(self, j, dtheta[j])),
            springs: DVector::zeros(n),
        };
        set_armature(self, form.armature.as_mut_slice());
        let mut of_rows = vec![<S as Scalar>::zero(); n * n];
        add_coriolis_blocks(self, dtheta, &mut of_rows);
        form.armature_coriolis = DMatrix::from_row_slice(n, n, &of_rows);
        spring_forces(self, theta, form.springs.as_mut_slice());
        if let (Some(&V), true) = (dtheta.first_chunk(), self.is_floating()) {
            let Ad = matrix6(base_pose(self, theta).inverse().Ad().to_matrix());
            form.A.view_mut((0, 0), (6, 6)).fill_with_identity();
            form.G.view_mut((0, 0), (6, 6)).copy_from(&matrix6(self.base_inertia.to_matrix()));
            form.ad_Adtheta.view_mut((0, 0), (6, 6)).copy_from(&matrix6(Twist::from_array(V).ad().to_matrix()));
            form.V_base.rows_mut(0, 6).copy_from(&(&Ad * vector6(environment.base_twist)));
            form.dV_base.rows_mut(0, 6).copy_from(&(&Ad * vector6(environment.proper_base_acceleration())));
        }
        for (i, link) in self.links.iter().enumerate() {
            let A = self.screw_of(i + 1);
            let frame = |slot: usize| self.body_frame(slot);
            let T = match link.motion {
                // T_{i,p} = e^{−[A]q} M_{i,p}
                Motion::Screw => {
                    let q = link.ratio * theta[link.q] + link.offset;
                    SE3::exp(A * -q) * self.home_in_parent(i + 1).inverse()
                }
                _ => frame(i + 1).inverse() * self.link::<S>(i + 1).transform(theta) * frame(link.parent),
            };
            let Ad = matrix6(T.Ad().to_matrix());
            let G = matrix6(self.body_inertia(i + 1).to_matrix());
            let i = base + i;
            match link.parent {
                0 if !self.is_floating() => {
                    form.V_base.rows_mut(6 * i, 6).copy_from(&(&Ad * vector6(environment.base_twist)));
                    form.dV_base.rows_mut(6 * i, 6).copy_from(&(&Ad * vector6(environment.proper_base_acceleration())));
                }
                parent => {
                    let p = base + parent - 1;
                    form.W.view_mut((6 * i, 6 * p), (6, 6)).copy_from(&Ad);
                    // ℒ = I + 𝒲ℒ, row by row: parents come before their children
                    let carried = Ad * form.L.view((6 * p, 0), (6, 6 * i));
                    form.L.view_mut((6 * i, 0), (6, 6 * i)).copy_from(&carried);
                }
            }
            form.A.view_mut((6 * i, link.j), (6, 1)).copy_from(&vector6(A * link.ratio));
            form.G.view_mut((6 * i, 6 * i), (6, 6)).copy_from(&G);
            let own = match link.motion {
                Motion::Screw => A * (link.ratio * dtheta[link.j]),
                Motion::Ball | Motion::Free => {
                    // (ω, v) in the axes of the joint's first link, which are the link's y, z and x
                    let V: [S; 6] = core::array::from_fn(|k| match link.motion {
                        Motion::Ball if k > 2 => <S as Scalar>::zero(),
                        _ => dtheta[link.j + k / 3 * 3 + (k + 1) % 3],
                    });
                    Twist::from_array(V)
                }
                Motion::Next => Twist::zero(),
            };
            let ad = matrix6(own.ad().to_matrix());
            form.ad_Adtheta.view_mut((6 * i, 6 * i), (6, 6)).copy_from(&ad);
        }
        form.V = &form.L * (&form.A * &form.dtheta + &form.V_base);
        for i in 0..N {
            let V = Twist::from_array(core::array::from_fn(|k| form.V[6 * i + k]));
            form.ad_V.view_mut((6 * i, 6 * i), (6, 6)).copy_from(&matrix6(V.ad().to_matrix()));
        }
        for &(frame, F) in environment.applied {
            let frame = self.frames[frame.0];
            if base + frame.slot > 0 {
                let Ad = matrix6((frame.T.inverse() * self.body_frame(frame.slot)).Ad().to_matrix());
                let mut block = form.F_tip.rows_mut(6 * (base + frame.slot - 1), 6);
                block += Ad.transpose() * DVector::from_column_slice(&F.to_array());
            }
        }
        Ok(form)
    }
}

impl<S: Entry> ClosedForm<S> {
    /// M = 𝒜ᵀℒᵀ𝒢ℒ𝒜 + armature.
    pub fn mass_matrix(&self) -> DMatrix<S> {
        let J = self.jacobians();
        J.tr_mul(&(&self.G * &J)) + &self.armature
    }

    /// The stacked body Jacobians ℒ𝒜, 6N × n: block i is J_ib, with 𝒱_i = J_ib θ̇ and M = Σ J_ibᵀ𝒢_iJ_ib.
    pub fn jacobians(&self) -> DMatrix<S> {
        &self.L * &self.A
    }

    /// The book's matrix that multiplies θ̇ in c = −𝒜ᵀℒᵀ(𝒢ℒ[ad_𝒜θ̇]𝒲 + `[ad_𝒱]`ᵀ𝒢)ℒ𝒜θ̇; base at rest. It gives c, but Ṁ
    /// minus twice this matrix is not skew-symmetric: see [`coriolis_matrix`](Self::coriolis_matrix).
    pub fn book_coriolis_matrix(&self) -> DMatrix<S> {
        let J = self.jacobians();
        let inner = &self.G * self.turned(&J) + self.ad_V.tr_mul(&(&self.G * &J));
        -J.tr_mul(&inner)
    }

    /// ℒ[ad_𝒜θ̇]𝒲J, for J = ℒ𝒜.
    fn turned(&self, J: &DMatrix<S>) -> DMatrix<S> {
        &self.L * (&self.ad_Adtheta * (&self.W * J))
    }

    /// c = −𝒜ᵀℒᵀ(𝒢ℒ[ad_𝒜θ̇](𝒲𝒱 + 𝒱_base) + `[ad_𝒱]`ᵀ𝒢𝒱), the forces of all velocities: Cθ̇ if the base is at rest.
    pub fn velocity_product(&self) -> DVector<S> {
        let turned = &self.L * (&self.ad_Adtheta * (&self.W * &self.V + &self.V_base));
        let inner = &self.G * turned + self.ad_V.tr_mul(&(&self.G * &self.V));
        &self.armature_coriolis * &self.dtheta - self.jacobians().tr_mul(&inner)
    }

    /// g = 𝒜ᵀℒᵀ𝒢ℒ𝒱̇_base.
    pub fn gravity_forces(&self) -> DVector<S> {
        self.jacobians().tr_mul(&(&self.G * (&self.L * &self.dV_base)))
    }

    /// JᵀF = 𝒜ᵀℒᵀ𝓕_tip.
    pub fn tip_forces(&self) -> DVector<S> {
        self.jacobians().tr_mul(&self.F_tip)
    }

    /// 𝒱̇ = ℒ(𝒜θ̈ − [ad_𝒜θ̇](𝒲𝒱 + 𝒱_base) + 𝒱̇_base), 6N, at any motion of the base.
    pub fn accelerations(&self, ddtheta: &DVector<S>) -> DVector<S> {
        &self.L * (&self.A * ddtheta - &self.ad_Adtheta * (&self.W * &self.V + &self.V_base) + &self.dV_base)
    }

    /// 𝓕 = ℒᵀ(𝒢𝒱̇ − `[ad_𝒱]`ᵀ𝒢𝒱 + 𝓕_tip), 6N.
    pub fn wrenches(&self, ddtheta: &DVector<S>) -> DVector<S> {
        let own = &self.G * self.accelerations(ddtheta) - self.ad_V.tr_mul(&(&self.G * &self.V)) + &self.F_tip;
        self.L.tr_mul(&own)
    }

    /// τ = 𝒜ᵀ𝓕 + armature θ̈ + f(θ, θ̇), at any motion of the base.
    pub fn inverse_dynamics(&self, ddtheta: &DVector<S>) -> DVector<S> {
        self.A.tr_mul(&self.wrenches(ddtheta))
            + &self.armature * ddtheta
            + &self.armature_coriolis * &self.dtheta
            + &self.friction
            + &self.springs
    }

    /// Ṁ = −(X + Xᵀ) with X = 𝒜ᵀℒᵀ𝒢ℒ[ad_𝒜θ̇]𝒲ℒ𝒜 (Modern Robotics, exercise 8.7); base at rest.
    pub fn mass_matrix_rate(&self) -> DMatrix<S> {
        let J = self.jacobians();
        let X = J.tr_mul(&(&self.G * self.turned(&J)));
        -(&X + X.transpose())
    }

    /// The Coriolis matrix of the Christoffel symbols, C = 𝒜ᵀℒᵀ(½(𝒢`[ad_𝒱]` − `[ad_𝒱]`ᵀ𝒢 + H(𝒢𝒱)) − 𝒢ℒ[ad_𝒜θ̇]𝒲)ℒ𝒜 with
    /// H(m, f) = `[[−[m], −[f]], [−[f], 0]]`: Cθ̇ = c and Ṁ = C + Cᵀ; base at rest.
    pub fn coriolis_matrix(&self) -> DMatrix<S> {
        let momenta = &self.G * &self.V;
        let mut H = DMatrix::zeros(self.G.nrows(), self.G.ncols());
        for i in 0..momenta.len() / 6 {
            let P = Wrench::from_array(core::array::from_fn(|k| momenta[6 * i + k]));
            let (m, f) = (crate::Mat3::hat(-P.m).rows(), crate::Mat3::hat(-P.f).rows());
            for r in 0..3 {
                for s in 0..3 {
                    H[(6 * i + r, 6 * i + s)] = m[r][s];
                    H[(6 * i + r, 6 * i + 3 + s)] = f[r][s];
                    H[(6 * i + 3 + r, 6 * i + s)] = f[r][s];
                }
            }
        }
        let J = self.jacobians();
        let own = &self.G * (&self.ad_V * &J) - self.ad_V.tr_mul(&(&self.G * &J)) + H * &J;
        let inner = own * S::from_f64(0.5) - &self.G * self.turned(&J);
        J.tr_mul(&inner) + &self.armature_coriolis
    }
}

fn matrix6<S: Entry>(rows: [[S; 6]; 6]) -> DMatrix<S> {
    DMatrix::from_fn(6, 6, |i, j| rows[i][j])
}

fn vector6<S: Entry>(V: Twist<S>) -> DVector<S> {
    DVector::from_column_slice(&V.to_array())
}
