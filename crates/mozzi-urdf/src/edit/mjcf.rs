//! Edits an MJCF's texts in place. A value that comes from a default class is written on the element itself.

use super::element::{Editor, Tag};
use super::inertial::comment_of;
use super::joint::is_near;
use super::{EditError, EditedFile, differences, refused, unsupported};
use crate::XacroArguments;
use crate::report::finding::Findings;
use crate::report::places::{Place, Places};
use crate::text::context::Context;
use crate::text::dialect::Dialect;
use crate::text::number::{numbers, up_to};
use crate::text::source::Source;
use crate::text::{bytes, syntax};
use crate::urdf::write::triple;
use crate::{Policy, Settings, mjcf, parse_in};
use mozzi::linalg::{Mat3, Sym3};
use mozzi::model::description::Joint;
use mozzi::{Description, SE3, SO3, SpatialInertia, Vec3};
use nalgebra::{Matrix3, SymmetricEigen};
use roxmltree::{Document, Node};
use std::collections::BTreeMap;
use std::path::Path;

/// The words of a joint's attribute that take a polynomial, of which mozzi uses the first number.
const POLYNOMIALS: [&str; 2] = ["damping", "stiffness"];

/// The texts that change, the first of them that of the model if it does.
pub(super) fn edit(
    file_name: &str,
    text: &str,
    edited: &Description,
    keeps_old: bool,
) -> Result<Vec<EditedFile>, EditError> {
    let folder = Path::new(file_name).parent();
    let settings = |policy| Settings { policy, ..Settings::default() };
    let read = |policy| parse_in(folder, file_name, text.as_bytes(), &settings(policy));
    let original = match read(Policy::Default) {
        Ok(loaded) => loaded.description,
        Err(_) => read(Policy::Lenient).map_err(EditError::Load)?.description,
    };
    let mut reasons = unsupported(&original, edited);
    for (old, new) in original.joints.iter().zip(&edited.joints) {
        if (old.kind, old.origin, old.spring_reference) != (new.kind, new.origin, new.spring_reference) {
            reasons.push(format!("joint `{}` was locked, or its spring is at rest elsewhere", old.name));
        }
    }
    if original.base != edited.base {
        reasons.push("its base is floating".into());
    }
    if !reasons.is_empty() {
        return Err(refused(reasons));
    }
    let model = Model { file_name, folder, original, edited, keeps_old };
    let mut armature = BTreeMap::new();
    let files = model.files(text, &armature)?;
    let again = model.read_again(text, &files)?;
    // a joint's armature contains that of its actuators and tendons
    for (wanted, found) in edited.joints.iter().zip(&again.joints) {
        if !is_near(&[wanted.armature], &[found.armature]) {
            armature.insert(wanted.name.clone(), found.armature - wanted.armature);
        }
    }
    let files = if armature.is_empty() { files } else { model.files(text, &armature)? };
    let again = model.read_again(text, &files)?;
    let reasons = differences(&again, edited);
    if !reasons.is_empty() {
        return Err(refused(reasons));
    }
    Ok(files)
}

struct Model<'m> {
    file_name: &'m str,
    folder: Option<&'m Path>,
    original: Description,
    edited: &'m Description,
    keeps_old: bool,
}

/// Elements of the texts by their places.
struct Pages<'a> {
    /// Where each text begins among all of them, the text, and its elements by the place of their name.
    pages: Vec<(usize, &'a str, BTreeMap<usize, Node<'a, 'a>>)>,
}

impl<'a> Pages<'a> {
    /// The element at a place: its page and tag.
    fn element(&self, place: &Place) -> Option<(usize, Tag<'a>)> {
        let at = place.span("").start;
        let page = self.pages.iter().rposition(|(base, ..)| *base <= at)?;
        let (base, text, nodes) = &self.pages[page];
        nodes.get(&(at - base)).map(|node| (page, Tag::new(*node, text)))
    }
}

impl Model<'_> {
    fn sources(
        &self,
        text: &str,
        texts: Vec<(String, String)>,
    ) -> Result<(Vec<Source>, Description, Places), EditError> {
        let mut findings = Findings::default();
        let source = Source::new(self.file_name, bytes::read(text.as_bytes(), &mut findings));
        let source = syntax::mended(source, Dialect::Mjcf, &mut findings);
        let mut cx = Context::new(findings, Dialect::Mjcf);
        let given = XacroArguments { texts, ..XacroArguments::default() };
        let mut sources = vec![source];
        match mjcf::read(&mut sources, self.folder, &given, &mut cx) {
            Some((description, places)) => Ok((sources, description, places)),
            None => Err(refused(vec![format!("{} cannot be read again", self.file_name)])),
        }
    }

    /// The robot of the edited texts.
    fn read_again(&self, text: &str, files: &[EditedFile]) -> Result<Description, EditError> {
        let texts = files.iter().map(|file| (file.name.clone(), file.text.clone())).collect();
        let main = files.iter().find(|file| file.name == self.file_name).map_or(text, |file| &file.text);
        self.sources(main, texts).map(|(_, description, _)| description)
    }

    /// The edited texts; `surplus` is the armature that joints have from elsewhere.
    fn files(&self, text: &str, surplus: &BTreeMap<String, f64>) -> Result<Vec<EditedFile>, EditError> {
        let (sources, _, places) = self.sources(text, Vec::new())?;
        let mut documents = Vec::new();
        for source in &sources {
            if source.is_attached {
                return Err(refused(vec![format!("a part of {} is attached", source.name)]));
            }
            if source.file().text != source.text {
                return Err(refused(vec![format!("the XML of {} is not valid", source.name)]));
            }
            let document = Document::parse(&source.text)
                .map_err(|error| refused(vec![format!("the XML of {} is not valid: {error}", source.name)]))?;
            documents.push(document);
        }
        let pages = Pages {
            pages: sources
                .iter()
                .zip(&documents)
                .map(|(source, document)| {
                    let nodes = document.descendants().filter(Node::is_element);
                    (source.base, &*source.text, nodes.map(|node| (node.range().start + 1, node)).collect())
                })
                .collect(),
        };
        let mut editors: Vec<Editor> = pages.pages.iter().map(|(_, text, _)| Editor::new(text)).collect();
        let mut reasons = Vec::new();
        let links = self.original.links.iter().zip(&self.edited.links).zip(&places.links);
        for ((old, new), place) in links.filter(|((old, new), _)| old.inertia != new.inertia) {
            match pages.element(place) {
                Some((page, body)) if body.name() == "body" => {
                    set_inertia(body, old.inertia, new.inertia, &mut editors[page]);
                    if self.keeps_old {
                        editors[page].insert_first(body, &comment_of(old.inertia));
                    }
                }
                _ => reasons.push(format!("link `{}` has no <body> of its own", old.name)),
            }
        }
        let joints = self.original.joints.iter().zip(&self.edited.joints).zip(&places.joints);
        for ((old, new), place) in joints.filter(|((old, new), _)| old != new) {
            match pages.element(place) {
                Some((page, tag)) if tag.name() == "joint" => {
                    let more = surplus.get(&old.name).copied().unwrap_or(0.0);
                    if new.armature - more < 0.0 {
                        reasons.push(format!(
                            "joint `{}`: actuators and tendons have an armature of {more:?}, more than the whole, {:?}",
                            old.name, new.armature
                        ));
                    }
                    let written = Joint { armature: new.armature - more, ..new.clone() };
                    set_joint(tag, old, &written, more != 0.0, self.keeps_old, &mut editors[page]);
                }
                _ => reasons.push(format!("joint `{}` has no <joint> of its own", old.name)),
            }
        }
        for ((old, new), place) in self.original.rotors.iter().zip(&self.edited.rotors).zip(&places.rotors) {
            match pages.element(place) {
                _ if old == new => {}
                Some((page, tag)) => editors[page].set(tag, "armature", Some(&format!("{:?}", new.armature))),
                None => reasons.push(format!("rotor `{}` has no element of its own", old.name)),
            }
        }
        if !reasons.is_empty() {
            return Err(refused(reasons));
        }
        let changed = sources.iter().zip(editors).filter(|(_, editor)| !editor.changes.is_empty());
        Ok(changed.map(|(source, editor)| EditedFile { name: source.name.to_string(), text: editor.apply() }).collect())
    }
}

/// The numbers of `<joint>` that differ.
fn set_joint<'a>(tag: Tag<'a>, old: &Joint, new: &Joint, is_more: bool, keeps_old: bool, editor: &mut Editor<'a>) {
    let of = |joint: &Joint| {
        [
            ("damping", joint.damping),
            ("frictionloss", joint.friction),
            ("armature", joint.armature),
            ("stiffness", joint.stiffness),
        ]
    };
    let all = of(old).into_iter().zip(of(new));
    let changed: Vec<_> = all.filter(|(old, new)| old.1 != new.1 || is_more && old.0 == "armature").collect();
    for (_, (name, value)) in &changed {
        // further terms of a polynomial stay
        let rest: Vec<&str> = match tag.attribute(name) {
            Some(text) if POLYNOMIALS.contains(name) => text.split_ascii_whitespace().skip(1).collect(),
            _ => Vec::new(),
        };
        let words = std::iter::once(format!("{value:?}")).chain(rest.into_iter().map(str::to_string));
        editor.set(tag, name, Some(&words.collect::<Vec<_>>().join(" ")));
    }
    if keeps_old && !changed.is_empty() {
        let values: Vec<String> = changed.iter().map(|((name, value), _)| format!("{name} {value:?}")).collect();
        editor.insert_before(tag, &format!("<!-- before: {} -->", values.join(", ")));
    }
}

/// Rewrites the numbers of `<inertial>` that differ, in its own way of writing; without one it is added, and replaces
/// what MuJoCo computed from geoms.
fn set_inertia<'a>(body: Tag<'a>, before: SpatialInertia, G: SpatialInertia, editor: &mut Editor<'a>) {
    let (c, I) = (G.center_of_mass(), G.about_center_of_mass());
    let six = |I: Sym3| [I.xx, I.yy, I.zz, I.xy, I.xz, I.yz];
    let Some(inertial) = body.child("inertial") else {
        let (diagonal, quaternion) = principal(I, SO3::identity());
        let turned = quaternion.map_or(String::new(), |q| format!(" quat=\"{}\"", list(&q)));
        let (mass, moments) = (G.mass, list(&diagonal));
        editor.insert_first(
            body,
            &format!("<inertial pos=\"{}\" mass=\"{mass:?}\"{turned} diaginertia=\"{moments}\"/>", triple(c)),
        );
        return;
    };
    let written = |name: &str| inertial.attribute(name);
    let old = |name: &str| written(name).and_then(|text| numbers::<3>(text).ok());
    if !is_near(&old("pos").unwrap_or_default(), &c.0) {
        editor.set(inertial, "pos", Some(&triple(c)));
    }
    if !written("mass").and_then(|text| numbers::<1>(text).ok()).is_some_and(|mass| is_near(&mass, &[G.mass])) {
        editor.set(inertial, "mass", Some(&format!("{:?}", G.mass)));
    }
    if is_near(&six(before.about_center_of_mass()), &six(I)) {
        return;
    }
    if written("fullinertia").is_some() {
        return editor.set(inertial, "fullinertia", Some(&list(&six(I))));
    }
    let by_angles = ["axisangle", "euler", "xyaxes", "zaxis"].into_iter().find(|name| written(name).is_some());
    let R = written("quat").and_then(|text| up_to::<4>(text).ok()).and_then(|(q, _)| mjcf::quaternion(q));
    let (diagonal, quaternion) = principal(I, R.unwrap_or_else(SO3::identity));
    let is_same = old("diaginertia").is_some_and(|old| is_near(&old, &diagonal));
    if is_same && quaternion.is_none() && by_angles.is_none() {
        return;
    }
    editor.set(inertial, "diaginertia", Some(&list(&diagonal)));
    if let Some(name) = by_angles {
        editor.set(inertial, name, None);
    }
    let identity = by_angles.is_some().then_some([1.0, 0.0, 0.0, 0.0]);
    if let Some(q) = quaternion.or(identity) {
        editor.set(inertial, "quat", Some(&list(&q)));
    }
}

/// Axes are kept if products of inertia relative to them are smaller than this, relative to the largest moment.
const UNTURNED: f64 = 1e-12;

fn list(values: &[f64]) -> String {
    values.iter().map(|x| format!("{x:?}")).collect::<Vec<_>>().join(" ")
}

/// The principal moments of I, and the quaternion (w, x, y, z) of their axes; the axes are near those of R, and none if
/// they are those of R.
fn principal(I: Sym3, R: SO3) -> ([f64; 3], Option<[f64; 4]>) {
    let in_R = I.congruence(R.inverse().matrix());
    let rows = in_R.to_mat3().rows();
    let diagonal = [rows[0][0], rows[1][1], rows[2][2]];
    let largest = diagonal.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    if [rows[0][1], rows[0][2], rows[1][2]].iter().all(|x| x.abs() <= UNTURNED * largest) {
        return (diagonal, None);
    }
    let eigen = SymmetricEigen::new(Matrix3::from_fn(|i, j| rows[i][j]));
    // each axis of R gets the eigenvector that is nearest to it, over all orders
    const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
    let nearness = |order: &[usize; 3]| (0..3).map(|i| eigen.eigenvectors[(i, order[i])].abs()).sum::<f64>();
    let order = ORDERS.into_iter().max_by(|a, b| nearness(a).total_cmp(&nearness(b))).unwrap_or(ORDERS[0]);
    let mut axes: [Vec3; 3] = core::array::from_fn(|i| {
        let sign = if eigen.eigenvectors[(i, order[i])] < 0.0 { -1.0 } else { 1.0 };
        Vec3(core::array::from_fn(|k| sign * eigen.eigenvectors[(k, order[i])]))
    });
    if axes[0].cross(axes[1]).dot(axes[2]) < 0.0 {
        axes[2] = -axes[2];
    }
    let turned = Mat3::from_rows([axes[0].0, axes[1].0, axes[2].0]).transpose();
    let Ok(V) = SO3::from_matrix(turned) else { return (diagonal, None) };
    let [w, x, y, z, ..] = SE3 { R: R * V, p: Vec3::zero() }.to_pose();
    (core::array::from_fn(|i| eigen.eigenvalues[order[i]]), Some([w, x, y, z]))
}
