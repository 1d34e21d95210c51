//! Kinks: the branches of functions with a kink, the points along a step where a switch changes
//! sign, and the motion after them.
//!
//! At a switching surface the branch on each side determines a direction. If one leads away from
//! the surface, the motion goes that way. If both lead back (dry friction bringing a body to rest),
//! the motion stays on the surface: the branches are mixed with the weight that keeps the switch at
//! zero, until that weight leaves [−1, 1] (A. F. Filippov, Differential Equations with
//! Discontinuous Righthand Sides, Kluwer 1988, §4; V. I. Utkin's equivalent control).

use super::super::roots::{first_crossing, refined, value_and_slope};
use super::start_slope;
use crate::num::{DoubleDouble, math};
use crate::system::{ExactRates, MotionError, Series, Side, State};

/// Switches whose crossings differ by less than this part of a step cross together.
const TOGETHER: f64 = 1e-12;

/// A term smaller than this part of the largest is ignored in choosing a direction.
const SIGNIFICANT: f64 = 1e-9;

/// Where that leaves no direction, a term smaller than this part is ignored: a motion that only touches the surface
/// arrives with a velocity of such a size, which may matter on one side, over the step there, and not on the other.
const TOUCHED: f64 = 1e-8;

/// A switch crosses zero, and does not merely touch it, where its rate of change times the time to its zero is more than this part of
/// its largest term.
const TRANSVERSAL: f64 = 1e-3;

/// Rates of change on both sides of a surface are the same to this part.
const SAME: f64 = 1e-9;

/// The maximal number of simultaneous switches that are tried in every combination.
const COMBINED: usize = 5;

/// The maximal number of surfaces met at the same time; beyond it the motion counts as stuck.
const MOST_STALLED: u32 = 64;

/// After so many steps in a row that do not advance the time the surface counts as touched only.
const STALLS: u32 = 8;

/// The position of the motion relative to its switching surfaces.
#[derive(Clone, Debug, Default)]
pub(super) struct Kinks {
    /// The switches on whose surface the current state lies.
    on_surface: Vec<usize>,
    /// The number of steps in a row that ended on a surface without advancing the time.
    stalled: u32,
    /// Whether the surface is only touched.
    touched: bool,
    /// Where the motion begins on surfaces: their first certain terms.
    certain: Vec<(usize, usize)>,
    /// The rates of change with which switches came to zero, where the motion did not merely touch their surfaces.
    arrival: Vec<(usize, f64)>,
    /// Whether the motion begins here: no switch is zero by rounding, and those that depend on another may be far from it.
    begins: bool,
}

/// A surface met within a step.
pub(super) struct KinkCrossing {
    /// The time after the series' origin, in its unit.
    pub(super) after: DoubleDouble,
    switches: Vec<usize>,
    /// The rates of change there of those that the motion does not merely touch.
    rates: Vec<(usize, f64)>,
}

/// The last term of a series may be this part of the first where the series still represents its
/// function.
const LAST: f64 = 0.1;

impl KinkCrossing {
    /// Whether the series are still valid there, beyond the step they allow: those of the switches,
    /// and those of every number as in [`represents`].
    pub(super) fn is_known(&self, series: &Series, part: f64, sizes: Option<&[f64]>) -> bool {
        let mut switches = self.switches.iter().map(|&i| series.switch(i));
        switches.all(|c| last_of(c, self.after.high).0 <= LAST * c[0].abs())
            && represents(series, self.after.high, (part, sizes))
    }
}

/// Whether the last terms of the series of every number are no more than a part of its largest a time `after` the origin, or
/// of the `sizes` of the numbers.
pub(super) fn represents(
    series: &Series,
    after: f64,
    (part, sizes): (f64, Option<&[f64]>),
) -> bool {
    (0..series.inputs()).all(|i| {
        let (last, largest) = last_of(series.coefficients(i), after);
        let size = sizes.map_or(0.0, |sizes| sizes[i] / series.unit(i));
        last <= part * largest.max(size)
    })
}

/// The larger of the last two terms of a series, and the largest before the last.
fn last_of(c: &[f64], after: f64) -> (f64, f64) {
    let term = |k: usize| (c[k] * math::powi(after, k as i32)).abs();
    let last = c.len() - 1;
    (term(last).max(term(last - 1)), (0..last).map(term).fold(0.0, f64::max))
}

impl Kinks {
    /// Chooses the sides at a state from which the motion begins: by the sign of each switch, and
    /// if one is zero by the direction of the motion.
    pub(super) fn begin(
        &mut self,
        series: &mut Series,
        rates: &mut ExactRates,
        state: &State,
    ) -> Result<(), MotionError> {
        *self = Kinks { begins: true, ..Kinks::default() };
        if series.switches() == 0 {
            return Ok(());
        }
        let numbers: Vec<DoubleDouble> = (0..state.values.len()).map(|i| state.exact(i)).collect();
        rates.evaluate(state.exact_time(), &numbers)?;
        for i in 0..series.switches() {
            let value = rates.switch(i);
            if value == 0.0 {
                self.on_surface.push(i);
            }
            // on a surface the positive side is tried first
            series.set_side(i, if value > 0.0 { Side::Positive } else { Side::Negative });
        }
        Ok(())
    }

    pub(super) fn is_on_surface(&self) -> bool {
        !self.on_surface.is_empty()
    }

    /// The choices of sides on a surface, the likeliest first.
    pub(super) fn undecided(&self, series: &Series) -> Option<Vec<Vec<Side>>> {
        if self.on_surface.is_empty() {
            return None;
        }
        let before: Vec<Side> = self.on_surface.iter().map(|&i| series.sides()[i]).collect();
        Some(candidates(&before))
    }

    /// Takes a choice of sides on the surface.
    pub(super) fn choose(&self, series: &mut Series, sides: &[Side]) {
        for (&i, &side) in self.on_surface.iter().zip(sides) {
            series.set_side(i, side);
        }
    }

    /// The series of the switches whose surface the state lies on and that have a side.
    pub(super) fn on_surface(&self, series: &Series) -> Vec<(usize, Vec<f64>)> {
        let is_sided = |&&i: &&usize| matches!(series.sides()[i], Side::Positive | Side::Negative);
        let sided = self.on_surface.iter().filter(is_sided);
        sided.map(|&i| (i, series.switch(i).to_vec())).collect()
    }

    /// Takes what is certain of the switches on a surface where the motion begins: their series, and those beside them.
    pub(super) fn learn(&mut self, here: &[(usize, Vec<f64>)], beside: &[(usize, Vec<f64>)]) {
        let pairs = here.iter().zip(beside);
        let first = |((i, here), (_, beside)): (&(usize, Vec<f64>), &(usize, Vec<f64>))| {
            Some((*i, start_slope::first_certain(here, beside)?))
        };
        self.certain = pairs.filter_map(first).collect();
    }

    /// The first term of a switch that decides on a direction within a time.
    fn deciding(&self, i: usize, series: &Series, reach: f64) -> Option<usize> {
        let switch = series.switch(i);
        if let Some(&(_, k)) = self.certain.iter().find(|(of, _)| *of == i) {
            return Some(k);
        }
        // whatever forces do later, at first it goes on as it came
        let goes_on =
            |&(of, rate): &(usize, f64)| of == i && is_same_rate(switch[1] / series.scale(), rate);
        if self.arrival.iter().any(goes_on) {
            return Some(1);
        }
        first_that_matters(switch, reach, self.significant())
    }

    /// From here on the motion counts as touching its surface only, until it moves. Returns whether that is new.
    pub(super) fn touch(&mut self) -> bool {
        !std::mem::replace(&mut self.touched, true)
    }

    fn significant(&self) -> f64 {
        if self.touched { TOUCHED } else { SIGNIFICANT }
    }

    /// Whether the motion moves to the chosen sides; `step` is how far the series is valid, `stride` the length of the
    /// last steps, if there were any.
    pub(super) fn leads_on(&self, series: &Series, step: f64, stride: f64) -> bool {
        let reach = (step / series.scale().abs()).min(1.0).min(known_ahead(series, stride));
        self.on_surface.iter().all(|&i| {
            let is_off = self.begins && is_off_surface(series, i, step, stride);
            self.leads_on_at(series, i, if is_off { None } else { Some(reach) })
        })
    }

    /// The switches that are not on their sides, with those on which they are: beside the surfaces by their values at the origin, or
    /// their first terms where they are zero there, since they have jumped, or are zero to rounding; on a surface where they are zero
    /// for a while, or no longer.
    pub(super) fn opposite(&self, series: &Series) -> Vec<(usize, Side)> {
        let opposite = |i: usize| {
            let (now, side) = (series.sides()[i], side_of(series.switch(i)));
            let is_free = !self.on_surface.contains(&i) || now == Side::Level;
            let may_leave = is_free && !(now == Side::Between && series.switch(i)[0] == 0.0);
            let may_be_level = side == Side::Level && now != Side::Between;
            (side != now && (may_leave || may_be_level)).then_some((i, side))
        };
        (0..series.switches()).filter_map(opposite).collect()
    }

    /// Forgets the surfaces on which a motion does not begin after all, by the sides of other switches.
    pub(super) fn begin_beside(&mut self, series: &Series, step: f64) {
        if std::mem::take(&mut self.begins) {
            let is_off = |i: usize| {
                series.sides()[i] != Side::Between && is_off_surface(series, i, step, 0.0)
            };
            self.on_surface.retain(|&i| !is_off(i));
        }
    }

    /// The first surface that the series meets before `end`, in its unit of time; `stride` as in
    /// [`leads_on`](Kinks::leads_on).
    pub(super) fn first(&self, series: &Series, end: f64, stride: f64) -> Option<KinkCrossing> {
        // what matters to a direction is decided over as long a time as where the direction is chosen
        let reach = end.min(1.0).min(known_ahead(series, stride));
        let met = |i: usize, end: f64| match series.sides()[i] {
            Side::Between => leaves_weight(series.weight(i), end),
            side => self.leaves_side(i, series, side, (end, reach)),
        };
        let mut earliest: Option<(f64, usize)> = None;
        for i in 0..series.switches() {
            let end = earliest.map_or(end, |(x, _)| x);
            if let Some(x) = met(i, end) {
                earliest = Some((x, i));
            }
        }
        let (x, first) = earliest?;
        let width = TOGETHER * end.min(x.max(1e-6 * end));
        // a surface that was only touched before is not met again here
        let together =
            |&i: &usize| i == first || met(i, x + width).is_some_and(|other| other >= x - width);
        let switches: Vec<usize> = (0..series.switches()).filter(together).collect();
        let after = match series.sides()[first] {
            Side::Between => DoubleDouble::from(x),
            _ => self.polish(series, first, x),
        };
        let rate = |&i: &usize| Some((i, rate_of_crossing(series.switch(i), x)? / series.scale()));
        let rates = switches.iter().filter_map(rate).collect();
        Some(KinkCrossing { after, switches, rates })
    }

    /// Ends a step on a surface, or on none. Returns false if the time no longer advances.
    pub(super) fn arrive(
        &mut self,
        crossing: Option<KinkCrossing>,
        series: &Series,
        state: &mut State,
    ) -> bool {
        let moved = state.exact_time() != series.time();
        self.stalled = if moved { 0 } else { self.stalled + 1 };
        self.touched = !moved && (self.touched || self.stalled >= STALLS);
        self.certain.clear();
        self.arrival.clear();
        self.begins = false;
        if let (Some(crossing), true) = (&crossing, moved) {
            self.arrival.clone_from(&crossing.rates);
        }
        self.on_surface = crossing.map_or(Vec::new(), |crossing| crossing.switches);
        for &i in &self.on_surface {
            // a number of the state that has reached zero is zero, not a rounding error
            if let (Some(number), true) = (series.switch_number(i), moved) {
                state.set(number, DoubleDouble::ZERO);
            }
        }
        self.stalled < MOST_STALLED
    }

    /// Whether the motion moves to the chosen side of a surface, that is whether the term of the switch that decides has
    /// that sign. One that is off the surface by the sides of others, where there is no `reach`, or stays where it is, as that of
    /// max(0, sign(t)) at t = 0, has its value.
    fn leads_on_at(&self, series: &Series, i: usize, reach: Option<f64>) -> bool {
        let sign = match series.sides()[i] {
            Side::Between => return series.weight(i)[0].abs() <= 1.0 + 1e-12,
            Side::Level => return side_of(series.switch(i)) == Side::Level,
            Side::Positive => 1.0,
            Side::Negative => -1.0,
        };
        let switch = series.switch(i);
        match reach.and_then(|reach| self.deciding(i, series, reach)) {
            Some(k) => sign * switch[k] > 0.0,
            None => sign * switch[0] >= 0.0,
        }
    }

    /// The point where a switch leaves its side. If the step begins on its surface, the switch
    /// begins with its first term that is significant over the time `reach`, whatever rounding makes of those before it.
    fn leaves_side(
        &self,
        i: usize,
        series: &Series,
        side: Side,
        (end, reach): (f64, f64),
    ) -> Option<f64> {
        let switch = series.switch(i);
        let sign = if side == Side::Negative { -1.0 } else { 1.0 };
        let from = if self.on_surface.contains(&i) { self.deciding(i, series, reach)? } else { 0 };
        let mut signed = [0.0; 64];
        let signed = &mut signed[..switch.len() - from];
        for (c, x) in signed.iter_mut().zip(&switch[from..]) {
            *c = sign * x;
        }
        falls(signed, end)
    }

    /// Refines a root to the precision of the series' lowest orders.
    fn polish(&self, series: &Series, i: usize, x: f64) -> DoubleDouble {
        let origin = if self.on_surface.contains(&i) {
            series.switch_after(i, DoubleDouble::ZERO)
        } else {
            DoubleDouble::ZERO
        };
        refined(series.switch(i), x, |x| series.switch_after(i, x) - origin)
    }
}

/// A direction is chosen by what the motion does in no more than this many of its last steps. Where its numbers are
/// polynomials of the time a series has no end, and the velocity of arrival is nothing beside what forces do in so long.
const AHEAD: f64 = 1e6;

/// The rate of change of a switch at its zero, in the unit of the series; `None` where its terms cancel there, so that it is no better
/// known than their rounding, or where the zero is of a higher order.
fn rate_of_crossing(switch: &[f64], x: f64) -> Option<f64> {
    let slope = value_and_slope(switch, x).1;
    let term = |(k, c): (usize, &f64)| (c * math::powi(x, k as i32)).abs();
    let largest = switch.iter().enumerate().map(term).fold(0.0, f64::max);
    ((slope * x).abs() > TRANSVERSAL * largest).then_some(slope)
}

/// Whether a switch leaves its surface as fast as it came there.
fn is_same_rate(now: f64, before: f64) -> bool {
    (now - before).abs() <= SAME * before.abs()
}

/// The side of a switch just after the origin.
pub(super) fn side_of(switch: &[f64]) -> Side {
    match switch.iter().find(|x| **x != 0.0) {
        Some(x) if *x < 0.0 => Side::Negative,
        Some(_) => Side::Positive,
        None => Side::Level,
    }
}

/// Whether the motion is off the surface of a switch, beyond the rounding of one that it is on; `step` and `stride` as in
/// [`leads_on`](Kinks::leads_on).
pub(super) fn is_off_surface(series: &Series, i: usize, step: f64, stride: f64) -> bool {
    let reach = (step / series.scale().abs()).min(1.0).min(known_ahead(series, stride));
    let switch = series.switch(i);
    let powers = std::iter::successors(Some(reach), |x| Some(x * reach));
    let terms = switch.iter().skip(1).zip(powers).map(|(c, x)| (c * x).abs());
    switch[0].abs() > SIGNIFICANT * terms.fold(0.0, f64::max)
}

/// How far ahead, in the unit of the series, a direction may be decided; unlimited where there was no step.
fn known_ahead(series: &Series, stride: f64) -> f64 {
    if stride > 0.0 { AHEAD * stride / series.scale().abs() } else { f64::INFINITY }
}

/// The first term beyond the constant one that is not negligible relative to the largest at a time.
fn first_that_matters(switch: &[f64], time: f64, significant: f64) -> Option<usize> {
    let terms = || {
        let powers = std::iter::successors(Some(time), |x| Some(x * time));
        switch.iter().enumerate().skip(1).zip(powers).map(|((k, c), x)| (k, (c * x).abs()))
    };
    let largest = terms().fold(0.0_f64, |m, (_, term)| m.max(term));
    terms().find(|(_, term)| *term > significant * largest).map(|(k, _)| k)
}

/// The point where a weight leaves [−1, 1]. One that begins at the edge may leave at once.
fn leaves_weight(weight: &[f64], end: f64) -> Option<f64> {
    let edge = |sign: f64| {
        let mut distance = [0.0; 64];
        for (d, w) in distance.iter_mut().zip(weight) {
            *d = -sign * w;
        }
        distance[0] = 1.0 - sign * weight[0];
        let from = usize::from(distance[0] < 1e-12);
        falls(&distance[from..weight.len()], end)
    };
    match (edge(1.0), edge(-1.0)) {
        (Some(a), Some(b)) => Some(a.min(b)),
        (one, None) | (None, one) => one,
    }
}

/// The point where a polynomial that should be positive falls below zero: at once, later, or never.
fn falls(coefficients: &[f64], end: f64) -> Option<f64> {
    match coefficients.iter().find(|c| **c != 0.0) {
        Some(c) if *c < 0.0 => Some(0.0),
        Some(_) => first_crossing(coefficients, end),
        None => None,
    }
}

/// The choices of sides to try, the likeliest first: through the surface; back or through; staying
/// on it.
fn candidates(before: &[Side]) -> Vec<Vec<Side>> {
    let through = |side: &Side| match side {
        Side::Positive => Side::Negative,
        Side::Negative | Side::Between | Side::Level => Side::Positive,
    };
    let flipped: Vec<Side> = before.iter().map(through).collect();
    let mut all = vec![flipped];
    if before.len() > COMBINED {
        all.push(vec![Side::Between; before.len()]);
        return all;
    }
    let sides = [Side::Positive, Side::Negative, Side::Between];
    let mut others: Vec<Vec<Side>> = vec![Vec::new()];
    for _ in before {
        let longer = |list: &Vec<Side>| {
            sides.map(|side| list.iter().copied().chain([side]).collect::<Vec<_>>())
        };
        others = others.iter().flat_map(longer).collect();
    }
    others.sort_by_key(|list| list.iter().filter(|side| **side == Side::Between).count());
    all.extend(others);
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_direction_is_reported_by_a_term_above_a_billionth() {
        assert_eq!(first_that_matters(&[0.0, 2e-9, 1.0], 1.0, SIGNIFICANT), Some(1));
        assert_eq!(first_that_matters(&[0.0, 0.5e-9, 1.0], 1.0, SIGNIFICANT), Some(2));
        // in the unit of the time in question
        assert_eq!(first_that_matters(&[0.0, 0.5e-9, 1.0], 0.1, SIGNIFICANT), Some(1));
    }

    /// (x − 1)(x − 1 − d) has the slope −d at 1, and its largest term there is 2 + d.
    #[test]
    fn a_switch_crosses_zero_where_a_thousandth_of_its_terms_is_left_of_its_rate() {
        for (apart, crosses) in [(2.1e-3, true), (1.9e-3, false)] {
            for unit in [1e-9, 1.0, 1e9] {
                let switch = [1.0 + apart, -(2.0 + apart) / unit, 1.0 / (unit * unit)];
                let rate = rate_of_crossing(&switch, unit);
                assert_eq!(rate.is_some(), crosses, "{apart} in {unit}");
                assert!(
                    rate.is_none_or(|rate| (rate * unit / -apart - 1.0).abs() < 1e-9),
                    "{rate:?}"
                );
            }
        }
    }

    #[test]
    fn a_rate_is_that_of_arrival_to_a_billionth() {
        for rate in [-1e-12, 1.0, 1e12] {
            for (part, same) in [(0.9e-9, true), (-0.9e-9, true), (1.1e-9, false), (-1.1e-9, false)]
            {
                assert_eq!(is_same_rate(rate * (1.0 + part), rate), same, "{part:e} of {rate:e}");
            }
        }
    }

    #[test]
    fn five_switches_are_tried_in_every_combination_and_six_are_not() {
        assert_eq!(candidates(&[Side::Positive; 5]).len(), 1 + 243);
        assert_eq!(candidates(&[Side::Positive; 6]).len(), 2);
    }
}
