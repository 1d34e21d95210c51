//! Numbers that fill an interval evenly, however many of them are taken (J. H. Halton, Numer. Math. 2 (1960) 84).
//!
//! In: an index, the number of a coordinate. Out: a number between 0 and 1. Never here: what they are for.

/// The bases of the sequence, one for each coordinate in turn.
const PRIMES: [usize; 12] = [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37];

/// The radical inverse of a number, in the base of a coordinate.
pub(super) fn halton(index: usize, coordinate: usize) -> f64 {
    let base = PRIMES[coordinate % PRIMES.len()];
    let (mut rest, mut part, mut sum) = (index, 1.0, 0.0);
    while rest > 0 {
        part /= base as f64;
        sum += part * (rest % base) as f64;
        rest /= base;
    }
    sum
}
