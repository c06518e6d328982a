//! Standing on feet: contact forces within friction cones, by a small quadratic program (Kuindersma et al. 2016).

use super::{Gains, errors};
use crate::Error;
use crate::error::{check, check_open};
use crate::trajectories::Reference;
use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettingsBuilder, DefaultSolver, IPSolver, NonnegativeConeT, SecondOrderConeT, SolverStatus, ZeroConeT,
};
use mozzi::nalgebra::DMatrix;
use mozzi::{Environment, FrameId, Model, SE3, Vec3, Wrench};
use mozzi_sim::{ContactPoint, Input};

/// Weight of (contact force)² next to (error of an acceleration)².
const FORCES: f64 = 1e-9;
/// Rate at which a foot's velocity is brought to rest, 1/s.
const BRAKE: f64 = 50.0;

/// Holds a pose, or follows a reference, on feet that stay: in each state the accelerations θ̈ and the forces f of the
/// feet on the ground of
///
/// > min ‖θ̈ − a‖² + ε‖f‖², a = θ̈_d + K_d ė + K_p e, with 0 = (Mθ̈ + h + Jᵀf)_u, Jθ̈ + J̇θ̇ = −b Jθ̇, f in the cones
///
/// where u are the velocities without a motor, such as a floating base's. Then τ = Mθ̈ + h + Jᵀf. A foot presses with
/// at least `least` and ‖f_t‖ ≤ μ f_n. If friction at the feet is less than the controller's μ, they slip.
pub struct Standing<'m, R> {
    model: &'m Model,
    /// The reference to follow.
    pub reference: R,
    gains: Gains,
    feet: Vec<ContactPoint>,
    ground: SE3,
    /// The least normal force of a foot, N.
    pub least: f64,
    /// The forces of the last call along the axes of the ground (n into it, x, y), N.
    pub forces: Vec<[f64; 3]>,
}

impl<'m, R: Reference> Standing<'m, R> {
    /// On these points of the robot, which are at rest on the plane z = 0 of `ground`, with gains on accelerations.
    ///
    /// # Errors
    /// [`mozzi::Error::WrongLength`], [`mozzi::Error::BadArgument`] for gains that are negative or not finite, no feet,
    /// or a robot with constraints.
    pub fn new(
        model: &'m Model,
        reference: R,
        gains: Gains,
        feet: Vec<ContactPoint>,
        ground: SE3,
    ) -> Result<Self, Error> {
        gains.check(model)?;
        check(!feet.is_empty(), "feet", "none", "at least one contact point")?;
        check_open(model, "a robot on standing feet")?;
        Ok(Standing { model, reference, gains, feet, ground, least: 0.0, forces: Vec::new() })
    }

    /// The wrenches of forces along the ground's axes at the points that touch it, in the feet's frames.
    fn wrenches(&self, touching: &[(SE3, Vec3)], axes: &[Vec3; 3], forces: &[f64]) -> Vec<(FrameId, Wrench)> {
        let of_foot = |(k, foot): (usize, &ContactPoint)| {
            let f = (0..3).fold(Vec3::zero(), |sum, i| sum + axes[i] * forces[3 * k + i]);
            let (T, point) = touching[k];
            let f = T.R.inverse_mul(f);
            (foot.frame, Wrench { m: point.cross(f), f })
        };
        self.feet.iter().enumerate().map(of_foot).collect()
    }
}

impl<R: Reference> Input for Standing<'_, R> {
    fn torque(&mut self, t: f64, theta: &[f64], dtheta: &[f64], tau: &mut [f64]) -> Result<(), mozzi_sim::Error> {
        let (model, n, k) = (self.model, self.model.n(), self.feet.len());
        let desired = self.reference.at(t);
        let [e, de] = errors(model, &desired, theta, dtheta)?;
        let ground = self.ground.R.matrix().transpose().rows().map(Vec3);
        let axes = [-ground[2], ground[0], ground[1]];

        // rows of J, and J̇θ̇ + b Jθ̇
        let mut J = DMatrix::zeros(3 * k, n);
        let (mut rates, mut touching) = (vec![0.0; 3 * k], Vec::with_capacity(k));
        for (i, foot) in self.feet.iter().enumerate() {
            let T = model.forward_kinematics(theta, foot.frame)?;
            let columns = model.body_jacobian(theta, foot.frame)?;
            let V = &columns * dtheta;
            let dV = &model.body_jacobian_rate(theta, dtheta, foot.frame)? * dtheta;
            let point = foot.farthest(T.R.inverse_mul(axes[0]));
            let at_point = |w: Vec3, v: Vec3| v + w.cross(point);
            // what touches stays under the centre of a ball: only the centre moves
            let bias = at_point(dV.w, dV.v) + V.w.cross(V.v + V.w.cross(foot.center));
            for (r, axis) in axes.iter().enumerate() {
                let axis = T.R.inverse_mul(*axis);
                columns.0.iter().enumerate().for_each(|(j, c)| J[(3 * i + r, j)] = at_point(c.w, c.v).dot(axis));
                rates[3 * i + r] = bias.dot(axis) + BRAKE * at_point(V.w, V.v).dot(axis);
            }
            touching.push((T, point));
        }

        // x = (θ̈, f); rows A x + s = b with s in the cones
        let M = model.mass_matrix(theta)?;
        let still = vec![0.0; n];
        let h = model.inverse_dynamics(theta, dtheta, &still, &model.environment())?;
        let motors = model.motors();
        let unmoved: Vec<usize> = (0..n).filter(|j| !motors.contains(j)).collect();
        let rows = unmoved.len() + 7 * k;
        let (mut A, mut b) = (DMatrix::zeros(rows, n + 3 * k), vec![0.0; rows]);
        for (r, &j) in unmoved.iter().enumerate() {
            A.view_mut((r, 0), (1, n)).copy_from(&M.row(j));
            (0..3 * k).for_each(|c| A[(r, n + c)] = J[(c, j)]);
            b[r] = -h[j];
        }
        let first = unmoved.len();
        A.view_mut((first, 0), (3 * k, n)).copy_from(&J);
        (0..3 * k).for_each(|r| b[first + r] = -rates[r]);
        let presses = first + 3 * k;
        let cones = presses + k;
        for (i, foot) in self.feet.iter().enumerate() {
            A[(presses + i, n + 3 * i)] = -1.0;
            b[presses + i] = -self.least;
            A[(cones + 3 * i, n + 3 * i)] = -foot.mu;
            A[(cones + 3 * i + 1, n + 3 * i + 1)] = -1.0;
            A[(cones + 3 * i + 2, n + 3 * i + 2)] = -1.0;
        }
        let P = DMatrix::from_fn(n + 3 * k, n + 3 * k, |r, c| match (r == c, r < n) {
            (true, true) => 1.0,
            (true, false) => FORCES,
            _ => 0.0,
        });
        let mut q = vec![0.0; n + 3 * k];
        for j in 0..n {
            q[j] = -(desired.ddtheta[j] + self.gains.p[j] * e[j] + self.gains.d[j] * de[j]);
        }
        let mut kinds = vec![ZeroConeT(presses), NonnegativeConeT(k)];
        kinds.extend((0..k).map(|_| SecondOrderConeT(3)));
        let x = solve(&P, &q, &A, &b, &kinds)?;

        let (ddtheta, forces) = x.split_at(n);
        let applied = self.wrenches(&touching, &axes, forces);
        let environment = Environment { applied: &applied, ..model.environment() };
        let needed = model.inverse_dynamics(theta, dtheta, ddtheta, &environment)?;
        motors.iter().for_each(|&j| tau[j] += needed[j]);
        self.forces = forces.chunks_exact(3).map(|f| [f[0], f[1], f[2]]).collect();
        Ok(())
    }
}

/// ‖Ax + s − b‖ over the size of its terms, below which a search that ended early is an answer.
const FEASIBLE: f64 = 1e-6;

/// The x of min ½xᵀPx + qᵀx with Ax + s = b, s in the cones.
fn solve(
    P: &DMatrix<f64>,
    q: &[f64],
    A: &DMatrix<f64>,
    b: &[f64],
    cones: &[clarabel::solver::SupportedConeT<f64>],
) -> Result<Vec<f64>, mozzi::Error> {
    let wrong = |found: String| mozzi::Error::BadArgument {
        what: "the forces of the feet",
        found,
        expected: "forces within the friction cones that hold the robot",
    };
    let settings = DefaultSettingsBuilder::default()
        .verbose(false)
        .tol_gap_abs(1e-11)
        .tol_gap_rel(1e-11)
        .tol_feas(1e-11)
        .build()
        .map_err(|error| wrong(error.to_string()))?;
    let solver = DefaultSolver::new(&sparse(P), q, &sparse(A), b, cones, settings);
    let mut solver = solver.map_err(|error| wrong(error.to_string()))?;
    solver.solve();
    let is_feasible = solver.solution.r_prim < FEASIBLE;
    match solver.solution.status {
        SolverStatus::Solved => Ok(solver.solution.x.clone()),
        SolverStatus::AlmostSolved | SolverStatus::InsufficientProgress if is_feasible => Ok(solver.solution.x.clone()),
        SolverStatus::PrimalInfeasible | SolverStatus::AlmostPrimalInfeasible => Err(wrong("impossible".to_string())),
        status => Err(wrong(format!("not found ({status})"))),
    }
}

fn sparse(X: &DMatrix<f64>) -> CscMatrix<f64> {
    let (mut starts, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
    for column in X.column_iter() {
        for (r, &x) in column.iter().enumerate().filter(|(_, x)| **x != 0.0) {
            rows.push(r);
            values.push(x);
        }
        starts.push(rows.len());
    }
    CscMatrix::new(X.nrows(), X.ncols(), starts, rows, values)
}
