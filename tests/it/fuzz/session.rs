//! Sessions: a session is read back equal after writing, and can be restored or ignored without a panic.

use std::sync::{Arc, OnceLock};

use phaselab::app::{App, AppEvent, Effect, Saved};
use phaselab::experiment::{Experiment, Setup};
use phaselab::view::draw;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use crate::fixtures::{catalog, in_lab, pendulum, press};
use crate::screen::rich;

pub(crate) const WORDS: &[&str] = &[
    "version = 1\n",
    "page = ",
    "focus = ",
    "plots = []\n",
    "[[plots]]\n",
    "kind = \"space\"\n",
    "kind = \"time\"\n",
    "[moment]\n",
    "time = ",
    "\"Lab\"",
    "\"",
    "=",
    "\n",
    "true",
    "{",
    "}",
    "[",
    "]",
    ",",
    "nan",
    "inf",
    "-",
    "e300",
];

/// The application before the pendulum is loaded.
fn opened() -> App {
    static OPENED: OnceLock<App> = OnceLock::new();
    OPENED.get_or_init(|| App::new(catalog(), Some("pendulum")).0).clone()
}

/// Sessions of the lab as it opens, and after some keys.
pub(super) fn own() -> Vec<String> {
    let session = |keys: &str| {
        let mut app = in_lab();
        press(&mut app, keys);
        toml::to_string(&app.saved().expect("a lab is open")).expect("it can be written")
    };
    ["", "Tab Tab Tab + + x Right c g z", "Right Tab Right Tab Tab Tab Tab Tab 2"]
        .map(session)
        .into()
}

pub(crate) fn check(bytes: &[u8]) {
    let text = &*String::from_utf8_lossy(bytes);
    let saved: Saved = match toml::from_str(text) {
        Ok(saved) => saved,
        Err(why) => {
            let place = why.span().unwrap_or_default();
            assert!(!why.message().is_empty() && text.get(place).is_some(), "{why}");
            return;
        }
    };
    let written = toml::to_string(&saved).expect("it can be written");
    let again: Saved = toml::from_str(&written).unwrap_or_else(|why| panic!("{written}: {why}"));
    // NaN is not equal to itself, but its text is
    assert_eq!(format!("{again:?}"), format!("{saved:?}"), "{written}");

    let loaded = pendulum();
    let setup = Setup::of(&loaded.model);
    let mut experiment =
        Experiment::new(&loaded.model, &loaded.equations, &loaded.system, setup).unwrap();
    experiment.set_epoch(loaded.epoch);
    let mut app = opened();
    app.resume(saved);
    for effect in app.update(AppEvent::Loaded(Ok(loaded))) {
        if let Effect::Execute(command) = effect {
            experiment.execute(command);
        }
    }
    app.update(AppEvent::Snapshot(Arc::new(experiment.snapshot())));
    experiment.advance(experiment.time() + 0.1, 20);
    app.update(AppEvent::Snapshot(Arc::new(experiment.snapshot())));
    let area = Rect::new(0, 0, 80, 24);
    draw(&app, &rich(), area, &mut Buffer::empty(area));
    assert!(app.saved().is_some(), "a lab is open");
}
