//! Records a motion in bounded memory: the newest rows in full, older ones thinned to every second, fourth and
//! eighth, and the oldest dropped. It also keeps the bounds of every channel, and the hulls of
//! points of the picture, over all rows ever recorded.
//!
//! In: rows at even times. Out: a [`Trail`], cheap to clone. Never here: when a row is due for drawing, or what its
//! numbers mean.

use std::collections::VecDeque;
use std::sync::Arc;

use super::Trail;
use super::hull::{Hull, Hulls};
use super::trail::THINNINGS;

/// The number of rows in a sealed chunk.
const CHUNK: usize = 128;

/// The greatest number of chunks at each thinning; the first are the newest rows, not thinned.
const CHUNKS: [usize; THINNINGS] = [64, 32, 32, 32];

/// The greatest number of stored values (48 MB), for systems with very many channels.
pub(super) const NUMBERS: usize = 6_000_000;

#[derive(Clone, Debug)]
pub(super) struct Recorder {
    width: usize,
    /// The time from which the current spacing counts.
    origin: f64,
    spacing: f64,
    count: u64,
    /// The time of the last row that was due.
    last: Option<f64>,
    /// `sealed[k]` contains every 2ᵏ-th row, the oldest chunk first.
    sealed: [VecDeque<Arc<Vec<f64>>>; CHUNKS.len()],
    limits: [usize; CHUNKS.len()],
    /// −1 if the times at which rows are due are −t, otherwise 1. Rows have t.
    sign: f64,
    open: Arc<Vec<f64>>,
    bounds: Vec<(f64, f64)>,
    hulls: Hulls,
}

impl Recorder {
    /// Creates a recorder of rows of that many channels, one per `spacing` of time.
    pub(super) fn new(channels: usize, spacing: f64) -> Recorder {
        Recorder { spacing, ..Recorder::bounded(channels, NUMBERS) }
    }

    /// Creates a recorder that stores at most so many numbers.
    pub(super) fn bounded(channels: usize, numbers: usize) -> Recorder {
        let width = channels + 1;
        let most = numbers / (width * CHUNK);
        let all: usize = CHUNKS.iter().sum();
        Recorder {
            width,
            origin: 0.0,
            spacing: 1.0,
            count: 0,
            last: None,
            sealed: Default::default(),
            limits: CHUNKS.map(|limit| limit.min((limit * most / all).max(2))),
            sign: 1.0,
            open: Arc::default(),
            bounds: vec![(f64::INFINITY, f64::NEG_INFINITY); channels],
            hulls: Hulls::default(),
        }
    }

    /// Clears the recorder; the next row is due at `origin`.
    pub(super) fn restart(&mut self, origin: f64) {
        let (limits, spacing, hulls) = (self.limits, self.spacing, self.hulls.begun_anew());
        *self = Recorder { origin, limits, hulls, ..Recorder::new(self.width - 1, spacing) };
    }

    /// Clears the recorder of all but the bounds; the next row is due when the clock, −t if `backwards`, is at `origin`.
    pub(super) fn turn(&mut self, origin: f64, backwards: bool) {
        let bounds = std::mem::take(&mut self.bounds);
        let hulls = std::mem::take(&mut self.hulls);
        self.restart(origin);
        (self.bounds, self.hulls) = (bounds, hulls);
        self.sign = if backwards { -1.0 } else { 1.0 };
    }

    /// The time between two rows.
    pub(super) fn spacing(&self) -> f64 {
        self.spacing
    }

    /// Forgets the rows from a time on; the next one is due then. The bounds stay.
    pub(super) fn rewind(&mut self, time: f64) {
        let width = self.width;
        let sign = self.sign;
        let before = |chunk: &[f64]| {
            chunk.chunks_exact(width).take_while(|row| sign * row[0] < time).count()
        };
        let rest = before(&self.open);
        Arc::make_mut(&mut self.open).truncate(rest * width);
        if rest == 0 {
            self.reopen(before);
        }
        (self.origin, self.count, self.last) = (time, 0, None);
    }

    /// Opens the newest chunk that has rows which stay, without the others.
    fn reopen(&mut self, before: impl Fn(&[f64]) -> usize) {
        for level in &mut self.sealed {
            while let Some(chunk) = level.pop_back() {
                match before(&chunk) {
                    0 => {}
                    CHUNK => {
                        level.push_back(chunk);
                        return;
                    }
                    rest => {
                        self.open = chunk;
                        Arc::make_mut(&mut self.open).truncate(rest * self.width);
                        return;
                    }
                }
            }
        }
    }

    /// Changes the time between two rows, counted from the last one.
    pub(super) fn set_spacing(&mut self, spacing: f64) {
        if spacing != self.spacing {
            let last = self.count.saturating_sub(1) as f64;
            self.origin += last * self.spacing;
            self.count = self.count.min(1);
            self.spacing = spacing;
        }
    }

    /// When the next row is due. The time is counted, not summed, so that rounding errors do not accumulate. It is
    /// always later than the last row, even if the spacing is below the resolution of the time.
    pub(super) fn due(&self) -> f64 {
        let due = self.origin + self.count as f64 * self.spacing;
        self.last.map_or(due, |last| due.max(last.next_up()))
    }

    pub(super) fn record(&mut self, time: f64, values: &[f64]) {
        self.count += 1;
        self.last = Some(time);
        self.insert(time, values);
    }

    /// Records an extra row before the next one is due.
    pub(super) fn insert(&mut self, time: f64, values: &[f64]) {
        self.widen(values);
        // copies the open chunk if a snapshot still shares it
        let open = Arc::make_mut(&mut self.open);
        open.push(self.sign * time);
        open.extend_from_slice(values);
        if open.len() == CHUNK * self.width {
            let full = std::mem::take(&mut self.open);
            self.sealed[0].push_back(full);
            self.thin();
        }
    }

    /// Prepends an earlier trail with its thinning. `row` converts a row of the trail to this recorder's channels, or
    /// drops it. The times of due rows do not change.
    pub(super) fn precede(&mut self, earlier: &Trail, row: impl Fn(&[f64]) -> Option<Vec<f64>>) {
        let later = self.trail();
        self.sealed = Default::default();
        self.open = Arc::default();
        let mut chunks = earlier.sealed.iter();
        for level in (0..THINNINGS).rev() {
            for chunk in chunks.by_ref().take(earlier.thinned[level]) {
                let rows: Vec<Vec<f64>> =
                    chunk.chunks_exact(earlier.width).filter_map(&row).collect();
                if rows.len() == CHUNK {
                    for row in &rows {
                        self.widen(&row[1..]);
                    }
                    self.sealed[level].push_back(Arc::new(rows.concat()));
                } else {
                    for row in &rows {
                        self.insert(row[0], &row[1..]);
                    }
                }
            }
        }
        let rest = earlier.open.chunks_exact(earlier.width.max(1)).filter_map(row);
        rest.for_each(|row| self.insert(row[0], &row[1..]));
        later.rows().for_each(|row| self.insert(row[0], &row[1..]));
    }

    /// Keeps the hulls of these points from now on.
    #[must_use]
    pub(super) fn with_hulls(self, hulls: Hulls) -> Recorder {
        Recorder { hulls, ..self }
    }

    /// Keeps no hulls from now on.
    pub(super) fn forget_hulls(&mut self) {
        self.hulls = Hulls::default();
    }

    /// Widens the bounds and the hulls to include these values.
    pub(super) fn widen(&mut self, values: &[f64]) {
        self.hulls.widen(values);
        for ((least, greatest), &value) in self.bounds.iter_mut().zip(values) {
            if value.is_finite() {
                *least = least.min(value);
                *greatest = greatest.max(value);
            }
        }
    }

    pub(super) fn trail(&self) -> Trail {
        let sealed = self.sealed.iter().rev().flatten().cloned().collect();
        let thinned = std::array::from_fn(|level| self.sealed[level].len());
        let backwards = self.sign < 0.0;
        Trail { sealed, thinned, open: Arc::clone(&self.open), width: self.width, backwards }
    }

    /// The least and greatest value of every channel; (0, 0) if none was finite.
    pub(super) fn bounds(&self) -> Arc<[(f64, f64)]> {
        let seen = |&(least, greatest): &(f64, f64)| {
            if least <= greatest { (least, greatest) } else { (0.0, 0.0) }
        };
        self.bounds.iter().map(seen).collect()
    }

    pub(super) fn hulls(&self) -> Arc<[Hull]> {
        self.hulls.all().into()
    }

    /// Merges two chunks wherever a thinning has too many.
    fn thin(&mut self) {
        for level in 0..CHUNKS.len() {
            if self.sealed[level].len() <= self.limits[level] {
                return;
            }
            let older = self.sealed[level].pop_front();
            if level + 1 == CHUNKS.len() {
                return;
            }
            let newer = self.sealed[level].pop_front();
            let rows = older.iter().chain(&newer).flat_map(|c| c.chunks_exact(self.width));
            let thinned: Vec<f64> = rows.step_by(2).flatten().copied().collect();
            self.sealed[level + 1].push_back(Arc::new(thinned));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A recorder with `count` rows of one channel, whose value is the row's number.
    fn filled(count: u64) -> Recorder {
        let mut recorder = Recorder::new(1, 0.5);
        recorder.restart(10.0);
        for k in 0..count {
            let due = recorder.due();
            recorder.record(due, &[k as f64]);
        }
        recorder
    }

    fn numbers(recorder: &Recorder) -> Vec<f64> {
        recorder.trail().rows().map(|row| row[1]).collect()
    }

    #[test]
    fn rows_are_due_at_even_times_and_in_order() {
        let recorder = filled(1000);
        assert_eq!(recorder.due(), 510.0);
        assert_eq!(numbers(&recorder), (0..1000).map(f64::from).collect::<Vec<_>>());
        assert!(recorder.trail().rows().all(|row| row[0] == 10.0 + 0.5 * row[1]));
    }

    #[test]
    fn another_spacing_counts_from_the_last_row() {
        let mut recorder = filled(3);
        recorder.set_spacing(4.0);
        assert_eq!(recorder.due(), 15.0);
        recorder.record(15.0, &[0.0]);
        recorder.set_spacing(4.0);
        assert_eq!(recorder.due(), 19.0);
    }

    #[test]
    fn memory_is_bounded_the_newest_rows_are_whole_and_older_ones_evenly_thinned() {
        let count = 300_000;
        let recorder = filled(count);
        let rows = numbers(&recorder);
        assert!((15_000..=21_000).contains(&rows.len()), "{}", rows.len());
        assert_eq!(rows.last(), Some(&(count as f64 - 1.0)));
        let gaps: Vec<f64> = rows.windows(2).map(|pair| pair[1] - pair[0]).collect();
        assert!(gaps.windows(2).all(|pair| pair[1] <= pair[0]), "thinning only grows with age");
        assert_eq!((gaps[0], gaps[gaps.len() - 1]), (8.0, 1.0));
        assert!(gaps.iter().rev().take(8000).all(|&gap| gap == 1.0));
    }

    #[test]
    fn many_channels_keep_fewer_rows() {
        let mut recorder = Recorder::new(2000, 1.0);
        for _ in 0..20_000 {
            let due = recorder.due();
            recorder.record(due, &vec![1.0; 2000]);
        }
        let rows = recorder.trail().len();
        assert!((1000..4000).contains(&rows), "{rows}");
    }

    #[test]
    fn bounds_outlive_the_rows_and_pass_over_what_is_not_finite() {
        let mut recorder = filled(200_000);
        recorder.widen(&[f64::NAN]);
        recorder.widen(&[f64::INFINITY]);
        assert_eq!(recorder.bounds()[0], (0.0, 199_999.0));
        recorder.restart(0.0);
        assert_eq!(recorder.bounds()[0], (0.0, 0.0));
        assert!(recorder.trail().is_empty());
    }

    #[test]
    fn a_past_taken_up_again_and_again_is_thinned_no_further() {
        let first = filled(120_000);
        let trail = first.trail();
        let mut again = filled(0);
        for _ in 0..5 {
            let before = again.trail();
            again = filled(0);
            let past = if before.is_empty() { &trail } else { &before };
            again.precede(past, |row| Some(row.to_vec()));
        }
        assert_eq!(numbers(&again), numbers(&first));
        assert_eq!(again.bounds()[0], (numbers(&first)[0], 119_999.0));
        // excluded rows are dropped, and later rows are appended
        let mut cut = filled(0);
        cut.insert(1e9, &[7.0]);
        cut.precede(&trail, |row| (row[1] < 1e5).then(|| row.to_vec()));
        let remaining = numbers(&cut);
        assert_eq!(remaining.last(), Some(&7.0));
        assert!(
            remaining[..remaining.len() - 1].iter().all(|&x| x < 1e5) && remaining.len() > 7000
        );
        assert!(remaining[..remaining.len() - 1].windows(2).all(|pair| pair[0] < pair[1]));
    }

    #[test]
    fn rows_from_a_time_on_are_forgotten_and_due_again() {
        for time in [10.0, 10.7, 60.0, 74.0, 74.2, 400.0, 60_000.0] {
            let mut recorder = filled(120_000);
            let all = numbers(&recorder);
            recorder.rewind(time);
            let remaining: Vec<f64> = all.into_iter().filter(|k| 10.0 + 0.5 * k < time).collect();
            assert_eq!(numbers(&recorder), remaining, "{time}");
            assert_eq!(recorder.due(), time);
            recorder.record(time, &[-1.0]);
            assert_eq!(recorder.due(), time + 0.5);
            for _ in 0..1000 {
                let due = recorder.due();
                recorder.record(due, &[-2.0]);
            }
            let later = numbers(&recorder);
            assert_eq!(later.iter().filter(|x| **x == -2.0).count(), 1000, "{time}");
        }
    }

    #[test]
    fn a_snapshot_keeps_what_it_saw() {
        let mut recorder = filled(100);
        let trail = recorder.trail();
        for _ in 0..10_000 {
            let due = recorder.due();
            recorder.record(due, &[-1.0]);
        }
        assert_eq!(trail.len(), 100);
        assert!(trail.rows().all(|row| row[1] >= 0.0));
    }
}
