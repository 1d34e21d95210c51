//! Numbers with all their first and second derivatives: values in, Hessians out. It uses nothing of the program.

/// The greatest number of variables: three coordinates, as many velocities, and the time.
pub(crate) const MOST: usize = 7;

/// A value with its gradient and Hessian (lower triangle by rows) in the first `count` variables.
#[derive(Clone, Copy)]
pub(crate) struct Jet {
    count: usize,
    pub(crate) value: f64,
    pub(crate) slope: [f64; MOST],
    bend: [f64; MOST * (MOST + 1) / 2],
}

fn index(i: usize, j: usize) -> usize {
    let (high, low) = (i.max(j), i.min(j));
    high * (high + 1) / 2 + low
}

/// A product of which one factor may be infinite where the other vanishes.
fn times(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 { 0.0 } else { a * b }
}

impl Jet {
    pub(crate) fn constant(count: usize, value: f64) -> Jet {
        Jet { count, value, slope: [0.0; MOST], bend: [0.0; MOST * (MOST + 1) / 2] }
    }

    pub(crate) fn variable(count: usize, i: usize, value: f64) -> Jet {
        let mut jet = Jet::constant(count, value);
        jet.slope[i] = 1.0;
        jet
    }

    pub(crate) fn second(&self, i: usize, j: usize) -> f64 {
        self.bend[index(i, j)]
    }

    pub(crate) fn add(&mut self, other: &Jet) {
        self.value += other.value;
        for i in 0..self.count {
            self.slope[i] += other.slope[i];
        }
        for k in 0..index(self.count, 0) {
            self.bend[k] += other.bend[k];
        }
    }

    pub(crate) fn plus(&self, other: &Jet) -> Jet {
        let mut sum = *self;
        sum.add(other);
        sum
    }

    /// The product with a number.
    pub(crate) fn scaled(&self, factor: f64) -> Jet {
        self.chain([factor * self.value, factor, 0.0])
    }

    pub(crate) fn times(&self, other: &Jet) -> Jet {
        let mut product = Jet::constant(self.count, self.value * other.value);
        for i in 0..self.count {
            product.slope[i] =
                times(self.slope[i], other.value) + times(self.value, other.slope[i]);
            for j in 0..=i {
                let k = index(i, j);
                product.bend[k] = times(self.bend[k], other.value)
                    + times(self.value, other.bend[k])
                    + times(self.slope[i], other.slope[j])
                    + times(self.slope[j], other.slope[i]);
            }
        }
        product
    }

    /// f(self), given f's value and first two derivatives there.
    pub(crate) fn chain(&self, [f, first, second]: [f64; 3]) -> Jet {
        let mut result = Jet::constant(self.count, f);
        for i in 0..self.count {
            result.slope[i] = times(first, self.slope[i]);
            for j in 0..=i {
                let k = index(i, j);
                result.bend[k] =
                    times(first, self.bend[k]) + times(second, times(self.slope[i], self.slope[j]));
            }
        }
        result
    }
}
