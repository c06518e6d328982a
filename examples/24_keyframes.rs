//! Keyframes of a model in MJCF: a stone above a table and an arm, started from the states in the file.
//!
//! MuJoCo starts at `qpos0`, the pose of the bodies in the file, even if there is a keyframe `home`; so does mozzi. A
//! keyframe is a named state: its `qpos` and `qvel` are converted to θ and θ̇, the stone's quaternion first and its
//! velocity in its own axes.

use mozzi::model::State;
use mozzi_examples::{agree, row};
use mozzi_sim::{Options, Zero};
use std::error::Error;

const MODEL: &str = "
<mujoco model='stone and arm'>
  <worldbody>
    <body name='stone' pos='1 0 2'><freejoint name='fall'/><geom size='0.1' mass='2'/></body>
    <body name='arm' pos='0 0 1'><joint name='elbow' axis='0 1 0' ref='90'/><geom size='0.1' pos='0.3 0 0' mass='1'/></body>
  </worldbody>
  <keyframe>
    <key name='home' qpos='1 0 1 1 0 0 0 0'/>
    <key name='thrown' qpos='1 0 1 0 0 1 0 0' qvel='-1 0 3 0 0 2 0'/>
  </keyframe>
</mujoco>";

fn main() -> Result<(), Box<dyn Error>> {
    let model = mozzi_urdf::parse("stone.xml", MODEL)?.build()?;
    let stone = model.frame("stone")?;
    for name in model.state_names() {
        println!("{name:>7}: θ = {}", row(&model.state(name)?.theta));
    }

    // the pose in the file: the stone at z = 2, the elbow at its `ref`
    let start = model.start();
    agree(
        "the stone starts where the file puts it",
        &model.forward_kinematics(&start.theta, stone)?.p.0,
        &[1.0, 0.0, 2.0],
        1e-15,
    );

    // thrown upside down: the key's velocity is the world's, and so is the flight
    let thrown = model.state("thrown")?;
    let time = 0.4;
    let flight = mozzi_sim::simulate(&model, &thrown.theta, &thrown.dtheta, Zero, &Options::new(time, 400))?;
    let found = model.forward_kinematics(flight.last().theta, stone)?.p.0;
    let expected = [1.0 - time, 0.0, 1.0 + 3.0 * time - 0.5 * 9.81 * time * time];
    agree("a throw is a parabola", &found, &expected, 1e-9);

    // a user-defined state, and an edit of the robot
    let end = flight.last();
    let state = State { time, theta: end.theta.to_vec(), dtheta: end.dtheta.to_vec() };
    let landed = model.with_state("landed", &state)?;
    let without_elbow = landed.with_locked_joints(&[("elbow", 0.3)])?;
    let again =
        without_elbow.forward_kinematics(&without_elbow.state("landed")?.theta, without_elbow.frame("stone")?)?;
    agree("states stay with the joints that are left", &again.p.0, &found, 1e-15);
    Ok(())
}
