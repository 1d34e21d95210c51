//! The unit of time, as far as the units of a file determine it.
//!
//! In: the units of coordinates and parameters, which are only text. Out: `s`, `yr`, `d` or an
//! empty text. Never here: conversion, which is never needed: the numbers of a file are in its own
//! units throughout.

use super::Model;

/// Units that are or contain a time, each with its unit of time.
const TIMES: [(&str, &str); 12] = [
    ("s", "s"),
    ("Hz", "s"),
    ("N", "s"),
    ("J", "s"),
    ("W", "s"),
    ("dyn", "s"),
    ("erg", "s"),
    ("esu", "s"),
    ("G", "s"),
    ("yr", "yr"),
    ("d", "d"),
    ("h", "h"),
];

impl Model {
    /// The unit of time on which the units of coordinates and parameters agree; empty if they do
    /// not.
    pub fn time_unit(&self) -> &'static str {
        let coordinates = self.coordinates.iter().map(|c| &c.unit);
        let units = coordinates.chain(self.parameters.iter().map(|p| &p.unit));
        let words = units.flat_map(|unit| unit.split(|c: char| !c.is_ascii_alphabetic()));
        let named = |word: &str| TIMES.iter().find(|(unit, _)| *unit == word).map(|(_, t)| *t);
        let mut times = words.filter_map(named);
        let Some(first) = times.next() else { return "" };
        if times.all(|time| time == first) { first } else { "" }
    }
}
