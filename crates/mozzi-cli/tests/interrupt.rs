//! Ctrl-C and SIGTERM in long computations, and progress on a terminal only. If the program is too fast to be
//! interrupted, a test says so.
#![cfg(unix)]

use crate::common;

use common::folder;
use std::io::Write;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::Duration;

/// The time of the interrupt: after the first second, since progress is shown from then on.
const WAIT: Duration = Duration::from_millis(1700);
/// θ̈ by thirteen times τ, by the kernel of one state: 10 s.
const STATES: usize = 100_000;

/// θ, θ̇ and τ of a robot with twelve joints, `count` states.
fn states(folder: &Path, count: usize) -> String {
    let header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({count}, 36), }}\n");
    let mut bytes = [b"\x93NUMPY\x01\x00", &(header.len() as u16).to_le_bytes()[..], header.as_bytes()].concat();
    (0..count * 36).for_each(|k| bytes.extend((k as f64 * 0.7).sin().to_le_bytes()));
    let path = folder.join("states.npy");
    std::fs::write(&path, bytes).expect("a file");
    path.to_string_lossy().into_owned()
}

fn batch<'a>(input: &'a str, output: &'a str) -> Vec<&'a str> {
    let quantity = ["compute", "anymal", "forward-dynamics-by-inverse-dynamics"];
    [&quantity[..], &["--in", input, "--out", output, "--threads", "1", "--kernels-only"]].concat()
}

/// The output after a signal; nothing if the program had already ended. A program that has not yet begun to listen is
/// ended by the signal itself, without a word: then once more, with more time before the signal.
fn interrupted(arguments: &[&str]) -> Option<Output> {
    stopped_by("-INT", arguments)
}

fn stopped_by(signal: &str, arguments: &[&str]) -> Option<Output> {
    let mut wait = WAIT;
    let output = loop {
        let output = after_a_signal(signal, arguments, wait);
        if output.status.signal().is_none() || wait > 8 * WAIT {
            break output;
        }
        wait *= 2;
    };
    if output.status.success() {
        println!("skipped: done before it was interrupted: {arguments:?}");
        return None;
    }
    let said = String::from_utf8_lossy(&output.stderr);
    let quiet = !said.contains('\u{1b}'); // no bar: no terminal
    assert!(output.status.code() == Some(130) && quiet, "{:?}: {said}", output.status);
    Some(output)
}

fn after_a_signal(signal: &str, arguments: &[&str], wait: Duration) -> Output {
    let program = Command::new(env!("CARGO_BIN_EXE_mozzi"))
        .args(arguments)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program runs");
    std::thread::sleep(wait);
    let id = program.id().to_string();
    assert!(Command::new("kill").args([signal, &id]).status().expect("kill runs").success());
    program.wait_with_output().expect("it ends")
}

/// The number before " of 100000 states" and the like.
fn count(said: &str, after: &str) -> usize {
    let (before, _) = said.split_once(after).unwrap_or_else(|| panic!("{after}: {said}"));
    before.rsplit(' ').next().and_then(|word| word.parse().ok()).unwrap_or_else(|| panic!("{said}"))
}

#[test]
fn a_batch_leaves_the_states_so_far() {
    let folder = folder("interrupt_batch");
    let input = states(&folder, STATES);
    for (name, signal) in [("a.csv", "-INT"), ("a.npz", "-TERM")] {
        let out = folder.join(name).to_string_lossy().into_owned();
        let Some(output) = stopped_by(signal, &batch(&input, &out)) else { continue };
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        let done = count(&said, &format!(" of {STATES} states"));
        assert!(done > 0 && said.contains("note: stopped by Ctrl-C: these are the first"), "{said}");
        if name == "a.csv" {
            let rows = std::fs::read_to_string(&out).expect("written");
            assert_eq!(rows.lines().count(), done + 1);
            assert!(rows.lines().all(|row| row.split(',').count() == 36 + 12));
        } else {
            let mut archive =
                zip::ZipArchive::new(std::fs::File::open(&out).expect("written")).expect("a whole archive");
            let bytes = archive.by_name("ddtheta.npy").expect("the accelerations").size() as usize;
            assert!((done * 12 * 8..done * 12 * 8 + 200).contains(&bytes), "{bytes} bytes of {done} states");
        }
    }
}

#[test]
fn a_simulation_leaves_the_motion_so_far() {
    let out = folder("interrupt_motion").join("motion.csv").to_string_lossy().into_owned();
    let motion = ["simulate", "ur5", "--time", "100000", "--record-every", "10", "--out", &out];
    let output = interrupted(&motion).expect("hours");
    assert!(String::from_utf8_lossy(&output.stderr).contains("stopped by Ctrl-C at t = "));
    let rows = std::fs::read_to_string(&out).expect("written");
    assert!(rows.starts_with("t,theta_1") && rows.lines().count() > 2);
    let width = |row: &str| row.split(',').count();
    assert!(rows.lines().all(|row| width(row) == width(rows.lines().next().expect("a header"))));
    assert!(String::from_utf8_lossy(&output.stdout).contains("ur5 for "));
}

#[test]
fn a_benchmark_leaves_the_quantities_so_far() {
    let quantities = ["--quantity", "inverse-dynamics", "--quantity", "coriolis-matrix"];
    let size = ["--states", "300", "--threads", "1", "--rounds", "200"];
    let Some(output) = interrupted(&[&["bench", "ur5", "--json"], &quantities[..], &size].concat()) else { return };
    let found: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(found["complete"] == false && said.contains("stopped by Ctrl-C: these are "), "{said}");
    let timed = found["timings"].as_array().expect("a list").iter().filter(|timing| timing["one_state"] == true);
    assert_eq!(timed.count(), count(&said, " of 2 quantities"));
}

/// What a command shows on a terminal of its own until Ctrl-C is typed there; none, said, where that cannot be tried.
fn typed_on_a_terminal(command: &str, wait: Duration) -> Option<String> {
    // util-linux's `script`: runs a command on a terminal of its own, and types its standard input there
    let script = Command::new("script")
        .args(["--quiet", "--return", "--flush", "--command", command, "/dev/null"])
        .env("TERM", "xterm")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn();
    let Ok(mut script) = script else {
        println!("skipped: there is no `script` here, which makes a terminal");
        return None;
    };
    std::thread::sleep(wait);
    let mut keys = script.stdin.take().expect("piped");
    let typed = keys.write_all(b"\x03"); // Ctrl-C
    let output = script.wait_with_output().expect("it ends");
    drop(keys);
    let shown = String::from_utf8_lossy(&output.stdout).into_owned();
    if typed.is_err() || !matches!(output.status.code(), Some(130)) {
        println!("skipped: another `script`, or done before it was interrupted: {shown:.300}");
        return None;
    }
    Some(shown)
}

#[test]
fn progress_is_shown_on_a_terminal() {
    let folder = folder("interrupt_terminal");
    let (input, out) = (states(&folder, STATES), folder.join("a.npy").to_string_lossy().into_owned());
    let command: Vec<String> = std::iter::once(env!("CARGO_BIN_EXE_mozzi"))
        .chain(batch(&input, &out))
        .map(|word| format!("'{word}'"))
        .collect();
    // a busy machine may not have drawn a bar yet: then once more, with more time before the key
    let mut wait = WAIT + WAIT;
    let (shown, bar) = loop {
        let Some(shown) = typed_on_a_terminal(&command.join(" "), wait) else { return };
        let bar = shown.split('\u{1b}').find(|part| part.contains("/100,000 states, ")).map(str::to_string);
        match bar {
            Some(bar) => break (shown, bar),
            None => assert!(wait <= 16 * WAIT, "{shown}"),
        }
        wait *= 2;
    };
    assert!(bar.contains("forward-dynamics-by") && bar.contains("/s, ") && bar.contains(" left"), "{bar}");
    assert!(shown.contains("stopped by Ctrl-C: these are the first"), "{shown}");
}
