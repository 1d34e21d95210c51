//! A trail that is kept between frames: a stamp for each dot instead of a stroke for each point.
//!
//! In: new points, each with a stamp that never decreases; which stamps are still part of the trail, and where each
//! age begins. Out: dots of a raster, the same as if the whole trail were drawn again. Never here: where points come
//! from, or whether they continue those before.
//!
//! A frame then costs a look at every cell, however long the trail is.

use super::course::Course;
use super::letter::faded;
use super::{Pen, Raster, noise};
use crate::view::glyphs::Glyphs;
use crate::view::plot::depth::{DepthBuffer, Visibility};
use crate::view::plot::scale::PlotFrame;
use crate::view::theme::{Dash, Shade};

/// The number of dots in a cell at most.
const DOTS: usize = 8;

/// The stamp of the current state, which is drawn but not kept.
const NOW: f64 = f64::INFINITY;

/// The age to which a veil dims a trail, as a part of all ages.
const VEILED: usize = 3;

/// What a stroke leaves on a dot.
#[derive(Clone, Copy, Debug)]
struct StrokeStamp {
    time: f64,
    near: f64,
}

/// A trail over a frame.
#[derive(Clone, Debug)]
pub struct CachedTrail {
    blank: Raster,
    /// The newest stamp of each dot, cell by cell; −∞ where there never was one.
    stamps: Vec<[f64; DOTS]>,
    /// How near to the eye the newest stroke on each dot is.
    nears: Vec<[f64; DOTS]>,
    /// The newest stamp of each cell.
    newest: Vec<f64>,
    course: Course<StrokeStamp>,
    dash: Dash,
    /// Whether the characters of ASCII show the age.
    fading: bool,
}

/// How a kept trail is drawn in one frame.
#[derive(Clone, Copy, Debug)]
pub struct Ages<'a> {
    /// The stamp from which each age on is drawn, the oldest first; lesser stamps than the first are not drawn.
    pub since: &'a [f64],
    /// The shade of each age.
    pub ramp: &'a [Shade],
    /// Greater ones lie over lesser ones.
    pub layer: u8,
    /// The surfaces that hide a part of the trail, and how near to the eye the current point is.
    pub behind: Option<(&'a DepthBuffer, f64)>,
}

impl Ages<'_> {
    /// The age of a stamp, if it is still drawn.
    fn of(&self, stamp: f64) -> Option<usize> {
        // the times of the ages ascend
        self.since.partition_point(|since| *since <= stamp).checked_sub(1)
    }

    /// The age with which a dot is drawn, if it is drawn: behind a veil it looks old.
    fn seen(&self, stamp: f64, sight: Visibility) -> Option<usize> {
        let age = self.of(stamp)?;
        match sight {
            Visibility::Clear => Some(age),
            Visibility::Veiled => Some(age.min(self.ramp.len() / VEILED)),
            Visibility::Hidden => None,
        }
    }
}

impl CachedTrail {
    /// Creates an empty trail over a frame: fading, or a line with a pattern.
    pub fn new(frame: &PlotFrame, glyphs: Glyphs, line: Option<Dash>) -> Self {
        let blank = Raster::new(frame.area, glyphs);
        let count = blank.cells.len();
        Self {
            stamps: vec![[f64::NEG_INFINITY; DOTS]; count],
            nears: vec![[0.0; DOTS]; count],
            newest: vec![f64::NEG_INFINITY; count],
            course: Course::new(frame, blank.size()),
            blank,
            dash: line.unwrap_or(Dash::Full),
            fading: line.is_none(),
        }
    }

    /// Continues the trail to a point: right, up, towards the eye; the stroke that leads there gets the stamp.
    pub fn to(&mut self, [x, y, near]: [f64; 3], time: f64) {
        let grid = self.grid();
        let (dash, lettered) = (self.dash, grid != [1, 1]);
        let Self { blank, stamps, nears, newest, course, .. } = self;
        course.to([x, y], (StrokeStamp { time, near }, grid), &mut |dot, inked| {
            if !(lettered || dash.covers(dot[inked.along])) {
                return;
            }
            let Some((cell, bit)) = blank.place(inked.centre(dot)) else { return };
            let bit = bit.trailing_zeros() as usize;
            stamps[cell][bit] = inked.ink.time;
            nears[cell][bit] = inked.ink.near;
            newest[cell] = newest[cell].max(inked.ink.time);
        });
    }

    /// Draws the trail and a last stroke to the current point.
    pub fn draw(&self, raster: &mut Raster, ages: Ages<'_>, present: [f64; 2]) {
        let pens: Vec<Pen> = (ages.ramp.iter().enumerate())
            .map(|(age, shade)| Pen::aged(*shade, ages.layer, age))
            .collect();
        let sign = |age: usize| match self.blank.glyphs {
            Glyphs::Ascii if self.fading => Some(faded(age, ages.ramp.len())),
            Glyphs::Ascii => self.dash.letter(),
            _ => None,
        };
        let behind = ages.behind.filter(|(depth, _)| !depth.is_empty());
        let oldest = ages.since.first().copied().unwrap_or(NOW);
        for (cell, stamps) in self.stamps.iter().enumerate() {
            if self.newest[cell] < oldest {
                continue;
            }
            for (bit, stamp) in stamps.iter().enumerate().filter(|(_, stamp)| **stamp >= oldest) {
                let near = self.nears[cell][bit];
                let sight = behind.map_or(Visibility::Clear, |(depth, _)| {
                    depth.sight(raster.dot_of(cell, bit), near)
                });
                let age = ages.seen(*stamp, sight);
                if let Some((age, pen)) = age.and_then(|age| Some((age, pens.get(age)?))) {
                    raster.ink_bit((cell, bit), pen, sign(age));
                }
            }
        }
        let (dash, grid) = (self.dash, self.grid());
        let mut end = |dot: [i32; 2], inked: super::course::Inked<StrokeStamp>| {
            let sight = behind.map_or(Visibility::Clear, |(depth, _)| {
                depth.sight(inked.centre(dot), inked.ink.near)
            });
            let age = ages.seen(inked.ink.time, sight);
            let Some((age, pen)) = age.and_then(|age| Some((age, pens.get(age)?))) else { return };
            if grid != [1, 1] || dash.covers(dot[inked.along]) {
                raster.ink(inked.centre(dot), pen, sign(age));
            }
        };
        let mut course = self.course.clone();
        let near = ages.behind.map_or(0.0, |(_, near)| near);
        course.to(present, (StrokeStamp { time: NOW, near }, grid), &mut end);
        course.rest(&mut end);
    }

    /// The number of dots drawn as one: characters of ASCII fill a cell.
    fn grid(&self) -> [i32; 2] {
        let ascii = self.blank.glyphs == Glyphs::Ascii;
        let lettered = ascii && (self.fading || self.dash.letter().is_some());
        if lettered { self.blank.cell() } else { [1, 1] }
    }
}

impl Raster {
    /// Sets a dot by its cell and the index of its bit.
    pub(super) fn ink_bit(&mut self, (cell, bit): (usize, usize), pen: &Pen, sign: Option<char>) {
        if pen.coverage < 1.0 && noise(self.thinning(cell, bit)) >= pen.coverage {
            return;
        }
        self.set((cell, 1 << bit), pen, sign);
    }

    /// The place that decides whether a dot is left out where dots are thinned.
    fn thinning(&self, cell: usize, bit: usize) -> [i32; 2] {
        if self.glyphs.is_ascii() {
            let columns = usize::from(self.area.width).max(1);
            return [(cell % columns) as i32, (cell / columns) as i32];
        }
        self.dot_of(cell, bit)
    }

    /// The place of a dot, by its cell and the index of its bit.
    fn dot_of(&self, cell: usize, bit: usize) -> [i32; 2] {
        let columns = usize::from(self.area.width).max(1);
        let (column, row) = ((cell % columns) as i32, (cell / columns) as i32);
        let [wide, high] = self.cell();
        [column * wide + bit as i32 % wide, row * high + bit as i32 / wide]
    }
}

#[cfg(test)]
mod tests {
    use ratatui::buffer::Buffer;
    use ratatui::layout::Rect;

    use super::super::course::Inked;
    use super::*;
    use crate::view::colour::ColourDepth;
    use crate::view::plot::Scale;
    use crate::view::theme::Theme;

    /// A line that leaves the frame, wraps, jumps and has gaps.
    fn line(count: usize) -> Vec<[f64; 2]> {
        let mut seed = 7_u64;
        let mut random = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963);
            (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        let mut at = [0.0, 0.0];
        let step = |i: usize, at: &mut [f64; 2], random: &mut dyn FnMut() -> f64| {
            let reach = if i.is_multiple_of(37) { 3.0 } else { 0.2 };
            *at = [at[0] + reach * random(), at[1] * 0.98 + reach * random()];
            if i % 101 == 50 { [f64::NAN, 0.0] } else { *at }
        };
        (0..count).map(|i| step(i, &mut at, &mut random)).collect()
    }

    fn shown(raster: &Raster) -> Buffer {
        let mut buffer = Buffer::empty(raster.area);
        raster.draw(&mut buffer);
        buffer
    }

    /// A fading trail drawn at once, oldest point first: the points are divided among the steps of a ramp.
    fn draw_whole(raster: &mut Raster, frame: &PlotFrame, points: &[[f64; 2]], ramp: &[Shade]) {
        let is_ascii = raster.glyphs == Glyphs::Ascii;
        let grid = if is_ascii { raster.cell() } else { [1, 1] };
        let mut course = Course::new(frame, raster.size());
        let mut put = |dot: [i32; 2], inked: Inked<usize>| {
            let age = inked.ink;
            let pen = Pen::aged(ramp[age], 2, age);
            let sign = is_ascii.then(|| faded(age, ramp.len()));
            if sign.is_some() || pen.dash.covers(dot[inked.along]) {
                raster.ink(inked.centre(dot), &pen, sign);
            }
        };
        for (index, point) in points.iter().enumerate() {
            let age = ((index + 1) * ramp.len()).div_ceil(points.len()) - 1;
            course.to(*point, (age, grid), &mut put);
        }
        course.rest(&mut put);
    }

    #[test]
    fn a_cached_trail_is_the_same_as_one_drawn_whole() {
        let area = Rect::new(0, 0, 31, 13);
        let whole = Scale::linear(-1.5, 1.5);
        let frames = [
            PlotFrame::new(whole, whole, area),
            PlotFrame::new(Scale::linear(-1.0, 1.0).wrapped(2.0), whole, area),
        ];
        let points = line(900);
        assert_eq!(points.len(), 900);
        for (frame, depth) in
            frames.iter().flat_map(|f| [ColourDepth::True, ColourDepth::None].map(|d| (f, d)))
        {
            let theme = Theme::dark(depth);
            let ramp = theme.trail(1);
            for glyphs in [Glyphs::Braille, Glyphs::HalfBlock, Glyphs::Ascii] {
                let mut cached = CachedTrail::new(frame, glyphs, None);
                for (index, point) in points.iter().enumerate() {
                    cached.to([point[0], point[1], 0.0], index as f64);
                    let count = index + 1;
                    if ![1, 2, 3, 10, 51, 500, 777, 900].contains(&count) {
                        continue;
                    }
                    let present = [0.3, 0.4];
                    let all: Vec<_> = points[..count].iter().copied().chain([present]).collect();
                    let mut whole = Raster::new(area, glyphs);
                    draw_whole(&mut whole, frame, &all, ramp);
                    let start = |age: usize| age * all.len() / ramp.len();
                    let since: Vec<f64> = (0..ramp.len())
                        .map(|age| if start(age) < count { start(age) as f64 } else { NOW })
                        .collect();
                    let mut again = Raster::new(area, glyphs);
                    cached.draw(
                        &mut again,
                        Ages { since: &since, ramp, layer: 2, behind: None },
                        present,
                    );
                    assert_eq!(shown(&again), shown(&whole), "{glyphs:?} {depth:?} {count}");
                }
            }
        }
    }

    #[test]
    fn what_is_older_than_the_trail_is_not_drawn() {
        let area = Rect::new(0, 0, 10, 4);
        let scale = Scale::linear(0.0, 1.0);
        let frame = PlotFrame::new(scale, scale, area);
        let theme = Theme::dark(ColourDepth::True);
        let mut cached = CachedTrail::new(&frame, Glyphs::Braille, None);
        cached.to([0.0, 0.1, 0.0], 0.0);
        cached.to([0.4, 0.1, 0.0], 1.0);
        cached.to([0.9, 0.8, 0.0], 2.0);
        let dots = |oldest: f64| {
            let mut raster = Raster::new(area, Glyphs::Braille);
            let ages = Ages { since: &[oldest; 8], ramp: theme.trail(0), layer: 1, behind: None };
            cached.draw(&mut raster, ages, [0.9, 0.8]);
            (raster.is_set([2, 14]), raster.is_set([18, 3]))
        };
        assert_eq!([dots(0.0), dots(2.0)], [(true, true), (false, true)]);
    }
}
