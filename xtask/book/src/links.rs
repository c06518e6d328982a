//! Links of Markdown: from places in the repository to places in the book.

use crate::map::Map;
use crate::text;
use std::collections::BTreeSet;
use std::path::Path;

/// Files and folders of the repository that the book shows as text, because chapters link to them.
#[derive(Default)]
pub struct Sources {
    paths: BTreeSet<String>,
}

/// A page that is being rewritten.
pub struct Page<'a> {
    pub root: &'a Path,
    /// The folder in which generated chapters and pictures are.
    pub src: &'a Path,
    /// The file, from the repository's root.
    pub file: &'a str,
    /// The page, from the book's root.
    pub page: &'a str,
    pub map: &'a Map,
}

impl Page<'_> {
    /// Rewrites the links of a piece of prose.
    pub fn rewrite(&self, prose: &str, sources: &mut Sources) -> Result<String, String> {
        let (mut out, mut rest) = (String::with_capacity(prose.len()), prose);
        while let Some(at) = rest.find("](") {
            let from = at + 2;
            let Some(length) = rest[from..].find(')') else { break };
            out.push_str(&rest[..from]);
            out.push_str(&self.target(&rest[from..from + length], sources)?);
            rest = &rest[from + length..];
        }
        out.push_str(rest);
        Ok(out)
    }

    /// Whether a relative path leads to a file of the repository.
    fn is_in_repository(&self, path: &str) -> bool {
        let folder = self.file.rsplit_once('/').map_or("", |(folder, _)| folder);
        joined(folder, path).is_ok_and(|file| self.root.join(file).exists())
    }

    fn target(&self, link: &str, sources: &mut Sources) -> Result<String, String> {
        if link.starts_with('#') || link.contains("://") || link.starts_with("mailto:") {
            return Ok(link.to_owned());
        }
        let (path, fragment) =
            link.split_once('#').map_or((link, String::new()), |(path, id)| (path, format!("#{id}")));
        // generated chapters, pictures and rustdoc are in the book's folder alone
        let page_folder = self.page.rsplit_once('/').map_or("", |(folder, _)| folder);
        let in_book = joined(page_folder, path).ok().filter(|_| !path.starts_with('/'));
        let is_generated = |page: String| page.starts_with("rustdoc/") || self.src.join(page).is_file();
        if !self.is_in_repository(path) && in_book.is_some_and(is_generated) {
            return Ok(link.to_owned());
        }
        let folder = self.file.rsplit_once('/').map_or("", |(folder, _)| folder);
        let file = match path.strip_prefix('/') {
            Some(absolute) => absolute.to_owned(),
            None => joined(folder, path)?,
        };
        let up = "../".repeat(self.page.matches('/').count());
        if let Some(page) = self.map.page(&file) {
            return Ok(format!("{up}{page}{fragment}"));
        }
        let at = self.root.join(&file);
        let is_picture = ["svg", "png", "webp"].iter().any(|ending| file.ends_with(&format!(".{ending}")));
        if is_picture && at.is_file() {
            let bytes = std::fs::read(&at).map_err(|error| format!("{file}: {error}"))?;
            let name = file.rsplit('/').next().unwrap_or(&file);
            text::write(&self.src.join("pictures").join(name), bytes)?;
            return Ok(format!("{up}pictures/{name}"));
        }
        if !at.exists() {
            return Err(format!("{}: the link `{link}` leads nowhere", self.file));
        }
        let file = file.trim_end_matches('/').to_owned();
        let shown = format!("{up}source/{}", shown(&file, at.is_dir()));
        sources.paths.insert(file);
        Ok(shown)
    }
}

/// A path relative to a folder, without `.` and `..`.
pub fn joined(folder: &str, path: &str) -> Result<String, String> {
    let mut parts: Vec<&str> = folder.split('/').filter(|part| !part.is_empty()).collect();
    for part in path.split('/') {
        match part {
            "" | "." => {}
            ".." => {
                parts.pop().ok_or_else(|| format!("`{path}` leaves the repository"))?;
            }
            name => parts.push(name),
        }
    }
    Ok(parts.join("/"))
}

/// The page of a file; mdBook takes `.md` in a link for a chapter.
fn shown(file: &str, is_folder: bool) -> String {
    if is_folder { format!("{file}/index.html") } else { format!("{}.html", file.replace(".md", "-md")) }
}

impl Sources {
    /// Adds a file to those that the book shows; its page.
    pub fn show(&mut self, file: &str) -> String {
        self.paths.insert(file.to_owned());
        format!("source/{}", shown(file, false))
    }

    /// Writes a page for each: the file's text, or the folder's list.
    pub fn write(&self, place: &crate::Place, html: &Path) -> Result<(), String> {
        let mut files: BTreeSet<String> = BTreeSet::new();
        for path in &self.paths {
            let at = place.root.join(path);
            if !at.is_dir() {
                files.insert(path.clone());
                continue;
            }
            let mut list = String::new();
            for entry in text::entries(&at)? {
                let name = entry.file_name().unwrap_or_default().to_string_lossy().into_owned();
                let is_text = entry.is_file() && std::fs::read_to_string(&entry).is_ok();
                if is_text {
                    files.insert(format!("{path}/{name}"));
                    list += &format!("<li><a href=\"{}\">{name}</a></li>\n", shown(&name, false));
                } else {
                    list += &format!("<li>{name}</li>\n");
                }
            }
            let page = frame(path, &format!("<ul>\n{list}</ul>"));
            text::write(&html.join("source").join(shown(path, true)), page)?;
        }
        for file in files {
            let source = text::read(&place.root.join(&file))?;
            let page = frame(&file, &format!("<pre>{}</pre>", text::escaped(&source)));
            text::write(&html.join("source").join(shown(&file, false)), page)?;
        }
        Ok(())
    }
}

fn frame(title: &str, content: &str) -> String {
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><title>{title}</title></head>\n\
         <body><h1>{title}</h1>\n{content}\n</body>\n</html>\n"
    )
}

#[cfg(test)]
mod tests {
    use super::joined;

    #[test]
    fn paths_are_joined() {
        assert_eq!(joined("docs", "../examples/cpp").as_deref(), Ok("examples/cpp"));
        assert_eq!(joined("", "a/./b").as_deref(), Ok("a/b"));
        assert!(joined("docs", "../../x").is_err());
    }
}
