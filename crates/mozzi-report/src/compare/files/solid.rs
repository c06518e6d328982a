//! The inertia of a link's shapes.

use mozzi::{SpatialInertia, Sym3};
use mozzi_urdf::geometry::{Form, Purpose, Shape};
use std::f64::consts::PI;

/// Shapes of a link, filled with 1 kg/m³: those for contacts, else those for pictures. None without a shape, or with a
/// mesh, whose file is not read here.
pub fn of_link(shapes: &[Shape], link: &str) -> Option<SpatialInertia> {
    let of = |purpose: Purpose| shapes.iter().filter(|s| s.link == link && s.purpose == purpose).collect::<Vec<_>>();
    let own = Some(of(Purpose::Collision)).filter(|list| !list.is_empty()).unwrap_or_else(|| of(Purpose::Visual));
    let solids: Option<Vec<SpatialInertia>> = own.into_iter().map(|s| Some(solid(&s.form)?.transformed(s.T))).collect();
    solids.filter(|list| !list.is_empty()).map(|list| list.into_iter().fold(SpatialInertia::zero(), |a, b| a + b))
}

/// About its own frame.
fn solid(form: &Form) -> Option<SpatialInertia> {
    let whole = |volume: f64, [x, y, z]: [f64; 3]| {
        Some(SpatialInertia::new(volume, mozzi::Vec3::zero(), Sym3::diagonal(volume * x, volume * y, volume * z)))
    };
    match *form {
        Form::Box { size: [x, y, z] } => {
            whole(x * y * z, [(y * y + z * z) / 12.0, (x * x + z * z) / 12.0, (x * x + y * y) / 12.0])
        }
        Form::Sphere { radius: r } => whole(4.0 / 3.0 * PI * r.powi(3), [0.4 * r * r; 3]),
        Form::Ellipsoid { radii: [a, b, c] } => {
            whole(4.0 / 3.0 * PI * a * b * c, [(b * b + c * c) / 5.0, (a * a + c * c) / 5.0, (a * a + b * b) / 5.0])
        }
        Form::Cylinder { radius: r, length: l } => {
            let across = (3.0 * r * r + l * l) / 12.0;
            whole(PI * r * r * l, [across, across, 0.5 * r * r])
        }
        Form::Capsule { radius: r, length: l } => {
            // two hemispheres, whose centres of mass are 3r/8 from their planes
            let (tube, ball) = (PI * r * r * l, 4.0 / 3.0 * PI * r.powi(3));
            let ends = ball * (0.4 * r * r + 0.25 * l * l + 0.375 * l * r);
            let across = tube * (3.0 * r * r + l * l) / 12.0 + ends;
            let volume = tube + ball;
            whole(volume, [across / volume, across / volume, (tube * 0.5 + ball * 0.4) * r * r / volume])
        }
        Form::Mesh { .. } => None,
    }
}
