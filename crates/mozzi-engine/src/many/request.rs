//! One call of a batch: the quantity, its tables, and the arguments common to all states.

use crate::many::chunk::Table;
use crate::{Arguments, BatchEnvironment, Derivative, Number};
use mozzi::quantities::{Query, Uses};
use mozzi::{Environment, Error, FrameId, Model, Vec3, Wrench};

/// The quantity and its arguments. Its tables are the quantity's inputs, then those of the environment: parameters,
/// gravity, wrenches.
pub(crate) struct Request<'a, T> {
    pub query: Query<'a>,
    pub model: &'a Model,
    /// The parts of the whole batch's environment that the quantity uses.
    pub environment: Environment<'a>,
    pub parameters: Option<&'a [T]>,
    pub gravity: Option<&'a [T]>,
    pub wrenches: &'a [(FrameId, &'a [T])],
}

impl<'a, T: Number> Request<'a, T> {
    pub fn new(query: Query<'a>, model: &'a Model, around: &BatchEnvironment<'a, T>) -> Self {
        let uses = query.declaration().uses;
        Request {
            query,
            model,
            environment: uses.of(&around.environment),
            parameters: around.parameters,
            gravity: around.gravity.filter(|_| uses.has(Uses::GRAVITY)),
            wrenches: if uses.has(Uses::WRENCHES) { around.wrenches } else { &[] },
        }
    }

    /// All tables: the quantity's inputs, then those of the environment.
    pub fn tables(&self, inputs: &[&'a [T]]) -> Vec<Table<'a, T>> {
        let declared = self.query.declaration().inputs.iter().zip(self.query.input_lengths(self.model));
        let own = declared.zip(inputs).map(|((input, width), numbers)| Table { name: input.name, numbers, width });
        own.chain(self.further()).collect()
    }

    /// The frames of the tables of wrenches.
    pub fn frames(&self) -> impl Iterator<Item = FrameId> {
        self.wrenches.iter().map(|&(frame, _)| frame)
    }

    /// The tables of the environment, in their order.
    pub fn further(&self) -> impl Iterator<Item = Table<'a, T>> + use<'_, 'a, T> {
        let table = |name, numbers, width| Table { name, numbers, width };
        let parameters = self.parameters.map(|numbers| table("parameters", numbers, self.model.parameter_count()));
        let gravity = self.gravity.map(|numbers| table("gravity", numbers, 3));
        let wrenches = self.wrenches.iter().map(move |&(_, numbers)| table("wrenches", numbers, 6));
        parameters.into_iter().chain(gravity).chain(wrenches)
    }

    /// The arguments of a program for this request, with `frames` as memory; none if the environment is the robot's
    /// own.
    pub fn arguments<'f>(&self, frames: &'f mut Vec<FrameId>) -> Arguments<'f> {
        let own = self.model.environment::<f64>();
        let environment = &self.environment;
        let uses = self.query.declaration().uses;
        let differs = |part, differs: bool| uses.has(part) && differs;
        frames.extend(self.wrenches.iter().map(|&(frame, _)| frame));
        frames.extend(environment.applied.iter().map(|&(frame, _)| frame));
        Arguments {
            parameters: self.parameters.is_some(),
            gravity: self.gravity.is_some() || differs(Uses::GRAVITY, environment.gravity != own.gravity),
            base_twist: differs(Uses::BASE_TWIST, environment.base_twist != own.base_twist),
            base_acceleration: differs(Uses::BASE_ACCELERATION, environment.base_acceleration != own.base_acceleration),
            about: self.query.subject.point != Vec3([0.0; 3]),
            wrenches: frames,
            derivative: Derivative::None,
        }
    }

    /// The program's inputs that are the same in all states, each with its index among the inputs after the state.
    pub fn constants(&self, arguments: &Arguments) -> Vec<Option<Vec<f64>>> {
        let environment = &self.environment;
        let mut all = Vec::new();
        let mut add = |is_argument: bool, constant: Option<Vec<f64>>| all.extend(is_argument.then_some(constant));
        add(arguments.parameters, None);
        add(arguments.gravity, self.gravity.is_none().then(|| environment.gravity.0.to_vec()));
        add(arguments.base_twist, Some(environment.base_twist.to_array().to_vec()));
        add(arguments.base_acceleration, Some(environment.base_acceleration.to_array().to_vec()));
        add(arguments.about, Some(self.query.subject.point.0.to_vec()));
        self.wrenches.iter().for_each(|_| add(true, None));
        environment.applied.iter().for_each(|(_, F)| add(true, Some(F.to_array().to_vec())));
        all
    }

    /// The quantity at one state, whose numbers are in the order of the tables.
    pub fn at_one_state(&self, numbers: &[Vec<f64>]) -> Result<Vec<Vec<f64>>, Error> {
        let (state, rest) = numbers.split_at(self.query.declaration().inputs.len());
        let state: Vec<&[f64]> = state.iter().map(Vec::as_slice).collect();
        let mut rest = rest.iter();
        let parameters = self.parameters.and_then(|_| rest.next());
        let gravity = self.gravity.and_then(|_| rest.next());
        let mut applied = self.environment.applied.to_vec();
        let wrench = |F: &Vec<f64>| Wrench::from_array(core::array::from_fn(|k| F[k]));
        applied.extend(self.wrenches.iter().zip(rest).map(|(&(frame, _), F)| (frame, wrench(F))));
        let gravity = gravity.map_or(self.environment.gravity, |g| Vec3(core::array::from_fn(|k| g[k])));
        let environment = Environment { gravity, applied: &applied, ..self.environment };
        let other = parameters.map(|parameters| self.model.with_parameters(parameters));
        other.as_ref().unwrap_or(self.model).compute(self.query, &state, &environment)
    }
}
