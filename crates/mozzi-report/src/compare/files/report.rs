//! The comparison of two files as text and as JSON.

use super::comparison::FilesComparison;
use super::forces::{Gap, Gaps};
use super::number::digits;
use crate::compare::vocabulary;
use crate::text::Page;
use serde_json::{Value, json};

/// Causes beyond this number are counted.
const SHOWN: usize = 40;

fn verdict(it: &FilesComparison) -> String {
    let alone: usize = it.only.iter().map(Vec::len).sum();
    if !it.is_compared() {
        return "no joint in common: nothing was compared".to_string();
    }
    if it.common == 0 && alone > 0 {
        return "no joint in common; only the floating bases are compared".to_string();
    }
    if it.agrees() {
        return if it.causes.is_empty() { "the same robot" } else { "the same forces to the tolerance" }.to_string();
    }
    if let Some(kinds) = it.differing_kinds() {
        let verb = if kinds == "damping" || kinds == "friction" || kinds == "stiffness" { "differs" } else { "differ" };
        return format!("the same masses and geometry; {kinds} {verb}");
    }
    if alone == 0 && it.forces_agree() {
        return "the same forces of another robot; the causes below name the differences".to_string();
    }
    if alone == 0 && it.base.is_some() && it.causes.is_empty() && it.is_explained() {
        return "another robot: the base is free in one file only".to_string();
    }
    match (alone, it.is_explained()) {
        (0, true) => "another robot; the causes below explain it".to_string(),
        (0, false) if it.is_accounted_for() => {
            "another robot; the causes below account for it, not all with a known reason".to_string()
        }
        (0, false) => "another robot; not all of it is explained".to_string(),
        (1, _) => "another robot: one joint moves in one file only".to_string(),
        _ => format!("another robot: {alone} joints move in one file only"),
    }
}

pub fn text(it: &FilesComparison) -> String {
    let mut page = Page::default();
    let [a, b] = &it.names;
    page.line(format!("{a} and {b}: {}", verdict(it)));
    if it.is_compared() {
        page.line(format!(
            "{} moving joints in both, {} random states of seed {}, tolerance {:e} of each joint's largest number",
            it.common, it.states, it.seed, it.tolerance
        ));
    }
    for (here, there) in &it.renamed {
        let by = if it.named.contains(here) { "name" } else { "place" };
        page.line(format!("  `{here}` is `{there}` in {b}, known by its {by}"));
    }
    if !it.links.is_empty() {
        let names = vocabulary::some(&it.links, |(here, there)| format!("`{here}` is `{there}`"));
        page.line(format!("  links in {b}, known by their joints: {names}"));
    }
    for (only, name) in it.only.iter().zip([a, b]) {
        if !only.is_empty() {
            let list = only.iter().map(|joint| format!("`{joint}`")).collect::<Vec<_>>().join(", ");
            page.line(format!("  moves in {name} only, and is held at 0: {list}"));
        }
    }
    if let Some(base) = &it.base {
        page.line(format!("  {base}"));
    }
    let labels = ["M", "gravity torque", "torque"];
    let is_there = |gap: &Gap| gap.part > it.tolerance && !it.forces_agree();
    let of_common = if it.only.iter().all(Vec::is_empty) { "" } else { " of the joints in both" };
    if it.forces_agree() {
        page.line(format!("  M, gravity torques and torques{of_common} agree"));
    }
    for (gap, what) in it.before.iter().zip(labels).filter(|(gap, _)| is_there(gap)) {
        let place = gap.joints.join(", ");
        let (most, scale) = (digits(gap.most), digits(gap.scale));
        page.line(match what {
            "M" => format!("  {what}[{place}] differs by up to {most}, of {scale}"),
            _ => format!("  {} of {place} differs by up to {most} {}, of {scale}", gap.name(what), gap.unit),
        });
    }
    for cause in it.causes.iter().take(SHOWN) {
        page.line(format!("  - {}", cause.sentence));
        if let Some(effect) = cause.effect.as_ref().filter(|_| it.causes.len() > 1) {
            page.line(format!("    alone: {effect}"));
        }
    }
    if it.causes.len() > SHOWN {
        page.line(format!("  and {} more; --json has all", it.causes.len() - SHOWN));
    }
    for note in &it.notes {
        page.line(format!("  note: {note}"));
    }
    if !it.forces_agree() && it.is_compared() {
        let worst =
            it.after.iter().map(|gap| gap.part).fold(0.0, |most, x| if x > most || x.is_nan() { x } else { most });
        page.line(format!("  with all of these accounted for, the forces{of_common} agree to {worst:.0e}"));
    }
    page.end()
}

pub fn json(it: &FilesComparison) -> Value {
    let gaps = |gaps: &Gaps| {
        let gap = |gap: &Gap| json!({ "most": gap.most, "of": gap.scale, "joints": gap.joints, "unit": gap.unit, "part": gap.part });
        json!({ "mass_matrix": gap(&gaps[0]), "gravity_forces": gap(&gaps[1]), "inverse_dynamics": gap(&gaps[2]) })
    };
    json!({
        "files": it.names,
        "agrees": it.agrees(),
        "compared": it.is_compared(),
        "explained": it.is_explained(),
        "accounted_for": it.is_compared() && it.is_accounted_for(),
        "tolerance": it.tolerance,
        "states": it.states,
        "seed": it.seed,
        "joints": it.common,
        "renamed": it.renamed.iter().map(|(here, there)| json!([here, there])).collect::<Value>(),
        "renamed_links": it.links.iter().map(|(here, there)| json!([here, there])).collect::<Value>(),
        "only": it.only,
        "base": it.base,
        "differences": gaps(&it.before),
        "differences_explained": gaps(&it.after),
        "causes": it.causes.iter().map(|cause| json!({
            "kind": cause.kind, "name": cause.name, "message": cause.sentence, "has_reason": cause.has_reason,
            "effect": cause.effect,
        })).collect::<Value>(),
        "notes": it.notes,
    })
}
