//! Systems defined by the brackets of their variables: their motion compared with closed forms and other
//! laws, their invariants, and refusals.

mod command;
mod motion;
mod structure;

/// A free rigid body by Euler's equations.
pub(crate) const BODY: &str = r#"
title = "A free body"

[variables]
L1 = { symbol = "L₁", initial = "I1*w1" }
L2 = { symbol = "L₂", initial = "I2*w2" }
L3 = { symbol = "L₃", initial = "I3*w3" }

[parameters]
I1 = 1.0
I2 = 2.0
I3 = 3.0
w1 = 0.01
w2 = 1.0
w3 = 0.01

[poisson]
H = "L1^2/(2*I1) + L2^2/(2*I2) + L3^2/(2*I3)"
brackets = [["L1", "L2", "-L3"], ["L2", "L3", "-L1"], ["L3", "L1", "-L2"]]
casimirs = { "|L|²" = "L1^2 + L2^2 + L3^2" }
"#;

/// A heavy top without angles: body components of the upward unit vector and of L.
const TOP: &str = r#"
title = "A heavy top"

[variables]
L1 = "I1*thetadot"
L2 = "I1*phidot*sin(theta0)"
L3 = "I3*(psidot + phidot*cos(theta0))"
G1 = 0
G2 = "sin(theta0)"
G3 = "cos(theta0)"

[parameters]
I1 = 1.0
I3 = 0.4
Mgl = 1.0
theta0 = 0.6
thetadot = 0.3
phidot = 0.2
psidot = 5.0

[poisson]
H = "(L1^2 + L2^2)/(2*I1) + L3^2/(2*I3) + Mgl*G3"
brackets = [
  ["L1", "L2", "-L3"], ["L2", "L3", "-L1"], ["L3", "L1", "-L2"],
  ["L1", "G2", "-G3"], ["L2", "G3", "-G1"], ["L3", "G1", "-G2"],
  ["L2", "G1", "G3"], ["L3", "G2", "G1"], ["L1", "G3", "G2"],
]
casimirs = { length = "G1^2 + G2^2 + G3^2", vertical = "L1*G1 + L2*G2 + L3*G3" }

[[observables]]
name = "spin"
expression = "L3"
"#;

/// Predator and prey.
const LOTKA_VOLTERRA: &str = r#"
title = "Lotka and Volterra"

[variables]
x = 2.0
y = 0.5

[parameters]
a = 1.0
b = 1.5
c = 0.75
d = 1.25

[poisson]
H = "a*ln(y) - b*y + c*ln(x) - d*x"
brackets = [["x", "y", "x*y"]]
"#;
