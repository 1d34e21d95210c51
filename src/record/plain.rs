//! Cells of one character each: a mark over a letter is written after it.
//!
//! Players of casts store one character per cell. A combining dot, as in θ̇, which has no precomposed character in
//! Unicode, would take the next cell (<https://github.com/asciinema/avt/issues/27>). So θ̇ becomes θ′ and the rest of
//! the row shifts by one, up to the next blank. In: a picture. Out: the same picture with single characters. Never
//! here: how a terminal shows it.

use ratatui::buffer::{Buffer, Cell};

/// Rewrites every row so that each cell contains one character.
pub fn plain(buffer: &mut Buffer) {
    let width = usize::from(buffer.area.width).max(1);
    for row in buffer.content.chunks_mut(width) {
        let mut x = 0;
        while x < row.len() {
            if row[x].symbol().chars().nth(1).is_some() {
                write_behind(row, x);
            }
            x += 1;
        }
    }
}

/// The sign that replaces a combining mark after its letter.
fn sign(mark: char) -> Option<&'static str> {
    match mark {
        '\u{307}' => Some("′"),
        '\u{308}' => Some("″"),
        _ => None,
    }
}

fn write_behind(row: &mut [Cell], x: usize) {
    let mut characters = row[x].symbol().chars();
    let letter = characters.next().map_or_else(|| " ".to_owned(), String::from);
    let sign = characters.next().and_then(sign);
    row[x].set_symbol(&letter);
    let Some(sign) = sign else { return };
    // a blank before another blank or a frame can be dropped
    let blank = |i: usize| row.get(i).is_some_and(|cell| cell.symbol() == " ");
    let spare = (x + 1..row.len()).find(|&i| blank(i) && (blank(i + 1) || is_frame(row, i + 1)));
    let narrow = |i: usize| (x..i).any(|at| is_frame(row, at));
    let single = || (x + 1..row.len()).find(|&i| blank(i));
    let Some(spare) = spare.filter(|&i| !narrow(i)).or_else(single).filter(|&i| !narrow(i)) else {
        return;
    };
    row[x + 1..=spare].rotate_right(1);
    row[x + 1] = row[x].clone();
    row[x + 1].set_symbol(sign);
}

fn is_frame(row: &[Cell], at: usize) -> bool {
    row.get(at).is_none_or(|cell| matches!(cell.symbol(), "│" | "┃" | "|"))
}

#[cfg(test)]
mod tests {
    use ratatui::style::Style;

    use super::*;

    #[test]
    fn dots_become_primes() {
        let check = |text: &str, expected: &str| {
            let mut buffer = Buffer::empty(ratatui::layout::Rect::new(0, 0, 20, 1));
            buffer.set_string(0, 0, text, Style::new());
            plain(&mut buffer);
            let row: String = buffer.content.iter().map(Cell::symbol).collect();
            assert_eq!(row.trim_end(), expected);
            assert_eq!(row.chars().count(), 20);
        };
        check("θ = 1", "θ = 1");
        check("θ̇          0 rad/s │", "θ′         0 rad/s │");
        check("m θ̇² + g cos θ │", "m θ′² + g cos θ│");
        check("│θ̈ = −g  │ x", "│θ″ = −g │ x");
        check("│θ̇│ x", "│θ│ x");
        check("ẋ 1", "ẋ 1");
    }
}
