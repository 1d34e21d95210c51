//! Demos inside the lab, as one watches them.

use std::time::Duration;

use phaselab::app::{Guide, GuideKind};
use phaselab::shell::{Guided, Screen};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use crate::screen::ascii;

/// A demo that has ended stands still, so that the picture with the way back must be asked for.
#[test]
fn a_demo_that_ends_asks_for_a_picture_that_says_so() {
    let name = "sleeping-top".to_owned();
    let guide = Guide { kind: GuideKind::Demo, title: name.clone(), system: name.clone(), name };
    let mut guided = Guided::open(&guide, ascii()).expect("a shipped demo");
    let area = Rect::new(0, 0, 80, 24);
    let is_over = |guided: &mut Guided| {
        let mut buffer = Buffer::empty(area);
        guided.draw(area, &mut buffer);
        let last_row: String =
            (0..area.width).map(|x| buffer[(x, area.bottom() - 1)].symbol()).collect();
        last_row.ends_with(" over: any key returns ")
    };
    assert!(!is_over(&mut guided));
    let step = Duration::from_millis(100);
    let ending = (0..600).map(|_| guided.advance(step)).collect::<Vec<_>>();
    assert!(is_over(&mut guided));
    // the last change is that it has ended
    let end = ending.iter().rposition(|changed| *changed).expect("it has ended");
    assert!((100..500).contains(&end), "{end}");
    assert!(!guided.advance(step));
}
