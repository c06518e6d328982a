//! Writing a robot.

use crate::describe::refused;
use crate::failure::{LoadWarning, of_file, of_model, warn};
use crate::model::PyModel;
use mozzi_urdf::{Written, chosen_end_effector, json, mjcf, named_states, sdf};
use pyo3::prelude::*;
use std::path::PathBuf;

/// The text in the format of a file's ending.
fn written(ending: &str, model: &mozzi::Model) -> PyResult<Written> {
    let robot = model.description();
    let lossless = |text: String| Written { text, losses: Vec::new(), remarks: Vec::new() };
    let not_written = |why: &dyn std::fmt::Display| refused(format!("{why}; .json can express all of it"));
    match ending {
        "json" => Ok(lossless(json::write(model))),
        "sdf" => sdf::write(robot).map_err(|why| not_written(&why)),
        "xml" => mjcf::write(robot).map_err(|why| not_written(&why)),
        "urdf" => {
            let mut expressible = mozzi_urdf::expressible(robot);
            expressible.end_effector = None;
            let mut found = lossless(mozzi_urdf::write(&expressible).map_err(|why| not_written(&why))?);
            found.losses.extend(chosen_end_effector(robot).into_iter().chain(named_states(robot)));
            Ok(found)
        }
        other => Err(refused(format!("the path ends in `.{other}`, expected .urdf, .xml (MJCF), .sdf or .json"))),
    }
}

#[pymethods]
impl PyModel {
    /// Write the robot to a file: URDF, MJCF (.xml), SDFormat (.sdf) or mozzi's JSON, by the ending of its name.
    ///
    /// JSON holds all of the robot's numbers. URDF gets a link on each axis that misses its link's frame, and a link
    /// for each further frame. Shapes are in none; `mozzi convert` and `mozzi.Identification.write` keep the text of a
    /// URDF.
    ///
    /// Parameters
    /// ----------
    /// path : path
    ///     The file, which is replaced if it exists.
    ///
    /// Returns
    /// -------
    /// None
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If the format cannot express the robot. Smaller losses, and what MuJoCo or Gazebo refuse, are warnings.
    ///
    /// Examples
    /// --------
    /// >>> import mozzi, pathlib, tempfile
    /// >>> loaded = mozzi.models.ur5().with_payload("tool0", 2.0)
    /// >>> file = pathlib.Path(tempfile.mkdtemp()) / "loaded.json"
    /// >>> loaded.save(file)
    /// >>> mozzi.Model.load(file).mass == loaded.mass
    /// True
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let model = &self.robot().model;
        let model = model.described().and_then(|robot| robot.build()).map_err(of_model)?;
        let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
        let Written { text, losses, remarks } = written(ending, &model)?;
        mozzi_report::whole_file::save(&path, text.as_bytes()).map_err(|error| of_file(&path, &error))?;
        let losses = losses.into_iter().map(|loss| format!("{} cannot express {loss}", path.display()));
        for text in losses.chain(remarks.into_iter().map(|remark| format!("{}: {remark}", path.display()))) {
            warn::<LoadWarning>(py, &text, 1)?;
        }
        Ok(())
    }
}
