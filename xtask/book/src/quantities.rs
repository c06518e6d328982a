//! The page of quantities: the list of docs/quantities.md, and a paragraph for each, which search finds by its name.

use crate::text;
use std::path::Path;

/// Where the quantities are listed in Rust.
const LIST: &str = "crates/mozzi/src/quantities/mod.rs";

/// The page with a paragraph for each quantity, to which the names in the list lead; the list keeps its formulas.
pub fn with_each(root: &Path, page: &str) -> Result<String, String> {
    let list = text::read(&root.join(LIST))?;
    let (head, table) = page.split_once("| name | formula |").ok_or("docs/quantities.md has no list of formulas")?;
    let rows: Vec<Vec<&str>> = table.lines().filter(|line| line.starts_with("| `")).map(cells).collect();
    let mut out = format!("{head}| name | formula |\n|---|---|\n");
    for [name, formula] in rows.iter().filter_map(|row| row.first_chunk::<2>()) {
        out += &format!("| [{name}](#{}) | {formula} |\n", name.trim_matches('`'));
    }
    out += "\n## One by one\n";
    for row in &rows {
        let [name, formula, inputs, of, environment, outputs] = row[..] else {
            return Err(format!("docs/quantities.md: {} columns, expected 6", row.len()));
        };
        let name = name.trim_matches('`');
        let rust = camel_case(name);
        if !list.split_whitespace().any(|word| word == rust) {
            return Err(format!("docs/quantities.md: `{rust}` is not in {LIST}"));
        }
        let of = if of.is_empty() { String::new() } else { format!("; of a {of}") };
        let environment = if environment.is_empty() { "nothing" } else { environment };
        out += &format!(
            "\n### `{name}`\n\n{formula}\n\n- **Inputs**: {inputs}{of}; of the environment: {environment}\n\
             - **Outputs**: {outputs}\n\
             - **Command line**: `mozzi compute MODEL {}`; **Python**: [`Model.{name}`](python.md#model{name})\n\
             - **Rust**: [`mozzi::quantities::{rust}`](../rustdoc/mozzi/quantities/struct.{rust}.html); **C++**: \
             `workspace.{name}(…)`; **C**: `mozzi_{name}(…)`\n",
            name.replace('_', "-")
        );
    }
    Ok(out)
}

/// The cells of a row of a table.
fn cells(line: &str) -> Vec<&str> {
    line.trim().trim_matches('|').split(" | ").map(str::trim).collect()
}

fn camel_case(name: &str) -> String {
    let capital = |word: &str| word[..1].to_uppercase() + &word[1..];
    name.split('_').filter(|word| !word.is_empty()).map(capital).collect()
}

#[cfg(test)]
mod tests {
    use super::{camel_case, cells};

    #[test]
    fn rows_and_names() {
        assert_eq!(cells("| `a_b` | x |  | y |"), ["`a_b`", "x", "", "y"]);
        assert_eq!(camel_case("inverse_dynamics_vjp"), "InverseDynamicsVjp");
    }
}
