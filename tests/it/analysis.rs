//! What `analysis` says of histories whose nature is known.

mod landscape;
mod level;
mod verdict;
