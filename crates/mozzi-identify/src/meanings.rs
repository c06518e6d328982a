//! The meaning of each code of a finding.

/// Each code with its meaning, in alphabetical order.
const MEANINGS: &[(&str, &str)] = &[
    ("acceleration", "Logged accelerations are not the derivatives of the velocities, and are not used."),
    (
        "apparent",
        "Predictions contain an inertia or a damping that no robot has, from friction with memory or from a delay; the \
         written robot does not.",
    ),
    ("astray", "The search for a robot that can exist ended before its optimum; do not use its values."),
    ("at_rest", "No joint moves, or its motion is noise: the log determines nothing."),
    (
        "behind_the_gears",
        "Rotors do not help to predict forces that were taken for the motors': they seem to be measured behind the \
         gears, or the rotors are light.",
    ),
    ("bridged", "Gaps in time that are short against the period of the cut-off are bridged."),
    ("causal_filter", "Velocities or forces come later than the motion: they were filtered forwards only."),
    ("clock_resolution", "Times have too few digits; an even rate is used if the rows determine one."),
    (
        "coloured_residuals",
        "What is left of the forces is no noise but an effect that the model lacks, so that standard deviations are too \
         small.",
    ),
    ("condition", "The equations are nearly singular: the motion excites some parameters much less than others."),
    ("constant", "A force is constant in all rows, or a position is constant although its velocity is not."),
    (
        "contradiction",
        "Positions, velocities and forces do not fit the robot's file, and no single mistake explains it.",
    ),
    ("cutoff", "The cut-off of the low-pass filter, and why it was chosen."),
    ("drop_out", "Rows in which a signal is exactly 0 and far from those around it are left out."),
    ("gap", "A gap in time is longer than the filter can bridge; the parts are filtered separately."),
    ("gravity", "Forces fit another direction of gravity, or lack gravity."),
    ("impossible_bodies", "Bodies that can exist explain the forces much worse than bodies that cannot."),
    ("jitter", "Times are uneven; signals are interpolated."),
    ("lag", "The force of one joint comes later or earlier than predicted, those of the others do not."),
    ("limits", "Signals are far beyond the limits of the robot's file: another unit, or those limits are wrong."),
    ("no_servo", "No PD law with a delay explains the forces of a joint from its target; its gains mean little."),
    ("no_velocities", "Without logged velocities Coulomb friction comes out too small at a low cut-off."),
    ("not_excited", "The motion does not determine some base parameters."),
    ("not_finite", "Rows with NaN or infinite numbers are left out."),
    ("not_left_out", "Errors are those of the motion that was fitted: a part of it does not suffice for a fit."),
    ("not_moving", "The position of a joint is the same in all rows."),
    ("offset", "The zero of an encoder seems to be another than that of the robot's file."),
    ("position_jump", "A position jumps farther than the joint moves between two rows."),
    ("repeated_rows", "Rows that repeat the row before are left out."),
    ("same_log", "A log is given twice: it counts twice, or it validates its own fit."),
    ("saturation", "Rows in which a force stays at its extreme value are left out."),
    ("scale", "All forces differ from the prediction of the robot's file by one factor: a unit, a gain, or masses."),
    (
        "scaled_links",
        "Inertias of links that are fixed to an identified link are scaled, since no body could have the rest.",
    ),
    ("short", "The log is too short."),
    ("sign", "A position, velocity or force seems to have the opposite sign."),
    ("spike", "Single values far above all others are left out."),
    ("stopped", "The search was stopped; the result is the best so far."),
    ("stuck", "A signal stays constant while its joint moves."),
    ("swapped_columns", "The columns of velocity and force of a joint seem to be swapped."),
    ("swapped_joints", "The columns of two joints seem to be swapped, or all joints to be in the reverse order."),
    (
        "thin_prior",
        "The robot's own inertia of a link is massless or flat; a body 1 cm thick takes its place in the prior.",
    ),
    ("thinned", "Rows are left out between which the filter leaves nothing."),
    ("time_unit", "Times are in another unit than seconds, or their unit is in doubt."),
    ("unexplained", "The fit leaves more than half of a joint's force."),
    ("unit", "A signal is in another unit than rad, m, s, N m or N."),
    ("velocity", "Velocities are not the derivatives of the positions."),
    ("wrapped", "A position that wraps by whole turns is unwrapped."),
    ("wrench", "Measured wrenches do not act on the robot, or have the opposite sign."),
];

/// The meaning of a finding's code, one sentence.
pub fn meaning(code: &str) -> Option<&'static str> {
    MEANINGS.iter().find(|(known, _)| *known == code).map(|(_, text)| *text)
}

/// All codes of findings, in alphabetical order.
pub fn codes() -> impl Iterator<Item = &'static str> {
    MEANINGS.iter().map(|(code, _)| *code)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;
    use std::path::Path;

    /// The text of all files of a folder.
    fn text_of(folder: &Path) -> String {
        let entries = std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
        let text = |path: std::path::PathBuf| match path.is_dir() {
            true => text_of(&path),
            false if path.ends_with("meanings.rs") || path.ends_with("finding.rs") => String::new(),
            false => std::fs::read_to_string(path).expect("text"),
        };
        entries.map(text).collect()
    }

    #[test]
    fn every_code_has_a_meaning() {
        let text = text_of(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"));
        let calls = ["Finding::note(", "Finding::warning(", "Finding::fault(", " fault("];
        let after =
            |call: &'static str| text.split(call).skip(1).filter_map(|rest| rest.trim_start().strip_prefix('"'));
        let given = calls.into_iter().flat_map(after).filter_map(|rest| rest.split('"').next());
        let given: BTreeSet<&str> = given.chain(["gravity", "offset", "wrench"]).collect();
        let known: BTreeSet<&str> = codes().collect();
        assert!(given.len() > 40 && given.iter().all(|code| known.contains(code)), "{given:?}");
        // `velocity` and `causal_filter` are chosen by a condition, those of mistakes by their kind
        assert!(known.iter().all(|code| text.contains(&format!("\"{code}\""))), "{known:?}");
        assert!(codes().is_sorted());
    }
}
