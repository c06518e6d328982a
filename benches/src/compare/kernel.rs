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
    /// How many n × n matrices it gives; 0 for a vector.
    pub matrices: usize,
    /// Pinocchio fills the upper triangle alone, mozzi the whole.
    pub is_symmetric: bool,
}

/// In the order of the table.
pub const KERNELS: [Kernel; 7] = [
    Kernel {
        name: "inverse_dynamics",
        run: |model, [theta, dtheta, ddtheta, _], environment, workspace, out| {
            native::inverse_dynamics(model, theta, dtheta, ddtheta, environment, workspace, out);
        },
        peer: &[Algorithm::Rnea],
        matrices: 0,
        is_symmetric: false,
    },
    Kernel {
        name: "forward_dynamics",
        run: |model, [theta, dtheta, _, tau], environment, workspace, out| {
            native::forward_dynamics(model, theta, dtheta, tau, environment, workspace, out);
        },
        peer: &[Algorithm::AbaWorld, Algorithm::AbaLocal],
        matrices: 0,
        is_symmetric: false,
    },
    Kernel {
        name: "mass_matrix",
        run: |model, [theta, ..], _, workspace, out| native::mass_matrix(model, theta, workspace, out),
        peer: &[Algorithm::CrbaWorld, Algorithm::CrbaLocal],
        matrices: 1,
        is_symmetric: true,
    },
    Kernel {
        name: "coriolis_matrix",
        run: |model, [theta, dtheta, ..], _, workspace, out| {
            native::coriolis_matrix(model, theta, dtheta, workspace, out);
        },
        peer: &[Algorithm::Coriolis],
        matrices: 1,
        is_symmetric: false,
    },
    Kernel {
        name: "bias_forces",
        run: |model, [theta, dtheta, ..], environment, workspace, out| {
            native::bias_forces(model, theta, dtheta, environment, workspace, out);
        },
        peer: &[Algorithm::NonLinearEffects],
        matrices: 0,
        is_symmetric: false,
    },
    Kernel {
        name: "inverse_dynamics_derivatives",
        run: |model, [theta, dtheta, ddtheta, _], environment, workspace, out| {
            let (_, derivatives) = parts(model, out);
            native::inverse_dynamics_derivatives(model, theta, dtheta, ddtheta, environment, workspace, derivatives);
        },
        peer: &[Algorithm::RneaDerivatives],
        matrices: 3,
        is_symmetric: false,
    },
    Kernel {
        name: "forward_dynamics_derivatives",
        run: |model, [theta, dtheta, _, tau], environment, workspace, out| {
            let (ddtheta, by) = parts(model, out);
            native::forward_dynamics_derivatives(model, theta, dtheta, tau, environment, workspace, ddtheta, by);
        },
        peer: &[Algorithm::AbaDerivatives],
        matrices: 3,
        is_symmetric: false,
    },
];

/// n numbers, and the three matrices before them.
fn parts<'a>(model: &Model, out: &'a mut [f64]) -> (&'a mut [f64], [&'a mut [f64]; 3]) {
    let square = model.n() * model.n();
    let (a, rest) = out.split_at_mut(square);
    let (b, rest) = rest.split_at_mut(square);
    let (c, vector) = rest.split_at_mut(square);
    (vector, [a, b, c])
}

impl Kernel {
    /// How many numbers are compared.
    fn compared(&self, model: &Model) -> usize {
        if self.matrices > 0 { self.matrices * model.n() * model.n() } else { model.n() }
    }

    /// How many numbers it writes: after several matrices a vector.
    pub fn length(&self, model: &Model) -> usize {
        self.compared(model) + if self.matrices > 1 { model.n() } else { 0 }
    }

    /// The largest difference between mozzi's result (by rows) and Pinocchio's (by columns), over the largest entry of the vector or
    /// matrix. Of a free base Pinocchio has the linear three first.
    pub fn difference(&self, model: &Model, ours: &[f64], theirs: &[f64]) -> f64 {
        let block = self.compared(model) / self.matrices.max(1);
        let blocks = ours.chunks_exact(block).zip(theirs.chunks_exact(block)).take(self.matrices.max(1));
        let differences = blocks.map(|(ours, theirs)| self.difference_of_block(model, ours, theirs));
        differences.fold(0.0_f64, |worst, x| if x <= worst { worst } else { x }) // NaN stays
    }

    fn difference_of_block(&self, model: &Model, ours: &[f64], theirs: &[f64]) -> f64 {
        let (n, base) = (model.n(), model.base().velocities());
        let place = |j: usize| if j < base { (j + 3) % 6 } else { j };
        let largest = theirs.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let mut worst = 0.0_f64;
        for (k, x) in ours.iter().enumerate() {
            let (row, column) = (place(k / n), place(k % n));
            let y = match (self.matrices, self.is_symmetric && row > column) {
                (0, _) => theirs[place(k)],
                (_, false) => theirs[column * n + row],
                (_, true) => theirs[row * n + column], // its mirror image, in the upper triangle
            };
            worst = if (x - y).abs() <= worst { worst } else { (x - y).abs() }; // NaN stays
        }
        worst / largest
    }
}
