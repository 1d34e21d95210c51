//! A rigid body assembled from pieces, its attitude, and the frames from which it is seen.

use super::Point;
use crate::diagnostic::SourceRange;
use crate::expr::{Expr, Symbol};

/// A rigid body.
#[derive(Clone, Debug)]
pub struct Body {
    /// The pieces it consists of.
    pub pieces: Vec<Piece>,
    /// The names defined by the body, which may be used wherever a parameter may.
    pub names: BodyNames,
    /// The place of the table in the file.
    pub place: SourceRange,
}

/// The names that a body defines. Their values depend on the parameters.
#[derive(Clone, Copy, Debug)]
pub struct BodyNames {
    /// `Ixx Iyy Izz Ixy Ixz Iyz` about the centre of mass; products carry the minus sign.
    pub inertia: [Symbol; 6],
    /// `I1 ≤ I2 ≤ I3`.
    pub principal: [Symbol; 3],
    /// `body_mass`.
    pub mass: Symbol,
    /// `body_x body_y body_z`.
    pub centre: [Symbol; 3],
}

impl BodyNames {
    /// Their spellings: six components, three moments, the mass, the centre of mass.
    pub const WRITTEN: [&'static str; 13] = [
        "Ixx",
        "Iyy",
        "Izz",
        "Ixy",
        "Ixz",
        "Iyz",
        "I1",
        "I2",
        "I3",
        "body_mass",
        "body_x",
        "body_y",
        "body_z",
    ];

    /// All symbols, in the order of `WRITTEN`.
    pub fn all(&self) -> Vec<Symbol> {
        let single = [self.mass];
        [&self.inertia[..], &self.principal, &single, &self.centre].concat()
    }
}

/// One piece: a solid with a position and an orientation.
#[derive(Clone, Debug)]
pub struct Piece {
    /// Its shape.
    pub solid: Solid,
    /// As the file writes it.
    pub mass: Expr,
    /// Its centre of mass.
    pub at: Point,
    /// Its orientation; [`PieceOrientation::None`] if the file gives none.
    pub turn: PieceOrientation,
    /// Its place in the file.
    pub place: SourceRange,
}

/// The standard solids along their own axes. Edges and lengths are full edges and lengths.
#[derive(Clone, Debug)]
pub enum Solid {
    /// A point mass.
    Point,
    /// A solid ball of this radius.
    Sphere(Expr),
    /// A thin spherical shell.
    SphericalShell(Expr),
    /// A solid cylinder along z.
    Cylinder {
        /// Its radius.
        radius: Expr,
        /// From end to end.
        length: Expr,
    },
    /// A thin open tube along z.
    CylindricalShell {
        /// Its radius.
        radius: Expr,
        /// From end to end.
        length: Expr,
    },
    /// A solid cone about z, with its tip up.
    Cone {
        /// The radius of its base.
        radius: Expr,
        /// From its base to its tip.
        height: Expr,
    },
    /// A thin disc perpendicular to z.
    Disc(Expr),
    /// A thin ring perpendicular to z.
    Ring(Expr),
    /// A thin rod along z, of this length.
    Rod(Expr),
    /// A solid block.
    Cuboid([Expr; 3]),
}

/// How a piece is turned within the body.
#[derive(Clone, Debug)]
pub enum PieceOrientation {
    /// Not rotated.
    None,
    /// Rotated by the right-hand rule about an axis of any length.
    Axis {
        /// About what it is turned, of any length.
        axis: Point,
        /// By how much it is turned.
        angle: Expr,
    },
    /// Euler's angles φ, θ, ψ: about z by ψ, then about x by θ, then about z by φ.
    Euler([Expr; 3]),
}

/// The attitude of a body: the matrix A takes components along space axes to those along body axes.
#[derive(Clone, Debug)]
pub struct Attitude {
    /// `A11 … A33`, by rows.
    pub matrix: [[Symbol; 3]; 3],
    /// Where A comes from.
    pub source: AttitudeSource,
}

impl Attitude {
    /// The spellings of the matrix entries, by rows.
    pub const WRITTEN: [[&'static str; 3]; 3] =
        [["A11", "A12", "A13"], ["A21", "A22", "A23"], ["A31", "A32", "A33"]];
}

/// Where an attitude comes from.
#[derive(Clone, Debug)]
pub enum AttitudeSource {
    /// Euler's angles φ, θ, ψ: A = B(ψ) C(θ) D(φ).
    Euler([Expr; 3]),
    /// Integrated alongside the motion: A′ = −\[ω\]× A.
    Rate {
        /// ω along the body axes.
        omega: Point,
        /// Euler's angles at the start, in terms of parameters.
        start: [Expr; 3],
    },
}

/// The vakonomic comparison motion: the constraints are substituted into L before it is varied.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// The coordinates whose velocities are eliminated by the constraints.
    pub eliminate: Vec<usize>,
    /// `other_x` and `other_x'` for each coordinate.
    pub symbols: Vec<(Symbol, Symbol)>,
    /// The place of the table in the file.
    pub place: SourceRange,
}

/// Axes from which a picture in space may be seen.
#[derive(Clone, Debug)]
pub struct Frame {
    /// As written in the file.
    pub name: String,
    /// The axis about which it rotates; z if the file gives none.
    pub axis: Point,
    /// The angle from the axes of `[space]`.
    pub angle: Expr,
    /// Its origin along these axes.
    pub origin: Point,
    /// The particles whose apparent forces are drawn: position and mass.
    pub particles: Vec<(Point, Expr)>,
    /// Whether it is the frame of the body of `[attitude]`; axis and angle are then unused.
    pub attitude: bool,
}
