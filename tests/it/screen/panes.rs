//! The contents of the panes, and their styles.

use std::sync::Arc;
use std::time::Duration;

use phaselab::app::{App, AppEvent, Drawn, DrawnPanes, LawInView, Notification, Pane, ValueId};
use phaselab::experiment::{Gauge, Growth, RunError, Status, Verdict};
use phaselab::instrument::{Plot, PotentialView};
use phaselab::integrate::{Occurrence, OccurrenceKind};
use phaselab::model::Shape;
use phaselab::system::ChannelKind;
use phaselab::view::RenderStyle;
use phaselab::view::colour::ColourDepth;
use phaselab::view::glyphs::Glyphs;
use phaselab::view::theme::{Role, Theme};
use ratatui::style::{Color, Modifier};

use super::{ascii, find, rich, rows, screen, screen_text};
use crate::app::real::Real;
use crate::fixtures::{
    at_picker, catalog, gauge, in_lab, in_lab_with, lab, loaded, lowered, pendulum, press, showing,
    snapshot,
};

#[test]
fn a_small_screen_says_how_large_it_must_be() {
    for size in [(39, 24), (80, 9), (20, 5)] {
        let text = rows(&screen(&in_lab(), &rich(), size)).join(" ");
        assert!(text.contains("40x10"), "{size:?}: {text}");
    }
    let buffer = screen(&in_lab(), &rich(), (40, 10));
    assert!(!rows(&buffer).join(" ").contains("needs"), "40x10 is enough");
}

#[test]
fn every_pane_of_a_large_screen_is_there() {
    let buffer = screen(&in_lab(), &rich(), (120, 40));
    for name in
        ["Motion", "Phase", "Time", "Parameters", "Initial values", "Gauges", "Law of motion"]
    {
        let (x, y) = find(&buffer, name).unwrap_or_else(|| panic!("{name} is missing"));
        assert_eq!(buffer[(x, y)].fg, rich().theme[Role::Title].fg.unwrap(), "{name}");
    }
    for text in ["1 Lab", "? help", "q quit", "taylor", "fps", "mass of the bob"] {
        assert!(find(&buffer, text).is_some(), "{text}");
    }
}

/// The help begins with the focused pane, and a search leaves what fits it; where there is room it has two columns.
#[test]
fn the_help_begins_here_and_is_searched() {
    let mut app = in_lab();
    press(&mut app, "Tab Tab Tab Tab ?");
    let text = rows(&screen(&app, &rich(), (80, 24)));
    assert!(text[2].contains("To begin with") && text[3].contains("pause or resume"), "{text:#?}");
    assert!(text.iter().any(|row| row.contains("Here: Plots")), "{text:#?}");
    let buffer = screen(&app, &rich(), (200, 60));
    let left = find(&buffer, "Here: Plots").expect("left");
    let right: String = (2..8)
        .flat_map(|y| (100..190).map(move |x| (x, y)))
        .map(|at| buffer[at].symbol())
        .collect();
    assert!(left.0 < 20 && right.chars().any(char::is_alphabetic), "{left:?} {right}");
    press(&mut app, "/ c u r s o r Space r e a d s");
    let buffer = screen(&app, &rich(), (80, 24));
    assert!(find(&buffer, "show or hide a cursor").is_some(), "{:#?}", rows(&buffer));
    assert!(find(&buffer, "stretch the horizontal").is_none());
    press(&mut app, "x x x");
    assert!(find(&screen(&app, &rich(), (80, 24)), "No match").is_some());
    press(&mut app, "Esc");
    let buffer = screen(&app, &rich(), (80, 24));
    assert!(find(&buffer, "Here: Plots").is_some() && find(&buffer, "No match").is_none());
}

/// The mouse is used from the start, so the help says what it does; and it is searched by words that no key has.
#[test]
fn the_help_tells_of_the_mouse_and_knows_other_words() {
    for (word, line) in [
        ("mouse", "begin the motion there"),
        ("drag", "a slider: change the value"),
        ("wheel", "zoom a plot or a picture"),
        ("click", "Shift-click"),
        ("conserved", "ask for a bracket"),
        ("stable", "find equilibria"),
        ("chaos", "Lyapunov exponent"),
    ] {
        let mut app = in_lab();
        press(&mut app, "? /");
        app.update(AppEvent::Paste(word.to_owned()));
        let buffer = screen(&app, &rich(), (120, 40));
        assert!(find(&buffer, line).is_some(), "{word}: {:#?}", rows(&buffer));
    }
}

/// The law of motion says how much of it is out of sight; then Tab reaches it, or the key for tabs, and arrows scroll it to its end.
#[test]
fn the_law_of_motion_scrolls_where_it_is_clipped() {
    for (size, keys) in [((120, 40), "Tab Tab Tab"), ((80, 24), "\\ \\"), ((40, 20), "\\ \\ \\")] {
        let mut app = lab("heavy-top", 1.0);
        let (_, drawn) = super::drawn(&app, &rich(), size);
        app.update(AppEvent::Drawn(drawn));
        press(&mut app, keys);
        assert_eq!(app.lab.as_ref().unwrap().focus.pane, Pane::Law, "{size:?}");
        let (buffer, drawn) = super::drawn(&app, &rich(), size);
        app.update(AppEvent::Drawn(drawn.clone()));
        let Some(LawInView::Clipped(beyond)) = drawn.panes.as_ref().map(|panes| panes.law) else {
            panic!("{size:?}: {drawn:?}")
        };
        assert!(find(&buffer, &format!("+{beyond} ↓")).is_some(), "{size:?} {:#?}", rows(&buffer));
        assert!(find(&buffer, "L = ").is_some(), "{size:?}");
        press(&mut app, "Down");
        assert_eq!(app.lab.as_ref().unwrap().law_scroll, 1);
        let buffer = screen(&app, &rich(), size);
        assert!(find(&buffer, &format!("+1 ↑ +{} ↓", beyond - 1)).is_some(), "{size:?}");
        press(&mut app, "End Down");
        assert_eq!(app.lab.as_ref().unwrap().law_scroll, beyond, "no further than its end");
        let buffer = screen(&app, &rich(), size);
        assert!(find(&buffer, &format!("+{beyond} ↑")).is_some(), "{size:?}");
        press(&mut app, "Home");
        assert_eq!(app.lab.as_ref().unwrap().law_scroll, 0);
    }
    // Where all of it is in view there is nothing to scroll, and Tab passes it by.
    let mut app = in_lab();
    let panes = DrawnPanes { single: false, ..DrawnPanes::default() };
    app.update(AppEvent::Drawn(Drawn { panes: Some(panes), ..Drawn::default() }));
    press(&mut app, "Shift-Tab");
    assert!(matches!(app.lab.as_ref().unwrap().focus.pane, Pane::Plot(_)));
}

/// On the smallest screen the motion is what is seen, with the status; a key goes to the other panes.
#[test]
fn on_the_smallest_screen_the_motion_comes_first() {
    for name in ["pendulum", "heavy-top", "double-well"] {
        let mut app = lab(name, 2.0);
        let (buffer, drawn) = super::drawn(&app, &rich(), (40, 10));
        assert!(find(&buffer, "Parameters").is_none(), "{name}: {:#?}", rows(&buffer));
        let dots = buffer
            .content
            .iter()
            .filter(|cell| cell.symbol().chars().any(|c| ('\u{2801}'..='\u{28ff}').contains(&c)));
        assert!(dots.count() > 5, "{name}: a picture");
        assert!(rows(&buffer)[8].contains("t 2"), "{name}: the status");
        app.update(AppEvent::Drawn(drawn));
        assert_eq!(
            app.lab.as_ref().unwrap().focus.pane,
            app.lab.as_ref().unwrap().motion().unwrap()
        );
        press(&mut app, "Shift-Tab");
        let buffer = screen(&app, &rich(), (40, 10));
        assert!(find(&buffer, "Gauges").is_some(), "{name}: {:#?}", rows(&buffer));
    }
    // Where there is room for more, the parameters have the focus.
    let mut app = in_lab();
    let (_, drawn) = super::drawn(&app, &rich(), (80, 24));
    app.update(AppEvent::Drawn(drawn));
    assert_eq!(app.lab.as_ref().unwrap().focus.pane, Pane::Parameters);
}

/// Without the footer the panes have its room; a value that is typed is seen all the same.
#[test]
fn a_footer_can_be_left_out() {
    let mut app = in_lab();
    let with = rows(&screen(&app, &rich(), (80, 24)));
    app.footer.shown = false;
    let without = rows(&screen(&app, &rich(), (80, 24)));
    assert!(with[23].contains("quit") && with[22].contains("fps"));
    assert!(without[23].starts_with('╰') || without[23].starts_with('└'), "{without:#?}");
    assert!(!without.join("").contains("fps") && !without.join("").contains("quit"));
    press(&mut app, "Enter");
    let typing = rows(&screen(&app, &rich(), (80, 24)));
    assert!(typing[23].contains("m = "), "{typing:#?}");
}

/// A page longer than a wide screen is high continues in a second column, and no row of it is lost or shown twice.
#[test]
fn wide_pages_have_two_columns() {
    let mut app = in_lab();
    press(&mut app, "?");
    let (_, drawn) = super::drawn(&app, &rich(), (200, 30));
    assert!(drawn.beyond > 0 && drawn.rows == 2 * 25, "{drawn:?}");
    let mut seen = String::new();
    let mut scroll = 0;
    while scroll <= drawn.beyond {
        app.text.scroll = scroll;
        let buffer = screen(&app, &rich(), (200, 30));
        let text = rows(&buffer);
        let part = |from: usize, to: usize| -> Vec<String> {
            let cut = |row: &String| row.chars().skip(from).take(to - from).collect();
            text[2..27].iter().map(cut).collect()
        };
        for row in part(2, 99).into_iter().chain(part(101, 198)) {
            seen += row.trim();
            seen += "\n";
        }
        scroll += drawn.rows;
    }
    app.text.scroll = drawn.beyond;
    seen += &screen_text(&app, (200, 30));
    for row in phaselab::app::keymap::KEYS {
        let begins: String = row.help.chars().take(40).collect();
        assert!(seen.contains(begins.trim()), "{}", row.help);
    }
}

#[test]
fn a_standard_screen_is_whole() {
    let buffer = screen(&in_lab(), &rich(), (80, 24));
    for text in
        ["Motion", "Phase", "Parameters", "Initial values", "Gauges", "θ₀", "exact", "quit", "fps"]
    {
        let exact = gauge("energy", "E", 1.0, Verdict::Exact(Growth::Level));
        let app = in_lab_with(|seen| seen.gauges = [exact].into());
        let buffer = if text == "exact" { screen(&app, &rich(), (80, 24)) } else { buffer.clone() };
        assert!(find(&buffer, text).is_some(), "{text} in {:#?}", rows(&buffer));
    }
}

#[test]
fn the_selected_value_is_marked_and_its_pane_framed() {
    let look = rich();
    let buffer = screen(&in_lab(), &look, (120, 40));
    let (x, y) = find(&buffer, "Parameters").unwrap();
    assert_eq!(
        buffer[(x - 3, y)].fg,
        look.theme[Role::Focus].fg.unwrap(),
        "the frame of the focus"
    );
    let reversed = |cell: &ratatui::buffer::Cell| cell.modifier.contains(Modifier::REVERSED);
    let row: Vec<_> = (x..120).map(|x| &buffer[(x, y + 1)]).collect();
    let marked: String =
        row.iter().filter(|cell| reversed(cell)).map(|cell| cell.symbol()).collect();
    assert_eq!(marked.trim(), "1", "the value of m");
}

#[test]
fn the_separatrix_of_the_pendulum_is_drawn() {
    let look = rich();
    let buffer = screen(&in_lab(), &look, (120, 40));
    let separatrix = look.theme[Role::Separatrix].fg.unwrap();
    let cells = buffer.content.iter().filter(|cell| cell.fg == separatrix);
    assert!(cells.count() > 30, "the curve through the upright position");
}

#[test]
fn verdicts_have_their_colours() {
    let look = rich();
    for (verdict, word, role) in [
        (Verdict::Exact(Growth::Root), "exact", Role::Good),
        (Verdict::Bounded, "bounded", Role::Good),
        (Verdict::Secular(1e-9), "drifting", Role::Bad),
        (Verdict::Lost, "lost", Role::Bad),
        (Verdict::Broken("−2F".into()), "not conserved", Role::Warn),
    ] {
        let app = in_lab_with(|seen| seen.gauges = [gauge("energy", "E", 4.0, verdict)].into());
        for size in [(80, 24), (120, 40)] {
            let buffer = screen(&app, &look, size);
            let at = find(&buffer, word).unwrap_or_else(|| panic!("{word} at {size:?}"));
            assert_eq!(buffer[at].fg, look.theme[role].fg.unwrap(), "{word}");
        }
    }
}

/// A deviation from the law of motion is marked on every picture, and the status shows its size.
#[test]
fn a_departed_invariant_marks_the_picture() {
    for (verdict, drift, word) in [
        (Verdict::Lost, 0.3, "lost 30 %"),
        (Verdict::Bounded, 2.3e-4, "swings 2.3e-4"),
        (Verdict::Secular(1e-9), 5.0e-5, "off 5.0e-5"),
    ] {
        let mut app = in_lab();
        let mut seen = snapshot(&pendulum(), 2.0);
        let of =
            |left| Gauge { left, max_drift: drift, ..gauge("energy", "E", 4.0, verdict.clone()) };
        seen.gauges = [of(Some(1.5))].into();
        app.update(AppEvent::Snapshot(Arc::new(seen.clone())));
        for (look, size) in [(rich(), (80, 24)), (rich(), (120, 40)), (ascii(), (80, 24))] {
            let rows = rows(&screen(&app, &look, size));
            let name = if look.glyphs.is_ascii() { "energy" } else { "E" };
            let word = if look.glyphs.is_ascii() {
                word.to_owned()
            } else {
                word.replace("e-4", "×10⁻⁴").replace("e-5", "×10⁻⁵")
            };
            let mark = format!("! {name} {word}");
            assert!(rows.iter().any(|row| row.contains(&mark)), "{size:?}: {}", rows.join("\n"));
            assert!(
                rows.iter().any(|row| row.contains("! Phase")),
                "{size:?}: {}",
                rows.join("\n")
            );
        }
        seen.gauges = [of(None)].into();
        app.update(AppEvent::Snapshot(Arc::new(seen)));
        let rows = rows(&screen(&app, &rich(), (80, 24)));
        assert!(!rows.iter().any(|row| row.contains("! ")), "{}", rows.join("\n"));
    }
}

#[test]
fn a_velocity_has_a_prime_in_a_cell_of_its_own() {
    let buffer = screen(&in_lab(), &rich(), (120, 40));
    let (x, y) = find(&buffer, "θ′ ").unwrap();
    assert_eq!([buffer[(x, y)].symbol(), buffer[(x + 1, y)].symbol()], ["θ", "′"]);
}

#[test]
fn nothing_jumps_while_numbers_change() {
    let column = |time: f64, text: &str| {
        let app = in_lab_with(|seen| {
            (seen.time, seen.recorded.to, seen.method.step) = (time, time, time / 1e4);
        });
        find(&screen(&app, &rich(), (120, 40)), text).map(|(x, _)| x)
    };
    for text in ["speed", "taylor", "steps/s", "fps"] {
        let still = column(1.25, text);
        assert!(still.is_some(), "{text}");
        for time in [0.001_234_5, 12.345, 4_321.987, 54_321.0] {
            assert_eq!(column(time, text), still, "{text} at t = {time}");
        }
    }
}

#[test]
fn an_error_in_a_field_is_read_beside_it() {
    let mut app = in_lab();
    press(&mut app, "Enter Ctrl-u 2 x Enter");
    let look = rich();
    let buffer = screen(&app, &look, (120, 40));
    let at = find(&buffer, "`2x` is not a number").unwrap();
    assert_eq!(buffer[at].fg, look.theme[Role::Bad].fg.unwrap());
    assert!(find(&buffer, "m = 2x").is_some(), "what was typed is still there");
}

#[test]
fn status_and_error_are_reported() {
    let shown = |status: Status| screen_text(&in_lab_with(|seen| seen.status = status), (120, 40));
    let failed = |time: f64, message: &str| {
        let message = message.to_owned();
        shown(Status::Failed(RunError { time, message, ends_motion: true }))
    };
    assert!(shown(Status::Paused).contains("paused"));
    let text = failed(2.0, "the bob left the world");
    for part in
        ["stopped", "The motion cannot continue", "The bob left the world", "r back to the start"]
    {
        assert!(text.contains(part), "{part}: {text}");
    }
    // at the start nothing leads back
    let text = failed(0.0, "no velocities");
    for part in ["The motion cannot begin", "No velocities", "E edit the file"] {
        assert!(text.contains(part), "{part}: {text}");
    }
}

#[test]
fn the_cursor_reads_the_cell_it_stands_on() {
    let mut app = in_lab();
    press(&mut app, "Tab Tab Tab Tab c");
    let plot = &app.lab.as_ref().unwrap().plots[1];
    assert_eq!((plot.kind.name(), plot.viewport().unwrap().cursor), ("phase", Some([0.5, 0.5])));
    let buffer = screen(&app, &rich(), (120, 40));
    let (x, y) = find(&buffer, "┼").unwrap();
    assert!((40..80).contains(&x) && y < 24, "in the phase portrait");
    // The window is symmetric about (0, 0), whose cell is at most half a cell away.
    let reading: String = rows(&buffer)[2].chars().skip(40).take(40).collect();
    let numbers: Vec<f64> = reading
        .split([' ', ',', '│'])
        .filter_map(|word| word.replace('−', "-").parse().ok())
        .collect();
    assert_eq!(numbers.len(), 2, "{reading}");
    assert!(numbers[0].abs() < 0.2 && numbers[1].abs() < 0.8, "{numbers:?}");
}

/// The key that puts a cursor on a plot also takes it off.
#[test]
fn the_key_of_the_cursor_says_what_it_does() {
    let mut app = in_lab();
    press(&mut app, "Tab Tab Tab Tab");
    let last = |app: &App| rows(&screen(app, &rich(), (200, 40))).pop().unwrap();
    assert!(last(&app).contains("c cursor"), "{}", last(&app));
    press(&mut app, "c");
    assert!(last(&app).contains("c no cursor"), "{}", last(&app));
}

/// Why a key does nothing here is reported, but is no error.
#[test]
fn a_hint_has_not_the_colour_of_an_error() {
    let theme = rich().theme;
    for (keys, text) in [
        ("f", "This system has no frames"),
        ("Tab Tab Tab Tab A", "A motion is added at the cursor"),
        ("u", "Nothing to undo."),
    ] {
        let mut app = in_lab();
        press(&mut app, keys);
        let buffer = screen(&app, &rich(), (120, 40));
        let at = find(&buffer, text).unwrap_or_else(|| panic!("{:#?}", rows(&buffer)));
        assert_eq!(Some(buffer[at].fg), theme[Role::Text].fg.or(Some(Color::Reset)), "{text}");
        assert_ne!(Some(buffer[at].fg), theme[Role::Bad].fg, "{text}");
    }
}

#[test]
fn the_picker_shows_what_a_system_is() {
    let buffer = screen(&at_picker(), &rich(), (120, 40));
    for text in ["Simple pendulum", "A mass on a light rod", "§4.2", "separatrix", "Enter open"] {
        assert!(find(&buffer, text).is_some(), "{text}");
    }
    let mut app = at_picker();
    press(&mut app, "/ h e n o n");
    let buffer = screen(&app, &rich(), (120, 40));
    assert!(find(&buffer, "4 of ").is_some() && find(&buffer, "Hénon–Heiles").is_some());
    assert!(find(&buffer, "Damped pendulum").is_none());
}

#[test]
fn the_first_row_of_the_picker_is_the_session() {
    let (mut app, _) = App::new(catalog(), None);
    let mut real = Real::of("pendulum");
    real.run(60);
    app.offer_session(real.app.saved().unwrap());
    let time = format!(", t = {} s", (100.0 * real.seen().time).round() / 100.0);
    for size in [(80, 24), (120, 40)] {
        let text = screen_text(&app, size);
        assert!(text.contains(&format!("› Continue: Simple pendulum{time}")), "{text}");
        assert!(!text.contains("› Simple pendulum"), "{text}");
    }
    // where there is no room for both the title is shortened, not the time
    let text = screen_text(&app, (70, 24));
    assert!(text.contains(&format!("› Continue: Simple…{time}")), "{text}");
    press(&mut app, "Down");
    let text = screen_text(&app, (80, 24));
    assert!(text.contains("  Continue: Simple pendulum"), "{text}");
    press(&mut app, "/ p e n d");
    let text = screen_text(&app, (80, 24));
    assert!(!text.contains("Continue:"), "{text}");
}

#[test]
fn the_equations_are_written_in_mathematics() {
    let mut app = in_lab();
    press(&mut app, "2");
    let text = screen_text(&app, (120, 40));
    for line in ["L = ½ m l² θ′² + m g l cos θ", "p_θ = m l² θ′", "θ″ = −(g/l) sin θ", "∂L/∂t = 0"]
    {
        assert!(text.contains(line), "{line} in\n{text}");
    }
}

/// The energy is written once: where it is H, or h, it is called so from then on. And what the first line has said of a law that
/// contains the time is not said again.
#[test]
fn the_page_of_equations_writes_an_energy_once() {
    let page = |name: &str| {
        let mut app = lab(name, 1.0);
        press(&mut app, "2");
        screen_text(&app, (160, 90))
    };
    let oscillator = page("harmonic-oscillator");
    assert_eq!(oscillator.matches("p_x²/(2 m) + ½ k x²").count(), 1, "{oscillator}");
    assert!(oscillator.contains("E = H ") && oscillator.contains("dH/dt = 0"), "{oscillator}");
    let planet = page("planet");
    assert_eq!(planet.matches("½ m (r′² + r² θ′²) − k/r").count(), 1, "{planet}");
    assert!(planet.contains("E = h "), "{planet}");
    let shaken = page("kapitza");
    assert_eq!(shaken.matches("a law that contains the time").count(), 1, "{shaken}");
    assert!(shaken.contains("Press I to search further."), "{shaken}");
}

#[test]
fn what_happened_is_marked_where_it_was_and_named() {
    let mut seen = snapshot(&pendulum(), 2.0);
    let impulse = |time: f64| Occurrence {
        name: "push".to_owned(),
        event: None,
        time,
        kind: OccurrenceKind::Mark,
    };
    seen.occurrences = [0.5, 1.0, 1.0005].map(impulse).into_iter().collect();
    let mut app = in_lab();
    let look = rich();
    let signs = |buffer: &ratatui::buffer::Buffer| {
        let warn = look.theme[Role::Warn].fg.unwrap();
        buffer.content.iter().filter(|c| c.symbol() == "◆" && c.fg == warn).count()
    };
    assert_eq!(signs(&screen(&app, &look, (120, 40))), 0);
    app.update(AppEvent::Snapshot(Arc::new(seen)));
    let buffer = screen(&app, &look, (120, 40));
    // on the phase portrait and on the time series, and in the heading that has room; two that coincide are one
    assert_eq!(signs(&buffer), 2 + 2 + 1, "{:#?}", rows(&buffer));
    assert!(find(&buffer, "◆ push").is_some());
    // the mark of t = 1 in the time series is above that time
    press(&mut app, "Shift-Tab Shift-Tab z");
    let buffer = screen(&app, &look, (120, 40));
    let columns: Vec<u16> =
        (1..120).filter(|&x| (2..38).any(|y| buffer[(x, y)].symbol() == "◆")).collect();
    let zero = find(&buffer, "└").unwrap().0 + 1;
    let width = 118 - zero;
    let wanted = [0.5, 1.0].map(|t: f64| zero + (t / 2.5 * f64::from(width)) as u16);
    assert_eq!(columns.len(), 2, "{columns:?}");
    assert!(columns.iter().zip(wanted).all(|(x, w)| x.abs_diff(w) <= 1), "{columns:?} {wanted:?}");
}

#[test]
fn an_ended_motion_says_by_what_and_how_to_go_on() {
    let app = in_lab_with(|seen| seen.status = Status::Ended("ground".to_owned()));
    for size in [(80, 24), (120, 40), (200, 60)] {
        let buffer = screen(&app, &rich(), size);
        assert!(find(&buffer, "ended at: ground; r restarts").is_some(), "{size:?}");
    }
}

#[test]
fn the_prompt_answers_in_mathematics_and_places_errors() {
    let ask = |text: &str| {
        let mut app = in_lab();
        press(&mut app, "{");
        app.update(AppEvent::Paste(text.to_owned()));
        press(&mut app, "Enter");
        app
    };
    for size in [(80, 24), (120, 40), (200, 60)] {
        let buffer = screen(&ask("theta, p_theta"), &rich(), size);
        assert!(find(&buffer, "[theta, p_theta] = 1").is_some(), "{:#?}", rows(&buffer));
        assert!(find(&buffer, "It is not identically zero").is_some(), "{size:?}");
        let buffer = screen(&ask("p_theta, H"), &rich(), size);
        assert!(find(&buffer, "= −m g l sin θ").is_some() || find(&buffer, "sin θ").is_some());
        let buffer = screen(&ask("H"), &rich(), size);
        assert!(find(&buffer, "Conserved: proved").is_some(), "{:#?}", rows(&buffer));
        let buffer = screen(&ask("theta, p_theta*lenght"), &rich(), size);
        let (x, y) = find(&buffer, "lenght").unwrap();
        assert_eq!(find(&buffer, "^^^^^^"), Some((x, y + 1)), "{:#?}", rows(&buffer));
        let bad = rich().theme[Role::Bad].fg.unwrap();
        assert_eq!(buffer[(x, y + 1)].fg, bad);
        assert_eq!(buffer[(find(&buffer, "? theta").unwrap().0, y + 2)].fg, bad, "and why");
    }
}

#[test]
fn a_picture_may_be_seen_from_a_frame() {
    let mut app = lab("merry-go-round", 2.0);
    let buffer = screen(&app, &rich(), (120, 40));
    assert!(find(&buffer, "From the ground").is_some());
    assert!(find(&buffer, "From the merry-go-round").is_some());
    for force in ["→ centrifugal", "→ Coriolis"] {
        let (x, _) = find(&buffer, force).unwrap_or_else(|| panic!("{:#?}", rows(&buffer)));
        let (from, _) = find(&buffer, "From the merry-go-round").unwrap();
        assert!(x + 4 > from, "only in the frame's own picture");
    }
    assert!(find(&buffer, "Euler").is_none(), "it turns evenly");
    // the first picture also rotates when asked to, and back
    press(&mut app, "Tab Tab Tab f z");
    let buffer = screen(&app, &rich(), (120, 40));
    assert!(find(&buffer, "seen from merry-go-round").is_some(), "{:#?}", rows(&buffer));
    press(&mut app, "f");
    assert!(find(&screen(&app, &rich(), (120, 40)), "From the ground").is_some());
}

/// The rows of the screen with the picture of the T-handle at this attitude, A by rows, after these keys in it.
fn t_handle(matrix: [f64; 9], keys: &str) -> Vec<String> {
    let handle = loaded("t-handle", 1);
    let mut now = snapshot(&handle, 1.0);
    let mut values = now.values.to_vec();
    for (i, channel) in handle.system.channels().iter().enumerate() {
        if let ChannelKind::Attitude(k) = channel.kind {
            values[i] = matrix[k];
        }
    }
    now.values = values.into();
    let mut app = lab("t-handle", 1.0);
    app.update(AppEvent::Snapshot(Arc::new(now)));
    let lab = app.lab.as_ref().unwrap();
    let drawn = |plot: &Plot| {
        let Some(eye) = plot.eye() else { return false };
        eye.shapes(&handle.model).iter().any(|shape| matches!(shape, Shape::Body { .. }))
    };
    let place = lab.plots.iter().position(drawn).unwrap();
    press(&mut app, &["Tab"].repeat(3 + place).join(" "));
    press(&mut app, keys);
    rows(&screen(&app, &rich(), (120, 40)))
}

#[test]
fn a_body_seen_from_itself_stands_still() {
    let picture = |matrix, keys: &str| t_handle(matrix, keys).concat();
    let still = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    assert!(picture(still, "z").contains("Motion") && picture(still, "z f").contains("the body"));
    // the fraction of the cells that a quarter turn does not change: all but the arrow of L, which
    // rotates instead
    let turned = [0.0, 1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    let kept = |keys: &str| {
        let (before, after) = (picture(still, keys), picture(turned, keys));
        let drawn = |c: char| ('⠁'..='⣿').contains(&c) || ('▀'..='▟').contains(&c);
        let all = before.chars().filter(|c| drawn(*c)).count();
        let same = before.chars().zip(after.chars()).filter(|(a, b)| a == b && drawn(*a)).count();
        same as f64 / all as f64
    };
    let (from_space, from_body) = (kept("z"), kept("z f"));
    assert!(from_body > 0.8 && from_space < 0.5, "{from_body} of {from_space}");
}

/// Seen from itself a body is about as large as in space, though its own frame turns any way.
#[test]
fn a_body_seen_from_itself_keeps_its_size() {
    let few = RenderStyle { theme: Theme::dark(ColourDepth::Ansi16), glyphs: Glyphs::Braille };
    for name in ["t-handle", "free-rigid-body"] {
        let mut real = Real::of(name);
        real.run(300);
        press(&mut real.app, "Tab Tab Tab z");
        let mut drawn = |keys: &str| {
            press(&mut real.app, keys);
            let screen = rows(&screen(&real.app, &few, (120, 40)));
            screen.concat().chars().filter(|c| ('⠁'..='⣿').contains(c)).count() as f64
        };
        let (from_space, from_body) = (drawn(""), drawn("f"));
        assert!(from_body > 0.6 * from_space, "{name}: {from_body} of {from_space}");
    }
}

#[test]
fn a_potential_is_drawn_with_the_energy_and_where_the_motion_is_allowed() {
    let planet = loaded("planet", 1);
    let mut app = lab("planet", 2.0);
    let mut now = snapshot(&planet, 2.0);
    // a circle-like motion between r = 0.8 and 1.4, as bounds and now
    let place = |kind| planet.system.channels().iter().position(|c| c.kind == kind).unwrap();
    let (r, energy) = (place(ChannelKind::Position(0)), place(ChannelKind::Energy));
    let mut bounds = now.bounds.to_vec();
    bounds[r] = (0.8, 1.4);
    now.bounds = bounds.into();
    let potential = |app: &phaselab::app::App, r: f64| {
        let lab = app.lab.as_ref().unwrap();
        let view = lab.loaded.model.views.iter().position(|v| v.kind == "potential");
        PotentialView::of(lab.loaded.physics(), view.unwrap()).unwrap().along(
            &lab.loaded.model.pool,
            &lab.valuation(),
            &[r],
        )[0]
    };
    app.update(AppEvent::Snapshot(Arc::new(now.clone())));
    // V_eff = V + p²/(2 m r²): p is constant, so doubling r divides the wall by four
    let lab = app.lab.as_ref().unwrap();
    let symbol = |name: &str| lab.valuation().at(planet.model.pool.find_symbol(name).unwrap());
    let (m, p) = (symbol("m"), symbol("p_theta"));
    let wall = |r: f64| p * p / (2.0 * m * r * r);
    let attraction = |r: f64| potential(&app, r) - wall(r);
    for r in [0.5, 1.0, 3.0] {
        let ratio = attraction(r) / attraction(2.0 * r);
        assert!((ratio - 2.0).abs() < 1e-10, "{ratio}");
    }
    let mut values = now.values.to_vec();
    values[energy] = 0.5 * potential(&app, 1.0);
    now.values = values.into();
    app.update(AppEvent::Snapshot(Arc::new(now)));
    let look = rich();
    for size in [(80, 24), (120, 40), (200, 60)] {
        let buffer = screen(&app, &look, size);
        assert!(find(&buffer, "Potential").is_some(), "{:#?}", rows(&buffer));
        let warn = look.theme[Role::Warn].fg.unwrap();
        let level = buffer.content.iter().filter(|c| c.fg == warn).count();
        assert!(level >= 5, "the energy between the turning points: {level} cells");
    }
}

/// Over an angle, the energy is a line between the turning points, however wide the well is: m = l = 1, so they are ±θ₀.
#[test]
fn the_energy_reaches_from_one_turning_point_of_a_pendulum_to_the_other() {
    for start in [0.5, 2.0, 3.0] {
        let mut real = Real::of("pendulum");
        let effects = real.app.give(ValueId::Initial(0), start);
        real.execute(effects);
        real.look();
        let lab = real.app.lab.as_mut().unwrap();
        let potential = lab.plots.iter().position(|plot| plot.kind.name() == "potential");
        (lab.focus.pane, lab.focus.zoomed) = (Pane::Plot(potential.expect("a potential")), true);
        let buffer = screen(&real.app, &rich(), (120, 40));
        let warn = rich().theme[Role::Warn].fg.unwrap();
        let amber = |y: u16| -> Vec<u16> {
            (2..118)
                .filter(|x| buffer[(*x, y)].fg == warn && buffer[(*x, y)].symbol() != " ")
                .collect()
        };
        let line = (3..36).map(amber).max_by_key(Vec::len).unwrap();
        let wide = start / std::f64::consts::PI;
        let share = line.len() as f64 / 112.0;
        assert!((share - wide).abs() < 0.1, "{share} of the width instead of {wide}: {line:?}");
        assert!(line.windows(2).all(|pair| pair[1] - pair[0] <= 3), "without a gap: {line:?}");
    }
}

/// Over a distance the window is from the start where the motion will come: from a(1 − e) = 0.4 to a(1 + e) = 1.6. It stays the same
/// on the way, and an orbit without a way back has none beyond where it has come.
#[test]
fn a_potential_shows_both_turning_points_before_the_motion_reaches_them() {
    let mut real = Real::of("planet");
    let ticks = |real: &mut Real| -> Vec<f64> {
        real.look();
        let lab = real.app.lab.as_mut().unwrap();
        let potential = lab.plots.iter().position(|plot| plot.kind.name() == "potential");
        (lab.focus.pane, lab.focus.zoomed) = (Pane::Plot(potential.expect("a potential")), true);
        let text = rows(&screen(&real.app, &rich(), (120, 40)));
        let axis = text.iter().rposition(|row| row.contains('┬')).expect("an axis");
        let numbers = text[axis + 1].split_whitespace();
        numbers.filter_map(|word| word.trim_matches('│').parse().ok()).collect()
    };
    let first = ticks(&mut real);
    assert!(first.len() > 3 && first[0] < 0.41 && first[first.len() - 1] > 1.59, "{first:?}");
    for frames in [5, 60, 60] {
        real.run(frames);
        assert_eq!(ticks(&mut real), first);
    }
    // at the perihelion the velocity of this ellipse is beyond that of escape from half of the sun
    let mut real = Real::of("planet");
    let effects = real.app.give(ValueId::Parameter(1), 20.0);
    real.execute(effects);
    let open = ticks(&mut real);
    assert!(open.len() > 1 && open[open.len() - 1] < 1.0, "{open:?}");
}

#[test]
fn a_body_is_drawn_as_it_stands() {
    // inside the frame: its heading and the lines below are the same for all
    let picture = |matrix| t_handle(matrix, "z")[2..37].to_vec();
    let cells = |rows: &[String]| {
        rows.iter().flat_map(|row| row.chars()).filter(|c| ('⠁'..='⣿').contains(c)).count()
    };
    let upright = picture([1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
    assert!(cells(&upright) > 100, "{upright:#?}");
    let turned = picture([0.0, 1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
    assert_ne!(upright, turned, "a quarter turn about z");
    let nowhere = cells(&picture([f64::NAN; 9]));
    assert!(
        2 * nowhere < cells(&upright),
        "without an attitude there is no body to draw: {nowhere}"
    );
}

#[test]
fn news_are_reported_one_after_the_other_and_leave_the_hints_room() {
    let mut app = in_lab();
    let mut seen = snapshot(&pendulum(), 2.5);
    seen.notices = ["old notice", "the bob passed", "the bob came back"].map(str::to_owned).into();
    let mut before = seen.clone();
    before.notices = ["old notice".to_owned()].into();
    app.update(AppEvent::Snapshot(Arc::new(before)));
    app.update(AppEvent::Tick(Duration::from_secs(6)));
    app.update(AppEvent::Snapshot(Arc::new(seen)));
    for notifications in ["the bob passed", "the bob came back"] {
        let rows = rows(&screen(&app, &rich(), (80, 24)));
        assert!(rows[21].contains(notifications), "{rows:#?}");
        assert!(rows[23].contains("? help") && rows[23].contains("q quit"), "{rows:#?}");
        app.update(AppEvent::Tick(Duration::from_millis(2100)));
    }
    app.update(AppEvent::Tick(Duration::from_secs(6)));
    assert_eq!(app.notifications.shown, None);
}

#[test]
fn a_frame_is_chosen_from_any_pane() {
    let mut app = lab("merry-go-round", 2.0);
    let buffer = screen(&app, &rich(), (120, 40));
    assert!(find(&buffer, "f frame").is_some(), "the hint stands where parameters are focused");
    press(&mut app, "f");
    let first = &app.lab.as_ref().unwrap().plots[0];
    assert!(first.eye().is_some_and(|eye| eye.frame.is_some()), "{first:?}");
}

#[test]
fn the_reason_of_a_gauge_is_read_in_full_where_it_is_narrow() {
    let mut long = gauge("energy", "E", 4.0, Verdict::Bounded);
    long.reason = "∂L/∂t = 0, and no force does work that would not be in the potential".to_owned();
    let mut app = in_lab_with(|seen| seen.gauges = [long].into());
    press(&mut app, "Tab Tab");
    for size in [(80, 24), (120, 40)] {
        let buffer = screen(&app, &rich(), size);
        let text = rows(&buffer).join(" ");
        for word in ["would not be", "potential;", "oscillates"] {
            assert!(text.contains(word), "{word} at {size:?} in {:#?}", rows(&buffer));
        }
    }
}

#[test]
fn a_view_of_any_kind_is_called_what_the_file_calls_it() {
    let text = "title = 'a test'\n[coordinates]\nx = { initial = 1.0 }\n[lagrangian]\n\
        L = \"1/2*x'^2 - x^2\"\n[[views]]\nkind = 'phase'\nx = 'x'\ny = 'p_x'\n\
        title = 'The plane'\n[[views]]\nkind = 'time'\ny = 'x'\ntitle = 'The swing'\n\
        [[views]]\nkind = 'space'\ntitle = 'The track'\n[[views]]\nkind = 'potential'\n\
        x = 'x'\ny = 'x^2'\ntitle = 'The well'\n[space]\nshapes = [{ mass = ['x', '0', '0'] }]\n";
    let mut app = showing(lowered(text), 1.0);
    let buffer = screen(&app, &rich(), (200, 60));
    for title in ["The plane", "The swing", "The track", "The well"] {
        let (x, y) = find(&buffer, title).unwrap_or_else(|| panic!("{:#?}", rows(&buffer)));
        assert_eq!(buffer[(x, y)].fg, rich().theme[Role::Title].fg.unwrap());
    }
    press(&mut app, ": s w i n g Enter");
    assert_eq!(app.lab.as_ref().unwrap().focused_plot().unwrap().1.kind.name(), "time");
}

#[test]
fn a_narrow_screen_shows_the_motion_too() {
    let braille = |buffer: &ratatui::buffer::Buffer| {
        let drawn = |c: char| ('⠁'..='⣿').contains(&c) || c == '●';
        buffer.content.iter().filter(|cell| cell.symbol().starts_with(drawn)).count()
    };
    for size in [(60, 24), (50, 20), (70, 24), (79, 24)] {
        let buffer = screen(&in_lab(), &rich(), size);
        assert!(find(&buffer, "Motion").is_some(), "{size:?} {:#?}", rows(&buffer));
        assert!(braille(&buffer) > 10, "{size:?}");
    }
    let buffer = screen(&at_picker(), &rich(), (60, 30));
    assert!(braille(&buffer) > 10, "the preview below the list: {:#?}", rows(&buffer));
}

#[test]
fn several_curves_are_told_apart_without_colour() {
    let mut app = in_lab();
    press(&mut app, "Tab Tab Tab v Down Down Enter Tab Down Tab Down Tab Enter z");
    for glyphs in [Glyphs::Braille, Glyphs::HalfBlock, Glyphs::Ascii] {
        let look = RenderStyle { theme: Theme::dark(ColourDepth::None), glyphs };
        let buffer = screen(&app, &look, (120, 40));
        let samples = [0, 1, 2].map(|i| {
            let [unicode, ascii] = look.theme.series(i).dash.sample();
            glyphs.pick(unicode, ascii)
        });
        for sample in samples {
            let (_, row) = find(&buffer, &format!("  {sample} ")).expect("a sample in the heading");
            assert_eq!(row, 1, "{sample}");
        }
    }
}

#[test]
fn the_theme_under_the_selection_is_previewed_and_taken_by_enter() {
    let look = rich();
    let title = |app: &App| {
        let buffer = screen(app, &look, (120, 40));
        let at = find(&buffer, "phaselab").unwrap();
        buffer[at].fg
    };
    let accent = |name: &str| {
        let theme = Theme::named(name, ColourDepth::True).unwrap();
        theme[Role::Accent].fg.unwrap()
    };
    let mut app = in_lab();
    assert_eq!(title(&app), accent("dark"));
    press(&mut app, "T Down");
    assert_eq!(title(&app), accent("light"), "seen before it is taken");
    press(&mut app, "Esc");
    assert_eq!(title(&app), accent("dark"), "and left again");
    press(&mut app, "T Down Down Enter");
    assert_eq!(title(&app), accent("contrast"));
}

#[test]
fn without_colour_what_is_selected_is_reversed_in_every_list() {
    let look = RenderStyle { theme: Theme::dark(ColourDepth::None), glyphs: Glyphs::Braille };
    for keys in ["", "Tab", "m", ":", "T", "Tab Tab Tab v"] {
        let mut app = in_lab();
        press(&mut app, keys);
        let buffer = screen(&app, &look, (80, 24));
        let reversed = buffer.content.iter().filter(|c| c.modifier.contains(Modifier::REVERSED));
        assert!(reversed.count() > 4, "{keys}: {:#?}", rows(&buffer));
    }
}

/// Width and height, in dots, of the drawing in a zoomed pane; dots are as wide as high.
fn extent(buffer: &ratatui::buffer::Buffer) -> [f64; 2] {
    let mut ends = [i32::MAX, i32::MIN, i32::MAX, i32::MIN];
    for y in 2..buffer.area.height - 3 {
        for x in 1..buffer.area.width - 1 {
            let symbol = buffer[(x, y)].symbol().chars().next().unwrap_or(' ');
            let Some(dots) = u32::from(symbol).checked_sub(0x2800).filter(|d| *d < 256) else {
                continue;
            };
            // Bits of the braille block: columns of three, then the lowest row.
            for bit in (0..8).filter(|bit| dots & (1 << bit) != 0) {
                let (column, row) = if bit < 6 { (bit / 3, bit % 3) } else { (bit - 6, 3) };
                let (x, y) = (2 * i32::from(x) + column, 4 * i32::from(y) + row);
                ends = [ends[0].min(x), ends[1].max(x), ends[2].min(y), ends[3].max(y)];
            }
        }
    }
    [f64::from(ends[1] - ends[0] + 1), f64::from(ends[3] - ends[2] + 1)]
}

#[test]
fn a_circular_orbit_is_round() {
    // A plane oscillator released on a circle of radius 1, in space and, one to one, in the plane of x and y.
    let text = "title = 'circle'\n[coordinates]\nx = { initial = 1.0 }\n\
        y = { initial = 0.0, velocity = 1.0 }\n[lagrangian]\n\
        L = \"1/2*(x'^2 + y'^2) - 1/2*(x^2 + y^2)\"\n[[views]]\nkind = 'space'\n\
        [[views]]\nkind = 'phase'\nx = 'x'\ny = 'y'\n\
        [space]\nshapes = [{ trace = ['x', 'y', '0'] }]\n";
    for keys in ["Tab Tab Tab z", "Tab Tab Tab Tab z"] {
        let mut real = crate::app::real::Real::with(lowered(text));
        real.run(400);
        real.press(keys);
        for size in [(80, 24), (120, 40), (200, 60)] {
            let [wide, high] = extent(&screen(&real.app, &rich(), size));
            assert!((wide / high - 1.0).abs() < 0.05, "{wide} to {high} at {size:?} after {keys}");
        }
    }
    let mut real = crate::app::real::Real::with(lowered(text));
    real.run(400);
    real.press("Tab Tab Tab Tab o z");
    let [wide, high] = extent(&screen(&real.app, &rich(), (200, 60)));
    assert!(wide > 1.5 * high, "without equal scales it fills the pane");
}

#[test]
fn a_notice_leaves_the_keys_in_sight() {
    let long = "a word and another ".repeat(12);
    for (text, size) in [("struck", (80, 24)), (long.as_str(), (80, 24)), ("struck", (40, 10))] {
        let mut app = in_lab();
        let before = rows(&screen(&app, &rich(), size));
        app.notifications.show(Notification::info(text));
        let after = rows(&screen(&app, &rich(), size));
        let last = usize::from(size.1) - 1;
        assert_eq!(after[last - 1..], before[last - 1..], "status and keys are as they were");
        let reported: String = after[..last - 1].join(" ");
        for word in text.split_whitespace() {
            assert!(reported.contains(word), "{after:#?}");
        }
        assert_eq!(after[..last - 4], before[..last - 4], "it takes a few rows at most");
    }
}

/// What a notification leaves of a word in a frame goes with it; text of a page without a frame stays.
#[test]
fn a_notice_blanks_nothing_beside_it_but_what_is_left_of_words_in_a_frame() {
    for keys in ["2", "3", "4"] {
        let mut app = in_lab();
        press(&mut app, keys);
        for size in [(80, 24), (60, 16), (120, 12)] {
            let before = rows(&screen(&app, &rich(), size));
            app.notifications.show(Notification::info("told"));
            let after = rows(&screen(&app, &rich(), size));
            app.notifications.dismiss();
            let last = usize::from(size.1) - 3;
            let beside = |row: &str| row.chars().skip(9).collect::<String>();
            assert_eq!(beside(&after[last]), beside(&before[last]), "page {keys} at {size:?}");
        }
    }
    // in the rows of a pane too no word is torn
    let mut app = in_lab();
    let (size, word) = ((120, 40), |c: char| c.is_alphanumeric() || ('▁'..='█').contains(&c));
    let before = rows(&screen(&app, &rich(), size));
    let mut torn = 0;
    for long in 78..110 {
        app.notifications.show(Notification::info(format!("{0} {0} {0}", "m".repeat(long))));
        let after = rows(&screen(&app, &rich(), size));
        for row in (0..after.len()).filter(|row| after[*row].contains(&"m".repeat(long))) {
            let [before, after] = [&before, &after].map(|rows| rows[row].chars().skip(3 + long));
            let (before, after): (Vec<char>, Vec<char>) =
                (before.take(2).collect(), after.collect());
            if before.iter().all(|c| word(*c)) {
                torn += 1;
                assert_eq!(after[1], ' ', "{long}: {after:?}");
            }
        }
    }
    assert!(torn > 5, "{torn} of\n{}", before.join("\n"));
    let mut app = lab("heavy-top", 1.0);
    if let Some(lab) = &mut app.lab {
        (lab.focus.pane, lab.focus.zoomed) = (Pane::Initial, true);
    }
    let size = (40, 10);
    let before = rows(&screen(&app, &rich(), size));
    assert!(before[7].contains(" ↓"), "{before:#?}");
    for long in 3..36 {
        app.notifications.show(Notification::info("m".repeat(long)));
        let after = rows(&screen(&app, &rich(), size));
        let rest = after[7].trim_start_matches(['╰', '─', ' ']).trim_start_matches('m');
        let words: String = rest.chars().filter(|c| !"─╯ ".contains(*c)).collect();
        assert!(
            ["", "+4↓", "+3↓", "+2↓", "+1↓"].contains(&&*words),
            "{long}: {words:?} {after:#?}"
        );
    }
}

#[test]
fn what_is_found_is_marked_and_topics_are_headings_only_of_the_whole_list() {
    let look = rich();
    let mut app = at_picker();
    let whole = rows(&screen(&app, &look, (80, 24))).join("\n");
    assert!(whole.contains("│ Pendulum "), "{whole}");
    press(&mut app, "/ p e n d");
    let buffer = screen(&app, &look, (80, 24));
    let text = rows(&buffer).join("\n");
    assert!(!text.contains("│ Pendulum "), "{text}");
    let (x, y) = find(&buffer, "Spherical pendulum").unwrap();
    let marked: String = (x..x + 18)
        .filter(|x| buffer[(*x, y)].modifier.contains(Modifier::UNDERLINED))
        .map(|x| buffer[(x, y)].symbol().to_owned())
        .collect();
    assert_eq!(marked, "pend");
}

#[test]
fn the_palette_names_keys_and_says_what_it_had_to_cut() {
    let mut app = in_lab();
    press(&mut app, ": c o a r s e");
    let text = rows(&screen(&app, &ascii(), (80, 24))).join("\n");
    assert!(text.contains("Shift-Left H -") && text.contains("Shift-Right L + ="), "{text}");
    let mut app = in_lab();
    press(&mut app, ": p a g e Space 9");
    let narrow = rows(&screen(&app, &ascii(), (60, 24))).join("\n");
    assert!(narrow.contains("line by line"), "what the line cuts stands below: {narrow}");
    let wide = screen_text(&app, (160, 50));
    assert!(wide.contains("to be read line by line"), "{wide}");
}

#[test]
fn two_mechanics_side_by_side_are_called_right_and_wrong() {
    let shown = |name: &str| screen(&lab(name, 1.0), &rich(), (120, 40));
    for name in ["rolling-disc", "knife-edge"] {
        let buffer = shown(name);
        let [right, wrong] = ["right", "wrong"].map(|which| {
            let at = find(&buffer, &format!("━ {which} mechanics")).expect(which);
            buffer[at].fg
        });
        assert_ne!(right, wrong, "{name}: each has the colour of its trace");
    }
    assert!(find(&shown("pendulum"), "mechanics ").is_none());
}

#[test]
fn all_verdicts_are_short_where_the_name_of_one_gauge_is_long() {
    let named = |name: &str| gauge(name, name, 1.0, Verdict::Exact(Growth::Level));
    let gauges = ["area", "longest of all names"].map(named);
    let app = in_lab_with(|seen| seen.gauges = gauges.into());
    let text = rows(&screen(&app, &rich(), (120, 40)));
    let row = |name: &str| text.iter().find(|row| row.contains(name)).unwrap();
    for name in [" area ", "longest of all names "] {
        assert!(row(name).contains(" exact ") && !row(name).contains("conserved"), "{text:#?}");
    }
}

#[test]
fn a_gauge_says_in_full_why_it_is_watched() {
    let mut watched = gauge("area", "area", 1.0, Verdict::Bounded);
    watched.reason = "[G, H] + ∂G/∂t = 0, proved by the canonical bracket".to_owned();
    let mut app = in_lab_with(|seen| seen.gauges = vec![watched; 9].into());
    press(&mut app, "Tab Tab");
    for size in [(80, 24), (120, 40), (200, 60)] {
        let text = rows(&screen(&app, &rich(), size));
        let joined = text.join(" ").replace('│', " ");
        let words: Vec<&str> = joined.split_whitespace().collect();
        assert!(words.join(" ").contains("proved by the canonical bracket"), "{size:?}: {text:#?}");
    }
}

#[test]
fn observed_quantities_have_their_units_on_axes() {
    let text = "title = 'a test'\n[coordinates]\nx = { initial = 1.0, unit = 'm' }\n\
        [parameters]\nm = { value = 1.0, unit = 'kg' }\nk = { value = 1.0, unit = 'kg/s²' }\n\
        [lagrangian]\nL = \"1/2*m*x'^2 - 1/2*k*x^2\"\n\
        [[observables]]\nname = 'stored'\nexpression = '1/2*k*x^2'\n\
        [[observables]]\nname = 'ratio'\nexpression = 'x/x'\n";
    let loaded = lowered(text);
    let unit = |name: &str| {
        let channel = loaded.system.channels().iter().find(|c| c.name == name).unwrap();
        channel.unit.clone()
    };
    assert_eq!(["p_x", "stored", "ratio", "energy"].map(unit), ["kg m/s", "J", "", "J"]);
}

#[test]
fn where_a_heading_has_no_room_for_values_all_curves_are_named() {
    let text = rows(&screen(&lab("rolling-race", 1.0), &ascii(), (80, 24))).join("\n");
    // those for which the title has no room stand above the axes
    assert!(["--- x1", "+++ x2", "... x3"].iter().all(|curve| text.contains(curve)), "{text}");
}

#[test]
fn names_are_whole_or_not_there_and_cuts_are_marked() {
    for width in 40..120 {
        let head = rows(&screen(&in_lab(), &rich(), (width, 20)))[0].clone();
        let name = head.split_whitespace().next().unwrap();
        assert!(["phaselab", "Simple", "Simple…", "1"].contains(&name), "{width}: {head}");
        let cut = ["Simpl…", "Simpl ", "Lab…", "Equation…"];
        assert!(cut.iter().all(|cut| !head.contains(cut)), "{width}: {head}");
    }
    // The longest meaning of a parameter, in fewer rows than it needs.
    let app = lab("heavy-top", 1.0);
    for size in [(60, 20), (80, 24), (120, 40)] {
        let rows = rows(&screen(&app, &rich(), size));
        let row = rows.iter().position(|row| row.contains("  moment of inertia about"));
        let Some(row) = row else { continue };
        let whole = rows[row..row + 3].join(" ").contains("fixed point");
        assert!(whole || rows[row].contains('…') || rows[row + 1].contains('…'), "{rows:#?}");
    }
}

/// A quantity that is exact between impulses, but changed by them, is marked differently from one that never changed.
#[test]
fn what_impulses_have_changed_is_marked() {
    let gauge = gauge("energy", "E", 4.0, Verdict::Exact(Growth::Level));
    let after_impulse = Gauge { reference: gauge.initial + 0.25, ..gauge.clone() };
    let letters = RenderStyle { glyphs: Glyphs::Ascii, ..rich() };
    for (gauge, marked) in [(gauge, false), (after_impulse, true)] {
        let mut app = in_lab_with(|seen| seen.gauges = [gauge].into());
        for (look, sign) in [(&rich(), "conserved between ◆"), (&letters, "conserved between *")]
        {
            for size in [(80, 24), (120, 40)] {
                let text = rows(&screen(&app, look, size)).join("\n");
                assert_eq!(text.contains(sign), marked, "{text}");
            }
        }
        press(&mut app, "9");
        let text = rows(&screen(&app, &rich(), (120, 200))).join(" ");
        let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
        assert_eq!(text.contains("impulses have changed it by 0.25"), marked, "{text}");
    }
}
