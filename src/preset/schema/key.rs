//! What a table of the file is made of: its keys, the kinds of their values, and the keys that several tables have.
//!
//! In: what a kind of plot says of itself. Out: [`Key`], [`SchemaTable`]. Never here: the tables.

use ValueKind::{
    Brackets, Constant, Flag, Formula, Formulas, Kinds, List, Named, Names, Number, PlotKind,
    Point, Table, Tables, Text, Texts, Triple,
};

use crate::instrument::{INSTRUMENTS, Instrument, Properties, listed};

/// A table of the file, or of a list in it.
#[derive(Debug)]
pub(in crate::preset) struct SchemaTable {
    /// Its heading: `[run]`, `[[events]]`, or what its entries are called.
    pub(in crate::preset) head: &'static str,
    pub(in crate::preset) about: &'static str,
    /// Its keys in the order of reporting; empty if the file chooses the names.
    pub(in crate::preset) keys: &'static [Key],
}

#[derive(Clone, Copy, Debug)]
pub(in crate::preset) struct Key {
    pub(in crate::preset) name: &'static str,
    pub(in crate::preset) kind: ValueKind,
    /// The unit of its number; empty if it has none, or if the file determines it.
    pub(in crate::preset) unit: &'static str,
    /// The kinds of entries that may have it.
    pub(in crate::preset) only: Only,
    /// What to write if it is missing; `None` if it is optional.
    pub(in crate::preset) missing: Option<&'static str>,
    /// Its purpose, on one line.
    pub(in crate::preset) help: &'static str,
}

/// Which entries of a table may have a key.
#[derive(Clone, Copy, Debug)]
pub(in crate::preset) enum Only {
    All,
    /// Only entries of these kinds.
    Of(&'static [&'static str]),
    /// The views whose kind of plot has this property.
    Plots(fn(&Properties) -> bool),
}

impl Only {
    /// Whether an entry of this kind may have the key.
    pub(in crate::preset) fn allows(self, kind: &str) -> bool {
        matches!(self, Self::All) || self.kinds().contains(&kind)
    }

    /// The kinds that may have it, in their order; none if all may.
    pub(super) fn kinds(self) -> Vec<&'static str> {
        match self {
            Self::All => Vec::new(),
            Self::Of(kinds) => kinds.to_vec(),
            Self::Plots(has) => {
                let kinds = INSTRUMENTS.into_iter().filter(|kind| has(kind.properties()));
                kinds.map(Instrument::name).collect()
            }
        }
    }
}

#[derive(Clone, Copy, Debug)]
pub(in crate::preset) enum ValueKind {
    /// A text in quotes.
    Text,
    PlotKind,
    Texts,
    /// `true` or `false`.
    Flag,
    Number,
    /// A number, or an expression of numbers in quotes.
    Constant,
    /// A number or an expression in quotes.
    Formula,
    /// One or more formulas.
    Formulas,
    /// A list of two or three expressions.
    Point,
    /// A list of three expressions.
    Triple,
    /// Names chosen by the file, each with an expression.
    Names,
    /// A list of `[a, b, {a, b}]`.
    Brackets,
    Table(&'static SchemaTable),
    /// A table of names chosen by the file, each with such a table.
    Named(&'static SchemaTable),
    /// Tables, each under a heading in double brackets.
    Tables(&'static SchemaTable),
    /// Tables of several kinds, whose keys are known to their own readers.
    Kinds(&'static SchemaTable),
    List(&'static SchemaTable),
}

pub(super) const fn key(name: &'static str, kind: ValueKind, help: &'static str) -> Key {
    Key { name, kind, unit: "", only: Only::All, missing: None, help }
}

impl Key {
    pub(super) const fn needed(self, missing: &'static str) -> Key {
        Key { missing: Some(missing), ..self }
    }

    pub(super) const fn only(self, only: &'static [&'static str]) -> Key {
        Key { only: Only::Of(only), ..self }
    }

    pub(super) const fn of_plots(self, has: fn(&Properties) -> bool) -> Key {
        Key { only: Only::Plots(has), ..self }
    }

    /// Its purpose in words for users.
    pub(super) fn purpose(&self) -> String {
        match self.kind {
            PlotKind => listed("`", "or"),
            _ => self.help.to_owned(),
        }
    }

    pub(super) const fn unit(self, unit: &'static str) -> Key {
        Key { unit, ..self }
    }
}

pub(super) const NAME: Key = key("name", Text, "what it is called").needed("write name = \"...\"");
pub(super) const ABOUT: Key = key("about", Text, "what it is, shown beside it");
pub(super) const UNIT: Key = key("unit", Text, "its unit, for show");
pub(super) const SYMBOL: Key = key("symbol", Text, "the letters it is shown by");
pub(super) const SOURCE: Key = key("source", Text, "where the claim is from");
pub(super) const PERIOD: Key =
    key("period", Formula, "after which it is the same again; for drawing and rotations");
pub(super) const INITIAL: Key =
    key("initial", Formula, "its value at the start").needed("give its value at the start");
pub(super) const EXPRESSION: Key =
    key("expression", Formula, "what it is").needed("write expression = \"...\"");
pub(super) const AT: Key =
    key("at", Number, "the time").needed("give the time: at = 1.0").unit("time");
pub(super) const FORCES: Key =
    key("forces", Names, "generalised forces that come from no potential");
pub(super) const H: Key = key("H", Formula, "the Hamiltonian").needed("write H = \"T + V\"");

impl ValueKind {
    pub(super) fn words(self) -> &'static str {
        match self {
            Text | PlotKind => "text",
            Texts => "list of texts",
            Flag => "`true` or `false`",
            Number => "number",
            Constant => "number, or expression of numbers",
            Formula => "expression",
            Formulas => "expression, or list of them",
            Point => "two or three expressions",
            Triple => "three expressions",
            Names => "names, each with an expression",
            Brackets => "list of `[a, b, {a, b}]`",
            Table(_) => "table",
            Named(_) => "names, each with a table or a value",
            Tables(_) | Kinds(_) => "tables",
            List(_) => "list of tables",
        }
    }

    /// The nested table, if there is one.
    pub(in crate::preset) fn section(self) -> Option<&'static SchemaTable> {
        match self {
            Table(section) | Named(section) | Tables(section) | Kinds(section) | List(section) => {
                Some(section)
            }
            _ => None,
        }
    }
}
