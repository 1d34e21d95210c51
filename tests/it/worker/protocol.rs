//! Commands in, snapshots out, with subjects that count and panic.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use phaselab::experiment::{AdvanceOutcome, Command, Snapshot, Status};
use phaselab::worker::{Runnable, Worker};

/// A subject that only counts.
#[derive(Default)]
struct Counter {
    epoch: u64,
    time: f64,
    speed: f64,
    running: bool,
    obeyed: f64,
    /// The number of times it was advanced.
    slices: Arc<AtomicU64>,
    panics_at: Option<f64>,
}

impl Counter {
    fn running(speed: f64) -> Counter {
        Counter { speed, running: true, ..Counter::default() }
    }
}

impl Runnable for Counter {
    fn set_epoch(&mut self, epoch: u64) {
        self.epoch = epoch;
    }

    fn execute(&mut self, command: Command) {
        match command {
            Command::Play => self.running = true,
            Command::Pause => self.running = false,
            Command::Speed(speed) => self.speed = speed,
            Command::Reset => self.time = 0.0,
            Command::Reference => panic!("this command panics"),
            _ => self.obeyed += 1.0,
        }
    }

    fn advance(&mut self, time: f64, budget: u64) -> AdvanceOutcome {
        self.slices.fetch_add(1, Ordering::SeqCst);
        // every unit of simulated time is a step
        let most = self.time + budget as f64;
        self.time = self.time.max(time.min(most));
        let in_order = self.panics_at.is_none_or(|at| self.time < at);
        assert!(in_order, "out of {}", "order");
        if self.time >= time { AdvanceOutcome::Arrived } else { AdvanceOutcome::Underway }
    }

    fn time(&self) -> f64 {
        self.time
    }

    fn speed(&self) -> f64 {
        self.speed
    }

    fn status(&self) -> Status {
        if self.running { Status::Running } else { Status::Paused }
    }

    fn snapshot(&self) -> Snapshot {
        Snapshot {
            time: self.time,
            status: self.status(),
            speed: self.speed,
            values: vec![self.obeyed].into(),
            ..Snapshot::empty(self.epoch)
        }
    }
}

/// Waits for a snapshot with a property.
fn wait(worker: &mut Worker, wanted: impl Fn(&Snapshot) -> bool) -> Arc<Snapshot> {
    let deadline = Instant::now() + Duration::from_secs(60);
    while Instant::now() < deadline {
        match worker.newest() {
            Some(snapshot) if wanted(&snapshot) => return snapshot,
            _ => std::thread::yield_now(),
        }
    }
    panic!("no such snapshot within a minute");
}

#[test]
fn a_paused_subject_is_shown_once_and_left_alone() {
    let counter = Counter::default();
    let slices = Arc::clone(&counter.slices);
    let mut worker = Worker::spawn(counter).expect("a thread");
    wait(&mut worker, |s| s.status == Status::Paused);
    assert!(worker.newest().is_none(), "the same snapshot is not given twice");
    worker.execute(Command::Speed(3.0));
    wait(&mut worker, |s| s.speed == 3.0);
    assert_eq!(slices.load(Ordering::SeqCst), 0);
}

#[test]
fn time_runs_at_the_speed_asked_for() {
    let mut worker = Worker::spawn(Counter::running(10.0)).expect("a thread");
    let first = wait(&mut worker, |_| true);
    let began = Instant::now();
    let later = wait(&mut worker, |s| s.time >= 3.0);
    let took = began.elapsed().as_secs_f64();
    // it may be slower if the machine is busy, and never faster (except by one frame)
    assert!(later.time - first.time <= 10.0 * (took + 0.05), "{} in {took} s", later.time);
}

#[test]
fn flat_out_is_as_fast_as_it_goes() {
    let mut worker = Worker::spawn(Counter::running(f64::INFINITY)).expect("a thread");
    wait(&mut worker, |s| s.time > 1e6);
}

#[test]
fn play_and_pause_are_obeyed_at_once() {
    let mut worker = Worker::spawn(Counter::running(f64::INFINITY)).expect("a thread");
    wait(&mut worker, |s| s.time > 0.0);
    worker.execute(Command::Pause);
    let held = wait(&mut worker, |s| s.status == Status::Paused);
    worker.execute(Command::Speed(2.0));
    let still = wait(&mut worker, |s| s.speed == 2.0);
    assert_eq!(held.time, still.time);
    worker.execute(Command::Play);
    wait(&mut worker, |s| s.time > still.time);
}

#[test]
fn every_command_is_obeyed_in_order() {
    let mut worker = Worker::spawn(Counter::running(f64::INFINITY)).expect("a thread");
    for index in 0..1000 {
        worker.execute(Command::Parameter { index, value: 0.0 });
    }
    worker.execute(Command::Pause);
    let snapshot = wait(&mut worker, |s| s.status == Status::Paused);
    assert_eq!(snapshot.values[0], 1000.0);
}

#[test]
fn a_command_about_time_sets_the_clock_anew() {
    let mut worker = Worker::spawn(Counter::running(1e6)).expect("a thread");
    wait(&mut worker, |s| s.time > 1e5);
    worker.execute(Command::Speed(1e-3));
    worker.execute(Command::Reset);
    wait(&mut worker, |s| s.speed == 1e-3 && s.time < 1.0);
    for _ in 0..3 {
        assert!(wait(&mut worker, |_| true).time < 1.0, "it goes on from the new time");
    }
}

#[test]
fn loading_raises_the_epoch_and_no_older_snapshot_follows() {
    let mut worker = Worker::spawn(Counter::running(f64::INFINITY)).expect("a thread");
    assert_eq!(worker.epoch(), 1);
    for epoch in 2..50 {
        wait(&mut worker, |_| true);
        assert_eq!(worker.load(Counter::running(f64::INFINITY)), epoch);
        assert_eq!(wait(&mut worker, |_| true).epoch, epoch);
    }
}

#[test]
fn an_idle_worker_waits_for_its_first_subject() {
    let mut worker = Worker::idle().expect("a thread");
    worker.execute(Command::Play);
    assert!(worker.newest().is_none());
    assert_eq!(worker.load(Counter::running(1.0)), 1);
    wait(&mut worker, |s| s.epoch == 1);
}

#[test]
fn a_panic_becomes_an_error_and_the_worker_goes_on() {
    let broken = Counter { panics_at: Some(1e3), ..Counter::running(f64::INFINITY) };
    let mut worker = Worker::spawn(broken).expect("a thread");
    let snapshot = wait(&mut worker, |s| matches!(s.status, Status::Failed(_)));
    let Status::Failed(error) = &snapshot.status else { unreachable!("just looked") };
    assert!(error.message.contains("out of order"), "{}", error.message);
    assert_eq!(snapshot.epoch, 1);
    worker.load(Counter::running(f64::INFINITY));
    wait(&mut worker, |s| s.time > 1e3 && s.status == Status::Running);
}

#[test]
fn a_command_that_panics_is_reported_as_well() {
    let mut worker = Worker::spawn(Counter::default()).expect("a thread");
    worker.execute(Command::Reference);
    let snapshot = wait(&mut worker, |s| matches!(s.status, Status::Failed(_)));
    let Status::Failed(error) = &snapshot.status else { unreachable!("just looked") };
    assert!(error.message.contains("this command panics"), "{}", error.message);
}

#[test]
fn dropping_the_worker_ends_its_thread() {
    let counter = Counter::running(f64::INFINITY);
    let slices = Arc::clone(&counter.slices);
    let mut worker = Worker::spawn(counter).expect("a thread");
    wait(&mut worker, |s| s.time > 0.0);
    drop(worker);
    // the thread owned the only other handle
    assert_eq!(Arc::strong_count(&slices), 1);
}
