//! Edits the texts of a robot in xacro. A number of the expansion is edited where it is written: as a literal, or as
//! that number of a property, of a macro's call or of a YAML file which, when it is changed, changes the number of the
//! expansion to the same value. Whatever else it changes shows when the edited texts are expanded again.

use super::element::{Change, Editor, Tag, replaced};
use super::joint::is_near;
use super::numbers::{Number, all_words, of_xacro, of_yaml, words};
use super::{EditError, EditedFile, differences, refused};
use crate::{LoadError, Settings, parse_in};
use mozzi::Description;
use mozzi_xacro::{Expansion, Origin, expand_text};
use roxmltree::{Document, Node};
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;

/// The most numbers that are tried, and the most steps of all their expansions, about a minute's.
const MOST_TRIED: usize = 4000;
const MOST_STEPS: u64 = 200_000_000;

/// The most reasons in a message.
const SHOWN: usize = 8;

/// A number of the expansion that is to be another.
struct Wanted {
    /// Its place in the expansion.
    word: Range<usize>,
    old: f64,
    new: f64,
    /// "value of <mass> of link `arm`"
    subject: String,
}

/// The place of a number in a file.
type Place = (usize, usize, usize);

/// An insertion or removal: the file, the place of its element, what changes and how.
struct Structure<'a> {
    file: usize,
    element: usize,
    change: Change<'a>,
    subject: String,
}

pub(super) fn edit(
    file_name: &str,
    text: &str,
    expansion: &Expansion,
    edited: &Description,
    keeps_old: bool,
    settings: &Settings,
) -> Result<Vec<EditedFile>, EditError> {
    if crate::mjcf::is_mjcf(&expansion.text) {
        return Err(refused(vec!["it is xacro of MJCF, of which only the expansion can be edited".into()]));
    }
    let document = Document::parse(&expansion.text)
        .map_err(|error| refused(vec![format!("the expansion's XML is not valid: {error}")]))?;
    let editor = super::editor(file_name, &document, edited, false)?;
    if editor.changes.is_empty() {
        return Ok(Vec::new());
    }
    let files = Files::new(file_name, text, expansion, settings);
    let (mut wanted, mut structures, mut reasons) = (Vec::new(), Vec::new(), Vec::new());
    for change in editor.changes {
        match numbers_of(&change, &expansion.text) {
            Some(numbers) => wanted.extend(numbers),
            None => match files.structure(change) {
                Ok(structure) => structures.push(structure),
                Err(reason) => reasons.push(reason),
            },
        }
    }
    let (places, is_whole) = files.places(&wanted);
    let mut values: BTreeMap<Place, Vec<&Wanted>> = BTreeMap::new();
    for (one, place) in wanted.iter().zip(&places) {
        match place {
            Some(place) => values.entry(*place).or_default().push(one),
            None if is_whole => reasons.push(files.computed(one)),
            None => reasons.push(format!("{}; not all were tried", files.computed(one))),
        }
    }
    for (place, all) in &values {
        if let Some(other) = all.iter().find(|one| !is_near(&[one.new], &[all[0].new])) {
            let (a, b) = (&all[0], other);
            reasons.push(format!(
                "the number at {} would be {:?} as the {} and {:?} as the {}",
                files.place(*place),
                a.new,
                a.subject,
                b.new,
                b.subject
            ));
        }
    }
    refuse_if(reasons)?;
    let texts = files.edited(&values, structures, keeps_old)?;
    let others = differences(&files.read(&texts).map_err(EditError::Load)?, edited);
    let shared = |reason| format!("{reason}: it shares a number of the files with one that changes");
    refuse_if(others.into_iter().map(shared).collect())?;
    Ok(texts)
}

fn refuse_if(mut reasons: Vec<String>) -> Result<(), EditError> {
    if reasons.is_empty() {
        return Ok(());
    }
    reasons.dedup();
    if reasons.len() > SHOWN {
        let more = reasons.split_off(SHOWN).len();
        reasons.push(format!("and {more} more"));
    }
    Err(refused(reasons))
}

/// The numbers that an attribute's change changes; None for another change.
fn numbers_of(change: &Change<'_>, text: &str) -> Option<Vec<Wanted>> {
    let Change::Set(tag, name, Some(value)) = change else { return None };
    let place = tag.node.attribute_node(name.as_str())?.range_value();
    let (old, new): (Vec<_>, Vec<_>) = (words(text, place).collect(), value.split_ascii_whitespace().collect());
    if old.len() != new.len() {
        return None;
    }
    let mut found = Vec::new();
    for (word, new) in old.into_iter().zip(new) {
        let (before, new): (f64, f64) = (text[word.clone()].parse().ok()?, new.parse().ok()?);
        if before != new {
            found.push(Wanted { word, old: before, new, subject: subject(*tag, name) });
        }
    }
    Some(found)
}

/// "value of <mass> of link `arm`"
fn subject(tag: Tag<'_>, attribute: &str) -> String {
    let is_named = |node: &Node| matches!(node.tag_name().name(), "link" | "joint") && node.attribute("name").is_some();
    let of = tag.node.ancestors().find(is_named);
    let of = of.map(|node| format!("{} `{}`", node.tag_name().name(), node.attribute("name").unwrap_or_default()));
    let of = of.unwrap_or_default();
    match attribute {
        "" => of,
        _ => format!("{attribute} of <{}> of {of}", tag.node.tag_name().name()),
    }
}

/// The files of an expansion.
struct Files<'f> {
    name: &'f str,
    expansion: &'f Expansion,
    settings: &'f Settings,
    /// The names and texts, those of YAML too.
    files: Vec<(String, String)>,
}

impl<'f> Files<'f> {
    fn new(name: &'f str, text: &str, expansion: &'f Expansion, settings: &'f Settings) -> Self {
        let mut files: Vec<(String, String)> = Vec::new();
        for (k, file) in expansion.files.iter().enumerate() {
            let content = match k {
                0 => text.strip_prefix('\u{feff}').unwrap_or(text).to_string(),
                _ if file.text.is_empty() => std::fs::read_to_string(&*file.name).unwrap_or_default(),
                _ => file.text.to_string(),
            };
            files.push((file.name.to_string(), content));
        }
        Files { name, expansion, settings, files }
    }

    /// The first number of a file that may be read several times.
    fn first(&self, file: usize) -> usize {
        let name = self.files.get(file).map(|(name, _)| name);
        self.files.iter().position(|(known, _)| Some(known) == name).unwrap_or(file)
    }

    fn is_yaml(&self, file: usize) -> bool {
        file > 0 && self.expansion.files[file].text.is_empty()
    }

    /// "arm.xacro:12:8"
    fn at(&self, file: usize, start: usize) -> String {
        let before = &self.files[file].1[..start];
        let line = before.matches('\n').count() + 1;
        let column = before[before.rfind('\n').map_or(0, |at| at + 1)..].chars().count() + 1;
        format!("{}:{line}:{column}", self.files[file].0)
    }

    /// "arm.xacro:12:8 (`2.5`)"
    fn place(&self, (file, start, end): Place) -> String {
        format!("{} (`{}`)", self.at(file, start), &self.files[file].1[start..end])
    }

    fn origin(&self, span: Range<usize>) -> Option<Origin> {
        let origin = self.expansion.origin(span)?;
        Some(Origin { file: self.first(origin.file), ..origin })
    }

    fn computed(&self, one: &Wanted) -> String {
        let origin = self.origin(one.word.clone());
        let text = origin.as_ref().and_then(|origin| self.files.get(origin.file)?.1.get(origin.span.clone()));
        let at = origin.as_ref().map_or(String::new(), |origin| self.expansion.describe(origin));
        format!(
            "the {} is computed, `{}` at {at}: no single number of the files gives it",
            one.subject,
            text.unwrap_or_default()
        )
    }

    /// Where each number is written, None if it is computed; and whether all numbers of the files were tried.
    fn places(&self, wanted: &[Wanted]) -> (Vec<Option<Place>>, bool) {
        let mut places: Vec<Option<Place>> = wanted.iter().map(|one| self.literal(&one.word)).collect();
        let Ok(document) = Document::parse(&self.expansion.text) else { return (places, true) };
        let before = all_words(&document);
        let index: Vec<Option<usize>> =
            wanted.iter().map(|one| before.iter().position(|word| *word == one.word)).collect();
        let most = MOST_TRIED.min((MOST_STEPS / self.expansion.work.max(1)) as usize);
        let (mut tried, mut is_whole) = (0, true);
        for file in (0..self.files.len()).filter(|&file| self.first(file) == file) {
            let text = &self.files[file].1;
            let numbers = if self.is_yaml(file) { of_yaml(text) } else { of_xacro(text) };
            for Number { span, value } in numbers {
                let is_missing = |k: usize| places[k].is_none() && wanted[k].old == value;
                if !(0..wanted.len()).any(is_missing) {
                    continue;
                }
                is_whole &= tried < most;
                if !is_whole {
                    break;
                }
                tried += 1;
                // a value that nothing else has
                let probe = 1.000_123 * value + 4.57e-4;
                let changed = replaced(text, vec![(span.clone(), format!("{probe:?}"))]);
                let Some(after) = self.words_with(file, &changed, before.len()) else { continue };
                for k in 0..wanted.len() {
                    let word = index[k].and_then(|k| after.get(k)).and_then(|word| word.parse::<f64>().ok());
                    if places[k].is_none() && word == Some(probe) {
                        places[k] = Some((file, span.start, span.end));
                    }
                }
            }
        }
        (places, is_whole)
    }

    /// The place of a word that is copied from a file.
    fn literal(&self, word: &Range<usize>) -> Option<Place> {
        let origin = self.origin(word.clone())?;
        let written = self.files.get(origin.file)?.1.get(origin.span.clone())?;
        (written == &self.expansion.text[word.clone()]).then_some((origin.file, origin.span.start, origin.span.end))
    }

    /// The words of the expansion after a file changed; None if there are more or fewer.
    fn words_with(&self, file: usize, text: &str, count: usize) -> Option<Vec<String>> {
        let mut arguments = self.settings.xacro.clone();
        let main = if file == 0 { text } else { &self.files[0].1 };
        if file > 0 {
            arguments.texts.push((self.files[file].0.clone(), text.to_string()));
        }
        let expansion = expand_text(self.name, main, &arguments).ok()?;
        let document = Document::parse(&expansion.text).ok()?;
        let words = all_words(&document);
        (words.len() == count).then(|| words.into_iter().map(|word| expansion.text[word].to_string()).collect())
    }

    /// The change of an element, at its place in a file.
    fn structure<'a>(&self, change: Change<'a>) -> Result<Structure<'a>, String> {
        let (Change::Set(tag, ..)
        | Change::Remove(tag)
        | Change::First(tag, _)
        | Change::Last(tag, _)
        | Change::Before(tag, _)) = &change;
        let start = tag.node.range().start + 1;
        let subject = subject(*tag, "");
        let origin = self.origin(start..start + tag.name().len());
        let written = |origin: &Origin| self.files.get(origin.file).and_then(|file| file.1.get(origin.span.clone()));
        match origin.filter(|origin| written(origin) == Some(tag.name())) {
            Some(origin) => Ok(Structure { file: origin.file, element: origin.span.start, change, subject }),
            None => Err(format!("{subject} has no element of its own in the files")),
        }
    }

    /// The edited texts.
    fn edited(
        &self,
        values: &BTreeMap<Place, Vec<&Wanted>>,
        structures: Vec<Structure<'_>>,
        keeps_old: bool,
    ) -> Result<Vec<EditedFile>, EditError> {
        let (mut texts, mut reasons) = (Vec::new(), Vec::new());
        for (file, (name, text)) in self.files.iter().enumerate() {
            let of_file: Vec<_> = values.iter().filter(|((at, ..), _)| *at == file).collect();
            let inserted: Vec<&Structure> = structures.iter().filter(|one| one.file == file).collect();
            if of_file.is_empty() && inserted.is_empty() {
                continue;
            }
            let mut replacements: Vec<(Range<usize>, String)> =
                of_file.iter().map(|((_, start, end), all)| (*start..*end, format!("{:?}", all[0].new))).collect();
            if self.is_yaml(file) {
                if keeps_old {
                    replacements.extend(comments(text, &replacements));
                }
            } else {
                let document = Document::parse(text)
                    .map_err(|error| refused(vec![format!("the XML of {name} is not valid: {error}")]))?;
                let mut editor = Editor::new(text);
                reasons.extend(insert(&mut editor, &document, &inserted, |at| self.at(file, at)));
                if keeps_old {
                    old_values(&mut editor, &document, &replacements);
                }
                replacements.extend(editor.replacements());
            }
            texts.push(EditedFile { name: name.clone(), text: replaced(text, replacements) });
        }
        refuse_if(reasons)?;
        Ok(texts)
    }

    /// The robot of the edited texts.
    fn read(&self, texts: &[EditedFile]) -> Result<Description, LoadError> {
        let mut settings = self.settings.clone();
        settings.xacro.texts.extend(texts.iter().map(|file| (file.name.clone(), file.text.clone())));
        let main = texts.iter().find(|file| file.name == self.files[0].0).map_or(&self.files[0].1, |file| &file.text);
        Ok(parse_in(Path::new(self.name).parent(), self.name, main.as_bytes(), &settings)?.description)
    }
}

/// Inserts and removes in one file. A macro's element gets the same change once; different ones are reasons.
fn insert<'a>(
    editor: &mut Editor<'a>,
    document: &'a Document<'a>,
    all: &[&Structure<'_>],
    place: impl Fn(usize) -> String,
) -> Vec<String> {
    let text = document.input_text();
    let mut done: Vec<(usize, Change<'a>, &str)> = Vec::new();
    let mut reasons = Vec::new();
    for one in all {
        let node = document.descendants().find(|node| node.is_element() && node.range().start + 1 == one.element);
        let Some(node) = node else { continue };
        let tag = Tag::new(node, text);
        let change = match &one.change {
            Change::Set(_, name, value) => Change::Set(tag, name.clone(), value.clone()),
            Change::Remove(_) => Change::Remove(tag),
            Change::First(_, element) => Change::First(tag, element.clone()),
            Change::Last(_, elements) => Change::Last(tag, elements.clone()),
            Change::Before(_, comment) => Change::Before(tag, comment.clone()),
        };
        match done.iter().find(|(element, known, _)| *element == one.element && known.is_of_same_kind(&change)) {
            Some((_, known, _)) if known.is_same(&change) => {}
            Some((.., other)) => reasons.push(format!(
                "the macro's element at {} would have to differ between {other} and {}",
                place(one.element),
                one.subject
            )),
            None => {
                done.push((one.element, change.clone(), &one.subject));
                editor.changes.push(change);
            }
        }
    }
    reasons
}

/// A comment before each element of which numbers change.
fn old_values<'a>(editor: &mut Editor<'a>, document: &'a Document<'a>, replacements: &[(Range<usize>, String)]) {
    let text = document.input_text();
    for node in document.descendants().filter(|node| node.is_element() && node.parent_element().is_some()) {
        let values: Vec<&str> = node
            .attributes()
            .flat_map(|attribute| {
                let part = attribute.range_value();
                replacements.iter().filter(move |(span, _)| part.start <= span.start && span.end <= part.end)
            })
            .map(|(span, _)| &text[span.clone()])
            .collect();
        if !values.is_empty() {
            editor.insert_before(Tag::new(node, text), &format!("<!-- before: {} -->", values.join(" ")));
        }
    }
}

/// A comment at the end of each line of YAML whose numbers change, unless it has one.
fn comments(text: &str, replacements: &[(Range<usize>, String)]) -> Vec<(Range<usize>, String)> {
    let mut lines: BTreeMap<usize, Vec<&str>> = BTreeMap::new();
    for (span, _) in replacements {
        let end = text[span.end..].find(['\r', '\n']).map_or(text.len(), |at| span.end + at);
        lines.entry(end).or_default().push(&text[span.clone()]);
    }
    let is_free = |end: usize| !text[text[..end].rfind('\n').map_or(0, |at| at + 1)..end].contains('#');
    let lines = lines.into_iter().filter(|(end, _)| is_free(*end));
    lines.map(|(end, values)| (end..end, format!(" # before: {}", values.join(", ")))).collect()
}
