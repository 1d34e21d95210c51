//! Transformations, generators and the complete integral: their names, then their laws.
//!
//! New variables are introduced before any expression is read, so that all that come later know
//! them. Whether a transformation is canonical is not asked here.

use toml::Spanned;

use super::ModelBuilder;
use super::names::{Names, report_twice};
use crate::diagnostic::{Diagnostic, SourceRange, nearest};
use crate::expr::{Expr, Rank, Symbol};
use crate::model::{
    Allowed, CompleteIntegral, GeneratingType, Generator, IntegralConstant, Model, Scope,
    Transformation, TransformationLaw,
};
use crate::preset::draft::{Draft, DraftTransformation, Formula, NamedFormula};

impl ModelBuilder<'_> {
    /// Introduces the new variables and the constants of the complete integral.
    pub(super) fn new_variables(&mut self, draft: &Draft, names: &mut Names) {
        let poisson = self.model.is_poisson();
        let places = draft.transformations.iter().map(|t| t.place.clone());
        let places = places.chain(draft.generators.iter().map(|g| g.place.clone()));
        for place in places.filter(|_| poisson) {
            let message = "brackets of variables have no canonical coordinates to transform";
            self.error(place, message);
        }
        if poisson {
            if let Some(integral) = &draft.integral {
                let message = "brackets of variables have no Hamilton–Jacobi equation";
                self.error(integral.place.clone(), message);
            }
            return;
        }
        let mut taken: Vec<&Spanned<String>> = Vec::new();
        for written in &draft.transformations {
            if let Some(name) = &written.name {
                let first = taken.iter().find(|first| first.get_ref() == name.get_ref());
                if let Some(first) = first {
                    report_twice(name, first.span(), "a transformation", self.diagnostics);
                }
                taken.push(name);
            }
            let new = self.variables_of(written, names);
            let name = written.name.as_ref().map_or("", |name| name.get_ref()).to_owned();
            let law = TransformationLaw::Explicit { positions: Vec::new(), momenta: Vec::new() };
            let place = written.place.clone();
            let residual = self.residual_of(written, names);
            self.model.transformations.push(Transformation { name, law, new, residual, place });
        }
        if let Some(written) = &draft.integral {
            let mut constants = Vec::new();
            for name in &written.constants {
                const KIND: &str = "a constant of the complete integral";
                let beta = Spanned::new(name.span(), format!("beta_{}", name.get_ref()));
                if names.word(name, KIND, self.diagnostics)
                    && names.word(&beta, "what is conjugate to a constant", self.diagnostics)
                {
                    let symbol = self.introduce(name.get_ref(), Rank::Constant);
                    let conjugate = self.introduce(beta.get_ref(), Rank::Constant);
                    let name = name.get_ref().clone();
                    constants.push(IntegralConstant { name, symbol, conjugate });
                }
            }
            let (function, place) = (Expr::ZERO, 0..0);
            self.model.complete_integral = Some(CompleteIntegral { function, constants, place });
        }
    }

    /// The name of what an explicit transformation lacks of being canonical.
    fn residual_of(&mut self, written: &DraftTransformation, names: &mut Names) -> Option<Symbol> {
        let name = written.residual.as_ref()?;
        if written.positions.is_none() && written.momenta.is_none() {
            let message = "`residual` is that of an explicit transformation";
            let made = matches!(
                written.kind.as_ref().map(|kind| kind.get_ref().as_str()),
                Some("compose" | "inverse")
            );
            let help = if made {
                "give it to the transformations that this one is made of"
            } else {
                "a generating function gives a canonical one: `derive` prints what rounding leaves of it"
            };
            self.diagnostics.push(Diagnostic::error(name.span(), message).with_help(help));
            return None;
        }
        let known =
            names.word(name, "what a transformation lacks of being canonical", self.diagnostics);
        known.then(|| self.introduce(name.get_ref(), Rank::Constant))
    }

    /// The new variables of a transformation: Q and P of each pair.
    fn variables_of(
        &mut self,
        written: &DraftTransformation,
        names: &mut Names,
    ) -> Vec<[Symbol; 2]> {
        let n = self.model.coordinates.len();
        let place = written.name.as_ref().map_or_else(|| written.place.clone(), Spanned::span);
        let own = |formulas: &Option<Vec<NamedFormula>>| -> Vec<Spanned<String>> {
            formulas.iter().flatten().map(|(name, _)| name.clone()).collect()
        };
        let (positions, momenta) = (own(&written.positions), own(&written.momenta));
        let all: Vec<Spanned<String>> = if !written.new.is_empty() {
            written.new.clone()
        } else if positions.len() == n && momenta.len() == n {
            [positions, momenta].concat()
        } else {
            let numbered = |letter: &str| -> Vec<Spanned<String>> {
                let name = |i: usize| {
                    if n == 1 { letter.to_owned() } else { format!("{letter}{}", i + 1) }
                };
                (0..n).map(|i| Spanned::new(place.clone(), name(i))).collect()
            };
            [numbered("Q"), numbered("P")].concat()
        };
        if all.len() != 2 * n {
            let message = format!("`new` names {} variables where there are {}", all.len(), 2 * n);
            let help = "name every new coordinate, then every new momentum";
            let place = written.new.first().map_or(place, Spanned::span);
            self.diagnostics.push(Diagnostic::error(place, message).with_help(help));
        }
        let mut symbols = Vec::new();
        for (k, name) in all.iter().enumerate() {
            if all[..k].iter().any(|before| before.get_ref() == name.get_ref()) {
                let message = format!("two new variables would be called `{}`", name.get_ref());
                self.error(name.span(), message);
            }
            symbols.push(if names.new_variable(name, self.diagnostics) {
                self.introduce(name.get_ref(), Rank::Momentum)
            } else {
                // what has the name already keeps it
                self.model.pool.symbol(&format!("new {}", name.get_ref()))
            });
        }
        symbols.resize(2 * n, self.model.symbols.time);
        (0..n).map(|i| [symbols[i], symbols[n + i]]).collect()
    }

    /// Reads the laws of the transformations, the generators and the complete integral.
    pub(super) fn transformations(&mut self, draft: &Draft) {
        if self.model.is_poisson() {
            return;
        }
        for (k, written) in draft.transformations.iter().enumerate() {
            if let Some(law) = self.transformation(written, k) {
                let place = written.function.as_ref().map_or(written.place.clone(), Spanned::span);
                self.model.transformations[k].place = place;
                self.model.transformations[k].law = law;
            }
        }
        let mut scope = Scope::new(&self.model, Allowed::Bracket, "a generator");
        let mut taken: Vec<&Spanned<String>> = Vec::new();
        for written in &draft.generators {
            let formula = written.function.as_ref();
            let e = formula.and_then(|f| self.formula(&mut scope, "a generator", f));
            let Some(name) = &written.name else { continue };
            if let Some(first) = taken.iter().find(|first| first.get_ref() == name.get_ref()) {
                report_twice(name, first.span(), "a generator", self.diagnostics);
            }
            taken.push(name);
            if let Some(expression) = e {
                self.model.generators.push(Generator { name: name.get_ref().clone(), expression });
            }
        }
        let Some(written) = &draft.integral else { return };
        let called = "the complete integral";
        let mut scope = Scope::new(&self.model, Allowed::Configuration, called);
        let constants = self.model.complete_integral.as_ref().map(|s| s.constants.clone());
        for IntegralConstant { name, symbol, .. } in constants.into_iter().flatten() {
            let e = self.model.pool.variable(symbol);
            scope.define(&name, e);
            scope.admit(symbol);
        }
        let read = written.function.as_ref().and_then(|f| self.formula(&mut scope, called, f));
        if let (Some(e), Some(integral)) = (read, &mut self.model.complete_integral) {
            integral.function = e;
            integral.place = written.function.as_ref().map_or(0..0, Spanned::span);
        }
    }

    fn transformation(
        &mut self,
        written: &DraftTransformation,
        k: usize,
    ) -> Option<TransformationLaw> {
        let n = self.model.coordinates.len();
        let new = self.model.transformations[k].new.clone();
        let mut scope = Scope::new(&self.model, Allowed::Transformation, "a transformation");
        for symbol in new.concat() {
            let name = self.model.pool.symbol_info(symbol).name.clone();
            let e = self.model.pool.variable(symbol);
            scope.define(&name, e);
        }
        let kind = written.kind.as_ref().map(|kind| kind.get_ref().as_str());
        let given = written.positions.is_some() || written.momenta.is_some();
        if kind == Some("explicit") || (kind.is_none() && given) {
            if let Some(function) = &written.function {
                self.error(
                    function.span(),
                    "an explicit transformation has no generating function",
                );
            }
            let positions = self.explicit(written, &mut scope, &new, 0)?;
            let momenta = self.explicit(written, &mut scope, &new, 1)?;
            return Some(TransformationLaw::Explicit { positions, momenta });
        }
        if let Some(made @ ("inverse" | "compose")) = kind {
            return self.made_of_others(written, k, made == "inverse");
        }
        if let Some(of) = written.of.first() {
            self.error(of.span(), "`of` belongs to kind = \"inverse\" and kind = \"compose\"");
            return None;
        }
        let types = self.types(written, n)?;
        if given {
            let message = "a transformation by a generating function has no `Q` and `P` of its own";
            self.diagnostics.push(
                Diagnostic::error(written.place.clone(), message)
                    .with_help("write kind = \"explicit\", or leave them out"),
            );
        }
        let Some(formula) = &written.function else {
            let message = "this transformation has no `F`";
            let help = "write F = \"...\", or kind = \"explicit\" with Q = { ... } and P = { ... }";
            self.diagnostics
                .push(Diagnostic::error(written.place.clone(), message).with_help(help));
            return None;
        };
        let function = self.formula(&mut scope, "a generating function", formula)?;
        let is_its_own = self.has_its_variables(function, &types, &new, formula)
            && self.has_no_others(function, k, formula);
        is_its_own.then_some(TransformationLaw::Generating { types, function })
    }

    /// The inverse of a transformation, or several one after the other: of those that stand above.
    fn made_of_others(
        &mut self,
        written: &DraftTransformation,
        k: usize,
        inverse: bool,
    ) -> Option<TransformationLaw> {
        let kind = if inverse { "inverse" } else { "compose" };
        if let Some(function) = &written.function {
            self.error(
                function.span(),
                "a transformation made of others has no generating function",
            );
        }
        if written.positions.is_some() || written.momenta.is_some() {
            let message = "a transformation made of others has no `Q` and `P` of its own";
            self.error(written.place.clone(), message);
        }
        let of = &written.of;
        let right = if inverse { of.len() == 1 } else { of.len() >= 2 };
        if !right {
            let place = of.first().map_or(written.place.clone(), Spanned::span);
            let message = format!(
                "`{kind}` needs {}",
                if inverse { "one other transformation" } else { "two or more others" }
            );
            let help = if inverse {
                "write of = [\"name\"], a transformation above this one"
            } else {
                "write of = [\"first\", \"second\"], transformations above this one, the first to act first"
            };
            self.diagnostics.push(Diagnostic::error(place, message).with_help(help));
            return None;
        }
        let mut found = Vec::new();
        for name in of {
            let above = &self.model.transformations[..k];
            match above.iter().position(|t| t.name == *name.get_ref()) {
                Some(i) => found.push(i),
                None => {
                    let names: Vec<&str> = above.iter().map(|t| t.name.as_str()).collect();
                    let message = format!(
                        "unknown transformation `{}`: only those above this one can be used",
                        name.get_ref()
                    );
                    let help = match nearest(name.get_ref(), names.iter().copied()) {
                        Some(near) => format!("did you mean `{near}`?"),
                        None if names.is_empty() => "there is none above".to_owned(),
                        None => format!("there are {}", names.join(", ")),
                    };
                    self.diagnostics.push(Diagnostic::error(name.span(), message).with_help(help));
                }
            }
        }
        let complete = found.len() == written.of.len();
        complete.then(|| match found[..] {
            [one] if inverse => TransformationLaw::Inverse(one),
            _ => TransformationLaw::Composition(found),
        })
    }

    /// The type of the generating function for each pair.
    fn types(&mut self, written: &DraftTransformation, n: usize) -> Option<Vec<GeneratingType>> {
        let known = || GeneratingType::ALL.map(GeneratingType::name);
        let read = |name: &Spanned<String>, others: &[&str]| {
            let found = GeneratingType::by_name(name.get_ref());
            if found.is_none() {
                let message = format!("unknown kind `{}` of transformation", name.get_ref());
                let all = known().into_iter().chain(others.iter().copied()).collect::<Vec<_>>();
                let help = match nearest(name.get_ref(), all.iter().copied()) {
                    Some(near) => format!("did you mean `{near}`?"),
                    None => format!("there are {}", all.join(", ")),
                };
                self.diagnostics.push(Diagnostic::error(name.span(), message).with_help(help));
            }
            found
        };
        let mixed = written.kind.as_ref().filter(|kind| kind.get_ref() == "mixed");
        if !written.types.is_empty() || mixed.is_some() {
            let types: Vec<_> = written.types.iter().map(|name| read(name, &[])).collect();
            if types.len() != n {
                let message = format!("`types` has {} entries for {n} pairs", types.len());
                let place = written.types.first().map_or(written.place.clone(), Spanned::span);
                let help = "write one of F1, F2, F3, F4 for each coordinate";
                self.diagnostics.push(Diagnostic::error(place, message).with_help(help));
                return None;
            }
            if let (Some(kind), None) = (&written.kind, mixed) {
                self.error(kind.span(), "`types` says the kind of each pair, and `kind` another");
                return None;
            }
            return types.into_iter().collect();
        }
        let Some(kind) = &written.kind else {
            let message = "this transformation has no `kind`";
            let help = "write kind = \"F1\", \"F2\", \"F3\", \"F4\", \"explicit\", \"inverse\" or \"compose\"";
            self.diagnostics
                .push(Diagnostic::error(written.place.clone(), message).with_help(help));
            return None;
        };
        read(kind, &["explicit", "mixed", "inverse", "compose"]).map(|kind| vec![kind; n])
    }

    /// Reads one half of an explicit transformation in the order of its new variables.
    fn explicit(
        &mut self,
        written: &DraftTransformation,
        scope: &mut Scope,
        new: &[[Symbol; 2]],
        half: usize,
    ) -> Option<Vec<Expr>> {
        let (table, letter) =
            if half == 0 { (&written.positions, "Q") } else { (&written.momenta, "P") };
        let symbols = new.concat();
        let Some(table) = table else {
            let message = format!("this transformation has no `{letter}`");
            let help = format!("write {letter} = {{ {letter} = \"...\" }}");
            self.diagnostics
                .push(Diagnostic::error(written.place.clone(), message).with_help(help));
            return None;
        };
        let mut found: Vec<Option<Expr>> = vec![None; new.len()];
        let wanted: Vec<String> =
            new.iter().map(|pair| self.model.pool.symbol_info(pair[half]).name.clone()).collect();
        for (name, formula) in table {
            let e = formula.as_ref().and_then(|f| self.formula(scope, "a new variable", f));
            match wanted.iter().position(|w| w == name.get_ref()) {
                Some(i) => found[i] = e,
                None => {
                    let message = format!("`{}` is not a new variable here", name.get_ref());
                    let help = format!("the variables are {}", wanted.join(", "));
                    self.diagnostics.push(Diagnostic::error(name.span(), message).with_help(help));
                    return None;
                }
            }
            if let (Some(e), Some(f)) = (e, formula)
                && self.model.pool.depends_on_any(e, &symbols)
            {
                self.error(f.span(), "an explicit transformation is a function of q, p and t");
                return None;
            }
        }
        for (name, _) in wanted.iter().zip(&found).filter(|(_, e)| e.is_none()) {
            if !table.iter().any(|(written, _)| written.get_ref() == name) {
                let message = format!("the transformation does not define `{name}`");
                self.error(written.place.clone(), message);
            }
        }
        found.into_iter().collect()
    }

    /// Whether a generating function has no new variables of other transformations, which are functions of q, p and t.
    fn has_no_others(&mut self, function: Expr, k: usize, formula: &Formula) -> bool {
        let Model { pool, transformations, .. } = &self.model;
        let own = transformations[k].new.concat();
        let name = |symbol: Symbol| format!("`{}`", pool.symbol_info(symbol).name);
        let others =
            transformations.iter().flat_map(|t| t.new.iter().flatten().map(move |s| (t, *s)));
        let wrong =
            others.filter(|(_, s)| !own.contains(s)).find(|(_, s)| pool.depends(function, *s));
        let Some((other, symbol)) = wrong else { return true };
        let message = format!(
            "this generating function may not depend on {}, a new variable of `{}`",
            name(symbol),
            other.name
        );
        let own: Vec<String> = own.into_iter().map(name).collect();
        let help = format!("its own new variables are {}", own.join(", "));
        self.diagnostics.push(Diagnostic::error(place_of(formula), message).with_help(help));
        false
    }

    /// Whether a generating function depends on the variables of its types only.
    fn has_its_variables(
        &mut self,
        function: Expr,
        types: &[GeneratingType],
        new: &[[Symbol; 2]],
        formula: &Formula,
    ) -> bool {
        let mut wrong: Option<(Symbol, String)> = None;
        for ((c, of), [position, momentum]) in self.model.coordinates.iter().zip(types).zip(new) {
            let old = if of.has_position() { c.momentum } else { c.position };
            let other = if of.has_new_position() { *momentum } else { *position };
            let right = [
                if of.has_position() { c.position } else { c.momentum },
                if of.has_new_position() { *position } else { *momentum },
            ];
            for symbol in [old, other] {
                if wrong.is_none() && self.model.pool.depends(function, symbol) {
                    let names = right.map(|s| self.model.pool.symbol_info(s).name.clone());
                    wrong = Some((
                        symbol,
                        format!("{} is a function of {} and {}", of.name(), names[0], names[1]),
                    ));
                }
            }
        }
        let Some((symbol, help)) = wrong else { return true };
        let name = &self.model.pool.symbol_info(symbol).name;
        let message = format!("this generating function may not depend on `{name}`");
        self.diagnostics.push(Diagnostic::error(place_of(formula), message).with_help(help));
        false
    }
}

fn place_of(formula: &Formula) -> SourceRange {
    formula.span()
}
