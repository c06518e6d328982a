//! The edits that mend the example of each code: with them, its file is the good example of the code's page.

/// A code with its language, and the edits of its example: each text occurs once and is replaced by the other. `…` in
/// it is anything up to the next occurrence of what follows; an empty text is the whole file.
#[rustfmt::skip]
const MENDS: &[(&str, &[(&str, &str)])] = &[
    ("urdf::circular_mimic", &[("    <mimic joint=\"elbow\"/>\n", "")]),
    ("urdf::continuous_limits", &[("type=\"continuous\"", "type=\"revolute\"")]),
    ("urdf::contradictory_attribute", &[(" iyx=\"0.001\"", "")]),
    ("urdf::contradictory_limits", &[("offset=\"5\"", "offset=\"0\"")]),
    ("urdf::decimal_comma", &[("0,2", "0.2")]),
    ("urdf::degrees", &[("lower=\"-90\" upper=\"90\"", "lower=\"-1.5708\" upper=\"1.5708\"")]),
    ("urdf::document_type", &[("<!DOCTYPE robot SYSTEM \"robot.dtd\">\n", "")]),
    ("urdf::duplicate_element", &[("      <mass value=\"3\"/>\n", "")]),
    ("urdf::duplicate_name", &[("name=\"shoulder\" type=\"revolute\">\n    <parent link=\"upper\"/>",
        "name=\"elbow\" type=\"revolute\">\n    <parent link=\"upper\"/>")]),
    ("urdf::empty", &[("", "<robot name=\"arm\">\n  <link name=\"base\"/>\n</robot>\n")]),
    ("urdf::empty_name", &[("  <link name=\"\"/>\n", "  <link name=\"tool\"/>\n  <joint name=\"mount\" type=\"fixed\">\
        <parent link=\"upper\"/><child link=\"tool\"/></joint>\n")]),
    ("urdf::fixed_mimic", &[("name=\"elbow\" type=\"fixed\"", "name=\"elbow\" type=\"revolute\"")]),
    ("urdf::fixed_source", &[("name=\"shoulder\" type=\"fixed\"", "name=\"shoulder\" type=\"revolute\"")]),
    ("urdf::ignored_force", &[("  <drake:linear_spring_damper>…</drake:linear_spring_damper>\n", "")]),
    ("urdf::ignored_limit", &[(" jerk=\"60\"", "")]),
    ("urdf::ignored_property", &[("    <limit lower=\"-1.5\" upper=\"1.5\" effort=\"50\" velocity=\"2\"/>\n", "")]),
    ("urdf::ignored_quaternion", &[("<robot name=\"arm\">", "<robot name=\"arm\" version=\"1.1\">")]),
    ("urdf::implausible_inertia", &[("ixx=\"30000\"", "ixx=\"0.03\""), ("iyy=\"30000\"", "iyy=\"0.03\""),
        ("izz=\"2000\"", "izz=\"0.002\"")]),
    ("urdf::implausible_length", &[("0 0 333", "0 0 0.333")]),
    ("urdf::implausible_mass", &[("value=\"2000\"", "value=\"2\"")]),
    ("urdf::indefinite_inertia", &[("-0.002", "0.002")]),
    ("urdf::late_declaration", &[("\n<?xml", "<?xml")]),
    ("urdf::long_name", &[("bbb…\"/>", "base\"/>")]),
    ("urdf::loop_closure", &[
        ("<robot name=\"arm\">", "<robot name=\"arm\" xmlns:drake=\"http://drake.mit.edu\">"),
        ("  <joint name=\"rod\" type=\"revolute\">…</joint>\n", "  <drake:ball_constraint>\n    \
        <drake:ball_constraint_body_A name=\"base\"/>\n    <drake:ball_constraint_body_B name=\"lower\"/>\n    \
        <drake:ball_constraint_p_AP value=\"0 0 0.9\"/>\n    <drake:ball_constraint_p_BQ value=\"0 0 0.4\"/>\n  \
        </drake:ball_constraint>\n"),
    ]),
    ("urdf::massless_leaf", &[("<link name=\"upper\"/>", "<link name=\"upper\">\n    <inertial>\n      \
        <origin xyz=\"0 0 0.2\"/>\n      <mass value=\"2\"/>\n      \
        <inertia ixx=\"0.03\" ixy=\"0\" ixz=\"0\" iyy=\"0.03\" iyz=\"0\" izz=\"0.002\"/>\n    </inertial>\n  </link>")]),
    ("urdf::mimic_of_several_axes", &[("type=\"floating\"", "type=\"continuous\"")]),
    ("urdf::missing_attribute", &[("iyy=\"0.03\" izz", "iyy=\"0.03\" iyz=\"0\" izz")]),
    ("urdf::missing_element", &[("<mass value=\"2\"/>\n", "<mass value=\"2\"/>\n      \
        <inertia ixx=\"0.03\" ixy=\"0\" ixz=\"0\" iyy=\"0.03\" iyz=\"0\" izz=\"0.002\"/>\n")]),
    ("urdf::missing_limit", &[("<axis xyz=\"0 1 0\"/>\n",
        "<axis xyz=\"0 1 0\"/>\n    <limit lower=\"-1.5\" upper=\"1.5\" effort=\"50\" velocity=\"2\"/>\n")]),
    ("urdf::misspelled_attribute", &[("Lower", "lower")]),
    ("urdf::misspelled_element", &[("<intertial>", "<inertial>"), ("</intertial>", "</inertial>")]),
    ("urdf::negative_friction", &[("damping=\"-0.1\"", "damping=\"0.1\"")]),
    ("urdf::negative_limit", &[("velocity=\"-2\"", "velocity=\"2\"")]),
    ("urdf::negative_mass", &[("value=\"-2\"", "value=\"2\"")]),
    ("urdf::no_base", &[("<robot name=\"arm\">\n", "<robot name=\"arm\">\n  <link name=\"base\"/>\n"),
        ("<parent link=\"lower\"/>", "<parent link=\"base\"/>")]),
    ("urdf::no_links", &[("<robot name=\"arm\">\n", "<robot name=\"arm\">\n  <link name=\"base\"/>\n")]),
    ("urdf::non_unit_axis", &[("0 2 0", "0 1 0")]),
    ("urdf::non_unit_quaternion", &[("1 1 1 1", "0.5 0.5 0.5 0.5")]),
    ("urdf::not_a_number", &[("value=\"two\"", "value=\"2\"")]),
    ("urdf::not_finite", &[("value=\"NaN\"", "value=\"2\"")]),
    ("urdf::not_utf8", &[("\u{fffd}", "à")]),
    ("urdf::redundant_attribute", &[(" k_velocity=\"10\"", "")]),
    ("urdf::repaired_inertia", &[("izz=\"0.2\"", "izz=\"0.002\"")]),
    ("urdf::reversed_limits", &[("lower=\"1.5\" upper=\"-1.5\"", "lower=\"-1.5\" upper=\"1.5\"")]),
    ("urdf::self_constraint", &[("body_A name=\"upper\"", "body_A name=\"base\""), ("p_AP value=\"0 0 0\"", "p_AP value=\"0 0 0.6\"")]),
    ("urdf::self_parent", &[("<parent link=\"lower\"/>", "<parent link=\"upper\"/>")]),
    ("urdf::several_bases", &[("izz=\"0.001\"/>\n    </inertial>\n  </link>\n",
        "izz=\"0.001\"/>\n    </inertial>\n  </link>\n  <joint name=\"elbow\" type=\"revolute\">\n    \
        <parent link=\"upper\"/>\n    <child link=\"lower\"/>\n    <origin xyz=\"0 0 0.4\"/>\n    <axis xyz=\"0 1 0\"/>\n    \
        <limit lower=\"-1.5\" upper=\"1.5\" effort=\"50\" velocity=\"2\"/>\n  </joint>\n")]),
    ("urdf::several_orientations", &[(" quat_xyzw=\"0 0 0.7071068 0.7071068\"", "")]),
    ("urdf::stray_text", &[(" this is the base", " <!-- this is the base -->")]),
    ("urdf::syntax", &[("    </inertial>\n  <joint", "    </inertial>\n  </link>\n  <joint")]),
    ("urdf::too_deep", &[("<a>…\n", "<link name=\"base\"/>\n")]),
    ("urdf::too_large", &[("", "<robot name=\"arm\">\n  <link name=\"base\"/>\n</robot>\n")]),
    ("urdf::too_large_number", &[("2e999", "2")]),
    ("urdf::too_many_attributes", &[("<link a0…/>", "<link name=\"base\"/>")]),
    ("urdf::too_many_namespaces", &[(" xmlns:n1=…>", ">")]),
    ("urdf::turned_inertia", &[("iyy=\"0.02\" iyz=\"0\" izz=\"0.036\"", "iyy=\"0.036\" iyz=\"0\" izz=\"0.02\"")]),
    ("urdf::undeclared_prefix", &[("<robot name=\"arm\">", "<robot name=\"arm\" xmlns:drake=\"http://drake.mit.edu\">")]),
    ("urdf::unknown_attribute", &[(" colour=\"red\"", "")]),
    ("urdf::unknown_element", &[("><battery/></link>", "/>")]),
    ("urdf::unknown_frame", &[("name=\"uper\"", "name=\"upper\"")]),
    ("urdf::unknown_joint", &[("sholder", "shoulder")]),
    ("urdf::unknown_joint_type", &[("revolving", "revolute")]),
    ("urdf::unknown_link", &[("link=\"bse\"", "link=\"base\"")]),
    ("urdf::unphysical_inertia", &[("izz=\"0.2\"", "izz=\"0.002\"")]),
    ("urdf::unreachable_link", &[("<parent link=\"lower\"/>", "<parent link=\"base\"/>")]),
    ("urdf::unsupported_constraint", &[
        ("<robot name=\"arm\">", "<robot name=\"arm\" xmlns:drake=\"http://drake.mit.edu\">"),
        ("  <constraint name=\"rod\" type=\"ball\">…</constraint>\n", "  <drake:ball_constraint>\n    \
        <drake:ball_constraint_body_A name=\"base\"/>\n    <drake:ball_constraint_body_B name=\"upper\"/>\n    \
        <drake:ball_constraint_p_AP value=\"0 0 0.5\"/>\n    <drake:ball_constraint_p_BQ value=\"0 0 0.4\"/>\n  \
        </drake:ball_constraint>\n"),
    ]),
    ("urdf::unsupported_joint", &[("  <joint name=\"shoulder\" type=\"ball\">…</joint>\n",
        "  <link name=\"yaw\"/>\n  <link name=\"pitch\"/>\n  <joint name=\"shoulder_z\" type=\"continuous\">\n    \
        <parent link=\"base\"/>\n    <child link=\"yaw\"/>\n    <origin xyz=\"0 0 0.1\"/>\n    <axis xyz=\"0 0 1\"/>\n  \
        </joint>\n  <joint name=\"shoulder_y\" type=\"continuous\">\n    <parent link=\"yaw\"/>\n    \
        <child link=\"pitch\"/>\n    <axis xyz=\"0 1 0\"/>\n  </joint>\n  \
        <joint name=\"shoulder_x\" type=\"continuous\">\n    <parent link=\"pitch\"/>\n    \
        <child link=\"upper\"/>\n    <axis xyz=\"1 0 0\"/>\n  </joint>\n")]),
    ("urdf::unsupported_version", &[("version=\"2\"", "version=\"1.0\"")]),
    ("urdf::wrong_count", &[("xyz=\"0 0.2\"", "xyz=\"0 0 0.2\"")]),
    ("urdf::wrong_root", &[("", "<robot name=\"arm\">\n  <link name=\"base\"/>\n</robot>\n")]),
    ("urdf::xacro", &[("  <link name=\"base\"/>\n", "  <xacro:property name=\"mass\" value=\"2\"/>\n  <link name=\"base\"/>\n")]),
    ("urdf::xacro_warning", &[(" unit=\"kg\"", "")]),
    ("urdf::zero_axis", &[("<axis xyz=\"0 0 0\"/>", "<axis xyz=\"0 1 0\"/>")]),
    ("urdf::zero_limits", &[("lower=\"0\" upper=\"0\" effort=\"0\" velocity=\"0\"",
        "lower=\"-1.5\" upper=\"1.5\" effort=\"50\" velocity=\"2\"")]),
    ("mjcf::actuator_armature", &[("site=\"tip\"", "joint=\"elbow\"")]),
    ("mjcf::circular_mimic", &[("    <joint joint1=\"elbow\" joint2=\"shoulder\"/>\n", "")]),
    ("mjcf::constraint_of_several_axes", &[("type=\"ball\"", "axis=\"0 1 0\"")]),
    ("mjcf::contradictory_key", &[("0.5 -0.9", "0.5 -1")]),
    ("mjcf::contradictory_limits", &[("polycoef=\"2 1\"", "polycoef=\"0 1\"")]),
    ("mjcf::duplicate_name", &[("name=\"upper\" pos=\"0 0 0.4\"", "name=\"lower\" pos=\"0 0 0.4\"")]),
    ("mjcf::global_coordinates", &[("global", "local")]),
    ("mjcf::ignored_attribute", &[(" rgba=\"1 0 0 1\" friction=\"0.8\"", "")]),
    ("mjcf::ignored_element", &[("  <actuator><motor name=\"drive\" joint=\"elbow\"/></actuator>\n", "")]),
    ("mjcf::ignored_force", &[("20 0 3", "20")]),
    ("mjcf::ignored_limit", &[(" limited=\"true\" range=\"-0.3 2\"", "")]),
    ("mjcf::ignored_mesh", &[("type=\"mesh\" mesh=\"table\"", "type=\"box\" size=\"0.4 0.6 0.02\"")]),
    ("mjcf::include", &[("no_such_file", "options")]),
    ("mjcf::indefinite_inertia", &[("-0.02", "0.02")]),
    ("mjcf::key_quaternion", &[("1 1 0 0", "0.7071068 0.7071068 0 0")]),
    ("mjcf::long_value", &[("axis=\"0 0 0…\"", "axis=\"0 0 1\"")]),
    ("mjcf::massless_leaf", &[(" mass=\"0\"", "")]),
    ("mjcf::mesh_inertia", &[("  <worldbody>\n",
        "  <asset><mesh name=\"hull\" vertex=\"0 0 0 0.1 0 0 0 0.1 0 0 0 0.3\"/></asset>\n  <worldbody>\n")]),
    ("mjcf::mimic_of_several_axes", &[("type=\"ball\"", "axis=\"0 1 0\"")]),
    ("mjcf::misplaced_joint", &[("    <joint name=\"rail\" type=\"slide\"/>\n", ""),
        ("      <joint name=\"shoulder\"", "      <joint name=\"rail\" type=\"slide\"/>\n      <joint name=\"shoulder\"")]),
    ("mjcf::missing_attribute", &[("limited=\"true\"", "limited=\"true\" range=\"-90 90\"")]),
    ("mjcf::missing_size", &[("0.1 0.2", "0.1 0.2 0.3")]),
    ("mjcf::negative_mass", &[("mass=\"-1\"", "mass=\"1\"")]),
    ("mjcf::no_mass", &[("<worldbody/>",
        "<worldbody>\n    <body name=\"ball\"><freejoint/><geom size=\"0.1\"/></body>\n  </worldbody>")]),
    ("mjcf::renamed_site", &[("site name=\"lower\"", "site name=\"tip\"")]),
    ("mjcf::repeated_include", &[("  <include file=\"parts/options.xml\"/>\n  <include", "  <include")]),
    ("mjcf::reversed_limits", &[("90 -90", "-90 90")]),
    ("mjcf::rotor_of_several_axes", &[("type=\"ball\"", "axis=\"0 1 0\"")]),
    ("mjcf::several_orientations", &[(" quat=\"1 0 0 0\"", "")]),
    ("mjcf::too_deep", &[("<body>…</worldbody>",
        "<body><joint/><geom size=\"0.1\"/></body></worldbody>")]),
    ("mjcf::too_many_constraints", &[("    <weld…  </equality>", "    <weld body1=\"upper\" body2=\"lower\"/>\n  </equality>")]),
    ("mjcf::too_many_keys", &[("<key/>\n…</keyframe>", "<key/>\n</keyframe>")]),
    ("mjcf::unclear_limit", &[("range=\"-90 90\"", "limited=\"true\" range=\"-90 90\"")]),
    ("mjcf::unknown_class", &[("  <worldbody>\n",
        "  <default>\n    <default class=\"arm\"><joint damping=\"0.1\"/></default>\n  </default>\n  <worldbody>\n")]),
    ("mjcf::unknown_joint", &[("sholder", "shoulder")]),
    ("mjcf::unknown_word", &[("\"hing\"", "\"hinge\"")]),
    ("mjcf::unsupported_attribute", &[("name=\"wedge\" vertex", "name=\"wedge\" inertia=\"shell\" vertex"),
        (" shellinertia=\"true\"", "")]),
    ("mjcf::unsupported_element", &[("<composite type=\"cable\" count=\"9 1 1\"/>",
        "<body name=\"left_hand\"><geom size=\"0.04\"/></body>")]),
    ("mjcf::unsupported_equality", &[("<tendon tendon1=\"flexor\"/>",
        "<joint joint1=\"elbow\" joint2=\"shoulder\" polycoef=\"0 -2\"/>")]),
    ("mjcf::unsupported_joint", &[("<freejoint name=\"elbow\"/>",
        "<joint name=\"x\" type=\"slide\" axis=\"1 0 0\"/>\n        <joint name=\"y\" type=\"slide\" axis=\"0 1 0\"/>\n        \
        <joint name=\"z\" type=\"slide\" axis=\"0 0 1\"/>\n        <joint name=\"elbow\" type=\"ball\"/>")]),
    ("mjcf::unsupported_tendon", &[(" stiffness=\"100\"", "")]),
    ("mjcf::wrong_root", &[("", "<mujoco model=\"arm\">\n  <include file=\"parts/options.xml\"/>\n  <worldbody>\n    \
        <body name=\"ball\"><freejoint/><geom size=\"0.1\"/></body>\n  </worldbody>\n</mujoco>\n")]),
    ("mjcf::zero_axis", &[("axis=\"0 0 0\"", "axis=\"0 1 0\"")]),
    ("sdf::circular_frames", &[("relative_to=\"f\"", "relative_to=\"b\"")]),
    ("sdf::contradictory_pitch", &[("<thread_pitch>20</thread_pitch>", "")]),
    ("sdf::default_inertia", &[("<link name=\"b\"/>",
        "<link name=\"b\"><inertial><mass>0.02</mass><inertia><ixx>1e-5</ixx><iyy>1e-5</iyy><izz>2e-6</izz></inertia></inertial></link>")]),
    ("sdf::duplicate_name", &[("<joint name=\"b\"", "<joint name=\"j\"")]),
    ("sdf::ignored_element", &[("    <model name=\"floor\"><static>true</static><link name=\"l\"/></model>\n", "")]),
    ("sdf::ignored_plugin", &[("    <plugin…</plugin>\n", "")]),
    ("sdf::include", &[("<include><uri>model://nowhere</uri></include>", "<include><uri>parts/tool.sdf</uri></include>\n    \
        <joint name=\"mount\" type=\"fixed\"><parent>b</parent><child>tool::tool</child></joint>")]),
    ("sdf::inertia_from_shapes", &[("<inertial auto=\"true\"/>", "<inertial><mass>1</mass><inertia><ixx>0.17</ixx>\
        <iyy>0.17</iyy><izz>0.17</izz></inertia></inertial>")]),
    ("sdf::misplaced_joint", &[("<parent>a</parent><child>world</child>", "<parent>world</parent><child>a</child>")]),
    ("sdf::no_model", &[("  <world name=\"w\"/>\n", "  <model name=\"arm\">\n    <link name=\"a\"><inertial><mass>1</mass>\
        <inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia></inertial></link>\n  </model>\n")]),
    ("sdf::static_model", &[("<static>true</static>", ""), ("</link></model>\n", "</link></model>\n    \
        <joint name=\"mount\" type=\"fixed\"><parent>a</parent><child>rack::l</child></joint>\n")]),
    ("sdf::unknown_frame", &[("\"elbow\"", "\"b\"")]),
    ("sdf::unknown_joint_type", &[("\"hinge\"", "\"revolute\"")]),
    ("sdf::unsupported_joint", &[("\"gearbox\"", "\"revolute\"")]),
    ("sdf::unsupported_version", &[("version=\"1.3\"", "version=\"1.11\"")]),
];

/// The mended text of the example of a code such as `urdf::zero_axis`.
pub fn mended(code: &str, text: &str) -> String {
    let (_, edits) = MENDS.iter().find(|(known, _)| *known == code).unwrap_or_else(|| panic!("{code} has no edits"));
    assert!(!edits.is_empty(), "{code}: no edits");
    edits.iter().fold(text.to_string(), |text, (from, to)| {
        if from.is_empty() {
            return (*to).to_string();
        }
        let (start, end) = from.split_once('…').unwrap_or((from, ""));
        let at = text.find(start).unwrap_or_else(|| panic!("{code}: `{start}` is not in its example"));
        let rest = at + start.len();
        assert!(from.contains('…') || !text[rest..].contains(start), "{code}: `{start}` is twice in its example");
        let length = text[rest..].find(end).unwrap_or_else(|| panic!("{code}: `{end}` is not in its example"));
        let end = rest + if end.is_empty() { 0 } else { length + end.len() };
        format!("{}{to}{}", &text[..at], &text[end..])
    })
}

/// All codes that have edits, with their languages.
pub fn codes() -> impl Iterator<Item = &'static str> {
    MENDS.iter().map(|(code, _)| *code)
}
