//! A number at each place of a plane, as shades: two places in a character where there are colours enough, else one.
//!
//! In: a field, the frame of the axes. Out: cells of the buffer, over which the other layers of a picture are drawn, and
//! the shades with their numbers. Never here: what the numbers are.

use ratatui::layout::Position;
use ratatui::style::Style;

use super::canvas::{Canvas, StyledText};
use super::number::brief;
use super::plot::PlotFrame;
use super::theme::Role;
use crate::instrument::Field;
use crate::view::colour::ColourDepth;

/// The characters from faint to strong where a character has one shade.
const SHADES: [char; 5] = ['·', '░', '▒', '▓', '█'];
const ASCII: [char; 8] = ['.', ':', '-', '=', '+', '*', '#', '@'];

fn step(share: f64, steps: usize) -> usize {
    ((share * steps as f64) as usize).min(steps - 1)
}

/// The faintest shade, that in the middle and the strongest, each as it is drawn here, with its number.
pub(super) fn keys(canvas: &Canvas<'_>, field: &Field) -> Vec<StyledText> {
    let (theme, glyphs) = (&canvas.style.theme, canvas.style.glyphs);
    let ramp = theme.density();
    let few = matches!(theme.depth(), ColourDepth::None | ColourDepth::Ansi16);
    let signs = glyphs.pick(&SHADES[..], &ASCII[..]);
    let [low, high] = field.range;
    let shades = [(0.0, low), (0.5, f64::midpoint(low, high)), (1.0, high)];
    let distinct = if high > low { &shades[..] } else { &shades[2..] };
    let spans = distinct.iter().flat_map(|&(share, value)| {
        let sign = if few || glyphs.is_ascii() { signs[step(share, signs.len())] } else { '█' };
        let key = (format!("  {sign} "), ramp[step(share, ramp.len())].style);
        [key, canvas.span(Role::Dim, brief(value, 3, glyphs))]
    });
    spans.collect()
}

pub(super) fn draw(canvas: &mut Canvas<'_>, frame: &PlotFrame, field: &Field) {
    let (theme, glyphs) = (&canvas.style.theme, canvas.style.glyphs);
    let ramp = theme.density();
    let few = matches!(theme.depth(), ColourDepth::None | ColourDepth::Ansi16);
    let number = |position: Position, share: f64| {
        let [x, _] = frame.at(position);
        let area = frame.area;
        let down = (f64::from(position.y - area.y) + share) / f64::from(area.height);
        field.at([x, frame.y.value(1.0 - down)]).map(|value| field.share(value))
    };
    for position in frame.area.positions() {
        let (symbol, style) = if few || glyphs.is_ascii() {
            let Some(share) = number(position, 0.5) else { continue };
            let style = ramp[step(share, ramp.len())].style;
            let signs = glyphs.pick(&SHADES[..], &ASCII[..]);
            (signs[step(share, signs.len())], style)
        } else {
            let halves = [0.25, 0.75].map(|half| number(position, half));
            let [upper, lower] =
                halves.map(|share| ramp[step(share.unwrap_or(0.0), ramp.len())].style.fg);
            let style = |fg, bg| Style { fg, bg, ..Style::new() };
            match halves {
                [Some(_), Some(_)] => ('▀', style(upper, lower)),
                [Some(_), None] => ('▀', style(upper, None)),
                [None, Some(_)] => ('▄', style(lower, None)),
                [None, None] => continue,
            }
        };
        if let Some(cell) = canvas.buffer.cell_mut(position) {
            cell.set_char(symbol).set_style(style);
        }
    }
}
