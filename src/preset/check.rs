//! Draft → Model: names are claimed once each, expressions parsed in their scope, and numbers
//! validated.
//!
//! In: the file as written. Out: the model, unless errors prevent one; all diagnostics, with
//! byte ranges of the file. Never here: the mechanics that follow, and whether the file's claims
//! about itself are true.

mod body;
mod comparison;
mod constraint;
mod degrees;
mod equilibrium;
mod expect;
mod frame;
mod motion;
mod names;
mod observable;
mod occurrence;
mod parameters;
mod picture;
mod place;
mod poisson;
mod ramp;
mod run;
mod transformation;

use std::collections::BTreeSet;

use super::draft::{Draft, Formula, LawTable};
use crate::cancel::Cancel;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::expr::{Expr, Symbol};
use crate::model::{Allowed, Model, Scope};
use names::Names;

/// Checks a draft. Returns `None` if a model cannot even be begun. The model may be used only if no
/// diagnostic is an error.
pub(super) fn check(
    file: &str,
    draft: &Draft,
    cancel: &Cancel,
    diagnostics: &mut Diagnostics,
) -> Option<Model> {
    let mut model = check_once(file, draft, false, cancel, diagnostics)?;
    if !draft.ramps.is_empty() && !diagnostics.any_error() {
        // whatever there is to say of the file has been said
        let mut silent = Diagnostics::default();
        let named = check_once(file, draft, true, cancel, &mut silent);
        model.with_ramps_named = named.filter(|_| !silent.any_error()).map(Box::new);
    }
    Some(model)
}

/// Checks a draft, whose ramped parameters are functions of the time, or keep their names.
fn check_once(
    file: &str,
    draft: &Draft,
    keeps_ramps: bool,
    cancel: &Cancel,
    diagnostics: &mut Diagnostics,
) -> Option<Model> {
    let mut model = Model::new(&draft.info.title);
    model.pool.set_cancel(cancel.clone());
    model.info = draft.info.clone();
    let used = BTreeSet::new();
    let degrees = Vec::new();
    let mut check = ModelBuilder { file, diagnostics, model, used, keeps_ramps, degrees };
    if check.beyond_limits(draft) {
        return None;
    }
    let mut names = Names::of(draft, check.diagnostics);
    check.moving(draft);
    for written in &draft.parameters {
        check.parameter(written);
    }
    check.ramps(draft);
    check.run(&draft.run);
    check.multipliers(draft);
    check.body_names(draft.body.as_ref(), draft.attitude.as_ref());
    if let Some(comparison) = &draft.comparison {
        check.comparison(comparison);
    }
    check.new_variables(draft, &mut names);
    check.occurrences_named_once(draft);
    check.definitions(draft);
    let law = check.law(&draft.mechanics, &mut names);
    if let Some(body) = &draft.body {
        check.body(body);
    }
    check.initial_values(draft, law);
    check.constraints(&draft.constraints);
    if let Some(comparison) = &draft.comparison {
        check.compared(comparison);
    }
    if let Some(attitude) = &draft.attitude {
        check.attitude(attitude);
    }
    check.transformations(draft);
    check.equilibria(&draft.equilibria);
    check.impulses(&draft.impulses);
    check.observables(&draft.observables, &mut names);
    check.events(&draft.events);
    check.expect(&draft.expect);
    check.frames(&draft.frames);
    let mut nodes = 0;
    check.views(&draft.views, &mut nodes);
    check.model.picture.shapes = check.shapes(&draft.shapes, &mut nodes);
    check.camera(&draft.camera);
    if !check.diagnostics.any_error() {
        check.unused(draft);
    }
    law.map(|_| check.model)
}

struct ModelBuilder<'c> {
    /// The file's text, for locating a position inside an expression.
    file: &'c str,
    diagnostics: &'c mut Diagnostics,
    model: Model,
    /// Every name that some expression uses.
    used: BTreeSet<String>,
    /// Whether parameters that change with the time keep their names.
    keeps_ramps: bool,
    /// The coordinates and parameters whose unit is the degree.
    degrees: Vec<Symbol>,
}

impl ModelBuilder<'_> {
    /// Parses an expression; its errors get their range in the file.
    fn formula(&mut self, scope: &mut Scope, called: &str, formula: &Formula) -> Option<Expr> {
        if self.model.pool.is_full() {
            // already reported
            return None;
        }
        let e = scope.at(called).read(&mut self.model.pool, formula.get_ref());
        self.diagnostics.note_plain(formula.span(), scope.plain.take());
        for slip in scope.diagnostics.drain(..) {
            let place = place::within(self.file, formula, slip.span);
            let mut diagnostic = Diagnostic::error(place, slip.message);
            diagnostic.help = slip.help;
            self.diagnostics.push(diagnostic);
        }
        self.used.append(&mut scope.used);
        if let Some(e) = e {
            self.in_radians(e, formula);
        }
        e
    }

    fn error(&mut self, at: std::ops::Range<usize>, message: impl Into<String>) {
        self.diagnostics.push(Diagnostic::error(at, message));
    }

    /// Reads the definitions in order; each may use the names above it.
    fn definitions(&mut self, draft: &Draft) {
        let mut scope = Scope::new(&self.model, Allowed::Observable, "a definition");
        for (name, _) in &draft.definitions {
            scope.announce(name.get_ref());
        }
        for (name, formula) in &draft.definitions {
            let called = format!("the definition `{}`", name.get_ref());
            let read = formula.as_ref().and_then(|f| self.formula(&mut scope, &called, f));
            // one that cannot be read is replaced by its own symbol, so that its uses are not
            // reported as well
            let e = read.unwrap_or_else(|| self.model.pool.named(name.get_ref()));
            scope.define(name.get_ref(), e);
            self.model.definitions.push((name.get_ref().clone(), e));
        }
    }

    /// Whether a limit on the number of entries is exceeded; such a file is not read any further.
    fn beyond_limits(&mut self, draft: &Draft) -> bool {
        let named = |places: Vec<std::ops::Range<usize>>, most: usize, what: &str| {
            places.get(most).map(|place| {
                let message = format!("there are {} {what}; {most} are allowed", places.len());
                Diagnostic::error(place.clone(), message)
            })
        };
        let coordinates = draft.moving.all.iter().map(|c| c.name.span()).collect();
        let parameters = draft.parameters.iter().map(|p| p.name.span()).collect();
        let definitions = draft.definitions.iter().map(|(name, _)| name.span()).collect();
        let observables = draft
            .observables
            .iter()
            .filter_map(|o| o.name.as_ref().map(toml::Spanned::span))
            .collect();
        let constraints = draft.constraints.iter().map(|c| c.place.clone()).collect();
        let impulses = draft.impulses.iter().map(|i| i.place.clone()).collect();
        let times = draft.impulses.iter().flat_map(|i| i.at.iter().map(toml::Spanned::span));
        let events = draft.events.iter().map(|e| e.place.clone()).collect();
        let transformations = draft.transformations.iter().map(|t| t.place.clone()).collect();
        let generators = draft.generators.iter().map(|g| g.place.clone()).collect();
        let equilibria = draft.equilibria.iter().map(|e| e.place.clone()).collect();
        let values = draft.expect.values.iter().map(|v| v.place.clone()).collect();
        let conserved = draft.expect.conserves.iter().map(toml::Spanned::span).collect();
        let views = draft.views.iter().map(|v| v.place.clone()).collect();
        let frames = draft.frames.iter().map(|f| f.place.clone()).collect();
        let particles = draft.frames.iter().map(|f| vec![f.place.clone(); f.particles.len()]);
        let own = draft.views.iter().flat_map(|v| v.shapes.iter().flatten());
        let shapes = own.chain(&draft.shapes).map(|s| s.place.clone()).collect();
        let events_claimed = draft.expect.events.iter().map(|e| e.place.clone()).collect();
        let counts = draft.expect.counts.iter().map(|c| c.place.clone()).collect();
        let brackets_claimed = draft.expect.brackets.iter().map(|b| b.place.clone()).collect();
        let steps = draft.expect.steps.iter().map(|s| s.place.clone()).collect();
        let pieces = draft.body.iter().flat_map(|body| &body.pieces);
        let pieces = pieces.map(|piece| piece.place.clone()).collect();
        let brackets = draft.mechanics.iter().flat_map(|m| &m.brackets);
        let brackets = brackets.map(|b| b.place.clone()).collect();
        let casimirs = draft.mechanics.iter().flat_map(|m| &m.casimirs);
        let casimirs = casimirs.map(|(name, _)| name.span()).collect();
        let poisson = draft.law() == Some(LawTable::Poisson);
        let errors = [
            named(coordinates, 64, if poisson { "variables" } else { "coordinates" }),
            named(parameters, 256, "parameters"),
            named(definitions, 1024, "definitions"),
            named(observables, 1024, "observables"),
            named(constraints, 128, "constraints"),
            named(impulses, 256, "impulses"),
            named(times.collect(), 10_000, "times of impulses"),
            named(events, 256, "events"),
            named(transformations, 64, "transformations"),
            named(generators, 256, "generators"),
            named(equilibria, 256, "equilibria"),
            named(brackets, 4096, "brackets"),
            named(casimirs, 64, "casimirs"),
            named(pieces, 1024, "pieces of a body"),
            named(values, 1024, "expected values"),
            named(conserved, 1024, "conserved quantities"),
            named(events_claimed, 1024, "expected events"),
            named(counts, 1024, "expected counts"),
            named(brackets_claimed, 256, "expected brackets"),
            named(steps, 64, "expected steps"),
            named(frames, 64, "frames"),
            named(particles.flatten().collect(), 256, "particles of frames"),
            named(views, 64, "views"),
            named(shapes, 1024, "shapes"),
        ];
        let mut beyond = false;
        for diagnostic in errors.into_iter().flatten() {
            self.diagnostics.push(diagnostic);
            beyond = true;
        }
        beyond
    }

    /// Warns of unused parameters and definitions.
    fn unused(&mut self, draft: &Draft) {
        let parameters = draft.parameters.iter().map(|p| (&p.name, "parameter"));
        let definitions = draft.definitions.iter().map(|(name, _)| (name, "definition"));
        for (name, kind) in parameters.chain(definitions) {
            if !self.used.contains(name.get_ref()) {
                let message = format!("the {kind} `{}` is not used", name.get_ref());
                self.diagnostics.push(Diagnostic::unused(name.span(), message));
            }
        }
    }
}
