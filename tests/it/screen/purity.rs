//! Any size, any terminal: no panic, no unsupported character, no colour if there is none.

use std::sync::{Arc, OnceLock};

use phaselab::app::{App, AppEvent, LoadError};
use phaselab::experiment::{RunError, Snapshot, Status, Trail, Verdict};
use phaselab::view::RenderStyle;
use phaselab::view::colour::ColourDepth;
use phaselab::view::glyphs::Glyphs;
use phaselab::view::theme::Theme;
use proptest::prelude::*;
use ratatui::style::Color;

use super::screen;
use crate::cases;
use crate::fixtures::{at_picker, catalog, gauge, in_lab, lab, pendulum, press, snapshot};
use crate::nonempty;

/// Keys that lead from the lab to every page, pop-up and pane.
const WAYS: [&str; 21] = [
    "",
    "2",
    "3",
    "4",
    "9",
    "T Down",
    "{ t h",
    "?",
    "m",
    ":",
    "Enter",
    "Enter Ctrl-u x Enter",
    "Tab",
    "Tab Tab",
    "Tab Tab Tab",
    "Tab Tab Tab Tab c +",
    "Tab Tab Tab Tab z",
    "z",
    "Shift-Tab v Enter",
    "Tab Tab Tab Tab g",
    "u",
];

/// Every page, pop-up and pane, and the picker in its states.
fn everything() -> &'static [App] {
    static EVERYTHING: OnceLock<Vec<App>> = OnceLock::new();
    EVERYTHING.get_or_init(all_states)
}

fn all_states() -> Vec<App> {
    let lab = WAYS.into_iter().map(|keys| {
        let mut app = in_lab();
        press(&mut app, keys);
        app
    });
    let picker = ["", "/ p e n", "/ x y z", "?"].into_iter().map(|keys| {
        let mut app = at_picker();
        press(&mut app, keys);
        app
    });
    let empty = App::new(catalog(), None).0;
    let mut failed = App::new(catalog(), Some("own.toml")).0;
    let message = "own.toml:1:1: a title is missing → add one\n".repeat(30);
    failed.update(AppEvent::Loaded(Err(LoadError { name: "own.toml".into(), message })));
    lab.chain(picker).chain(vec![empty, failed, stopped(), unseen(), crowded()]).collect()
}

/// A motion that cannot continue, with NaN among its numbers.
fn stopped() -> App {
    let mut app = in_lab();
    let mut odd = snapshot(&pendulum(), 2.0);
    odd.status = Status::Failed(RunError {
        time: 2.0,
        message: "the step became too small".into(),
        ends_motion: true,
    });
    odd.time = f64::NAN;
    odd.values = odd.values.iter().map(|_| f64::NAN).collect();
    odd.bounds = odd.bounds.iter().map(|_| (f64::NEG_INFINITY, f64::INFINITY)).collect();
    let verdicts = [Verdict::Open, Verdict::Secular(f64::INFINITY), Verdict::Broken("−2F".into())];
    odd.gauges = verdicts.map(|v| gauge("θ̇ of the bob", "θ̇", f64::MAX, v)).into();
    app.update(AppEvent::Snapshot(Arc::new(odd)));
    app
}

/// A system without a snapshot yet.
fn unseen() -> App {
    let (mut app, _) = App::new(catalog(), Some("pendulum"));
    app.update(AppEvent::Loaded(Ok(pendulum())));
    app
}

/// A snapshot that belongs to another system: everything in it is too short.
fn crowded() -> App {
    let mut app = in_lab();
    let empty = Snapshot { trail: Trail::from_rows(1, &[vec![0.0]]), ..Snapshot::empty(1) };
    app.update(AppEvent::Snapshot(Arc::new(empty)));
    app
}

#[test]
fn all_presets_are_drawn() {
    for entry in nonempty(catalog().entries()) {
        let mut app = lab(&entry.name, 1.0);
        for keys in ["", "2", "3", "4", "9"] {
            press(&mut app, keys);
            for size in [(80, 24), (200, 60)] {
                let text = super::rows(&screen(&app, &super::rich(), size)).join("\n");
                let title: String = entry.info.title.chars().take(9).collect();
                assert!(
                    text.contains(&title) && text.contains("quit"),
                    "{} {keys} {text}",
                    entry.name
                );
            }
        }
    }
}

#[test]
fn ascii_screens_hold_nothing_else() {
    let look = RenderStyle { theme: Theme::dark(ColourDepth::Ansi16), glyphs: Glyphs::Ascii };
    for app in everything() {
        for size in [(40, 10), (80, 24), (120, 40), (200, 60)] {
            let buffer = screen(app, &look, size);
            for (index, cell) in buffer.content.iter().enumerate() {
                let at = buffer.pos_of(index);
                assert!(
                    cell.symbol().is_ascii(),
                    "{:?} at {at:?} of {:#?}",
                    cell.symbol(),
                    super::rows(&buffer)
                );
            }
        }
    }
}

#[test]
fn ascii_screens_know_every_letter() {
    let look = RenderStyle { theme: Theme::dark(ColourDepth::Ansi16), glyphs: Glyphs::Ascii };
    for entry in nonempty(catalog().entries()) {
        let mut app = lab(&entry.name, 1.0);
        for keys in ["1", "2", "3", "4", "9"] {
            press(&mut app, keys);
            let text = super::rows(&screen(&app, &look, (160, 250))).join("\n");
            let strange: Vec<&str> =
                text.lines().filter(|l| l.replace("? help", "").contains('?')).collect();
            assert!(strange.is_empty(), "{}: {strange:#?}", entry.name);
        }
    }
}

#[test]
fn screens_without_colour_have_none() {
    let look = RenderStyle { theme: Theme::dark(ColourDepth::None), glyphs: Glyphs::Braille };
    for app in everything() {
        for size in [(40, 10), (80, 24), (120, 40)] {
            for cell in &screen(app, &look, size).content {
                assert_eq!((cell.fg, cell.bg), (Color::Reset, Color::Reset), "{:?}", cell.symbol());
            }
        }
    }
}

#[test]
fn screens_of_few_colours_have_no_others() {
    for (depth, most) in [(ColourDepth::Ansi16, 0), (ColourDepth::Ansi256, 255)] {
        let look = RenderStyle { theme: Theme::dark(depth), glyphs: Glyphs::Braille };
        for app in everything() {
            for cell in &screen(app, &look, (120, 40)).content {
                let fits = match cell.fg {
                    Color::Rgb(..) => false,
                    Color::Indexed(index) => index <= most && most > 0,
                    _ => true,
                };
                assert!(fits && cell.bg == Color::Reset, "{:?} at {depth:?}", cell.fg);
            }
        }
    }
}

/// A size that was once too narrow for a list beside a plot.
#[test]
fn a_size_between_two_layouts_is_no_panic() {
    for app in everything() {
        let (buffer, _) = super::drawn(app, &super::rich(), (64, 19));
        assert!(buffer.content.iter().any(|cell| cell.symbol() != " "));
    }
}

proptest! {
    #![proptest_config(cases(48))]

    #[test]
    fn no_size_is_a_panic(
        width in 0..250_u16,
        height in 0..250_u16,
        glyphs in 0..Glyphs::ALL.len(),
        first in 0..4_usize,
    ) {
        let glyphs = Glyphs::ALL[glyphs];
        let look = RenderStyle { theme: Theme::dark(ColourDepth::Ansi256), glyphs };
        for app in everything().iter().skip(first).step_by(4) {
            let mut app = app.clone();
            let (_, drawn) = super::drawn(&app, &look, (width, height));
            app.update(AppEvent::Drawn(drawn));
            press(&mut app, "End PageUp");
            screen(&app, &look, (width, height));
        }
    }

    #[test]
    fn no_small_size_is_a_panic(width in 0..70_u16, height in 0..20_u16) {
        for app in everything() {
            screen(app, &super::rich(), (width, height));
        }
    }

    #[test]
    fn no_number_is_a_panic(
        bits in prop::collection::vec(any::<u64>(), 40),
        // level curves take seconds where parameters or bounds are far from one
        odd_plane in prop::bool::weighted(0.05),
    ) {
        let mut numbers = bits.iter().map(|bits| f64::from_bits(*bits)).cycle();
        let mut number = || numbers.next().unwrap();
        let mut odd = snapshot(&pendulum(), 2.0);
        odd.time = number();
        odd.speed = number();
        if odd_plane {
            odd.parameters = odd.parameters.iter().map(|_| number()).collect();
            odd.bounds = odd.bounds.iter().map(|_| (number(), number())).collect();
        }
        odd.initial = odd.initial.iter().map(|_| number()).collect();
        odd.values = odd.values.iter().map(|_| number()).collect();
        let rows: Vec<Vec<f64>> =
            (0..20).map(|_| (0..=odd.values.len()).map(|_| number()).collect()).collect();
        odd.trail = Trail::from_rows(odd.values.len() + 1, &rows);
        let mut strange = gauge("energy", "E", number(), Verdict::Secular(number()));
        (strange.drift, strange.reference) = (number(), number());
        strange.history = (0..9).map(|_| number() as f32).collect();
        odd.gauges = [strange].into();
        odd.method.step = number();
        odd.method.tolerance = Some(number());
        let mut app = in_lab();
        app.update(AppEvent::Snapshot(Arc::new(odd)));
        for keys in ["", "Tab Tab Tab Tab z", "g", "4", "2"] {
            press(&mut app, keys);
            screen(&app, &super::rich(), (120, 40));
        }
    }
}
