//! The loader: from a name to an experiment, on a thread of its own.
//!
//! In: what to open. Out: everything that was made of it, once, or why it could not be. What was asked for before the
//! newest is stopped. Never here: the stages themselves.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;

use super::regular;
use crate::app::LoadError;
use crate::cancel::Cancel;
use crate::experiment::Prepared;
use crate::preset::Catalog;

/// A derivation goes as deep as its expressions are nested, and a stranger's file may nest them far.
pub(super) const STACK: usize = 64 << 20;

/// Loads systems, one after the other.
#[derive(Debug)]
pub(super) struct Loader {
    catalog: Arc<Catalog>,
    newest: u64,
    sender: Sender<(u64, Outcome)>,
    receiver: Receiver<(u64, Outcome)>,
    /// Stops what is being loaded.
    cancel: Option<Cancel>,
}

/// What was asked for and what was made of it.
type Outcome = Result<(String, Box<Prepared>), LoadError>;

impl Loader {
    /// A loader that knows these presets.
    pub(super) fn new(catalog: Arc<Catalog>) -> Self {
        let (sender, receiver) = channel();
        Self { catalog, newest: 0, sender, receiver, cancel: None }
    }

    /// What is being loaded is no longer wanted.
    pub(super) fn stop(&mut self) {
        self.newest += 1;
        if let Some(cancel) = self.cancel.take() {
            cancel.cancel();
        }
    }

    /// Begins to load a preset or file, and stops what is still being loaded.
    pub(super) fn load(&mut self, name: String) {
        self.stop();
        let cancel = Cancel::new();
        self.cancel = Some(cancel.clone());
        let (ticket, sender, catalog) =
            (self.newest, self.sender.clone(), Arc::clone(&self.catalog));
        let failed = LoadError { name: name.clone(), message: String::new() };
        let work = move || {
            let outcome = catch_unwind(AssertUnwindSafe(|| prepare(&catalog, &name, &cancel)));
            if cancel.is_cancelled() {
                // nobody waits for it, and it is large
                return;
            }
            let outcome = outcome.unwrap_or_else(|panic| Err(defect(panic.as_ref())));
            let outcome = match outcome {
                Ok(ready) => Ok((name, Box::new(ready))),
                Err(message) => Err(LoadError { name, message }),
            };
            // The program may have ended meanwhile.
            let _ = sender.send((ticket, outcome));
        };
        let started =
            thread::Builder::new().name("loader".to_owned()).stack_size(STACK).spawn(work);
        if let Err(error) = started {
            let message = format!("there is no thread to load it on: {error}");
            let _ = self.sender.send((ticket, Err(LoadError { message, ..failed })));
        }
    }

    /// What was asked for last, once it is there.
    pub(super) fn take(&mut self) -> Option<Outcome> {
        let newest = self.newest;
        let (_, outcome) = self.receiver.try_iter().find(|(ticket, _)| *ticket == newest)?;
        // the token is the system's from now on
        self.cancel = None;
        Some(outcome)
    }
}

impl Drop for Loader {
    fn drop(&mut self) {
        self.stop();
    }
}

fn prepare(catalog: &Catalog, name: &str, cancel: &Cancel) -> Result<Prepared, String> {
    let document = regular::find(catalog, name).map_err(|why| why.to_string())?;
    Prepared::with(&document, cancel).map_err(|unready| unready.report)
}

/// What is reported of a panic of a stage.
pub(super) fn defect(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    let reason =
        text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no reason given");
    format!("loading stopped by a defect of the program: {reason}")
}
