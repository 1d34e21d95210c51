//! Untrusted input: presets, expressions, terminal bytes, casts, sessions, configurations and scripts, randomly mutated.
//! No input makes the program panic or hang; errors have positions; what is read and written is read back equal.
//!
//! `tests/corpus/<target>` contains the seed inputs, each of which is first checked unchanged; they include inputs that
//! once failed. The mutations are the same in every run. `PHASELAB_FUZZ_SECONDS=600 cargo test fuzz` tests each target
//! for that long; `PHASELAB_FUZZ_SEED` selects other mutations.

mod cast;
mod configuration;
mod expression;
mod hunt;
mod mutation;
mod preset;
mod script;
mod session;
mod target;
mod terminal;

use std::fmt::Debug;
use std::str::FromStr;
use std::time::Duration;

use crate::property::dice;
use hunt::{Length, hunt};
use target::TARGETS;

const SEED: u64 = 1;

/// Reads a number from the environment.
fn number<T: FromStr<Err: Debug>>(variable: &str) -> Option<T> {
    let word = std::env::var(variable).ok()?;
    Some(word.parse().unwrap_or_else(|why| panic!("{variable}={word}: {why:?}")))
}

#[track_caller]
#[expect(clippy::print_stdout, reason = "who looks for long wants to know how much was looked at")]
fn check(name: &str) {
    let target = TARGETS.iter().find(|target| target.name == name).expect("a target");
    let seed = number("PHASELAB_FUZZ_SEED").unwrap_or(SEED);
    let seconds = number("PHASELAB_FUZZ_SECONDS").map(|s| Length::Time(Duration::from_secs(s)));
    let length = seconds.unwrap_or(Length::Cases(target.cases));
    let cases = hunt(target, seed, length).unwrap_or_else(|error| panic!("{error}"));
    assert!(cases > 0);
    println!("{name}: {cases} cases of seed {seed}");
}

#[test]
fn presets() {
    check("presets");
}

#[test]
fn expressions() {
    check("expressions");
}

#[test]
fn input() {
    check("input");
}

#[test]
fn casts() {
    check("casts");
}

#[test]
fn sessions() {
    check("sessions");
}

#[test]
fn configuration() {
    check("configuration");
}

#[test]
fn scripts() {
    check("scripts");
}

/// The fuzzer finds a failure and shrinks it; otherwise the tests above would prove nothing.
#[test]
fn a_failure_is_found_and_made_short() {
    let fails = |bytes: &[u8]| bytes.windows(2).any(|pair| pair == b"}{");
    let inputs = [b"{a} {b} {c}".to_vec(), b"[d] {e}".to_vec()];
    let found = (0..1000).find_map(|case| {
        let bytes = mutation::mutant(&mut dice::Dice::of(SEED, case), &inputs, &["x"]);
        fails(&bytes).then_some(bytes)
    });
    let short = mutation::shrunk(found.expect("such a change is made"), 400, &fails);
    assert_eq!(short, b"}{");
}
