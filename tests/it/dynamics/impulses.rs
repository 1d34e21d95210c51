//! The derivative of a motion across impulses, against closed forms and differences of motions.

use nalgebra::DMatrix;
use phaselab::app::Loaded;
use phaselab::dynamics::{
    Chaos, DynamicsError, Fixed, FlowMap, PhaseSpace, driven_orbit, flow_map, gali, lyapunov,
    periodic_orbit,
};
use phaselab::integrate::{Propagator, Reached, Settings, method_named};
use phaselab::system::MotionErrorKind;

use super::{Case, method, taylor};
use crate::fixtures::{loaded, lowered};

/// A system with its phase space over impulses, at its initial state with other variables.
pub(super) fn case(loaded: &Loaded, start: &[f64]) -> Case {
    let parameters = loaded.model.parameter_values();
    let (model, equations) = (&loaded.model, &loaded.equations);
    let space = PhaseSpace::through_impulses((model, equations, &loaded.system), &parameters);
    let space = space.unwrap();
    let state = loaded.system.initial(model.run.start, &parameters, &[]).unwrap();
    let mut start = (space.state(&state).unwrap(), start);
    for (x, &y) in start.0.values.iter_mut().zip(start.1) {
        *x = y;
    }
    Case { space, start: start.0 }
}

pub(super) fn file(text: &str) -> Case {
    case(&lowered(text), &[])
}

fn map(case: &Case, until: f64) -> FlowMap {
    let found = flow_map(&case.space, taylor(), &case.start, until, &mut |_| {}).unwrap();
    assert_eq!(found.error, None);
    found
}

/// The variables at the end of a motion that begins displaced along one of them.
fn end_of(case: &Case, until: f64, i: usize, shift: f64) -> Vec<f64> {
    let (system, parameters) = (case.space.system(), case.space.parameters());
    let (method, settings) = taylor();
    let mut motion = Propagator::new(system, method, settings, parameters).unwrap();
    let mut start = case.start.clone();
    start.values[i] += shift;
    motion.begin(&start, parameters).unwrap();
    while motion.reach(until, until, &mut 1000).unwrap() != Reached::Arrived {}
    let state = motion.state().clone();
    case.space.variables(&case.space.state(&state).unwrap()).to_vec()
}

/// What happens on the way.
fn occurrences(case: &Case, until: f64) -> Vec<String> {
    let (system, parameters) = (case.space.system(), case.space.parameters());
    let (method, settings) = taylor();
    let mut motion = Propagator::new(system, method, settings, parameters).unwrap();
    motion.begin(&case.start, parameters).unwrap();
    let mut names = Vec::new();
    loop {
        match motion.reach(until, until, &mut 1000).unwrap() {
            Reached::Arrived => return names,
            Reached::Occurred(found) => names.push(found.name),
            Reached::OutOfBudget | Reached::Ended => {}
        }
    }
}

/// M by central differences of motions, extrapolated twice after Richardson.
fn by_differences(case: &Case, until: f64, width: f64) -> DMatrix<f64> {
    let n = case.space.dimension();
    let column = |i: usize, h: f64| -> Vec<f64> {
        let (above, below) = (end_of(case, until, i, h), end_of(case, until, i, -h));
        above.iter().zip(&below).map(|(a, b)| (a - b) / (2.0 * h)).collect()
    };
    let mut m = DMatrix::zeros(n, n);
    for i in 0..n {
        let [wide, middle, narrow] = [4.0, 2.0, 1.0].map(|part| column(i, part * width));
        for j in 0..n {
            let first = (4.0 * middle[j] - wide[j]) / 3.0;
            let second = (4.0 * narrow[j] - middle[j]) / 3.0;
            m[(j, i)] = (16.0 * second - first) / 15.0;
        }
    }
    m
}

/// A ball above the ground at y = 0, m = 2, g = 10, which keeps the part 0.8 of its velocity.
const BALL: &str = "title = \"t\"\n[coordinates]\ny = { initial = 1, velocity = 0.5 }\n\
    [lagrangian]\nL = \"y'^2 - 20*y\"\n\
    [[impulses]]\nname = \"bounce\"\nchange = { p_y = \"-3.6*y'\" }\n\
    [[events]]\nname = \"ground\"\nwhen = \"y\"\ndirection = \"falling\"\naction = \"impulse:bounce\"\n";

#[test]
fn a_bouncing_ball_has_the_derivative_of_its_closed_form() {
    // the ground at t₁ = (v + u)/g with u = √(v² + 2 g y); then y = e u τ − g τ²/2, τ = T − t₁
    let (e, g, m, y, v) = (0.8, 10.0, 2.0, 1.0, 0.5_f64);
    let u = (v * v + 2.0 * g * y).sqrt();
    let until = 1.0;
    let rest = until - (v + u) / g;
    // by y, and by v
    let found = map(&file(BALL), until);
    for (column, (du, dt)) in [(g / u, 1.0 / u), (v / u, (1.0 + v / u) / g)].into_iter().enumerate()
    {
        let unit = if column == 0 { 1.0 } else { 1.0 / m };
        let dy = e * du * rest - (e * u - g * rest) * dt;
        let dv = e * du + g * dt;
        let wanted = [dy * unit, m * dv * unit];
        for (row, wanted) in wanted.into_iter().enumerate() {
            let off = (found.matrix[(row, column)] - wanted).abs();
            assert!(off < 2e-14 * wanted.abs().max(1.0), "{row}, {column}: {off:e}");
        }
    }
    // each bounce shrinks areas by e²
    assert!((found.determinant.unwrap() - e * e).abs() < 1e-14, "{}", found.determinant.unwrap());
    assert!((found.determinant_expected.unwrap() - e * e).abs() < 1e-14);
    let three = map(&file(BALL), 2.2);
    assert!(
        (three.determinant.unwrap() - (e * e).powi(3)).abs() < 1e-13,
        "{}",
        three.determinant.unwrap()
    );
}

/// A point in an ellipse with semi-axes 2 and 1, which reflects it.
fn billiard(start: &[f64]) -> Case {
    let text = "title = \"t\"\n[coordinates]\nx = { initial = 0, momentum = 0 }\n\
        y = { initial = 0, momentum = 1 }\n\
        [hamiltonian]\nH = \"(p_x^2 + p_y^2)/2\"\n\
        [[impulses]]\nname = \"wall\"\n\
        change = { p_x = \"-2*(p_x*x/4 + p_y*y)/(x^2/16 + y^2)*x/4\", \
                   p_y = \"-2*(p_x*x/4 + p_y*y)/(x^2/16 + y^2)*y\" }\n\
        [[events]]\nname = \"edge\"\nwhen = \"x^2/4 + y^2 - 1\"\ndirection = \"rising\"\n\
        action = \"impulse:wall\"\n";
    case(&lowered(text), start)
}

#[test]
fn the_short_axis_of_an_elliptic_billiard_has_the_known_monodromy() {
    // to and fro over L = 2 between mirrors of radius R = a²/b = 4: the transverse part of M has
    // the trace (2 − 2 L/R)² − 2 (Kozlov & Treshchev, Billiards, 1991), the rest 2
    let found = map(&billiard(&[]), 4.0);
    assert!((found.matrix.trace() - 1.0).abs() < 1e-13, "{}", found.matrix.trace());
    assert!((found.determinant.unwrap() - 1.0).abs() < 1e-13);
    assert!(found.symplectic_residual.unwrap() < 1e-13);
    // the long axis: L = 4, R = b²/a = 1/2, and trace (2 − 16)² − 2 + 2
    let found = map(&billiard(&[0.0, 0.0, 1.0, 0.0]), 8.0);
    assert!((found.matrix.trace() - 196.0).abs() < 1e-10, "{}", found.matrix.trace());
}

#[test]
fn reflections_in_general_are_canonical_and_have_the_derivative_of_differences() {
    let case = billiard(&[0.3, -0.2, 0.8, 0.55]);
    let found = map(&case, 9.0);
    let size = found.matrix.amax();
    assert!(found.symplectic_residual.unwrap() < 1e-13 * size * size);
    assert!((found.determinant.unwrap() - 1.0).abs() < 1e-12 * size);
    let off = (&found.matrix - by_differences(&case, 9.0, 2e-4)).amax();
    assert!(off < 1e-9 * size, "{off:e} of {size}");
}

/// A double pendulum that hits a wall that moves, by an impulse that depends on all there is.
const WALL: &str = "title = \"t\"\n[coordinates]\na = { initial = 0.9, velocity = -0.4 }\n\
    b = { initial = 0.3, velocity = 0.5 }\n\
    [lagrangian]\nL = \"a'^2 + b'^2/2 + a'*b'*cos(a - b) + 2*cos(a) + cos(b) + a'*sin(t)/5\"\n\
    [[impulses]]\nname = \"push\"\n\
    change = { p_a = \"-1.7*(2*a' + b'*cos(a - b)) + sin(t)/5\", p_b = \"a*b/3 - cos(3*t)*b'/4\" }\n\
    [[impulses]]\nname = \"kick\"\nat = [0.25]\nchange = { p_b = \"sin(a)*b'/3\" }\n\
    [[events]]\nname = \"wall\"\nwhen = \"a - 0.3 - 0.1*sin(t) + b'/20\"\ndirection = \"falling\"\n\
    action = \"impulse:push\"\n";

#[test]
fn coupled_masses_moving_surfaces_and_impulses_that_depend_on_all_agree_with_differences() {
    let case = file(WALL);
    for until in [0.2, 0.6, 3.0] {
        let found = map(&case, until);
        let off = (&found.matrix - by_differences(&case, until, 1e-4)).amax();
        let size = found.matrix.amax();
        assert!(off < 1e-9 * size, "until {until}: {off:e} of {size}");
    }
    // the kick, and the wall twice
    assert_eq!(occurrences(&case, 3.0), ["kick", "wall", "wall"]);
}

#[test]
fn every_method_carries_vectors_through_the_same_impulses() {
    let case = file(WALL);
    let exact = map(&case, 1.5).matrix;
    for (name, step, within) in
        [("dop853", None, 1e-8), ("rk4", Some(1e-3), 1e-8), ("gauss6", Some(1e-2), 1e-8)]
    {
        let method = method(name, step);
        let found = flow_map(&case.space, method, &case.start, 1.5, &mut |_| {}).unwrap();
        assert_eq!(found.error, None, "{name}");
        let off = (&found.matrix - &exact).amax() / exact.amax();
        assert!(off < within, "{name}: {off:e}");
    }
}

#[test]
fn a_kicked_rotor_has_the_derivative_of_the_standard_map() {
    let case = case(&loaded("kicked-rotor", 1), &[]);
    let k = case.space.parameters()[1];
    let found = map(&case, 12.5);
    // drift over 1, then the kick; half a drift at the end
    let drift = |t: f64| DMatrix::from_row_slice(2, 2, &[1.0, t, 0.0, 1.0]);
    let (mut q, mut p) = (case.start.values[0], case.start.values[1]);
    let mut m = DMatrix::identity(2, 2);
    for _ in 0..12 {
        q += p;
        p += k * q.sin();
        m = DMatrix::from_row_slice(2, 2, &[1.0, 0.0, k * q.cos(), 1.0]) * drift(1.0) * m;
    }
    m = drift(0.5) * m;
    let off = (&found.matrix - &m).amax();
    assert!(off < 1e-12 * m.amax(), "{off:e} of {}", m.amax());
}

#[test]
fn linear_kicks_have_the_exponents_of_their_matrix() {
    let text = "title = \"t\"\n[coordinates]\nq = { initial = 1e-3, momentum = 0 }\n\
        [hamiltonian]\nH = \"p_q^2/2\"\n\
        [[impulses]]\nname = \"kick\"\nevery = 1\nchange = { p_q = \"q\" }\n";
    let case = file(text);
    let found = lyapunov(&case.space, taylor(), &case.start, 60.0, &mut |_| {}).unwrap();
    // the eigenvalues of [[1, 1], [1, 2]] are (3 ± √5)/2
    let exact = f64::midpoint(3.0, 5.0_f64.sqrt()).ln();
    assert_eq!(found.exponents.len(), 2);
    for (found, wanted) in found.exponents.iter().zip([exact, -exact]) {
        assert!((found - wanted).abs() < 0.01, "{found} is not {wanted}");
    }
}

/// An event is not lost where tangent vectors are made orthonormal: a stone thrown up lands, a ball bounces until it rests. What
/// ends so is not called regular.
#[test]
fn exponents_are_those_of_the_motion_with_its_events() {
    let landing = "title = \"t\"\n[coordinates]\ny = { initial = 0, velocity = 20 }\n[lagrangian]\n\
        L = \"y'^2/2 - 10*y\"\n[[events]]\nname = \"landing\"\nwhen = \"y\"\ndirection = \"falling\"\n\
        action = \"stop\"\n";
    // t₁ as above, and the sum of the times 2 eⁿ u/g of all further flights
    let (e, u) = (0.8, (0.5_f64 * 0.5 + 20.0).sqrt());
    let rests = (0.5 + u) / 10.0 + 2.0 * u / 10.0 * e / (1.0 - e);
    for (text, end, within) in [(landing, 4.0, 1e-12), (BALL, rests, 1e-3)] {
        let case = file(text);
        let found = lyapunov(&case.space, taylor(), &case.start, 50.0, &mut |_| {});
        let error = match found {
            Ok(found) => {
                assert_eq!(found.verdict, Chaos::Undecided, "{}", found.reason);
                found.error.unwrap_or_else(|| panic!("{text}\ngoes on to {}", found.time))
            }
            // the stone is followed in one step, which is too short for any exponent
            Err(error) => error,
        };
        let DynamicsError::Motion(error) = error else { panic!("{error}") };
        assert!((error.time - end).abs() < within, "{error} is not {end}");
    }
    let found = gali(&file(landing).space, taylor(), (&file(landing).start, 50.0), 2, &mut |_| {});
    assert!(found.unwrap().error.is_some());
}

/// For strong kicks λ ≈ ln(K/2) (B. V. Chirikov, Physics Reports 52, 263 (1979)); what the map itself has by 10⁷ kicks is
/// 1.6202 for K = 10 and 1.1364 for K = 6. A mean over 20,000 kicks is uncertain by about 0.006.
#[test]
fn the_standard_map_has_its_exponents_at_strong_kicks() {
    for (strength, exponent) in [("10", 1.6202), ("6", 1.1364)] {
        let text = format!(
            "title = \"t\"\n[coordinates]\nq = {{ initial = 0.5, momentum = 2.6, period = \"2*pi\" }}\n[hamiltonian]\n\
             H = \"p_q^2/2\"\n[[impulses]]\nname = \"kick\"\nevery = 1\nchange = {{ p_q = \"{strength}*sin(q)\" }}\n"
        );
        let case = file(&text);
        let found = lyapunov(&case.space, taylor(), &case.start, 20_000.5, &mut |_| {}).unwrap();
        let largest = found.exponents[0];
        assert!((largest - exponent).abs() < 0.025, "{strength}: {largest}");
        // areas are preserved
        assert!((largest + found.exponents[1]).abs() < 1e-9, "{:?}", found.exponents);
    }
}

fn error(text: &str, until: f64) -> MotionErrorKind {
    let case = file(text);
    let found = flow_map(&case.space, taylor(), &case.start, until, &mut |_| {}).unwrap();
    let Some(error) = found.error else {
        panic!(
            "{text}\nhas a derivative: {} with det {}",
            found.matrix,
            found.determinant_expected.unwrap()
        )
    };
    error.kind
}

const FREE: &str = "title = \"t\"\n[coordinates]\nx = { initial = -1, momentum = 1 }\n\
    y = { initial = -1, momentum = 1 }\n[hamiltonian]\nH = \"(p_x^2 + p_y^2)/2\"\n\
    [[impulses]]\nname = \"back\"\nchange = { p_x = \"-2*p_x\" }\n";

fn event(name: &str, when: &str, action: &str) -> String {
    format!("[[events]]\nname = \"{name}\"\nwhen = \"{when}\"\naction = \"{action}\"\n")
}

#[test]
fn what_has_no_derivative_is_said() {
    // along the tangent of the curve y = x + x³ at its point of inflection, which it crosses there
    let grazing = format!("{FREE}{}", event("touch", "y - x - x^3", "impulse:back"));
    assert_eq!(error(&grazing, 2.0), MotionErrorKind::Grazes("touch".to_owned()));
    // a corner: both walls at once
    let walls = [event("right", "x", "impulse:back"), event("top", "y", "impulse:back")].concat();
    let corner = error(&format!("{FREE}{walls}"), 2.0);
    assert!(matches!(corner, MotionErrorKind::Coincides(_)), "{corner:?}");
    let stop = format!("{FREE}{}", event("end", "x", "stop"));
    assert_eq!(error(&stop, 2.0), MotionErrorKind::Ended("end".to_owned()));
    // before it, all is well
    assert_eq!(map(&file(&stop), 0.9).matrix[(0, 2)], 0.9);
}

#[test]
fn what_is_not_computed_is_refused() {
    let text = format!("{FREE}{}", event("late", "action - 1", "impulse:back"));
    let case = file(&text);
    let refused = flow_map(&case.space, taylor(), &case.start, 2.0, &mut |_| {}).unwrap_err();
    assert!(refused.to_string().contains("depends on the action"), "{refused}");
    let case = file(BALL);
    let refused = flow_map(&case.space, taylor(), &case.start, -1.0, &mut |_| {}).unwrap_err();
    assert!(refused.to_string().contains("forwards only"), "{refused}");
    // questions that take the motion to be smooth still refuse impulses
    let loaded = lowered(BALL);
    let (model, equations) = (&loaded.model, &loaded.equations);
    let refused = PhaseSpace::of((model, equations, &loaded.system), &[]).unwrap_err();
    assert!(matches!(refused, DynamicsError::Unsuited(_)));
}

/// The strength of the kick of the shipped rotor, at which the golden torus breaks (J. M. Greene, J. Math. Phys. 20 (1979)
/// 1183).
const CRITICAL: f64 = 0.971635406;

/// A state at the time of an impulse is the one after it, as in a run.
#[test]
fn an_impulse_at_the_end_has_acted() {
    let rotor = case(&loaded("kicked-rotor", 1), &[0.5, 2.6]);
    for kicks in [1, 2, 5] {
        let found = map(&rotor, f64::from(kicks));
        assert_eq!(rotor.space.variables(&found.state), end_of(&rotor, f64::from(kicks), 0, 0.0));
    }
    let (angle, slope) = (0.5 + 2.6, CRITICAL * (0.5_f64 + 2.6).cos());
    let found = map(&rotor, 1.0);
    let variables = rotor.space.variables(&found.state);
    assert!((variables[0] - angle).abs() < 1e-14);
    assert!((variables[1] - (2.6 + CRITICAL * angle.sin())).abs() < 1e-14);
    let exact = DMatrix::from_row_slice(2, 2, &[1.0, 1.0, slope, 1.0 + slope]);
    assert!((found.matrix - exact).amax() < 1e-14);
}

/// The convergents of the golden mean, their momenta on the line θ = π, and their residues.
#[test]
fn the_residues_of_the_golden_torus_are_greenes() {
    let known = [
        (3.0, 5.0, 3.67, 0.24201467),
        (5.0, 8.0, 3.76, 0.25552013),
        (8.0, 13.0, 3.7307, 0.24660815),
        (13.0, 21.0, 3.7404, 0.25229897),
        (21.0, 34.0, 3.73722, 0.24872040),
        (34.0, 55.0, 3.73825, 0.25093749),
        (55.0, 89.0, 3.737916, 0.24956827),
    ];
    for (turns, kicks, momentum, residue) in known {
        let near = case(&loaded("kicked-rotor", 1), &[std::f64::consts::PI, momentum]);
        let fixed = Fixed::Period(kicks);
        let orbit = periodic_orbit(&near.space, taylor(), &near.start, Some(kicks), fixed);
        let orbit = orbit.unwrap();
        assert!((orbit.period - kicks).abs() < 1e-12 && orbit.stable);
        let found = (2.0 - orbit.monodromy.trace()) / 4.0;
        assert!((found - residue).abs() < 2e-8, "{turns}/{kicks}: {found}");
        let turned = map(&Case { space: near.space.clone(), start: orbit.state.clone() }, kicks);
        let angle = near.space.variables(&turned.state)[0] - near.space.variables(&orbit.state)[0];
        assert!((angle - std::f64::consts::TAU * turns).abs() < 1e-9, "{angle}");
    }
}

/// Impulses at equal intervals are a drive: without a period the orbit is looked for over theirs.
#[test]
fn an_orbit_is_closed_over_the_period_of_the_kicks() {
    let near = case(&loaded("kicked-rotor", 1), &[3.0, 6.2]);
    assert_eq!(near.space.drive(), Some(1.0));
    let orbit = driven_orbit(&near.space, taylor(), &near.start, 1.0).unwrap();
    assert_eq!(orbit.period, 1.0);
    let variables = near.space.variables(&orbit.state);
    // one turn from kick to kick, kicked where the kick vanishes
    let off = [variables[0] - std::f64::consts::PI, variables[1] - std::f64::consts::TAU];
    assert!(off.iter().all(|off| off.abs() < 1e-12), "{off:?}");
    assert!((orbit.monodromy.trace() - (2.0 - CRITICAL)).abs() < 1e-12);
    // single times are none, and two intervals have the period of both
    let text = |impulses: &str| {
        format!(
            "title = 'a test'\n[coordinates]\nx = {{ initial = 1.0 }}\n[lagrangian]\n\
             L = \"1/2*x'^2 - 1/2*x^2\"\n{impulses}"
        )
    };
    let kick = |when: &str, n: u32| {
        format!("[[impulses]]\nname = \"k{n}\"\n{when}\nchange = {{ p_x = \"0.1\" }}\n")
    };
    let once = file(&text(&kick("at = [1.0]", 1)));
    assert_eq!(once.space.drive(), None);
    let both = [kick("every = \"0.5\"", 1), kick("every = \"0.75\"", 2)].concat();
    assert!((file(&text(&both)).space.drive().unwrap() - 1.5).abs() < 1e-14);
}

/// Each kick halves the momentum: after hundreds of them the determinant is below the range of numbers, and its logarithm is not.
#[test]
fn exponents_over_hundreds_of_lossy_kicks_add_up_to_those_of_the_kicks() {
    let case = file(
        "title = \"Kicked\"\n[coordinates]\nx = { initial = 1, momentum = 0 }\n[hamiltonian]\nH = \"1/2*p_x^2 + 1/2*x^2\"\n\
         [[impulses]]\nname = \"kick\"\nevery = 0.05\nchange = { p_x = \"1/10 - p_x/2\" }\n",
    );
    for (name, step) in [("taylor", None), ("rk4", Some(0.01))] {
        let settings = Settings { step, tolerance: None };
        let by = (method_named(name).unwrap(), settings);
        let found = lyapunov(&case.space, by, &case.start, 100.0, &mut |_| {}).unwrap();
        assert!((found.sum + 2.0_f64.ln() / 0.05).abs() < 0.5, "{name}: {}", found.sum);
        assert!(!found.reason.contains("volume"), "{name}: {}", found.reason);
    }
}
