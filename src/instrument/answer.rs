//! What an instrument has computed beside its picture, and what it needs.
//!
//! In: the result of a job, of any type. Out: [`Answer`]s and [`Need`]s. Never here: threads, and what a result is.

use std::any::Any;
use std::fmt;
use std::sync::Arc;

use crate::job::Job;

/// The result of an instrument's job. Only the instrument's own file knows the type.
#[derive(Clone)]
pub struct Answer(Arc<dyn Any + Send + Sync>);

/// The job that a picture needs.
#[derive(Debug)]
pub enum Need {
    /// No job is needed; an earlier result is dropped.
    Nothing,
    /// The last result is still valid.
    Valid,
    /// This job is needed. The last result stays until it has finished.
    Job(Job<Answer>),
    /// This job is needed once the values of the motion rest, and the last result stays until it has finished: where a sweep moves
    /// them in each frame, it would begin again in each.
    AtRest(Job<Answer>),
    /// This job is needed while the picture is drawn.
    WhileDrawn(Job<Answer>),
    /// This job adds to the picture and may take long: where there is no background it is left out.
    Addition(Job<Answer>),
}

impl Answer {
    /// Wraps a result.
    pub fn new(result: impl Any + Send + Sync) -> Self {
        Self(Arc::new(result))
    }

    /// The result, if it is of this type.
    pub fn of<T: Any>(&self) -> Option<&T> {
        self.0.downcast_ref()
    }
}

impl fmt::Debug for Answer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Answer")
    }
}

/// Results are equal if they are the same allocation.
impl PartialEq for Answer {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}
