//! A part of a model as text: the body or frame that is attached and the sections that refer to it, with the prefix
//! before all names. The model's outermost default class is given by name wherever it would have held; lines keep their
//! numbers.

use crate::urdf::vocabulary::shown;
use crate::urdf::write;
use roxmltree::{Document, Node};
use std::collections::BTreeSet;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Attributes whose value is the name of an element.
const NAMES: [&str; 24] = [
    "body",
    "body1",
    "body2",
    "childclass",
    "class",
    "cranksite",
    "geom",
    "geom1",
    "geom2",
    "hfield",
    "joint",
    "joint1",
    "joint2",
    "jointinparent",
    "material",
    "mesh",
    "name",
    "refsite",
    "sidesite",
    "site",
    "site1",
    "site2",
    "slidersite",
    "texture",
];
/// Attributes whose value is the name of a tendon.
const TENDONS: [&str; 3] = ["tendon", "tendon1", "tendon2"];
/// The sections that are attached as far as they refer to the part.
const REFERRING: [&str; 3] = ["tendon", "equality", "actuator"];

/// The part to attach.
pub(crate) struct Wanted<'w> {
    /// `body` or `frame` and its name; None for the contents of the world.
    pub root: Option<(&'static str, &'w str)>,
    pub prefix: &'w str,
    /// The folder of the model, relative to that of the model to which it is attached.
    pub folder: PathBuf,
}

/// Two texts, each in a root element.
pub(crate) struct Part {
    /// The text that replaces the `<attach>`.
    pub bodies: String,
    pub sections: String,
}

impl Part {
    /// An error states why there is none.
    pub fn of(document: &Document, text: &str, wanted: &Wanted) -> Result<Self, String> {
        let root = document.root_element();
        let sections = |name: &'static str| root.children().filter(move |node| node.has_tag_name(name));
        let mut roots = Vec::new(); // the elements that replace the <attach>
        match wanted.root {
            None => roots.extend(sections("worldbody").flat_map(|world| world.children()).filter(Node::is_element)),
            Some((tag, name)) => {
                let is_it = |node: &Node| node.has_tag_name(tag) && node.attribute("name") == Some(name);
                let found = sections("worldbody").flat_map(|world| world.descendants()).find(is_it);
                roots.push(found.ok_or_else(|| format!("{tag}: its model has no {tag} `{}`", shown(name)))?);
            }
        }
        let main = sections("default").find_map(|section| section.attribute("class")).unwrap_or("main");
        let compiler = |name: &str| sections("compiler").filter_map(|node| node.attribute(name)).next_back();
        let folder = compiler("meshdir").or(compiler("assetdir")).unwrap_or_default();
        let mut writer = Writer {
            text,
            prefix: escaped(wanted.prefix),
            main: escaped(main),
            meshes: wanted.folder.join(folder),
            strips: compiler("strippath") == Some("true"),
            edits: Vec::new(),
        };
        let mut bodies = Vec::new();
        for node in roots {
            writer.renamed(node);
            let childclass = node.ancestors().skip(1).find_map(|node| node.attribute("childclass")).unwrap_or(main);
            match node.tag_name().name() {
                "body" | "frame" | "replicate" => writer.classed(node, "childclass", childclass),
                "geom" | "site" => writer.classed(node, "class", childclass),
                _ => {}
            }
            bodies.push(node.range());
        }
        let inside = Inside::of(&bodies, root, wanted.root.is_none());
        let mut others = Vec::new();
        for section in root.children().filter(Node::is_element) {
            match section.tag_name().name() {
                "default" => {
                    writer.renamed(section);
                    writer.classed(section, "class", main);
                    others.push(section.range());
                }
                "asset" => {
                    writer.assets(section);
                    others.push(section.range());
                }
                name if REFERRING.contains(&name) => {
                    writer.referring(section, &inside);
                    others.push(section.range());
                }
                _ => {}
            }
        }
        let outermost = format!("<default class=\"{}{}\"/>", writer.prefix, writer.main);
        Ok(Part { bodies: writer.written(&bodies, ""), sections: writer.written(&others, &outermost) })
    }
}

/// The names of joints, bodies, sites, geoms and tendons that are attached.
struct Inside<'d>(Option<BTreeSet<(&'static str, &'d str)>>);

impl<'d> Inside<'d> {
    /// All, if it is the whole world.
    fn of(bodies: &[Range<usize>], root: Node<'d, 'd>, is_all: bool) -> Self {
        if is_all {
            return Inside(None);
        }
        let is_inside =
            |node: &Node| bodies.iter().any(|body| body.start <= node.range().start && node.range().end <= body.end);
        let mut names = BTreeSet::new();
        for node in root.descendants().filter(is_inside) {
            let kind = match node.tag_name().name() {
                "joint" | "freejoint" => "joint",
                "body" => "body",
                "site" => "site",
                "geom" => "geom",
                _ => continue,
            };
            names.extend(node.attribute("name").map(|name| (kind, name)));
        }
        let mut inside = Inside(Some(names));
        for tendons in root.children().filter(|node| node.has_tag_name("tendon")) {
            let kept: Vec<Node> =
                tendons.children().filter(|node| node.is_element() && inside.has_all(*node)).collect();
            for tendon in kept {
                if let (Some(names), Some(name)) = (&mut inside.0, tendon.attribute("name")) {
                    names.insert(("tendon", name));
                }
            }
        }
        inside
    }

    /// True if all elements that this one refers to are attached.
    fn has_all(&self, node: Node) -> bool {
        let Some(names) = &self.0 else { return true };
        node.descendants().flat_map(|node| node.attributes()).all(|attribute| {
            let kind = match attribute.name() {
                "joint" | "joint1" | "joint2" | "jointinparent" => "joint",
                "body" | "body1" | "body2" => "body",
                "site" | "site1" | "site2" | "cranksite" | "slidersite" | "refsite" | "sidesite" => "site",
                "geom" | "geom1" | "geom2" => "geom",
                name if TENDONS.contains(&name) => "tendon",
                _ => return true,
            };
            names.contains(&(kind, attribute.value()))
        })
    }
}

/// The changes of a text: ranges and what replaces them.
struct Writer<'t> {
    text: &'t str,
    prefix: String,
    /// The name of the outermost default class.
    main: String,
    /// The folder of meshes.
    meshes: PathBuf,
    strips: bool,
    edits: Vec<(Range<usize>, String)>,
}

impl Writer<'_> {
    /// Puts the prefix before all names in an element and its contents.
    fn renamed(&mut self, node: Node) {
        for attribute in node.descendants().flat_map(|node| node.attributes()) {
            let (name, value) = (attribute.name(), attribute.value());
            let is_name = NAMES.contains(&name) || TENDONS.contains(&name);
            if is_name && !value.is_empty() && !(name.starts_with("body") && value == "world") {
                let start = attribute.range_value().start;
                self.edits.push((start..start, self.prefix.clone()));
            }
        }
    }

    /// Gives an element the class that it would have had.
    fn classed(&mut self, node: Node, attribute: &str, class: &str) {
        if node.attribute(attribute).is_none() {
            let class = format!("{}{}", self.prefix, escaped(class));
            self.insert(node, &format!(" {attribute}=\"{class}\""));
        }
    }

    /// Inserts an attribute.
    fn insert(&mut self, node: Node, what: &str) {
        let name = node.range().start + 1;
        let ends = |c: char| c.is_ascii_whitespace() || matches!(c, '/' | '>');
        let at = name + self.text[name..].find(ends).unwrap_or_default();
        self.edits.push((at..at, what.to_string()));
    }

    /// Meshes and materials; a mesh's file gets its model's folder, and one without a name is named after its file.
    fn assets(&mut self, section: Node) {
        let main = self.main.clone();
        for asset in section.children().filter(Node::is_element) {
            self.renamed(asset);
            if !matches!(asset.tag_name().name(), "mesh" | "material") {
                continue;
            }
            self.classed(asset, "class", &main);
            let Some(file) = asset.attribute_node("file").filter(|_| asset.has_tag_name("mesh")) else { continue };
            let path = Path::new(file.value());
            let stem = path.file_stem().unwrap_or_default().to_string_lossy();
            if asset.attribute("name").is_none() {
                self.insert(asset, &format!(" name=\"{}{}\"", self.prefix, escaped(&stem)));
            }
            let path = if self.strips { path.file_name().map_or(path, Path::new) } else { path };
            let path = self.meshes.join(path).to_string_lossy().into_owned();
            self.edits.push((file.range_value(), escaped(&path)));
        }
    }

    /// Elements that refer to others; those that refer to what is not attached are left out.
    fn referring(&mut self, section: Node, inside: &Inside) {
        let main = self.main.clone();
        for node in section.children().filter(Node::is_element) {
            if inside.has_all(node) {
                self.renamed(node);
                self.classed(node, "class", &main);
            } else {
                let lines = self.text[node.range()].matches('\n').count();
                self.edits.push((node.range(), "\n".repeat(lines)));
            }
        }
    }

    /// The changed pieces of the text, each on its own line, in a root element.
    fn written(&mut self, pieces: &[Range<usize>], first: &str) -> String {
        self.edits.sort_by_key(|(range, _)| (range.start, range.end));
        let breaks: Vec<usize> = self.text.match_indices('\n').map(|(at, _)| at).collect();
        let (mut written, mut line) = (format!("<mujoco>{first}"), 0);
        for piece in pieces {
            let before = breaks.partition_point(|at| *at < piece.start);
            let start = written.len();
            written.push_str(&"\n".repeat(before.saturating_sub(line)));
            let mut at = piece.start;
            let from = self.edits.partition_point(|(range, _)| range.start < piece.start);
            let within = self.edits[from..].iter().take_while(|(range, _)| range.start <= piece.end);
            for (range, new) in within.filter(|(range, _)| range.end <= piece.end) {
                written.push_str(&self.text[at..range.start]);
                written.push_str(new);
                at = range.end;
            }
            written.push_str(&self.text[at..piece.end]);
            line += written[start..].matches('\n').count();
        }
        written.push_str("</mujoco>");
        written
    }
}

/// As a part of an attribute's value, in either kind of quotes.
fn escaped(text: &str) -> String {
    write::escaped(text).replace('\'', "&apos;")
}
