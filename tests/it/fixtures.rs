//! Test data for `app` and `view`: loaded systems, snapshots made without an integrator, and keys written as words.

use std::collections::HashMap;
use std::hash::Hash;
use std::sync::{Arc, LazyLock, Mutex, OnceLock, PoisonError};
use std::time::Duration;

use crossterm::event::KeyEvent;
use phaselab::app::{App, AppEvent, CheckedText, Effect, Loaded, key};
use phaselab::diagnostic::Document;
use phaselab::experiment::{Gauge, MethodFact, Prepared, Setup, Snapshot, Status, Trail, Verdict};
use phaselab::mechanics::derive;
use phaselab::preset::{Catalog, Checked};
use phaselab::system::{ChannelKind, InitialOverride, System};
use phaselab::view::theme::PALETTES;

/// The shipped presets, without the user's.
pub(crate) fn catalog() -> &'static Catalog {
    static CATALOG: OnceLock<Catalog> = OnceLock::new();
    CATALOG.get_or_init(|| Catalog::with_folder(None))
}

/// What several tests share, by its key.
type Shelf<K, T> = Mutex<HashMap<K, Arc<OnceLock<T>>>>;

/// Makes a value the first time it is wanted; the others wait for that.
fn once<K: Eq + Hash, T: Clone>(shelf: &Shelf<K, T>, key: K, make: impl FnOnce() -> T) -> T {
    let place = {
        let mut shelf = shelf.lock().unwrap_or_else(PoisonError::into_inner);
        Arc::clone(shelf.entry(key).or_default())
    };
    place.get_or_init(make).clone()
}

/// A shipped preset, lowered; it is cached for the whole process.
pub(crate) fn loaded(name: &str, epoch: u64) -> Loaded {
    static SHELF: LazyLock<Shelf<String, Loaded>> = LazyLock::new(Shelf::default);
    let make = || lower(name, 1, catalog().find(name).unwrap());
    Loaded { epoch, ..once(&SHELF, name.to_owned(), make) }
}

/// A shipped preset, compiled anew: no other test has begun its machine code.
pub(crate) fn compiled(name: &str) -> Loaded {
    let loaded = loaded(name, 1);
    let system = System::compile(&loaded.model, &loaded.equations, &[]).unwrap();
    Loaded { system: Arc::new(system), ..loaded }
}

/// Lowers the text of a file, with epoch 1.
pub(crate) fn lowered(text: &str) -> Loaded {
    lower("test", 1, Document::new("test", text))
}

fn lower(name: &str, epoch: u64, document: Document) -> Loaded {
    let checked = document.read().unwrap_or_else(|diagnostics| panic!("{diagnostics:?}"));
    let Checked { model, warnings, .. } = checked;
    let equations = derive(&model).unwrap();
    let system = System::compile(&model, &equations, &[]).unwrap();
    let (model, equations, system) = (Arc::new(model), Arc::new(equations), Arc::new(system));
    let document = Arc::new(document);
    Loaded { name: name.to_owned(), epoch, document, warnings, model, equations, system }
}

/// The pendulum.
pub(crate) fn pendulum() -> Loaded {
    loaded("pendulum", 1)
}

/// A snapshot in which every coordinate oscillates like a cosine about its initial value; if constraints do not permit
/// this, the initial state at any time.
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
        setup: Arc::new(Setup { method: "auto".to_owned(), ..Setup::default() }),
        restored: true,
        ..Snapshot::empty(loaded.epoch)
    }
}

/// A gauge with this value and verdict.
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

/// The application with the pendulum in the lab and a snapshot at t = 2.
pub(crate) fn in_lab() -> App {
    static LAB: LazyLock<App> = LazyLock::new(|| lab("pendulum", 2.0));
    LAB.clone()
}

/// The application with a shipped preset in the lab and a snapshot at `time`; with the answers of its jobs, some of which take
/// a minute, it is cached for the whole process.
pub(crate) fn lab(name: &str, time: f64) -> App {
    static SHELF: LazyLock<Shelf<(String, u64), App>> = LazyLock::new(Shelf::default);
    once(&SHELF, (name.to_owned(), time.to_bits()), || showing(loaded(name, 1), time))
}

/// The application with a system in the lab and a snapshot at `time`.
pub(crate) fn showing(loaded: Loaded, time: f64) -> App {
    let seen = snapshot(&loaded, time);
    let (mut app, _) = App::new(catalog(), Some(&loaded.name));
    app.themes.available = PALETTES.iter().map(|palette| (palette.name, palette.about)).collect();
    app.update(AppEvent::Loaded(Ok(loaded)));
    app.update(AppEvent::Snapshot(Arc::new(seen)));
    app
}

/// The application with the pendulum in the lab and a snapshot at t = 2 after a change.
pub(crate) fn in_lab_with(change: impl FnOnce(&mut Snapshot)) -> App {
    let (mut app, mut seen) = (in_lab(), snapshot(&pendulum(), 2.0));
    change(&mut seen);
    app.update(AppEvent::Snapshot(Arc::new(seen)));
    app
}

/// The application at the picker, with the pendulum as a preview.
pub(crate) fn at_picker() -> App {
    static PICKER: LazyLock<App> = LazyLock::new(|| {
        let (mut app, _) = App::new(catalog(), None);
        while app.picker.current().unwrap().name != "pendulum" {
            press(&mut app, "Down");
        }
        press(&mut app, "Wait");
        app.update(AppEvent::Loaded(Ok(pendulum())));
        app.update(AppEvent::Snapshot(Arc::new(snapshot(&pendulum(), 2.0))));
        app
    });
    PICKER.clone()
}

/// Presses keys written as words: `Down Enter q Ctrl-c`. `Wait` lets a second pass. Returns the requested effects.
pub(crate) fn press(app: &mut App, keys: &str) -> Vec<Effect> {
    let mut effects = Vec::new();
    for word in keys.split_whitespace() {
        effects.extend(match word {
            "Wait" => app.update(AppEvent::Tick(Duration::from_secs(1))),
            word => app.update(AppEvent::Key(key(word))),
        });
    }
    effects
}

/// Parses a key.
pub(crate) fn key(word: &str) -> KeyEvent {
    key::named(word).unwrap_or_else(|_| panic!("no key is called {word}"))
}

/// The application with a system of its own in the lab, at its start, where nothing is computed on the side but what is
/// waited for.
pub(crate) fn begun(text: &str) -> App {
    let ready = Prepared::of(&Document::new("test", text)).unwrap_or_else(|why| panic!("{why}"));
    let mut start = None;
    let loaded = Loaded::of("test".to_owned(), ready, |mut experiment| {
        experiment.set_epoch(1);
        start = Some(experiment.snapshot());
        1
    });
    let (mut app, _) = App::new(catalog(), Some("test"));
    app.update(AppEvent::Loaded(Ok(loaded)));
    app.update(AppEvent::Snapshot(Arc::new(start.expect("an experiment"))));
    app
}

/// Types into the field that is open, in place of what it has, and accepts it.
pub(crate) fn write(app: &mut App, typed: &str) -> Vec<Effect> {
    for c in typed.chars() {
        press(app, &if c == ' ' { "Space".to_owned() } else { c.to_string() });
    }
    press(app, "Enter")
}

/// Checks the text that waits, which has no error, as the shell does, and returns it.
pub(crate) fn checked(app: &mut App) -> String {
    let (text, is_right) = judged(app);
    assert!(is_right, "{text}");
    text
}

/// Checks the text that waits, as the shell does. Returns it, and whether it has no error.
pub(crate) fn judged(app: &mut App) -> (String, bool) {
    let (text, is_right, _) = answered(app);
    (text, is_right)
}

/// Rebuilds the system in the lab from a text that another program has saved to its file. Returns what follows.
pub(crate) fn rebuild(app: &mut App, text: &str) -> Vec<Effect> {
    app.update(AppEvent::FileRead { text: text.to_owned(), asked: false });
    let (text, is_right, effects) = answered(app);
    assert!(is_right, "{text}");
    effects
}

/// Checks the text that waits, as the shell does. Returns it, whether it has no error, and what follows.
fn answered(app: &mut App) -> (String, bool, Vec<Effect>) {
    let effects = app.update(AppEvent::Tick(Duration::from_millis(20)));
    let found = effects.into_iter().find_map(|effect| match effect {
        Effect::Check { ticket, title, text } => Some((ticket, title, text)),
        _ => None,
    });
    let (ticket, title, text) = found.expect("a text to be checked");
    let name = app.lab.as_ref().unwrap().loaded.name.clone();
    let ready = Prepared::of(&Document::new(title.as_str(), text.as_str()));
    let outcome = ready.map(|ready| Loaded::of(name, ready, |_| 2)).map_err(|why| why.diagnostics);
    let (took, is_right) = (Some(Duration::from_millis(3)), outcome.is_ok());
    let effects = app.update(AppEvent::Checked(Box::new(CheckedText { ticket, outcome, took })));
    (text, is_right, effects)
}
