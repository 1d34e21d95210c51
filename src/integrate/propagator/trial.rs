//! Trials by other methods around a time at which a motion stops.
//!
//! In: the states from which it came there. Out: a method, or a fixed step, that passes. Never here: what the error is called.

use super::Propagator;
use crate::integrate::{Settings, Stepping, initial_step, method_named};
use crate::num::{DoubleDouble, math};
use crate::system::{MotionErrorKind, Passage, State};

/// A method that may pass a singular configuration is tried with about this many steps to it.
const STEPS_THERE: f64 = 50.0;

const MOST_STEPS: u32 = 4000;

/// The results of a trial and of another one with half the step may differ by this part. It is also the part of the
/// velocities by which the rates may change them in a step that no longer moves the clock, where another method may
/// pass.
const AGREES: f64 = 1e-3;

/// Forces that are so many times those in the regular steps before grow without bound.
const UNBOUNDED: f64 = 1e6;

/// Velocities that are no more than so many times those in the regular steps do not grow without bound.
const BOUNDED: f64 = 10.0;

/// A trial from the beginning of the motion goes beyond the place by this part of the time to it.
const BEYOND: f64 = 0.05;

/// The parts of the time to an overflow after which a motion is looked at that may have left the range of numbers sooner itself.
const GROWING: [f64; 12] = [0.95, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.15, 0.1, 0.05];

/// A number that changes by less than this part of the largest of its kind is ignored.
const NEGLIGIBLE: f64 = 1e-6;

/// A number of a motion by fixed steps that is so many times all of its kind in the motion itself has run away.
const RUN_AWAY: f64 = 1e3;

/// The number of step sizes tried, each a tenth of the one before.
const STEPS_TRIED: u32 = 3;

impl Propagator {
    /// Whether the motion stops where its rates grow without bound, as in a collision: over a step too small to move the
    /// clock they still change its velocities. Another method only steps over it.
    pub(super) fn is_steep(&self, kind: &MotionErrorKind) -> bool {
        let (MotionErrorKind::StepUnderflow(step), n) = (kind, self.system.degrees()) else {
            return false;
        };
        let state = self.stepper.state();
        let numbers: Vec<DoubleDouble> = (0..state.values.len()).map(|i| state.exact(i)).collect();
        let mut rates = self.system.exact_rates();
        rates.set_parameters(&self.system.inputs(&self.parameters));
        if state.form != self.system.form()
            || numbers.len() < 2 * n
            || rates.evaluate(state.exact_time(), &numbers).is_err()
        {
            return false;
        }
        let change = (n..2 * n).map(|i| (rates.rate(i).high * step).abs()).fold(0.0, f64::max);
        let size = (n..2 * n).map(|i| numbers[i].high.abs()).fold(0.0, f64::max);
        changes_much(change, size)
    }

    /// Whether the motion stops where its forces grow without bound and its velocities do not.
    pub(super) fn has_unbounded_force(&self, kind: &MotionErrorKind) -> bool {
        let (MotionErrorKind::StepUnderflow(_), Some(regular)) = (kind, &self.watch.regular) else {
            return false;
        };
        let sizes = [self.stepper.state(), regular].map(|state| self.sizes_of_rates(state));
        let [Some([velocity, force]), Some([velocity_before, force_before])] = sizes else {
            return false;
        };
        grows_alone([force_before, force], [velocity_before, velocity])
    }

    /// The greatest rate of a coordinate, and of a velocity or momentum, at a state.
    fn sizes_of_rates(&self, state: &State) -> Option<[f64; 2]> {
        let n = self.system.degrees();
        if state.form != self.system.form() || state.values.len() < 2 * n || n == 0 {
            return None;
        }
        let numbers: Vec<DoubleDouble> = (0..state.values.len()).map(|i| state.exact(i)).collect();
        let mut rates = self.system.exact_rates();
        rates.set_parameters(&self.system.inputs(&self.parameters));
        rates.evaluate(state.exact_time(), &numbers).ok()?;
        let largest = |range: std::ops::Range<usize>| {
            range.map(|i| rates.rate(i).high.abs()).fold(0.0, f64::max)
        };
        Some([largest(0..n), largest(n..2 * n)])
    }

    /// The initial states and end times of trials that pass a time at which the motion stops: from
    /// nearby, and from the beginning of the motion.
    fn around(&self, time: f64) -> Vec<(State, f64)> {
        let mut ways = Vec::new();
        for (from, part) in [(&self.watch.regular, 1.0), (&self.watch.begun, BEYOND)] {
            let Some(from) = from else { continue };
            let mut way = way_beyond(part, time - from.time, self.stepper.step_size());
            if way == 0.0 && !self.method.locates_kinks {
                // it begins on a kink that this method does not know, and has not taken a step
                way = initial_step::of(&self.system, from, &self.parameters);
            }
            if way > 0.0 && time >= from.time && (time + way).is_finite() {
                ways.push((from.clone(), time + way));
            }
        }
        ways
    }

    /// Another method that passes a time, if there is one.
    pub(super) fn way_past(&mut self, time: f64) -> Option<Passage> {
        let settings = Settings { step: None, tolerance: None };
        for name in ["taylor", "dop853"] {
            let method = method_named(name).filter(|method| method.name != self.method.name);
            let Some(method) = method else { continue };
            // from the beginning first: one that begins nearby may end before it comes to what stops the motion
            for (from, until) in self.around(time).into_iter().rev() {
                match self.trial(method, settings, &from, until) {
                    Trial::Passed(_) => return Some(Passage { method: method.name, step: None }),
                    Trial::Stopped => break,
                    Trial::Unfinished => {}
                }
            }
        }
        if self.method.stepping == Stepping::Fixed { None } else { self.fixed_past(time) }
    }

    /// Whether fixed steps have led far beyond where the motion itself is at that time and was at its beginning, as the default
    /// method follows it.
    pub(super) fn has_run_away(&mut self, state: &State) -> bool {
        let settings = Settings { step: None, tolerance: None };
        let (Some(from), Some(method)) = (self.watch.begun.clone(), method_named("taylor")) else {
            return false;
        };
        if self.method.stepping != Stepping::Fixed || state.time <= from.time {
            return false;
        }
        let Trial::Passed(there) = self.trial(method, settings, &from, state.time) else {
            return false;
        };
        let native = |state| self.system.convert(state, self.system.form(), &self.parameters);
        match [native(state), native(&from), native(&there)] {
            [Ok(state), Ok(from), Ok(there)] => {
                runs_away(&state, [&from, &there], self.system.degrees())
            }
            _ => false,
        }
    }

    /// Whether the motion itself stays in range beyond a time at which fixed steps have left the range of numbers, as methods of
    /// variable step follow it; `None` if they do not tell.
    pub(super) fn stays_in_range(
        &mut self,
        time: f64,
        is_vast: impl Fn(&State) -> bool,
    ) -> Option<bool> {
        let settings = Settings { step: None, tolerance: None };
        let from = self.watch.begun.clone()?;
        let since = time - from.time;
        if since <= 0.0 {
            return None;
        }
        for method in ["taylor", "dop853"].into_iter().filter_map(method_named) {
            let beyond = from.time + (1.0 + BEYOND) * since;
            if let Trial::Passed(state) = self.trial(method, settings, &from, beyond) {
                return Some(!is_vast(&state));
            }
            // one that grows leaves the range as well, by fixed steps that are too long much later than by itself
            for part in GROWING {
                let before = from.time + part * since;
                if let Trial::Passed(state) = self.trial(method, settings, &from, before) {
                    if is_vast(&state) {
                        return Some(false);
                    }
                    break;
                }
            }
        }
        None
    }

    /// A fixed step with which the motion passes a time, if there is one.
    pub(super) fn fixed_past(&mut self, time: f64) -> Option<Passage> {
        let method = method_named("rk4")?;
        for (from, until) in self.around(time) {
            let steps = (time - from.time) / STEPS_THERE;
            let mut step = math::powi(10.0, math::log10(steps).floor() as i32);
            for _ in 0..STEPS_TRIED {
                let settings = |step| Settings { step: Some(step), tolerance: None };
                let coarse = self.trial(method, settings(step), &from, until);
                let fine = self.trial(method, settings(0.5 * step), &from, until);
                if let (Trial::Passed(coarse), Trial::Passed(fine)) = (coarse, fine)
                    && agree(&from, &coarse, &fine, self.system.degrees())
                {
                    return Some(Passage { method: method.name, step: Some(step) });
                }
                step *= 0.1;
            }
        }
        None
    }

    pub(super) fn trial(
        &mut self,
        method: &'static crate::integrate::Method,
        settings: Settings,
        from: &State,
        until: f64,
    ) -> Trial {
        self.integrated(method, settings, from, until).unwrap_or(Trial::Stopped)
    }

    /// The same; `None` where it stops.
    fn integrated(
        &mut self,
        method: &'static crate::integrate::Method,
        settings: Settings,
        from: &State,
        until: f64,
    ) -> Option<Trial> {
        let mut stepper = (method.make)(&self.system, &settings).ok()?;
        stepper.start(from, &self.parameters).ok()?;
        let mut state = from.clone();
        for _ in 0..MOST_STEPS {
            if stepper.time() >= until {
                stepper.at(until, &mut state).ok()?;
                return Some(Trial::Passed(state));
            }
            stepper.step(until).ok()?;
            state.copy_from(stepper.state());
            if !self.domain.has_energy(&state) {
                return None;
            }
            if let Some(projector) = &mut self.projector {
                projector.project(&mut state).ok()?;
                stepper.replace_state(&state);
            }
        }
        Some(Trial::Unfinished)
    }
}

/// Whether forces have grown from one size to another without bound, and velocities have not.
fn grows_alone([force_before, force]: [f64; 2], [before, velocity]: [f64; 2]) -> bool {
    force > UNBOUNDED * force_before && velocity < BOUNDED * before
}

/// Whether rates change velocities of this size by what counts, over a step that no longer moves the clock.
fn changes_much(change: f64, size: f64) -> bool {
    change > AGREES * size
}

/// How an integration by another method went.
pub(super) enum Trial {
    /// It reached this state beyond the place.
    Passed(State),
    /// It stopped too.
    Stopped,
    /// It took too many steps to find out.
    Unfinished,
}

/// Whether numbers of a kind, coordinates or rates, are far larger than all of their kind in other states.
fn runs_away(state: &State, others: [&State; 2], degrees: usize) -> bool {
    let kinds = [0..degrees, degrees..(2 * degrees).min(state.values.len())];
    let largest = |state: &State, kind: &std::ops::Range<usize>| {
        state.values[kind.clone()].iter().map(|x| x.abs()).fold(0.0, f64::max)
    };
    kinds.iter().any(|kind| {
        let most = others.iter().map(|other| largest(other, kind)).fold(0.0, f64::max);
        largest(state, kind) > RUN_AWAY * most && most > 0.0
    })
}

/// Whether two integrations from a state end at the same point. Numbers are compared relative to
/// their change, and to the largest of their kind, since one may be nothing but rounding.
fn agree(from: &State, coarse: &State, fine: &State, degrees: usize) -> bool {
    let kinds = [0..degrees, degrees..(2 * degrees).min(from.values.len())];
    kinds.into_iter().all(|kind| {
        let apart = |x: &State, y: &State, i: usize| (x.values[i] - y.values[i]).abs();
        let largest = kind.clone().map(|i| apart(fine, from, i)).fold(0.0, f64::max);
        kind.clone().all(|i| {
            let size = apart(fine, from, i).max(NEGLIGIBLE * largest);
            apart(coarse, fine, i) <= AGREES * size
        })
    })
}

/// How far a trial goes beyond a place that is so far from its beginning: by a part of that, and by two steps at least.
fn way_beyond(part: f64, since: f64, step: f64) -> f64 {
    (part * since).max(2.0 * step)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_trial_from_the_beginning_goes_a_twentieth_beyond_the_place() {
        let way = way_beyond(BEYOND, 2.0, 1e-9);
        assert!((0.08..0.12).contains(&way), "{way}");
        assert_eq!(way_beyond(BEYOND, 2.0, 0.5), 1.0);
    }
    use crate::system::Form;

    #[test]
    fn steps_run_away_at_a_thousand_times_the_motion() {
        let motion = [&state([1.0, 0.0, 0.5, 2.0]), &state([-0.3, 0.0, 0.0, 0.0])];
        assert!(!runs_away(&state([900.0, -900.0, 1900.0, 0.0]), motion, 2));
        assert!(runs_away(&state([0.0, -1100.0, 0.0, 0.0]), motion, 2));
        assert!(runs_away(&state([0.0, 0.0, 2100.0, 0.0]), motion, 2));
    }

    fn state(values: [f64; 4]) -> State {
        State::new(0.0, Form::Velocity, values.to_vec())
    }

    #[test]
    fn two_ways_agree_to_a_thousandth_of_what_moves() {
        let from = state([0.0; 4]);
        let agrees = |off: f64| {
            let fine = state([1.0, 1.0, 2.0, 1.0]);
            agree(&from, &state([1.0, 1.0, 2.0 * (1.0 + off), 1.0]), &fine, 2)
        };
        assert!(agrees(0.8e-3));
        assert!(!agrees(1.2e-3));
    }

    #[test]
    fn a_force_grows_alone_by_a_million_where_velocities_grow_by_less_than_ten() {
        assert!(grows_alone([1.0, 1.1e6], [1.0, 9.0]));
        assert!(!grows_alone([1.0, 0.9e6], [1.0, 9.0]));
        assert!(!grows_alone([1.0, 1.1e6], [1.0, 11.0]));
    }

    #[test]
    fn rates_are_steep_that_change_velocities_by_a_thousandth() {
        for size in [1e-9, 1.0, 1e9] {
            assert!(changes_much(1.1e-3 * size, size), "{size}");
            assert!(!changes_much(0.9e-3 * size, size), "{size}");
        }
    }

    #[test]
    fn a_number_that_moves_by_less_than_a_millionth_is_noise() {
        let from = state([0.0; 4]);
        let agrees = |noise: f64| {
            agree(&from, &state([1.0, noise, 1.0, 0.0]), &state([1.0, 0.0, 1.0, 0.0]), 2)
        };
        assert!(agrees(0.8e-9));
        assert!(!agrees(1.2e-9));
    }
}
