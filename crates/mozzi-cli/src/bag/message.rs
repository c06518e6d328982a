//! A message `sensor_msgs/msg/JointState`.

use super::cdr::Cdr;

/// Names of the lists.
const LISTS: [&str; 3] = ["positions", "velocities", "efforts"];

/// One message.
pub struct State {
    /// The header's time, ns.
    pub stamp: i64,
    /// The time at which it was recorded, ns.
    pub received: i64,
    pub names: Vec<String>,
    /// Positions, velocities, efforts.
    pub values: [Vec<f64>; 3],
}

impl State {
    /// A message in CDR: header, names, positions, velocities, efforts.
    pub fn read(bytes: &[u8], received: i64) -> Option<Self> {
        let mut from = Cdr::of(bytes)?;
        let (seconds, nanoseconds) = (from.uint32()? as i32, from.uint32()?);
        from.string()?;
        let count = from.uint32()?;
        let names = (0..count).map(|_| from.string()).collect::<Option<Vec<_>>>()?;
        let values = [from.float64s()?, from.float64s()?, from.float64s()?];
        let stamp = i64::from(seconds) * 1_000_000_000 + i64::from(nanoseconds);
        Some(State { stamp, received, names, values })
    }

    /// The lengths, if a list has another one than the names.
    pub fn uneven(&self) -> Option<String> {
        let count = self.names.len();
        let mut lists = LISTS.iter().zip(&self.values);
        let (list, values) = lists.find(|(_, values)| !values.is_empty() && values.len() != count)?;
        Some(format!("{count} names, {} {list}", values.len()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A message with two names; `number` writes 4 or 8 bytes of one byte order.
    fn message(encoding: u8, efforts: usize, number: impl Fn(u64, usize) -> Vec<u8>) -> Vec<u8> {
        let mut body: Vec<u8> = Vec::new();
        let mut put = |bytes: &[u8]| {
            body.resize(body.len().next_multiple_of(bytes.len().min(8)), 0);
            body.extend(bytes);
        };
        // the stamp, and an empty text of one byte
        [3, 500, 1].into_iter().for_each(|x| put(&number(x, 4)));
        put(&[0]);
        put(&number(2, 4));
        for name in [b"ab\0", b"cd\0"] {
            put(&number(3, 4));
            name.iter().for_each(|byte| put(&[*byte]));
        }
        for count in [2, 0, efforts] {
            put(&number(count as u64, 4));
            (0..count).for_each(|k| put(&number((0.5 + k as f64).to_bits(), 8)));
        }
        [vec![0, encoding, 0, 0], body].concat()
    }

    #[test]
    fn both_byte_orders_are_read_and_uneven_lists_are_named() {
        let big = |x: u64, size: usize| x.to_be_bytes()[8 - size..].to_vec();
        let little = |x: u64, size: usize| x.to_le_bytes()[..size].to_vec();
        for bytes in [message(0, 2, big), message(1, 2, little)] {
            let state = State::read(&bytes, 9).expect("a message");
            assert_eq!(
                (state.stamp, state.names.as_slice()),
                (3_000_000_500, &["ab".to_string(), "cd".to_string()][..])
            );
            assert_eq!(state.values, [vec![0.5, 1.5], vec![], vec![0.5, 1.5]]);
            assert_eq!(state.uneven(), None);
            assert!(State::read(&bytes[..bytes.len() - 1], 9).is_none(), "cut off");
        }
        let state = State::read(&message(1, 1, little), 9).expect("a message");
        assert_eq!(state.uneven().as_deref(), Some("2 names, 1 efforts"));
        assert!(State::read(&message(7, 2, little), 9).is_none(), "another encoding");
    }
}
