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

mod input;
mod loader;
mod panic;
mod queue;
mod request;
mod session;
mod signals;
mod stage;
mod terminal;

pub use input::{Input, PASTE_LIMIT};
pub use panic::report_panics;
pub use request::{Refusal, Request};
pub use stage::{Ending, Pace, Page, Wish, perform};
pub use terminal::NoTerminal;

use crate::preset::Catalog;
use session::Session;

/// Opens the laboratory on the terminal until it is left.
///
/// # Errors
/// Where there is no terminal or nothing of that name; before the screen is touched.
pub fn run(request: &Request) -> Result<Ending, Refusal> {
    NoTerminal::check()?;
    let catalog = Catalog::load();
    if let Some(name) = &request.open {
        catalog.find(name)?;
    }
    let variable = |name: &str| std::env::var(name).ok();
    let mut session = Session::new(catalog, request, request.look(&variable))?;
    let ending = perform(&mut session, request.pace(&variable));
    // The worker may be in the middle of a long step, and nobody waits for it any more.
    std::mem::forget(session);
    ending
}
