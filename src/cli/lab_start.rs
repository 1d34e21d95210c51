//! How the laboratory opens a system whose parameters, initial values or method are given.
//!
//! In: options. Out: a checkpoint of a motion that is about to begin. Never here: the screen, or the motion.

use super::assignment;
use super::error::CommandError;
use super::open;
use super::start_options::StartOptions;
use crate::experiment::Checkpoint;

impl StartOptions {
    /// Whether anything is not as the file says.
    pub(super) fn is_given(&self) -> bool {
        !self.set.is_empty() || !self.init.is_empty() || self.integrator.is_given()
    }

    /// The motion that is to begin, or `None` if all of it is as its file says.
    pub(super) fn checkpoint(
        &self,
        name: Option<&str>,
    ) -> Result<Option<Checkpoint>, CommandError> {
        let wrong = |what: &str| Err(CommandError::WrongUse(what.to_owned()));
        if !self.is_given() {
            return Ok(None);
        }
        let Some(name) = name else {
            return wrong(
                "--set, --init, --method, --step and --tolerance are for a system: give its name first",
            );
        };
        if self.init.iter().any(|given| given.name() == "t") {
            return wrong(
                "--init t: the laboratory begins at the time of the file; `phaselab run` takes another",
            );
        }
        let document = open::find(name)?;
        let mut model = open::read(&document)?;
        let parameters = assignment::parameters(&model, &self.set)?;
        let overrides = assignment::initial(&model, &parameters, &self.init)?;
        self.integrator.settings(&document, &model)?;
        let mut checkpoint = Checkpoint { running: true, ..Checkpoint::default() };
        checkpoint.set_parameters(&model, parameters.iter().copied());
        checkpoint.start_with(&model, &overrides);
        self.integrator.set(&mut checkpoint);
        if self.integrator.is_given() {
            // whether the method suits the system is known once it is compiled
            model.set_parameters(&parameters);
            model.leave_views_out();
            let derived = open::derive(&document, model)?;
            let system = open::compile(&document, &derived, &[])?;
            self.integrator.choose(&document, &derived.model, &system)?;
        }
        Ok(Some(checkpoint))
    }
}

#[cfg(test)]
mod tests {
    use std::process::Command;

    use clap::Parser;

    use super::*;
    use crate::app::command_line;
    use crate::experiment::Named;
    use crate::integrate::Stepping;

    #[derive(Parser)]
    struct Line {
        name: String,
        #[command(flatten)]
        start: StartOptions,
    }

    /// The words of a line as a shell reads them.
    fn words(line: &str) -> Vec<String> {
        let script = format!("for word in {line}; do printf '%s\\n' \"$word\"; done");
        let done = Command::new("sh").args(["-c", &script]).output().expect("a shell");
        String::from_utf8(done.stdout).expect("text").lines().map(str::to_owned).collect()
    }

    fn read(line: &str) -> (String, Result<Option<Checkpoint>, CommandError>) {
        let line = Line::try_parse_from(words(line)).expect("options");
        let checkpoint = line.start.checkpoint(Some(&line.name));
        (line.name, checkpoint)
    }

    /// What is shared is read back to the last bit.
    #[test]
    fn a_shared_command_is_read_back() {
        let document = open::find("pendulum").expect("a preset");
        let model = document.read().expect("a model").model;
        let mut values = model.parameter_values();
        for value in &mut values {
            *value = (*value + 0.1).sqrt();
        }
        let named = |name: &str, value| Named { name: name.to_owned(), value };
        let mut checkpoint = Checkpoint { running: true, ..Checkpoint::default() };
        checkpoint.set_parameters(&model, values.iter().copied());
        checkpoint.initial = vec![named("theta", 0.1 + 0.2), named("theta'", -1e-17)];
        checkpoint.method = Some("rk4".to_owned());
        checkpoint.step = Some(1.0 / 300.0);
        let line = command_line("pendulum", &checkpoint, Stepping::Fixed);
        let (name, back) = read(&line);
        assert_eq!(name, "pendulum");
        assert_eq!(back.ok().flatten(), Some(checkpoint.clone()), "{line}");
        // the lab keeps both settings while methods are tried
        checkpoint.tolerance = Some(1e-9);
        for (method, stepping) in [("rk4", Stepping::Fixed), ("taylor", Stepping::Adaptive)] {
            let with_both = Checkpoint { method: Some(method.to_owned()), ..checkpoint.clone() };
            let line = command_line("pendulum", &with_both, stepping);
            let back = read(&line).1.expect(&line).expect("a start");
            let settings = (back.step.is_some(), back.tolerance.is_some());
            let is_fixed = stepping == Stepping::Fixed;
            assert_eq!(settings, (is_fixed, !is_fixed), "{line}");
        }
    }

    #[test]
    fn what_no_system_has_is_refused() {
        let check = |line: &str, part: &str| {
            let error = read(line).1.expect_err(line);
            assert!(error.message().contains(part), "{line}: {}", error.message());
        };
        check("phaselab pendulum --set q=1", "unknown parameter `q`");
        check("phaselab pendulum --init t=1", "phaselab run");
        check("phaselab pendulum --method gaus", "unknown method `gaus`");
        check("phaselab pendulum --method rk4 --tolerance 1e-9", "--tolerance: rk4");
        assert!(read("phaselab pendulum").1.is_ok_and(|start| start.is_none()));
    }
}
