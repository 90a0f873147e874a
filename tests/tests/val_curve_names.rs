//! Names of random polygons against a second path: the curve as it stands, seen in another projection, with other invariants.
//!
//! The second path shares no code with the library: a projection along an axis, the determinant of Fox's matrix modulo another prime,
//! and the signatures of Levine and Tristram from Kashaev's matrix of the regions; expected values come from the planar diagrams of
//! KnotInfo, which the library does not use.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use nalgebra::{DMatrix, Rotation3, Vector3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use topo_knots::{KnotName, KnotTable, V, identify};

static PLANAR_DIAGRAMS: &str = include_str!("../../crates/topo-knots/data/pd.csv");

/// Prime of the second path.
const Q: u64 = (1 << 31) - 1;

/// A diagram: for each visit of a crossing along the curve its number and whether it is above, and the sign of each crossing.
#[derive(Clone, Default)]
struct Seen {
    visits: Vec<(usize, bool)>,
    signs: Vec<i32>,
}

/// Values to compare: Delta(t) Delta(1/t) modulo the prime, and signatures at two points of the circle.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Values {
    alexander: u64,
    signatures: [i32; 2],
}

impl Seen {
    /// The polygon along the z axis.
    fn of(x: &[V]) -> Self {
        let n = x.len();
        let mut along = Vec::new();
        let mut signs = Vec::new();
        for i in 0..n {
            for j in i + 2..n {
                if i == 0 && j == n - 1 {
                    continue;
                }
                let (a, b, c, d) = (x[i], x[(i + 1) % n], x[j], x[(j + 1) % n]);
                let (e, f, g) = (b - a, d - c, c - a);
                let turn = e.x * f.y - e.y * f.x;
                let s = (g.x * f.y - g.y * f.x) / turn;
                let t = (g.x * e.y - g.y * e.x) / turn;
                if s <= 0.0 || s >= 1.0 || t <= 0.0 || t >= 1.0 {
                    continue;
                }
                let first_is_over = a.z + s * e.z > c.z + t * f.z;
                let crossing = signs.len();
                along.push((i as f64 + s, (crossing, first_is_over)));
                along.push((j as f64 + t, (crossing, !first_is_over)));
                signs.push(if (turn > 0.0) == first_is_over { 1 } else { -1 });
            }
        }
        along.sort_by(|p, q| p.0.total_cmp(&q.0));
        Self {
            visits: along.into_iter().map(|(_, visit)| visit).collect(),
            signs,
        }
    }

    /// From a planar diagram, edges counterclockwise from the one that comes in below.
    fn planar(cell: &str) -> Self {
        let crossings: Vec<Vec<usize>> = cell
            .split(' ')
            .map(|c| c.split('-').map(|e| e.parse().unwrap()).collect())
            .collect();
        let n_edges = 2 * crossings.len();
        let mut seen = Self {
            visits: vec![(0, false); n_edges],
            signs: Vec::new(),
        };
        for (k, c) in crossings.iter().enumerate() {
            let positive = c[1] == c[3] % n_edges + 1;
            seen.visits[c[0] - 1] = (k, false);
            seen.visits[if positive { c[3] } else { c[1] } - 1] = (k, true);
            seen.signs.push(if positive { 1 } else { -1 });
        }
        seen
    }

    fn values(&self) -> Values {
        // Half a degree beside roots of unity of small order, where a signature may jump.
        let signature = |turn: f64| self.signature((0.5 * TAU * (turn + 0.5 / 360.0)).cos());
        Values {
            alexander: self.alexander(),
            signatures: [signature(0.5), signature(0.31)],
        }
    }

    /// Delta(t) Delta(1/t), which does not depend on what the determinant leaves open.
    fn alexander(&self) -> u64 {
        let t = 123_456_789;
        self.minor(t) * self.minor(inverse(t)) % Q
    }

    /// A first minor of Fox's matrix of the Wirtinger presentation.
    fn minor(&self, t: u64) -> u64 {
        let n = self.signs.len();
        let mut rows = vec![vec![0; n]; n];
        let mut arc = 0;
        let one_less_t = (1 + Q - t) % Q;
        for (crossing, over) in &self.visits {
            let row = &mut rows[*crossing];
            if *over {
                row[arc] = (row[arc] + one_less_t) % Q;
            } else {
                let after = (arc + 1) % n;
                let (from, to) = match self.signs[*crossing] > 0 {
                    true => (arc, after),
                    false => (after, arc),
                };
                row[from] = (row[from] + t) % Q;
                row[to] = (row[to] + Q - 1) % Q;
                arc = after;
            }
        }
        rows.truncate(n.saturating_sub(1));
        let mut product = 1;
        for k in 0..rows.len() {
            let Some(pivot) = (k..rows.len()).find(|i| rows[*i][k] != 0) else {
                return 0;
            };
            if pivot != k {
                rows.swap(pivot, k);
                product = (Q - product) % Q;
            }
            product = product * rows[k][k] % Q;
            let by = inverse(rows[k][k]);
            let (above, below) = rows.split_at_mut(k + 1);
            let top = &above[k];
            for row in below.iter_mut().filter(|row| row[k] != 0) {
                let factor = row[k] * by % Q;
                for j in k..n {
                    row[j] = (row[j] + (Q - factor) * top[j]) % Q;
                }
            }
        }
        product
    }

    /// Kashaev's matrix at x: half of its signature, less the writhe, is that of Levine and Tristram at the angle 2 acos x.
    fn signature(&self, x: f64) -> i32 {
        let n = self.signs.len();
        if n == 0 {
            return 0;
        }
        // Half-edges of a crossing counterclockwise from the one that leaves above.
        let slot = |(c, over): (usize, bool), leaves: bool| match (over, leaves) {
            (true, true) => 4 * c,
            (true, false) => 4 * c + 2,
            (false, _) => 4 * c + if leaves == (self.signs[c] > 0) { 1 } else { 3 },
        };
        let mut twin = vec![0; 4 * n];
        for (k, visit) in self.visits.iter().enumerate() {
            let next = self.visits[(k + 1) % self.visits.len()];
            let (p, q) = (slot(*visit, true), slot(next, false));
            (twin[p], twin[q]) = (q, p);
        }
        let mut region = vec![usize::MAX; 4 * n];
        let mut n_regions = 0;
        for start in 0..4 * n {
            let mut corner = start;
            while region[corner] == usize::MAX {
                region[corner] = n_regions;
                let far = twin[corner];
                corner = 4 * (far / 4) + (far + 3) % 4;
            }
            n_regions = n_regions.max(region[start] + 1);
        }
        let mut matrix = DMatrix::<f64>::zeros(n_regions, n_regions);
        for c in 0..n {
            // First the corner between the two strands that leave.
            let first = if self.signs[c] > 0 { 0 } else { 3 };
            for i in 0..4 {
                for j in 0..4 {
                    let entry = match (i % 2, j % 2) {
                        (0, 0) if i == j => 2.0 * x * x - 1.0,
                        (0, 0) | (1, 1) => 1.0,
                        _ => x,
                    };
                    let [p, q] = [i, j].map(|k| region[4 * c + (first + k) % 4]);
                    matrix[(p, q)] += f64::from(self.signs[c]) * entry;
                }
            }
        }
        let eigenvalues = matrix.symmetric_eigenvalues();
        let signature: i32 = eigenvalues
            .iter()
            .filter(|e| e.abs() > 1e-8)
            .map(|e| if *e > 0.0 { 1 } else { -1 })
            .sum();
        (signature - self.signs.iter().sum::<i32>()) / 2
    }
}

fn inverse(a: u64) -> u64 {
    let (mut power, mut result, mut exponent) = (a, 1, Q - 2);
    while exponent > 0 {
        if exponent & 1 == 1 {
            result = result * power % Q;
        }
        power = power * power % Q;
        exponent >>= 1;
    }
    result
}

/// What the second path must find for a name.
struct Expected(BTreeMap<&'static str, Values>);

impl Expected {
    fn new() -> Self {
        let row = |line: &'static str| {
            let (name, cell) = line.split_once(',').unwrap();
            (name, Seen::planar(cell).values())
        };
        Self(PLANAR_DIAGRAMS.lines().skip(1).map(row).collect())
    }

    fn of(&self, name: &KnotName) -> Values {
        let unknot = Values {
            alexander: 1,
            signatures: [0; 2],
        };
        let factors = name.factors().iter().filter(|f| f.knot != "0_1");
        factors.fold(unknot, |sum, factor| {
            let own = self.0[factor.knot.as_str()];
            let hand = if factor.mirrored { -1 } else { 1 };
            Values {
                alexander: sum.alexander * own.alexander % Q,
                signatures: [0, 1].map(|k| sum.signatures[k] + hand * own.signatures[k]),
            }
        })
    }
}

/// What was met.
#[derive(Debug, Default)]
struct Counts {
    curves: usize,
    knotted: usize,
    certain: usize,
    composite: usize,
    ten_crossings: usize,
}

impl Counts {
    /// Names a curve and, if the name is certain, compares it with the second path.
    fn check(&mut self, x: &[V], expected: &Expected, table: &KnotTable) {
        let kind = identify(x, table);
        self.curves += 1;
        let Ok(kind) = kind else {
            // Hundreds of crossings: refused, and never named.
            self.knotted += 1;
            return;
        };
        self.knotted += usize::from(!kind.is_unknot());
        if !kind.is_certain() {
            return;
        }
        let name = kind.candidates().next().unwrap();
        self.certain += 1;
        self.composite += usize::from(name.is_sum());
        self.ten_crossings += usize::from(name.factors()[0].knot.starts_with("10_"));
        let turn = Rotation3::from_euler_angles(0.7, -0.4, 1.9);
        let turned: Vec<V> = x.iter().map(|x| turn * x).collect();
        assert_eq!(
            Seen::of(&turned).values(),
            expected.of(name),
            "{name}: {x:?}"
        );
    }
}

fn random_polygon(n: usize, rng: &mut Pcg64) -> Vec<V> {
    let mut coordinate = || 2.0 * rng.random::<f64>() - 1.0;
    (0..n)
        .map(|_| V::new(coordinate(), coordinate(), coordinate()))
        .collect()
}

/// The closure of a braid word with two vertices a letter, shaken.
fn shaken_closure(word: &[i32], rng: &mut Pcg64) -> Vec<V> {
    let mut x = Vec::new();
    let mut place = 0;
    loop {
        for (k, g) in word.iter().enumerate() {
            let strand = g.unsigned_abs() as usize;
            let (next, lift) = match strand {
                s if s == place + 1 => (place + 1, g.signum()),
                s if s == place => (place - 1, -g.signum()),
                _ => (place, 0),
            };
            let at = |radius: f64, k: f64, z: f64| {
                let (sin, cos) = (TAU * k / word.len() as f64).sin_cos();
                V::new(radius * cos, radius * sin, z)
            };
            let middle = 3.0 + 0.5 * (place + next) as f64;
            x.push(at(3.0 + place as f64, k as f64, 0.0));
            x.push(at(middle, k as f64 + 0.5, 0.7 * f64::from(lift)));
            place = next;
        }
        if place == 0 {
            break;
        }
    }
    let mut noise = || 0.1 * rng.random::<f64>() - 0.05;
    x.iter_mut()
        .for_each(|x| *x += V::new(noise(), noise(), noise()));
    x
}

/// Random polygons of 5 to 60 vertices, sums and knots of ten crossings; what was met.
fn check_all(n_random: usize, n_sums: usize, n_ten: usize, seed: u64) -> Counts {
    let table = KnotTable::builtin();
    let expected = Expected::new();
    let mut rng = Pcg64::seed_from_u64(seed);
    let mut counts = Counts::default();
    for _ in 0..n_random {
        let n = rng.random_range(5..=60);
        counts.check(&random_polygon(n, &mut rng), &expected, &table);
    }
    let small: Vec<_> = table.primes_up_to(7).collect();
    let mut n_made = 0;
    while n_made < n_sums {
        let [a, b] = [0; 2].map(|_| small[rng.random_range(0..small.len())]);
        if a.crossing_number + b.crossing_number > 10 {
            continue;
        }
        let hand =
            |name: &str, is_mirrored: bool| format!("{}{name}", if is_mirrored { "m" } else { "" });
        let name = [a, b]
            .map(|k| hand(&k.name, rng.random_bool(0.5)))
            .join("#");
        let word = table.get(&name).unwrap().braid.clone();
        counts.check(&shaken_closure(&word, &mut rng), &expected, &table);
        n_made += 1;
    }
    for k in 0..n_ten {
        let hand = if rng.random_bool(0.5) { "m" } else { "" };
        let name = format!("{hand}10_{}", k % 165 + 1);
        let word = table.get(&name).unwrap().braid.clone();
        counts.check(&shaken_closure(&word, &mut rng), &expected, &table);
    }
    println!("{counts:?}");
    counts
}

#[test]
fn val_random_polygons_are_named_as_a_second_path_finds() {
    let counts = check_all(400, 40, 40, 5);
    assert!(counts.knotted > 100 && counts.composite >= 40 && counts.ten_crossings >= 40);
    assert!(counts.certain > 200);
}

#[test]
#[ignore = "long: 30 minutes"]
fn long_a_hundred_thousand_random_polygons_are_named_as_a_second_path_finds() {
    let counts = check_all(100_000, 500, 500, 9);
    assert!(counts.curves >= 100_000 && counts.knotted >= 10_000);
    assert!(counts.composite >= 500 && counts.ten_crossings >= 500);
}

/// The second path itself: the same from any side, and the signature of the right-handed trefoil.
#[test]
fn val_the_second_path_is_an_invariant() {
    let mut rng = Pcg64::seed_from_u64(3);
    for _ in 0..20 {
        let x = random_polygon(14, &mut rng);
        let views = [0.0, 0.9, 2.3].map(|angle| {
            let turn = Rotation3::new(Vector3::new(angle, 0.3 * angle, -angle));
            Seen::of(&x.iter().map(|x| turn * x).collect::<Vec<V>>()).values()
        });
        assert!(views.iter().all(|v| *v == views[0]), "{views:?}");
    }
    let expected = Expected::new();
    assert_eq!(expected.of(&KnotName::parse("3_1")).signatures[0], -2);
    assert_eq!(expected.of(&KnotName::parse("m3_1#m3_1")).signatures[0], 4);
}
