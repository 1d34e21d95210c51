//! Panics: the terminal is restored before they are reported.
//!
//! In: a panic on any thread. Out: on the thread that owns the terminal, the restored terminal, then the report,
//! and the exit status 101 by unwinding. On any other thread there is no report, since the panic is caught where
//! the thread was started and a report would spoil the screen. The log has both. Never here: catching.

use std::io::{Write, stderr};
use std::panic;
use std::sync::Arc;
use std::thread;

use color_eyre::Result;
use color_eyre::config::{HookBuilder, Theme};

use super::terminal::Terminal;

/// Installs plain reports of panics and errors, without colours. Call it once, before anything else.
///
/// # Errors
/// Returns an error if reports have been set up before.
pub fn report_panics() -> Result<()> {
    let (report, errors) = HookBuilder::default()
        .theme(Theme::new())
        .panic_section(
            "This is a bug in phaselab. A report of what you did before it, with the lines above, helps to fix it.",
        )
        .try_into_hooks()?;
    errors.install()?;
    panic::set_hook(Box::new(move |info| {
        // If it cannot be written, another panic would abort the program without restoring the terminal.
        let _ = writeln!(stderr(), "{}", report.panic_report(info));
    }));
    Ok(())
}

/// Restores this terminal before the current panic hook runs, for panics of the calling thread.
pub(super) fn guard(terminal: &Arc<Terminal>) {
    let report = panic::take_hook();
    let terminal = Arc::clone(terminal);
    let holder = thread::current().id();
    panic::set_hook(Box::new(move |info| {
        tracing::error!("{info}");
        if thread::current().id() == holder {
            terminal.leave();
        } else if terminal.is_changed() {
            return;
        }
        report(info);
    }));
}
