//! The kernels on `f64`, with the instruction set of the machine that runs them: fused multiply-add where the processor has
//! it, found once when the [`Workspace`] is made, else plain `f64`. For control loops: no allocation.
//!
//! Results agree with the plain kernels to rounding, not bit for bit. AVX2 and AVX-512 are deliberately left out: for one state
//! they make code slower.
//!
//! Derivatives of g, JᵀF and Mx alone are not here: ∂τ/∂θ of [`inverse_dynamics_derivatives`] at θ̇ = 0 is their sum, and each entry is
//! compiled once more for each instruction set.
//!
//! ```
//! # use mozzi::{Description, fast};
//! # fn example(model: &mozzi::Model) {
//! let mut workspace = fast::Workspace::new(model);
//! let (theta, dtheta, ddtheta) = (vec![0.1; model.nq()], vec![0.0; model.n()], vec![0.0; model.n()]);
//! let mut tau = vec![0.0; model.n()];
//! fast::inverse_dynamics(model, &theta, &dtheta, &ddtheta, &model.environment(), &mut workspace, &mut tau);
//! # }
//! ```

use crate::dynamics as kernel;
use crate::model::{Environment, FrameId, Model};
use crate::scalar::Fused;
use crate::spatial::Wrench;
use alloc::vec::Vec;

/// Memory for the kernels of this module, and the choice of the instruction set.
#[derive(Clone, Debug)]
pub struct Workspace(Inner);

#[derive(Clone, Debug)]
#[allow(clippy::large_enum_variant)] // one per thread, not in lists
enum Inner {
    Plain(crate::Workspace<f64>),
    /// Made only where the processor has FMA: the proof that the fused entries may be called.
    Fused(crate::Workspace<Fused>, Vec<(FrameId, Wrench<Fused>)>),
}

impl Workspace {
    /// Memory for this model.
    pub fn new(model: &Model) -> Self {
        #[cfg(target_arch = "x86_64")]
        if std::is_x86_feature_detected!("fma") {
            return Workspace(Inner::Fused(crate::Workspace::new(model), Vec::with_capacity(model.frames().len())));
        }
        Self::portable(model)
    }

    /// Memory for this model, on plain `f64` whatever the processor has: bit for bit the plain kernels' results.
    pub fn portable(model: &Model) -> Self {
        Workspace(Inner::Plain(crate::Workspace::new(model)))
    }

    /// "fma" or "portable".
    pub fn instruction_set(&self) -> &'static str {
        match self.0 {
            Inner::Plain(_) => "portable",
            Inner::Fused(..) => "fma",
        }
    }

    /// Was all that the last [`forward_dynamics`] or [`forward_dynamics_derivatives`] divided by far from rounding? See
    /// [`Workspace::is_regular`](crate::Workspace::is_regular).
    pub fn is_regular(&self) -> bool {
        match &self.0 {
            Inner::Plain(workspace) => workspace.is_regular(),
            Inner::Fused(workspace, _) => workspace.is_regular(),
        }
    }
}

fn fused(x: &[f64]) -> &[Fused] {
    // SAFETY: Fused is a transparent f64.
    unsafe { core::slice::from_raw_parts(x.as_ptr().cast(), x.len()) }
}
fn fused_mut(x: &mut [f64]) -> &mut [Fused] {
    // SAFETY: Fused is a transparent f64, and the borrow is handed on.
    unsafe { core::slice::from_raw_parts_mut(x.as_mut_ptr().cast(), x.len()) }
}

/// The environment with fused numbers, its wrenches in `applied`.
fn fused_environment<'a>(e: &Environment, applied: &'a mut Vec<(FrameId, Wrench<Fused>)>) -> Environment<'a, Fused> {
    applied.clear();
    applied.extend(e.applied.iter().map(|&(frame, F)| (frame, F.map(Fused))));
    Environment {
        gravity: e.gravity.map(Fused),
        base_twist: e.base_twist.map(Fused),
        base_acceleration: e.base_acceleration.map(Fused),
        applied,
    }
}

/// One entry: the same kernel on plain or on fused numbers, the latter compiled for FMA (and AVX, which it implies).
macro_rules! entry {
    ($(#[$doc:meta])* $name:ident($($in:ident),*; $([$environment:ident])? $out:ident)) => {
        $(#[$doc])*
        pub fn $name(model: &Model, $($in: &[f64],)* $($environment: &Environment,)? workspace: &mut Workspace, $out: &mut [f64]) {
            #[cfg_attr(target_arch = "x86_64", target_feature(enable = "fma"))]
            fn entry(
                model: &Model, $($in: &[Fused],)* $($environment: &Environment<Fused>,)?
                workspace: &mut crate::Workspace<Fused>, $out: &mut [Fused],
            ) {
                kernel::$name(model, $($in,)* $($environment,)? workspace, $out);
            }
            match &mut workspace.0 {
                Inner::Plain(workspace) => kernel::$name(model, $($in,)* $($environment,)? workspace, $out),
                Inner::Fused(workspace, _applied) => {
                    $(let $environment = &fused_environment($environment, _applied);)?
                    #[allow(unused_unsafe)] // no target feature elsewhere
                    // SAFETY: the variant exists only where the processor has FMA.
                    unsafe { entry(model, $(fused($in),)* $($environment,)? workspace, fused_mut($out)) }
                }
            }
        }
    };
}

entry! {
    /// [`inverse_dynamics`](kernel::inverse_dynamics()).
    ///
    /// # Panics
    /// On slices of a wrong length.
    inverse_dynamics(theta, dtheta, ddtheta; [environment] tau)
}
entry! {
    /// [`forward_dynamics`](kernel::forward_dynamics()).
    ///
    /// # Panics
    /// On slices of a wrong length.
    forward_dynamics(theta, dtheta, tau; [environment] ddtheta)
}
entry! {
    /// [`bias_forces`](kernel::bias_forces()).
    ///
    /// # Panics
    /// On slices of a wrong length.
    bias_forces(theta, dtheta; [environment] h)
}
entry! {
    /// [`velocity_product`](kernel::velocity_product).
    ///
    /// # Panics
    /// On slices of a wrong length.
    velocity_product(theta, dtheta; c)
}
entry! {
    /// [`mass_matrix`](kernel::mass_matrix()).
    ///
    /// # Panics
    /// On slices of a wrong length.
    mass_matrix(theta; M)
}
entry! {
    /// [`coriolis_matrix`](kernel::coriolis_matrix()).
    ///
    /// # Panics
    /// On slices of a wrong length.
    coriolis_matrix(theta, dtheta; C)
}

/// [`inverse_dynamics_derivatives`](kernel::inverse_dynamics_derivatives()): `[∂τ/∂θ, ∂τ/∂θ̇, ∂τ/∂θ̈ = M]`.
///
/// # Panics
/// On slices of a wrong length.
pub fn inverse_dynamics_derivatives(
    model: &Model,
    theta: &[f64],
    dtheta: &[f64],
    ddtheta: &[f64],
    environment: &Environment,
    workspace: &mut Workspace,
    derivatives: [&mut [f64]; 3],
) {
    #[cfg_attr(target_arch = "x86_64", target_feature(enable = "fma"))]
    fn entry(
        model: &Model,
        [theta, dtheta, ddtheta]: [&[Fused]; 3],
        environment: &Environment<Fused>,
        workspace: &mut crate::Workspace<Fused>,
        derivatives: [&mut [Fused]; 3],
    ) {
        kernel::inverse_dynamics_derivatives(model, theta, dtheta, ddtheta, environment, workspace, derivatives);
    }
    match &mut workspace.0 {
        Inner::Plain(workspace) => {
            kernel::inverse_dynamics_derivatives(model, theta, dtheta, ddtheta, environment, workspace, derivatives);
        }
        Inner::Fused(workspace, applied) => {
            let environment = &fused_environment(environment, applied);
            let (state, derivatives) = ([theta, dtheta, ddtheta].map(fused), derivatives.map(fused_mut));
            #[allow(unused_unsafe)] // no target feature elsewhere
            // SAFETY: the variant exists only where the processor has FMA.
            unsafe {
                entry(model, state, environment, workspace, derivatives)
            }
        }
    }
}

/// [`forward_dynamics_derivatives`](kernel::forward_dynamics_derivatives()): θ̈, and `[∂θ̈/∂θ, ∂θ̈/∂θ̇, ∂θ̈/∂τ = M⁻¹]`.
///
/// # Panics
/// On slices of a wrong length.
#[allow(clippy::too_many_arguments)] // the kernel's
pub fn forward_dynamics_derivatives(
    model: &Model,
    theta: &[f64],
    dtheta: &[f64],
    tau: &[f64],
    environment: &Environment,
    workspace: &mut Workspace,
    ddtheta: &mut [f64],
    derivatives: [&mut [f64]; 3],
) {
    #[cfg_attr(target_arch = "x86_64", target_feature(enable = "fma"))]
    fn entry(
        model: &Model,
        [theta, dtheta, tau]: [&[Fused]; 3],
        environment: &Environment<Fused>,
        workspace: &mut crate::Workspace<Fused>,
        ddtheta: &mut [Fused],
        derivatives: [&mut [Fused]; 3],
    ) {
        kernel::forward_dynamics_derivatives(model, theta, dtheta, tau, environment, workspace, ddtheta, derivatives);
    }
    match &mut workspace.0 {
        Inner::Plain(w) => {
            kernel::forward_dynamics_derivatives(model, theta, dtheta, tau, environment, w, ddtheta, derivatives);
        }
        Inner::Fused(workspace, applied) => {
            let environment = &fused_environment(environment, applied);
            let (state, derivatives) = ([theta, dtheta, tau].map(fused), derivatives.map(fused_mut));
            #[allow(unused_unsafe)] // no target feature elsewhere
            // SAFETY: the variant exists only where the processor has FMA.
            unsafe {
                entry(model, state, environment, workspace, fused_mut(ddtheta), derivatives)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{state, tree, wrench};

    #[test]
    fn the_instruction_set_changes_results_by_rounding_alone() {
        for (seed, mimics) in [(1, 0), (2, 3)] {
            let model = tree(seed, 9, mimics);
            let [theta, dtheta, x] = state(&model, seed);
            let n = model.n();
            let applied = [(model.end_effector().expect("named"), wrench(1))];
            let environment = Environment { applied: &applied, ..model.environment() };
            let run = |mut w: Workspace| {
                let (mut tau, mut ddtheta, mut c, mut h) = (vec![0.0; n], vec![0.0; n], vec![0.0; n], vec![0.0; n]);
                let (mut M, mut C) = (vec![0.0; n * n], vec![0.0; n * n]);
                inverse_dynamics(&model, &theta, &dtheta, &x, &environment, &mut w, &mut tau);
                forward_dynamics(&model, &theta, &dtheta, &x, &environment, &mut w, &mut ddtheta);
                bias_forces(&model, &theta, &dtheta, &environment, &mut w, &mut h);
                velocity_product(&model, &theta, &dtheta, &mut w, &mut c);
                mass_matrix(&model, &theta, &mut w, &mut M);
                coriolis_matrix(&model, &theta, &dtheta, &mut w, &mut C);
                let mut by = [(); 6].map(|()| vec![0.0; n * n]);
                assert!(w.is_regular());
                let ([a, b, c_, d, e, f], mut again) = (by.each_mut().map(|x| &mut x[..]), vec![0.0; n]);
                inverse_dynamics_derivatives(&model, &theta, &dtheta, &x, &environment, &mut w, [a, b, c_]);
                let three = [d, e, f];
                forward_dynamics_derivatives(&model, &theta, &dtheta, &x, &environment, &mut w, &mut again, three);
                [vec![tau, ddtheta, h, c, M, C, again], by.to_vec()].concat()
            };
            let portable = run(Workspace::portable(&model));
            for (a, b) in run(Workspace::new(&model)).iter().zip(&portable) {
                let scale = b.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
                assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-10 * scale));
            }
            // the portable path is the plain kernel, bit for bit
            let mut tau = vec![0.0; n];
            kernel::inverse_dynamics(
                &model,
                &theta,
                &dtheta,
                &x,
                &environment,
                &mut crate::Workspace::new(&model),
                &mut tau,
            );
            assert_eq!(tau, portable[0]);
        }
    }
}
