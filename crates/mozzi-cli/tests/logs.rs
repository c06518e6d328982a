//! A motion in files of each format, read back by the formats' own libraries in Python.

use crate::common;

use common::{assert_close, complaint, folder, json, numbers, rows, text};
use mozzi::Model;
use serde_json::Value;
use std::path::PathBuf;
use std::process::Command;

const FALL: [&str; 9] = ["simulate", "anymal", "--floating", "--time", "0.05", "--step", "0.01", "--dtheta", RATES];
const RATES: &str = "0.1,0.2,0.3,0,0,1,1,-1,0.5,0.3,0.2,0.1,0,0,0,0,0,0.4";

/// Python with these modules, or the reason why there is none.
fn python(modules: &str) -> Result<PathBuf, String> {
    let python = PathBuf::from(std::env::var_os("MOZZI_PYTHON").ok_or("MOZZI_PYTHON is not set")?);
    let probe = Command::new(&python).args(["-c", &format!("import {modules}")]).output();
    match probe.is_ok_and(|output| output.status.success()) {
        true => Ok(python),
        false => Err(format!("{} has not all of {modules}", python.display())),
    }
}

#[test]
fn every_format_holds_the_motion() {
    let python = match python("numpy, pyarrow, mcap, mcap_ros2") {
        Ok(python) => python,
        Err(why) => return println!("skipped: {why}"),
    };
    let folder = folder("logs");
    let mut formats = vec!["npy", "npz", "arrow"];
    formats.extend(cfg!(feature = "parquet").then_some("parquet"));
    formats.extend(cfg!(feature = "mcap").then_some("mcap"));
    for format in &formats {
        let file = folder.join(format!("motion.{format}"));
        text(&[&FALL[..], &["--out", file.to_str().expect("text")]].concat());
    }
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/logs/read.py");
    let output = Command::new(python).arg(script).arg(&folder).output().expect("Python starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let found: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(found.as_object().map(serde_json::Map::len), Some(formats.len()));

    let motion = json(&FALL);
    let csv = text(&[&FALL[..], &["--out", "-"]].concat());
    let header: Vec<&str> = csv.lines().next().expect("a header").split(',').collect();
    let table: Vec<Vec<f64>> =
        csv.lines().skip(1).map(|line| line.split(',').map(|cell| cell.parse().expect("a number")).collect()).collect();
    for name in ["t", "kinetic_energy", "applied_work"] {
        assert_eq!(numbers(&found[".npz"][name]), numbers(&motion[name]), "{name}");
    }
    for name in ["theta", "dtheta", "ddtheta", "tau"] {
        assert_eq!(rows(&found[".npz"][name]), rows(&motion[name]), "{name}");
    }
    for format in [".npy", ".arrow", ".parquet"].into_iter().filter(|format| found.get(format).is_some()) {
        for (c, name) in header.iter().enumerate() {
            let column: Vec<f64> = table.iter().map(|row| row[c]).collect();
            assert_eq!(numbers(&found[format][name]), column, "{format} {name}");
        }
    }
    if let Some(messages) = found.get(".mcap") {
        assert_messages(messages, &motion);
    }
}

/// Joint states by name, and every link's pose in {s} as mozzi computes it.
fn assert_messages(messages: &Value, motion: &Value) {
    let model: Model = mozzi_urdf::open("anymal").expect("embedded").description.floating().build().expect("sound");
    let states = messages["joints"].as_array().expect("messages");
    assert_eq!(states.len(), 6);
    for (k, state) in states.iter().enumerate() {
        let t = motion["t"][k].as_f64().expect("a time");
        assert_eq!(state[0].as_u64(), Some((t * 1e9).round() as u64));
        assert!((state[1].as_f64().expect("a stamp") - t).abs() < 1e-9);
        let names: Vec<&str> = state[2].as_array().expect("names").iter().filter_map(Value::as_str).collect();
        assert_eq!(names, model.joint_names().collect::<Vec<_>>());
        assert_eq!(numbers(&state[3]), numbers(&motion["theta"][k])[7..]);
        assert_eq!(numbers(&state[4]), numbers(&motion["dtheta"][k])[6..]);
        assert_eq!(numbers(&state[5]), numbers(&motion["tau"][k])[6..]);
        let theta = numbers(&motion["theta"][k]);
        for (frame, name) in model.frames() {
            let found = messages["frames"][k][name].as_array().expect("a transform");
            assert_eq!(found[0], "world");
            let expected = model.forward_kinematics(&theta, frame).expect("a pose").to_pose();
            assert_close(&numbers(&found[1..].iter().cloned().collect()), &expected, 1e-12);
        }
    }
    assert_eq!(numbers(&messages["kinetic_energy"]), numbers(&motion["kinetic_energy"]));
}

#[test]
fn formats_that_are_not_known_or_not_built_in_are_named_before_the_motion_runs() {
    let said = |file: &str| complaint(&["simulate", "ur5", "--time", "1e5", "--out", file]);
    let (code, message) = said("motion.txt");
    assert_eq!(code, 1);
    assert!(message.contains("motion.txt: expected a name that ends in .csv, .npy, .npz, .arrow"), "{message}");
    for (format, is_built) in [("parquet", cfg!(feature = "parquet")), ("mcap", cfg!(feature = "mcap"))] {
        if !is_built {
            let (code, message) = said(&format!("motion.{format}"));
            assert_eq!(code, 1);
            assert!(message.contains(&format!("--features {format}")), "{message}");
        }
    }
}

/// The program's peak memory, kB, as Linux reports it while it runs.
#[cfg(target_os = "linux")]
fn peak(arguments: &[&str]) -> u64 {
    let mut program = Command::new(env!("CARGO_BIN_EXE_mozzi"))
        .args(arguments)
        .stdout(std::process::Stdio::null())
        .spawn()
        .expect("the program runs");
    let status = format!("/proc/{}/status", program.id());
    let mut most = 0;
    loop {
        let text = std::fs::read_to_string(&status).unwrap_or_default();
        let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let found = line.and_then(|line| line.trim().trim_end_matches("kB").trim().parse().ok());
        most = most.max(found.unwrap_or(0));
        if let Some(ended) = program.try_wait().expect("it can be waited for") {
            assert!(ended.success(), "{ended}");
            return most;
        }
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
}

#[test]
#[cfg(target_os = "linux")]
fn memory_does_not_grow_with_the_rows() {
    let folder = folder("logs_memory");
    for format in ["csv", "npy", "npz", "arrow"] {
        let file = folder.join(format!("long.{format}")).to_string_lossy().into_owned();
        let of = |time: &str| {
            peak(&[
                "simulate",
                "double_pendulum",
                "--theta",
                "1,0.5",
                "--method",
                "euler",
                "--step",
                "1e-5",
                "--time",
                time,
                "--out",
                &file,
            ])
        };
        // 50,000 and 300,000 rows of 14 numbers: 6 and 34 MB
        let (few, many) = (of("0.5"), of("3"));
        println!("{format}: {few} kB, {many} kB");
        assert!(many < few + 8_000, "{format}: {few} kB of 50,000 rows, {many} kB of 300,000");
        assert!(std::fs::metadata(&file).expect("written").len() > 30_000_000);
    }
}

#[test]
fn rows_are_those_of_the_motion_whoever_ends_it() {
    let folder = folder("logs_until");
    let motion = ["simulate", "double_pendulum", "--theta", "1,0.5", "--step", "0.01", "--until", "joint1 < 0.2"];
    let csv = text(&[&motion[..], &["--out", "-"]].concat());
    let table: Vec<Vec<f64>> =
        csv.lines().skip(1).map(|line| line.split(',').map(|cell| cell.parse().expect("a number")).collect()).collect();
    assert!(table.len() < 100, "{} rows", table.len());
    let file = folder.join("ended.npy").to_string_lossy().into_owned();
    text(&[&motion[..], &["--out", &file]].concat());
    let bytes = std::fs::read(&file).expect("written");
    let header = String::from_utf8_lossy(&bytes[10..bytes.len() - 8 * table.len() * table[0].len()]).into_owned();
    assert!(header.contains(&format!("'shape': ({},)", table.len())), "{header}");
    assert!(header.starts_with("{'descr': [('t', '<f8'), ('theta_1', '<f8'), "), "{header}");
    let numbers = bytes[10 + header.len()..].chunks_exact(8).map(|x| f64::from_le_bytes(x.try_into().expect("eight")));
    assert!(numbers.eq(table.concat()));
    // a failed run leaves no file
    let file = folder.join("failed.csv").to_string_lossy().into_owned();
    let failing = ["simulate", "double_pendulum", "--method", "dopri", "--tolerance", "0", "--out", &file];
    assert_eq!(complaint(&failing).0, 1);
    let failing = ["simulate", "double_pendulum", "--dtheta", "1e149,1e149", "--out", &file];
    assert!(complaint(&failing).1.contains("diverged") && !std::path::Path::new(&file).exists());
}

#[test]
fn a_page_holds_as_many_rows_as_it_is_told() {
    let folder = folder("logs_page");
    let page = folder.join("fall.html").to_string_lossy().into_owned();
    let fall = ["simulate", "double_pendulum", "--time", "1", "--report", &page];
    let said = |flags: &[&str]| text(&[&fall[..], flags].concat());
    assert!(said(&[]).contains("page: 1001 of 1001 rows, "));
    assert!(said(&["--page-rows", "150"]).contains("page: 101 of 1001 rows, "));
    assert!(said(&["--page-rows", "all", "--step", "4e-5"]).contains("page: 25001 of 25001 rows, "));
    assert!(said(&["--step", "4e-5"]).contains("page: 12501 of 25001 rows, "));
    assert!(complaint(&[&fall[..], &["--page-rows", "1"]].concat()).1.contains("at least 2, or all"));
}
