//! A humanoid stands on two feet: joint torques for given wrenches at the soles.
//!
//! With a floating base τ = M θ̈ + c + g + JᵀF has six rows more than there are motors. At rest g + JᵀF must be 0 in
//! these six: the wrenches at the soles carry the weight. There are twelve unknowns for six equations; this example
//! uses the least-norm solution (least squares). The other rows are then the motors' torques. Forward dynamics verifies
//! the result: with those torques and those wrenches, all accelerations are 0.
//!
//! mozzi does not include Talos: run `pip install example-robot-data`, then give the file
//! `cmeel.prefix/share/example-robot-data/robots/talos_data/robots/talos_reduced.urdf` of its folder, or set the
//! variable MOZZI_ROBOTS to the folder of robots.

use mozzi::nalgebra::DMatrix;
use mozzi::{Environment, Wrench};
use mozzi_examples::{agree, row};
use std::error::Error;
use std::path::{Path, PathBuf};

fn main() -> Result<(), Box<dyn Error>> {
    let Some(file) = file() else {
        println!(
            "skipped: no file of Talos. `pip install example-robot-data`, then give the path of talos_reduced.urdf."
        );
        return Ok(());
    };
    let name = file.to_str().ok_or("the path is no text")?;
    let talos = mozzi_urdf::open(name)?.description.floating().build()?;
    let joints: Vec<&str> = talos.joint_names().collect();
    println!("Talos, {:.1} kg: {} joints.", talos.mass(), joints.len());

    // knees bent
    let mut theta = talos.neutral_configuration();
    theta[6] = 1.0;
    for (name, angle) in [("3", -0.4), ("4", 0.8), ("5", -0.4)] {
        for side in ["left", "right"] {
            let joint = format!("leg_{side}_{name}_joint");
            theta[7 + joints.iter().position(|known| *known == joint).ok_or("a leg's joint")?] = angle;
        }
    }
    let soles = [talos.frame("left_sole_link")?, talos.frame("right_sole_link")?];

    // g + JᵀF = 0 in the base's six rows
    let g = talos.gravity_forces(&theta)?;
    let J: Vec<DMatrix<f64>> = soles
        .iter()
        .map(|&sole| Ok(talos.body_jacobian(&theta, sole)?.matrix()))
        .collect::<Result<_, mozzi::Error>>()?;
    let grasp = DMatrix::from_fn(6, 12, |row, k| J[k / 6][(k % 6, row)]);
    let F = grasp.clone().svd(true, true).solve(&-g.rows(0, 6), 1e-12)?;
    let wrench = |k: usize| Wrench::from_array(std::array::from_fn(|i| F[6 * k + i]));
    for (k, side) in ["left", "right"].into_iter().enumerate() {
        let Wrench { m, f } = wrench(k);
        println!("  {side:5} sole presses with m = [{}] N m, f = [{}] N", row(&m.0), row(&f.0));
    }
    let pressed: f64 = (0..2).map(|k| wrench(k).f.norm()).sum();
    println!("  together {pressed:.2} N; the weight is {:.2} N\n", talos.mass() * talos.gravity().norm());

    // the motors' torques
    let applied = [(soles[0], wrench(0)), (soles[1], wrench(1))];
    let environment = Environment { applied: &applied, ..talos.environment() };
    let still = vec![0.0; talos.n()];
    let tau = talos.inverse_dynamics(&theta, &still, &still, &environment)?;
    agree("the base needs nothing more", &[tau.rows(0, 6).amax() / (talos.mass() * 9.81)], &[0.0], 1e-12);
    println!("\n{:24} {:>10} {:>8}", "joint", "τ (N m)", "limit");
    for ((joint, tau), limits) in joints.iter().zip(tau.iter().skip(6)).zip(talos.joints().map(|joint| joint.limits)) {
        if joint.starts_with("leg_left") {
            println!("{joint:24} {tau:10.3} {:8}", limits.effort.map_or("–".into(), |effort| format!("{effort}")));
        }
        if let Some(effort) = limits.effort {
            assert!(tau.abs() < effort, "{joint} can hold it");
        }
    }

    let ddtheta = talos.forward_dynamics(&theta, &still, tau.as_slice(), &environment)?;
    println!();
    agree("accelerations, over g", &[ddtheta.amax() / 9.81], &[0.0], 1e-9);
    let without = talos.forward_dynamics(&theta, &still, &still, &talos.environment())?;
    agree("with neither motors nor ground it falls at", &without.as_slice()[3..6], &[0.0, 0.0, -9.81], 1e-10);
    Ok(())
}

/// The path from the command line, or from the folder of robots.
fn file() -> Option<PathBuf> {
    let given = std::env::args_os().nth(1).map(PathBuf::from);
    let folder = || std::env::var_os("MOZZI_ROBOTS");
    given
        .or_else(|| Some(Path::new(&folder()?).join("talos_data/robots/talos_reduced.urdf")))
        .filter(|file| file.is_file())
}
