//! Columns, cells and times as programs write them: read by every command in the same way, or refused with a remedy.

use super::motion::{ROBOT, clean};
use super::{OWN, Same, Variants, Words, joined, with};
use crate::common::{complaint, file, folder, json, mozzi, numbers};
use std::path::Path;

/// Names of joints in the columns.
const JOINTS: &str = "t,theta_joint1,theta_joint2,dtheta_joint1,dtheta_joint2,tau_joint1,tau_joint2";

/// Standard error of a command.
fn notes(arguments: &[&str]) -> String {
    let output = mozzi(arguments);
    let notes = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{arguments:?}: {notes}");
    notes
}

/// The clean table without a column.
fn without(column: usize) -> String {
    let left = |cells: &[&str]| {
        cells.iter().enumerate().filter(|(k, _)| *k != column).map(|(_, cell)| *cell).collect::<Vec<_>>().join(",")
    };
    let header: Vec<&str> = JOINTS.split(',').collect();
    with(&left(&header), |_, x| {
        let cells: Vec<String> = x.iter().map(|x| format!("{x:.9}")).collect();
        left(&cells.iter().map(String::as_str).collect::<Vec<_>>())
    })
}

#[test]
fn a_missing_column_is_named_as_the_log_would() {
    let mut v = Variants::new("identify_logs_missing");
    const LOCK: &str = "--lock joint2=POSITION";
    v.check("force.csv", without(6), &[], &Words(&["column tau_joint2 is missing", "did not move", LOCK]));
    v.check("velocity.csv", without(4), &[], &Words(&["column dtheta_joint2 is missing", "are differentiated"]));
    v.check("position.csv", without(2), &[], &Words(&["column theta_joint2 is missing", LOCK]));
    let named = with("t,q1,q2,qd1,qd2,tau1", |_, x| joined(&x[..6], ","));
    v.check("number.csv", named, &[], &Words(&["column tau2 is missing, the force of joint2"]));
    let moving = &["--lock", "joint2=0.3"];
    let words = &["--lock joint2: its position (`theta_joint2`) is between", "expected a joint that does not move"];
    v.check("locked.csv", clean().table(JOINTS, ","), moving, &Words(words));
    v.check("locked_force.csv", without(6), moving, &Words(&["--lock joint2: its position"]));
    v.end(6);
}

#[test]
fn every_command_reads_times_alike() {
    let folder = folder("identify_logs_times");
    let out = |name: &str| folder.join(name).to_string_lossy().into_owned();
    let shown = |log: &str| {
        let svg = out("plot.svg");
        let plot = notes(&["plot", "trajectory", ROBOT, log, "--out", &svg]);
        let view = notes(&["view", ROBOT, log, "--out", &out("page.html")]);
        let follow = ["simulate", ROBOT, "--follow", log, "--controller", "computed-torque", "--step", "0.02", "--out"];
        let followed = notes(&[&follow[..], &[&out("followed.csv")]].concat());
        (plot, view, followed, std::fs::read_to_string(out("followed.csv")).expect("a table"))
    };
    let m = clean;
    let seconds = file(&folder, "seconds.csv", &m().table(OWN, ","));
    let (.., expected) = shown(&seconds);
    let last = |table: &str| -> Vec<f64> {
        let row = table.lines().last().expect("a row").split(',').take(3);
        row.map(|cell| cell.parse().expect("a number")).collect()
    };
    for (name, scale, start, words) in [
        ("ms.csv", 1e3, 0.0, "times are taken as ms and converted to s"),
        ("ns.csv", 1e9, 5e9, "times are taken as ns and converted to s"),
        ("late.csv", 1.0, 14362.004, "times are counted from the first row, t = 14362.004 s"),
    ] {
        let log = file(&folder, name, &m().timed(|t| scale * t + start).table(OWN, ","));
        let (plot, view, followed, table) = shown(&log);
        for said in [plot, view, followed] {
            assert!(said.contains(words), "{name}: {said}");
        }
        let apart = last(&table).iter().zip(last(&expected)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(apart < 1e-3, "{name}: {apart}");
    }
    // positions alone at whole seconds are slow, not in ms
    let slow = "t,theta_1,theta_2\n".to_string()
        + &(0..200).map(|k| format!("{k},{},0\n", 0.1 * f64::from(k))).collect::<String>();
    let slow = file(&folder, "slow.csv", &slow);
    let said = notes(&["plot", "trajectory", ROBOT, &slow, "--out", &out("slow.svg")]);
    assert!(!said.contains("converted"), "{said}");
    // rows that are cut off, lack numbers or are repeated
    let whole = m().table(OWN, ",");
    let mut lines: Vec<&str> = whole.lines().collect();
    lines.insert(700, lines[699]);
    let cells: Vec<&str> = lines[500].split(',').collect();
    let lacking = format!("{},nan,{}", cells[0], cells[2..].join(","));
    lines[500] = &lacking;
    let worn = file(&folder, "worn.csv", &(lines.join("\n") + "\n12.0,0.3"));
    let (plot, ..) = shown(&worn);
    for words in ["the last row is cut off", "1 of 1201 rows lack numbers or hold NaN, first ", "1 of 1201 rows repeat"]
    {
        assert!(plot.contains(words), "{words}: {plot}");
    }
}

#[test]
fn times_that_do_not_increase_are_explained() {
    let mut v = Variants::new("identify_logs_order");
    let changed = |change: &dyn Fn(&mut Vec<f64>)| {
        let mut m = clean();
        change(&mut m.t);
        m.table(OWN, ",")
    };
    let again = changed(&|t| t[600..].iter_mut().for_each(|t| *t -= 6.0));
    v.check("again.csv", &again, &[], &Words(&["row 600", "after 5.99 s", "two logs", "split it here"]));
    v.check("back.csv", changed(&|t| t[600] = 3.0), &[], &Words(&["row 600", "out of order", "delete it"]));
    v.check("equal.csv", changed(&|t| t[600] = t[599]), &[], &Words(&["row 600", "log more digits"]));
    let swapped = changed(&|t| (1..20).for_each(|k| t.swap(10 * k, 10 * k + 1)));
    v.check("swapped.csv", swapped, &[], &Words(&["out of order in 19 places", "sort them by time"]));
    let equal = changed(&|t| t.fill(1.7e9));
    v.check("six_digits.csv", &equal, &[], &Words(&["t is 1700000000 s", "steps of 10000 s", "log more digits"]));
    let flags = &["--trust-log"];
    v.check("six_digits.csv", &equal, flags, &Words(&["log more digits"]));
    let log = file(&v.folder, "plotted.csv", &again);
    let why = complaint(&["plot", "trajectory", ROBOT, &log, "--out", "x.svg"]).1;
    assert!(why.contains("plotted.csv:602: t is 0 after 5.99") && why.contains("two logs"), "{why}");
    v.end(6);
}

#[test]
fn cells_and_lines_of_programs_are_read() {
    let mut v = Variants::new("identify_logs_cells");
    let m = clean;
    let list = |x: &[f64], begin: &str, separator: &str, end: &str| format!("\"{begin}{}{end}\"", joined(x, separator));
    for (name, begin, separator, end) in
        [("numpy.csv", "[ ", " ", "]"), ("broken.csv", "[", "\n ", "]"), ("array.csv", "array('d', [", ", ", "])")]
    {
        let of = |x: &[f64]| list(x, begin, separator, end);
        let rows = with("t,q,dq,tau", |_, x| format!("{},{},{},{}", x[0], of(&x[1..3]), of(&x[3..5]), of(&x[5..])));
        v.check(name, rows, &[], &Same);
    }
    let rows = with("Time,name,position,velocity,effort", |_, x| {
        let of = |a: f64, b: f64| list(&[a, b], "(", ", ", ")");
        format!("{},\"['joint2', 'joint1']\",{},{},{}", x[0], of(x[2], x[1]), of(x[4], x[3]), of(x[6], x[5]))
    });
    v.check("named.csv", rows, &[], &Same);
    let uneven = m().table("t,a,b,c,d,e,f", ",").lines().map(str::to_string).collect::<Vec<_>>();
    let rows = uneven.iter().enumerate().map(|(k, line)| match k {
        0 => "t,q,tau\n".to_string(),
        70 => "0.69,[1],[1 2]\n".to_string(),
        _ => {
            let x: Vec<&str> = line.split(',').collect();
            format!("{},[{} {}],[{} {}]\n", x[0], x[1], x[2], x[5], x[6])
        }
    });
    v.check("uneven.csv", rows.collect::<String>(), &[], &Words(&["uneven.csv:71: column 2 (`q[0]`) is `[1]`"]));
    let dots = "t,θ_1,θ_2,θ\u{307}_1,θ\u{307}_2,τ_1,τ_2";
    v.check("dots.csv", m().table(dots, ","), &[], &Same);
    let degrees = m().map(|_, q, v, _| [q, v].into_iter().flatten().for_each(|x| *x = x.to_degrees()));
    let names = "t,q_0_deg,q_1_deg,qd_0_deg,qd_1_deg,tau_0,tau_1";
    v.check("rates_deg.csv", degrees.table(names, ","), &[], &Same);
    let stamped = format!("__time,{},/js/header/stamp/sec", &OWN[2..]);
    let rows =
        with(&stamped, |_, x| format!("{:.9},{},{:.0}", 1.7e9 + x[0], joined(&x[1..], ","), 1.7e9 + x[0].floor()));
    v.check("seconds_of_stamp.csv", rows, &[], &Same);
    v.check("returns.csv", m().table(OWN, ",").replace('\n', "\r"), &[], &Same);
    let mut lines: Vec<String> = m().table(OWN, ",").lines().map(str::to_string).collect();
    lines.insert(400, OWN.to_string());
    v.check("header_twice.csv", lines.join("\n"), &[], &Same);
    let dates = with(OWN, |_, x| format!("03/01/2024 12:00:{:09.6},{}", x[0], joined(&x[1..], ",")));
    v.check("dates.csv", dates, &[], &Words(&["may be the month or the day", "2024-03-01T12:59"]));
    let wide = (0..30_000).map(|k| format!("a{k}")).collect::<Vec<_>>().join(",") + "\n";
    v.check("wide.csv", wide + "1,2\n", &[], &Words(&["30000 columns, expected at most 20000"]));
    v.end(12);
}

#[test]
fn json_is_named_by_every_command() {
    let folder = folder("identify_logs_json");
    for (name, text, remedy) in [
        ("lines.jsonl", "{\"t\": 0, \"q1\": 1}\n{\"t\": 1, \"q1\": 1}\n", ", lines=True).to_csv("),
        ("array.json", " [ {\"t\": 0, \"q1\": 1},\n {\"t\": 1, \"q1\": 1}]", "array.json\").to_csv("),
    ] {
        let log = file(&folder, name, text);
        let x = folder.join("x.svg").to_string_lossy().into_owned();
        for arguments in [
            &["identify", ROBOT, &log][..],
            &["plot", "trajectory", ROBOT, &log, "--out", &x],
            &["compute", ROBOT, "mass-matrix", "--in", &log],
            &["simulate", ROBOT, "--controller", "computed-torque", "--follow", &log],
        ] {
            let why = complaint(arguments).1;
            assert!(why.contains("is JSON, expected a table") && why.contains(remedy), "{arguments:?}: {why}");
        }
    }
}

#[test]
fn text_of_any_name_holds_states_and_names_of_joints_are_explained() {
    let folder = folder("identify_logs_names");
    let text = "t,field.name0,field.name1,field.position0,field.position1\n0,joint2,joint1,0.5,0.2\n";
    let table = file(&folder, "states.txt", text);
    let of = |flags: &[&str]| json(&[&["compute", ROBOT, "gravity-forces"], flags].concat());
    let (found, expected) = (of(&["--in", &table]), of(&["--theta", "0.2,0.5"]));
    let first = |value: &serde_json::Value| value.to_string();
    let expected = numbers(&expected["g"]);
    assert!(first(&found).contains(&format!("{}", expected[0])), "{found} {expected:?}");
    let columns = crate::common::text(&["identify", ROBOT, &table, "--columns"]);
    assert!(columns.contains("names of the joints, which give their order"), "{columns}");
    assert!(Path::new(&table).exists() && !columns.contains("unknown name"), "{columns}");
}
