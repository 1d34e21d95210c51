//! What a new system begins from: a file that runs, with comments on what may be changed.

/// The text of a new file.
pub fn template() -> &'static str {
    TEMPLATE
}

const TEMPLATE: &str = r#"# A system of your own; it runs as it is. Without a title it is called by its file's name.
# title = "Pendulum"

[coordinates]                     # each with its initial value and velocity; theta = 1.0 is enough
theta = { symbol = "θ", unit = "rad", initial = 1.0, velocity = 0.0, period = "2*pi" }

[parameters]                      # sliders of the lab: a number, or a table
g = { value = 9.81, min = 0.0, max = 30.0, unit = "m/s²", about = "gravity" }
l = { value = 1.0, min = 0.1, max = 5.0, unit = "m", about = "length of the rod" }
m = { value = 1.0, min = 0.1, max = 5.0, unit = "kg", about = "mass of the bob" }

[lagrangian]                      # θ′ (or theta') is the velocity of θ; or write [hamiltonian] and H with p_theta
L = "½ m l² θ′² + m g l cos θ"
# dissipation = "½ c θ′²"         # friction, by Rayleigh's function

[space]                           # a picture: points are [x, y, z]
shapes = [
  { line = ["0", "0", "0"], to = ["l sin θ", "-l cos θ", "0"] },
  { mass = ["l sin θ", "-l cos θ", "0"] },
]
"#;
