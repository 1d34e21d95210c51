//! Periodic orbits in the lab: closed near the motion, with period, action and multipliers held against published numbers
//! and closed forms.

use std::f64::consts::{PI, TAU};

use phaselab::app::{App, AppEvent, Computation, Effect};
use phaselab::experiment::Experiment;
use phaselab::instrument::{Layer, Plot};
use phaselab::job::Progress;
use phaselab::view::RenderStyle;
use phaselab::view::colour::ColourDepth;
use phaselab::view::glyphs::Glyphs;
use phaselab::view::theme::Theme;

use crate::fixtures::press;
use crate::laboratory::{self, open, prepared, see, typed};
use crate::screen::{rows, screen, screen_text};

/// Hénon's and Heiles's system at E = 1/8, a little beside the orbit B.
const HENON_HEILES: &str = r#"
title = "beside orbit B"
[coordinates]
x = { initial = 0.0, momentum = "sqrt(2*(1/8 - y0^2/2 + y0^3/3) - p0^2)" }
y = { initial = "y0", momentum = "p0" }
[parameters]
y0 = -0.18
p0 = 0.004
[hamiltonian]
H = "1/2*(p_x^2 + p_y^2) + 1/2*(x^2 + y^2) + x^2*y - y^3/3"
[run]
until = 100.0
"#;

fn one(lagrangian: &str, rest: &str) -> String {
    format!(
        "title = \"one\"\n[coordinates]\nq = {{ initial = 1.0, velocity = 0.0 }}\n[lagrangian]\n\
         L = \"{lagrangian}\"\n{rest}\n[run]\nuntil = 100.0\n"
    )
}

/// The lab with a motion at a time, after `t` was pressed.
fn opened(text: &str, time: f64) -> (App, Experiment) {
    let (mut app, experiment) = before(text, time);
    typed(&mut app, "t");
    (app, experiment)
}

/// The same before it was pressed.
fn before(text: &str, time: f64) -> (App, Experiment) {
    let (mut app, mut experiment) = open(prepared(text));
    see(&mut app, &mut experiment, time);
    (app, experiment)
}

fn focused(app: &App) -> &Plot {
    app.lab.as_ref().unwrap().focused_plot().unwrap().1
}

fn measure(app: &App, word: &str) -> Option<f64> {
    assert_eq!(focused(app).kind.name(), "orbit");
    laboratory::measured(app, focused(app), word)
}

fn layers(app: &App) -> Vec<Layer> {
    laboratory::layers(app, focused(app))
}

fn curve(app: &App) -> Option<Vec<[f64; 2]>> {
    layers(app).into_iter().find_map(|layer| match layer {
        Layer::Line(points, _) => Some(points),
        _ => None,
    })
}

fn legend(app: &App) -> String {
    laboratory::legend(app, focused(app))
}

#[test]
fn orbit_b_of_henon_and_heiles_has_its_published_numbers() {
    let (app, _) = opened(HENON_HEILES, 0.01);
    let near = |word: &str, published: f64, error: f64| {
        let found = measure(&app, word).unwrap();
        assert!((found - published).abs() < error, "{word}: {found} {published}");
    };
    near("energy", 0.125, 1e-13);
    near("period", 6.900_599_447_648_209, 1e-11);
    near("trace", 4.026_594_859_728_68, 1e-9);
    near("residue", (2.0 - 4.026_594_859_728_68) / 4.0, 1e-9);
    assert_eq!(measure(&app, "stable"), Some(0.0));
    // its exponent: ν + 1/ν is the trace, λ = ln ν / T
    let half = measure(&app, "trace").unwrap() / 2.0;
    let exponent = (half + (half * half - 1.0).sqrt()).ln() / measure(&app, "period").unwrap();
    assert!((exponent - 0.191_954_536_236_23).abs() < 1e-10, "{exponent}");
    let message = legend(&app);
    for words in ["T = 6.9005994", "1 (flow), 1 (energy)", "unstable, residue −0.50665"] {
        assert!(message.contains(words), "{words}: {message}");
    }
    // the curve closes, and passes through the published start
    let curve = curve(&app).unwrap();
    let [first, last] = [curve[0], curve[curve.len() - 1]];
    assert!((0..2).all(|k| (first[k] - last[k]).abs() < 1e-11), "{first:?} {last:?}");
    let start = [0.0, -0.185_405_087_090_802_14];
    let away = |at: &[f64; 2]| (at[0] - start[0]).hypot(at[1] - start[1]);
    assert!(curve.iter().map(away).fold(f64::MAX, f64::min) < 5e-3);
}

#[test]
fn a_pendulum_has_the_period_of_its_elliptic_integral() {
    let (app, _) = opened(&one("1/2*q'^2 + cos(q)", ""), 0.5);
    // T = 2π / agm(1, cos ½)
    let (mut a, mut b) = (1.0_f64, 0.5_f64.cos());
    for _ in 0..6 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    assert!((measure(&app, "period").unwrap() - TAU / a).abs() < 1e-12);
    // the flow and the energy leave nothing across the orbit
    assert_eq!(measure(&app, "residue"), None);
    for words in ["multipliers 1 (flow), 1 (energy)", "neutral: one of a family"] {
        assert!(legend(&app).contains(words), "{}", legend(&app));
    }
    // the area within: ∮ p dq = 2 ∫ √(2 (cos q − cos 1)) dq, by Gauss's substitution q = sin φ
    let n = 20_000;
    let width = PI / f64::from(n);
    let slice = |k: i32| {
        let angle = -PI / 2.0 + (f64::from(k) + 0.5) * width;
        let height = 2.0 * (angle.sin().cos() - 1.0_f64.cos());
        2.0 * height.max(0.0).sqrt() * angle.cos() * width
    };
    let area: f64 = (0..n).map(slice).sum();
    let found = measure(&app, "action").unwrap();
    assert!((found - area).abs() < 1e-7, "{found} {area}");
}

#[test]
fn a_limit_cycle_is_found_from_where_the_motion_is_now() {
    // ẍ = (1 − x²) ẋ − x, with the period 6.66328685…
    let text = one("1/2*q'^2 - 1/2*q^2", "dissipation = \"1/2*(q^2 - 1)*q'^2\"");
    let (mut app, mut experiment) = opened(&text, 40.0);
    let near = |app: &App| (measure(app, "period").unwrap() - 6.663_286_859_323).abs() < 1e-9;
    assert!(near(&app), "{:?}", measure(&app, "period"));
    assert_eq!(measure(&app, "stable"), Some(1.0));
    // again, from later on: the answer is another, the orbit the same
    see(&mut app, &mut experiment, 43.0);
    let before = curve(&app).unwrap();
    typed(&mut app, "t");
    let after = curve(&app).unwrap();
    assert!(near(&app));
    assert_ne!(before[0], after[0]);
}

#[test]
fn where_nothing_comes_back_it_says_why() {
    let (app, _) = opened(&one("1/2*q'^2", "").replace("velocity = 0.0", "velocity = 1.0"), 1.0);
    assert_eq!((measure(&app, "period"), curve(&app)), (None, None));
    assert!(
        legend(&app).contains("no periodic orbit was found near the start"),
        "{}",
        legend(&app)
    );
    // and so does the screen
    let shown = screen_text(&app, (120, 40));
    assert!(shown.contains("no periodic orbit was found"), "{shown}");
}

/// q̈ + 2γ q̇ + q = cos wt has one periodic orbit, of the amplitude 1/√((1 − w²)² + (2γw)²), and the multipliers of the motion
/// without the drive.
#[test]
fn a_driven_motion_is_closed_over_the_period_of_its_drive() {
    let text =
        one("1/2*q'^2 - 1/2*q^2", "dissipation = \"0.1*q'^2\"\nforces = { q = \"cos(2*t)\" }");
    let (app, _) = opened(&text, 3.0);
    let (g, w) = (0.1_f64, 2.0_f64);
    let period = measure(&app, "period").unwrap_or_else(|| panic!("{}", legend(&app)));
    assert!((period - PI).abs() < 1e-12, "{period}");
    assert_eq!((measure(&app, "multiple"), measure(&app, "stable")), (Some(1.0), Some(1.0)));
    let trace = 2.0 * (-g * PI).exp() * ((1.0 - g * g).sqrt() * PI).cos();
    assert!((measure(&app, "trace").unwrap() - trace).abs() < 1e-10);
    let amplitude = 1.0 / ((1.0 - w * w).powi(2) + (2.0 * g * w).powi(2)).sqrt();
    let greatest = curve(&app).unwrap().iter().map(|at| at[0]).fold(f64::MIN, f64::max);
    // 512 points miss the top by no more than (π/512)² of it
    assert!((greatest / amplitude - 1.0).abs() < 5e-5, "{greatest} {amplitude}");
    assert!(legend(&app).contains("that of the drive"), "{}", legend(&app));
}

/// Two drives of frequencies 2 and 3 have the common period 2π; of frequencies 1 and √2 they have none.
#[test]
fn drives_have_a_common_period_or_none() {
    let driven = |force: &str| {
        let rest = format!("dissipation = \"0.1*q'^2\"\nforces = {{ q = \"{force}\" }}");
        opened(&one("1/2*q'^2 - 2*q^2", &rest), 40.0).0
    };
    let app = driven("cos(2*t + 1) + sin(3*t)^2/4 + cos(3*t)");
    assert!((measure(&app, "period").unwrap() - TAU).abs() < 1e-12);
    for force in ["cos(t) + cos(sqrt(2)*t)", "exp(-t)", "t"] {
        let app = driven(force);
        assert_eq!(measure(&app, "period"), None);
        assert!(legend(&app).contains("depends on time, and not by"), "{}", legend(&app));
    }
}

#[test]
fn a_motion_that_never_returns_says_what_was_searched_for() {
    let (app, _) = opened(&one("1/2*q'^2 + 1/2*q^2", ""), 1.0);
    let said = legend(&app);
    for words in
        ["a return of (q, p_q) to within 50 %", "over a time of", "moved away", "give its period"]
    {
        assert!(said.contains(words), "{said}");
    }
}

/// The trail of a periodic motion lies on its orbit: without colour the orbit is dashed, so that both are seen.
#[test]
fn without_colour_the_orbit_is_told_from_the_trail() {
    let (mut app, _) = opened(&one("1/2*q'^2 - 1/2*q^2", ""), 0.3);
    press(&mut app, "z");
    let dots = |depth| {
        let look = RenderStyle { theme: Theme::dark(depth), glyphs: Glyphs::Braille };
        let text = rows(&screen(&app, &look, (120, 40))).concat();
        let braille = text.chars().map(u32::from).filter(|c| (0x2800..0x2900).contains(c));
        braille.map(|c| (c - 0x2800).count_ones()).sum::<u32>()
    };
    let (coloured, plain) = (dots(ColourDepth::True), dots(ColourDepth::None));
    assert!(coloured > 200, "the orbit is drawn: {coloured} dots");
    let share = f64::from(plain) / f64::from(coloured);
    assert!((0.4..0.75).contains(&share), "{plain} of {coloured} dots");
}

/// Where there is no orbit that is said at once, and what the motion is instead by another job; both say how far they are.
#[test]
fn a_refusal_comes_in_stages() {
    let damped = one("1/2*q'^2 - 1/2*q^2", "dissipation = \"0.01*q'^2\"");
    let (mut app, _) = before(&damped, 1.0);
    let mut effects = press(&mut app, "t");
    let mut names = Vec::new();
    for words in
        ["; what the motion is instead is being computed", ". The motion from there is regular"]
    {
        let job = effects.iter().position(|effect| matches!(effect, Effect::Compute(_)));
        let Effect::Compute(Computation { ticket, job, .. }) = effects.remove(job.expect("a job"))
        else {
            unreachable!("it is one")
        };
        let progress = Progress::new();
        let outcome = job.run(&progress);
        names.push(job.name.clone());
        assert!(progress.share().total.is_some() && progress.share().done > 0, "{}", job.name);
        effects.extend(app.update(AppEvent::Computed { ticket, outcome }));
        assert!(legend(&app).contains(words), "{}", legend(&app));
    }
    assert_eq!(names, ["periodic orbit", "what the motion is"]);
    assert!(!effects.iter().any(|effect| matches!(effect, Effect::Compute(_))));
}
