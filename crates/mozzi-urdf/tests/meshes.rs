//! Inertias that MJCF computes from geoms and meshes, against MuJoCo, if `MOZZI_PYTHON` names a Python that has it.
//!
//! Masses, centres, principal moments and products of inertia agree to 1e-10.

use mozzi::{SpatialInertia, Vec3};
use mozzi_urdf::load;
use serde_json::Value;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

const JUDGE: &str = r#"
import json, mujoco, numpy as np, sys
found = {}
for path in sys.argv[1:]:
    try:
        model = mujoco.MjModel.from_xml_path(path)
    except ValueError as error:
        found[path] = str(error)
        continue
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    found[path] = bodies = {}
    for i in range(1, model.nbody):
        R = np.zeros(9)
        mujoco.mju_quat2Mat(R, model.body_iquat[i])
        R = R.reshape(3, 3)
        I = R @ np.diag(model.body_inertia[i]) @ R.T
        bodies[model.body(i).name] = [model.body_mass[i], *model.body_ipos[i], *I.ravel(), *sorted(model.body_inertia[i]), *data.xpos[i], *data.xmat[i]]
print(json.dumps(found))
"#;

/// A star: points of a ball at radii that alternate, so that it is not convex; the middle is not at the origin.
fn star() -> (Vec<[f32; 3]>, Vec<[usize; 3]>) {
    let (around, rows) = (14_usize, 9_usize);
    let mut vertices = vec![[0.4_f32, 0.1, 1.3], [0.4, 0.1, -1.1]];
    for row in 1..rows {
        for k in 0..around {
            let (a, b) =
                (row as f64 / rows as f64 * std::f64::consts::PI, k as f64 / around as f64 * std::f64::consts::TAU);
            let r = if (row + k) % 2 == 0 { 1.0 } else { 0.55 } * (1.0 + 0.3 * (2.0 * b).sin());
            vertices.push(
                [0.4 + r * a.sin() * b.cos(), 0.1 + 0.7 * r * a.sin() * b.sin(), 1.2 * r * a.cos()].map(|x| x as f32),
            );
        }
    }
    let at = |row: usize, k: usize| 2 + (row - 1) * around + k % around;
    let mut triangles = Vec::new();
    for k in 0..around {
        triangles.push([0, at(1, k), at(1, k + 1)]);
        triangles.push([1, at(rows - 1, k + 1), at(rows - 1, k)]);
        for row in 1..rows - 1 {
            triangles.push([at(row, k), at(row + 1, k), at(row + 1, k + 1)]);
            triangles.push([at(row, k), at(row + 1, k + 1), at(row, k + 1)]);
        }
    }
    (vertices, triangles)
}

/// Writes the star in three formats.
fn write_meshes(folder: &Path) {
    let (vertices, triangles) = star();
    let mut obj = String::from("o star\n");
    vertices.iter().for_each(|[x, y, z]| writeln!(obj, "v {x} {y} {z}").unwrap());
    triangles.iter().for_each(|[a, b, c]| writeln!(obj, "f {} {} {}", a + 1, b + 1, c + 1).unwrap());
    std::fs::write(folder.join("star.obj"), obj).unwrap();
    let mut stl = vec![0; 80];
    stl.extend((triangles.len() as u32).to_le_bytes());
    for triangle in &triangles {
        stl.extend([0; 12]);
        triangle.iter().flat_map(|&i| vertices[i]).for_each(|x| stl.extend(x.to_le_bytes()));
        stl.extend([0; 2]);
    }
    std::fs::write(folder.join("star.stl"), stl).unwrap();
    let mut msh: Vec<u8> =
        [vertices.len() as i32, 0, 0, triangles.len() as i32].iter().flat_map(|n| n.to_le_bytes()).collect();
    vertices.iter().flatten().for_each(|x| msh.extend(x.to_le_bytes()));
    triangles.iter().flatten().for_each(|&i| msh.extend((i as i32).to_le_bytes()));
    std::fs::write(folder.join("star.msh"), msh).unwrap();
}

/// Copies of copies, in frames, with the geoms of one body copied, too.
const REPLICATED: &str = "<mujoco><compiler angle='radian'/><worldbody><frame pos='0 0 2' euler='0.1 0.2 0.3'>\
    <replicate count='3' offset='0.5 0.1 0' euler='0 0.3 1.2' sep='-'><body name='leg' pos='1 0 0'><joint name='hip' axis='0 1 0'/>\
    <geom size='0.1 0.2' type='capsule'/><replicate count='2' offset='0 0 0.4'><body name='toe' pos='0 0.3 0'><joint name='t' axis='1 0 0'/>\
    <geom size='0.1'/></body></replicate></body></replicate></frame><body name='wheel'><joint name='axle'/>\
    <replicate count='11' euler='0 0 0.6'><geom type='box' size='0.1 0.2 0.3' pos='1 0 0'/></replicate></body></worldbody></mujoco>";

/// A model of bodies, each with its geoms; names are numbers.
fn model(compiler: &str, bodies: &[String]) -> String {
    let mut assets = String::new();
    for filling in ["convex", "exact", "legacy", "shell"] {
        for format in ["obj", "stl", "msh"] {
            let _ = write!(assets, "<mesh name='{format}_{filling}' file='star.{format}' inertia='{filling}'/>");
        }
        let moved = "scale='0.7 0.9 1.4' refpos='0.1 -0.2 0.3' refquat='0.9 0.1 -0.3 0.2'";
        let _ = write!(assets, "<mesh name='moved_{filling}' file='star.stl' inertia='{filling}' {moved}/>");
        if filling != "convex" {
            let _ = write!(
                assets,
                "<mesh name='mirror_{filling}' file='star.obj' inertia='{filling}' scale='1 -0.8 1.1'/>"
            );
        }
    }
    assets += "<hfield name='field' nrow='2' ncol='2' size='1 0.5 0.4 0.2' elevation='0 1 2 1'/>";
    let points = "0 0 0  1 0 0  0 1.5 0  0 0 2  0.9 1.2 1.9  0.2 0.2 0.2";
    let _ =
        write!(assets, "<mesh name='points' vertex='{points}'/><mesh name='hull' vertex='{points}' inertia='convex'/>");
    let mut text = format!("<mujoco><compiler angle='radian' {compiler}/><asset>{assets}</asset><worldbody>");
    for (k, body) in bodies.iter().enumerate() {
        let _ = write!(text, "<body name='b{k}' pos='{k} 0 0'><joint name='j{k}' axis='0 1 0'/>{body}</body>");
    }
    text + "</worldbody></mujoco>"
}

fn models() -> Vec<(&'static str, String)> {
    let mut meshes = Vec::new();
    for filling in ["convex", "exact", "legacy", "shell"] {
        for of in ["obj", "stl", "msh", "moved", "mirror"] {
            if (of, filling) != ("mirror", "convex") {
                let at = "pos='0.3 -0.4 0.5' euler='0.3 -0.7 1.1'";
                meshes.push(format!("<geom type='mesh' mesh='{of}_{filling}' {at}/>"));
                meshes.push(format!("<geom type='mesh' mesh='{of}_{filling}' {at} density='370'/>"));
                meshes.push(format!(
                    "<geom type='mesh' mesh='{of}_{filling}' mass='2.5'/><geom size='0.2' pos='1 0 0'/>"
                ));
            }
        }
    }
    meshes.push("<geom type='mesh' mesh='points'/>".into());
    meshes.push("<geom type='mesh' mesh='hull' mass='3'/>".into());
    let solids = [
        "box' size='0.3 0.2 0.5",
        "sphere' size='0.3",
        "capsule' size='0.2 0.6",
        "cylinder' size='0.2 0.6",
        "ellipsoid' size='0.3 0.2 0.5",
        "hfield' hfield='field",
    ];
    let mut primitives = Vec::new();
    for solid in solids {
        for more in ["", "density='370'", "mass='4'", "shellinertia='true'", "shellinertia='true' mass='2'"] {
            primitives.push(format!("<geom type='{solid}' {more} pos='0.1 0.2 0.3' quat='0.9 0.1 0.2 -0.3'/>"));
        }
    }
    primitives.push(
        "<geom type='capsule' size='0.1' fromto='0 0 0 1 2 3'/><geom type='box' size='0.1' fromto='0 0 0 1 0 1'/>"
            .into(),
    );
    let fitted: Vec<String> = ["box", "sphere", "capsule", "cylinder", "ellipsoid"]
        .iter()
        .flat_map(|kind| {
            [
                format!("<geom type='{kind}' mesh='obj_exact' pos='0.3 0 0'/>"),
                format!("<geom type='{kind}' mesh='moved_legacy' fitscale='0.8' mass='2'/>"),
            ]
        })
        .collect();
    let inertial = "<inertial pos='0.1 0.2 0.3' mass='2' diaginertia='0.03 0.04 0.05' quat='0.9 0.1 0.2 0.3'/>";
    let chosen = vec![
        format!("{inertial}<geom size='0.2'/>"),
        "<geom size='0.2'/><geom size='0.3' group='3' pos='1 0 0'/><geom type='mesh' mesh='stl_exact' group='2'/>"
            .into(),
        format!("{inertial}<geom size='0.2' mass='0'/>"),
        format!("{inertial}<geom size='0.2' group='4' mass='1'/>"),
    ];
    let weak = vec![
        "<inertial pos='0 0 0' mass='0.001' diaginertia='1e-5 2e-5 1e-6'/>".to_string(),
        "<inertial pos='0.1 0 0' mass='1' diaginertia='0.1 0.2 0.9'/>".to_string(),
        "<geom type='mesh' mesh='obj_legacy' mass='0.02'/>".to_string(),
    ];
    vec![
        ("meshes", model("", &meshes)),
        ("primitives", model("", &primitives)),
        ("fitted", model("", &fitted)),
        ("fitted_aabb", model("fitaabb='true'", &fitted)),
        ("auto", model("inertiafromgeom='auto' inertiagrouprange='0 2'", &chosen)),
        ("true", model("inertiafromgeom='true' inertiagrouprange='0 2'", &chosen)),
        ("false", model("inertiafromgeom='false'", &[chosen[0].clone(), chosen[2].clone()])),
        ("bounds", model("boundmass='0.5' boundinertia='0.01' balanceinertia='true'", &weak)),
        ("total", model("settotalmass='12.5'", &meshes[..9])),
        ("replicate", REPLICATED.to_string()),
    ]
}

fn compare(name: &str, body: &str, found: SpatialInertia, expected: &[f64]) -> [f64; 4] {
    let (mass, c) = (expected[0], Vec3([expected[1], expected[2], expected[3]]));
    let I = found.about_center_of_mass();
    let rows = I.to_mat3().rows();
    let scale = expected[13..16].iter().fold(0.0_f64, |m, x| m.max(*x));
    let far = |a: &[f64], b: &[f64]| a.iter().zip(b).fold(0.0_f64, |m, (x, y)| m.max((x - y).abs()));
    let errors = [
        (found.mass - mass).abs() / mass,
        (found.center_of_mass() - c).norm() / c.norm().max(0.1),
        far(&found.verdict().principal_moments, &expected[13..16]) / scale,
        far(rows.as_flattened(), &expected[4..13]) / scale,
    ];
    for (error, bound) in errors.iter().zip([1e-10; 4]) {
        assert!(error < &bound, "{name}: {body}: {errors:?}");
    }
    errors
}

#[test]
fn inertias_of_geoms_are_mujocos() {
    let Ok(python) = std::env::var("MOZZI_PYTHON") else {
        println!("skipped: MOZZI_PYTHON names no Python with mujoco (cargo xtask test makes one)");
        return;
    };
    let folder = std::env::temp_dir().join(format!("mozzi-meshes-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    write_meshes(&folder);
    let files: Vec<PathBuf> = models()
        .into_iter()
        .map(|(name, text)| {
            let file = folder.join(format!("{name}.xml"));
            std::fs::write(&file, text).unwrap();
            file
        })
        .collect();
    let output = Command::new(&python).current_dir(&folder).arg("-c").arg(JUDGE).args(&files).output().unwrap();
    if !output.status.success() {
        println!("skipped: {python} has no mujoco: {}", String::from_utf8_lossy(&output.stderr));
        return;
    }
    let judged: Value = serde_json::from_slice(&output.stdout).unwrap();
    for file in &files {
        let name = file.file_stem().unwrap().to_string_lossy().into_owned();
        let bodies = judged[file.to_str().unwrap()]
            .as_object()
            .unwrap_or_else(|| panic!("{name}: {}", judged[file.to_str().unwrap()]));
        let robot = load(file).unwrap_or_else(|error| panic!("{error}")).description;
        let built = robot.clone().build().unwrap();
        let mut worst = [0.0_f64; 4];
        for (body, expected) in bodies {
            let expected: Vec<f64> = expected.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
            let found = robot.links.iter().find(|link| link.name == *body).unwrap().inertia;
            let errors = compare(&name, body, found, &expected);
            let T = built.forward_kinematics(&built.start().theta, built.frame(body).unwrap()).unwrap();
            let pose = T.p.0.iter().chain(T.R.matrix().rows().as_flattened()).copied().collect::<Vec<_>>();
            let far = pose.iter().zip(&expected[16..]).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
            assert!(far < 1e-12, "{name}: {body}: {pose:?}, expected {:?}", &expected[16..]);
            worst.iter_mut().zip(errors).for_each(|(worst, error)| *worst = worst.max(error));
        }
        println!(
            "{name}: {} bodies: mass {:.1e}, centre {:.1e}, moments {:.1e}, products {:.1e}",
            bodies.len(),
            worst[0],
            worst[1],
            worst[2],
            worst[3]
        );
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn a_mesh_that_cannot_be_read_is_told() {
    let why = |mesh: &str, geom: &str| {
        let text = format!(
            "<mujoco><asset>{mesh}</asset><worldbody><body name='b'><joint/><geom type='mesh' mesh='{geom}'/></body></worldbody></mujoco>"
        );
        let error = mozzi_urdf::parse("a.xml", text).unwrap_err();
        let first = error.diagnostics()[0].clone();
        assert_eq!(first.code(), "mozzi::mjcf::mesh_inertia");
        first.message().to_string()
    };
    let flat = "0 0 0 1 0 0 0 1 0 1 1 0";
    for (mesh, said) in [
        ("", "there is no such mesh in <asset>"),
        ("<mesh name='m' file='m.stl'/>", "`m.stl` is relative to the model, which was not read from a file"),
        ("<mesh name='m' vertex='0 0 0 1 0 0'/>", "it has 2 vertices, expected at least 4"),
        ("<mesh name='m' vertex='0 0 0 1'/>", "vertex: expected three numbers for each"),
        (&format!("<mesh name='m' vertex='{flat}'/>"), "its vertices are in one plane, so it has no convex hull"),
        (&format!("<mesh name='m' vertex='{flat}' face='0 1 9'/>"), "face: expected three vertices for each"),
        (
            "<mesh name='m' builtin='sphere' params='2'/>",
            "builtin: changes its vertices in a way that mozzi does not follow",
        ),
    ] {
        assert_eq!(why(mesh, "m"), format!("body `b`: geom: mesh: its inertia is needed, and is unknown: {said}"));
    }
}
