//! The preset's tables: the allowed keys of each, their kinds, and their purposes.
//!
//! In: nothing. Out: [`FILE`], by which the reader decides which keys are allowed or missing, and [`reference`], the
//! description of the format for users. Never here: values, names chosen by the file, or their combined meaning.

use std::fmt::Write as _;

/// A table of the file, or of a list in it.
#[derive(Debug)]
pub(super) struct SchemaTable {
    /// Its heading: `[run]`, `[[events]]`, or what its entries are called.
    pub(super) head: &'static str,
    /// Its purpose.
    pub(super) about: &'static str,
    /// Its keys in the order of reporting; empty if the file chooses the names.
    pub(super) keys: &'static [Key],
}

/// A key of a table.
#[derive(Clone, Copy, Debug)]
pub(super) struct Key {
    /// Its name.
    pub(super) name: &'static str,
    /// The kind of its value.
    pub(super) kind: ValueKind,
    /// The unit of its number; empty if it has none, or if the file determines it.
    pub(super) unit: &'static str,
    /// The kinds of entries that may have it; empty for all.
    pub(super) only: &'static [&'static str],
    /// What to write if it is missing; `None` if it is optional.
    pub(super) missing: Option<&'static str>,
    /// Its purpose, on one line.
    pub(super) help: &'static str,
}

/// The kind of a value.
#[derive(Clone, Copy, Debug)]
pub(super) enum ValueKind {
    /// A text in quotes.
    Text,
    /// A list of texts.
    Texts,
    /// `true` or `false`.
    Flag,
    /// A number.
    Number,
    /// A number, or an expression of numbers in quotes.
    Constant,
    /// A number or an expression in quotes.
    Formula,
    /// One or more formulas.
    Formulas,
    /// A list of two or three expressions.
    Point,
    /// A list of three expressions.
    Triple,
    /// Names chosen by the file, each with an expression.
    Names,
    /// A list of `[a, b, {a, b}]`.
    Brackets,
    /// A table.
    Table(&'static SchemaTable),
    /// A table of names chosen by the file, each with such a table.
    Named(&'static SchemaTable),
    /// Tables, each under a heading in double brackets.
    Tables(&'static SchemaTable),
    /// Tables of several kinds, whose keys are known to their own readers.
    Kinds(&'static SchemaTable),
    /// A list of tables in braces.
    List(&'static SchemaTable),
}

const fn key(name: &'static str, kind: ValueKind, help: &'static str) -> Key {
    Key { name, kind, unit: "", only: &[], missing: None, help }
}

impl Key {
    const fn needed(self, missing: &'static str) -> Key {
        Key { missing: Some(missing), ..self }
    }

    const fn only(self, only: &'static [&'static str]) -> Key {
        Key { only, ..self }
    }

    const fn unit(self, unit: &'static str) -> Key {
        Key { unit, ..self }
    }
}

use ValueKind::{
    Brackets, Constant, Flag, Formula, Formulas, Kinds, List, Named, Names, Number, Point, Table,
    Tables, Text, Texts, Triple,
};

const NAME: Key = key("name", Text, "what it is called").needed("write name = \"...\"");
const ABOUT: Key = key("about", Text, "what it is, shown beside it");
const UNIT: Key = key("unit", Text, "its unit, for show");
const SYMBOL: Key = key("symbol", Text, "the letters it is shown by");
const SOURCE: Key = key("source", Text, "where the claim is from");
const WITHIN: Key = key("within", Number, "the absolute tolerance; 1e-10 where not given");
const PERIOD: Key =
    key("period", Formula, "after which it is the same again; for drawing and rotations");
const INITIAL: Key =
    key("initial", Formula, "its value at the start").needed("give its value at the start");
const EXPRESSION: Key =
    key("expression", Formula, "what it is").needed("write expression = \"...\"");
const AT: Key = key("at", Number, "the time").needed("give the time: at = 1.0").unit("time");
const FORCES: Key = key("forces", Names, "generalised forces that come from no potential");
const H: Key = key("H", Formula, "the Hamiltonian").needed("write H = \"T + V\"");

/// The whole file.
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
        key("constraints", Tables(&CONSTRAINT), "what the motion is held to"),
        key("impulses", Tables(&IMPULSE), "sudden changes of momenta"),
        key("events", Tables(&EVENT), "crossings that are located"),
        key("body", Table(&BODY), "a rigid body made of pieces"),
        key("attitude", Table(&ATTITUDE), "how the body stands"),
        key("comparison", Table(&COMPARISON), "the wrong mechanics beside the right"),
        key("transformations", Tables(&TRANSFORMATION), "transformations (q, p) → (Q, P)"),
        key("generators", Tables(&GENERATOR), "generators of infinitesimal transformations"),
        key("hamilton_jacobi", Table(&INTEGRAL), "a complete integral"),
        key("observables", Tables(&OBSERVABLE), "what is watched"),
        key("expect", Table(&EXPECT), "what the file claims of its motion"),
        key("frames", Tables(&FRAME), "frames that a picture may be seen from"),
        key("views", Kinds(&VIEW), "what the screen opens with"),
        key("space", Table(&SPACE), "the system in space"),
        key("run", Table(&RUN), "how it is run"),
    ],
};

/// A coordinate.
pub(super) const COORDINATE: SchemaTable = SchemaTable {
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

/// A variable of brackets.
pub(super) const VARIABLE: SchemaTable = SchemaTable {
    head: "[variables]",
    about: "The variables of a `[poisson]` file in order: a number or an expression, or a table. `L1'` is the rate of `L1`.",
    keys: &[INITIAL, SYMBOL, UNIT, PERIOD],
};

/// A parameter.
pub(super) const PARAMETER: SchemaTable = SchemaTable {
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

const RAMP: SchemaTable = SchemaTable {
    head: "[[ramps]]",
    about: "A parameter that goes from its value to another one: a function of the time wherever it is used, but for initial values. Several of one parameter follow each other.",
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

const LAGRANGIAN: SchemaTable = SchemaTable {
    head: "[lagrangian]",
    about: "d/dt(∂L/∂q') − ∂L/∂q + ∂F/∂q' = Q.",
    keys: &[
        key("L", Formula, "the Lagrangian").needed("write L = \"T - V\""),
        key("dissipation", Formula, "Rayleigh's function F"),
        FORCES,
    ],
};

const HAMILTONIAN: SchemaTable = SchemaTable {
    head: "[hamiltonian]",
    about: "q' = ∂H/∂p, p' = −∂H/∂q + force.",
    keys: &[H, FORCES],
};

const POISSON: SchemaTable = SchemaTable {
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

const CONSTRAINT: SchemaTable = SchemaTable {
    head: "[[constraints]]",
    about: "Beside a Lagrangian, linear in the velocities; without one it holds the coordinates.",
    keys: &[
        NAME,
        key("expression", Formula, "what is held at zero")
            .needed("write expression = \"...\", which is to be zero"),
        key("unit", Text, "the unit of its multiplier, for show"),
        key("about", Text, "what its multiplier is"),
    ],
};

const IMPULSE: SchemaTable = SchemaTable {
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

const EVENT: SchemaTable = SchemaTable {
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

const BODY: SchemaTable = SchemaTable {
    head: "[body]",
    about: "It defines `Ixx` … `Izz`, `I1 ≤ I2 ≤ I3`, `body_mass` and `body_x`, `body_y`, `body_z`.",
    keys: &[key("pieces", List(&PIECE), "the pieces")
        .needed("write pieces = [ { solid = \"sphere\", mass = \"m\", radius = \"a\" } ]")],
};

/// The solids that a body can be composed of.
pub(super) const SOLIDS: &[&str] = &[
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

/// A piece of a body.
pub(super) const PIECE: SchemaTable = SchemaTable {
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
pub(super) const TURN: SchemaTable = SchemaTable {
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

const ATTITUDE: SchemaTable = SchemaTable {
    head: "[attitude]",
    about: "The matrix from space axes to body axes, `A11` … `A33`: by `euler`, or by `omega`.",
    keys: &[
        key("euler", Triple, "Euler's angles φ, θ, ψ as functions of q and t").unit("rad"),
        key("omega", Triple, "the angular velocity about the body's axes").unit("rad/time"),
        key("start", Triple, "Euler's angles at the start, beside `omega`").unit("rad"),
    ],
};

const COMPARISON: SchemaTable = SchemaTable {
    head: "[comparison]",
    about: "The constraints are put into L before it is varied; the motion is `other_x`.",
    keys: &[key("eliminate", Texts, "the coordinates whose velocities are eliminated")
        .needed("write eliminate = [\"x\"], one coordinate for each constraint")],
};

const TRANSFORMATION: SchemaTable = SchemaTable {
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
    ],
};

const GENERATOR: SchemaTable = SchemaTable {
    head: "[[generators]]",
    about: "Of infinitesimal transformations; `run --flow-of NAME` carries the state along its flow.",
    keys: &[NAME, key("G", Formula, "a function of q, p, t").needed("write G = \"...\"")],
};

const INTEGRAL: SchemaTable = SchemaTable {
    head: "[hamilton_jacobi]",
    about: "A complete integral of H(q, ∂S/∂q, t) + ∂S/∂t = 0; checked.",
    keys: &[
        key("S", Formula, "a function of q, t and the constants").needed("write S = \"...\""),
        key("constants", Texts, "the constants, one for each coordinate")
            .needed("write constants = [\"alpha\"]"),
    ],
};

const OBSERVABLE: SchemaTable = SchemaTable {
    head: "[[observables]]",
    about: "Each may use those above it.",
    keys: &[NAME, EXPRESSION, key("conserved", Flag, "a claim that it is; checked")],
};

const EXPECT: SchemaTable = SchemaTable {
    head: "[expect]",
    about: "The file's own test.",
    keys: &[
        key("conserves", Texts, "`energy`, momenta, Casimirs, observables, expressions"),
        key("values", List(&EXPECTED_VALUE), "values at times"),
        key("events", List(&EXPECTED_EVENT), "when something happens"),
        key("count", List(&EXPECTED_COUNT), "how often it happens"),
        key("brackets", List(&EXPECTED_BRACKET), "what brackets are"),
        key(
            "invariants",
            Number,
            "how many independent constants without time are found, H among them",
        ),
        key("degree", Number, "up to which degree in the momenta they are searched; else 2"),
    ],
};

/// An expected value.
pub(super) const EXPECTED_VALUE: SchemaTable = SchemaTable {
    head: "`values` of [expect]",
    about: "What an expression is at a time.",
    keys: &[
        key("name", Text, "what it is called"),
        EXPRESSION,
        AT,
        key("is", Number, "what it is then").needed("give the number: is = 2.0"),
        WITHIN,
        SOURCE,
    ],
};

/// An expected event.
pub(super) const EXPECTED_EVENT: SchemaTable = SchemaTable {
    head: "`events` of [expect]",
    about: "When an event or an impulse happens.",
    keys: &[
        NAME,
        key("nth", Number, "which of them; the first where not given"),
        AT,
        WITHIN,
        SOURCE,
    ],
};

/// An expected count.
pub(super) const EXPECTED_COUNT: SchemaTable = SchemaTable {
    head: "`count` of [expect]",
    about: "How often it has happened by a time.",
    keys: &[
        NAME,
        key("until", Number, "the time").needed("give the time: until = 10.0").unit("time"),
        key("is", Number, "how often").needed("give the number: is = 3"),
        SOURCE,
    ],
};

/// An expected bracket.
pub(super) const EXPECTED_BRACKET: SchemaTable = SchemaTable {
    head: "`brackets` of [expect]",
    about: "What the bracket of two expressions is.",
    keys: &[
        key("f", Formula, "the first").needed("write f = \"...\""),
        key("g", Formula, "the second").needed("write g = \"...\""),
        key("is", Formula, "what [f, g] is").needed("write is = \"...\""),
        SOURCE,
    ],
};

const FRAME: SchemaTable = SchemaTable {
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

/// A particle of a frame.
pub(super) const PARTICLE: SchemaTable = SchemaTable {
    head: "`particles` of a frame",
    about: "On which the apparent forces are drawn.",
    keys: &[
        key("at", Triple, "where it is").needed("write at = [\"...\", \"...\", \"...\"]"),
        key("mass", Formula, "its mass").needed("write mass = \"...\""),
    ],
};

const VIEW: SchemaTable = SchemaTable {
    head: "[[views]]",
    about: "A `potential` is `y` over the coordinate `x`, all else held.",
    keys: &[
        key(
            "kind",
            Text,
            "`phase`, `space`, `time`, `potential`, `section`, `diagram`, `map`, `transformation`, `ensemble`, `orbit`, `spectrum`, `actions`, `angle`, `action`, `abbreviated`, `phase-action` or `legendre`",
        )
        .needed("write kind = \"phase\", \"space\", \"time\", \"potential\" or \"section\""),
        key("title", Text, "what it is called"),
        key("x", Formula, "the horizontal axis").only(&[
            "phase",
            "potential",
            "section",
            "map",
            "transformation",
            "ensemble",
            "orbit",
            "actions",
            "angle",
            "action",
            "abbreviated",
            "phase-action",
            "legendre",
        ]),
        key("y", Formulas, "the vertical axis; several in a time series").only(&[
            "phase",
            "time",
            "potential",
            "section",
            "diagram",
            "map",
            "transformation",
            "ensemble",
            "orbit",
            "spectrum",
        ]),
        key("over", Text, "the parameter over whose range it runs")
            .needed("write over = \"...\", a parameter")
            .only(&["diagram"]),
        key("on", Formula, "vanishes on the surface of section")
            .needed("write on = \"...\", which vanishes on the surface")
            .only(&["section", "diagram", "map"]),
        key("direction", Text, "of the crossings: `rising`, `falling` or `either`; `rising`")
            .only(&["section", "diagram", "map"]),
        key("x_range", Formulas, "the two ends of the horizontal axis")
            .only(&["section", "diagram", "map"]),
        key("y_range", Formulas, "the two ends of the vertical axis")
            .only(&["section", "diagram", "map"]),
        key("of", Formula, "the quantity at the end of the motions; without it and `on` the largest exponent")
            .only(&["map"]),
        key("until", Formula, "the time at which the motions end").only(&["map"]),
        key("frame", Text, "the frame it is seen from").only(&["space"]),
        key("shapes", List(&SHAPE), "what is drawn in place of the shapes of [space]")
            .only(&["space"]),
    ],
};

const SPACE: SchemaTable = SchemaTable {
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
    ],
};

const SHAPE: SchemaTable = SchemaTable {
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
        key("size", Formula, "how large it is").only(&["plane"]),
        key("from", Formula, "where `s` begins").only(&["path"]),
        key("to", Formula, "where `s` ends").only(&["path"]),
        key("samples", Number, "how many points are drawn").only(&["path"]),
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
        key("step", Number, "the step of a method of fixed step").unit("time"),
        key("tolerance", Number, "the accuracy of an adaptive method"),
    ],
};

impl ValueKind {
    /// A short description of the kind.
    fn words(self) -> &'static str {
        match self {
            Text => "text",
            Texts => "list of texts",
            Flag => "`true` or `false`",
            Number => "number",
            Constant => "number, or expression of numbers",
            Formula => "expression",
            Formulas => "expression, or list of them",
            Point => "two or three expressions",
            Triple => "three expressions",
            Names => "names, each with an expression",
            Brackets => "list of `[a, b, {a, b}]`",
            Table(_) => "table",
            Named(_) => "names, each with a table or a value",
            Tables(_) | Kinds(_) => "tables",
            List(_) => "list of tables",
        }
    }

    /// The nested table, if there is one.
    pub(super) fn section(self) -> Option<&'static SchemaTable> {
        match self {
            Table(section) | Named(section) | Tables(section) | Kinds(section) | List(section) => {
                Some(section)
            }
            _ => None,
        }
    }
}

/// The tables of the file, each before the tables nested in it.
fn sections() -> Vec<&'static SchemaTable> {
    let mut all = vec![&FILE];
    let mut at = 0;
    while at < all.len() {
        let inner = all[at].keys.iter().filter_map(|key| key.kind.section());
        let mut place = at + 1;
        for section in inner.collect::<Vec<_>>() {
            if !all.iter().any(|known| known.head == section.head) {
                let last = if at == 0 { all.len() } else { place };
                all.insert(last, section);
                place += 1;
            }
        }
        at += 1;
    }
    all
}

/// The tables and keys of the format, as Markdown.
pub fn reference() -> String {
    let mut text = String::new();
    for section in sections() {
        let head = section.head;
        let head = if head.starts_with('[') { format!("`{head}`") } else { head.to_owned() };
        // writing to a String cannot fail
        let _ = writeln!(text, "### {head}\n\n{}\n", section.about);
        let _ =
            writeln!(text, "| key | value | unit | where | what it is |\n|---|---|---|---|---|");
        for key in section.keys {
            let name = match key.missing {
                Some(_) => format!("`{}` (needed)", key.name),
                None => format!("`{}`", key.name),
            };
            let cells = [key.kind.words(), key.unit, &key.only.join(", "), key.help];
            let cells = cells.join(" | ").replace("  ", " ");
            let _ = writeln!(text, "| {name} | {cells} |");
        }
        text.push('\n');
    }
    text.truncate(text.trim_end().len());
    text.push('\n');
    text
}
