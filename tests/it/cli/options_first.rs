//! Options of the laboratory before the name of a command or after it: they hold where the command shows something on its
//! screen, and are refused by name where it does not.

use super::phaselab;

#[test]
fn a_command_that_has_no_screen_refuses_them_by_name() {
    let refused = |arguments: &[&str], option: &str, command: &str| {
        let sentence =
            format!("`{option}` is an option of the laboratory, which `{command}` does not take");
        phaselab(arguments).fails(2, &[&sentence]);
    };
    refused(&["--fps", "4", "derive", "pendulum"], "--fps", "derive");
    refused(&["--theme=light", "run", "pendulum"], "--theme", "run");
    refused(&["--color", "never", "--fps", "4", "list"], "--color", "list");
    refused(&["--theme", "dark", "theme", "list"], "--theme", "theme");
    refused(&["--resume", "tour"], "--resume", "tour");
    refused(&["--fps", "4", "--watch", "lessons"], "--watch", "lessons");
    refused(&["-l", "play", "pendulum"], "-l", "play");
    refused(&["--demo", "tour"], "--demo", "tour");
}

#[test]
fn a_command_on_the_screen_takes_them() {
    // without a terminal it says that it needs one, and nothing of a name that is not there
    phaselab(&["--fps", "4", "tour"]).fails(2, &["needs a terminal"]);
    phaselab(&["--reduce-motion", "lessons", "kepler"]).fails(2, &["needs a terminal"]);
    let listed = phaselab(&["--fps", "4", "lessons"]).success();
    assert_eq!(listed, phaselab(&["lessons"]).success());
    // what is wrong with them is said as ever
    phaselab(&["--fps", "0", "tour"]).fails(2, &["--fps"]);
    phaselab(&["--fps", "tour"]).fails(2, &["--fps"]);
}

#[test]
fn it_takes_them_after_its_name_too() {
    phaselab(&["tour", "--fps", "4"]).fails(2, &["needs a terminal"]);
    phaselab(&["tour", "--restart", "--mouse=false"]).fails(2, &["needs a terminal"]);
    phaselab(&["--theme", "light", "play", "pendulum", "--fps=4"]).fails(2, &["needs a terminal"]);
    let listed = phaselab(&["lessons", "--theme", "light"]).success();
    assert_eq!(listed, phaselab(&["lessons"]).success());
    phaselab(&["tour", "--fps", "0"]).fails(2, &["--fps"]);
    phaselab(&["lessons", "kepler", "--glyphs", "brail"]).fails(2, &["--glyphs", "braille"]);
    phaselab(&["--fps", "4", "tour", "--fps", "5"]).fails(2, &["--fps", "multiple times"]);
    // what a lesson or a cast does not take is refused there too, and so is all of it without a screen
    phaselab(&["tour", "--watch"]).fails(2, &["--watch"]);
    phaselab(&["play", "pendulum", "--log"]).fails(2, &["--log"]);
    phaselab(&["derive", "pendulum", "--fps", "4"]).fails(2, &["--fps"]);
    let help = phaselab(&["play", "--help"]).success();
    assert!(
        help.contains("--fps") && help.contains("--theme") && !help.contains("--watch"),
        "{help}"
    );
}

/// Who has just written a file asks for it by the same name.
#[test]
fn a_name_that_is_a_file_of_this_folder_is_understood() {
    let said = "unknown command or preset `system`; did you mean the file `./system.toml`?";
    super::with_file("", &["system"]).fails(2, &[said]);
    super::with_file("", &["systen"]).fails(2, &["unknown command or preset `systen`"]);
}

#[test]
fn a_word_that_is_no_command_stays_the_name_of_a_system() {
    phaselab(&["--fps", "4", "pendulum"]).fails(2, &["needs a terminal"]);
    phaselab(&["--fps", "4", "tuor"]).fails(2, &["unknown command or preset `tuor`"]);
    let help = phaselab(&["--fps", "4", "--help"]).success();
    assert!(help.contains("Usage: phaselab"), "{help}");
}
