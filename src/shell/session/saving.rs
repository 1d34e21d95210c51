//! Saving: the session and the unsaved texts, kept in a store while the laboratory is open and at its end.
//!
//! In: the application's state, and the time that has passed. Out: what the store is given, and what it had. Never
//! here: the files of the store.

use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;

use tracing::{error, info};

use super::super::atomic_file;
use super::super::store::{Store, StoreError};
use super::{Session, Since, UNHURRIED};
use crate::app::{AppEvent, LoadError, Notification, Unsaved};
use crate::preset::{PresetOrigin, is_path};

/// The interval at which the session is saved while the laboratory is open, the delay before typed text is stored,
/// and the interval of checks whether another program that saves its session has ended.
const SAVING: Duration = Duration::from_secs(15);
const TEXTS: Duration = Duration::from_secs(1);
const TAKING_OVER: Duration = Duration::from_secs(1);

impl Session {
    /// Saves the session in a store from now on, and restores the texts stored there; `open` is the requested name.
    /// Whatever cannot be stored is reported to the user.
    pub(in crate::shell) fn keep_in(
        &mut self,
        store: Result<Store, StoreError>,
        open: Option<&str>,
    ) {
        let mut troubles = match store {
            Err(why) => vec![why.to_string()],
            Ok(mut store) => {
                self.take_texts(store.texts().to_vec(), open);
                self.app.workbench.keeps = store.keeps_texts();
                let troubles = std::mem::take(&mut store.troubles);
                self.saving.store = Some(store);
                troubles
            }
        };
        let left = atomic_file::left_behind(Path::new("."));
        if let Some(first) = left.first() {
            let more = if left.len() > 1 {
                format!(" and {} more", left.len() - 1)
            } else {
                String::new()
            };
            let first = first.strip_prefix(".").unwrap_or(first).display();
            troubles.push(format!("unfinished files were left here: {first}{more}"));
        }
        if !troubles.is_empty() {
            let report = troubles.join("; ");
            self.app.notifications.show(Notification::error(&report));
            self.warning = Some(report);
        }
    }

    /// Restores stored texts under the names that their systems have in this program.
    fn take_texts(&mut self, texts: Vec<Unsaved>, open: Option<&str>) {
        let own = self.app.picker.entries.iter().filter_map(|entry| match &entry.origin {
            PresetOrigin::User(path) => Some((entry.name.as_str(), path.as_path())),
            PresetOrigin::Shipped => None,
        });
        let open = open.filter(|open| is_path(open)).map(|open| (open, Path::new(open)));
        let names: Vec<_> = open.into_iter().chain(own).collect();
        let texts = texts.into_iter().map(|text| called(text, &names)).collect();
        self.app.workbench.put(texts);
    }

    /// Queues the current session and the unsaved texts for saving, without waiting for the disk.
    pub(super) fn keep(&mut self, last: bool) -> io::Result<()> {
        self.saving.since = Since::default();
        if let Some(snapshot) = self.worker.newest() {
            self.update(AppEvent::Snapshot(snapshot));
        }
        self.keep_texts(last);
        let Some(store) = &mut self.saving.store else { return Ok(()) };
        if let Some(mut saved) = self.app.saved() {
            saved.open = absolute(saved.open)?;
            store.save(saved);
        }
        Ok(())
    }

    /// Queues the unsaved texts for storing.
    fn keep_texts(&mut self, last: bool) {
        self.saving.since.texts = Duration::ZERO;
        self.saving.stored_texts = self.app.workbench.revision();
        let Some(store) = &mut self.saving.store else { return };
        // If the file cannot be resolved, the text is stored under its current name.
        let place = |text: Unsaved| placed(text.clone()).unwrap_or(text);
        store.keep_texts(self.app.unsaved().into_iter().map(place).collect(), last);
    }

    /// Saves the session and the texts, waiting for the disk at most this long.
    pub(super) fn keep_within(&mut self, time: Duration) -> io::Result<()> {
        self.keep(true)?;
        let Some(store) = &mut self.saving.store else { return Ok(()) };
        let first = store.wait_for_errors(time).into_iter().next();
        self.app.workbench.keeps = store.keeps_texts();
        first.map_or(Ok(()), Err)
    }

    /// Whether the program may end. It may not before the user has been warned of the loss of a text. A text that has
    /// its file outlives the program, so the disk is not waited for.
    pub(super) fn may_end(&mut self) -> bool {
        if !self.app.workbench.keeps || self.app.unsaved().is_empty() {
            return true;
        }
        if let Some(store) = &self.saving.store {
            store.hurry(true);
        }
        if let Err(error) = self.keep_within(UNHURRIED) {
            error!("{error}");
        }
        if !self.app.workbench.keeps {
            if let Some(store) = &self.saving.store {
                store.hurry(false);
            }
            self.app.stay();
        }
        self.app.workbench.keeps
    }

    /// Saves the session and the texts periodically. An error is reported only once; it will occur again at the
    /// end.
    pub(super) fn save_periodically(&mut self, elapsed: Duration) {
        let since = &mut self.saving.since;
        for time in [&mut since.saved, &mut since.texts, &mut since.checked] {
            *time = time.saturating_add(elapsed);
        }
        if self.saving.since.checked >= TAKING_OVER {
            self.saving.since.checked = Duration::ZERO;
            self.take_over();
        }
        let mut errors = Vec::new();
        if self.saving.since.saved >= SAVING {
            errors.extend(self.keep(false).err());
        } else if self.saving.since.texts >= TEXTS
            && self.saving.stored_texts != self.app.workbench.revision()
        {
            self.keep_texts(false);
        }
        if let Some(store) = &mut self.saving.store {
            errors.extend(store.errors());
            self.app.workbench.keeps = store.keeps_texts();
        }
        if let Some(error) = errors.first() {
            let report = error.to_string();
            if self.warning.as_ref() != Some(&report) {
                self.app.notifications.show(Notification::error(&report));
                self.warning = Some(report);
            }
        }
    }

    /// Takes over saving the session if the program that did so has ended.
    fn take_over(&mut self) {
        let Some(store) = &mut self.saving.store else { return };
        let Some(texts) = store.take_over() else { return };
        let troubles = std::mem::take(&mut store.troubles);
        let mut report =
            vec!["The other phaselab has ended; this one saves the session now.".into()];
        report.extend(troubles);
        info!("{}", report.join(" "));
        self.app.notifications.show(Notification::info(report.join(" ")));
        self.warning = None;
        self.take_texts(texts, None);
        self.keep_texts(false);
    }

    /// Adds the location of an unsaved text to the message about a system that cannot be loaded.
    pub(super) fn with_text_saved(&self, mut error: LoadError) -> LoadError {
        let place = self.saving.store.as_ref().and_then(Store::place_of_texts);
        let unsaved = self.app.unsaved().iter().any(|text| text.name == error.name);
        if let Some(place) = place.filter(|_| unsaved) {
            let place = place.display();
            error.message += &format!("\n\nIts unsaved text is in {place}.\n");
        }
        error
    }
}

/// Returns a name that is valid whatever folder the program is next started in.
fn absolute(name: String) -> io::Result<String> {
    if !is_path(&name) {
        return Ok(name);
    }
    Ok(std::path::absolute(&name)?.display().to_string())
}

/// Returns the canonical path of a file, with links resolved, even if the file does not exist.
fn identity(path: &Path) -> io::Result<PathBuf> {
    let whole = std::path::absolute(path)?;
    if let Ok(real) = whole.canonicalize() {
        return Ok(real);
    }
    let folder = whole.parent().and_then(|folder| folder.canonicalize().ok());
    Ok(match (folder, whole.file_name()) {
        (Some(folder), Some(name)) => folder.join(name),
        _ => whole,
    })
}

/// Identifies a text by the canonical path of its file, so that it is found again from any folder and under any
/// spelling.
fn placed(text: Unsaved) -> io::Result<Unsaved> {
    let place = text.place.map(|place| identity(&place)).transpose()?;
    let name = if is_path(&text.name) {
        identity(Path::new(&text.name))?.display().to_string()
    } else {
        text.name
    };
    Ok(Unsaved { name, place, ..text })
}

/// Renames a restored text to the one of these names that denotes its file, if there is one.
fn called(text: Unsaved, names: &[(&str, &Path)]) -> Unsaved {
    let own = is_path(&text.name).then(|| PathBuf::from(&text.name)).or(text.place.clone());
    let Some(file) = own.and_then(|own| identity(&own).ok()) else { return text };
    let same = |path: &Path| identity(path).is_ok_and(|path| path == file);
    match names.iter().find(|(_, path)| same(path)) {
        Some((name, path)) => {
            Unsaved { name: (*name).to_owned(), place: Some(path.to_path_buf()), ..text }
        }
        None => text,
    }
}
