//! Articulated bodies of grippers: a joint and its mimic joints on the same link p, siblings, free their links
//! together. d and the columns ĜA of all add up, in p's coordinates, at the first of them. Else see
//! `forward_dynamics.rs`.

use crate::model::Model;
use crate::scalar::Scalar;
use crate::spatial::Wrench;
use crate::workspace::{Articulated, Recursion, Workspace};

/// Tips to base: frees each joint, and hands the inertia and the wrench that are left to its parent.
#[cfg_attr(not(debug_assertions), inline(always))]
#[rustfmt::skip]
pub(super) fn free_joints<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, workspace: &mut Workspace<S>) {
    let slots = model.links.len() + 1;
    let Workspace { recursion: Recursion { T, F, .. }, articulated: Articulated { c, G_hat, U, u }, pivots: d, .. } = workspace;
    let (T, F, c, G_hat, U) = (&T[..slots], &mut F[..slots], &c[..slots], &mut G_hat[..slots], &mut U[..slots]);
    for (i, link) in model.outward::<S>() {
        (U[i], d[link.j]) = (Wrench::zero(), S::from(model.armature[link.j]));
    }
    for (i, link) in model.inward::<S>() {
        let (A, j, p, Ad) = (link.A(), link.j, link.parent, T[i].Ad());
        let (GA, first, moves_parent) = (G_hat[i] * A, model.first_sibling(i), p > 0 || model.is_floating());
        d[j] += A * GA;
        if first == 0 {
            let one_over_d = S::one() / d[j];
            u[j] = (u[j] - A * F[i]) * one_over_d;
            U[i] = GA * one_over_d;
            if moves_parent {
                let G_a  = G_hat[i].minus_outer(GA, one_over_d);
                let F_a  = G_a.mul_add(c[i], F[i] + GA * u[j]);
                G_hat[p] = G_a.congruence_add(Ad, G_hat[p]);
                F[p]     = Ad.transpose().mul_add(F_a, F[p]);
            }
            continue;
        }
        // the link goes to its parent as it is; its joint is freed with the last of its siblings
        let F_i  = G_hat[i].mul_add(c[i], F[i]);
        u[j]     -= A * F_i;
        U[first] = Ad.transpose().mul_add(GA, U[first]);
        if moves_parent {
            G_hat[p] = G_hat[i].congruence_add(Ad, G_hat[p]);
            F[p]     = Ad.transpose().mul_add(F_i, F[p]);
        }
        if i == first {
            let (GA, one_over_d) = (U[i], S::one() / d[j]);
            u[j] = u[j] * one_over_d;
            U[i] = GA * one_over_d;
            if moves_parent {
                G_hat[p] = G_hat[p].minus_outer(GA, one_over_d);
                F[p] += GA * u[j];
            }
        }
    }
}

/// Base to tips: the accelerations.
#[cfg_attr(not(debug_assertions), inline(always))]
#[rustfmt::skip]
pub(super) fn accelerations<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, workspace: &mut Workspace<S>, ddtheta: &mut [S],
) {
    let slots = model.links.len() + 1;
    let Workspace { recursion: Recursion { T, dV, .. }, articulated: Articulated { c, U, u, .. }, .. } = workspace;
    let (T, dV, c, U) = (&T[..slots], &mut dV[..slots], &c[..slots], &U[..slots]);
    for (i, link) in model.outward::<S>() {
        let (dV_p, j, first) = (dV[link.parent], link.j, model.first_sibling(i));
        let dV_i = T[i].Ad() * dV_p + c[i];
        if first == 0 {
            ddtheta[j] = u[j] - dV_i.dot(U[i]);
        } else if first == i {
            ddtheta[j] = u[j] - dV_p.dot(U[i]);                                       // U is in the coordinates of p
        }
        dV[i] = dV_i + link.A() * ddtheta[j];
    }
}
