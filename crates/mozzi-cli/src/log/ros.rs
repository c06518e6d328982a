//! The ROS 2 messages of a motion: their definitions and their bytes.

use super::cdr::Cdr;
use mozzi::{Model, SE3};

/// A message type: its name, and its definition down to numbers.
pub struct Message {
    pub name: &'static str,
    pub definition: &'static str,
}

pub const JOINT_STATE: Message = Message {
    name: "sensor_msgs/msg/JointState",
    definition: "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n\
        ================================================================================\n\
        MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n\
        ================================================================================\n\
        MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n",
};

pub const TRANSFORMS: Message = Message {
    name: "tf2_msgs/msg/TFMessage",
    definition: "geometry_msgs/TransformStamped[] transforms\n\
        ================================================================================\n\
        MSG: geometry_msgs/TransformStamped\nstd_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n\
        ================================================================================\n\
        MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n\
        ================================================================================\n\
        MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n\
        ================================================================================\n\
        MSG: geometry_msgs/Transform\ngeometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n\
        ================================================================================\n\
        MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n\
        ================================================================================\n\
        MSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n",
};

pub const FLOAT64: Message = Message { name: "std_msgs/msg/Float64", definition: "float64 data\n" };

/// Nanoseconds.
pub fn nanoseconds(t: f64) -> u64 {
    (t * 1e9).round().max(0.0) as u64
}

fn header(cdr: &mut Cdr, time: u64, frame: &str) {
    cdr.int32(i32::try_from(time / 1_000_000_000).unwrap_or(i32::MAX));
    cdr.uint32((time % 1_000_000_000) as u32);
    cdr.string(frame);
}

/// A message of the independent joints: position, velocity, effort.
pub fn joint_state(time: u64, names: &[&str], values: [&[f64]; 3]) -> Vec<u8> {
    let mut cdr = Cdr::new();
    header(&mut cdr, time, "");
    cdr.length(names.len());
    names.iter().for_each(|name| cdr.string(name));
    values.iter().for_each(|list| cdr.float64s(list));
    cdr.into_bytes()
}

/// The parent frame of transforms: the base link, or {s} for a floating base.
pub fn space_frame(model: &Model) -> &str {
    match model.is_floating() {
        true => &model.description().free_joint.parent,
        false => model.folded_links()[0].links.first().map_or("world", |(name, _)| name),
    }
}

/// The pose of each frame in {s}.
pub fn transforms(time: u64, space: &str, poses: &[(&str, SE3)]) -> Vec<u8> {
    let mut cdr = Cdr::new();
    cdr.length(poses.len());
    for (name, T) in poses {
        header(&mut cdr, time, space);
        cdr.string(name);
        let [w, x, y, z, px, py, pz] = T.to_pose();
        [px, py, pz, x, y, z, w].into_iter().for_each(|number| cdr.float64(number));
    }
    cdr.into_bytes()
}

pub fn float64(x: f64) -> Vec<u8> {
    let mut cdr = Cdr::new();
    cdr.float64(x);
    cdr.into_bytes()
}
