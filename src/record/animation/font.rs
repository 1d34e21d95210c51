//! The letters of a picture: outlines of DejaVu Sans Mono, which has the signs of mathematics.
//!
//! In: a character, the size of a cell. Out: its outline as contours in pixels. Never here: characters drawn as shapes.

use ttf_parser::{Face, GlyphId, OutlineBuilder};

use super::coverage::{Contours, PixelPoint};

/// What stands for a character that no letter replaces.
const UNKNOWN: char = '?';

/// The slant of italics.
const SLANT: f64 = 0.2;

/// Characters that the font lacks, and others that look like them.
const ALIKE: [(char, char); 4] = [('∮', '∫'), ('ℓ', 'l'), ('∥', '‖'), ('𝕁', 'J')];

/// The fonts, scaled so that a letter is as wide as a cell.
pub(super) struct Font {
    regular: Option<Face<'static>>,
    bold: Option<Face<'static>>,
    cell: (f64, f64),
}

impl Font {
    pub(super) fn new(cell: (usize, usize)) -> Font {
        let face = |bytes: &'static [u8]| Face::parse(bytes, 0).ok();
        Font {
            regular: face(dejavu::sans_mono::regular()),
            bold: face(dejavu::sans_mono::bold()),
            cell: (cell.0 as f64, cell.1 as f64),
        }
    }

    /// The outline of a character in its cell.
    pub(super) fn outline(&self, character: char, bold: bool, italic: bool) -> Contours {
        let face = if bold { &self.bold } else { &self.regular };
        let Some(face) = face else { return Contours::default() };
        let Some(glyph) = find(face, character) else { return Contours::default() };
        let advance = face.glyph_hor_advance(glyph).map_or(1.0, f64::from);
        let across = self.cell.0 / advance;
        // small letters are as high as whole pixels, so that their tops are sharp
        let small = face.glyph_index('x').and_then(|x| face.glyph_bounding_box(x));
        let small = small.map_or(1.0, |bounds| f64::from(bounds.y_max));
        let up = (small * across).round().max(1.0) / small;
        let (above, below) = (f64::from(face.ascender()) * up, f64::from(-face.descender()) * up);
        let baseline = (above + 0.5 * (self.cell.1 - above - below)).round();
        let slant = if italic { SLANT } else { 0.0 };
        let mut pen = OutlinePen { contours: Contours::default(), across, up, baseline, slant };
        face.outline_glyph(glyph, &mut pen);
        pen.contours.close();
        pen.contours
    }
}

/// The glyph of a character, or of one that stands for it.
fn find(face: &Face<'_>, character: char) -> Option<GlyphId> {
    let alike = ALIKE.iter().find(|(rare, _)| *rare == character).map(|(_, other)| *other);
    [Some(character), alike, Some(UNKNOWN)].into_iter().flatten().find_map(|c| face.glyph_index(c))
}

/// Takes an outline in units of the font.
struct OutlinePen {
    contours: Contours,
    across: f64,
    up: f64,
    baseline: f64,
    slant: f64,
}

impl OutlinePen {
    fn place(&self, x: f32, y: f32) -> PixelPoint {
        let (x, y) = (f64::from(x), f64::from(y));
        // what is slanted keeps its middle
        let leaning = self.slant * (y * self.up - 0.4 * self.baseline);
        (x * self.across + leaning, self.baseline - y * self.up)
    }
}

impl OutlineBuilder for OutlinePen {
    fn move_to(&mut self, x: f32, y: f32) {
        let at = self.place(x, y);
        self.contours.begin(at);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let to = self.place(x, y);
        self.contours.line(to);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let (by, to) = (self.place(x1, y1), self.place(x, y));
        self.contours.curve(by, to);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        // TrueType has quadratic curves only; a cubic one is close to the quadratic one with the same middle
        let (a, b, to) = (self.place(x1, y1), self.place(x2, y2), self.place(x, y));
        self.contours.curve((0.5 * (a.0 + b.0), 0.5 * (a.1 + b.1)), to);
    }

    fn close(&mut self) {
        self.contours.close();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every letter and sign that phaselab prints has a shape of its own.
    #[test]
    fn no_sign_of_the_lab_is_unknown() {
        let signs = "AZaz09 αβγδεζηθικλμνξοπρςστυφχψωϑϕϵΓΔΘΛΞΠΣΦΨΩ⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻ⁿ₀₁₂₃₄₅₆₇₈₉₊₋ₓₘₙᵢⱼₖᵣᵀᴴᵏᵉ\
                     ′″½⅓⅔¼¾⅕⅖⅗⅘⅙⅚⅛⅜⅝⅞−·×÷±∓∂∇∫∮√∞∝≈≠≡≢≤≥∈∧⊥⊕⊙☉‖∥⟨⟩→←↑↓↔⇒⇔↦▶◀▲▼◆●○■•✓✗✦…–—‘’“”«»§°ẋẍẏżṗṙṡéüößøℓ𝕁";
        let font = Font::new((10, 20));
        let faces = [&font.regular, &font.bold].map(|face| face.as_ref().expect("a font"));
        for face in faces {
            let unknown = face.glyph_index(UNKNOWN);
            for sign in signs.chars() {
                assert!(find(face, sign).is_some_and(|glyph| Some(glyph) != unknown), "{sign}");
            }
            assert_eq!(find(face, '漢'), unknown);
        }
    }
}
