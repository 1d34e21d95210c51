//! What is said of constants of the motion on the page of equations: the verdict, what was found and how far it is
//! proved, what was searched, and the table of brackets.
//!
//! In: the findings of the lab's search. Out: blocks of a page of text. Never here: the search.

use super::RenderStyle;
use super::text_page::TextPage;
use super::theme::Role;
use crate::app::{Findings, Lab};
use crate::expr::Expr;
use crate::integrability::Proof;

/// Formulas with more nodes than this are not written out.
const MOST: u64 = 600;

pub(super) const CONSTANTS: &str = "Further constants of the motion";
pub(super) const BRACKETS: &str = "Brackets";

pub(super) fn verdict(lab: &Lab, page: &mut TextPage) {
    if let Some(status) = lab.searches.constants.status() {
        page.words(Role::Dim, status);
        return;
    }
    match lab.findings() {
        Some(Ok(findings)) => {
            let role =
                if findings.summary.contains("integrable") { Role::Good } else { Role::Text };
            page.words(role, capital(&findings.summary));
        }
        Some(Err(why)) => page.words(Role::Dim, format!("Integrable or not: not known; {why}.")),
        None if lab.searches.constants.was_stopped() => {
            page.words(
                Role::Dim,
                "Integrable or not: the search was stopped; press I to restart it.",
            );
        }
        None => page.words(Role::Dim, "Integrable or not: the search has not ended yet."),
    }
}

/// Adds what was found, what was searched, and the table of brackets if it is open.
pub(super) fn found(lab: &Lab, style: &RenderStyle, page: &mut TextPage) {
    let Some(Ok(findings)) = lab.findings() else { return };
    let invariants = &findings.invariants;
    let write = |e: Expr| {
        let pool = &findings.equations.pool;
        match pool.weight(e) {
            weight if weight > MOST => {
                format!("… ({weight} pieces: phaselab invariants prints them)")
            }
            _ => style.glyphs.formula(pool, e),
        }
    };
    page.heading(CONSTANTS);
    if invariants.found.is_empty() && !invariants.is_exhausted() {
        page.words(Role::Dim, "None was found.");
    }
    let known = invariants.known.len();
    for (i, constant) in invariants.found.iter().enumerate() {
        let mut remark = format!("found at degree {}", constant.degree);
        remark.push_str(match constant.proof {
            Proof::Proved => ", proved",
            Proof::AtTheseParameters => ", proved at these parameters",
            Proof::Unproved => ", not proved",
        });
        if !constant.independent {
            remark.push_str("; a function of those before");
        }
        if constant.between_impulses {
            remark.push_str("; between impulses");
        }
        page.formula(
            &style.glyphs.text(&findings.names[known + i]),
            write(constant.expression),
            &remark,
        );
    }
    // where the line at the top says no more than the verdict, it has been said
    if findings.summary != findings.relations.verdict {
        page.words(Role::Dim, capital(&findings.relations.verdict));
    }
    let relations = &findings.relations;
    if !relations.completing.is_empty() {
        let names = relations.commuting_names(&findings.names).join(", ");
        page.words(Role::Dim, style.glyphs.text(&format!("In involution: {names} (proved).")));
    }
    // where nothing was searched for, the ansatz says nothing
    let needless = invariants.found.is_empty() && invariants.is_exhausted();
    if let Some(searched) = invariants.searched.last().filter(|_| !needless) {
        let family = if style.glyphs.is_ascii() { &searched.family } else { &searched.shown };
        let words = format!("Searched up to degree {}: {family}.", searched.degree);
        page.words(Role::Dim, style.glyphs.text(&words));
    }
    if invariants.is_exhausted() {
        page.words(Role::Dim, "No other constant can be independent of these.");
    } else if let Some(why) = &invariants.ended {
        page.words(Role::Dim, format!("The search ended: {why}. Press I to search further."));
    }
    match findings.separates {
        Some(true) => {
            page.words(Role::Text, "Hamilton–Jacobi separates in these coordinates: proved.");
        }
        Some(false) => {
            page.words(
                Role::Dim,
                "Hamilton–Jacobi does not separate in these coordinates: proved.",
            );
        }
        None => {}
    }
    let constants = known + invariants.found.len();
    if findings.hamiltonian && constants > 0 {
        let brackets = constants > 1 && !lab.searches.constants.brackets;
        if brackets {
            page.words(Role::Dim, "Press B for the brackets of the constants.");
        }
        page.words(
            Role::Dim,
            "Press J to carry the state along the flow of a constant or a symmetry.",
        );
    }
    if lab.searches.constants.brackets {
        let parameters = !lab.loaded.model.parameters.is_empty();
        brackets(findings, parameters, style, page, &write);
    }
}

/// Adds \[I_i, I_j\] of every pair.
fn brackets(
    findings: &Findings,
    parameters: bool,
    style: &RenderStyle,
    page: &mut TextPage,
    write: &dyn Fn(Expr) -> String,
) {
    page.heading(BRACKETS);
    if !findings.hamiltonian {
        page.words(
            Role::Dim,
            "More than H acts here, so constants of the motion have no brackets.",
        );
        return;
    }
    let table = &findings.relations.brackets;
    let mut commuting = Vec::new();
    for (i, row) in table.iter().enumerate() {
        for (j, entry) in row.iter().enumerate().skip(i + 1) {
            let label = style
                .glyphs
                .text(&format!("[{}, {}]", findings.names[i], findings.names[j]))
                .into_owned();
            match entry {
                Some(e) if *e == Expr::ZERO => commuting.push(label),
                Some(e) => page.formula(&label, write(*e), ""),
                None => page.words(Role::Dim, format!("{label} is not known in closed form.")),
            }
        }
    }
    if !commuting.is_empty() {
        let these = if parameters { ", for these values of the parameters" } else { "" };
        let words = format!("{} = 0: proved{these}.", commuting.join(" = "));
        page.words(Role::Good, words);
    }
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(|c| c.to_uppercase().to_string()).unwrap_or_default();
    format!("{first}{}.", letters.as_str())
}
