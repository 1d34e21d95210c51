//! Casts as GIFs, decoded again.

use gif::{ColorOutput, DecodeOptions};
use phaselab::record::{RecordedCast, animation};

/// A GIF as a viewer shows it.
struct Shown {
    size: (usize, usize),
    /// Each picture as it looks, and its delay in centiseconds.
    pictures: Vec<(Vec<[u8; 3]>, u16)>,
    /// The pixels of each picture in the file.
    drawn: Vec<usize>,
}

impl Shown {
    fn pixel(&self, picture: usize, (x, y): (usize, usize)) -> [u8; 3] {
        self.pictures[picture].0[y * self.size.0 + x]
    }

    fn length(&self) -> u64 {
        self.pictures.iter().map(|(_, delay)| u64::from(*delay)).sum()
    }
}

fn cast(events: &str) -> RecordedCast {
    let head = r##"{"version":2,"width":4,"height":2,"theme":{"fg":"#ffffff","bg":"#000000"}}"##;
    RecordedCast::read(&format!("{head}\n{events}")).expect("a cast")
}

fn written(cast: &RecordedCast, cell_width: u16) -> Vec<u8> {
    animation::write(cast, cell_width, Vec::new()).expect("a GIF")
}

fn shown(bytes: &[u8]) -> Shown {
    let mut options = DecodeOptions::new();
    options.set_color_output(ColorOutput::Indexed);
    let mut decoder = options.read_info(bytes).expect("a GIF");
    let palette = decoder.global_palette().expect("a palette").to_vec();
    let size = (usize::from(decoder.width()), usize::from(decoder.height()));
    let mut canvas = vec![[0; 3]; size.0 * size.1];
    let (mut pictures, mut drawn) = (Vec::new(), Vec::new());
    while let Some(frame) = decoder.read_next_frame().expect("a picture") {
        let (left, top) = (usize::from(frame.left), usize::from(frame.top));
        for (place, index) in frame.buffer.iter().enumerate() {
            if frame.transparent != Some(*index) {
                let (x, y) = (place % usize::from(frame.width), place / usize::from(frame.width));
                let colour = &palette[3 * usize::from(*index)..][..3];
                canvas[(top + y) * size.0 + left + x].copy_from_slice(colour);
            }
        }
        pictures.push((canvas.clone(), frame.delay));
        drawn.push(frame.buffer.len());
    }
    Shown { size, pictures, drawn }
}

#[test]
fn a_dot_is_where_it_must_be() {
    let two =
        cast("[0, \"o\", \"\u{2801}\"]\n[1, \"o\", \"\\u001b[31m\u{2880}\"]\n[3, \"o\", \"\"]");
    let shown = shown(&written(&two, 8));
    assert_eq!((shown.size, shown.pictures.len()), ((32, 32), 2));
    let (white, black, red) = ([255; 3], [0; 3], [0xc8, 0x4f, 0x4f]);
    // upper left of the first cell, then lower right of the second
    assert_eq!(shown.pixel(0, (1, 1)), white);
    assert_eq!(shown.pixel(0, (6, 1)), black);
    assert_eq!(shown.pixel(0, (13, 13)), black);
    assert_eq!((shown.pixel(1, (1, 1)), shown.pixel(1, (13, 13))), (white, red));
    assert_eq!(shown.pixel(1, (9, 1)), black);
    // the second picture holds one cell
    assert_eq!(shown.drawn, [32 * 32, 8 * 16]);
    assert_eq!((shown.pictures[0].1, shown.pictures[1].1), (100, 200));
}

#[test]
fn frames_and_blocks_join() {
    let lines = cast("[0, \"o\", \"──│\\u001b[2;1H▄█│\"]\n[1, \"o\", \"\"]");
    for width in [5, 8, 10, 13] {
        let shown = shown(&written(&lines, width));
        let w = usize::from(width);
        let white = |x: usize, y: usize| shown.pixel(0, (x, y)) == [255; 3];
        assert!((0..2 * w).all(|x| white(x, w - 1) || white(x, w)), "{width}");
        assert!((0..4 * w).all(|y| white(2 * w + w / 2, y) || white(2 * w + (w - 1) / 2, y)));
        assert!((0..2 * w).all(|x| (3 * w..4 * w).all(|y| white(x, y))), "{width}");
        assert!((0..w).all(|x| (2 * w..3 * w).all(|y| !white(x, y))), "{width}");
    }
}

#[test]
fn delays_add_up_to_the_length_of_the_cast() {
    let output =
        |n: u32, every: f64| format!("[{}, \"o\", \"\\u001b[H{n:04}\"]\n", f64::from(n) * every);
    for (every, count) in [(1.0 / 30.0, 91), (0.004, 251), (0.05, 21), (0.333, 10)] {
        let events: String = (0..count).map(|n| output(n, every)).collect();
        let cast = cast(&events);
        let shown = shown(&written(&cast, 4));
        assert_eq!(shown.length(), (cast.end + 5_000) / 10_000, "every {every} s");
        let all = shown.pictures.iter().all(|(_, delay)| *delay >= 2);
        assert!(all && shown.pictures.len() > 5, "every {every} s");
        // the end is the end
        let last = cast_of_one(&format!("{:04}", count - 1));
        assert_eq!(shown.pictures.last().map(|(pixels, _)| pixels), Some(&last), "every {every} s");
    }
    // a delay has sixteen bits, and a picture that changes nothing is not written
    let long = cast("[0, \"o\", \"a\"]\n[500, \"o\", \"\\u001b[Ha\"]\n[1000, \"o\", \"\"]");
    let shown = shown(&written(&long, 4));
    assert_eq!((shown.length(), shown.pictures.len()), (100_000, 2));
}

fn cast_of_one(text: &str) -> Vec<[u8; 3]> {
    let mut shown = shown(&written(&cast(&format!("[0, \"o\", \"{text}\"]\n[1, \"o\", \"\"]")), 4));
    shown.pictures.remove(0).0
}

#[test]
fn more_colours_than_a_palette_has_become_the_nearest() {
    let cell =
        |n: u32| format!("\\u001b[48;2;{};{};{}m ", n % 8 * 36, n / 8 % 8 * 36, n / 64 % 8 * 36);
    let head = r#"{"version":2,"width":32,"height":16}"#;
    let cells: String = (0..512).map(cell).collect();
    let cast = RecordedCast::read(&format!("{head}\n[0, \"o\", \"{cells}\"]\n[1, \"o\", \"\"]"));
    let shown = shown(&written(&cast.expect("a cast"), 4));
    let mut worst = 0;
    for n in 0..512_usize {
        let wanted = [n % 8, n / 8 % 8, n / 64 % 8].map(|part| part as i32 * 36);
        let found = shown.pixel(0, (n % 32 * 4 + 1, n / 32 * 8 + 1));
        for (found, wanted) in found.iter().zip(wanted) {
            worst = worst.max((i32::from(*found) - wanted).abs());
        }
    }
    assert!((1..=144).contains(&worst), "{worst}");
}

#[test]
fn the_same_cast_is_the_same_picture() {
    let text: String = ('!'..='~').map(|c| if matches!(c, '"' | '\\') { ' ' } else { c }).collect();
    let cast = cast(&format!("[0, \"o\", \"{text}\"]\n[1, \"o\", \"θ″ ½\"]\n[2, \"o\", \"\"]"));
    assert_eq!(written(&cast, 10), written(&cast, 10));
    assert_ne!(written(&cast, 10), written(&cast, 9));
}

#[test]
fn what_is_too_large_is_refused() {
    let head = r#"{"version":2,"width":1000,"height":500}"#;
    let cast = RecordedCast::read(&format!("{head}\n[0, \"o\", \"a\"]")).expect("a cast");
    let error = animation::write(&cast, 40, Vec::new()).expect_err("40000 by 40000 pixels");
    assert!(error.to_string().contains("40000×40000"), "{error}");
}

/// A wide character that the font lacks has a sign in its place, which is not blank.
#[test]
fn a_wide_character_is_no_blank() {
    let wide = cast_of_one("\u{632f}x");
    assert_eq!(wide, cast_of_one("? x"));
    assert_ne!(wide, cast_of_one("  x"));
}

/// A combining sign has no cell of its own, so what follows stays in its column.
#[test]
fn combining_signs_shift_nothing() {
    assert_eq!(cast_of_one("q\u{307}bcd"), cast_of_one("qbcd"));
}

/// Octants are exact shapes: octant 3 is the second row at the left, where braille has a dot.
#[test]
fn octants_are_drawn() {
    let octant = cast_of_one("\u{1cd00}");
    let at = |x: usize, y: usize| octant[y * 16 + x];
    assert_eq!((at(0, 2), at(1, 3)), ([255; 3], [255; 3]));
    assert_eq!((at(0, 1), at(2, 2), at(0, 4)), ([0; 3], [0; 3], [0; 3]));
}
