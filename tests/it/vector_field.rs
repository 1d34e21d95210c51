//! Vector fields and nullclines of phase portraits, and what has none.

use std::f64::consts::PI;

use phaselab::app::App;
use phaselab::instrument::{Layer, Picture, PlaneField, Plot, PlotContext, SavedPlot, named};
use phaselab::system::ChannelKind::{self, Momentum, Position, Velocity};
use phaselab::view::RenderStyle;
use phaselab::view::glyphs::Glyphs;

use crate::fixtures::{begun, in_lab, lab, press};
use crate::screen::{rich, rows, screen};

/// A phase portrait of two channels.
fn portrait(app: &App, [x, y]: [ChannelKind; 2]) -> Plot {
    let loaded = &app.lab.as_ref().unwrap().loaded;
    let channel = |kind| vec![loaded.physics().channel(kind).expect("a channel")];
    let columns = (vec![channel(x), channel(y)], None);
    Plot::new(named("phase").expect("the kind"), columns, &loaded.model)
}

fn field(app: &App, kinds: [ChannelKind; 2]) -> Result<PlaneField, String> {
    let plot = portrait(app, kinds);
    let present = app.lab.as_ref().unwrap().present().expect("a snapshot");
    PlaneField::of(PlotContext { plot: &plot, present: &present, answer: None })
}

/// Points of a plane, and what the rates there are.
fn check(app: &App, kinds: [ChannelKind; 2], law: impl Fn([f64; 2]) -> [f64; 2]) {
    let field = field(app, kinds).expect("a field");
    let mut rates = field.rates();
    for at in [[0.0, 0.0], [0.3, -1.2], [2.0, 4.0], [-3.0, 0.5], [PI, -7.0]] {
        let (found, expected) = (rates.at(at).expect("rates"), law(at));
        for k in [0, 1] {
            let scale = 1.0 + expected[k].abs();
            assert!(
                (found[k] - expected[k]).abs() < 1e-12 * scale,
                "{at:?}: {found:?} {expected:?}"
            );
        }
    }
}

/// q̇ = p/(m l²), ṗ = −m g l sin θ, in either order of the axes, and q̈ = −(g/l) sin θ over the velocity.
#[test]
fn the_field_of_the_pendulum() {
    let text = "title = \"Test\"\n[coordinates]\ntheta = { initial = 1.0, period = \"2*pi\" }\n\
                [parameters]\nm = 2.0\nl = 0.5\ng = 9.0\n[lagrangian]\n\
                L = \"1/2*m*l^2*theta'^2 + m*g*l*cos(theta)\"\n";
    let app = begun(text);
    let (m, l, g) = (2.0, 0.5, 9.0);
    let hamilton = |q: f64, p: f64| [p / (m * l * l), -m * g * l * q.sin()];
    check(&app, [Position(0), Momentum(0)], |[q, p]| hamilton(q, p));
    check(&app, [Momentum(0), Position(0)], |[p, q]| {
        let [rate, force] = hamilton(q, p);
        [force, rate]
    });
    check(&app, [Position(0), Velocity(0)], |[q, v]| [v, -g / l * q.sin()]);
    assert!(!field(&app, [Position(0), Momentum(0)]).unwrap().is_momentary());
}

/// Where the law is Hamilton's and not quadratic, where friction acts, where the time is in the law, and where another coordinate is.
#[test]
fn the_field_of_other_laws() {
    let relativistic = "title = \"Test\"\n[coordinates]\nx = { initial = 1.0 }\n\
                        [hamiltonian]\nH = \"sqrt(p_x^2 + 1) + x^2/2\"\n";
    check(&begun(relativistic), [Position(0), Momentum(0)], |[x, p]| {
        [p / (p * p + 1.0).sqrt(), -x]
    });
    let damped = "title = \"Test\"\n[coordinates]\nx = { initial = 1.0 }\n[lagrangian]\n\
                  L = \"x'^2 - 1/2*x^2\"\ndissipation = \"1/2*0.3*x'^2\"\n";
    check(&begun(damped), [Position(0), Velocity(0)], |[x, v]| [v, (-x - 0.3 * v) / 2.0]);
    check(&begun(damped), [Position(0), Momentum(0)], |[x, p]| [p / 2.0, -x - 0.3 * p / 2.0]);
    let in_time = "title = \"Test\"\n[coordinates]\nx = { initial = 1.0 }\n[lagrangian]\n\
                   L = \"1/2*x'^2 - 1/2*(1 + t)*x^2\"\n[run]\nstart = 3.0\n";
    check(&begun(in_time), [Position(0), Momentum(0)], |[x, p]| [p, -4.0 * x]);
    assert!(field(&begun(in_time), [Position(0), Momentum(0)]).unwrap().is_momentary());
    let coupled = "title = \"Test\"\n[coordinates]\nx = { initial = 1.0 }\n\
                   y = { initial = 0.5, velocity = 2.0 }\n[lagrangian]\n\
                   L = \"1/2*x'^2 + 1/2*y'^2 + 1/2*x'*y' - x^2*y^2\"\n";
    let app = begun(coupled);
    assert!(field(&app, [Position(0), Velocity(0)]).unwrap().is_momentary());
    // p = M q̇ with M = (1 ½; ½ 1), so that p_y = 2 + x′/2 at the start, where x′ is 0
    let inverse = 4.0 / 3.0;
    check(&app, [Position(0), Momentum(0)], |[x, p]| [inverse * (p - 0.5 * 2.0), -2.0 * x * 0.25]);
    check(&app, [Position(1), Velocity(1)], |[y, v]| {
        let [fx, fy] = [-2.0 * y * y, -2.0 * y];
        [v, inverse * (fy - 0.5 * fx)]
    });
}

/// p = v³ − v has three velocities for small momenta: the motion, and so the field, has those of its branch, v > 1/√3. Below it ends.
#[test]
fn the_field_is_on_the_branch_of_the_motion() {
    let start = |velocity: f64| {
        format!(
            "title = \"Test\"\n[coordinates]\nx = {{ initial = 1.0, velocity = {velocity:?} }}\n\
             [lagrangian]\nL = \"1/4*x'^4 - 1/2*x'^2 - 1/2*x^2\"\n"
        )
    };
    for sign in [1.0, -1.0] {
        let found = field(&begun(&start(sign * 1.2)), [Position(0), Momentum(0)]).unwrap();
        let mut rates = found.rates();
        for v in [0.7, 2.0, 1.0, 0.8, 1.2] {
            assert_eq!(rates.at([0.3, -0.5 * sign]), None, "beyond the end of the branch");
            let [rate, force] = rates.at([0.3, sign * (v * v * v - v)]).expect("rates");
            assert!((rate - sign * v).abs() < 1e-10 && force == -0.3, "{v}: {rate} {force}");
        }
    }
    // p = v/√(1 − v²), from rest to velocities near that of light
    let relativistic = "title = \"Test\"\n[coordinates]\nx = { initial = 1.0 }\n[lagrangian]\n\
                        L = \"-sqrt(1 - x'^2) - 1/2*x^2\"\n";
    check(&begun(relativistic), [Position(0), Momentum(0)], |[x, p]| {
        [p / (p * p + 1.0).sqrt(), -x]
    });
}

/// The arrows of a picture, with their columns and rows, and the middle of the axes; the picture is that of the pendulum alone.
fn arrows(look: &RenderStyle) -> (Vec<(u16, u16, char)>, (u16, u16)) {
    let mut app = in_lab();
    while app.lab.as_ref().unwrap().focused_plot().is_none_or(|(_, p)| p.kind.name() != "phase") {
        press(&mut app, "Tab");
    }
    press(&mut app, "* z");
    let buffer = screen(&app, look, (120, 40));
    let symbol = |x: u16, y: u16| buffer[(x, y)].symbol().chars().next().unwrap_or(' ');
    let ticks: Vec<String> = rows(&buffer);
    let is_zero = |row: &&String| row.trim_start_matches(['│', '|', '┃', ' ']).starts_with('0');
    let middle = ticks.iter().skip(2).position(|row| is_zero(&row)).expect("a tick at zero") + 2;
    let below = (middle + 1..40).find(|y| is_zero_below(&ticks[*y])).expect("ticks below");
    let across = ticks[below].chars().position(|c| c == '0').expect("a tick at zero");
    let mut found = Vec::new();
    for y in 3..(below - 1) as u16 {
        for x in 12..116 {
            if "→↗↑↖←↙↓↘><^v".contains(symbol(x, y)) {
                found.push((x, y, symbol(x, y)));
            }
        }
    }
    (found, (across as u16, middle as u16))
}

/// Whether a row has the ticks from −π to π.
fn is_zero_below(row: &str) -> bool {
    row.contains("pi/2") && row.contains(" 0 ") || row.contains("π/2") && row.contains(" 0 ")
}

/// θ′ = p/(m l²) is to the right above p = 0 and to the left below, p′ = −m g l sin θ down right of θ = 0 and up left of it.
#[test]
fn arrows_point_along_the_flow() {
    for (glyphs, diagonals) in
        [(Glyphs::Braille, true), (Glyphs::HalfBlock, false), (Glyphs::Ascii, false)]
    {
        let (found, (across, middle)) = arrows(&RenderStyle { glyphs, ..rich() });
        assert!(found.len() > 40, "{glyphs:?}: {found:?}");
        for &(x, y, sign) in &found {
            let wrong = [
                (y < middle, "←↙↖<"),
                (y > middle, "→↗↘>"),
                (x > across, "↑↗↖^"),
                (x < across, "↓↘↙v"),
            ];
            let is_wrong = wrong.iter().any(|(here, signs)| *here && signs.contains(sign));
            assert!(!is_wrong, "{glyphs:?}: {sign} at {x}, {y}; {across}, {middle}: {found:?}");
        }
        let has = |sign: char| found.iter().any(|(_, _, own)| *own == sign);
        assert_eq!("↗↖↙↘".chars().all(has), diagonals, "{glyphs:?}: {found:?}");
        assert!(["→><^v", "←><^v"].iter().all(|signs| signs.chars().any(has)), "{found:?}");
    }
}

/// No arrow lies on the trail.
#[test]
fn arrows_leave_the_trail_alone() {
    let mut app = in_lab();
    let before = screen(&app, &rich(), (120, 40));
    press(&mut app, "*");
    let after = screen(&app, &rich(), (120, 40));
    let theme = rich().theme;
    let inks: Vec<_> = theme.trail(0).iter().filter_map(|shade| shade.style.fg).collect();
    let cells = (2..21).flat_map(|y| (41..79).map(move |x| (x, y)));
    let trail: Vec<(u16, u16)> =
        cells.filter(|at| before[*at].symbol() != " " && inks.contains(&before[*at].fg)).collect();
    assert!(trail.len() > 10, "{trail:?}");
    for at in trail {
        assert!(!"→↗↑↖←↙↓↘".contains(after[at].symbol()), "{at:?}");
    }
}

/// Runs beside the motion have other colours than the nullclines, and without colours other dashes.
#[test]
fn nullclines_are_not_in_the_colours_of_pinned_runs() {
    let mut app = in_lab();
    press(&mut app, "*");
    let shown = screen(&app, &rich(), (120, 40));
    let legend = rows(&shown)[2].clone();
    let theme = rich().theme;
    // the first of the runs beside the motion, in their order
    let runs = [4, 2, 5, 3].map(|series| theme.curve(series).fg);
    let samples: Vec<_> =
        (41..79).filter(|x| shown[(*x, 2)].symbol() == "━").map(|x| shown[(x, 2)].fg).collect();
    assert!(samples.len() >= 2, "{legend}");
    assert!(samples.iter().all(|fg| !runs.contains(&Some(*fg))), "{legend}: {samples:?}");
}

/// Over the plane of the pendulum θ′ vanishes on p = 0 and p′ on sin θ = 0; they cross at the equilibria. A force that jumps from
/// one infinity to the other vanishes nowhere.
#[test]
fn nullclines_lead_through_the_equilibria() {
    let found = field(&in_lab(), [Position(0), Momentum(0)]).unwrap();
    let [level, upright] = found.nullclines([[-PI, PI], [-8.0, 9.0]]);
    let all = |curves: &[Vec<[f64; 2]>]| curves.iter().flatten().copied().collect::<Vec<_>>();
    let (level, upright) = (all(&level), all(&upright));
    assert!(level.len() > 50 && upright.len() > 50, "{} {}", level.len(), upright.len());
    assert!(level.iter().all(|[_, p]| p.abs() < 1e-3), "{level:?}");
    assert!(upright.iter().all(|[q, _]| q.sin().abs() < 1e-3), "{upright:?}");
    for equilibrium in [-PI, 0.0, PI] {
        for curve in [&level, &upright] {
            let near = |[q, p]: &[f64; 2]| (q - equilibrium).abs() < 0.06 && p.abs() < 0.2;
            assert!(curve.iter().any(near), "{equilibrium} {curve:?}");
        }
    }

    let pole = "title = \"Test\"\n[coordinates]\nx = { initial = 1.0 }\n[lagrangian]\n\
                L = \"1/2*x'^2 - ln(abs(x))\"\n";
    let found = field(&begun(pole), [Position(0), Momentum(0)]).unwrap();
    let [level, upright] = found.nullclines([[-1.0, 1.3], [-1.0, 1.0]]);
    assert!(upright.is_empty(), "{upright:?}");
    assert!(!level.is_empty());
}

fn shown(app: &App) -> String {
    rows(&screen(app, &rich(), (120, 40))).join("\n")
}

/// Whether any picture of the lab has strokes.
fn has_strokes(app: &App) -> bool {
    let lab = app.lab.as_ref().unwrap();
    let present = lab.present().expect("a snapshot");
    lab.plots.iter().any(|plot| {
        let picture = plot.kind.picture(lab.context(plot, &present), [f64::NAN; 2]);
        let is_field = |layer: &Layer| matches!(layer, Layer::VectorField(_));
        matches!(picture, Some(Picture::Axes { layers, .. }) if layers.iter().any(|(_, l)| is_field(l)))
    })
}

/// A key shows it and hides it, wherever the focus is; undo takes it back, and a session keeps it.
#[test]
fn a_key_shows_the_field_and_its_nullclines() {
    let mut app = in_lab();
    assert!(!has_strokes(&app));
    press(&mut app, "*");
    assert!(has_strokes(&app));
    let shown = shown(&app);
    assert!(shown.contains(" θ′ = 0") && shown.contains(" p_θ′ = 0"), "{shown}");
    let lab = app.lab.as_ref().unwrap();
    let physics = lab.loaded.physics();
    let plot = lab.plots.iter().find(|plot| plot.shows_field()).expect("the portrait");
    let text = serde_json::to_string(&SavedPlot::of(plot, physics)).unwrap();
    let saved: SavedPlot = serde_json::from_str(&text).unwrap();
    assert!(saved.viewport.expect("axes").field);
    press(&mut app, "u");
    assert!(!has_strokes(&app));
    press(&mut app, "* *");
    assert!(!has_strokes(&app));
}

/// A plane that has none says why.
#[test]
fn a_plane_without_a_field_says_why() {
    let system = |law: &str, y: &str| {
        format!(
            "title = \"Test\"\n[coordinates]\nx = {{ initial = 1.0 }}\ny = {{ initial = 0.5 }}\n\
             {law}\n[[views]]\nkind = \"phase\"\nx = \"x\"\ny = \"{y}\"\n"
        )
    };
    let free = "[lagrangian]\nL = \"1/2*x'^2 + 1/2*y'^2\"";
    let tied = "[lagrangian]\nL = \"1/2*x'^2 + 1/2*y'^2\"\n[[constraints]]\nname = \"rod\"\n\
                expression = \"x^2 + y^2 - 1.25\"";
    let hamiltonian = "[hamiltonian]\nH = \"1/2*p_x^2 + 1/2*p_y^2\"";
    for (law, y, why) in [
        (free, "y", "y against x is not a coordinate and its own momentum or velocity"),
        (free, "p_y", "is not a coordinate and its own momentum or velocity"),
        (tied, "x'", "the constraints allow only some of its points"),
        (hamiltonian, "x'", "H gives the rates of momenta, and not of velocities"),
    ] {
        let mut app = begun(&system(law, y));
        let lab = app.lab.as_mut().unwrap();
        let index = lab.plots.iter().position(|plot| plot.kind.name() == "phase").unwrap();
        lab.focus.pane = phaselab::app::Pane::Plot(index);
        press(&mut app, "*");
        assert!(!has_strokes(&app), "{law}");
        let shown = shown(&app);
        assert!(shown.contains("no vector field"), "{law}: {shown}");
        let plot = &app.lab.as_ref().unwrap().plots[index];
        let lacks = plot.lacks_field(app.lab.as_ref().unwrap().loaded.physics());
        assert!(lacks.as_deref().is_some_and(|lacks| lacks.contains(why)), "{law}: {lacks:?}");
    }
    let poisson = lab("explorer", 1.0);
    let lacks = field(&poisson, [Position(0), Position(1)]).expect_err("none");
    assert!(lacks.contains("brackets"), "{lacks}");
}

/// A view of a file opens with its field.
#[test]
fn a_file_asks_for_the_field() {
    let view = "title = \"Test\"\n[coordinates]\nx = { initial = 1.0 }\n[lagrangian]\n\
                L = \"1/2*x'^2 - 1/2*x^2\"\n[[views]]\nkind = \"phase\"\nx = \"x\"\ny = \"p_x\"\nfield = true\n";
    assert!(has_strokes(&begun(view)));
    assert!(!has_strokes(&begun(&view.replace("true", "false"))));
}

/// From elsewhere the key acts on a portrait in view, and brings one that is not to the front; the focused one goes first.
#[test]
fn the_field_is_shown_where_it_is_seen() {
    let mut app = in_lab();
    let size = (80, 24);
    let time = app.lab.as_ref().unwrap().plots.iter().position(|p| p.kind.name() == "time");
    app.lab.as_mut().unwrap().focus.pane = phaselab::app::Pane::Plot(time.unwrap());
    press(&mut app, "z");
    let (_, drawn) = crate::screen::drawn(&app, &rich(), size);
    app.update(phaselab::app::AppEvent::Drawn(drawn));
    press(&mut app, "*");
    let shown = rows(&screen(&app, &rich(), size)).join("\n");
    assert!(shown.contains(" p_θ′ = 0"), "{shown}");
    assert!(shown.contains("p_θ against θ, is shown"), "{shown}");
}
