//! Programs as text, one line per step.

use crate::program::Function;
use crate::program::{Array, Output, Program, Step, Value};
use std::fmt;
use std::str::{FromStr, SplitWhitespace};

impl fmt::Display for Program {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "program {}", self.name)?;
        for Array { name, length } in &self.inputs {
            writeln!(f, "input {name} {length}")?;
        }
        for (place, step) in self.steps.iter().enumerate() {
            write!(f, "%{place} = ")?;
            match step {
                Step::Constant(x) => write!(f, "{x:?}")?,
                Step::Input(array, index) => write!(f, "{} {index}", self.inputs[*array as usize].name)?,
                Step::Apply(function, _) => write!(f, "{function}")?,
            }
            step.operands().iter().try_for_each(|value| write!(f, " %{value}"))?;
            writeln!(f)?;
        }
        for Output { name, values } in &self.outputs {
            write!(f, "output {name}")?;
            values.iter().try_for_each(|value| write!(f, " %{value}"))?;
            writeln!(f)?;
        }
        Ok(())
    }
}

/// Error: the text is not a valid program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NotAProgram {
    /// The line, from 1.
    pub line: usize,
    /// The error: found, and expected.
    pub problem: String,
}

impl fmt::Display for NotAProgram {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {} of the program: {}", self.line, self.problem)
    }
}
impl std::error::Error for NotAProgram {}

impl FromStr for Program {
    type Err = NotAProgram;

    fn from_str(text: &str) -> Result<Self, NotAProgram> {
        let mut program =
            Program { name: String::new(), inputs: Vec::new(), steps: Vec::new(), outputs: Vec::new(), asked: None };
        for (index, line) in text.lines().enumerate() {
            program.read(index == 0, line).map_err(|problem| NotAProgram { line: index + 1, problem })?;
        }
        match text.is_empty() {
            true => Err(NotAProgram { line: 1, problem: "is missing, expected `program NAME`".to_string() }),
            false => Ok(program),
        }
    }
}

impl Program {
    fn read(&mut self, is_first: bool, line: &str) -> Result<(), String> {
        let mut words = line.split_whitespace();
        match (words.next(), is_first) {
            (Some("program"), true) => self.name = name(&mut words)?,
            (found, true) => return Err(format!("begins with `{}`, expected `program`", found.unwrap_or_default())),
            (None, _) => {}
            (Some("input"), _) => {
                let (name, length) = (name(&mut words)?, number(&mut words)?);
                if self.inputs.iter().any(|input| input.name == name) || !self.steps.is_empty() {
                    return Err(format!("an input `{name}` here, expected each once and before all steps"));
                }
                self.inputs.push(Array { name, length });
            }
            (Some("output"), _) => {
                let name = name(&mut words)?;
                let values = words.by_ref().map(|word| self.value(word)).collect::<Result<_, _>>()?;
                self.outputs.push(Output { name, values });
            }
            (Some(place), _) => {
                if place != format!("%{}", self.steps.len()) || words.next() != Some("=") {
                    return Err(format!("`{place}`, expected `%{} = …`", self.steps.len()));
                }
                let step = self.step(&mut words)?;
                self.steps.push(step);
            }
        }
        words.next().map_or(Ok(()), |word| Err(format!("`{word}` is too much")))
    }

    fn step(&self, words: &mut SplitWhitespace) -> Result<Step, String> {
        let word = words.next().ok_or("ends after `=`, expected a number, an input or a function")?;
        if let Some(array) = self.inputs.iter().position(|input| input.name == word) {
            let (index, length) = (number(words)?, self.inputs[array].length);
            let (Ok(a), Ok(i), true) = (array.try_into(), index.try_into(), index < length) else {
                return Err(format!("entry {index} of `{word}`, which has {length}"));
            };
            return Ok(Step::Input(a, i));
        }
        if let Some(function) = Function::named(word) {
            let mut operands = [0; 3];
            for operand in &mut operands[..function.arity()] {
                let word = words.next().ok_or(format!("`{word}` takes {} operands", function.arity()))?;
                *operand = self.value(word)?;
            }
            return Ok(Step::Apply(function, operands));
        }
        let constant = word.parse().map_err(|_| format!("`{word}`, expected a number, an input or a function"))?;
        Ok(Step::Constant(constant))
    }

    fn value(&self, word: &str) -> Result<Value, String> {
        let value = word.strip_prefix('%').and_then(|digits| digits.parse().ok());
        let known = value.filter(|&value: &Value| (value as usize) < self.steps.len());
        known.ok_or_else(|| {
            format!("`{word}`, expected `%` and the number of a step before, up to {}", self.steps.len())
        })
    }
}

fn name(words: &mut SplitWhitespace) -> Result<String, String> {
    words.next().map(str::to_string).ok_or_else(|| "ends here, expected a name".to_string())
}

fn number(words: &mut SplitWhitespace) -> Result<usize, String> {
    let word = words.next().unwrap_or_default();
    word.parse().map_err(|_| format!("`{word}`, expected a number that is not negative"))
}

#[cfg(test)]
mod tests {
    use crate::Program;

    const TEXT: &str = "program p\ninput x 2\n%0 = x 1\n%1 = 0.1\n%2 = sin %0\n%3 = fnma %0 %1 %2\noutput y %3 %0\n";

    #[test]
    fn a_program_is_read_as_it_was_written() {
        let program: Program = TEXT.parse().expect("a program");
        assert_eq!(program.to_string(), TEXT);
        assert_eq!(program.evaluate(&[&[0.0, 0.5]]), [[0.5_f64.sin() - 0.05, 0.5]]);
    }

    #[test]
    fn what_is_no_program_is_refused_at_its_line() {
        let refused = |from: &str, to: &str| {
            let text = TEXT.replacen(from, to, 1);
            text.parse::<Program>().expect_err(&text).to_string()
        };
        assert_eq!(refused("x 1", "x 2"), "line 3 of the program: entry 2 of `x`, which has 2");
        assert_eq!(
            refused("= 0.1", "= O.1"),
            "line 4 of the program: `O.1`, expected a number, an input or a function"
        );
        assert!(refused("sin %0", "sin %2").contains("line 5 of the program: `%2`, expected `%` and the number"));
        assert!(refused("sin %0", "sin").contains("line 5 of the program: `sin` takes 1 operands"));
        assert!(refused("%3 =", "%4 =").contains("line 6 of the program: `%4`, expected `%3 = …`"));
        assert!(refused("program p", "p").contains("line 1 of the program: begins with `p`"));
        assert!(refused("%3 %0", "%3 %9").contains("line 7"));
        assert!("".parse::<Program>().is_err());
    }
}
