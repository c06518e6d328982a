//! ROS 2's serialisation of a message: CDR, little-endian, each number at a multiple of its size.

pub struct Cdr(Vec<u8>);

/// The encoding, before the first number; alignment counts from its end.
const HEAD: [u8; 4] = [0, 1, 0, 0];

impl Cdr {
    pub fn new() -> Self {
        Cdr(HEAD.to_vec())
    }

    pub fn into_bytes(self) -> Vec<u8> {
        self.0
    }

    fn put<const N: usize>(&mut self, bytes: [u8; N]) {
        let at = (self.0.len() - HEAD.len()).next_multiple_of(N) + HEAD.len();
        self.0.resize(at, 0);
        self.0.extend(bytes);
    }

    pub fn int32(&mut self, x: i32) {
        self.put(x.to_le_bytes());
    }

    pub fn uint32(&mut self, x: u32) {
        self.put(x.to_le_bytes());
    }

    pub fn float64(&mut self, x: f64) {
        self.put(x.to_le_bytes());
    }

    /// The number of a sequence's entries, which follow.
    pub fn length(&mut self, entries: usize) {
        self.uint32(u32::try_from(entries).unwrap_or(u32::MAX));
    }

    pub fn string(&mut self, text: &str) {
        self.length(text.len() + 1);
        self.0.extend(text.as_bytes());
        self.0.push(0);
    }

    pub fn float64s(&mut self, values: &[f64]) {
        self.length(values.len());
        values.iter().for_each(|&x| self.float64(x));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_stand_at_multiples_of_their_size() {
        let mut cdr = Cdr::new();
        cdr.string("ab"); // 4 + 3 bytes
        cdr.float64(1.0); // from 8 on
        cdr.int32(-1);
        let expected = [&[0, 1, 0, 0, 3, 0, 0, 0, b'a', b'b', 0, 0][..], &1f64.to_le_bytes(), &[0xff; 4]].concat();
        assert_eq!(cdr.into_bytes(), expected);
    }
}
