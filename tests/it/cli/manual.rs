//! The manual: it contains everything in the tables, and `man` can display it.

use std::fs;
use std::process::Command;

use phaselab::app::keymap::KEYS;
use phaselab::cli::EXITS;
use phaselab::shell::options::rows;

use super::phaselab;

/// A page as `man` displays it, with runs of spaces collapsed.
fn shown(page: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("page.1");
    fs::write(&path, page).unwrap();
    let output = Command::new("groff")
        .args(["-man", "-Tutf8", "-Kutf8", "-ww", "-P-c", "-P-b", "-P-u", "-rLL=100n"])
        .arg(&path)
        .output()
        .expect("there is no groff: install it (Debian: apt-get install groff-base)");
    let reported = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success() && reported.is_empty(), "{reported}");
    let text = String::from_utf8(output.stdout).unwrap();
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// A roff text without its escapes.
fn plain(page: &str) -> String {
    let page = page.replace("\\fB", "").replace("\\fR", "").replace("\\fI", "").replace("\\-", "-");
    page.replace("\\*(Aq", "'").replace("\\&", "").replace("\\\\", "\\")
}

#[test]
fn the_page_holds_every_table() {
    let page = plain(&phaselab(&["man"]).success());
    for heading in [
        "NAME",
        "SYNOPSIS",
        "DESCRIPTION",
        "OPTIONS",
        "KEYS",
        "FILES",
        "ENVIRONMENT",
        "\"EXIT STATUS\"",
        "EXAMPLES",
        "VERSION",
    ] {
        assert!(page.contains(&format!(".SH {heading}\n")), "{heading} in {page}");
    }
    for row in KEYS {
        assert!(page.contains(row.help), "{}", row.help);
    }
    for row in rows() {
        assert!(page.contains(&format!("--{}", row.name)), "{}", row.name);
        assert!(page.contains(&row.variable()), "{}", row.name);
    }
    for exit in EXITS {
        assert!(page.contains(exit.when), "{}", exit.code);
    }
}

#[test]
fn man_shows_each_page_without_complaint() {
    let whole = shown(&phaselab(&["man"]).success());
    for words in ["phaselab - A laboratory", "pause or resume", "143 ended by a signal"] {
        assert!(whole.contains(words), "no `{words}` in {whole}");
    }
    let command = phaselab::cli::command();
    for below in command.get_subcommands().filter(|command| command.get_name() != "help") {
        let name = below.get_name();
        let page = shown(&phaselab(&["man", name]).success());
        assert!(page.contains(&format!("phaselab-{name}")), "{name}: {page}");
        assert!(page.contains("EXAMPLES"), "{name}: {page}");
    }
}

#[test]
fn a_command_that_is_none_has_no_page() {
    phaselab(&["man", "derives"]).fails(2, &["unknown command `derives`", "`derive`"]);
}
