//! Lowers expressions to a program: every canonical node becomes a few operations, equal
//! subexpressions share a register, and operations that depend only on parameters are collected
//! separately.

use std::sync::Arc;

use rustc_hash::FxHashMap;

use super::overflow;
use super::program::{Block, Guard, LinearTerm, Op, Program, Register, STEEPEST_FOLLOWED};
use crate::expr::{Expr, FunctionId, Pool, Symbol};
use crate::num::{DoubleDouble, Number};

/// A program under construction.
#[derive(Debug)]
pub(super) struct Lowering<'a> {
    pub(super) pool: &'a mut Pool,
    pub(super) program: Program,
    /// The register of every expression lowered, and of every symbol bound.
    pub(super) known: FxHashMap<Expr, Register>,
    /// The register of every operation emitted: equal operations share one.
    written: FxHashMap<Op, Register>,
    constants: FxHashMap<(u64, u64), u32>,
    pub(super) switches: Vec<Expr>,
    pub(super) unknown: Option<Symbol>,
    /// Whether the cut of `atan2` is a switch, as it must be for a motion that it drives.
    pub(super) cuts: bool,
}

impl<'a> Lowering<'a> {
    /// An empty program with the symbols of parameters and time bound.
    pub(super) fn new(pool: &'a mut Pool, parameters: &[Symbol], time: Symbol) -> Lowering<'a> {
        let mut lowering = Lowering {
            pool,
            program: Program::default(),
            known: FxHashMap::default(),
            written: FxHashMap::default(),
            constants: FxHashMap::default(),
            switches: Vec::new(),
            unknown: None,
            cuts: false,
        };
        lowering.constant_index(DoubleDouble::ZERO);
        for (i, &symbol) in parameters.iter().enumerate() {
            let register = lowering.push(Op::Parameter(i as u32));
            lowering.bind(symbol, register);
        }
        let register = lowering.push(Op::Time);
        lowering.bind(time, register);
        lowering
    }

    /// Treats the cut of `atan2` as a switching surface from here on.
    pub(super) fn switch_at_cuts(&mut self) {
        self.cuts = true;
    }

    pub(super) fn input(&mut self) -> Register {
        let register = self.push(Op::Input(self.program.inputs.len() as u32));
        self.program.inputs.push(register);
        register
    }

    pub(super) fn bind(&mut self, symbol: Symbol, register: Register) {
        let e = self.pool.variable(symbol);
        self.known.insert(e, register);
    }

    pub(super) fn variable(&mut self, symbol: Symbol) -> Register {
        let e = self.pool.variable(symbol);
        self.lower(e)
    }

    pub(super) fn lower(&mut self, e: Expr) -> Register {
        let mut stack = vec![(e, false)];
        while let Some((e, parts_done)) = stack.pop() {
            if self.known.contains_key(&e) {
                continue;
            }
            if parts_done {
                let register = self.lower_node(e);
                self.known.insert(e, register);
            } else {
                stack.push((e, true));
                self.pool.node(e).for_each_part(|part| stack.push((part, false)));
            }
        }
        self.known[&e]
    }

    pub(super) fn lower_all(&mut self, list: &[Expr]) -> Vec<Register> {
        list.iter().map(|&e| self.lower(e)).collect()
    }

    /// `a − b`.
    pub(super) fn difference(&mut self, a: Register, b: Register) -> Register {
        self.linear(Number::ZERO, &[(Number::ONE, a), (Number::MINUS_ONE, b)])
    }

    /// `−a`.
    pub(super) fn negative(&mut self, a: Register) -> Register {
        self.linear(Number::ZERO, &[(Number::MINUS_ONE, a)])
    }

    /// Σ row_i · x_i.
    pub(super) fn inner_product(&mut self, row: &[Expr], x: &[Register]) -> Register {
        let mut terms = Vec::new();
        for (&a, &x) in row.iter().zip(x) {
            match a {
                Expr::ZERO => {}
                Expr::ONE => terms.push((Number::ONE, x)),
                _ => {
                    let a = self.lower(a);
                    terms.push((Number::ONE, self.multiply(a, x)));
                }
            }
        }
        self.linear(Number::ZERO, &terms)
    }

    /// The registers of the solution of `matrix · x = right`. Blocks of unknowns that are not
    /// coupled are solved separately.
    pub(super) fn solve(&mut self, matrix: &[Vec<Expr>], right: &[Register]) -> Vec<Register> {
        let n = right.len();
        let mut solution = right.to_vec();
        let mut done = vec![false; n];
        for start in 0..n {
            if done[start] {
                continue;
            }
            let mut members = vec![start];
            done[start] = true;
            let mut next = 0;
            while let Some(&i) = members.get(next) {
                for j in 0..n {
                    let connected = matrix[i][j] != Expr::ZERO || matrix[j][i] != Expr::ZERO;
                    if connected && !done[j] {
                        done[j] = true;
                        members.push(j);
                    }
                }
                next += 1;
            }
            members.sort_unstable();
            self.solve_block(matrix, right, &members, &mut solution);
        }
        solution
    }

    fn solve_block(
        &mut self,
        matrix: &[Vec<Expr>],
        right: &[Register],
        members: &[usize],
        solution: &mut [Register],
    ) {
        if let &[i] = members
            && matrix[i][i] == Expr::ONE
        {
            solution[i] = right[i];
            return;
        }
        let mut block = Block { matrix: Vec::new(), right: Vec::new(), inputs: Vec::new() };
        let mut entries = Vec::new();
        for &i in members {
            block.right.push(right[i]);
            for &j in members {
                entries.push(matrix[i][j]);
                block.matrix.push(self.lower(matrix[i][j]));
            }
        }
        let reached = self.pool.reachable(&entries);
        let registers: Vec<Register> =
            reached.iter().filter_map(|e| self.known.get(e).copied()).collect();
        block.inputs = (0..self.program.inputs.len())
            .filter(|&i| registers.contains(&self.program.inputs[i]))
            .collect();
        let first = self.push(Op::Solve(self.program.blocks.len() as u32));
        self.program.blocks.push(block);
        for _ in 1..members.len() {
            self.push(Op::Written);
        }
        for (place, &i) in members.iter().enumerate() {
            solution[i] = first + place as u32;
        }
    }

    /// Returns the finished program, or a symbol that is not bound.
    pub(super) fn finish(mut self, outputs: Vec<Register>) -> Result<Arc<Program>, Symbol> {
        if let Some(symbol) = self.unknown {
            return Err(symbol);
        }
        self.program.outputs = outputs;
        let live = self.program.live();
        for (r, op) in self.program.ops.iter().enumerate() {
            match (op, self.program.fixed[r]) {
                (Op::Written | Op::Input(_), _) => {}
                _ if !live[r] => {}
                (_, true) => self.program.prologue.push(r as u32),
                (_, false) => self.program.body.push(r as u32),
            }
        }
        let guards = self.program.body.iter().filter_map(|&r| guard(&self.program, r));
        self.program.guards = guards.collect();
        self.program.hiding = overflow::hiding(&self.program);
        Ok(Arc::new(self.program))
    }

    pub(super) fn push(&mut self, op: Op) -> Register {
        if let (Some(&register), false) = (self.written.get(&op), op == Op::Written) {
            return register;
        }
        let register = self.program.ops.len() as u32;
        let fixed = match op {
            Op::Constant(_) | Op::Parameter(_) => true,
            Op::Time | Op::Input(_) | Op::Solve(_) => false,
            Op::Linear { first, count, .. } => self.program.terms
                [first as usize..(first + count) as usize]
                .iter()
                .all(|term| self.is_fixed(term.register)),
            Op::Scale(a, b) | Op::Multiply(a, b) | Op::Divide(a, b) | Op::ParametricPower(a, b) => {
                self.is_fixed(a) && self.is_fixed(b)
            }
            Op::Square(a) | Op::Root(a) | Op::Power(a, _) => self.is_fixed(a),
            Op::Call(_, [a, b]) => self.is_fixed(a) && self.is_fixed(b),
            Op::Select { switch, positive, negative, .. } => {
                [switch, positive, negative].iter().all(|&r| self.is_fixed(r))
            }
            Op::Written => self.program.fixed[register as usize - 1],
        };
        self.program.ops.push(op);
        self.program.fixed.push(fixed);
        if op != Op::Written {
            self.written.insert(op, register);
        }
        register
    }

    pub(super) fn is_fixed(&self, register: Register) -> bool {
        self.program.fixed[register as usize]
    }

    pub(super) fn constant_index(&mut self, x: DoubleDouble) -> u32 {
        let key = (x.high.to_bits(), x.low.to_bits());
        let next = self.program.constants.len() as u32;
        let index = *self.constants.entry(key).or_insert(next);
        if index == next {
            self.program.constants.push(x);
        }
        index
    }

    pub(super) fn constant(&mut self, x: DoubleDouble) -> Register {
        let index = self.constant_index(x);
        self.push(Op::Constant(index))
    }

    pub(super) fn linear(&mut self, constant: Number, terms: &[(Number, Register)]) -> Register {
        let first = self.program.terms.len() as u32;
        for &(c, register) in terms {
            self.program.terms.push(LinearTerm { coefficient: c.double(), register });
        }
        let constant = self.constant_index(constant.double());
        self.push(Op::Linear { constant, first, count: terms.len() as u32 })
    }

    pub(super) fn multiply(&mut self, a: Register, b: Register) -> Register {
        match (self.is_fixed(a), self.is_fixed(b)) {
            _ if a == b => self.push(Op::Square(a)),
            (true, false) => self.push(Op::Scale(a, b)),
            (false, true) => self.push(Op::Scale(b, a)),
            _ => self.push(Op::Multiply(a.min(b), a.max(b))),
        }
    }

    /// Returns `base^n` for n ≥ 1 by repeated squaring.
    pub(super) fn integer_power(&mut self, base: Register, n: u64) -> Register {
        match n {
            1 => base,
            _ if n.is_multiple_of(2) => {
                let root = self.integer_power(base, n / 2);
                self.push(Op::Square(root))
            }
            _ => {
                let rest = self.integer_power(base, n - 1);
                self.multiply(base, rest)
            }
        }
    }
}

impl Program {
    /// Compiles expressions of a pool, as functions of parameters, time and inputs.
    ///
    /// # Errors
    /// Returns the first symbol that is none of these.
    pub fn compile(
        pool: &mut Pool,
        parameters: &[Symbol],
        time: Symbol,
        inputs: &[Symbol],
        outputs: &[Expr],
    ) -> Result<Arc<Program>, Symbol> {
        let mut lowering = Lowering::new(pool, parameters, time);
        for &symbol in inputs {
            let register = lowering.input();
            lowering.bind(symbol, register);
        }
        let outputs = lowering.lower_all(outputs);
        lowering.finish(outputs)
    }
}

/// The guard of an operation, if it needs one. No motion continues through the zero of an argument whose power is the
/// inverse or a higher one: it meets a pole, or passes it closely.
fn guard(program: &Program, r: Register) -> Option<Guard> {
    match program.ops[r as usize] {
        Op::Root(under) => {
            let argument = Some(under);
            Some(Guard { value: r, argument, under: argument, passes: true, exponent: None })
        }
        Op::Power(under, exponent) => {
            let exponent = program.constants[exponent as usize].high;
            Some(Guard {
                value: r,
                argument: Some(under).filter(|_| exponent.abs() <= STEEPEST_FOLLOWED),
                under: Some(under).filter(|_| exponent > -1.0),
                passes: false,
                exponent: None,
            })
        }
        // how steep it is the parameters say
        Op::ParametricPower(under, exponent) => Some(Guard {
            value: r,
            argument: Some(under),
            under: Some(under),
            passes: false,
            exponent: Some(exponent),
        }),
        Op::Call(FunctionId::Asin | FunctionId::Acos, _) => {
            Some(Guard { value: r + 1, argument: None, under: None, passes: true, exponent: None })
        }
        _ => None,
    }
}
