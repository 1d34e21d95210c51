//! Text that is safe to show: characters that would control a terminal, or reorder or hide the text
//! beside them, are escaped (`\u{9b}`).
//!
//! In: text of a file, a name, an argument, a path. Out: the same text with such characters
//! escaped. Everything quoted is escaped here when it is written. Never here: colours, files.

use std::borrow::Cow;
use std::ffi::OsStr;
use std::fmt::Write;
use std::io::{self, ErrorKind};
use std::path::Path;

/// The largest number of characters of a text quoted in a sentence.
pub const QUOTED: usize = 80;

/// Beyond these magnitudes a number is written with an exponent, because it would have too many
/// digits.
const LARGE: f64 = 1e15;
const SMALL: f64 = 1e-5;

/// Returns whether a character has an effect on the terminal or the text around it: controls (C0,
/// DEL, C1), directional marks, line and paragraph separators, and characters without width or
/// shape (joiners, tags, the byte order mark).
pub fn is_steering(c: char) -> bool {
    c.is_control()
        || matches!(
            c,
            '\u{ad}'
                | '\u{34f}'
                | '\u{61c}'
                | '\u{180e}'
                | '\u{200b}'..='\u{200f}'
                | '\u{2028}'..='\u{202e}'
                | '\u{2060}'..='\u{206f}'
                | '\u{feff}'
                | '\u{fff0}'..='\u{fffb}'
                | '\u{fffe}'..='\u{ffff}'
                | '\u{1bca0}'..='\u{1bca3}'
                | '\u{1d173}'..='\u{1d17a}'
                | '\u{e0000}'..='\u{e0fff}'
        )
}

/// Escapes text for a single line; line ends and tabs are escaped as well.
pub fn line(text: &str) -> Cow<'_, str> {
    escaped(text, |_| false)
}

/// Whether a text is printable ASCII in lines, as nearly all text is, of which nothing needs to be escaped.
pub fn is_plain(text: &[u8]) -> bool {
    let plain = |&byte: &u8| byte == b'\n' || (0x20..0x7f).contains(&byte);
    // without an early end, so that many bytes are compared at once
    text.iter().fold(true, |all, byte| all & plain(byte))
}

/// Escapes text for several lines; line ends and tabs are preserved as layout.
pub fn lines(text: &str) -> Cow<'_, str> {
    escaped(text, is_layout)
}

/// Returns whether a character only moves to the next line or column.
fn is_layout(c: char) -> bool {
    matches!(c, '\n' | '\t')
}

fn escaped(text: &str, stays: impl Fn(char) -> bool) -> Cow<'_, str> {
    // nearly all text is printable ASCII, which a check of its bytes shows
    let is_plain = |byte: u8| (0x20..0x7f).contains(&byte) || byte < 0x20 && stays(byte.into());
    if text.bytes().all(is_plain) {
        return Cow::Borrowed(text);
    }
    let steers = |c: char| is_steering(c) && !stays(c);
    if !text.chars().any(steers) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        if steers(c) {
            push_escape(&mut out, c);
        } else {
            out.push(c);
        }
    }
    Cow::Owned(out)
}

/// Appends a character as an escape: `\n`, `\t`, `\r`, else `\u{…}`.
pub fn push_escape(out: &mut String, c: char) {
    match c {
        '\n' => out.push_str("\\n"),
        '\r' => out.push_str("\\r"),
        '\t' => out.push_str("\\t"),
        c => {
            // writing to a String cannot fail
            let _ = write!(out, "\\u{{{:x}}}", c as u32);
        }
    }
}

/// Escapes text of several lines that may contain our own colours: sequences that only set colours
/// (`ESC [ … m`) remain, and everything else is treated as in [`lines`].
pub fn coloured(text: &str) -> Cow<'_, str> {
    if !text.contains('\x1b') {
        return lines(text);
    }
    let mut out = String::with_capacity(text.len());
    let mut pieces = text.split('\x1b');
    out.push_str(&lines(pieces.next().unwrap_or_default()));
    for piece in pieces {
        let rest = piece.strip_prefix('[').unwrap_or_default();
        let numbers = rest.find(|c: char| !(c.is_ascii_digit() || c == ';' || c == ':'));
        match numbers {
            Some(at) if rest[at..].starts_with('m') => {
                out.push_str("\x1b[");
                out.push_str(&rest[..=at]);
                out.push_str(&lines(&rest[at + 1..]));
            }
            _ => {
                push_escape(&mut out, '\x1b');
                out.push_str(&lines(piece));
            }
        }
    }
    Cow::Owned(out)
}

/// Escapes serialised JSON. Such characters occur only within its strings, where JSON has an escape
/// of its own, so the result parses to the same value.
pub fn json(text: &str) -> Cow<'_, str> {
    let steers = |c: char| is_steering(c) && !is_layout(c);
    if is_plain(text.as_bytes()) || !text.chars().any(steers) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        if steers(c) {
            for unit in c.encode_utf16(&mut [0; 2]) {
                // writing to a String cannot fail
                let _ = write!(out, "\\u{unit:04x}");
            }
        } else {
            out.push(c);
        }
    }
    Cow::Owned(out)
}

/// Prepares text for quotation in a sentence: on one line, and of limited length.
pub fn quoted(text: &str) -> String {
    line(&shortened(text, QUOTED)).into_owned()
}

/// Shortens text to at most this many characters; shortened text ends in `…`.
pub fn shortened(text: &str, most: usize) -> Cow<'_, str> {
    match text.char_indices().nth(most) {
        Some((end, _)) => Cow::Owned(format!("{}…", &text[..end])),
        None => Cow::Borrowed(text),
    }
}

/// A file's path on one line; bytes that are not UTF-8 are escaped (`\xff`).
pub fn path(path: &Path) -> String {
    os(path.as_os_str())
}

/// A word of the command line or a file's name on one line, escaped like [`path`].
pub fn os(word: &OsStr) -> String {
    let mut out = String::new();
    for chunk in word.as_encoded_bytes().utf8_chunks() {
        out.push_str(&line(chunk.valid()));
        for byte in chunk.invalid() {
            // writing to a String cannot fail
            let _ = write!(out, "\\x{byte:02x}");
        }
    }
    out
}

/// A number in a sentence, without hundreds of digits: `0.25`, `1e300`.
pub fn number(x: f64) -> String {
    let size = x.abs();
    if x == 0.0 || !x.is_finite() || (SMALL..LARGE).contains(&size) {
        format!("{x}")
    } else {
        format!("{x:e}")
    }
}

/// As [`why`], of a file that could not be written: what is not found is its folder.
pub fn why_unwritten(error: &io::Error) -> String {
    match error.kind() {
        ErrorKind::NotFound if error.get_ref().is_none() => "its folder does not exist".to_owned(),
        _ => why(error),
    }
}

/// Describes an error of a file or a stream in words, without the system's error number.
pub fn why(error: &io::Error) -> String {
    if error.get_ref().is_some() {
        return lines(&error.to_string()).into_owned();
    }
    let words = match error.kind() {
        ErrorKind::NotFound => "no such file or folder",
        ErrorKind::PermissionDenied => "permission denied",
        ErrorKind::AlreadyExists => "it is there already",
        ErrorKind::IsADirectory => "it is a folder, not a file",
        ErrorKind::NotADirectory => "a part of the path is not a folder",
        ErrorKind::ReadOnlyFilesystem => "the file system is read-only",
        ErrorKind::StorageFull => "no space left on the device",
        ErrorKind::QuotaExceeded => "no space left within the quota",
        ErrorKind::FileTooLarge => "it would be too large",
        ErrorKind::InvalidFilename => "no file can have that name",
        ErrorKind::BrokenPipe => "its reader has closed it",
        ErrorKind::OutOfMemory => "no memory is left",
        ErrorKind::TimedOut => "it takes too long",
        // in the system's words, without its number
        _ => {
            let text = error.to_string();
            return lines(text.split(" (os error").next().unwrap_or(&text)).to_lowercase();
        }
    };
    words.to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One character of each kind.
    const STEERING: [char; 22] = [
        '\0',
        '\x07',
        '\x1b',
        '\x7f',
        '\u{80}',
        '\u{9b}',
        '\u{9f}',
        '\u{ad}',
        '\u{61c}',
        '\u{200b}',
        '\u{200d}',
        '\u{200f}',
        '\u{2028}',
        '\u{2029}',
        '\u{202a}',
        '\u{202e}',
        '\u{2060}',
        '\u{2066}',
        '\u{2069}',
        '\u{feff}',
        '\u{e0041}',
        '\u{fffe}',
    ];

    #[test]
    fn what_steers_is_written_out_and_the_rest_stays() {
        for c in STEERING {
            assert!(is_steering(c), "{c:?}");
            let given = format!("a{c}b");
            let expected = format!("a\\u{{{:x}}}b", c as u32);
            assert_eq!(line(&given), expected);
            assert_eq!(lines(&given), expected);
            assert_eq!(coloured(&given), expected);
        }
        for plain in ["θ̈ = −g sin θ", "漢字", "ﬁ 🪐 \\u{9b}", "\u{a0}", "x'", ""] {
            assert!(!plain.chars().any(is_steering));
            assert_eq!([line(plain), lines(plain), json(plain), coloured(plain)], [plain; 4]);
        }
        assert_eq!(line("a\tb\r\n"), "a\\tb\\r\\n");
        assert_eq!(lines("a\tb\r\n"), "a\tb\\r\n");
    }

    #[test]
    fn only_colours_pass_as_sequences() {
        let ours = "\x1b[1;38;5;214mbold\x1b[0m\n";
        assert_eq!(coloured(ours), ours);
        for other in
            ["\x1b[2J", "\x1b]0;x\x07", "\x1b[1;", "\x1b", "\x1bc", "\x1b[?25m", "\x1b[1 m"]
        {
            assert!(!coloured(other).contains('\x1b'), "{other:?}");
        }
        assert_eq!(coloured("\x1b[31mred\u{9b}2J\x1b[m"), "\x1b[31mred\\u{9b}2J\x1b[m");
    }

    #[test]
    fn json_reads_back() {
        let all: String = STEERING.iter().chain(&['\n', '"', '\\', 'θ']).collect();
        let text = serde_json::json!({ "a": all }).to_string();
        let safe = json(&text);
        assert!(!safe.chars().any(is_steering), "{safe:?}");
        let read: serde_json::Value = serde_json::from_str(&safe).expect("JSON");
        assert_eq!(read["a"], all);
        assert!(safe.contains("\\u009b") && safe.contains("\\udb40\\udc41"), "{safe}");
    }

    #[test]
    fn what_is_quoted_has_an_end() {
        let at_most = "x".repeat(QUOTED);
        assert_eq!(quoted(&at_most), at_most);
        assert_eq!(quoted(&format!("{at_most}y")), format!("{at_most}…"));
        assert_eq!(quoted("a\nb"), "a\\nb");
        let shown = [0.0, 0.25, -3.0, 1e14, 1e15, 1e300, -5e-324, 1e-5].map(number);
        let expected =
            ["0", "0.25", "-3", "100000000000000", "1e15", "1e300", "-5e-324", "0.00001"];
        assert_eq!(shown, expected);
    }

    #[test]
    fn errors_of_the_system_are_reported_in_words() {
        let shown = |number| why(&io::Error::from_raw_os_error(number));
        // ENOENT, EACCES, ENOSPC, EIO
        let numbers = [2, 13, 28, 5];
        let words = ["no such file or folder", "permission denied", "no space left on the device"];
        assert_eq!(numbers.map(shown)[..3], words);
        assert!(!numbers.map(shown)[3].contains("os error"));
        assert_eq!(why(&io::Error::other("it is\x07 odd")), "it is\\u{7} odd");
    }

    #[cfg(unix)]
    #[test]
    fn a_path_of_any_bytes_has_a_spelling() {
        use std::os::unix::ffi::OsStrExt;
        assert_eq!(os(OsStr::from_bytes(b"a\xff\x1b[2J\n.toml")), "a\\xff\\u{1b}[2J\\n.toml");
        assert_eq!(path(Path::new("my/θ.toml")), "my/θ.toml");
    }
}
