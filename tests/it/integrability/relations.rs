//! The verdict in a line, and what follows about brackets from the proofs that constants are constant.

use phaselab::expr::Expr;
use phaselab::integrability::{is_hamiltonian, relations, summary};

use super::{hamiltonian, search};
use crate::fixtures::loaded;

fn line(h: &str, degree: u32) -> String {
    let model = hamiltonian(&["x", "y"], &[], h);
    let (mut equations, found) = search(&model, degree);
    let hamiltonian = is_hamiltonian(&model, &mut equations);
    let relations = relations(&model, &mut equations, &found, hamiltonian);
    summary(&found, &relations)
}

#[test]
fn verdicts_in_a_line() {
    let kinetic = "1/2*(p_x^2 + p_y^2)";
    for (potential, degree, verdict) in [
        (
            "- 1/sqrt(x^2 + y^2)",
            2,
            "superintegrable: 3 independent invariants, 2 in involution, every bounded orbit closes",
        ),
        ("+ 1/2*(3*x^2 + 5*y^2) + x^2*y + 2*y^3", 2, "integrable: 2 invariants in involution"),
        ("+ 1/2*(x^2 + y^2) + x^2*y - 1/3*y^3", 4, "only E found, up to degree 4 (proved)"),
        ("+ 1/2*x^2*y^2", 4, "only E found, up to degree 4 (proved)"),
        ("+ 1/2*(3*x^2 + 5*y^2) + x^2*y + 201/100*y^3", 2, "only E found, up to degree 2 (proved)"),
    ] {
        assert_eq!(line(&format!("{kinetic} {potential}"), degree), verdict, "{potential}");
    }
}

/// Tufillaro's constant commutes with H at M = 3m, whatever form their bracket has.
#[test]
fn what_is_proved_constant_commutes_with_h() {
    for (mass, integrable) in [(3.0, true), (2.5, false)] {
        let mut model = (*loaded("swinging-atwood", 1).model).clone();
        model.parameters[0].value = mass;
        let (mut equations, found) = search(&model, 2);
        let relations = relations(&model, &mut equations, &found, true);
        assert_eq!(found.found.is_empty(), !integrable);
        assert_eq!(
            relations.verdict.contains("integrable (Liouville)"),
            integrable,
            "{}",
            relations.verdict
        );
        if integrable {
            assert_eq!(relations.brackets[0][1], Some(Expr::ZERO));
        }
    }
}
