//! Words that take the room they need: titles, the names of gauges, legends above a picture and not over it.

use std::sync::Arc;

use phaselab::app::AppEvent;
use phaselab::experiment::{Command, Gauge, Growth, Verdict};
use phaselab::system::InitialOverride::Position;

use super::{find, rich, rows, screen};
use crate::app::real::Real;
use crate::fixtures::{begun, catalog, gauge, lab, press, snapshot};

/// In 80 columns a long title takes the room of the last page, which help names, and of the gaps between the others.
#[test]
fn titles_of_the_shipped_presets_are_whole_in_80_columns() {
    let mut long = 0;
    for entry in catalog().entries() {
        let title = entry.info.title.clone();
        if title.chars().count() < 30 {
            continue;
        }
        long += 1;
        let mut app = lab(&entry.name, 0.5);
        let text = rows(&screen(&app, &rich(), (80, 24)));
        assert!(text[0].contains(&title), "{}", text[0]);
        for page in ["1 Lab", "2 Equations", "3 Notes", "4 Numbers"] {
            assert!(text[0].contains(page), "{}", text[0]);
        }
        press(&mut app, "9");
        let text = rows(&screen(&app, &rich(), (80, 24)));
        assert!(text[0].contains("9 Plain"), "the page on the screen is named: {}", text[0]);
    }
    assert!(long > 15, "{long} titles are long");
}

/// Where a name is long, verdicts take no more columns than their words, and a number that there is none of is no word.
#[test]
fn long_names_of_gauges_have_the_room_that_verdicts_leave() {
    let mut app = lab("damped-pendulum", 1.0);
    let mut seen = snapshot(&app.lab.as_ref().unwrap().loaded, 1.0);
    let exact = Verdict::Exact(Growth::Level);
    let name = "friction on the hoop";
    let others = (0..3).map(|k| gauge(&format!("g{k}"), &format!("g{k}"), 1.0, exact.clone()));
    let mut gauges: Vec<Gauge> = others.collect();
    gauges.push(gauge(name, name, -2.452, exact));
    seen.gauges = gauges.into();
    app.update(AppEvent::Snapshot(Arc::new(seen.clone())));
    let text = rows(&screen(&app, &rich(), (80, 24)));
    assert!(text.iter().any(|row| row.contains(&format!("{name}  "))), "{text:#?}");

    let other = Gauge { drift: f64::NAN, ..gauge("b", "β", 2.0, Verdict::OtherBranch) };
    seen.gauges = vec![other].into();
    app.update(AppEvent::Snapshot(Arc::new(seen)));
    for size in [(80, 24), (120, 40)] {
        let text = rows(&screen(&app, &rich(), size));
        assert!(text.iter().any(|row| row.contains("other branch")), "{text:#?}");
        assert!(!text.iter().any(|row| row.contains("unknown")), "{text:#?}");
    }
}

/// The names of two mechanics stand in a row of their own, which nothing is drawn in.
#[test]
fn a_legend_covers_nothing_of_the_picture() {
    for (name, words) in [
        ("rolling-disc", ["━ right mechanics", "━ wrong mechanics"]),
        ("knife-edge", ["━ right mechanics", "━ wrong mechanics"]),
        ("merry-go-round", ["→ centrifugal", "→ Coriolis"]),
    ] {
        let mut real = Real::of(name);
        for _ in 0..8 {
            real.run(45);
            let buffer = screen(&real.app, &rich(), (80, 24));
            let places = words.map(|word| find(&buffer, word).unwrap_or_else(|| panic!("{word}")));
            assert_eq!(places[0].1, places[1].1, "{name}");
            let from = places[0].0.saturating_sub(1);
            let row: String =
                (from..from + 38).map(|x| buffer[(x, places[0].1)].symbol()).collect();
            let dotted = |c: char| ('\u{2801}'..='\u{28ff}').contains(&c);
            assert!(!row.chars().any(dotted), "{name}: {row}");
        }
    }
}

/// A second motion of a body put together from pieces is drawn with its edges, in its colour.
#[test]
fn a_second_motion_of_a_body_is_drawn_with_its_body() {
    let look = rich();
    let style = look.theme.curve(4);
    let inks: Vec<_> =
        (0..=12).map(|far| look.theme.receding(style, f64::from(far) / 12.0).fg).collect();
    let mut real = Real::of("t-handle");
    let start = [Position(0, 300.0), Position(1, 900.0), Position(2, 900.0)];
    real.experiment.execute(Command::AddStart(start.to_vec()));
    real.run(60);
    let buffer = screen(&real.app, &look, (120, 40));
    let cells = (2..22).flat_map(|y| (1..39).map(move |x| (x, y)));
    let is_own =
        |at: &(u16, u16)| buffer[*at].symbol() != " " && inks.contains(&Some(buffer[*at].fg));
    // nothing else of it is in this picture
    let count = cells.filter(is_own).count();
    assert!(count > 15, "{count}: {:#?}", rows(&buffer));
}

/// The arrow of a vector has the colour of the trace it ends at, so that two of them are told apart.
#[test]
fn vectors_have_the_colours_of_their_traces() {
    let mut real = Real::of("kovalevskaya");
    real.run(120);
    let buffer = screen(&real.app, &rich(), (120, 40));
    let colours = ["M", "g"].map(|name| {
        let mut cells = (2..22).flat_map(|y| (41..79).map(move |x| (x, y)));
        let at = cells.find(|at| buffer[*at].symbol() == name);
        buffer[at.unwrap_or_else(|| panic!("{name}: {:#?}", rows(&buffer)))].fg
    });
    assert_ne!(colours[0], colours[1]);
}

/// Several vectors from one foot are different things: none has the colour of another, whether a trace is at its tip or not.
#[test]
fn vectors_from_one_foot_have_colours_of_their_own() {
    for (preset, names) in [
        ("rotations", &["e₁", "e₂", "e₃", "n"][..]),
        ("charge-in-fields", &["E", "B"]),
        ("kepler-brackets", &["L", "A"]),
    ] {
        let mut real = Real::of(preset);
        real.run(120);
        let buffer = screen(&real.app, &rich(), (120, 40));
        let text = rows(&buffer);
        let colours: Vec<_> = names
            .iter()
            .map(|name| {
                let letters: Vec<String> = name.chars().map(String::from).collect();
                let mut cells = (2..26).flat_map(|y| (1..39).map(move |x| (x, y)));
                let at = cells.find(|(x, y)| {
                    let here = |(k, letter): (usize, &String)| {
                        buffer[(x + u16::try_from(k).unwrap(), *y)].symbol() == letter
                    };
                    let end = x + u16::try_from(letters.len()).unwrap();
                    let ends =
                        |x: u16| !buffer[(x, *y)].symbol().starts_with(char::is_alphanumeric);
                    letters.iter().enumerate().all(here) && ends(end) && ends(x - 1)
                });
                buffer[at.unwrap_or_else(|| panic!("{name}: {text:#?}"))].fg
            })
            .collect();
        for (k, colour) in colours.iter().enumerate() {
            assert!(!colours[..k].contains(colour), "{preset}: {names:?} {colours:?}");
        }
    }
}

/// Definitions that serve the drawing may be longer than a page when all others are substituted into them: they are named.
#[test]
fn definitions_too_long_to_be_read_are_named() {
    let mut app = lab("heavy-top", 0.5);
    press(&mut app, "2");
    let text = rows(&screen(&app, &rich(), (200, 60))).join("\n");
    assert!(text.contains("V_eff = "), "{text}");
    let named = "u_angle, u_upper, u_lower: too long when written out";
    assert!(text.contains(named) && !text.contains("arccos"), "{text}");
}

/// A sum of x and a parameter, with three characters between them.
#[test]
fn a_definition_is_written_out_up_to_two_hundred_characters() {
    for (length, is_written) in [(200, true), (201, false)] {
        let parameter = "p".repeat(length - "x + ".len());
        let mut app = begun(&format!(
            "title = \"Long\"\n[parameters]\n{parameter} = {{ value = 1 }}\n[coordinates]\nx = {{ initial = 0.3 }}\n\
             [definitions]\nD = \"x + {parameter}\"\n[lagrangian]\nL = \"1/2*x'^2 - 1/2*x^2\"\n"
        ));
        press(&mut app, "2");
        let text = rows(&screen(&app, &rich(), (120, 60))).join("\n");
        assert!(text.contains("Definitions of the file"), "{text}");
        assert_eq!(!text.contains("D: too long when written out"), is_written, "{text}");
    }
}
