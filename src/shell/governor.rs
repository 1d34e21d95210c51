//! The governor: how often frames are sent over a connection of limited bandwidth, and how detailed they are.
//!
//! In: the bytes of each frame and when they were sent. Out: when the next frame is due, its maximum size in bytes,
//! and how much of the picture to leave out. Never here: a clock, the terminal, or which details are left out.
//!
//! If the connection is too slow, frames come less often, down to [`FEWEST`] per second. If that is not enough,
//! there are fewer colours, then less detail; a frame that is still too large is split over several frames. Bytes
//! are counted, not estimated: the next frame has to wait until what was sent has been transmitted.

use std::time::{Duration, Instant};

use crate::view::Detail;

/// The minimum number of frames per second, however slow the connection is.
const FEWEST: f64 = 2.0;

/// A frame whose transmission takes longer than this, in seconds, is too large; the detail is then reduced.
const SLOW: f64 = 0.4;

/// A frame that takes less than this leaves room for more detail, which may take three times as much.
const EASY: f64 = 0.125;

/// How long frames must be too large before the detail is reduced.
const SLOWNESS: Duration = Duration::from_secs(1);

/// How long there must be room before the detail is raised. The time doubles after every premature raise, up to the
/// second value.
const EASE: [Duration; 2] = [Duration::from_secs(3), Duration::from_secs(60)];

/// A reduction this soon after a raise means that the raise was premature.
const SOON: Duration = Duration::from_secs(10);

/// The averaging time for the need of a frame, in seconds.
const MEMORY: f64 = 1.0;

/// The interval between frames while the window has no focus: two per second are enough to show that the program
/// runs.
const ASIDE: Duration = Duration::from_millis(500);

/// Controls the rate and detail of frames.
#[derive(Debug)]
pub(super) struct Governor {
    frames: u16,
    /// The bytes per second; `None` if there is no limit.
    budget: Option<f64>,
    /// Whether the window has the focus.
    pub(super) watched: bool,
    /// When the last frame was sent.
    at: Instant,
    /// The bytes that had not been transmitted then.
    owed: f64,
    /// The average transmission time of a frame, in seconds.
    need: f64,
    detail: Detail,
    /// How long frames have been too large, or small.
    slow: Duration,
    easy: Duration,
    ease: Duration,
    risen: Option<Instant>,
}

impl Governor {
    /// Creates a governor for at most this many frames and this many bytes per second.
    pub(super) fn new(frames: u16, budget: Option<u32>, now: Instant) -> Self {
        Self {
            frames: frames.max(1),
            budget: budget.map(|bytes| f64::from(bytes.max(1))),
            watched: true,
            at: now,
            owed: 0.0,
            need: 0.0,
            detail: Detail::default(),
            slow: Duration::ZERO,
            easy: Duration::ZERO,
            ease: EASE[0],
            risen: None,
        }
    }

    /// Sets the number of frames per second.
    pub(super) fn want(&mut self, frames: u16) {
        self.frames = frames.max(1);
    }

    /// Returns the level of detail of the picture.
    pub(super) fn detail(&self) -> Detail {
        self.detail
    }

    /// Returns the maximum size of the next frame in bytes.
    pub(super) fn most(&self) -> usize {
        self.budget.map_or(usize::MAX, |budget| (budget / FEWEST) as usize)
    }

    /// Registers a frame of this many bytes, zero if nothing had changed.
    pub(super) fn sent(&mut self, bytes: usize, now: Instant) {
        let passed = now.saturating_duration_since(self.at);
        self.at = now;
        let Some(budget) = self.budget else { return };
        self.owed = (self.owed - passed.as_secs_f64() * budget).max(0.0) + bytes as f64;
        let share = passed.as_secs_f64() / (passed.as_secs_f64() + MEMORY);
        self.need += (bytes as f64 / budget - self.need) * share;
        self.judge(passed, now);
    }

    /// Returns when the next frame is due.
    pub(super) fn due(&self) -> Instant {
        let interval = if self.watched { self.interval() } else { self.interval().max(ASIDE) };
        self.paid().max(self.at + interval)
    }

    /// Returns when it is due if the user has typed something and waits for the result.
    pub(super) fn soon(&self, now: Instant) -> Instant {
        self.paid().max(now + self.interval())
    }

    fn interval(&self) -> Duration {
        Duration::from_secs(1) / u32::from(self.frames)
    }

    /// Returns when everything sent will have been transmitted.
    fn paid(&self) -> Instant {
        self.at + Duration::from_secs_f64(self.budget.map_or(0.0, |budget| self.owed / budget))
    }

    /// Reduces or raises the detail if frames have been too large, or small, for long enough.
    fn judge(&mut self, passed: Duration, now: Instant) {
        self.slow = if self.need > SLOW { self.slow + passed } else { Duration::ZERO };
        self.easy = if self.need < EASY { self.easy + passed } else { Duration::ZERO };
        let poorer = self.detail.poorer().filter(|_| self.slow >= SLOWNESS);
        let richer = self.detail.richer().filter(|_| self.easy >= self.ease);
        if let Some(detail) = poorer {
            let soon = self.risen.is_some_and(|risen| now - risen < SOON);
            self.ease = if soon { (self.ease * 2).min(EASE[1]) } else { EASE[0] };
            // The need of a less detailed picture is still unknown.
            (self.detail, self.need, self.slow) =
                (detail, f64::midpoint(EASY, SLOW), Duration::ZERO);
        } else if let Some(detail) = richer {
            (self.detail, self.easy, self.risen) = (detail, Duration::ZERO, Some(now));
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use ratatui::buffer::Buffer;
    use ratatui::layout::{Rect, Size};
    use ratatui::style::{Color, Style};

    use super::*;
    use crate::app::{App, Event, Loaded};
    use crate::experiment::{Experiment, Prepared};
    use crate::preset::Catalog;
    use crate::view::colour::ColourDepth;
    use crate::view::frame::Frames;
    use crate::view::glyphs::Glyphs;
    use crate::view::theme::Theme;
    use crate::view::{self, RenderStyle};

    const BUDGET: u32 = 16 * 1024;

    /// Simulates a connection: returns each frame's time in seconds and its bytes.
    fn carried(
        governor: &mut Governor,
        seconds: f64,
        mut frame: impl FnMut(&Governor) -> usize,
    ) -> Vec<(f64, usize)> {
        let start = governor.at;
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
        let mut governor = governor(Some(BUDGET));
        governor.watched = false;
        let now = governor.at;
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
            let catalog = Catalog::with_folder(None);
            let document = catalog.find(name).expect("a shipped preset");
            let ready = Prepared::of(&document).expect("a preset without errors");
            let Prepared { document, model, equations, system, mut experiment } = ready;
            let name = name.to_owned();
            experiment.set_epoch(1);
            let (mut app, _) = App::new(&catalog, Some(&name));
            let loaded = Loaded { name, epoch: 1, document, model, equations, system };
            app.update(Event::Loaded(Ok(loaded)));
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
            self.app.update(Event::Tick(Duration::from_secs(1) / 30));
            self.app.update(Event::Snapshot(Arc::new(self.experiment.snapshot())));
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
        let frame =
            |frame: u32| motion.frame(f64::from(frame) / 30.0, usize::MAX, Detail::default());
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
        let fits =
            |((_, mean, most), (_, bytes)): (&(&str, usize, usize), &(&str, (usize, usize)))| {
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
}
