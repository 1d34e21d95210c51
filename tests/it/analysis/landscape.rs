//! Landscapes whose saddles and separatrices are known in closed form.

use phaselab::analysis::{Landscape, Plane};
use phaselab::system::Form;

use crate::fixtures::loaded;

/// The landscape of a preset with some parameters set, around a given range of the motion.
fn survey(name: &str, set: &[(&str, f64)], form: Form, motion: [[f64; 2]; 2]) -> Landscape {
    let loaded = loaded(name, 1);
    let mut parameters = loaded.model.parameter_values();
    for (name, value) in set {
        parameters[loaded.model.parameter(name).unwrap()] = *value;
    }
    let (system, parameters) = (&*loaded.system, &parameters[..]);
    let period = system.period(0, parameters);
    let plane = Plane { system, parameters, time: 0.0, form, period };
    Landscape::survey(&plane, motion, [motion[0][1], 0.0]).unwrap()
}

fn greatest(curves: &[Vec<[f64; 2]>], axis: usize) -> f64 {
    curves.iter().flatten().map(|point| point[axis].abs()).fold(0.0, f64::max)
}

#[test]
fn the_pendulum_turns_over_beyond_its_separatrix() {
    // The upright position is the saddle, and 2 m l √(g l) is the greatest momentum of the curve through it.
    let (m, l, g) = (1.5, 0.8, 9.81);
    let set = [("m", m), ("l", l), ("g", g)];
    for (form, top) in
        [(Form::Momentum, 2.0 * m * l * f64::sqrt(g * l)), (Form::Velocity, 2.0 * f64::sqrt(g / l))]
    {
        for amplitude in [1e-3, 0.3, 3.0] {
            let motion = [[-amplitude, amplitude], [-amplitude, amplitude]];
            let found = survey("pendulum", &set, form, motion);
            assert!(!found.saddles.is_empty());
            for [angle, rate] in &found.saddles {
                assert!((angle.abs() - std::f64::consts::PI).abs() < 1e-4, "{angle}");
                assert!(rate.abs() < 1e-3 * top, "{rate}");
            }
            let height = greatest(&found.separatrices, 1);
            assert!((height / top - 1.0).abs() < 2e-3, "{height} of {top}");
            let [x, y] = found.window;
            assert_eq!(x, [-std::f64::consts::PI, std::f64::consts::PI]);
            assert!(y[1] > top && y[1] < 2.0 * top, "the window {y:?} shows all of it");
        }
    }
}

#[test]
fn the_double_well_has_a_figure_of_eight() {
    // Through (0, 0), out to x = √(2a/b) and p = √(m/2b) a.
    let (m, a, b) = (1.0, 2.0, 0.5);
    let set = [("m", m), ("a", a), ("b", b)];
    let well = f64::sqrt(a / b);
    for motion in [[[0.9 * well, 1.1 * well], [-0.2, 0.2]], [[-4.0, 4.0], [-3.0, 3.0]]] {
        let found = survey("double-well", &set, Form::Momentum, motion);
        assert_eq!(found.saddles.len(), 1);
        assert!(found.saddles[0].iter().all(|v| v.abs() < 1e-3), "{:?}", found.saddles);
        let (wide, high) = (greatest(&found.separatrices, 0), greatest(&found.separatrices, 1));
        assert!((wide / f64::sqrt(2.0 * a / b) - 1.0).abs() < 5e-3, "{wide}");
        assert!((high / (f64::sqrt(m / (2.0 * b)) * a) - 1.0).abs() < 5e-3, "{high}");
    }
}

#[test]
fn an_oscillator_has_ellipses_and_no_separatrix() {
    let found = survey("harmonic-oscillator", &[], Form::Momentum, [[-1.0, 1.0], [-1.0, 1.0]]);
    assert!(found.saddles.is_empty() && found.separatrices.is_empty());
    let closed = found.levels.iter().flatten().filter(|curve| curve.first() == curve.last());
    assert!(closed.count() >= 4, "{} curves", found.levels.len());
}

/// Equal weights rest at every height: the whole line p = 0 consists of equilibria, and none of them is a saddle.
#[test]
fn a_line_of_equilibria_has_no_saddles() {
    for speed in [0.3, 0.5, 1.0] {
        let motion = [[0.5, 2.0], [-2.0 * speed, 0.0]];
        let found = survey("atwood", &[("m1", 1.0)], Form::Momentum, motion);
        assert!(found.saddles.is_empty(), "{speed}: {:?}", found.saddles);
        assert!(found.separatrices.is_empty(), "{speed}");
    }
}

/// A start is enough for a window that shows all of the orbit: the turning point x₀ and the greatest momentum √(m k) x₀.
#[test]
fn the_first_window_contains_a_bounded_orbit() {
    for (m, k, start) in [(1.0, 4.0, 3.0), (2.0, 9.0, 1e-3), (0.5, 2.0, 40.0)] {
        let set = [("m", m), ("k", k)];
        let fastest = f64::sqrt(m * k) * start;
        let here = [[start, start], [0.0, 0.0]];
        let window = survey("harmonic-oscillator", &set, Form::Momentum, here).window;
        for (axis, most) in [(0, start), (1, fastest)] {
            let [from, to] = window[axis];
            assert!(from <= -most && most <= to, "{axis}: {window:?} without {most}");
            assert!(to - from < 3.0 * most, "{axis}: {window:?} around {most}");
        }
        // and it stays when the motion has been all along it
        let whole = [[-start, start], [-fastest, fastest]];
        let later = survey("harmonic-oscillator", &set, Form::Momentum, whole).window;
        for (first, later) in window.as_flattened().iter().zip(later.as_flattened()) {
            assert!((first / later - 1.0).abs() < 0.02, "{window:?}, then {later}");
        }
    }
}

/// A body that falls comes back to no height: the window is that of the motion, with the little that is added around any.
#[test]
fn an_unbounded_orbit_leaves_the_window_to_the_motion() {
    let motion = [[-50.0, 19.0], [-30.0, 19.0]];
    let window = survey("falling-body", &[], Form::Momentum, motion).window;
    for axis in 0..2 {
        let [[from, to], [low, high]] = [window[axis], motion[axis]];
        assert!(from < low && to > high, "{window:?}");
        assert!(to - from < 1.5 * (high - low), "{window:?}");
    }
}

#[test]
fn where_nothing_is_finite_there_is_no_landscape() {
    let loaded = loaded("pendulum", 1);
    let parameters = vec![f64::NAN; loaded.model.parameters.len()];
    let system = &*loaded.system;
    let plane =
        Plane { system, parameters: &parameters, time: 0.0, form: Form::Momentum, period: None };
    assert!(Landscape::survey(&plane, [[-1.0, 1.0], [-1.0, 1.0]], [1.0, 0.0]).is_none());
    let plane = Plane { parameters: &loaded.model.parameter_values(), ..plane };
    assert!(Landscape::survey(&plane, [[f64::NAN, 1.0], [0.0, 1.0]], [1.0, 0.0]).is_none());
}

/// A rate of which even a little more is no number has no region around it to be searched.
#[test]
fn a_motion_at_the_end_of_the_numbers_has_an_end_to_its_search() {
    let loaded = loaded("pendulum", 1);
    let parameters = loaded.model.parameter_values();
    let system = &*loaded.system;
    for form in [Form::Momentum, Form::Velocity] {
        let period = Some(std::f64::consts::TAU);
        let plane = Plane { system, parameters: &parameters, time: 0.0, form, period };
        for far in [1e300, 1.5e308] {
            let found = Landscape::survey(&plane, [[-1.0, 1.0], [-far, far]], [1.0, far]);
            assert!(found.is_none_or(|found| found.window[1][1] >= far), "{far}");
        }
    }
}
