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
    /// About `about` round numbers in a range of places, two at least.
    pub fn new(scale: Scale, range: [f64; 2], about: usize) -> Self {
        let of = |about: usize| match scale {
            Scale::Linear => linear(range, about as f64),
            Scale::Logarithmic => decades(range, about as f64),
        };
        let found = (about.max(1)..about.max(1) + 12).map(of).find(|ticks| ticks.len() > 1);
        Ticks(found.unwrap_or_else(|| match scale {
            Scale::Linear => linear(range, 12.0),
            Scale::Logarithmic => within_a_decade(range),
        }))
    }
}

fn linear([low, high]: [f64; 2], about: f64) -> Vec<(f64, String)> {
    let step = round_step((high - low) / about);
    let first = (low / step).ceil() as i64;
    let decimals = (-step.log10()).ceil().max(0.0) as usize;
    let name = |x: f64| match (1e-4..1e5).contains(&step) {
        true => format!("{x:.decimals$}"),
        false if x == 0.0 => "0".to_string(),
        false => {
            // as many digits as tell neighbours apart
            let places = (x.abs() / step).log10().max(0.0) as usize + 1;
            let text = format!("{x:.places$e}");
            let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
            format!("{}e{exponent}", digits.trim_end_matches('0').trim_end_matches('.'))
        }
    };
    let name = |x: f64| name(x).replace('-', "−");
    (first..).map(|k| k as f64 * step).take_while(|x| *x <= high).map(|x| (x, name(x))).collect()
}

fn decades([low, high]: [f64; 2], about: f64) -> Vec<(f64, String)> {
    let step = ((high - low) / about).ceil().max(1.0);
    let first = (low / step).ceil() as i64;
    let ticks = (first..).map(|k| k as f64 * step).take_while(|x| *x <= high);
    ticks.map(|x| (x, format!("10{}", superscript(x as i64)))).collect()
}

/// 1, 2 … 9 times a power of ten.
fn within_a_decade([low, high]: [f64; 2]) -> Vec<(f64, String)> {
    let powers = low.floor() as i64..=high.floor() as i64;
    let all = powers.flat_map(|power| (1..10).map(move |k| (k, power)));
    let place = |(k, power): (i64, i64)| ((k as f64).log10() + power as f64, k, power);
    let named = |(x, k, power)| match k {
        1 => (x, format!("10{}", superscript(power))),
        _ => (x, format!("{k}·10{}", superscript(power))),
    };
    all.map(place).filter(|(x, ..)| (low..=high).contains(x)).map(named).collect()
}

/// The range to draw: if there are spikes, up to the range of 99 % of the numbers; then also the lowest and the highest
/// number beyond it.
pub(super) fn without_spikes(values: &[f64]) -> ([f64; 2], [Option<f64>; 2]) {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|x| x.is_finite()).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    let (Some(&lowest), Some(&highest)) = (sorted.first(), sorted.last()) else { return ([0.0, 0.0], [None; 2]) };
    let at = |part: f64| sorted[(part * (sorted.len() - 1) as f64).round() as usize];
    let (from, to) = (at(0.005), at(0.995));
    let usual = to - from;
    let below = Some(lowest).filter(|x| usual > 0.0 && *x < from - 2.0 * usual);
    let above = Some(highest).filter(|x| usual > 0.0 && *x > to + 2.0 * usual);
    let low = if below.is_some() { from - 0.25 * usual } else { lowest };
    let high = if above.is_some() { to + 0.25 * usual } else { highest };
    ([low, high], [below, above])
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
        assert_eq!(names(Scale::Linear, [0.0, 3e-7], 3), ["0", "1e−7", "2e−7", "3e−7"]);
        assert_eq!(names(Scale::Linear, [-6e-16, 6e-16], 3), ["−5e−16", "0", "5e−16"]);
        assert_eq!(names(Scale::Logarithmic, [-3.2, 0.1], 4), ["10⁻³", "10⁻²", "10⁻¹", "10⁰"]);
        assert_eq!(names(Scale::Linear, [0.499999, 0.50002], 4), ["5e−1", "5.0001e−1", "5.0002e−1"]);
        assert_eq!(names(Scale::Linear, [0.500001, 0.500012], 3), ["5.00005e−1", "5.0001e−1"]);
        assert_eq!(names(Scale::Linear, [1234567.0, 2234567.0], 2), ["1.5e6", "2e6"]);
        // two at least
        assert_eq!(names(Scale::Linear, [3.1, 4.9], 1), ["3.5", "4.0", "4.5"]);
        assert_eq!(names(Scale::Logarithmic, [-0.9, -0.2], 4), ["2·10⁻¹", "3·10⁻¹", "4·10⁻¹", "5·10⁻¹", "6·10⁻¹"]);
    }

    #[test]
    fn spikes_are_cut_and_steps_are_not() {
        let mut wave: Vec<f64> = (0..1000).map(|k| (0.01 * f64::from(k)).sin()).collect();
        assert_eq!(without_spikes(&wave).1, [None, None]);
        wave[500] = 2e4;
        let ([low, high], cut) = without_spikes(&wave);
        assert_eq!(cut, [None, Some(2e4)]);
        assert!(low < -0.99 && (1.0..2.0).contains(&high), "{low} {high}");
        let jump: Vec<f64> = (0..100).map(|k| if k < 60 { 0.0 } else { 5.0 }).collect();
        assert_eq!(without_spikes(&jump), ([0.0, 5.0], [None, None]));
    }

    #[test]
    fn ranges_leave_air() {
        let of = |values: &[f64]| Scale::Linear.range(values.iter().copied());
        assert_eq!(of(&[0.0, 10.0, f64::NAN]), [-0.5, 10.5]);
        assert_eq!((of(&[0.0, 0.0]), of(&[])), ([-1.0, 1.0], [0.0, 1.0]));
        assert_eq!(Scale::Logarithmic.range([0.0, -1.0, 10.0, 1000.0].into_iter()), [0.9, 3.1]);
    }
}
