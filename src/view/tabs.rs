//! The tabs of a frame in which several pictures take turns.
//!
//! In: the plots of a frame, which of them is shown. Out: spans of a title, and where each leads. Never here: the pictures themselves.

use unicode_width::UnicodeWidthStr;

use super::canvas::{Canvas, StyledText};
use super::quantity::Quantities;
use super::theme::Role;
use crate::instrument::Plot;

/// The name of a picture in a row of tabs.
pub(super) fn label(q: &Quantities<'_>, plot: &Plot) -> String {
    let heading = plot.kind.heading(plot, &q.present());
    heading.map_or_else(|| "Picture".to_owned(), |heading| heading.title)
}

/// The names of pictures, no two the same: those that occur twice are followed by as many quantities as tell them apart,
/// those of the same quantities by their place.
fn distinct(q: &Quantities<'_>, plots: &[(usize, &Plot)]) -> Vec<String> {
    let bare: Vec<String> = plots.iter().map(|(_, plot)| label(q, plot)).collect();
    let quantities: Vec<Vec<usize>> =
        plots.iter().map(|(_, plot)| plot.columns.iter().flatten().copied().collect()).collect();
    let named = |place: usize, count: usize| {
        let names: Vec<String> =
            quantities[place].iter().take(count).map(|channel| q.name(*channel)).collect();
        format!("{} {}", bare[place], names.join(", ")).trim_end().to_owned()
    };
    let longest = quantities.iter().map(Vec::len).max().unwrap_or(0);
    let mut labels = bare.clone();
    for count in 1..=longest {
        let alike =
            |place: usize| labels.iter().filter(|other| **other == labels[place]).count() > 1;
        let again: Vec<usize> = (0..labels.len()).filter(|place| alike(*place)).collect();
        for place in again {
            labels[place] = named(place, count);
        }
    }
    for place in 1..labels.len() {
        let before = labels[..place].iter().filter(|other| **other == labels[place]).count();
        if before > 0 {
            labels[place] = format!("{} ({})", labels[place], before + 1);
        }
    }
    labels
}

pub(super) struct Tabs {
    /// The names, with a line between neighbours.
    pub(super) spans: Vec<StyledText>,
    /// The picture to which each name leads.
    pub(super) pictures: Vec<usize>,
}

/// The names of the pictures that take turns in a frame; names that occur twice are followed by their quantities. If they do
/// not fit, as many as do, the shown one among them, and the number of the others. `None` if it is alone.
pub(super) fn of(
    canvas: &Canvas<'_>,
    q: &Quantities<'_>,
    (shown, sharing): (usize, &[usize]),
    room: usize,
) -> Option<Tabs> {
    if sharing.len() < 2 {
        return None;
    }
    let all: Vec<_> =
        sharing.iter().filter_map(|index| Some((*index, q.lab.plots.get(*index)?))).collect();
    let labels = distinct(q, &all);
    let place = all.iter().position(|(index, _)| *index == shown)?;
    let line = canvas.style.glyphs.pick(" │ ", " | ");
    let fitting = |from: usize| {
        let mut used = 0;
        let fits = |(count, label): &(usize, &String)| {
            used += label.width() + line.width();
            let others = labels.len() - count - 1;
            let rest = if others == 0 { 0 } else { others.to_string().len() + 1 + line.width() };
            used + rest <= room + line.width()
        };
        labels[from..].iter().enumerate().take_while(fits).count()
    };
    let (mut from, mut count) = (0, fitting(0));
    if place >= count {
        // as many as fit before it
        from = (0..=place).find(|from| fitting(*from) > place - from).unwrap_or(place);
        count = fitting(from).max(1);
    }
    let mut tabs = Tabs { spans: Vec::new(), pictures: Vec::new() };
    for ((index, _), label) in all.iter().zip(&labels).skip(from).take(count) {
        if !tabs.spans.is_empty() {
            tabs.spans.push(canvas.span(Role::Border, line));
        }
        let role = if *index == shown { Role::Title } else { Role::Dim };
        tabs.spans.push(canvas.span(role, label.clone()));
        tabs.pictures.push(*index);
    }
    let others = labels.len() - count;
    if others > 0 {
        tabs.spans.push(canvas.span(Role::Border, line));
        tabs.spans.push(canvas.span(Role::Dim, format!("+{others}")));
        tabs.pictures.push(all[(from + count) % all.len()].0);
    }
    Some(tabs)
}
