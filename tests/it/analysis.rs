//! What `analysis` says of histories whose nature is known.

mod brackets;
mod inquiry;
mod landscape;
mod level;
mod verdict;
