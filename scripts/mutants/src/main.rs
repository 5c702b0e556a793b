//! Weaves mutants of cargo-mutants into one program that the environment tells which of them to be: `MUTANT=17 test`.
//!
//! usage: piezobeam-mutants LIST FOLDER SEED COUNT [NUMBER..]
//!
//! LIST is what `cargo mutants --list --json` prints; a mutant's number is its place there, counted from 1. Of all but the
//! single NUMBERs (those that do not compile), COUNT are taken in an order that SEED shuffles, and woven into the sources
//! under FOLDER, which is a copy. Prints a line for each that is taken: number, `woven` or `alone`, name. What is `alone`
//! is in a constant, or takes a field out of a literal, and has to be built by itself.
//!
//! Operands are evaluated once, in their order, before a `match` chooses the operator, so that mutants nest in each other.
use proc_macro2::{LineColumn, Span};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::ops::Range;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{BinOp, Expr};

/// The mutant that the environment asks for, looked up once.
const SWITCH: &str = r#"
mod mutant {
    use core::sync::atomic::{AtomicU32, Ordering::Relaxed};

    static NOW: AtomicU32 = AtomicU32::new(u32::MAX);

    #[inline(always)]
    pub(crate) fn now() -> u32 {
        let now = NOW.load(Relaxed);
        if now == u32::MAX { ask() } else { now }
    }

    #[cold]
    fn ask() -> u32 {
        let now = std::env::var("MUTANT").ok().and_then(|text| text.parse().ok()).unwrap_or(0);
        NOW.store(now, Relaxed);
        now
    }
}
"#;

/// Mutants of one place: number and replacement.
type Places = BTreeMap<(String, LineColumn), Vec<(u32, String)>>;

/// What stands in place of some bytes.
struct Edit {
    at: Range<usize>,
    parts: Vec<Part>,
}

enum Part {
    Text(String),
    Source(Range<usize>),
}

struct Weaver<'a> {
    places: &'a Places,
    edits: Vec<Edit>,
    woven: BTreeSet<u32>,
}

/// `match` on the mutant, each way on a line of its own with its number, by which errors of the compiler find it.
fn choose(ways: &[(u32, String)], else_way: &str) -> String {
    let mut text = String::from("match crate::mutant::now() {\n");
    for (number, way) in ways {
        let _ = writeln!(text, "{number} => {way}, // mutant {number}.");
    }
    let _ = write!(text, "_ => {else_way}\n}}");
    text
}

fn text(text: impl Into<String>) -> Part {
    Part::Text(text.into())
}

fn has_let(expr: &Expr) -> bool {
    match expr {
        Expr::Let(_) => true,
        Expr::Binary(both) => has_let(&both.left) || has_let(&both.right),
        _ => false,
    }
}

impl Weaver<'_> {
    fn of(&mut self, kind: &str, span: Span) -> Vec<(u32, String)> {
        self.places.get(&(kind.to_owned(), span.start())).cloned().unwrap_or_default()
    }

    fn edit(&mut self, at: Range<usize>, mutants: &[(u32, String)], parts: Vec<Part>) {
        self.woven.extend(mutants.iter().map(|m| m.0));
        self.edits.push(Edit { at, parts });
    }

    fn function(&mut self, block: &syn::Block) {
        let Some(first) = block.stmts.first() else { return };
        let mutants = self.of("FnValue", first.span());
        if mutants.is_empty() {
            return;
        }
        let mut before = String::from("\n");
        for (number, value) in &mutants {
            let _ = writeln!(
                before,
                "if crate::mutant::now() == {number} {{ return {value}; }} // mutant {number}."
            );
        }
        let open = block.brace_token.span.open().byte_range().end;
        self.edit(open..open, &mutants, vec![text(before)]);
    }

    fn binary(&mut self, both: &syn::ExprBinary) {
        let mutants = self.of("BinaryOperator", both.op.span());
        if mutants.is_empty() || has_let(&both.left) || has_let(&both.right) {
            return;
        }
        let (at, op) = (both.span().byte_range(), both.op.span().source_text().unwrap_or_default());
        let (left, right) = (both.left.span().byte_range(), both.right.span().byte_range());
        let parts = match both.op {
            BinOp::And(_) | BinOp::Or(_) => {
                // There is one other operator. What is right of it is evaluated only where it counts.
                let (number, sign) =
                    (mutants[0].0, if matches!(both.op, BinOp::And(_)) { "!=" } else { "==" });
                vec![
                    text("(match ("),
                    Part::Source(left),
                    text(format!(
                        ") {{ mutant_l => if mutant_l {sign} (crate::mutant::now() == {number}) {{ ("
                    )),
                    Part::Source(right),
                    text(") } else { mutant_l } })"),
                ]
            }
            BinOp::AddAssign(_)
            | BinOp::SubAssign(_)
            | BinOp::MulAssign(_)
            | BinOp::DivAssign(_)
            | BinOp::RemAssign(_)
            | BinOp::BitAndAssign(_)
            | BinOp::BitOrAssign(_)
            | BinOp::BitXorAssign(_)
            | BinOp::ShlAssign(_)
            | BinOp::ShrAssign(_) => {
                let mut parts = vec![
                    text("(match ("),
                    Part::Source(right),
                    text(") { mutant_r => match crate::mutant::now() {\n"),
                ];
                for (number, other) in &mutants {
                    parts.push(text(format!("{number} => {{ ")));
                    parts.push(Part::Source(left.clone()));
                    parts.push(text(format!(" {other} mutant_r; }} // mutant {number}.\n")));
                }
                parts.push(text("_ => { "));
                parts.push(Part::Source(left));
                parts.push(text(format!(" {op} mutant_r; }}\n}} }})")));
                parts
            }
            _ => {
                let compares = matches!(
                    both.op,
                    BinOp::Eq(_) | BinOp::Ne(_) | BinOp::Lt(_) | BinOp::Le(_) | BinOp::Gt(_) | BinOp::Ge(_)
                );
                // Comparisons take nothing away.
                let by = if compares { "&" } else { "" };
                let ways: Vec<_> =
                    mutants.iter().map(|(n, other)| (*n, format!("mutant_l {other} mutant_r"))).collect();
                vec![
                    text(format!("(match ({by}(")),
                    Part::Source(left),
                    text(format!("), {by}(")),
                    Part::Source(right),
                    text(format!(
                        ")) {{ (mutant_l, mutant_r) => {} }})",
                        choose(&ways, &format!("mutant_l {op} mutant_r"))
                    )),
                ]
            }
        };
        self.edit(at, &mutants, parts);
    }
}

impl<'ast> Visit<'ast> for Weaver<'_> {
    // What is evaluated while compiling cannot ask the environment.
    fn visit_item_const(&mut self, _: &'ast syn::ItemConst) {}
    fn visit_item_static(&mut self, _: &'ast syn::ItemStatic) {}
    fn visit_impl_item_const(&mut self, _: &'ast syn::ImplItemConst) {}
    fn visit_trait_item_const(&mut self, _: &'ast syn::TraitItemConst) {}
    fn visit_expr_const(&mut self, _: &'ast syn::ExprConst) {}
    fn visit_type(&mut self, _: &'ast syn::Type) {}
    fn visit_generic_argument(&mut self, _: &'ast syn::GenericArgument) {}
    fn visit_pat(&mut self, _: &'ast syn::Pat) {}

    fn visit_expr_repeat(&mut self, repeat: &'ast syn::ExprRepeat) {
        self.visit_expr(&repeat.expr);
    }

    fn visit_item_fn(&mut self, f: &'ast syn::ItemFn) {
        if f.sig.constness.is_none() {
            self.function(&f.block);
            visit::visit_item_fn(self, f);
        }
    }

    fn visit_impl_item_fn(&mut self, f: &'ast syn::ImplItemFn) {
        if f.sig.constness.is_none() {
            self.function(&f.block);
            visit::visit_impl_item_fn(self, f);
        }
    }

    fn visit_trait_item_fn(&mut self, f: &'ast syn::TraitItemFn) {
        if let Some(block) = &f.default {
            self.function(block);
        }
        visit::visit_trait_item_fn(self, f);
    }

    fn visit_expr_binary(&mut self, both: &'ast syn::ExprBinary) {
        self.binary(both);
        visit::visit_expr_binary(self, both);
    }

    fn visit_expr_unary(&mut self, unary: &'ast syn::ExprUnary) {
        let mutants = self.of("UnaryOperator", unary.op.span());
        if let Some((number, _)) = mutants.first() {
            let op = unary.op.span().source_text().unwrap_or_default();
            let ways = choose(&[(*number, "mutant_v".to_owned())], &format!("{op}mutant_v"));
            let parts = vec![
                text("(match ("),
                Part::Source(unary.expr.span().byte_range()),
                text(format!(") {{ mutant_v => {ways} }})")),
            ];
            self.edit(unary.span().byte_range(), &mutants, parts);
        }
        visit::visit_expr_unary(self, unary);
    }

    fn visit_arm(&mut self, arm: &'ast syn::Arm) {
        let gone = self.of("MatchArm", arm.span());
        let there = gone.first().map(|(number, _)| format!("crate::mutant::now() != {number}"));
        if let Some((_, guard)) = &arm.guard {
            let mutants = self.of("MatchArmGuard", guard.span());
            if !mutants.is_empty() || there.is_some() {
                let mut before = there.map_or_else(String::new, |there| format!("{there} && "));
                before += "(match crate::mutant::now() {\n";
                for (number, value) in &mutants {
                    let _ = writeln!(before, "{number} => {value}, // mutant {number}.");
                }
                let at = guard.span().byte_range();
                let both: Vec<_> = gone.into_iter().chain(mutants).collect();
                self.edit(at.clone(), &both, vec![text(before + "_ => "), Part::Source(at), text("\n})")]);
            }
        } else if let Some(there) = there {
            let end = arm.pat.span().byte_range().end;
            self.edit(end..end, &gone, vec![text(format!(" if {there}"))]);
        }
        visit::visit_arm(self, arm);
    }
}

/// The bytes of `source` in `at`, edits inside it made.
fn render(source: &str, edits: &[Edit], at: Range<usize>, outer: Option<usize>, out: &mut String) {
    let mut from = at.start;
    // Sorted: outer edits come first.
    for (i, edit) in edits.iter().enumerate().skip(outer.map_or(0, |i| i + 1)) {
        if edit.at.start >= at.end {
            break;
        }
        if edit.at.start < from || edit.at.end > at.end {
            continue;
        }
        out.push_str(&source[from..edit.at.start]);
        for part in &edit.parts {
            match part {
                Part::Text(text) => out.push_str(text),
                Part::Source(range) => render(source, edits, range.clone(), Some(i), out),
            }
        }
        from = edit.at.end;
    }
    out.push_str(&source[from..at.end]);
}

fn place(value: &Value) -> LineColumn {
    let number = |key: &str| value[key].as_u64().unwrap_or_default() as usize;
    LineColumn { line: number("line"), column: number("column").saturating_sub(1) }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [list, folder, seed, count, left_out @ ..] = args.as_slice() else {
        return Err("usage: piezobeam-mutants LIST FOLDER SEED COUNT [NUMBER..]".into());
    };
    let list: Vec<Value> = serde_json::from_str(&std::fs::read_to_string(list)?)?;
    let left_out: BTreeSet<u32> = left_out.iter().map(|n| n.parse()).collect::<Result<_, _>>()?;
    let name = |n: u32| list[n as usize - 1]["name"].as_str().unwrap_or_default();
    let file = |n: u32| list[n as usize - 1]["file"].as_str().unwrap_or_default();

    // Fisher and Yates's shuffle by xorshift: the first so many are a sample, whatever is left out later.
    let mut order: Vec<u32> = (1..=u32::try_from(list.len())?).collect();
    let mut state = seed.parse::<u64>()?.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    for i in (1..order.len()).rev() {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        order.swap(i, (state % (i as u64 + 1)) as usize);
    }
    order.truncate(count.parse()?);

    let mut files: BTreeMap<&str, Places> = BTreeMap::new();
    for &n in order.iter().filter(|n| !left_out.contains(n)) {
        let mutant = &list[n as usize - 1];
        // Another iterator is another type.
        if mutant["function"]["return_type"].as_str().is_some_and(|of| of.contains("impl "))
            && mutant["genre"] == "FnValue"
        {
            continue;
        }
        let kind = mutant["genre"].as_str().unwrap_or_default().to_owned();
        let replacement = mutant["replacement"].as_str().unwrap_or_default().to_owned();
        let at = place(&mutant["span"]["start"]);
        files.entry(file(n)).or_default().entry((kind, at)).or_default().push((n, replacement));
    }
    let mut woven = BTreeSet::new();
    for (file, places) in &files {
        let path = std::path::Path::new(folder).join(file);
        let source = std::fs::read_to_string(&path)?;
        let mut weaver = Weaver { places, edits: vec![], woven: BTreeSet::new() };
        weaver.visit_file(&syn::parse_file(&source)?);
        weaver.edits.sort_by_key(|edit| (edit.at.start, std::cmp::Reverse(edit.at.end)));
        let mut out = String::new();
        render(&source, &weaver.edits, 0..source.len(), None, &mut out);
        std::fs::write(&path, out)?;
        woven.append(&mut weaver.woven);
    }
    let root = std::path::Path::new(folder).join("src/lib.rs");
    std::fs::write(&root, std::fs::read_to_string(&root)? + SWITCH)?;
    for n in order.into_iter().filter(|n| !left_out.contains(n)) {
        println!("{n}\t{}\t{}", if woven.contains(&n) { "woven" } else { "alone" }, name(n));
    }
    Ok(())
}
