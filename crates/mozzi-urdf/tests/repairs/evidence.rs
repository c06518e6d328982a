//! The evidence for a repair: twins, shapes and names that count, and others that do not; its effect and its reason.

use super::{LIMIT, SOUND, arm, found};
use mozzi_urdf::fix::{apply, proposals};
use mozzi_urdf::{Settings, parse};

/// A robot of these links, each on a hinge of the base.
fn links(links: &[(&str, &str)]) -> String {
    let each = |(name, content): &(&str, &str)| {
        format!(
            "<link name=\"{name}\">{content}</link><joint name=\"j_{name}\" type=\"continuous\"><parent link=\"base\"/>\
             <child link=\"{name}\"/><axis xyz=\"0 1 0\"/></joint>\n"
        )
    };
    format!("<robot name=\"r\"><link name=\"base\"/>\n{}</robot>", links.iter().map(each).collect::<String>())
}

fn inertial(center: &str, mass: &str, [xx, xy, xz, yy, yz, zz]: [&str; 6]) -> String {
    format!(
        "<inertial><origin xyz=\"{center}\"/><mass value=\"{mass}\"/><inertia ixx=\"{xx}\" ixy=\"{xy}\" ixz=\"{xz}\" \
         iyy=\"{yy}\" iyz=\"{yz}\" izz=\"{zz}\"/></inertial>"
    )
}

/// The codes and changes of the proposals.
fn changes(text: &str) -> Vec<(&'static str, String)> {
    found(text).into_iter().map(|one| (one.code, one.change)).collect()
}

#[test]
fn a_number_in_a_name_is_no_evidence_of_an_effort() {
    let joint = |k: usize, effort: &str, velocity: &str| {
        format!(
            "<link name=\"link{k}\"/><joint name=\"joint{k}\" type=\"revolute\"><parent link=\"link{}\"/><child \
             link=\"link{k}\"/><axis xyz=\"0 0 1\"/><limit lower=\"-1\" upper=\"1\" effort=\"{effort}\" \
             velocity=\"{velocity}\"/></joint>",
            k - 1
        )
    };
    let robot = |joints: &[String]| format!("<robot name=\"r\"><link name=\"link0\"/>{}</robot>", joints.concat());
    let shoulder = [joint(1, "87", "2"), joint(2, "87", "2"), joint(3, "0", "3")];
    assert_eq!(changes(&robot(&shoulder)), []);
    // the other joints of the wrist
    let wrist = [&shoulder[..], &[joint(4, "12", "3"), joint(5, "12", "3")]].concat();
    assert_eq!(changes(&robot(&wrist)), [("zero_effort", "effort 0 → 12".to_string())]);
    // the other side is evidence, unless it is of another speed
    let slow = arm(SOUND, r#"lower="-1" upper="2" effort="0""#);
    assert_eq!(changes(&slow.replacen("velocity=\"3\"", "velocity=\"1\"", 1)), []);
}

#[test]
fn a_small_negative_moment_has_lost_its_sign() {
    for yz in ["1.9e-06", "0"] {
        let moments = ["0.00011487", "0", "0", "0.00011556", yz, "-2.2e-06"];
        let leg = inertial("0.0 -0.00836718 -0.11591877", "0.03117243", moments);
        assert_eq!(changes(&links(&[("leg", &leg)])), [("negative_moment", "izz -2.2e-6 → 2.2e-6".to_string())]);
    }
}

#[test]
fn products_of_the_other_side_are_mirrored() {
    let moments = |xy, yz| ["0.0005", xy, "3e-05", "0.0013", yz, "0.0012"];
    let right = inertial("0.07 -0.01 0.005", "0.46", moments("-2.6e-05", "-4e-06"));
    // −2.6e-5 + 2 m x y
    let left = inertial("0.07 0.01 0.005", "0.46", moments("0.000618", "4.2e-05"));
    let list = found(&links(&[("l_elbow", &left), ("r_elbow", &right)]));
    assert_eq!(list.len(), 1, "{list:#?}");
    assert_eq!(
        list[0].to_string().lines().next(),
        Some("link `l_elbow`: ixy 0.000618 → 2.6e-5, iyz 4.2e-5 → 4e-6 [mirrored_products]")
    );
    assert!(list[0].reason.contains("link `r_elbow`, its mirror image across y = 0"), "{}", list[0].reason);
    // without a twin: the term of the wrong sign is taken out
    let alone = changes(&links(&[("elbow", &left)]));
    assert_eq!(alone[0].0, "parallel_axis", "{alone:?}");
}

#[test]
fn a_twin_decides_where_the_nearest_would_be_near() {
    // the sum of two moments is 1 % below the third: a digit of iyy, which the twin has
    let moments = |yy| ["0.01", "0", "0", yy, "0", "0.0199"];
    let [left, right] = ["0.0098", "0.0105"].map(|yy| inertial("0 0 0.1", "1", moments(yy)));
    let alone = changes(&links(&[("l_arm", &left)]));
    assert_eq!(alone.iter().map(|(code, _)| *code).collect::<Vec<_>>(), ["nearest_inertia"], "{alone:?}");
    // no candidate agrees with this twin, either
    let both = changes(&links(&[("l_arm", &left), ("r_arm", &right)]));
    assert_eq!(both.iter().map(|(code, _)| *code).collect::<Vec<_>>(), ["nearest_inertia"], "{both:?}");
    // a product ten times too large, which breaks the inequality by little
    let [left, right] =
        ["0.006", "0.0006"].map(|xz| inertial("0 0.05 0.1", "1", ["0.02", "0", xz, "0.0204", "0", "0.0372"]));
    let said = changes(&links(&[("l_arm", &left), ("r_arm", &right)]));
    assert_eq!(said, [("power_of_ten", "ixz 0.006 → 0.0006".to_string())]);
}

#[test]
fn a_dummy_shape_judges_no_inertia() {
    let head = inertial("0 0 0", "0.5", ["0.004", "0", "0", "0.0041", "0", "0.0042"]);
    let ball = |radius| format!("{head}<collision><geometry><sphere radius=\"{radius}\"/></geometry></collision>");
    assert_eq!(changes(&links(&[("head", &ball("0.001"))])), []);
    assert_eq!(changes(&links(&[("head", &ball("0.1"))])), []);
}

#[test]
fn every_entry_of_the_mass_matrix_is_compared() {
    // two hinges about x and z through one point: ixz is in their common entry alone
    let bad = SOUND.replace("ixz=\"0\"", "ixz=\"0.5\"");
    let text = format!(
        "<robot name=\"r\"><link name=\"base\"/><link name=\"a\"/><link name=\"l_hand\"><inertial>{bad}</inertial></link>\
         <joint name=\"x\" type=\"continuous\"><parent link=\"base\"/><child link=\"a\"/><axis xyz=\"1 0 0\"/></joint>\
         <joint name=\"z\" type=\"continuous\"><parent link=\"a\"/><child link=\"l_hand\"/><axis xyz=\"0 0 1\"/></joint>\
         </robot>"
    );
    let list = found(&text);
    assert!(list.len() == 1 && list[0].effect.starts_with("M: entry (1, 2) "), "{list:#?}");
    let slide = text.replace("type=\"continuous\"", "type=\"prismatic\"");
    assert_eq!(found(&slide)[0].effect, "M does not change: it depends on none of these numbers");
    let fixed = text.replace("type=\"continuous\"", "type=\"fixed\"");
    assert_eq!(found(&fixed)[0].effect, "M does not change: no joint moves the link");
}

#[test]
fn the_worst_number_is_the_reason() {
    let rod = inertial("0 0 0", "1", ["0.083", "0", "0", "0.083", "0", "0.00167"]);
    let rod = format!("{rod}<collision><geometry><box size=\"0.01 0.01 1\"/></geometry></collision>");
    let list = found(&links(&[("rod", &rod)]));
    assert_eq!(list.iter().map(|one| &*one.change).collect::<Vec<_>>(), ["izz 0.00167 → 1.67e-5"], "{list:#?}");
    let expected = "izz is off by a factor of 10^2; as written, izz is about 100.2 times that of the link's shape, \
                    uniformly filled";
    assert_eq!(list[0].reason, expected);
    // two rods with one fault: each is the twin of the other, and their products are no reason
    for center in ["0 0 0", "0.001 0 0.01"] {
        let rod = rod.replace("0 0 0", center).replace("0.00167", "5e-7");
        let both = changes(&links(&[("l_rod", &rod), ("r_rod", &rod)]));
        let expected = ("power_of_ten", "izz 5e-7 → 5e-6".to_string());
        assert_eq!(both, [expected.clone(), expected], "{center}");
    }
    let away = found(&arm(&SOUND.replace("0.02 0 0.15", "20 0 150"), LIMIT));
    assert!(away[0].reason.contains("the centre of mass is 149.7 m outside of the link's shape"), "{}", away[0].reason);
}

#[test]
fn what_is_left_open_is_counted() {
    let notes = |name: &str, text: &str| proposals(name, text, None, &Settings::default()).unwrap().notes();
    let text = arm(SOUND, LIMIT);
    assert_eq!(notes("arm.urdf", &text), []);
    // a limit is missing, which nothing can propose
    let open = text.replacen(" effort=\"30\" velocity=\"3\"", "", 1);
    assert!(parse("arm.urdf", &open).unwrap().warnings.len() == 2);
    let said = "2 warnings of `mozzi check` have no proposal".to_string();
    assert_eq!(notes("arm.urdf", &open), [("without_proposal", said)]);
    let mesh = |file: &str| text.replacen("<box size=\"0.1 0.2 0.3\"/>", &format!("<mesh filename=\"{file}\"/>"), 1);
    let said = notes("/nowhere/arm.urdf", &mesh("a.dae"));
    assert_eq!((said.len(), said[0].0), (1, "unread_shapes"), "{said:?}");
    let expected = "the shapes of 1 link were not read: mesh a.dae was not found: there is no file /nowhere/a.dae";
    assert_eq!(said[0].1, expected);
}

#[test]
#[cfg(unix)]
fn meshes_of_other_formats_and_outside_of_the_package_are_counted() {
    let top = std::env::temp_dir().join(format!("mozzi-repairs-{}", std::process::id()));
    let _ = std::fs::remove_dir_all(&top);
    std::fs::create_dir_all(top.join("robot")).unwrap();
    std::fs::create_dir_all(top.join("source")).unwrap();
    let cube = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n";
    std::fs::write(top.join("source/a.obj"), cube).unwrap();
    std::fs::write(top.join("robot/a.dae"), "<COLLADA/>").unwrap();
    std::os::unix::fs::symlink(top.join("source"), top.join("robot/meshes")).unwrap();
    let robot = top.join("robot/arm.urdf").to_string_lossy().into_owned();
    let text = |file: &str| {
        arm(SOUND, LIMIT).replacen("<box size=\"0.1 0.2 0.3\"/>", &format!("<mesh filename=\"{file}\"/>"), 1)
    };
    let notes = |file: &str, root: Option<&std::path::Path>| {
        let found = proposals(&robot, &text(file), root, &Settings::default()).unwrap();
        found.unread.into_values().collect::<Vec<_>>()
    };
    let dae = notes("a.dae", None);
    assert!(dae[0].contains("mesh a.dae: surfaces of `dae` files are not read"), "{dae:?}");
    let outside = notes("meshes/a.obj", None);
    assert!(outside[0].contains("outside of the robot's folder") && outside[0].contains("--mesh-root"), "{outside:?}");
    assert!(notes("meshes/a.obj", Some(&top)).is_empty());
    std::fs::remove_dir_all(&top).unwrap();
}

#[test]
fn windows_lines_stay() {
    let text = arm(&SOUND.replace("iyy=\"0.05\"", "iyy=\"-0.05\""), LIMIT).replace('\n', "\r\n");
    let repaired = apply(&text, &found(&text));
    assert_eq!(repaired, arm(SOUND, LIMIT).replace('\n', "\r\n"));
}

#[test]
fn exact_twins_refute_a_possible_inertia() {
    let good = ["0.003", "0", "-0.00014", "0.003", "0", "0.00003"];
    let at = |y: &str, moments| inertial(&format!("0.002 {y} -0.1"), "0.2", moments);
    // m (‖c‖² E − c cᵀ) more
    let about_origin = ["0.005", "0", "-0.0001", "0.0050008", "0", "0.0000308"];
    let robot = links(&[("L_calf", &at("0", good)), ("R_calf", &at("0", about_origin))]);
    let list = found(&robot);
    assert_eq!(list.iter().map(|one| one.code).collect::<Vec<_>>(), ["about_origin"], "{list:#?}");
    assert!(list[0].reason.ends_with("without that they are those of `L_calf`"), "{}", list[0].reason);
    assert!(list[0].change.contains("ixz -0.0001 → -0.00014"), "{}", list[0].change);
    // of two links with other products either may be wrong; three decide
    let wrong = ["0.003", "0", "-0.00006", "0.003", "0", "0.00003"];
    let pair = [("L1", at("0", good)), ("R1", at("0", wrong))];
    assert_eq!(changes(&links(&pair.each_ref().map(|(name, text)| (*name, text.as_str())))), []);
    let legs = [("L1", at("0", good)), ("R1", at("0", wrong)), ("R2", at("0", good)), ("L2", at("0", good))];
    let text = links(&legs.each_ref().map(|(name, text)| (*name, text.as_str())));
    assert_eq!(changes(&text), [("parallel_axis", "ixz -6e-5 → -0.00014".to_string())]);
}
