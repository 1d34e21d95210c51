//! The second phase of an order of a Taylor series: every operation finished from its inner products.
//!
//! In: operations in the order of a program. Out: the same sorted by kind, so that one decision serves all of a
//! run. Never here: numbers, inner products, what an operation comes from.
//!
//! ```text
//!   of a program    scale  product  sum  product  scale  sum
//!                     │       │      └──────▶│             ▲       the second product needs the sum
//!   in runs         [scale  scale]  [product]  [sum]   ·   [product]  [sum]
//!                                round 0                     round 1
//! ```

use super::program::Register;

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum TermSign {
    Plus,
    Minus,
}

/// `f_k = c a_k`, where c depends on parameters only.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scaling {
    pub(super) register: Register,
    pub(super) fixed: Register,
    pub(super) varying: Register,
}

/// `f_k = Σ a_j b_{k−j}`, all but its ends in an inner product.
#[derive(Clone, Copy, Debug)]
pub(super) struct Product {
    pub(super) register: Register,
    pub(super) left: Register,
    pub(super) right: Register,
    pub(super) inner: u32,
}

/// An operation with a relation of the schedule's table.
#[derive(Clone, Copy, Debug)]
pub(super) struct Related {
    pub(super) register: Register,
    pub(super) relation: u32,
}

/// A relation of frequent shape, `k f_k = ± Σ j a_j b_{k−j}`: f′ = ± a′ b, as sine and cosine are.
#[derive(Clone, Copy, Debug)]
pub(super) struct Integral {
    pub(super) register: Register,
    pub(super) sign: TermSign,
    pub(super) slope: Register,
    pub(super) factor: Register,
    pub(super) inner: u32,
}

/// A sum of multiples, a range of the program's table of terms.
#[derive(Clone, Copy, Debug)]
pub(super) struct LinearSum {
    pub(super) register: Register,
    pub(super) first: u32,
    pub(super) count: u32,
}

/// Linear equations. The varying entries of the matrix are a range of the schedule's table; the inner products are
/// theirs.
#[derive(Clone, Copy, Debug)]
pub(super) struct LinearSolve {
    pub(super) register: Register,
    pub(super) block: u32,
    pub(super) first: u32,
    pub(super) count: u32,
    pub(super) inner: u32,
}

#[derive(Clone, Copy, Debug)]
pub(super) enum Step {
    Time(Register),
    Scale(Scaling),
    Product(Product),
    Related(Related),
    Integral(Integral),
    Sum(LinearSum),
    Solution(LinearSolve),
    /// An operation that is evaluated by itself.
    Alone(Register),
}

/// Operations of one kind, none of which needs one that stands behind it.
#[derive(Clone, Debug)]
pub(super) enum OperationRun {
    Time(Register),
    Scales(Vec<Scaling>),
    Products(Vec<Product>),
    Related(Vec<Related>),
    Integrals(Vec<Integral>),
    Sums(Vec<LinearSum>),
    Solution(LinearSolve),
    Alone(Register),
}

/// When an operation is finished: in which round, and which place its kind has there.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug, Default)]
struct FinishingTurn {
    round: u32,
    kind: u8,
}

/// The operations of a program as they are found, each with its turn.
#[derive(Debug)]
pub(super) struct Sorter {
    steps: Vec<(FinishingTurn, Step)>,
    /// The turn of every register that is written.
    turns: Vec<FinishingTurn>,
}

impl Sorter {
    /// For a program of so many registers.
    pub(super) fn new(registers: usize) -> Sorter {
        Sorter { steps: Vec::new(), turns: vec![FinishingTurn::default(); registers] }
    }

    /// Adds an operation that writes `count` registers and needs the operations before that write others.
    pub(super) fn add(
        &mut self,
        step: Step,
        count: usize,
        needs: impl IntoIterator<Item = Register>,
    ) {
        let (kind, register) = kind_and_register(&step);
        let latest = needs.into_iter().map(|r| self.turns[r as usize]).max().unwrap_or_default();
        let round = latest.round + u32::from(latest.kind > kind);
        let turn = FinishingTurn { round, kind };
        self.turns[register as usize..][..count].fill(turn);
        self.steps.push((turn, step));
    }

    /// The runs, in order.
    pub(super) fn runs(mut self) -> Vec<OperationRun> {
        // operations of one turn stay in the order of the program
        self.steps.sort_by_key(|&(turn, _)| turn);
        let mut runs: Vec<OperationRun> = Vec::new();
        for (_, step) in self.steps {
            match (runs.last_mut(), step) {
                (Some(OperationRun::Scales(run)), Step::Scale(step)) => run.push(step),
                (Some(OperationRun::Products(run)), Step::Product(step)) => run.push(step),
                (Some(OperationRun::Related(run)), Step::Related(step)) => run.push(step),
                (Some(OperationRun::Integrals(run)), Step::Integral(step)) => run.push(step),
                (Some(OperationRun::Sums(run)), Step::Sum(step)) => run.push(step),
                (_, step) => runs.push(OperationRun::of(step)),
            }
        }
        runs
    }
}

impl OperationRun {
    fn of(step: Step) -> OperationRun {
        match step {
            Step::Time(register) => OperationRun::Time(register),
            Step::Scale(step) => OperationRun::Scales(vec![step]),
            Step::Product(step) => OperationRun::Products(vec![step]),
            Step::Related(step) => OperationRun::Related(vec![step]),
            Step::Integral(step) => OperationRun::Integrals(vec![step]),
            Step::Sum(step) => OperationRun::Sums(vec![step]),
            Step::Solution(step) => OperationRun::Solution(step),
            Step::Alone(register) => OperationRun::Alone(register),
        }
    }
}

/// The place of an operation's kind in a round, and the first register that it writes.
fn kind_and_register(step: &Step) -> (u8, Register) {
    match *step {
        Step::Time(register) => (0, register),
        Step::Scale(Scaling { register, .. }) => (1, register),
        Step::Product(Product { register, .. }) => (2, register),
        Step::Related(Related { register, .. }) => (3, register),
        Step::Integral(Integral { register, .. }) => (4, register),
        Step::Sum(LinearSum { register, .. }) => (5, register),
        Step::Solution(LinearSolve { register, .. }) => (6, register),
        Step::Alone(register) => (7, register),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn product(register: Register, left: Register, right: Register) -> (Step, Vec<Register>) {
        (Step::Product(Product { register, left, right, inner: 0 }), vec![left, right])
    }

    fn scale(register: Register, varying: Register) -> (Step, Vec<Register>) {
        (Step::Scale(Scaling { register, fixed: 0, varying }), vec![varying])
    }

    fn sum(register: Register, needs: &[Register]) -> (Step, Vec<Register>) {
        let count = needs.len() as u32;
        (Step::Sum(LinearSum { register, first: 0, count }), needs.to_vec())
    }

    fn runs_of(steps: &[(Step, Vec<Register>)]) -> Vec<Vec<Register>> {
        let mut sorter = Sorter::new(16);
        for (step, needs) in steps {
            sorter.add(*step, 1, needs.iter().copied());
        }
        let written = |run: &OperationRun| match run {
            OperationRun::Time(register) | OperationRun::Alone(register) => vec![*register],
            OperationRun::Scales(run) => run.iter().map(|step| step.register).collect(),
            OperationRun::Products(run) => run.iter().map(|step| step.register).collect(),
            OperationRun::Related(run) => run.iter().map(|step| step.register).collect(),
            OperationRun::Integrals(run) => run.iter().map(|step| step.register).collect(),
            OperationRun::Sums(run) => run.iter().map(|step| step.register).collect(),
            OperationRun::Solution(step) => vec![step.register],
        };
        sorter.runs().iter().map(written).collect()
    }

    #[test]
    fn operations_of_one_kind_stand_together_behind_what_they_need() {
        // 0 and 1 are inputs
        let steps = [
            scale(2, 0),
            product(3, 2, 1),
            sum(4, &[3, 0]),
            product(5, 4, 4),
            scale(6, 1),
            sum(7, &[5, 6]),
            sum(8, &[7]),
        ];
        assert_eq!(runs_of(&steps), [vec![2, 6], vec![3], vec![4], vec![5], vec![7, 8]]);
    }

    #[test]
    fn what_waits_for_a_later_kind_is_in_a_later_round() {
        let steps = [sum(2, &[0]), scale(3, 2), sum(4, &[3]), scale(5, 0)];
        assert_eq!(runs_of(&steps), [vec![5], vec![2], vec![3], vec![4]]);
    }

    #[test]
    fn a_solution_is_known_in_all_its_registers() {
        let mut sorter = Sorter::new(8);
        sorter.add(
            Step::Solution(LinearSolve { register: 2, block: 0, first: 0, count: 0, inner: 0 }),
            2,
            [0, 1],
        );
        let (step, needs) = product(4, 3, 3);
        sorter.add(step, 1, needs);
        let runs = sorter.runs();
        assert!(
            matches!(runs[..], [OperationRun::Solution(_), OperationRun::Products(_)]),
            "{runs:?}"
        );
    }
}
