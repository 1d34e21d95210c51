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
    assert_eq!(found.verdict, Chaos::Unstable, "{}", found.reason);
    assert!(
        found.reason.contains("back at its start after 6.901, to rounding"),
        "{}",
        found.reason
    );
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
    assert_ne!(found.verdict, Chaos::Chaotic, "{}", found.reason);
    let text = text.replace("- 2*x^2 + 3*y^2", "+ 3*x^2 - 2*y^2");
    let found = of(&file(&text, &[]), 200.0);
    assert_eq!(found.verdict, Chaos::Unstable, "{}", found.reason);
    assert!(found.reason.contains("the motion is at rest"), "{}", found.reason);
}

/// Linear equations are never chaotic: the exponents are known in closed form but for Mathieu's, whose sum is 0.
#[test]
fn linear_motions_are_unstable_and_never_chaotic() {
    let oscillator = |law: &str| {
        let text = format!(
            "title = \"t\"\n[coordinates]\nx = {{ initial = 0.7, velocity = 0 }}\n[lagrangian]\n{law}\n"
        );
        of(&file(&text, &[]), 300.0)
    };
    let driven = oscillator("L = \"1/2*x'^2 - x^2/2\"\ndissipation = \"-0.05*x'^2\"");
    assert_eq!(driven.verdict, Chaos::Unstable, "{}", driven.reason);
    assert!((driven.exponents[0] - 0.05).abs() <= driven.uncertainty[0], "{driven:?}");
    let mathieu = oscillator("L = \"1/2*x'^2 - 0.5*(1 + 0.5*cos(2*t))*x^2\"");
    assert_eq!(mathieu.verdict, Chaos::Unstable, "{}", mathieu.reason);
    assert!(mathieu.exponents[0] > 0.1 && mathieu.sum.abs() < 1e-10);
    // a stable one of Mathieu's, and friction that damps
    let still = oscillator("L = \"1/2*x'^2 - 0.5*(3 + 0.2*cos(2*t))*x^2\"");
    assert_eq!(still.verdict, Chaos::Regular, "{}", still.reason);
    let saddle = |y: &str| {
        let text = format!(
            "title = \"t\"\n[coordinates]\nx = {{ initial = 1, momentum = 0 }}\ny = {{ initial = {y}, momentum = 0 }}\n\
             [hamiltonian]\nH = \"1/2*(p_x^2 + p_y^2) + x^2/2 - y^2/2\"\n"
        );
        of(&file(&text, &[]), 300.0)
    };
    let plane = saddle("0");
    assert_eq!(plane.verdict, Chaos::Unstable, "{}", plane.reason);
    assert!((plane.exponents[0] - 1.0).abs() <= plane.uncertainty[0], "{plane:?}");
    // where it escapes along the flow, that direction is not taken out
    let escapes = saddle("0.5");
    assert_eq!((escapes.verdict, escapes.removed), (Chaos::Unstable, Removed::Nothing));
    assert!((escapes.exponents[0] - 1.0).abs() <= escapes.uncertainty[0], "{escapes:?}");
    assert!((escapes.exponents[3] + 1.0).abs() <= escapes.uncertainty[3], "{escapes:?}");
}

/// x = 0, y = cos t of V = (x² − 2)²/2 + y²/2 has the multipliers e^{±4π}; it is periodic. Beside an oscillator of another frequency it
/// is not, and follows linear equations all the same.
#[test]
fn an_unstable_orbit_in_a_plane_is_not_chaotic() {
    let text = "title = \"t\"\n[coordinates]\nx = { initial = 0, momentum = 0 }\ny = { initial = 1, momentum = 0 }\n";
    let law = "[hamiltonian]\nH = \"1/2*(p_x^2 + p_y^2) + 1/2*(x^2 - 2)^2 + y^2/2\"\n";
    let found = of(&file(&format!("{text}{law}"), &[]), 200.0);
    assert_eq!(found.verdict, Chaos::Unstable, "{}", found.reason);
    assert!(found.reason.contains("back at its start after 6.28"), "{}", found.reason);
    assert!((found.exponents[0] - 2.0).abs() <= found.uncertainty[0], "{found:?}");
    let third = "z = { initial = 1, momentum = 0 }\n[hamiltonian]\n\
                 H = \"1/2*(p_x^2 + p_y^2 + p_z^2) + 1/2*(x^2 - 2)^2 + y^2/2 + z^2\"\n";
    let found = of(&file(&format!("{text}{third}"), &[]), 200.0);
    assert_eq!(found.verdict, Chaos::Unstable, "{}", found.reason);
    assert!(found.reason.contains("linear equations"), "{}", found.reason);
}

/// A motion of one degree of freedom has the exponents 0 where it returns: x″ = x does not, nor does the homoclinic orbit
/// x = 1/cosh(√2 t) of V = x⁴ − x², which comes to rest at an equilibrium with the rates ±√2.
#[test]
fn a_motion_of_one_degree_of_freedom_that_does_not_return_has_exponents() {
    let well = |potential: &str, start: &str, until: f64| {
        let text = format!(
            "title = \"t\"\n[coordinates]\nx = {{ initial = {start}, velocity = 0 }}\n[lagrangian]\nL = \"1/2*x'^2 - ({potential})\"\n"
        );
        of(&file(&text, &[]), until)
    };
    let found = well("-x^2/2", "0.7", 100.0);
    assert_eq!(found.verdict, Chaos::Unstable, "{}", found.reason);
    for (exponent, known) in found.exponents.iter().zip([1.0, -1.0]) {
        assert!((exponent - known).abs() <= found.uncertainty[0], "{found:?}");
    }
    for until in [10.0, 40.0, 300.0] {
        let found = well("x^4 - x^2", "1", until);
        assert_eq!(found.verdict, Chaos::Unstable, "{until}: {}", found.reason);
        for (exponent, known) in found.exponents.iter().zip([1.0, -1.0]) {
            assert!((exponent - known * 2.0_f64.sqrt()).abs() <= found.uncertainty[0], "{found:?}");
        }
    }
    // inside and outside of the separatrix the motion returns
    for start in ["0.999", "1.001"] {
        let found = well("x^4 - x^2", start, 100.0);
        assert_eq!((found.verdict, &found.exponents[..]), (Chaos::Regular, &[0.0, 0.0][..]));
        assert!(found.reason.contains("that returns"), "{}", found.reason);
    }
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
    let late = of(&case, 3840.0);
    assert_eq!(late.verdict, Chaos::Unstable, "{}", late.reason);
    assert!(late.reason.contains("back at its start after 6.28"), "{}", late.reason);
}
