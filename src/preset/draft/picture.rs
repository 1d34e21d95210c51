//! The views and the shapes of the picture in space, as written.

use toml::Spanned;
use toml::de::DeValue;

use super::table::Table;
use super::value::Value;
use super::vector::{Formulas, optional_point, point};
use super::{Formula, value};
use crate::diagnostic::nearest;
use crate::diagnostic::{Diagnostic, Diagnostics, SourceRange};
use crate::instrument::{Axis, INSTRUMENTS, Instrument, listed, named};

pub(in crate::preset) struct DraftView {
    pub(in crate::preset) place: SourceRange,
    pub(in crate::preset) kind: &'static dyn Instrument,
    pub(in crate::preset) title: String,
    /// The expressions for each axis of the kind.
    pub(in crate::preset) axes: Vec<Vec<Formula>>,
    /// The frame from which the picture in space is seen.
    pub(in crate::preset) frame: Option<Spanned<String>>,
    /// The shapes drawn in place of those of `[space]`.
    pub(in crate::preset) shapes: Option<Vec<DraftShape>>,
    pub(in crate::preset) section: Option<DraftSection>,
    /// The parameter over whose range it runs.
    pub(in crate::preset) over: Option<Spanned<String>>,
    /// The time at which the motions of a map end.
    pub(in crate::preset) until: Option<Formula>,
    /// Whether a straight line is drawn through the points of a diagram.
    pub(in crate::preset) slope: bool,
    /// Whether the vector field of its plane is drawn.
    pub(in crate::preset) field: Option<Spanned<bool>>,
}

pub(in crate::preset) struct DraftSection {
    /// The expression that vanishes on it.
    pub(in crate::preset) on: Option<Formula>,
    /// Which crossings count.
    pub(in crate::preset) direction: Option<Spanned<String>>,
    pub(in crate::preset) ranges: [Option<[Formula; 2]>; 2],
}

/// A shape as written; parts that could not be read, or that its kind does not have, are `None`.
pub(in crate::preset) struct DraftShape {
    pub(in crate::preset) place: SourceRange,
    pub(in crate::preset) kind: ShapeKind,
    /// The value of the key that names the kind: a point, or the curve of a path.
    pub(in crate::preset) at: Option<Formulas>,
    pub(in crate::preset) to: Option<Formulas>,
    pub(in crate::preset) normal: Option<Formulas>,
    /// The radius, or the size of a plane.
    pub(in crate::preset) size: Option<Formula>,
    pub(in crate::preset) shade: Option<Formula>,
    /// The first and the last value of the parameter of a path.
    pub(in crate::preset) ends: [Option<Formula>; 2],
    pub(in crate::preset) samples: Option<Spanned<f64>>,
    /// The label or the caption.
    pub(in crate::preset) text: String,
}

pub(in crate::preset) struct DraftFollow {
    pub(in crate::preset) at: Option<Formulas>,
    pub(in crate::preset) reach: Option<Formula>,
}

/// The camera of `[space]`, as written.
#[derive(Default)]
pub(in crate::preset) struct DraftCamera {
    pub(in crate::preset) follow: Option<DraftFollow>,
    pub(in crate::preset) azimuth: Option<Spanned<f64>>,
    pub(in crate::preset) elevation: Option<Spanned<f64>>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
pub(in crate::preset) enum ShapeKind {
    Line,
    Spring,
    Trace,
    Circle,
    Mass,
    Path,
    Vector,
    Plane,
    Disc,
    Sphere,
    Cone,
    Cylinder,
    Caption,
    Body,
}

/// The key that names each kind.
const SHAPES: [(&str, ShapeKind); 14] = [
    ("line", ShapeKind::Line),
    ("spring", ShapeKind::Spring),
    ("trace", ShapeKind::Trace),
    ("circle", ShapeKind::Circle),
    ("mass", ShapeKind::Mass),
    ("path", ShapeKind::Path),
    ("vector", ShapeKind::Vector),
    ("plane", ShapeKind::Plane),
    ("disc", ShapeKind::Disc),
    ("sphere", ShapeKind::Sphere),
    ("cone", ShapeKind::Cone),
    ("cylinder", ShapeKind::Cylinder),
    ("caption", ShapeKind::Caption),
    ("body", ShapeKind::Body),
];

pub(super) fn views(top: &mut Table<'_>) -> Vec<DraftView> {
    let tables = top.tables("views", "this view");
    tables.into_iter().filter_map(view).collect()
}

fn view(mut table: Table<'_>) -> Option<DraftView> {
    let help = format!("write kind = {}", listed("\"", "or"));
    let Some((_, found)) = table.require("kind", &help) else {
        let axes = INSTRUMENTS.into_iter().flat_map(|kind| kind.properties().written);
        for key in axes
            .map(|axis| axis.key)
            .chain(["title", "frame", "shapes", "over", "of", "until", "slope", "field"])
            .chain(SECTION_KEYS)
        {
            table.take(key);
        }
        table.finish();
        return None;
    };
    let written = value::text(found, "`kind`", table.diagnostics)?;
    let kind = view_kind(&written, table.diagnostics)?;
    table.called = format!("this view of kind {}", written.get_ref());
    let title = table.line("title");
    let place = table.place.clone();
    let properties = kind.properties();
    let mut axes: Vec<Vec<Formula>> =
        properties.written.iter().map(|axis| several(&mut table, axis)).collect();
    let (mut frame, mut shapes) = (None, None);
    if properties.is_scene {
        frame = table.text("frame");
        shapes = table.has("shapes").then(|| shapes_of(&mut table));
    }
    let mut until = None;
    if properties.follows_motions {
        let of = table.take("of");
        axes.extend(of.map(|(_, found)| {
            value::formula(found, "`of`", table.diagnostics).into_iter().collect::<Vec<_>>()
        }));
        let found = table.take("until");
        until = found.and_then(|(_, found)| value::formula(found, "`until`", table.diagnostics));
    }
    let section = properties.is_section.then(|| section(&mut table, !properties.follows_motions));
    let (mut over, mut slope) = (None, false);
    if properties.is_over_a_parameter {
        over = table.text("over");
        if over.is_none() {
            table.require("over", "write over = \"...\", a parameter");
        }
        slope = table.flag("slope").is_some_and(|flag| *flag.get_ref());
    }
    let field = if properties.has_vector_field { table.flag("field") } else { None };
    table.finish();
    Some(DraftView { place, kind, title, axes, frame, shapes, section, over, until, slope, field })
}

/// The keys of a section besides its axes.
const SECTION_KEYS: [&str; 4] = ["on", "direction", "x_range", "y_range"];

fn section(table: &mut Table<'_>, needed: bool) -> DraftSection {
    let on = if needed {
        table.require("on", "write on = \"...\", which vanishes on the surface")
    } else {
        table.take("on")
    };
    let on = on.and_then(|(_, found)| value::formula(found, "`on`", table.diagnostics));
    let direction = table.text("direction");
    let ranges = ["x_range", "y_range"].map(|key| range(table, key));
    DraftSection { on, direction, ranges }
}

/// The two ends of an axis.
fn range(table: &mut Table<'_>, key: &'static str) -> Option<[Formula; 2]> {
    let (_, found) = table.take(key)?;
    let items = match found.get_ref() {
        DeValue::Array(items) if items.len() == 2 => items,
        _ => {
            let message = format!("`{key}` must be the two ends of the axis");
            let help = format!("write {key} = [\"-pi\", \"pi\"]");
            table.diagnostics.push(Diagnostic::error(found.span(), message).with_help(help));
            return None;
        }
    };
    let end = |place: usize| value::formula(&items[place], &format!("`{key}`"), table.diagnostics);
    let (from, to) = (end(0), end(1));
    Some([from?, to?])
}

/// The expressions of an axis: one, or a list if the axis takes several.
fn several(table: &mut Table<'_>, axis: &Axis) -> Vec<Formula> {
    let key = axis.key;
    let Some((_, found)) = table.require(key, &format!("write {key} = \"...\"")) else {
        return Vec::new();
    };
    let called = format!("`{key}`");
    match found.get_ref() {
        DeValue::Array(items) if axis.several => {
            if items.is_empty() {
                table.diagnostics.push(Diagnostic::error(found.span(), "this list is empty"));
            }
            items.iter().filter_map(|v| value::formula(v, &called, table.diagnostics)).collect()
        }
        _ => value::formula(found, &called, table.diagnostics).into_iter().collect(),
    }
}

/// The kind that a name denotes.
fn view_kind(
    written: &Spanned<String>,
    diagnostics: &Diagnostics,
) -> Option<&'static dyn Instrument> {
    let name = written.get_ref().as_str();
    let kind = named(name);
    if kind.is_none() {
        let help = match nearest(name, INSTRUMENTS.iter().map(|kind| kind.name())) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("the kinds are {}", listed("", "and")),
        };
        let message = format!("unknown kind of view `{name}`");
        diagnostics.push(Diagnostic::error(written.span(), message).with_help(help));
    }
    kind
}

/// Reads `[space]`: its shapes, and the camera: where it stands, and what it follows.
pub(super) fn space(top: &mut Table<'_>) -> (Vec<DraftShape>, DraftCamera) {
    let Some(mut table) = top.table("space") else { return Default::default() };
    let all = shapes_of(&mut table);
    let follow = table
        .has("follow")
        .then(|| DraftFollow { at: point(&mut table, "follow"), reach: size(&mut table, "reach") });
    let azimuth = table.number("azimuth");
    let elevation = table.number("elevation");
    table.finish();
    (all, DraftCamera { follow, azimuth, elevation })
}

fn shapes_of(table: &mut Table<'_>) -> Vec<DraftShape> {
    let mut all = Vec::new();
    for item in table.list("shapes") {
        let shape = "{ line = [\"0\", \"0\", \"0\"], to = [\"x\", \"y\", \"0\"] }";
        if let Some(entry) = Table::of(item, "this shape", item.span(), shape, table.diagnostics) {
            all.extend(self::shape(entry));
        }
    }
    all
}

fn shape(mut table: Table<'_>) -> Option<DraftShape> {
    use ShapeKind::{
        Body, Caption, Circle, Cone, Cylinder, Disc, Line, Mass, Path, Plane, Sphere, Spring,
        Trace, Vector,
    };
    let names = SHAPES.map(|(name, _)| name);
    let given: Vec<_> = SHAPES.into_iter().filter(|(name, _)| table.has(name)).collect();
    let [(name, kind)] = given[..] else {
        // what stands where a shape has its place is meant as one
        let takes_place = |value: &Value<'_>| matches!(value.get_ref(), DeValue::Array(_));
        let meant = || {
            let mut entries = table.entries().filter(|(key, value)| {
                takes_place(value) && !["to", "normal"].contains(&key.get_ref().as_str())
            });
            entries.next().map(|(key, _)| (key, None))
        };
        let misspelt = table
            .entries()
            .find_map(|(key, _)| nearest(key.get_ref(), names).map(|near| (key, Some(near))));
        let message = match given[..] {
            [(first, _), (second, _), ..] => {
                Err(format!("this shape is `{first}` and `{second}` at once"))
            }
            _ => misspelt.or_else(meant).ok_or_else(|| "unknown shape".to_owned()),
        };
        let all = || format!("the shapes are {}; each is a table of its own", names.join(", "));
        let diagnostic = match message {
            Ok((key, near)) => {
                let help = near.map_or_else(all, |near| format!("did you mean `{near}`?"));
                let message = format!("unknown shape `{}`", key.get_ref());
                Diagnostic::error(key.span(), message).with_help(help)
            }
            Err(message) => Diagnostic::error(table.place.clone(), message).with_help(all()),
        };
        table.diagnostics.push(diagnostic);
        return None;
    };
    table.called = format!("the shape `{name}`");
    let mut shape = DraftShape {
        place: table.place.clone(),
        kind,
        at: point(&mut table, name),
        to: None,
        normal: None,
        size: None,
        shade: None,
        ends: [None, None],
        samples: None,
        text: String::new(),
    };
    if kind == Vector {
        shape.text = table.line("label");
    }
    if let Line | Spring | Vector | Cone | Cylinder = kind {
        shape.to = point(&mut table, "to");
    }
    if let Circle | Disc | Plane = kind {
        shape.normal = optional_point(&mut table, "normal");
    }
    match kind {
        Circle | Disc | Sphere | Cone | Cylinder => {
            shape.size = size(&mut table, "radius");
        }
        Plane => shape.size = size(&mut table, "size"),
        Mass => shape.size = table.formula("radius"),
        Path => {
            shape.ends = ["from", "to"].map(|key| size(&mut table, key));
            shape.samples = table.number("samples");
        }
        Caption => {
            if !table.has("text") {
                table.lacks_key("text", "write text = \"...\"");
            }
            shape.text = table.line("text");
        }
        Line | Spring | Vector | Trace | Body => {}
    }
    if kind == Disc {
        shape.shade = table.formula("shade");
    }
    table.finish();
    Some(shape)
}

/// A required number or expression.
fn size(table: &mut Table<'_>, key: &'static str) -> Option<Formula> {
    let (_, found) = table.require(key, &format!("write {key} = \"...\""))?;
    value::formula(found, &format!("`{key}`"), table.diagnostics)
}
