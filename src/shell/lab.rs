//! The lab on a terminal: set up, run, and the terminal restored.
//!
//! In: a [`Request`]. Out: how it ended. Never here: the loop itself (`frame_loop`), what a session does.

use std::io::{self, Write};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

use tracing::{error, info};

use super::cast_player::CastPlayer;
use super::demo::Demo;
use super::diagnosis::diagnosis;
use super::frame_loop::{Ending, FramePace, run_screen};
use super::lab_error::LabError;
use super::lesson::LessonScreen;
use super::log::Log;
use super::recording_ahead::{NotRecorded, RecordingAhead};
use super::regular;
use super::request::Request;
use super::session::{ExitResult, Session};
use super::session_file;
use super::store::Store;
use super::terminal::{HEADLESS, RECORDED, TerminalError};
use crate::diagnostic::Diagnostic;
use crate::preset::Catalog;
use crate::record::{Lesson, RecordedCast, Recording, ScriptRunner, screenshot};

/// Opens the laboratory on the terminal until the user leaves it.
///
/// # Errors
/// Returns an error, before the screen is touched, if there is no terminal, no session or nothing of that name; and
/// afterwards if the session could not be saved.
pub fn run(request: &Request) -> Result<Ending, LabError> {
    TerminalError::check(HEADLESS)?;
    let catalog = Catalog::load();
    let mut request = request.clone();
    let saved = if request.resume { Some(session_file::read()?) } else { None };
    if let Some(saved) = &saved {
        request.open = Some(saved.open.clone());
    }
    let (mut offered, mut no_offer) = (None, None);
    if request.open.is_none() {
        match session_file::read() {
            Ok(saved) if regular::find(&catalog, &saved.open).is_ok() => offered = Some(saved),
            Ok(saved) => no_offer = Some(format!("{} no longer exists", saved.open)),
            Err(why) => no_offer = Some(why.to_string()),
        }
    }
    if let Some(name) = &request.open {
        regular::find(&catalog, name)?;
    }
    let variable = |name: &str| std::env::var(name).ok();
    let log = request.log.as_ref().map(Log::open).transpose()?;
    info!("phaselab {} starts", env!("CARGO_PKG_VERSION"));
    for finding in diagnosis(&variable, None) {
        info!("{}: {} ({})", finding.what, finding.found, finding.why);
    }
    if let Some(why) = no_offer {
        info!("nothing to continue: {why}");
    }
    let pace = request.pace(&variable);
    let mut session = Session::new(catalog, &request, request.render_style(&variable), pace)?;
    session.keep_in(Store::open(), request.open.as_deref());
    if let Some(saved) = saved {
        session.resume(saved);
    } else if let Some(offered) = offered {
        session.offer(offered);
    }
    let ended = catch_unwind(AssertUnwindSafe(|| run_screen(&mut session, pace)));
    let ExitResult { recorded, saved } = session.left();
    match &ended {
        Ok(Ok(ending)) => info!("ends: {ending:?}"),
        Ok(Err(error)) => error!("{error}"),
        Err(_) => error!("ends by a panic"),
    }
    if let Err(error) = &saved {
        error!("{error}");
    }
    drop(session);
    if let Some(log) = log {
        log.close();
    }
    let ending = ended.unwrap_or_else(|panic| resume_unwind(panic))?;
    let lost = saved.map_err(LabError::Unsaved).and(recorded.map_err(LabError::Unrecorded));
    match (lost, ending) {
        (Err(why), Ending::Quit) => Err(why),
        (Err(why), Ending::Signal(_) | Ending::HungUp) => {
            // The signal decides the exit status; nothing changes if the message cannot be written.
            let _ = writeln!(io::stderr(), "phaselab: {why}");
            Ok(ending)
        }
        (Ok(()), _) => Ok(ending),
    }
}

/// Shows a cast on the terminal until the user leaves it.
///
/// # Errors
/// Returns an error, before the screen is touched, if there is no terminal.
pub fn show(cast: RecordedCast, request: &Request) -> Result<Ending, LabError> {
    TerminalError::check("")?;
    let variable = |name: &str| std::env::var(name).ok();
    // Nothing in a cast can be clicked, and its text can be selected.
    let pace = FramePace { mouse: false, ..request.pace(&variable) };
    run_screen(&mut CastPlayer::new(cast, request.render_style(&variable)), pace)
}

/// Shows a cast on the terminal while it is being recorded, from its first frame on, until the user leaves it. `begin` begins
/// the recording. Returns also how the recording ended, if it has.
///
/// # Errors
/// Returns an error, before the screen is touched, if there is no terminal.
pub fn show_ahead(
    begin: impl FnOnce() -> RecordingAhead,
    request: &Request,
) -> Result<(Ending, Option<Result<Recording, NotRecorded>>), LabError> {
    TerminalError::check(RECORDED)?;
    let variable = |name: &str| std::env::var(name).ok();
    let pace = FramePace { mouse: false, ..request.pace(&variable) };
    let mut player = CastPlayer::following(begin(), request.render_style(&variable));
    let ending = run_screen(&mut player, pace)?;
    Ok((ending, player.recorded()))
}

/// Performs a demo on the terminal until it ends or the user leaves it. Returns its last picture as text with
/// colours if the user did not leave it before, or what is wrong with its script.
///
/// # Errors
/// Returns an error, before the screen is touched, if there is no terminal.
pub fn play_demo(
    script: ScriptRunner,
    request: &Request,
) -> Result<(Ending, Result<Option<String>, Diagnostic>), LabError> {
    TerminalError::check(RECORDED)?;
    let variable = |name: &str| std::env::var(name).ok();
    let style = request.render_style(&variable);
    let palette = style.theme.palette();
    let mut demo = Demo::new(script, style);
    let pace = FramePace { mouse: false, ..request.pace(&variable) };
    let ending = run_screen(&mut demo, pace)?;
    let text = |picture| screenshot::write(&picture, palette, screenshot::ImageFormat::Ansi, "");
    Ok((ending, demo.outcome().map(|last| last.map(text))))
}

/// Takes a lesson on the terminal until the person leaves it. Returns what is wrong with its script, if anything is.
///
/// # Errors
/// Returns an error, before the screen is touched, if there is no terminal.
pub fn take_lesson(
    lesson: &mut Lesson,
    request: &Request,
) -> Result<(Ending, Result<(), Diagnostic>), LabError> {
    TerminalError::check("")?;
    let variable = |name: &str| std::env::var(name).ok();
    let mut screen = LessonScreen::new(lesson, request.render_style(&variable));
    let ending = run_screen(&mut screen, request.pace(&variable))?;
    Ok((ending, screen.outcome().1))
}
