//! Sections of a page that fits a screen.

use crate::text::Page;

/// Sections in the order of their importance.
#[derive(Default)]
pub struct Sections(Vec<Section>);

struct Section {
    /// For the list of those that are left out.
    name: String,
    title: String,
    lines: Vec<String>,
}

impl Sections {
    /// One more; an empty one is no section.
    pub fn add(&mut self, name: &str, title: impl Into<String>, lines: Vec<String>) {
        if !lines.is_empty() {
            self.0.push(Section { name: name.to_string(), title: title.into(), lines });
        }
    }

    /// Adds to a page, up to `most` lines in all, those that fit; the rest are named. The first is always there, and
    /// cut if it is too long.
    pub fn write(self, page: &mut Page, most: usize) {
        // two lines for the names of the others, which may wrap
        let mut left = most.saturating_sub(page.count() + 3);
        let mut omitted = Vec::new();
        for (k, section) in self.0.into_iter().enumerate() {
            let mut lines = Page::default();
            lines.title(&section.title).lines(&section.lines);
            let count = lines.end().lines().count();
            if count > left && k > 0 {
                omitted.push(section.name);
                continue;
            }
            page.title(&section.title).lines(&cut(section.lines, left.saturating_sub(2)));
            left = left.saturating_sub(count);
        }
        if !omitted.is_empty() {
            page.blank().line(format!("left out: {}; --all shows them", omitted.join(", ")));
        }
    }
}

/// At most `most` lines; a last one counts the others.
pub fn cut(mut lines: Vec<String>, most: usize) -> Vec<String> {
    let all = lines.len();
    if all > most.max(1) {
        let shown = most.max(2) - 1;
        lines.truncate(shown);
        lines.push(format!("… {} more lines; --all shows them, --json gives every digit", all - shown));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_fit_is_named() {
        let mut sections = Sections::default();
        sections.add("joints", "joints", vec!["a".into(), "b".into()]);
        sections.add("links", "links of the robot", vec!["c".to_string(); 50]);
        sections.add("frames", "frames", vec!["d".into()]);
        sections.add("rotors", "rotors", Vec::new());
        let mut page = Page::default();
        sections.write(&mut page, 20);
        let text = page.end();
        assert!(text.lines().count() <= 20, "{text}");
        assert!(text.contains("── frames ─") && !text.contains("links of the robot"), "{text}");
        assert!(text.contains("left out: links; --all shows them"), "{text}");
    }

    #[test]
    fn the_first_section_is_cut() {
        let lines: Vec<String> = (0..90).map(|k| k.to_string()).collect();
        assert_eq!(cut(lines.clone(), 90).len(), 90);
        let short = cut(lines, 10);
        assert_eq!(
            (short.len(), short[9].as_str()),
            (10, "… 81 more lines; --all shows them, --json gives every digit")
        );
    }
}
