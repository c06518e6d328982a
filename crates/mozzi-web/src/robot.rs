//! A robot with its inputs and the requests that were prepared.

use crate::about::about;
use crate::applied::Applied;
use crate::bodies::Bodies;
use crate::drawn::Call;
use crate::request::{Kind, Request};
use mozzi::quantities::{Dim, INPUTS, Query, Subject};
use mozzi::{Environment, FrameId, Model, TaskFrame, Vec3, Wrench};
use serde_json::Value;

/// A robot, its inputs θ, θ̇, …, the wrenches that it applies, and prepared requests with their outputs.
#[derive(Debug)]
pub struct Robot {
    model: Model,
    bodies: Bodies,
    /// In the order of [`INPUTS`].
    inputs: [Vec<f64>; INPUTS.len()],
    applied: Applied,
    wrenches: Vec<(FrameId, Wrench)>,
    requests: Vec<Request>,
    #[cfg(feature = "play")]
    pub(crate) settings: crate::play::Settings,
}

impl Robot {
    /// The robot at its start and at rest; constant vectors are 0.
    pub fn new(model: Model) -> Self {
        let rows = &[0, 1, 2, 3, 4, 5];
        let subject = Subject { frame: None, coordinates: TaskFrame::Body, rows, point: Vec3::zero() };
        let mut inputs = INPUTS.map(|input| vec![0.0; input.dim.size(&model, &subject)]);
        for (input, numbers) in INPUTS.iter().zip(&mut inputs).filter(|(input, _)| input.dim == Dim::Nq) {
            debug_assert_eq!(input.name, "theta");
            numbers.copy_from_slice(&model.start().theta);
        }
        Robot {
            bodies: Bodies::new(&model),
            inputs,
            applied: Applied::default(),
            wrenches: Vec::new(),
            requests: Vec::new(),
            #[cfg(feature = "play")]
            settings: crate::play::Settings::default(),
            model,
        }
    }

    /// The model.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// Everything that does not depend on the state, as JSON: names, frames, joints and their axes, bodies and their
    /// inertia ellipsoids, inputs, and the list of quantities.
    ///
    /// # Errors
    /// The model's.
    pub fn about(&self) -> Result<Value, String> {
        about(&self.model, &self.bodies, &self.inputs).map_err(|error| error.to_string())
    }

    /// The numbers of an input, by its place in [`INPUTS`].
    ///
    /// # Errors
    /// There is no such input.
    pub fn input(&mut self, input: usize) -> Result<&mut [f64], String> {
        let found = self.inputs.get_mut(input).map(Vec::as_mut_slice);
        found.ok_or_else(|| format!("input {input} does not exist, expected less than {}", INPUTS.len()))
    }

    /// Prepares a request and describes its inputs and outputs. Returns its number; the same text has the same one.
    ///
    /// # Errors
    /// Text that is no request; an unknown quantity or frame, with the names that exist.
    pub fn prepare(&mut self, text: &str) -> Result<(usize, Value), String> {
        let known = self.requests.iter().position(|request| request.text == text);
        let place = match known {
            Some(place) => place,
            None => {
                self.requests.push(Request::parse(text, &self.model)?);
                self.requests.len() - 1
            }
        };
        Ok((place, self.requests[place].about()))
    }

    /// The outputs of a request, one after the other.
    ///
    /// # Errors
    /// There is no such request.
    pub fn output(&self, request: usize) -> Result<&[f64], String> {
        self.requests.get(request).map(|request| &request.numbers[..]).ok_or_else(|| none(request))
    }

    /// Computes the outputs of a request at the current inputs.
    ///
    /// # Errors
    /// There is no such request; the library's errors, such as a singular mass matrix. Outputs are then NaN.
    pub fn evaluate(&mut self, request: usize) -> Result<(), String> {
        let Robot { model, bodies, inputs, applied, wrenches, requests, .. } = self;
        let request = requests.get_mut(request).ok_or_else(|| none(request))?;
        let [theta, ..] = &*inputs;
        let computed = applied.wrenches(model, theta, wrenches).and_then(|()| {
            let environment = Environment { applied: wrenches, ..model.environment() };
            let mut given: [&[f64]; INPUTS.len()] = [&[]; INPUTS.len()];
            for (slice, &place) in given.iter_mut().zip(&request.inputs) {
                *slice = &inputs[place];
            }
            let given = &given[..request.inputs.len()];
            match &request.kind {
                Kind::Quantity(asked) => {
                    let mut query: Query = Query::at(asked.index);
                    query.subject = asked.subject();
                    model.compute(query, given, &environment).map(|outputs| outputs.concat())
                }
                Kind::Drawn(drawn, frame) => {
                    let call = Call { model, bodies, inputs: given, environment: &environment, frame: *frame };
                    (drawn.compute)(&call)
                }
            }
        });
        match computed {
            Ok(numbers) => {
                request.numbers.copy_from_slice(&numbers);
                Ok(())
            }
            Err(error) => {
                request.numbers.fill(f64::NAN);
                Err(error.to_string())
            }
        }
    }

    /// Sets which wrenches the robot applies to the environment, by a JSON list such as `[{"frame": "tool0", "as":
    /// "body"}]`, and returns the array of their numbers, six for each, first 0. `as` is
    ///
    /// - `body`: (m, f) in the frame's own coordinates;
    /// - `space`: (m, f) in {s}, about its origin;
    /// - `point`: (p, f), the force f at the point p, both in {s}.
    ///
    /// # Errors
    /// Text that is no such list; an unknown frame.
    pub fn apply(&mut self, text: &str) -> Result<&mut [f64], String> {
        self.applied = Applied::parse(text, &self.model)?;
        Ok(&mut self.applied.numbers)
    }

    /// Replaces the inertial parameters, a JSON list: see [`Model::parameters`].
    ///
    /// # Errors
    /// Text that is not a list of this many finite numbers.
    pub fn set_parameters(&mut self, text: &str) -> Result<(), String> {
        let parameters: Vec<f64> = serde_json::from_str(text).map_err(|error| format!("the parameters: {error}"))?;
        let expected = self.model.parameter_count();
        if parameters.len() != expected {
            return Err(format!("there are {} parameters, expected {expected}", parameters.len()));
        }
        self.model = self.model.with_parameters(&parameters);
        self.bodies = Bodies::new(&self.model);
        Ok(())
    }
}

#[cfg(feature = "play")]
impl Robot {
    /// θ of the inputs.
    pub(crate) fn theta(&self) -> &[f64] {
        self.named("theta")
    }

    /// θ̇ of the inputs.
    pub(crate) fn dtheta(&self) -> &[f64] {
        self.named("dtheta")
    }

    fn named(&self, name: &str) -> &[f64] {
        INPUTS.iter().position(|input| input.name == name).map_or(&[], |place| &self.inputs[place])
    }

    /// Sets an input by its name, in place.
    pub(crate) fn put(&mut self, name: &str, numbers: &[f64]) {
        if let Some(place) = INPUTS.iter().position(|input| input.name == name) {
            self.inputs[place].copy_from_slice(numbers);
        }
    }
}

fn none(request: usize) -> String {
    format!("request {request} was not prepared")
}
