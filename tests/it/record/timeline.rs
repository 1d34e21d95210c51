//! The time bar and time reversed in scripts: what they say holds, and again in the same way.

use super::{played, recorded};

const BACK: &str = r#"
Wait 3s
Look at 1
Assert status paused
Assert t = 1 within 1e-15
Press ;
Press )
Assert t > 1
Press '
Assert t = 1 within 1e-15
Press Z
Wait 0.5s
Assert status running
Assert t < 0.9
Assert screen "Return error"
Wait 2s
Assert status paused
Assert t = 0 within 1e-300
Assert separation.error < 1e-13
Assert screen "dotted: expected"
Assert theta = theta0 within 1e-12
Press Space
Wait 1s
Assert t < -0.5
Press r
Wait 1s
Assert t > 0.5
"#;

#[test]
fn a_script_looks_back_and_reverses_time() {
    let recording = played("pendulum", BACK);
    let wrong: Vec<&str> = recording.false_claims.iter().map(|c| c.message.as_str()).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
    let again = played("pendulum", BACK);
    assert_eq!(recording.events, again.events);
}

#[test]
fn a_claim_about_the_way_back_can_be_wrong() {
    let text = "Wait 1s\nPress Z\nWait 2s\nAssert separation.error > 1e-3\nAssert t > 0.5";
    assert_eq!(recorded("pendulum", text).false_claims.len(), 2);
}
