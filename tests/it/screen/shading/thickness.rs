//! From what size on a body is painted, and that a disc which turns is a whole.

use phaselab::view::colour::Rgb;
use ratatui::buffer::{Buffer, Cell};
use ratatui::style::Color;

use super::super::{rich, rows, screen};
use super::{in_space, seen_from};

/// A cylinder that is seen two columns wide in both directions, or as a disc of any size, is painted up to an edge of blocks, and
/// what is thinner is dots: each with a body just below and just above.
#[test]
fn two_columns_are_thick() {
    let is_braille =
        |cell: &Cell| cell.symbol().chars().any(|c| ('\u{2801}'..='\u{28ff}').contains(&c));
    let is_line = |cell: &Cell| is_braille(cell) && cell.bg == Color::Reset;
    let is_block = |cell: &Cell| cell.symbol().chars().any(|c| ('▀'..='▟').contains(&c));
    // the ends of the line are ten apart, and the body is above it
    let floor = "{ line = [\"-5\", \"0\", \"-2\"], to = [\"5\", \"0\", \"-2\"] }";
    let picture = |body: &str| screen(&in_space(&format!("{floor}{body}")), &rich(), (200, 60));
    let count = |buffer: &Buffer, rows: std::ops::Range<u16>, counts: &dyn Fn(&Cell) -> bool| {
        let cells = rows.flat_map(|y| (1..73).map(move |x| &buffer[(x, y)]));
        cells.filter(|cell| counts(cell)).count()
    };
    let buffer = picture("");
    let floor = (1..30).max_by_key(|&y| count(&buffer, y..y + 1, &is_braille)).expect("rows");
    let column = 10.0 / count(&buffer, floor..floor + 1, &is_braille) as f64;
    for (length, wide, style) in [
        (20.0, 1.9, "dots"),
        (20.0, 2.1, "solid"),
        (1.9, 20.0, "solid"),
        (2.1, 20.0, "solid"),
        (1.6, 1.9, "dots"),
        (1.0, 2.1, "solid"),
        (1.6, 2.1, "solid"),
    ] {
        let (half, radius) = (length / 2.0 * column, wide / 2.0 * column);
        let ends = format!("[\"0\", \"0\", \"{}\"], to = [\"0\", \"0\", \"{half}\"]", -half);
        let buffer = picture(&format!(", {{ cylinder = {ends}, radius = \"{radius}\" }}"));
        let painted = count(&buffer, 2..30, &|cell| Rgb::of(cell.bg).is_some() || is_block(cell));
        let drawn = match (painted, count(&buffer, 2..floor, &is_line)) {
            (0, _) => "dots",
            (_, 0) => "solid",
            (_, _) => "both",
        };
        assert_eq!(drawn, style, "{length} × {wide} columns: {}", rows(&buffer).join("\n"));
    }
}

/// A disc that turns is a whole from its upper end to its lower one: blocks or, where it is narrower than two dots, a line.
#[test]
fn a_disc_is_blocks_and_from_its_edge_a_line() {
    let is_braille =
        |cell: &Cell| cell.symbol().chars().any(|c| ('\u{2801}'..='\u{28ff}').contains(&c));
    let is_dots = |cell: &&Cell| is_braille(cell) && cell.bg == Color::Reset;
    let is_block = |cell: &&Cell| {
        Rgb::of(cell.bg).is_some() || cell.symbol().chars().any(|c| ('▀'..='▟').contains(&c))
    };
    let mut lines = 0;
    // turned towards the eye, and tilted about the line of sight
    let attitudes = (0..180).step_by(2).map(|turn| (0, turn));
    let tilts = (0..180).step_by(9).flat_map(|tilt| [(tilt, 0), (tilt, 2), (tilt, 6)]);
    for (tilt, turn) in attitudes.chain(tilts) {
        let [(sin, cos), (across, up)] = [turn, tilt].map(|x| f64::from(x).to_radians().sin_cos());
        let normal = format!("[\"{}\", \"{sin}\", \"{}\"]", cos * up, cos * across);
        let disc = format!(
            "{{ disc = [\"0\", \"0\", \"0\"], radius = \"1\", normal = {normal} }}, \
             {{ line = [\"0\", \"0\", \"-2\"], to = [\"0\", \"0\", \"-3\"] }}"
        );
        let buffer = screen(&seen_from(0, &disc), &rich(), (120, 40));
        let cells: Vec<_> = (2..14).flat_map(|y| (3..39).map(move |x| (x, y))).collect();
        let of = |counts: &dyn Fn(&&Cell) -> bool| -> Vec<(u16, u16)> {
            cells.iter().copied().filter(|at| counts(&&buffer[*at])).collect()
        };
        let (dots, blocks) = (of(&is_dots), of(&is_block));
        let text = format!("{tilt} {turn}: {}", rows(&buffer).join("\n"));
        assert!(dots.is_empty() || blocks.is_empty(), "{text}");
        let all = [dots, blocks.clone()].concat();
        let extent = |at: &dyn Fn(&(u16, u16)) -> u16| {
            let ends = all.iter().map(at).min().zip(all.iter().map(at).max());
            ends.map_or(0, |(low, high)| high - low + 1)
        };
        assert!(extent(&|at| at.0).max(2 * extent(&|at| at.1)) >= 16, "{text}");
        // each cell is reached from the first one
        let (mut reached, mut left) = (vec![all[0]], all[1..].to_vec());
        while let Some(at) = reached.pop() {
            let near = |b: &(u16, u16)| at.0.abs_diff(b.0) <= 1 && at.1.abs_diff(b.1) <= 1;
            reached.extend(left.iter().copied().filter(near));
            left.retain(|b| !near(b));
        }
        assert!(left.is_empty(), "{text}");
        lines += usize::from(blocks.is_empty());
    }
    assert!((20..=50).contains(&lines), "{lines}");
}
