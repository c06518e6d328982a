//! Which parameters the motion determines, and which motion would determine the others.

use crate::columns::{Columns, Equations, Kind};
use crate::signals::Samples;
use crate::{Error, Identification};
use mozzi::random::Random;

/// One combination of parameters that some motion can determine.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// The combination: `link1.Izz + 0.25 link2.m`.
    pub name: String,
    /// By the robot's own values.
    pub robot: f64,
    /// By least squares.
    pub least_squares: f64,
    /// The value of the physically consistent estimate.
    pub consistent: f64,
    /// The standard deviation of least squares; infinite if the motion does not determine it.
    pub deviation: f64,
    /// Change of the forces by one standard deviation, relative to their root mean square.
    pub effect: f64,
    /// Advice for a better log, if the parameter is not determined well.
    pub advice: Option<String>,
}

impl Parameter {
    /// Whether the standard deviation is larger than the value, and more than 1 % of the forces: a parameter that is 0
    /// for certain is determined.
    pub fn is_weak(&self) -> bool {
        !(self.deviation < self.least_squares.abs()) && !(self.effect < 0.01)
    }
}

/// All base parameters of an identification.
///
/// # Errors
/// [`Error::Model`].
pub fn parameters(found: &Identification<'_>) -> Result<Vec<Parameter>, Error> {
    let (setup, estimates) = (&found.setup, &found.estimates);
    let columns = &setup.columns;
    let robot = setup.base.values(&columns.prior());
    let consistent = setup.base.values(&estimates.consistent.predicting());
    let advisor = Advisor::new(columns)?;
    let evidence = found.evidence();
    let force: Vec<f64> = evidence.rms().iter().map(|rms| rms.max(f64::MIN_POSITIVE.sqrt())).collect();
    let relative = evidence.weighted(&force);
    let mut all = Vec::new();
    for (row, name) in setup.base.names().into_iter().enumerate() {
        let k = setup.base.columns[row];
        let mut one = Parameter {
            name,
            robot: robot[row],
            least_squares: estimates.least_squares.values[row],
            consistent: consistent[row],
            deviation: estimates.least_squares.deviations[row],
            effect: estimates.least_squares.deviations[row] * relative.R.column(k).norm(),
            advice: None,
        };
        if one.is_weak() {
            one.advice = Some(advisor.advice(k));
        }
        all.push(one);
    }
    Ok(all)
}

/// Knows how strongly each motion of one joint acts on each column.
struct Advisor<'c, 'm> {
    columns: &'c Columns<'m>,
    joints: Vec<String>,
    /// By column: root mean squares of its entries when joint j alone accelerates at 1 rad/s².
    accelerated: Vec<Vec<f64>>,
    /// By column: when joint j alone turns at 1 rad/s.
    turning: Vec<Vec<f64>>,
    /// By column: the change of its entries at rest when joint j turns.
    tilted: Vec<Vec<f64>>,
}

/// Random postures.
const POSTURES: usize = 8;

impl<'c, 'm> Advisor<'c, 'm> {
    fn new(columns: &'c Columns<'m>) -> Result<Self, Error> {
        let (model, P) = (columns.model, columns.count());
        let n = model.n();
        let joints = model.velocity_names().map(str::to_string).collect();
        let mut equations = Equations::new(columns, &Samples::default())?;
        let zeros = vec![0.0; n];
        let mut at = |theta: &[f64], dtheta: &[f64], ddtheta: &[f64]| {
            let (mut A, mut b) = (vec![0.0; n * P], vec![0.0; n]);
            equations.at([theta, dtheta, ddtheta, &zeros], &mut A, &mut b);
            A
        };
        let empty = vec![vec![0.0; n]; P];
        let (mut accelerated, mut turning, mut tilted) = (empty.clone(), empty.clone(), empty);
        let mut random = Random(5);
        for _ in 0..POSTURES {
            let mut theta = model.neutral_configuration();
            mozzi::model::integrate(model, &mut theta, &random.vector(n, 2.0), 1.0);
            let rest = at(&theta, &zeros, &zeros);
            for j in 0..n {
                let unit: Vec<f64> = (0..n).map(|i| if i == j { 1.0 } else { 0.0 }).collect();
                let mut turned = theta.clone();
                mozzi::model::integrate(model, &mut turned, &unit, 1.0);
                let cases = [
                    (at(&theta, &zeros, &unit), &mut accelerated),
                    (at(&theta, &unit, &zeros), &mut turning),
                    (at(&turned, &zeros, &zeros), &mut tilted),
                ];
                for (A, sums) in cases {
                    for k in 0..P {
                        sums[k][j] += (0..n).map(|i| (A[i * P + k] - rest[i * P + k]).powi(2)).sum::<f64>();
                    }
                }
            }
        }
        Ok(Advisor { columns, joints, accelerated, turning, tilted })
    }

    /// Advice for a log that determines column k.
    fn advice(&self, k: usize) -> String {
        let kind = self.columns.unknowns[k].kind;
        let name = self.columns.unknowns[k].name.rsplit_once('.').map_or("", |(joint, _)| joint);
        match kind {
            Kind::Viscous(_) | Kind::RotorViscous(_) => format!("move {name} at different speeds"),
            Kind::Coulomb(_) | Kind::RotorCoulomb(_) | Kind::Stribeck(_) => {
                format!("let {name} reverse, and move it slowly in both directions")
            }
            Kind::Offset(_) => format!("move {name} in both directions at the same postures"),
            Kind::Stiffness(_) => format!("move {name} through its range"),
            Kind::Gain(_) => "carry a payload of known mass in a further log".to_string(),
            Kind::Armature(_) | Kind::Apparent(_) => format!("accelerate {name} more"),
            Kind::Link(_) | Kind::Payload(_) => {
                let most = |sums: &[f64]| {
                    sums.iter().enumerate().fold((0, 0.0), |a, (j, &x)| if x > a.1 { (j, x) } else { a })
                };
                // 5 rad/s² and 1 rad/s are what arms do
                let (a, by_acceleration) = most(&self.accelerated[k]);
                let (v, by_velocity) = most(&self.turning[k]);
                let (t, by_gravity) = most(&self.tilted[k]);
                let by_acceleration = 25.0 * by_acceleration;
                if by_gravity >= by_acceleration && by_gravity >= by_velocity {
                    format!("turn {} through a wider range, against gravity", self.joints[t])
                } else if by_acceleration >= by_velocity {
                    format!("accelerate {} more", self.joints[a])
                } else {
                    format!("turn {} faster", self.joints[v])
                }
            }
        }
    }
}
