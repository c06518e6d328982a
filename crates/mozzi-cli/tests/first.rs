//! What people type first: each guess works, or says in one line what does; and what is printed fits a screen.

use crate::common::{assert_close, complaint, file, folder, json, mozzi, numbers, screen, text, words};

const Q: &str = "--q=0,-1.2,1.5,0.3,1.1,0";

#[test]
fn quantities_have_the_names_of_books_and_libraries() {
    let of = |name: &str, state: &str| text(&["compute", "ur5", name, state, "--json"]);
    for (guess, name) in [
        ("M", "mass-matrix"),
        ("crba", "mass-matrix"),
        ("inertia_matrix", "mass-matrix"),
        ("C", "coriolis-matrix"),
        ("c", "velocity-product"),
        ("g", "gravity-forces"),
        ("gravity", "gravity-forces"),
        ("h", "bias-forces"),
        ("nle", "bias-forces"),
        ("rnea", "inverse-dynamics"),
        ("RNEA", "inverse-dynamics"),
        ("aba", "forward-dynamics"),
        ("FDab", "forward-dynamics"),
        ("J_b", "body-jacobian"),
        ("jacobian", "body-jacobian"),
        ("Js", "space-jacobian"),
        ("T", "forward-kinematics"),
        ("fk", "forward-kinematics"),
        ("Lambda", "task-space-dynamics"),
        ("com", "center-of-mass"),
        ("ccrba", "centroidal-momentum-matrix"),
        ("Y", "regressor"),
    ] {
        assert_eq!(of(guess, Q), of(name, Q), "{guess}");
    }
}

#[test]
fn several_quantities_are_a_list() {
    let page = screen(&["compute", "ur5", "M,h,g", Q], 60);
    for name in ["mass_matrix", "bias_forces", "gravity_forces"] {
        assert!(page.contains(&format!("{name}: ")), "{page}");
    }
    assert_eq!(text(&["compute", "ur5", "M", "h", "g", Q]), page);
    let list = json(&["compute", "ur5", "M,g", Q]);
    let alone = json(&["compute", "ur5", "g", Q]);
    assert_eq!(list["results"][1], alone);
    // a flag has an effect on one of them
    text(&["compute", "ur5", "M,h", Q, "--qd=1,0,0,0,0,0"]);
    let (code, said) = complaint(&["compute", "ur5", "M,g", "--tau=1,0,0,0,0,0"]);
    assert!(code == 1 && said.contains("--tau has no effect on mass-matrix, gravity-forces"), "{said}");
}

#[test]
fn a_wrong_quantity_shows_three_and_where_all_are() {
    for (guess, near) in [("mass-matrx", "`mass-matrix`"), ("jacobian_bdy", "`body-jacobian`"), ("foo", "`")] {
        let (code, said) = complaint(&["compute", "ur5", guess]);
        let first = said.lines().next().expect("a line");
        assert!(code == 2 && first.contains(near) && first.matches('`').count() == 8, "{said}");
        assert!(said.contains("`mozzi compute --list` shows all") && said.lines().count() < 10, "{said}");
    }
    let (_, said) = complaint(&["compute", "ur5", "closed-form"]);
    assert!(said.contains("`mozzi terms MODEL --stacked` shows the closed form"), "{said}");
    let (_, said) = complaint(&["compute", "ur5", "ik"]);
    assert!(said.contains("`mozzi ik MODEL"), "{said}");
}

#[test]
fn commands_are_found_by_what_they_do() {
    let robots = text(&["robots"]);
    assert!(robots.contains("ur5") && robots.contains("tool0"), "{robots}");
    for guess in [&["list"][..], &["models"], &["info"], &["ls"]] {
        assert_eq!(text(guess), robots, "{guess:?}");
    }
    assert_eq!(json(&["robots"])["robots"][5]["n"], 6);
    for (guess, meant) in [
        (&["fk", "ur5", Q][..], &["compute", "ur5", "fk", Q][..]),
        (&["rnea", "ur5", Q], &["compute", "ur5", "rnea", Q]),
        (&["ur5", "M,g", Q], &["compute", "ur5", "M,g", Q]),
        (&["compute", "M", "ur5", Q], &["compute", "ur5", "M", Q]),
        (&["ur5"], &["info", "ur5"]),
        (&["ur5", "terms", Q], &["terms", "ur5", Q]),
        (&["sim", "double_pendulum", "--duration", "0.1"], &["simulate", "double_pendulum", "--time", "0.1"]),
    ] {
        assert_eq!(text(guess), text(meant), "{guess:?}");
    }
    let (code, said) = complaint(&["rnea"]);
    assert!(code == 2 && said.contains("`rnea` needs a robot"), "{said}");
    let (code, said) = complaint(&["terms"]);
    assert!(code == 2 && said.contains("`mozzi robots` lists"), "{said}");
}

#[test]
fn tips_name_the_flag_or_the_command_that_has_it() {
    for (line, tip) in [
        ("compute ur5 M --cutoff 1", "--cutoff is a flag of `mozzi identify`"),
        ("compute ur5 M --thta 1", "did you mean `--theta`?"),
        ("simulate ur5 --steps 100", "--time is the duration and --dt the step"),
        ("simulate ur5 --fext 1", "flags"),
        ("ik ur5 0.4,0.2,0.5", "a value needs its flag before it"),
        ("trajectory ur5 --dt 0.1 --until x", "--until is a flag of `mozzi simulate`"),
        ("info ur5 -1", "a number needs its flag before it"),
    ] {
        let words: Vec<&str> = line.split(' ').collect();
        let (code, said) = complaint(&words);
        assert!(code == 2 && said.contains(tip) && !said.contains("as a value"), "{line}: {said}");
    }
}

#[test]
fn numbers_of_a_flag_may_be_words() {
    let list = json(&["compute", "ur5", "g", "--q=0,-90,45,0,30,0", "--deg"]);
    assert_eq!(json(&["compute", "ur5", "g", "--q", "0", "-90", "45", "0", "30", "0", "--deg"]), list);
    assert_eq!(json(&["compute", "ur5", "g", "--q", "0,", "-pi/2,", "45deg,", "0,", "30deg,", "0"]), list);
    let page = text(&["ik", "ur5", "--position", "0.4", "0.1", "0.3", "--rpy", "pi", "0", "0"]);
    assert!(page.contains("`tool0` reaches its goal"), "{page}");
    let (_, said) = complaint(&["ik", "ur5", "0.4", "0.1", "0.3"]);
    assert!(said.contains("a number needs its flag before it"), "{said}");
}

#[test]
fn a_torque_may_be_numbers() {
    let motion = json(&["simulate", "two_link_planar", "--tau", "31.392,-9.81", "--time", "0.002"]);
    assert_eq!(motion["tau"], serde_json::json!(vec![[31.392, -9.81]; 3]));
    let (_, said) = complaint(&["simulate", "two_link_planar", "--torque", "1"]);
    assert!(said.contains("--torque has 1 entry, expected 2: joint1, joint2"), "{said}");
}

#[test]
fn angles_may_be_in_degrees() {
    let radians = json(&["compute", "ur5", "g", "--q=0,-1.5707963267948966,0.7853981633974483,0,0,0"]);
    for guess in
        ["--q=0,-90deg,45°,0,0,0", "--theta=0,-pi/2,pi/4,0,0,0", "--theta=0,-1.5707963267948966rad,45deg,0,0,0"]
    {
        assert_eq!(json(&["compute", "ur5", "g", guess]), radians, "{guess}");
    }
    for flag in ["--deg", "--degrees"] {
        assert_eq!(json(&["compute", "ur5", "g", "--q=0,-90,45,0,0,0", flag]), radians);
        // explicit units win
        assert_eq!(json(&["compute", "ur5", "g", "--q=0,-pi/2,45deg,0,0,0", flag]), radians);
    }
    // rates turn, forces do not; a slide stays in metres
    let found = json(&["compute", "panda", "rnea", "--deg", "--qd=180,0,0,0,0,0,0,1"]);
    let dtheta = numbers(&found["dtheta"]);
    assert!((dtheta[0] - std::f64::consts::PI).abs() < 1e-15 && dtheta[7] == 1.0, "{dtheta:?}");
    assert_eq!(numbers(&json(&["compute", "ur5", "aba", "--deg", "--tau=90,0,0,0,0,0"])["tau"])[0], 90.0);
    let (_, said) = complaint(&["compute", "panda", "g", "--q=0,0,0,0,0,0,0,1deg"]);
    assert!(said.contains("entry 8 is `1deg`, which is no angle"), "{said}");
    let way = |flags: &[&str]| json(&[&["trajectory", "ur5", "--to"][..], flags].concat())["t"].clone();
    let by_degrees = way(&["90,0,0,0,0,0", "--max-velocity", "90", "--deg"]);
    assert_eq!(by_degrees, way(&["90deg,0,0,0,0,0", "--max-velocity", "90deg"]));
    let (_, said) = complaint(&["simulate", "ur5", "--deg", "--until", "elbow_joint > 90"]);
    assert!(said.contains("conditions of --until and --report-event are in radians"), "{said}");
    // and printed so
    let page = text(&["info", "ur5", "--deg"]);
    assert!(page.contains("-360") && page.contains("units: deg, deg/s, N m"), "{page}");
    let pose = ["--position=0.4,0.2,0.5", "--rpy=180,0,0", "--deg"];
    let page = text(&[&["ik", "ur5"][..], &pose].concat());
    assert!(page.contains("θ in deg") && page.contains("--deg --theta="), "{page}");
    let back = text(&["fk", "ur5", "--deg", &joined(&page)]);
    assert!(back.contains("0.4 ⎤") && back.contains("0.2 ⎥") && back.contains("0.5 ⎥"), "{back}");
}

/// The pasted flag of θ, whose lines a shell joins.
fn joined(page: &str) -> String {
    let begin = page.find("--theta=").expect("a flag");
    page[begin..].replace("\\\n", "").split_whitespace().next().expect("a word").to_string()
}

#[test]
fn radians_that_look_like_degrees_are_questioned() {
    let said = |arguments: &[&str]| String::from_utf8(mozzi(arguments).stderr).expect("text");
    let note = said(&["ik", "ur5", "--position", "0.4,0.2,0.5", "--rpy", "180,0,0"]);
    assert!(note.contains("--rpy is in radians, and 180 rad are 28.6 turns"), "{note}");
    let note = said(&["compute", "ur5", "g", "--q", "0,-90,90,0,0,0"]);
    assert!(note.contains("--theta is in radians"), "{note}");
    for fine in ["--q=0,-90deg,0,0,0,0", "--q=0,6.2,0,0,0,0"] {
        assert_eq!(said(&["compute", "ur5", "g", fine]), "");
    }
    let note = said(&["compute", "ur5", "c", "--q=0,1,0,0,0,0", "--dtheta=0,90,0,0,0,0"]);
    assert!(note.contains("--dtheta is in rad/s, and 9e1 is large"), "{note}");
}

#[test]
fn tables_that_look_like_degrees_are_questioned() {
    let place = folder("degrees");
    let table = |name: &str, ending: &str, value: &str| {
        let header: String = (1..=6).map(|k| format!(",theta_{k}{ending}")).collect();
        file(&place, name, &format!("t{header}\n0,0,{value},90,0,90,0\n1,0,-90,90,0,90,0\n"))
    };
    let said = |arguments: &[&str]| String::from_utf8(mozzi(arguments).stderr).expect("text");
    let (plain, named) = (table("a.csv", "", "-90"), table("b.csv", "_deg", "-90"));
    let question =
        "column `theta_2` is read in radians, and -90 rad are -14.3 turns; `theta_2_deg` is a name for degrees";
    let svg = place.join("a.svg").display().to_string();
    for arguments in
        [&["compute", "ur5", "g", "--in", &plain][..], &["plot", "trajectory", "ur5", &plain, "--out", &svg]]
    {
        let note = said(arguments);
        assert_eq!(note.matches("is read in radians").count(), 1, "{note}");
        assert!(note.contains(question), "{note}");
    }
    assert!(!said(&["compute", "ur5", "g", "--in", &named]).contains("radians"));
}

#[test]
fn first_guesses_of_values_have_tips() {
    for (line, tip) in [
        ("ik ur5 --position 0.4,0.2,0.5 --seed 0,-90,0,0,0,0", "--guess is the initial guess of θ"),
        ("compute ur5 tau --wrench 0,0,0,0,0,1", "; --tip-wrench 0,0,0,0,0,1 is the end effector's"),
        ("compute ur5 manipulability", "`mozzi plot ellipsoids MODEL"),
        ("compute ur5 gravity-compensation", "`gravity-forces` is g(θ), without springs"),
        ("compute ur5 fk --frame wrist_3", "no frame `wrist_3` (did you mean `wrist_3_link`?); this robot has"),
        ("compute ur5 fk --frame TOOL0", "no frame `TOOL0` (did you mean `tool0`?); this robot has"),
        ("compute ur5 g --gravity pluto", "expected a number, a vector X,Y,Z, or one of earth, moon, mars, none"),
        ("compute ur5 g --q 0x10,0,0,0,0,0", "is `0x10`, expected a number\n"),
    ] {
        let words: Vec<&str> = line.split(' ').collect();
        let (_, said) = complaint(&words);
        assert!(said.contains(tip), "{line}: {said}");
    }
    let svg = folder("guesses").join("a.svg").display().to_string();
    text(&["plot", "ellipsoids", "ur5", "--q", "0,-1,1,0,1,0", "--out", &svg]);
}

#[test]
fn gravity_is_a_number_a_vector_or_a_body() {
    let of = |gravity: &str| json(&["compute", "ur5", "g", Q, "--gravity", gravity])["gravity"].clone();
    assert_eq!(of("9.81"), of("0,0,-9.81"));
    assert_eq!(of("moon"), of("1.62"));
    assert_eq!(of("none"), of("0,0,0"));
}

#[test]
fn payloads_and_locks_are_flags_of_every_command() {
    let page = |arguments: &[&str]| json(&[arguments, &["--payload", "5"]].concat());
    let plain = numbers(&json(&["compute", "ur5", "g", Q])["g"]);
    let loaded = numbers(&page(&["compute", "ur5", "g", Q])["g"]);
    let named = numbers(&json(&["compute", "ur5", "g", Q, "--payload", "tool0=5"])["g"]);
    assert!(loaded == named && (loaded[1] - plain[1]).abs() > 1.0, "{plain:?} {loaded:?}");
    for command in ["info", "terms", "screws", "bench", "simulate", "trajectory", "codegen", "ik"] {
        let mut words = vec![command, "ur5", "--payload", "1", "--lock", "wrist_3_joint=0.5", "--json"];
        match command {
            "bench" => words.extend(["--quantity", "g", "--states", "16", "--rounds", "1"]),
            "simulate" => words.extend(["--time", "0.002"]),
            "trajectory" => words.extend(["--to", "0.1,0,0,0,0", "--time", "0.05"]),
            "codegen" => words.extend(["--explain", "--quantity", "g"]),
            "ik" => words.extend(["--position", "0.4,0.2,0.5"]),
            _ => {}
        }
        let found = text(&words);
        assert!(!found.contains("\"wrist_3_joint\",\n") || command == "info" || command == "screws", "{command}");
    }
    assert_eq!(json(&["info", "ur5", "--lock", "wrist_3_joint=0.5"])["n"], 5);
    let locked = json(&["compute", "ur5", "fk", "--lock", "wrist_3_joint=90deg", "--q=0,0,0,0,0"])["T"].clone();
    let turned = json(&["compute", "ur5", "fk", "--q=0,0,0,0,0,90deg"])["T"].clone();
    for (a, b) in crate::common::rows(&locked).concat().iter().zip(crate::common::rows(&turned).concat()) {
        assert!((a - b).abs() < 1e-12, "{locked} {turned}");
    }
}

#[test]
fn a_frame_is_pinned_where_it_is() {
    let found = json(&["compute", "ur5", "constraint-residual", Q, "--pin", "tool0"]);
    let residual = numbers(&found["phi"]);
    assert!(residual.len() == 6 && residual.iter().all(|x| x.abs() < 1e-12), "{residual:?}");
    let feet = ["--pin", "LF_FOOT=point", "--pin", "RH_FOOT=point"];
    let motion = json(&[&["simulate", "anymal", "--floating", "--time", "0.01"], &feet[..]].concat());
    assert!(motion["constraints"]["residual"].as_f64().expect("a number") < 1e-9, "{}", motion["constraints"]);
    let (_, said) = complaint(&["terms", "ur5", "--pin", "tool0=glue"]);
    assert!(said.contains("--pin tool0 is `glue`, expected weld or point"), "{said}");
}

#[test]
fn a_start_is_a_flag_of_pages_and_trajectories() {
    let folder = folder("first_start");
    let out = |name: &str| folder.join(name).to_str().expect("text").to_string();
    let (view, play) = (out("view.html"), out("play.html"));
    text(&["view", "double_pendulum", "--theta", "0.125,0.25", "--out", &view]);
    assert!(std::fs::read_to_string(&view).expect("a page").contains("0.125"));
    text(&["play", "double_pendulum", "--q", "0.125,0.25", "--out", &play]);
    assert!(std::fs::read_to_string(&play).expect("a page").contains("\"theta\":[0.125,0.25]"));
    let theta =
        json(&["trajectory", "double_pendulum", "--theta", "0.125,0.25", "--to", "1,0", "--dt", "0.1", "--time", "1"]);
    assert_eq!(numbers(&theta["theta"][0]), [0.125, 0.25]);
}

#[test]
fn controllers_have_names_and_a_time_constant() {
    let start = "--q=0,-1.2,1.5,-0.3,-1.57,0";
    for controller in ["pd-gravity", "computed-torque", "task-space", "impedance"] {
        let line = ["simulate", "ur5", start, "--controller", controller, "--time", "0.05"];
        let held = json(&[&line[..], &["--payload", "2"]].concat());
        assert_eq!(held["tracking_error"]["largest"].as_array().expect("a list").len(), 6, "{controller}");
        let page = screen(&line, 60);
        assert!(words(&page).contains(&format!("motors: {controller}, response 0.1 s")), "{page}");
        assert!(page.contains("tracking error e = θ_d ⊖ θ [rad]:") && page.contains("wrist_3_joint"), "{page}");
    }
    // an error of computed torque falls as (1 + t/T) e^(-t/T)
    let folder = folder("first_controllers");
    let way = file(&folder, "way.csv", "t,theta_1,theta_2\n0,0.1,0\n5,0.1,0\n");
    let motion = json(&[
        "simulate",
        "double_pendulum",
        "--q=0,0",
        "--follow",
        &way,
        "--controller",
        "computed-torque",
        "--response",
        "0.2",
        "--time",
        "0.4",
        "--step",
        "0.001",
    ]);
    let last = numbers(motion["theta"].as_array().expect("rows").last().expect("a row"))[0];
    assert!((last - 0.1 * (1.0 - 3.0 * (-2.0_f64).exp())).abs() < 1e-6, "{last}");
    let (_, said) = complaint(&["simulate", "ur5", "--controller", "pid"]);
    assert!(said.contains("expected one of pd-gravity, computed-torque") && said.contains("or a JSON file"), "{said}");
    let (_, said) = complaint(&["simulate", "ur5", "--controller", "pd-gravity", "--response", "0"]);
    assert!(said.contains("--response is 0 s"), "{said}");
    let (_, said) = complaint(&["simulate", "anymal", "--floating", "--controller", "standing"]);
    assert!(said.contains("expected --ground"), "{said}");
}

#[test]
fn a_robot_stands_by_a_name() {
    let words = ["simulate", "anymal", "--floating", "--ground", "--controller", "standing", "--time", "0.05"];
    let motion = json(&words);
    let height = |row: &serde_json::Value| numbers(row)[6];
    let rows = motion["theta"].as_array().expect("rows");
    let fall = height(&rows[0]) - height(rows.last().expect("a row"));
    assert!(fall.abs() < 1e-3, "{fall}");
    let page = screen(&words, 100);
    assert!(page.contains("roll") && page.contains("com x"), "{page}");
    let (folder, robot) = (folder("first_standing"), mozzi_urdf::embedded::text("anymal").expect("embedded"));
    let fixed = r#"<joint name="of_more" type="fixed"><parent link="base"/><child link="more"/></joint>"#;
    let robot = robot.replacen("<link ", &format!("<link name=\"more\"/>{fixed}<link "), 1);
    let robot = file(&folder, "more.urdf", &robot).replace('\\', "/");
    let controller = file(&folder, "own.json", &format!(r#"{{"controller": "standing", "model": "{robot}"}}"#));
    let own = json(&words.map(|word| if word == "standing" { controller.as_str() } else { word }));
    assert_close(&numbers(&own["theta"][rows.len() - 1]), &numbers(&rows[rows.len() - 1]), 1e-6);
}

#[test]
fn a_stiff_joint_is_named_with_the_method_that_works() {
    let folder = folder("first_stiff");
    let stiff = r#"{"controller": "pd-gravity", "p": 100, "d": 8000}"#;
    let stiff = file(&folder, "stiff.json", stiff);
    let words = ["simulate", "ur5", "--qd=0.1,0,0,0,0,0.1", "--controller", &stiff, "--time", "0.5"];
    let (_, said) = complaint(&[&words[..], &["--method", "rk4"]].concat());
    assert!(said.contains("`wrist_3_joint` is stiff") && said.contains("--method moreau"), "{said}");
    text(&[&words[..], &["--method", "moreau"]].concat());
}

#[test]
fn goals_that_cannot_be_reached_are_explained() {
    let (_, said) = complaint(&["ik", "ur5", "--position", "2,0,0.5"]);
    assert!(said.contains("m out of reach") && said.contains("the arm reaches 0.95"), "{said}");
    let (_, said) = complaint(&["ik", "two_link_planar", "--position", "0.5,0.3,0.3"]);
    assert!(said.contains("no joint moves `tip` along"), "{said}");
}

#[test]
fn check_takes_several_files() {
    let folder = folder("first_check");
    let broken = file(&folder, "broken.urdf", "<robot name='a'><link/></robot>");
    let output = mozzi(&["check", "ur5", &broken, "panda"]);
    let said = String::from_utf8(output.stderr).expect("text");
    assert!(output.status.code() == Some(1) && said.contains("2 of 3 robots are valid"), "{said}");
    assert!(mozzi(&["check", "ur5", "panda"]).status.success());
    let output = mozzi(&["check", "ur5", &broken, "--format", "sarif"]);
    let log: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert!(output.status.code() == Some(1) && !log["runs"][0]["results"].as_array().expect("a list").is_empty());
}

#[test]
fn findings_about_one_element_are_one_block() {
    let folder = folder("first_blocks");
    let link = |name: &str| {
        format!(
            "<link name='{name}'><inertial><mass value='1'/>\n<inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/>\n\
             </inertial></link>"
        )
    };
    // two attributes of one element that URDF does not have, and one of another line
    let text = format!(
        "<robot name='a'>{}{}<joint name='j' type='revolute'>\n<limit lower='-1' upper='1' effort='1' velocity='1' gain='2' \
         offset='3'/>\n<axis xyz='0 0 1' colour='red'/>\n<parent link='b'/><child link='c'/></joint></robot>",
        link("b"),
        link("c")
    );
    let robot = file(&folder, "robot.urdf", &text);
    let said = String::from_utf8(mozzi(&["check", &robot]).stderr).expect("text");
    assert!(said.contains("`gain`") && said.contains("also: ") && said.contains("`offset`"), "{said}");
    assert_eq!(said.matches("warning").count() - said.matches("warnings").count(), 2, "{said}");
    let lines = String::from_utf8(mozzi(&["check", &robot, "--json"]).stdout).expect("text");
    assert_eq!(lines.lines().count(), 3, "{lines}");
}
