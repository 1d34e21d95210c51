//! Constants of the motion: found, proved, and proved absent.

use phaselab::integrability::{Invariants, Limits, Proof, invariants, relations};
use phaselab::mechanics::{self, Equations};
use phaselab::model::Model;

use crate::build::{hamiltonian, lagrangian};

/// Searches up to a degree without a limit of time.
fn search(model: &Model, degree: u32) -> (Equations, Invariants) {
    let mut equations = mechanics::derive(model).expect("derivable");
    let limits = Limits { degree: Some(degree), is_over: &|| false };
    let found = invariants(model, &mut equations, &limits).expect("a law that can be searched");
    (equations, found)
}

#[test]
fn trial() {
    for (q, h, d) in [
        (vec!["x", "y"], "1/2*(p_x^2+p_y^2)/m - k/sqrt(x^2+y^2)", 2),
        (vec!["r", "theta"], "1/2*(p_r^2+p_theta^2/r^2)/m - k/r", 2),
        (vec!["x", "y"], "1/2*(p_x^2+p_y^2) + 1/2*(x^2+y^2) + x^2*y - 1/3*y^3", 4),
        (vec!["x", "y"], "1/2*(p_x^2+p_y^2) + 1/2*(x^2+16*y^2) + x^2*y + 16/3*y^3", 4),
        (vec!["x", "y"], "1/2*(p_x^2+p_y^2) + 1/2*(m*x^2+k*y^2) + x^2*y + 2*y^3", 2),
    ] {
        let model = hamiltonian(&q, &["m", "k"], h);
        let begin = std::time::Instant::now();
        let (mut e, found) = search(&model, d);
        let r = relations(&model, &mut e, &found, true);
        println!("{h}: {:?} {}", begin.elapsed(), r.verdict);
        for k in &found.known { println!("  known {} deg {}", e.pool.text(k.expression), k.degree); }
        for c in &found.found {
            println!("  {} deg {} {:?} {}", e.pool.text(c.expression), c.degree, c.proof, c.independent);
        }
        for s in &found.searched { println!("  [{}] {} {}", s.degree, s.size, s.family); }
        println!("  none {:?} ended {:?}", found.none_up_to, found.ended);
    }
    let _ = (lagrangian, Proof::Proved);
}
