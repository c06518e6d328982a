//! The rows of the one-sided forces that act in a step.

use super::Impulses;
use crate::Error;
use crate::contacts::{Surface, Touch};
use crate::factored_mass::Support;
use crate::one_sided::{Law, Solver};
use alloc::string::ToString;
use alloc::vec;
use alloc::vec::Vec;
use mozzi::constraints::constraint_jacobian;
use mozzi::kinematics::{body_jacobian, forward_kinematics, twist_of};
use mozzi::linalg::Vec3;
use mozzi::model::{FrameId, Freedom};
use mozzi::spatial::Twist;
use nalgebra::{DMatrix, DVector, DVectorView, RowDVector};

/// The source of a block of rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Key {
    /// A row of the robot's constraints.
    Constraint(usize),
    /// A joint's lower (0) or upper (1) limit.
    Stop(usize, usize),
    /// A velocity.
    Dry(usize),
    /// A contact point and a plane.
    Contact(usize, usize),
}

/// J, G and the laws at the middle of a step.
pub(crate) struct System {
    /// The blocks: what they belong to, their first row, and their law.
    pub rows: Vec<(Key, usize, Law)>,
    /// The blocks whose friction is taken at the middle of the step.
    pub shifted: Vec<bool>,
    pub solver: Solver,
    /// m × n
    pub J: DMatrix<f64>,
    /// The velocity of the surroundings along the rows.
    pub w: DVector<f64>,
    /// J M⁻¹Jᵀ
    pub G: DMatrix<f64>,
    pub touches: Vec<Touching>,
    /// The velocities along the rows at the start of the step, and what they gain in its second half as the rows turn.
    pub start: DVector<f64>,
    pub turns: DVector<f64>,
}

/// A contact of a system.
pub(crate) struct Touching {
    /// The contact point and the plane.
    pub pair: (usize, usize),
    /// Its first row.
    pub first: usize,
    /// n, t₁ and t₂ in {s}.
    pub axes: [Vec3; 3],
    /// The touching point in its frame.
    pub of_frame: Vec3,
    /// The distance at the middle of the step, m.
    pub gap: f64,
}

impl System {
    /// The velocities of the surroundings as seen from the robot.
    pub fn relative(&self, dtheta: &[f64]) -> DVector<f64> {
        let mut u = self.w.clone();
        u.gemv(-1.0, &self.J, &DVectorView::from_slice(dtheta, dtheta.len()), 1.0);
        u
    }
}

/// A joint that is farther beyond its stop was not stopped, rad or m: what it gains in a step from its acceleration is
/// less.
const PASSED: f64 = 1e-4;

/// Joints slower than this press no point into a plane, rad/s or m/s.
const RESTS: f64 = 1e-7;

/// Rows that act at once: their matrix G has 300 MB.
const MOST_ROWS: usize = 6000;

impl Impulses<'_> {
    /// The velocities of the surroundings as seen from the robot at (t, θ, θ̇), along the rows of a system, which was
    /// made nearby.
    pub fn relative_at(&mut self, system: &System, t: f64, theta: &[f64], dtheta: &[f64]) -> DVector<f64> {
        let (model, n, m) = (self.model, self.model.n(), self.model.constraint_rows());
        let mut u = DVector::zeros(system.w.len());
        let mut columns = (None, Vec::new());
        let surfaces = self.surfaces(t);
        if m > 0 {
            let (mut A, still) = (vec![0.0; m * n], vec![0.0; n]);
            constraint_jacobian(model, theta, &still, &mut self.mass.workspace, &mut A, &mut [], &mut []);
            for (r, row) in A.chunks_exact(n).enumerate() {
                u[r] = -row.iter().zip(dtheta).map(|(a, rate)| a * rate).sum::<f64>();
            }
        }
        let mut touches = system.touches.iter(); // in the order of the rows
        for &(key, first, _) in &system.rows {
            match key {
                Key::Constraint(_) => {}
                Key::Dry(j) => u[first] = -dtheta[j],
                Key::Stop(k, side) => {
                    let row = self.stop_row(theta, k, side);
                    u[first] = -row.iter().zip(dtheta).map(|(a, rate)| a * rate).sum::<f64>();
                }
                Key::Contact(point, plane) => {
                    let Some(then) = touches.next() else { continue };
                    let of = &self.contacts.points[point];
                    self.columns(theta, of.frame, &mut columns);
                    let T = forward_kinematics(self.model, theta, of.frame);
                    let touch = surfaces[plane].touch_like(of, T, then.of_frame);
                    let V = twist_of(&columns.1, dtheta);
                    let v = touch.R * (V.v + V.w.cross(touch.of_frame));
                    for k in 0..3 {
                        u[first + k] = touch.speeds[k] - touch.axes[k].dot(v);
                    }
                }
            }
        }
        u
    }

    /// The rows of a step of h seconds with the middle (t, θ), for the joints with dry friction that are not `sliding`
    /// and for what is near, on the way from the start (θ, θ̇) to the next θ without impulses. `diagonal` is added to
    /// the diagonal of M, which stays factored.
    pub fn system(
        &mut self,
        t: f64,
        theta: &[f64],
        [start, dtheta, next]: [&[f64]; 3],
        h: f64,
        diagonal: &[f64],
        sliding: &[usize],
    ) -> Result<System, Error> {
        let (model, n) = (self.model, self.model.n());
        let m = model.constraint_rows();
        let expected = m + self.dry.len();
        let mut rows: Vec<f64> = Vec::with_capacity(expected * n);
        let (mut w, mut blocks, mut touches) = (Vec::with_capacity(expected), Vec::with_capacity(expected), Vec::new());
        if m > 0 {
            let (mut A, still) = (vec![0.0; m * n], vec![0.0; n]);
            constraint_jacobian(model, theta, &still, &mut self.mass.workspace, &mut A, &mut [], &mut []);
            for (r, row) in A.chunks_exact(n).enumerate() {
                blocks.push((Key::Constraint(r), w.len(), Law::Bilateral));
                rows.extend_from_slice(row);
                w.push(0.0);
            }
        }
        for &(k, side) in self.sides() {
            // along the limit's own gradient: a ball may come past the half turn in a step
            let rate: f64 = self.stop_row(start, k, side).iter().zip(dtheta).map(|(a, rate)| a * rate).sum();
            let is_far = self.room(start, k, side) - h * rate.max(0.0) > super::NEAR;
            if is_far && !self.passed.contains(&(k, side)) {
                continue;
            }
            blocks.push((Key::Stop(k, side), w.len(), Law::Stop));
            rows.extend(self.stop_row(theta, k, side).iter());
            w.push(0.0);
        }
        for &j in self.dry.iter().filter(|j| !sliding.contains(j)) {
            blocks.push((Key::Dry(j), w.len(), Law::Dry { most: h * model.friction()[j] }));
            rows.extend((0..n).map(|k| if k == j { 1.0 } else { 0.0 }));
            w.push(0.0);
        }
        let mut columns = (None, Vec::new());
        let near = self.near([t, t + 0.5 * h], theta, next);
        self.memory.stands_for = near.others;
        let all = w.len() + 3 * near.acting.len();
        if all > MOST_ROWS {
            let what = "the number of forces at contacts, stops and constraints";
            return Err(
                mozzi::Error::BadArgument { what, found: all.to_string(), expected: "at most 6000 at once" }.into()
            );
        }
        for (point, plane, touch) in near.acting {
            let key = Key::Contact(point, plane);
            let of = &self.contacts.points[point];
            let first = w.len();
            blocks.push((key, first, Law::Contact { mu: of.mu }));
            self.columns(theta, of.frame, &mut columns);
            for k in 0..3 {
                rows.extend(point_row(&columns.1, &touch, touch.axes[k]).iter());
                w.push(touch.speeds[k]);
            }
            let Touch { axes, of_frame, gap, .. } = touch;
            touches.push(Touching { pair: (point, plane), first, axes, of_frame, gap });
        }
        self.mass.factor(theta, 1.0, diagonal)?;
        let J = DMatrix::from_row_slice(w.len(), n, &rows);
        let [G, R] = self.delassus(&J);
        let laws: Vec<Law> = blocks.iter().map(|&(_, _, law)| law).collect();
        let (shifted, mut solver) = (vec![false; laws.len()], Solver::new(&G, &laws, Some(R)));
        if let Some((_, last)) = self.last.take().filter(|(keys, _)| keys.iter().eq(blocks.iter().map(|(key, ..)| key)))
        {
            solver.begin_as(last);
        }
        let still = || DVector::zeros(w.len());
        let (start, turns) = (still(), still());
        Ok(System { rows: blocks, shifted, solver, J, w: DVector::from_vec(w), G, touches, start, turns })
    }

    /// G = J M⁻¹Jᵀ and R = D^{−½}L⁻ᵀJᵀ, n × m, with G = RᵀR.
    pub fn delassus(&self, J: &DMatrix<f64>) -> [DMatrix<f64>; 2] {
        let (n, m) = (self.model.n(), J.nrows());
        let (mut R, mut G) = (J.transpose(), DMatrix::zeros(m, m));
        // what is not 0, of one row after the other, and where each ends
        let (mut entries, mut ends) = (Vec::with_capacity(m * n), Vec::with_capacity(m + 1));
        let mut support = Support::default();
        ends.push(0);
        for a in 0..m {
            let (before, rest) = R.as_mut_slice().split_at_mut(a * n);
            let y = &mut rest[..n];
            self.mass.halve(y, &mut support);
            entries.extend(support.places.iter().map(|&k| (k, y[k])));
            ends.push(entries.len());
            let sparse = |b: usize| &entries[ends[b]..ends[b + 1]];
            for b in 0..=a {
                let dense = if b < a { &before[b * n..][..n] } else { &*y };
                let (few, all) = if sparse(b).len() < sparse(a).len() { (sparse(b), &*y) } else { (sparse(a), dense) };
                let product: f64 = few.iter().map(|&(k, y)| y * all[k]).sum();
                (G[(a, b)], G[(b, a)]) = (product, product);
            }
        }
        [G, R]
    }

    /// A contact point next to a plane.
    pub fn touch(&self, theta: &[f64], point: usize, surface: &Surface) -> Touch {
        let of = &self.contacts.points[point];
        surface.touch(of, forward_kinematics(self.model, theta, of.frame))
    }

    /// The body Jacobian of a frame, unless the columns are already its.
    pub(super) fn columns(&self, theta: &[f64], frame: FrameId, (of, columns): &mut (Option<FrameId>, Vec<Twist>)) {
        if *of != Some(frame) {
            columns.resize(self.model.n(), Twist::zero());
            body_jacobian(self.model, theta, frame, columns);
            *of = Some(frame);
        }
    }

    /// The limits that act as stops.
    pub fn sides(&self) -> &[(usize, usize)] {
        self.stops.as_ref().map_or(&[], |(_, sides)| sides)
    }

    /// How far joint k is from its limit.
    pub fn room(&self, theta: &[f64], k: usize, side: usize) -> f64 {
        self.stops.as_ref().map_or(f64::INFINITY, |(bounds, _)| {
            let ([low, high], value) = (bounds.joints[k], bounds.value(theta, k));
            if side == 0 { value - low } else { high - value }
        })
    }

    /// Adds the stops and planes that a step which ends at (t, θ) would pass without being stopped, where a link with
    /// little inertia becomes fast within it; false if there are none.
    pub fn add_passed(&mut self, system: &System, t: f64, theta: &[f64], dtheta: &[f64]) -> bool {
        let acts = |k: usize, side: usize| system.rows.iter().any(|&(key, ..)| key == Key::Stop(k, side));
        let is_passed = |&&(k, side): &&(usize, usize)| self.room(theta, k, side) < -PASSED && !acts(k, side);
        let found: Vec<(usize, usize)> = self.sides().iter().filter(is_passed).copied().collect();
        self.passed.extend(&found);
        if dtheta.iter().all(|rate| rate.abs() < RESTS) {
            return !found.is_empty();
        }
        let touches = |pair| {
            let known = self.pressed.iter().chain(&self.memory.stands_for);
            system.touches.iter().map(|touching| &touching.pair).chain(known).any(|other| *other == pair)
        };
        let near = self.near([t, t], theta, theta).acting.into_iter();
        let deep = near.filter(|(.., touch)| touch.gap < -self.reach).map(|(point, plane, _)| (point, plane));
        let pressed: Vec<(usize, usize)> = deep.filter(|&pair| !touches(pair)).collect();
        self.pressed.extend(&pressed);
        !(found.is_empty() && pressed.is_empty())
    }

    /// True if a joint is farther beyond a stop than a start may be.
    pub(super) fn is_beyond(&self, theta: &[f64], k: usize, side: usize) -> bool {
        self.room(theta, k, side) < -2.0 * crate::events::stops::NEAR
    }

    /// True if any joint is.
    pub fn is_beyond_a_stop(&self, theta: &[f64]) -> bool {
        self.sides().iter().any(|&(k, side)| self.is_beyond(theta, k, side))
    }

    /// The rate of the joint towards its limit.
    pub(super) fn stop_row(&self, theta: &[f64], k: usize, side: usize) -> RowDVector<f64> {
        let mut row = RowDVector::zeros(self.model.n());
        if let Some((bounds, _)) = &self.stops {
            let place = bounds.places[k];
            let sign = if side == 0 { -1.0 } else { 1.0 };
            let gradient = place.bounded_gradient(theta);
            let count = if place.freedom == Freedom::Ball { 3 } else { 1 };
            (0..count).for_each(|i| row[place.j + i] = sign * gradient[i]);
        }
        row
    }
}

/// The velocity of the material at a touching point along an axis in {s}, from the body Jacobian of its frame.
pub(super) fn point_row(columns: &[Twist], touch: &Touch, axis: Vec3) -> RowDVector<f64> {
    let axis = touch.R.inverse_mul(axis);
    let moment = touch.of_frame.cross(axis);
    RowDVector::from_iterator(columns.len(), columns.iter().map(|V| V.v.dot(axis) + V.w.dot(moment)))
}
