//! Scripts: keys pressed in the lab or the picker, the resulting focus, and the effects requested.

use std::sync::Arc;
use std::time::Duration;

use phaselab::app::{App, AppEvent, Effect, LoadError, Overlay, Page, Pane};
use phaselab::experiment::{Checkpoint, Command};

use crate::fixtures::{at_picker, catalog, in_lab, loaded, lowered, pendulum, press, snapshot};

/// A short description of the focus.
fn place(app: &App) -> String {
    let over = match &app.overlay {
        None => String::new(),
        Some(Overlay::Help { .. }) => " + help".to_owned(),
        Some(Overlay::Message(_)) => " + message".to_owned(),
        Some(Overlay::Menu(menu)) => format!(" + menu {:?}", menu.title),
        Some(Overlay::Prompt(prompt)) => format!(" + prompt {:?}", prompt.input.value()),
        Some(Overlay::Workbench) => " + editor".to_owned(),
        Some(Overlay::Field(field)) => format!(" + field {:?}", field.input.value()),
    };
    let page = match (app.page, &app.lab) {
        (Page::Picker, _) => {
            let name = app.picker.current().map_or("nothing", |entry| &entry.name);
            let search = app.picker.search.as_ref().map(|s| format!(" /{}", s.value()));
            format!("picker {name}{}", search.unwrap_or_default())
        }
        (Page::Lab, Some(lab)) => {
            let pane = match lab.focus.pane {
                Pane::Plot(i) => {
                    let plot = &lab.plots[i];
                    let column = |column: &Vec<usize>| match (&column[..], plot.kind.name()) {
                        ([one], "phase") => format!(" {one}"),
                        (several, _) => format!(" {several:?}"),
                    };
                    let columns: String = plot.columns.iter().map(column).collect();
                    let view = plot.view.map_or_else(String::new, |view| format!(" {view}"));
                    format!("{}{columns}{view}", plot.kind.name())
                }
                Pane::Parameters => format!("parameter {}", lab.selection.parameter),
                Pane::Initial => format!("initial {}", lab.selection.initial),
                Pane::Gauges => format!("gauge {}", lab.selection.gauge),
                Pane::Law => format!("law {}", lab.law_scroll),
            };
            format!("lab {pane}{}", if lab.focus.zoomed { " zoomed" } else { "" })
        }
        (page, _) => format!("{page:?}").to_lowercase(),
    };
    page + &over
}

/// The changed parameters of a motion that is brought back.
fn values(motion: &Checkpoint) -> Vec<(&str, f64)> {
    motion.parameters.iter().map(|changed| (changed.name.as_str(), changed.value)).collect()
}

fn asked(effects: &[Effect]) -> String {
    let word = |effect: &Effect| match effect {
        Effect::Execute(Command::Restore(motion)) => format!("Restore({:?})", values(motion)),
        Effect::Execute(command) => format!("{command:?}"),
        other => format!("{other:?}"),
    };
    effects.iter().map(word).collect::<Vec<_>>().join(", ")
}

#[test]
fn scripts_in_the_lab() {
    // The keys, the resulting focus, and the effect of the last key.
    let scripts = [
        ("", "lab parameter 0", ""),
        ("Down", "lab parameter 1", ""),
        ("Up", "lab parameter 0", ""),
        ("End", "lab parameter 3", ""),
        ("End Down j", "lab parameter 3", ""),
        ("Tab", "lab initial 0", ""),
        ("Tab Tab", "lab gauge 0", ""),
        ("Tab Tab Tab", "lab space", ""),
        ("Tab Tab Tab Tab", "lab phase 0 2", ""),
        ("Shift-Tab", "lab potential 3", ""),
        ("Shift-Tab Shift-Tab", "lab time [0]", ""),
        ("z", "lab parameter 0 zoomed", ""),
        ("z z", "lab parameter 0", ""),
        ("z Esc", "lab parameter 0", ""),
        ("Esc", "lab parameter 0", ""),
        ("Esc Esc", "picker pendulum", ""),
        ("Esc Space Esc", "lab parameter 0", ""),
        ("Esc Esc Enter", "lab parameter 0", "Reset, Play"),
        ("? q", "lab parameter 0", ""),
        ("2", "equations", ""),
        ("2 Esc", "lab parameter 0", ""),
        ("3", "notes", ""),
        ("4 1", "lab parameter 0", ""),
        ("?", "lab parameter 0 + help", ""),
        ("? ?", "lab parameter 0", ""),
        ("? Esc", "lab parameter 0", ""),
        ("3 ? Esc", "notes", ""),
        ("Space", "lab parameter 0", "Pause"),
        ("p", "lab parameter 0", "Pause"),
        (".", "lab parameter 0", "Pause, Step(1)"),
        ("2 .", "equations", "Pause, Step(1)"),
        ("]", "lab parameter 0", "Speed(2.0)"),
        ("] ] ]", "lab parameter 0", "Speed(10.0)"),
        ("[", "lab parameter 0", "Speed(0.5)"),
        ("] ] ] ] ] ] ] ] ] ]", "lab parameter 0", "Speed(inf)"),
        ("] ] ] ] ] ] ] ] ] ] [", "lab parameter 0", "Speed(1000.0)"),
        ("r", "lab parameter 0", "Reset"),
        ("R", "lab parameter 0", "FullReset"),
        ("e", "lab parameter 0", "Reference"),
        ("m", "lab parameter 0 + menu \"Method of integration\"", ""),
        ("m Enter", "lab parameter 0", ""),
        ("m Esc", "lab parameter 0", ""),
        ("m q", "lab parameter 0 + menu \"Method of integration\"", ""),
        ("m r k 4 Enter", "lab parameter 0", "Method(\"rk4\")"),
        ("Right", "lab parameter 0", "Parameter { index: 0, value: 1.02 }"),
        ("Left", "lab parameter 0", "Parameter { index: 0, value: 0.98 }"),
        ("L", "lab parameter 0", "Parameter { index: 0, value: 1.2 }"),
        ("Shift-Left", "lab parameter 0", "Parameter { index: 0, value: 0.8 }"),
        ("Right Right Right", "lab parameter 0", "MoveParameter { index: 0, value: 1.06 }"),
        ("Right u", "lab parameter 0", "Restore([])"),
        ("Right u U", "lab parameter 0", "Restore([(\"m\", 1.02)])"),
        ("Right Backspace", "lab parameter 0", "MoveParameter { index: 0, value: 1.0 }"),
        ("Tab Right", "lab initial 0", "Initial { index: 0, value: 2.01 }"),
        ("Tab Down Down Left", "lab initial 1", "Initial { index: 1, value: -0.005 }"),
        ("Enter", "lab parameter 0 + field \"1\"", ""),
        ("Enter q", "lab parameter 0 + field \"q\"", ""),
        ("Enter Esc", "lab parameter 0", ""),
        ("Enter Ctrl-c", "lab parameter 0 + field \"1\"", "Quit"),
        ("q", "lab parameter 0", "Quit"),
        ("4 q", "numbers", "Quit"),
        // Esc and q that arrived together.
        ("2 Alt-q", "lab parameter 0", "Quit"),
        ("Enter Alt-q", "lab parameter 0 + field \"1\"", ""),
        ("Ctrl-z", "lab parameter 0", "Suspend"),
        ("Ctrl-l", "lab parameter 0", "Repaint"),
        (": m e t h o d Space r k 4 Enter s 0 . 5 Enter", "lab parameter 0", "StepSize(0.5)"),
        ("a Ctrl-u 1 e - 9 Enter", "lab parameter 0", "Tolerance(1e-9)"),
        // The axes of a plot: time horizontally, then θ̇ vertically; then p against θ again.
        ("Tab Tab Tab v", "lab space + menu \"Choose a view or the horizontal axis\"", ""),
        ("Tab Tab Tab v Down Down Enter", "lab space + menu \"Vertical axis, against t\"", ""),
        ("Tab Tab Tab v Down Down Enter Down Enter", "lab time [1]", ""),
        ("Tab Tab Tab v Down Down Enter Tab Down Tab Enter", "lab time [0, 1]", ""),
        ("Tab Tab Tab v Down Down Down Down Down Down Enter Down Down Enter", "lab phase 0 2", ""),
        ("Tab Tab Tab v Esc", "lab space", ""),
        (": z o o m Enter", "lab parameter 0 zoomed", ""),
    ];
    for (keys, wanted, effects) in scripts {
        let mut app = in_lab();
        let words: Vec<&str> = keys.split_whitespace().collect();
        let mut last = Vec::new();
        for word in words {
            last = press(&mut app, word);
        }
        assert_eq!(place(&app), wanted, "after {keys}");
        assert_eq!(asked(&last), effects, "after {keys}");
    }
}

#[test]
fn scripts_in_the_picker() {
    let scripts = [
        ("", "picker pendulum", ""),
        ("Home", "picker nothing", ""),
        ("Home Down", "picker planet", ""),
        ("Enter", "lab parameter 0", "Reset, Play"),
        ("/", "picker planet /", ""),
        ("h e n o n", "picker henon-heiles /henon", ""),
        ("/ q", "picker nothing /q", ""),
        ("k a p Enter", "picker kapitza /kap", "Load(\"kapitza\")"),
        ("/ k a p Esc", "picker kapitza", ""),
        ("q", "picker pendulum", "Quit"),
        ("/ Ctrl-c", "picker planet /", "Quit"),
        ("/ x y z Enter", "picker nothing /xyz", ""),
        ("Esc", "picker pendulum", ""),
        ("?", "picker pendulum + help", ""),
    ];
    for (keys, wanted, effects) in scripts {
        let mut app = at_picker();
        let mut last = Vec::new();
        for word in keys.split_whitespace() {
            last = press(&mut app, word);
        }
        assert_eq!(place(&app), wanted, "after {keys}");
        assert_eq!(asked(&last), effects, "after {keys}");
    }
}

#[test]
fn a_preview_waits_until_the_selection_rests() {
    let mut app = at_picker();
    press(&mut app, "Home Down Down");
    let name = app.picker.current().unwrap().name.clone();
    assert_eq!(app.update(AppEvent::Tick(Duration::from_millis(50))), []);
    press(&mut app, "Up");
    assert_eq!(
        app.update(AppEvent::Tick(Duration::from_millis(100))),
        [],
        "{name} was left before"
    );
    assert_eq!(
        app.update(AppEvent::Tick(Duration::from_millis(100))),
        [Effect::Load("planet".into())]
    );
    assert_eq!(app.update(AppEvent::Tick(Duration::from_millis(100))), []);
}

#[test]
fn a_system_opened_before_it_is_there_opens_when_it_comes() {
    let mut app = at_picker();
    press(&mut app, "/ k a p");
    assert_eq!(press(&mut app, "Enter"), [Effect::Load("kapitza".into())]);
    assert_eq!(press(&mut app, "Enter"), [], "it is on its way");
    assert_eq!(app.page, Page::Picker);
    assert_eq!(
        app.update(AppEvent::Loaded(Ok(loaded("kapitza", 2)))),
        [Effect::Execute(Command::Play)]
    );
    assert_eq!(app.page, Page::Lab);
}

#[test]
fn what_cannot_be_loaded_is_reported_and_the_rest_goes_on() {
    let (mut app, effects) = App::new(catalog(), Some("own.toml"));
    assert_eq!(effects, [Effect::Load("own.toml".into())]);
    let error = LoadError { name: "own.toml".into(), message: "line 1\nline 2".into() };
    app.update(AppEvent::Loaded(Err(error.clone())));
    assert!(matches!(&app.overlay, Some(Overlay::Message(f)) if *f == error));
    press(&mut app, "Esc");
    assert!(app.overlay.is_none());
    assert_eq!(app.page, Page::Picker);
    assert_eq!(press(&mut app, "Enter").len(), 1, "another system can be opened");
}

#[test]
fn snapshots_of_another_system_are_dropped() {
    let mut app = in_lab();
    let mut other = snapshot(&pendulum(), 7.0);
    other.epoch = 9;
    app.update(AppEvent::Snapshot(Arc::new(other)));
    assert_eq!(app.snapshot().unwrap().time, 2.0);
}

#[test]
fn news_of_the_experiment_is_reported_once() {
    let mut app = in_lab();
    let mut reported = snapshot(&pendulum(), 2.5);
    reported.notices = ["the energy jumped".to_owned()].into();
    app.update(AppEvent::Snapshot(Arc::new(reported.clone())));
    assert!(
        app.notifications.shown.take().is_some_and(|notice| notice.text == "the energy jumped")
    );
    app.update(AppEvent::Snapshot(Arc::new(reported)));
    assert_eq!(app.notifications.shown, None);
}

#[test]
fn a_page_of_text_does_not_scroll_beyond_its_end() {
    let mut app = in_lab();
    press(&mut app, "2");
    app.update(AppEvent::Drawn(phaselab::app::Drawn { beyond: 3, rows: 20, ..Default::default() }));
    press(&mut app, "Down Down Down Down Down Down");
    assert_eq!(app.text.scroll, 3);
    press(&mut app, "Up");
    assert_eq!(app.text.scroll, 2);
    press(&mut app, "End g");
    assert_eq!(app.text.scroll, 0);
}

/// The lab with a free particle and one impulse per name applied on command, beside a scheduled one.
pub(super) fn with_impulses(names: &[&str]) -> App {
    let impulse = |name: &&str| {
        format!("[[impulses]]\nname = '{name}'\nchange = {{ p_x = '1' }}\nabout = 'a {name}'\n")
    };
    let impulses: String = names.iter().map(impulse).collect();
    let text = format!(
        "title = 'a test'\n[coordinates]\nx = {{ initial = 0.0 }}\n[lagrangian]\nL = \"1/2*x'^2\"\n\
         [[impulses]]\nname = 'tick'\nevery = 1.0\nchange = {{ p_x = '1' }}\n{impulses}"
    );
    let loaded = lowered(&text);
    let mut app = in_lab();
    app.update(AppEvent::Snapshot(Arc::new(snapshot(&pendulum(), 2.0))));
    let seen = snapshot(&loaded, 1.0);
    app.update(AppEvent::Loaded(Ok(loaded)));
    app.update(AppEvent::Snapshot(Arc::new(seen)));
    app
}

#[test]
fn an_impulse_is_applied_by_its_key_or_by_its_name() {
    let mut app = in_lab();
    assert_eq!(asked(&press(&mut app, "b")), "");
    assert!(app.notifications.shown.is_some_and(|notice| notice.text.contains("no impulses")));
    let mut app = with_impulses(&[]);
    assert_eq!(asked(&press(&mut app, "b")), "");
    assert!(app.notifications.shown.is_some_and(|notice| notice.text.contains("by themselves")));
    let mut app = with_impulses(&["push"]);
    assert_eq!(asked(&press(&mut app, "b")), "ApplyImpulse(1)");
    let mut app = with_impulses(&["push", "kick"]);
    assert_eq!(asked(&press(&mut app, "b")), "");
    assert!(place(&app).ends_with("+ menu \"Impulse\""), "{}", place(&app));
    assert_eq!(asked(&press(&mut app, "Down Enter")), "ApplyImpulse(2)");
    assert_eq!(asked(&press(&mut app, ": k i c k Enter")), "ApplyImpulse(2)");
}

#[test]
fn a_reset_takes_back_what_was_reported_before() {
    for key in ["r", "R"] {
        let mut app = in_lab();
        press(&mut app, "b");
        assert!(app.notifications.shown.is_some());
        press(&mut app, key);
        assert_eq!(app.notifications.shown, None, "{key}");
    }
}
