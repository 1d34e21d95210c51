//! Outputs: the files that a key asks for (system, table, drawing, recording), and what goes to the clipboard.
//!
//! In: the application's state. Out: files in the current folder, written aside, with a sentence about each. Never
//! here: what is in a table or a drawing.

use std::path::Path;
use std::sync::Arc;
use std::{env, io};

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use tracing::{error, info};

use super::super::clipboard;
use super::super::new_file;
use super::super::recorder::CastRecorder;
use super::super::writer::WriteReport;
use super::Session;
use crate::app::{AppEvent, Lab, Loaded, Notification};
use crate::experiment::{Export, Snapshot};
use crate::printable;
use crate::record::{data, plain, screenshot};
use crate::view::colour::ColourDepth;
use crate::view::glyphs::Glyphs;
use crate::view::theme::{PALETTES, Palette, Theme};
use crate::view::{self, RenderStyle};

impl Session {
    /// Exports the current state as a system file.
    pub(super) fn export(&mut self) {
        let Some((loaded, snapshot)) = self.seen() else {
            return self.report(Err("There is no motion here to save.".to_owned()));
        };
        self.write_file(move || {
            let Loaded { name, document, model, system, .. } = &loaded;
            let export = Export::of(document, (model, system), &snapshot)?;
            let Export { text, missing } = export.with_what_holds(document)?;
            let written = put(name, "toml", text.as_bytes())?;
            Ok([vec![written], missing].concat().join(" "))
        });
    }

    /// Returns the system in the lab and its newest snapshot.
    fn seen(&self) -> Option<(Loaded, Arc<Snapshot>)> {
        let lab = self.app.lab.as_ref()?;
        lab.seen()?;
        Some((lab.loaded.clone(), Arc::clone(lab.snapshot.as_ref()?)))
    }

    /// Starts to write a file that a key requested; the outcome is reported.
    fn write_file(&mut self, work: impl FnOnce() -> WriteReport + Send + 'static) {
        if let Err(why) = self.writer.begin(work) {
            self.report(Err(why));
        }
    }

    pub(super) fn report(&mut self, report: WriteReport) {
        info!("{report:?}");
        self.app.update(AppEvent::Written(report));
    }

    /// Returns the stem for files about the current state.
    fn stem(&self) -> String {
        self.app.lab.as_ref().map_or_else(|| "phaselab".to_owned(), |lab| lab.loaded.name.clone())
    }

    fn title(&self) -> String {
        let lab = self.app.lab.as_ref();
        lab.map_or_else(|| "phaselab".to_owned(), |lab| lab.loaded.model.info.title.clone())
    }

    /// Saves a drawing of the screen, with all colours and the finest dots whatever the terminal supports.
    pub(super) fn still(&mut self) {
        let palette = self.palette();
        let style =
            RenderStyle { theme: Theme::new(palette, ColourDepth::True), glyphs: Glyphs::Braille };
        let area = Rect::from(self.size);
        let mut screen = Buffer::empty(area);
        view::draw(&self.app, &style, area, &mut screen);
        plain(&mut screen);
        let (stem, title) = (self.stem(), self.title());
        self.write_file(move || {
            let drawing = screenshot::write(&screen, palette, screenshot::ImageFormat::Svg, &title);
            put(&stem, "svg", drawing.as_bytes())
        });
    }

    /// Puts a text into the terminal's clipboard, or else into a file.
    pub(super) fn copy(&mut self, what: &'static str, text: String, ending: &'static str) {
        if self.clipboard.is_there && text.len() <= clipboard::MOST {
            let copied = match ending {
                "tex" => format!("Copied {what} as LaTeX."),
                "sh" => format!("Copied: {text}"),
                _ => format!("Copied {what}."),
            };
            self.clipboard.text = Some(text);
            return self.report(Ok(copied));
        }
        let why = if self.clipboard.is_there {
            "because this is too long for the clipboard"
        } else {
            "because this terminal is not known to have a clipboard"
        };
        let stem = self.stem();
        self.write_file(move || {
            // one line can be read from the screen as well
            if ending == "sh" {
                let written = put(&stem, ending, format!("{text}\n").as_bytes())?;
                return Ok(format!("{}: {text}", written.trim_end_matches('.')));
            }
            let written = put(&stem, ending, text.as_bytes())?;
            Ok(format!("{}, {why}.", written.trim_end_matches('.')))
        });
    }

    /// Saves a table of what the focused instrument has computed, or of the recorded motion.
    pub(super) fn data(&mut self) {
        let Some((loaded, snapshot)) = self.seen() else {
            return self.report(Err("There is no motion here to save.".to_owned()));
        };
        let computed = self.app.lab.as_ref().and_then(Lab::focused_table);
        self.write_file(move || {
            let mut table = Vec::new();
            let (stem, written) = match computed {
                Some((kind, computed)) => (
                    format!("{}-{kind}", loaded.name),
                    data::write_table(&loaded, &snapshot, &computed, &mut table),
                ),
                None => (loaded.name.clone(), data::write(&loaded, &snapshot, &mut table)),
            };
            written.map_err(|why| why.to_string())?;
            put(&stem, "csv", &table)
        });
    }

    /// Starts a recording, or reports why that is impossible.
    pub(super) fn record(&mut self) {
        let palette = self.palette();
        match CastRecorder::begin(&self.stem(), &self.title(), self.size, palette) {
            Ok(recorder) => self.recorder = Some(recorder),
            Err(why) => self.give_up_recording(&why),
        }
    }

    /// Ends the recording after an error, but keeps what was recorded; the next attempt begins another file.
    pub(super) fn give_up_recording(&mut self, why: &io::Error) {
        let recorder = self.recorder.take();
        let report = recorder.map_or_else(|| why.to_string(), |recorder| recorder.give_up(why));
        error!("{report}");
        self.app.recording = false;
        self.app.notifications.show(Notification::error(format!("{report}.")));
    }

    /// Ends a recording, and reports its name.
    pub(super) fn end_recording(&mut self) {
        self.app.recording = false;
        if let Some(recorder) = self.recorder.take() {
            let end = move || recorder.end(true).map_err(|why| why.to_string());
            self.write_file(move || end().map(|name| written(&name)));
        }
    }

    fn palette(&self) -> &'static Palette {
        let named = |p: &&Palette| Some(p.name) == self.app.theme_shown();
        PALETTES.iter().find(named).unwrap_or_else(|| self.style.full().theme.palette())
    }
}

/// Writes a file about the current state into the current folder. Returns a sentence about it.
fn put(stem: &str, ending: &'static str, bytes: &[u8]) -> WriteReport {
    let path =
        new_file::write_new(Path::new(""), stem, ending, bytes).map_err(|why| why.to_string())?;
    Ok(written(&path.display().to_string()))
}

/// Says that a file is written, and in which folder.
fn written(name: &str) -> String {
    let folder = env::current_dir().map(|folder| printable::path(&folder));
    let folder = folder.map_or_else(|_| String::new(), |path| format!(" in {path}"));
    format!("Saved {name}{folder}.")
}
