//! Broken files are refused, at the right place and with the right message.
/// A body with something in it.
macro_rules! body {
    ($inside:literal) => {
        concat!("<mujoco><worldbody><body name='b'>", $inside, "</body></worldbody></mujoco>")
    };
}

mod meaning;
mod mjcf;
mod mjcf_left_out;
mod numbers;
mod structure;
mod syntax;

use mozzi_urdf::{LoadError, Policy, parse, parse_with};

/// A broken text, with § where the error is expected to point, and the error's code and message.
type Case = (&'static str, &'static str, &'static str);

/// The text without its mark, and the line and column where it stood.
fn unmarked(text: &str) -> (String, usize, usize) {
    let (before, after) = text.split_once('§').expect("a mark");
    let line = before.matches('\n').count() + 1;
    let column = before.rsplit('\n').next().map_or(0, |last| last.chars().count()) + 1;
    (format!("{before}{after}"), line, column)
}

/// The code with the language of the text.
fn full(text: &str, code: &str) -> String {
    format!("mozzi::{}::{code}", if text.contains("<mujoco") { "mjcf" } else { "urdf" })
}

/// Each case has exactly one error, as expected.
fn refused(cases: &[Case]) {
    for &(text, code, message) in cases {
        let (text, line, column) = unmarked(text);
        let error = parse("a.urdf", &text).expect_err(&text);
        let errors: Vec<_> = error.errors().collect();
        let [found] = errors.as_slice() else { panic!("{text}\n{error}") };
        assert_eq!(
            (found.code(), found.to_string()),
            (full(&text, code).as_str(), format!("a.urdf:{line}:{column}: error: {message}")),
            "{text}"
        );
        known(&error);
    }
}

/// Each case loads with exactly one warning, as expected, and is refused by the strict policy.
fn warned(cases: &[Case]) {
    for &(text, code, message) in cases {
        let (text, line, column) = unmarked(text);
        let robot = parse("a.urdf", &text).unwrap_or_else(|error| panic!("{text}\n{error}"));
        let [found] = robot.warnings.as_slice() else { panic!("{text}\n{:#?}", robot.warnings) };
        assert_eq!(
            (found.code(), found.to_string()),
            (full(&text, code).as_str(), format!("a.urdf:{line}:{column}: warning: {message}")),
            "{text}"
        );
        let strict = parse_with("a.urdf", &text, Policy::Strict).expect_err("a warning");
        assert_eq!(strict.errors().count(), 1);
        known(&strict);
    }
}

/// Every code has its explanation, and every report can be drawn.
fn known(error: &LoadError) {
    for diagnostic in error.diagnostics() {
        assert!(mozzi_urdf::explain(diagnostic.code()).is_some(), "{}", diagnostic.code());
    }
    for style in [mozzi_urdf::Style::Ascii, mozzi_urdf::Style::Unicode, mozzi_urdf::Style::Color] {
        assert!(error.pretty(style).contains("refused"));
    }
}
