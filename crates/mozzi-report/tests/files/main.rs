//! Two files of a robot: the causes of their differences.
#![allow(clippy::unwrap_used, missing_docs)]

mod actuation;
mod aligned;
mod bodies;
mod constraints;
mod exchanged;
mod faults;
mod frames;
mod places;
mod reasons;
mod rotors;
mod rounded;
mod shapes;
mod starts;
mod verdict;

use mozzi::Description;
use mozzi_report::compare::files::{FilesComparison, RobotFile, compare_files};
use mozzi_urdf::XacroArguments;
use mozzi_urdf::geometry::{self, geometry};
use mozzi_urdf::mjcf::actuation_of;
use std::path::{Path, PathBuf};

fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/faults").join(name)
}

fn robot(name: &str) -> RobotFile {
    let path = path(name);
    let loaded = mozzi_urdf::load(&path).unwrap_or_else(|error| panic!("{error}"));
    let (inertial_axes, shapes) =
        (loaded.inertial_axes.clone(), Some(geometry(&path.to_string_lossy()).unwrap().shapes));
    RobotFile {
        name: name.to_string(),
        model: loaded.build().unwrap(),
        inertial_axes,
        shapes,
        has_start: false,
        has_rates: true,
        actuation: None,
        path: Some(path),
    }
}

fn compare(a: &str, b: &str) -> FilesComparison {
    compare_files(&robot(a), &robot(b), 20, 1, 1e-9).unwrap()
}

/// The robot of a text, next to the files of `tests/faults`.
fn of_text(name: &str, text: &str) -> RobotFile {
    let loaded = mozzi_urdf::parse(name, text).unwrap_or_else(|error| panic!("{error}"));
    let (inertial_axes, shapes) = (loaded.inertial_axes.clone(), Some(geometry::parse(name, text).shapes));
    let (has_start, has_rates) = (!name.ends_with(".urdf"), !name.ends_with(".xml"));
    let (model, path) = (loaded.build().unwrap(), Some(path(name)));
    let actuation = (!has_rates).then(|| actuation_of(None, name, text.as_bytes(), &XacroArguments::default()));
    RobotFile { name: name.into(), model, inertial_axes, shapes, has_start, has_rates, actuation, path }
}

/// a.urdf of a text, and b.urdf, in which these parts are replaced.
fn compare_edited(text: &str, edits: &[(&str, &str)]) -> FilesComparison {
    let edited = edits.iter().fold(text.to_string(), |text, (from, to)| {
        assert_eq!(text.matches(from).count(), 1, "{from}");
        text.replace(from, to)
    });
    compare_files(&of_text("a.urdf", text), &of_text("b.urdf", &edited), 10, 1, 1e-9).unwrap()
}

/// before.urdf, and b.urdf with an edited description.
fn compare_description(edit: impl Fn(&mut Description)) -> FilesComparison {
    let before = robot("before.urdf");
    let mut after = RobotFile { name: "b.urdf".into(), ..before.clone() };
    let mut description = before.model.description().clone();
    edit(&mut description);
    after.model = description.build().unwrap();
    after.inertial_axes.clear();
    compare_files(&before, &after, 10, 1, 1e-9).unwrap()
}

/// The report without line breaks.
fn flat(comparison: &FilesComparison) -> String {
    comparison.text().split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Whether the forces are the second robot's with all causes accounted for.
fn is_accounted_for(comparison: &FilesComparison) -> bool {
    let json = comparison.json();
    let quantities = json["differences_explained"].as_object().unwrap().values();
    quantities.map(|gap| [&gap["most"], &gap["of"]].map(|x| x.as_f64().unwrap())).all(|[most, of]| most <= 1e-9 * of)
}

/// The comparison has this one cause, which explains it or is a place.
fn has_cause(comparison: &FilesComparison, words: &str, is_explained: bool) {
    let causes: Vec<&str> = comparison.causes().collect();
    let text = comparison.text();
    assert!(causes.len() == 1 && causes[0].contains(words), "{words}: {text}");
    assert!(!comparison.agrees() && comparison.is_explained() == is_explained, "{words}: {text}");
    assert!(is_accounted_for(comparison), "{words}: {text}");
}
