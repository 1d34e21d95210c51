//! Where an evaluation lies relative to the kinks of a program.
//!
//! In: the values of its switches and of the functions under its roots. Out: whether two evaluations lie on the
//! same sides. Never here: where a kink is crossed.

use std::cmp::Ordering;

/// Values under a root that differ by more than this factor, while their arguments differ by rounding alone, lie
/// beside the point where the root vanishes.
const BESIDE: f64 = 100.0;

/// The sides of one evaluation.
#[derive(Clone, PartialEq, Debug)]
pub struct KinkSides {
    switches: Vec<Option<Ordering>>,
    roots: Vec<f64>,
}

impl KinkSides {
    pub(super) fn new(
        switches: impl Iterator<Item = f64>,
        roots: impl Iterator<Item = f64>,
    ) -> KinkSides {
        KinkSides { switches: switches.map(side).collect(), roots: roots.collect() }
    }

    /// Whether a switch whose value elsewhere is `value` lies on the same side here.
    pub fn has_switch_at(&self, i: usize, value: f64) -> bool {
        self.switches[i] == side(value)
    }

    /// Whether there are any kinks.
    pub fn any(&self) -> bool {
        !(self.switches.is_empty() && self.roots.is_empty())
    }

    /// The number of switches.
    pub fn switches(&self) -> usize {
        self.switches.len()
    }

    /// The switches, and the functions under roots, between whose sides here and elsewhere a kink lies.
    pub fn differences(&self, other: &KinkSides) -> (Vec<usize>, Vec<usize>) {
        let switches = (0..self.switches.len()).filter(|&i| self.switches[i] != other.switches[i]);
        let roots = (0..self.roots.len()).filter(|&i| !alike(self.roots[i], other.roots[i]));
        (switches.collect(), roots.collect())
    }

    /// Whether an evaluation nearby, at numbers that differ by rounding, has no kink between it and this one.
    /// A kink of a root may lie between values that differ in size.
    pub fn agrees(&self, other: &KinkSides) -> bool {
        let mut roots = self.roots.iter().zip(&other.roots);
        self.switches == other.switches && roots.all(|(&a, &b)| alike(a, b))
    }
}

/// Whether two values under a root lie on one side of where it vanishes.
fn alike(a: f64, b: f64) -> bool {
    let (a, b) = (a.abs(), b.abs());
    a.max(b) <= BESIDE * a.min(b)
}

fn side(value: f64) -> Option<Ordering> {
    value.partial_cmp(&0.0)
}
