//! Rotors that several joints turn, as in a coupled wrist: their friction acts on the sum of the joints' motions.

use mozzi::Model;

/// By rotor: the rotor's rate over each velocity, J of ω = J θ̇. A force of the rotor is Jᵀ of it.
pub fn rates(model: &Model) -> Vec<Vec<f64>> {
    let robot = model.description();
    let rows: Vec<(&str, usize)> =
        model.joint_names().zip(model.places()).map(|(name, place)| (name, place.j)).collect();
    let of = |rotor: &mozzi::model::description::Rotor| {
        let mut J = vec![0.0; model.n()];
        for gear in &rotor.gears {
            let Some(source) = robot.source_of(&gear.joint) else { continue };
            let name = robot.joints[source.joint].name.as_str();
            if let Some((_, row)) = rows.iter().find(|(known, _)| *known == name) {
                J[*row] += gear.ratio * source.ratio;
            }
        }
        J
    };
    robot.rotors.iter().map(of).collect()
}

/// J θ̇.
pub fn rate(J: &[f64], dtheta: &[f64]) -> f64 {
    J.iter().zip(dtheta).map(|(J, x)| J * x).sum()
}

/// The rates of all rotors at all times: J θ̇ of signals θ̇ by velocity.
pub fn signals(model: &Model, dtheta: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let N = dtheta.first().map_or(0, Vec::len);
    let at = |t: usize| dtheta.iter().map(|x| x[t]).collect::<Vec<f64>>();
    rates(model).iter().map(|J| (0..N).map(|t| rate(J, &at(t))).collect()).collect()
}
