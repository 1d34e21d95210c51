//! The preset's tables: the allowed keys of each, their kinds, and their purposes.
//!
//! In: the kinds of plots. Out: [`FILE`], by which the reader decides which keys are allowed or missing, and [`reference`], the
//! description of the format for users. Never here: values, names chosen by the file, or their combined meaning.

mod body;
mod canonical;
mod claims;
mod key;
mod law;
mod picture;
mod reference;

pub(super) use body::{PIECE, SOLIDS, TURN};
pub(super) use key::{Key, SchemaTable, ValueKind};
pub(super) use law::{COORDINATE, PARAMETER, VARIABLE};
pub use reference::reference;

use body::{ATTITUDE, BODY};
use canonical::{EQUILIBRIUM, GENERATOR, INTEGRAL, TRANSFORMATION};
use claims::{EXPECT, OBSERVABLE};
use key::ValueKind::{Kinds, Named, Names, Number, Table, Tables, Text, Texts};
use key::key;
use law::{COMPARISON, CONSTRAINT, EVENT, HAMILTONIAN, IMPULSE, LAGRANGIAN, POISSON, RAMP};
use picture::{FRAME, SPACE, VIEW};

pub(super) const FILE: SchemaTable = SchemaTable {
    head: "(top)",
    about: "What the file says of itself, before the first table.",
    keys: &[
        key("title", Text, "the name of the system; else that of the file"),
        key("notes", Text, "what to look for, in a few short paragraphs"),
        key("summary", Text, "the system in one line"),
        key("source", Text, "where it is from"),
        key("chapter", Text, "the section that a shipped system belongs to"),
        key("topics", Texts, "words under which it is listed"),
        key("coordinates", Named(&COORDINATE), "the coordinates in order"),
        key("variables", Named(&VARIABLE), "the variables of brackets, in place of coordinates"),
        key("parameters", Named(&PARAMETER), "what can be changed while it runs"),
        key("ramps", Tables(&RAMP), "parameters that change with the time"),
        key("definitions", Names, "names for expressions; each may use those above it"),
        key("lagrangian", Table(&LAGRANGIAN), "the law of motion by L"),
        key("hamiltonian", Table(&HAMILTONIAN), "the law of motion by H"),
        key("poisson", Table(&POISSON), "the law of motion by H and brackets"),
        key("constraints", Tables(&CONSTRAINT), "conditions that the motion satisfies"),
        key("impulses", Tables(&IMPULSE), "sudden changes of momenta"),
        key("events", Tables(&EVENT), "crossings that are located"),
        key("body", Table(&BODY), "a rigid body made of pieces"),
        key("attitude", Table(&ATTITUDE), "how the body stands"),
        key("comparison", Table(&COMPARISON), "the wrong mechanics beside the right"),
        key("transformations", Tables(&TRANSFORMATION), "transformations (q, p) → (Q, P)"),
        key("generators", Tables(&GENERATOR), "generators of infinitesimal transformations"),
        key("equilibria", Tables(&EQUILIBRIUM), "the names of equilibria"),
        key("hamilton_jacobi", Table(&INTEGRAL), "a complete integral"),
        key("observables", Tables(&OBSERVABLE), "what is watched"),
        key("expect", Table(&EXPECT), "what the file claims of its motion"),
        key("frames", Tables(&FRAME), "frames that a picture may be seen from"),
        key("views", Kinds(&VIEW), "what the screen opens with"),
        key("space", Table(&SPACE), "the system in space"),
        key("run", Table(&RUN), "how it is run"),
    ],
};

const RUN: SchemaTable = SchemaTable {
    head: "[run]",
    about: "What is left out follows from the system.",
    keys: &[
        key("method", Text, "the integrator, or `auto`"),
        key("speed", Number, "how fast it runs").unit("time per second"),
        key("start", Number, "the time of the initial values").unit("time"),
        key("until", Number, "how far a run without a screen goes").unit("time"),
        key("step", Number, "the step of a fixed-step method").unit("time"),
        key("tolerance", Number, "the accuracy of an adaptive method"),
    ],
};
