//! The keyboard protocol of kitty: used where the terminal knows it, and switched off on every way of leaving.

use std::time::Duration;

use rustix::process::Signal;

use super::session::{Session, Setup};

const PROGRAM: &str = env!("CARGO_BIN_EXE_phaselab");

/// The question with which the protocol begins, its answer, and the end of all questions.
const QUESTION: &str = "\x1b[?u";
const KNOWN: &str = "\x1b[?0u\x1b[?62;22c";
const UNKNOWN: &str = "\x1b[?62;22c";

/// The flags pushed on the terminal's stack, and popped from it.
const PUSH: &str = "\x1b[>1u";
const POP: &str = "\x1b[<1u";

fn pendulum(arguments: &[&str]) -> Session {
    let arguments = [&["pendulum"], arguments].concat();
    Setup::new(PROGRAM, &arguments).size(120, 40).start()
}

/// The pendulum on a terminal that knows the protocol, and has been told to use it.
fn known() -> Session {
    let mut lab = pendulum(&[]);
    lab.until("it asks", |lab| lab.sent().contains(QUESTION));
    lab.press(KNOWN);
    lab.until("it uses the protocol", |lab| depth(lab) == 1);
    lab.shows("running");
    lab
}

/// How many entries are on the stack of the alternate screen.
fn depth(lab: &Session) -> usize {
    let sent = lab.sent();
    let mut depth: usize = 0;
    for at in sent.match_indices("\x1b[").map(|(at, _)| at) {
        if sent[at..].starts_with(PUSH) {
            depth += 1;
        } else if sent[at..].starts_with(POP) {
            depth = depth.saturating_sub(1);
        }
    }
    depth
}

/// Asserts that nothing is left on the stack, and that it was taken off while the alternate screen was there.
#[track_caller]
fn is_off(lab: &Session) {
    lab.assert_restored();
    assert_eq!(depth(lab), 0);
    let sent = lab.sent();
    assert!(sent.rfind(POP) < sent.rfind("\x1b[?1049l"), "each screen has a stack of its own");
}

#[test]
fn where_it_is_known_shift_enter_is_a_key_of_its_own() {
    for shift_enter in ["\x1b[13;2u", "\x1b[27;2;13~"] {
        let mut lab = known();
        // the cursor of the phase plane, and a motion added there
        lab.press("\t\t\t\t\t");
        lab.shows("cursor");
        lab.press("c");
        // what the key does next
        lab.shows("no cursor");
        lab.press(shift_enter);
        lab.shows("motion 1 begins there");
        lab.press("q");
        assert_eq!(lab.ends().0, 0);
        is_off(&lab);
    }
}

#[test]
fn where_it_is_unknown_or_nothing_is_asked_it_is_not_used() {
    let mut lab = pendulum(&[]);
    lab.until("it asks", |lab| lab.sent().contains(QUESTION));
    lab.press(UNKNOWN);
    lab.shows("running");
    lab.bytes_in(Duration::from_millis(300));
    // an answer after the last one is noise
    lab.press("\x1b[?0u");
    lab.bytes_in(Duration::from_millis(300));
    assert!(!lab.sent().contains(PUSH));
    lab.press("q");
    assert_eq!(lab.ends().0, 0);
    assert!(!lab.sent().contains(POP), "what was not switched on is not switched off");
    lab.assert_restored();

    let mut silent =
        Setup::new(PROGRAM, &["pendulum"]).size(120, 40).variable("TERM", "linux").start();
    silent.shows("running");
    assert!(!silent.sent().contains(QUESTION));
    silent.press("q");
    assert_eq!(silent.ends().0, 0);
}

#[test]
fn it_is_switched_off_on_every_way_of_leaving() {
    for (signal, status) in [
        (Signal::TERM, 143),
        (Signal::HUP, 129),
        (Signal::INT, 130),
        (Signal::QUIT, 131),
        (Signal::ABORT, 134),
        (Signal::USR1, 138),
    ] {
        let mut lab = known();
        lab.signal(signal);
        assert_eq!(lab.ends().0, status, "{signal:?}");
        is_off(&lab);
    }
    // Ctrl-c as the protocol sends it
    let mut lab = known();
    lab.press("\x1b[99;5u");
    assert_eq!(lab.ends().0, 0);
    is_off(&lab);
}

/// The custom page, whose `p` panics, on a terminal that knows the protocol.
#[test]
fn a_panic_switches_it_off_before_it_is_read() {
    let mut page = Setup::page().variable("KEYBOARD", "1").start();
    page.until("it asks", |page| page.sent().contains(QUESTION));
    page.press(KNOWN);
    page.until("it uses the protocol", |page| depth(page) == 1);
    page.press("p");
    assert_eq!(page.ends().0, 101);
    is_off(&page);
    let sent = page.sent();
    assert!(sent.rfind(POP) < sent.rfind("fell off the wall"), "the message comes after it");
}

#[test]
fn a_stop_switches_it_off_and_the_return_on_again_once() {
    let mut lab = known();
    lab.press("\x1b[122;5u");
    lab.stops();
    assert_eq!(depth(&lab), 0, "the shell has its own keyboard");
    lab.signal(Signal::CONT);
    lab.until("it is used again", |lab| depth(lab) == 1);
    lab.shows("running");
    // a return that nobody has seen leave: what was pushed is not pushed twice
    lab.signal(Signal::STOP);
    lab.stops();
    lab.signal(Signal::CONT);
    lab.bytes_in(Duration::from_millis(500));
    assert_eq!(depth(&lab), 1);
    lab.press("q");
    assert_eq!(lab.ends().0, 0);
    is_off(&lab);
}
