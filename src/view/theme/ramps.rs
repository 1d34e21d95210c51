//! Ramps: sequences of shades whose contrast with the background never decreases.
//!
//! In: a palette and a depth. Out: the steps of trails, of density and of light. Never here: which step a dot gets.

use ratatui::style::{Color, Modifier, Style};

use super::dash::Dash;
use super::palettes::Palette;
use super::role::{PaletteColour, Shade};
use crate::view::colour::{ColourDepth, Rgb};

/// The number of steps from shade to full light; with fewer steps, a frame in which a body turns changes fewer cells.
const LIGHTS: usize = 10;

/// The least contrast of a surface's tones with the background: a side in the shade is no hole.
const LEAST_CONTRAST: f64 = 1.5;

/// The colours of a surface from shade to full light.
pub type Tones = [Color; LIGHTS];

/// Makes the ramps of a palette at a depth.
pub(super) struct Ramps {
    pub(super) palette: &'static Palette,
    pub(super) depth: ColourDepth,
}

impl Ramps {
    /// `ages` steps from the faintest line that is still legible to the colour, which only the newest reaches, a little brightened.
    pub(super) fn trail(&self, ink: &PaletteColour, ages: usize) -> Vec<Shade> {
        let colour = ink.rgb.unwrap_or(self.palette.foreground);
        let faintest = self.palette.faded(colour, 0.62);
        let newest = colour.mix(self.palette.foreground, 0.12);
        let base = ink.ansi;
        // Bright has more contrast than plain on black, but less on white.
        let oldest = if self.contrast(Color::DarkGray) < self.contrast(base) {
            Color::DarkGray
        } else {
            base
        };
        let bright = brighter(base);
        let bright = if self.contrast(bright) > self.contrast(base) { bright } else { base };
        self.steps(ages, &[oldest, base, base, bright], |fresh| {
            if fresh < 0.75 {
                faintest.mix(colour, fresh / 0.75)
            } else {
                colour.mix(newest, (fresh - 0.75) / 0.25)
            }
        })
    }

    /// `steps` shades from sparse to dense.
    pub(super) fn density(&self, steps: usize) -> Vec<Shade> {
        let heat = self.palette.heat.map(|ink| ink.rgb.unwrap_or(self.palette.foreground));
        self.steps(steps, &self.palette.heat.map(|ink| ink.ansi), |share| {
            let place = share * (heat.len() - 1) as f64;
            let below = (place as usize).min(heat.len() - 2);
            heat[below].mix(heat[below + 1], place - below as f64)
        })
    }

    /// The colours of a surface of level curves from shade to full light: among 256 colours greys, as no other has steps fine
    /// enough. `None` where colours are too few.
    pub(super) fn level_tones(&self, ink: &PaletteColour) -> Option<Tones> {
        let rgb = ink.rgb.filter(|_| self.depth == ColourDepth::Ansi256).map(Rgb::grey);
        self.tones(&PaletteColour { rgb: rgb.or(ink.rgb), ..*ink })
    }

    /// The colours of a surface from shade to full light; `None` where colours are too few.
    pub(super) fn tones(&self, ink: &PaletteColour) -> Option<Tones> {
        let own = ink.rgb.unwrap_or(self.palette.foreground);
        // between the background and its own colour, and brighter in the light on paper of any colour
        let background = self.palette.background;
        let (most, steps) = if self.palette.is_dark() { (0.85, 4..17) } else { (0.75, 5..15) };
        let nearest = steps.map(|step| 0.05 * f64::from(step));
        let is_seen =
            |share: &f64| background.mix(own, *share).contrast(background) >= LEAST_CONTRAST;
        let least = nearest.into_iter().find(is_seen).unwrap_or(most);
        let ends = if self.palette.is_dark() { [least, most] } else { [most, least] };
        let tone = |step: usize| {
            let light = step as f64 / (LIGHTS - 1) as f64;
            background.mix(own, ends[0] + (ends[1] - ends[0]) * light)
        };
        match self.depth {
            ColourDepth::True => Some(std::array::from_fn(|step| {
                let Rgb(r, g, b) = tone(step);
                Color::Rgb(r, g, b)
            })),
            ColourDepth::Ansi256 => {
                Some(std::array::from_fn(|step| Color::Indexed(tone(step).nearest256())))
            }
            ColourDepth::Ansi16 | ColourDepth::None => None,
        }
    }

    /// A ramp of a few of the sixteen colours, or of the colours that `at` gives for positions from 0 to 1.
    fn steps(&self, steps: usize, few: &[Color], at: impl Fn(f64) -> Rgb) -> Vec<Shade> {
        let mut strongest = (0.0, Color::Reset);
        (0..steps)
            .map(|step| {
                let share = if steps < 2 { 1.0 } else { step as f64 / (steps - 1) as f64 };
                if self.depth == ColourDepth::None {
                    return weight(share);
                }
                let colour = match self.depth {
                    ColourDepth::Ansi256 => Color::Indexed(at(share).nearest256()),
                    ColourDepth::True => {
                        let Rgb(r, g, b) = at(share);
                        Color::Rgb(r, g, b)
                    }
                    _ => few[((share * few.len() as f64) as usize).min(few.len() - 1)],
                };
                // Rounding to the palette may reduce the contrast; then the previous step is used again.
                if self.contrast(colour) >= strongest.0 {
                    strongest = (self.contrast(colour), colour);
                }
                Shade { style: Style::new().fg(strongest.1), coverage: 1.0, dash: Dash::Full }
            })
            .collect()
    }

    fn contrast(&self, colour: Color) -> f64 {
        Rgb::of(colour).unwrap_or(self.palette.foreground).contrast(self.palette.background)
    }
}

/// A step without colour: dim and thin, plain, or bold.
fn weight(share: f64) -> Shade {
    let modifier = match share {
        s if s < 0.3 => Modifier::DIM,
        s if s < 0.9 => Modifier::empty(),
        _ => Modifier::BOLD,
    };
    let style = Style::new().add_modifier(modifier);
    Shade { style, coverage: (0.2 + 1.2 * share).min(1.0), dash: Dash::Full }
}

/// The bright counterpart of one of the eight base colours.
fn brighter(colour: Color) -> Color {
    match colour {
        Color::Red => Color::LightRed,
        Color::Green => Color::LightGreen,
        Color::Yellow => Color::LightYellow,
        Color::Blue => Color::LightBlue,
        Color::Magenta => Color::LightMagenta,
        Color::Cyan => Color::LightCyan,
        Color::Gray => Color::White,
        other => other,
    }
}
