//! phaselab: a laboratory for analytical mechanics in a terminal.
//!
//! The data flows through one folder per stage: a file becomes a [`model`], the model
//! [`mechanics`]' equations, and so on; `ARCHITECTURE.md` has the whole picture.

#![warn(clippy::disallowed_methods)]

pub mod action_angle;
pub mod analysis;
pub mod app;
pub mod cancel;
pub mod claims;
pub mod cli;
pub mod diagnostic;
pub mod dynamics;
pub mod ensemble;
pub mod experiment;
pub mod expr;
pub mod file;
pub mod instrument;
pub mod integrability;
pub mod integrate;
pub mod job;
pub mod mechanics;
pub mod model;
pub mod num;
pub mod orbits;
pub mod preset;
pub mod printable;
pub mod record;
pub mod shell;
pub mod system;
pub mod view;
pub mod worker;
