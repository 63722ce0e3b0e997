//! Random numbers that depend only on a seed and on the index of a member.

use rand_chacha::ChaCha12Rng;
use rand_chacha::rand_core::SeedableRng;

/// The random numbers of a member: a stream of its own from ChaCha with 12 rounds [Bernstein 2008],
/// keyed by the seed.
///
/// Streams of different members, and of different seeds, do not overlap. The numbers of a member
/// depend neither on the thread nor on the number of members.
/// ```
/// use pc_solve::member_stream;
/// use rand_chacha::rand_core::Rng;
///
/// let first = |seed, member| member_stream(seed, member).next_u64();
/// assert_eq!(first(1, 7), first(1, 7));
/// assert!(first(1, 7) != first(1, 8) && first(1, 7) != first(2, 7));
/// ```
pub fn member_stream(seed: u64, member: u64) -> ChaCha12Rng {
    let mut stream = ChaCha12Rng::seed_from_u64(seed);
    stream.set_stream(member);
    stream
}
