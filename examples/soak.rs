//! A long run without a terminal: draws many frames of a system in motion on a virtual clock and measures their memory.
//!
//! `cargo run --release --example soak -- double-pendulum 1000000` exits with status 1 if the memory in use has grown by
//! more than a twentieth since the first tenth of the frames.

use std::io::{Write, stdout};
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Duration;

use color_eyre::eyre::{Result, eyre};
use phaselab::app::{App, AppEvent, Loaded};
use phaselab::experiment::Prepared;
use phaselab::preset::Catalog;
use phaselab::view::colour::ColourDepth;
use phaselab::view::frame::Frames;
use phaselab::view::glyphs::Glyphs;
use phaselab::view::theme::Theme;
use phaselab::view::{Painter, RenderStyle};
use ratatui::layout::Size;

/// Returns the number of memory pages in use, as Linux counts them.
fn memory() -> Result<u64> {
    let text = std::fs::read_to_string("/proc/self/statm")?;
    let pages = text.split_whitespace().nth(1).ok_or_else(|| eyre!("no count of pages"))?;
    Ok(pages.parse()?)
}

fn main() -> Result<ExitCode> {
    let mut words = std::env::args().skip(1);
    let name = words.next().unwrap_or_else(|| "pendulum".to_owned());
    let count: u32 = words.next().map_or(Ok(1_000_000), |word| word.parse())?;
    let catalog = Catalog::with_folder(None);
    let document = catalog.find(&name)?;
    let Prepared { document, warnings, model, equations, system, mut experiment } =
        Prepared::of(&document)?;
    experiment.set_epoch(1);
    let (mut app, _) = App::new(&catalog, Some(&name));
    app.update(AppEvent::Loaded(Ok(Loaded {
        name,
        epoch: 1,
        document,
        warnings,
        model,
        equations,
        system,
    })));
    let look = RenderStyle { theme: Theme::dark(ColourDepth::Ansi256), glyphs: Glyphs::Braille };
    let (mut frames, mut painter) = (Frames::new(true)?, Painter::default());
    let (start, mut bytes, mut first) = (experiment.time(), 0, 0);
    for frame in 0..count {
        let time = start + f64::from(frame) / 30.0 * experiment.speed();
        experiment.advance(time, u64::MAX);
        app.update(AppEvent::Tick(Duration::from_secs(1) / 30));
        app.update(AppEvent::Snapshot(Arc::new(experiment.snapshot())));
        let draw = |area, buffer: &mut _| {
            painter.draw(&app, &look, area, buffer);
        };
        bytes += frames.next(Size::new(80, 24), draw)?.len();
        if frame == count / 10 {
            first = memory()?;
        }
    }
    let last = memory()?;
    let growth = last as f64 / first.max(1) as f64 - 1.0;
    let mean = bytes as f64 / f64::from(count.max(1));
    writeln!(
        stdout(),
        "{count} frames of {mean:.0} bytes; memory {first} to {last} pages, {:+.1} %",
        100.0 * growth
    )?;
    Ok(if growth > 0.05 { ExitCode::FAILURE } else { ExitCode::SUCCESS })
}
