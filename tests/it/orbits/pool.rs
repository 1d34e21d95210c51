//! The pool: results in order, whatever the threads; cancelled and broken off.

use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};

use phaselab::cancel::Cancel;
use phaselab::ensemble::in_order;

/// Work that takes longer the earlier the item, so that later ones are done first.
fn uneven(i: usize) -> f64 {
    (0..(50 - i.min(49)) * 200).fold(i as f64, |x, k| (x + k as f64).sqrt())
}

#[test]
fn results_come_in_order_and_are_the_same_for_any_number_of_threads() {
    let with = |threads| {
        let mut all = Vec::new();
        let take = |i, x| {
            all.push((i, x));
            ControlFlow::Continue(())
        };
        in_order(threads, 50, &Cancel::new(), uneven, take).unwrap();
        all
    };
    let one = with(1);
    assert_eq!(one.iter().map(|r| r.0).collect::<Vec<_>>(), (0..50).collect::<Vec<_>>());
    for threads in [2, 3, 8, 200] {
        assert_eq!(with(threads), one, "{threads} threads");
    }
    let none = in_order(4, 0, &Cancel::new(), uneven, |_, _| panic!("there is nothing"));
    none.unwrap();
}

#[test]
fn after_a_cancellation_nothing_is_begun_and_what_was_done_is_handed_on() {
    let (cancel, begun) = (Cancel::new(), AtomicUsize::new(0));
    let mut taken = Vec::new();
    let work = |i| {
        begun.fetch_add(1, Ordering::SeqCst);
        if i == 7 {
            cancel.cancel();
        }
        i
    };
    let take = |i, _| {
        taken.push(i);
        ControlFlow::Continue(())
    };
    in_order(3, 1_000_000, &cancel, work, take).unwrap();
    assert!(taken.len() >= 8 && begun.load(Ordering::SeqCst) < 100_000, "{}", taken.len());
    assert_eq!(taken, (0..taken.len()).collect::<Vec<_>>());
}

#[test]
fn whoever_takes_may_break_off() {
    let begun = AtomicUsize::new(0);
    let mut taken = 0;
    let work = |_| begun.fetch_add(1, Ordering::SeqCst);
    let take = |i, _| {
        taken += 1;
        if i == 4 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    in_order(4, 10_000_000, &Cancel::new(), work, take).unwrap();
    assert_eq!(taken, 5);
    assert!(begun.load(Ordering::SeqCst) < 1_000_000);
}

#[test]
fn a_panic_of_one_item_reaches_the_caller() {
    let take = |_, ()| ControlFlow::Continue(());
    let outcome = catch_unwind(AssertUnwindSafe(|| {
        in_order(2, 100, &Cancel::new(), |i| assert_ne!(i, 30, "thirty"), take)
    }));
    let panic = outcome.unwrap_err();
    assert!(panic.downcast_ref::<String>().is_some_and(|said| said.contains("thirty")));
}
