//! The report of an identification: one HTML file with figures, without scripts. The verdict comes first, then the
//! undetermined parameters, then the figures; tables are folded. Printed it is one page.

mod bars;
mod forces;
mod friction;
mod inertias;
mod style;
mod tables;

use crate::figure::Figure;
use crate::markup::escaped;
use crate::text::digits;
use mozzi::Model;
use mozzi_identify::judgement::Judgement;
use mozzi_identify::{Errors, Finding, Identification, Level, Verdict};
use std::fmt::Write as _;

/// The report as an HTML file: whether forces are predicted, which parameters the data does not determine, measured
/// and predicted forces with their residuals, friction, parameters before and after, and all tables. It fetches
/// nothing and runs nothing.
pub fn fit_html(found: &Identification<'_>, judged: &Judgement, validations: &[(String, Errors)]) -> String {
    let name = escaped(&found.setup.columns.model.description().name);
    let mut body = format!("<header><h1>{name}, identified</h1></header>\n<main>\n");
    body += &verdict(found, validations);
    body += &undetermined(judged);
    body += &noticed(found.findings.iter().chain(&judged.findings));
    body += &forces::section(found, judged);
    body += &friction::section(found, judged);
    body += &bars::section(found);
    body += &inertias::section(found);
    body += &tables::section(found, judged, validations);
    format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{name}, identified</title>\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'\">\n\
         <style>{}</style></head>\n<body>\n{body}</main></body></html>\n",
        style::STYLE
    )
}

/// N m or N, of each velocity; A where forces are currents.
fn units(found: &Identification<'_>) -> Vec<&'static str> {
    let columns = &found.setup.columns;
    let slides = sliding(columns.model);
    slides
        .iter()
        .map(|slides| match (columns.choice.gains, slides) {
            (true, _) => "A",
            (false, true) => "N",
            (false, false) => "N m",
        })
        .collect()
}

/// Whether each velocity is a length's.
fn sliding(model: &Model) -> Vec<bool> {
    let mut slides = vec![false; model.n()];
    if model.is_floating() {
        slides[3..6].fill(true);
    }
    for (joint, place) in model.joints().zip(model.places()) {
        let of_free = place.velocities().len() == 6;
        for (k, j) in place.velocities().enumerate() {
            slides[j] = joint.kind.name() == "prismatic" || (of_free && k > 2);
        }
    }
    slides
}

/// A figure among the text.
fn drawn(figure: &Figure, class: &str) -> String {
    format!("<figure class=\"{class}\">{}</figure>\n", figure.svg_of_page())
}

fn verdict(found: &Identification<'_>, validations: &[(String, Errors)]) -> String {
    let verdict = Verdict::new(found, validations.iter().map(|(_, errors)| errors));
    let least_squares = &found.estimates.least_squares;
    let samples: usize = found.samples.iter().map(|samples| samples.count()).sum();
    let class = if verdict.is_trusted { "good" } else { "bad" };
    let mut text = format!("<section class=\"verdict {class}\">\n");
    for line in verdict.to_string().lines() {
        let mut letters = line.chars();
        let first = letters.next().map(|c| c.to_uppercase().to_string()).unwrap_or_default();
        let _ = writeln!(text, "<p class=\"answer\">{}{}.</p>", escaped(&first), escaped(letters.as_str()));
    }
    let _ = writeln!(
        text,
        "<p>{samples} samples determine {} of {} base parameters; condition number {:.0}. The percentage is the root mean \
         square over the joints of error over force (NRMS); differences below 3 % mean nothing on one trajectory.</p>\n\
         </section>",
        least_squares.rank,
        found.setup.base.count(),
        least_squares.condition
    );
    text
}

/// The base parameters whose deviation is larger than their value, with what would determine them.
fn undetermined(judged: &Judgement) -> String {
    let weak: Vec<_> = judged.parameters.iter().filter(|one| one.is_weak()).collect();
    if weak.is_empty() {
        return "<section><h2>What is not determined</h2>\n<p>Nothing: every base parameter that matters is larger than \
                its deviation.</p></section>\n"
            .to_string();
    }
    let items: String = weak
        .iter()
        .map(|one| {
            let advice = one.advice.as_ref().map(|advice| format!("; {}", escaped(advice))).unwrap_or_default();
            let [value, deviation] = [one.least_squares, one.deviation].map(|x| digits(x, 4));
            format!("<li><b>{}</b>: {value} ± {deviation}{advice}</li>\n", escaped(&one.name))
        })
        .collect();
    format!(
        "<section><h2>What is not determined</h2>\n<p>{} of {} base parameters have deviations larger than \
         themselves.</p>\n<ul class=\"weak\">\n{items}</ul></section>\n",
        weak.len(),
        judged.parameters.len()
    )
}

fn noticed<'f>(all: impl Iterator<Item = &'f Finding>) -> String {
    let items: String = all
        .map(|finding| {
            let class = if finding.level != Level::Note { " class=\"warning\"" } else { "" };
            format!("<li{class}>{}</li>\n", escaped(&finding.text))
        })
        .collect();
    if items.is_empty() {
        return String::new();
    }
    format!("<section><h2>What was noticed</h2>\n<ul>\n{items}</ul></section>\n")
}
