//! A motion by extrapolated midpoint steps (Gragg 1965, Bulirsch & Stoer 1966), with kinks located to the last bit; the
//! program's own methods are compared with it.

use super::case::Case;
use super::oracle::{after_impulse, rates};
use super::tree::Branches;

/// Columns of the table: the last is of order 12.
const COLUMNS: usize = 6;

/// A kink is located at least to this time.
const NEAREST: f64 = 1e-24;

/// The end of a motion.
#[derive(Clone, Debug)]
pub(crate) struct Arrival {
    pub(crate) time: f64,
    pub(crate) state: Vec<f64>,
    /// Whether the event ended it.
    pub(crate) stopped: bool,
    /// Times and states during the motion.
    pub(crate) way: Vec<(f64, Vec<f64>)>,
}

/// The reason why there is no motion for comparison.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Lost {
    /// The first rates cannot be computed.
    AtStart,
    /// A pole, or the end of a domain.
    NotFinite,
    /// It would take too long.
    TooLong,
    /// The motion rests on a kink, or meets them in ever shorter intervals.
    Sticks,
    /// It does not keep its own energy.
    Inaccurate,
}

struct Walker<'a> {
    case: &'a Case,
    tolerance: f64,
    branches: Branches,
    budget: u64,
    /// The greatest component so far: errors are relative to it, as those of the program's results are.
    scale: f64,
}

/// The scale of a motion that has not left the origin.
const LEAST_SCALE: f64 = 1e-3;

/// Rates that change by more than this multiple of what they and the state were are looked at again.
const CHANGED: f64 = 10.0;

/// A step leads back if it misses its beginning by no more than this multiple of the tolerance, which the motion backwards may
/// enlarge; and by how much rounding alone does.
const RETURN: f64 = 1e4;
const LEAST_RETURN: f64 = 1e-13;

/// An attempted step.
struct Step {
    state: Vec<f64>,
    error: f64,
    /// Whether it crosses a kink.
    crossed: bool,
}

/// Follows the case to its end; `budget` is a number of evaluations.
pub(crate) fn follow(
    case: &Case,
    start: &[f64],
    tolerance: f64,
    budget: u64,
) -> Result<Arrival, Lost> {
    let scale = start.iter().fold(LEAST_SCALE, |most, x| most.max(x.abs()));
    let mut walker = Walker { case, tolerance, branches: Branches::default(), budget, scale };
    let mut state = start.to_vec();
    let mut time = 0.0;
    let mut way = Vec::new();
    if let Some((at, i, by)) = case.impulse.filter(|(at, ..)| *at <= case.length) {
        let stopped = walker.to(&mut time, &mut state, at, &mut way)?;
        if stopped {
            return Ok(Arrival { time, state, stopped, way });
        }
        state = after_impulse(case, time, &state, i, by).ok_or(Lost::NotFinite)?;
    }
    let free = Case { constraint: None, release: None, ..case.clone() };
    if let Some(at) = case.release.filter(|at| *at <= case.length && case.constraint.is_some()) {
        let stopped = walker.to(&mut time, &mut state, at, &mut way)?;
        if stopped {
            return Ok(Arrival { time, state, stopped, way });
        }
        let Walker { budget, scale, .. } = walker;
        walker = Walker { case: &free, tolerance, branches: Branches::default(), budget, scale };
    }
    let stopped = walker.to(&mut time, &mut state, case.length, &mut way)?;
    Ok(Arrival { time, state, stopped, way })
}

impl Walker<'_> {
    fn rates(&mut self, time: f64, state: &[f64]) -> Result<Vec<f64>, Lost> {
        self.budget = self.budget.checked_sub(1).ok_or(Lost::TooLong)?;
        Ok(rates(self.case, time, state, &mut self.branches))
    }

    /// Whether a value lies on the other side of its branch.
    fn crossed(&self) -> bool {
        let pairs = self.branches.values.iter().zip(&self.branches.above);
        pairs.into_iter().any(|(value, above)| match above {
            Some(true) => *value < 0.0,
            Some(false) => *value > 0.0,
            None => false,
        })
    }

    /// Chooses the branches on which the motion is about to be.
    fn choose(&mut self, time: f64, state: &[f64]) -> Result<(), Lost> {
        self.branches = Branches::default();
        let rate = self.rates(time, state)?;
        if rate.iter().any(|r| !r.is_finite()) {
            return Err(if time == 0.0 { Lost::AtStart } else { Lost::NotFinite });
        }
        let values = self.branches.values.clone();
        let mut above: Vec<Option<bool>> = values.iter().map(|v| Some(*v > 0.0)).collect();
        if values.contains(&0.0) {
            // half a step ahead, including accelerations
            let h = 1e-6_f64;
            let mut ahead: Vec<f64> =
                state.iter().zip(&rate).map(|(x, r)| h.mul_add(*r, *x)).collect();
            let later = self.rates(time + h, &ahead)?;
            for (x, (r, s)) in ahead.iter_mut().zip(rate.iter().zip(&later)) {
                *x += 0.5 * h * (s - r);
            }
            self.branches.above.clear();
            self.rates(time + h, &ahead)?;
            for (side, (value, later)) in
                above.iter_mut().zip(values.iter().zip(&self.branches.values))
            {
                if *value == 0.0 {
                    if *later == 0.0 {
                        return Err(Lost::Sticks);
                    }
                    *side = Some(*later > 0.0);
                }
            }
        }
        self.branches.above = above;
        Ok(())
    }

    fn to(
        &mut self,
        time: &mut f64,
        state: &mut Vec<f64>,
        end: f64,
        way: &mut Vec<(f64, Vec<f64>)>,
    ) -> Result<bool, Lost> {
        self.choose(*time, state)?;
        let stop = self.case.stop.as_ref().map(|_| self.branches.above.len() - 1);
        let mut h = (0.01_f64).min(end - *time);
        let mut hurried = 0;
        while *time < end {
            h = h.min(end - *time);
            if *time + h <= *time {
                return Err(Lost::NotFinite);
            }
            let step = self.step(*time, state, h)?;
            // a NaN error is too large
            if step.error.is_nan() || step.error > 1.0 {
                let factor = 0.9 * step.error.powf(-1.0 / (2.0 * COLUMNS as f64 - 1.0));
                h *= if factor.is_finite() { factor.clamp(0.1, 0.9) } else { 0.2 };
                continue;
            }
            if !step.crossed {
                if self.is_changed(*time, state, &step, h)?
                    && !self.leads_back(*time, state, &step, h)?
                {
                    h *= 0.5;
                    continue;
                }
                let last = end - *time <= h * (1.0 + 1e-12);
                *time = if last { end } else { *time + h };
                *state = step.state;
                self.scale = state.iter().fold(self.scale, |most, x| most.max(x.abs()));
                way.push((*time, state.clone()));
                let factor = 0.9 * (step.error + 1e-10).powf(-1.0 / (2.0 * COLUMNS as f64 - 1.0));
                h *= factor.clamp(0.5, 4.0);
                hurried = 0;
                continue;
            }
            // the shortest step that crosses
            let (mut low, mut high) = (0.0, h);
            // to the last bit of the step, not of the time: where accelerations are huge even that bit of the time is
            // seen in the state
            while high - low > NEAREST.max(f64::EPSILON * high) {
                let middle = f64::midpoint(low, high);
                if middle <= low || middle >= high {
                    break;
                }
                if self.step(*time, state, middle)?.crossed {
                    high = middle;
                } else {
                    low = middle;
                }
            }
            let step = self.step(*time, state, high)?;
            // the estimate of the longer step, on a branch continued beyond its kink, says nothing of this one: powers
            // between 1 and 2 are approached in steps that their own estimates allow
            if step.error.is_nan()
                || step.error > 1.0
                || !self.leads_back(*time, state, &step, high)?
            {
                h = 0.5 * high;
                continue;
            }
            hurried = if high < 1e-9 { hurried + 1 } else { 0 };
            if hurried > 3 {
                return Err(Lost::Sticks);
            }
            *time += high;
            *state = step.state;
            way.push((*time, state.clone()));
            self.rates(*time, state)?;
            let pairs = self.branches.values.iter().zip(&mut self.branches.above);
            for (k, (value, above)) in pairs.enumerate() {
                if *above == Some(true) && *value < 0.0 || *above == Some(false) && *value > 0.0 {
                    *above = above.map(|side| !side);
                    if stop == Some(k) {
                        return Ok(true);
                    }
                }
            }
            h = h.min(0.1);
        }
        Ok(false)
    }

    /// Whether the rates at the end of a step are of another size than at its beginning.
    fn is_changed(&mut self, time: f64, state: &[f64], step: &Step, h: f64) -> Result<bool, Lost> {
        let before = self.rates(time, state)?;
        let after = self.rates(time + h, &step.state)?;
        let largest = before.iter().chain(state).fold(LEAST_SCALE, |most, x| most.max(x.abs()));
        Ok(before.iter().zip(&after).any(|(a, b)| (a - b).abs() > CHANGED * largest))
    }

    /// Whether the same step backwards leads to where it began. Rates that are large only in a narrow place are seen at none of the
    /// points of a step that ends there, so its own estimate says nothing of them; a step that begins there sees them first.
    fn leads_back(&mut self, time: f64, state: &[f64], step: &Step, h: f64) -> Result<bool, Lost> {
        let back = self.step(time + h, &step.state, -h)?;
        let errors = back.state.iter().zip(state).zip(&step.state).map(|((a, b), end)| {
            let size = 1.0 + b.abs().max(end.abs()).max(self.scale);
            (a - b).abs() / (self.tolerance.max(LEAST_RETURN) * size)
        });
        Ok(errors.fold(0.0, |most: f64, e| if e.is_nan() { f64::INFINITY } else { most.max(e) })
            <= RETURN)
    }

    fn step(&mut self, time: f64, state: &[f64], h: f64) -> Result<Step, Lost> {
        let first = self.rates(time, state)?;
        let mut table: Vec<Vec<f64>> = Vec::new();
        let mut previous = Vec::new();
        let mut crossed = false;
        for k in 0..COLUMNS {
            let count = 2 * (k + 1);
            let part = h / count as f64;
            let mut before = state.to_vec();
            let mut now: Vec<f64> = state.iter().zip(&first).map(|(x, r)| x + part * r).collect();
            crossed = false;
            for i in 1..count {
                let rate = self.rates(time + i as f64 * part, &now)?;
                crossed |= self.crossed();
                let next = before.iter().zip(&rate).map(|(x, r)| x + 2.0 * part * r).collect();
                before = std::mem::replace(&mut now, next);
            }
            let mut row = vec![now];
            for j in 1..=k {
                let ratio = ((k + 1) as f64 / (k + 1 - j) as f64).powi(2) - 1.0;
                let pairs = row[j - 1].iter().zip(&table[j - 1]);
                row.push(pairs.map(|(a, b)| a + (a - b) / ratio).collect());
            }
            previous.clone_from(&row[k.saturating_sub(1)]);
            table = row;
        }
        let state_after = table[COLUMNS - 1].clone();
        let error = state_after
            .iter()
            .zip(&previous)
            .zip(state)
            .map(|((a, b), x)| {
                let size = (1.0 + a.abs().max(x.abs())).min(self.scale.max(a.abs()));
                (a - b).abs() / (self.tolerance * size)
            })
            .fold(0.0, |most: f64, e| if e.is_nan() { f64::INFINITY } else { most.max(e) });
        if error.is_finite() && error <= 1.0 {
            self.rates(time + h, &state_after)?;
            crossed |= self.crossed();
        }
        Ok(Step { state: state_after, error, crossed })
    }
}
