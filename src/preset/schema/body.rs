//! The tables of a rigid body: its pieces, how they are turned, and how it stands.
//!
//! In: nothing. Out: their keys. Never here: moments of inertia.

use super::key::ValueKind::{Flag, Formula, List, Table, Text, Triple};
use super::key::{SchemaTable, key};

pub(super) const BODY: SchemaTable = SchemaTable {
    head: "[body]",
    about: "It defines `Ixx` … `Izz`, `I1 ≤ I2 ≤ I3`, `body_mass` and `body_x`, `body_y`, `body_z`.",
    keys: &[key("pieces", List(&PIECE), "the pieces")
        .needed("write pieces = [ { solid = \"sphere\", mass = \"m\", radius = \"a\" } ]")],
};

/// The solids that a body can be composed of.
pub(in crate::preset) const SOLIDS: &[&str] = &[
    "sphere",
    "spherical-shell",
    "shell",
    "cylinder",
    "cylindrical-shell",
    "cone",
    "disc",
    "ring",
    "rod",
    "cuboid",
];

pub(in crate::preset) const PIECE: SchemaTable = SchemaTable {
    head: "a piece",
    about: "A solid or a point. Edges are full edges; the axis of a solid is its z.",
    keys: &[
        key("point", Flag, "`true` for a point"),
        key("solid", Text, "its shape, one of those under `turned`"),
        key("mass", Formula, "its mass").needed("write mass = \"...\""),
        key("radius", Formula, "its radius").needed("write radius = \"...\"").only(&[
            "sphere",
            "spherical-shell",
            "shell",
            "cylinder",
            "cylindrical-shell",
            "cone",
            "disc",
            "ring",
        ]),
        key("length", Formula, "its length").needed("write length = \"...\"").only(&[
            "cylinder",
            "cylindrical-shell",
            "rod",
        ]),
        key("height", Formula, "its height").needed("write height = \"...\"").only(&["cone"]),
        key("size", Triple, "its edges")
            .needed("write size = [\"...\", \"...\", \"...\"]")
            .only(&["cuboid"]),
        key("at", Triple, "its centre of mass; the origin where not given"),
        key("turned", Table(&TURN), "how it is turned").only(SOLIDS),
    ],
};

/// The rotation of a piece.
pub(in crate::preset) const TURN: SchemaTable = SchemaTable {
    head: "`turned` of a piece",
    about: "By an axis and an angle, by the right-hand rule; or by Euler's angles.",
    keys: &[
        key("axis", Triple, "about what")
            .needed("write axis = [\"...\", \"...\", \"...\"]")
            .only(&["axis and angle"]),
        key("angle", Formula, "by how much")
            .needed("write angle = \"...\"")
            .only(&["axis and angle"])
            .unit("rad"),
        key("euler", Triple, "φ, θ, ψ: about z by ψ, then x by θ, then z by φ")
            .only(&["Euler's angles"])
            .unit("rad"),
    ],
};

pub(super) const ATTITUDE: SchemaTable = SchemaTable {
    head: "[attitude]",
    about: "The matrix from space axes to body axes, `A11` … `A33`: by `euler`, or by `omega`.",
    keys: &[
        key("euler", Triple, "Euler's angles φ, θ, ψ as functions of q and t").unit("rad"),
        key("omega", Triple, "the angular velocity about the body's axes").unit("rad/time"),
        key("start", Triple, "Euler's angles at the start, beside `omega`").unit("rad"),
    ],
};
