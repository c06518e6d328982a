//! The book's search, as a reader uses it: the index that mdBook wrote, searched in a browser by the script that comes
//! with it, from files alone.

use super::FOLDER;
use crate::command;
use crate::page;
use crate::report::Outcome;
use crate::workspace::Workspace;
use std::process::Command;

/// Typical queries, and the page that must come first.
const QUERIES: [(&str, &str); 16] = [
    ("gravity compensation at 1 kHz in C++", "use/gravity-compensation.html"),
    ("why does Pinocchio differ", "use/compare.html"),
    ("my URDF is wrong", "use/urdf.html"),
    ("from KDL", "use/kdl.html"),
    ("from Pinocchio", "use/pinocchio.html"),
    ("from MuJoCo", "use/mujoco.html"),
    ("identify my arm", "use/identify.html"),
    ("legged robot on its feet", "use/legged.html"),
    ("a million states", "use/million.html"),
    ("train through dynamics", "use/train.html"),
    ("Newton-Euler inverse dynamics", "learn/newton-euler.html"),
    ("closed form", "learn/closed-form.html"),
    ("task space", "learn/task-space.html"),
    ("homework", "learn/homework.html"),
    ("coriolis_matrix", "reference/quantities.html"),
    ("decimal_comma", "reference/diagnostics/decimal_comma.html"),
];

pub fn check(workspace: &Workspace) -> Outcome {
    let Some(browser) = page::browser() else {
        return Outcome::Skipped("there is no Chromium or Chrome".into());
    };
    try_check(workspace, Command::new(browser)).map_or_else(Outcome::Failed, Outcome::Passed)
}

fn try_check(workspace: &Workspace, mut browser: Command) -> Result<String, String> {
    let folder = workspace.path(FOLDER);
    let script = |start: &str| {
        let entries = std::fs::read_dir(folder.join("html")).map_err(|error| format!("{FOLDER}/html: {error}"))?;
        let names = entries.filter_map(Result::ok).map(|entry| entry.file_name().to_string_lossy().into_owned());
        let mut found = names.filter(|name| name.starts_with(start) && name.ends_with(".js"));
        found.next().ok_or_else(|| format!("{FOLDER}/html has no {start}….js"))
    };
    let (engine, index) = (script("elasticlunr")?, script("searchindex")?);
    let queries: Vec<String> = QUERIES.iter().map(|(query, _)| format!("{query:?}")).collect();
    let queries = queries.join(", ");
    let html = format!(
        "<!DOCTYPE html><meta charset=\"utf-8\"><pre id=\"found\"></pre><script>window.search = {{}};</script>\
         <script src=\"html/{engine}\"></script><script src=\"html/{index}\"></script><script>\
         const {{ index, search_options, doc_urls }} = window.search, lunr = elasticlunr.Index.load(index);\
         const first = (query) => lunr.search(query, search_options).slice(0, 1).map((found) => doc_urls[found.ref]);\
         document.getElementById(\"found\").textContent = [{queries}].map((query) => `[${{first(query)}}]`).join(\"\\n\");\
         </script>"
    );
    let file = folder.join("search.html");
    std::fs::write(&file, html).map_err(|error| format!("{}: {error}", file.display()))?;
    browser.args(["--headless=new", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=10000", "--dump-dom"]);
    let (_, page) = command::output(browser.arg(format!("file://{}", file.display())))?;
    let found: Vec<&str> = answers(&page);
    if found.len() != QUERIES.len() {
        return Err(format!("the browser answered {} of {} searches: {page}", found.len(), QUERIES.len()));
    }
    let wrong = QUERIES.iter().zip(found).filter(|((_, expected), found)| !found.starts_with(expected));
    let wrong: Vec<String> = wrong.map(|((query, page), found)| format!("{query}: {found} before {page}")).collect();
    if wrong.is_empty() {
        Ok(format!("{} searches find their page first", QUERIES.len()))
    } else {
        Err(wrong.join("; "))
    }
}

/// The lines `[…]` of the page.
fn answers(page: &str) -> Vec<&str> {
    let text = page.split("<pre id=\"found\">").nth(1).and_then(|rest| rest.split("</pre>").next()).unwrap_or_default();
    text.lines().filter_map(|line| line.strip_prefix('[')?.strip_suffix(']')).collect()
}

#[cfg(test)]
mod tests {
    use super::answers;

    #[test]
    fn answers_are_lines_in_brackets() {
        assert_eq!(answers("<pre id=\"found\">[a.html#b]\n[]</pre><script>[x]</script>"), ["a.html#b", ""]);
        assert_eq!(answers("nothing"), Vec::<&str>::new());
    }
}
