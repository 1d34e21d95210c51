//! Many orbits: the order of results, and what ends them, what a run of each tells.

mod outcome;
mod pool;
