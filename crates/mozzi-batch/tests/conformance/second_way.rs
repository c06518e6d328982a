//! Every quantity a second time, by other means than its kernel: the book's stacked equations, links one by one from the description, dual
//! numbers, linearity in the parameters.

use crate::bodies::{bodies, frame, moments, momentum_columns, twist};
use mozzi::nalgebra::{DMatrix, DVector};
use mozzi::quantities::*;
use mozzi::{ClosedForm, Dual, Environment, Model, SE3, Scalar, TaskFrame, Twist, Vec3, Wrench, seed_direction};

/// What a quantity is computed of.
#[derive(Clone, Copy)]
pub struct Given<'a> {
    pub model: &'a Model,
    pub of: Subject<'a>,
    pub inputs: &'a [&'a [f64]],
    pub environment: &'a Environment<'a>,
}

/// A quantity without a second way does not compile.
pub trait SecondWay: Quantity {
    /// How far, over the largest entry, the kernel in `f64` may be off.
    const TOLERANCE: f64 = 1e-11;
    fn second_way(given: Given) -> Vec<Vec<f64>>;
}

type Matrix = DMatrix<f64>;

fn rows(M: &Matrix) -> Vec<f64> {
    M.transpose().as_slice().to_vec()
}
fn vector(x: &[f64]) -> DVector<f64> {
    DVector::from_column_slice(x)
}
fn lift(x: &[f64]) -> Vec<Dual> {
    Dual::constants(x)
}

impl Given<'_> {
    fn theta(&self) -> &[f64] {
        self.inputs[0]
    }
    fn n(&self) -> usize {
        self.model.n()
    }
    /// The stacked equations with these rates and in this environment.
    fn form(&self, dtheta: &[f64], environment: &Environment) -> ClosedForm {
        self.model.closed_form(self.theta(), dtheta, environment).expect("lengths")
    }
    fn at_rest(&self) -> ClosedForm {
        self.form(&vec![0.0; self.n()], &Environment::with_gravity(Vec3([0.0; 3])))
    }
    fn moving(&self) -> ClosedForm {
        self.form(self.inputs[1], &Environment::with_gravity(Vec3([0.0; 3])))
    }
    fn frame_name(&self) -> &str {
        self.model.frame_name(self.of.frame.expect("a frame"))
    }
    /// J of a frame by its columns, in its own coordinates or those of {s}, along a motion.
    fn jacobian<S: mozzi::Real>(&self, theta: &[S], coordinates: TaskFrame) -> Vec<Twist<S>> {
        let (T, J) = frame(self.model, theta, self.frame_name());
        match coordinates {
            TaskFrame::Body => J,
            TaskFrame::Space => J.into_iter().map(|column| T.Ad() * column).collect(),
        }
    }
    fn jacobian_rate(&self, dtheta: &[f64], coordinates: TaskFrame) -> Vec<Twist> {
        let moving = self.jacobian(&seed_direction(self.model, self.theta(), dtheta), coordinates);
        moving.into_iter().map(|column| column.map(|x| x.derivative)).collect()
    }
    /// The first output of a quantity on dual numbers, and its derivative along a direction of each input.
    fn dual<Q: Quantity>(&self, quantity: Q, inputs: &[&[Dual]]) -> Vec<Dual> {
        let query = Query::from(quantity);
        let dual = self.model.map(Dual::constant);
        let applied: Vec<_> =
            self.environment.applied.iter().map(|&(frame, F)| (frame, F.map(Dual::constant))).collect();
        let environment = Environment {
            gravity: self.environment.gravity.map(Dual::constant),
            base_twist: self.environment.base_twist.map(Dual::constant),
            base_acceleration: self.environment.base_acceleration.map(Dual::constant),
            applied: &applied,
        };
        let length = query.output_lengths(self.model).next().expect("an output");
        let mut out = vec![Dual::zero(); length];
        query.evaluate(&dual, inputs, &environment, &mut Memory::new(&dual), &mut [&mut out]);
        out
    }
    /// ∂/∂θ of a quantity's first output, whose other inputs are constant: n columns.
    fn by_theta<Q: Quantity>(&self, quantity: Q, others: &[&[f64]]) -> Matrix {
        let others: Vec<Vec<Dual>> = others.iter().map(|x| lift(x)).collect();
        let columns = (0..self.n()).map(|j| {
            let mut e = vec![0.0; self.n()];
            e[j] = 1.0;
            let theta = seed_direction(self.model, self.theta(), &e);
            let inputs: Vec<&[Dual]> = std::iter::once(&theta[..]).chain(others.iter().map(Vec::as_slice)).collect();
            self.dual(quantity, &inputs).into_iter().map(|x| x.derivative).collect::<Vec<f64>>()
        });
        let columns: Vec<DVector<f64>> = columns.map(|column| vector(&column)).collect();
        Matrix::from_columns(&columns)
    }
    /// ∂τ/∂(θ, θ̇, θ̈) at θ̈ by dual numbers.
    fn tau_derivatives(&self, ddtheta: &[f64]) -> [Matrix; 3] {
        let (theta, dtheta) = (self.inputs[0], self.inputs[1]);
        let by = |which: usize| {
            let columns: Vec<DVector<f64>> = (0..self.n())
                .map(|j| {
                    let mut e = vec![0.0; self.n()];
                    e[j] = 1.0;
                    let zero = vec![0.0; self.n()];
                    let of = |k: usize| if k == which { &e } else { &zero };
                    let inputs = [
                        seed_direction(self.model, theta, of(0)),
                        Dual::list(dtheta, of(1)),
                        Dual::list(ddtheta, of(2)),
                    ];
                    let tau = self.dual(InverseDynamics, &inputs.each_ref().map(Vec::as_slice));
                    DVector::from_iterator(self.n(), tau.into_iter().map(|x| x.derivative))
                })
                .collect();
            Matrix::from_columns(&columns)
        };
        [by(0), by(1), by(2)]
    }
    /// θ̈ of τ by the stacked equations and a general solver.
    fn acceleration(&self) -> DVector<f64> {
        let form = self.form(self.inputs[1], self.environment);
        let rest = form.inverse_dynamics(&DVector::zeros(self.n()));
        form.mass_matrix().cholesky().expect("positive").solve(&(vector(self.inputs[2]) - rest))
    }
    /// A quantity that is linear in the parameters, one parameter after the other.
    fn by_parameters(&self, of: impl Fn(&Model) -> Vec<f64>) -> Matrix {
        let p = self.model.parameter_count();
        let columns: Vec<DVector<f64>> = (0..p)
            .map(|k| {
                let mut unit = vec![0.0; p];
                unit[k] = 1.0;
                vector(&of(&self.model.with_parameters(&unit)))
            })
            .collect();
        Matrix::from_columns(&columns)
    }
    fn kinetic_energy(&self) -> f64 {
        let V_s = self.environment.base_twist;
        let of_links: f64 = bodies(self.model, self.theta())
            .into_iter()
            .filter_map(|body| {
                let V = twist(&body.J, self.inputs[1]) + body.T.inverse().Ad() * V_s;
                Some(0.5 * V.dot(body.G? * V))
            })
            .sum();
        let robot = self.model.description();
        let (velocities, names): (usize, Vec<&str>) =
            (self.model.base().velocities(), self.model.joint_names().collect());
        let mut of_rotors = 0.0;
        for joint in &robot.joints {
            let (mut source, mut ratio) = (joint, 1.0);
            while let Some(mimic) = &source.mimic {
                ratio *= mimic.ratio;
                source = robot.joints.iter().find(|other| other.name == mimic.joint).expect("a joint");
            }
            if let Some(j) = names.iter().position(|name| *name == source.name) {
                of_rotors += 0.5 * joint.armature * (ratio * self.inputs[1][velocities + j]).powi(2);
            }
        }
        of_links + of_rotors
    }
    fn momentum(&self) -> Wrench {
        let columns = momentum_columns(self.model, self.theta());
        columns.into_iter().zip(self.inputs[1]).fold(Wrench::zero(), |h, (column, &rate)| h + column * rate)
    }
    /// ḣ with θ̇ moving by θ̈.
    fn momentum_rate(&self, ddtheta: &[f64]) -> Wrench {
        let columns = momentum_columns(self.model, &seed_direction(self.model, self.theta(), self.inputs[1]));
        let rates = Dual::list(self.inputs[1], ddtheta);
        let h = columns.into_iter().zip(rates).fold(Wrench::zero(), |h, (column, rate)| h + column * rate);
        h.map(|x| x.derivative)
    }
    fn center(&self) -> Vec3 {
        let (mass, first) = moments(self.model, self.theta());
        first * (1.0 / mass)
    }
    fn mass(&self) -> f64 {
        moments(self.model, self.theta()).0
    }
}

/// The rows of a Jacobian from its columns.
fn jacobian_rows(columns: &[Twist]) -> Vec<f64> {
    (0..6).flat_map(|row| columns.iter().map(move |column| column.to_array()[row])).collect()
}
fn pose(T: SE3) -> Vec<f64> {
    T.to_matrix().as_flattened().to_vec()
}

macro_rules! second_ways {
    ($($Q:ident $([$tolerance:expr])?: |$g:ident| $way:expr;)*) => { $(
        impl SecondWay for $Q {
            $(const TOLERANCE: f64 = $tolerance;)?
            fn second_way($g: Given) -> Vec<Vec<f64>> { $way }
        }
    )* };
}

fn accelerations(g: Given) -> Vec<Vec<f64>> {
    vec![g.acceleration().as_slice().to_vec()]
}
fn jacobian_derivative(g: Given, coordinates: TaskFrame) -> Vec<Vec<f64>> {
    let along = |j: usize| {
        let mut e = vec![0.0; g.n()];
        e[j] = 1.0;
        jacobian_rows(&g.jacobian_rate(&e, coordinates))
    };
    vec![(0..g.n()).flat_map(along).collect()]
}

second_ways! {
    InverseDynamics: |g| {
        let form = g.form(g.inputs[1], g.environment);
        vec![form.inverse_dynamics(&vector(g.inputs[2])).as_slice().to_vec()]
    };
    ForwardDynamics [1e-7]: |g| accelerations(g);
    ForwardDynamicsByMassMatrix [1e-7]: |g| accelerations(g);
    ForwardDynamicsByInverseDynamics [1e-7]: |g| accelerations(g);
    MassMatrix: |g| vec![rows(&g.at_rest().mass_matrix())];
    MassMatrixInverse [1e-7]: |g| vec![rows(&g.at_rest().mass_matrix().try_inverse().expect("regular"))];
    MassMatrixRate: |g| vec![rows(&g.moving().mass_matrix_rate())];
    CoriolisMatrix: |g| vec![rows(&g.moving().coriolis_matrix())];
    VelocityProduct: |g| vec![g.moving().velocity_product().as_slice().to_vec()];
    GravityForces: |g| {
        let form = g.form(&vec![0.0; g.n()], &Environment::with_gravity(g.environment.gravity));
        vec![form.gravity_forces().as_slice().to_vec()]
    };
    BiasForces: |g| {
        // friction is the difference of τ and c where nothing else acts
        let (still, moving) = (DVector::zeros(g.n()), g.moving());
        let friction = moving.inverse_dynamics(&still) - moving.velocity_product();
        vec![(g.form(g.inputs[1], g.environment).inverse_dynamics(&still) - friction).as_slice().to_vec()]
    };
    TipForces: |g| vec![g.form(&vec![0.0; g.n()], g.environment).tip_forces().as_slice().to_vec()];
    JointFriction: |g| {
        let robot = g.model.description();
        let (velocities, names): (usize, Vec<&str>) = (g.model.base().velocities(), g.model.joint_names().collect());
        let mut f = vec![0.0; g.n()];
        for joint in &robot.joints {
            let (mut source, mut ratio) = (joint, 1.0);
            while let Some(mimic) = &source.mimic {
                ratio *= mimic.ratio;
                source = robot.joints.iter().find(|other| other.name == mimic.joint).expect("a joint");
            }
            if let Some(j) = names.iter().position(|name| *name == source.name) {
                let rate = ratio * g.inputs[0][velocities + j];
                f[velocities + j] += ratio * (joint.damping * rate + joint.friction * Scalar::sgn(rate));
            }
        }
        vec![f]
    };
    KineticEnergy: |g| vec![vec![g.kinetic_energy()]];
    PotentialEnergy: |g| vec![vec![-g.environment.gravity.dot(moments(g.model, g.theta()).1)]];
    ForwardKinematics: |g| vec![pose(frame(g.model, g.theta(), g.frame_name()).0)];
    FramePoses: |g| {
        vec![g.model.frames().flat_map(|(_, name)| pose(frame(g.model, g.theta(), name).0)).collect()]
    };
    SpaceJacobian: |g| vec![jacobian_rows(&g.jacobian(g.theta(), TaskFrame::Space))];
    BodyJacobian: |g| vec![jacobian_rows(&g.jacobian(g.theta(), TaskFrame::Body))];
    SpaceJacobianRate: |g| vec![jacobian_rows(&g.jacobian_rate(g.inputs[1], TaskFrame::Space))];
    BodyJacobianRate: |g| vec![jacobian_rows(&g.jacobian_rate(g.inputs[1], TaskFrame::Body))];
    SpaceJacobianDerivative: |g| jacobian_derivative(g, TaskFrame::Space);
    BodyJacobianDerivative: |g| jacobian_derivative(g, TaskFrame::Body);
    FrameAcceleration: |g| {
        // along the motion, the rates of ω and ṗ in {s}, turned into the frame's coordinates
        let theta = seed_direction(g.model, g.theta(), g.inputs[1]);
        let (T, J) = frame(g.model, &theta, g.frame_name());
        let V = twist(&J, &Dual::list(g.inputs[1], g.inputs[2]));
        let rate = |x: Vec3<Dual>| T.R.map(|x| x.value).inverse() * (T.R * x).map(|x| x.derivative);
        vec![Twist { w: rate(V.w), v: rate(V.v) }.to_array().to_vec()]
    };
    TaskSpaceDynamics [1e-6]: |g| {
        let (k, coordinates) = (g.of.rows.len(), g.of.coordinates);
        let of_rows = |columns: &[Twist]| {
            Matrix::from_fn(k, columns.len(), |r, j| columns[j].to_array()[g.of.rows[r]])
        };
        let J = of_rows(&g.jacobian(g.theta(), coordinates));
        let dJ = of_rows(&g.jacobian_rate(g.inputs[1], coordinates));
        let M = g.at_rest().mass_matrix().try_inverse().expect("regular");
        let h = vector(&BiasForces::second_way(g)[0]);
        let Lambda = (&J * &M * J.transpose()).try_inverse().expect("regular");
        let eta = &Lambda * (&J * &M * h - dJ * vector(g.inputs[1]));
        vec![rows(&Lambda), eta.as_slice().to_vec()]
    };
    InverseDynamicsDerivatives: |g| g.tau_derivatives(g.inputs[2]).iter().map(rows).collect();
    ForwardDynamicsDerivatives [1e-6]: |g| {
        let ddtheta = g.acceleration();
        let [d_theta, d_dtheta, M] = g.tau_derivatives(ddtheta.as_slice());
        let inverse = M.try_inverse().expect("regular");
        let (d_theta, d_dtheta) = (-&inverse * d_theta, -&inverse * d_dtheta);
        vec![ddtheta.as_slice().to_vec(), rows(&d_theta), rows(&d_dtheta), rows(&inverse)]
    };
    GravityForcesDerivative: |g| vec![rows(&g.by_theta(GravityForces, &[]))];
    TipForcesDerivative: |g| vec![rows(&g.by_theta(TipForces, &[]))];
    MassMatrixProductDerivative: |g| {
        let by = g.by_theta(MassMatrix, &[]); // n² × n
        let n = g.n();
        let entry = |i: usize, j: usize| (0..n).map(|k| by[(i * n + k, j)] * g.inputs[1][k]).sum();
        vec![rows(&Matrix::from_fn(n, n, entry))]
    };
    CenterOfMass: |g| vec![g.center().0.to_vec()];
    CenterOfMassVelocity: |g| vec![(g.momentum().f * (1.0 / g.mass())).0.to_vec()];
    CenterOfMassAcceleration: |g| vec![(g.momentum_rate(g.inputs[2]).f * (1.0 / g.mass())).0.to_vec()];
    CenterOfMassJacobian: |g| {
        let columns = momentum_columns(g.model, g.theta());
        vec![(0..3).flat_map(|row| columns.iter().map(move |column| column.f.0[row])).map(|x| x / g.mass()).collect()]
    };
    Momentum: |g| vec![g.momentum().about(g.of.point).to_array().to_vec()];
    MomentumRate: |g| vec![g.momentum_rate(g.inputs[2]).about(g.of.point).to_array().to_vec()];
    CentroidalMomentumMatrix: |g| {
        let columns: Vec<[f64; 6]> =
            momentum_columns(g.model, g.theta()).iter().map(|column| column.about(g.center()).to_array()).collect();
        vec![(0..6).flat_map(|row| columns.iter().map(move |column| column[row])).collect()]
    };
    CentroidalMomentumBias: |g| vec![g.momentum_rate(&vec![0.0; g.n()]).about(g.center()).to_array().to_vec()];
    Regressor: |g| {
        let environment = Environment { applied: &[], ..*g.environment };
        let tau = |model: &Model| {
            model.inverse_dynamics(g.inputs[0], g.inputs[1], g.inputs[2], &environment).expect("lengths").as_slice().to_vec()
        };
        vec![rows(&g.by_parameters(tau))]
    };
    EnergyRegressors: |g| {
        let energy = |query: Query<'static>| move |model: &Model| {
            let inputs = &g.inputs[..query.declaration().inputs.len()];
            model.compute(query, inputs, g.environment).expect("lengths").remove(0)
        };
        vec![rows(&g.by_parameters(energy(KineticEnergy.into()))), rows(&g.by_parameters(energy(PotentialEnergy.into())))]
    };
}
