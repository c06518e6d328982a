//! Each subcommand gives a result, in text and in JSON.
#![allow(non_snake_case)]

use crate::common;

use common::{assert_close, complaint, file, folder, json, mozzi, numbers, rows, text, times};

const STATE: [&str; 8] = [
    "--theta",
    "-0.1,-1.2,1.5,0.3,1.1,0",
    "--dtheta",
    "0.5,-0.3,0.4,0.2,-0.6,1",
    "--ddtheta",
    "1,0.5,-1,2,0,-0.5",
    "--tip-wrench",
    "0.1,-0.2,0.5,3,-4,20",
];

#[test]
fn help_names_every_subcommand_and_gives_examples() {
    let help = text(&["--help"]);
    let all = ["info", "screws", "terms", "compute", "simulate", "check"];
    for name in all {
        assert!(help.contains(&format!("\n  {name} ")), "{name} in {help}");
        assert!(text(&[name, "--help"]).contains("MODEL"));
    }
    for name in ["convert", "explain", "bench", "codegen", "view", "plot", "robots"] {
        assert!(help.contains(&format!("\n  {name} ")), "{name} in {help}");
    }
    for name in ["info", "terms", "compute", "simulate", "check", "ik", "view", "play", "convert", "identify"] {
        assert!(help.contains(&format!("mozzi {name} ")), "an example of {name}");
    }
    assert!(text(&["compute", "--help"]).contains("theta_1 … theta_n"));
}

#[test]
fn info_tells_joints_limits_masses_and_frames() {
    let page = text(&["info", "ur5"]);
    for word in ["shoulder_pan_joint", "revolute", "6.2832", "150", "20.9939 kg", "8.393", "tool0", "-9.81"] {
        assert!(page.contains(word), "{word} in {page}");
    }
    let robot = json(&["info", "panda"]);
    assert_eq!((robot["n"].as_u64(), robot["moving_links"].as_u64()), (Some(8), Some(9)));
    assert!(robot["end_effector"] == "panda_hand_tcp" && json(&["info", "anymal"])["end_effector"].is_null());
    let mimic_joint = robot["joints"].as_array().expect("joints").iter().find(|joint| !joint["mimic"].is_null());
    assert_eq!(mimic_joint.expect("a mimic joint")["mimic"]["ratio"], 1.0);
    assert!(json(&["info", "ur5", "--gravity", "0,0,-1.62"])["gravity"][2] == -1.62);
}

#[test]
fn screws_are_the_books_lists() {
    let page = text(&["screws", "two_link_planar", "--all"]);
    for word in ["S_i", "B_i", "A_i", "M_1,2", "G_2"] {
        assert!(page.contains(word), "{word} in {page}");
    }
    let lists = json(&["screws", "two_link_planar"]);
    assert_eq!(rows(&lists["S"]), [[0.0, -1.0, 0.0, 0.0, 0.0, 0.0], [0.0, -1.0, 0.0, 0.0, 0.0, -0.5]]);
    assert_eq!(numbers(&lists["M"][1][0]), [1.0, 0.0, 0.0, 0.9]);
    assert_eq!(lists["G"][0][3][3], 2.0);
    assert_eq!(lists["parents"].as_array().map(Vec::len), Some(2));
    assert!(json(&["screws", "anymal"])["B"].is_null());
}

#[test]
fn screws_are_python_that_reads_back() {
    let python = text(&["screws", "ur5", "--python"]);
    let list = |name: &str| {
        let start = python.find(&format!("{name} = np.array(")).expect("the list") + name.len() + 12;
        let length = python[start..].find("\n)").or(python[start..].find("\n])").map(|k| k + 2)).expect("its end");
        // JSON allows no comma after the last entry
        let literal = python[start..start + length].trim().replace(",\n]", "\n]");
        serde_json::from_str::<serde_json::Value>(&literal).unwrap_or_else(|error| panic!("{name}: {error}: {literal}"))
    };
    assert!(python.starts_with("# ur5"));
    let lists = json(&["screws", "ur5"]);
    let end = |name: &str| python.find(&format!("{name} = ")).expect("the list");
    assert!(end("Mlist") < end("Glist") && end("Glist") < end("Slist") && python.contains("]).T"));
    assert_eq!(list("M"), lists["end_effector"]["M"]);
}

#[test]
fn terms_satisfy_the_equation_of_motion() {
    let found = json(&[&["terms", "ur5"], &STATE[..]].concat());
    let of = |name: &str| numbers(&found[name]);
    let ddtheta = of("ddtheta");
    let mut tau = times(&rows(&found["mass_matrix"]), &ddtheta);
    for name in ["bias_forces", "tip_forces", "joint_friction", "spring_forces"] {
        tau = tau.iter().zip(of(name)).map(|(a, b)| a + b).collect();
    }
    assert_close(&tau, &of("inverse_dynamics"), 1e-12);
    let h: Vec<f64> = of("velocity_product").iter().zip(of("gravity_forces")).map(|(c, g)| c + g).collect();
    assert_close(&h, &of("bias_forces"), 1e-12);
    assert_close(&times(&rows(&found["coriolis_matrix"]), &of("dtheta")), &of("velocity_product"), 1e-12);
    assert_close(&of("forward_dynamics"), &ddtheta, 1e-10);
    assert_close(&times(&rows(&found["body_jacobian"]), &of("dtheta")), &of("V_b"), 1e-14);
    assert_eq!(rows(&found["task_space_dynamics"]["Lambda"]).len(), 6);
    assert_eq!(found["newton_euler"]["twists"].as_array().map(Vec::len), Some(6));
    assert!(found["closed_form"].is_null());

    let tau: Vec<String> = of("inverse_dynamics").iter().map(f64::to_string).collect();
    let d_tau = json(&[&["terms", "ur5"], &STATE[..4], &["--tau", &tau.join(",")], &STATE[6..]].concat());
    assert_close(&numbers(&d_tau["ddtheta"]), &ddtheta, 1e-10);
}

const DDTHETA: &str = "1,0.5,-1,2,0,-0.5";

#[test]
fn derivatives_are_what_small_steps_make_of_the_answers() {
    let h = 1e-6;
    let tau = |theta: f64, dtheta: f64| {
        let (theta, dtheta) =
            (format!("0,{},1.5,0.3,1.1,0", -1.2 + theta), format!("0.5,{},0.4,0.2,-0.6,1", -0.3 + dtheta));
        let state = ["--theta", &theta, "--dtheta", &dtheta, "--ddtheta", DDTHETA];
        numbers(&json(&[&["compute", "ur5", "inverse-dynamics"][..], &state].concat())["tau"])
    };
    let state = ["--theta", "0,-1.2,1.5,0.3,1.1,0", "--dtheta", "0.5,-0.3,0.4,0.2,-0.6,1"];
    let compute = |quantity: &str, more: &[&str]| json(&[&["compute", "ur5", quantity], &state[..], more].concat());
    let inverse = compute("inverse-dynamics-derivatives", &["--ddtheta", DDTHETA]);
    let column = |key: &str| rows(&inverse[key]).iter().map(|row| row[1]).collect::<Vec<_>>();
    let slope = |a: Vec<f64>, b: Vec<f64>| a.iter().zip(b).map(|(a, b)| (a - b) / (2.0 * h)).collect::<Vec<_>>();
    assert_close(&column("d_theta"), &slope(tau(h, 0.0), tau(-h, 0.0)), 1e-7);
    assert_close(&column("d_dtheta"), &slope(tau(0.0, h), tau(0.0, -h)), 1e-7);
    // M and its inverse; `terms` has the same
    let tau: Vec<String> = tau(0.0, 0.0).iter().map(f64::to_string).collect();
    let forward = compute("forward-dynamics-derivatives", &["--tau", &tau.join(",")]);
    for (j, row) in rows(&forward["d_tau"]).iter().enumerate() {
        let product = times(&rows(&inverse["d_ddtheta"]), row);
        let unit: Vec<f64> = (0..6).map(|i| f64::from(u8::from(i == j))).collect();
        assert_close(&product, &unit, 1e-10);
    }
    let terms = json(&[&["terms", "ur5"], &state[..], &["--ddtheta", DDTHETA]].concat());
    for key in ["d_theta", "d_dtheta", "d_ddtheta"] {
        assert_eq!(terms["inverse_dynamics_derivatives"][key], inverse[key], "{key}");
    }
    for key in ["d_theta", "d_dtheta", "d_tau"] {
        // τ went through the test's JSON reader, which is off by an ulp
        let (a, b) = (rows(&terms["forward_dynamics_derivatives"][key]).concat(), rows(&forward[key]).concat());
        assert_close(&a, &b, 1e-13 * a.iter().fold(1.0, |m: f64, x| m.max(x.abs())));
    }
    let gravity = json(&["compute", "ur5", "gravity-forces-derivative", "--theta", state[1]]);
    assert_eq!(terms["gravity_forces_derivative"], gravity["dg"]);
    let page = text(&["compute", "anymal", "forward-dynamics-derivatives", "--floating", "--all", "-v"]);
    for word in ["∂θ̈/∂θ̇", "∂θ̈/∂τ = M⁻¹", "base.wx", "along the velocities", "d_tau ["] {
        assert!(page.contains(word), "{word} in {page}");
    }
    let page = text(&["terms", "anymal", "--floating", "--all"]);
    for word in ["∂τ/∂θ̇", "∂θ̈/∂τ = M⁻¹", "base.wx"] {
        assert!(page.contains(word), "{word} in {page}");
    }
}

#[test]
fn terms_show_every_quantity_and_the_stacked_matrices() {
    let page = text(&[&["terms", "ur5"], &STATE[..], &["--stacked"]].concat());
    let words = ["T_sb", "J_b", "J̇_s", "M(θ)", "Ṁ", "C(θ, θ̇)", "+ c", "+ g", "h = c + g"];
    let more =
        ["+ JᵀF_tip", "kinetic_energy", "Λ", "η", "V̇_i", "𝒜", "𝒢", "𝒲", "ℒ", "[ad_𝒱]", "[ad_𝒜θ̇]", "𝒱_base", "36 × 36"];
    for word in words.iter().chain(&more) {
        assert!(page.contains(word), "{word} in {page}");
    }
    let found = json(&[&["terms", "ur5"], &STATE[..], &["--stacked"]].concat());
    let form = &found["closed_form"];
    assert_eq!((rows(&form["A"]).len(), rows(&form["L"]).len(), numbers(&form["F"]).len()), (36, 36, 36));
    assert_close(&numbers(&form["inverse_dynamics"]), &numbers(&found["inverse_dynamics"]), 1e-11);
    for (a, b) in rows(&form["mass_matrix"]).iter().zip(rows(&found["mass_matrix"])) {
        assert_close(a, &b, 1e-13);
    }
}

#[test]
fn terms_have_one_h_on_every_page() {
    let all = json(&[&["terms", "ur5"], &STATE[..]].concat());
    assert!(numbers(&all["tip_forces"]).iter().any(|x| x.abs() > 1.0), "a wrench at the tip");
    let only = |what: &'static str| [&["terms", "ur5"], &STATE[..], &["--only", what]].concat();
    for name in ["bias_forces", "task_space_dynamics"] {
        assert_eq!(json(&only(name))[name], all[name], "{name}");
    }
    let line = |page: &str| page.lines().find(|line| line.contains("h = c + g")).map(str::to_string).expect("h");
    let h: Vec<String> =
        line(&text(&[&["terms", "ur5"], &STATE[..]].concat())).split_whitespace().map(String::from).collect();
    // the state stays, though two of its names are short for quantities
    let one = json(&only("M"));
    for key in ["theta", "dtheta", "ddtheta", "gravity"] {
        assert_eq!(one[key], all[key], "{key}");
    }
    let (code, why) = complaint(&["terms", "ur5", "--only", "M", "--stacked"]);
    assert!(code == 1 && why.contains("--stacked has no effect with --only"), "{why}");
    let page = text(&only("h"));
    assert!(h[h.len() - 6..].iter().all(|entry| page.contains(entry)), "{h:?} in {page}");
}

/// A joint with a spring of 1e-6 N m/rad that rests at 0.5 rad, one that follows it, and a rail.
const SPRINGS: &str = r#"<robot name="s"><link name="b"/><link name="c"/><link name="d"/><link name="e"><inertial><mass value="1"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link><joint name="j" type="revolute">
<parent link="b"/><child link="c"/><axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="99" velocity="9"/>
<dynamics spring_stiffness="1e-6" spring_reference="0.5"/></joint><joint name="k" type="revolute"><parent link="c"/>
<child link="d"/><axis xyz="0 1 0"/><limit lower="-9" upper="9" effort="99" velocity="9"/>
<mimic joint="j" multiplier="2" offset="0.25"/></joint><joint name="rail" type="prismatic"><parent link="d"/><child link="e"/>
<axis xyz="1 0 0"/><limit lower="-1" upper="1" effort="99" velocity="9"/><dynamics spring_stiffness="200" damping="1e-5"/></joint></robot>"#;

#[test]
fn pages_in_degrees_have_no_radians_and_small_numbers_are_not_0() {
    let robot = file(&folder("springs"), "springs.urdf", SPRINGS);
    let page = text(&["info", &robot, "--deg"]);
    for words in ["28.648", "2 · j + 14.323945", "1e-6", "1.0000e-5"] {
        assert!(page.contains(words), "{words} in {page}");
    }
    let to = ["trajectory", &robot, "--to", "90,0", "--deg", "--step", "0.5"];
    let said = String::from_utf8(mozzi(&to).stderr).expect("text");
    assert!(said.contains("joint limit: `j` reaches 90, beyond its limit 57.29578"), "{said}");
    let falls = ["simulate", &robot, "--dtheta", "90,0", "--time", "2", "--deg"];
    assert!(text(&falls).contains("beyond 57.29578"), "{}", text(&falls));
}

#[test]
fn what_needs_an_end_effector_is_null_with_a_note() {
    let output = mozzi(&["terms", "anymal", "--json"]);
    assert!(output.status.success());
    let note = String::from_utf8_lossy(&output.stderr).to_string();
    assert!(note.contains("`LF_FOOT`") && note.contains("omitted"), "{note}");
    let found: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert!(found["body_jacobian"].is_null() && found["task_space_dynamics"].is_null());
    assert_eq!(rows(&found["mass_matrix"]).len(), 12);
    let named = json(&["terms", "anymal", "--end-effector", "LF_FOOT"]);
    assert_eq!(rows(&named["body_jacobian"]).len(), 6);
    assert_eq!(rows(&named["forward_kinematics"]).len(), 4);
}

#[test]
fn a_planar_task_has_its_rows() {
    let arguments = ["terms", "two_link_planar", "--theta", "0.3,0.8", "--task", "vx,vz"];
    let found = json(&arguments);
    assert_eq!(rows(&found["task_space_dynamics"]["Lambda"]).len(), 2);
    assert_eq!(numbers(&found["task_space_dynamics"]["rows"]), [3.0, 5.0]);
    assert!(text(&arguments).contains("rows v_x v_z"));
}

#[test]
fn forward_dynamics_undoes_inverse_dynamics_in_three_ways() {
    let inverse = json(&[&["compute", "ur5", "inverse-dynamics"], &STATE[..]].concat());
    let tau: Vec<String> = numbers(&inverse["tau"]).iter().map(f64::to_string).collect();
    for by in ["", "-by-mass-matrix", "_by_inverse_dynamics"] {
        let (tau, quantity) = (tau.join(","), format!("forward-dynamics{by}").replace("-dynamics_", "_dynamics_"));
        let arguments = [&["compute", "ur5", &quantity], &STATE[..4], &STATE[6..], &["--tau", &tau]].concat();
        assert_close(&numbers(&json(&arguments)["ddtheta"]), &[1.0, 0.5, -1.0, 2.0, 0.0, -0.5], 1e-10);
    }
    assert!(text(&["compute", "ur5", "inverse-dynamics"]).contains("inverse_dynamics"));
    assert!(text(&["compute", "ur5", "forward-dynamics"]).contains("forward_dynamics"));
}

#[test]
fn simulate_tells_the_motion_and_its_energy() {
    for (method, name, most) in
        [("euler", "Euler", 1.0), ("semi-implicit-euler", "semi-implicit Euler", 1.0), ("rk4", "Runge-Kutta 4", 1e-5)]
    {
        let arguments = ["simulate", "double_pendulum", "--theta", "1,-0.5", "--time", "0.5", "--method", method];
        let page = text(&arguments);
        assert!(page.contains(name) && page.contains("500 steps of 0.001 s") && page.contains("drift"), "{page}");
        let motion = json(&arguments);
        assert_eq!((numbers(&motion["t"]).len(), rows(&motion["theta"]).len()), (501, 501));
        assert!(motion["largest_drift"].as_f64().expect("a number") < most);
    }
    let arguments = ["simulate", "ur5", "--torque", "gravity-compensation", "--theta", "0,-1,1,0,0,0", "--time", "0.1"];
    for row in rows(&json(&arguments)["theta"]) {
        assert_close(&row, &[0.0, -1.0, 1.0, 0.0, 0.0, 0.0], 1e-12);
    }
    let few = json(&["simulate", "ur5", "--time", "0.1", "--step", "0.01", "--record-every", "5"]);
    assert_close(&numbers(&few["t"]), &[0.0, 0.05, 0.1], 1e-15);
}

#[test]
fn check_says_that_a_robot_is_one() {
    let output = mozzi(&["check", "ur5"]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && output.stdout.is_empty() && said.contains("no warnings"), "{said}");
    assert_eq!(text(&["check", "ur5", "--format", "json"]), "");
}
