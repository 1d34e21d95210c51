//! The nearest surface at each dot of a raster, among those of a kind.
//!
//! In: rows of dots with their nearness to the eye. Out: what covers a dot. Never here: the shapes of surfaces.

use std::ops::Range;

/// A dot that a surface covers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Covered {
    /// How near the surface is to the eye.
    pub near: f64,
    /// The number of the surface.
    pub surface: usize,
    /// How brightly it is lit, 0 to 1.
    pub light: f64,
    /// Whether a veil is in front of it.
    pub veiled: bool,
}

/// The nearest surface of a kind at each dot.
#[derive(Clone, Debug, Default)]
pub(super) struct Nearest {
    /// How near it is, row by row; −∞ where there is none. Empty as long as there is no surface.
    nears: Vec<f64>,
    /// Which surface that is, and how brightly it is lit.
    surfaces: Vec<(u32, f32)>,
    /// All dots that are covered lie between these.
    pub(super) range: Range<usize>,
}

impl Nearest {
    pub(super) fn near(&self, place: usize) -> f64 {
        self.nears.get(place).copied().unwrap_or(f64::NEG_INFINITY)
    }

    /// Whether there is no room yet, and so no surface.
    pub(super) fn is_empty(&self) -> bool {
        self.nears.is_empty()
    }

    /// Makes room for this many dots.
    pub(super) fn prepare(&mut self, [wide, high]: [i32; 2]) {
        if self.nears.is_empty() {
            let count = (wide * high) as usize;
            self.nears = vec![f64::NEG_INFINITY; count];
            self.surfaces = vec![(0, 0.0); count];
        }
    }

    /// Covers dots with a surface in one light, given how near it is at each of them, unless something nearer does.
    pub(super) fn cover(
        &mut self,
        places: Range<usize>,
        (surface, light): (usize, f64),
        nears: impl Iterator<Item = f64>,
    ) {
        let new = (surface as u32, light as f32);
        let there = (self.nears.get_mut(places.clone())).zip(self.surfaces.get_mut(places.clone()));
        let Some((own, surfaces)) = there.filter(|(own, _)| !own.is_empty()) else { return };
        for ((own, surface), near) in own.iter_mut().zip(surfaces).zip(nears) {
            if *own < near {
                (*own, *surface) = (near, new);
            }
        }
        let range = &mut self.range;
        *range = if range.start >= range.end {
            places
        } else {
            range.start.min(places.start)..range.end.max(places.end)
        };
    }

    pub(super) fn covered(&self, place: usize, veiled: bool) -> Option<Covered> {
        let &(surface, light) = self.surfaces.get(place)?;
        let near = self.near(place);
        let covered = Covered { near, surface: surface as usize, light: f64::from(light), veiled };
        (near > f64::NEG_INFINITY).then_some(covered)
    }
}
