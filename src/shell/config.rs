//! The configuration: a file of the user's with what the laboratory is to be opened with.
//!
//! In: `phaselab/config.toml` where XDG keeps configuration, if it is there. Out: [`Options`], or every mistake in its
//! place. Never here: what an option does.

use std::fmt::Write as _;
use std::io;
use std::path::PathBuf;

use etcetera::BaseStrategy;
use etcetera::base_strategy::Xdg;

use super::options::{Choice, Kind, NAMES, OPTIONS, Options};
use super::regular;
use crate::diagnostic::{Diagnostic, Document};
use crate::preset::{Plain, Setting};

/// Where the configuration stands, whether it is there or not; `None` without a home.
pub fn path() -> Option<PathBuf> {
    Xdg::new().ok().map(|xdg| xdg.config_dir().join("phaselab").join("config.toml"))
}

/// The file there is.
///
/// # Errors
/// Where it is there and cannot be read.
pub fn find() -> io::Result<Option<Document>> {
    let Some(path) = path() else { return Ok(None) };
    match regular::document(&path) {
        Ok(document) => Ok(Some(document)),
        Err(error) => match error.kind() {
            io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => Ok(None),
            _ => Err(error),
        },
    }
}

/// What a configuration asks for.
///
/// # Errors
/// All its mistakes, in the order of their places.
pub fn read(document: &Document) -> Result<Options, Vec<Diagnostic>> {
    let mut options = Options::default();
    let (entries, mut mistakes) = document.settings("the configuration", NAMES);
    for entry in entries {
        let Some(choice) = OPTIONS.iter().find(|choice| choice.name == entry.key) else { continue };
        match word(choice, &entry) {
            Ok(word) => options.ask(choice.name, word),
            Err(mistake) => mistakes.push(mistake),
        }
    }
    mistakes.sort_by_key(|mistake| mistake.place.start);
    if mistakes.is_empty() { Ok(options) } else { Err(mistakes) }
}

/// The value as a word that the option accepts.
fn word(choice: &Choice, entry: &Setting) -> Result<String, Diagnostic> {
    let at = |message: String| Diagnostic::error(entry.place.clone(), message);
    // `color = 256` and `color = true` mean what they say
    let word = match &entry.value {
        Plain::Flag(flag) => flag.to_string(),
        Plain::Number(number) => number.clone(),
        Plain::Text(text) if matches!(choice.kind, Kind::Switch) => {
            let mistake = at(format!("`{}` must be true or false, not a text", choice.name));
            let quoted = ["true", "false"].contains(&text.as_str());
            return Err(if quoted { mistake.with_help("leave the quotes away") } else { mistake });
        }
        Plain::Text(text) => text.clone(),
        Plain::Other(kind) => {
            let wanted =
                if matches!(choice.kind, Kind::Switch) { "true or false" } else { "a word" };
            return Err(at(format!("`{}` must be {wanted}, not {kind}", choice.name)));
        }
    };
    choice.accept(&word).map(|()| word).map_err(|wrong| {
        let mistake = at(wrong.message);
        match wrong.help {
            Some(help) => mistake.with_help(help),
            None => mistake,
        }
    })
}

/// The configuration that says what is so without one, with a comment on each key.
pub fn default_text() -> String {
    let mut text = "\
# The configuration of phaselab: what the laboratory opens with.
# It stands where `phaselab config path` says. An option on the command line
# wins over a variable of the environment (PHASELAB_FPS), and that over a key
# here. Each key below has the value it has without this file.
"
    .to_owned();
    for choice in OPTIONS {
        let _ = writeln!(text, "\n# {}", choice.about);
        match choice.kind {
            Kind::Switch => {}
            Kind::Word(words) => {
                let width = words.iter().map(|(word, _)| word.len()).max().unwrap_or(0);
                for (word, about) in words {
                    let _ = writeln!(text, "#   {word:width$}  {about}");
                }
            }
            Kind::Count { least, most, auto } => {
                let _ = writeln!(text, "#   {least} to {most}, or \"auto\": {auto}");
            }
            Kind::Text { shape, .. } => {
                let _ = writeln!(text, "#   {shape}");
            }
        }
        let quoted = match choice.kind {
            Kind::Switch => choice.usual.to_owned(),
            Kind::Word(_) | Kind::Count { .. } | Kind::Text { .. } => {
                format!("\"{}\"", choice.usual)
            }
        };
        let _ = writeln!(text, "{} = {quoted}", choice.name);
    }
    text
}
