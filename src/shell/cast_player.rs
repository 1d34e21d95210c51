//! The cast player: shows a cast on the terminal, at its own speed or another.
//!
//! In: a [`RecordedCast`], or one that is still being recorded, keys, time. Out: cells. A cast may be an untrusted file, so its output goes to a
//! terminal in memory, and only characters and colours leave that terminal. Its processing time per frame is
//! limited, so that no cast blocks the keys. Never here: files, or the format of a cast.

use std::time::{Duration, Instant};

use crossterm::event::{Event, KeyCode, KeyEvent, KeyModifiers};
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect, Size};

use super::cast_screen::draw_screen;
use super::frame_loop::{Screen, ScreenRequest};
use super::recording_ahead::{NotRecorded, RecordingAhead};
use crate::record::{CastEvent, CastTheme, RecordedCast, Recording};
use crate::view::RenderStyle;
use crate::view::colour::Rgb;
use crate::view::theme::Role;

/// A cast being shown.
pub struct CastPlayer {
    cast: RecordedCast,
    /// Where the rest of the cast comes from while it is still being recorded.
    ahead: Option<RecordingAhead>,
    recorded: Option<Result<Recording, NotRecorded>>,
    style: RenderStyle,
    screen: avt::Vt,
    /// The index of the next event, and how many bytes of it have been written.
    next: (usize, usize),
    /// The time in the cast, in microseconds.
    time: f64,
    /// An index into [`SPEEDS`].
    speed: usize,
    paused: bool,
    /// Whether the end is to be shown, which is not recorded yet.
    to_end: bool,
    /// Whether the user has shown or hidden the control line, if so.
    wanted: Option<bool>,
    /// How much longer the control line is shown by default.
    awake: Duration,
    /// The size of the window.
    size: Size,
    /// The parts of the control line that change by themselves: the second, the last second, whether the cast is over,
    /// whether the line is shown.
    shown: (u64, u64, bool, bool),
}

/// How long the control line covers the last row after a key, and at the start.
const AWAKE: Duration = Duration::from_secs(3);
const AT_FIRST: Duration = Duration::from_secs(5);

/// Seconds of the cast per second.
const SPEEDS: [f64; 9] = [0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 64.0];

/// The index of the cast's own speed.
const NORMAL: usize = 3;

/// The time that a frame may spend on the cast, and the number of characters written between two checks of it.
const SPENT: Duration = Duration::from_millis(15);
const CHARACTERS: usize = 64;

/// Within this many microseconds of a chapter's start, going back leads to the previous chapter.
const AT_ONCE: f64 = 1e6;

/// How far the arrow keys seek, in microseconds.
const LEAP: f64 = 5e6;

impl CastPlayer {
    /// Creates a player at the start of a cast.
    pub fn new(cast: RecordedCast, style: RenderStyle) -> Self {
        let screen = blank(cast.size);
        Self {
            cast,
            ahead: None,
            recorded: None,
            style,
            screen,
            next: (0, 0),
            time: 0.0,
            speed: NORMAL,
            paused: false,
            to_end: false,
            wanted: None,
            awake: AT_FIRST,
            size: Size::default(),
            shown: (0, 0, false, true),
        }
    }

    /// Creates a player at the start of a cast that is still being recorded.
    pub fn following(ahead: RecordingAhead, style: RenderStyle) -> Self {
        let cast = RecordedCast {
            title: None,
            size: ahead.size,
            theme: CastTheme::default(),
            events: Vec::new(),
            end: 0,
        };
        Self { ahead: Some(ahead), ..Self::new(cast, style) }
    }

    /// Returns how the recording of the cast ended, or how far it came, if it was recorded meanwhile.
    pub fn recorded(self) -> Option<Result<Recording, NotRecorded>> {
        self.recorded.or_else(|| self.ahead.map(RecordingAhead::left))
    }

    /// Takes over what has been recorded since the last frame.
    fn follow(&mut self) {
        let Some(ahead) = &mut self.ahead else { return };
        let (new, ended) = ahead.take();
        for part in new {
            self.cast.events.extend(part.events);
            self.cast.end = part.reached;
        }
        if ended.is_some() {
            (self.recorded, self.ahead) = (ended, None);
        }
        if self.to_end {
            self.go(self.cast.end as f64);
            self.to_end = self.ahead.is_some();
        }
    }

    /// Whether there is a free row of the window below the cast's screen.
    fn has_room(&self) -> bool {
        usize::from(self.size.height) > self.screen.size().1
    }

    fn shows_controls(&self) -> bool {
        let by_itself = self.has_room() || self.paused || self.is_over() || !self.awake.is_zero();
        self.wanted.unwrap_or(by_itself)
    }

    /// Returns a warning if the window does not show the whole cast.
    fn cut_off(&self) -> Option<String> {
        let (columns, rows) = self.screen.size();
        let Size { width, height } = self.size;
        let cut = columns > usize::from(width) || rows > usize::from(height);
        cut.then(|| {
            format!(
                "the cast is {columns}×{rows}, the window {width}×{height}: \
                 enlarge it, or use a smaller font"
            )
        })
    }

    /// Whether the cast is over.
    pub fn is_over(&self) -> bool {
        let at_end = self.next.0 == self.cast.events.len() && self.time >= self.cast.end as f64;
        at_end && self.ahead.is_none()
    }

    /// Seeks to a time; seeking backwards replays the cast from the start.
    fn go(&mut self, time: f64) {
        let time = time.clamp(0.0, self.cast.end as f64);
        if time < self.time {
            self.screen = blank(self.cast.size);
            self.next = (0, 0);
        }
        self.time = time;
    }

    /// Advances to the next event and pauses there.
    fn step(&mut self) {
        self.paused = true;
        let later = |(time, _): &&(u64, CastEvent)| *time as f64 > self.time;
        let next = self.cast.events.iter().find(later).map(|(time, _)| *time as f64);
        self.go(next.unwrap_or(self.cast.end as f64));
    }

    /// Returns the chapters, ordered by time.
    fn chapters(&self) -> impl DoubleEndedIterator<Item = (f64, &str)> {
        self.cast.events.iter().filter_map(|(time, event)| match event {
            CastEvent::Marker(name) => Some((*time as f64, name.as_str())),
            _ => None,
        })
    }

    fn press(&mut self, key: KeyEvent) -> ScreenRequest {
        let shown = self.shows_controls();
        self.awake = self.awake.max(AWAKE);
        self.to_end = false;
        let ctrl = key.modifiers.contains(KeyModifiers::CONTROL);
        match key.code {
            KeyCode::Char(c) if ctrl => match c {
                'c' => return ScreenRequest::Quit,
                'z' => return ScreenRequest::Suspend,
                'l' => return ScreenRequest::Repaint,
                _ => {}
            },
            code => match code {
                KeyCode::Char('q') | KeyCode::Esc => return ScreenRequest::Quit,
                KeyCode::Char(' ' | 'p') if self.is_over() => self.go(0.0),
                KeyCode::Char(' ' | 'p') => self.paused = !self.paused,
                KeyCode::Char('.') => self.step(),
                KeyCode::Char('c') => self.wanted = Some(!shown),
                KeyCode::Char('[') => self.speed = self.speed.saturating_sub(1),
                KeyCode::Char(']') => self.speed = (self.speed + 1).min(SPEEDS.len() - 1),
                KeyCode::Left | KeyCode::Char('h') => self.go(self.time - LEAP),
                KeyCode::Right | KeyCode::Char('l') => self.go(self.time + LEAP),
                KeyCode::Home | KeyCode::Char('0') => self.go(0.0),
                KeyCode::End => {
                    self.go(self.cast.end as f64);
                    self.to_end = self.ahead.is_some();
                }
                KeyCode::Tab | KeyCode::BackTab => {
                    let to = if code == KeyCode::BackTab {
                        // Shortly after a chapter's start, go to the previous one.
                        let before = self.time - AT_ONCE;
                        let found = self.chapters().rfind(|(time, _)| *time < before);
                        Some(found.map_or(0.0, |(time, _)| time))
                    } else {
                        let found = self.chapters().find(|(time, _)| *time > self.time);
                        found.map(|(time, _)| time)
                    };
                    if let Some(time) = to {
                        self.go(time);
                    }
                }
                _ => {}
            },
        }
        ScreenRequest::Nothing
    }

    /// Writes the events that are due to the terminal in memory, within the time limit of a frame. Returns whether
    /// anything was written.
    fn write(&mut self) -> bool {
        let began = Instant::now();
        let mut written = false;
        while let Some((time, event)) = self.cast.events.get(self.next.0) {
            if *time as f64 > self.time {
                break;
            }
            match event {
                CastEvent::Output(text) => {
                    let rest = &text[self.next.1..];
                    let end = rest.char_indices().nth(CHARACTERS).map_or(rest.len(), |(at, _)| at);
                    self.screen.feed_str(&rest[..end]);
                    written = true;
                    if end < rest.len() {
                        self.next.1 += end;
                        if began.elapsed() > SPENT {
                            return true;
                        }
                        continue;
                    }
                }
                CastEvent::Resize(columns, rows) => {
                    self.screen.resize(wide(*columns), (*rows).into());
                    written = true;
                }
                CastEvent::Marker(_) => {}
            }
            self.next = (self.next.0 + 1, 0);
            if began.elapsed() > SPENT {
                return true;
            }
        }
        written
    }

    /// Draws the control line: the time in the cast, then the keys, the most important first.
    fn draw_controls(&self, row: Rect, buffer: &mut Buffer) {
        let glyphs = self.style.glyphs;
        let (sign, role) = match (self.is_over(), self.paused) {
            (true, _) => (glyphs.pick("■", "#"), Role::Dim),
            (_, true) => (glyphs.pick("‖", "="), Role::Warn),
            _ => (glyphs.pick("▶", ">"), Role::Good),
        };
        let chapter = self.chapters().rfind(|(time, _)| *time <= self.time);
        let chapter = chapter.map_or(String::new(), |(_, name)| format!("  {name}"));
        let so_far = if self.ahead.is_some() { " so far" } else { "" };
        let pieces = [
            (role, format!("{sign} ")),
            (Role::Accent, clock(self.time)),
            (Role::Dim, format!(" of {}{so_far}  ", clock(self.cast.end as f64))),
            (Role::Text, format!("×{}{chapter}", SPEEDS[self.speed])),
        ];
        let (pause, rest) = if self.is_over() { ("again", "") } else { ("pause", "  . step") };
        let keys = [
            format!("space {pause}  q quit"),
            "← → 5 s".to_owned(),
            "[ ] speed".to_owned(),
            "Tab S-Tab chapter".to_owned(),
            "c hide".to_owned(),
            format!("Home{rest}"),
        ];
        let mut x = self.write_over(row, &pieces, buffer);
        for key in keys {
            let piece = [(Role::Dim, format!("   {key}"))];
            let wide = piece[0].1.chars().count() as u16;
            if x + wide > row.right() {
                break;
            }
            x = self.write_on(x, row, &piece, buffer);
        }
    }

    /// Writes pieces over a cleared row. Returns the column after them.
    fn write_over(&self, row: Rect, pieces: &[(Role, String)], buffer: &mut Buffer) -> u16 {
        for x in row.left()..row.right() {
            buffer[(x, row.y)].reset();
        }
        self.write_on(row.x + 1, row, pieces, buffer)
    }

    fn write_on(
        &self,
        mut x: u16,
        row: Rect,
        pieces: &[(Role, String)],
        buffer: &mut Buffer,
    ) -> u16 {
        for (role, text) in pieces {
            if x >= row.right() {
                break;
            }
            let room = usize::from(row.right() - x);
            let text = self.style.glyphs.text(text);
            x = buffer.set_stringn(x, row.y, &text, room, self.style.theme[*role]).0;
        }
        x
    }
}

impl Screen for CastPlayer {
    fn background(&mut self, colour: Rgb) {
        self.style = self.style.on(colour);
    }

    fn input(&mut self, event: Event) -> ScreenRequest {
        match event {
            Event::Key(key) => self.press(key),
            // The window may no longer show the whole cast.
            Event::Resize(..) => {
                self.awake = self.awake.max(AWAKE);
                ScreenRequest::Nothing
            }
            _ => ScreenRequest::Nothing,
        }
    }

    fn advance(&mut self, elapsed: Duration) -> bool {
        self.follow();
        // All events up to the current time must be written before time advances.
        let behind =
            self.cast.events.get(self.next.0).is_some_and(|(t, _)| (*t as f64) < self.time);
        if !self.paused && !behind {
            let passed = elapsed.as_secs_f64() * 1e6 * SPEEDS[self.speed];
            self.time = (self.time + passed).min(self.cast.end as f64);
        }
        let written = self.write();
        self.awake = self.awake.saturating_sub(elapsed);
        let (second, last) = ((self.time / 1e6) as u64, self.cast.end / 1_000_000);
        let shown = (second, last, self.is_over(), self.shows_controls());
        let changed = written || shown != self.shown;
        self.shown = shown;
        changed
    }

    fn draw(&mut self, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        self.size = area.as_size();
        draw_screen(&self.screen, &self.style, area, buffer);
        if area.height > 0 && self.shows_controls() {
            let rows = self.screen.size().1;
            let y = if self.has_room() { area.y + rows as u16 } else { area.bottom() - 1 };
            self.draw_controls(Rect { y, height: 1, ..area }, buffer);
            if let Some(sentence) = self.cut_off().filter(|_| y > area.y) {
                let row = Rect { y: y - 1, height: 1, ..area };
                self.write_over(row, &[(Role::Warn, sentence)], buffer);
            }
        }
        None
    }

    fn is_typing(&self) -> bool {
        false
    }

    /// Nothing more comes of a script that is wrong.
    fn is_done(&self) -> bool {
        matches!(self.recorded, Some(Err(_)))
    }
}

fn blank((columns, rows): (u16, u16)) -> avt::Vt {
    avt::Vt::builder().size(wide(columns), rows.into()).scrollback_limit(0).build()
}

/// Returns at least two columns, since the terminal in memory has no room for a wide character in one.
fn wide(columns: u16) -> usize {
    columns.max(2).into()
}

/// Formats a time as `1:05`.
fn clock(time: f64) -> String {
    let seconds = (time / 1e6) as u64;
    format!("{}:{:02}", seconds / 60, seconds % 60)
}
