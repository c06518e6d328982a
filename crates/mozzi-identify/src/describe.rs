//! The identified parameters as links and joints of the robot's file.

use crate::columns::Columns;
use crate::estimate::pseudo_inertia::pseudo_inertia;
use crate::predict::parameters;
use crate::{Error, Finding};
use mozzi::{Description, SE3, SpatialInertia};

/// The file's robot with the identified parameters. A link keeps the inertias of the links that are fixed to it, and
/// takes what is left; if no body could have the rest, theirs are scaled down. `original` is the file's description, in
/// which joints may move that are locked in the model.
///
/// # Errors
/// [`Error::Model`] if the model's frames have no poses.
pub fn describe(
    columns: &Columns<'_>,
    x: &[f64],
    original: &Description,
) -> Result<(Description, Vec<Finding>), Error> {
    let model = columns.model;
    let (pi, names) = (parameters(columns, x)?, model.parameter_names());
    let mut robot = original.clone();
    let mut findings = Vec::new();
    let before = model.parameters();
    let poses = model.frame_poses(&model.neutral_configuration())?;
    let pose = |link: &str| model.frames().position(|(_, name)| name == link).map_or(SE3::identity(), |k| poses[k]);
    let value = |name: String| names.iter().position(|known| *known == name).map(|k| (before[k], pi[k]));
    let moved = model.moving_joints().map(|joint| joint.child.as_str());
    let base = model.is_floating().then(|| base_link(model.description())).flatten();
    for link in moved.chain(base) {
        let Some(first) = names.iter().position(|name| name.strip_suffix(".m") == Some(link)) else { continue };
        // what no datum reaches keeps its digits
        let change = (first..first + 10).map(|k| (pi[k] - before[k]).abs()).fold(0.0, f64::max);
        if change <= 1e-6 * before[first..first + 10].iter().fold(0.0_f64, |most, x| most.max(x.abs())) {
            continue;
        }
        let total = kept(&before[first..first + 10], &pi[first..first + 10]);
        let fixed = fixed_to(model.description(), link);
        let to_link = pose(link).inverse();
        let inertia = |name: &str| robot.links.iter().find(|one| one.name == name).map(|one| one.inertia);
        let of_fixed = fixed.iter().filter_map(|name| Some(inertia(name)?.transformed(to_link * pose(name))));
        let sum = of_fixed.fold(SpatialInertia::zero(), |sum, one| sum + one).to_parameters();
        let share = share(&total, &sum);
        if share < 1.0 {
            findings.push(Finding::note(
                "scaled_links",
                format!(
                    "{} are heavier than the whole that moves with {link}: their inertias are scaled by {share:.3}",
                    fixed.join(", ")
                ),
            ));
        }
        for one in &mut robot.links {
            if one.name == link {
                one.inertia = SpatialInertia::from_parameters(core::array::from_fn(|k| total[k] - share * sum[k]));
            } else if share < 1.0 && fixed.contains(&one.name.as_str()) {
                one.inertia = one.inertia.map(|x| share * x);
            }
        }
    }
    let joints: Vec<String> = model.joint_names().map(str::to_string).collect();
    for name in joints {
        let followers: Vec<(usize, [f64; 2])> = robot
            .joints
            .iter()
            .enumerate()
            .filter_map(|(k, joint)| Some((k, original.source_of(&joint.name)?)))
            .filter(|(_, source)| original.joints[source.joint].name == name)
            .map(|(k, source)| (k, [source.ratio, source.offset]))
            .collect();
        for (kind, power) in [("armature", 2), ("damping", 2), ("friction", 1), ("stiffness", 2)] {
            let Some((old, new)) = value(format!("{name}.{kind}")).filter(|(old, new)| old != new) else { continue };
            for &(k, [ratio, offset]) in &followers {
                let joint = &mut robot.joints[k];
                let field = match kind {
                    "armature" => &mut joint.armature,
                    "damping" => &mut joint.damping,
                    "friction" => &mut joint.friction,
                    _ => &mut joint.stiffness,
                };
                // the sum over joint and followers, Σ |ratio|^power, becomes the new one
                *field = match old > 0.0 {
                    true => *field * new / old,
                    false if joint.name == name => new / ratio.abs().powi(power),
                    false => *field,
                };
                if kind == "stiffness" && old > 0.0 && new > 0.0 {
                    let rest = &mut joint.spring_reference;
                    *rest = offset + (*rest - offset) * old / new; // the preload stays
                }
            }
        }
    }
    for rotor in &mut robot.rotors {
        if let Some((_, new)) = value(format!("{}.armature", rotor.name)) {
            rotor.armature = new;
        }
    }
    Ok((robot, findings))
}

/// A link's new parameters, with the old digits of those that hardly changed.
fn kept(before: &[f64], after: &[f64]) -> [f64; 10] {
    const HARDLY: f64 = 1e-9;
    let scale = |k: usize| match k {
        0 => 0..1,
        1..=3 => 1..4,
        _ => 4..10,
    };
    core::array::from_fn(|k| {
        let size = scale(k).map(|i| after[i].abs()).fold(0.0, f64::max);
        if (after[k] - before[k]).abs() <= HARDLY * size { before[k] } else { after[k] }
    })
}

/// The link that no joint moves.
fn base_link(robot: &Description) -> Option<&str> {
    let is_child = |name: &str| robot.joints.iter().any(|joint| joint.child == name);
    robot.links.iter().map(|link| link.name.as_str()).find(|name| !is_child(name))
}

/// The links that fixed joints hang on a link, directly or one after another.
fn fixed_to<'r>(robot: &'r Description, link: &'r str) -> Vec<&'r str> {
    let (mut all, mut next) = (vec![link], 0);
    while let Some(&parent) = all.get(next) {
        let is_fixed =
            |joint: &&mozzi::model::description::Joint| joint.parent == parent && joint.kind.name() == "fixed";
        all.extend(robot.joints.iter().filter(is_fixed).map(|joint| joint.child.as_str()));
        next += 1;
    }
    all.split_off(1)
}

/// How much of a part can be taken from a whole so that a body is left: 1, or half of the most.
fn share(whole: &[f64], part: &[f64]) -> f64 {
    let Some(L) = pseudo_inertia(whole).cholesky() else { return 1.0 };
    let of_part = pseudo_inertia(part);
    // the largest eigenvalue of J⁻¹ J_part, by L⁻¹ J_part L⁻ᵀ
    let Some(half) = L.l().solve_lower_triangular(&of_part) else { return 1.0 };
    let Some(both) = L.l().solve_lower_triangular(&half.transpose()) else { return 1.0 };
    let most = (0.5 * (both + both.transpose())).symmetric_eigenvalues().max();
    if most < 0.95 { 1.0 } else { 0.5 / most }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Choice;
    use mozzi::random::Random;

    #[test]
    fn the_built_robot_has_the_identified_parameters() {
        let panda = mozzi_urdf::open("panda").expect("embedded").description;
        let whole = panda.clone().build().expect("sound");
        let finger = whole.joint_names().last().expect("a finger").to_string();
        let locked = whole.with_locked_joints(&[(&finger, 0.02)]).expect("a joint");
        let columns = Columns::new(&locked, Choice::default()).expect("columns");
        let mut random = Random(3);
        let mut x = columns.prior();
        for first in columns.bodies() {
            let factor = 1.0 + 0.4 * random.next();
            x[first..first + 10].iter_mut().for_each(|x| *x *= factor);
        }
        for (k, unknown) in columns.unknowns.iter().enumerate().filter(|(_, unknown)| unknown.kind.is_positive()) {
            x[k] = 0.5 + unknown.prior + 0.3 * random.next();
        }
        let (found, _) = describe(&columns, &x, &panda).expect("a robot");
        let built = found.clone().build().expect("sound").with_locked_joints(&[(&finger, 0.02)]).expect("a joint");
        let expected = parameters(&columns, &x).expect("parameters");
        let error = built.parameters().iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(error < 1e-12 * locked.mass(), "{error:e}");
        assert!(found.links.iter().all(|link| link.inertia.mass == 0.0 || link.inertia.verdict().is_physical()));
    }

    #[test]
    fn parts_that_are_heavier_than_the_whole_are_scaled() {
        let whole = [1.0, 0.0, 0.0, 0.0, 0.01, 0.0, 0.0, 0.01, 0.0, 0.01];
        assert_eq!(share(&whole, &whole.map(|x| 0.3 * x)), 1.0);
        assert!((share(&whole, &whole.map(|x| 2.0 * x)) - 0.25).abs() < 1e-12);
    }
}
