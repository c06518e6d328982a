//! A synthetic log: the double pendulum with heavier links and more friction than its file.

use mozzi::{Environment, Model};
use std::fmt::Write;

pub const ROBOT: &str = "double_pendulum";

/// Rows of a motion.
#[derive(Clone)]
pub struct Motion {
    pub t: Vec<f64>,
    /// By row: both joints.
    pub theta: Vec<[f64; 2]>,
    pub dtheta: Vec<[f64; 2]>,
    pub tau: Vec<[f64; 2]>,
}

/// 12 s at 100 Hz.
pub fn clean() -> Motion {
    let file: Model = mozzi_urdf::open(ROBOT).expect("embedded").description.build().expect("sound");
    let heavier = |(x, name): (&f64, String)| match name.as_str() {
        _ if name.starts_with("rod1") => 1.2 * x,
        _ if name.starts_with("rod2") => 1.35 * x,
        _ if name.ends_with("viscous") || name.ends_with("damping") => 0.2,
        _ => *x,
    };
    let names: Vec<String> = file.parameter_names().iter().map(ToString::to_string).collect();
    let truth = file.with_parameters(&file.parameters().iter().zip(names).map(heavier).collect::<Vec<f64>>());
    let environment: Environment = truth.environment();
    let wave = |j: usize, t: f64| -> [f64; 3] {
        let terms: [[f64; 3]; 3] = match j {
            0 => [[0.8, 2.1, 0.3], [0.35, 4.7, 1.0], [0.2, 6.9, 0.0]],
            _ => [[0.7, 3.3, 1.2], [0.4, 5.3, 0.5], [0.25, 1.1, 0.0]],
        };
        terms.iter().fold([0.6 * (j as f64 + 0.5), 0.0, 0.0], |[q, v, a], &[size, w, p]| {
            let (s, c) = (w * t + p).sin_cos();
            [q + size * s, v + size * w * c, a - size * w * w * s]
        })
    };
    let mut motion = Motion { t: Vec::new(), theta: Vec::new(), dtheta: Vec::new(), tau: Vec::new() };
    for k in 0..1200 {
        let t = 0.01 * f64::from(k);
        let at = [wave(0, t), wave(1, t)];
        let of = |i: usize| [at[0][i], at[1][i]];
        let tau = truth.inverse_dynamics(&of(0), &of(1), &of(2), &environment).expect("torques");
        motion.t.push(t);
        motion.theta.push(of(0));
        motion.dtheta.push(of(1));
        motion.tau.push([tau[0] + 0.25 * at[0][1].signum(), tau[1] + 0.1 * at[1][1].signum()]);
    }
    motion
}

impl Motion {
    /// A table with these names, t first, then θ, θ̇, τ; each row's cells are joined by `separator`.
    pub fn table(&self, header: &str, separator: &str) -> String {
        self.cells(header, separator, &|x| format!("{x:.9}"))
    }

    pub fn cells(&self, header: &str, separator: &str, show: &dyn Fn(f64) -> String) -> String {
        let mut text = header.to_string() + "\n";
        for row in 0..self.t.len() {
            let all = [self.theta[row], self.dtheta[row], self.tau[row]].concat();
            let cells: Vec<String> = [self.t[row]].iter().chain(&all).map(|x| show(*x)).collect();
            writeln!(text, "{}", cells.join(separator)).expect("text");
        }
        text
    }

    /// With each row changed.
    pub fn map(mut self, mut change: impl FnMut(usize, &mut [f64; 2], &mut [f64; 2], &mut [f64; 2])) -> Self {
        for row in 0..self.t.len() {
            change(row, &mut self.theta[row], &mut self.dtheta[row], &mut self.tau[row]);
        }
        self
    }

    /// With other times.
    pub fn timed(mut self, time: impl Fn(f64) -> f64) -> Self {
        self.t.iter_mut().for_each(|t| *t = time(*t));
        self
    }

    pub fn without(&self, rows: std::ops::Range<usize>) -> Self {
        let keep = |k: &usize| !rows.contains(k);
        let pick = |table: &[[f64; 2]]| (0..table.len()).filter(keep).map(|k| table[k]).collect();
        Motion {
            t: (0..self.t.len()).filter(keep).map(|k| self.t[k]).collect(),
            theta: pick(&self.theta),
            dtheta: pick(&self.dtheta),
            tau: pick(&self.tau),
        }
    }
}
