//! The subject of a quantity: its frame, its task or its point.

use crate::border::{check_finite, slice};
use crate::environment::CEnvironment;
use crate::handle::check_pointer;
use crate::robot::{Frame, Robot};
use crate::status::{Outcome, Status, of_model, refuse};
use mozzi::quantities::{Declaration, LIST, Of, Query};
use mozzi::{TaskFrame, Vec3};

/// `mozzi_task`.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Task {
    frame: Frame,
    coordinates: i32,
    rows: *const usize,
    row_count: usize,
}

impl Task {
    pub fn frame(&self) -> Frame {
        self.frame
    }
}

/// The arguments of a call besides inputs and outputs; those that a quantity does not have are null or 0.
#[derive(Clone, Copy, Debug)]
pub struct Given {
    pub frame: Frame,
    pub task: *const Task,
    pub about: *const f64,
    pub environment: *const CEnvironment,
}

impl Default for Given {
    fn default() -> Self {
        let (task, about, environment) = (std::ptr::null(), std::ptr::null(), std::ptr::null());
        Given { frame: 0, task, about, environment }
    }
}

/// `mozzi_subject`.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct CSubject {
    pub task: Task,
    pub about: [f64; 3],
}

/// The declaration of this number.
pub fn declaration(quantity: i32) -> Outcome<(usize, &'static Declaration)> {
    let index = usize::try_from(quantity).unwrap_or(usize::MAX);
    match LIST.get(index) {
        Some(declaration) => Ok((index, declaration)),
        None => refuse!(Status::NOT_FOUND, "there is no quantity {quantity}: there are {}", LIST.len()),
    }
}

impl CSubject {
    /// The other arguments of a call, of a subject that may be null.
    ///
    /// # Safety
    /// The pointer is null or valid.
    pub unsafe fn given(this: *const CSubject, environment: *const CEnvironment) -> Outcome<Given> {
        if this.is_null() {
            return Ok(Given { environment, ..Given::default() });
        }
        check_pointer(this, "subject")?;
        // SAFETY: the caller's promise.
        let this = unsafe { &*this };
        Ok(Given { frame: this.task.frame(), task: &raw const this.task, about: this.about.as_ptr(), environment })
    }

    /// The quantity of this number, with its subject.
    ///
    /// # Safety
    /// As [`Given::query`].
    pub unsafe fn query<'a>(this: *const CSubject, robot: &Robot, quantity: i32) -> Outcome<Query<'a>> {
        let (index, _) = declaration(quantity)?;
        // SAFETY: the caller's promise.
        let query = unsafe { CSubject::given(this, std::ptr::null())?.query(robot, index)? };
        query.check_subject(&robot.model).map_err(|error| of_model(&error))?;
        Ok(query)
    }
}

impl Given {
    /// The quantity of this index with its frame, task or point.
    ///
    /// # Safety
    /// The pointers are null or valid as long as 'a.
    #[inline(always)]
    pub unsafe fn query<'a>(&self, robot: &Robot, index: usize) -> Outcome<Query<'a>> {
        let mut query: Query<'a> = Query::at(index);
        match query.declaration().of {
            Of::Robot => {}
            Of::Frame => query.subject.frame = Some(robot.frame(self.frame)?),
            // SAFETY: the caller's promise.
            Of::Task => query = unsafe { self.of_task(robot, query)? },
            Of::Point if !self.about.is_null() => {
                // SAFETY: the caller's promise.
                let about = unsafe { slice(self.about, 3, "about")? };
                check_finite(about, "about")?;
                query.subject.point = Vec3([about[0], about[1], about[2]]);
            }
            Of::Point => {}
        }
        if query.declaration().needs_mass {
            query.check_subject(&robot.model).map_err(|error| of_model(&error))?;
        }
        Ok(query)
    }

    /// # Safety
    /// As [`query`](Self::query).
    unsafe fn of_task<'a>(&self, robot: &Robot, mut query: Query<'a>) -> Outcome<Query<'a>> {
        check_pointer(self.task, "task")?;
        // SAFETY: the caller's promise.
        let task = unsafe { &*self.task };
        query.subject.frame = Some(robot.frame(task.frame)?);
        query.subject.coordinates = match task.coordinates {
            0 => TaskFrame::Body,
            1 => TaskFrame::Space,
            other => {
                return refuse!(
                    Status::INVALID_ARGUMENT,
                    "task.coordinates is {other}, expected MOZZI_BODY or MOZZI_SPACE"
                );
            }
        };
        if task.row_count > 6 {
            return refuse!(Status::INVALID_ARGUMENT, "the task has {} rows, expected at most 6", task.row_count);
        }
        if task.row_count > 0 {
            // SAFETY: the caller's promise.
            query.subject.rows = unsafe { slice(task.rows, task.row_count, "task.rows")? };
        }
        query.check_subject(&robot.model).map_err(|error| of_model(&error))?;
        Ok(query)
    }
}
