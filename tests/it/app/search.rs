//! Searching: the systems and actions found, and their order.

use phaselab::app::keymap::{Binding, KEYS};
use phaselab::app::{Action, App, AppEvent, Overlay};

use crate::fixtures::{at_picker, in_lab, press};

/// The names of the systems that match a search.
fn systems(query: &str) -> Vec<String> {
    let mut app = at_picker();
    press(&mut app, "/");
    app.update(AppEvent::Paste(query.to_owned()));
    let shown = app.picker.shown();
    shown.into_iter().map(|index| app.picker.entries[index].name.clone()).collect()
}

/// The palette's items for a search.
fn lines(app: &App, query: &str) -> Vec<String> {
    let mut app = app.clone();
    press(&mut app, ":");
    app.update(AppEvent::Paste(query.to_owned()));
    let Some(Overlay::Menu(menu)) = &app.overlay else { panic!("there is no palette") };
    menu.shown().into_iter().map(|index| menu.items[index].label.clone()).collect()
}

#[test]
fn a_letter_leaves_the_systems_of_which_a_word_begins_with_it() {
    let all = at_picker().picker.entries.len();
    let found = systems("m");
    assert!(!found.is_empty() && found.len() < all / 4, "{} of {all}", found.len());
    assert_eq!(found[0], "magnetic-mirror", "a title that begins with it is first");
    assert!(!found.contains(&"pendulum".to_owned()), "an m within a word is none");
}

#[test]
fn the_best_system_is_first() {
    for (query, first) in [
        ("pendulum", "pendulum"),
        ("henon", "henon-heiles"),
        ("hh", "henon-heiles"),
        ("ddp", "driven-damped-pendulum"),
        ("pend", "pendulum"),
        ("doub pend", "double-pendulum"),
        ("foucault", "foucault"),
        ("kepler", "kepler-brackets"),
    ] {
        let found = systems(query);
        assert_eq!(found.first().map(String::as_str), Some(first), "{query}: {found:?}");
    }
    // A system whose description has a word that begins so comes later, and one that depends on something not at all.
    let found = systems("pend");
    assert!(found.contains(&"least-action".to_owned()), "{found:?}");
    assert!(!found.contains(&"darwin".to_owned()), "{found:?}");
    assert_eq!(systems("zzz"), [""; 0]);
    assert_eq!(systems("").len(), at_picker().picker.entries.len());
}

#[test]
fn the_palette_begins_with_what_people_do() {
    let lines = lines(&in_lab(), "");
    assert!(lines[0].starts_with("pause"), "{lines:?}");
    let moving = ["the value above", "less, by a fine step", "the first value"];
    let first = |wanted: &str| lines.iter().position(|line| line.starts_with(wanted));
    for line in moving {
        assert!(first(line) > first("open: "), "{line}");
    }
    for word in ["step", "reset", "choose the method", "quit", "set l", "set the initial"] {
        let place = first(word).unwrap_or_else(|| panic!("{word} is missing"));
        assert!(place < 30, "{word} is line {place}");
    }
}

#[test]
fn the_palette_finds_words_and_not_chance() {
    let lab = in_lab();
    for (query, first) in [
        ("undo", "undo the last"),
        ("pause", "pause"),
        ("quit", "quit, "),
        ("ene", "measure the drift of energy"),
        ("theme", "theme: dark"),
        ("method", "method: "),
    ] {
        let found = lines(&lab, query);
        assert!(found[0].starts_with(first), "{query}: {found:?}");
    }
    let chance = lines(&lab, "ene");
    assert!(!chance.iter().any(|line| line.starts_with("focus the next")), "{chance:?}");
}

/// The footer and the palette have one word for an action.
#[test]
fn a_line_of_the_palette_has_the_word_of_the_footer() {
    let moves = |row: &&Binding| {
        !matches!(row.action, Action::Move(_) | Action::Change { .. }) && !row.hint.is_empty()
    };
    for row in KEYS.iter().filter(moves) {
        assert!(row.help.contains(row.hint), "{}: {}", row.hint, row.help);
    }
}

/// Who does not know how a key is put finds it by the word that a textbook has.
#[test]
fn the_palette_knows_other_words() {
    let lab = in_lab();
    for (query, first) in [
        ("conserved", "ask for a bracket"),
        ("is this conserved", "ask for a bracket"),
        ("stable", "find equilibria"),
        ("stability", "find equilibria"),
        ("equilibrium", "find equilibria"),
        ("restart", "reset to the initial values"),
        ("trail", "reset to the initial values"),
        ("chaos", "measure the Lyapunov exponent"),
        ("drag", "use the mouse here"),
        ("zoom in", "look closer"),
        ("gif", "record the screen"),
        ("print", "write a screenshot"),
        ("action variable", "show actions: action variable"),
        ("poincare", "type the surface of a section"),
        ("eigenvalues", "find equilibria"),
        ("integrable", "search for constants of the motion"),
        ("Floquet", "find the periodic orbit"),
        ("noether", "carry the state along the flow"),
        ("canonical", "show page 2"),
    ] {
        let found = lines(&lab, query);
        assert!(found.first().is_some_and(|line| line.starts_with(first)), "{query}: {found:?}");
    }
    // Another system comes before actions only where it is called so.
    assert!(lines(&lab, "stable").iter().any(|line| line == "open: Double well"));
    assert_eq!(lines(&lab, "double well")[0], "open: Double well");
    assert_eq!(lines(&lab, "damped")[0], "open: Damped oscillator");
    // What cannot be done here is not listed beside the same thing that can.
    for query in ["undo", "new", "redo"] {
        let mut found = lines(&lab, query);
        found.retain(|line| line.contains("new system") || line.contains("undone change"));
        assert!(found.len() < 2, "{found:?}");
    }
}

/// The palette finds every kind of plot by its name, and shows it in the nearest plot.
#[test]
fn every_kind_of_plot_is_found_by_its_name() {
    for kind in phaselab::instrument::INSTRUMENTS {
        let found = lines(&in_lab(), kind.name());
        let shown =
            |line: &String| line.starts_with("show ") && line.to_lowercase().contains(kind.name());
        assert!(found.iter().any(shown), "{}: {found:?}", kind.name());
    }
    for begin in ["", "Tab", "2"] {
        let mut app = in_lab();
        press(&mut app, begin);
        press(&mut app, ":");
        app.update(AppEvent::Paste("Legendre".to_owned()));
        press(&mut app, "Enter");
        let lab = app.lab.as_ref().unwrap();
        let (_, plot) = lab.focused_plot().expect("a plot has the focus");
        assert_eq!(plot.kind.name(), "legendre", "after {begin:?}");
        assert_eq!(app.page, phaselab::app::Page::Lab);
    }
}
