//! Preset files: their contents, the exact report on every error, and the catalog.

mod bad;
mod catalog;
mod good;
mod hostile;
mod notes;
mod scope;
mod tables;

/// A small correct system, in the parts of its file.
const GOOD: &str = r#"title = "Oscillator"

[coordinates]
x = { initial = 1.0 }

[parameters]
m = 1.0
k = 2.0

[lagrangian]
L = "1/2*m*x'^2 - 1/2*k*x^2"
"#;
