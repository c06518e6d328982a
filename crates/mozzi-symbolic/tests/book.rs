//! The planar arm of Modern Robotics, section 8.1: equations (8.9) to (8.11).

use crate::{embedded, formulas, of};
use mozzi_symbolic::{Collect, Equal, Language, Options, Symbols};

const BOOK: Options = Options { symbols: Symbols::ALL, equal: Equal::OfLink, collect: Collect::Shortest, names: false };

/// Letter by letter but for the order of g and L₂: the book writes L₁g and gL₂.
#[test]
fn the_planar_arm_is_that_of_the_book() {
    let robot = embedded("two_link_planar");
    assert_eq!(
        formulas(&of(robot, "M", &BOOK)),
        "M(θ) =\n[ m₁L₁² + m₂(L₁² + 2L₁L₂ cos θ₂ + L₂²) m₂(L₁L₂ cos θ₂ + L₂²) ]\n\
         [ m₂(L₁L₂ cos θ₂ + L₂²) m₂L₂² ]"
    );
    assert_eq!(formulas(&of(robot, "c", &BOOK)), "c(θ, θ̇) =\n[ −m₂L₁L₂ sin θ₂ (2θ̇₁θ̇₂ + θ̇₂²) ]\n[ m₂L₁L₂θ̇₁² sin θ₂ ]");
    assert_eq!(
        formulas(&of(robot, "g", &BOOK)),
        "g(θ) =\n[ (m₁ + m₂)L₁g cos θ₁ + m₂L₂g cos(θ₁ + θ₂) ]\n[ m₂L₂g cos(θ₁ + θ₂) ]"
    );
    assert_eq!(
        formulas(&of(robot, "tau", &BOOK)),
        "τ₁ = (m₁L₁² + m₂(L₁² + 2L₁L₂ cos θ₂ + L₂²))θ̈₁ + m₂(L₁L₂ cos θ₂ + L₂²)θ̈₂ \
         − m₂L₁L₂ sin θ₂ (2θ̇₁θ̇₂ + θ̇₂²) + (m₁ + m₂)L₁g cos θ₁ + m₂L₂g cos(θ₁ + θ₂)\n\
         τ₂ = m₂(L₁L₂ cos θ₂ + L₂²)θ̈₁ + m₂L₂²θ̈₂ + m₂L₁L₂θ̇₁² sin θ₂ + m₂L₂g cos(θ₁ + θ₂)"
    );
}

#[test]
fn lines_of_text_fit_a_page() {
    let numbers = Options { symbols: Symbols::NONE, ..BOOK };
    let robots =
        [("two_link_planar", "tau", BOOK), ("ur5", "g", numbers), ("ur5", "M", numbers), ("panda", "g", numbers)];
    for (robot, quantity, options) in robots {
        let text = of(embedded(robot), quantity, &options).print(Language::Text);
        let width = |line: &str| line.chars().filter(|c| !('\u{300}'..'\u{370}').contains(c)).count();
        let long = text.lines().find(|line| width(line) > 80);
        assert_eq!(long, None, "{robot}: {quantity}");
        assert!(text.lines().any(|line| line.starts_with("    ")), "{robot}: {quantity} has a broken line");
    }
}

#[test]
fn symbols_are_only_what_was_asked_for() {
    let robot = embedded("two_link_planar");
    let masses = Symbols { masses: true, ..Symbols::NONE };
    let found = of(robot, "M", &Options { symbols: masses, ..BOOK });
    assert!(formulas(&found).ends_with("[ m₂(0.2 cos θ₂ + 0.16) 0.16m₂ ]"), "{}", formulas(&found));
    let numbers = of(robot, "g", &Options { symbols: Symbols::NONE, ..BOOK });
    assert_eq!(formulas(&numbers), "g(θ) =\n[ 14.715 cos θ₁ + 3.924 cos(θ₁ + θ₂) ]\n[ 3.924 cos(θ₁ + θ₂) ]");
    // by default each number of the file is a symbol of its own
    let separate = of(robot, "M", &Options { equal: Equal::Separate, ..BOOK });
    assert!(formulas(&separate).contains("m₁r₁² + m₂(L₁² + 2L₁r₂ cos θ₂ + r₂²)"), "{}", formulas(&separate));
}

#[test]
fn velocities_are_collected_on_request() {
    let by_velocity = Options { collect: Collect::Velocities, ..BOOK };
    let found = formulas(&of(embedded("two_link_planar"), "c", &by_velocity));
    assert_eq!(found, "c(θ, θ̇) =\n[ −2m₂L₁L₂θ̇₁θ̇₂ sin θ₂ − m₂L₁L₂θ̇₂² sin θ₂ ]\n[ m₂L₁L₂θ̇₁² sin θ₂ ]");
}

#[test]
fn the_furuta_pendulum_of_exercise_8_4() {
    let robot = embedded("furuta_pendulum");
    assert_eq!(
        formulas(&of(robot, "M", &BOOK)),
        "M(θ) =\n[ (m₁ + m₂)L₁² + I₁yy + sin² θ₂ (m₂L₂² + I₂xx) −m₂L₁L₂ cos θ₂ ]\n\
         [ −m₂L₁L₂ cos θ₂ m₂L₂² + I₂xx ]"
    );
    let numbers = Options { symbols: Symbols::NONE, ..BOOK };
    let M = formulas(&of(robot, "M", &numbers));
    assert!(M.contains("[ 6 sin² θ₂ + 8 −2 cos θ₂ ]"), "{M}");
}
