//! A number at each place of a plane, as shades: two places in a character where there are colours enough, else one.
//!
//! In: a field, the frame of the axes. Out: cells of the buffer, over which the other layers of a picture are drawn. Never
//! here: what the numbers are.

use ratatui::layout::Position;
use ratatui::style::Style;

use super::canvas::Canvas;
use super::plot::PlotFrame;
use crate::instrument::Field;
use crate::view::colour::ColourDepth;

/// The characters from faint to strong where a character has one shade.
const SHADES: [char; 5] = ['·', '░', '▒', '▓', '█'];
const ASCII: [char; 8] = ['.', ':', '-', '=', '+', '*', '#', '@'];

/// Draws a field.
pub(super) fn draw(canvas: &mut Canvas<'_>, frame: &PlotFrame, field: &Field) {
    let (theme, glyphs) = (&canvas.look.theme, canvas.look.glyphs);
    let ramp = theme.density();
    let few = matches!(theme.depth(), ColourDepth::None | ColourDepth::Ansi16);
    let step = |share: f64, steps: usize| ((share * steps as f64) as usize).min(steps - 1);
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
