//! What notes of shipped presets name exists: keys, names of the file, other presets, methods, commands with their options.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use phaselab::app::keymap::{KEYS, KeyContext};
use phaselab::integrate::method_named;
use phaselab::model::Model;
use phaselab::preset::Catalog;

/// The names that stand in quotation marks of code.
fn marked(notes: &str) -> impl Iterator<Item = &str> {
    notes.split('`').skip(1).step_by(2)
}

/// Where in the lab a key of the notes may be pressed.
fn is_key(name: &str) -> bool {
    let contexts = [
        KeyContext::Anywhere,
        KeyContext::Experiment,
        KeyContext::Lab,
        KeyContext::Plot,
        KeyContext::Values,
    ];
    let is_named = |names: Vec<String>| names.iter().any(|key| key == name);
    KEYS.iter().any(|binding| contexts.contains(&binding.context) && is_named(binding.key_names()))
}

/// The names that a file declares or shows.
fn declared(model: &Model) -> BTreeSet<String> {
    let pool = &model.pool;
    let of = |symbol| pool.symbol_info(symbol).name.clone();
    let parameters = model.parameters.iter().map(|p| p.name.clone());
    let coordinates = model.coordinates.iter().map(|c| c.name.clone());
    let momenta = model.coordinates.iter().map(|c| of(c.momentum));
    let observables = model.observables.iter().map(|o| o.name.clone());
    let definitions = model.definitions.iter().map(|d| d.0.clone());
    let generators = model.generators.iter().map(|g| g.name.clone());
    let maps = model.transformations.iter().map(|t| t.name.clone());
    let constants = model.complete_integral.iter().flat_map(|s| &s.constants);
    let constants = constants.flat_map(|c| [c.name.clone(), format!("beta_{}", c.name)]);
    parameters
        .chain(coordinates)
        .chain(momenta)
        .chain(observables)
        .chain(definitions)
        .chain(generators)
        .chain(maps)
        .chain(constants)
        .collect()
}

/// What of a command does not exist: the subcommand, the system, an option.
fn wrong_in_command(line: &str, presets: &BTreeSet<&str>) -> Option<String> {
    let mut words = line.split_whitespace().skip(1);
    let command = words.next().unwrap_or_default();
    let help = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/help/{command}.txt"));
    let Ok(help) = fs::read_to_string(help) else { return Some(format!("command {command}")) };
    let system = words.next().unwrap_or_default();
    if !presets.contains(system) {
        return Some(format!("system {system}"));
    }
    let options = words.filter(|word| word.starts_with("--"));
    let mut names = options.map(|word| word.split('=').next().unwrap_or(word));
    names.find(|name| !help.contains(&format!("{name} "))).map(str::to_owned)
}

/// Everything that a preset's notes name and that is not there.
fn missing(notes: &str, model: &Model, presets: &BTreeSet<&str>) -> Vec<String> {
    let declared = declared(model);
    let mut all = Vec::new();
    for name in marked(notes) {
        let is_option = name.starts_with("--");
        let is_command = name.starts_with("phaselab ");
        let known = is_option
            || is_command
            || is_key(name)
            || declared.contains(name)
            || presets.contains(name)
            || method_named(name).is_some();
        if !known {
            all.push(name.to_owned());
        }
    }
    let paragraphs = notes.split("\n\n").map(str::trim).filter(|p| p.starts_with("phaselab "));
    let quoted = marked(notes).filter(|name| name.starts_with("phaselab "));
    all.extend(paragraphs.chain(quoted).filter_map(|line| wrong_in_command(line, presets)));
    all
}

#[test]
fn what_notes_name_exists() {
    let catalog = Catalog::with_folder(None);
    let presets: BTreeSet<&str> = catalog.entries().iter().map(|e| e.name.as_str()).collect();
    let mut wrong = Vec::new();
    for entry in catalog.entries() {
        let model = entry.document().unwrap().read().unwrap().model;
        let missing = missing(&model.info.notes, &model, &presets);
        wrong.extend(missing.into_iter().map(|name| format!("{}: {name}", entry.name)));
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn what_does_not_exist_is_found() {
    let catalog = Catalog::with_folder(None);
    let presets: BTreeSet<&str> = catalog.entries().iter().map(|e| e.name.as_str()).collect();
    let model = catalog.find("pendulum").unwrap().read().unwrap().model;
    let notes = "`r` resets, `€` does not, nor `Ctrl-j`; `m` is the mass, `theta` an angle, `pendulum` this one, `mass` nothing.\n\n\
                 phaselab flow pendulum --until 1 --from 2\n\nphaselab flows pendulum\n\nphaselab run no-such";
    let found = missing(notes, &model, &presets);
    assert_eq!(found, ["€", "Ctrl-j", "mass", "--from", "command flows", "system no-such"]);
}
