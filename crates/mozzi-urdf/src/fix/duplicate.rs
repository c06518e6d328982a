//! A mass that is counted twice: a link and the one that a fixed joint attaches to it have the same inertia at the same
//! place.

use super::inertial::shortest;
use super::{Proposal, Robot};
use crate::edit::element::Editor;
use mozzi::SpatialInertia;
use mozzi::model::description::JointKind;

/// The inertias are the same up to this part.
const SAME: f64 = 1e-6;

pub(super) fn proposals(robot: &Robot<'_>) -> Vec<Proposal> {
    let fixed = robot.description.joints.iter().filter(|joint| joint.kind == JointKind::Fixed);
    let pair = fixed.filter_map(|joint| {
        let (above, below) = (robot.inertials.get(&joint.parent)?, robot.inertials.get(&joint.child)?);
        let (one, other) = (above.inertia(&above.numbers), below.inertia(&below.numbers));
        if one.mass <= 0.0 || !is_same(one, other.transformed(joint.origin)) {
            return None;
        }
        // the one without a shape is the copy
        let has_shape = |tag: super::Tag<'_>| tag.child("visual").is_some() || tag.child("collision").is_some();
        let is_above = !has_shape(above.link) && has_shape(below.link);
        let (copy, name, kept) = match is_above {
            true => (above, &joint.parent, &joint.child),
            false => (below, &joint.child, &joint.parent),
        };
        let mut editor = Editor::new(copy.tag.text);
        editor.remove(copy.tag);
        let mut proposal = robot.proposal("counted_twice", copy.link, &editor);
        proposal.change = format!("its <inertial> of {} kg is removed", shortest(copy.numbers.mass));
        proposal.reason = format!(
            "link `{kept}`, on the other side of the fixed joint `{}`, has the same inertia at the same place: the mass \
             is counted twice",
            joint.name
        );
        proposal.inertia = Some((name.clone(), copy.inertia(&copy.numbers), SpatialInertia::zero()));
        Some(proposal)
    });
    pair.collect()
}

fn is_same(a: SpatialInertia, b: SpatialInertia) -> bool {
    let (a, b) = (a.to_parameters(), b.to_parameters());
    let near = |range: std::ops::Range<usize>, least: f64| {
        let scale = a[range.clone()].iter().fold(least, |m, x| m.max(x.abs()));
        a[range.clone()].iter().zip(&b[range]).all(|(x, y)| (x - y).abs() <= SAME * scale)
    };
    // mass, its moment, moments of inertia
    near(0..1, 0.0) && near(1..4, 1e-3 * a[0]) && near(4..10, 0.0)
}
