//! Constants of the motion as one JSON object. The keys are a stable interface for other programs; every expression is
//! in the syntax of preset files.

use serde_json::{Value, json};

use super::InvariantsReport;
use super::MathScript;
use crate::expr::Expr;
use crate::integrability::Proof;

pub(super) fn write(answer: &InvariantsReport<'_>) -> String {
    let InvariantsReport { model, equations, invariants, relations, .. } = answer;
    let text = |e: Expr| Value::String(equations.pool.text(e));
    let names: Vec<String> = answer.names();
    let commutes = |i: usize| -> Value {
        if !answer.hamiltonian {
            return Value::Null;
        }
        let others = (0..names.len()).filter(|&j| j != i);
        let commuting = others.filter(|&j| relations.brackets[i][j] == Some(Expr::ZERO));
        commuting.map(|j| Value::String(names[j].clone())).collect()
    };
    let known = invariants.known.iter().enumerate().map(|(i, known)| {
        json!({
            "name": known.name,
            "expression": text(known.expression),
            "degree": known.degree,
            "independent": invariants.known_independent.get(i),
            "commutes_with": commutes(i),
        })
    });
    let first = invariants.known.len();
    let found = invariants.found.iter().enumerate().map(|(i, constant)| {
        json!({
            "name": names[first + i],
            "expression": text(constant.expression),
            "degree": constant.degree,
            "proved": constant.proof != Proof::Unproved,
            "for_all_parameters": constant.proof == Proof::Proved,
            "between_impulses": constant.between_impulses,
            "independent": constant.independent,
            "commutes_with": commutes(first + i),
        })
    });
    let ansatz = invariants
        .searched
        .iter()
        .map(|s| json!({ "degree": s.degree, "family": s.family, "monomials": s.size }));
    // a number of the file that stands for itself is no parameter
    let written = model
        .parameters
        .iter()
        .filter(|p| p.name.starts_with(|c: char| c.is_alphabetic() || c == '_'));
    let parameters: serde_json::Map<String, Value> =
        written.map(|p| (p.name.clone(), json!(p.value))).collect();
    let mut object = json!({
        "phaselab": env!("CARGO_PKG_VERSION"),
        "title": model.info.title,
        "parameters": parameters,
        "method": null,
        "searched": answer.searched(MathScript::Ascii),
        "known": known.collect::<Vec<_>>(),
        "found": found.collect::<Vec<_>>(),
        "none_up_to": invariants.none_up_to,
        "independent": invariants.independent(),
        "degrees_of_freedom": relations.freedoms,
        "in_involution": relations.commuting_names(&names),
        "verdict": relations.verdict,
        "separates": answer.separates,
        "ansatz": ansatz.collect::<Vec<_>>(),
        "ended": invariants.ended,
    });
    if answer.jacobi && answer.hamiltonian {
        let mut brackets = Vec::new();
        for i in 0..names.len() {
            for j in i + 1..names.len() {
                if let Some(e) = relations.brackets[i][j] {
                    brackets.push(json!([names[i], names[j], text(e)]));
                }
            }
        }
        object["brackets"] = Value::Array(brackets);
    }
    if let Some((name, values)) = &answer.scan {
        let values = values.iter().map(|at| {
            json!({
                "value": at.value,
                "independent": at.invariants.independent(),
                "found": at.invariants.found.len(),
                "none_up_to": at.invariants.none_up_to,
            })
        });
        object["scan"] = json!({ "parameter": name, "values": values.collect::<Vec<_>>() });
    }
    format!("{object:#}\n")
}
