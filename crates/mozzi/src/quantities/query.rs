//! A quantity with the frame, task or point that it refers to.

use super::{LIST, place_of};
use crate::linalg::Vec3;
use crate::model::{Environment, Error, FrameId, Model, Task, TaskFrame, check_length};
use crate::quantities::{Declaration, Dim, Of, Quantity, Subject};
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

/// Names of quantities besides their own: the book's symbols, and those of Featherstone and of Pinocchio.
pub const ALIASES: [(&str, &str); 22] = [
    ("M", "mass_matrix"),
    ("crba", "mass_matrix"),
    ("M_inv", "mass_matrix_inverse"),
    ("dM", "mass_matrix_rate"),
    ("C", "coriolis_matrix"),
    ("c", "velocity_product"),
    ("g", "gravity_forces"),
    ("h", "bias_forces"),
    ("nle", "bias_forces"),
    ("tau", "inverse_dynamics"),
    ("rnea", "inverse_dynamics"),
    ("id", "inverse_dynamics"),
    ("ddtheta", "forward_dynamics"),
    ("aba", "forward_dynamics"),
    ("fd", "forward_dynamics"),
    ("T", "forward_kinematics"),
    ("fk", "forward_kinematics"),
    ("J_b", "body_jacobian"),
    ("J_s", "space_jacobian"),
    ("Lambda", "task_space_dynamics"),
    ("com", "center_of_mass"),
    ("jacobian", "body_jacobian"),
];

/// A quantity to compute, with the frame, task or point that it refers to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Query<'a> {
    pub(crate) index: usize,
    /// The frame, task or point.
    pub subject: Subject<'a>,
}

impl<Q: Quantity> From<Q> for Query<'static> {
    fn from(_: Q) -> Self {
        Query::from_quantity::<Q>()
    }
}

impl<'a> Query<'a> {
    /// The quantity of this type.
    pub const fn from_quantity<Q: Quantity>() -> Query<'static> {
        Query::at(const { place_of(Q::DECLARATION.name) })
    }

    /// The quantity with this index in [`LIST`].
    pub const fn at(index: usize) -> Query<'static> {
        let (coordinates, rows) = (TaskFrame::Body, &[0, 1, 2, 3, 4, 5]);
        Query { index, subject: Subject { frame: None, coordinates, rows, point: Vec3([0.0; 3]) } }
    }

    /// The quantity of this name, with `_` or `-` between its words, or of one of the [`ALIASES`].
    ///
    /// # Errors
    /// [`Error::NoSuchQuantity`] with the names that exist.
    pub fn named(name: &str) -> Result<Query<'static>, Error> {
        let alias = ALIASES.iter().find(|(alias, _)| *alias == name).map(|(_, meant)| *meant);
        let plain = alias.unwrap_or(name).replace('-', "_");
        let place = LIST.iter().position(|known| known.name == plain);
        let known = || LIST.iter().map(|known| known.name).collect();
        place.map(Query::at).ok_or_else(|| Error::NoSuchQuantity { name: String::from(name), known: known() })
    }

    /// Sets the frame.
    pub fn of(self, frame: FrameId) -> Self {
        Query { subject: Subject { frame: Some(frame), ..self.subject }, ..self }
    }

    /// Sets the task.
    pub fn of_task(self, Task { frame, coordinates, rows }: Task<'a>) -> Self {
        Query { subject: Subject { frame: Some(frame), coordinates, rows, ..self.subject }, ..self }
    }

    /// Sets the reference point in {s}.
    pub fn about(self, point: Vec3) -> Self {
        Query { subject: Subject { point, ..self.subject }, ..self }
    }

    /// Its index in [`LIST`].
    pub fn index(&self) -> usize {
        self.index
    }

    /// Its declaration.
    pub fn declaration(&self) -> &'static Declaration {
        &LIST[self.index]
    }

    /// Its name.
    pub fn name(&self) -> &'static str {
        self.declaration().name
    }

    /// The lengths of its inputs for this robot.
    pub fn input_lengths<'m, C: crate::Scalar>(
        &self,
        model: &'m Model<C>,
    ) -> impl Iterator<Item = usize> + use<'m, 'a, C> {
        let subject = self.subject;
        self.declaration().inputs.iter().map(move |input| input.dim.size(model, &subject))
    }

    /// The shapes of its outputs for this robot.
    pub fn shapes<C: crate::Scalar>(&self, model: &Model<C>) -> Vec<Vec<usize>> {
        self.declaration().outputs.iter().map(|output| output.shape(model, &self.subject).collect()).collect()
    }

    /// The lengths of its outputs for this robot.
    pub fn output_lengths<'m, C: crate::Scalar>(
        &self,
        model: &'m Model<C>,
    ) -> impl Iterator<Item = usize> + use<'m, 'a, C> {
        let subject = self.subject;
        self.declaration().outputs.iter().map(move |output| output.length(model, &subject))
    }

    /// Checks that this robot has the frame, that the rows are distinct, and that it has mass if the quantity needs it.
    ///
    /// # Errors
    /// [`Error::BadArgument`] if the frame is missing or belongs to another model, or rows repeat; [`Error::NoMass`].
    pub fn check_subject(&self, model: &Model) -> Result<(), Error> {
        let Declaration { name, of, needs_mass, .. } = self.declaration();
        match (of, self.subject.frame) {
            (Of::Frame | Of::Task, None) => {
                let expected = "the name of a frame";
                return Err(Error::BadArgument { what: "the frame", found: format!("missing for {name}"), expected });
            }
            (Of::Task, Some(_)) => self.subject.task().check(model)?,
            (Of::Frame, Some(frame)) => model.check_frame(frame)?,
            _ => {}
        }
        match model.mass() {
            mass if *needs_mass && !(mass > 0.0) => Err(Error::NoMass { mass }),
            _ => Ok(()),
        }
    }

    /// Checks the [subject](Self::check_subject), the lengths of the inputs, the quaternions, and the environment's
    /// frames.
    ///
    /// # Errors
    /// [`Error::WrongLength`], [`Error::BadArgument`].
    #[inline]
    pub fn check(&self, model: &Model, inputs: &[&[f64]], environment: &Environment) -> Result<(), Error> {
        self.check_subject(model)?;
        let declared = self.declaration().inputs;
        assert!(inputs.len() == declared.len(), "{} inputs, expected {}", inputs.len(), declared.len());
        for (input, &slice) in declared.iter().zip(inputs) {
            match input.dim {
                Dim::Nq => model.check_configuration(slice)?,
                Dim::N => model.check_velocities([(input.name, slice)])?,
                dim => check_length(input.name, slice, dim.size(model, &self.subject))?,
            }
        }
        model.check_environment(environment)
    }
}
