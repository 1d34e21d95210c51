//! The members of a family between two of its points: those at given values, folds, and bifurcations.
//!
//! In: two points, one step apart. Out: the members between them, in their order. Never here: the step.

use super::super::error::DynamicsError;
use super::super::family::{Bifurcation, Member};
use super::{Continuation, FamilyPoint};

/// The halvings that locate a bifurcation.
const HALVINGS: usize = 30;

impl Continuation<'_> {
    /// Collects the members between two points, in their order.
    pub(super) fn between(
        &self,
        from: &FamilyPoint,
        to: &FamilyPoint,
        step: f64,
        members: &mut Vec<Member>,
    ) -> Result<(), DynamicsError> {
        let (low, high) = self.range();
        let mut found: Vec<(f64, Member)> = Vec::new();
        let [before, after] = [self.slope(from)?, self.slope(to)?];
        let folds = (before < 0.0) != (after < 0.0);
        let mut specials: Vec<(
            Bifurcation,
            Box<dyn Fn(&FamilyPoint) -> Result<f64, DynamicsError> + '_>,
        )> = Vec::new();
        if folds {
            specials.push((Bifurcation::Fold, Box::new(|point: &FamilyPoint| self.slope(point))));
        }
        // what is rounding at either end has no sign
        let changes =
            |ends: [Option<f64>; 2]| matches!(ends, [Some(a), Some(b)] if (a < 0.0) != (b < 0.0));
        if changes([from.doubling(), to.doubling()]) {
            let test = |point: &FamilyPoint| Ok(point.doubling().unwrap_or(0.0));
            specials.push((Bifurcation::PeriodDoubling, Box::new(test)));
        }
        if !folds && changes([from.unit(), to.unit()]) {
            let test = |point: &FamilyPoint| Ok(point.unit().unwrap_or(0.0));
            specials.push((Bifurcation::Branching, Box::new(test)));
        }
        for (kind, test) in specials {
            let (mut a, mut b) = (0.0, step);
            let below = test(from)? < 0.0;
            let mut last = None;
            for _ in 0..HALVINGS {
                let middle = 0.5 * (a + b);
                let Some((point, _)) = self.onwards(from, middle)? else { break };
                if (test(&point)? < 0.0) == below {
                    a = middle;
                } else {
                    b = middle;
                }
                last = Some((middle, point));
            }
            if let Some((part, point)) = last
                && (low..=high).contains(&point.value)
            {
                let member =
                    Member { value: point.value, orbit: point.orbit, bifurcation: Some(kind) };
                found.push((part, member));
            }
        }
        for &value in self.values {
            if (from.value < value) == (to.value < value) || from.value == value {
                continue;
            }
            let (mut a, mut b) = (0.0, step);
            let (mut fa, mut fb) = (from.value - value, to.value - value);
            let mut last = (step, to.clone());
            // the rule of false position, with the weight of an end that stays halved
            for _ in 0..30 {
                if fb == 0.0 {
                    break;
                }
                let middle = a + (b - a) * fa / (fa - fb);
                let Some((point, _)) = self.onwards(from, middle)? else { break };
                let off = point.value - value;
                last = (middle, point);
                if off.abs() <= 1e-12 * value.abs().max(1e-2) {
                    break;
                }
                if (off < 0.0) == (fb < 0.0) {
                    (b, fb, fa) = (middle, off, 0.5 * fa);
                } else {
                    (a, fa, fb) = (middle, off, 0.5 * fb);
                }
            }
            let (part, point) = last;
            // a member that was not found is left out
            if (point.value - value).abs() > 1e-9 * value.abs().max(1e-2) {
                continue;
            }
            found.push((part, Member { value, orbit: point.orbit, bifurcation: None }));
        }
        found.sort_by(|x, y| x.0.total_cmp(&y.0));
        members.extend(found.into_iter().map(|(_, member)| member));
        Ok(())
    }
}
