//! The command line that opens the lab as it is set: the system with what differs from its file.
//!
//! In: a system's name, a checkpoint, the method in force. Out: words for a shell. Never here: how words are read (`cli`), or where the
//! motion has come to since.

use super::{App, Effect, Page};
use crate::experiment::{Checkpoint, choose_method};
use crate::integrate::Stepping;

impl App {
    /// Copies the command line that opens the lab as it is set.
    pub(super) fn share(&mut self) -> Vec<Effect> {
        let Some(lab) = self.lab.as_ref().filter(|_| self.page != Page::Picker) else {
            return self.notify("Open a system first: the command opens it as it is set.");
        };
        if !self.has_file() {
            return self.notify("Save the system first (E, Ctrl-s); the command opens its file.");
        }
        if self.is_edited() {
            return self
                .notify("Save the text first (E, Ctrl-s); the command opens the saved file.");
        }
        let Some(mut checkpoint) = lab.checkpoint() else {
            return self.notify("The motion has not begun yet.");
        };
        let of_file = &lab.loaded.model.run.method;
        let chosen = |name: &String| choose_method(&lab.loaded.system, name).ok();
        let method = chosen(checkpoint.method.as_ref().unwrap_or(of_file));
        let names = [method, chosen(of_file)].map(|method| method.map(|method| method.name));
        // what `auto` selects need not be named
        checkpoint.method.take_if(|_| names[0] == names[1]);
        let stepping = method.map_or(Stepping::Adaptive, |method| method.stepping);
        let text = command_line(&lab.loaded.name, &checkpoint, stepping);
        vec![Effect::Copy { what: "the command", text, ending: "sh" }]
    }
}

/// Writes the command that begins a motion with the settings of a checkpoint, of its step and tolerance the one that a
/// method has which steps in this way.
pub fn command_line(system: &str, checkpoint: &Checkpoint, stepping: Stepping) -> String {
    let named = |option: &str, name: &str, value: f64| {
        format!("--{option} {}", quoted(&format!("{name}={}", number(value))))
    };
    let parameters = checkpoint.parameters.iter().map(|p| named("set", &p.name, p.value));
    let initial = checkpoint.initial.iter().map(|i| named("init", &i.name, i.value));
    let method = checkpoint.method.iter().map(|name| format!("--method {}", quoted(name)));
    let setting = |option: &str, value: Option<f64>| {
        value.map(|value| format!("--{option} {}", number(value)))
    };
    let setting = match stepping {
        Stepping::Fixed => setting("step", checkpoint.step),
        Stepping::Adaptive => setting("tolerance", checkpoint.tolerance),
    };
    let options = parameters.chain(initial).chain(method).chain(setting);
    // a file may be called like an option
    let path = if system.starts_with('-') { "./" } else { "" };
    let words = ["phaselab".to_owned(), quoted(&format!("{path}{system}"))];
    let words = words.into_iter().chain(options);
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
        let unchanged = |name| command_line(name, &Checkpoint::default(), Stepping::Adaptive);
        assert_eq!(unchanged("pendulum"), "phaselab pendulum");
        assert_eq!(unchanged("-a.toml"), "phaselab ./-a.toml");
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
        assert_eq!(command_line("my file.toml", &checkpoint, Stepping::Fixed), line);
    }

    #[test]
    fn a_shell_reads_the_word_back() {
        assert_eq!(quoted("a'b$c"), r"'a'\''b$c'");
        assert_eq!(quoted("x=1e-9"), "x=1e-9");
        assert_eq!(quoted(""), "\"\"");
    }
}
