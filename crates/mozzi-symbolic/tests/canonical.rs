//! Two ways to one robot print one text.

use crate::robots::{Moved, all, chain};
use crate::{embedded, model, of};
use mozzi::quantities::Query;
use mozzi_symbolic::{Language, Options, Rational, Symbols, derive, steps};

#[test]
fn fixed_joints_and_units_of_writing_do_not_matter() {
    let text = embedded("two_link_planar");
    // the tip joint's offset in two parts, 0.5 as 5e-1, an angle of 2π
    let other = text
        .replace("xyz=\"0.5 0 0\"", "xyz=\"5e-1 0.0 0\"")
        .replace("<mass value=\"2\"/>", "<mass value=\"2.000\"/>")
        .replace(
            "<origin xyz=\"0.4 0 0\"/>\n  </joint>",
            "<origin xyz=\"0.4 0 0\" rpy=\"0 0 6.283185307\"/>\n  </joint>",
        );
    assert!(other != text);
    let options = Options { symbols: Symbols::NONE, ..Options::default() };
    for quantity in ["M", "c", "g", "T", "J_b", "J_s", "potential"] {
        let print = |text: &str| {
            let page = of(text, quantity, &options).print(Language::Text);
            page.split("\n\n").next().expect("a formula").trim().to_string()
        };
        assert_eq!(print(text), print(&other), "{quantity}");
    }
}

#[test]
fn a_turned_link_frame_gives_the_same_equations() {
    // link 2's frame turned by 90° about x: other axes in the file, the same robot
    let link = |rpy, axis, center, mass| Moved {
        kind: "continuous",
        axis,
        origin: "0.5 0 0",
        rpy,
        mass,
        center,
        inertia: ["0", "0", "0"],
    };
    let first = || link("0 0 0", "0 -1 0", "0.3 0 0", "2");
    let plain = chain("arm", &[first(), link("0 0 0", "0 -1 0", "0.2 0 0", "1")]);
    let turned = chain("arm", &[first(), link("1.570796326794897 0 0", "0 0 1", "0.2 0 0", "1")]);
    let options = Options { symbols: Symbols::NONE, ..Options::default() };
    for quantity in ["M", "c", "g", "tau", "kinetic"] {
        let print = |text: &str| of(text, quantity, &options).print(Language::Text);
        let formula = |text: &str| print(text).split("\n\n").next().expect("a formula").trim_end().to_string();
        assert_eq!(formula(&plain), formula(&turned), "{quantity}");
    }
}

#[test]
fn a_derivation_is_the_kernel_in_f64() {
    for (name, text) in all() {
        let model = model(&text);
        let theta: Vec<f64> = (0..model.n()).map(|k| 0.3 + 0.5 * k as f64).collect();
        for symbols in [Symbols::NONE, Symbols::ALL] {
            for names in [false, true] {
                let options = Options { symbols, names, ..Options::default() };
                let query = Query::named("M").expect("known");
                let found = derive(&model, Some(&text), query, &options).expect(name);
                let found = found.evaluate(&[&theta], Rational::to_f64, std::f64::consts::PI).swap_remove(0);
                let expected = model.compute(query, &[&theta], &model.environment()).expect("regular").swap_remove(0);
                let size = expected.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
                for (found, expected) in found.iter().zip(&expected) {
                    assert!((found - expected).abs() < 1e-7 * size, "{name}: {found} {expected}");
                }
            }
        }
    }
}

#[test]
fn the_recursion_of_each_robot_ends_at_the_kernels_torques() {
    let options = Options { symbols: Symbols::ALL, ..Options::default() };
    for (name, text) in all() {
        let found = steps(&model(&text), Some(&text), &options).unwrap_or_else(|error| panic!("{name}: {error}"));
        let page = found.print(Language::Text).expect("text");
        for part in ["base\n", "outward, link 1", "inward, link 1", "torques", "𝒲(θ)"] {
            assert!(page.contains(part), "{name}: no {part}");
        }
        assert_eq!(page.contains("ℒ₃,₁"), page.contains("link 3"), "{name}");
    }
}

/// JᵀF of a tip's wrench, F = (m, f).
#[test]
fn tip_forces_have_the_wrench_as_symbols() {
    let options = Options { symbols: Symbols::ALL, equal: mozzi_symbolic::Equal::OfLink, ..Options::default() };
    let page = of(embedded("two_link_planar"), "tip_forces", &options).print(Language::Text);
    assert!(page.contains("L₁ sin θ₂ F₄") && page.contains("L₂F₆"), "{page}");
}

#[test]
fn mimic_joints_balls_and_floating_bases_are_derived() {
    let text = embedded("furuta_pendulum");
    let robot = mozzi_urdf::parse("robot.urdf", text).expect("sound").description.floating().build().expect("sound");
    let options = Options { symbols: Symbols::NONE, ..Options::default() };
    for quantity in ["M", "g"] {
        let found = derive(&robot, Some(text), Query::named(quantity).expect("known"), &options);
        found.unwrap_or_else(|error| panic!("{quantity}: {error}"));
    }
    let mimic = embedded("two_link_planar").replace(
        "<child link=\"link2\"/>",
        "<child link=\"link2\"/><mimic joint=\"joint1\" multiplier=\"-0.5\" offset=\"0.3\"/>",
    );
    let page = of(&mimic, "M", &options).print(Language::Text);
    assert!(page.contains("θ₁/2") && page.contains("0.3"), "{page}");
}
