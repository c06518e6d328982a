//! A second way to compute every quantity, independent of its kernel: the book's stacked equations, links one by one
//! from the description, dual numbers, linearity in the parameters.

use crate::bodies::{frame, twist};
use crate::constraints::saddle;
use crate::given::{Given, dot, list, rows, unit, vector, zeros};
use crate::linear::inverse;
use mozzi::model::seed_direction;
use mozzi::nalgebra::{DMatrix, DVector};
use mozzi::quantities::*;
use mozzi::{Dual, Entry, Environment, SE3, Scalar, TaskFrame, Twist, Vec3};

/// A quantity's second way. A quantity without one does not compile.
pub trait SecondWay: Quantity {
    /// The tolerance of the kernel in `f64`, relative to the largest entry.
    const TOLERANCE: f64 = 1e-11;
    /// The outputs, matrices by rows.
    fn second_way<S: Entry>(given: Given<S>) -> Vec<Vec<S>>;
}

type Way<S> = fn(Given<S>) -> Vec<Vec<S>>;

/// The outputs of the quantity at this index of the [list](LIST).
pub fn second_way<S: Entry>(index: usize, given: Given<S>) -> Vec<Vec<S>> {
    macro_rules! ways {
        ($($Q:ident)*) => { &[$(<$Q as SecondWay>::second_way::<S>),*] };
    }
    let ways: &[Way<S>] = mozzi::quantities!(ways);
    ways[index](given)
}

/// [`second_way`] on `f64`, compiled here and not, less optimised, in each test.
pub fn second_way_of_f64(index: usize, given: Given) -> Vec<Vec<f64>> {
    second_way(index, given)
}

/// The rows of a Jacobian, or of the momentum matrix, from its columns.
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
        // friction and springs are the difference of τ and c if nothing else acts
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
        // the rates of ω and ṗ in {s} along the motion, rotated into the frame's coordinates
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
    ConstraintJacobian: |g| vec![g.constraints().A.concat()];
    ConstraintBias: |g| vec![g.constraint_bias()];
    ConstraintResidual: |g| vec![g.constraints().phi];
    ConstrainedForwardDynamics [1e-6]: |g| {
        let form = g.form(g.inputs[1], g.environment);
        let force = vector(g.inputs[2]) - form.inverse_dynamics(&DVector::zeros(g.n()));
        let a: Vec<S> = g.constraint_bias().into_iter().map(|x| -x).collect();
        let (ddtheta, lambda) = saddle(&form.mass_matrix(), &g.constraints().A, &force, &a);
        vec![ddtheta, lambda]
    };
    ConstraintProjection [1e-6]: |g| {
        // column by column: the part of a force that the constraints do not absorb
        let (n, A, M) = (g.n(), g.constraints().A, g.at_rest().mass_matrix());
        let still = zeros(A.len());
        let column = |j: usize| &M * vector(&saddle(&M, &A, &vector(&unit(n, j)), &still).0);
        vec![rows(&DMatrix::from_columns(&(0..n).map(column).collect::<Vec<_>>()))]
    };
    ConstraintImpulse [1e-6]: |g| {
        let M = g.at_rest().mass_matrix();
        let A = g.constraints().A;
        let (after, impulse) = saddle(&M, &A, &(&M * vector(g.inputs[1])), &zeros(A.len()));
        vec![after, impulse]
    };
    InverseDynamicsDerivatives: |g| g.tau_derivatives(g.inputs[2]).iter().map(rows).collect();
    ForwardDynamicsDerivatives [1e-6]: |g| {
        let ddtheta = list(&g.acceleration());
        let [d_theta, d_dtheta, M] = g.tau_derivatives(&ddtheta);
        let inverse = inverse(&M).expect("regular");
        let (d_theta, d_dtheta) = (-&inverse * d_theta, -&inverse * d_dtheta);
        vec![ddtheta, rows(&d_theta), rows(&d_dtheta), rows(&inverse)]
    };
    InverseDynamicsVjp: |g| {
        let x = vector(g.inputs[3]);
        g.tau_derivatives(g.inputs[2]).iter().map(|X| list(&X.tr_mul(&x))).collect()
    };
    ForwardDynamicsVjp [1e-6]: |g| {
        let [d_theta, d_dtheta, M] = g.tau_derivatives(&list(&g.acceleration()));
        let y = inverse(&M).expect("regular") * vector(g.inputs[3]);
        vec![list(&-d_theta.tr_mul(&y)), list(&-d_dtheta.tr_mul(&y)), list(&y)]
    };
    InverseDynamicsParameterVjp: |g| {
        g.by_robot(g.inputs[2], g.inputs[3])
    };
    ForwardDynamicsParameterVjp [1e-6]: |g| {
        let y = inverse(&g.at_rest().mass_matrix()).expect("regular") * vector(g.inputs[3]);
        g.by_robot(&list(&g.acceleration()), &list(&-y))
    };
    MassMatrixProductVjp: |g| {
        let [a, x] = [g.inputs[1], g.inputs[2]].map(Dual::constants);
        let d_theta = g.gradient(0, |g| dot(&x, &list(&(g.at_rest().mass_matrix() * vector(&a)))));
        vec![d_theta, list(&(g.at_rest().mass_matrix() * vector(g.inputs[2])))]
    };
    EnergyGradients: |g| {
        let kinetic = |k: usize| g.gradient(k, |g| g.kinetic_energy());
        let potential = |g: &Given<Dual<S>>| PotentialEnergy::second_way(*g)[0][0];
        vec![kinetic(0), kinetic(1), g.gradient(0, potential)]
    };
    FrameTwistVjp: |g| {
        let w = Dual::constants(g.inputs[2]);
        let of = |g: &Given<Dual<S>>| dot(&w, &twist(&g.jacobian(TaskFrame::Body), g.inputs[1]).to_array());
        vec![g.gradient(0, of), g.gradient(1, of)]
    };
    FrameAccelerationVjp: |g| {
        let w = Dual::constants(g.inputs[3]);
        [0, 1, 2].map(|k| g.gradient(k, |g| dot(&w, &FrameAcceleration::second_way(*g)[0]))).to_vec()
    };
    MomentumVjp: |g| {
        let w = Dual::constants(g.inputs[2]);
        [0, 1].map(|k| g.gradient(k, |g| dot(&w, &Momentum::second_way(*g)[0]))).to_vec()
    };
    MomentumRateVjp: |g| {
        let w = Dual::constants(g.inputs[3]);
        [0, 1, 2].map(|k| g.gradient(k, |g| dot(&w, &MomentumRate::second_way(*g)[0]))).to_vec()
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
