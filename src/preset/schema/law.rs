//! The tables of what moves and of its law: coordinates, parameters, L, H or brackets, constraints, impulses, events.
//!
//! In: nothing. Out: their keys. Never here: tables of what is claimed or drawn.

use super::key::ValueKind::{Brackets, Constant, Formula, Formulas, Names, Number, Text, Texts};
use super::key::{ABOUT, FORCES, H, INITIAL, NAME, PERIOD, SYMBOL, SchemaTable, UNIT, key};

pub(in crate::preset) const COORDINATE: SchemaTable = SchemaTable {
    head: "[coordinates]",
    about: "The coordinates in order: `theta = { initial = 2.0 }`, or `theta = 2.0`, its initial value alone.",
    keys: &[
        INITIAL,
        key(
            "velocity",
            Formula,
            "its velocity at the start; else 0, or what the constraints leave",
        ),
        key("momentum", Formula, "its momentum at the start, beside a Hamiltonian"),
        SYMBOL,
        UNIT,
        PERIOD,
    ],
};

pub(in crate::preset) const VARIABLE: SchemaTable = SchemaTable {
    head: "[variables]",
    about: "The variables of a `[poisson]` file in order: a number or an expression, or a table. `L1'` is the rate of `L1`.",
    keys: &[INITIAL, SYMBOL, UNIT, PERIOD],
};

pub(in crate::preset) const PARAMETER: SchemaTable = SchemaTable {
    head: "[parameters]",
    about: "What can be changed while it runs: a number or an expression of numbers (`\"2*pi\"`), or a table.",
    keys: &[
        key("value", Constant, "what it is").needed("write { value = 1.0 }"),
        key("min", Number, "the least it can be set to"),
        key("max", Number, "the greatest"),
        key("scale", Text, "how its keys step: `linear` or `log`"),
        UNIT,
        SYMBOL,
        ABOUT,
    ],
};

pub(super) const RAMP: SchemaTable = SchemaTable {
    head: "[[ramps]]",
    about: "A parameter that goes from its value to another one: a function of the time wherever it is used, but for initial values. Of several of one parameter each begins at the value that those before it in the file have reached, and ends what is left of them.",
    keys: &[
        key("parameter", Text, "its name").needed("write parameter = \"omega\""),
        key("to", Formula, "where it leads, of other parameters").needed("write to = 2"),
        key("start", Formula, "when it begins; 0 where not given"),
        key("duration", Formula, "how long it takes").needed("write duration = 100"),
        key(
            "form",
            Text,
            "`smooth` (10u³ − 15u⁴ + 6u⁵), where not given; `cubic` (3u² − 2u³), `linear`",
        ),
    ],
};

pub(super) const LAGRANGIAN: SchemaTable = SchemaTable {
    head: "[lagrangian]",
    about: "d/dt(∂L/∂q') − ∂L/∂q + ∂F/∂q' = Q.",
    keys: &[
        key("L", Formula, "the Lagrangian").needed("write L = \"T - V\""),
        key("dissipation", Formula, "Rayleigh's function F"),
        FORCES,
    ],
};

pub(super) const HAMILTONIAN: SchemaTable = SchemaTable {
    head: "[hamiltonian]",
    about: "q' = ∂H/∂p, p' = −∂H/∂q + force.",
    keys: &[H, FORCES],
};

pub(super) const POISSON: SchemaTable = SchemaTable {
    head: "[poisson]",
    about: "x' = {x, H} + force.",
    keys: &[
        H,
        key("brackets", Brackets, "the bracket of each pair of variables, once")
            .needed("write brackets = [[\"a\", \"b\", \"{a, b}\"], ...], one for each pair"),
        key("casimirs", Names, "functions that commute with every variable; checked"),
        FORCES,
    ],
};

pub(super) const CONSTRAINT: SchemaTable = SchemaTable {
    head: "[[constraints]]",
    about: "Beside a Lagrangian, linear in the velocities; without velocities it restricts the coordinates.",
    keys: &[
        NAME,
        key("expression", Formula, "what must be zero")
            .needed("write expression = \"...\", which is to be zero"),
        key("unit", Text, "the unit of its multiplier, for show"),
        key("about", Text, "what its multiplier is"),
    ],
};

pub(super) const IMPULSE: SchemaTable = SchemaTable {
    head: "[[impulses]]",
    about: "Without `at` and `every` it is applied by a key.",
    keys: &[
        NAME,
        key("at", Formulas, "when it is applied").unit("time"),
        key("every", Formula, "the interval, the first time one interval after the start")
            .unit("time"),
        key("change", Names, "by how much which momentum changes")
            .needed("write change = { p_x = \"...\" }"),
        ABOUT,
    ],
};

pub(super) const EVENT: SchemaTable = SchemaTable {
    head: "[[events]]",
    about: "Located where an expression crosses zero.",
    keys: &[
        NAME,
        key("when", Formula, "what crosses zero")
            .needed("write when = \"...\"; it happens where that crosses zero"),
        key("direction", Text, "`rising`, `falling` or `either`, which it is where not given"),
        key(
            "action",
            Text,
            "`mark`, where not given; `stop`, `release:CONSTRAINT`, `impulse:IMPULSE`",
        ),
    ],
};

pub(super) const COMPARISON: SchemaTable = SchemaTable {
    head: "[comparison]",
    about: "The constraints are put into L before it is varied; the motion is `other_x`.",
    keys: &[key("eliminate", Texts, "the coordinates whose velocities are eliminated")
        .needed("write eliminate = [\"x\"], one coordinate for each constraint")],
};
