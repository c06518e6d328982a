//! Output to the terminal: no control characters, no floods.

use crate::common;

use common::{file, folder, mozzi};
use std::path::Path;
use std::process::{Command, Output};

/// Checks that the output contains nothing that controls a terminal.
fn assert_harmless(output: &Output, what: &str) -> String {
    let all = [&output.stdout[..], &output.stderr].concat();
    let text = String::from_utf8(all).expect("UTF-8");
    let odd = text.chars().find(|c| c.is_control() && !"\n\t".contains(*c));
    assert_eq!(odd, None, "{what}: {text:?}");
    assert!(!text.contains("panicked") && text.len() < 100_000, "{what}: {} bytes", text.len());
    text
}

/// A title, a clipboard, a colour, a bell, DEL, and C1's introducer.
const ODD: &str = "\u{1b}]0;t\u{7}\u{1b}]52;c;aGFja2Vk\u{7}\u{1b}[31m\u{7f}\u{9b}31m\u{85}";
/// Those of them that XML allows: DEL and C1.
const ODD_OF_XML: &str = "\u{7f}\u{9b}31m\u{85}\u{9d}52;c;x\u{9c}";

#[test]
fn names_texts_and_paths_are_escaped() {
    let folder = folder("odd");
    let robot = |name: &str, link: &str| {
        format!(
            "<robot name='{name}'><link name='{link}'/><link name='{link}2'/>\n<joint name='{name}' type='fixed'>\
             <parent link='{link}'/><child link='{link}2'/></joint></robot>"
        )
    };
    let sound = file(&folder, "sound.urdf", &robot(ODD_OF_XML, ODD_OF_XML));
    let broken = file(&folder, "broken.urdf", &robot("a", ODD));
    let misspelt =
        file(&folder, "misspelt.urdf", &robot("a", "b").replace("<joint ", &format!("<jiont a='{ODD_OF_XML}' ")));
    let odd_path = file(&folder, "odd\u{1b}[31m\u{9b}.urdf", "<robot name='a'>\n<link/></robot>");
    let json = file(&folder, "odd.json", &format!("{{\"robot\": \"{ODD}\"}}"));
    let table = file(&folder, "odd.csv", &format!("theta_1,{ODD}\n1,2\n"));
    let cell = file(&folder, "cell.csv", &format!("theta_1,theta_2\n1,{ODD}\n"));
    let nowhere = format!("nowhere{ODD}");
    for arguments in [
        &["info", &sound][..],
        &["info", &sound, "--json"],
        &["check", &sound],
        &["check", &sound, "--json"],
        &["convert", &sound, "/dev/stdout.py"],
        &["info", &broken],
        &["check", &broken, "--json"],
        &["info", &misspelt],
        &["info", &odd_path],
        &["check", &odd_path, "--json"],
        &["info", &json],
        &["info", &nowhere],
        &["info", "ur5", &nowhere],
        &[&nowhere],
        &["simulate", "ur5", "--theta", &nowhere],
        &["compute", "two_link_planar", "gravity-forces", "--in", &table],
        &["compute", "two_link_planar", "gravity-forces", "--in", &cell],
        &["compute", "two_link_planar", "gravity-forces", "--in", &nowhere],
    ] {
        let output = mozzi(arguments);
        let text = assert_harmless(&output, &format!("{arguments:?}"));
        if arguments.contains(&"--json") && !text.is_empty() {
            let first = text.lines().next().expect("a line");
            let object = if first == "{" { &text } else { first };
            assert!(serde_json::from_str::<serde_json::Value>(object).is_ok(), "{text}");
        }
    }
    let said = String::from_utf8(mozzi(&["info", &broken]).stderr).expect("text");
    assert!(said.contains("\\u001b]52;c;aGFja2Vk\\u0007") && said.contains("broken.urdf:1:"), "{said}");
}

#[test]
#[cfg(unix)]
fn what_python_says_is_escaped() {
    let python = common::script("odd_python", &format!("printf '%s' '{ODD}' >&2\nexit 1"));
    assert_harmless(&mozzi(&["compare", "ur5", "--python", &python]), "compare");
}

#[test]
#[cfg(target_os = "linux")]
fn a_terminal_with_colours_gets_those_alone() {
    let folder = folder("odd_terminal");
    let robot = file(&folder, "odd.urdf", &format!("<robot name='a'>\n<link nam='{ODD}'/></robot>"));
    let command = format!("'{}' info '{robot}'", env!("CARGO_BIN_EXE_mozzi"));
    let script = Command::new("script").args(["--quiet", "--return", "--command", &command, "/dev/null"]).output();
    let Ok(output) = script else { return println!("skipped: there is no `script` here, which makes a terminal") };
    let text = String::from_utf8_lossy(&output.stdout);
    if !text.contains("\u{1b}[") {
        return println!("skipped: no colours: {text}");
    }
    assert!(text.contains("\\u001b]52;c"), "{text:?}");
    for odd in ["\u{1b}]", "\u{7}", "\u{7f}", "\u{9b}"] {
        assert!(!text.contains(odd), "{odd:?} in {text:?}");
    }
}

#[test]
fn long_cells_and_numbers_are_short() {
    let folder = folder("long_cells");
    let in_table = |name: &str, text: &str| {
        let table = file(&folder, name, text);
        let output = mozzi(&["compute", "two_link_planar", "gravity-forces", "--in", &table]);
        assert_eq!(output.status.code(), Some(1));
        let said = assert_harmless(&output, name);
        assert!(said.len() < 6000 && said.contains(name), "{} bytes", said.len());
        said
    };
    let long = "x".repeat(2_000_000);
    let said = in_table("cell.csv", &format!("theta_1,theta_2\n1,{long}\n"));
    assert!(
        said.contains("cell.csv:2: column 2 (`theta_2`) is `xxxx") && said.contains("2000000 characters"),
        "{said}"
    );
    in_table("header.csv", &format!("theta_1,{long}\n1,2\n"));
    in_table("row.csv", &format!("theta_1,theta_2\n{}\n", "1,".repeat(1_000_000)));
    let said = String::from_utf8(mozzi(&["simulate", "ur5", "--time", "1e300"]).stderr).expect("text");
    assert!(said.contains("1e303") && !said.contains("0000000000"), "{said}");
    let table = file(&folder, "late.csv", "t,tau_1,tau_2\n1e-300,0,0\n1e300,0,0\n");
    let said = mozzi(&["simulate", "two_link_planar", "--torque", &table]);
    let said = String::from_utf8(said.stderr).expect("text");
    assert!(said.contains("covers t = 1e-300 s to 1e300 s"), "{said}");
    assert!(Path::new(&table).exists());
}
