//! A body composed of pieces, its attitude, and the incorrect mechanics for comparison, as written.

use toml::Spanned;

use super::table::Table;
use super::vector::{self, Formulas};
use super::{Formula, value};
use crate::diagnostic::nearest;
use crate::diagnostic::{Diagnostic, Diagnostics, SourceRange};
use crate::preset::schema::{Key, PIECE, SOLIDS, TURN};

/// `[body]` as written.
pub(in crate::preset) struct DraftBody {
    pub(in crate::preset) place: SourceRange,
    pub(in crate::preset) pieces: Vec<DraftPiece>,
}

pub(in crate::preset) struct DraftPiece {
    /// One of the [`SOLIDS`]; `None` for a point.
    pub(in crate::preset) solid: Option<&'static str>,
    /// The sizes of the solid with their keys; a cuboid has three under one key.
    pub(in crate::preset) sizes: Vec<(&'static str, Option<Formula>)>,
    pub(in crate::preset) mass: Option<Formula>,
    pub(in crate::preset) at: Option<Formulas>,
    pub(in crate::preset) turn: DraftTurn,
    pub(in crate::preset) place: SourceRange,
}

/// The rotation of a piece, as written.
pub(in crate::preset) enum DraftTurn {
    None,
    Axis { axis: Option<Formulas>, angle: Option<Formula> },
    Euler(Option<Formulas>),
}

/// `[attitude]` as written.
pub(in crate::preset) struct DraftAttitude {
    pub(in crate::preset) place: SourceRange,
    pub(in crate::preset) euler: Option<Formulas>,
    pub(in crate::preset) omega: Option<Formulas>,
    pub(in crate::preset) start: Option<Formulas>,
}

/// `[comparison]` as written.
pub(in crate::preset) struct DraftComparison {
    pub(in crate::preset) place: SourceRange,
    pub(in crate::preset) list: SourceRange,
    pub(in crate::preset) eliminate: Vec<Spanned<String>>,
}

pub(super) fn body(top: &mut Table<'_>) -> Option<DraftBody> {
    let mut table = top.table("body")?;
    let example = "{ solid = \"sphere\", mass = \"m\", radius = \"a\" }";
    let mut pieces = Vec::new();
    if let Some((_, found)) = table.take("pieces") {
        let items = value::list(found, "`pieces`", top.diagnostics);
        if items.is_some_and(|items| items.is_empty()) {
            let diagnostic =
                Diagnostic::error(found.span(), "a body is made of at least one piece");
            top.diagnostics.push(diagnostic.with_help(format!("write pieces = [ {example} ]")));
        }
        for item in items.into_iter().flatten() {
            let entry = Table::of(item, "this piece", item.span(), example, top.diagnostics);
            pieces.extend(entry.and_then(|entry| piece(entry.with(&PIECE))));
        }
    }
    let place = table.place.clone();
    table.finish();
    Some(DraftBody { place, pieces })
}

fn piece(mut table: Table<'_>) -> Option<DraftPiece> {
    let point = table.flag("point").filter(|flag| *flag.get_ref());
    let (had, written) = (table.has("solid"), table.text("solid"));
    let solid = match (&point, &written) {
        (Some(_), Some(solid)) => {
            let message = "a piece is a point or a solid, not both";
            table.diagnostics.push(Diagnostic::error(solid.span(), message));
            return None;
        }
        (Some(_), None) => None,
        (None, Some(solid)) => Some(known(solid, table.diagnostics)?),
        (None, None) => {
            if !had {
                let message = "this piece has no `solid`";
                let help = "write solid = \"sphere\" or another one, or point = true";
                table.lacks(
                    "solid",
                    Diagnostic::error(table.place.clone(), message).with_help(help),
                );
                table.finish_unread();
            }
            return None;
        }
    };
    table.called = format!("this {}", solid.unwrap_or("point"));
    table.is_of_kind(solid.unwrap_or("point"));
    let mass = table.formula("mass");
    let mut sizes = Vec::new();
    let sized = |row: &&Key| {
        !SOLIDS.iter().all(|s| row.only.allows(s)) && solid.is_some_and(|s| row.only.allows(s))
    };
    for key in PIECE.keys.iter().filter(sized).map(|row| row.name) {
        if key == "size" {
            let edges = vector::triple(&mut table, key);
            let edges = edges.map(Formulas::into_inner);
            let edge = |i| edges.as_ref().and_then(|edges: &Vec<Formula>| edges.get(i).cloned());
            sizes.extend((0..3).map(|i| (key, edge(i))));
        } else {
            sizes.push((key, table.formula(key)));
        }
    }
    let at = vector::triple(&mut table, "at");
    let turn = if solid.is_some() { turn(&mut table) } else { DraftTurn::None };
    let place = table.place.clone();
    table.finish();
    Some(DraftPiece { solid, sizes, mass, at, turn, place })
}

fn known(solid: &Spanned<String>, diagnostics: &Diagnostics) -> Option<&'static str> {
    let name = solid.get_ref().as_str();
    let known = SOLIDS.iter().find(|known| **known == name);
    if known.is_none() {
        let help = match nearest(name, SOLIDS.iter().copied()) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("the solids are {}", SOLIDS.join(", ")),
        };
        let message = format!("unknown solid `{name}`");
        diagnostics.push(Diagnostic::error(solid.span(), message).with_help(help));
    }
    known.copied()
}

fn turn(table: &mut Table<'_>) -> DraftTurn {
    let Some((place, found)) = table.take("turned") else { return DraftTurn::None };
    let shape = "turned = { axis = [\"0\", \"0\", \"1\"], angle = \"...\" }";
    let Some(table) = Table::of(found, "`turned`", place, shape, table.diagnostics) else {
        return DraftTurn::None;
    };
    let mut table = table.with(&TURN);
    let turn = if table.has("euler") {
        for (key, _) in table.entries() {
            if let "axis" | "angle" = key.get_ref().as_str() {
                let message = "a piece is turned by `axis` and `angle` or by `euler`, not by both";
                table.diagnostics.push(Diagnostic::error(key.span(), message));
            }
        }
        table.pass_over(&["axis", "angle"]);
        DraftTurn::Euler(vector::triple(&mut table, "euler"))
    } else {
        let axis = vector::triple(&mut table, "axis");
        DraftTurn::Axis { axis, angle: table.formula("angle") }
    };
    table.finish();
    turn
}

pub(super) fn attitude(top: &mut Table<'_>) -> Option<DraftAttitude> {
    let mut table = top.table("attitude")?;
    let (has_euler, has_omega) = (table.has("euler"), table.has("omega"));
    let euler = vector::triple(&mut table, "euler");
    let omega = vector::triple(&mut table, "omega");
    let (start_key, _) = table.take("start").unzip();
    let start = vector::triple(&mut table, "start");
    match (has_euler, has_omega, start_key) {
        (false, false, _) => {
            let message = "[attitude] has neither `euler` nor `omega`";
            let help = "write euler = [\"phi\", \"theta\", \"psi\"], or the angular velocity about \
                        the body's axes: omega = [\"w1\", \"w2\", \"w3\"]";
            table.lacks("euler", Diagnostic::error(table.place.clone(), message).with_help(help));
        }
        (true, true, _) => {
            let message = "[attitude] has both `euler` and `omega`";
            let help = "the orientation of a body follows from angles or from an angular velocity";
            top.diagnostics.push(Diagnostic::error(table.place.clone(), message).with_help(help));
        }
        (true, false, Some(start)) => {
            let message = "`start` goes with `omega`; the angles of `euler` need none";
            top.diagnostics.push(Diagnostic::error(start, message));
        }
        _ => {}
    }
    let place = table.place.clone();
    table.finish();
    Some(DraftAttitude { place, euler, omega, start })
}

pub(super) fn comparison(top: &mut Table<'_>) -> Option<DraftComparison> {
    let mut table = top.table("comparison")?;
    let found = table.take("eliminate");
    let list = found.as_ref().map_or(0..0, |(_, found)| found.span());
    let items = found.and_then(|(_, found)| value::list(found, "`eliminate`", top.diagnostics));
    let eliminate = items
        .into_iter()
        .flatten()
        .filter_map(|item| value::text(item, "a coordinate to eliminate", top.diagnostics))
        .collect();
    let place = table.place.clone();
    table.finish();
    Some(DraftComparison { place, list, eliminate })
}
