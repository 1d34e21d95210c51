//! A double well that opens under a motion: into which of its wells the motion falls depends on the phase alone, with the
//! probability that the growth of their areas gives, ½ where they are alike.
//! Source: A. I. Neishtadt, *Passage through a separatrix in a resonance problem with a slowly varying parameter*, J. Appl.
//! Math. Mech. 39 (1975) 594; J. Henrard, *Capture into resonance*, Celest. Mech. 27 (1982) 3.

use super::{Done, done, program};

/// V = x⁴/4 − a x²/2 + c x, with a = 4s − 1 and c = C s, where s = t/T goes from 0 to 1.
fn parameters(s: f64, tilt: f64) -> (f64, f64) {
    (4.0 * s - 1.0, tilt * s)
}

/// Starts on one orbit of the well that has not opened, from rest at `amplitude`, at phases that follow the golden ratio;
/// and its action ∮ p dq.
fn starts(amplitude: f64, count: usize) -> (Vec<[f64; 2]>, f64) {
    let h = 1e-3;
    let rate = |[x, p]: [f64; 2]| [p, -x - x * x * x];
    let step = |s: [f64; 2]| {
        let plus = |k: [f64; 2], h: f64| [s[0] + h * k[0], s[1] + h * k[1]];
        let k1 = rate(s);
        let k2 = rate(plus(k1, h / 2.0));
        let k3 = rate(plus(k2, h / 2.0));
        let k4 = rate(plus(k3, h));
        [0, 1].map(|i| s[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]))
    };
    let mut orbit = vec![[amplitude, 0.0]];
    let (mut action, mut turned) = (0.0, false);
    loop {
        let before = orbit[orbit.len() - 1];
        let after = step(before);
        action += h * 0.5 * (before[1].powi(2) + after[1].powi(2));
        turned |= after[1] > 0.0;
        if turned && after[1] <= 0.0 {
            break;
        }
        orbit.push(after);
    }
    let phase = |k: usize| (0.25 + 0.618_033_988_749_894_9 * k as f64).fract();
    let at = |k: usize| orbit[(phase(k) * orbit.len() as f64) as usize];
    ((0..count).map(at).collect(), action)
}

/// The areas of the left and the right lobe of the separatrix.
fn lobes(s: f64, tilt: f64) -> [f64; 2] {
    let (a, c) = parameters(s, tilt);
    // the saddle is the middle root of x³ − a x + c
    let mut saddle = c / a;
    for _ in 0..60 {
        saddle -= (saddle.powi(3) - a * saddle + c) / (3.0 * saddle * saddle - a);
    }
    // V − V(saddle) = ¼ (x − saddle)² ((x + saddle)² − 2a + 2 saddle²)
    let width = (2.0 * a - 2.0 * saddle * saddle).sqrt();
    [-1.0, 1.0].map(|side: f64| {
        let end = -saddle + side * width;
        let n = 4000;
        let sum: f64 = (0..n)
            .map(|k| {
                let u = (f64::from(k) + 0.5) / f64::from(n);
                // x = end + (saddle − end) u² takes the root at the end away
                let x = end + (saddle - end) * u * u;
                let below = (2.0 * a - 2.0 * saddle * saddle - (x + saddle).powi(2)).max(0.0);
                (x - saddle).abs() * (0.5 * below).sqrt() * (saddle - end).abs() * 2.0 * u
            })
            .sum();
        2.0 * sum / f64::from(n)
    })
}

/// The probability of the right well: its share in the growth of both areas, when together they reach the action.
fn expected(tilt: f64, action: f64) -> f64 {
    let both = |s: f64| lobes(s, tilt).iter().sum::<f64>();
    let has_wells = |s: f64| {
        let (a, c) = parameters(s, tilt);
        a > 0.05 && 4.0 * a.powi(3) > 27.5 * c * c
    };
    let first = (250..1000).map(|k| f64::from(k) / 1000.0).find(|&s| has_wells(s));
    let (mut low, mut high) = (first.expect("two wells"), 1.0);
    assert!(both(low) < action && action < both(high));
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if both(middle) < action { low = middle } else { high = middle }
    }
    let h = 1e-4;
    let [left, right] = [0, 1].map(|i| lobes(low + h, tilt)[i] - lobes(low - h, tilt)[i]);
    right / (left + right)
}

/// The share of the motions that end in the right well, and its probability. The time T is another one for each.
fn share(amplitude: f64, tilt: f64, count: usize) -> (f64, f64) {
    let (starts, action) = starts(amplitude, count);
    let home = tempfile::tempdir().expect("a folder");
    let file = format!(
        "title = \"Well\"\n[coordinates]\nx = {{ initial = 1.0, momentum = 0.0 }}\n[parameters]\nC = {tilt:?}\n\
         T = 200.0\n[definitions]\ns = \"min(t/T, 1)\"\n[hamiltonian]\n\
         H = \"p_x^2/2 + x^4/4 - (4*s - 1)*x^2/2 + C*s*x\"\n"
    );
    std::fs::write(home.path().join("well.toml"), file).expect("written");
    let mut table = "x,p_x,T\n".to_owned();
    for (k, [x, p]) in starts.iter().enumerate() {
        let time = 150.0 + 150.0 * (0.754_877_666_246_692_7 * k as f64).fract();
        table.push_str(&format!("{x:?},{p:?},{time:?}\n"));
    }
    std::fs::write(home.path().join("starts.csv"), table).expect("written");
    let words = ["./well.toml", "--over=starts.csv", "--until=300"];
    let method = ["--method=leapfrog", "--step=0.05", "--format=json"];
    let found = done(program(home.path()).arg("sweep").args(words).args(method));
    // steps as long as these let the energy swing a little, and the sweep says so
    assert!(
        found.stderr.is_empty() || found.stderr.contains("departs from its value"),
        "{}",
        found.stderr
    );
    let found = Done { stderr: String::new(), ..found }.json();
    let names = found["columns"].as_array().expect("columns");
    let place = names.iter().rposition(|name| name == "x").expect("x");
    let ends = found["rows"].as_array().expect("rows");
    assert_eq!(ends.len(), count);
    let right = ends.iter().filter(|row| {
        let x = row[place].as_f64().expect("a number");
        assert!(x.abs() > 0.2, "{x} is in neither well");
        x > 0.0
    });
    (right.count() as f64 / count as f64, expected(tilt, action))
}

/// How many motions: a hundred, or what the environment says.
fn count() -> usize {
    let given = std::env::var("PHASELAB_PHASES").ok();
    given.map_or(100, |count| count.parse().expect("a number of motions"))
}

/// Whether a share of the motions is the probability: to three standard deviations, and to 0.03 of a thousand or more.
fn check(amplitude: f64, tilt: f64) {
    let count = count();
    let (found, expected) = share(amplitude, tilt, count);
    let deviation = (expected * (1.0 - expected) / count as f64).sqrt();
    let within = if count < 1000 { 3.0 * deviation } else { 0.03 };
    assert!((found - expected).abs() < within, "{found} of {count} is not {expected}");
}

#[test]
fn wells_that_are_alike_take_half_each() {
    // at a = 1 each lobe has 4/3
    let [left, right] = lobes(0.5, 0.0);
    assert!((left - 4.0 / 3.0).abs() < 1e-6 && (right - left).abs() < 1e-12, "{left} {right}");
    check(0.9, 0.0);
}

#[test]
fn the_well_that_grows_faster_takes_more() {
    let (_, action) = starts(1.1, 1);
    // far enough from ½ that a hundred motions tell
    let probability = expected(0.8, action);
    assert!((probability - 0.302).abs() < 0.002, "{probability}");
    check(1.1, 0.8);
}
