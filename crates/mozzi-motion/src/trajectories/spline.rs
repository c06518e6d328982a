//! Cubic splines through via points: θ, θ̇ and θ̈ without jumps.

use super::path::{Path, Point};
use crate::Error;
use crate::error::{check, check_flat};
use mozzi::Model;

/// What a spline does at its ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ends {
    /// θ″ = 0: for paths that are timed later, whose θ′ must not vanish.
    Natural,
    /// θ′ = 0: for splines in time that start and end at rest.
    AtRest,
}

/// A cubic spline of each joint through points at increasing s from 0 to 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Spline {
    joints: usize,
    s: Vec<f64>,
    /// Rows of positions.
    points: Vec<f64>,
    /// Rows of second derivatives.
    curvatures: Vec<f64>,
}

impl Spline {
    /// Through rows of positions at these s. Scaled to begin at 0 and end at 1: times in seconds do, for a path that is
    /// to be run through by [`Profile::linear`](super::Profile::linear) of their span.
    ///
    /// # Errors
    /// [`mozzi::Error::BadArgument`] for fewer than two points, an s that does not increase, or a floating base;
    /// [`mozzi::Error::WrongLength`].
    pub fn new(model: &Model, s: &[f64], points: &[Vec<f64>], ends: Ends) -> Result<Self, Error> {
        check_flat(model, "a spline's robot")?;
        check(points.len() >= 2, "the number of via points", points.len(), "at least 2")?;
        if s.len() != points.len() {
            let (found, expected) = (s.len(), points.len());
            return Err(mozzi::Error::WrongLength { what: "the list of the via points' s", found, expected }.into());
        }
        for (k, point) in points.iter().enumerate() {
            model.check_configuration(point)?;
            let fine = point.iter().chain([&s[k]]).all(|x| x.is_finite());
            check(fine, "a via point", format!("{point:?} at {}", s[k]), "finite numbers")?;
            let increases = k == 0 || s[k] > s[k - 1];
            check(increases, "the s of a via point", format!("{} in row {}", s[k], k + 1), "numbers that increase")?;
        }
        let (first, span) = (s[0], s[s.len() - 1] - s[0]);
        let s: Vec<f64> = s.iter().map(|s| (s - first) / span).collect();
        let curvatures = curvatures(&s, points, ends);
        Ok(Spline { joints: model.n(), s, points: points.concat(), curvatures })
    }

    /// Through rows of positions, s in proportion to the distances between them, √Σ Δθ².
    ///
    /// # Errors
    /// As [`new`](Self::new); also where two points in a row are the same.
    pub fn through(model: &Model, points: &[Vec<f64>], ends: Ends) -> Result<Self, Error> {
        let apart = |p: &[Vec<f64>]| p[0].iter().zip(&p[1]).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt();
        let mut s = vec![0.0];
        for (k, pair) in points.windows(2).enumerate() {
            let way = apart(pair);
            let found = || format!("{:?} in row {}, as in the one before it", pair[1], k + 2);
            check(way != 0.0, "a via point", found(), "points of which no two in a row are the same")?;
            s.push(s[s.len() - 1] + way);
        }
        Self::new(model, &s, points, ends)
    }

    fn row<'a>(&self, list: &'a [f64], k: usize) -> &'a [f64] {
        &list[k * self.joints..(k + 1) * self.joints]
    }
}

impl Path for Spline {
    fn at(&self, s: f64) -> Point {
        let k = self.s.partition_point(|&begin| begin <= s).clamp(1, self.s.len() - 1) - 1;
        let h = self.s[k + 1] - self.s[k];
        let (b, a) = ((s - self.s[k]) / h, (self.s[k + 1] - s) / h);
        let [y0, y1] = [k, k + 1].map(|k| self.row(&self.points, k));
        let [m0, m1] = [k, k + 1].map(|k| self.row(&self.curvatures, k));
        let each = |f: &dyn Fn(usize) -> f64| (0..self.joints).map(f).collect();
        let sixth = h * h / 6.0;
        Point {
            theta: each(&|j| a * y0[j] + b * y1[j] + sixth * ((a * a * a - a) * m0[j] + (b * b * b - b) * m1[j])),
            slope: each(&|j| {
                (y1[j] - y0[j]) / h + h / 6.0 * ((1.0 - 3.0 * a * a) * m0[j] + (3.0 * b * b - 1.0) * m1[j])
            }),
            curvature: each(&|j| a * m0[j] + b * m1[j]),
        }
    }
}

/// The second derivatives M of continuous slopes: h[k−1] M[k−1] + 2(h[k−1] + h[k]) M[k] + h[k] M[k+1] = 6(d[k] −
/// d[k−1]), d the slopes of the chords, solved by elimination.
fn curvatures(s: &[f64], points: &[Vec<f64>], ends: Ends) -> Vec<f64> {
    let (count, joints) = (s.len(), points[0].len());
    let h: Vec<f64> = s.windows(2).map(|s| s[1] - s[0]).collect();
    let mut all = vec![0.0; count * joints];
    for j in 0..joints {
        let d: Vec<f64> = (0..count - 1).map(|k| (points[k + 1][j] - points[k][j]) / h[k]).collect();
        let (mut diagonal, mut right) = (vec![0.0; count], vec![0.0; count]);
        for k in 0..count {
            let (before, after) = (k.checked_sub(1).map(|k| (h[k], d[k])), h.get(k).zip(d.get(k)));
            (diagonal[k], right[k]) = match (before, after, ends) {
                (Some((h0, d0)), Some((&h1, &d1)), _) => (2.0 * (h0 + h1), 6.0 * (d1 - d0)),
                (_, _, Ends::Natural) => (1.0, 0.0),
                (None, Some((&h1, &d1)), Ends::AtRest) => (2.0 * h1, 6.0 * d1),
                (Some((h0, d0)), None, Ends::AtRest) => (2.0 * h0, -6.0 * d0),
                (None, None, _) => (1.0, 0.0),
            };
        }
        // beside the diagonal stands h, and 0 in the end rows of natural ends
        let natural = ends == Ends::Natural;
        let above = |k: usize| if natural && k == 0 { 0.0 } else { h[k] };
        let below = |k: usize| if natural && k == count - 1 { 0.0 } else { h[k - 1] };
        for k in 1..count {
            let factor = below(k) / diagonal[k - 1];
            diagonal[k] -= factor * above(k - 1);
            right[k] -= factor * right[k - 1];
        }
        for k in (0..count).rev() {
            let next = if k + 1 < count { above(k) * all[(k + 1) * joints + j] } else { 0.0 };
            all[k * joints + j] = (right[k] - next) / diagonal[k];
        }
    }
    all
}
