//! Names that are too long for their place: what tells one from another stays.

use std::sync::Arc;

use phaselab::app::AppEvent;
use phaselab::experiment::{Gauge, Growth, Verdict};
use phaselab::view::RenderStyle;
use phaselab::view::colour::ColourDepth;
use phaselab::view::glyphs::Glyphs;
use phaselab::view::theme::Theme;

use super::{find, rich, rows, screen};
use crate::app::real::Real;
use crate::fixtures::{at_picker, gauge, in_lab, lab, press, snapshot};

/// Keys of curves whose names begin with the same words end with those that differ.
#[test]
fn keys_that_begin_alike_are_told_apart() {
    for (name, keys, size) in [
        ("two-centres", ["━ angular momentum about the left sun", "━ …right sun"], (120, 40)),
        ("oscillator-hamilton-jacobi", ["━ β to the right", "━ …left"], (80, 24)),
    ] {
        let buffer = screen(&lab(name, 1.0), &rich(), size);
        for (index, key) in keys.into_iter().enumerate() {
            let (x, y) =
                find(&buffer, key).unwrap_or_else(|| panic!("{key}: {:#?}", rows(&buffer)));
            assert_eq!(Some(buffer[(x, y)].fg), rich().theme.curve(index).fg, "{name}: {key}");
        }
    }
}

/// Keys above the axes are whole where a curve ends to the right of them, in their row.
#[test]
fn a_curve_in_their_row_leaves_the_keys_whole() {
    let look = RenderStyle { theme: Theme::dark(ColourDepth::True), glyphs: Glyphs::Ascii };
    let mut real = Real::of("rolling-disc");
    let mut beside = 0;
    for _ in 0..100 {
        real.run(3);
        let text = rows(&screen(&real.app, &look, (120, 40)));
        let title =
            text.iter().position(|row| row.contains("- Time x, x (wrong)")).expect("a title");
        let row = &text[title + 1];
        assert!(row.contains("- x ") && row.contains("- x (wrong)"), "{text:#?}");
        let after = row.split_once("- x (wrong)").map_or("", |(_, after)| after);
        beside += usize::from(after[..after.find('|').unwrap_or(0)].contains('@'));
    }
    assert!(beside > 0, "no curve ends in the row of the keys");
}

/// The gauges of the pendulum with these on a screen.
fn with_gauges(gauges: Vec<Gauge>, size: (u16, u16)) -> Vec<String> {
    let mut app = in_lab();
    let mut seen = snapshot(&app.lab.as_ref().unwrap().loaded, 2.0);
    seen.gauges = gauges.into();
    app.update(AppEvent::Snapshot(Arc::new(seen)));
    rows(&screen(&app, &rich(), size))
}

/// A row of a low list has the whole of each verdict, and no value is covered by it.
#[test]
fn another_branch_is_called_so_in_a_single_row() {
    let exact = || Verdict::Exact(Growth::Level);
    let gauges = vec![
        gauge("energy", "E", 2.5, exact()),
        gauge("alpha", "α", 2.5, exact()),
        gauge("beta", "β_α", -1.26, Verdict::OtherBranch),
        gauge("gamma", "γ", 2.5, exact()),
    ];
    for size in [(80, 24), (120, 40)] {
        let text = with_gauges(gauges.clone(), size);
        let row =
            text.iter().find(|row| row.contains("β_α")).unwrap_or_else(|| panic!("{text:#?}"));
        assert!(row.contains("other branch"), "{text:#?}");
        assert!(text.iter().any(|row| row.contains("−1.26")), "{text:#?}");
    }
}

/// What is below the last digit of the terms of a quantity is zero. What only seems small is not.
#[test]
fn a_value_below_the_digits_of_its_terms_is_zero() {
    let small = |name: &str, value| Gauge {
        scale: 8.0,
        ..gauge(name, name, value, Verdict::Exact(Growth::Level))
    };
    let gauges = vec![small("zero", -8e-31), small("tiny", -8e-12)];
    for size in [(80, 24), (120, 40)] {
        let text = with_gauges(gauges.clone(), size).join("\n");
        assert!(!text.contains("10⁻³¹") && text.contains("10⁻¹²"), "{text}");
    }
    let mut app = in_lab();
    let mut seen = snapshot(&app.lab.as_ref().unwrap().loaded, 2.0);
    seen.gauges = gauges.into();
    app.update(AppEvent::Snapshot(Arc::new(seen)));
    press(&mut app, "4");
    let text = rows(&screen(&app, &rich(), (120, 60))).join("\n");
    assert!(!text.contains("10⁻³¹") && text.contains("10⁻¹²"), "{text}");
}

/// Where the preview leaves room the list of systems has it.
#[test]
fn whole_titles_are_listed_where_there_is_room() {
    let mut app = at_picker();
    press(&mut app, "/ d i p o l e");
    for width in [110, 120, 200] {
        let text = rows(&screen(&app, &rich(), (width, 40)));
        for title in
            ["Charge in the field of an electric dipole", "Charge in the field of a magnetic"]
        {
            let listed = text.iter().filter(|row| row.contains(title)).count();
            assert!(listed > 0, "{width}: {text:#?}");
        }
        assert!(!text.iter().any(|row| row.contains("dipole…")), "{text:#?}");
    }
}

/// The numbers of a page end in one column, however long the names are.
#[test]
fn numbers_stand_in_one_column() {
    let mut app = lab("two-centres", 1.0);
    press(&mut app, "4");
    let text = rows(&screen(&app, &rich(), (120, 60)));
    let ends = |name: &str| {
        let row = text.iter().find(|row| row.starts_with(&format!("│   {name} ")));
        let row: Vec<char> = row.unwrap_or_else(|| panic!("{name}: {text:#?}")).chars().collect();
        let blank = (name.chars().count() + 5..row.len()).find(|&i| row[i] != ' ');
        let number = blank.unwrap_or_else(|| panic!("{name}: {text:#?}"));
        (number..row.len()).find(|&i| row[i] == ' ').unwrap_or(row.len())
    };
    let all = ["x", "p_x", "angular momentum about the left sun", "Euler's integral"].map(ends);
    assert!(all.windows(2).all(|pair| pair[0] == pair[1]), "{all:?} {text:#?}");
}
