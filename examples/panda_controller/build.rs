//! Generates the arm's equations from its URDF at every build.

use mozzi::Solid;
use mozzi::quantities::{ForwardDynamics, InverseDynamics, Query};
use mozzi_engine::{Arguments, Language, Precision, emit_into};
use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=build.rs"); // and your URDF, if it is a file
    write(Path::new(&std::env::var_os("OUT_DIR").ok_or("cargo sets OUT_DIR")?))
}

/// `panda.rs`, `panda.c` and `panda.h` for the controller; `panda_loaded.*` for the arm with a load that is missing in
/// the controller's model.
pub fn write(folder: &Path) -> Result<(), Box<dyn Error>> {
    let arm = mozzi_urdf::open("panda")?.build()?.with_locked_joints(&[("panda_finger_joint1", 0.04)])?;
    let load = Solid::Sphere { radius: 0.04 }.inertia(0.5);
    let mut loaded = arm.with_payload(arm.frame("panda_hand_tcp")?, load)?.description().clone();
    loaded.name = "panda_loaded".into();
    let loaded = loaded.build()?;
    for language in [Language::Rust, Language::C] {
        let of = |robot, quantities: &[Query]| {
            emit_into(folder, robot, quantities, Arguments::default(), language, Precision::F64)
        };
        of(&arm, &[InverseDynamics.into(), ForwardDynamics.into()])?;
        of(&loaded, &[ForwardDynamics.into()])?;
    }
    Ok(())
}
