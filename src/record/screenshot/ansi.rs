//! A still as coloured text: consecutive lines without cursor movements.

use std::fmt::Write;

use ratatui::buffer::{Buffer, Cell};
use ratatui::style::{Color, Modifier};

use crate::view::sgr;

/// The lines; each ends with a reset of the colours.
pub(super) fn write(screen: &Buffer) -> String {
    let mut out = String::new();
    let width = usize::from(screen.area.width).max(1);
    for row in screen.content.chunks(width) {
        let end = row.iter().rposition(|cell| !is_plain_blank(cell)).map_or(0, |last| last + 1);
        let plain = sequence(&Cell::EMPTY);
        let mut style = plain.clone();
        for cell in &row[..end] {
            let wanted = sequence(cell);
            if wanted != style {
                // writing to a String cannot fail
                let _ = write!(out, "\x1b[{wanted}m");
                style = wanted;
            }
            out.push_str(cell.symbol());
        }
        out.push_str(if style == plain { "\n" } else { "\x1b[0m\n" });
    }
    out
}

fn is_plain_blank(cell: &Cell) -> bool {
    let plain = (Modifier::empty(), Color::Reset, Color::Reset);
    cell.symbol() == " " && (cell.modifier, cell.fg, cell.bg) == plain
}

/// The parameters that set a cell's style regardless of the previous one: `0;1;38;5;214`.
fn sequence(cell: &Cell) -> String {
    sgr::written(&sgr::afresh(cell.modifier, cell.fg, cell.bg))
}
