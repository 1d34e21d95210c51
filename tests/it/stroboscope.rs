//! Points of a stroboscope as starts, also where the initial values lie at another phase of the drive.

use phaselab::app::{AppEvent, Drawn};
use phaselab::experiment::{Command, Prepared};
use phaselab::instrument::{Layer, NoStart, PlotContext, Seed};

use crate::laboratory::{layers, prepared, typed};
use crate::section::{opened, shipped};

/// A motion that begins at a point of a stroboscope passes it at the first instant, also where the initial values lie at another
/// phase: half an interval before it, as those of the standard map, or a third of a period of a drive.
#[test]
fn a_point_at_another_phase_of_a_drive_is_carried_back_to_the_start() {
    let driven = "title = \"driven\"\n[coordinates]\nx = { initial = 0.2, velocity = 0.1 }\n[lagrangian]\n\
        L = \"1/2*x'^2 - 1/4*x^4 + x*cos(2*pi*t)\"\n[[views]]\nkind = \"section\"\n\
        on = \"sin(2*pi*(t - 1/3))\"\nx = \"x\"\ny = \"x'\"\n";
    for (name, first) in
        [(Some("duffing"), None), (Some("kicked-rotor"), Some(0.5)), (None, Some(1.0 / 3.0))]
    {
        let ready = name.map_or_else(|| prepared(driven), shipped);
        let title = ready.document.stem().unwrap_or("driven").to_owned();
        let (mut app, index) = opened(ready, 0.01);
        let at = [0.3, 0.2];
        let plot = app.lab.as_ref().unwrap().plots[index].clone();
        let given = {
            let lab = app.lab.as_ref().unwrap();
            let present = &lab.present().unwrap();
            plot.kind
                .start(PlotContext { plot: &plot, present, answer: None }, at)
                .unwrap_or_else(|why| panic!("{title}: {why:?}"))
        };
        let physics = app.lab.as_ref().unwrap().loaded.physics();
        let mut ready = Prepared::of(&app.lab.as_ref().unwrap().loaded.document).unwrap();
        ready.experiment.execute(Command::Start(given));
        let axes = [plot.column(0).unwrap(), plot.column(1).unwrap()];
        if first.is_none() {
            // the start lies on the stroboscope itself
            let [x, v] = axes.map(|axis| ready.experiment.values()[axis]);
            assert_eq!([x, v], at, "{title}");
            continue;
        }
        ready.experiment.advance(3.0, u64::MAX);
        let crossings = ready.experiment.crossings();
        let row = crossings.rows(0, physics.system.channels().len()).next().unwrap();
        let time = first.unwrap_or(f64::NAN);
        assert!((row[0] - time).abs() < 1e-14, "{title}: {}", row[0]);
        for (&axis, x) in axes.iter().zip(at) {
            assert!((row[1 + axis] - x).abs() < 1e-14, "{title}: {} {x}", row[1 + axis]);
        }
        // an orbit added at the cursor passes the point, too
        typed(&mut app, "Tab Tab Tab c");
        app.update(AppEvent::Drawn(Drawn { reading: Some(at), ..Drawn::default() }));
        typed(&mut app, "n");
        let plot = app.lab.as_ref().unwrap().plots[index].clone();
        assert_eq!(plot.seeds, [Seed::Through(at)], "{title}");
        let last = layers(&app, &plot).into_iter().rev().find_map(|layer| match layer {
            Layer::Points(points, _) => Some(points),
            _ => None,
        });
        let nearest = last
            .unwrap()
            .iter()
            .map(|[x, y]| (x - at[0]).hypot(y - at[1]))
            .fold(f64::INFINITY, f64::min);
        assert!(nearest < 1e-13, "{title}: {nearest:e}");
    }
}

/// Beyond an impulse there is no way back before it has acted.
#[test]
fn a_point_is_not_carried_back_over_an_impulse() {
    let text = "title = \"kicked\"\n[coordinates]\nx = { initial = 0.2, momentum = 0.1 }\n[hamiltonian]\n\
        H = \"1/2*p_x^2\"\n[[impulses]]\nname = \"kick\"\nevery = 1\nchange = { p_x = \"sin(x)\" }\n[[views]]\n\
        kind = \"section\"\non = \"t - 1.5\"\nx = \"x\"\ny = \"p_x\"\n";
    let (app, index) = opened(prepared(text), 0.01);
    let lab = app.lab.as_ref().unwrap();
    let (plot, present) = (&lab.plots[index], &lab.present().unwrap());
    let refused = plot.kind.start(PlotContext { plot, present, answer: None }, [0.3, 0.2]);
    let Err(NoStart::Refused(why)) = refused else { panic!("{refused:?}") };
    assert_eq!(
        why,
        "The motion begins at t = 0, the picture shows t = 1.5, and over an impulse between them no point can be carried back."
    );
}
