//! Checks of the finished book: every internal link and anchor leads somewhere, and no page requests anything from a
//! network.

use crate::links::joined;
use crate::text;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Text that would load something: a script, a style, a font, a picture or a frame.
const REQUESTS: [&str; 7] =
    ["src=\"http", "src=\"//", "url(http", "url(\"http", "@import \"http", "importScripts(\"http", "poster=\"http"];
/// Folders whose pages are made by other programs: their links are not checked.
const FOREIGN: [&str; 2] = ["robots/", "rustdoc/"];

/// The number of links, or every problem.
pub fn check(html: &Path, has_rustdoc: bool) -> Result<String, Vec<String>> {
    let one = |error: String| vec![error];
    let (mut pages, mut problems, mut files) = (BTreeMap::new(), Vec::new(), BTreeSet::new());
    for path in text::files(html).map_err(one)? {
        let name = path.strip_prefix(html).map_err(|error| one(error.to_string()))?;
        let name = name.to_string_lossy().replace('\\', "/");
        files.insert(name.clone());
        let is_text = [".html", ".css", ".js"].iter().any(|ending| name.ends_with(ending));
        if !is_text || name.starts_with("rustdoc/") {
            continue;
        }
        let content = text::read(&path).map_err(one)?;
        if !name.starts_with("source/") {
            problems.extend(requests(&content).into_iter().map(|line| format!("{name} requests {line}")));
        }
        if name.ends_with(".html") && !FOREIGN.iter().any(|folder| name.starts_with(folder)) {
            pages.insert(name, content);
        }
    }
    let ids: BTreeMap<&str, BTreeSet<&str>> =
        pages.iter().map(|(name, content)| (name.as_str(), values(content, "id").collect())).collect();
    let mut links = 0;
    for (name, content) in &pages {
        let folder = name.rsplit_once('/').map_or("", |(folder, _)| folder);
        for link in values(content, "href").chain(values(content, "src")) {
            if link.contains(':') || link.starts_with("//") || link.is_empty() {
                continue; // another site, or data in the page
            }
            links += 1;
            let (path, fragment) = link.split_once('#').unwrap_or((link, ""));
            let path = path.split_once('?').map_or(path, |(path, _)| path);
            let to = match path {
                "" => name.clone(),
                path => joined(folder, path).map_err(one)?,
            };
            if to.starts_with("rustdoc/") && !has_rustdoc {
                continue;
            }
            let is_known =
                fragment.is_empty() || ids.get(to.as_str()).is_none_or(|ids| ids.contains(decoded(fragment).as_str()));
            if !files.contains(&to) {
                problems.push(format!("{name}: the link `{link}` leads nowhere"));
            } else if !is_known {
                problems.push(format!("{name}: `{link}`: there is no such anchor"));
            }
        }
    }
    match problems.is_empty() {
        true => Ok(format!("{} pages, {links} links lead somewhere, no request to a network", pages.len())),
        false => Err(problems),
    }
}

/// The lines that would load something from a network.
fn requests(content: &str) -> Vec<String> {
    let mut found = Vec::new();
    for request in REQUESTS {
        found.extend(content.match_indices(request).map(|(at, _)| excerpt(content, at)));
    }
    // a style sheet or a font; links to other sites are `<a>`
    for (at, _) in content.match_indices("<link ") {
        let tag = &content[at..content[at..].find('>').map_or(content.len(), |end| at + end)];
        if tag.contains("href=\"http") || tag.contains("href=\"//") {
            found.push(excerpt(content, at));
        }
    }
    found
}

fn excerpt(content: &str, at: usize) -> String {
    content[at..].chars().take(80).collect()
}

/// The values of an attribute.
fn values<'a>(content: &'a str, attribute: &str) -> impl Iterator<Item = &'a str> {
    let start = format!(" {attribute}=\"");
    let places: Vec<usize> = content.match_indices(&start).map(|(at, found)| at + found.len()).collect();
    places.into_iter().filter_map(|from| content[from..].split('"').next())
}

/// A fragment with its `%xx`.
fn decoded(fragment: &str) -> String {
    let (mut bytes, mut rest) = (Vec::new(), fragment);
    while let Some(first) = rest.chars().next() {
        let hex =
            rest.strip_prefix('%').and_then(|rest| rest.get(..2)).and_then(|hex| u8::from_str_radix(hex, 16).ok());
        let length = match hex {
            Some(byte) => {
                bytes.push(byte);
                3
            }
            None => {
                bytes.extend_from_slice(&rest.as_bytes()[..first.len_utf8()]);
                first.len_utf8()
            }
        };
        rest = &rest[length..];
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

#[cfg(test)]
mod tests {
    use super::{decoded, requests, values};

    #[test]
    fn requests_are_found_and_links_are_not() {
        assert_eq!(requests("<a href=\"https://a.b\">x</a> <link href=\"css/a.css\">").len(), 0);
        assert_eq!(requests("<script src=\"https://a.b/c.js\"></script>").len(), 1);
        assert_eq!(requests("<link rel=\"stylesheet\" href=\"https://a.b/c.css\">").len(), 1);
        assert_eq!(requests("@font-face { src: url(https://a.b/c.woff2) }").len(), 1);
    }

    #[test]
    fn attributes_and_fragments() {
        assert_eq!(values("<a href=\"b#c\" id=\"d\">", "id").collect::<Vec<_>>(), ["d"]);
        assert_eq!(decoded("%CF%84-x"), "τ-x");
    }
}
