//! The robot's centre of mass; its velocity and acceleration follow from the momentum.

use super::momentum::{composite_inertia, momentum, momentum_matrix, momentum_rate};
use crate::kinematics::base_pose;
use crate::lie::SE3;
use crate::linalg::Vec3;
use crate::model::Model;
use crate::quantities::{Call, DDTHETA, DTHETA, Declaration, Dim, Kernel, Quantity, THETA, THREE, output, sized};
use crate::scalar::Scalar;
use crate::spatial::Wrench;
use crate::workspace::Workspace;

/// The centre of mass of the moving links and a floating base, in {s}, m. NaN if they have no mass.
///
/// Cost O(n), no allocation.
///
/// # Panics
/// When θ is not nq long.
#[cfg_attr(not(debug_assertions), inline(always))]
pub fn center_of_mass<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    workspace: &mut Workspace<S>,
) -> Vec3<S> {
    base_pose(model, theta) * center_in_base(model, theta, workspace)
}

/// The centre of mass in the base's frame. Computing about it avoids the rounding error that the base's distance from
/// {s} would cause.
#[cfg_attr(not(debug_assertions), inline(always))]
fn center_in_base<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    workspace: &mut Workspace<S>,
) -> Vec3<S> {
    composite_inertia(model, theta, workspace).mc * one_over_mass(model)
}

/// A frame with the axes of {s} and its origin at the centre of mass, seen from the base. Afterwards the workspace
/// holds composite inertias.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn centroidal_frame<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    workspace: &mut Workspace<S>,
) -> SE3<S> {
    SE3 { R: base_pose(model, theta).R.inverse(), p: center_in_base(model, theta, workspace) }
}

#[cfg_attr(not(debug_assertions), inline(always))]
fn one_over_mass<S: Scalar + From<C>, C: Scalar>(model: &Model<C>) -> S {
    S::one() / S::from(model.mass())
}

/// See [`center_of_mass`].
#[derive(Clone, Copy, Debug)]
pub struct CenterOfMass;
impl Quantity for CenterOfMass {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "center_of_mass",
        "c, the centre of mass of all that moves, in {s}",
        &[THETA],
        &[output("c", THREE, "m")],
    )
    .needs_mass();
}
impl Kernel for CenterOfMass {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, ..], [p, ..]) = (c.inputs, c.outputs);
        p.copy_from_slice(&center_of_mass(c.model, theta, &mut c.memory.workspace).0);
    }
}

/// ċ = f/m, f the linear [`momentum`].
#[derive(Clone, Copy, Debug)]
pub struct CenterOfMassVelocity;
impl Quantity for CenterOfMassVelocity {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "center_of_mass_velocity",
        "ċ of the centre of mass, in the axes of {s}",
        &[THETA, DTHETA],
        &[output("dc", THREE, "m/s")],
    )
    .needs_mass();
}
impl Kernel for CenterOfMassVelocity {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, dtheta, ..], [dc, ..]) = (c.inputs, c.outputs);
        let f = momentum(c.model, theta, dtheta, &mut c.memory.workspace).f;
        dc.copy_from_slice(&(f * one_over_mass(c.model)).0);
    }
}

/// c̈ = ḟ/m, f the linear [`momentum`].
#[derive(Clone, Copy, Debug)]
pub struct CenterOfMassAcceleration;
impl Quantity for CenterOfMassAcceleration {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "center_of_mass_acceleration",
        "c̈ of the centre of mass, in the axes of {s}",
        &[THETA, DTHETA, DDTHETA],
        &[output("ddc", THREE, "m/s²")],
    )
    .needs_mass();
}
impl Kernel for CenterOfMassAcceleration {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, dtheta, ddtheta, ..], [ddc, ..]) = (c.inputs, c.outputs);
        let df = momentum_rate(c.model, theta, dtheta, ddtheta, &mut c.memory.workspace).f;
        ddc.copy_from_slice(&(df * one_over_mass(c.model)).0);
    }
}

/// The linear rows of [`momentum_matrix`] over the mass.
#[derive(Clone, Copy, Debug)]
pub struct CenterOfMassJacobian;
impl Quantity for CenterOfMassJacobian {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "center_of_mass_jacobian",
        "J of the centre of mass: ċ = Jθ̇, in the axes of {s}",
        &[THETA],
        &[output("J", &[Dim::Is(3), Dim::N], "m or 1")],
    )
    .needs_mass();
}
impl Kernel for CenterOfMassJacobian {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, ..], [J, ..], n) = (c.inputs, c.outputs, c.model.n());
        let columns = sized(&mut c.memory.wrenches, n, Wrench::zero());
        momentum_matrix(c.model, theta, &mut c.memory.workspace, columns);
        let scale = one_over_mass(c.model);
        for (j, column) in columns.iter().enumerate() {
            for (row, entry) in (column.f * scale).0.into_iter().enumerate() {
                J[row * n + j] = entry;
            }
        }
    }
}
