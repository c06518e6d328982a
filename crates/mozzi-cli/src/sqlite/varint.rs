//! SQLite's integers of one to nine bytes.

/// The integer at the beginning, and its length; None if the bytes end.
pub fn varint(bytes: &[u8]) -> Option<(i64, usize)> {
    let mut value = 0_u64;
    for (k, &byte) in bytes.iter().take(8).enumerate() {
        value = value << 7 | u64::from(byte & 0x7f);
        if byte < 0x80 {
            return Some((value as i64, k + 1));
        }
    }
    let last = bytes.get(8)?;
    Some(((value << 8 | u64::from(*last)) as i64, 9))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integers_have_one_to_nine_bytes() {
        assert_eq!(varint(&[0x7f, 1]), Some((127, 1)));
        assert_eq!(varint(&[0x81, 0x00]), Some((128, 2)));
        assert_eq!(varint(&[0xff; 9]), Some((-1, 9)));
        assert_eq!(varint(&[0x80]), None);
        assert_eq!(varint(&[0xff; 8]), None);
    }
}
