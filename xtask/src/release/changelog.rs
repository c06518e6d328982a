//! The changelog: a section for each version, the newest first.

use crate::report::Outcome;
use crate::workspace::Workspace;

/// Checks the headings, and that this version or `Unreleased` has entries.
pub fn check(workspace: &Workspace, version: &str) -> Outcome {
    match std::fs::read_to_string(workspace.path("CHANGELOG.md")) {
        Ok(text) => said(&text, version).map_or_else(Outcome::Failed, Outcome::Passed),
        Err(error) => Outcome::Failed(format!("CHANGELOG.md: {error}")),
    }
}

fn said(text: &str, version: &str) -> Result<String, String> {
    let sections: Vec<(&str, &str)> =
        text.split("\n## ").skip(1).map(|section| section.split_once('\n').unwrap_or((section, ""))).collect();
    for (heading, _) in &sections {
        let is_dated = heading.split_once(" - ").is_some_and(|(version, date)| {
            let numbers = |text: &str, by, count| text.split(by).filter(|x| x.parse::<u32>().is_ok()).count() == count;
            numbers(version, '.', 3) && numbers(date, '-', 3)
        });
        if *heading != "Unreleased" && !is_dated {
            return Err(format!("`## {heading}`: expected `## Unreleased` or `## 1.2.3 - 2026-01-31`"));
        }
    }
    let entries = |body: &str| body.lines().filter(|line| line.starts_with("- ")).count();
    let of = |wanted: &str| sections.iter().find(|(heading, _)| heading.starts_with(wanted));
    let own = format!("{version} - ");
    match (of(&own), of("Unreleased")) {
        (Some((_, body)), _) if entries(body) > 0 => Ok(format!("{} entries for {version}", entries(body))),
        (Some(_), _) => Err(format!("the section {version} is empty")),
        (None, Some((_, body))) if entries(body) > 0 => {
            Ok(format!("{} entries under Unreleased: rename it `## {version} - DATE` to publish", entries(body)))
        }
        _ => Err(format!("nothing about {version}")),
    }
}

#[cfg(test)]
mod tests {
    use super::said;

    #[test]
    fn headings_and_entries() {
        assert!(said("# Changelog\n\n## 0.1.0 - 2026-11-25\n\n- first\n", "0.1.0").is_ok_and(|x| x.starts_with("1 ")));
        assert!(said("# Changelog\n\n## Unreleased\n\n- a\n- b\n", "0.1.0").is_ok_and(|x| x.contains("rename")));
        assert!(said("# Changelog\n\n## Unreleased\n", "0.1.0").is_err());
        assert!(said("# Changelog\n\n## 0.1.0 - 2026-11-25\n", "0.1.0").is_err_and(|x| x.contains("empty")));
        assert!(said("# Changelog\n\n## Version 1\n\n- a\n", "0.1.0").is_err_and(|x| x.contains("expected")));
    }
}
