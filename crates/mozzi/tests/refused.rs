//! Refusals and their words: descriptions that cannot be built, impossible edits, wrong arguments.

use mozzi::model::description::{
    Anchor, Closure, Constraint, ConstraintKind, Gear, Joint, JointKind, JointState, Mimic, NamedState,
};
use mozzi::model::{Bounds, Error, HomeFrames, Screws};
use mozzi::{Base, Description, Model, SE3, SO3, ScrewAxis, SpatialInertia, Sym3, Vec3};

fn turn() -> JointKind {
    JointKind::Screw(ScrewAxis::new([0.0, 1.0, 0.0], [0.0; 3]).unwrap())
}

fn body() -> SpatialInertia {
    SpatialInertia::new(1.0, Vec3([0.1, 0.0, 0.0]), Sym3::diagonal(0.1, 0.1, 0.1))
}

fn at(x: f64) -> SE3 {
    SE3::translation([x, 0.0, 0.0])
}

/// A trunk with an arm of two joints, a thumb that follows the first of them, a ball and a plate that is fixed.
fn robot() -> Description {
    let thumb = Mimic { joint: "shoulder".into(), ratio: 0.5, offset: 0.0 };
    let links = ["trunk", "upper", "fore", "thumb", "eye", "plate"];
    links
        .into_iter()
        .fold(Description::new("r"), |robot, name| robot.link(name, body()))
        .joint(Joint::new("shoulder", "trunk", "upper", at(0.0), turn()))
        .joint(Joint::new("elbow", "upper", "fore", at(0.4), turn()))
        .joint(Joint { mimic: Some(thumb), ..Joint::new("knuckle", "trunk", "thumb", at(0.1), turn()) })
        .joint(Joint::new("gaze", "trunk", "eye", at(0.2), JointKind::Ball(Vec3::zero())))
        .joint(Joint::new("screws", "trunk", "plate", at(0.3), JointKind::Fixed))
}

fn model() -> Model {
    robot().build().unwrap()
}

fn refuses(words: &str, edit: impl FnOnce(&mut Description)) {
    let mut robot = robot();
    edit(&mut robot);
    let said = robot.build().expect_err(words).to_string();
    assert!(said.contains(words), "{said}\nexpected: {words}");
}

fn says<T>(result: Result<T, Error>, words: &str) {
    let Err(error) = result else { panic!("accepted, expected: {words}") };
    let said = error.to_string();
    assert!(said.contains(words), "{said}\nexpected: {words}");
}

fn gear(joint: &str, ratio: f64) -> Gear {
    Gear { joint: joint.into(), ratio }
}

fn sum(joints: Vec<Gear>, source: Vec<Gear>, polynomial: [f64; 5]) -> Constraint {
    Constraint { name: "sum".into(), kind: ConstraintKind::Joint { joints, source, polynomial } }
}

#[test]
fn numbers_that_are_none() {
    refuses("gravity: is [0.0, NaN, -9.81], expected finite", |robot| robot.gravity[1] = f64::NAN);
    refuses("not finite", |robot| robot.joints[0].origin = at(f64::INFINITY));
    refuses("is a ball at [NaN, 0.0, 0.0]", |r| r.joints[3].kind = JointKind::Ball(Vec3([f64::NAN, 0.0, 0.0])));
    refuses("go from 1 to -1, expected the lower bound first", |r| r.joints[0].limits.position = Some([1.0, -1.0]));
    refuses("expected none for a free joint", |robot| {
        robot.joints[3].kind = JointKind::Free;
        robot.joints[3].limits.position = Some([0.0, 1.0]);
    });
    refuses("ratio NaN and offset 0, expected finite", |robot| {
        robot.joints[2].mimic = Some(Mimic { joint: "shoulder".into(), ratio: f64::NAN, offset: 0.0 });
    });
    refuses("not finite", |r| *r = r.clone().frame("tool", "fore", at(f64::NAN)));
    refuses("there is no link `for`", |r| *r = r.clone().frame("tool", "for", at(0.1)));
    refuses("there is no link or frame `tol`", |robot| robot.end_effector = Some("tol".into()));
}

#[test]
fn constraints_and_motors_of_nothing() {
    let hold = |robot: &mut Description, one: Constraint| robot.constraints.push(one);
    let flat = [0.0; 5];
    refuses("is [0.0, NaN, 0.0, 0.0, 0.0], expected finite", |robot| {
        hold(robot, sum(vec![gear("elbow", 1.0)], vec![], [0.0, f64::NAN, 0.0, 0.0, 0.0]));
    });
    refuses("is missing, expected the joint that is held", |robot| hold(robot, sum(vec![], vec![], flat)));
    refuses("`elbo` does not exist", |robot| hold(robot, sum(vec![gear("elbo", 1.0)], vec![], flat)));
    refuses("a ball joint, expected a joint of one axis", |r| hold(r, sum(vec![gear("gaze", 1.0)], vec![], flat)));
    refuses("is -1 m, expected a positive", |r| {
        hold(r, Constraint::new("rod", "fore", Anchor::world(at(1.0)), Closure::Distance(-1.0)));
    });
    refuses("numbers that are not finite", |r| {
        hold(r, Constraint::point("pin", "fore", Anchor::world(at(f64::NAN))));
    });
    refuses("`plate` and `trunk` are fixed to each other", |r| hold(r, Constraint::weld("w", "plate", "trunk")));
    refuses("hold `screws`, a fixed joint", |robot| robot.motors = Some(vec!["screws".into()]));
    refuses("hold `knuckle`, a mimic joint", |robot| robot.motors = Some(vec!["knuckle".into()]));
    refuses("`screws` is fixed, expected joints that move", |robot| {
        let joint = JointState { name: "screws".into(), positions: vec![], velocities: vec![] };
        robot.states.push(NamedState { name: "home".into(), time: 0.0, base: None, joints: vec![joint] });
    });
}

#[test]
fn joints_that_cannot_be_locked() {
    let lock = |name: &str, position| model().with_locked_joints(&[(name, position)]);
    says(lock("knuckle", 0.0), "`knuckle`, which follows `shoulder`");
    says(lock("elbow", f64::NAN), "NaN for `elbow`");
    says(lock("gaze", 0.0), "`gaze`, a ball joint");
    assert_eq!(lock("shoulder", 0.3).unwrap().n(), 4, "its mimic joint with it");
}

#[test]
fn chains_that_are_tied_to_others() {
    let (from, to) = (|model: &Model| model.frame("trunk").unwrap(), |model: &Model| model.frame("fore").unwrap());
    let chain = |model: Model| model.sub_chain(from(&model), to(&model));
    assert_eq!(chain(model()).unwrap().n(), 2);
    let thumb = model().sub_chain(from(&model()), model().frame("thumb").unwrap());
    says(thumb, "`knuckle`, which follows `shoulder` off the path");
    let geared = model().with_rotor("belt", 0.1, &[("elbow", 2.0), ("knuckle", 1.0)]).unwrap();
    says(chain(geared), "`belt`, which `knuckle` off the path turns, too");
    let inside = model().with_rotor("belt", 0.1, &[("elbow", 2.0), ("shoulder", 1.0)]).unwrap();
    assert_eq!(chain(inside).unwrap().description().rotors.len(), 1);
    let held = |one: Constraint| chain(model().with_constraints([one]).unwrap());
    says(
        held(Constraint::point("rod", "fore", Anchor::frame("eye").at(at(0.5)))),
        "`rod`, which holds {s} or a part off",
    );
    says(
        held(sum(vec![gear("elbow", 1.0)], vec![gear("knuckle", 1.0)], [0.0; 5])),
        "`sum`, which holds {s} or a part off",
    );
    let pinned = held(Constraint::point("pin", "fore", Anchor::world(at(0.6)))).unwrap();
    assert_eq!(pinned.description().constraints.len(), 1);
    // {s} is that of the base: a part that begins elsewhere has another one
    let arm = |one: Constraint| {
        let model = model().with_constraints([one]).unwrap();
        model.sub_chain(model.frame("upper").unwrap(), to(&model))
    };
    says(arm(Constraint::point("pin", "fore", Anchor::world(at(0.6)))), "`pin`, which holds {s} or a part off");
    assert!(
        arm(Constraint::point("pin", "thumb", Anchor::world(at(0.6)))).unwrap().description().constraints.is_empty()
    );
    assert!(pinned.without_constraints().unwrap().description().constraints.is_empty());
}

#[test]
fn screws_without_numbers() {
    says(model().screws(), "`gaze`, a ball joint");
    let made = |place: f64, mass: f64| {
        let inertia = SpatialInertia { mass, ..body() };
        let axes = [ScrewAxis::new([0.0, 0.0, 1.0], [0.0; 3]).unwrap()];
        let frames = [at(place), at(1.0)];
        Model::from_screws("arm", HomeFrames::Base(&frames), &[inertia], Screws::Space(&axes))
    };
    assert_eq!(made(0.5, 1.0).unwrap().n(), 1);
    says(made(f64::NAN, 1.0), "not finite in number 1");
    says(made(0.5, f64::INFINITY), "not finite in number 1");
}

#[test]
fn arguments_of_constrained_motions() {
    let pin = Constraint::point("pin", "fore", Anchor::world(at(0.6)));
    let model = model().with_constraints([pin]).unwrap();
    let (theta, rates) = (model.neutral_configuration(), vec![0.0; model.n()]);
    let of = |weights: &[f64]| {
        model.constrained_inverse_dynamics(&theta, &rates, &rates, &model.environment(), Some(weights))
    };
    says(of(&[1.0]), "weights");
    says(of(&[1.0, -1.0, 1.0, 1.0, 1.0]), "-1 for `elbow`");
    says(model.constraint_wrenches(&theta, &[1.0]), "lambda");
}

#[test]
fn matrices_that_are_no_configurations() {
    let mut rows = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];
    assert_eq!(SE3::from_rounded_matrix(rows).unwrap(), SE3::identity());
    rows[0][0] = 1.0 + 1e-7; // of float32
    assert_eq!(SE3::from_rounded_matrix(rows).unwrap().R, SO3::identity());
    rows[0][0] = 1.2;
    assert!(SE3::from_rounded_matrix(rows).unwrap_err().to_string().contains("not a rotation"));
    (rows[0][0], rows[3][0]) = (1.0, 0.5);
    let said = SE3::from_rounded_matrix(rows).unwrap_err().to_string();
    assert!(said.contains("the last row is [0.5, 0.0, 0.0, 1.0]"), "{said}");
}

#[test]
fn a_mimic_joints_limits_are_those_of_its_source() {
    let mut robot = robot();
    robot.joints[2].limits.position = Some([-0.1, 0.2]);
    assert_eq!(Bounds::of(&robot.clone().build().unwrap()).joints[0], [-0.2, 0.4]);
    robot.joints[0].limits.position = Some([0.5, 1.0]); // which keep it outside of its own
    assert_eq!(Bounds::of(&robot.build().unwrap()).joints[0], [0.5, 1.0]);
    assert_eq!(model().base(), Base::Fixed);
}
