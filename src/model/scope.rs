//! Which names an expression may use, depending on its place in the file, and the error message for
//! each name that it may not use.

mod allowed;
mod meaning;
mod notation;
mod notations;
mod plain;
mod unknown_name;

use std::cell::OnceCell;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use rustc_hash::FxHashMap;

use super::{Mechanics, Model, multiplier_name};
use crate::expr::{Expr, Node, Pool, Resolve, Span, Symbol, SymbolInfo, SyntaxError, parse_all};

pub use allowed::Allowed;

use allowed::SymbolRole;
use meaning::Meaning;
use notation::ShownNames;

/// The largest depth of an expression with its definitions substituted: the 256 nested parentheses
/// allowed in a text, with a call, a sum, a product and a power in each.
const DEPTH_LIMIT: usize = 4 * 256;

/// The largest number of errors reported at one place.
const MOST_ERRORS: usize = 100;

/// The names of a model that may be used at one place, and the errors found there.
#[derive(Clone, Debug)]
pub struct Scope {
    allowed: Allowed,
    place: String,
    names: BTreeMap<String, Meaning>,
    kinds: FxHashMap<Symbol, SymbolRole>,
    offenders: FxHashMap<Expr, Option<Symbol>>,
    infos: Arc<Vec<SymbolInfo>>,
    /// The names as the screen shows them, once something is not a name of the file.
    shown: OnceCell<ShownNames>,
    /// The plain form of the last expression read, if it was written in the notation of the screen.
    pub plain: Option<String>,
    /// The number of errors found, including those that are not reported.
    error_count: usize,
    /// Whether the coordinates are variables of a Poisson system, which have no momenta.
    poisson: bool,
    /// The errors found so far; the caller takes them out to report them.
    pub diagnostics: Vec<SyntaxError>,
    /// The names used so far, so that unused ones can be reported.
    pub used: BTreeSet<String>,
}

impl Scope {
    /// The names of `model` (with its definitions) that `allowed` permits. Messages refer to the
    /// place as `place`: "the Lagrangian", "an initial value".
    pub fn new(model: &Model, allowed: Allowed, place: &str) -> Scope {
        let mut names = BTreeMap::new();
        let mut kinds = FxHashMap::default();
        let common = model.symbols;
        let mut constant = |name: &str, symbol, kind: Option<SymbolRole>| {
            names.insert(name.to_owned(), Meaning::Symbol(symbol));
            kinds.extend(kind.map(|kind| (symbol, kind)));
        };
        constant("t", common.time, Some(SymbolRole::Time));
        constant("energy", common.energy, Some(SymbolRole::Energy));
        if !model.is_poisson() {
            constant("action", common.action, Some(SymbolRole::Action));
        }
        for p in &model.parameters {
            constant(&p.name, p.symbol, None);
        }
        let constant_values = matches!(allowed, Allowed::Parameters | Allowed::Pieces);
        for symbol in model.body.iter().flat_map(|body| body.names.all()) {
            constant(&model.pool.symbol_info(symbol).name, symbol, Some(SymbolRole::Inertia));
        }
        for constraint in &model.constraints {
            let name = multiplier_name(&constraint.name);
            constant(&name, constraint.multiplier, Some(SymbolRole::Multiplier));
        }
        for symbol in model.attitude.iter().flat_map(|a| a.matrix.concat()) {
            constant(&model.pool.symbol_info(symbol).name, symbol, Some(SymbolRole::Attitude));
        }
        if !model.is_poisson() {
            for c in &model.coordinates {
                constant(&format!("p_{}", c.name), c.momentum, Some(SymbolRole::Momentum));
            }
        }
        for c in &model.coordinates {
            let symbols = [c.position, c.velocity, c.acceleration];
            names.insert(c.name.clone(), Meaning::Position(symbols));
            let rates = [SymbolRole::Position, SymbolRole::Velocity, SymbolRole::Acceleration];
            kinds.extend(symbols.into_iter().zip(rates));
        }
        for (name, symbol) in model.new_variables() {
            names.insert(name, Meaning::Symbol(symbol));
            kinds.insert(symbol, SymbolRole::New);
        }
        for &(position, velocity) in model.comparison.iter().flat_map(|c| &c.symbols) {
            let name = model.pool.symbol_info(position).name.clone();
            names.insert(name, Meaning::Other([position, velocity]));
            kinds.extend([(position, SymbolRole::Other), (velocity, SymbolRole::Other)]);
        }
        for (name, e) in &model.definitions {
            names.insert(name.clone(), Meaning::Defined(*e));
        }
        for (symbol, e) in model.ramped.functions().filter(|_| !constant_values) {
            names.insert(model.pool.symbol_info(symbol).name.clone(), Meaning::Defined(e));
        }
        if let Mechanics::Poisson { casimirs, .. } = &model.mechanics {
            for (name, e, _) in casimirs {
                names.entry(name.clone()).or_insert(Meaning::Defined(*e));
            }
        }
        for o in &model.observables {
            names.entry(o.name.clone()).or_insert(Meaning::Defined(o.expression));
        }
        Scope {
            infos: model.pool.symbol_infos(),
            shown: OnceCell::new(),
            plain: None,
            allowed,
            place: place.to_owned(),
            names,
            kinds,
            offenders: FxHashMap::default(),
            error_count: 0,
            poisson: model.is_poisson(),
            diagnostics: Vec::new(),
            used: BTreeSet::new(),
        }
    }

    /// Changes how messages refer to the place of use.
    pub fn at(&mut self, place: &str) -> &mut Scope {
        place.clone_into(&mut self.place);
        self
    }

    /// Adds a name for an expression (a definition, an earlier observable, the parameter of a
    /// path).
    pub fn define(&mut self, name: &str, e: Expr) {
        if self.names.insert(name.to_owned(), Meaning::Defined(e)).is_none() {
            self.shown.take();
        }
    }

    /// Allows a symbol wherever it stands.
    pub fn admit(&mut self, symbol: Symbol) {
        self.kinds.remove(&symbol);
    }

    /// Adds a name that is defined further down. Until [`Scope::define`] gives it a meaning, its
    /// use is reported as an error of its own kind.
    pub fn announce(&mut self, name: &str) {
        self.shown.take();
        self.names.entry(name.to_owned()).or_insert(Meaning::Later);
    }

    /// The names as the screen shows them.
    fn shown(&self) -> &ShownNames {
        self.shown.get_or_init(|| ShownNames::of(&self.infos, &self.names))
    }

    /// Returns whether a name is known here, whether or not it may be used.
    pub fn knows(&self, name: &str) -> bool {
        self.names.contains_key(name)
    }

    /// Reads an expression in this scope. Returns `None` if there were errors, which are then in
    /// [`Scope::diagnostics`].
    pub fn read(&mut self, pool: &mut Pool, text: &str) -> Option<Expr> {
        let (before, reported) = (self.error_count, self.diagnostics.len());
        self.plain = None;
        let (syntax, diagnostics) = parse_all(text);
        for diagnostic in diagnostics {
            self.complain(diagnostic);
        }
        let syntax = syntax?;
        let e = syntax.lower(pool, self);
        self.name_unfinished_exponents(text, reported);
        if self.error_count == before {
            self.check_result(pool, e, syntax.span);
        }
        if self.error_count > before {
            self.add_corrected_line(text, reported);
            return None;
        }
        self.plain = self.plain_form(text, &syntax);
        Some(e)
    }

    /// Checks that no constant is infinite and that no limit is exceeded.
    fn check_result(&mut self, pool: &Pool, e: Expr, span: Span) {
        if pool.is_full() {
            let message = "with this, the file's expressions grow beyond a million nodes";
            return self.complain(SyntaxError::new(span, message));
        }
        if pool.depth(e) > DEPTH_LIMIT {
            let message =
                format!("with its definitions opened, this is nested deeper than {DEPTH_LIMIT}");
            return self.complain(SyntaxError::new(span, message));
        }
        if pool.reachable(&[e]).into_iter().any(|part| holds_infinity(pool.node(part))) {
            let message = "this divides by zero, has the root of a negative number, or holds a number beyond all range";
            self.complain(SyntaxError::new(span, message));
        }
    }

    /// Why a kind of symbol may not be used here, or `None` if it may.
    fn objection(&self, kind: SymbolRole) -> Option<String> {
        self.allowed.objection(kind, &self.place)
    }

    /// The first symbol in an expression that may not be used here.
    fn offender(&mut self, pool: &Pool, e: Expr) -> Option<(Symbol, String)> {
        if self.allowed == Allowed::Observable {
            return None;
        }
        let kind = |s: &Symbol| self.kinds.get(s).copied();
        let found = match self.offenders.get(&e) {
            Some(&known) => known,
            None => pool
                .symbols_of(e)
                .into_iter()
                .find(|s| kind(s).is_some_and(|k| self.objection(k).is_some())),
        };
        self.offenders.insert(e, found);
        let symbol = found?;
        self.kinds.get(&symbol).and_then(|&k| self.objection(k)).map(|why| (symbol, why))
    }

    fn meaning(
        &mut self,
        pool: &mut Pool,
        name: &str,
        primes: usize,
        span: Span,
    ) -> Result<Expr, SyntaxError> {
        let (name, primes) = &self.plain_name(name, primes, span)?;
        let (name, primes) = (name.as_str(), *primes);
        let Some(&meaning) = self.names.get(name) else {
            return Err(self.unknown(name, primes, span));
        };
        let e = match meaning {
            Meaning::Position(symbols) => match symbols.get(primes) {
                Some(&symbol) => pool.variable(symbol),
                None => {
                    return Err(SyntaxError::new(span, "there is no name for a third derivative"));
                }
            },
            Meaning::Other(symbols) => match symbols.get(primes) {
                Some(&symbol) => pool.variable(symbol),
                None => {
                    let message = format!("the other motion has no name for `{name}''`");
                    return Err(SyntaxError::new(span, message));
                }
            },
            _ if primes > 0 => return Err(self.without_velocity(pool, name, span)),
            Meaning::Symbol(symbol) => pool.variable(symbol),
            Meaning::Defined(e) => e,
            Meaning::Later => {
                let message = format!("`{name}` is not defined yet at this place");
                return Err(SyntaxError::new(span, message)
                    .with_help("only what is defined above may be used"));
            }
        };
        if let Some((symbol, why)) = self.offender(pool, e) {
            let shown = format!("{name}{}", "'".repeat(primes));
            let used = &pool.symbol_info(symbol).name;
            let message = if matches!(meaning, Meaning::Defined(_)) {
                format!("`{shown}` may not be used here: it uses `{used}`, and {why}")
            } else {
                format!("`{shown}` may not be used here: {why}")
            };
            let error = SyntaxError::new(span, message);
            return Err(match (self.allowed, self.kinds.get(&symbol)) {
                (Allowed::Lagrangian, Some(SymbolRole::Momentum)) => {
                    error.with_help("write it in velocities, or give the law in [hamiltonian]")
                }
                (Allowed::Hamiltonian, Some(SymbolRole::Velocity)) => {
                    error.with_help("write it in momenta, or give the law in [lagrangian]")
                }
                (_, Some(SymbolRole::Multiplier)) => {
                    error.with_help("what a constraint needs follows from the law of motion")
                }
                _ => error,
            });
        }
        self.used.insert(name.to_owned());
        Ok(e)
    }
}

/// Returns whether a constant of a node is infinite or NaN.
fn holds_infinity(node: &Node) -> bool {
    match node {
        Node::Number(n) => !n.is_finite(),
        Node::Sum(constant, terms) => {
            !constant.is_finite() || terms.iter().any(|(c, _)| !c.is_finite())
        }
        Node::Product(coefficient, factors) => {
            !coefficient.is_finite() || factors.iter().any(|(_, n)| !n.is_finite())
        }
        Node::Pi | Node::Symbol(_) | Node::Power(..) | Node::Call(..) => false,
    }
}

impl Resolve for Scope {
    fn name(&mut self, pool: &mut Pool, name: &str, primes: usize, span: Span) -> Option<Expr> {
        match self.meaning(pool, name, primes, span) {
            Ok(e) => Some(e),
            Err(diagnostic) => {
                self.complain(diagnostic);
                None
            }
        }
    }

    fn is_variable(&self, name: &str) -> bool {
        self.knows(name) || self.shown().has(name)
    }

    fn is_constant(&self, name: &str) -> bool {
        let Ok((name, 0)) = self.plain_name(name, 0, Span::default()) else { return false };
        match self.names.get(&name) {
            Some(Meaning::Symbol(symbol)) => {
                self.kinds.get(symbol).is_none_or(|k| *k == SymbolRole::Inertia)
            }
            _ => false,
        }
    }

    fn complain(&mut self, error: SyntaxError) {
        self.error_count += 1;
        if self.diagnostics.len() < MOST_ERRORS {
            self.diagnostics.push(error);
        }
    }
}
