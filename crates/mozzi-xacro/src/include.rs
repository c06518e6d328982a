//! `<xacro:include>`, and reading files.

use crate::bounds::{MOST_BYTES, MOST_FILES, MOST_INCLUDE_DEPTH};
use crate::condition::truth;
use crate::document::Id;
use crate::expander::{Expander, File};
use crate::expression::{Value, text_of};
use crate::fault::{Fault, Result};
use crate::files;
use crate::glob::{self, is_pattern};
use crate::parse::parse;
use crate::scope::{Definition, Macros, Property, Scope};
use std::path::{Component, Path, PathBuf};
use std::rc::Rc;

impl Expander<'_> {
    pub fn include(&self, id: Id, macros: &Rc<Macros>, scope: &Rc<Scope>) -> Result<()> {
        let filename = self.checked(id, &["filename"], &["ns", "optional"])?;
        let (mut macros, mut scope, outer) = (macros.clone(), scope.clone(), scope.clone());
        if let Some(ns) = self.optional(id, "ns").filter(|ns| !ns.value.is_empty()) {
            let name = self.evaluate_text(&ns.value, &outer, &ns.place)?;
            let inner = Rc::new(Macros::default());
            macros.set(&name, Definition::Namespace(inner.clone()));
            let properties = Scope::namespace(&outer);
            outer.set(&name, Property::Value(Value::Namespace(properties.clone())));
            (macros, scope) = (inner, properties);
        }
        let is_optional = match self.optional(id, "optional") {
            Some(optional) => truth(&Value::Str(optional.value.clone()))
                .map_err(|fault| self.placed(fault, &optional.value, &optional.place))?,
            None => false,
        };
        if self.document.borrow().element_children(id).next().is_some() {
            self.warn("what is inside <xacro:include> is not used".to_string());
        }
        let file = self.evaluate(&filename.value, &outer, &filename.place)?;
        let placed = |fault| self.placed(fault, "", &filename.place);
        let Value::Str(file) = &file else {
            let shown = text_of(&self.budget, &file).unwrap_or_default();
            return Err(placed(Fault::new(format!(
                "the file to include is `{shown}`, a {}, expected a path",
                file.kind()
            ))));
        };
        let path = self.beside(file);
        let files = if is_pattern(file) || is_pattern(&path.to_string_lossy()) {
            let found = glob::files(&path.to_string_lossy()).map_err(placed)?;
            if found.is_empty() {
                self.warn(format!("no file matches `{file}`"));
            }
            found
        } else {
            vec![path]
        };
        let mut included = Vec::new();
        for file in files {
            match self.include_file(file, &macros, &scope) {
                Ok(root) => {
                    included.push(root);
                    let declared = self.document.borrow().attributes(root).to_vec();
                    let parent = self.document.borrow().node(id).parent;
                    if let Some(parent) = parent {
                        self.import_namespaces(parent, &declared);
                    }
                }
                Err(fault) if fault.is_missing_file && is_optional => {}
                Err(fault) => return Err(placed(fault)),
            }
        }
        self.remove_comments_before(id);
        self.document.borrow_mut().replace_by_content(id, &included);
        Ok(())
    }

    /// The evaluated root of an included file.
    fn include_file(&self, path: PathBuf, macros: &Rc<Macros>, scope: &Rc<Scope>) -> Result<Id> {
        if self.open.borrow().len() > MOST_INCLUDE_DEPTH {
            let message = format!(
                "more than {MOST_INCLUDE_DEPTH} files include each other; does `{}` include itself?",
                path.display()
            );
            return Err(Fault::new(message));
        }
        let file = self.read(&path)?;
        let root = self.parse(file)?;
        // after an error in an optional file, files are still searched next to that file, as in xacro
        self.open.borrow_mut().push(path);
        self.budget.deeper(|| self.evaluate_node(root, macros, scope))?;
        self.open.borrow_mut().pop();
        Ok(root)
    }

    /// Reads a file, and returns its index.
    pub fn read(&self, path: &Path) -> Result<u32> {
        let text = self.text_of(path)?;
        self.budget.spend(1 + text.len() as u64 / 64)?;
        self.add_file(&path.to_string_lossy(), &text)
    }

    /// The text of a file, or its replacement.
    pub fn text_of(&self, path: &Path) -> Result<String> {
        self.given.text_of(path).map_or_else(|| read_text(path), |text| Ok(text.to_string()))
    }

    pub fn add_file(&self, name: &str, text: &str) -> Result<u32> {
        let mut files = self.files.borrow_mut();
        if files.len() >= MOST_FILES {
            return Err(Fault::new(format!("more than {MOST_FILES} files are included")));
        }
        files.push(File { name: name.into(), text: text.into() });
        Ok(files.len() as u32 - 1)
    }

    fn parse(&self, file: u32) -> Result<Id> {
        let text = self.files.borrow()[file as usize].text.clone();
        Ok(parse(&text, file, &mut self.document.borrow_mut(), &self.budget)?.root)
    }
}

/// The path with each `folder/..` removed, as written.
pub(crate) fn without_parents(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        let is_up =
            part == Component::ParentDir && matches!(plain.components().next_back(), Some(Component::Normal(_)));
        if is_up {
            plain.pop();
        } else {
            plain.push(part);
        }
    }
    plain
}

/// The text of a file, without a byte order mark.
pub(crate) fn read_text(path: &Path) -> Result<String> {
    let fails =
        |why: &dyn std::fmt::Display| Fault::missing_file(format!("`{}` cannot be read: {why}", path.display()));
    let bytes = files::read(path, MOST_BYTES as u64).map_err(|why| fails(&why))?;
    let text = String::from_utf8(bytes).map_err(|why| {
        Fault::new(format!("byte {} of `{}` is not UTF-8", why.utf8_error().valid_up_to(), path.display()))
    })?;
    Ok(text.strip_prefix('\u{feff}').map(str::to_string).unwrap_or(text))
}
