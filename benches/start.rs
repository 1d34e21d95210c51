//! From text to a system that is ready to move: `cargo bench --bench start`.
//!
//! - `derive`: the derivation alone; `ready`: reading, checking, deriving, compiling and setting up.
//!   Each is measured in turn with a baseline, the pendulum in the same run, and their quotient is
//!   printed: what a system costs is read off against the smallest one.
//! - `closed forms`: what is found only when somebody asks for it, as a quotient to `derive`.
//! - `catalog`: opening a preset by its name against listing all of them.
//! - `csv numbers`: the formatting of rows, by the library and by the language.

#![allow(clippy::print_stdout, reason = "a benchmark reports on the terminal")]

use std::fmt::Write as _;
use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{Criterion, criterion_group, criterion_main};
use phaselab::diagnostic::Document;
use phaselab::experiment::Prepared;
use phaselab::mechanics::derive_for_motion;
use phaselab::preset::{self, Catalog};

/// The rounds in which a system and its baseline alternate.
const ROUNDS: usize = 15;

fn systems() -> Vec<(String, Document)> {
    let pendulum = "[lagrangian]\nL = \"1/2*a1'^2 + cos(a1)\"\n";
    let double =
        "[lagrangian]\nL = \"a1'^2 + 1/2*a2'^2 + a1'*a2'*cos(a1 - a2) + 2*cos(a1) + cos(a2)\"\n";
    let top = "[lagrangian]\nL = \"1/2*(a1'^2 + a2'^2*sin(a1)^2) + 1/5*(a3' + a2'*cos(a1))^2 - cos(a1)\"\n";
    let mut all: Vec<(String, usize, String)> = vec![
        ("pendulum".to_owned(), 1, pendulum.to_owned()),
        ("double pendulum".to_owned(), 2, double.to_owned()),
        ("heavy top".to_owned(), 3, top.to_owned()),
    ];
    all.extend([5, 10, 20].map(|n| (format!("chain of {n}"), n, chain(n))));
    all.push(("ten bodies in space".to_owned(), 30, bodies(10)));
    let document = |(name, n, law): (String, usize, String)| {
        let start =
            |i: usize| format!("a{i} = {{ initial = {} }}\n", (i * i % 17) as f64 / 3.0 + 0.5);
        let coordinates: String = (1..=n).map(start).collect();
        let text = format!("title = \"{name}\"\n[coordinates]\n{coordinates}{law}");
        (name, Document::new("system.toml", text))
    };
    all.into_iter().map(document).collect()
}

/// Pendulums of unit mass and length, each hung from the last.
fn chain(n: usize) -> String {
    let mut law = String::from("[definitions]\ny0 = \"0\"\nv0 = \"0\"\nw0 = \"0\"\n");
    let (mut kinetic, mut potential) = (String::from("0"), String::from("0"));
    for i in 1..=n {
        let last = i - 1;
        // writing to a String cannot fail
        let _ = writeln!(law, "y{i} = \"y{last} - cos(a{i})\"");
        let _ = writeln!(law, "v{i} = \"v{last} + cos(a{i})*a{i}'\"");
        let _ = writeln!(law, "w{i} = \"w{last} + sin(a{i})*a{i}'\"");
        let _ = write!(kinetic, " + 1/2*(v{i}^2 + w{i}^2)");
        let _ = write!(potential, " + y{i}");
    }
    law + &format!("[lagrangian]\nL = \"{kinetic} - ({potential})\"\n")
}

/// Bodies of unit mass that attract each other in space.
fn bodies(n: usize) -> String {
    let mut law = String::from("[lagrangian]\nL = \"0");
    for i in 1..=3 * n {
        let _ = write!(law, " + 1/2*a{i}'^2");
    }
    for i in 0..n {
        for j in 0..i {
            let square = |k: usize| format!("(a{} - a{})^2", 3 * i + k, 3 * j + k);
            let _ = write!(law, " + 1/sqrt({} + {} + {})", square(1), square(2), square(3));
        }
    }
    law + "\"\n"
}

/// The median of the quotients of two times, measured in turn.
fn quotient(mut one: impl FnMut(), mut other: impl FnMut()) -> f64 {
    let time = |work: &mut dyn FnMut()| {
        let begin = Instant::now();
        work();
        begin.elapsed().as_secs_f64()
    };
    let mut quotients: Vec<f64> =
        (0..ROUNDS).map(|_| time(&mut one) / time(&mut other).max(1e-9)).collect();
    quotients.sort_by(f64::total_cmp);
    quotients[ROUNDS / 2]
}

fn ready(document: &Document) {
    black_box(Prepared::of(document).expect("a right file"));
}

fn start(criterion: &mut Criterion) {
    let systems = systems();
    let baseline = systems[0].1.clone();
    let mut group = criterion.benchmark_group("start");
    for (name, document) in &systems {
        let model = document.read().expect("a right file").model;
        let derive = || {
            black_box(derive_for_motion(&model).expect("derivable"));
        };
        println!(
            "{name}: ready / ready of a pendulum = {:.1}; closed forms / derive = {:.2}",
            quotient(|| ready(document), || ready(&baseline)),
            quotient(
                || {
                    let mut equations = derive_for_motion(&model).expect("derivable");
                    equations.find_closed_forms();
                    black_box(equations);
                },
                derive
            )
        );
        group.bench_function(format!("{name}, derive"), |bencher| bencher.iter(derive));
        group.bench_function(format!("{name}, ready"), |bencher| {
            bencher.iter(|| ready(document));
        });
    }
}

fn catalog(criterion: &mut Criterion) {
    let find = || {
        black_box(preset::find_beside(None, "pendulum".as_ref()).expect("a preset"));
    };
    let list = || {
        black_box(Catalog::with_folder(None));
    };
    let parse = || {
        for entry in Catalog::with_folder(None).entries() {
            let document = entry.document().expect("a preset");
            black_box(document.text.parse::<toml::Table>().expect("a right file"));
        }
    };
    println!("catalog: list / parse all = {:.4}", quotient(list, parse));
    println!("catalog: find / list = {:.4}", quotient(find, list));
    criterion.bench_function("catalog, find", |bencher| bencher.iter(find));
    criterion.bench_function("catalog, list", |bencher| bencher.iter(list));
}

fn csv_numbers(criterion: &mut Criterion) {
    let numbers: Vec<f64> = (0..9000).map(|k| (f64::from(k) * 0.37).sin() * 10.0).collect();
    let mut text = String::new();
    let mut library = || {
        text.clear();
        for &x in &numbers {
            text.push_str(ryu::Buffer::new().format_finite(x));
            text.push(',');
        }
        black_box(text.len());
    };
    let mut own = String::new();
    let language = || {
        own.clear();
        for &x in &numbers {
            let _ = write!(own, "{x:?},");
        }
        black_box(own.len());
    };
    println!("csv numbers: library / language = {:.2}", quotient(&mut library, language));
    criterion.bench_function("csv numbers, 9000", |bencher| bencher.iter(&mut library));
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_millis(600));
    targets = start, catalog, csv_numbers
}
criterion_main!(benches);
