//! Locates zero crossings of the events' functions along a step, beyond the last digit of time,
//! since the effect of an impulse there shows in the last digits after it.
//!
//! In: a motion that has taken a step, the functions. Out: the first crossing that counts. Never here: what follows from it.
//!
//! If the step is a power series in time, so is every function along it wherever it is analytic,
//! and all roots of these polynomials are found piece by piece. Without a series, and across kinks
//! and poles, the functions are sampled.

mod jumps;
mod vanishing;

use super::DenseOutput;
use super::clock::{DIGITS, spacing};
use super::located_event::{Crossing, EventRole, LocatedEvent, LocatedEvents, first};
use super::piece_count::PieceCount;
use super::polynomial::StepPolynomial;
use super::probe::Probe;
use super::root_correction::RootCorrection;
use super::roots::{CUT_OFF, root_error, sign_changes};
use super::sampling::{Sampling, leaving};
use super::series_piece::SeriesPiece;
use crate::model::Direction;
use crate::num::DoubleDouble;
use crate::system::{CompiledEvent, EventFunctions, MotionError, State};

/// At a root of its series a function is less than this part of its terms.
const VANISHES: f64 = 1e-6;

/// How often the minimal interval is doubled about the zero of a root: up to half of the digits of time.
const MOST_DOUBLED: u32 = 24;

/// After an impulse the sign of a function may change again very soon, after this part of the time.
const SOONEST: f64 = 2e-15;

#[derive(Clone, Debug)]
pub(super) struct EventLocator {
    probe: Probe,
    directions: Vec<Direction>,
    /// What each event does to the motion.
    roles: Vec<EventRole>,
    /// Whether each function has zeros that are no rounding.
    may_cross: Vec<bool>,
    /// The functions that are zero all along, which therefore never cross, and since when.
    vanishing: Vec<(usize, f64)>,
    /// The last known side of zero of each function; zero if unknown.
    sides: Vec<f64>,
    /// When each of them last crossed zero in a direction that counts, or left it with an impulse; NaN before it has.
    last: Vec<f64>,
    /// What else is at the time of the event that was found last.
    beside: LocatedEvents,
    /// Whether an impulse has just changed the state.
    fresh: bool,
    /// The values of the functions that leave their zeros then, that of the event that caused it and what a constraint held,
    /// and the part of their course that is rounding.
    leaving: Vec<Option<[f64; 2]>>,
    /// The time up to which the functions were found to be simple.
    simple: Option<f64>,
    pieces: PieceCount,
    /// The last end of an interval, with the decimal number it is written as: the next one mostly
    /// begins there.
    end: (f64, DoubleDouble),
}

/// The roots of the functions' series on a piece.
enum PieceRoots {
    /// The first crossing that counts, if there is one.
    First(Option<LocatedEvent>),
    /// A function does not vanish at a root of its series.
    Misleading,
}

impl EventLocator {
    pub(super) fn new(
        event_functions: EventFunctions,
        events: &[CompiledEvent],
        blank: State,
    ) -> EventLocator {
        let count = events.len();
        let may_cross = (0..count).map(|event| event_functions.may_cross(event)).collect();
        EventLocator {
            probe: Probe::new(event_functions, count, blank),
            directions: events.iter().map(|event| event.direction).collect(),
            roles: events.iter().map(|event| EventRole::of(event.action)).collect(),
            may_cross,
            vanishing: Vec::new(),
            sides: vec![0.0; count],
            last: vec![f64::NAN; count],
            beside: LocatedEvents::default(),
            fresh: false,
            leaving: vec![None; count],
            simple: None,
            pieces: PieceCount::NONE,
            end: (f64::NAN, DoubleDouble::ZERO),
        }
    }

    /// The decimal number that a time is written as.
    fn written(&mut self, time: f64) -> DoubleDouble {
        if self.end.0 != time {
            self.end = (time, DoubleDouble::from_decimal(time));
        }
        self.end.1
    }

    pub(super) fn set_parameters(&mut self, parameters: &[f64]) {
        self.probe.event_functions().set_parameters(parameters);
        self.simple = None;
    }

    /// Forgets how far the functions are simple and what else happens now, when the motion changes.
    pub(super) fn turn(&mut self) {
        self.simple = None;
        self.beside = LocatedEvents::default();
    }

    /// The next event at a time at which one has been found, if the state is still the same.
    pub(super) fn next_at(&mut self, time: f64) -> Option<LocatedEvent> {
        let (next, side) = self.beside.next_at(time)?;
        self.sides[next.event] = side;
        self.last[next.event] = next.exact.high;
        Some(next)
    }

    /// Forgets the sides of the functions.
    pub(super) fn forget(&mut self) {
        self.sides.fill(0.0);
        self.last.fill(f64::NAN);
        self.fresh = false;
        self.probe.begin(None);
        self.simple = None;
    }

    /// The value of a function at a state; `None` if it has none there.
    pub(super) fn value(&mut self, event: usize, state: &State) -> Option<f64> {
        self.probe.of(state).ok().map(|values| values[event]).filter(|value| !value.is_nan())
    }

    /// Returns the first crossing that counts between two times of the motion's last step, as far
    /// as the functions can be followed at once, and the time up to which they were followed.
    pub(super) fn scan(
        &mut self,
        motion: &mut dyn DenseOutput,
        from: f64,
        to: f64,
    ) -> Result<(Option<LocatedEvent>, f64), MotionError> {
        let (found, end) = self.scanned(motion, from, to)?;
        if let Some(found) = &found {
            self.last[found.event] = found.exact.high;
        }
        Ok((found, end))
    }

    fn scanned(
        &mut self,
        motion: &mut dyn DenseOutput,
        from: f64,
        to: f64,
    ) -> Result<(Option<LocatedEvent>, f64), MotionError> {
        if from >= to {
            return Ok((None, to));
        }
        if self.keep_sides(motion, from, to) {
            self.pass();
            return Ok((None, to));
        }
        let Some((piece, beyond)) = self.piece(motion, from, to) else {
            self.pieces.count(motion.interval().0, from)?;
            let end = self.simple_until(motion, from, to)?;
            let found = self.sampled(motion, from, end, end >= to)?;
            if found.is_some() {
                self.pieces.begin();
            }
            return Ok((found, end));
        };
        let shortest = DIGITS * spacing(from);
        let end = (piece.from + DoubleDouble::from(piece.unit) * piece.length).high.min(to);
        if end - from >= shortest || end >= to {
            self.pieces.shortest = 0;
            let known = self.sides.clone();
            if let PieceRoots::First(found) = self.roots(motion, &piece, (from, end), end >= to)? {
                return Ok((found, end));
            }
            // the series belong to another branch, or are rounding
            self.sides = known;
            self.pieces.count(motion.interval().0, from)?;
            let end = self.simple_until(motion, from, end)?;
            return Ok((self.sampled(motion, from, end, end >= to)?, end));
        }
        // a kink or a pole; about the zero of a root its series is rounding over ever so many digits
        let doubled =
            if self.probe.event_functions().has_branches() { self.pieces.shortest } else { 0 };
        let end = (from + shortest * f64::from(1 << doubled.min(MOST_DOUBLED))).min(to);
        self.pieces.note_length(from, beyond)?;
        Ok((self.sampled(motion, from, end, end >= to)?, end))
    }

    /// Passes over a piece of a step on which all functions surely stay on their known sides.
    pub(super) fn pass(&mut self) {
        (self.fresh, self.pieces.shortest) = (false, 0);
    }

    /// The last known side of zero of each function; zero if unknown.
    pub(super) fn sides(&self) -> &[f64] {
        &self.sides
    }

    /// Whether all functions surely stay on their known sides from the beginning of a power-series step to a time in it:
    /// mostly the sizes of their terms show it, and nothing else is to be done.
    fn keep_sides(&mut self, motion: &dyn DenseOutput, from: f64, to: f64) -> bool {
        let Some(series) = motion.series() else { return false };
        let (origin, unit) = (series.time(), series.scale());
        let begun = self.probe.not_before(origin) == origin;
        if !begun || from != origin.high || unit <= 0.0 {
            return false;
        }
        let whole = (to - from + 2.0 * spacing(to)) / unit;
        self.probe.event_functions().keep_signs(series, &self.sides, (CUT_OFF, whole))
    }

    /// The piece that begins at a time within a power-series step and on which the functions are
    /// represented by their own series. If it ends before the requested end, there may be a kink
    /// there. Also returns how far beyond the piece the functions are represented.
    fn piece(
        &mut self,
        motion: &dyn DenseOutput,
        from: f64,
        to: f64,
    ) -> Option<(SeriesPiece, f64)> {
        let series = motion.series()?;
        let (origin, unit) = (series.time(), series.scale());
        // where the ends of the step are known exactly, those of a piece are the same
        let end = motion.exact_end();
        let begins = end.is_some() && from == origin.high;
        let from = if begins { origin } else { self.written(from) };
        let from = self.probe.not_before(from);
        let x = ((from - origin) / unit).high.max(0.0);
        let to = end.filter(|end| end.high == to).unwrap_or_else(|| self.written(to));
        let whole = ((to - from) / unit).high;
        if unit <= 0.0 || whole <= 0.0 {
            return None;
        }
        let event_functions = self.probe.event_functions();
        let valid = event_functions.expand(series, x, (CUT_OFF, whole))?;
        let mut length = valid;
        for sign in event_functions.expanded_branch_signs() {
            if let Some(change) = sign_changes(&sign, length).next() {
                // digits there, not at the end of the step, which may be much later
                let there = (from + DoubleDouble::from(change.x) * unit).high;
                let digits = 0.5 * DIGITS * spacing(there) / unit;
                length = (change.x - digits.max(root_error(&sign, change.x))).max(0.0);
            }
        }
        Some((SeriesPiece { from, unit, length }, valid * unit))
    }

    /// The first crossing that counts on a piece. The next piece detects one at the end, if it is not the `last`.
    fn roots(
        &mut self,
        motion: &mut dyn DenseOutput,
        piece: &SeriesPiece,
        (from, to): (f64, f64),
        is_last: bool,
    ) -> Result<PieceRoots, MotionError> {
        self.fresh = false;
        let reference = if from == 0.0 { to } else { from.abs() };
        let (length, soonest) = (piece.length, SOONEST * reference / piece.unit);
        let mut passed = Vec::new();
        for event in 0..self.sides.len() {
            if !self.may_cross[event] {
                passed.push(Vec::new());
                continue;
            }
            let coefficients = self.probe.event_functions().expanded(event);
            let mut polynomial = StepPolynomial { coefficients, length, soonest };
            let doubtful = polynomial.coefficients[0] * self.sides[event] <= 0.0;
            if doubtful || polynomial.begins_at_zero() {
                // the series has only the digits of an `f64`, which where its terms cancel (sin θ at π, slowly passed) may
                // be too few for the sign
                let exact = self.probe.exactly_at(motion, event, piece.from)?.high;
                let jumps = self.probe.event_functions().may_jump()
                    && (exact - polynomial.coefficients[0]).abs() > VANISHES * polynomial.size();
                // on a jump itself it has neither the value before nor that after it, which the series has
                if !jumps {
                    polynomial.coefficients[0] = exact;
                }
            }
            let crossings = self.follow(motion, event, &polynomial, piece, to, is_last)?;
            if self.probe.event_functions().has_branches() {
                let vanishing = VANISHES * polynomial.size();
                for crossing in &crossings {
                    let value = self.probe.exactly_at(motion, event, crossing.exact)?.high;
                    if value.abs() > vanishing || value.is_nan() {
                        return Ok(PieceRoots::Misleading);
                    }
                }
            }
            passed.push(crossings);
        }
        Ok(PieceRoots::First(self.take(&passed, to)))
    }

    /// The crossings of one function, in order of time, up to the first that counts.
    fn follow(
        &mut self,
        motion: &mut dyn DenseOutput,
        event: usize,
        polynomial: &StepPolynomial,
        piece: &SeriesPiece,
        to: f64,
        is_last: bool,
    ) -> Result<Vec<Crossing>, MotionError> {
        let course = polynomial.follow(self.sides[event]);
        let mut crossings = Vec::new();
        // just behind a root of a higher order its sign is rounding
        let begun = piece.from.high;
        let has_crossed = (begun - self.last[event]).abs() <= DIGITS * spacing(begun);
        if self.sides[event] == 0.0 {
            self.sides[event] = course.side;
        } else if !has_crossed && course.side != 0.0 && course.side != self.sides[event] {
            crossings.push(Crossing::at(piece.from, course.side));
        }
        let direction = self.directions[event];
        for change in &course.changes {
            if crossings.last().is_some_and(|last| last.counts(direction)) {
                return Ok(crossings);
            }
            if change.side == crossings.last().map_or(self.sides[event], |last| last.side) {
                continue;
            }
            let exact = piece.from + DoubleDouble::from(change.x) * piece.unit;
            let mut crossing = Crossing::at(exact, change.side);
            // a change that does not count tells the side, which beside a double zero at a kink would be that of its rounding
            let is_rounding = polynomial.is_rounding_after(change.x);
            if crossing.counts(direction) || is_rounding {
                let probe = &mut self.probe;
                let mut root = RootCorrection { probe, motion, event, polynomial, piece };
                let exact = if is_rounding {
                    root.bracketed(change.x, change.side)?
                } else {
                    root.correct(change.x, change.side)?
                };
                let Some(exact) = exact else { continue };
                crossing.exact = exact;
            }
            crossings.push(crossing);
        }
        let side = crossings.last().map_or(self.sides[event], |last| last.side);
        let counted = crossings.last().is_some_and(|last| last.counts(direction));
        if is_last && !counted && polynomial.ends_at_zero(side) {
            // it crosses at the very end of the piece, which may be the time of an output row or an
            // impulse
            let probe = &mut self.probe;
            let mut root = RootCorrection { probe, motion, event, polynomial, piece };
            if !polynomial.ends_flat() {
                crossings.push(Crossing::at(self.written(to), -side));
            } else if let Some(exact) = root.bracketed(piece.length, -side)? {
                crossings.push(Crossing::at(exact, -side));
            }
        }
        for crossing in crossings.iter_mut().filter(|c| c.exact.high > to) {
            crossing.exact = self.written(to);
        }
        Ok(crossings)
    }

    /// The end, at most `to`, of the interval that begins at a time within the last step and on
    /// which the functions are simple.
    fn simple_until(
        &mut self,
        motion: &mut dyn DenseOutput,
        from: f64,
        to: f64,
    ) -> Result<f64, MotionError> {
        if let Some(end) = self.simple.filter(|&end| end > from) {
            return Ok(end.min(to));
        }
        let length = self.probe.resolved(motion, from, to - from)?.unwrap_or(f64::INFINITY);
        self.pieces.note_length(from, length)?;
        let end = from + length.max(DIGITS * spacing(from));
        self.simple = Some(end);
        Ok(end.min(to))
    }

    /// The first crossing that counts on an interval on which the functions are simple.
    fn sampled(
        &mut self,
        motion: &mut dyn DenseOutput,
        from: f64,
        to: f64,
        is_last: bool,
    ) -> Result<Option<LocatedEvent>, MotionError> {
        let soonest = SOONEST * if from == 0.0 { to } else { from.abs() };
        let soonest = std::mem::take(&mut self.fresh).then_some(soonest);
        let leaves = soonest.is_some();
        let probe = &mut self.probe;
        let mut sampling = Sampling { probe, motion, whole: (from, to), is_last };
        let samples = sampling.samples(self.sides.len(), soonest)?;
        let mut passed: Vec<Vec<Crossing>> = Vec::new();
        // functions that leave a zero, and when each shows to which side
        let mut left = Vec::new();
        for (event, samples) in samples.iter().enumerate() {
            if !self.may_cross[event] {
                passed.push(Vec::new());
                continue;
            }
            let own = (event, self.directions[event]);
            let (known, last) = (&mut self.sides[event], self.last[event]);
            let zero = self.leaving[event].take().filter(|_| leaves);
            let samples = zero.map_or(&samples[..], |residual| leaving(samples, residual));
            if let (Some(residual), Some(first)) = (zero, samples.first()) {
                left.push((event, residual, first.time()));
            }
            passed.push(sampling.follow(own, samples, known, last)?);
        }
        let found = self.take(&passed, to);
        // what happens before changes the motion, and perhaps the side
        for (event, residual, shown) in left {
            if found.is_some_and(|found| found.event != event && found.exact.high < shown) {
                (self.sides[event], self.leaving[event]) = (0.0, Some(residual));
            }
        }
        Ok(found)
    }

    /// The first of all crossings that counts; what else happens at its time is kept.
    fn take(&mut self, passed: &[Vec<Crossing>], to: f64) -> Option<LocatedEvent> {
        let how = (&self.directions[..], &self.roles[..]);
        self.beside = first(passed, how, &mut self.sides, to);
        self.beside.next().map(|(found, _)| found)
    }
}
