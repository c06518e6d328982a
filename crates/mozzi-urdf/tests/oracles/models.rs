//! `docs/published-models.md`: the outcome for each MJCF model of gymnasium and dm_control, if `MOZZI_ORACLES` names a
//! folder that `oracles/make_mjcf.py` wrote into.
//!
//! `cargo xtask docs` rewrites the page.

use super::{compare_all, model};
use mozzi_urdf::{LoadError, Loaded, Severity, load};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

const HEAD: &str = "\
# Published models of MuJoCo

Every MJCF file of PyPI's `gymnasium` 1.4.0 and `dm_control` 1.0.50, as mozzi reads it. `cargo xtask docs` writes this page; a test of
`cargo xtask test` checks that it is current.
";

/// The meaning of each refusal; one that is missing here fails the test.
const WHY: [(&str, &str); 8] = [
    ("include", "An included file is missing; MuJoCo reports the same."),
    ("mesh_inertia", "Inertias would have to be computed from meshes that are not in the package, or bound no volume."),
    (
        "unsupported_attribute",
        "`springdamper` chooses a spring by the mass matrix, which is singular without the inertias of meshes, which mozzi does not read.",
    ),
    ("unsupported_equality", "Spatial tendons are coupled, by forces that mozzi does not compute."),
    ("unsupported_joint", "A free joint inside the tree, which MuJoCo refuses, too."),
    ("unsupported_tendon", "A tendon with stiffness or damping puts forces on several joints at once."),
    (
        "missing_attribute",
        "An `<inertial>` gives no moments; MuJoCo takes them as 0, and refuses the model if the body moves.",
    ),
    ("wrong_root", "A description of MJCF itself, not a model."),
];

/// A model and its outcome.
struct Entry {
    name: String,
    verdict: String,
    outcome: Result<(usize, Loaded), LoadError>,
    /// Worst normalised error, if MuJoCo's numbers are available.
    error: Option<f64>,
}

/// The path below the folder of packages.
pub(crate) fn name_of(path: &str) -> String {
    let path = path.replace('\\', "/");
    ["/gymnasium/", "/dm_control/"]
        .iter()
        .find_map(|start| path.rfind(start).map(|at| path[at + 1..].to_string()))
        .unwrap()
}

fn entries(folder: &Path) -> Vec<Entry> {
    let mut oracles = BTreeMap::new();
    for entry in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        let is_model = entry.file_name().unwrap().to_string_lossy().starts_with("mjcf_");
        if is_model {
            let oracle: Value = serde_json::from_str(&std::fs::read_to_string(entry).unwrap()).unwrap();
            oracles.insert(oracle["mjcf"].as_str().unwrap().to_string(), oracle);
        }
    }
    let list = std::fs::read_to_string(folder.join("list.txt")).unwrap();
    let read = |line: &str| {
        let (path, verdict) = line.split_once('\t').unwrap();
        let outcome = load(path).map(|robot| (robot.clone().build().unwrap().n(), robot));
        let error = oracles.get(path).and_then(|oracle| {
            let worst = compare_all(path, oracle, &model(oracle).ok()?);
            worst.0.values().copied().reduce(f64::max)
        });
        // MuJoCo's own messages contain paths of this machine
        let verdict = if verdict.starts_with("MuJoCo") { "refused" } else { verdict }.to_string();
        Entry { name: name_of(path), verdict, outcome, error }
    };
    list.lines().map(read).collect()
}

/// The bound of each model in the existing page.
fn bounds(page: &str) -> BTreeMap<&str, f64> {
    let row = |line: &'_ str| -> Option<(usize, usize)> {
        let cell = line.split(" | ").nth(2)?.strip_prefix("≤ ")?;
        Some((line.len(), cell.parse::<usize>().ok()?))
    };
    page.lines()
        .filter_map(|line| {
            let (_, bound) = row(line)?;
            Some((line.trim_start_matches("| ").split(" | ").next()?, bound as f64))
        })
        .collect()
}

/// A bound on an error that also holds with other processors' rounding: the existing one, if it holds within a factor
/// of four, or the next power of two.
fn bound(error: f64, written: Option<&f64>) -> f64 {
    match written {
        Some(&bound) if error <= 4.0 * bound => bound,
        _ => error.max(1.0).log2().ceil().exp2(),
    }
}

fn page(entries: &[Entry], written: &BTreeMap<&str, f64>) -> String {
    let mut page = String::from(HEAD);
    let compared: Vec<&Entry> = entries.iter().filter(|entry| entry.error.is_some()).collect();
    let trees = entries.iter().filter(|entry| entry.verdict == "compared").count();
    let _ = write!(
        page,
        "\nOf {} files {trees} are models with hinges, slides, balls and free bodies. {} of them are trees: they load, and agree with MuJoCo \
         at 100 random states each. Refused by name: {}.\n\n\
         ## Trees\n\n\
         Poses of all bodies, Jacobians, M, h, τ, θ̈ and the kinetic energy, without springs, damping and friction, which are \
         switched off in MuJoCo. The error is normalised: the difference over ε = 2.2 × 10⁻¹⁶ times the size of the terms. \
         *Left out* are forces of MuJoCo that mozzi does not compute, each told in a warning.\n\n\
         The inertia of a mesh is that of MuJoCo 4, which drops its products of inertia about the principal axes where they \
         are at most 10⁻⁷ of the largest moment.\n\n\
         | model | n | worst error | left out |\n|---|---|---|---|\n",
        entries.len(),
        compared.len(),
        trees - compared.len()
    );
    for Entry { name, outcome, error, .. } in &compared {
        let (Ok((n, robot)), Some(error)) = (outcome, error) else { continue };
        let forces = robot.warnings.iter().filter(|warning| warning.code().ends_with("::ignored_force"));
        let what = |text: &str| text.split(", ").nth(1).unwrap_or_default().to_string();
        let forces: Vec<String> = forces.map(|warning| what(warning.message())).collect();
        let _ = writeln!(
            page,
            "| {name} | {n} | ≤ {} | {} |",
            bound(*error, written.get(name.as_str())),
            forces.join(", ")
        );
    }
    let mut kinds = BTreeMap::new();
    let _ = writeln!(
        page,
        "\n## Refused\n\nThe second column is MuJoCo's result.\n\n| file | MuJoCo | code | first error |\n|---|---|---|---|"
    );
    for Entry { name, verdict, outcome, .. } in entries {
        let Err(error) = outcome else { continue };
        let errors: Vec<_> = error.errors().collect();
        for found in &errors {
            let code = found.code().trim_start_matches("mozzi::mjcf::").trim_start_matches("mozzi::urdf::");
            kinds.entry(code.to_string()).or_insert_with(std::collections::BTreeSet::new).insert(name);
        }
        let first = errors[0];
        let message = first.message().split(" cannot be read: ").next().unwrap_or_default().replace('<', "\\<");
        let verdict = if verdict == "compared" { "loads" } else { verdict };
        let _ = writeln!(page, "| {name} | {verdict} | `{}` | {message} |", first.code().rsplit("::").next().unwrap());
    }
    let _ = writeln!(page, "\n| code | files | why |\n|---|---|---|");
    for (code, files) in kinds {
        let why =
            WHY.iter().find(|(known, _)| *known == code).unwrap_or_else(|| panic!("{code} needs a word: {files:?}"));
        let _ = writeln!(page, "| `{code}` | {} | {} |", files.len(), why.1);
    }
    let _ = writeln!(page, "\n## Loaded, with nothing to compare\n\n| file | MuJoCo | n |\n|---|---|---|");
    for entry in entries.iter().filter(|entry| entry.error.is_none()) {
        let Ok((n, robot)) = &entry.outcome else { continue };
        assert!(robot.warnings.iter().all(|warning| warning.severity() == Severity::Warning));
        let _ = writeln!(page, "| {} | {} | {n} |", entry.name, entry.verdict);
    }
    page
}

#[test]
fn the_page_of_published_models_is_current() {
    let Some(folder) = std::env::var_os("MOZZI_ORACLES") else {
        println!("skipped: MOZZI_ORACLES names no folder (cargo xtask test makes one)");
        return;
    };
    let folder = Path::new(&folder);
    if !folder.join("list.txt").exists() {
        println!("skipped: {} has no list.txt of oracles/make_mjcf.py", folder.display());
        return;
    }
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/published-models.md");
    let written = std::fs::read_to_string(&file).unwrap_or_default().replace("\r\n", "\n");
    let bless = std::env::var_os("MOZZI_BLESS").is_some();
    let page = page(&entries(folder), &bounds(&written));
    if bless {
        std::fs::write(&file, &page).unwrap();
        return;
    }
    let differing = page.lines().zip(written.lines()).find(|(found, written)| found != written);
    assert!(written == page, "docs/published-models.md is not current: run `cargo xtask docs`\n{differing:#?}");
}
