//! Tests of `analysis` on histories of a known kind.

mod brackets;
mod inquiry;
mod landscape;
mod level;
mod verdict;
