//! Apparent forces, compared with the closed form of uniform rotation and with Newton's law for a free particle.

use phaselab::expr::{Expr, Symbol};
use phaselab::mechanics::{Apparent, Equations, derive};
use phaselab::preset;

use crate::build::sample;

fn seen(frame: &str) -> (Equations, Apparent) {
    let text = format!(
        "title = 'free'\n[coordinates]\nx = {{ initial = 1.0 }}\ny = {{ initial = 0.0 }}\n\
         z = {{ initial = 0.0 }}\n[parameters]\nm = 2.0\nw = 0.7\n[lagrangian]\n\
         L = \"m/2*(x'^2 + y'^2 + z'^2)\"\n[[frames]]\nname = 'f'\n{frame}\n\
         particles = [{{ at = ['x', 'y', 'z'], mass = 'm' }}]\n"
    );
    let model = preset::read(&text).unwrap_or_else(|diagnostics| panic!("{diagnostics:?}")).model;
    let equations = derive(&model).unwrap();
    let apparent = equations.supplements.frames[0][0].clone();
    (equations, apparent)
}

fn close(a: [f64; 3], b: [f64; 3]) {
    let size = a.iter().chain(&b).fold(1.0_f64, |s, v| s.max(v.abs()));
    assert!((0..3).all(|k| (a[k] - b[k]).abs() < 1e-13 * size), "{a:?} {b:?}");
}

#[test]
fn in_uniform_rotation_they_are_those_of_the_textbook() {
    let (equations, apparent) = seen("angle = 'w*t'");
    let pool = &equations.pool;
    let symbol = |name: &str| pool.find_symbol(name).unwrap();
    for seed in 0..20 {
        let at = sample(seed);
        let value = |vector: [Expr; 3]| vector.map(|e| pool.evaluate(e, &at));
        let [x, y, z] = ["x", "y", "z"].map(|name| at(symbol(name)));
        let [u, v, s] = ["x'", "y'", "z'"].map(|name| at(symbol(name)));
        let (m, w, t) = (at(symbol("m")), at(symbol("w")), at(symbol("t")));
        let (sin, cos) = (w * t).sin_cos();
        let r = [x * cos + y * sin, -x * sin + y * cos, z];
        let rate = [u * cos + v * sin + w * r[1], -u * sin + v * cos - w * r[0], s];
        close(value(apparent.at), r);
        close(value(apparent.velocity), rate);
        close(value(apparent.centrifugal), [m * w * w * r[0], m * w * w * r[1], 0.0]);
        close(value(apparent.coriolis), [2.0 * m * w * rate[1], -2.0 * m * w * rate[0], 0.0]);
        assert_eq!(apparent.euler, [Expr::ZERO; 3], "it turns evenly");
        assert_eq!(apparent.dragging, [Expr::ZERO; 3], "its origin rests");
    }
}

#[test]
fn they_account_for_every_bend_of_a_path_that_is_straight() {
    // uneven rotation about an oblique axis with a moving origin: m dv'/dt is their sum
    let frame = "axis = ['1', '2', '2']\nangle = 'w*t + sin(t) + t^2'\norigin = ['3*t', '1 - t^2', 'sin(2*t)']";
    let (mut equations, apparent) = seen(frame);
    let mut seeds: Vec<(Symbol, Expr)> = vec![(equations.symbols.time, Expr::ONE)];
    for c in equations.coordinates.clone() {
        seeds.push((c.position, equations.pool.variable(c.velocity)));
        seeds.push((c.velocity, Expr::ZERO));
    }
    let acceleration = apparent.velocity.map(|e| equations.pool.derivation(e, &seeds));
    let pool = &equations.pool;
    let m = pool.find_symbol("m").unwrap();
    for seed in 0..20 {
        let at = sample(seed);
        let value = |vector: [Expr; 3]| vector.map(|e| pool.evaluate(e, &at));
        let Apparent { centrifugal, coriolis, euler, dragging, .. } = apparent;
        let forces = [centrifugal, coriolis, euler, dragging].map(value);
        let sum = [0, 1, 2].map(|k| forces.iter().map(|f| f[k]).sum::<f64>());
        close(value(acceleration).map(|a| at(m) * a), sum);
        assert!(forces.iter().all(|f| f.iter().any(|v| v.abs() > 1e-3)), "none of them is missing");
    }
}
