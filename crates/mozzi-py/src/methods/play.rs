//! The playground of a robot.

use super::report::drawing;
use crate::model::PyModel;
use mozzi_report::{Played, play_html};
use mozzi_urdf::json;
use pyo3::prelude::*;
use std::path::PathBuf;

#[pymethods]
impl PyModel {
    /// Make an interactive page of the robot: drag it, push it, let it fall, edit it, and watch every quantity.
    ///
    /// A notebook shows the page; `save` writes it to a file for a browser.
    ///
    /// Parameters
    /// ----------
    /// shapes : path or str, optional
    ///     The robot's file, or the name of an embedded robot, for its shapes. Default: a skeleton.
    /// meshes : {'visual', 'collision', 'none'}
    ///     Meshes of that file to embed in the page.
    /// mesh_root : path, optional
    ///     A folder above meshes outside of the file's own folder and package; they are embedded as well. Meshes that
    ///     are not found elsewhere are searched there.
    ///
    /// Returns
    /// -------
    /// Page
    ///
    /// Warns
    /// -----
    /// LoadWarning
    ///     For each shape that is left out.
    ///
    /// Examples
    /// --------
    /// >>> import mozzi
    /// >>> mozzi.models.ur5().play()
    /// <mozzi page of 2... MB: a notebook shows it, save(path) writes it>
    #[pyo3(signature = (*, shapes=None, meshes="visual", mesh_root=None))]
    fn play<'py>(
        &self,
        py: Python<'py>,
        shapes: Option<PathBuf>,
        meshes: &str,
        mesh_root: Option<PathBuf>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (model, drawing) = (&self.robot().model, drawing(py, shapes, meshes, mesh_root)?);
        let name = &model.description().name;
        let text = json::to_value(model.description()).to_string();
        let file = format!("{name}.json");
        let played = Played { name, file: &file, text: &text, included: &[], model, drawing: &drawing, theta: None };
        let page = play_html(&played);
        py.import("mozzi._notebook")?.getattr("Page")?.call1((page,))
    }
}
