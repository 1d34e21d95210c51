//! The names of a file: well formed, not reserved, and each given once.

use std::collections::BTreeMap;

use toml::Spanned;

use crate::diagnostic::Diagnostic;
use crate::diagnostic::Diagnostics;
use crate::diagnostic::SourceRange;
use crate::expr::{FUNCTIONS, latex_of_unicode};
use crate::model::{Attitude, BodyNames, multiplier_name};
use crate::preset::draft::{Draft, LawTable};

/// The names given so far, with what they name and their ranges.
pub(super) struct Names {
    taken: BTreeMap<String, (&'static str, SourceRange)>,
    coordinates: Vec<String>,
    /// Whether the names include variables of brackets, which have no momenta.
    poisson: bool,
    /// The constraints and the notation of their multipliers.
    multipliers: Vec<(String, String)>,
}

impl Names {
    /// Checks the names of coordinates, parameters and definitions.
    pub(super) fn of(draft: &Draft, diagnostics: &mut Diagnostics) -> Names {
        let coordinates = draft.moving.all.iter().map(|c| c.name.get_ref().clone()).collect();
        let constraints = draft.constraints.iter().filter_map(|c| c.name.as_ref());
        let multipliers = constraints
            .map(|name| (name.get_ref().clone(), multiplier_name(name.get_ref())))
            .collect();
        let poisson = draft.law() == Some(LawTable::Poisson);
        let mut names = Names { taken: BTreeMap::new(), coordinates, poisson, multipliers };
        names.given(draft);
        let kind = if poisson { "a variable" } else { "a coordinate" };
        for coordinate in &draft.moving.all {
            names.word(&coordinate.name, kind, diagnostics);
        }
        for parameter in &draft.parameters {
            names.word(&parameter.name, "a parameter", diagnostics);
        }
        for (name, _) in &draft.definitions {
            names.word(name, "a definition", diagnostics);
        }
        names
    }

    /// Adds the names that tables of the file define implicitly.
    fn given(&mut self, draft: &Draft) {
        let mut take = |name: &str, kind: &'static str, place: &SourceRange| {
            self.taken.insert(name.to_owned(), (kind, place.clone()));
        };
        if let Some(body) = &draft.body {
            for name in BodyNames::WRITTEN {
                take(name, "what follows from the pieces", &body.place);
            }
        }
        if let Some(attitude) = &draft.attitude {
            for name in Attitude::WRITTEN.as_flattened() {
                take(name, "an entry of the matrix", &attitude.place);
            }
        }
        if let Some(comparison) = &draft.comparison {
            for coordinate in &self.coordinates {
                let name = format!("other_{coordinate}");
                take(&name, "a coordinate of the other motion", &comparison.place);
            }
        }
    }

    /// Claims the name of a new variable, which other transformations may have too.
    pub(super) fn new_variable(
        &mut self,
        name: &Spanned<String>,
        diagnostics: &mut Diagnostics,
    ) -> bool {
        const KIND: &str = "a new variable";
        if let Some((kind, _)) = self.taken.get(name.get_ref()).filter(|(kind, _)| *kind != KIND) {
            let message = format!("the new variable `{}` would be {kind} too", name.get_ref());
            let help = "give the new variables other names: new = [\"...\", \"...\"]";
            diagnostics.push(Diagnostic::error(name.span(), message).with_help(help));
            false
        } else {
            self.kind(name.get_ref()).is_some() || self.word(name, KIND, diagnostics)
        }
    }

    /// Claims a name that may be used in expressions; returns whether it is one.
    pub(super) fn word(
        &mut self,
        name: &Spanned<String>,
        kind: &'static str,
        diagnostics: &mut Diagnostics,
    ) -> bool {
        let written = name.get_ref();
        if is_word(written) {
            let before = self.taken.len();
            self.claim(name, kind, diagnostics);
            return self.taken.len() > before;
        }
        let message = format!("`{written}` cannot name {kind}");
        let rule = "a name is made of ASCII letters, digits and `_`, and begins with no digit";
        let plain: String =
            latex_of_unicode(written).chars().filter(|c| !"\\{} ".contains(*c)).collect();
        let help = if is_word(&plain) && !written.is_ascii() {
            format!("{rule}: write {plain} with symbol = \"{written}\"")
        } else {
            rule.to_owned()
        };
        diagnostics.push(Diagnostic::error(name.span(), message).with_help(help));
        false
    }

    /// Claims a name of any letters, which must be neither reserved nor taken.
    pub(super) fn claim(
        &mut self,
        name: &Spanned<String>,
        kind: &'static str,
        diagnostics: &mut Diagnostics,
    ) {
        let written = name.get_ref().as_str();
        if let Some(meaning) = self.reserved(written) {
            let message = format!("`{written}` cannot name {kind}: it is {meaning}");
            diagnostics
                .push(Diagnostic::error(name.span(), message).with_help("choose another name"));
        } else if let Some((first, place)) = self.taken.get(written) {
            report_twice(name, place.clone(), first, diagnostics);
        } else {
            self.taken.insert(written.to_owned(), (kind, name.span()));
        }
    }

    /// The kind of thing that already has this name, if any.
    pub(super) fn kind(&self, name: &str) -> Option<&'static str> {
        self.taken.get(name).map(|(kind, _)| *kind)
    }

    fn reserved(&self, name: &str) -> Option<String> {
        let of = |prefix: &str| {
            let coordinate = name.strip_prefix(prefix)?;
            self.coordinates.iter().find(|c| *c == coordinate)
        };
        let fixed = match name {
            "t" => "the time",
            "pi" => "the circle constant",
            "energy" => "the energy function",
            "action" => "the action",
            _ if FUNCTIONS.iter().any(|f| f.name == name) => "a function",
            _ => {
                let multiplies = self.multipliers.iter().find(|(_, written)| written == name);
                if let Some((constraint, _)) = multiplies {
                    return Some(format!("the multiplier of the constraint `{constraint}`"));
                }
                let moving = name.trim_end_matches('\'');
                return match of("p_").filter(|_| !self.poisson) {
                    Some(coordinate) => Some(format!("the momentum of `{coordinate}`")),
                    None if moving != name && self.coordinates.iter().any(|c| c == moving) => {
                        Some(format!("a rate of change of `{moving}`"))
                    }
                    None => None,
                };
            }
        };
        Some(fixed.to_owned())
    }
}

/// Reports a name that is already taken.
pub(super) fn report_twice(
    name: &Spanned<String>,
    first: SourceRange,
    kind: &str,
    diagnostics: &mut Diagnostics,
) {
    let message = format!("the name `{}` is given twice", name.get_ref());
    let diagnostic = Diagnostic::error(name.span(), message)
        .with_help("rename one of them")
        .with_also(first, format!("here it names {kind}"));
    diagnostics.push(diagnostic);
}

/// Whether expressions can use it as a name.
fn is_word(name: &str) -> bool {
    name.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_')
        && name.bytes().next().is_some_and(|b| !b.is_ascii_digit())
}
