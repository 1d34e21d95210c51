//! How long the search for constants of the motion takes: the vector of Kepler's problem, the absence of any in Hénon
//! and Heiles's to degree 6, three bodies in the plane to degree 2.

use criterion::{Criterion, criterion_group, criterion_main};
use phaselab::integrability::{Limits, invariants};
use phaselab::mechanics;
use phaselab::preset::read;

const KEPLER: &str = "title = \"Kepler\"\n[coordinates]\nr = { initial = 1.0 }\n\
    theta = { initial = 0.0, velocity = 1.0 }\n[parameters]\nm = 1.0\nk = 1.0\n[lagrangian]\n\
    L = \"1/2*m*(r'^2 + r^2*theta'^2) + k/r\"\n";

const HENON_HEILES: &str = "title = \"Hénon–Heiles\"\n[coordinates]\nx = { initial = 0.1 }\n\
    y = { initial = 0.2 }\n[hamiltonian]\n\
    H = \"1/2*(p_x^2 + p_y^2) + 1/2*(x^2 + y^2) + x^2*y - 1/3*y^3\"\n";

const THREE_BODIES: &str = "title = \"Three bodies\"\n[coordinates]\n\
    x1 = { initial = 1.0 }\ny1 = { initial = 0.0 }\nx2 = { initial = 0.0 }\n\
    y2 = { initial = 1.0 }\nx3 = { initial = -1.0 }\ny3 = { initial = 0.0 }\n[hamiltonian]\n\
    H = \"1/2*(p_x1^2 + p_y1^2 + p_x2^2 + p_y2^2 + p_x3^2 + p_y3^2) \
    - 1/sqrt((x1 - x2)^2 + (y1 - y2)^2) - 1/sqrt((x1 - x3)^2 + (y1 - y3)^2) \
    - 1/sqrt((x2 - x3)^2 + (y2 - y3)^2)\"\n";

fn bench(c: &mut Criterion) {
    let mut group = c.benchmark_group("invariants");
    group.sample_size(10);
    for (name, text, degree) in [
        ("kepler", KEPLER, 2),
        ("henon-heiles", HENON_HEILES, 6),
        ("three bodies", THREE_BODIES, 2),
    ] {
        let model = read(text).unwrap_or_else(|diagnostics| panic!("{diagnostics:?}")).model;
        let equations = mechanics::derive(&model).expect("derivable");
        group.bench_function(name, |b| {
            b.iter(|| {
                let limits = Limits { degree: Some(degree), is_over: &|| false };
                invariants(&model, &mut equations.clone(), &limits).expect("it can be searched")
            });
        });
    }
    group.finish();
}

criterion_group!(benches, bench);
criterion_main!(benches);
