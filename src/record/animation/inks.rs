//! The palette of a GIF: which colours it has, and which of them a pixel gets.
//!
//! In: how often each colour is drawn, and how much of it covers the background. Out: at most 255 colours, one index
//! being left for what is transparent. Flat colours come before the mixtures at the edges of letters. Never here: shapes.

use std::collections::{BTreeMap, HashMap};

use super::glyph::LEVELS;
use crate::view::colour::Rgb;

/// The index of what is left as it was.
pub(super) const TRANSPARENT: u8 = 0;

/// The most colours besides.
const MOST: usize = 255;

/// How many of them are flat colours, where there are too many mixtures.
const MOST_FLAT: usize = 200;

/// The indices of an ink on a ground, from none to full coverage.
pub(super) type InkRamp = [u8; LEVELS + 1];

/// How many pixels are drawn in which ink on which ground, with which coverage.
#[derive(Default)]
pub(super) struct InkCounts {
    pairs: HashMap<(Rgb, Rgb), [u64; LEVELS + 1]>,
}

impl InkCounts {
    pub(super) fn add(&mut self, ink: Rgb, ground: Rgb, histogram: &[u32; LEVELS + 1]) {
        let counts = self.pairs.entry((ink, ground)).or_default();
        for (count, more) in counts.iter_mut().zip(histogram) {
            *count += u64::from(*more);
        }
    }
}

/// The colours of a GIF.
pub(super) struct Inks {
    colours: Vec<Rgb>,
    ramps: HashMap<(Rgb, Rgb), InkRamp>,
}

impl Inks {
    /// Chooses the colours.
    pub(super) fn of(drawn: InkCounts) -> Inks {
        // whether it is flat, and how often it is drawn
        let mut counts: BTreeMap<[u8; 3], (bool, u64)> = BTreeMap::new();
        for ((ink, ground), levels) in drawn.pairs {
            for (level, count) in levels.into_iter().enumerate().filter(|(_, count)| *count > 0) {
                let Rgb(r, g, b) = blend(ink, ground, level);
                let known = counts.entry([r, g, b]).or_default();
                known.0 |= level == 0 || level == LEVELS;
                known.1 += count;
            }
        }
        let mut colours: Vec<([u8; 3], (bool, u64))> = counts.into_iter().collect();
        // the sort is stable, so equal counts stay in the order of their colours
        colours.sort_by_key(|(_, (flat, count))| (!flat, u64::MAX - count));
        if colours.len() > MOST {
            let flat = colours.iter().filter(|(_, (flat, _))| *flat).count();
            let first = flat.min(MOST_FLAT);
            colours[first..].sort_by_key(|(_, (_, count))| u64::MAX - count);
            colours.truncate(MOST);
        }
        let colours = colours.into_iter().map(|([r, g, b], _)| Rgb(r, g, b)).collect();
        Inks { colours, ramps: HashMap::new() }
    }

    /// The palette as bytes; its first colour is never seen.
    pub(super) fn palette(&self) -> Vec<u8> {
        let first = self.colours.first().copied().unwrap_or(Rgb(0, 0, 0));
        [first].iter().chain(&self.colours).flat_map(|Rgb(r, g, b)| [*r, *g, *b]).collect()
    }

    /// The indices of an ink on a ground.
    pub(super) fn ramp(&mut self, ink: Rgb, ground: Rgb) -> InkRamp {
        let colours = &self.colours;
        *self.ramps.entry((ink, ground)).or_insert_with(|| {
            std::array::from_fn(|level| nearest(colours, blend(ink, ground, level)))
        })
    }
}

/// The colour of a pixel, a part of which is covered.
fn blend(Rgb(r, g, b): Rgb, Rgb(red, green, blue): Rgb, level: usize) -> Rgb {
    let mix = |ink: u8, ground: u8| {
        let sum = usize::from(ink) * level + usize::from(ground) * (LEVELS - level);
        ((sum + LEVELS / 2) / LEVELS) as u8
    };
    Rgb(mix(r, red), mix(g, green), mix(b, blue))
}

/// The index of the colour that is least far away; green counts most, as the eye sees it best.
fn nearest(colours: &[Rgb], Rgb(r, g, b): Rgb) -> u8 {
    let far = |Rgb(red, green, blue): &Rgb| {
        let square = |a: u8, b: u8| (i64::from(a) - i64::from(b)).pow(2);
        2 * square(*red, r) + 4 * square(*green, g) + 3 * square(*blue, b)
    };
    let places = colours.iter().enumerate().min_by_key(|(_, colour)| far(colour));
    places.map_or(TRANSPARENT, |(place, _)| place as u8 + 1)
}
