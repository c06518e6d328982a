//! What packages of the program bring along: completions, manual pages, the version.

use crate::common;

use common::{complaint, folder, text};
use std::process::Command;

/// The commands that `mozzi --help` lists.
fn commands() -> Vec<String> {
    let help = text(&["--help"]);
    let list = help.split("Commands:").nth(1).and_then(|rest| rest.split("Options:").next()).expect("a list");
    let names: Vec<String> = list
        .lines()
        .filter_map(|line| line.strip_prefix("  "))
        .filter(|line| line.starts_with(char::is_alphabetic))
        .filter_map(|line| line.split_whitespace().next().map(str::to_owned))
        .collect();
    assert!(names.len() > 20 && names.contains(&"compute".to_string()), "{names:?}");
    names
}

#[test]
fn completions_know_every_command() {
    let names = commands();
    for shell in ["bash", "zsh", "fish", "powershell"] {
        let script = text(&["completions", shell]);
        for name in &names {
            assert!(script.contains(name), "{shell}: {name}");
        }
        assert!(script.contains("--theta"), "{shell}");
        // the shell itself reads it
        if ["bash", "zsh", "fish"].contains(&shell) {
            let file = common::file(&folder(&format!("completions-{shell}")), "script", &script);
            match Command::new(shell).args(["-n", &file]).status() {
                Ok(status) => assert!(status.success(), "{shell}"),
                Err(_) => println!("skipped: no {shell} on this machine"),
            }
        }
    }
    assert!(complaint(&["completions", "tcsh"]).1.contains("possible values"), "shells that there are");
}

#[test]
fn every_command_has_a_manual_page() {
    let folder = folder("manual");
    text(&["man", "--out", &folder.display().to_string()]);
    let read = |name: &str| std::fs::read_to_string(folder.join(name)).expect("a page");
    assert_eq!(read("mozzi.1"), text(&["man"]));
    for name in commands().iter().filter(|name| *name != "help") {
        let page = read(&format!("mozzi-{name}.1"));
        assert!(page.contains(&format!(".TH mozzi-{name} 1")), "{page}");
        assert!(page.contains("SYNOPSIS") && page.contains("OPTIONS"), "{name}");
    }
    assert!(read("mozzi-simulate.1").contains("EXTRA"), "examples");
}

#[test]
fn the_version_says_what_the_build_can_do() {
    let long = text(&["--version"]);
    let lines: Vec<&str> = long.lines().collect();
    assert_eq!(lines[0], format!("mozzi {}", env!("CARGO_PKG_VERSION")));
    let heads: Vec<&str> = lines[1..].iter().map(|line| line.split(':').next().unwrap()).collect();
    assert_eq!(heads, ["commit", "features", "machine code", "for"]);
    let is_known =
        ["avx", "neon", "not on this machine"].iter().any(|set| lines[3].starts_with(&format!("machine code: {set}")));
    assert!(is_known, "{long}");
    assert_eq!(text(&["-V"]).trim(), lines[0]);
}
