//! Errors of many states, in units.

use crate::Double;
use crate::accuracy::reference::Reference;
use mozzi::Scalar;

/// Threshold for zero: a smaller entry, relative to the largest entry, is 0 in 31 digits.
const ZERO: f64 = 1e-24;

/// The unit of such an entry relative to the largest: the rounding error of 31 digits over that of `f64`.
const NO_UNIT: f64 = 1e-10;

/// The errors of one quantity computed in one way.
#[derive(Clone, Debug, Default)]
pub struct Errors {
    /// For each state: the largest error of an output over the output's largest unit.
    whole: Vec<f32>,
    /// For each state: the largest error of an entry over the entry's own unit; entries that are 0 do not count.
    entries: Vec<f32>,
    /// For each state, if the formula's terms are known: the largest error of an output over ε times the output's
    /// largest term.
    terms: Vec<f32>,
}

/// The largest error, the 99.9th percentile over the states, and the median.
#[derive(Clone, Copy, Debug, Default)]
pub struct Summary {
    /// The largest.
    pub max: f64,
    /// The 99.9th percentile.
    pub most: f64,
    /// The median.
    pub median: f64,
}

impl Errors {
    /// Adds the errors at a state; `epsilon` is the number type's ε over 2⁻⁵².
    pub fn add(&mut self, reference: &Reference, found: &[Vec<f64>], epsilon: f64) {
        let (mut whole, mut entries, mut terms) = (0.0_f64, 0.0_f64, 0.0_f64);
        for (output, ((values, units), found)) in reference.values.iter().zip(&reference.units).zip(found).enumerate() {
            let unit = units.iter().fold(0.0_f64, |m, x| m.max(*x));
            let mut worst = 0.0_f64;
            let size = values.iter().fold(0.0_f64, |m, &x| m.max(f64::from(x).abs()));
            for ((&value, &own), &found) in values.iter().zip(units).zip(found) {
                let error = f64::from(Double::from_f64(found) - value).abs();
                let error = if error.is_nan() { f64::INFINITY } else { error };
                worst = worst.max(error);
                if f64::from(value).abs() > ZERO * size || own > NO_UNIT * unit {
                    entries = entries.max(over(error, own * epsilon));
                }
            }
            whole = whole.max(over(worst, unit * epsilon));
            if let Some(size) = &reference.terms {
                terms = terms.max(over(worst, size[output] * f64::EPSILON * epsilon));
            }
        }
        self.whole.push(whole as f32);
        self.entries.push(entries as f32);
        self.terms.extend(reference.terms.is_some().then_some(terms as f32));
    }

    /// Merges both.
    pub fn join(&mut self, other: Errors) {
        self.whole.extend(other.whole);
        self.entries.extend(other.entries);
        self.terms.extend(other.terms);
    }

    /// Errors of whole outputs.
    pub fn whole(&self) -> Summary {
        Summary::of(&self.whole)
    }

    /// Errors of whole outputs, in ε times the largest term of the formula.
    pub fn terms(&self) -> Option<Summary> {
        (!self.terms.is_empty()).then(|| Summary::of(&self.terms))
    }

    /// Errors entry by entry.
    pub fn entries(&self) -> Summary {
        Summary::of(&self.entries)
    }
}

fn over(error: f64, unit: f64) -> f64 {
    if error == 0.0 { 0.0 } else { error / unit }
}

impl Summary {
    fn of(errors: &[f32]) -> Self {
        let mut sorted = errors.to_vec();
        sorted.sort_unstable_by(f32::total_cmp);
        let at = |share: f64| {
            let place = (share * sorted.len() as f64).ceil() as usize;
            sorted.get(place.clamp(1, sorted.len().max(1)) - 1).map_or(0.0, |&x| f64::from(x))
        };
        Summary { max: at(1.0), most: at(0.999), median: at(0.5) }
    }

    /// The worse of each.
    pub fn worse(self, other: Self) -> Self {
        Summary { max: self.max.max(other.max), most: self.most.max(other.most), median: self.median.max(other.median) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_told_in_units() {
        let number = |x: f64| Double::from_f64(x);
        let reference = Reference {
            values: vec![vec![number(1.0), number(0.0)]],
            units: vec![vec![f64::EPSILON, 0.0]],
            terms: None,
        };
        let mut errors = Errors::default();
        errors.add(&reference, &[vec![1.0, 0.0]], 1.0);
        errors.add(&reference, &[vec![1.0 + 4.0 * f64::EPSILON, 0.0]], 1.0);
        errors.add(&reference, &[vec![1.0 + 4.0 * f64::EPSILON, 0.0]], 2.0);
        let Summary { max, median, .. } = errors.whole();
        assert_eq!((max, median), (4.0, 2.0));
        errors.add(&reference, &[vec![f64::NAN, 0.0]], 1.0);
        assert!(errors.whole().max.is_infinite());
        let mut small = Errors::default();
        small.add(&reference, &[vec![1.0, 1e-20]], 1.0); // an entry that is 0
        assert!(small.whole().max < 1e-4 && small.entries().max == 0.0);
    }
}
