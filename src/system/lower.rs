//! From expressions to a program: every canonical node becomes a few operations, equal parts one
//! register; what depends on parameters only is gathered apart.

use std::collections::HashMap;
use std::sync::Arc;

use super::program::{Block, Guard, LIVE_POWER_BITS, Op, Program, Register, Term};
use crate::expr::{Branches, Expr, FunctionId, Node, Pool, Rule, Symbol};
use crate::num::{DoubleDouble, Number};

/// A program being written.
#[derive(Debug)]
pub(super) struct Lowering<'a> {
    pool: &'a mut Pool,
    program: Program,
    /// The register of every expression lowered, and of every symbol bound.
    known: HashMap<Expr, Register>,
    /// The register of every operation written: equal operations are one.
    written: HashMap<Op, Register>,
    constants: HashMap<(u64, u64), u32>,
    /// The expression of each switch.
    switches: Vec<Expr>,
    unknown: Option<Symbol>,
    /// Whether the cut of `atan2` is a switch, as it is to a motion that is pushed by it.
    cuts: bool,
}

impl<'a> Lowering<'a> {
    /// An empty program; the symbols of parameters and time are bound.
    pub(super) fn new(pool: &'a mut Pool, parameters: &[Symbol], time: Symbol) -> Lowering<'a> {
        let mut lowering = Lowering {
            pool,
            program: Program::default(),
            known: HashMap::new(),
            written: HashMap::new(),
            constants: HashMap::new(),
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

    /// From here on the cut of `atan2` is a switching surface.
    pub(super) fn switch_at_cuts(&mut self) {
        self.cuts = true;
    }

    /// The next input.
    pub(super) fn input(&mut self) -> Register {
        let register = self.push(Op::Input(self.program.inputs.len() as u32));
        self.program.inputs.push(register);
        register
    }

    /// From here on the symbol stands for the register.
    pub(super) fn bind(&mut self, symbol: Symbol, register: Register) {
        let e = self.pool.variable(symbol);
        self.known.insert(e, register);
    }

    /// The register of a symbol.
    pub(super) fn variable(&mut self, symbol: Symbol) -> Register {
        let e = self.pool.variable(symbol);
        self.lower(e)
    }

    /// The register of an expression.
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
                stack.extend(self.pool.node(e).parts().into_iter().map(|part| (part, false)));
            }
        }
        self.known[&e]
    }

    /// Registers of all expressions of a list.
    pub(super) fn lower_all(&mut self, list: &[Expr]) -> Vec<Register> {
        list.iter().map(|&e| self.lower(e)).collect()
    }

    /// `a − b`.
    pub(super) fn difference(&mut self, a: Register, b: Register) -> Register {
        self.linear(Number::ZERO, &[(Number::ONE, a), (Number::MINUS_ONE, b)])
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

    /// The registers of the solution of `matrix · x = right`. Unknowns that no chain of entries
    /// connects are solved for apart.
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

    /// The finished program, or the symbol that stands for nothing.
    pub(super) fn finish(mut self, outputs: Vec<Register>) -> Result<Arc<Program>, Symbol> {
        if let Some(symbol) = self.unknown {
            return Err(symbol);
        }
        self.program.outputs = outputs;
        for (r, op) in self.program.ops.iter().enumerate() {
            match (op, self.program.fixed[r]) {
                (Op::Written | Op::Input(_), _) => {}
                (_, true) => self.program.prologue.push(r as u32),
                (_, false) => self.program.body.push(r as u32),
            }
        }
        let guards = self.program.body.iter().filter_map(|&r| guard(&self.program.ops, r));
        self.program.guards = guards.collect();
        Ok(Arc::new(self.program))
    }

    fn push(&mut self, op: Op) -> Register {
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

    fn is_fixed(&self, register: Register) -> bool {
        self.program.fixed[register as usize]
    }

    fn constant_index(&mut self, x: DoubleDouble) -> u32 {
        let key = (x.high.to_bits(), x.low.to_bits());
        let next = self.program.constants.len() as u32;
        let index = *self.constants.entry(key).or_insert(next);
        if index == next {
            self.program.constants.push(x);
        }
        index
    }

    fn constant(&mut self, x: DoubleDouble) -> Register {
        let index = self.constant_index(x);
        self.push(Op::Constant(index))
    }

    fn linear(&mut self, constant: Number, terms: &[(Number, Register)]) -> Register {
        let first = self.program.terms.len() as u32;
        for &(c, register) in terms {
            self.program.terms.push(Term { coefficient: c.double(), register });
        }
        let constant = self.constant_index(constant.double());
        self.push(Op::Linear { constant, first, count: terms.len() as u32 })
    }

    fn multiply(&mut self, a: Register, b: Register) -> Register {
        match (self.is_fixed(a), self.is_fixed(b)) {
            _ if a == b => self.push(Op::Square(a)),
            (true, false) => self.push(Op::Scale(a, b)),
            (false, true) => self.push(Op::Scale(b, a)),
            _ => self.push(Op::Multiply(a.min(b), a.max(b))),
        }
    }

    /// `base^n` for n ≥ 1 by squares.
    fn integer_power(&mut self, base: Register, n: u64) -> Register {
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

    fn lower_node(&mut self, e: Expr) -> Register {
        match self.pool.node(e).clone() {
            Node::Number(n) => self.constant(n.double()),
            Node::Pi => self.constant(DoubleDouble::PI),
            Node::Symbol(symbol) => {
                self.unknown.get_or_insert(symbol);
                self.constant(DoubleDouble::from(f64::NAN))
            }
            Node::Sum(constant, terms) => {
                let terms: Vec<(Number, Register)> =
                    terms.iter().map(|(c, t)| (*c, self.known[t])).collect();
                self.linear(constant, &terms)
            }
            Node::Product(coefficient, factors) => self.lower_product(coefficient, &factors),
            Node::Power(base, exponent) => {
                let (base, exponent) = (self.known[&base], self.known[&exponent]);
                self.lower_power(base, exponent)
            }
            Node::Call(function, arguments) => self.lower_call(function, &arguments),
        }
    }

    /// `coefficient · Π base^exponent`: what depends on parameters only is joined to one factor.
    fn lower_product(&mut self, coefficient: Number, factors: &[(Expr, Number)]) -> Register {
        if let Some(opened) = self.open_squares(coefficient, factors) {
            return self.lower(opened);
        }
        // [fixed above, fixed below, varying above, varying below]
        let mut parts: [Option<Register>; 4] = [None; 4];
        for &(base, exponent) in factors {
            let (register, inverse) = self.lower_factor(base, exponent);
            let place = 2 * usize::from(!self.is_fixed(register)) + usize::from(inverse);
            let joined = parts[place].map_or(register, |old| self.multiply(old, register));
            parts[place] = Some(joined);
        }
        let mut fixed = (!coefficient.is_one()).then(|| self.constant(coefficient.double()));
        if let Some(above) = parts[0] {
            fixed = Some(fixed.map_or(above, |c| self.multiply(c, above)));
        }
        if let Some(below) = parts[1] {
            let above = fixed.unwrap_or_else(|| self.constant(DoubleDouble::ONE));
            fixed = Some(self.push(Op::Divide(above, below)));
        }
        let above = match (fixed, parts[2]) {
            (Some(fixed), Some(above)) => self.multiply(fixed, above),
            (Some(one), None) | (None, Some(one)) => one,
            (None, None) => self.constant(DoubleDouble::ONE),
        };
        parts[3].map_or(above, |below| self.push(Op::Divide(above, below)))
    }

    /// A power with a numeric exponent; true where it belongs below the line.
    fn lower_factor(&mut self, base: Expr, exponent: Number) -> (Register, bool) {
        if let Some(n) = exponent.as_integer() {
            let base = self.known[&base];
            return (self.integer_power(base, n.unsigned_abs()), n < 0);
        }
        let base = self.known[&base];
        if exponent.abs() == Number::HALF {
            return (self.push(Op::Root(base)), exponent.is_negative());
        }
        let whole = exponent + -Number::HALF;
        if let Some(n @ 1..) = whole.as_integer() {
            // the root passes zero as it is, where its cube would touch it
            let (root, rest) = (self.push(Op::Root(base)), self.integer_power(base, n as u64));
            return (self.multiply(root, rest), false);
        }
        let exponent = self.constant_index(exponent.double());
        (self.push(Op::Power(base, exponent)), false)
    }

    /// A product in which roots of squares are written as what they are, if it has any:
    /// `(b² c)^α = |b|^{2α} c^α`, and an odd power of `|b|` is `sign(b)` times that of `b`, so that
    /// `x/√(x²)` is a sign also where it is 0/0. The kink at `b = 0` becomes one that is located.
    fn open_squares(&mut self, coefficient: Number, factors: &[(Expr, Number)]) -> Option<Expr> {
        let even = |n: Number| n.as_integer().is_some_and(|n| n % 2 == 0);
        let mut opened = Vec::new();
        let mut any = false;
        for &(base, exponent) in factors {
            let inner = match self.pool.node(base).clone() {
                Node::Product(c, inner) if exponent.as_integer().is_none() => (c, inner),
                Node::Call(FunctionId::Abs, arguments) => {
                    let b = arguments[0];
                    let own = factors.iter().find(|&&(other, _)| other == b).map(|&(_, m)| m);
                    match (own.filter(|m| m.as_integer().is_some()), exponent.as_integer()) {
                        // 1/|b| = sign(b)/b, and b |b|^α = sign(b) |b|^(1 + α)
                        (Some(_), Some(n)) if n % 2 != 0 => {
                            opened.push((self.pool.call(FunctionId::Sign, &[b]), Number::ONE));
                            opened.push((b, exponent));
                            any = true;
                        }
                        (Some(m), None) => {
                            if !even(m) {
                                opened.push((self.pool.call(FunctionId::Sign, &[b]), Number::ONE));
                            }
                            opened.push((base, m));
                            opened.push((b, -m));
                            opened.push((base, exponent));
                            any = true;
                        }
                        _ => opened.push((base, exponent)),
                    }
                    continue;
                }
                _ => {
                    opened.push((base, exponent));
                    continue;
                }
            };
            let (squares, others): (Vec<_>, Vec<_>) = inner.1.iter().partition(|(_, n)| even(*n));
            any |= !squares.is_empty();
            for (b, n) in squares {
                let power = n * exponent;
                if power.as_integer().is_none() {
                    opened.push((self.pool.call(FunctionId::Abs, &[b]), power));
                    continue;
                }
                if !even(power) {
                    opened.push((self.pool.call(FunctionId::Sign, &[b]), Number::ONE));
                }
                opened.push((b, power));
            }
            opened.push((self.pool.monomial(inner.0, &others), exponent));
        }
        any.then(|| self.pool.monomial(coefficient, &opened))
    }

    fn lower_power(&mut self, base: Register, exponent: Register) -> Register {
        if self.is_fixed(exponent) {
            let register = self.push(Op::ParametricPower(base, exponent));
            self.make_room(register, 2 * LIVE_POWER_BITS);
            return register;
        }
        // b^e = exp(e ln b)
        let logarithm = self.call(FunctionId::Ln, [base, base]);
        let product = self.multiply(exponent, logarithm);
        self.call(FunctionId::Exp, [product, product])
    }

    /// Registers behind one that needs more than one, if they are not there yet.
    fn make_room(&mut self, register: Register, count: usize) {
        if self.program.ops.len() == register as usize + 1 {
            for _ in 0..count {
                self.push(Op::Written);
            }
        }
    }

    fn call(&mut self, function: FunctionId, arguments: [Register; 2]) -> Register {
        let register = self.push(Op::Call(function, arguments));
        self.make_room(register, 1);
        register
    }

    fn lower_call(&mut self, function: FunctionId, arguments: &[Expr]) -> Register {
        match function.row().rule {
            Rule::Series(_) if function == FunctionId::Atan2 && self.cuts => {
                let branches = half_planes(self.pool, arguments);
                self.cuts = false;
                let register = self.select(branches);
                self.cuts = true;
                register
            }
            Rule::Series(_) => {
                let first = self.known[&arguments[0]];
                let second = arguments.get(1).map_or(first, |e| self.known[e]);
                // one operation gives both of a pair
                let (leader, offset) = match function {
                    FunctionId::Cos => (FunctionId::Sin, 1),
                    FunctionId::Cosh => (FunctionId::Sinh, 1),
                    other => (other, 0),
                };
                self.call(leader, [first, second]) + offset
            }
            Rule::Branch(branches) => {
                let branches = branches(self.pool, arguments);
                self.select(branches)
            }
            Rule::Power => {
                let base = self.known[&arguments[0]];
                self.push(Op::Root(base))
            }
        }
    }

    fn select(&mut self, branches: Branches) -> Register {
        let positive = self.lower(branches.positive);
        let negative = self.lower(branches.negative);
        let opposite = self.pool.neg(branches.switch);
        if let Some(mode) = self.switches.iter().position(|&e| e == opposite) {
            let switch = self.program.switches[mode];
            let mode = Some(mode as u32);
            return self.push(Op::Select { switch, mode, positive: negative, negative: positive });
        }
        let switch = self.lower(branches.switch);
        let mode = (!self.is_fixed(switch)).then(|| self.mode(branches.switch, switch));
        self.push(Op::Select { switch, mode, positive, negative })
    }

    fn mode(&mut self, e: Expr, register: Register) -> u32 {
        if let Some(mode) = self.switches.iter().position(|&known| known == e) {
            return mode as u32;
        }
        self.switches.push(e);
        self.program.switches.push(register);
        self.switches.len() as u32 - 1
    }
}

/// What is to be watched of an operation.
fn guard(ops: &[Op], r: Register) -> Option<Guard> {
    match ops[r as usize] {
        Op::Root(under) => Some(Guard { value: r, under: Some(under), passes: true }),
        Op::Power(under, _) => Some(Guard { value: r, under: Some(under), passes: false }),
        Op::Call(FunctionId::Asin | FunctionId::Acos, _) => {
            Some(Guard { value: r + 1, under: None, passes: true })
        }
        _ => None,
    }
}

/// `atan2(y, x)` on the two sides of y = 0, on each without a cut nearby:
/// `±π/2 + atan2(∓x, ±y)`. They agree where x > 0, and differ by a turn where x < 0. The cuts of
/// the calls it is made of lie where the other one is taken.
fn half_planes(pool: &mut Pool, arguments: &[Expr]) -> Branches {
    let (y, x) = (arguments[0], arguments[1]);
    let (minus_y, minus_x) = (pool.neg(y), pool.neg(x));
    let above = pool.call(FunctionId::Atan2, &[minus_x, y]);
    let below = pool.call(FunctionId::Atan2, &[x, minus_y]);
    let pi = pool.pi();
    let right_angle = pool.scale(Number::HALF, pi);
    let positive = pool.add(right_angle, above);
    let negative = pool.sub(below, right_angle);
    Branches { switch: y, positive, negative }
}
