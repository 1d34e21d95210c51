//! Expressions: text in, exact symbolic algebra inside, text out. They contain no physics.
//!
//! A [`Pool`] interns every expression once, in a canonical form (n-ary sums with numeric
//! coefficients, n-ary products with numeric exponents). Equal expressions therefore have *the same
//! handle*, and common subexpressions are free. An [`Expr`] is such a handle, a [`Symbol`] an
//! interned name.
//!
//! In: source text ([`parse`] → [`Syntax`] with spans → [`Pool`]). Out: derivatives, simplified
//! forms, proofs of vanishing, and three notations ([`Pool::text`], [`Pool::unicode`],
//! [`Pool::latex`]). Never here: coordinates, velocities, units, files, numerical motion.

mod attempt;
mod ball;
mod common_root;
mod conditioning;
mod derivative;
mod division;
mod evaluate;
mod expand;
mod function;
mod inverses;
mod jump;
mod juxtaposition;
mod kinks;
mod latex;
mod measure;
mod memo;
mod node;
mod notation;
mod one_fraction;
mod other_functions;
mod parse;
mod perfect_square;
mod plain;
mod pool;
mod positive_factors;
mod print;
mod product;
mod quotient_sign;
mod range;
mod rewrite;
mod sample;
mod sides;
mod simplify;
mod spelling;
mod steps;
mod sum;
mod symbol;
mod syntax;
mod terms;
mod text;
mod textbook;
mod token;
mod trigonometry;
mod unicode;
mod vanishing;
mod zero_test;

pub use attempt::Attempt;
pub use function::{
    BilinearEquation, Convolution, Divisor, FUNCTIONS, Function, KinkBranches, Recurrence, Rule,
    SeriesOperand,
};
pub use node::{Expr, FunctionId, Node};
pub use notation::{
    latex_name, latex_of_unicode, plain_name, subscripts, unicode_name, with_subscripts,
    without_dots,
};
pub use parse::{LEFT_TO_RIGHT, parse, parse_all};
pub use plain::EULER;
pub use pool::{NODE_LIMIT, Pool};
pub use range::{is_never_negative, keeps_its_sign};
pub use spelling::{spell, spelt, spelt_derivatives, subscript};
pub use symbol::{Rank, Symbol, SymbolInfo};
pub use syntax::{BinaryOperator, Resolve, Span, Syntax, SyntaxError, SyntaxKind};
pub use zero_test::Zero;
