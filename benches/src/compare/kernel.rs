//! The kernels that both sides have.

use crate::peer::Algorithm;
use mozzi::native::{self, Workspace};
use mozzi::{Environment, Model};
use mozzi_benches::State;

/// One kernel: mozzi's function, what Pinocchio calls it, and how many numbers it gives for n joints.
pub struct Kernel {
    pub name: &'static str,
    pub run: fn(&Model, State, &Environment, &mut Workspace, &mut [f64]),
    pub peer: &'static [Algorithm],
    pub is_matrix: bool,
    /// Pinocchio fills the upper triangle alone, mozzi the whole.
    pub is_symmetric: bool,
}

/// In the order of the table.
pub const KERNELS: [Kernel; 5] = [
    Kernel {
        name: "inverse_dynamics",
        run: |model, [theta, dtheta, ddtheta, _], environment, workspace, out| {
            native::inverse_dynamics(model, theta, dtheta, ddtheta, environment, workspace, out);
        },
        peer: &[Algorithm::Rnea],
        is_matrix: false,
        is_symmetric: false,
    },
    Kernel {
        name: "forward_dynamics",
        run: |model, [theta, dtheta, _, tau], environment, workspace, out| {
            native::forward_dynamics(model, theta, dtheta, tau, environment, workspace, out);
        },
        peer: &[Algorithm::AbaWorld, Algorithm::AbaLocal],
        is_matrix: false,
        is_symmetric: false,
    },
    Kernel {
        name: "mass_matrix",
        run: |model, [theta, ..], _, workspace, out| native::mass_matrix(model, theta, workspace, out),
        peer: &[Algorithm::CrbaWorld, Algorithm::CrbaLocal],
        is_matrix: true,
        is_symmetric: true,
    },
    Kernel {
        name: "coriolis_matrix",
        run: |model, [theta, dtheta, ..], _, workspace, out| {
            native::coriolis_matrix(model, theta, dtheta, workspace, out);
        },
        peer: &[Algorithm::Coriolis],
        is_matrix: true,
        is_symmetric: false,
    },
    Kernel {
        name: "bias_forces",
        run: |model, [theta, dtheta, ..], environment, workspace, out| {
            native::bias_forces(model, theta, dtheta, environment, workspace, out);
        },
        peer: &[Algorithm::NonLinearEffects],
        is_matrix: false,
        is_symmetric: false,
    },
];

impl Kernel {
    /// How many numbers it gives.
    pub fn length(&self, model: &Model) -> usize {
        if self.is_matrix { model.n() * model.n() } else { model.n() }
    }

    /// The largest difference between mozzi's result (by rows) and Pinocchio's (by columns), over the largest entry.
    /// Of a free base Pinocchio has the linear three first.
    pub fn difference(&self, model: &Model, ours: &[f64], theirs: &[f64]) -> f64 {
        let (n, base) = (model.n(), model.base().velocities());
        let place = |j: usize| if j < base { (j + 3) % 6 } else { j };
        let largest = theirs.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let mut worst = 0.0_f64;
        for (k, x) in ours.iter().enumerate() {
            let (row, column) = (place(k / n), place(k % n));
            let y = match (self.is_matrix, self.is_symmetric && row > column) {
                (false, _) => theirs[place(k)],
                (true, false) => theirs[column * n + row],
                (true, true) => theirs[row * n + column], // its mirror image, in the upper triangle
            };
            worst = if (x - y).abs() <= worst { worst } else { (x - y).abs() }; // NaN stays
        }
        worst / largest
    }
}
