//! One integration-test binary.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod action_variable;
mod analysis;
mod app;
mod batch;
mod build;
mod circles;
mod cli;
mod config;
mod constrain;
mod constraint_corner;
mod course;
mod diagram;
mod documents;
mod double;
mod dynamics;
mod elementary;
mod ensemble;
mod escaping_cloud;
mod event_functions;
mod experiment;
mod expr;
mod expr_parse;
mod family;
mod fixtures;
mod flow_plot;
mod fuzz;
mod honest;
mod impasse;
mod instrument;
mod integrability;
mod laboratory;
mod layers;
mod legendre;
mod map;
mod mechanics;
mod methods;
mod multiple_roots;
mod notation;
mod occurrences;
mod orbit;
mod orbits;
mod paused_cloud;
mod periodic_points;
mod plot;
mod poisson;
mod preset;
mod property;
mod record;
mod reference;
mod report_corpus;
mod rigid_body;
mod screen;
mod section;
mod section_marks;
mod several_motions;
mod starts;
mod stroboscope;
mod system;
mod tangent;
mod taylor;
mod terminal;
mod thresholds;
mod transformation;
mod units;
mod vector_field;
mod words;
mod worker;

use proptest::test_runner::Config;

/// The items of a list, which must have some, so that a loop over them checks something.
fn nonempty<T>(items: impl IntoIterator<Item = T>) -> Vec<T> {
    let items: Vec<T> = items.into_iter().collect();
    assert!(!items.is_empty(), "there is nothing to check");
    items
}

/// The number of random cases of a property, scaled by `PROPTEST_CASES` relative to its default of 256 if that is set.
fn cases(count: u32) -> Config {
    let config = Config::default();
    Config { cases: count * config.cases.max(32) / 256, failure_persistence: None, ..config }
}
