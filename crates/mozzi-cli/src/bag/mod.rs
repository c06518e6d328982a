//! `sensor_msgs/msg/JointState` messages as a table: of an MCAP file, of a SQLite file of rosbag2, or of a rosbag2
//! folder.

mod cdr;
mod message;
mod topics;

use crate::failure::{self, Failure, Result};
use crate::input::cannot;
use crate::recogniser::Request;
use crate::sqlite::Database;
use crate::tables::read::Choose;
use crate::tables::samples::Samples;
use message::State;
#[cfg(feature = "mcap")]
use mozzi_urdf::files;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// The type's names in ROS 2 and ROS 1.
const TYPES: [&str; 2] = ["sensor_msgs/msg/JointState", "sensor_msgs/JointState"];

/// Whether messages are read from this file or folder.
pub fn is_bag(file: &str) -> bool {
    let ending = Path::new(file).extension().map(|ending| ending.to_string_lossy().to_lowercase());
    matches!(ending.as_deref(), Some("mcap" | "db3" | "zstd")) || Path::new(file).is_dir()
}

/// The messages of a topic.
#[derive(Default)]
struct Topic {
    states: Vec<State>,
    /// The number of messages that are not complete.
    damaged: usize,
    /// The number of messages whose lists differ in length, and the lengths of the first.
    uneven: (usize, String),
}

/// The messages by topic.
#[derive(Default)]
struct Topics(BTreeMap<String, Topic>);

impl Topics {
    /// Adds a message that was received at this time, ns.
    fn add(&mut self, file: &str, topic: &str, received: i64, bytes: &[u8]) -> Result<()> {
        if bytes.starts_with(b"\x28\xb5\x2f\xfd") {
            return Err(Failure::wrong(format!(
                "{file}: the messages of {topic} are compressed by zstd; `ros2 bag convert` writes them uncompressed"
            )));
        }
        let of_topic = self.0.entry(topic.to_string()).or_default();
        let Some(state) = State::read(bytes, received) else {
            of_topic.damaged += 1;
            return Ok(());
        };
        let mut known = BTreeSet::new();
        if let Some(name) = state.names.iter().find(|name| !known.insert(*name)) {
            return Err(Failure::wrong(format!(
                "{file}: a message of {topic} names the joint `{name}` twice, expected different names"
            )));
        }
        match state.uneven() {
            Some(lengths) if of_topic.uneven.0 == 0 => of_topic.uneven = (1, lengths),
            Some(_) => of_topic.uneven.0 += 1,
            None => of_topic.states.push(state),
        }
        Ok(())
    }

    /// The complete messages. Others are left out with a note; a bag without complete ones is an error.
    fn complete(self, file: &str) -> Result<BTreeMap<String, Vec<State>>> {
        let (mut found, mut left_out) = (BTreeMap::new(), Vec::new());
        for (topic, Topic { states, damaged, uneven: (uneven, lengths) }) in self.0 {
            let all = states.len() + damaged + uneven;
            let damage =
                format!("{file}: {damaged} of {all} messages of {topic} are damaged, expected JointState in CDR");
            let lengths = format!(
                "{file}: {uneven} of {all} messages of {topic} have lists of other lengths than their names ({lengths} in \
                 the first), expected one number for each name, or none"
            );
            left_out.extend([(damaged, damage), (uneven, lengths)].into_iter().filter(|(count, _)| *count > 0));
            if !states.is_empty() {
                found.insert(topic, states);
            }
        }
        if let (true, Some((_, what))) = (found.is_empty(), left_out.first()) {
            return Err(Failure::wrong(what));
        }
        left_out.iter().for_each(|(_, what)| failure::note(&format!("{what}; they are left out")));
        Ok(found)
    }
}

/// The robot's motion in a bag; joints that a message lacks are NaN. The robot is chosen by the names of joints.
pub fn read(file: &str, choose: Choose, request: &Request) -> Result<Samples> {
    let mut topics = Topics::default();
    for part in parts(file)? {
        match part.to_lowercase() {
            name if name.ends_with(".mcap") => of_mcap(&part, &mut topics)?,
            name if name.ends_with(".db3") => of_sqlite(&part, &mut topics)?,
            _ => {
                let help = "`ros2 bag convert` writes it uncompressed, or `zstd -d` if whole files are compressed";
                return Err(Failure::wrong(format!("{part} is compressed; {help}")));
            }
        }
    }
    if topics.0.is_empty() {
        return Err(Failure::wrong(format!("{file} has no messages of {}", TYPES[0])));
    }
    let topics = topics.complete(file)?;
    let names: BTreeSet<&String> = topics.values().flatten().flat_map(|state| &state.names).collect();
    let model = choose(&names.into_iter().map(|name| format!("theta_{name}")).collect::<Vec<_>>());
    let states = topics::choose(file, topics, model, request)?;
    topics::table(file, states, model, request)
}

/// The files of a bag, in the order in which they were written: `bag_2.db3` precedes `bag_10.db3`.
fn parts(file: &str) -> Result<Vec<String>> {
    if !Path::new(file).is_dir() {
        return Ok(vec![file.to_string()]);
    }
    let entries = std::fs::read_dir(file).map_err(|error| cannot(file, &error))?;
    let mut found = Vec::new();
    for entry in entries {
        let path = entry.map_err(|error| cannot(file, &error))?.path();
        if path.is_file() && is_bag(&path.to_string_lossy()) {
            found.push(path.to_string_lossy().into_owned());
        }
    }
    let number = |name: &str| {
        let stem = name.split(['/', '\\']).next_back().unwrap_or_default().split('.').next().unwrap_or_default();
        stem.rsplit('_').next().and_then(|digits| digits.parse::<u64>().ok())
    };
    found.sort_unstable_by(|a, b| (number(a), a).cmp(&(number(b), b)));
    if found.is_empty() {
        return Err(Failure::wrong(format!(
            "{file} is a folder without .db3 or .mcap, expected a log or a bag of rosbag2"
        )));
    }
    Ok(found)
}

#[cfg(not(feature = "mcap"))]
fn of_mcap(file: &str, _: &mut Topics) -> Result<()> {
    Err(Failure::wrong(format!("{file}: this program was built without the feature mcap, which reads it")))
}

/// A larger bag is refused: it is read whole.
#[cfg(feature = "mcap")]
const MOST_BYTES: u64 = 4 << 30;

#[cfg(feature = "mcap")]
fn of_mcap(file: &str, topics: &mut Topics) -> Result<()> {
    let bytes = files::read(Path::new(file), MOST_BYTES).map_err(|error| cannot(file, &error))?;
    let messages = mcap::MessageStream::new(&bytes).map_err(|error| cannot(file, &error))?;
    for message in messages {
        let message = message.map_err(|error| match error {
            mcap::McapError::UnsupportedCompression(_) => {
                cannot(file, &format!("{error}; `mcap decompress {file} -o OUT.mcap` writes it uncompressed"))
            }
            _ => cannot(file, &error),
        })?;
        let channel = &message.channel;
        if !channel.schema.as_ref().is_some_and(|schema| TYPES.contains(&schema.name.as_str())) {
            continue;
        }
        if channel.message_encoding != "cdr" {
            let (topic, encoding) = (&channel.topic, &channel.message_encoding);
            return Err(Failure::wrong(format!(
                "{file}: {topic} is encoded as `{encoding}`, expected `cdr`, as ROS 2"
            )));
        }
        let received = i64::try_from(message.log_time).unwrap_or(i64::MAX);
        topics.add(file, &channel.topic, received, &message.data)?;
    }
    Ok(())
}

/// The tables `topics` and `messages` of rosbag2's default storage until ROS 2 Humble.
fn of_sqlite(file: &str, topics: &mut Topics) -> Result<()> {
    let wrong = |why: String| cannot(file, &why);
    let mut database = Database::open(file).map_err(wrong)?;
    let mut known: BTreeMap<i64, String> = BTreeMap::new();
    let table = database.table("topics").map_err(wrong)?;
    let columns = ["id", "name", "type", "serialization_format"].map(|name| table.column(name));
    let [id, name, kind, format] = columns;
    let (id, name, kind, format) =
        (id.map_err(wrong)?, name.map_err(wrong)?, kind.map_err(wrong)?, format.map_err(wrong)?);
    let mut other: Option<(String, String)> = None;
    let read = database.rows(&table, |row| {
        let text = |value: crate::sqlite::Value| value.text().unwrap_or_default().to_string();
        let (kind, format, name) = (text(row.value(kind)?), text(row.value(format)?), text(row.value(name)?));
        if TYPES.contains(&kind.as_str()) {
            match format.as_str() {
                "cdr" => drop(known.insert(row.value(id)?.integer().unwrap_or_default(), name)),
                _ => other = Some((name, format)),
            }
        }
        Ok(())
    });
    read.map_err(wrong)?;
    if let Some((topic, format)) = other.filter(|_| known.is_empty()) {
        return Err(Failure::wrong(format!("{file}: {topic} is encoded as `{format}`, expected `cdr`, as ROS 2")));
    }
    let table = database.table("messages").map_err(wrong)?;
    let columns = ["topic_id", "timestamp", "data"].map(|name| table.column(name));
    let [topic, time, data] = columns;
    let (topic, time, data) = (topic.map_err(wrong)?, time.map_err(wrong)?, data.map_err(wrong)?);
    let mut damaged = None;
    let read = database.rows(&table, |row| {
        let Some(topic) = row.value(topic)?.integer().and_then(|topic| known.get(&topic)) else { return Ok(()) };
        let received = row.value(time)?.integer().unwrap_or_default();
        let bytes = match row.value(data)? {
            crate::sqlite::Value::Blob(bytes) => bytes,
            _ => Vec::new(),
        };
        if let Err(failure) = topics.add(file, topic, received, &bytes) {
            damaged = Some(failure);
            return Err(String::new());
        }
        Ok(())
    });
    match (damaged, read) {
        (Some(failure), _) => Err(failure),
        (None, read) => read.map_err(wrong),
    }
}
