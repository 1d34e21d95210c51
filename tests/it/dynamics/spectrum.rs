//! Lines of signals that are known, of a pendulum against its elliptic integral, and mean rates of angles.

use std::f64::consts::TAU;

use phaselab::diagnostic::Document;
use phaselab::dynamics::{
    Spectrum, SpectrumRequest, frequency_drift, mean_rate, sampled_spectrum, spectrum,
};
use phaselab::ensemble::SystemFlow;
use phaselab::experiment::Prepared;
use phaselab::integrate::{Settings, method_named};
use phaselab::system::System;

fn lines(signal: &dyn Fn(f64) -> f64, spacing: f64, fundamentals: usize) -> Spectrum {
    let signal: Vec<f64> = (0..1024).map(|k| signal(spacing * f64::from(k))).collect();
    spectrum(&signal, spacing, (8, fundamentals), &mut |_| true).unwrap()
}

/// Frequencies, amplitudes and phases of a known signal; the weakest line is a hundred thousand times fainter.
const KNOWN: [(f64, f64, f64); 6] = [
    (1.3, 1.0, 0.2),
    (1.838_477_631_085_023_6, 0.4, -1.1),
    (3.138_477_631_085_023_6, 0.05, 2.0),
    (0.761_522_368_914_976_4, 1e-2, 0.5),
    (1.423, 1e-3, -2.5),
    (3.9, 1e-5, 1.0),
];

fn known(t: f64) -> f64 {
    2.5 + KNOWN.iter().map(|(w, a, phase)| a * (w * t + phase).cos()).sum::<f64>()
}

#[test]
fn known_lines_are_found_to_rounding_and_named() {
    let found = lines(&known, 0.25, 3);
    assert_eq!(found.lines.len(), 6, "{:#?}", found.lines);
    assert!((found.mean - 2.5).abs() < 1e-12 && found.left < 1e-12);
    // k·(1.3, 1.3 √2, 1.423): the third is the sum of the first two, the fourth 2·1.3 − 1.3 √2
    let names = [[1, 0, 0], [0, 1, 0], [1, 1, 0], [2, -1, 0], [0, 0, 1], [3, 0, 0]];
    for ((line, (frequency, amplitude, phase)), k) in found.lines.iter().zip(KNOWN).zip(names) {
        assert!(
            (line.frequency - frequency).abs() < 1e-12 / amplitude.sqrt(),
            "{line:?} {frequency}"
        );
        assert!((line.amplitude - amplitude).abs() < 1e-12, "{line:?}");
        assert!((line.phase - phase).abs() < 1e-11 / amplitude, "{line:?} {phase}");
        assert_eq!(line.combination.as_deref(), Some(&k[..]));
        assert!((line.frequency - frequency).abs() < 10.0 * line.error + 1e-15, "{line:?}");
    }
}

/// Ten lines as close as those of the perihelia of the planets, in arcseconds a year over 40 million years: Laskar's
/// frequencies g₁ … g₈ and two combinations (A. Morbidelli, *Modern Celestial Mechanics*, table 7.1), with amplitudes of two
/// powers of ten.
#[test]
fn ten_lines_of_perihelia_are_found_to_rounding() {
    let per_year = std::f64::consts::PI / (180.0 * 3600.0);
    let arcseconds =
        [5.596, 7.456, 17.365, 17.916, 4.257_49, 28.220_69, 3.088_39, 0.671, 52.183_89, -19.705_71];
    let amplitudes = [0.018, 0.016, 0.011, 0.009, 0.044, 0.012, 0.037, 0.006, 0.004, 0.003];
    let spacing = 8000.0;
    let signal: Vec<f64> = (0..5000)
        .map(|k| {
            let t = spacing * f64::from(k);
            let lines = arcseconds.iter().zip(amplitudes).enumerate();
            lines.map(|(i, (w, a))| a * (w * per_year * t + i as f64).cos()).sum()
        })
        .collect();
    let found = spectrum(&signal, spacing, (10, 1), &mut |_| true).unwrap();
    assert_eq!(found.lines.len(), 10, "{:#?}", found.lines);
    for wanted in arcseconds {
        let of = |line: &phaselab::dynamics::SpectralLine| line.frequency / per_year;
        let nearest = found.lines.iter().map(|line| (of(line) - wanted.abs()).abs());
        let off = nearest.fold(f64::INFINITY, f64::min);
        assert!(off < 1e-12, "{wanted}″ a year: {off:e}");
    }
}

/// The perihelion of Jupiter as Laskar gives it, Icarus 88 (1990) 266, table VI: the ten lines by which REBOUND tests its
/// analysis of frequencies, of amplitudes that span three powers of ten, over 10.8 million years.
#[test]
fn the_lines_of_jupiters_perihelion_are_found_to_rounding() {
    let arcseconds = [
        4.2488163, 28.2206942, 3.0895148, 52.1925732, 27.0613982, 29.3799573, 28.8679427,
        27.5734578, 5.4070444, 0.6671228,
    ];
    let amplitudes = [44119.0, 15750.0, 1800.0, 516.0, 183.0, 178.0, 107.0, 95.0, 62.0, 58.0];
    let phases =
        [30.676, 308.112, 121.362, 45.551, 218.696, 217.460, 32.614, 43.733, 116.984, 74.116];
    let per_year = std::f64::consts::PI / (180.0 * 3600.0);
    let spacing = 120_000.0 / 365.25;
    let signal: Vec<f64> = (0..32_768)
        .map(|k| {
            let t = spacing * f64::from(k);
            let lines = arcseconds.iter().zip(amplitudes).zip(phases);
            lines
                .map(|((w, a), phase)| a * 1e-6 * (w * per_year * t + f64::to_radians(phase)).cos())
                .sum()
        })
        .collect();
    let found = spectrum(&signal, spacing, (10, 1), &mut |_| true).unwrap();
    assert_eq!(found.lines.len(), 10, "{:#?}", found.lines);
    for (line, (wanted, amplitude)) in found.lines.iter().zip(arcseconds.iter().zip(amplitudes)) {
        let off = (line.frequency / per_year - wanted).abs();
        assert!(off < 1e-12, "{wanted}″ a year: {off:e}");
        assert!(
            (line.amplitude * 1e6 / amplitude - 1.0).abs() < 1e-9,
            "{wanted}: {}",
            line.amplitude
        );
    }
}

/// Lines are found beside a mean that grows, as evenly or as a parabola, and is much larger than they are.
#[test]
fn lines_are_found_beside_a_mean_that_changes() {
    for slow in [|t: f64| 0.3 * t, |t: f64| 40.0 - 0.05 * t + 2e-3 * t * t] {
        let signal = |t: f64| slow(t) + 0.5 * (1.3 * t + 0.2).cos() + 1e-3 * (2.1 * t).cos();
        let found = lines(&signal, 0.25, 2);
        let frequencies: Vec<f64> = found.lines.iter().map(|line| line.frequency).collect();
        let [one, two] = frequencies[..] else { panic!("{found:?}") };
        assert!((one - 1.3).abs() < 1e-11 && (two - 2.1).abs() < 1e-8, "{frequencies:?}");
        assert!((found.lines[0].amplitude - 0.5).abs() < 1e-10, "{:?}", found.lines[0]);
        let change = slow(0.25 * 1023.0) - slow(0.0);
        assert!((found.change_of_mean().unwrap() - change).abs() < 1e-9 * change.abs());
        assert!(found.left < 1e-9 && found.turns.is_none());
    }
    // a line alone has none, and what escapes has no lines
    assert_eq!(lines(&known, 0.25, 3).change_of_mean(), None);
    let escapes = lines(&|t: f64| (1.0 + 0.04 * t * t).sqrt(), 0.25, 2);
    assert!(escapes.lines.is_empty() && escapes.turns.is_some(), "{escapes:?}");
}

/// A mean that decays is no polynomial: what one of ninth degree leaves of it is little beside a strong line.
#[test]
fn a_line_is_found_beside_a_mean_that_decays() {
    let found = lines(&|t: f64| 3.0 * t.cos() - 50.0 * (-t / 50.0).exp(), 0.2, 2);
    let [line, ..] = &found.lines[..] else { panic!("{found:?}") };
    assert!((line.frequency - 1.0).abs() < line.error && line.error < 1e-2, "{line:?}");
    assert!((line.amplitude - 3.0).abs() < 1e-2, "{line:?}");
    assert!(!found.is_continuous() && found.left < 1e-4, "{} of {}", found.left, found.size);
}

#[test]
fn what_is_no_combination_is_not_named_one() {
    let found = lines(&known, 0.25, 2);
    let unnamed: Vec<f64> =
        found.lines.iter().filter(|l| l.combination.is_none()).map(|l| l.frequency).collect();
    assert_eq!((found.fundamentals.len(), unnamed.len()), (2, 1));
    assert!((unnamed[0] - 1.423).abs() < 1e-9);
}

/// What goes away and does not come back has no lines: a straight line, a hyperbola, a part of a turn. Two turns are a line.
#[test]
fn what_makes_no_turn_is_no_line() {
    let away: [&dyn Fn(f64) -> f64; 3] =
        [&|t| 1.0 + 3.0 * t, &|t| (1.0 + t * t).sqrt(), &|t| (0.02 * t).sin()];
    for signal in away {
        let found = lines(signal, 0.05, 1);
        assert!(
            found.lines.is_empty() && found.turns.is_some_and(|turns| turns < 1.0),
            "{found:?}"
        );
    }
    let found = lines(&|t| (0.3 * t).sin(), 0.05, 1);
    assert!(found.turns.is_none());
    assert!((found.lines[0].frequency - 0.3).abs() < 1e-9, "{:?}", found.lines);
}

#[test]
fn noise_shows_in_the_error() {
    // pseudo-random numbers beside one line
    let mut seed = 12_345_u64;
    let mut noise = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let signal: Vec<f64> =
        (0..1024).map(|k| (0.7 * 0.25 * f64::from(k)).cos() + 1e-3 * noise()).collect();
    let found = spectrum(&signal, 0.25, (1, 1), &mut |_| true).unwrap();
    let (line, off) = (&found.lines[0], (found.lines[0].frequency - 0.7).abs());
    assert!(off < 5.0 * line.error && line.error < 1e-5 && line.error > 1e-8, "{line:?} {off:e}");
    assert!((found.left - 1e-3 / 12f64.sqrt()).abs() < 5e-5, "{}", found.left);
    assert_eq!(spectrum(&[f64::NAN; 64], 0.1, (1, 1), &mut |_| true), None);
    assert_eq!(spectrum(&[1.0; 64], 0.0, (1, 1), &mut |_| true), None);
    // nothing moves, nothing stands out
    let still = spectrum(&[1.0; 64], 0.1, (3, 1), &mut |_| true).unwrap();
    assert_eq!((still.lines.len(), still.mean), (0, 1.0));
}

/// The angle of the pendulum L = ½ q̇² + cos q at equal intervals of time.
fn pendulum(q: f64, velocity: f64, spacing: f64) -> Vec<f64> {
    let text = format!(
        "title = \"one\"\n[coordinates]\nq = {{ initial = {q:?}, velocity = {velocity:?} }}\n\
         [lagrangian]\nL = \"1/2*q'^2 + cos(q)\"\n[run]\nuntil = 100.0\n"
    );
    let ready = Prepared::of(&Document::new("test", &text)).unwrap_or_else(|e| panic!("{e}"));
    let start = ready.system.initial(0.0, &[], &[]).unwrap();
    let method = (method_named("taylor").unwrap(), Settings::default());
    let system = System::clone(&ready.system);
    let flow = SystemFlow { system, method, parameters: Vec::new(), start: 0.0, effort: None };
    let times: Vec<f64> = (0..1024).map(|k| spacing * f64::from(k)).collect();
    let carried = flow.carry(&start, &times, &[0]);
    assert_eq!(carried.seen.len(), 1024);
    carried.seen.iter().map(|row| row[0]).collect()
}

fn agm(mut a: f64, mut b: f64) -> f64 {
    for _ in 0..8 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    a
}

#[test]
fn a_pendulum_has_odd_multiples_of_its_frequency() {
    let angle = pendulum(1.0, 0.0, 0.2);
    let found = spectrum(&angle, 0.2, (4, 1), &mut |_| true).unwrap();
    // ω = agm(1, cos ½)
    let frequency = agm(1.0, 0.5_f64.cos());
    for (line, odd) in found.lines.iter().zip([1, 3, 5, 7]) {
        let off = (line.frequency - f64::from(odd) * frequency).abs();
        assert!(off < 1e-11 / line.amplitude, "{odd}: {line:?} {off:e}");
        assert_eq!(line.combination, Some(vec![odd]));
    }
    assert_eq!(found.lines.len(), 4);
    // a pendulum that swings has no mean rate
    let rate = mean_rate(&angle, 0.2).unwrap();
    assert!(rate.rate.abs() < 1e-8, "{rate:?}");
}

#[test]
fn a_pendulum_that_turns_over_has_the_mean_rate_of_its_elliptic_integral() {
    // 2π/T = agm(p, √(p² − 4)), p the velocity at the bottom
    let rate = mean_rate(&pendulum(0.0, 2.5, 0.2), 0.2).unwrap();
    let exact = agm(2.5, 1.5);
    assert!((rate.rate - exact).abs() < 1e-12, "{rate:?} {exact}");
    assert!(rate.error < 1e-6 && (rate.rate - exact).abs() <= rate.error + 1e-15);
    // a plain average over the same time is far from it
    let angle = pendulum(0.0, 2.5, 0.2);
    let plain = (angle[1023] - angle[0]) / (1023.0 * 0.2);
    assert!((plain - exact).abs() > 1e-5, "{plain}");
    assert_eq!(mean_rate(&[0.0, TAU], 1.0), None);
}

/// A line whose frequency changes in the middle of the time drifts by as much, and one beside others that does not change, not at all.
#[test]
fn the_drift_of_a_frequency_is_its_change_between_the_halves() {
    let count = 4096;
    let signal = |later: f64| -> Vec<f64> {
        let value = |k: usize| {
            let t = 0.1 * k as f64;
            let rate = if k < count / 2 { 1.0 } else { later };
            (rate * t).cos() + 0.3 * (2.0_f64.sqrt() * t).sin()
        };
        (0..count).map(value).collect()
    };
    let drift = |later: f64| {
        let signal = signal(later);
        let lines = spectrum(&signal, 0.1, (6, 0), &mut |_| true).unwrap().lines;
        frequency_drift(&signal, 0.1, &lines).unwrap()
    };
    let changed = drift(1.02);
    assert!((changed.first - 1.0).abs() < 1e-7 && (changed.second - 1.02).abs() < 1e-7);
    assert!((changed.relative() - 0.02 / 1.01).abs() < 1e-6, "{}", changed.relative());
    assert!(drift(1.0).relative() < 1e-9);
    assert_eq!(frequency_drift(&[0.0; 16], 0.1, &[]), None);
}

/// A faint line beside the strongest one comes to be nearer to where that was; it is no drift of it.
#[test]
fn the_drift_follows_the_strongest_line_past_a_fainter_one() {
    let count = 4096;
    // turns in the time of a half
    let turn = std::f64::consts::TAU / (0.1 * (count / 2) as f64);
    let later = 1.0 - 3.5 * turn;
    let value = |k: usize| {
        let t = 0.1 * k as f64;
        let rate = if k < count / 2 { 1.0 } else { later };
        (rate * t).cos() + 0.3 * ((1.0 + 2.0 * turn) * t).sin()
    };
    let signal: Vec<f64> = (0..count).map(value).collect();
    let lines = spectrum(&signal, 0.1, (6, 0), &mut |_| true).unwrap().lines;
    let drift = frequency_drift(&signal, 0.1, &lines).unwrap();
    assert!((drift.first - 1.0).abs() < 0.1 * turn, "{drift:?}");
    assert!((drift.second - later).abs() < 0.1 * turn, "{drift:?}");
    // of two lines alike it is not known which one it was
    let value = |k: usize| {
        let t = 0.1 * k as f64;
        let rates = if k < count / 2 { [1.0, 1.3] } else { [1.0 - 2.0 * turn, 1.0 + 2.0 * turn] };
        (rates[0] * t).cos() + 0.9 * (rates[1] * t).sin()
    };
    let signal: Vec<f64> = (0..count).map(value).collect();
    let lines = spectrum(&signal, 0.1, (6, 0), &mut |_| true).unwrap().lines;
    let drift = frequency_drift(&signal, 0.1, &lines).unwrap();
    assert!(drift.error > 3.0 * turn, "{drift:?}");
}

/// Of the frequencies a and b the two strongest lines 2a + b and b span every second combination alone: a is half of their
/// difference. All lines have integers by a changed basis.
#[test]
fn a_basis_is_changed_where_a_line_is_half_of_a_combination() {
    let (a, b) = (1.0, 0.5_f64.sqrt());
    let integers = [(2, 1), (0, 1), (1, 0), (3, 2), (1, 2), (4, -1), (6, -1)];
    let of = |(m, n): (i32, i32)| f64::from(m) * a + f64::from(n) * b;
    let signal = |t: f64| {
        let terms = integers.iter().zip(0..);
        terms.map(|(&k, i)| 0.5_f64.powi(i) * (of(k) * t + f64::from(i)).cos()).sum::<f64>()
    };
    let found = lines(&signal, 0.25, 2);
    assert_eq!((found.lines.len(), found.fundamentals.len()), (7, 2), "{:#?}", found.lines);
    for (line, k) in found.lines.iter().zip(integers) {
        assert!((line.frequency - of(k)).abs() < 1e-10, "{line:?} {k:?}");
        let name = line.combination.as_ref().unwrap_or_else(|| panic!("{line:?} has no name"));
        let named: f64 = name.iter().zip(&found.fundamentals).map(|(&k, w)| f64::from(k) * w).sum();
        assert!((named - line.frequency).abs() < 1e-9, "{line:?} {:?}", found.fundamentals);
    }
}

/// Two lines that the time does not tell apart are not known better than that, and all the digits come with a longer time.
#[test]
fn lines_that_are_not_resolved_have_wide_errors() {
    let pair = [(0.997_926_783, 0.8601), (1.011_999_079, 0.1801)];
    for (length, resolved) in [(100.0, false), (150.0, false), (200.0, false), (1000.0, true)] {
        let signal = |t: f64| pair.iter().map(|(w, a)| a * (w * t).cos()).sum::<f64>();
        let found = lines(&signal, length / 1024.0, 2);
        assert!(!found.lines.is_empty());
        for line in &found.lines {
            let off = |w: f64| (line.frequency - w).abs();
            let off = off(pair[0].0).min(off(pair[1].0));
            assert!(off < 3.0 * line.error + 1e-13, "{length}: {off:e} {line:?}");
            assert!(!resolved || line.error < 1e-9, "{length}: {line:?}");
        }
    }
}

/// Two lines that are not told apart hide none that are clean, however faint, and what they leave is no line.
#[test]
fn lines_that_are_not_resolved_hide_no_others() {
    let clean = [(1.9, 1e-2), (0.4, 1e-3), (3.1, 1e-5)];
    // half a turn in the whole time, and a little more than one
    for apart in [0.5, 0.8, 1.1] {
        let beside = 1.0 + apart * TAU / 1000.0;
        let signal = |t: f64| {
            let pair = (1.0 * t).cos() + 0.3 * (beside * t + 1.0).cos();
            pair + clean.iter().map(|(w, a)| a * (w * t).cos()).sum::<f64>()
        };
        let signal: Vec<f64> = (0..4000).map(|k| signal(0.25 * f64::from(k))).collect();
        let found = spectrum(&signal, 0.25, (8, 4), &mut |_| true).unwrap();
        for (frequency, amplitude) in clean {
            let line = found.lines.iter().find(|line| (line.frequency - frequency).abs() < 1e-4);
            let line = line.unwrap_or_else(|| panic!("{apart}: {frequency} in {found:?}"));
            assert!((line.amplitude / amplitude - 1.0).abs() < 2e-2, "{apart}: {line:?}");
            let off = (line.frequency - frequency).abs();
            assert!(off <= 3.0 * line.error, "{apart}: {off:e} {line:?}");
        }
        let is_known = |w: f64| {
            clean.iter().any(|(known, _)| (w - known).abs() < 1e-4) || (0.99..1.01).contains(&w)
        };
        let others: Vec<_> = found.lines.iter().filter(|line| !is_known(line.frequency)).collect();
        assert!(others.is_empty(), "{apart}: {others:?}");
    }
}

/// cos 100 t + 0.1 cos √2 t: of 2048 values in 90 units of time the first has the image 2π·2048/90 − 100.
#[test]
fn a_line_too_fast_for_the_values_is_found_with_more_or_not_claimed() {
    let quantity = |t: f64| (100.0 * t).cos() + 0.1 * (2.0_f64.sqrt() * t).cos();
    let mut sample = |times: &[f64]| times.iter().map(|&t| quantity(t)).collect();
    let request = |counts: [usize; 2]| SpectrumRequest {
        span: [0.0, 90.0],
        counts,
        is_angle: false,
        lines: (4, 2),
        drive: None,
    };
    let own = sampled_spectrum(&request([2048, 65_536]), &mut sample, &mut |_| true).unwrap();
    assert!(own.is_resolved() && own.count == 8192, "{own:?}");
    assert!((own.spectrum.lines[0].frequency - 100.0).abs() < 1e-10);
    assert!((own.spectrum.lines[1].frequency - 2.0_f64.sqrt()).abs() < 1e-9);
    let few = sampled_spectrum(&request([2048; 2]), &mut sample, &mut |_| true).unwrap();
    assert!(!few.is_resolved() && few.is_strongest_left_out(), "{few:?}");
    let image = std::f64::consts::TAU * 2048.0 / 90.0 - 100.0;
    assert!(few.images.len() == 1 && (few.images[0].frequency - image).abs() < 1e-9);
    assert!((few.spectrum.lines[0].frequency - 2.0_f64.sqrt()).abs() < 1e-9);
    // the slow one is right, and a faint fast one is said not to be
    let quantity = |t: f64| (2.0_f64.sqrt() * t).cos() + 1e-4 * (100.0 * t).cos();
    let mut sample = |times: &[f64]| times.iter().map(|&t| quantity(t)).collect();
    let faint = sampled_spectrum(&request([2048; 2]), &mut sample, &mut |_| true).unwrap();
    assert!(!faint.is_false() && !faint.is_resolved(), "{faint:?}");
    assert!((faint.spectrum.lines[0].frequency - 2.0_f64.sqrt()).abs() < 1e-9);
}

/// No more values are taken of what has no lines, nor of what does not move.
#[test]
fn noise_and_rest_are_not_taken_more_often() {
    let (mut x, mut noise) = (0.3_f64, Vec::new());
    for _ in 0..4096 {
        x = 3.99 * x * (1.0 - x);
        noise.push(x);
    }
    let request = SpectrumRequest {
        span: [0.0, 90.0],
        counts: [2048, 65_536],
        is_angle: false,
        lines: (4, 1),
        drive: None,
    };
    let mut sample = |times: &[f64]| noise[..times.len()].to_vec();
    let found = sampled_spectrum(&request, &mut sample, &mut |_| true).unwrap();
    assert!(found.count == 2048 && found.is_resolved(), "{found:?}");
    let mut sample = |times: &[f64]| vec![0.1; times.len()];
    let found = sampled_spectrum(&request, &mut sample, &mut |_| true).unwrap();
    assert!(found.count == 2048 && found.is_resolved(), "{found:?}");
}

/// cos(t/1000) + 0.01 cos t: however much of its turn the slow line has made, the fast one is there.
#[test]
fn a_line_that_has_made_no_turn_does_not_hide_those_beside_it() {
    for until in [500.0, 1000.0, 2000.0, 3000.0, 6000.0] {
        let spacing = 0.5;
        let at = |k: usize| spacing * k as f64;
        let signal: Vec<f64> = (0..=(until / spacing) as usize)
            .map(|k| (1e-3 * at(k)).cos() + 0.01 * at(k).cos())
            .collect();
        let found = spectrum(&signal, spacing, (8, 2), &mut |_| true).unwrap();
        let line = found.lines.first().unwrap_or_else(|| panic!("no line until {until}"));
        assert!((line.frequency - 1.0).abs() < 1e-5, "{until}: {line:?}");
        assert!((line.frequency - 1.0).abs() <= 3.0 * line.error, "{until}: {line:?}");
        assert!((line.amplitude - 0.01).abs() < 1e-4, "{until}: {line:?}");
    }
    // what escapes has none
    for law in [|t: f64| t * t, |t: f64| (1.0 + t * t).sqrt(), |t: f64| t.ln_1p(), f64::tanh] {
        let signal: Vec<f64> = (0..2000).map(|k| law(0.01 * f64::from(k))).collect();
        let found = spectrum(&signal, 0.01, (8, 2), &mut |_| true).unwrap();
        assert!(found.lines.is_empty(), "{:?}", found.lines);
    }
}

/// Beside a slow change of fifth degree, which is fitted to rounding, there are both lines of which it left none; beside one that
/// is no polynomial the line is there within its error.
#[test]
fn lines_are_found_beside_a_slow_change_of_higher_degree() {
    let sampled = |law: &dyn Fn(f64) -> f64, until: f64| {
        let spacing = until / 2048.0;
        let signal: Vec<f64> = (0..=2048).map(|k| law(spacing * f64::from(k))).collect();
        spectrum(&signal, spacing, (8, 2), &mut |_| true).unwrap()
    };
    let fifth = |t: f64| t.powi(5) / 3e7 + 0.01 * ((2.0 * t).cos() + (2.5 * t).cos());
    let found = sampled(&fifth, 60.0);
    let mut frequencies: Vec<f64> = found.lines.iter().map(|line| line.frequency).collect();
    frequencies.sort_by(f64::total_cmp);
    assert!(frequencies.len() >= 2, "{found:?}");
    assert!((frequencies[0] - 2.0).abs() < 1e-8 && (frequencies[1] - 2.5).abs() < 1e-8);
    let decaying = |t: f64| 1.0 / (1.0 + 0.1 * t) + 0.01 * (3.1 * t).cos();
    let found = sampled(&decaying, 40.0);
    let line = found.lines.first().expect("a line");
    assert!((line.frequency - 3.1).abs() <= 3.0 * line.error && line.error < 1e-2, "{line:?}");
}

/// Two lines that make from a half of a turn to nearly one and a half about each other in the whole time: neither is an image of a
/// faster one, how far they lie apart is known, and a motion followed for as long as is said has both.
#[test]
fn lines_too_close_to_be_told_apart_are_not_called_too_fast() {
    let sampled = |apart: f64, amplitude: f64, until: f64| {
        let beside = 1.0 + apart;
        let mut sample = |times: &[f64]| {
            let at = |&t: &f64| t.cos() + amplitude * (beside * t + 1.0).cos();
            times.iter().map(at).collect()
        };
        let request = SpectrumRequest {
            span: [0.0, until],
            counts: [2048, 65_536],
            is_angle: false,
            lines: (6, 2),
            drive: None,
        };
        sampled_spectrum(&request, &mut sample, &mut |_| true).unwrap()
    };
    for amplitude in [1.0, 0.9, 0.5] {
        for turns in [0.5, 0.8, 1.0, 1.2, 1.4] {
            let apart = turns * TAU / 1000.0;
            let found = sampled(apart, amplitude, 1000.0);
            assert!(found.is_resolved() && !found.is_false(), "{amplitude}, {turns}: {found:?}");
            let close = found.spectrum.close;
            // lines without noise may be told apart sooner
            let longer = match close {
                Some(close) => {
                    assert!((close.apart / apart - 1.0).abs() < 0.01, "{turns}: {close:?}");
                    let mut fitted = found.spectrum.lines.iter().map(|line| line.frequency);
                    assert!(fitted.any(|fitted| fitted == close.frequency), "{found:?}");
                    sampled(apart, amplitude, close.time_to_part())
                }
                None => found,
            };
            assert!(close.is_some() || turns > 1.0, "{amplitude}, {turns}");
            let lines = &longer.spectrum.lines;
            assert!(longer.spectrum.close.is_none() && lines.len() == 2, "{lines:?}");
            let distance = (lines[0].frequency - lines[1].frequency).abs();
            assert!((distance / apart - 1.0).abs() < 1e-6, "{amplitude}, {turns}: {lines:?}");
        }
    }
    // one line, and two that are told apart, are not close
    assert!(sampled(0.0, 1.0, 1000.0).spectrum.close.is_none());
    assert!(sampled(3.0 * TAU / 1000.0, 1.0, 1000.0).spectrum.close.is_none());
}

/// A wave that decays is no sum of lines: what is listed for it lies between zero and the fastest that the values can show.
#[test]
fn lines_of_a_wave_that_decays_are_between_zero_and_half_of_the_rate_of_values() {
    for (rate, frequency, drive) in [(0.05, 1.3, 0.0), (0.15, 1.0, 0.0), (0.15, 1.4, 0.05)] {
        let at = |t: f64| {
            let wave = (-rate * t).exp();
            // the frequency falls with the amplitude
            wave * (frequency * t - 2.0 * wave).cos() + drive * (t + 1.0).cos()
        };
        let (count, spacing) = (1024, 90.0 / 1024.0);
        let signal: Vec<f64> = (0..count).map(|k| at(f64::from(k) * spacing)).collect();
        let found = spectrum(&signal, spacing, (10, 1), &mut |_| true).expect("a spectrum");
        for line in &found.lines {
            let range = TAU / 90.0..=std::f64::consts::PI / spacing;
            assert!(range.contains(&line.frequency), "{rate}: {:?}", found.lines);
        }
        assert!(found.is_continuous() || !found.lines.is_empty());
    }
}
