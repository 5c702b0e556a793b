//! The table as a Parquet file: one row group, no compression, empty cells as nulls.

use super::Table;
use super::row::{COLUMNS, Kind};
use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::column::writer::ColumnWriter;
use parquet::data_type::ByteArray;
use parquet::errors::Result;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use std::sync::Arc;

/// The bytes of the file.
pub fn bytes(table: &Table) -> Result<Vec<u8>> {
    let varied = table.vary.iter().map(|one| (one.path.as_str(), Kind::Number));
    let columns: Vec<_> = varied.chain(COLUMNS.map(|(name, _, kind)| (name, kind))).collect();
    let fields =
        columns.iter().map(|&(name, kind)| field(name, kind).map(Arc::new)).collect::<Result<_>>()?;
    let schema = Arc::new(Type::group_type_builder("sweep").with_fields(fields).build()?);
    let properties = Arc::new(WriterProperties::builder().build());
    let mut writer = SerializedFileWriter::new(Vec::new(), schema, properties)?;
    let cells = table.cells();
    let mut group = writer.next_row_group()?;
    for i in 0..columns.len() {
        let Some(mut column) = group.next_column()? else { break };
        let column_cells: Vec<&str> = cells.iter().map(|row| row.get(i).unwrap_or_default()).collect();
        // 1 where there is a value, 0 where there is none.
        let levels: Vec<i16> = column_cells.iter().map(|cell| i16::from(!cell.is_empty())).collect();
        let there = || column_cells.iter().filter(|cell| !cell.is_empty());
        match column.untyped() {
            ColumnWriter::DoubleColumnWriter(writer) => {
                let values: Vec<f64> = there().map(|cell| cell.parse().unwrap_or(f64::NAN)).collect();
                writer.write_batch(&values, Some(&levels), None)?;
            }
            ColumnWriter::Int64ColumnWriter(writer) => {
                let values: Vec<i64> = there().map(|cell| cell.parse().unwrap_or(-1)).collect();
                writer.write_batch(&values, Some(&levels), None)?;
            }
            ColumnWriter::ByteArrayColumnWriter(writer) => {
                let values: Vec<ByteArray> = there().map(|&cell| cell.into()).collect();
                writer.write_batch(&values, Some(&levels), None)?;
            }
            _ => {}
        }
        column.close()?;
    }
    group.close()?;
    writer.into_inner()
}

fn field(name: &str, kind: Kind) -> Result<Type> {
    let (physical, logical) = match kind {
        Kind::Number => (Physical::DOUBLE, None),
        Kind::Count => (Physical::INT64, None),
        Kind::Text => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
    };
    Type::primitive_type_builder(name, physical)
        .with_repetition(Repetition::OPTIONAL)
        .with_logical_type(logical)
        .build()
}
