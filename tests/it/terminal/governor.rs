//! The governor on simulated connections: what it lets through, of made-up pictures and of systems in motion.

use std::sync::Arc;
use std::time::{Duration, Instant};

use phaselab::app::{App, AppEvent};
use phaselab::experiment::{Experiment, Prepared};
use phaselab::shell::Governor;
use phaselab::view::colour::ColourDepth;
use phaselab::view::frame::Frames;
use phaselab::view::glyphs::Glyphs;
use phaselab::view::theme::Theme;
use phaselab::view::{self, Detail, RenderStyle};
use ratatui::buffer::Buffer;
use ratatui::layout::{Rect, Size};
use ratatui::style::{Color, Style};

use crate::fixtures::{catalog, loaded};

const BUDGET: u32 = 16 * 1024;

/// Simulates a connection: returns each frame's time in seconds and its bytes.
fn carried(
    governor: &mut Governor,
    seconds: f64,
    mut frame: impl FnMut(&Governor) -> usize,
) -> Vec<(f64, usize)> {
    let start = governor.due();
    let mut frames = Vec::new();
    let mut now = start;
    while (now - start).as_secs_f64() < seconds {
        let bytes = frame(governor);
        frames.push(((now - start).as_secs_f64(), bytes));
        governor.sent(bytes, now);
        now = governor.due();
    }
    frames
}

fn sum(frames: &[(f64, usize)]) -> usize {
    frames.iter().map(|(_, bytes)| bytes).sum()
}

/// Returns the greatest gap between two frames, in seconds.
fn gap(frames: &[(f64, usize)]) -> f64 {
    frames.windows(2).map(|pair| pair[1].0 - pair[0].0).fold(0.0, f64::max)
}

fn governor(budget: Option<u32>) -> Governor {
    Governor::new(15, budget, Instant::now())
}

/// Simulates a picture of which every cell changes with every frame, within the limits of `governor`.
fn heat(governor: &mut Governor, seconds: f64) -> Vec<(f64, usize)> {
    let mut screen = Frames::new(true).expect("memory");
    let mut turn = 0_usize;
    carried(governor, seconds, |governor| {
        turn += 1;
        let depth = governor.detail();
        let draw = |area: Rect, buffer: &mut Buffer| {
            for (index, cell) in buffer.content.iter_mut().enumerate() {
                let heat = (index * 7 + turn * 13) as u8;
                let colour = if depth == Detail::default() {
                    Color::Rgb(heat, 255 - heat, heat / 2)
                } else {
                    Color::Indexed(heat)
                };
                cell.set_char(if (index + turn).is_multiple_of(2) { '▀' } else { '▄' });
                cell.set_style(Style::new().fg(colour));
            }
            assert_eq!(area.area() as usize, buffer.content.len());
        };
        screen.next_within(Size::new(80, 24), governor.most(), draw).expect("bytes").len()
    })
}

#[test]
fn a_picture_that_is_too_much_for_the_line_keeps_to_it() {
    let mut governor = governor(Some(BUDGET));
    let frames = heat(&mut governor, 10.0);
    assert!(sum(&frames) <= BUDGET as usize * 11, "{} bytes in ten seconds", sum(&frames));
    assert!(gap(&frames) <= 0.51, "{} s without a frame", gap(&frames));
    assert_eq!(governor.detail().poorer(), None, "nothing more can be left out");
}

#[test]
fn first_frames_become_fewer_and_then_the_picture_poorer() {
    let steady = |bytes: usize| {
        let mut governor = governor(Some(BUDGET));
        let frames = carried(&mut governor, 30.0, |governor| bytes.min(governor.most()));
        (frames.len() as f64 / 30.0, governor.detail())
    };
    let (rate, detail) = steady(900);
    assert!(rate > 14.5 && detail == Detail::default(), "{rate}");
    let (rate, detail) = steady(4000);
    assert!((4.0..4.2).contains(&rate) && detail == Detail::default(), "{rate} {detail:?}");
    let (rate, detail) = steady(20_000);
    assert!((1.9..2.2).contains(&rate) && detail.poorer().is_none(), "{rate} {detail:?}");
}

#[test]
fn it_climbs_back_when_there_is_room_and_does_not_swing() {
    let mut governor = governor(Some(BUDGET));
    carried(&mut governor, 20.0, Governor::most);
    assert_eq!(governor.detail().poorer(), None);
    carried(&mut governor, 60.0, |_| 200);
    assert_eq!(governor.detail(), Detail::default());

    // Detailed pictures are too large and poor ones small: it may try, but less and less often.
    let mut changes = Vec::new();
    let mut last = governor.detail();
    carried(&mut governor, 600.0, |governor| {
        if governor.detail() != last {
            last = governor.detail();
            changes.push(last);
        }
        if last.richer().is_none() { governor.most() } else { 300 }
    });
    assert!((4..=40).contains(&changes.len()), "{} changes in ten minutes", changes.len());
}

#[test]
fn without_a_limit_only_the_frames_count() {
    let mut governor = governor(None);
    let frames = carried(&mut governor, 10.0, |_| 50_000);
    assert_eq!(frames.len(), 151);
    assert_eq!((governor.most(), governor.detail()), (usize::MAX, Detail::default()));
    governor.watched = false;
    assert!(carried(&mut governor, 10.0, |_| 500).len() <= 21);
}

#[test]
fn what_is_typed_is_soon_seen_but_not_before_the_line_is_free() {
    let now = Instant::now();
    let mut governor = Governor::new(15, Some(BUDGET), now);
    governor.watched = false;
    governor.sent(100, now);
    assert_eq!(governor.due(), now + Duration::from_millis(500));
    assert!(governor.soon(now) < now + Duration::from_millis(70));
    governor.sent(BUDGET as usize / 2, now);
    assert!(governor.soon(now) >= now + Duration::from_millis(500));
}

/// A running system, and the terminal that shows it.
struct OpenSystem {
    app: App,
    experiment: Experiment,
    look: RenderStyle,
    screen: Frames,
    size: Size,
}

impl OpenSystem {
    fn of(name: &str, depth: ColourDepth, (width, height): (u16, u16)) -> Self {
        let loaded = loaded(name, 1);
        let Prepared { mut experiment, .. } =
            Prepared::of(&loaded.document).expect("a preset without errors");
        experiment.set_epoch(1);
        let (mut app, _) = App::new(catalog(), Some(name));
        app.update(AppEvent::Loaded(Ok(loaded)));
        let look = RenderStyle { theme: Theme::dark(depth), glyphs: Glyphs::Braille };
        Self {
            app,
            experiment,
            look,
            screen: Frames::new(true).expect("memory"),
            size: Size { width, height },
        }
    }

    /// Returns the size in bytes of a frame at this time of the clock, in seconds.
    fn frame(&mut self, time: f64, most: usize, detail: Detail) -> usize {
        self.experiment.advance(time * self.experiment.speed(), u64::MAX);
        self.app.update(AppEvent::Tick(Duration::from_secs(1) / 30));
        self.app.update(AppEvent::Snapshot(Arc::new(self.experiment.snapshot())));
        let look = self.look.reduced(detail);
        let draw = |area, buffer: &mut Buffer| {
            view::draw(&self.app, &look, area, buffer);
        };
        self.screen.next_within(self.size, most, draw).expect("bytes").len()
    }
}

/// Returns the mean and the greatest size in bytes of this many frames, at 30 per second, after the first two
/// seconds.
fn frames(name: &str, count: u32) -> (usize, usize) {
    let mut motion = OpenSystem::of(name, ColourDepth::Ansi256, (80, 24));
    let frame = |frame: u32| motion.frame(f64::from(frame) / 30.0, usize::MAX, Detail::default());
    let bytes = (0..count + 60).map(frame).collect::<Vec<_>>().split_off(60);
    (bytes.iter().sum::<usize>() / bytes.len(), bytes.iter().max().copied().unwrap_or(0))
}

#[test]
fn frames_fit_a_slow_line() {
    let limits = [
        ("pendulum", 350, 600),
        ("planet", 450, 1000),
        ("double-pendulum", 350, 1200),
        ("henon-heiles", 350, 1500),
        ("solar-system", 350, 1300),
        ("foucault", 350, 1500),
        ("toda", 350, 1300),
    ];
    let found = limits.map(|(name, ..)| (name, frames(name, 200)));
    let fits = |((_, mean, most), (_, bytes)): (&(&str, usize, usize), &(&str, (usize, usize)))| {
        bytes.0 <= *mean && bytes.1 <= *most
    };
    assert!(limits.iter().zip(&found).all(fits), "name, mean and greatest: {found:?}");
}

#[test]
fn a_limit_of_the_line_is_kept_to() {
    for size in [(80, 24), (200, 60)] {
        let mut motion = OpenSystem::of("double-pendulum", ColourDepth::True, size);
        let start = Instant::now();
        let mut governor = Governor::new(15, Some(BUDGET), start);
        let (mut now, mut sum, mut count) = (start, 0, 0);
        while now - start < Duration::from_secs(10) {
            let time = (now - start).as_secs_f64();
            let bytes = motion.frame(time, governor.most(), governor.detail());
            governor.sent(bytes, now);
            (sum, count) = (sum + bytes, count + 1);
            now = governor.due();
        }
        assert!(sum <= BUDGET as usize * 11, "{size:?}: {sum} bytes in ten seconds");
        assert!(count >= 20, "{size:?}: {count} frames in ten seconds");
    }
}
