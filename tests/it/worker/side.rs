//! Jobs with real threads: the newest has priority, a stop is obeyed, a panic is reported.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use phaselab::job::{Job, Outcome};
use phaselab::worker::SideJob;

/// Waits for a result, for at most a minute.
fn until<T>(mut look: impl FnMut() -> Option<T>) -> T {
    let begun = Instant::now();
    loop {
        if let Some(found) = look() {
            return found;
        }
        assert!(begun.elapsed() < Duration::from_secs(60), "nothing came");
        thread::yield_now();
    }
}

/// A job that ends only when it is cancelled, and then reports that.
fn endless(ended: &Arc<AtomicBool>) -> Job<u32> {
    let ended = Arc::clone(ended);
    Job::new("endless", move |progress| {
        let mut count = 0;
        while !progress.is_cancelled() {
            count += 1;
            progress.reach(count);
            thread::yield_now();
        }
        ended.store(true, Ordering::SeqCst);
        0
    })
}

#[test]
fn a_job_gives_its_result_once() {
    let mut side = SideJob::new("test");
    side.begin(7, Job::new("adding", |_| 1 + 1));
    assert_eq!(until(|| side.take()), (7, Outcome::Done(2)));
    assert!(side.take().is_none() && !side.is_busy());
}

#[test]
fn the_next_job_stops_the_one_before_and_its_result_is_dropped() {
    let ended = Arc::new(AtomicBool::new(false));
    let mut side = SideJob::new("test");
    side.begin(1, endless(&ended));
    side.begin(2, Job::new("five", |_| 5));
    assert_eq!(until(|| side.take()), (2, Outcome::Done(5)));
    until(|| ended.load(Ordering::SeqCst).then_some(()));
    assert!(side.take().is_none());
}

/// It may have ended, and nobody has asked for it.
#[test]
fn the_result_of_an_earlier_job_is_no_answer_to_a_later_one() {
    let mut side = SideJob::new("test");
    for _ in 0..100 {
        let ended = Arc::new(AtomicBool::new(false));
        let end = Arc::clone(&ended);
        side.begin(
            1,
            Job::new("four", move |_| {
                end.store(true, Ordering::SeqCst);
                4
            }),
        );
        until(|| ended.load(Ordering::SeqCst).then_some(()));
        side.begin(2, Job::new("five", |_| 5));
        assert_eq!(until(|| side.take()), (2, Outcome::Done(5)));
    }
}

#[test]
fn a_job_ends_with_its_owner_at_once() {
    let ended = Arc::new(AtomicBool::new(false));
    let mut side = SideJob::new("test");
    side.begin(1, endless(&ended));
    until(|| side.share().filter(|(_, share)| share.done > 0));
    let begun = Instant::now();
    drop(side);
    assert!(begun.elapsed() < Duration::from_millis(200), "nobody waits for it");
    until(|| ended.load(Ordering::SeqCst).then_some(()));
}

#[test]
fn progress_never_becomes_less() {
    let ended = Arc::new(AtomicBool::new(false));
    let mut side = SideJob::new("test");
    side.begin(3, endless(&ended));
    let mut last = 0;
    for _ in 0..1000 {
        let (ticket, share) = side.share().expect("it is under way");
        assert!(ticket == 3 && share.done >= last && share.total.is_none());
        last = share.done;
    }
    side.stop();
    assert!(!side.is_busy() && side.share().is_none() && side.take().is_none());
}

#[test]
fn a_panic_on_the_side_is_reported() {
    let mut side: SideJob<()> = SideJob::new("test");
    side.begin(1, Job::new("the search", |_| panic!("there is a hole")));
    let reported = "the search stopped by a bug in phaselab: there is a hole".to_owned();
    assert_eq!(until(|| side.take()), (1, Outcome::Failed(reported)));
    // and another job can begin
    side.begin(2, Job::new("nothing", |_| ()));
    assert_eq!(until(|| side.take()), (2, Outcome::Done(())));
}
