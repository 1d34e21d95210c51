//! The terminal is asked for its background: a light one gets the light theme, whatever it answers does no harm.

use std::time::Duration;

use super::session::{Session, Setup, quits};

const PROGRAM: &str = env!("CARGO_BIN_EXE_phaselab");

/// OSC 11 and the request for the device's attributes.
const QUESTION: &str = "\x1b]11;?\x07\x1b[c";

/// The answer to the second of them.
const ATTRIBUTES: &str = "\x1b[?62;22c";

/// The name of the program, in the accent of the theme for dark terminals and of that for light ones.
const DARK: &str = "38;2;63;167;214";
const LIGHT: &str = "38;2;0;95;158";

/// The pendulum with these further arguments and environment.
fn pendulum(arguments: &[&str], environment: &[(&'static str, &str)]) -> Session {
    let arguments = [&["pendulum"], arguments].concat();
    let mut setup =
        Setup::new(PROGRAM, &arguments).size(120, 40).variable("COLORTERM", "truecolor");
    for (name, value) in environment {
        setup = setup.variable(name, *value);
    }
    setup.start()
}

/// Waits for the question, answers it, and waits until the whole picture is in the colours of a theme.
fn answered(lab: &mut Session, answer: &str, colour: &str) {
    lab.until("it asks", |lab| lab.sent().contains(QUESTION));
    lab.press(answer);
    lab.until("it is in the colours of the theme", |lab| in_colour(lab, colour));
}

/// Whether the name of the program at the top is in this colour.
fn in_colour(lab: &Session, colour: &str) -> bool {
    let screen = lab.screen();
    let mut top = (0..10).filter_map(|column| screen.cell(0, column));
    let found = top.find(|cell| cell.contents() == "p").map(vt100::Cell::fgcolor);
    matches!(found, Some(vt100::Color::Rgb(r, g, b)) if format!("38;2;{r};{g};{b}") == colour)
}

#[test]
fn a_light_terminal_gets_the_light_theme_and_a_dark_one_the_dark() {
    for (background, colour) in [
        ("rgb:ffff/ffff/ffff", LIGHT),
        ("rgb:fdfd/f6f6/e3e3", LIGHT),
        ("rgb:0000/0000/0000", DARK),
        ("rgb:1e1e/1e1e/2e2e", DARK),
    ] {
        for end in ["\x07", "\x1b\\"] {
            let mut lab = pendulum(&[], &[]);
            answered(&mut lab, &format!("\x1b]11;{background}{end}{ATTRIBUTES}"), colour);
            quits(lab);
        }
    }
}

#[test]
fn the_first_picture_does_not_wait_for_the_answer() {
    let mut lab = pendulum(&[], &[]);
    lab.shows("running");
    assert!(in_colour(&lab, DARK), "nothing has been answered yet");
    quits(lab);
    // An answer that comes while it runs is taken all the same, and what says nothing changes nothing.
    let mut lab = pendulum(&[], &[("COLORFGBG", "0;15")]);
    lab.shows("running");
    assert!(in_colour(&lab, LIGHT));
    answered(&mut lab, &format!("\x1b]11;rgb:0000/0000/0000\x07{ATTRIBUTES}"), DARK);
    quits(lab);
}

#[test]
fn an_answer_that_is_none_changes_nothing_and_presses_no_key() {
    for answer in [
        ATTRIBUTES,
        "\x1b]11;rgb:qqqq/2222/3333\x07\x1b[?62;22c",
        "\x1b]11;2\x1b\\\x1b[?1;2c",
        // It was asked for before the attributes: what comes after them was not.
        "\x1b[?62;22c\x1b]11;rgb:ffff/ffff/ffff\x07",
    ] {
        let mut lab = pendulum(&[], &[]);
        answered(&mut lab, answer, DARK);
        lab.shows("running");
        lab.bytes_in(Duration::from_millis(300));
        assert!(in_colour(&lab, DARK), "{answer:?}");
        assert!(lab.text().contains("Parameters"), "{answer:?} has pressed a key");
        quits(lab);
    }
}

#[test]
fn a_theme_that_was_chosen_is_not_asked_about() {
    let silent = |arguments: &[&str], environment: &[(&'static str, &str)]| {
        let mut lab = pendulum(arguments, environment);
        lab.shows("running");
        assert!(!lab.sent().contains("\x1b]11"), "{arguments:?} {environment:?}");
        // What the terminal would show is not sent at all; elsewhere its keyboard is asked about.
        let is_known = environment.iter().any(|(name, _)| ["TERM", "STY"].contains(name));
        assert_eq!(
            lab.sent().contains("\x1b[?u\x1b[c"),
            !is_known,
            "{arguments:?} {environment:?}"
        );
        assert_eq!(lab.sent().contains("\x1b[c"), !is_known, "{arguments:?} {environment:?}");
        // Without a question there is no answer.
        lab.press("\x1b]11;rgb:ffff/ffff/ffff\x07");
        lab.bytes_in(Duration::from_millis(200));
        assert!(!in_colour(&lab, LIGHT));
        quits(lab);
    };
    silent(&["--theme", "dark"], &[]);
    silent(&[], &[("PHASELAB_THEME", "contrast")]);
    silent(&[], &[("TERM", "linux")]);
    silent(&[], &[("STY", "1.pts-0.host")]);
    silent(&["--color", "never"], &[]);
}

#[test]
fn who_leaves_at_once_leaves_no_answer_to_the_shell() {
    let mut lab = pendulum(&[], &[]);
    lab.until("it asks", |lab| lab.sent().contains(QUESTION));
    lab.press("q");
    // The answer comes after the key and before the end.
    lab.press(&format!("\x1b]11;rgb:ffff/ffff/ffff\x07{ATTRIBUTES}"));
    assert_eq!(lab.ends().0, 0);
    lab.assert_restored();
}
