//! A body put together from pieces, how it stands, and the wrong mechanics beside the right, as
//! written.

use toml::Spanned;

use super::table::Table;
use super::vector::{self, Formulas};
use super::{Formula, value};
use crate::diagnostic::nearest;
use crate::diagnostic::{Diagnostic, Diagnostics, SourceRange};

/// `[body]` as written.
pub(in crate::preset) struct DraftBody {
    /// Where the table stands.
    pub(in crate::preset) place: SourceRange,
    pub(in crate::preset) pieces: Vec<DraftPiece>,
}

/// A piece as written.
pub(in crate::preset) struct DraftPiece {
    /// Which solid, by its name in [`SOLIDS`]; `None` for a point.
    pub(in crate::preset) solid: Option<&'static str>,
    /// The sizes the solid has, each with its key; three of one key for a cuboid.
    pub(in crate::preset) sizes: Vec<(&'static str, Option<Formula>)>,
    pub(in crate::preset) mass: Option<Formula>,
    pub(in crate::preset) at: Option<Formulas>,
    pub(in crate::preset) turn: DraftTurn,
    /// Where it stands.
    pub(in crate::preset) place: SourceRange,
}

/// How a piece is turned, as written.
pub(in crate::preset) enum DraftTurn {
    None,
    Axis { axis: Option<Formulas>, angle: Option<Formula> },
    Euler(Option<Formulas>),
}

/// `[attitude]` as written.
pub(in crate::preset) struct DraftAttitude {
    /// Where the table stands.
    pub(in crate::preset) place: SourceRange,
    pub(in crate::preset) euler: Option<Formulas>,
    pub(in crate::preset) omega: Option<Formulas>,
    pub(in crate::preset) start: Option<Formulas>,
}

/// `[comparison]` as written.
pub(in crate::preset) struct DraftComparison {
    /// Where the table stands.
    pub(in crate::preset) place: SourceRange,
    /// Where the list stands.
    pub(in crate::preset) list: SourceRange,
    pub(in crate::preset) eliminate: Vec<Spanned<String>>,
}

/// The solids and the keys of their sizes.
const SOLIDS: [(&str, &[&str]); 10] = [
    ("sphere", &["radius"]),
    ("spherical-shell", &["radius"]),
    ("shell", &["radius"]),
    ("cylinder", &["radius", "length"]),
    ("cylindrical-shell", &["radius", "length"]),
    ("cone", &["radius", "height"]),
    ("disc", &["radius"]),
    ("ring", &["radius"]),
    ("rod", &["length"]),
    ("cuboid", &["size"]),
];

pub(super) fn body(top: &mut Table<'_>, mistakes: &mut Diagnostics) -> Option<DraftBody> {
    let mut table = top.table("body", mistakes)?;
    let example = "{ solid = \"sphere\", mass = \"m\", radius = \"a\" }";
    let help = format!("write pieces = [ {example} ]");
    let mut pieces = Vec::new();
    if let Some((_, found)) = table.require("pieces", &help) {
        let items = value::list(found, "`pieces`", mistakes);
        if items.is_some_and(|items| items.is_empty()) {
            let mistake = Diagnostic::error(found.span(), "a body is made of at least one piece");
            mistakes.push(mistake.with_help(help));
        }
        for item in items.into_iter().flatten() {
            let entry = Table::of(item, "this piece", item.span(), example, mistakes);
            pieces.extend(entry.and_then(|entry| piece(entry, mistakes)));
        }
    }
    let place = table.place.clone();
    table.finish(mistakes);
    Some(DraftBody { place, pieces })
}

fn piece(mut table: Table<'_>, mistakes: &mut Diagnostics) -> Option<DraftPiece> {
    let point = table.flag("point", mistakes).filter(|flag| *flag.get_ref());
    let (had, written) = (table.has("solid"), table.text("solid", mistakes));
    let row = match (&point, &written) {
        (Some(_), Some(solid)) => {
            let message = "a piece is a point or a solid, not both";
            mistakes.push(Diagnostic::error(solid.span(), message));
            return None;
        }
        (Some(_), None) => None,
        (None, Some(solid)) => Some(known(solid, mistakes)?),
        (None, None) => {
            if !had {
                let message = "this piece has no `solid`";
                let help = "write solid = \"sphere\" or another one, or point = true";
                table.lacks(
                    "solid",
                    Diagnostic::error(table.place.clone(), message).with_help(help),
                );
                for key in ["mass", "at", "turned", "radius", "length", "height", "size"] {
                    table.take(key);
                }
                table.finish(mistakes);
            }
            return None;
        }
    };
    table.called = format!("this {}", row.map_or("point", |(name, _)| *name));
    let found = table.require("mass", "write mass = \"...\"");
    let mass = found.and_then(|(_, v)| value::formula(v, "`mass`", mistakes));
    let mut sizes = Vec::new();
    for &key in row.map_or(&[][..], |(_, keys)| keys) {
        if key == "size" {
            let edges = vector::triple(&mut table, key, mistakes);
            let edges = edges.map(Formulas::into_inner);
            let edge = |i| edges.as_ref().and_then(|edges: &Vec<Formula>| edges.get(i).cloned());
            sizes.extend((0..3).map(|i| (key, edge(i))));
        } else {
            let found = table.require(key, &format!("write {key} = \"...\""));
            let called = format!("`{key}`");
            sizes.push((key, found.and_then(|(_, v)| value::formula(v, &called, mistakes))));
        }
    }
    let at = vector::optional_triple(&mut table, "at", mistakes);
    let turn = if row.is_some() { turn(&mut table, mistakes) } else { DraftTurn::None };
    let place = table.place.clone();
    table.finish(mistakes);
    Some(DraftPiece { solid: row.map(|(name, _)| *name), sizes, mass, at, turn, place })
}

fn known(
    solid: &Spanned<String>,
    mistakes: &mut Diagnostics,
) -> Option<&'static (&'static str, &'static [&'static str])> {
    let name = solid.get_ref().as_str();
    let row = SOLIDS.iter().find(|(known, _)| *known == name);
    if row.is_none() {
        let names = SOLIDS.map(|(name, _)| name);
        let help = match nearest(name, names) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("the solids are {}", names.join(", ")),
        };
        let message = format!("there is no solid `{name}`");
        mistakes.push(Diagnostic::error(solid.span(), message).with_help(help));
    }
    row
}

fn turn(table: &mut Table<'_>, mistakes: &mut Diagnostics) -> DraftTurn {
    let Some((place, found)) = table.take("turned") else { return DraftTurn::None };
    let shape = "turned = { axis = [\"0\", \"0\", \"1\"], angle = \"...\" }";
    let Some(mut table) = Table::of(found, "`turned`", place, shape, mistakes) else {
        return DraftTurn::None;
    };
    let turn = if table.has("euler") {
        for key in ["axis", "angle"] {
            if let Some((place, _)) = table.take(key) {
                let message = "a piece is turned by `axis` and `angle` or by `euler`, not by both";
                mistakes.push(Diagnostic::error(place, message));
            }
        }
        DraftTurn::Euler(vector::triple(&mut table, "euler", mistakes))
    } else {
        let axis = vector::triple(&mut table, "axis", mistakes);
        let found = table.require("angle", "write angle = \"...\"");
        let angle = found.and_then(|(_, v)| value::formula(v, "`angle`", mistakes));
        table.take("euler");
        DraftTurn::Axis { axis, angle }
    };
    table.finish(mistakes);
    turn
}

pub(super) fn attitude(top: &mut Table<'_>, mistakes: &mut Diagnostics) -> Option<DraftAttitude> {
    let mut table = top.table("attitude", mistakes)?;
    let (has_euler, has_omega) = (table.has("euler"), table.has("omega"));
    let euler = vector::optional_triple(&mut table, "euler", mistakes);
    let omega = vector::optional_triple(&mut table, "omega", mistakes);
    let (start_key, _) = table.take("start").unzip();
    let start = vector::optional_triple(&mut table, "start", mistakes);
    match (has_euler, has_omega, start_key) {
        (false, false, _) => {
            let message = "[attitude] has neither `euler` nor `omega`";
            let help = "write euler = [\"phi\", \"theta\", \"psi\"], or the angular velocity about \
                        the body's axes: omega = [\"w1\", \"w2\", \"w3\"]";
            table.lacks("euler", Diagnostic::error(table.place.clone(), message).with_help(help));
        }
        (true, true, _) => {
            let message = "[attitude] has both `euler` and `omega`";
            let help = "either angles or an angular velocity say how a body stands";
            mistakes.push(Diagnostic::error(table.place.clone(), message).with_help(help));
        }
        (true, false, Some(start)) => {
            let message = "`start` goes with `omega`; the angles of `euler` need none";
            mistakes.push(Diagnostic::error(start, message));
        }
        _ => {}
    }
    let place = table.place.clone();
    table.finish(mistakes);
    Some(DraftAttitude { place, euler, omega, start })
}

pub(super) fn comparison(
    top: &mut Table<'_>,
    mistakes: &mut Diagnostics,
) -> Option<DraftComparison> {
    let mut table = top.table("comparison", mistakes)?;
    let help = "write eliminate = [\"x\"], one coordinate for each constraint";
    let found = table.require("eliminate", help);
    let list = found.as_ref().map_or(0..0, |(_, found)| found.span());
    let items = found.and_then(|(_, found)| value::list(found, "`eliminate`", mistakes));
    let eliminate = items
        .into_iter()
        .flatten()
        .filter_map(|item| value::text(item, "a coordinate to eliminate", mistakes))
        .collect();
    let place = table.place.clone();
    table.finish(mistakes);
    Some(DraftComparison { place, list, eliminate })
}
