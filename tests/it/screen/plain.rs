//! The plain-text page, and the position of the terminal's cursor.

use std::sync::Arc;
use std::time::Duration;

use phaselab::app::keymap::{KEYS, KeyContext};
use phaselab::app::{App, AppEvent, ValueId};
use phaselab::experiment::Verdict;
use phaselab::view::RenderStyle;
use phaselab::view::colour::ColourDepth;
use phaselab::view::glyphs::Glyphs;
use phaselab::view::theme::Theme;

use super::{drawn, find, rich, rows};
use crate::fixtures::{at_picker, catalog, gauge, in_lab, loaded, pendulum, press, snapshot};
use crate::nonempty;

/// The page on a screen long enough for all of it, as one text without line breaks.
fn text(app: &App) -> String {
    let plain = RenderStyle { theme: Theme::dark(ColourDepth::None), glyphs: Glyphs::Braille };
    let buffer = drawn(app, &plain, (114, 240)).0;
    let lines: Vec<String> =
        rows(&buffer).iter().map(|row| row.trim_matches(['│', ' ']).into()).collect();
    lines.join(" ").split_whitespace().collect::<Vec<_>>().join(" ")
}

fn sees(app: &mut App, time: f64) {
    app.update(AppEvent::Snapshot(Arc::new(snapshot(&pendulum(), time))));
}

#[test]
fn everything_on_the_screen_can_be_read() {
    for name in ["pendulum", "heavy-top", "merry-go-round", "knife-edge"] {
        let system = loaded(name, 1);
        let mut seen = snapshot(&system, 1.0);
        seen.notices = ["first notice".to_owned(), "latest notice".to_owned()].into();
        let broken = Verdict::Broken("−2F along the whole way that it went".to_owned());
        seen.gauges = [gauge("energy", "E", 0.25, broken)].into();
        let (mut app, _) = App::new(catalog(), Some(name));
        app.update(AppEvent::Loaded(Ok(system.clone())));
        app.update(AppEvent::Snapshot(Arc::new(seen)));
        press(&mut app, "1 9");
        let text = text(&app);
        let reported = |what: &str| {
            let what = Glyphs::Braille.text(what);
            let what = what.split_whitespace().collect::<Vec<_>>().join(" ");
            assert!(text.contains(&what), "{name}: {what} in {text}");
        };
        reported(&system.model.info.title);
        reported(&system.model.info.summary);
        reported("Time 1");
        reported("running, speed ×1, method taylor");
        for parameter in &system.model.parameters {
            reported(&format!("{} is ", parameter.shown));
            reported(&parameter.about);
            reported(&parameter.unit);
        }
        let lab = app.lab.as_ref().unwrap();
        for index in 0..lab.count(ValueId::Initial) {
            reported(&format!("{} is ", lab.value_info(ValueId::Initial(index)).unwrap().shown));
        }
        let channels = system.system.channels();
        for (index, channel) in channels.iter().enumerate().filter(|(_, c)| !c.name.is_empty()) {
            // A quantity that a file expects something of is watched under its own name.
            if channels[..index].iter().all(|before| before.name != channel.name) {
                reported(&format!("{} is ", channel.shown));
            }
        }
        reported(
            "E (energy) is 0.25000000; changed by 0 since t = 0; not conserved: by the physics",
        );
        reported("−2F along the whole way that it went. Reason: ∂L/∂t = 0.");
        reported("latest notice first notice");
        for row in KEYS.iter().filter(|row| row.context == KeyContext::Experiment) {
            reported(row.help);
        }
        assert!(!text.contains(['⣿', '●', '━']), "no pictures");
    }
}

#[test]
fn it_keeps_still_until_it_is_asked() {
    let mut app = in_lab();
    press(&mut app, "9");
    let read = |app: &App| drawn(app, &rich(), (80, 24)).0;
    let first = read(&app);
    for frame in 0..90 {
        app.update(AppEvent::Tick(Duration::from_millis(33)));
        sees(&mut app, 2.0 + f64::from(frame) / 30.0);
        assert!(read(&app) == first, "it moved by itself");
    }
    press(&mut app, "Enter");
    assert!(text(&app).contains("Time 4.96667"), "{}", text(&app));
    // Automatically, every two seconds and not more often.
    press(&mut app, "A");
    app.notifications.dismiss();
    let mut pictures = vec![read(&app)];
    for frame in 0..150 {
        app.update(AppEvent::Tick(Duration::from_millis(100)));
        sees(&mut app, 10.0 + f64::from(frame));
        let now = read(&app);
        if pictures.last() != Some(&now) {
            pictures.push(now);
        }
    }
    assert!((6..=9).contains(&pictures.len()), "{} in 15 s", pictures.len());
    press(&mut app, "A");
    app.notifications.dismiss();
    let still = read(&app);
    app.update(AppEvent::Tick(Duration::from_secs(5)));
    sees(&mut app, 99.0);
    assert!(read(&app) == still);
    // The result of a command given here is read at once.
    press(&mut app, "Space");
    sees(&mut app, 123.0);
    assert!(text(&app).contains("Time 123"));
}

#[test]
fn the_cursor_stands_at_the_line_that_is_read() {
    for size in [(40, 12), (80, 24), (120, 40)] {
        let mut app = in_lab();
        press(&mut app, "9");
        let mut lines = Vec::new();
        for _ in 0..400 {
            let (buffer, seen) = drawn(&app, &rich(), size);
            app.update(AppEvent::Drawn(seen.clone()));
            let (x, y) = seen.cursor.expect("a cursor");
            let line: String = (x..size.0).map(|x| buffer[(x, y)].symbol()).collect();
            lines.push((app.reading.line, line.trim_matches(['│', ' ']).to_owned()));
            press(&mut app, "Down");
        }
        lines.dedup();
        assert!(lines[0].1.starts_with("Simple pendulum"), "{lines:?}");
        assert!(lines.iter().enumerate().all(|(i, (line, _))| i == *line), "each in its turn");
        let all: Vec<&str> = lines.iter().map(|(_, line)| line.as_str()).collect();
        let all = all.join(" ");
        for word in ["Parameters, 4:", "mass of the bob", "Gauges, 1:", "pause or resume"] {
            assert!(all.contains(word), "{word} at {size:?} in {all}");
        }
        press(&mut app, "Home");
        assert_eq!(app.reading.line, 0);
        press(&mut app, "End");
        assert_eq!(app.reading.line, lines.len() - 1);
    }
}

#[test]
fn the_cursor_stands_in_the_text_being_typed() {
    let at = |app: &App| {
        let (buffer, seen) = drawn(app, &rich(), (80, 24));
        (seen.cursor, buffer)
    };
    assert_eq!(at(&in_lab()).0, None, "nothing is typed");
    for (keys, text) in [
        ("Enter Ctrl-u 4 2", "m = 42"),
        (": z o o", "/ zoo"),
        ("{ t h", "? th"),
        ("Tab Tab Tab v t", "/ t"),
    ] {
        let mut app = in_lab();
        press(&mut app, keys);
        let (cursor, buffer) = at(&app);
        let (x, y) = find(&buffer, text).unwrap_or_else(|| panic!("{:#?}", rows(&buffer)));
        assert_eq!(cursor, Some((x + text.chars().count() as u16, y)), "{keys}");
    }
    let mut app = at_picker();
    press(&mut app, "/ p e n");
    let (cursor, buffer) = at(&app);
    let (x, y) = find(&buffer, "/ pen").unwrap();
    assert_eq!(cursor, Some((x + 5, y)));
}

#[test]
fn every_parameter_of_every_preset_says_what_it_means() {
    for entry in nonempty(catalog().entries()) {
        let model = catalog().find(&entry.name).unwrap().read().unwrap().model;
        let unclear = |p: &&phaselab::model::Parameter| p.about.trim().is_empty() || p.min >= p.max;
        let unclear = model.parameters.iter().find(unclear).map(|parameter| &parameter.name);
        assert_eq!(unclear, None, "{} does not say what it means, or has no range", entry.name);
    }
}

#[test]
fn the_footer_tells_meaning_unit_and_range_of_what_is_focused() {
    let mut app = in_lab();
    press(&mut app, "Down");
    let buffer = drawn(&app, &rich(), (120, 40)).0;
    let parameter = &pendulum().model.parameters[1];
    let footer = rows(&buffer)[39].clone();
    for part in [&parameter.unit, &"0.2 to 3".to_owned()] {
        assert!(footer.contains(part.as_str()), "{part} in {footer}");
    }
    // the list has room for what it means
    let all = rows(&buffer).join("\n");
    assert!(all.contains(parameter.about.as_str()), "{} in {all}", parameter.about);
}
