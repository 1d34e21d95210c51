//! Panics: the terminal is restored before anyone reads about them.
//!
//! In: a panic on any thread. Out: on the thread that holds the terminal, the terminal as it was, then the report, and
//! the exit status 101 by unwinding; on any other thread no report, for it is caught where the thread was started, and
//! writing about it would spoil the screen. The log has both. Never here: catching.

use std::io::{Write, stderr};
use std::panic;
use std::sync::Arc;
use std::thread;

use color_eyre::Result;
use color_eyre::config::{HookBuilder, Theme};

use super::terminal::Terminal;

/// Has panics and errors reported plainly, without colours, as what they are. Once, before anything else.
///
/// # Errors
/// Where reports have been set up before.
pub fn report_panics() -> Result<()> {
    let (report, errors) = HookBuilder::default()
        .theme(Theme::new())
        .panic_section(
            "This is a defect of phaselab. What you did before it, and the lines above, help to mend it.",
        )
        .try_into_hooks()?;
    errors.install()?;
    panic::set_hook(Box::new(move |info| {
        // Where nobody can read it, another panic would abort and leave the terminal as it is.
        let _ = writeln!(stderr(), "{}", report.panic_report(info));
    }));
    Ok(())
}

/// Puts the present panic hook behind the restoring of this terminal, for the thread that calls it.
pub(super) fn guard(terminal: &Arc<Terminal>) {
    let report = panic::take_hook();
    let terminal = Arc::clone(terminal);
    let holder = thread::current().id();
    panic::set_hook(Box::new(move |info| {
        tracing::error!("{info}");
        if thread::current().id() == holder {
            terminal.leave();
        } else if terminal.is_held() {
            return;
        }
        report(info);
    }));
}
