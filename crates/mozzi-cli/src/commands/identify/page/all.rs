//! Every number of the result: `--all`.

use crate::tables::samples::Row;
use crate::text::{Page, digits, table};
use mozzi_identify::Identification;
use mozzi_identify::judgement::Judgement;

/// All parameters, before and after.
pub fn parameters(page: &mut Page, found: &Identification<'_>, judged: &Judgement) {
    let optimum = &found.estimates.consistent;
    let columns = &found.setup.columns;
    let head = ["", "unit", "before", "identified", "apparent", "determined", "from the prior"];
    let mut rows = vec![head.map(str::to_string).to_vec()];
    for (k, unknown) in columns.unknowns.iter().enumerate() {
        let apparent = optimum.apparent[k];
        rows.push(vec![
            unknown.name.clone(),
            columns.unit(k).to_string(),
            digits(unknown.prior, 5),
            digits(optimum.x[k], 5),
            if apparent == 0.0 {
                String::new()
            } else {
                format!("{}{}", if apparent > 0.0 { "+" } else { "" }, digits(apparent, 5))
            },
            judged.standings[k].text(),
            format!("{:.0} %", 100.0 * optimum.prior_share[k]),
        ]);
    }
    page.title("all parameters; apparent: what predictions contain beyond the robot").lines(&table(&rows, "llrrrlr"));
}

/// The meaning of each column.
pub fn column_table(page: &mut Page, file: &str, rows: &[Row]) {
    let head = ["column", "meaning", "unit", "joint"].map(str::to_string).to_vec();
    let row = |row: &Row| vec![row.column.clone(), row.meaning.clone(), row.unit.clone(), row.joint.clone()];
    let all: Vec<Vec<String>> = [head].into_iter().chain(rows.iter().map(row)).collect();
    page.title(&format!("columns of {file}")).lines(&table(&all, "llll"));
}

/// The parameters that the motion does not determine.
pub fn weak(page: &mut Page, judged: &Judgement) {
    let weak: Vec<_> = judged.parameters.iter().filter(|parameter| parameter.is_weak()).collect();
    if weak.is_empty() {
        return;
    }
    let mut rows = vec![["", "value", "deviation", "what would help"].map(str::to_string).to_vec()];
    for parameter in weak {
        let name: String = if parameter.name.chars().count() > 60 {
            parameter.name.chars().take(57).chain("…".chars()).collect()
        } else {
            parameter.name.clone()
        };
        rows.push(vec![
            name,
            digits(parameter.least_squares, 5),
            digits(parameter.deviation, 5),
            parameter.advice.clone().unwrap_or_default(),
        ]);
    }
    page.title("base parameters that the motion does not determine").lines(&table(&rows, "lrrl"));
}
