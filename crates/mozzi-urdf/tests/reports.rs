//! Every diagnostic code, reached by a broken file, with the exact report that its author reads.
//!
//! `tests/broken/CODE.urdf` and `CODE-variant.urdf` are robots with one thing wrong, `CODE.txt` beside them the report.
//! `MOZZI_BLESS=1 cargo test -p mozzi-urdf --test reports` writes the reports anew: read them before you commit them.

use mozzi_urdf::{Policy, Style, codes, explain, parse_with};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// A broken file: its name without ending, and its bytes.
struct Broken {
    name: String,
    text: Vec<u8>,
}

impl Broken {
    /// The code that the file is an example of.
    fn code(&self) -> &str {
        self.name.split('-').next().unwrap_or_default()
    }
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/broken")
}

/// The files of the folder, and those that are too large for it.
fn broken() -> Vec<Broken> {
    let files = std::fs::read_dir(folder()).expect("tests/broken").map(|entry| entry.expect("an entry").path());
    let mut all: Vec<Broken> = files
        .filter(|path| path.extension().is_some_and(|ending| ending == "urdf"))
        .map(|path| Broken {
            name: path.file_stem().expect("a name").to_string_lossy().into_owned(),
            text: std::fs::read(&path).expect("a readable file"),
        })
        .collect();
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
    all.extend(large.map(|(name, text)| Broken { name: name.to_string(), text }));
    all.sort_by(|a, b| a.name.cmp(&b.name));
    all
}

/// What its author reads, and the codes in it.
fn report(broken: &Broken) -> (String, BTreeSet<String>) {
    let policy = if broken.code() == "repaired_inertia" { Policy::Lenient } else { Policy::Default };
    let (text, diagnostics) = match parse_with("arm.urdf", &broken.text, policy) {
        Ok(robot) => (robot.warnings.iter().map(|warning| warning.pretty(Style::Ascii)).collect(), robot.warnings),
        Err(error) => (error.pretty(Style::Ascii) + "\n", error.diagnostics().to_vec()),
    };
    let lines: Vec<&str> = text.lines().map(str::trim_end).collect();
    (lines.join("\n") + "\n", diagnostics.iter().map(|diagnostic| diagnostic.code().to_string()).collect())
}

#[test]
fn every_code_is_reached_and_its_report_is_as_it_was_read() {
    let (bless, mut reached) = (std::env::var_os("MOZZI_BLESS").is_some(), BTreeSet::new());
    let mut differing = Vec::new();
    for broken in broken() {
        let (found, codes) = report(&broken);
        let code = format!("mozzi::urdf::{}", broken.code());
        // a value that stands as text is stray, too
        let others = codes.iter().filter(|found| **found != code && *found != "mozzi::urdf::stray_text").count();
        if others > 0 || !codes.contains(&code) {
            differing.push(format!("{}: expected {code} alone\n{found}", broken.name));
        }
        reached.insert(broken.code().to_string());
        let file = folder().join(format!("{}.txt", broken.name));
        if bless {
            std::fs::write(&file, &found).expect("a writable folder");
        }
        let expected = std::fs::read_to_string(&file).unwrap_or_default();
        if found != expected.replace("\r\n", "\n") {
            differing.push(format!("{}\nfound\n{found}\nexpected\n{expected}", broken.name));
        }
    }
    assert!(differing.is_empty(), "{}", differing.join("\n\n"));
    let known: BTreeSet<String> = codes().map(str::to_string).collect();
    assert_eq!(reached, known, "codes that tests/broken reaches, and those that there are");
    assert!(known.iter().all(|code| explain(code).is_some()));
}
