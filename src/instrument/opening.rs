//! The plots that the lab opens with.
//!
//! In: a system. Out: [`Plot`]s of every kind. Never here: what a single kind opens with.

use super::{INSTRUMENTS, Physics, Plot, named};

impl Plot {
    /// The plots that the lab opens with: the file's views, then those that every system has, to fill a large screen.
    pub fn opening(physics: Physics<'_>) -> Vec<Self> {
        let mut plots: Vec<Self> = Vec::new();
        let views = 0..physics.model.views.len();
        let of_file = views.filter_map(|view| Self::of_view(physics, view));
        let of_every = INSTRUMENTS.into_iter().flat_map(|kind| {
            let all = kind.opening(physics).into_iter();
            all.map(move |columns| Self::new(kind, (columns, None), physics.model).opened(physics))
        });
        for plot in of_file.chain(of_every) {
            if !plots.iter().any(|p| p.shows_the_same(&plot, physics.model)) {
                plots.push(plot);
            }
        }
        plots
    }

    /// The plot of a view of the file, or `None` if one of its quantities is not a channel.
    pub fn of_view(physics: Physics<'_>, index: usize) -> Option<Self> {
        let kind = named(&physics.model.views.get(index)?.kind)?;
        Self::viewing(kind, physics, index)
    }
}
