//! Themes: legible, distinguishable, and colourless if requested.

use phaselab::view::colour::{ColourDepth, Rgb};
use phaselab::view::theme::{CURVES, Dash, PALETTES, Palette, Role, Shade, Theme};
use ratatui::style::{Color, Style};

use crate::nonempty;

const COLOURFUL: [ColourDepth; 3] = [ColourDepth::Ansi16, ColourDepth::Ansi256, ColourDepth::True];

/// Every style a theme can give.
fn styles(theme: &Theme) -> Vec<Style> {
    let shades = |shades: &[Shade]| shades.iter().map(|shade| shade.style).collect::<Vec<_>>();
    let mut all: Vec<Style> = Role::ALL.iter().map(|role| theme[*role]).collect();
    all.extend((0..CURVES).map(|series| theme.curve(series)));
    all.extend((0..CURVES).flat_map(|series| shades(theme.trail(series))));
    all.extend((0..CURVES).map(|series| theme.series(series).style));
    all.extend(shades(theme.density()));
    all
}

/// The background of a palette: its own, or plain black or white if it uses the terminal's sixteen colours.
fn background(palette: &Palette, depth: ColourDepth) -> Rgb {
    match depth {
        ColourDepth::Ansi16 if palette.background.luminance() > 0.5 => Rgb(255, 255, 255),
        ColourDepth::Ansi16 => Rgb(0, 0, 0),
        _ => palette.background,
    }
}

/// Whether a role is used for text, which needs a contrast of 4.5 to 1; lines need 3 to 1.
fn is_text(role: Role) -> bool {
    !matches!(role, Role::Border | Role::Level)
}

/// The foreground of a style; the terminal's default is assumed to be the palette's.
fn colour(palette: &Palette, style: Style) -> Rgb {
    style.fg.and_then(Rgb::of).unwrap_or(palette.foreground)
}

#[test]
fn text_has_the_contrast_to_be_read() {
    for palette in &PALETTES {
        for depth in COLOURFUL {
            let theme = Theme::new(palette, depth);
            let ground = background(palette, depth);
            for role in Role::ALL {
                let contrast = colour(palette, theme[role]).contrast(ground);
                let least = if is_text(role) { 4.5 } else { 3.0 };
                assert!(contrast >= least, "{} {depth:?} {role:?}: {contrast:.2}", palette.name);
            }
            // Legends are written in the colours of their curves.
            for series in (0..CURVES).filter(|_| theme.depth() != ColourDepth::Ansi16) {
                let contrast = colour(palette, theme.curve(series)).contrast(ground);
                assert!(
                    contrast >= 4.5,
                    "{} {depth:?} curve {series}: {contrast:.2}",
                    palette.name
                );
            }
        }
    }
}

#[test]
fn the_dark_theme_is_legible_on_white() {
    for depth in [ColourDepth::Ansi256, ColourDepth::True] {
        let theme = Theme::dark(depth);
        for role in Role::ALL {
            // The terminal's own foreground suits its own background.
            let Some(rgb) = theme[role].fg.and_then(Rgb::of) else { continue };
            let contrast = rgb.contrast(Rgb(255, 255, 255));
            assert!(contrast >= 2.3, "{depth:?} {role:?}: {contrast:.2}");
        }
    }
}

#[test]
fn series_are_told_apart() {
    for palette in &PALETTES {
        for depth in [ColourDepth::Ansi256, ColourDepth::True] {
            let theme = Theme::new(palette, depth);
            if theme.depth() != depth {
                continue;
            }
            for (a, b) in (0..CURVES).flat_map(|a| (0..a).map(move |b| (a, b))) {
                let [x, y] = [a, b].map(|series| colour(palette, theme.curve(series)));
                let distance = x.distance(y);
                assert!(distance > 0.08, "{} {depth:?} {a} and {b}: {distance:.3}", palette.name);
            }
        }
        let dark = Theme::dark(ColourDepth::Ansi16);
        let mut sixteen: Vec<_> = (0..CURVES).map(|s| format!("{:?}", dark.curve(s).fg)).collect();
        sixteen.sort();
        sixteen.dedup();
        assert_eq!(sixteen.len(), CURVES);
    }
}

#[test]
fn ramps_only_grow_stronger() {
    for palette in &PALETTES {
        for depth in COLOURFUL {
            let theme = Theme::new(palette, depth);
            let ground = palette.background;
            let trails = (0..CURVES).map(|series| theme.trail(series));
            for ramp in trails.chain([theme.density()]) {
                let contrast: Vec<f64> =
                    ramp.iter().map(|s| colour(palette, s.style).contrast(ground)).collect();
                assert!(contrast.is_sorted(), "{} {depth:?}: {contrast:?}", palette.name);
                assert!(contrast[0] > 1.3, "the oldest step is still seen: {contrast:?}");
                assert!(ramp.iter().all(|shade| shade.coverage == 1.0));
            }
        }
    }
}

/// What is old, far away or sparse is faint, and still a line on the page.
#[test]
fn what_fades_stays_legible() {
    for palette in &PALETTES {
        let theme = Theme::new(palette, ColourDepth::True);
        if theme.depth() != ColourDepth::True {
            continue;
        }
        let lines = (0..CURVES).map(|series| theme.curve(series)).chain([theme[Role::Level]]);
        let far = lines.map(|style| theme.receding(style, 1.0));
        let old = (0..CURVES).map(|series| theme.trail(series)[0].style);
        for style in nonempty(far.chain(old).chain([theme.density()[0].style])) {
            let contrast = colour(palette, style).contrast(palette.background);
            assert!(contrast >= 3.0, "{} {style:?}: {contrast:.2}", palette.name);
        }
        let bold = theme.receding(theme[Role::Text], 1.0);
        assert!(colour(palette, bold).contrast(palette.background) < 8.0, "it is far away");
    }
}

#[test]
fn true_colour_ramps_are_smooth_and_of_rising_luminance() {
    let theme = Theme::dark(ColourDepth::True).with_ages(16);
    for series in 0..CURVES {
        let ramp: Vec<Rgb> = theme
            .trail(series)
            .iter()
            .map(|shade| Rgb::of(shade.style.fg.unwrap()).unwrap())
            .collect();
        assert_eq!(ramp.len(), 16);
        for pair in ramp.windows(2) {
            assert!(pair[0].luminance() < pair[1].luminance());
            assert!(pair[0].distance(pair[1]) < 0.08, "{pair:?}");
        }
    }
}

#[test]
fn a_depth_is_never_exceeded() {
    for palette in &PALETTES {
        for depth in COLOURFUL {
            let theme = Theme::new(palette, depth);
            for colour in nonempty(styles(&theme).into_iter().filter_map(|style| style.fg)) {
                let fits = match depth.min(palette.most) {
                    ColourDepth::True => matches!(colour, Color::Rgb(..) | Color::Reset),
                    ColourDepth::Ansi256 => matches!(colour, Color::Indexed(16..) | Color::Reset),
                    _ => !matches!(colour, Color::Rgb(..) | Color::Indexed(_)),
                };
                assert!(fits, "{} {depth:?} has {colour:?}", palette.name);
            }
        }
    }
}

#[test]
fn without_colour_there_is_none_and_weights_tell_roles_apart() {
    for palette in &PALETTES {
        let theme = Theme::new(palette, ColourDepth::None);
        for style in styles(&theme) {
            assert_eq!((style.fg, style.bg), (None, None));
        }
        let different = |roles: &[Role]| {
            for (i, a) in roles.iter().enumerate() {
                for b in &roles[..i] {
                    assert_ne!(theme[*a], theme[*b], "{a:?} {b:?}");
                }
            }
        };
        different(&[Role::Text, Role::Dim, Role::Accent, Role::Title, Role::Selected]);
        different(&[Role::Good, Role::Warn, Role::Bad]);
        different(&[Role::Border, Role::Focus]);
        different(&[Role::Level, Role::Separatrix]);
        let coverage: Vec<_> = theme.trail(0).iter().map(|shade| shade.coverage).collect();
        assert!(coverage.is_sorted() && coverage[0] < 0.5 && coverage[7] == 1.0);
        assert!(theme.line(Role::Level).coverage < theme.line(Role::Separatrix).coverage);
        assert_ne!(theme.series(0), theme.series(1));
    }
}

/// Simulated colours for people who lack one kind of cones, from sRGB in linear light.
/// Source: F. Viénot, H. Brettel and J. D. Mollon, "Digital video colourmaps for checking the legibility of displays by
/// dichromats", Color Res. Appl. 24 (1999) 243.
const DICHROMATS: [[[f64; 3]; 3]; 2] = [
    [[0.11238, 0.88762, 0.0], [0.11238, 0.88762, 0.0], [0.00401, -0.00401, 1.0]],
    [[0.29275, 0.70725, 0.0], [0.29275, 0.70725, 0.0], [-0.02234, 0.02234, 1.0]],
];

fn seen_by(matrix: &[[f64; 3]; 3], colour: Rgb) -> Rgb {
    let linear = [colour.0, colour.1, colour.2].map(|c| (f64::from(c) / 255.0).powf(2.2));
    let [r, g, b] = matrix.map(|row| {
        let light: f64 = row.iter().zip(linear).map(|(a, c)| a * c).sum();
        (255.0 * light.clamp(0.0, 1.0).powf(1.0 / 2.2)).round() as u8
    });
    Rgb(r, g, b)
}

#[test]
fn the_theme_for_the_colour_blind_is_distinguishable_by_them() {
    for depth in [ColourDepth::Ansi256, ColourDepth::True] {
        let theme = Theme::named("colour-blind", depth).unwrap();
        let verdicts = [Role::Good, Role::Warn, Role::Bad].map(|role| theme[role]).to_vec();
        let curves: Vec<Style> = (0..CURVES).map(|series| theme.curve(series)).collect();
        for (styles, least) in [(verdicts, 0.1), (curves, 0.05)] {
            for matrix in &DICHROMATS {
                for (a, b) in (0..styles.len()).flat_map(|a| (0..a).map(move |b| (a, b))) {
                    let [x, y] =
                        [a, b].map(|i| seen_by(matrix, colour(theme.palette(), styles[i])));
                    assert!(x.distance(y) > least, "{depth:?} {a} {b}: {:.3}", x.distance(y));
                }
            }
        }
    }
}

#[test]
fn high_contrast_is_high() {
    for depth in COLOURFUL {
        let theme = Theme::named("contrast", depth).unwrap();
        for role in Role::ALL {
            let contrast = colour(theme.palette(), theme[role]).contrast(Rgb(0, 0, 0));
            // The terminal defines its own sixteen colours.
            let strong = is_text(role) && depth != ColourDepth::Ansi16;
            assert!(contrast >= if strong { 7.0 } else { 4.5 }, "{role:?} {contrast:.2}");
        }
    }
}

#[test]
fn the_terminals_own_colours_stay_its_own() {
    let theme = Theme::named("terminal", ColourDepth::True).unwrap();
    assert_eq!(theme.depth(), ColourDepth::Ansi16);
    let dark = theme.renamed("dark").unwrap();
    assert_eq!(dark.depth(), ColourDepth::True, "another theme has all colours again");
}

#[test]
fn without_colour_every_line_of_a_plot_has_a_pattern_of_its_own() {
    let theme = Theme::dark(ColourDepth::None);
    let drawn = |series: usize| -> Vec<bool> {
        (0..400).map(|place| theme.series(series).dash.covers(place)).collect()
    };
    for (a, b) in (0..CURVES).flat_map(|a| (0..a).map(move |b| (a, b))) {
        let apart = drawn(a).iter().zip(drawn(b)).filter(|(x, y)| **x != *y).count();
        assert!(apart > 20, "{a} and {b} differ in {apart} dots of 400");
        assert_ne!(theme.series(a).dash.sample(), theme.series(b).dash.sample());
    }
    let coloured = Theme::dark(ColourDepth::Ansi16);
    assert!((0..CURVES).all(|s| (0..99).all(|place| coloured.series(s).dash.covers(place))));
}

#[test]
fn themes_are_found_by_name() {
    for palette in &PALETTES {
        let theme = Theme::named(palette.name, ColourDepth::True).unwrap();
        assert_eq!(theme.palette().name, palette.name);
        assert!(!palette.about.is_empty());
    }
    assert!(Theme::named("no such theme", ColourDepth::True).is_none());
}

#[test]
fn colour_arithmetic_agrees_with_its_sources() {
    // WCAG: black on white is 21 to 1, and #767676 the lightest grey with 4.5.
    let white = Rgb(255, 255, 255);
    assert!((Rgb(0, 0, 0).contrast(white) - 21.0).abs() < 1e-12);
    assert!(Rgb(0x76, 0x76, 0x76).contrast(white) > 4.5);
    assert!(Rgb(0x77, 0x77, 0x77).contrast(white) < 4.5);
    // Ottosson: the distance of black and white is the whole lightness.
    assert!((Rgb(0, 0, 0).distance(white) - 1.0).abs() < 1e-6);
    // Every entry of the cube and of the greys is nearest to its own colour.
    for index in 16..=255 {
        let rgb = Rgb::of_index(index);
        assert_eq!(Rgb::of_index(rgb.nearest256()), rgb);
    }
    assert_eq!(Rgb(200, 10, 60).mix(white, 0.0), Rgb(200, 10, 60));
    assert_eq!(Rgb(200, 10, 60).mix(white, 1.0), white);
}

/// Where the seven colours are used up a line has the next pattern.
#[test]
fn more_curves_than_colours_differ_by_their_dashes() {
    let themes = PALETTES.iter().flat_map(|p| COLOURFUL.map(|depth| Theme::new(p, depth)));
    for theme in nonempty(themes.filter(|theme| theme.depth() != ColourDepth::None)) {
        for series in 0..CURVES {
            let [first, second, third] = [0, 1, 2].map(|n| theme.series(series + n * CURVES));
            assert_eq!((first.style, first.style), (second.style, third.style));
            assert_eq!(first.dash, Dash::Full, "{} {series}", theme.palette().name);
            assert!(first.dash != second.dash && second.dash != third.dash);
            assert_ne!(first.dash, third.dash);
        }
    }
}
