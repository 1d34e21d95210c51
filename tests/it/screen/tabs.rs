//! The titles of lists that share a frame: the shown one is always there, and the others are where they are clicked; and the
//! words in a list, the same for the same.

use std::sync::Arc;

use phaselab::app::{AppEvent, HitTarget, Pane};
use phaselab::experiment::Verdict;
use phaselab::view::glyphs::Glyphs;
use phaselab::view::{RenderStyle, hit_test};
use ratatui::layout::Rect;

use super::{find, rich, rows, screen};
use crate::app::real::Real;
use crate::fixtures::{gauge, in_lab, pendulum, snapshot};

/// Each list, and a word that its frame begins with.
const LISTS: [(Pane, &str, &str); 4] = [
    (Pane::Parameters, "Parameters", "Param"),
    (Pane::Initial, "Initial", "Initial"),
    (Pane::Gauges, "Gauges", "Gauges"),
    (Pane::Law, "Law", "Law"),
];

#[test]
fn the_shown_list_is_named_in_its_frame_whatever_its_width() {
    let mut real = Real::of("pendulum");
    for style in [rich(), RenderStyle { glyphs: Glyphs::Ascii, ..rich() }] {
        // A lesson leaves the lab so many rows of a standard screen.
        for size in [(80, 15), (80, 14), (70, 14), (64, 12), (50, 22), (40, 24)] {
            for (pane, name, _) in LISTS {
                if let Some(lab) = &mut real.app.lab {
                    lab.focus.pane = pane;
                }
                let drawn = rows(&screen(&real.app, &style, size));
                let border = |row: &&String| row.contains('╭') || row.contains("+-");
                let titles: String = drawn.iter().filter(border).cloned().collect();
                assert!(titles.contains(name), "{name} at {size:?}: {drawn:#?}");
            }
        }
    }
}

#[test]
fn all_titles_fit_beside_a_plot_of_a_standard_screen_and_are_clicked_there() {
    let mut real = Real::of("pendulum");
    if let Some(lab) = &mut real.app.lab {
        lab.focus.pane = Pane::Gauges;
    }
    let size = (80, 15);
    let buffer = screen(&real.app, &rich(), size);
    for (pane, _, begins) in LISTS {
        let (x, y) = find(&buffer, begins).unwrap_or_else(|| panic!("{begins}"));
        let area = Rect::new(0, 0, size.0, size.1);
        let hit = hit_test(&real.app, &rich(), area, x + 1, y);
        assert_eq!(hit, Some(HitTarget::Pane(pane)), "{begins} of {:#?}", rows(&buffer));
    }
}

/// What is as high as wide is not drawn in a flat slot: two rows of two pictures then; a motion along a line has one.
#[test]
fn a_square_picture_has_a_square_slot() {
    for (name, rows_of_frames) in [
        ("symplectic-euler", 2),
        ("moving-axes", 2),
        ("thrown-ball", 2),
        ("another-momentum", 1),
        ("pendulum", 1),
    ] {
        let real = Real::of(name);
        let drawn = rows(&screen(&real.app, &rich(), (120, 40)));
        let corners = |row: &&String| row.chars().take(78).filter(|c| *c == '╭').count() == 2;
        assert_eq!(drawn.iter().filter(corners).count(), rows_of_frames, "{name}: {drawn:#?}");
    }
}

/// The equations of a chain of four are Lagrange's where the solved ones would fill hundreds of rows, and those of five bodies
/// are on page 2; both say where all are.
#[test]
fn long_equations_are_not_spread_out_in_the_pane() {
    for (name, said) in [
        ("chain-pendulum", "phaselab derive chain-pendulum"),
        ("solar-system", "15 equations of motion: page 2"),
    ] {
        let mut real = Real::of(name);
        if let Some(lab) = &mut real.app.lab {
            lab.focus.pane = Pane::Law;
            lab.focus.zoomed = true;
        }
        let drawn = rows(&screen(&real.app, &rich(), (120, 120))).join(" ");
        let words: Vec<&str> = drawn.split_whitespace().filter(|word| *word != "│").collect();
        assert!(words.join(" ").contains(said), "{name}: {drawn}");
    }
}

/// A picture that was brought into a slot stays there while another one is focused.
#[test]
fn a_tab_stays_while_another_picture_has_the_focus() {
    for size in [(120, 40), (80, 24)] {
        let mut real = Real::of("pendulum");
        real.run(30);
        let place =
            |kind: &str| real.lab().plots.iter().position(|plot| plot.kind.name() == kind).unwrap();
        let (potential, other) =
            (place("potential"), if size.0 == 80 { 0 } else { place("phase") });
        for index in [potential, other] {
            real.app.lab.as_mut().unwrap().focus.pane = Pane::Plot(index);
            real.app.update(AppEvent::Tick(std::time::Duration::ZERO));
        }
        let buffer = screen(&real.app, &rich(), size);
        let (x, y) = find(&buffer, "Potential").expect("a title or a tab");
        let hit = hit_test(&real.app, &rich(), Rect::new(0, 0, size.0, size.1), x + 2, y + 4);
        let shown = matches!(hit, Some(HitTarget::Plot { index, .. }) if index == potential);
        assert!(shown, "{hit:?} {:#?}", rows(&buffer));
    }
}

/// Where the names of all pictures do not fit, as many as do are there, the shown one among them, and the number of the
/// others; each is clicked where it stands, and the number leads to the next one.
#[test]
fn pictures_that_share_a_frame_are_named_as_far_as_there_is_room() {
    let size = (80, 24);
    let mut real = Real::of("planet");
    real.run(30);
    let count = real.lab().plots.len();
    let named = |real: &Real| {
        let top = rows(&screen(&real.app, &rich(), size))[1].clone();
        let frame = top.rsplit('╮').nth(1).unwrap().to_owned();
        let tabs = frame.trim_matches(|c: char| "╭─┏━ ".contains(c)).to_owned();
        tabs.split(" │ ").map(str::to_owned).collect::<Vec<String>>()
    };
    let first = named(&real);
    let others = first.last().and_then(|last| last.strip_prefix('+')).map(str::parse::<usize>);
    assert!(first.len() > 2, "{first:?}");
    // the other frame holds one picture
    assert_eq!(others, Some(Ok(count - 1 - (first.len() - 1))), "{first:?}");
    let buffer = screen(&real.app, &rich(), size);
    let (x, y) = find(&buffer, first.last().unwrap()).unwrap();
    let area = Rect::new(0, 0, size.0, size.1);
    let next = hit_test(&real.app, &rich(), area, x, y);
    let Some(HitTarget::Pane(Pane::Plot(index))) = next else { panic!("{next:?}") };
    real.app.lab.as_mut().unwrap().focus.pane = Pane::Plot(index);
    real.app.update(AppEvent::Tick(std::time::Duration::ZERO));
    let middle = hit_test(&real.app, &rich(), area, 60, 8);
    let is_shown = matches!(middle, Some(HitTarget::Plot { index: shown, .. }) if shown == index);
    assert!(is_shown, "{middle:?}");
    let second = named(&real);
    assert!(second.iter().all(|name| !name.contains('/')) && second.len() > 1, "{second:?}");
}

/// A verdict is reported in one way in a list: what varies is not called `varies` in one row and `not conserved` in the next.
#[test]
fn one_verdict_has_the_same_words_throughout_a_list() {
    let long = "a quantity with a long name";
    for (names, in_full) in [(["energy", "L"], true), (["energy", long], false)] {
        let mut app = in_lab();
        let mut seen = snapshot(&pendulum(), 2.0);
        let broken = || Verdict::Broken("−2F".to_owned());
        seen.gauges = names.map(|name| gauge(name, name, 1.0, broken())).into();
        app.update(AppEvent::Snapshot(Arc::new(seen)));
        let text = rows(&screen(&app, &rich(), (120, 40))).join("\n");
        assert_eq!(text.contains("not conserved"), in_full, "{text}");
        assert_eq!(text.contains("varies"), !in_full, "{text}");
    }
}
