//! The gauge of one constraint: its residual and its force.
//!
//! In: residuals relative to the size of their terms, and the multiplier's value. Out: a [`Gauge`].
//! Never here: how a constraint is enforced.

use super::deviation::Deviation;
use super::{Gauge, Reference};
use crate::analysis::Verdict;
use crate::expr::Expr;
use crate::mechanics::Equations;
use crate::model::Model;
use crate::num::significant;
use crate::system::{ChannelKind, System};

/// A longer row is replaced by its general form.
const LONGEST: usize = 24;

#[derive(Clone, Debug)]
pub(super) struct ResidualGauge {
    index: usize,
    name: String,
    multiplier: usize,
    /// λ as shown, its unit, and the meaning of the force.
    symbol: String,
    unit: String,
    force: String,
    deviation: Deviation,
}

impl ResidualGauge {
    /// Creates one gauge for each constraint.
    pub(super) fn all(model: &Model, equations: &Equations, system: &System) -> Vec<ResidualGauge> {
        let gauge = |index: usize| {
            let kind = ChannelKind::Multiplier(index);
            let multiplier = system.channels().iter().position(|c| c.kind == kind)?;
            let channel = &system.channels()[multiplier];
            Some(ResidualGauge {
                index,
                name: model.constraints[index].name.clone(),
                multiplier,
                symbol: channel.shown.clone(),
                unit: channel.unit.clone(),
                force: force(model, equations, index),
                deviation: Deviation::since(0.0),
            })
        };
        (0..model.constraints.len()).filter_map(gauge).collect()
    }

    pub(super) fn refer(&mut self, time: f64) {
        self.deviation = Deviation::since(time);
    }

    pub(super) fn observe(&mut self, residuals: &[[f64; 2]]) {
        self.deviation.observe(self.now(residuals));
    }

    pub(super) fn sample(&mut self, time: f64, residuals: &[[f64; 2]]) {
        self.deviation.sample(time, self.now(residuals));
    }

    pub(super) fn name(&self) -> &str {
        &self.name
    }

    pub(super) fn restore(&mut self, known: &Reference) {
        self.deviation.restore(known);
    }

    /// The larger of the residuals in position and in velocity.
    pub(super) fn now(&self, residuals: &[[f64; 2]]) -> f64 {
        residuals.get(self.index).map_or(0.0, |r| r[0].max(r[1]))
    }

    pub(super) fn show(&self, values: &[f64], residuals: &[[f64; 2]], released: bool) -> Gauge {
        let lambda = values[self.multiplier];
        let reason = if released {
            "no longer holds".to_owned()
        } else if lambda.is_nan() {
            self.force.clone()
        } else {
            let unit = if self.unit.is_empty() { String::new() } else { format!(" {}", self.unit) };
            format!("{} = {}{unit}, {}", self.symbol, short(lambda), self.force)
        };
        let gauge = self.deviation.gauge(&self.name, &self.name, reason, self.now(residuals));
        if released {
            return Gauge { verdict: Verdict::Released, ..gauge };
        }
        // a motion that could not begin shows nothing of it
        if residuals.is_empty() {
            return Gauge { verdict: Verdict::Open, ..gauge };
        }
        gauge
    }
}

/// The force of a constraint: in the file's words, or λ times the row.
fn force(model: &Model, equations: &Equations, index: usize) -> String {
    let about = &model.constraints[index].about;
    if !about.is_empty() {
        return about.clone();
    }
    let pool = &equations.pool;
    let row = model.coordinates.iter().zip(&equations.constraints[index].row);
    let parts = row.filter(|(_, a)| **a != Expr::ZERO).map(|(c, &a)| {
        let factor = pool.unicode(a);
        let factor = match factor.as_str() {
            "1" => "λ".to_owned(),
            "−1" => "−λ".to_owned(),
            _ if factor.chars().count() > LONGEST => "λ A".to_owned(),
            _ => format!("λ·({factor})"),
        };
        format!("{factor} on {}", c.shown)
    });
    parts.collect::<Vec<_>>().join(", ")
}

/// A number with four significant digits; a zero has no sign.
fn short(x: f64) -> String {
    significant(if x == 0.0 { 0.0 } else { x }, 4, 0.0..f64::INFINITY).replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::short;

    /// A multiplier at rest is 0, whatever the sign of its zero, and a negative number has a minus sign, not a hyphen.
    #[test]
    fn a_multiplier_has_a_minus_sign_and_a_zero_none() {
        for (x, written) in [(-0.0, "0"), (0.0, "0"), (-18.72, "−18.72"), (4.905, "4.905")] {
            assert_eq!(short(x), written);
        }
    }
}
