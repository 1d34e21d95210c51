//! Standard output as the program was started with it.
//!
//! In: nothing. Out: whether there is a standard output. Never here: what is written to it.
//!
//! Where it is closed (`>&-`), Rust's runtime opens `/dev/null` in its place before `main`, so that whatever is written would
//! be lost in silence. Whether it is there is found out before the runtime begins.

#![allow(
    unsafe_code,
    reason = "the place of a function in the program's file is given by its section"
)]

use std::io;
use std::sync::atomic::{AtomicBool, Ordering};

use rustix::io::{Errno, fcntl_getfd};

static CLOSED: AtomicBool = AtomicBool::new(false);

extern "C" fn find_out() {
    let found = fcntl_getfd(rustix::stdio::stdout());
    CLOSED.store(found.err() == Some(Errno::BADF), Ordering::Relaxed);
}

/// Run by whatever loads the program, before its `main`; elsewhere a closed output is not noticed. This is sound since
/// [`find_out`] needs nothing of the runtime: it makes a system call and stores its answer.
#[used]
#[cfg_attr(target_os = "linux", unsafe(link_section = ".init_array"))]
#[cfg_attr(target_os = "macos", unsafe(link_section = "__DATA,__mod_init_func"))]
static BEFORE_MAIN: extern "C" fn() = find_out;

/// Standard output, if there is one.
///
/// # Errors
/// Returns an error if the program was started with it closed.
pub(super) fn stdout() -> io::Result<io::Stdout> {
    if CLOSED.load(Ordering::Relaxed) {
        return Err(io::Error::other("it is closed"));
    }
    Ok(io::stdout())
}
