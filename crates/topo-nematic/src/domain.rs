//! The domain of one run: which cells are regular, which have cut links or faces, and what is beyond the walls.

use crate::tensor::{Tensor5, contract};
use crate::{Faces, Grid};

/// What lies beyond an outer face: link conductance (2 for a fixed value on the face, 0 for a free face) and values.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Wall {
    /// Conductance of the link from a cell centre to the face, in units of that between two cells.
    pub conductance: f64,
    /// Tensor on the face: one for all, or one for each cell along it (the lower axis runs faster).
    pub values: Vec<Tensor5>,
}

impl Wall {
    pub(crate) fn value(&self, index: usize) -> &Tensor5 {
        &self.values[if self.values.len() == 1 { 0 } else { index }]
    }
}

/// Walls at the lower and upper end of each axis; none where faces are periodic.
pub(crate) type Walls = [[Option<Wall>; 2]; 3];

/// A cell that does not have six whole links to other cells and its whole volume.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SpecialCell {
    pub cell: u32,
    /// Neighbours at -x, +x, -y, +y, -z, +z (the cell itself where there is none).
    pub neighbours: [u32; 6],
    /// Weights of the links to them, 1 for a whole face.
    pub weights: [f64; 6],
    /// Sum of the weights of links to fixed values, in the same unit.
    pub sink: f64,
    /// Sum of weight times fixed value.
    pub source: Tensor5,
    /// Sum of weight times square of the fixed value.
    pub offset: f64,
    /// Share of the energy of links to fixed values that is stored in weak anchoring.
    pub anchored: f64,
    /// Share of the cell that is fluid, by which bulk energy counts.
    pub volume: f64,
    /// Share by which its inertia against change counts.
    pub mass: f64,
}

impl SpecialCell {
    /// A link to the fixed value `q`.
    pub(crate) fn link_to(&mut self, weight: f64, q: &Tensor5) {
        self.sink += weight;
        for (s, x) in self.source.iter_mut().zip(q) {
            *s += weight * x;
        }
        self.offset += weight * contract(q, q);
    }

    /// Sum of all link weights.
    pub(crate) fn total_weight(&self) -> f64 {
        self.weights.iter().sum::<f64>() + self.sink
    }

    /// Mass that makes the cell no stiffer than a regular one.
    pub(crate) fn relaxation_mass(&self) -> f64 {
        self.mass.max(self.total_weight() / 6.0)
    }
}

/// What a cell is, from the particle's point of view.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Kind {
    Regular,
    Inactive,
    /// Weights, sink and volume; neighbours and walls are filled in by the domain.
    Special(Box<SpecialCell>),
}

/// A run of regular cells along x.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Run {
    pub start: u32,
    pub length: u32,
}

/// Regular cells as runs, special cells as a list, both by planes of constant z.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Domain {
    pub grid: Grid,
    pub walls: Walls,
    pub runs: Vec<Run>,
    pub special: Vec<SpecialCell>,
    run_offsets: Vec<usize>,
    special_offsets: Vec<usize>,
    /// Fluid volume in cells.
    pub total_volume: f64,
    /// Sum of masses.
    pub total_mass: f64,
    /// Cells that are part of the field.
    pub n_active: usize,
}

/// Steps to the six neighbours, in the order of links.
pub(crate) const STEPS: [(usize, bool); 6] = [
    (0, false),
    (0, true),
    (1, false),
    (1, true),
    (2, false),
    (2, true),
];

/// The neighbour of (i, j, k) in direction `link`; none beyond a wall.
pub(crate) fn neighbour(grid: &Grid, ijk: [usize; 3], link: usize) -> Option<[usize; 3]> {
    let (axis, up) = STEPS[link];
    let n = grid.cells()[axis];
    let x = ijk[axis];
    let next = match (up, grid.faces()[axis]) {
        (true, _) if x + 1 < n => x + 1,
        (false, _) if x > 0 => x - 1,
        (true, Faces::Periodic) => 0,
        (false, Faces::Periodic) => n - 1,
        (_, Faces::Wall) => return None,
    };
    let mut other = ijk;
    other[axis] = next;
    Some(other)
}

/// Index of the face cell that (i, j, k) touches along `axis`.
pub(crate) fn face_index(grid: &Grid, [i, j, k]: [usize; 3], axis: usize) -> usize {
    let [nx, ny, _] = grid.cells();
    match axis {
        0 => k * ny + j,
        1 => k * nx + i,
        _ => j * nx + i,
    }
}

impl Domain {
    /// The domain of `grid` between `walls`, whose cells are what `kind` says.
    pub(crate) fn new(grid: Grid, walls: Walls, kind: impl Fn([usize; 3]) -> Kind) -> Self {
        let [nx, ny, nz] = grid.cells();
        let mut domain = Self {
            grid,
            walls,
            runs: Vec::new(),
            special: Vec::new(),
            run_offsets: vec![0],
            special_offsets: vec![0],
            total_volume: 0.0,
            total_mass: 0.0,
            n_active: 0,
        };
        for k in 0..nz {
            for j in 0..ny {
                let mut start = None;
                for i in 0..nx {
                    let kind = kind([i, j, k]);
                    if kind == Kind::Regular {
                        start.get_or_insert(i);
                        domain.total_volume += 1.0;
                        domain.total_mass += 1.0;
                        domain.n_active += 1;
                        continue;
                    }
                    domain.end_run(start.take(), [i, j, k]);
                    if let Kind::Special(cell) = kind {
                        domain.add_special(*cell, [i, j, k]);
                    }
                }
                domain.end_run(start, [nx, j, k]);
            }
            domain.run_offsets.push(domain.runs.len());
            domain.special_offsets.push(domain.special.len());
        }
        domain
    }

    fn end_run(&mut self, start: Option<usize>, [end, j, k]: [usize; 3]) {
        if let Some(first) = start {
            self.runs.push(Run {
                start: self.grid.index([first, j, k]) as u32,
                length: (end - first) as u32,
            });
        }
    }

    fn add_special(&mut self, mut cell: SpecialCell, ijk: [usize; 3]) {
        cell.cell = self.grid.index(ijk) as u32;
        for link in 0..6 {
            match neighbour(&self.grid, ijk, link) {
                Some(other) => cell.neighbours[link] = self.grid.index(other) as u32,
                None => {
                    cell.neighbours[link] = cell.cell;
                    cell.weights[link] = 0.0;
                    let (axis, up) = STEPS[link];
                    if let Some(wall) = &self.walls[axis][usize::from(up)] {
                        let value = *wall.value(face_index(&self.grid, ijk, axis));
                        cell.link_to(wall.conductance, &value);
                    }
                }
            }
        }
        self.total_volume += cell.volume;
        self.total_mass += cell.mass;
        self.n_active += 1;
        self.special.push(cell);
    }

    /// Runs of regular cells in plane `k`.
    pub(crate) fn runs_of(&self, k: usize) -> &[Run] {
        &self.runs[self.run_offsets[k]..self.run_offsets[k + 1]]
    }

    /// Special cells of plane `k`.
    pub(crate) fn special_of(&self, k: usize) -> &[SpecialCell] {
        &self.special[self.special_offsets[k]..self.special_offsets[k + 1]]
    }

    /// Largest eigenvalue of the Laplacian, times h², by Gershgorin's theorem.
    pub(crate) fn stiffest(&self) -> f64 {
        let special = self
            .special
            .iter()
            .map(|s| (2.0 * s.weights.iter().sum::<f64>() + s.sink) / s.mass);
        special.fold(12.0 + self.stiffest_wall(), f64::max)
    }

    /// What walls may add to that of a regular cell: a cell in a corner has one link to each.
    pub(crate) fn stiffest_wall(&self) -> f64 {
        let walls = self.walls.iter().flatten().flatten();
        walls.map(|w| (w.conductance - 2.0).max(0.0)).sum()
    }

    /// The mass of each cell: its share in the sum of squares of the molecular field; 0 where there is no field.
    pub(crate) fn masses(&self) -> Vec<f64> {
        let mut masses = vec![0.0; self.grid.n_cells()];
        for run in &self.runs {
            masses[run.start as usize..(run.start + run.length) as usize].fill(1.0);
        }
        for special in &self.special {
            masses[special.cell as usize] = special.mass;
        }
        masses
    }

    /// Bytes of the lists.
    pub(crate) fn n_bytes(&self) -> u64 {
        let lists = std::mem::size_of_val(&self.runs[..])
            + std::mem::size_of_val(&self.special[..])
            + std::mem::size_of_val(&self.run_offsets[..])
            + std::mem::size_of_val(&self.special_offsets[..]);
        let walls: usize = self
            .walls
            .iter()
            .flatten()
            .flatten()
            .map(|w| std::mem::size_of_val(&w.values[..]))
            .sum();
        (lists + walls) as u64
    }
}
