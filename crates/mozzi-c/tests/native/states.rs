//! Robots and states with every quantity by the library itself: what the programs read and compare with.

use mozzi::model::integrate;
use mozzi::quantities::{LIST, Of, Query};
use mozzi::random::Random;
use mozzi::{Environment, Model, TaskFrame, Twist, Vec3, Wrench};
use std::fmt::Write;

/// The tips of a Panda's fingers at one place: a closed loop.
const LOOP: &str = r#"{"constraints": [{"name": "grip", "kind": "point", "a": {"frame": null, "xyz": [0.3, 0.1, 0.5]}, "b": {"frame": "panda_hand"}}]}"#;

/// Name, floating base, frame, constraints.
const ROBOTS: [(&str, bool, &str, &str); 4] = [
    ("two_link_planar", false, "", ""),
    ("panda", false, "panda_hand", LOOP),
    ("ur5", true, "", ""),
    ("anymal", true, "LF_FOOT", ""),
];

fn numbers(text: &mut String, list: &[f64]) {
    list.iter().for_each(|x| write!(text, "{x:?} ").expect("a String"));
    text.push('\n');
}

fn model(name: &str, floating: bool, constraints: &str) -> Model {
    let mut robot = mozzi_urdf::open(name).expect("embedded").description;
    if floating {
        robot = robot.floating();
    }
    if !constraints.is_empty() {
        robot = mozzi_urdf::constraints::parse("constraints", constraints, robot).expect("frames of the robot");
    }
    robot.build().expect("sound")
}

/// The file of the programs.
pub fn file() -> String {
    let (mut text, mut random) = (String::new(), Random(24));
    for (name, floating, frame, constraints) in ROBOTS {
        let model = model(name, floating, constraints);
        let last = model.frames().last().expect("a frame").1.to_string();
        let frame = if frame.is_empty() { &last } else { frame };
        let line = if constraints.is_empty() { "-" } else { constraints };
        writeln!(text, "{name} {} {frame}\n{line}", u8::from(floating)).expect("a String");
        let mut list = |length: usize| -> Vec<f64> { (0..length).map(|_| random.next()).collect() };
        let (n, around) = (model.n(), list(24));
        let six = |from: usize| -> [f64; 6] { std::array::from_fn(|k| around[from + k]) };
        let three = |from: usize| Vec3(std::array::from_fn(|k| around[from + k]));
        numbers(&mut text, &around);
        let rows = [0, 3, 4];
        let rows = if n < 3 { &rows[1..2] } else { &rows[..] };
        writeln!(text, "{} {}", rows.len(), rows.iter().map(ToString::to_string).collect::<Vec<_>>().join(" "))
            .expect("a String");
        let frame = model.frame(frame).expect("a frame of the robot");
        let applied = [(frame, Wrench::from_array(six(15)))];
        let environment = Environment {
            gravity: three(0),
            base_twist: Twist::from_array(six(3)),
            base_acceleration: Twist::from_array(six(9)),
            applied: &applied,
        };
        let mut theta = model.start().theta;
        integrate(&model, &mut theta, &list(n), 1.0);
        for (index, declaration) in LIST.iter().enumerate() {
            let mut query = Query::at(index).of(frame);
            if declaration.of == Of::Task {
                query.subject.rows = rows;
                query.subject.coordinates = TaskFrame::Space;
            }
            query.subject.point = three(21);
            let lengths: Vec<usize> = query.input_lengths(&model).collect();
            let inputs: Vec<Vec<f64>> = declaration
                .inputs
                .iter()
                .zip(lengths)
                .map(|(input, length)| if input.name == "theta" { theta.clone() } else { list(length) })
                .collect();
            let slices: Vec<&[f64]> = inputs.iter().map(Vec::as_slice).collect();
            let found = model.compute(query, &slices, &environment);
            let found = found.unwrap_or_else(|error| panic!("{} of {name}: {error}", declaration.name));
            inputs.iter().chain(&found).for_each(|list| numbers(&mut text, list));
        }
    }
    text
}
