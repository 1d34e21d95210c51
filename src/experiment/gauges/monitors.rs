//! What is monitored: the quantities that a law conserves, and those that it would conserve but for what acts on them.
//!
//! In: a model and the consequences of its law. Out: monitors without a reference. Never here: values.

use std::collections::HashMap;
use std::sync::Arc;

use super::invariant_monitor::{
    ChangeLaw, ChangeRate, ENERGY_BALANCE, InvariantMonitor, MonitoredInvariant,
};
use crate::experiment::energy_law::{EnergyLaw, LONGEST};
use crate::expr::Expr;
use crate::mechanics::{Conserved, Equations, casimir_rate};
use crate::model::{Mechanics, Model};
use crate::system::{ChannelKind, System};

/// The monitors of what is conserved, and of what would be but for something that acts on it; the energy comes first.
pub(super) fn monitors(
    model: &Model,
    equations: &mut Arc<Equations>,
    system: &System,
) -> Vec<InvariantMonitor> {
    let casimirs = changing_casimirs(model, equations);
    let equations = &**equations;
    let find = |kind: ChannelKind| system.channels().iter().position(|c| c.kind == kind);
    let mut monitors = Vec::new();
    let mut add = |name: &str, reason: String, broken, kind, quantity, expression| {
        let Some(channel) = find(kind) else { return };
        let shown = system.channels()[channel].shown.clone();
        let name = name.to_owned();
        let invariant = MonitoredInvariant {
            name,
            shown,
            reason,
            proved: true,
            broken,
            channel,
            quantity,
            expression,
        };
        monitors.push(InvariantMonitor::new(invariant));
    };
    // the first quantity of a `TermWatch`
    let energy = Some(0);
    if !equations.conserved.iter().any(|c| c.name == "energy") {
        let law = EnergyLaw::of(model, equations);
        let kind = ChannelKind::Energy;
        let change = ChangeLaw { shown: law.rate, rate: ChangeRate::Energy(law.parts) };
        add("energy", law.cause, Some(change), kind, energy, equations.energy);
        let reason = "E − work done on it".to_owned();
        add(ENERGY_BALANCE, reason, None, ChannelKind::EnergyBalance, energy, equations.energy);
    } else if !model.impulses.is_empty() {
        let reason = "E − impulse work".to_owned();
        add(ENERGY_BALANCE, reason, None, ChannelKind::EnergyBalance, energy, equations.energy);
    }
    for (i, (name, casimir, law)) in casimirs {
        let reason = "Casimir; a force acts".to_owned();
        add(&name, reason, Some(law), ChannelKind::Casimir(i), None, casimir);
    }
    for (i, conserved) in equations.conserved.iter().enumerate() {
        let is_energy = conserved.name == "energy";
        let kind = if is_energy { ChannelKind::Energy } else { ChannelKind::Conserved(i) };
        let quantity = Some(if is_energy { 0 } else { i + 1 });
        monitors.extend(find(kind).map(|channel| {
            InvariantMonitor::new(MonitoredInvariant {
                name: conserved.name.clone(),
                shown: system.channels()[channel].shown.clone(),
                reason: conserved.reason.to_string(),
                proved: conserved.reason.is_proved(),
                broken: None,
                channel,
                quantity,
                expression: conserved.expression,
            })
        }));
    }
    monitors
        .sort_by_key(|monitor| monitor.invariant.channel != find(ChannelKind::Energy).unwrap_or(0));
    monitors
}

/// The equations with the energy expanded in the conserved quantities. The error of an invariant is that of the
/// energy's terms in it, which may nearly cancel.
pub(super) fn with_energy_opened(equations: &Arc<Equations>) -> Arc<Equations> {
    let has_energy = |c: &Conserved| equations.pool.depends(c.expression, equations.symbols.energy);
    if !equations.conserved.iter().any(has_energy) {
        return Arc::clone(equations);
    }
    let mut equations = Equations::clone(equations);
    let energy = HashMap::from([(equations.symbols.energy, equations.energy)]);
    for i in 0..equations.conserved.len() {
        let e = equations.conserved[i].expression;
        equations.conserved[i].expression = equations.pool.substitute(e, &energy);
    }
    Arc::new(equations)
}

/// The Casimirs that forces change: the index, the name, the expression and the law of its change.
fn changing_casimirs(
    model: &Model,
    equations: &mut Arc<Equations>,
) -> Vec<(usize, (String, Expr, ChangeLaw))> {
    let Mechanics::Poisson { casimirs, forces, .. } = &model.mechanics else { return Vec::new() };
    if casimirs.is_empty() {
        return Vec::new();
    }
    let equations = Arc::make_mut(equations);
    let mut changing = Vec::new();
    for (i, (name, casimir, _)) in casimirs.iter().enumerate() {
        let rate = casimir_rate(equations, *casimir, forces);
        if rate != Expr::ZERO {
            let written = equations.pool.unicode(rate);
            let short = written.chars().count() <= LONGEST;
            let shown = format!("dC/dt = {}", if short { &written } else { "∇C·f" });
            let law = ChangeLaw { shown, rate: ChangeRate::All(vec![rate]) };
            changing.push((i, (name.clone(), *casimir, law)));
        }
    }
    changing
}
