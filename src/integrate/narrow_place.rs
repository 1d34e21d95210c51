//! Narrow places of a law, as a thin barrier or a short pulse, that a step may pass without having been there.
//!
//! In: the arguments u of exponential functions, and what is divided by, at the ends of steps. Out: how much of a step may be taken. Never here: the law.
//!
//! e^u, tanh u and their like change where u is small, and show nothing elsewhere. Between the ends of a step u is followed by the
//! cubic of its values and slopes there, which is exact for a straight path into a Gaussian barrier. A step in which it changes by
//! much, or turns while it was large, is too long to have seen what the function does. 1/u^n is large where u is small beside what it
//! is at the ends of the step, or changes its sign.

use crate::system::{State, SteepArguments, System};

/// The largest change of an argument in one step: e^u is then resolved by the points within it.
const FARTHEST: f64 = 6.0;

/// Beyond this argument no exponential is a number: there it may move at once.
const SATURATED: f64 = 750.0;

/// Beyond this one it is less than the last digit of what is 1.
const SEEN: f64 = 36.0;

/// An argument that falls below this part of what it is at the farther end of a step comes closer to 0 than its cubic is sure of.
const NEAR: f64 = 0.01;

/// The places at which the cubic is evaluated.
const PLACES: u32 = 16;

/// The part of a step over which slopes are taken.
const SLOPE_OVER: f64 = 1e-4;

/// An argument at one end of a step, and its slope, per step.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
struct End {
    value: f64,
    slope: f64,
}

/// The cubic with these ends, at one of the places.
fn between(begin: End, end: End, k: u32) -> f64 {
    let (s, d) = (f64::from(k) / f64::from(PLACES), end.value - begin.value);
    let (a, b) = (begin.slope - d, d - end.slope);
    begin.value + s * (d + (1.0 - s) * (a * (1.0 - s) + b * s))
}

/// The part of a step before the first of its places at which something holds; 1 where there is none.
fn part_before(holds: impl Fn(&u32) -> bool) -> f64 {
    let first = (1..=PLACES).find(holds);
    first.map_or(1.0, |k| f64::from((k - 1).max(1)) / f64::from(PLACES))
}

/// The part of a step before a divisor with these ends vanishes, or comes near to it; 1 where it does not.
fn part_before_zero(begin: End, end: End) -> f64 {
    let near = NEAR * begin.value.abs().max(end.value.abs());
    part_before(|&k| {
        let u = between(begin, end, k);
        u == 0.0 || (u > 0.0) != (begin.value > 0.0) || u.abs() < near
    })
}

/// The part of a step after which an argument with these ends is to be evaluated again; 1 where the step shows all of it.
fn part_of(begin: End, end: End) -> f64 {
    let at = |k: u32| between(begin, end, k);
    let limited = |u: f64| u.clamp(-SATURATED, SATURATED);
    let turns = |k: u32| {
        let (begin, end) = (begin.value.abs(), end.value.abs());
        begin.min(end) > SATURATED && at(k).abs() < NEAR * begin.max(end)
    };
    part_before(|&k| (limited(at(k)) - limited(begin.value)).abs() > FARTHEST || turns(k))
}

/// The arguments and the divisors along one motion.
#[derive(Clone, Debug)]
pub(super) struct NarrowPlaces {
    arguments: Option<FollowedArguments>,
    divisors: Option<FollowedArguments>,
}

impl NarrowPlaces {
    /// Those in the law of a system; `None` if there are none.
    pub(super) fn of(system: &System, parameters: &[f64], blank: &State) -> Option<NarrowPlaces> {
        let followed = |found: SteepArguments| FollowedArguments::new(found, blank);
        let arguments = system.steep_arguments(parameters).map(followed);
        let divisors = system.divisors(parameters).map(followed);
        let is_any = arguments.is_some() || divisors.is_some();
        is_any.then_some(NarrowPlaces { arguments, divisors })
    }

    pub(super) fn set_parameters(&mut self, parameters: &[f64]) {
        let all = self.arguments.iter_mut().chain(&mut self.divisors);
        all.for_each(|followed| followed.arguments.set_parameters(parameters));
    }

    /// The part of a step from a state to another, with the rates at both, that may be taken; 1 for all of it.
    pub(super) fn part(
        &mut self,
        step: f64,
        begin: (&State, &[f64]),
        end: (&State, &[f64]),
    ) -> f64 {
        let arguments = self.arguments.as_mut().map(|found| found.part(step, begin, end, part_of));
        let divisors =
            self.divisors.as_mut().map(|found| found.part(step, begin, end, part_before_zero));
        arguments.into_iter().chain(divisors).fold(1.0, f64::min)
    }
}

/// Functions of the state along one motion.
#[derive(Clone, Debug)]
struct FollowedArguments {
    arguments: SteepArguments,
    there: State,
    here: Vec<f64>,
    beside: Vec<f64>,
    begin: Vec<End>,
    end: Vec<End>,
}

impl FollowedArguments {
    fn new(arguments: SteepArguments, blank: &State) -> FollowedArguments {
        let count = arguments.count();
        FollowedArguments {
            arguments,
            there: blank.clone(),
            here: vec![0.0; count],
            beside: vec![0.0; count],
            begin: vec![End::default(); count],
            end: vec![End::default(); count],
        }
    }

    /// The part of a step that may be taken by this rule for each of them.
    fn part(
        &mut self,
        step: f64,
        (before, slopes): (&State, &[f64]),
        (after, last_slopes): (&State, &[f64]),
        rule: fn(End, End) -> f64,
    ) -> f64 {
        let (mut begin, mut end) = (std::mem::take(&mut self.begin), std::mem::take(&mut self.end));
        let known = self.observe_end(step, before, before.time, slopes, &mut begin)
            && self.observe_end(step, after, before.time + step, last_slopes, &mut end);
        let ends = begin.iter().zip(&end);
        let part = ends.map(|(&begin, &end)| rule(begin, end)).fold(1.0, f64::min);
        (self.begin, self.end) = (begin, end);
        if known { part } else { 1.0 }
    }

    /// The arguments at a state, and their slopes; false where one has no value.
    fn observe_end(
        &mut self,
        step: f64,
        state: &State,
        time: f64,
        slopes: &[f64],
        out: &mut [End],
    ) -> bool {
        self.there.copy_from(state);
        (self.there.time, self.there.time_carry) = (time, 0.0);
        if self.arguments.observe(&self.there, &mut self.here).is_err() {
            return false;
        }
        let offset = SLOPE_OVER * step;
        for (x, slope) in self.there.values.iter_mut().zip(slopes) {
            *x += offset * slope;
        }
        self.there.time += offset;
        if self.arguments.observe(&self.there, &mut self.beside).is_err() {
            return false;
        }
        for (i, end) in out.iter_mut().enumerate() {
            *end = End { value: self.here[i], slope: (self.beside[i] - self.here[i]) / SLOPE_OVER };
        }
        out.iter().all(|end| end.value.is_finite() && end.slope.is_finite())
    }
}

/// The arguments at the ends of the last equal steps.
#[derive(Clone, Debug)]
pub(super) struct PassedPlaces {
    arguments: SteepArguments,
    /// Those at the last ends, the newest last.
    ends: [Vec<f64>; 3],
    /// How many of the last arguments are known.
    known: usize,
}

impl PassedPlaces {
    pub(super) fn new(arguments: SteepArguments) -> PassedPlaces {
        let ends = std::array::from_fn(|_| vec![0.0; arguments.count()]);
        PassedPlaces { arguments, ends, known: 0 }
    }

    /// Records the end of a step. Returns whether the last one or two of them have passed a place where the law changes by more than
    /// they could tell.
    pub(super) fn has_passed(&mut self, state: &State) -> bool {
        let [oldest, middle, newest] = &mut self.ends;
        std::mem::swap(oldest, middle);
        std::mem::swap(middle, newest);
        if self.arguments.observe(state, newest).is_err() {
            self.known = 0;
            return false;
        }
        self.known = (self.known + 1).min(self.ends.len());
        let [oldest, middle, newest] = &self.ends;
        let limited = |u: f64| u.clamp(-SEEN, SEEN);
        let known = self.known;
        (0..newest.len()).any(|i| {
            let (a, b, c) = (oldest[i], middle[i], newest[i]);
            let jumps = known > 1 && (limited(c) - limited(b)).abs() > FARTHEST;
            jumps || known > 2 && turns_unseen(a, b, c)
        })
    }
}

/// Whether the parabola through three values that show nothing comes to where something shows.
fn turns_unseen(a: f64, b: f64, c: f64) -> bool {
    let (slope, bend) = (0.5 * (c - a), 0.5 * (a + c) - b);
    let place = -0.5 * slope / bend;
    let least = b + 0.5 * slope * place;
    [a, b, c].iter().all(|u| u.abs() > SEEN)
        && place.abs() < 1.0
        && (least.abs() < SEEN || least * b < 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::math;

    /// The ends of −((s − at)/width)² over a step from 0 to 1.
    fn gaussian(at: f64, width: f64) -> (End, End) {
        let end = |s: f64| End {
            value: -math::powi((s - at) / width, 2),
            slope: -2.0 * (s - at) / (width * width),
        };
        (end(0.0), end(1.0))
    }

    #[test]
    fn a_barrier_within_a_step_ends_it_before() {
        for width in [1e-2, 1e-4, 1e-8] {
            for at in [0.2, 0.5, 0.9] {
                let (begin, end) = gaussian(at, width);
                let part = part_of(begin, end);
                assert!(part < at, "{width} {at}: {part}");
            }
        }
        let (begin, end) = gaussian(1.5, 1e-4);
        assert_eq!(part_of(begin, end), 1.0);
    }

    #[test]
    fn a_step_ends_before_a_divisor_falls_to_a_hundredth() {
        let line = |begin: f64, end: f64| {
            let slope = end - begin;
            part_before_zero(End { value: begin, slope }, End { value: end, slope })
        };
        for size in [1e-200, 1.0, 1e200] {
            assert_eq!(line(size, 0.011 * size), 1.0);
            assert!(line(size, 0.009 * size) < 1.0 && line(size, -0.3 * size) < 0.77);
            assert!(line(0.009 * size, size) == 1.0 && line(-size, size) < 0.5);
        }
        // 1 + 10¹⁶ x² from x = 0.3 to −0.2
        let square = |x: f64, by: f64| End { value: 1.0 + 1e16 * x * x, slope: 2e16 * x * by };
        assert!(part_before_zero(square(0.3, -0.5), square(-0.2, -0.5)) < 0.6);
        assert_eq!(part_before_zero(square(0.3, -0.1), square(0.2, -0.1)), 1.0);
    }

    #[test]
    fn a_change_by_six_is_resolved_and_one_by_more_is_not() {
        let line = |by: f64| (End { value: 1.0, slope: by }, End { value: 1.0 + by, slope: by });
        let part = |by: f64| part_of(line(by).0, line(by).1);
        assert_eq!(part(5.9), 1.0);
        assert!(part(6.1) < 1.0);
        // what is no number at either end
        let far = |value: f64, slope: f64| End { value, slope };
        assert_eq!(part_of(far(-1000.0, -50.0), far(-1050.0, -50.0)), 1.0);
    }

    #[test]
    fn equal_steps_that_pass_a_barrier_between_them_are_seen() {
        let wall = |x: f64| -x * x / 1e-8;
        let turns = |begin: f64, step: f64| {
            turns_unseen(wall(begin), wall(begin + step), wall(begin + 2.0 * step))
        };
        assert!(turns(-0.0151, 0.01));
        assert!(turns(-0.0049, 0.01));
        assert!(!turns(-0.0351, 0.01));
        assert!(!turns(0.0051, 0.01));
    }
}
