//! Themes: the roles of the screen's parts, resolved to the styles a terminal can show.
//!
//! In: a palette of [`PALETTES`] and a [`ColourDepth`]. Out: a [`Theme`], which maps each [`Role`] to a style.
//! Never here: the use of a role. Without colour the roles differ by bold, dim, reverse and underline alone.

mod dash;
mod palettes;
mod ramps;
mod role;

use std::ops::Index;

use ratatui::style::{Color, Modifier, Style};

use super::colour::{ColourDepth, Rgb};
use ramps::Ramps;

pub use dash::Dash;
pub use palettes::{PALETTES, Palette};
pub use ramps::Tones;
pub use role::{CURVES, PaletteColour, Role, Shade};

/// The number of steps of a trail, from oldest to newest; it is small, so that a frame changes few cells.
const AGES: usize = 8;

/// The number of steps of the density ramp, from sparse to dense.
const DENSITIES: usize = 12;

/// By how much the brightness of a line differs at least from that of a surface behind it.
const LEGIBLE: f64 = 0.25;

/// The number of steps to the foreground that are tried to reach that difference.
const LEGIBLE_STEPS: u8 = 5;

/// The styles of a palette at one depth.
#[derive(Clone, Debug)]
pub struct Theme {
    palette: &'static Palette,
    /// The depth of the terminal; the palette may use less.
    asked: ColourDepth,
    depth: ColourDepth,
    roles: [Style; Role::ALL.len()],
    curves: [Style; CURVES],
    trails: Vec<Vec<Shade>>,
    density: Vec<Shade>,
    /// The colours of surfaces, with the colour that each belongs to.
    tones: Vec<(Color, Tones)>,
}

impl Theme {
    /// The theme with this name at a depth, or `None` if there is no such palette.
    pub fn named(name: &str, depth: ColourDepth) -> Option<Self> {
        PALETTES.iter().find(|palette| palette.name == name).map(|p| Self::new(p, depth))
    }

    /// The default theme: it is made for dark terminals, and legible on light ones.
    pub fn dark(depth: ColourDepth) -> Self {
        Self::new(&PALETTES[0], depth)
    }

    /// The theme of a palette at a depth.
    pub fn new(palette: &'static Palette, depth: ColourDepth) -> Self {
        let asked = depth;
        let depth = depth.min(palette.most);
        let ramps = Ramps { palette, depth };
        Self {
            palette,
            asked,
            depth,
            roles: palette.roles.map(|ink| ink.style(depth)),
            curves: palette.curves.map(|ink| ink.style(depth)),
            trails: palette.curves.iter().map(|ink| ramps.trail(ink, AGES)).collect(),
            density: ramps.density(DENSITIES),
            tones: {
                let level = &palette.roles[Role::Level as usize];
                let of = |ink: &PaletteColour, tones| Some((ink.style(depth).fg?, tones?));
                let series = palette.curves.iter().map(|ink| of(ink, ramps.tones(ink)));
                series.chain([of(level, ramps.level_tones(level))]).flatten().collect()
            },
        }
    }

    /// The same theme at another depth.
    #[must_use]
    pub fn with_depth(self, depth: ColourDepth) -> Self {
        let ages = self.trails.first().map_or(AGES, Vec::len);
        Self::new(self.palette, depth).with_ages(ages)
    }

    /// The same theme with only a share of the dots of its trails.
    #[must_use]
    pub fn thinned(mut self, share: f64) -> Self {
        for shade in self.trails.iter_mut().flatten() {
            shade.coverage *= share;
        }
        self
    }

    /// The same theme with another number of steps in its trails; with fewer steps, a frame changes fewer cells.
    #[must_use]
    pub fn with_ages(self, ages: usize) -> Self {
        let ramps = Ramps { palette: self.palette, depth: self.depth };
        let trails = self.palette.curves.iter().map(|ink| ramps.trail(ink, ages)).collect();
        Self { trails, ..self }
    }

    /// The theme of another palette for the same terminal, or `None` if there is none with this name.
    pub fn renamed(&self, name: &str) -> Option<Self> {
        Some(Self::named(name, self.asked)?.with_ages(self.trails[0].len()))
    }

    /// The colours by their roles.
    pub fn palette(&self) -> &'static Palette {
        self.palette
    }

    /// The depth of colour it uses.
    pub fn depth(&self) -> ColourDepth {
        self.depth
    }

    /// The style of text about the n-th series; the colours repeat after the last.
    pub fn curve(&self, series: usize) -> Style {
        self.curves[series % CURVES]
    }

    /// The style of the line of the n-th series: where the colours repeat, with the next dash pattern; without colour each series
    /// has its own.
    pub fn series(&self, series: usize) -> Shade {
        let dash = match self.depth {
            ColourDepth::None => Dash::ALL[series % Dash::ALL.len()],
            _ => Dash::ALL[series / CURVES % Dash::ALL.len()],
        };
        Shade { style: self.curve(series), coverage: 1.0, dash }
    }

    /// The style of a line of a role; without colour, level curves and the like are dotted.
    pub fn line(&self, role: Role) -> Shade {
        let behind = matches!(role, Role::Level | Role::Border | Role::Dim);
        let dotted = self.depth == ColourDepth::None && behind;
        let coverage = if dotted { 0.4 } else { 1.0 };
        Shade { style: self[role], coverage, dash: Dash::Full }
    }

    /// A style as it looks at a distance, still legible: `far` is 0 at the front of the picture and 1 at its back. Among few colours, and
    /// without any, only the farther half is dimmed.
    pub fn receding(&self, style: Style, far: f64) -> Style {
        let own = style.fg.and_then(Rgb::of).unwrap_or(self.palette.foreground);
        let Rgb(r, g, b) = self.palette.faded(own, 0.6 * far);
        match self.depth {
            _ if far <= 0.0 => style,
            ColourDepth::True => style.fg(Color::Rgb(r, g, b)),
            ColourDepth::Ansi256 => style.fg(Color::Indexed(Rgb(r, g, b).nearest256())),
            ColourDepth::Ansi16 | ColourDepth::None if far > 0.5 => {
                style.remove_modifier(Modifier::BOLD).add_modifier(Modifier::DIM)
            }
            ColourDepth::Ansi16 | ColourDepth::None => style,
        }
    }

    /// The colours of a surface of this style, that of level curves or of a series, from shade to full light; `None` where
    /// colours are too few to shade with.
    pub fn tones(&self, style: Style) -> Option<&Tones> {
        self.tones.iter().find(|(own, _)| Some(*own) == style.fg).map(|(_, tones)| tones)
    }

    /// The style of dots that fill what is too thin for tones: its own colour or its brightest tone, whichever stands out more from
    /// the page, because dots are sparser than a background. `None` where colours are too few to shade with.
    pub fn dots(&self, style: Style) -> Option<Style> {
        let own = style.fg.into_iter().chain(self.tones(style)?.last().copied());
        let contrast = |colour: &Color| {
            Rgb::of(*colour).map_or(0.0, |colour| colour.contrast(self.palette.background))
        };
        let boldest = own.max_by(|a, b| contrast(a).total_cmp(&contrast(b)));
        boldest.map(|colour| style.fg(colour))
    }

    /// A style whose colour stands out from this background: its own, one nearer to the foreground, or where neither is, whichever
    /// of the foreground and the palette's own background differs more.
    pub fn legible(&self, style: Style, background: Color) -> Style {
        let foreground = self.palette.foreground;
        let own = style.fg.and_then(Rgb::of).unwrap_or(foreground);
        let behind = Rgb::of(background).unwrap_or(self.palette.background).brightness();
        let apart = |colour: Rgb| (colour.brightness() - behind).abs();
        if apart(own) >= LEGIBLE {
            return style;
        }
        let shown = |colour: Rgb| match self.depth {
            ColourDepth::Ansi256 => {
                let index = colour.nearest256();
                (Rgb::of_index(index), Color::Indexed(index))
            }
            _ => (colour, Color::Rgb(colour.0, colour.1, colour.2)),
        };
        let shares = (1..=LEGIBLE_STEPS).map(|step| f64::from(step) / f64::from(LEGIBLE_STEPS));
        let mut colours = shares.map(|share| shown(own.towards(foreground, share)));
        let ends = || [foreground, self.palette.background].map(shown);
        let farthest = || ends().into_iter().max_by(|a, b| apart(a.0).total_cmp(&apart(b.0)));
        let found = colours.find(|(colour, _)| apart(*colour) >= LEGIBLE).or_else(farthest);
        found.map_or(style, |(_, colour)| style.fg(colour))
    }

    /// The fading trail of the n-th series, from a faint one to its colour, brightened.
    ///
    /// The contrast with the background never decreases from one step to the next. Without colour, old steps are
    /// dimmed and thinned out.
    pub fn trail(&self, series: usize) -> &[Shade] {
        &self.trails[series % CURVES]
    }

    /// The shades of a cloud of points from sparse to dense, with increasing contrast.
    pub fn density(&self) -> &[Shade] {
        &self.density
    }
}

impl Index<Role> for Theme {
    type Output = Style;

    fn index(&self, role: Role) -> &Style {
        &self.roles[role as usize]
    }
}
