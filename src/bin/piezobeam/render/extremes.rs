//! The table of extremes: as text for a terminal, as a document in Markdown.

use std::fmt::Write;

use comfy_table::{CellAlignment, Table, presets};

use super::{capital, significant, text::lines};
use crate::extremes::{Extremes, Row, Verdict};

const HEADER: [&str; 10] =
    ["case", "N", "type", "expected", "status", "residual", "error", "u, q", "visits / cap", "verdict"];

const INTRODUCTION: &str = "\
What the solver does at the edges of what can be asked of it: data of extreme sizes, contact that is hard to
decide, meshes that are bad. Each row is one scene on one mesh; the table is computed, not written, and the command
exits with 1 if a row is `wrong`.

*N* is the number of elements, nodes at breaks included. *expected* is what the row is held to: an error, a status, or
a refusal that names a field. *error* is the largest error of the bending over the largest bending, *u, q* the larger
of the same two of stretching and potential where they are known, both against what *reference* says: a closed form,
the limit of one, 16 digits by another method (`suite`, see `tests/reference`), the same scene in other units, or
our own solution on a finer mesh, which shows convergence and no more. *visits* are elements whose matrices were
evaluated or re-factored, with the most that is allowed. A row is `wrong` that did not end as expected, and one that
is called converged with a residual above the tolerance, a field that is not finite, or a foundation that pulls.
";

/// For people at a terminal.
pub fn text(table: &Extremes) -> String {
    let mut out = String::new();
    for group in &table.groups {
        let _ = writeln!(out, "{}", group.name);
        let mut rows = Table::new();
        rows.load_style(presets::NOTHING);
        rows.set_header(HEADER);
        for row in &group.rows {
            rows.add_row(cells(row));
        }
        for column in rows.column_iter_mut().skip(5).take(4) {
            column.set_cell_alignment(CellAlignment::Right);
        }
        out += &lines(rows);
        for row in group.rows.iter().filter(|row| row.verdict == Verdict::Wrong) {
            let Row { case, elements, precision, remarks, .. } = row;
            let _ = writeln!(out, "wrong: {case}, N = {elements}, {precision}: {}", remarks.join("; "));
        }
        out.push('\n');
    }
    let _ = writeln!(out, "{}", summary(table));
    out
}

/// As a document.
pub fn markdown(table: &Extremes) -> String {
    let quick = if table.quick { " --quick" } else { "" };
    let mut out = format!(
        "# Extremes\n\n`cargo beam extremes{quick} --format markdown --out docs/extremes.md --force`\n\n{INTRODUCTION}\n{}\n",
        summary(table)
    );
    for group in &table.groups {
        let _ = writeln!(out, "\n## {}\n\n{}\n", capital(group.name), group.comment);
        let _ = writeln!(out, "| {} | reference | remarks |", HEADER.join(" | "));
        let _ = writeln!(out, "|{}", "---|".repeat(HEADER.len() + 2));
        for row in &group.rows {
            let cells = cells(row).map(|cell| cell.replace('|', "\\|"));
            let _ =
                writeln!(out, "| {} | {} | {} |", cells.join(" | "), row.reference, row.remarks.join("; "));
        }
    }
    out
}

fn summary(table: &Extremes) -> String {
    let count = |verdict| table.groups.iter().flat_map(|g| &g.rows).filter(|r| r.verdict == verdict).count();
    let [ok, refused] = [Verdict::Ok, Verdict::Refused].map(count);
    format!("{} rows: {ok} ok, {refused} refused, {} wrong.", table.rows, table.wrong)
}

fn cells(row: &Row) -> [String; 10] {
    let number = |value: Option<f64>| value.map_or("-".into(), |v| significant(v, 2));
    let visits = row.element_visits.map_or("-".into(), |visits| format!("{visits} / {}", row.visits_cap));
    [
        row.case.clone(),
        row.elements.to_string(),
        row.precision.into(),
        row.expected.clone(),
        row.status.clone(),
        number(row.residual),
        number(row.error),
        number(row.electric_error),
        visits,
        row.verdict.name().into(),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::extremes::Section;

    fn table() -> Extremes {
        let row = Row {
            case: "k = 1e8".into(),
            elements: 100,
            precision: "f64",
            expected: "error <= 1e-6".into(),
            status: "converged".into(),
            residual: Some(1e-12),
            reference: "closed form".into(),
            error: Some(2.5e-8),
            electric_error: None,
            element_visits: Some(412),
            visits_cap: 4000,
            verdict: Verdict::Ok,
            remarks: Vec::new(),
        };
        let wrong =
            Row { verdict: Verdict::Wrong, remarks: vec!["the foundation pulls".into()], ..row.clone() };
        let groups = vec![Section { name: "stiffness", comment: "Words.", rows: vec![row, wrong] }];
        Extremes { quick: true, rows: 2, wrong: 1, groups }
    }

    #[test]
    fn text_says_what_is_wrong() {
        let text = text(&table());
        assert!(text.contains("wrong: k = 1e8, N = 100, f64: the foundation pulls"), "{text}");
        assert!(text.ends_with("2 rows: 1 ok, 0 refused, 1 wrong.\n"), "{text}");
    }

    #[test]
    fn markdown_names_its_command_and_has_whole_rows() {
        let text = markdown(&table());
        assert!(text.starts_with("# Extremes\n\n`cargo beam extremes --quick "), "{text}");
        let row = "| k = 1e8 | 100 | f64 | error <= 1e-6 | converged | 1e-12 | 2.5e-8 | - | 412 / 4000 | ok | closed form |  |";
        assert!(text.contains(row), "{text}");
        assert!(text.contains("## Stiffness\n\nWords."), "{text}");
    }
}
