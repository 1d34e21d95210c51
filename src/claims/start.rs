//! Checks whether a motion can start: its state, its energy and its first step must be finite.
//!
//! In: the error that stopped it, and the values at the start. Out: a diagnostic at its place, with
//! the coordinate and the reason. Never here: whether constraints agree at the start, which `system` checks.

use nalgebra::{DMatrix, DVector};

use crate::diagnostic::{Diagnostic, SourceRange};
use crate::dynamics::CompiledLaw;
use crate::expr::{Expr, FunctionId, Node, Pool, Symbol};
use crate::mechanics::{ConstraintRow, Equations, Flow};
use crate::model::{Coordinate, Model};
use crate::num::{Number, no_longer_than, short};
use crate::system::{InitialOverride, MotionError, MotionErrorKind, State};

/// A term of the law longer than this is not reported.
const LONGEST: u64 = 60;

/// A number with more characters than this is written with an exponent.
const LONGEST_NUMBER: usize = 24;

/// The rounding of a value at the start, relative to it.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// A term that changes by more than this part within the rounding of the start has no digits.
const UNKNOWN: f64 = 0.1;

/// What is larger by this factor than at this relative distance is large by a pole.
const BESIDE_A_POLE: f64 = 1e8;
const BESIDE: f64 = 1e-3;

/// Why the motion cannot start at a state, which is empty if there is none with the values that are given: a coordinate has no
/// inertia, or a term of the law or of a constraint no value there.
pub fn undefined_start(
    (model, equations, system): CompiledLaw<'_>,
    state: &State,
    given: &[InitialOverride],
) -> Option<Diagnostic> {
    if model.constraints.is_empty()
        && let Some(cause) = without_mass(model, equations)
    {
        return Some(cause);
    }
    let parameters = model.parameter_values();
    let mut values = system.coordinates_of_start(&parameters, given);
    if !state.values.is_empty() {
        // also where not all of them are known, since the others give the reason
        system.observer(&parameters).observe(state, &mut values).ok();
    }
    let known = system.valuation((model, equations), state.time, &parameters, &values);
    let at = |symbol| known.at(symbol);
    without_value(model, equations, &at).or_else(|| constant_singular_mass(model, equations, &at))
}

/// Why the motion cannot start at a state, if a term of the law has a value there by rounding alone.
pub fn start_on_a_pole(
    (model, equations, system): CompiledLaw<'_>,
    state: &State,
) -> Option<Diagnostic> {
    let parameters = model.parameter_values();
    let mut values = vec![f64::NAN; system.channels().len()];
    system.observer(&parameters).observe(state, &mut values).ok()?;
    let known = system.valuation((model, equations), state.time, &parameters, &values);
    on_a_pole(model, equations, &|symbol| known.at(symbol))
}

/// Returns why nothing can start with this energy, or with the error of the first step, or `None`
/// if it can.
pub(super) fn diagnostic(
    model: &Model,
    equations: &Equations,
    error: Option<&MotionError>,
    energy: f64,
    at: &dyn Fn(Symbol) -> f64,
) -> Option<Diagnostic> {
    let law = model.law_place.clone();
    if error.is_none() && energy.is_finite() {
        return on_a_pole(model, equations, at);
    }
    if let Some(MotionError {
        kind: MotionErrorKind::SingularMass | MotionErrorKind::NoMass, ..
    }) = error
        && let Some(cause) = without_mass(model, equations)
    {
        return Some(cause);
    }
    if let Some(MotionError { kind: MotionErrorKind::SingularMass, .. }) = error
        && let Some(cause) = constant_singular_mass(model, equations, at)
    {
        return Some(cause);
    }
    match (without_value(model, equations, at), error) {
        (Some(cause), _) => Some(cause),
        (None, Some(error)) => {
            Some(Diagnostic::error(law, format!("the motion cannot start: {error}")))
        }
        (None, None) => {
            let message = "the motion cannot start: its energy is not a finite number there";
            Some(Diagnostic::error(law, message))
        }
    }
}

/// A term of the law or of a constraint, as it is or differentiated, that has no value at the start.
fn without_value(
    model: &Model,
    equations: &Equations,
    at: &dyn Fn(Symbol) -> f64,
) -> Option<Diagnostic> {
    let pool = &equations.pool;
    let law = law_and_rates(equations).into_iter().map(|roots| (None, roots));
    let constraints = equations.constraints.iter().map(|constraint| {
        let ConstraintRow { name, row, rate, bias, position, .. } = constraint;
        (Some(name), position.iter().chain(row).chain([rate, bias]).copied().collect())
    });
    let (constraint, culprit) = law
        .chain(constraints)
        .find_map(|(constraint, roots)| Some((constraint, undefined(pool, &roots, at)?)))?;
    let (coordinate, cause) = describe(model, pool, culprit, at)?;
    let written = constraint.and_then(|name| model.constraints.iter().find(|c| c.name == *name));
    let place = written.map(|constraint| &constraint.place);
    let place = place.or_else(|| Some(&model.coordinates[coordinate?].place));
    let within = constraint.map_or(String::new(), |name| format!(", in the constraint `{name}`"));
    let message = format!("the motion cannot start: {cause}{within}");
    let diagnostic = Diagnostic::error(place.unwrap_or(&model.law_place).clone(), message);
    let is_of_power = matches!(pool.node(culprit), Node::Call(FunctionId::Ln, _))
        && pool.symbols_of(culprit).is_empty();
    Some(if is_of_power {
        diagnostic.with_help(
            "a power u^x whose exponent changes is exp(x*ln(u)), so that u must be above zero",
        )
    } else {
        diagnostic
    })
}

/// A coordinate that has no inertia.
fn without_mass(model: &Model, equations: &Equations) -> Option<Diagnostic> {
    let (place, message, help) = without_inertia(model, equations)?;
    Some(Diagnostic::error(place, message).with_help(help))
}

/// Coordinates whose velocities appear in L without giving them a mass.
fn without_inertia(model: &Model, equations: &Equations) -> Option<(SourceRange, String, String)> {
    let Flow::Lagrange { mass, .. } = &equations.flow else { return None };
    let light: Vec<usize> =
        (0..mass.len()).filter(|&i| mass[i].iter().all(|&m| m == Expr::ZERO)).collect();
    let first = *light.first()?;
    let names: Vec<String> =
        light.iter().map(|&i| format!("`{}`", model.coordinates[i].name)).collect();
    let name = &model.coordinates[first].name;
    let message = match names.as_slice() {
        [one] => format!("the motion cannot start: the coordinate {one} has no kinetic term in L"),
        all => format!(
            "the motion cannot start: the coordinates {} have no kinetic term in L",
            all.join(", ")
        ),
    };
    let (_, l) = model.mechanics.function();
    let linear = light.iter().map(|&i| &model.coordinates[i]);
    let linear = linear.into_iter().find(|c| model.pool.depends(l, c.velocity));
    let help = if let Some(Coordinate { name, .. }) = linear {
        format!(
            "L is linear in {name}', so that no acceleration follows; a law of first order in time is \
                 written with [hamiltonian] or [poisson]"
        )
    } else {
        format!("a term such as 1/2*m*{name}'^2 is missing")
    };
    Some((model.coordinates[first].place.clone(), message, help))
}

/// Masses that are constant and do not resist every velocity: that of a coordinate is 0, or those of several are one.
fn constant_singular_mass(
    model: &Model,
    equations: &Equations,
    at: &dyn Fn(Symbol) -> f64,
) -> Option<Diagnostic> {
    let Flow::Lagrange { mass, .. } = &equations.flow else { return None };
    let pool = &equations.pool;
    let coordinates = model.coordinates.iter();
    let mut moving: Vec<Symbol> = coordinates.flat_map(|c| [c.position, c.velocity]).collect();
    moving.push(model.symbols.time);
    if !model.constraints.is_empty()
        || mass.iter().flatten().any(|&m| pool.depends_on_any(m, &moving))
    {
        return None;
    }
    let value = |&m: &Expr| pool.evaluate(m, at);
    let n = mass.len();
    let matrix = DMatrix::from_fn(n, n, |i, k| value(&mass[i][k]));
    let (i, message) = if let Some(i) =
        matrix.row_iter().position(|row| row.iter().all(|m| *m == 0.0))
    {
        let (name, what) = (&model.coordinates[i].name, pool.text(mass[i][i]));
        (i, format!("the mass of the coordinate `{name}` is 0: `{what}`"))
    } else {
        let ratio = unresisted(&matrix)?;
        let among: Vec<usize> = (0..ratio.len()).filter(|&i| ratio[i] != 0.0).collect();
        let first = *among.first()?;
        let names: Vec<String> =
            among.iter().map(|&i| format!("`{}'`", model.coordinates[i].name)).collect();
        let parts: Vec<String> = among.iter().map(|&i| short(ratio[i] / ratio[first])).collect();
        let (names, parts) = (names.join(", "), parts.join(" : "));
        (first, format!("no mass in L resists the velocities {names} in the ratio {parts}"))
    };
    let place = model.coordinates[i].place.clone();
    Some(Diagnostic::error(place, format!("the motion cannot start: {message}")))
}

/// What is less than this part of the masses of its coordinates is 0.
const NOTHING: f64 = 1e-12;

/// Velocities that a matrix of masses takes to 0, if there are any.
fn unresisted(matrix: &DMatrix<f64>) -> Option<DVector<f64>> {
    // coordinates have units of their own
    let units = matrix.diagonal().map(|mass| mass.abs().sqrt());
    if units.iter().any(|unit| *unit == 0.0) {
        return None;
    }
    let scaled =
        DMatrix::from_fn(units.len(), units.len(), |i, k| matrix[(i, k)] / (units[i] * units[k]));
    let factors = scaled.full_piv_lu();
    let upper = factors.u();
    // the pivots fall
    let rank = upper.diagonal().iter().position(|pivot| pivot.abs() <= NOTHING)?;
    let resisted = upper.view((0, 0), (rank, rank));
    let pivots = resisted.solve_upper_triangular(&-upper.view((0, rank), (rank, 1)))?;
    let mut velocities = DVector::zeros(units.len());
    velocities.rows_mut(0, rank).copy_from(&pivots);
    velocities[rank] = 1.0;
    factors.q().inv_permute_rows(&mut velocities);
    Some(velocities.component_div(&units))
}

/// The law and its energy, and what follows from them.
fn law_and_rates(equations: &Equations) -> [Vec<Expr>; 2] {
    let law = equations.lagrangian.iter().copied().chain([equations.energy]).collect();
    [law, equations.flow.expressions()]
}

/// A law that has a value at the start by rounding alone, as tan(x) has at π/2.
fn on_a_pole(
    model: &Model,
    equations: &Equations,
    at: &dyn Fn(Symbol) -> f64,
) -> Option<Diagnostic> {
    let pool = &equations.pool;
    let roots = law_and_rates(equations).concat();
    let reachable = pool.reachable(&roots);
    let has_poles = |e: Expr| match pool.node(e) {
        Node::Call(FunctionId::Tan | FunctionId::Cot, _) => true,
        Node::Product(_, factors) => factors.iter().any(|(_, power)| power.is_negative()),
        _ => false,
    };
    let poles: Vec<Expr> = reachable.iter().copied().filter(|&e| has_poles(e)).collect();
    for (i, c) in model.coordinates.iter().enumerate() {
        let symbol = c.position;
        let value = at(symbol);
        let of_it: Vec<Expr> = poles.iter().copied().filter(|&e| pool.depends(e, symbol)).collect();
        if value == 0.0 || of_it.is_empty() {
            continue;
        }
        let is_on_a_pole = |e: Expr| {
            has_pole(value, |x| pool.evaluate(e, &|s| if s == symbol { x } else { at(s) }))
        };
        let Some(&pole) = of_it.iter().find(|&&e| is_on_a_pole(e)) else { continue };
        // a factor that is 0 may take the pole away
        if roots.iter().any(|&root| is_on_a_pole(root)) {
            let what = if pool.weight(pole) <= LONGEST {
                format!("`{}` has a pole", pool.text(pole))
            } else {
                "a part of the law has a pole".to_owned()
            };
            let message =
                format!("the motion cannot start: {what} at {} = {value}, up to rounding", c.name);
            return Some(Diagnostic::error(model.coordinates[i].place.clone(), message));
        }
    }
    None
}

/// Whether a function has a pole at a place, up to rounding.
fn has_pole(place: f64, function: impl Fn(f64) -> f64) -> bool {
    let at = |part: f64| function(place * (1.0 + part));
    let here = at(0.0);
    let beside = at(BESIDE).abs().max(at(-BESIDE).abs());
    beside > 0.0
        && here.abs() > BESIDE_A_POLE * beside
        && (at(ROUNDING) - here).abs() > UNKNOWN * here.abs()
}

/// The first part of expressions that has no value although its own parts have; a multiplier, say, whose value is not known is no reason.
fn undefined(pool: &Pool, roots: &[Expr], at: &dyn Fn(Symbol) -> f64) -> Option<Expr> {
    pool.reachable(roots).into_iter().find(|&e| {
        !matches!(pool.node(e), Node::Symbol(_))
            && !pool.evaluate(e, at).is_finite()
            && pool.node(e).parts().iter().all(|&part| pool.evaluate(part, at).is_finite())
    })
}

/// Formats `1/x has no value at x = 0`, with the coordinate if there is one.
fn describe(
    model: &Model,
    pool: &Pool,
    e: Expr,
    at: &dyn Fn(Symbol) -> f64,
) -> Option<(Option<usize>, String)> {
    if matches!(pool.node(e), Node::Symbol(_) | Node::Number(_)) {
        return None;
    }
    // the factor of a product that has no value
    let culprit = match pool.node(e) {
        Node::Product(_, factors) => {
            let has_none = |&&(base, power): &&(Expr, Number)| {
                let value = pool.evaluate(base, at);
                let is_root = power.as_integer().is_none();
                value == 0.0 && power.is_negative() || value < 0.0 && is_root
            };
            factors.iter().find(has_none).map(|&(base, _)| base)
        }
        _ => None,
    };
    let symbols = pool.symbols_of(culprit.unwrap_or(e));
    let of = |s: Symbol| {
        model.coordinates.iter().position(|c| [c.position, c.velocity, c.momentum].contains(&s))
    };
    let coordinate = symbols.iter().find_map(|&s| of(s));
    let shown = |s: &Symbol| {
        format!("{} = {}", pool.symbol_info(*s).name, no_longer_than(at(*s), LONGEST_NUMBER))
    };
    let moving: Vec<String> = symbols
        .iter()
        .filter(|&&s| of(s).is_some() || s == model.symbols.time)
        .map(shown)
        .collect();
    let values = if moving.is_empty() { symbols.iter().map(shown).collect() } else { moving };
    let what = if pool.weight(e) <= LONGEST && has_finite_numbers(pool, e) {
        format!("`{}` has no finite value", pool.text(e))
    } else {
        "a part of the law has no finite value".to_owned()
    };
    let place =
        if values.is_empty() { String::new() } else { format!(" at {}", values.join(", ")) };
    Some((coordinate, format!("{what}{place}")))
}

/// Whether all numbers in an expression are finite: a derivative at the end of a domain may have others, as that of asin(1).
fn has_finite_numbers(pool: &Pool, e: Expr) -> bool {
    pool.reachable(&[e]).into_iter().all(|part| match pool.node(part) {
        Node::Number(n) | Node::Product(n, _) => n.value().is_finite(),
        Node::Sum(constant, terms) => {
            constant.value().is_finite() && terms.iter().all(|(c, _)| c.value().is_finite())
        }
        _ => true,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn velocities_that_no_mass_resists_are_found() {
        let of = |rows: &[&[f64]]| {
            let n = rows.len();
            unresisted(&DMatrix::from_fn(n, n, |i, k| rows[i][k]))
        };
        let found = of(&[&[1.0, 1.0], &[1.0, 1.0]]).expect("a ratio");
        assert_eq!(found[0] / found[1], -1.0);
        assert_eq!(of(&[&[1.0, 1.0], &[1.0, 2.0]]), None);
        let found = of(&[&[2.0, 0.0, 4.0], &[0.0, 3.0, 0.0], &[4.0, 0.0, 8.0]]).expect("a ratio");
        assert!((found[0] / found[2] + 2.0).abs() < 1e-12 && found[1] == 0.0, "{found:?}");
        assert_eq!(of(&[&[0.0, 1.0], &[1.0, 0.0]]), None);
        assert_eq!(of(&[&[1.0, 0.0], &[0.0, 1e-26]]), None);
        // x'² + 2 x' y' + (1 + d) y'² resists x' = −y' by d alone, in any units of x
        for unit in [1.0, 1e-10, 1e15] {
            let by = |d: f64| of(&[&[unit * unit, unit], &[unit, 1.0 + d]]);
            assert!(by(0.9e-12).is_some() && by(1.1e-12).is_none(), "{unit}");
        }
    }

    /// 1/(x − 1 + d), with more beside it from a distance on.
    fn near_pole(x: f64, d: f64, (from, more): (f64, f64)) -> f64 {
        let distance = x - 1.0;
        let rest = if distance.abs() >= from { more } else { 0.0 };
        1.0 / (distance + d) + rest
    }

    /// Four units in the last place, 8.9e-16, change 1/(x − 1 + d) by a tenth where d is 8.0e-15.
    #[test]
    fn a_value_that_rounding_changes_by_a_tenth_is_at_a_pole() {
        let is_pole = |d: f64| has_pole(1.0, |x| near_pole(x, d, (0.0, 0.0)));
        assert!(is_pole(7.9e-15) && !is_pole(8.1e-15));
        assert!(is_pole(-1e-15) && !is_pole(0.5));
    }

    #[test]
    fn a_pole_is_larger_by_1e8_than_a_thousandth_beside_it() {
        let is_pole = |from: f64, more: f64| has_pole(1.0, |x| near_pole(x, 1e-15, (from, more)));
        assert!(is_pole(1e-4, 0.99e7) && !is_pole(1e-4, 1.01e7));
        assert!(is_pole(1.01e-3, 1e9) && !is_pole(0.99e-3, 1e9));
    }

    /// What vanishes beside a place has no size there to compare with.
    #[test]
    fn a_spike_alone_is_no_pole() {
        assert!(!has_pole(1.0, |x| if x == 1.0 { 1e20 } else { 0.0 }));
    }
}
