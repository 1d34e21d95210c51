//! Frames: their bytes and the time to encode them, `view::frame` compared with ratatui's `CrosstermBackend` alone; and the
//! time to draw one, `view::Painter`, which keeps what does not change, compared with drawing everything anew.
//!
//! `cargo bench --bench frames` prints a line for each system and each depth of colour: the mean bytes of a frame in ten
//! seconds of motion at 80 × 24, thirty frames a second, after the first two seconds, and the median time from a picture to
//! its bytes, both ways. Then a line for each system: the
//! median time of a frame at 120 × 40 over a full trail, both ways in turn. `-- NAME…` prints only these lines, for the systems
//! that are named; `-- counted NAME FRAMES` only draws that many frames by a painter, for a program that counts instructions
//! (`valgrind --tool=callgrind --toggle-collect='*Painter*draw*'`); `-- all` prints the mean bytes for every preset, in true colour, at 80 × 24 and 120 × 40, and their means.

#![allow(clippy::print_stdout, reason = "a benchmark reports on the terminal")]

use std::cell::RefCell;
use std::hint::black_box;
use std::io::{self, Write};
use std::rc::Rc;
use std::sync::Arc;
use std::time::{Duration, Instant};

use phaselab::app::{App, AppEvent, Loaded};
use phaselab::experiment::{Experiment, Prepared};
use phaselab::preset::Catalog;
use phaselab::view::colour::ColourDepth;
use phaselab::view::frame::Frames;
use phaselab::view::glyphs::Glyphs;
use phaselab::view::theme::Theme;
use phaselab::view::{self, Painter, RenderStyle};
use ratatui::backend::CrosstermBackend;
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect, Size};
use ratatui::{Terminal, TerminalOptions, Viewport};

const SIZE: Size = Size { width: 80, height: 24 };
const FIRST: u32 = 60;
const COUNT: u32 = 300;

/// The frame after which the trail is full, and the number of frames that are timed.
const FULL: u32 = 18_000;
const TIMED: u32 = 200;

/// A system in motion that is drawn.
struct Motion {
    app: App,
    experiment: Experiment,
    look: RenderStyle,
    painter: Painter,
}

impl Motion {
    fn of(name: &str, depth: ColourDepth) -> Self {
        let catalog = Catalog::with_folder(None);
        let document = catalog.find(name).expect("a shipped preset");
        let Prepared { document, warnings, model, equations, system, mut experiment } =
            Prepared::of(&document).expect("a preset without mistakes");
        experiment.set_epoch(1);
        let name = name.to_owned();
        let (mut app, _) = App::new(&catalog, Some(&name));
        let loaded = Loaded { name, epoch: 1, document, warnings, model, equations, system };
        app.update(AppEvent::Loaded(Ok(loaded)));
        let look = RenderStyle { theme: Theme::dark(depth), glyphs: Glyphs::Braille };
        Self { app, experiment, look, painter: Painter::default() }
    }

    fn advance(&mut self, frame: u32) {
        let time = f64::from(frame) / 30.0 * self.experiment.speed();
        self.experiment.advance(time, u64::MAX);
        self.app.update(AppEvent::Tick(Duration::from_secs(1) / 30));
        self.app.update(AppEvent::Snapshot(Arc::new(self.experiment.snapshot())));
    }

    fn picture(&mut self, frame: u32, size: Size) -> Buffer {
        self.advance(frame);
        let area = Rect::from((Position::ORIGIN, size));
        let mut buffer = Buffer::empty(area);
        self.painter.draw(&self.app, &self.look, area, &mut buffer);
        buffer
    }
}

/// The mean bytes of a frame, and the median time from a picture to its bytes.
struct Encoded {
    bytes: f64,
    time: Duration,
}

impl Encoded {
    fn of(frames: Vec<(usize, Duration)>) -> Self {
        let (bytes, times): (Vec<usize>, Vec<Duration>) = frames.into_iter().unzip();
        Self { bytes: bytes.iter().sum::<usize>() as f64 / bytes.len() as f64, time: median(times) }
    }
}

fn median(mut times: Vec<Duration>) -> Duration {
    times.sort_unstable();
    times[times.len() / 2]
}

/// Bytes written, shared with the backend that writes them.
#[derive(Clone, Default)]
struct Written(Rc<RefCell<Vec<u8>>>);

impl Write for Written {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.borrow_mut().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// The same pictures drawn on ratatui's terminal with crossterm's backend, and on that of `view::frame`, which also
/// looks for control characters in them.
fn encoded(name: &str, depth: ColourDepth, size: Size) -> [Encoded; 2] {
    let mut motion = Motion::of(name, depth);
    let mut frames = Frames::new(false).expect("memory");
    let written = Written::default();
    let viewport = Viewport::Fixed(Rect::from((Position::ORIGIN, size)));
    let backend = CrosstermBackend::new(written.clone());
    let mut terminal =
        Terminal::with_options(backend, TerminalOptions { viewport }).expect("memory");
    let (mut plain, mut frugal) = (Vec::new(), Vec::new());
    for frame in 0..FIRST + COUNT {
        let picture = motion.picture(frame, size);
        let begun = Instant::now();
        terminal.draw(|frame| frame.buffer_mut().clone_from(&picture)).expect("bytes");
        let plainly = (written.0.take().len(), begun.elapsed());
        let begun = Instant::now();
        let next = frames.next(size, |_, buffer| buffer.clone_from(&picture)).expect("bytes");
        let frugally = (black_box(&next).len(), begun.elapsed());
        if frame >= FIRST {
            plain.push(plainly);
            frugal.push(frugally);
        }
    }
    [plain, frugal].map(Encoded::of)
}

/// The median time of a frame over a full trail: drawn anew, and by a painter.
fn times(name: &str) -> (Duration, Duration) {
    let mut motion = Motion::of(name, ColourDepth::True);
    let area = Rect::new(0, 0, 120, 40);
    let (mut painter, mut anew, mut kept) = (Painter::default(), Vec::new(), Vec::new());
    for frame in FULL..FULL + TIMED {
        motion.advance(frame);
        let mut buffer = Buffer::empty(area);
        let begun = Instant::now();
        view::draw(&motion.app, &motion.look, area, black_box(&mut buffer));
        anew.push(begun.elapsed());
        let mut again = Buffer::empty(area);
        let begun = Instant::now();
        painter.draw(&motion.app, &motion.look, area, black_box(&mut again));
        kept.push(begun.elapsed());
    }
    (median(anew), median(kept))
}

/// Prints the mean bytes of a frame of every preset at two sizes, and their means.
fn all() {
    println!("{:28} {:>8} {:>8}", "preset", "80x24", "120x40");
    let sizes = [SIZE, Size { width: 120, height: 40 }];
    let catalog = Catalog::with_folder(None);
    let of = |name: &str| sizes.map(|size| encoded(name, ColourDepth::True, size)[1].bytes);
    let mut rows = Vec::new();
    for entry in catalog.entries() {
        let row = of(&entry.name);
        println!("{:28} {:8.0} {:8.0}", entry.name, row[0], row[1]);
        rows.push(row);
    }
    let mean = |k: usize| rows.iter().map(|row| row[k]).sum::<f64>() / rows.len() as f64;
    println!("{:28} {:8.0} {:8.0}", "mean", mean(0), mean(1));
}

/// Prints the median time of a frame of some systems, drawn anew and by a painter.
fn timed(names: &[&str]) {
    println!("{:16} {:>10} {:>10} {:>6}", "system", "anew", "kept", "ratio");
    for name in names {
        let (anew, kept) = times(name);
        let ratio = anew.as_secs_f64() / kept.as_secs_f64();
        println!("{name:16} {anew:>10.1?} {kept:>10.1?} {ratio:6.1}");
    }
}

/// Draws frames of a system over a full trail by a painter and measures nothing itself.
fn counted(name: &str, frames: u32) {
    let mut motion = Motion::of(name, ColourDepth::True);
    for frame in FULL..FULL + frames {
        black_box(motion.picture(frame, Size { width: 120, height: 40 }));
    }
}

fn main() {
    crossterm::style::force_color_output(true);
    let given: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect();
    let names: Vec<&str> = given.iter().map(String::as_str).collect();
    match names[..] {
        [] => {}
        ["all"] => return all(),
        ["counted", name, frames] => {
            return counted(name, frames.parse().expect("a number of frames"));
        }
        _ => return timed(&names),
    }
    let titles = ["crossterm", "frames", "saved", "crossterm", "frames"];
    let [a, b, c, d, e] = titles;
    println!("{:16} {:8} {a:>10} {b:>10} {c:>6} {d:>10} {e:>10}", "system", "colours");
    for name in ["pendulum", "double-pendulum", "henon-heiles", "foucault"] {
        for (depth, called) in [
            (ColourDepth::None, "none"),
            (ColourDepth::Ansi16, "16"),
            (ColourDepth::Ansi256, "256"),
            (ColourDepth::True, "true"),
        ] {
            let [plain, frugal] = encoded(name, depth, SIZE);
            let saved = 100.0 * (1.0 - frugal.bytes / plain.bytes);
            println!(
                "{name:16} {called:8} {:10.0} {:10.0} {saved:5.0}% {:>10.1?} {:>10.1?}",
                plain.bytes, frugal.bytes, plain.time, frugal.time
            );
        }
    }
    timed(&["pendulum", "heavy-top", "double-pendulum", "chain-pendulum", "henon-heiles"]);
}
