//! CSV: a header with the names of the JSON report, then one row per sample; empty cells where JSON has `null`.

use csv::Writer;

use crate::report::Samples;

const HEADER: [&str; 9] = [
    "x",
    "bending",
    "slope",
    "moment",
    "shear",
    "stretching",
    "potential",
    "axial_force",
    "electric_displacement",
];

pub fn solve(samples: &Samples) -> String {
    write(samples).expect("numbers and plain names go into memory as CSV")
}

fn write(samples: &Samples) -> csv::Result<String> {
    let fields = super::fields(samples).map(|field| field.values);
    let mut writer = Writer::from_writer(Vec::new());
    writer.write_record(HEADER)?;
    for (i, &x) in samples.x.iter().enumerate() {
        let field = |values: Option<&[f64]>| values.and_then(|v| v.get(i)).copied();
        let cells = std::iter::once(Some(x)).chain(fields.map(field));
        let row: Vec<_> = cells.map(|v| v.filter(|v| v.is_finite())).collect();
        writer.serialize(row)?;
    }
    let bytes = writer.into_inner().map_err(|e| e.into_error())?;
    Ok(String::from_utf8(bytes).expect("ASCII names and numbers"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::fixture;

    #[test]
    fn rows_and_empty_cells() {
        let samples = Samples {
            x: vec![0.0, 0.5, 1.0],
            bending: Some(vec![0.0, 1.0 / 3.0, f64::NAN]),
            slope: Some(vec![1e-300, -2.0, 3.0]),
            potential: Some(vec![1.0, 2.0, 3.0]),
            ..Samples::default()
        };
        assert_eq!(
            solve(&samples),
            "x,bending,slope,moment,shear,stretching,potential,axial_force,electric_displacement\n\
             0.0,0.0,1e-300,,,,1.0,,\n\
             0.5,0.3333333333333333,-2.0,,,,2.0,,\n\
             1.0,,3.0,,,,3.0,,\n"
        );
    }

    #[test]
    fn header_has_the_names_of_the_json_report() {
        let json = serde_json::to_value(Samples::default()).unwrap();
        let mut names: Vec<_> = json.as_object().unwrap().keys().cloned().collect();
        let mut header = HEADER.to_vec();
        names.sort();
        header.sort_unstable();
        assert_eq!(names, header);
    }

    #[test]
    fn numbers_read_back() {
        let samples = fixture::partial().report.samples;
        let text = solve(&samples);
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let rows: Vec<_> = reader.records().map(Result::unwrap).collect();
        assert_eq!(rows.len(), samples.x.len());
        for (row, &moment) in rows.iter().zip(samples.moment.as_ref().unwrap()) {
            assert_eq!(row[3].parse::<f64>().unwrap(), moment);
        }
    }
}
