//! Exactly one base, every link reached from it once.

use super::{Element, Report, unknown_link};
use alloc::format;
use alloc::string::ToString;
use alloc::vec;
use alloc::vec::Vec;

/// The tree of a description in which every link is reached once.
pub(super) struct Tree {
    /// Links, parents before children.
    pub order: Vec<usize>,
    /// The joint whose child each link is; none for the base.
    pub joint: Vec<Option<usize>>,
    /// The link that carries each link.
    pub parent: Vec<usize>,
}

impl Report<'_> {
    /// The tree, or None after reporting why there is none.
    pub(super) fn tree(&mut self, link: impl Fn(&str) -> Option<usize>) -> Option<Tree> {
        let d = self.description;
        if d.links.is_empty() {
            self.error(Element::Robot, "links", "no_links", "there are none, expected at least one".to_string());
            return None;
        }
        let mut parent_joint: Vec<Option<usize>> = vec![None; d.links.len()];
        let mut children: Vec<Vec<usize>> = vec![Vec::new(); d.links.len()];
        // a name that two links share is ambiguous
        let mut complete = d.links.iter().enumerate().all(|(i, described)| link(&described.name) == Some(i));
        for (i, joint) in d.joints.iter().enumerate() {
            let (parent, child) = (link(&joint.parent), link(&joint.child));
            for (attribute, found, name) in [("parent", parent, &joint.parent), ("child", child, &joint.child)] {
                if found.is_none() {
                    self.error(Element::Joint(i), attribute, "unknown_link", unknown_link(d, name));
                    complete = false;
                }
            }
            let (Some(parent), Some(child)) = (parent, child) else { continue };
            if parent == child {
                let message = format!("link `{}` is also the joint's parent, expected another link", joint.child);
                self.error(Element::Joint(i), "child", "self_parent", message);
                complete = false;
            } else if let Some(first) = parent_joint[child] {
                let message = format!(
                    "link `{}` is already the child of joint `{}`, which closes a loop; expected a tree, whose loops constraints close",
                    joint.child, d.joints[first].name
                );
                self.error(Element::Joint(i), "child", "loop_closure", message);
                complete = false;
            } else {
                parent_joint[child] = Some(i);
                children[parent].push(child);
            }
        }
        let roots: Vec<usize> = (0..d.links.len()).filter(|&i| parent_joint[i].is_none()).collect();
        if !complete {
            return None; // further errors would only repeat this one
        }
        let name = |&i: &usize| format!("`{}`", d.links[i].name);
        match roots.as_slice() {
            [] => {
                let message =
                    "every link is the child of a joint: a closed ring; expected one link, the base, that is no child"
                        .to_string();
                self.error(Element::Robot, "joints", "no_base", message);
            }
            [root] => {
                let mut tree = Tree { order: vec![*root], joint: parent_joint, parent: vec![*root; d.links.len()] };
                let (mut reached, mut next) = (vec![false; d.links.len()], 0);
                while let Some(&i) = tree.order.get(next) {
                    (reached[i], next) = (true, next + 1);
                    tree.order.extend(&children[i]);
                    children[i].iter().for_each(|&child| tree.parent[child] = i);
                }
                if tree.order.len() == d.links.len() {
                    return Some(tree);
                }
                for i in (0..d.links.len()).filter(|&i| !reached[i]) {
                    let message = format!(
                        "is not connected to the base `{}`: it hangs in a closed ring of joints",
                        d.links[*root].name
                    );
                    self.error(Element::Link(i), "joints", "unreachable_link", message);
                }
            }
            [first, others @ ..] => {
                for i in others {
                    let message = format!(
                        "is no joint's child, and neither is {}: expected one base, so a joint that leads to this link is missing",
                        name(first)
                    );
                    self.error(Element::Link(*i), "joints", "several_bases", message);
                }
            }
        }
        None
    }
}
