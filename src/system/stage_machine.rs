//! Runs the instructions of a [`StageList`] step after step, for one orbit or for several at once.
//!
//! In: instructions, registers. Out: registers after many steps, with the bits that single steps
//! give. Never here: which steps, numbers that leave the range of `f64`.

use super::registers::{Registers, StageNumber};
use super::stage_list::StageList;
use crate::num::Kernel;

/// Many steps. `seen` is handed the count of steps so far and the registers at the end of each step
/// from `from` on.
pub(super) struct StageSteps<'a, R, F> {
    pub(super) registers: &'a mut Registers<R>,
    pub(super) stages: &'a StageList,
    pub(super) count: u64,
    pub(super) from: u64,
    pub(super) seen: F,
}

impl<R: StageNumber, F: FnMut(u64, &Registers<R>)> Kernel for StageSteps<'_, R, F> {
    type Output = ();
    const OF_SEVERAL: bool = R::OF_SEVERAL;

    #[inline(always)]
    fn run<const FUSED: bool>(mut self) {
        let (stages, from) = (self.stages, self.from.min(self.count));
        let (mut done, mut list, mut ends) = (0, &stages.open, false);
        loop {
            self.registers.run(&stages.map, list);
            if ends {
                (self.seen)(done, self.registers);
                if done == self.count {
                    return;
                }
                (list, ends) = (&stages.lead, false);
                continue;
            }
            done += 1;
            ends = done >= from;
            list = if ends { &stages.end } else { &stages.step };
        }
    }
}
