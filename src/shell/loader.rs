//! The loader: builds an experiment from a name, in the background.
//!
//! In: what to open. Out: all that was built from it, once, or the reason why it failed. A new request cancels the
//! previous one. Never here: the stages themselves.

use std::sync::Arc;

use super::regular;
use crate::app::LoadError;
use crate::cancel::Cancel;
use crate::experiment::Prepared;
use crate::job::{self, Job};
use crate::preset::Catalog;
use crate::worker::SideJob;

/// Loads systems, one after the other.
#[derive(Debug)]
pub(super) struct Loader {
    catalog: Arc<Catalog>,
    /// The name requested last, and the number of that request: a load that ends while it is replaced is not its answer.
    name: String,
    request: u64,
    side: SideJob<Result<Box<Prepared>, String>>,
}

/// The requested name with the prepared experiment, or an error.
type LoadOutcome = Result<(String, Box<Prepared>), LoadError>;

impl Loader {
    pub(super) fn new(catalog: Arc<Catalog>) -> Self {
        Self { catalog, name: String::new(), request: 0, side: SideJob::new("loader") }
    }

    /// Cancels the load under way.
    pub(super) fn stop(&mut self) {
        self.side.stop();
    }

    /// Starts to load a preset or file, and cancels the previous load.
    pub(super) fn load(&mut self, name: String) {
        let (catalog, asked) = (Arc::clone(&self.catalog), name.clone());
        // The token passes to the system once that exists.
        let job = Job::new("loading", move |progress| prepare(&catalog, &asked, progress.token()));
        self.name = name;
        self.request += 1;
        self.side.begin(self.request, job);
    }

    /// Returns the outcome of the latest request as soon as there is one.
    pub(super) fn take(&mut self) -> Option<LoadOutcome> {
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
    Prepared::with(&document, cancel).map(Box::new).map_err(|error| error.report)
}
