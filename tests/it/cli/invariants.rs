//! `phaselab invariants` and `phaselab symmetries`.

use serde_json::Value;

use super::phaselab;

fn json(words: &[&str]) -> Value {
    serde_json::from_str(&phaselab(words).success()).expect("JSON")
}

#[test]
fn the_vector_of_kepler_is_found_and_named() {
    let answer =
        json(&["invariants", "kepler-brackets", "--degree", "2", "--format", "json", "--jacobi"]);
    for key in ["searched", "known", "found", "none_up_to", "verdict", "brackets", "parameters"] {
        assert!(!answer[key].is_null() || key == "none_up_to", "{key}: {answer:#}");
    }
    let text = phaselab(&["invariants", "kepler-brackets", "--degree", "2"]).success();
    assert!(text.contains("searched"), "{text}");
}

#[test]
fn absence_is_stated_with_what_was_searched() {
    let answer = json(&["invariants", "henon-heiles", "--degree", "3", "--format", "json"]);
    assert_eq!(answer["found"], serde_json::json!([]));
    assert_eq!(answer["none_up_to"], 3);
    let searched = answer["searched"].as_str().expect("text");
    assert!(searched.contains("polynomials in p_x, p_y"), "{searched}");
}

#[test]
fn a_scan_finds_the_ratio_of_swinging_atwood() {
    let words = ["invariants", "swinging-atwood", "--degree", "2", "--format", "json"];
    let answer = json(&[&words[..], &["--scan", "M=2:4:1"]].concat());
    let values = answer["scan"]["values"].as_array().expect("a list");
    let found: Vec<u64> = values.iter().map(|v| v["found"].as_u64().expect("a number")).collect();
    assert_eq!(found, [0, 1, 0]);
}

#[test]
fn wrong_scans_are_refused() {
    for scan in ["M", "M=1:2", "M=2:1:1", "M=1:2:0", "M=1:2:1e-9"] {
        phaselab(&["invariants", "swinging-atwood", "--scan", scan]).fails(2, &["--scan"]);
    }
    phaselab(&["invariants", "swinging-atwood", "--scan", "q=1:2:1"])
        .fails(2, &["no parameter `q`", "M, m, g"]);
    phaselab(&["invariants", "planet", "--degree", "0"]).fails(2, &["--degree"]);
}

#[test]
fn symmetries_are_told_with_their_constants() {
    let answer = json(&["symmetries", "free-particle", "--format", "json"]);
    let all = answer["symmetries"].as_array().expect("a list");
    assert!(!all.is_empty());
    for symmetry in all {
        assert_eq!(symmetry["proved"], true);
        for key in ["name", "time", "coordinates", "gauge", "conserved"] {
            assert!(!symmetry[key].is_null(), "{key}");
        }
    }
    let text = phaselab(&["symmetries", "free-particle"]).success();
    assert!(text.contains("time shift"), "{text}");
}

/// Kepler's third law is a symmetry without an integral; its averages are those of the virial theorem.
#[test]
fn similarity_is_told() {
    let answer = json(&["symmetries", "planet", "--format", "json"]);
    let all = answer["point_symmetries"]["found"].as_array().expect("a list");
    let law = all.iter().find(|s| s["noether"] == false).unwrap_or_else(|| panic!("{answer}"));
    assert_eq!(law["name"], "dilation");
    assert_eq!(law["proved"], true);
    assert_eq!(answer["similarity"]["degree"], "-1");
    assert_eq!(answer["similarity"]["period_exponent"], "3/2");
    assert_eq!(answer["similarity"]["mean_T_over_mean_V"], "-1/2");
    let text = phaselab(&["symmetries", "planet"]).success();
    for part in ["not Noether's", "virial theorem"] {
        assert!(text.contains(part), "{text}");
    }
    let latex = phaselab(&["symmetries", "planet", "--format", "latex"]).success();
    assert!(latex.contains("\\langle T \\rangle"), "{latex}");
    // where friction acts there is no similarity, and nothing of Noether's
    let answer = json(&["symmetries", "damped-pendulum", "--format", "json"]);
    assert!(answer["similarity"].is_null());
    assert_eq!(answer["symmetries"], serde_json::json!([]));
    assert_eq!(answer["point_symmetries"]["found"][0]["name"], "time shift");
}
