//! The Taylor series of the events' functions along a motion whose own series is known.
//!
//! In: the series of the motion, a time within its step. Out: the coefficients of every function
//! about that time, and how far they represent it. Never here: zeros.
//!
//! The estimate is that of a step by Taylor series: À. Jorba, M. Zou, Experimental Mathematics 14
//! (2005) 99, section 3.

use std::borrow::Cow;
use std::sync::Arc;

use super::System;
use super::jet::{Jet, Side};
use super::program::{Guard, Program};
use super::sign_bound::{LAST, bound, keeps_sign, shows_no_end, stays};
use super::step_series::StepSeries;
use crate::expr::FunctionId;
use crate::num::{
    DoubleDouble, ScalarLanes, all_finite, cosine_of_arctangent, cosine_of_half, math, square_root,
};

/// The most times ahead from which functions are evaluated whose last terms show nothing.
const MOST_SAMPLES: u32 = 100;

/// The series of the functions, up to one order.
#[derive(Clone, Debug)]
pub(super) struct Expansion {
    system: System,
    jet: Jet<f64>,
    /// The roots in the functions, whose series continue on another branch where they pass zero.
    guards: Vec<Guard>,
    /// The number of outputs that are functions of events; the others are arguments.
    functions: usize,
    outputs: usize,
    /// Whether the functions read each input.
    read: Vec<bool>,
    /// The numbers of the motion that the functions are, if they are nothing else.
    numbers: Option<Vec<usize>>,
    /// The degree of the functions as polynomials in the numbers of the motion and the time, if they are polynomials.
    degree: Option<usize>,
    /// The degree of the series that were taken in last.
    taken_degree: usize,
    /// A series of the motion shifted to another time.
    moved: Vec<f64>,
    /// Such series of the numbers that the functions are.
    shifted: Vec<f64>,
}

impl Expansion {
    pub(super) fn new(
        system: &System,
        program: Arc<Program>,
        functions: usize,
        order: usize,
    ) -> Expansion {
        Expansion {
            system: system.clone(),
            outputs: program.outputs(),
            read: program.inputs_read(),
            numbers: program.outputs_as_inputs().filter(|numbers| {
                program.switches() == 0 && numbers.iter().all(|&i| i < system.motion_len())
            }),
            degree: program.degree(),
            guards: program.guards.clone(),
            taken_degree: 1,
            jet: Jet::new(program, order),
            functions,
            moved: vec![0.0; order + 1],
            shifted: Vec::new(),
        }
    }

    pub(super) fn set_parameters(&mut self, parameters: &[DoubleDouble]) {
        self.jet.set_parameters(parameters);
    }

    pub(super) fn order(&self) -> usize {
        self.jet.order()
    }

    /// Expands the functions about a time `x` after the origin of the motion's series, in its unit.
    /// Returns false if a coefficient is not finite.
    pub(super) fn about(&mut self, series: &dyn StepSeries, x: f64) -> bool {
        if self.numbers.is_some() {
            return self.numbers_about(series, x);
        }
        self.take_in(series, x);
        let time = (series.time() + DoubleDouble::from(x) * series.scale()).high;
        // a switch may be within another one, as in max(|x| − 1, 0): each pass settles those that depend on none unsettled
        for _ in 0..=self.jet.switches() {
            if !self.grow(time, series.scale()) {
                return false;
            }
            let mut turned = false;
            for i in 0..self.jet.switches() {
                let side = side(self.jet.switch(i));
                turned |= side != self.jet.side(i);
                self.jet.set_side(i, side);
            }
            if !turned {
                return true;
            }
        }
        false
    }

    /// The same where the functions are numbers of the motion.
    fn numbers_about(&mut self, series: &dyn StepSeries, x: f64) -> bool {
        self.shifted.clear();
        for &number in self.numbers.iter().flatten() {
            shift(series.coefficients(number), x, &mut self.moved);
            let unit = series.unit(number);
            self.shifted.extend(self.moved.iter().map(|c| c * unit));
        }
        self.shifted.iter().all(|c| c.is_finite())
    }

    /// Sets the coefficients of what the functions depend on.
    fn take_in(&mut self, series: &dyn StepSeries, x: f64) {
        let motion_len = self.system.motion_len();
        self.taken_degree = 1;
        let mut next = self.system.driven_len();
        for place in 0..motion_len {
            self.take_in_one(place, (series.coefficients(place), series.unit(place)), x);
        }
        for (place, auxiliary) in (motion_len..).zip(self.system.carries()) {
            if auxiliary && next < series.count() {
                self.take_in_one(place, (series.coefficients(next), series.unit(next)), x);
                next += 1;
            } else {
                (0..=self.order()).for_each(|k| self.jet.set_input(place, k, 0.0));
            }
        }
    }

    fn take_in_one(&mut self, place: usize, (coefficients, unit): (&[f64], f64), x: f64) {
        if !self.read[place] {
            return;
        }
        shift(coefficients, x, &mut self.moved);
        let degree = self.moved.iter().rposition(|c| *c != 0.0).unwrap_or(0);
        self.taken_degree = self.taken_degree.max(degree);
        for (k, &c) in self.moved.iter().enumerate() {
            self.jet.set_input(place, k, c * unit);
        }
    }

    fn grow(&mut self, time: f64, unit: f64) -> bool {
        self.jet.advance_to(self.order(), time, unit).is_ok()
            && (0..self.outputs).all(|i| all_finite(ScalarLanes, self.jet.output_series(i)))
            // also of roots that the functions do not read here, as in the smaller part of a maximum
            && self.branch_signs().all(|c| all_finite(ScalarLanes, &c))
    }

    /// Whether every function has this sign from the origin of a series up to a time, in its unit, and is represented
    /// up to a part `cut_off` of it; false where the sizes of the terms do not show that.
    pub(super) fn keep_signs(
        &mut self,
        series: &dyn StepSeries,
        signs: &[f64],
        (cut_off, time): (f64, f64),
    ) -> bool {
        if let Some(numbers) = &self.numbers {
            let mut pairs =
                numbers.iter().zip(signs).map(|(&i, sign)| (series.coefficients(i), sign));
            return pairs.all(|(c, sign)| c[0] * sign > 0.0 && keeps_sign(c, f64::INFINITY, time));
        }
        let keeps = |c: &[f64], sign: f64| c[0] * sign > 0.0 && keeps_sign(c, cut_off, time);
        let arguments = self.functions..self.outputs;
        self.jet.switches() == 0
            && !self.has_branches()
            && self.about(series, 0.0)
            && !self.may_continue(time)
            && signs.iter().enumerate().all(|(i, &sign)| keeps(self.function(i), sign))
            && arguments.into_iter().all(|i| stays(self.jet.output_series(i), time))
    }

    pub(super) fn function(&self, event: usize) -> &[f64] {
        if self.numbers.is_some() {
            return &self.shifted[event * self.moved.len()..][..self.moved.len()];
        }
        self.jet.output_series(event)
    }

    /// Series beyond whose first zero other branches of the functions apply: those of the switches, of the roots, of which √(y²)
    /// continues as y where y changes its sign, of arctangents, and of the angles of points.
    pub(super) fn branch_signs(&self) -> impl Iterator<Item = Cow<'_, [f64]>> {
        let switches = (0..self.jet.switches()).map(|i| Cow::Borrowed(self.jet.switch(i)));
        let roots = self.guards.iter().filter_map(|guard| self.root(guard));
        switches.chain(roots).chain(self.angles())
    }

    /// Of each arctangent the cosine, which passes zero at a pole of the argument: there the function jumps, and its series goes
    /// on, as that of arctan(tan t) = t does. Of the angle of each point the cosine of half of it, which passes zero at the cut.
    fn angles(&self) -> impl Iterator<Item = Cow<'_, [f64]>> {
        let arguments = self.jet.arguments();
        let tangents = arguments.filter(|(function, _)| *function == FunctionId::Atan);
        let tangents = tangents.map(|(_, tangent)| Cow::Owned(cosine_of_arctangent(tangent)));
        let angles = self.jet.angles_of_points();
        tangents.chain(angles.map(|angle| Cow::Owned(cosine_of_half(angle))))
    }

    /// Whether there are roots or inverse functions.
    pub(super) fn has_branches(&self) -> bool {
        !self.guards.is_empty() || self.angles().next().is_some()
    }

    /// The series of a root that is positive on its branch, or of the root of the argument of a power that is none itself.
    fn root(&self, guard: &Guard) -> Option<Cow<'_, [f64]>> {
        match (guard.passes, guard.under(|r| self.jet.value(r))) {
            (true, _) => Some(Cow::Borrowed(self.jet.series(guard.value))),
            (false, Some(under)) => Some(Cow::Owned(square_root(self.jet.series(under)))),
            (false, None) => None,
        }
    }

    /// Whether the functions are numbers of the motion, whose polynomials in a step are all that there is of them.
    fn is_of_numbers(&self) -> bool {
        self.numbers.is_some()
    }

    /// Whether the functions are the polynomials that were found, with nothing cut off.
    fn is_whole(&self) -> bool {
        self.degree.is_some_and(|degree| degree.saturating_mul(self.taken_degree) <= self.order())
    }

    /// Whether the last terms of a series at a time show nothing of how its function continues: the next term of cos t⁴ at 0
    /// comes eight orders after the last.
    fn may_continue(&self, time: f64) -> bool {
        let functions = (0..self.functions).map(|i| self.function(i));
        !self.is_whole()
            && functions
                .map(Cow::Borrowed)
                .chain(self.branch_signs())
                .any(|c| shows_no_end(&c, time))
    }

    /// Expands the functions about a time `x` after the origin of the motion's series, in its unit, and returns how far
    /// the series represent them up to a part `cut_off` of them, followed no farther than `whole`; a NaN if there are
    /// none.
    pub(super) fn expand(
        &mut self,
        series: &dyn StepSeries,
        x: f64,
        (cut_off, whole): (f64, f64),
    ) -> f64 {
        if !self.about(series, x) {
            return f64::NAN;
        }
        if self.is_of_numbers() {
            return whole;
        }
        let reach = self.reach(cut_off, whole);
        if !self.may_continue(reach) {
            return reach;
        }
        // the last terms show nothing here, but those about a time ahead do, if they also hold back to here; the same
        // number of terms about here holds no farther
        let mut ahead = if reach.is_finite() { 0.5 * reach } else { 1.0 };
        let mut least = 0.0;
        for _ in 0..MOST_SAMPLES {
            let there =
                if self.about(series, x + ahead) { self.reach(cut_off, whole) } else { 0.0 };
            if there >= ahead {
                least = there.min(2.0 * ahead);
                break;
            }
            ahead *= if there > 0.0 { 0.5 * (there / ahead) } else { 1e-4 };
        }
        if self.about(series, x) { reach.min(least) } else { f64::NAN }
    }

    /// How far the series represent their functions up to a part `cut_off` of them, in their unit,
    /// followed no farther than `whole`.
    fn reach(&self, cut_off: f64, whole: f64) -> f64 {
        // mostly they do so all the way, which takes no root to see
        let (functions, arguments) = (0..self.functions, self.functions..self.outputs);
        let series = |i: usize| self.jet.output_series(i);
        if functions.clone().all(|i| is_valid(self.function(i), cut_off, whole))
            && arguments.clone().all(|i| stays(series(i), whole))
            && self.branch_signs().all(|c| is_valid(&c, cut_off, whole))
        {
            return whole;
        }
        let functions = functions.map(|i| validity(self.function(i), cut_off));
        let arguments = arguments.map(|i| moving(series(i)));
        let branches = self.branch_signs().map(|c| validity(&c, cut_off));
        // a NaN must not be lost
        let least = |reach: f64, own: f64| if own < reach || own.is_nan() { own } else { reach };
        functions.chain(arguments).chain(branches).fold(whole, least)
    }
}

/// Writes the coefficients of Σ cₖ (x + y)ᵏ in powers of y, by repeated division.
fn shift(coefficients: &[f64], x: f64, out: &mut [f64]) {
    let order = out.len() - 1;
    out.copy_from_slice(&coefficients[..=order]);
    if x != 0.0 {
        for first in 0..order {
            for k in (first..order).rev() {
                out[k] += out[k + 1] * x;
            }
        }
    }
}

/// The side of a switch just after the origin.
pub(super) fn side(c: &[f64]) -> Side {
    match c.iter().find(|x| **x != 0.0) {
        Some(x) if *x < 0.0 => Side::Negative,
        _ => Side::Positive,
    }
}

/// Whether a truncated series represents its function up to a time, in its own unit: [`validity`]
/// without its roots.
fn is_valid(c: &[f64], cut_off: f64, time: f64) -> bool {
    (c.len() - LAST..c.len()).filter(|&k| c[k] != 0.0).all(|k| {
        let mut term = c[k].abs();
        (0..k).rev().any(|j| {
            term *= time;
            cut_off * c[j].abs() >= term
        })
    })
}

/// How far a truncated series represents its function, in its own unit.
fn validity(c: &[f64], cut_off: f64) -> f64 {
    let mut length = f64::INFINITY;
    for k in c.len() - LAST..c.len() {
        if c[k] == 0.0 {
            continue;
        }
        let to_term = |j: usize| {
            let ratio = cut_off * (c[j] / c[k]).abs();
            math::powf(ratio, 1.0 / (k - j) as f64)
        };
        length = length.min((0..k).map(to_term).fold(0.0, f64::max));
    }
    length
}

/// How far the argument of an exponential stays in one range of its values.
fn moving(c: &[f64]) -> f64 {
    let bound = bound(c[0]);
    let terms = c.iter().enumerate().skip(1).filter(|(_, x)| **x != 0.0);
    let reach = terms.map(|(k, x)| math::powf(bound / x.abs(), 1.0 / k as f64));
    reach.fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ORDER: usize = 12;
    const CUT_OFF: f64 = 1e-3;

    fn factorial(k: usize) -> f64 {
        (1..=k).map(|i| i as f64).product()
    }

    #[test]
    fn a_sine_is_simple_for_about_half_a_turn_and_a_pole_is_avoided() {
        for speed in [1.0, 1e6, 1e-6] {
            let sine: [f64; ORDER + 1] = std::array::from_fn(|k| {
                let sign = [0.0, 1.0, 0.0, -1.0][k % 4];
                sign * math::powi(speed, k as i32) / factorial(k)
            });
            let turn = validity(&sine, CUT_OFF) * speed;
            assert!((2.5..4.5).contains(&turn), "{turn}");
            let pole: [f64; ORDER + 1] = std::array::from_fn(|k| math::powi(speed, k as i32));
            let part = validity(&pole, CUT_OFF) * speed;
            assert!((0.4..0.7).contains(&part), "{part}");
        }
        let mut line = [0.0; ORDER + 1];
        (line[0], line[1]) = (-5.0, 1.0);
        assert_eq!(validity(&line, CUT_OFF), f64::INFINITY);
    }

    #[test]
    fn a_step_without_roots_agrees_with_the_length_itself() {
        let sine: [f64; ORDER + 1] = std::array::from_fn(|k| {
            [0.0, 1.0, 0.0, -1.0][k % 4] * math::powi(3.0, k as i32) / factorial(k)
        });
        let pole: [f64; ORDER + 1] = std::array::from_fn(|k| math::powi(-7.0, k as i32));
        for c in [sine, pole] {
            let length = validity(&c, CUT_OFF);
            assert!(
                is_valid(&c, CUT_OFF, 0.999 * length) && !is_valid(&c, CUT_OFF, 1.001 * length)
            );
            let length = moving(&c);
            assert!(stays(&c, 0.999 * length) && !stays(&c, 1.001 * length));
        }
    }

    #[test]
    fn the_tail_of_an_exponential_is_approached_in_ever_smaller_steps() {
        // the argument −a (t − 500)², seen from 0, from 250 and from 499
        for (from, most) in [(0.0, 250.0), (250.0, 125.0), (499.0, 1.0)] {
            let (a, d) = (1e4, from - 500.0);
            let c = [-a * d * d, -2.0 * a * d, -a];
            let reach = moving(&c);
            assert!(reach < most && reach > 0.05 * most, "{from}: {reach}");
        }
    }
}
