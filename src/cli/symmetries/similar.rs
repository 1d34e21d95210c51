//! What `phaselab symmetries` says beyond Noether's: point symmetries of the equations of motion, and mechanical similarity
//! with the virial theorem.
//!
//! In: what was found. Out: text, LaTeX, keys of the JSON object. Never here: the search.

use serde_json::{Map, Value, json};

use super::super::script::MathScript;
use crate::expr::{Expr, Pool};
use crate::integrability::{PointSymmetries, PointSymmetry, Unsupported, changed};
use crate::mechanics::{Equations, Similarity};
use crate::num::Number;

/// The point symmetries, and the similarity.
pub(super) struct Others {
    /// Whether the equations have a Lagrangian.
    pub(super) has_lagrangian: bool,
    /// How many of the point symmetries, which come first, are listed with Noether's.
    pub(super) listed: usize,
    pub(super) points: Result<PointSymmetries, Unsupported>,
    pub(super) similarity: Option<Similarity>,
}

/// `x by …, y by …`.
pub(super) fn moved(
    equations: &Equations,
    script: MathScript,
    time: Expr,
    coordinates: &[Expr],
) -> String {
    let pool = &equations.pool;
    let one = |(s, e)| format!("{} by {}", script.symbol(pool, s), script.math(pool, e));
    changed(equations, time, coordinates).map(one).collect::<Vec<_>>().join(", ")
}

/// What is said of those that are not written, and of those that were not when the time ran out.
pub(super) fn missing(unwritten: usize, unfinished: usize) -> String {
    let line = |count: usize, why: &str| match count {
        0 => String::new(),
        1 => format!("1 more is not written: {why}\n"),
        _ => format!("{count} more are not written: {why}\n"),
    };
    line(unwritten, "no coefficients that are short fractions were found for a proof")
        + &line(unfinished, "the time allowed ran out (see --budget)")
}

/// The exponents of a scaling by name, `t` first.
fn scaling(equations: &Equations, exponents: &[Number]) -> Vec<(String, String)> {
    let mut pool = Pool::new();
    let names = equations.coordinates.iter().map(|c| c.position);
    let names = names.map(|s| equations.pool.symbol_info(s).name.clone());
    let mut texts = Vec::new();
    for &n in exponents {
        let e = pool.number(n);
        texts.push(pool.text(e));
    }
    ["t".to_owned()].into_iter().chain(names).zip(texts).collect()
}

impl Others {
    pub(super) fn text(&self, equations: &Equations, script: MathScript) -> String {
        let mut text = String::new();
        match &self.points {
            Err(why) => text.push_str(&format!("\nPoint symmetries of the equations: {why}\n")),
            Ok(points) => {
                let own = points.found.iter().filter(|s| s.noether == Some(true)).count();
                for symmetry in points.found.iter().skip(self.listed) {
                    let here =
                        if symmetry.for_all_parameters { "" } else { " at these parameters" };
                    let kind = match symmetry.noether {
                        Some(true) => "maps motions to motions; Noether's",
                        Some(false) => "maps motions to motions; not Noether's",
                        _ => "maps motions to motions",
                    };
                    text.push_str(&format!("\n{}\n", symmetry.name));
                    text.push_str(&format!(
                        "  moves {}\n",
                        moved(equations, script, symmetry.time, &symmetry.coordinates)
                    ));
                    if let Some(exponents) = &symmetry.scaling {
                        let scaled = scaling(equations, exponents).into_iter();
                        let scaled = scaled.filter(|(_, n)| n != "0");
                        let scaled: Vec<String> =
                            scaled.map(|(q, n)| format!("{q} by s^{n}")).collect();
                        text.push_str(&format!("  scales {} for any s > 0\n", scaled.join(", ")));
                    }
                    text.push_str(&format!("  {kind}   (proved{here})\n"));
                }
                let (count, searched) = (points.found.len(), &points.searched);
                let complete =
                    if points.complete { ", and there are no others (proved)" } else { "" };
                let what = if count == 1 { "point symmetry" } else { "point symmetries" };
                // without a Lagrangian none is
                let law = self.has_lagrangian;
                let unknown = points.found.iter().filter(|s| law && s.noether.is_none()).count();
                let own = match (unknown, own) {
                    (0, own) => format!("{own} of them Noether's"),
                    (_, 0) => "of which it is not known which are Noether's".to_owned(),
                    _ => format!("{own} of them Noether's and {unknown} of which it is not known"),
                };
                text.push_str(&format!(
                    "\n{count} {what} of the equations of motion, {own}{complete} among\n  {searched}\n"
                ));
                text.push_str(&missing(points.unwritten, points.unfinished));
            }
        }
        if let Some(known) = &self.similarity {
            let math = |e: Expr| script.math(&equations.pool, e);
            let names: Vec<String> =
                known.scaled.iter().map(|&s| script.symbol(&equations.pool, s)).collect();
            let mut pool = equations.pool.clone();
            let (period, virial) = exponents(&mut pool, known);
            let time = match period {
                Expr::ZERO => "as long".to_owned(),
                Expr::ONE => "l times as long".to_owned(),
                power => format!("l^{} times as long", enclosed(&script.math(&pool, power))),
            };
            let virial = match virial {
                Expr::ONE => String::new(),
                factor => format!("{} ", enclosed(&script.math(&pool, factor))),
            };
            text.push_str(&format!(
                "\nSimilarity\n  T is of degree 2 and V of degree {} in {} (proved)\n  a motion l times as large \
                 takes {time}\n  virial theorem: <T> = {virial}<V> where {} stays bounded\n",
                math(known.degree),
                names.join(", "),
                math(known.virial),
            ));
        }
        text
    }

    pub(super) fn latex(&self, equations: &Equations) -> String {
        let pool = &equations.pool;
        let mut lines = Vec::new();
        let others = self.points.iter().flat_map(|points| &points.found);
        for symmetry in others.skip(self.listed) {
            let all = changed(equations, symmetry.time, &symmetry.coordinates);
            let terms: Vec<String> = all
                .map(|(s, e)| {
                    let name = &pool.symbol_info(s).latex;
                    format!("\\left({}\\right) \\partial_{{{name}}}", pool.latex(e))
                })
                .collect();
            lines.push(format!("X &= {}", terms.join(" + ")));
        }
        if let Some(known) = &self.similarity {
            let mut pool = pool.clone();
            let (_, virial) = exponents(&mut pool, known);
            let virial = pool.latex(virial);
            lines.push(format!(
                "\\langle T \\rangle &= \\left({virial}\\right) \\langle V \\rangle"
            ));
        }
        if lines.is_empty() {
            return String::new();
        }
        format!("\\begin{{align*}}\n{}\n\\end{{align*}}\n", lines.join(" \\\\\n"))
    }

    pub(super) fn json(&self, equations: &Equations, object: &mut Value) {
        let text = |e: Expr| Value::String(equations.pool.text(e));
        let one = |s: &PointSymmetry| {
            let coordinates: Map<String, Value> = equations
                .coordinates
                .iter()
                .zip(&s.coordinates)
                .map(|(c, &e)| (equations.pool.symbol_info(c.position).name.clone(), text(e)))
                .collect();
            let scaling: Option<Map<String, Value>> = s.scaling.as_ref().map(|exponents| {
                let all = scaling(equations, exponents).into_iter();
                all.map(|(name, n)| (name, Value::String(n))).collect()
            });
            json!({
                "name": s.name,
                "time": text(s.time),
                "coordinates": coordinates,
                "noether": s.noether,
                "proved": true,
                "for_all_parameters": s.for_all_parameters,
                "scaling": scaling,
            })
        };
        object["point_symmetries"] = match &self.points {
            Ok(points) => json!({
                "found": points.found.iter().map(one).collect::<Vec<_>>(),
                "searched": points.searched,
                "complete": points.complete,
                "unwritten": points.unwritten,
                "unfinished": points.unfinished,
            }),
            Err(why) => json!({ "found": [], "why": why.to_string() }),
        };
        object["similarity"] = self.similarity.as_ref().map_or(Value::Null, |known| {
            let mut pool = equations.pool.clone();
            let (period, virial) = exponents(&mut pool, known);
            let name = |s| pool.symbol_info(s).name.clone();
            let scaled: Vec<String> = known.scaled.iter().map(|&s| name(s)).collect();
            json!({
                "coordinates": scaled,
                "kinetic": text(known.kinetic),
                "potential": text(known.potential),
                "degree": text(known.degree),
                "period_exponent": pool.text(period),
                "virial": text(known.virial),
                "mean_T_over_mean_V": pool.text(virial),
            })
        });
    }
}

/// 1 − k/2, of which power the period is, and k/2 of ⟨T⟩ = (k/2) ⟨V⟩.
fn exponents(pool: &mut Pool, known: &Similarity) -> (Expr, Expr) {
    let half = pool.scale(Number::HALF, known.degree);
    (pool.sub(Expr::ONE, half), half)
}

/// A factor or a power in brackets, but for a single letter or fraction.
fn enclosed(written: &str) -> String {
    if written.chars().count() == 1 { written.to_owned() } else { format!("({written})") }
}
