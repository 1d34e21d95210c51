//! What is canonical near the start and not far from it.

use phaselab::diagnostic::Document;
use phaselab::mechanics;

/// Whether the transformation Q = `of`, P = p_x is said to be canonical.
fn is_canonical(of: &str) -> bool {
    let text = format!(
        "title = 'T'\n[coordinates]\nx = {{ initial = 1.0, momentum = 0.3 }}\n\
         [hamiltonian]\nH = '1/2*p_x^2 + 1/2*x^2'\n\
         [[transformations]]\nname = 'near'\nkind = 'explicit'\nQ = {{ X = '{of}' }}\nP = {{ Y = 'p_x' }}\n"
    );
    let model = Document::new("system.toml", &text).read().expect("a model").model;
    let mut equations = mechanics::derive(&model).expect("derivable");
    let maps = mechanics::phase_maps(&model, &mut equations);
    maps[0].verdict(&model, &mut equations).canonical
}

#[test]
fn a_map_that_departs_beyond_any_distance_is_not_canonical() {
    for of in ["x + 1e-30*x^9", "x + 1e-60*x^9", "x + max(0, x - 9000)", "x + max(0, x - 1e9)"] {
        assert!(!is_canonical(of), "{of}");
    }
    for of in ["x", "x + sin(t)", "x + p_x^3", "x + max(0, p_x - 9000)"] {
        assert!(is_canonical(of), "{of}");
    }
}
