//! Linear algebra over a prime field: echelon forms, null spaces, ranks.
//!
//! In: rows of residues, one at a time. Out: ranks and bases, exact. Never here: what a row means.

use crate::num::{PrimeField, Residue, Unreduced};

/// The rows that are taken off another at a time.
const TOGETHER: usize = 4;

/// The rows met so far, in echelon form: each has a leading one where those before it and after it have zero or
/// come later.
#[derive(Clone, Debug)]
pub(super) struct Echelon {
    field: PrimeField,
    width: usize,
    /// The row whose leading one is in a column.
    leading: Vec<Option<usize>>,
    rows: Vec<Vec<Residue>>,
}

impl Echelon {
    pub(super) fn new(field: PrimeField, width: usize) -> Echelon {
        Echelon { field, width, leading: vec![None; width], rows: Vec::new() }
    }

    /// The number of independent rows.
    pub(super) fn rank(&self) -> usize {
        self.rows.len()
    }

    /// Whether a column is independent of those before it.
    pub(super) fn leads(&self, column: usize) -> bool {
        self.leading[column].is_some()
    }

    /// Adds a row, and returns whether it was independent of those before.
    pub(super) fn add(&mut self, row: Vec<Residue>) -> bool {
        let field = self.field;
        // entries are reduced when their column is reached, and not after every row that is taken off them
        let mut sums: Vec<Unreduced> = row.into_iter().map(|x| field.unreduced(x)).collect();
        // rows that are to be taken off, with their factors: four at a time are taken off what is to the right
        let mut waiting: Vec<(Residue, usize)> = Vec::with_capacity(TOGETHER);
        for column in 0..self.width {
            for &(factor, known) in &waiting {
                field.add_product(&mut sums[column], factor, self.rows[known][column]);
            }
            let entry = field.reduced(sums[column]);
            if entry.is_zero() {
                continue;
            }
            if let Some(known) = self.leading[column] {
                waiting.push((field.neg(entry), known));
                if waiting.len() == TOGETHER {
                    self.take_off(&mut waiting, &mut sums, column + 1);
                }
                continue;
            }
            let Some(scale) = field.inverse(entry) else { continue };
            self.take_off(&mut waiting, &mut sums, column + 1);
            let mut row = vec![Residue::ZERO; self.width];
            for (x, &sum) in row[column..].iter_mut().zip(&sums[column..]) {
                *x = field.mul(field.reduced(sum), scale);
            }
            self.leading[column] = Some(self.rows.len());
            self.rows.push(row);
            return true;
        }
        false
    }

    /// Adds the waiting rows times their factors to the sums from a column on.
    fn take_off(&self, waiting: &mut Vec<(Residue, usize)>, sums: &mut [Unreduced], column: usize) {
        let of = |k: usize| match waiting.get(k) {
            Some(&(factor, row)) => (factor, &self.rows[row][column..]),
            // nothing, beside whatever row
            None => (Residue::ZERO, self.rows.first().map_or(&[][..], |row| &row[column..])),
        };
        if !waiting.is_empty() {
            let [(a, w), (b, x), (c, y), (d, z)] = [0, 1, 2, 3].map(of);
            let rows = w.iter().zip(x).zip(y.iter().zip(z));
            for (sum, ((&w, &x), (&y, &z))) in sums[column..].iter_mut().zip(rows) {
                self.field.add_products(sum, [a, b, c, d], [w, x, y, z]);
            }
        }
        waiting.clear();
    }

    /// A basis of the null space: one vector for each column without a leading one.
    pub(super) fn null_space(&self) -> Vec<Vec<Residue>> {
        let field = self.field;
        let free = (0..self.width).filter(|&c| self.leading[c].is_none());
        let basis = free.map(|c| {
            let mut vector = vec![Residue::ZERO; self.width];
            vector[c] = field.one();
            for column in (0..c).rev() {
                let Some(row) = self.leading[column] else { continue };
                let row = &self.rows[row];
                let mut sum = Residue::ZERO;
                for k in column + 1..=c {
                    if !vector[k].is_zero() && !row[k].is_zero() {
                        sum = field.add(sum, field.mul(row[k], vector[k]));
                    }
                }
                vector[column] = field.neg(sum);
            }
            vector
        });
        basis.collect()
    }
}

/// The reduced row echelon form of a basis where columns are taken as leading in the given order. Each row has the
/// least possible support: no vector of the span has a smaller one within it.
pub(super) fn reduced(
    field: PrimeField,
    basis: &[Vec<Residue>],
    order: &[usize],
) -> Vec<Vec<Residue>> {
    let mut rows: Vec<Vec<Residue>> = basis.to_vec();
    let mut done = 0;
    for &column in order {
        let Some(found) = (done..rows.len()).find(|&i| !rows[i][column].is_zero()) else {
            continue;
        };
        rows.swap(done, found);
        let Some(scale) = field.inverse(rows[done][column]) else { continue };
        for x in &mut rows[done] {
            *x = field.mul(*x, scale);
        }
        let pivot = rows[done].clone();
        for (i, row) in rows.iter_mut().enumerate() {
            if i == done || row[column].is_zero() {
                continue;
            }
            let factor = field.neg(row[column]);
            for (x, &y) in row.iter_mut().zip(&pivot).filter(|(_, y)| !y.is_zero()) {
                *x = field.add(*x, field.mul(factor, y));
            }
        }
        done += 1;
        if done == rows.len() {
            break;
        }
    }
    rows.truncate(done);
    rows
}

/// The solution of a square system, or `None` if it is singular.
pub(super) fn solve(
    field: PrimeField,
    matrix: Vec<Vec<Residue>>,
    right: Vec<Residue>,
) -> Option<Vec<Residue>> {
    let n = right.len();
    let augmented: Vec<Vec<Residue>> = matrix
        .into_iter()
        .zip(right)
        .map(|(mut row, b)| {
            row.push(b);
            row
        })
        .collect();
    let order: Vec<usize> = (0..n).collect();
    let rows = reduced(field, &augmented, &order);
    let regular = rows.len() == n && (0..n).all(|i| !rows[i][i].is_zero());
    regular.then(|| rows.iter().map(|row| row[n]).collect())
}
