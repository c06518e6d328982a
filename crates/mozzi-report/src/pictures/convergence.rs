//! How the error of each method falls with its step.

use crate::figure::{Curve, Figure, Panel, Scale, Stroke};
use mozzi::simulation::{Method, Options};
use mozzi::{Error, Model, Trajectory, difference};

const METHODS: [Method; 3] = [Method::Euler, Method::SemiImplicitEuler, Method::RungeKutta4];

/// The reference takes so many times as many steps as the finest that is compared with it, by the method of highest order.
const FINER: usize = 4;

/// Errors of one method.
#[derive(Clone, Debug, PartialEq)]
pub struct Convergence {
    /// The method.
    pub method: Method,
    /// (h, error): step in seconds, and the largest entry of θ(t_f) ⊖ θ_reference(t_f).
    pub errors: Vec<[f64; 2]>,
}

/// Errors at the end of a motion, for steps halved from the given number of them: `simulate` runs it under options. The reference is
/// Runge-Kutta 4 with a quarter of the shortest step.
///
/// # Errors
/// What `simulate` answers.
pub fn convergence(
    model: &Model,
    duration: f64,
    coarsest: usize,
    halvings: usize,
    mut simulate: impl FnMut(&Options) -> Result<Trajectory, Error>,
) -> Result<Vec<Convergence>, Error> {
    let mut end = |method, steps: usize| {
        let options = Options { method, record_every: steps, ..Options::new(duration, steps) };
        Ok(simulate(&options)?.last().theta.to_vec())
    };
    let reference = end(Method::RungeKutta4, (FINER * coarsest) << halvings)?;
    let mut found = Vec::new();
    for method in METHODS {
        let mut errors = Vec::new();
        for halving in 0..=halvings {
            let steps = coarsest << halving;
            let mut apart = vec![0.0; model.n()];
            match end(method, steps) {
                Ok(theta) => difference(model, &reference, &theta, &mut apart),
                Err(Error::Diverged { .. }) => continue, // too long a step for this method: no point of the curve
                Err(other) => return Err(other),
            }
            errors.push([duration / steps as f64, apart.iter().fold(0.0, |most: f64, x| most.max(x.abs()))]);
        }
        found.push(Convergence { method, errors });
    }
    Ok(found)
}

impl Convergence {
    /// The order that the last two errors show, log₂ of their ratio.
    pub fn measured_order(&self) -> Option<f64> {
        let [.., coarse, fine] = self.errors[..] else { return None };
        Some((coarse[1] / fine[1]).log2())
    }

    /// All methods in one panel, with the slopes that their orders promise as dashed lines.
    pub fn figure(title: impl Into<String>, found: &[Convergence]) -> Figure {
        let mut curves = Vec::new();
        for (color, Convergence { method, errors }) in found.iter().enumerate() {
            let name = format!("{} (order {})", method.name(), method.order());
            if let [first, .., last] = errors[..] {
                let promised = |h: f64| last[1] * (h / last[0]).powi(method.order() as i32);
                let slope = vec![[first[0], promised(first[0])], last];
                curves.push(Curve { name: String::new(), color, stroke: Stroke::Dashed, points: slope });
            }
            curves.push(Curve { name, color, stroke: Stroke::Marked, points: errors.clone() });
        }
        let panel = Panel {
            x_label: "step h [s]".into(),
            y_label: "error of θ at the end [rad, m]".into(),
            scale: Scale::Logarithmic,
            curves,
            equal: false,
        };
        Figure { title: title.into(), panels: vec![panel], columns: 1 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mozzi::simulation::Zero;

    #[test]
    fn methods_have_their_orders() {
        let model = mozzi_urdf::open("double_pendulum").and_then(mozzi_urdf::Loaded::build).expect("embedded");
        let run = |options: &Options| model.simulate(&[1.0, 0.3], &[0.0; 2], Zero, options);
        let found = convergence(&model, 0.5, 64, 3, run).expect("errors");
        for each in &found {
            let order = each.measured_order().expect("four errors");
            assert!((order - f64::from(each.method.order())).abs() < 0.5, "{:?}", each);
        }
        let svg = Convergence::figure("", &found).svg();
        assert!(svg.contains("Runge-Kutta 4 (order 4)") && svg.contains("10⁻"));
    }
}
