//! Columns `wrench_FRAME_m_x` … of a table are wrenches of that frame.

use crate::common;

use common::{assert_close, complaint, file, folder, json, numbers, rows};

#[test]
fn a_frames_wrench_has_six_columns() {
    let folder = folder("wrench_columns");
    let names = ["m_x", "m_y", "m_z", "f_x", "f_y", "f_z"].map(|entry| format!("wrench_rod1_{entry}")).join(",");
    let table = file(&folder, "states.csv", &format!("theta_1,theta_2,{names}\n0.3,0.4,0.1,0.2,0.3,1,2,3\n"));
    let of_file = json(&["compute", "double_pendulum", "tip-forces", "--in", &table]);
    let flag = "rod1=0.1,0.2,0.3,1,2,3";
    let of_flag = json(&["compute", "double_pendulum", "tip-forces", "--theta", "0.3,0.4", "--wrench", flag]);
    assert_close(&rows(&of_file["tau"])[0], &numbers(&of_flag["tau"]), 1e-15);
    let refused = |name: &str, header: &str| {
        let table = file(&folder, name, &format!("theta_1,theta_2,{header}\n0.3,0.4,0.1,0.2,0.3,1,2,3\n"));
        complaint(&["compute", "double_pendulum", "tip-forces", "--in", &table]).1
    };
    let why = refused("missing.csv", &names.replace("wrench_rod1_f_y", "tau_1"));
    assert!(why.contains("missing"), "{why}");
    let why = refused("toe.csv", &names.replace("rod1", "toe"));
    assert!(why.contains("`wrench_toe`") && why.contains("toe"), "{why}");
    let why = refused("twice.csv", &names.replace("f_y", "f_x"));
    assert!(why.contains("columns 6 and 7 both give `wrench_rod1_f_x`"), "{why}");
}
