//! Which joint of one robot is which of the other.

use crate::compare::Result;
use crate::compare::constants::{Constants, freed};
use mozzi::Description;
use mozzi::model::description::JointKind;

/// Both robots with the same independent moving joints, under the first one's names.
pub struct Matched {
    pub a: Description,
    pub b: Description,
    /// Joints known by their place: names in both.
    pub renamed: Vec<(String, String)>,
    /// Joints that move in one robot only; fixed at 0 here.
    pub only_a: Vec<String>,
    pub only_b: Vec<String>,
}

/// By name, then by axis at home, then by the link that it moves.
pub fn matched(a: &Description, b: &Description) -> Result<Matched> {
    let (mut a, mut b) = (freed(a), freed(b));
    (a.states, a.start, b.states, b.start) = (Vec::new(), None, Vec::new(), None);
    let (of_a, of_b) = (Constants::of(&a)?, Constants::of(&b)?);
    let is_twin = |name: &str, nv: usize, there: &Constants| there.joint(name).is_some_and(|joint| joint.nv == nv);
    let lone_a: Vec<_> = of_a.joints.iter().filter(|joint| !is_twin(&joint.name, joint.nv, &of_b)).collect();
    let lone_b: Vec<_> = of_b.joints.iter().filter(|joint| !is_twin(&joint.name, joint.nv, &of_a)).collect();
    let mut renamed: Vec<(String, String)> = Vec::new();
    let child = |robot: &Description, name: &str| {
        robot.joints.iter().find(|joint| joint.name == name).map(|joint| joint.child.clone())
    };
    for joint in &lone_a {
        let is_place =
            |x: &[f64; 6], y: &[f64; 6]| x.iter().zip(y).all(|(x, y)| (x - y).abs() <= 1e-6 * (1.0 + x.abs()));
        let fits = |other: &&&crate::compare::constants::JointConstants| {
            let is_free = !renamed.iter().any(|(_, taken)| *taken == other.name);
            is_free && other.nv == joint.nv && joint.axes.iter().zip(&other.axes).all(|(x, y)| is_place(x, y))
        };
        let fitting: Vec<_> = lone_b.iter().filter(fits).collect();
        // several have the same place in legs that are alike: then the link decides
        let own = child(&a, &joint.name);
        let found = match fitting.as_slice() {
            [one] => Some(one),
            several => several.iter().find(|other| child(&b, &other.name) == own),
        };
        if let Some(other) = found {
            renamed.push((joint.name.clone(), other.name.clone()));
        }
    }
    let only =
        |lone: &[&crate::compare::constants::JointConstants], of: fn(&(String, String)) -> &String| -> Vec<String> {
            let names = lone.iter().map(|joint| joint.name.clone());
            names.filter(|name| !renamed.iter().any(|pair| of(pair) == name)).collect()
        };
    let (only_a, only_b) = (only(&lone_a, |pair| &pair.0), only(&lone_b, |pair| &pair.1));
    for (robot, only) in [(&mut a, &only_a), (&mut b, &only_b)] {
        robot
            .joints
            .iter_mut()
            .filter(|joint| only.contains(&joint.name))
            .for_each(|joint| joint.kind = JointKind::Fixed);
    }
    // a name of b that a has for another joint must not be taken for it
    for joint in &mut b.joints {
        if let Some((name, _)) = renamed.iter().find(|(_, there)| *there == joint.name) {
            joint.name.clone_from(name);
        } else if renamed.iter().any(|(name, _)| *name == joint.name) {
            joint.name.push('\'');
        }
    }
    Ok(Matched { a, b, renamed, only_a, only_b })
}
