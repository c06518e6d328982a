//! The types of numbers in .npy files, by NumPy's names: `<f8`, `>i4`, `|u1`.

/// Largest magnitude up to which float64 holds every integer.
const EXACT: u64 = 1 << f64::MANTISSA_DIGITS;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kind {
    letter: char,
    pub size: usize,
    is_big: bool,
}

impl Kind {
    /// Floats of 4 and 8 bytes, integers of 1 to 8.
    pub fn of(name: &str) -> Option<Self> {
        let (order, letter_and_size) = name.split_at_checked(1)?;
        let (letter, size) = letter_and_size.split_at_checked(1)?;
        let sizes: &[usize] = if letter == "f" { &[4, 8] } else { &[1, 2, 4, 8] };
        let size = sizes.iter().copied().find(|known| *size == known.to_string())?;
        let is_big = match order {
            "<" => false,
            ">" => true,
            "=" | "|" => cfg!(target_endian = "big"),
            _ => return None,
        };
        ["f", "i", "u"].contains(&letter).then(|| Kind { letter: letter.chars().next().unwrap_or('f'), size, is_big })
    }

    /// The number of these bytes; an integer that float64 does not hold exactly is an error.
    pub fn number(self, bytes: &[u8]) -> Result<f64, String> {
        let mut all = [0; 8];
        for (to, &from) in all.iter_mut().zip(bytes.iter().take(self.size)) {
            *to = from;
        }
        if self.is_big {
            all[..self.size].reverse();
        }
        let bits = u64::from_le_bytes(all);
        let unused = 64 - 8 * self.size as u32;
        match (self.letter, self.size) {
            ('f', 4) => Ok(f32::from_bits(bits as u32).into()),
            ('f', _) => Ok(f64::from_bits(bits)),
            ('i', _) => {
                let x = ((bits << unused) as i64) >> unused;
                exact(x, x.unsigned_abs(), x as f64)
            }
            _ => exact(bits, bits, bits as f64),
        }
    }
}

fn exact(shown: impl std::fmt::Display, magnitude: u64, x: f64) -> Result<f64, String> {
    match magnitude <= EXACT {
        true => Ok(x),
        false => Err(format!("{shown} is an integer that float64 does not hold, expected one up to 2^53")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_those_of_their_bytes() {
        let of = |name: &str, bytes: &[u8]| Kind::of(name).expect("known").number(bytes);
        assert_eq!(of("<i8", &(-7_i64).to_le_bytes()), Ok(-7.0));
        assert_eq!(of(">i4", &(-7_i32).to_be_bytes()), Ok(-7.0));
        assert_eq!(of(">u2", &40_000_u16.to_be_bytes()), Ok(40_000.0));
        assert_eq!((of("|i1", &[0xff]), of("|u1", &[0xff])), (Ok(-1.0), Ok(255.0)));
        assert_eq!((of("<f4", &0.5_f32.to_le_bytes()), of(">f8", &0.1_f64.to_be_bytes())), (Ok(0.5), Ok(0.1)));
        assert!(of("<u8", &u64::MAX.to_le_bytes()).expect_err("too large").starts_with("18446744073709551615 is"));
        assert_eq!(of("<i8", &i64::MIN.to_le_bytes()).map_err(|_| ()), Err(()));
        for unknown in ["<f2", "<c16", "|O", "<U4", "|b1", "", "é8", "<m8[ns]"] {
            assert_eq!(Kind::of(unknown), None, "{unknown}");
        }
    }
}
