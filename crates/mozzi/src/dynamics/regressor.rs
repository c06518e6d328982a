//! Forces and energies, linear in the model's parameters: the regressor (Khosla and Kanade 1985; Atkeson, An and
//! Hollerbach 1986).

use super::armature::of_free_joint;
use super::inverse_dynamics::newton_euler;
use crate::kinematics::{base_pose, joint_transforms, link_twists};
use crate::lie::SE3;
use crate::linalg::Vec3;
use crate::model::Error;
use crate::model::{Environment, Freedom, JOINT_PARAMETERS, Model, Spring};
use crate::quantities::{Call, DDTHETA, DTHETA, Declaration, Dim, Kernel, Quantity, THETA, Uses, output};
use crate::scalar::{Scalar, pass};
use crate::spatial::{SpatialInertia, Twist};
use crate::workspace::{Recursion, Workspace};
use nalgebra::DMatrix;
use nalgebra::RowDVector;

pass! {
/// The regressor Y(θ, θ̇, θ̈), n × p with p = [`parameter_count`](Model::parameter_count), row-major into `Y`:
///
/// > Y π = M(θ)θ̈ + c(θ, θ̇) + g(θ) + f(θ, θ̇)
///
/// with π = [`parameters`](Model::parameters). Gravity and a moving {s} are included; `environment.applied` is not,
/// since JᵀF depends on no parameter: τ = Y π + JᵀF.
///
/// The wrench that a body needs is linear in its ten parameters: its columns are the wrenches of ten unit inertias in
/// the link's frame, each felt by every joint between the body and the base.
///
/// > F_k = 𝒢_k 𝒱̇ − `[ad_𝒱]`ᵀ 𝒢_k 𝒱, Y_jk = Σ ratio A_jᵀ `[Ad_T]`ᵀ F_k
///
/// A joint's armature, damping, friction, stiffness and preload have the columns θ̈_j, θ̇_j, sgn θ̇_j, θ_j and −1 in
/// its own row. A ball has the first four in each of its three rows, with its rotation vector in place of θ_j. A free
/// joint has the first three in each of its six rows, with ω × v added to the linear θ̈. A rotor's armature has the
/// column Jᵀ Jθ̈, J the row of its gear ratios. Entries are N m or N per unit of the parameter.
///
/// Cost O(N · depth), no allocation.
///
/// # Panics
/// When θ is not nq long, θ̇ or θ̈ not n, or `Y` not n p.
pub fn regressor<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, theta: &[S], dtheta: &[S], ddtheta: &[S],
    environment: &Environment<S>, workspace: &mut Workspace<S>, Y: &mut [S],
) {
    let (n, p) = (model.n(), model.parameter_count());
    assert!(Y.len() == n * p, "Y has {} entries, expected n p = {}", Y.len(), n * p);
    // 𝒱 and 𝒱̇ of each link, as in inverse dynamics; without its forces
    let mut tau = core::mem::take(&mut workspace.vector);
    newton_euler(model, theta, dtheta, ddtheta, environment, workspace, &mut tau);
    workspace.vector = tau;
    let Workspace { recursion: Recursion { T, V, dV, .. }, .. } = workspace;

    Y.fill(S::zero());
    for (body, slot) in model.bodies().enumerate() {
        let Ad = model.link_frame(slot).map(S::from).inverse().Ad();                     // to the link's frame
        let (V_b, dV_b) = (Ad * V[slot], Ad * dV[slot]);
        for (k, G) in SpatialInertia::units().into_iter().enumerate() {
            let column = 10 * body + k;
            let F_b = G * dV_b - V_b.ad().transpose() * (G * V_b);               // (8.53) of a unit
            let mut F = Ad.transpose() * F_b;
            for (i, link) in model.to_base::<S>(slot) {
                Y[link.j * p + column] += link.A() * F;             // (8.54)
                F = T[i].Ad().transpose() * F;                      // (8.53)
            }
            if model.is_floating() {
                for (row, entry) in F.to_array().into_iter().enumerate() {
                    Y[row * p + column] = entry;
                }
            }
        }
    }
    joint_entries(model, theta, dtheta, ddtheta, |row, column, entry| Y[row * p + column] += entry);
}
}

/// The entries of Y that belong to joints and rotors: calls `add(row, column, entry)` for each.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn joint_entries<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    dtheta: &[S],
    ddtheta: &[S],
    mut add: impl FnMut(usize, usize, S),
) {
    for (k, place) in model.places().iter().enumerate() {
        let column = model.parameters_of_joint(k).start;
        for j in place.velocities() {
            add(j, column, ddtheta[j]);
            add(j, column + 1, dtheta[j]);
            add(j, column + 2, dtheta[j].sgn());
        }
        if place.freedom == Freedom::Free {
            let (w, v) = of_free_joint(dtheta, place.j);
            for (k, x) in w.cross(v).0.into_iter().enumerate() {
                add(place.j + 3 + k, column, x);
            }
        }
        if place.freedom != Freedom::Free {
            for (j, stretch) in place.velocities().zip(Spring::<C>::stretch(place, theta)) {
                add(j, column + 3, stretch);
            }
        }
        if place.freedom == Freedom::One {
            add(place.j, column + 4, -S::one());
        }
    }
    let first = model.parameter_count() - model.rotors.len();
    for (column, rotor) in (first..).zip(&model.rotors) {
        let rate = rotor.rate(ddtheta);
        for &(j, entry) in &rotor.J {
            add(j, column, S::from(entry) * rate);
        }
    }
}

pass! {
/// The energies' regressors, p numbers each: 𝒦 = y_𝒦 π and 𝒫 = y_𝒫 π + 𝒫₀, as defined in
/// [`kinetic_energy`](super::kinetic_energy) and [`potential_energy`](super::potential_energy), with π =
/// [`parameters`](Model::parameters); `V_s` is the twist of {s} and 𝒫₀ = Σ ½k(θ₀ − offset)² the springs' energy
/// at θ = 0.
///
/// > y_𝒦 = ½ 𝒱ᵀ𝒢_k𝒱 of unit inertias 𝒢_k, ½ θ̇² of armatures; y_𝒫 = −gᵀ`p_sb` of masses, −R_sbᵀg of first moments, ½ θ²
/// > (½ ‖φ‖² of a ball) of
/// > stiffnesses, −θ of preloads
///
/// Joules per unit of the parameter. Cost O(N), no allocation.
///
/// # Panics
/// When θ is not nq long, θ̇ not n, or `kinetic` or `potential` not p.
pub fn energy_regressors<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, theta: &[S], dtheta: &[S], V_s: Twist<S>, gravity: Vec3<S>,
    workspace: &mut Workspace<S>, kinetic: &mut [S], potential: &mut [S],
) {
    let p = model.parameter_count();
    assert!(kinetic.len() == p && potential.len() == p, "expected {p} entries, one for each parameter");
    model.assert_lengths(theta.len(), [dtheta.len()]);
    joint_transforms(model, theta, workspace);
    link_twists(model, theta, dtheta, V_s, workspace);
    let (Workspace { recursion: Recursion { T, V, .. }, .. }, half) = (workspace, S::from_f64(0.5));

    kinetic.fill(S::zero());
    potential.fill(S::zero());
    T[0] = base_pose(model, theta);
    for (i, link) in model.outward::<S>() {
        T[i] = T[link.parent] * T[i].inverse();                                  // T_si
    }
    for (body, slot) in model.bodies().enumerate() {
        let T_b = model.link_frame(slot).map(S::from);
        let (V_b, SE3 { R, p }) = (T_b.inverse().Ad() * V[slot], T[slot] * T_b);
        for (k, entry) in SpatialInertia::by_parameters(V_b, V_b).into_iter().enumerate() {
            kinetic[10 * body + k] = half * entry;
        }
        let down = R.inverse() * gravity;
        potential[10 * body] = -gravity.dot(p);
        potential[10 * body + 1..][..3].copy_from_slice(&(-down).0);
    }
    let first = 10 * model.bodies().count();
    for (y, rotor) in kinetic[p - model.rotors.len()..].iter_mut().zip(&model.rotors) {
        let rate = rotor.rate(dtheta);
        *y = half * rate * rate;
    }
    let of_joints = kinetic[first..].chunks_mut(JOINT_PARAMETERS).zip(potential[first..].chunks_mut(JOINT_PARAMETERS));
    for ((kinetic, potential), place) in of_joints.zip(model.places()) {
        kinetic[0] = place.velocities().fold(S::zero(), |sum, j| (half * dtheta[j]).mul_add(dtheta[j], sum));
        if place.freedom != Freedom::Free {
            let stretch = Vec3(Spring::<C>::stretch(place, theta));
            potential[3] = half * stretch.dot(stretch);
        }
        if place.freedom == Freedom::One {
            potential[4] = -theta[place.q];
        }
    }
}
}

/// See [`regressor`].
#[derive(Clone, Copy, Debug)]
pub struct Regressor;
#[doc(hidden)]
impl Quantity for Regressor {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "regressor",
        "Y(θ, θ̇, θ̈): τ = Yπ + JᵀF, with π the robot's parameters",
        &[THETA, DTHETA, DDTHETA],
        &[output("Y", &[Dim::N, Dim::Parameters], "N m or N, each per unit of its parameter")],
    )
    .uses(Uses::GRAVITY.and(Uses::BASE_TWIST).and(Uses::BASE_ACCELERATION));
}
#[doc(hidden)]
impl Kernel for Regressor {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, dtheta, ddtheta, ..], [Y, ..]) = (c.inputs, c.outputs);
        regressor(c.model, theta, dtheta, ddtheta, c.environment, &mut c.memory.workspace, Y);
    }
}

/// See [`energy_regressors`].
#[derive(Clone, Copy, Debug)]
pub struct EnergyRegressors;
#[doc(hidden)]
impl Quantity for EnergyRegressors {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "energy_regressors",
        "the rows that give the kinetic and the potential energy of the parameters π",
        &[THETA, DTHETA],
        &[
            output("kinetic", &[Dim::Parameters], "J, each per unit of its parameter"),
            output("potential", &[Dim::Parameters], "J, each per unit of its parameter"),
        ],
    )
    .uses(Uses::GRAVITY.and(Uses::BASE_TWIST))
    .is_of_masses();
}
#[doc(hidden)]
impl Kernel for EnergyRegressors {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, dtheta, ..], [kinetic, potential, ..], e) = (c.inputs, c.outputs, c.environment);
        energy_regressors(c.model, theta, dtheta, e.base_twist, e.gravity, &mut c.memory.workspace, kinetic, potential);
    }
}

impl Model<f64> {
    /// Y(θ, θ̇, θ̈), n × p: see [`regressor`](regressor()). τ = Y π + JᵀF with π =
    /// [`parameters`](Model::parameters).
    ///
    /// ```
    /// use mozzi::{Description, HomeFrames, SE3, ScrewAxis, Screws, Solid, nalgebra::DVector};
    /// let rod = Solid::Box([1.0, 0.02, 0.02]).inertia(1.0);
    /// let home = [0.5, 1.5, 2.0].map(|x| SE3::translation([x, 0.0, 0.0]));
    /// let S = [0.0, 1.0].map(|x| ScrewAxis::from_line([0.0, -1.0, 0.0], [x, 0.0, 0.0], 0.0).expect("unit"));
    /// let arm = Description::from_screws("arm", HomeFrames::Base(&home), &[rod; 2], Screws::Space(&S))?.build()?;
    ///
    /// let (theta, dtheta, ddtheta) = ([0.3, -0.5], [1.0, 0.2], [0.0, 2.0]);
    /// let Y = arm.regressor(&theta, &dtheta, &ddtheta, &arm.environment())?;
    /// let tau = arm.inverse_dynamics(&theta, &dtheta, &ddtheta, &arm.environment())?;
    /// assert!((Y * DVector::from_vec(arm.parameters()) - tau).amax() < 1e-12);
    /// // of 2 · 10 + 2 · 5 parameters, fifteen combinations can be identified from forces and motions
    /// assert_eq!((arm.parameter_count(), arm.base_parameters().count()), (30, 15));
    /// # Ok::<(), mozzi::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn regressor(
        &self,
        theta: &[f64],
        dtheta: &[f64],
        ddtheta: &[f64],
        environment: &Environment,
    ) -> Result<DMatrix<f64>, Error> {
        let Y = self.compute(Regressor, &[theta, dtheta, ddtheta], environment)?;
        Ok(DMatrix::from_row_slice(self.n(), self.parameter_count(), &Y[0]))
    }

    /// (y_𝒦, y_𝒫) with 𝒦 = y_𝒦 π and 𝒫 = y_𝒫 π + 𝒫₀, under the model's gravity and with {s} at rest: see
    /// [`energy_regressors`](energy_regressors()).
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn energy_regressors(
        &self,
        theta: &[f64],
        dtheta: &[f64],
    ) -> Result<(RowDVector<f64>, RowDVector<f64>), Error> {
        let found = self.compute(EnergyRegressors, &[theta, dtheta], &self.environment())?;
        let mut found = found.into_iter().map(RowDVector::from_vec);
        let mut next = || found.next().expect("two rows");
        Ok((next(), next()))
    }
}
