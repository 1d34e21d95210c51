//! Scripts read: line by line, with every error in its place.
//!
//! In: a text. Out: a [`Script`], or its errors. Never here: what one command means.

use std::collections::HashMap;

use super::command::ParsedLine;
use super::line::{LineText, ScriptLine};
use super::{COMMANDS, LONGEST, PACE, Script, ScriptHeader, ScriptStep};
use crate::diagnostic::{Diagnostic, Document, SourceRange, nearest};
use crate::record::clock::{Micros, SECOND};

impl ScriptHeader {
    /// Reads the settings of a script, which stand before its first step; the steps are not read.
    ///
    /// # Errors
    /// Returns every error up to there with its range.
    pub fn read(document: &Document) -> Result<ScriptHeader, Vec<Diagnostic>> {
        let reading = ScriptReading::of(document, |reading| reading.steps.is_empty())?;
        if reading.diagnostics.is_empty() { Ok(reading.head) } else { Err(reading.diagnostics) }
    }
}

impl Script {
    /// Reads a script.
    ///
    /// # Errors
    /// Returns every error with its range.
    pub fn read(document: &Document) -> Result<Script, Vec<Diagnostic>> {
        let reading = ScriptReading::of(document, |_| true)?;
        reading.conclude(document.text.len())
    }

    /// The duration, without the time for keys.
    fn length(&self) -> Micros {
        let (mut pace, mut length) = (PACE, 0_u64);
        for (_, step) in &self.steps {
            length = length.saturating_add(match step {
                ScriptStep::Pace(time) => {
                    pace = *time;
                    0
                }
                ScriptStep::Wait(time) | ScriptStep::Sweep { time, .. } => *time,
                ScriptStep::Press(keys) => pace.saturating_mul(keys.len() as u64),
                ScriptStep::Type(text) => pace.saturating_mul(text.chars().count() as u64),
                _ => 0,
            });
        }
        length
    }
}

#[derive(Default)]
struct ScriptReading {
    head: ScriptHeader,
    given: HashMap<&'static str, SourceRange>,
    steps: Vec<(SourceRange, ScriptStep)>,
    markers: HashMap<String, SourceRange>,
    diagnostics: Vec<Diagnostic>,
}

const MOST_ERRORS: usize = 100;

impl ScriptReading {
    /// Reads the lines of a text for as long as a condition holds.
    fn of(document: &Document, continues: impl Fn(&Self) -> bool) -> Result<Self, Vec<Diagnostic>> {
        if let Some(diagnostic) = document.unreadable() {
            return Err(vec![diagnostic.clone()]);
        }
        // editors put a byte order mark in front
        let text = document.text.strip_prefix('\u{feff}').unwrap_or(&document.text);
        let (mut reading, mut start) = (Self::default(), document.text.len() - text.len());
        for text in text.split('\n') {
            reading.line(text.strip_suffix('\r').unwrap_or(text), start);
            start += text.len() + 1;
            if !continues(&reading) {
                break;
            }
        }
        Ok(reading)
    }

    /// Reads one line of the text, which begins at this byte.
    fn line(&mut self, text: &str, start: usize) {
        let mut line = ScriptLine::new(text, start);
        let Some(word) = line.word() else { return };
        if let Err(diagnostic) = self.command(&word, &mut line)
            && self.diagnostics.len() < MOST_ERRORS
        {
            self.diagnostics.push(diagnostic);
        }
    }

    fn command(&mut self, word: &LineText, line: &mut ScriptLine<'_>) -> Result<(), Diagnostic> {
        let command = COMMANDS.iter().find(|command| command.name == word.text);
        let command = command.ok_or_else(|| unknown(word))?;
        let parsed = (command.read)(line)?;
        line.end(command.form)?;
        let place = word.place.start..line.here();
        match parsed {
            ParsedLine::Setting(say) => {
                if !self.steps.is_empty() {
                    let message = format!("`{}` comes too late: the demo has begun", word.text);
                    let help = "settings of the whole demo come before its first step";
                    return Err(Diagnostic::error(word.place.clone(), message).with_help(help));
                }
                if let Some(first) = self.given.insert(command.name, word.place.clone()) {
                    let message = format!("`{}` is given twice", word.text);
                    let diagnostic = Diagnostic::error(word.place.clone(), message);
                    return Err(diagnostic.with_also(first, "it was given here"));
                }
                say(&mut self.head);
            }
            ParsedLine::Step(step) => {
                if let ScriptStep::Marker(name) = &step
                    && let Some(first) = self.markers.insert(name.clone(), place.clone())
                {
                    let message = format!("there are two markers `{name}`");
                    let help = "a player finds a chapter by its name: give each its own";
                    let diagnostic = Diagnostic::error(place, message).with_help(help);
                    return Err(diagnostic.with_also(first, "the first one"));
                }
                self.steps.push((place, step));
            }
        }
        Ok(())
    }

    fn conclude(mut self, end: usize) -> Result<Script, Vec<Diagnostic>> {
        let script = Script { head: self.head, steps: self.steps };
        if let Some((width, _)) = script.head.size {
            let room = Script::caption_room(width);
            for (place, step) in &script.steps {
                if let ScriptStep::Caption(text) = step
                    && text.chars().count() > room
                {
                    let many = text.chars().count();
                    let message = format!(
                        "a caption may have {room} characters at this size; this one has {many}"
                    );
                    self.diagnostics.push(Diagnostic::error(place.clone(), message));
                }
            }
        }
        let length = script.length();
        if self.diagnostics.is_empty() && length > LONGEST * SECOND {
            let message = format!("a demo may last an hour; this one lasts {} s", length / SECOND);
            self.diagnostics.push(Diagnostic::error(end..end, message));
        }
        if self.diagnostics.is_empty() && length.saturating_mul(script.head.fps.into()) < SECOND {
            let message = "there is nothing to see: no time passes in this script";
            let help = "let it pass with `Wait 2s`";
            self.diagnostics.push(Diagnostic::error(end..end, message).with_help(help));
        }
        if self.diagnostics.is_empty() { Ok(script) } else { Err(self.diagnostics) }
    }
}

fn unknown(word: &LineText) -> Diagnostic {
    let message = format!("unknown command `{}`", word.text);
    let diagnostic = Diagnostic::error(word.place.clone(), message);
    let names = COMMANDS.iter().map(|command| command.name);
    match nearest(&word.text, names.clone()) {
        Some(near) => diagnostic.with_help(format!("did you mean `{near}`?")),
        None => diagnostic
            .with_help(format!("a line begins with {}", names.collect::<Vec<_>>().join(" "))),
    }
}
