//! Formatting of errors for the reader: file, line and column, the line itself, a caret under the
//! place, the reason, and a correction.

use annotate_snippets::{Annotation, AnnotationKind, Level, Origin, Renderer, Snippet};

use super::{Diagnostic, Severity};
use crate::diagnostic::SourceRange;
use crate::printable;

/// The longest line that is shown: a longer one is unreadable and slow to format.
const LONGEST_LINE: usize = 4096;

/// The length at which a sentence is cut: what it quotes may be as long as a file.
const LONGEST_SENTENCE: usize = 420;

/// The largest distance at which a related place is shown.
const FARTHEST: usize = 65_536;

/// Formats errors found in `text`, the content of `path`, each followed by an empty line. Without
/// colour the frame around the file's own lines is ASCII. Characters that would control a terminal
/// are escaped.
pub fn report(text: &str, path: &str, diagnostics: &[Diagnostic], colour: bool) -> String {
    let renderer = if colour { Renderer::styled() } else { Renderer::plain() };
    let path = printable::line(path);
    let mut drawn = String::new();
    for diagnostic in diagnostics {
        let level = match diagnostic.severity {
            Severity::Error => Level::ERROR,
            Severity::Warning | Severity::Unused => Level::WARNING,
        };
        let title = level.primary_title(sentence(&diagnostic.message));
        let place = one_line(text, &diagnostic.place);
        let mut group =
            if line_end(text, place.start) - line_start(text, place.start) > LONGEST_LINE {
                title.element(origin(text, &path, place.start))
            } else {
                title.element(snippet(text, &path, &place, diagnostic))
            };
        if let Some(help) = &diagnostic.help {
            group = group.element(Level::HELP.message(sentence(help)));
        }
        let rendered = renderer.render(&[group]);
        drawn.push_str(&in_the_file(rendered, text, &path, place.start));
        drawn.push_str("\n\n");
    }
    drawn
}

fn sentence(text: &str) -> String {
    printable::line(&printable::shortened(text, LONGEST_SENTENCE)).into_owned()
}

/// Only the lines in question, because the cost of formatting grows with the text passed on.
fn snippet<'t>(
    text: &str,
    path: &'t str,
    place: &SourceRange,
    diagnostic: &'t Diagnostic,
) -> Snippet<'t, Annotation<'t>> {
    let also = diagnostic.also.as_ref().map(|(place, what)| (one_line(text, place), what));
    let also = also.filter(|(other, _)| other.start.abs_diff(place.start) < FARTHEST);
    let other = also.as_ref().map_or(place, |(other, _)| other);
    let first = place.start.min(other.start);
    let window =
        Window::of(text, line_start(text, first)..line_end(text, place.end.max(other.end)));
    let (within, beside) = (window.within(place), window.within(other));
    let snippet = Snippet::source(window.shown)
        .line_start(line_number(text, first))
        .path(path)
        .annotation(AnnotationKind::Primary.span(within));
    match &also {
        Some((_, what)) => {
            snippet.annotation(AnnotationKind::Context.span(beside).label(sentence(what)))
        }
        None => snippet,
    }
}

/// Lines of a file as they are shown, with a map of the offsets that escapes have shifted.
struct Window {
    shown: String,
    /// The offset of the first line in the file.
    start: usize,
    /// For each escaped character, its end in the file and its end in the shown text.
    moved: Vec<(usize, usize)>,
}

impl Window {
    fn of(text: &str, part: SourceRange) -> Window {
        let mut window = Window { shown: String::new(), start: part.start, moved: Vec::new() };
        let lines = &text[part.clone()];
        for (at, c) in lines.char_indices() {
            let layout = matches!(c, '\n' | '\t');
            let line_end = c == '\r' && lines[at + 1..].starts_with('\n');
            if !printable::is_steering(c) || layout {
                window.shown.push(c);
                continue;
            }
            if !line_end {
                printable::push_escape(&mut window.shown, c);
            }
            window.moved.push((part.start + at + c.len_utf8(), window.shown.len()));
        }
        window
    }

    /// Converts a range of the file to a range of the shown text.
    fn within(&self, place: &SourceRange) -> SourceRange {
        let shown = |at: usize| {
            let before = self.moved.partition_point(|(end, _)| *end <= at);
            let (end, shown) = before.checked_sub(1).map_or((self.start, 0), |i| self.moved[i]);
            shown + (at - end)
        };
        // a place within an escaped character maps to the beginning of its escape
        shown(place.start)..shown(place.end)
    }
}

/// Corrects the column to that of the file, because escapes before the place may have shifted it.
fn in_the_file(rendered: String, text: &str, path: &str, at: usize) -> String {
    let before = &text[line_start(text, at)..at];
    let shown = Window::of(before, 0..before.len()).shown;
    let locate = |line: &str| {
        let column = 1 + line.chars().count();
        format!("{path}:{}:{column}", line_number(text, at))
    };
    if shown == before { rendered } else { rendered.replacen(&locate(&shown), &locate(before), 1) }
}

/// The origin that gives only line and column.
fn origin<'t>(text: &str, path: &'t str, at: usize) -> Origin<'t> {
    let column = 1 + text[line_start(text, at)..at].chars().count();
    Origin::path(path).line(line_number(text, at)).char_column(column)
}

fn line_number(text: &str, at: usize) -> usize {
    1 + text[..at].matches('\n').count()
}

/// The part of a place on its first line, extended to whole characters of the text.
fn one_line(text: &str, place: &SourceRange) -> SourceRange {
    let mut start = place.start.min(text.len());
    while !text.is_char_boundary(start) {
        start -= 1;
    }
    let mut end = place.end.clamp(start, line_end(text, start));
    while !text.is_char_boundary(end) {
        end += 1;
    }
    start..end
}

fn line_start(text: &str, at: usize) -> usize {
    text[..at].rfind('\n').map_or(0, |newline| newline + 1)
}

fn line_end(text: &str, at: usize) -> usize {
    let end = text[at..].find('\n').map_or(text.len(), |length| at + length);
    if text[at..end].ends_with('\r') { end - 1 } else { end }
}
