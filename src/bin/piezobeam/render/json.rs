//! JSON: one line per key, arrays on one line, numbers that read back to the same `f64`.

use std::io::{Result, Write};

use serde::Serialize;
use serde_json::ser::{CompactFormatter, Formatter, PrettyFormatter, Serializer};

use crate::extremes::Extremes;
use crate::report::{Report, Timing};

pub fn solve(report: &Report) -> String {
    write(report)
}

pub fn time(timing: &Timing) -> String {
    write(timing)
}

pub fn extremes(table: &Extremes) -> String {
    write(table)
}

fn write(value: &impl Serialize) -> String {
    let mut bytes = Vec::new();
    let mut serializer = Serializer::with_formatter(&mut bytes, Lines::default());
    value.serialize(&mut serializer).expect("plain data with string keys serializes into memory");
    bytes.push(b'\n');
    String::from_utf8(bytes).expect("serde_json writes UTF-8")
}

/// Objects as in pretty JSON, arrays as in compact JSON: a column of a million numbers is one line.
#[derive(Default)]
struct Lines(PrettyFormatter<'static>);

impl Formatter for Lines {
    fn begin_object<W: ?Sized + Write>(&mut self, w: &mut W) -> Result<()> {
        self.0.begin_object(w)
    }
    fn end_object<W: ?Sized + Write>(&mut self, w: &mut W) -> Result<()> {
        self.0.end_object(w)
    }
    fn begin_object_key<W: ?Sized + Write>(&mut self, w: &mut W, first: bool) -> Result<()> {
        self.0.begin_object_key(w, first)
    }
    fn begin_object_value<W: ?Sized + Write>(&mut self, w: &mut W) -> Result<()> {
        self.0.begin_object_value(w)
    }
    fn end_object_value<W: ?Sized + Write>(&mut self, w: &mut W) -> Result<()> {
        self.0.end_object_value(w)
    }
    fn begin_array_value<W: ?Sized + Write>(&mut self, w: &mut W, first: bool) -> Result<()> {
        CompactFormatter.begin_array_value(w, first)?;
        if first { Ok(()) } else { w.write_all(b" ") }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::fixture;
    use serde_json::Value;

    /// Positions of `keys` in `text` must increase.
    fn in_order(text: &str, keys: &[&str]) {
        let mut from = 0;
        for key in keys {
            let at = text[from..].find(&format!("\"{key}\":"));
            from += at.unwrap_or_else(|| panic!("{key} missing or out of order in\n{text}"));
        }
    }

    #[test]
    fn full_report() {
        let report = fixture::partial().report;
        let text = solve(&report);
        in_order(
            &text,
            &[
                "status",
                "reason",
                "iterations",
                "element_visits",
                "elements",
                "residual",
                "warnings",
                "samples",
                "x",
                "bending",
                "slope",
                "moment",
                "shear",
                "stretching",
                "potential",
                "axial_force",
                "electric_displacement",
                "contact",
                "zones",
                "force",
                "uniqueness",
                "certified",
                "margin_bending",
                "margin_electric",
                "resultants",
                "left",
                "right",
                "bending_energy",
                "equilibrium_error",
                "precision",
                "method",
                "name",
                "lowest_pressure",
                "sensitivities",
            ],
        );
        let value: Value = serde_json::from_str(&text).unwrap();
        assert_eq!(value["status"], "converged");
        assert_eq!(value["reason"], Value::Null);
        assert_eq!(value["contact"]["zones"][0][1], 0.3185);
        // Read as text: serde_json's own reader may round differently in the last digit.
        let line = text.lines().find_map(|l| l.trim().strip_prefix("\"bending\": [")).unwrap();
        let read = line.trim_end_matches("],").split(", ").map(|v| v.parse::<f64>().unwrap());
        assert!(read.eq(report.samples.bending.clone().unwrap()), "numbers must round-trip");
        assert!(text.contains("\"zones\": [[0.0, 0.3185]]"), "{text}");
    }

    #[test]
    fn absent_fields_are_null() {
        let value: Value = serde_json::from_str(&solve(&fixture::free().report)).unwrap();
        assert_eq!(value["contact"], Value::Null);
        assert_eq!(value["samples"]["potential"], Value::Null);
        assert_eq!(value["uniqueness"]["margin_bending"], Value::Null);
        assert_eq!(value["samples"].as_object().unwrap().len(), 9);
    }

    #[test]
    fn numbers_that_are_not_finite_are_null() {
        let mut report = fixture::partial().report;
        report.residual = f64::INFINITY;
        report.samples.bending.as_mut().unwrap()[1] = f64::NAN;
        report.samples.bending.as_mut().unwrap()[2] = -1.0 / 3.0;
        let value: Value = serde_json::from_str(&solve(&report)).unwrap();
        assert_eq!(value["residual"], Value::Null);
        assert_eq!(value["samples"]["bending"][1], Value::Null);
        assert_eq!(value["samples"]["bending"][2], -1.0 / 3.0);
    }

    #[test]
    fn derivatives() {
        let mut report = fixture::partial().report;
        report.sensitivities = Some(fixture::sensitivities());
        let value: Value = serde_json::from_str(&solve(&report)).unwrap();
        let found = &value["sensitivities"];
        assert_eq!(found["parameters"][1]["unit"], "N");
        assert_eq!(found["parameters"][0]["unit"], Value::Null);
        assert_eq!(found["outputs"][0]["derivatives"][1], -1.25e-6);
    }

    #[test]
    fn timing() {
        let timing = fixture::timing();
        let value: Value = serde_json::from_str(&time(&timing)).unwrap();
        assert_eq!(value["best_ns"], 81.2e3);
        assert_eq!(value["median_ns"], 90e3);
        assert_eq!(value["element_visits"], 406);
    }
}
