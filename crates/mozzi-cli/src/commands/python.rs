//! A robot's lists as Python, in the shapes of the Modern Robotics package.

use mozzi::model::ScrewLists;
use mozzi::{Base, Model, SE3, ScrewAxis};

pub fn literals(model: &Model, lists: &ScrewLists, tip: SE3) -> String {
    let robot = &model.description().name;
    let last = match lists.M.last() {
        Some(M_n) => M_n.inverse() * tip, // M_{n,n+1}
        None => tip,
    };
    let poses: Vec<String> = lists.M_relative.iter().chain([&last]).map(|T| nested(&T.to_matrix())).collect();
    let inertias: Vec<String> = lists.G.iter().map(|G| nested(&G.to_matrix())).collect();
    let names: Vec<String> = lists.joints.iter().map(|name| literal(name)).collect();
    let mut lines = vec![
        format!(
            "# {}: the lists of Modern Robotics, chapter 8; angular first, SI units, frames at centres of mass",
            escaped(robot)
        ),
        "import numpy as np".to_string(),
        String::new(),
        format!("joints = [{}]", names.join(", ")),
        format!("g = np.array({})", flat(&model.gravity().0)),
        "# M_{i-1,i} of the links, then the end effector's".to_string(),
        format!("Mlist = np.array([\n{},\n])", poses.join(",\n")),
        "# spatial inertias".to_string(),
        format!("Glist = np.array([\n{},\n])", inertias.join(",\n")),
        "# screw axes as columns: in the base frame, and in the end effector's".to_string(),
        format!("Slist = np.array([\n{},\n]).T", axes(&lists.S)),
        format!("Blist = np.array([\n{},\n]).T", axes(&lists.B)),
        "# the end effector at theta = 0, seen from the base".to_string(),
        format!("M = np.array(\n{}\n)", nested(&tip.to_matrix())),
    ];
    let call = "# tau = mr.InverseDynamics(theta, dtheta, ddtheta, g, Ftip, Mlist, Glist, Slist)";
    match model.base() {
        Base::Fixed => lines.extend(["base = \"fixed\"", "", "# import modern_robotics as mr", call].map(str::to_string)),
        Base::Floating => lines.extend([
            "# link 0, the base, is free; its spatial inertia, in its own frame".to_string(),
            "base = \"floating\"".to_string(),
            format!("Gbase = np.array(\n{}\n)", nested(&model.base_inertia().to_matrix())),
            String::new(),
            "# import modern_robotics as mr; it supports fixed bases only: theta, dtheta, tau are the joints', the base at rest"
                .to_string(),
            call.to_string(),
        ]),
    }
    lines.push(String::new());
    lines.join("\n")
}

/// A name as a Python string.
fn literal(name: &str) -> String {
    format!("\"{}\"", escaped(name).replace('"', "\\\""))
}

/// Escapes backslashes and invisible characters as Python does: a line break would end a comment.
fn escaped(name: &str) -> String {
    let one = |c: char| match c {
        '\\' => "\\\\".to_string(),
        '\'' | '"' => c.to_string(),
        // Rust writes unprintable characters as \u{…}
        _ if c.escape_debug().len() == 1 => c.to_string(),
        _ if u32::from(c) < 0x1_0000 => format!("\\u{:04x}", u32::from(c)),
        _ => format!("\\U{:08x}", u32::from(c)),
    };
    name.chars().map(one).collect()
}

fn flat(values: &[f64]) -> String {
    // {:?} is the shortest text that reads back as the same number
    format!("[{}]", values.iter().map(|x| format!("{x:?}")).collect::<Vec<_>>().join(", "))
}

fn nested<const C: usize>(rows: &[[f64; C]]) -> String {
    format!("    [{}]", rows.iter().map(|row| flat(row)).collect::<Vec<_>>().join(",\n     "))
}

fn axes(list: &[ScrewAxis]) -> String {
    list.iter().map(|A| format!("    {}", flat(&A.twist().to_array()))).collect::<Vec<_>>().join(",\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_strings_of_python() {
        assert_eq!(literal("joint_1"), r#""joint_1""#);
        assert_eq!(literal("größe 関節 class"), r#""größe 関節 class""#);
        assert_eq!(literal("a\"b'c\\d"), r#""a\"b'c\\d""#);
        assert_eq!(literal("x\u{200b}y\n\u{1}\u{e0001}"), r#""x\u200by\u000a\u0001\U000e0001""#);
    }
}
