//! A custom page in phaselab's shell: a clock that runs until it is paused.
//!
//! Run `cargo run --example page`. Space pauses the clock, `f` fills the screen with its digits, `i` opens a line of
//! text, `M` turns on mouse reporting, `z` suspends, `p` panics, `t` panics on another thread, and `q` quits. The tests
//! of the shell run it on a pseudo-terminal. With `KEYBOARD` in its environment it asks for the keyboard protocol of kitty.

use std::io::{Write, stderr};
use std::process::ExitCode;
use std::thread;
use std::time::Duration;

use color_eyre::eyre::Result;
use crossterm::event::{Event, KeyCode};
use phaselab::shell::{
    Ending, FramePace, LabError, Questions, Screen, ScreenRequest, report_panics, run_screen,
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
    fn typed(&mut self, code: KeyCode) {
        match (&mut self.typing, code) {
            (_, KeyCode::Esc | KeyCode::Enter) => self.typing = None,
            (Some(text), KeyCode::Char(character)) => text.push(character),
            _ => {}
        }
    }
}

impl Screen for Clock {
    fn input(&mut self, event: Event) -> ScreenRequest {
        self.inputs += 1;
        match event {
            Event::Key(key) if self.typing.is_some() => self.typed(key.code),
            Event::Key(key) => match key.code {
                KeyCode::Char('q') => return ScreenRequest::Quit,
                KeyCode::Char('z') => return ScreenRequest::Suspend,
                KeyCode::Char('l') => return ScreenRequest::Repaint,
                KeyCode::Char(' ') => self.held = !self.held,
                KeyCode::Char('f') => self.full = !self.full,
                KeyCode::Char('i') => self.typing = Some(String::new()),
                KeyCode::Char('p') => panic!("the clock fell off the wall"),
                KeyCode::Char('t') => {
                    let broken = thread::spawn(|| panic!("somebody else's clock")).join();
                    self.typing = Some(format!("caught: {}", broken.is_err()));
                }
                KeyCode::Char('M') => {
                    self.mouse = !self.mouse;
                    return ScreenRequest::Mouse(self.mouse);
                }
                _ => {}
            },
            Event::Paste(text) => self.typing = Some(text),
            Event::Mouse(mouse) => {
                self.typing = Some(format!("{:?} {} {}", mouse.kind, mouse.column, mouse.row));
            }
            Event::Resize(columns, rows) => self.size = (columns, rows),
            Event::FocusGained | Event::FocusLost => {}
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
        // The last cell shows that the whole screen is drawn.
        if let Some(cell) =
            buffer.cell_mut((area.right().wrapping_sub(1), area.bottom().wrapping_sub(1)))
        {
            cell.set_symbol("#");
        }
        // The terminal's cursor is shown only in the line of text.
        let long = self.typing.as_ref()?.chars().count() as u16;
        Some(Position::new(6 + long, 3))
    }

    fn is_typing(&self) -> bool {
        self.typing.is_some()
    }
}

fn main() -> Result<ExitCode> {
    report_panics()?;
    match run_screen(
        &mut Clock::default(),
        FramePace {
            frames: 30,
            bytes: None,
            synchronized: true,
            mouse: false,
            asks: Questions { background: false, keyboard: std::env::var_os("KEYBOARD").is_some() },
        },
    ) {
        Ok(Ending::Quit) => Ok(ExitCode::SUCCESS),
        Ok(Ending::HungUp) => Ok(ExitCode::from(129)),
        Ok(Ending::Signal(number)) => Ok(ExitCode::from(128 + number as u8)),
        Err(LabError::TerminalError(why)) => {
            writeln!(stderr(), "{why}")?;
            Ok(ExitCode::from(2))
        }
        Err(error) => Err(error.into()),
    }
}
