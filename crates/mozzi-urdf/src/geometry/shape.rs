//! A shape: its form, its pose, its colour.

use mozzi::{SE3, Solid};

/// A solid or a surface on a link.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// The link that it belongs to.
    pub link: String,
    /// Visual or collision shape.
    pub purpose: Purpose,
    /// Configuration of its frame relative to the link's.
    pub T: SE3,
    /// Its form.
    pub form: Form,
    /// Red, green, blue, opacity from 0 to 1, if the file gives them.
    pub color: Option<[f64; 4]>,
    /// True if it collides with planes: a URDF's `<collision>`; in MJCF a geom whose `contype` or `conaffinity` has the
    /// bit 1, whether it is drawn or not.
    pub touches: bool,
    /// Its own coefficient of sliding friction, in MJCF.
    pub friction: Option<f64>,
}

/// The purpose of a shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// `<visual>`; in MJCF a geom that MuJoCo draws: of the groups 0 to 2, and not transparent.
    Visual,
    /// `<collision>`; in MJCF another geom.
    Collision,
}

impl Purpose {
    /// "visual" or "collision".
    pub fn name(self) -> &'static str {
        match self {
            Purpose::Visual => "visual",
            Purpose::Collision => "collision",
        }
    }
}

/// A form about the origin of its own frame, lengths in metres.
#[derive(Clone, Debug, PartialEq)]
pub enum Form {
    /// With these edges along x, y, z.
    Box {
        /// Three edges.
        size: [f64; 3],
    },
    /// About z.
    Cylinder {
        /// Its radius.
        radius: f64,
        /// Along z.
        length: f64,
    },
    /// A cylinder about z, closed by two hemispheres.
    Capsule {
        /// Radius of cylinder and hemispheres.
        radius: f64,
        /// Length of the cylinder alone, along z.
        length: f64,
    },
    /// A ball.
    Sphere {
        /// Its radius.
        radius: f64,
    },
    /// An ellipsoid.
    Ellipsoid {
        /// Its semi-axes along x, y, z.
        radii: [f64; 3],
    },
    /// A surface in a file of its own.
    Mesh {
        /// As written; [`locate`](super::locate) finds the file.
        file: String,
        /// Scale factors that convert its coordinates to metres; negative ones mirror.
        scale: [f64; 3],
    },
}

impl Form {
    /// "box", "cylinder", "capsule", "ellipsoid", "sphere" or "mesh".
    pub fn name(&self) -> &'static str {
        match self {
            Form::Box { .. } => "box",
            Form::Cylinder { .. } => "cylinder",
            Form::Capsule { .. } => "capsule",
            Form::Ellipsoid { .. } => "ellipsoid",
            Form::Sphere { .. } => "sphere",
            Form::Mesh { .. } => "mesh",
        }
    }

    /// As a solid with formulas of its own; None for a mesh.
    pub fn solid(&self) -> Option<Solid> {
        Some(match *self {
            Form::Box { size } => Solid::Box(size),
            Form::Cylinder { radius, length } => Solid::Cylinder { radius, length },
            Form::Capsule { radius, length } => Solid::Capsule { radius, length },
            Form::Ellipsoid { radii } => Solid::Ellipsoid(radii),
            Form::Sphere { radius } => Solid::Sphere { radius },
            Form::Mesh { .. } => return None,
        })
    }

    /// Its lengths in the order of its fields; a mesh's scale factors.
    pub fn size(&self) -> Vec<f64> {
        match self {
            Form::Box { size } => size.to_vec(),
            Form::Cylinder { radius, length } | Form::Capsule { radius, length } => vec![*radius, *length],
            Form::Ellipsoid { radii } => radii.to_vec(),
            Form::Sphere { radius } => vec![*radius],
            Form::Mesh { scale, .. } => scale.to_vec(),
        }
    }
}
