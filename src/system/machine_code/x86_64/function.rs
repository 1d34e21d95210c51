//! A compiled function and its call: the only place of the program with `unsafe` code.
//!
//! In: the bytes of a function. Out: its call on slices. Never here: what it computes, how it is encoded.
//!
//! What the compiler of this source cannot check holds for these reasons:
//! - The bytes are a function with the signature of [`FunctionPointer`]: they read nothing but its six arguments, change no register
//!   that belongs to the caller, call nothing but the loops behind them, and end with a return (`encoding`, `product_loops`).
//! - It reads and writes only inside the six stretches of memory that it is given: `compile` compares every address with
//!   the lengths of the layout, and each call the lengths of the slices with these. What is read is numbers, for
//!   which every pattern of bits is valid; the only addresses that are read from memory are rows of a matrix, written
//!   by [`CompiledGrowth`](super::CompiledGrowth) before each call as a permutation of its rows.
//! - Its instructions are those that [`CompiledFunction::of`] and [`widest`] have asked the processor for.
//! - Where one call serves a part of the orbits, it reads and writes the same part of every [`Batch`]: the addresses of the
//!   second part are half a batch behind.
//! - The pages are writable until the bytes are in them, and executable from then on. They stay as long as the function may
//!   be called, which borrows it; they are given back when it is dropped.
#![allow(unsafe_code, reason = "generated code is put into memory, called and freed")]

use std::ffi::c_void;
use std::ptr::{NonNull, null_mut};

use pulp::x86::{V3, V4};
use rustix::mm::{MapFlags, MprotectFlags, ProtFlags, mmap_anonymous, mprotect, munmap};

use super::basic_block::Width;
use super::layout::{Area, LINE};
use crate::num::{BATCH, Batch, DoubleDouble};

/// The values, the work, the series and the state, and the exact series and state.
type FunctionPointer =
    unsafe extern "sysv64" fn(*const f64, *mut f64, *mut f64, *mut f64, *mut f64, *mut f64);

/// The areas in the order of the arguments.
const AREAS: [Area; 6] =
    [Area::Values, Area::Work, Area::Series, Area::State, Area::ExactSeries, Area::ExactState];

/// Why no function was compiled.
#[derive(Debug)]
pub(super) struct NotCompiled;

/// Pages of memory with code in them.
#[derive(Debug)]
struct Pages {
    start: NonNull<c_void>,
    length: usize,
}

// SAFETY: nobody writes to the pages, and only their owner frees them
unsafe impl Send for Pages {}
// SAFETY: the same
unsafe impl Sync for Pages {}

impl Pages {
    /// Pages with these bytes; `None` where memory may not be made executable.
    fn of(bytes: &[u8]) -> Option<Pages> {
        let (protection, flags) = (ProtFlags::READ | ProtFlags::WRITE, MapFlags::PRIVATE);
        // SAFETY: a new mapping, wherever there is room
        let start = unsafe { mmap_anonymous(null_mut(), bytes.len(), protection, flags) };
        let pages = Pages { start: NonNull::new(start.ok()?)?, length: bytes.len() };
        // SAFETY: so many bytes were mapped, and nobody else knows them
        unsafe {
            pages
                .start
                .cast::<u8>()
                .copy_from_nonoverlapping(NonNull::from(bytes).cast(), bytes.len());
        }
        let executable = MprotectFlags::READ | MprotectFlags::EXEC;
        // SAFETY: nobody writes to them any more
        unsafe { mprotect(pages.start.as_ptr(), pages.length, executable) }.ok()?;
        Some(pages)
    }
}

impl Drop for Pages {
    fn drop(&mut self) {
        // SAFETY: they were mapped, and nobody calls what is in them. Where they stay, memory is lost and nothing else.
        let _ = unsafe { munmap(self.start.as_ptr(), self.length) };
    }
}

#[derive(Clone, Copy)]
pub(super) enum Values<'a> {
    Plain(&'a [f64]),
    Exact(&'a [DoubleDouble]),
}

pub(super) struct Stretches<'a> {
    pub(super) values: Values<'a>,
    pub(super) work: &'a mut WorkMemory,
    pub(super) series: &'a mut [f64],
    pub(super) state: &'a mut [f64],
    pub(super) exact_series: &'a mut [DoubleDouble],
    pub(super) exact_state: &'a mut [DoubleDouble],
}

/// A cache line.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
struct Line([f64; LINE]);

/// A stretch of memory that begins with a cache line.
#[derive(Clone, Debug)]
pub(super) struct WorkMemory {
    lines: Vec<Line>,
    length: usize,
}

impl WorkMemory {
    pub(super) fn of(numbers: &[f64]) -> WorkMemory {
        let mut work = WorkMemory {
            lines: vec![Line([0.0; LINE]); numbers.len().div_ceil(LINE)],
            length: numbers.len(),
        };
        work.copy(0, numbers);
        work
    }

    /// Copies numbers to a place, which is the beginning of a cache line.
    pub(super) fn copy(&mut self, first: usize, numbers: &[f64]) {
        debug_assert!(first.is_multiple_of(LINE), "{first}");
        let lines = &mut self.lines[first / LINE..];
        let (whole, rest) = numbers.as_chunks::<LINE>();
        for (line, numbers) in lines.iter_mut().zip(whole) {
            line.0 = *numbers;
        }
        if !rest.is_empty() {
            lines[whole.len()].0[..rest.len()].copy_from_slice(rest);
        }
    }

    pub(super) fn set(&mut self, i: usize, number: f64) {
        self.lines[i / LINE].0[i % LINE] = number;
    }
}

/// The memory of one call for several orbits.
pub(super) struct BatchStretches<'a> {
    pub(super) values: &'a [Batch],
    pub(super) work: &'a mut WorkMemory,
    pub(super) series: &'a mut [Batch],
    pub(super) state: &'a mut [Batch],
}

/// How many numbers the widest instructions of this processor compute with.
pub(super) fn widest() -> Width {
    if V4::try_new().is_some() { Width::Eight } else { Width::Four }
}

#[derive(Debug)]
pub(super) struct CompiledFunction {
    pages: Pages,
    /// How many orbits one call serves.
    lanes: usize,
    lengths: [usize; 6],
}

impl CompiledFunction {
    /// Puts a function into memory that stays within these lengths.
    ///
    /// # Errors
    /// If the processor does not have AVX2 and fused multiply-adds, or memory may not be made executable.
    pub(super) fn of(
        bytes: &[u8],
        lanes: Width,
        length: impl Fn(Area) -> usize,
    ) -> Result<CompiledFunction, NotCompiled> {
        if V3::try_new().is_none() {
            return Err(NotCompiled);
        }
        let pages = Pages::of(bytes).ok_or(NotCompiled)?;
        Ok(CompiledFunction { pages, lanes: lanes.numbers(), lengths: AREAS.map(length) })
    }

    /// Calls it.
    ///
    /// # Panics
    /// If a stretch of memory has another length than that of the layout.
    pub(super) fn call(&self, memory: Stretches<'_>) {
        let Stretches { values, work, series, state, exact_series, exact_state } = memory;
        let (start, count) = match values {
            Values::Plain(values) => (values.as_ptr(), values.len()),
            Values::Exact(values) => (values.as_ptr().cast(), 2 * values.len()),
        };
        let (exact_series_len, exact_state_len) = (2 * exact_series.len(), 2 * exact_state.len());
        let lengths =
            [count, work.length, series.len(), state.len(), exact_series_len, exact_state_len];
        self.assert_lengths(lengths);
        // SAFETY: the code stays within these lengths; a `DoubleDouble` is two `f64`
        unsafe {
            self.enter(
                start,
                [
                    work.lines.as_mut_ptr().cast(),
                    series.as_mut_ptr(),
                    state.as_mut_ptr(),
                    exact_series.as_mut_ptr().cast(),
                    exact_state.as_mut_ptr().cast(),
                ],
            );
        }
    }

    /// Calls it for several orbits.
    ///
    /// # Panics
    /// If a stretch of memory has another length than that of the layout.
    pub(super) fn call_for_all(&self, memory: BatchStretches<'_>) {
        let BatchStretches { values, work, series, state } = memory;
        let lengths = [values.len(), series.len(), state.len()].map(|length| BATCH * length);
        let [values_len, series_len, state_len] = lengths;
        self.assert_lengths([values_len, work.length, series_len, state_len, 0, 0]);
        for first in (0..BATCH).step_by(self.lanes) {
            // SAFETY: the code stays within these lengths where it begins with the first orbit, and is as far from their
            // ends as from these beginnings where it begins with another
            unsafe {
                let behind = |stretch: *mut f64| stretch.add(first);
                self.enter(
                    values.as_ptr().cast::<f64>().add(first),
                    [
                        behind(work.lines.as_mut_ptr().cast()),
                        behind(series.as_mut_ptr().cast()),
                        behind(state.as_mut_ptr().cast()),
                        null_mut(),
                        null_mut(),
                    ],
                );
            }
        }
    }

    /// Panics unless these are the lengths of the layout. One by one: they were just put side by side, and wider loads would
    /// wait for that.
    #[inline]
    fn assert_lengths(&self, lengths: [usize; 6]) {
        let mut equal = true;
        for i in 0..lengths.len() {
            equal &= lengths[i] == self.lengths[i];
        }
        assert!(equal, "{lengths:?} instead of {:?}", self.lengths);
    }

    /// Calls the code.
    ///
    /// # Safety
    /// The code stays within what these pointers point to.
    unsafe fn enter(&self, values: *const f64, stretches: [*mut f64; 5]) {
        let [work, series, state, exact_series, exact_state] = stretches;
        // SAFETY: the code has this signature, and its caller vouches for the pointers
        unsafe {
            let entry: FunctionPointer = std::mem::transmute(self.pages.start.as_ptr());
            entry(values, work, series, state, exact_series, exact_state);
        }
    }
}
