//! `mozzi identify` with forty variants of one log: each is fitted as well as the clean log, or refused with a sentence
//! that names the cause.

mod bags;
mod commands;
mod drivers;
mod mimic;
mod motion;
mod readers;

use crate::common;
use common::{file, folder, mozzi};
use motion::{ROBOT, clean};
use serde_json::Value;
use std::fmt::Write;
use std::path::Path;

/// The mass parameters that the log determines, and how well it is predicted.
fn result(log: &str, flags: &[&str]) -> Result<(Vec<f64>, f64), String> {
    let output = mozzi(&[&["identify", ROBOT, log, "--json"], flags].concat());
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into_owned());
    }
    let found: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let base = found["base_parameters"].as_array().expect("a list").iter();
    let values = base.map(|one| one["value"].as_f64().expect("a number")).collect();
    Ok((values, found["verdict"]["nrms"].as_f64().expect("a number")))
}

/// What is expected of a variant.
enum Expected {
    /// As the clean log within 2 %.
    Same,
    /// Refused with these words.
    Words(&'static [&'static str]),
}
use Expected::{Same, Words};

struct Variants {
    folder: std::path::PathBuf,
    clean: Vec<f64>,
    wrong: Vec<String>,
    count: usize,
}

impl Variants {
    fn new(name: &str) -> Self {
        let folder = folder(name);
        let log = file(&folder, "clean.csv", &clean().table(OWN, ","));
        let (clean, nrms) = result(&log, &[]).expect("the clean log");
        assert!(nrms < 0.02, "{nrms}");
        Variants { folder, clean, wrong: Vec::new(), count: 0 }
    }

    fn check(&mut self, name: &str, content: impl AsRef<[u8]>, flags: &[&str], expected: &Expected) {
        let path = self.folder.join(name);
        std::fs::write(&path, content).expect("a file");
        self.check_file(path.to_str().expect("text"), flags, expected);
    }

    fn check_file(&mut self, path: &str, flags: &[&str], expected: &Expected) {
        self.count += 1;
        let largest = self.clean.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let complaint = match (result(path, flags), expected) {
            (Ok((values, nrms)), Same) => {
                let apart = values.iter().zip(&self.clean).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / largest;
                (apart > 0.02 || nrms > 0.03)
                    .then(|| format!("{:.2} % apart, NRMS {:.2} %", 100.0 * apart, 100.0 * nrms))
            }
            (Err(why), Same) => Some(why),
            (Ok((_, nrms)), Words(_)) => Some(format!("accepted, NRMS {:.2} %", 100.0 * nrms)),
            (Err(why), Words(words)) => {
                let lacks = words.iter().any(|word| !why.to_lowercase().contains(&word.to_lowercase()));
                lacks.then(|| format!("expected {words:?}: {why}"))
            }
        };
        let name = Path::new(path).file_name().unwrap_or_default().to_string_lossy();
        self.wrong.extend(complaint.map(|complaint| format!("{name}: {complaint}")));
    }

    fn end(self, least: usize) {
        assert!(self.count >= least, "{} variants", self.count);
        println!("{} variants, {} wrong", self.count, self.wrong.len());
        assert!(self.wrong.is_empty(), "{} of {} wrong:\n{}", self.wrong.len(), self.count, self.wrong.join("\n"));
    }
}

const OWN: &str = "t,theta_1,theta_2,dtheta_1,dtheta_2,tau_1,tau_2";

/// The clean table with further text columns before, after or between.
fn with(header: &str, row: impl Fn(usize, &[f64]) -> String) -> String {
    let motion = clean();
    let mut text = header.to_string() + "\n";
    for k in 0..motion.t.len() {
        let all = [&[motion.t[k]][..], &motion.theta[k], &motion.dtheta[k], &motion.tau[k]].concat();
        writeln!(text, "{}", row(k, &all)).expect("text");
    }
    text
}

fn joined(x: &[f64], separator: &str) -> String {
    x.iter().map(|x| format!("{x:.9}")).collect::<Vec<_>>().join(separator)
}

#[test]
fn headers_and_formats_of_drivers_are_read() {
    let mut v = Variants::new("identify_logs_formats");
    let m = clean();
    let epoch = 1_714_521_600.0;
    v.check("zero_based.csv", m.table("timestamp,q_0,q_1,qd_0,qd_1,tau_0,tau_1", ","), &[], &Same);
    let rtde = "timestamp actual_q_0 actual_q_1 actual_qd_0 actual_qd_1 target_moment_0 target_moment_1";
    v.check("rtde.csv", m.table(rtde, " "), &[], &Same);
    let rtde = "timestamp;target_q_0;target_q_1;actual_q_0;actual_q_1;actual_qd_0;actual_qd_1;actual_current_0;\
                actual_current_1;target_moment_0;target_moment_1;actual_TCP_force_0;actual_TCP_force_1;robot_mode";
    let all = with(rtde, |_, x| {
        let [t, q0, q1, v0, v1, a, b] = x else { unreachable!() };
        format!(
            "{t:.6};{:.6};{:.6};{q0:.9};{q1:.9};{v0:.9};{v1:.9};{:.6};{:.6};{a:.9};{b:.9};1;2;7",
            q0 + 0.01,
            q1 - 0.01,
            a / 9.0,
            b / 7.0
        )
    });
    v.check("rtde_all.csv", all, &[], &Same);
    let current = "timestamp,actual_q_0,actual_q_1,actual_qd_0,actual_qd_1,actual_current_0,actual_current_1";
    v.check("rtde_current.csv", m.table(current, ","), &[], &Words(&["current", "--torque current"]));
    let franka = "duration, state.q[0], state.q[1], state.dq[0], state.dq[1], state.tau_J[0], state.tau_J[1], \
                  state.q_d[0], state.q_d[1], state.tau_ext_hat_filtered[0], state.tau_ext_hat_filtered[1]";
    let rows = with(franka, |_, x| format!("{:.3}, {}, 0, 0, 0, 0", 1000.0 * x[0], joined(&x[1..], ", ")));
    v.check("franka.csv", rows, &[], &Same);
    v.check("brackets.csv", m.table("time,q[0],q[1],dq[0],dq[1],tau_J[0],tau_J[1]", ","), &[], &Same);
    let juggler = "__time,/joint_states/joint2/position,/joint_states/joint1/position,/joint_states/joint2/velocity,\
                   /joint_states/joint1/velocity,/joint_states/joint2/effort,/joint_states/joint1/effort";
    let rows =
        with(juggler, |_, x| format!("{:.9},{}", epoch + x[0], joined(&[x[2], x[1], x[4], x[3], x[6], x[5]], ",")));
    v.check("plotjuggler.csv", rows, &[], &Same);
    let index = "__time,/joint_states/position[0],/joint_states/position[1],/joint_states/velocity[0],\
                 /joint_states/velocity[1],/joint_states/effort[0],/joint_states/effort[1]";
    v.check("plotjuggler_index.csv", m.clone().timed(|t| epoch + t).table(index, ","), &[], &Same);
    let rows = with(&(juggler.to_string() + ",/imu/temperature"), |_, x| {
        let all = joined(&[x[2], x[1], x[4], x[3], x[6], x[5]], ",");
        format!("{:.9},{all},\n{:.9},,,,,,,21.5", epoch + x[0], epoch + x[0] + 0.004)
    });
    v.check("plotjuggler_sparse.csv", rows, &[], &Same);
    let rostopic = "%time,field.header.seq,field.header.stamp,field.header.frame_id,field.name0,field.name1,\
                    field.position0,field.position1,field.velocity0,field.velocity1,field.effort0,field.effort1";
    let rows = with(rostopic, |k, x| {
        let stamp = 1_714_521_600_000_000_000_u64 + (x[0] * 1e9).round() as u64;
        let swapped = joined(&[x[2], x[1], x[4], x[3], x[6], x[5]], ",");
        format!("{},{k},{stamp},,joint2,joint1,{swapped}", stamp + 123_456)
    });
    v.check("rostopic.csv", rows, &[], &Same);
    let bagpy = "Time,header.seq,header.stamp.secs,header.stamp.nsecs,header.frame_id,name_0,name_1,position_0,position_1,\
                 velocity_0,velocity_1,effort_0,effort_1";
    let rows = with(bagpy, |k, x| {
        let nanoseconds = (x[0] * 1e9).round() as u64;
        let (s, ns) = (1_714_521_600 + nanoseconds / 1_000_000_000, nanoseconds % 1_000_000_000);
        format!("{:.6},{k},{s},{ns},,joint1,joint2,{}", epoch + x[0] + 0.001, joined(&x[1..], ","))
    });
    v.check("bagpy.csv", rows, &[], &Same);
    let listed = "Time,name,position_0,position_1,velocity_0,velocity_1,effort_0,effort_1";
    let rows = with(listed, |_, x| {
        let swapped = joined(&[x[2], x[1], x[4], x[3], x[6], x[5]], ",");
        format!("{:.6},\"['joint2', 'joint1']\",{swapped}", epoch + x[0])
    });
    v.check("bagpy_listed.csv", rows, &[], &Same);
    let rows = with("Time,position,velocity,effort", |_, x| {
        format!(
            "{:.6},\"[{}]\",\"[{}]\",\"[{}]\"",
            x[0],
            joined(&x[1..3], ", "),
            joined(&x[3..5], ", "),
            joined(&x[5..], ", ")
        )
    });
    v.check("lists.csv", rows, &[], &Same);
    v.check("pandas.csv", with(&format!(",{OWN}"), |k, x| format!("{k},{}", joined(x, ","))), &[], &Same);
    let iso = with(&OWN.replacen('t', "timestamp", 1), |_, x| {
        format!("2024-05-01T12:00:{:09.6}Z,{}", x[0], joined(&x[1..], ","))
    });
    v.check("iso.csv", iso, &[], &Same);
    let iso =
        with(&OWN.replacen('t', "", 1), |_, x| format!("2024-05-01 12:00:{:09.6},{}", x[0], joined(&x[1..], ",")));
    v.check("pandas_dates.csv", iso, &[], &Same);
    v.check("numpy.csv", m.cells(&format!("# {OWN}"), ",", &|x| format!("{x:.18e}")), &[], &Same);
    v.check(
        "numpy_blanks.txt",
        m.cells(&format!("# {}", OWN.replace(',', " ")), " ", &|x| format!("{x:.18e}")),
        &[],
        &Same,
    );
    let units = format!("{}\ns;rad;rad;rad/s;rad/s;N m;N m", OWN.replace(',', ";"));
    v.check("units.csv", m.table(&units, ";"), &[], &Same);
    let degrees = clean().map(|_, q, v, _| {
        [q, v].into_iter().flatten().for_each(|x| *x = x.to_degrees());
    });
    let units = format!("{}\ns,deg,deg,deg/s,deg/s,Nm,Nm", OWN);
    v.check("units_deg.csv", degrees.table(&units, ","), &[], &Same);
    let named = "Time [s],Joint 1 Position [deg],Joint 2 Position [deg],Joint 1 Velocity [deg/s],Joint 2 Velocity [deg/s],\
                 Joint 1 Torque [Nm],Joint 2 Torque [Nm]";
    v.check("excel.csv", degrees.table(named, ","), &[], &Same);
    let comma = |x: f64| format!("{x:.9}").replace('.', ",");
    v.check("decimal_commas.csv", m.cells(&OWN.replace(',', ";"), ";", &comma), &[], &Same);
    v.check("decimal_commas_tab.txt", m.cells(&OWN.replace(',', "\t"), "\t", &comma), &[], &Same);
    v.check("commas_twice.csv", m.cells(OWN, ",", &comma), &[], &Words(&["decimal commas"]));
    v.check("tab.tsv", m.table(&OWN.replace(',', "\t"), "\t"), &[], &Same);
    let text = with(&format!("{OWN},mode,is_moving"), |k, x| format!("{},auto,{}", joined(x, ","), k % 2 == 0));
    v.check("text.csv", text, &[], &Same);
    let names = OWN.replace("_1", "_shoulder").replace("_2", "_elbow");
    v.check("foreign.csv", m.table(&names, ","), &[], &Words(&["--order shoulder,elbow"]));
    v.check("ordered.csv", m.table(&names, ","), &["--order", "shoulder,elbow"], &Same);
    let names = OWN.replace("_1", "_left_joint1").replace("_2", "_left_joint2");
    v.check("suffix.csv", m.table(&names, ","), &[], &Same);
    let twice = format!("{OWN},effort_joint1");
    v.check(
        "twice.csv",
        with(&twice, |_, x| format!("{},5", joined(x, ","))),
        &[],
        &Words(&["tau_1", "effort_joint1"]),
    );
    v.check(
        "no_header.csv",
        m.table(OWN, ",").split_once('\n').expect("rows").1,
        &[],
        &Words(&["first line holds numbers"]),
    );
    v.check("log.bag", b"#ROSBAG V2.0\n\x45\0\0\0", &[], &Words(&["ROS 1", "rosbags-convert"]));
    v.check("log.mat", b"MATLAB 5.0 MAT-file, Platform: GLNXA64", &[], &Words(&["MATLAB", "writetable"]));
    v.check("log.h5", b"\x89HDF\r\n\x1a\n and more", &[], &Words(&["HDF5", "csv"]));
    let three = "t,q_0,q_1,q_2,tau_0,tau_1,tau_2";
    v.check("three.csv", with(three, |_, x| joined(x, ",")), &[], &Words(&["neither from 0 nor from 1"]));
    let whole = m.table(OWN, ",");
    v.check("cut.csv", &whole[..whole.len() - 20], &[], &Same);
    v.end(34);
}

#[test]
fn faults_of_logs_are_mended_or_named() {
    let mut v = Variants::new("identify_logs_faults");
    let m = clean;
    v.check("milliseconds.csv", m().timed(|t| 1e3 * t).table(OWN, ","), &[], &Same);
    v.check("microseconds.csv", m().timed(|t| 1e6 * t).table(OWN, ","), &[], &Same);
    v.check("nanoseconds.csv", m().timed(|t| 1e9 * t + 5e9).table(OWN, ","), &[], &Same);
    let six = |x: f64| format!("{}", format!("{x:.5e}").parse::<f64>().expect("a number"));
    let coarse = |start: f64| {
        let mut text = OWN.to_string() + "\n";
        let m = clean();
        for k in 0..m.t.len() {
            let all = [m.theta[k], m.dtheta[k], m.tau[k]].concat();
            writeln!(text, "{},{}", six(start + m.t[k]), joined(&all, ",")).expect("text");
        }
        text
    };
    v.check("six_digits.csv", coarse(1.7e9), &[], &Words(&["six digits"]));
    v.check("six_digits_uptime.csv", coarse(1234.5), &[], &Same);
    let wrap = |x: f64| (x + std::f64::consts::PI).rem_euclid(std::f64::consts::TAU) - std::f64::consts::PI;
    let turned = m().map(|_, q, _, _| q.iter_mut().for_each(|x| *x = wrap(*x + 2.0 * std::f64::consts::TAU)));
    v.check("wrapped.csv", turned.table(OWN, ","), &[], &Same);
    let outs = m().map(|k, q, v, tau| {
        if k % 97 == 40 || k % 211 == 3 {
            [q, v, tau].into_iter().flatten().for_each(|x| *x = 0.0);
        }
    });
    v.check("drop_outs.csv", outs.table(OWN, ","), &[], &Same);
    let desired = m().map({
        let all = clean();
        move |k, _, v, _| *v = all.dtheta[(k + 12).min(all.t.len() - 1)]
    });
    v.check("desired.csv", desired.table(OWN, ","), &[], &Words(&["desired", "velocity"]));
    v.check(
        "velocities_swapped.csv",
        m().map(|_, _, v, _| v.swap(0, 1)).table(OWN, ","),
        &[],
        &Words(&["velocity", "joint"]),
    );
    v.check(
        "velocity_and_torque.csv",
        m().map(|_, _, v, tau| std::mem::swap(v, tau)).table(OWN, ","),
        &[],
        &Words(&["swapped"]),
    );
    let amperes = m().map(|_, _, _, tau| (tau[0], tau[1]) = (tau[0] / 11.0, tau[1] / 9.0));
    v.check("amperes.csv", amperes.table(OWN, ","), &[], &Words(&["current"]));
    let rated = m().map(|_, _, _, tau| (tau[0], tau[1]) = (tau[0] / 0.02, tau[1] / 0.005));
    v.check("per_mille.csv", rated.table(OWN, ","), &[], &Words(&["per mille"]));
    let motor = m().map(|_, _, _, tau| (tau[0], tau[1]) = (tau[0] / 100.0, tau[1] / 50.0));
    v.check("motor_side.csv", motor.table(OWN, ","), &[], &Words(&["motor side", "gear"]));
    v.check(
        "millinewton.csv",
        m().map(|_, _, _, tau| tau.iter_mut().for_each(|x| *x *= 1e3)).table(OWN, ","),
        &[],
        &Words(&["mN m"]),
    );
    v.check(
        "force_sign.csv",
        m().map(|_, _, _, tau| tau[1] = -tau[1]).table(OWN, ","),
        &[],
        &Words(&["opposite sign", "joint2"]),
    );
    v.check(
        "joint_sign.csv",
        m().map(|_, q, v, _| (q[0], v[0]) = (-q[0], -v[0])).table(OWN, ","),
        &[],
        &Words(&["opposite sign"]),
    );
    v.check(
        "velocity_sign.csv",
        m().map(|_, _, v, _| v[0] = -v[0]).table(OWN, ","),
        &[],
        &Words(&["opposite sign", "joint1"]),
    );
    let degrees = m().map(|_, q, v, _| [q, v].into_iter().flatten().for_each(|x| *x = x.to_degrees()));
    v.check("degrees.csv", degrees.table(OWN, ","), &[], &Words(&["degrees"]));
    let mixed = m().map(|_, q, _, _| q.iter_mut().for_each(|x| *x = x.to_degrees()));
    v.check("degrees_mixed.csv", mixed.table(OWN, ","), &[], &Words(&["degrees"]));
    let swapped = m().map(|_, q, v, tau| {
        q.swap(0, 1);
        v.swap(0, 1);
        tau.swap(0, 1);
    });
    v.check("joints.csv", swapped.table(OWN, ","), &[], &Words(&["swapped"]));
    v.check(
        "constant_force.csv",
        m().map(|_, _, _, tau| tau[1] = 0.0).table(OWN, ","),
        &[],
        &Words(&["constant", "joint2"]),
    );
    v.check(
        "constant_encoder.csv",
        m().map(|_, q, _, _| q[1] = 0.3).table(OWN, ","),
        &[],
        &Words(&["constant", "joint2"]),
    );
    let text = m().table(OWN, ",");
    let repeated: String = text
        .lines()
        .enumerate()
        .map(|(k, line)| if k > 0 && k % 3 == 0 { format!("{line}\n{line}\n") } else { format!("{line}\n") })
        .collect();
    v.check("repeated.csv", repeated, &[], &Same);
    let jump = m().map(|k, q, _, _| q[0] += if k > 600 { 0.7 } else { 0.0 });
    v.check("jump.csv", jump.table(OWN, ","), &[], &Words(&["jumps by", "joint1"]));
    let first = clean();
    let constant = m().map(move |_, q, v, tau| (*q, *v, *tau) = (first.theta[0], first.dtheta[0], first.tau[0]));
    v.check("constant.csv", constant.table(OWN, ","), &[], &Words(&["constant"]));
    let two = m().map(|_, q, v, tau| {
        q.swap(0, 1);
        tau.swap(0, 1);
        v.swap(0, 1);
        [q, v].into_iter().flatten().for_each(|x| *x = x.to_degrees());
    });
    v.check("two_faults.csv", two.table(OWN, ","), &[], &Words(&["no single mistake explains it"]));
    v.check("gap.csv", m().without(500..506).table(OWN, ","), &[], &Same);
    v.end(24);
}
