//! Figures: of a table's motion, of methods, of a robot.

use crate::common;

use common::{complaint, file, folder, text};

#[test]
fn every_kind_of_figure_is_written() {
    let folder = folder("plot");
    let path = |name: &str| folder.join(name).to_string_lossy().into_owned();
    let (table, figure) = (path("swing.csv"), path("figure.svg"));
    text(&["simulate", "double_pendulum", "--theta", "1.5,0", "--time", "0.2", "--out", &table]);
    let drawn = |arguments: &[&str]| {
        let said = text(&[&["plot"], arguments, &["--out", &figure]].concat());
        assert!(said.starts_with(&format!("wrote a figure to {figure}\n")), "{said}");
        (said, std::fs::read_to_string(&figure).expect("a figure"))
    };
    for (kind, word) in [("trajectory", "θ̈ [rad/s²]"), ("energy", "potential"), ("phase", "joint2 [rad]")] {
        let (_, svg) = drawn(&[kind, "double_pendulum", &table, "--title", "A <swing>"]);
        assert!(svg.contains(word) && svg.contains("A &lt;swing&gt;"), "{kind}: {svg:.400}");
    }
    let slower = path("slower.csv");
    text(&["simulate", "double_pendulum", "--theta", "1.0,0", "--time", "0.2", "--out", &slower]);
    let (_, svg) = drawn(&["energy", "double_pendulum", &table, "--with", &slower]);
    assert!(svg.contains("kinetic, slower.csv") && svg.contains("stroke-dasharray=\"5 3\""), "two runs: {svg:.800}");
    let (_, svg) = drawn(&["phase", "double_pendulum", &table]);
    assert!(svg.contains(">start</text>"), "the start is marked");
    let (said, svg) = drawn(&[
        "convergence",
        "double_pendulum",
        "--theta",
        "1,0.3",
        "--time",
        "0.3",
        "--step",
        "0.01",
        "--halvings",
        "3",
    ]);
    assert!(
        said.contains("Euler: order 1, measured 1.0") && said.contains("Dormand-Prince 5(4): order 5, measured "),
        "{said}"
    );
    assert!(svg.contains("step h [s]") && svg.contains("evaluations of θ̈"), "{svg:.400}");
    let (_, svg) =
        drawn(&["ellipsoids", "ur5", "--theta", "0,-1.2,1.5,0.3,1.1,0", "--theta=0,-2,1,0,1,0", "--plane", "xz"]);
    let found = common::json(&["plot", "ellipsoids", "ur5", "--floating", "--out", &figure]);
    assert_eq!(found["out"], *figure);
    let arguments =
        ["plot", "convergence", "furuta_pendulum", "--theta", "0.3,0.5", "--time", "0.5", "--halvings", "2"];
    let methods = common::json(&[&arguments[..], &["--out", &figure]].concat())["methods"].clone();
    let order = methods[4]["measured_order"].as_f64().expect("Dormand-Prince's");
    assert!((order - 5.0).abs() < 0.5, "{methods}");
    assert!(svg.contains("velocities at") && svg.contains("forces at"));
}

#[test]
fn what_cannot_be_drawn_is_said() {
    let folder = folder("plot_wrong");
    let still = file(&folder, "still.csv", "t,theta_1,theta_2\n0,0,0\n1,0,0\n");
    let (code, said) = complaint(&["plot", "phase", "double_pendulum", &still, "--out", "x.svg"]);
    assert_eq!(code, 1);
    assert!(said.contains("still.csv: the motion's dtheta has 0 numbers, expected 4: 2 rows of 2"), "{said}");
    let (code, said) = complaint(&["plot", "energy", "double_pendulum", &still, "--out", "x.pdf"]);
    assert!(code == 1 && said.contains("--out is x.pdf, expected a file that ends in .svg or .png"), "{said}");
    let png = folder.join("figure.png");
    let arguments = ["plot", "energy", "double_pendulum", &still, "--out", png.to_str().expect("text")];
    if cfg!(feature = "png") {
        let output = common::mozzi(&arguments);
        match output.status.success() {
            true => assert!(std::fs::read(png).expect("a picture").starts_with(b"\x89PNG\r\n")),
            false => assert!(String::from_utf8_lossy(&output.stderr).contains("this machine has no fonts")),
        }
    } else {
        let (code, said) = complaint(&arguments);
        assert!(code == 1 && said.contains("--features png"), "{said}");
    }
}
