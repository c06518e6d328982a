//! Replaces the inertia of a link.

use super::element::{Editor, Tag};
use super::joint::{ROUNDING, is_near};
use crate::text::number::numbers;
use crate::urdf::write::triple;
use mozzi::{SO3, SpatialInertia};

const MOMENTS: [&str; 6] = ["ixx", "ixy", "ixz", "iyy", "iyz", "izz"];

/// Rewrites the numbers that differ. The axes of `<inertial>` remain: I_file = Rᵀ I R.
pub(super) fn set_inertia<'a>(link: Tag<'a>, G: SpatialInertia, editor: &mut Editor<'a>) {
    let Some(inertial) = link.child("inertial") else {
        if G != SpatialInertia::zero() {
            insert(link, G, editor);
        }
        return;
    };
    let origin = inertial.child("origin");
    let old = |tag: Option<Tag>, name| tag.and_then(|tag| tag.attribute(name)).and_then(|text| numbers::<3>(text).ok());
    let c = G.center_of_mass();
    if !is_near(&old(origin, "xyz").unwrap_or_default(), &c.0) {
        match origin {
            Some(origin) => editor.set(origin, "xyz", Some(&triple(c))),
            None => editor.insert_first(inertial, &format!("<origin xyz=\"{}\"/>", triple(c))),
        }
    }
    if let Some(origin) = origin {
        editor.set(origin, "quat_xyzw", None); // URDF 1.1's replacement for rpy
    }
    let R = old(origin, "rpy").map_or_else(SO3::identity, |[roll, pitch, yaw]| SO3::from_rpy(roll, pitch, yaw));
    let I = G.about_center_of_mass().congruence(R.inverse().matrix());
    let set = |tag: Option<Tag<'a>>, names: &[&str], values: &[f64], editor: &mut Editor<'a>| {
        let Some(tag) = tag else { return };
        let scale = values.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        for (name, value) in names.iter().zip(values) {
            let old = tag.attribute(name).and_then(|text| numbers::<1>(text).ok());
            if !old.is_some_and(|[old]| (old - value).abs() <= ROUNDING * scale) {
                editor.set(tag, name, Some(&format!("{value:?}")));
            }
        }
    };
    set(inertial.child("mass"), &["value"], &[G.mass], editor);
    set(inertial.child("inertia"), &MOMENTS, &[I.xx, I.xy, I.xz, I.yy, I.yz, I.zz], editor);
}

/// A comment with the numbers that a link had before.
pub(super) fn comment_of(G: SpatialInertia) -> String {
    let (c, I) = (G.center_of_mass(), G.about_center_of_mass());
    let values = [I.xx, I.xy, I.xz, I.yy, I.yz, I.zz];
    let moments: Vec<String> = MOMENTS.iter().zip(values).map(|(name, value)| format!("{name} {value:?}")).collect();
    format!("<!-- before: mass {:?}, centre {}, {} -->", G.mass, triple(c), moments.join(" "))
}

fn insert<'a>(link: Tag<'a>, G: SpatialInertia, editor: &mut Editor<'a>) {
    let (c, I) = (G.center_of_mass(), G.about_center_of_mass());
    let values = [I.xx, I.xy, I.xz, I.yy, I.yz, I.zz];
    let moments: String = MOMENTS.iter().zip(values).map(|(name, value)| format!(" {name}=\"{value:?}\"")).collect();
    let element = format!(
        "<inertial><origin xyz=\"{}\"/><mass value=\"{:?}\"/><inertia{moments}/></inertial>",
        triple(c),
        G.mass
    );
    editor.insert_first(link, &element);
}
