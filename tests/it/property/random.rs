//! Random systems and runs of them, in natural units and in any others.

use super::case::{Case, Constraint, Law, ROTATIONS, Units};
use super::dice::Dice;
use super::jet::Jet;
use super::tree::{
    Branches, Kinked, Smooth, Tree, kinked, number, power, product, quotient, smooth, sum, variable,
};

/// Names of every kind: those with a meaning for symmetries, and others.
const NAMES: [[&str; 3]; 4] =
    [["x", "y", "z"], ["u", "v", "w"], ["r", "theta", "phi"], ["q1", "q2", "q3"]];

/// The case with this index under a seed.
pub(crate) fn case(seed: u64, index: u64) -> Case {
    let mut dice = Dice::of(seed, index);
    let law = match dice.below(20) {
        0..=14 => Law::Lagrangian,
        15..=17 => Law::Hamiltonian,
        _ => Law::Poisson,
    };
    let n = if law == Law::Poisson { 3 } else { dice.pick(&[1, 1, 1, 2, 2, 3]) };
    let names = dice.pick(&NAMES)[..n].iter().map(|name| (*name).to_owned()).collect();
    let mut case = Case {
        law,
        names,
        kinetic: Vec::new(),
        potential: Vec::new(),
        dissipation: Vec::new(),
        forces: Vec::new(),
        constraint: None,
        release: None,
        structure: ROTATIONS,
        claims: false,
        by_momentum: Vec::new(),
        start: (0..2 * n).map(|_| dice.between(-1.2, 1.2)).collect(),
        impulse: None,
        stop: None,
        length: 0.0,
        method: "auto".to_owned(),
        step: None,
        tolerance: None,
        units: Units::natural(n),
    };
    case.start.truncate(case.numbers());
    for x in &mut case.start {
        if dice.chance(0.1) {
            *x = 0.0;
        }
    }
    match law {
        Law::Lagrangian => lagrangian(&mut case, &mut dice),
        Law::Hamiltonian => hamiltonian(&mut case, &mut dice),
        Law::Poisson => poisson(&mut case, &mut dice),
    }
    length(&mut case, &mut dice);
    if law != Law::Poisson && case.constraint.is_none() && dice.chance(0.12) {
        let at = case.length * dice.between(0.1, 0.9);
        case.impulse = Some((at, dice.below(n), dice.between(-1.0, 1.0)));
        if dice.chance(0.3) {
            case.impulse = Some((0.0, dice.below(n), dice.between(-0.5, 0.5)));
            if let Some((at, ..)) = &mut case.impulse {
                *at = case.length / 4.0;
            }
        }
    }
    if dice.chance(0.1) {
        case.stop = Some(sum([variable(0), number(-dice.between(-1.5, 1.5))]));
    }
    if law == Law::Poisson && dice.chance(0.6) {
        for i in 0..3 {
            for j in 0..=i {
                let entry = dice.between(-1.0, 1.0);
                (case.structure[i][j], case.structure[j][i]) = (entry, entry);
            }
        }
    }
    if law == Law::Lagrangian && case.constraint.is_none() && dice.chance(0.15) {
        case.by_momentum = (0..n).filter(|_| dice.chance(0.7)).collect();
    }
    method(&mut case, &mut dice);
    case.claims = case.keeps_energy() && dice.chance(0.2);
    units(&mut case, &mut dice);
    if case.constraint.is_some() && dice.chance(0.3) {
        case.release = Some(case.length * dice.between(0.1, 0.9));
    }
    case
}

fn half() -> Tree {
    number(0.5)
}

fn square(tree: Tree) -> Tree {
    power(tree, 2)
}

fn lagrangian(case: &mut Case, dice: &mut Dice) {
    let n = case.count();
    for i in 0..n {
        kinetic_term(case, dice, i);
    }
    if n > 1 && dice.chance(0.2) {
        // coupled masses, and a rotating field
        let factors = [number(dice.between(-0.2, 0.2)), variable(n), variable(n + 1)];
        case.kinetic.push(product(factors));
    }
    if n > 1 && dice.chance(0.2) {
        let field = number(dice.between(-1.0, 1.0));
        case.kinetic.push(product([field, variable(0), variable(n + 1)]));
    }
    potential(case, dice);
    if dice.chance(0.2) {
        let i = dice.below(n);
        let c = number(dice.between(0.05, 0.6));
        case.dissipation.push(product([half(), c, square(variable(n + i))]));
    }
    if dice.chance(0.2) {
        let force = force(case, dice);
        let i = dice.below(n);
        case.forces.push((i, force));
    }
    if n > 1 && dice.chance(0.3) {
        constrain(case, dice);
    }
}

fn kinetic_term(case: &mut Case, dice: &mut Dice, i: usize) {
    let n = case.count();
    let v = || variable(n + i);
    let mass = number(dice.between(0.3, 3.0));
    let other = variable(dice.below(n));
    let a = number(dice.between(0.1, 1.0));
    let term = match dice.below(14) {
        0..=6 => product([half(), mass, square(v())]),
        7 => product([half(), sum([mass, product([a, square(other)])]), square(v())]),
        8 => product([half(), sum([number(2.0), smooth(Smooth::Sin, other)]), square(v())]),
        9 => product([half(), smooth(Smooth::Exp, product([a, other])), square(v())]),
        10 => {
            sum([product([half(), mass, square(v())]), product([number(0.25), a, power(v(), 4)])])
        }
        11 => {
            let start = &mut case.start[n + i];
            *start *= 0.5;
            let inside = sum([number(1.0), product([number(-1.0), square(v())])]);
            product([number(-1.0), smooth(Smooth::Sqrt, inside)])
        }
        12 => smooth(Smooth::Cosh, v()),
        _ => quotient(product([half(), square(v())]), sum([number(1.0), square(other)])),
    };
    case.kinetic.push(term);
}

/// One coordinate, or a sum of some.
fn combination(case: &Case, dice: &mut Dice) -> Tree {
    let n = case.count();
    let i = dice.below(n);
    match dice.below(4) {
        0 if n > 1 => {
            let j = (i + 1) % n;
            sum([variable(i), product([number(dice.between(-1.5, 1.5)), variable(j)])])
        }
        1 => sum([variable(i), number(dice.between(-0.7, 0.7))]),
        _ => variable(i),
    }
}

fn potential(case: &mut Case, dice: &mut Dice) {
    let n = case.count();
    let q = if case.law == Law::Poisson { 3 } else { n };
    if dice.chance(0.7) {
        for i in 0..q {
            let k = number(dice.between(0.2, 2.0));
            case.potential.push(product([half(), k, square(variable(i))]));
        }
    }
    for _ in 0..=dice.below(3) {
        let term = potential_term(case, dice);
        case.potential.push(term);
    }
    if dice.chance(0.12) {
        let time = variable(case.time());
        let w = number(dice.between(0.3, 3.0));
        let drive = smooth(Smooth::Cos, product([w, time]));
        let factors = [number(dice.between(0.1, 0.6)), variable(dice.below(n)), drive];
        case.potential.push(product(factors));
    }
}

fn potential_term(case: &Case, dice: &mut Dice) -> Tree {
    let n = case.count();
    let u = combination(case, dice);
    let a = number(dice.between(0.1, 1.5));
    let minus = |tree: Tree| product([number(-1.0), tree]);
    match dice.below(26) {
        0 => product([number(0.25), a, power(u, 4)]),
        1 => product([a, smooth(Smooth::Cos, u)]),
        2 => minus(product([a, smooth(Smooth::Cos, u)])),
        3 => product([a, smooth(Smooth::Sin, product([number(3.0), u]))]),
        4 => product([a, smooth(Smooth::Sqrt, sum([number(1.0), square(u)]))]),
        5 => {
            let spelling = [
                Kinked::Abs,
                Kinked::Root,
                Kinked::HalfPower,
                Kinked::Max,
                Kinked::Min,
                Kinked::Sign,
            ];
            product([a, kinked(dice.pick(&spelling), u)])
        }
        6 => product([a, kinked(Kinked::Contact(2.0), u)]),
        7 => product([a, kinked(Kinked::Contact(2.5), u)]),
        8 => product([a, kinked(Kinked::AbsPower(dice.pick(&[1.5, 1.8, 2.5, 3.0])), u)]),
        9 => product([a, kinked(Kinked::SquarePower(dice.pick(&[1.5, 2.5])), u)]),
        10 => product([a, square(smooth(Smooth::Tanh, u))]),
        11 => product([a, smooth(Smooth::Ln, smooth(Smooth::Cosh, u))]),
        12 => {
            let w = number(dice.pick(&[1.0, 0.3, 0.05]));
            let exponent = quotient(minus(u), w);
            quotient(a, sum([number(1.0), smooth(Smooth::Exp, exponent)]))
        }
        13 => minus(quotient(a, square(smooth(Smooth::Cosh, u)))),
        14 => minus(product([a, smooth(Smooth::Exp, minus(square(u)))])),
        15 => product([a, smooth(Smooth::Exp, minus(square(sum([u, number(-4.0)]))))]),
        16 => {
            let steep = dice.pick(&[8, 12, 20, 40]);
            power(quotient(u, number(dice.between(1.3, 2.5))), steep)
        }
        17 => {
            let inside = sum([number(1.0), minus(smooth(Smooth::Exp, minus(u)))]);
            product([a, square(inside)])
        }
        18 => {
            let soft = number(dice.pick(&[0.01, 0.1, 1.0]));
            let r = sum((0..n).map(|i| square(variable(i))).chain([soft]));
            minus(quotient(a, smooth(Smooth::Sqrt, r)))
        }
        19 if n > 1 => {
            let r = sum([square(variable(0)), square(variable(1))]);
            minus(quotient(a, smooth(Smooth::Sqrt, r)))
        }
        20 if n > 1 => product([a, square(variable(0)), variable(1)]),
        21 => product([a, smooth(Smooth::Atan, u)]),
        22 => product([a, smooth(Smooth::Tanh, quotient(u, number(dice.pick(&[1.0, 0.1]))))]),
        23 => product([a, u]),
        24 => {
            // a wall far away, or a gentle slope
            let far = sum([u, number(dice.pick(&[-3.0, -6.0, 5.0]))]);
            product([number(3.0), smooth(Smooth::Exp, product([number(5.0), far]))])
        }
        _ => product([half(), a, square(u)]),
    }
}

fn force(case: &Case, dice: &mut Dice) -> Tree {
    let n = case.count();
    let i = dice.below(n);
    let a = number(dice.between(-0.8, 0.8));
    let time = variable(case.time());
    match dice.below(5) {
        0 => product([a, smooth(Smooth::Cos, product([number(dice.between(0.3, 3.0)), time]))]),
        1 => {
            let v = variable(n + i);
            product([number(-dice.between(0.05, 0.5)), v.clone(), kinked(Kinked::Abs, v)])
        }
        2 => product([number(-dice.between(0.05, 0.5)), smooth(Smooth::Tanh, variable(n + i))]),
        3 => a,
        _ => product([number(-dice.between(0.01, 0.2)), power(variable(n + i), 3)]),
    }
}

fn constrain(case: &mut Case, dice: &mut Dice) {
    let n = case.count();
    let minus = |tree: Tree| product([number(-1.0), tree]);
    if n == 3 && dice.chance(0.4) {
        // a knife's edge
        let [x, y, turn] = [variable(3), variable(4), variable(2)];
        let expression = sum([
            product([smooth(Smooth::Sin, turn.clone()), x]),
            minus(product([smooth(Smooth::Cos, turn), y])),
        ]);
        let (along, angle) = (case.start[3], case.start[2]);
        case.start[3] = along * angle.cos();
        case.start[4] = along * angle.sin();
        case.constraint = Some(Constraint { expression, holonomic: false });
        return;
    }
    if dice.chance(0.4) {
        let r2 = square(number(1.0));
        let expression = sum([square(variable(0)), square(variable(1)), minus(r2)]);
        let angle = dice.pick(&[0.0, 0.7, 1.9, std::f64::consts::PI, std::f64::consts::FRAC_PI_2]);
        let turn = case.start[n];
        case.start[0] = angle.cos();
        case.start[1] = angle.sin();
        case.start[n] = -turn * angle.sin();
        case.start[n + 1] = turn * angle.cos();
        case.constraint = Some(Constraint { expression, holonomic: true });
        return;
    }
    // the second coordinate as a function of the first
    let u = variable(0);
    let curve = match dice.below(4) {
        0 => product([number(dice.between(-1.0, 1.0)), square(u)]),
        1 => smooth(Smooth::Sin, u),
        2 => product([number(dice.between(-2.0, 2.0)), u]),
        _ => product([half(), smooth(Smooth::Cosh, u)]),
    };
    let mut at = case.start.clone();
    at.push(0.0);
    let value: Jet = curve.jet(&at, &mut Branches::default());
    case.start[1] = value.value;
    case.start[n + 1] = value.slope[0] * case.start[n];
    let expression = sum([variable(1), minus(curve)]);
    case.constraint = Some(Constraint { expression, holonomic: true });
}

fn hamiltonian(case: &mut Case, dice: &mut Dice) {
    let n = case.count();
    for i in 0..n {
        let p = || variable(n + i);
        let m = number(dice.between(0.3, 3.0));
        let other = variable(dice.below(n));
        let term = match dice.below(8) {
            0..=4 => quotient(square(p()), product([number(2.0), m])),
            5 => product([half(), square(p()), sum([number(1.0), square(other)])]),
            6 => smooth(Smooth::Sqrt, sum([number(1.0), square(p())])),
            _ => sum([product([half(), square(p())]), product([number(0.1), power(p(), 4)])]),
        };
        case.kinetic.push(term);
    }
    potential(case, dice);
    if dice.chance(0.15) {
        let force = product([number(-dice.between(0.05, 0.5)), variable(n)]);
        case.forces.push((0, force));
    }
}

fn poisson(case: &mut Case, dice: &mut Dice) {
    for i in 0..3 {
        let a = number(dice.between(0.2, 2.0));
        case.kinetic.push(product([half(), a, square(variable(i))]));
    }
    if dice.chance(0.5) {
        let term = potential_term(case, dice);
        case.potential.push(term);
    }
}

fn length(case: &mut Case, dice: &mut Dice) {
    let whole = std::f64::consts::TAU * dice.pick(&[1.0, 2.0, 5.0]);
    case.length = match dice.below(10) {
        0 | 1 => whole,
        2 => 100.0 * dice.between(0.4, 1.0),
        3 => dice.between(0.001, 0.1),
        _ => dice.between(0.5, 30.0),
    };
}

fn method(case: &mut Case, dice: &mut Dice) {
    let fixed = [
        "leapfrog",
        "yoshida4",
        "yoshida6",
        "yoshida8",
        "gauss4",
        "gauss6",
        "symplectic-euler",
        "rk4",
    ];
    match dice.below(10) {
        0..=4 => {}
        5 | 6 => {
            "dop853".clone_into(&mut case.method);
            if dice.chance(0.8) {
                case.tolerance = Some(10.0_f64.powi(-3 - dice.below(11) as i32));
            }
        }
        7 => {
            case.tolerance = Some(10.0_f64.powi(-6 - dice.below(10) as i32));
            "taylor".clone_into(&mut case.method);
        }
        _ => {
            dice.pick(&fixed).clone_into(&mut case.method);
            let per_unit = dice.pick(&[0.8, 3.0, 10.0, 30.0, 100.0]);
            case.length = case.length.min(20_000.0 / per_unit);
            case.step = Some(1.0 / per_unit);
        }
    }
}

fn units(case: &mut Case, dice: &mut Dice) {
    if dice.chance(0.5) {
        return;
    }
    let decade = |dice: &mut Dice, low: i32, high: i32| {
        let exponent = low + dice.below((high - low + 1) as usize) as i32;
        let digits = dice.pick(&[1.0, 1.0, 2.5, 6.67]);
        format!("{digits}e{exponent}").parse::<f64>().unwrap_or(1.0)
    };
    let length = decade(dice, -10, 20);
    let time = decade(dice, -15, 15);
    let mass = decade(dice, -30, 40);
    case.units = Units {
        positions: vec![length; case.count()],
        time,
        energy: mass * (length / time).powi(2),
        as_parameters: case.law != Law::Poisson && dice.chance(0.4),
    };
}
