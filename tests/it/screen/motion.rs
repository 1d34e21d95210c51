//! Reduced motion: nothing on the screen blinks, spins or fades by itself.

use std::fs;
use std::path::Path;

/// Names and characters, in code or text, of things that move although nothing happens.
const RESTLESS: [&str; 6] = ["SLOW_BLINK", "RAPID_BLINK", "spinner", "Throbber", "⠋", "◐"];

/// The file in which these words may occur: it only maps them to parameters.
const SGR: &str = "view/sgr.rs";

fn check(folder: &Path, wrong: &mut Vec<String>) {
    for entry in fs::read_dir(folder).expect("a folder of src") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            check(&path, wrong);
        } else if !path.ends_with(SGR) {
            let code = fs::read_to_string(&path).expect("a source file");
            let found = RESTLESS.iter().filter(|word| code.contains(**word));
            wrong.extend(found.map(|word| format!("{word} in {}", path.display())));
        }
    }
}

#[test]
fn nothing_on_the_screen_moves_by_itself() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut wrong = Vec::new();
    for room in ["app", "view", "shell"] {
        check(&source.join(room), &mut wrong);
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}
