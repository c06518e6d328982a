//! Ranges and round numbers along an axis.

/// The scale of an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scale {
    /// Evenly.
    #[default]
    Linear,
    /// Logarithmic; values that are not positive are not drawn.
    Logarithmic,
}

impl Scale {
    /// The place of a number on the axis, in the units of [`range`](Self::range).
    pub(super) fn place(self, x: f64) -> f64 {
        match self {
            Scale::Linear => x,
            Scale::Logarithmic if x > 0.0 => x.log10(),
            Scale::Logarithmic => f64::NAN,
        }
    }

    /// The places of the lowest and the highest value, with a margin.
    pub(super) fn range(self, values: impl Iterator<Item = f64>) -> [f64; 2] {
        let places = values.map(|x| self.place(x)).filter(|x| x.is_finite());
        let [low, high] = places.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)]);
        if low > high {
            return [0.0, 1.0];
        }
        let air = match high - low {
            0.0 if low == 0.0 => 1.0,
            0.0 => 0.1 * low.abs(),
            size => 0.05 * size,
        };
        [low - air, high + air]
    }
}

/// Places and their labels.
pub(super) struct Ticks(pub Vec<(f64, String)>);

impl Ticks {
    /// About `about` round numbers in a range of places.
    pub fn new(scale: Scale, [low, high]: [f64; 2], about: usize) -> Self {
        let about = about.max(1) as f64;
        let logarithmic = scale == Scale::Logarithmic;
        let step = if logarithmic { ((high - low) / about).ceil().max(1.0) } else { round_step((high - low) / about) };
        let first = (low / step).ceil() as i64;
        let decimals = (-step.log10()).ceil().max(0.0) as usize;
        let name = |k: i64| {
            let x = k as f64 * step;
            match (logarithmic, step) {
                (true, _) => format!("10{}", superscript(x as i64)),
                (_, step) if !(1e-4..1e5).contains(&step) => format!("{x:.1e}"),
                _ => format!("{x:.decimals$}").replace('-', "−"),
            }
        };
        let ticks = (first..).map(|k| (k as f64 * step, name(k))).take_while(|(x, _)| *x <= high);
        Ticks(ticks.collect())
    }
}

/// 1, 2 or 5 times a power of ten, not below this.
fn round_step(raw: f64) -> f64 {
    let power = 10.0_f64.powf(raw.log10().floor());
    [1.0, 2.0, 5.0].map(|k| k * power).into_iter().find(|step| *step >= raw * (1.0 - 1e-9)).unwrap_or(10.0 * power)
}

fn superscript(exponent: i64) -> String {
    let digit =
        |c: char| c.to_digit(10).map_or('⁻', |d| ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][d as usize]);
    exponent.to_string().chars().map(digit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_numbers() {
        let names =
            |scale, range, about| Ticks::new(scale, range, about).0.into_iter().map(|(_, n)| n).collect::<Vec<_>>();
        assert_eq!(names(Scale::Linear, [-0.1, 1.1], 5), ["0.0", "0.5", "1.0"]);
        assert_eq!(names(Scale::Linear, [-3.0, 7.0], 5), ["−2", "0", "2", "4", "6"]);
        assert_eq!(names(Scale::Linear, [0.0, 3e-7], 3), ["0.0e0", "1.0e-7", "2.0e-7", "3.0e-7"]);
        assert_eq!(names(Scale::Logarithmic, [-3.2, 0.1], 4), ["10⁻³", "10⁻²", "10⁻¹", "10⁰"]);
    }

    #[test]
    fn ranges_leave_air() {
        let of = |values: &[f64]| Scale::Linear.range(values.iter().copied());
        assert_eq!(of(&[0.0, 10.0, f64::NAN]), [-0.5, 10.5]);
        assert_eq!((of(&[0.0, 0.0]), of(&[])), ([-1.0, 1.0], [0.0, 1.0]));
        assert_eq!(Scale::Logarithmic.range([0.0, -1.0, 10.0, 1000.0].into_iter()), [0.9, 3.1]);
    }
}
