//! The moving bodies of a robot, and the base.

use mozzi::model::description::JointKind;
use mozzi::{FrameId, Model, SpatialInertia, Vec3};

/// The drawn bodies: body 0, the base, and body k, the k-th moving link, in the order of [`Model::moving_joints`]. All
/// data are in the frame of the body's link in the file.
#[derive(Debug)]
pub struct Bodies {
    pub names: Vec<String>,
    /// The frames of their links; none if the model has no such frame.
    pub frames: Vec<Option<FrameId>>,
    pub inertias: Vec<SpatialInertia>,
    /// Where the joint acts: a ball's centre, else the point of the screw axis that is nearest to the origin.
    pub points: Vec<Vec3>,
}

impl Bodies {
    pub fn new(model: &Model) -> Self {
        let names: Vec<String> = (model.folded_links().iter())
            .map(|body| body.links.first().map_or_else(String::new, |(name, _)| (*name).to_string()))
            .collect();
        let parameters = model.parameters();
        let mut inertias: Vec<_> =
            parameters.as_chunks::<10>().0.iter().copied().map(SpatialInertia::from_parameters).collect();
        if !model.is_floating() {
            inertias.insert(0, model.base_inertia());
        }
        inertias.truncate(names.len()); // the joints' parameters come after the bodies'
        let point = |kind: JointKind| match kind {
            JointKind::Screw(A) => A.twist().w.cross(A.twist().v),
            JointKind::Ball(center) => center,
            JointKind::Free | JointKind::Fixed => Vec3::zero(),
        };
        Bodies {
            frames: names.iter().map(|name| model.frame(name).ok()).collect(),
            names,
            inertias,
            points: std::iter::once(Vec3::zero()).chain(model.moving_joints().map(|joint| point(joint.kind))).collect(),
        }
    }

    /// The body that carries a link or frame of the description.
    pub fn of_frame(&self, model: &Model, frame: &str) -> usize {
        let description = model.description();
        let link = description.frames.iter().find(|known| known.name == frame).map_or(frame, |known| &known.link);
        let folded = model.folded_links();
        folded.iter().position(|body| body.links.iter().any(|(name, _)| *name == link)).unwrap_or(0)
    }
}
