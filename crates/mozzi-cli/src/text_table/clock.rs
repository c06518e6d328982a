//! Dates and times as people and programs write them.

/// Seconds since 1970 of `2024-05-01T12:00:00.123Z` (also with a space, `/`, `_` or an offset, `20240501T120000.123`,
/// German `01.05.2024`, MATLAB's `01-May-2024`); seconds of the day of `12:00:00.123` or `12:59:50 PM`. Without an
/// offset, UTC.
pub fn seconds(text: &str) -> Option<f64> {
    let text = text.trim().trim_matches('"');
    let (date, time) = match text.split_once(['T', ' ', '_']) {
        Some((date, time)) if date.contains(':') => (None, format!("{date} {time}")), // 12:59:50 PM
        Some((date, time)) => (Some(date), time.trim().to_string()),
        None => (None, text.to_string()),
    };
    let days = date.map_or(Some(0), days)?;
    let (time, offset) = match time.strip_suffix(['Z', 'z']).or_else(|| time.strip_suffix(" UTC")) {
        Some(time) => (time, 0.0),
        None => match time.rfind(['+', '-']) {
            Some(k) => (&time[..k], offset(&time[k..])?),
            None => (time.as_str(), 0.0),
        },
    };
    Some(days as f64 * 86400.0 + of_day(time, date.is_some())? - offset)
}

/// Seconds of the day; after a date also without colons.
fn of_day(time: &str, has_date: bool) -> Option<f64> {
    let upper = time.trim().to_uppercase();
    let (time, half) = match (upper.strip_suffix("AM"), upper.strip_suffix("PM")) {
        (Some(time), _) => (time.trim_end(), Some(0)),
        (_, Some(time)) => (time.trim_end(), Some(12)),
        _ => (upper.as_str(), None),
    };
    let spaced;
    let digits = time.bytes().take_while(u8::is_ascii_digit).count();
    let time = match has_date && digits == 6 {
        true => {
            spaced = format!("{}:{}:{}", &time[..2], &time[2..4], &time[4..]);
            &spaced
        }
        false => time,
    };
    let mut parts = time.split(':');
    let (hours, minutes, rest) = (parts.next()?, parts.next()?, parts.next()?);
    // LabVIEW's 10:22:33:000
    let rest = parts.next().map_or(rest.to_string(), |fraction| format!("{rest}.{fraction}"));
    let (hours, minutes): (u32, u32) = (hours.parse().ok()?, minutes.parse().ok()?);
    let hours = half.map_or(hours, |half| hours % 12 + half);
    let rest: f64 = rest.trim().replace(',', ".").parse().ok()?;
    let is_clock = hours < 24 && minutes < 60 && (0.0..61.0).contains(&rest) && parts.next().is_none();
    is_clock.then(|| f64::from(hours * 3600 + minutes * 60) + rest)
}

/// Whether a text begins with a date such as 03/01/2024, in which the month or the day may come first.
pub fn is_ambiguous(text: &str) -> bool {
    let date = text.trim().trim_matches('"').split(['T', ' ']).next().unwrap_or_default();
    let parts: Vec<&str> = date.split(['/', '-']).collect();
    let is_number = |part: &&str| part.bytes().all(|byte| byte.is_ascii_digit());
    let may_be_month = |part: &str| part.parse().is_ok_and(|k: u32| k <= 12);
    let is_date = parts.len() == 3 && parts.iter().all(is_number) && parts.iter().map(|part| part.len()).eq([2, 2, 4]);
    is_date && may_be_month(parts[0]) && may_be_month(parts[1])
}

const MONTHS: [&str; 12] = ["jan", "feb", "mar", "apr", "may", "jun", "jul", "aug", "sep", "oct", "nov", "dec"];

/// Days since 1970 of the Gregorian calendar (Hinnant, days_from_civil).
fn days(date: &str) -> Option<i64> {
    let date = match date.len() == 8 && date.bytes().all(|byte| byte.is_ascii_digit()) {
        true => format!("{}-{}-{}", &date[..4], &date[4..6], &date[6..]),
        false => date.to_lowercase(),
    };
    let separator = ['-', '/', '.'].into_iter().find(|&c| date.contains(c))?;
    let month = |part: &str| MONTHS.iter().position(|month| *month == part).map(|k| k as i64 + 1);
    let is_named = date.split(separator).nth(1).is_some_and(|part| month(part).is_some());
    let mut parts = date.split(separator).map(|part| month(part.trim()).or_else(|| part.trim().parse::<i64>().ok()));
    let (a, b, c) = (parts.next()??, parts.next()??, parts.next()??);
    let (year, month, day) = match () {
        () if a > 31 => (a, b, c),
        () if separator == '.' || is_named || a > 12 => (c, b, a),
        () => (c, a, b), // the month first, as the day is no month
    };
    let is_leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    let last = match month {
        2 => 28 + i64::from(is_leap),
        4 | 6 | 9 | 11 => 30,
        _ => 31,
    };
    let is_certain = a > 31 || separator == '.' || is_named || a > 12 || b > 12;
    if !is_certain
        || parts.next().is_some()
        || !(1900..3000).contains(&year)
        || !(1..=12).contains(&month)
        || !(1..=last).contains(&day)
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
        assert_eq!([seconds("12:00:01 AM"), seconds("12:00:01 PM")], [Some(1.0), Some(43201.0)]);
        assert_eq!(seconds("10:22:33:250"), Some(37353.25));
        for text in [
            "01-May-2024 00:00:00.25",
            "20240501T000000.25",
            "20240501_000000.25",
            "2024/05/01 12:00:00.25 AM",
            "2024-05-01_00:00:00.25",
        ] {
            assert_eq!(seconds(text), Some(1_714_521_600.25), "{text}");
        }
        for text in ["15/05/2024 00:00:00", "05/15/2024 00:00:00"] {
            assert_eq!((seconds(text), is_ambiguous(text)), (Some(1_715_731_200.0), false), "{text}");
        }
        for text in ["0.5", "120000.5", "1700000000000000000", "2024-05-01", "elbow", "24:00:00", "2024-13-01T00:00:00"]
        {
            assert_eq!(seconds(text), None, "{text}");
        }
        for date in ["2023-02-29", "1900-02-29", "2024-04-31"] {
            assert_eq!(seconds(&format!("{date}T00:00:00")), None, "{date}");
        }
        assert!(is_ambiguous("03/01/2024 12:59:50.0 PM") && !is_ambiguous("2024-03-01") && !is_ambiguous("0.5"));
    }
}
