//! The loader: from a name to an experiment, on the side.
//!
//! In: what to open. Out: everything that was made of it, once, or why it could not be. What was asked for before the
//! newest is stopped. Never here: the stages themselves.

use std::sync::Arc;

use super::regular;
use crate::app::LoadError;
use crate::cancel::Cancel;
use crate::experiment::Prepared;
use crate::job::{self, Job};
use crate::preset::Catalog;
use crate::worker::Side;

/// Loads systems, one after the other.
#[derive(Debug)]
pub(super) struct Loader {
    catalog: Arc<Catalog>,
    /// What was asked for last.
    name: String,
    side: Side<Result<Box<Prepared>, String>>,
}

/// What was asked for and what was made of it.
type Outcome = Result<(String, Box<Prepared>), LoadError>;

impl Loader {
    /// A loader that knows these presets.
    pub(super) fn new(catalog: Arc<Catalog>) -> Self {
        Self { catalog, name: String::new(), side: Side::new("loader") }
    }

    /// What is being loaded is no longer wanted.
    pub(super) fn stop(&mut self) {
        self.side.stop();
    }

    /// Begins to load a preset or file, and stops what is still being loaded.
    pub(super) fn load(&mut self, name: String) {
        let (catalog, asked) = (Arc::clone(&self.catalog), name.clone());
        // the token is the system's once it is there
        let job = Job::new("loading", move |progress| prepare(&catalog, &asked, progress.token()));
        self.name = name;
        self.side.begin(0, job);
    }

    /// What was asked for last, once it is there.
    pub(super) fn take(&mut self) -> Option<Outcome> {
        let name = self.name.clone();
        let made = match self.side.take()?.1 {
            job::Outcome::Done(made) => made,
            job::Outcome::Failed(message) => Err(message),
            job::Outcome::Cancelled => return None,
        };
        Some(match made {
            Ok(ready) => Ok((name, ready)),
            Err(message) => Err(LoadError { name, message }),
        })
    }
}

fn prepare(catalog: &Catalog, name: &str, cancel: &Cancel) -> Result<Box<Prepared>, String> {
    let document = regular::find(catalog, name).map_err(|why| why.to_string())?;
    Prepared::with(&document, cancel).map(Box::new).map_err(|unready| unready.report)
}
