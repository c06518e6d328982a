//! Python's `Model`: where it comes from, what it is turned into.

use crate::describe::{State, from_state, to_state};
use crate::failure::of_model;
use crate::numpy::Fresh;
use crate::results::named;
use crate::robot::{Asked, Machine, Robot};
use crate::threads::Threads;
use crate::{html, load};

use mozzi::FrameId;
use mozzi::quantities::{Of, Query};
use mozzi_engine::{Engine, Refusal};
use mozzi_report::text::scalar;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString, PyTuple};
use std::hash::{DefaultHasher, Hash, Hasher};

/// A robot: made from a file, a text, the book's lists, or by `mozzi.models`. It never changes, and may be shared by
/// threads.
///
/// Its methods compute one quantity each. Arguments are anything NumPy makes an array of; the last axis is a state,
/// leading axes are many states, computed on all cores, broadcast by NumPy's rule. Results are float32 where all arrays
/// given are, else float64.
///
/// Examples
/// --------
/// >>> import mozzi
/// >>> panda = mozzi.models.panda()
/// >>> panda.n, panda.joint_names[0]
/// (8, 'panda_joint1')
/// >>> panda.gravity_forces([0.0] * 6)
/// Traceback (most recent call last):
///     ...
/// ValueError: theta has shape (6,), expected (..., 8): one value per joint of 'panda' (panda_joint1, …)
#[pyclass(frozen, name = "Model", module = "mozzi")]
pub struct PyModel(Robot);

impl PyModel {
    pub fn of(model: mozzi::Model) -> Self {
        PyModel(Robot::new(model))
    }

    #[inline(always)]
    pub fn robot(&self) -> &Robot {
        &self.0
    }

    pub fn frame(&self, name: Option<&str>) -> PyResult<FrameId> {
        self.0.frame(name).map_err(of_model)
    }

    fn compiled(&self, names: Vec<Asked>, threads: Option<usize>) -> PyResult<Self> {
        let model = &self.0.model;
        let query = |(name, frame): &Asked| self.query(name, frame.as_deref());
        let queries = names.iter().map(query).collect::<PyResult<Vec<_>>>()?;
        let code = mozzi_engine::compile(model, &queries).map_err(of_model)?;
        let mut robot = Robot::new(model.clone());
        robot.compiled = Some(Machine { code, names, threads });
        Ok(PyModel(robot))
    }

    /// The quantity of this name; if it has a frame, for this frame, by default the end effector.
    pub fn query(&self, name: &str, frame: Option<&str>) -> PyResult<Query<'static>> {
        let query = Query::named(name).map_err(of_model)?;
        Ok(if is_of_frame(&query) { query.of(self.frame(frame)?) } else { query })
    }

    pub fn built(model: Result<mozzi::Model, mozzi::Error>) -> PyResult<Self> {
        model.map(Self::of).map_err(of_model)
    }
}

fn is_of_frame(query: &Query) -> bool {
    matches!(query.declaration().of, Of::Frame | Of::Task)
}

/// A new array of these numbers.
pub fn array<'py>(
    py: Python<'py>,
    shape: &[usize],
    numbers: impl IntoIterator<Item = f64>,
) -> PyResult<Bound<'py, PyAny>> {
    let mut fresh = Fresh::<f64>::new(py, shape)?;
    fresh.numbers().iter_mut().zip(numbers).for_each(|(place, x)| *place = x);
    Ok(fresh.into_array())
}

#[pymethods]
impl PyModel {
    /// The robot of any file (URDF, xacro, MJCF, SDFormat, JSON of `mozzi convert`), or an embedded robot by its name.
    ///
    /// Parameters
    /// ----------
    /// name_or_path : str, path or file
    ///     Name of an embedded robot, a path, or an object with `read`.
    /// policy : str, optional
    ///     'strict': warnings are errors; 'lenient': repair inertias and warn.
    /// floating : bool, optional
    ///     Free the base.
    /// xacro_args, packages : dict, optional
    ///     Values of a xacro file's arguments, and folders of ROS packages, by name.
    ///
    /// Returns
    /// -------
    /// Model
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
        let xacro = load::Xacro { values: xacro_args, packages };
        load::any(name_or_path, policy, floating, &xacro).map(Self::of)
    }

    /// A quantity by any of its names: `compute("M", theta)` is `mass_matrix(theta)`. The book's symbols (M, C, c, g,
    /// h, J_b, J_s, Lambda, T), and Featherstone's and Pinocchio's names (rnea, crba, aba, nle, fk) are known.
    ///
    /// Parameters
    /// ----------
    /// quantity : str
    ///     Name of the quantity.
    /// *args, **kwargs
    ///     Arguments of its method.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray, float or a named tuple
    ///     The result of the method.
    ///
    /// Examples
    /// --------
    /// >>> import mozzi
    /// >>> mozzi.models.ur5().compute("M", [0.0] * 6).shape
    /// (6, 6)
    #[pyo3(signature = (quantity, *args, **kwargs))]
    fn compute<'py>(
        slf: &Bound<'py, Self>,
        quantity: &str,
        args: &Bound<'py, PyTuple>,
        kwargs: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        slf.call_method(Query::named(quantity).map_err(of_model)?.name(), args, kwargs)
    }

    /// The robot of a URDF, xacro, MJCF or SDFormat file: a path or file. `policy` 'strict' refuses oddities,
    /// 'lenient' repairs inertias and says so; `floating` frees the base. A xacro file is expanded with `xacro_args`
    /// (the values of its arguments by name) and `packages` (the folders of `$(find name)`).
    #[staticmethod]
    #[pyo3(signature = (path_or_file, *, policy="default", floating=false, xacro_args=None, packages=None))]
    fn from_urdf(
        path_or_file: &Bound<'_, PyAny>,
        policy: &str,
        floating: bool,
        xacro_args: Option<Bound<'_, PyDict>>,
        packages: Option<Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let xacro = load::Xacro { values: xacro_args, packages };
        load::file(path_or_file, policy, floating, &xacro).map(Self::of)
    }

    /// As `from_urdf`: the language is told by the file's first element.
    #[staticmethod]
    #[pyo3(signature = (path_or_file, *, policy="default", floating=false))]
    fn from_mjcf(path_or_file: &Bound<'_, PyAny>, policy: &str, floating: bool) -> PyResult<Self> {
        load::file(path_or_file, policy, floating, &load::Xacro::default()).map(Self::of)
    }

    /// The robot of a text of URDF, xacro, MJCF or SDFormat, str or bytes; the rest as for `from_urdf`.
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
        let xacro = load::Xacro { values: xacro_args, packages };
        load::text(text, name, policy, floating, &xacro).map(Self::of)
    }

    /// A serial chain of the book's lists: n + 1 home frames (4, 4), each seen from the one before ('relative', as of
    /// the Modern Robotics package) or from the base ('base'); n spatial inertias (6, 6), each in its link's frame; and
    /// the screw axes, the columns of a matrix (6, n), in the 'space', 'body' or 'link' frame.
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

    #[staticmethod]
    fn _from_state(
        state: State,
        compiled: Vec<Asked>,
        threads: Option<usize>,
        is_kernels_only: bool,
    ) -> PyResult<Self> {
        let mut model = Self::built(from_state(state)?.build())?;
        model.0.is_kernels_only = is_kernels_only;
        if compiled.is_empty() { Ok(model) } else { model.compiled(compiled, threads) }
    }

    #[allow(clippy::type_complexity)] // what pickle wants
    fn __reduce__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyAny>, (State, Vec<Asked>, Option<usize>, bool))> {
        let rebuild = py.get_type::<PyModel>().getattr("_from_state")?;
        let (names, threads) = match &self.0.compiled {
            Some(machine) => (machine.names.clone(), machine.threads),
            None => (Vec::new(), None),
        };
        Ok((rebuild, (to_state(self.0.model.description()), names, threads, self.0.is_kernels_only)))
    }

    /// The same robot with these quantities as machine code at once, at one state and at many. Arrays of states get
    /// machine code by themselves as soon as that pays; one state, and `simulate`, only by this method. It is used for
    /// float64, in the robot's own gravity, with its own parameters, its base at rest, touching nothing; everything
    /// else is computed as before. `simulate` uses 'forward_dynamics', from one start and, if the torques are a
    /// function, from many.
    ///
    /// Parameters
    /// ----------
    /// *quantities : str
    ///     Names of methods that compute a quantity, such as 'inverse_dynamics'.
    /// frame : str, optional
    ///     Frame of those that are of a frame. Default: the end effector.
    /// threads : int, optional
    ///     Largest number of threads for many states, unless a call has its own. Default: all cores.
    ///
    /// Returns
    /// -------
    /// Model
    ///     Equal to this one. `engine(name)` reports what computes a quantity.
    ///
    /// Examples
    /// --------
    /// >>> import mozzi
    /// >>> ur5 = mozzi.models.ur5()
    /// >>> fast = ur5.compile("inverse_dynamics", "mass_matrix")
    /// >>> theta = [0, -1.2, 1.5, 0.3, 1.1, 0]
    /// >>> bool(abs(fast.mass_matrix(theta) - ur5.mass_matrix(theta)).max() < 1e-12)
    /// True
    #[pyo3(signature = (*quantities, frame=None, threads=None))]
    fn compile(&self, quantities: Vec<String>, frame: Option<String>, threads: Option<Threads>) -> PyResult<Self> {
        let asked = quantities.into_iter().map(|name| {
            let of_frame = Query::named(&name).is_ok_and(|query| is_of_frame(&query));
            (name, frame.clone().filter(|_| of_frame))
        });
        let before = self.0.compiled.iter().flat_map(|machine| machine.names.clone());
        self.compiled(before.chain(asked).collect(), threads.map(|Threads(count)| count))
    }

    /// The same robot without machine code: arrays are computed state by state, by the kernels of one state, on all
    /// cores. By default a quantity in arrays becomes machine code as soon as that pays, which changes the last digits
    /// once; when that is depends on the sizes of this robot's calls alone.
    ///
    /// Returns
    /// -------
    /// Model
    ///     Equal to this one.
    ///
    /// Examples
    /// --------
    /// >>> import mozzi, numpy
    /// >>> ur5 = mozzi.models.ur5().kernels_only()
    /// >>> theta = numpy.zeros((2000, 6))
    /// >>> bool((ur5.mass_matrix(theta)[7] == ur5.mass_matrix(theta[7])).all())
    /// True
    fn kernels_only(&self) -> Self {
        let mut robot = Robot::new(self.0.model.clone());
        robot.is_kernels_only = true;
        PyModel(robot)
    }

    /// What computes a quantity in the robot's own environment, as far as calls have decided.
    ///
    /// Parameters
    /// ----------
    /// quantity : str
    ///     Name of its method.
    /// frame : str, optional
    ///     Frame of a quantity that is of one. Default: the end effector.
    ///
    /// Returns
    /// -------
    /// Engine
    ///     A named tuple: `one` for one state, `many` for arrays of states. Each is such as 'machine code (avx512f),
    ///     5210 bytes', or 'kernels: ' and why.
    ///
    /// Examples
    /// --------
    /// >>> import mozzi
    /// >>> mozzi.models.ur5().engine("mass_matrix").one
    /// 'kernels: machine code was not requested'
    #[pyo3(signature = (quantity, frame=None))]
    fn engine<'py>(&self, py: Python<'py>, quantity: &str, frame: Option<&str>) -> PyResult<Bound<'py, PyAny>> {
        let query = self.query(quantity, frame)?;
        let compiled = self.0.compiled.as_ref().map(|machine| machine.code.engine(query));
        let one = compiled.unwrap_or(Engine::Kernels(Refusal::NotAsked));
        let many = py.detach(|| self.0.batch::<f64>(None).map(|batch| batch.engine(query)))?;
        let words = |engine: Engine| PyString::new(py, &engine.to_string()).into_any();
        named(py, "Engine", vec![words(one), words(many)])
    }

    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other.cast::<PyModel>().is_ok_and(|other| other.get().0.model.description() == self.0.model.description())
    }

    fn __hash__(&self) -> u64 {
        let mut hasher = DefaultHasher::new();
        (&self.0.model.description().name, self.0.model.n(), self.0.model.frames().len()).hash(&mut hasher);
        hasher.finish()
    }

    fn __repr__(&self) -> String {
        let model = &self.0.model;
        let base = if model.is_floating() { ", floating" } else { "" };
        let (robot, links) = (model.description(), model.description().links.len());
        format!(
            "<mozzi.Model '{}': {} joints, {links} links, {} kg{base}>",
            robot.name,
            model.joint_names().len(),
            scalar(model.mass())
        )
    }

    fn _repr_html_(&self) -> String {
        html::table(&self.0.model)
    }
}
