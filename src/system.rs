//! A compiled system: from here on there are only numbers.
//!
//! In: a [`Model`](crate::model::Model), the [`Equations`](crate::mechanics::Equations) derived
//! from it, and expressions to observe. Out: a [`System`], which makes initial states
//! ([`System::initial`]), transfers states when parameters change ([`System::change_parameters`]),
//! computes the observables of a state ([`System::observer`]) and gives the steppers of `integrate`
//! their equations of motion. Never here: steps in time, files, symbols after compiling.
//!
//! ```text
//!   expressions of the equations
//!        │ rhs, observables, terms, legendre, discontinuities, constraint_programs: which program computes what
//!        │ lower, node: every canonical node becomes a few operations
//!        ▼
//!   Program (program)  one flat list; what depends on parameters alone stands in front of it
//!        │   tangent: its derivative, a program again     split_step: both halves of a splitting step in one list
//!        │                                                rates_list, lane_rates: rates in one list, for several states at once
//!        │
//!        ├──────────────── values ────────────────┐  ┌───────── Taylor coefficients ─────────┐
//!        ▼                                        │  │                                       ▼
//!   Evaluator (value)                             │  │     schedule: inner products first,
//!     f64, double-double, batches of orbits       │  │     finishing_pass: then the rest, sorted by kind
//!        ▼                                        │  │     jet: order k of all registers, f64 … batches
//!   rates, exact       motion of every method     │  │          machine_code: the same orders by generated code
//!   observe            channels of a state        │  │                                       ▼
//!                                                 │  │     growth, series, batch_series
//!   term_watch, batch_terms   conserved terms     │  │     expansion: events along a step
//!   event_functions    signs of events            │  │     resolution: how far a series tells
//!        └────────────────────────────────────────┘  └───────────────────────────────────────┘
//!
//!   Around them: conversion (initial states, velocities ↔ momenta), constrained, projection and active_set
//!   (constraints), impulse and saltation (jumps), image (maps that are solved for), error (why a motion ends).
//! ```

mod active_set;
mod allowed_displacements;
mod attitude;
mod batch_event_signs;
mod batch_series;
mod batch_split_step;
mod batch_states;
mod batch_steps;
mod batch_terms;
mod batch_values;
mod branch;
mod channel;
mod compilation;
mod compiled;
mod conditions;
mod consistent_initial;
mod constrained;
mod constraint_corner;
mod constraint_programs;
mod constraint_span;
mod conversion;
mod converter;
mod discontinuities;
mod elimination;
mod enclosure;
mod energy;
mod error;
mod error_report;
mod event_functions;
mod exact;
mod expansion;
mod finishing_pass;
mod growth;
mod image;
mod impulse;
mod inertia;
mod instruction;
mod jet;
mod kink_sides;
mod kkt;
mod lane_rates;
mod lane_series;
mod legendre;
mod logarithms;
mod lower;
mod machine_code;
mod made_once;
mod mass_determinant;
mod native_states;
mod node;
mod observables;
mod observe;
mod operation;
mod overflow;
mod parametric_power;
mod parts;
mod program;
mod program_inputs;
mod projection;
mod projector;
mod rates;
mod rates_list;
mod register_map;
mod registers;
mod resolution;
mod rhs;
mod saltation;
mod schedule;
mod separability;
mod series;
mod sign_bound;
mod solve;
mod split_step;
mod stage_list;
mod stage_machine;
mod state;
mod state_layout;
mod state_sum;
mod steep_arguments;
mod steep_program;
mod step_in_time;
mod step_series;
mod steps_in_time;
mod surface;
mod tangent;
mod term_sizes;
mod term_watch;
mod terms;
mod underflow;
mod valuation;
mod value;
mod variational;
mod variations;

pub use allowed_displacements::AllowedDisplacements;
pub use batch_event_signs::BatchEventSigns;
pub use batch_series::BatchSeries;
pub use batch_split_step::BatchSplitStep;
pub use batch_states::BatchStates;
pub use batch_steps::BatchSteps;
pub use batch_terms::BatchTerms;
pub use branch::Branch;
pub use channel::{Channel, ChannelKind};
pub use compilation::CompileError;
pub use compiled::System;
pub use converter::Converter;
pub use discontinuities::{CompiledAction, CompiledEvent, CompiledImpulse, Discontinuities};
pub use enclosure::Enclosure;
pub use error::{MotionError, MotionErrorKind, Passage};
pub use event_functions::EventFunctions;
pub use exact::ExactRates;
pub use impulse::{ImpulseOutcome, ImpulseTimes};
pub use jet::{Jet, Side};
pub use kink_sides::KinkSides;
pub use lane_rates::{LaneRates, OrbitRates, STAGES, StageRates, Stages};
pub use lane_series::LaneSeries;
pub use logarithms::Logarithms;
pub use observe::Observer;
pub use program::{Program, Singular};
pub use projector::{ConstraintDirections, ConstraintProjector};
pub use rates::Rates;
pub use saltation::Saltation;
pub use series::Series;
pub use split_step::SplitStep;
pub use stage_list::Composition;

pub use state::{Form, InitialOverride, State};
pub use steep_arguments::SteepArguments;
pub use step_series::StepSeries;
pub use steps_in_time::{StepsInTime, instant_of};
pub use surface::SurfaceRow;
pub use term_watch::{TermSums, TermWatch};
pub use value::Evaluator;
