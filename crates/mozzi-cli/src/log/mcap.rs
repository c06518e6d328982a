//! MCAP: `/joint_states`, `/tf` and the energies as messages of ROS 2.

use super::ros::{self, FLOAT64, JOINT_STATE, Message, TRANSFORMS};
use crate::failure::{Failure, Result};
use crate::interrupt::Writing;
use ::mcap::records::MessageHeader;
use ::mcap::{McapResult, WriteOptions, Writer};
use mozzi::{Freedom, Place};
use mozzi::{Model, Trajectory};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufWriter;

pub fn write(file: &str, model: &Model, motion: &Trajectory) -> Result<()> {
    let cannot = |error: &dyn std::fmt::Display| Failure::wrong(format!("{file} cannot be written: {error}"));
    let _writing = Writing::to(file);
    let to = BufWriter::new(File::create(file).map_err(|error| cannot(&error))?);
    let mut log = Log::new(to).map_err(|error| cannot(&error))?;
    // JointState speaks of joints of one axis; the others are in the transforms
    let of_one_axis: Vec<(&str, &Place)> =
        model.joint_names().zip(model.places()).filter(|(_, place)| place.freedom == Freedom::One).collect();
    let names: Vec<&str> = of_one_axis.iter().map(|(name, _)| *name).collect();
    let space = ros::space_frame(model);
    let topics = [
        ("/joint_states", JOINT_STATE),
        ("/tf", TRANSFORMS),
        ("/kinetic_energy", FLOAT64),
        ("/potential_energy", FLOAT64),
    ];
    let mut channels = Vec::new();
    for (topic, message) in topics {
        channels.push(log.channel(topic, &message).map_err(|error| cannot(&error))?);
    }
    for (sequence, row) in motion.samples().enumerate() {
        let time = ros::nanoseconds(row.t);
        let poses = model.frame_poses(row.theta)?;
        let frames: Vec<_> =
            model.frames().map(|(_, name)| name).zip(poses).filter(|(name, _)| *name != space).collect();
        let of = |list: &[f64], at: fn(&Place) -> usize| -> Vec<f64> {
            of_one_axis.iter().map(|(_, place)| list[at(place)]).collect()
        };
        let joints = [of(row.theta, |place| place.q), of(row.dtheta, |place| place.j), of(row.tau, |place| place.j)];
        let joints = joints.each_ref().map(Vec::as_slice);
        let messages = [
            ros::joint_state(time, &names, joints),
            ros::transforms(time, space, &frames),
            ros::float64(row.energy.kinetic),
            ros::float64(row.energy.potential),
        ];
        for (channel, bytes) in channels.iter().zip(messages) {
            log.message(*channel, sequence, time, &bytes).map_err(|error| cannot(&error))?;
        }
    }
    log.finish().map_err(|error| cannot(&error))
}

struct Log(Writer<BufWriter<File>>);

impl Log {
    fn new(to: BufWriter<File>) -> McapResult<Self> {
        WriteOptions::new().profile("ros2").library("mozzi").compression(None).create(to).map(Log)
    }

    fn channel(&mut self, topic: &str, message: &Message) -> McapResult<u16> {
        let schema = self.0.add_schema(message.name, "ros2msg", message.definition.as_bytes())?;
        self.0.add_channel(schema, topic, "cdr", &BTreeMap::new())
    }

    fn message(&mut self, channel_id: u16, sequence: usize, time: u64, bytes: &[u8]) -> McapResult<()> {
        let header = MessageHeader { channel_id, sequence: sequence as u32, log_time: time, publish_time: time };
        self.0.write_to_known_channel(&header, bytes)
    }

    fn finish(mut self) -> McapResult<()> {
        self.0.finish().map(|_| ())
    }
}
