//! The tables of what is observed, and of what the file claims of its motion.
//!
//! In: nothing. Out: their keys. Never here: whether a claim holds.

use super::key::ValueKind::{Flag, Formula, List, Number, Text, Texts};
use super::key::{AT, EXPRESSION, NAME, SOURCE, SchemaTable, key};

pub(super) const OBSERVABLE: SchemaTable = SchemaTable {
    head: "[[observables]]",
    about: "Each may use those above it.",
    keys: &[
        NAME,
        EXPRESSION,
        key(
            "conserved",
            Flag,
            "`true` claims that it is conserved, `false` that it is not; without a proof, a drift above 1e-10 of the size of its terms along the motion is an error",
        ),
        key(
            "unit",
            Text,
            "its unit, for show; by default the one that follows from those of the file",
        ),
    ],
};

pub(super) const EXPECT: SchemaTable = SchemaTable {
    head: "[expect]",
    about: "The file's own test.",
    keys: &[
        key(
            "conserves",
            Texts,
            "`energy`, momenta, Casimirs, observables, expressions: claims as `conserved` of an observable",
        ),
        key("values", List(&EXPECTED_VALUE), "values at times"),
        key("events", List(&EXPECTED_EVENT), "when something happens"),
        key("count", List(&EXPECTED_COUNT), "how often it happens"),
        key("brackets", List(&EXPECTED_BRACKET), "what brackets are"),
        key("steps", List(&EXPECTED_STEP), "transformations that are a step of a method"),
        key(
            "invariants",
            Number,
            "how many independent constants without time are found, H among them",
        ),
        key("degree", Number, "up to which degree in the momenta they are searched; else 2"),
    ],
};

pub(in crate::preset) const EXPECTED_VALUE: SchemaTable = SchemaTable {
    head: "`values` of [expect]",
    about: "What an expression is at a time.",
    keys: &[
        key("name", Text, "what it is called"),
        EXPRESSION,
        AT,
        key("is", Number, "what it is then").needed("give the number: is = 2.0"),
        key(
            "within",
            Number,
            "the absolute tolerance; where not given 1e-10 of the largest size of its terms in the last eighth of the time until then, and for zero at least 1e-15 of the largest before",
        ),
        SOURCE,
    ],
};

pub(in crate::preset) const EXPECTED_EVENT: SchemaTable = SchemaTable {
    head: "`events` of [expect]",
    about: "When an event or an impulse happens.",
    keys: &[
        NAME,
        key("nth", Number, "which of them; the first where not given"),
        AT,
        key("within", Number, "the absolute tolerance; where not given 1e-10 of the time"),
        SOURCE,
    ],
};

pub(in crate::preset) const EXPECTED_COUNT: SchemaTable = SchemaTable {
    head: "`count` of [expect]",
    about: "How often it has happened by a time.",
    keys: &[
        NAME,
        key("until", Number, "the time").needed("give the time: until = 10.0").unit("time"),
        key("is", Number, "how often").needed("give the number: is = 3"),
        SOURCE,
    ],
};

pub(in crate::preset) const EXPECTED_BRACKET: SchemaTable = SchemaTable {
    head: "`brackets` of [expect]",
    about: "What the bracket of two expressions is.",
    keys: &[
        key("f", Formula, "the first").needed("write f = \"...\""),
        key("g", Formula, "the second").needed("write g = \"...\""),
        key(
            "is",
            Formula,
            "what [f, g] is, which is proved, or held against [f, g] at twenty points: a difference above 1e-10 of the size of its terms is wrong",
        )
        .needed("write is = \"...\""),
        SOURCE,
    ],
};

pub(in crate::preset) const EXPECTED_STEP: SchemaTable = SchemaTable {
    head: "`steps` of [expect]",
    about: "A transformation that is one step of a method: the same images, and the same derivatives of them.",
    keys: &[
        key("transformation", Text, "its name").needed("write transformation = \"...\""),
        key("method", Text, "the method").needed("write method = \"symplectic-euler\""),
        key("step", Formula, "its step, in parameters").needed("write step = \"h\""),
        key(
            "within",
            Number,
            "the largest difference between image and M, relative to their size; 1e-10 where not given",
        ),
        SOURCE,
    ],
};
