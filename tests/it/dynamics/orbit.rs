//! Periodic orbits.

use phaselab::dynamics::{Along, DynamicsError, Fixed, Orbit, Removed, family, periodic_orbit};

use super::{Case, file, method, preset, taylor};

fn close(a: f64, b: f64, within: f64) {
    assert!((a - b).abs() <= within, "{a} is not {b}");
}

fn of(case: &Case, period: Option<f64>, fixed: Fixed) -> Orbit {
    periodic_orbit(&case.space, taylor(), &case.start, period, fixed).unwrap()
}

#[test]
fn orbit_b_of_henon_and_heiles_is_closed_from_nearby() {
    let case = preset("henon-heiles", &[], &[0.0, -0.18, 0.46, 0.0]);
    let found = of(&case, None, Fixed::Energy(0.125));
    close(found.period, 6.900_599_447_648_208_6, 2e-13);
    close(found.energy, 0.125, 1e-15);
    close(found.transverse.trace(), 4.026_594_859_728_68, 1e-11);
    assert!(found.closure < 1e-14 && !found.stable);
    assert_eq!((found.trivial, found.multipliers.len()), (Removed::FlowAndEnergy, 2));
    let exponent = found.multipliers[0][0].ln() / found.period;
    close(exponent, 0.191_954_536_236_23, 1e-12);
    close(found.multipliers[0][0] * found.multipliers[1][0], 1.0, 1e-12);
    // the same by a method of fixed step, whose own map is closed
    let other = periodic_orbit(
        &case.space,
        method("yoshida8", Some(0.05)),
        &case.start,
        None,
        Fixed::Energy(0.125),
    );
    close(other.unwrap().period, found.period, 1e-6);
}

#[test]
fn the_pendulum_has_its_closed_form_period() {
    // T = 4 K(sin 1) for θ₀ = 2 and g/l = 1, E = −cos 2 g/l above the pivot
    let text = "title = \"t\"\n[coordinates]\nx = { initial = 1.9, momentum = 0 }\n\
                [hamiltonian]\nH = \"1/2*p_x^2 - cos(x)\"\n";
    let found = of(&file(text, &[]), None, Fixed::Energy(-(2.0_f64.cos())));
    close(found.period, 8.349752926918493, 1e-13);
    assert!(found.multipliers.is_empty() && found.stable);
    // dJ/dE = T
    let case = file(text, &[]);
    let action = |energy: f64| of(&case, None, Fixed::Energy(energy)).action.unwrap();
    let energy = -(2.0_f64.cos());
    let slope = (action(energy + 1e-4) - action(energy - 1e-4)) / 2e-4;
    close(slope, found.period, 1e-6);
    // of a given period
    let found = of(&case, None, Fixed::Period(8.0));
    assert!(found.period == 8.0 && found.closure < 1e-14);
    let other = of(&case, None, Fixed::Energy(found.energy));
    close(other.period, 8.0, 1e-11);
}

#[test]
fn the_lyapunov_orbit_at_l1_closes() {
    // about L1 of the Earth and the Moon
    let (x, v) = (0.826915, 0.090663934460268879);
    let case =
        preset("restricted-three-body", &[("mu", 0.012150585609624), ("x0", x), ("v0", v)], &[]);
    let found = of(&case, Some(2.7172), Fixed::Energy(energy(&case)));
    close(found.period, 2.717210310294213, 1e-13);
    assert!(found.closure < 1e-13 && !found.stable);
    close(found.multipliers[0][0] * found.multipliers[1][0], 1.0, 1e-8);
}

/// A start on an orbit is left as it is, to the last bit; beside one of a given period the orbit moves.
#[test]
fn a_start_on_an_orbit_is_left_as_it_is() {
    let case = preset("henon-heiles", &[], &[0.0, -0.18540508709080214, 0.45975654576795759, 0.0]);
    let found = of(&case, None, Fixed::Nothing);
    assert_eq!(found.state.values, case.start.values);
    close(found.period, 6.900_599_447_648_208_6, 2e-13);
    close(found.exponent(found.multipliers[0]).unwrap(), 0.191_954_536_236_23, 1e-12);
    assert_eq!(found.rotation(found.multipliers[0]), None);
    // the orbits at L1 that are shorter lie nearer to it, x = 0.8369; their family followed gives x = 0.827128… at 2.716
    let (x, v) = (0.826915, 0.090663934460268879);
    let set = [("mu", 0.0121505856), ("x0", x), ("v0", v)];
    let case = preset("restricted-three-body", &set, &[]);
    let first = of(&case, Some(2.7172), Fixed::Nothing);
    let walk = (Along::Period, Fixed::Nothing);
    let members =
        family(&case.space, taylor(), &first, walk, (&[2.717, 2.716], &|_| ())).unwrap().members;
    assert_eq!(members.len(), 2);
    for member in members {
        let found = of(&case, Some(member.value), Fixed::Period(member.value));
        assert!(found.period == member.value && found.closure < 1e-12);
        // where on the orbit each of them begins is nobody's choice
        close(found.energy, member.orbit.energy, 1e-9);
        let [own, other] = [&found, &member.orbit].map(|orbit| orbit.multipliers[0][0]);
        close(own / other, 1.0, 1e-6);
    }
}

fn energy(case: &Case) -> f64 {
    case.space.system().energy(&case.start, case.space.parameters()).unwrap()
}

#[test]
fn the_figure_eight_is_linearly_stable_by_its_two_angles() {
    let case = preset("figure-eight", &[], &[]);
    let found = of(&case, Some(6.32591398292621168), Fixed::Energy(-1.28714199563185771));
    close(found.period, 6.32591398292621168, 1e-11);
    assert_eq!(found.multipliers.len(), 10);
    for angle in [0.00842272471, 0.298092529] {
        let angle = angle * std::f64::consts::TAU;
        let there = |z: &&[f64; 2]| (z[0] - angle.cos()).abs() + (z[1] - angle.sin()).abs() < 1e-7;
        let at = found.multipliers.iter().find(there).unwrap();
        close(found.rotation(*at).unwrap() * std::f64::consts::TAU, angle, 1e-7);
        close(found.exponent(*at).unwrap(), 0.0, 1e-8);
    }
    assert!(found.stable);
}

#[test]
fn a_limit_cycle_and_a_driven_orbit_close() {
    // van der Pol's, ε = 1: T = 6.6632868593231301896996820305
    let text = "title = \"t\"\n[coordinates]\nx = { initial = 2.1, momentum = 0 }\n\
                [hamiltonian]\nH = \"1/2*p_x^2 + 1/2*x^2\"\nforces = { x = \"(1 - x^2)*p_x\" }\n";
    let found = of(&file(text, &[]), None, Fixed::Nothing);
    close(found.period, 6.663_286_859_323_13, 1e-12);
    assert_eq!((found.trivial, found.stable), (Removed::Flow, true));
    // Liouville: the only other multiplier is exp ∫ (1 − x²) dt, the determinant
    close(found.multipliers[0][0], found.monodromy.determinant(), 1e-12);
    // the answer of an oscillator to a drive: x'' + 0.2 x' + x = cos 2t
    let text = "title = \"t\"\n[coordinates]\nx = { initial = 0, momentum = 0 }\n\
                [hamiltonian]\nH = \"1/2*p_x^2 + 1/2*x^2\"\nforces = { x = \"cos(2*t) - 0.2*p_x\" }\n";
    let case = file(text, &[]);
    let found = of(&case, Some(std::f64::consts::PI), Fixed::Nothing);
    let size = 9.0 + 0.16;
    close(found.state.values[0], -3.0 / size, 1e-13);
    close(found.state.values[1], 2.0 * 0.4 / size, 1e-13);
    assert_eq!(found.trivial, Removed::Nothing);
    let none = periodic_orbit(&case.space, taylor(), &case.start, None, Fixed::Nothing);
    assert!(matches!(none, Err(DynamicsError::Unsuited(why)) if why.contains("period")));
}

#[test]
fn where_nothing_returns_no_orbit_is_claimed() {
    let text = "title = \"t\"\n[coordinates]\nx = { initial = 1, momentum = 0 }\n\
                [hamiltonian]\nH = \"1/2*p_x^2 - 1/2*x^2\"\n";
    let case = file(text, &[]);
    for period in [None, Some(3.0)] {
        let found = periodic_orbit(&case.space, taylor(), &case.start, period, Fixed::Energy(-0.5));
        assert!(matches!(found, Err(DynamicsError::Unsuited(_) | DynamicsError::Motion(_))));
    }
}

/// In metres, seconds and kilogrammes of atoms and of galaxies the numbers are others and the orbit is the same.
#[test]
fn an_orbit_does_not_depend_on_units() {
    for (length, time, mass) in [(1e-10, 1e-15, 1e-30), (1e20, 1e15, 1e40), (1e-10, 1e6, 1.0)] {
        let text = format!(
            "title = \"t\"\n[coordinates]\nx = {{ initial = 0 }}\ny = {{ initial = {} }}\n\
             [parameters]\nm = {mass:e}\na = {length:e}\nb = {time:e}\n[hamiltonian]\n\
             H = \"1/2*(p_x^2 + p_y^2)/m + m/b^2*(1/2*(x^2 + y^2) + (x^2*y - y^3/3)/a)\"\n",
            -0.18 * length
        );
        let momentum = 0.46 * mass * length / time;
        let case = file(&text, &[0.0, -0.18 * length, momentum, 0.0]);
        let energy = mass * (length / time).powi(2);
        let found = of(&case, None, Fixed::Energy(0.125 * energy));
        close(found.period / time, 6.900_599_447_648_208_6, 1e-12);
        close(found.energy / energy, 0.125, 1e-14);
        close(found.transverse.trace(), 4.026_594_859_728_68, 1e-10);
        assert!(found.closure < 1e-13 && !found.stable, "{}", found.closure);
    }
}

/// A return is searched for as long as the motion takes, in any unit of time.
#[test]
fn an_orbit_is_found_in_any_unit_of_time() {
    let period = |unit: f64| {
        let text = format!(
            "title = \"slow\"\n[coordinates]\nq = {{ initial = 1.1 }}\n[lagrangian]\n\
             L = \"1/2*({unit:e}*q')^2 + cos(q)\"\n"
        );
        let case = file(&text, &[]);
        of(&case, None, Fixed::Energy(-(1.1_f64.cos()))).period / unit
    };
    let natural = period(1.0);
    for unit in [1e-60, 1e25, 1e60] {
        assert!((period(unit) / natural - 1.0).abs() < 1e-12, "{unit:e}");
    }
}

/// Along a resonance of tori a motion nearly closes everywhere: what misses itself by more than rounding is no orbit.
#[test]
fn what_nearly_closes_along_a_resonance_is_no_orbit() {
    let text = "title = \"t\"\n[coordinates]\nx = { initial = 0, momentum = 0.3 }\ny = { initial = 0.8, momentum = 0.01 }\n\
                [hamiltonian]\nH = \"1/2*(p_x^2 + p_y^2) + 1/4*(x^4 + y^4) + 0.3*x^2*y^2 + x^2/2 + y^2\"\n";
    let case = file(text, &[]);
    match periodic_orbit(&case.space, taylor(), &case.start, None, Fixed::Energy(2.0)) {
        Ok(found) => {
            assert!(found.closure < 1e-9 && (found.energy - 2.0).abs() < 1e-9, "{found:?}");
        }
        Err(error) => assert!(error.to_string().contains("misses itself"), "{error}"),
    }
}

/// Near a resonance of tori the motion misses itself by some 1e-5 wherever it begins, and the few orbits that do close (Poincaré,
/// Birkhoff) are found. Period and trace are those of an independent shooting (DOP853 at a tolerance of 1e-13, where the orbit
/// closes to 1e-14), and this orbit passes through the origin, as its images under the symmetries of H do.
#[test]
fn an_orbit_along_a_resonance_is_found() {
    let text = "title = \"t\"\n[coordinates]\nx = { initial = 0 }\ny = { initial = 0 }\n[hamiltonian]\n\
                H = \"1/2*(p_x^2 + p_y^2) + 1/4*(x^4 + y^4) + 0.3*x^2*y^2 + x^2/2 + y^2\"\n";
    let case = file(text, &[-0.2993, -0.2045, 0.7507, 1.1137]);
    let wanted = energy(&case);
    let found = of(&case, None, Fixed::Energy(wanted));
    close(found.period, 15.649_229_222_05, 1e-8);
    close(found.transverse.trace(), 1.999_851_835_467, 1e-8);
    close(found.energy, wanted, 1e-13);
    assert!(found.closure < 1e-13 && found.stable, "{}", found.closure);
}

/// The reason that a search for an orbit with a period gives.
fn refused(case: &Case, period: f64) -> String {
    match periodic_orbit(&case.space, taylor(), &case.start, Some(period), Fixed::Period(period)) {
        Ok(found) => panic!("{found:?}"),
        Err(error) => error.to_string(),
    }
}

/// Two oscillators that do not act on each other, whose frequencies are 1 and this.
fn two_oscillators(frequency: f64) -> Case {
    let text = format!(
        "title = \"t\"\n[coordinates]\nx = {{ initial = 1, momentum = 0 }}\ny = {{ initial = 0.5, momentum = 0.3 }}\n\
         [hamiltonian]\nH = \"1/2*(p_x^2 + p_y^2) + 1/2*x^2 + 1/2*({frequency:?})^2*y^2\"\n"
    );
    file(&text, &[1.0, 0.5, 0.0, 0.3])
}

/// No motion but rest has the period 2: what is said of the one from the start has its frequencies, in closed form.
#[test]
fn a_torus_that_is_not_closed_is_named_by_its_frequencies() {
    let golden = refused(&two_oscillators(f64::midpoint(1.0, 5.0_f64.sqrt())), 2.0);
    // 1/0.618… = 1.618…: either may come first
    let ratio = golden.contains("1.61803398") || golden.contains("0.61803398");
    assert!(ratio && golden.contains("lies on a torus that is not resonant"), "{golden}");
    // the convergents of the golden mean with numbers up to 12 end with 5 : 8
    assert!(golden.contains("5 : 8") || golden.contains("8 : 5"), "{golden}");
    let resonant = refused(&two_oscillators(1.5), 2.0);
    assert!(resonant.contains("lies on a resonant torus"), "{resonant}");
    assert!(resonant.contains("2 : 3") || resonant.contains("3 : 2"), "{resonant}");
    assert!(resonant.contains("closes after 12.5663706"), "{resonant}");
}

/// The rotation number 0.920604232837 and the frequency 0.991333945460 are those of 6312 crossings by another integrator
/// (heyoka, to t = 40000) and their weighted Birkhoff averages.
#[test]
fn a_torus_of_henon_and_heiles_and_chaos_are_told_apart_where_no_orbit_is_found() {
    let torus = refused(&preset("henon-heiles", &[], &[0.0, 0.1, 0.3, 0.1]), 4.0);
    for words in ["a torus that is not resonant", "0.991334 and", "12 : 11"] {
        assert!(torus.contains(words), "{words}: {torus}");
    }
    let (_, ratio) = torus.split_once("ratio to the first ").expect("a ratio");
    let (ratio, error) = ratio.split_once(" ± ").expect("its error");
    let (error, _) = error.split_once(',').expect("what it says");
    let [ratio, error] = [ratio, error].map(|number| number.parse::<f64>().expect("a number"));
    assert!((ratio - 0.920_604_232_837).abs() <= error && error < 2e-5, "{torus}");
    let chaos = refused(&preset("henon-heiles", &[], &[0.0, -0.1, 0.49, 0.27]), 4.0);
    assert!(chaos.contains("The motion from there is chaotic: "), "{chaos}");
    assert!(!chaos.contains("torus"), "{chaos}");
}

/// p_φ moves by rounding alone, which is no unit: the bob goes round, and does not rest.
#[test]
fn a_conserved_momentum_does_not_make_a_motion_rest() {
    let case = preset("spherical-pendulum", &[], &[]);
    match periodic_orbit(&case.space, taylor(), &case.start, None, Fixed::Energy(energy(&case))) {
        Ok(found) => {
            close(found.energy, energy(&case), 1e-8);
            assert!(found.closure < 1e-13 || !found.closes_to_rounding, "{}", found.closure);
        }
        Err(error) => assert!(!error.to_string().contains("equilibrium"), "{error}"),
    }
}

/// Beside r = 0 the angle is undefined and neighbours part without bound, although the motion along the vertical closes.
#[test]
fn an_orbit_through_a_singularity_of_its_law_has_no_multipliers() {
    let case = preset(
        "swinging-atwood",
        &[],
        &[
            0.748_464_070_645_990_5,
            3.141_592_653_589_793_6,
            -0.694_376_657_737_462_2,
            1.782_169_216_402_999_8e-16,
        ],
    );
    let (period, fixed) = (0.782_061_887_005_775, Fixed::Energy(energy(&case)));
    let found = periodic_orbit(&case.space, taylor(), &case.start, Some(period), fixed);
    let why = found.map(|orbit| orbit.multipliers).unwrap_err().to_string();
    assert!(why.contains("passes close to a singularity of its law"), "{why}");
    assert!(why.contains("r = ") && why.contains("e-"), "{why}");
    // Kepler's ellipses with less and less angular momentum, in Cartesian coordinates: all multipliers are 1, and what
    // rounding leaves of them grows as the pericentre shrinks
    let text = "title = \"t\"\n[coordinates]\nx = { initial = 1, momentum = 0 }\ny = { initial = 0, momentum = L }\n\
                [parameters]\nL = 1\n[hamiltonian]\nH = \"1/2*(p_x^2 + p_y^2) - 1/sqrt(x^2 + y^2)\"\n";
    let mut before = 0.0;
    for momentum in [0.9, 0.3, 0.1] {
        let text = text.replace("momentum = L", &format!("momentum = {momentum}"));
        let found = of(&file(&text, &[]), None, Fixed::Energy(0.5 * momentum * momentum - 1.0));
        let rounding = found.rounding.unwrap();
        let off = found.multipliers.iter().map(|z| (z[0] - 1.0).hypot(z[1]));
        assert!(rounding > 3.0 * before && rounding < 1e-3, "{momentum}: {rounding:e}");
        // a double root moves by the root of what moves the matrix
        assert!(off.fold(0.0, f64::max) < 10.0 * rounding.sqrt(), "{momentum}: {found:?}");
        before = rounding;
    }
}

/// From far inside, the first state that comes back near the start has gone round many times; the period is that of once.
#[test]
fn a_limit_cycle_that_was_followed_eleven_times_has_its_least_period() {
    for start in [0.3, 0.5] {
        let text = format!(
            "title = 't'\n[coordinates]\nx = {{ initial = {start} }}\n[lagrangian]\n\
             L = \"1/2*x'^2 - 1/2*x^2\"\nforces = {{ x = \"2*(1 - x^2)*x'\" }}\n"
        );
        let found = of(&file(&text, &[]), None, Fixed::Nothing);
        // T and μ by DOP853 at 1e-13
        close(found.period, 7.629_874_479_674, 1e-11);
        close(found.multipliers[0][0], 1.273_849e-8, 1e-12);
    }
}

/// The multiplier of van der Pol's limit cycle is exp ∮ μ(1 − x²) dt: at μ = 1 it has digits (the logarithm as well by DOP853), at μ = 5 it is e^−85.4, of which a matrix in `f64` knows none.
#[test]
fn a_multiplier_below_rounding_has_no_exponent() {
    for (strength, period, logarithm, known) in [
        (1.0, 6.663_286_859_323_130, -7.058_932_808_799, true),
        (5.0, 11.612_230_667_719_5, f64::NAN, false),
    ] {
        let text = format!(
            "title = 't'\n[coordinates]\nx = {{ initial = 2 }}\n[lagrangian]\n\
             L = \"1/2*x'^2 - 1/2*x^2\"\nforces = {{ x = \"{strength}*(1 - x^2)*x'\" }}\n"
        );
        let found = of(&file(&text, &[]), None, Fixed::Nothing);
        close(found.period, period, 1e-12);
        let [small] = found.multipliers[..] else { panic!("{:?}", found.multipliers) };
        assert_eq!(found.nearly_vanishes(small), !known, "{small:?} {:?}", found.rounding);
        match found.exponent(small) {
            Some(exponent) => close(exponent * period, logarithm, 1e-9),
            None => assert!(!known),
        }
    }
}

/// A multiplier just outside the unit circle is told from rounding: of Mathieu's equation x″ = −(1 + e cos 2t) x, |μ| = e^{±eT/4}
/// (L. D. Landau, E. M. Lifshitz, Mechanics, § 27); of an oscillator that is pushed along its velocity by c, e^{cT/2}; of van der Pol's cycle run
/// backwards, e^{cT}. With the other sign the last two are stable.
#[test]
fn a_multiplier_just_outside_the_circle_is_unstable() {
    use core::f64::consts::{PI, TAU};
    let judged = |law: &str, start: &str, period: Option<f64>, stability: &str, exponent: f64| {
        let text = format!("title = \"t\"\n[coordinates]\nx = {start}\n[lagrangian]\n{law}\n");
        let fixed = period.map_or(Fixed::Nothing, Fixed::Period);
        let found = of(&file(&text, &[]), period, fixed);
        assert_eq!(found.stability().word(), stability, "{law}: {found:?}");
        assert_eq!(found.is_stable(), Some(stability == "stable"), "{law}");
        let size = found.multipliers[0][0].hypot(found.multipliers[0][1]);
        let off = size.ln() / found.period - exponent;
        assert!(off.abs() < 1e-4 * exponent.abs(), "{law}: {size} {off:e}");
    };
    let rest = "{ initial = 0, velocity = 0 }";
    for size in [1e-7, 1e-9] {
        let mathieu = format!("L = \"1/2*x'^2 - 1/2*(1 + {size:e}*cos(2*t))*x^2\"");
        judged(&mathieu, rest, Some(PI), "unstable", size / 4.0);
        let turning = "L = \"1/2*x'^2 - 1/2*(1.3 + 0.1*cos(t))*x^2\"";
        for (sign, stability) in [(1.0, "unstable"), (-1.0, "stable")] {
            let c = sign * size;
            let pushed = format!("{turning}\nforces = {{ x = \"{c:e}*x' + 0*t\" }}");
            judged(&pushed, rest, Some(TAU), stability, c / 2.0);
            let cycle = "L = \"1/2*x'^2 - 1/2*x^2\"";
            let cycle = format!("{cycle}\nforces = {{ x = \"{:e}*(1 - x^2)*x'\" }}", -c);
            judged(&cycle, "{ initial = 2.001, velocity = 0 }", None, stability, c);
        }
    }
}
