//! Derivations of embedded and written robots.

use mozzi::quantities::Query;
use mozzi_symbolic::{Derivation, Equal, Language, Options, Symbols, derive};

fn of(robot: &str, quantity: &str, options: &Options) -> Derivation {
    let text = mozzi_urdf::embedded::text(robot).expect(robot);
    let model = mozzi_urdf::parse("robot.urdf", text).expect("sound").description.build().expect("sound");
    let query = Query::named(quantity).expect(quantity);
    let query = match mozzi_urdf_frame(&query) {
        true => query.of(model.end_effector().expect("one")),
        false => query,
    };
    derive(&model, Some(text), query, options).unwrap_or_else(|error| panic!("{robot} {quantity}: {error}"))
}

fn mozzi_urdf_frame(query: &Query) -> bool {
    query.declaration().of == mozzi::quantities::Of::Frame
}

#[test]
fn look() {
    let options = Options { symbols: Symbols::ALL, equal: Equal::OfLink, ..Options::default() };
    for quantity in ["M", "c", "g", "tau", "C", "T", "J_b", "J_s", "dJ_b", "kinetic", "potential", "Y"] {
        let found = of("two_link_planar", quantity, &options);
        println!("{}", found.print(Language::Text));
        println!("{}", found.print(Language::Latex));
        println!("{:?}", found.operations());
    }
    for (robot, quantity) in [("furuta_pendulum", "M"), ("furuta_pendulum", "c")] {
        println!("{}", of(robot, quantity, &options).print(Language::Text));
        println!("{}", of(robot, quantity, &options).print(Language::Python));
        println!("{}", of(robot, quantity, &options).print(Language::Sympy));
    }
    for (robot, quantity) in [("ur5", "M"), ("panda", "g"), ("panda", "M")] {
      for names in [false, true] {
        let start = std::time::Instant::now();
        let found = of(robot, quantity, &Options { names, ..Options::default() });
        println!("{robot} {quantity} {:?} {:?}", start.elapsed(), found.operations());
      }
    }
}
