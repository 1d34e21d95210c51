//! Many orbits: the order of results, and what ends them.

mod pool;
