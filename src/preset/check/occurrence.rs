//! Impulses and events: what they name must exist, and they depend on the state before them.

use toml::Spanned;

use super::ModelBuilder;
use super::names::report_twice;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::nearest;
use crate::expr::{Expr, keeps_its_sign};
use crate::model::{Allowed, Direction, EventAction, Impulse, Mechanics, MotionEvent, Scope};
use crate::preset::draft::{Draft, DraftEvent, DraftImpulse, Formula};
use crate::printable::number;

/// The actions of an event, as listed in messages.
const ACTIONS: &str = "`mark`, `stop`, `release:CONSTRAINT` or `impulse:IMPULSE`";

impl ModelBuilder<'_> {
    /// Impulses and events share one namespace, because occurrences are reported by name.
    pub(super) fn occurrences_named_once(&mut self, draft: &Draft) {
        let impulses = draft.impulses.iter().filter_map(|i| i.name.as_ref());
        let events = draft.events.iter().filter_map(|e| e.name.as_ref());
        let all = impulses.map(|n| (n, "an impulse")).chain(events.map(|n| (n, "an event")));
        let mut before: Vec<(&Spanned<String>, &str)> = Vec::new();
        for (name, kind) in all {
            match before.iter().find(|(known, _)| known.get_ref() == name.get_ref()) {
                Some((first, what)) => {
                    report_twice(name, first.span(), what, self.diagnostics);
                }
                None => before.push((name, kind)),
            }
        }
    }

    pub(super) fn impulses(&mut self, written: &[DraftImpulse]) {
        let mut times = Scope::new(&self.model, Allowed::Parameters, "the time of an impulse");
        let allowed = match self.model.mechanics {
            Mechanics::Lagrangian { .. } => Allowed::Lagrangian,
            Mechanics::Hamiltonian { .. } => Allowed::Hamiltonian,
            Mechanics::Poisson { .. } => Allowed::Poisson,
        };
        let mut scope = Scope::new(&self.model, allowed, "an impulse");
        for impulse in written {
            let name = impulse.name.as_ref().map_or(String::new(), |n| n.get_ref().clone());
            let called = format!("the impulse `{name}`");
            let mut given: Vec<(Expr, &Formula)> = Vec::new();
            for formula in &impulse.at {
                if let Some(e) = self.time(formula, &mut times) {
                    self.time_given_once(&given, e, formula);
                    given.push((e, formula));
                }
            }
            let at = given.into_iter().map(|(e, _)| e).collect::<Vec<_>>();
            let period = impulse.every.as_ref().and_then(|f| self.interval(f, &mut times));
            let mut change = vec![Expr::ZERO; self.model.coordinates.len()];
            for (name, formula) in impulse.change.iter().flatten() {
                let formula = formula.as_ref();
                let jump = formula.and_then(|f| self.formula(&mut scope, &called, f));
                match self.after_impulse(name.get_ref()) {
                    Some(index) => change[index] = jump.unwrap_or(Expr::ZERO),
                    None => self.diagnostics.push(self.unknown_momentum(name)),
                }
            }
            let mut scheduled = at.iter().chain(&period);
            if scheduled.any(|&e| self.model.ramped.acts_on(&self.model.pool, e)) {
                let message = "the times of an impulse cannot follow a ramp";
                self.error(impulse.place.clone(), message);
            }
            self.model.impulses.push(Impulse {
                name,
                times: at,
                period,
                change,
                about: impulse.about.clone(),
            });
        }
    }

    /// Reads the time at which an impulse is applied.
    fn time(&mut self, formula: &Formula, scope: &mut Scope) -> Option<Expr> {
        let e = self.formula(scope, "the time of an impulse", formula)?;
        if !self.finite(e, "the time of this impulse", formula) {
            return None;
        }
        let (at, start) = (self.at_start(e), self.model.run.start);
        if at <= start {
            let place = if at < start { "before the start" } else { "the start itself" };
            let start = number(start);
            let message = format!("this is {place}, t = {start}; it does not act");
            self.diagnostics.push(Diagnostic::warning(formula.span(), message));
        }
        Some(e)
    }

    /// An impulse acts once at a time: one that is given twice is an error, and a warning where it is at these values only.
    fn time_given_once(&mut self, before: &[(Expr, &Formula)], e: Expr, formula: &Formula) {
        let at = self.at_start(e);
        let Some((other, first)) = before.iter().find(|(other, _)| self.at_start(*other) == at)
        else {
            return;
        };
        let place = formula.span();
        let diagnostic = if *other == e {
            Diagnostic::error(place, "this time is given twice")
        } else {
            let message = format!("at these values this is the same time, t = {}", number(at));
            Diagnostic::warning(place, message)
        };
        let help = "an impulse acts once at a time; two impulses act there one after the other";
        let diagnostic = diagnostic.with_help(help);
        self.diagnostics.push(diagnostic.with_also(first.span(), "it is given here"));
    }

    /// Reads the period at which an impulse is repeated.
    fn interval(&mut self, formula: &Formula, scope: &mut Scope) -> Option<Expr> {
        let e = self.formula(scope, "the interval of an impulse", formula)?;
        if !self.finite(e, "the interval of this impulse", formula) {
            return None;
        }
        let interval = self.at_start(e);
        if interval <= 0.0 {
            let message = format!("`every` is an interval and must be positive, not {interval}");
            self.error(formula.span(), message);
            return None;
        }
        Some(e)
    }

    /// The index of the coordinate whose momentum a key of `change` names, or of the variable that it names.
    fn after_impulse(&self, name: &str) -> Option<usize> {
        let bare = if self.model.is_poisson() { name } else { name.strip_prefix("p_")? };
        self.model.coordinate(bare)
    }

    fn unknown_momentum(&self, name: &Spanned<String>) -> Diagnostic {
        let poisson = self.model.is_poisson();
        let message = if poisson {
            format!("unknown variable `{}`", name.get_ref())
        } else {
            format!("unknown momentum `{}`", name.get_ref())
        };
        let prefix = if poisson { "" } else { "p_" };
        let coordinates = self.model.coordinates.iter();
        let known: Vec<String> = coordinates.map(|c| format!("{prefix}{}", c.name)).collect();
        let bare = name.get_ref().trim_end_matches('\'');
        let meant = format!("{prefix}{}", bare.strip_prefix("p_").unwrap_or(bare));
        let near = nearest(&meant, known.iter().map(String::as_str));
        Diagnostic::error(name.span(), message).with_help(match near {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("an impulse may change {}", known.join(", ")),
        })
    }

    pub(super) fn events(&mut self, written: &[DraftEvent]) {
        let mut scope = Scope::new(&self.model, Allowed::Event, "an event");
        for event in written {
            let name = event.name.as_ref().map_or(String::new(), |n| n.get_ref().clone());
            let called = format!("the event `{name}`");
            let when = event.when.as_ref().and_then(|formula| {
                let e = self.formula(&mut scope, &called, formula)?;
                self.changes(e, formula).then_some(e)
            });
            let direction = event.direction.as_ref().map_or(Direction::Either, |d| self.sense(d));
            let action = event.action.as_ref().and_then(|a| self.action(a));
            self.model.events.push(MotionEvent {
                name,
                when: when.unwrap_or(Expr::ZERO),
                direction,
                action: action.unwrap_or(EventAction::Mark),
                place: Some(event.when.as_ref().map_or(event.place.clone(), Spanned::span)),
            });
        }
    }

    /// Whether an event can ever happen, as far as its symbols show.
    pub(super) fn changes(&mut self, e: Expr, formula: &Formula) -> bool {
        let constant = |s| {
            let body = self.model.body.as_ref();
            self.model.parameters.iter().any(|p| p.symbol == s)
                || body.is_some_and(|body| body.names.all().contains(&s))
        };
        let moves = !self.model.pool.symbols_of(e).into_iter().all(constant);
        if !moves {
            let diagnostic = Diagnostic::error(formula.span(), "this does not change in time");
            let help = "an event happens where its expression crosses zero";
            self.diagnostics.push(diagnostic.with_help(help));
        } else if keeps_its_sign(&mut self.model.pool, e) {
            let message =
                "this never changes sign, it touches zero at most: the event never happens";
            let help = "an event is where the expression crosses zero: write x - 2 in place of abs(x - 2) or (x - 2)^2";
            self.diagnostics.push(Diagnostic::warning(formula.span(), message).with_help(help));
        }
        moves
    }

    pub(super) fn sense(&mut self, written: &Spanned<String>) -> Direction {
        let word = written.get_ref().as_str();
        let known = Direction::ALL.into_iter().find(|direction| direction.word() == word);
        known.unwrap_or_else(|| {
            let help = match nearest(word, Direction::ALL.map(Direction::word)) {
                Some(near) => format!("did you mean `{near}`?"),
                None => "a direction is `rising`, `falling` or `either`".to_owned(),
            };
            let message = format!("unknown direction `{word}`");
            self.diagnostics.push(Diagnostic::error(written.span(), message).with_help(help));
            Direction::Either
        })
    }

    fn action(&mut self, written: &Spanned<String>) -> Option<EventAction> {
        let text = written.get_ref().trim();
        let (verb, object) = match text.split_once(':') {
            Some((verb, object)) => (verb.trim(), Some(object.trim())),
            None => (text, None),
        };
        let known: Vec<&str> = match (verb, object.filter(|name| !name.is_empty())) {
            ("mark", None) if object.is_none() => return Some(EventAction::Mark),
            ("stop", None) if object.is_none() => return Some(EventAction::Stop),
            ("release", Some(_)) => {
                self.model.constraints.iter().map(|c| c.name.as_str()).collect()
            }
            ("impulse", Some(_)) => self.model.impulses.iter().map(|i| i.name.as_str()).collect(),
            _ => {
                self.diagnostics.push(no_action(written, verb));
                return None;
            }
        };
        let object = object.unwrap_or("");
        if let Some(index) = known.iter().position(|name| *name == object) {
            let release = verb == "release";
            return Some(if release {
                EventAction::Release(index)
            } else {
                EventAction::Impulse(index)
            });
        }
        let kind = if verb == "release" { "constraint" } else { "impulse" };
        let help = match nearest(object, known.iter().copied()) {
            Some(near) => format!("did you mean `{verb}:{near}`?"),
            None if known.is_empty() => format!("the file has no [[{kind}s]]"),
            None => format!("the {kind}s are {}", known.join(", ")),
        };
        let message = format!("unknown {kind} `{object}`");
        self.diagnostics.push(Diagnostic::error(written.span(), message).with_help(help));
        None
    }
}

fn no_action(written: &Spanned<String>, verb: &str) -> Diagnostic {
    let text = written.get_ref();
    let message = format!("unknown action `{text}`");
    let help = match (verb, nearest(verb, ["mark", "stop", "release", "impulse"])) {
        ("release" | "impulse", _) => format!("name which: `{verb}:NAME`"),
        (_, Some(near @ ("mark" | "stop"))) => format!("did you mean `{near}`?"),
        (_, Some(near)) => format!("did you mean `{near}:NAME`?"),
        _ => format!("the actions are {ACTIONS}"),
    };
    Diagnostic::error(written.span(), message).with_help(help)
}
