//! Files are written completely or not at all; other commands can read the files of a motion.

use crate::common;

use common::{assert_close, file, folder, json, mozzi, rows, text};
use std::path::Path;
use std::process::Command;

fn formats() -> impl Iterator<Item = &'static str> {
    ["csv", "npy", "npz", "arrow", "feather"].into_iter().chain(cfg!(feature = "parquet").then_some("parquet"))
}

#[test]
fn every_format_of_a_motion_is_read_by_every_command() {
    let folder = folder("every_format");
    let controller = file(&folder, "pd.json", r#"{"controller": "computed-torque", "p": 100, "d": 20}"#);
    for robot in [&["double_pendulum"][..], &["anymal", "--floating"]] {
        let mut seen: Vec<(Vec<Vec<f64>>, String)> = Vec::new();
        for format in formats() {
            let path = folder.join(format!("motion.{format}"));
            let motion = path.to_str().expect("text");
            let simulate = [&["simulate"][..], robot, &["--time", "0.1", "--step", "0.01", "--out", motion]].concat();
            text(&simulate);
            let with = |before: &[&str], after: &[&str]| text(&[before, robot, after].concat());
            let found = json(&[&["compute"][..], robot, &["inverse-dynamics", "--in", motion]].concat());
            let figure = folder.join("energy.svg");
            let figure = figure.to_str().expect("text");
            with(&["plot", "energy"], &[motion, "--out", figure]);
            let page = folder.join("page.html");
            with(&["view"], &[motion, "--out", page.to_str().expect("text")]);
            let page = std::fs::read_to_string(&page).expect("written");
            assert!(page.contains(&format!("motion.{format}")), "{format}");
            if robot.len() == 1 {
                with(&["simulate"], &["--follow", motion, "--controller", &controller]);
                with(&["simulate"], &["--torque", motion, "--time", "0.1"]);
                with(&["trajectory"], &["--via", motion]);
            }
            seen.push((rows(&found["tau"]), std::fs::read_to_string(figure).expect("written")));
        }
        for (tau, figure) in &seen[1..] {
            assert_eq!((tau, figure), (&seen[0].0, &seen[0].1));
        }
        assert_close(&seen[0].0[5], &vec![0.0; seen[0].0[5].len()], 1e-8);
    }
}

#[test]
fn a_plain_array_is_not_guessed_at() {
    let folder = folder("plain_array");
    let out = folder.join("g.npy");
    let out = out.to_str().expect("text");
    let states = file(&folder, "s.csv", "t,theta_1,theta_2\n0,1,2\n1,2,3\n");
    text(&["compute", "two_link_planar", "gravity-forces", "--in", &states, "--out", out]);
    let (code, said) = common::complaint(&["plot", "energy", "two_link_planar", out, "--out", "no.svg"]);
    assert!(code == 1 && said.contains("is a plain array (2, 2), expected named columns"), "{said}");
}

#[test]
fn a_motion_of_no_time_has_one_row() {
    let folder = folder("no_time");
    for method in ["euler", "rk4", "dopri", "midpoint"] {
        for format in ["csv", "npz"] {
            let out = folder.join(format!("{method}.{format}"));
            let out = out.to_str().expect("text");
            text(&["simulate", "double_pendulum", "--theta", "1,2", "--time", "0", "--method", method, "--out", out]);
            let found = json(&["compute", "double_pendulum", "gravity-forces", "--in", out]);
            assert_eq!(rows(&found["theta"]), [[1.0, 2.0]], "{method} {format}");
        }
    }
}

/// Runs the program with a file size limit of 8 blocks of 512 or 1024 bytes, as if the disk were full.
#[cfg(target_os = "linux")]
fn on_a_full_disk(arguments: &[&str]) -> (Option<i32>, String) {
    let script = "trap '' XFSZ; ulimit -f 8; exec \"$0\" \"$@\"";
    let mut command = Command::new("sh");
    let output = command.args(["-c", script, env!("CARGO_BIN_EXE_mozzi")]).args(arguments).output();
    let output = output.expect("the program runs");
    (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_leaves_the_old_file() {
    let folder = folder("full_disk");
    let states = file(&folder, "states.csv", &format!("theta_1,theta_2\n{}", "0.5,0.25\n".repeat(2000)));
    let formats: Vec<&str> = formats().chain(cfg!(feature = "mcap").then_some("mcap")).collect();
    for format in &formats {
        let out = file(&folder, &format!("old.{format}"), "old");
        let simulate = ["simulate", "double_pendulum", "--time", "2", "--out", &out];
        let compute = ["compute", "two_link_planar", "mass-matrix", "--in", &states, "--out", &out];
        let is_of_results = !["parquet", "mcap"].contains(format);
        for arguments in [Some(&simulate[..]), is_of_results.then_some(&compute[..])].into_iter().flatten() {
            let (code, said) = on_a_full_disk(arguments);
            assert!(code == Some(1) && said.contains(&format!("{out} cannot be written: ")), "{arguments:?}: {said}");
            assert_eq!(std::fs::read_to_string(&out).expect("there"), "old", "{arguments:?}");
        }
        text(&simulate);
        assert_ne!(std::fs::read(&out).expect("there"), b"old");
    }
    let out = file(&folder, "old.html", "old");
    let (code, said) = on_a_full_disk(&["view", "ur5", "--out", &out]);
    assert!(code == Some(1) && said.contains(&format!("{out} cannot be written: ")), "{said}");
    assert_eq!(std::fs::read_to_string(&out).expect("there"), "old");
    let left: Vec<String> = std::fs::read_dir(&folder)
        .expect("a folder")
        .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
        .filter(|name| !name.starts_with("old.") && name != "states.csv")
        .collect();
    assert!(left.is_empty(), "{left:?}");
}

#[test]
#[cfg(unix)]
fn links_permissions_and_devices_stay() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let folder = folder("links");
    let real = file(&folder, "real.csv", "old");
    std::fs::set_permissions(&real, std::fs::Permissions::from_mode(0o640)).expect("set");
    let link = folder.join("link.csv");
    symlink("real.csv", &link).expect("a link");
    let simulate =
        |out: &Path| mozzi(&["simulate", "double_pendulum", "--time", "0.01", "--out", out.to_str().expect("text")]);
    assert!(simulate(&link).status.success());
    assert!(link.is_symlink() && std::fs::read_to_string(&real).expect("there").starts_with("t,theta_1"));
    assert_eq!(std::fs::metadata(&real).expect("there").permissions().mode() & 0o777, 0o640);
    let dangling = folder.join("dangling.csv");
    symlink("later.csv", &dangling).expect("a link");
    assert!(simulate(&dangling).status.success() && folder.join("later.csv").is_file() && dangling.is_symlink());
    let pipe = folder.join("device.csv");
    symlink("/dev/null", &pipe).expect("a link");
    assert!(simulate(&pipe).status.success() && pipe.is_symlink());
    let said = simulate(&folder.join("nowhere/motion.csv"));
    assert!(
        said.status.code() == Some(1)
            && String::from_utf8_lossy(&said.stderr).contains("nowhere/motion.csv cannot be written")
    );
}

#[test]
fn a_large_page_announces_its_size() {
    let folder = folder("large_page");
    let mut table = String::from("t,theta_1,theta_2,dtheta_1,dtheta_2,ddtheta_1,ddtheta_2,tau_1,tau_2\n");
    for row in 0..400_000 {
        let x = (f64::from(row) * 0.1).sin();
        table.push_str(&format!("{row},{x},{x},{x},{x},{x},{x},{x},{x}\n"));
    }
    let motion = file(&folder, "long.csv", &table);
    let page = folder.join("long.html");
    let view = ["view", "double_pendulum", &motion, "--out", page.to_str().expect("text")];
    let said = |flags: &[&str]| String::from_utf8(mozzi(&[&view[..], flags].concat()).stderr).expect("text");
    let announced = said(&["--page-rows", "all"]);
    let size = std::fs::metadata(&page).expect("written").len();
    assert!(size > 20_000_000, "{size}");
    let expected = format!("note: page: 400000 of 400000 rows, {:.1} MB: ", size as f64 / 1e6);
    assert!(announced.contains(&expected) && announced.contains("--page-rows"), "{announced}");
    assert!(!said(&[]).contains("note: page"));
}
