//! Every diagnostic code of all languages, reached by a broken file, with the exact report that its author reads.
//!
//! `tests/broken/CODE.urdf` and `CODE-variant.urdf` are robots with one error, `CODE.txt` next to them is the report;
//! likewise the models in `tests/broken/mjcf` and `tests/broken/sdf`. A code without a file fails the test.
//! `MOZZI_BLESS=1 cargo test -p mozzi-urdf reports` rewrites the reports: read them before you commit them.

mod excerpt;
mod mends;
mod page;

use mozzi_urdf::{LoadError, Loaded, Policy, Style, codes, explain, load_with, mjcf, parse_with, sdf};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// A broken file: its name without ending, and its bytes; a MuJoCo model has a path, for its included files.
struct Broken {
    name: String,
    text: Vec<u8>,
    path: Option<PathBuf>,
}

impl Broken {
    /// The code that the file is an example of.
    fn code(&self) -> &str {
        self.name.split('-').next().unwrap_or_default()
    }

    /// Its text; bytes that are not UTF-8 are replaced.
    fn text(&self) -> String {
        let read = |path: &PathBuf| std::fs::read(path).expect("a file");
        String::from_utf8_lossy(&self.path.as_ref().map_or_else(|| self.text.clone(), read)).replace("\r\n", "\n")
    }

    fn load(&self) -> Result<Loaded, LoadError> {
        let policy = if self.code() == "repaired_inertia" { Policy::Lenient } else { Policy::Default };
        match &self.path {
            Some(path) => load_with(path, policy),
            None if self.text.starts_with(b"<mujoco") => parse_with("arm.xml", &self.text, policy),
            None => parse_with("arm.urdf", &self.text, policy),
        }
    }
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/broken")
}

/// The files of a folder with an ending.
fn files(folder: &Path, ending: &str) -> impl Iterator<Item = PathBuf> {
    let paths = std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    paths.filter(move |path| path.extension().is_some_and(|found| found == ending))
}

fn name(path: &Path) -> String {
    path.file_stem().expect("a name").to_string_lossy().into_owned()
}

/// The files of the folder, and those that are too large for it.
fn robots() -> Vec<Broken> {
    let read = |path: PathBuf| Broken { name: name(&path), text: std::fs::read(&path).expect("a file"), path: None };
    let mut all: Vec<Broken> = files(&folder(), "urdf").map(read).collect();
    let robot = |start: &str, rest: &str| format!("<robot name=\"arm\"{start}>\n{rest}\n</robot>\n").into_bytes();
    let count = |n: usize, text: fn(usize) -> String| (0..n).map(text).collect::<String>();
    let large = [
        ("long_name", robot("", &format!("  <link name=\"{}\"/>", "b".repeat(300)))),
        ("too_deep", robot("", &(count(300, |_| "<a>".into()) + &"</a>".repeat(300)))),
        ("too_large", vec![b' '; (64 << 20) + 1]),
        ("too_large-elements", robot("", &count(2_000_000, |_| "<a/>".into()))),
        ("too_many_attributes", robot("", &format!("  <link {}/>", count(300, |k| format!("a{k}=\"\" "))))),
        ("too_many_namespaces", robot(&count(65, |k| format!(" xmlns:n{k}=\"{k}\"")), "  <link name=\"base\"/>")),
        ("too_many_namespaces-file", robot("", &count(4097, |k| format!("<a xmlns:n{k}=\"{k}\"/>\n")))),
    ];
    all.extend(large.map(|(name, text)| Broken { name: name.to_string(), text, path: None }));
    all.sort_by(|a, b| a.name.cmp(&b.name));
    all
}

/// The models of MuJoCo, and those that are too large for the folder.
fn models() -> Vec<Broken> {
    let read = |path: PathBuf| Broken { name: name(&path), text: Vec::new(), path: Some(path) };
    let mut all: Vec<Broken> = files(&folder().join("mjcf"), "xml").map(read).collect();
    let text = format!("<mujoco><worldbody>{}</worldbody></mujoco>", "<body>".repeat(300) + &"</body>".repeat(300));
    all.push(Broken { name: "too_deep".to_string(), text: text.into_bytes(), path: None });
    let body = "<worldbody><body name=\"b\"><freejoint/><geom size=\"1\"/></body></worldbody>";
    let keys = "<key/>\n".repeat(1_000_000 / 7 + 1);
    let text = format!("<mujoco>\n{body}\n<keyframe>\n{keys}</keyframe>\n</mujoco>\n");
    all.push(Broken { name: "too_many_keys".to_string(), text: text.into_bytes(), path: None });
    all.sort_by(|a, b| a.name.cmp(&b.name));
    all
}

/// The models of Gazebo and Drake.
fn sdf_models() -> Vec<Broken> {
    let read = |path: PathBuf| Broken { name: name(&path), text: Vec::new(), path: Some(path) };
    let mut all: Vec<Broken> = files(&folder().join("sdf"), "sdf").map(read).collect();
    all.sort_by(|a, b| a.name.cmp(&b.name));
    all
}

/// The report for its author, and the codes in it.
fn report(broken: &Broken) -> (String, BTreeSet<String>) {
    let (text, diagnostics) = match broken.load() {
        Ok(robot) => {
            let all = [robot.warnings, robot.unused].concat();
            (all.iter().map(|found| found.pretty(Style::Ascii)).collect(), all)
        }
        Err(error) => (error.pretty(Style::Ascii) + "\n", error.diagnostics().to_vec()),
    };
    // the folder differs on each machine
    let text = ["mjcf", "sdf"].iter().fold(text, |text: String, language| {
        text.replace(&*format!("{}/", folder().join(language).to_string_lossy()), "")
    });
    let lines: Vec<&str> = text.lines().map(str::trim_end).collect();
    (lines.join("\n") + "\n", diagnostics.iter().map(|diagnostic| diagnostic.code().to_string()).collect())
}

/// Compares the reports with the files next to them; returns the codes that were reached.
fn compare(language: &str, folder: &Path, all: Vec<Broken>) -> BTreeSet<String> {
    let (bless, mut reached) = (std::env::var_os("MOZZI_BLESS").is_some(), BTreeSet::new());
    let mut differing = Vec::new();
    for broken in all {
        let (found, codes) = report(&broken);
        let code = format!("mozzi::{language}::{}", broken.code());
        // a value written as text is also stray text; a reported element may be inside an ignored section
        let beside =
            ["stray_text", "ignored_element", "undeclared_prefix"].map(|short| format!("mozzi::{language}::{short}"));
        let others = codes.iter().filter(|found| **found != code && !beside.contains(*found)).count();
        if others > 0 || !codes.contains(&code) {
            differing.push(format!("{}: expected {code} alone\n{found}", broken.name));
        }
        reached.insert(broken.code().to_string());
        let file = folder.join(format!("{}.txt", broken.name));
        if bless {
            std::fs::write(&file, &found).expect("a writable folder");
        }
        let expected = std::fs::read_to_string(&file).unwrap_or_default();
        if found != expected.replace("\r\n", "\n") {
            differing.push(format!("{}\nfound\n{found}\nexpected\n{expected}", broken.name));
        }
    }
    assert!(differing.is_empty(), "{}", differing.join("\n\n"));
    reached
}

#[test]
fn every_code_of_urdf_is_reached_and_its_report_is_as_it_was_read() {
    let reached = compare("urdf", &folder(), robots());
    let known: BTreeSet<String> = codes().map(str::to_string).collect();
    assert_eq!(reached, known, "codes that tests/broken reaches, and those that there are");
    assert!(known.iter().all(|code| explain(code).is_some()));
}

#[test]
fn every_code_of_mjcf_is_reached_and_its_report_is_as_it_was_read() {
    let reached = compare("mjcf", &folder().join("mjcf"), models());
    let known: BTreeSet<String> = mjcf::codes().map(str::to_string).collect();
    let missing: Vec<&String> = known.difference(&reached).collect();
    assert!(missing.is_empty(), "codes that tests/broken/mjcf does not reach: {missing:?}");
    // it shares the others with URDF
    let shared: BTreeSet<String> = codes().map(str::to_string).collect();
    let unknown: Vec<&String> =
        reached.iter().filter(|&code| !known.contains(code) && !shared.contains(code)).collect();
    assert!(unknown.is_empty(), "{unknown:?}");
    assert!(reached.iter().all(|code| explain(&format!("mozzi::mjcf::{code}")).is_some()));
}

#[test]
fn every_code_of_sdf_is_reached_and_its_report_is_as_it_was_read() {
    let reached = compare("sdf", &folder().join("sdf"), sdf_models());
    let known: BTreeSet<String> = sdf::codes().map(str::to_string).collect();
    let missing: Vec<&String> = known.difference(&reached).collect();
    assert!(missing.is_empty(), "codes that tests/broken/sdf does not reach: {missing:?}");
    assert!(reached.iter().all(|code| explain(&format!("mozzi::sdf::{code}")).is_some()));
    let sorted: Vec<&str> = sdf::codes().collect();
    assert!(sorted.is_sorted());
}
