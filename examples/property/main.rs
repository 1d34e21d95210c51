//! An endless property test: random systems are run and compared with an independent motion, or must report why they
//! cannot continue.
//!
//! `cargo run --release --example property -- --seconds 600 --seed 7` exits with status 1 if a case failed; each failing
//! case is printed as a file, with the command that repeats it. `--case N` runs one case, `--count N` a number of cases
//! instead of a time, and `--files FOLDER` writes failing files there.

#[path = "../../tests/it/property/case.rs"]
mod case;
#[path = "../../tests/it/property/dice.rs"]
mod dice;
#[path = "../../tests/it/property/extrapolation.rs"]
mod extrapolation;
#[path = "../../tests/it/property/jet.rs"]
mod jet;
#[path = "../../tests/it/property/judge.rs"]
mod judge;
#[path = "../../tests/it/property/oracle.rs"]
mod oracle;
#[path = "../../tests/it/property/processor_time.rs"]
mod processor_time;
#[path = "../../tests/it/property/random.rs"]
mod random;
#[path = "../../tests/it/property/shrink.rs"]
mod shrink;
#[path = "../../tests/it/property/tree.rs"]
mod tree;

use std::collections::BTreeMap;
use std::io::{Write, stdout};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use color_eyre::eyre::{Result, eyre};

use judge::{Budget, Kind, Outcome, judged};

const BUDGET: Budget =
    Budget { steps: 100_000, evaluations: 100_000, watchdog: Duration::from_secs(60) };

/// The most cases tried in order to shrink one that fails.
const ATTEMPTS: u32 = 120;

/// A thread that hangs keeps running; this many of them would block everything else.
const MOST_HANGS: u32 = 4;

struct Options {
    seconds: u64,
    seed: u64,
    first: u64,
    count: u64,
    files: Option<PathBuf>,
}

fn options() -> Result<Options> {
    let random = SystemTime::now().duration_since(UNIX_EPOCH)?.as_nanos() as u64 % 1_000_000_000;
    let mut options = Options { seconds: 60, seed: random, first: 0, count: u64::MAX, files: None };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let value = words.next().ok_or_else(|| eyre!("{word} needs a value"))?;
        match word.as_str() {
            "--seconds" => options.seconds = value.parse()?,
            "--seed" => options.seed = value.parse()?,
            "--count" => options.count = value.parse()?,
            "--from" => options.first = value.parse()?,
            "--case" => (options.first, options.count) = (value.parse()?, 1),
            "--files" => options.files = Some(value.into()),
            _ => return Err(eyre!("there is no option {word}")),
        }
    }
    Ok(options)
}

fn main() -> Result<ExitCode> {
    let Options { seconds, seed, first, count, files } = options()?;
    let mut out = stdout();
    writeln!(out, "seed {seed}")?;
    // A panic is reported as a failure of its case.
    std::panic::set_hook(Box::new(|_| ()));
    let begun = Instant::now();
    let mut tally: BTreeMap<String, u64> = BTreeMap::new();
    let mut failures: BTreeMap<Kind, u64> = BTreeMap::new();
    let mut hangs = 0;
    let mut done = 0;
    for index in (first..).take_while(|index| index - first < count) {
        if begun.elapsed() >= Duration::from_secs(seconds) || hangs >= MOST_HANGS {
            break;
        }
        done += 1;
        let case = random::case(seed, index);
        let outcome = judged(&case, BUDGET);
        let word = match &outcome {
            Outcome::Failed(failure) => format!("failed, {:?}", failure.kind),
            other => format!("{other:?}").to_lowercase(),
        };
        *tally.entry(word).or_default() += 1;
        let Outcome::Failed(failure) = outcome else { continue };
        *failures.entry(failure.kind).or_default() += 1;
        writeln!(out, "\ncase {index} fails: {failure}")?;
        writeln!(
            out,
            "again: cargo run --release --example property -- --seed {seed} --case {index}"
        )?;
        let hang = matches!(failure.kind, Kind::Hang | Kind::Slow);
        hangs += u32::from(failure.kind == Kind::Hang);
        let fails = |case: &case::Case| matches!(judged(case, BUDGET), Outcome::Failed(f) if f.kind == failure.kind);
        let smallest = if hang { case.clone() } else { shrink::shrunk(&case, ATTEMPTS, &fails) };
        let text = smallest.toml();
        writeln!(out, "as small as it was made:\n{text}")?;
        let last = judged(&smallest, Budget { watchdog: Duration::from_secs(5), ..BUDGET });
        if let Outcome::Failed(last) = &last {
            writeln!(out, "which fails: {last}")?;
        }
        if let Some(folder) = &files {
            std::fs::create_dir_all(folder)?;
            let head = format!("# {failure}\n# now: {last:?}\n");
            let name = format!("{:?}-{seed}-{index}.toml", failure.kind);
            std::fs::write(folder.join(name), head + &text)?;
        }
        out.flush()?;
    }
    writeln!(out, "\n{done} cases of seed {seed} in {:.0} s", begun.elapsed().as_secs_f64())?;
    for (word, count) in &tally {
        writeln!(out, "{count:8} {word}")?;
    }
    Ok(if failures.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
