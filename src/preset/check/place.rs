//! Maps a byte of an expression to a byte of the file: past the quotes and escapes, in which
//! several bytes stand for one character.

use crate::diagnostic::SourceRange;
use crate::expr::Span;
use crate::preset::draft::Formula;

/// The range in the file of a part of an expression.
pub(super) fn within(file: &str, formula: &Formula, span: Span) -> SourceRange {
    let whole = formula.span();
    let Some(raw) = file.get(whole.clone()) else { return whole };
    let (open, close) = quotes(raw);
    let Some(body) = raw.get(open..raw.len() - close) else { return whole };
    let text = formula.get_ref();
    let first = whole.start + open;
    if body == text {
        let at = |offset: usize| first + offset.min(body.len());
        return at(span.start)..at(span.end);
    }
    if !raw.starts_with('"') {
        return whole;
    }
    first + written_offset(body, text, span.start)..first + written_offset(body, text, span.end)
}

/// The lengths of the opening and closing quotes of a value.
fn quotes(raw: &str) -> (usize, usize) {
    for quote in ["\"\"\"", "'''"] {
        if raw.len() >= 6 && raw.starts_with(quote) {
            let newline = ["\r\n", "\n"].iter().find(|n| raw[3..].starts_with(**n));
            return (3 + newline.map_or(0, |n| n.len()), 3);
        }
    }
    if raw.len() >= 2 && raw.starts_with(['"', '\'']) { (1, 1) } else { (0, 0) }
}

/// The offset in the written text, with escapes, of the character at `offset` of the unescaped
/// text.
fn written_offset(written: &str, meant: &str, offset: usize) -> usize {
    let mut at = 0;
    let mut meant_at = 0;
    for c in meant.chars() {
        at += folded(&written[at..]);
        if meant_at >= offset {
            return at;
        }
        let rest = &written[at..];
        let length = match rest.strip_prefix('\\').map(|r| r.as_bytes().first()) {
            Some(Some(b'x')) => 4,
            Some(Some(b'u')) => 6,
            Some(Some(b'U')) => 10,
            Some(_) => 2,
            None => c.len_utf8(),
        };
        at = (at + length).min(written.len());
        while !written.is_char_boundary(at) {
            at -= 1;
        }
        meant_at += c.len_utf8();
    }
    at
}

/// The length of line endings that a backslash removes.
fn folded(rest: &str) -> usize {
    let Some(after) = rest.strip_prefix('\\') else { return 0 };
    let next = after.trim_start();
    let skipped = &after[..after.len() - next.len()];
    if !skipped.contains('\n') {
        return 0;
    }
    let length = 1 + skipped.len();
    length + folded(next)
}
