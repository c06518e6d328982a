//! Expands [xacro](https://github.com/ros/xacro), the format in which ROS users describe robots with properties,
//! macros, includes and expressions. The language is that of xacro 2.1. Expressions are a bounded subset of Python; no
//! host code is evaluated.
//!
//! The expansion keeps the origin of each element and attribute: the file, and the chain of macro calls to it.
//!
//! ```
//! use mozzi_xacro::{Arguments, expand_text};
//!
//! let text = r#"<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
//!   <xacro:macro name="arm" params="side"><link name="${side}_arm"/></xacro:macro>
//!   <xacro:arm side="left"/>
//! </robot>"#;
//! let expansion = expand_text("r.xacro", text, &Arguments::default())?;
//! assert!(expansion.text.contains(r#"<link name="left_arm"/>"#));
//! let place = expansion.origin(expansion.text.find("left_arm").expect("there")..0).expect("a place");
//! assert_eq!(expansion.describe(&place), "r.xacro:2:53, from r.xacro:3 (side = \"left\")");
//! # Ok::<(), mozzi_xacro::Error>(())
//! ```
//!
//! Time, memory and depth are bounded for any input: five million steps, strings of a mebibyte, ints of 16,384 bits,
//! lists of 262,144 items, 250 macros in macros, 64 MiB of output. Each bound ends with an error at its place.
mod bounds;
mod condition;
mod document;
mod elements;
mod expander;
mod expression;
mod fault;
pub mod files;
mod find;
mod glob;
mod include;
mod macros;
mod origin;
mod parameters;
mod parse;
mod place;
mod property;
mod scope;
mod space;
mod substitution;
mod text;
mod write;
mod yaml;
mod yaml_scalar;

pub use expander::File;
pub use origin::{Error, Expansion, Origin, Warning};

use bounds::Budget;
use document::{Content, Document};
use expander::Expander;
use fault::{Fault, Result};
use place::Place;
use scope::{Macros, Scope};
use std::cell::{Cell, RefCell};
use std::path::{Path, PathBuf};
use std::rc::Rc;
use write::Writer;

/// The arguments of an expansion.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Arguments {
    /// Values of `$(arg name)`.
    pub values: Vec<(String, String)>,
    /// Folders of packages, for `$(find name)`; other packages are searched in the folders of `AMENT_PREFIX_PATH`,
    /// `CMAKE_PREFIX_PATH` and `ROS_PACKAGE_PATH`, and in those around the file.
    pub packages: Vec<(String, PathBuf)>,
    /// Texts of files that are included or loaded, by their names in [`Expansion::files`], instead of their content.
    pub texts: Vec<(String, String)>,
}

impl Arguments {
    /// The text that is read instead of a file, if there is one; its name may contain `folder/..`.
    pub fn text_of(&self, path: &Path) -> Option<&str> {
        let plain = include::without_parents(path);
        let found = self.texts.iter().find(|(known, _)| Path::new(known) == path || Path::new(known) == plain);
        found.map(|(_, text)| text.as_str())
    }
}

/// Expands a file.
///
/// # Errors
/// [`Error`] with its place, and the chain of macro calls to it.
pub fn expand(path: impl AsRef<Path>, arguments: &Arguments) -> std::result::Result<Expansion, Error> {
    let path = path.as_ref();
    let name = path.to_string_lossy();
    match include::read_text(path) {
        Ok(text) => expand_text(&name, &text, arguments),
        Err(fault) => Err(Error::unread(fault.message)),
    }
}

/// Expands a text; included files are searched next to `name`.
///
/// # Errors
/// See [`expand`].
pub fn expand_text(name: &str, text: &str, arguments: &Arguments) -> std::result::Result<Expansion, Error> {
    let run = || expand_here(name, text, arguments);
    if cfg!(target_family = "wasm") {
        return run(); // there are no threads; what nests too deep for its stack ends in a trap
    }
    // macros and expressions nest to a bounded depth, but need more stack than every thread is sure to have
    std::thread::scope(|scope| {
        let thread = std::thread::Builder::new().name("xacro".to_string()).stack_size(bounds::STACK);
        let Ok(handle) = thread.spawn_scoped(scope, run) else {
            return Err(Error::unread("no thread can be started for the expansion".to_string()));
        };
        handle.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    })
}

fn expand_here(name: &str, text: &str, arguments: &Arguments) -> std::result::Result<Expansion, Error> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut document = Document::default();
    let spacer = document.add(Content::Text("\n\n".into()), Place::default());
    let given = arguments.values.iter().map(|(name, value)| (name.as_str().into(), value.as_str().into()));
    let expander = Expander {
        given: arguments,
        budget: Budget::default(),
        document: RefCell::new(document),
        files: RefCell::default(),
        open: RefCell::new(vec![PathBuf::from(name)]),
        arguments: RefCell::new(given.collect()),
        known_arguments: RefCell::default(),
        variables: RefCell::default(),
        expressions: RefCell::default(),
        warnings: RefCell::default(),
        place: RefCell::default(),
        calls: Cell::new(0),
        spacer,
    };
    let result = expander.run(name, text);
    if result.is_ok() {
        expander.warn_of_unused_arguments();
    }
    let files = expander.files.take();
    let warnings = expander.warnings.take();
    let arguments = expander.known_values();
    let variables = expander.variables.take().into_iter().collect();
    match result {
        Ok((text, pieces)) => {
            Ok(Expansion { text, files, warnings, arguments, variables, work: expander.budget.work(), pieces })
        }
        Err(fault) => Err(Error::new(*fault, files, warnings)),
    }
}

impl Expander<'_> {
    fn run(&self, name: &str, text: &str) -> Result<(String, Vec<write::Piece>)> {
        let file = self.add_file(name, text)?;
        let parsed = parse::parse(text, file, &mut self.document.borrow_mut(), &self.budget)?;
        let root = parsed.root;
        let target = self.document.borrow().attribute(root, "xacro:targetNamespace").cloned();
        if let Some(target) = target.filter(|target| !target.value.is_empty()) {
            let mut document = self.document.borrow_mut();
            document.remove_attribute(root, &target.name);
            document.set_attribute(root, document::Attribute { name: "xmlns".into(), ..target });
        }
        let (macros, scope) = (Rc::new(Macros::default()), Rc::new(Scope::default()));
        self.evaluate_node(root, &macros, &scope).map_err(|fault| self.located(fault, root))?;
        let document = self.document.borrow();
        let mut writer =
            Writer { document: &document, text: "<?xml version=\"1.0\" ?>\n".to_string(), pieces: Vec::new() };
        for id in parsed.top {
            writer.node(id, 0)?;
        }
        let (text, pieces) = (writer.text, writer.pieces);
        // the result of an expression may contain characters that XML does not allow
        if let Some(at) = text.find(|c: char| {
            (c as u32) < 0x20 && !matches!(c, '\n' | '\t' | '\r') || matches!(c, '\u{fffe}' | '\u{ffff}')
        }) {
            let after = pieces.partition_point(|piece| piece.span.start <= at);
            let place = after.checked_sub(1).map(|k| pieces[k].place.clone());
            let fault = Fault::new("the expansion holds a control character, which XML does not allow");
            return Err(Box::new(Fault { place, ..*fault }));
        }
        Ok((text, pieces))
    }
}
