//! The parameters of a macro: `a b:=1 c:=^ d:=^|2 *block **blocks`.

use crate::scope::Parameter;
use crate::space::is_space;

/// The parameters of the attribute `params`.
pub(crate) fn parse(text: &str) -> Vec<Parameter> {
    let (mut rest, mut parameters) = (text, Vec::new());
    while !rest.is_empty() {
        let (parameter, after) = match with_default(rest) {
            Some((parameter, after)) => (parameter, after),
            None => {
                let word = rest.trim_start_matches(is_space);
                let end = word.find(is_space).unwrap_or(word.len());
                let name = word[..end].into();
                (Parameter { name, forwards: false, default: None }, word[end..].trim_start_matches(is_space))
            }
        };
        if parameter.name.is_empty() {
            break;
        }
        parameters.push(parameter);
        rest = after;
    }
    parameters
}

/// A name, `:=` or `=`, and a default; `^` forwards the caller's property. Also returns the remaining text.
fn with_default(text: &str) -> Option<(Parameter, &str)> {
    let text = text.trim_start_matches(is_space);
    let end = text.find(|c: char| is_space(c) || matches!(c, ':' | '='))?;
    let (name, rest) = text.split_at(end);
    let rest = rest.trim_start_matches(is_space);
    let rest = rest.strip_prefix(':').unwrap_or(rest).strip_prefix('=')?.trim_start_matches(is_space);
    if name.is_empty() {
        return None;
    }
    let forms = [rest.strip_prefix("^|"), rest.strip_prefix('^')];
    for (forwards, text) in forms.into_iter().flatten().map(|text| (true, text)).chain([(false, rest)]) {
        if let Some(length) = default(text) {
            let default = Some(&text[..length]).filter(|default| !default.is_empty()).map(Into::into);
            let after = text[length..].trim_start_matches(is_space);
            return Some((Parameter { name: name.into(), forwards, default }, after));
        }
    }
    None
}

/// The length of the default at the beginning of a text: `${…}` or `$(…)` up to a space, or words and quoted texts, or
/// nothing.
fn default(text: &str) -> Option<usize> {
    let ends = |at: usize| text[at..].chars().next().is_none_or(is_space);
    for (open, close) in [("${", '}'), ("$(", ')')] {
        if text.starts_with(open) {
            let found = text.match_indices(close).map(|(at, _)| at + 1).find(|at| ends(*at));
            if found.is_some() {
                return found;
            }
        }
    }
    let mut dead = vec![false; text.len() + 1];
    words(text, 0, &ends, &mut dead).or_else(|| ends(0).then_some(0))
}

/// The end of the longest row of words and quoted texts. `dead` marks places from which there is no end.
fn words(text: &str, from: usize, ends: &dyn Fn(usize) -> bool, dead: &mut [bool]) -> Option<usize> {
    // places to continue from; those of the later words are on top
    let mut open: Vec<(usize, Vec<usize>)> = vec![(from, parts(text, from))];
    while let Some((at, next)) = open.last_mut() {
        match next.pop() {
            Some(end) if dead[end] => {}
            Some(end) => open.push((end, parts(text, end))),
            None => {
                if *at > from && ends(*at) {
                    return Some(*at);
                }
                dead[*at] = true;
                open.pop();
            }
        }
    }
    None
}

/// The ends of one word or quoted text, the preferred one last.
fn parts(text: &str, at: usize) -> Vec<usize> {
    let rest = &text[at..];
    match rest.chars().next() {
        Some(quote @ ('\'' | '"')) => rest
            .match_indices(quote)
            .skip(1)
            .map(|(end, _)| at + end + 1)
            .collect::<Vec<_>>()
            .into_iter()
            .rev()
            .collect(),
        Some(c) if !is_space(c) => {
            vec![at + rest.find(|c: char| is_space(c) || matches!(c, '\'' | '"')).unwrap_or(rest.len())]
        }
        _ => Vec::new(),
    }
}
