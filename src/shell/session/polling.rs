//! What is polled between frames: the file on the disk, the checker's answer, background jobs, errors of the motion.
//!
//! In: the time that has passed. Out: events for the application. Never here: frames, keys.

use std::path::Path;
use std::time::Duration;

use tracing::{error, info};

use super::super::files::FileChange;
use super::Session;
use crate::app::{AppEvent, CheckedText};
use crate::experiment::Status;
use crate::preset::is_path;

impl Session {
    /// Checks the file of the system being loaded or in the lab. Returns whether it has changed.
    pub(super) fn watch(&mut self, elapsed: Duration) -> bool {
        if let Some(watch) = &mut self.watch
            && let Some(name) = self.app.loading().filter(|name| is_path(name))
        {
            // The file has changed while it was being loaded.
            if let Some(FileChange::Text { .. }) = watch.poll(Path::new(name), elapsed) {
                info!("load {name} again");
                self.loader.load(name.to_owned());
            }
            return false;
        }
        if let Some(watch) = &mut self.watch
            && let Some(name) = self.app.failed_system().filter(|name| is_path(name))
        {
            // This file could not be loaded at all.
            let Some(FileChange::Text { .. }) = watch.poll(Path::new(name), elapsed) else {
                return false;
            };
            let effects = self.app.again();
            self.execute(effects);
            return true;
        }
        let open = self.app.page != crate::app::Page::Picker;
        let Some((watch, place)) = self.watch.as_mut().zip(self.app.file().filter(|_| open)) else {
            return false;
        };
        match watch.poll(&place, elapsed) {
            None => return false,
            Some(FileChange::Removed) => {
                info!("{} is gone", place.display());
                self.update(AppEvent::FileThere(false));
            }
            Some(FileChange::Text { text, back }) => {
                if back {
                    self.update(AppEvent::FileThere(true));
                }
                self.update(AppEvent::FileRead { text, asked: false });
            }
        }
        true
    }

    /// Takes in the result of a check, if there is one; a correct system runs at once. Returns whether there was
    /// one.
    pub(super) fn answer(&mut self) -> bool {
        let Some(answer) = self.checker.take() else { return false };
        let name = self.app.checked_system();
        let Some(name) = name.filter(|_| self.app.awaits(answer.ticket)) else { return false };
        let outcome = answer.outcome.map(|ready| self.begin(name, *ready));
        let (ticket, took) = (answer.ticket, Some(answer.took));
        self.update(AppEvent::Checked(Box::new(CheckedText { ticket, outcome, took })));
        true
    }

    /// Takes in the outcomes and the progress of background jobs. Returns whether there are any jobs.
    pub(super) fn poll_jobs(&mut self) -> bool {
        let mut events = Vec::new();
        let mut busy = false;
        for side in self.sides.values_mut() {
            busy |= side.is_busy();
            if let Some((ticket, outcome)) = side.take() {
                events.push(AppEvent::Computed { ticket, outcome });
            } else if let Some((ticket, share)) = side.share() {
                events.push(AppEvent::Progress { ticket, share });
            }
        }
        for event in events {
            self.update(event);
        }
        busy
    }

    /// Logs each error of the motion once.
    pub(super) fn report_errors(&mut self) {
        let error = match self.app.snapshot().map(|snapshot| &snapshot.status) {
            Some(Status::Failed(error)) => {
                Some(format!("at t = {}: {}", error.time, error.message))
            }
            _ => None,
        };
        if error != self.error {
            if let Some(error) = &error {
                error!("{error}");
            }
            self.error = error;
        }
    }
}
