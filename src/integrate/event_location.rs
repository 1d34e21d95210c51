//! Where along a step a function of the state crosses zero: looked for on the dense output, located
//! beyond the last digit of time: what an impulse there does shows in the last digits after it.
//!
//! In: a stepper that has taken a step, the functions. Out: the first crossing that counts. Never
//! here: what follows from it.
//!
//! A function is followed from look to look by its values and slopes (cubic interpolation); where
//! it is not what its ends foretell, the piece is halved, so that functions that change faster than
//! the motion are not stepped over, and neither are two zeros within one piece.

use super::Stepper;
use super::clock::spacing;
use crate::model::Direction;
use crate::num::{DoubleDouble, math};
use crate::system::{EventFunctions, MotionError, MotionErrorKind, State};

/// Into how many pieces a stretch on which the functions are simple is cut at first.
const PIECES: usize = 4;

/// A stretch is not shorter than so many digits of the clock: at a pole there is no simple one, …
const DIGITS: f64 = 16.0;

/// … but so many of these in a row are no pole: a function changes faster than the clock can tell.
const MOST_SHORTEST: u32 = 64;

/// How far a look goes beyond the zero of a secant, in parts of the way to it.
const BEYOND: f64 = 1.01;

/// A value between two looks may differ from what they foretell by this part of its size.
const PREDICTED: f64 = 0.02;

/// How often a piece may be halved.
const HALVINGS: u32 = 14;

/// The part of a piece over which a slope is taken.
const SLOPE_OVER: f64 = 1e-5;

/// After an impulse the sign of a function may change again very soon: the first looks are then at
/// halves of halves of the step, down to this part of the time.
const SOONEST: f64 = 2e-15;

/// A value below this part of those beside it has no sign that could be trusted.
const SIGNLESS: f64 = 1e-13;

/// Where the functions of the events stand.
#[derive(Clone, Debug)]
pub(super) struct EventLocator {
    event_functions: EventFunctions,
    directions: Vec<Direction>,
    /// The side of zero each function was on last; zero where that is not known.
    sides: Vec<f64>,
    /// Whether an impulse has just changed the state.
    fresh: bool,
    /// When the last impulse fell: the motion after it is not to be asked about earlier times.
    begun: Option<DoubleDouble>,
    /// Up to here the functions were found to be simple.
    simple: Option<f64>,
    /// How many stretches in a row were as short as may be.
    shortest: u32,
    values: Vec<f64>,
    state: State,
}

/// An event found.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct LocatedEvent {
    pub(super) event: usize,
    /// Of this the nearest `f64` is the time.
    pub(super) exact: DoubleDouble,
}

/// A look at one function.
#[derive(Clone, Copy, Debug)]
struct Sample {
    time: f64,
    value: f64,
    slope: f64,
}

/// A crossing of one function.
#[derive(Clone, Copy, Debug)]
struct Crossing {
    exact: DoubleDouble,
    /// The side it leads to.
    side: f64,
}

impl EventLocator {
    pub(super) fn new(
        event_functions: EventFunctions,
        directions: Vec<Direction>,
        blank: State,
    ) -> EventLocator {
        let count = directions.len();
        EventLocator {
            event_functions,
            directions,
            sides: vec![0.0; count],
            fresh: false,
            begun: None,
            simple: None,
            shortest: 0,
            values: vec![0.0; count],
            state: blank,
        }
    }

    pub(super) fn set_parameters(&mut self, parameters: &[f64]) {
        self.event_functions.set_parameters(parameters);
        self.simple = None;
    }

    /// The motion goes on otherwise than it did.
    pub(super) fn turn(&mut self) {
        self.simple = None;
    }

    /// Forgets where the functions stood.
    pub(super) fn forget(&mut self) {
        self.sides.fill(0.0);
        self.fresh = false;
        self.begun = None;
        self.simple = None;
    }

    /// An impulse has led from one state to another, by the event given or by none: functions that
    /// jumped with it did not cross zero.
    pub(super) fn after_impulse(
        &mut self,
        before: &State,
        after: &State,
        event: Option<usize>,
    ) -> Result<(), MotionError> {
        let mut old = vec![0.0; self.sides.len()];
        self.event_functions.look(before, &mut old)?;
        self.event_functions.look(after, &mut self.values)?;
        for (i, (old, new)) in old.iter().zip(&self.values).enumerate() {
            if event == Some(i) || (old - new).abs() > 1e-12 * (old.abs() + new.abs()) {
                self.sides[i] = 0.0;
            }
        }
        self.fresh = true;
        self.begun = Some(after.exact_time());
        self.simple = None;
        Ok(())
    }

    /// A constraint was let go at a state: functions that did not jump with it stand where `known`
    /// has them.
    pub(super) fn inherit(
        &mut self,
        mut known: EventLocator,
        state: &State,
    ) -> Result<(), MotionError> {
        known.event_functions.look(state, &mut known.values)?;
        self.event_functions.look(state, &mut self.values)?;
        for (i, (old, new)) in known.values.iter().zip(&self.values).enumerate() {
            let same = (old - new).abs() <= 1e-12 * (old.abs() + new.abs());
            self.sides[i] = if same { known.sides[i] } else { 0.0 };
        }
        self.fresh = true;
        Ok(())
    }

    /// Where the stretch ends that begins at a time within the last step and on which the functions
    /// are simple; `to` at the latest.
    pub(super) fn stretch(
        &mut self,
        stepper: &mut dyn Stepper,
        from: f64,
        to: f64,
    ) -> Result<f64, MotionError> {
        if from >= to {
            return Ok(to);
        }
        if let Some(end) = self.simple.filter(|&end| end > from) {
            return Ok(end.min(to));
        }
        self.move_to(stepper, from)?;
        let length = self.event_functions.resolved(&self.state, to - from).unwrap_or(f64::INFINITY);
        let shortest = DIGITS * spacing(from);
        self.shortest = if length < shortest { self.shortest + 1 } else { 0 };
        if self.shortest > MOST_SHORTEST {
            let kind = MotionErrorKind::ClockStands(spacing(from));
            return Err(MotionError { time: from, kind, place: Vec::new() });
        }
        let end = from + length.max(shortest);
        self.simple = Some(end);
        Ok(end.min(to))
    }

    /// The first crossing that counts, between two times of the stepper's last step, on a
    /// [stretch](Crossings::stretch).
    pub(super) fn first(
        &mut self,
        stepper: &mut dyn Stepper,
        from: f64,
        to: f64,
    ) -> Result<Option<LocatedEvent>, MotionError> {
        if from >= to {
            return Ok(None);
        }
        let mut looks: Vec<Vec<Sample>> = vec![Vec::new(); self.sides.len()];
        let soonest = SOONEST * if from == 0.0 { to } else { from.abs() };
        let fresh = std::mem::take(&mut self.fresh);
        let early = if fresh { math::log2((to - from) / soonest).ceil() as i32 } else { 0 };
        let early = (3..early).rev().map(|k| math::powi(0.5, k));
        let parts = (0..=PIECES).map(|k| k as f64 / PIECES as f64);
        let mut parts: Vec<f64> = early.chain(parts).collect();
        parts.sort_by(f64::total_cmp);
        for part in parts {
            let time = if part == 1.0 { to } else { from + (to - from) * part };
            let width = (to - from) * part.max(1.0 / PIECES as f64);
            for (i, look) in self.look(stepper, time, width, (from, to))?.into_iter().enumerate() {
                looks[i].push(look);
            }
        }
        let mut found: Option<LocatedEvent> = None;
        let mut passed: Vec<Vec<Crossing>> = Vec::new();
        for (event, looks) in looks.iter().enumerate() {
            let crossings = self.follow(stepper, event, looks, (from, to))?;
            let counts = crossings.last().filter(|c| self.counts(event, c));
            if let Some(crossing) = counts
                && found.is_none_or(|first| earlier(crossing.exact, first.exact))
            {
                found = Some(LocatedEvent { event, exact: crossing.exact });
            }
            passed.push(crossings);
        }
        let until = found.map_or(to, |found| found.exact.high);
        for (event, crossings) in passed.iter().enumerate() {
            let mine = found.is_some_and(|found| found.event == event);
            let mut gone = crossings.iter().filter(|c| c.exact.high < until || mine);
            if let Some(last) = gone.next_back() {
                self.sides[event] = last.side;
            }
        }
        Ok(found)
    }

    /// Looks at all functions at a time within the last step; slopes are taken over a small part
    /// of `width`.
    fn look(
        &mut self,
        stepper: &mut dyn Stepper,
        time: f64,
        width: f64,
        (from, to): (f64, f64),
    ) -> Result<Vec<Sample>, MotionError> {
        self.move_to(stepper, time)?;
        self.event_functions.look(&self.state, &mut self.values)?;
        let here = self.values.clone();
        // not so small that the clock's last digit decides
        let step = (width * SLOPE_OVER).max(1e-14 * time.abs());
        let beside = if time + step <= to { time + step } else { (time - step).max(from) };
        self.move_to(stepper, beside)?;
        self.event_functions.look(&self.state, &mut self.values)?;
        let looks = here.iter().zip(&self.values).map(|(&value, &next)| {
            let slope = if beside == time { 0.0 } else { (next - value) / (beside - time) };
            Sample { time, value, slope }
        });
        Ok(looks.collect())
    }

    /// The state at a time within the last step, though not before the last impulse.
    fn move_to(&mut self, stepper: &mut dyn Stepper, time: f64) -> Result<(), MotionError> {
        match self.begun.filter(|&begun| earlier(DoubleDouble::written(time), begun)) {
            Some(begun) => stepper.at_exactly(begun, &mut self.state),
            None => stepper.at(time, &mut self.state),
        }
    }

    /// Whether a crossing is one the event waits for.
    fn counts(&self, event: usize, crossing: &Crossing) -> bool {
        match self.directions[event] {
            Direction::Rising => crossing.side > 0.0,
            Direction::Falling => crossing.side < 0.0,
            Direction::Either => true,
        }
    }

    /// The crossings of one function, in time, up to the first that counts.
    fn follow(
        &mut self,
        stepper: &mut dyn Stepper,
        event: usize,
        looks: &[Sample],
        whole: (f64, f64),
    ) -> Result<Vec<Crossing>, MotionError> {
        let mut walk = Search { event, whole, side: self.sides[event], found: Vec::new() };
        for pair in looks.windows(2) {
            if walk.side == 0.0 {
                walk.side = sign(pair[0], pair[1]);
                self.sides[event] = walk.side;
            }
            if self.piece(stepper, &mut walk, pair[0], pair[1], HALVINGS)? {
                break;
            }
        }
        if let (true, [.., before, last]) = (walk.side == 0.0, looks) {
            self.sides[event] = sign(*last, *before);
        }
        Ok(walk.found)
    }

    /// Follows a function over one piece; true where a crossing that counts was found.
    fn piece(
        &mut self,
        stepper: &mut dyn Stepper,
        walk: &mut Search,
        a: Sample,
        b: Sample,
        halvings: u32,
    ) -> Result<bool, MotionError> {
        let time = 0.5 * (a.time + b.time);
        if time <= a.time || time >= b.time {
            return self.end(stepper, walk, a, b);
        }
        let width = b.time - a.time;
        let middle = self.look(stepper, time, width, walk.whole)?[walk.event];
        let predicted = 0.5 * (a.value + b.value) + width * (a.slope - b.slope) / 8.0;
        let steep = 1.5 * (b.value - a.value) / width - 0.25 * (a.slope + b.slope);
        let size = a.value.abs().max(b.value.abs()).max(middle.value.abs());
        let off = (middle.value - predicted).abs().max((middle.slope - steep).abs() * width / 8.0);
        let surprise = off > PREDICTED * size;
        if surprise && halvings > 0 {
            return Ok(self.piece(stepper, walk, a, middle, halvings - 1)?
                || self.piece(stepper, walk, middle, b, halvings - 1)?);
        }
        Ok(self.turned(stepper, walk, a, middle)? || self.turned(stepper, walk, middle, b)?)
    }

    /// A piece on which the function has one turning point at most: looks there, too, where it lies
    /// towards zero.
    fn turned(
        &mut self,
        stepper: &mut dyn Stepper,
        walk: &mut Search,
        a: Sample,
        b: Sample,
    ) -> Result<bool, MotionError> {
        let same_side = a.value * b.value > 0.0;
        let towards = a.value * a.slope < 0.0 && b.value * b.slope > 0.0;
        if !(same_side && towards) {
            return self.end(stepper, walk, a, b);
        }
        let (mut left, mut right) = (a, b);
        for _ in 0..60 {
            // the turning point of a function with these slopes
            let part = left.slope / (left.slope - right.slope);
            let time = left.time + (right.time - left.time) * part.clamp(0.05, 0.95);
            if time <= left.time || time >= right.time {
                break;
            }
            let width = right.time - left.time;
            let look = self.look(stepper, time, width, walk.whole)?[walk.event];
            if look.value * a.value <= 0.0 {
                return Ok(self.end(stepper, walk, a, look)? || self.end(stepper, walk, look, b)?);
            }
            if look.slope * a.value < 0.0 {
                left = look;
            } else {
                right = look;
            }
            let rest = (left.slope.abs() + right.slope.abs()) * (right.time - left.time);
            if rest < 1e-3 * look.value.abs() {
                break;
            }
        }
        self.end(stepper, walk, a, b)
    }

    /// A piece with one crossing at most: notes it.
    fn end(
        &mut self,
        stepper: &mut dyn Stepper,
        walk: &mut Search,
        a: Sample,
        b: Sample,
    ) -> Result<bool, MotionError> {
        let side = sign(b, a);
        if side == 0.0 && b.time == walk.whole.1 && b.slope * walk.side < 0.0 {
            // it crosses just where the step ends, as one does that ends there for a row or an impulse
            let crossing = Crossing { exact: DoubleDouble::written(b.time), side: -walk.side };
            walk.side = -walk.side;
            walk.found.push(crossing);
            return Ok(self.counts(walk.event, &crossing));
        }
        if side == 0.0 || side == walk.side {
            return Ok(false);
        }
        if walk.side == 0.0 {
            walk.side = side;
            self.sides[walk.event] = side;
            return Ok(false);
        }
        let exact = self.locate(stepper, walk.event, side, a.time, b.time)?;
        walk.side = side;
        let crossing = Crossing { exact, side };
        walk.found.push(crossing);
        Ok(self.counts(walk.event, &crossing))
    }

    /// The time of a crossing between two, after which the function is on `side`: halving, mixed
    /// with the secant's step kept inside (R. P. Brent, Algorithms for Minimization without
    /// Derivatives, ch. 4, has the reasons), down to neighbouring times, and a secant between these.
    fn locate(
        &mut self,
        stepper: &mut dyn Stepper,
        event: usize,
        side: f64,
        mut left: f64,
        mut right: f64,
    ) -> Result<DoubleDouble, MotionError> {
        let mut low = self.exactly(stepper, event, left)?;
        let mut high = self.exactly(stepper, event, right)?;
        if low.high * side > 0.0 {
            return Ok(DoubleDouble::written(left));
        }
        for round in 0..200 {
            let middle = 0.5 * (left + right);
            if middle <= left || middle >= right {
                break;
            }
            // a little beyond the secant's zero, so that the farther end comes near, too
            let part = low.high / (low.high - high.high);
            let digit = spacing(right.abs().max(left.abs()));
            let secant = if part < 0.5 {
                left + (right - left) * part * BEYOND + digit
            } else {
                right - (right - left) * (1.0 - part) * BEYOND - digit
            };
            let inside = secant > left && secant < right && round % 4 != 3;
            let time = if inside { secant } else { middle };
            let value = self.exactly(stepper, event, time)?;
            if value.high == 0.0 {
                return Ok(DoubleDouble::written(time));
            }
            if value.high * side > 0.0 {
                (right, high) = (time, value);
            } else {
                (left, low) = (time, value);
            }
        }
        // the states looked at were those at these times
        let (left, right) = (DoubleDouble::written(left), DoubleDouble::written(right));
        let part = low / (low - high);
        Ok(if part.is_finite() { left + (right - left) * part } else { left })
    }

    fn exactly(
        &mut self,
        stepper: &mut dyn Stepper,
        event: usize,
        time: f64,
    ) -> Result<DoubleDouble, MotionError> {
        self.move_to(stepper, time)?;
        self.event_functions.exactly(event, &self.state)
    }
}

fn earlier(a: DoubleDouble, b: DoubleDouble) -> bool {
    (a - b).high < 0.0
}

/// One function on its way through a step.
struct Search {
    event: usize,
    whole: (f64, f64),
    side: f64,
    found: Vec<Crossing>,
}

/// The side of zero a function is on; none where its value may be rounding.
fn sign(here: Sample, beside: Sample) -> f64 {
    let value = here.value;
    if value.abs() > SIGNLESS * beside.value.abs() { value.signum() } else { 0.0 }
}
