//! A still as text with its colours: lines one after the other, without any moving about of the cursor.

use std::fmt::Write;

use ratatui::buffer::{Buffer, Cell};
use ratatui::style::{Color, Modifier};

/// The lines; each ends in the terminal's own colours.
pub(super) fn write(screen: &Buffer) -> String {
    let mut out = String::new();
    let width = usize::from(screen.area.width).max(1);
    for row in screen.content.chunks(width) {
        let end = row.iter().rposition(|cell| !is_plain_blank(cell)).map_or(0, |last| last + 1);
        let mut style = String::new();
        for cell in &row[..end] {
            let wanted = sequence(cell);
            if wanted != style {
                // writing to a String cannot fail
                let _ = write!(out, "\x1b[0{wanted}m");
                style = wanted;
            }
            out.push_str(cell.symbol());
        }
        out.push_str(if style.is_empty() { "\n" } else { "\x1b[0m\n" });
    }
    out
}

fn is_plain_blank(cell: &Cell) -> bool {
    cell.symbol() == " " && sequence(cell).is_empty()
}

/// What sets a cell's style, from the plain one: `;1;38;5;214`.
fn sequence(cell: &Cell) -> String {
    const WEIGHTS: [(Modifier, &str); 5] = [
        (Modifier::BOLD, ";1"),
        (Modifier::DIM, ";2"),
        (Modifier::ITALIC, ";3"),
        (Modifier::UNDERLINED, ";4"),
        (Modifier::REVERSED, ";7"),
    ];
    let weights = WEIGHTS.iter().filter(|(m, _)| cell.modifier.contains(*m)).map(|(_, s)| *s);
    weights.collect::<String>() + &colour(cell.fg, 30) + &colour(cell.bg, 40)
}

fn colour(colour: Color, base: u8) -> String {
    const SIXTEEN: [Color; 16] = [
        Color::Black,
        Color::Red,
        Color::Green,
        Color::Yellow,
        Color::Blue,
        Color::Magenta,
        Color::Cyan,
        Color::Gray,
        Color::DarkGray,
        Color::LightRed,
        Color::LightGreen,
        Color::LightYellow,
        Color::LightBlue,
        Color::LightMagenta,
        Color::LightCyan,
        Color::White,
    ];
    match colour {
        Color::Reset => String::new(),
        Color::Rgb(r, g, b) => format!(";{};2;{r};{g};{b}", base + 8),
        Color::Indexed(index) => format!(";{};5;{index}", base + 8),
        named => match SIXTEEN.iter().position(|known| *known == named) {
            Some(index) if index < 8 => format!(";{}", base + index as u8),
            Some(index) => format!(";{}", base + 52 + index as u8),
            None => String::new(),
        },
    }
}
