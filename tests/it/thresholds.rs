//! Thresholds, tested by their decisions: a case just inside and one just outside.

use std::fmt::Write as _;

use phaselab::diagnostic::Document;
use phaselab::mechanics::derive;
use phaselab::system::System;

/// The number of redundant constraints, of two in the plane whose directions differ by this angle.
fn redundant(angle: &str) -> usize {
    let mut text = "title = \"Two rails\"\n[coordinates]\n".to_owned();
    for name in ["x", "y"] {
        let _ = writeln!(text, "{name} = {{ initial = 0 }}");
    }
    let _ = writeln!(
        text,
        "[lagrangian]\nL = \"1/2*(x'^2 + y'^2)\"\n\
         [[constraints]]\nname = \"one\"\nexpression = \"x + y\"\n\
         [[constraints]]\nname = \"other\"\nexpression = \"x + y + {angle}*(x - y)\"\n\
         [run]\nuntil = 1"
    );
    let model = Document::new("rails.toml", text).read().unwrap().model;
    let equations = derive(&model).unwrap();
    let system = System::compile(&model, &equations, &[]).unwrap();
    system.redundant().len()
}

#[test]
fn rows_are_independent_beyond_a_billionth() {
    assert_eq!(redundant("0.0000000015"), 0);
    assert_eq!(redundant("0.0000000007"), 1);
}
