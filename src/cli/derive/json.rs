//! The consequences of a law of motion as one JSON object. The keys are a stable interface for
//! other programs; every expression is in the syntax of preset files.

use serde_json::{Map, Value, json};

use super::against::LagrangianComparison;
use crate::expr::{Expr, Symbol};
use crate::mechanics::{
    Further, GeneratingFunction, HamiltonJacobi, Holonomy, LeftSide, NoFunction, Report,
    ReportedEquation, Separation,
};
use crate::model::{EventAction, Model, MotionEvent};

pub(super) fn write(
    report: &Report<'_>,
    further: &Further,
    compared: Option<&LagrangianComparison>,
) -> String {
    let page = JsonReport { report };
    let mut why = Vec::new();
    let solved = match &report.motion {
        Ok(motion) => Value::Object(page.map(motion)),
        Err(reason) => {
            why.push(format!("equations: {reason}"));
            Value::Null
        }
    };
    let mass_matrix = match report.unsolved() {
        Some((mass, _)) => mass.iter().map(|row| page.list(row)).collect(),
        None => Value::Null,
    };
    let hamiltonian = match &report.hamiltonian {
        Ok(h) => page.text(h.right),
        Err(reason) => {
            why.push(format!("hamiltonian: {reason}"));
            Value::Null
        }
    };
    let conserved = report.equations.conserved.iter().map(|c| {
        let expression = page.text(c.expression);
        json!({ "name": c.name, "expression": expression, "reason": c.reason.to_string() })
    });
    let observables = further.classes.iter().map(|c| {
        let rate = c.rate.as_ref().map_or(Value::Null, |&rate| page.text(rate));
        json!({ "name": c.name, "class": c.class.to_string(), "rate": rate })
    });
    let cyclic = report.cyclic.iter().map(|&q| page.left(LeftSide::Symbol(q)));
    let mut object = json!({
        "phaselab": env!("CARGO_PKG_VERSION"),
        "title": report.model.info.title,
        "coordinates": report.model.coordinates.iter().map(|c| &c.name).collect::<Vec<_>>(),
        "not_below_zero": page.list(&report.domain),
        "momenta": page.map(&report.momenta),
        "equations": solved,
        "mass_matrix": mass_matrix,
        "right_hand_side": page.list(&further.right_hand_side),
        "hamiltonian": hamiltonian,
        "energy": page.text(report.energy.right),
        "energy_rate": page.text(report.energy_rate),
        "cyclic": cyclic.collect::<Vec<_>>(),
        "conserved": conserved.collect::<Vec<_>>(),
        "observables": observables.collect::<Vec<_>>(),
        "constraints": page.constraints(),
        "impulses": page.impulses(),
        "events": events(report.model),
        "transformations": page.transformations(further),
        "generators": page.generators(further),
        "separates": report.separation.and_then(Separation::answer),
        "separation": page.separation(),
    });
    let ramps: Vec<Value> = report
        .model
        .parameters
        .iter()
        .filter_map(|p| {
            let mut all = report.model.ramped.functions();
            let (_, e) = all.find(|(symbol, _)| *symbol == p.symbol)?;
            Some(json!({ "parameter": p.name, "value": page.text(e) }))
        })
        .collect();
    if !ramps.is_empty() {
        object["ramps"] = ramps.into();
    }
    if let Some(body) = &report.body {
        let expressions = page.map(&body.lines);
        let body = body.numbers(report.model, report.equations);
        object["body"] = json!({
            "mass": body.mass,
            "centre_of_mass": body.centre,
            "inertia": body.inertia,
            "principal_moments": body.moments,
            "axes": body.axes,
            "expressions": expressions,
        });
    }
    if let Some(compared) = compared {
        object["against"] = compared.json(&report.equations.pool);
    }
    if let Some(integral) = &further.hamilton_jacobi {
        object["hamilton_jacobi"] = page.hamilton_jacobi(integral);
    }
    if report.model.is_poisson() {
        object["variables"] = object["coordinates"].clone();
        let brackets = report.brackets.iter().filter_map(|line| match line.left {
            LeftSide::Bracket(a, b) => {
                let [a, b] = [a, b].map(|symbol| page.left(LeftSide::Symbol(symbol)));
                Some(json!([a, b, page.text(line.right)]))
            }
            _ => None,
        });
        object["brackets"] = brackets.collect();
        let casimirs = report.casimirs.iter().zip(&further.casimir_rates);
        object["casimirs"] = casimirs
            .map(|((name, e), rate)| {
                json!({ "name": name, "expression": page.text(*e), "rate": page.text(*rate) })
            })
            .collect();
    }
    if !why.is_empty() {
        object["why"] = Value::String(why.join("; "));
    }
    format!("{object:#}\n")
}

struct JsonReport<'a> {
    report: &'a Report<'a>,
}

impl JsonReport<'_> {
    fn text(&self, e: Expr) -> Value {
        Value::String(self.report.equations.pool.text(e))
    }

    fn list(&self, all: &[Expr]) -> Value {
        all.iter().map(|&e| self.text(e)).collect()
    }

    fn map(&self, lines: &[ReportedEquation]) -> Map<String, Value> {
        lines.iter().map(|line| (self.left(line.left), self.text(line.right))).collect()
    }

    /// The left-hand side of an equation: `x''`, `p_x'`.
    fn left(&self, left: LeftSide) -> String {
        let name = |symbol| &self.report.equations.pool.symbol_info(symbol).name;
        match left {
            LeftSide::Letter(letter) => letter.to_owned(),
            LeftSide::Symbol(s) | LeftSide::Jump(s) => name(s).clone(),
            LeftSide::Rate(p) => format!("{}'", name(p)),
            LeftSide::Added(letter, q) => format!("{letter}_{}", name(q)),
            LeftSide::Bracket(a, b) => format!("{{{}, {}}}", name(a), name(b)),
        }
    }

    /// Each constraint, Σ coefficient · x' + rate = 0, with its multiplier: the name, and the value
    /// if it is known in closed form. The force on x is λ times the coefficient of x.
    fn constraints(&self) -> Vec<Value> {
        let all = self.report.constraints.iter().map(|known| {
            let named = self.report.model.coordinates.iter().zip(&known.row.row);
            let coefficients: Map<String, Value> =
                named.map(|(c, &a)| (c.name.clone(), self.text(a))).collect();
            json!({
                "name": known.constraint.name,
                "expression": self.text(known.constraint.expression),
                "holonomic": known.holonomy.answer(),
                "given": if known.row.position.is_some() { "position" } else { "velocity" },
                "holonomy": self.holonomy(known.holonomy),
                "coefficients": coefficients,
                "rate": self.text(known.row.rate),
                "multiplier": self.left(LeftSide::Symbol(known.row.multiplier)),
                "lambda": known.multiplier.map(|e| self.text(e)),
            })
        });
        all.collect()
    }

    /// What is known of a constraint on the velocities by Frobenius' theorem.
    fn holonomy(&self, known: &Holonomy) -> Value {
        match known {
            Holonomy::Given | Holonomy::Unknown => Value::Null,
            Holonomy::Holonomic { constant, together, at_these_parameters } => json!({
                "constant": constant.map(|e| self.text(e)),
                "with_the_others": together,
                "for_all_parameters": !at_these_parameters,
            }),
            Holonomy::Not { variables, component } => {
                let all = variables.iter().map(|&s| self.left(LeftSide::Symbol(s)));
                json!({ "component": self.text(*component), "in": all.collect::<Vec<_>>() })
            }
        }
    }

    /// Whether Hamilton–Jacobi separates, and why not.
    fn separation(&self) -> Value {
        match self.report.separation {
            None => Value::Null,
            Some(Separation::Separates { at_these_parameters }) => {
                json!({ "for_all_parameters": !at_these_parameters })
            }
            Some(Separation::Not(a, b)) => {
                let pair = [a, b].map(|&s| self.left(LeftSide::Symbol(s)));
                json!({ "fails_for": pair })
            }
            Some(Separation::Unknown(why)) => json!({ "why": why }),
        }
    }

    /// Each transformation: whether it is canonical, and K.
    fn transformations(&self, further: &Further) -> Vec<Value> {
        let pool = &self.report.equations.pool;
        let name = |symbol| pool.symbol_info(symbol).name.clone();
        let all = further.transformations.iter().map(|known| {
            let map = |solution: &Option<Vec<(Symbol, Expr)>>, order: &[Symbol]| {
                let Some(solution) = solution else { return Value::Null };
                let value = |s: &Symbol| solution.iter().find(|(found, _)| found == s);
                let found = order.iter().filter_map(value);
                Value::Object(found.map(|&(s, e)| (name(s), self.text(e))).collect())
            };
            let failing = known.verdict.failing.iter().map(|bracket| {
                let [a, b] = bracket.pair.map(name);
                let (is, expected) = (self.text(bracket.is), self.text(bracket.expected));
                json!({ "f": a, "g": b, "is": is, "expected": expected })
            });
            let valence = known.verdict.valence.map(|e| self.text(e));
            let parameters = known.canonical_where.iter();
            let parameters: Map<String, Value> =
                parameters.map(|&(s, e)| (name(s), self.text(e))).collect();
            let mut why = known.verdict.why.clone();
            if let (None, Err(reason)) = (&why, &known.hamiltonian) {
                why = Some(format!("K: {reason}"));
            }
            json!({
                "name": known.map.name,
                "canonical": known.verdict.canonical,
                "proved": known.verdict.proved,
                "residual": known.verdict.residual,
                "K": known.hamiltonian.as_ref().ok().map(|&e| self.text(e)),
                "K_of_old": known.hamiltonian_in_old.map(|e| self.text(e)),
                "new": map(&known.map.forwards, &known.map.implicit.new),
                "old": map(&known.backwards, &known.map.old),
                "near_start": known.backwards.as_ref().map(|_| known.is_local),
                "valence": valence,
                "canonical_where": (!parameters.is_empty()).then_some(parameters),
                "generating_functions": self.generating_functions(&known.functions),
                "failing_brackets": failing.collect::<Vec<_>>(),
                "why": why,
            })
        });
        all.collect()
    }

    /// F1 … F4 and those of mixed types where they exist, and why others do not.
    fn generating_functions(&self, known: &[GeneratingFunction]) -> Value {
        let all = known.iter().map(|one| {
            let value = match &one.function {
                Ok(e) => json!({ "F": self.text(*e), "proved": one.proved }),
                Err(why) => {
                    let exists = matches!(why, NoFunction::NotWritten(_));
                    json!({ "F": null, "exists": exists, "why": why.to_string() })
                }
            };
            (one.name(), value)
        });
        Value::Object(all.collect())
    }

    /// Each generator G with [H, G].
    fn generators(&self, further: &Further) -> Vec<Value> {
        let all = further.generators.iter().map(|known| {
            json!({
                "name": known.name,
                "expression": self.text(known.expression),
                "bracket_with_H": known.bracket.as_ref().ok().map(|&e| self.text(e)),
                "conserved": known.conserved,
            })
        });
        all.collect()
    }

    fn hamilton_jacobi(&self, known: &HamiltonJacobi) -> Value {
        let model = self.report.model;
        let coordinates = model.coordinates.iter().zip(&known.momenta);
        let momenta: Map<String, Value> =
            coordinates.map(|(c, &e)| (format!("p_{}", c.name), self.text(e))).collect();
        let constants = model.complete_integral.iter().flat_map(|s| &s.constants);
        let beta: Map<String, Value> =
            constants.zip(&known.beta).map(|(c, &e)| (c.name.clone(), self.text(e))).collect();
        json!({
            "residual": known.residual,
            "complete": known.complete,
            "momenta": momenta,
            "beta": beta,
            "why": known.why,
        })
    }

    /// Each impulse with its time and what it adds to momenta (or variables).
    fn impulses(&self) -> Vec<Value> {
        let all = self.report.impulses.iter().map(|impulse| {
            json!({
                "name": impulse.impulse.name,
                "change": self.map(&impulse.changes),
                "at": self.list(&impulse.impulse.times),
                "every": impulse.impulse.period.map(|e| self.text(e)),
            })
        });
        all.collect()
    }
}

fn events(model: &Model) -> Vec<Value> {
    let object = |event: &MotionEvent| {
        let direction = event.direction.word();
        let action = match event.action {
            EventAction::Mark => "mark".to_owned(),
            EventAction::Section(_) => "section".to_owned(),
            EventAction::Stop => "stop".to_owned(),
            EventAction::Release(k) => format!("release:{}", model.constraints[k].name),
            EventAction::Impulse(k) => format!("impulse:{}", model.impulses[k].name),
        };
        json!({
            "name": event.name,
            "when": model.pool.text(event.when),
            "direction": direction,
            "action": action,
        })
    };
    model.events.iter().map(object).collect()
}
