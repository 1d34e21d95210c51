//! Lyapunov exponents.

use phaselab::dynamics::{Chaos, Lyapunov, Removed, lyapunov};

use super::{Case, file, method, preset, taylor};

/// The unstable periodic orbit B of Hénon and Heiles at E = 1/8: its period, and ln|μ|/T.
const ORBIT: [f64; 4] = [0.0, -0.18540508709080214, 0.45975654576795759, 0.0];
const PERIOD: f64 = 6.900_599_447_648_208;
const EXPONENT: f64 = 0.19195453623623;

fn of(case: &Case, until: f64) -> Lyapunov {
    lyapunov(&case.space, taylor(), &case.start, until, &mut |_| {}).unwrap()
}

#[test]
fn a_periodic_orbit_has_the_exponents_of_its_multipliers() {
    let case = preset("henon-heiles", &[], &ORBIT);
    let found = of(&case, 20.0 * PERIOD);
    let [largest, zero, other, least] = found.exponents[..] else { panic!("{found:?}") };
    assert!((largest - EXPONENT).abs() < 2e-6, "{largest}");
    assert_eq!((zero, other, found.removed), (0.0, 0.0, Removed::FlowAndEnergy));
    assert!((largest + least).abs() < 1e-15 && found.pairing_residual.unwrap() < 1e-15);
    assert!(found.sum.abs() < 1e-15);
    assert_eq!(found.verdict, Chaos::Chaotic, "{}", found.reason);
    // MEGNO of pure exponential growth is λt/2 on average
    let expected = 0.5 * EXPONENT * found.time;
    assert!((found.megno / expected - 1.0).abs() < 0.1, "{} {expected}", found.megno);
    for ((exponent, off), known) in
        found.exponents.iter().zip(&found.uncertainty).zip([EXPONENT, 0.0, 0.0, -EXPONENT])
    {
        assert!((exponent - known).abs() <= *off);
    }
    // another method agrees as far as it follows the orbit
    let other =
        lyapunov(&case.space, method("yoshida6", Some(0.05)), &case.start, 70.0, &mut |_| {});
    assert!((other.unwrap().exponents[0] - EXPONENT).abs() < 1e-3);
}

#[test]
fn chaotic_and_regular_motions_of_henon_and_heiles_are_told_apart() {
    // starts of ChaosTools' tests; exponents at E = 1/8 lie between 0.037 and 0.046 over 10⁶
    let chaotic = of(&preset("henon-heiles", &[], &[0.0, -0.25, 0.42081, 0.0]), 1500.0);
    assert_eq!(chaotic.verdict, Chaos::Chaotic, "{}", chaotic.reason);
    let (largest, off) = (chaotic.exponents[0], chaotic.uncertainty[0]);
    assert!((0.03..0.08).contains(&largest) && off < 0.02, "{largest} ± {off}");
    assert!(chaotic.pairing_residual.unwrap() < 1e-14);
    assert!(chaotic.megno > 20.0);
    for start in [[0.0, 0.295456, 0.407308431, 0.0], [0.0, 0.483, 0.27898039, 0.0]] {
        let regular = of(&preset("henon-heiles", &[], &start), 800.0);
        assert_eq!(regular.verdict, Chaos::Regular, "{}", regular.reason);
        assert!(regular.exponents[0].abs() <= regular.uncertainty[0]);
    }
    let short = of(&preset("henon-heiles", &[], &[0.0, -0.25, 0.42081, 0.0]), 5.0);
    assert_eq!(short.verdict, Chaos::Undecided);
    assert!(short.reason.contains("too short"));
}

#[test]
fn megno_of_a_torus_is_two() {
    let found = of(&preset("henon-heiles", &[], &[0.0, 0.483, 0.27898039, 0.0]), 3000.0);
    assert!((found.megno - 2.0).abs() < 0.2, "{}", found.megno);
    // and that of motions that only drift apart in time
    let found = of(&preset("pendulum", &[], &[1.5, 0.0]), 600.0);
    assert!((found.megno - 2.0).abs() < 0.1, "{}", found.megno);
    assert_eq!(found.exponents, [0.0, 0.0]);
    assert_eq!(found.verdict, Chaos::Regular);
}

#[test]
fn friction_gives_the_exponents_of_the_linear_system() {
    let text = "title = \"t\"\n[coordinates]\nx = { initial = 0.3, momentum = 0.7 }\n\
                [hamiltonian]\nH = \"1/2*p_x^2 + 1/2*x^2\"\nforces = { x = \"-0.3*p_x\" }\n";
    let found = of(&file(text, &[]), 300.0);
    for exponent in &found.exponents {
        assert!((exponent + 0.15).abs() < 1e-4, "{exponent}");
    }
    assert!((found.sum + 0.3).abs() < 1e-13);
    assert_eq!((found.removed, found.pairing_residual), (Removed::Nothing, None));
    assert_eq!(found.verdict, Chaos::Regular);
}

/// On the limit cycle of van der Pol all vectors keep their lengths and turn into the direction of the flow: e^{−7.06} of the area
/// is left after a period. The exponents add up to the mean of 1 − x² over it, here by equal intervals of a period of
/// 6.66328685932313 (C. M. Andersen & J. F. Geer, SIAM J. Appl. Math. 42 (1982) 678).
#[test]
fn exponents_of_a_limit_cycle_hold_for_many_periods() {
    const PERIOD: f64 = 6.663_286_859_323_13;
    let text = "title = \"t\"\n[coordinates]\nx = { initial = 2.0, velocity = 0.0 }\n[lagrangian]\n\
                L = \"1/2*x'^2 - 1/2*x^2\"\nforces = { x = \"(1 - x^2)*x'\" }\n";
    let mut motion = crate::experiment::build(text, |_| {});
    let (settled, count) = (20.0 * PERIOD, 256);
    let divergence: f64 = (0..count)
        .map(|k| {
            crate::experiment::run(&mut motion, settled + PERIOD * f64::from(k) / f64::from(count));
            1.0 - crate::experiment::value(&motion, "x").powi(2)
        })
        .sum();
    let mean = divergence / f64::from(count);
    let case = file(text, &[]);
    for tolerance in [1e-10, 1e-15] {
        let (kind, settings) = method("taylor", None);
        let settings = phaselab::integrate::Settings { tolerance: Some(tolerance), ..settings };
        let found =
            lyapunov(&case.space, (kind, settings), &case.start, 3000.0, &mut |_| {}).unwrap();
        let [along, across] = found.exponents[..] else { panic!("{found:?}") };
        assert!(along.abs() < 1e-4, "{along}");
        assert!((across - mean).abs() < 1e-3, "{across} {mean}");
        assert_eq!(found.verdict, Chaos::Regular, "{}", found.reason);
    }
}

#[test]
fn an_unstable_equilibrium_has_the_exponents_of_its_eigenvalues() {
    let text = "title = \"t\"\n[coordinates]\nx = { initial = 0, momentum = 0 }\n\
                y = { initial = 0, momentum = 0 }\n\
                [hamiltonian]\nH = \"1/2*(p_x^2 + p_y^2) - 2*x^2 + 3*y^2\"\n";
    let found = of(&file(text, &[]), 60.0);
    assert_eq!(found.removed, Removed::Nothing);
    assert!((found.exponents[0] - 2.0).abs() < 1e-3 && (found.exponents[3] + 2.0).abs() < 1e-3);
    assert!(found.exponents[1].abs() < 0.02 && found.pairing_residual.unwrap() < 1e-13);
}

/// What is taken out depends on whether the motion moves, not on its units.
#[test]
fn a_motion_in_atomic_units_is_no_rest() {
    for [length, time, energy] in
        [[1.0, 1.0, 1.0], [5e-11, 2.4e-17, 4.4e-18], [3.1e19, 3.2e15, 2.7e41]]
    {
        let [q, rate] = [format!("/{length:e}"), format!("*{:e}", time / length)];
        let speed = length / time;
        let text = format!(
            "title = \"one\"\n[coordinates]\nx = {{ initial = {:e}, velocity = {:e} }}\n\
             y = {{ initial = {:e}, velocity = {:e} }}\n[lagrangian]\n\
             L = \"{energy:e}*(1/2*((x'{rate})^2 + (y'{rate})^2) - 1/2*((x{q})^2 + (y{q})^2) - (x{q})^2*(y{q}) + 1/3*(y{q})^3)\"\n",
            0.1 * length,
            0.2 * speed,
            0.15 * length,
            0.25 * speed
        );
        let found = of(&file(&text, &[]), 200.0 * time);
        assert_eq!(found.removed, Removed::FlowAndEnergy, "{text}");
        assert_eq!(found.exponents[1..3], [0.0; 2], "{text}");
    }
    // a body that stays where it is has no direction of its own
    let rest = "title = \"top\"\n[coordinates]\nq = { initial = \"pi\" }\n[lagrangian]\nL = \"1/2*q'^2 + cos(q)\"\n";
    assert_eq!(of(&file(rest, &[]), 20.0).removed, Removed::Nothing);
}

/// Two magnetic needles: to t = 100 MEGNO is below what regular motion may have, and has doubled since 50; neighbours part by
/// e^28 until 200.
#[test]
fn a_megno_that_doubles_is_not_that_of_regular_motion() {
    let text = "title = \"needles\"\n[coordinates]\na = { initial = 0.6, velocity = 0.3 }\nf = { initial = 0.1, velocity = 0.5 }\n\
                b = { initial = 1.9, velocity = -0.2 }\ng = { initial = 1.3, velocity = 0.4 }\n[lagrangian]\n\
                L = \"1/2*(a'^2 + sin(a)^2*f'^2) + 0.35*(b'^2 + sin(b)^2*g'^2) \
                - sin(a)*sin(b)*cos(f - g) + 2*cos(a)*cos(b)\"\n";
    let case = file(text, &[]);
    let early = of(&case, 100.0);
    assert!((2.2..2.8).contains(&early.megno), "{}", early.megno);
    assert_eq!(early.verdict, Chaos::Undecided, "{}", early.reason);
    assert!(early.reason.contains("rises in proportion to time"), "{}", early.reason);
    assert_eq!(of(&case, 200.0).verdict, Chaos::Chaotic);
}

/// On the invariant plane y = 0 neighbours part as e^{kt} exactly, and MEGNO is kt/2: at kt = 7.7 that is too much for a regular
/// motion and too little to be called chaotic. Over a third of the time it may pass for regular, over twice the time not.
#[test]
fn a_slow_growth_is_undecided_until_it_shows() {
    let text = "title = \"t\"\n[coordinates]\nx = { initial = 1, momentum = 0 }\ny = { initial = 0, momentum = 0 }\n\
                [hamiltonian]\nH = \"1/2*(p_x^2 + x^2) + 1/2*(p_y^2 - 0.004^2*y^2) + 1/4*y^4\"\n";
    let case = file(text, &[]);
    let found = of(&case, 1920.0);
    assert_eq!(found.verdict, Chaos::Undecided, "{}", found.reason);
    assert!((found.exponents[0] - 0.004).abs() <= found.uncertainty[0].max(1e-4), "{found:?}");
    for words in ["in a time of 1920", "between regular (up to 2.8) and chaotic (from 5)"] {
        assert!(found.reason.contains(words), "{words}: {}", found.reason);
    }
    assert_eq!(of(&case, 640.0).verdict, Chaos::Regular);
    assert_eq!(of(&case, 3840.0).verdict, Chaos::Chaotic);
}
