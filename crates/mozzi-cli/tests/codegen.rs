//! `mozzi codegen`: files of source text, and operation counts before and after folding.

use crate::common;

use common::{complaint, folder, json, mozzi, text};
use mozzi::quantities::{Dim, LIST, Uses};

#[test]
fn files_of_each_language() {
    let folder = folder("codegen");
    let out = folder.join("new").join("folder");
    let out = out.to_str().expect("a path");
    for (lang, files) in [("rust", &["ur5.rs"][..]), ("c", &["ur5.h", "ur5.c"]), ("cuda", &["ur5.cu"])] {
        let arguments = ["codegen", "ur5", "--quantity", "inverse-dynamics", "--quantity", "body-jacobian"];
        let arguments = [&arguments[..], &["--lang", lang, "--precision", "f32", "--out", out]].concat();
        let said = text(&arguments);
        let told = json(&arguments);
        assert_eq!((told["robot"].as_str(), told["precision"].as_str()), (Some("ur5"), Some("f32")));
        for (k, name) in files.iter().enumerate() {
            let written = std::fs::read_to_string(std::path::Path::new(out).join(name)).expect("a file");
            assert!(written.contains("inverse_dynamics") && written.contains("body_jacobian_"), "{lang}");
            assert!(said.contains(&format!("{name}: {} bytes", written.len())), "{said}");
            assert_eq!(told["files"][k]["bytes"], written.len());
        }
        assert_eq!(told["files"].as_array().map(Vec::len), Some(files.len()));
    }
    let casadi = ["codegen", "ur5", "--quantity", "inverse-dynamics", "--lang", "casadi", "--out", out];
    assert!(text(&casadi).contains("ur5_casadi.c: "));
    let written = std::fs::read_to_string(std::path::Path::new(out).join("ur5_casadi.c")).expect("a file");
    assert!(
        written.contains("int jac_ur5_inverse_dynamics(") && written.contains("\"./ur5_casadi.so\""),
        "{written:.3000}"
    );
    let (code, said) = complaint(&[&casadi[..], &["--precision", "f32"]].concat());
    assert!(code == 1 && said.contains("--precision is f32, expected f64"), "{said}");
    // gravity of the command line is built in; with --argument it is an argument
    let header = |more: &[&str]| {
        let arguments = ["codegen", "ur5", "--quantity", "gravity-forces", "--lang", "c", "--out", out];
        text(&[&arguments[..], more].concat());
        std::fs::read_to_string(std::path::Path::new(out).join("ur5.h")).expect("a file")
    };
    assert!(header(&["--gravity", "0,0,-1.62"]).contains("(0, 0, -1.62) m/s^2"));
    assert!(
        header(&["--argument", "gravity"]).contains("const double theta[6], const double gravity[3], double g[6]);")
    );
    let both = header(&["--argument", "wrench", "--argument", "parameters"]);
    assert!(both.contains("const double parameters[") && both.contains("const double wrench[6]"));
    let one = header(&["--argument", "wrench=forearm_link"]);
    assert!(one.contains("const double wrench[6]") && one.contains("`forearm_link`"), "{one}");
    let several = header(&["--argument", "wrench", "--argument", "wrench=forearm_link", "--argument", "base-twist"]);
    for argument in
        ["const double base_twist[6]", "const double wrench_tool0[6]", "const double wrench_forearm_link[6]"]
    {
        assert!(several.contains(argument), "{argument} in {several}");
    }
    // names that no language has
    let link = |name: &str| format!("<link name=\"{name}\"/>");
    let joint = |name: &str, parent: &str, child: &str| {
        let ends = format!("<parent link=\"{parent}\"/><child link=\"{child}\"/>");
        format!("<joint name=\"{name}\" type=\"continuous\">{ends}<axis xyz=\"0 1 0\"/></joint>")
    };
    let (links, first) = (["base", "left foot", "right.foot"].map(link).concat(), joint("j", "base", "left foot"));
    let robot = format!("<robot name=\"odd\">{links}{first}{}</robot>", joint("k", "left foot", "right.foot"));
    let robot = common::file(&folder, "odd.urdf", &robot);
    let flags = ["--lang", "c", "--argument", "wrench=left foot", "--argument", "wrench=right.foot", "--out", out];
    text(&[&["codegen", &robot, "--quantity", "inverse-dynamics"][..], &flags].concat());
    let odd = std::fs::read_to_string(std::path::Path::new(out).join("odd.h")).expect("a file");
    for frame in ["left foot", "right.foot"] {
        assert!(odd.contains(&format!("that the frame `{frame}` applies")), "{odd}");
    }
}

/// Tasks have rows, and quantities of constraints need constraints.
#[test]
fn what_has_no_program_is_refused() {
    let out = folder("codegen_refused");
    let out = out.to_str().expect("a path");
    for lang in ["c", "casadi"] {
        let generate = |quantity: &'static str| ["codegen", "two_link_planar", quantity, "--lang", lang, "--out", out];
        for (quantity, part) in [
            (
                "task-space-dynamics",
                "task-space-dynamics is not generated: the rows wx,wy,wz,vx,vy,vz of J are dependent",
            ),
            ("constraint-jacobian", "two_link_planar has no constraints; --constraints FILE adds some"),
        ] {
            let (code, said) = complaint(&generate(quantity));
            assert!(code == 1 && said.contains(part), "{said}");
        }
        let (code, said) = complaint(&[&generate("mass-matrix")[..], &["--task", "vx"]].concat());
        assert!(code == 1 && said.contains("--task and --task-frame have an effect on"), "{said}");
        text(&[&generate("task-space-dynamics")[..], &["--task", "vx,vz", "--argument", "base-acceleration"]].concat());
    }
    let header = std::fs::read_to_string(std::path::Path::new(out).join("two_link_planar.h")).expect("a file");
    for part in ["Rows: vx, vz of its twist, in the frame's coordinates", "double Lambda[4]"] {
        assert!(header.contains(part), "{part} in {header}");
    }
    let moved = ["codegen", "ur5", "tau", "--argument", "base-acceleration", "--lang", "c", "--out", out];
    text(&moved);
    let header = std::fs::read_to_string(std::path::Path::new(out).join("ur5.h")).expect("a file");
    assert!(header.contains("not the acceleration of its origin, which is dv + w x v"), "{header}");
}

#[test]
fn a_program_that_would_be_too_long_is_declined_at_once() {
    let mut urdf = String::from("<robot name='snake'><link name='l0'/>");
    for k in 1..=2000 {
        let axis = if k % 2 == 0 { "0 1 0" } else { "0.6 0 0.8" };
        urdf += &format!(
            "<link name='l{k}'><inertial><origin xyz='0.1 0.02 0.3'/><mass value='1'/>\
             <inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial></link><joint name='j{k}' type='continuous'>\
             <parent link='l{}'/><child link='l{k}'/><origin xyz='0.1 0.2 0.3'/><axis xyz='{axis}'/></joint>",
            k - 1
        );
    }
    let robot = common::file(&folder("snake"), "snake.urdf", &(urdf + "</robot>"));
    for quantity in ["inverse-dynamics", "forward-dynamics", "mass-matrix"] {
        let out = folder("snake_out");
        let arguments =
            ["codegen", &robot, "--quantity", quantity, "--lang", "c", "--out", out.to_str().expect("text")];
        let (code, said) = complaint(&arguments);
        assert_eq!(code, 1);
        let words = [quantity, "`snake`", "operations", "expected at most 150000", "--allow-large"];
        assert!(words.iter().all(|word| said.contains(word)), "{said}");
    }
    let run = mozzi(&["simulate", &robot, "--compiled", "--time", "0.001", "--method", "euler"]);
    let said = String::from_utf8_lossy(&run.stderr);
    assert!(run.status.success() && said.contains("would not fit the instruction cache"), "{said}");
}

#[test]
fn explain_tells_the_work() {
    let all = json(&["codegen", "panda", "--explain", "--end-effector", "panda_hand_tcp"]);
    let work = all["work"].as_array().expect("a list");
    assert_eq!(work.len(), LIST.len());
    for (entry, declaration) in work.iter().zip(LIST) {
        assert_eq!(entry["quantity"], declaration.name.replace('_', "-"));
        let flops = |when: &str| entry[when]["flops"].as_u64().expect("a count");
        // no wrench is an argument, and the robot has no friction, springs or constraints
        let is_of_rows = declaration.outputs.iter().all(|output| output.dims.contains(&Dim::Constraints));
        let is_nothing = declaration.uses == Uses::WRENCHES
            || is_of_rows
            || ["joint_friction", "spring_forces"].contains(&declaration.name);
        assert!((0 < flops("after")) != is_nothing && flops("after") < flops("before").max(1), "{entry}");
        let code = entry["machine_code"].as_array().expect("a list");
        assert!(code.len() == 2 && code[0]["states"] == 1);
        assert!(code.iter().all(|code| code["bytes"].is_null() != code["none_because"].is_null()), "{entry}");
    }
    assert_eq!(all["files"].as_array().map(Vec::len), Some(0));
    let page = text(&["codegen", "panda", "--explain", "--quantity", "inverse-dynamics"]);
    let after = work[0]["after"]["flops"].to_string();
    let line = page.lines().find(|line| line.contains("inverse-dynamics")).expect("its line");
    assert!(line.split_whitespace().any(|word| word == after), "{page}");
    assert!(!page.contains("mass-matrix"), "{page}");
    // with more arguments, fewer numbers are folded
    let open = json(&["codegen", "panda", "--explain", "--quantity", "inverse-dynamics", "--argument", "parameters"]);
    assert!(open["work"][0]["after"]["flops"].as_u64() > work[0]["after"]["flops"].as_u64());
}

#[test]
fn wrong_usage_is_told() {
    let usage = |arguments: &[&str], words: &[&str]| {
        let (code, message) = complaint(&[&["codegen"], arguments].concat());
        assert_eq!(code, 2, "{message}");
        words.iter().for_each(|word| assert!(message.contains(word), "{word} in {message}"));
    };
    let rest = ["--lang", "c", "--out", "x"];
    usage(
        &[&["ur5", "--quantity", "inverse-dynamic"][..], &rest].concat(),
        &["`inverse-dynamic`", "`inverse-dynamics`"],
    );
    usage(&[&["ur5"][..], &rest].concat(), &["<QUANTITY>...", "such as M, C, g"]);
    usage(&[&["ur5", "--quantity", "mass-matrix", "--argument", "mass"][..], &rest].concat(), &["wrench=FRAME"]);
    usage(&["ur5", "--quantity", "mass-matrix", "--lang", "c"], &["--out"]);
    usage(&["ur5", "--quantity", "mass-matrix", "--lang", "fortran", "--out", "x"], &["fortran", "rust, c, cuda"]);
    let wrong = |arguments: &[&str], words: &[&str]| {
        let (code, message) = complaint(&[&["codegen"], arguments].concat());
        assert_eq!(code, 1, "{message}");
        words.iter().for_each(|word| assert!(message.contains(word), "{word} in {message}"));
    };
    wrong(&[&["ur6", "--quantity", "mass-matrix"][..], &rest].concat(), &["`ur6`", "ur5"]);
    wrong(
        &[&["ur5", "--quantity", "mass-matrix", "--argument", "wrench=hand"][..], &rest].concat(),
        &["no frame `hand`"],
    );
    wrong(&[&["ur5", "--quantity", "tip-forces"][..], &rest].concat(), &["of no wrench is 0", "--argument wrench"]);
    wrong(&[&["anymal", "--quantity", "body-jacobian"][..], &rest].concat(), &["end effector"]);
    let folder = folder("codegen_wrong");
    let file = common::file(&folder, "file", "no folder");
    wrong(&["ur5", "--quantity", "mass-matrix", "--lang", "c", "--out", &file], &[&file, "cannot be written"]);
    // if the chain branches, quantities of a frame are omitted, with a note
    let output = mozzi(&["codegen", "anymal", "--explain"]);
    let (page, note) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success() && !page.contains("body-jacobian") && note.contains("omitted"), "{page}{note}");
}
