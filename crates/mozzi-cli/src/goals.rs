//! Tables of poses in CSV files: columns x y z of the origin and qw qx qy qz of the orientation, in {s}.

use crate::failure::{Failure, Result};
use crate::numbers::number;
use crate::samples::csv_failure;
use mozzi::SE3;

const COLUMNS: [&str; 7] = ["qw", "qx", "qy", "qz", "x", "y", "z"];

/// Poses and the line of each in the file.
pub fn read(file: &str) -> Result<Vec<(u64, SE3)>> {
    let cannot = |error: std::io::Error| Failure::wrong(format!("{file} cannot be read: {error}"));
    let input: Box<dyn std::io::Read> = match file {
        "-" => Box::new(std::io::stdin().lock()),
        path => Box::new(std::fs::File::open(path).map_err(cannot)?),
    };
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_reader(input);
    let header = reader.headers().map_err(|error| csv_failure(file, &error))?.clone();
    let mut places = [0; 7];
    for (place, name) in places.iter_mut().zip(COLUMNS) {
        *place = header.iter().position(|cell| cell.trim_start_matches('\u{feff}') == name).ok_or_else(|| {
            Failure::wrong(format!("{file}:1: column `{name}` is missing, expected the columns {}", COLUMNS.join(" ")))
        })?;
    }
    if let Some(unknown) = header.iter().position(|cell| !COLUMNS.contains(&cell.trim_start_matches('\u{feff}'))) {
        let expected = COLUMNS.join(" ");
        return Err(Failure::wrong(format!(
            "{file}:1: column {} is called `{}`, expected {expected}",
            unknown + 1,
            &header[unknown]
        )));
    }
    let mut poses = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| csv_failure(file, &error))?;
        let line = record.position().map_or(0, |position| position.line());
        let mut pose = [0.0; 7];
        for ((entry, name), place) in pose.iter_mut().zip(COLUMNS).zip(places) {
            *entry = number(format!("{file}:{line}: column {} (`{name}`)", place + 1), &record[place])?;
        }
        poses.push((line, from_pose(&format!("{file}:{line}: qw qx qy qz"), pose)?));
    }
    if poses.is_empty() {
        return Err(Failure::wrong(format!("{file} has no rows below its header")));
    }
    Ok(poses)
}

/// Of a quaternion that is one: its length may be off 1 by 10⁻³, as a free base's.
pub fn from_pose(place: &str, pose: [f64; 7]) -> Result<SE3> {
    let length = pose[..4].iter().map(|x| x * x).sum::<f64>().sqrt();
    if (length - 1.0).abs() > 1e-3 {
        return Err(Failure::wrong(format!("{place}: the quaternion's length is {length}, expected 1")));
    }
    Ok(SE3::from_pose(pose))
}
