//! Help: the text of each command, word for word, and the correctness of its examples.
//!
//! `tests/help` contains the text of each command at 80 columns. `UPDATE_EXPECT=1` rewrites the texts; review them
//! afterwards.

use std::fs;
use std::path::{Path, PathBuf};

use clap::Command;
use phaselab::preset::Catalog;

use super::phaselab;

/// Every command with its words, the program itself first, with help of this width.
fn commands(width: usize) -> Vec<(Vec<String>, Command)> {
    let mut whole = phaselab::cli::command().term_width(width);
    whole.build();
    let mut all = vec![(Vec::new(), whole)];
    let mut at = 0;
    while at < all.len() {
        let (words, command) = all[at].clone();
        let below = command.get_subcommands().filter(|command| command.get_name() != "help");
        for command in below {
            let mut words = words.clone();
            words.push(command.get_name().to_owned());
            all.push((words, command.clone().term_width(width)));
        }
        at += 1;
    }
    all
}

fn file(words: &[String]) -> PathBuf {
    let name = if words.is_empty() { "phaselab".to_owned() } else { words.join("-") };
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/help").join(name).with_extension("txt")
}

#[test]
fn each_command_says_what_is_written() {
    let update = std::env::var_os("UPDATE_EXPECT").is_some();
    let mut wrong = Vec::new();
    let commands = commands(80);
    for (words, command) in &commands {
        let help = command.clone().render_long_help().to_string();
        let widest = help.lines().map(|line| line.chars().count()).max().unwrap_or(0);
        assert!(widest <= 80, "{words:?} is {widest} wide:\n{help}");
        let path = file(words);
        if update {
            fs::write(path, help).unwrap();
        } else if fs::read_to_string(&path).unwrap_or_default() != help {
            wrong.push(help);
        }
    }
    assert!(wrong.is_empty(), "help that differs:\n\n{}", wrong.join("\n"));
    let files = fs::read_dir(file(&[]).parent().unwrap()).unwrap().count();
    assert_eq!(files, commands.len(), "a file of tests/help belongs to no command");
}

#[test]
fn each_argument_says_what_it_is_for() {
    for (words, command) in commands(80) {
        assert!(command.get_about().is_some(), "{words:?}");
        for argument in command.get_arguments() {
            assert!(argument.get_help().is_some(), "{words:?} {}", argument.get_id());
        }
    }
}

/// The lines below `Examples:`, for each command without subcommands.
fn examples() -> Vec<(Vec<String>, String)> {
    let mut all = Vec::new();
    for (words, command) in commands(80) {
        let help = command.get_after_help().map(ToString::to_string).unwrap_or_default();
        let lines = help.lines().skip_while(|line| *line != "Examples:").skip(1);
        let lines: Vec<String> =
            lines.take_while(|line| line.starts_with("  ")).map(|l| l.trim().to_owned()).collect();
        // the subcommands of `config` have theirs in the help of `config`
        assert!(words.len() > 1 || !lines.is_empty(), "{words:?} has no examples");
        all.extend(lines.into_iter().map(|line| (words.clone(), line)));
    }
    all
}

/// A command line's words, up to a shell operator or a comment.
fn words(line: &str) -> Vec<String> {
    let (mut words, mut word, mut quote) = (Vec::new(), None::<String>, None);
    let mut characters = line.chars().peekable();
    while let Some(c) = characters.next() {
        match (quote, c) {
            (Some(open), _) if c == open => quote = None,
            (None, '\'' | '"') => {
                quote = Some(c);
                word.get_or_insert_default();
            }
            (None, '|' | '>' | '&') => break,
            (None, ' ') => {
                words.extend(word.take());
                if characters.peek() == Some(&' ') {
                    break;
                }
            }
            _ => word.get_or_insert_default().push(c),
        }
    }
    words.extend(word);
    words
}

#[test]
fn the_examples_are_right() {
    let catalog = Catalog::with_folder(None);
    for (of, line) in examples() {
        let words = words(&line);
        assert_eq!(words[0], "phaselab", "{line}");
        assert_eq!(words.get(1..=of.len()).unwrap_or_default(), of, "{line}");
        let parsed = phaselab::cli::command().try_get_matches_from(&words);
        let mut matches = &parsed.unwrap_or_else(|why| panic!("{line}: {why}"));
        while let Some((_, below)) = matches.subcommand() {
            matches = below;
        }
        let name = matches.try_get_one::<String>("name").ok().flatten();
        if let Some(name) = name.filter(|name| !name.contains('.')) {
            assert!(catalog.find(name).is_ok(), "{line}");
        }
    }
}

#[test]
fn help_is_asked_for_in_every_way() {
    let long = phaselab(&["run", "--help"]).success();
    assert_eq!(phaselab(&["help", "run"]).success(), long);
    assert!(long.contains("Examples:\n  phaselab run pendulum"), "{long}");
    assert!(phaselab(&["run", "-h"]).success().len() < long.len());
    assert_eq!(phaselab(&["-V"]).success(), phaselab(&["--version"]).success());
}
