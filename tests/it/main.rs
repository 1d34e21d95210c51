//! One integration-test binary.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod analysis;
mod app;
mod build;
mod cli;
mod config;
mod constrain;
mod double;
mod elementary;
mod experiment;
mod expr;
mod expr_parse;
mod hand;
mod impasse;
mod layers;
mod mechanics;
mod methods;
mod occurrences;
mod plot;
mod poisson;
mod preset;
mod property;
mod readme;
mod record;
mod reference;
mod rigid_body;
mod screen;
mod starts;
mod system;
mod taylor;
mod terminal;
mod thresholds;
mod worker;
