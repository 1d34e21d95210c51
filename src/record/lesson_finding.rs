//! What was found, in words for a person: a quantity as the lab shows it, and its value with a few digits.
//!
//! In: a claim, the application. Out: a sentence, unless the claim is too long to help. Never here: whether an answer is
//! right, and what a check of the script reports.

use super::assertion::{column, measured, short, value};
use super::script::{Assert, AssertedNumber, Comparator, LineText};
use crate::app::App;
use crate::model::{Allowed, Scope};
use crate::num::significant;

/// The most characters of a quantity in a sentence; a longer one says nothing to whoever has not written it.
const LONGEST: usize = 24;

/// What a true claim has found, or `None` if it cannot be said in few words.
pub(super) fn in_words(claim: &Assert, app: &App) -> Option<String> {
    let Assert::Number { measure, of, relation, with, .. } = claim else { return None };
    let (left, right) = (measured(app, *measure, of).ok()?, value(app, with).ok()?);
    let name = shown(app, *measure, of).filter(|name| name.chars().count() <= LONGEST)?;
    let what = match measure {
        AssertedNumber::Value => name,
        AssertedNumber::Drift => format!("the drift of {name}"),
        AssertedNumber::Least => format!("the least {name}"),
        AssertedNumber::Greatest => format!("the greatest {name}"),
        AssertedNumber::Count => format!("the count of {name}"),
        AssertedNumber::Time => format!("the time of {name}"),
    };
    // a quantity that moves has its value at a time
    let now = app.snapshot().map(|snapshot| significant(snapshot.time, 3, 1e-3..1e4));
    let when = match measure {
        AssertedNumber::Value => now.map_or_else(String::new, |now| format!(" at t = {now}")),
        _ => String::new(),
    };
    Some(match relation {
        Comparator::Equal if left == right => format!("{what} is {}{when}", short(left)),
        Comparator::Equal => {
            let off = significant((left - right).abs(), 2, 1e-3..1e4);
            format!("{what} is {}{when}, to within {off}", short(right))
        }
        Comparator::Less => format!("{what} is {}, below {}", short(left), short(right)),
        Comparator::More => format!("{what} is {}, above {}", short(left), short(right)),
    })
}

/// A quantity as the lab shows it: a channel, a gauge, or an expression.
fn shown(app: &App, measure: AssertedNumber, of: &LineText) -> Option<String> {
    let lab = app.lab.as_ref()?;
    let quoted = |name: &str| {
        if name.contains(' ') { format!("“{name}”") } else { name.to_owned() }
    };
    if let Ok(index) = column(app, of) {
        return Some(quoted(&lab.loaded.system.channels()[index].shown));
    }
    if measure != AssertedNumber::Value {
        return Some(quoted(&of.text));
    }
    let mut pool = lab.loaded.equations.pool.clone();
    let mut scope = Scope::new(&lab.loaded.model, Allowed::Observable, "a script");
    scope.read(&mut pool, &of.text).map(|e| pool.unicode(e))
}
