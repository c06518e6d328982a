//! The fuzz targets under a plain driver: for `MOZZI_FUZZ_SECONDS` each (5 if not set), from the seed
//! `MOZZI_FUZZ_SEED`. Not in a plain `cargo test`; `cargo xtask test` runs it. A failing input is written to the folder
//! for temporary files, and its name is printed.
mod targets;

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::Path;
use std::time::{Duration, Instant};

/// No input may take longer; one of 64 KiB takes milliseconds.
const LONGEST: Duration = Duration::from_secs(5);

/// xorshift64*: the same numbers in every run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 16
    }

    fn below(&mut self, n: usize) -> usize {
        self.next() as usize % n.max(1)
    }
}

fn setting(name: &str, default: u64) -> u64 {
    std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(default)
}

/// Runs the target on inputs from `make` until the time is up.
fn run(name: &str, target: fn(&[u8]), mut make: impl FnMut(&mut Random) -> Vec<u8>) {
    let until = Instant::now() + Duration::from_secs(setting("MOZZI_FUZZ_SECONDS", 5));
    let (mut random, mut count) = (Random(setting("MOZZI_FUZZ_SEED", 1).max(1)), 0);
    while Instant::now() < until {
        let (input, start) = (make(&mut random), Instant::now());
        let result = catch_unwind(AssertUnwindSafe(|| {
            target(&input);
            assert!(start.elapsed() < LONGEST, "took {:?}", start.elapsed());
        }));
        if let Err(panic) = result {
            let file = std::env::temp_dir().join(format!("mozzi-fuzz-{name}-{count}"));
            std::fs::write(&file, &input).expect("a writable folder");
            eprintln!("input {count} of {name} is in {}", file.display());
            resume_unwind(panic);
        }
        count += 1;
    }
    println!("{name}: {count} inputs");
}

/// Valid and invalid robots with one file ending.
fn corpus(folders: &[&str], ending: &str) -> Vec<Vec<u8>> {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let files = folders.iter().flat_map(|folder| std::fs::read_dir(here.join(folder)).into_iter().flatten());
    let mut paths: Vec<_> = files.map(|entry| entry.expect("an entry").path()).collect();
    paths.retain(|path| path.extension().is_some_and(|found| found == ending));
    paths.sort();
    assert!(paths.len() > 50, "{paths:?}");
    paths.iter().map(|path| std::fs::read(path).expect("a readable file")).collect()
}

const WORDS: &[&str] = &[
    "<",
    ">",
    "/>",
    "'",
    "\"",
    "&",
    "&amp;",
    "&#48;",
    "]]>",
    "<!--",
    "-->",
    "<![CDATA[",
    "<?xml?>",
    "=",
    " ",
    "\n",
    "\0",
    "ä",
    "\u{feff}",
    "xmlns='x'",
    "xmlns:x='y'",
    "x:",
    "<link name='a'/>",
    "<origin xyz='0 0 1'/>",
    "<inertial>",
    "</inertial>",
    "<mass value='1'/>",
    "<inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/>",
    "<joint name='j' type='fixed'>",
    "</joint>",
    "<parent link='base'/>",
    "<child link='upper'/>",
    "<mimic joint='shoulder'/>",
    "<dynamics damping='1'/>",
    "revolute",
    "prismatic",
    "continuous",
    "fixed",
    "floating",
    "base",
    "upper",
    "shoulder",
    "lower",
    "name",
    "xyz",
    "rpy",
];
const NUMBERS: &[&str] = &[
    "0",
    "-0",
    "1",
    "-1",
    "0.1",
    "90",
    "1e3",
    "1e-9",
    "1e-300",
    "5e-324",
    "1e154",
    "1e160",
    "1e200",
    "1e300",
    "-1e300",
    "1.7976931348623157e308",
    "1e999",
    "nan",
    "inf",
    "1,5",
    "",
    "0 0 0",
    "1e300 1e300 1e300",
];

const MJCF_WORDS: &[&str] = &[
    "<",
    "/>",
    "'",
    "\"",
    "&",
    "<!--",
    "-->",
    "ä",
    "<body name='c'>",
    "</body>",
    "<joint/>",
    "<joint type='slide' ref='1'/>",
    "<joint class='a'/>",
    "<freejoint/>",
    "<frame euler='0 90 0'>",
    "</frame>",
    "<geom size='0.1 0.2 0.3'/>",
    "<geom type='box' size='1 1 1' mass='2'/>",
    "<inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/>",
    "<inertial pos='0 0 0' mass='1' fullinertia='1 1 1 0 0 0'/>",
    "<site name='s' fromto='0 0 0 0 0 1'/>",
    "<compiler settotalmass='3'/>",
    "<compiler angle='radian' eulerseq='XYZ'/>",
    "<compiler boundmass='1' boundinertia='1' balanceinertia='true'/>",
    "<compiler inertiafromgeom='true'/>",
    "<option gravity='0 0 -1'/>",
    "<default><default class='a'><joint armature='1'/></default></default>",
    "<default><geom density='1e300'/></default>",
    "<include file='a.xml'/>",
    "<equality><joint joint1='elbow' joint2='shoulder' polycoef='1 2'/></equality>",
    "<tendon><fixed name='t' range='0 1'/></tendon>",
    "<extension><plugin plugin='p'><instance/></plugin></extension>",
    "capsule",
    "cylinder",
    "ellipsoid",
    "sphere",
    "mesh",
    "plane",
    "slide",
    "hinge",
    "ball",
    "true",
    "false",
    "auto",
    "shoulder",
    "elbow",
    "name",
    "quat",
    "euler",
    "axisangle",
    "xyaxes",
    "zaxis",
    "class",
    "range",
    "actuatorfrcrange",
    "mass",
    "density",
    "fromto",
    "childclass='a'",
    "damping='1 2 3'",
];

/// One change: of a number, of a word, of bytes.
fn mutate(text: &mut Vec<u8>, other: &[u8], words: &[&str], random: &mut Random) {
    let at = random.below(text.len() + 1);
    let most = if random.below(8) == 0 { 400 } else { 8 };
    let length = 1 + random.below(most);
    let end = (at + length).min(text.len());
    match random.below(8) {
        0..=2 => {
            // the value in quotes after the place
            let quote = |from: usize, text: &[u8]| text[from..].iter().position(|&b| b == b'"').map(|k| from + k);
            let Some(open) = quote(at, text) else { return };
            let Some(close) = quote(open + 1, text) else { return };
            let value = NUMBERS[random.below(NUMBERS.len())];
            let numbers = text[open + 1..close].split(|&b| b == b' ').count();
            let value = if random.below(8) == 0 { value.to_string() } else { vec![value; numbers].join(" ") };
            text.splice(open + 1..close, value.bytes());
        }
        3 => drop(text.splice(at..at, words[random.below(words.len())].bytes())),
        4 => drop(text.splice(at..end, words[random.below(words.len())].bytes())),
        5 => drop(text.drain(at..end)),
        6 => {
            let piece = text[at..end].to_vec();
            let to = random.below(text.len() + 1);
            text.splice(to..to, piece);
        }
        _ if random.below(4) == 0 && at < text.len() => text[at] = random.next() as u8,
        _ => {
            let from = random.below(other.len());
            let piece = &other[from..(from + length).min(other.len())];
            text.splice(at..end, piece.iter().copied());
        }
    }
}

/// Each text of the corpus, and then mutations of them.
fn texts(name: &str, target: fn(&[u8]), corpus: &[Vec<u8>], words: &[&str]) {
    corpus.iter().for_each(|text| target(text));
    run(name, target, |random| {
        let mut text = corpus[random.below(corpus.len())].clone();
        for _ in 0..=random.below(5) {
            let other = &corpus[random.below(corpus.len())];
            mutate(&mut text, other, words, random);
        }
        text
    });
}

#[test]
#[ignore = "takes its time; cargo xtask test runs it"]
fn urdf() {
    texts("urdf", targets::urdf, &corpus(&["tests/broken", "models"], "urdf"), WORDS);
}

#[test]
#[ignore = "takes its time; cargo xtask test runs it"]
fn mjcf() {
    texts(
        "mjcf",
        targets::mjcf,
        &corpus(&["tests/broken/mjcf", "../../oracles", "../../oracles/parts"], "xml"),
        MJCF_WORDS,
    );
}

#[test]
#[ignore = "takes its time; cargo xtask test runs it"]
fn description() {
    run("description", targets::description, |random| {
        // small bytes are harmless numbers: every third input is made of them
        let (length, mask) = (random.below(600), if random.below(3) == 0 { 0x7f } else { 0xff });
        (0..length).map(|_| random.next() as u8 & mask).collect()
    });
}
