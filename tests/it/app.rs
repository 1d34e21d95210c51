//! The application driven by keys: a state, keys, and the resulting state and effects.

mod companions;
mod editor;
mod equilibria;
mod flow;
mod guides;
mod invariants;
mod keys;
mod marks;
mod mend;
mod notices;
mod ramp;
pub(crate) mod real;
mod saved;
mod scripts;
mod search;
mod share;
mod surface;
mod typed_axis;
mod undo;
mod values;
mod workbench;
