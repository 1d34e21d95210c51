//! The error for a name that means nothing at its place, with what was probably meant.
//!
//! In: the name, the names of the place. Out: an error with a suggestion. Never here: what names mean.

use super::allowed::{Allowed, SymbolRole};
use super::meaning::Meaning;
use super::{MOST_ERRORS, Scope, notations};
use crate::diagnostic::{nearest, with_index};
use crate::expr::{Expr, FUNCTIONS, Pool, Span, SyntaxError, plain_name};
use crate::model::{Attitude, BodyNames};

/// What is said of a velocity of something that is not a coordinate.
const VELOCITIES: &str = "only coordinates have velocities";

/// The longest rate of a definition that is written out.
const LONGEST_RATE: usize = 240;

impl Scope {
    /// The error for a name that the place does not know.
    pub(super) fn unknown(&self, name: &str, primes: usize, span: Span) -> SyntaxError {
        let error = SyntaxError::new(span, format!("unknown name `{name}`"));
        if self.diagnostics.len() >= MOST_ERRORS {
            return error;
        }
        let bare = name.strip_prefix("p_").filter(|_| self.poisson && primes == 0);
        if let Some(bare) = bare
            && let Some(Meaning::Position(_)) = self.names.get(bare)
        {
            let help = format!("variables given by their brackets have no momenta: write `{bare}`");
            return error.with_help(help);
        }
        if self.poisson && name == "action" && primes == 0 {
            return error.with_help("brackets have no Lagrangian, whose integral the action is");
        }
        let usable = |(known, meaning): (&String, &Meaning)| {
            let word = known.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_');
            let moves = primes == 0 || matches!(meaning, Meaning::Position(_) | Meaning::Other(_));
            let open = match meaning {
                Meaning::Symbol(s) => {
                    self.kinds.get(s).is_none_or(|&k| self.objection(k).is_none())
                }
                Meaning::Position(_) => self.objection(SymbolRole::Position).is_none(),
                Meaning::Other(_) => self.objection(SymbolRole::Other).is_none(),
                Meaning::Defined(_) => true,
                Meaning::Later => false,
            };
            word && moves && open
        };
        let mut known: Vec<&str> =
            self.names.iter().filter(|&entry| usable(entry)).map(|(n, _)| n.as_str()).collect();
        if primes == 0 {
            known.extend(FUNCTIONS.iter().map(|f| f.name));
            known.push("pi");
        }
        known.sort_unstable();
        if let Some(apart) = self.taken_apart(name, primes) {
            return error.with_help(format!("names side by side are written apart: `{apart}`"));
        }
        let positions = self.names.iter().filter_map(|(name, meaning)| match meaning {
            Meaning::Position([symbol, ..]) => Some((symbol, name.as_str())),
            _ => None,
        });
        let first = positions.min().map(|(_, name)| name);
        let is_position = |name: &str| matches!(self.names.get(name), Some(Meaning::Position(_)));
        let moves = self.objection(SymbolRole::Position).is_none() && primes == 0;
        let written = notations::written_here(name, first, &is_position);
        if let Some(help) = written.filter(|_| moves) {
            return error.with_help(help);
        }
        if matches!(name, "deg" | "degree" | "degrees") && primes == 0 {
            return error.with_help("angles are in radians: 30 degrees are 30*pi/180");
        }
        if let Some(table) = table_of(name).filter(|_| primes == 0) {
            let help = format!("{table} defines it; other names belong in [parameters]");
            return error.with_help(help);
        }
        if let Some(names) = with_index(name, &known).filter(|_| primes == 0) {
            return error.with_help(format!("did you mean {names}?"));
        }
        // a table takes ASCII names only
        let plain = plain_name(name).filter(|_| !name.is_ascii());
        let shown = plain.as_deref().unwrap_or("it");
        // T is an energy or a period
        let near = nearest(name, known).filter(|near| (name, *near) != ("T", "t"));
        match near {
            Some(near) => error.with_help(format!("did you mean `{near}{}`?", "'".repeat(primes))),
            None if primes > 0 && self.coordinates_are_open() => error
                .with_help(format!("{VELOCITIES}: give {shown} an initial value in [coordinates]")),
            None if primes > 0 => error.with_help(VELOCITIES),
            None if self.coordinates_are_open() && self.has_a_rate(&error) => {
                error.with_help(format!("give {shown} an initial value in [coordinates]"))
            }
            None if name.starts_with("lambda_") => error.with_help(self.multipliers()),
            None if self.allowed == Allowed::Parameters => {
                error.with_help(format!("give {shown} a value in [parameters]"))
            }
            None => {
                let help =
                    format!("give {shown} a value in [parameters], or define it in [definitions]");
                error.with_help(help)
            }
        }
    }

    /// Says of an unknown `e` directly behind a number, as in `1e`, that it begins an exponent; of errors from a place on.
    pub(super) fn name_unfinished_exponents(&mut self, text: &str, from: usize) {
        for error in self.diagnostics.iter_mut().skip(from) {
            let name = text.get(error.span.start..error.span.end).unwrap_or_default();
            if !matches!(name, "e" | "E") || error.message != format!("unknown name `{name}`") {
                continue;
            }
            let before = &text[..error.span.start];
            let number = before.trim_end_matches(|c: char| c.is_ascii_digit() || c == '.');
            let number = &before[number.len()..];
            if number.contains(|c: char| c.is_ascii_digit()) {
                error.message = format!("the exponent of `{number}{name}` has no digits");
                error.span.start -= number.len();
                error.help = Some(format!("write `{number}{name}3`, or `{number}` alone"));
            }
        }
    }

    /// Whether a name could be that of a coordinate which the file has not declared.
    fn coordinates_are_open(&self) -> bool {
        !self.poisson && self.allowed != Allowed::Parameters
    }

    /// Whether the same unknown name has a velocity elsewhere in the expression.
    fn has_a_rate(&self, error: &SyntaxError) -> bool {
        let of_velocity = |other: &SyntaxError| {
            other.help.as_ref().is_some_and(|help| help.starts_with(VELOCITIES))
        };
        self.diagnostics.iter().any(|other| other.message == error.message && of_velocity(other))
    }

    /// Suggests the multipliers that a name beginning like one could mean.
    fn multipliers(&self) -> String {
        let multiplies = |meaning: &Meaning| match meaning {
            Meaning::Symbol(s) => self.kinds.get(s) == Some(&SymbolRole::Multiplier),
            _ => false,
        };
        let known: Vec<&str> =
            self.names.iter().filter(|(_, m)| multiplies(m)).map(|(n, _)| n.as_str()).collect();
        if known.is_empty() {
            "the file has no [[constraints]], and so no multipliers".to_owned()
        } else {
            format!("the multipliers are {}", known.join(", "))
        }
    }

    /// The error for a prime after a name that is not a coordinate. The rate of a definition is given, to be written out.
    pub(super) fn without_velocity(
        &mut self,
        pool: &mut Pool,
        name: &str,
        span: Span,
    ) -> SyntaxError {
        let message = format!("`{name}` is not a coordinate and has no velocity");
        let error = SyntaxError::new(span, message);
        if let Some(&Meaning::Defined(e)) = self.names.get(name) {
            let rate = self.rate_in_letters(pool, e).map(|rate| {
                let own = Some(format!("v{name}")).filter(|own| !self.knows(own));
                let own = own.unwrap_or_else(|| format!("{name}_rate"));
                format!("write its rate out, as a definition: {own} = \"{rate}\"")
            });
            return SyntaxError { help: rate, ..error };
        }
        let moves = |m: &Meaning| matches!(m, Meaning::Position(_) | Meaning::Other(_));
        let moving = self.names.iter().filter(|(_, m)| moves(m));
        match nearest(name, moving.map(|(n, _)| n.as_str())) {
            Some(near) => error.with_help(format!("did you mean `{near}'`?")),
            None => error,
        }
    }
}

impl Scope {
    /// The rate of an expression of q, q̇ and t, if it may be used here and is not too long to be copied.
    fn rate_in_letters(&mut self, pool: &mut Pool, e: Expr) -> Option<String> {
        let mut seeds = Vec::new();
        for meaning in self.names.values() {
            if let Meaning::Position([position, velocity, acceleration]) = *meaning {
                let (rate, second) = (pool.variable(velocity), pool.variable(acceleration));
                seeds.extend([(position, rate), (velocity, second)]);
            }
        }
        let contained = pool.symbols_of(e);
        for (&symbol, role) in &self.kinds {
            let is_followed = matches!(
                role,
                SymbolRole::Position
                    | SymbolRole::Velocity
                    | SymbolRole::Acceleration
                    | SymbolRole::Inertia
            );
            if *role == SymbolRole::Time {
                seeds.push((symbol, Expr::ONE));
            } else if !is_followed && contained.contains(&symbol) {
                return None;
            }
        }
        let rate = pool.derivation(e, &seeds);
        let rate =
            if self.offender(pool, rate).is_none() { pool.ascii(rate) } else { return None };
        (rate.len() <= LONGEST_RATE).then_some(rate)
    }
}

/// The table whose presence in the file defines a name.
fn table_of(name: &str) -> Option<&'static str> {
    if BodyNames::WRITTEN.contains(&name) {
        Some("[body]")
    } else if Attitude::WRITTEN.as_flattened().contains(&name) {
        Some("[attitude]")
    } else {
        None
    }
}
