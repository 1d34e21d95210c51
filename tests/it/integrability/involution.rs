//! Sets in involution that are completed by combinations and products of constants, and constants with roots of numbers.

use phaselab::integrability::{Proof, is_hamiltonian, relations};
use phaselab::model::Model;

use super::{hamiltonian, search};

/// The verdict, and what is in involution by the names of the constants.
fn judged(model: &Model, degree: u32) -> (String, Vec<String>) {
    let (mut equations, found) = search(model, degree);
    let is_hamiltonian = is_hamiltonian(model, &mut equations);
    let relations = relations(model, &mut equations, &found, is_hamiltonian);
    let known = found.known.iter().map(|k| k.name.clone());
    let names: Vec<String> =
        known.chain((1..=found.found.len()).map(|i| format!("I{i}"))).collect();
    let commuting = relations.commuting_names(&names);
    (relations.verdict, commuting)
}

/// L_x, L_y and L_z do not commute in pairs; L_z and L² do (Goldstein, *Classical Mechanics*, § 9.7).
#[test]
fn a_central_force_has_the_square_of_its_angular_momentum() {
    let h = "1/2*(p_r^2 + p_theta^2/r^2 + p_phi^2/(r^2*sin(theta)^2)) + 1/4*r^4 - 1/r";
    let (verdict, commuting) = judged(&hamiltonian(&["r", "theta", "phi"], &[], h), 1);
    assert!(verdict.contains("3 of them in involution: superintegrable"), "{verdict}");
    assert!(commuting.contains(&"I1^2 + I2^2".to_owned()), "{commuting:?}");
}

/// Two bodies on a plane with a force along their line: P_x, P_y, the energy, and the angular momentum about the centre of
/// mass, which is no constant of first degree by itself, are in involution.
#[test]
fn the_angular_momentum_about_the_centre_of_mass_completes_the_momenta() {
    let kinetic = "1/2*(p_x^2 + p_y^2 + p_u^2 + p_v^2)";
    let potential = "((x - u)^2 + (y - v)^2)^2";
    let model = hamiltonian(&["x", "y", "u", "v"], &[], &format!("{kinetic} + {potential}"));
    let (verdict, commuting) = judged(&model, 1);
    assert!(verdict.contains("4 of them in involution"), "{verdict}");
    assert_eq!(commuting.len(), 4, "{commuting:?}");
}

/// A square is no constant of its own: nothing is added where a commuting set cannot be completed.
#[test]
fn nothing_is_added_that_depends_on_what_commutes() {
    let h = "1/2*(p_x^2 + p_y^2) + 1/2*(x^2 + y^2) + x^2*y - 1/3*y^3";
    let (verdict, commuting) = judged(&hamiltonian(&["x", "y"], &[], h), 4);
    assert!(verdict.contains("1 in involution"), "{verdict}");
    assert_eq!(commuting, ["energy"]);
}

/// The integrable relative of Hénon and Heiles with x²y + 2y³, turned by 45°, has coefficients with √2; with 3y³ it is
/// not integrable (Bountis, Segur, Vivaldi, Phys. Rev. A 25 (1982) 1257).
#[test]
fn systems_turned_by_45_degrees_have_their_constants() {
    for (cubic, integrable) in [("2", true), ("3", false)] {
        let h = format!(
            "1/2*(p_x^2 + p_y^2 + x^2 + y^2) + 1/2*(x + y)^2*((x - y)/sqrt(2)) \
             + {cubic}*((x - y)/sqrt(2))^3"
        );
        let model = hamiltonian(&["x", "y"], &[], &h);
        let (_, found) = search(&model, 2);
        assert_eq!(found.found.len(), usize::from(integrable), "{cubic}");
        assert!(found.found.iter().all(|c| c.proof == Proof::Proved));
        assert_eq!(judged(&model, 2).0.contains("integrable (Liouville)"), integrable);
    }
}

/// Two different roots; what is found is one of the two energies, of which the other is what is left of the whole.
#[test]
fn constants_may_have_several_roots_of_numbers() {
    let h = "1/2*(p_x^2 + p_y^2) + sqrt(2)*x^2 + sqrt(3)*y^2";
    let (_, found) = search(&hamiltonian(&["x", "y"], &[], h), 2);
    assert_eq!(found.found.len(), 1);
    assert_eq!(found.found[0].proof, Proof::Proved);
}

/// Powers of an energy that is no polynomial in the momenta are nothing new.
#[test]
fn powers_of_a_relativistic_energy_are_not_found_again() {
    let h = "sqrt(1 + p_x^2 + p_y^2) - 1/2/sqrt(x^2 + y^2)";
    let (_, found) = search(&hamiltonian(&["x", "y"], &[], h), 3);
    assert!(found.found.is_empty(), "{} found", found.found.len());
    assert_eq!(found.none_up_to, Some(3));
}
