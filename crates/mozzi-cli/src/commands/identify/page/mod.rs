//! The result as text: the verdict, errors, masses and joints; the rest by `--all`.

mod all;

use crate::tables::samples::Row;
use crate::text::{Page, digits, table};
use all::{column_table, parameters, weak};
use mozzi::Model;
use mozzi_identify::judgement::Judgement;
use mozzi_identify::{Errors, Identification, Kind, Level, Refinement, Verdict};
use serde_json::{Value, json};

/// The parts of a page beside the identification.
pub struct Shown<'s> {
    pub verdict: &'s Verdict,
    pub judged: &'s Judgement,
    pub validations: &'s [(String, Errors)],
    /// Columns, by log.
    pub logs: &'s [(String, Vec<Row>)],
    pub written: &'s [String],
    /// Every number.
    pub is_all: bool,
}

pub fn text(found: &Identification<'_>, shown: &Shown) -> String {
    let model = found.setup.columns.model;
    let judged = shown.judged;
    let mut page = Page::default();
    shown.verdict.to_string().lines().for_each(|line| {
        page.line(line);
    });
    let warnings = found.findings.iter().chain(&judged.findings).filter(|one| one.level != Level::Note);
    let mut codes: Vec<&str> = warnings.map(|one| one.code).collect();
    codes.dedup();
    if !codes.is_empty() {
        page.line(format!("with warnings: {}", codes.join(", ")));
    }
    let rows: usize = found.samples.iter().map(|samples| samples.count()).sum();
    page.line(format!(
        "{}: {} unknowns, {} of {} base parameters determined, from {rows} samples, condition number {:.0}",
        model.description().name,
        found.setup.columns.count(),
        found.estimates.least_squares.rank,
        found.setup.base.count(),
        found.estimates.least_squares.condition
    ));
    let is_judged = !shown.validations.is_empty() || found.held_out.is_some();
    if let Some(errors) = found.left_out.as_ref().filter(|_| shown.is_all || !is_judged) {
        errors_table(
            &mut page,
            "error of predictions, five blocks of time left out in turn",
            (found, shown.is_all),
            errors,
        );
    }
    if let Some(errors) = &found.held_out {
        errors_table(&mut page, "error on the part that was not fitted", (found, shown.is_all), errors);
    }
    for (file, errors) in shown.validations {
        errors_table(&mut page, &format!("error on {file}"), (found, shown.is_all), errors);
    }
    if found.left_out.is_none() && !is_judged {
        errors_table(&mut page, "error on the samples that were fitted", (found, shown.is_all), &found.fitted);
    }
    joints(&mut page, found, judged);
    bodies(&mut page, found, judged);
    servos(&mut page, judged);
    let count = judged.parameters.iter().filter(|parameter| parameter.is_weak()).count();
    if shown.is_all {
        parameters(&mut page, found, judged);
        shown.logs.iter().for_each(|(file, rows)| column_table(&mut page, file, rows));
        weak(&mut page, judged);
    } else {
        page.blank();
        if count > 0 {
            page.line(format!("the motion does not determine {count} base parameters; --all names what would help"));
        }
        page.line("differences below 3 % mean nothing on one trajectory; --all prints every parameter and column");
    }
    if !shown.written.is_empty() {
        let (names, are) = (shown.written.join(", "), if shown.written.len() == 1 { "is" } else { "are" });
        page.blank().line(format!("{names} {are} written"));
    }
    page.end()
}

/// Friction, armature and offsets: a row for each joint, a column for each kind.
fn joints(page: &mut Page, found: &Identification<'_>, judged: &Judgement) {
    let (columns, optimum) = (&found.setup.columns, &found.estimates.consistent);
    let of_joint = |k: &usize| !matches!(columns.unknowns[*k].kind, Kind::Link(_) | Kind::Payload(_));
    let own: Vec<usize> = (0..columns.count()).filter(of_joint).collect();
    let split = |k: usize| columns.unknowns[k].name.rsplit_once('.').unwrap_or(("", ""));
    let mut kinds: Vec<(&str, &str)> = Vec::new();
    let mut names: Vec<&str> = Vec::new();
    for &k in &own {
        let ((joint, kind), unit) = (split(k), columns.unit(k));
        if !kinds.contains(&(kind, unit)) {
            kinds.push((kind, unit));
        }
        if !names.contains(&joint) {
            names.push(joint);
        }
    }
    if names.is_empty() {
        return;
    }
    let title = |(kind, unit): &(&str, &str)| format!("{}, {unit}", kind.replace('_', " "));
    let mut rows = vec![std::iter::once(String::new()).chain(kinds.iter().map(title)).collect::<Vec<_>>()];
    for joint in names {
        let cell = |&(kind, unit): &(&str, &str)| {
            let Some(&k) = own.iter().find(|&&k| split(k) == (joint, kind) && columns.unit(k) == unit) else {
                return String::new();
            };
            let value = if kind.starts_with("apparent") { optimum.apparent[k] } else { optimum.x[k] };
            match judged.standings[k].deviation {
                Some(deviation) => format!("{} ± {}", digits(value, 4), digits(deviation, 2)),
                None => format!("{} ?", digits(value, 4)),
            }
        };
        rows.push(std::iter::once(joint.to_string()).chain(kinds.iter().map(cell)).collect());
    }
    let align = format!("l{}", "r".repeat(kinds.len()));
    page.title("joints; ?: not determined by itself").lines(&table(&rows, &align));
}

/// Gains and delay of position controllers.
fn servos(page: &mut Page, judged: &Judgement) {
    let Some(first) = judged.servos.first() else { return };
    let head = ["", "kp, N m/rad or N/m", "kd, N m s/rad or N s/m", "bias, N m or N", "error"];
    let mut rows = vec![head.map(str::to_string).to_vec()];
    for servo in &judged.servos {
        let pair = |[value, deviation]: [f64; 2]| format!("{} ± {}", digits(value, 4), digits(deviation, 2));
        rows.push(vec![
            servo.joint.clone(),
            pair(servo.stiffness),
            pair(servo.damping),
            digits(servo.bias, 4),
            format!("{:.1} %", 100.0 * servo.nrms),
        ]);
    }
    let title = format!("position controllers; targets act {:.1} ms later", 1e3 * first.delay);
    page.title(&title).lines(&table(&rows, "lrrrr"));
}

/// Masses, before and after, and what is known of them.
fn bodies(page: &mut Page, found: &Identification<'_>, judged: &Judgement) {
    let (columns, optimum) = (&found.setup.columns, &found.estimates.consistent);
    let mut rows = vec![["mass, kg", "before", "identified", "determined"].map(str::to_string).to_vec()];
    for k in columns.bodies() {
        let unknown = &columns.unknowns[k];
        rows.push(vec![
            unknown.name.trim_end_matches(".m").to_string(),
            digits(unknown.prior, 4),
            digits(optimum.x[k], 4),
            judged.standings[k].text(),
        ]);
    }
    if rows.len() > 1 {
        page.title("bodies that can exist").lines(&table(&rows, "lrrl"));
    }
}

/// Root mean square errors by joint.
fn errors_table(page: &mut Page, title: &str, (found, is_all): (&Identification<'_>, bool), errors: &Errors) {
    let of: Vec<(&str, &Vec<f64>)> = [
        ("as it was", &errors.robot, true),
        ("+ friction", &errors.friction, is_all),
        ("least squares", &errors.least_squares, true),
        ("identified", &errors.consistent, true),
        ("written", &errors.written, is_all),
    ]
    .into_iter()
    .filter_map(|(name, list, is_shown)| is_shown.then_some((name, list)))
    .collect();
    let head = ["", "force"].into_iter().chain(of.iter().map(|(name, _)| *name)).chain(["%"]);
    let mut rows = vec![head.map(str::to_string).collect::<Vec<_>>()];
    for (j, name) in found.setup.columns.model.velocity_names().enumerate() {
        let force = errors.force[j];
        let percent = if force > 0.0 { 100.0 * errors.consistent[j] / force } else { 0.0 };
        let cells = std::iter::once(force).chain(of.iter().map(|(_, list)| list[j])).map(|x| digits(x, 4));
        rows.push([name.to_string()].into_iter().chain(cells).chain([format!("{percent:.2}")]).collect());
    }
    let share = |list: &[f64]| format!("{:.2} %", 100.0 * errors.normalized(list));
    let nrms = of.iter().map(|(_, list)| share(list));
    let cells = ["NRMS".to_string(), String::new()].into_iter().chain(nrms).chain([String::new()]);
    rows.push(cells.collect());
    let align = format!("l{}", "r".repeat(rows[0].len() - 1));
    page.title(&format!("{title}, N m or N")).lines(&table(&rows, &align));
    let (identified, written) = (errors.normalized(&errors.consistent), errors.normalized(&errors.written));
    if written > 1.01 * identified {
        page.line(format!(
            "  the written robot alone, without apparent inertia and damping: {}",
            share(&errors.written)
        ));
    }
}

/// The tables of columns alone.
pub fn columns(logs: &[(String, Vec<Row>)]) -> String {
    let mut page = Page::default();
    logs.iter().for_each(|(file, rows)| column_table(&mut page, file, rows));
    page.end()
}

pub fn columns_json(logs: &[(String, Vec<Row>)]) -> Value {
    let row = |row: &Row| json!({ "column": row.column, "meaning": row.meaning, "unit": row.unit, "joint": row.joint });
    let of =
        |(file, rows): &(String, Vec<Row>)| json!({ "log": file, "columns": rows.iter().map(row).collect::<Vec<_>>() });
    json!({ "logs": logs.iter().map(of).collect::<Vec<_>>() })
}

/// Errors of rollouts before and after the refinement.
pub fn refinement(model: &Model, refined: &Refinement) -> Vec<String> {
    let line = |(j, name): (usize, &str)| {
        format!(
            "rollouts of {name}: position error {:.2e} before, {:.2e} after; velocity error {:.2e}, {:.2e}",
            refined.before[0][j], refined.after[0][j], refined.before[1][j], refined.after[1][j]
        )
    };
    model.velocity_names().enumerate().map(line).collect()
}
