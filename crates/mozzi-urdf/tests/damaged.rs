//! Damaged and enormous files: a result or an error, never a panic, in bounded time.

use mozzi_urdf::{Style, embedded, parse};

/// An embedded robot, or one of the two MuJoCo models that are written for the tests.
fn text(k: usize) -> &'static str {
    const MODELS: [&str; 2] =
        [include_str!("../../../oracles/test_bodies.xml"), include_str!("../../../oracles/test_compiler.xml")];
    let k = k % (embedded::names().len() + MODELS.len());
    match embedded::names().nth(k) {
        Some(name) => embedded::text(name).expect("embedded").trim_end(),
        None => MODELS[k - embedded::names().len()].trim_end(),
    }
}

/// xorshift64*: the same numbers in every run.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 33) as usize % n
    }
}

/// Reads a text; an accepted robot becomes a model, a refused one a report.
fn answer(text: &[u8]) -> bool {
    match parse("damaged.urdf", text) {
        Ok(robot) => {
            robot.build().expect("what was read can be built");
            true
        }
        Err(error) => {
            assert!(error.errors().next().is_some() && !error.pretty(Style::Unicode).is_empty());
            assert!(
                error.errors().all(|error| error.line() >= 1 && error.column() >= 1 && !error.to_string().is_empty())
            );
            false
        }
    }
}

#[test]
fn truncated_anywhere() {
    for k in 0..7 {
        let text = text(k).as_bytes();
        let mut random = Random(7);
        for _ in 0..60 {
            assert!(!answer(&text[..random.below(text.len())]), "{k} without its end");
        }
    }
}

#[test]
fn mutated_anywhere() {
    let pieces: [&[u8]; 16] = [
        b"<",
        b">",
        b"/>",
        b"'",
        b"\"",
        b"&",
        b"-",
        b"0",
        b"1e999",
        b",",
        b"\0",
        b"\xff",
        b"link",
        b"<!--",
        b"\xc3\xa4",
        b"",
    ];
    let (mut random, mut accepted) = (Random(11), 0);
    for round in 0..560 {
        let mut text = text(round).replace("<include file=\"parts/test_leg.xml\"/>", "").into_bytes();
        for _ in 0..1 + random.below(3) {
            let (at, piece) = (random.below(text.len()), pieces[random.below(pieces.len())]);
            let end = (at + random.below(4)).min(text.len());
            text.splice(at..end, piece.iter().copied());
        }
        accepted += usize::from(answer(&text));
    }
    assert!(accepted > 0 && accepted < 560, "{accepted}"); // in a comment, damage does no harm
}

#[test]
fn nested_without_end() {
    for start in ["<robot name='a'>", "<robot name='a'><link name='b'>", "<mujoco>", "<mujoco><worldbody><body>"] {
        for piece in ["<a>", "<link name='a'>", "<!--", "<![CDATA[", "<a b='", "</a>", "<a xmlns:b='c'>", "<?"] {
            assert!(!answer(format!("{start}{}", piece.repeat(200_000)).as_bytes()), "{piece}");
        }
    }
}

#[test]
fn wrong_throughout() {
    // thousands of errors of each kind that looks something up
    let link = |k: usize| format!("<link name='l{k}'><inertial/></link>");
    let joint = |k: usize| {
        format!(
            "<joint name='j{k}' type='revolute'><parent link='x{k}'/><child link='y{k}'/><mimic joint='z{k}'/></joint>"
        )
    };
    let text: String = (0..20_000).map(|k| link(k) + &joint(k)).collect();
    let error = parse("wrong.urdf", format!("<robot name='r'>{text}</robot>")).expect_err("wrong");
    assert_eq!(error.errors().count(), 1000);
    assert!(error.to_string().ends_with("more"), "{error}");
    // a circle of mimic joints
    let text: String = (0..20_000)
        .map(|k| {
            let next = (k + 1) % 20_000;
            format!("<link name='l{}'/><joint name='j{k}' type='continuous'><parent link='l0'/><child link='l{}'/><mimic joint='j{next}'/></joint>", k + 1, k + 1)
        })
        .collect();
    let error = parse("circle.urdf", format!("<robot name='r'><link name='l0'/>{text}</robot>")).expect_err("a circle");
    assert!(error.errors().all(|error| error.code() == "mozzi::urdf::circular_mimic"), "{error}");
}

const BODY: &str = "<inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial>";

#[test]
fn ten_thousand_links() {
    let robot = |parent: fn(usize) -> usize| {
        let link = |k: usize| {
            format!(
                "<link name='l{k}'>{BODY}</link>\n<joint name='j{k}' type='continuous'><parent link='l{}'/><child link='l{k}'/>\
                 <origin xyz='0 0 0.1'/><axis xyz='0 1 0'/></joint>\n",
                parent(k)
            )
        };
        format!("<robot name='r'><link name='l0'/>\n{}</robot>", (1..10_000).map(link).collect::<String>())
    };
    for text in [robot(|k| k - 1), robot(|_| 0)] {
        let robot = parse("large.urdf", text).expect("a robot");
        assert!(robot.warnings.is_empty());
        assert_eq!(robot.description.links.len(), 10_000);
    }
}

#[test]
fn large_and_wrong_models_of_mujoco() {
    let classes: String =
        (0..5_000).map(|k| format!("<default class='class{k}'><joint axis='1 0 0'/></default>")).collect();
    let bodies: String =
        (0..20_000).map(|k| format!("<body name='b{k}'><joint class='clas{k}'/><geom size='{k}'/></body>")).collect();
    let wrong = format!("<mujoco><default>{classes}</default><worldbody>{bodies}</worldbody></mujoco>");
    let error = parse("wrong.xml", wrong).expect_err("no such classes");
    assert_eq!(error.errors().count(), 1000);
    // a class with many values inside many others
    let deep = format!("{}{}", "<default class='d'>".repeat(200), "</default>".repeat(200));
    let error = parse("deep.xml", format!("<mujoco><default>{deep}</default></mujoco>")).expect_err("one name");
    assert!(error.errors().all(|error| error.code() == "mozzi::mjcf::duplicate_name"), "{error}");

    let bodies: String = (0..10_000)
        .map(|k| format!("<body name='b{k}'><joint name='j{k}'/><geom size='0.1'/><site name='b{k}'/></body>"))
        .collect();
    let robot = parse("large.xml", format!("<mujoco><worldbody>{bodies}</worldbody></mujoco>")).expect("a robot");
    assert_eq!((robot.description.links.len(), robot.warnings.len()), (10_001, 1));
    assert_eq!(robot.build().expect("a model").n(), 10_000);
}
