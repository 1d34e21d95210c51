//! A guide: a lesson or a demo that can be taken from the lab.
//!
//! In: nothing. Out: [`Guide`], plain data, as the shell finds it. Never here: scripts, files, the list of them.

/// A lesson or a demo.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Guide {
    /// Which of both it is.
    pub kind: GuideKind,
    /// Its name, by which it is opened.
    pub name: String,
    /// As lists show it.
    pub title: String,
    /// The title of the system that it is about.
    pub system: String,
}

/// Whether a person or a script is at the keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GuideKind {
    /// A lesson, and how far it was taken.
    Lesson(LessonTaken),
    /// A demo, which one watches.
    Demo,
}

/// How far a lesson was taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LessonTaken {
    /// Not begun.
    NotYet,
    /// Left on the way.
    Partly,
    /// To its end.
    Whole,
}

impl Guide {
    /// Returns what it is, and how far it was taken.
    pub(super) fn about(&self) -> String {
        let what = match self.kind {
            GuideKind::Lesson(LessonTaken::NotYet) => "lesson",
            GuideKind::Lesson(LessonTaken::Partly) => "lesson, begun",
            GuideKind::Lesson(LessonTaken::Whole) => "lesson, finished",
            GuideKind::Demo => "demo",
        };
        format!("{what}: {}", self.system)
    }
}
