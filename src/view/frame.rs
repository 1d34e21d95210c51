//! Frames: what a terminal shows, and the bytes that turn it into the next picture.
//!
//! In: a function that draws. Out: a frame of bytes between the marks of synchronized output, or nothing if no cell
//! has changed. Never here: sending the bytes, or when to draw.
//!
//! ratatui's [`Terminal`] stores the pictures and finds what has changed; the encoder is its backend.

mod encoder;
mod pen;

use std::io;

use ratatui::Terminal;
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect, Size};

use encoder::Encoder;

use crate::printable::is_steering;

/// The picture on a terminal, and the encoder for the next one.
#[derive(Debug)]
pub struct Frames {
    terminal: Terminal<Encoder>,
    /// The last drawn picture, unless the terminal's contents are unknown.
    shown: Option<Buffer>,
}

impl Frames {
    /// Creates frames for a terminal with unknown contents; `synchronized` puts the marks around each frame.
    ///
    /// # Errors
    /// Returns the encoder's errors. It writes into memory and has none.
    pub fn new(synchronized: bool) -> io::Result<Self> {
        Ok(Self { terminal: Terminal::new(Encoder::new(synchronized))?, shown: None })
    }

    /// Forgets what the terminal shows: the next frame paints every cell.
    pub fn forget(&mut self) {
        self.shown = None;
    }

    /// Whether the terminal shows the last drawn picture, as far as is known.
    pub fn is_current(&self) -> bool {
        self.shown.is_some() && !self.terminal.backend().has_pending()
    }

    /// The last drawn picture, or `None` if the terminal's contents are unknown.
    pub fn shown(&self) -> Option<&Buffer> {
        self.shown.as_ref()
    }

    /// The position of the terminal's cursor, or `None` if it is hidden.
    pub fn cursor(&self) -> Option<Position> {
        self.terminal.backend().cursor()
    }

    /// Returns the bytes that turn the current picture into what `draw` draws on a blank area of the given size.
    ///
    /// # Errors
    /// Returns the encoder's errors. It writes into memory and has none.
    pub fn next(
        &mut self,
        size: Size,
        draw: impl FnOnce(Rect, &mut Buffer),
    ) -> io::Result<Vec<u8>> {
        self.next_within(size, usize::MAX, draw)
    }

    /// Does the same as [`Self::next`] in about `most` bytes. If more are needed, the frame changes as many cells as
    /// fit, and the next frame continues from there.
    ///
    /// # Errors
    /// Returns the encoder's errors. It writes into memory and has none.
    pub fn next_within(
        &mut self,
        size: Size,
        most: usize,
        draw: impl FnOnce(Rect, &mut Buffer),
    ) -> io::Result<Vec<u8>> {
        self.next_with(size, most, |area, buffer| {
            draw(area, buffer);
            None
        })
    }

    /// Does the same as [`Self::next_within`], and leaves the terminal's cursor where `draw` places it.
    ///
    /// # Errors
    /// Returns the encoder's errors. It writes into memory and has none.
    pub fn next_with(
        &mut self,
        size: Size,
        most: usize,
        draw: impl FnOnce(Rect, &mut Buffer) -> Option<Position>,
    ) -> io::Result<Vec<u8>> {
        self.terminal.backend_mut().begin(size, most);
        if self.shown.is_none() {
            // `clear` would query the cursor's position.
            self.terminal.resize(Rect::from((Position::ORIGIN, size)))?;
        }
        let drawn = self.terminal.draw(|frame| {
            let area = frame.area();
            let cursor = draw(area, frame.buffer_mut());
            // Text of an untrusted file must not send control characters to the terminal, however it got into a cell.
            for cell in &mut frame.buffer_mut().content {
                if cell.symbol().chars().any(is_steering) {
                    cell.set_symbol(" ");
                }
            }
            if let Some(at) = cursor.filter(|at| area.contains(*at)) {
                frame.set_cursor_position(at);
            }
        })?;
        // The cells are copied into the memory of those before.
        let shown = self.shown.get_or_insert_default();
        shown.area = drawn.buffer.area;
        shown.content.clone_from(&drawn.buffer.content);
        Ok(self.terminal.backend_mut().take())
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use ratatui::style::{Color, Modifier, Style};

    use super::*;

    const SIZE: Size = Size { width: 12, height: 5 };

    /// Arbitrary cells: a symbol, colours, modifiers.
    fn cells() -> impl Strategy<Value = Vec<(usize, &'static str, Style)>> {
        let symbol = prop::sample::select(vec![" ", "a", "θ", "⣿", "░", "\u{1b}", "x\u{307}"]);
        let colour = prop::sample::select(vec![
            Color::Reset,
            Color::Red,
            Color::DarkGray,
            Color::Indexed(214),
            Color::Rgb(1, 2, 3),
        ]);
        // Only modifiers that the terminal emulator of the tests supports.
        let modifier = prop::sample::select(vec![
            Modifier::empty(),
            Modifier::BOLD,
            Modifier::DIM,
            Modifier::ITALIC,
            Modifier::UNDERLINED | Modifier::BOLD,
            Modifier::REVERSED,
        ]);
        let cell = (0..60_usize, symbol, colour.clone(), colour, modifier);
        prop::collection::vec(
            cell.prop_map(|(at, symbol, fg, bg, modifier)| {
                (at, symbol, Style::new().fg(fg).bg(bg).add_modifier(modifier))
            }),
            0..80,
        )
    }

    fn paint(cells: &[(usize, &'static str, Style)], area: Rect, buffer: &mut Buffer) {
        for &(at, symbol, style) in cells {
            let (x, y) = buffer.pos_of(at % usize::from(area.width * area.height));
            buffer[(x, y)].reset();
            buffer[(x, y)].set_symbol(symbol).set_style(style);
        }
    }

    fn colour(colour: Color) -> vt100::Color {
        match colour {
            Color::Red => vt100::Color::Idx(1),
            Color::DarkGray => vt100::Color::Idx(8),
            Color::Indexed(index) => vt100::Color::Idx(index),
            Color::Rgb(r, g, b) => vt100::Color::Rgb(r, g, b),
            _ => vt100::Color::Default,
        }
    }

    fn check(terminal: &vt100::Screen, drawn: &Buffer) {
        for y in 0..SIZE.height {
            for x in 0..SIZE.width {
                let (cell, shown) = (&drawn[(x, y)], terminal.cell(y, x).expect("inside"));
                let symbol = if cell.symbol() == "\u{1b}" { " " } else { cell.symbol() };
                let contents = if shown.has_contents() { shown.contents() } else { " " };
                assert_eq!(contents, symbol, "at {x}, {y}");
                assert_eq!(shown.bgcolor(), colour(cell.bg), "background at {x}, {y}");
                assert_eq!(shown.inverse(), cell.modifier.contains(Modifier::REVERSED));
                assert_eq!(shown.underline(), cell.modifier.contains(Modifier::UNDERLINED));
                if symbol != " " {
                    assert_eq!(shown.fgcolor(), colour(cell.fg), "foreground at {x}, {y}");
                    assert_eq!(shown.bold(), cell.modifier.contains(Modifier::BOLD));
                    assert_eq!(shown.dim(), cell.modifier.contains(Modifier::DIM));
                    assert_eq!(shown.italic(), cell.modifier.contains(Modifier::ITALIC));
                }
            }
        }
    }

    proptest! {
        #[test]
        fn frames_bring_the_terminal_to_what_was_drawn(
            pictures in prop::collection::vec((cells(), any::<bool>()), 1..6),
        ) {
            let mut terminal = vt100::Parser::new(SIZE.height, SIZE.width, 0);
            terminal.process("left by somebody else\r\n\x1b[7mso".as_bytes());
            let mut screen = Frames::new(true).expect("memory");
            prop_assert!(!pictures.is_empty());
            for (cells, forget) in pictures {
                if forget {
                    terminal.process(b"\x1b[41mthe terminal was resized");
                    screen.forget();
                }
                let mut drawn = Buffer::empty(Rect::from(SIZE));
                paint(&cells, drawn.area, &mut drawn);
                let bytes = screen.next(SIZE, |area, buffer| paint(&cells, area, buffer)).expect("bytes");
                terminal.process(&bytes);
                check(terminal.screen(), &drawn);
                let again = screen.next(SIZE, |area, buffer| paint(&cells, area, buffer)).expect("bytes");
                prop_assert_eq!(again, Vec::<u8>::new());
            }
        }
    }

    proptest! {
        #[test]
        fn what_has_no_room_in_a_frame_comes_with_the_next(
            pictures in prop::collection::vec((cells(), 1..60_usize), 1..6),
        ) {
            let mut terminal = vt100::Parser::new(SIZE.height, SIZE.width, 0);
            let mut screen = Frames::new(false).expect("memory");
            prop_assert!(!pictures.is_empty());
            for (cells, most) in pictures {
                let mut drawn = Buffer::empty(Rect::from(SIZE));
                paint(&cells, drawn.area, &mut drawn);
                // A picture has 60 cells, and each frame updates at least one of them.
                for _ in 0..=60 {
                    let paint = |area, buffer: &mut Buffer| paint(&cells, area, buffer);
                    let bytes = screen.next_within(SIZE, most, paint).expect("bytes");
                    // The allowance covers clearing the screen and one cell with its movement and colours.
                    prop_assert!(bytes.len() <= most + 64, "{} bytes for {most}", bytes.len());
                    terminal.process(&bytes);
                    if screen.is_current() {
                        break;
                    }
                }
                prop_assert!(screen.is_current());
                check(terminal.screen(), &drawn);
            }
        }
    }

    /// Over a slow line what can be read comes first, wherever it stands.
    #[test]
    fn letters_come_before_pictures() {
        let paint = |area: Rect, buffer: &mut Buffer| {
            for y in 0..area.height - 1 {
                buffer.set_string(0, y, "⣿".repeat(area.width.into()), Style::new());
            }
            buffer.set_string(0, area.height - 1, "t 1.5", Style::new());
        };
        let mut screen = Frames::new(false).expect("memory");
        let first = screen.next_within(SIZE, 40, paint).expect("bytes");
        let first = String::from_utf8(first).expect("text");
        let letters = first.find("1.5").expect("the letters");
        assert!(first.find('⣿').is_none_or(|dots| dots > letters), "{first:?}");
        // and those that change meanwhile come before the rest of the picture
        let next = screen.next_within(SIZE, 40, |area, buffer: &mut Buffer| {
            paint(area, buffer);
            buffer.set_string(0, area.height - 1, "t 1.6", Style::new());
        });
        let next = String::from_utf8(next.expect("bytes")).expect("text");
        let letters = next.find('6').expect("the digit");
        assert!(next.find('⣿').is_some_and(|dots| dots > letters), "{next:?}");
    }

    #[test]
    fn the_cursor_is_left_where_it_belongs() {
        let mut screen = Frames::new(true).expect("memory");
        let mut terminal = vt100::Parser::new(SIZE.height, SIZE.width, 0);
        for (text, cursor) in
            [("a", (3, 2)), ("ab", (3, 2)), ("ab", (4, 2)), ("ab", (4, 2)), ("", (0, 0))]
        {
            let bytes = screen.next_with(SIZE, usize::MAX, |area, buffer| {
                buffer.set_string(area.x, 1, text, Style::new());
                Some(Position::from(cursor))
            });
            let bytes = bytes.expect("bytes");
            terminal.process(&bytes);
            assert_eq!(terminal.screen().cursor_position(), (cursor.1, cursor.0), "{text}");
            assert_eq!(screen.cursor(), Some(Position::from(cursor)));
        }
        let again = screen.next_with(SIZE, usize::MAX, |_, _| Some(Position::new(0, 0)));
        let again = again.expect("bytes");
        assert!(again.is_empty(), "nothing is sent where nothing changes: {again:?}");
        let outside = screen.next_with(SIZE, usize::MAX, |_, _| Some(Position::new(SIZE.width, 0)));
        assert!(outside.expect("bytes").is_empty() && screen.cursor().is_none());
    }

    #[test]
    fn a_frame_is_marked_and_small() {
        let mut screen = Frames::new(true).expect("memory");
        let mut frame = |text: &str, style: Style| {
            let bytes = screen.next(SIZE, |area, buffer| {
                buffer.set_string(area.x, 1, text, style);
            });
            String::from_utf8(bytes.expect("bytes")).expect("text")
        };
        let plain = Style::new();
        assert_eq!(frame("12:30", plain), "\x1b[?2026h\x1b[0m\x1b[2J\x1b[2H12:30\x1b[?2026l");
        assert_eq!(frame("12:31", plain), "\x1b[?2026h\x081\x1b[?2026l");
        assert_eq!(frame("12:31", plain), "");
    }

    /// To move the cursor takes fewer bytes than to change a colour.
    #[test]
    fn cells_of_one_colour_are_written_together() {
        let mut screen = Frames::new(false).expect("memory");
        let mut frame = |symbol: &str| {
            let bytes = screen.next(SIZE, |area, buffer| {
                for x in 0..area.width {
                    let colour = Color::Rgb(100, 100, 100 + x as u8 % 2);
                    buffer.set_string(x, 2, symbol, Style::new().fg(colour));
                }
            });
            String::from_utf8(bytes.expect("bytes")).expect("text")
        };
        frame("a");
        assert_eq!(frame("b").matches("38;2;").count(), 1);
        assert_eq!(frame("c").matches('c').count(), usize::from(SIZE.width));
    }

    #[test]
    fn every_size_is_drawn() {
        let mut screen = Frames::new(false).expect("memory");
        for (width, height) in [(0, 0), (1, 1), (500, 500), (0, 9), (9, 0), (80, 24)] {
            let bytes = screen.next(Size { width, height }, |area, buffer| {
                assert_eq!(buffer.area, area);
            });
            let bytes = bytes.expect("bytes");
            assert!(width == 0 || height == 0 || !bytes.is_empty());
        }
    }
}
