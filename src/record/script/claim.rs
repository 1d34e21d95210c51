//! The claims of a script: what an `Assert` says, and what decides whether an answer or a task is right.
//!
//! In: the rest of a line. Out: an [`Assert`]. Never here: whether it holds.

use super::line::ScriptLine;
use super::{Assert, AssertedNumber, Comparator, LineText, Word};
use crate::diagnostic::Diagnostic;

/// The forms of an `Assert`, with descriptions.
pub const CLAIMS: [(&str, &str); 10] = [
    (
        "EXPR = EXPR within EPS",
        "an expression of state, parameters and time has this value; also `<` and `>`",
    ),
    ("KIND.WORD > EXPR", "a number of a plot of that kind, as `phase.saddles`; also `<` and `=`"),
    ("drift NAME < EPS", "the gauge of that name has drifted by no more since its reference"),
    ("greatest NAME = EXPR within EPS", "the greatest value of a column since the motion began"),
    ("least NAME = EXPR within EPS", "the least"),
    ("count NAME = N", "how often an event or an impulse has happened"),
    ("time NAME = EXPR within EPS", "when it last happened"),
    (
        "verdict NAME WORD",
        "the verdict on a gauge: `exact`, `bounded`, `secular`, `lost`, `not conserved`, `open`, `unknown`, `other branch`, `released`",
    ),
    ("status WORD", "`running`, `paused`, `ended` or `stopped`"),
    ("screen \"TEXT\"", "the text stands on the screen"),
];

/// The words for measures in front of a name.
const MEASURES: [(&str, AssertedNumber); 5] = [
    ("drift", AssertedNumber::Drift),
    ("greatest", AssertedNumber::Greatest),
    ("least", AssertedNumber::Least),
    ("count", AssertedNumber::Count),
    ("time", AssertedNumber::Time),
];

const STATUS: [Word; 4] = ["running", "paused", "ended", "stopped"];

const VERDICTS: [Word; 7] = ["exact", "bounded", "secular", "lost", "open", "unknown", "released"];

/// What some of them are called elsewhere: in old scripts, and where a column of the screen is narrow.
const OTHER_WORDS: [(Word, Word); 3] =
    [("broken", "not conserved"), ("varies", "not conserved"), ("drifting", "secular")];

/// A verdict, as gauges and runs have it.
fn verdict(line: &mut ScriptLine<'_>) -> Result<Word, Diagnostic> {
    let what = "a verdict";
    if line.take("not") {
        line.one_of("the rest of `not conserved`", &["conserved"])?;
        return Ok("not conserved");
    }
    if line.take("other") {
        line.one_of("the rest of `other branch`", &["branch"])?;
        return Ok("other branch");
    }
    if let Some((old, new)) = OTHER_WORDS.iter().find(|(old, _)| line.take(old)) {
        let message = format!("`{old}` is not {what} of a script");
        let place = line.here() - old.len()..line.here();
        return Err(Diagnostic::error(place, message).with_help(format!("write `{new}`")));
    }
    line.one_of(what, &VERDICTS)
}

pub(super) fn claim(line: &mut ScriptLine<'_>) -> Result<Assert, Diagnostic> {
    if line.take("status") {
        let word = line.one_of("how an experiment stands", &STATUS)?;
        return Ok(Assert::Status(word));
    }
    if line.take("screen") {
        return Ok(Assert::Screen(line.quoted("a text")?.text));
    }
    if line.take("verdict") {
        let name = line.name("the name of a gauge")?;
        return Ok(Assert::Verdict(name, verdict(line)?));
    }
    let measure = MEASURES.iter().find(|(word, _)| line.take(word)).map(|(_, measure)| *measure);
    let of = match measure {
        Some(_) => line.name("a name")?,
        None if line.is_quoted() => line.name("a name")?,
        None => line.until(&["=", "<", ">"], "what is claimed")?,
    };
    let relations = [("=", Comparator::Equal), ("<", Comparator::Less), (">", Comparator::More)];
    let relation =
        relations.iter().find(|(sign, _)| line.take(sign)).map(|(_, relation)| *relation);
    let relation = relation.ok_or_else(|| {
        let here = line.word().map_or(line.here()..line.here(), |word| word.place);
        Diagnostic::error(here, "one of `=` `<` `>` is missing here, between spaces")
    })?;
    let with = line.until(&["within"], "a value")?;
    let within = line.take("within").then(|| line.until(&[], "a tolerance")).transpose()?;
    let measure = measure.unwrap_or(AssertedNumber::Value);
    exactness(line, measure, relation, within.as_ref())?;
    Ok(Assert::Number { measure, of, relation, with, within })
}

/// `=` needs a tolerance, except between counts; `<` and `>` must not have one.
fn exactness(
    line: &ScriptLine<'_>,
    measure: AssertedNumber,
    relation: Comparator,
    within: Option<&LineText>,
) -> Result<(), Diagnostic> {
    match (relation, measure, within) {
        (Comparator::Equal, AssertedNumber::Count, None) => Ok(()),
        (Comparator::Equal, _, None) => {
            Err(line.missing("how far it may be off").with_help("add `within 1e-9`"))
        }
        (Comparator::Less | Comparator::More, _, Some(within)) => {
            let message = "`within` belongs to `=`";
            Err(Diagnostic::error(within.place.clone(), message))
        }
        _ => Ok(()),
    }
}
