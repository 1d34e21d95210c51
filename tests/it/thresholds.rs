//! Thresholds, tested by their decisions: a case just inside and one just outside.

use std::fmt::Write as _;

use phaselab::analysis::{Errors, History, Verdict};
use phaselab::diagnostic::Document;
use phaselab::experiment::{Checkpoint, Command, Gauge};
use phaselab::integrate::{METHODS, Settings};
use phaselab::mechanics::{Class, class_of, derive};
use phaselab::system::System;

use crate::cli::with_file;
use crate::experiment::{build, gauge, run};
use crate::taylor::Run;

/// The number of redundant constraints, of two in the plane whose directions differ by this angle.
fn redundant(angle: &str) -> usize {
    let mut text = "title = \"Two rails\"\n[coordinates]\n".to_owned();
    for name in ["x", "y"] {
        let _ = writeln!(text, "{name} = {{ initial = 0 }}");
    }
    let _ = writeln!(
        text,
        "[lagrangian]\nL = \"1/2*(x'^2 + y'^2)\"\n\
         [[constraints]]\nname = \"one\"\nexpression = \"x + y\"\n\
         [[constraints]]\nname = \"other\"\nexpression = \"x + y + {angle}*(x - y)\"\n\
         [run]\nuntil = 1"
    );
    let model = Document::new("rails.toml", text).read().unwrap().model;
    let equations = derive(&model).unwrap();
    let system = System::compile(&model, &equations, &[]).unwrap();
    system.redundant().len()
}

#[test]
fn rows_are_independent_beyond_a_billionth() {
    assert_eq!(redundant("0.0000000015"), 0);
    assert_eq!(redundant("0.0000000007"), 1);
}

/// The verdict on a signal from 0 to 1, of which 64 intervals are kept, where `floor` is explained by rounding.
fn verdict(floor: f64, signal: impl Fn(f64) -> f64) -> &'static str {
    let mut history = History::new();
    let count = 8192_u32;
    for k in 0..=count {
        let time = f64::from(k) / f64::from(count);
        history.push(time, signal(time));
    }
    Verdict::of(&history, 0.0, floor, Errors::Accumulated).word()
}

/// An oscillation of amplitude 1 from peak to peak, of four samples.
fn oscillation(time: f64) -> f64 {
    if (time * 8192.0).round() % 4.0 < 2.0 { 0.5 } else { -0.5 }
}

/// Asserts that the signal with the first number is bounded, and with the second secular.
fn turns(floor: f64, numbers: [f64; 2], signal: impl Fn(f64, f64) -> f64) {
    says(["bounded", "secular"], floor, numbers, signal);
}

/// Asserts what is said of the signal with each number.
fn says(words: [&str; 2], floor: f64, numbers: [f64; 2], signal: impl Fn(f64, f64) -> f64) {
    let verdicts = numbers.map(|number| verdict(floor, |time| signal(number, time)));
    assert_eq!(verdicts, words, "{numbers:?}");
}

/// A share of time spent above that grows: the mean inclines, and the extremes do not.
#[test]
fn what_inclines_by_a_tenth_of_its_swing_is_open() {
    says(["bounded", "open"], 1e-9, [0.09, 0.11], |rise, time| {
        let above = 256.0 * (0.3 + rise * time);
        if (time * 8192.0).round() % 256.0 < above { 0.5 } else { -0.5 }
    });
}

/// Levels of the eighths that no line has, ±a, leave a standard error of a √(8/(6·42)) for the slope of the rest.
#[test]
fn what_inclines_by_four_and_a_half_standard_errors_is_open() {
    let error = 0.05 * (8.0 / (6.0 * 42.0_f64)).sqrt();
    says(["bounded", "open"], 1e-9, [4.3, 4.7], |errors, time| {
        let eighth = (time * 8.0).floor().min(7.0);
        let level = [1.0, -1.0, -1.0, 1.0, 1.0, -1.0, -1.0, 1.0][eighth as usize];
        oscillation(time) + 0.05 * level + errors * error * eighth
    });
}

#[test]
fn a_level_is_left_by_more_than_one_and_a_fifth_of_the_swing() {
    turns(1e-9, [1.15, 1.25], |jump, time| oscillation(time) + if time < 0.5 { 0.0 } else { jump });
}

#[test]
fn a_level_is_left_by_eight_times_the_rounding() {
    turns(1.0, [7.5, 8.5], |jump, time| if time < 0.5 { 0.0 } else { jump });
}

/// Where an error is a function of the state nothing is said before it has come back by half: a peak in the middle of the
/// way, of which this part is left at the end.
#[test]
fn a_function_of_the_state_is_open_until_it_has_returned_by_half() {
    let word = |back: f64| {
        let mut history = History::new();
        for k in 0..=8192_u32 {
            let time = f64::from(k) / 8192.0;
            history
                .push(time, if time < 0.5 { 2.0 * time } else { 1.0 - back * (2.0 * time - 1.0) });
        }
        Verdict::of(&history, 0.0, 1e-9, Errors::OfState).word()
    };
    assert_eq!(word(0.45), "open");
    assert_eq!(word(0.55), "bounded");
}

/// A staircase never comes back, but its rest beside a line does: there and back once for each step.
#[test]
fn a_staircase_of_a_state_is_a_trend_from_seven_steps_on() {
    let word = |steps: f64| {
        let mut history = History::new();
        for k in 0..=8192_u32 {
            let time = f64::from(k) / 8192.0;
            let phase = std::f64::consts::TAU * steps * time;
            history.push(time, phase - phase.sin());
        }
        Verdict::of(&history, 0.0, 1e-9, Errors::OfState).word()
    };
    assert_eq!(word(6.0), "open");
    assert_eq!(word(8.0), "secular");
}

/// Where errors accumulate it must have come back more often: three peaks and a part of the fourth make a way of seven
/// times the swing.
#[test]
fn an_accumulated_error_is_open_until_it_has_returned_three_times() {
    let peaks = |count: f64| verdict(1e-9, |time| 1.0 - 2.0 * ((count * time).fract() - 0.5).abs());
    assert_eq!(peaks(3.3), "open");
    assert_eq!(peaks(3.7), "bounded");
    // what rounding explains needs no more looks
    assert_eq!(verdict(0.2, |time| 1.0 - 2.0 * (time - 0.5).abs()), "bounded");
    assert_eq!(verdict(0.1, |time| 1.0 - 2.0 * (time - 0.5).abs()), "open");
}

#[test]
fn a_trend_is_a_hundredth_of_the_swing() {
    // between the means of the first and the last quarter lie three quarters of the time
    turns(1e-9, [0.009, 0.012], |rise, time| oscillation(time) + rise * time / 0.75);
}

#[test]
fn extremes_rise_with_a_trend_by_a_fifth_of_it() {
    // the rest of the rise is that of the share of time spent above
    says(["open", "secular"], 1e-9, [0.17, 0.23], |along, time| {
        let above = 64.0 * (0.4 + 0.25 * time * (1.0 - along));
        let wave = if (time * 8192.0).round() % 64.0 < above { 0.5 } else { -0.5 };
        wave + 0.25 * along * time
    });
}

#[test]
fn every_part_of_a_trend_has_a_third_of_its_share() {
    // between the second and the third of five parts the rise has this slope, elsewhere 1: 2 s/(1 + s) of an even one
    says(["open", "secular"], 1e-9, [0.19, 0.23], |slope, time| {
        let slow = time.clamp(0.2, 0.6) - 0.2;
        oscillation(time) + 0.5 * (time - slow + slope * slow)
    });
}

#[test]
fn a_trend_is_clear_of_six_standard_errors() {
    // the means of neighbouring intervals differ by 1, a quarter has 16 of them
    let error = 0.5 / 16.0_f64.sqrt();
    says(["open", "secular"], 1e-9, [5.4, 6.3], |errors, time| {
        let scatter = if (time * 64.0).floor() % 2.0 == 0.0 { 0.5 } else { -0.5 };
        scatter + errors * error * time / 0.75
    });
}

/// An oscillator from x = 0.3 with x' = 0.2, and what else the file has.
fn oscillator(rest: &str) -> String {
    format!(
        "title = \"An oscillator\"\n[coordinates]\nx = {{ initial = 0.3, velocity = 0.2 }}\n[lagrangian]\n\
         L = \"1/2*x'^2 - 1/2*x^2\"\n{rest}\n[run]\nuntil = 1\n"
    )
}

/// Asserts that `check` accepts the file with the first number and refuses it, with these words, with the second.
fn claimed([within, beyond]: [&str; 2], said: &str, text: impl Fn(&str) -> String) {
    with_file(&text(within), &["check", "system.toml"]).success();
    with_file(&text(beyond), &["check", "system.toml"]).fails(65, &[said]);
}

/// It jumps, and its rate vanishes before and after. Its terms are 1 and ½.
#[test]
fn what_is_claimed_conserved_drifts_by_no_more_than_1e_10_of_its_terms() {
    claimed(["1.4e-10", "1.6e-10"], "claimed to be conserved, but it is not", |drift| {
        oscillator(&format!(
            "[[observables]]\nname = \"one\"\nexpression = \"1 + {drift}/2*sign(t - 1/2) + 1/2*sign(x^2 + 10)\"\n\
             conserved = true"
        ))
    });
}

#[test]
fn a_claimed_bracket_is_off_by_no_more_than_1e_10_of_its_terms() {
    // the two sides are terms of one size
    claimed(["1.9e-10", "2.1e-10"], "is not what this says", |off| {
        oscillator(&format!(
            "[expect]\nbrackets = [{{ f = \"sqrt(2 + cos(x))\", g = \"p_x\", is = \"-1/2*sin(x)*sqrt(2 - cos(x))/sqrt(4 - cos(x)^2)*(1 + {off})\" }}]"
        ))
    });
}

/// Four hundred points are tried near the start, from x = 0.15 to 0.45: where the claim has a value at 25 of them it is held to
/// be seen, at 15 it is not.
#[test]
fn what_is_checked_by_values_is_seen_at_some_twenty_points() {
    claimed(["0.4330", "0.4390"], "cannot be checked: it has no value near the start", |from| {
        let zero = format!("ln(sqrt(x - {from})) - 1/2*ln(x - {from})");
        oscillator(&format!(
            "[expect]\nbrackets = [{{ f = \"sin(x)\", g = \"p_x\", is = \"cos(x) + {zero}\" }}]"
        ))
    });
}

#[test]
fn a_casimir_commutes_to_1e_10_of_its_terms() {
    claimed(["1.9e-10", "2.1e-10"], "is not a Casimir", |off| {
        format!(
            "title = \"A body\"\n[variables]\nL1 = {{ initial = 1 }}\nL2 = {{ initial = 2 }}\nL3 = {{ initial = 3 }}\n\
             [poisson]\nH = \"L1^2/2 + L2^2/3 + L3^2/5\"\n\
             brackets = [[\"L1\", \"L2\", \"-L3\"], [\"L2\", \"L3\", \"-L1\"], [\"L3\", \"L1\", \"-L2\"]]\n\
             casimirs = {{ C = \"L1^2 + L2^2 + (1 + {off})*L3^2\" }}\n"
        )
    });
}

/// Near the start these commute with everything to the last digit, and ten starts away they do not.
#[test]
fn what_commutes_near_the_start_alone_is_no_casimir() {
    for added in ["max(0, x - 30)", "exp(-(x - 50)^2)"] {
        let text = format!(
            "title = \"A plane\"\n[variables]\nx = {{ initial = 0 }}\np = {{ initial = 1 }}\nz = {{ initial = 1 }}\n\
             [poisson]\nH = \"p^2/2\"\nbrackets = [[\"x\", \"p\", \"1\"]]\ncasimirs = {{ C = \"z + {added}\" }}\n"
        );
        with_file(&text, &["check", "system.toml"])
            .fails(65, &["`C` is not a Casimir of these brackets"]);
    }
    let map = oscillator(
        "[[transformations]]\nname = \"m\"\nkind = \"explicit\"\nQ = { Q = \"x + max(0, x - 30)*p_x\" }\n\
         P = { P = \"p_x - max(0, x - 30)\" }",
    );
    let text = with_file(&map, &["derive", "system.toml"]).success();
    assert!(text.contains("not canonical"), "{text}");
}

#[test]
fn a_complete_integral_solves_its_equation_to_1e_10_of_its_terms() {
    // H and α count three times in what is left, not once
    claimed(["3e-10", "3.5e-10"], "does not solve", |off| {
        oscillator(&format!(
            "[hamilton_jacobi]\nS = \"1/2*x*sqrt(2*alpha - x^2) + alpha*asin(x/sqrt(2*alpha)) - alpha*t*(1 + {off})\"\n\
             constants = [\"alpha\"]"
        ))
    });
}

#[test]
fn a_start_is_on_its_constraints_to_1e_9_of_their_terms() {
    claimed(["1.9e-9", "2.1e-9"], "do not keep the constraint `c`", |off| {
        format!(
            "title = \"Two\"\n[coordinates]\nx = {{ initial = 1, velocity = 0 }}\n\
             y = {{ initial = \"1 + {off}\", velocity = 0 }}\n[lagrangian]\nL = \"1/2*x'^2 + 1/2*y'^2\"\n\
             [[constraints]]\nname = \"c\"\nexpression = \"x - y\"\n[run]\nuntil = 1\n"
        )
    });
}

/// What the motion shows of a rate that no point near the start has, since it begins at t = ½. The constant keeps the drift
/// within its own limit.
#[test]
fn a_rate_along_a_motion_vanishes_to_1e_9_of_its_terms() {
    claimed(["0.9e-9", "1.1e-9"], "claimed to be conserved, but it is not", |off| {
        oscillator(&format!(
            "[[observables]]\nname = \"G\"\nconserved = true\n\
             expression = \"100 + (sqrt(1 - sin(x)^2) - (1 + {off})*cos(x))*max(0, t - 0.5)\""
        ))
    });
}

/// A rate on constraints is classified by its values; each of the numbers in its two terms may be off by 1e-10.
#[test]
fn a_rate_on_constraints_vanishes_to_some_1e_10_of_its_terms() {
    let class = |off: &str| {
        let text = format!(
            "title = \"Two\"\n[coordinates]\nx = {{ initial = 0.5, velocity = 0.3 }}\n\
             y = {{ initial = 0.5, velocity = 0.3 }}\n[lagrangian]\nL = \"1/2*x'^2 + 1/2*y'^2\"\n\
             [[constraints]]\nname = \"c\"\nexpression = \"x - y\"\n[[observables]]\n\
             name = \"G\"\nexpression = \"sin(x) - (1 + {off})*sin(y)\"\n"
        );
        let model = Document::new("two.toml", text).read().unwrap().model;
        let mut equations = derive(&model).unwrap();
        class_of(&model, &mut equations, "G", model.observables[0].expression).class
    };
    assert_eq!(class("2e-10"), Class::Numerically);
    assert_eq!(class("2e-9"), Class::Changing);
}

/// A state that is off its constraint by more is not restored: the coordinates beside it are taken.
#[test]
fn a_state_is_restored_within_some_1e_9_of_the_terms_of_its_constraints() {
    let text = "title = \"Two\"\n[coordinates]\nx = { initial = 1, velocity = 0 }\n\
                y = { initial = 1, velocity = 0 }\n[lagrangian]\nL = \"1/2*x'^2 + 1/2*y'^2\"\n\
                [[constraints]]\nname = \"c\"\nexpression = \"x - y\"\n";
    for (off, restored) in [(0.5e-9, true), (6e-9, false)] {
        let mut experiment = build(text, |_| ());
        run(&mut experiment, 0.5);
        let seen = experiment.snapshot();
        let mut moment = Checkpoint::of(experiment.model(), experiment.system(), &seen);
        moment.present.as_mut().unwrap().state[0] = [1.0 + off, 0.0];
        experiment.execute(Command::Restore(Box::new(moment)));
        let x = experiment.snapshot().state.values[0];
        assert_eq!(x == 1.0 + off, restored, "off by {off:e}: {x}");
    }
}

#[test]
fn a_map_is_canonical_to_a_residual_of_1e_10() {
    let derived = |off: &str| {
        let text = oscillator(&format!(
            "[[transformations]]\nname = \"m\"\nkind = \"explicit\"\nQ = {{ Q = \"x*(1 + {off})\" }}\nP = {{ P = \"p_x\" }}"
        ));
        with_file(&text, &["derive", "system.toml"]).success()
    };
    assert!(derived("0.9e-10").contains("canonical to rounding"));
    assert!(derived("1.1e-10").contains("not canonical"));
}

/// The error of rk4 in an energy of ½ beside a constant: where the value has three digits fewer than the sum of its other
/// terms, the drift is that of the sum, else it drowns in the rounding of the value.
#[test]
fn a_constant_is_left_out_of_a_drift_from_a_thousand_times_what_varies() {
    let word = |constant: u32| {
        let text = format!(
            "title = \"An offset\"\n[coordinates]\nx = {{ initial = 1 }}\n[lagrangian]\n\
             L = \"1/2*x'^2 - 1/2*x^2 - {constant}\"\n"
        );
        let mut experiment = build(&text, |setup| {
            "rk4".clone_into(&mut setup.method);
            setup.settings.step = Some(0.01);
        });
        run(&mut experiment, 10.0);
        gauge(&experiment.snapshot(), "energy").verdict.word()
    };
    assert_eq!(word(0), "secular");
    assert_eq!(word(490), "exact");
    assert_eq!(word(510), "secular");
}

/// The step that rk4 chooses for the motion of a file.
fn step_of_rk4(text: &str) -> f64 {
    let rk4 = METHODS.iter().find(|method| method.name == "rk4").expect("a method");
    let Run { system, parameters, .. } = Run::new(text);
    let state = system.initial(0.0, &parameters, &[]).expect("regular");
    let settings = Settings { step: None, tolerance: None };
    let mut stepper = (rk4.make)(&system, &settings).expect("it fits every system");
    stepper.start(&state, &parameters).expect("regular");
    stepper.step(f64::INFINITY).expect("regular");
    stepper.step_size()
}

/// A motion's own time is the same part of its period in all units of length and time, from rest and from the middle.
#[test]
fn a_time_scale_goes_with_the_units() {
    let step = |rate: f64, size: f64, from_rest: bool| {
        let (at, velocity) = if from_rest { (size, 0.0) } else { (0.0, 1.2 * rate * size) };
        step_of_rk4(&format!(
            "title = \"An oscillator\"\n[coordinates]\nx = {{ initial = {at:e}, velocity = {velocity:e} }}\n\
             [parameters]\nw = {rate:e}\nl = {size:e}\n[lagrangian]\n\
             L = \"1/2*(x'/l)^2 - 1/2*w^2*((x/l)^2 + (x/l)^4/4)\"\n"
        ))
    };
    for from_rest in [true, false] {
        let whole = step(1.0, 1.0, from_rest);
        assert!(0.01 < whole && whole < 0.3, "{whole}");
        for (rate, size) in [(1e-60, 1.0), (1e-9, 1e18), (1e9, 1e-18), (1e60, 1e30)] {
            let part = rate * step(rate, size, from_rest) / whole;
            assert!((part - 1.0).abs() < 1e-6, "{rate:e} {size:e}: {part}");
        }
    }
}

/// A motion's own time is that which three in four of 48 steps exceed: where a quarter of them lie behind a switch to fifty
/// times the frequency, it is that of the fast motion.
#[test]
fn a_time_scale_is_that_of_forty_eight_steps() {
    let text = |switch: f64| {
        format!(
            "title = \"Two rates\"\n[coordinates]\nx = {{ initial = 1 }}\n[lagrangian]\n\
             L = \"1/2*x'^2 - (1/2 + 1250*(1 + sign(t - {switch:?})))*x^2\"\n"
        )
    };
    // when the steps end at the tolerance at which they are looked at
    let mut slow = Run::with(&text(1e6), Some(1e-9));
    let ends: Vec<f64> = (0..48)
        .map(|_| {
            slow.stepper.step(1e5).unwrap();
            slow.stepper.time()
        })
        .collect();
    let step = |switch: f64| step_of_rk4(&text(switch));
    let whole = step(1e6);
    assert!(step(ends[32]) < 0.1 * whole, "{} {whole}", step(ends[32]));
    assert!(step(ends[38]) > 0.5 * whole, "{} {whole}", step(ends[38]));
}

/// A body at rest, pulled by less than static friction: its forces are followed over 32 intervals of a step if what is between
/// their ends is predicted to a fiftieth of them, which a sine of period 2π is up to intervals of 1.26.
#[test]
fn forces_at_rest_are_followed_where_they_are_predicted_to_a_fiftieth() {
    let steps = |until: f64| {
        let mut run = Run::new(
            "title = \"Friction\"\n[coordinates]\nx = { initial = 0 }\ny = { initial = 0 }\n\
             [lagrangian]\nL = \"1/2*x'^2 + 1/2*y'^2 + 0.2*x*sin(t)\"\n\
             dissipation = \"0.3*sqrt(x'^2 + y'^2)\"\n",
        );
        assert_eq!(run.to(until)[..4], [0.0; 4]);
        run.steps
    };
    let at_once = steps(20.0);
    assert_eq!(steps(38.0), at_once);
    assert!(steps(43.0) > at_once);
}

/// Follows the error of rk4 in the energy of an oscillator from step to step: what is said of it changes where the drift passes
/// the limit. Returns the greatest drift before that and the least after it.
fn passed(step: f64, limit: f64, steps: u32, said: impl Fn(&Gauge) -> bool) -> [f64; 2] {
    let mut experiment = build(&oscillator(""), |setup| {
        "rk4".clone_into(&mut setup.method);
        setup.settings.step = Some(step);
    });
    let (mut below, mut above) = (0.0_f64, f64::INFINITY);
    for k in 1..=steps {
        run(&mut experiment, step * f64::from(k));
        let gauge = gauge(&experiment.snapshot(), "energy");
        assert_eq!(said(&gauge), gauge.max_drift > limit, "{} after {k} steps", gauge.max_drift);
        if gauge.max_drift > limit {
            above = above.min(gauge.max_drift);
        } else {
            below = below.max(gauge.max_drift);
        }
    }
    [below, above]
}

#[test]
fn a_quantity_is_lost_beyond_a_tenth_of_what_moves() {
    let [below, above] = passed(0.8, 0.1, 80, |gauge| gauge.verdict.word() == "lost");
    assert!(below > 0.09 && above < 0.11, "{below} {above}");
}

#[test]
fn a_drift_is_reported_beyond_a_millionth_of_what_moves() {
    let [below, above] = passed(0.1, 1e-6, 200, |gauge| gauge.left.is_some());
    assert!(below > 0.9e-6 && above < 1.1e-6, "{below} {above}");
}

/// The words of an oscillator in the plane of this amplitude that moves along a line: those on its energy and on its angular
/// momentum, whose terms are 0.
fn along_a_line(amplitude: f64) -> [&'static str; 2] {
    let text = format!(
        "title = \"A line\"\n[coordinates]\nx = {{ initial = {amplitude:e} }}\ny = {{ initial = 0 }}\n[lagrangian]\n\
         L = \"1/2*(x'^2 + y'^2) - 1/2*(x^2 + y^2)\"\n"
    );
    let mut experiment = build(&text, |_| {});
    run(&mut experiment, 50.0);
    let snapshot = experiment.snapshot();
    ["energy", "L_z"].map(|name| gauge(&snapshot, name).verdict.word())
}

/// The energy is half the square of the amplitude: 5e-307 has all its digits, 5e-309 is less than the least normal number.
#[test]
fn a_drift_is_not_known_where_every_term_underflows() {
    assert_eq!(along_a_line(1.0), ["exact", "exact"]);
    assert_eq!(along_a_line(1e-153), ["exact", "exact"]);
    assert_eq!(along_a_line(1e-154), ["unknown", "exact"]);
    assert_eq!(along_a_line(1e-170), ["unknown", "exact"]);
    // at rest in the middle nothing moves, and nothing underflows
    assert_eq!(along_a_line(0.0), ["exact", "exact"]);
}

/// A fall to y = 0 in this time from rest at 1, in the potential −k/y² with k = 1/(2 t²).
fn fall(variable: &str, time: f64) -> String {
    format!("{:e}/{variable}^2", 0.5 / (time * time))
}

/// From rest at 1 the kink of √|x| is passed after (4/3) √2. Every method stops where y = 0; as it is only known which of them come
/// beyond the kink from trials that take a twentieth of the time longer, nothing is said of it where that comes before.
#[test]
fn a_method_is_called_to_pass_where_it_comes_a_twentieth_beyond() {
    let kink = 4.0 / 3.0 * 2.0_f64.sqrt();
    for (longer, passes) in [(1.03, false), (1.08, true)] {
        let text = format!(
            "title = \"Two\"\n[coordinates]\nx = {{ initial = 1 }}\ny = {{ initial = 1 }}\n[lagrangian]\n\
             L = \"1/2*(x'^2 + y'^2) - sqrt(abs(x)) + {}\"\n",
            fall("y", longer * kink)
        );
        let said = with_file(&text, &["run", "system.toml", "--method=dop853", "--until=6"]).text();
        assert_eq!(said.contains("taylor passes it"), passes, "{longer}: {said}");
    }
}

/// A pendulum in spherical coordinates swings through the pole after a quarter of its period, where tangent vectors have no limit.
/// Where the motion continues for a hundredth of that time no collision lies there.
#[test]
fn a_pole_is_told_from_a_collision_where_the_motion_continues_a_hundredth_beyond() {
    // the quarter of a period at amplitude 1: π/2 over the mean of 1 and cos ½
    let (mut a, mut b) = (1.0_f64, 0.5_f64.cos());
    for _ in 0..6 {
        (a, b) = (f64::midpoint(a, b), (a * b).sqrt());
    }
    let quarter = std::f64::consts::FRAC_PI_2 / a;
    for (longer, words) in [(1.005, "a collision or another"), (1.02, "a pole of the coordinates")]
    {
        let text = format!(
            "title = \"A pole\"\n[coordinates]\nth = {{ initial = 1 }}\nf = {{ initial = 0 }}\nz = {{ initial = 1 }}\n\
             [lagrangian]\nL = \"1/2*(th'^2 + sin(th)^2*f'^2 + z'^2) + cos(th) + {}\"\n",
            fall("z", longer * quarter)
        );
        let said = with_file(&text, &["flow", "system.toml", "--until=3"]).text();
        assert!(said.contains(words), "{longer}: {said}");
    }
}

/// What `equilibria` says of a place first.
fn equilibrium(text: &str) -> String {
    let said = with_file(text, &["equilibria", "system.toml"]).success();
    said.lines().next().unwrap_or_default().to_owned()
}

/// A valley on a plane that is flat along y to the rounding of its second derivative.
#[test]
fn a_valley_on_a_surface_is_flat_to_1e_12_of_its_greatest_slope() {
    for (part, word) in [("0.9e-12", "degenerate"), ("1.1e-12", "minimum")] {
        let said = equilibrium(&format!(
            "title = \"A valley\"\n[coordinates]\nx = {{ initial = 0.1 }}\ny = {{ initial = 0.1 }}\nz = {{ initial = 0 }}\n\
             [lagrangian]\nL = \"1/2*(x'^2 + y'^2 + z'^2) - 1/2*x^2 - 1/2*{part}*y^2\"\n\
             [[constraints]]\nname = \"plane\"\nexpression = \"z\"\n"
        ));
        assert!(said.starts_with(word), "{part}: {said}");
    }
}

/// A force that drives an oscillator by what may be the rounding of its linear law.
#[test]
fn growth_is_seen_beyond_the_rounding_of_what_it_is_made_of() {
    for (rate, word) in [("7e-14", "linearly stable"), ("1e-13", "unstable")] {
        let rest =
            oscillator("").replace("[run]", &format!("forces = {{ x = \"{rate}*x'\" }}\n[run]"));
        let said = equilibrium(&rest);
        assert!(said.contains(word), "{rate}: {said}");
    }
}

/// Beside a force of 1 that a constraint balances, one of 64 ε is rounding of its equations.
#[test]
fn a_multiplier_is_zero_below_sixty_four_units_of_what_constraints_balance() {
    for (force, is_zero) in [(1.2e-14, true), (1.6e-14, false)] {
        let text = format!(
            "title = \"Held\"\n[coordinates]\nx = {{ initial = 0 }}\ny = {{ initial = 0 }}\nz = {{ initial = 0 }}\n\
             [lagrangian]\nL = \"1/2*(x'^2 + y'^2 + z'^2) - {force:e}*x - y - 1/2*z^2\"\n\
             [[constraints]]\nname = \"a\"\nexpression = \"x\"\n[[constraints]]\nname = \"b\"\nexpression = \"y\"\n"
        );
        let found = with_file(&text, &["equilibria", "system.toml", "--format=json"]).json();
        let multipliers = &found["equilibria"][0]["multipliers"];
        let expected = if is_zero { 0.0 } else { force };
        assert_eq!(multipliers["lambda_a"].as_f64(), Some(expected), "{multipliers}");
        assert_eq!(multipliers["lambda_b"].as_f64(), Some(1.0), "{multipliers}");
    }
}

/// The rate of a cyclic coordinate is its momentum, and one of 64 ε is rounding of a unit.
#[test]
fn a_rate_is_zero_below_sixty_four_units_of_what_it_is_made_of() {
    for (momentum, is_zero) in [(1.3e-14, true), (1.5e-14, false)] {
        let text = format!(
            "title = \"Slow\"\n[coordinates]\nf = {{ initial = 0, momentum = {momentum:e} }}\nx = {{ initial = 0 }}\n\
             [hamiltonian]\nH = \"1/2*(p_f^2 + p_x^2 + x^2)\"\n"
        );
        let found = with_file(&text, &["equilibria", "system.toml", "--format=json"]).json();
        let rate = &found["equilibria"][0]["rates"]["f'"];
        assert_eq!(rate.as_f64(), Some(if is_zero { 0.0 } else { momentum }), "{found}");
    }
}

/// In the variables of a rotation every term of H has some twenty nodes.
#[test]
fn a_new_hamiltonian_is_written_up_to_ten_thousand_nodes() {
    for (terms, is_written) in [(380, true), (600, false)] {
        let sum: Vec<String> =
            (1..=terms).map(|k| format!("{k}*sin({k}*x)*cos(p_x/{k})")).collect();
        let text = format!(
            "title = \"Long\"\n[coordinates]\nx = {{ initial = 0.3, momentum = 0.2 }}\n[hamiltonian]\n\
             H = \"1/2*p_x^2 + {}\"\n[[transformations]]\nname = \"m\"\nkind = \"explicit\"\n\
             Q = {{ Q = \"x*cos(1) + p_x*sin(1)\" }}\nP = {{ P = \"p_x*cos(1) - x*sin(1)\" }}\n",
            sum.join(" + ")
        );
        let found = with_file(&text, &["derive", "system.toml", "--format=json"]).json();
        let map = &found["transformations"][0];
        assert_eq!(map["K"].is_string(), is_written, "{terms}: {}", map["why"]);
        assert_eq!(map["K_of_old"].is_string(), !is_written, "{terms}: {}", map["why"]);
    }
}
