//! The screen of a cast, drawn into cells.
//!
//! In: the terminal in memory. Out: its characters and colours, reduced to what this terminal shows. Never here: time,
//! keys, or what is drawn over it (`cast_player`).

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Color, Modifier, Style};

use crate::view::RenderStyle;
use crate::view::colour::{ColourDepth, Rgb};
use crate::view::glyphs::Glyphs;

/// Draws as much of the screen as the area holds; the rest of the area is left as it is.
pub(super) fn draw_screen(screen: &avt::Vt, style: &RenderStyle, area: Rect, buffer: &mut Buffer) {
    let depth = style.theme.depth();
    for (y, line) in (area.top()..area.bottom()).zip(screen.view()) {
        let mut x = area.left();
        for cell in line.cells() {
            // This is the second half of a wide character.
            if cell.width() == 0 {
                continue;
            }
            if x + cell.width() as u16 > area.right() {
                break;
            }
            let drawn = &mut buffer[(x, y)];
            let plain = style.glyphs.is_ascii() && !cell.char().is_ascii();
            drawn.set_char(if plain { spelt(cell.char()) } else { cell.char() });
            drawn.set_style(pen_style(cell.pen(), depth));
            x += cell.width() as u16;
        }
    }
}

/// Returns an ASCII replacement of a character.
fn spelt(character: char) -> char {
    let text = Glyphs::Ascii.text(&character.to_string()).into_owned();
    match (character, text.as_str()) {
        ('\u{2800}', _) => ' ',
        ('\u{2801}'..='\u{28ff}' | '▀'..='▟', _) => '*',
        ('─'..='╿', "?") => '+',
        (_, text) => text.chars().next().unwrap_or('?'),
    }
}

fn pen_style(pen: &avt::Pen, depth: ColourDepth) -> Style {
    let mut style = Style::new();
    style.fg = pen.foreground().and_then(|c| colour(c, depth));
    style.bg = pen.background().and_then(|c| colour(c, depth));
    let weights = [
        (pen.is_bold(), Modifier::BOLD),
        (pen.is_faint(), Modifier::DIM),
        (pen.is_italic(), Modifier::ITALIC),
        (pen.is_underline(), Modifier::UNDERLINED),
        (pen.is_strikethrough(), Modifier::CROSSED_OUT),
        (pen.is_inverse(), Modifier::REVERSED),
    ];
    for (_, weight) in weights.into_iter().filter(|(has, _)| *has) {
        style = style.add_modifier(weight);
    }
    style
}

/// Reduces a colour to what this terminal supports.
fn colour(colour: avt::Color, depth: ColourDepth) -> Option<Color> {
    match (depth, colour) {
        (ColourDepth::None, _) => None,
        (ColourDepth::True, avt::Color::RGB(c)) => Some(Color::Rgb(c.r, c.g, c.b)),
        (ColourDepth::Ansi256, avt::Color::RGB(c)) => {
            Some(Color::Indexed(Rgb(c.r, c.g, c.b).nearest256()))
        }
        (ColourDepth::Ansi16, avt::Color::RGB(_) | avt::Color::Indexed(16..)) => None,
        (_, avt::Color::Indexed(index)) => Some(Color::Indexed(index)),
    }
}
