//! Xacro files are expanded before they are read. Findings in the expansion are reported at their places in the xacro
//! file.

use crate::geometry::Own;
use crate::report::diagnostic::Diagnostic;
use crate::report::error::LoadError;
use crate::report::finding::Finding;
use crate::settings::Settings;
use crate::text::bytes::to_text;
use crate::text::dialect::Dialect;
use crate::text::scan::scan;
use crate::text::source::{Source, Walker};
use crate::text::{syntax, xacro};
use mozzi_xacro::{Arguments, Error, Expansion, File, Origin, expand_text};
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

/// A source that the reader takes, and warnings of xacro.
type Prepared = (Source, Vec<Diagnostic>);

/// The source as it is, or its expansion if it is xacro.
pub(crate) fn prepare(source: Source, arguments: &Arguments) -> Result<Prepared, LoadError> {
    let dialect = Dialect::of(&source.text);
    let parse = || {
        scan(&source.text).ok()?;
        let document = roxmltree::Document::parse(&source.text).ok()?;
        Some(xacro::is_unexpanded(&document, dialect))
    };
    if !xacro::is_program(&source.text, &source.name, parse) {
        let unused = |(name, _): &(String, String)| {
            let message = format!("the argument `{name}` is given and not used: the file is no xacro");
            let start = Walker::new(&source.text).advance(0);
            Diagnostic::new(Finding::warning("xacro_warning", 0..0, message), start, source.clone(), dialect)
        };
        let warnings = arguments.values.iter().map(unused).collect();
        return Ok((source, warnings));
    }
    let place = |files: &[File], origin: &Origin, finding| at(files, origin, finding, dialect);
    match expand_text(&source.name, &source.text, arguments) {
        Ok(expansion) => {
            let warning = |warning: &mozzi_xacro::Warning| {
                let finding = Finding::warning("xacro_warning", 0..0, warning.message.clone());
                place(&expansion.files, &warning.place, finding)
            };
            let warnings = expansion.warnings.iter().take(crate::report::finding::MOST_FINDINGS).map(warning).collect();
            let mut expanded = Source::new(&source.name, &expansion.text);
            expanded.expansion = Some(Arc::new(expansion));
            Ok((expanded, warnings))
        }
        Err(error) => {
            let mut diagnostics = vec![refused(&error, &source, dialect)];
            diagnostics.extend(error.warnings().iter().map(|warning| {
                let finding = Finding::warning("xacro_warning", 0..0, warning.message.clone());
                place(error.files(), &warning.place, finding)
            }));
            Err(LoadError::Refused { file: source.name.to_string(), diagnostics, is_cut: false })
        }
    }
}

/// The expansion of a xacro text; None for any other text.
///
/// # Errors
/// [`LoadError::Refused`] with the place of the error.
pub fn expanded(
    file_name: &str,
    text: impl AsRef<[u8]>,
    settings: impl Into<Settings>,
) -> Result<Option<String>, LoadError> {
    Ok(expanded_with_warnings(file_name, text, settings)?.0)
}

/// As [`expanded`], and the warnings of the expansion.
///
/// # Errors
/// As [`expanded`].
pub fn expanded_with_warnings(
    file_name: &str,
    text: impl AsRef<[u8]>,
    settings: impl Into<Settings>,
) -> Result<(Option<String>, Vec<Diagnostic>), LoadError> {
    let Ok(text) = to_text(text.as_ref()) else { return Ok((None, Vec::new())) };
    let (source, warnings) = prepare(Source::new(file_name, text), &settings.into().xacro)?;
    Ok((source.expansion.map(|expansion| expansion.text.clone()), warnings))
}

/// The inputs from this machine that the expansion of a xacro text used: environment variables, and files that are
/// neither next to the robot's file nor in a package (a folder with package.xml, or one that is given). If the text is
/// passed on, it may contain them.
///
/// # Errors
/// As [`expanded`].
pub fn taken_from_host(
    file_name: &str,
    text: impl AsRef<[u8]>,
    settings: impl Into<Settings>,
) -> Result<Vec<String>, LoadError> {
    let (Ok(text), settings) = (to_text(text.as_ref()), settings.into()) else { return Ok(Vec::new()) };
    let Some(expansion) = of(file_name, text, &settings)? else { return Ok(Vec::new()) };
    let variables = expansion.variables.iter().map(|name| format!("the environment variable `{name}`"));
    let packages = settings.xacro.packages.iter().map(|(_, folder)| folder.as_path());
    let own = Own::of(Path::new(file_name), packages);
    let others = expansion.files.iter().skip(1).filter(|file| !own.has(Path::new(&*file.name)));
    Ok(variables.chain(others.map(|file| format!("the file {}", file.name))).collect())
}

/// The expansion of a xacro text with its places; None for any other text.
pub(crate) fn of(file_name: &str, text: &str, settings: &Settings) -> Result<Option<Arc<Expansion>>, LoadError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    Ok(prepare(Source::new(file_name, text), &settings.xacro)?.0.expansion)
}

fn refused(error: &Error, source: &Source, dialect: Dialect) -> Diagnostic {
    let Some(origin) = error.place() else {
        let finding = Finding::error("xacro", 0..0, error.message());
        return Diagnostic::new(finding, Walker::new(&source.text).advance(0), source.clone(), dialect);
    };
    let mut finding = Finding::error("xacro", 0..0, error.message());
    if error.is_syntax() && origin.file == 0 {
        // the XML reader's message
        if let Err(syntax) = syntax::parse(source, dialect) {
            let origin = Origin { span: syntax.span.clone(), ..origin.clone() };
            return at(error.files(), &origin, syntax, dialect);
        }
    } else if error.is_syntax() {
        // it may be any file of this machine, so diagnostics must not show its lines
        finding = finding.help("an included file is XML, of xacro or of URDF");
        let diagnostic = at(error.files(), origin, finding, dialect);
        return diagnostic.hidden();
    }
    at(error.files(), origin, finding, dialect)
}

/// A finding of the expansion at its place in a xacro file.
pub(crate) fn placed(expansion: &Expansion, finding: Finding, span: Range<usize>, dialect: Dialect) -> Diagnostic {
    let start = || Origin { file: 0, span: 0..0, calls: Vec::new() };
    let origin = expansion.origin(span).unwrap_or_else(start);
    at(&expansion.files, &origin, finding, dialect)
}

fn at(files: &[File], origin: &Origin, mut finding: Finding, dialect: Dialect) -> Diagnostic {
    let source = files.get(origin.file).map_or_else(|| Source::new("", ""), |file| Source::new(&file.name, &file.text));
    finding.span = source.clamp(origin.span.clone());
    let position = Walker::new(&source.text).advance(finding.span.start);
    Diagnostic::new(finding, position, source, dialect).called_from(origin.from(files))
}
