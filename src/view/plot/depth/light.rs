//! The light on surfaces.
//!
//! In: normals in the coordinates of the camera: right, up, towards the eye. Out: brightness. Never here: colours, or which
//! surface is the nearest.

/// The direction of the light, from above, a little left in front: right, up, towards the eye.
const LIGHT: [f64; 3] = [-0.40, 0.75, 0.53];

/// How far around a surface the light reaches, as the cosine with the opposite sign: without it all that is turned away from the
/// light would be equally dark, and the underside of a body would look flat.
const AROUND: f64 = 0.5;

/// How brightly a surface with this normal is lit, seen from its front: from 0 to 1.
pub(super) fn lit(normal: [f64; 3]) -> f64 {
    let size = |v: [f64; 3]| v.iter().map(|v| v * v).sum::<f64>().sqrt();
    let front = if normal[2] < 0.0 { -1.0 } else { 1.0 };
    let along: f64 = (0..3).map(|k| front * normal[k] * LIGHT[k]).sum();
    let cosine = along / (size(normal) * size(LIGHT));
    let light = (cosine + AROUND) / (1.0 + AROUND);
    if light.is_finite() { light.clamp(0.0, 1.0) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The underside of a body is darker the more it is turned away, whichever way round its faces are written.
    #[test]
    fn what_is_turned_away_from_the_light_has_shades_too() {
        let tilted = |up: f64| [0.0, up, (1.0 - up * up).sqrt()];
        let lights: Vec<f64> = [0.8, 0.4, 0.0, -0.4, -0.7].map(|up| lit(tilted(up))).to_vec();
        assert!(lights.is_sorted_by(|a, b| a > b), "{lights:?}");
        assert!((lit(LIGHT) - 1.0).abs() < 1e-12);
        assert!((lit(tilted(-0.4)) - lit(tilted(-0.4).map(|v| -v))).abs() < 1e-12);
    }
}
