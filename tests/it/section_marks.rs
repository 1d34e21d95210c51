//! Equilibria marked on a section: those that lie on its surface, whatever the units.

use phaselab::instrument::{Layer, MarkerShape};

use crate::laboratory::{layers, open, prepared, see, typed};

/// Two wells at y = ±a around a saddle, with x as an oscillator beside; the section is y = 0 in words of `on`. Where the
/// equilibria are that are marked, in units of a.
fn marked(a: f64, on: &str) -> Vec<f64> {
    let text = format!(
        "title = \"two wells\"\n[coordinates]\nx = {{ initial = \"0.3*a\" }}\ny = {{ initial = \"1.1*a\" }}\n\
         [parameters]\na = {a:e}\n[hamiltonian]\n\
         H = \"1/2*(p_x^2 + p_y^2) + 1/2*x^2 + (y^2 - a^2)^2/(4*a^2)\"\n\
         [[views]]\nkind = \"section\"\non = \"{on}\"\nx = \"y\"\ny = \"p_x\"\n[run]\nuntil = 100.0\n"
    );
    let (mut app, mut experiment) = open(prepared(&text));
    see(&mut app, &mut experiment, 0.5);
    typed(&mut app, "F");
    let lab = app.lab.as_ref().unwrap();
    let present = lab.present().unwrap();
    assert_eq!(present.equilibria.len(), 3, "{:?}", present.equilibria);
    let plot = lab.plots.iter().find(|plot| plot.kind.name() == "section").unwrap();
    let place = |layer: Layer| match layer {
        Layer::Point(at, MarkerShape::Ring | MarkerShape::Cross, _) => Some(at[0] / a),
        _ => None,
    };
    layers(&app, plot).into_iter().filter_map(place).collect()
}

#[test]
fn equilibria_lie_on_a_surface_or_beside_it_whatever_the_units() {
    for a in [1.0, 1e-11, 1e11] {
        let on_saddle = marked(a, "y");
        assert!(on_saddle.len() == 1 && on_saddle[0].abs() < 1e-6, "{a:e}: {on_saddle:?}");
        let on_well = marked(a, "y - a");
        assert!(on_well.len() == 1 && (on_well[0] - 1.0).abs() < 1e-6, "{a:e}: {on_well:?}");
        assert_eq!(marked(a, "y - 0.9*a"), [0.0; 0], "{a:e}");
        assert_eq!(marked(a, "x").len(), 3, "{a:e}");
    }
}
