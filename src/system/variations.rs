//! The programs of a system with tangent vectors, each made once.
//!
//! In: a number of vectors, and how to make its programs. Out: the programs, for all motions of the system. Never here: what they
//! compute.

use std::sync::{Arc, Mutex, PoisonError};

use super::rhs::Tangents;

/// The programs with tangent vectors that were asked for, with their machine code: all motions of a system share them.
#[derive(Debug, Default)]
pub(super) struct Variations(Mutex<Vec<Arc<Tangents>>>);

impl Variations {
    /// Those with `count` vectors, made if they were not asked for before.
    pub(super) fn of(&self, count: usize, make: impl FnOnce() -> Tangents) -> Arc<Tangents> {
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(tangents) = known.iter().find(|tangents| tangents.count == count) {
            return Arc::clone(tangents);
        }
        let tangents = Arc::new(make());
        known.push(Arc::clone(&tangents));
        tangents
    }
}

#[cfg(test)]
mod tests {
    use super::super::machine_code::CodeCache;
    use super::super::program::Program;
    use super::super::rhs::{MotionPrograms, SplitHamiltonian};
    use super::*;
    use crate::expr::Pool;

    /// Programs of x, whose contents do not matter.
    fn tangents(count: usize) -> Tangents {
        let mut pool = Pool::new();
        let [x, t] = ["x", "t"].map(|name| pool.symbol(name));
        let rate = pool.variable(x);
        let program = Program::compile(&mut pool, &[], t, &[x], &[rate]).expect("x is an input");
        let part = || Arc::clone(&program);
        let motion = MotionPrograms {
            native: part(),
            code: CodeCache::new(),
            canonical: (part(), true),
            split: Ok(SplitHamiltonian { drift: part(), kick: part() }),
        };
        Tangents { count, motion, legendre: program }
    }

    #[test]
    fn programs_with_vectors_are_made_once_for_each_number_of_them() {
        let known = Variations::default();
        let first = known.of(2, || tangents(2));
        assert_eq!(known.of(3, || tangents(3)).count, 3);
        assert!(Arc::ptr_eq(&first, &known.of(2, || panic!("they are known"))));
    }
}
