//! Lessons and demos inside the lab: they have its screen until they are left, and the lab is as it was.
//!
//! In: a [`Guide`], events, time. Out: its picture, and what is wrong with its script. Never here: what a script says.

use std::time::Duration;

use crossterm::event::Event;
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::{Modifier, Style};
use tracing::warn;

use super::demo::Demo;
use super::frame_loop::{Screen, ScreenRequest};
use super::lesson::LessonScreen;
use super::progress::{LessonMark, LessonProgress};
use crate::app::{Guide, GuideKind, LessonTaken};
use crate::diagnostic::{Diagnostic, Document};
use crate::preset::{self, CatalogEntry};
use crate::record::{Lesson, Script, ScriptHeader, ScriptRunner, called};
use crate::view::colour::Rgb;
use crate::view::{Detail, RenderStyle};

/// What is said when a demo is over.
const LEADS_BACK: &str = " over: any key returns ";

/// The lessons and demos that are shipped, with how far each lesson was taken.
pub(super) fn guides(systems: &[CatalogEntry]) -> Vec<Guide> {
    let progress = LessonProgress::known().unwrap_or_else(|why| {
        warn!("{why}");
        LessonProgress::default()
    });
    let lessons = preset::lessons().into_iter().filter_map(|name| {
        let taken = match progress.lessons.get(name).copied().unwrap_or_default() {
            LessonMark { finished: true, .. } => LessonTaken::Whole,
            LessonMark { step: 0, .. } => LessonTaken::NotYet,
            LessonMark { .. } => LessonTaken::Partly,
        };
        guide(GuideKind::Lesson(taken), name, &preset::lesson(name)?, systems)
    });
    let demos = preset::demos()
        .into_iter()
        .filter_map(|name| guide(GuideKind::Demo, name, &preset::demo(name)?, systems));
    lessons.chain(demos).collect()
}

fn guide(
    kind: GuideKind,
    name: &str,
    source: &Document,
    systems: &[CatalogEntry],
) -> Option<Guide> {
    let head = ScriptHeader::read(source).ok()?;
    let open = head.open.map(|open| open.text)?;
    let system = systems.iter().find(|entry| entry.name == open);
    let system = system.map_or(open, |entry| entry.info.title.clone());
    let title = head.title.unwrap_or_else(|| system.clone());
    Some(Guide { kind, name: name.to_owned(), title, system })
}

/// A lesson or demo that has the screen.
pub struct Guided {
    name: String,
    screen: GuideScreen,
    /// Whether the lab's motion was running before.
    pub(super) was_running: bool,
}

enum GuideScreen {
    Lesson(Box<LessonScreen<Lesson>>),
    Demo(Box<Demo>),
}

impl Guided {
    /// Opens a lesson, where it was left, or a demo.
    ///
    /// # Errors
    /// Returns what is wrong with its script or its system.
    pub fn open(guide: &Guide, style: RenderStyle) -> Result<Self, String> {
        let name = guide.name.clone();
        let source = match guide.kind {
            GuideKind::Lesson(_) => preset::lesson(&name),
            GuideKind::Demo => preset::demo(&name),
        };
        let source = source.ok_or_else(|| format!("{name} no longer exists"))?;
        let report = |diagnostics: &[Diagnostic]| source.report(diagnostics, false);
        let script = Script::read(&source).map_err(|diagnostics| report(&diagnostics))?;
        let open = script.head.open.as_ref().map_or_else(|| name.clone(), |open| open.text.clone());
        let system = preset::find(&open).map_err(|why| why.to_string())?;
        let screen = match guide.kind {
            GuideKind::Lesson(_) => {
                let lesson = Lesson::watched(script, &system, called(&open));
                let mut lesson = lesson.map_err(|diagnostics| report(&diagnostics))?;
                let progress = LessonProgress::known().ok();
                let mark = progress.and_then(|all| all.lessons.get(&name).copied());
                lesson
                    .resume(mark.unwrap_or_default().step)
                    .map_err(|diagnostic| report(&[diagnostic]))?;
                GuideScreen::Lesson(Box::new(LessonScreen::new(lesson, style)))
            }
            GuideKind::Demo => {
                let runner = ScriptRunner::watched(script, &system, called(&open));
                let runner = runner.map_err(|diagnostic| report(&[diagnostic]))?;
                GuideScreen::Demo(Box::new(Demo::new(runner, style)))
            }
        };
        Ok(Self { name, screen, was_running: false })
    }

    /// Whether a demo has come to its end; its last picture then stays until a key is pressed.
    fn is_over(&self) -> bool {
        matches!(&self.screen, GuideScreen::Demo(demo) if demo.is_done())
    }

    /// Leaves it, and keeps the progress of a lesson. Returns what is wrong with its script, or why progress is not saved.
    pub(super) fn leave(self) -> Option<String> {
        match self.screen {
            GuideScreen::Demo(demo) => demo.outcome().err().map(|diagnostic| diagnostic.message),
            GuideScreen::Lesson(screen) => {
                let (lesson, outcome) = screen.outcome();
                let mark = LessonMark::of(&lesson);
                let saved = LessonProgress::file()
                    .and_then(|path| LessonProgress::note(&path, &self.name, mark));
                let wrong = outcome.err().map(|diagnostic| diagnostic.message);
                wrong.or_else(|| saved.err().map(|why| why.to_string()))
            }
        }
    }

    fn screen(&mut self) -> &mut dyn Screen {
        match &mut self.screen {
            GuideScreen::Lesson(lesson) => &mut **lesson,
            GuideScreen::Demo(demo) => &mut **demo,
        }
    }
}

impl Screen for Guided {
    fn input(&mut self, event: Event) -> ScreenRequest {
        if self.is_over() && matches!(event, Event::Key(_)) {
            return ScreenRequest::Quit;
        }
        self.screen().input(event)
    }

    fn advance(&mut self, elapsed: Duration) -> bool {
        let over = self.is_over();
        let changed = self.screen().advance(elapsed);
        changed || self.is_over() != over
    }

    fn draw(&mut self, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        let cursor = self.screen().draw(area, buffer);
        if self.is_over() && area.height > 2 {
            // At the right of the last row, beside the caption.
            let width = area.width.min(LEADS_BACK.len() as u16);
            let place = (area.right() - width, area.bottom() - 1);
            let reversed = Style::new().add_modifier(Modifier::REVERSED);
            buffer.set_stringn(place.0, place.1, LEADS_BACK, width.into(), reversed);
        }
        cursor
    }

    fn is_typing(&self) -> bool {
        match &self.screen {
            GuideScreen::Lesson(lesson) => lesson.is_typing(),
            GuideScreen::Demo(demo) => demo.is_typing(),
        }
    }

    fn reduce(&mut self, detail: Detail) {
        self.screen().reduce(detail);
    }

    fn background(&mut self, colour: Rgb) {
        self.screen().background(colour);
    }
}
