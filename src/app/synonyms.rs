//! Other words for actions: what a person types who does not know how the table of keys puts it.
//!
//! In: an action. Out: the words, for the palette's search and for that of the help. Never here: keys, or how a line is
//! searched.

use super::action::{Action, AxisChoice};
use super::page::Page;

/// Returns other words for an action.
pub fn synonyms(action: Action) -> &'static [&'static str] {
    match action {
        Action::Ask => &["is this conserved", "conserved", "constant of the motion", "commute"],
        Action::SearchFurther => {
            &["conserved quantities", "first integrals", "invariants", "integrable", "Liouville"]
        }
        Action::Equilibria => &[
            "stable",
            "unstable",
            "stability",
            "equilibrium",
            "fixed points",
            "normal modes",
            "eigenvalues",
            "linearise",
        ],
        Action::ApplyFlow => {
            &["Noether", "Lie symmetries", "generator", "canonical transformation"]
        }
        Action::Active => &["canonical transformation", "active and passive"],
        Action::Show(Page::Equations) => {
            &["equations of motion", "momenta", "canonical", "symmetries"]
        }
        Action::TypeSurface => &["Poincaré section", "stroboscope", "return map"],
        Action::Diagram => &["bifurcation", "sweep"],
        Action::Exponents => &["chaos", "Lyapunov", "predictable", "sensitive"],
        Action::AddNeighbour => &["butterfly effect", "sensitive"],
        Action::ByChaos => &["chaos"],
        Action::VectorField => &["direction field", "slope field", "arrows", "phase flow"],
        Action::Reset => {
            &["restart", "back to the start", "start over", "start again", "clear the trail"]
        }
        Action::FullReset => &["restart with the original values", "defaults"],
        Action::PlayPause => &["stop", "run", "play", "freeze"],
        Action::StepBack | Action::ShowEarlier => &["rewind", "earlier"],
        Action::Reverse => &["backwards"],
        Action::Faster => &["speed up", "fast forward"],
        Action::Slower => &["speed", "slow down", "slow motion"],
        Action::Mouse => &["drag", "click", "wheel"],
        Action::Closer(AxisChoice::Both) => &["zoom in", "magnify"],
        Action::Farther(AxisChoice::Both) => &["zoom out"],
        Action::Home => &["restore the view", "original view"],
        Action::ChooseAxes => &["another plot", "graph", "phase portrait"],
        Action::ChooseMethod => &["integrator", "solver"],
        Action::Spectrum => &["Fourier", "frequency", "quasi-periodic", "torus"],
        Action::PeriodicOrbit => &["closed orbit", "Floquet", "monodromy"],
        Action::Pin => &["compare", "keep"],
        Action::Still => &["picture", "image", "print"],
        Action::Data => &["export", "save the data"],
        Action::Record => &["video", "film", "animation", "gif"],
        Action::Export => &["save"],
        Action::Share => &["link", "command line", "reproduce", "send"],
        Action::Edit => &["Lagrangian", "Hamiltonian", "source", "friction", "force"],
        Action::Guides => &["tutorial", "learn", "examples"],
        Action::ChooseTheme => &["colors"],
        Action::Quit => &["exit"],
        _ => &[],
    }
}
