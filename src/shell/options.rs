//! The options of the laboratory: one row each, from which the command line, the configuration, the environment, the
//! manual page and the README are made.
//!
//! In: words, from any of these. Out: [`Options`], what is asked for by name. Never here: where the words come from,
//! or what an option does.

use super::bandwidth::Bandwidth;
use crate::diagnostic::nearest;
use crate::view::theme::PALETTES;

/// One option: `--name` on the command line, `name` in the configuration, `PHASELAB_NAME` in the environment.
#[derive(Debug)]
pub struct Choice {
    /// Its name.
    pub name: &'static str,
    /// One letter for it on the command line.
    pub letter: Option<char>,
    /// What it may be.
    pub kind: Kind,
    /// What it is where nobody asks.
    pub usual: &'static str,
    /// What it is for, a sentence.
    pub about: &'static str,
    /// Variables by which other programs are reported the same, and which win over the configuration.
    pub overruled_by: &'static [&'static str],
    /// Whether it says what is opened, so that no name can stand beside it.
    pub excludes_name: bool,
}

/// What an option may be.
#[derive(Debug)]
pub enum Kind {
    /// Yes or no.
    Switch,
    /// One of these words, each with what it means.
    Word(&'static [(&'static str, &'static str)]),
    /// A whole number within these, or `auto`, and what that means.
    Count {
        /// The least.
        least: u16,
        /// The greatest.
        most: u16,
        /// What `auto` is.
        auto: &'static str,
    },
    /// Whatever a function accepts.
    Text {
        /// What that is, in a few words.
        shape: &'static str,
        /// Whether a word is one.
        accept: fn(&str) -> bool,
        /// What it is where it is named without a word, which otherwise comes after `=`.
        bare: Option<&'static str>,
    },
}

/// All options of the laboratory.
pub const OPTIONS: &[Choice] = &[
    Choice {
        name: "resume",
        letter: None,
        kind: Kind::Switch,
        usual: "false",
        about: "Go on with the last session: its system, views, values and motion.",
        overruled_by: &[],
        excludes_name: true,
    },
    Choice {
        name: "watch",
        letter: None,
        kind: Kind::Switch,
        usual: "false",
        about: "Build the system anew whenever its file is saved; the motion goes on.",
        overruled_by: &[],
        excludes_name: false,
    },
    Choice {
        name: "color",
        letter: None,
        kind: Kind::Word(&[
            ("auto", "what the environment says: NO_COLOR, COLORTERM, TERM"),
            ("never", "none"),
            ("16", "the terminal's own sixteen"),
            ("256", "the xterm palette"),
            ("true", "24 bits"),
        ]),
        usual: "auto",
        about: "How many colours to use.",
        overruled_by: &["NO_COLOR"],
        excludes_name: false,
    },
    Choice {
        name: "glyphs",
        letter: None,
        kind: Kind::Word(&[
            ("auto", "what the locale says: LC_ALL, LC_CTYPE, LANG"),
            ("braille", "braille patterns, the finest"),
            ("half", "half blocks"),
            ("quadrant", "quarters of a cell"),
            ("sextant", "sixths of a cell; few fonts have them"),
            ("octant", "eighths of a cell; very few fonts have them"),
            ("ascii", "ASCII only"),
        ]),
        usual: "auto",
        about: "What to draw with; `phaselab doctor --glyphs` shows what the font has.",
        overruled_by: &[],
        excludes_name: false,
    },
    Choice {
        name: "theme",
        letter: None,
        kind: Kind::Word(THEMES),
        usual: "auto",
        about: "The colours of the screen; `phaselab theme list` shows them.",
        overruled_by: &[],
        excludes_name: false,
    },
    Choice {
        name: "fps",
        letter: None,
        kind: Kind::Count { least: 1, most: 240, auto: "30, and 15 over ssh" },
        usual: "auto",
        about: "The most frames in a second.",
        overruled_by: &[],
        excludes_name: false,
    },
    Choice {
        name: "bandwidth",
        letter: None,
        kind: Kind::Text {
            shape: "bytes a second such as 16k or 1M, or off; auto: off, and 64k over ssh",
            accept: |word| word == "auto" || word.parse::<Bandwidth>().is_ok(),
            bare: None,
        },
        usual: "auto",
        about: "The most that is sent in a second; where it is too little less is drawn.",
        overruled_by: &[],
        excludes_name: false,
    },
    Choice {
        name: "reduce-motion",
        letter: None,
        kind: Kind::Switch,
        usual: "false",
        about: "At most 4 frames a second, and nothing that fades.",
        overruled_by: &[],
        excludes_name: false,
    },
    Choice {
        name: "log",
        letter: Some('l'),
        kind: Kind::Text {
            shape: "a path, off, or state for phaselab/phaselab.log in your state folder",
            accept: |word| !word.is_empty(),
            bare: Some("state"),
        },
        usual: "off",
        about: "Where to write what happens.",
        overruled_by: &[],
        excludes_name: false,
    },
    Choice {
        name: "mouse",
        letter: None,
        kind: Kind::Switch,
        usual: "false",
        about: "Use the mouse from the beginning; in the lab M switches it on and off.",
        overruled_by: &[],
        excludes_name: false,
    },
    Choice {
        name: "no-sync",
        letter: None,
        kind: Kind::Switch,
        usual: "false",
        about: "Leave out the marks round each frame, for a terminal that shows them.",
        overruled_by: &[],
        excludes_name: false,
    },
];

/// The themes by name, and leaving it to the terminal.
const THEMES: &[(&str, &str)] = &{
    let auto = "dark, or light where COLORFGBG says so";
    let mut words = [("auto", auto); PALETTES.len() + 1];
    let mut at = 0;
    while at < PALETTES.len() {
        words[at + 1] = (PALETTES[at].name, PALETTES[at].about);
        at += 1;
    }
    words
};

/// The names of [`OPTIONS`].
pub const NAMES: &[&str] = &{
    let mut names = [""; OPTIONS.len()];
    let mut at = 0;
    while at < names.len() {
        names[at] = OPTIONS[at].name;
        at += 1;
    }
    names
};

impl Choice {
    /// The environment variable that asks for it: `PHASELAB_NO_SYNC`.
    pub fn variable(&self) -> String {
        format!("PHASELAB_{}", self.name.to_uppercase().replace('-', "_"))
    }

    /// The words it may be, in a few words.
    pub fn words(&self) -> String {
        match self.kind {
            Kind::Switch => "true, false".to_owned(),
            Kind::Word(words) => words.iter().map(|(word, _)| *word).collect::<Vec<_>>().join(", "),
            Kind::Count { least, most, .. } => format!("auto, {least} to {most}"),
            Kind::Text { shape, .. } => shape.to_owned(),
        }
    }

    /// Whether it may be this.
    ///
    /// # Errors
    /// What is wrong, a clause without a full stop, and what would be right.
    pub fn accept(&self, word: &str) -> Result<(), Wrong> {
        let wrong = |wanted: String| Wrong {
            message: format!("`{}` is {wanted}, not `{word}`", self.name),
            help: None,
        };
        match self.kind {
            Kind::Switch if ["true", "false"].contains(&word) => Ok(()),
            Kind::Switch => Err(wrong("true or false".to_owned())),
            Kind::Word(words) if words.iter().any(|(known, _)| *known == word) => Ok(()),
            Kind::Word(words) => {
                let near = nearest(word, words.iter().map(|(word, _)| *word));
                let help = near.map(|near| format!("did you mean `{near}`?"));
                Err(Wrong { help, ..wrong(format!("one of {}", self.words())) })
            }
            Kind::Count { .. } if word == "auto" => Ok(()),
            Kind::Count { least, most, .. } => match word.parse() {
                Ok(number) if (least..=most).contains(&number) => Ok(()),
                _ => Err(wrong(format!("a whole number from {least} to {most}, or auto"))),
            },
            Kind::Text { accept, .. } if accept(word) => Ok(()),
            Kind::Text { shape, .. } => Err(wrong(shape.to_owned())),
        }
    }
}

/// Why a word is not taken.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Wrong {
    /// What is wrong.
    pub message: String,
    /// What would be right, where that can be said.
    pub help: Option<String>,
}

/// What is asked for, by name; what nobody asks for is left out.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Options(Vec<(&'static str, String)>);

impl Options {
    /// Asks for something, in words that were accepted; the last of one name counts.
    pub fn ask(&mut self, name: &'static str, word: impl Into<String>) {
        self.0.retain(|(known, _)| *known != name);
        self.0.push((name, word.into()));
    }

    /// What the environment asks for, `variable` being what it says.
    ///
    /// # Errors
    /// A sentence on a variable that cannot be used.
    pub fn of_environment(variable: &dyn Fn(&str) -> Option<String>) -> Result<Self, String> {
        let mut options = Self::default();
        for choice in OPTIONS {
            let name = choice.variable();
            let Some(word) = variable(&name).filter(|word| !word.is_empty()) else { continue };
            choice.accept(&word).map_err(|wrong| {
                let help = wrong.help.map_or(String::new(), |help| format!("; {help}"));
                format!("{name}: {}{help}", wrong.message)
            })?;
            options.ask(choice.name, word);
        }
        Ok(options)
    }

    /// What a configuration asks for, less what the environment says better by variables that many programs know.
    #[must_use]
    pub fn within(mut self, variable: &dyn Fn(&str) -> Option<String>) -> Self {
        let says = |name: &&str| variable(name).is_some_and(|value| !value.is_empty());
        let overruled = |choice: &&Choice| choice.overruled_by.iter().any(says);
        for choice in OPTIONS.iter().filter(overruled) {
            self.0.retain(|(name, _)| *name != choice.name);
        }
        self
    }

    /// These, and where they ask for nothing those.
    #[must_use]
    pub fn or(mut self, those: Self) -> Self {
        for (name, word) in those.0 {
            if self.get(name).is_none() {
                self.0.push((name, word));
            }
        }
        self
    }

    /// What is asked for under a name.
    pub fn get(&self, name: &str) -> Option<&str> {
        self.0.iter().find(|(known, _)| *known == name).map(|(_, word)| word.as_str())
    }

    /// Whether a switch is on.
    pub fn is_on(&self, name: &str) -> bool {
        self.get(name) == Some("true")
    }

    /// A number; none for `auto`.
    pub fn count(&self, name: &str) -> Option<u16> {
        self.get(name).and_then(|word| word.parse().ok())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn asked(words: &[(&'static str, &str)]) -> Options {
        let mut options = Options::default();
        for (name, word) in words {
            options.ask(name, *word);
        }
        options
    }

    #[test]
    fn every_option_accepts_what_it_usually_is() {
        for choice in OPTIONS {
            assert_eq!(choice.accept(choice.usual), Ok(()), "{}", choice.name);
            let free = matches!(choice.kind, Kind::Text { bare: Some(_), .. });
            assert!(free || choice.accept("no such word").is_err(), "{}", choice.name);
        }
    }

    #[test]
    fn a_flag_wins_over_the_environment_and_that_over_the_configuration() {
        let environment = |name: &str| match name {
            "PHASELAB_FPS" => Some("20".to_owned()),
            "PHASELAB_NO_SYNC" => Some(String::new()),
            "NO_COLOR" => Some("1".to_owned()),
            _ => None,
        };
        let flags = asked(&[("glyphs", "half")]);
        let file =
            asked(&[("glyphs", "ascii"), ("fps", "10"), ("color", "true"), ("no-sync", "true")]);
        let below = Options::of_environment(&environment)
            .expect("good words")
            .or(file.within(&environment));
        let options = flags.or(below);
        assert_eq!(options.get("glyphs"), Some("half"));
        assert_eq!(options.count("fps"), Some(20));
        assert_eq!(options.get("color"), None, "NO_COLOR is the environment's wish");
        assert!(options.is_on("no-sync"), "an empty variable says nothing");
    }

    #[test]
    fn a_variable_that_cannot_be_used_is_reported() {
        let check = |name: &str, word: &str, told: &str| {
            let variable = |asked: &str| (asked == name).then(|| word.to_owned());
            assert_eq!(Options::of_environment(&variable), Err(told.to_owned()));
        };
        check(
            "PHASELAB_FPS",
            "1000",
            "PHASELAB_FPS: `fps` is a whole number from 1 to 240, or auto, not `1000`",
        );
        check(
            "PHASELAB_GLYPHS",
            "brail",
            "PHASELAB_GLYPHS: `glyphs` is one of auto, braille, half, quadrant, sextant, octant, ascii, not `brail`; \
             did you mean `braille`?",
        );
        check("PHASELAB_NO_SYNC", "yes", "PHASELAB_NO_SYNC: `no-sync` is true or false, not `yes`");
    }
}
