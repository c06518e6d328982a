//! Printed equations are not longer than those of textbooks, which are the same functions.

use crate::robots::{all, chain, moved};
use crate::{model, of};
use mozzi_symbolic::{Language, Options, Symbols};
use std::collections::BTreeMap;

/// M on and above the diagonal, row by row, c and g, with the source's abbreviations; a, b, c … are rates of joints
/// 1, 2, 3 …, s1 is sin θ₁, c23 is cos(θ₂ + θ₃), s2x2 is sin 2θ₂. Axes may point the other way: signs alone differ.
struct Published {
    robot: &'static str,
    source: &'static str,
    names: &'static [(&'static str, &'static str)],
    equations: [&'static [&'static str]; 3],
}

const PUBLISHED: [Published; 6] = [
    Published {
        robot: "RR",
        source: "Spong, Hutchinson and Vidyasagar 2006, section 7.3",
        names: &[("h", "-m2*L1*r2*s2")],
        equations: [
            &[
                "m1*r1*r1 + m2*(L1*L1 + r2*r2 + 2*L1*r2*c2) + I1y + I2y",
                "m2*(r2*r2 + L1*r2*c2) + I2y",
                "m2*r2*r2 + I2y",
            ],
            &["h*(2*a*b + b*b)", "-h*a*a"],
            &["(m1*r1 + m2*L1)*g*c1 + m2*r2*g*c12", "m2*r2*g*c12"],
        ],
    },
    Published {
        robot: "RP",
        source: "Craig 2005, example 6.5",
        names: &[],
        equations: [
            &["m1*r1*r1 + I1y + I2y + m2*q2*q2", "0", "m2"],
            &["2*m2*q2*a*b", "-m2*q2*a*a"],
            &["(m1*r1 + m2*q2)*g*c1", "m2*g*s1"],
        ],
    },
    Published {
        robot: "cart-pole",
        source: "Tedrake, Underactuated Robotics, section 3.2",
        names: &[],
        equations: [&["m1 + m2", "m2*r2*c2", "m2*r2*r2"], &["-m2*r2*b*b*s2", "0"], &["0", "-m2*g*r2*s2"]],
    },
    Published {
        robot: "Furuta",
        source: "Cazzolato and Prime 2011, with full inertia tensors",
        names: &[],
        equations: [
            &["I1z + m1*r1*r1 + m2*L1*L1 + (I2y + m2*r2*r2)*s2*s2 + I2z*c2*c2", "-m2*L1*r2*c2", "m2*r2*r2 + I2x"],
            &["a*b*s2x2*(m2*r2*r2 + I2y - I2z) + m2*L1*r2*s2*b*b", "-0.5*a*a*s2x2*(m2*r2*r2 + I2y - I2z)"],
            &["0", "-g*m2*r2*s2"],
        ],
    },
    Published {
        robot: "SCARA",
        source: "Murray, Li and Sastry 1994, section 4.3",
        names: &[
            ("alpha", "I1z + r1*r1*m1 + L1*L1*m2 + L1*L1*m3 + L1*L1*m4"),
            ("beta", "I2z + I3z + I4z + L2*L2*m3 + L2*L2*m4 + m2*r2*r2"),
            ("gamma", "L1*L2*m3 + L1*L2*m4 + L1*m2*r2"),
            ("delta", "I3z + I4z"),
        ],
        equations: [
            &["alpha + beta + 2*gamma*c2", "beta + gamma*c2", "delta", "0", "beta", "delta", "0", "delta", "0", "m4"],
            &["-gamma*s2*b*a - gamma*s2*(a + b)*b", "gamma*s2*a*a", "0", "0"],
            &["0", "0", "0", "-m4*g"],
        ],
    },
    Published {
        robot: "elbow",
        source: "Murray, Li and Sastry 1994, example 4.3",
        names: &[
            ("G112", "(I2y - I2z - m2*r2*r2)*c2*s2 + (I3y - I3z)*c23*s23 - m3*(L2*c2 + r3*c23)*(L2*s2 + r3*s23)"),
            ("G113", "(I3y - I3z)*c23*s23 - m3*r3*s23*(L2*c2 + r3*c23)"),
            ("G211", "(I2z - I2y + m2*r2*r2)*c2*s2 + (I3z - I3y)*c23*s23 + m3*(L2*c2 + r3*c23)*(L2*s2 + r3*s23)"),
            ("G223", "-L2*m3*r3*s3"),
            ("G311", "(I3z - I3y)*c23*s23 + m3*r3*s23*(L2*c2 + r3*c23)"),
        ],
        equations: [
            &[
                "I2y*s2*s2 + I3y*s23*s23 + I1z + I2z*c2*c2 + I3z*c23*c23 + m2*r2*r2*c2*c2 + m3*(L2*c2 + r3*c23)*(L2*c2 + r3*c23)",
                "0",
                "0",
                "I2x + I3x + m3*L2*L2 + m2*r2*r2 + m3*r3*r3 + 2*m3*L2*r3*c3",
                "I3x + m3*r3*r3 + m3*L2*r3*c3",
                "I3x + m3*r3*r3",
            ],
            &["2*G112*a*b + 2*G113*a*c", "G211*a*a + 2*G223*b*c + G223*c*c", "G311*a*a - G223*b*b"],
            &["0", "-(m2*g*r2 + m3*g*L2)*c2 - m3*r3*g*c23", "-m3*g*r3*c23"],
        ],
    },
];

/// The waist, shoulder and elbow of Murray, Li and Sastry: positive angles lower the arm.
fn elbow() -> String {
    chain(
        "elbow",
        &[
            moved("continuous", "0 0 1", "0 0 0", "2.1", "0 0 0.31", ["0.011", "0.013", "0.017"]),
            moved("continuous", "-1 0 0", "0 0 0.61", "1.3", "0 0.23 0", ["0.007", "0.019", "0.021"]),
            moved("continuous", "-1 0 0", "0 0.53 0", "0.8", "0 0.12 0", ["0.003", "0.009", "0.01"]),
        ],
    )
}

/// A product of sums, read once for its value and for its additions and products, as the printer counts them.
struct Reader<'a> {
    rest: &'a str,
    values: &'a BTreeMap<String, f64>,
    operations: usize,
    used: Vec<&'a str>,
}

impl<'a> Reader<'a> {
    fn eats(&mut self, sign: char) -> bool {
        self.rest = self.rest.trim_start();
        self.rest.strip_prefix(sign).map(|rest| self.rest = rest).is_some()
    }

    fn sum(&mut self) -> f64 {
        let mut value = if self.eats('-') { -self.product() } else { self.product() };
        loop {
            let sign = match (self.eats('+'), self.eats('-')) {
                (true, _) => 1.0,
                (_, true) => -1.0,
                _ => return value,
            };
            self.operations += 1;
            value += sign * self.product();
        }
    }

    fn product(&mut self) -> f64 {
        let mut value = self.factor();
        while self.eats('*') {
            self.operations += 1;
            value *= self.factor();
        }
        value
    }

    fn factor(&mut self) -> f64 {
        if self.eats('(') {
            let value = self.sum();
            assert!(self.eats(')'), "{}", self.rest);
            return value;
        }
        let end = self.rest.find(|c: char| !c.is_alphanumeric() && c != '.').unwrap_or(self.rest.len());
        let (word, rest) = self.rest.split_at(end);
        self.rest = rest;
        self.used.push(word);
        word.parse().unwrap_or_else(|_| *self.values.get(word).unwrap_or_else(|| panic!("`{word}`")))
    }
}

/// The value of a text, and its operations, with those of the abbreviations at each place where they stand.
fn read(text: &str, values: &BTreeMap<String, f64>, names: &BTreeMap<&str, usize>) -> (f64, usize) {
    let mut reader = Reader { rest: text, values, operations: 0, used: Vec::new() };
    let value = reader.sum();
    assert!(reader.rest.trim().is_empty(), "{text}: `{}` is left", reader.rest);
    (value, reader.operations + reader.used.iter().filter_map(|word| names.get(word)).sum::<usize>())
}

/// The values of the equations' words at a state.
fn values(model: &mozzi::Model, theta: &[f64], dtheta: &[f64]) -> BTreeMap<String, f64> {
    let mut values = BTreeMap::from([("g".to_string(), model.gravity().norm())]);
    let mut add = |name: String, value: f64| values.insert(name, value);
    let description = model.description();
    for (i, link) in description.links.iter().filter(|link| link.inertia.mass > 0.0).enumerate() {
        let i = i + 1;
        add(format!("m{i}"), link.inertia.mass);
        add(format!("r{i}"), link.inertia.center_of_mass().norm());
        let moments = link.inertia.about_center_of_mass();
        add(format!("I{i}x"), moments.xx);
        add(format!("I{i}y"), moments.yy);
        add(format!("I{i}z"), moments.zz);
    }
    for (i, joint) in description.joints.iter().enumerate() {
        add(format!("L{i}"), joint.origin.p.norm());
    }
    for (i, (q, rate)) in theta.iter().zip(dtheta).enumerate() {
        add(format!("q{}", i + 1), *q);
        add(["a", "b", "c", "d"][i].to_string(), *rate);
    }
    for (name, angle) in [("1", theta[0]), ("2", theta[1]), ("12", theta[0] + theta[1]), ("2x2", 2.0 * theta[1])] {
        add(format!("s{name}"), angle.sin());
        add(format!("c{name}"), angle.cos());
    }
    if let [_, second, third, ..] = theta {
        for (name, angle) in [("3", *third), ("23", second + third)] {
            add(format!("s{name}"), angle.sin());
            add(format!("c{name}"), angle.cos());
        }
    }
    values
}

#[test]
fn equations_are_not_longer_than_published_ones() {
    let mut robots = all();
    robots.push(("elbow", elbow()));
    for published in PUBLISHED {
        let name = published.robot;
        let (_, text) = robots.iter().find(|(other, _)| *other == name).expect(name);
        let model = model(text);
        let (theta, dtheta) = ([0.37, -0.81, 1.23, 0.4], [0.7, -1.3, 0.9, 0.6]);
        let n = model.n();
        let (theta, dtheta) = (&theta[..n], &dtheta[..n]);
        let mut values = values(&model, theta, dtheta);
        let mut names = BTreeMap::new();
        for (name, text) in published.names {
            let (value, operations) = read(text, &values, &names);
            values.insert(name.to_string(), value);
            names.insert(*name, operations);
        }
        let M = model.mass_matrix(theta).expect("sound");
        let upper: Vec<f64> = (0..n).flat_map(|i| (i..n).map(move |j| (i, j))).map(|entry| M[entry]).collect();
        let c = model.velocity_product(theta, dtheta).expect("sound");
        let g = model.gravity_forces(theta).expect("sound");
        let expected = [upper, c.as_slice().to_vec(), g.as_slice().to_vec()];
        for ((quantity, equations), expected) in ["M", "c", "g"].into_iter().zip(published.equations).zip(expected) {
            assert_eq!(equations.len(), expected.len(), "{name} {quantity}");
            let mut most = 0;
            for (equation, expected) in equations.iter().zip(expected) {
                let (value, operations) = read(equation, &values, &names);
                assert!((value - expected).abs() < 1e-12, "{name} {quantity}: {equation} is {value}, not {expected}");
                most += operations;
            }
            let options = Options { symbols: Symbols::ALL, names: false, ..Options::default() };
            let found = of(text, quantity, &options);
            let count = found.operations().total();
            println!("{name} {quantity}: {count} operations, {most} in {}", published.source);
            assert!(count <= most, "{}", found.print(Language::Text));
        }
    }
}
