//! The views of a file and its picture in space. Everything in them is an expression of the state,
//! evaluated with the observables.

use crate::expr::Expr;

/// An expression to be shown, with its source text.
#[derive(Clone, Debug)]
pub struct WrittenExpr {
    /// As written in the file.
    pub written: String,
    /// The expression itself.
    pub expression: Expr,
}

/// One pane.
#[derive(Clone, Debug)]
pub struct View {
    /// The name of its instrument.
    pub kind: String,
    /// A title, or empty.
    pub title: String,
    /// The expressions on each axis of the instrument, in order.
    pub axes: Vec<Vec<WrittenExpr>>,
    /// The frame from which a picture in space is seen; the axes of `[space]` if there is none.
    pub frame: Option<usize>,
    /// The shapes that a picture in space draws instead of the model's.
    pub shapes: Option<Vec<Shape>>,
    /// The surface of section, by its index among the model's.
    pub section: Option<usize>,
    /// What it runs over, in the order of the axes.
    pub over: Vec<Variation>,
    /// The time at which the motions of a map end, if the file gives it.
    pub until: Option<Expr>,
    /// The range of each axis, if the file gives it: expressions of the parameters.
    pub ranges: [Option<[Expr; 2]>; 2],
    /// Whether a diagram has the straight line of least squares through its points.
    pub slope: bool,
    /// Whether the vector field of its plane is drawn, with the nullclines.
    pub field: bool,
}

/// A number that differs between the motions of one picture.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Variation {
    /// The parameter of this index.
    Parameter(usize),
    /// The initial value of this index: coordinates come first, then velocities or momenta.
    Initial(usize),
}

/// A point in space: three expressions, with z up; the third is zero for a plane system.
pub type Point = [Expr; 3];

/// One part of the picture in space.
#[derive(Clone, Debug)]
pub enum Shape {
    /// A straight line.
    Line {
        /// Its first end.
        from: Point,
        /// Its second end.
        to: Point,
    },
    /// A coiled spring.
    Spring {
        /// Its first end.
        from: Point,
        /// Its second end.
        to: Point,
    },
    /// A thin line about a point.
    Circle {
        /// The point that it is about.
        centre: Point,
        /// Its radius.
        radius: Expr,
        /// Its axis; z if the file gives none.
        normal: Point,
    },
    /// A point mass.
    Mass {
        /// Its position.
        at: Point,
        /// Its drawn radius; a dot if the file gives none.
        radius: Option<Expr>,
    },
    /// The track that a point leaves behind.
    Trace {
        /// The point.
        at: Point,
    },
    /// An arrow.
    Vector {
        /// Its tail.
        at: Point,
        /// Along x, y and z.
        components: Point,
        /// The name beside its tip, or empty.
        label: String,
    },
    /// A curve, sampled at evenly spaced values of its own parameter `s`.
    Path {
        /// The sampled points, in order.
        points: Vec<Point>,
    },
    /// A square part of a plane.
    Plane {
        /// Its centre.
        at: Point,
        /// What it is perpendicular to.
        normal: Point,
        /// The length of its edge.
        size: Expr,
    },
    /// A filled disc.
    Disc {
        /// The point in its middle.
        centre: Point,
        /// Its radius.
        radius: Expr,
        /// Its axis; z if the file gives none.
        normal: Point,
        /// The share of the range of a map whose shade it has, if the file gives one.
        shade: Option<Expr>,
    },
    /// A sphere that hides what is behind it.
    Sphere {
        /// The point in its middle.
        centre: Point,
        /// Its radius.
        radius: Expr,
    },
    /// A solid cone.
    Cone {
        /// The point at which it ends.
        tip: Point,
        /// The centre of its base.
        base: Point,
        /// The radius of its base.
        radius: Expr,
    },
    /// A solid cylinder.
    Cylinder {
        /// The centre of one end.
        from: Point,
        /// The centre of the other end.
        to: Point,
        /// Its radius.
        radius: Expr,
    },
    /// Words beside a point.
    Caption {
        /// Where they begin.
        at: Point,
        /// The words.
        text: String,
    },
    /// The pieces of the model's body, rotated by its attitude, with the principal axes.
    Body {
        /// Its centre of mass.
        at: Point,
    },
}

impl Shape {
    /// The places and arrows that it is drawn from, without the directions that only turn it.
    pub fn points(&self) -> Vec<Point> {
        match self {
            Self::Line { from, to } | Self::Spring { from, to } => vec![*from, *to],
            Self::Circle { centre, .. }
            | Self::Disc { centre, .. }
            | Self::Sphere { centre, .. } => {
                vec![*centre]
            }
            Self::Mass { at, .. }
            | Self::Trace { at }
            | Self::Body { at }
            | Self::Caption { at, .. }
            | Self::Plane { at, .. } => vec![*at],
            Self::Cone { tip, base, .. } => vec![*tip, *base],
            Self::Cylinder { from, to, .. } => vec![*from, *to],
            Self::Vector { at, components, .. } => vec![*at, *components],
            Self::Path { points } => points.clone(),
        }
    }
}

/// The picture of a system in space.
#[derive(Clone, Debug, Default)]
pub struct SpacePicture {
    /// What it shows.
    pub shapes: Vec<Shape>,
    /// The point that the camera follows, if it does not show all of the motion.
    pub follow: Option<Follow>,
    /// Where the camera stands at first.
    pub viewpoint: Viewpoint,
}

/// Where the camera of a picture in space stands at first, in radians; `None` is up to the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Viewpoint {
    /// The rotation about the vertical axis.
    pub azimuth: Option<f64>,
    /// The elevation above the plane of x and y.
    pub elevation: Option<f64>,
}

/// The point that the camera follows in a picture in space.
#[derive(Clone, Copy, Debug)]
pub struct Follow {
    /// The point in the middle of the picture.
    pub at: Point,
    /// The same point of the comparison motion, which the picture holds as well.
    pub beside: Option<Point>,
    /// How far the picture reaches from it.
    pub reach: Expr,
}
