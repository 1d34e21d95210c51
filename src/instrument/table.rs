//! The table of instruments.
//!
//! In: the files of the kinds. Out: the kinds in their order, found by name, with what they offer. Never here: what a
//! single kind does, or what kinds have in common.

use super::kind::{Instrument, Offer};
use super::present::Physics;
use super::{
    action, actions, angle, diagram, ensemble, exponents, family, flow, legendre, map, orbit,
    paths, phase, potential, section, separation, space, spectrum, time, transformation,
};

/// All kinds, in the order in which the lab opens with them.
pub static INSTRUMENTS: [&dyn Instrument; 24] = [
    &space::Space,
    &phase::Phase,
    &transformation::TransformationPlot,
    &section::SectionPlot,
    &potential::Potential,
    &time::Time,
    &separation::SeparationPlot,
    &exponents::Exponents,
    &flow::FlowPlot,
    &ensemble::Ensemble,
    &orbit::OrbitPlot,
    &family::FamilyPlot,
    &spectrum::SpectrumPlot,
    &actions::ActionsPlot,
    &angle::AnglePlot,
    &action::ActionPlot(action::Principle::Hamilton),
    &action::ActionPlot(action::Principle::Maupertuis),
    &action::ActionPlot(action::Principle::PhaseSpace),
    &paths::PathsPlot,
    &legendre::LegendrePlot,
    &diagram::Diagram(diagram::DiagramQuantity::Crossings),
    &diagram::Diagram(diagram::DiagramQuantity::Frequency),
    &diagram::Diagram(diagram::DiagramQuantity::Period),
    &map::Map,
];

/// Finds a kind by its name.
pub fn named(name: &str) -> Option<&'static dyn Instrument> {
    INSTRUMENTS.into_iter().find(|kind| kind.name() == name)
}

/// The names of all kinds, with a word before the last: `a, b and c`.
pub fn listed(quote: &str, before_last: &str) -> String {
    let names: Vec<String> =
        INSTRUMENTS.iter().map(|kind| format!("{quote}{}{quote}", kind.name())).collect();
    match names.split_last() {
        Some((last, rest)) if !rest.is_empty() => {
            format!("{} {before_last} {last}", rest.join(", "))
        }
        _ => names.concat(),
    }
}

/// The choices for a pane: first the complete ones and those that begin without a quantity, then the quantities.
pub fn offers(physics: Physics<'_>) -> Vec<(&'static dyn Instrument, Offer)> {
    let of = |kind: &'static dyn Instrument| {
        kind.offers(physics).into_iter().map(move |offer| (kind, offer))
    };
    let mut all: Vec<_> = INSTRUMENTS.into_iter().flat_map(of).collect();
    all.sort_by_key(|(_, offer)| !offer.columns.is_empty() || !offer.over.is_empty());
    all
}
