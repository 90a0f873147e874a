//! Inversions in spheres: other embeddings of the same knot, to start a search from.

use rand::RngExt;
use rand_pcg::Pcg64;

use crate::curves::Curves;
use crate::{KnotError, V};

/// Vertices of an inverted curve.
const N_VERTICES: usize = 600;
/// Centres that are tried for one curve.
const MOST_TRIALS: usize = 200;
/// Largest number of centres of which the one furthest from the curve is taken.
const MOST_COMPARED: usize = 12;
/// A longer curve has strands too thin for its vertices, and would take long to tighten.
const LONGEST: f64 = 500.0;

/// Inverts closed curves in a sphere around a random point between its strands; `None` if no point gives a curve that is thick
/// enough.
///
/// ```math
/// x \mapsto S \frac{x - p}{|x - p|^2}, \qquad S = \mathrm{diag}(1, 1, -1)
/// ```
///
/// The reflection undoes the change of handedness. The inversion keeps the Möbius energy of a curve, but another part of the
/// knot becomes its outside: the point lies in a face of the diagram, which becomes the outer one. Tightening keeps that face
/// outside, so that each face may lead to another basin.
///
/// # Errors
/// [`KnotError::Curve`] if the curves cannot be resampled.
///
/// # Validation
/// `inversions_keep_the_type_and_change_the_shape`
///
/// # References
/// `freedman1994`
pub(crate) fn inverted(curves: &Curves, rng: &mut Pcg64) -> Result<Option<Curves>, KnotError> {
    let fine = curves.resampled(N_VERTICES)?;
    let x = fine.vertices();
    let tau = curves.thickness().tau;
    for _ in 0..MOST_TRIALS {
        let mut best = (0.0, V::zeros());
        for _ in 0..rng.random_range(1..MOST_COMPARED) {
            let (a, b) = (rng.random_range(0..x.len()), rng.random_range(0..x.len()));
            let u = rng.random_range(0.3..0.7);
            let mut random = || tau * rng.random_range(-1.0..1.0);
            let aside = V::new(random(), random(), random());
            let centre = x[a] * u + x[b] * (1.0 - u) + aside;
            let room = x
                .iter()
                .map(|x| (x - centre).norm())
                .fold(f64::INFINITY, f64::min);
            if room > best.0 {
                best = (room, centre);
            }
        }
        let (room, centre) = best;
        if room == 0.0 {
            continue;
        }
        let image = x.iter().map(|x| {
            let y = (x - centre) * (room / (x - centre).norm()).powi(2);
            V::new(y.x, y.y, -y.z)
        });
        // Edges that are far from equal: the centre was too near the curve.
        let image = fine.with_vertices(image);
        let Some(Ok(image)) = image.map(|image| image.resampled(N_VERTICES)) else {
            continue;
        };
        if image.length() < LONGEST * image.thickness().tau {
            return Ok(Some(image));
        }
    }
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{KnotTable, relax_moebius};
    use rand::SeedableRng;

    #[test]
    fn inversions_keep_the_type_and_change_the_shape() {
        let table = KnotTable::builtin();
        let mut rng = Pcg64::seed_from_u64(2);
        for name in ["3_1", "5_2"] {
            let knot = table.get(name).expect("known");
            let start = knot.start_curve().expect("a curve");
            let round = Curves::from(relax_moebius(&start, 200, 100).expect("relaxed"));
            // Length over the largest distance: the shape, whatever its size and place.
            let spread = |curve: &Curves| {
                let curve = &curve.parts()[0];
                let middle = curve.centroid();
                let far = |x: &V| (x - middle).norm();
                curve.length() / curve.vertices().iter().map(far).fold(0.0, f64::max)
            };
            let mut spreads = vec![spread(&round)];
            for _ in 0..4 {
                let curve = inverted(&round, &mut rng).expect("a curve").expect("fair");
                // The handedness too: the signature changes sign under reflection.
                knot.verify(&curve.parts()[0]).expect("the same knot");
                spreads.push(spread(&curve));
            }
            spreads.sort_by(f64::total_cmp);
            assert!(spreads[4] > 1.1 * spreads[0], "{name}: {spreads:?}");
        }
    }
}
