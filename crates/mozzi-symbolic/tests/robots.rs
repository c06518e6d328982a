//! Small robots of textbooks, with a different decimal for each number.

/// A joint and the link that it moves.
pub struct Moved {
    pub kind: &'static str,
    pub axis: &'static str,
    pub origin: &'static str,
    pub rpy: &'static str,
    pub mass: &'static str,
    pub center: &'static str,
    pub inertia: [&'static str; 3],
}

const POINT: [&str; 3] = ["0"; 3];

pub fn moved(
    kind: &'static str,
    axis: &'static str,
    origin: &'static str,
    mass: &'static str,
    center: &'static str,
    inertia: [&'static str; 3],
) -> Moved {
    Moved { kind, axis, origin, rpy: "0 0 0", mass, center, inertia }
}

/// URDF of a chain.
pub fn chain(name: &str, links: &[Moved]) -> String {
    let mut text = format!("<robot name=\"{name}\"><link name=\"base\"/>\n");
    for (i, link) in (1..).zip(links) {
        let parent = if i == 1 { "base".to_string() } else { format!("link{}", i - 1) };
        let [xx, yy, zz] = link.inertia;
        let limit = if link.kind == "continuous" {
            ""
        } else {
            "<limit lower=\"-9\" upper=\"9\" effort=\"99\" velocity=\"9\"/>"
        };
        text.push_str(&format!(
            "<joint name=\"joint{i}\" type=\"{}\"><parent link=\"{parent}\"/><child link=\"link{i}\"/>\
             <origin xyz=\"{}\" rpy=\"{}\"/><axis xyz=\"{}\"/>{limit}</joint>\n\
             <link name=\"link{i}\"><inertial><origin xyz=\"{}\"/><mass value=\"{}\"/>\
             <inertia ixx=\"{xx}\" iyy=\"{yy}\" izz=\"{zz}\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link>\n",
            link.kind, link.origin, link.rpy, link.axis, link.center, link.mass
        ));
    }
    text + "</robot>\n"
}

/// The robots by name.
pub fn all() -> Vec<(&'static str, String)> {
    let (turn, slide) = ("continuous", "prismatic");
    let rr = [
        moved(turn, "0 -1 0", "0 0 0", "2.1", "0.31 0 0", ["0.011", "0.013", "0.017"]),
        moved(turn, "0 -1 0", "0.53 0 0", "1.3", "0.23 0 0", ["0.007", "0.019", "0.021"]),
    ];
    let rp = [
        moved(turn, "0 -1 0", "0 0 0", "2.1", "0.31 0 0", ["0.011", "0.013", "0.017"]),
        moved(slide, "1 0 0", "0 0 0", "1.3", "0 0 0", ["0.007", "0.019", "0.021"]),
    ];
    let pr = [
        moved(slide, "0 0 1", "0 0 0", "2.1", "0 0 0", POINT),
        moved(turn, "0 -1 0", "0 0 0", "1.3", "0.23 0 0", ["0.007", "0.019", "0.021"]),
    ];
    let rrr = [
        moved(turn, "0 -1 0", "0 0 0", "2.1", "0.31 0 0", ["0.011", "0.013", "0.017"]),
        moved(turn, "0 -1 0", "0.53 0 0", "1.3", "0.23 0 0", ["0.007", "0.019", "0.021"]),
        moved(turn, "0 -1 0", "0.43 0 0", "0.8", "0.12 0 0", ["0.003", "0.009", "0.01"]),
    ];
    let scara = [
        moved(turn, "0 0 1", "0 0 0.61", "2.1", "0.31 0 0", ["0.011", "0.013", "0.017"]),
        moved(turn, "0 0 1", "0.53 0 0", "1.3", "0.23 0 0", ["0.007", "0.019", "0.021"]),
        moved(turn, "0 0 1", "0.43 0 0", "0.8", "0 0 0", ["0.003", "0.009", "0.01"]),
        moved(slide, "0 0 -1", "0 0 0", "0.35", "0 0 0", ["0.001", "0.002", "0.004"]),
    ];
    let furuta = [
        moved(turn, "0 0 1", "0 0 0", "2.1", "0.31 0 0", ["0.011", "0.013", "0.017"]),
        moved(turn, "1 0 0", "0.53 0 0", "1.3", "0 0 0.23", ["0.007", "0.019", "0.021"]),
    ];
    let cart_pole = [
        moved(slide, "1 0 0", "0 0 0", "2.1", "0 0 0", POINT),
        moved(turn, "0 1 0", "0 0 0", "1.3", "0 0 0.23", POINT),
    ];
    let double = [
        moved(slide, "1 0 0", "0 0 0", "2.1", "0 0 0", POINT),
        moved(turn, "0 1 0", "0 0 0", "1.3", "0 0 0.53", POINT),
        moved(turn, "0 1 0", "0 0 0.54", "0.8", "0 0 0.43", POINT),
    ];
    let puma = [
        moved(turn, "0 0 1", "0 0 0.67", "2.1", "0 0.05 0", ["0.011", "0.013", "0.017"]),
        Moved {
            rpy: "-1.5707963 0 0",
            ..moved(turn, "0 0 1", "0 0.14 0", "1.3", "0.23 0 0", ["0.007", "0.019", "0.021"])
        },
        moved(turn, "0 0 1", "0.43 0 0", "0.8", "0 0.12 0", ["0.003", "0.009", "0.01"]),
    ];
    vec![
        ("RR", chain("rr", &rr)),
        ("RP", chain("rp", &rp)),
        ("PR", chain("pr", &pr)),
        ("RRR", chain("rrr", &rrr)),
        ("SCARA", chain("scara", &scara)),
        ("Furuta", chain("furuta", &furuta)),
        ("cart-pole", chain("cart_pole", &cart_pole)),
        ("double pendulum on a cart", chain("double_on_cart", &double)),
        ("3R of a Puma", chain("puma", &puma)),
    ]
}
