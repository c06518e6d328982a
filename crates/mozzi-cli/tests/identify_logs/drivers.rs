//! Names and clocks of further drivers and programs.

use super::motion::clean;
use super::{OWN, Same, Variants, Words, joined, with};

#[test]
fn names_of_further_drivers_are_read() {
    let mut v = Variants::new("identify_logs_drivers");
    let m = clean();
    for (name, header) in [
        ("mujoco.csv", "time,qpos_0,qpos_1,qvel_0,qvel_1,qfrc_actuator_0,qfrc_actuator_1"),
        ("isaac.csv", "time,dof_pos_0,dof_pos_1,dof_vel_0,dof_vel_1,applied_torque_0,applied_torque_1"),
        (
            "actuators.csv",
            "t,actuators[0].position,actuators[1].position,actuators[0].velocity,actuators[1].velocity,\
         actuators[0].torque,actuators[1].torque",
        ),
        (
            "unitree.csv",
            "t,/lowstate/motor_state[0]/q,/lowstate/motor_state[1]/q,/lowstate/motor_state[0]/dq,\
         /lowstate/motor_state[1]/dq,/lowstate/motor_state[0]/tau_est,/lowstate/motor_state[1]/tau_est",
        ),
        ("subscripts.csv", "t,q₁,q₂,q̇₁,q̇₂,τ₁,τ₂"),
        ("german.csv", "Zeit [s],q_ist_1,q_ist_2,qd_ist_1,qd_ist_2,tau_ist_1,tau_ist_2"),
        ("seconds.csv", "seconds,q1,q2,qd1,qd2,tau1,tau2"),
    ] {
        v.check(name, m.table(header, ","), &[], &Same);
    }
    let degrees = clean().map(|_, q, v, _| [q, v].into_iter().flatten().for_each(|x| *x = x.to_degrees()));
    let kinova = "t,position_deg_0,position_deg_1,velocity_deg_s_0,velocity_deg_s_1,torque_0,torque_1";
    v.check("kinova.csv", degrees.table(kinova, ","), &[], &Same);
    let imperial = clean().map(|_, _, _, tau| tau.iter_mut().for_each(|x| *x /= 0.112_984_829));
    v.check("imperial.csv", imperial.table("t,q1,q2,qd1,qd2,tau1 [lbf in],tau2 [lbf in]", ","), &[], &Same);
    v.check(
        "stones.csv",
        m.table("t,q1,q2,qd1,qd2,tau1 [st ft],tau2 [st ft]", ","),
        &[],
        &Words(&["the unit `st ft` is not known"]),
    );
    let gravity = m.table("t,q1,q2,qd1,qd2,tau_gravity_1,tau_gravity_2", ",");
    v.check("gravity.csv", gravity, &[], &Words(&["no forces"]));
    let fri = "time_stamp_sec,time_stamp_nano_sec,measured_joint_position[0],measured_joint_position[1],\
               measured_joint_velocity[0],measured_joint_velocity[1],measured_torque[0],measured_torque[1]";
    let rows = with(fri, |_, x| {
        let nanoseconds = (x[0] * 1e9).round() as u64;
        format!(
            "{},{},{}",
            1_714_521_600 + nanoseconds / 1_000_000_000,
            nanoseconds % 1_000_000_000,
            joined(&x[1..], ",")
        )
    });
    v.check("fri.csv", rows, &[], &Same);
    // what belongs to no joint: a gripper, an inertial sensor, a force sensor without moments
    let more = "t,q0,q1,q2,qd0,qd1,qd2,tau0,tau1,tau2,acc_x,acc_y,acc_z,f_x,f_y,f_z";
    let rows = with(more, |_, x| {
        let [t, q0, q1, v0, v1, a, b] = x else { unreachable!() };
        format!("{t:.9},{q0:.9},{q1:.9},0.04,{v0:.9},{v1:.9},0,{a:.9},{b:.9},0,0.1,0.2,9.8,1,2,3")
    });
    v.check("gripper.csv", &rows, &[], &Words(&["more than the robot has joints", "--order 0,1 takes these"]));
    v.check("gripper_left_out.csv", &rows, &["--order", "0,1"], &Same);
    // a driver that fills accelerations with zeros
    let rows = with(&format!("{OWN},ddtheta_1,ddtheta_2"), |_, x| format!("{},0,0", joined(x, ",")));
    v.check("zeros.csv", rows, &[], &Same);
    v.end(15);
}

#[test]
fn clocks_of_further_programs_are_read() {
    let mut v = Variants::new("identify_logs_clocks");
    let at = |seconds: &dyn Fn(f64) -> String| {
        with(&OWN.replacen('t', "time", 1), |_, x| format!("{},{}", seconds(x[0]), joined(&x[1..], ",")))
    };
    v.check("matlab.csv", at(&|t| format!("15-Mar-2024 10:22:{t:09.6}")), &[], &Same);
    v.check("compact.csv", at(&|t| format!("20240315T1022{t:09.6}")), &[], &Same);
    v.check("twelve.csv", at(&|t| format!("03/15/2024 10:22:{t:09.6} PM")), &[], &Same);
    v.check(
        "labview.csv",
        at(&|t| format!("10:22:{:02}:{:03}", t as u32, (t * 1e3).round() as u32 % 1000)),
        &[],
        &Same,
    );
    v.check("ambiguous.csv", at(&|t| format!("03/04/2024 10:22:{t:09.6}")), &[], &Words(&["month or the day"]));
    // a count of rows in place of the time
    let counted = clean().timed(|t| (100.0 * t).round() / 25.0);
    v.check("counter.csv", counted.table(OWN, ","), &[], &Words(&["the same for all joints", "count of rows"]));
    // a turn in degrees
    let wrapped = clean().map(|_, q, v, _| {
        q.iter_mut().for_each(|x| *x = x.to_degrees().rem_euclid(360.0));
        v.iter_mut().for_each(|x| *x = x.to_degrees());
    });
    v.check("turns.csv", wrapped.table(OWN, ","), &[], &Words(&["degrees"]));
    v.check("log.csv", b"\xfd7zXZ\0 and more", &[], &Words(&["compressed by xz"]));
    v.end(8);
}
