//! Equations in symbols: `model.derive`.

use crate::failure::of_model;
use crate::interrupt::waited;
use crate::methods::quantity as task;
use crate::model::PyModel;
use mozzi::quantities::Query;
use mozzi_symbolic::{Collect, Derivation, Equal, Error, Language, Options, Symbols, base_parameters, derive};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::ffi::CString;

/// A quantity of a robot in symbols, compared with its kernel: text by ``print``, a formula in notebooks.
#[pyclass(frozen, name = "Derivation", module = "mozzi")]
pub struct PyDerivation(Derivation);

fn symbols(words: &str) -> PyResult<Symbols> {
    let mut symbols = Symbols::NONE;
    for word in words.split(',').map(str::trim) {
        match word {
            "masses" => symbols.masses = true,
            "lengths" => symbols.lengths = true,
            "inertias" => symbols.inertias = true,
            "gravity" => symbols.gravity = true,
            "joints" => symbols.joints = true,
            "all" => symbols = Symbols::ALL,
            "none" => symbols = Symbols::NONE,
            _ => {
                let expected = "some of masses, lengths, inertias, gravity, joints, all, none, separated by commas";
                return Err(PyValueError::new_err(format!("symbols has '{word}', expected {expected}")));
            }
        }
    }
    Ok(symbols)
}

fn one_of<T: Copy>(name: &str, found: &str, known: &[(&str, T)]) -> PyResult<T> {
    known.iter().find(|(word, _)| *word == found).map(|(_, value)| *value).ok_or_else(|| {
        let words: Vec<String> = known.iter().map(|(word, _)| format!("'{word}'")).collect();
        PyValueError::new_err(format!("{name} is '{found}', expected {}", words.join(" or ")))
    })
}

#[pymethods]
impl PyModel {
    /// Derive a quantity in symbols: the equations as a textbook writes them.
    ///
    /// Parameters
    /// ----------
    /// quantity : str
    ///     Name of the quantity: 'mass_matrix', 'M', 'velocity_product', 'gravity_forces', 'inverse_dynamics', …;
    ///     'mass_matrix_inverse', 'forward_dynamics', 'task_space_dynamics' up to four velocities; or
    ///     'base_parameters', for π_b and Y_b of τ = Y_b π_b.
    /// frame : str, optional
    ///     Its frame. Default: the end effector.
    /// symbols : str, optional
    ///     Numbers that become symbols: 'masses', 'lengths', 'inertias', 'gravity', 'joints', separated by commas;
    ///     'all' or 'none'. Default: 'all' up to three moving links, else 'none'.
    /// equal : str, optional
    ///     'none': each number is a symbol of its own; 'link': equal numbers of one link share a symbol; 'robot': equal
    ///     numbers of the robot do.
    /// collect : str, optional
    ///     'shortest' form, or 'velocities': terms grouped by products of velocities.
    /// cse : bool, optional
    ///     Name sub-expressions that occur more than once.
    /// rows : sequence of int, optional
    ///     Rows of (ω, v) of a task. Default: all six.
    /// coordinates : {'body', 'space'}
    ///     Coordinates of a task's twist.
    /// urdf : str, optional
    ///     The URDF text from which exact decimals are read. Default: the text of an embedded robot; for other robots
    ///     the shortest decimals of the model's numbers.
    ///
    /// Returns
    /// -------
    /// Derivation
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If the quantity is not derived, its matrix is singular in every configuration, or its entries are too long.
    ///
    /// Examples
    /// --------
    /// >>> import mozzi
    /// >>> arm = mozzi.models.two_link_planar()
    /// >>> print(str(arm.derive("potential_energy", equal="link")).splitlines()[0])
    /// P(θ) = (m₁ + m₂)L₁g sin θ₁ + m₂L₂g sin(θ₁ + θ₂)
    #[pyo3(signature = (
        quantity, *, frame=None, symbols=None, equal="none", collect="shortest", cse=false, rows=None,
        coordinates="body", urdf=None
    ))]
    #[allow(clippy::too_many_arguments)] // Python's keywords
    fn derive(
        slf: &Bound<'_, Self>,
        quantity: &str,
        frame: Option<&str>,
        symbols: Option<&str>,
        equal: &str,
        collect: &str,
        cse: bool,
        rows: Option<&Bound<'_, PyAny>>,
        coordinates: &str,
        urdf: Option<String>,
    ) -> PyResult<PyDerivation> {
        let rows = rows.map(task::rows).transpose()?;
        let mut query = None;
        if quantity.replace('-', "_") != "base_parameters" {
            let mut found = slf.get().query(quantity, frame)?;
            found.subject.coordinates = task::coordinates(Some(coordinates))?;
            query = Some(found);
        }
        let model = &slf.get().robot().model;
        let default = if model.moving_links() <= 3 { Symbols::ALL } else { Symbols::NONE };
        let equals = [("none", Equal::Separate), ("link", Equal::OfLink), ("robot", Equal::OfRobot)];
        let collects = [("shortest", Collect::Shortest), ("velocities", Collect::Velocities)];
        let options = Options {
            symbols: symbols.map_or(Ok(default), self::symbols)?,
            equal: one_of("equal", equal, &equals)?,
            collect: one_of("collect", collect, &collects)?,
            names: cse,
        };
        let own = mozzi_urdf::embedded::text(&model.description().name).map(str::to_string);
        let robot = slf.clone().unbind();
        let found = waited(slf.py(), move || {
            let mut query: Option<Query<'_>> = query;
            if let (Some(query), Some(rows)) = (&mut query, &rows) {
                query.subject.rows = rows;
            }
            let derive = |text: Option<&str>| match query {
                Some(query) => derive(&robot.get().robot().model, text, query, &options),
                None => base_parameters(&robot.get().robot().model, text, &options),
            };
            match (&urdf, &own) {
                (Some(text), _) => derive(Some(text)),
                // a changed robot is not the file's any more
                (None, Some(text)) => match derive(Some(text)) {
                    Err(Error::NotRead(_)) => derive(None),
                    found => found,
                },
                (None, None) => derive(None),
            }
        })?;
        found.map(PyDerivation).map_err(|error| match error {
            Error::Model(error) => of_model(error),
            Error::NotProven { .. } => PyRuntimeError::new_err(error.to_string()),
            error => PyValueError::new_err(error.to_string()),
        })
    }
}

#[pymethods]
impl PyDerivation {
    /// Name of the quantity.
    #[getter]
    fn quantity(&self) -> &'static str {
        self.0.quantity
    }

    /// Numbers of the file by the names of the symbols that occur: `{symbol: value}`.
    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let values = PyDict::new(py);
        for meaning in &self.0.legend {
            values.set_item(meaning.plain_name(), meaning.value.to_f64())?;
        }
        Ok(values)
    }

    /// Number of additions, of products, and of different sines and cosines in the printed equations.
    #[getter]
    fn operations<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let count = self.0.operations();
        PyTuple::new(py, [count.additions, count.products, count.sines])
    }

    fn __str__(&self) -> String {
        self.0.print(Language::Text)
    }

    fn __repr__(&self) -> String {
        self.0.print(Language::Text)
    }

    fn _repr_latex_(&self) -> String {
        self.0.print(Language::Markdown)
    }

    /// Return the equations as LaTeX with amsmath.
    fn latex(&self) -> String {
        self.0.print(Language::Latex)
    }

    /// Return the equations as Markdown with LaTeX formulas and a table of the symbols.
    fn markdown(&self) -> String {
        self.0.print(Language::Markdown)
    }

    /// Return the text of a Python function of NumPy arrays.
    fn python(&self) -> String {
        self.0.print(Language::Python)
    }

    /// Return the text of a MATLAB function.
    fn matlab(&self) -> String {
        self.0.print(Language::Matlab)
    }

    /// Return the text of a Julia function.
    fn julia(&self) -> String {
        self.0.print(Language::Julia)
    }

    /// Return the equations as SymPy's expression or matrix, with exact numbers. Needs SymPy.
    ///
    /// Returns
    /// -------
    /// sympy.Expr, sympy.Matrix or dict
    ///     A dict by name for several results.
    ///
    /// Raises
    /// ------
    /// ImportError
    ///     If SymPy is not installed.
    fn sympy<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let code =
            CString::new(self.0.print(Language::Sympy)).map_err(|error| PyValueError::new_err(error.to_string()))?;
        let scope = PyDict::new(py);
        py.run(&code, Some(&scope), None)?;
        let get = |name: &str| scope.get_item(name)?.ok_or_else(|| PyRuntimeError::new_err(name.to_string()));
        match &self.0.formulas[..] {
            [_] => get(self.0.quantity),
            all => {
                let found = PyDict::new(py);
                for formula in all {
                    found.set_item(formula.name, get(formula.name)?)?;
                }
                Ok(found.into_any())
            }
        }
    }
}
