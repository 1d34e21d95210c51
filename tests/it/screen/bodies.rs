//! Small bodies: what is left of a wheel that is seen from its edge, and of masses where dots are blocks.

use phaselab::view::RenderStyle;
use phaselab::view::colour::ColourDepth;
use phaselab::view::glyphs::Glyphs;
use phaselab::view::theme::Theme;

use super::{rows, screen};
use crate::fixtures::{begun, lab};

/// A wheel about the vertical with four spokes or none, seen from a height in degrees.
fn wheel(elevation: f64, spokes: bool) -> String {
    let ends = [["0.7", "0.7"], ["-0.7", "0.7"], ["-0.7", "-0.7"], ["0.7", "-0.7"]];
    let line = |[x, y]: [&str; 2]| {
        format!("{{ line = [\"0\", \"0\", \"0\"], to = [\"{x}\", \"{y}\", \"0\"] }},\n")
    };
    let spokes: String = ends.into_iter().filter(|_| spokes).map(line).collect();
    format!(
        "title = 'a wheel'\n[coordinates]\nx = {{ initial = 0.0 }}\n[lagrangian]\nL = \"1/2*x'^2\"\n\
         [[views]]\nkind = 'space'\n[space]\nazimuth = 0\nelevation = {elevation:?}\nshapes = [\n\
         {{ circle = [\"0\", \"0\", \"0\"], radius = \"1\" }},\n{spokes}]\n"
    )
}

#[test]
fn a_wheel_seen_from_its_edge_has_no_spokes() {
    for glyphs in [Glyphs::Braille, Glyphs::HalfBlock, Glyphs::Ascii] {
        let look = RenderStyle { theme: Theme::dark(ColourDepth::None), glyphs };
        let picture = |elevation: f64, spokes: bool| {
            rows(&screen(&begun(&wheel(elevation, spokes)), &look, (120, 40)))
        };
        assert_eq!(picture(2.0, true), picture(2.0, false), "{glyphs:?}");
        assert_ne!(picture(60.0, true), picture(60.0, false), "{glyphs:?}");
    }
}

/// Among blocks a marker is smaller than what surrounds it.
#[test]
fn where_dots_are_blocks_a_mass_is_made_of_them() {
    let app = lab("two-centres", 1.0);
    for (glyphs, markers) in [(Glyphs::Braille, 3), (Glyphs::HalfBlock, 0)] {
        let look = RenderStyle { theme: Theme::dark(ColourDepth::True), glyphs };
        let rows = rows(&screen(&app, &look, (120, 40)));
        let pane: String = rows[2..22].iter().flat_map(|row| row.chars().take(39)).collect();
        assert!(rows[1].contains("Motion"), "{rows:#?}");
        assert_eq!(pane.matches('●').count(), markers, "{glyphs:?} {rows:#?}");
    }
}
