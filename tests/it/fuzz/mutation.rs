//! Random mutations: bytes replaced, pieces cut, copied, repeated and mixed, keywords of the format inserted.

use super::dice::Dice;

/// The greatest length of a mutated input, in bytes.
const LONGEST: usize = 16 * 1024;

/// Boundary cases of numbers and texts.
const EDGES: [&str; 18] = [
    "0",
    "-1",
    "1e308",
    "-1e-320",
    "1e999",
    "nan",
    "inf",
    "65535",
    "65536",
    "4294967296",
    "-9223372036854775808",
    "18446744073709551616",
    "0.1e-9999999999",
    "\u{0}",
    "\u{feff}",
    "θ\u{307}",
    "\u{202e}",
    "👩‍🔬",
];

/// One of the inputs, mutated in one to six places.
pub(crate) fn mutant(dice: &mut Dice, inputs: &[Vec<u8>], words: &[&str]) -> Vec<u8> {
    let mut bytes = inputs[dice.below(inputs.len())].clone();
    for _ in 0..=dice.below(6) {
        change(dice, &mut bytes, inputs, words);
        bytes.truncate(LONGEST);
    }
    bytes
}

fn change(dice: &mut Dice, bytes: &mut Vec<u8>, inputs: &[Vec<u8>], words: &[&str]) {
    let place = dice.below(bytes.len() + 1);
    let piece = place..(place + 1 + dice.below(40)).min(bytes.len());
    match dice.below(9) {
        0 if place < bytes.len() => bytes[place] = dice.next() as u8,
        1 if place < bytes.len() => bytes[place] ^= 1 << dice.below(8),
        2 => drop(bytes.drain(piece)),
        3 => {
            let copy = bytes[piece].to_vec();
            let to = dice.below(bytes.len() + 1);
            bytes.splice(to..to, copy);
        }
        4 => {
            let copy = bytes[piece.clone()].repeat(1 << dice.below(8));
            bytes.splice(piece.end..piece.end, copy);
        }
        5 => {
            let other = &inputs[dice.below(inputs.len())];
            let from = dice.below(other.len() + 1);
            bytes.truncate(place);
            bytes.extend(&other[from..]);
        }
        6 => {
            // a number becomes another
            let digit = |byte: &u8| byte.is_ascii_digit() || *byte == b'.';
            let Some(start) = bytes[place..].iter().position(digit) else { return };
            let start = place + start;
            let length = bytes[start..].iter().take_while(|byte| digit(byte)).count();
            bytes.splice(start..start + length, dice.pick(&EDGES).bytes());
        }
        _ => {
            let word = if dice.chance(0.2) { dice.pick(&EDGES) } else { dice.pick(words) };
            bytes.splice(place..place, word.bytes());
        }
    }
}

/// Shrinks a failing input: pieces are left out as long as it fails, in at most `looks` attempts.
pub(crate) fn shrunk(mut bytes: Vec<u8>, mut looks: u32, fails: &dyn Fn(&[u8]) -> bool) -> Vec<u8> {
    let mut length = bytes.len() / 2;
    while length > 0 {
        let mut at = 0;
        while at + length <= bytes.len() {
            if looks == 0 {
                return bytes;
            }
            looks -= 1;
            let mut less = bytes.clone();
            less.drain(at..at + length);
            if fails(&less) { bytes = less } else { at += length }
        }
        length /= 2;
    }
    bytes
}
