//! Damaged, hostile and endless tables: a result or one sentence, with bounded memory.
#![cfg(target_os = "linux")]

use crate::common;

use arrow_array::{ArrayRef, Float64Array, RecordBatch};
use arrow_ipc::CompressionType;
use arrow_ipc::writer::{FileWriter, IpcWriteOptions};
use common::{folder, text};
use std::fs::File;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Output};
use std::sync::Arc;

/// Mutants of each file.
const MUTANTS: u64 = 120;
/// Address space that the program may take, kB.
const MEMORY: u64 = 3_000_000;

/// Runs the program with little memory: a huge allocation ends it by a signal.
fn bounded(arguments: &[&str]) -> Output {
    let script = format!("ulimit -v {MEMORY}; exec \"$0\" \"$@\"");
    let mut command = Command::new("sh");
    command.args(["-c", &script, env!("CARGO_BIN_EXE_mozzi")]).args(arguments);
    command.output().expect("the program runs")
}

/// Checks that the program refuses, and returns its message.
fn refused(arguments: &[&str]) -> String {
    let output = bounded(arguments);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{arguments:?}: {said}");
    assert!(!said.contains("panicked") && said.len() < 2000, "{arguments:?}: {said}");
    said
}

const DYNAMICS: [&str; 4] = ["compute", "two_link_planar", "inverse-dynamics", "--in"];

fn read(file: &Path) -> Vec<&str> {
    [&DYNAMICS[..], &[file.to_str().expect("text")]].concat()
}

/// Pseudo-random numbers (Steele, Lea, Flood 2014).
struct Random(u64);

impl Random {
    fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let x = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((x ^ (x >> 31)) % bound.max(1) as u64) as usize
    }
}

/// Bytes flipped, cut off, omitted, repeated, or turned into a wrong length.
fn mutant(bytes: &[u8], random: &mut Random) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for _ in 0..=random.below(3) {
        let at = random.below(bytes.len());
        match random.below(6) {
            0 => bytes[at] ^= 1 << random.below(8),
            1 => bytes[at] = [0, 1, 0x7f, 0x80, 0xff][random.below(5)],
            2 => bytes.truncate(at.max(1)),
            3 => drop(bytes.drain(at..(at + 1 + random.below(40)).min(bytes.len()))),
            4 => {
                let piece = bytes[at..(at + 64).min(bytes.len())].to_vec();
                bytes.splice(at..at, piece);
            }
            _ => {
                let length = [0, -1, 1 << 20, i64::from(i32::MAX), 1 << 58, i64::MIN][random.below(6)].to_le_bytes();
                let at = at / 4 * 4;
                let to = (at + 4 + 4 * random.below(2)).min(bytes.len());
                bytes[at..to].copy_from_slice(&length[..to - at]);
            }
        }
        if bytes.is_empty() {
            bytes.push(b'A');
        }
    }
    bytes
}

/// Columns of states, as `mozzi simulate` writes them, compressed by LZ4.
fn lz4(path: &Path, rows: usize) {
    let column = |k: usize| -> ArrayRef { Arc::new(Float64Array::from(vec![0.25 * k as f64; rows])) };
    let names = ["theta_1", "theta_2", "dtheta_1", "dtheta_2", "ddtheta_1", "ddtheta_2"];
    let batch = RecordBatch::try_from_iter(names.into_iter().enumerate().map(|(k, name)| (name, column(k))));
    let batch = batch.expect("columns");
    let options = IpcWriteOptions::default().try_with_compression(Some(CompressionType::LZ4_FRAME)).expect("built in");
    let file = File::create(path).expect("a file");
    let mut writer = FileWriter::try_new_with_options(file, &batch.schema(), options).expect("a writer");
    writer.write(&batch).and_then(|()| writer.finish()).expect("written");
}

fn npy(shape: &str, numbers: &[u8]) -> Vec<u8> {
    let header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}\n");
    [b"\x93NUMPY\x01\x00", &(header.len() as u16).to_le_bytes()[..], header.as_bytes(), numbers].concat()
}

fn npz(path: &Path, name: &str, content: &[u8]) {
    let mut archive = zip::ZipWriter::new(File::create(path).expect("a file"));
    archive.start_file(name, zip::write::SimpleFileOptions::default()).expect("an entry"); // compressed
    archive.write_all(content).expect("written");
    archive.finish().expect("an archive");
}

#[test]
fn mutants_of_every_format_are_read_or_refused() {
    let folder = folder("mutants");
    let mut files = Vec::new();
    let binary = ["npy", "npz", "arrow"].into_iter().chain(cfg!(feature = "parquet").then_some("parquet"));
    for format in ["csv"].into_iter().chain(binary) {
        let file = folder.join(format!("motion.{format}"));
        let name = file.to_str().expect("text");
        text(&["simulate", "two_link_planar", "--theta", "0.3,0.4", "--time", "0.1", "--step", "0.01", "--out", name]);
        files.push(file);
    }
    let compressed = [folder.join("lz4.feather"), folder.join("deflated.npz")];
    lz4(&compressed[0], 50);
    npz(&compressed[1], "theta.npy", &npy("(10, 2)", &[0; 160]));
    files.extend(compressed);
    let mut random = Random(1);
    let (mut answered, mut all) = (0, 0);
    for file in &files {
        let output = bounded(&read(file));
        let is_of_positions = file.ends_with("deflated.npz");
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success() || is_of_positions, "{}: {said}", file.display());
        let whole = std::fs::read(file).expect("written");
        for _ in 0..MUTANTS {
            let path = folder.join(format!("mutant-{}", file.file_name().expect("a name").to_string_lossy()));
            let bytes = mutant(&whole, &mut random);
            std::fs::write(&path, &bytes).expect("a file");
            let output = bounded(&read(&path));
            let said = String::from_utf8_lossy(&output.stderr);
            let is_sound = matches!(output.status.code(), Some(0 | 1)) && !said.contains("panicked");
            if !is_sound {
                std::fs::write(folder.join("culprit"), &bytes).expect("kept");
            }
            assert!(is_sound, "{}, kept as `culprit`: {:?}: {said}", path.display(), output.status);
            assert!(said.contains(if output.status.success() { "states in" } else { "error: " }), "{said}");
            answered += usize::from(output.status.success());
            all += 1;
        }
    }
    // most are refused; some mutants are valid, such as a number with another digit
    assert!(answered > 0 && 2 * answered < all, "{answered} of {all} were answered");
}

#[test]
fn what_unpacks_to_too_much_is_refused_before_it_does() {
    let folder = folder("bombs");
    let path = folder.join("bomb.npz");
    npz(&path, "theta.npy", &npy("(500000000, 2)", &[0; 1 << 20]));
    assert!(refused(&read(&path)).contains("bomb.npz cannot be read: it unpacks to more than 1024 MiB"));
    npz(&path, "theta.npy", &npy("(4, 2)", &[0; 1 << 20]));
    assert!(refused(&read(&path)).contains("more bytes of numbers, expected those of shape (4, 2)"));
    npz(&path, "other.npy", &vec![0; 1 << 20]);
    assert!(refused(&read(&path)).contains("does not begin with"));
    let path = folder.join("bomb.feather");
    lz4(&path, 1000);
    let mut bytes = std::fs::read(&path).expect("written");
    let length = 8000_i64.to_le_bytes();
    let at = bytes.windows(8).position(|found| found == length).expect("the length of a buffer");
    bytes[at..at + 8].copy_from_slice(&290_000_000_000_000_000_i64.to_le_bytes());
    std::fs::write(&path, &bytes).expect("a file");
    assert!(refused(&read(&path)).contains("bomb.feather cannot be read: it unpacks to more than 1024 MiB"));
}

#[test]
fn devices_without_end_end() {
    let folder = folder("endless");
    for name in ["z.csv", "z.npy", "z.npz", "z.arrow", "z.feather"] {
        let path = folder.join(name);
        std::os::unix::fs::symlink("/dev/zero", &path).expect("a link");
        assert!(refused(&read(&path)).contains(name));
    }
    assert!(refused(&["plot", "energy", "ur5", "/dev/zero", "--out", "no.svg"]).contains("line 1 holds a zero byte"));
    assert!(refused(&["info", "/dev/zero"]).contains("/dev/zero"));
    let controller = ["simulate", "ur5", "--controller", "/dev/zero"];
    assert!(refused(&controller).contains("/dev/zero: cannot be read: it has more than"));
    // an endless row, and endless rows
    let script = "yes 1,2,3,4 | tr -d '\\n' | \"$0\" compute two_link_planar inverse-dynamics --in -";
    let output = Command::new("sh").args(["-c", script, env!("CARGO_BIN_EXE_mozzi")]).output().expect("it runs");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() == Some(1) && said.contains("line 1 is longer than 64 MiB"), "{said}");
}

#[test]
fn motions_without_bound_are_refused_with_their_size() {
    let folder = folder("endless_motion");
    let out = folder.join("motion.csv");
    let out = out.to_str().expect("text");
    let simulate = ["simulate", "ur5", "--step", "1e-12", "--out", out];
    let said = refused(&simulate);
    for words in ["2e12 steps", "motion.csv", "expected at most 1e9 steps", "--allow-large"] {
        assert!(said.contains(words), "{words} in {said}");
    }
    assert!(!Path::new(out).exists());
    let start = ["simulate", "ur5", "--step", "1e-12", "--time", "0.5", "--dtheta", "1,0,0,0,0,0"];
    let short = bounded(&[&start[..], &["--until", "theta_1 > 1e-11", "--allow-large"]].concat());
    let said = String::from_utf8_lossy(&short.stderr);
    assert!(short.status.success() && said.contains("note: 5e11 steps"), "{said}");
    assert!(refused(&["simulate", "ur5", "--step", "1e-8", "--json"]).contains("of memory"));
    assert!(refused(&["trajectory", "ur5", "--to", "1,1,1,1,1,1", "--step", "1e-12"]).contains("rows"));
    assert!(refused(&["plot", "convergence", "ur5", "--step", "1e-12", "--out", "no.svg"]).contains("steps"));
}
