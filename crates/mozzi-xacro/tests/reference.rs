//! Every case of `cases/` gives the result of PyPI's xacro 2.1.1 (`cases/expected.txt`, written by compare.py),
//! including errors; deliberate differences are rejected by name; expansion bombs end at a bound; the PR2 equals its
//! published expansion.

use mozzi_xacro::{Arguments, Expansion, expand};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

const ROOT: [&str; 2] = ["<robot xmlns:xacro=\"http://www.ros.org/wiki/xacro\">", "</robot>"];

fn cases(name: &str) -> String {
    std::fs::read_to_string(Path::new("tests/cases").join(name)).expect("the cases")
}

/// A folder of its own.
fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("mozzi-xacro-{name}-{}", std::process::id()));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a folder");
    folder
}

fn expression(line: &str) -> String {
    let value = line.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;");
    format!("{}<a v=\"${{{value}}}\"/>{}", ROOT[0], ROOT[1])
}

/// A case: its name, arguments, and files.
struct Case {
    name: String,
    arguments: Arguments,
    files: Vec<(String, String)>,
}

fn all_cases() -> Vec<Case> {
    let mut all = Vec::new();
    for (number, line) in cases("expressions.txt").lines().enumerate() {
        if !line.trim().is_empty() && !line.starts_with('#') {
            let files = vec![("main.xacro".to_string(), expression(line))];
            all.push(Case {
                name: format!("expression {}: {line}", number + 1),
                arguments: Arguments::default(),
                files,
            });
        }
    }
    for block in format!("\n{}", cases("documents.txt")).split("\n=== ").skip(1) {
        let (header, body) = block.split_once('\n').unwrap_or((block, ""));
        let mut words = header.split(" | ");
        let name = words.next().unwrap_or_default().to_string();
        let given = words.flat_map(str::split_whitespace).filter_map(|word| word.split_once(":="));
        let values = given.map(|(name, value)| (name.to_string(), value.to_string())).collect();
        let mut files = vec![("main.xacro".to_string(), Vec::new())];
        for line in body.lines() {
            match line.strip_prefix("--- ") {
                Some(file) => files.push((file.to_string(), Vec::new())),
                None => files.last_mut().expect("the first").1.push(line),
            }
        }
        let whole = |text: &str| ["<?xml", "<robot", "<!--", "<mujoco"].iter().any(|start| text.starts_with(start));
        let wrapped = |(file, lines): (String, Vec<&str>)| {
            let text = lines.join("\n");
            let text =
                if file.ends_with(".yaml") || whole(&text) { text } else { format!("{}{text}{}", ROOT[0], ROOT[1]) };
            (file, text)
        };
        let files = files.into_iter().map(wrapped).collect();
        all.push(Case { name, arguments: Arguments { values, ..Arguments::default() }, files });
    }
    all
}

/// True if words are equal, or numbers differ by a tolerance at most, relative to numbers beyond 1.
fn are_equal(a: &str, b: &str, tolerance: f64) -> bool {
    let split = |text: &str| -> Vec<String> {
        text.split(|c: char| c.is_whitespace() || "\"<>(),[]{}=:/".contains(c)).map(str::to_string).collect()
    };
    let is_close = |(a, b): (&String, &String)| {
        a == b
            || matches!((a.parse::<f64>(), b.parse::<f64>()), (Ok(a), Ok(b)) if (a - b).abs() <= tolerance * a.abs().max(1.0))
    };
    let (a, b) = (split(a), split(b));
    a.len() == b.len() && a.iter().zip(&b).all(is_close)
}

#[test]
fn as_the_reference() {
    let expected = format!("\n{}", cases("expected.txt"));
    let mut expected = expected.split("\n=== ").skip(1).map(|block| block.split_once('\n').expect("a name and a text"));
    let home = folder("reference");
    let (mut wrong, mut count) = (Vec::new(), 0);
    for case in all_cases() {
        let (name, text) = expected.next().expect("as many texts as cases");
        assert_eq!(name, case.name, "run compare.py --write");
        let is_of_here = case.name == "file name" || case.name == "environment";
        if is_of_here || text.contains("FOLDER") {
            continue; // depends on the current folder or the environment
        }
        for (file, text) in &case.files {
            let path = home.join(file);
            std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
            std::fs::write(path, text).expect("a file");
        }
        match (expand(home.join("main.xacro"), &case.arguments), text.trim()) {
            (Err(_), "refused") => {}
            (Ok(expansion), text) if are_equal(expansion.text.trim(), text, 1e-12) => {}
            (Ok(expansion), text) => wrong.push(format!("{name}: {}, expected {text}", expansion.text)),
            (Err(error), text) => wrong.push(format!("{name}: {error}, expected {text}")),
        }
        for (file, _) in &case.files {
            std::fs::remove_file(home.join(file)).expect("removed");
        }
        count += 1;
    }
    std::fs::remove_dir_all(&home).expect("removed");
    assert!(wrong.is_empty(), "{} of {count}:\n{}", wrong.len(), wrong.join("\n"));
    assert!(count > 800, "{count}");
}

fn one(name: &str, text: &str) -> Result<Expansion, String> {
    mozzi_xacro::expand_text(name, text, &Arguments::default()).map_err(|error| error.to_string())
}

#[test]
fn what_is_not_supported_is_refused_by_name() {
    for line in cases("unsupported.txt").lines().filter(|line| !line.starts_with('#')) {
        let error = one("a.xacro", &expression(line)).expect_err(line);
        assert!(error.starts_with("a.xacro:1:"), "{line}: {error}");
        let says = ["not supported", "no function", "no text", "called with"].iter().any(|words| error.contains(words));
        assert!(says, "{line}: {error}");
    }
}

/// Found by fuzzing: a loop of 10¹⁸ rounds, none of which adds anything.
#[test]
fn an_empty_sequence_is_repeated_at_once() {
    for (empty, expected) in [("()", "()"), ("[]", "[]")] {
        let file = expression(&format!("{empty} * 10**18"));
        let found = mozzi_xacro::expand_text("empty.xacro", &file, &Arguments::default()).expect("an expansion");
        assert!(found.text.contains(expected), "{}", found.text);
    }
}

/// Found by fuzzing: more than the 65535 decimals that Rust's formatting takes. Lengths and ends are Python's.
#[test]
fn floats_have_any_number_of_decimals() {
    for (format, length, end) in [
        ("%.70000f", 70_002, "000000"),
        ("%.70000e", 70_006, "00e-01"),
        ("%#.70000g", 70_002, "000000"),
        ("%.70000g", 57, "015625"),
    ] {
        let file = expression(&format!("(len('{format}' % 0.1), ('{format}' % 0.1)[-6:])"));
        let found = one("a.xacro", &file).expect("an expansion").text;
        assert!(found.contains(&format!("({length}, '{end}')")), "{format}: {found}");
    }
}

#[test]
fn bombs_end_at_a_bound() {
    let double = |body: &str| format!("{}{body}{}", ROOT[0], ROOT[1]);
    let mut bombs: Vec<String> =
        cases("bombs.txt").lines().filter(|line| !line.starts_with('#')).map(expression).collect();
    let macros: String = (1..12)
        .map(|k| format!("<xacro:macro name=\"m{k}\">{}</xacro:macro>", format!("<xacro:m{}/>", k - 1).repeat(10)))
        .collect();
    bombs.push(double(&format!("<xacro:macro name=\"m0\"><a/></xacro:macro>{macros}<xacro:m11/>")));
    let properties: String = (1..12)
        .map(|k| format!("<xacro:property name=\"p{k}\" value=\"{}\"/>", format!("${{p{}}} ", k - 1).repeat(10)))
        .collect();
    bombs.push(double(&format!("<xacro:property name=\"p0\" value=\"lol\"/>{properties}<a b=\"${{p11}}\"/>")));
    bombs.push(double("<xacro:macro name=\"m\"><xacro:m/></xacro:macro><xacro:m/>"));
    bombs.push(double("<xacro:macro name=\"m\"><xacro:m/><xacro:m/></xacro:macro><xacro:m/>"));
    bombs.push(double(
        "<xacro:macro name=\"m\" params=\"n\"><xacro:if value=\"${n}\"><xacro:m n=\"${n-1}\"/><xacro:m n=\"${n-1}\"/></xacro:if>\
         </xacro:macro><xacro:m n=\"60\"/>",
    ));
    bombs.push(double(&("<a>".repeat(1000) + &"</a>".repeat(1000))));
    bombs.push(double("<xacro:property name=\"l\" value=\"${[]}\"/><a b=\"${l.append(l)}\" c=\"${l}\"/>"));
    let chain: String =
        (1..3000).map(|k| format!("<xacro:property name=\"p{k}\" value=\"${{p{}}}\"/>", k - 1)).collect();
    bombs.push(double(&format!("{chain}<a b=\"${{p2999}}\"/>")));
    bombs.push(double(
        "<xacro:macro name=\"w\" params=\"*b\"><a><xacro:insert_block name=\"b\"/><xacro:insert_block name=\"b\"/></a></xacro:macro>"
    ) .replace("</robot>", &("<xacro:w>".repeat(40) + "<b/>" + &"</xacro:w>".repeat(40) + "</robot>")));
    let mut slowest = (Duration::ZERO, String::new());
    for bomb in bombs {
        let start = Instant::now();
        let error = one("bomb.xacro", &bomb).expect_err(&bomb[..bomb.len().min(200)]);
        assert!(error.starts_with("bomb.xacro:"), "{error}");
        slowest = slowest.max((start.elapsed(), error));
    }
    println!("the slowest: {:?}, {}", slowest.0, slowest.1); // less than a second in the release profile
}

/// The same comparison with the tool itself, if a Python has it, and random expressions for some seconds.
#[test]
fn pypis_xacro_agrees() {
    let has = |python: &String| {
        let import = Command::new(python).args(["-c", "import xacro"]).output();
        import.is_ok_and(|output| output.status.success())
    };
    let Some(python) = std::env::var("MOZZI_PYTHON").ok().filter(has) else {
        println!("skipped: MOZZI_PYTHON names no Python with xacro (cargo xtask test makes one)");
        return;
    };
    // cargo builds examples next to the tests
    let program = std::env::current_exe().expect("this program").with_file_name("../examples/batch");
    let mut compare = Command::new(python);
    let output = compare.arg("tests/compare.py").arg(program).args(["--fuzz", "5"]).output().expect("runs");
    let said = [output.stdout, output.stderr].concat();
    let said = String::from_utf8_lossy(&said);
    println!("{said}");
    assert!(output.status.success(), "{said}");
}

#[test]
fn the_pr2_is_its_published_expansion() {
    let data = Path::new("../../../shared/data/xacro/pr2");
    let Ok(golden) = std::fs::read_to_string(data.join("pr2_1.11.4.xml")) else {
        println!("skipped: {} is not here", data.display());
        return;
    };
    let home = folder("pr2");
    std::fs::create_dir_all(home.join("test/robots")).expect("a folder");
    copy(data, &home.join("test/robots/pr2"));
    let arguments = Arguments { packages: vec![("xacro".to_string(), home.clone())], ..Arguments::default() };
    let expansion = expand(home.join("test/robots/pr2/pr2.urdf.xacro"), &arguments).expect("expanded");
    std::fs::remove_dir_all(&home).expect("removed");
    let (found, expected) = (tree(&expansion.text), tree(&golden));
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(&expected) {
        // the published one has 12 digits
        assert!(are_equal(found, expected, 1e-11), "{found}, expected {expected}");
    }
    println!("{} pieces of the PR2, {} steps", found.len(), expansion.work);
}

fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).expect("a folder");
    for entry in std::fs::read_dir(from).expect("a folder").flatten() {
        let target = to.join(entry.file_name());
        if entry.path().is_dir() {
            copy(&entry.path(), &target)
        } else {
            _ = std::fs::copy(entry.path(), target).expect("a copy");
        }
    }
}

/// Names, sorted attributes and texts, in order.
fn tree(text: &str) -> Vec<String> {
    let document = roxmltree::Document::parse(text).expect("XML");
    let mut pieces = Vec::new();
    for node in document.descendants() {
        if node.is_element() {
            let mut attributes: Vec<String> = node
                .attributes()
                .map(|a| format!("{} {}", a.name(), a.value().split_whitespace().collect::<Vec<_>>().join(" ")))
                .collect();
            attributes.sort();
            pieces.push(format!("{} {}", node.tag_name().name(), attributes.join(" ")));
        } else if node.is_text() && !node.text().unwrap_or_default().trim().is_empty() {
            pieces.push(node.text().unwrap_or_default().split_whitespace().collect::<Vec<_>>().join(" "));
        }
    }
    pieces
}
