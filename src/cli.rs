//! The command line: one file per subcommand, each built on the same stages as the laboratory.
//!
//! In: arguments. Out: data on standard output (and nothing else there), errors and messages on
//! standard error, an exit code of [`EXITS`]. If the reader closes the pipe early (`| head`), a
//! command ends quietly and successfully. Never here: mechanics, the integration of a motion.

mod actions;
mod advice;
mod assignment;
mod bracket;
mod cells;
mod check;
mod command;
mod completions;
mod config;
mod count_bar;
mod decimal;
mod demo;
mod demo_source;
mod derive;
mod doctor;
mod equilibria;
mod error;
mod events;
mod exit;
mod flow;
mod fmt;
mod format;
mod interrupt;
mod invariants;
mod lab;
mod lab_start;
mod lesson;
mod list;
mod lyapunov;
mod manual;
mod method_options;
mod methods;
mod motion_options;
mod new;
mod number_table;
mod open;
mod orbit;
mod output;
mod path;
mod path_function;
mod play;
mod plot;
mod record;
mod report;
mod reverse;
mod rows;
mod run;
mod script;
mod section;
mod slow_notice;
mod spectrum;
mod standard_output;
mod start_options;
mod starts;
mod stderr;
mod study;
mod sweep;
mod symmetries;
mod theme;
mod threads;

pub use command::{command, main};
pub use exit::{EXITS, Exit};
