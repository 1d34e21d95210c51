//! Evaluates an `Assert` of a script.
//!
//! In: an assertion, the application. Out: whether it is true, with a sentence that gives the values; or an error if
//! it names something that does not exist. Never here: when it is evaluated.

use crate::app::{App, Lab};
use crate::diagnostic::Diagnostic;
use crate::diagnostic::nearest;
use crate::experiment::{Snapshot, Status};
use crate::instrument::{INSTRUMENTS, named};
use crate::model::{Allowed, Scope};
use crate::num::significant;

use super::script::{Assert, AssertedNumber, Comparator, LineText};

#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct AssertionResult {
    pub(super) holds: bool,
    pub(super) sentence: String,
}

/// Evaluates an assertion; `screen` contains the screen's rows.
pub(super) fn find(
    claim: &Assert,
    app: &App,
    screen: &[String],
) -> Result<AssertionResult, Diagnostic> {
    match claim {
        Assert::Screen(text) => {
            let holds = screen.iter().any(|row| row.contains(text.as_str()));
            let sentence = if holds { "is on the screen" } else { "is not on the screen" };
            Ok(AssertionResult { holds, sentence: format!("\"{text}\" {sentence}") })
        }
        Assert::Status(word) => {
            let status = app.snapshot().map(|s| status(&s.status));
            let is = status.unwrap_or("without a system");
            Ok(AssertionResult {
                holds: status == Some(word),
                sentence: format!("the motion is {is}"),
            })
        }
        Assert::Verdict(name, word) => {
            let (lab, snapshot) = seen(app, name)?;
            let gauge = gauge(lab, snapshot, name)?;
            let is = gauge.verdict.word();
            let holds = is == *word;
            Ok(AssertionResult { holds, sentence: format!("the verdict on {} is {is}", name.text) })
        }
        Assert::Number { measure, of, relation, with, within } => {
            let left = measured(app, *measure, of)?;
            let right = value(app, with)?;
            let within = within.as_ref().map(|eps| value(app, eps)).transpose()?;
            Ok(compared(*measure, of, (left, right), *relation, within))
        }
    }
}

fn compared(
    measure: AssertedNumber,
    of: &LineText,
    (left, right): (f64, f64),
    relation: Comparator,
    within: Option<f64>,
) -> AssertionResult {
    let what = match measure {
        AssertedNumber::Value => of.text.clone(),
        AssertedNumber::Drift => format!("the drift of {}", of.text),
        AssertedNumber::Least => format!("the least {}", of.text),
        AssertedNumber::Greatest => format!("the greatest {}", of.text),
        AssertedNumber::Count => format!("the count of {}", of.text),
        AssertedNumber::Time => format!("the time of {}", of.text),
    };
    let off = (left - right).abs();
    let (holds, sentence) = match relation {
        Comparator::Equal => {
            let within = within.unwrap_or(0.0);
            let sentence = match measure {
                AssertedNumber::Count => format!("{what} is {left}"),
                _ if off == 0.0 => format!("{what} is {left}, exactly"),
                _ => format!(
                    "{what} is {left}, {} off {right}, within {}",
                    tolerance(off),
                    tolerance(within)
                ),
            };
            (off <= within, sentence)
        }
        Comparator::Less => {
            (left < right, format!("{what} is {}, below {}", short(left), short(right)))
        }
        Comparator::More => {
            (left > right, format!("{what} is {}, above {}", short(left), short(right)))
        }
    };
    if holds {
        return AssertionResult { holds, sentence };
    }
    let sentence = match relation {
        Comparator::Equal => {
            let within = within.unwrap_or(0.0);
            match measure {
                AssertedNumber::Count => format!("{what} is {left}, not {right}"),
                _ => format!(
                    "{what} is {left}, which is {} off {right}, not within {}",
                    tolerance(off),
                    tolerance(within)
                ),
            }
        }
        Comparator::Less => format!("{what} is {}, not below {}", short(left), short(right)),
        Comparator::More => format!("{what} is {}, not above {}", short(left), short(right)),
    };
    AssertionResult { holds, sentence }
}

/// A difference with two digits, for display only.
fn tolerance(x: f64) -> String {
    significant(x, 2, 1e-3..1e4)
}

/// A number with four digits, for display only.
pub(super) fn short(x: f64) -> String {
    significant(x, 4, 1e-3..1e6)
}

fn status(status: &Status) -> &'static str {
    match status {
        Status::Running => "running",
        Status::Paused => "paused",
        Status::Ended(_) => "ended",
        Status::Failed(_) => "stopped",
    }
}

fn seen<'a>(app: &'a App, at: &LineText) -> Result<(&'a Lab, &'a Snapshot), Diagnostic> {
    let lab = app.lab.as_ref().and_then(|lab| Some((lab, lab.seen()?)));
    lab.ok_or_else(|| Diagnostic::error(at.place.clone(), "there is no system in motion here"))
}

fn gauge<'a>(
    lab: &Lab,
    snapshot: &'a Snapshot,
    name: &LineText,
) -> Result<&'a crate::experiment::Gauge, Diagnostic> {
    let named = |g: &&crate::experiment::Gauge| g.name == name.text || g.shown == name.text;
    snapshot.gauges.iter().find(named).ok_or_else(|| {
        let names = snapshot.gauges.iter().map(|g| g.name.as_str());
        missing("gauge", name, names, &lab.loaded.name)
    })
}

/// The index of the channel of a name.
pub(super) fn column(app: &App, of: &LineText) -> Result<usize, Diagnostic> {
    let (lab, _) = seen(app, of)?;
    let channels = lab.loaded.system.channels();
    channels.iter().position(|c| c.name == of.text || c.shown == of.text).ok_or_else(|| {
        let named = lab.loaded.physics().named();
        let names: Vec<&str> = named.map(|(_, channel)| channel.name.as_str()).collect();
        missing("column", of, names.into_iter(), &lab.loaded.name)
    })
}

pub(super) fn shown_channel(app: &App, of: &LineText) -> Result<usize, Diagnostic> {
    let (lab, _) = seen(app, of)?;
    let channel = lab.shown_channel(&of.text).map_err(|scope| unreadable(&scope, of))?;
    channel.ok_or_else(|| {
        let message = format!("no picture shows `{}`", of.text);
        let help = "name what is on an axis, or a component of a point in a picture, as it is written there";
        Diagnostic::error(of.place.clone(), message).with_help(help)
    })
}

/// Why an expression of a script cannot be read.
fn unreadable(scope: &Scope, written: &LineText) -> Diagnostic {
    let Some(first) = scope.diagnostics.first() else {
        return Diagnostic::error(written.place.clone(), "this is not an expression");
    };
    let start = written.place.start;
    let place = start + first.span.start..start + first.span.end;
    Diagnostic { help: first.help.clone(), ..Diagnostic::error(place, first.message.clone()) }
}

/// The two ends of a range, the less one first.
pub(super) fn range(app: &App, ends: &[LineText; 2]) -> Result<[f64; 2], Diagnostic> {
    let [from, to] = ends;
    let range = [value(app, from)?, value(app, to)?];
    if range[0] < range[1] {
        return Ok(range);
    }
    let message = format!("this range would go from {} to {}", range[0], range[1]);
    Err(Diagnostic::error(from.place.start..to.place.end, message))
}

/// The number that is measured of a name or an expression now.
pub(super) fn measured(
    app: &App,
    measure: AssertedNumber,
    of: &LineText,
) -> Result<f64, Diagnostic> {
    if measure == AssertedNumber::Value {
        return value(app, of);
    }
    let (lab, snapshot) = seen(app, of)?;
    let channel = || column(app, of);
    let event = || {
        let model = &lab.loaded.model;
        let names = || {
            let events = model.events.iter().map(|event| event.name.as_str());
            events.chain(model.impulses.iter().map(|impulse| impulse.name.as_str()))
        };
        if names().any(|name| name == of.text) {
            return Ok(snapshot.occurrences.counts().iter().find(|t| t.name == of.text));
        }
        Err(missing("event or impulse", of, names(), &lab.loaded.name))
    };
    Ok(match measure {
        AssertedNumber::Value => f64::NAN,
        AssertedNumber::Drift => gauge(lab, snapshot, of)?.max_drift,
        AssertedNumber::Least => snapshot.bounds[channel()?].0,
        AssertedNumber::Greatest => snapshot.bounds[channel()?].1,
        AssertedNumber::Count => event()?.map_or(0.0, |event| event.count as f64),
        AssertedNumber::Time => event()?.map(|event| event.last).ok_or_else(|| {
            Diagnostic::error(of.place.clone(), format!("`{}` has not happened yet", of.text))
        })?,
    })
}

/// The current value of an expression.
pub(super) fn value(app: &App, written: &LineText) -> Result<f64, Diagnostic> {
    // a number needs no system
    if let Ok(number) = written.text.parse::<f64>()
        && number.is_finite()
    {
        return Ok(number);
    }
    let (lab, snapshot) = seen(app, written)?;
    // the name of a column need not be a valid expression
    let channels = lab.loaded.system.channels();
    if let Some(at) = channels.iter().position(|channel| channel.name == written.text) {
        return Ok(snapshot.values[at]);
    }
    if let Some(value) = measured_of_plot(lab, written)? {
        return Ok(value);
    }
    let mut pool = lab.loaded.equations.pool.clone();
    let mut scope = Scope::new(&lab.loaded.model, Allowed::Observable, "a script");
    let e = scope.read(&mut pool, &written.text);
    let e = e.ok_or_else(|| unreadable(&scope, written))?;
    let now = lab.valuation();
    let value = pool.evaluate(e, &|symbol| now.at(symbol));
    if value.is_finite() {
        return Ok(value);
    }
    let message = format!("`{}` has no value here", written.text);
    let diagnostic = Diagnostic::error(written.place.clone(), message);
    Err(if pool.depends(e, lab.loaded.equations.symbols.action) {
        diagnostic.with_help(
            "the action is a column where an observable of the file is made of it: give one, as S = \"action\", and assert that",
        )
    } else {
        diagnostic
    })
}

/// The value of a measure of a plot, `KIND.WORD`, or `None` if the text is not one.
fn measured_of_plot(lab: &Lab, written: &LineText) -> Result<Option<f64>, Diagnostic> {
    let Some((kind, word)) = written.text.split_once('.') else { return Ok(None) };
    let is_word = |text: &str| text.starts_with(|c: char| c.is_ascii_alphabetic());
    if !is_word(kind) || !is_word(word) {
        return Ok(None);
    }
    let part = |text: &str, from: usize| {
        let start = written.place.start + from;
        LineText { text: text.to_owned(), place: start..start + text.len() }
    };
    let system = "this version";
    let known = named(kind).ok_or_else(|| {
        let names = INSTRUMENTS.iter().map(|kind| kind.name());
        missing("kind of plot", &part(kind, 0), names, system)
    })?;
    let measure = known.measure(word).ok_or_else(|| {
        let words = known.properties().measures.iter().map(|measure| measure.word);
        missing("number of a plot of this kind", &part(word, kind.len() + 1), words, system)
    })?;
    let refused = |message| Err(Diagnostic::error(written.place.clone(), message));
    let mut plots = lab.plots.iter().filter(|plot| plot.kind == known).peekable();
    let Some(present) = lab.present().filter(|_| plots.peek().is_some()) else {
        return refused(format!("no pane shows a plot of kind `{kind}`"));
    };
    // the first plot that has the number
    match plots.find_map(|plot| (measure.value)(lab.context(plot, &present))) {
        Some(value) => Ok(Some(value)),
        None => refused(format!("no plot of kind `{kind}` has `{word}` here")),
    }
}

/// An error about something that does not exist, with the nearest name that does.
pub(super) fn missing<'a>(
    kind: &str,
    name: &LineText,
    names: impl Iterator<Item = &'a str> + Clone,
    system: &str,
) -> Diagnostic {
    let message = format!("{system} has no {kind} `{}`", name.text);
    let diagnostic = Diagnostic::error(name.place.clone(), message);
    match nearest(&name.text, names.clone()) {
        Some(near) => diagnostic.with_help(format!("did you mean `{near}`?")),
        None => {
            let all: Vec<&str> = names.collect();
            if all.is_empty() {
                diagnostic.with_help("there are none")
            } else {
                diagnostic.with_help(format!("there are {}", all.join(", ")))
            }
        }
    }
}
