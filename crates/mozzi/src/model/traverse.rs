//! Traversals of a tree: base to tips, tips to base, and from one link to the base.
//!
//! These are iterators and not closures, so that a kernel's whole body is compiled for the instruction set of the entry
//! that it is inlined into.

use super::{Lifted, Link, Model};
use crate::scalar::Scalar;
use core::marker::PhantomData;

/// Moving links with their slots, constants as `S`.
pub(crate) struct Traverse<'m, C, S, Order> {
    links: &'m [Link<C>],
    /// The slot that comes next in `Order`; 0 ends the inward traversals.
    slot: usize,
    types: PhantomData<(S, Order)>,
}

pub(crate) struct Outward;
pub(crate) struct Inward;
pub(crate) struct ToBase;

impl<C: Scalar> Model<C> {
    /// The link of a slot other than the base's.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn link<S>(&self, slot: usize) -> Lifted<'_, C, S> {
        Lifted::new(&self.links[slot - 1])
    }

    /// Base to tips.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn outward<S>(&self) -> Traverse<'_, C, S, Outward> {
        Traverse { links: &self.links, slot: 1, types: PhantomData }
    }

    /// Tips to base.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn inward<S>(&self) -> Traverse<'_, C, S, Inward> {
        Traverse { links: &self.links, slot: self.links.len(), types: PhantomData }
    }

    /// The steps from a slot's link to the base: each link with its parent, and with the parent's joint; at a floating
    /// base the last parent is slot 0, whose joint is `None`.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn steps_to_base<S>(&self, slot: usize) -> StepsToBase<'_, C, S> {
        let parent = self.links[slot - 1].parent;
        StepsToBase { links: &self.links, slot, parent, ends_at_base: self.is_floating(), number: PhantomData }
    }

    /// A slot's link, its parent, and so on down to the base.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn to_base<S>(&self, slot: usize) -> Traverse<'_, C, S, ToBase> {
        Traverse { links: &self.links, slot, types: PhantomData }
    }
}

/// See [`Model::steps_to_base`].
pub(crate) struct StepsToBase<'m, C, S> {
    links: &'m [Link<C>],
    slot: usize,
    parent: usize,
    /// A step to a floating base is left.
    ends_at_base: bool,
    number: PhantomData<S>,
}

/// A link, its parent's slot, and the joint that moves the parent.
pub(crate) type Step<'m, C, S> = (usize, usize, Option<Lifted<'m, C, S>>);

impl<'m, C: Scalar, S> Iterator for StepsToBase<'m, C, S> {
    type Item = Step<'m, C, S>;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn next(&mut self) -> Option<Self::Item> {
        let (link, parent) = (self.slot, self.parent);
        match self.links.get(parent.wrapping_sub(1)) {
            Some(joint) => {
                (self.slot, self.parent) = (parent, joint.parent);
                Some((link, parent, Some(Lifted::new(joint))))
            }
            None if self.ends_at_base => {
                self.ends_at_base = false;
                Some((link, 0, None))
            }
            None => None,
        }
    }
}

impl<'m, C: Scalar, S> Iterator for Traverse<'m, C, S, Outward> {
    type Item = (usize, Lifted<'m, C, S>);
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn next(&mut self) -> Option<Self::Item> {
        let link = self.links.get(self.slot - 1)?;
        self.slot += 1;
        Some((self.slot - 1, Lifted::new(link)))
    }
}

impl<'m, C: Scalar, S> Iterator for Traverse<'m, C, S, Inward> {
    type Item = (usize, Lifted<'m, C, S>);
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn next(&mut self) -> Option<Self::Item> {
        let slot = self.slot;
        let link = self.links.get(slot.wrapping_sub(1))?;
        self.slot -= 1;
        Some((slot, Lifted::new(link)))
    }
}

impl<'m, C: Scalar, S> Iterator for Traverse<'m, C, S, ToBase> {
    type Item = (usize, Lifted<'m, C, S>);
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn next(&mut self) -> Option<Self::Item> {
        let slot = self.slot;
        let link = self.links.get(slot.wrapping_sub(1))?;
        self.slot = link.parent;
        Some((slot, Lifted::new(link)))
    }
}
