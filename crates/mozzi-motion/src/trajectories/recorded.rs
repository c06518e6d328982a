//! A motion from a table of times, such as a file's.

use super::chart::{State, between};
use super::path::{Path, Point};
use super::reference::{Desired, Reference};
use super::spline::{Ends, Spline};
use crate::Error;
use crate::error::check;
use mozzi::{ConfigurationSpace, Model};

/// Rows of θ at increasing times, and of θ̇ and θ̈ if they are known. In between: with θ̈ the quintic that meets θ, θ̇
/// and θ̈ of both rows, with θ̇ alone the cubic that meets θ and θ̇, with neither the cubic spline at rest at both
/// ends. On balls, free joints and floating bases the polynomials are those of u in θ = θ_k ⊕ u.
#[derive(Clone, Debug)]
pub struct Recorded {
    space: ConfigurationSpace,
    n: usize,
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
    /// [`mozzi::Error::BadArgument`] for times that do not increase, numbers that are not finite, or θ̈ without θ̇;
    /// [`mozzi::Error::WrongLength`].
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
        let space = model.configuration_space().clone();
        Ok(Recorded { space, n: model.n(), times: times.to_vec(), rows, end: theta[theta.len() - 1].clone() })
    }
}

impl Reference for Recorded {
    fn duration(&self) -> f64 {
        self.times[self.times.len() - 1]
    }

    fn at(&self, t: f64) -> Desired {
        let (first, last) = (self.times[0], self.duration());
        let still = |theta: Vec<f64>| Desired { dtheta: vec![0.0; self.n], ddtheta: vec![0.0; self.n], theta };
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
                let second = ddtheta.as_ref();
                let end =
                    |k: usize| State { theta: &theta[k], rate: &dtheta[k], second: second.map(|rows| &rows[k][..]) };
                let Point { theta, slope, curvature } = between(&self.space, h, x, [end(k), end(k + 1)]);
                Desired { theta, dtheta: slope, ddtheta: curvature }
            }
        }
    }
}
