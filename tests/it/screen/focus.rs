//! The focus: Tab goes once to each pane in view, a key turns the tabs of a frame, and one pane looks focused wherever one is.

use phaselab::app::{AppEvent, Pane};
use phaselab::view::colour::ColourDepth;
use phaselab::view::glyphs::Glyphs;
use phaselab::view::theme::{Role, Theme};
use phaselab::view::{RenderStyle, hit_test};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::{drawn, rich, rows};
use crate::app::real::Real;
use crate::fixtures::{at_picker, in_lab, press};

/// The frames on a screen that look focused, by their upper left corners.
fn focused(buffer: &Buffer, style: &RenderStyle) -> Vec<(u16, u16)> {
    let focus = style.theme[Role::Focus].fg;
    let area = buffer.area;
    let all = (0..area.height).flat_map(|y| (0..area.width).map(move |x| (x, y)));
    all.filter(|&at| match style.theme.depth() {
        ColourDepth::None => buffer[at].symbol() == "┏",
        _ => ["╭", "┌"].contains(&buffer[at].symbol()) && Some(buffer[at].fg) == focus,
    })
    .collect()
}

/// Draws, and lets the lab know what is in view.
fn look(real: &mut Real, style: &RenderStyle, size: (u16, u16)) -> Buffer {
    let (buffer, seen) = drawn(&real.app, style, size);
    real.app.update(AppEvent::Drawn(seen));
    buffer
}

/// The pane at a place.
fn pane_at(real: &Real, size: (u16, u16), (x, y): (u16, u16)) -> Option<Pane> {
    use phaselab::app::HitTarget;
    let area = Rect::new(0, 0, size.0, size.1);
    match hit_test(&real.app, &rich(), area, x, y + 1)? {
        HitTarget::Pane(pane) => Some(pane),
        HitTarget::Plot { index, .. } | HitTarget::Space { index, .. } => Some(Pane::Plot(index)),
        HitTarget::Gauge(_) => Some(Pane::Gauges),
        _ => None,
    }
}

#[test]
fn tab_goes_once_to_each_pane_in_view_and_to_no_other() {
    for name in ["pendulum", "planet"] {
        let mut real = Real::of(name);
        real.run(30);
        for size in [(80, 24), (120, 40), (200, 60), (70, 14)] {
            let begun = Pane::Parameters;
            real.app.lab.as_mut().unwrap().focus.pane = begun;
            let mut seen = Vec::new();
            let mut corners = Vec::new();
            loop {
                let buffer = look(&mut real, &rich(), size);
                let one = focused(&buffer, &rich());
                assert_eq!(one.len(), 1, "{name} {size:?}: {:#?}", rows(&buffer));
                corners.extend(one);
                seen.push(real.lab().focus.pane);
                real.press("Tab");
                if real.lab().focus.pane == begun || seen.len() > 20 {
                    break;
                }
            }
            let once = |all: &[(u16, u16)]| {
                let mut all = all.to_vec();
                all.sort_unstable();
                all.dedup();
                all.len()
            };
            // each has a place of its own: none took that of another
            assert_eq!(once(&corners), seen.len(), "{name} {size:?}: {seen:?} at {corners:?}");
            assert!(seen.len() > 1, "{name} {size:?}");
            let last = seen.pop();
            look(&mut real, &rich(), size);
            real.press("Shift-Tab");
            assert_eq!(Some(real.lab().focus.pane), last, "{name} {size:?}");
        }
    }
}

#[test]
fn a_key_turns_the_tabs_of_a_frame_through_all_panes_that_are_hidden() {
    for (name, size) in [("planet", (80, 24)), ("planet", (120, 40)), ("heavy-top", (70, 14))] {
        let mut real = Real::of(name);
        real.run(30);
        let first = look(&mut real, &rich(), size);
        assert!(rows(&first).join("").contains('\\'), "the key is shown: {:#?}", rows(&first));
        let pictures = real.lab().plots.len();
        if let Some(lab) = &mut real.app.lab {
            lab.focus.pane = Pane::Plot(0);
        }
        let mut seen = Vec::new();
        for _ in 0..=pictures {
            real.press("\\");
            let buffer = look(&mut real, &rich(), size);
            let pane = real.lab().focus.pane;
            assert!(matches!(pane, Pane::Plot(_)), "{name} {size:?}: {pane:?}");
            let corner = focused(&buffer, &rich());
            let [at] = corner[..] else { panic!("{name} {size:?}: {corner:?}") };
            assert_eq!(pane_at(&real, size, (at.0 + 5, at.1)), Some(pane), "{name} {size:?}");
            seen.push((pane, at));
        }
        // all in one place
        assert!(seen.iter().all(|(_, at)| *at == seen[0].1), "{name} {size:?}: {seen:?}");
        let mut panes: Vec<usize> = seen
            .iter()
            .filter_map(|(pane, _)| if let Pane::Plot(index) = pane { Some(*index) } else { None })
            .collect();
        panes.sort_unstable();
        panes.dedup();
        let beside = usize::from(size.0 != 70);
        assert!(panes.len() > 1 && panes.len() + beside <= pictures, "{name} {size:?}: {panes:?}");
    }
    // where every pane has a frame of its own there is nothing to turn, and it is said
    let mut real = Real::of("harmonic-oscillator");
    look(&mut real, &rich(), (300, 90));
    real.press("\\");
    let text = rows(&look(&mut real, &rich(), (300, 90))).join("\n");
    assert!(text.contains("There are no tabs"), "{text}");
}

#[test]
fn one_pane_looks_focused_on_every_page_and_below_every_list() {
    let colourless = RenderStyle { theme: Theme::dark(ColourDepth::None), glyphs: Glyphs::Braille };
    for keys in ["", "3", "4", "?", "m", ":", "T", "v", "{", "E", "Enter", "z"] {
        let mut app = in_lab();
        press(&mut app, keys);
        for style in [rich(), colourless.clone()] {
            for size in [(80, 24), (120, 40), (200, 60)] {
                let buffer = drawn(&app, &style, size).0;
                let one = focused(&buffer, &style);
                assert_eq!(one.len(), 1, "{keys:?} {size:?}: {one:?} {:#?}", rows(&buffer));
            }
        }
    }
    let buffer = drawn(&at_picker(), &rich(), (80, 24)).0;
    assert_eq!(focused(&buffer, &rich()).len(), 1, "{:#?}", rows(&buffer));
}
