//! What fits into a pane: tabs that differ, names and units that are whole, rows that are not left empty.

use std::sync::Arc;

use phaselab::app::{App, AppEvent, Guide, GuideKind, LessonTaken, Pane};
use phaselab::experiment::{Growth, Snapshot, Verdict};
use phaselab::instrument::Sight;
use phaselab::num::rounded;

use super::{find, rich, rows, screen};
use crate::app::real::Real;
use crate::experiment::shipped;
use crate::fixtures::{catalog, gauge, lab, loaded, press, snapshot};
use crate::nonempty;

/// The tabs in the titles of the left panes.
fn tabs(rows: &[String]) -> Vec<Vec<String>> {
    let titles =
        rows.iter().flat_map(|row| row.split('╭')).filter_map(|part| part.strip_prefix("─ "));
    let titles = titles.filter_map(|part| part.split(" ─").next());
    let named = titles.map(|title| {
        let tabs = title.split(" │ ").map(|tab| tab.split("  ").next().unwrap_or(tab).trim());
        tabs.map(str::to_owned).collect::<Vec<_>>()
    });
    named.filter(|tabs| tabs.len() > 1).collect()
}

#[test]
fn tabs_of_a_frame_differ() {
    for (name, two) in [
        ("duffing", ["Phase x, x′", "Phase x, p_x"]),
        ("driven-damped-pendulum", ["Phase θ, θ′", "Time θ′"]),
    ] {
        let rows = rows(&screen(&lab(name, 1.0), &rich(), (120, 40)));
        let tabs = tabs(&rows);
        assert_eq!(tabs.len(), 1, "{name}: {rows:#?}");
        for (place, tab) in tabs[0].iter().enumerate() {
            assert!(!tabs[0][..place].contains(tab), "{name}: {tabs:?}");
        }
        for tab in two {
            assert!(tabs[0].iter().any(|other| other == tab), "{name}: {tab} in {tabs:?}");
        }
    }
}

/// What a parameter of a shipped file means is read as a whole in 80 columns, below the panes or in its list.
#[test]
fn meanings_of_parameters_are_whole() {
    let mut cut = Vec::new();
    let mut read = 0;
    for entry in nonempty(catalog().entries()) {
        let (mut app, _) = App::new(catalog(), Some(&entry.name));
        app.update(AppEvent::Loaded(Ok(loaded(&entry.name, 1))));
        let count = app.lab.as_ref().map_or(0, |lab| lab.loaded.model.parameters.len());
        for _ in 0..count {
            let rows = rows(&screen(&app, &rich(), (80, 24)));
            // the list has the left half below the pictures
            let list = rows[14..22].iter().map(|row| row.chars().take(40).collect::<String>());
            let cells = list.chain(rows.last().cloned());
            cut.extend(cells.filter(|row| row.contains('…')).map(|row| (&entry.name, row)));
            read += 1;
            press(&mut app, "Down");
        }
    }
    assert!(cut.is_empty() && read > 300, "{read}: {cut:#?}");
}

/// A gauge whose reason is long leaves its verdict and its name to the list.
#[test]
fn reasons_of_gauges_are_whole() {
    for (name, least) in [("solar-system", 8), ("heavy-top", 3), ("kicked-rotor", 3), ("planet", 3)]
    {
        let mut app = lab(name, 1.0);
        let lab = app.lab.as_mut().expect("a lab");
        lab.focus.pane = Pane::Gauges;
        let mut seen = (**lab.snapshot.as_ref().expect("a snapshot")).clone();
        seen.gauges = shipped(name).snapshot().gauges;
        let gauges = seen.gauges.len();
        assert!(gauges >= least, "{name}: {gauges}");
        app.update(AppEvent::Snapshot(Arc::new(seen)));
        for _ in 0..gauges {
            let rows = rows(&screen(&app, &rich(), (80, 24)));
            let last = rows.last().expect("a row");
            assert!(last.contains("? help") && !last.contains('…'), "{name}: {last}");
            press(&mut app, "Down");
        }
    }
}

/// The names of gauges are those that were once torn, some of them of shipped presets.
#[test]
fn names_of_gauges_end_with_a_word() {
    let mut app = lab("pendulum", 1.0);
    let lab = app.lab.as_ref().expect("a lab");
    let mut seen = (**lab.snapshot.as_ref().expect("a snapshot")).clone();
    let names = [
        "least spin that sleeps",
        "A Aᵀ = 1, det A = 1",
        "areal velocity seen from above",
        "centre of mass at the start along x",
        "centre of mass at the start along y",
        "E",
        "p_x",
        "p_y",
        "p_z",
    ];
    let named = |name: &&str| gauge(name, name, 1.0, Verdict::Exact(Growth::Level));
    seen.gauges = names.iter().map(named).collect::<Vec<_>>().into();
    app.update(AppEvent::Snapshot(Arc::new(seen)));
    let text = super::screen_text(&app, (120, 40));
    for shown in ["least spin that sleeps", "A Aᵀ = 1, det A = 1", "areal velocity seen…"] {
        assert!(text.contains(&format!("  {shown} ")), "{shown}: {text}");
    }
    for end in ["… along x ", "… along y "] {
        assert!(text.contains("  centre") && text.contains(end), "{end}: {text}");
    }
}

#[test]
fn a_unit_is_whole_though_its_bar_is_shorter() {
    for size in [(80, 24), (120, 40)] {
        let text = rows(&screen(&lab("solar-system", 1.0), &rich(), size));
        let row = text.iter().find(|row| row.contains("au³/(M☉ yr²)"));
        assert!(row.is_some_and(|row| row.contains('●')), "{text:#?}");
    }
}

/// While the law of motion is clipped the gauges have no row to spare: a heading and two rows for each in a frame.
#[test]
fn rows_to_spare_are_those_of_the_law() {
    for name in ["harmonic-oscillator", "pendulum", "planet"] {
        let app = lab(name, 1.0);
        let gauges = app.lab.as_ref().and_then(|lab| Some(lab.snapshot.as_ref()?.gauges.len()));
        let buffer = screen(&app, &rich(), (120, 40));
        let at = |title: &str| find(&buffer, title).unwrap_or_else(|| panic!("{name}: {title}")).1;
        let (from, to) = (at("Gauges"), at("Law of motion"));
        let height = usize::from(to - from);
        // and more only where a reason has a row below its gauge
        assert!(height >= 2 * gauges.expect("gauges") + 3, "{name}: {:#?}", rows(&buffer));
        let inside = (from + 1..to - 1).map(|y| (84..118).map(move |x| (x, y)));
        for mut row in inside {
            assert!(row.any(|at| buffer[at].symbol() != " "), "{name}: {:#?}", rows(&buffer));
        }
        assert!(rows(&buffer).iter().any(|row| row.contains(" ↓ ─")), "{name} is clipped");
    }
}

#[test]
fn numbers_have_two_columns_where_they_are_wide() {
    let mut app = lab("planet", 1.0);
    press(&mut app, "4");
    let at = |size, heading: &str| {
        let buffer = screen(&app, &rich(), size);
        find(&buffer, heading).unwrap_or_else(|| panic!("{heading}: {:#?}", rows(&buffer)))
    };
    let [state, gauges] = ["State", "Gauges"].map(|heading| at((200, 60), heading));
    assert!(state.0 < 20 && gauges.0 > 90, "{state:?} {gauges:?}");
    let [state, gauges] = ["State", "Gauges"].map(|heading| at((120, 60), heading));
    assert_eq!(state.0, gauges.0);
}

/// The room in which a pendulum may swing is there before it has moved: the picture does not jump when the motion begins.
#[test]
fn a_pendulum_that_has_not_moved_yet_has_room_to_swing() {
    let buffer = screen(&lab("pendulum", 0.0), &rich(), (120, 40));
    let dots = |c: &str| c.starts_with(|c: char| ('⠁'..='⣿').contains(&c) || c == '●');
    let drawn: Vec<u16> =
        (1..38).filter(|x| (2..20).any(|y| dots(buffer[(*x, y)].symbol()))).collect();
    let wide = drawn.last().unwrap() - drawn.first().unwrap() + 1;
    assert!((8..=22).contains(&wide), "{wide} columns of 38: {:#?}", rows(&buffer));
}

/// Wherever a file has a view of the motion, one is on the screen when it opens, and what is brought to the front is shown
/// all the same.
#[test]
fn the_motion_is_seen_wherever_there_is_a_view_of_it() {
    let mut unseen = Vec::new();
    for entry in catalog().entries() {
        let (mut app, _) = App::new(catalog(), Some(&entry.name));
        app.update(AppEvent::Loaded(Ok(loaded(&entry.name, 1))));
        let shown = |app: &App, size: (u16, u16)| {
            let (_, drawn) = super::drawn(app, &rich(), size);
            drawn.panes.expect("the lab").in_view
        };
        let motions: Vec<usize> = {
            let lab = app.lab.as_ref().unwrap();
            (0..lab.plots.len()).filter(|index| lab.shows_motion(&lab.plots[*index])).collect()
        };
        for size in [(80, 24), (120, 40), (200, 60)] {
            let plots = shown(&app, size);
            if !motions.is_empty() && !motions.iter().any(|index| plots.has(Pane::Plot(*index))) {
                unseen.push(format!("{} at {size:?}", entry.name));
            }
        }
        let last = app.lab.as_ref().unwrap().plots.len() - 1;
        app.lab.as_mut().unwrap().focus.bring_to_front(last);
        assert!(shown(&app, (80, 24)).has(Pane::Plot(last)), "{}", entry.name);
    }
    assert!(unseen.is_empty(), "{unseen:#?}");
}

/// A body on the far side of a sphere is seen through it, from wherever one looks.
#[test]
fn a_body_is_seen_through_its_sphere() {
    let mut app = lab("smooth-sphere", 1.0);
    for turn in 0..8 {
        let lab = app.lab.as_mut().unwrap();
        let Sight::Camera(eye) = &mut lab.plots[0].sight else { panic!("no scene") };
        // From below: the particle is near the top.
        eye.pitch = -1.0;
        eye.yaw = std::f64::consts::TAU * f64::from(turn) / 8.0;
        let rows = rows(&screen(&app, &rich(), (80, 24)));
        let motion: String = rows[2..13].iter().flat_map(|row| row.chars().take(39)).collect();
        assert_eq!(motion.matches('●').count(), 1, "{turn}: {rows:#?}");
    }
}

/// A scene fills its pane in one direction: its cones and rims are where they are drawn, also where their places depend on
/// parameters, and nothing is kept free for where they never come.
#[test]
fn tops_fill_their_pane() {
    for name in ["heavy-top", "heavy-top-body", "sleeping-top"] {
        let mut real = Real::of(name);
        real.run(360);
        let rows = rows(&screen(&real.app, &rich(), (80, 24)));
        let pane: Vec<Vec<char>> =
            rows[2..12].iter().map(|row| row.chars().skip(1).take(37).collect()).collect();
        let inked = |c: &char| {
            ('\u{2801}'..='\u{28ff}').contains(c) || ('▀'..='▟').contains(c) || *c == '●'
        };
        let high = pane.iter().filter(|row| row.iter().any(inked)).count();
        let wide = (0..37).filter(|x| pane.iter().any(|row| inked(&row[*x]))).count();
        assert!(high >= 9 || wide >= 33, "{name}, {high} rows, {wide} columns: {rows:#?}");
    }
}

/// A step is told to two digits: what changes all the time beyond them is no use.
#[test]
fn a_step_has_two_digits_whatever_its_size() {
    assert_eq!(
        [17_476.3, 0.012_345, 99.6, -0.0].map(|h| rounded(h, 2)),
        [17_000.0, 0.012, 100.0, 0.0]
    );
    for name in ["falling-body", "pendulum", "free-particle"] {
        let mut real = Real::of(name);
        real.run(120);
        let rows = rows(&screen(&real.app, &rich(), (120, 40)));
        let (_, step) = rows[38].split_once(" step ").expect("a step");
        let step = step.split_whitespace().next().unwrap();
        let digits = step.split('×').next().unwrap().replace('.', "");
        assert!(digits.trim_matches('0').len() <= 2, "{name}: {step}");
    }
}

/// Before the first step there is none to be told of.
#[test]
fn no_step_is_not_a_step_of_zero() {
    let loaded = loaded("pendulum", 1);
    let mut seen = snapshot(&loaded, 1.0);
    seen.method.step = 0.0;
    let mut app = lab("pendulum", 1.0);
    app.update(AppEvent::Snapshot(Arc::new(seen)));
    let rows = rows(&screen(&app, &rich(), (120, 40)));
    assert!(rows[38].contains(" step – "), "{}", rows[38]);
}

/// One quantity has one name on the axes and in the list of gauges.
#[test]
fn an_axis_is_named_as_its_quantity() {
    let mut real = Real::of("mixed-types");
    real.run(60);
    let shown = rows(&screen(&real.app, &rich(), (120, 40))).concat();
    assert!(shown.contains("P₁") && shown.contains("P₂"), "{shown}");
    assert!(!["P1", "P2", "F1,"].iter().any(|name| shown.contains(name)), "{shown}");
}

/// What stands above the systems in the list is in sight when it opens, however few rows there are.
#[test]
fn the_list_of_systems_begins_with_its_first_rows() {
    let (mut app, _) = App::new(catalog(), None);
    app.picker.guides = vec![Guide {
        kind: GuideKind::Demo,
        name: "tour".to_owned(),
        title: "The pendulum".to_owned(),
        system: "Simple pendulum".to_owned(),
    }];
    for size in [(40, 10), (60, 15), (80, 24), (120, 40)] {
        let text = super::screen_text(&app, size);
        assert!(text.contains("Lessons and demos"), "{text}");
        assert!(text.contains('›'), "{text}");
    }
}

/// Where a list says what its selected value means, the footer leaves the room to the keys.
#[test]
fn the_meaning_of_a_value_does_not_push_the_keys_out() {
    let app = lab("planet", 1.0);
    let drawn = rows(&screen(&app, &rich(), (80, 24)));
    let (footer, above) = drawn.split_last().unwrap();
    assert!(above.join(" ").contains("mass of the planet"), "{drawn:#?}");
    assert!(!footer.contains("mass of the planet") && footer.contains("\\ tabs"), "{footer}");
    assert!(footer.contains("0.1 to 10"), "{footer}");
}

/// A note of a list that has no room loses what is said behind its first words, rather than half a word.
#[test]
fn a_note_without_room_loses_its_last_part() {
    let guide = |kind, name: &str, title: &str, system: &str| Guide {
        kind,
        name: name.to_owned(),
        title: title.to_owned(),
        system: system.to_owned(),
    };
    let mut app = lab("pendulum", 1.0);
    app.picker.guides = vec![
        guide(
            GuideKind::Lesson(LessonTaken::NotYet),
            "a",
            "The hoop that rolls and the block that slides",
            "Hoop, disc and ball",
        ),
        guide(GuideKind::Demo, "b", "The bouncing ball", "Bouncing ball"),
    ];
    press(&mut app, "F2");
    for size in [(80, 24), (120, 40)] {
        let text = rows(&screen(&app, &rich(), size));
        for (title, note) in
            [("The hoop that rolls", "lesson "), ("The bouncing", "demo: Bouncing ball ")]
        {
            let row = text.iter().find(|row| row.contains(title)).expect("a row");
            assert!(row.contains(note) && !row.contains('…'), "{row}");
        }
    }
}

/// On a wide screen the notes stand in two columns.
#[test]
fn notes_use_the_width_of_the_screen() {
    let mut app = lab("double-pendulum", 1.0);
    press(&mut app, "3");
    let rows = rows(&screen(&app, &rich(), (200, 60)));
    let right = rows.iter().filter(|row| row.chars().skip(110).take(80).any(char::is_alphabetic));
    assert!(right.count() > 8, "{rows:#?}");
}

/// Whatever is typed, the last line says how to leave.
#[test]
fn every_field_says_how_to_leave_it() {
    for keys in ["Enter", "a", "g"] {
        let mut app = lab("pendulum", 1.0);
        press(&mut app, keys);
        assert!(app.overlay.is_some(), "{keys}");
        for size in [(80, 24), (120, 40)] {
            let last = rows(&screen(&app, &rich(), size)).pop().expect("a footer");
            assert!(last.contains("Esc cancel"), "{keys} at {size:?}: {last}");
        }
    }
}

/// The law of motion is on the first screen of every shipped system, at a standard size with its first row and how much more
/// there is, which a click shows.
#[test]
fn the_law_is_on_the_first_screen() {
    let mut missing = Vec::new();
    for entry in nonempty(catalog().entries()) {
        let app = lab(&entry.name, 1.0);
        for size in [(80, 24), (120, 40)] {
            let rows = rows(&screen(&app, &rich(), size));
            let of_law = |row: &&String| {
                let row = row.trim_end_matches(['│', ' ']);
                let row = row.rsplit('│').next().unwrap_or(row).trim_start();
                ["L = ", "H = "].iter().any(|begin| row.starts_with(begin))
            };
            let more = |row: &String| size.0 >= 110 || row.contains(" ↓");
            if !rows.iter().any(|row| of_law(&row) && more(row)) {
                missing.push((entry.name.clone(), size, rows));
            }
        }
    }
    let names: Vec<_> = missing.iter().map(|(name, size, _)| (name, size)).collect();
    assert!(missing.is_empty(), "{names:?} {:#?}", missing[0].2);
}

/// At 120 columns and more the reason of every gauge is read in full, beside its name or below it, and its verdict too where
/// the names leave room.
#[test]
fn reasons_are_in_full_where_there_is_room() {
    let mut seen = 0;
    for name in ["pendulum", "planet", "heavy-top", "damped-pendulum", "atwood", "two-centres"] {
        let mut app = lab(name, 1.0);
        let gauges = shipped(name).snapshot().gauges;
        let lab = app.lab.as_ref().expect("a lab");
        let taken = (**lab.snapshot.as_ref().expect("a snapshot")).clone();
        app.update(AppEvent::Snapshot(Arc::new(Snapshot { gauges: gauges.clone(), ..taken })));
        for size in [(120, 40), (200, 60)] {
            // five gauges, six parameters and six initial values leave no rows for reasons
            if (name, size.0) == ("heavy-top", 120) {
                continue;
            }
            let text = rows(&screen(&app, &rich(), size));
            let column: Vec<String> = text
                .iter()
                .map(|row| {
                    row.chars()
                        .skip(size.0 as usize - LISTS_COLUMN[usize::from(size.0 == 200)])
                        .collect()
                })
                .collect();
            let words = column.join(" ").replace(['│', '╭', '╰', '─', '╮', '╯'], " ");
            let words = words.split_whitespace().collect::<Vec<_>>().join(" ");
            for gauge in gauges.iter() {
                let reason = gauge.reason.replace('-', "−");
                let reason = reason.split_whitespace().collect::<Vec<_>>().join(" ");
                assert!(
                    words.contains(&reason),
                    "{name} {size:?} {}: {reason} in {words}",
                    gauge.name
                );
                seen += 1;
            }
        }
    }
    assert!(seen > 20, "{seen}");
}

/// The columns of the lists at 120 and at 200.
const LISTS_COLUMN: [usize; 2] = [40, 52];
