//! The bytes of a frame, as they go to a terminal at the end of a slow line.

use std::time::Duration;

use phaselab::app::AppEvent;
use phaselab::view::colour::ColourDepth;
use phaselab::view::frame::Frames;
use phaselab::view::glyphs::Glyphs;
use phaselab::view::theme::Theme;
use phaselab::view::{Painter, RenderStyle};
use ratatui::layout::Size;

use crate::app::real::Real;

/// The frames that are counted, after the ones in which the picture is built up.
const FIRST: usize = 60;
const COUNT: usize = 200;

/// The mean and the greatest number of bytes of a frame of a system in motion at 80 × 24, thirty frames a second.
fn bytes(name: &str) -> (usize, usize) {
    let mut real = Real::of(name);
    let look = RenderStyle { theme: Theme::dark(ColourDepth::Ansi256), glyphs: Glyphs::Braille };
    let (mut frames, mut painter) = (Frames::new(true).unwrap(), Painter::default());
    let mut counted = Vec::new();
    for _ in 0..FIRST + COUNT {
        // two frames of a sixtieth of a second
        real.run(2);
        real.app.update(AppEvent::Tick(Duration::from_secs(1) / 30));
        let frame = frames.next(Size::new(80, 24), |area, buffer| {
            painter.draw(&real.app, &look, area, buffer);
        });
        counted.push(frame.unwrap().len());
    }
    let counted = &counted[FIRST..];
    (counted.iter().sum::<usize>() / COUNT, counted.iter().copied().max().unwrap())
}

#[test]
fn a_frame_of_a_motion_is_small() {
    let (mean, most) = bytes("pendulum");
    assert!((50..=350).contains(&mean) && most <= 600, "{mean} bytes on average, at most {most}");
    let (mean, most) = bytes("double-pendulum");
    assert!(mean <= 700 && most <= 4500, "{mean} bytes on average, at most {most}");
}
