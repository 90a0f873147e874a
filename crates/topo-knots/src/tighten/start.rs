//! Other embeddings of a braid word to start from.

use rand::RngExt;
use rand_pcg::Pcg64;

/// Edges, with more if the type was not kept, and steps of the descent of the Moebius energy that gives the second start.
pub(super) const MOEBIUS_EDGES: [usize; 2] = [320, 700];
pub(super) const MOEBIUS_STEPS: usize = 120;
/// Cancelling pairs of generators put into a word to vary its embedding.
pub(super) const N_PADS: usize = 2;
/// Generators up to which a word gets a further strand; more make long starts.
pub(super) const MOST_STRANDS: i32 = 4;

/// The word with pairs of a generator and its inverse put in at random places: the same braid, embedded with detours.
pub(super) fn padded(word: &[i32], rng: &mut Pcg64) -> Vec<i32> {
    let largest = word.iter().map(|g| g.abs()).max().unwrap_or(1);
    let mut padded = word.to_vec();
    for _ in 0..N_PADS {
        let sign = if rng.random_bool(0.5) { 1 } else { -1 };
        let generator = sign * rng.random_range(1..=largest);
        let place = rng.random_range(0..=padded.len());
        padded.splice(place..place, [generator, -generator]);
    }
    padded
}

/// The word after one to three of Markov's moves at random: a further strand, a conjugation, a cancelling pair.
///
/// The closure is the same knot, embedded in another way; a further strand often leads into a better basin.
pub(super) fn stabilised(word: &[i32], rng: &mut Pcg64) -> Vec<i32> {
    let mut word = word.to_vec();
    for k in 0..rng.random_range(1..=3) {
        let turn = rng.random_range(0..word.len());
        word.rotate_left(turn);
        let largest = word.iter().map(|g| g.abs()).max().unwrap_or(1);
        let sign = if rng.random_bool(0.5) { 1 } else { -1 };
        let generator = sign * rng.random_range(1..=largest);
        match if k == 0 { 0 } else { rng.random_range(0..3) } {
            0 if largest < MOST_STRANDS => word.push(sign * (largest + 1)),
            1 => {
                word.insert(0, generator);
                word.push(-generator);
            }
            _ => {
                let place = rng.random_range(0..=word.len());
                word.splice(place..place, [generator, -generator]);
            }
        }
    }
    word
}
