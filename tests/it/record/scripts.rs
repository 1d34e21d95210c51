//! Scripts: their contents, and the reports on errors.

use phaselab::diagnostic::{Diagnostic, Document};
use phaselab::preset::Catalog;
use phaselab::record::script::{COMMANDS, ScriptStep};
use phaselab::record::{Script, play, transcript};

use super::{played, recorded, script};

/// The errors of a script as `line:column message; help`.
fn diagnostics(text: &str) -> Vec<String> {
    let document = Document::new("test.demo", text);
    let tell = |diagnostic: &Diagnostic| {
        let (line, column) = document.line_and_column(diagnostic.place.start);
        let help = diagnostic.help.as_deref().map_or(String::new(), |help| format!("; {help}"));
        format!("{line}:{column} {}{help}", diagnostic.message)
    };
    let found = match Script::read(&document) {
        Err(diagnostics) => diagnostics,
        Ok(script) => {
            let system = Catalog::with_folder(None).find("pendulum").expect("a preset");
            match play(&script, &system, "pendulum", (80, 24)) {
                Err(diagnostics) => diagnostics,
                Ok(recording) => recording.false_claims,
            }
        }
    };
    found.iter().map(tell).collect()
}

#[test]
fn a_demo_is_shown_without_the_footer() {
    let keys = "Assert screen \"? help\"";
    for (hide, seen) in [("", true), ("Hide footer\n", false)] {
        let found = diagnostics(&format!("{hide}Wait 1s\n{keys}"));
        assert_eq!(found.is_empty(), seen, "{found:?}");
    }
}

#[test]
fn errors_stand_in_their_places() {
    let check = |text: &str, expected: &[&str]| assert_eq!(diagnostics(text), expected, "{text}");
    check("Wait 1s", &[]);
    check("  # nothing\n\nWiat 2s", &["3:1 unknown command `Wiat`; did you mean `Wait`?"]);
    check("wait 2s", &["1:1 unknown command `wait`; did you mean `Wait`?"]);
    // a byte order mark in front is none of its words
    check("\u{feff}Wait 1s", &[]);
    check("\u{feff}Wait 1s\nWiat 2s", &["2:1 unknown command `Wiat`; did you mean `Wait`?"]);
    check("Wait", &["1:5 here a time is missing"]);
    check("Wait 2", &["1:6 is 2 in seconds or milliseconds?; write 2s or 2ms"]);
    check("Wait soon", &["1:6 `soon` is not a time; write it as 2s, 0.5s or 150ms"]);
    check("Wait 1s 2s", &["1:9 unexpected `2s`; it is written Wait 2s"]);
    check("Wait 1s\nWait 9999999s", &["2:14 a demo may last an hour; this one lasts 10000000 s"]);
    check("Press Tba\nWait 1s", &["1:7 unknown key `Tba`; did you mean `Tab`?"]);
    check("Press x3", &["1:7 `x3` belongs after a key; as in Press Down x3"]);
    check("Press", &["1:6 here a key is missing"]);
    check("Caption bare words", &["1:9 a text belongs in quotes; write it as \"bare words\""]);
    check("Caption \"open", &["1:9 this text has no end; put a \" after it"]);
    check(
        "Wait 1s\nSize 80x24",
        &[
            "2:1 `Size` comes too late: the demo has begun; settings of the whole demo come before its first step",
        ],
    );
    check("Size 80x24\nSize 90x24\nWait 1s", &["2:1 `Size` is given twice"]);
    check("Size 80\nWait 1s", &["1:6 a size is written 100x30, columns and rows"]);
    check("Size 8x8\nWait 1s", &["1:6 a screen has from 40x11 to 400x150 characters"]);
    check("Theme drak\nWait 1s", &["1:7 `drak` is not a theme; did you mean `dark`?"]);
    check("Hide footer\nWait 1s", &[]);
    check("Hide panes\nWait 1s", &["1:6 `panes` is not what is hidden; there are footer"]);
    check("Fps 1000\nWait 1s", &["1:5 `1000`: there are 1 to 60 frames in a second"]);
    check(
        "Marker \"a\"\nWait 1s\nMarker \"a\"",
        &["3:1 there are two markers `a`; a player finds a chapter by its name: give each its own"],
    );
    check(
        "Size 40x11\nCaption \"0123456789 123456789 123456789 123456789\"\nWait 1s",
        &["2:1 a caption may have 36 characters at this size; this one has 40"],
    );
    check("Press Tab", &[]);
    check(
        "Set l = 2",
        &[
            "1:10 there is nothing to see: no time passes in this script; let it pass with `Wait 2s`",
        ],
    );
    check("Set l 2\nWait 1s", &["1:8 here `=` is missing"]);
    check(
        "Set lenght = 2\nWait 1s",
        &["1:5 pendulum has no parameter or initial value `lenght`; \
         there are m, l, g, theta0, theta, theta'"],
    );
    check("Set l = 2*lx\nWait 1s", &["1:11 unknown name `lx`; did you mean `l`?"]);
    check("Sweep l 2 in 1s", &["1:9 here `to` is missing"]);
    check("Sweep l to 2 and g to 3 in 1s", &[]);
    check("Sweep l to 2 and in 1s", &["1:21 here `to` is missing"]);
    check("Sweep l to 2 and l to 3 in 1s", &["1:18 `l` cannot be swept twice at once"]);
    check(
        "Sweep l to 2 and gg to 3 in 1s",
        &["1:18 pendulum has no parameter or initial value `gg`; did you mean `g`?"],
    );
    check("Sweep l to 2", &["1:13 here `in` is missing"]);
    check("Speed -1\nWait 1s", &["1:7 a speed must be above zero; this is -1"]);
    check("Press q\nWait 1s", &["2:1 the lab was left before this line"]);
    // several at once, each at its position
    assert_eq!(diagnostics("Wiat 1s\nPress Entr\nWait\n").len(), 3);
}

#[test]
fn claims_are_held_against_the_moment() {
    let check = |text: &str, expected: &[&str]| {
        assert_eq!(diagnostics(&format!("Wait 1s\n{text}")), expected, "{text}");
    };
    check("Assert energy = -m*g*l*cos(theta0) within 1e-12", &[]);
    check("Assert t > 0.5", &[]);
    check("Assert t = 1 within 1e-15", &[]);
    check("Assert t < 0.5", &["2:1 this is false: t is 1, not below 0.5"]);
    check(
        "Assert t = 2 within 0.5",
        &["2:1 this is false: t is 1, which is 1 off 2, not within 0.5"],
    );
    check("Assert drift energy < 1e-12", &[]);
    check(
        "Assert drift enregy < 1e-12",
        &["2:14 pendulum has no gauge `enregy`; did you mean `energy`?"],
    );
    check("Assert greatest theta = theta0 within 1e-12", &[]);
    check("Assert \"kinetic energy\" > 0", &[]);
    check("Assert phase.saddles = 2 within 0", &[]);
    check("Assert phase.separatrices > 0", &[]);
    check("Assert phase.saddles < 1", &["2:1 this is false: phase.saddles is 2, not below 1"]);
    check(
        "Assert phas.saddles > 0",
        &["2:8 this version has no kind of plot `phas`; did you mean `phase`?"],
    );
    check(
        "Assert phase.sadles > 0",
        &[
            "2:14 this version has no number of a plot of this kind `sadles`; did you mean `saddles`?",
        ],
    );
    check("Assert status running", &[]);
    check(
        "Assert status runing",
        &["2:15 `runing` is not how an experiment stands; did you mean `running`?"],
    );
    check("Assert status paused", &["2:1 this is false: the motion is running"]);
    check("Assert screen \"Phase\"", &[]);
    check("Assert screen \"Fase\"", &["2:1 this is false: \"Fase\" is not on the screen"]);
    check("Assert t = 1", &["2:13 here how far it may be off is missing; add `within 1e-9`"]);
    check("Assert t", &["2:9 one of `=` `<` `>` is missing here, between spaces"]);
    check(
        "Assert count impulse = 1",
        &["2:14 pendulum has no event or impulse `impulse`; there are none"],
    );
    check("Assert thetta = 1 within 1", &["2:8 unknown name `thetta`; did you mean `theta`?"]);
}

#[test]
fn keys_are_the_keys_of_the_lab() {
    let recording =
        played("pendulum", "Press Space\nWait 1s\nAssert status paused\nAssert t = 0 within 0");
    assert!(recording.false_claims.is_empty());
    let recording = played(
        "pendulum",
        "Press Down Enter\nPress Backspace x4\nType \"2*m\"\nPress Enter\nWait 1s\nAssert l = 2 within 0",
    );
    assert!(recording.false_claims.is_empty(), "{:?}", recording.false_claims);
}

#[test]
fn a_sweep_is_even_and_arrives() {
    let text = "Fps 10\nPace 0s\nSweep l from 1 to 3 in 1s\nAssert l = 3 within 0\nWait 1s\nAssert t = 2 within 1e-12";
    let recording = played("pendulum", text);
    assert!(recording.false_claims.is_empty(), "{:?}", recording.false_claims);
    assert_eq!((recording.frames, recording.end), (20, 2_000_000));
}

#[test]
fn several_values_are_swept_at_once() {
    let text = "Fps 10\nPace 0s\nSweep l from 1 to 3 and g to 2*9.81 in 1s\nAssert l = 3 within 0\n\
                Assert g = 19.62 within 0\nWait 1s";
    let recording = played("pendulum", text);
    assert!(recording.false_claims.is_empty(), "{:?}", recording.false_claims);
    assert_eq!(recording.frames, 20);
    let account = transcript::write(&recording);
    assert!(account.contains("  sweep     l from 1 to 3, g from 9.81 to 19.62"), "{account}");
}

#[test]
fn what_a_script_changes_is_selected() {
    let recording = played("pendulum", "Size 110x32\nSweep g to 20 in 1s\nAssert screen \"› g \"");
    assert_eq!(recording.false_claims, []);
}

#[test]
fn what_a_script_sets_and_sweeps_is_taken_back_as_one() {
    let text = "Fps 10\nSet m = 2\nWait 1s\nSweep l from 1.5 to 3 and g to 20 in 2s\nPress u\n\
                Assert screen \"undone: l 3 → 1, g 20 → 9.81\"\nAssert l = 1 within 0\nAssert g = 9.81 within 0\nAssert m = 2 within 0\n\
                Press U\nAssert l = 3 within 0\nAssert g = 20 within 0\nPress u x2\n\
                Assert m = 1 within 0\nAssert l = 1 within 0\n\
                Set theta = 1\nWait 1s\nSet theta = 1\nAssert t = 0 within 0";
    let recording = played("pendulum", text);
    let wrong: Vec<_> = recording.false_claims.iter().map(|claim| &claim.message).collect();
    assert!(wrong.is_empty(), "{wrong:?}");
}

#[test]
fn the_account_tells_what_was_done_and_found() {
    let text = "Title \"Ein Pendel\"\nCaption \"It swings\"\nPress z\nWait 1s\nMarker \"One\"\n\
                Assert t > 1\nAssert t > 9\nWait 1s";
    let account = transcript::write(&recorded("pendulum", text));
    let lines: Vec<&str> = account.lines().collect();
    assert_eq!(lines[0], "Ein Pendel");
    assert_eq!(lines[1], "80x24 characters, 20 frames a second, 2.15 s");
    for line in [
        "    0.00 s  caption   It swings",
        "    0.00 s  press     z",
        "    1.15 s  chapter   One",
        "    1.15 s  found     t is 1.15, above 1",
        "    1.15 s  FALSE     t is 1.15, not above 9",
        "    2.15 s  end",
    ] {
        assert!(lines.contains(&line), "{line}\n{account}");
    }
    assert_eq!(account.matches("phaselab  Simple pendulum").count(), 2);
}

#[test]
fn every_command_is_written_as_its_row_says() {
    for command in COMMANDS {
        assert!(command.form.starts_with(command.name), "{}", command.name);
        assert!(!command.about.ends_with('.'), "{}", command.about);
    }
    let script = script("Sweep l from 1 to 2 in 3s # on\nPress \"\nCaption");
    assert!(matches!(script.steps[0].1, ScriptStep::Sweep { .. }));
}
