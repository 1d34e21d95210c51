//! The script of a demo: a file, a preset's own, or the tour, with the system that it opens.
//!
//! In: a name. Out: the script, its system, and the system's name on the screen. Never here: how it is played.

use std::path::Path;

use super::error::CommandError;
use super::{open, record};
use crate::diagnostic::Document;
use crate::preset::is_path;
use crate::record::{Script, called};

/// The tour, which is played if no demo is named.
const TOUR: &str = include_str!("tour.demo");

/// The text of a script: a file's, a preset's demo, or the tour.
pub(super) fn source(name: Option<&str>) -> Result<Document, CommandError> {
    let Some(name) = name else { return Ok(Document::new("tour.demo", TOUR)) };
    let path = Path::new(name);
    let is_script = path.extension().is_some_and(|ending| ending == "demo");
    if is_script || (is_path(name) && path.extension().is_none_or(|ending| ending != "toml")) {
        return Document::open(path).map_err(|why| CommandError::reading(path, &why));
    }
    record::own_demo(name, "name a script, as in --demo my.demo")
}

/// A script with its system and the system's name on the screen.
pub(super) fn scripted(source: &Document) -> Result<(Script, Document, String), CommandError> {
    let script =
        Script::read(source).map_err(|diagnostics| record::located(source, &diagnostics))?;
    let Some(system) = &script.head.open else {
        let what = format!("{} does not say which system it is about: Open NAME", source.path);
        return Err(CommandError::WrongFile(what));
    };
    let document = open::find(&system.text)?;
    // the errors of the system are reported for the system's own file
    open::read(&document)?;
    let name = called(&system.text).to_owned();
    Ok((script, document, name))
}
