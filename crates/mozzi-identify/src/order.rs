//! Times that do not increase: the likely cause, and the remedy.

/// Seconds of a day.
const DAY: f64 = 86400.0;

/// Rows that are out of order lie within this many median steps.
const NEAR: f64 = 100.0;

/// Why the time of this row is not later than that of the row before, and what helps.
pub fn explain(t: &[f64], row: usize) -> String {
    let (before, now) = (t[..row].iter().rev().find(|t| t.is_finite()).copied().unwrap_or(f64::NAN), t[row]);
    let known: Vec<f64> = t.iter().copied().filter(|t| t.is_finite()).collect();
    let steps = || known.windows(2).map(|pair| pair[1] - pair[0]);
    if known.iter().all(|t| *t == known[0]) {
        // %g keeps six digits
        let digits = 10f64.powf(known[0].abs().max(1.0).log10().floor() - 5.0);
        return format!(
            "all rows have this time; six digits (%g) of it are steps of {digits} s; log more digits, such as %.9f, or \
             seconds since the start"
        );
    }
    if now == before {
        let count = steps().filter(|step| *step == 0.0).count();
        return format!(
            "{count} rows have the time of the row before, though their numbers differ; log more digits, such as %.9f, or \
             delete one of each two rows"
        );
    }
    let mut forward: Vec<f64> = steps().filter(|step| *step > 0.0).collect();
    forward.sort_unstable_by(f64::total_cmp);
    let usual = forward.get(forward.len() / 2).copied().unwrap_or(0.0);
    let (count, most) =
        steps().filter(|step| *step < 0.0).fold((0, 0.0_f64), |(k, most), step| (k + 1, most.max(-step)));
    let next = t[row + 1..].iter().find(|t| t.is_finite());
    if 2 * count > known.len() {
        return format!("times decrease in {count} of {} rows: the last row comes first; reverse them", known.len());
    }
    if count == 1 && before < DAY && most > 0.99 * DAY {
        return "the clock passes midnight; log the date as well, or add 86400 s to the rows from here on".into();
    }
    if count == 1 && next.is_some_and(|next| *next > before) {
        return "this row is out of order; delete it, or sort the rows by time".into();
    }
    if count == 1 && (now - known[0]).abs() <= 2.0 * usual {
        return "the clock starts again, as in a file of two logs; split it here into two files, and name both".into();
    }
    if count == 1 && most > NEAR * usual {
        return format!("the clock was set back by {most:.4} s; split the log here into two files, and name both");
    }
    let is_within_a_second = || known.windows(2).all(|pair| pair[1] >= pair[0] || pair[1].floor() == pair[0].floor());
    if count > 2 && most > 0.3 && is_within_a_second() {
        return format!(
            "the clock goes back in {count} places, by up to {most:.4} s, as where seconds and nanoseconds are joined \
             without the leading zeros of the latter; write nanoseconds with nine digits"
        );
    }
    if most <= NEAR * usual {
        return format!(
            "rows are out of order in {count} places, by up to {most:.3e} s; sort them by time, in pandas \
             df.sort_values(\"t\"), or log the time of measurement instead of that of reception"
        );
    }
    format!(
        "the clock goes back in {count} places, by up to {most:.4} s, as in a file of several logs; split it there, and \
         name each file"
    )
}

#[cfg(test)]
mod tests {
    use super::explain;

    #[test]
    fn causes_are_told_apart() {
        let clock = |k: usize| 0.01 * k as f64;
        // 12 s and 50,000,000 ns as 12.50000000
        let joined = |k: usize| format!("{}.{}", k / 100, 10_000_000 * (k % 100)).parse::<f64>().expect("a number");
        let even: Vec<f64> = (0..1000).map(clock).collect();
        let with = |change: &dyn Fn(&mut Vec<f64>)| {
            let mut t = even.clone();
            change(&mut t);
            let row = (1..t.len()).find(|&k| t[k] <= t[k - 1]).expect("a row");
            explain(&t, row)
        };
        type Change<'c> = &'c dyn Fn(&mut Vec<f64>);
        let cases: [(Change, &str); 10] = [
            (&|t| t[500] = t[499], "1 rows have the time of the row before"),
            (&|t| t[500] = 1.0, "this row is out of order"),
            (&|t| t[500..].iter_mut().for_each(|t| *t -= 5.0), "the clock starts again"),
            (&|t| t[500..].iter_mut().for_each(|t| *t -= 3.0), "the clock was set back by 2.9900 s"),
            (&|t| t.iter_mut().enumerate().for_each(|(k, t)| *t += if k < 500 { 86395.0 } else { -5.0 }), "midnight"),
            (&|t| (10..20).for_each(|k| t.swap(10 * k, 10 * k + 1)), "rows are out of order in 10 places"),
            (&|t| (300..1000).for_each(|k| t[k] = clock(k % 300)), "goes back in 3 places, by up to 2.9900 s"),
            (&|t| t.reverse(), "times decrease in 999 of 1000 rows"),
            (&|t| t.iter_mut().enumerate().for_each(|(k, t)| *t = joined(k)), "without the leading zeros"),
            (&|t| t.fill(1.7e9), "six digits (%g) of it are steps of 10000 s"),
        ];
        for (change, words) in cases {
            let why = with(change);
            assert!(why.contains(words), "{words}: {why}");
        }
    }
}
