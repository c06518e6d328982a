//! The fuzz targets on the corpus of `fuzz/corpus`, each file once; and, ignored, on damaged files of it for
//! `MOZZI_FUZZ_SECONDS` each (5 if not set), from the seed `MOZZI_FUZZ_SEED`. `cargo xtask test` runs both. cargo-fuzz
//! is guided by coverage.
mod targets;

use std::path::Path;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// No file may take longer; one takes milliseconds, on a busy machine seconds.
const LONGEST: Duration = Duration::from_secs(30);

/// Targets share the name of a temporary file.
static ALONE: Mutex<()> = Mutex::new(());

/// A run of the target within the time limit.
fn bounded(target: fn(&[u8]), bytes: &[u8]) {
    let begin = Instant::now();
    target(bytes);
    assert!(begin.elapsed() < LONGEST, "{:?}", begin.elapsed());
}

fn corpus(name: &str) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/corpus").join(name);
    let mut paths: Vec<_> = folder.read_dir().expect("a corpus").map(|entry| entry.expect("a file").path()).collect();
    paths.sort();
    assert!(!paths.is_empty(), "no files in {}", folder.display());
    paths.iter().map(|path| std::fs::read(path).expect("a file")).collect()
}

fn replay(name: &str, target: fn(&[u8])) {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    for (k, bytes) in corpus(name).iter().enumerate() {
        println!("{name}, file {k} by name"); // the last one is the one that fails
        bounded(target, bytes);
    }
}

/// splitmix64 (Steele, Lea, Flood 2014).
struct Random(u64);

impl Random {
    fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let x = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((x ^ (x >> 31)) % bound.max(1) as u64) as usize
    }
}

/// One change: of a bit, a byte or a length; or a piece is removed, repeated, or taken from another file.
fn mutate(bytes: &mut Vec<u8>, other: &[u8], random: &mut Random) {
    let at = random.below(bytes.len() + 1);
    let end = (at + 1 + random.below(12)).min(bytes.len());
    match random.below(7) {
        0 if at < bytes.len() => bytes[at] ^= 1 << random.below(8),
        1 if at < bytes.len() => bytes[at] = b"\0\x01\x7f\x80\xff \n,.-e09\"'{}[]:"[random.below(20)],
        2 => drop(bytes.drain(at..end)),
        3 => bytes.truncate(at),
        4 => {
            let piece = bytes[at..end].to_vec();
            drop(bytes.splice(at..at, piece));
        }
        5 => {
            let length = [0, -1, 1 << 20, i64::from(i32::MAX), 1 << 58, i64::MIN][random.below(6)].to_le_bytes();
            let end = (at + 8).min(bytes.len());
            bytes[at..end].copy_from_slice(&length[..end - at]);
        }
        _ => {
            let from = random.below(other.len());
            let piece = other[from..(from + 1 + random.below(40)).min(other.len())].to_vec();
            drop(bytes.splice(at..end, piece));
        }
    }
}

/// The target on damaged files until the time is up; a failing file is kept.
fn damaged(name: &str, target: fn(&[u8])) {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let setting = |name: &str, default| std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(default);
    let end = Instant::now() + Duration::from_secs(setting("MOZZI_FUZZ_SECONDS", 5));
    let (mut random, corpus) = (Random(setting("MOZZI_FUZZ_SEED", 1)), corpus(name));
    let mut count = 0;
    while Instant::now() < end {
        let mut bytes = corpus[random.below(corpus.len())].clone();
        for _ in 0..=random.below(5) {
            mutate(&mut bytes, &corpus[random.below(corpus.len())], &mut random);
        }
        if let Err(panic) = std::panic::catch_unwind(|| bounded(target, &bytes)) {
            let kept = std::env::temp_dir().join(format!("mozzi-fuzz-{name}-failing"));
            std::fs::write(&kept, &bytes).expect("a temporary file");
            println!("failed on {}", kept.display());
            std::panic::resume_unwind(panic);
        }
        count += 1;
    }
    println!("{name}: {count} damaged files");
}

macro_rules! fuzz {
    ($($name:ident)*) => {
        mod replayed { $(
            #[test]
            fn $name() {
                super::replay(stringify!($name), super::targets::$name);
            }
        )* }
        mod damaged_files { $(
            #[test]
            #[ignore = "takes its time; cargo xtask test runs it"]
            fn $name() {
                super::damaged(stringify!($name), super::targets::$name);
            }
        )* }
    };
}

fuzz!(json csv log bag npy npz arrow request);
