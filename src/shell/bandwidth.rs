//! Bandwidth: how many bytes per second may be sent to the terminal.
//!
//! In: the user's notation, `16k`. Out: bytes per second. Never here: enforcing the limit.

use std::str::FromStr;

/// A limit on the bytes sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bandwidth {
    /// As much as the terminal takes.
    Unlimited,
    /// This many bytes per second.
    Bytes(u32),
}

/// The minimum, in bytes per second: two frames per second with a few changed cells need this much.
const LEAST: u32 = 1024;

/// The error for an invalid bandwidth.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{0}` is not a bandwidth: write bytes a second from 1k on, such as `16k` or `1M`, or `off`"
)]
pub struct BandwidthError(String);

impl Bandwidth {
    /// Returns the bytes per second, or `None` if there is no limit.
    pub fn bytes(self) -> Option<u32> {
        match self {
            Self::Unlimited => None,
            Self::Bytes(bytes) => Some(bytes),
        }
    }
}

impl FromStr for Bandwidth {
    type Err = BandwidthError;

    /// Parses bytes per second, with `k` for 1024 and `M` for 1024² of them, or `off`.
    fn from_str(text: &str) -> Result<Self, BandwidthError> {
        if text == "off" {
            return Ok(Self::Unlimited);
        }
        let (digits, unit) = match text.char_indices().next_back() {
            Some((at, 'k' | 'K')) => (&text[..at], 1024),
            Some((at, 'm' | 'M')) => (&text[..at], 1024 * 1024),
            _ => (text, 1),
        };
        let plain = digits.bytes().all(|b| b.is_ascii_digit());
        let number = digits.parse().ok().filter(|_| plain);
        let bytes = number.and_then(|number: u32| number.checked_mul(unit));
        bytes
            .filter(|b| *b >= LEAST)
            .map(Self::Bytes)
            .ok_or_else(|| BandwidthError(text.to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bandwidths_are_read() {
        let read = |text: &str| text.parse::<Bandwidth>().ok();
        assert_eq!(read("16k"), Some(Bandwidth::Bytes(16 * 1024)));
        assert_eq!(read("1M"), Some(Bandwidth::Bytes(1024 * 1024)));
        assert_eq!(read("20000"), Some(Bandwidth::Bytes(20_000)));
        assert_eq!(read("off"), Some(Bandwidth::Unlimited));
        for wrong in ["", "k", "+16k", "-1", "1.5k", "16 k", "1023", "0", "99999M", "16kB", "θ"] {
            assert_eq!(read(wrong), None, "{wrong}");
        }
        let why = "16kB".parse::<Bandwidth>().expect_err("no bandwidth").to_string();
        assert!(why.contains("`16kB`") && why.contains("`16k`"), "{why}");
    }
}
