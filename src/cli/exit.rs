//! Exit codes: one row each, from which the help, the manual page and the README are made.
//!
//! In: nothing. Out: [`EXITS`]. Never here: which failure has which code.

/// An exit code with its meaning.
#[derive(Clone, Copy, Debug)]
pub struct Exit {
    /// The code, or how it is computed.
    pub code: &'static str,
    /// When it is used.
    pub when: &'static str,
}

pub(super) const DONE: u8 = 0;
/// The request could not be fulfilled.
pub(super) const COULD_NOT: u8 = 1;
pub(super) const WRONG_USE: u8 = 2;
/// A file is wrong: `EX_DATAERR` of BSD's `sysexits.h`.
pub(super) const WRONG_FILE: u8 = 65;
/// Output could not be written: `EX_IOERR` of BSD's `sysexits.h`.
pub(super) const COULD_NOT_WRITE: u8 = 74;
/// The base to which a signal's number is added.
pub(super) const SIGNAL: u8 = 128;

const fn exit(code: &'static str, when: &'static str) -> Exit {
    Exit { code, when }
}

/// Every exit code, in order.
pub const EXITS: &[Exit] = &[
    exit("0", "success, even if the output is not read to its end (| head)"),
    exit(
        "1",
        "failed: the motion could not continue (a singular mass matrix, a state that is not finite); \
         the rows so far are written",
    ),
    exit(
        "2",
        "wrong use: an unknown name or option, a value out of place, a file that cannot be read, \
         or no terminal for the lab",
    ),
    exit(
        "65",
        "a file is wrong: a system, a script, the configuration; its errors are reported in their \
         places",
    ),
    exit("74", "output could not be written; an existing file is unchanged"),
    exit("101", "a panic: a bug in phaselab; the terminal is restored first"),
    exit("129", "ended by a signal: the terminal has hung up"),
    exit("130", "ended by a signal: interrupted (Ctrl-C)"),
    exit("131", "ended by a signal: quit"),
    exit("143", "ended by a signal: asked to terminate"),
];

/// The rows as lines of a help text, `width` characters wide.
pub(super) fn lines(width: usize) -> String {
    let mut text = String::new();
    for Exit { code, when } in EXITS {
        let mut line = format!("  {code:>3} ");
        for word in when.split(' ') {
            if line.chars().count() + 1 + word.chars().count() > width {
                text.push_str(&line);
                text.push('\n');
                line = " ".repeat(6);
            }
            line.push(' ');
            line.push_str(word);
        }
        text.push_str(&line);
        text.push('\n');
    }
    text.truncate(text.trim_end().len());
    text
}
