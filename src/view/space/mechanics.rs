//! The right mechanics and the wrong one beside it: which of the two a point moves with.
//!
//! In: the shapes of a picture, the symbols of the comparison. Out: the colours of the two motions. Never here: words.

use super::colours;
use crate::expr::{Pool, Symbol};
use crate::instrument::CameraPose;
use crate::model::{Point, Shape};
use crate::view::quantity::Quantities;

/// Two mechanics side by side, each with a trace.
pub(super) struct ComparedMechanics {
    /// The colours of the trace of the right one and of the wrong one.
    pub(super) colours: [usize; 2],
    symbols: Symbols,
}

/// What belongs to the wrong motion, and what to neither.
struct Symbols {
    wrong: Vec<Symbol>,
    neither: Vec<Symbol>,
}

impl ComparedMechanics {
    /// The two mechanics of a picture, or `None` where they are not compared or only one leaves a trace.
    pub(super) fn of(q: &Quantities<'_>, eye: CameraPose, points: &[Point]) -> Option<Self> {
        let (model, pool) = (&q.lab.loaded.model, &q.lab.loaded.equations.pool);
        let comparison = model.comparison.as_ref()?;
        let parameters = model.parameters.iter().map(|parameter| parameter.symbol);
        let symbols = Symbols {
            wrong: comparison.symbols.iter().flat_map(|&(place, rate)| [place, rate]).collect(),
            neither: parameters.chain([model.symbols.time]).collect(),
        };
        let trace = |wrong: bool| {
            q.lab.shapes(eye).find_map(|(shape, _)| match shape {
                Shape::Trace { at } => {
                    (symbols.is_wrong(pool, at)? == wrong).then(|| colours::colour(q, points, at))
                }
                _ => None,
            })
        };
        Some(Self { colours: [trace(false)?, trace(true)?], symbols })
    }

    /// The colour of the motion that a point moves with; `None` if it moves with neither.
    pub(super) fn colour(&self, pool: &Pool, at: &Point) -> Option<usize> {
        let wrong = self.symbols.is_wrong(pool, at)?;
        Some(self.colours[usize::from(wrong)])
    }
}

impl Symbols {
    /// Whether a point moves with the wrong mechanics, or with the right one; `None` if with neither.
    fn is_wrong(&self, pool: &Pool, at: &Point) -> Option<bool> {
        let all = at.iter().flat_map(|e| pool.symbols_of(*e));
        let symbols: Vec<Symbol> = all.filter(|symbol| !self.neither.contains(symbol)).collect();
        (!symbols.is_empty()).then(|| symbols.iter().any(|symbol| self.wrong.contains(symbol)))
    }
}
