//! A quantity with the frame, task or point that it refers to.

use super::{LIST, place_of};
use crate::linalg::Vec3;
use crate::model::{Environment, Error, FrameId, Model, Task, TaskFrame, check_length};
use crate::quantities::{Declaration, Dim, Of, Quantity, Subject};
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

/// Names of quantities besides their own: the book's symbols, Featherstone's names, and Pinocchio's.
pub const ALIASES: &[(&str, &str)] = &[
    ("M", "mass_matrix"),
    ("crba", "mass_matrix"),
    ("HandC", "mass_matrix"),
    ("inertia_matrix", "mass_matrix"),
    ("M_inv", "mass_matrix_inverse"),
    ("Minv", "mass_matrix_inverse"),
    ("computeMinverse", "mass_matrix_inverse"),
    ("dM", "mass_matrix_rate"),
    ("Mdot", "mass_matrix_rate"),
    ("C", "coriolis_matrix"),
    ("coriolis", "coriolis_matrix"),
    ("computeCoriolisMatrix", "coriolis_matrix"),
    ("c", "velocity_product"),
    ("g", "gravity_forces"),
    ("gravity", "gravity_forces"),
    ("gravity_torques", "gravity_forces"),
    ("computeGeneralizedGravity", "gravity_forces"),
    ("h", "bias_forces"),
    ("nle", "bias_forces"),
    ("bias", "bias_forces"),
    ("nonLinearEffects", "bias_forces"),
    ("tau", "inverse_dynamics"),
    ("τ", "inverse_dynamics"),
    ("torque", "inverse_dynamics"),
    ("torques", "inverse_dynamics"),
    ("rnea", "inverse_dynamics"),
    ("id", "inverse_dynamics"),
    ("ddtheta", "forward_dynamics"),
    ("θ̈", "forward_dynamics"),
    ("qdd", "forward_dynamics"),
    ("aba", "forward_dynamics"),
    ("fd", "forward_dynamics"),
    ("FDab", "forward_dynamics"),
    ("FDcrb", "forward_dynamics_by_mass_matrix"),
    ("friction", "joint_friction"),
    ("kinetic", "kinetic_energy"),
    ("K", "kinetic_energy"),
    ("𝒦", "kinetic_energy"),
    ("P", "potential_energy"),
    ("𝒫", "potential_energy"),
    ("potential", "potential_energy"),
    ("T", "forward_kinematics"),
    ("T_sb", "forward_kinematics"),
    ("fk", "forward_kinematics"),
    ("pose", "forward_kinematics"),
    ("J", "body_jacobian"),
    ("J_b", "body_jacobian"),
    ("Jb", "body_jacobian"),
    ("jacobian", "body_jacobian"),
    ("J_s", "space_jacobian"),
    ("Js", "space_jacobian"),
    ("dJ_b", "body_jacobian_rate"),
    ("J_dot", "body_jacobian_rate"),
    ("dJ_s", "space_jacobian_rate"),
    ("Lambda", "task_space_dynamics"),
    ("Λ", "task_space_dynamics"),
    ("eta", "task_space_dynamics"),
    ("η", "task_space_dynamics"),
    ("osim", "task_space_dynamics"),
    ("rnea_derivatives", "inverse_dynamics_derivatives"),
    ("computeRNEADerivatives", "inverse_dynamics_derivatives"),
    ("aba_derivatives", "forward_dynamics_derivatives"),
    ("computeABADerivatives", "forward_dynamics_derivatives"),
    ("com", "center_of_mass"),
    ("center_of_mass_position", "center_of_mass"),
    ("vcom", "center_of_mass_velocity"),
    ("acom", "center_of_mass_acceleration"),
    ("Jcom", "center_of_mass_jacobian"),
    ("com_jacobian", "center_of_mass_jacobian"),
    ("ccrba", "centroidal_momentum_matrix"),
    ("Ag", "centroidal_momentum_matrix"),
    ("A_G", "centroidal_momentum_matrix"),
    ("Y", "regressor"),
    ("computeJointTorqueRegressor", "regressor"),
];

/// The place in [`LIST`] of the first name or alias that is meant.
fn place_by(is: &dyn Fn(&str) -> bool) -> Option<usize> {
    let alias = || ALIASES.iter().find(|(alias, _)| is(alias)).map(|(_, meant)| *meant);
    LIST.iter()
        .position(|known| is(known.name))
        .or_else(|| alias().and_then(|meant| LIST.iter().position(|known| known.name == meant)))
}

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

    /// The quantity of this name, with `_` or `-` between its words, or of one of the [`ALIASES`]. Names of more than
    /// one letter may be written in capitals: RNEA.
    ///
    /// # Errors
    /// [`Error::NoSuchQuantity`] with the names that exist.
    pub fn named(name: &str) -> Result<Query<'static>, Error> {
        let plain = name.replace('-', "_");
        let is = |known: &str| known == plain;
        let is_in_capitals = |known: &str| plain.len() > 1 && known.eq_ignore_ascii_case(&plain);
        let place = place_by(&is).or_else(|| place_by(&is_in_capitals));
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

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::string::ToString;

    #[test]
    fn every_alias_is_of_a_quantity_and_no_quantitys_name() {
        for &(alias, meant) in ALIASES {
            assert_eq!(Query::named(alias).expect(alias).name(), meant);
            assert!(LIST.iter().all(|known| known.name != alias), "{alias}");
        }
        assert_eq!(Query::named("RNEA").expect("known").name(), "inverse_dynamics");
        assert_eq!(Query::named("Mass-Matrix").expect("known").name(), "mass_matrix");
        let names = ["C", "c", "T", "J-b"].map(|name| Query::named(name).expect(name).name());
        assert_eq!(names, ["coriolis_matrix", "velocity_product", "forward_kinematics", "body_jacobian"]);
    }

    #[test]
    fn an_unknown_quantity_names_the_nearest_three() {
        let told = |name: &str| Query::named(name).expect_err("unknown").to_string();
        for (name, near) in [
            ("mass-matrx", "`mass_matrix`"),
            ("inertia", "`mass_matrix`"),
            ("jacobian_body", "`body_jacobian`"),
            ("inverse-dynamic", "`inverse_dynamics`"),
            ("gravity_vector", "`gravity_forces`"),
        ] {
            let told = told(name);
            assert!(told.contains(near) && told.matches('`').count() == 8, "{name}: {told}");
        }
    }
}
