//! The part of the report that takes longer to find, as text: observables that change, transformations, generators, the
//! Hamilton–Jacobi equation.
//!
//! In: [`Further`]. Out: lines of the report. Never here: what is known of a law at once.

use super::super::super::decimal::magnitude;
use super::TextReport;
use crate::mechanics::{Class, Classed, Further};

impl TextReport<'_> {
    /// The observables that are not conserved, with their rates.
    pub(super) fn changing(&mut self, classes: &[Classed]) {
        let unknown = classes.iter().filter(|c| c.class == Class::Unknown);
        let unknown: Vec<String> = unknown
            .map(|c| {
                let name = self.words(&c.name);
                let row = match &c.rate {
                    Ok(rate) => format!("  d({name})/dt = {}", self.math(*rate)),
                    Err(why) => format!("  {name}   ({})", self.words(&why.0)),
                };
                let mut own = self.report.equations.conserved.iter();
                let declared =
                    own.any(|conserved| conserved.name == c.name && conserved.reason.is_declared());
                if declared { format!("{row}   (declared conserved)") } else { row }
            })
            .collect();
        let here = classes.iter().filter(|c| c.class == Class::AtTheseParameters);
        let here: Vec<String> = here
            .map(|c| {
                let name = self.words(&c.name);
                match &c.rate {
                    Ok(rate) => format!("  {name}, for d({name})/dt = {}", self.math(*rate)),
                    Err(_) => format!("  {name}"),
                }
            })
            .collect();
        let changing = classes.iter().filter(|c| c.class == Class::Changing);
        let rows: Vec<String> = changing
            .map(|c| {
                let name = self.words(&c.name);
                match &c.rate {
                    Ok(rate) => format!("  d({name})/dt = {}", self.math(*rate)),
                    Err(why) => format!("  {name}   ({}; {})", c.class, self.words(&why.0)),
                }
            })
            .collect();
        let rounded = classes.iter().filter(|c| c.class == Class::Numerically && c.rate.is_err());
        let rounded: Vec<String> =
            rounded.map(|c| format!("  {}   ({})", self.words(&c.name), c.class)).collect();
        let sections = [
            ("Conserved to rounding", rounded),
            ("Conserved at the file's values of the parameters", here),
            ("Not conserved", rows),
            ("Not known to be conserved or not", unknown),
        ];
        for (title, rows) in sections {
            if !rows.is_empty() {
                self.heading(title);
                for row in &rows {
                    self.line(row);
                }
            }
        }
    }

    /// Each transformation: the map, whether it is canonical, and K.
    pub(super) fn transformations(&mut self, further: &Further) {
        for known in &further.transformations {
            let name = self.words(&known.map.name);
            let verdict = &known.verdict;
            let residual = verdict.residual.map_or_else(String::new, |residual| {
                format!("; residual {} at points around the start", magnitude(residual))
            });
            let judged = match (verdict.canonical, verdict.proved) {
                (true, true) => format!("canonical, proved{residual}"),
                (true, false) if !verdict.only_here.is_empty() => {
                    format!("canonical at these values of the parameters{residual}")
                }
                (true, false) => format!("canonical to rounding{residual}"),
                (false, _) if verdict.residual.is_none() && verdict.failing.is_empty() => {
                    "no map is known".to_owned()
                }
                (false, _) => format!("not canonical{residual}"),
            };
            self.heading(&format!("Transformation {name}: {}", self.words(&judged)));
            for (s, e) in known.map.forwards.iter().flatten() {
                let line = format!("  {} = {}", self.symbol(*s), self.math(*e));
                self.line(&line);
            }
            if known.map.forwards.is_none() {
                self.line("  the new variables are not known in closed form");
            }
            for bracket in &verdict.only_here {
                let [f, g] = bracket.pair.map(|symbol| self.symbol(symbol));
                let (is, here) = (self.math(bracket.is), self.math(bracket.expected));
                self.line(&format!("  [{f}, {g}] = {is}, which is {here} at these values"));
            }
            for bracket in &verdict.failing {
                let [f, g] = bracket.pair.map(|symbol| self.symbol(symbol));
                let (is, expected) = (self.math(bracket.is), self.math(bracket.expected));
                self.line(&format!("  [{f}, {g}] = {is}, not {expected}"));
            }
            if let Some(why) = verdict.why.as_ref().filter(|_| verdict.failing.is_empty()) {
                self.line(&format!("  {}", self.words(why)));
            }
            if let Some(valence) = verdict.valence {
                self.line(&format!("  a scale transformation of valence {}", self.math(valence)));
            }
            let parameters = known.canonical_where.iter();
            let parameters: Vec<String> = parameters
                .map(|&(parameter, e)| format!("{} = {}", self.symbol(parameter), self.math(e)))
                .collect();
            if !parameters.is_empty() {
                self.line(&format!("  with {}:", parameters.join(", ")));
            }
            for one in &known.functions {
                let name = one.name();
                let words = match &one.function {
                    Ok(e) if one.proved => format!("{} = {}", name, self.math(*e)),
                    Ok(e) => format!("{} = {}   (near the start)", name, self.math(*e)),
                    Err(why) => format!("{}: {}", name, self.words(&why.to_string())),
                };
                self.line(&format!("  {words}"));
            }
            if verdict.canonical && known.functions.is_empty() {
                self.line(&format!("  {}", known.without_functions()));
            }
            match &known.hamiltonian {
                Ok(e) => {
                    let where_known = if known.is_local { "   (near the start)" } else { "" };
                    self.line(&format!("  K = {}{where_known}", self.math(*e)));
                }
                Err(why) if verdict.canonical => {
                    self.line(&format!("  K: {}", self.words(&why.to_string())));
                }
                Err(_) => {}
            }
            if let Some(e) = known.hamiltonian_in_old {
                self.line(&format!("  K = {}   (in the old variables)", self.math(e)));
            }
        }
    }

    /// Each generator G with [H, G].
    pub(super) fn generators(&mut self, further: &Further) {
        if further.generators.is_empty() {
            return;
        }
        self.heading("Generators");
        for known in &further.generators {
            let bracket = match &known.bracket {
                Ok(e) => self.math(*e),
                Err(_) => "not known in closed form".to_owned(),
            };
            let conserved = if known.conserved { "conserved" } else { "not conserved" };
            let (name, e) = (self.words(&known.name), self.math(known.expression));
            self.line(&format!("  {name}: G = {e}, [H, G] = {bracket}   ({conserved})"));
        }
    }

    pub(super) fn hamilton_jacobi(&mut self, further: &Further) {
        let Some(known) = &further.hamilton_jacobi else { return };
        let model = self.report.model;
        let complete = if known.complete { "complete" } else { "not complete" };
        self.heading(&format!("Integral of the Hamilton-Jacobi equation: {complete}"));
        if let Some(why) = &known.why {
            self.line(&format!("  {}", self.words(why)));
        }
        for (c, &e) in model.coordinates.iter().zip(&known.momenta) {
            self.line(&format!("  {} = {}", self.symbol(c.momentum), self.math(e)));
        }
        let constants = model.complete_integral.iter().flat_map(|s| &s.constants);
        for (c, &e) in constants.zip(&known.beta) {
            self.line(&format!("  {} = {}", self.symbol(c.conjugate), self.math(e)));
        }
    }
}
