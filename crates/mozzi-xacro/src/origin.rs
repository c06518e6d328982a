//! The result of an expansion: a text with its places, or an error at a place.

use crate::expander::File;
use crate::fault::Fault;
use crate::parse::NOT_XML;
use crate::place::Place;
use crate::write::Piece;
use std::fmt;
use std::ops::Range;
use std::sync::Arc;

/// A place in one of the files, and the chain of macro calls to it, innermost first.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Origin {
    /// The index of the file in the list of files.
    pub file: usize,
    /// The bytes in the file's text.
    pub span: Range<usize>,
    /// The file and the byte of each call, and its arguments: `prefix = "left_"`.
    pub calls: Vec<(usize, usize, String)>,
}

impl Origin {
    pub(crate) fn of(place: &Place) -> Origin {
        let calls = std::iter::successors(place.call.as_ref(), |call| call.place.call.as_ref());
        let calls = calls.map(|call| (call.place.file as usize, call.place.start as usize, call.arguments.clone()));
        Origin { file: place.file as usize, span: place.span(), calls: calls.collect() }
    }
}

impl Origin {
    /// `, from ur.urdf.xacro:40 (prefix = "left_")`, for each call; empty outside of macros.
    pub fn from(&self, files: &[File]) -> String {
        from(files, self)
    }
}

/// A warning or message from a successful expansion.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// The message.
    pub message: String,
    /// Its place.
    pub place: Origin,
}

/// An expanded file.
#[derive(Debug)]
pub struct Expansion {
    /// The expansion, as xacro prints it, without its banner.
    pub text: String,
    /// The files that were read, the given one first; YAML files have no text here.
    pub files: Vec<File>,
    /// Messages of the file, and warnings.
    pub warnings: Vec<Warning>,
    /// The arguments that the files declare or read, with their values, by name.
    pub arguments: Vec<(String, String)>,
    /// The variables of the environment whose values were read.
    pub variables: Vec<String>,
    /// Evaluation steps; the limit is two million.
    pub work: u64,
    pub(crate) pieces: Vec<Piece>,
}

impl Expansion {
    /// The origin of a part of the text: the place of the element, attribute or text in which it begins. None before
    /// the first element.
    pub fn origin(&self, span: Range<usize>) -> Option<Origin> {
        // at a `<`, the element's name
        let start = span.start + usize::from(self.text[..].get(span.start..).is_some_and(|text| text.starts_with('<')));
        let after = self.pieces.partition_point(|piece| piece.span.start <= start);
        let piece = self.pieces.get(after.checked_sub(1)?)?;
        let mut origin = Origin::of(&piece.place);
        let raw = self.files.get(origin.file).and_then(|file| file.text.get(origin.span.clone()));
        let (written, from) = match piece.value {
            Some((value, name)) if start < value => {
                // the attribute's name
                let length = value.saturating_sub(piece.span.start + 2);
                origin.span = name as usize..name as usize + length;
                return Some(origin);
            }
            Some((value, _)) => (self.text.get(value..piece.span.end), value),
            None => (self.text.get(piece.span.clone()), piece.span.start),
        };
        // text copied verbatim from the file keeps its exact place
        if raw == written && start <= piece.span.end {
            let begin = origin.span.start + (start - from);
            let end = begin + span.end.min(piece.span.end).saturating_sub(start);
            origin.span = begin..end;
        }
        Some(origin)
    }

    /// `wrist.xacro:12:8, from ur.urdf.xacro:40 (prefix = "left_")`
    pub fn describe(&self, origin: &Origin) -> String {
        describe(&self.files, origin)
    }
}

/// The line and the column of a byte, both counted from 1, columns in characters.
fn position(text: &str, at: usize) -> (usize, usize) {
    let before = &text[..text.floor_char_boundary(at)];
    let start = before.rfind('\n').map_or(0, |k| k + 1);
    (before.matches('\n').count() + 1, before[start..].chars().count() + 1)
}

fn describe(files: &[File], origin: &Origin) -> String {
    let Some(file) = files.get(origin.file) else { return String::new() };
    let (line, column) = position(&file.text, origin.span.start);
    format!("{}:{line}:{column}{}", file.name, from(files, origin))
}

/// Inner and outer calls that a message shows; those between are counted.
const SHOWN: [usize; 2] = [4, 2];

/// `, from ur.urdf.xacro:40 (prefix = "left_")`, for each call.
fn from(files: &[File], origin: &Origin) -> String {
    let (count, [inner, outer]) = (origin.calls.len(), SHOWN);
    let between = if count > inner + outer + 1 { inner..count - outer } else { 0..0 };
    let calls = origin.calls.iter().enumerate().filter_map(|(k, (file, at, arguments))| {
        if between.contains(&k) {
            return (k == inner).then(|| format!(", from {} more calls", between.len()));
        }
        let file = files.get(*file)?;
        let line = position(&file.text, *at).0;
        let arguments = if arguments.is_empty() { String::new() } else { format!(" ({arguments})") };
        Some(format!(", from {}:{line}{arguments}", file.name))
    });
    calls.collect()
}

/// Why a file cannot be expanded. Displays as `file:line:column, from file:line (arguments): message`.
#[derive(Clone, Debug)]
pub struct Error {
    message: String,
    place: Option<Origin>,
    files: Arc<[File]>,
    warnings: Arc<[Warning]>,
}

impl Error {
    pub(crate) fn new(fault: Fault, files: Vec<File>, warnings: Vec<Warning>) -> Error {
        let place = fault.place.as_ref().map(Origin::of);
        Error { message: fault.message, place, files: files.into(), warnings: warnings.into() }
    }

    pub(crate) fn unread(message: String) -> Error {
        Error { message, place: None, files: Arc::new([]), warnings: Arc::new([]) }
    }

    /// The message: found, and expected.
    pub fn message(&self) -> &str {
        &self.message
    }

    /// The place; none if the first file cannot be read.
    pub fn place(&self) -> Option<&Origin> {
        self.place.as_ref()
    }

    /// The files that were read.
    pub fn files(&self) -> &[File] {
        &self.files
    }

    /// Messages of the file before the error.
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings
    }

    /// True if the file at the place is not XML.
    pub fn is_syntax(&self) -> bool {
        self.message.starts_with(NOT_XML)
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.place {
            Some(place) => write!(f, "{}: {}", describe(&self.files, place), self.message),
            None => f.write_str(&self.message),
        }
    }
}

impl std::error::Error for Error {}
