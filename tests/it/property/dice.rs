//! Random numbers that are the same everywhere: SplitMix64 (Steele, Lea & Flood, OOPSLA 2014).

/// A stream of random numbers.
#[derive(Clone, Debug)]
pub(crate) struct Dice(u64);

impl Dice {
    /// The stream of one case of a seed.
    pub(crate) fn of(seed: u64, case: u64) -> Dice {
        let mut dice = Dice(seed);
        dice.0 = dice.next() ^ case.wrapping_mul(0xd134_2543_de82_ef95);
        dice.next();
        dice
    }

    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A uniform number between two bounds, with so few digits that a file remains readable.
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        let even = (self.next() >> 11) as f64 / (1_u64 << 53) as f64;
        let value = low + (high - low) * even;
        if (high - low) < 0.01 { value } else { (value * 1000.0).round() / 1000.0 }
    }

    pub(crate) fn below(&mut self, count: usize) -> usize {
        (self.next() % count as u64) as usize
    }

    pub(crate) fn chance(&mut self, share: f64) -> bool {
        self.between(0.0, 1.0) < share
    }

    pub(crate) fn pick<T: Clone>(&mut self, of: &[T]) -> T {
        of[self.below(of.len())].clone()
    }
}
