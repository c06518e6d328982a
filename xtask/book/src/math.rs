//! Formulas: `$…$` within a line and `$$…$$` on lines of their own, in LaTeX, become MathML.

use pulldown_latex::config::{DisplayMode, RenderConfig};
use pulldown_latex::{Parser, Storage, push_mathml};

/// Replaces the formulas of a piece of prose and adds their number to `count`.
pub fn replace(prose: &str, count: &mut usize) -> Result<String, String> {
    let (mut text, mut rest) = (String::with_capacity(prose.len()), prose);
    while let Some(at) = rest.find('$') {
        text.push_str(&rest[..at]);
        let is_block = rest[at..].starts_with("$$");
        let mark = if is_block { "$$" } else { "$" };
        let from = at + mark.len();
        let length = rest[from..].find(mark).ok_or_else(|| format!("`{}` is not closed", first_line(&rest[at..])))?;
        let formula = rest[from..from + length].trim();
        if formula.is_empty() {
            return Err(format!("an empty formula near `{}`", first_line(&rest[at..])));
        }
        let mathml = render(formula, is_block)?;
        match is_block {
            true => text.push_str(&format!("<div class=\"formula\">{mathml}</div>")),
            false => text.push_str(&mathml),
        }
        *count += 1;
        rest = &rest[from + length + mark.len()..];
    }
    text.push_str(rest);
    Ok(text)
}

/// On one line, so that Markdown takes it as one piece of HTML.
fn render(formula: &str, is_block: bool) -> Result<String, String> {
    let storage = Storage::new();
    // errors of the parser would be drawn into the page
    for event in Parser::new(formula, &storage) {
        event.map_err(|error| format!("formula `{formula}`: {error}"))?;
    }
    let display_mode = if is_block { DisplayMode::Block } else { DisplayMode::Inline };
    let config = RenderConfig { display_mode, ..RenderConfig::default() };
    let mut mathml = String::new();
    push_mathml(&mut mathml, Parser::new(formula, &storage), config)
        .map_err(|error| format!("formula `{formula}`: {error}"))?;
    // dots and hats keep their size
    Ok(mathml.replace('\n', " ").replace("<mover>", "<mover accent=\"true\">"))
}

fn first_line(text: &str) -> &str {
    text.lines().next().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::replace;

    #[test]
    fn formulas_become_mathml() {
        let mut count = 0;
        let text = replace("by $M\\ddot\\theta$ and\n\n$$\n\\tau = M\\ddot{\\theta}\n$$\n", &mut count).expect("two");
        assert_eq!(count, 2);
        assert!(text.contains("<div class=\"formula\"><math") && !text.contains('$'), "{text}");
    }

    #[test]
    fn mistakes_are_errors() {
        let mut count = 0;
        assert!(replace("costs $5", &mut count).is_err());
        assert!(replace("$\\nonsense{x}$", &mut count).is_err());
    }
}
