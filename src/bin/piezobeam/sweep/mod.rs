//! Many scenes that differ in some numbers: a table with a row for each.
//!
//! Rows are solved on all cores and kept in a journal as they come, so that a run that was interrupted goes on where
//! it was; the table is sorted and free of times, the same to the last byte however it came about.

mod grid;
mod journal;
#[cfg(feature = "parquet")]
pub mod parquet;
mod row;

pub use grid::{Shard, Vary};
pub use row::COLUMNS;

use crate::cli::SweepArgs;
use crate::report::CONVERGED;
use crate::scene_file::{Entries, Entry};
use grid::Grid;
use indicatif::ProgressBar;
use journal::Journal;
use rayon::ThreadPoolBuilder;
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use row::Solve;
use std::collections::BTreeMap;
use std::error::Error;
use std::sync::{Mutex, PoisonError};

/// The solved scenes.
pub struct Table {
    pub vary: Vec<Vary>,
    /// Lines of CSV, each with its end.
    rows: BTreeMap<usize, String>,
    shard: Shard,
    journal: Option<Journal>,
}

impl Table {
    /// The table as CSV; of a shard that is not the first, without the header.
    pub fn csv(&self) -> String {
        let header = if self.shard.is_first() { row::header(&self.vary) } else { String::new() };
        self.rows.values().fold(header, |csv, row| csv + row)
    }

    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// The cells of all rows.
    pub fn cells(&self) -> Vec<csv::StringRecord> {
        let text: String = self.rows.values().map(String::as_str).collect();
        let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(text.as_bytes());
        reader.records().filter_map(Result::ok).collect()
    }

    /// Rows that are no solution.
    pub fn failed(&self) -> usize {
        let status = self.vary.len();
        self.cells().iter().filter(|cells| cells.get(status) != Some(CONVERGED)).count()
    }

    /// Takes the journal away, after the table was written.
    pub fn finish(self) {
        if let Some(journal) = self.journal {
            journal.remove();
        }
    }
}

/// Solves what is left to solve, and shows on `bar` how far it is.
///
/// # Errors
/// A scene that is none as it is, numbers that it does not have, a journal that cannot be written. What the varied values
/// make wrong is a row of the table.
pub fn run(args: &SweepArgs, bar: &ProgressBar) -> Result<Table, Box<dyn Error>> {
    let entries = Entries::read(&args.scene)?;
    let varied = args.vary.iter().map(|one| entries.entry(&one.path)).collect::<Result<Vec<_>, _>>()?;
    let grid = Grid::new(&args.vary)?;
    let range = grid.rows(args.shard);

    let journal = match &args.out {
        Some(out) => Some(Journal::open(out, &key(args, &entries), range.clone())?),
        None => None,
    };
    let done = journal.as_ref().map(|journal| journal.rows().clone()).unwrap_or_default();
    let left: Vec<usize> = range.clone().filter(|row| !done.contains_key(row)).collect();
    bar.set_length(range.len() as u64);
    bar.set_position(done.len() as u64);
    bar.reset_eta();

    let sheet = Mutex::new((journal, done));
    let pool = ThreadPoolBuilder::new().num_threads(args.jobs.unwrap_or(0)).build()?;
    let solved = pool.install(|| {
        left.into_par_iter().try_for_each(|row| {
            let values = grid.values(row);
            let line = row::line(&values, &solve(args, &entries, &varied, &values));
            // What a thread that panicked left is whole: lines are added at once.
            let mut sheet = sheet.lock().unwrap_or_else(PoisonError::into_inner);
            let (journal, done) = &mut *sheet;
            if let Some(journal) = journal {
                journal.add(row, &line)?;
            }
            done.insert(row, line);
            bar.inc(1);
            Ok::<(), journal::JournalError>(())
        })
    });
    bar.finish_and_clear();
    solved?;
    let (journal, rows) = sheet.into_inner().unwrap_or_else(PoisonError::into_inner);
    Ok(Table { vary: args.vary.clone(), rows, shard: args.shard, journal })
}

/// One scene; what is wrong with it is its row.
fn solve(args: &SweepArgs, entries: &Entries, varied: &[Entry], values: &[f64]) -> row::Found {
    let pairs: Vec<_> = varied.iter().cloned().zip(values.iter().copied()).collect();
    let file = match entries.with(&pairs) {
        Ok(file) => file,
        Err(error) => return row::Found::bad(&error),
    };
    let task = Solve { stop: args.stop, method: args.method };
    crate::model::with(&file, args.elements, args.precision, task)
        .unwrap_or_else(|error| row::Found::bad(&file.complaint(&error)))
}

/// All that decides what the rows are.
fn key(args: &SweepArgs, entries: &Entries) -> String {
    let SweepArgs { vary, shard, elements, precision, stop, method, .. } = args;
    let asked = format!("{vary:?} {shard:?} {elements:?} {precision:?} {stop:?} {method:?}");
    format!("{}\n{asked}\n{}", env!("CARGO_PKG_VERSION"), entries.text())
}
