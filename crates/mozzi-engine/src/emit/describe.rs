//! Comments of emitted text: the robot, the functions and their arrays.

use super::Precision;
use super::names::in_comment;
use crate::program::{Arguments, Derivative, Program};
use mozzi::Freedom;
use mozzi::quantities::{Of, Query};
use mozzi::{FrameId, Model, TaskFrame};

/// Sentences of the header comment about all functions of a text.
pub(super) struct Rules {
    /// The order of the entries of matrices.
    pub matrices: &'static str,
    /// Checks beside those of NaN and large angles.
    pub checks: &'static str,
}

/// Functions on arrays.
pub(super) const ARRAYS: Rules = Rules { matrices: "Matrices are by rows.", checks: "nothing else is checked" };

/// The header comment of a text.
pub(super) fn robot(model: &Model, arguments: Arguments, precision: Precision, rules: Rules) -> Vec<String> {
    let mut lines = vec![
        format!("The dynamics of the robot `{}` as straight-line code.", in_comment(&model.description().name)),
        format!("Made by mozzi {}; do not edit; generate it again.", env!("CARGO_PKG_VERSION")),
        String::new(),
    ];
    let numbers = if precision.is_f64() { "64-bit" } else { "32-bit" };
    lines.push(format!(
        "Numbers are {numbers} floats in SI units: m, rad, kg, s, N. Six numbers are angular first: twists (w, v), wrenches (m, f)."
    ));
    lines.push(format!("Arrays must not overlap. {}", rules.matrices));
    lines.push(
        "Frames: {s} is the frame of the fixed base, or the world of a floating one; a link's frame is that of the file."
            .to_string(),
    );
    let gravity = match arguments.gravity {
        true => "an argument".to_string(),
        false => {
            let [x, y, z] = model.gravity().0;
            format!("({x}, {y}, {z}) m/s^2")
        }
    };
    lines.push(format!("In these functions gravity is {gravity}, in {{s}}."));
    match arguments.wrenches {
        [] => lines.push("No wrenches are applied.".to_string()),
        frames => {
            let names: Vec<String> = frames.iter().map(|&frame| format!("`{}`", frame_name(model, frame))).collect();
            lines.push(format!("Wrenches that these frames apply are arguments: {}.", names.join(", ")));
        }
    }
    if arguments.parameters {
        lines.push("Masses, inertias, frictions and springs are an argument; geometry is built in.".to_string());
    }
    lines.push(format!(
        "Results that depend on NaN or an angle beyond {:?} rad are NaN; {}.",
        precision.largest_angle(),
        rules.checks
    ));
    lines.push(String::new());
    let joints: Vec<_> = model.moving_joints().map(|joint| (joint.name.as_str(), joint.kind.name())).collect();
    if model.is_floating() {
        lines.push(
            "theta[0..6] is the base's pose in {s}: unit quaternion (w, x, y, z), origin (x, y, z) in m.".to_string(),
        );
        lines.push(
            "Entries 0 to 5 of velocities are its twist (w, v) in its own coordinates, rad/s and m/s; of accelerations their rates;"
                .to_string(),
        );
        lines.push("of forces the wrench (m, f) on it in its own coordinates, N m and N.".to_string());
    }
    let is_flat = model.configuration_space().is_flat();
    for (name, place) in model.joint_names().zip(model.places()) {
        let kind = joints.iter().find(|(known, _)| *known == name).map_or("", |(_, kind)| kind);
        let units = match place.freedom {
            Freedom::One if kind == "prismatic" => "m, m/s, m/s^2, N",
            Freedom::One => "rad, rad/s, rad/s^2, N m",
            Freedom::Ball => "unit quaternion (w, x, y, z); w in its link's axes, rad/s; its rate; m, N m",
            Freedom::Free => {
                "unit quaternion (w, x, y, z), origin in m; twist (w, v) in its link's coordinates; its rate; wrench (m, f)"
            }
        };
        let (q, j) = (place.positions(), place.velocities());
        let places = match place.freedom {
            Freedom::One if is_flat => format!("[{}]", place.j),
            Freedom::One => format!("theta[{}], others [{}]", place.q, place.j),
            _ => format!("theta[{}..{}], others [{}..{}]", q.start, q.end - 1, j.start, j.end - 1),
        };
        lines.push(format!("  {places} {}: {kind}; {units}", in_comment(name)));
    }
    lines
}

fn frame_name(model: &Model, frame: FrameId) -> String {
    in_comment(model.frame_name(frame))
}

/// The formula of a quantity, and the cost of the recursive algorithm.
pub(super) fn quantity(model: &Model, query: Query, program: &Program) -> Vec<String> {
    let frame = query.subject.frame.map(|frame| format!(" Frame: `{}`.", frame_name(model, frame)));
    let words = format!("{}.{}{}", ascii(query.declaration().formula), frame.unwrap_or_default(), rows(query));
    let before = program
        .count_before_folding()
        .map(|count| format!("The recursive algorithm takes {} flops; of these remain:", count.flops()));
    [words].into_iter().chain(before).collect()
}

/// The rows of a task.
fn rows(query: Query) -> String {
    if query.declaration().of != Of::Task {
        return String::new();
    }
    let names: Vec<&str> = query.subject.rows.iter().map(|&row| ["wx", "wy", "wz", "vx", "vy", "vz"][row]).collect();
    let coordinates = match query.subject.coordinates {
        TaskFrame::Body => "the frame's coordinates",
        TaskFrame::Space => "{s}",
    };
    format!(" Rows: {} of its twist, in {coordinates}.", names.join(", "))
}

/// Shape, meaning and unit of an array.
pub(super) fn array(model: &Model, query: Query, arguments: Arguments, name: &str) -> String {
    if let Some(of) = name.strip_suffix("_rate").filter(|_| matches!(arguments.derivative, Derivative::Rates(_))) {
        let along = if of == "theta" { ", along the velocities" } else { "" };
        return format!("the rate of {of} in the direction of the inputs' rates{along}");
    }
    if let (Derivative::Product(_), Some(about)) = (arguments.derivative, of_product(name)) {
        return about.to_string();
    }
    let declaration = query.declaration();
    let base = if model.is_floating() { "base and " } else { "" };
    if let Some(input) = declaration.inputs.iter().find(|input| input.name == name) {
        let units = if name == "theta" { "units above".to_string() } else { ascii(input.unit) };
        return format!("{}; {} of {base}joints, {units}", input.dim.size(model, &query.subject), input.about);
    }
    if let Some(output) = declaration.outputs.iter().find(|output| output.name == name) {
        let sizes: Vec<String> = output.shape(model, &query.subject).map(|size| size.to_string()).collect();
        let shape = if sizes.is_empty() { "1".to_string() } else { sizes.join(" x ") };
        return format!("{shape}; {}", ascii(output.unit));
    }
    let twist = |what: &str| format!("6; the {what} of {{s}}, in its own coordinates, angular first");
    match name {
        "pivots" | "task_pivots" => {
            "the pivots of the factorization. If one is not positive, or below 4e-9 of their sum, the matrix may be \
             singular and the results are meaningless"
                .to_string()
        }
        "parameters" => format!(
            "{}; of {base}moving links (m, m c, I_xx, I_xy, I_xz, I_yy, I_yz, I_zz) in their frames, kg, kg m, kg m^2; of joints armature, damping, friction, stiffness, preload",
            model.parameter_count()
        ),
        "gravity" => "3; in {s}, m/s^2".to_string(),
        "about" => "3; a point in {s}, m".to_string(),
        "base_twist" => twist("twist"),
        "base_acceleration" => {
            "6; the rates (dw, dv) of the twist of {s}, in its own coordinates, without gravity: not the acceleration of its \
             origin, which is dv + w x v"
                .to_string()
        }
        _ => {
            let of_name = |frame: &&FrameId| arguments.wrench_name(model, **frame) == name;
            let frame = arguments.wrenches.iter().find(of_name).map(|&frame| frame_name(model, frame));
            let frame = frame.unwrap_or_default();
            format!("6; (m, f) that the frame `{frame}` applies to what it touches, in its own coordinates, N m, N")
        }
    }
}

/// An array of a product of derivatives.
fn of_product(name: &str) -> Option<&'static str> {
    match name {
        "along" => Some("changes of inputs along a direction, one input after the other"),
        "along_2" => Some("changes of inputs along a second direction, one input after the other"),
        "w" => Some("a weight for each number of the quantity"),
        "product" => Some("the product with its derivatives"),
        _ => None,
    }
}

/// Symbols and their names in plain letters, longer ones first.
const LETTERS: [(&str, &str); 50] = [
    ("θ̈", "ddtheta"),
    ("θ̇", "dtheta"),
    ("θ_j", "theta_j"),
    ("θ", "theta"),
    ("τ", "tau"),
    ("Ṁ", "dM"),
    ("M⁻¹", "M^-1"),
    ("ḣ", "dh"),
    ("ċ", "dc"),
    ("c̈", "ddc"),
    ("Ȧ", "dA"),
    ("𝒱̇", "dV"),
    ("𝒱", "V"),
    ("𝓕", "F"),
    ("𝒦", "K"),
    ("𝒫", "P"),
    ("Λ", "Lambda"),
    ("λ", "lambda"),
    ("φ", "phi"),
    ("⁺", "+"),
    ("η", "eta"),
    ("μ", "mu"),
    ("π", "pi"),
    ("ω", "w"),
    ("½", "1/2 "),
    ("ᵀ", "^T "),
    ("²", "^2"),
    ("⁻¹", "^-1"),
    ("∂", "d"),
    ("−", "-"),
    ("Σ", "sum"),
    ("·", " "),
    ("₀", "0"),
    ("₁", "1"),
    ("₂", "2"),
    ("ü", "ue"),
    ("é", "e"),
    ("–", "-"),
    ("×", "x"),
    ("√", "sqrt "),
    ("ℒ", "L"),
    ("𝒢", "G"),
    ("𝒜", "A"),
    ("𝒲", "W"),
    ("≤", "<="),
    ("≥", ">="),
    ("°", " deg"),
    ("…", "..."),
    ("„", "'"),
    ("“", "'"),
];

/// A formula or a unit in ASCII, which every compiler reads in a comment. Factors stand apart: J_bθ̇ is J_b dtheta.
fn ascii(text: &str) -> String {
    let (mut plain, mut rest, mut is_prefix) = (String::new(), text, false);
    while let Some(next) = rest.chars().next() {
        let found = LETTERS.iter().find(|(symbol, _)| rest.starts_with(symbol));
        let (symbol, letters) =
            found.copied().unwrap_or((&rest[..next.len_utf8()], if next.is_ascii() { "" } else { "_" }));
        let letters = if letters.is_empty() { symbol } else { letters };
        let is_factor =
            found.is_some() && letters.len() > 1 && letters.starts_with(char::is_alphabetic) && symbol != "ü";
        if is_factor && !is_prefix && plain.ends_with(|last: char| last.is_alphanumeric() || last == ')') {
            plain.push(' ');
        }
        plain += letters;
        is_prefix = symbol == "∂";
        rest = &rest[symbol.len()..];
    }
    plain
}

#[cfg(test)]
mod tests {
    #[test]
    fn every_formula_has_plain_letters() {
        for declaration in mozzi::quantities::LIST {
            let units = declaration.outputs.iter().map(|output| output.unit);
            let units = units.chain(declaration.inputs.iter().map(|input| input.unit));
            for text in units.chain([declaration.formula]) {
                assert!(text.contains('_') || !super::ascii(text).contains('_'), "{text}: {}", super::ascii(text));
            }
        }
        assert_eq!(super::ascii("τ = M(θ)θ̈ + JᵀF"), "tau = M(theta) ddtheta + J^T F");
        assert_eq!(super::ascii("V = J_bθ̇, ½θ̇ᵀMθ̇, ∂τ/∂θ"), "V = J_b dtheta, 1/2 dtheta^T M dtheta, dtau/dtheta");
    }
}
