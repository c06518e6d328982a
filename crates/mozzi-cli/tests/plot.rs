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
    text(&["simulate", "ur5", "--floating", "--time", "0.01", "--out", &slower]);
    let output = common::mozzi(&["plot", "trajectory", "ur5", &slower, "--floating", "--out", &figure]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && said.contains("the floating base is not drawn, only the joints"), "{said}");
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
    assert!(said.contains("still.csv: the motion has no dtheta, expected 4: 2 rows of 2"), "{said}");
    let (code, said) = complaint(&["plot", "energy", "double_pendulum", &still, "--out", "x.html"]);
    assert!(code == 1 && said.contains("--out is x.html, expected a file that ends in .svg, .png or .pdf"), "{said}");
}

#[test]
fn figures_are_png_and_pdf_if_built_so() {
    let folder = folder("plot_formats");
    let still = file(&folder, "still.csv", "t,theta_1,theta_2\n0,0,0\n1,0,0\n");
    let path = |name: &str| folder.join(name).to_string_lossy().into_owned();
    let (svg, png, pdf) = (path("figure.svg"), path("figure.png"), path("figure.pdf"));
    text(&["plot", "energy", "double_pendulum", &still, "--out", &svg]);
    for (out, format, is_built) in [(&png, "png", cfg!(feature = "png")), (&pdf, "pdf", cfg!(feature = "pdf"))] {
        let output = common::mozzi(&["plot", "energy", "double_pendulum", &still, "--out", out, "--title", "θ̇ (1)"]);
        let said = String::from_utf8_lossy(&output.stderr);
        match (output.status.success(), format) {
            (false, _) if !is_built => assert!(said.contains(&format!("--features {format}")), "{said}"),
            (false, _) => assert!(said.contains("this machine has no fonts"), "{said}"),
            (true, "png") => check_png(&std::fs::read(out).expect("a picture"), &svg),
            (true, _) => check_pdf(&std::fs::read(out).expect("a page")),
        }
    }
}

/// The size is twice that of the SVG.
fn check_png(png: &[u8], svg: &str) {
    assert!(png.starts_with(b"\x89PNG\r\n"));
    let size = [16, 20].map(|k| u32::from_be_bytes(png[k..k + 4].try_into().expect("four bytes")));
    let svg = std::fs::read_to_string(svg).expect("a figure");
    assert!(svg.contains(&format!("width=\"{}\" height=\"{}\"", size[0] / 2, size[1] / 2)), "{size:?}: {svg:.200}");
}

/// Each entry of the table of objects leads to its object, and the title is UTF-16.
pub fn check_pdf(pdf: &[u8]) {
    assert!(pdf.starts_with(b"%PDF-1.4\n") && pdf.ends_with(b"%%EOF\n"));
    let text = String::from_utf8_lossy(pdf);
    let table = text.rsplit("startxref\n").next().and_then(|rest| rest.lines().next()?.parse::<usize>().ok());
    let table = std::str::from_utf8(&pdf[table.expect("a place")..]).expect("text");
    let mut entries = table.lines().skip(3).take_while(|line| line.ends_with(" n "));
    assert_eq!(table.lines().nth(1), Some("0 6"));
    for k in 1..6 {
        let place: usize = entries.next().expect("an entry")[..10].parse().expect("a number");
        assert!(pdf[place..].starts_with(format!("{k} 0 obj\n").as_bytes()), "object {k}");
    }
    assert!(text.contains("/MediaBox [0 0 540 "), "720 px are 540 points");
    assert!(text.contains("/Title <FEFF03B8"), "θ");
}
