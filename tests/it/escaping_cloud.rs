//! Clouds of which a part escapes: the window follows the bulk, and the rest is counted.

use phaselab::instrument::{Across, Seed};

use crate::ensemble::{cloud, measure, opened};
use crate::laboratory::{prepared, see};

/// A well of depth 1, which motions with p² > 2 at its middle leave for ever.
const WELL: &str = "title = \"a well\"\n[coordinates]\nq = { initial = 0.0, momentum = 0.2 }\n[hamiltonian]\n\
    H = \"1/2*p_q^2 - exp(-1/2*q^2)\"\n[run]\nuntil = 100.0\n";

#[test]
fn the_window_follows_the_bulk_and_says_how_many_are_outside() {
    for (momenta, escapes) in [([0.1, 1.8], true), ([0.1, 1.0], false)] {
        let (mut app, _, mut experiment) = opened(prepared(WELL));
        app.lab.as_mut().unwrap().plots[0].seeds = vec![Seed::Spread([[-0.1, 0.1], momenta])];
        see(&mut app, &mut experiment, 0.02);
        assert_eq!(measure(&app, "outside"), Some(0.0));
        for time in [5.0, 10.0, 15.0, 20.0] {
            see(&mut app, &mut experiment, time);
        }
        let points = cloud(&app);
        let free = |[q, p]: &&[f64; 2]| p * p / 2.0 > (-q * q / 2.0).exp();
        let free = points.iter().filter(free).count() as f64;
        assert_eq!(free > 300.0, escapes, "{free}");
        let lab = app.lab.as_ref().unwrap();
        let (plot, present) = (&lab.plots[0], lab.present().unwrap());
        let Across::Channel(_, Some([lo, hi])) = plot.kind.across(lab.context(plot, &present))
        else {
            panic!("no range")
        };
        // the fastest are at q = 1.1 · 20 and more
        let farthest = points.iter().map(|at| at[0]).fold(0.0, f64::max);
        assert_eq!(farthest > 18.0, escapes, "{farthest}");
        assert!(lo > -6.0 && hi < 12.0, "{lo} {hi}");
        let outside = measure(&app, "outside").unwrap();
        assert!(outside <= free && outside >= 0.5 * free, "{outside} {free}");
    }
}

/// A centre that attracts with the force 1/r².
const CENTRE: &str = "title = \"a centre\"\n[coordinates]\nx = { initial = 1.0, momentum = 0.0 }\n\
    y = { initial = 0.0, momentum = 1.0 }\n[hamiltonian]\n\
    H = \"1/2*(p_x^2 + p_y^2) - 1/sqrt(x^2 + y^2)\"\n[run]\nuntil = 100.0\n";

/// Points that turn around the centre some hundred times a second would hold up all others.
#[test]
fn points_that_take_too_many_steps_are_given_up_and_counted() {
    let (mut app, _, mut experiment) = opened(prepared(CENTRE));
    app.lab.as_mut().unwrap().plots[0].seeds = vec![Seed::Spread([[1e-3, 1.0], [-0.1, 0.1]])];
    see(&mut app, &mut experiment, 0.02);
    for time in [1.0, 2.0, 3.0] {
        see(&mut app, &mut experiment, time);
    }
    let lost = measure(&app, "lost").unwrap();
    // of an orbit that begins at r with the momentum 1 the period is 2π (r/2)^{3/2}: of r < 0.02, 6 ms and less
    assert!(lost > 30.0 && lost < 400.0, "{lost}");
    assert!(measure(&app, "outside").unwrap() >= lost);
    assert_eq!(measure(&app, "points"), Some(2000.0 - lost));
}
