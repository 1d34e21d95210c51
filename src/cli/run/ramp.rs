//! `--ramp NAME=FROM:TO:START:DURATION[:FORM]`.
//!
//! In: the option. Out: a [`Ramp`] of a model. Never here: what it does to the model.

use std::str::FromStr;

use crate::cli::assignment::{self, Assignment, name_in_letters, number};
use crate::cli::error::CommandError;
use crate::model::{Model, Ramp, RampForm};
use crate::printable;

/// A ramp under the name of its parameter.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct RampArgument {
    name: String,
    values: [f64; 2],
    start: f64,
    duration: f64,
    form: RampForm,
}

impl FromStr for RampArgument {
    type Err = String;

    fn from_str(text: &str) -> Result<RampArgument, String> {
        let form = "write it as name=from:to:start:duration, or with :cubic or :linear behind";
        let (name, rest) = text.split_once('=').ok_or(form)?;
        let parts: Vec<&str> = rest.split(':').map(str::trim).collect();
        let named = |last: &&str| RampForm::NAMED.into_iter().find(|(name, _)| name == last);
        let (numbers, shape) = match parts.split_last() {
            Some((last, numbers)) if named(last).is_some() => (numbers, named(last)),
            _ => (&parts[..], None),
        };
        let shape = shape.map_or_else(RampForm::default, |(_, shape)| shape);
        let &[from, to, start, duration] = numbers else { return Err(form.to_owned()) };
        let duration = number(duration)?;
        if duration <= 0.0 {
            return Err("the duration of a ramp must be above zero".to_owned());
        }
        Ok(RampArgument {
            name: name_in_letters(name),
            values: [number(from)?, number(to)?],
            start: number(start)?,
            duration,
            form: shape,
        })
    }
}

pub(super) fn of(
    model: &Model,
    named: &[RampArgument],
    set: &[Assignment],
) -> Result<Vec<Ramp>, CommandError> {
    let mut ramps: Vec<Ramp> = Vec::new();
    for ramp in named {
        let parameter = assignment::parameter(model, &ramp.name)?;
        if ramps.iter().any(|before| before.parameter == parameter) {
            let name = printable::quoted(&ramp.name);
            return Err(CommandError::WrongUse(format!("--ramp gives {name} twice")));
        }
        if set.iter().any(|assignment| assignment.name() == ramp.name) {
            let name = printable::quoted(&ramp.name);
            let message = format!("--set and --ramp both give {name}: keep one of them");
            return Err(CommandError::WrongUse(message));
        }
        let RampArgument { values, start, duration, form, .. } = *ramp;
        ramps.push(Ramp { parameter, values, start, duration, form });
    }
    Ok(ramps)
}
