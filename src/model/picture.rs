//! What a file wants shown: views and the picture in space. Everything in it is an expression of
//! the state, to be evaluated beside the observables.

use crate::expr::Expr;

/// An expression to be shown, as it was written.
#[derive(Clone, Debug)]
pub struct Channel {
    /// As written in the file.
    pub written: String,
    /// What it is.
    pub expression: Expr,
}

/// One pane.
#[derive(Clone, Debug)]
pub struct View {
    /// The name of its kind, one of the table of instruments.
    pub kind: String,
    /// A title, or empty.
    pub title: String,
    /// What is written for each axis of the kind, in their order.
    pub axes: Vec<Vec<Channel>>,
    /// The frame a picture in space is seen from; the axes of `[space]` where there is none.
    pub frame: Option<usize>,
    /// What a picture in space draws in place of the model's shapes.
    pub shapes: Option<Vec<Shape>>,
}

/// A point in space: three expressions, z up; a plane system leaves the third at zero.
pub type Point = [Expr; 3];

/// One part of the picture in space.
#[derive(Clone, Debug)]
pub enum Shape {
    /// A straight piece.
    Line {
        /// From here.
        from: Point,
        /// To here.
        to: Point,
    },
    /// A coiled spring.
    Spring {
        /// From here.
        from: Point,
        /// To here.
        to: Point,
    },
    /// A circle.
    Circle {
        /// Its centre.
        centre: Point,
        /// Its radius.
        radius: Expr,
        /// Its axis; z where the file gives none.
        normal: Point,
    },
    /// A body.
    Mass {
        /// Where it is.
        at: Point,
        /// How large it is drawn; a dot where the file gives none.
        radius: Option<Expr>,
    },
    /// The track a point leaves behind.
    Trace {
        /// The point.
        at: Point,
    },
    /// An arrow.
    Vector {
        /// Its foot.
        at: Point,
        /// Its components.
        components: Point,
    },
    /// A curve, sampled: `points` are the values of the file's expressions at evenly spaced
    /// values of its own parameter `s`.
    Path {
        /// The sampled points, in order.
        points: Vec<Point>,
    },
    /// A piece of a plane.
    Plane {
        /// Its middle.
        at: Point,
        /// Its normal.
        normal: Point,
        /// Its edge.
        size: Expr,
    },
    /// The pieces of the model's body, turned by its attitude, with the principal axes.
    Body {
        /// Its centre of mass.
        at: Point,
    },
}
