//! Constraints as the kernels read them: anchors in the links' normal frames, rows, and the velocities they couple.

use super::description::{Anchor, Closure, ConstraintKind, Description, Gear};
use super::{Frame, Link};
use crate::lie::SE3;
use crate::linalg::ldlt::Pattern;
use crate::scalar::{Real, Scalar};
use alloc::collections::BTreeMap;
use alloc::vec::Vec;

/// The constraints of a model.
#[derive(Clone, Debug)]
pub(crate) struct Ties<C> {
    pub list: Vec<Tie<C>>,
    /// m, the number of rows of A.
    pub rows: usize,
}

/// One constraint.
#[derive(Clone, Debug)]
pub(crate) struct Tie<C> {
    /// Its first row of A.
    pub first: usize,
    /// The columns in which its rows are not zero, and their ancestors in the factors of M; the last first.
    pub support: Vec<usize>,
    pub kind: TieKind<C>,
}

#[derive(Clone, Debug)]
pub(crate) enum TieKind<C> {
    Frames { a: End<C>, b: End<C>, closure: Closure<C> },
    Joint { joints: Vec<Own<C>>, source: Vec<Own<C>>, polynomial: [C; 5] },
}

/// An anchor. A slot of `None` is {s}; a fixed base is {s}, too.
#[derive(Clone, Copy, Debug)]
pub(crate) struct End<C> {
    pub slot: Option<usize>,
    /// Its configuration in the link's normal frame.
    pub T: SE3<C>,
}

/// A multiple of a joint's position, ratio · θ + offset.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Own<C> {
    pub q: usize,
    pub j: usize,
    pub ratio: C,
    pub offset: C,
}

impl<C> TieKind<C> {
    /// The number of its rows.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn rows(&self) -> usize {
        match self {
            TieKind::Joint { .. } => 1,
            TieKind::Frames { closure, .. } => closure.rows().len(),
        }
    }

    /// The number of its rows of angular velocities, which come first.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn angular_rows(&self) -> usize {
        match self {
            TieKind::Frames { closure: Closure::Weld, .. } => 3,
            TieKind::Frames { closure: Closure::Hinge, .. } => 2,
            _ => 0,
        }
    }
}

impl<C: Scalar> Ties<C> {
    pub fn map<U>(&self, f: impl Fn(C) -> U + Copy) -> Ties<U> {
        let end = |end: End<C>| End { slot: end.slot, T: end.T.map(f) };
        let own = |own: Own<C>| Own { q: own.q, j: own.j, ratio: f(own.ratio), offset: f(own.offset) };
        let tie = |tie: &Tie<C>| Tie {
            first: tie.first,
            support: tie.support.clone(),
            kind: match &tie.kind {
                TieKind::Frames { a, b, closure } => {
                    TieKind::Frames { a: end(*a), b: end(*b), closure: closure.map(f) }
                }
                TieKind::Joint { joints, source, polynomial } => {
                    let [joints, source] = [joints, source].map(|sum| sum.iter().copied().map(own).collect());
                    TieKind::Joint { joints, source, polynomial: polynomial.map(f) }
                }
            },
        };
        Ties { list: self.list.iter().map(tie).collect(), rows: self.rows }
    }
}

/// The constraints of a checked description, by the frames and links of its normal form.
pub(super) fn ties<C: Real>(
    description: &Description<C>,
    frames: &[Frame<C>],
    links: &[Link<C>],
    moving_joints: &[usize],
    pattern: &Pattern,
    is_floating: bool,
) -> Ties<C> {
    let names = description.links.iter().map(|l| &l.name).chain(description.frames.iter().map(|f| &f.name));
    let names: BTreeMap<&str, usize> = names.enumerate().map(|(k, name)| (name.as_str(), k)).collect();
    let joint_names = moving_joints.iter().map(|&i| description.joints[i].name.as_str());
    // among the links of one joint the first, whose position is the joint's own
    let slots: BTreeMap<&str, usize> = joint_names.enumerate().rev().map(|(slot, name)| (name, slot)).collect();
    let end = |anchor: &Anchor<C>| match &anchor.frame {
        None if is_floating => End { slot: None, T: anchor.T },
        None => End { slot: Some(0), T: anchor.T },
        Some(name) => {
            let Frame { slot, T } = frames[names.get(name.as_str()).copied().unwrap_or_default()];
            End { slot: Some(slot), T: T * anchor.T }
        }
    };
    let own = |gear: &Gear<C>| {
        let Link { q, j, ratio, offset, .. } = links[slots.get(gear.joint.as_str()).copied().unwrap_or_default()];
        Own { q, j, ratio: gear.ratio * ratio, offset: gear.ratio * offset }
    };
    let (mut list, mut rows) = (Vec::new(), 0);
    for constraint in &description.constraints {
        let kind = match &constraint.kind {
            ConstraintKind::Frames { a, b, closure } => TieKind::Frames { a: end(a), b: end(b), closure: *closure },
            ConstraintKind::Joint { joints, source, polynomial } => {
                let [joints, source] = [joints, source].map(|sum| sum.iter().map(own).collect());
                TieKind::Joint { joints, source, polynomial: *polynomial }
            }
        };
        let moved = match &kind {
            TieKind::Frames { a, b, .. } => between(a.slot, b.slot, links),
            TieKind::Joint { joints, source, .. } => joints.iter().chain(source).map(|own| own.j).collect(),
        };
        let mut support: Vec<usize> =
            moved.iter().flat_map(|&j| core::iter::once(j).chain(pattern.ancestors(j))).collect();
        support.sort_unstable_by(|a, b| b.cmp(a));
        support.dedup();
        list.push(Tie { first: rows, support, kind });
        rows += constraint.row_names().len();
    }
    Ties { list, rows }
}

/// The velocities that move one slot relative to another.
fn between<C>(a: Option<usize>, b: Option<usize>, links: &[Link<C>]) -> Vec<usize> {
    let mut moved = Vec::new();
    if a.is_none() != b.is_none() {
        moved.extend(0..6);
    }
    moved.extend(Way::new(links, [a, b]).map(|(_, slot)| links[slot - 1].j));
    moved
}

/// The slots on the paths from two slots to the one that carries both, the last first, each with the end that it
/// carries: 0 or 1. {s} is beyond the base.
pub(crate) struct Way<'m, C> {
    links: &'m [Link<C>],
    slots: [usize; 2],
}

impl<'m, C> Way<'m, C> {
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn new(links: &'m [Link<C>], [a, b]: [Option<usize>; 2]) -> Self {
        Way { links, slots: [a.unwrap_or(0), b.unwrap_or(0)] }
    }
}

impl<C> Iterator for Way<'_, C> {
    type Item = (usize, usize);

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn next(&mut self) -> Option<(usize, usize)> {
        let [a, b] = self.slots;
        if a == b {
            return None;
        }
        let (k, slot) = if b > a { (1, b) } else { (0, a) };
        self.slots[k] = self.links[slot - 1].parent;
        Some((k, slot))
    }
}

impl<C: Scalar> Own<C> {
    /// The joint's position, ratio · θ + offset.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn position<S: Scalar + From<C>>(&self, theta: &[S]) -> S {
        S::from(self.ratio).mul_add(theta[self.q], S::from(self.offset))
    }
}

impl<C: Scalar> Closure<C> {
    /// Converts its number by `f`.
    pub(crate) fn map<U>(self, f: impl Fn(C) -> U) -> Closure<U> {
        match self {
            Closure::Point => Closure::Point,
            Closure::Weld => Closure::Weld,
            Closure::Hinge => Closure::Hinge,
            Closure::Distance(length) => Closure::Distance(f(length)),
            Closure::Rolling(radius) => Closure::Rolling(f(radius)),
        }
    }
}
