//! The table of keys: no twins, and nothing in it that does nothing.

use std::sync::Arc;
use std::time::Duration;

use phaselab::app::keymap::{self, Binding, CHAINS, KEYS, Place};
use phaselab::app::{App, Drawn, Event, Page};
use phaselab::experiment::Status;

use super::scripts::with_blows;
use crate::hand::{at_picker, in_lab, loaded, pendulum, press, snapshot};

#[test]
fn no_key_means_two_things_at_once() {
    let twins = keymap::duplicates();
    let told: Vec<String> =
        twins.iter().map(|(k, a, b)| format!("{k}: {} | {}", a.help, b.help)).collect();
    assert!(told.is_empty(), "{told:#?}");
}

#[test]
fn every_place_is_in_a_chain_and_in_the_help() {
    for row in KEYS {
        assert!(CHAINS.iter().any(|chain| chain.contains(&row.place)), "{:?}", row.place);
        assert!(Place::ALL.contains(&row.place), "{:?}", row.place);
        assert!(!row.keys.is_empty() && !row.help.is_empty(), "{row:?}");
    }
}

/// Some states in which the keys of a place hold; between them every key there finds something to do.
fn states(place: Place) -> Vec<App> {
    let lab = |keys: &str| {
        let mut app = in_lab();
        press(&mut app, keys);
        app
    };
    let scrolled = |keys: &str| {
        let mut app = lab(keys);
        app.update(Event::Drawn(Drawn { beyond: 90, rows: 20 }));
        app.scroll = 40;
        app
    };
    let picker = |keys: &str| {
        let mut app = at_picker();
        press(&mut app, keys);
        app
    };
    match place {
        Place::Always | Place::Anywhere => vec![lab("")],
        Place::Lab => vec![lab(""), with_blows(&["push"])],
        Place::Picker => vec![picker("Up Up")],
        Place::Search => vec![picker("/ p e n d Down")],
        Place::Experiment => vec![lab("Right Wait Right u"), lab("4")],
        Place::Space => vec![with_frame(), lab("Tab Tab Tab + Down Down")],
        Place::Plot => vec![lab("Tab Tab Tab Tab + Right")],
        Place::Values => vec![lab("Down Right")],
        Place::Gauges => {
            let mut app = lab("Tab Tab");
            let mut two = snapshot(&pendulum(), 2.0);
            two.gauges =
                [two.gauges[0].clone(), two.gauges[0].clone(), two.gauges[0].clone()].into();
            app.update(Event::Snapshot(Arc::new(two)));
            press(&mut app, "Down");
            vec![app]
        }
        Place::Text => vec![scrolled("2")],
        Place::Menu => vec![lab("m"), lab(": Down"), lab("Tab Tab Tab v Down Enter Down")],
        Place::Field | Place::Typing => vec![lab("Enter")],
    }
}

/// The ball on the merry-go-round, its first picture focused.
fn with_frame() -> App {
    let loaded = loaded("merry-go-round", 1);
    let mut app = in_lab();
    let seen = snapshot(&loaded, 1.0);
    app.update(Event::Loaded(Ok(loaded)));
    app.update(Event::Snapshot(Arc::new(seen)));
    press(&mut app, "Tab Tab Tab");
    app
}

fn does_something(row: &Binding, key: phaselab::app::Key) -> bool {
    states(row.place).into_iter().any(|mut app| {
        assert!(
            app.places().contains(&row.place),
            "{:?} is not active in its own state",
            row.place
        );
        let before = summary(&app);
        let effects = app.update(Event::Key(key));
        !effects.is_empty() || summary(&app) != before
    })
}

/// All that a key can change.
fn summary(app: &App) -> String {
    let lab = app.lab.as_ref().map(|lab| {
        let values: Vec<_> =
            (0..4).map(|i| lab.value(phaselab::app::Target::Parameter(i))).collect();
        format!("{:?} {:?} {} {:?} {values:?}", lab.plots, lab.focus, lab.zoomed, lab.selection)
    });
    let picker = (app.picker.selected, app.picker.search.as_ref().map(|s| s.value().to_owned()));
    format!("{:?} {:?} {} {picker:?} {lab:?}", app.page, app.over, app.scroll)
}

#[test]
fn every_key_in_the_table_does_something() {
    for row in KEYS {
        for key in row.keys {
            assert!(does_something(row, *key), "{key} does nothing: {}", row.help);
        }
    }
}

#[test]
fn the_palette_finds_the_energy() {
    let mut app = in_lab();
    press(&mut app, ": e n e Enter");
    assert_eq!(app.page, Page::Lab);
    press(&mut app, ": e n e r g Space 4 Enter");
    assert_eq!(app.page, Page::Numbers);
}

#[test]
fn a_notice_goes_by_itself() {
    let mut app = in_lab();
    press(&mut app, "u");
    assert!(app.notice.as_ref().is_some_and(|notice| notice.error));
    app.update(Event::Tick(Duration::from_secs(20)));
    assert_eq!(app.notice, None);
}

#[test]
fn a_fault_is_answered_by_a_reset_and_not_by_play() {
    let mut app = in_lab();
    let mut faulted = snapshot(&pendulum(), 2.0);
    let fault = phaselab::experiment::Fault { time: 2.0, message: "collision".to_owned() };
    faulted.status = Status::Faulted(fault);
    app.update(Event::Snapshot(Arc::new(faulted)));
    assert!(press(&mut app, "Space").is_empty());
    assert!(app.notice.is_some_and(|notice| notice.text.contains("reset")));
}
