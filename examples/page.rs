//! A page of one's own in phaselab's shell: a clock that runs until it is reported otherwise.
//!
//! `cargo run --example page`, then: Space holds it, `f` fills the screen with its digits, `i` opens a line of text, `M` has the mouse reported, `z` suspends, `p` panics, `t` panics on
//! another thread, `q` quits. The tests of the shell run it on a pseudo-terminal.

use std::io::{Write, stderr};
use std::process::ExitCode;
use std::thread;
use std::time::Duration;

use color_eyre::eyre::Result;
use phaselab::app::{Code, Key, Mouse};
use phaselab::shell::{
    Ending, Input, LabError, Pace, Screen, ScreenRequest, perform, report_panics,
};
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::{Color, Modifier, Style};

#[derive(Default)]
struct Clock {
    time: Duration,
    held: bool,
    full: bool,
    mouse: bool,
    typing: Option<String>,
    inputs: usize,
    size: (u16, u16),
}

impl Clock {
    fn typed(&mut self, key: Key) {
        match (&mut self.typing, key.code) {
            (_, Code::Esc | Code::Enter) => self.typing = None,
            (Some(text), Code::Char(character)) => text.push(character),
            _ => {}
        }
    }
}

impl Screen for Clock {
    fn input(&mut self, input: Input) -> ScreenRequest {
        self.inputs += 1;
        match input {
            Input::Key(key) if self.typing.is_some() => self.typed(key),
            Input::Key(key) if key == Key::char('q') => return ScreenRequest::Quit,
            Input::Key(key) if key == Key::char('z') => return ScreenRequest::Suspend,
            Input::Key(key) if key == Key::char('l') => return ScreenRequest::Repaint,
            Input::Key(key) if key == Key::char(' ') => self.held = !self.held,
            Input::Key(key) if key == Key::char('f') => self.full = !self.full,
            Input::Key(key) if key == Key::char('i') => self.typing = Some(String::new()),
            Input::Key(key) if key == Key::char('p') => panic!("the clock fell off the wall"),
            Input::Key(key) if key == Key::char('t') => {
                let broken = thread::spawn(|| panic!("somebody else's clock")).join();
                self.typing = Some(format!("caught: {}", broken.is_err()));
            }
            Input::Paste(text) => self.typing = Some(text),
            Input::Key(key) if key == Key::char('M') => {
                self.mouse = !self.mouse;
                return ScreenRequest::Mouse(self.mouse);
            }
            Input::Mouse(Mouse { column, row, act }) => {
                self.typing = Some(format!("{act:?} {column} {row}"));
            }
            Input::Resize(columns, rows) => self.size = (columns, rows),
            Input::Key(_) | Input::Focus(_) => {}
        }
        ScreenRequest::Nothing
    }

    fn advance(&mut self, elapsed: Duration) -> bool {
        if !self.held {
            self.time += elapsed;
        }
        !self.held
    }

    fn draw(&mut self, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        if self.full {
            for (place, cell) in buffer.content.iter_mut().enumerate() {
                let digit = (self.time.as_millis() as usize + place) % 10;
                cell.set_char(char::from(b'0' + digit as u8));
            }
        }
        let lines = [
            format!("clock {:.3}", self.time.as_secs_f64()),
            format!("inputs {}", self.inputs),
            format!("size {}x{}", self.size.0, self.size.1),
            self.typing.as_ref().map_or(String::new(), |text| format!("text [{text}]")),
        ];
        let styles = [
            Style::new().fg(Color::Indexed(214)).add_modifier(Modifier::BOLD),
            Style::new(),
            Style::new().fg(Color::Cyan),
            Style::new().add_modifier(Modifier::REVERSED),
        ];
        for ((y, line), style) in (area.y..area.bottom()).zip(lines).zip(styles) {
            buffer.set_stringn(area.x, y, line, area.width.into(), style);
        }
        // The last cell of all shows that the whole screen is reached.
        if let Some(cell) =
            buffer.cell_mut((area.right().wrapping_sub(1), area.bottom().wrapping_sub(1)))
        {
            cell.set_symbol("#");
        }
        // The terminal's cursor stands in the line of text, and nowhere else.
        let long = self.typing.as_ref()?.chars().count() as u16;
        Some(Position::new(6 + long, 3))
    }

    fn is_typing(&self) -> bool {
        self.typing.is_some()
    }
}

fn main() -> Result<ExitCode> {
    report_panics()?;
    match perform(
        &mut Clock::default(),
        Pace { frames: 30, bytes: None, synchronized: true, mouse: false },
    ) {
        Ok(Ending::Quit) => Ok(ExitCode::SUCCESS),
        Ok(Ending::Gone) => Ok(ExitCode::from(129)),
        Ok(Ending::Signal(number)) => Ok(ExitCode::from(128 + number as u8)),
        Err(LabError::TerminalError(why)) => {
            writeln!(stderr(), "{why}")?;
            Ok(ExitCode::from(2))
        }
        Err(error) => Err(error.into()),
    }
}
