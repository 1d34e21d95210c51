//! The terminal of a cast: characters with the colours they are drawn in.
//!
//! In: the output of a cast. Out: cells. The output is untrusted, so it goes to a terminal in memory. Never here: time.

use crate::record::cast_theme::CastTheme;
use crate::view::colour::Rgb;

/// A character as it is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ScreenCell {
    pub(super) character: char,
    /// The colour of the character.
    pub(super) ink: Rgb,
    /// The colour behind it.
    pub(super) ground: Rgb,
    pub(super) bold: bool,
    pub(super) italic: bool,
    pub(super) underlined: bool,
    pub(super) strikethrough: bool,
}

/// How much of a faint colour is that of the background.
const FAINT: f64 = 0.4;

/// A terminal in memory.
pub(super) struct CastTerminal {
    screen: avt::Vt,
    theme: CastTheme,
}

impl CastTerminal {
    pub(super) fn new((columns, rows): (u16, u16), theme: CastTheme) -> CastTerminal {
        let size = (usize::from(columns), usize::from(rows));
        let screen = avt::Vt::builder().size(size.0, size.1).scrollback_limit(0).build();
        CastTerminal { screen, theme }
    }

    pub(super) fn feed(&mut self, text: &str) {
        self.screen.feed_str(text);
    }

    pub(super) fn resize(&mut self, columns: u16, rows: u16) {
        self.screen.resize(columns.into(), rows.into());
    }

    /// The screen row by row; what lies beyond the terminal is blank.
    pub(super) fn cells(&self, (columns, rows): (u16, u16)) -> Vec<ScreenCell> {
        let blank = self.cell(' ', avt::Pen::default());
        let mut cells = vec![blank; usize::from(columns) * usize::from(rows)];
        for (row, line) in cells.chunks_mut(columns.into()).zip(self.screen.view()) {
            for (cell, from) in row.iter_mut().zip(line.cells()) {
                // the second half of a wide character shows nothing
                let character = if from.width() == 0 { ' ' } else { from.char() };
                *cell = self.cell(character, *from.pen());
            }
        }
        cells
    }

    fn cell(&self, character: char, pen: avt::Pen) -> ScreenCell {
        let mut ink = pen.foreground().map_or(self.theme.foreground, |c| self.colour(c));
        let mut ground = pen.background().map_or(self.theme.background, |c| self.colour(c));
        if pen.is_inverse() {
            (ink, ground) = (ground, ink);
        }
        if pen.is_faint() {
            ink = ink.mix(ground, FAINT);
        }
        // blanks differ by what can be seen of them only
        let blank = character == ' ' && !pen.is_underline() && !pen.is_strikethrough();
        ScreenCell {
            character,
            ink: if blank { ground } else { ink },
            ground,
            bold: pen.is_bold() && !blank,
            italic: pen.is_italic() && !blank,
            underlined: pen.is_underline(),
            strikethrough: pen.is_strikethrough(),
        }
    }

    fn colour(&self, colour: avt::Color) -> Rgb {
        match colour {
            avt::Color::RGB(c) => Rgb(c.r, c.g, c.b),
            avt::Color::Indexed(index) => {
                let basic = self.theme.sixteen.get(usize::from(index)).copied();
                basic
                    .or_else(|| Rgb::of(ratatui::style::Color::Indexed(index)))
                    .unwrap_or(self.theme.foreground)
            }
        }
    }
}
