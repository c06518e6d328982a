//! xacro files are programs that produce a URDF. Detects such files. Unexpanded xacro in a text is refused, with the
//! command that expands it.

use crate::report::finding::Finding;
use crate::text::dialect::Dialect;
use crate::urdf::vocabulary::shown;
use roxmltree::{Document, Node};
use std::ops::Range;

/// Elements whose attributes the URDF reader uses. Expressions in other elements, such as `$(find …)` in a mesh's name,
/// do not affect it.
const READ: [&str; 13] = [
    "robot", "link", "inertial", "mass", "inertia", "origin", "joint", "parent", "child", "axis", "limit", "dynamics",
    "mimic",
];

/// The beginnings of an expression. A `$(` alone is not an expression: it may occur in a name.
const EXPRESSIONS: [&str; 9] =
    ["${", "$(arg ", "$(find ", "$(env ", "$(optenv ", "$(eval ", "$(anon ", "$(dirname)", "$(cwd)"];

/// The end of messages: the expected file.
const EXPECTED: &str = "expected a file that xacro has expanded";

/// The most arguments listed in a suggested command.
const MOST_ARGUMENTS: usize = 8;

/// True if the text contains an expression that xacro evaluates.
pub(crate) fn has_expression(text: &str) -> bool {
    EXPRESSIONS.iter().any(|start| text.contains(start))
}

/// The first part of a text that xacro has to expand, with the command that does it. A declaration of its namespace
/// does not count: xacro leaves it in its output.
pub(crate) fn refuse(document: &Document, file: &str, dialect: Dialect) -> Option<Finding> {
    let (span, message) = document.root().descendants().filter(Node::is_element).find_map(|node| {
        let span = name(node);
        if is_xacro(node) {
            let written = shown(&document.input_text()[span.clone()]);
            return Some((span, format!("<{written}> is a xacro element, {EXPECTED}")));
        }
        // in MJCF any word may be a value, so only numbers are checked, when they are read
        let expression = node.attributes().find(|attribute| has_expression(attribute.value()));
        let attribute = expression.filter(|_| dialect == Dialect::Urdf && is_read(node))?;
        let (element, value) = (node.tag_name().name(), shown(attribute.value()));
        let message = format!("{element}: {}: is `{value}`, a xacro expression, {EXPECTED}", attribute.name());
        Some((attribute.range_value(), message))
    })?;
    Some(Finding::error("xacro", span, message).help(command(document, file, dialect)))
}

/// The place of the name in the start tag.
fn name(node: Node) -> Range<usize> {
    let start = node.range().start + 1;
    let rest = node.document().input_text().get(start..).unwrap_or_default();
    let ends = |c: char| c.is_ascii_whitespace() || matches!(c, '/' | '>');
    start..start + rest.find(ends).unwrap_or(rest.len())
}

/// Checks the prefix, as xacro itself does, or the namespace.
fn is_xacro(node: Node) -> bool {
    node.document().input_text()[name(node)].starts_with("xacro:")
        || node.tag_name().namespace().is_some_and(|space| space.ends_with("/xacro"))
}

fn is_read(node: Node) -> bool {
    node.ancestors().filter(Node::is_element).all(|ancestor| READ.contains(&ancestor.tag_name().name()))
}

/// How to expand the file.
fn command(document: &Document, file: &str, dialect: Dialect) -> String {
    let (input, output) = (quoted(file), quoted(&expanded(file, dialect)));
    let values: String = arguments(document).map(|name| format!(" {name}:=VALUE")).collect();
    format!(
        "`mozzi xacro {input}{values} -o {output}` expands it; it is expanded at once if its name ends in .xacro, or if \
         its root declares xmlns:xacro=\"http://www.ros.org/wiki/xacro\""
    )
}

/// True if the file must be expanded before it is read: its name ends in `.xacro`, or `parse` finds it
/// [unexpanded](is_unexpanded).
pub(crate) fn is_program(text: &str, file: &str, parse: impl FnOnce() -> Option<bool>) -> bool {
    let is_named = file.ends_with(".xacro") && text.contains('<');
    is_named || text.contains("xacro") && parse() == Some(true)
}

/// True if the root declares xacro's namespace and something is left to expand.
pub(crate) fn is_unexpanded(document: &Document, dialect: Dialect) -> bool {
    let declares = document
        .root_element()
        .namespaces()
        .any(|space| space.name() == Some("xacro") || space.uri().ends_with("/xacro"));
    declares && refuse(document, "", dialect).is_some()
}

/// The names of arguments that have no default.
fn arguments<'d>(document: &'d Document) -> impl Iterator<Item = &'d str> {
    let is_plain = |name: &&str| name.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_');
    document
        .root()
        .descendants()
        .filter(|node| node.tag_name().name() == "arg" && is_xacro(*node) && !node.has_attribute("default"))
        .filter_map(|node| node.attribute("name"))
        .filter(is_plain)
        .take(MOST_ARGUMENTS)
}

/// The output file: never the input file.
fn expanded(file: &str, dialect: Dialect) -> String {
    let ending = match dialect {
        Dialect::Urdf => ".urdf",
        Dialect::Mjcf => ".xml",
        Dialect::Sdf => ".sdf",
    };
    match (file.strip_suffix(".xacro"), file.strip_suffix(ending)) {
        (Some(stem), _) => format!("{}{ending}", stem.strip_suffix(ending).unwrap_or(stem)),
        (None, Some(stem)) => format!("{stem}-expanded{ending}"),
        (None, None) => format!("{file}-expanded{ending}"),
    }
}

/// A file's name, quoted for a shell.
fn quoted(file: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "._-+/:@%,=~".contains(c);
    let file = if file.starts_with(['-', '~']) { format!("./{file}") } else { file.to_string() };
    match file.chars().all(is_plain) && !file.is_empty() {
        true => file,
        false => format!("'{}'", file.replace('\'', r"'\''").replace(char::is_control, "?")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The message about a text, and its remedy.
    fn refused(file: &str, text: &str) -> Option<(String, String)> {
        let document = Document::parse(text).expect("well-formed");
        let finding = refuse(&document, file, Dialect::of(text))?;
        Some((finding.message, finding.help.expect("a command")))
    }

    fn help(file: &str, text: &str) -> String {
        refused(file, text).expect("refused").1
    }

    const MACRO: &str = "<robot xmlns:xacro='http://www.ros.org/wiki/xacro'><xacro:arm/></robot>";

    #[test]
    fn what_is_expanded_is_read() {
        for text in [
            "<robot name='r' xmlns:xacro='http://www.ros.org/wiki/xacro'><!-- ${a} <xacro:arm/> --><link name='a'/></robot>",
            "<robot><link name='a'><visual><geometry><mesh filename='$(find p)/a.stl'/></geometry></visual></link></robot>",
            "<robot><gazebo><plugin ns='${a}'/></gazebo></robot>",
            "<robot><link name='costs $ (5)'/></robot>",
            "<mujoco><asset><mesh file='${a}'/></asset></mujoco>",
        ] {
            assert_eq!(refused("a.xacro", text), None, "{text}");
        }
    }

    #[test]
    fn what_is_not_expanded_is_named() {
        for (text, message) in [
            (MACRO, "<xacro:arm> is a xacro element, expected a file that xacro has expanded"),
            (
                "<robot xmlns:x='http://ros.org/wiki/xacro'><gazebo><x:if value='1'/></gazebo></robot>",
                "<x:if> is a xacro element, expected a file that xacro has expanded",
            ),
            (
                "<robot xmlns:xacro='http://example.org/#interface'><xacro:arm/></robot>",
                "<xacro:arm> is a xacro element, expected a file that xacro has expanded",
            ),
            (
                "<robot><link name='${side}_arm'/></robot>",
                "link: name: is `${side}_arm`, a xacro expression, expected a file that xacro has expanded",
            ),
            (
                "<robot><joint><child link='$(arg side)_arm'/></joint></robot>",
                "child: link: is `$(arg side)_arm`, a xacro expression, expected a file that xacro has expanded",
            ),
            (
                "<mujoco xmlns:xacro='http://www.ros.org/wiki/xacro'><xacro:arm/></mujoco>",
                "<xacro:arm> is a xacro element, expected a file that xacro has expanded",
            ),
        ] {
            assert_eq!(refused("a.xacro", text).map(|(found, _)| found).as_deref(), Some(message), "{text}");
        }
    }

    #[test]
    fn commands() {
        let plain = |input: &str, output: &str| format!("`mozzi xacro {input} -o {output}` expands it");
        let begins = |file: &str, text: &str, start: &str| {
            let help = help(file, text);
            assert!(help.starts_with(start), "{help}");
        };
        for (file, input, output) in [
            ("arm.xacro", "arm.xacro", "arm.urdf"),
            ("robots/arm.urdf.xacro", "robots/arm.urdf.xacro", "robots/arm.urdf"),
            ("arm.urdf", "arm.urdf", "arm-expanded.urdf"),
            ("arm.xml", "arm.xml", "arm.xml-expanded.urdf"),
            ("my arm's.xacro", r"'my arm'\''s.xacro'", r"'my arm'\''s.urdf'"),
            ("-arm.xacro", "./-arm.xacro", "./-arm.urdf"),
            ("a\nb.xacro", "'a?b.xacro'", "'a?b.urdf'"),
        ] {
            begins(file, MACRO, &plain(input, output));
        }
        let model = "<mujoco xmlns:xacro='http://www.ros.org/wiki/xacro'><xacro:arm/></mujoco>";
        begins("arm.xml.xacro", model, &plain("arm.xml.xacro", "arm.xml"));
        let arguments = "<robot xmlns:xacro='http://www.ros.org/wiki/xacro'><xacro:arg name='side'/>\
            <xacro:arg name='gripper' default='none'/><xacro:arg name='$(rm)'/><link name='a'/></robot>";
        begins("arm.xacro", arguments, &plain("arm.xacro side:=VALUE", "arm.urdf"));
    }
}
