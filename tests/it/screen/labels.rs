//! Names and colours in the picture, and the words beside them: what a thing is must be readable off the screen.

use std::sync::Arc;

use phaselab::app::{App, AppEvent, Notification, Pane};
use phaselab::experiment::{Gauge, Growth, Verdict};
use phaselab::model::{Model, Shape};
use phaselab::view::RenderStyle;
use phaselab::view::colour::ColourDepth;
use phaselab::view::glyphs::Glyphs;
use phaselab::view::theme::Theme;
use ratatui::buffer::Buffer;
use ratatui::style::Color;

use super::{rich, rows, screen};
use crate::app::real::Real;
use crate::fixtures::{begun, catalog, gauge, in_lab, lab, loaded, lowered, press, snapshot};
use crate::nonempty;

/// The arrows of a picture in space, as their labels.
fn arrows(model: &Model) -> Vec<&str> {
    let shapes = model.picture.shapes.iter();
    let labels = shapes.filter_map(|shape| match shape {
        Shape::Vector { label, .. } => Some(label.as_str()),
        _ => None,
    });
    labels.collect()
}

#[test]
fn every_arrow_of_the_shipped_presets_has_a_name() {
    let mut count = 0;
    for entry in catalog().entries() {
        let model = catalog().find(&entry.name).unwrap().read().unwrap().model;
        let labels = arrows(&model);
        assert!(labels.iter().all(|label| !label.is_empty()), "{}: {labels:?}", entry.name);
        count += labels.len();
    }
    assert!(count > 40, "{count} arrows were seen");
}

/// The places of the filled markers in this colour within the left-hand frame.
fn markers(buffer: &Buffer, colour: Option<Color>) -> Vec<(u16, u16)> {
    let cells = (1..24).flat_map(|y| (0..40).map(move |x| (x, y)));
    let alike = |&(x, y): &(u16, u16)| {
        let cell = &buffer[(x, y)];
        cell.symbol() == "●" && Some(cell.fg) == colour
    };
    cells.filter(alike).collect()
}

#[test]
fn masses_that_parameters_fix_leave_the_first_colour_to_what_moves() {
    let buffer = screen(&lab("two-centres", 1.0), &rich(), (120, 40));
    let places = [0, 1, 2].map(|curve| markers(&buffer, rich().theme.curve(curve).fg));
    let [planet, suns, others] = &places;
    assert!(planet.len() == 1 && suns.len() == 2 && others.is_empty(), "{places:?}");
    // both suns are amber, and lie on the horizontal axis
    assert_eq!(suns[0].1, suns[1].1, "{places:?}");
}

#[test]
fn the_sun_is_amber_although_it_moves() {
    let shipped = loaded("solar-system", 1);
    let shapes = shipped.model.picture.shapes.iter();
    let mut masses = shapes.filter_map(|shape| match shape {
        Shape::Mass { at, .. } => Some(shipped.model.pool.text(at[0])),
        _ => None,
    });
    assert_eq!(masses.nth(1).as_deref(), Some("x0"), "the second colour is the amber one");
    let buffer = screen(&lab("solar-system", 1.0), &rich(), (120, 40));
    let amber = rich().theme.curve(1).fg;
    let mut picture = (2..22).flat_map(|y| (1..38).map(move |x| (x, y)));
    assert!(picture.any(|at| Some(buffer[at].fg) == amber));
}

/// The residual of a constraint is no conserved quantity, and is not written twice.
#[test]
fn a_residual_is_called_a_residual() {
    let mut app = lab("pendulum-rod", 1.0);
    let name = loaded("pendulum-rod", 1).model.constraints[0].name.clone();
    let mut seen = snapshot(&loaded("pendulum-rod", 1), 1.0);
    let exact = Verdict::Exact(Growth::Level);
    let energy = gauge("energy", "E", 4.0, exact.clone());
    let residual = Gauge {
        initial: 0.0,
        reference: 0.0,
        drift: 3.25e-16,
        proved: false,
        reason: "λ_rod = 1.5 N/m, tension of the rod, with a sentence that no pane has room for"
            .into(),
        ..gauge(&name, &name, 3.25e-16, exact)
    };
    seen.gauges = [energy, residual].into();
    app.update(AppEvent::Snapshot(Arc::new(seen)));
    let text = rows(&screen(&app, &rich(), (120, 40)));
    let at = text.iter().position(|row| row.contains(&format!("  {name} "))).unwrap();
    assert!(text[at].contains("residual") && text[at].contains(" exact "), "{text:#?}");
    assert!(!text[at].contains("conserved"), "{text:#?}");
    assert_eq!(text[at + 1].matches("10⁻¹⁶").count(), 1, "{text:#?}");
    assert!(!text.join("\n").contains("conserved (exact)"), "one word for one verdict: {text:#?}");
    press(&mut app, "4");
    let text = rows(&screen(&app, &rich(), (120, 100)));
    let row = text.iter().rfind(|row| row.contains(&format!("  {name} "))).unwrap();
    assert!(row.contains("  residual") && !row.contains("drift"), "{text:#?}");
}

/// The last hint says what `q` does now: it closes what lies on top, and leaves where nothing does.
#[test]
fn the_hint_for_q_says_what_it_does() {
    let mut app = in_lab();
    for (keys, word) in [("?", "q close"), ("q", "q quit"), ("T", "q close"), ("q", "q quit")] {
        press(&mut app, keys);
        let text = rows(&screen(&app, &rich(), (80, 24)));
        assert!(text[23].contains(word), "{keys}: {text:#?}");
    }
}

/// The names of the axes stand in the corner of the frame, beside what is drawn.
#[test]
fn the_triad_stands_in_the_corner() {
    for glyphs in [Glyphs::Braille, Glyphs::Ascii] {
        let look = RenderStyle { glyphs, ..rich() };
        let buffer = screen(&lab("sleeping-top", 1.0), &look, (120, 40));
        let floor = (2..40).find(|&y| "╰+".contains(buffer[(0, y)].symbol()));
        let floor = floor.unwrap_or_else(|| panic!("{:#?}", rows(&buffer)));
        let row: String = (1..9).map(|x| buffer[(x, floor - 1)].symbol()).collect();
        assert!(row.trim_end().ends_with('x'), "{:#?}", rows(&buffer));
        assert_eq!(buffer[(2, floor - 3)].symbol(), "z", "{:#?}", rows(&buffer));
        // a low picture has it beside the scene, too
        let text = rows(&screen(&lab("sleeping-top", 1.0), &look, (80, 24)));
        let corner: String =
            text[7..13].iter().flat_map(|row| row.chars().skip(1).take(10)).collect();
        assert!(["x", "y", "z"].iter().all(|axis| corner.contains(axis)), "{text:#?}");
    }
}

/// Where the tabs of a frame leave no room for the keys of its curves, these are written above the axes.
#[test]
fn every_curve_of_several_has_its_key_on_the_screen() {
    for (name, keys) in [
        ("toda-three", &["━ p_q₁", "━ p_q₂", "━ p_q₃"][..]),
        ("free-rigid-body", &["━ rate about axis 1", "━ rate about axis 2", "━ rate about axis 3"]),
        ("kepler-brackets", &["━ L_x", "━ L_y", "━ L_z"]),
        ("relativistic-particle", &["━ x′", "━ y′"]),
    ] {
        let buffer = screen(&lab(name, 1.0), &rich(), (120, 40));
        for (index, key) in keys.iter().enumerate() {
            let at = super::find(&buffer, key);
            let (x, y) = at.unwrap_or_else(|| panic!("{name}: {key}\n{:#?}", rows(&buffer)));
            assert_eq!(Some(buffer[(x, y)].fg), rich().theme.curve(index).fg, "{name}: {key}");
        }
    }
}

/// The reading of the cursor stands beside the words above the axes, or below them.
#[test]
fn the_cursor_covers_no_word_above_the_axes() {
    let mut app = lab("darwin", 1.0);
    while app.lab.as_ref().unwrap().focused_plot().is_none_or(|(_, p)| p.kind.name() != "time") {
        press(&mut app, "Tab");
    }
    let above = |app: &phaselab::app::App| -> String {
        rows(&screen(app, &rich(), (80, 24)))[2].chars().skip(41).take(38).collect()
    };
    let words = above(&app).trim().to_owned();
    assert!(words.chars().count() > 28, "{words}");
    press(&mut app, "c");
    let buffer = screen(&app, &rich(), (80, 24));
    assert!(super::find(&buffer, "┼").is_some(), "{:#?}", rows(&buffer));
    assert!(above(&app).contains(&words), "{words} {:#?}", rows(&buffer));
}

/// A rod on ice swings around neither of its ends, so the picture has no room for that.
#[test]
fn a_free_rod_fills_its_picture() {
    let buffer = screen(&lab("rod-on-ice", 2.0), &rich(), (120, 40));
    let dots = |c: &str| c.starts_with(|c: char| ('⠁'..='⣿').contains(&c) || c == '●');
    let drawn: Vec<u16> =
        (2..20).filter(|y| (1..38).any(|x| dots(buffer[(x, *y)].symbol()))).collect();
    let high = drawn.last().unwrap() - drawn.first().unwrap() + 1;
    assert!(high >= 12, "{high} rows of 20: {:#?}", rows(&buffer));
}

/// Three rollers and the finish lie close together in a small frame.
#[test]
fn no_name_is_written_over_another() {
    for (time, size) in [(1.3, (40, 10)), (1.5, (40, 10)), (1.5, (80, 24)), (0.1, (40, 10))] {
        let buffer = screen(&lab("rolling-race", time), &rich(), size);
        for name in ["hoop", "disc", "ball", "finish"] {
            let here = super::find(&buffer, name);
            assert!(here.is_some(), "{name} at {time}, {size:?}: {:#?}", rows(&buffer));
        }
    }
}

/// A notification over a focused frame has one weight throughout.
#[test]
fn a_notification_takes_nothing_from_the_frame_below_it() {
    let mut app = in_lab();
    let text = "lift-off at t = 0.5634: the constraint sphere no longer holds";
    app.notifications.show(Notification::info(text.to_owned()));
    let buffer = screen(&app, &rich(), (80, 24));
    let (x, y) = super::find(&buffer, "lift-off at").expect("the notification");
    let modifiers = |x: u16| buffer[(x, y)].modifier;
    let long = text.chars().count() as u16;
    assert!((x..x + long).all(|at| modifiers(at) == modifiers(x)), "{:?}", rows(&buffer));
    assert_eq!(modifiers(x), rich().theme[phaselab::view::theme::Role::Good].add_modifier);
}

/// In a frame that is too narrow for all its titles none ends with the line that stands between two.
#[test]
fn no_line_between_titles_is_left_alone() {
    for width in 40..100 {
        for text in rows(&screen(&in_lab(), &rich(), (width, 17))) {
            let alone = text.contains("│  ─") || text.contains("│ ─");
            assert!(!alone, "{width}: {text}");
        }
    }
}

/// Titles that begin alike are told apart by their ends where the list has no room for them.
#[test]
fn no_two_rows_of_the_picker_are_the_same() {
    let (app, _) = phaselab::app::App::new(catalog(), None);
    for size in [(80, 250), (100, 250), (120, 250)] {
        let buffer = screen(&app, &rich(), size);
        let list = |row: String| row.chars().skip(3).take(30).collect::<String>().trim().to_owned();
        let mut names: Vec<String> = rows(&buffer).into_iter().skip(5).map(list).collect();
        names.retain(|name| name.chars().filter(|c| c.is_alphabetic()).count() > 3);
        let count = names.len();
        names.sort();
        names.dedup();
        assert!(count > 80 && names.len() == count, "{size:?}: {names:#?}");
    }
}

/// Where a notification ends within the words of a frame, such as `+1 down`, nothing is left of them.
#[test]
fn a_notification_leaves_no_part_of_a_word_in_the_frame() {
    let look = RenderStyle { theme: Theme::dark(ColourDepth::Ansi16), glyphs: Glyphs::Ascii };
    let bottom = |app: &phaselab::app::App| rows(&screen(app, &look, (80, 24))).remove(21);
    let mut app = lab("rolling-race", 1.3);
    let frame = bottom(&app);
    let mark = frame.find("+1 down").expect("a list that is clipped");
    // From a notification that ends before the mark to one that covers it.
    for long in nonempty(mark - 8..mark + 9) {
        let text = "x".repeat(long);
        app.notifications.show(Notification::info(text.clone()));
        let row = bottom(&app);
        let rest = row.split_once(&text).expect("the notification").1.replace("+1 down", "");
        assert!(!rest.contains(char::is_alphabetic), "{row}");
    }
}

/// Neumann's particle on its sphere.
fn on_a_solid_sphere() -> App {
    let text = include_str!("../../../presets/constraints/neumann.toml");
    let axes = text.find("  { line").unwrap()..text.find("  { trace").unwrap();
    let mut text = text.to_owned();
    text.replace_range(axes, "");
    // without the axes around it, it fills the picture
    begun(&text.replace("reach = \"1.3\"", "reach = \"1.05\""))
}

/// In ASCII a shaded sphere is made of points: a block in each shaded cell would hide the curves on it.
#[test]
fn in_ascii_a_sphere_is_shaded_by_points() {
    let look = RenderStyle { theme: Theme::dark(ColourDepth::None), glyphs: Glyphs::Ascii };
    let buffer = screen(&on_a_solid_sphere(), &look, (120, 40));
    let count = |sign: &str| {
        let cells = (2..21).flat_map(|y| (2..38).map(move |x| (x, y)));
        cells.filter(|at| buffer[*at].symbol() == sign).count()
    };
    assert!(count(".") + count(":") > 25 && count("#") < 4, "{:#?}", rows(&buffer));
}

/// The sphere is shaded by dots, of the same colour as the curve on it where there is none: few, so that it is seen.
#[test]
fn without_colour_a_sphere_leaves_the_curve_on_it_in_sight() {
    let dots = |depth| {
        let look = RenderStyle { theme: Theme::dark(depth), glyphs: Glyphs::Braille };
        // At the start there is hardly a curve yet, and all dots are those of the sphere.
        let buffer = screen(&on_a_solid_sphere(), &look, (120, 40));
        let dots = |x: u16, y: u16| {
            let symbol = buffer[(x, y)].symbol().chars().next().map_or(0, u32::from);
            if (0x2800..0x2900).contains(&symbol) { (symbol - 0x2800).count_ones() } else { 0 }
        };
        (2..22).flat_map(|y| (2..38).map(move |x| (x, y))).map(|(x, y)| dots(x, y)).sum::<u32>()
    };
    let (coloured, plain) = (dots(ColourDepth::Ansi16), dots(ColourDepth::None));
    assert!(plain > 100 && 2 * plain < coloured, "{plain} of {coloured} dots");
}

/// The further lines of a formula stand right of its sign, however long its terms are.
#[test]
fn no_line_of_a_formula_hangs_left_of_its_sign() {
    let mut further = 0;
    for name in ["double-pendulum", "heavy-top", "swinging-atwood"] {
        let mut app = lab(name, 1.0);
        press(&mut app, "2");
        for size in [(80, 250), (100, 250)] {
            let rows = rows(&screen(&app, &rich(), size));
            let from = rows.iter().position(|row| row.contains("Equations of motion"));
            let section = rows[from.expect("a heading") + 1..].iter();
            let mut sign = 0;
            for row in section.take_while(|row| row.chars().any(char::is_alphanumeric)) {
                let letters: Vec<char> = row.chars().collect();
                let begins = letters.iter().position(|c| !"│ ".contains(*c));
                match letters.windows(3).position(|three| three == [' ', '=', ' ']) {
                    Some(at) => sign = at + 1,
                    None => {
                        further += 1;
                        assert!(begins.unwrap_or(0) > sign, "{name} at {size:?}: {row}");
                    }
                }
            }
        }
    }
    assert!(further > 5, "{further}");
}

/// Neumann's particle is never darker than its curve, whether it is behind the sphere or on its bright side, so that it is not lost
/// in its first seconds.
#[test]
fn a_particle_on_a_sphere_is_never_dimmed_by_it() {
    let mut real = Real::of("neumann");
    let mut colours = Vec::new();
    for _ in 0..12 {
        real.run(30);
        let buffer = screen(&real.app, &rich(), (80, 24));
        let cells = (2..13).flat_map(|y| (1..39).map(move |x| (x, y)));
        let bodies: Vec<Color> = cells
            .map(|at| &buffer[at])
            .filter(|cell| cell.symbol() == "●")
            .map(|cell| cell.fg)
            .collect();
        assert_eq!(bodies.len(), 1, "{:#?}", rows(&buffer));
        colours.extend(bodies);
    }
    let brightness = |colour: &Color| match colour {
        Color::Rgb(r, g, b) => u32::from(*r) + u32::from(*g) + u32::from(*b),
        other => panic!("{other:?}"),
    };
    let own = rich().theme.curve(0).fg.expect("a colour");
    assert!(colours.iter().all(|colour| brightness(colour) >= brightness(&own)), "{colours:?}");
}

/// Kovalevskaya's top is a body beside the sphere of its vertical.
#[test]
fn a_top_without_angles_is_shown_as_a_body() {
    let mut real = Real::of("kovalevskaya");
    for _ in 0..6 {
        real.run(60);
        let buffer = screen(&real.app, &rich(), (80, 24));
        let rows = rows(&buffer);
        assert!(
            rows[1].contains(" Motion ") && rows[1].contains(" Seen from the body "),
            "{rows:#?}"
        );
        let of_the_body = |at: &(u16, u16)| {
            let dotted =
                |c: char| ('\u{2801}'..='\u{28ff}').contains(&c) || ('▀'..='▟').contains(&c);
            buffer[*at].symbol().chars().all(dotted) || buffer[*at].bg != Color::Reset
        };
        let cells = (2..13).flat_map(|y| (1..39).map(move |x| (x, y)));
        assert!(cells.filter(of_the_body).count() > 30, "{rows:#?}");
    }
}

/// A drift that is seen without a power of ten is given in per cent, in the two-line and in the one-line form.
#[test]
fn a_large_drift_is_given_in_per_cent() {
    let mut app = lab("damped-pendulum", 1.0);
    let mut seen = snapshot(&app.lab.as_ref().unwrap().loaded, 1.0);
    for (drift, shown) in [(1.0, " 100 % "), (0.512, " 51 % "), (0.0099, " 9.9×10⁻³ ")] {
        seen.gauges = [Gauge { drift, ..gauge("energy", "E", 4.0, Verdict::Lost) }].into();
        app.update(AppEvent::Snapshot(Arc::new(seen.clone())));
        let text = rows(&screen(&app, &rich(), (120, 40)));
        assert!(text.iter().any(|row| row.contains(shown)), "{text:#?}");
    }
}

/// What is not conserved has a signed change since the start, whatever its terms have changed by.
#[test]
fn what_is_not_conserved_has_the_change_since_the_start() {
    let mut app = lab("damped-pendulum", 1.0);
    let mut seen = snapshot(&app.lab.as_ref().unwrap().loaded, 1.0);
    let broken = Verdict::Broken("friction".to_owned());
    for (initial, value, shown) in [
        (1.2425, 0.911, " −27 % "),
        (1.24252, 1.24184, " −0.05 % "),
        (2.0, 0.085, " −96 % "),
        (0.425, 1.115, " +162 % "),
        (-2.0, -2.1, " −5.0 % "),
        (0.0, 0.25, " +0.250 "),
        (1e-3, -0.5, " −0.501 "),
        (3.0, 3.0, " 0 "),
    ] {
        let of = gauge("energy", "E", value, broken.clone());
        seen.gauges = [Gauge { initial, reference: initial, drift: 0.43, ..of }].into();
        app.update(AppEvent::Snapshot(Arc::new(seen.clone())));
        let text = rows(&screen(&app, &rich(), (120, 40)));
        assert!(text.iter().any(|row| row.contains(shown)), "{shown} in {text:#?}");
    }
}

/// The gauge of an attitude has one name in all characters; what it measures is its reason.
#[test]
fn the_gauge_of_an_attitude_has_one_name() {
    let real = Real::of("sleeping-top");
    let gauges = &real.seen().gauges;
    let gauge = gauges.iter().find(|gauge| gauge.name == "attitude").expect("an attitude");
    assert_eq!(gauge.shown, "attitude");
    assert!(gauge.reason.starts_with("A Aᵀ = 1, det A = 1"), "{}", gauge.reason);
}

/// An attitude is not conserved: what is exact is that A stays a rotation. Its axis has the minus signs of all numbers.
#[test]
fn the_gauge_of_an_attitude_is_a_residual() {
    let mut real = Real::of("sleeping-top");
    real.run(120);
    let text = rows(&screen(&real.app, &rich(), (120, 40)));
    let row = text.iter().find(|row| row.contains("  attitude ")).expect("the gauge");
    assert!(row.contains("residual") && !row.contains("conserved"), "{row}");
    let place = real.seen().gauges.iter().position(|gauge| gauge.name == "attitude").unwrap();
    assert!(real.seen().gauges[place].reason.contains("-0."), "a component is negative");
    let lab = real.app.lab.as_mut().unwrap();
    (lab.focus.pane, lab.selection.gauge) = (Pane::Gauges, place);
    for size in [(120, 40), (160, 30)] {
        let text = rows(&screen(&real.app, &rich(), size)).join("\n");
        assert!(text.contains("turned by Φ = ") && !text.contains("-0."), "{text}");
    }
}

/// A diagram at a fixed time names the time, and a logarithm over ln 2 is one to that base.
#[test]
fn the_axis_of_a_diagram_names_its_quantity_and_time() {
    let app = begun(
        "title = \"t\"\n[coordinates]\nx = { initial = 1.0, velocity = 0.0 }\n[parameters]\n\
         n = { value = 1.0, min = 0.0, max = 3.0 }\n[definitions]\nsize = \"x^2 + 1\"\n[lagrangian]\n\
         L = \"1/2*x'^2 - 1/2*x^2\"\n[[views]]\nkind = \"diagram\"\nover = \"n\"\non = \"t - 40*2^n\"\n\
         y = \"ln(size)/ln(2)\"\n",
    );
    let text = rows(&screen(&app, &rich(), (120, 40)));
    assert!(text.iter().any(|row| row.contains("log₂ size where t = 40·2ⁿ")), "{text:#?}");
}

/// The names of the axes in the corner of a picture in space stand apart, from wherever it is seen.
#[test]
fn the_names_of_the_axes_are_not_written_over_each_other() {
    for name in ["toda", "solar-system", "charge-in-fields", "heavy-top"] {
        let mut real = Real::of(name);
        for _ in 0..6 {
            let index = real.lab().motion().unwrap();
            real.app.lab.as_mut().unwrap().focus.pane = index;
            real.press("z");
            let corner = rows(&screen(&real.app, &rich(), (80, 24)));
            let corner: Vec<String> =
                corner[15..22].iter().map(|row| row.chars().take(16).collect()).collect();
            let text = corner.join("\n");
            let letters: Vec<(usize, usize)> = corner
                .iter()
                .enumerate()
                .flat_map(|(y, row)| {
                    let is_axis = |(_, c): &(usize, char)| "xyz".contains(*c);
                    row.chars().enumerate().filter(is_axis).map(move |(x, _)| (x, y))
                })
                .collect();
            assert_eq!(letters.len(), 3, "{name}:\n{text}");
            for (k, (x, y)) in letters.iter().enumerate() {
                let apart = |other: &(usize, usize)| other.1 != *y || other.0.abs_diff(*x) > 1;
                assert!(letters[..k].iter().all(apart), "{name}:\n{text}");
            }
            real.press("z Left Left Left Up");
        }
    }
}

/// In ASCII the wrong mechanics has the same name as elsewhere.
#[test]
fn the_wrong_mechanics_has_its_name_on_every_terminal() {
    for glyphs in [Glyphs::Braille, Glyphs::Ascii] {
        let look = RenderStyle { theme: Theme::dark(ColourDepth::None), glyphs };
        let rows = rows(&screen(&lab("rolling-disc", 1.0), &look, (120, 40)));
        assert!(rows.iter().any(|row| row.contains("Time x, x (wrong)")), "{rows:#?}");
        assert!(!rows.iter().any(|row| row.contains("other_")), "{rows:#?}");
    }
}

/// A camera that follows a body keeps the same body of the wrong mechanics in the picture, or says at the edge where it is.
#[test]
fn a_camera_holds_both_of_two_mechanics() {
    for (name, right, wrong) in [
        ("rolling-disc", ["cx", "y", "cz"], ["ox", "other_y", "oz"]),
        (
            // at the ends of the handles, which nothing hides
            "knife-edge",
            ["bx + 0.6*s", "y", "bz + 0.6*c"],
            ["ox + 0.6*s", "other_y", "oz + 0.6*c"],
        ),
    ] {
        let text = std::fs::read_to_string(format!("presets/constraints/{name}.toml")).unwrap();
        let caption =
            |at: [&str; 3], text: &str| format!("  {{ caption = {at:?}, text = \"{text}\" }},\n");
        let captions = caption(right, "Q") + &caption(wrong, "W");
        let text = text.replace("shapes = [\n", &format!("shapes = [\n{captions}"));
        let mut real = Real::with(lowered(&text));
        for _ in 0..4 {
            real.run(45);
            let rows = rows(&screen(&real.app, &rich(), (120, 40)));
            let pane: String = rows[3..22].iter().flat_map(|row| row.chars().take(39)).collect();
            // what has gone farther than a camera can hold is named at the edge
            let is_held = pane.contains('W') || pane.contains("wrong: ");
            assert!(pane.contains('Q') && is_held, "{name}: {rows:#?}");
        }
    }
}

/// Neumann's sphere has light and shade.
#[test]
fn a_particle_on_a_sphere_moves_on_a_ball() {
    let buffer = screen(&lab("neumann", 1.0), &rich(), (120, 40));
    let cells = (2..22).flat_map(|y| (1..39).map(move |x| (x, y)));
    let mut tones: Vec<Color> = cells.map(|at| buffer[at].bg).collect();
    let shaded = tones.iter().filter(|tone| **tone != Color::Reset).count();
    tones.sort_by_key(|tone| format!("{tone:?}"));
    tones.dedup();
    assert!(shaded > 200 && tones.len() > 4, "{shaded} cells, {tones:?}");
}

/// The rows on which a colour is drawn in dots.
fn rows_in(buffer: &ratatui::buffer::Buffer, colour: Option<ratatui::style::Color>) -> usize {
    let dots = |c: &str| c.starts_with(|c: char| ('⠁'..='⣿').contains(&c));
    let is_drawn = |x: u16, y: u16| {
        let cell = &buffer[(x, y)];
        Some(cell.fg) == colour && dots(cell.symbol())
    };
    (3..buffer.area.height - 3).filter(|y| (8..buffer.area.width).any(|x| is_drawn(x, *y))).count()
}

/// Of two charges the mechanical momentum moves, and the canonical one is zero but for rounding: the axis they share is that of the
/// first.
#[test]
fn a_curve_that_is_zero_leaves_the_axis_to_the_one_that_moves() {
    let mut real = Real::of("darwin");
    real.run(300);
    let is_shown = |app: &phaselab::app::App| {
        app.lab.as_ref().unwrap().focused_plot().is_some_and(|(_, plot)| plot.kind.name() == "time")
    };
    while !is_shown(&real.app) {
        real.press("Tab");
    }
    real.press("z");
    let buffer = screen(&real.app, &rich(), (120, 40));
    let high = rows_in(&buffer, rich().theme.curve(0).fg);
    assert!(high >= 12, "{high} rows: {:#?}", rows(&buffer));
}

/// Bodies that stay where they are have the amber of suns, however many there are, and what moves has another colour.
#[test]
fn all_bodies_that_stay_are_amber() {
    let buffer = screen(&lab("two-centres", 1.0), &rich(), (120, 40));
    let theme = rich().theme;
    let coloured = |series: usize| -> Vec<u16> {
        let cells = (2..21).flat_map(|y| (1..39).map(move |x| (x, y)));
        let fg = theme.curve(series).fg;
        cells.filter(|at| Some(buffer[*at].fg) == fg).map(|(x, _)| x).collect()
    };
    let amber = coloured(1);
    let (left, right) = (amber.iter().min(), amber.iter().max());
    assert!(left < right && right.zip(left).is_some_and(|(r, l)| r - l > 5), "{amber:?}");
    assert!(coloured(2).is_empty(), "{:#?}", rows(&buffer));
    assert!(!coloured(0).is_empty(), "{:#?}", rows(&buffer));
}

/// Without the extra force the ellipse is closed: the angle of the Runge–Lenz vector, 10⁻¹⁵ rad by rounding, is a flat line. With it the
/// line rises.
#[test]
fn an_angle_that_is_rounding_is_flat() {
    let text = include_str!("../../../presets/gravity/precessing-orbit.toml");
    let high = |beta: &str| {
        let text = text.replace("beta = { value = 0.03", &format!("beta = {{ value = {beta}"));
        let mut real = Real::with(lowered(&text));
        let is_shown = |app: &phaselab::app::App| {
            let lab = app.lab.as_ref().unwrap();
            let physics = lab.loaded.physics();
            lab.focused_plot().is_some_and(|(_, plot)| {
                plot.kind.name() == "time" && plot.words(physics).contains("Runge")
            })
        };
        // Tab goes to what is in view, and before anything was drawn all is
        for _ in 0..30 {
            if !is_shown(&real.app) {
                real.press("Tab");
            }
        }
        assert!(is_shown(&real.app));
        real.press("z");
        real.run(400);
        let buffer = screen(&real.app, &rich(), (120, 40));
        (rows_in(&buffer, rich().theme.curve(0).fg), rows(&buffer))
    };
    let (turning, shown) = high("0.03");
    assert!(turning > 10, "{turning}: {shown:#?}");
    let (still, shown) = high("0.0");
    assert!((1..3).contains(&still), "{still}: {shown:#?}");
}
