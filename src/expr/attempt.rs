//! Attempts: work whose result may be done without, held within an allowance.
//!
//! In: what is attempted. Out: its result, or nothing and the pool as it was, so that what was given up has no influence on
//! what is done afterwards. Never here: what is worth an attempt.

use super::pool::Pool;

/// An attempt that was begun: the pool as it was.
#[derive(Debug)]
pub struct Attempt {
    before: Pool,
    allowed: u64,
}

impl Pool {
    /// Does something for which no more than `allowance` steps are needed: one for each expression that is asked for, and one for
    /// each of its parts. Where they are used up, or the pool is full, there is no result and the pool is as it was before.
    ///
    /// Attempts within attempts use up the allowance of both.
    pub fn attempt<T>(
        &mut self,
        allowance: u64,
        find: impl FnOnce(&mut Pool) -> Option<T>,
    ) -> Option<T> {
        let attempt = self.begin(allowance);
        let found = find(self);
        if self.end(attempt) { found } else { None }
    }

    /// Begins an [attempt](Pool::attempt) by something that holds the pool.
    pub fn begin(&mut self, allowance: u64) -> Attempt {
        let before = self.clone();
        Attempt { before, allowed: self.steps.allow(allowance) }
    }

    /// Ends an attempt, and returns whether what was built is valid. Nothing built since it was begun is there if it is not.
    pub fn end(&mut self, attempt: Attempt) -> bool {
        self.steps.allow_again(attempt.allowed);
        let is_valid = !self.is_full();
        if !is_valid {
            let steps = self.steps;
            *self = attempt.before;
            self.steps = steps;
        }
        is_valid
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Expr, Pool};

    /// (1 + x)(1 + x²)(1 + x⁴)…, multiplied out as far as it goes.
    fn product(pool: &mut Pool, most: i64) -> Expr {
        let x = pool.named("x");
        let mut all = Expr::ONE;
        for k in 0..most {
            let power = pool.powi(x, 1 << k);
            let factor = pool.add(Expr::ONE, power);
            all = pool.mul(all, factor);
        }
        pool.multiplied_out(all)
    }

    #[test]
    fn what_is_given_up_leaves_nothing_behind() {
        let mut pool = Pool::new();
        let small = product(&mut pool, 3);
        let built = pool.built();
        assert_eq!(pool.attempt(500, |pool| Some(product(pool, 9))), None);
        assert_eq!((pool.built(), pool.is_full()), (built, false));
        // what comes after it is what it is without it
        let mut other = Pool::new();
        product(&mut other, 3);
        let (after, alone) = (product(&mut pool, 4), product(&mut other, 4));
        assert_eq!(pool.text(after), other.text(alone));
        assert_eq!(pool.attempt(1_000_000, |pool| Some(product(pool, 3))), Some(small));
    }

    #[test]
    fn an_attempt_within_another_uses_up_both() {
        let mut pool = Pool::new();
        let found = pool.attempt(500, |pool| {
            let inner = pool.attempt(1_000_000, |pool| Some(product(pool, 9)));
            assert_eq!(inner, None);
            Some(product(pool, 2))
        });
        assert_eq!(found, None);
        assert!(pool.attempt(500, |pool| Some(product(pool, 2))).is_some());
    }
}
