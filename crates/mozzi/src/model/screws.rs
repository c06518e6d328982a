//! The book's lists: home frames, screw axes and inertias, in and out.

use super::build::normal_form;
use super::description::{Joint, JointKind, NamedFrame};
use super::{Description, Error, Freedom, Model};
use crate::lie::SE3;
use crate::scalar::Real;
use crate::spatial::{ScrewAxis, SpatialInertia, Twist};
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

/// The home configurations of a serial chain's link frames: n frames, then the end effector's.
#[derive(Clone, Copy, Debug)]
pub enum HomeFrames<'a> {
    /// M_1 … M_n, M_{n+1}, each relative to the base.
    Base(&'a [SE3]),
    /// M_{0,1} … M_{n,n+1}, each relative to the previous frame, as in the Modern Robotics package.
    Relative(&'a [SE3]),
}

/// The n screw axes of a serial chain.
#[derive(Clone, Copy, Debug)]
pub enum Screws<'a> {
    /// S_i, in the base frame.
    Space(&'a [ScrewAxis]),
    /// B_i, in the end-effector frame.
    Body(&'a [ScrewAxis]),
    /// A_i, each in its link's frame.
    Link(&'a [ScrewAxis]),
}

impl Description {
    /// A serial chain from the book's lists: home frames, the spatial inertia of each link in its frame, and screw
    /// axes. Links are named `link1` …, joints `joint1` …, the base `base` and the last frame `end_effector`.
    ///
    /// # Errors
    /// [`Error::WrongLength`] when the lists are not n + 1, n and n long.
    pub fn from_screws(
        name: impl Into<String>,
        frames: HomeFrames,
        inertias: &[SpatialInertia],
        screws: Screws,
    ) -> Result<Self, Error> {
        let (Screws::Space(axes) | Screws::Body(axes) | Screws::Link(axes)) = screws;
        let (HomeFrames::Base(given) | HomeFrames::Relative(given)) = frames;
        let n = axes.len();
        let length = |what, found, expected| {
            if found == expected { Ok(()) } else { Err(Error::WrongLength { what, found, expected }) }
        };
        length("the list of spatial inertias", inertias.len(), n)?;
        length("the list of home frames (one for each link, and the end effector's)", given.len(), n + 1)?;

        let mut home = given.to_vec(); // relative to the base
        if let HomeFrames::Relative(_) = frames {
            (1..=n).for_each(|i| home[i] = home[i - 1] * home[i]);
        }
        let mut robot = Description::new(name).link("base", SpatialInertia::zero());
        let mut parent = String::from("base");
        for i in 0..n {
            let M = match frames {
                HomeFrames::Relative(given) => given[i],
                HomeFrames::Base(_) if i == 0 => home[0],
                HomeFrames::Base(_) => home[i - 1].inverse() * home[i],
            };
            let A = match screws {
                Screws::Space(S) => S[i].transformed(home[i].inverse()), // A_i = Ad_{M_i⁻¹} S_i
                Screws::Body(B) => B[i].transformed(home[i].inverse() * home[n]),
                Screws::Link(A) => A[i],
            };
            let link = format!("link{}", i + 1);
            robot = robot.link(link.clone(), inertias[i]);
            robot = robot.joint(Joint::new(format!("joint{}", i + 1), parent, link.clone(), M, JointKind::Screw(A)));
            parent = link;
        }
        let T = if n == 0 { home[0] } else { home[n - 1].inverse() * home[n] };
        robot.frames.push(NamedFrame { name: "end_effector".into(), link: parent, T });
        robot.end_effector = Some("end_effector".into());
        Ok(robot)
    }
}

impl Model {
    /// The model of [`Description::from_screws`] without the check that inertias are physical, for programs that build
    /// a model from lists at every call. Names and tree are valid by construction.
    ///
    /// # Errors
    /// [`Error::WrongLength`] as there; [`Error::BadArgument`] for numbers that are not finite.
    pub fn from_screws(
        name: impl Into<String>,
        frames: HomeFrames,
        inertias: &[SpatialInertia],
        screws: Screws,
    ) -> Result<Self, Error> {
        let robot = Description::from_screws(name, frames, inertias, screws)?;
        let refused = |what, of: usize| Error::BadArgument {
            what,
            found: format!("not finite in number {of}"),
            expected: "finite numbers",
        };
        let origins = robot.joints.iter().map(|joint| joint.origin).chain(robot.frames.iter().map(|frame| frame.T));
        for (i, T) in origins.enumerate() {
            if !T.to_matrix().as_flattened().iter().all(|x| x.is_finite()) {
                return Err(refused("the list of home frames", i + 1));
            }
        }
        for (i, G) in inertias.iter().enumerate() {
            if !G.to_parameters().iter().all(|x| x.is_finite()) {
                return Err(refused("the list of spatial inertias", i + 1));
            }
        }
        Ok(normal_form(&robot, robot.clone()))
    }
}

/// The book's lists of a model. Frame {i} of moving link i is at the centre of mass of the link and all links fixed to
/// it, with the axes of the link's frame in the file; a massless link's frame is that frame itself. Lists run over the
/// N moving links, base to tips, with every joint at 0.
#[derive(Clone, Debug)]
pub struct ScrewLists {
    /// The joint that moves each link.
    pub joints: Vec<String>,
    /// The link that it moves.
    pub links: Vec<String>,
    /// Number of the link that carries it, from 1; 0 is the base.
    pub parents: Vec<usize>,
    /// M_i: frame {i} relative to the base.
    pub M: Vec<SE3>,
    /// M_{i−1,i}: frame {i} relative to its parent's.
    pub M_relative: Vec<SE3>,
    /// S_i, in the base frame.
    pub S: Vec<ScrewAxis>,
    /// A_i, in frame {i}.
    pub A: Vec<ScrewAxis>,
    /// 𝒢_i, in frame {i}: block-diagonal.
    pub G: Vec<SpatialInertia>,
    /// The end effector's name and home frame M_{n+1}, if the model has one.
    pub end_effector: Option<(String, SE3)>,
    /// B_i, in the end-effector frame; empty if the model has none.
    pub B: Vec<ScrewAxis>,
}

impl ScrewLists {
    /// M_1 … M_N, and M_{n+1} if there is an end effector: the argument of [`HomeFrames::Base`] for a serial chain.
    pub fn home_frames(&self) -> Vec<SE3> {
        self.M.iter().copied().chain(self.end_effector.as_ref().map(|(_, M)| *M)).collect()
    }
}

impl Model<f64> {
    /// The book's M_i, S_i, B_i, A_i and 𝒢_i of this model.
    ///
    /// # Errors
    /// [`Error::BadArgument`] for a robot with a ball or a free joint, which do not have a single screw axis.
    pub fn screws(&self) -> Result<ScrewLists, Error> {
        if let Some((joint, _)) = self.joints().zip(self.places()).find(|(_, place)| place.freedom != Freedom::One) {
            let found = format!("`{}`, a {} joint", joint.name, joint.kind.name());
            return Err(Error::BadArgument {
                what: "a joint of the screw lists",
                found,
                expected: "joints of one axis",
            });
        }
        let mut homes = alloc::vec![SE3::identity()]; // of the normal frames
        for link in &self.links {
            homes.push(homes[link.parent] * link.M.inverse());
        }
        let bodies: Vec<SE3> = (0..=self.links.len()).map(|slot| self.body_frame(slot)).collect();
        let M: Vec<SE3> = (1..homes.len()).map(|i| homes[i] * bodies[i]).collect();
        let A: Vec<ScrewAxis> = (self.moving_joints().zip(&bodies[1..]).enumerate())
            .filter_map(|(k, (joint, &body))| match joint.kind {
                JointKind::Screw(A) => Some(A.transformed(body.inverse() * self.link_frame(k + 1))),
                _ => None,
            })
            .collect();
        let S: Vec<ScrewAxis> = A.iter().zip(&M).map(|(A, &M)| A.transformed(M)).collect();
        let end_effector = self.structure.end_effector.map(|id| {
            let frame = self.frames[id.0];
            (self.frame_name(id).into(), homes[frame.slot] * frame.T)
        });
        let B = match &end_effector {
            Some((_, tip)) => S.iter().map(|S| S.transformed(tip.inverse())).collect(),
            None => Vec::new(),
        };
        Ok(ScrewLists {
            joints: self.moving_joints().map(|joint| joint.name.clone()).collect(),
            links: self.moving_joints().map(|joint| joint.child.clone()).collect(),
            parents: self.links.iter().map(|link| link.parent).collect(),
            M_relative: (1..homes.len()).map(|slot| self.home_in_parent(slot)).collect(),
            G: (1..homes.len()).map(|slot| self.body_inertia(slot)).collect(),
            M,
            S,
            A,
            B,
            end_effector,
        })
    }
}

impl<C: Real> Model<C> {
    /// The book's frame {i} relative to the slot's normal frame; the base frame itself for slot 0.
    pub(crate) fn body_frame(&self, slot: usize) -> SE3<C> {
        if slot > 0 && !self.links[slot - 1].is_last {
            return SE3::identity(); // an axis that carries no link
        }
        let link = self.link_frame(slot);
        if slot == 0 {
            return link;
        }
        let c = self.links[slot - 1].G.congruence(link.Ad()).center_of_mass();
        link * SE3::translation(c.0)
    }

    /// M_{p,i}: frame {i} of this slot relative to its parent's when the joint is at 0.
    pub(crate) fn home_in_parent(&self, slot: usize) -> SE3<C> {
        let link = &self.links[slot - 1];
        self.body_frame(link.parent).inverse() * link.M.inverse() * self.body_frame(slot)
    }

    /// 𝒢_i in frame {i}: block-diagonal; the first moment at the centre of mass is only rounding error.
    pub(crate) fn body_inertia(&self, slot: usize) -> SpatialInertia<C> {
        let G = self.links[slot - 1].G.congruence(self.body_frame(slot).Ad());
        if G.mass == C::zero() { G } else { SpatialInertia { mc: crate::Vec3::zero(), ..G } }
    }

    /// A_i in frame {i}.
    pub(crate) fn screw_of(&self, slot: usize) -> Twist<C> {
        self.body_frame(slot).inverse().Ad() * self.links[slot - 1].screw.twist()
    }
}
