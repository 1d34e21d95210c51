//! The quantities that a file declares conserved without a proof: what is seen of them along the motion.
//!
//! In: a model, its equations, samples of a motion. Out: a diagnostic for each quantity that is not conserved. Never
//! here: the motion.

use crate::diagnostic::{Diagnostic, SourceRange};
use crate::expr::{Expr, Symbol};
use crate::mechanics::{Conserved, Equations, OneSided, Reason, class_of};
use crate::model::Model;

/// The tolerated drift of a conserved quantity, relative to the size of its terms.
const TOLERANCE: f64 = 1e-10;

/// A change above this part of the size of its terms is no rounding.
const SEEN: f64 = 1e-14;

/// A rate longer than this is not reported.
const LONGEST: u64 = 60;

/// The quantity of that name that is proved to be conserved.
pub(super) fn known<'a>(equations: &'a Equations, name: &str) -> Option<&'a Conserved> {
    equations.conserved.iter().find(|c| c.name == name && c.reason.is_proved())
}

/// A quantity declared conserved for which that is not proved.
pub(super) struct Claim {
    pub(super) name: String,
    pub(super) place: SourceRange,
    pub(super) expression: Expr,
    /// Its rate of change, if it is not known to vanish.
    pub(super) rate: Option<Expr>,
    /// Whether that rate is nonzero somewhere along the motion.
    pub(super) refuted: bool,
    /// The kinks of its rate and its own jumps, if it is not known to be conserved.
    one_sided: Option<OneSided>,
    /// Whether each of their functions was always positive, or always negative; `None` if neither, or at the kink.
    stayed: Vec<(Expr, Option<bool>)>,
    /// Whether its terms, which are not 0, were seen below the numbers that have all their digits.
    pub(super) underflows: bool,
    first: f64,
    size: f64,
    farthest: f64,
}

pub(super) fn open_claims(model: &Model, equations: &mut Equations) -> Vec<Claim> {
    let observed = model.observables.iter().filter(|o| o.conserved == Some(true));
    let observed = observed.map(|o| (&o.name, o.expression, &o.place));
    let observed = observed.filter(|(name, ..)| known(equations, name).is_none());
    let expected = model.expect.conserves.iter().map(|(name, e, place)| (name, *e, place));
    // what is expected of the motion is expected of its impulses as well
    let always = |known: &Conserved| !matches!(known.reason, Reason::BetweenImpulses(_));
    let expected = expected.filter(|(name, ..)| !known(equations, name).is_some_and(always));
    let all: Vec<(&String, Expr, &SourceRange)> = observed.chain(expected).collect();
    let claim = |(name, expression, place): (&String, Expr, &SourceRange)| {
        let classed = class_of(model, equations, name, expression);
        let rate = classed.rate.ok().filter(|_| !classed.class.is_conserved());
        let one_sided = if classed.class.is_conserved() {
            None
        } else {
            OneSided::of(model, equations, expression)
        };
        Claim {
            name: name.clone(),
            place: place.clone(),
            expression,
            rate,
            refuted: false,
            one_sided,
            stayed: Vec::new(),
            underflows: false,
            first: f64::NAN,
            size: 0.0,
            farthest: 0.0,
        }
    };
    all.into_iter().map(claim).collect()
}

impl Claim {
    pub(super) fn sample(&mut self, value: f64, size: f64) {
        if self.first.is_nan() {
            self.first = value;
        }
        self.size = self.size.max(size);
        let distance = (value - self.first).abs();
        self.farthest =
            if distance.is_finite() { self.farthest.max(distance) } else { f64::INFINITY };
    }

    /// Sees on which sides of its kinks a state is.
    pub(super) fn see_sides(&mut self, equations: &Equations, at: &dyn Fn(Symbol) -> f64) {
        let Some(one_sided) = &self.one_sided else { return };
        let side = |e: Expr| {
            let value = equations.pool.evaluate(e, at);
            (value != 0.0 && !value.is_nan()).then_some(value > 0.0)
        };
        let now = one_sided.switches().into_iter().map(|e| (e, side(e)));
        if self.stayed.is_empty() {
            self.stayed = now.collect();
        } else {
            for ((_, stayed), (_, now)) in self.stayed.iter_mut().zip(now) {
                *stayed = stayed.filter(|_| *stayed == now);
            }
        }
    }

    /// A quantity that is conserved only as long as a motion stays on one side of a kink, as this motion does, is not conserved.
    pub(super) fn one_sided(
        &self,
        equations: &Equations,
        at: &dyn Fn(Symbol) -> f64,
        end: f64,
    ) -> Option<Diagnostic> {
        let one_sided = self.one_sided.as_ref()?;
        let stayed: Vec<(Expr, bool)> =
            self.stayed.iter().filter_map(|&(e, side)| Some((e, side?))).collect();
        let mut equations = equations.clone();
        let sides = one_sided.sides(&mut equations, &stayed, at);
        if sides.is_empty() {
            return None;
        }
        let side = |&(e, positive): &(Expr, bool)| {
            format!("{} {} 0", equations.pool.unicode(e), if positive { '>' } else { '<' })
        };
        let place = sides.iter().map(side).collect::<Vec<_>>().join(" and ");
        let message = format!("`{}` is claimed to be conserved, but it is not", self.name);
        let help = format!(
            "it is only where {place}, where this motion stays as far as it is seen until t = {end}"
        );
        Some(Diagnostic::error(self.place.clone(), message).with_help(help))
    }

    /// A quantity that changes by too little to detect, for instance by a distant force, is not
    /// conserved. One whose rate of change vanishes all along this motion is.
    pub(super) fn unseen(&self, equations: &Equations, end: f64) -> Option<Diagnostic> {
        let (name, rate) = (&self.name, self.rate.filter(|_| self.refuted)?);
        let mut help = if is_seen(self.farthest, self.size) {
            format!("it changes by {:.1e} until t = {end}, small beside its terms", self.farthest)
        } else {
            format!("it only keeps its value to rounding until t = {end}")
        };
        if equations.pool.weight(rate) <= LONGEST {
            let rate = equations.pool.unicode(rate);
            help.push_str(&format!("; its rate of change is {rate}"));
        }
        let message = format!("`{name}` is claimed to be conserved, but it is not");
        Some(Diagnostic::error(self.place.clone(), message).with_help(help))
    }

    pub(super) fn diagnostic(&self, equations: &Equations, end: f64) -> Option<Diagnostic> {
        let Claim { name, .. } = self;
        if self.first.is_nan() {
            let message = format!("`{name}` is claimed to be conserved, but it is not a number");
            return Some(Diagnostic::error(self.place.clone(), message));
        }
        if self.underflows && self.size < f64::MIN_POSITIVE {
            let message = format!("`{name}` cannot be checked: its terms underflow");
            let help = "other units make them larger";
            return Some(Diagnostic::error(self.place.clone(), message).with_help(help));
        }
        if is_tolerated(self.farthest, self.size) {
            return None;
        }
        let drift = self.farthest / self.size;
        let message = format!("`{name}` is claimed to be conserved, but it is not");
        let mut help = format!("it drifts by {drift:.1e} of its size until t = {end}");
        if name == "energy" {
            let rate = equations.pool.unicode(equations.energy_rate);
            let between = if equations.law_jumps() { " between steps" } else { "" };
            help = format!("{help}; dE/dt = {rate}{between}");
        }
        Some(Diagnostic::error(self.place.clone(), message).with_help(help))
    }
}

/// Whether a change is more than rounding of terms of this size.
fn is_seen(change: f64, size: f64) -> bool {
    change > SEEN * size
}

/// Whether a quantity that has changed by this, beside the size of its terms, counts as conserved.
fn is_tolerated(change: f64, size: f64) -> bool {
    change <= TOLERANCE * size
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_change_is_seen_beyond_1e_14_and_tolerated_up_to_1e_10_of_the_terms() {
        assert!(is_seen(2.1e-14, 2.0) && !is_seen(1.9e-14, 2.0));
        assert!(is_tolerated(1.9e-10, 2.0) && !is_tolerated(2.1e-10, 2.0));
        assert!(!is_tolerated(f64::NAN, 2.0));
    }
}
