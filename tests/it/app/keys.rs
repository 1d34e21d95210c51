//! The table of keys: no duplicates, and no key without an action.

use std::path::Path;
use std::sync::{Arc, OnceLock};
use std::time::Duration;

use crossterm::event::KeyEvent;
use phaselab::app::keymap::{Binding, CHAINS, KEYS, KeyContext};
use phaselab::app::{
    Action, App, AppEvent, Choice, Drawn, DrawnPanes, Effect, LawInView, LoadError, Menu, Overlay,
    Page, Pane, PanesInView, ValueId,
};
use phaselab::experiment::{Command, Status};
use phaselab::instrument::Sight;

use super::scripts::with_impulses;
use crate::fixtures::{at_picker, in_lab, loaded, pendulum, press, snapshot};

#[test]
fn no_key_means_two_things_at_once() {
    let mut reported = Vec::new();
    for chain in CHAINS {
        let rows: Vec<_> = KEYS.iter().filter(|row| chain.contains(&row.context)).collect();
        for (index, first) in rows.iter().enumerate() {
            for second in &rows[index + 1..] {
                let shared = first.keys.iter().filter(|key| second.keys.contains(key));
                let name = phaselab::app::key::name;
                reported.extend(
                    shared.map(|k| format!("{}: {} | {}", name(k), first.help, second.help)),
                );
            }
        }
    }
    assert!(reported.is_empty(), "{reported:#?}");
}

#[test]
fn every_context_is_in_a_chain_and_in_the_help() {
    for row in KEYS {
        assert!(CHAINS.iter().any(|chain| chain.contains(&row.context)), "{:?}", row.context);
        assert!(KeyContext::ALL.contains(&row.context), "{:?}", row.context);
        assert!(!row.keys.is_empty() && !row.help.is_empty(), "{row:?}");
    }
}

/// States in which a context's keys are active; each key has an effect in at least one of them.
fn states(context: KeyContext) -> &'static [App] {
    static STATES: OnceLock<Vec<Vec<App>>> = OnceLock::new();
    let states = STATES.get_or_init(|| KeyContext::ALL.into_iter().map(states_made).collect());
    let at = KeyContext::ALL.iter().position(|other| *other == context);
    &states[at.expect("it is one of all")]
}

fn states_made(context: KeyContext) -> Vec<App> {
    let lab = |keys: &str| {
        let mut app = in_lab();
        press(&mut app, keys);
        app
    };
    let scrolled = |keys: &str| {
        let mut app = lab(keys);
        app.update(AppEvent::Drawn(Drawn { beyond: 90, rows: 20, ..Drawn::default() }));
        app.text.scroll = 40;
        app
    };
    let picker = |keys: &str| {
        let mut app = at_picker();
        press(&mut app, keys);
        app
    };
    match context {
        KeyContext::Always | KeyContext::Anywhere => vec![lab("")],
        KeyContext::Lab => {
            let mut shared = lab("");
            let in_view = PanesInView::of([Pane::Plot(0), Pane::Plot(1), Pane::Parameters]);
            let panes = DrawnPanes { in_view, ..DrawnPanes::default() };
            shared.update(AppEvent::Drawn(Drawn { panes: Some(panes), ..Drawn::default() }));
            vec![with_impulses(&["push"]), with_frame(), lab(""), shared]
        }
        KeyContext::Picker => vec![picker("Up Up")],
        KeyContext::Search => vec![picker("/ p e n d Down")],
        KeyContext::Experiment => {
            vec![lab("Right Wait Right u"), lab("4"), lab(": m e t h o d Space r k 4 Enter")]
        }
        KeyContext::Space => vec![lab("Tab Tab Tab"), lab("Tab Tab Tab + Down Down")],
        KeyContext::Plot => vec![lab("Tab Tab Tab Tab + Right")],
        KeyContext::Values => vec![lab("Down Right")],
        KeyContext::Gauges => {
            let mut app = lab("Tab Tab");
            let mut two = snapshot(&pendulum(), 2.0);
            two.gauges =
                [two.gauges[0].clone(), two.gauges[0].clone(), two.gauges[0].clone()].into();
            app.update(AppEvent::Snapshot(Arc::new(two)));
            press(&mut app, "Down");
            vec![app]
        }
        KeyContext::Text => {
            let mut searched = lab("3 / m Enter");
            let drawn = Drawn { beyond: 90, rows: 20, matches: 3, ..Drawn::default() };
            searched.update(AppEvent::Drawn(drawn));
            vec![scrolled("3"), searched]
        }
        KeyContext::Help => vec![lab("?")],
        KeyContext::Message => vec![wrong_file()],
        KeyContext::Law => {
            let mut app = in_lab();
            let panes =
                DrawnPanes { single: false, law: LawInView::Clipped(90), ..DrawnPanes::default() };
            app.update(AppEvent::Drawn(Drawn { panes: Some(panes), ..Drawn::default() }));
            press(&mut app, "Shift-Tab PgDn PgDn");
            vec![app]
        }
        KeyContext::Equations => vec![lab("2")],
        KeyContext::HelpSearch => vec![scrolled("? / z o o m")],
        KeyContext::Plain => {
            let mut app = scrolled("9");
            app.reading.line = 40;
            app.update(AppEvent::Snapshot(Arc::new(snapshot(&pendulum(), 3.0))));
            vec![app]
        }
        KeyContext::Menu => {
            vec![lab("m"), lab(": Down"), lab("Tab Tab Tab v Down Down Enter Down")]
        }
        KeyContext::Workbench => {
            vec![lab("E Ctrl-Home x"), lab("E Ctrl-Home x Ctrl-u"), lab("E Ctrl-Home x Ctrl-x")]
        }
        KeyContext::Field | KeyContext::Typing => vec![lab("Enter")],
    }
}

/// The list of systems, with the errors of a file over it.
fn wrong_file() -> App {
    let (mut app, _) = App::new(crate::fixtures::catalog(), Some("./wrong.toml"));
    let (name, message) = ("./wrong.toml".to_owned(), "error: a wrong line".to_owned());
    app.update(AppEvent::Loaded(Err(LoadError { name, message })));
    app
}

/// The ball on the merry-go-round, with its first picture focused.
fn with_frame() -> App {
    let loaded = loaded("merry-go-round", 1);
    let mut app = in_lab();
    let seen = snapshot(&loaded, 1.0);
    app.update(AppEvent::Loaded(Ok(loaded)));
    app.update(AppEvent::Snapshot(Arc::new(seen)));
    press(&mut app, "Tab Tab Tab");
    app
}

/// The visible facts about an application.
fn facts(app: &App) -> Vec<(String, String)> {
    let mut facts = Vec::new();
    let mut fact = |name: &str, value: String| facts.push((name.to_owned(), value));
    fact("page", format!("{:?}", app.page));
    let over = match &app.overlay {
        None => "nothing".to_owned(),
        Some(Overlay::Help { search, typing, .. }) => {
            let search = search.as_ref().map(tui_input::Input::value);
            format!("the keys, search {search:?} typing {typing}")
        }
        Some(Overlay::Message(error)) => error.message.clone(),
        Some(Overlay::Menu(menu)) => {
            format!("list {:?} line {} marked {:?}", menu.title, menu.selected, menu.marked)
        }
        Some(Overlay::Field(field)) => format!("field {:?}", field.input.value()),
        Some(Overlay::Prompt(prompt)) => format!("prompt {:?}", prompt.input.value()),
        Some(Overlay::Workbench) => "the editor".to_owned(),
    };
    fact("over it", over);
    let buffer = app.open_buffer();
    fact("first line", format!("{:?}", buffer.map(|buffer| &buffer.editor.lines()[0])));
    fact("cursor", format!("{:?}", buffer.map(|buffer| buffer.editor.cursor())));
    fact("asked", format!("{:?}", buffer.map(|buffer| buffer.asking.is_some())));
    fact("scrolled", app.text.scroll.to_string());
    fact("theme", format!("{:?}", app.themes.chosen));
    let read = app.reading.snapshot.as_ref().map(|snapshot| snapshot.time);
    fact("reads t =", format!("{read:?}"));
    fact("line read", app.reading.line.to_string());
    fact("read anew by itself", app.reading.automatic.to_string());
    let notice = app.notifications.shown.as_ref().map_or("nothing", |notice| notice.text.as_str());
    fact("told", notice.to_owned());
    let search = app.picker.search.as_ref().map(|search| search.value().to_owned());
    fact("search", format!("{search:?}"));
    let system = app.picker.current().map_or("none", |entry| entry.name.as_str());
    fact("system", system.to_owned());
    let Some(lab) = &app.lab else { return facts };
    fact("focus", format!("{:?}", lab.focus.pane));
    fact("zoomed", lab.focus.zoomed.to_string());
    let selection = lab.selection;
    fact("parameter", selection.parameter.to_string());
    fact("initial value", selection.initial.to_string());
    fact("gauge", selection.gauge.to_string());
    fact("law scrolled", lab.law_scroll.to_string());
    let search = app.text.search.as_ref();
    let search = search.map(|s| format!("{:?}, match {}", s.input.value(), s.place + 1));
    fact("search in the text", search.unwrap_or_else(|| "none".to_owned()));
    for index in 0..lab.count(ValueId::Parameter) {
        let target = ValueId::Parameter(index);
        let name = lab.value_info(target).unwrap().name;
        fact(&name, format!("{:?}", lab.value(target).unwrap()));
    }
    for (index, plot) in lab.plots.iter().enumerate() {
        let about = |name: &str| format!("plot {index}, {name}");
        match plot.sight {
            Sight::Camera(eye) => {
                fact(&about("direction"), format!("{:.4} {:.4}", eye.yaw, eye.pitch));
                fact(&about("zoom"), eye.zoom.to_string());
                fact(&about("frame"), format!("{:?}", eye.frame));
            }
            Sight::Axes(viewport) => {
                fact(&about("zoom"), format!("{:?}", viewport.zoom));
                fact(&about("pan"), format!("{:?}", viewport.pan));
                fact(&about("log"), viewport.log.to_string());
                fact(&about("equal scales"), viewport.equal.to_string());
                fact(&about("cursor"), format!("{:?}", viewport.cursor));
            }
        }
    }
    facts
}

/// The outcome of a key: the effects requested and the facts changed.
fn outcome(app: &mut App, act: impl FnOnce(&mut App) -> Vec<Effect>) -> String {
    let before = facts(app);
    let effects = act(app);
    let asked = effects.iter().map(|effect| match effect {
        Effect::Execute(Command::Restore(_)) => "Restore".to_owned(),
        Effect::Execute(command) => format!("{command:?}"),
        Effect::Compute(computation) => format!("compute {}", computation.job.name),
        other => format!("{other:?}"),
    });
    let after = facts(app);
    let changed = before.iter().zip(&after).filter(|(before, after)| before != after);
    let changed = changed.map(|((name, before), (_, after))| format!("{name} {before} -> {after}"));
    asked.chain(changed).collect::<Vec<_>>().join("; ")
}

/// The table of keys with the effect of each in a state where it has one, in `tests/screens/keys.txt`.
/// `PHASELAB_BLESS=1 cargo test app::keys` rewrites it; review the changes before you commit them.
#[test]
fn every_key_in_the_table_does_what_is_written() {
    let mut table = String::new();
    for row in KEYS {
        let does = |key: KeyEvent| {
            let outcomes = states(row.context).iter().cloned().map(|mut app| {
                let active = app.key_contexts().contains(&row.context);
                assert!(active, "{:?} is not active in its own state", row.context);
                outcome(&mut app, |app| app.update(AppEvent::Key(key)))
            });
            let found: Vec<String> = outcomes.filter(|outcome| !outcome.is_empty()).collect();
            // An outcome with an effect is preferred to a message that there is none.
            let done = found.iter().find(|outcome| !outcome.starts_with("told "));
            done.or(found.first()).cloned().unwrap_or_default()
        };
        let first = does(row.keys[0]);
        let keys = row.key_names();
        assert!(!first.is_empty(), "{} does nothing: {}", keys[0], row.help);
        for (key, name) in row.keys.iter().zip(&keys) {
            assert_eq!(does(*key), first, "{name} and {}: {}", keys[0], row.help);
        }
        let (context, help) = (row.context.title(), row.help);
        table.push_str(&format!("{context} | {} | {help}\n    {first}\n", keys.join(" ")));
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/screens/keys.txt");
    if std::env::var_os("PHASELAB_BLESS").is_some() {
        std::fs::write(&path, &table).unwrap();
    }
    let meant = std::fs::read_to_string(&path).unwrap_or_default();
    let wrong = table.lines().zip(meant.lines().chain([""])).find(|(now, meant)| now != meant);
    assert!(table == meant, "a key has changed what it does: {wrong:?}");
}

/// Opens the palette of an application.
fn palette(app: &App) -> (App, Menu) {
    let mut app = app.clone();
    press(&mut app, ":");
    let Some(Overlay::Menu(menu)) = &app.overlay else { panic!("there is no palette") };
    let menu = menu.clone();
    (app, menu)
}

#[test]
fn the_palette_lists_every_row_and_does_what_its_key_does() {
    for context in
        KeyContext::ALL.into_iter().filter(|p| !matches!(p, KeyContext::Field | KeyContext::Typing))
    {
        for app in states(context) {
            if app.overlay.is_some() || context == KeyContext::Search {
                continue;
            }
            // a job that is requested is not run: what it finds is shown elsewhere, and takes most of the time
            let mut app = app.clone();
            app.jobs.in_background = true;
            let (open, menu) = palette(&app);
            let contexts = app.key_contexts();
            // the cursor of the nearest plot is listed once, as that of plots
            let repeats =
                |row: &&Binding| row.action == Action::Cursor && row.context != KeyContext::Plot;
            for row in KEYS.iter().filter(|row| !repeats(row)) {
                let line = menu.items.iter().position(|item| {
                    let near = Choice::ActionAt(row.context, row.action);
                    (item.choice == Choice::Action(row.action) || item.choice == near)
                        && item.label.ends_with(row.help)
                        && item.about.starts_with(row.context.title())
                });
                let line = line.unwrap_or_else(|| panic!("{} is not listed", row.help));
                let item = &menu.items[line];
                let near = matches!(item.choice, Choice::ActionAt(..));
                let here = contexts.contains(&row.context) || near;
                assert_eq!(
                    near,
                    !contexts.contains(&row.context) && app.nearest(row.context).is_some()
                );
                assert!(item.unavailable.is_none() == (here && app.offers(row.action)), "{item:?}");
                let mut open = open.clone();
                if let Some(Overlay::Menu(menu)) = &mut open.overlay {
                    menu.selected = line;
                }
                if !here || !app.offers(row.action) {
                    press(&mut open, "Enter");
                    let reported =
                        open.notifications.shown.map(|notice| notice.text).unwrap_or_default();
                    assert!(reported.contains(item.unavailable.as_ref().unwrap()), "{reported}");
                    continue;
                }
                if near {
                    // What it does there is shown by a test of its own.
                    continue;
                }
                let mut taken = app.clone();
                let taken = outcome(&mut taken, |app| {
                    *app = open;
                    app.update(AppEvent::Key(crate::fixtures::key("Enter")))
                });
                let mut pressed = app.clone();
                let pressed = outcome(&mut pressed, |app| app.update(AppEvent::Key(row.keys[0])));
                assert_eq!(taken, pressed, "{:?}: {}", row.context, row.help);
            }
        }
    }
}

/// The help lies over whatever was open, also over a field and a prompt, and leads back to it.
#[test]
fn the_help_is_reached_from_everywhere_and_leads_back() {
    let over = |app: &App| facts(app).into_iter().find(|(name, _)| name == "over it").unwrap().1;
    let cases = [
        ("Enter", KeyContext::Field),
        ("{ H", KeyContext::Field),
        (": z o", KeyContext::Menu),
        ("m", KeyContext::Menu),
        ("E", KeyContext::Workbench),
        ("", KeyContext::Values),
        ("Tab Tab Tab Tab", KeyContext::Plot),
        ("2", KeyContext::Equations),
        ("3", KeyContext::Text),
    ];
    for (keys, context) in cases {
        let mut app = in_lab();
        press(&mut app, keys);
        let before = over(&app);
        press(&mut app, "F1");
        assert!(over(&app).starts_with("the keys"), "{keys}");
        assert_eq!(app.key_contexts_below()[0], context, "{keys}: what holds here comes first");
        press(&mut app, "Esc");
        assert_eq!(over(&app), before, "{keys}");
        // A search takes letters, q among them; the first Esc ends it, the second leads back.
        press(&mut app, "F1 / q u");
        assert_eq!(over(&app), "the keys, search Some(\"qu\") typing true", "{keys}");
        press(&mut app, "Enter");
        assert_eq!(over(&app), "the keys, search Some(\"qu\") typing false", "{keys}");
        press(&mut app, "Esc Esc");
        assert_eq!(over(&app), before, "{keys}");
    }
    let mut app = at_picker();
    press(&mut app, "/ p e F1 Esc");
    assert_eq!(app.picker.search.as_ref().map(tui_input::Input::value), Some("pe"));
}

/// What is copied is what `derive --format latex` prints: equations with their left sides, in an environment.
#[test]
fn the_equations_are_copied_as_latex() {
    let mut app = in_lab();
    assert!(press(&mut app, "y").is_empty(), "not on the page of panes");
    let effects = press(&mut app, "2 y");
    let copied = effects.iter().find_map(|effect| match effect {
        Effect::Copy { text, ending, .. } => Some((text, *ending)),
        _ => None,
    });
    let (text, ending) = copied.expect("it is copied");
    assert_eq!(ending, "tex");
    assert!(text.starts_with("% Simple pendulum\n\\begin{align*}\nL &= "), "{text}");
    assert!(text.contains("\\ddot{\\theta} &= ") && text.ends_with("\\end{align*}\n"), "{text}");
}

/// In every list Home and End go to its ends, and a page is more than a line.
#[test]
fn lists_have_ends_and_pages() {
    let line = |app: &App| match &app.overlay {
        Some(Overlay::Menu(menu)) => menu.selected,
        _ => app.picker.selected,
    };
    let lists: [(fn() -> App, &str); 4] =
        [(in_lab, ":"), (in_lab, ": e"), (in_lab, "m"), (at_picker, "/ p")];
    for (begun, keys) in lists {
        let mut app = begun();
        press(&mut app, keys);
        press(&mut app, "End");
        let last = line(&app);
        assert!(last > 1, "{keys}");
        press(&mut app, "Down");
        assert_eq!(line(&app), last, "{keys}: nothing lies below the end");
        press(&mut app, "PgUp");
        assert_eq!(line(&app), last.saturating_sub(10), "{keys}");
        press(&mut app, "PgDn Home");
        assert_eq!(line(&app), 0, "{keys}");
        press(&mut app, "PgDn");
        assert_eq!(line(&app), last.min(10), "{keys}");
    }
}

/// `c` is a cursor wherever one is in the lab: on a list of values, too.
#[test]
fn the_cursor_is_reached_from_every_pane() {
    let mut lists = 0;
    for tabs in 0..in_lab().lab.expect("a lab").panes().count() {
        let mut app = in_lab();
        (0..tabs).for_each(|_| drop(press(&mut app, "Tab")));
        let before = app.lab.as_ref().unwrap().focus.pane;
        lists += usize::from(!matches!(before, Pane::Plot(_)));
        press(&mut app, "c");
        let lab = app.lab.as_ref().unwrap();
        let Pane::Plot(index) = lab.focus.pane else { panic!("{before:?}: {:?}", lab.focus.pane) };
        let cursor = lab.plots[index].viewport().and_then(|viewport| viewport.cursor);
        assert_eq!(cursor, Some([0.5, 0.5]), "{before:?}");
        // from elsewhere it stays where it is
        if !matches!(before, Pane::Plot(_)) {
            press(&mut app, "Right");
            let moved = app.lab.as_ref().unwrap().plots[index].viewport().unwrap().cursor;
            assert_ne!(moved, cursor, "{before:?}");
            app.lab.as_mut().unwrap().focus.pane = before;
            press(&mut app, "c");
            let lab = app.lab.as_ref().unwrap();
            assert_eq!(lab.focus.pane, Pane::Plot(index));
            assert_eq!(lab.plots[index].viewport().unwrap().cursor, moved, "{before:?}");
        }
    }
    assert!(lists >= 3, "{lists}");
}

/// An action for plots goes to the nearest one, and the focus with it, whatever has the focus and whichever page is
/// shown.
#[test]
fn the_palette_acts_on_the_nearest_pane() {
    for begin in ["", "Tab", "Tab Tab", "2", "3"] {
        let mut app = in_lab();
        press(&mut app, begin);
        press(&mut app, ":");
        app.update(AppEvent::Paste("show or hide a cursor".to_owned()));
        press(&mut app, "Enter");
        let lab = app.lab.as_ref().unwrap();
        assert_eq!((app.page, lab.focus.pane), (Page::Lab, Pane::Plot(1)), "{begin}");
        let cursor = lab.plots[1].viewport().unwrap().cursor;
        assert_eq!(cursor, Some([0.5, 0.5]), "{begin}");
        let reported =
            app.notifications.shown.as_ref().map(|notice| notice.text.clone()).unwrap_or_default();
        assert_eq!(reported, "The focus moved to the phase plane, p_θ against θ.", "{begin}");
    }
    // The motion in space is another pane; a plot that was focused is the nearest.
    let mut app = in_lab();
    press(&mut app, ":");
    app.update(AppEvent::Paste("look from higher".to_owned()));
    press(&mut app, "Enter");
    assert_eq!(app.lab.as_ref().unwrap().focus.pane, Pane::Plot(0));
    let mut app = in_lab();
    press(&mut app, "Tab Tab Tab Tab Tab Tab Tab :");
    app.update(AppEvent::Paste("show or hide a cursor".to_owned()));
    press(&mut app, "Enter");
    assert_eq!(app.lab.as_ref().unwrap().focus.pane, Pane::Plot(3), "the one focused last");
    // Among the systems there is no pane.
    let (_, menu) = palette(&at_picker());
    assert!(menu.items.iter().all(|item| !matches!(item.choice, Choice::ActionAt(..))));
}

#[test]
fn the_palette_opens_types_and_chooses() {
    let first = |query: &str| {
        let (mut app, _) = palette(&in_lab());
        app.update(AppEvent::Paste(query.to_owned()));
        let Some(Overlay::Menu(menu)) = &app.overlay else { panic!() };
        let label = menu.current().unwrap().1.label.clone();
        let effects = press(&mut app, "Enter");
        (
            label,
            outcome(&mut in_lab(), |before| {
                *before = app;
                effects
            }),
        )
    };
    for (query, label, does) in [
        ("ene", "measure the drift of energy and all gauges from here", "Reference"),
        ("kapitza", "open: Kapitza's pendulum", "Load(\"kapitza\")"),
        ("henon", "open: Hénon–Heiles", "Load(\"henon-heiles\")"),
        ("rk4", "method: rk4", "Method(\"rk4\")"),
        ("set l", "set l", "over it nothing -> field \"1\""),
        ("theta0", "set θ₀", "over it nothing -> field \"2\""),
        ("theme light", "theme: light", "theme None -> Some(\"light\")"),
        ("gauges focus", "focus: gauges", "focus Parameters -> Gauges"),
        (
            "zoom",
            "zoom the focused pane until it fills the page, or put it back",
            "zoomed false -> true",
        ),
        ("page 3", "show page 3: notes, source and expectations", "page Lab -> Notes"),
    ] {
        let (found, done) = first(query);
        assert!(found.starts_with(label), "{query} finds {found}");
        assert!(done.contains(does), "{query}: {done}");
    }
}

#[test]
fn the_palette_finds_the_energy() {
    let mut app = in_lab();
    press(&mut app, ": e n e Enter");
    assert_eq!(app.page, Page::Lab);
    press(&mut app, "/ p a g e Space 4 Enter");
    assert_eq!(app.page, Page::Numbers);
}

#[test]
fn a_notice_goes_by_itself() {
    let mut app = in_lab();
    press(&mut app, "u");
    assert!(app.notifications.shown.is_some());
    app.update(AppEvent::Tick(Duration::from_secs(20)));
    assert_eq!(app.notifications.shown, None);
}

#[test]
fn an_error_is_answered_by_a_reset_and_not_by_play() {
    let mut app = in_lab();
    let mut failed = snapshot(&pendulum(), 2.0);
    let error = phaselab::experiment::RunError {
        time: 2.0,
        message: "collision".to_owned(),
        ends_motion: true,
    };
    failed.status = Status::Failed(error);
    app.update(AppEvent::Snapshot(Arc::new(failed)));
    assert!(press(&mut app, "Space").is_empty());
    assert!(app.notifications.shown.is_some_and(|notice| notice.text.contains("reset")));
}
