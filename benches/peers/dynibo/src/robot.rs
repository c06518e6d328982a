//! A robot in dynibo, with a fixed or floating base, and its states.

use dynibo::{BaseState, FloatingRobot, Frame, RobotModel, Twist};
use nalgebra::{DMatrix, Quaternion, Translation3, UnitQuaternion, Vector3};
use std::ffi::CStr;

/// Names in mozzi and in dynibo.
pub const QUANTITIES: [(&CStr, &CStr); 4] = [
    (c"inverse_dynamics", c"inverse_dynamics"),
    (c"forward_dynamics", c"forward_dynamics"),
    (c"mass_matrix", c"mass_matrix"),
    (c"bias_forces", c"inverse_dynamics, no acceleration"),
];

enum Kind {
    Bolted(dynibo::Robot),
    Free(FloatingRobot),
}

/// A state in dynibo's form.
struct State {
    /// With the acceleration of θ̈, and with that of θ̈ = 0.
    base: [BaseState; 2],
    /// The body twist of a floating base.
    v: [Vector3<f64>; 2],
    q: Vec<f64>,
    qd: Vec<f64>,
    qdd: Vec<f64>,
    zero: Vec<f64>,
    forces: Vec<f64>,
}

pub struct Robot {
    kind: Kind,
    joints: usize,
    /// 6 for a floating base, else 0.
    base: usize,
    /// mozzi's index of each of dynibo's joints, which dynibo orders level by level.
    order: Vec<usize>,
    states: Vec<State>,
    vector: Vec<f64>,
    matrix: Vec<f64>,
}

impl Robot {
    pub fn new(urdf: &str, is_floating: bool) -> Result<Self, String> {
        let file = std::env::temp_dir().join(format!("mozzi-dynibo-{}.urdf", std::process::id()));
        std::fs::write(&file, urdf).map_err(|error| format!("{}: {error}", file.display()))?;
        let model = RobotModel::from_urdf(&file).map_err(|error| error.to_string());
        let _ = std::fs::remove_file(&file);
        let model = model?;
        let mut order = Vec::new();
        for k in 0..model.joint_count() {
            let name = model.joint_name(k).map_err(|error| error.to_string())?;
            let number = name.strip_prefix("joint").and_then(|number| number.parse::<usize>().ok());
            order.push(number.ok_or_else(|| format!("a joint is called {name}"))? - 1);
        }
        let (joints, base) = (model.joint_count(), if is_floating { 6 } else { 0 });
        let n = joints + base;
        let kind = if is_floating {
            Kind::Free(model.floating_robot().map_err(|error| error.to_string())?)
        } else {
            Kind::Bolted(model.robot())
        };
        Ok(Robot { kind, joints, base, order, states: Vec::new(), vector: vec![0.0; n], matrix: vec![0.0; n * n] })
    }

    pub fn state_length(&self) -> usize {
        4 * self.joints + if self.base > 0 { 25 } else { 0 }
    }

    pub fn state_count(&self) -> usize {
        self.states.len()
    }

    pub fn set_states(&mut self, numbers: &[f64]) {
        let (base, n) = (self.base, self.base + self.joints);
        let positions = if base > 0 { 7 } else { 0 };
        let three = |x: &[f64]| Vector3::new(x[0], x[1], x[2]);
        for s in numbers.chunks_exact(self.state_length()) {
            let (theta, rest) = s.split_at(positions + self.joints);
            let (dtheta, ddtheta, tau) = (&rest[..n], &rest[n..2 * n], &rest[2 * n..]);
            let joints = |x: &[f64]| self.order.iter().map(|&k| x[k]).collect::<Vec<_>>();
            let mut forces = [&tau[..base], &joints(&tau[base..])].concat();
            let still = BaseState::stationary(Frame::identity()).expect("a finite frame");
            let (mut states, mut v) = ([still, still], [Vector3::zeros(); 2]);
            if base > 0 {
                let R = UnitQuaternion::from_quaternion(Quaternion::new(theta[0], theta[1], theta[2], theta[3]));
                let frame = Frame::from_parts(Translation3::from(three(&theta[4..])), R);
                v = [three(dtheta), three(&dtheta[3..])];
                let spin = v[0].cross(&v[1]);
                let velocity = Twist::new(R * v[0], R * v[1]);
                let moving = Twist::new(R * three(ddtheta), R * (three(&ddtheta[3..]) + spin));
                states = [moving, Twist::new(Vector3::zeros(), R * spin)]
                    .map(|acceleration| BaseState::new(frame, velocity, acceleration).expect("finite numbers"));
                forces[..3].copy_from_slice((R * three(tau)).as_slice());
                forces[3..6].copy_from_slice((R * three(&tau[3..])).as_slice());
            }
            self.states.push(State {
                base: states,
                v,
                q: joints(&theta[positions..]),
                qd: joints(&dtheta[base..]),
                qdd: joints(&ddtheta[base..]),
                zero: vec![0.0; self.joints],
                forces,
            });
        }
    }

    pub fn run(&mut self, algorithm: usize, state: usize) {
        let State { base, q, qd, qdd, zero, forces, .. } = &self.states[state];
        let (x, M) = (&mut self.vector, &mut self.matrix);
        match (&mut self.kind, algorithm) {
            (Kind::Bolted(robot), 0) => robot.inverse_dynamics(q, qd, qdd, &[], x),
            (Kind::Bolted(robot), 1) => robot.forward_dynamics(q, qd, forces, &[], x),
            (Kind::Bolted(robot), 2) => robot.mass_matrix(q, M),
            (Kind::Bolted(robot), _) => robot.inverse_dynamics(q, qd, zero, &[], x),
            (Kind::Free(robot), 0) => robot.inverse_dynamics(&base[0], q, qd, qdd, &[], x),
            (Kind::Free(robot), 1) => robot.forward_dynamics(&base[0], q, qd, forces, &[], x),
            (Kind::Free(robot), 2) => robot.mass_matrix(&base[0], q, M),
            (Kind::Free(robot), _) => robot.inverse_dynamics(&base[1], q, qd, zero, &[], x),
        }
        .expect("a sound robot and a finite state");
    }

    /// mozzi's index of one of dynibo's velocities.
    fn place(&self, k: usize) -> usize {
        if k < self.base { k } else { self.base + self.order[k - self.base] }
    }

    /// In mozzi's convention, matrices by rows.
    pub fn result(&mut self, algorithm: usize, state: usize) -> Vec<f64> {
        self.run(algorithm, state);
        let State { base, v, .. } = &self.states[state];
        let back = base[0].frame().rotation.inverse();
        let n = self.base + self.joints;
        if algorithm == 2 {
            let mut X = DMatrix::identity(n, n); // of velocities, world's from the body's
            for start in (0..self.base).step_by(3) {
                X.view_mut((start, start), (3, 3)).copy_from(&back.inverse().to_rotation_matrix().into_inner());
            }
            let M = X.transpose() * DMatrix::from_column_slice(n, n, &self.matrix) * X;
            let mut out = vec![0.0; n * n];
            for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
                out[self.place(i) * n + self.place(j)] = M[(i, j)];
            }
            return out;
        }
        let mut x = vec![0.0; n];
        for (k, &y) in self.vector.iter().enumerate() {
            x[self.place(k)] = y;
        }
        for start in (0..self.base).step_by(3) {
            let turned = back * Vector3::new(x[start], x[start + 1], x[start + 2]);
            x[start..start + 3].copy_from_slice(turned.as_slice());
        }
        if algorithm == 1 && self.base > 0 {
            let spin = v[0].cross(&v[1]);
            for (x, spin) in x[3..6].iter_mut().zip(spin.iter()) {
                *x -= spin;
            }
        }
        x
    }
}
