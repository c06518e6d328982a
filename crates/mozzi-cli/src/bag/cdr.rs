//! Reads ROS 2's serialisation of a message: CDR of either byte order, each number at a multiple of its size.

pub struct Cdr<'b> {
    /// The bytes after the encoding, from which alignment counts.
    bytes: &'b [u8],
    at: usize,
    is_big_endian: bool,
}

impl<'b> Cdr<'b> {
    /// A whole message; None for another encoding.
    pub fn of(message: &'b [u8]) -> Option<Self> {
        let is_big_endian = match message.get(1)? {
            0 => true,
            1 => false,
            _ => return None,
        };
        Some(Cdr { bytes: message.get(4..)?, at: 0, is_big_endian })
    }

    fn take<const K: usize>(&mut self) -> Option<[u8; K]> {
        let mut found: [u8; K] = self.bytes.get(self.at..self.at.checked_add(K)?)?.try_into().ok()?;
        self.at += K;
        if self.is_big_endian {
            found.reverse();
        }
        Some(found)
    }

    fn align(&mut self, to: usize) {
        self.at = self.at.next_multiple_of(to);
    }

    pub fn uint32(&mut self) -> Option<u32> {
        self.align(4);
        self.take().map(u32::from_le_bytes)
    }

    pub fn string(&mut self) -> Option<String> {
        let length = self.uint32()? as usize;
        let text = self.bytes.get(self.at..self.at.checked_add(length)?)?;
        self.at += length;
        Some(String::from_utf8_lossy(text.strip_suffix(b"\0").unwrap_or(text)).into_owned())
    }

    /// A sequence with its length before it.
    pub fn float64s(&mut self) -> Option<Vec<f64>> {
        let count = self.uint32()? as usize;
        if count > 0 {
            self.align(8);
        }
        (0..count).map(|_| self.take().map(f64::from_le_bytes)).collect()
    }
}
