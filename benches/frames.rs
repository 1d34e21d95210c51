//! The number of bytes in frames: `view::frame` compared with ratatui's `CrosstermBackend` alone.
//!
//! `cargo bench --bench frames` prints a line for each system and each depth of colour: the mean bytes of a frame in ten
//! seconds of motion at 80 × 24, thirty frames a second, after the first two seconds.

#![allow(clippy::print_stdout, reason = "a benchmark reports on the terminal")]

use std::sync::Arc;
use std::time::Duration;

use phaselab::app::{App, Event, Loaded};
use phaselab::experiment::{Experiment, Prepared};
use phaselab::preset::Catalog;
use phaselab::view::colour::ColourDepth;
use phaselab::view::frame::Frames;
use phaselab::view::glyphs::Glyphs;
use phaselab::view::theme::Theme;
use phaselab::view::{self, RenderStyle};
use ratatui::backend::{Backend, CrosstermBackend};
use ratatui::buffer::Buffer;
use ratatui::layout::{Rect, Size};

const SIZE: Size = Size { width: 80, height: 24 };
const FIRST: u32 = 60;
const COUNT: u32 = 300;

/// A system in motion that is drawn.
struct Motion {
    app: App,
    experiment: Experiment,
    look: RenderStyle,
}

impl Motion {
    fn of(name: &str, depth: ColourDepth) -> Self {
        let catalog = Catalog::with_folder(None);
        let document = catalog.find(name).expect("a shipped preset");
        let Prepared { document, model, equations, system, mut experiment } =
            Prepared::of(&document).expect("a preset without mistakes");
        experiment.set_epoch(1);
        let name = name.to_owned();
        let (mut app, _) = App::new(&catalog, Some(&name));
        let loaded = Loaded { name, epoch: 1, document, model, equations, system };
        app.update(Event::Loaded(Ok(loaded)));
        let look = RenderStyle { theme: Theme::dark(depth), glyphs: Glyphs::Braille };
        Self { app, experiment, look }
    }

    fn picture(&mut self, frame: u32) -> Buffer {
        let time = f64::from(frame) / 30.0 * self.experiment.speed();
        self.experiment.advance(time, u64::MAX);
        self.app.update(Event::Tick(Duration::from_secs(1) / 30));
        self.app.update(Event::Snapshot(Arc::new(self.experiment.snapshot())));
        let area = Rect::from((ratatui::layout::Position::ORIGIN, SIZE));
        let mut buffer = Buffer::empty(area);
        view::draw(&self.app, &self.look, area, &mut buffer);
        buffer
    }
}

/// The mean bytes of a frame: crossterm's, and those of `view::frame`.
fn bytes(name: &str, depth: ColourDepth) -> (f64, f64) {
    let mut motion = Motion::of(name, depth);
    let mut frames = Frames::new(false).expect("memory");
    let mut shown = motion.picture(0);
    let (mut plain, mut frugal) = (0, 0);
    for frame in 1..FIRST + COUNT {
        let picture = motion.picture(frame);
        let mut out = Vec::new();
        let changed = shown.diff_iter(&picture);
        CrosstermBackend::new(&mut out).draw(changed).expect("bytes");
        let next = frames.next(SIZE, |_, buffer| buffer.clone_from(&picture)).expect("bytes");
        if frame >= FIRST {
            (plain, frugal) = (plain + out.len(), frugal + next.len());
        }
        shown = picture;
    }
    let mean = |sum: usize| sum as f64 / f64::from(COUNT);
    (mean(plain), mean(frugal))
}

fn main() {
    crossterm::style::force_color_output(true);
    println!("{:16} {:8} {:>10} {:>10} {:>6}", "system", "colours", "crossterm", "frames", "saved");
    for name in ["pendulum", "double-pendulum", "henon-heiles", "foucault"] {
        for (depth, called) in [
            (ColourDepth::None, "none"),
            (ColourDepth::Ansi16, "16"),
            (ColourDepth::Ansi256, "256"),
            (ColourDepth::True, "true"),
        ] {
            let (plain, frugal) = bytes(name, depth);
            let saved = 100.0 * (1.0 - frugal / plain);
            println!("{name:16} {called:8} {plain:10.0} {frugal:10.0} {saved:5.0}%");
        }
    }
}
