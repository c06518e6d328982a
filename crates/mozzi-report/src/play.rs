//! The playground as one HTML file: robots as the texts of their files, which the page reads itself.

use crate::Drawing;
use crate::page::filled;
use mozzi::Model;
use mozzi_urdf::geometry::FRICTION;
use mozzi_urdf::{embedded, json};
use serde_json::{Value, json};

/// HTML, gzipped, made by `cargo xtask page` from `page/`.
const PAGE: &[u8] = include_bytes!("../bundle/play.html.gz");
/// mozzi-web with files and simulation for WebAssembly, gzipped, made by `cargo xtask page`.
const WASM: &[u8] = include_bytes!("../bundle/play.wasm.gz");

/// Robots next to the embedded ones: name, file, text.
const MORE: [(&str, &str, &str); 4] = [
    ("snake, a xacro", "snake.urdf.xacro", include_str!("../robots/snake.urdf.xacro")),
    ("spherical pendulum, an MJCF", "spherical_pendulum.xml", include_str!("../robots/spherical_pendulum.xml")),
    ("four-bar linkage", "four_bar.json", include_str!("../robots/four_bar.json")),
    ("Delta robot", "delta.json", include_str!("../robots/delta.json")),
];

/// Where robots start: poses from which they fall, swing or stand, of our own choice.
const STARTS: [(&str, &[f64]); 7] = [
    ("anymal", &[0.0, 0.4, -0.8, 0.0, 0.4, -0.8, 0.0, -0.4, 0.8, 0.0, -0.4, 0.8]),
    ("double_pendulum", &[1.6, 0.3]),
    ("furuta_pendulum", &[0.0, 0.4]),
    ("panda", &[0.0, -0.8, 0.0, -2.4, 0.0, 1.6, 0.8, 0.02]),
    ("two_link_planar", &[0.3, 0.8]),
    ("ur5", &[0.0, -1.2, 1.5, -0.3, -1.57, 0.0]),
    ("snake, a xacro", &[0.3, -0.5, 0.2, 0.6, -0.3, 0.4]),
];

/// Lessons: their number, which is that of a section of the book, and their text, which is JSON.
const LESSONS: [(&str, &str); 7] = [
    ("8.1", include_str!("../lessons/8.1.json")),
    ("8.2", include_str!("../lessons/8.2.json")),
    ("8.3", include_str!("../lessons/8.3.json")),
    ("8.4", include_str!("../lessons/8.4.json")),
    ("8.5", include_str!("../lessons/8.5.json")),
    ("8.6", include_str!("../lessons/8.6.json")),
    ("8.7", include_str!("../lessons/8.7.json")),
];

/// The numbers of the lessons.
pub fn lessons() -> impl Iterator<Item = &'static str> {
    LESSONS.iter().map(|&(number, _)| number)
}

/// The playground with a lesson beside its robot; none if there is no lesson of this number.
pub fn lesson_html(number: &str) -> Option<String> {
    let &(_, text) = LESSONS.iter().find(|&&(known, _)| known == number)?;
    let lesson: Value = serde_json::from_str(text).ok()?;
    let mut robots = menu();
    let place = robots.iter().position(|robot| robot["name"] == lesson["robot"])?;
    if !lesson["theta"].is_null() {
        robots[place]["theta"] = lesson["theta"].clone();
    }
    let title = format!("{}: mozzi's playground", lesson["title"].as_str().unwrap_or_default());
    let data = json!({ "robots": robots, "first": place, "friction": FRICTION, "lesson": lesson });
    Some(filled(PAGE, WASM, &title, &data))
}

/// The embedded robots, a xacro, an MJCF and two closed loops.
fn menu() -> Vec<Value> {
    embedded::names()
        .map(|name| {
            let file = format!("{name}.urdf");
            entry(name, &file, embedded::text(name).unwrap_or_default(), true)
        })
        .chain(MORE.map(|(name, file, text)| entry(name, file, text, false)))
        .collect()
}

/// The robot that the playground shows at first.
#[derive(Clone, Copy, Debug)]
pub struct Played<'a> {
    /// Its name in the menu: that of an embedded robot, or a path.
    pub name: &'a str,
    /// The name of its file.
    pub file: &'a str,
    /// The file's text: URDF, MJCF or JSON.
    pub text: &'a str,
    /// Other texts that it includes, by their paths from its folder.
    pub included: &'a [(String, String)],
    /// The robot itself; what differs from the text comes from options.
    pub model: &'a Model,
    /// Its meshes.
    pub drawing: &'a Drawing,
    /// Where it starts, other than the playground's own pose of an embedded robot or the file's start.
    pub theta: Option<&'a [f64]>,
}

/// The playground with a first robot, the embedded ones, a xacro, an MJCF and two closed loops.
pub fn play_html(first: &Played) -> String {
    let mut robots = menu();
    let place = embedded::names().position(|name| name == first.name && is_as_in_file(name, first.model));
    let place = place.unwrap_or_else(|| {
        let name = first.name.rsplit(['/', '\\']).next().unwrap_or_default();
        let mut own = entry(name, first.file, first.text, false);
        own["description"] = json::to_value(first.model.description());
        for (path, text) in first.included {
            own["files"][path] = json!(text);
        }
        // whether the page's programs may open the file: an option or xacro made other robots
        own["isAsFile"] = json!(name == first.file && is_as_in_file(first.name, first.model));
        own["meshes"] = first.drawing.meshes_to_json();
        robots.insert(0, own);
        0
    });
    if let Some(theta) = first.theta {
        robots[place]["theta"] = json!(theta);
    }
    let title = format!("{}: mozzi's playground", first.model.description().name);
    filled(PAGE, WASM, &title, &json!({ "robots": robots, "first": place, "friction": FRICTION }))
}

fn entry(name: &str, file: &str, text: &str, is_embedded: bool) -> Value {
    let start = STARTS.iter().find(|(known, _)| *known == name).map(|(_, theta)| theta);
    json!({ "name": name, "file": file, "files": { file: text }, "isEmbedded": is_embedded, "theta": start })
}

/// True if no option changes the robot of a file, or an embedded one.
fn is_as_in_file(name_or_path: &str, model: &Model) -> bool {
    mozzi_urdf::open(name_or_path).is_ok_and(|loaded| loaded.description == *model.description())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::page::unpacked;

    #[test]
    fn the_playground_asks_for_nothing_and_is_small() {
        let page = unpacked(PAGE);
        assert!(page.contains("default-src 'none'") && page.contains("connect-src 'none'"));
        assert!(page.contains("three.js") && page.contains("The MIT License"), "the notice of three.js");
        let model = mozzi_urdf::open("ur5").expect("embedded").build().expect("sound");
        let drawing = Drawing::default();
        let page = play_html(&Played {
            name: "ur5",
            file: "ur5.urdf",
            text: "",
            included: &[],
            model: &model,
            drawing: &drawing,
            theta: None,
        });
        assert!(page.len() < 2_500_000, "{} bytes", page.len());
        assert!(page.contains("\"first\":5") && page.contains("<title>ur5: mozzi's playground</title>"));
    }

    #[test]
    fn every_lesson_has_its_robot_and_questions() {
        for number in lessons() {
            let page = lesson_html(number).expect("a lesson");
            assert!(page.contains("\"lesson\":{") && page.len() < 2_500_000, "{number}: {} bytes", page.len());
        }
        for (number, text) in LESSONS {
            let lesson: Value = serde_json::from_str(text).expect("JSON");
            assert!(lesson["title"].as_str().is_some_and(|title| title.starts_with(number)));
            let parts = lesson["parts"].as_array().expect("parts");
            let questions = parts.iter().filter(|part| !part["ask"].is_null() || !part["choose"].is_null());
            assert!(questions.count() > 1, "{number}");
        }
        assert_eq!(lesson_html("9.1"), None);
    }

    #[test]
    fn another_robot_comes_first() {
        let text = MORE[2].2;
        let file = json::File::parse("four_bar.json", text).expect("JSON");
        let model = json::read(&file).expect("sound").build().expect("sound");
        let drawing = Drawing::default();
        let page = play_html(&Played {
            name: "a/own.json",
            file: "own.json",
            text,
            included: &[("parts/b.xml".to_string(), "<mujoco/>".to_string())],
            model: &model,
            drawing: &drawing,
            theta: None,
        });
        assert!(page.contains("\"first\":0") && page.contains("\"name\":\"own.json\""));
        assert!(page.contains("\"isAsFile\":false"), "there is no such file");
        assert!(page.contains("\"parts/b.xml\":\"\\u003cmujoco/>\""), "what it includes");
    }

    #[test]
    fn a_robot_starts_where_it_is_told() {
        let model = mozzi_urdf::open("double_pendulum").expect("embedded").build().expect("sound");
        let drawing = Drawing::default();
        let (name, file) = ("double_pendulum", "double_pendulum.urdf");
        let theta = Some(&[0.125, -0.25][..]);
        let page = play_html(&Played { name, file, text: "", included: &[], model: &model, drawing: &drawing, theta });
        assert!(page.contains("\"theta\":[0.125,-0.25]"));
    }
}
