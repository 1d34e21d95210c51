//! A rigid body put together from pieces, how it stands, and the frames it is seen from.

use super::{Point, SourceRange};
use crate::expr::{Expr, Symbol};

/// A rigid body.
#[derive(Clone, Debug)]
pub struct Body {
    /// What it is made of.
    pub pieces: Vec<Piece>,
    /// What follows from the pieces, as names that stand wherever a parameter may.
    pub names: BodyNames,
    /// Where the table stands in the file.
    pub place: SourceRange,
}

/// The names a body defines. They have values of their own at every set of parameters.
#[derive(Clone, Copy, Debug)]
pub struct BodyNames {
    /// `Ixx Iyy Izz Ixy Ixz Iyz` about the centre of mass, products with the minus sign.
    pub inertia: [Symbol; 6],
    /// `I1 ≤ I2 ≤ I3`.
    pub principal: [Symbol; 3],
    /// `body_mass`.
    pub mass: Symbol,
    /// `body_x body_y body_z`.
    pub centre: [Symbol; 3],
}

impl BodyNames {
    /// How they are written: six components, three moments, the mass, the centre of mass.
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

    /// All of them.
    pub fn all(&self) -> Vec<Symbol> {
        let single = [self.mass];
        [&self.inertia[..], &self.principal, &single, &self.centre].concat()
    }
}

/// One piece: a solid, placed and turned.
#[derive(Clone, Debug)]
pub struct Piece {
    /// What it is.
    pub solid: Solid,
    /// Its mass.
    pub mass: Expr,
    /// Its centre of mass.
    pub at: Point,
    /// How it is turned; not at all where the file says nothing.
    pub turn: Turn,
    /// Where it stands in the file.
    pub place: SourceRange,
}

/// The standard solids, in axes of their own: edges are full edges, lengths full lengths.
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
        /// Its length.
        length: Expr,
    },
    /// A thin open tube along z.
    CylindricalShell {
        /// Its radius.
        radius: Expr,
        /// Its length.
        length: Expr,
    },
    /// A solid cone about z, tip up.
    Cone {
        /// The radius of its base.
        radius: Expr,
        /// Its height.
        height: Expr,
    },
    /// A thin disc at right angles to z.
    Disc(Expr),
    /// A thin ring at right angles to z.
    Ring(Expr),
    /// A thin rod along z, of this length.
    Rod(Expr),
    /// A solid block.
    Cuboid([Expr; 3]),
}

/// A turning of a piece.
#[derive(Clone, Debug)]
pub enum Turn {
    /// None.
    None,
    /// By the right-hand rule about an axis of any length.
    Axis {
        /// The axis.
        axis: Point,
        /// The angle.
        angle: Expr,
    },
    /// Euler's angles φ, θ, ψ: about z by ψ, then about x by θ, then about z by φ.
    Euler([Expr; 3]),
}

/// How a body stands: A takes components along space axes to those along body axes.
#[derive(Clone, Debug)]
pub struct Attitude {
    /// `A11 … A33`, by rows.
    pub matrix: [[Symbol; 3]; 3],
    /// Where A comes from.
    pub source: AttitudeSource,
    /// Where the table stands in the file.
    pub place: SourceRange,
}

impl Attitude {
    /// How the entries of the matrix are written, by rows.
    pub const WRITTEN: [[&'static str; 3]; 3] =
        [["A11", "A12", "A13"], ["A21", "A22", "A23"], ["A31", "A32", "A33"]];
}

/// Where an attitude comes from.
#[derive(Clone, Debug)]
pub enum AttitudeSource {
    /// Euler's angles φ, θ, ψ: A = B(ψ) C(θ) D(φ).
    Euler([Expr; 3]),
    /// Integrated beside the motion: A′ = −\[ω\]× A.
    Rate {
        /// ω about the body axes.
        omega: Point,
        /// Euler's angles at the start, in parameters.
        start: [Expr; 3],
    },
}

/// The wrong mechanics beside the right: the constraints put into L before it is varied.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// The coordinates whose velocities the constraints are solved for.
    pub eliminate: Vec<usize>,
    /// `other_x` of each coordinate, and `other_x'`.
    pub symbols: Vec<(Symbol, Symbol)>,
    /// Where the table stands in the file.
    pub place: SourceRange,
}

/// Axes a picture in space may be seen from.
#[derive(Clone, Debug)]
pub struct Frame {
    /// As written in the file.
    pub name: String,
    /// The axis it turns about; z where the file gives none.
    pub axis: Point,
    /// The angle from the axes of `[space]`.
    pub angle: Expr,
    /// Its origin in these axes.
    pub origin: Point,
    /// The particles whose apparent forces are drawn: where, and the mass.
    pub particles: Vec<(Point, Expr)>,
    /// Whether it is the frame of the body of `[attitude]`; axis and angle say nothing then.
    pub attitude: bool,
}
