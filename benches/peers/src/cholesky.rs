//! The peers' linear algebra: sparse Cholesky factors on a pattern that is analysed once.

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::sparse::linalg::cholesky::{
    LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMat};
use faer::{Conj, MatMut, Par, Side};
use nalgebra::DMatrixViewMut;
use nalgebra_sparse::CscMatrix;
use nalgebra_sparse::factorization::CscCholesky;

/// The columns of a symmetric matrix of blocks, block tridiagonal, as a library wants to have them.
pub struct Pattern {
    pub starts: Vec<usize>,
    pub rows: Vec<usize>,
    room: Room,
}

/// What a library has room for, and what it reads.
#[derive(Clone, Copy, PartialEq)]
pub enum Room {
    /// The upper triangle for both.
    Upper,
    /// Both triangles, of which the lower one is read.
    Both,
}

impl Pattern {
    pub fn block_tridiagonal(blocks: usize, size: usize, room: Room) -> Self {
        let mut pattern = Self { starts: vec![0], rows: Vec::new(), room };
        for column in 0..blocks * size {
            let block = column / size;
            let end = if room == Room::Upper { column + 1 } else { (block + 2).min(blocks) * size };
            pattern.rows.extend(block.saturating_sub(1) * size..end);
            pattern.starts.push(pattern.rows.len());
        }
        pattern
    }

    /// Where the values have the entry (i, j) or (j, i), whichever is read; a column's rows follow one another.
    pub fn slot(&self, i: usize, j: usize) -> usize {
        let (row, column) = match self.room {
            Room::Upper => (i.min(j), i.max(j)),
            Room::Both => (i.max(j), i.min(j)),
        };
        let start = self.starts[column];
        start + row - self.rows[start]
    }

    pub fn order(&self) -> usize {
        self.starts.len() - 1
    }
}

/// A pivot is not positive.
#[derive(Debug)]
pub struct NotDefinite;

/// A library's Cholesky factor of a matrix.
pub trait Cholesky {
    const ROOM: Room;
    /// Analyses the pattern.
    fn new(pattern: &Pattern) -> Self;
    fn factor(&mut self, values: &[f64]) -> Result<(), NotDefinite>;
    /// In place; at most two right-hand sides, one after the other.
    fn solve(&mut self, sides: &mut [f64]);
}

/// Its own memory kept from factor to factor, and no reordering, which would be slower here: a band has no fill.
pub struct Faer {
    pattern: SymbolicSparseColMat<usize>,
    symbolic: SymbolicCholesky<usize>,
    factor: Vec<f64>,
    scratch: MemBuffer,
}

impl Cholesky for Faer {
    const ROOM: Room = Room::Upper;

    fn new(pattern: &Pattern) -> Self {
        let n = pattern.order();
        let (starts, rows) = (pattern.starts.clone(), pattern.rows.clone());
        let pattern = SymbolicSparseColMat::new_checked(n, n, starts, None, rows);
        let order = SymmetricOrdering::Identity;
        let symbolic = factorize_symbolic_cholesky(pattern.as_ref(), Side::Upper, order, Default::default())
            .expect("enough memory");
        let scratch = MemBuffer::new(StackReq::any_of(&[
            symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default()),
            symbolic.solve_in_place_scratch::<f64>(2, Par::Seq),
        ]));
        Self { pattern, factor: vec![0.0; symbolic.len_val()], symbolic, scratch }
    }

    fn factor(&mut self, values: &[f64]) -> Result<(), NotDefinite> {
        let matrix = SparseColMatRef::new(self.pattern.as_ref(), values);
        let (plain, stack) = (Default::default(), MemStack::new(&mut self.scratch));
        self.symbolic
            .factorize_numeric_llt(
                &mut self.factor,
                matrix,
                Side::Upper,
                plain,
                Par::Seq,
                stack,
                Default::default(),
            )
            .map(drop)
            .map_err(|_| NotDefinite)
    }

    fn solve(&mut self, sides: &mut [f64]) {
        let n = self.symbolic.nrows();
        let count = sides.len() / n;
        let sides = MatMut::from_column_major_slice_mut(sides, n, count);
        let stack = MemStack::new(&mut self.scratch);
        LltRef::new(&self.symbolic, &self.factor).solve_in_place_with_conj(Conj::No, sides, Par::Seq, stack);
    }
}

/// It never reorders.
pub struct Nalgebra(CscCholesky<f64>);

impl Cholesky for Nalgebra {
    const ROOM: Room = Room::Both;

    fn new(pattern: &Pattern) -> Self {
        let n = pattern.order();
        // There is no pattern without values.
        let mut identity = vec![0.0; pattern.rows.len()];
        (0..n).for_each(|i| identity[pattern.slot(i, i)] = 1.0);
        let matrix =
            CscMatrix::try_from_csc_data(n, n, pattern.starts.clone(), pattern.rows.clone(), identity)
                .expect("a pattern");
        Self(CscCholesky::factor(&matrix).expect("the identity"))
    }

    fn factor(&mut self, values: &[f64]) -> Result<(), NotDefinite> {
        self.0.refactor(values).map_err(|_| NotDefinite)
    }

    fn solve(&mut self, sides: &mut [f64]) {
        let n = self.0.l().nrows();
        let count = sides.len() / n;
        self.0.solve_mut(DMatrixViewMut::from_slice(sides, n, count));
    }
}
