//! A random system with the settings of a run, in natural units, and its file in any units.

use std::fmt::Write as _;

use super::tree::{Spelling, Tree};

/// The form of the law of motion.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Law {
    Lagrangian,
    Hamiltonian,
    /// The brackets of an angular momentum.
    Poisson,
}

/// A constraint: an expression that must be zero.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Constraint {
    pub(crate) expression: Tree,
    pub(crate) holonomic: bool,
}

/// The units in which a file is written, relative to the natural ones.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Units {
    /// The unit of each coordinate.
    pub(crate) positions: Vec<f64>,
    pub(crate) time: f64,
    /// The unit of the energy.
    pub(crate) energy: f64,
    /// Whether they are parameters; otherwise the numbers contain them.
    pub(crate) as_parameters: bool,
}

/// A system and a run of it.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Case {
    pub(crate) law: Law,
    pub(crate) names: Vec<String>,
    /// L is their sum less the potential terms; H is the sum of both.
    pub(crate) kinetic: Vec<Tree>,
    pub(crate) potential: Vec<Tree>,
    pub(crate) dissipation: Vec<Tree>,
    pub(crate) forces: Vec<(usize, Tree)>,
    pub(crate) constraint: Option<Constraint>,
    /// The time at which the constraint is released.
    pub(crate) release: Option<f64>,
    /// For a Poisson system: {a, b} = −(A x)_c, and cyclic, with a symmetric A.
    pub(crate) structure: [[f64; 3]; 3],
    /// Whether the file claims that its energy is conserved.
    pub(crate) claims: bool,
    /// The initial velocities that are overridden as momenta.
    pub(crate) by_momentum: Vec<usize>,
    /// Coordinates, then velocities or momenta.
    pub(crate) start: Vec<f64>,
    /// The time, the coordinate and the size.
    pub(crate) impulse: Option<(f64, usize, f64)>,
    /// The event function whose zero ends the motion.
    pub(crate) stop: Option<Tree>,
    pub(crate) length: f64,
    pub(crate) method: String,
    pub(crate) step: Option<f64>,
    pub(crate) tolerance: Option<f64>,
    pub(crate) units: Units,
}

/// The structure of an angular momentum.
pub(crate) const ROTATIONS: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

impl Units {
    pub(crate) fn natural(count: usize) -> Units {
        Units { positions: vec![1.0; count], time: 1.0, energy: 1.0, as_parameters: false }
    }
}

impl Case {
    pub(crate) fn count(&self) -> usize {
        self.names.len()
    }

    /// The number of components of a state.
    pub(crate) fn numbers(&self) -> usize {
        if self.law == Law::Poisson { self.count() } else { 2 * self.count() }
    }

    /// The index of the time among the variables.
    pub(crate) fn time(&self) -> usize {
        2 * self.count()
    }

    /// All expressions of the law of motion except constraints.
    pub(crate) fn trees(&self) -> impl Iterator<Item = &Tree> {
        let forces = self.forces.iter().map(|(_, tree)| tree);
        self.kinetic.iter().chain(&self.potential).chain(&self.dissipation).chain(forces)
    }

    /// Whether the form of the law conserves the energy.
    pub(crate) fn keeps_energy(&self) -> bool {
        let time = self.time();
        self.dissipation.is_empty()
            && self.forces.is_empty()
            && self.impulse.is_none()
            && self.constraint.as_ref().is_none_or(|c| c.holonomic && !c.expression.holds(time))
            && !self.trees().any(|tree| tree.holds(time))
    }

    /// Whether the momentum of a coordinate is conserved because the coordinate occurs in no expression.
    pub(crate) fn is_cyclic(&self, i: usize) -> bool {
        self.law == Law::Lagrangian
            && self.dissipation.is_empty()
            && self.forces.is_empty()
            && self.constraint.is_none()
            && self.impulse.is_none()
            && !self.trees().any(|tree| tree.holds(i))
    }

    /// The unit of each component of a state.
    pub(crate) fn state_units(&self) -> Vec<f64> {
        let Units { positions, time, energy, .. } = &self.units;
        let second = |x: &f64| match self.law {
            Law::Lagrangian => x / time,
            _ => energy * time / x,
        };
        let both = positions.iter().copied().chain(positions.iter().map(second));
        both.take(self.numbers()).collect()
    }

    /// The case in natural units.
    pub(crate) fn in_natural_units(&self) -> Case {
        Case { units: Units::natural(self.count()), ..self.clone() }
    }

    fn spellings(&self) -> Vec<Spelling> {
        let symbol = |text: String| self.units.as_parameters.then_some(text);
        let units = self.state_units();
        let n = self.count();
        let mut names = Vec::new();
        for (i, name) in self.names.iter().enumerate() {
            let unit = self.units.positions[i];
            names.push(Spelling { name: name.clone(), unit, symbol: symbol(format!("unit_{i}")) });
        }
        for (i, name) in self.names.iter().enumerate() {
            let (name, text) = match self.law {
                Law::Lagrangian => (format!("{name}'"), format!("unit_{i}/unit_t")),
                _ => (format!("p_{name}"), format!("unit_E*unit_t/unit_{i}")),
            };
            let unit = units.get(n + i).copied().unwrap_or(1.0);
            names.push(Spelling { name, unit, symbol: symbol(text) });
        }
        let unit = self.units.time;
        names.push(Spelling { name: "t".to_owned(), unit, symbol: symbol("unit_t".to_owned()) });
        names
    }

    /// The text of the file.
    pub(crate) fn toml(&self) -> String {
        let (names, units) = (self.spellings(), self.state_units());
        let Units { time, energy, as_parameters, .. } = self.units;
        let n = self.count();
        let scale = |unit: f64, text: &str| Spelling {
            name: String::new(),
            unit,
            symbol: (as_parameters && unit != 1.0).then(|| text.to_owned()),
        };
        let terms = |trees: &[Tree], scale: &Spelling| -> String {
            let terms: Vec<String> =
                trees.iter().map(|tree| tree.write_scaled(scale, &names)).collect();
            if terms.is_empty() { "0".to_owned() } else { terms.join(" + ") }
        };
        let mut text = "title = \"A random system\"\n".to_owned();
        let section = if self.law == Law::Poisson { "variables" } else { "coordinates" };
        let _ = writeln!(text, "\n[{section}]");
        for (i, name) in self.names.iter().enumerate() {
            let initial = self.start[i] * units[i];
            let _ = match self.law {
                Law::Poisson => writeln!(text, "{name} = {{ initial = {initial:?} }}"),
                Law::Lagrangian => {
                    let second = self.start[n + i] * units[n + i];
                    writeln!(text, "{name} = {{ initial = {initial:?}, velocity = {second:?} }}")
                }
                Law::Hamiltonian => {
                    let second = self.start[n + i] * units[n + i];
                    writeln!(text, "{name} = {{ initial = {initial:?}, momentum = {second:?} }}")
                }
            };
        }
        if as_parameters {
            let _ = writeln!(text, "\n[parameters]");
            for (i, unit) in self.units.positions.iter().enumerate() {
                let _ = writeln!(text, "unit_{i} = {unit:?}");
            }
            let _ = writeln!(text, "unit_t = {time:?}\nunit_E = {energy:?}");
        }
        let whole = scale(energy, "unit_E");
        let (kinetic, potential) = (terms(&self.kinetic, &whole), terms(&self.potential, &whole));
        let _ = match self.law {
            Law::Lagrangian => writeln!(text, "\n[lagrangian]\nL = \"{kinetic} - ({potential})\""),
            Law::Hamiltonian => writeln!(text, "\n[hamiltonian]\nH = \"{kinetic} + {potential}\""),
            Law::Poisson => {
                let [x, y, z] = [0, 1, 2].map(|i| self.names[i].as_str());
                let c = self.units.positions[0] / (energy * time);
                let row = |i: usize| {
                    let parts = (0..3).filter(|&j| self.structure[i][j] != 0.0);
                    let part =
                        |j: usize| format!("({:?})*{}", -c * self.structure[i][j], self.names[j]);
                    let parts: Vec<String> = parts.map(part).collect();
                    if parts.is_empty() { "0".to_owned() } else { parts.join(" + ") }
                };
                let [of_x, of_y, of_z] = [0, 1, 2].map(row);
                writeln!(
                    text,
                    "\n[poisson]\nH = \"{kinetic} + {potential}\"\nbrackets = [[\"{x}\", \"{y}\", \
                     \"{of_z}\"], [\"{y}\", \"{z}\", \"{of_x}\"], [\"{z}\", \"{x}\", \
                     \"{of_y}\"]]"
                )
            }
        };
        if !self.dissipation.is_empty() {
            let power = scale(energy / time, "unit_E/unit_t");
            let _ = writeln!(text, "dissipation = \"{}\"", terms(&self.dissipation, &power));
        }
        if !self.forces.is_empty() {
            let forces: Vec<String> = self
                .forces
                .iter()
                .map(|(i, tree)| {
                    let unit = scale(energy / units[*i], &format!("unit_E/unit_{i}"));
                    format!("{} = \"{}\"", self.names[*i], tree.write_scaled(&unit, &names))
                })
                .collect();
            let _ = writeln!(text, "forces = {{ {} }}", forces.join(", "));
        }
        if let Some(Constraint { expression, .. }) = &self.constraint {
            let expression = expression.write(&names);
            let _ =
                writeln!(text, "\n[[constraints]]\nname = \"held\"\nexpression = \"{expression}\"");
        }
        if let Some(at) = self.release.filter(|_| self.constraint.is_some()) {
            let _ = writeln!(
                text,
                "\n[[events]]\nname = \"let go\"\nwhen = \"t - {:?}\"\naction = \"release:held\"",
                at * time
            );
        }
        if let Some((at, i, change)) = self.impulse {
            let change = change * energy * time / units[i];
            let _ = writeln!(
                text,
                "\n[[impulses]]\nname = \"kick\"\nat = [{:?}]\nchange = {{ p_{} = \"{change:?}\" }}",
                at * time,
                self.names[i]
            );
        }
        if let Some(stop) = &self.stop {
            let _ = writeln!(
                text,
                "\n[[events]]\nname = \"end\"\nwhen = \"{}\"\ndirection = \"either\"\naction = \"stop\"",
                stop.write(&names)
            );
        }
        if self.claims {
            let _ = writeln!(text, "\n[expect]\nconserves = [\"energy\"]");
        }
        let _ = writeln!(
            text,
            "\n[run]\nmethod = \"{}\"\nuntil = {:?}",
            self.method,
            self.length * time
        );
        if let Some(step) = self.step {
            let _ = writeln!(text, "step = {:?}", step * time);
        }
        if let Some(tolerance) = self.tolerance {
            let _ = writeln!(text, "tolerance = {tolerance:?}");
        }
        text
    }
}
