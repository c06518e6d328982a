//! Every quantity a second time, by other means than its kernel: the book's stacked equations, links one by one from
//! the description, dual numbers, linearity in the parameters.

use crate::bodies::{bodies, frame, moments, momentum_columns, source, twist};
use crate::linear::{inverse, solve};
use mozzi::model::description::{Gear, Joint, Rotor};
use mozzi::nalgebra::{DMatrix, DVector};
use mozzi::quantities::*;
use mozzi::{
    ClosedForm, Description, Dual, Entry, Environment, Model, Place, SE3, SO3, Scalar, TaskFrame, Twist, Vec3, Wrench,
    seed_direction,
};

/// What a quantity is computed of.
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

/// A quantity's second way; one without does not compile.
pub trait SecondWay: Quantity {
    /// How far, over the largest entry, the kernel in `f64` may be off.
    const TOLERANCE: f64 = 1e-11;
    /// The outputs, matrices by rows.
    fn second_way<S: Entry>(given: Given<S>) -> Vec<Vec<S>>;
}

type Way<S> = fn(Given<S>) -> Vec<Vec<S>>;

/// The outputs of the quantity of this place in the [list](LIST).
pub fn second_way<S: Entry>(index: usize, given: Given<S>) -> Vec<Vec<S>> {
    macro_rules! ways {
        ($($Q:ident)*) => { &[$(<$Q as SecondWay>::second_way::<S>),*] };
    }
    let ways: &[Way<S>] = mozzi::quantities!(ways);
    ways[index](given)
}

fn rows<S: Entry>(M: &DMatrix<S>) -> Vec<S> {
    M.transpose().as_slice().to_vec()
}
fn vector<S: Entry>(x: &[S]) -> DVector<S> {
    DVector::from_column_slice(x)
}
fn list<S: Entry>(x: &DVector<S>) -> Vec<S> {
    x.as_slice().to_vec()
}
fn zeros<S: Entry>(n: usize) -> Vec<S> {
    vec![<S as Scalar>::zero(); n]
}
/// The j-th of n unit vectors.
fn unit<S: Entry>(n: usize, j: usize) -> Vec<S> {
    let mut e = zeros(n);
    e[j] = <S as Scalar>::one();
    e
}
/// The kernel's first output.
fn by_kernel<S: Entry>(query: Query, model: &Model<S>, inputs: &[&[S]], environment: &Environment<S>) -> Vec<S> {
    let mut all: Vec<Vec<S>> = query.output_lengths(model).map(zeros).collect();
    let mut slices: Vec<&mut [S]> = all.iter_mut().map(Vec::as_mut_slice).collect();
    query.evaluate(model, inputs, environment, &mut Memory::new(model), &mut slices);
    all.swap_remove(0)
}

impl<S: Entry> Given<'_, S> {
    fn theta(&self) -> &[S] {
        self.inputs[0]
    }
    fn n(&self) -> usize {
        self.model.n()
    }
    /// The stacked equations with these rates and in this environment.
    fn form(&self, dtheta: &[S], environment: &Environment<S>) -> ClosedForm<S> {
        self.model.closed_form(self.theta(), dtheta, environment).expect("lengths")
    }
    fn at_rest(&self) -> ClosedForm<S> {
        self.form(&zeros(self.n()), &Environment::with_gravity(Vec3::zero()))
    }
    fn moving(&self) -> ClosedForm<S> {
        self.form(self.inputs[1], &Environment::with_gravity(Vec3::zero()))
    }
    /// The robot as dual numbers, its own derivatives zero.
    fn dual_robot(&self) -> (Description<Dual<S>>, Model<Dual<S>>) {
        (self.robot.map(Dual::constant), self.model.map(Dual::constant))
    }
    /// The first columns of a function of θ that moves along each joint in turn: its derivative by θ.
    fn by_each_joint(&self, of: impl Fn(&[Dual<S>]) -> Vec<S>) -> DMatrix<S> {
        let along = |j| seed_direction(self.model, self.theta(), &unit(self.n(), j));
        let columns: Vec<DVector<S>> = (0..self.n()).map(|j| vector(&of(&along(j)))).collect();
        DMatrix::from_columns(&columns)
    }
    fn pose_and_jacobian(&self) -> (SE3<S>, Vec<Twist<S>>) {
        frame(self.robot, self.model, self.theta(), self.frame_name())
    }
    fn frame_name(&self) -> &str {
        self.model.frame_name(self.of.frame.expect("a frame"))
    }
    /// J of the frame by its columns, in its own coordinates or those of {s}.
    fn jacobian(&self, coordinates: TaskFrame) -> Vec<Twist<S>> {
        let (T, J) = self.pose_and_jacobian();
        match coordinates {
            TaskFrame::Body => J,
            TaskFrame::Space => J.into_iter().map(|column| T.Ad() * column).collect(),
        }
    }
    fn jacobian_rate(&self, dtheta: &[S], coordinates: TaskFrame) -> Vec<Twist<S>> {
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
    /// ∂/∂θ of what the stacked equations at rest give: n columns.
    fn by_theta(&self, of: impl Fn(ClosedForm<Dual<S>>) -> Vec<Dual<S>>) -> DMatrix<S> {
        let (still, (_, model), mut applied) = (Dual::constants(&zeros(self.n())), self.dual_robot(), Vec::new());
        let environment = self.environment.map(Dual::constant, &mut applied);
        let environment =
            Environment { applied: environment.applied, ..Environment::with_gravity(environment.gravity) };
        self.by_each_joint(|theta| derivatives(of(model.closed_form(theta, &still, &environment).expect("lengths"))))
    }
    /// ∂τ/∂(θ, θ̇, θ̈) at θ̈: of the stacked equations, by dual numbers.
    fn tau_derivatives(&self, ddtheta: &[S]) -> [DMatrix<S>; 3] {
        let (n, (_, model)) = (self.n(), self.dual_robot());
        let mut applied = Vec::new();
        let environment = self.environment.map(Dual::constant, &mut applied);
        let tau = |theta: &[Dual<S>], dtheta: &[Dual<S>], ddtheta: &[Dual<S>]| {
            let form = model.closed_form(theta, dtheta, &environment).expect("lengths");
            derivatives(list(&form.inverse_dynamics(&vector(ddtheta))))
        };
        let [theta, dtheta, ddtheta] = [self.theta(), self.inputs[1], ddtheta].map(Dual::constants);
        let along = |x: &[Dual<S>], j| Dual::list(&x.iter().map(|x| x.value).collect::<Vec<S>>(), &unit(n, j));
        let columns = |of: &dyn Fn(usize) -> Vec<S>| {
            DMatrix::from_columns(&(0..n).map(|j| vector(&of(j))).collect::<Vec<DVector<S>>>())
        };
        [
            self.by_each_joint(|theta| tau(theta, &dtheta, &ddtheta)),
            columns(&|j| tau(&theta, &along(&dtheta, j), &ddtheta)),
            columns(&|j| tau(&theta, &dtheta, &along(&ddtheta, j))),
        ]
    }
    /// θ̈ of τ by the stacked equations and a general solver.
    fn acceleration(&self) -> DVector<S> {
        let form = self.form(self.inputs[1], self.environment);
        let rest = form.inverse_dynamics(&DVector::zeros(self.n()));
        let right = DMatrix::from_columns(&[vector(self.inputs[2]) - rest]);
        solve(&form.mass_matrix(), &right).expect("regular").column(0).into_owned()
    }
    /// A quantity that is linear in the parameters, one parameter after the other.
    fn by_parameters(&self, query: Query, environment: &Environment<S>) -> DMatrix<S> {
        let (p, inputs) = (self.model.parameter_count(), &self.inputs[..query.declaration().inputs.len()]);
        let of = |pi: &[S]| vector(&by_kernel(query, &self.model.with_parameters(pi), inputs, environment));
        let constant = of(&zeros(p)); // the springs' energy at θ = 0
        DMatrix::from_columns(&(0..p).map(|k| of(&unit(p, k)) - &constant).collect::<Vec<DVector<S>>>())
    }
    /// Of each joint: the place of its source joint, and the joint's ratio and offset.
    fn joints(&self) -> impl Iterator<Item = (&Joint<S>, Place, S, S)> {
        let places: Vec<_> = self.model.joint_names().zip(self.model.places()).collect();
        self.robot.joints.iter().filter_map(move |joint| {
            let (source, ratio, offset) = source(self.robot, joint);
            let &(_, &place) = places.iter().find(|(name, _)| *name == source.name)?;
            Some((joint, place, ratio, offset))
        })
    }
    /// Of each velocity of each joint: the place of its source joint's, the joint's ratio, and what `of` says.
    fn at_joints(&self, of: impl Fn(&Joint<S>) -> [S; 2]) -> Vec<(usize, S, [S; 2])> {
        let at = |(joint, place, ratio, _): (&Joint<S>, Place, S, S)| {
            let of = of(joint);
            place.velocities().map(move |j| (j, ratio, of))
        };
        self.joints().flat_map(at).collect()
    }
    /// Of each joint's spring: the place of its source joint among the velocities, k, its stretch q − θ₀ and the
    /// joint's ratio. Of a ball each part of the logarithm of its rotation.
    fn springs(&self) -> Vec<(usize, [S; 3])> {
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
    /// Of each rotor its armature, and J θ̇ by its gears.
    fn rotors(&self, dtheta: &[S]) -> Vec<[S; 2]> {
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
    fn spring_energy(&self) -> S {
        let half = S::from_f64(0.5);
        self.springs().into_iter().fold(<S as Scalar>::zero(), |sum, (_, [k, x, _])| sum + half * k * x * x)
    }
    fn kinetic_energy(&self) -> S {
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
    fn momentum_columns(&self) -> Vec<Wrench<S>> {
        momentum_columns(self.robot, self.model, self.theta())
    }
    fn momentum(&self) -> Wrench<S> {
        self.momentum_columns()
            .into_iter()
            .zip(self.inputs[1])
            .fold(Wrench::zero(), |h, (column, &rate)| h + column * rate)
    }
    /// ḣ with θ̇ moving by θ̈.
    fn momentum_rate(&self, ddtheta: &[S]) -> Wrench<S> {
        let (robot, model) = self.dual_robot();
        let columns = momentum_columns(&robot, &model, &seed_direction(self.model, self.theta(), self.inputs[1]));
        let rates = Dual::list(self.inputs[1], ddtheta);
        let h = columns.into_iter().zip(rates).fold(Wrench::zero(), |h, (column, rate)| h + column * rate);
        h.map(|x| x.derivative)
    }
    fn moments(&self) -> (S, Vec3<S>) {
        moments(self.robot, self.model, self.theta())
    }
    fn center(&self) -> Vec3<S> {
        let (mass, first) = self.moments();
        first.map(|x| x / mass)
    }
    /// Of a vector over the robot's mass.
    fn over_mass(&self, x: Vec3<S>) -> Vec<Vec<S>> {
        let (mass, _) = self.moments();
        vec![x.map(|x| x / mass).0.to_vec()]
    }
    fn point(&self) -> Vec3<S> {
        self.of.point.map(S::from_f64)
    }
}

fn derivatives<S>(of: Vec<Dual<S>>) -> Vec<S> {
    of.into_iter().map(|x| x.derivative).collect()
}

/// The rows of a Jacobian, or of the matrix of momentum, from its columns.
fn six_rows<S: Entry>(columns: &[[S; 6]]) -> Vec<S> {
    (0..6).flat_map(|row| columns.iter().map(move |column| column[row])).collect()
}
fn jacobian_rows<S: Entry>(columns: &[Twist<S>]) -> Vec<S> {
    six_rows(&columns.iter().map(|column| column.to_array()).collect::<Vec<_>>())
}
fn pose<S: Entry>(T: SE3<S>) -> Vec<S> {
    T.to_matrix().as_flattened().to_vec()
}

macro_rules! second_ways {
    ($($Q:ident $([$tolerance:expr])?: |$g:ident| $way:expr;)*) => { $(
        impl SecondWay for $Q {
            $(const TOLERANCE: f64 = $tolerance;)?
            fn second_way<S: Entry>($g: Given<S>) -> Vec<Vec<S>> { $way }
        }
    )* };
}

fn accelerations<S: Entry>(g: Given<S>) -> Vec<Vec<S>> {
    vec![list(&g.acceleration())]
}
fn jacobian_derivative<S: Entry>(g: Given<S>, coordinates: TaskFrame) -> Vec<Vec<S>> {
    vec![(0..g.n()).flat_map(|j| jacobian_rows(&g.jacobian_rate(&unit(g.n(), j), coordinates))).collect()]
}

second_ways! {
    InverseDynamics: |g| vec![list(&g.form(g.inputs[1], g.environment).inverse_dynamics(&vector(g.inputs[2])))];
    ForwardDynamics [1e-7]: |g| accelerations(g);
    ForwardDynamicsByMassMatrix [1e-7]: |g| accelerations(g);
    ForwardDynamicsByInverseDynamics [1e-7]: |g| accelerations(g);
    MassMatrix: |g| vec![rows(&g.at_rest().mass_matrix())];
    MassMatrixInverse [1e-7]: |g| vec![rows(&inverse(&g.at_rest().mass_matrix()).expect("regular"))];
    MassMatrixRate: |g| vec![rows(&g.moving().mass_matrix_rate())];
    CoriolisMatrix: |g| vec![rows(&g.moving().coriolis_matrix())];
    VelocityProduct: |g| vec![list(&g.moving().velocity_product())];
    GravityForces: |g| {
        vec![list(&g.form(&zeros(g.n()), &Environment::with_gravity(g.environment.gravity)).gravity_forces())]
    };
    BiasForces: |g| {
        // friction and springs are the difference of τ and c where nothing else acts
        let (still, moving) = (DVector::zeros(g.n()), g.moving());
        let friction = moving.inverse_dynamics(&still) - moving.velocity_product();
        vec![list(&(g.form(g.inputs[1], g.environment).inverse_dynamics(&still) - friction))]
    };
    TipForces: |g| vec![list(&g.form(&zeros(g.n()), g.environment).tip_forces())];
    JointFriction: |g| {
        let mut f = zeros(g.n());
        for (j, ratio, [damping, friction]) in g.at_joints(|joint| [joint.damping, joint.friction]) {
            let rate = ratio * g.inputs[0][j];
            f[j] += ratio * (damping * rate + friction * rate.sgn());
        }
        vec![f]
    };
    SpringForces: |g| {
        let mut f = zeros(g.n());
        for (j, [k, x, ratio]) in g.springs() {
            f[j] += ratio * k * x;
        }
        vec![f]
    };
    KineticEnergy: |g| vec![vec![g.kinetic_energy()]];
    PotentialEnergy: |g| vec![vec![g.spring_energy() - g.environment.gravity.dot(g.moments().1)]];
    ForwardKinematics: |g| vec![pose(g.pose_and_jacobian().0)];
    FramePoses: |g| {
        vec![g.model.frames().flat_map(|(_, name)| pose(frame(g.robot, g.model, g.theta(), name).0)).collect()]
    };
    SpaceJacobian: |g| vec![jacobian_rows(&g.jacobian(TaskFrame::Space))];
    BodyJacobian: |g| vec![jacobian_rows(&g.jacobian(TaskFrame::Body))];
    SpaceJacobianRate: |g| vec![jacobian_rows(&g.jacobian_rate(g.inputs[1], TaskFrame::Space))];
    BodyJacobianRate: |g| vec![jacobian_rows(&g.jacobian_rate(g.inputs[1], TaskFrame::Body))];
    SpaceJacobianDerivative: |g| jacobian_derivative(g, TaskFrame::Space);
    BodyJacobianDerivative: |g| jacobian_derivative(g, TaskFrame::Body);
    FrameAcceleration: |g| {
        // along the motion, the rates of ω and ṗ in {s}, turned into the frame's coordinates
        let (robot, model) = g.dual_robot();
        let theta = seed_direction(g.model, g.theta(), g.inputs[1]);
        let (T, J) = frame(&robot, &model, &theta, g.frame_name());
        let V = twist(&J, &Dual::list(g.inputs[1], g.inputs[2]));
        let rate = |x: Vec3<Dual<S>>| T.R.map(|x| x.value).inverse() * (T.R * x).map(|x| x.derivative);
        vec![Twist { w: rate(V.w), v: rate(V.v) }.to_array().to_vec()]
    };
    TaskSpaceDynamics [1e-6]: |g| {
        let (k, coordinates) = (g.of.rows.len(), g.of.coordinates);
        let of_rows = |columns: &[Twist<S>]| {
            DMatrix::from_fn(k, columns.len(), |r, j| columns[j].to_array()[g.of.rows[r]])
        };
        let J = of_rows(&g.jacobian(coordinates));
        let dJ = of_rows(&g.jacobian_rate(g.inputs[1], coordinates));
        let M = inverse(&g.at_rest().mass_matrix()).expect("regular");
        let h = vector(&BiasForces::second_way(g)[0]);
        let Lambda = inverse(&(&J * &M * J.transpose())).expect("regular");
        let eta = &Lambda * (&J * &M * h - dJ * vector(g.inputs[1]));
        vec![rows(&Lambda), list(&eta)]
    };
    InverseDynamicsDerivatives: |g| g.tau_derivatives(g.inputs[2]).iter().map(rows).collect();
    ForwardDynamicsDerivatives [1e-6]: |g| {
        let ddtheta = list(&g.acceleration());
        let [d_theta, d_dtheta, M] = g.tau_derivatives(&ddtheta);
        let inverse = inverse(&M).expect("regular");
        let (d_theta, d_dtheta) = (-&inverse * d_theta, -&inverse * d_dtheta);
        vec![ddtheta, rows(&d_theta), rows(&d_dtheta), rows(&inverse)]
    };
    GravityForcesDerivative: |g| vec![rows(&g.by_theta(|form| list(&form.gravity_forces())))];
    TipForcesDerivative: |g| vec![rows(&g.by_theta(|form| list(&form.tip_forces())))];
    MassMatrixProductDerivative: |g| {
        let by = g.by_theta(|form| rows(&form.mass_matrix())); // n² × n
        let (n, x) = (g.n(), g.inputs[1]);
        let entry = |i: usize, j: usize| {
            (0..n).fold(<S as Scalar>::zero(), |sum, k| sum + by[(i * n + k, j)] * x[k])
        };
        vec![rows(&DMatrix::from_fn(n, n, entry))]
    };
    CenterOfMass: |g| vec![g.center().0.to_vec()];
    CenterOfMassVelocity: |g| g.over_mass(g.momentum().f);
    CenterOfMassAcceleration: |g| g.over_mass(g.momentum_rate(g.inputs[2]).f);
    CenterOfMassJacobian: |g| {
        let (columns, mass) = (g.momentum_columns(), g.moments().0);
        vec![(0..3).flat_map(|row| columns.iter().map(move |column| column.f.0[row])).map(|x| x / mass).collect()]
    };
    Momentum: |g| vec![g.momentum().about(g.point()).to_array().to_vec()];
    MomentumRate: |g| vec![g.momentum_rate(g.inputs[2]).about(g.point()).to_array().to_vec()];
    CentroidalMomentumMatrix: |g| {
        let center = g.center();
        vec![six_rows(&g.momentum_columns().iter().map(|column| column.about(center).to_array()).collect::<Vec<_>>())]
    };
    CentroidalMomentumBias: |g| vec![g.momentum_rate(&zeros(g.n())).about(g.center()).to_array().to_vec()];
    Regressor: |g| {
        let environment = Environment { applied: &[], ..*g.environment };
        vec![rows(&g.by_parameters(InverseDynamics.into(), &environment))]
    };
    EnergyRegressors: |g| {
        [KineticEnergy.into(), PotentialEnergy.into()].map(|query: Query| rows(&g.by_parameters(query, g.environment))).to_vec()
    };
}
