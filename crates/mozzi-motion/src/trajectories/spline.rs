//! Cubic splines through via points: θ, θ̇ and θ̈ without jumps.

use super::chart::{State, between};
use super::path::{Path, Point};
use crate::Error;
use crate::error::check;
use mozzi::model::difference;
use mozzi::{ConfigurationSpace, Model};

/// End conditions of a spline.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ends {
    /// θ″ = 0: for paths that are timed later, whose θ′ must not vanish.
    Natural,
    /// θ′ = 0: for splines in time that start and end at rest.
    AtRest,
}

/// A cubic spline of each joint through points at increasing s from 0 to 1.
///
/// A ball, a free joint and a floating base have no coordinates that can be added. There y_{k+1} = y_k + (θ_{k+1} ⊖
/// θ_k) takes their place: its cubic spline has the slopes and curvatures at the points, and between them θ_k ⊕ u
/// meets both with a quintic u. So θ, θ′ and θ″ have no jumps, rotations about one axis give the cubic spline of their
/// angle, and the choice of {s} does not matter. Rotations between two points take the shorter way.
#[derive(Clone, Debug, PartialEq)]
pub struct Spline {
    space: ConfigurationSpace,
    s: Vec<f64>,
    /// Rows of positions.
    theta: Vec<Vec<f64>>,
    /// Rows of y: for joints of one axis, their positions.
    y: Vec<Vec<f64>>,
    /// Rows of second derivatives.
    curvatures: Vec<Vec<f64>>,
}

impl Spline {
    /// A spline through rows of positions at these s, which are scaled to begin at 0 and end at 1. Times in seconds can
    /// be used, for a path that is timed by [`Profile::linear`](super::Profile::linear) over their span.
    ///
    /// # Errors
    /// [`mozzi::Error::BadArgument`] for fewer than two points or an s that does not increase;
    /// [`mozzi::Error::WrongLength`].
    pub fn new(model: &Model, s: &[f64], points: &[Vec<f64>], ends: Ends) -> Result<Self, Error> {
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
        let y = developed(model, points);
        let curvatures = curvatures(&s, &y, ends);
        Ok(Spline { space: model.configuration_space().clone(), s, theta: points.to_vec(), y, curvatures })
    }

    /// A spline through rows of positions, s in proportion to the distances between them, ‖θ_{k+1} ⊖ θ_k‖.
    ///
    /// # Errors
    /// As [`new`](Self::new); also if two consecutive points are the same.
    pub fn through(model: &Model, points: &[Vec<f64>], ends: Ends) -> Result<Self, Error> {
        let (mut s, mut way) = (vec![0.0], vec![0.0; model.n()]);
        points.iter().try_for_each(|point| model.check_configuration(point))?;
        for (k, pair) in points.windows(2).enumerate() {
            difference(model, &pair[0], &pair[1], &mut way);
            let way = way.iter().map(|x| x * x).sum::<f64>().sqrt();
            let found = || format!("{:?} in row {}, as in the one before it", pair[1], k + 2);
            check(way != 0.0, "a via point", found(), "points of which no two in a row are the same")?;
            s.push(s[s.len() - 1] + way);
        }
        Self::new(model, &s, points, ends)
    }

    /// y, y′ and y″ within piece k.
    fn cubic(&self, k: usize, s: f64) -> [Vec<f64>; 3] {
        let h = self.s[k + 1] - self.s[k];
        let (b, a) = ((s - self.s[k]) / h, (self.s[k + 1] - s) / h);
        let [[y0, y1], [m0, m1]] = [&self.y, &self.curvatures].map(|rows| [&rows[k], &rows[k + 1]]);
        let each = |f: &dyn Fn(usize) -> f64| (0..y0.len()).map(f).collect();
        let sixth = h * h / 6.0;
        [
            each(&|j| a * y0[j] + b * y1[j] + sixth * ((a * a * a - a) * m0[j] + (b * b * b - b) * m1[j])),
            each(&|j| (y1[j] - y0[j]) / h + h / 6.0 * ((1.0 - 3.0 * a * a) * m0[j] + (3.0 * b * b - 1.0) * m1[j])),
            each(&|j| a * m0[j] + b * m1[j]),
        ]
    }
}

impl Path for Spline {
    fn at(&self, s: f64) -> Point {
        let k = self.s.partition_point(|&begin| begin <= s).clamp(1, self.s.len() - 1) - 1;
        if self.space.is_flat() {
            let [theta, slope, curvature] = self.cubic(k, s);
            return Point { theta, slope, curvature };
        }
        let [start, end] = [self.s[k], self.s[k + 1]];
        let [first, last] = [start, end].map(|s| self.cubic(k, s));
        let ends = [(k, &first), (k + 1, &last)].map(|(k, [_, rate, second])| State {
            theta: &self.theta[k],
            rate,
            second: Some(second),
        });
        between(&self.space, end - start, s - start, ends)
    }

    fn knots(&self) -> Vec<f64> {
        self.s.clone()
    }
}

/// Rows y_{k+1} = y_k + (θ_{k+1} ⊖ θ_k): on a flat space, the positions.
fn developed(model: &Model, points: &[Vec<f64>]) -> Vec<Vec<f64>> {
    if model.configuration_space().is_flat() {
        return points.to_vec();
    }
    let mut rows = vec![vec![0.0; model.n()]];
    for (k, pair) in points.windows(2).enumerate() {
        let mut way = vec![0.0; model.n()];
        difference(model, &pair[0], &pair[1], &mut way);
        way.iter_mut().zip(&rows[k]).for_each(|(way, y)| *way += y);
        rows.push(way);
    }
    rows
}

/// The second derivatives M of continuous slopes: h[k−1] M[k−1] + 2(h[k−1] + h[k]) M[k] + h[k] M[k+1] = 6(d[k] −
/// d[k−1]), d the slopes of the chords, solved by elimination.
fn curvatures(s: &[f64], points: &[Vec<f64>], ends: Ends) -> Vec<Vec<f64>> {
    let (count, joints) = (s.len(), points[0].len());
    let h: Vec<f64> = s.windows(2).map(|s| s[1] - s[0]).collect();
    let mut all = vec![vec![0.0; joints]; count];
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
        // off-diagonal entries are h, and 0 in the end rows of natural ends
        let natural = ends == Ends::Natural;
        let above = |k: usize| if natural && k == 0 { 0.0 } else { h[k] };
        let below = |k: usize| if natural && k == count - 1 { 0.0 } else { h[k - 1] };
        for k in 1..count {
            let factor = below(k) / diagonal[k - 1];
            diagonal[k] -= factor * above(k - 1);
            right[k] -= factor * right[k - 1];
        }
        for k in (0..count).rev() {
            let next = if k + 1 < count { above(k) * all[k + 1][j] } else { 0.0 };
            all[k][j] = (right[k] - next) / diagonal[k];
        }
    }
    all
}
