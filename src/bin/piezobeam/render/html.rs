//! The report as one page of HTML: pictures in it, nothing loaded from elsewhere, light or dark as the reader's screen
//! is, in one column where that is narrow.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::chart;
use crate::chapters::{Chapter, Claim, Document, Figure, Section, Table};

/// What pictures do not bring with them.
const STYLE: &str = "
:root { color-scheme: light dark; --ink: #222; --faint: #5f5f5f; --page: #fff; --line: #d9d9d9; --card: #f6f7f8;
        --good: #00684b; --bad: #b03a00 }
@media (prefers-color-scheme: dark) { :root { --ink: #ececec; --faint: #a9b0b8; --page: #16191d; --line: #343a41;
        --card: #1f2429; --good: #3fc79d; --bad: #f58b45 } }
* { box-sizing: border-box }
body { margin: 0 auto; max-width: 1180px; padding: 1rem; background: var(--page); color: var(--ink);
       font: 16px/1.5 system-ui, sans-serif; overflow-wrap: break-word }
h1 { font-size: 1.7rem; line-height: 1.2 } h2 { font-size: 1.35rem; margin-top: 2.5rem; border-top: 2px solid var(--line);
       padding-top: 1rem } h3 { font-size: 1.1rem; margin-top: 2rem }
p, ul { max-width: 46rem } a { color: inherit } code { font-size: .92em }
.faint, figcaption, .caption { color: var(--faint) } figcaption, .caption { font-size: .9rem }
.caption { margin: 1.5rem 0 0; max-width: none }
.figures { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 440px), 1fr)); gap: 1.2rem }
figure { margin: 0; min-width: 0; max-width: 580px } figure svg { width: 100%; height: auto; display: block }
.scroll { overflow-x: auto; margin: .3rem 0 1rem }
table { border-collapse: collapse; font-size: .92rem; font-variant-numeric: tabular-nums }
th, td { padding: .25rem .7rem; border-bottom: 1px solid var(--line); text-align: right; white-space: nowrap }
th:first-child, td:first-child { text-align: left }
.claims { display: grid; gap: .7rem } .claim { background: var(--card); border-left: 4px solid var(--good);
       padding: .6rem .9rem; border-radius: 3px } .claim.artefact { border-color: #d55e00 } .claim.fails { border-color: red }
.claim p { margin: .15rem 0; max-width: none } .claim .verdict { font-weight: 600 }
";

/// The whole page.
pub fn page(document: &Document) -> String {
    let markup = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { "piezobeam: report" }
                style { (PreEscaped(STYLE)) (PreEscaped(chart::style_sheet())) }
            }
            body {
                h1 { "piezobeam: error, run time, stability" }
                p { (rich(&document.introduction)) }
                p.faint { (rich(&document.made)) }
                p { (document.tally()) }
                nav { ul { @for chapter in &document.chapters {
                    li { a href={ "#" (chapter.name) } { (chapter.title) } }
                } } }
                @for chapter in &document.chapters { (self::chapter(chapter)) }
            }
        }
    };
    markup.into_string()
}

fn chapter(chapter: &Chapter) -> Markup {
    html! {
        section id=(chapter.name) {
            h2 { (chapter.title) }
            @for paragraph in &chapter.introduction { p { (rich(paragraph)) } }
            div.claims { @for claim in &chapter.claims { (self::claim(claim)) } }
            @for section in &chapter.sections { (self::section(section)) }
        }
    }
}

fn claim(claim: &Claim) -> Markup {
    let class = match (claim.holds, claim.artefact) {
        (false, _) => "claim fails",
        (true, true) => "claim artefact",
        (true, false) => "claim",
    };
    html! {
        div class=(class) {
            p { span.faint { (claim.by) ": " } (rich(claim.said)) }
            p { span.faint { "Found: " } (rich(&claim.found)) }
            p { span.verdict { (claim.verdict()) }
                @if !claim.assumes.is_empty() { span.faint { " Assumes: " (rich(claim.assumes)) } } }
        }
    }
}

fn section(section: &Section) -> Markup {
    html! {
        h3 { (section.title) }
        @for paragraph in &section.text { p { (rich(paragraph)) } }
        @if !section.figures.is_empty() {
            div.figures { @for figure in &section.figures { (self::figure(figure)) } }
        }
        @for table in &section.tables { (self::table(table)) }
    }
}

fn figure(figure: &Figure) -> Markup {
    html! {
        figure {
            (PreEscaped(figure.plot.svg()))
            figcaption { (rich(&figure.caption)) " " code { (figure.name) ".csv" } }
        }
    }
}

fn table(table: &Table) -> Markup {
    html! {
        p.caption { (rich(&table.caption)) " " code { (table.name) ".csv" } }
        div.scroll { table {
            thead { tr { @for cell in &table.header { th { (chart::scientific(cell)) } } } }
            tbody { @for row in &table.rows { tr { @for cell in row { td { (chart::scientific(cell)) } } } } }
        } }
    }
}

/// Text in which what stands between backticks is code.
fn rich(text: &str) -> Markup {
    html! {
        @for (i, part) in text.split('`').enumerate() {
            @if i % 2 == 1 { code { (part) } } @else { (chart::scientific(part)) }
        }
    }
}
