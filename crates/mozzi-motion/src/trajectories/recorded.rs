//! A motion from a table of times: what a file says.

use super::path::Path;
use super::reference::{Desired, Reference};
use super::spline::{Ends, Spline};
use crate::Error;
use crate::error::check;
use mozzi::Model;

/// Rows of θ at increasing times, and of θ̇ and θ̈ where they are known. In between: with θ̈ the quintic that meets θ,
/// θ̇ and θ̈ of both rows, with θ̇ alone the cubic that meets θ and θ̇, with neither the cubic spline at rest at both
/// ends.
#[derive(Clone, Debug)]
pub struct Recorded {
    times: Vec<f64>,
    rows: Rows,
    end: Vec<f64>,
}

#[derive(Clone, Debug)]
enum Rows {
    /// θ, θ̇ and θ̈, of which the last may be missing.
    Hermite([Vec<Vec<f64>>; 2], Option<Vec<Vec<f64>>>),
    Spline(Spline),
}

impl Recorded {
    /// From rows at these times, in seconds, the first not below 0.
    ///
    /// # Errors
    /// [`mozzi::Error::BadArgument`] for times that do not increase, numbers that are not finite, θ̈ without θ̇, or a
    /// floating base; [`mozzi::Error::WrongLength`].
    pub fn new(
        model: &Model,
        times: &[f64],
        theta: &[Vec<f64>],
        dtheta: Option<&[Vec<f64>]>,
        ddtheta: Option<&[Vec<f64>]>,
    ) -> Result<Self, Error> {
        let spline = Spline::new(model, times, theta, Ends::AtRest)?; // checks times and θ
        check(times[0] >= 0.0, "the first time", times[0], "at least 0")?;
        check(ddtheta.is_none() || dtheta.is_some(), "what is known beside θ", "θ̈ alone", "θ̇ too")?;
        for rows in [dtheta, ddtheta].into_iter().flatten() {
            if rows.len() != times.len() {
                return Err(mozzi::Error::WrongLength {
                    what: "a list of rates",
                    found: rows.len(),
                    expected: times.len(),
                }
                .into());
            }
            for row in rows {
                model.check_lengths(&theta[0], [("a row of rates", row)])?;
                check(row.iter().all(|x| x.is_finite()), "a row of rates", format!("{row:?}"), "finite numbers")?;
            }
        }
        let rows = match (dtheta, ddtheta) {
            (Some(rates), second) => Rows::Hermite([theta.to_vec(), rates.to_vec()], second.map(<[_]>::to_vec)),
            (None, _) => Rows::Spline(spline),
        };
        Ok(Recorded { times: times.to_vec(), rows, end: theta[theta.len() - 1].clone() })
    }
}

impl Reference for Recorded {
    fn duration(&self) -> f64 {
        self.times[self.times.len() - 1]
    }

    fn at(&self, t: f64) -> Desired {
        let (first, last) = (self.times[0], self.duration());
        let still =
            |theta: Vec<f64>| Desired { dtheta: vec![0.0; theta.len()], ddtheta: vec![0.0; theta.len()], theta };
        if t > last {
            return still(self.end.clone());
        }
        match &self.rows {
            Rows::Spline(spline) => {
                let (span, point) = (last - first, spline.at(((t - first) / (last - first)).clamp(0.0, 1.0)));
                if t < first {
                    return still(point.theta);
                }
                let by = |list: Vec<f64>, unit: f64| list.into_iter().map(|x| x / unit).collect();
                Desired { theta: point.theta, dtheta: by(point.slope, span), ddtheta: by(point.curvature, span * span) }
            }
            Rows::Hermite([theta, dtheta], ddtheta) => {
                if t < first {
                    return still(theta[0].clone());
                }
                let k = self.times.partition_point(|&begin| begin <= t).clamp(1, self.times.len() - 1) - 1;
                let (h, x) = (self.times[k + 1] - self.times[k], t - self.times[k]);
                let mut now = still(theta[k].clone());
                for j in 0..now.theta.len() {
                    let ends = |k: usize| [theta[k][j], dtheta[k][j]];
                    let second = ddtheta.as_ref().map(|rows| [rows[k][j], rows[k + 1][j]]);
                    [now.theta[j], now.dtheta[j], now.ddtheta[j]] = hermite(h, x, [ends(k), ends(k + 1)], second);
                }
                now
            }
        }
    }
}

/// y, y′ and y″ at x of the polynomial on [0, h] that has these values and slopes at its ends, and these second
/// derivatives.
fn hermite(h: f64, x: f64, [[y0, v0], [y1, v1]]: [[f64; 2]; 2], second: Option<[f64; 2]>) -> [f64; 3] {
    let rest = y1 - y0 - v0 * h;
    let c = match second {
        None => {
            let (p, q) = (rest / (h * h), (v1 - v0) / h);
            [3.0 * p - q, (q - 2.0 * p) / h, 0.0, 0.0]
        }
        Some([a0, a1]) => {
            let p = (rest - 0.5 * a0 * h * h) / (h * h * h);
            let q = (v1 - v0 - a0 * h) / (h * h);
            let r = (a1 - a0) / h;
            [
                0.5 * a0,
                10.0 * p - 4.0 * q + 0.5 * r,
                (-15.0 * p + 7.0 * q - r) / h,
                (6.0 * p - 3.0 * q + 0.5 * r) / (h * h),
            ]
        }
    };
    let [a, b, c, d] = c;
    [
        y0 + x * (v0 + x * (a + x * (b + x * (c + x * d)))),
        v0 + x * (2.0 * a + x * (3.0 * b + x * (4.0 * c + x * 5.0 * d))),
        2.0 * a + x * (6.0 * b + x * (12.0 * c + x * 20.0 * d)),
    ]
}
