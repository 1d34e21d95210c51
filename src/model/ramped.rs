//! Parameters as functions of the time, as expressions.
//!
//! In: a parameter, the parts of its way. Out: the function that stands for it wherever it is used. Never here: models, what
//! follows from a law that depends on the time.

use std::collections::HashMap;

use super::parameter::Parameter;
use crate::expr::{Expr, FunctionId, Node, Pool, Rank, Symbol, latex_of_unicode, subscripts};
use crate::num::Number;

/// A part of a parameter's way, as a file gives it: its numbers may be expressions in other parameters.
#[derive(Clone, Copy, Debug)]
pub struct RampPart {
    /// The value that it leads to.
    pub to: Expr,
    /// When it begins.
    pub start: Expr,
    /// How long it takes, above zero.
    pub duration: Expr,
    /// How it goes.
    pub form: RampForm,
}

/// How smoothly a ramp begins and ends, with u from 0 to 1 on the way.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum RampForm {
    /// 10u³ − 15u⁴ + 6u⁵: the third derivative jumps at both ends.
    #[default]
    Smooth,
    /// 3u² − 2u³: the second derivative jumps.
    Cubic,
    /// u: the first derivative jumps.
    Linear,
}

impl RampForm {
    /// All forms with their names in files.
    pub const NAMED: [(&str, RampForm); 3] =
        [("smooth", RampForm::Smooth), ("cubic", RampForm::Cubic), ("linear", RampForm::Linear)];
}

/// Parameters as functions of the time.
#[derive(Clone, Debug, Default)]
pub struct Ramped {
    functions: HashMap<Symbol, Expr>,
    /// The clamped progress of each part, and whether every part that has it begins and ends smoothly.
    progress: HashMap<Expr, bool>,
    named: Vec<NamedRamp>,
    instant: Option<Symbol>,
}

/// A parameter that keeps its name in the law, with the function of the time that it is.
#[derive(Clone, Debug)]
pub struct NamedRamp {
    /// The one that changes with the time.
    pub parameter: Symbol,
    /// Its first three derivatives by the time.
    pub derivatives: [Symbol; 3],
    /// Its value as a function of the progress of each part, and of the symbol of its value before the first.
    pub function: Expr,
    /// The progress of each part: it goes evenly from 0 to 1 between two times.
    pub progress: Vec<RampProgress>,
}

/// How far a part of a ramp is.
#[derive(Clone, Copy, Debug)]
pub struct RampProgress {
    /// The symbol by which the function contains it.
    pub symbol: Symbol,
    /// When the part begins, and when it ends.
    pub times: [Expr; 2],
    /// When a later part takes its place, if that is before its end.
    pub stopped: Option<Expr>,
}

/// A part of a parameter's way among the others: it begins at the value that those before it have reached, and ends what is
/// left of them.
struct RampStage {
    part: RampPart,
    /// From the value that it begins with to the one that it leads to.
    change: Expr,
    /// How far it comes before a later one begins; all the way, if there is nothing.
    limit: Option<Expr>,
    /// When that one begins.
    stopped: Option<Expr>,
}

fn stages(pool: &mut Pool, initial: Expr, parts: &[RampPart]) -> Vec<RampStage> {
    let mut stages: Vec<RampStage> = Vec::new();
    for &part in parts {
        for earlier in &mut stages {
            earlier.stop(pool, part.start);
        }
        let value = match stages.last() {
            Some(last) if last.limit.is_none() => last.part.to,
            _ => stages.iter().fold(initial, |value, RampStage { part, change, limit, .. }| {
                let share = limit.map_or(*change, |limit| {
                    let share = part.form.share(pool, limit);
                    pool.mul(*change, share)
                });
                pool.add(value, share)
            }),
        };
        let change = pool.sub(part.to, value);
        stages.push(RampStage { part, change, limit: None, stopped: None });
    }
    stages
}

impl RampStage {
    /// Lets it end at a time, if that is before its end.
    fn stop(&mut self, pool: &mut Pool, time: Expr) {
        let passed = pool.sub(time, self.part.start);
        let passed = pool.div(passed, self.part.duration);
        let one = pool.number(Number::ONE);
        let reached = match pool.node(passed) {
            Node::Number(n) if n.value() >= 1.0 => return,
            Node::Number(n) if n.value() <= 0.0 => Expr::ZERO,
            Node::Number(_) => passed,
            _ => {
                let passed = pool.call(FunctionId::Max, &[passed, Expr::ZERO]);
                pool.call(FunctionId::Min, &[passed, one])
            }
        };
        let earlier = |pool: &mut Pool, known: Option<Expr>, new: Expr| match known {
            None => new,
            Some(known) => match (pool.node(known), pool.node(new)) {
                (Node::Number(a), Node::Number(b)) if a.value() <= b.value() => known,
                (Node::Number(_), Node::Number(_)) => new,
                _ => pool.call(FunctionId::Min, &[known, new]),
            },
        };
        self.limit = Some(earlier(pool, self.limit, reached));
        self.stopped = Some(earlier(pool, self.stopped, time));
    }
}

impl RampForm {
    /// Coefficients and powers of the progress.
    fn powers(self) -> &'static [(i64, i64)] {
        match self {
            RampForm::Smooth => &[(10, 3), (-15, 4), (6, 5)],
            RampForm::Cubic => &[(3, 2), (-2, 3)],
            RampForm::Linear => &[(1, 1)],
        }
    }

    /// How much of the way is behind at a progress.
    fn share(self, pool: &mut Pool, progress: Expr) -> Expr {
        let mut terms = Vec::new();
        for &(coefficient, power) in self.powers() {
            let power = pool.monomial(Number::ONE, &[(progress, Number::integer(power))]);
            terms.push((Number::integer(coefficient), power));
        }
        pool.linear(Number::ZERO, &terms)
    }
}

impl Ramped {
    /// Makes a parameter follow its schedule from its own value, which stays what it is before the first part.
    ///
    /// Between a and b it is a s(v) + b s(u), where u is what has passed of a part, v what is left, and s(u) + s(v) = 1: as a and a share of
    /// b − a what leads to zero would lose its digits. Both are clamped, so that nothing writes one as a difference from the other.
    pub fn lead(&mut self, pool: &mut Pool, time: Symbol, parameter: Symbol, parts: &[RampPart]) {
        let own = pool.variable(parameter);
        let time = pool.variable(time);
        let mut value = own;
        let one = pool.number(Number::ONE);
        for RampStage { part, limit, .. } in stages(pool, own, parts) {
            let limit = limit.unwrap_or(one);
            let passed = pool.sub(time, part.start);
            let passed = pool.div(passed, part.duration);
            let [ahead, least] = [passed, limit].map(|u| pool.sub(one, u));
            let [u, left] =
                [(passed, Expr::ZERO, limit), (ahead, least, one)].map(|(part, least, most)| {
                    let part = pool.call(FunctionId::Max, &[part, least]);
                    pool.call(FunctionId::Min, &[part, most])
                });
            // one that a later part takes over from stops at once
            let smoothly = part.form == RampForm::Smooth && limit == one;
            self.proceed(u, smoothly);
            self.proceed(left, smoothly);
            let [share, left] = [u, left].map(|u| part.form.share(pool, u));
            let terms = [pool.mul(value, left), pool.mul(part.to, share)];
            value = pool.sum(&terms);
        }
        self.functions.insert(parameter, value);
    }

    /// Lets a parameter keep its name: it is l + l̇ (t − s) + ½ l̈ (t − s)², of which at the instant s = t the value and the first two
    /// derivatives are those of any function of the time. No law has higher ones; the rate of what follows from it, as of a
    /// multiplier, may have the third. Returns the derivatives and s as parameters of any value. What the progress of each part
    /// is called is not `taken`.
    pub fn keep(
        &mut self,
        pool: &mut Pool,
        time: Symbol,
        (parameter, parts): (&Parameter, &[RampPart]),
        taken: &dyn Fn(&str) -> bool,
    ) -> Vec<Parameter> {
        let (name, shown) = (&parameter.name, &parameter.shown);
        let latex = latex_of_unicode(shown);
        let mut introduce = |written: &str, shown: &str, latex: &str, rank| {
            let symbol = pool.symbol(written);
            pool.describe(symbol, shown, latex, rank);
            symbol
        };
        let orders = [("'", '′', "dot"), ("''", '″', "ddot"), ("'''", '‴', "dddot")];
        let derivatives = orders.map(|(primes, mark, command)| {
            let written = format!("{name}{primes}");
            let latex = format!("\\{command}{{{latex}}}");
            introduce(&written, &format!("{shown}{mark}"), &latex, Rank::Rate)
        });
        let instant = introduce("the instant", "s", "s", Rank::Variable);
        let any = Parameter::nameless;
        let [rate, second, third] = derivatives;
        let mut added = vec![any(rate, 0.618_034), any(second, -0.414_214), any(third, 0.236_068)];
        // the instant is the same for all
        if self.instant.replace(instant).is_none() {
            added.push(any(instant, 0.302_776));
        }
        let named = NamedRamp::of(pool, (parameter, derivatives), parts, taken);
        self.named.push(named);
        let [own, instant, time] =
            [parameter.symbol, instant, time].map(|symbol| pool.variable(symbol));
        let since = pool.sub(time, instant);
        let [rate, second] = [rate, second].map(|symbol| pool.variable(symbol));
        let linear = pool.mul(rate, since);
        let half = pool.ratio(1, 2);
        let square =
            pool.monomial(Number::ONE, &[(since, Number::integer(2)), (second, Number::ONE)]);
        let square = pool.mul(half, square);
        let value = pool.sum(&[own, linear, square]);
        self.functions.insert(parameter.symbol, value);
        added
    }

    /// The parameters that keep their names.
    pub fn named(&self) -> &[NamedRamp] {
        &self.named
    }

    /// The symbol of the instant around which parameters that keep their names are developed, if there are any.
    pub fn instant(&self) -> Option<Symbol> {
        self.instant
    }

    /// Lets a parameter be a function of the time.
    pub(super) fn insert(&mut self, parameter: Symbol, value: Expr) {
        self.functions.insert(parameter, value);
    }

    /// Notes the clamped progress of a part, and whether it begins and ends smoothly.
    pub(super) fn proceed(&mut self, progress: Expr, smoothly: bool) {
        self.progress.entry(progress).and_modify(|all| *all &= smoothly).or_insert(smoothly);
    }

    /// Whether this is the clamped progress of parts of ramps that all begin and end smoothly.
    pub fn is_smooth_progress(&self, e: Expr) -> bool {
        self.progress.get(&e).is_some_and(|smooth| *smooth)
    }

    /// Whether no parameter changes with the time.
    pub fn is_empty(&self) -> bool {
        self.functions.is_empty()
    }

    /// Each parameter with its function of the time.
    pub fn functions(&self) -> impl Iterator<Item = (Symbol, Expr)> {
        self.functions.iter().map(|(&symbol, &e)| (symbol, e))
    }

    /// Whether an expression has a parameter that changes with the time.
    pub fn acts_on(&self, pool: &Pool, e: Expr) -> bool {
        self.functions.keys().any(|&symbol| pool.depends(e, symbol))
    }

    /// An expression with these functions in place of the parameters.
    pub fn replace(&self, pool: &mut Pool, e: Expr) -> Expr {
        if self.functions.is_empty() { e } else { pool.substitute(e, &self.functions) }
    }
}

impl NamedRamp {
    fn of(
        pool: &mut Pool,
        (parameter, derivatives): (&Parameter, [Symbol; 3]),
        parts: &[RampPart],
        taken: &dyn Fn(&str) -> bool,
    ) -> NamedRamp {
        let name = &parameter.name;
        let numbered = |name: String| {
            std::iter::once(name.clone()).chain((2..).map(move |n| format!("{name}{n}")))
        };
        let initial = unused(pool, numbered(format!("{name}_i")), taken);
        let number = pool.symbol_info(initial).name[name.len() + 2..].to_owned();
        let index = format!("ᵢ{}", subscripts(&number));
        pool.describe(
            initial,
            &format!("{}{index}", parameter.shown),
            &format!("{{{}}}_{{i{number}}}", latex_of_unicode(&parameter.shown)),
            Rank::Constant,
        );
        let initial = pool.variable(initial);
        let own = HashMap::from([(parameter.symbol, initial)]);
        let parts: Vec<RampPart> = (parts.iter())
            .map(|part| {
                let [to, start, duration] =
                    [part.to, part.start, part.duration].map(|e| pool.substitute(e, &own));
                RampPart { to, start, duration, form: part.form }
            })
            .collect();
        let mut function = initial;
        let mut progress = Vec::new();
        for RampStage { part, change, stopped, .. } in stages(pool, initial, &parts) {
            let end = pool.add(part.start, part.duration);
            let symbol = unused(pool, numbered("u".to_owned()), taken);
            let info = pool.symbol_info(symbol).clone();
            pool.describe(symbol, &info.unicode, &info.latex, Rank::Variable);
            progress.push(RampProgress { symbol, times: [part.start, end], stopped });
            let u = pool.variable(symbol);
            let share = part.form.share(pool, u);
            let change = pool.mul(change, share);
            function = pool.add(function, change);
        }
        NamedRamp { parameter: parameter.symbol, derivatives, function, progress }
    }
}

/// The symbol of the first name that neither the pool has nor anything else in the file.
fn unused(
    pool: &mut Pool,
    names: impl IntoIterator<Item = String>,
    taken: &dyn Fn(&str) -> bool,
) -> Symbol {
    let mut chosen = String::new();
    for name in names {
        chosen = name;
        if pool.find_symbol(&chosen).is_none() && !taken(&chosen) {
            break;
        }
    }
    pool.symbol(&chosen)
}
