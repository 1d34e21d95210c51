//! The application by its keys: a state, keys, the state and the effects after them.

mod editor;
mod keys;
pub(crate) mod real;
mod saved;
mod scripts;
mod search;
mod values;
mod workbench;
