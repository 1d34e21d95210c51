//! The image of a state under a transformation that cannot be written down, followed along a motion.
//!
//! In: the relations between (q, p) and (Q, P), a time, a state. Out: (Q, P) on the branch of the last image, or NaN where
//! there is none. Never here: whether the map is canonical.
//!
//! The relations are solved by Newton's method from the last image. At a caustic, det ∂²F/∂old∂new = 0, the branch ends;
//! the state after the first one without an image may take another branch. Where the relations only break down at a place, as
//! ½ q² cot Q does at q = 0, the image continues as before.
//! Source: *The Principles of Dynamics*, § 3.2.1.

use std::sync::Arc;

use super::program::Program;
use super::rhs::ProgramBuilder;
use super::solve::Factored;
use super::value::Evaluator;
use crate::expr::Symbol;
use crate::mechanics::{Flow, ImplicitMap, guesses};
use crate::num::{DoubleDouble, Real};

/// The maximal numbers of steps, and of halvings of a step.
const STEPS: u32 = 100;
const HALVINGS: u32 = 12;

/// Nothing is found where so many steps leave more than half of the residual: even at a double root each leaves a quarter.
const STALLED: u32 = 8;

/// A step is the last but one if it is this small relative to each number.
const SMALL: f64 = 1e-14;

/// A step is the last but one as well if it is this small relative to the largest number, where another passes
/// through zero.
const ROUNDING: f64 = 1e-25;

/// If the first step leaves at most this part of the residual, it leads to the solution nearest to the guess.
const TAME: f64 = 0.25;

/// An image went on evenly if it is off by less than this part of the way.
const EVEN: f64 = 0.1;

/// For maps one after the other so many numbers are guessed.
const SPREAD: usize = 40;

/// The numbers of parts into which the way from the last state is divided.
const PARTS: [u32; 4] = [1, 4, 16, 64];

/// The relations of one map, and an image near the start.
#[derive(Clone, Debug)]
pub(super) struct ImageProgram {
    /// A program of (q, native rates, auxiliary numbers, Q, P): the relations, then their derivatives with respect to Q
    /// and P by rows.
    program: Arc<Program>,
    example: Vec<f64>,
    /// The number of guesses of which nothing is known.
    spread: usize,
}

impl ImageProgram {
    pub(super) fn of(
        (map, example): &(ImplicitMap, Vec<f64>),
        builder: &mut ProgramBuilder<'_>,
    ) -> Result<ImageProgram, Symbol> {
        let equations = builder.equations;
        let mut lowering = builder.on_full_state();
        if let Flow::Lagrange { .. } = equations.flow {
            let momenta = lowering.lower_all(&equations.momenta);
            for (c, p) in equations.coordinates.iter().zip(momenta) {
                lowering.bind(c.momentum, p);
            }
        }
        for &symbol in &map.new {
            let new = lowering.input();
            lowering.bind(symbol, new);
        }
        let mut outputs = lowering.lower_all(&map.relations);
        outputs.extend(map.by_new.iter().flat_map(|row| lowering.lower_all(row)));
        let program = lowering.finish(outputs)?;
        // a search in vain costs as many times more for maps one after the other
        let spread = if map.own.is_empty() { SPREAD / example.len() } else { usize::MAX };
        Ok(ImageProgram { program, example: example.clone(), spread })
    }
}

/// The image of the last state, from which the next one follows.
#[derive(Clone, Debug)]
pub(super) struct MapImage {
    values: Evaluator<DoubleDouble>,
    factored: Factored<DoubleDouble>,
    example: Vec<f64>,
    spread: usize,
    /// The last state that had an image, and the image.
    last: Option<Known>,
    /// Whether the last state had none.
    lost: bool,
    /// A state, then a trial image.
    inputs: Vec<DoubleDouble>,
}

#[derive(Clone, Debug)]
struct Known {
    time: DoubleDouble,
    state: Vec<DoubleDouble>,
    image: Vec<DoubleDouble>,
    /// The rate at which it came here; empty where nothing was known before.
    rate: Vec<DoubleDouble>,
}

impl Known {
    /// The image at a time if it continues at the same rate.
    fn extrapolated(&self, time: DoubleDouble) -> Vec<DoubleDouble> {
        let elapsed = time - self.time;
        self.image.iter().zip(&self.rate).map(|(&x, &rate)| x + rate * elapsed).collect()
    }

    /// The rate from here to an image at another time; empty if that is the same.
    fn rate_to(&self, time: DoubleDouble, image: &[DoubleDouble]) -> Vec<DoubleDouble> {
        let elapsed = time - self.time;
        if elapsed == DoubleDouble::ZERO {
            return Vec::new();
        }
        image.iter().zip(&self.image).map(|(&x, &before)| (x - before) / elapsed).collect()
    }
}

impl MapImage {
    pub(super) fn new(of: &ImageProgram) -> MapImage {
        MapImage {
            factored: Factored::new(of.example.len()),
            inputs: vec![DoubleDouble::ZERO; of.program.inputs()],
            values: Evaluator::new(Arc::clone(&of.program)),
            example: of.example.clone(),
            spread: of.spread,
            last: None,
            lost: false,
        }
    }

    /// The number of new variables.
    pub(super) fn len(&self) -> usize {
        self.example.len()
    }

    pub(super) fn set_parameters(&mut self, parameters: &[DoubleDouble]) {
        self.values.set_parameters(parameters);
        // what was known belongs to other relations, but is near
        if let Some(known) = self.last.take() {
            self.example = known.image.iter().map(|x| x.value()).collect();
        }
        self.lost = false;
    }

    /// Writes the image of a state (q, native rates, auxiliary numbers).
    pub(super) fn write(
        &mut self,
        time: DoubleDouble,
        state: &[DoubleDouble],
        out: &mut [DoubleDouble],
    ) {
        let followed = self.last.take().map(|known| (self.follow(&known, time, state), known));
        let mut rate = Vec::new();
        let image = match followed {
            Some((Some(image), known)) => {
                rate = known.rate_to(time, &image);
                Some(image)
            }
            // one state without an image parts what lies on two branches
            Some((None, known)) if !self.lost => {
                self.last = Some(known);
                None
            }
            Some((None, known)) => {
                let last = [known.extrapolated(time), known.image.clone()];
                let found = self.search(time, state, &last);
                self.last = Some(known);
                found
            }
            None => self.search(time, state, &[]),
        };
        self.lost = image.is_none();
        match image {
            Some(image) => {
                out.copy_from_slice(&image);
                self.last = Some(Known { time, state: state.to_vec(), image, rate });
            }
            None => out.fill(DoubleDouble::from(f64::NAN)),
        }
    }

    fn follow(
        &mut self,
        known: &Known,
        time: DoubleDouble,
        state: &[DoubleDouble],
    ) -> Option<Vec<DoubleDouble>> {
        if let Some(image) = self.ahead(known, time, state) {
            return Some(image);
        }
        PARTS.into_iter().find_map(|parts| {
            let mut image = known.image.clone();
            for part in 1..=parts {
                let share = f64::from(part) / f64::from(parts);
                let between = |a: DoubleDouble, b: DoubleDouble| {
                    if part == parts { b } else { a + (b - a) * share }
                };
                for ((x, &a), &b) in self.inputs.iter_mut().zip(&known.state).zip(state) {
                    *x = between(a, b);
                }
                let (found, left) = self.newton(between(known.time, time), &image)?;
                if left > TAME {
                    return None;
                }
                image = found;
            }
            Some(image)
        })
    }

    /// The image that is where a known one would be by now if it went on evenly; `None` if there is none so near that the way
    /// here was nearly even.
    fn ahead(
        &mut self,
        known: &Known,
        time: DoubleDouble,
        state: &[DoubleDouble],
    ) -> Option<Vec<DoubleDouble>> {
        let guess = known.extrapolated(time);
        if guess.len() < self.len() {
            return None;
        }
        let apart = |a: &[DoubleDouble], b: &[DoubleDouble]| {
            a.iter().zip(b).map(|(&a, &b)| (a - b).value().abs()).fold(0.0, f64::max)
        };
        self.inputs[..state.len()].copy_from_slice(state);
        let (found, _) = self.newton(time, &guess)?;
        (apart(&found, &guess) <= EVEN * apart(&guess, &known.image)).then_some(found)
    }

    /// An image by Newton's method from several guesses.
    fn search(
        &mut self,
        time: DoubleDouble,
        state: &[DoubleDouble],
        last: &[Vec<DoubleDouble>],
    ) -> Option<Vec<DoubleDouble>> {
        let n = self.len();
        self.inputs[..state.len()].copy_from_slice(state);
        let doubles = |guess: Vec<f64>| guess.into_iter().map(DoubleDouble::from).collect();
        let example = doubles(self.example.clone());
        let given = last.iter().cloned().chain([example]).filter(|guess| guess.len() == n);
        let spread = guesses(n).take(self.spread).map(doubles);
        given.chain(spread).find_map(|guess| Some(self.newton(time, &guess)?.0))
    }

    /// The solution of the relations at the state in `inputs` by Newton's method, with the part of the residual that the
    /// first step leaves.
    fn newton(
        &mut self,
        time: DoubleDouble,
        guess: &[DoubleDouble],
    ) -> Option<(Vec<DoubleDouble>, f64)> {
        let n = self.len();
        let mut image = guess.to_vec();
        let mut left = None;
        let mut size = self.residual(time, &image)?;
        let mut before = f64::INFINITY;
        for step in 0..STEPS {
            if step % STALLED == 0 {
                if size > 0.5 * before {
                    return None;
                }
                before = size;
            }
            if size == 0.0 {
                return Some((image, left.unwrap_or(0.0)));
            }
            let values = &self.values;
            if !self.factored.factor(|i, j| values.output(n + i * n + j)) {
                return None;
            }
            let mut step: Vec<DoubleDouble> = (0..n).map(|i| self.values.output(i)).collect();
            self.factored.solve(&mut step);
            let largest = image.iter().map(|x| x.value().abs()).fold(0.0, f64::max);
            let is_small = |(x, d): (&DoubleDouble, &DoubleDouble)| {
                d.value().abs() <= (SMALL * x.value().abs()).max(ROUNDING * largest)
            };
            let done = image.iter().zip(&step).all(is_small);
            let mut part = 1.0;
            let mut moved = None;
            for _ in 0..HALVINGS {
                let trial: Vec<_> = image.iter().zip(&step).map(|(&x, &d)| x - d * part).collect();
                let after = self.residual(time, &trial);
                if let Some(after) = after.filter(|&after| after < size || done) {
                    moved = Some((trial, after));
                    break;
                }
                part *= 0.5;
            }
            let (trial, after) = moved?;
            if done {
                return Some((trial, left.unwrap_or(0.0)));
            }
            left.get_or_insert(after / size);
            (image, size) = (trial, after);
        }
        None
    }

    /// The size of what is left of the relations at a trial image; `None` where they have no values.
    fn residual(&mut self, time: DoubleDouble, image: &[DoubleDouble]) -> Option<f64> {
        let state = self.inputs.len() - image.len();
        self.inputs[state..].copy_from_slice(image);
        self.values.evaluate(time, &self.inputs).ok()?;
        let all = (0..image.len()).map(|i| self.values.output(i).value());
        let size = all.fold(0.0, |sum, x| sum + x * x).sqrt();
        size.is_finite().then_some(size)
    }
}
