//! The tables of what is drawn: frames, views, the system in space and its shapes.
//!
//! In: what the kinds of plots say of themselves. Out: the keys. Never here: a kind by its name, what a picture looks like.

use super::key::ValueKind::{Flag, Formula, Formulas, List, Number, PlotKind, Point, Text, Triple};
use super::key::{NAME, SchemaTable, key};
use crate::instrument::Properties;

pub(super) const FRAME: SchemaTable = SchemaTable {
    head: "[[frames]]",
    about: "It turns and moves, or is that of the body.",
    keys: &[
        NAME,
        key("attitude", Flag, "`true` for the frame of the body"),
        key("axis", Triple, "about what it turns; z where not given"),
        key("angle", Formula, "by how much, of q and t; needed without `attitude`").unit("rad"),
        key("origin", Triple, "where it is"),
        key("particles", List(&PARTICLE), "on which apparent forces are drawn"),
    ],
};

pub(in crate::preset) const PARTICLE: SchemaTable = SchemaTable {
    head: "`particles` of a frame",
    about: "On which the apparent forces are drawn.",
    keys: &[
        key("at", Triple, "where it is").needed("write at = [\"...\", \"...\", \"...\"]"),
        key("mass", Formula, "its mass").needed("write mass = \"...\""),
    ],
};

pub(super) const VIEW: SchemaTable = SchemaTable {
    head: "[[views]]",
    about: "A `potential` is `y` over the coordinate `x`, with all else fixed.",
    keys: &[
        key("kind", PlotKind, "")
            .needed("write kind = \"phase\", \"space\", \"time\", \"potential\" or \"section\""),
        key("title", Text, "what it is called"),
        key("x", Formula, "the horizontal axis").of_plots(|plot| has_axis(plot, "x")),
        key("y", Formulas, "the vertical axis; several in a time series")
            .of_plots(|plot| has_axis(plot, "y")),
        key("over", Text, "the parameter over whose range it runs")
            .needed("write over = \"...\", a parameter")
            .of_plots(|plot| plot.is_over_a_parameter),
        key("on", Formula, "vanishes on the surface of section")
            .needed("write on = \"...\", which vanishes on the surface")
            .of_plots(|plot| plot.is_section),
        key("direction", Text, "of the crossings: `rising`, `falling` or `either`; `rising`")
            .of_plots(|plot| plot.is_section),
        key("x_range", Formulas, "the two ends of the horizontal axis")
            .of_plots(|plot| plot.is_section),
        key("y_range", Formulas, "the two ends of the vertical axis")
            .of_plots(|plot| plot.is_section),
        key(
            "of",
            Formula,
            "the quantity at the end of the motions; without it and `on` the largest exponent",
        )
        .of_plots(|plot| plot.follows_motions),
        key("until", Formula, "the time at which the motions end")
            .of_plots(|plot| plot.follows_motions),
        key("slope", Flag, "`true` draws the straight line of least squares, with its slope")
            .of_plots(|plot| plot.is_over_a_parameter),
        key("field", Flag, "`true` draws the vector field of the plane, with its nullclines")
            .of_plots(|plot| plot.has_vector_field),
        key("frame", Text, "the frame it is seen from").of_plots(|plot| plot.is_scene),
        key("shapes", List(&SHAPE), "what is drawn in place of the shapes of [space]")
            .of_plots(|plot| plot.is_scene),
    ],
};

fn has_axis(plot: &Properties, key: &str) -> bool {
    plot.written.iter().any(|axis| axis.key == key)
}

pub(super) const SPACE: SchemaTable = SchemaTable {
    head: "[space]",
    about: "Points have two or three expressions, z up.",
    keys: &[
        key("shapes", List(&SHAPE), "what is drawn"),
        key(
            "follow",
            Point,
            "the point in the middle of the picture; else all of the motion is shown",
        ),
        key("reach", Formula, "how far the picture reaches from `follow`"),
        key(
            "azimuth",
            Number,
            "how far the eye is turned about z, in degrees; 30 where not given, 0 for a picture in the plane",
        ),
        key(
            "elevation",
            Number,
            "how high the eye stands above the plane of x and y, in degrees; 20 where not given, 90 for a picture in the plane",
        ),
    ],
};

pub(super) const SHAPE: SchemaTable = SchemaTable {
    head: "a shape",
    about: "Its kind is a key of its own.",
    keys: &[
        key("line", Point, "a line from here"),
        key("spring", Point, "a spring from here"),
        key("trace", Point, "the track that this point leaves"),
        key("circle", Point, "a circle about this centre"),
        key("mass", Point, "a mass here"),
        key("path", Point, "a curve in its own parameter `s`"),
        key("vector", Point, "a vector from here"),
        key("plane", Point, "a plane about this point"),
        key("disc", Point, "a filled disc about this centre"),
        key("sphere", Point, "a sphere about this centre, which hides what is behind it"),
        key("cone", Point, "a solid cone with this tip"),
        key("cylinder", Point, "a solid cylinder from the centre of this end"),
        key("caption", Point, "words beside this point"),
        key("body", Point, "the pieces of [body] about this centre of mass, turned by [attitude]"),
        key("to", Point, "the other end, the components, or the centre of the base")
            .only(&["line", "spring", "vector", "cone", "cylinder"]),
        key("label", Text, "the name beside its tip").only(&["vector"]),
        key("text", Text, "the words").needed("write text = \"...\"").only(&["caption"]),
        key("radius", Formula, "its radius")
            .only(&["circle", "mass", "disc", "sphere", "cone", "cylinder"]),
        key("normal", Point, "what it is perpendicular to; z where not given")
            .only(&["circle", "plane", "disc"]),
        key("shade", Formula, "the share of the range of a map, from 0 to 1, whose shade it has")
            .only(&["disc"]),
        key("size", Formula, "how large it is").only(&["plane"]),
        key("from", Formula, "where `s` begins").only(&["path"]),
        key("to", Formula, "where `s` ends").only(&["path"]),
        key("samples", Number, "how many points are drawn").only(&["path"]),
    ],
};
