//! `docs/published-robots.md`: the table of published robots, and every warning and refusal on the URDFs of
//! `example-robot-data`, if `MOZZI_ROBOTS` names that package's folder of robots and `MOZZI_ORACLES` a folder that
//! `oracles/make_mjcf.py` wrote into.
//!
//! `cargo xtask docs` rewrites the page.

mod table;

use crate::files::files_with_ending;
use mozzi_urdf::{Diagnostic, Severity, load};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::path::{Path, PathBuf};

const HEAD: &str = "\
# Published robots

Published robots as mozzi reads them under the default policy: the URDF and SDFormat files of PyPI's `example-robot-data` 6.0.0, and
the MJCF models of `gymnasium` 1.4.0 and `dm_control` 1.0.50 in which something moves. `cargo xtask docs` writes this page; a test
of `cargo xtask test` checks that it is current. [Published models of MuJoCo](published-models.md) compares the MJCF models with MuJoCo.
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
    loads: bool,
    said: Vec<Diagnostic>,
}

/// The files of the package whose names end in `.` and an ending, in order.
fn files(folder: &Path, ending: &str) -> Vec<table::File> {
    let mut paths = Vec::new();
    files_with_ending(folder, ending, &mut paths);
    paths.sort();
    let name = |path: &PathBuf| path.strip_prefix(folder).expect("in the folder").to_string_lossy().replace('\\', "/");
    paths.into_iter().map(|path| (name(&path), path)).collect()
}

fn robots(files: &[table::File]) -> Vec<Robot> {
    let read = |(name, path): &table::File| match load(path) {
        Ok(robot) => {
            let said = robot.warnings.clone();
            robot.build().expect("what is read can be built");
            Robot { name: name.clone(), loads: true, said }
        }
        Err(error) => Robot { name: name.clone(), loads: false, said: error.diagnostics().to_vec() },
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

fn page(robots: &[Robot], files: &[table::File], table: &str) -> String {
    let mut page = String::from(HEAD);
    let _ = write!(
        page,
        "\n## What `check` finds in {} files\n\nThe number of each code that `mozzi check` reports; *joints* are those that move; \
         *proposals* are the repairs that `mozzi check --fix` offers, which are of URDF only.\n\n{table}",
        files.len()
    );
    let refused = robots.iter().filter(|robot| !robot.loads).count();
    let silent = robots.iter().filter(|robot| robot.said.is_empty()).count();
    let _ = writeln!(
        page,
        "\n## Kinds of diagnostics of the URDFs\n\nOf {} URDFs {} load, {silent} of them without warnings; {refused} are refused.",
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
    let _ = writeln!(page, "\n| code | | times | files | explanation |\n|---|---|---|---|---|");
    for ((code, severity), (count, files)) in &kinds {
        let why = WHY.iter().find(|(known, _)| known == code).unwrap_or_else(|| panic!("{code} needs a word"));
        let link = format!("[`{code}`](diagnostics/{code}.md)");
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

    let _ = writeln!(page, "\n## All diagnostics of the URDFs");
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

/// Compares the page, with the proposals of every so many files computed anew.
fn compare(step: usize) {
    let [Ok(folder), Ok(oracles)] = ["MOZZI_ROBOTS", "MOZZI_ORACLES"].map(std::env::var) else {
        eprintln!(
            "skipped: MOZZI_ROBOTS does not name the folder of example-robot-data, or MOZZI_ORACLES none of oracles"
        );
        return;
    };
    let (folder, oracles) = (Path::new(&folder), Path::new(&oracles));
    if !oracles.join("list.txt").exists() {
        eprintln!("skipped: {} has no list.txt of oracles/make_mjcf.py", oracles.display());
        return;
    }
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/published-robots.md");
    let read = || std::fs::read_to_string(&file).unwrap_or_default().replace("\r\n", "\n");
    let bless = std::env::var_os("MOZZI_BLESS").is_some();
    let urdfs = files(folder, "urdf");
    let robots = robots(&urdfs);
    let all = [urdfs, files(folder, "sdf"), table::models(oracles)].concat();
    let page = page(&robots, &all, &table::table(&all, &read(), if bless { 1 } else { step }));
    if bless {
        std::fs::write(&file, &page).expect("a writable folder");
    }
    let written = read();
    let differing = page.lines().zip(written.lines()).find(|(found, written)| found != written);
    assert!(written == page, "docs/published-robots.md is not current: run `cargo xtask docs`\n{differing:#?}");
}

#[test]
fn the_page_of_published_robots_is_current() {
    compare(8);
}

#[test]
#[ignore = "minutes; cargo xtask nightly runs it"]
fn all_proposals_for_published_robots_are_current() {
    compare(1);
}
