//! Bags: what `JointState` messages look like, and files of SQLite that are no bags of rosbag2.

use super::motion::ROBOT;
use super::{Same, Variants, Words, clean, file, folder};
use crate::common::complaint;

/// A record of SQLite: its header, then its values.
fn record(values: &[&[u8]], kinds: &[u64]) -> Vec<u8> {
    let header: Vec<u8> = kinds.iter().flat_map(|kind| varint(*kind)).collect();
    let mut bytes = varint(header.len() as u64 + 1);
    bytes.extend(header);
    values.iter().for_each(|value| bytes.extend(*value));
    bytes
}

fn varint(x: u64) -> Vec<u8> {
    match x {
        0..128 => vec![x as u8],
        128..16384 => vec![(x >> 7) as u8 | 0x80, (x & 0x7f) as u8],
        _ => vec![(x >> 14) as u8 | 0x80, (x >> 7) as u8 & 0x7f | 0x80, (x & 0x7f) as u8],
    }
}

const PAGE: usize = 65536;

/// A leaf page; each cell is pointed at several times.
fn leaf(cells: &[Vec<u8>], times: usize, begin: usize) -> Vec<u8> {
    let mut page = vec![0; PAGE];
    let mut end = PAGE;
    let mut pointers = Vec::new();
    for (k, cell) in cells.iter().enumerate() {
        let mut whole = varint(cell.len() as u64);
        whole.extend(varint(k as u64 + 1));
        whole.extend(cell);
        end -= whole.len();
        page[end..end + whole.len()].copy_from_slice(&whole);
        (0..times).for_each(|_| pointers.push(end as u16));
    }
    page[begin] = 0x0d;
    page[begin + 3..begin + 5].copy_from_slice(&(pointers.len() as u16).to_be_bytes());
    for (k, pointer) in pointers.iter().enumerate() {
        page[begin + 8 + 2 * k..][..2].copy_from_slice(&pointer.to_be_bytes());
    }
    page
}

fn text(text: &str) -> (Vec<u8>, u64) {
    (text.as_bytes().to_vec(), 13 + 2 * text.len() as u64)
}

fn row(values: &[(Vec<u8>, u64)]) -> Vec<u8> {
    let (bytes, kinds): (Vec<&[u8]>, Vec<u64>) = values.iter().map(|(bytes, kind)| (bytes.as_slice(), *kind)).unzip();
    record(&bytes, &kinds)
}

/// A bag with one message, to which `times` pointers lead.
fn database(times: usize, ending: &str) -> Vec<u8> {
    let table = |name: &str, root: u8, columns: &str| {
        let sql = format!("CREATE TABLE {name}({columns}) {ending}");
        row(&[text("table"), text(name), text(name), (vec![root], 1), text(&sql)])
    };
    let topics = table("topics", 2, "id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format TEXT");
    let messages = table("messages", 3, "id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data BLOB");
    let mut file = leaf(&[topics, messages], 1, 100);
    file[..16].copy_from_slice(b"SQLite format 3\0");
    file[16..18].copy_from_slice(&[0, 1]);
    file[56..60].copy_from_slice(&[0, 0, 0, 1]);
    let topic = row(&[(Vec::new(), 0), text("/joint_states"), text("sensor_msgs/msg/JointState"), text("cdr")]);
    file.extend(leaf(&[topic], 1, 0));
    let data = vec![7; 2000];
    let length = data.len() as u64;
    file.extend(leaf(&[row(&[(Vec::new(), 0), (vec![1], 1), (vec![9], 1), (data, 12 + 2 * length)])], times, 0));
    file
}

#[test]
fn files_of_sqlite_that_are_no_bags_say_so() {
    let folder = folder("identify_logs_sqlite");
    let of = |name: &str, bytes: &[u8]| {
        let path = folder.join(name);
        std::fs::write(&path, bytes).expect("a file");
        complaint(&["identify", ROBOT, path.to_str().expect("text")]).1
    };
    assert!(
        of("one.db3", &database(1, ""))
            .contains("1 of 1 messages of /joint_states are damaged, expected JointState in CDR")
    );
    let why = of("overlap.db3", &database(16_000, ""));
    assert!(why.contains("cells overlap") || why.contains("expected JointState"), "{why}");
    let why = of("rowid.db3", &database(1, "WITHOUT ROWID"));
    assert!(why.contains("WITHOUT ROWID"), "{why}");
    file(&folder, "hot.db3-journal", "a transaction");
    let why = of("hot.db3", &database(1, ""));
    assert!(why.contains("hot.db3-journal") && why.contains("not finished"), "{why}");
}

#[cfg(feature = "mcap")]
mod mcap_files {
    use super::*;
    use crate::common::mozzi;
    use std::collections::BTreeMap;

    /// Joint names with positions, velocities and efforts.
    type Message = (i64, Vec<&'static str>, [Vec<f64>; 3]);

    fn cdr((stamp, names, values): &Message) -> Vec<u8> {
        let mut bytes = vec![0, 1, 0, 0];
        let align = |bytes: &mut Vec<u8>, to: usize| bytes.resize(4 + (bytes.len() - 4).next_multiple_of(to), 0);
        let string = |bytes: &mut Vec<u8>, text: &str| {
            align(bytes, 4);
            bytes.extend((text.len() as u32 + 1).to_le_bytes());
            bytes.extend(text.as_bytes());
            bytes.push(0);
        };
        bytes.extend(((stamp / 1_000_000_000) as i32).to_le_bytes());
        bytes.extend(((stamp % 1_000_000_000) as u32).to_le_bytes());
        string(&mut bytes, "base");
        align(&mut bytes, 4);
        bytes.extend((names.len() as u32).to_le_bytes());
        names.iter().for_each(|name| string(&mut bytes, name));
        for list in values {
            align(&mut bytes, 4);
            bytes.extend((list.len() as u32).to_le_bytes());
            if !list.is_empty() {
                align(&mut bytes, 8);
            }
            list.iter().for_each(|x| bytes.extend(x.to_le_bytes()));
        }
        bytes
    }

    /// The messages of each topic, as one file.
    fn bag(topics: &[(&str, Vec<Message>)]) -> Vec<u8> {
        let mut to = std::io::Cursor::new(Vec::new());
        let mut writer = mcap::WriteOptions::new().profile("ros2").compression(None).create(&mut to).expect("a writer");
        let schema = writer.add_schema("sensor_msgs/msg/JointState", "ros2msg", b"string[] name").expect("a schema");
        for (topic, messages) in topics {
            let channel_id = writer.add_channel(schema, topic, "cdr", &BTreeMap::new()).expect("a channel");
            for (k, message) in messages.iter().enumerate() {
                let log_time = 1_714_000_000_000_000_000 + 1_000_000 * k as u64 * 10;
                let header =
                    mcap::records::MessageHeader { channel_id, sequence: k as u32, log_time, publish_time: log_time };
                writer.write_to_known_channel(&header, &cdr(message)).expect("a message");
            }
        }
        writer.finish().expect("an end");
        drop(writer);
        to.into_inner()
    }

    fn stamp(t: f64) -> i64 {
        1_714_000_000_000_000_000 + (t * 1e9).round() as i64
    }

    /// One message for each row, from both joints' values.
    fn messages(of: impl Fn(usize, i64, [[f64; 2]; 3]) -> Vec<Message>) -> Vec<Message> {
        let m = clean();
        (0..m.t.len()).flat_map(|k| of(k, stamp(m.t[k]), [m.theta[k], m.dtheta[k], m.tau[k]])).collect()
    }

    fn plain(_: usize, stamp: i64, x: [[f64; 2]; 3]) -> Vec<Message> {
        vec![(stamp, vec!["joint1", "joint2"], x.map(|x| x.to_vec()))]
    }

    fn gripper(_: usize, stamp: i64, _: [[f64; 2]; 3]) -> Vec<Message> {
        vec![(stamp + 1_500_000, vec!["finger"], [vec![0.02], vec![0.0], vec![0.0]])]
    }

    #[test]
    fn messages_of_drivers_are_read() {
        let mut v = Variants::new("identify_logs_bags");
        let one = |of: &dyn Fn(usize, i64, [[f64; 2]; 3]) -> Vec<Message>| bag(&[("/joint_states", messages(of))]);
        v.check("plain.mcap", one(&plain), &[], &Same);
        v.check("gripper.mcap", one(&|k, t, x| [plain(k, t, x), gripper(k, t, x)].concat()), &[], &Same);
        let other = bag(&[("/joint_states", messages(plain)), ("/gripper/joint_states", messages(gripper))]);
        v.check("gripper_topic.mcap", other, &[], &Same);
        let split = |_: usize, t: i64, x: [[f64; 2]; 3]| -> Vec<Message> {
            vec![(t, vec!["joint1"], x.map(|x| vec![x[0]])), (t, vec!["joint2"], x.map(|x| vec![x[1]]))]
        };
        v.check("split.mcap", one(&split), &[], &Same);
        let parts = v.folder.join("split.mcap");
        let computed = mozzi(&["compute", ROBOT, "mass-matrix", "--in", parts.to_str().expect("text")]);
        let notes = String::from_utf8_lossy(&computed.stderr);
        assert!(computed.status.success() && !notes.contains("NaN"), "{notes}");
        let turns = |k: usize, t: i64, x: [[f64; 2]; 3]| -> Vec<Message> {
            match k % 2 {
                0 => plain(k, t, x),
                _ => vec![(t, vec!["joint2", "joint1"], x.map(|x| vec![x[1], x[0]]))],
            }
        };
        v.check("order.mcap", one(&turns), &[], &Same);
        let unset = |_: usize, _: i64, x: [[f64; 2]; 3]| -> Vec<Message> {
            vec![(0, vec!["joint1", "joint2"], x.map(|x| x.to_vec()))]
        };
        v.check("unset.mcap", one(&unset), &[], &Same);
        let nan = |_: usize, t: i64, x: [[f64; 2]; 3]| -> Vec<Message> {
            vec![(t, vec!["joint1", "joint2"], [x[0].to_vec(), x[1].to_vec(), vec![f64::NAN; 2]])]
        };
        v.check("no_effort.mcap", one(&nan), &[], &Words(&["no forces"]));
        let both = || bag(&[("/a/joint_states", messages(plain)), ("/b/joint_states", messages(plain))]);
        v.check("two.mcap", both(), &[], &Words(&["/a/joint_states", "/b/joint_states", "--topic"]));
        v.check("chosen.mcap", both(), &["--topic", "/b/joint_states"], &Same);
        let twice = |_: usize, t: i64, x: [[f64; 2]; 3]| -> Vec<Message> {
            vec![(t, vec!["joint1", "joint1"], x.map(|x| x.to_vec()))]
        };
        v.check("twice.mcap", one(&twice), &[], &Words(&["`joint1` twice"]));
        let back = |k: usize, t: i64, x: [[f64; 2]; 3]| plain(k, if k > 600 { t - 5_000_000_000 } else { t }, x);
        v.check("back.mcap", one(&back), &[], &Words(&["goes back"]));
        v.end(11);
    }
}
