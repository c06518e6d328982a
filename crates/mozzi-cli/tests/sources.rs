//! Sources of robots and tables: standard input, files named like embedded robots, tables of other programs.

use crate::common;

use common::{complaint, file, folder, json, mozzi, numbers, text};
use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};

fn piped(input: &[u8], arguments: &[&str]) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_mozzi"))
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program runs");
    let mut pipe = child.stdin.take().expect("a pipe");
    let _ = pipe.write_all(input); // an error if it is not read
    drop(pipe);
    child.wait_with_output().expect("an end")
}

const ARM: &str = "<robot name='arm'><link name='a'/>
<link name='b'><inertial><mass value='2'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial>
<visual><geometry><mesh filename='b.stl'/></geometry></visual></link>
<joint name='j' type='continuous'><parent link='a'/><child link='b'/><axis xyz='0 0 1'/></joint></robot>";
const PENDULUM: &str = "<mujoco model='p'><worldbody><body name='b'><joint name='j' axis='0 1 0'/>
<inertial pos='0 0 -1' mass='1' diaginertia='1 1 1'/></body></worldbody></mujoco>";

#[test]
fn a_robot_comes_through_a_pipe() {
    let folder = folder("piped");
    let as_json = folder.join("ur5.json");
    let as_json = as_json.to_str().expect("text");
    text(&["convert", "ur5", as_json]);
    let as_json = std::fs::read_to_string(as_json).expect("written");
    let page = folder.join("page.html");
    let page = page.to_str().expect("text");
    for (robot, name) in [(ARM, "arm"), (PENDULUM, "p"), (&as_json, "ur5"), (&format!("\u{feff}{as_json}"), "ur5")] {
        for command in [
            &["info", "-"][..],
            &["check", "-"],
            &["check", "-", "--json"],
            &["terms", "-"],
            &["compute", "-", "mass-matrix"],
            &["simulate", "-", "--time", "0.01"],
            &["view", "-", "--out", page],
        ] {
            let output = piped(robot.as_bytes(), command);
            let said = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "{command:?}: {said}");
        }
        let found: serde_json::Value =
            serde_json::from_slice(&piped(robot.as_bytes(), &["info", "-", "--json"]).stdout).expect("JSON");
        assert_eq!(found["robot"], name);
    }
    let said = String::from_utf8(piped(ARM.as_bytes(), &["view", "-", "--out", page]).stderr).expect("text");
    assert!(said.contains("standard input has no folder"), "{said}");
    let broken = piped(b"<robot name='arm'>\n<link nam='a'/></robot>", &["info", "-"]);
    let said = String::from_utf8_lossy(&broken.stderr);
    assert!(broken.status.code() == Some(1) && said.contains("standard input:2:"), "{said}");
    let twice = piped(ARM.as_bytes(), &["compute", "-", "mass-matrix", "--in", "-"]);
    let said = String::from_utf8_lossy(&twice.stderr);
    assert!(twice.status.code() == Some(1) && said.contains("standard input is the robot's file"), "{said}");
}

#[test]
fn a_file_named_like_an_embedded_robot_is_read() {
    let folder = folder("named_like");
    file(&folder, "ur5", ARM);
    std::fs::create_dir(folder.join("panda")).expect("a folder");
    let run = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_mozzi"));
        let output = command.current_dir(&folder).args(arguments).output().expect("the program runs");
        [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).expect("text"))
    };
    let [found, said] = run(&["info", "ur5"]);
    assert!(found.starts_with("arm: 1 independent joint"), "{found}");
    assert!(said.contains("note: `ur5` is a file here and an embedded robot; the file is read"), "{said}");
    let [found, said] = run(&["info", "panda"]);
    assert!(found.starts_with("panda: ") && !said.contains("embedded robot"), "{found}{said}");
}

/// Checks that the table is refused with these words.
fn refused(table: &Path, words: &[&str]) {
    let (code, said) =
        complaint(&["compute", "two_link_planar", "gravity-forces", "--in", table.to_str().expect("text")]);
    assert_eq!(code, 1, "{said}");
    words.iter().for_each(|word| assert!(said.contains(word), "{word} in {said}"));
}

#[test]
fn tables_of_other_programs_are_read_or_refused_with_a_remedy() {
    let folder = folder("other_programs");
    let path = |name: &str, text: &str| Path::new(&file(&folder, name, text)).to_path_buf();
    let read = |name: &str, content: &str| {
        let table = path(name, content);
        let output = mozzi(&["compute", "two_link_planar", "gravity-forces", "--in", table.to_str().expect("text")]);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        (output.stdout, String::from_utf8_lossy(&output.stderr).into_owned())
    };
    let (commas, note) = read("semicolon.csv", "theta_1;theta_2\n0,5;1\n");
    assert!(note.contains("decimal commas"), "{note}");
    assert_eq!(commas, read("tab.csv", "theta_1\ttheta_2\n0.5\t1\n").0);
    assert_eq!(commas, read("plain.csv", "theta_1,theta_2\n0.5,1\n").0);
    refused(&path("bare.csv", "0.5,1\n0.6,1\n"), &["bare.csv:1", "the first line holds numbers", "`theta_1,theta_2`"]);
    refused(&path("timed.csv", "0,0.5,1\n1,0.6,1\n"), &["timed.csv:1", "`t,theta_1,theta_2`"]);
    refused(&path("empty.csv", ""), &["empty.csv is empty"]);
    let zstd = folder.join("zstd.feather");
    write_zstd(&zstd);
    let remedy = "df.to_feather(file, compression=\"lz4\")";
    refused(&zstd, &["zstd.feather cannot be read: it is compressed by zstd", remedy, "df.write_ipc("]);
}

/// A table without rows, so that there is nothing to compress.
fn write_zstd(path: &Path) {
    use arrow_array::{ArrayRef, Float64Array, RecordBatch};
    use arrow_ipc::CompressionType;
    use arrow_ipc::writer::{FileWriter, IpcWriteOptions};
    let column = || -> ArrayRef { std::sync::Arc::new(Float64Array::from(Vec::<f64>::new())) };
    let batch = RecordBatch::try_from_iter([("theta_1", column()), ("theta_2", column())]).expect("columns");
    let options = IpcWriteOptions::default().try_with_compression(Some(CompressionType::ZSTD)).expect("built in");
    let file = std::fs::File::create(path).expect("a file");
    let mut writer = FileWriter::try_new_with_options(file, &batch.schema(), options).expect("a writer");
    writer.write(&batch).and_then(|()| writer.finish()).expect("written");
}

#[test]
fn integers_are_numbers() {
    let folder = folder("integers");
    let path = folder.join("states.npy");
    let header = "{'descr': '<i8', 'fortran_order': False, 'shape': (2, 2), }\n";
    let numbers_of = |numbers: [i64; 4]| numbers.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>();
    let write = |numbers: [i64; 4]| {
        let length = (header.len() as u16).to_le_bytes();
        let bytes = [b"\x93NUMPY\x01\x00", &length[..], header.as_bytes(), &numbers_of(numbers)].concat();
        std::fs::write(&path, bytes).expect("a file");
    };
    write([0, 0, 1, -2]);
    let in_file = path.to_str().expect("text");
    let found = json(&["compute", "two_link_planar", "gravity-forces", "--in", in_file]);
    let expected = json(&["compute", "two_link_planar", "gravity-forces", "--theta", "1,-2"]);
    assert_eq!(numbers(&found["g"][1]), numbers(&expected["g"]));
    write([0, 0, 1, (1 << 53) + 1]);
    refused(&path, &["states.npy: entry 3", "9007199254740993"]);
}
