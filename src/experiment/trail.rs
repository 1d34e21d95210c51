//! The recorded motion: rows of channel values, sealed in shared chunks so that a snapshot copies only the open one.

use std::sync::Arc;

/// The number of thinning levels, including the rows that are not thinned.
pub(super) const THINNINGS: usize = 4;

/// Two trails are equal if their rows are equal bit by bit.
impl PartialEq for Trail {
    fn eq(&self, other: &Self) -> bool {
        let bits = |trail: &Self| -> Vec<u64> {
            trail.rows().flatten().map(|value| value.to_bits()).collect()
        };
        self.width == other.width && bits(self) == bits(other)
    }
}

/// Recorded rows, the oldest first. Each row is the time followed by the value of every channel.
#[derive(Clone, Debug, Default)]
pub struct Trail {
    pub(super) sealed: Vec<Arc<Vec<f64>>>,
    /// The number of sealed chunks at each thinning level; the most thinned chunks, at the last level, come first.
    pub(super) thinned: [usize; THINNINGS],
    pub(super) open: Arc<Vec<f64>>,
    pub(super) width: usize,
    /// Whether it was recorded while time ran backwards.
    pub(super) backwards: bool,
}

impl Trail {
    /// Creates a trail from rows of `width` numbers each: the time, then the channels.
    pub fn from_rows(width: usize, rows: &[Vec<f64>]) -> Trail {
        let open = rows.iter().flat_map(|row| row.iter().copied().take(width)).collect();
        Trail { open: Arc::new(open), width, ..Trail::default() }
    }

    /// A number that increases along the trail: the time, or its negative if time ran backwards.
    pub fn order(&self, time: f64) -> f64 {
        if self.backwards { -time } else { time }
    }

    /// The part of the trail that was recorded up to a time.
    #[must_use]
    pub fn until(&self, time: f64) -> Trail {
        let (width, last) = (self.width.max(1), self.order(time));
        let rows_until = |chunk: &[f64]| {
            chunk.chunks_exact(width).take_while(|row| self.order(row[0]) <= last).count()
        };
        let mut trail = Trail { sealed: Vec::new(), ..self.clone() };
        for (index, chunk) in self.sealed.iter().enumerate() {
            let count = rows_until(chunk);
            if count * width == chunk.len() {
                trail.sealed.push(Arc::clone(chunk));
                continue;
            }
            trail.open = Arc::new(chunk[..count * width].to_vec());
            // the most thinned chunks come first
            let mut left = index;
            for level in (0..THINNINGS).rev() {
                trail.thinned[level] = trail.thinned[level].min(left);
                left -= trail.thinned[level];
            }
            return trail;
        }
        let count = rows_until(&self.open);
        trail.open = Arc::new(self.open[..count * width].to_vec());
        trail
    }

    /// The number of rows.
    pub fn len(&self) -> usize {
        if self.width == 0 {
            return 0;
        }
        let sealed: usize = self.sealed.iter().map(|chunk| chunk.len()).sum();
        (sealed + self.open.len()) / self.width
    }

    /// Whether nothing is recorded.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The row at an index, counted from the oldest.
    pub fn row(&self, index: usize) -> Option<&[f64]> {
        let mut from = index.checked_mul(self.width)?;
        for chunk in self.sealed.iter().chain(std::iter::once(&self.open)) {
            if from < chunk.len() {
                return chunk.get(from..from + self.width);
            }
            from -= chunk.len();
        }
        None
    }

    /// The rows, the oldest first: `row[0]` is the time, `row[1 + channel]` a channel's value.
    pub fn rows(&self) -> impl DoubleEndedIterator<Item = &[f64]> {
        let width = self.width.max(1);
        self.sealed
            .iter()
            .chain(std::iter::once(&self.open))
            .flat_map(move |c| c.chunks_exact(width))
    }
}
