//! The quantities of a robot and of one of its frames.

use mozzi::FrameId;
use mozzi::quantities::{LIST, Of, Query};

/// All but those of a point or a task.
pub fn quantities(frame: FrameId) -> impl Iterator<Item = Query<'static>> {
    (0..LIST.len()).map(Query::at).filter_map(move |query| match query.declaration().of {
        Of::Robot => Some(query),
        Of::Frame => Some(query.of(frame)),
        Of::Point | Of::Task => None,
    })
}
