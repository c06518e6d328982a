//! A locked joint becomes a fixed joint, with its child's pose as origin; other friction, armature or springs are
//! attributes of `<dynamics>`.

use super::element::{Editor, Tag};
use crate::text::number::numbers;
use crate::urdf::write::triple;
use mozzi::model::description::Joint;
use mozzi::{SE3, Vec3};

pub(super) fn lock<'a>(joint: Tag<'a>, origin: SE3, editor: &mut Editor<'a>) {
    editor.set(joint, "type", Some("fixed"));
    if let Some(mimic) = joint.child("mimic") {
        editor.remove(mimic);
    }
    place(joint, origin, editor);
}

/// Rewrites the attributes of `<dynamics>` that differ.
pub(super) fn set_dynamics<'a>(tag: Tag<'a>, old: &Joint, new: &Joint, keeps_old: bool, editor: &mut Editor<'a>) {
    let of = |joint: &Joint| {
        [
            ("damping", joint.damping),
            ("friction", joint.friction),
            ("armature", joint.armature),
            ("spring_stiffness", joint.stiffness),
            ("spring_reference", joint.spring_reference),
        ]
    };
    let changed: Vec<_> = of(old).into_iter().zip(of(new)).filter(|(old, new)| old.1 != new.1).collect();
    if changed.is_empty() {
        return;
    }
    match tag.child("dynamics") {
        Some(dynamics) => {
            changed.iter().for_each(|(_, (name, value))| editor.set(dynamics, name, Some(&format!("{value:?}"))));
        }
        None => {
            let attributes: String =
                changed.iter().map(|(_, (name, value))| format!(" {name}=\"{value:?}\"")).collect();
            editor.insert_last(tag, &[format!("<dynamics{attributes}/>")]);
        }
    }
    if keeps_old {
        let values: Vec<String> = changed.iter().map(|((name, value), _)| format!("{name} {value:?}")).collect();
        editor.insert_first(tag, &format!("<!-- before: {} -->", values.join(", ")));
    }
}

/// Rewrites those attributes of `<origin>` that differ.
fn place<'a>(parent: Tag<'a>, T: SE3, editor: &mut Editor<'a>) {
    let rpy = Vec3(T.R.to_rpy());
    let Some(origin) = parent.child("origin") else {
        if T != SE3::identity() {
            let rotation = if rpy == Vec3::zero() { String::new() } else { format!(" rpy=\"{}\"", triple(rpy)) };
            editor.insert_first(parent, &format!("<origin xyz=\"{}\"{rotation}/>", triple(T.p)));
        }
        return;
    };
    let written = |name: &str| origin.attribute(name).map_or(Some([0.0; 3]), |text| numbers::<3>(text).ok());
    if !written("xyz").is_some_and(|xyz| is_near(&xyz, &T.p.0)) {
        editor.set(origin, "xyz", Some(&triple(T.p)));
    }
    let is_rpy = origin.attribute("quat_xyzw").is_none();
    let turned = written("rpy").map(|[r, p, y]| mozzi::SO3::from_rpy(r, p, y).matrix().rows());
    if !(is_rpy && turned.is_some_and(|R| is_near(R.as_flattened(), T.R.matrix().rows().as_flattened()))) {
        editor.set(origin, "quat_xyzw", None);
        editor.set(origin, "rpy", Some(&triple(rpy)));
    }
}

/// Rotations and sums change a number by a few ε, which is no reason to rewrite it.
pub(super) const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Equal up to rounding.
pub(super) fn is_near(a: &[f64], b: &[f64]) -> bool {
    let scale = a.iter().chain(b).fold(0.0_f64, |most, x| most.max(x.abs()));
    a.iter().zip(b).all(|(a, b)| (a - b).abs() <= ROUNDING * scale)
}
