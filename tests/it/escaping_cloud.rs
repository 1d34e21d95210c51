//! Clouds of which a part escapes: the window follows the bulk, and the rest is counted.

use phaselab::instrument::{Across, Seed};

use crate::ensemble::{cloud, measure, opened, see};
use crate::section::prepared;

/// V = q²/2 − q³/3 has a saddle at q = 1, E = 1/6, beyond which motions come to infinity in a finite time.
const WELL: &str = "title = \"a well\"\n[coordinates]\nq = { initial = 0.0, momentum = 0.2 }\n[hamiltonian]\n\
    H = \"1/2*p_q^2 + 1/2*q^2 - 1/3*q^3\"\n[run]\nuntil = 100.0\n";

#[test]
fn the_window_follows_the_bulk_and_says_how_many_are_outside() {
    // p²/2 = 1/6 at p = 0.577: a part of the first box has more
    for (momenta, escapes) in [([0.2, 0.62], true), ([0.1, 0.3], false)] {
        let (mut app, _, mut experiment) = opened(prepared(WELL));
        app.lab.as_mut().unwrap().plots[0].seeds = vec![Seed::Spread([[-0.1, 0.1], momenta])];
        see(&mut app, &mut experiment, 0.02);
        assert_eq!(measure(&app, "outside"), Some(0.0));
        let energy = |[q, p]: &[f64; 2]| p * p / 2.0 + q * q / 2.0 - q * q * q / 3.0;
        let bound = cloud(&app).iter().filter(|at| energy(at) < 1.0 / 6.0).count();
        assert_eq!(bound < 2000, escapes, "{bound}");
        let mut time = 0.0;
        while time < 6.0 {
            time += 1.0;
            see(&mut app, &mut experiment, time);
        }
        let lab = app.lab.as_ref().unwrap();
        let (plot, present) = (&lab.plots[0], lab.present().unwrap());
        let Across::Channel(_, Some([lo, hi])) = plot.kind.across(plot, &present, lab.answer(plot))
        else {
            panic!("no range")
        };
        // the well lies between −½ and 1; what leaves it is at q = 100 and more within a time of 5
        assert!(lo > -0.8 && hi < 6.0 && hi - lo > 0.3, "{lo} {hi}");
        let outside = measure(&app, "outside").unwrap();
        let far = cloud(&app).iter().filter(|[q, _]| !(-0.6..=1.0).contains(q)).count() as f64;
        assert_eq!(far > 0.0, escapes, "{far}");
        assert!(outside <= far && (outside > 0.8 * far), "{outside} {far}");
        // who has more energy than the saddle leaves, the others stay
        assert!(far <= (2000 - bound) as f64, "{far} {bound}");
    }
}
