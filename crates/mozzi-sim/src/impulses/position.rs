//! Positions after a step: contacts and stops that carry have no gap, feet that stick stay where they are.

use super::rows::point_row;
use super::{Impulses, Key};
use crate::Error;
use crate::contacts::{PlaneMotion, Touch};
use alloc::collections::BTreeMap;
use alloc::vec;
use alloc::vec::Vec;
use mozzi::constraints::constraint_jacobian;
use mozzi::linalg::Vec3;
use mozzi::model::FrameId;
use mozzi::model::Support;
use mozzi::model::integrate;
use nalgebra::{DMatrix, DVector, RowDVector};

/// Gaps below this are rounding, m.
const CLOSED: f64 = 1e-13;
const CORRECTIONS: usize = 3;
/// A correction that moves a joint farther may press other points into a plane, rad or m.
const STILL: f64 = 1e-5;
/// Rounds in which these points are added to the rows.
const ADDITIONS: usize = 3;
/// Joints this near to a limit are at it, rad or m.
const AT_LIMIT: f64 = 1e-11;
/// G is made regular by adding a part of its diagonal, because rows may be redundant, or more than the joints can meet:
/// the first of these with which the errors shrink and the robot moves at most `FARTHEST` times as far, in M's norm, as
/// it would for each row alone.
const REGULAR: [f64; 5] = [1e-10, 1e-8, 1e-6, 1e-4, 1e-2];
const FARTHEST: f64 = 10.0;
/// Anchors are so many times as compliant: where a joint cannot meet both, the gap closes.
const YIELDS: f64 = 1e7;
/// And relative to its largest entry: a row of a loop that holds anyway is rounding.
const NOISE: f64 = 1e-14;
/// No correction moves a joint farther than this, and twice what the fastest one moves in the step, rad or m.
const AT_ONCE: f64 = 0.03;

/// A row whose position is to be put right.
#[allow(clippy::large_enum_variant)] // a short list, made once a step
enum OpenRow {
    Constraint(RowDVector<f64>),
    /// A joint and the side of its limit.
    Stop(usize, usize),
    /// A point of a frame, along one of its axes.
    Point(FrameId, Touch, usize),
}

impl OpenRow {
    /// An anchor yields to gaps, loops and limits where it stands against them.
    fn compliance(&self) -> f64 {
        if matches!(self, OpenRow::Point(_, _, 1..)) { YIELDS } else { 1.0 }
    }
}

/// A configuration with its rows, what is left to move along them, and whether that is at most half as far.
struct Nearer {
    theta: Vec<f64>,
    open: Vec<OpenRow>,
    errors: DVector<f64>,
    halves: bool,
    /// The largest change of a joint, rad or m.
    farthest: f64,
}

impl Impulses<'_> {
    /// θ ← θ ⊕ δ with the least δᵀMδ that brings the contacts and stops that carried in the last step to gap 0, from
    /// either side, and sticking points back to their anchors. `h` is the length of the step, `moves` how far the
    /// fastest joint moves in it. Returns true if θ changed.
    pub fn correct(&mut self, t: f64, theta: &mut [f64], h: f64, moves: f64) -> Result<bool, Error> {
        let (stopped, most) = (core::mem::take(&mut self.memory.stopped), AT_ONCE + 2.0 * moves);
        if self.memory.carrying.is_empty() {
            self.memory.anchors.clear();
            return Ok(false);
        }
        self.move_anchors(h);
        self.set_anchors(t, theta, Some(&stopped));
        let mut pressed = Vec::new();
        let (mut open, mut errors) = self.open_rows(t, theta, &pressed);
        let mut changes = false;
        for correction in 0..CORRECTIONS {
            if errors.amax() < CLOSED {
                break;
            }
            if correction == 0 {
                self.mass.factor(theta, 0.0, &[])?;
            }
            let Some(nearer) = self.nearer_without_pressing(t, theta, (open, errors), &mut pressed, most) else {
                break;
            };
            theta.copy_from_slice(&nearer.theta);
            changes = true;
            if !nearer.halves {
                break;
            }
            (open, errors) = (nearer.open, nearer.errors);
        }
        self.set_anchors(t, theta, None);
        self.put_at_limits(theta);
        Ok(changes)
    }

    /// As [`nearer`](Self::nearer), with rows for the points that it would press into a plane. None if it still does.
    fn nearer_without_pressing(
        &mut self,
        t: f64,
        theta: &[f64],
        (mut open, mut errors): (Vec<OpenRow>, DVector<f64>),
        pressed: &mut Vec<(usize, usize)>,
        most: f64,
    ) -> Option<Nearer> {
        for _ in 0..=ADDITIONS {
            let nearer = self.nearer(t, theta, open, &errors, pressed, most)?;
            if nearer.farthest <= STILL {
                return Some(nearer);
            }
            let more = self.pressed(t, &nearer.theta, errors.amax(), pressed);
            if more.is_empty() {
                return Some(nearer);
            }
            pressed.extend(more);
            (open, errors) = self.open_rows(t, theta, pressed);
        }
        None
    }

    /// Points that did not carry and are deeper in a plane than the errors that are corrected: a link with little
    /// inertia would turn about those that did until it stands on another one, in each step on other ones.
    fn pressed(&self, t: f64, theta: &[f64], error: f64, known: &[(usize, usize)]) -> Vec<(usize, usize)> {
        let carries = |pair: (usize, usize)| {
            self.memory.carrying.iter().any(|&(key, _)| key == Key::Contact(pair.0, pair.1)) || known.contains(&pair)
        };
        let near = self.near([t, t], theta, theta).acting.into_iter();
        let deep = near.filter(|(.., touch)| touch.gap < -error.max(CLOSED));
        deep.map(|(point, plane, _)| (point, plane)).filter(|&pair| !carries(pair)).collect()
    }

    /// A configuration with smaller errors, Σ e²/G_rr, which is δᵀMδ as if each row were alone, of anchors a part of
    /// it. None if there is none.
    fn nearer(
        &mut self,
        t: f64,
        theta: &[f64],
        open: Vec<OpenRow>,
        errors: &DVector<f64>,
        pressed: &[(usize, usize)],
        most: f64,
    ) -> Option<Nearer> {
        let yields: Vec<f64> = open.iter().map(OpenRow::compliance).collect();
        let J = self.jacobian(theta, open);
        let [G, _] = self.delassus(&J);
        let least = NOISE * G.diagonal().amax() + f64::MIN_POSITIVE;
        let way = |e: &DVector<f64>, r: usize| e[r] * e[r] / (G[(r, r)] + least);
        let size = |e: &DVector<f64>| (0..e.len()).map(|r| way(e, r) / yields[r]).sum::<f64>();
        let before = size(errors);
        let farthest = FARTHEST * FARTHEST * (0..errors.len()).map(|r| way(errors, r)).sum::<f64>();
        let last = &REGULAR[REGULAR.len() - 1];
        REGULAR.iter().find_map(|regular| {
            let mut sum = G.clone();
            (0..G.nrows()).for_each(|r| sum[(r, r)] += G[(r, r)] * regular * yields[r] + least);
            let p = sum.cholesky()?.solve(errors);
            // δ = M⁻¹Jᵀp, δᵀMδ = pᵀG p
            if !(p.dot(&(&G * &p)) <= farthest) {
                return None;
            }
            let (mut change, mut theta) = (J.tr_mul(&p), theta.to_vec());
            self.mass.divide(change.as_mut_slice());
            let share = match most / change.amax() {
                enough if enough >= 1.0 => 1.0,
                less if regular == last => less,
                _ => return None, // a joint with hardly any inertia would turn by anything
            };
            integrate(self.model, &mut theta, change.as_slice(), share);
            let (open, errors) = self.open_rows(t, &theta, pressed);
            let (left, farthest) = (size(&errors), share * change.amax());
            (left < before).then_some(Nearer { theta, open, errors, halves: left < 0.25 * before, farthest })
        })
    }

    /// Joints that are at their limits to rounding are there exactly.
    fn put_at_limits(&self, theta: &mut [f64]) {
        for &(key, _) in &self.memory.carrying {
            let Key::Stop(k, side) = key else { continue };
            if self.room(theta, k, side).abs() < AT_LIMIT {
                self.put_at_limit(theta, k, side);
            }
        }
    }

    fn put_at_limit(&self, theta: &mut [f64], k: usize, side: usize) {
        let Some((bounds, _)) = &self.stops else { return };
        bounds.places[k].put_at_limit(theta, bounds.joints[k][side]);
    }

    /// Puts joints that are beyond their stops nevertheless at them: with hardly any inertia they come and go within a
    /// step. Loops hold theirs.
    pub fn put_within_stops(&self, theta: &mut [f64]) {
        if self.model.constraint_rows() > 0 {
            return;
        }
        for &(k, side) in self.sides() {
            if self.is_beyond(theta, k, side) {
                self.put_at_limit(theta, k, side);
            }
        }
    }

    /// Rows of the contacts, stops and constraints that hold and of points that would be pressed, and how far to move
    /// along them.
    fn open_rows(&mut self, t: f64, theta: &[f64], pressed: &[(usize, usize)]) -> (Vec<OpenRow>, DVector<f64>) {
        let (model, n) = (self.model, self.model.n());
        let (mut rows, mut errors) = (Vec::new(), Vec::new());
        let surfaces = self.surfaces(t);
        for &(key, sticks) in &self.memory.carrying {
            match key {
                Key::Stop(k, side) => {
                    rows.push(OpenRow::Stop(k, side));
                    errors.push(self.room(theta, k, side));
                }
                Key::Contact(point, plane) => {
                    let frame = self.contacts.points[point].frame;
                    let touch = self.touch(theta, point, &surfaces[plane]);
                    rows.push(OpenRow::Point(frame, touch, 0));
                    errors.push(touch.gap - self.memory.rebounds.get(&(point, plane)).unwrap_or(&0.0));
                    let anchor = self.memory.anchors.get(&(point, plane));
                    let Some(anchor) = anchor.filter(|_| sticks) else { continue };
                    let way = surfaces[plane].T * *anchor - touch.at;
                    for axis in 1..3 {
                        rows.push(OpenRow::Point(frame, touch, axis));
                        errors.push(touch.axes[axis].dot(way));
                    }
                }
                _ => {}
            }
        }
        for &(point, plane) in pressed {
            let touch = self.touch(theta, point, &surfaces[plane]);
            rows.push(OpenRow::Point(self.contacts.points[point].frame, touch, 0));
            errors.push(touch.gap);
        }
        let m = model.constraint_rows();
        if m > 0 {
            let (mut A, mut phi, still) = (vec![0.0; m * n], vec![0.0; m], vec![0.0; n]);
            constraint_jacobian(model, theta, &still, &mut self.mass.workspace, &mut A, &mut [], &mut phi);
            rows.extend(A.chunks_exact(n).map(|row| OpenRow::Constraint(RowDVector::from_row_slice(row))));
            errors.extend(phi.iter().map(|x| -x));
        }
        (rows, DVector::from_vec(errors))
    }

    /// These rows of velocities.
    fn jacobian(&self, theta: &[f64], open: Vec<OpenRow>) -> DMatrix<f64> {
        let mut columns = (None, Vec::new());
        let row = |open: OpenRow| match open {
            OpenRow::Constraint(row) => row,
            OpenRow::Stop(k, side) => self.stop_row(theta, k, side),
            OpenRow::Point(frame, touch, axis) => {
                self.columns(theta, frame, &mut columns);
                point_row(&columns.1, &touch, touch.axes[axis])
            }
        };
        DMatrix::from_rows(&open.into_iter().map(row).collect::<Vec<_>>())
    }

    /// The anchors on belts move with them.
    fn move_anchors(&mut self, h: f64) {
        for (&(_, plane), anchor) in &mut self.memory.anchors {
            if let PlaneMotion::Belt(T, v) = &self.contacts.planes[plane].motion {
                *anchor += T.R.inverse_mul(*v) * h;
            }
        }
    }

    /// Keeps the anchors of the points that stick, and sets those of points that begin to: where they are, or, of the
    /// `only` ones that came to rest within the step, by how far they are beyond where they did. A sphere or a disc has
    /// none: it rolls.
    fn set_anchors(&mut self, t: f64, theta: &[f64], only: Option<&BTreeMap<(usize, usize), [f64; 2]>>) {
        let surfaces = self.surfaces(t);
        let mut kept: BTreeMap<(usize, usize), Vec3> = BTreeMap::new();
        for &(key, sticks) in &self.memory.carrying {
            let Key::Contact(point, plane) = key else { continue };
            if !sticks || self.contacts.points[point].support != Support::Point {
                continue;
            }
            let pair = (point, plane);
            let known = self.memory.anchors.get(&pair).copied();
            let here = || surfaces[plane].T.inverse() * self.touch(theta, point, &surfaces[plane]).at;
            let anchor = match only {
                None => known.or_else(|| Some(here())),
                Some(stopped) => known.or_else(|| stopped.get(&pair).map(|&[x, y]| here() + Vec3([x, y, 0.0]))),
            };
            kept.extend(anchor.map(|anchor| (pair, anchor)));
        }
        self.memory.anchors = kept;
    }
}
