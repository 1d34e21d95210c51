//! The program on a pseudo-terminal: the state in which it leaves the terminal on every exit, its input and output.

mod background;
mod check;
mod decoder;
mod endings;
mod governor;
mod hostile;
mod keyboard;
mod lab;
mod page;
mod session;
mod storage;
mod workbench;
