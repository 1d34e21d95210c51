//! The claims of a file: how long the motion is followed to check them.

use phaselab::claims::false_claims;
use phaselab::expr::Expr;
use phaselab::mechanics::Flow;

use crate::hand::lowered;

/// The steps that a check may take of a motion whose force is a sum of this many parameters times x, as is said where they
/// do not suffice, and the number of parts of its law. A step costs the same with many parameters as with one.
fn steps(parameters: usize) -> (u64, u64) {
    let names: Vec<String> = (0..parameters).map(|k| format!("k{k}")).collect();
    let values: String = names.iter().map(|name| format!("{name} = 1e6\n")).collect();
    let text = format!(
        "title = \"a\"\n[coordinates]\nx = {{ initial = 1 }}\n[parameters]\n{values}[lagrangian]\n\
         L = \"1/2*x'^2 - 1/2*({})*x^2\"\n[run]\nuntil = 1e9\n\
         [[observables]]\nname = \"G\"\nexpression = \"x\"\nconserved = true\n",
        names.join(" + ")
    );
    let loaded = lowered(&text);
    let equations = &loaded.equations;
    let Flow::Lagrange { mass, force, .. } = &equations.flow else { panic!("a Lagrangian") };
    let roots: Vec<Expr> = mass.concat().into_iter().chain(force.clone()).collect();
    let said = false_claims(&loaded.model, equations);
    let said = said.first().map_or("", |diagnostic| &diagnostic.message);
    let steps = said.strip_prefix("`G` cannot be checked: the ").and_then(|rest| {
        rest.split_once(" steps that a check may take led only to t = ")?.0.parse().ok()
    });
    (steps.unwrap_or_else(|| panic!("{said}")), equations.pool.reachable(&roots).len() as u64)
}

#[test]
fn claims_are_worth_four_million_evaluations_of_one_part_and_at_least_five_thousand_steps() {
    let (few, parts) = steps(700);
    assert!((700..800).contains(&parts), "{parts}");
    assert_eq!(few, 4_000_000 / parts);
    let (many, parts) = steps(900);
    assert!(parts > 900, "{parts}");
    assert_eq!(many, 5_000);
}
