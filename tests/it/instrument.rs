//! The table of instruments: every row is drawn, named, saved, offered and described; and background jobs of the lab.

use std::collections::BTreeSet;
use std::sync::Arc;
use std::time::Duration;

use phaselab::app::{App, AppEvent, Asker, Computation, Effect, Saved};
use phaselab::experiment::{Command, Snapshot};
use phaselab::instrument::{
    Answer, INSTRUMENTS, Instrument, Layer, Level, Picture, Plot, SavedPlot, named, offers,
};
use phaselab::job::{Outcome, Progress, Share};
use phaselab::mechanics::derive_for_motion;
use phaselab::preset;

use crate::fixtures::{begun, catalog, in_lab, loaded, pendulum, press, snapshot};
use crate::laboratory::{measure, measured, plot_named};
use crate::nonempty;
use crate::screen::{rich, rows};

/// The kinds that the pendulum has: all but sections, whose surface a file names (`section` tests those), and
/// transformations, which a file defines (`transformation`).
fn kinds() -> impl Iterator<Item = &'static dyn Instrument> {
    INSTRUMENTS.into_iter().filter(|kind| {
        !kind.properties().is_section
            && !kind.properties().written.iter().any(|axis| axis.transformed)
    })
}

/// The pendulum in the lab with a plot of each kind: those that it opens with, and those that are asked for.
fn with_all_kinds() -> App {
    let mut app = in_lab();
    let lab = app.lab.as_mut().unwrap();
    for kind in kinds() {
        if !lab.plots.iter().any(|plot| plot.kind == kind) {
            let offer = kind.offers(lab.loaded.physics()).remove(0);
            let shown = (offer.columns, offer.view);
            let mut plot = Plot::new(kind, shown, &lab.loaded.model).opened(lab.loaded.physics());
            if plot.over.is_empty() {
                plot.over = offer.over;
            }
            lab.plots.push(plot);
        }
    }
    app
}

/// The first plot of a kind on the pendulum's initial screen.
fn plot(app: &App, name: &str) -> (usize, Plot) {
    let plots = app.lab.as_ref().unwrap().plots.iter().enumerate();
    let of_kind = plots.filter(|(_, plot)| plot.kind.name() == name);
    of_kind.map(|(index, plot)| (index, plot.clone())).next().unwrap_or_else(|| panic!("{name}"))
}

fn screen(app: &App, width: u16, height: u16) -> Vec<String> {
    rows(&crate::screen::screen(app, &rich(), (width, height)))
}

#[test]
fn every_kind_has_a_name_of_its_own() {
    let names: Vec<&str> = INSTRUMENTS.iter().map(|kind| kind.name()).collect();
    let different: BTreeSet<&str> = names.iter().copied().collect();
    assert_eq!(different.len(), names.len(), "{names:?}");
    for kind in INSTRUMENTS {
        let mut words = kind.name().split('-');
        let plain = |word: &str| !word.is_empty() && word.chars().all(|c| c.is_ascii_lowercase());
        assert!(words.all(plain), "{kind:?}");
        assert!(named(kind.name()).is_some_and(|found| found == kind));
        let keys: BTreeSet<&str> = kind.properties().written.iter().map(|axis| axis.key).collect();
        assert_eq!(keys.len(), kind.properties().written.len(), "{kind:?} has an axis twice");
        for taken in ["kind", "title", "view", "eye", "lens", "frame", "shapes"] {
            assert!(!keys.contains(taken), "{kind:?} has an axis called {taken}");
        }
    }
}

/// A new kind costs its file, a row and at most one file more: nothing above the table decides by the name of a kind, but asks
/// what the kind says of itself. A key or a search may still name the kind that it opens.
#[test]
fn nothing_above_the_table_decides_by_the_name_of_a_kind() {
    let named: Vec<String> =
        INSTRUMENTS.iter().map(|kind| format!("\"{}\"", kind.name())).collect();
    let mut offenders = Vec::new();
    let mut read = 0;
    for room in ["preset", "experiment", "worker", "app", "view", "record", "shell"] {
        for (path, code) in sources(room) {
            // what a file calls its own parts may be spelled as a kind is; only who knows of kinds can mean one
            if room == "preset" && !code.contains("instrument::") {
                continue;
            }
            read += 1;
            let code = code.split("\n#[cfg(test)]").next().unwrap_or_default();
            for line in code.lines().filter(|line| decides_by(line, &named)) {
                offenders.push(format!("{path}: {}", line.trim()));
            }
        }
    }
    assert!(read > 200, "{read}");
    assert!(offenders.is_empty(), "{offenders:#?}");
    assert!(decides_by("    kind.name() == \"phase\"", &named));
    assert!(decides_by("    (\"time\", None) => plot", &named));
    assert!(decides_by("    .only(&[\"map\", \"diagram\"])", &named));
    assert!(!decides_by("    Action::Ensemble => self.show_picture(\"ensemble\"),", &named));
}

/// Whether a line compares something with the name of a kind, matches on it, or lists it.
fn decides_by(line: &str, names: &[String]) -> bool {
    let pattern = line.split_once("=>").map_or("", |(pattern, _)| pattern);
    names.iter().any(|name| {
        let compared = ["== ", "!= "].map(|before| format!("{before}{name}"));
        let listed =
            line.contains("only(") || line.contains("contains(") || line.contains("matches!(");
        pattern.contains(name)
            || compared.iter().any(|text| line.contains(text))
            || listed && line.contains(name)
            || line.trim_start().starts_with(name) && line.trim_end().ends_with("\",")
    })
}

/// The source files of a room with their paths.
fn sources(room: &str) -> Vec<(String, String)> {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let (mut found, mut folders) = (Vec::new(), vec![root.join(room)]);
    let mut add = |path: std::path::PathBuf| {
        let code = std::fs::read_to_string(&path).expect("a source file");
        found.push((path.display().to_string(), code));
    };
    add(root.join(format!("{room}.rs")));
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).into_iter().flatten() {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                add(path);
            }
        }
    }
    found
}

#[test]
fn every_kind_is_drawn_described_and_saved() {
    let mut all = with_all_kinds();
    // what they show is computed once
    press(&mut all, "Tab Tab Tab");
    for kind in nonempty(kinds()) {
        let mut app = all.clone();
        let (index, shown) = plot(&app, kind.name());
        press(&mut app, &(["Tab"].repeat(index).join(" ") + " z"));
        let lab = app.lab.as_ref().unwrap();
        assert_eq!(lab.focused_plot().unwrap().1, &shown);
        let drawn = screen(&app, 80, 24);
        let body = &drawn[2..22];
        let marks = body.concat().chars().filter(|c| !c.is_whitespace()).count();
        assert!(marks > 100, "{kind:?} {drawn:#?}");
        // its title is in the frame, and its description on the plain-text page
        let present = lab.present().unwrap();
        let heading = kind.heading(&shown, &present).expect("a heading");
        assert!(drawn[1].contains(&heading.title), "{kind:?} {drawn:#?}");
        let words = shown.words(lab.loaded.physics());
        assert!(!words.trim().is_empty() && !kind.words(&shown, present.physics).is_empty());
        press(&mut app, "9");
        let page = screen(&app, 80, 400);
        assert!(page.iter().any(|row| row.contains(&words)), "{kind:?}: {words}");
    }
}

#[test]
fn every_kind_is_saved_in_a_session() {
    let mut app = with_all_kinds();
    press(&mut app, "Tab Tab Tab Tab + x Right");
    let saved = app.saved().expect("a lab is open");
    let text = toml::to_string(&saved).expect("it can be written");
    let read: Saved = toml::from_str(&text).expect("it can be read");
    let kinds: BTreeSet<&str> = read.plots.iter().map(|plot| plot.kind.as_str()).collect();
    assert_eq!(kinds, self::kinds().map(Instrument::name).collect(), "{text}");
    let pendulum = pendulum();
    let plots: Vec<Option<Plot>> =
        read.plots.iter().map(|plot| plot.place(pendulum.physics())).collect();
    let before = &app.lab.as_ref().unwrap().plots;
    assert_eq!(plots, before.iter().cloned().map(Some).collect::<Vec<_>>());
    // a session of another version may name an unknown kind
    let strange = SavedPlot { kind: "spiral".to_owned(), ..read.plots[0].clone() };
    assert_eq!(strange.place(pendulum.physics()), None);
}

/// The picture settings in the first version of the session format.
#[test]
fn sessions_are_read_as_they_were_written_before() {
    let check = |text: &str, name: &str| {
        let saved: SavedPlot = toml::from_str(text).expect(text);
        let plot = saved.place(pendulum().physics()).expect(text);
        assert_eq!(plot.kind.name(), name);
        plot
    };
    let viewport = "[lens]\nzoom = [1.0, 2.0]\npan = [0.0, 0.5]\nlog = false\n";
    let eye = "[eye]\nyaw = 0.5\npitch = 0.25\nzoom = 2.0\n";
    assert_eq!(check(&format!("kind = \"space\"\n{eye}"), "space").eye().unwrap().zoom, 2.0);
    let axes = "x = { name = \"theta\", place = 0 }\ny = { name = \"p_theta\", place = 2 }\n";
    let phase = check(&format!("kind = \"phase\"\n{axes}{viewport}"), "phase");
    assert_eq!((phase.columns, phase.sight), (vec![vec![0], vec![2]], phase.sight));
    let time = "kind = \"time\"\ny = [{ name = \"theta\", place = 0 }]\n";
    assert_eq!(check(&format!("{time}{viewport}"), "time").viewport().unwrap().zoom, [1.0, 2.0]);
    check(&format!("kind = \"potential\"\nview = 3\n{viewport}"), "potential");
}

#[test]
fn every_kind_can_be_chosen() {
    let pendulum = pendulum();
    let offered = offers(pendulum.physics());
    for kind in nonempty(kinds()) {
        let own: Vec<_> = offered.iter().filter(|(of, _)| *of == kind).collect();
        assert!(!own.is_empty(), "{kind:?}");
        for (_, offer) in own {
            assert!(!offer.label.is_empty() && !offer.about.is_empty(), "{offer:?}");
            let columns = offer.columns.clone();
            let plot = Plot::new(kind, (columns, offer.view), &pendulum.model);
            // each further axis has a heading in the menu
            for axis in &kind.chosen()[plot.columns.len()..] {
                assert!(!axis.heading.is_empty(), "{axis:?}");
            }
        }
    }
}

#[test]
fn a_misspelt_kind_gets_the_nearest_of_the_table() {
    for kind in INSTRUMENTS {
        let wrong: String = kind.name().chars().skip(1).collect();
        let text = format!(
            "title = 'a test'\n[coordinates]\nx = {{ initial = 1.0 }}\n[lagrangian]\nL = \"1/2*x'^2\"\n\
             [[views]]\nkind = \"{wrong}\"\n"
        );
        let diagnostics = preset::read(&text).expect_err("there is no such kind");
        let help = format!("did you mean `{}`?", kind.name());
        assert_eq!(diagnostics[0].help.as_deref(), Some(help.as_str()), "{wrong}");
    }
}

/// A lab whose jobs run elsewhere, and the jobs requested until the first snapshot of the pendulum.
fn aside() -> (App, Vec<Computation>) {
    let (mut app, _) = App::new(catalog(), Some("pendulum"));
    app.jobs.in_background = true;
    app.update(AppEvent::Loaded(Ok(pendulum())));
    let effects = app.update(AppEvent::Snapshot(Arc::new(snapshot(&pendulum(), 2.0))));
    (app, computations(effects))
}

#[test]
fn the_motion_is_shown_before_its_equations_are_solved() {
    let (mut app, _) = App::new(catalog(), Some("double-pendulum"));
    app.jobs.in_background = true;
    let unsolved = |name, epoch| {
        let mut loaded = loaded(name, epoch);
        loaded.equations = Arc::new(derive_for_motion(&loaded.model).unwrap());
        loaded
    };
    let system = unsolved("double-pendulum", 1);
    let asked = computations(app.update(AppEvent::Loaded(Ok(system.clone()))));
    let shown = |app: &App| app.lab.as_ref().unwrap().loaded.equations.hamiltonian.clone();
    assert_eq!(shown(&app).unwrap_err().to_string(), "it has not been derived yet");
    // it is asked once, and another system does not take the answer for its own
    let seen = AppEvent::Snapshot(Arc::new(snapshot(&system, 1.0)));
    assert!(computations(app.update(seen)).iter().all(|c| c.asker != Asker::Equations));
    let late = ran(&asked[0]);
    let again = computations(app.update(AppEvent::Loaded(Ok(unsolved("pendulum", 2)))));
    app.update(late);
    assert!(shown(&app).is_err());
    app.update(ran(&again[0]));
    assert!(shown(&app).is_ok());
    // what is shown at last is what a lab without a background shows at once
    let equations = &app.lab.as_ref().unwrap().loaded.equations;
    assert!(!equations.has_pending_forms());
    assert!(equations.solved.is_ok() && equations.separable.is_ok());
}

fn computations(effects: Vec<Effect>) -> Vec<Computation> {
    let asked = effects.into_iter().filter_map(|effect| match effect {
        Effect::Compute(computation) => Some(computation),
        _ => None,
    });
    asked.collect()
}

fn ran(computation: &Computation) -> AppEvent {
    let outcome = computation.job.run(&Progress::new());
    AppEvent::Computed { ticket: computation.ticket, outcome }
}

fn answer(app: &App) -> Option<Answer> {
    let (_, shown) = plot(app, "phase");
    app.lab.as_ref().unwrap().answer(&shown).cloned()
}

#[test]
fn no_frame_waits_for_level_curves_and_the_old_ones_stay() {
    let (mut app, asked) = aside();
    let (index, _) = plot(&app, "phase");
    assert_eq!(asked.iter().map(|c| c.asker).collect::<Vec<_>>(), [Asker::Plot(index)]);
    assert_eq!(answer(&app), None, "nothing was computed yet");
    let before = screen(&app, 120, 40);
    assert_eq!(app.update(ran(&asked[0])), []);
    let first = answer(&app).expect("the curves are there");
    assert_ne!(screen(&app, 120, 40), before);
    // the same screen as with immediate computation
    assert_eq!(screen(&app, 120, 40)[1..38], screen(&in_lab(), 120, 40)[1..38]);
    // another parameter: the old curves remain until the new ones arrive, which are requested once
    let mut seen = snapshot(&pendulum(), 2.1);
    let mut parameters = seen.parameters.to_vec();
    parameters[0] *= 1.5;
    seen.parameters = parameters.into();
    let asked = computations(app.update(AppEvent::Snapshot(Arc::new(seen.clone()))));
    assert_eq!((asked.len(), answer(&app)), (1, Some(first.clone())));
    assert_eq!(computations(app.update(AppEvent::Snapshot(Arc::new(seen)))), []);
    app.update(ran(&asked[0]));
    assert!(answer(&app).is_some_and(|answer| answer != first));
}

#[test]
fn an_answer_that_nobody_waits_for_is_dropped() {
    let (mut app, asked) = aside();
    let late = ran(&asked[0]);
    // meanwhile another system is loaded, with its own phase plane
    let other = loaded("pendulum", 2);
    app.update(AppEvent::Loaded(Ok(other.clone())));
    app.update(late.clone());
    assert_eq!(answer(&app), None);
    let seen = Snapshot { epoch: 2, ..snapshot(&other, 1.0) };
    let asked = computations(app.update(AppEvent::Snapshot(Arc::new(seen))));
    app.update(late);
    assert_eq!((asked.len(), answer(&app)), (1, None));
    app.update(ran(&asked[0]));
    assert!(answer(&app).is_some());
}

/// The motion stays in its picture while the level curves of a larger window are being computed.
#[test]
fn a_motion_that_leaves_its_level_curves_is_still_seen() {
    let (mut app, _) = App::new(catalog(), Some("harmonic-oscillator"));
    app.jobs.in_background = true;
    let system = loaded("harmonic-oscillator", 1);
    app.update(AppEvent::Loaded(Ok(system.clone())));
    let seen = |time: f64| AppEvent::Snapshot(Arc::new(snapshot(&system, time)));
    let asked = computations(app.update(seen(0.1)));
    app.update(ran(&asked[0]));
    assert!(answer(&app).is_some());
    app.update(seen(3.0));
    let text = screen(&app, 120, 40);
    let right = |row: &String| row.chars().skip(40).take(39).collect::<String>();
    let marks = text[..22].iter().filter(|row| right(row).contains('●')).count();
    assert_eq!(marks, 1, "{text:#?}");
}

#[test]
fn a_job_that_takes_long_is_shown_with_its_progress() {
    let (mut app, asked) = aside();
    let reported = |app: &App| screen(app, 160, 50).concat().contains("level curves of the energy");
    app.update(AppEvent::Tick(Duration::from_millis(290)));
    assert!(!reported(&app), "what is there at once is not worth a word");
    app.update(AppEvent::Tick(Duration::from_millis(20)));
    assert!(reported(&app));
    let share = Share { done: 1, total: Some(4) };
    app.update(AppEvent::Progress { ticket: asked[0].ticket, share });
    assert!(screen(&app, 160, 50).concat().contains("energy 25 %"));
    app.update(ran(&asked[0]));
    assert!(!reported(&app));
}

#[test]
fn a_job_that_panics_is_reported_and_the_lab_goes_on() {
    let (mut app, asked) = aside();
    let outcome = Outcome::Failed("level curves stopped by a defect".to_owned());
    app.update(AppEvent::Computed { ticket: asked[0].ticket, outcome });
    assert!(
        app.notifications.shown.take().is_some_and(|notice| notice.text.contains("by a defect"))
    );
    assert_eq!(press(&mut app, "r"), [Effect::Execute(Command::Reset)]);
}

#[test]
fn the_prompt_is_answered_on_the_side_and_its_question_given_up_with_it() {
    let (mut app, asked) = aside();
    app.update(ran(&asked[0]));
    press(&mut app, "{");
    press(&mut app, "t h e t a");
    let asked = computations(press(&mut app, "Enter"));
    assert_eq!(asked.iter().map(|c| c.asker).collect::<Vec<_>>(), [Asker::Prompt]);
    let waiting = screen(&app, 80, 24).concat();
    assert!(!waiting.contains("conserved:"), "{waiting}");
    app.update(ran(&asked[0]));
    assert_ne!(screen(&app, 80, 24).concat(), waiting, "the answer is there");
    // a question that takes long, and Esc
    let asked = computations(press(&mut app, "Enter"));
    app.update(AppEvent::Tick(Duration::from_millis(400)));
    assert!(screen(&app, 80, 24).concat().contains("deriving"));
    assert_eq!(press(&mut app, "Esc"), [Effect::StopComputing(Asker::Prompt)]);
    app.update(ran(&asked[0]));
    assert!(app.overlay.is_none());
}

#[test]
fn a_key_finds_the_frequency_of_the_pendulum() {
    let mut app = in_lab();
    press(&mut app, "w z");
    let (_, plot) = app.lab.as_ref().unwrap().focused_plot().unwrap();
    assert_eq!(plot.kind.name(), "spectrum");
    let measure = |word: &str| measure(&app, plot, word);
    // ω = √(g/l) agm(1, cos ½θ₀), θ₀ = 2
    let (mut a, mut b) = (1.0_f64, 1.0_f64.cos());
    for _ in 0..8 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    let exact = 9.81_f64.sqrt() * a;
    assert!((measure("frequency") - exact).abs() < 1e-10, "{} {exact}", measure("frequency"));
    assert_eq!(measure("fundamentals"), 1.0);
    assert!(measure("lines") >= 5.0);
    let shown = screen(&app, 120, 40).concat();
    for (name, frequency) in [("ω₁", exact), ("3ω₁", 3.0 * exact)] {
        assert!(shown.contains(&format!("{name} = {frequency:.8}")), "{name} {frequency}: {shown}");
    }
    assert!(!shown.contains("mean rate"), "it swings: {shown}");
}

/// x = cos t, so that x x′ = −½ sin 2t: an expression of the view has a spectrum as a coordinate has.
#[test]
fn the_spectrum_of_an_expression() {
    let app = begun(
        "title = 'a test'\n[coordinates]\nx = { initial = 1.0 }\n\
         [lagrangian]\nL = \"1/2*x'^2 - 1/2*x^2\"\n\
         [[views]]\nkind = \"spectrum\"\ny = \"x*x'\"\n",
    );
    let frequency = measured(&app, plot_named(&app, "spectrum"), "frequency");
    assert!(frequency.is_some_and(|f| (f - 2.0).abs() < 1e-10), "{frequency:?}");
}

/// The rotor at rest where its kick vanishes and draws it back: K/4 is Greene's residue of that point of the standard map.
#[test]
fn orbits_of_kicked_systems_are_closed_from_the_initial_values() {
    let text = catalog().find("kicked-rotor").unwrap().text.clone();
    let near = text.replace("value = 0.5,", "value = 3.0,").replace("value = 2.6,", "value = 0.1,");
    assert_ne!(near, text);
    let mut app = begun(&near);
    press(&mut app, "t");
    let (_, plot) = app.lab.as_ref().unwrap().focused_plot().unwrap();
    assert_eq!(plot.kind.name(), "orbit");
    let measure = |word: &str| measured(&app, plot, word);
    assert!(measure("period").is_some_and(|period| (period - 1.0).abs() < 1e-12));
    assert!(measure("residue").is_some_and(|r| (r - 0.971635406 / 4.0).abs() < 1e-8));
    assert_eq!(measure("stable"), Some(1.0));
    // an impact comes when the motion makes it come, and takes energy from this ball: nothing closes
    let mut ball = begun(&catalog().find("bouncing-ball").unwrap().text);
    press(&mut ball, "t");
    let lab = ball.lab.as_ref().unwrap();
    let (_, plot) = lab.focused_plot().unwrap();
    assert_eq!(plot.kind.name(), "orbit");
    let shown = screen(&ball, 120, 40).concat();
    assert!(shown.contains("no periodic orbit"), "{shown}");
}

/// A plane is drawn with one scale. Where a file has no units, places are told from momenta by what they depend on.
#[test]
fn planes_of_places_have_one_scale_and_phase_planes_two() {
    let is_plane = |preset: &str, x: &str, y: &str| {
        let loaded = loaded(preset, 1);
        let physics = loaded.physics();
        let phase = named("phase").unwrap();
        let column = |name: &str| {
            let found = physics.system.channels().iter().position(|c| c.name == name);
            vec![found.unwrap_or_else(|| panic!("{preset}: {name}"))]
        };
        let plot = Plot::new(phase, (vec![column(x), column(y)], None), physics.model);
        plot.opened(physics).is_plane(physics)
    };
    for (preset, x, y, expected) in [
        ("magnetic-dipole", "distance from the axis", "z", true),
        ("sleeping-top", "A₃₁", "A₃₂", true),
        ("unbalanced-wheel", "L_x", "L_y", true),
        ("toda-three", "q1 - q2", "q2 - q3", true),
        ("henon-heiles", "x", "y", true),
        ("foucault", "x", "y", true),
        ("henon-heiles", "y", "p_y", false),
        ("henon-heiles", "p_x", "p_y", false),
        ("magnetic-dipole", "z", "magnetic latitude", false),
        ("magnetic-dipole", "x", "p_φ", false),
        ("planet", "r", "theta", false),
        ("pendulum", "theta", "p_theta", false),
    ] {
        assert_eq!(is_plane(preset, x, y), expected, "{preset}: {y} against {x}");
    }
}

/// A cell shows the dots of its highest level alone: curves of one level have no gap where they cross.
#[test]
fn curves_against_the_time_are_of_one_level() {
    let app = begun(
        "title = 'a test'\n[coordinates]\nx = { initial = 0, velocity = 1 }\ny = { initial = 1, velocity = -1 }\n\
         [lagrangian]\nL = \"1/2*x'^2 + 1/2*y'^2\"\n[[views]]\nkind = \"time\"\ny = [\"x\", \"y\"]\n",
    );
    let lab = app.lab.as_ref().unwrap();
    let several = |plot: &&Plot| plot.kind.name() == "time" && plot.columns[0].len() == 2;
    let plot = lab.plots.iter().find(several).expect("both against t");
    let present = lab.present().unwrap();
    let picture = plot.kind.picture(lab.context(plot, &present), [f64::NAN; 2]);
    let Some(Picture::Axes { layers, .. }) = picture else { panic!("no axes") };
    let is_curve = |layer: &Layer| matches!(layer, Layer::Curve { .. } | Layer::CompanionCurves(_));
    let levels: Vec<Level> =
        layers.iter().filter(|(_, layer)| is_curve(layer)).map(|(level, _)| *level).collect();
    assert_eq!(levels, [levels[0]; 4]);
}
