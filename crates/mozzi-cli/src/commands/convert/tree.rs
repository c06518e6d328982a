//! The text of an SDFormat or MJCF file, and a line for each thing that the format cannot express.

use super::urdf::shapes;
use crate::failure::{self, Failure, Result};
use mozzi::Description;
use mozzi_urdf::{Policy, Settings, Written, mjcf, sdf};

pub fn text(input: &str, output: &str, suffix: &str, robot: &Description, settings: &Settings) -> Result<String> {
    let written = if suffix == "sdf" { sdf::write(robot) } else { mjcf::write(robot) };
    let not_written = |why: &dyn std::fmt::Display| {
        Failure::wrong(format!("{output} is not written: {why}; .json can express all of it"))
    };
    let Written { text, losses, remarks } = written.map_err(|why| not_written(&why))?;
    if settings.policy == Policy::Strict && !losses.is_empty() {
        return Err(not_written(&format!("--strict, and it cannot express {}", losses.join("; "))));
    }
    losses.iter().for_each(|loss| failure::note(&format!("{output} cannot express {loss}")));
    remarks.iter().for_each(|remark| failure::note(&format!("{output}: {remark}")));
    shapes(input, output, settings)?;
    Ok(text)
}
