//! Python's `Model` from files, texts, and the book's lists.

use crate::load::{self, Xacro};
use crate::model::PyModel;
use pyo3::prelude::*;
use pyo3::types::PyDict;

#[pymethods]
impl PyModel {
    /// Load a robot from a file of any format, or an embedded robot by its name.
    ///
    /// Parameters
    /// ----------
    /// name_or_path : str, path or file
    ///     Name of an embedded robot; path of a URDF, xacro, MJCF, SDFormat or `mozzi convert` JSON file; or an object
    ///     with `read`.
    /// policy : {'default', 'strict', 'lenient'}
    ///     'strict': warnings are errors; 'lenient': repair inertias and warn.
    /// floating : bool
    ///     Give the robot a floating base.
    /// xacro_args : dict, optional
    ///     Values of a xacro file's arguments by name.
    /// packages : dict of str to path, optional
    ///     Folders of ROS packages by name, for `$(find name)`.
    ///
    /// Returns
    /// -------
    /// Model
    ///
    /// Raises
    /// ------
    /// LoadError
    ///     If the file is invalid; `diagnostics` lists every finding with its line.
    ///
    /// Examples
    /// --------
    /// >>> import mozzi
    /// >>> mozzi.Model.load("ur5").n
    /// 6
    #[staticmethod]
    #[pyo3(signature = (name_or_path, *, policy="default", floating=false, xacro_args=None, packages=None))]
    fn load(
        name_or_path: &Bound<'_, PyAny>,
        policy: &str,
        floating: bool,
        xacro_args: Option<Bound<'_, PyDict>>,
        packages: Option<Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let xacro = Xacro { values: xacro_args, packages };
        load::any(name_or_path, policy, floating, &xacro).map(Self::of)
    }

    /// Load a robot from a URDF, xacro, MJCF or SDFormat file; the format is detected from the root element.
    ///
    /// Parameters
    /// ----------
    /// path_or_file : str, path or file
    ///     A path, or an object with `read`.
    /// policy : {'default', 'strict', 'lenient'}
    ///     'strict': warnings are errors; 'lenient': repair inertias and warn.
    /// floating : bool
    ///     Give the robot a floating base.
    /// xacro_args : dict, optional
    ///     Values of a xacro file's arguments by name.
    /// packages : dict of str to path, optional
    ///     Folders of ROS packages by name, for `$(find name)`.
    ///
    /// Returns
    /// -------
    /// Model
    ///
    /// Raises
    /// ------
    /// LoadError
    ///     If the file is invalid; `diagnostics` lists every finding with its line.
    #[staticmethod]
    #[pyo3(signature = (path_or_file, *, policy="default", floating=false, xacro_args=None, packages=None))]
    fn from_urdf(
        path_or_file: &Bound<'_, PyAny>,
        policy: &str,
        floating: bool,
        xacro_args: Option<Bound<'_, PyDict>>,
        packages: Option<Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let xacro = Xacro { values: xacro_args, packages };
        load::file(path_or_file, policy, floating, &xacro).map(Self::of)
    }

    /// Alias of `from_urdf` without xacro; the format is detected from the root element.
    ///
    /// Parameters
    /// ----------
    /// path_or_file : str, path or file
    ///     A path, or an object with `read`.
    /// policy : {'default', 'strict', 'lenient'}
    ///     'strict': warnings are errors; 'lenient': repair inertias and warn.
    /// floating : bool
    ///     Give the robot a floating base.
    ///
    /// Returns
    /// -------
    /// Model
    ///
    /// Raises
    /// ------
    /// LoadError
    ///     If the file is invalid; `diagnostics` lists every finding with its line.
    #[staticmethod]
    #[pyo3(signature = (path_or_file, *, policy="default", floating=false))]
    fn from_mjcf(path_or_file: &Bound<'_, PyAny>, policy: &str, floating: bool) -> PyResult<Self> {
        load::file(path_or_file, policy, floating, &Xacro::default()).map(Self::of)
    }

    /// Load a robot from the text of a URDF, xacro, MJCF or SDFormat file.
    ///
    /// Parameters
    /// ----------
    /// text : str or bytes
    ///     The text; its format is detected from the root element.
    /// name : str
    ///     File name for messages.
    /// policy : {'default', 'strict', 'lenient'}
    ///     'strict': warnings are errors; 'lenient': repair inertias and warn.
    /// floating : bool
    ///     Give the robot a floating base.
    /// xacro_args : dict, optional
    ///     Values of a xacro file's arguments by name.
    /// packages : dict of str to path, optional
    ///     Folders of ROS packages by name, for `$(find name)`.
    ///
    /// Returns
    /// -------
    /// Model
    ///
    /// Raises
    /// ------
    /// LoadError
    ///     If the file is invalid; `diagnostics` lists every finding with its line.
    #[staticmethod]
    #[pyo3(signature = (
        text, *, name="robot.urdf", policy="default", floating=false, xacro_args=None, packages=None
    ))]
    fn from_urdf_string(
        text: &Bound<'_, PyAny>,
        name: &str,
        policy: &str,
        floating: bool,
        xacro_args: Option<Bound<'_, PyDict>>,
        packages: Option<Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let xacro = Xacro { values: xacro_args, packages };
        load::text(text, name, policy, floating, &xacro).map(Self::of)
    }

    /// Make a serial chain from the book's lists: home frames, spatial inertias and screw axes.
    ///
    /// Parameters
    /// ----------
    /// M_list : array_like, shape (n + 1, 4, 4)
    ///     Home frames of the links, base to tip, and of the end effector.
    /// G_list : array_like, shape (n, 6, 6)
    ///     Spatial inertias, each in its link's frame: kg m², kg m, kg.
    /// S_list : array_like, shape (6, n)
    ///     Screw axes (ω, v), one a column.
    /// name : str
    ///     Name of the robot.
    /// frames : {'relative', 'base'}
    ///     'relative': each home frame is given in the frame before it, as in the Modern Robotics package; 'base': in
    ///     the base's frame.
    /// axes : {'space', 'body', 'link'}
    ///     Frame of the screw axes: {s}, the end effector's, or the axis's own link's.
    ///
    /// Returns
    /// -------
    /// Model
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     For a wrong shape, or an invalid frame, inertia or axis; the message contains its index.
    ///
    /// Examples
    /// --------
    /// >>> import mozzi
    /// >>> import numpy as np
    /// >>> home, inertia, axis = [np.eye(4)] * 2, [np.eye(6)], np.eye(6)[:, [2]]
    /// >>> mozzi.Model.from_screws(home, inertia, axis).mass_matrix([0.5])
    /// array([[1.]])
    #[staticmethod]
    #[pyo3(signature = (M_list, G_list, S_list, *, name="robot", frames="relative", axes="space"))]
    fn from_screws(
        M_list: &Bound<'_, PyAny>,
        G_list: &Bound<'_, PyAny>,
        S_list: &Bound<'_, PyAny>,
        name: &str,
        frames: &str,
        axes: &str,
    ) -> PyResult<Self> {
        load::screws(name, [M_list, G_list, S_list], frames, axes).map(Self::of)
    }

    #[staticmethod]
    fn _embedded(py: Python<'_>, name: &str, floating: bool) -> PyResult<Self> {
        load::embedded(py, name, floating).map(Self::of)
    }
}
