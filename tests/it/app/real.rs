//! The application with a real experiment: requests are carried out, and their results are sent back.

use std::sync::Arc;

use crossterm::event::KeyEvent;
use phaselab::app::{App, AppEvent, Effect, Lab, Loaded, ValueId};
use phaselab::experiment::{Command, Experiment, Setup, Snapshot, Status};
use proptest::prelude::*;

use crate::cases;
use crate::fixtures::{catalog, key, loaded};
use crate::screen::screen_text;

/// The length of a frame in seconds.
const FRAME: f64 = 1.0 / 60.0;

/// A lab and its experiment.
pub(crate) struct Real {
    pub(crate) app: App,
    pub(crate) experiment: Experiment,
}

impl Real {
    pub(crate) fn of(name: &str) -> Self {
        Self::with(loaded(name, 1))
    }

    /// Opens the lab of a system with an experiment.
    pub(crate) fn with(loaded: Loaded) -> Self {
        let setup = Setup::of(&loaded.model);
        let Loaded { model, equations, system, .. } = &loaded;
        let mut experiment = Experiment::new(model, equations, system, setup).unwrap();
        experiment.set_epoch(loaded.epoch);
        let (mut app, _) = App::new(catalog(), Some(&loaded.name));
        app.update(AppEvent::Loaded(Ok(loaded)));
        let mut real = Self { app, experiment };
        real.look();
        real
    }

    pub(crate) fn look(&mut self) {
        self.app.update(AppEvent::Snapshot(Arc::new(self.experiment.snapshot())));
    }

    /// Carries out the requested effects.
    pub(crate) fn execute(&mut self, effects: Vec<Effect>) {
        for effect in effects {
            if let Effect::Execute(command) = effect {
                self.experiment.execute(command);
            }
        }
    }

    pub(crate) fn press(&mut self, keys: &str) {
        for word in keys.split_whitespace() {
            self.press_key(key(word));
        }
    }

    pub(crate) fn press_key(&mut self, key: KeyEvent) {
        let effects = self.app.update(AppEvent::Key(key));
        self.execute(effects);
        self.look();
    }

    pub(crate) fn lab(&self) -> &Lab {
        self.app.lab.as_ref().unwrap()
    }

    pub(crate) fn seen(&self) -> &Snapshot {
        self.app.snapshot().unwrap()
    }

    /// Advances by some frames.
    pub(crate) fn run(&mut self, frames: u32) {
        let time = self.experiment.time() + f64::from(frames) * FRAME * self.experiment.speed();
        self.experiment.advance(time, u64::MAX);
        self.look();
    }

    /// Everything that can be undone, as text.
    fn state(&self) -> String {
        let (lab, seen) = (self.lab(), self.seen());
        let values: Vec<_> = (0..lab.count(ValueId::Parameter))
            .map(ValueId::Parameter)
            .chain((0..lab.count(ValueId::Initial)).map(ValueId::Initial))
            .map(|target| lab.value(target))
            .collect();
        format!(
            "{:?} {values:?} {:?} {:?} {:?} {:?} {:?}",
            lab.plots,
            seen.parameters,
            seen.initial,
            seen.setup.overrides,
            seen.method.name,
            seen.setup.settings
        )
    }

    /// Everything visible of the motion from its beginning to a second later, as text.
    fn motion(mut self) -> String {
        // gauges of what page 2 found are no edit, and stay
        self.experiment.execute(Command::Follow(Vec::new()));
        self.press("r");
        self.run(60);
        // `auto` chose this method; it is the same one under its own name. What was undone has resumed the motion.
        let seen = format!("{:?}", self.seen()).replace("method: \"auto\"", "method: \"taylor\"");
        seen.replace("restored: true", "restored: false")
    }
}

#[test]
fn a_paused_motion_moves_by_exactly_one_frame() {
    for (keys, speed) in [("", 1.0), ("]", 2.0), ("[ [", 0.2)] {
        let mut real = Real::of("pendulum");
        real.run(30);
        real.press(keys);
        real.press("Space");
        assert_eq!(real.seen().status, Status::Paused);
        for _ in 0..5 {
            let before = real.seen().time;
            real.press(".");
            assert_eq!(real.seen().time, before + FRAME * speed, "at speed {speed}");
            assert_eq!(real.seen().status, Status::Paused);
        }
        real.press("Space");
        assert_eq!(real.seen().status, Status::Running);
    }
}

#[test]
fn a_reset_keeps_the_parameters_and_a_full_one_does_not() {
    let mut real = Real::of("pendulum");
    let file = (real.seen().parameters.clone(), real.seen().initial.clone());
    real.press("Right Right Tab Right");
    let chosen = (real.seen().parameters.clone(), real.seen().initial.clone());
    assert_ne!((&file.0, &file.1), (&chosen.0, &chosen.1));
    let begun: Vec<f64> = real.seen().values.to_vec();
    real.run(50);
    assert!(real.seen().time > 0.5 && *real.seen().values != *begun);
    real.press("r");
    assert_eq!(real.seen().time, 0.0);
    assert_eq!((&real.seen().parameters, &real.seen().initial), (&chosen.0, &chosen.1));
    assert_eq!(*real.seen().values, *begun, "q and p are those of the beginning, to the bit");
    real.run(50);
    real.press("R");
    assert_eq!(real.seen().time, 0.0);
    assert_eq!((&real.seen().parameters, &real.seen().initial), (&file.0, &file.1));
}

#[test]
fn a_new_reference_measures_drift_from_here_and_says_so() {
    // Its energy drifts at once, so that there is something to undo.
    let mut real = Real::of("pendulum");
    real.press(": m e t h o d Space r k 4 Enter s . 2 Enter");
    assert_eq!(real.seen().method.name, "rk4");
    real.run(300);
    assert!(real.seen().gauges[0].drift > 1e-12, "{}", real.seen().gauges[0].drift);
    let time = real.seen().time;
    real.press("e");
    let gauge = &real.seen().gauges[0];
    assert_eq!((gauge.drift, gauge.max_drift, gauge.reference_time), (0.0, 0.0, time));
    // The notification disappears by itself; the reference time of the gauges remains visible.
    real.app.notifications.dismiss();
    for size in [(80, 24), (120, 40)] {
        let text = screen_text(&real.app, size);
        assert!(text.contains("since t = 5"), "{text}");
    }
}

#[test]
fn the_method_its_step_and_its_tolerance_are_taken_back() {
    let mut real = Real::of("pendulum");
    let start = real.state();
    real.press(": m e t h o d Space d o p 8 5 3 Enter a 1 e - 9 Enter");
    real.press(": m e t h o d Space r k 4 Enter s . 0 1 Enter");
    let end = real.state();
    assert_eq!(real.seen().method.name, "rk4");
    assert_eq!(
        (real.seen().setup.settings.step, real.seen().setup.settings.tolerance),
        (Some(0.01), Some(1e-9))
    );
    real.press("u u u u");
    assert_eq!(real.state(), start);
    real.press("U U U U");
    assert_eq!(real.state(), end);
}

#[test]
fn a_value_given_back_follows_the_parameters_again() {
    // A file's value may depend on parameters; it does so again once a change is undone.
    let mut real = Real::of("pendulum");
    real.press("Tab Right u");
    assert!(real.seen().setup.overrides.is_empty(), "{:?}", real.seen().setup.overrides);
    real.press("Tab Tab Tab Tab Tab Right");
    real.press("u R u u");
    assert!(real.seen().setup.overrides.is_empty());
}

#[test]
fn what_is_taken_back_is_shown() {
    let mut real = Real::of("pendulum");
    real.press("Right Tab Tab Tab Tab + Tab");
    let zoom = |real: &Real| format!("{:?}", real.lab().plots[1]);
    let closer = zoom(&real);
    real.press("u");
    assert_ne!(zoom(&real), closer);
    assert_eq!(real.lab().focus.pane, phaselab::app::Pane::Plot(1));
    real.press("u");
    assert_eq!(real.lab().focus.pane, phaselab::app::Pane::Parameters);
}

#[test]
fn undo_and_redo_tell_what_went_where() {
    let reported = |real: &Real| {
        real.app.notifications.shown.as_ref().map(|n| n.text.clone()).unwrap_or_default()
    };
    let check = |keys: &str, undone: &str, redone: &str| {
        let mut real = Real::of("pendulum");
        real.press(keys);
        real.press("u");
        assert_eq!(reported(&real), undone, "{keys}");
        real.press("U");
        assert_eq!(reported(&real), redone, "{keys}");
    };
    check("Right", "undone: m 1.02 → 1", "redone: m 1 → 1.02");
    // a motion under way has been another one meanwhile, and is brought back
    let mut real = Real::of("pendulum");
    real.run(60);
    real.press("Right");
    real.run(60);
    real.press("u");
    let whole = "undone: m 1.02 → 1, the motion of t = 1";
    assert_eq!(reported(&real), whole);
    check("Tab Right", "undone: initial θ 2.01 → 2", "redone: initial θ 2 → 2.01");
    check("m Down Enter", "undone: method leapfrog → taylor", "redone: method taylor → leapfrog");
    check(
        "m Down Enter s Ctrl-u . 0 2 Enter",
        "undone: step 0.02 → by itself",
        "redone: step by itself → 0.02",
    );
    check("R", "undone: the reset to the file's values", "redone: the reset to the file's values");
    check(
        "Tab Tab Tab Tab +",
        "undone: the view of p_θ against θ",
        "redone: the view of p_θ against θ",
    );
}

/// Edits of every kind, and the keys that lead to them.
const EDITS: [&str; 24] = [
    "Right",
    "Left",
    "L",
    "H",
    "Down",
    "Up",
    "Tab",
    "Tab",
    "Tab",
    "Shift-Tab",
    "Backspace",
    "R",
    "+",
    "-",
    "x",
    "Y",
    "g",
    "c",
    "0",
    "f",
    "v Down Enter Down Enter",
    "m Down Enter",
    "s Ctrl-u . 0 2 Enter",
    "a Ctrl-u 1 e - 8 Enter",
];

proptest! {
    #![proptest_config(cases(12))]

    #[test]
    fn a_hundred_edits_taken_back_are_the_beginning_to_the_bit(
        edits in prop::collection::vec((0..EDITS.len(), any::<bool>()), 100),
        name in prop::sample::select(vec!["pendulum", "merry-go-round", "planet"]),
    ) {
        let mut real = Real::of(name);
        real.press("Space");
        let start = real.state();
        for (edit, wait) in edits {
            // on a value `v` adds a picture, which stays
            let on_a_value = !matches!(real.lab().focus.pane, phaselab::app::Pane::Plot(_));
            if EDITS[edit].starts_with('v') && on_a_value {
                continue;
            }
            real.press(EDITS[edit]);
            if real.app.overlay.is_some() {
                real.press("Esc");
            }
            if wait {
                real.app.update(AppEvent::Tick(std::time::Duration::from_secs(1)));
            }
        }
        let end = real.state();
        for _ in 0..100 {
            real.press("u");
        }
        prop_assert_eq!(real.state(), start);
        for _ in 0..100 {
            real.press("U");
        }
        prop_assert_eq!(real.state(), end);
        for _ in 0..100 {
            real.press("u");
        }
        let mut fresh = Real::of(name);
        fresh.press("Space");
        prop_assert!(real.motion() == fresh.motion(), "the motions differ");
    }
}
