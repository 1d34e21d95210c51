//! A law whose parameters change with the time, as one reads it: `p = m l² θ̇` with l, l̇ and l̈ as they are at this instant, and not
//! the ramp's formula in each place.
//!
//! The derivation is that of any law. A ramped parameter is l + l̇ (t − s) + ½ l̈ (t − s)² in it, with l, l̇, l̈ and s as symbols; at s = t
//! its value and its first two derivatives are those of any function, and no law has higher ones. So what is proved of it is
//! proved for every ramp. What is derived later of what is known at the instant, as the rate of an observable, takes l, l̇ and l̈ as
//! what they are by then: functions of the time, with l̇, l̈ and l⃛ as their rates.
//!
//! In: a model of which the parameters keep their names, what was derived of it. Out: [`NamedRamps`]. Never here: motions, which follow the functions.

use std::collections::HashMap;

use super::equations::{Conserved, Equations, Flow, NamedRamps, NoClosedForm, Reason};
use super::further::Further;
use super::structure::Separation;
use crate::expr::{Expr, Symbol};
use crate::model::Model;

/// The model of which the law is derived with its ramps by name, if it has any, and there is nothing in the file that only the
/// functions themselves can answer for.
pub(super) fn model(model: &Model) -> Option<Model> {
    let named = model.with_ramps_named.as_deref()?;
    let asks_more = !model.transformations.is_empty()
        || !model.generators.is_empty()
        || model.complete_integral.is_some()
        || model.comparison.is_some()
        || !model.frames.is_empty();
    let law = named.mechanics.function().1;
    if asks_more || !named.pool.depends(law, named.ramped.instant()?) {
        return None;
    }
    let mut named = named.clone();
    named.leave_views_out();
    named.picture.shapes.clear();
    Some(named)
}

impl NamedRamps {
    /// What was derived of the model, at this instant; conserved is what is so with the functions themselves.
    pub(super) fn of(model: Model, mut equations: Equations, conserved: &[Conserved]) -> Self {
        equations.conserved.retain_mut(|own| {
            let known = conserved.iter().find(|known| known.name == own.name);
            // by name it may be conserved for another reason; a proof for every ramp is one for this one
            if let Some(known) = known.filter(|known| known.reason != Reason::Numerically) {
                own.reason.clone_from(&known.reason);
            }
            known.is_some()
        });
        let why = "H depends on the time".to_owned();
        equations.supplements.separation = Some(Separation::Unknown(why));
        let mut named = NamedRamps { model, equations };
        named.take_the_instant();
        named
    }

    /// The law with its ramps by name and what takes longer to find of it, if it has ramps; `further` is what was found of the
    /// functions themselves.
    pub fn readable(equations: &Equations, further: &Further) -> Option<(NamedRamps, Further)> {
        let mut named = NamedRamps::clone(equations.supplements.named_ramps.as_deref()?);
        named.equations.find_closed_forms();
        let further = named.further(further);
        Some((named, further))
    }

    /// What takes longer to find. Of the observables only `further`, which knows the ramps, says whether they are conserved.
    fn further(&mut self, further: &Further) -> Further {
        let mut own = Further::of(&self.model, &mut self.equations);
        for classed in &mut own.classes {
            if let Some(known) = further.classes.iter().find(|known| known.name == classed.name) {
                classed.class = known.class;
            }
        }
        own
    }

    /// Lets s be t; from then on parameters and their rates are functions of the time.
    fn take_the_instant(&mut self) {
        let now = self.now();
        let NamedRamps { model, equations } = self;
        equations.supplements.ramp_rates = model
            .ramped
            .named()
            .iter()
            .flat_map(|ramp| {
                let [first, second, third] = ramp.derivatives;
                [(ramp.parameter, first), (first, second), (second, third)]
            })
            .map(|(symbol, rate)| (symbol, equations.pool.variable(rate)))
            .collect();
        let Equations { pool, .. } = equations;
        let mut all: Vec<&mut Expr> = model.mechanics.expressions_mut();
        all.extend(model.constraints.iter_mut().map(|constraint| &mut constraint.expression));
        all.extend(model.impulses.iter_mut().flat_map(|impulse| &mut impulse.change));
        all.extend(model.events.iter_mut().map(|event| &mut event.when));
        all.extend(model.observables.iter_mut().map(|observable| &mut observable.expression));
        all.extend(model.definitions.iter_mut().map(|definition| &mut definition.1));
        all.extend(&mut equations.momenta);
        match &mut equations.flow {
            Flow::Lagrange { mass, force, momentum_rates } => {
                all.extend(mass.iter_mut().flatten().chain(force).chain(momentum_rates));
            }
            Flow::Hamilton { velocities, momentum_rates } => {
                all.extend(velocities.iter_mut().chain(momentum_rates));
            }
            Flow::Poisson { rates } => all.extend(rates),
        }
        all.extend([
            &mut equations.law,
            &mut equations.energy,
            &mut equations.energy_rate,
            &mut equations.action_rate,
        ]);
        let forms = [&mut equations.lagrangian, &mut equations.hamiltonian];
        all.extend(forms.into_iter().flatten());
        let lists: [&mut Result<Vec<Expr>, NoClosedForm>; 3] =
            [&mut equations.velocities, &mut equations.solved, &mut equations.multipliers];
        all.extend(lists.into_iter().flatten().flatten());
        for row in &mut equations.constraints {
            all.extend(row.row.iter_mut().chain([&mut row.rate, &mut row.bias]));
            all.extend(&mut row.position);
        }
        all.extend(equations.conserved.iter_mut().map(|conserved| &mut conserved.expression));
        for e in all {
            *e = pool.substitute(*e, &now);
        }
        model.pool = pool.clone();
    }

    fn now(&mut self) -> HashMap<Symbol, Expr> {
        let time = self.equations.pool.variable(self.model.symbols.time);
        self.model.ramped.instant().map(|instant| (instant, time)).into_iter().collect()
    }
}
