//! Mistakes as a person reads them: file, line and column, the line itself, a caret under the
//! place, the reason, and what would be right.

use annotate_snippets::{Annotation, AnnotationKind, Level, Origin, Renderer, Snippet};

use super::{Mistake, Severity};
use crate::model::Place;

/// A line longer than this is not shown: nobody could read it, and it takes long to draw.
const LONGEST_LINE: usize = 4096;

/// A second place farther away than this is not shown.
const FARTHEST: usize = 65_536;

/// Draws mistakes found in `text`, the content of `path`, each followed by an empty line. Without
/// colour the frame around the file's own lines is ASCII.
pub fn report(text: &str, path: &str, mistakes: &[Mistake], colour: bool) -> String {
    let renderer = if colour { Renderer::styled() } else { Renderer::plain() };
    let mut drawn = String::new();
    for mistake in mistakes {
        let level = match mistake.severity {
            Severity::Error => Level::ERROR,
            Severity::Warning => Level::WARNING,
        };
        let title = level.primary_title(mistake.message.as_str());
        let place = one_line(text, &mistake.place);
        let mut group =
            if line_end(text, place.start) - line_start(text, place.start) > LONGEST_LINE {
                title.element(origin(text, path, place.start))
            } else {
                title.element(snippet(text, path, place, mistake))
            };
        if let Some(help) = &mistake.help {
            group = group.element(Level::HELP.message(help.as_str()));
        }
        drawn.push_str(&renderer.render(&[group]));
        drawn.push_str("\n\n");
    }
    drawn
}

/// The lines in question, and no others: the cost of drawing is that of the text handed over.
fn snippet<'t>(
    text: &'t str,
    path: &'t str,
    place: Place,
    mistake: &'t Mistake,
) -> Snippet<'t, Annotation<'t>> {
    let also = mistake.also.as_ref().map(|(place, what)| (one_line(text, place), what));
    let also = also.filter(|(other, _)| other.start.abs_diff(place.start) < FARTHEST);
    let other = also.as_ref().map_or(&place, |(other, _)| other);
    let first = place.start.min(other.start);
    let window = line_start(text, first)..line_end(text, place.end.max(other.end));
    let within = |place: &Place| place.start - window.start..place.end - window.start;
    let snippet = Snippet::source(&text[window.clone()])
        .line_start(line_number(text, first))
        .path(path)
        .annotation(AnnotationKind::Primary.span(within(&place)));
    match &also {
        Some((other, what)) => {
            snippet.annotation(AnnotationKind::Context.span(within(other)).label(what.as_str()))
        }
        None => snippet,
    }
}

/// Line and column alone.
fn origin<'t>(text: &str, path: &'t str, at: usize) -> Origin<'t> {
    let column = 1 + text[line_start(text, at)..at].chars().count();
    Origin::path(path).line(line_number(text, at)).char_column(column)
}

fn line_number(text: &str, at: usize) -> usize {
    1 + text[..at].matches('\n').count()
}

/// The part of a place on its first line, moved to whole characters of the text.
fn one_line(text: &str, place: &Place) -> Place {
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
