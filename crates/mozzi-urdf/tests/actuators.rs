//! MJCF's actuators and gravity compensation, compared with MuJoCo 4.0.0.

use mozzi_sim::{Input, Options, simulate};
use mozzi_urdf::XacroArguments;
use mozzi_urdf::mjcf::{Actuated, Actuation, actuation_of};

const SERVOS: &str = r#"<mujoco model="servos">
  <compiler angle="radian"/>
  <default>
    <joint armature="0.05" damping="0.3"/>
    <position kp="30" kv="2" ctrlrange="-1 1"/>
    <default class="strong"><general gainprm="80" biasprm="1 -80 -4" forcerange="-20 20"/></default>
    <default class="fast"><velocity kv="5"/></default>
  </default>
  <worldbody>
    <body name="a" pos="0 0 1" gravcomp="0.75"><inertial pos="0.2 0.01 0" mass="2" diaginertia="0.01 0.02 0.03"/><joint name="j1" axis="0 1 0" range="-2 1.5" actuatorfrcrange="-9 9"/>
      <body name="b" pos="0.4 0 0"><inertial pos="0.15 0 0.02" mass="1" diaginertia="0.005 0.01 0.01"/><joint name="j2" axis="0 1 0"/>
        <body name="c" pos="0.3 0 0" gravcomp="1"><inertial pos="0.05 0 0" mass="0.4" diaginertia="0.001 0.001 0.001"/><joint name="j3" axis="1 0 0" range="-1 3"/>
          <body name="d" pos="0.1 0 0"><inertial pos="0.05 0 0.1" mass="0.2" diaginertia="0.001 0.001 0.001"/><joint name="s" type="slide" axis="0 0 1"/></body>
        </body>
      </body>
    </body>
  </worldbody>
  <tendon><fixed name="t"><joint joint="j2" coef="0.5"/><joint joint="j3" coef="-2"/></fixed></tendon>
  <actuator>
    <position name="p1" joint="j1" gear="2"/>
    <general name="g2" class="strong" joint="j2"/>
    <velocity name="v3" class="fast" joint="j3"/>
    <position name="pt" tendon="t" kp="7" dampratio="0.8" ctrlrange="-5 5"/>
    <position name="p3" joint="j3" kp="12" inheritrange="0.5"/>
    <motor name="ms" joint="s" gear="3"/>
    <damper name="ds" joint="s" kv="2" ctrlrange="0 1"/>
    <general name="gs" joint="s" gaintype="affine" gainprm="1 2 3" biastype="affine" biasprm="0.5 -1 -0.25"/>
  </actuator>
  <keyframe><key name="k" qpos="0.5 -0.8 0.3 0.1" qvel="0.2 -0.4 0.7 0.3" ctrl="1.7 0.4 0.6 0.2 4 0.5 0.7 0.9"/></keyframe>
</mujoco>"#;

/// `data.qfrc_actuator + data.qfrc_gravcomp` of MuJoCo 4.0.0 after `mj_forward` in the key.
const FORCES: [f64; 4] = [-6.872238202951605, 23.2732336058012, 0.158829040134783, 3.295];

fn actuation(text: &str) -> Actuation {
    actuation_of(None, "servos.xml", text.as_bytes(), &XacroArguments::default())
}

#[test]
fn actuators_have_mujocos_forces() {
    let model = mozzi_urdf::parse("servos.xml", SERVOS).expect("sound").build().expect("sound");
    let found = actuation(SERVOS);
    assert_eq!(found.left_out, [""; 0]);
    let mut input = Actuated::new(&model, &found, &found.controls["k"]).expect("its own robot");
    let (key, mut tau) = (model.state("k").expect("a key"), [0.0; 4]);
    input.add_forces(&key.theta, &key.dtheta, &mut tau);
    for (tau, expected) in tau.iter().zip(FORCES) {
        assert!((tau - expected).abs() < 1e-11, "{tau} {expected}");
    }
    // ∂τ/∂θ̇ of the gains, by differences, where nothing is clamped
    let [mut stiffness, mut damping] = [[0.0; 4]; 2];
    input.gains(&mut stiffness, &mut damping);
    let (e, mut moved) = (1e-6, key.dtheta.clone());
    moved[2] += e;
    let mut more = [0.0; 4];
    input.add_forces(&key.theta, &moved, &mut more);
    assert!(((tau[2] - more[2]) / e - damping[2]).abs() < 1e-6, "{} {}", (tau[2] - more[2]) / e, damping[2]);
}

struct Driven(Actuated);
impl Input for Driven {
    fn torque(&mut self, _: f64, theta: &[f64], dtheta: &[f64], tau: &mut [f64]) -> Result<(), mozzi_sim::Error> {
        self.0.add_forces(theta, dtheta, tau);
        Ok(())
    }
    fn gains(&self, stiffness: &mut [f64], damping: &mut [f64]) {
        self.0.gains(stiffness, damping);
    }
}

#[test]
fn a_held_pose_holds() {
    // position actuators at the pose's own controls; the weight of one of the two links is compensated
    let text = SERVOS.replace("ctrl=\"1.7 0.4 0.6 0.2 4 0.5 0.7 0.9\"", "ctrl=\"0.5 -0.8\"").replace("qvel", "user");
    let start = text.find("<actuator>").expect("there");
    let end = text.find("</actuator>").expect("there");
    let drives = "<actuator><position joint='j1' kp='2000' kv='90'/><position joint='j2' kp='2000' kv='90'/>";
    let text = format!("{}{drives}{}", &text[..start], &text[end..]).replace(" user=\"0.2 -0.4 0.7 0.3\"", "");
    let text = text.replace("actuatorfrcrange=\"-9 9\"", "");
    let model = mozzi_urdf::parse("held.xml", &text).expect("sound").build().expect("sound");
    let found = actuation(&text);
    let key = model.state("k").expect("a key");
    let options = Options::new(1.0, 1000);
    let at = |controls: &[f64]| {
        let input = Driven(Actuated::new(&model, &found, controls).expect("its own robot"));
        let motion = simulate(&model, &key.theta, &key.dtheta, input, &options).expect("a motion");
        motion.last().theta.to_vec()
    };
    let held = at(&found.controls["k"]);
    assert!((held[0] - 0.5).abs() < 0.02 && (held[1] + 0.8).abs() < 0.02, "{held:?}");
    let other = at(&[0.6, -0.8]);
    assert!((other[0] - 0.6).abs() < 0.02, "{other:?}");
}

/// Gains and biases of MuJoCo 4.0.0 for an element after a default of another kind.
#[test]
fn a_default_of_one_kind_is_not_that_of_another() {
    for (default, element, gain, bias) in [
        ("<position kp='7' kv='3'/>", "position", [7.0, 0.0, 0.0], [0.0, -7.0, -3.0]),
        ("<position kp='7' kv='3'/>", "velocity", [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]),
        ("<position kp='7' kv='3'/>", "motor", [1.0, 0.0, 0.0], [0.0; 3]),
        ("<position kp='7' kv='3'/>", "general", [7.0, 0.0, 0.0], [0.0, -7.0, -3.0]),
        ("<velocity kv='2'/>", "position", [1.0, 0.0, 0.0], [0.0, -1.0, 0.0]),
        ("<velocity kv='2'/>", "general", [2.0, 0.0, 0.0], [0.0, 0.0, -2.0]),
        ("<general gainprm='5' biasprm='1 -4 -3' biastype='affine'/>", "position", [5.0, 0.0, 0.0], [0.0, -5.0, -3.0]),
        ("<general gainprm='5' biasprm='1 -4 -3' biastype='affine'/>", "velocity", [5.0, 0.0, 0.0], [0.0, 0.0, -5.0]),
        ("<damper kv='2'/>", "damper", [0.0, 0.0, -2.0], [0.0; 3]),
    ] {
        let text = format!(
            "<mujoco><default>{default}</default><worldbody><body><joint name='h'/><geom size='1'/></body></worldbody>\
             <actuator><{element} joint='h'/></actuator></mujoco>"
        );
        let found = actuation(&text);
        let one = found.actuators[0].as_ref().expect(element);
        assert_eq!((one.gain, one.bias), (gain, bias), "{default} {element}");
    }
}

/// The damping of MuJoCo 4.0.0, −biasprm[2], of a joint, of one that follows it, and of a tendon.
#[test]
fn damping_ratios_are_of_independent_joints() {
    let body = |name: &str, at: &str, reference: &str, inside: &str| {
        format!(
            "<body name='{name}' pos='{at} 0 0'><joint name='j{name}' axis='0 1 0' ref='{reference}'/><geom \
             type='box' size='0.05 0.02 0.01' pos='0.1 0 0.05' mass='1'/>{inside}</body>"
        )
    };
    let tree = body("a", "0", "0.3", &body("b", "0.2", "-0.4", &body("c", "0.2", "0.7", "")));
    let text = format!(
        "<mujoco><compiler angle='radian'/><worldbody>{tree}</worldbody><equality><joint joint1='jb' joint2='ja' \
         polycoef='0.2 1 0 0 0'/></equality><tendon><fixed name='t'><joint joint='jb' coef='2'/><joint joint='jc' \
         coef='-3'/></fixed></tendon><actuator><position joint='ja' kp='100' dampratio='1'/><position joint='jb' \
         gear='2' kp='100' dampratio='0.5'/><position tendon='t' kp='50' dampratio='0.7'/></actuator></mujoco>"
    );
    let found = actuation(&text);
    for (one, damping) in
        found.actuators.iter().flatten().zip([3.1531743569589543, 0.31475577606520955, 0.10873993649208184])
    {
        assert!((one.bias[2] + damping).abs() < 1e-12 * damping, "{}: {} {damping}", one.name, one.bias[2]);
    }
}

#[test]
fn groups_that_are_disabled_do_not_act() {
    let text = "<mujoco><option actuatorgroupdisable='3'/><worldbody><body><joint name='h' actuatorfrcrange='-.3 .2'/>\
                <geom size='1'/></body></worldbody><tendon><fixed name='t' actuatorfrcrange='-1 1'><joint joint='h' \
                coef='1'/></fixed></tendon><actuator><motor joint='h'/><motor joint='h' group='3'/><motor name='u' \
                tendon='t'/></actuator></mujoco>";
    let found = actuation(text);
    assert_eq!(found.actuators.iter().map(Option::is_some).collect::<Vec<_>>(), [true, false, false]);
    assert!(found.left_out[0].contains("`u`: drives tendon `t`, which clamps its actuators' force"), "{found:?}");
    let warnings = format!("{:?}", mozzi_urdf::parse("a.xml", text).expect("sound").warnings);
    assert!(warnings.contains("an uneven bound of the actuators' force"), "{warnings}");
}

#[test]
fn what_is_not_computed_is_named() {
    let text = "<mujoco><worldbody><body><joint name='h'/><geom size='1'/><site name='here'/><body><joint name='ball' \
                type='ball'/><geom size='1'/></body></body></worldbody><actuator><motor name='a' site='here'/>\
                <muscle name='b' joint='h'/><intvelocity name='c' joint='h'/><position name='d' joint='ball'/>\
                <general name='e' joint='h' gaintype='user'/><position name='f' joint='h' timeconst='0.1'/>\
                <motor name='g' joint='h'/></actuator><keyframe><key ctrl='1 2'/></keyframe></mujoco>";
    let found = actuation(text);
    let expected = [
        ("a", "drives a site"),
        ("b", "is of the kind `muscle`"),
        ("c", "has a state of its own, `integrator`"),
        ("d", "drives joint `ball`, which has several axes"),
        ("e", "has a gain of the type `user`"),
        ("f", "has a state of its own, `filterexact`"),
    ];
    for ((name, why), line) in expected.iter().zip(&found.left_out) {
        assert_eq!(*line, format!("actuator `{name}`: {why}, which is not computed"));
    }
    assert_eq!(found.left_out[6], "key `key0`: ctrl: is `1 2`, expected 7 numbers; it is not used");
    assert_eq!((found.actuators.len(), found.actuators.iter().flatten().count()), (7, 1));
    // a switch of the whole actuation
    let off = text.replace("<mujoco>", "<mujoco><option><flag actuation='disable'/></option>");
    assert_eq!(actuation(&off), Actuation::default());
    // attributes are checked as everywhere
    let misspelt = text.replace("timeconst", "timeconts");
    let error = mozzi_urdf::parse("a.xml", misspelt).expect_err("a misspelling").to_string();
    assert!(error.contains("did you mean `timeconst`") || error.contains("timeconts"), "{error}");
}

/// A `gravcomp` below 0 adds weight, beside one above 0.
#[test]
fn gravity_compensation_may_be_negative() {
    let force = |part: &str| {
        let text = SERVOS.replace(r#"gravcomp="0.75""#, &format!(r#"gravcomp="{part}""#));
        let model = mozzi_urdf::parse("servos.xml", &text).expect("sound").build().expect("sound");
        let mut input = Actuated::new(&model, &actuation(&text), &[]).expect("its own robot");
        let mut tau = [0.0; 4];
        input.add_forces(&model.neutral_configuration::<f64>(), &[0.0; 4], &mut tau);
        tau[0]
    };
    let weight = 2.0 * 9.81 * 0.2;
    let found = force("-0.5") - force("0.5");
    assert!((found - weight).abs() < 1e-12, "{found}, expected {weight}");
}
