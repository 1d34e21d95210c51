//! The picture of the action variable: closed forms, separatrices, what a slow and a fast change leave, and what has none.

use phaselab::action_angle::{FrozenSystem, NotFrozen};
use phaselab::cancel::Cancel;
use phaselab::diagnostic::Document;
use phaselab::experiment::Command;
use phaselab::instrument::{Ink, Layer};
use phaselab::integrate::Settings;
use std::f64::consts::PI;

use crate::course::Course;

#[track_caller]
fn near(found: f64, wanted: f64, within: f64) {
    assert!((found - wanted).abs() <= within, "{found} is not {wanted} within {within}");
}

const PENDULUM: &str = "title = \"Pendulum\"\n[coordinates]\n\
                        q = { initial = 2.0, velocity = \"v\", period = \"2*pi\" }\n[parameters]\nv = 0.0\n\
                        [lagrangian]\nL = \"1/2*q'^2 + cos(q)\"\n";

/// θ₀ = 2: J = 16 (E(k) − k′² K(k)), T = 4 K(k), k = sin 1; the separatrix has 16, a turn 8.
#[test]
fn the_pendulum_has_its_action_and_its_separatrix() {
    let mut course = Course::showing("actions", PENDULUM);
    course.go(0.3);
    near(course.value("action"), 10.039416280433402, 1e-12);
    near(course.value("period"), 8.349752926918494, 1e-12);
    near(course.value("separatrix"), 16.0, 1e-11);
    assert!(course.legend().contains("libration: J = 10.039"), "{}", course.legend());
    assert!(
        course.legend().contains("separatrix at E = 1: J = 16, 8 a turn"),
        "{}",
        course.legend()
    );
    // below the separatrix the curve climbs to 16, above it begins at 8
    let curves = course.curves();
    let [libration, rotation] = &curves[..] else { panic!("{}", curves.len()) };
    assert!(libration.iter().all(|at| at[0] < 1.0) && rotation.iter().all(|at| at[0] > 1.0));
    let (top, bottom) = (libration.last().unwrap()[1], rotation[0][1]);
    assert!(top < 16.0 && top > 15.9 && bottom > 8.0 && bottom < 8.05, "{top} {bottom}");
    // a motion that goes round has half
    let mut round = Course::showing("actions", &PENDULUM.replace("v = 0.0", "v = 3.0"));
    round.go(0.3);
    assert!(round.legend().contains("rotation: J = "), "{}", round.legend());
    assert!(round.value("action") > 8.0);
}

/// An angle without its period has wells without end, of which those far away are too narrow to be seen and are left out. The
/// others are at 2πk ± arccos(−E), of the period 2π/M(1, cos(θ₀/2)) by Gauss's arithmetic-geometric mean M.
#[test]
fn an_energy_has_the_wells_that_are_seen() {
    let text = "title = \"t\"\n[coordinates]\nq = { initial = 0.0, momentum = 0.0 }\n[hamiltonian]\nH = \"p_q^2/2 - cos(q)\"\n";
    let model = Document::new("t", text).read().unwrap_or_else(|_| panic!("{text}")).model;
    let settings = Settings { step: None, tolerance: None };
    let held =
        FrozenSystem::of(&model, 0, settings, &Cancel::new()).expect("it conserves its energy");
    let rows = held.at(0.0, &[], [&[0.0], &[0.0]]).expect("a state").rows(-0.9).expect("wells");
    assert!(rows.len() > 10, "{}", rows.len());
    let swing = 0.9_f64.acos();
    let mut means = [1.0, (swing / 2.0).cos()];
    for _ in 0..6 {
        means = [f64::midpoint(means[0], means[1]), (means[0] * means[1]).sqrt()];
    }
    for (row, k) in rows.iter().zip(-(rows.len() as i32 / 2)..) {
        let [left, right] = row.turning_points.map(|end| end.expect("it turns"));
        near(left, 2.0 * PI * f64::from(k) - swing, 1e-12);
        near(right, 2.0 * PI * f64::from(k) + swing, 1e-12);
        near(row.period, 2.0 * PI / means[0], 1e-10);
    }
}

#[test]
fn an_oscillator_has_a_straight_line() {
    let mut course = Course::showing(
        "actions",
        "title = \"t\"\n[coordinates]\nq = { initial = 1.0, momentum = 0.5 }\n[hamiltonian]\nH = \"p_q^2/2 + 2*q^2\"\n",
    );
    course.go(1.0);
    near(course.value("action"), PI * 2.125, 1e-12);
    let [line] = &course.curves()[..] else { panic!("one curve") };
    assert!(line.len() > 20);
    for [energy, action] in line {
        near(*action, PI * energy, 1e-12 * energy);
    }
    assert!(!course.legend().contains("separatrix"), "{}", course.legend());
}

/// An oscillator whose frequency is doubled in the time `T`.
fn tightened(duration: &str, way: &str) -> String {
    format!(
        "title = \"t\"\n[coordinates]\nq = {{ initial = 1.0, momentum = 0.0 }}\n[parameters]\nw = 1.0\n{way}\n\
         [hamiltonian]\nH = \"p_q^2/2 + 1/2*w^2*q^2\"\n"
    )
    .replace("DURATION", duration)
}

const RAMP: &str = "[[ramps]]\nparameter = \"w\"\nto = 2\nstart = 2\nduration = DURATION";

/// E doubles with ω, J stays; after a fast change it does not.
#[test]
fn a_slow_change_leaves_the_action_and_a_fast_one_does_not() {
    let mut slow = Course::showing("actions", &tightened("60", RAMP));
    for time in [0.0, 20.0, 40.0, 65.0] {
        slow.go(time);
    }
    near(slow.value("action"), PI, 1e-4);
    assert!(slow.value("change").abs() < 1e-4);
    // first of all, so that a low plot has it too
    assert!(slow.legend().starts_with("ΔJ/J = "), "{}", slow.legend());
    assert!(slow.legend().contains(": adiabatic"), "{}", slow.legend());
    // E beside J, where a low plot has room for it
    let second = slow.legend().lines().nth(1).map(str::to_owned).unwrap_or_default();
    assert!(second.contains("since t = 0: ΔE/(E − V₀) = +1"), "{}", slow.legend());
    // the curve is that of the law held at this instant, J = 2π E/ω with ω = 2
    let [line] = &slow.curves()[..] else { panic!("one curve") };
    for [energy, action] in line {
        near(*action, PI * energy, 1e-11 * energy);
    }
    let way = slow.layers().into_iter().find_map(|layer| match layer {
        Layer::Line(points, stroke) if stroke.ink == Ink::Warn => Some(points),
        _ => None,
    });
    let way = way.expect("the way of the motion");
    assert_eq!(way.len(), 4);
    near(way[3][0], 2.0 * way[0][0], 1e-4);
    near(way[3][1], way[0][1], 1e-4);
    // while hardly anything has changed, J and E swing alike, and neither word is true
    let mut begun = Course::showing("actions", &tightened("60", RAMP));
    begun.go(0.0);
    begun.go(4.0);
    assert!(begun.legend().contains(": undecided so far"), "{}", begun.legend());
    // nor is the other word true at any time of a slow ramp: J swings at its beginning, by the rate of ω
    for time in [9.0, 10.0, 11.5, 12.0, 14.0, 20.0, 35.0, 65.0] {
        begun.go(time);
        assert!(!begun.legend().contains("not adiabatic"), "at {time}: {}", begun.legend());
    }
    assert!(begun.legend().contains("adiabatic"), "{}", begun.legend());
    let mut fast = Course::showing("actions", &tightened("0.01", RAMP));
    fast.go(0.0);
    fast.go(5.0);
    // q and p stay: E = 2 at ω = 2 where the ramp began at cos² 2
    let energy = |w: f64| 0.5 * (2.0_f64.sin().powi(2) + (w * 2.0_f64.cos()).powi(2));
    near(fast.value("action"), PI * energy(2.0), 2e-2);
    assert!(fast.legend().contains(": not adiabatic"), "{}", fast.legend());
}

/// A parameter that enters by the initial values alone changes the motion at the reset, not before; the answer follows.
#[test]
fn a_reset_and_a_stroke_have_their_own_action() {
    let text = "title = \"t\"\n[coordinates]\nq = { initial = \"a\", momentum = 0.0 }\n[parameters]\na = 1.0\n\
                [hamiltonian]\nH = \"p_q^2/2 + 1/2*q^2\"\n\
                [[impulses]]\nname = \"stroke\"\nchange = { p_q = 1.0 }\n";
    let mut course = Course::showing("actions", text);
    course.go(3.0);
    near(course.value("action"), PI, 1e-12);
    course.experiment.execute(Command::Parameter { index: 0, value: 0.5 });
    course.go(4.0);
    near(course.value("action"), PI, 1e-12);
    course.experiment.execute(Command::Reset);
    course.go(5.0);
    near(course.value("action"), PI / 4.0, 1e-12);
    // J = 2π E, after p grows by one at t = 10
    course.go(10.0);
    course.experiment.execute(Command::ApplyImpulse(0));
    course.go(12.0);
    let energy = 0.5 * ((0.5 * 10.0_f64.cos()).powi(2) + (1.0 - 0.5 * 10.0_f64.sin()).powi(2));
    near(course.value("action"), 2.0 * PI * energy, 1e-12);
}

/// However late one looks for the first time, the change is that since the start.
#[test]
fn a_change_is_counted_from_the_start_however_late_one_looks() {
    let mut late = Course::showing("actions", &tightened("60", RAMP));
    late.go(65.0);
    assert!(late.legend().contains(": adiabatic"), "{}", late.legend());
    near(late.value("change"), 0.0, 1e-4);
    late.experiment.execute(Command::Reset);
    late.go(70.0);
    assert!(late.legend().contains(": adiabatic"), "{}", late.legend());
}

/// Beside an abyss a well has its curve up to its edge: V = ½q² − 0.075 q⁴ is highest at 5/6.
#[test]
fn a_well_beside_an_abyss_has_its_curve() {
    let course = {
        let text = "title = \"t\"\n[coordinates]\nq = { initial = 0.3, momentum = 0.8 }\n\
                    [hamiltonian]\nH = \"p_q^2/2 + 1/2*q^2 - 0.075*q^4\"\n";
        let mut course = Course::showing("actions", text);
        course.go(1.0);
        course
    };
    let curves = course.curves();
    assert!(!curves.is_empty(), "{}", course.legend());
    let highest =
        curves.iter().flatten().fold([0.0, 0.0], |a: [f64; 2], b| if b[1] > a[1] { *b } else { a });
    assert!((0.8..5.0 / 6.0).contains(&highest[0]), "{highest:?}");
    // there p = √0.15 (10/3 − q²)
    let lobe = 8.0 / 3.0 * 0.15_f64.sqrt() * (10.0_f64 / 3.0).powf(1.5);
    near(course.value("separatrix"), lobe, 1e-9);
    assert!(
        course.legend().contains("J = 6.2854") && !course.legend().contains("inf"),
        "{}",
        course.legend()
    );
}

#[test]
fn what_has_no_action_says_why() {
    let cases = [
        ("H = \"p_q^2/2 + q^2/2\"\nforces = { q = \"-p_q/10\" }", NotFrozen::EnergyNotConserved),
        (
            "H = \"p_q^2/2 + q^2/2\"\n[[impulses]]\nname = \"a\"\nevery = 2\nchange = { p_q = 1 }",
            NotFrozen::Impulses,
        ),
    ];
    for (law, why) in cases {
        let text = format!(
            "title = \"t\"\n[coordinates]\nq = {{ initial = 1.0 }}\n[hamiltonian]\n{law}\n"
        );
        let model = Document::new("t", &text).read().unwrap_or_else(|_| panic!("{text}")).model;
        let settings = Settings { step: None, tolerance: None };
        let found = FrozenSystem::of(&model, 0, settings, &Cancel::new()).err();
        assert_eq!(found, Some(why));
    }
    let mut course = Course::showing(
        "actions",
        "title = \"t\"\n[coordinates]\nq = { initial = 1.0 }\n[hamiltonian]\nH = \"p_q^2/2 + q^2/2\"\nforces = { q = \"-p_q/10\" }\n",
    );
    course.go(1.0);
    assert!(course.legend().contains("forces change the energy"), "{}", course.legend());
}

/// Of an oscillator w is the polar angle of (−ω q, p) over a whole turn, and grows by ω/2π.
#[test]
fn the_angle_of_an_oscillator_is_that_of_its_ellipse() {
    let mut course = Course::showing(
        "angle",
        "title = \"t\"\n[coordinates]\nq = { initial = 1.0, momentum = 0.5 }\n[hamiltonian]\nH = \"p_q^2/2 + 2*q^2\"\n",
    );
    let phase = 2.0_f64.atan2(0.5);
    for time in [0.0, 0.4, 1.1, 1.9, 2.6, 3.5] {
        course.go(time);
        // q = A sin(2t + φ), p = 2 A cos(2t + φ), tan φ = 2 q₀/p₀
        let (q, p) = (2.0 * time + phase).sin_cos();
        near(course.value("angle"), p.atan2(-q).rem_euclid(2.0 * PI) / (2.0 * PI), 1e-12);
        near(course.value("frequency"), 1.0 / PI, 1e-13);
        near(course.value("action"), PI * 2.125, 1e-12);
    }
    assert!(course.value("residual") < 1e-12);
}

/// From rest at 2 rad, on the right, w begins at ½ and grows by t/(4 K(sin 1)), through many turning points.
#[test]
fn the_angle_of_a_pendulum_grows_evenly() {
    let period = 8.349752926918494;
    let mut course = Course::showing("angle", PENDULUM);
    for i in 0..12 {
        let time = 2.37 * f64::from(i);
        course.go(time);
        let off = course.value("angle") - (0.5 + time / period);
        near(off - off.round(), 0.0, 1e-10);
    }
    assert!(course.value("residual") < 1e-10);
    assert!(course.legend().contains("ν = dE/dJ = 0.11976"), "{}", course.legend());
    let mut round = Course::showing("angle", &PENDULUM.replace("v = 0.0", "v = -3.0"));
    for i in 0..8 {
        round.go(1.21 * f64::from(i));
    }
    assert!(round.value("residual") < 1e-11, "{}", round.value("residual"));
    assert!(round.value("frequency") > 1.0 / period);
}

/// Of what separates the angle grows evenly, of what does not it does not, or has no action at all.
#[test]
fn the_angle_of_what_separates() {
    let isochrone = "title = \"t\"\n[coordinates]\nq = { initial = 1.0, momentum = 0.2 }\nphi = { initial = 0.3, momentum = 0.5 }\n\
                     [hamiltonian]\nH = \"p_q^2/2 + p_phi^2/(2*q^2) - 1/(1 + sqrt(1 + q^2))\"\n";
    let mut course = Course::showing("angle", isochrone);
    for i in 0..6 {
        course.go(5.3 * f64::from(i));
    }
    let energy = 0.02 + 0.125 - 1.0 / (1.0 + 2.0_f64.sqrt());
    near(course.value("frequency"), (-2.0 * energy).powf(1.5) / (2.0 * PI), 1e-12);
    assert!(course.value("residual") < 1e-10, "{}", course.value("residual"));
    let coupled = "title = \"t\"\n[coordinates]\nq = { initial = 0.3, momentum = 0.1 }\ny = { initial = 0.2, momentum = 0.1 }\n\
                   [hamiltonian]\nH = \"p_q^2/2 + p_y^2/2 + q^2/2 + y^2/2 + q^2*y - y^3/3\"\n";
    let mut course = Course::showing("angle", coupled);
    course.go(0.0);
    assert!(course.legend().contains("does not separate"), "{}", course.legend());
    // a law that depends on the time has the angle of the instant, and no line
    let mut slow = Course::showing("angle", &tightened("60", RAMP));
    for i in 0..4 {
        slow.go(2.5 * f64::from(i));
    }
    assert!(slow.legend().contains("depends on the time"), "{}", slow.legend());
    assert!(!slow.legend().contains("of a turn"), "{}", slow.legend());
}

/// A form that the whole of a time-dependent law has: the same motion by `[[ramps]]` and written out.
#[test]
fn a_law_with_the_time_in_it_is_frozen_at_the_instant() {
    let written = "[definitions]\nu = \"min(max((t - 2)/60, 0), 1)\"\nww = \"1 + 3*u^2 - 2*u^3\"";
    let by_hand = tightened("60", written).replace("1/2*w^2*q^2", "1/2*ww^2*q^2 + 0*w");
    let by_ramp = tightened("60", &format!("{RAMP}\nform = \"cubic\""));
    let mut both = [by_hand, by_ramp].map(|text| Course::showing("actions", &text));
    for course in &mut both {
        course.go(0.0);
        course.go(33.0);
    }
    let [a, b] = both.map(|course| course.value("action"));
    near(a, b, 1e-12);
    assert!((a - PI).abs() > 1e-9 && (a - PI).abs() < 0.1, "{a}");
}
