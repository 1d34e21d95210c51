//! The fuzzing loop: the seed inputs of a target, then mutations of them, each within a time limit.

use std::fs;
use std::panic::catch_unwind;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::{Duration, Instant};

use super::dice::Dice;
use super::mutation::{mutant, shrunk};
use super::target::Target;

/// The time after which an input counts as hanging; the slowest takes a hundredth of it.
const PATIENCE: Duration = Duration::from_secs(60);

/// The number of attempts to shrink a failing input.
const LOOKS: u32 = 400;

/// The stack size, equal to that of the thread on which the laboratory loads files.
const STACK: usize = 64 << 20;

/// The length of a fuzzing run.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Length {
    /// A number of mutated inputs.
    Cases(u64),
    /// A duration.
    Time(Duration),
}

impl Length {
    fn is_over(self, cases: u64, began: Instant) -> bool {
        match self {
            Length::Cases(count) => cases >= count,
            Length::Time(time) => began.elapsed() >= time,
        }
    }
}

/// An input's origin and bytes.
type Input = (String, Vec<u8>);

/// Tests a target; returns the number of mutated inputs, or a description of the failure.
pub(crate) fn hunt(target: &'static Target, seed: u64, length: Length) -> Result<u64, String> {
    let (sender, inputs) = channel();
    let hunter = thread::Builder::new().stack_size(STACK);
    let hunter = hunter.spawn(move || look(target, seed, length, &sender)).unwrap();
    let mut last = Input::default();
    loop {
        match inputs.recv_timeout(PATIENCE) {
            Ok(input) => last = input,
            Err(RecvTimeoutError::Disconnected) => break,
            Err(RecvTimeoutError::Timeout) => {
                let why = format!("no answer within {PATIENCE:?}");
                return Err(described(target, &last.0, &why, &last.1));
            }
        }
    }
    hunter.join().unwrap_or_else(|_| Err("the hunter itself panicked".to_owned()))
}

fn look(target: &Target, seed: u64, length: Length, tell: &Sender<Input>) -> Result<u64, String> {
    let fails = |bytes: &[u8]| catch_unwind(|| (target.check)(bytes)).is_err();
    let mut inputs = Vec::new();
    for (place, bytes) in target.corpus() {
        let name = place.display().to_string();
        tell.send((name.clone(), bytes.clone())).ok();
        if fails(&bytes) {
            return Err(format!("{}: {name} fails", target.name));
        }
        inputs.push(bytes);
    }
    assert!(!inputs.is_empty(), "{}: no input is kept", target.name);
    let began = Instant::now();
    let mut case = 0;
    while !length.is_over(case, began) {
        let bytes = mutant(&mut Dice::of(seed, case), &inputs, target.words);
        let name = format!("case {case} of seed {seed}");
        tell.send((name.clone(), bytes.clone())).ok();
        // if the input ends the whole process, this file is all that is left
        fs::write(place(target), &bytes).unwrap();
        if fails(&bytes) {
            return Err(described(target, &name, "it panics", &shrunk(bytes, LOOKS, &fails)));
        }
        case += 1;
    }
    fs::remove_file(place(target)).unwrap();
    Ok(case)
}

/// The file of the current input until its check is finished.
fn place(target: &Target) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{}.input", target.name))
}

/// Saves a failing input for the corpus and describes it.
fn described(target: &Target, name: &str, why: &str, bytes: &[u8]) -> String {
    let place = place(target);
    fs::write(&place, bytes).unwrap();
    format!(
        "{}, {name}: {why}; the input, {} bytes, is in {}; it begins {:?}",
        target.name,
        bytes.len(),
        place.display(),
        String::from_utf8_lossy(&bytes[..bytes.len().min(400)]),
    )
}
