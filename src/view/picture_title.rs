//! The title of a picture: what is shown, the keys of its curves, as many current values as fit, and what is being computed.
//!
//! In: a plot, the room in its frame. Out: spans. Never here: the picture below it, or the tabs beside it.

use super::canvas::{Canvas, StyledText, groups, wide};
use super::colour::ColourDepth;
use super::ink::pen;
use super::ink::{colourless_mark, is_colourless, marker};
use super::marks;
use super::number::{readable, with_powers};
use super::quantity::Quantities;
use super::theme::{Dash, Role};
use crate::instrument::{Entry, Heading, Ink, Plot};

/// Builds the heading: what is shown, as many current values as fit, and what is being computed.
pub(super) fn title(
    canvas: &Canvas<'_>,
    q: &Quantities<'_>,
    plot: &Plot,
    room: usize,
) -> Vec<StyledText> {
    let present = q.present();
    let Some(mut heading) = plot.kind.heading(plot, &present) else { return Vec::new() };
    if let Some(counted) = plot.kind.counted(q.lab.context(plot, &present)) {
        heading.entries.insert(0, counted);
    }
    let mut pieces = vec![vec![canvas.span(Role::Title, &heading.title)]];
    let curves = curves(&heading);
    if curves.is_empty() {
        let entries = with_all_keys(canvas, q, &heading, room);
        pieces.extend(entries.map(|entry| piece(canvas, q, entry)));
    } else {
        pieces = keys(canvas, q, &heading, &curves, room);
    }
    if let Some(eye) = plot.eye().filter(|eye| eye.zoom != 1.0) {
        let zoom = super::number::brief(eye.zoom, 2, canvas.style.glyphs);
        pieces.push(vec![canvas.span(Role::Dim, format!("  ×{zoom}"))]);
    }
    if let Some(status) = q.lab.under_way(plot).and_then(crate::app::UnderWay::status) {
        pieces.insert(1, vec![canvas.span(Role::Dim, format!("  {status}"))]);
    }
    groups(pieces, room)
}

/// An entry of a heading other than a curve.
fn piece(canvas: &Canvas<'_>, q: &Quantities<'_>, entry: &Entry) -> Vec<StyledText> {
    let valued = |name: &str, value: f64| {
        let name = canvas.span(Role::Dim, format!("  {name}"));
        [name].into_iter().chain(current(canvas, value)).collect()
    };
    match entry {
        Entry::Channel(channel) => valued(&q.name(*channel), q.value(*channel)),
        Entry::Number(name, value) => valued(name, *value),
        Entry::Words(words) => {
            let words = with_powers(words, canvas.style.glyphs);
            vec![canvas.span(Role::Dim, format!("  {words}"))]
        }
        Entry::Key(ink, words) => {
            let glyphs = canvas.style.glyphs;
            let (mark, style) = match (colourless_mark(canvas, *ink), ink) {
                (Some(shape), _) => (marker(shape).symbol(glyphs), canvas.style(Role::Text)),
                (None, Ink::Level) if is_colourless(canvas.style) => {
                    (glyphs.pick('·', '.'), canvas.style(Role::Text))
                }
                _ => (glyphs.pick('●', 'o'), pen(canvas, *ink, 0).style),
            };
            vec![(format!("  {mark} "), style), canvas.span(Role::Dim, words)]
        }
        Entry::Occurrences => marks::legend(canvas, q),
        Entry::Curve(index, channel) => key(canvas, q, *index, *channel),
        Entry::Line(index, words) => sampled(canvas, *index, words),
    }
}

/// A current value; nothing while it has none, as where a motion cannot begin.
fn current(canvas: &Canvas<'_>, value: f64) -> Option<StyledText> {
    let shown = || format!(" {:<8}", readable(value, 4, canvas.style.glyphs));
    (!value.is_nan()).then(|| canvas.span(Role::Accent, shown()))
}

/// The curves of a heading: their indices and channels.
fn curves(heading: &Heading) -> Vec<(usize, usize)> {
    let curve = |entry: &Entry| match entry {
        Entry::Curve(index, channel) => Some((*index, *channel)),
        _ => None,
    };
    heading.entries.iter().filter_map(curve).collect()
}

/// Whether an entry is the key of a curve or of a kind of points.
fn is_key(entry: &Entry) -> bool {
    matches!(entry, Entry::Curve(..) | Entry::Key(..) | Entry::Line(..))
}

/// The entries of a heading: with its keys if all of them fit, else without, as then all are above the axes.
fn with_all_keys<'a>(
    canvas: &Canvas<'_>,
    q: &Quantities<'_>,
    heading: &'a Heading,
    room: usize,
) -> impl Iterator<Item = &'a Entry> {
    let until_last = heading.entries.iter().rposition(is_key).map_or(0, |last| last + 1);
    let pieces = heading.entries[..until_last].iter().flat_map(|entry| piece(canvas, q, entry));
    let all: Vec<StyledText> =
        [canvas.span(Role::Title, &heading.title)].into_iter().chain(pieces).collect();
    let several = heading.entries.iter().filter(|entry| is_key(entry)).count() > 1;
    let beyond = several && wide(&all) > room;
    heading.entries.iter().filter(move |entry| !beyond || !is_key(entry))
}

/// Each curve in its colour with its current value; without values if they do not all fit; none if there are several whose
/// names do not all fit, as then all are above the axes.
fn keys(
    canvas: &Canvas<'_>,
    q: &Quantities<'_>,
    heading: &Heading,
    curves: &[(usize, usize)],
    room: usize,
) -> Vec<Vec<StyledText>> {
    let head = vec![canvas.span(Role::Title, &heading.title)];
    let named = || curves.iter().map(|(index, channel)| key(canvas, q, *index, *channel));
    let valued = named().zip(curves).map(|(mut key, (_, channel))| {
        key.extend(current(canvas, q.value(*channel)));
        key
    });
    let (valued, mut named): (Vec<_>, Vec<_>) = (valued.collect(), named().collect());
    if wide(&[head.clone(), valued.concat()].concat()) <= room {
        let others = heading.entries.iter().filter(|entry| !matches!(entry, Entry::Curve(..)));
        let others = others.map(|entry| piece(canvas, q, entry)).collect();
        [vec![head], valued, others].concat()
    } else if wide(&[head.clone(), named.concat()].concat()) <= room {
        [vec![head], named].concat()
    } else if curves.len() > 1 || heading.given {
        vec![head]
    } else {
        // The name of the curve has priority over the name of the picture.
        if let Some((first, _)) = named.first_mut().and_then(|key| key.first_mut()) {
            *first = first.trim_start().to_owned();
        }
        named
    }
}

/// A sample of a channel's curve, and its name.
fn key(canvas: &Canvas<'_>, q: &Quantities<'_>, index: usize, channel: usize) -> Vec<StyledText> {
    sampled(canvas, index, &q.name(channel))
}

/// A sample of a curve's line, and words.
fn sampled(canvas: &Canvas<'_>, index: usize, words: &str) -> Vec<StyledText> {
    let theme = &canvas.style.theme;
    let dash = theme.series(index).dash;
    let [unicode, ascii] = dash.sample();
    let sample = canvas.style.glyphs.pick(unicode, ascii);
    // A colour is visible on one character; a pattern needs three.
    let plain = theme.depth() != ColourDepth::None && dash == Dash::Full;
    let mark = if plain { canvas.style.glyphs.pick("━", "-") } else { sample };
    vec![(format!("  {mark} "), theme.curve(index)), canvas.span(Role::Dim, words)]
}

/// Keys, pairs of a mark and a name, in a width: where they are too long, words that all names begin with are left out of
/// the names after the first, or of all of them.
pub(super) fn keys_in(keys: &[StyledText], width: usize, mark: &str) -> Vec<StyledText> {
    let names: Vec<&str> = keys.iter().skip(1).step_by(2).map(|(name, _)| name.as_str()).collect();
    let same = common_words(&names);
    if wide(keys) <= width || same == 0 || !keys.len().is_multiple_of(2) {
        return keys.to_vec();
    }
    let without = |from: usize| -> Vec<StyledText> {
        let shown = |(index, (text, style)): (usize, &StyledText)| match text.get(same..) {
            Some(rest) if index % 2 == 1 && index > from => (format!("{mark}{rest}"), *style),
            _ => (text.clone(), *style),
        };
        keys.iter().enumerate().map(shown).collect()
    };
    let [first_whole, none_whole] = [1, 0].map(without);
    if wide(&first_whole) <= width { first_whole } else { none_whole }
}

/// The length of the words, with the blanks after them, that several names begin with.
fn common_words(names: &[&str]) -> usize {
    let [first, others @ ..] = names else { return 0 };
    let ends = first.match_indices(' ').map(|(at, _)| at + 1);
    let shared = |end: &usize| others.iter().all(|name| name.starts_with(&first[..*end]));
    if others.is_empty() { 0 } else { ends.take_while(shared).last().unwrap_or(0) }
}

/// The keys of curves and of kinds of points that the title has no room for, if the picture has several.
pub(super) fn keys_beyond(
    canvas: &Canvas<'_>,
    q: &Quantities<'_>,
    plot: &Plot,
    title: &[StyledText],
) -> Vec<StyledText> {
    let Some(heading) = plot.kind.heading(plot, &q.present()) else { return Vec::new() };
    let keys = heading.entries.iter().filter(|entry| is_key(entry));
    let keys: Vec<Vec<StyledText>> = keys.map(|entry| piece(canvas, q, entry)).collect();
    let in_title = |key: &Vec<StyledText>| title.windows(2).any(|pair| pair[1] == key[1]);
    if keys.len() < 2 {
        return Vec::new();
    }
    keys.into_iter().filter(|key| !in_title(key)).flatten().collect()
}
