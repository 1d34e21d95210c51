//! Enclosures of a law over a box of times and states: whether anything in it is narrower than the box.
//!
//! A high power, what is divided by, and the argument of an exponential function may change by orders of magnitude between
//! two states, so that neither shows what lies between them, as a thin barrier or a steep wall. Interval arithmetic bounds each of
//! them over the box. One is resolved there if it changes by no more than a factor, or if all its changes together are nothing
//! beside what they are added to: that is followed from the rates backwards, as derivatives are.
//!
//! In: intervals of the time and of the numbers of a state. Out: whether all is resolved, the rounding of rates. Never here: steps.
//!
//! Source: R. E. Moore, R. B. Kearfott, M. J. Cloud, Introduction to Interval Analysis (SIAM, 2009).

use std::sync::Arc;

use super::compiled::System;
use super::program::{Op, Program, Register};
use crate::expr::FunctionId;
use crate::num::{DoubleDouble, Interval, math};

/// A product of this degree may have its first term beyond the last order of a series.
const STEEP: f64 = 6.0;

/// The ratio of the bounds of what is resolved, e².
const RATIO: f64 = 7.389;

/// The width of the argument of a function that is resolved.
const WIDE: f64 = 2.0;

/// Beyond this argument exponentials leave the range of `f64`, and functions that saturate with them no longer change.
const SATURATED: f64 = 750.0;

/// Beyond the first of these arguments a hyperbolic tangent is 1 to all digits; below the negative of the second an exponential is
/// nothing beside the inverse of anything.
const LIMITS: (f64, f64) = (40.0, 1e4);

/// Numbers are at the ends of the range of `f64` below the first of these, and above the second.
const RANGE: (f64, f64) = (1e-290, 1e290);

/// A change by this part is none, to all digits of double-double.
const NOTHING: f64 = 1e-32;

/// The rounding of one operation, in parts of its result.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// What may be narrow.
#[derive(Clone, Copy, Debug)]
enum Narrow {
    /// A number whose order of magnitude counts: a high power, or what is divided by.
    Size(Register),
    /// A power whose exponent depends on parameters.
    ParametricPower(Register, Register),
    /// The function with an argument.
    Function(FunctionId, Register, Register),
}

/// Encloses the registers of the law of a system.
#[derive(Clone, Debug)]
pub struct Enclosure {
    program: Arc<Program>,
    narrow: Vec<Narrow>,
    /// Of which of these nothing can be told, not even at a point.
    unknown: Vec<bool>,
    registers: Vec<Interval>,
    /// By how much each register may change without an effect.
    harmless: Vec<f64>,
    /// The rounding of each register.
    rounding: Vec<f64>,
}

impl System {
    /// Allocates the enclosure of the motion's law, whose inputs are the numbers of a state in [`System::form`].
    pub fn enclosure(&self) -> Enclosure {
        let program = Arc::clone(&self.motion().native);
        let count = program.ops.len();
        let narrow = narrow(&program);
        Enclosure {
            unknown: vec![false; narrow.len()],
            narrow,
            registers: vec![Interval::ALL; count],
            harmless: vec![0.0; count],
            rounding: vec![0.0; count],
            program,
        }
    }
}

impl Enclosure {
    /// Takes other values, in the order of the model, for all evaluations to come.
    pub fn set_parameters(&mut self, parameters: &[DoubleDouble]) {
        let program = Arc::clone(&self.program);
        for &r in &program.prologue {
            match program.ops[r as usize] {
                Op::Parameter(i) => {
                    self.registers[r as usize] = Interval::of(parameters[i as usize]);
                }
                op => self.evaluate(&program, r, op),
            }
        }
    }

    /// Encloses all registers over an interval of times, and one of each number that the rates depend on.
    pub fn enclose(&mut self, time: Interval, numbers: impl Iterator<Item = Interval>) {
        let program = Arc::clone(&self.program);
        for (&r, x) in program.inputs.iter().zip(numbers) {
            self.registers[r as usize] = x;
        }
        for &r in &program.body {
            match program.ops[r as usize] {
                Op::Time => self.registers[r as usize] = time,
                op => self.evaluate(&program, r, op),
            }
        }
    }

    /// Asks for everything narrow again.
    pub fn ask_all(&mut self) {
        self.unknown.fill(false);
    }

    /// Gives up what is not even resolved at the point that was enclosed last, as quotients of what is beyond the range of numbers.
    pub fn give_up(&mut self) {
        for i in 0..self.narrow.len() {
            self.unknown[i] = !self.resolves(self.narrow[i]);
        }
    }

    /// Whether everything narrow is resolved over the box that was enclosed last, where the rates may change by so much each
    /// without an effect.
    pub fn is_resolved(&mut self, harmless: impl Iterator<Item = f64>) -> bool {
        let known = self.narrow.iter().zip(&self.unknown).filter(|(_, unknown)| !**unknown);
        let known = known.map(|(narrow, _)| *narrow);
        if known.clone().all(|narrow| self.resolves(narrow)) {
            return true;
        }
        self.find_harmless(harmless);
        let registers = &self.registers;
        let known = self.narrow.iter().zip(&self.unknown).filter(|(_, unknown)| !**unknown);
        known.map(|(narrow, _)| *narrow).all(|narrow| {
            let register = match narrow {
                Narrow::Size(r) | Narrow::ParametricPower(r, _) => r,
                Narrow::Function(function, value, argument) => {
                    let has_companion = matches!(function, FunctionId::Sin | FunctionId::Sinh);
                    let beside = value + Register::from(has_companion);
                    let is_harmless = |r: Register| is_harmless(registers, &self.harmless, r);
                    if is_harmless(value) && is_harmless(beside) {
                        return true;
                    }
                    argument
                }
            };
            self.resolves(narrow) || is_harmless(registers, &self.harmless, register)
        })
    }

    /// The rounding of a rate at a point that was enclosed last, where the numbers have these errors.
    pub fn rounding(&mut self, errors: impl Iterator<Item = f64>) -> impl Iterator<Item = f64> {
        let program = Arc::clone(&self.program);
        for (&r, error) in program.inputs.iter().zip(errors) {
            self.rounding[r as usize] = error;
        }
        for &r in &program.body {
            self.round(&program, r);
        }
        let Enclosure { program, rounding, .. } = self;
        program.outputs.iter().map(|&r| rounding[r as usize])
    }

    fn at(&self, r: Register) -> Interval {
        self.registers[r as usize]
    }

    fn evaluate(&mut self, program: &Program, r: Register, op: Op) {
        let at = |r: Register| self.registers[r as usize];
        let value = match op {
            Op::Constant(c) => Interval::of(program.constants[c as usize]),
            Op::Linear { constant, first, count } => {
                let terms = &program.terms[first as usize..(first + count) as usize];
                let constant = Interval::of(program.constants[constant as usize]);
                terms.iter().fold(constant, |sum, term| {
                    sum + Interval::of(term.coefficient) * at(term.register)
                })
            }
            Op::Scale(a, b) | Op::Multiply(a, b) => at(a) * at(b),
            Op::Square(a) => at(a).square(),
            Op::Divide(a, b) => at(a) * at(b).recip(),
            Op::Root(a) => at(a).root(),
            Op::Power(a, exponent) => at(a).power(program.constants[exponent as usize].high),
            Op::ParametricPower(a, exponent) => at(a).power(at(exponent).low),
            Op::Call(function, [a, b]) => {
                let (value, companion) = of_function(function, at(a), at(b));
                self.registers[r as usize + 1] = companion;
                value
            }
            Op::Select { switch, positive, negative, .. } => match at(switch) {
                // a function is continuous up to its kink, or has a step there
                side if side.low >= 0.0 && side.high > 0.0 => at(positive),
                side if side.high <= 0.0 && side.low < 0.0 => at(negative),
                _ => at(positive).hull(at(negative)),
            },
            Op::Solve(block) => {
                let n = program.blocks[block as usize].size();
                self.registers[r as usize..][..n].fill(Interval::ALL);
                return;
            }
            Op::Parameter(_) | Op::Time | Op::Input(_) | Op::Written => return,
        };
        self.registers[r as usize] = value;
    }

    /// Whether what may be narrow changes by no more than its function shows.
    fn resolves(&self, narrow: Narrow) -> bool {
        match narrow {
            Narrow::Size(r) => has_one_size(self.at(r)),
            Narrow::ParametricPower(r, exponent) => {
                (0.0..STEEP).contains(&self.at(exponent).low) || has_one_size(self.at(r))
            }
            Narrow::Function(function, value, argument) => {
                let (u, value) = (self.at(argument), self.at(value));
                match function {
                    FunctionId::Exp | FunctionId::Sinh | FunctionId::Cosh | FunctionId::Tanh => {
                        u.low.clamp(-SATURATED, SATURATED) + WIDE
                            >= u.high.clamp(-SATURATED, SATURATED)
                    }
                    FunctionId::Ln => has_one_size(u),
                    FunctionId::Atan => u.width() <= WIDE || has_one_size(u),
                    FunctionId::Tan | FunctionId::Cot => {
                        value.width() <= WIDE || has_one_size(value)
                    }
                    _ => u.width() <= WIDE,
                }
            }
        }
    }

    /// Follows what has no effect on the rates back to all registers.
    fn find_harmless(&mut self, outputs: impl Iterator<Item = f64>) {
        let program = Arc::clone(&self.program);
        self.harmless.fill(f64::INFINITY);
        for (&r, x) in program.outputs.iter().zip(outputs) {
            let own = &mut self.harmless[r as usize];
            *own = own.min(x);
        }
        for &r in program.body.iter().rev() {
            let value = self.at(r);
            let own = self.harmless[r as usize];
            let change = own.max(NOTHING * value.mignitude());
            let mut lower = |r: Register, x: f64| {
                let part = &mut self.harmless[r as usize];
                *part = part.min(if x.is_nan() { 0.0 } else { x });
            };
            let at = |r: Register| self.registers[r as usize];
            match program.ops[r as usize] {
                Op::Linear { first, count, .. } => {
                    for term in &program.terms[first as usize..(first + count) as usize] {
                        lower(term.register, change / term.coefficient.high.abs());
                    }
                }
                Op::Scale(a, b) | Op::Multiply(a, b) => {
                    lower(a, change / at(b).magnitude());
                    lower(b, change / at(a).magnitude());
                }
                Op::Square(a) => lower(a, change / (2.0 * at(a).magnitude())),
                Op::Divide(a, b) if at(a).is_zero() => {
                    lower(a, change * at(b).mignitude());
                }
                Op::Divide(a, b) => {
                    lower(a, change * at(b).mignitude());
                    lower(b, change * at(b).mignitude() / value.magnitude());
                }
                Op::Root(a) => lower(a, (2.0 * change * value.mignitude()).max(change * change)),
                Op::Power(a, exponent) => {
                    let n = program.constants[exponent as usize].high.abs();
                    lower(a, change * at(a).mignitude() / (n * value.magnitude()));
                }
                Op::ParametricPower(a, exponent) => {
                    let n = at(exponent).magnitude();
                    lower(a, change * at(a).mignitude() / (n * value.magnitude()));
                }
                Op::Call(function, [a, b]) => {
                    let beside = self.harmless_companion(function, r);
                    let slope = largest_slope(function, at(a), at(b), value);
                    for argument in [a, b] {
                        lower_of(&mut self.harmless, argument, change.min(beside) / slope);
                    }
                }
                Op::Select { switch, positive, negative, .. } => {
                    lower(switch, 0.0);
                    lower(positive, change);
                    lower(negative, change);
                }
                Op::Solve(block) => {
                    let block = &program.blocks[block as usize];
                    for &part in block.matrix.iter().chain(&block.right) {
                        lower(part, NOTHING * at(part).mignitude());
                    }
                }
                Op::Parameter(_) | Op::Constant(_) | Op::Time | Op::Input(_) | Op::Written => {}
            }
        }
    }

    /// By how much the companion of a function may change: the cosine beside the sine, and that of the hyperbolic ones.
    fn harmless_companion(&self, function: FunctionId, r: Register) -> f64 {
        match function {
            FunctionId::Sin | FunctionId::Sinh => {
                self.harmless[r as usize + 1].max(NOTHING * self.at(r + 1).mignitude())
            }
            _ => f64::INFINITY,
        }
    }

    /// Finds the rounding of a register from those of what it is computed from.
    fn round(&mut self, program: &Program, r: Register) {
        let size = |r: Register| self.registers[r as usize].magnitude();
        let error = |r: Register| self.rounding[r as usize];
        let own = ROUNDING * size(r);
        let passed_on = match program.ops[r as usize] {
            Op::Linear { first, count, .. } => {
                let terms = &program.terms[first as usize..(first + count) as usize];
                let part = |register: Register| error(register) + ROUNDING * size(register);
                terms.iter().map(|t| t.coefficient.high.abs() * part(t.register)).sum()
            }
            Op::Scale(a, b) | Op::Multiply(a, b) => size(a) * error(b) + size(b) * error(a),
            Op::Square(a) => 2.0 * size(a) * error(a),
            Op::Divide(a, b) => (error(a) + size(r) * error(b)) / size(b),
            Op::Root(a) => 0.5 * error(a) / size(r),
            Op::Power(a, exponent) => {
                program.constants[exponent as usize].high.abs() * size(r) * error(a) / size(a)
            }
            Op::ParametricPower(a, exponent) => size(exponent) * size(r) * error(a) / size(a),
            Op::Call(function, [a, b]) => {
                let (u, v) = (self.at(a), self.at(b));
                let slope = largest_slope(function, u, v, self.at(r));
                let passed_on = slope * (error(a) + error(b));
                self.rounding[r as usize + 1] = passed_on + ROUNDING * size(r + 1);
                passed_on
            }
            Op::Select { positive, negative, .. } => error(positive).max(error(negative)),
            Op::Solve(block) => {
                // what rounding does in a system of equations is not known here
                let n = program.blocks[block as usize].size();
                self.rounding[r as usize..][..n].fill(0.0);
                return;
            }
            Op::Written | Op::Input(_) => return,
            Op::Parameter(_) | Op::Constant(_) | Op::Time => 0.0,
        };
        let all: f64 = own + passed_on;
        self.rounding[r as usize] = if all.is_nan() { 0.0 } else { all };
    }
}

fn lower_of(harmless: &mut [f64], r: Register, x: f64) {
    let part = &mut harmless[r as usize];
    *part = part.min(if x.is_nan() { 0.0 } else { x });
}

fn is_harmless(registers: &[Interval], harmless: &[f64], r: Register) -> bool {
    let (value, harmless) = (registers[r as usize], harmless[r as usize]);
    harmless == f64::INFINITY || value.width() <= harmless || value.magnitude() <= harmless
}

/// Whether numbers are of one order of magnitude, or at an end of the range.
fn has_one_size(x: Interval) -> bool {
    let (least, most) = (x.mignitude(), x.magnitude());
    most <= RATIO * least || most <= RANGE.0 || least >= RANGE.1
}

/// The values of a function and of its companion.
fn of_function(function: FunctionId, u: Interval, v: Interval) -> (Interval, Interval) {
    use std::f64::consts::{FRAC_PI_2, PI, TAU};
    const ONE: Interval = Interval { low: -1.0, high: 1.0 };
    let within = |x: Interval| x.within(ONE);
    // the sine between angles: it is largest at π/2 after any turns, and least at −π/2
    let sine = |u: Interval| {
        if u.width().is_nan() || u.width() >= TAU || u.magnitude() > 1e15 {
            return ONE;
        }
        let ends = Interval::between(math::sin(u.low), math::sin(u.high), 4.0);
        let reaches = |at: f64| {
            let turns = ((u.low - at) / TAU).ceil();
            at + turns * TAU <= u.high + 1e-14 * u.magnitude()
        };
        let low = if reaches(-FRAC_PI_2) { -1.0 } else { ends.low };
        let high = if reaches(FRAC_PI_2) { 1.0 } else { ends.high };
        within(Interval { low, high })
    };
    let shifted = |by: f64| Interval::between(u.low + by, u.high + by, 1.0);
    // the tangent has a pole between two angles that are not on the same branch
    let tangent = |u: Interval| {
        let branch = |x: f64| ((x + FRAC_PI_2) / PI).floor();
        let is_one = u.magnitude() < 1e15 && branch(u.low) == branch(u.high);
        let ends = u.rising(math::tan);
        if is_one && ends.low <= ends.high && math::tan(u.low) <= math::tan(u.high) {
            ends
        } else {
            Interval::ALL
        }
    };
    match function {
        FunctionId::Sin => (sine(u), sine(shifted(FRAC_PI_2))),
        FunctionId::Cos => (sine(shifted(FRAC_PI_2)), Interval::ALL),
        FunctionId::Tan => (tangent(u), Interval::ALL),
        FunctionId::Cot => {
            let turned = Interval::between(FRAC_PI_2 - u.low, FRAC_PI_2 - u.high, 1.0);
            (tangent(turned), Interval::ALL)
        }
        FunctionId::Asin => (within(u).rising(math::asin), Interval::ALL),
        FunctionId::Acos => {
            let u = within(u);
            (Interval::between(math::acos(u.low), math::acos(u.high), 4.0), Interval::ALL)
        }
        FunctionId::Atan => (u.rising(math::atan), Interval::ALL),
        FunctionId::Atan2 if v.low > 0.0 => {
            let corners = [(u.low, v.low), (u.low, v.high), (u.high, v.low), (u.high, v.high)];
            let angle = |(y, x)| Interval::between(math::atan2(y, x), math::atan2(y, x), 4.0);
            let all = corners.into_iter().map(angle).reduce(Interval::hull);
            (all.unwrap_or(Interval::ALL), Interval::ALL)
        }
        FunctionId::Atan2 => (Interval { low: -4.0, high: 4.0 }, Interval::ALL),
        FunctionId::Sinh => (u.rising(math::sinh), cosine(u)),
        FunctionId::Cosh => (cosine(u), Interval::ALL),
        FunctionId::Tanh => {
            let value = match u {
                _ if u.low > LIMITS.0 => Interval::point(1.0),
                _ if u.high < -LIMITS.0 => Interval::point(-1.0),
                _ => within(u.rising(math::tanh)),
            };
            (value, Interval::ALL)
        }
        FunctionId::Exp if u.high < -LIMITS.1 => (Interval::ZERO, Interval::ALL),
        FunctionId::Exp => {
            let value = u.rising(math::exp);
            (Interval { low: value.low.max(0.0), ..value }, Interval::ALL)
        }
        FunctionId::Ln => {
            let positive = Interval { low: u.low.max(0.0), high: u.high.max(0.0) };
            (positive.rising(math::ln), Interval::ALL)
        }
        FunctionId::Sqrt => (u.root(), Interval::ALL),
        FunctionId::Abs | FunctionId::Sign | FunctionId::Min | FunctionId::Max => {
            (Interval::ALL, Interval::ALL)
        }
    }
}

/// The hyperbolic cosine.
fn cosine(u: Interval) -> Interval {
    let (least, most) = (u.mignitude(), u.magnitude());
    let value = Interval::between(math::cosh(least), math::cosh(most), 4.0);
    Interval { low: value.low.max(1.0), ..value }
}

/// The largest slope of a function, and of its companion, in its arguments.
fn largest_slope(function: FunctionId, u: Interval, v: Interval, value: Interval) -> f64 {
    match function {
        FunctionId::Sin | FunctionId::Cos | FunctionId::Atan => 1.0,
        FunctionId::Tan | FunctionId::Cot => 1.0 + value.square().high,
        FunctionId::Asin | FunctionId::Acos => {
            1.0 / (1.0 - u.magnitude() * u.magnitude()).max(0.0).sqrt()
        }
        FunctionId::Atan2 => 1.0 / u.mignitude().max(v.mignitude()),
        FunctionId::Sinh | FunctionId::Cosh => cosine(u).high,
        // 1 − tanh² u ≤ 4 exp(−2 |u|)
        FunctionId::Tanh => (4.0 * math::exp(-2.0 * u.mignitude())).min(1.0),
        FunctionId::Exp => value.high,
        FunctionId::Ln => 1.0 / u.mignitude(),
        FunctionId::Sqrt
        | FunctionId::Abs
        | FunctionId::Sign
        | FunctionId::Min
        | FunctionId::Max => f64::INFINITY,
    }
}

/// What may be narrow in a program.
fn narrow(program: &Program) -> Vec<Narrow> {
    let mut degrees = vec![0.0_f64; program.ops.len()];
    let mut narrow = Vec::new();
    for &r in program.inputs.iter().chain(&program.body) {
        let of = |r: Register| degrees[r as usize];
        let is_fixed = |r: Register| program.fixed[r as usize];
        let op = program.ops[r as usize];
        let degree = match op {
            Op::Linear { first, count, .. } => {
                let terms = &program.terms[first as usize..(first + count) as usize];
                terms.iter().map(|term| of(term.register)).fold(0.0, f64::max)
            }
            Op::Scale(_, a) => of(a),
            Op::Multiply(a, b) => of(a) + of(b),
            Op::Square(a) => 2.0 * of(a),
            _ => 1.0,
        };
        degrees[r as usize] = degree;
        match op {
            // a companion and the unknowns of equations are in the registers behind
            Op::Call(..) => degrees[r as usize + 1] = 1.0,
            Op::Solve(block) => {
                degrees[r as usize..][..program.blocks[block as usize].size()].fill(1.0);
            }
            _ => {}
        }
        match op {
            Op::Multiply(..) | Op::Square(_) if degree >= STEEP => narrow.push(Narrow::Size(r)),
            Op::Divide(_, b) if !is_fixed(b) => narrow.push(Narrow::Size(b)),
            Op::Power(a, exponent) => {
                let exponent = program.constants[exponent as usize].high;
                if exponent < 0.0 {
                    narrow.push(Narrow::Size(a));
                } else if exponent >= STEEP {
                    narrow.push(Narrow::Size(r));
                }
            }
            Op::ParametricPower(_, exponent) => narrow.push(Narrow::ParametricPower(r, exponent)),
            Op::Call(function, [a, b]) => {
                narrow.push(Narrow::Function(function, r, a));
                if function == FunctionId::Atan2 {
                    narrow.push(Narrow::Function(function, r, b));
                }
            }
            _ => {}
        }
    }
    narrow
}
