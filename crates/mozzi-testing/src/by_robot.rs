//! The gradient of xᵀτ by the robot: the description's joints and axes moved in dual numbers, and the bodies' power
//! summed link by link.

use crate::bodies::{bodies, twist};
use crate::given::{Given, dot, list, unit, zeros};
use mozzi::model::description::JointKind;
use mozzi::model::seed_direction;
use mozzi::quantities::InverseDynamics;
use mozzi::{Base, Description, Dual, Entry, Environment, Model, SE3, Scalar, Twist, Vec3};

impl<S: Entry> Given<'_, S> {
    /// By π, by the placements, by the axes, by gravity.
    pub(crate) fn by_robot(&self, ddtheta: &[S], x: &[S]) -> Vec<Vec<S>> {
        let inputs = [self.inputs[0], self.inputs[1], ddtheta];
        let here = Given { inputs: &inputs, ..*self };
        let still = Environment { applied: &[], ..*self.environment };
        let Y = here.by_parameters(InverseDynamics.into(), &still);
        let by_pi = list(&Y.tr_mul(&crate::given::vector(x)));

        let (mut placements, mut axes) = (Vec::new(), Vec::new());
        if self.model.base() == Base::Floating {
            let [by_theta, ..] = here.tau_derivatives(ddtheta);
            let moved = |j| dot(x, &list(&by_theta.column(j).into_owned()));
            placements.extend((0..6).map(moved));
            axes.extend(zeros::<S>(6));
        }
        for name in self.moving_links() {
            let joint = self.robot.joints.iter().position(|joint| joint.child == name).expect("a joint");
            for k in 0..6 {
                let small = SE3::exp(seed(k));
                let (mut robot, model) = self.dual_robot();
                robot.joints[joint].origin = robot.joints[joint].origin * small;
                placements.push(here.power(&robot, &model, x));
                let (mut robot, _) = self.dual_robot();
                axes.push(match &mut robot.joints[joint].kind {
                    JointKind::Screw(axis) => {
                        *axis = axis.moved(small);
                        here.power(&robot, &model, x)
                    }
                    _ => <S as Scalar>::zero(),
                });
            }
        }

        let along = |k: usize| {
            let g = Vec3(std::array::from_fn(|i| <S as Scalar>::from_f64(if i == k { 1.0 } else { 0.0 })));
            let form = self.form(&zeros(self.n()), &Environment::with_gravity(g));
            dot(x, &list(&form.gravity_forces()))
        };
        vec![by_pi, placements, axes, (0..3).map(along).collect()]
    }

    /// The links that move, in the order of the model's parameters, without a floating base.
    fn moving_links(&self) -> Vec<String> {
        let floats = self.model.base() == Base::Floating;
        let names = self.model.parameter_names();
        let links = names.iter().filter_map(|name| name.strip_suffix(".mcx").map(String::from));
        links.skip(usize::from(floats)).collect()
    }

    /// The derivative of xᵀτ, less the joints' own forces: Σ (Jx)ᵀ(𝒢𝒱̇ − [ad_𝒱]ᵀ𝒢𝒱 + F) over the links of a robot in
    /// dual numbers.
    fn power(&self, robot: &Description<Dual<S>>, model: &Model<Dual<S>>, x: &[S]) -> S {
        type D<S> = Dual<Dual<S>>;
        let lift = |x: Dual<S>| D::<S>::constant(x);
        // along the motion, the outer dual number
        let moving = robot.map(lift);
        let inputs = self.inputs.iter().map(|input| Dual::constants(input)).collect::<Vec<_>>();
        let theta = seed_direction(model, &inputs[0], &inputs[1]);
        let (rates, still) = (Dual::list(&inputs[1], &inputs[2]), Dual::constants(x));
        let (V_s, dV_s) = (self.environment.base_twist, self.environment.base_acceleration);
        let dV_s = dV_s - Twist { w: Vec3::zero(), v: self.environment.gravity };
        let of_space = Twist::from_array(std::array::from_fn(|k| {
            let constant = |V: Twist<S>| Dual::constant(V.to_array()[k]);
            D { value: constant(V_s), derivative: constant(dV_s) }
        }));
        let all = bodies(&moving, &model.map(lift), &theta);
        let mut sum = <Dual<S> as Scalar>::zero();
        for body in &all {
            let V = twist(&body.J, &rates) + body.T.inverse().Ad() * of_space;
            let X = twist(&body.J, &Dual::constants(&still)).map(|x| x.value);
            let (dV, V) = (V.map(|x| x.derivative), V.map(|x| x.value));
            if let Some(G) = body.G {
                let G = G.map(|x| x.value);
                sum += X.dot(G * dV - V.ad().transpose() * (G * V));
            }
            for &(frame, F) in self.environment.applied {
                let name = self.model.frame_name(frame);
                let added = robot.frames.iter().find(|frame| frame.name == name);
                let (link, T) = added.map_or((name, SE3::identity()), |frame| (frame.link.as_str(), frame.T));
                if link == body.name {
                    sum += (T.inverse().Ad() * X).dot(F.map(Dual::constant));
                }
            }
        }
        sum.derivative
    }
}

/// The k-th unit twist, times ε.
fn seed<S: Entry>(k: usize) -> Twist<Dual<S>> {
    Twist::from_array(Dual::list(&zeros(6), &unit(6, k)).try_into().expect("six numbers"))
}
