//! Units of derived quantities: of the energy, the momenta and the observables, from the units that
//! the file gives.
//!
//! The dimension of an expression follows from its symbols. The dimension of the energy is the one
//! on which all terms with known units agree. A momentum has the dimension of energy times time
//! over its coordinate, because pᵢq̇ᵢ is an energy.
//!
//! In: a model and its energy. Out: units as text, empty if they are not known. Never here:
//! conversion of numbers.

use std::collections::BTreeMap;

use super::{ConstraintRow, Equations};
use crate::expr::{Expr, Node, Symbol};
use crate::model::Model;
use crate::num::Number;

/// Exponents of base units, in halves, because Gaussian units need them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Dimension(BTreeMap<String, i64>);

/// The units of forces and of energies that have names. What has the dimension of an energy is a torque if it acts on an angle.
const FORCES: [&str; 3] = ["N", "J", "N/m"];
const TORQUES: [&str; 1] = ["N m"];
const ENERGIES: [&str; 3] = ["N", "J", "W"];

/// Derived units in terms of base units, in halves: g^½ cm^(3/2)/s is the Gaussian unit of charge.
const DERIVED: [(&str, &[(&str, i64)]); 9] = [
    ("N", &[("kg", 2), ("m", 2), ("s", -4)]),
    ("J", &[("kg", 2), ("m", 4), ("s", -4)]),
    ("W", &[("kg", 2), ("m", 4), ("s", -6)]),
    ("Hz", &[("s", -2)]),
    ("dyn", &[("g", 2), ("cm", 2), ("s", -4)]),
    ("erg", &[("g", 2), ("cm", 4), ("s", -4)]),
    ("esu", &[("g", 1), ("cm", 3), ("s", -2)]),
    ("statV", &[("g", 1), ("cm", 1), ("s", -2)]),
    ("G", &[("g", 1), ("cm", -1), ("s", -2)]),
];

/// The unit of angles. It equals 1 and is written only if a quantity is an angle or a rate of
/// change of one.
const ANGLE: &str = "rad";

/// The order of units: mass and length first, as listed; then all others, with units of time last.
const ORDER: [&str; 7] = ["kg", "g", "M☉", "M⊕", "m", "cm", "au"];
const TIMES: [&str; 5] = ["s", "min", "h", "d", "yr"];

impl Dimension {
    /// Reads `kg m²/s` or `au³/(M☉ yr²)`.
    fn read(unit: &str) -> Option<Self> {
        let mut dimension = Self::with_angles(unit)?;
        dimension.0.remove(ANGLE);
        Some(dimension)
    }

    /// Reads a unit, with the radian treated like any other unit.
    fn with_angles(unit: &str) -> Option<Self> {
        let mut dimension = Self::default();
        for (place, part) in unit.split('/').enumerate() {
            let part = part.trim().trim_start_matches('(').trim_end_matches(')');
            for word in part.split([' ', '·']).filter(|word| !word.is_empty() && *word != "1") {
                let base = word.trim_end_matches(|c| power(c).is_some());
                let raised = word[base.len()..].chars().filter_map(power);
                let exponent = raised
                    .fold(None, |sum: Option<i64>, digit| Some(sum.unwrap_or(0) * 10 + digit));
                let exponent = exponent.unwrap_or(1) * if place == 0 { 1 } else { -1 };
                if !base.chars().all(|c| c.is_alphabetic() || "☉⊕".contains(c)) || base.is_empty()
                {
                    return None;
                }
                match DERIVED.iter().find(|(name, _)| *name == base) {
                    Some((_, parts)) => {
                        for (name, halves) in *parts {
                            dimension.times(name, halves * exponent);
                        }
                    }
                    None => dimension.times(base, 2 * exponent),
                }
            }
        }
        Some(dimension)
    }

    fn times(&mut self, base: &str, halves: i64) {
        let sum = self.0.entry(base.to_owned()).or_insert(0);
        *sum += halves;
        if *sum == 0 {
            self.0.remove(base);
        }
    }

    /// The product with another dimension raised to `n / d`, if all exponents remain halves.
    fn product(mut self, other: &Self, (n, d): (i64, i64)) -> Option<Self> {
        for (base, halves) in &other.0 {
            if (halves * n) % d != 0 {
                return None;
            }
            self.times(base, halves * n / d);
        }
        Some(self)
    }

    /// Returns whether this is the dimension of an angle or of its rate of change.
    fn is_of_angle(&self) -> bool {
        self.0.get(ANGLE) == Some(&2)
            && self.0.iter().all(|(base, halves)| {
                base == ANGLE || TIMES.contains(&base.as_str()) && *halves < 0
            })
    }

    /// The dimension as text, with a force in newtons, an energy in joules and a power in watts given by that name.
    fn named(&self) -> String {
        self.named_as(&ENERGIES).unwrap_or_else(|| self.written())
    }

    /// The one of these units that has this dimension.
    fn named_as(&self, names: &[&str]) -> Option<String> {
        let is_own = |name: &&&str| Self::read(name).as_ref() == Some(self);
        names.iter().find(is_own).map(|name| (*name).to_owned())
    }

    /// The dimension as text, `kg m²/s`; empty if an exponent is not an integer.
    fn written(&self) -> String {
        if self.0.values().any(|halves| halves % 2 != 0) {
            return String::new();
        }
        let rank = |base: &str| match (
            ORDER.iter().position(|b| *b == base),
            TIMES.iter().position(|b| *b == base),
        ) {
            (Some(place), _) => place,
            (None, None) => ORDER.len(),
            (None, Some(_)) => ORDER.len() + 1,
        };
        let mut bases: Vec<(&str, i64)> =
            self.0.iter().map(|(base, halves)| (base.as_str(), halves / 2)).collect();
        bases.sort_by_key(|(base, _)| rank(base));
        let side = |positive: bool| -> Vec<String> {
            let these = bases.iter().filter(|(_, n)| (*n > 0) == positive);
            these.map(|(base, n)| format!("{base}{}", raised(n.abs()))).collect()
        };
        let (above, below) = (side(true), side(false));
        let above = if above.is_empty() { "1".to_owned() } else { above.join(" ") };
        match below.as_slice() {
            [] => above,
            [one] => format!("{above}/{one}"),
            several => format!("{above}/({})", several.join(" ")),
        }
    }
}

/// The value of a superscript digit.
fn power(c: char) -> Option<i64> {
    "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().position(|digit| digit == c).map(|digit| digit as i64)
}

/// An exponent in superscript; 1 is omitted.
fn raised(n: i64) -> String {
    let digits = if n == 1 { String::new() } else { n.to_string() };
    digits.chars().filter_map(|c| "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().nth(c.to_digit(10)? as usize)).collect()
}

impl Equations {
    /// The units of the energy and of each momentum; empty where they do not follow from the file's
    /// units.
    pub fn units(&self, model: &Model) -> (String, Vec<String>) {
        let unknown = || (String::new(), vec![String::new(); model.coordinates.len()]);
        let time = Dimension::read(model.time_unit()).filter(|_| !model.time_unit().is_empty());
        let read = Dimension::read;
        let Some((energy, time)) = self.dimension_read(model, self.energy, read).zip(time) else {
            return unknown();
        };
        if energy == Dimension::default() {
            return unknown();
        }
        let of_momentum = |unit: &str| {
            let coordinate = if unit.is_empty() { None } else { Dimension::read(unit) };
            let action = energy.clone().product(&time, (1, 1))?;
            Some(action.product(&coordinate?, (-1, 1))?.written())
        };
        let momenta = model.coordinates.iter().map(|c| of_momentum(&c.unit).unwrap_or_default());
        (energy.named(), momenta.collect())
    }

    /// The unit of any other quantity; empty if it does not follow from the file's units or there
    /// is none.
    pub fn unit(&self, model: &Model, e: Expr) -> String {
        let angular = self.dimension_read(model, e, Dimension::with_angles);
        if let Some(angular) = angular.filter(Dimension::is_of_angle) {
            return angular.written();
        }
        let dimension = self.dimension_read(model, e, Dimension::read);
        dimension
            .filter(|d| *d != Dimension::default())
            .map_or_else(String::new, |dimension| dimension.named())
    }

    /// The unit of the multiplier of a constraint: the one that the file gives, or the one that follows.
    pub fn multiplier_unit(&self, model: &Model, index: usize) -> String {
        let (row, constraint) = (&self.constraints[index], &model.constraints[index]);
        if !constraint.unit.is_empty() {
            return constraint.unit.clone();
        }
        let dimension = self.dimension_of_multiplier(model, row);
        let Some(dimension) = dimension.filter(|d| *d != Dimension::default()) else {
            return String::new();
        };
        let torque = || dimension.named_as(&TORQUES).filter(|_| self.acts_on_an_angle(model, row));
        torque().or_else(|| dimension.named_as(&FORCES)).unwrap_or_else(|| dimension.written())
    }

    /// Whether a constraint without a dimension acts on an angle, so that its multiplier is a torque: its coefficient is a number there.
    fn acts_on_an_angle(&self, model: &Model, row: &ConstraintRow) -> bool {
        let read: Reader = Dimension::with_angles;
        let coefficient =
            |e| self.dimension(e, &|symbol| self.dimension_of_symbol(model, symbol, read));
        let terms = row.row.iter().zip(&model.coordinates).filter(|(e, _)| **e != Expr::ZERO);
        let mut angles =
            terms.filter(|(_, c)| read(&c.unit).is_some_and(|unit| unit.is_of_angle()));
        angles.any(|(e, _)| coefficient(*e) == Some(Dimension::default()))
    }

    /// The dimension of a multiplier: λ times a constraint on places is an energy, and λ times one on velocities a power.
    fn dimension_of_multiplier(&self, model: &Model, row: &ConstraintRow) -> Option<Dimension> {
        let read: Reader = Dimension::read;
        let plain = |e| self.dimension(e, &|symbol| self.dimension_of_symbol(model, symbol, read));
        let energy = plain(self.energy)?;
        let of_place = match row.position {
            Some(f) => plain(f)?,
            // A constraint Σ A_α q̇_α + A has the dimension of A_α q_α by the time; so has the energy of the power.
            None => {
                let terms = row.row.iter().zip(&model.coordinates);
                agreed(terms.filter(|(e, _)| **e != Expr::ZERO).map(|(e, c)| {
                    let place = read(&c.unit).filter(|_| !c.unit.is_empty())?;
                    plain(*e)?.product(&place, (1, 1))
                }))?
            }
        };
        energy.product(&of_place, (-1, 1))
    }

    /// Whether a quantity measures a place as the coordinates do, whatever their unit: it depends on the configuration
    /// alone, and is of the first degree in the coordinates that are no angles.
    pub fn is_place(&self, model: &Model, e: Expr) -> bool {
        let attitude = self.supplements.attitude_symbols;
        let is_entry = |s: Symbol| attitude.iter().flatten().flatten().any(|entry| *entry == s);
        let placed = |s: Symbol| model.coordinates.iter().find(|c| c.position == s);
        let moves = |s: &Symbol| placed(*s).is_some() || is_entry(*s);
        let symbols = self.pool.symbols_of(e);
        let given = |s: &Symbol| model.parameters.iter().any(|p| p.symbol == *s);
        let place = || Dimension([("place".to_owned(), 2)].into());
        let degree = |s: Symbol| match placed(s) {
            Some(c) if c.period.is_some() => Some(Dimension::default()),
            Some(_) => Some(place()),
            None => is_entry(s).then(place),
        };
        symbols.iter().any(moves)
            && symbols.iter().all(|s| moves(s) || given(s))
            && self.dimension(e, &degree) == Some(place())
    }

    /// The dimension of an expression, if it follows from the units of the symbols.
    fn dimension_read(&self, model: &Model, e: Expr, read: Reader) -> Option<Dimension> {
        self.dimension(e, &|symbol| {
            self.dimension_of_symbol(model, symbol, read)
                .or_else(|| self.of_multiplier(model, symbol, read))
        })
    }

    /// The dimension of a symbol that is no multiplier.
    fn dimension_of_symbol(
        &self,
        model: &Model,
        symbol: Symbol,
        read: Reader,
    ) -> Option<Dimension> {
        of_symbol(model, symbol, read).or_else(|| self.of_body(model, symbol, read))
    }

    /// The dimension of a multiplier: of the unit that the file gives its constraint, or the one that follows.
    fn of_multiplier(&self, model: &Model, symbol: Symbol, read: Reader) -> Option<Dimension> {
        let mut rows = self.constraints.iter().zip(&model.constraints);
        let (row, constraint) = rows.find(|(row, _)| row.multiplier == symbol)?;
        if constraint.unit.is_empty() {
            return self.dimension_of_multiplier(model, row);
        }
        read(&constraint.unit)
    }

    fn of_body(&self, model: &Model, symbol: Symbol, read: Reader) -> Option<Dimension> {
        let names = model.body.as_ref()?.names;
        let body = self.supplements.body.as_ref()?;
        let same: &[Expr] = if names.mass == symbol {
            &[body.mass]
        } else if names.centre.contains(&symbol) {
            &body.centre
        } else if names.inertia.contains(&symbol) || names.principal.contains(&symbol) {
            &body.inertia
        } else {
            return None;
        };
        // What is zero by the symmetry of the body has the unit of the others.
        let known = same.iter().filter(|e| **e != Expr::ZERO);
        agreed(known.map(|e| self.dimension(*e, &|s| of_symbol(model, s, read))))
    }

    /// The dimension of an expression, if it follows from those of the symbols.
    fn dimension(
        &self,
        e: Expr,
        of_symbol: &dyn Fn(Symbol) -> Option<Dimension>,
    ) -> Option<Dimension> {
        let mut known: BTreeMap<usize, Option<Dimension>> = BTreeMap::new();
        let mut parts = self.pool.reachable(&[e]);
        parts.sort_unstable();
        for part in parts {
            let of = |e: &Expr| known.get(&e.index()).cloned().flatten();
            let dimension = match self.pool.node(part) {
                Node::Number(_) | Node::Pi => Some(Dimension::default()),
                Node::Symbol(symbol) => of_symbol(*symbol),
                Node::Sum(_, terms) => agreed(terms.iter().map(|(_, e)| of(e))),
                Node::Product(_, factors) => {
                    factors.iter().try_fold(Dimension::default(), |product, (base, exponent)| {
                        let Number::Rational(n, d) = exponent else { return None };
                        product.product(&of(base)?, (*n, *d))
                    })
                }
                Node::Power(..) => None,
                Node::Call(id, arguments) => match (id.row().name, &**arguments) {
                    ("abs", [e]) => of(e),
                    ("sqrt", [e]) => Dimension::default().product(&of(e)?, (1, 2)),
                    ("min" | "max", all) => agreed(all.iter().map(of)),
                    _ => Some(Dimension::default()),
                },
            };
            known.insert(part.index(), dimension);
        }
        known.remove(&e.index()).flatten()
    }
}

/// A function that reads a unit.
type Reader = fn(&str) -> Option<Dimension>;

/// The dimension of a parameter, a coordinate or a velocity.
fn of_symbol(model: &Model, symbol: Symbol, read: Reader) -> Option<Dimension> {
    if let Some(parameter) = model.parameters.iter().find(|p| p.symbol == symbol) {
        return read(&parameter.unit).filter(|_| !parameter.unit.is_empty());
    }
    let coordinate = |c: &&crate::model::Coordinate| !c.unit.is_empty();
    let mut all = model.coordinates.iter().filter(coordinate);
    if let Some(c) = all.clone().find(|c| c.position == symbol) {
        return read(&c.unit);
    }
    let c = all.find(|c| c.velocity == symbol)?;
    let time = Dimension::read(model.time_unit()).filter(|_| !model.time_unit().is_empty())?;
    read(&c.unit)?.product(&time, (-1, 1))
}

/// The dimension on which all known ones agree.
fn agreed(all: impl Iterator<Item = Option<Dimension>>) -> Option<Dimension> {
    let mut known = all.flatten();
    let first = known.next()?;
    known.all(|other| other == first).then_some(first)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_read_and_written() {
        for (unit, written) in [
            ("kg m²/s", "kg m²/s"),
            ("N s", "kg m/s"),
            ("N m s", "kg m²/s"),
            ("au³/(M☉ yr²)", "au³/(M☉ yr²)"),
            ("rad/s", "1/s"),
            ("rad", "1"),
            ("kg m² rad/s", "kg m²/s"),
            ("esu statV", "g cm²/s²"),
            ("G", ""),
            ("M⊕ au³/yr²", "M⊕ au³/yr²"),
        ] {
            assert_eq!(
                Dimension::read(unit).map(|d| d.written()).as_deref(),
                Some(written),
                "{unit}"
            );
        }
        assert_eq!(Dimension::read("°"), None);
        assert_eq!(Dimension::read("m^2"), None);
    }
}
