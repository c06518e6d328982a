//! `docs/published-robots.md`: every warning and every refusal on the URDFs of `example-robot-data`, if `MOZZI_ROBOTS`
//! names that package's folder of robots.
//!
//! `cargo xtask docs` rewrites the page.

use crate::files;

use files::urdf_files;
use mozzi_urdf::{Diagnostic, Severity, load};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::path::{Path, PathBuf};

const HEAD: &str = "\
# Published robots

The diagnostics of each URDF of PyPI's `example-robot-data` 6.0.0 under the default policy. Robots that are not in the second
table load without warnings. `cargo xtask docs` writes this page; a test of `cargo xtask test` checks that it is current.
";

/// Why each kind is right; a kind that is missing here fails the test.
const WHY: [(&str, &str); 14] = [
    (
        "fixed_mimic",
        "The arms of Talos were reduced by making joints fixed, and their `<mimic>` was left in. A fixed joint does not \
         move, so these fingers stay as they are: the warning is for users who expect a gripper that closes.",
    ),
    (
        "ignored_force",
        "The PR2 switches gravity off for its arms and cameras in Gazebo. mozzi does not read Gazebo's settings: gravity acts on \
         these links here.",
    ),
    ("implausible_mass", "Moments of inertia without a mass: one of them was forgotten, or both are placeholders."),
    (
        "indefinite_inertia",
        "Negative moments of the trunk and of the thighs, in moving bodies. Rotation would have a \
             negative kinetic energy, so forward dynamics is meaningless. Refused; `--lenient` uses the \
             nearest physical inertia.",
    ),
    (
        "massless_leaf",
        "Fingers that move and have no `<inertial>`. Inverse dynamics works; forward dynamics returns an \
             error that names the joint.",
    ),
    ("missing_attribute", "A robot needs a name; this file is xacro's output for an empty macro."),
    (
        "missing_limit",
        "Wheels and knees of type `revolute` with effort and velocity and without bounds. URDF's default of 0 would lock \
         them, which nobody intends; they turn freely here, with a warning.",
    ),
    ("no_links", "The same file has no links: there is no robot to compute."),
    (
        "unknown_attribute",
        "`D`, `K`, `mu_coulomb` and `mu_viscous` of the Panda are the Panda's own names for friction and stiffness, which would change the joint torques; `dont_collapse`, `current`, `command_effort` and `gear_velocity` \
         concern other programs. URDF does not define them, so they are ignored, with one warning each.",
    ),
    (
        "unknown_element",
        "`<gravity>` and `<kinematic>` are SDF elements in the wrong place, `<origin>` and `<surface>` in a link are not defined in URDF: they do not have the effect that their authors expect. `<self_filter>` and `<collision_checking>` are for \
         programs of their own.",
    ),
    (
        "unknown_joint",
        "Fingers follow `index_q1`, and the joint is called `Left_index_q1`. Without the coupling the hand would have eight \
         degrees of freedom too many: refused.",
    ),
    (
        "unphysical_inertia",
        "Placeholders (all six entries 10⁻⁶), rounded digits, guessed moments: no rigid body has them. \
             The equations of motion are sound, so the numbers are used as given.",
    ),
    (
        "turned_inertia",
        "Small sensors whose moments fit their collision box with two axes exchanged: a slip in the file, of 1e-7 to \
         3e-5 kg m², which is computed as it is written.",
    ),
    (
        "zero_limits",
        "A `<limit>` whose numbers are all 0, as exporters of CAD programs write it: the joint is computed as the file says, \
         at 0 where limits are respected.",
    ),
];

/// One file and its diagnostics.
struct Robot {
    name: String,
    /// Degrees of freedom and links; None if it is refused.
    size: Option<(usize, usize)>,
    said: Vec<Diagnostic>,
}

fn robots(folder: &Path) -> Vec<Robot> {
    let mut files = Vec::new();
    urdf_files(folder, &mut files);
    files.sort();
    let read = |path: &PathBuf| {
        let name = path.strip_prefix(folder).expect("in the folder").to_string_lossy().replace('\\', "/");
        match load(path) {
            Ok(robot) => {
                let (said, links) = (robot.warnings.clone(), robot.description.links.len());
                let model = robot.build().expect("what is read can be built");
                Robot { name, size: Some((model.n(), links)), said }
            }
            Err(error) => Robot { name, size: None, said: error.diagnostics().to_vec() },
        }
    };
    files.iter().map(read).collect()
}

fn short(found: &Diagnostic) -> &str {
    found.code().rsplit("::").next().unwrap_or_default()
}

/// The message without the list of expected values, short enough for an item of a list.
fn message(found: &Diagnostic) -> String {
    let text = found.message();
    text.split_once(", expected one of").map_or(text, |(start, _)| start).to_string()
}

fn page(robots: &[Robot]) -> String {
    let mut page = String::from(HEAD);
    let refused = robots.iter().filter(|robot| robot.size.is_none()).count();
    let silent = robots.iter().filter(|robot| robot.said.is_empty()).count();
    let _ = writeln!(
        page,
        "\nOf {} files {} load, {silent} of them without warnings; {refused} are refused.",
        robots.len(),
        robots.len() - refused
    );

    let mut kinds: BTreeMap<(&str, &str), (usize, BTreeSet<&str>)> = BTreeMap::new();
    for robot in robots {
        for found in &robot.said {
            let severity = if found.severity() == Severity::Error { "error" } else { "warning" };
            let kind = kinds.entry((short(found), severity)).or_default();
            kind.0 += 1;
            kind.1.insert(&robot.name);
        }
    }
    let _ = writeln!(page, "\n## Kinds\n\n| code | | times | files | explanation |\n|---|---|---|---|---|");
    for ((code, severity), (count, files)) in &kinds {
        let why = WHY.iter().find(|(known, _)| known == code).unwrap_or_else(|| panic!("{code} needs a word"));
        let link = format!("[`{code}`](diagnostics.md#mozziurdf{code})");
        let _ = writeln!(page, "| {link} | {severity} | {count} | {} | {} |", files.len(), why.1);
    }

    let inertias = |is: fn(&Diagnostic) -> bool| {
        let of = |robot: &&Robot| robot.said.iter().filter(|found| is(found)).count();
        robots.iter().map(|robot| of(&robot)).sum::<usize>()
    };
    let triangle = inertias(|found| found.message().contains("triangle inequality"));
    let negative = inertias(|found| found.message().contains("smallest principal moment"));
    let severe = inertias(|found| short(found) == "indefinite_inertia" && found.severity() == Severity::Error);
    let _ = write!(
        page,
        "\n## The policy on inertias\n\n\
         {triangle} links break the triangle inequality of the principal moments, {negative} have a negative moment: {} in \
         all. Refusing them would refuse ANYmal, HyQ, Tiago and PR2, whose equations of motion are sound: the mass matrix \
         is positive definite, although no rigid body has such numbers. So they are used as given, with a \
             warning. Of the {negative} \
         negative ones {severe} make their moving body indefinite, which is an error: its forward dynamics would be meaningless. \
             The others are antennas fixed to a much heavier base.\n\n\
         Fourteen links of the two iCubs have moments of 10⁻¹⁸ kg m² and less, of either sign. This is rounding of zero: they are point masses, which are valid and give no warning.\n",
        triangle + negative
    );

    let _ = writeln!(
        page,
        "\n## Files\n\n| file | degrees of freedom | links | warnings | errors |\n|---|---|---|---|---|"
    );
    for robot in robots.iter().filter(|robot| !robot.said.is_empty() || robot.size.is_none()) {
        let errors = robot.said.iter().filter(|found| found.severity() == Severity::Error).count();
        let (n, links) = robot.size.map_or(("refused".into(), "–".into()), |(n, l)| (n.to_string(), l.to_string()));
        let _ = writeln!(page, "| {} | {n} | {links} | {} | {errors} |", robot.name, robot.said.len() - errors);
    }
    let _ = writeln!(page, "\n## All diagnostics");
    for robot in robots.iter().filter(|robot| !robot.said.is_empty()) {
        let _ = writeln!(page, "\n### {}\n", robot.name);
        for found in &robot.said {
            let severity = if found.severity() == Severity::Error { "error" } else { "warning" };
            let _ = writeln!(
                page,
                "- {}:{} {severity} `{}`: {}",
                found.line(),
                found.column(),
                short(found),
                message(found)
            );
        }
    }
    page
}

#[test]
fn the_page_of_published_robots_is_current() {
    let Ok(folder) = std::env::var("MOZZI_ROBOTS") else {
        eprintln!("skipped: MOZZI_ROBOTS does not name the folder of example-robot-data");
        return;
    };
    let page = page(&robots(Path::new(&folder)));
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/published-robots.md");
    if std::env::var_os("MOZZI_BLESS").is_some() {
        std::fs::write(&file, &page).expect("a writable folder");
    }
    let written = std::fs::read_to_string(&file).unwrap_or_default().replace("\r\n", "\n");
    let differing = page.lines().zip(written.lines()).find(|(found, written)| found != written);
    assert!(written == page, "docs/published-robots.md is not current: run `cargo xtask docs`\n{differing:#?}");
}
