//! `mozzi derive`: forms, symbols, counts, refusals.

use crate::common::{complaint, folder, json, mozzi, text};

#[test]
fn each_form_is_printed() {
    let page = text(&["derive", "two_link_planar", "--equal", "link"]);
    for part in ["M(θ) =", "m₁L₁² + m₂(L₁² + 2L₁L₂ cos θ₂ + L₂²)", "c(θ, θ̇) =", "g(θ) =", "g = 9.81 m/s²: gravity z"]
    {
        assert!(page.contains(part), "{part} in {page}");
    }
    for (form, part) in [
        ("latex", r"\begin{bmatrix}"),
        ("markdown", "| $m_{1}$ | 2 | kg | link1 mass |"),
        ("sympy", "mass_matrix = Matrix(2, 2, ["),
        ("python", "def mass_matrix(theta, m1=2.0,"),
        ("matlab", "function out_M = mass_matrix(theta)"),
        ("julia", "function mass_matrix(theta; m1=2.0,"),
    ] {
        let page = text(&["derive", "two_link_planar", "M", "--as", form]);
        assert!(page.contains(part), "{form}: {page}");
    }
    let told = json(&["derive", "two_link_planar", "g", "--equal", "link"]);
    let found = &told["derivations"][0];
    assert_eq!(
        (found["quantity"].as_str(), found["symbols"][0]["name"].as_str()),
        (Some("gravity-forces"), Some("m1"))
    );
    assert_eq!(found["operations"]["sines"], 2);
    assert_eq!(text(&["derive", "two_link_planar", "M,g"]), text(&["derive", "two_link_planar", "M", "g"]));
    assert!(text(&["derive", "two_link_planar", "--list"]).contains("mass-matrix"));
    let steps = text(&["derive", "two_link_planar", "--steps", "--equal", "link"]);
    assert!(steps.contains("outward, link 2: link2") && steps.contains("𝓕₁") && steps.contains("τ₁ = "), "{steps}");
}

#[test]
fn inverses_and_base_parameters_are_printed() {
    let page = text(&["derive", "two_link_planar", "M_inv", "Lambda", "--equal", "link", "--task", "vx,vz"]);
    for part in ["M⁻¹(θ) = 1/Δ ·", "Δ = m₂L₁²L₂²(m₁ + m₂ sin² θ₂)", "Λ(θ) = 1/Δ ·", "m₁ + m₂ sin² θ₂   0"]
    {
        assert!(page.contains(part), "{part} in {page}");
    }
    let space = text(&["derive", "two_link_planar", "Lambda", "--task", "wy,vx", "--task-frame", "space"]);
    assert!(space.contains("sin² θ₁"), "{space}");
    for name in ["base-parameters", "base_parameters"] {
        let page = text(&["derive", "two_link_planar", name]);
        assert!(page.contains("I₁yy + m₂L₁²") && page.contains("Y_b₁₁ = g cos θ₁"), "{page}");
    }
    let told = json(&["derive", "ur5", "base-parameters"]);
    assert_eq!(told["derivations"][0]["quantity"], "base-parameters");
    let list = text(&["derive", "two_link_planar", "--list"]);
    for name in ["mass-matrix-inverse", "forward-dynamics", "task-space-dynamics", "base-parameters"] {
        assert!(list.contains(name), "{list}");
    }
    assert!(!list.contains("forward-dynamics-vjp"), "{list}");
}

/// With named sub-expressions, fewer than 1.3 times the operations of the recorded program.
#[test]
fn an_arms_mass_matrix_is_as_short_as_its_program() {
    for (robot, quantity) in [("ur5", "mass-matrix"), ("ur5", "gravity-forces")] {
        let told = json(&["derive", robot, quantity, "--symbols", "none", "--cse"]);
        let count = &told["derivations"][0]["operations"];
        let found = count["additions"].as_u64().expect("a number") + count["products"].as_u64().expect("a number");
        let work = json(&["codegen", robot, "--quantity", quantity, "--explain"]);
        let flops = work["work"][0]["after"]["flops"].as_u64().expect("a number");
        println!("{robot} {quantity}: {found} operations, the recorded program {flops}");
        assert!(found as f64 <= 1.3 * flops as f64, "{found} operations, the program {flops}");
    }
}

#[test]
fn edited_and_other_robots_are_derived_by_their_own_decimals() {
    let run = mozzi(&["derive", "panda", "g", "--lock", "panda_finger_joint1=0.02"]);
    let said = String::from_utf8_lossy(&run.stderr);
    assert!(run.status.success() && said.contains("the file's decimals are not used"), "{said}");
    let json = folder("derive").join("arm.json");
    text(&["convert", "two_link_planar", json.to_str().expect("a path")]);
    let page = text(&["derive", json.to_str().expect("a path"), "M", "--equal", "link"]);
    assert!(page.contains("m₁L₁² + m₂(L₁² + 2L₁L₂ cos θ₂ + L₂²)"), "{page}");
    let moon = text(&["derive", "two_link_planar", "g", "--gravity", "moon", "--symbols", "none"]);
    assert!(moon.contains("2.43 cos θ₁ + 0.648 cos(θ₁ + θ₂)"), "{moon}");
}

#[test]
fn what_cannot_be_derived_is_refused_by_name() {
    for (arguments, part) in [
        (&["derive", "ur5", "aba"][..], "forward-dynamics of 6 velocities is too long to read as one fraction"),
        (&["derive", "ur5", "aba_derivatives"], "forward-dynamics-derivatives divides by pivots"),
        (&["derive", "two_link_planar", "Lambda"], "such as vx,vz"),
        (&["derive", "two_link_planar", "M", "--task", "vx"], "--task and --task-frame have an effect on"),
        (&["derive", "ur5", "M", "--symbols", "weights"], "found `weights`, expected some of masses"),
        (&["derive", "ur5", "constraint-jacobian"], "ur5 has no constraints; --constraints FILE adds some"),
        (&["derive", "ur5", "--floating", "--steps"], "a floating base"),
        (&["derive", "two_link_planar", "--steps", "--as", "julia"], "--steps is printed as text, latex or markdown"),
    ] {
        let (code, said) = complaint(arguments);
        assert!(code != 0 && said.contains(part), "{said}");
    }
}

/// Quantities that are derived before a refused one are printed; the refusal names the part that is no polynomial.
#[test]
fn refusals_tell_their_reason() {
    let body = "<inertial pos='0 0 -0.2' mass='2' diaginertia='0.1 0.2 0.25'/>";
    let joint = "<joint name='neck' type='ball' stiffness='1.5'/>";
    let robot = format!("<mujoco><worldbody><body name='head'>{joint}{body}</body></worldbody></mujoco>");
    let robot = crate::common::file(&folder("ball"), "ball.xml", &robot);
    let run = mozzi(&["derive", &robot, "M", "tau", "--symbols", "none"]);
    let (page, said) = (String::from_utf8_lossy(&run.stdout), String::from_utf8_lossy(&run.stderr));
    assert!(run.status.code() == Some(1) && page.contains("M") && !page.contains("tau"), "{page}");
    assert!(said.contains("in the spring of the ball joint `neck`") && !said.contains("Derived are"), "{said}");
    let robot = std::fs::read_to_string(&robot).unwrap().replace(" stiffness='1.5'", "");
    let robot = crate::common::file(&folder("ball"), "without_spring.xml", &robot);
    for quantity in ["regressor", "base-parameters"] {
        let (_, said) = complaint(&["derive", &robot, quantity]);
        assert!(said.contains("the column of the stiffness of the ball joint `neck`"), "{said}");
    }
    let module = text(&["derive", "two_link_planar", "M", "c", "g", "--as", "sympy"]);
    assert_eq!(module.matches("\nvalues = {").count(), 1, "{module}");
}

/// A joint of MJCF may miss the origin of its body: lengths are those between axes, not between bodies.
#[test]
fn lengths_are_between_axes() {
    let body = |name: &str, x: &str, inner: &str| {
        format!(
            "<body name='{name}' pos='{x} 0 0'><joint name='{name}_joint' axis='0 0 1' pos='-0.4 0 0'/>\
             <inertial pos='0 0 0' mass='2' diaginertia='0.1 0.1 0.1'/>{inner}</body>"
        )
    };
    let robot = format!("<mujoco><worldbody>{}</worldbody></mujoco>", body("a", "0.4", &body("b", "0.7", "")));
    let robot = crate::common::file(&folder("axes"), "axes.xml", &robot);
    let page = text(&["derive", &robot, "M", "--as", "text"]);
    assert!(page.contains("L₁ = 0.7 m: b_joint axis x relative to the axis before it"), "{page}");
    assert!(page.contains("r₂ = 0.4 m: b centre of mass x relative to its axis"), "{page}");
    assert!(page.contains("m₂(L₁² + 2r₂L₁ cos θ₂ + r₂²)") || page.contains("m₂(L₁² + 2L₁r₂ cos θ₂ + r₂²)"), "{page}");
}
