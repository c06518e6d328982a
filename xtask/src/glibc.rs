//! The version of glibc that a binary needs.

/// The largest minor version in the names GLIBC_2.N of a binary's symbols.
pub fn newest(binary: &[u8]) -> Option<u32> {
    const NAME: &[u8] = b"GLIBC_2.";
    let places = binary.windows(NAME.len()).enumerate().filter(|(_, name)| *name == NAME);
    let versions = places.filter_map(|(at, _)| {
        let digits = binary[at + NAME.len()..].iter().take_while(|byte| byte.is_ascii_digit());
        digits.map(|&byte| char::from(byte)).collect::<String>().parse().ok()
    });
    versions.max()
}

#[cfg(test)]
mod tests {
    use super::newest;

    #[test]
    fn versions_are_numbers() {
        assert_eq!(newest(b"\0GLIBC_2.2.5\0GLIBC_2.17\0GLIBC_2.9\0GLIBC_PRIVATE\0"), Some(17));
        assert_eq!(newest(b"GLIBC_2.x"), None);
    }
}
