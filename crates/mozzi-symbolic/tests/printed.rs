//! The other forms: LaTeX with matching braces, Python that computes, long robots in time.

use crate::robots::all;
use crate::{embedded, of};
use mozzi_symbolic::{Language, Options, Symbols, print_all};
use pulldown_latex::{Parser, Storage};
use std::process::Command;
use std::time::Instant;

fn options(symbols: Symbols, names: bool) -> Options {
    Options { symbols, names, ..Options::default() }
}

/// Reads each formula; the number of them.
fn check_latex(page: &str) -> usize {
    let mut count = 0;
    for piece in page.split(r"\[").skip(1) {
        let (formula, _) = piece.split_once(r"\]").expect("closed");
        let storage = Storage::new();
        for event in Parser::new(formula, &storage) {
            event.unwrap_or_else(|error| panic!("{error}\n{formula}"));
        }
        count += 1;
    }
    count
}

/// A typesetter of its own reads every formula; TeX does, too, but is large.
#[test]
fn latex_is_typeset() {
    let mut count = 0;
    let mut check = |robot: &str, text: &str, quantity: &str, options: &Options| {
        let page = of(text, quantity, options).print(Language::Latex);
        assert!(page.is_ascii(), "{page}");
        println!("{robot} {quantity}");
        count += check_latex(&page);
    };
    for (name, text) in all() {
        for quantity in ["M", "C", "c", "g", "tau", "T", "J_b", "kinetic_energy", "M_inv"] {
            check(name, &text, quantity, &options(Symbols::ALL, true));
        }
    }
    for quantity in ["M", "g", "J_b", "J_s"] {
        check("ur5", embedded("ur5"), quantity, &options(Symbols::NONE, true));
    }
    assert!(count > 85, "{count} formulas");
}

/// Names of links that differ in signs alone are different symbols in code; TeX gets them as text.
#[test]
fn links_keep_their_own_symbols() {
    let link = |name: &str, mass: &str| {
        format!(
            "<link name=\"{name}\"><inertial><origin xyz=\"0.{mass} 0 0\"/><mass value=\"{mass}\"/><inertia ixx=\"0\" \
             iyy=\"0\" izz=\"0\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link>"
        )
    };
    let on = |child: &str, kind: &str, parent: &str| {
        format!(
            "<joint name=\"to {child}\" type=\"{kind}\"><parent link=\"{parent}\"/><child link=\"{child}\"/>\
             <axis xyz=\"0 1 0\"/></joint>"
        )
    };
    let parts = [
        "<link name=\"base\"/>".to_string(),
        link("arm", "2"),
        on("arm", "continuous", "base"),
        link("load-1", "3"),
        on("load-1", "fixed", "arm"),
        link("load_1", "5"),
        on("load_1", "fixed", "arm"),
        link("50%$", "7"),
        on("50%$", "fixed", "arm"),
    ];
    let text = format!("<robot name=\"r\">{}</robot>", parts.concat());
    let derived = of(&text, "M", &options(Symbols::ALL, false));
    let names: std::collections::BTreeSet<String> = derived.legend.iter().map(|meaning| meaning.plain_name()).collect();
    assert_eq!(names.len(), derived.legend.len(), "{names:?}");
    assert!(derived.print(Language::Latex).contains(r"50\%\$"));
    assert!(derived.print(Language::Text).contains("m₁_load_1") && !derived.print(Language::Text).contains("load−1"));
    let root = of(&text.replace("0 1 0", "1 1 0"), "g", &options(Symbols::NONE, false)).print(Language::Text);
    assert!(root.contains("√2 "), "{root}");
}

/// A name of the file stays on its line: a line break would end a comment of code.
#[test]
fn names_of_links_cannot_leave_their_place() {
    for name in ["tool&#10;print(1)", "tool&#13;|x", "a^b~c", "tool\u{2028}x", "%}", "a{\\"] {
        let link = |name: &str| {
            format!(
                "<link name=\"{name}\"><inertial><origin xyz=\"0.3 0 0\"/><mass value=\"2\"/><inertia ixx=\"0\" \
                 iyy=\"0\" izz=\"0\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link>"
            )
        };
        let on = |kind: &str, child: &str, parent: &str| {
            format!(
                "<joint name=\"{child}\" type=\"{kind}\"><parent link=\"{parent}\"/><child link=\"{child}\"/>\
                 <axis xyz=\"0 1 0\"/></joint>"
            )
        };
        let parts = ["<link name=\"base\"/>".into(), link("arm"), on("continuous", "arm", "base")];
        let text = format!("<robot name=\"r\">{}{}{}</robot>", parts.concat(), link(name), on("fixed", name, "arm"));
        let found = of(&text, "M", &options(Symbols::ALL, false));
        let plain = of(&text.replace(name, "tool"), "M", &options(Symbols::ALL, false));
        for language in [Language::Text, Language::Markdown, Language::Sympy, Language::Python, Language::Matlab] {
            let (page, expected) = (found.print(language), plain.print(language));
            assert_eq!(page.lines().count(), expected.lines().count(), "{language:?}: {page}");
            assert!(!page.chars().any(|c| c.is_control() && c != '\n' || c == '\u{2028}'), "{page}");
        }
        check_latex(&found.print(Language::Latex));
    }
}

/// A robot of one joint: θ is a tuple of one symbol.
#[test]
fn sympy_takes_one_joint() {
    let Some(python) = crate::lagrange::python() else { return };
    let pendulum = crate::robots::chain(
        "pendulum",
        &[crate::robots::moved("continuous", "0 1 0", "0 0 0", "2", "0 0 -0.5", ["0", "0", "0"])],
    );
    for (quantity, check) in [("g", "g"), ("tau", "tau"), ("kinetic_energy", "kinetic_energy")] {
        let module = of(&pendulum, quantity, &options(Symbols::ALL, false)).print(Language::Sympy);
        let script = format!("{module}\nassert len(theta if 'theta' in globals() else dtheta) == 1, '{check}'\n");
        let output = Command::new(&python).args(["-c", &script]).output().expect("Python runs");
        assert!(output.status.success(), "{}\n{script}", String::from_utf8_lossy(&output.stderr));
    }
}

/// Angles in four decimals are those of π, axes of rounded components are unit vectors.
#[test]
fn rounded_angles_and_axes_are_derived() {
    let robot = |rpy: &str, axis: &str| {
        crate::robots::chain(
            "rounded",
            &[crate::robots::Moved {
                rpy: Box::leak(rpy.to_string().into_boxed_str()),
                axis: Box::leak(axis.to_string().into_boxed_str()),
                ..crate::robots::moved("continuous", "0 0 1", "0 0 0", "2", "0.5 0 0", ["0.1", "0.2", "0.3"])
            }],
        )
    };
    for angle in ["1.5708", "1.5707", "1.57079633"] {
        let text =
            of(&robot(&format!("{angle} 0 0"), "0 0 1"), "g", &options(Symbols::ALL, false)).print(Language::Text);
        assert!(text.contains("[ m₁r₁g cos θ₁ ]"), "{angle}: {text}");
    }
    let text = of(&robot("0 0 0", "0.26726124 0.53452248 0.80178373"), "M", &options(Symbols::NONE, false));
    let found = text.evaluate(&[&[0.4]], |x| x.to_f64(), std::f64::consts::PI)[0][0];
    let model = crate::model(&robot("0 0 0", "0.26726124 0.53452248 0.80178373"));
    assert!((found - model.mass_matrix(&[0.4]).expect("sound")[(0, 0)]).abs() < 1e-12, "{found}");
}

/// A robot of one velocity: matrices of one column remain matrices, and all entries may be 0.
#[test]
fn single_columns_and_zeros_are_told() {
    let inertia = ["0", "0.02", "0"];
    let pendulum =
        crate::robots::chain("p", &[crate::robots::moved("continuous", "0 1 0", "0 0 0", "2", "0 0 -0.5", inertia)]);
    let options = options(Symbols::ALL, false);
    let julia = of(&pendulum, "M", &options).print(Language::Julia);
    assert!(julia.contains("out_M = reshape([m1*r1^2 + I1_yy], (1, 1))"), "{julia}");
    let zeros = of(&pendulum, "body_jacobian_derivative", &options);
    assert_eq!(zeros.print(Language::Text), "all entries of H_b(θ) are 0\n");
    assert!(zeros.print(Language::Latex).contains(r"H^{b}(\theta) = 0"), "{}", zeros.print(Language::Latex));
}

#[test]
fn python_computes_what_the_kernel_computes() {
    let python = std::env::var("MOZZI_PYTHON").unwrap_or_else(|_| "python3".into());
    let has = Command::new(&python).args(["-c", "import numpy"]).output().is_ok_and(|output| output.status.success());
    if !has {
        println!("skipped: there is no Python with NumPy; MOZZI_PYTHON names one");
        return;
    }
    let theta = [0.3, -1.2, 1.4, -0.5, 0.9, 2.0];
    let model = crate::model(embedded("ur5"));
    for quantity in ["mass_matrix_product_derivative", "inverse_dynamics_vjp"] {
        let robot = embedded("two_link_planar");
        let mut script = of(robot, quantity, &options(Symbols::ALL, true)).print(Language::Python);
        let query = mozzi::quantities::Query::named(quantity).expect(quantity);
        let vectors = [[0.3, 0.8], [-1.1, 0.6], [0.7, 1.9], [3.0, 5.0]];
        let inputs = query.declaration().inputs.len();
        let inputs: Vec<&[f64]> = vectors[..inputs - 1].iter().chain(&vectors[3..]).map(|x| &x[..]).collect();
        let model = crate::model(robot);
        let expected = model.compute(query, &inputs, &model.environment()).expect("sound").concat();
        let given: Vec<String> = inputs.iter().map(|x| format!("{x:?}")).collect();
        script += &format!("from numpy import hstack, ravel\nout = {quantity}({})\n", given.join(", "));
        script += "print(*(hstack(out) if isinstance(out, tuple) else ravel(out)))\n";
        let output = Command::new(&python).args(["-c", &script]).output().expect("Python runs");
        let said = String::from_utf8_lossy(&output.stdout);
        let found: Vec<f64> = said.split_whitespace().map(|x| x.parse().expect("a number")).collect();
        assert_eq!(found.len(), expected.len(), "{}", String::from_utf8_lossy(&output.stderr));
        for (x, y) in found.iter().zip(&expected) {
            assert!((x - y).abs() < 1e-12 * (1.0 + y.abs()), "{quantity}: {x} instead of {y}");
        }
    }
    for names in [false, true] {
        let mut script = of(embedded("ur5"), "M", &options(Symbols::NONE, names)).print(Language::Python);
        script.push_str(&format!("print(*mass_matrix({theta:?}).ravel())\n"));
        let output = Command::new(&python).args(["-c", &script]).output().expect("Python runs");
        let said = String::from_utf8_lossy(&output.stdout);
        let found: Vec<f64> = said.split_whitespace().map(|x| x.parse().expect("a number")).collect();
        let expected = model.mass_matrix(&theta).expect("regular");
        assert_eq!(found.len(), 36, "{}", String::from_utf8_lossy(&output.stderr));
        for (k, x) in found.iter().enumerate() {
            assert!((x - expected[(k / 6, k % 6)]).abs() < 1e-7 * expected.amax(), "{k}: {x}");
        }
    }
}

/// Named sub-expressions have names of their own: a vector x has entries x₁, x₂.
#[test]
fn each_name_is_assigned_once() {
    let robot = embedded("two_link_planar");
    let mut count = 0;
    for declared in mozzi::quantities::LIST {
        for symbols in [Symbols::ALL, Symbols::NONE] {
            let Ok(found) = crate::attempt(robot, declared.name, &options(symbols, true)) else { continue };
            for language in [Language::Text, Language::Python, Language::Sympy, Language::Matlab, Language::Julia] {
                let page = found.print(language);
                let mut names: Vec<&str> = page.lines().filter_map(assigned).flatten().collect();
                let all = names.len();
                names.sort_unstable();
                names.dedup();
                assert_eq!(names.len(), all, "{} as {language:?}:\n{page}", declared.name);
            }
            count += 1;
        }
    }
    assert!(count > 90, "{count} derivations");
}

/// A SymPy module of all quantities: no name has two meanings, and each expression is that of its own module.
#[test]
fn a_module_of_several_quantities_keeps_its_names() {
    let robot = embedded("two_link_planar");
    for (symbols, names) in [(Symbols::ALL, false), (Symbols::NONE, true)] {
        let options = options(symbols, names);
        let base = mozzi_symbolic::base_parameters(&crate::model(robot), Some(robot), &options).expect("derived");
        let of =
            |declared: &'static mozzi::quantities::Declaration| crate::attempt(robot, declared.name, &options).ok();
        let has_entries = |found: &mozzi_symbolic::Derivation| !found.formulas[0].shape.contains(&0);
        let all: Vec<_> = mozzi::quantities::LIST.iter().filter_map(of).filter(has_entries).chain([base]).collect();
        let module = print_all(&all, Language::Sympy);
        let mut assigned: Vec<&str> = module.lines().filter_map(assigned).flatten().collect();
        let count = assigned.len();
        assigned.sort_unstable();
        assigned.dedup();
        assert_eq!(assigned.len(), count, "{module}");
        for part in ["\ninverse_dynamics_vjp_d_theta = ", "\npi_b = ", "\nmass_matrix_inverse = "] {
            assert!(module.contains(part), "{part} in {module}");
        }
        let Some(python) = crate::lagrange::python() else { continue };
        let mut script = format!("{module}\ndef at_file(x): return [y.subs(values) for y in x]\n");
        for single in all.iter().filter(|found| ["mass_matrix", "momentum_vjp"].contains(&found.quantity)) {
            let text = format!("{:?}", single.print(Language::Sympy));
            script += &format!("own = {{}}\nexec({text}, own)\n");
            for formula in &single.formulas {
                let (one, several) = match single.formulas.len() {
                    1 => (single.quantity, single.quantity.to_string()),
                    _ => (formula.name, format!("{}_{}", single.quantity, formula.name)),
                };
                script += &format!("assert at_file({several}) == at_file(own['{one}']), '{several}'\n");
            }
        }
        let file = std::env::temp_dir().join(format!("mozzi-module-{}-{names}.py", std::process::id()));
        std::fs::write(&file, &script).expect("written");
        let output = Command::new(&python).arg(&file).output().expect("Python runs");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        std::fs::remove_file(file).expect("removed");
    }
}

/// The names on the left of an assignment: none of a definition or of an entry of the text's legend.
fn assigned(line: &str) -> Option<impl Iterator<Item = &str>> {
    let (left, _) = line.rsplit_once(" = ").filter(|(left, _)| !left.contains("function"))?;
    Some(left.split(" = ").flat_map(|part| part.split(", ")).map(|name| name.trim_end_matches(',').trim()))
}

/// An arm's M and g take less than two seconds where the test is compiled with little optimization, too.
#[test]
fn arms_are_derived_soon() {
    for (robot, quantity, seconds) in [("ur5", "M", 2.0), ("panda", "g", 2.0)] {
        let best = (0..3)
            .map(|_| {
                let start = Instant::now();
                of(embedded(robot), quantity, &options(Symbols::NONE, true));
                start.elapsed().as_secs_f64()
            })
            .fold(f64::INFINITY, f64::min);
        println!("{robot} {quantity}: {best:.2} s");
        assert!(best < 4.0 * seconds, "{robot} {quantity}: {best} s");
    }
}

#[test]
fn angles_of_the_file_are_exact() {
    let found = of(embedded("ur5"), "T", &options(Symbols::NONE, false));
    let page = found.print(Language::Text);
    assert!(page.contains("read as multiples of π"), "{page}");
}
