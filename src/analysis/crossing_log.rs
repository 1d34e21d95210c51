//! Where a motion has crossed the surfaces of section of its file.
//!
//! In: the values of all channels at each crossing, located by the propagator. Out: rows, cheap to clone. Never here:
//! how a crossing is located, or the orbits of other starts.

use std::collections::VecDeque;
use std::sync::Arc;

/// The number of crossings in a sealed chunk.
const CHUNK: usize = 128;

/// The most numbers stored for a surface (16 MB); beyond it the oldest crossings are dropped.
const NUMBERS: usize = 2_000_000;

/// The crossings of each surface since the last restart, the oldest first.
#[derive(Clone, Debug, Default)]
pub struct CrossingLog {
    surfaces: Vec<Crossed>,
    counts: Arc<[u64]>,
    only_counts: bool,
}

/// The crossings of one surface: rows of the time and the value of every channel.
#[derive(Clone, Debug, Default)]
struct Crossed {
    sealed: VecDeque<Arc<Vec<f64>>>,
    open: Arc<Vec<f64>>,
}

impl CrossingLog {
    /// Creates an empty log of this many surfaces.
    pub fn new(surfaces: usize) -> CrossingLog {
        CrossingLog {
            surfaces: vec![Crossed::default(); surfaces],
            counts: vec![0; surfaces].into(),
            only_counts: false,
        }
    }

    /// Clears the log.
    pub fn clear(&mut self) {
        let only_counts = self.only_counts;
        *self = CrossingLog { only_counts, ..CrossingLog::new(self.surfaces.len()) };
    }

    /// Only counts crossings from now on, without storing them.
    pub fn only_count(&mut self) {
        self.only_counts = true;
    }

    /// Adds a crossing.
    pub fn push(&mut self, surface: usize, time: f64, values: &[f64]) {
        let Some(crossed) = self.surfaces.get_mut(surface) else { return };
        Arc::make_mut(&mut self.counts)[surface] += 1;
        if self.only_counts {
            return;
        }
        let width = values.len() + 1;
        let open = Arc::make_mut(&mut crossed.open);
        open.push(time);
        open.extend_from_slice(values);
        if open.len() == CHUNK * width {
            let full = std::mem::take(&mut crossed.open);
            crossed.sealed.push_back(full);
            if crossed.sealed.len() > (NUMBERS / (CHUNK * width)).max(1) {
                crossed.sealed.pop_front();
            }
        }
    }

    /// Forgets the crossings after a time, of a motion with this many channels; with the sign −1, those at earlier times.
    /// Chunks that end before it stay shared.
    pub fn rewind(&mut self, time: f64, sign: f64, channels: usize) {
        let width = channels + 1;
        for (surface, crossed) in self.surfaces.iter_mut().enumerate() {
            let mut removed = 0;
            loop {
                let is_later = |row: &[f64]| sign * row[0] > sign * time;
                let later = crossed.open.chunks_exact(width).rev().take_while(|row| is_later(row));
                let later = later.count();
                if later > 0 {
                    removed += later;
                    let left = crossed.open.len() - later * width;
                    crossed.open = Arc::new(crossed.open[..left].to_vec());
                }
                let last =
                    crossed.sealed.back().and_then(|chunk| chunk.chunks_exact(width).next_back());
                if !(crossed.open.is_empty() && last.is_some_and(is_later)) {
                    break;
                }
                crossed.open = crossed.sealed.pop_back().unwrap_or_default();
            }
            if removed > 0 {
                Arc::make_mut(&mut self.counts)[surface] -= removed as u64;
            }
        }
    }

    /// How often each surface was crossed, including crossings that were dropped.
    pub fn counts(&self) -> &[u64] {
        &self.counts
    }

    /// The stored crossings of a surface by a motion with this many channels, the oldest first: `row[0]` is the time,
    /// `row[1 + channel]` a channel's value.
    pub fn rows(
        &self,
        surface: usize,
        channels: usize,
    ) -> impl DoubleEndedIterator<Item = &[f64]> + Clone {
        let crossed = self.surfaces.get(surface).into_iter();
        let chunks = crossed.flat_map(|c| c.sealed.iter().chain(std::iter::once(&c.open)));
        chunks.flat_map(move |chunk| chunk.chunks_exact(channels + 1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_newest_crossings_are_stored_in_order_and_all_are_counted() {
        let mut log = CrossingLog::new(2);
        let channels = 999;
        let most = NUMBERS / (CHUNK * (channels + 1)) * CHUNK;
        let count = most + 5 * CHUNK + 7;
        for k in 0..count {
            log.push(1, k as f64, &vec![-(k as f64); channels]);
        }
        let times: Vec<f64> = log.rows(1, channels).map(|row| row[0]).collect();
        assert_eq!((log.counts(), times.len()), (&[0, count as u64][..], most + 7));
        assert!(times.windows(2).all(|pair| pair[1] == pair[0] + 1.0));
        assert_eq!(times.last(), Some(&(count as f64 - 1.0)));
        assert!(log.rows(1, channels).all(|row| row[channels] == -row[0]));
        let mut back = log.clone();
        back.rewind(count as f64 - 3.5, 1.0, channels);
        assert_eq!(back.counts(), [0, count as u64 - 3]);
        assert_eq!(back.rows(1, channels).count(), most + 4);
        assert_eq!(log.rows(0, channels).count(), 0);
        log.only_count();
        log.clear();
        log.push(0, 1.0, &vec![0.0; channels]);
        log.push(2, 1.0, &vec![0.0; channels]);
        assert_eq!((log.counts(), log.rows(0, channels).count()), (&[1, 0][..], 0));
    }

    #[test]
    fn a_copy_keeps_what_it_saw() {
        let mut log = CrossingLog::new(1);
        log.push(0, 1.0, &[2.0]);
        let before = log.clone();
        log.push(0, 3.0, &[4.0]);
        assert_eq!(before.rows(0, 1).collect::<Vec<_>>(), [[1.0, 2.0]]);
        assert_eq!((before.counts()[0], log.counts()[0]), (1, 2));
    }
}
