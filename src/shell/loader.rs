//! The loader: from a name to an experiment, on a thread of its own.
//!
//! In: what to open. Out: everything that was made of it, once, or why it could not be. What was asked for before the
//! newest is dropped when it comes. Never here: the stages themselves.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;

use crate::analysis::flaws;
use crate::app::LoadFailure;
use crate::experiment::{Experiment, Setup};
use crate::mechanics::{self, Equations};
use crate::model::Model;
use crate::preset::Catalog;
use crate::system::System;

/// A derivation goes as deep as its expressions are nested, and a stranger's file may nest them far.
const STACK: usize = 64 << 20;

/// Loads systems, one after the other.
#[derive(Debug)]
pub(super) struct Loader {
    catalog: Arc<Catalog>,
    newest: u64,
    sender: Sender<(u64, Outcome)>,
    receiver: Receiver<(u64, Outcome)>,
}

type Outcome = Result<Box<Ready>, LoadFailure>;

/// A system on all its stages.
pub(super) struct Ready {
    /// What was asked for.
    pub(super) name: String,
    /// What the file says.
    pub(super) model: Arc<Model>,
    /// What follows from it.
    pub(super) equations: Arc<Equations>,
    /// The same as a program.
    pub(super) system: Arc<System>,
    /// The system in motion.
    pub(super) experiment: Experiment,
}

impl Loader {
    /// A loader that knows these presets.
    pub(super) fn new(catalog: Arc<Catalog>) -> Self {
        let (sender, receiver) = channel();
        Self { catalog, newest: 0, sender, receiver }
    }

    /// Begins to load a preset or file; what is still being loaded is no longer wanted.
    pub(super) fn load(&mut self, name: String) {
        self.newest += 1;
        let (ticket, sender, catalog) =
            (self.newest, self.sender.clone(), Arc::clone(&self.catalog));
        let failed = LoadFailure { name: name.clone(), message: String::new() };
        let work = move || {
            let outcome = catch_unwind(AssertUnwindSafe(|| prepare(&catalog, &name)));
            let outcome = outcome.unwrap_or_else(|panic| Err(defect(panic.as_ref())));
            let outcome = outcome.map_err(|message| LoadFailure { name, message });
            // The program may have ended meanwhile.
            let _ = sender.send((ticket, outcome.map(Box::new)));
        };
        let started =
            thread::Builder::new().name("loader".to_owned()).stack_size(STACK).spawn(work);
        if let Err(error) = started {
            let message = format!("there is no thread to load it on: {error}");
            let _ = self.sender.send((ticket, Err(LoadFailure { message, ..failed })));
        }
    }

    /// What was asked for last, once it is there.
    pub(super) fn take(&mut self) -> Option<Outcome> {
        let newest = self.newest;
        self.receiver.try_iter().find(|(ticket, _)| *ticket == newest).map(|(_, outcome)| outcome)
    }
}

/// All the stages from a name to an experiment; the error is a report for the user.
pub(super) fn prepare(catalog: &Catalog, name: &str) -> Result<Ready, String> {
    let document = catalog.find(name).map_err(|why| why.to_string())?;
    let read = document.read();
    let model = read.map_err(|mistakes| document.report(&mistakes, false))?.model;
    let why = |what: &dyn std::fmt::Display| format!("{}: {what}", document.path);
    let equations = mechanics::derive(&model).map_err(|error| why(&error))?;
    let mistakes = flaws(&model, &equations);
    if !mistakes.is_empty() {
        return Err(document.report(&mistakes, false));
    }
    let system = System::compile(&model, &equations, &[]).map_err(|error| why(&error))?;
    let (model, equations) = (Arc::new(model), Arc::new(equations));
    let experiment = Experiment::new(&model, &equations, &system, Setup::of(&model));
    let experiment = experiment.map_err(|error| why(&error))?;
    Ok(Ready { name: name.to_owned(), model, equations, system: Arc::new(system), experiment })
}

fn defect(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    let reason =
        text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no reason given");
    format!("loading stopped by a defect of the program: {reason}")
}
