//! `new` and `fmt`: a file to begin from, and its plain form.

use std::fs;

use phaselab::experiment::Derived;
use phaselab::mechanics::Report;
use phaselab::preset::{Catalog, UNTITLED, read, template};

use super::{PENDULUM, done, program, with_file};

#[test]
fn a_new_file_runs_and_is_never_written_over() {
    let home = tempfile::tempdir().unwrap();
    let run = |words: &[&str]| done(program(home.path()).args(words));
    let first = run(&["new", "cart"]);
    assert_eq!((first.code, first.stderr.as_str()), (0, ""));
    assert_eq!(first.stdout, "cart.toml was written; open it with phaselab ./cart.toml\n");
    let path = home.path().join("cart.toml");
    assert_eq!(fs::read_to_string(&path).unwrap(), template());
    assert_eq!(run(&["check", "cart.toml"]).code, 0);
    let derived = run(&["derive", "./cart.toml", "--format", "json"]);
    assert!(derived.stdout.contains("\"title\": \"cart\""), "{}", derived.stdout);
    fs::write(&path, "mine").unwrap();
    let again = run(&["new", "cart.toml"]);
    assert_eq!((again.code, again.stdout.as_str()), (2, ""));
    assert!(
        again.stderr.contains("cart.toml already exists and was not overwritten"),
        "{}",
        again.stderr
    );
    assert_eq!(fs::read_to_string(&path).unwrap(), "mine");
    assert_eq!(run(&["new", "nowhere/cart"]).code, 74);
    assert_eq!(run(&["new", ".."]).code, 2);
}

/// The title of a file without one is its name; a text in no file is untitled.
#[test]
fn a_title_may_be_left_out() {
    let file = PENDULUM.replace("title = \"A pendulum\"\n", "");
    assert_ne!(file, PENDULUM);
    assert_eq!(read(&file).unwrap().model.info.title, UNTITLED);
    let derived = with_file(&file, &["derive", "system.toml", "--format", "json"]).success();
    assert!(derived.contains("\"title\": \"system\""), "{derived}");
    assert_eq!(with_file(&file, &["fmt", "system.toml"]).success(), file);
}

#[test]
fn the_notation_of_the_screen_is_written_plainly() {
    let fancy = PENDULUM.replace("theta'^2", "θ′²");
    assert_ne!(fancy, PENDULUM);
    let plain = with_file(&fancy, &["fmt", "system.toml"]).success();
    let [law, expected] = [&plain, PENDULUM].map(|text| {
        let Derived { model, equations } = Derived::of(read(text).unwrap().model).unwrap();
        equations.pool.text(Report::of(&model, &equations).law.right)
    });
    assert_eq!(law, expected);
    assert!(!plain.contains('′'), "{plain}");
    let checked = read(&plain).unwrap();
    assert_eq!(checked.plain, [], "what is plain is left alone");
    let wrong = PENDULUM.replace("theta'^2", "θ′ 2");
    with_file(&wrong, &["fmt", "system.toml"]).fails(65, &["a number comes after", "1 error"]);
}

#[test]
fn only_the_expressions_in_that_notation_change() {
    let text = template();
    let checked = read(text).unwrap();
    let plain = checked.in_plain_form(text);
    assert!(plain.contains("L = \"1/2*m*l^2*theta'^2 + m*g*l*cos(theta)\""), "{plain}");
    assert!(plain.contains("# dissipation = \"½ c θ′²\""), "comments stay: {plain}");
    assert_eq!(plain.lines().count(), text.lines().count());
    let catalog = Catalog::with_folder(None);
    for entry in catalog.entries() {
        let document = catalog.find(&entry.name).unwrap();
        let checked = document.read().unwrap();
        assert_eq!(checked.in_plain_form(&document.text), document.text, "{}", entry.name);
    }
}
