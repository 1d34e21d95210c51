//! Completions: scripts that their shells can read, and the completions that bash then offers.

use std::fs;
use std::process::Command;

use super::phaselab;

#[test]
fn every_shell_has_a_script_with_commands_and_options() {
    for shell in ["bash", "zsh", "fish"] {
        let script = phaselab(&["completions", shell]).success();
        for word in ["derive", "print-default", "tolerance", "no-sync", "list --format names"] {
            assert!(script.contains(word), "{shell}: no {word}");
        }
    }
    let zsh = phaselab(&["completions", "zsh"]).success();
    // derive, bracket and run at least, and the first word
    assert!(zsh.matches(":_phaselab_presets'").count() >= 4, "{zsh}");
    assert!(zsh.contains("\":: :_phaselab_first\"") && !zsh.contains("$line[2]"), "{zsh}");
    let fish = phaselab(&["completions", "fish"]).success();
    assert!(fish.contains("__fish_phaselab_using_subcommand derive' -a '(phaselab list"), "{fish}");
    phaselab(&["completions", "csh"]).fails(2, &["csh", "bash"]);
}

/// Every installed shell reads its script without an error.
#[test]
fn the_scripts_are_right_in_their_shells() {
    let folder = tempfile::tempdir().unwrap();
    let mut read = 0;
    for shell in ["bash", "zsh", "fish"] {
        let path = folder.path().join(shell);
        fs::write(&path, phaselab(&["completions", shell]).success()).unwrap();
        let Ok(output) = Command::new(shell).arg("-n").arg(&path).output() else { continue };
        let reported = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success() && reported.is_empty(), "{shell}: {reported}");
        read += 1;
    }
    assert!(read > 0, "not even bash is here");
}

/// The completions that bash offers for the last of these words.
fn offered(words: &[&str]) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    let script = folder.path().join("completion");
    fs::write(&script, phaselab(&["completions", "bash"]).success()).unwrap();
    fs::write(folder.path().join("my.toml"), "").unwrap();
    let program = assert_cmd::cargo::cargo_bin("phaselab");
    let ask = r#"
        source "$1"; shift
        COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1))
        _phaselab_with_presets phaselab "${COMP_WORDS[COMP_CWORD]}" "${COMP_WORDS[COMP_CWORD-1]}"
        printf '%s\n' "${COMPREPLY[@]}"
    "#;
    let output = Command::new("bash")
        .args(["--norc", "-c", ask, "bash"])
        .arg(&script)
        .args(words)
        .env_clear()
        .env("PATH", format!("{}:/usr/bin:/bin", program.parent().unwrap().display()))
        .env("HOME", folder.path())
        .current_dir(folder.path())
        .output()
        .unwrap();
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
    String::from_utf8(output.stdout).unwrap().lines().map(str::to_owned).collect()
}

#[test]
fn bash_offers_commands_options_presets_and_files() {
    assert_eq!(offered(&["phaselab", "deri"]), ["derive"]);
    assert_eq!(offered(&["phaselab", "henon"]), ["henon-heiles", "henon-heiles-relatives"]);
    assert_eq!(offered(&["phaselab", "run", "henon"]), ["henon-heiles", "henon-heiles-relatives"]);
    assert_eq!(offered(&["phaselab", "derive", "my"]), ["my.toml"]);
    assert_eq!(offered(&["phaselab", "run", "pendulum", "--toler"]), ["--tolerance"]);
    assert_eq!(offered(&["phaselab", "--glyphs", "br"]), ["braille"]);
    assert_eq!(offered(&["phaselab", "methods", "henon"]), [""]);
    let all = offered(&["phaselab", "derive", ""]);
    assert!(all.contains(&"pendulum".to_owned()) && all.len() > 50, "{all:?}");
    assert!(all.iter().all(|word| !word.starts_with(['<', '['])), "{all:?}");
}
