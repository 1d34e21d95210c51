//! A question of a lesson, and its answer.
//!
//! Never here: what is right, keys, or what comes next.

use super::script::{Assert, LineText};
use crate::app::Prediction;
use crate::diagnostic::SourceRange;

#[derive(Clone, Debug)]
pub(super) struct Question {
    pub(super) place: SourceRange,
    pub(super) text: String,
    pub(super) kind: QuestionKind,
}

#[derive(Clone, Debug)]
pub(super) enum QuestionKind {
    Choice {
        options: Vec<AnswerChoice>,
        chosen: Option<usize>,
    },
    Number {
        value: LineText,
        within: LineText,
        typed: Option<f64>,
    },
    /// A point or a curve, and the time since which the motion is compared with it.
    Place {
        prediction: Prediction,
        since: f64,
    },
}

#[derive(Clone, Debug)]
pub(super) struct AnswerChoice {
    pub(super) place: SourceRange,
    pub(super) text: String,
    pub(super) why: Option<String>,
    pub(super) claim: Assert,
}

#[derive(Clone, Debug)]
pub(super) enum GivenAnswer {
    Option(usize),
    Number(f64),
    Points(Vec<[f64; 2]>),
}

#[derive(Clone, Debug)]
pub(super) struct AnswerVerdict {
    pub(super) question: Question,
    pub(super) right: bool,
    pub(super) truth: Truth,
}

/// What is right.
#[derive(Clone, Debug)]
pub(super) enum Truth {
    Options(Vec<bool>),
    /// A number, and how far a prediction may be off.
    Value(f64, f64),
    /// The point or the curve of the motion.
    Place(Vec<[f64; 2]>),
}
