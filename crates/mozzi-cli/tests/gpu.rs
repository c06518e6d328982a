//! `mozzi compute --gpu`: on a GPU the numbers of the cores, without one the reason.

use crate::common;

use common::{complaint, file, folder, mozzi, text};

const STATES: &str = "theta_1,theta_2,theta_3,theta_4,theta_5,theta_6\n0.1,-1.2,1.5,0.3,1.1,0\n0,0.5,-0.5,1,2,3\n";

#[test]
fn numbers_of_the_cores_or_no_cuda_device() {
    let states = file(&folder("gpu"), "states.csv", STATES);
    let arguments = ["compute", "ur5", "mass-matrix", "--in", &states];
    let output = mozzi(&[&arguments[..], &["--gpu"]].concat());
    let said = String::from_utf8(output.stderr).expect("text");
    if output.status.success() {
        let [found, expected] = [String::from_utf8(output.stdout).expect("text"), text(&arguments)].map(|csv| {
            let numbers = csv.lines().skip(1).flat_map(|line| line.split(',').map(|x| x.parse().expect("a number")));
            numbers.collect::<Vec<f64>>()
        });
        common::assert_close(&found, &expected, 1e-12);
        return;
    }
    assert_eq!(output.status.code(), Some(1));
    let is_named = said.starts_with("error: no CUDA device: ") || said.starts_with("error: NVRTC");
    assert!(output.stdout.is_empty() && is_named, "{said}");
}

#[test]
fn wrong_usage_is_told() {
    let states = file(&folder("gpu usage"), "states.csv", STATES);
    let arguments = |more: &[&'static str]| {
        let known = ["compute", "ur5", "mass-matrix", "--gpu"];
        complaint(&[&known[..], more].concat())
    };
    let (code, message) = arguments(&["--theta", "0,0,0,0,0,0"]);
    assert!(code == 2 && message.contains("--gpu has no effect without --in"), "{message}");
    let with_threads = ["compute", "ur5", "mass-matrix", "--gpu", "--in", &states, "--threads", "2"];
    let (code, message) = complaint(&with_threads);
    assert!(code == 2 && message.contains("--threads"), "{message}");
}
