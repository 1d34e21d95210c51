//! Work that is no longer wanted is stopped at whatever stage it is.

use std::fmt::Write as _;
use std::sync::mpsc::channel;
use std::thread;
use std::time::Duration;

use phaselab::cancel::Cancel;
use phaselab::diagnostic::Document;
use phaselab::experiment::Prepared;
use phaselab::expr::{Pool, Zero};

/// A chain of pendulums, which takes minutes to derive if it has many links.
fn chain(links: usize) -> Document {
    let mut text = "title = \"Chain\"\n[coordinates]\n".to_owned();
    for k in 1..=links {
        let _ = writeln!(text, "a{k} = {{ initial = 0.5 }}");
    }
    let sum = |k: usize, term: &dyn Fn(usize) -> String| {
        (1..=k).map(term).collect::<Vec<_>>().join(" + ")
    };
    let terms = (1..=links).map(|k| {
        let x = sum(k, &|i| format!("cos(a{i})*a{i}'"));
        let y = sum(k, &|i| format!("sin(a{i})*a{i}'"));
        let height = sum(k, &|i| format!("cos(a{i})"));
        format!("1/2*(({x})^2 + ({y})^2) + 9.81*({height})")
    });
    let _ = writeln!(text, "[lagrangian]\nL = \"{}\"", terms.collect::<Vec<_>>().join(" + "));
    Document::new("chain.toml", text)
}

#[test]
fn what_is_cancelled_before_it_begins_is_not_begun() {
    let cancel = Cancel::new();
    cancel.cancel();
    let unready = Prepared::with(&chain(64), &cancel).err().expect("nobody wants it");
    assert!(unready.report.contains("stopped before it was ready"), "{}", unready.report);
}

#[test]
fn a_derivation_ends_soon_after_it_is_cancelled() {
    for links in [40, 64] {
        let cancel = Cancel::new();
        let (reported, ended) = channel();
        let token = cancel.clone();
        thread::spawn(move || {
            let _ = reported.send(Prepared::with(&chain(links), &token).is_err());
        });
        thread::sleep(Duration::from_millis(50));
        cancel.cancel();
        let stopped = ended.recv_timeout(Duration::from_secs(10));
        assert_eq!(stopped, Ok(true), "a chain of {links}");
    }
}

#[test]
fn a_cancelled_pool_grows_no_more() {
    let cancel = Cancel::new();
    let mut pool = chain(4).read_with(&cancel).expect("it has no error").model.pool;
    let known = pool.named("a1");
    let next = pool.named("one more").index();
    cancel.cancel();
    assert!(!pool.is_full());
    let new = pool.named("another");
    assert!(new.index() < next && pool.is_full(), "nothing is added");
    let sum = pool.add(known, known);
    assert!(sum.index() < next);
}

#[test]
fn a_pool_of_its_own_is_not_stopped_by_another_token() {
    let mut pool = Pool::new();
    Cancel::new().cancel();
    let x = pool.named("x");
    let zero = pool.sub(x, x);
    assert_eq!(pool.is_zero(zero), Zero::Proved);
}
