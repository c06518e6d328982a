//! All numbers, folded.

use super::units;
use crate::markup::escaped;
use crate::text::digits;
use mozzi_identify::judgement::Judgement;
use mozzi_identify::{Errors, Identification};
use std::fmt::Write as _;

/// The errors, the first table open; base parameters and parameters.
pub fn section(found: &Identification<'_>, judged: &Judgement, validations: &[(String, Errors)]) -> String {
    let mut errors: Vec<(String, &Errors)> = Vec::new();
    errors.extend(validations.iter().map(|(file, errors)| (format!("Errors on {file}"), errors)));
    let held = found.held_out.as_ref().map(|errors| ("Errors on the part that was not fitted".to_string(), errors));
    errors.extend(held);
    let left = "Errors of predictions: five blocks of time, each left out in turn".to_string();
    errors.extend(found.left_out.as_ref().map(|errors| (left, errors)));
    errors.push(("Errors on the samples that were fitted".to_string(), &found.fitted));
    let mut text = String::new();
    for (k, (title, errors)) in errors.into_iter().enumerate() {
        let table = errors_table(found, errors);
        text += &match k {
            0 => format!("<section><h2>{}</h2>\n{table}</section>\n", escaped(&title)),
            _ => format!("<details><summary>{}</summary>\n{table}</details>\n", escaped(&title)),
        };
    }
    text + &parameters(found, judged)
}

/// A table from rows of cells; the first row is the head.
fn table(rows: &[Vec<String>]) -> String {
    let mut text = String::from("<div class=\"wide\"><table>\n");
    for (k, row) in rows.iter().enumerate() {
        let tag = if k == 0 { "th" } else { "td" };
        let cells: String = row.iter().map(|cell| format!("<{tag}>{}</{tag}>", escaped(cell))).collect();
        let _ = writeln!(text, "<tr>{cells}</tr>");
    }
    text + "</table></div>\n"
}

fn errors_table(found: &Identification<'_>, errors: &Errors) -> String {
    let head = ["joint", "force", "robot's file", "with friction", "least squares", "identified", "identified, %"];
    let mut rows = vec![head.map(str::to_string).to_vec()];
    let units = units(found);
    for (j, name) in found.setup.columns.model.velocity_names().enumerate() {
        let all = [errors.force[j], errors.robot[j], errors.friction[j], errors.least_squares[j], errors.consistent[j]];
        let percent = if errors.force[j] > 0.0 { 100.0 * errors.consistent[j] / errors.force[j] } else { 0.0 };
        let cells = all.iter().map(|x| digits(*x, 4));
        rows.push(
            [format!("{name} [{}]", units[j])].into_iter().chain(cells).chain([format!("{percent:.2}")]).collect(),
        );
    }
    let nrms = 100.0 * errors.normalized(&errors.consistent);
    format!(
        "<p>Root mean squares of the force, and of the errors of: the robot's file as it was; the same with fitted friction \
         and offsets; least squares; bodies that can exist (identified). NRMS {nrms:.2} %.</p>\n{}",
        table(&rows)
    )
}

fn parameters(found: &Identification<'_>, judged: &Judgement) -> String {
    let optimum = &found.estimates.consistent;
    let mut rows =
        vec![["parameter", "before", "identified", "deviation", "from the prior"].map(str::to_string).to_vec()];
    for (k, unknown) in found.setup.columns.unknowns.iter().enumerate() {
        rows.push(vec![
            format!("{} [{}]", unknown.name, found.setup.columns.unit(k)),
            digits(unknown.prior, 6),
            digits(optimum.x[k], 6),
            judged.standings[k].text(),
            format!("{:.0} %", 100.0 * optimum.prior_share[k]),
        ]);
    }
    let mut base = vec![
        ["base parameter", "before", "least squares", "deviation", "identified", "what would determine it"]
            .map(str::to_string)
            .to_vec(),
    ];
    for one in &judged.parameters {
        base.push(vec![
            one.name.clone(),
            digits(one.robot, 6),
            digits(one.least_squares, 6),
            digits(one.deviation, 6),
            digits(one.consistent, 6),
            one.advice.clone().unwrap_or_default(),
        ]);
    }
    format!(
        "<details><summary>Base parameters</summary>\n<p>The combinations on which forces depend. Deviations are those of \
         least squares.</p>\n{}</details>\n<details><summary>Parameters</summary>\n<p>Of bodies that can exist. Where most \
         comes from the prior, the number is the robot's own, not the data's.</p>\n{}</details>\n",
        table(&base),
        table(&rows)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_escaped() {
        assert!(table(&[vec!["<script>".to_string()]]).contains("&lt;script&gt;"));
    }
}
