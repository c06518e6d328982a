//! MCAP: `/joint_states`, `/tf` and the energies as messages of ROS 2.

use super::Rows;
use super::ros::{self, FLOAT64, JOINT_STATE, Message, TRANSFORMS};
use ::mcap::records::MessageHeader;
use ::mcap::{McapResult, WriteOptions, Writer};
use mozzi::{Freedom, Model, Place};
use mozzi_sim::Sample;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufWriter};

pub struct Mcap<'m> {
    model: &'m Model,
    /// JointState contains joints of one axis; the others are in the transforms.
    of_one_axis: Vec<(&'m str, &'m Place)>,
    space: &'m str,
    log: Log,
    channels: Vec<u16>,
    rows: usize,
}

impl<'m> Mcap<'m> {
    pub fn new(to: File, model: &'m Model) -> io::Result<Self> {
        let mut log = Log::new(BufWriter::new(to)).map_err(io::Error::other)?;
        let of_one_axis =
            model.joint_names().zip(model.places()).filter(|(_, place)| place.freedom == Freedom::One).collect();
        let topics = [
            ("/joint_states", JOINT_STATE),
            ("/tf", TRANSFORMS),
            ("/kinetic_energy", FLOAT64),
            ("/potential_energy", FLOAT64),
        ];
        let channels = topics.iter().map(|(topic, message)| log.channel(topic, message)).collect::<McapResult<_>>();
        let channels = channels.map_err(io::Error::other)?;
        Ok(Mcap { model, of_one_axis, space: ros::space_frame(model), log, channels, rows: 0 })
    }
}

impl Rows for Mcap<'_> {
    fn row(&mut self, row: &Sample) -> io::Result<()> {
        let (time, space) = (ros::nanoseconds(row.t), self.space);
        let poses = self.model.frame_poses(row.theta).map_err(io::Error::other)?;
        let frames: Vec<_> =
            self.model.frames().map(|(_, name)| name).zip(poses).filter(|(name, _)| *name != space).collect();
        let names: Vec<&str> = self.of_one_axis.iter().map(|(name, _)| *name).collect();
        let of = |list: &[f64], at: fn(&Place) -> usize| -> Vec<f64> {
            self.of_one_axis.iter().map(|(_, place)| list[at(place)]).collect()
        };
        let joints = [of(row.theta, |place| place.q), of(row.dtheta, |place| place.j), of(row.tau, |place| place.j)];
        let joints = joints.each_ref().map(Vec::as_slice);
        let messages = [
            ros::joint_state(time, &names, joints),
            ros::transforms(time, space, &frames),
            ros::float64(row.energy.kinetic),
            ros::float64(row.energy.potential),
        ];
        for (channel, bytes) in self.channels.iter().zip(messages) {
            self.log.message(*channel, self.rows, time, &bytes).map_err(io::Error::other)?;
        }
        self.rows += 1;
        Ok(())
    }

    fn finish(self: Box<Self>) -> io::Result<()> {
        self.log.finish().map_err(io::Error::other)
    }
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
