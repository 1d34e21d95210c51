//! Families of periodic orbits in the lab: held against the closed form of the pendulum's amplitude, and the published
//! bifurcations of the straight orbit of Hénon and Heiles.

use phaselab::app::App;
use phaselab::experiment::Prepared;
use phaselab::instrument::{Layer, Physics, Plot, PlotTable, named};

use crate::laboratory::{self, first, open, prepared, see};

/// The lab with the family that is offered with these words.
fn opened(text: &str, label: &str) -> App {
    let (mut app, mut experiment) = open(prepared(text));
    let lab = app.lab.as_mut().unwrap();
    let kind = named("family").unwrap();
    let offers = kind.offers(lab.loaded.physics());
    let known: Vec<String> = offers.iter().map(|offer| offer.label.clone()).collect();
    let found = offers.into_iter().find(|offer| offer.label == label);
    let offer = found.unwrap_or_else(|| panic!("{label} is not among {known:?}"));
    let mut plot = Plot::new(kind, (offer.columns, None), &lab.loaded.model);
    plot.over = offer.over;
    lab.plots = vec![plot];
    see(&mut app, &mut experiment, 0.01);
    app
}

fn table(app: &App) -> PlotTable {
    let lab = app.lab.as_ref().unwrap();
    let plot = &lab.plots[0];
    let table = plot.kind.table(lab.context(plot, &lab.present().unwrap()));
    table.unwrap_or_else(|| panic!("{:?}", legend(app)))
}

fn measure(app: &App, word: &str) -> Option<f64> {
    laboratory::measured(app, first(app), word)
}

fn layers(app: &App) -> Vec<Layer> {
    laboratory::layers(app, first(app))
}

fn legend(app: &App) -> String {
    laboratory::legend(app, first(app))
}

/// E = −cos of the amplitude, and T = 2π/agm(1, cos of half of it).
#[test]
fn a_pendulum_has_its_amplitudes_and_periods() {
    let text = "title = \"one\"\n[coordinates]\nq = { initial = 1.2, velocity = 0.0 }\n[lagrangian]\n\
                L = \"1/2*q'^2 + cos(q)\"\n[run]\nuntil = 100.0\n";
    let app = opened(text, "family of orbits: q over E");
    let table = table(&app);
    assert_eq!(table.columns, ["energy", "greatest q", "period", "trace"]);
    assert!(table.rows.len() > 30, "{}", table.rows.len());
    for row in &table.rows {
        let amplitude = (-row[0]).acos();
        assert!((row[1] - amplitude).abs() < 1e-7, "{row:?} {amplitude}");
        let (mut a, mut b) = (1.0_f64, (amplitude / 2.0).cos());
        for _ in 0..8 {
            (a, b) = (0.5 * (a + b), (a * b).sqrt());
        }
        let period = std::f64::consts::TAU / a;
        assert!((row[2] / period - 1.0).abs() < 1e-9, "{row:?} {period}");
    }
    assert_eq!(measure(&app, "folds"), Some(0.0));
    assert_eq!(measure(&app, "doublings"), Some(0.0));
}

/// The orbit along an axis of symmetry: the isochronous bifurcation at 0.969309 of the energy of the saddles, 1/6 (M. Brack,
/// Foundations of Physics 31 (2001) 209), and stable below it.
#[test]
fn the_straight_orbit_of_henon_and_heiles_branches_where_it_is_published() {
    let text = "title = \"A\"\n[coordinates]\nx = { initial = 0.0, momentum = 0.0 }\ny = { initial = 0.0, momentum = 0.565 }\n\
                [hamiltonian]\nH = \"1/2*(p_x^2 + p_y^2 + x^2 + y^2) + x^2*y - 1/3*y^3\"\n[run]\nuntil = 100.0\n";
    let app = opened(text, "family of orbits: y over E");
    let published = 0.969_309 / 6.0;
    let first = measure(&app, "first").unwrap_or_else(|| panic!("{}", legend(&app)));
    assert!((first - published).abs() < 1e-6, "{first} {published}\n{}", legend(&app));
    assert!(measure(&app, "branchings").unwrap() >= 1.0, "{}", legend(&app));
    assert!(legend(&app).contains("branching at E = 0.16155"), "{}", legend(&app));
    // its name stands at its place in the picture
    let named = layers(&app).into_iter().any(|layer| match layer {
        Layer::Name(at, name) => name == "branching" && (at[0] - published).abs() < 1e-6,
        _ => false,
    });
    assert!(named);
    // E = ½ y² − ⅓ y³ at its farther end
    for row in table(&app).rows {
        let ends = row[1] * row[1] * (0.5 - row[1] / 3.0);
        assert!((ends - row[0]).abs() < 1e-7, "{row:?} {ends}");
    }
}

/// At the same energy the amplitude q is that of ½ k q² + ¼ q⁴ = E.
#[test]
fn over_a_parameter_the_energy_stays() {
    let text = "title = \"one\"\n[coordinates]\nq = { initial = 0.5, velocity = 0.0 }\n[parameters]\n\
                k = { value = 2.0, min = 1.0, max = 3.0 }\n[lagrangian]\nL = \"1/2*q'^2 - 1/2*k*q^2 - 1/4*q^4\"\n\
                [run]\nuntil = 100.0\n";
    let app = opened(text, "family of orbits: q over k");
    let table = table(&app);
    assert_eq!(table.columns, ["k", "greatest q", "period", "energy", "trace"]);
    let energy = 0.25 + 0.5_f64.powi(4) / 4.0;
    assert!(table.rows.len() > 30, "{}", table.rows.len());
    for row in &table.rows {
        assert!((row[3] - energy).abs() < 1e-9, "{row:?}");
        let square = -row[0] + (row[0] * row[0] + 4.0 * energy).sqrt();
        assert!((row[1] - square.sqrt()).abs() < 1e-7, "{row:?}");
    }
}

/// A file may ask for a family over the energy, and for no other.
#[test]
fn a_file_has_families_over_the_energy() {
    let text = |x: &str| {
        format!(
            "title = \"one\"\n[coordinates]\nq = {{ initial = 0.0, velocity = 1.0 }}\n[lagrangian]\nL = \"1/2*q'^2\"\n\
             [[views]]\nkind = \"family\"\nx = \"{x}\"\ny = \"q\"\n[run]\nuntil = 100.0\n"
        )
    };
    let reported = |x: &str| {
        let mut app = opened(&text(x), "family of orbits: q over E");
        let lab = app.lab.as_mut().unwrap();
        let views = Plot::opening(lab.loaded.physics());
        lab.plots = views.into_iter().filter(|plot| plot.kind.name() == "family").collect();
        assert_eq!(lab.plots.len(), 1);
        legend(&app)
    };
    assert!(reported("energy").contains("periodic orbit"), "{}", reported("energy"));
    assert!(reported("q").contains("x = \"energy\""), "{}", reported("q"));
}

/// Variables given by their brackets have families over the energy, too: at y = 0 it is ½ x² + ¼ x⁴.
#[test]
fn of_a_system_given_by_brackets() {
    let text = "title = \"one\"\n[variables]\nx = { initial = 1.0 }\ny = { initial = 0.0 }\n[poisson]\n\
                H = \"1/2*(x^2 + y^2) + 1/4*x^4\"\nbrackets = [[\"x\", \"y\", \"1\"]]\n[run]\nuntil = 100.0\n";
    let app = opened(text, "family of orbits: x over E");
    let table = table(&app);
    assert_eq!(table.columns, ["energy", "greatest x", "period", "trace"]);
    assert!(table.rows.len() > 30, "{}", table.rows.len());
    let (low, high) = (table.rows[0][0], table.rows[table.rows.len() - 1][0]);
    assert!(low < 0.2 && high > 1.2, "{low} to {high}");
    for row in &table.rows {
        let square = (1.0 + 4.0 * row[0]).sqrt() - 1.0;
        assert!((row[1] - square.sqrt()).abs() < 1e-7, "{row:?}");
    }
}

/// A motion that does not come back has no family, and it is said why.
#[test]
fn where_there_is_no_orbit_there_is_no_family() {
    let text = "title = \"one\"\n[coordinates]\nq = { initial = 0.0, velocity = 1.0 }\n[lagrangian]\nL = \"1/2*q'^2\"\n\
                [run]\nuntil = 100.0\n";
    let app = opened(text, "family of orbits: q over E");
    assert_eq!(measure(&app, "members"), None);
    assert!(legend(&app).contains("no periodic orbit was found"), "{}", legend(&app));
}

/// An angle that rotates has no greatest value; its momentum has: p²/2 − cos q = E at the bottom, where the energy is E + 1.
#[test]
fn of_an_angle_that_rotates_the_momentum_is_drawn() {
    let text = "title = \"one\"\n[coordinates]\nq = { initial = 0.0, velocity = 2.6, period = \"2*pi\" }\n[lagrangian]\n\
                L = \"1/2*q'^2 + cos(q)\"\n[run]\nuntil = 100.0\n";
    let app = opened(text, "family of orbits: q over E");
    let table = table(&app);
    assert_eq!(table.columns, ["energy", "greatest p_q", "period", "trace"]);
    assert!(table.rows.len() > 20, "{}", table.rows.len());
    for row in &table.rows {
        let greatest = (2.0 * (row[0] + 1.0)).sqrt();
        assert!((row[1] - greatest).abs() < 1e-7, "{row:?} {greatest}");
    }
}

/// A family is offered over each parameter of the law, however many there are, and over none of initial values or observables
/// alone.
#[test]
fn families_are_offered_over_all_parameters_of_the_law() {
    let text = "title = \"one\"\n[coordinates]\nq = { initial = \"q0\", velocity = 0.0 }\n[parameters]\nq0 = 0.5\n\
                a = 1.0\nb = 1.0\nc = 1.0\nd = 1.0\nunseen = 1.0\nseen = 2.0\n\
                [[observables]]\nname = \"scaled\"\nexpression = \"seen*q\"\n[lagrangian]\n\
                L = \"1/2*a*q'^2 - 1/2*b*q^2 - 1/4*c*q^4 - 1/6*d*q^6\"\n[run]\nuntil = 100.0\n";
    let Prepared { model, equations, system, .. } = prepared(text);
    let physics = Physics { model: &model, equations: &equations, system: &system };
    let offers = named("family").unwrap().offers(physics);
    let over: Vec<&str> =
        offers.iter().map(|offer| offer.label.rsplit(' ').next().unwrap()).collect();
    assert_eq!(over, ["E", "a", "b", "c", "d"]);
}
