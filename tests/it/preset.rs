//! Preset files: what they may say, every mistake with its exact report, and the catalog.

mod bad;
mod catalog;
mod good;
mod hostile;
mod scope;
mod tables;

/// A small system that is right, in the parts of its file.
const GOOD: &str = r#"title = "Oscillator"

[coordinates]
x = { initial = 1.0 }

[parameters]
m = 1.0
k = 2.0

[lagrangian]
L = "1/2*m*x'^2 - 1/2*k*x^2"
"#;
