//! Expressions: text in, exact symbolic algebra inside, text out. No physics.
//!
//! A [`Pool`] interns every expression once, in a canonical form (n-ary sums with numeric
//! coefficients, n-ary products with numeric exponents), so equal means *the same handle* and
//! common subexpressions are free. An [`Expr`] is such a handle, a [`Symbol`] an interned name.
//!
//! In: source text ([`parse`] → [`Syntax`] with spans → [`Pool`]). Out: derivatives, simplified
//! forms, zero proofs, and three ways of writing ([`Pool::text`], [`Pool::unicode`],
//! [`Pool::latex`]). Never here: coordinates, velocities, units, files, numbers in motion.

mod ball;
mod conditioning;
mod derivative;
mod double;
mod evaluate;
mod expand;
mod function;
mod latex;
pub mod math;
mod notation;
mod number;
mod parse;
mod pool;
mod print;
mod product;
mod real;
mod sample;
mod simplify;
mod sum;
mod symbol;
mod syntax;
mod terms;
mod text;
mod token;
mod trigonometry;
mod unicode;
mod wide;
mod zero_test;

pub use double::DoubleDouble;
pub use function::{Branches, FUNCTIONS, Function, FunctionId, Rule};
pub use notation::{latex_name, latex_of_unicode, unicode_name};
pub use number::Number;
pub use parse::parse;
pub use pool::{Expr, NODE_LIMIT, Node, Pool};
pub use real::{Real, Recurrence, RecurrenceStep};
pub use symbol::{Rank, Symbol, SymbolInfo};
pub use syntax::{BinaryOperator, Resolve, Span, Syntax, SyntaxError, SyntaxKind, nearest};
pub use wide::ExtendedRange;
pub use zero_test::Zero;
