//! The command line that opens the lab as it is set: the system with what differs from its file.
//!
//! In: a system's name, a checkpoint. Out: words for a shell. Never here: how words are read (`cli`), or where the
//! motion has come to since.

use super::session::NEW_SYSTEM;
use super::{App, Effect, Saved};
use crate::experiment::Checkpoint;

impl App {
    /// Copies the command line that opens the lab as it is set.
    pub(super) fn share(&mut self) -> Vec<Effect> {
        let Some(Saved { open, moment, edited, .. }) = self.saved() else {
            return self.notify("Save the system first (E, Ctrl-s): a command opens a file.");
        };
        if edited || open == NEW_SYSTEM {
            return self.notify("Save the text first (E, Ctrl-s): a command opens the file.");
        }
        let text = command_line(&open, &moment);
        vec![Effect::Copy { what: "the command", text, ending: "sh" }]
    }
}

/// Writes the command that begins a motion with the settings of a checkpoint.
pub fn command_line(system: &str, checkpoint: &Checkpoint) -> String {
    let named = |option: &str, name: &str, value: f64| {
        format!("--{option} {}", quoted(&format!("{name}={}", number(value))))
    };
    let parameters = checkpoint.parameters.iter().map(|p| named("set", &p.name, p.value));
    let initial = checkpoint.initial.iter().map(|i| named("init", &i.name, i.value));
    let method = checkpoint.method.iter().map(|name| format!("--method {}", quoted(name)));
    let setting = |option: &str, value: Option<f64>| {
        value.map(|value| format!("--{option} {}", number(value)))
    };
    let settings = [setting("step", checkpoint.step), setting("tolerance", checkpoint.tolerance)];
    let options = parameters.chain(initial).chain(method).chain(settings.into_iter().flatten());
    let words = ["phaselab".to_owned(), quoted(system)].into_iter().chain(options);
    words.collect::<Vec<_>>().join(" ")
}

/// A number with all its digits.
fn number(value: f64) -> String {
    let plain = value == 0.0 || (1e-4..1e15).contains(&value.abs());
    if plain { format!("{value}") } else { format!("{value:e}") }
}

/// A word as a shell reads it back.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "_-./=+:,@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        return word.to_owned();
    }
    // θ′ is written theta', which is easier to read within double quotes
    if !word.contains(['"', '$', '`', '\\', '!']) {
        return format!("\"{word}\"");
    }
    format!("'{}'", word.replace('\'', r"'\''"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiment::{Changed, Named};

    #[test]
    fn only_what_differs_is_written() {
        assert_eq!(command_line("pendulum", &Checkpoint::default()), "phaselab pendulum");
        let changed = |name: &str, value| Changed { name: name.to_owned(), value, of_file: 1.0 };
        let checkpoint = Checkpoint {
            parameters: vec![changed("l", 2.0), changed("g", 1.5e-300)],
            initial: vec![Named { name: "theta'".to_owned(), value: -0.1 }],
            method: Some("gauss4".to_owned()),
            step: Some(0.01),
            ..Checkpoint::default()
        };
        let line = "phaselab \"my file.toml\" --set l=2 --set g=1.5e-300 --init \"theta'=-0.1\" \
                    --method gauss4 --step 0.01";
        assert_eq!(command_line("my file.toml", &checkpoint), line);
    }

    #[test]
    fn a_shell_reads_the_word_back() {
        assert_eq!(quoted("a'b$c"), r"'a'\''b$c'");
        assert_eq!(quoted("x=1e-9"), "x=1e-9");
        assert_eq!(quoted(""), "\"\"");
    }
}
