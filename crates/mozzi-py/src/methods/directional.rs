//! The derivative of any quantity along a direction.

use crate::arguments::{Arguments, Given};
use crate::array::{Numbers, common_leading, wrong_shape};
use crate::environment::ArrayEnvironment;
use crate::failure::{of_batch, of_model};
use crate::methods::quantity::of_subject;
use crate::model::PyModel;
use crate::numpy::Element;
use crate::results::Results;
use crate::signature::{Signature, Slot};
use crate::threads::Threads;
use mozzi::quantities::{Input, Query};
use mozzi_engine::Direction;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// The name of an input's tangent in messages.
fn tangent_of(input: &Input) -> &'static str {
    match input.name {
        "theta" => "the tangent of theta",
        "dtheta" => "the tangent of dtheta",
        "ddtheta" => "the tangent of ddtheta",
        "tau" => "the tangent of tau",
        _ => "the tangent of x",
    }
}

fn wrong_count(what: &str, found: usize, query: &Query) -> PyErr {
    let names: Vec<&str> = query.declaration().inputs.iter().map(|input| input.name).collect();
    let (expected, name, names) = (names.len(), query.name(), names.join(", "));
    PyValueError::new_err(format!("{what} has {found} entries, expected {expected} for {name}: {names}"))
}

/// Results in f64 as Python gets them, in this number type.
fn finished<'py, T: Element>(
    py: Python<'py>,
    query: &Query,
    shapes: &[Vec<usize>],
    found: &[Vec<f64>],
) -> PyResult<Bound<'py, PyAny>> {
    let mut results = Results::<T>::new(py, shapes)?;
    for (to, from) in results.slices().into_iter().zip(found) {
        to.iter_mut().zip(from).for_each(|(to, &from)| *to = T::from_f64(from));
    }
    results.finish(py, query)
}

#[pymethods]
impl PyModel {
    /// Compute a quantity and its derivative along a direction, exactly and without a step size.
    ///
    /// The derivative is ∂f/∂θ δθ + ∂f/∂θ̇ δθ̇ + … + ∂f/∂π δπ, for any quantity; for a derivative it is of second
    /// order.
    ///
    /// Parameters
    /// ----------
    /// quantity : str
    ///     Name of a method that computes a quantity, such as 'inverse_dynamics'.
    /// inputs : sequence of array_like
    ///     Its inputs, in the order of that method.
    /// tangents : sequence of (array_like or None)
    ///     For each input its rate of change along the direction, n numbers; None is zero. That of theta is along the
    ///     velocities: of a floating base a body twist (ω, v), of a ball joint ω.
    /// frame : str, optional
    ///     A link or frame, if the quantity refers to one. Default: the end effector.
    /// coordinates, rows : optional
    ///     Those of a task, as for `task_space_dynamics`.
    /// about : array_like, shape (3,), optional
    ///     The point of a momentum.
    /// tip_wrench, gravity, applied_wrenches, base_twist, base_acceleration : optional
    ///     The environment, as for the quantity's method; it is constant.
    /// parameters : array_like, shape (..., p), optional
    ///     Inertial parameters in the order of `Model.parameters`. Default: the model's.
    /// parameters_tangent : array_like, shape (..., p), optional
    ///     Their rate of change. Default: zero.
    /// threads : int, optional
    ///     Maximum number of threads for many states. Default: all cores.
    ///
    /// Returns
    /// -------
    /// tuple
    ///     The quantity and its derivative, each as the quantity's method returns it. They are computed in float64, and
    ///     rounded to float32 if all given arrays are; a single gravity, `base_twist` and `base_acceleration` do not
    ///     count.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     For an unknown quantity, and for shapes that do not match; the message names the array.
    /// TypeError
    ///     For an argument that the quantity's method does not take.
    /// SingularError
    ///     If the mass matrix is singular. The message names the joint.
    ///
    /// Examples
    /// --------
    /// >>> import mozzi
    /// >>> ur5 = mozzi.models.ur5()
    /// >>> theta, along = [0, -1.2, 1.5, 0.3, 1.1, 0], [0, 1.0, 0, 0, 0, 0]
    /// >>> g, dg = ur5.jvp("gravity_forces", [theta], [along])
    /// >>> column = ur5.gravity_forces_derivative(theta)[:, 1]
    /// >>> bool(abs(dg - column).max() < 1e-12)
    /// True
    #[pyo3(signature = (
        quantity, inputs, tangents, *, frame=None, coordinates=None, rows=None, about=None, tip_wrench=None,
        gravity=None, applied_wrenches=None, base_twist=None, base_acceleration=None, parameters=None,
        parameters_tangent=None, threads=None
    ))]
    #[allow(clippy::too_many_arguments)] // Python's keywords
    fn jvp<'py>(
        &self,
        py: Python<'py>,
        quantity: &str,
        inputs: Vec<Bound<'py, PyAny>>,
        tangents: Vec<Option<Bound<'py, PyAny>>>,
        frame: Given<'_, 'py>,
        coordinates: Given<'_, 'py>,
        rows: Given<'_, 'py>,
        about: Given<'_, 'py>,
        tip_wrench: Given<'_, 'py>,
        gravity: Given<'_, 'py>,
        applied_wrenches: Given<'_, 'py>,
        base_twist: Given<'_, 'py>,
        base_acceleration: Given<'_, 'py>,
        parameters: Given<'_, 'py>,
        parameters_tangent: Given<'_, 'py>,
        threads: Option<Threads>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let (robot, model) = (self.robot(), &self.robot().model);
        let query = Query::named(quantity).map_err(of_model)?;
        let declaration = query.declaration();
        let given = [
            (Slot::Frame, frame),
            (Slot::Coordinates, coordinates),
            (Slot::Rows, rows),
            (Slot::About, about),
            (Slot::TipWrench, tip_wrench),
            (Slot::Gravity, gravity),
            (Slot::AppliedWrenches, applied_wrenches),
            (Slot::BaseTwist, base_twist),
            (Slot::BaseAcceleration, base_acceleration),
            (Slot::Parameters, parameters),
        ];
        Arguments::check(&given, &Signature::new(declaration))?;
        let (arguments, mut rows) = (Arguments::of(given), None);
        let query = of_subject(query, robot, &arguments, &mut rows)?;
        query.check_subject(model).map_err(of_model)?;
        if inputs.len() != declaration.inputs.len() {
            return Err(wrong_count("inputs", inputs.len(), &query));
        }
        if tangents.len() != declaration.inputs.len() {
            return Err(wrong_count("tangents", tangents.len(), &query));
        }
        let mut environment = ArrayEnvironment::new(model, &arguments)?;
        let mut state = Vec::with_capacity(inputs.len());
        for (input, given) in declaration.inputs.iter().zip(&inputs) {
            let numbers = Numbers::new(input.name, given)?;
            robot.check_shape(&numbers)?;
            state.push(numbers);
        }
        let mut rates = Vec::with_capacity(inputs.len());
        for (input, given) in declaration.inputs.iter().zip(&tangents) {
            let Some(given) = given else { continue };
            let numbers = Numbers::new(tangent_of(input), given)?;
            robot.check_shape_as(&numbers, if input.name == "theta" { "dtheta" } else { input.name })?;
            rates.push(numbers);
        }
        if let Some(given) = parameters_tangent {
            let (numbers, p) = (Numbers::new("parameters_tangent", given)?, model.parameter_count());
            if numbers.shape.last() != Some(&p) {
                let expected = format!("(..., {p}): one rate for each of Model.parameters");
                return Err(wrong_shape(numbers.name, &numbers.shape, expected));
            }
            rates.push(numbers);
        }
        let is_single = state.iter().chain(&rates).all(|numbers| numbers.is_single) && environment.is_single;

        let tables = state.iter().chain(&rates).chain(environment.tables());
        let leading = common_leading(tables.map(|table| (table.name, table.leading(1))))?;
        let tables = state.iter_mut().chain(&mut rates).chain(environment.tables_mut());
        tables.into_iter().try_for_each(|table| table.spread::<f64>(&leading, 1))?;
        let shape = |own: Vec<usize>| [&leading[..], &own].concat();
        let shapes: Vec<Vec<usize>> = query.shapes(model).into_iter().map(shape).collect();
        let empty = || shapes.iter().map(|shape| vec![0.0; shape.iter().product()]).collect::<Vec<Vec<f64>>>();
        let (mut values, mut derivatives) = (empty(), empty());

        let inputs = state.iter().map(Numbers::slice::<f64>).collect::<PyResult<Vec<_>>>()?;
        let mut rates = rates.iter().map(Numbers::slice::<f64>).collect::<PyResult<Vec<_>>>()?.into_iter();
        let of_inputs: Vec<_> = tangents.iter().map(|given| given.as_ref().and_then(|_| rates.next())).collect();
        let direction = Direction { inputs: &of_inputs, parameters: rates.next() };
        let (batch, wrenches) = (robot.batch::<f64>(threads)?, environment.wrenches()?);
        let around = environment.of_batch(&wrenches)?;
        let mut slices: Vec<&mut [f64]> = values.iter_mut().map(Vec::as_mut_slice).collect();
        let mut rates: Vec<&mut [f64]> = derivatives.iter_mut().map(Vec::as_mut_slice).collect();
        py.detach(|| batch.directional_derivative(query, &inputs, direction, &around, &mut slices, &mut rates))
            .map_err(|error| of_batch(error, &leading))?;
        let finish = if is_single { finished::<f32> } else { finished::<f64> };
        Ok((finish(py, &query, &shapes, &values)?, finish(py, &query, &shapes, &derivatives)?))
    }
}
