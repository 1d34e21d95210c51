//! Rotation numbers by weighted Birkhoff averages, against maps whose rotation numbers are known.

use std::f64::consts::{PI, TAU};

use phaselab::dynamics::{NoRotation, Turning, angle_rotation, rotation};

const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// The standard map: p' = p + K sin θ, θ' = θ + p'.
fn standard(k: f64, start: (f64, f64), count: usize) -> Vec<[f64; 2]> {
    let (mut theta, mut p) = start;
    let step = |_| {
        p += k * theta.sin();
        theta += p;
        [theta, p]
    };
    (0..count).map(step).collect()
}

/// A turn through ρ on an ellipse with a bump: q = a sin φ, p = b cos φ, φ distorted.
fn curve(rho: f64, count: usize) -> Vec<[f64; 2]> {
    let point = |n: usize| {
        let phase = TAU * (0.1 + rho * n as f64);
        let bent = phase + 0.2 * phase.sin();
        [3.0 + 2.0 * bent.sin() * (1.0 + 0.1 * phase.cos()), 0.1 * bent.cos() - 1.0]
    };
    (0..count).map(point).collect()
}

#[test]
fn a_curve_has_the_number_it_was_made_with() {
    for rho in [GOLDEN, 1.0 - GOLDEN, 0.1234567, PI - 3.0, 0.93] {
        for (count, within) in [(250, 1e-5), (4000, 1e-12)] {
            let found = rotation(&curve(rho, count), [None; 2]).unwrap();
            let off = (found.number - rho).abs();
            assert!(off < within && off <= found.error + 1e-15, "{rho} {count}: {found:?}");
            assert_eq!(found.turning, Turning::Middle);
        }
    }
    // the other way round it is the rest of a turn
    let back: Vec<[f64; 2]> = curve(0.3, 2000).into_iter().rev().collect();
    assert!((rotation(&back, [None; 2]).unwrap().number - 0.7).abs() < 1e-10);
    // p of q islands
    let islands = rotation(&curve(3.0 / 7.0, 700), [None; 2]).unwrap();
    assert!((islands.number - 3.0 / 7.0).abs() < 1e-12);
}

/// Without kicks the angle advances by p; with small ones the torus of ω lies at θ = φ − K sin φ/(4 sin² πω) + O(K²).
#[test]
fn the_torus_of_the_golden_mean_is_where_perturbation_theory_has_it() {
    let free = standard(0.0, (0.5, 1.3), 300);
    let found = rotation(&free, [Some(TAU), None]).unwrap();
    assert!((found.number - 1.3 / TAU).abs() < 1e-14 && found.turning == Turning::Axis(0));
    let kick = 1e-3;
    let size = kick / (4.0 * (PI * GOLDEN).sin().powi(2));
    let torus = |phase: f64| phase - size * phase.sin();
    let phase = 0.9;
    let (now, before) = (torus(phase), torus(phase - TAU * GOLDEN));
    let orbit = standard(kick, (now, now - before), 5000);
    let found = rotation(&orbit, [Some(TAU), None]).unwrap();
    let off = (found.number - GOLDEN).abs();
    assert!(off < kick * kick && found.error < 1e-12, "{found:?} {off}");
    // without the first order it lies farther away
    let off = standard(kick, (now, TAU * GOLDEN), 5000);
    let off = (rotation(&off, [Some(TAU), None]).unwrap().number - GOLDEN).abs();
    assert!(off > 10.0 * kick * kick, "{off}");
}

/// Inside an island about θ = π the map turns by arccos(1 − K/2)/2π at its centre.
#[test]
fn an_island_turns_as_its_centre_does() {
    let kick = 0.6_f64;
    let orbit = standard(kick, (PI + 1e-5, 0.0), 3000);
    let found = rotation(&orbit, [Some(TAU), None]).unwrap();
    let centre = (1.0 - kick / 2.0).acos() / TAU;
    assert_eq!(found.turning, Turning::Middle);
    assert!((found.number - centre).abs() < 1e-9, "{found:?} {centre}");
}

/// A closed curve that is bent around its own middle without enclosing it: turns of all sizes occur, and nothing is chaotic.
#[test]
fn a_curve_beside_its_middle_is_not_chaotic() {
    let bent = |rho: f64, count: usize| -> Vec<[f64; 2]> {
        let point = |n: usize| {
            let phase = TAU * rho * n as f64;
            let (angle, radius) = (2.6 * phase.sin(), 1.0 + 0.2 * phase.cos());
            [radius * angle.sin(), radius * angle.cos()]
        };
        (0..count).map(point).collect()
    };
    for count in [100, 1000, 10_000] {
        for rho in [GOLDEN, PI - 3.0, 2.0_f64.sqrt() - 1.0] {
            let found = rotation(&bent(rho, count), [None; 2]);
            let chaotic = matches!(found, Err(NoRotation::Diverges(_) | NoRotation::AllTurns));
            assert!(!chaotic, "{rho} {count}: {found:?}");
            let is_regular = matches!(found, Err(NoRotation::NotEnclosing | NoRotation::NotAround));
            assert!(is_regular || count < 10_000, "{rho} {count}: {found:?}");
        }
    }
    // averages converge, turns do not: it is regular, and is not said to go round once
    let found = rotation(&bent(GOLDEN, 10_000), [None; 2]);
    assert_eq!(found, Err(NoRotation::NotEnclosing));
    // where it shifts along its curve but a little in all crossings
    for rho in [1.0 / 5.0 + 3e-4, 1.0 / 3.0 - 8e-4, 2e-3] {
        let found = rotation(&bent(rho, 300), [None; 2]);
        let chaotic = matches!(found, Err(NoRotation::Diverges(_) | NoRotation::AllTurns));
        assert!(!chaotic, "{rho}: {found:?}");
    }
}

#[test]
fn a_chaotic_orbit_has_none_and_says_why() {
    for (kick, start) in [(1.5, (0.01, 0.0)), (3.0, (0.3, 0.2)), (7.0, (1.0, 2.0))] {
        for count in [100, 1000, 20000] {
            let orbit = standard(kick, start, count);
            let found = rotation(&orbit, [Some(TAU), None]);
            // a hundred crossings may all lie near an island
            let open = count == 100 && matches!(found, Err(NoRotation::Undecided(_)));
            let diverges = matches!(found, Err(NoRotation::Diverges(_)));
            assert!(diverges || open, "{kick} {count}: {found:?}");
            let wrapped: Vec<[f64; 2]> =
                orbit.iter().map(|at| at.map(|x| x.rem_euclid(TAU))).collect();
            let around = rotation(&wrapped, [None; 2]);
            let reported = matches!(around, Err(NoRotation::Diverges(_) | NoRotation::AllTurns));
            assert!(reported || open, "{kick} {count}: {around:?}");
        }
    }
}

/// A circle map that turns slowly once in its round is regular, and needs many crossings to show it.
#[test]
fn an_orbit_of_few_crossings_is_not_called_chaotic() {
    let angles = |count: usize| {
        let next = |angle: &f64| Some(angle + 0.12 + 0.11 * angle.sin());
        std::iter::successors(Some(0.0), next).take(count).collect::<Vec<f64>>()
    };
    for count in [60, 240] {
        let found = angle_rotation(&angles(count), TAU);
        assert!(matches!(found, Err(NoRotation::Undecided(_))), "{count}: {found:?}");
    }
    assert!(angle_rotation(&angles(5000), TAU).is_ok());
}

/// How much a tangent vector has grown along the standard map, as a logarithm.
fn grown(k: f64, (mut theta, mut p): (f64, f64), count: usize) -> f64 {
    let (mut turned, mut kicked, mut sum) = (0.6_f64, 0.8_f64, 0.0);
    for _ in 0..count {
        kicked += k * theta.cos() * turned;
        turned += kicked;
        p += k * theta.sin();
        theta += p;
        let size = turned.hypot(kicked);
        sum += size.ln();
        (turned, kicked) = (turned / size, kicked / size);
    }
    sum
}

fn is_chaotic(found: Result<phaselab::dynamics::Rotation, NoRotation>) -> bool {
    matches!(found, Err(NoRotation::Diverges(_) | NoRotation::AllTurns))
}

/// Starts of the standard map from weak to strong kicks, known to be regular or chaotic by how a tangent vector grows in a hundred
/// times as many crossings: no regular one is called chaotic, however few its crossings, most chaotic ones are after a
/// thousand, in the thin layers beside the saddle point too; the others cling to islands.
#[test]
fn regular_and_chaotic_orbits_are_told_apart_in_thin_layers_too() {
    let part = |k: usize, by: f64| (by * k as f64).fract();
    let spread = |k: usize| (TAU * part(k, 0.618_034), TAU * part(k, 0.754_878));
    let beside = |k: usize| (0.03 * (part(k, 0.618_034) - 0.5), 0.02 * (part(k, 0.754_878) - 0.5));
    let kicks = [0.3, 0.6, 0.9, 0.971_635, 1.2, 1.6, 2.2, 3.0];
    let orbits = kicks.iter().flat_map(|&kick| (1..=60).map(move |k| (kick, spread(k))));
    let layers = [0.5, 0.7, 0.9].iter().flat_map(|&kick| (1..=20).map(move |k| (kick, beside(k))));
    let (mut regular, mut chaotic, mut found) = (0, 0, 0);
    for (kick, start) in orbits.chain(layers) {
        let grown = grown(kick, start, 100_000);
        let orbit = standard(kick, start, 1000);
        let of = |count: usize| rotation(&orbit[..count], [Some(TAU), None]);
        if grown < 25.0 {
            regular += 1;
            for count in [60, 100, 240, 1000] {
                assert!(!is_chaotic(of(count)), "{kick} {start:?} {count}: {:?}", of(count));
            }
        } else if grown > 100.0 {
            chaotic += 1;
            found += usize::from(is_chaotic(of(1000)));
        }
    }
    assert!(regular > 150 && chaotic > 150, "{regular} {chaotic}");
    assert!(found * 100 > 88 * chaotic, "{found} of {chaotic}");
}

/// Columns of two and of one tell the same of an orbit: an angle alone that wanders is chaotic, one that shifts slowly is not.
#[test]
fn an_angle_alone_is_judged_as_a_point_is() {
    for (kick, start) in [(1.5, (0.01, 0.0)), (3.0, (0.3, 0.2)), (7.0, (1.0, 2.0))] {
        let angles: Vec<f64> = standard(kick, start, 5000).iter().map(|at| at[0]).collect();
        assert!(is_chaotic(angle_rotation(&angles, TAU)), "{kick}");
    }
    // slow near 0 in each of its rounds, which take 60 crossings: the parts of a few rounds differ by as much as random numbers
    let slow = |angle: &f64| Some(angle + 0.27 + 0.26 * angle.sin());
    for count in [90, 150, 400] {
        let angles: Vec<f64> = std::iter::successors(Some(0.0), slow).take(count).collect();
        let found = angle_rotation(&angles, TAU);
        assert!(!is_chaotic(found), "{count}: {found:?}");
    }
}

#[test]
fn what_is_no_rotation_is_refused() {
    assert_eq!(rotation(&curve(0.3, 15), [None; 2]), Err(NoRotation::TooFew(15)));
    assert_eq!(rotation(&[[0.5, 0.25]; 50], [None; 2]), Err(NoRotation::OnePoint));
    assert_eq!(rotation(&[[f64::NAN, 0.0]; 50], [None; 2]), Err(NoRotation::NotFinite));
    // a crescent around a point that its middle is not
    let crescent = |n: u32| {
        let phase = TAU * 0.0531 * f64::from(n);
        let (angle, radius) = (1.8 * phase.sin(), 1.0 + 0.05 * phase.cos());
        [radius * angle.cos(), radius * angle.sin()]
    };
    let points: Vec<[f64; 2]> = (0..1000).map(crescent).collect();
    assert_eq!(rotation(&points, [None; 2]), Err(NoRotation::NotAround));
    assert_eq!(angle_rotation(&[0.0; 3], TAU), Err(NoRotation::TooFew(3)));
}
