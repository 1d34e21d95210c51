//! Made by hand for the tests of `app` and `view`: loaded systems, snapshots that no integrator had a part in, keys
//! written as words.

use std::sync::{Arc, OnceLock};
use std::time::Duration;

use phaselab::app::{App, Code, Effect, Event, Key, Loaded};
use phaselab::diagnostic::Document;
use phaselab::experiment::{Gauge, MethodFact, Snapshot, Status, Trail, Verdict};
use phaselab::mechanics::derive;
use phaselab::preset::Catalog;
use phaselab::system::{ChannelKind, InitialOverride, System};
use phaselab::view::theme::PALETTES;

/// The shipped presets, without the user's.
pub(crate) fn catalog() -> &'static Catalog {
    static CATALOG: OnceLock<Catalog> = OnceLock::new();
    CATALOG.get_or_init(|| Catalog::with_folder(None))
}

/// A shipped preset, lowered.
pub(crate) fn loaded(name: &str, epoch: u64) -> Loaded {
    lower(name, epoch, catalog().find(name).unwrap())
}

/// The text of a file, lowered; epoch 1.
pub(crate) fn lowered(text: &str) -> Loaded {
    lower("test", 1, Document::new("test", text))
}

fn lower(name: &str, epoch: u64, document: Document) -> Loaded {
    let model = document.read().unwrap_or_else(|mistakes| panic!("{mistakes:?}")).model;
    let equations = derive(&model).unwrap();
    let system = System::compile(&model, &equations, &[]).unwrap();
    let (model, equations, system) = (Arc::new(model), Arc::new(equations), Arc::new(system));
    let document = Arc::new(document);
    Loaded { name: name.to_owned(), epoch, document, model, equations, system }
}

/// The pendulum, derived once.
pub(crate) fn pendulum() -> Loaded {
    static PENDULUM: OnceLock<Loaded> = OnceLock::new();
    PENDULUM.get_or_init(|| loaded("pendulum", 1)).clone()
}

/// What one could see at a time if every coordinate swung like a cosine of its own about its initial value; where
/// constraints would not let it, the start all the time.
pub(crate) fn snapshot(loaded: &Loaded, time: f64) -> Snapshot {
    let system = &loaded.system;
    let parameters = loaded.model.parameter_values();
    let initial = system.initial_values(&parameters);
    let mut observer = system.observer(&parameters);
    let mut row = |t: f64| {
        let swing = |i: usize| {
            let (sin, cos) = (3.0 * t + i as f64).sin_cos();
            let (sin0, cos0) = (i as f64).sin_cos();
            let q = initial[i] + 0.9 * (cos - cos0);
            [InitialOverride::Position(i, q), InitialOverride::Velocity(i, -2.7 * (sin - sin0))]
        };
        let free = loaded.model.constraints.is_empty();
        // variables of a Poisson system have no velocity of their own
        let possible = |given: &InitialOverride| {
            !loaded.model.is_poisson() || matches!(given, InitialOverride::Position(..))
        };
        let given: Vec<InitialOverride> =
            (0..system.degrees()).filter(|_| free).flat_map(swing).filter(possible).collect();
        let mut values = vec![f64::NAN; system.channels().len()];
        let moment = if free { t } else { loaded.model.run.start };
        let state = system.initial(moment, &parameters, &given).unwrap();
        observer.observe(&state, &mut values).unwrap();
        [vec![t], values].concat()
    };
    let rows: Vec<Vec<f64>> = (0..=200).map(|i| row(time * f64::from(i) / 200.0)).collect();
    let width = rows[0].len();
    let bounds = (1..width).map(|c| {
        let column = rows.iter().map(|row| row[c]);
        (column.clone().fold(f64::INFINITY, f64::min), column.fold(f64::NEG_INFINITY, f64::max))
    });
    let energy = system.channels().iter().position(|c| c.kind == ChannelKind::Energy).unwrap();
    Snapshot {
        time,
        status: Status::Running,
        speed: 1.0,
        parameters: parameters.into(),
        initial: initial.into(),
        values: rows[200][1..].into(),
        bounds: bounds.collect(),
        trail: Trail::from_rows(width, &rows),
        gauges: [gauge("energy", "E", rows[200][1 + energy], Verdict::Bounded)].into(),
        method: MethodFact { name: "taylor", step: 0.0123, steps: 4321, tolerance: Some(1e-15) },
        taken_up: true,
        ..Snapshot::empty(loaded.epoch)
    }
}

/// A gauge of a value.
pub(crate) fn gauge(name: &str, shown: &str, value: f64, verdict: Verdict) -> Gauge {
    Gauge {
        name: name.to_owned(),
        shown: shown.to_owned(),
        reason: "∂L/∂t = 0".to_owned(),
        proved: true,
        value,
        initial: value,
        scale: value.abs(),
        farthest: 3e-16 * value.abs(),
        reference: value,
        reference_time: 0.0,
        drift: 2.5e-16,
        max_drift: 3e-16,
        left: None,
        history: [0.0, 1e-16, 2.5e-16].into(),
        verdict,
    }
}

/// The application as it is once the pendulum is open in the lab and was seen at t = 2.
pub(crate) fn in_lab() -> App {
    let (mut app, _) = App::new(catalog(), Some("pendulum"));
    app.themes = PALETTES.iter().map(|palette| (palette.name, palette.about)).collect();
    app.update(Event::Loaded(Ok(pendulum())));
    app.update(Event::Snapshot(Arc::new(snapshot(&pendulum(), 2.0))));
    app
}

/// The application at the picker, with the pendulum as a preview.
pub(crate) fn at_picker() -> App {
    let (mut app, _) = App::new(catalog(), None);
    while app.picker.current().unwrap().name != "pendulum" {
        press(&mut app, "Down");
    }
    press(&mut app, "Wait");
    app.update(Event::Loaded(Ok(pendulum())));
    app.update(Event::Snapshot(Arc::new(snapshot(&pendulum(), 2.0))));
    app
}

/// Presses keys written as words: `Down Enter q Ctrl-c`. `Wait` lets a second pass. Returns what was asked for.
pub(crate) fn press(app: &mut App, keys: &str) -> Vec<Effect> {
    let mut effects = Vec::new();
    for word in keys.split_whitespace() {
        effects.extend(match word {
            "Wait" => app.update(Event::Tick(Duration::from_secs(1))),
            word => app.update(Event::Key(key(word))),
        });
    }
    effects
}

/// The key of a word.
pub(crate) fn key(word: &str) -> Key {
    if let Some(rest) = word.strip_prefix("Ctrl-") {
        return Key { ctrl: true, ..key(rest) };
    }
    if let Some(rest) = word.strip_prefix("Alt-") {
        return Key { alt: true, ..key(rest) };
    }
    if let Some(rest) = word.strip_prefix("Shift-") {
        return Key { shift: true, ..key(rest) };
    }
    Key::plain(match word {
        "Enter" => Code::Enter,
        "Esc" => Code::Esc,
        "Tab" => Code::Tab,
        "Backspace" => Code::Backspace,
        "Delete" => Code::Delete,
        "Up" => Code::Up,
        "Down" => Code::Down,
        "Left" => Code::Left,
        "Right" => Code::Right,
        "Home" => Code::Home,
        "End" => Code::End,
        "PageUp" => Code::PageUp,
        "PageDown" => Code::PageDown,
        "Space" => Code::Char(' '),
        "F1" => Code::F(1),
        word => {
            let mut messages = word.chars();
            let (Some(letter), None) = (messages.next(), messages.next()) else {
                panic!("no key is called {word}")
            };
            Code::Char(letter)
        }
    })
}
