//! The governor: how often frames may come over a line of so many bytes a second, and how much may be in them.
//!
//! In: the bytes of each frame and when they were sent. Out: when the next is due, the most bytes it may have, and how
//! much of the picture to leave out. Never here: a clock, the terminal, or what is left out.
//!
//! Where the line is too slow frames come less often, down to [`FEWEST`] a second. Where that is not enough there are
//! fewer colours, then less in the picture; what is still too much comes in parts, a part a frame. Bytes are counted, not
//! guessed: what was sent has to be paid for in time before the next frame.

use std::time::{Duration, Instant};

use crate::view::Detail;

/// The fewest frames in a second, however slow the line is.
const FEWEST: f64 = 2.0;

/// A frame that takes longer than this on the line, in seconds, is too much; the picture has to become poorer.
const SLOW: f64 = 0.4;

/// One that takes less leaves room for a richer picture, which may be three times as much.
const EASY: f64 = 0.125;

/// For how long it has to be too much.
const SLOWNESS: Duration = Duration::from_secs(1);

/// For how long there has to be room; twice as long after every rise that was too much, up to the second time.
const EASE: [Duration; 2] = [Duration::from_secs(3), Duration::from_secs(60)];

/// A fall so soon after a rise says that the rise was too much.
const SOON: Duration = Duration::from_secs(10);

/// How long what a frame needs is remembered, in seconds.
const MEMORY: f64 = 1.0;

/// Between two frames while nobody looks: two in a second are enough to see that it lives.
const ASIDE: Duration = Duration::from_millis(500);

/// Watches over what is sent.
#[derive(Debug)]
pub(super) struct Governor {
    frames: u16,
    /// Bytes in a second; `None` where the line carries anything.
    budget: Option<f64>,
    /// Whether somebody looks at the window.
    pub(super) watched: bool,
    /// When the last frame was sent.
    at: Instant,
    /// Bytes that were sent then and not paid for.
    owed: f64,
    /// Seconds that a frame takes on the line, on average.
    need: f64,
    detail: Detail,
    /// For how long frames have been too much, or small.
    slow: Duration,
    easy: Duration,
    ease: Duration,
    risen: Option<Instant>,
}

impl Governor {
    /// So many frames in a second, and at most so many bytes.
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

    /// So many frames in a second are wanted from now on.
    pub(super) fn want(&mut self, frames: u16) {
        self.frames = frames.max(1);
    }

    /// How much to leave out of the picture.
    pub(super) fn detail(&self) -> Detail {
        self.detail
    }

    /// The most bytes that the next frame may have.
    pub(super) fn most(&self) -> usize {
        self.budget.map_or(usize::MAX, |budget| (budget / FEWEST) as usize)
    }

    /// A frame of so many bytes was sent, none if nothing had changed.
    pub(super) fn sent(&mut self, bytes: usize, now: Instant) {
        let passed = now.saturating_duration_since(self.at);
        self.at = now;
        let Some(budget) = self.budget else { return };
        self.owed = (self.owed - passed.as_secs_f64() * budget).max(0.0) + bytes as f64;
        let share = passed.as_secs_f64() / (passed.as_secs_f64() + MEMORY);
        self.need += (bytes as f64 / budget - self.need) * share;
        self.judge(passed, now);
    }

    /// When the next frame is due.
    pub(super) fn due(&self) -> Instant {
        let interval = if self.watched { self.interval() } else { self.interval().max(ASIDE) };
        self.paid().max(self.at + interval)
    }

    /// When it is due where something was typed that somebody waits to see.
    pub(super) fn soon(&self, now: Instant) -> Instant {
        self.paid().max(now + self.interval())
    }

    fn interval(&self) -> Duration {
        Duration::from_secs(1) / u32::from(self.frames)
    }

    /// When the line has carried all that was sent.
    fn paid(&self) -> Instant {
        self.at + Duration::from_secs_f64(self.budget.map_or(0.0, |budget| self.owed / budget))
    }

    /// Makes the picture poorer or richer where it has been too much, or little, for long enough.
    fn judge(&mut self, passed: Duration, now: Instant) {
        self.slow = if self.need > SLOW { self.slow + passed } else { Duration::ZERO };
        self.easy = if self.need < EASY { self.easy + passed } else { Duration::ZERO };
        let poorer = self.detail.poorer().filter(|_| self.slow >= SLOWNESS);
        let richer = self.detail.richer().filter(|_| self.easy >= self.ease);
        if let Some(detail) = poorer {
            let soon = self.risen.is_some_and(|risen| now - risen < SOON);
            self.ease = if soon { (self.ease * 2).min(EASE[1]) } else { EASE[0] };
            // What a poorer picture needs is to be seen.
            (self.detail, self.need, self.slow) =
                (detail, f64::midpoint(EASY, SLOW), Duration::ZERO);
        } else if let Some(detail) = richer {
            (self.detail, self.easy, self.risen) = (detail, Duration::ZERO, Some(now));
        }
    }
}

#[cfg(test)]
mod tests {
    use ratatui::buffer::Buffer;
    use ratatui::layout::{Rect, Size};
    use ratatui::style::{Color, Style};

    use super::*;
    use crate::view::frame::Frames;

    const BUDGET: u32 = 16 * 1024;

    /// What a line has carried: each frame's time in seconds and its bytes.
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

    /// The greatest gap between two frames, in seconds.
    fn gap(frames: &[(f64, usize)]) -> f64 {
        frames.windows(2).map(|pair| pair[1].0 - pair[0].0).fold(0.0, f64::max)
    }

    fn governor(budget: Option<u32>) -> Governor {
        Governor::new(15, budget, Instant::now())
    }

    /// A picture of which every cell changes with every frame, as bytes that `governor` lets through.
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

        // Rich pictures are too much and poor ones are little: it may try, but ever less often.
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
}
