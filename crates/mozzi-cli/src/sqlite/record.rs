//! A row's record: the kinds of its values, and their places.

use super::Value;
use super::varint::varint;
use std::ops::Range;

/// The kinds of a record's values, with their places in the payload.
pub struct Record(Vec<(i64, Range<usize>)>);

impl Record {
    /// From the beginning of a payload with this length, which contains the header; None if it is damaged.
    pub fn new(payload: &[u8], length: usize) -> Option<Self> {
        let (size, mut at) = varint(payload)?;
        let size = usize::try_from(size).ok().filter(|&size| size <= payload.len())?;
        let (mut start, mut values) = (size, Vec::new());
        while at < size {
            let (kind, more) = varint(&payload[at..size])?;
            at += more;
            let end = start.checked_add(width(kind)?).filter(|&end| end <= length)?;
            values.push((kind, start..end));
            start = end;
        }
        Some(Record(values))
    }

    /// The kind and the place of a value.
    pub fn column(&self, column: usize) -> Option<(i64, Range<usize>)> {
        self.0.get(column).cloned()
    }
}

/// The bytes of a value.
fn width(kind: i64) -> Option<usize> {
    Some(match kind {
        0 | 8 | 9 => 0,
        1..=4 => kind as usize,
        5 => 6,
        6 | 7 => 8,
        12.. => usize::try_from((kind - 12) / 2).ok()?,
        _ => return None,
    })
}

/// The value of these bytes; None if a text is not UTF-8.
pub fn value(kind: i64, bytes: &[u8]) -> Option<Value> {
    Some(match kind {
        0 => Value::Null,
        8 | 9 => Value::Integer(kind - 8),
        7 => Value::Real(f64::from_be_bytes(bytes.try_into().ok()?)),
        1..=6 => {
            let sign = if bytes.first().is_some_and(|&byte| byte >= 0x80) { -1 } else { 0 };
            Value::Integer(bytes.iter().fold(sign, |value, &byte| value << 8 | i64::from(byte)))
        }
        _ if kind % 2 == 0 => Value::Blob(bytes.to_vec()),
        _ => Value::Text(String::from_utf8(bytes.to_vec()).ok()?),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_big_endian() {
        assert_eq!(value(1, &[0xfe]), Some(Value::Integer(-2)));
        assert_eq!(value(2, &[1, 0]), Some(Value::Integer(256)));
        assert_eq!(value(9, &[]), Some(Value::Integer(1)));
        assert_eq!(value(7, &1.5_f64.to_be_bytes()), Some(Value::Real(1.5)));
        assert_eq!(value(17, b"ab"), Some(Value::Text("ab".into())));
        let record = Record::new(&[4, 1, 2, 16], 9).expect("a record");
        assert_eq!(record.column(2), Some((16, 7..9)));
        assert_eq!(record.column(3), None);
        assert!(Record::new(&[3, 6, 6], 4).is_none());
    }
}
