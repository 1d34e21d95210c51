//! Constants of the motion for reading and for typesetting.

use super::InvariantsReport;
use super::MathScript;
use crate::expr::{Expr, latex_name};
use crate::integrability::{Proof, Searched, found_names};

impl InvariantsReport<'_> {
    /// The names of all constants: those known, then I1, I2, … for those found, or another letter.
    pub(super) fn names(&self) -> Vec<String> {
        let known = &self.invariants.known;
        let count = self.invariants.found.len();
        let found = found_names(self.model, &self.equations.pool, known, count);
        known.iter().map(|k| k.name.clone()).chain(found).collect()
    }

    /// What was searched, word for word: the standard family of the highest degree and the one before it, of the
    /// other parity; expressions as in files, or as on the screen.
    pub(super) fn searched(&self, script: MathScript) -> String {
        let family = |searched: &Searched| family(searched, script);
        let standard: Vec<_> = self.invariants.searched.iter().filter(|s| s.standard).collect();
        match standard.as_slice() {
            [] => "nothing".to_owned(),
            [one] => family(one),
            [.., before, last] => format!("{}; and {}", family(last), family(before)),
        }
    }
}

/// An ansatz in words.
fn family(searched: &Searched, script: MathScript) -> String {
    match script {
        MathScript::Unicode => searched.shown.clone(),
        MathScript::Ascii => searched.family.clone(),
    }
}

/// How a constant is known.
fn proof(proof: Proof) -> &'static str {
    match proof {
        Proof::Proved => "proved",
        Proof::AtTheseParameters => "proved at these parameters",
        Proof::Unproved => "not proved: it holds at every random point modulo a prime",
    }
}

pub(super) fn write(answer: &InvariantsReport<'_>, script: MathScript) -> String {
    let InvariantsReport { model, equations, invariants, relations, .. } = answer;
    let math = |e| script.math(&equations.pool, e);
    let names = answer.names();
    let mut text = format!("{}\n{}\n", model.info.title, script.words(&relations.verdict));
    match answer.separates {
        Some(true) => text.push_str(&script.words(
            "Hamilton–Jacobi separates in these coordinates (Levi-Civita's conditions, proved)\n",
        )),
        Some(false) => text.push_str(&script.words(
            "Hamilton–Jacobi does not separate in these coordinates (Levi-Civita's conditions)\n",
        )),
        None => {}
    }
    if !invariants.known.is_empty() {
        text.push_str("\nknown\n");
        for known in &invariants.known {
            text.push_str(&format!("  {} = {}\n", known.name, math(known.expression)));
        }
    }
    if !invariants.found.is_empty() {
        text.push_str("\nfound\n");
        let first = invariants.known.len();
        for (i, constant) in invariants.found.iter().enumerate() {
            let name = &names[first + i];
            text.push_str(&format!("  {name} = {}\n", math(constant.expression)));
            let between = if constant.between_impulses { ", between impulses" } else { "" };
            let dependent = if constant.independent { "" } else { ", depends on those above" };
            text.push_str(&format!(
                "       degree {}, {}{between}{dependent}\n",
                constant.degree,
                proof(constant.proof)
            ));
        }
    }
    if !relations.completing.is_empty() {
        let here = relations.completing.iter().all(|c| c.for_all_parameters);
        let here = if here { "" } else { ", at these parameters" };
        let names = relations.commuting_names(&names).join(", ");
        text.push_str(&format!("\nin involution\n  {names}\n       proved{here}\n"));
    }
    if answer.jacobi && answer.hamiltonian {
        text.push_str("\nbrackets\n");
        for i in 0..names.len() {
            for j in i + 1..names.len() {
                if let Some(e) = relations.brackets[i][j] {
                    text.push_str(&format!("  [{}, {}] = {}\n", names[i], names[j], math(e)));
                }
            }
        }
    }
    text.push_str(&format!("\nsearched\n  {}\n", answer.searched(script)));
    let others: Vec<_> = invariants.searched.iter().filter(|s| !s.standard).collect();
    if let Some(other) = others.last() {
        text.push_str(&format!("  also {}\n", family(other, script)));
    }
    if let Some(n) = invariants.none_up_to {
        let but = if invariants.found.is_empty() {
            "what is known and products of it"
        } else {
            "these and their products"
        };
        text.push_str(&format!("  of this form, up to degree {n}: nothing but {but} (proved)\n"));
    }
    if let Some(why) = &invariants.ended {
        text.push_str(&format!("  ended: {why}\n"));
    }
    if let Some((name, values)) = &answer.scan {
        text.push_str(&format!("\n{name}: constants of the motion\n"));
        for at in values {
            let (total, found) = (at.invariants.independent(), at.invariants.found.len());
            text.push_str(&format!("  {}: {total} independent, {found} found\n", at.value));
        }
    }
    text
}

pub(super) fn latex(answer: &InvariantsReport<'_>) -> String {
    let pool = &answer.equations.pool;
    let known = answer.invariants.known.iter().map(|k| k.expression);
    let all: Vec<Expr> =
        known.chain(answer.invariants.found.iter().map(|c| c.expression)).collect();
    let names = found_names(answer.model, pool, &answer.invariants.known, all.len());
    let lines: Vec<String> = names
        .iter()
        .zip(&all)
        .map(|(name, &e)| format!("{} &= {}", latex_name(name), pool.latex(e)))
        .collect();
    format!("\\begin{{align*}}\n{}\n\\end{{align*}}\n", lines.join(" \\\\\n"))
}
