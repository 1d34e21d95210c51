//! Frames: what a terminal shows, and the bytes from there to the next picture.
//!
//! In: a function that draws. Out: a frame of bytes, between the marks of synchronized output, or nothing if no cell
//! has changed. Never here: sending them, or when to draw.

mod pen;

use std::mem;

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect, Size};

use pen::Pen;

use crate::printable::is_steering;

/// The marks round a frame, between which a terminal holds back what it shows.
const SYNCHRONIZED: [&[u8]; 2] = [b"\x1b[?2026h", b"\x1b[?2026l"];

/// The picture on a terminal, and the way to the next one.
#[derive(Debug)]
pub struct Frames {
    shown: Option<Buffer>,
    next: Buffer,
    pen: Pen,
    /// The row in which the next frame begins, where the last had not room for all.
    rest: Option<u16>,
    synchronized: bool,
    cursor: Option<Position>,
}

impl Frames {
    /// A terminal that shows nobody knows what; `synchronized` puts the marks round each frame.
    pub fn new(synchronized: bool) -> Self {
        let (next, pen) = (Buffer::default(), Pen::default());
        Self { shown: None, next, pen, rest: None, synchronized, cursor: None }
    }

    /// What the terminal shows is no longer known: the next frame paints every cell.
    pub fn forget(&mut self) {
        self.shown = None;
    }

    /// Whether the terminal shows what was drawn last, as far as is known.
    pub fn is_current(&self) -> bool {
        self.shown.is_some() && self.rest.is_none()
    }

    /// What the terminal shows, where that is known.
    pub fn shown(&self) -> Option<&Buffer> {
        self.shown.as_ref()
    }

    /// Where the terminal's cursor was left, if it is to be seen there.
    pub fn cursor(&self) -> Option<Position> {
        self.cursor
    }

    /// The bytes that turn what is shown into what `draw` draws on a blank area of that size.
    pub fn next(&mut self, size: Size, draw: impl FnOnce(Rect, &mut Buffer)) -> Vec<u8> {
        self.next_within(size, usize::MAX, draw)
    }

    /// The same in about so many bytes at most: where there would be more, the frame turns as many cells into what is
    /// drawn as it has room for, and the frame after it goes on from there.
    pub fn next_within(
        &mut self,
        size: Size,
        most: usize,
        draw: impl FnOnce(Rect, &mut Buffer),
    ) -> Vec<u8> {
        self.next_with(size, most, |area, buffer| {
            draw(area, buffer);
            None
        })
    }

    /// The same, with the terminal's cursor left where `draw` says that it belongs.
    pub fn next_with(
        &mut self,
        size: Size,
        most: usize,
        draw: impl FnOnce(Rect, &mut Buffer) -> Option<Position>,
    ) -> Vec<u8> {
        let area = Rect::new(0, 0, size.width, size.height);
        self.next.resize(area);
        self.next.reset();
        let cursor = draw(area, &mut self.next).filter(|at| area.contains(*at));
        // A stranger's file must not speak to the terminal, whichever way its text got into a cell.
        for cell in &mut self.next.content {
            if cell.symbol().chars().any(is_steering) {
                cell.set_symbol(" ");
            }
        }

        let mut out = Vec::new();
        if self.synchronized {
            out.extend(SYNCHRONIZED[0]);
        }
        let empty = out.len();
        let shown = self.shown.take().filter(|shown| shown.area == area).unwrap_or_else(|| {
            self.pen.clear(&mut out);
            Buffer::empty(area)
        });
        let changed: Vec<_> = shown.diff_iter(&self.next).map(|(x, y, _)| (x, y)).collect();
        let start = changed.partition_point(|(_, y)| Some(*y) < self.rest);
        self.rest = None;
        for at in changed[start..].iter().chain(&changed[..start]).copied() {
            if self.rest.is_none() && out.len() >= most {
                self.rest = Some(at.1);
            }
            if self.rest.is_none() {
                self.pen.put(&mut out, at, &self.next[at], area.width);
            } else {
                self.next[at] = shown[at].clone();
            }
        }
        self.shown = Some(mem::replace(&mut self.next, shown));
        if let Some(at) = cursor {
            self.pen.rest(&mut out, (at.x, at.y));
        }
        self.cursor = cursor;
        if out.len() == empty {
            return Vec::new();
        }
        if self.synchronized {
            out.extend(SYNCHRONIZED[1]);
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use ratatui::style::{Color, Modifier, Style};

    use super::*;

    const SIZE: Size = Size { width: 12, height: 5 };

    /// What a cell may look like: a symbol, colours, modifiers.
    fn cells() -> impl Strategy<Value = Vec<(usize, &'static str, Style)>> {
        let symbol = prop::sample::select(vec![" ", "a", "θ", "⣿", "░", "\u{1b}", "x\u{307}"]);
        let colour = prop::sample::select(vec![
            Color::Reset,
            Color::Red,
            Color::DarkGray,
            Color::Indexed(214),
            Color::Rgb(1, 2, 3),
        ]);
        // The terminal of the tests knows these.
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

    /// Whether a terminal shows what was drawn.
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
            let mut screen = Frames::new(true);
            for (cells, forget) in pictures {
                if forget {
                    terminal.process(b"\x1b[41mthe terminal was resized");
                    screen.forget();
                }
                let mut drawn = Buffer::empty(Rect::from(SIZE));
                paint(&cells, drawn.area, &mut drawn);
                let bytes = screen.next(SIZE, |area, buffer| paint(&cells, area, buffer));
                terminal.process(&bytes);
                check(terminal.screen(), &drawn);
                let again = screen.next(SIZE, |area, buffer| paint(&cells, area, buffer));
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
            let mut screen = Frames::new(false);
            for (cells, most) in pictures {
                let mut drawn = Buffer::empty(Rect::from(SIZE));
                paint(&cells, drawn.area, &mut drawn);
                // A picture has 60 cells, and each frame brings at least one of them.
                for _ in 0..=60 {
                    let paint = |area, buffer: &mut Buffer| paint(&cells, area, buffer);
                    let bytes = screen.next_within(SIZE, most, paint);
                    // The clearing before and one cell with its way and its colours.
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

    #[test]
    fn the_cursor_is_left_where_it_belongs() {
        let mut screen = Frames::new(true);
        let mut terminal = vt100::Parser::new(SIZE.height, SIZE.width, 0);
        for (text, cursor) in
            [("a", (3, 2)), ("ab", (3, 2)), ("ab", (4, 2)), ("ab", (4, 2)), ("", (0, 0))]
        {
            let bytes = screen.next_with(SIZE, usize::MAX, |area, buffer| {
                buffer.set_string(area.x, 1, text, Style::new());
                Some(Position::from(cursor))
            });
            terminal.process(&bytes);
            assert_eq!(terminal.screen().cursor_position(), (cursor.1, cursor.0), "{text}");
            assert_eq!(screen.cursor(), Some(Position::from(cursor)));
        }
        let again = screen.next_with(SIZE, usize::MAX, |_, _| Some(Position::new(0, 0)));
        assert!(again.is_empty(), "nothing is sent where nothing changes: {again:?}");
        let outside = screen.next_with(SIZE, usize::MAX, |_, _| Some(Position::new(SIZE.width, 0)));
        assert!(outside.is_empty() && screen.cursor().is_none());
    }

    #[test]
    fn a_frame_is_marked_and_small() {
        let mut screen = Frames::new(true);
        let mut frame = |text: &str, style: Style| {
            let bytes = screen.next(SIZE, |area, buffer| {
                buffer.set_string(area.x, 1, text, style);
            });
            String::from_utf8(bytes).expect("text")
        };
        let plain = Style::new();
        assert_eq!(frame("12:30", plain), "\x1b[?2026h\x1b[0m\x1b[2J\x1b[2H12:30\x1b[?2026l");
        assert_eq!(frame("12:31", plain), "\x1b[?2026h\x081\x1b[?2026l");
        assert_eq!(frame("12:31", plain), "");
    }

    #[test]
    fn no_size_is_too_strange() {
        let mut screen = Frames::new(false);
        for (width, height) in [(0, 0), (1, 1), (500, 500), (0, 9), (9, 0), (80, 24)] {
            screen.next(Size { width, height }, |area, buffer| {
                assert_eq!(buffer.area, area);
            });
        }
    }
}
