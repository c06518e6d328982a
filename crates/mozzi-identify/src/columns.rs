//! The linear equations A x = b of one sample: which unknowns there are, and their columns.

use crate::choice::Choice;
use crate::rotors::{rate, rates};
use crate::signals::Samples;
use crate::{Error, payload::Carried};
use mozzi::quantities::{Query, Regressor, TipForces};
use mozzi::{Environment, Model, fast};

/// The parameter of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Entry k of the robot's [`parameters`](Model::parameters): a link's.
    Link(usize),
    /// Rotor inertia: entry k of the parameters.
    Armature(usize),
    /// Viscous friction: entry k of the parameters.
    Viscous(usize),
    /// Coulomb friction: entry k of the parameters.
    Coulomb(usize),
    /// Viscous friction of a rotor that several joints turn.
    RotorViscous(usize),
    /// Its Coulomb friction.
    RotorCoulomb(usize),
    /// An apparent rotor inertia of entry k, from forces behind the gears, which rotors do not affect; not part of the
    /// robot.
    Apparent(usize),
    /// Stribeck friction of an independent joint.
    Stribeck(usize),
    /// Stiffness: entry k of the parameters.
    Stiffness(usize),
    /// A constant force of row j.
    Offset(usize),
    /// Parameter k of the payload.
    Payload(usize),
    /// The drive gain of row j.
    Gain(usize),
}

impl Kind {
    /// Whether the parameter cannot be negative by itself.
    pub fn is_positive(self) -> bool {
        matches!(
            self,
            Kind::Armature(_)
                | Kind::Viscous(_)
                | Kind::Coulomb(_)
                | Kind::RotorViscous(_)
                | Kind::RotorCoulomb(_)
                | Kind::Stiffness(_)
                | Kind::Gain(_)
        )
    }
}

/// A parameter that is estimated.
#[derive(Clone, Debug, PartialEq)]
pub struct Unknown {
    /// As in [`parameter_names`](Model::parameter_names); `joint.stribeck`, `joint.offset`, `payload.m`, `joint.gain`,
    /// `joint.apparent_inertia`.
    pub name: String,
    /// The parameter's kind.
    pub kind: Kind,
    /// The robot's own value.
    pub prior: f64,
}

/// A kind of a parameter, by its entry.
type KindOf = fn(usize) -> Kind;

/// Joint parameters in [`parameters`](Model::parameters): armature, damping, friction, stiffness, preload.
const OF_JOINT: usize = 5;

/// The number of link parameters, which come first.
fn link_parameters(model: &Model) -> usize {
    10 * (model.moving_links() + usize::from(model.is_floating()))
}

/// The unknowns of a robot, and how the others are fixed.
#[derive(Clone, Debug)]
pub struct Columns<'m> {
    /// The robot.
    pub model: &'m Model,
    /// The choice of parameters to estimate.
    pub choice: Choice,
    /// The columns, in order.
    pub unknowns: Vec<Unknown>,
    /// Entries of the parameters that are not estimated and not 0.
    fixed: Vec<(usize, f64)>,
    /// Coulomb friction that is not estimated, by place.
    fixed_coulomb: Vec<f64>,
    pub(crate) payload: Option<Carried>,
    /// By rotor: its rate over each velocity.
    pub(crate) rotors: Vec<Vec<f64>>,
    /// The row of each joint parameter, by place.
    pub(crate) rows: Vec<core::ops::Range<usize>>,
}

impl<'m> Columns<'m> {
    /// The columns of a choice.
    ///
    /// # Errors
    /// [`Error::NotExciting`] if nothing is to be estimated; [`Error::BadOption`] for a width that is not positive.
    pub fn new(model: &'m Model, choice: Choice) -> Result<Self, Error> {
        for (option, width) in
            [("the width of Coulomb friction", Some(choice.width)), ("Stribeck's velocity", choice.stribeck)]
        {
            if width.is_some_and(|width| !(width > 0.0 && width.is_finite())) {
                let found = format!("{} rad/s", width.unwrap_or_default());
                return Err(Error::BadOption { option, found, expected: "a positive velocity".into() });
            }
        }
        let (names, values) = (model.parameter_names(), model.parameters());
        let places = model.places();
        let first = link_parameters(model);
        let (mut unknowns, mut fixed, mut fixed_coulomb) = (Vec::new(), Vec::new(), vec![0.0; places.len()]);
        let mut add = |name: String, kind: Kind, prior: f64| unknowns.push(Unknown { name, kind, prior });
        for k in 0..first {
            match choice.links {
                true => add(names[k].clone(), Kind::Link(k), values[k]),
                false => fixed.push((k, values[k])),
            }
        }
        let kinds: [(bool, KindOf); 5] = [
            (choice.armature, Kind::Armature),
            (choice.viscous, Kind::Viscous),
            (choice.coulomb, Kind::Coulomb),
            (choice.stiffness, Kind::Stiffness),
            (false, Kind::Stiffness), // the preload
        ];
        for (entry, (is_chosen, kind)) in kinds.into_iter().enumerate() {
            for place in 0..places.len() {
                let k = first + OF_JOINT * place + entry;
                match (is_chosen, entry) {
                    (true, _) => add(names[k].clone(), kind(k), values[k]),
                    (false, 2) => fixed_coulomb[place] = values[k],
                    (false, _) => fixed.push((k, values[k])),
                }
            }
        }
        for k in first + OF_JOINT * places.len()..model.parameter_count() {
            match choice.armature {
                true => add(names[k].clone(), Kind::Armature(k), values[k]),
                false => fixed.push((k, values[k])),
            }
        }
        for (r, rotor) in model.description().rotors.iter().enumerate() {
            if choice.viscous {
                add(format!("{}.damping", rotor.name), Kind::RotorViscous(r), 0.0);
            }
            if choice.coulomb {
                add(format!("{}.friction", rotor.name), Kind::RotorCoulomb(r), 0.0);
            }
        }
        let joints: Vec<&str> = model.joint_names().collect();
        if choice.stribeck.is_some() {
            joints.iter().enumerate().for_each(|(k, joint)| add(format!("{joint}.stribeck"), Kind::Stribeck(k), 0.0));
        }
        let base = if model.is_floating() { 6 } else { 0 };
        let rows: Vec<&str> = model.velocity_names().collect();
        if choice.offset {
            (base..model.n()).for_each(|j| add(format!("{}.offset", rows[j]), Kind::Offset(j), 0.0));
        }
        if choice.is_apparent() && !choice.armature {
            let joints = model.joint_names().zip(0..);
            joints.for_each(|(joint, place)| {
                add(format!("{joint}.apparent_inertia"), Kind::Apparent(first + OF_JOINT * place), 0.0);
            });
        }
        let payload = choice.payload.map(|frame| Carried::new(model, frame)).transpose()?;
        if payload.is_some() {
            for (k, name) in names.iter().take(10).enumerate() {
                let name = name.rsplit('.').next().unwrap_or_default();
                add(format!("payload.{name}"), Kind::Payload(k), 0.0);
            }
        }
        if choice.gains {
            (base..model.n()).for_each(|j| add(format!("{}.gain", rows[j]), Kind::Gain(j), 1.0));
        }
        fixed.retain(|(_, value)| *value != 0.0);
        if unknowns.is_empty() {
            return Err(Error::NotExciting { reason: "no parameter is chosen to be estimated".into() });
        }
        let rows = places.iter().map(|place| place.velocities()).collect();
        Ok(Columns { model, choice, unknowns, fixed, fixed_coulomb, payload, rotors: rates(model), rows })
    }

    /// The number of unknowns.
    pub fn count(&self) -> usize {
        self.unknowns.len()
    }

    /// The first columns of each link's ten parameters, and of the payload's.
    pub fn bodies(&self) -> Vec<usize> {
        let is_first = |unknown: &Unknown| match unknown.kind {
            Kind::Link(k) | Kind::Payload(k) => k % 10 == 0,
            _ => false,
        };
        (0..self.count()).filter(|&k| is_first(&self.unknowns[k])).collect()
    }

    /// The unit of unknown k.
    pub fn unit(&self, k: usize) -> &'static str {
        let Unknown { name, kind, .. } = &self.unknowns[k];
        let joint = name.rsplit_once('.').map_or("", |(joint, _)| joint);
        let joint = self.model.description().joints.iter().find(|one| one.name == joint);
        let slides = joint.is_some_and(
            |joint| matches!(joint.kind, mozzi::model::description::JointKind::Screw(A) if A.is_prismatic()),
        );
        match (kind, slides) {
            (Kind::Link(k) | Kind::Payload(k), _) => ["kg", "kg m", "kg m²"][[0, 1, 1, 1, 2, 2, 2, 2, 2, 2][k % 10]],
            (Kind::Armature(_) | Kind::Apparent(_), false) => "kg m²",
            (Kind::Armature(_) | Kind::Apparent(_), true) => "kg",
            (Kind::Viscous(_) | Kind::RotorViscous(_), false) => "N m s/rad",
            (Kind::Viscous(_) | Kind::RotorViscous(_), true) => "N s/m",
            (Kind::Stiffness(_), false) => "N m/rad",
            (Kind::Stiffness(_), true) => "N/m",
            (Kind::Coulomb(_) | Kind::RotorCoulomb(_) | Kind::Stribeck(_) | Kind::Offset(_), false) => "N m",
            (Kind::Coulomb(_) | Kind::RotorCoulomb(_) | Kind::Stribeck(_) | Kind::Offset(_), true) => "N",
            (Kind::Gain(_), false) => "N m/A",
            (Kind::Gain(_), true) => "N/A",
        }
    }

    /// The robot's own values.
    pub fn prior(&self) -> Vec<f64> {
        self.unknowns.iter().map(|unknown| unknown.prior).collect()
    }

    /// The index of a kind.
    pub fn index(&self, kind: Kind) -> Option<usize> {
        self.unknowns.iter().position(|unknown| unknown.kind == kind)
    }

    /// The first row of the joint whose parameters hold entry k.
    pub(crate) fn row_of(&self, k: usize) -> usize {
        self.rows[self.place_of(k)].start
    }

    /// Whether entry k belongs to one joint, not to a rotor that several joints turn.
    pub(crate) fn is_of_joint(&self, k: usize) -> bool {
        k < link_parameters(self.model) + OF_JOINT * self.rows.len()
    }

    /// The index of the joint whose parameters hold entry k.
    fn place_of(&self, k: usize) -> usize {
        (k - link_parameters(self.model)) / OF_JOINT
    }
}

/// Fills the equations of one sample after another.
pub struct Equations<'c, 'm> {
    columns: &'c Columns<'m>,
    workspace: fast::Workspace,
    query: Query<'static>,
    Y: Vec<f64>,
    JtF: Vec<f64>,
    /// Entries of the parameters that are known: those that are not estimated, and the log's payload.
    known: Vec<(usize, f64)>,
}

impl<'c, 'm> Equations<'c, 'm> {
    /// Memory for the equations of these samples.
    ///
    /// # Errors
    /// [`Error::Model`] if a payload's frame belongs to another model.
    pub fn new(columns: &'c Columns<'m>, samples: &Samples) -> Result<Self, Error> {
        let model = columns.model;
        let mut known = columns.fixed.clone();
        if let Some((frame, inertia)) = samples.payload {
            let mut payload = vec![0.0; model.parameter_count()];
            Carried::new(model, frame)?.add(&mut payload, &inertia.to_parameters());
            known.extend(payload.into_iter().enumerate().filter(|(_, value)| *value != 0.0));
        }
        Ok(Equations {
            columns,
            workspace: fast::Workspace::new(model),
            query: Query::from(Regressor),
            Y: vec![0.0; model.n() * model.parameter_count()],
            JtF: vec![0.0; model.n()],
            known,
        })
    }

    /// The equations of sample k: A, n × P by rows, and b.
    pub fn fill(&mut self, samples: &Samples, k: usize, A: &mut [f64], b: &mut [f64]) {
        let model = self.columns.model;
        let (n, nq) = (model.n(), model.nq());
        let theta = &samples.theta[k * nq..][..nq];
        let row = k * n..(k + 1) * n;
        let (dtheta, ddtheta) = (&samples.dtheta[row.clone()], &samples.ddtheta[row.clone()]);
        let tau = &samples.tau[row];
        let all = n + self.columns.rotors.len();
        let of_row = |table: &Option<Vec<f64>>| table.as_ref().map(|table| table[k * all..(k + 1) * all].to_vec());
        let friction = [of_row(&samples.coulomb), of_row(&samples.stribeck)];
        self.with_friction([theta, dtheta, ddtheta, tau], friction, A, b);
        if !samples.wrenches.is_empty() {
            // JᵀF depends on no parameter
            let environment =
                Environment { applied: &samples.applied(k), ..Environment::with_gravity(mozzi::Vec3::zero()) };
            let query = Query::from(TipForces);
            fast::evaluate(&query, model, &[theta], &environment, &mut self.workspace, &mut [&mut self.JtF]);
            b.iter_mut().zip(&self.JtF).for_each(|(b, JtF)| *b -= JtF);
        }
    }

    /// The equations at a state θ, θ̇, θ̈, τ.
    pub fn at(&mut self, state: [&[f64]; 4], A: &mut [f64], b: &mut [f64]) {
        self.with_friction(state, [None, None], A, b);
    }

    /// Writes the equations with Coulomb and Stribeck friction of unit size, if given, instead of the friction of θ̇.
    fn with_friction(
        &mut self,
        [theta, dtheta, ddtheta, tau]: [&[f64]; 4],
        [coulomb, stribeck]: [Option<Vec<f64>>; 2],
        A: &mut [f64],
        b: &mut [f64],
    ) {
        let columns = self.columns;
        let (model, choice, P) = (columns.model, &columns.choice, columns.count());
        let (n, p) = (model.n(), model.parameter_count());
        let environment = model.environment();
        let inputs = [theta, dtheta, ddtheta];
        fast::evaluate(&self.query, model, &inputs, &environment, &mut self.workspace, &mut [&mut self.Y]);
        let Y = &self.Y;
        A.fill(0.0);
        b.copy_from_slice(tau);
        let shape = choice.shape();
        let of = |given: Option<Vec<f64>>, of_one: &dyn Fn(f64) -> f64| {
            let speeds = dtheta.iter().copied().chain(columns.rotors.iter().map(|J| rate(J, dtheta)));
            given.unwrap_or_else(|| speeds.map(of_one).collect::<Vec<f64>>())
        };
        let coulomb = of(coulomb, &|x| shape.coulomb(x));
        let stribeck = of(stribeck, &|x| shape.stribeck(x));
        for (column, unknown) in columns.unknowns.iter().enumerate() {
            match unknown.kind {
                Kind::Link(k) | Kind::Armature(k) | Kind::Viscous(k) | Kind::Stiffness(k) | Kind::Apparent(k) => {
                    (0..n).for_each(|j| A[j * P + column] = Y[j * p + k]);
                }
                Kind::Coulomb(k) => {
                    columns.rows[columns.place_of(k)].clone().for_each(|j| A[j * P + column] = coulomb[j]);
                }
                Kind::RotorViscous(r) | Kind::RotorCoulomb(r) => {
                    let J = &columns.rotors[r];
                    let is_viscous = matches!(unknown.kind, Kind::RotorViscous(_));
                    let of_rotor = if is_viscous { rate(J, dtheta) } else { coulomb[n + r] };
                    (0..n).for_each(|j| A[j * P + column] = J[j] * of_rotor);
                }
                Kind::Stribeck(place) => {
                    columns.rows[place].clone().for_each(|j| A[j * P + column] = stribeck[j]);
                }
                Kind::Offset(j) => A[j * P + column] = 1.0,
                Kind::Gain(j) => {
                    A[j * P + column] = -tau[j];
                    b[j] = 0.0;
                }
                Kind::Payload(k) => {
                    if let Some(carried) = &columns.payload {
                        (0..n).for_each(|j| A[j * P + column] = carried.column(&Y[j * p..][..p], k));
                    }
                }
            }
        }
        for j in 0..n {
            b[j] -= self.known.iter().map(|&(k, value)| Y[j * p + k] * value).sum::<f64>();
        }
        for (rows, &mu) in columns.rows.iter().zip(&columns.fixed_coulomb) {
            if mu != 0.0 {
                rows.clone().for_each(|j| b[j] -= mu * coulomb[j]);
            }
        }
    }
}
