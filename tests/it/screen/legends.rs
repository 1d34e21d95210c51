//! What names curves, arrows and motions: all in one place, and told apart without colours; pictures from several frames of
//! reference, whose lengths compare.

use phaselab::view::RenderStyle;
use phaselab::view::colour::ColourDepth;
use phaselab::view::glyphs::Glyphs;
use phaselab::view::theme::Theme;

use super::{rich, rows, screen};
use crate::app::real::Real;
use crate::fixtures::{begun, lab, lowered};

/// Three curves are named in the frame or above the axes, and never some here and some there.
#[test]
fn the_names_of_all_curves_stand_in_one_line() {
    let app = begun(
        "title = \"t\"\n[coordinates]\nx = { initial = 1.0, velocity = 0.0 }\n[lagrangian]\n\
         L = \"1/2*x'^2 - 1/2*x^2\"\n[[observables]]\nname = \"first quantity\"\nexpression = \"x\"\n\
         [[observables]]\nname = \"second quantity\"\nexpression = \"2*x\"\n[[observables]]\n\
         name = \"third quantity\"\nexpression = \"3*x\"\n[[views]]\nkind = \"time\"\n\
         y = [\"x\", \"2*x\", \"3*x\"]\n",
    );
    let keys = ["━ second quantity", "━ third quantity"];
    let mut places = Vec::new();
    for width in (60..200).step_by(5) {
        let text = rows(&screen(&app, &rich(), (width, 40)));
        let has = |row: &String| keys.iter().filter(|key| row.contains(**key)).count();
        // above the axes they may take two rows
        let (title, below) = (has(&text[1]), text[2..4].iter().map(has).sum::<usize>());
        assert!(matches!((title, below), (2, 0) | (0, 2)), "{width}: {:#?}", &text[..4]);
        places.push(title > 0);
    }
    assert!(places.contains(&false), "{places:?}");
}

/// Without colours, signs of a legend are all alike: the names stand at what they name.
#[test]
fn names_stand_at_the_arrows_where_there_are_no_colours() {
    for glyphs in [Glyphs::Braille, Glyphs::Ascii] {
        let look = RenderStyle { theme: Theme::dark(ColourDepth::None), glyphs };
        let text = rows(&screen(&lab("merry-go-round", 2.0), &look, (120, 40)));
        for force in ["centrifugal", "Coriolis"] {
            let with = |row: &&String| row.contains(force) && !row.contains("force");
            assert_eq!(text.iter().filter(with).count(), 1, "{force}: {text:#?}");
        }
        let together = |row: &String| row.contains("centrifugal") && row.contains("> Coriolis");
        assert!(!text.iter().any(together), "{text:#?}");
        let mut disc = Real::of("rolling-disc");
        disc.run(30);
        let text = rows(&screen(&disc.app, &look, (120, 40)));
        let scene = text[2..20].iter().map(|row| row.chars().take(40).collect::<String>());
        let scene = scene.collect::<Vec<_>>().join("\n");
        assert!(!scene.contains("right mechanics"), "{scene}");
        for motion in ["right", "wrong"] {
            assert!(scene.contains(motion), "{motion}: {scene}");
        }
    }
}

/// A particle that flies off sweeps a spiral in a frame that turns; after a turn it is where it is seen to be from the ground. The
/// circle about the middle has the same size in both pictures.
#[test]
fn pictures_from_two_frames_of_reference_have_one_scale() {
    let mut real = Real::with(lowered(
        "title = \"t\"\n[coordinates]\nx = { initial = 1.0, velocity = 0.5 }\n\
         y = { initial = 0.0, velocity = 0.0 }\n[lagrangian]\nL = \"1/2*(x'^2 + y'^2)\"\n\
         [[frames]]\nname = \"turning\"\naxis = [\"0\", \"0\", \"1\"]\nangle = \"t\"\n\
         [[views]]\nkind = \"space\"\n[[views]]\nkind = \"space\"\nframe = \"turning\"\n[space]\n\
         shapes = [{ circle = [\"0\", \"0\", \"0\"], radius = \"1\" }, { mass = [\"x\", \"y\", \"0\"] }]\n",
    ));
    real.run(377);
    let buffer = screen(&real.app, &rich(), (120, 40));
    let top: Vec<u16> = (0..120).filter(|&x| buffer[(x, 1)].symbol() == "╭").collect();
    let height = |pane: usize| {
        let columns = top[pane] + 1..top[pane + 1] - 1;
        let is_dotted = |y: &u16| {
            columns.clone().any(|x| {
                let symbol = buffer[(x, *y)].symbol();
                symbol.chars().all(|c| ('\u{2801}'..='\u{28ff}').contains(&c))
            })
        };
        let end = (2..40).find(|&y| buffer[(top[pane], y)].symbol() == "╰").expect("a frame");
        (2..end).filter(is_dotted).count()
    };
    let [ground, turning] = [height(0), height(1)];
    assert!(ground > 3 && ground.abs_diff(turning) <= 1, "{ground} {turning} {:#?}", rows(&buffer));
}
