//! The orbit in the new variables of a transformation: the grid of the old ones, and what is said of the map.

mod branches;
mod caustics;
mod listed;

use phaselab::app::{App, AppEvent, Pane};
use phaselab::diagnostic::Document;
use phaselab::experiment::Prepared;
use phaselab::instrument::{Ink, Layer, MarkerShape, Picture, Plot};
use phaselab::num::math;
use phaselab::preset;

use crate::fixtures::{begun, in_lab, lab, press};
use crate::screen::screen_text;

/// The plots of this kind in the lab of a preset, on which motion has been seen up to a time.
fn plots(app: &App) -> Vec<Plot> {
    let all = app.lab.as_ref().expect("a lab").plots.iter();
    all.filter(|plot| plot.kind.name() == "transformation").cloned().collect()
}

/// The grid of a plot, and the lines in its corner.
fn shown(app: &App, plot: &Plot) -> (Vec<Vec<[f64; 2]>>, Vec<String>) {
    let lab = app.lab.as_ref().expect("a lab");
    let present = lab.present().expect("a motion");
    let picture = plot.kind.picture(lab.context(plot, &present), [0.0, 1.0]);
    let Some(Picture::Axes { layers, .. }) = picture else { panic!("it has axes") };
    let (mut grid, mut words) = (Vec::new(), Vec::new());
    for (_, layer) in layers {
        match layer {
            Layer::Line(line, stroke) if stroke.ink == Ink::Level => grid.push(line),
            Layer::Legend(lines) => words = lines,
            _ => {}
        }
    }
    (grid, words)
}

fn measure(app: &App, plot: &Plot, word: &str) -> f64 {
    let lab = app.lab.as_ref().expect("a lab");
    let all = plot.kind.properties().measures;
    let measure = all.iter().find(|measure| measure.word == word).expect("it is measured");
    (measure.value)(lab.context(plot, &lab.present().expect("a motion"))).expect("a value")
}

/// Q = atan2(m ω q, p), P = E/ω with m = 1, ω = 2: along a line of the grid q = √(2 P/(m ω)) sin Q or p = √(2 P m ω) cos Q
/// is the same.
#[test]
fn the_oscillator_by_its_angle_has_the_grid_of_q_and_p() {
    let mut app = lab("angle-of-the-oscillator", 3.0);
    press(&mut app, "Wait");
    let [by_angle, polar] = &plots(&app)[..] else { panic!("the file has two") };
    let (grid, words) = shown(&app, by_angle);
    assert_eq!(words, ["canonical, proved", "K = ω P", "ring, dim grid: the second branch"]);
    assert_eq!(measure(&app, by_angle, "canonical"), 1.0);
    assert!(measure(&app, by_angle, "residual") < 1e-12);
    assert!(grid.len() >= 14, "seven lines of each, some of them parted: {}", grid.len());
    let spread = |values: Vec<f64>| {
        let (lo, hi) = values
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), &x| (lo.min(x), hi.max(x)));
        hi - lo
    };
    let mut constant = [0, 0];
    for line in &grid {
        let old = |[angle, action]: [f64; 2]| {
            [
                math::powf(action, 0.5) * math::sin(angle),
                2.0 * math::powf(action, 0.5) * math::cos(angle),
            ]
        };
        let both = [0, 1].map(|k| spread(line.iter().map(|&point| old(point)[k]).collect()));
        let k = usize::from(both[1] < both[0]);
        assert!(both[k] < 1e-9, "{both:?}");
        constant[k] += 1;
        // the angle jumps by 2π at q = 0, p < 0, and is not joined there
        assert!(line.windows(2).all(|pair| (pair[1][0] - pair[0][0]).abs() < 3.5), "{line:?}");
    }
    assert!(constant.iter().all(|&count| count >= 7), "{constant:?}");
    // the same without its scale is not canonical
    let (grid, words) = shown(&app, polar);
    assert!(!grid.is_empty());
    assert_eq!(words[0], "not canonical: [θ, r] = 1/√(p_q² + q²) ≠ 1");
    assert_eq!(measure(&app, polar, "canonical"), 0.0);
}

/// Coordinates that turn, or move, are as long as the old ones: X and Y are drawn one to one where x and y are. A pair (Q, P) has
/// areas and no lengths, and other coordinates than linear ones have none that compare.
#[test]
fn new_coordinates_are_drawn_one_to_one_where_the_old_ones_are() {
    let equal = |app: &App| -> Vec<bool> {
        plots(app).iter().map(|plot| plot.viewport().expect("axes").equal).collect()
    };
    assert_eq!(equal(&lab("moving-axes", 0.1)), [true, false]);
    assert_eq!(equal(&lab("angle-of-the-oscillator", 0.1)), [false, false]);
    let text = crate::fixtures::catalog().find("moving-axes").expect("a preset").text.clone();
    let polar = text.replace(
        "P_X*(x*cos(Omega*t) + y*sin(Omega*t)) + P_Y*(y*cos(Omega*t) - x*sin(Omega*t))",
        "P_X*sqrt(x^2 + y^2) + P_Y*atan2(y, x)",
    );
    assert_ne!(polar, text);
    assert!(!equal(&begun(&polar))[0]);
    let of_two_units = text.replacen("y = { unit = \"m\"", "y = { unit = \"km\"", 1);
    assert_ne!(of_two_units, text);
    assert!(!equal(&begun(&of_two_units))[0]);
}

/// An angle written as atan2 jumps by a turn: its trail leaves at one edge and enters at the other.
/// One step of symplectic Euler, Q = q + h P/m, P = p − h ∂V/∂q, taken as a map of the plane into itself.
#[test]
fn in_the_active_view_the_point_is_moved_and_the_coordinates_stay() {
    let mut app = lab("symplectic-euler", 1.0);
    press(&mut app, "Wait");
    let place = |app: &App| {
        let plots = &app.lab.as_ref().expect("a lab").plots;
        plots.iter().position(|plot| plot.kind.name() == "transformation").expect("a map")
    };
    let before = shown(&app, &plots(&app)[0]).0;
    assert!(before.len() >= 14, "the grid of the passive view");
    app.lab.as_mut().expect("a lab").focus.pane = Pane::Plot(place(&app));
    press(&mut app, "Q");
    let plot = plots(&app)[0].clone();
    let (arrow, words) = shown(&app, &plot);
    let lab = app.lab.as_ref().expect("a lab");
    let present = lab.present().expect("a motion");
    let value = |name: &str| {
        let channels = present.physics.system.channels();
        present.value(channels.iter().position(|channel| channel.name == name).expect(name))
    };
    let new = |axis| present.value(plot.column(axis).expect("a channel"));
    let (x, p) = (value("q"), value("p_q"));
    assert_eq!(arrow, [vec![[x, p], [new(0), new(1)]]]);
    assert!((new(0) - x).abs() > 1e-3 && (new(1) - p).abs() > 1e-3, "it is moved");
    // motions beside the main one are moved with it
    let picture = plot.kind.picture(lab.context(&plot, &present), [0.0, 1.0]);
    let Some(Picture::Axes { layers, .. }) = picture else { panic!("it has axes") };
    let beside = layers.iter().filter(|(_, layer)| matches!(layer, Layer::Companions(_)));
    assert_eq!(beside.count(), 2);
    assert_eq!(words[0], "(q, p_q) → (Q₁, P₁), the ring");
    assert_eq!(words[1], "canonical, proved");
    let heading = plot.kind.heading(&plot, &present).expect("a heading");
    assert!(heading.given || heading.title == "Transformation, active");
    // the key takes it back, from wherever the focus is, and says where there is nothing to be moved
    press(&mut app, "Q");
    assert_eq!(shown(&app, &plots(&app)[0]).0, before);
    let phase = app.lab.as_ref().expect("a lab").plots.iter();
    let phase = phase.clone().position(|plot| plot.kind.name() == "phase").expect("a phase plane");
    app.lab.as_mut().expect("a lab").focus.pane = Pane::Plot(phase);
    press(&mut app, "Q");
    assert_eq!(shown(&app, &plots(&app)[0]).0, arrow);
    assert_eq!(app.lab.as_ref().expect("a lab").focus.pane, Pane::Plot(phase), "the focus stays");
    let mut app = in_lab();
    press(&mut app, "Q");
    let reported = app.notifications.shown.take().map(|notice| notice.text).unwrap_or_default();
    assert!(reported.contains("Q does nothing here"), "{reported}");
}

#[test]
fn what_is_written_as_atan2_is_an_angle() {
    let app = lab("angle-of-the-oscillator", 1.0);
    let system = &app.lab.as_ref().unwrap().loaded.system;
    let period = |name: &str| {
        let place = system.channels().iter().position(|c| c.name == name).expect(name);
        system.period(place, &[1.0, 2.0, 0.1, 2.0, 0.5])
    };
    assert_eq!([period("Q"), period("theta")], [Some(std::f64::consts::TAU); 2]);
    assert_eq!([period("P"), period("r"), period("q")], [None; 3]);
}

/// The pane takes part in what every pane has: it is offered, named, kept.
#[test]
fn a_transformation_is_offered_where_the_file_has_one() {
    let app = lab("symplectic-euler", 1.0);
    let physics = app.lab.as_ref().unwrap().loaded.physics();
    let [plot] = &plots(&app)[..] else { panic!("the file has one") };
    let offered = plot.kind.offers(physics);
    assert!(offered.iter().any(|offer| offer.columns == plot.columns), "{offered:?}");
    assert!(plot.words(physics).contains("P₁ against Q₁"), "{}", plot.words(physics));
    assert!(shown(&app, plot).1[0].starts_with("canonical"));
    let pendulum = lab("pendulum", 1.0);
    assert!(plot.kind.offers(pendulum.lab.as_ref().unwrap().loaded.physics()).is_empty());
}

#[test]
fn only_new_variables_are_its_axes() {
    let text = "title = \"t\"\n[coordinates]\nq = { initial = 1.0 }\n[hamiltonian]\nH = \"p_q^2/2 + q^2/2\"\n\
        [[transformations]]\nname = \"turn\"\nkind = \"explicit\"\nQ = { X = \"p_q\" }\nP = { Y = \"-q\" }\n\
        [[views]]\nkind = \"transformation\"\nx = \"X\"\ny = \"p_q\"\n";
    let report = |text: &str| match preset::read(text) {
        Ok(_) => String::new(),
        Err(diagnostics) => format!("{diagnostics:?}"),
    };
    let said = report(text);
    assert!(said.contains("is shown in its new variables, and this is not one"), "{said}");
    assert!(said.contains("write one of X, Y"), "{said}");
    assert_eq!(report(&text.replace("y = \"p_q\"", "y = \"Y\"")), "");
}

/// p = P² + 0.1 sin P + 0.01 is nowhere below 0.0075, so there is no image at p = 0, where the motion begins. Above it
/// there is one, and P is constant where p is.
#[test]
fn a_grid_is_there_where_the_point_itself_has_no_image() {
    let text = "title = \"t\"\n[coordinates]\nq = { initial = 0.4, momentum = 0 }\n[hamiltonian]\n\
        H = \"p_q^2/2 + q^2/2\"\n[[transformations]]\nname = \"fold\"\nkind = \"F2\"\nnew = [\"Q\", \"P\"]\n\
        F = \"q*(P^2 + 0.1*sin(P) + 0.01)\"\n[[views]]\nkind = \"transformation\"\nx = \"Q\"\ny = \"P\"\n";
    let mut app = begun(text);
    press(&mut app, "Wait");
    let [plot] = &plots(&app)[..] else { panic!("the file has one") };
    let (grid, words) = shown(&app, plot);
    assert!(grid.len() > 4, "{} lines, {words:?}", grid.len());
    // where p is constant, P is
    let level = |line: &[[f64; 2]]| line.iter().all(|at| (at[1] - line[0][1]).abs() < 1e-12);
    assert!(grid.iter().any(|line| level(line)), "{words:?}");
}

/// p = P + a cos(q + P) and Q = q + a cos(q + P) cannot be written down: along each line of the grid q or p is constant, by
/// iterating q = Q − a cos(q + P).
#[test]
fn a_map_without_a_closed_form_has_its_grid() {
    for axes in [["Q", "P"], ["P", "Q"]] {
        has_the_grid_of_a_twist(axes);
    }
}

fn has_the_grid_of_a_twist(axes: [&str; 2]) {
    let text = "title = \"t\"\n[coordinates]\nq = { initial = 0.4, momentum = 0.3 }\n[hamiltonian]\n\
        H = \"p_q^2/2 + q^2/2\"\n[[transformations]]\nname = \"twist\"\nkind = \"F2\"\nnew = [\"Q\", \"P\"]\n\
        F = \"q*P + 0.1*sin(q + P)\"\n[[views]]\nkind = \"transformation\"\n";
    let [x, y] = axes;
    let mut app = begun(&format!("{text}x = \"{x}\"\ny = \"{y}\"\n"));
    press(&mut app, "Wait");
    let [plot] = &plots(&app)[..] else { panic!("the file has one") };
    let (grid, words) = shown(&app, plot);
    assert_eq!(words.first().map(String::as_str), Some("canonical, proved"));
    assert_eq!(words.last().map(String::as_str), Some("solved numerically"));
    assert_eq!(grid.len(), 14, "seven lines of each");
    let spread = |values: Vec<f64>| {
        let hi = values.iter().fold(f64::NEG_INFINITY, |hi, &x| hi.max(x));
        hi - values.iter().fold(f64::INFINITY, |lo, &x| lo.min(x))
    };
    let mut constant = [0, 0];
    for line in &grid {
        let old = |&image: &[f64; 2]| {
            let [new_q, new_p] = if x == "Q" { image } else { [image[1], image[0]] };
            let turn = |q: f64| 0.1 * math::cos(q + new_p);
            let q = (0..60).fold(new_q, |q, _| new_q - turn(q));
            [q, new_p + turn(q)]
        };
        let held = [0, 1].map(|k| spread(line.iter().map(|image| old(image)[k]).collect()));
        let axis = usize::from(held[1] < held[0]);
        assert!(held[axis] < 1e-14 && held[1 - axis] > 0.25, "{held:?}");
        constant[axis] += 1;
    }
    assert_eq!(constant, [7, 7]);
}

/// An oscillator with the transformation of an F2, at times one after the other.
struct Course {
    app: App,
    experiment: phaselab::experiment::Experiment,
}

impl Course {
    fn of(start: [f64; 2], function: &str) -> Course {
        let [q, p] = start;
        Course::with(&format!(
            "title = \"t\"\n[coordinates]\nq = {{ initial = {q}, momentum = {p} }}\n[hamiltonian]\n\
             H = \"p_q^2/2 + q^2/2\"\n[[transformations]]\nname = \"a\"\nkind = \"F2\"\nnew = [\"Q\", \"P\"]\n\
             F = \"{function}\"\n[[views]]\nkind = \"transformation\"\nx = \"Q\"\ny = \"P\"\n"
        ))
    }

    fn with(text: &str) -> Course {
        let app = begun(text);
        let ready =
            Prepared::of(&Document::new("test", text)).unwrap_or_else(|why| panic!("{why}"));
        let mut experiment = ready.experiment;
        experiment.set_epoch(1);
        Course { app, experiment }
    }

    fn go(&mut self, time: f64) {
        self.experiment.advance(time, 1_000_000);
        self.app.update(AppEvent::Snapshot(std::sync::Arc::new(self.experiment.snapshot())));
        press(&mut self.app, "Wait");
    }

    /// The lines of the grid, whole or dim, the images on other branches, and the legend.
    #[allow(clippy::type_complexity, reason = "the parts of one picture")]
    fn seen(&self) -> ([Vec<Vec<[f64; 2]>>; 2], Vec<[f64; 2]>, Vec<String>) {
        let lab = self.app.lab.as_ref().expect("a lab");
        let [plot] = &plots(&self.app)[..] else { panic!("the file has one") };
        let present = lab.present().expect("a motion");
        let picture = plot.kind.picture(lab.context(plot, &present), [0.0, 1.0]);
        let Some(Picture::Axes { layers, .. }) = picture else { panic!("it has axes") };
        let (mut grids, mut others, mut words) = ([vec![], vec![]], vec![], vec![]);
        for (_, layer) in layers {
            match layer {
                Layer::Line(line, stroke) => {
                    grids[usize::from(stroke.covering.is_some())].push(line);
                }
                Layer::Point(at, MarkerShape::Ring, Ink::Level) => others.push(at),
                Layer::Legend(lines) => words = lines,
                _ => {}
            }
        }
        (grids, others, words)
    }

    fn value(&self, name: &str) -> f64 {
        let lab = self.app.lab.as_ref().expect("a lab");
        let present = lab.present().expect("a motion");
        let channels = present.physics.system.channels();
        present.value(channels.iter().position(|c| c.name == name).expect(name))
    }
}

/// The trail begins where a parameter was changed last: before, the same names were other quantities.
#[test]
fn the_trail_in_new_variables_is_that_of_the_present_map() {
    let text = "title = \"scaled\"\n[coordinates]\nq = { initial = 1.0, momentum = 0.5 }\n[parameters]\nl = 2\n\
                [hamiltonian]\nH = \"p_q^2/2 + q^2/2\"\n[[transformations]]\nname = \"scaled\"\nkind = \"explicit\"\n\
                Q = { Q = \"q/l\" }\nP = { P = \"l*p_q\" }\n[[views]]\nkind = \"transformation\"\nx = \"Q\"\ny = \"P\"\n";
    let mut course = Course::with(text);
    course.go(1.5);
    let whole = course.app.lab.as_ref().unwrap().snapshot.clone().expect("a snapshot");
    let drawn = |seen: phaselab::experiment::Snapshot| {
        let mut app = course.app.clone();
        app.update(phaselab::app::AppEvent::Snapshot(std::sync::Arc::new(seen)));
        let all =
            crate::screen::rows(&crate::screen::screen(&app, &crate::screen::rich(), (120, 40)));
        // the pane at the top left
        let pane = all.iter().skip(1).take(20).map(|row| row.chars().take(40).collect());
        pane.collect::<Vec<String>>()
    };
    let with = |changed: Option<f64>, from: f64| {
        let mut seen = (*whole).clone();
        let rows: Vec<Vec<f64>> =
            seen.trail.rows().filter(|row| row[0] >= from).map(<[f64]>::to_vec).collect();
        seen.trail = phaselab::experiment::Trail::from_rows(seen.values.len() + 1, &rows);
        seen.recorded.changed = changed.map(|time| {
            let state = phaselab::system::State { time, ..(*seen.state).clone() };
            let (what, state) = ("l".to_owned(), std::sync::Arc::new(state));
            std::sync::Arc::new(phaselab::experiment::LastChange { what, state })
        });
        drawn(seen)
    };
    let all = with(None, 0.0);
    assert_eq!(with(Some(0.8), 0.0), with(None, 0.8));
    assert_ne!(with(Some(0.8), 0.0), all);
    let mut experiment = course.experiment;
    assert_eq!(experiment.snapshot().recorded.changed, None);
    experiment.execute(phaselab::experiment::Command::Parameter { index: 0, value: 3.0 });
    let seen = experiment.snapshot();
    let changed = seen.recorded.changed.expect("a change");
    assert_eq!((changed.what.as_str(), changed.state.time), ("l", seen.time));
    experiment.execute(phaselab::experiment::Command::Reset);
    assert_eq!(experiment.snapshot().recorded.changed, None);
}

/// Q = q cos a + p sin a, P = p cos a − q sin a: F2 and F3 divide by cos a, F1 and F4 by sin a, which is never both zero.
#[test]
fn generating_functions_that_do_not_exist_are_named_with_the_determinant() {
    let text = crate::fixtures::catalog().find("four-generators").unwrap().text.clone();
    for (angle, said) in [
        ("0.7", None),
        ("1.57", None),
        ("1.5707963267948966", Some("no F₂, F₃: ∂P/∂p = ∂Q/∂q = 0")),
        // the plane is that of the map by F1, which is not there: what was solved for still is
        ("0", Some("no F₁, F₄: ∂Q/∂p = ∂P/∂q = 0")),
    ] {
        let text = match angle {
            "0" => text.clone(),
            _ => text.replace("a = { value = 0.7,", &format!("a = {{ value = {angle},")),
        };
        let mut course = Course::with(&text);
        if angle == "0" {
            let none = phaselab::experiment::Command::Parameter { index: 0, value: 0.0 };
            course.experiment.execute(none);
        }
        course.go(1.0);
        let (_, words) = shown(&course.app, &plots(&course.app)[0]);
        let missing = words.iter().find(|line| line.starts_with("no F"));
        assert_eq!(missing.map(String::as_str), said, "at {angle}: {words:?}");
    }
}

/// Units take no function away: Q = q/λ, P = λp has F2 = qP/λ and F3 = −λpQ however large λ is, and neither F1 nor F4.
#[test]
fn units_take_no_generating_function_away() {
    for scale in ["1.0", "1e7", "1e-7"] {
        let text = format!(
            "title = \"scaled\"\n[coordinates]\nq = {{ initial = 1.0, momentum = 0.5 }}\n[parameters]\nl = {scale}\n\
             [hamiltonian]\nH = \"p_q^2/2 + q^2/2\"\n[[transformations]]\nname = \"scaled\"\nkind = \"explicit\"\n\
             Q = {{ Q = \"q/l\" }}\nP = {{ P = \"l*p_q\" }}\n[[views]]\nkind = \"transformation\"\nx = \"Q\"\ny = \"P\"\n"
        );
        let mut course = Course::with(&text);
        course.go(1.0);
        let (_, words) = shown(&course.app, &plots(&course.app)[0]);
        let missing = words.iter().find(|line| line.starts_with("no F"));
        let said = "no F₁, F₄: ∂Q/∂p = ∂P/∂q = 0";
        assert_eq!(missing.map(String::as_str), Some(said), "at {scale}: {words:?}");
    }
}

/// Q = q², P = p is not canonical, so that none of its generating functions is said to be missing.
#[test]
fn of_a_map_that_is_not_canonical_no_function_is_missing() {
    let text = "title = \"bad\"\n[coordinates]\nq = { initial = 1.0, momentum = 0.5 }\n[hamiltonian]\n\
                H = \"p_q^2/2 + q^2/2\"\n[[transformations]]\nname = \"bad\"\nkind = \"explicit\"\n\
                Q = { Q = \"q^2\" }\nP = { P = \"p_q\" }\n[[views]]\nkind = \"transformation\"\nx = \"Q\"\ny = \"P\"\n";
    let mut course = Course::with(text);
    course.go(1.0);
    let (_, words) = shown(&course.app, &plots(&course.app)[0]);
    assert!(words.iter().any(|line| line.contains("not canonical")), "{words:?}");
    assert!(!words.iter().any(|line| line.contains("no F")), "{words:?}");
}

/// F2 = q P²/2: p = P²/2 and Q = q P, so that P = ±√(2p): both roots are drawn, and where P alone solves there is but one.
#[test]
fn both_square_roots_are_drawn() {
    let mut course = Course::of([0.3, 0.9], "q*P^2/2");
    for time in [0.2, 0.5] {
        course.go(time);
        let ([whole, dim], others, words) = course.seen();
        let image = ["Q", "P"].map(|name| course.value(name));
        assert!((image[1].abs() - (2.0 * course.value("p_q")).sqrt()).abs() < 1e-14);
        let [other] = others[..] else { panic!("{others:?}, {words:?}") };
        assert!((0..2).all(|k| (other[k] + image[k]).abs() < 1e-12), "{other:?} of {image:?}");
        assert!(words.iter().any(|line| line.contains("the second branch")), "{words:?}");
        let side = |lines: &[Vec<[f64; 2]>], sign: f64| {
            !lines.is_empty() && lines.iter().flatten().all(|at| at[1] * sign >= -1e-9)
        };
        assert!(side(&whole, image[1]) && side(&dim, -image[1]));
        // along each dim line q = Q/P or p = P²/2 is constant
        for line in &dim {
            let old = |k: usize| {
                line.iter().map(move |at| if k == 0 { at[0] / at[1] } else { at[1] * at[1] / 2.0 })
            };
            let spread =
                |k: usize| old(k).fold(f64::MIN, f64::max) - old(k).fold(f64::MAX, f64::min);
            assert!(spread(0).min(spread(1)) < 1e-9, "{} {}", spread(0), spread(1));
        }
    }
    let mut single = Course::of([0.3, 0.9], "q*P + 0.1*sin(q + P)");
    single.go(0.2);
    let ([_, dim], others, words) = single.seen();
    assert!(dim.is_empty() && others.is_empty(), "{words:?}");
}

/// p = P⁵ − 5P³ + 5P = 2 T₅(P/2) has the five roots 2 cos((arccos(p/2) + 2πk)/5): each is an image, with Q = q ∂p/∂P.
#[test]
fn five_branches_are_drawn() {
    let mut course = Course::of([0.3, 0.4], "q*(P^5 - 5*P^3 + 5*P)");
    for time in [0.2, 0.9] {
        course.go(time);
        let ([whole, dim], others, words) = course.seen();
        let [q, p, own] = ["q", "p_q", "P"].map(|name| course.value(name));
        let root =
            |k: i32| 2.0 * (((p / 2.0).acos() + std::f64::consts::TAU * f64::from(k)) / 5.0).cos();
        let image = |root: f64| [q * (5.0 * root.powi(4) - 15.0 * root.powi(2) + 5.0), root];
        let (mine, rest): (Vec<f64>, Vec<f64>) =
            (0..5).map(root).partition(|root| (root - own).abs() < 1e-9);
        assert_eq!((mine.len(), rest.len(), others.len()), (1, 4, 4), "{others:?}, {words:?}");
        for root in rest {
            let [x, y] = image(root);
            let drawn = others.iter().filter(|at| (at[0] - x).hypot(at[1] - y) < 1e-9);
            assert_eq!(drawn.count(), 1, "{root} in {others:?}");
        }
        assert!(words.iter().any(|line| line.contains("4 other branches")), "{words:?}");
        // every branch has lines of its own: its P lies between two of the extrema of p, ±(√5 ± 1)/2
        let ends = [-1.618033988749895, -0.6180339887498949, 0.6180339887498949, 1.618033988749895];
        let branch = |at: &[f64; 2]| ends.iter().filter(|end| at[1] > **end).count();
        let mut drawn: Vec<usize> = whole.iter().chain(&dim).flatten().map(branch).collect();
        drawn.sort_unstable();
        drawn.dedup();
        assert_eq!(drawn, [0, 1, 2, 3, 4]);
    }
}

/// Maps one after the other have the branches of each: of p = P³ − 3P, Q = q ∂p/∂P, then Y = 2 Q, Z = P/2 three, where |p| < 2.
#[test]
fn maps_one_after_the_other_have_all_branches() {
    let text = "title = \"t\"\n[coordinates]\nq = { initial = 0.3, momentum = 0.4 }\n[hamiltonian]\n\
        H = \"p_q^2/2 + q^2/2\"\n[[transformations]]\nname = \"a\"\nkind = \"F2\"\nnew = [\"Q\", \"P\"]\n\
        F = \"q*(P^3 - 3*P)\"\n[[transformations]]\nname = \"b\"\nkind = \"explicit\"\n\
        Q = { X = \"2*q\" }\nP = { W = \"p_q/2\" }\n[[transformations]]\nname = \"c\"\nkind = \"compose\"\n\
        of = [\"a\", \"b\"]\nnew = [\"Y\", \"Z\"]\n[[views]]\nkind = \"transformation\"\nx = \"Y\"\ny = \"Z\"\n";
    let mut course = Course::with(text);
    for time in [0.2, 0.9] {
        course.go(time);
        let ([whole, dim], others, words) = course.seen();
        let [q, p, own] = ["q", "p_q", "Z"].map(|name| course.value(name));
        // P = 2 cos((arccos(p/2) + 2πk)/3)
        let root =
            |k: i32| 2.0 * (((p / 2.0).acos() + std::f64::consts::TAU * f64::from(k)) / 3.0).cos();
        let (mine, rest): (Vec<f64>, Vec<f64>) =
            (0..3).map(root).partition(|root| (0.5 * root - own).abs() < 1e-9);
        assert_eq!((mine.len(), rest.len(), others.len()), (1, 2, 2), "{others:?}, {words:?}");
        for root in rest {
            let [y, z] = [2.0 * q * (3.0 * root * root - 3.0), 0.5 * root];
            let drawn = others.iter().filter(|at| (at[0] - y).hypot(at[1] - z) < 1e-9);
            assert_eq!(drawn.count(), 1, "{root} in {others:?}");
        }
        assert!(!whole.is_empty() && !dim.is_empty(), "{words:?}");
        assert!(words.iter().any(|line| line.contains("2 other branches")), "{words:?}");
    }
}

/// Galilei: the grid of (q, p) is that of the instant, on which q = Q + u t or p = P + m u is constant.
#[test]
fn a_map_that_moves_has_the_grid_of_the_instant() {
    let head = "title = \"t\"\n[coordinates]\nq = { initial = 0.3, momentum = 0.9 }\n[hamiltonian]\n\
                H = \"p_q^2/2 + q^2/2\"\n[[transformations]]\nname = \"a\"\n";
    let view = "\n[[views]]\nkind = \"transformation\"\nx = \"Q\"\ny = \"P\"\n";
    let ways = [
        "kind = \"F2\"\nnew = [\"Q\", \"P\"]\nF = \"(q - t/5)*P + q/5 - t/50\"",
        "kind = \"explicit\"\nQ = { Q = \"q - t/5\" }\nP = { P = \"p_q - 1/5\" }",
    ];
    for way in ways {
        let mut course = Course::with(&format!("{head}{way}{view}"));
        for time in [7.0, 8.0, 9.5] {
            course.go(time);
            let ([whole, _], _, words) = course.seen();
            assert_eq!(whole.len(), 14, "{words:?}");
            // seven lines of the old q, within the motion and its margin, at this time
            let reach = 1.3 * 0.9_f64.hypot(0.3) + 1e-9;
            let mut levels = 0;
            for line in &whole {
                let old = |at: &[f64; 2]| at[0] + time / 5.0;
                let (least, greatest) = line
                    .iter()
                    .map(old)
                    .fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), q| (lo.min(q), hi.max(q)));
                assert!(least >= -reach && greatest <= reach, "{least} … {greatest} at {time}");
                levels += usize::from(greatest - least < 1e-12);
            }
            assert_eq!(levels, 7);
            press(&mut course.app, "Wait");
            let (_, _, words) = course.seen();
            assert!(words[0].contains("canonical"), "{words:?}");
            let k = words.iter().find(|line| line.starts_with("K = ")).expect("K").clone();
            // K = ½ P² + ½ (Q + t/5)² by hand, of the explicit map but for what depends on no variable
            let parts = if way.starts_with("kind = \"F2\"") {
                ["½ P²", "½ Q²", "⅕ t Q"]
            } else {
                ["½ P²", "½ (Q + ⅕ t)²", "− 0.02"]
            };
            assert!(parts.iter().all(|part| k.contains(part)), "{k}");
        }
    }
}

/// p = P³ − 3P + sin P/10: beyond p ≈ ±2 the branch in the middle ends, and then each of the outer ones beyond the other side.
/// The grid is that of the image's own branch, after a whole turn too, when its window no longer grows.
#[test]
fn the_grid_changes_its_branch_with_the_image() {
    let mut course = Course::of([-3.0, 0.0], "q*(P^3 - 3*P + 0.1*sin(P))");
    let turn = std::f64::consts::TAU;
    for k in 1..60 {
        course.go(turn * f64::from(k) / 60.0);
    }
    for (part, sign) in [(1.25, 1.0), (1.75, -1.0), (2.25, 1.0)] {
        course.go(turn * part);
        let image = course.value("P");
        assert!(image * sign > 1.0, "P = {image} at {part}");
        let ([whole, _], _, words) = course.seen();
        let outside = whole.iter().flatten().filter(|at| at[1] * sign < 0.5).count();
        assert!(!whole.is_empty() && outside == 0, "{outside} points of another branch, {words:?}");
    }
}

/// No stroke joins two branches, whichever observation it is that has no image, while frames are seen between the rows.
#[test]
fn a_trail_is_parted_at_a_caustic() {
    let text = "title = \"t\"\n[coordinates]\nq = { initial = -3.0, momentum = 0.0 }\n[hamiltonian]\n\
        H = \"p_q^2/2 + q^2/2\"\n[[transformations]]\nname = \"a\"\nkind = \"F2\"\nnew = [\"Q\", \"P\"]\n\
        F = \"q*(P^3 - 3*P + 0.1*sin(P))\"\n[[views]]\nkind = \"transformation\"\nx = \"Q\"\ny = \"P\"\n";
    let mut jumps = 0;
    for frames in [0.0, 0.0007, 0.003, 0.011] {
        let ready =
            Prepared::of(&Document::new("test", text)).unwrap_or_else(|why| panic!("{why}"));
        let mut experiment = ready.experiment;
        let mut time = 0.0;
        while time < 20.0 {
            time += if frames > 0.0 { frames } else { 20.0 };
            experiment.advance(time, 1_000_000);
        }
        let place = ready.system.channels().iter().position(|c| c.name == "P").expect("a channel");
        let trail = experiment.snapshot().trail.clone();
        let rows: Vec<f64> = trail.rows().map(|row| row[1 + place]).collect();
        let joined = rows.windows(2).filter(|pair| (pair[1] - pair[0]).abs() > 1.5).count();
        assert_eq!(joined, 0, "strokes between branches with a frame every {frames}");
        jumps += rows.split(|x| x.is_nan()).filter(|part| !part.is_empty()).count() - 1;
    }
    assert!(jumps >= 20, "{jumps}: five changes of branch or more each time");
}

/// The page of equations has what the notes of the presets send one to it for: which bracket fails, K, the generating
/// functions, the generators, the complete integral.
#[test]
fn the_page_of_equations_has_transformations() {
    let page = |name: &str| {
        let mut app = crate::fixtures::begun(&crate::fixtures::catalog().find(name).unwrap().text);
        crate::fixtures::press(&mut app, "2");
        screen_text(&app, (120, 120))
    };
    let oscillator = page("angle-of-the-oscillator");
    for words in [
        "Transformation action-angle: canonical, proved",
        "K = ω P",
        "Transformation polar: not canonical",
        "[θ, r] = ",
        "valence = λ μ",
        "Generators",
        "[H, G] = 0",
    ] {
        assert!(oscillator.contains(words), "{words}: {oscillator}");
    }
    let turn = page("four-generators");
    assert!(turn.contains("F₄ = "), "{turn}");
    let falling = page("falling-body");
    assert!(falling.contains("Integral of the Hamilton–Jacobi equation: complete"), "{falling}");
    assert!(falling.contains("∂S/∂α"), "{falling}");
}
