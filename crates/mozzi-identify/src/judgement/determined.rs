//! Parameters, or combinations of parameters, that the data determines.

use crate::Identification;
use crate::judgement::excitation::Parameter;

/// Smaller factors in a combination are rounding.
const THERE: f64 = 1e-9;

/// How well the data determines one unknown.
#[derive(Clone, Debug, PartialEq)]
pub struct Standing {
    /// √(σ² + (x − x_LS)²) if the data determines the unknown by itself: the noise, and how far the prior and bounds
    /// draw it from least squares.
    pub deviation: Option<f64>,
    /// Otherwise the combinations with it that are determined, the shortest first; none if no force depends on it, or
    /// if the motion determines none of them.
    pub only: Vec<String>,
}

impl Standing {
    /// The deviation with its digits, or what is determined instead.
    pub fn text(&self) -> String {
        match (self.deviation, self.only.first()) {
            (Some(deviation), _) => format!("± {deviation:.4}"),
            (None, None) => "not determined".into(),
            (None, Some(only)) => {
                let short: String = only.chars().take(SHOWN).collect();
                let more = if only.chars().count() > SHOWN { " …" } else { "" };
                format!("not determined; only {short}{more}")
            }
        }
    }
}

/// Letters of a combination that a table shows.
const SHOWN: usize = 48;

/// By unknown: it is determined by itself if it is a base parameter without others in it, whose deviation is below its
/// value or below 1 % of the forces.
pub fn standings(found: &Identification<'_>, parameters: &[Parameter]) -> Vec<Standing> {
    let (setup, K) = (&found.setup, &found.setup.base.combination);
    let count = setup.columns.count();
    let with = |k: usize| (0..K.nrows()).filter(move |&row| K[(row, k)].abs() > THERE);
    let of = |k: usize| {
        if let Some(row) = setup.alone(k) {
            let bias = found.estimates.consistent.predicting()[k] - found.estimates.least_squares.x[k];
            let deviation = parameters[row].deviation.hypot(bias);
            return Standing { deviation: (!parameters[row].is_weak()).then_some(deviation), only: Vec::new() };
        }
        let strong = with(k).filter(|&row| !parameters[row].is_weak());
        let mut only: Vec<String> = strong.map(|row| parameters[row].name.clone()).collect();
        only.sort_by_key(String::len);
        Standing { deviation: None, only }
    };
    (0..count).map(of).collect()
}
