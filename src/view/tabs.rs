//! The tabs of a frame in which several pictures take turns.
//!
//! In: the plots of a frame, which of them is shown. Out: spans of a title. Never here: the pictures themselves.

use super::canvas::{Canvas, Span, wide};
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

/// The names of the pictures that take turns in a frame, with a line between neighbours; names that occur twice are
/// followed by their quantities. If they do not fit, the place of the shown one among all; `None` if it is alone.
pub(super) fn of(
    canvas: &Canvas<'_>,
    q: &Quantities<'_>,
    (shown, sharing): (usize, &[usize]),
    room: usize,
) -> Option<Vec<Span>> {
    if sharing.len() < 2 {
        return None;
    }
    let plots = || sharing.iter().filter_map(|index| Some((*index, q.lab.plots.get(*index)?)));
    let mut spans = Vec::new();
    let all: Vec<_> = plots().collect();
    for ((index, _), label) in all.iter().zip(distinct(q, &all)) {
        let index = *index;
        if !spans.is_empty() {
            spans.push(canvas.span(Role::Border, canvas.look.glyphs.pick(" │ ", " | ")));
        }
        spans.push(canvas.span(if index == shown { Role::Title } else { Role::Dim }, label));
    }
    if wide(&spans) <= room {
        return Some(spans);
    }
    let place = sharing.iter().position(|index| *index == shown)? + 1;
    let own = label(q, q.lab.plots.get(shown)?);
    let counted = canvas.span(Role::Dim, format!(" {place}/{}", sharing.len()));
    Some(vec![canvas.span(Role::Title, own), counted])
}
