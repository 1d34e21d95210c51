//! The program on a pseudo-terminal: what it leaves behind on every way out, and what it takes in and sends.

mod endings;
mod hostile;
mod kept;
mod lab;
mod page;
mod session;
mod workbench;
