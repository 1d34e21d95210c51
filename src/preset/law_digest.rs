//! Whether two texts of a file give the same law of motion.
//!
//! In: a text. Out: a digest of the tables that the law depends on. Never here: the law.

use toml::{Table, Value};

use crate::num;

/// The tables that the law of motion depends on.
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
];

/// The keys of a coordinate or a variable that say where it starts, or how it is shown.
const OF_THE_START: &[&str] = &["initial", "velocity", "momentum", "symbol", "unit"];

/// The keys of any other table that only describe it.
const DESCRIPTIONS: &[&str] = &["symbol", "unit", "about", "min", "max", "scale"];

/// Returns a digest of what a file says of its law of motion, the same whatever it says of its initial values, notes, views
/// and claims, and however it is laid out. `None` if the text is not TOML.
pub fn law_digest(text: &str) -> Option<String> {
    let mut file: Table = text.parse().ok()?;
    // the tables have no order in the file, but their entries do
    let mut said = Table::new();
    for key in OF_THE_LAW {
        let Some(mut entry) = file.remove(*key) else { continue };
        let described =
            if ["coordinates", "variables"].contains(key) { OF_THE_START } else { DESCRIPTIONS };
        strip(&mut entry, described);
        said.insert((*key).to_owned(), entry);
    }
    Some(format!("{:016x}", num::digest(said.to_string().as_bytes())))
}

/// Removes these keys from the tables that an entry of the file consists of.
fn strip(entry: &mut Value, keys: &[&str]) {
    match entry {
        Value::Array(tables) => tables.iter_mut().for_each(|table| strip_table(table, keys)),
        Value::Table(named) => {
            named.iter_mut().for_each(|(_, value)| {
                // `theta = 2.0` stands for `theta = { initial = 2.0 }`
                if keys.contains(&"initial") && !value.is_table() {
                    *value = Value::Table(Table::new());
                }
                strip_table(value, keys);
            });
        }
        _ => {}
    }
}

fn strip_table(value: &mut Value, keys: &[&str]) {
    if let Value::Table(table) = value {
        table.retain(|key, _| !keys.contains(&key));
    }
}
