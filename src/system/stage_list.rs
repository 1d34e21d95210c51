//! The steps of a splitting method as one straight list of instructions: the operations of both
//! halves of the motion and the sums between them, on one file of registers that holds the state.
//!
//! ```text
//! registers   moved by T alone │ by V alone │ by both │ the operations, each rate where it is added
//!
//! open        kick · its sums
//! step        (drift · its sums · kick · its sums)… · the last sums of a step and the first of the next
//! end         the same without the sums of the next step, which are
//! lead
//! ```
//!
//! A step of symplectic Euler is kick · its sums · drift · its sums, with nothing to open or to lead.
//!
//! In: the programs of both halves, the weights of the composition. Out: instructions. Never here:
//! numbers, and systems whose halves depend on time: these are evaluated operation by operation.

use super::instruction::{Instruction, Moved};
use super::rates::Rates;
use super::register_map::RegisterMap;

/// The composition of a step of kicks by V and drifts by T.
#[derive(Clone, PartialEq, Debug)]
pub enum Composition {
    /// Leapfrogs with these parts of the step, one after the other.
    Leapfrogs(Vec<f64>),
    /// A whole kick, then a whole drift.
    KickDrift,
}

/// The instructions of one method and system. The drift is the first program of its registers, the kick the second.
#[derive(Clone, Debug)]
pub(super) struct StageList {
    pub(super) map: RegisterMap,
    pub(super) open: Vec<Instruction>,
    pub(super) step: Vec<Instruction>,
    pub(super) end: Vec<Instruction>,
    pub(super) lead: Vec<Instruction>,
    composition: Composition,
}

impl StageList {
    /// The list for the rates under T alone and under V alone. Returns `None` where V depends on time, and where there are
    /// more numbers than registers.
    pub(super) fn new(drift: &Rates, kick: &Rates, composition: &Composition) -> Option<StageList> {
        let count = drift.system().state_len();
        let is_moved = |half: &Rates, i: usize| half.places.contains(&i);
        let group = |by: [bool; 2]| {
            (0..count)
                .filter(|&i| [is_moved(drift, i), is_moved(kick, i)] == by)
                .collect::<Vec<usize>>()
        };
        let own = [group([true, false]), group([false, true])];
        let (both, neither) = (group([true, true]), group([false, false]));
        let mut list = StageList {
            map: RegisterMap::new([&own[0], &own[1], &both, &neither], false)?,
            open: Vec::new(),
            step: Vec::new(),
            end: Vec::new(),
            lead: Vec::new(),
            composition: composition.clone(),
        };
        let drift = list.map.lower(drift.outputs(), [&own[0], &both])?;
        let kick = list.map.lower(kick.outputs(), [&own[1], &both])?;
        match composition {
            Composition::Leapfrogs(weights) => list.put_together(weights.len(), &drift, &kick)?,
            Composition::KickDrift => {
                let (ends, sums) = (moves(&kick.1, 0), moves(&drift.1, 1));
                list.end = [kick.0, ends, drift.0, sums].concat();
                list.step.clone_from(&list.end);
            }
        }
        Some(list)
    }

    /// Puts the parts of a step of so many leapfrogs together. The kicks have the factors 0, 2, 4, …, the drifts between
    /// them 1, 3, 5, …
    fn put_together(
        &mut self,
        leapfrogs: usize,
        (drift, drifted): &Half,
        (kick, kicked): &Half,
    ) -> Option<()> {
        let last = u8::try_from(2 * leapfrogs).ok()?;
        let mut stages = Vec::new();
        for factor in (1..last).step_by(2) {
            stages.extend_from_slice(drift);
            stages.extend(moves(drifted, factor));
            stages.extend_from_slice(kick);
            if factor + 1 < last {
                stages.extend(moves(kicked, factor + 1));
            }
        }
        let turn = kicked.iter().map(|&moved| Instruction::MoveTwice { factors: [last, 0], moved });
        self.lead = moves(kicked, 0);
        self.open = [&kick[..], &self.lead].concat();
        self.end = [stages.clone(), moves(kicked, last)].concat();
        self.step = stages.into_iter().chain(turn).collect();
        Some(())
    }

    pub(super) fn factors(&self, step: f64) -> impl Iterator<Item = f64> + '_ {
        let (weights, whole) = match &self.composition {
            Composition::Leapfrogs(weights) => (&weights[..], 0),
            Composition::KickDrift => (&[][..], 2),
        };
        let before = std::iter::once(&0.0).chain(weights);
        let inner = weights.iter().zip(before);
        let inner = inner.flat_map(move |(&w, before)| [0.5 * (before + w) * step, w * step]);
        let last = weights.last().map(|w| 0.5 * w * step);
        inner.chain(last).chain(std::iter::repeat_n(step, whole))
    }
}

/// The instructions of the rates of a half, and what they move.
type Half = (Vec<Instruction>, Vec<Moved>);

/// The sums that move numbers by a factor times their rates.
fn moves(moved: &[Moved], factor: u8) -> Vec<Instruction> {
    moved.iter().map(|&moved| Instruction::Move { factor, moved }).collect()
}
