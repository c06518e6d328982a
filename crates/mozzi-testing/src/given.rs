//! A quantity's inputs, and the building blocks of its second ways: stacked equations, sums over bodies, dual numbers.

use crate::bodies::{bodies, frame, moments, momentum_columns, source, twist};
use crate::constraints;
use crate::linear::solve;
use mozzi::model::description::{Gear, Joint, Rotor};
use mozzi::model::seed_direction;
use mozzi::nalgebra::{DMatrix, DVector};
use mozzi::quantities::*;
use mozzi::{
    ClosedForm, Description, Dual, Entry, Environment, Model, Place, SE3, SO3, Scalar, TaskFrame, Twist, Vec3, Wrench,
};

/// The data from which a quantity is computed.
#[derive(Clone, Copy, Debug)]
pub struct Given<'a, S = f64> {
    /// The robot.
    pub robot: &'a Description<S>,
    /// Its model.
    pub model: &'a Model<S>,
    /// The frame, task or point.
    pub of: Subject<'a>,
    /// The quantity's inputs.
    pub inputs: &'a [&'a [S]],
    /// Gravity, the base's motion, wrenches.
    pub environment: &'a Environment<'a, S>,
}

impl<S: Entry> Given<'_, S> {
    pub(crate) fn theta(&self) -> &[S] {
        self.inputs[0]
    }
    pub(crate) fn n(&self) -> usize {
        self.model.n()
    }
    /// The stacked equations with these rates and in this environment.
    pub(crate) fn form(&self, dtheta: &[S], environment: &Environment<S>) -> ClosedForm<S> {
        self.model.closed_form(self.theta(), dtheta, environment).expect("lengths")
    }
    pub(crate) fn at_rest(&self) -> ClosedForm<S> {
        self.form(&zeros(self.n()), &Environment::with_gravity(Vec3::zero()))
    }
    pub(crate) fn moving(&self) -> ClosedForm<S> {
        self.form(self.inputs[1], &Environment::with_gravity(Vec3::zero()))
    }
    /// The robot in dual numbers, with zero derivatives.
    pub(crate) fn dual_robot(&self) -> (Description<Dual<S>>, Model<Dual<S>>) {
        (self.robot.map(Dual::constant), self.model.map(Dual::constant))
    }
    /// The derivative of a function by θ, one column for each joint: θ moves along one joint at a time.
    pub(crate) fn by_each_joint(&self, of: impl Fn(&[Dual<S>]) -> Vec<S>) -> DMatrix<S> {
        let along = |j| seed_direction(self.model, self.theta(), &unit(self.n(), j));
        let columns: Vec<DVector<S>> = (0..self.n()).map(|j| vector(&of(&along(j)))).collect();
        DMatrix::from_columns(&columns)
    }
    pub(crate) fn constraints(&self) -> constraints::Rows<S> {
        constraints::rows(self.robot, self.model, self.theta())
    }
    pub(crate) fn constraint_bias(&self) -> Vec<S> {
        let (robot, model) = self.dual_robot();
        constraints::bias(&robot, &model, self.model, self.theta(), self.inputs[1])
    }
    pub(crate) fn pose_and_jacobian(&self) -> (SE3<S>, Vec<Twist<S>>) {
        frame(self.robot, self.model, self.theta(), self.frame_name())
    }
    pub(crate) fn frame_name(&self) -> &str {
        self.model.frame_name(self.of.frame.expect("a frame"))
    }
    /// The columns of the frame's J, in its own coordinates or those of {s}.
    pub(crate) fn jacobian(&self, coordinates: TaskFrame) -> Vec<Twist<S>> {
        let (T, J) = self.pose_and_jacobian();
        match coordinates {
            TaskFrame::Body => J,
            TaskFrame::Space => J.into_iter().map(|column| T.Ad() * column).collect(),
        }
    }
    pub(crate) fn jacobian_rate(&self, dtheta: &[S], coordinates: TaskFrame) -> Vec<Twist<S>> {
        let (robot, model) = self.dual_robot();
        let theta = seed_direction(self.model, self.theta(), dtheta);
        let moving: Given<Dual<S>> = Given {
            robot: &robot,
            model: &model,
            of: self.of,
            inputs: &[&theta],
            environment: &Environment::with_gravity(Vec3::zero()),
        };
        moving.jacobian(coordinates).into_iter().map(|column| column.map(|x| x.derivative)).collect()
    }
    /// ∂/∂θ of a function of the stacked equations at rest: n columns.
    pub(crate) fn by_theta(&self, of: impl Fn(ClosedForm<Dual<S>>) -> Vec<Dual<S>>) -> DMatrix<S> {
        let (still, (_, model), mut applied) = (Dual::constants(&zeros(self.n())), self.dual_robot(), Vec::new());
        let environment = self.environment.map(Dual::constant, &mut applied);
        let environment =
            Environment { applied: environment.applied, ..Environment::with_gravity(environment.gravity) };
        self.by_each_joint(|theta| derivatives(of(model.closed_form(theta, &still, &environment).expect("lengths"))))
    }
    /// The gradient of a number by the k-th input, θ along the velocities.
    pub(crate) fn gradient(&self, k: usize, of: impl Fn(&Given<Dual<S>>) -> Dual<S>) -> Vec<S> {
        let (robot, model) = self.dual_robot();
        let mut applied = Vec::new();
        let environment = self.environment.map(Dual::constant, &mut applied);
        let along = |j: usize| {
            let mut inputs: Vec<Vec<Dual<S>>> = self.inputs.iter().map(|input| Dual::constants(input)).collect();
            inputs[k] = match k {
                0 => seed_direction(self.model, self.theta(), &unit(self.n(), j)),
                _ => Dual::list(self.inputs[k], &unit(self.n(), j)),
            };
            let inputs: Vec<&[Dual<S>]> = inputs.iter().map(Vec::as_slice).collect();
            let environment = &environment;
            of(&Given { robot: &robot, model: &model, of: self.of, inputs: &inputs, environment }).derivative
        };
        (0..self.n()).map(along).collect()
    }
    /// ∂τ/∂(θ, θ̇, θ̈) at θ̈ from the stacked equations, by dual numbers.
    pub(crate) fn tau_derivatives(&self, ddtheta: &[S]) -> [DMatrix<S>; 3] {
        let (n, (_, model)) = (self.n(), self.dual_robot());
        let mut applied = Vec::new();
        let environment = self.environment.map(Dual::constant, &mut applied);
        let form =
            |theta: &[Dual<S>], dtheta: &[Dual<S>]| model.closed_form(theta, dtheta, &environment).expect("lengths");
        let tau = |form: &ClosedForm<Dual<S>>, ddtheta: &[Dual<S>]| {
            derivatives(list(&form.inverse_dynamics(&vector(ddtheta))))
        };
        let [theta, dtheta, ddtheta] = [self.theta(), self.inputs[1], ddtheta].map(Dual::constants);
        let still = form(&theta, &dtheta);
        let along = |x: &[Dual<S>], j| Dual::list(&x.iter().map(|x| x.value).collect::<Vec<S>>(), &unit(n, j));
        let columns = |of: &dyn Fn(usize) -> Vec<S>| {
            DMatrix::from_columns(&(0..n).map(|j| vector(&of(j))).collect::<Vec<DVector<S>>>())
        };
        [
            self.by_each_joint(|theta| tau(&form(theta, &dtheta), &ddtheta)),
            columns(&|j| tau(&form(&theta, &along(&dtheta, j)), &ddtheta)),
            columns(&|j| tau(&still, &along(&ddtheta, j))),
        ]
    }
    /// θ̈ for τ by the stacked equations and a general solver.
    pub(crate) fn acceleration(&self) -> DVector<S> {
        let form = self.form(self.inputs[1], self.environment);
        let rest = form.inverse_dynamics(&DVector::zeros(self.n()));
        let right = DMatrix::from_columns(&[vector(self.inputs[2]) - rest]);
        solve(&form.mass_matrix(), &right).expect("regular").column(0).into_owned()
    }
    /// A quantity that is linear in the parameters, one parameter after the other.
    pub(crate) fn by_parameters(&self, query: Query, environment: &Environment<S>) -> DMatrix<S> {
        let (p, inputs) = (self.model.parameter_count(), &self.inputs[..query.declaration().inputs.len()]);
        let of = |pi: &[S]| vector(&by_kernel(query, &self.model.with_parameters(pi), inputs, environment));
        let constant = of(&zeros(p)); // the springs' energy at θ = 0
        if p == 0 {
            return DMatrix::zeros(constant.len(), 0);
        }
        DMatrix::from_columns(&(0..p).map(|k| of(&unit(p, k)) - &constant).collect::<Vec<DVector<S>>>())
    }
    /// For each joint: the index of its source joint, and the joint's ratio and offset.
    pub(crate) fn joints(&self) -> impl Iterator<Item = (&Joint<S>, Place, S, S)> {
        let places: Vec<_> = self.model.joint_names().zip(self.model.places()).collect();
        self.robot.joints.iter().filter_map(move |joint| {
            let (source, ratio, offset) = source(self.robot, joint);
            let &(_, &place) = places.iter().find(|(name, _)| *name == source.name)?;
            Some((joint, place, ratio, offset))
        })
    }
    /// For each velocity of each joint: the index of its source joint's velocity, the joint's ratio, and the value of
    /// `of`.
    pub(crate) fn at_joints(&self, of: impl Fn(&Joint<S>) -> [S; 2]) -> Vec<(usize, S, [S; 2])> {
        let at = |(joint, place, ratio, _): (&Joint<S>, Place, S, S)| {
            let of = of(joint);
            place.velocities().map(move |j| (j, ratio, of))
        };
        self.joints().flat_map(at).collect()
    }
    /// For each joint's spring: the index of its source joint among the velocities, k, its stretch q − θ₀ and the
    /// joint's ratio. A ball gives one entry for each component of the logarithm of its rotation.
    pub(crate) fn springs(&self) -> Vec<(usize, [S; 3])> {
        let at = |(joint, place, ratio, offset): (&Joint<S>, Place, S, S)| {
            let stretches = match self.theta()[place.positions()] {
                [w, x, y, z] => SO3::from_quaternion(w, Vec3([x, y, z])).log().0.to_vec(),
                [theta] => vec![ratio * theta + offset - joint.spring_reference],
                _ => Vec::new(), // a free joint has no spring
            };
            let k = joint.stiffness;
            place.velocities().zip(stretches).map(move |(j, stretch)| (j, [k, stretch, ratio]))
        };
        self.joints().flat_map(at).collect()
    }
    /// For each rotor: its armature, and J θ̇ through its gears.
    pub(crate) fn rotors(&self, dtheta: &[S]) -> Vec<[S; 2]> {
        let rate = |gear: &Gear<S>| {
            let joint = self.robot.joints.iter().find(|joint| joint.name == gear.joint).expect("checked");
            let (source, ratio, _) = source(self.robot, joint);
            let place = self.model.joint_names().position(|name| *name == source.name).expect("independent");
            gear.ratio * ratio * dtheta[self.model.places()[place].j]
        };
        let of = |rotor: &Rotor<S>| {
            [rotor.armature, rotor.gears.iter().map(rate).fold(<S as Scalar>::zero(), |sum, rate| sum + rate)]
        };
        self.robot.rotors.iter().map(of).collect()
    }
    pub(crate) fn spring_energy(&self) -> S {
        let half = S::from_f64(0.5);
        self.springs().into_iter().fold(<S as Scalar>::zero(), |sum, (_, [k, x, _])| sum + half * k * x * x)
    }
    pub(crate) fn kinetic_energy(&self) -> S {
        let (V_s, half) = (self.environment.base_twist, S::from_f64(0.5));
        let mut twice = <S as Scalar>::zero();
        for body in bodies(self.robot, self.model, self.theta()) {
            let V = twist(&body.J, self.inputs[1]) + body.T.inverse().Ad() * V_s;
            twice += body.G.map_or(<S as Scalar>::zero(), |G| V.dot(G * V));
        }
        for (j, ratio, [armature, _]) in self.at_joints(|joint| [joint.armature, joint.damping]) {
            let rate = ratio * self.inputs[1][j];
            twice += armature * rate * rate;
        }
        for [armature, rate] in self.rotors(self.inputs[1]) {
            twice += armature * rate * rate;
        }
        half * twice
    }
    pub(crate) fn momentum_columns(&self) -> Vec<Wrench<S>> {
        momentum_columns(self.robot, self.model, self.theta())
    }
    pub(crate) fn momentum(&self) -> Wrench<S> {
        self.momentum_columns()
            .into_iter()
            .zip(self.inputs[1])
            .fold(Wrench::zero(), |h, (column, &rate)| h + column * rate)
    }
    /// ḣ while θ̇ changes at the rate θ̈.
    pub(crate) fn momentum_rate(&self, ddtheta: &[S]) -> Wrench<S> {
        let (robot, model) = self.dual_robot();
        let columns = momentum_columns(&robot, &model, &seed_direction(self.model, self.theta(), self.inputs[1]));
        let rates = Dual::list(self.inputs[1], ddtheta);
        let h = columns.into_iter().zip(rates).fold(Wrench::zero(), |h, (column, rate)| h + column * rate);
        h.map(|x| x.derivative)
    }
    pub(crate) fn moments(&self) -> (S, Vec3<S>) {
        moments(self.robot, self.model, self.theta())
    }
    pub(crate) fn center(&self) -> Vec3<S> {
        let (mass, first) = self.moments();
        first.map(|x| x / mass)
    }
    /// A vector divided by the robot's mass.
    pub(crate) fn over_mass(&self, x: Vec3<S>) -> Vec<Vec<S>> {
        let (mass, _) = self.moments();
        vec![x.map(|x| x / mass).0.to_vec()]
    }
    pub(crate) fn point(&self) -> Vec3<S> {
        self.of.point.map(S::from_f64)
    }
}

pub(crate) fn dot<S: Entry>(x: &[S], y: &[S]) -> S {
    x.iter().zip(y).fold(<S as Scalar>::zero(), |sum, (&x, &y)| sum + x * y)
}
pub(crate) fn rows<S: Entry>(M: &DMatrix<S>) -> Vec<S> {
    M.transpose().as_slice().to_vec()
}
pub(crate) fn vector<S: Entry>(x: &[S]) -> DVector<S> {
    DVector::from_column_slice(x)
}
pub(crate) fn list<S: Entry>(x: &DVector<S>) -> Vec<S> {
    x.as_slice().to_vec()
}
pub(crate) fn zeros<S: Entry>(n: usize) -> Vec<S> {
    vec![<S as Scalar>::zero(); n]
}
/// The j-th of n unit vectors.
pub(crate) fn unit<S: Entry>(n: usize, j: usize) -> Vec<S> {
    let mut e = zeros(n);
    e[j] = <S as Scalar>::one();
    e
}
/// The kernel's first output.
pub(crate) fn by_kernel<S: Entry>(
    query: Query,
    model: &Model<S>,
    inputs: &[&[S]],
    environment: &Environment<S>,
) -> Vec<S> {
    let mut all: Vec<Vec<S>> = query.output_lengths(model).map(zeros).collect();
    let mut slices: Vec<&mut [S]> = all.iter_mut().map(Vec::as_mut_slice).collect();
    query.evaluate(model, inputs, environment, &mut Memory::new(model), &mut slices);
    all.swap_remove(0)
}

pub(crate) fn derivatives<S>(of: Vec<Dual<S>>) -> Vec<S> {
    of.into_iter().map(|x| x.derivative).collect()
}
