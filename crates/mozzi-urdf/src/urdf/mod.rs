//! URDF: one element a file, and its writer.

pub(crate) mod axis;
pub(crate) mod drake;
pub(crate) mod expressible;
pub(crate) mod extension;
pub(crate) mod floating;
pub(crate) mod inertial;
pub(crate) mod joint;
pub(crate) mod limit;
pub(crate) mod link;
pub(crate) mod origin;
pub(crate) mod robot;
pub(crate) mod series;
pub(crate) mod transmission;
pub(crate) mod version;
pub(crate) mod vocabulary;
pub(crate) mod write;
