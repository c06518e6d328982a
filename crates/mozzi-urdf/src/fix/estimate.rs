//! Inertias from shapes and a density, for links that have none or that are doubted.

use super::fit::Detail;
use super::inertial::shortest;
use super::{Repairs, with_robot};
use crate::edit::element::Editor;
use crate::edit::inertial::set_inertia;
use crate::{EditError, Settings};
use mozzi::linalg::Sym3;
use mozzi::{SpatialInertia, Vec3};
use std::path::Path;

/// A proposal for each link with a readable shape: the convex hull of its shapes, filled with this density, kg/m³.
/// A given mass of more than 0 is kept, and only its distribution is that of the shape.
///
/// # Errors
/// As [`proposals`](super::proposals).
pub fn estimates(
    file_name: &str,
    text: &str,
    density: f64,
    mesh_root: Option<&Path>,
    settings: &Settings,
) -> Result<Repairs, EditError> {
    with_robot(file_name, text, mesh_root, settings, Detail::All, |robot| {
        let links = robot.root.children().filter(|tag| tag.name() == "link");
        let all = links.filter_map(|link| {
            let name = link.attribute("name")?;
            let solid = robot.solid(name)?;
            let old = robot.inertials.get(name).map(|inertial| inertial.inertia(&inertial.numbers));
            let given = old.map(|G| G.mass).filter(|mass| *mass > 0.0);
            let mass = given.unwrap_or(density * solid.moments.size);
            let (center, I) = without_noise(solid.moments.center, solid.moments.I * (1.0 / solid.moments.size));
            let new = SpatialInertia::new(mass, center, I * mass);
            let mut editor = Editor::new(link.text);
            let changes = set_inertia(link, new, shortest, &mut editor);
            if changes.is_empty() {
                return None;
            }
            let mut proposal = robot.proposal("estimated_inertia", link, &editor);
            proposal.change = changes.join(", ");
            let volume = mozzi::spatial::Rounded(solid.moments.size);
            proposal.reason = match given {
                Some(_) => format!("the hull of its shapes has {volume} m³, filled evenly with the given mass"),
                None => format!("the hull of its shapes has {volume} m³, filled with {density:?} kg/m³"),
            };
            proposal.inertia = Some((name.to_string(), old.unwrap_or_else(SpatialInertia::zero), new));
            Some(proposal)
        });
        all.collect()
    })
}

/// A centre, and the moments about it per mass, with 0 in place of what the sums over a symmetric hull leave of it.
fn without_noise(center: Vec3, I: Sym3) -> (Vec3, Sym3) {
    let square = 1e-13 * I.trace();
    let kept = |x: f64, noise: f64| if x.abs() <= noise { 0.0 } else { x };
    let product = |x| kept(x, square);
    let length = 1e-13 * I.trace().sqrt();
    let center = Vec3(center.0.map(|x| kept(x, length)));
    (center, Sym3 { xy: product(I.xy), xz: product(I.xz), yz: product(I.yz), ..I })
}
