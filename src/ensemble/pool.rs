//! Work on many items at once, with results in the order of the items.
//!
//! In: a number of items and what is to be done with each. Out: each result, in order, as soon as all before it are
//! there. Nothing depends on the number of threads. Never here: what an item is.

use std::any::Any;
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

use crate::cancel::Cancel;

/// The stack of a thread, as large as that of a program's first one.
const STACK: usize = 16 << 20;

/// How many items may be computed ahead of the first that is not done, for each thread.
const AHEAD: usize = 1024;

/// Why there are no threads.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
#[error("the threads could not be started: {0}")]
pub struct PoolError(String);

/// A result, or what a panic left.
type ThreadResult<T> = Result<T, Box<dyn Any + Send>>;

/// What the threads and the consumer share.
struct ResultQueue<T> {
    done: Mutex<Done<T>>,
    changed: Condvar,
}

struct Done<T> {
    results: BTreeMap<usize, ThreadResult<T>>,
    /// The first item that was not handed on.
    first: usize,
    /// The threads still at work.
    working: usize,
}

impl<T> ResultQueue<T> {
    fn done(&self) -> MutexGuard<'_, Done<T>> {
        self.done.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn wait<'a>(&self, done: MutexGuard<'a, Done<T>>) -> MutexGuard<'a, Done<T>> {
        self.changed.wait(done).unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits until an item is not too far ahead of those handed on.
    fn admit(&self, item: usize, ahead: usize, stopped: &dyn Fn() -> bool) {
        let mut done = self.done();
        while item >= done.first + ahead && !stopped() {
            done = self.wait(done);
        }
    }

    /// The result of the next item; `None` if nobody will compute it.
    fn next(&self, item: usize) -> Option<ThreadResult<T>> {
        let mut done = self.done();
        loop {
            if let Some(result) = done.results.remove(&item) {
                done.first = item + 1;
                self.changed.notify_all();
                return Some(result);
            }
            if done.working == 0 {
                return None;
            }
            done = self.wait(done);
        }
    }
}

/// Does `work` on each of `count` items with so many threads, or 0 for all cores, and hands the results to `take` in the order of the
/// items, on the calling thread. Once cancelled, or once `take` breaks off, no further item is begun; what was begun
/// before is finished and handed on up to the first gap.
///
/// # Errors
/// Returns an error if the threads cannot be started.
///
/// # Panics
/// A panic of `work` is passed on to the caller.
pub fn in_order<T: Send>(
    threads: usize,
    count: usize,
    cancel: &Cancel,
    work: impl Fn(usize) -> T + Sync,
    mut take: impl FnMut(usize, T) -> ControlFlow<()>,
) -> Result<(), PoolError> {
    let threads = threads.min(count.max(1));
    let builder = rayon::ThreadPoolBuilder::new().num_threads(threads).stack_size(STACK);
    let pool = builder.build().map_err(|why| PoolError(why.to_string()))?;
    let threads = pool.current_num_threads();
    let (next, over) = (AtomicUsize::new(0), AtomicBool::new(false));
    let done = Done { results: BTreeMap::new(), first: 0, working: threads };
    let queue = ResultQueue { done: Mutex::new(done), changed: Condvar::new() };
    let stopped = || over.load(Ordering::Acquire) || cancel.is_cancelled();
    let break_off = || {
        // under the lock, so that nobody is between looking at it and waiting
        let done = queue.done();
        over.store(true, Ordering::Release);
        drop(done);
        queue.changed.notify_all();
    };
    let one_after_the_other = || {
        while !stopped() {
            let item = next.fetch_add(1, Ordering::Relaxed);
            if item >= count {
                break;
            }
            queue.admit(item, AHEAD * threads, &stopped);
            let result = catch_unwind(AssertUnwindSafe(|| work(item)));
            queue.done().results.insert(item, result);
            queue.changed.notify_all();
        }
        queue.done().working -= 1;
        queue.changed.notify_all();
    };
    let panicked = pool.in_place_scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|_| one_after_the_other());
        }
        for item in 0..count {
            let broken = match queue.next(item) {
                None => break,
                Some(Ok(result)) => take(item, result).is_break(),
                Some(Err(panic)) => {
                    break_off();
                    return Some(panic);
                }
            };
            if broken {
                break_off();
                break;
            }
        }
        None
    });
    panicked.map_or(Ok(()), |panic| resume_unwind(panic))
}
