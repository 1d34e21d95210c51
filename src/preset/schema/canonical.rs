//! The tables of canonical transformations, their generators, the names of equilibria, and a complete integral.
//!
//! In: nothing. Out: their keys. Never here: whether they are canonical.

use super::key::ValueKind::{Formula, Names, Text, Texts};
use super::key::{NAME, SchemaTable, key};

pub(super) const TRANSFORMATION: SchemaTable = SchemaTable {
    head: "[[transformations]]",
    about: "By a generating function of one old and one new variable of each pair, or explicitly. The new variables are \
            `Q`, `P` for one coordinate, else `Q1` …, `P1` …; observables, views, claims and `--observe` may use them \
            where no other transformation has the same.",
    keys: &[
        NAME,
        key(
            "kind",
            Text,
            "`F1` of q, Q; `F2` of q, P; `F3` of p, Q; `F4` of p, P; `mixed`, `explicit`, `inverse`, `compose`",
        ),
        key("types", Texts, "the kind for each pair, where they differ"),
        key("of", Texts, "the transformations above that it is made of, the first to act first"),
        key("F", Formula, "the generating function"),
        key("Q", Names, "the new coordinates as functions of q, p, t, where it is explicit"),
        key("P", Names, "the new momenta"),
        key("new", Texts, "other names for the new coordinates, then for the new momenta"),
        key(
            "residual",
            Text,
            "a name for the largest entry of |M J Mᵀ − J| of an explicit one, with M from its derivatives: zero where it is canonical",
        ),
    ],
};

pub(super) const GENERATOR: SchemaTable = SchemaTable {
    head: "[[generators]]",
    about: "Of infinitesimal transformations; `run --flow-of NAME` carries the state along its flow.",
    keys: &[NAME, key("G", Formula, "a function of q, p, t").needed("write G = \"...\"")],
};

pub(super) const EQUILIBRIUM: SchemaTable = SchemaTable {
    head: "[[equilibria]]",
    about: "The equilibrium at this place has the name, in lists and beside its mark on plots; where it is missing, no other gets it.",
    keys: &[
        NAME,
        key("near", Names, "coordinates near which it is, by the parameters")
            .needed("write near = { x = \"...\" }"),
    ],
};

pub(super) const INTEGRAL: SchemaTable = SchemaTable {
    head: "[hamilton_jacobi]",
    about: "A complete integral of H(q, ∂S/∂q, t) + ∂S/∂t = 0; checked.",
    keys: &[
        key("S", Formula, "a function of q, t and the constants").needed("write S = \"...\""),
        key("constants", Texts, "the constants, one for each coordinate")
            .needed("write constants = [\"alpha\"]"),
    ],
};
