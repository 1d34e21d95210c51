//! What a new system begins from: a file that runs, with comments on what may be changed.

/// The text of a new file.
pub fn template() -> &'static str {
    TEMPLATE
}

const TEMPLATE: &str = r#"# A system of your own; it runs as it is.
# title = "Pendulum"      # else the file's name

[coordinates]             # theta = 1.0 is enough
theta = { initial = 1.0, velocity = 0.0, unit = "rad", period = "2*pi" }

[parameters]              # sliders; or: m = 1.0
g = { value = 9.81, min = 0, max = 30, unit = "m/s²" }
l = { value = 1, min = 0.1, max = 5, unit = "m", about = "length" }
m = { value = 1, min = 0.1, max = 5, unit = "kg", about = "mass" }

[lagrangian]              # θ′ or theta' is dθ/dt
L = "½ m l² θ′² + m g l cos θ"
# dissipation = "½ c θ′²" # Rayleigh's function

# [hamiltonian]           # p_θ in place of θ′
# H = "½ p_θ²/(m l²) - m g l cos θ"

[space]                   # points are [x, y, z]
shapes = [
  { line = ["0", "0", "0"], to = ["l sin θ", "-l cos θ", "0"] },
  { mass = ["l sin θ", "-l cos θ", "0"] },
]
"#;
