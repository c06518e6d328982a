//! Python's `Model`: machine code, copies, pickling and text.

use crate::describe::{State, from_state, to_state};
use crate::failure::of_model;
use crate::html;
use crate::numpy::Fresh;
use crate::results::named;
use crate::robot::{Asked, Machine, Robot};
use crate::threads::Threads;

use mozzi::FrameId;
use mozzi::quantities::Query;
use mozzi_engine::{Engine, Refusal};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString, PyTuple};
use std::hash::{DefaultHasher, Hash, Hasher};

/// A robot; its methods compute one quantity each.
///
/// Made from a file (`load`), a text, the book's lists, or by `mozzi.models`. A model never changes, and threads may
/// share it.
///
/// Arguments are anything NumPy makes an array of. The last axis is a state; leading axes are many states, which are
/// broadcast by NumPy's rule and computed on all cores. Results are float32 if all given arrays are; a
/// single gravity, `base_twist` and `base_acceleration` do not count.
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
        if query.declaration().needs_frame() {
            return Ok(query.of(self.frame(frame)?));
        }
        if frame.is_some() {
            self.frame(frame)?; // a name that no frame has is an error of any quantity
        }
        Ok(query)
    }

    pub fn built(model: Result<mozzi::Model, mozzi::Error>) -> PyResult<Self> {
        model.map(Self::of).map_err(of_model)
    }
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
    /// Compute a quantity by any of its names: `compute("M", theta)` is `mass_matrix(theta)`.
    ///
    /// The book's symbols (M, C, c, g, h, J_b, J_s, Lambda, T), and Featherstone's and Pinocchio's names (rnea, crba,
    /// aba, nle, fk) are known.
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
    /// Raises
    /// ------
    /// ValueError
    ///     For an unknown name; the message lists the nearest.
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

    /// Return an equal robot that computes these quantities by machine code, at one state and at many.
    ///
    /// Arrays of states get machine code without this method as soon as that pays; one state and `simulate` do not. The
    /// code is used for float64, in the robot's own gravity, with its own parameters, its base at rest and no applied
    /// wrenches; other calls use the kernels. `simulate` uses 'forward_dynamics', from one start, and from several if
    /// `torque` is a function.
    ///
    /// Parameters
    /// ----------
    /// *quantities : str
    ///     Names of methods that compute a quantity, such as 'inverse_dynamics'.
    /// frame : str, optional
    ///     Frame of the quantities that refer to one. Default: the end effector.
    /// threads : int, optional
    ///     Maximum number of threads for many states, unless a call has its own. Default: all cores.
    ///
    /// Returns
    /// -------
    /// Model
    ///     Equal to this one. `engine(name)` reports how a quantity is computed.
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
        if frame.is_some() {
            self.frame(frame.as_deref())?; // also where no quantity refers to one
        }
        let asked = quantities.into_iter().map(|name| {
            let of_frame = Query::named(&name).is_ok_and(|query| query.declaration().needs_frame());
            (name, frame.clone().filter(|_| of_frame))
        });
        let before = self.0.compiled.iter().flat_map(|machine| machine.names.clone());
        self.compiled(before.chain(asked).collect(), threads.map(|Threads(count)| count))
    }

    /// Return an equal robot that never uses machine code.
    ///
    /// Arrays are computed state by state on all cores, and each row equals the result at that one state exactly. By
    /// default a quantity in arrays becomes machine code as soon as that pays, which changes the last digits once, at a
    /// moment that depends only on the sizes of this robot's calls.
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

    /// Report how a quantity is computed in the robot's own environment, as decided by the calls so far.
    ///
    /// Parameters
    /// ----------
    /// quantity : str
    ///     Name of its method.
    /// frame : str, optional
    ///     Frame of a quantity that refers to one. Default: the end effector.
    ///
    /// Returns
    /// -------
    /// Engine
    ///     A named tuple: `one` for one state, `many` for arrays of states. Each reads 'machine code (avx512f), 5210
    ///     bytes', or 'kernels: ' and the reason.
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
            "<mozzi.Model '{}': {} joints, {links} links, {}{base}>",
            robot.name,
            model.joint_names().len(),
            html::masses(model)
        )
    }

    fn _repr_html_(&self) -> String {
        html::table(&self.0.model)
    }
}
