//! Dates and times as people and programs write them.

/// Seconds since 1970 of `2024-05-01T12:00:00.123Z` (also with a space, `/`, an offset, or German `01.05.2024`);
/// seconds of the day of `12:00:00.123`. Without an offset, UTC.
pub fn seconds(text: &str) -> Option<f64> {
    let text = text.trim().trim_matches('"');
    let (date, time) = match text.split_once(['T', ' ']) {
        Some((date, time)) => (Some(date), time.trim()),
        None => (None, text),
    };
    let days = date.map_or(Some(0), days)?;
    let (time, offset) = match time.strip_suffix(['Z', 'z']).or_else(|| time.strip_suffix(" UTC")) {
        Some(time) => (time, 0.0),
        None => match time.rfind(['+', '-']) {
            Some(k) => (&time[..k], offset(&time[k..])?),
            None => (time, 0.0),
        },
    };
    let mut parts = time.split(':');
    let (hours, minutes, rest) = (parts.next()?, parts.next()?, parts.next()?);
    let is_end = parts.next().is_none();
    let (hours, minutes): (u32, u32) = (hours.parse().ok()?, minutes.parse().ok()?);
    let rest: f64 = rest.trim().replace(',', ".").parse().ok()?;
    let is_clock = hours < 24 && minutes < 60 && (0.0..61.0).contains(&rest) && is_end;
    is_clock.then(|| days as f64 * 86400.0 + f64::from(hours * 3600 + minutes * 60) + rest - offset)
}

/// Whether a text begins with a date such as 03/01/2024, in which the month or the day may come first.
pub fn is_ambiguous(text: &str) -> bool {
    let date = text.trim().trim_matches('"').split(['T', ' ']).next().unwrap_or_default();
    let parts: Vec<&str> = date.split(['/', '-']).collect();
    let is_number = |part: &&str| part.bytes().all(|byte| byte.is_ascii_digit());
    parts.len() == 3 && parts.iter().all(is_number) && parts.iter().map(|part| part.len()).eq([2, 2, 4])
}

/// Days since 1970 of the Gregorian calendar (Hinnant, days_from_civil).
fn days(date: &str) -> Option<i64> {
    let separator = ['-', '/', '.'].into_iter().find(|&c| date.contains(c))?;
    let mut parts = date.split(separator).map(|part| part.trim().parse::<i64>().ok());
    let (a, month, c) = (parts.next()??, parts.next()??, parts.next()??);
    let (year, day) = if separator == '.' { (c, a) } else { (a, c) };
    if parts.next().is_some() || !(1900..3000).contains(&year) || !(1..=12).contains(&month) || !(1..=31).contains(&day)
    {
        return None;
    }
    let y = year - i64::from(month <= 2);
    let (era, of_era) = (y.div_euclid(400), y.rem_euclid(400));
    let of_year = (153 * (month + if month > 2 { -3 } else { 9 }) + 2) / 5 + day - 1;
    Some(era * 146_097 + of_era * 365 + of_era / 4 - of_era / 100 + of_year - 719_468)
}

/// Seconds of `+02:00`, `+0200` or `-05`.
fn offset(text: &str) -> Option<f64> {
    let sign = if text.starts_with('-') { -1.0 } else { 1.0 };
    let digits: String = text[1..].chars().filter(|c| *c != ':').collect();
    let (hours, minutes) = match digits.len() {
        2 => (digits.as_str(), "0"),
        4 => digits.split_at(2),
        _ => return None,
    };
    Some(sign * (hours.parse::<f64>().ok()? * 3600.0 + minutes.parse::<f64>().ok()? * 60.0))
}

#[cfg(test)]
mod tests {
    use super::{is_ambiguous, seconds};

    #[test]
    fn dates_are_seconds_since_1970() {
        assert_eq!(seconds("1970-01-02T00:00:01.5Z"), Some(86401.5));
        assert_eq!(seconds("2024-02-29 12:00:00+02:00"), Some(1_709_200_800.0));
        assert_eq!(seconds("01.05.2024 00:00:00,25"), Some(1_714_521_600.25));
        assert_eq!(seconds("12:00:01"), Some(43201.0));
        for text in ["0.5", "2024-05-01", "elbow", "24:00:00", "2024-13-01T00:00:00"] {
            assert_eq!(seconds(text), None, "{text}");
        }
        assert!(is_ambiguous("03/01/2024 12:59:50.0 PM") && !is_ambiguous("2024-03-01") && !is_ambiguous("0.5"));
    }
}
