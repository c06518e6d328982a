//! Fourteen ways in which a robot's physics got lost in public, each as a pair of small files: the comparison names the
//! cause of each.
use crate::{compare, robot};
use mozzi_report::compare::files::{RobotFile, compare_files};

/// Before, after, and words of each cause.
const FAULTS: [(&str, &str, &[&str]); 25] = [
    (
        "before.urdf",
        "01_damping.urdf",
        &[
            "damping of `shoulder` is dropped",
            "friction of `shoulder` is dropped",
            "damping of `elbow` is dropped",
            "friction of `elbow` is dropped",
        ],
    ),
    (
        "before.urdf",
        "02_not_rotated.urdf",
        &["02_not_rotated.urdf's inertia of `upper` is not rotated by its inertial's orientation"],
    ),
    (
        "before.urdf",
        "03_mass_of_shapes_added.urdf",
        &["adds the mass of the shapes of `upper`, of 1000 kg/m³, to the given one: 8 kg instead of 2 kg"],
    ),
    (
        "before.urdf",
        "04_mass_of_shapes.urdf",
        &["computes the inertia of `upper` from its shapes, of 1000 kg/m³: 6 kg instead of the given 2 kg"],
    ),
    (
        "before.urdf",
        "05_merged_without_rotation.urdf",
        &["merges `tool` into `lower` without the rotation of its inertial"],
    ),
    (
        "06_before.xml",
        "06_conjugate.xml",
        &["06_conjugate.xml's inertia of `upper` is rotated by the inverse (conjugate)"],
    ),
    (
        "before.urdf",
        "07_merged_without_parallel_axis.urdf",
        &["merges `tool` into `lower` without the parallel-axis term"],
    ),
    (
        "before.urdf",
        "08_decimal_point.urdf",
        &["ixx of the inertia of `upper` is off by a factor 1e1, a decimal point: 0.2 instead of 0.02"],
    ),
    (
        "before.urdf",
        "09_effort_zero.urdf",
        &["armature of `shoulder` is dropped", "effort limit of `shoulder` is 0", "effort limit of `elbow` is 0"],
    ),
    (
        "before.urdf",
        "10_triangle.urdf",
        &["izz 0.0275 instead of 0.002): no body can have it, since the largest principal moment exceeds the sum"],
    ),
    (
        "before.urdf",
        "11_negative.urdf",
        &["izz of the inertia of `lower` has the other sign: -0.002 instead of 0.002: a principal moment is negative"],
    ),
    ("before.urdf", "12_rotor_lost.urdf", &["armature of `shoulder` is dropped"]),
    ("before.urdf", "12_gear_lost.urdf", &["armature of `shoulder` lacks the square of the gear ratio 50"]),
    ("before.urdf", "13_multiplier_lost.urdf", &["multiplier of the mimic joint `grip` is lost"]),
    ("before.urdf", "13_offset_lost.urdf", &["offset of the mimic joint `grip` is lost"]),
    ("before.urdf", "13_limits_lost.urdf", &["lower limit of `grip` is dropped", "upper limit of `grip` is dropped"]),
    ("before.urdf", "14_centre_in_mm.urdf", &["has the inertia of `upper` in other units: centre of mass by 1e3 (mm)"]),
    ("before.urdf", "14_moments_in_kg_mm2.urdf", &["inertia of `upper` is off by a factor 1e6, a unit"]),
    ("before.urdf", "14_mass_in_g.urdf", &["has the inertia of `lower` in other units: mass by 1e3 (g)"]),
    ("before.urdf", "14_origin_in_mm.urdf", &["`elbow` has its origin in mm"]),
    ("before.urdf", "14_angle_in_degrees.urdf", &["`elbow` has its angles in degrees"]),
    ("before.urdf", "14_mesh_scale.urdf", &["has the inertia of `lower` in other units: mass by 1e9, moments by 1e9"]),
    // the first file is the wrong one
    (
        "02_not_rotated.urdf",
        "before.urdf",
        &["02_not_rotated.urdf's inertia of `upper` is not rotated by its inertial's orientation"],
    ),
    (
        "05_merged_without_rotation.urdf",
        "before.urdf",
        &["05_merged_without_rotation.urdf merges `tool` into `lower` without the rotation of its inertial"],
    ),
    (
        "03_mass_of_shapes_added.urdf",
        "before.urdf",
        &["03_mass_of_shapes_added.urdf adds the mass of the shapes of `upper`"],
    ),
];

#[test]
fn the_cause_of_each_fault_is_named() {
    let mut wrong = Vec::new();
    for (before, after, words) in FAULTS {
        let comparison = compare(before, after);
        let causes: Vec<&str> = comparison.causes().collect();
        let is_named =
            causes.len() == words.len() && causes.iter().zip(words).all(|(cause, words)| cause.contains(words));
        if !is_named || comparison.agrees() || !comparison.is_explained() {
            wrong.push(comparison.text());
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_same_robot_agrees_however_it_is_written() {
    for (a, b) in
        [("before.urdf", "before.urdf"), ("before.urdf", "merged_rightly.urdf"), ("06_before.xml", "06_before.xml")]
    {
        let comparison = compare(a, b);
        assert!(comparison.agrees() && comparison.causes().next().is_none(), "{}", comparison.text());
    }
    // joints are known by their places, and forces are those of both
    let mut other = robot("before.urdf");
    let mut description = other.model.description().clone();
    for joint in &mut description.joints {
        joint.name = format!("arm/{}", joint.name);
        if let Some(mimic) = &mut joint.mimic {
            mimic.joint = format!("arm/{}", mimic.joint);
        }
    }
    (other.name, other.model) = ("renamed.urdf".to_string(), description.build().unwrap());
    let comparison = compare_files(&robot("before.urdf"), &other, 20, 1, 1e-9).unwrap();
    assert!(comparison.agrees(), "{}", comparison.text());
    assert!(comparison.text().contains("`elbow` is `arm/elbow` in renamed.urdf, known by its place"));
}

#[test]
fn the_verdict_is_in_forces_and_depends_on_the_tolerance() {
    let (before, after) = (robot("before.urdf"), robot("02_not_rotated.urdf"));
    let comparison = compare_files(&before, &after, 20, 1, 1e-9).unwrap();
    assert!(comparison.text().contains("torque of `shoulder` differs by up to"), "{}", comparison.text());
    let json = comparison.json();
    let [most, of] = ["most", "of"].map(|key| json["differences"]["inverse_dynamics"][key].as_f64().unwrap());
    // the largest difference, computed without the comparison
    let gap = {
        let I = |robot: &RobotFile| robot.model.description().links[1].inertia.about_center_of_mass();
        let (a, b) = (I(&before), I(&after));
        (a.xx - b.xx).abs().max((a.zz - b.zz).abs())
    };
    assert!(most > 0.1 * gap && most < 100.0 * gap, "{most} {gap}");
    assert!(!comparison.forces_agree());
    let loose = compare_files(&before, &after, 20, 1, 1.0 - 1e-9).unwrap();
    assert!(loose.forces_agree() && most < of);
    let worst = json["differences_explained"]["inverse_dynamics"]["most"].as_f64().unwrap();
    assert!(worst <= 1e-12 * of, "with the cause accounted for, the forces are the second robot's");
}
