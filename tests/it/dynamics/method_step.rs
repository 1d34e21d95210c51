//! One step of a method beside a transformation: symplectic Euler is the map that q P + h H(q, P) generates.

use phaselab::app::Loaded;
use phaselab::claims::false_claims;
use phaselab::dynamics::MethodStep;
use phaselab::integrate::{Settings, method_named};

use super::preset;
use crate::fixtures::{begun, loaded, lowered, press};
use crate::laboratory::{measured, plot_named};
use crate::screen::screen_text;

/// Two entangled degrees of freedom, where H does not separate and the map is solved numerically, as the step is.
const ENTANGLED: &str = "title = \"T\"\n\
    [coordinates]\nx = { initial = 0.8, momentum = 0.5 }\ny = { initial = -0.3, momentum = 0.7 }\n\
    [parameters]\nh = 0.05\n[hamiltonian]\nH = \"(1 + x^2)*p_x^2/2 + p_y^2/(2 + cos(x*y)) + x^4*p_y + sin(y)\"\n\
    [[transformations]]\nname = \"step\"\nkind = \"F2\"\nnew = [\"X\", \"Y\", \"U\", \"V\"]\n\
    F = \"x*U + y*V + h*((1 + x^2)*U^2/2 + V^2/(2 + cos(x*y)) + x^4*V + sin(y))\"\n\
    [expect]\nsteps = [{ transformation = \"step\", method = \"symplectic-euler\", step = \"h\", within = 1e-13 }]\n";

fn beside(loaded: &Loaded, name: &str, (method, step): (&str, f64)) -> MethodStep {
    let mut equations = (*loaded.equations).clone();
    let method = method_named(method).expect("a method");
    let parts = (&*loaded.model, &mut equations, &*loaded.system);
    MethodStep::beside(parts, name, (method, step)).unwrap_or_else(|why| panic!("{why}"))
}

#[test]
fn a_step_of_symplectic_euler_is_the_map_of_its_generating_function() {
    let pendulum = loaded("symplectic-euler", 1);
    let found = beside(&pendulum, "symplectic euler", ("symplectic-euler", 0.1));
    assert!(found.points == 20 && found.image < 1e-15 && found.derivative < 1e-15, "{found:?}");
    // M of P = p − h sin q, Q = q + h P has the trace 2 − h² cos q, and the determinant 1
    for matrix in &found.first {
        let cosine = -matrix[(1, 0)] / 0.1;
        assert!((matrix.trace() - (2.0 - 0.01 * cosine)).abs() < 1e-15, "{matrix}");
        assert!((matrix.determinant() - 1.0).abs() < 1e-15, "{matrix}");
    }
    let found = beside(&lowered(ENTANGLED), "step", ("symplectic-euler", 0.05));
    assert!(found.image < 1e-13 && found.derivative < 1e-13, "{found:?}");
    assert!(found.first[0].nrows() == 4 && found.first[0][(0, 3)] != 0.0);
}

/// Neither a step of another size, nor that of another method, nor the map of explicit Euler: apart by h² where they are
/// nearest.
#[test]
fn other_steps_are_other_maps() {
    let pendulum = loaded("symplectic-euler", 1);
    for (name, method, step) in [
        ("symplectic euler", "symplectic-euler", 0.11),
        ("symplectic euler", "leapfrog", 0.1),
        ("explicit euler", "symplectic-euler", 0.1),
    ] {
        let found = beside(&pendulum, name, (method, step));
        assert!(found.image > 1e-3 && found.derivative > 1e-3, "{name}, {method}: {found:?}");
    }
}

/// The matrix of the step is that which `flow` has of the method's own map after one step.
#[test]
fn the_matrix_of_a_step_is_that_of_the_flow() {
    let case = preset("symplectic-euler", &[], &[1.2, 0.5]);
    let settings = Settings { step: Some(0.1), tolerance: None };
    let method = method_named("symplectic-euler").expect("a method");
    let mut look = |_: f64| {};
    let flow =
        phaselab::dynamics::flow_map(&case.space, (method, settings), &case.start, 0.1, &mut look)
            .expect("a map");
    // ∂(q + h P, P)/∂(q, p) with P = p − h sin q
    let (h, cosine) = (0.1, 1.2_f64.cos());
    let known = [[1.0 - h * h * cosine, h], [-h * cosine, 1.0]];
    for (i, row) in known.iter().enumerate() {
        for (j, entry) in row.iter().enumerate() {
            assert!((flow.matrix[(i, j)] - entry).abs() < 1e-15, "{}", flow.matrix);
        }
    }
}

/// In the units of atoms both maps are small in one variable and steep in the other: what differs is seen in all units.
#[test]
fn other_steps_are_other_maps_in_all_units() {
    // lengths of a, times of 1/ω, masses of m
    for [a, m, w] in [[1.0, 1.0, 1.0], [5e-11, 9e-31, 4e16], [3e20, 2e30, 1e-15]] {
        let text = |step: f64| {
            format!(
                "title = \"T\"\n[coordinates]\nx = {{ initial = {a:e}, momentum = {:e} }}\n\
                 [parameters]\nm = {m:e}\nw = {w:e}\nh = {:e}\n[hamiltonian]\nH = \"p_x^2/(2*m) + m*w^2*x^2/2\"\n\
                 [[transformations]]\nname = \"step\"\nkind = \"explicit\"\n\
                 Q = {{ Q = \"x + {step}*h*(p_x - {step}*h*m*w^2*x)/m\" }}\n\
                 P = {{ P = \"p_x - {step}*h*m*w^2*x\" }}\n",
                0.5 * a * m * w,
                0.1 / w
            )
        };
        let of = |step| beside(&lowered(&text(step)), "step", ("symplectic-euler", 0.1 / w));
        let (same, other) = (of(1.0), of(1.01));
        assert!(same.image < 1e-13 && same.derivative < 1e-13, "{w}: {same:?}");
        assert!(other.image > 1e-4 && other.derivative > 1e-4, "{w}: {other:?}");
    }
}

#[test]
fn what_a_file_says_of_a_step_is_checked() {
    let diagnostics = |text: &str| {
        let loaded = lowered(text);
        let all = false_claims(&loaded.model, &loaded.equations).into_iter();
        all.map(|d| format!("{}: {}", d.message, d.help.unwrap_or_default())).collect::<Vec<_>>()
    };
    assert!(diagnostics(ENTANGLED).is_empty(), "{:?}", diagnostics(ENTANGLED));
    for (from, to, said) in [
        ("step = \"h\"", "step = \"2*h\"", "`step` is not a step of `symplectic-euler`"),
        ("step = \"h\"", "step = \"-h\"", "its step is not above 0"),
        ("symplectic-euler", "symplectic-eular", "did you mean `symplectic-euler`?"),
        ("symplectic-euler", "taylor", "fixed-step methods are"),
        ("symplectic-euler", "rk4", "`step` is not a step of `rk4`"),
    ] {
        let found = diagnostics(&ENTANGLED.replace(from, to));
        assert!(found.len() == 1 && found[0].contains(said), "{to}: {found:?}");
    }
}

/// The corner of the plane of the new variables has it, at the parameters of now.
#[test]
fn the_plane_shows_the_step_beside_the_map() {
    let text = &crate::fixtures::catalog().find("symplectic-euler").expect("a preset").text;
    let mut app = begun(text);
    press(&mut app, "Wait Wait");
    let off = measured(&app, plot_named(&app, "transformation"), "off_step");
    assert!(off.is_some_and(|off| off < 1e-15), "{off:?}");
    let page = |width, height| screen_text(&app, (width, height));
    // a low plot leaves it to the zoomed pane
    let low = page(80, 24);
    assert!(low.contains("canonical, proved") && low.contains("z shows more"), "{low}");
    // a higher one has a third of its rows for it
    let high = page(120, 40);
    assert!(high.contains("is one step of symplectic-euler"), "{high}");
    let page = page(200, 60);
    for words in ["is one step of symplectic-euler", "20 points", "map: M = (", "step: M = ("] {
        assert!(page.contains(words), "{words}: {page}");
    }
}
