//! The function of all orders of a series.
//!
//! In: a program with its schedule, the orders in both precisions. Out: its function, and what must hold where it is called.
//! Never here: one order, one instruction.

use super::allocation::assemble;
use super::arithmetic::{Arithmetic, Code};
use super::basic_block::{MachineInstruction, Width};
use super::double::Double;
use super::emitter::Emitter;
use super::function::{CompiledFunction, NotCompiled, WorkMemory};
use super::layout::{Address, Area, FactoredPlace, Precision, SeriesPlaces};
use super::plain::{Lanes, Plain};
use crate::num::BATCH;
use crate::system::jet::JetPlan;
use crate::system::program::{Op, Register};
use crate::system::schedule::Denominator;

/// No more instructions are generated than about this many, half a megabyte: more than a core's second-level cache holds would be
/// slower to read than the loops of a jet.
const LARGEST: usize = 75_000;

/// How many numbers of how many orbits are computed.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct SeriesExtent {
    /// The orbits that one call serves.
    pub(super) orbits: Width,
    /// The numbers of the state, and those of them that the rates depend on.
    pub(super) numbers: usize,
    pub(super) inputs: usize,
}

/// A function and what it is called with.
#[derive(Debug)]
pub(super) struct Compiled {
    pub(super) function: CompiledFunction,
    /// The stretch of work as it is at first.
    pub(super) work: WorkMemory,
    pub(super) scale: Address,
    /// Where order 0 of all registers in `f64` begins.
    pub(super) values: Address,
    /// The matrices in `f64`, and the exact ones.
    pub(super) factored: Vec<FactoredPlace>,
    pub(super) exactly_factored: Vec<FactoredPlace>,
    /// The registers whose series would be compared with zero: the code takes it that their values are not zero.
    pub(super) vanishing: Vec<Register>,
    /// The registers that are divided by: the code takes it that their values have
    /// [reciprocals](crate::num::DoubleDouble::has_reciprocal).
    pub(super) divisors: Vec<Register>,
}

/// Compiles the orders of a series, of which an exact jet computes the lowest.
pub(super) fn compile(
    plan: &JetPlan<'_>,
    exact: Option<&JetPlan<'_>>,
    extent: SeriesExtent,
) -> Result<Compiled, NotCompiled> {
    let program = plan.program;
    let alone = |op: &Op| matches!(op, Op::Select { .. } | Op::ParametricPower(..));
    if program.ops.iter().any(alone) || program.switches() > 0 || size(plan) > LARGEST {
        return Err(NotCompiled);
    }
    let first = exact.map_or(2, |exact| exact.stride);
    if !(2..=plan.stride).contains(&first) {
        return Err(NotCompiled);
    }
    let mut code = Code::new(extent.orbits);
    let (places, exactly_factored) = if extent.orbits == Width::One {
        write_one(plan, exact, &mut code, extent)?
    } else {
        (write_lanes(plan, &mut code, extent)?, Vec::new())
    };
    let mut first_work = code.layout.first_work();
    if code.block.instructions.len() > LARGEST {
        return Err(NotCompiled);
    }
    // each call for a part of several orbits has a part of every slot
    let lanes = extent.orbits.numbers();
    let slot = if lanes > 1 { BATCH } else { 1 };
    let (bytes, work) = assemble(&code.block, first_work.len(), slot);
    first_work.resize(work, 0.0);
    let (size, exact_stride) = (places.size, exact.map_or(0, |exact| exact.stride));
    let length = |area| match area {
        Area::Values => plan.values * exact.map_or(size, |_| Double::SIZE),
        Area::Work => work,
        Area::Series => plan.series * size,
        Area::State => extent.numbers * plan.stride * size,
        Area::ExactSeries => exact.map_or(0, |exact| exact.series * Double::SIZE),
        Area::ExactState => extent.numbers * exact_stride * Double::SIZE,
    };
    let mut accesses =
        code.block.instructions.iter().flat_map(MachineInstruction::memory).flatten();
    if accesses.any(|(at, count)| at.offset + count + (slot - lanes) > length(at.area)) {
        return Err(NotCompiled);
    }
    let relations = &plan.schedule.relations;
    let divisor = |denominator| match denominator {
        Denominator::One | Denominator::Order => None,
        Denominator::Value(a) | Denominator::OrderTimes(a) | Denominator::Twice(a) => Some(a),
    };
    Ok(Compiled {
        function: CompiledFunction::of(&bytes, code.lanes, length)?,
        work: WorkMemory::of(&first_work),
        scale: code.layout.scale,
        values: places.values,
        factored: places.factored,
        exactly_factored,
        vanishing: relations.iter().filter_map(|r| r.vanishing).collect(),
        divisors: relations.iter().filter_map(|r| divisor(r.denominator)).collect(),
    })
}

/// Writes the orders of one orbit. Returns their places, and those of exact matrices.
fn write_one(
    plan: &JetPlan<'_>,
    exact: Option<&JetPlan<'_>>,
    code: &mut Code,
    extent: SeriesExtent,
) -> Result<(SeriesPlaces, Vec<FactoredPlace>), NotCompiled> {
    let numbers = (extent.numbers, extent.inputs);
    let exact_places = exact.map(|exact| {
        let (stride, areas) = (exact.stride, (Area::ExactSeries, Area::ExactState));
        code.layout.series(exact, precision_of::<Double>(stride, areas))
    });
    let precision = precision_of::<Plain>(plan.stride, (Area::Series, Area::State));
    let precision = Precision { copies_values: exact.is_some(), ..precision };
    let places = code.layout.series(plan, precision);
    let mut first = 0;
    if let (Some(exact), Some(own)) = (exact, &exact_places) {
        first = exact.stride - 1;
        Emitter::<Double>::new(exact, code, (own, Some(&places)), numbers).write(0, first)?;
    }
    Emitter::<Plain>::new(plan, code, (&places, None), numbers).write(first, plan.stride - 1)?;
    Ok((places, exact_places.map_or_else(Vec::new, |places| places.factored)))
}

/// Writes the orders of several orbits.
fn write_lanes(
    plan: &JetPlan<'_>,
    code: &mut Code,
    extent: SeriesExtent,
) -> Result<SeriesPlaces, NotCompiled> {
    let precision = precision_of::<Lanes>(plan.stride, (Area::Series, Area::State));
    let places = code.layout.series(plan, precision);
    let numbers = (extent.numbers, extent.inputs);
    Emitter::<Lanes>::new(plan, code, (&places, None), numbers).write(0, plan.stride - 1)?;
    Ok(places)
}

/// What an arithmetic needs for so many orders of the series and the state in these areas.
fn precision_of<A: Arithmetic>(stride: usize, areas: (Area, Area)) -> Precision {
    Precision { size: A::SIZE, side: A::SIDE, stride, copies_values: false, areas }
}

/// About how many instructions there will be.
fn size(plan: &JetPlan<'_>) -> usize {
    let (pairs, operations) = (plan.schedule.pairs.len(), plan.program.body.len());
    (plan.stride - 1) * (pairs * 9 + operations * 6)
}
