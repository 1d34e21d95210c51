//! The speed of integration. Short by default: `cargo bench --bench integrate`.
//!
//! - `unit of time`: one unit of time of a motion by the default method; the number of steps in it is
//!   printed too and gives the steps per second.
//! - `rates`: one evaluation of the equations of motion, compiled from the file's expressions and
//!   hand-written. Their quotient is printed; it is measured in the same run.
//! - `fixed step`: one step of a method of fixed step, many in a row that nobody looks at, and the same
//!   method as a loop written by hand without compensated sums. Their quotient is printed likewise.

#![allow(clippy::print_stdout, reason = "a benchmark reports on the terminal")]

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{Criterion, criterion_group, criterion_main};
use phaselab::integrate::{METHODS, Settings, Stepper};
use phaselab::mechanics;
use phaselab::preset;
use phaselab::system::{Rates, State, System};

/// Hand-written rates of change of a state.
type ByHand = fn(&[f64], &mut [f64]);

/// A motion to be measured.
struct Motion {
    name: &'static str,
    text: &'static str,
    by_hand: ByHand,
}

const MOTIONS: &[Motion] = &[
    Motion {
        name: "pendulum",
        text: r#"
            [coordinates]
            theta = { initial = 1.5 }
            [lagrangian]
            L = "1/2*theta'^2 + cos(theta)"
        "#,
        by_hand: |x, out| (out[0], out[1]) = (x[1], -x[0].sin()),
    },
    Motion {
        name: "double pendulum",
        text: r#"
            [coordinates]
            a = { initial = 1.5 }
            b = { initial = 0.5 }
            [lagrangian]
            L = "a'^2 + b'^2/2 + a'*b'*cos(a - b) + 2*cos(a) + cos(b)"
        "#,
        by_hand: double_pendulum,
    },
    Motion {
        name: "heavy top",
        text: r#"
            [coordinates]
            theta = { initial = 0.6 }
            phi = { initial = 0 }
            psi = { initial = 0, velocity = 10 }
            [lagrangian]
            L = "1/2*(theta'^2 + phi'^2*sin(theta)^2) + 1/5*(psi' + phi'*cos(theta))^2 - cos(theta)"
        "#,
        by_hand: heavy_top,
    },
    Motion {
        name: "Hénon–Heiles",
        text: r#"
            [coordinates]
            x = { initial = 0, momentum = 0.42081 }
            y = { initial = -0.25, momentum = 0 }
            [hamiltonian]
            H = "(p_x^2 + p_y^2 + x^2 + y^2)/2 + x^2*y - y^3/3"
        "#,
        by_hand: |x, out| {
            (out[0], out[1]) = (x[2], x[3]);
            out[2] = -x[0] - 2.0 * x[0] * x[1];
            out[3] = -x[1] - x[0] * x[0] + x[1] * x[1];
        },
    },
    Motion {
        name: "Kepler, e = 0.9",
        text: r#"
            [coordinates]
            x = { initial = 0.1, momentum = 0 }
            y = { initial = 0, momentum = "sqrt(19)" }
            [hamiltonian]
            H = "(p_x^2 + p_y^2)/2 - 1/sqrt(x^2 + y^2)"
        "#,
        by_hand: |x, out| {
            let r = x[0].hypot(x[1]);
            let pull = -1.0 / (r * r * r);
            (out[0], out[1], out[2], out[3]) = (x[2], x[3], pull * x[0], pull * x[1]);
        },
    },
];

fn double_pendulum(x: &[f64], out: &mut [f64]) {
    let (s, c) = (x[0] - x[1]).sin_cos();
    let f = -s * x[3] * x[3] - 2.0 * x[0].sin();
    let g = s * x[2] * x[2] - x[1].sin();
    let det = 2.0 - c * c;
    (out[0], out[1]) = (x[2], x[3]);
    (out[2], out[3]) = ((f - c * g) / det, (2.0 * g - c * f) / det);
}

/// I₁ = 1, I₃ = 2/5, Mgl = 1.
fn heavy_top(x: &[f64], out: &mut [f64]) {
    let (s, c) = x[0].sin_cos();
    let spin = 0.4 * (x[5] + x[4] * c);
    let turn = (spin - 2.0 * x[4] * c) * x[3] / s;
    out[..3].copy_from_slice(&x[3..6]);
    out[3] = s * x[4] * (x[4] * c - spin) + s;
    out[4] = turn;
    out[5] = x[4] * s * x[3] - c * turn;
}

fn open(motion: &Motion) -> (System, State) {
    let text = format!("title = \"{}\"\n{}", motion.name, motion.text);
    let model = preset::read(&text).expect("a right file").model;
    let equations = mechanics::derive(&model).expect("derivable");
    let system = System::compile(&model, &equations, &[]).expect("compiles");
    let state = system.initial(0.0, &[], &[]).expect("an initial state");
    (system, state)
}

fn unit_of_time(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("unit of time");
    for motion in MOTIONS {
        let (system, state) = open(motion);
        let method = &METHODS[0];
        let mut stepper = (method.make)(&system, &Settings::default()).expect("fits");
        stepper.start(&state, &[]).expect("starts");
        println!("{}: {:.2} steps of {}", motion.name, steps(stepper.as_mut()), method.name);
        stepper.start(&state, &[]).expect("starts");
        group.bench_function(motion.name, |bencher| {
            bencher.iter(|| {
                let limit = stepper.time() + 1.0;
                while stepper.time() < limit {
                    stepper.step(limit).expect("goes on");
                }
            });
        });
    }
}

/// Counts the steps in a unit of time, averaged over a hundred.
fn steps(stepper: &mut dyn Stepper) -> f64 {
    let mut count = 0.0;
    while stepper.time() < 100.0 {
        stepper.step(100.0).expect("goes on");
        count += 1.0;
    }
    count / 100.0
}

fn rates(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("rates");
    for motion in MOTIONS {
        let by_hand = motion.by_hand;
        let (system, state) = open(motion);
        let mut rates = system.native_rates();
        rates.set_parameters(&[]);
        // A state away from the start, where too many values are zero.
        let numbers: Vec<f64> =
            state.values.iter().enumerate().map(|(i, x)| x + 0.1 + 0.05 * i as f64).collect();
        let mut out = [vec![0.0; numbers.len()], vec![0.0; numbers.len()]];
        rates.evaluate(0.0, &numbers, &mut out[0]).expect("rates");
        by_hand(&numbers, &mut out[1]);
        for (a, b) in out[0].iter().zip(&out[1]) {
            assert!((a - b).abs() < 1e-12 * (1.0 + b.abs()), "{}: {a} is not {b}", motion.name);
        }
        let [mut out, _] = out;
        println!(
            "{}: compiled / by hand = {:.2}",
            motion.name,
            quotient(&mut rates, by_hand, &numbers)
        );
        group.bench_function(format!("{}, compiled", motion.name), |bencher| {
            bencher.iter(|| rates.evaluate(0.0, black_box(&numbers), &mut out).expect("rates"));
        });
        group.bench_function(format!("{}, by hand", motion.name), |bencher| {
            bencher.iter(|| by_hand(black_box(&numbers), black_box(&mut out)));
        });
    }
}

/// Returns the time of a compiled evaluation relative to a hand-written one: the median of rounds in
/// which both alternate, so that a machine that slows down slows both.
fn quotient(rates: &mut Rates, by_hand: ByHand, numbers: &[f64]) -> f64 {
    const CALLS: usize = 2000;
    let mut out = vec![0.0; numbers.len()];
    let mut quotients: Vec<f64> = (0..101)
        .map(|_| {
            let begin = Instant::now();
            for _ in 0..CALLS {
                rates.evaluate(0.0, black_box(numbers), black_box(&mut out)).expect("rates");
            }
            let compiled = begin.elapsed();
            let begin = Instant::now();
            for _ in 0..CALLS {
                by_hand(black_box(numbers), black_box(&mut out));
            }
            compiled.as_secs_f64() / begin.elapsed().as_secs_f64()
        })
        .collect();
    quotients.sort_by(f64::total_cmp);
    quotients[quotients.len() / 2]
}

/// A step of a method, written by hand.
type StepByHand = fn(&mut [f64; 4], f64);

/// The methods of fixed step that are measured, on Hénon and Heiles.
const FIXED_STEPS: &[(&str, f64, StepByHand)] = &[
    ("leapfrog", 0.01, |x, h| leapfrog(x, h)),
    ("yoshida4", 0.02, |x, h| {
        let outer = 1.351_207_191_959_657_8;
        for w in [outer, 1.0 - 2.0 * outer, outer] {
            leapfrog(x, w * h);
        }
    }),
    ("gauss4", 0.05, |x, h| gauss(x, h)),
];

fn force(x: &[f64; 4]) -> [f64; 2] {
    [-x[0] - 2.0 * x[0] * x[1], -x[1] - x[0] * x[0] + x[1] * x[1]]
}

fn leapfrog(x: &mut [f64; 4], h: f64) {
    for part in 0..2 {
        let f = force(x);
        (x[2], x[3]) = (x[2] + 0.5 * h * f[0], x[3] + 0.5 * h * f[1]);
        if part == 0 {
            (x[0], x[1]) = (x[0] + h * x[2], x[1] + h * x[3]);
        }
    }
}

/// Gauss's method of order 4 by fixed-point iteration from the slope at the beginning.
fn gauss(x: &mut [f64; 4], h: f64) {
    let r = 3.0_f64.sqrt() / 6.0;
    let a = [[0.25, 0.25 - r], [0.25 + r, 0.25]];
    let slope = |x: &[f64; 4]| {
        let f = force(x);
        [x[2], x[3], f[0], f[1]]
    };
    let mut k = [slope(x); 2];
    loop {
        let mut most = 0.0_f64;
        let old = k;
        for i in 0..2 {
            let mut y = *x;
            for (n, y) in y.iter_mut().enumerate() {
                *y += h * (a[i][0] * old[0][n] + a[i][1] * old[1][n]);
            }
            k[i] = slope(&y);
            for n in 0..4 {
                most = most.max((k[i][n] - old[i][n]).abs());
            }
        }
        if most <= 1e-16 {
            break;
        }
    }
    for (n, x) in x.iter_mut().enumerate() {
        *x += h * 0.5 * (k[0][n] + k[1][n]);
    }
}

fn fixed_step(criterion: &mut Criterion) {
    const STEPS: u64 = 4096;
    let motion = MOTIONS.iter().find(|m| m.name == "Hénon–Heiles").expect("is there");
    let (system, state) = open(motion);
    let mut group = criterion.benchmark_group("fixed step");
    group.throughput(criterion::Throughput::Elements(STEPS));
    for &(name, step, by_hand) in FIXED_STEPS {
        let method = METHODS.iter().find(|m| m.name == name).expect("a method");
        let settings = Settings { step: Some(step), tolerance: None };
        let mut stepper = (method.make)(&system, &settings).expect("fits");
        stepper.start(&state, &[]).expect("starts");
        let many = |stepper: &mut dyn Stepper| {
            stepper.steps(1e9, 1e9, &mut STEPS.clone()).expect("goes on");
        };
        let mut x = [state.values[0], state.values[1], state.values[2], state.values[3]];
        let mut quotients: Vec<f64> = (0..41)
            .map(|_| {
                let begin = Instant::now();
                many(stepper.as_mut());
                let own = begin.elapsed();
                let begin = Instant::now();
                for _ in 0..STEPS {
                    by_hand(black_box(&mut x), black_box(step));
                }
                own.as_secs_f64() / begin.elapsed().as_secs_f64()
            })
            .collect();
        quotients.sort_by(f64::total_cmp);
        println!("{name}: stepper / by hand = {:.2}", quotients[quotients.len() / 2]);
        group.bench_function(format!("{name}, stepper"), |b| b.iter(|| many(stepper.as_mut())));
        group.bench_function(format!("{name}, step by step"), |b| {
            b.iter(|| (0..STEPS).for_each(|_| stepper.step(1e9).expect("goes on")));
        });
        group.bench_function(format!("{name}, by hand"), |b| {
            b.iter(|| (0..STEPS).for_each(|_| by_hand(black_box(&mut x), black_box(step))));
        });
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(20)
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_millis(600));
    targets = unit_of_time, rates, fixed_step
}
criterion_main!(benches);
