//! The token by which an importer knows that description and binary belong together.

/// A token of all these bytes, in the form of a UUID: FNV-1a of 128 bits. It guards against mistakes, not against attacks.
pub(crate) fn token<'a>(files: impl Iterator<Item = &'a Vec<u8>>) -> String {
    let (mut hash, prime) =
        (0x6c62_272e_07bb_0142_62b8_2175_6295_c58d_u128, 0x0000_0000_0100_0000_0000_0000_0000_013b_u128);
    for bytes in files {
        for byte in bytes.iter().copied().chain([0]) {
            hash = (hash ^ u128::from(byte)).wrapping_mul(prime);
        }
    }
    let digits = format!("{hash:032x}");
    let parts = [&digits[..8], &digits[8..12], &digits[12..16], &digits[16..20], &digits[20..]];
    format!("{{{}}}", parts.join("-"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The values of the authors' test suite, of `a` and of the empty text, each here with the zero that ends a file.
    #[test]
    fn tokens_are_known_and_differ() {
        assert_eq!(token(std::iter::empty()), "{6c62272e-07bb-0142-62b8-21756295c58d}");
        let [a, b] = [b"a".to_vec(), b"b".to_vec()];
        assert_ne!(token([&a, &b].into_iter()), token([&b, &a].into_iter()));
    }
}
