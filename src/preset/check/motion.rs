//! The law of motion and the initial values it needs.

use super::ModelBuilder;
use super::names::Names;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::nearest;
use crate::expr::Expr;
use crate::model::{Allowed, Coordinate, Mechanics, Scope};
use crate::preset::draft::{Draft, DraftCoordinate, DraftMechanics, Formula, LawTable};

impl ModelBuilder<'_> {
    /// Declares the coordinates or variables and the kind of the law, which determine what
    /// expressions may name.
    pub(super) fn moving(&mut self, draft: &Draft) {
        let law = draft.law();
        let poisson = law == Some(LawTable::Poisson);
        let introduce = if poisson { Coordinate::variable } else { Coordinate::new };
        for written in &draft.moving.all {
            let (name, pool) = (written.name.get_ref(), &mut self.model.pool);
            let mut coordinate = introduce(pool, name, &written.symbol, &written.unit);
            coordinate.place = written.name.span();
            self.note_degrees(coordinate.position, &written.unit);
            self.model.coordinates.push(coordinate);
        }
        self.model.mechanics = law.unwrap_or(LawTable::Lagrangian).unread();
        let wrong = match (law, &draft.moving.coordinates, &draft.moving.variables) {
            (Some(LawTable::Poisson), Some(place), _) => {
                let help = "head them with [variables]; each starts from its `initial` alone";
                Some((place, "[poisson] moves [variables], not [coordinates]", help))
            }
            (Some(LawTable::Lagrangian | LawTable::Hamiltonian), _, Some(place)) => {
                let help = "head them with [coordinates], or give the law in [poisson]";
                Some((place, "[variables] are moved by [poisson] only", help))
            }
            _ => None,
        };
        if let Some((place, message, help)) = wrong {
            self.diagnostics.push(Diagnostic::error(place.clone(), message).with_help(help));
        }
    }

    /// Reads the law of motion into the model. Returns `None` unless the file gives exactly one.
    pub(super) fn law(&mut self, given: &[DraftMechanics], names: &mut Names) -> Option<LawTable> {
        let (first, others) = given.split_first()?;
        for other in others {
            let message = "the file gives more than one law of motion";
            let diagnostic = Diagnostic::error(other.place.clone(), message)
                .with_help("keep one of [lagrangian], [hamiltonian] and [poisson]")
                .with_also(first.place.clone(), "the first one");
            self.diagnostics.push(diagnostic);
        }
        for law in given {
            let mechanics = self.mechanics(law, names);
            if law.law == first.law {
                self.model.law_place =
                    law.function.as_ref().map_or(law.place.clone(), toml::Spanned::span);
                self.model.mechanics = mechanics;
            }
        }
        others.is_empty().then_some(first.law)
    }

    fn mechanics(&mut self, written: &DraftMechanics, names: &mut Names) -> Mechanics {
        let (allowed, called) = match written.law {
            LawTable::Lagrangian => (Allowed::Lagrangian, "the Lagrangian"),
            LawTable::Hamiltonian => (Allowed::Hamiltonian, "the Hamiltonian"),
            LawTable::Poisson => (Allowed::Poisson, "the Hamiltonian"),
        };
        let mut scope = Scope::new(&self.model, allowed, called);
        let mut read = |check: &mut Self, called: &str, formula: &Option<Formula>| {
            let formula = formula.as_ref();
            formula.and_then(|f| check.formula(&mut scope, called, f)).unwrap_or(Expr::ZERO)
        };
        let function = read(self, called, &written.function);
        let dissipation = read(self, "Rayleigh's function", &written.dissipation);
        let mut forces = vec![Expr::ZERO; self.model.coordinates.len()];
        for (name, formula) in &written.forces {
            let force = read(self, "a force", formula);
            match self.model.coordinate(name.get_ref()) {
                Some(index) => forces[index] = force,
                None => self.diagnostics.push(self.no_coordinate(name)),
            }
        }
        match written.law {
            LawTable::Lagrangian => {
                Mechanics::Lagrangian { lagrangian: function, dissipation, forces }
            }
            LawTable::Hamiltonian => Mechanics::Hamiltonian { hamiltonian: function, forces },
            LawTable::Poisson => Mechanics::Poisson {
                hamiltonian: function,
                brackets: self.brackets(&written.brackets),
                casimirs: self.casimirs(&written.casimirs, names),
                forces,
                place: written.brackets_place.clone(),
            },
        }
    }

    fn no_coordinate(&self, name: &toml::Spanned<String>) -> Diagnostic {
        let kind = if self.model.is_poisson() { "variable" } else { "coordinate" };
        let message = format!("unknown {kind} `{}`", name.get_ref());
        let diagnostic = Diagnostic::error(name.span(), message);
        let known: Vec<&str> = self.model.coordinates.iter().map(|c| c.name.as_str()).collect();
        let bare = name.get_ref().trim_end_matches('\'');
        match nearest(bare.strip_prefix("p_").unwrap_or(bare), known.iter().copied()) {
            Some(near) => diagnostic.with_help(format!("did you mean `{near}`?")),
            None => diagnostic.with_help(format!("the {kind}s are {}", known.join(", "))),
        }
    }

    /// Reads the initial values, which are expressions in parameters.
    pub(super) fn initial_values(&mut self, draft: &Draft, law: Option<LawTable>) {
        let mut scope = Scope::new(&self.model, Allowed::Parameters, "an initial value");
        for (index, written) in draft.moving.all.iter().enumerate() {
            let name = written.name.get_ref();
            let mut value = |check: &mut Self, called: &str, what: &str, f: &Option<Formula>| {
                let formula = f.as_ref()?;
                let e = check.formula(&mut scope, called, formula)?;
                check.finite(e, what, formula).then_some(e)
            };
            let at = format!("the initial value of `{name}`");
            let initial = value(self, "an initial value", &at, &written.initial);
            let [velocity, momentum] = [&written.velocity, &written.momentum]
                .map(|rate| rate.as_ref().map(|(_, formula)| formula.clone()));
            let what = format!("the initial velocity of `{name}`");
            let velocity = value(self, "an initial velocity", &what, &velocity);
            let what = format!("the initial momentum of `{name}`");
            let momentum = value(self, "an initial momentum", &what, &momentum);
            let what = format!("the period of `{name}`");
            let period = value(self, "a period", &what, &written.period);
            let period = period.filter(|&e| self.positive_period(e, name, written));
            if let Some(law) = law {
                self.right_rate(law, written);
            }
            let coordinate = &mut self.model.coordinates[index];
            coordinate.initial = initial.unwrap_or(Expr::ZERO);
            coordinate.rate_given = written.velocity.is_some() || written.momentum.is_some();
            coordinate.initial_rate = velocity.or(momentum).unwrap_or(Expr::ZERO);
            coordinate.period = period;
        }
    }

    /// A Lagrangian needs initial velocities, a Hamiltonian initial momenta.
    fn right_rate(&mut self, law: LawTable, written: &DraftCoordinate) {
        let (wrong, given, wanted, of) = match law {
            LawTable::Lagrangian => (&written.momentum, "momentum", "velocity", "a Lagrangian"),
            LawTable::Hamiltonian => (&written.velocity, "velocity", "momentum", "a Hamiltonian"),
            LawTable::Poisson => return,
        };
        if let Some((place, _)) = wrong {
            let message = format!("a `{given}` is given, but {of} starts from a `{wanted}`");
            let diagnostic = Diagnostic::error(place.clone(), message);
            self.diagnostics.push(diagnostic.with_help(format!("did you mean `{wanted}`?")));
        }
    }

    fn positive_period(&mut self, e: Expr, name: &str, written: &DraftCoordinate) -> bool {
        let period = self.at_start(e);
        let positive = period > 0.0 || period.is_nan();
        if let (false, Some(formula)) = (positive, &written.period) {
            self.error(formula.span(), format!("the period of `{name}` must be positive"));
        }
        positive
    }

    /// The value of an expression in parameters at the file's values. It is NaN if the expression
    /// uses derived quantities, such as the moments of a body.
    pub(super) fn at_start(&self, e: Expr) -> f64 {
        let value = |symbol| {
            self.model.parameters.iter().find(|p| p.symbol == symbol).map_or(f64::NAN, |p| p.value)
        };
        self.model.pool.evaluate(e, &value)
    }

    pub(super) fn finite(&mut self, e: Expr, what: &str, formula: &Formula) -> bool {
        let symbols = self.model.pool.symbols_of(e);
        let known = symbols.iter().all(|s| self.model.parameters.iter().any(|p| p.symbol == *s));
        let value = self.at_start(e);
        if known && !value.is_finite() {
            let comes = if value.is_nan() { "is not a real number" } else { "is infinite" };
            self.error(formula.span(), format!("with the parameters' values {what} {comes}"));
        }
        !known || value.is_finite()
    }
}

impl LawTable {
    /// A law of this kind in which everything is zero.
    fn unread(self) -> Mechanics {
        let (zero, forces) = (Expr::ZERO, Vec::new());
        match self {
            LawTable::Lagrangian => {
                Mechanics::Lagrangian { lagrangian: zero, dissipation: zero, forces }
            }
            LawTable::Hamiltonian => Mechanics::Hamiltonian { hamiltonian: zero, forces },
            LawTable::Poisson => Mechanics::Poisson {
                hamiltonian: zero,
                brackets: Vec::new(),
                casimirs: Vec::new(),
                forces,
                place: 0..0,
            },
        }
    }
}
