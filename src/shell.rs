//! The shell: the only doer. Terminal in and out, signals, the frame loop, and what the application asks for.
//!
//! In: what to open and how to show it. Out: how it ended; the terminal as it was. Never here: what a key means, what
//! anything looks like, or how a system moves. The lower part ([`perform`]) knows only a [`Page`] that takes inputs and
//! can be drawn.
//!
//! It is at home on Unix terminals, and speaks to them itself: crossterm's reader panics on a malformed mouse report,
//! spins once the terminal is gone and takes a cut arrow key for Esc; its writer blocks, and asks `NO_COLOR` by itself.
//! No question is ever put to the terminal: answers arrive late over a slow line, or as text in tmux and screen; the
//! environment says what there is to know.

mod checker;
pub mod config;
mod files;
mod input;
mod loader;
pub mod options;
mod panic;
mod product;
mod queue;
mod request;
mod session;
mod signals;
mod stage;
mod store;
mod terminal;

pub use input::{Input, PASTE_LIMIT};
pub use options::Options;
pub use panic::report_panics;
pub use request::{Refusal, Request};
pub use stage::{Ending, Pace, Page, Wish, perform};
pub use store::NoSession;
pub use terminal::NoTerminal;

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

use crate::preset::Catalog;
use session::Session;
use store::Store;

/// Opens the laboratory on the terminal until it is left.
///
/// # Errors
/// Where there is no terminal, no session or nothing of that name, before the screen is touched; and where the session
/// could not be saved, after it was left.
pub fn run(request: &Request) -> Result<Ending, Refusal> {
    NoTerminal::check()?;
    let catalog = Catalog::load();
    let mut request = request.clone();
    let saved = if request.resume { Some(store::read()?) } else { None };
    if let Some(saved) = &saved {
        request.open = Some(saved.open.clone());
    }
    if let Some(name) = &request.open {
        catalog.find(name)?;
    }
    let variable = |name: &str| std::env::var(name).ok();
    let mut session = Session::new(catalog, &request, request.look(&variable))?;
    session.keep_in(Store::open());
    if let Some(saved) = saved {
        session.resume(saved);
    }
    let pace = request.pace(&variable);
    let ended = catch_unwind(AssertUnwindSafe(|| perform(&mut session, pace)));
    let kept = session.keep();
    // The worker may be in the middle of a long step, and nobody waits for it any more.
    std::mem::forget(session);
    let ending = ended.unwrap_or_else(|panic| resume_unwind(panic))?;
    kept.map_err(Refusal::Unsaved)?;
    Ok(ending)
}
