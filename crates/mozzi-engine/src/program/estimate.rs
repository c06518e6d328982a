//! Estimates the length of a program without recording it.

use mozzi::Model;
use mozzi::quantities::{ForwardDynamics, Query};
use std::collections::HashMap;

/// Operations for a link in a recursion, and in the articulated-body algorithm.
const LINK: f64 = 100.0;
const ARTICULATED: f64 = 300.0;
/// Operations for a matrix entry between two joints.
const ENTRY: f64 = 30.0;
/// Least bytes of machine code for an operation.
const BYTES: f64 = 5.0;
/// Estimates beyond this are of code that is too long for every shape; recording it would take tens of milliseconds.
const LONGEST: f64 = 1_000_000.0;

/// A source text with more operations is reported as too long: a compiler takes minutes to optimize it.
pub const LONGEST_TEXT: f64 = 150_000.0;

/// About how many operations the program of this quantity has, at a cost of O(links), for a robot with few zeros in its
/// axes and placements, for which folding removes the least.
pub fn estimate<'q>(model: &Model, query: impl Into<Query<'q>>) -> f64 {
    let query = query.into();
    let tree = Tree::of(model);
    let n = model.n() as f64;
    if query == ForwardDynamics.into() && !model.solves_by_mass_matrix() {
        return ARTICULATED * tree.links;
    }
    let matrices = query.shapes(model).iter().filter(|shape| shape[..] == [model.n(), model.n()]).count() as f64;
    let entries: f64 = query.output_lengths(model).map(|length| length as f64).sum::<f64>() - matrices * n * n;
    let divisions = if query.declaration().divides { tree.by_mass_matrix() * matrices.max(1.0) } else { 0.0 };
    LINK * tree.links + 2.0 * ENTRY * matrices * tree.depths + entries + divisions
}

/// True if forward dynamics by the mass matrix is so much longer than by the articulated-body algorithm that it need
/// not be recorded.
pub(crate) fn is_deep(model: &Model) -> bool {
    let tree = Tree::of(model);
    tree.by_mass_matrix() > 10.0 * ARTICULATED * tree.links
}

/// True if the machine code would be several times too long.
pub fn is_too_long<'q>(model: &Model, query: impl Into<Query<'q>>) -> bool {
    estimate(model, query) * BYTES > LONGEST
}

/// Sums over the moving links.
struct Tree {
    links: f64,
    /// Σ d, with d the number of joints that move a link.
    depths: f64,
    /// Σ d².
    squares: f64,
}

impl Tree {
    fn of(model: &Model) -> Self {
        let robot = model.description();
        let parents: HashMap<&str, (&str, f64)> = robot
            .joints
            .iter()
            .map(|joint| (joint.child.as_str(), (joint.parent.as_str(), f64::from(joint.kind.name() != "fixed"))))
            .collect();
        let mut depths: HashMap<&str, f64> = HashMap::new();
        let mut tree = Tree { links: model.moving_links() as f64 + 1.0, depths: 0.0, squares: 0.0 };
        for joint in &robot.joints {
            // up to a link whose depth is known, then down again
            let (mut way, mut link) = (Vec::new(), joint.child.as_str());
            while let (None, Some(&(parent, moves))) = (depths.get(link), parents.get(link)) {
                way.push((link, moves));
                link = parent;
            }
            let mut depth = depths.get(link).copied().unwrap_or(if model.is_floating() { 6.0 } else { 0.0 });
            for (link, moves) in way.into_iter().rev() {
                depth += moves;
                depths.insert(link, depth);
                (tree.depths, tree.squares) = (tree.depths + moves * depth, tree.squares + moves * depth * depth);
            }
        }
        tree
    }

    /// The cost of M, its factorization, and a solution.
    fn by_mass_matrix(&self) -> f64 {
        LINK * self.links + ENTRY * self.depths + 0.5 * self.squares
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Arguments, record_quantity};
    use mozzi::quantities::{InverseDynamics, LIST, MassMatrix};
    use mozzi::{Description, SE3, ScrewAxis, SpatialInertia};

    fn chain(joints: usize) -> Model {
        use mozzi::model::description::{Joint, JointKind};
        let mut robot = Description::new("chain").link("0", SpatialInertia::zero());
        for k in 0..joints {
            let axis = if k % 2 == 0 { [0.0, 1.0, 0.0] } else { [0.6, 0.0, 0.8] };
            let kind = JointKind::Screw(ScrewAxis::new(axis, [0.0; 3]).expect("unit"));
            let (parent, child) = (k.to_string(), (k + 1).to_string());
            let inertia = SpatialInertia::point_mass(1.0, mozzi::Vec3([0.1, 0.2, 0.3]));
            let origin = SE3::translation([0.1, 0.02, 0.3]);
            robot = robot.link(&child, inertia).joint(Joint::new(format!("j{k}"), &parent, &child, origin, kind));
        }
        robot.build().expect("sound")
    }

    #[test]
    fn estimates_are_of_the_right_size() {
        let model = chain(12);
        for query in [Query::from(InverseDynamics), MassMatrix.into(), ForwardDynamics.into()] {
            let found = record_quantity(&model, query, Arguments::default()).expect("its own").count().flops() as f64;
            let ratio = estimate(&model, query) / found;
            assert!((0.2..5.0).contains(&ratio), "{}: {ratio} of {found}", query.name());
        }
    }

    #[test]
    fn long_programs_are_declined_at_once() {
        let model = chain(2000);
        for query in (0..LIST.len()).map(Query::at).filter(|query| !query.shapes(&model).is_empty()) {
            let _ = is_too_long(&model, query);
        }
        for query in [Query::from(InverseDynamics), MassMatrix.into(), ForwardDynamics.into()] {
            assert!(is_too_long(&model, query) && estimate(&model, query) > LONGEST_TEXT, "{}", query.name());
        }
        assert!(is_deep(&model) && !is_deep(&chain(8)));
        assert!(!is_too_long(&chain(30), InverseDynamics));
    }
}
