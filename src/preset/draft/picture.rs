//! Views and the shapes of the picture in space, as written.

use toml::Spanned;
use toml::de::DeValue;

use super::table::{Table, Value};
use super::vector::{Formulas, optional_point, point};
use super::{Formula, value};
use crate::diagnostic::nearest;
use crate::diagnostic::{Diagnostic, Diagnostics, SourceRange};

/// A view as written.
pub(in crate::preset) struct DraftView {
    /// Where it stands.
    pub(in crate::preset) place: SourceRange,
    pub(in crate::preset) kind: DraftViewKind,
    pub(in crate::preset) title: String,
    pub(in crate::preset) x: Option<Formula>,
    pub(in crate::preset) y: Vec<Formula>,
    /// From which frame the picture in space is seen.
    pub(in crate::preset) frame: Option<Spanned<String>>,
    /// What is drawn in place of the shapes of `[space]`.
    pub(in crate::preset) shapes: Option<Vec<DraftShape>>,
}

/// The kinds of views.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(in crate::preset) enum DraftViewKind {
    Space,
    Phase,
    Time,
    Potential,
    /// The format has it and this version does not: it is read and left out.
    NotYet,
}

/// A shape as written.
pub(in crate::preset) struct DraftShape {
    /// Where it stands.
    pub(in crate::preset) place: SourceRange,
    /// What it is.
    pub(in crate::preset) kind: DraftShapeKind,
}

/// What a shape is; parts that could not be read are missing.
pub(in crate::preset) enum DraftShapeKind {
    Line {
        from: Option<Formulas>,
        to: Option<Formulas>,
    },
    Spring {
        from: Option<Formulas>,
        to: Option<Formulas>,
    },
    Trace {
        at: Option<Formulas>,
    },
    Circle {
        centre: Option<Formulas>,
        radius: Option<Formula>,
        normal: Option<Formulas>,
    },
    Mass {
        at: Option<Formulas>,
        radius: Option<Formula>,
    },
    Path {
        curve: Option<Formulas>,
        from: Option<Formula>,
        to: Option<Formula>,
        samples: Option<Spanned<f64>>,
    },
    Vector {
        at: Option<Formulas>,
        components: Option<Formulas>,
    },
    Plane {
        at: Option<Formulas>,
        normal: Option<Formulas>,
        size: Option<Formula>,
    },
    Body {
        at: Option<Formulas>,
    },
}

const VIEWS: [(&str, DraftViewKind); 4] = [
    ("phase", DraftViewKind::Phase),
    ("space", DraftViewKind::Space),
    ("time", DraftViewKind::Time),
    ("potential", DraftViewKind::Potential),
];
const VIEWS_NOT_YET: [&str; 5] = ["section", "spectrum", "ensemble", "transformation", "action"];
const SHAPES: [&str; 9] =
    ["line", "spring", "trace", "circle", "mass", "path", "vector", "plane", "body"];

pub(super) fn views(top: &mut Table<'_>, mistakes: &mut Diagnostics) -> Vec<DraftView> {
    let tables = top.tables("views", "this view", mistakes);
    tables.into_iter().filter_map(|table| view(table, mistakes)).collect()
}

fn view(mut table: Table<'_>, mistakes: &mut Diagnostics) -> Option<DraftView> {
    let help = "write kind = \"phase\", \"space\", \"time\" or \"potential\"";
    let Some((_, found)) = table.require("kind", help) else {
        for key in ["title", "x", "y", "frame", "shapes"] {
            table.take(key);
        }
        table.finish(mistakes);
        return None;
    };
    let written = value::text(found, "`kind`", mistakes)?;
    let kind = view_kind(&written, mistakes)?;
    table.called = format!("this view of kind {}", written.get_ref());
    let title = table.line("title", mistakes);
    let mut axis = |key, mistakes: &mut Diagnostics| {
        let found = match kind {
            DraftViewKind::NotYet => table.take(key),
            _ => table.require(key, &format!("write {key} = \"...\"")),
        };
        found.map_or(Vec::new(), |(_, v)| several(v, key, kind, mistakes))
    };
    let (x, y) = match kind {
        DraftViewKind::Space => (Vec::new(), Vec::new()),
        DraftViewKind::Time => (Vec::new(), axis("y", mistakes)),
        DraftViewKind::Phase | DraftViewKind::Potential | DraftViewKind::NotYet => {
            (axis("x", mistakes), axis("y", mistakes))
        }
    };
    let (mut frame, mut shapes) = (None, None);
    if kind == DraftViewKind::Space {
        frame = table.text("frame", mistakes);
        shapes = table.has("shapes").then(|| shapes_of(&mut table, mistakes));
    }
    let place = table.place.clone();
    if kind != DraftViewKind::NotYet {
        table.finish(mistakes);
    }
    Some(DraftView { place, kind, title, x: x.into_iter().next(), y, frame, shapes })
}

/// What runs up the axis: one expression, or a list of them in a time series.
fn several(
    found: &Value<'_>,
    key: &str,
    kind: DraftViewKind,
    mistakes: &mut Diagnostics,
) -> Vec<Formula> {
    let called = format!("`{key}`");
    match found.get_ref() {
        DeValue::Array(items) if kind == DraftViewKind::Time => {
            if items.is_empty() {
                mistakes.push(Diagnostic::error(found.span(), "this list is empty"));
            }
            items.iter().filter_map(|v| value::formula(v, &called, mistakes)).collect()
        }
        _ => value::formula(found, &called, mistakes).into_iter().collect(),
    }
}

fn view_kind(written: &Spanned<String>, mistakes: &mut Diagnostics) -> Option<DraftViewKind> {
    let name = written.get_ref().as_str();
    if let Some((_, kind)) = VIEWS.iter().find(|(known, _)| *known == name) {
        return Some(*kind);
    }
    if VIEWS_NOT_YET.contains(&name) {
        let message = format!("views of kind `{name}` are not supported yet by this version");
        mistakes
            .push(Diagnostic::warning(written.span(), message).with_help("the view is left out"));
        return Some(DraftViewKind::NotYet);
    }
    let known = VIEWS.iter().map(|(name, _)| *name).chain(VIEWS_NOT_YET);
    let help = match nearest(name, known) {
        Some(near) => format!("did you mean `{near}`?"),
        None => "the kinds are phase, space, time and potential".to_owned(),
    };
    let message = format!("there is no view of kind `{name}`");
    mistakes.push(Diagnostic::error(written.span(), message).with_help(help));
    None
}

pub(super) fn shapes(top: &mut Table<'_>, mistakes: &mut Diagnostics) -> Vec<DraftShape> {
    let Some(mut table) = top.table("space", mistakes) else { return Vec::new() };
    let all = shapes_of(&mut table, mistakes);
    table.finish(mistakes);
    all
}

/// The list of shapes of a table.
fn shapes_of(table: &mut Table<'_>, mistakes: &mut Diagnostics) -> Vec<DraftShape> {
    let mut all = Vec::new();
    for item in table.list("shapes", mistakes) {
        let shape = "{ line = [\"0\", \"0\", \"0\"], to = [\"x\", \"y\", \"0\"] }";
        if let Some(entry) = Table::of(item, "this shape", item.span(), shape, mistakes) {
            all.extend(self::shape(entry, mistakes));
        }
    }
    all
}

fn shape(mut table: Table<'_>, mistakes: &mut Diagnostics) -> Option<DraftShape> {
    let given: Vec<&'static str> = SHAPES.into_iter().filter(|kind| table.has(kind)).collect();
    let [kind] = given[..] else {
        let message = match given[..] {
            [first, second, ..] => format!("this shape is `{first}` and `{second}` at once"),
            _ => "this is no shape".to_owned(),
        };
        let misspelt = table
            .entries()
            .find_map(|(key, _)| nearest(key.get_ref(), SHAPES).map(|near| (key.span(), near)));
        let mistake = match misspelt {
            Some((place, near)) if given.is_empty() => {
                Diagnostic::error(place, message).with_help(format!("did you mean `{near}`?"))
            }
            _ => {
                let help =
                    format!("the shapes are {}; each is a table of its own", SHAPES.join(", "));
                Diagnostic::error(table.place.clone(), message).with_help(help)
            }
        };
        mistakes.push(mistake);
        return None;
    };
    table.called = format!("the shape `{kind}`");
    let first = point(&mut table, kind, mistakes);
    let kind = match kind {
        "line" => DraftShapeKind::Line { from: first, to: point(&mut table, "to", mistakes) },
        "spring" => DraftShapeKind::Spring { from: first, to: point(&mut table, "to", mistakes) },
        "trace" => DraftShapeKind::Trace { at: first },
        "circle" => DraftShapeKind::Circle {
            centre: first,
            radius: size(&mut table, "radius", mistakes),
            normal: optional_point(&mut table, "normal", mistakes),
        },
        "body" => DraftShapeKind::Body { at: first },
        "mass" => DraftShapeKind::Mass { at: first, radius: table.formula("radius", mistakes) },
        "path" => DraftShapeKind::Path {
            curve: first,
            from: size(&mut table, "from", mistakes),
            to: size(&mut table, "to", mistakes),
            samples: table.number("samples", mistakes),
        },
        "vector" => {
            DraftShapeKind::Vector { at: first, components: point(&mut table, "to", mistakes) }
        }
        _ => DraftShapeKind::Plane {
            at: first,
            normal: optional_point(&mut table, "normal", mistakes),
            size: size(&mut table, "size", mistakes),
        },
    };
    let place = table.place.clone();
    table.finish(mistakes);
    Some(DraftShape { place, kind })
}

/// A number or expression that has to be there.
fn size(table: &mut Table<'_>, key: &'static str, mistakes: &mut Diagnostics) -> Option<Formula> {
    let (_, found) = table.require(key, &format!("write {key} = \"...\""))?;
    value::formula(found, &format!("`{key}`"), mistakes)
}
