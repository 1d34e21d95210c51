//! What `analysis` says of histories whose nature is known.

mod brackets;
mod landscape;
mod level;
mod verdict;
