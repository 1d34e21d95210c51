//! The shell: the only doer. Terminal in and out, signals, the frame loop, and what the application asks for.
//!
//! In: what to open and how to show it. Out: how it ended; the terminal as it was. Never here: what a key means, what
//! anything looks like, or how a system moves. The lower part ([`perform`]) knows only a [`Screen`] that takes inputs and
//! can be drawn.
//!
//! It is at home on Unix terminals, and speaks to them itself: crossterm's reader panics on a malformed mouse report,
//! spins once the terminal is gone and takes a cut arrow key for Esc; its writer blocks, and asks `NO_COLOR` by itself.
//! No question is ever put to the terminal: answers arrive late over a slow line, or as text in tmux and screen; the
//! environment says what there is to know.

mod bandwidth;
mod cast_player;
mod checker;
pub mod config;
mod demo;
mod diagnosis;
mod file_writer;
mod files;
mod frame_loop;
mod fresh;
mod governor;
mod input;
mod job;
mod loader;
mod log;
pub mod options;
mod panic;
mod partial;
mod product;
mod queue;
mod recorder;
mod regular;
mod request;
mod session;
mod signals;
mod store;
mod terminal;
pub(crate) mod whole;

pub use bandwidth::{Bandwidth, BandwidthError};
pub use cast_player::CastPlayer;
pub use diagnosis::{Finding, diagnosis};
pub use frame_loop::{Ending, Pace, Screen, ScreenRequest, perform};
pub use input::{Input, PASTE_LIMIT};
pub use log::{LogError, LogFile};
pub use options::Options;
pub use panic::report_panics;
pub use request::{LabError, MOST_FRAMES, Request};
pub use store::SessionError;
pub use terminal::TerminalError;

use std::io::{self, Write};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

use crate::diagnostic::Diagnostic;
use crate::preset::Catalog;
use crate::record::{RecordedCast, ScriptRunner, screenshot};
use demo::Demo;
use log::Log;
pub(crate) use partial::remove_all as remove_partial_files;
use session::{Left, Session};
use store::Store;

/// Opens the laboratory on the terminal until it is left.
///
/// # Errors
/// Where there is no terminal, no session or nothing of that name, before the screen is touched; and where the session
/// could not be saved, after it was left.
pub fn run(request: &Request) -> Result<Ending, LabError> {
    TerminalError::check()?;
    let catalog = Catalog::load();
    let mut request = request.clone();
    let saved = if request.resume { Some(store::read()?) } else { None };
    if let Some(saved) = &saved {
        request.open = Some(saved.open.clone());
    }
    if let Some(name) = &request.open {
        regular::find(&catalog, name)?;
    }
    let variable = |name: &str| std::env::var(name).ok();
    let mut log = request.log.as_ref().map_or(Ok(Log::default()), Log::open)?;
    log.info(format!("phaselab {} starts", env!("CARGO_PKG_VERSION")));
    for finding in diagnosis(&variable, None) {
        log.info(format!("{}: {} ({})", finding.what, finding.found, finding.why));
    }
    log.guard();
    let pace = request.pace(&variable);
    let mut session = Session::new(catalog, &request, request.look(&variable), pace, log)?;
    session.keep_in(Store::open(), request.open.as_deref());
    if let Some(saved) = saved {
        session.resume(saved);
    }
    let ended = catch_unwind(AssertUnwindSafe(|| perform(&mut session, pace)));
    let Left { recorded, kept } = session.left();
    match &ended {
        Ok(Ok(ending)) => session.log.info(format!("ends: {ending:?}")),
        Ok(Err(refusal)) => session.log.error(refusal),
        Err(_) => session.log.error("ends by a panic"),
    }
    if let Err(error) = &kept {
        session.log.error(error);
    }
    session.log.close();
    drop(session);
    let ending = ended.unwrap_or_else(|panic| resume_unwind(panic))?;
    let lost = kept.map_err(LabError::Unsaved).and(recorded.map_err(LabError::Unrecorded));
    match (lost, ending) {
        (Err(why), Ending::Quit) => Err(why),
        (Err(why), Ending::Signal(_) | Ending::Gone) => {
            // the signal decides how it ends; where nobody can read this it makes no difference
            let _ = writeln!(io::stderr(), "phaselab: {why}");
            Ok(ending)
        }
        (Ok(()), _) => Ok(ending),
    }
}

/// Shows a tape on the terminal until it is left.
///
/// # Errors
/// Where there is no terminal, before the screen is touched.
pub fn show(tape: RecordedCast, request: &Request) -> Result<Ending, LabError> {
    TerminalError::check()?;
    let variable = |name: &str| std::env::var(name).ok();
    perform(&mut CastPlayer::new(tape, request.look(&variable)), request.pace(&variable))
}

/// Performs a demo on the terminal until it ends or is left. What it ends with: its last picture as text with colours, where
/// it was not left before; or what is wrong with its script.
///
/// # Errors
/// Where there is no terminal, before the screen is touched.
pub fn perform_demo(
    performance: ScriptRunner,
    request: &Request,
) -> Result<(Ending, Result<Option<String>, Diagnostic>), LabError> {
    TerminalError::check()?;
    let variable = |name: &str| std::env::var(name).ok();
    let look = request.look(&variable);
    let palette = look.theme.palette();
    let mut demo = Demo::new(performance, look);
    let ending = perform(&mut demo, request.pace(&variable))?;
    let text = |picture| still::write(&picture, palette, still::Form::Ansi, "");
    Ok((ending, demo.outcome().map(|last| last.map(text))))
}
