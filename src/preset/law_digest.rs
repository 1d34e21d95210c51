//! Whether two texts of a file give the same law of motion.
//!
//! In: a text. Out: a digest of the tables that a motion depends on. Never here: the law.

use toml::{Table, Value};

use crate::num;

/// The tables that the law of motion and its initial values depend on.
const OF_THE_LAW: &[&str] = &[
    "coordinates",
    "variables",
    "parameters",
    "ramps",
    "definitions",
    "lagrangian",
    "hamiltonian",
    "poisson",
    "constraints",
    "impulses",
    "events",
    "body",
    "attitude",
    "comparison",
    "run",
];

/// The keys of what has a name in the file that only describe it.
const DESCRIPTIONS: &[&str] = &["symbol", "unit", "about", "min", "max", "scale"];

/// The keys of `[run]` that the motion depends on.
const OF_THE_METHOD: &[&str] = &["method", "step", "tolerance"];

/// Returns a digest of what a file says of its law of motion, its initial values and its method, the same whatever it says of
/// its title, notes, views and claims, and however it is laid out. `None` if the text is not TOML.
pub fn law_digest(text: &str) -> Option<String> {
    let mut file: Table = text.parse().ok()?;
    // the tables have no order in the file, but their entries do
    let mut law = Table::new();
    for key in OF_THE_LAW {
        let Some(mut entry) = file.remove(*key) else { continue };
        match (*key, &mut entry) {
            ("coordinates" | "variables" | "parameters", Value::Table(named)) => {
                named
                    .iter_mut()
                    .for_each(|(_, one)| retain(one, |key| !DESCRIPTIONS.contains(&key)));
            }
            ("constraints" | "impulses", Value::Array(all)) => {
                for one in all {
                    retain(one, |key| !DESCRIPTIONS.contains(&key));
                }
            }
            ("run", run) => retain(run, |key| OF_THE_METHOD.contains(&key)),
            _ => {}
        }
        law.insert((*key).to_owned(), entry);
    }
    // what an event waits for may be an observable, and that another one
    let mut others: Vec<Value> = match file.remove("observables") {
        Some(Value::Array(all)) => all,
        _ => Vec::new(),
    };
    let mut law = law.to_string();
    while let Some(used) = others.iter().position(|one| is_named(one, &law)) {
        law += &others.remove(used).to_string();
    }
    Some(format!("{:016x}", num::digest(law.as_bytes())))
}

fn is_named(observable: &Value, text: &str) -> bool {
    let name = observable.get("name").and_then(Value::as_str);
    name.is_some_and(|name| {
        let word = |c: char| c.is_alphanumeric() || c == '_';
        text.match_indices(name).any(|(at, _)| {
            let before = text[..at].chars().next_back();
            let after = text[at + name.len()..].chars().next();
            !name.is_empty() && !before.is_some_and(word) && !after.is_some_and(word)
        })
    })
}

fn retain(value: &mut Value, keeps: impl Fn(&str) -> bool) {
    if let Value::Table(table) = value {
        table.retain(|key, _| keeps(key));
    }
}
