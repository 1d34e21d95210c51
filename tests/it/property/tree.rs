//! Expressions as trees: written in the file's language in any units, and evaluated with derivatives. Kinks use a
//! prescribed branch.

use std::fmt::Write as _;

use super::jet::Jet;

/// A function of one argument, smooth on its domain.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Smooth {
    Sin,
    Cos,
    Exp,
    Tanh,
    Cosh,
    Sqrt,
    Atan,
    Ln,
}

/// A function of one argument with a kink at zero, in one of many spellings.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Kinked {
    /// |u|
    Abs,
    /// √(u²)
    Root,
    /// (u²)^½
    HalfPower,
    /// max(u, −u)
    Max,
    /// −min(u, −u)
    Min,
    /// u sign(u)
    Sign,
    /// |u|^p
    AbsPower(f64),
    /// (u²)^(p/2)
    SquarePower(f64),
    /// max(0, u)^p
    Contact(f64),
}

/// An expression of variables by index: coordinates, then velocities or momenta, then the time.
#[derive(Clone, PartialEq, Debug)]
pub(crate) enum Tree {
    Number(f64),
    Variable(usize),
    Sum(Vec<Tree>),
    Product(Vec<Tree>),
    Quotient(Box<Tree>, Box<Tree>),
    Power(Box<Tree>, i32),
    Smooth(Smooth, Box<Tree>),
    Kinked(Kinked, Box<Tree>),
}

/// The branches of all kinks in the order of evaluation, and the values that decide them.
#[derive(Clone, Default, Debug)]
pub(crate) struct Branches {
    /// Whether the value is above zero; if this is `None`, the value decides.
    pub(crate) above: Vec<Option<bool>>,
    pub(crate) values: Vec<f64>,
}

impl Branches {
    fn next(&mut self, value: f64) -> bool {
        let at = self.values.len();
        self.values.push(value);
        if self.above.len() <= at {
            self.above.resize(at + 1, None);
        }
        self.above[at].unwrap_or(value > 0.0)
    }

    /// Adds a function that is only watched for its zero.
    pub(crate) fn watch(&mut self, value: f64) {
        self.next(value);
    }
}

/// How a variable is written: its name, and the unit by which the name is divided.
pub(crate) struct Spelling {
    pub(crate) name: String,
    pub(crate) unit: f64,
    /// The same unit as a product of parameters, if it is written as such.
    pub(crate) symbol: Option<String>,
}

pub(crate) fn number(value: f64) -> Tree {
    Tree::Number(value)
}

pub(crate) fn variable(i: usize) -> Tree {
    Tree::Variable(i)
}

pub(crate) fn product(factors: impl IntoIterator<Item = Tree>) -> Tree {
    Tree::Product(factors.into_iter().collect())
}

pub(crate) fn sum(terms: impl IntoIterator<Item = Tree>) -> Tree {
    Tree::Sum(terms.into_iter().collect())
}

pub(crate) fn power(base: Tree, exponent: i32) -> Tree {
    Tree::Power(Box::new(base), exponent)
}

pub(crate) fn smooth(function: Smooth, argument: Tree) -> Tree {
    Tree::Smooth(function, Box::new(argument))
}

pub(crate) fn kinked(function: Kinked, argument: Tree) -> Tree {
    Tree::Kinked(function, Box::new(argument))
}

pub(crate) fn quotient(above: Tree, below: Tree) -> Tree {
    Tree::Quotient(Box::new(above), Box::new(below))
}

impl Smooth {
    fn name(self) -> &'static str {
        match self {
            Smooth::Sin => "sin",
            Smooth::Cos => "cos",
            Smooth::Exp => "exp",
            Smooth::Tanh => "tanh",
            Smooth::Cosh => "cosh",
            Smooth::Sqrt => "sqrt",
            Smooth::Atan => "atan",
            Smooth::Ln => "ln",
        }
    }

    fn values(self, u: f64) -> [f64; 3] {
        match self {
            Smooth::Sin => [u.sin(), u.cos(), -u.sin()],
            Smooth::Cos => [u.cos(), -u.sin(), -u.cos()],
            Smooth::Exp => [u.exp(); 3],
            Smooth::Tanh => {
                let (f, c) = (u.tanh(), u.cosh());
                [f, 1.0 / (c * c), -2.0 * f / (c * c)]
            }
            Smooth::Cosh => [u.cosh(), u.sinh(), u.cosh()],
            Smooth::Sqrt => [u.sqrt(), 0.5 / u.sqrt(), -0.25 / (u * u.sqrt())],
            Smooth::Atan => {
                let s = 1.0 / (1.0 + u * u);
                [u.atan(), s, -2.0 * u * s * s]
            }
            Smooth::Ln => [u.ln(), 1.0 / u, -1.0 / (u * u)],
        }
    }
}

/// ln(cosh(u)) and its derivatives, also where the cosine overflows.
fn ln_cosh(u: f64) -> [f64; 3] {
    let tail = (-2.0 * u.abs()).exp();
    let slope = u.tanh();
    [u.abs() + tail.ln_1p() - std::f64::consts::LN_2, slope, 4.0 * tail / (1.0 + tail).powi(2)]
}

impl Kinked {
    /// The values on the branch above zero or below; a branch continues beyond the kink.
    fn values(self, u: f64, above: bool) -> [f64; 3] {
        let side = if above { 1.0 } else { -1.0 };
        let powers = |p: f64| {
            let a = u.abs();
            let slope = p * a.powf(p - 1.0) * side;
            [a.powf(p), slope, p * (p - 1.0) * a.powf(p - 2.0)]
        };
        match self {
            Kinked::AbsPower(p) | Kinked::SquarePower(p) => powers(p),
            Kinked::Contact(p) if above => powers(p),
            Kinked::Contact(_) => [0.0; 3],
            _ => [side * u, side, 0.0],
        }
    }

    fn write(self, u: &str) -> String {
        match self {
            Kinked::Abs => format!("abs({u})"),
            Kinked::Root => format!("sqrt(({u})^2)"),
            Kinked::HalfPower => format!("(({u})^2)^0.5"),
            Kinked::Max => format!("max({u}, -({u}))"),
            Kinked::Min => format!("(-min({u}, -({u})))"),
            Kinked::Sign => format!("(({u})*sign({u}))"),
            Kinked::AbsPower(p) => format!("abs({u})^{p}"),
            Kinked::SquarePower(p) => format!("(({u})^2)^{}", p / 2.0),
            Kinked::Contact(p) => format!("max(0, {u})^{p}"),
        }
    }
}

impl Tree {
    /// The value with derivatives at a point.
    pub(crate) fn jet(&self, point: &[f64], branches: &mut Branches) -> Jet {
        let count = point.len();
        match self {
            Tree::Number(value) => Jet::constant(count, *value),
            Tree::Variable(i) => Jet::variable(count, *i, point[*i]),
            Tree::Sum(terms) => {
                let mut sum = Jet::constant(count, 0.0);
                for term in terms {
                    match term {
                        Tree::Number(value) => sum.value += value,
                        term => sum.add(&term.jet(point, branches)),
                    }
                }
                sum
            }
            Tree::Product(factors) => {
                let mut scale = 1.0;
                let mut product: Option<Jet> = None;
                for factor in factors {
                    match factor {
                        Tree::Number(value) => scale *= value,
                        factor => {
                            let factor = factor.jet(point, branches);
                            product = Some(product.map_or(factor, |p| p.times(&factor)));
                        }
                    }
                }
                product.map_or(Jet::constant(count, scale), |product| product.scaled(scale))
            }
            Tree::Quotient(above, below) => {
                let above = above.jet(point, branches);
                let below = below.jet(point, branches);
                let u = below.value;
                above.times(&below.chain([1.0 / u, -1.0 / (u * u), 2.0 / (u * u * u)]))
            }
            Tree::Power(base, n) => {
                let base = base.jet(point, branches);
                let (u, p) = (base.value, f64::from(*n));
                base.chain([
                    u.powi(*n),
                    p * u.powi(*n - 1),
                    if *n == 1 { 0.0 } else { p * (p - 1.0) * u.powi(*n - 2) },
                ])
            }
            Tree::Smooth(function, argument) => {
                if let (Smooth::Ln, Tree::Smooth(Smooth::Cosh, inner)) = (function, &**argument) {
                    let inner = inner.jet(point, branches);
                    return inner.chain(ln_cosh(inner.value));
                }
                let argument = argument.jet(point, branches);
                argument.chain(function.values(argument.value))
            }
            Tree::Kinked(function, argument) => {
                let argument = argument.jet(point, branches);
                let above = branches.next(argument.value);
                argument.chain(function.values(argument.value, above))
            }
        }
    }

    /// The value with a bound of its rounding error, which cancellation makes large: ln(cosh(u)) near 0.
    pub(crate) fn rounded(&self, point: &[f64]) -> (f64, f64) {
        let last_digit = |value: f64, error: f64| (value, error + f64::EPSILON * value.abs());
        match self {
            Tree::Number(value) => (*value, 0.0),
            Tree::Variable(i) => last_digit(point[*i], 0.0),
            Tree::Sum(terms) => terms.iter().fold((0.0, 0.0), |(sum, error), term| {
                let (value, own) = term.rounded(point);
                last_digit(sum + value, error + own)
            }),
            Tree::Product(factors) => {
                factors.iter().fold((1.0, 0.0), |(product, error), factor| {
                    let (value, own) = factor.rounded(point);
                    last_digit(product * value, error * value.abs() + own * product.abs())
                })
            }
            Tree::Quotient(above, below) => {
                let ((a, of_a), (b, of_b)) = (above.rounded(point), below.rounded(point));
                last_digit(a / b, of_a / b.abs() + of_b * (a / (b * b)).abs())
            }
            Tree::Power(base, n) => {
                let (u, error) = base.rounded(point);
                let slope = f64::from(*n) * u.powi(*n - 1);
                last_digit(u.powi(*n), error * slope.abs())
            }
            Tree::Smooth(function, argument) => {
                let (u, error) = argument.rounded(point);
                let [value, slope, _] = function.values(u);
                last_digit(value, error * slope.abs())
            }
            Tree::Kinked(function, argument) => {
                let (u, error) = argument.rounded(point);
                let [value, slope, _] = function.values(u, u > 0.0);
                last_digit(value, error * slope.abs())
            }
        }
    }

    /// Whether the variable occurs.
    pub(crate) fn holds(&self, i: usize) -> bool {
        match self {
            Tree::Number(_) => false,
            Tree::Variable(j) => i == *j,
            Tree::Sum(parts) | Tree::Product(parts) => parts.iter().any(|part| part.holds(i)),
            Tree::Quotient(above, below) => above.holds(i) || below.holds(i),
            Tree::Power(part, _) | Tree::Smooth(_, part) | Tree::Kinked(_, part) => part.holds(i),
        }
    }

    /// Writes the tree in the file's language, as a factor of a product.
    pub(crate) fn write(&self, names: &[Spelling]) -> String {
        match self {
            Tree::Number(value) => literal(*value),
            Tree::Variable(i) => {
                let Spelling { name, unit, symbol } = &names[*i];
                match symbol {
                    _ if *unit == 1.0 => name.clone(),
                    Some(symbol) => format!("({name}/({symbol}))"),
                    None => format!("({name}/{unit:?})"),
                }
            }
            Tree::Sum(terms) => {
                let terms: Vec<String> = terms.iter().map(|term| term.write(names)).collect();
                format!("({})", terms.join(" + "))
            }
            Tree::Product(factors) => write_product(1.0, factors, names),
            Tree::Quotient(above, below) => {
                format!("({}/{})", above.write(names), below.write(names))
            }
            Tree::Power(base, n) => {
                let base = base.write(names);
                if *n >= 0 && base.starts_with(|c: char| c == '(' || c.is_alphabetic()) {
                    format!("{base}^{n}")
                } else {
                    format!("({base})^({n})")
                }
            }
            Tree::Smooth(function, argument) => {
                format!("{}({})", function.name(), argument.write(names))
            }
            Tree::Kinked(function, argument) => function.write(&argument.write(names)),
        }
    }

    /// Writes a multiple of the tree in the file's language; literal units are combined with the numbers of products,
    /// as in physical laws.
    pub(crate) fn write_scaled(&self, scale: &Spelling, names: &[Spelling]) -> String {
        if let Some(symbol) = &scale.symbol {
            return format!("({symbol})*{}", self.write(names));
        }
        match self {
            Tree::Sum(terms) => {
                let terms: Vec<String> =
                    terms.iter().map(|term| term.write_scaled(scale, names)).collect();
                terms.join(" + ")
            }
            Tree::Product(factors) => write_product(scale.unit, factors, names),
            other if scale.unit == 1.0 => other.write(names),
            other => write_product(scale.unit, std::slice::from_ref(other), names),
        }
    }
}

fn literal(value: f64) -> String {
    if value < 0.0 { format!("({value:?})") } else { format!("{value:?}") }
}

/// Writes a product with its numbers combined, including the units of bare variables.
fn write_product(mut scale: f64, factors: &[Tree], names: &[Spelling]) -> String {
    let mut rest = String::new();
    for factor in factors {
        match factor {
            Tree::Number(value) => scale *= value,
            Tree::Variable(i) if names[*i].symbol.is_none() => {
                scale /= names[*i].unit;
                let _ = write!(rest, "*{}", names[*i].name);
            }
            Tree::Power(base, n) if matches!(&**base, Tree::Variable(i) if names[*i].symbol.is_none() && plain(names[*i].unit, *n)) =>
            {
                let Tree::Variable(i) = &**base else { unreachable!("matched above") };
                scale /= names[*i].unit.powi(*n);
                let _ = write!(rest, "*{}^{}", names[*i].name, literal_power(*n));
            }
            other => {
                let _ = write!(rest, "*{}", other.write(names));
            }
        }
    }
    match rest.strip_prefix('*') {
        Some(rest) if scale == 1.0 => format!("({rest})"),
        Some(rest) => format!("({}*{rest})", literal(scale)),
        None => literal(scale),
    }
}

/// Whether the power of a unit is a number that people would write.
fn plain(unit: f64, n: i32) -> bool {
    (1e-120..1e120).contains(&unit.powi(n))
}

fn literal_power(n: i32) -> String {
    if n < 0 { format!("({n})") } else { n.to_string() }
}
