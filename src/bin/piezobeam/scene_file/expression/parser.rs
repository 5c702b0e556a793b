//! The grammar of formulas: numbers, names, calls and brackets between operators.

use std::f64::consts::{E, PI, TAU};

use winnow::ascii::digit0;
use winnow::combinator::{Infix, Prefix, alt, expression, opt, peek};
use winnow::error::ParserError;
use winnow::prelude::*;
use winnow::stream::{Stateful, Stream};
use winnow::token::{any, one_of, take_while};

use super::super::error::{listed, quoted};
use super::super::{number, suggestion};
use super::ExpressionError;
use super::program::{Binary, FUNCTIONS, Function, Program, Step, TOO_DEEP};

/// The longest formula, in bytes.
const LONGEST: usize = 4096;

/// The deepest nesting of brackets, signs and powers; the parser recurs for each of them.
const DEEPEST: usize = 32;

const NAMES: [&str; 5] = ["x", "L", "pi", "e", "tau"];

/// The text still to be read, and what has become of the text before it.
type Input<'a> = Stateful<&'a str, State<'a>>;

#[derive(Debug)]
struct State<'a> {
    text: &'a str,
    length: f64,
    depth: usize,
    program: Program,
}

/// Why a parser stops: with an error, or without one where another parser may be tried.
#[derive(Debug)]
struct Stop(Option<Box<ExpressionError>>);

impl<I: Stream> ParserError<I> for Stop {
    type Inner = Self;

    fn from_input(_: &I) -> Self {
        Self(None)
    }

    fn is_backtrack(&self) -> bool {
        self.0.is_none()
    }

    fn into_inner(self) -> Result<Self, Self> {
        Ok(self)
    }
}

/// Translates a formula in `x`, in which `L` is the given length.
pub(super) fn parse(text: &str, length: f64) -> Result<Program, ExpressionError> {
    if text.len() > LONGEST {
        return Err(ExpressionError {
            at: None,
            message: format!("longer than {LONGEST} bytes"),
            hint: "give a table of x and y instead".to_owned(),
        });
    }
    translate(text, length)
}

/// Translates a formula of any length.
pub(super) fn translate(text: &str, length: f64) -> Result<Program, ExpressionError> {
    let state = State { text, length, depth: 0, program: Program::default() };
    let mut input = Input { input: text, state };
    let Err(stop) = whole(&mut input) else { return Ok(input.state.program) };
    // Only parsers which are tried, and are not the last to be, stop without an error.
    Err(stop.0.map_or_else(|| error_at(text, 0, "not a formula", "an example is 0.4*sin(pi*x/L)^2"), |e| *e))
}

fn whole(i: &mut Input<'_>) -> Result<(), Stop> {
    spaces(i)?;
    sum(i)?;
    match i.input.chars().next() {
        None => Ok(()),
        Some(')') => Err(stop(i, "unmatched \")\"", "remove it or open it before")),
        Some(',') => Err(stop(i, "unexpected \",\"", "write a dot as the decimal mark, 0.5")),
        Some(_) => Err(expected(i, "an operator", "write * for a product")),
    }
}

/// Operators between operands. The output, here and below, is the offset behind the operand and the spaces
/// after it, which is where the next operator stands.
fn sum(i: &mut Input<'_>) -> Result<usize, Stop> {
    expression(operand).prefix(sign).infix(operator).parse_next(i)
}

fn operand(i: &mut Input<'_>) -> Result<usize, Stop> {
    alt((literal, named, bracket)).parse_next(i)
}

/// A sign binds less tightly than a power and more tightly than a product.
fn sign<'a>(i: &mut Input<'a>) -> Result<Prefix<Input<'a>, usize, Stop>, Stop> {
    let Some(symbol) = opt(one_of(['-', '+'])).parse_next(i)? else {
        return Err(expected(i, "a number, a name or \"(\"", "an example is 0.4*sin(pi*x/L)^2"));
    };
    nest(i)?;
    Ok(Prefix(
        5,
        match symbol {
            '-' => |i: &mut Input<'a>, end| {
                i.state.depth -= 1;
                add(i, end, end, Step::Apply(Function::Negative))
            },
            _ => |i: &mut Input<'a>, end| {
                i.state.depth -= 1;
                Ok(end)
            },
        },
    ))
}

/// An operator may be read twice, first by an operand before it that turns out to bind more tightly; not so
/// the power, which binds most tightly, so that its nesting is counted once.
fn operator<'a>(i: &mut Input<'a>) -> Result<Infix<Input<'a>, usize, Stop>, Stop> {
    let symbol = one_of(['+', '-', '*', '/', '^']).parse_next(i)?;
    if symbol == '^' {
        nest(i)?;
    } else {
        spaces(i)?;
    }
    match symbol {
        '+' => Ok(Infix::Left(1, |i, at, end| add(i, at, end, Step::Binary(Binary::Plus)))),
        '-' => Ok(Infix::Left(1, |i, at, end| add(i, at, end, Step::Binary(Binary::Minus)))),
        '/' => Ok(Infix::Left(3, |i, at, end| add(i, at, end, Step::Binary(Binary::Over)))),
        '*' if i.input.starts_with('*') => Err(stop(i, "unexpected \"*\"", "write ^ for a power")),
        '*' => Ok(Infix::Left(3, |i, at, end| add(i, at, end, Step::Binary(Binary::Times)))),
        _ => Ok(Infix::Right(7, |i: &mut Input<'a>, at, end| {
            i.state.depth -= 1;
            add(i, at, end, Step::Binary(Binary::Power))
        })),
    }
}

fn literal(i: &mut Input<'_>) -> Result<usize, Stop> {
    let at = offset(i);
    let word = digits.parse_next(i)?;
    let value: f64 = word.parse().map_err(|_| {
        stop_at(i, at, format!("{} is not a number", quoted(word)), "write a number such as 0.5")
    })?;
    if !value.is_finite() {
        let message = format!("{} is beyond the range of double precision", quoted(word));
        return Err(stop_at(i, at, message, "use numbers up to about 1.8e308"));
    }
    if value == 0.0 && number::vanishes(word) {
        let message = format!("{} is too small for double precision", quoted(word));
        return Err(stop_at(i, at, message, "write 0, or numbers from about 5e-324 on"));
    }
    spaces(i)?;
    add(i, at, offset(i), Step::Constant(value))
}

/// The text of a number: its digits, its fraction and its exponent.
fn digits<'a>(i: &mut Input<'a>) -> Result<&'a str, Stop> {
    peek(one_of(('0'..='9', '.'))).parse_next(i)?;
    let exponent = (one_of(['e', 'E']), opt(one_of(['+', '-'])), one_of('0'..='9'), digit0);
    (digit0, opt(('.', digit0)), opt(exponent)).take().parse_next(i)
}

/// The text of a name.
fn letters<'a>(i: &mut Input<'a>) -> Result<&'a str, Stop> {
    peek(one_of(|c: char| c.is_alphabetic() || c == '_')).parse_next(i)?;
    take_while(1.., |c: char| c.is_alphabetic() || c.is_ascii_digit() || c == '_').parse_next(i)
}

fn named(i: &mut Input<'_>) -> Result<usize, Stop> {
    let at = offset(i);
    let name = letters.parse_next(i)?;
    spaces(i)?;
    if i.input.starts_with('(') {
        return call(i, at, name);
    }
    let step = match name {
        "x" => Step::Variable,
        "L" => Step::Constant(i.state.length),
        "pi" | "π" => Step::Constant(PI),
        "e" => Step::Constant(E),
        "tau" => Step::Constant(TAU),
        _ => return Err(unknown_name(i, at, name)),
    };
    add(i, at, offset(i), step)
}

/// A call from its opening bracket on.
fn call(i: &mut Input<'_>, at: usize, name: &str) -> Result<usize, Stop> {
    let Some(&(_, step)) = FUNCTIONS.iter().find(|&&(known, _)| known == name) else {
        return Err(unknown_function(i, at, name));
    };
    open(i)?;
    sum(i)?;
    if matches!(step, Step::Binary(_)) {
        if i.input.is_empty() || i.input.starts_with(')') {
            let message = format!("{name} takes two arguments");
            return Err(stop_at(i, at, message, format!("write {name}(x, 0.5)")));
        }
        if opt(',').parse_next(i)?.is_some() {
            spaces(i)?;
            sum(i)?;
        }
    }
    let end = close(i)?;
    add(i, at, end, step)
}

fn bracket(i: &mut Input<'_>) -> Result<usize, Stop> {
    open(i)?;
    sum(i)?;
    close(i)
}

fn open(i: &mut Input<'_>) -> Result<(), Stop> {
    '('.parse_next(i)?;
    nest(i)
}

fn close(i: &mut Input<'_>) -> Result<usize, Stop> {
    if opt(')').parse_next(i)?.is_some() {
        i.state.depth -= 1;
        spaces(i)?;
        return Ok(offset(i));
    }
    let hint = match i.input.chars().next() {
        None => "close every bracket",
        Some(',') => "write a dot as the decimal mark; only min and max take two arguments",
        Some(_) => "write * for a product",
    };
    Err(expected(i, "\")\"", hint))
}

/// Goes one level deeper, behind a bracket, a sign or the symbol of a power.
fn nest(i: &mut Input<'_>) -> Result<(), Stop> {
    spaces(i)?;
    if i.state.depth == DEEPEST {
        return Err(stop(i, TOO_DEEP.0, TOO_DEEP.1));
    }
    i.state.depth += 1;
    Ok(())
}

fn spaces(i: &mut Input<'_>) -> Result<(), Stop> {
    take_while(0.., |c: char| c.is_ascii_whitespace()).void().parse_next(i)
}

fn offset(i: &Input<'_>) -> usize {
    i.state.text.len() - i.input.len()
}

/// Adds a step which stands at this offset to the program, and passes on where its operand ends.
fn add(i: &mut Input<'_>, at: usize, end: usize, step: Step) -> Result<usize, Stop> {
    i.state.program.add(step).map_err(|(message, hint)| stop_at(i, at, message, hint))?;
    Ok(end)
}

fn error_at(text: &str, at: usize, message: impl Into<String>, hint: impl Into<String>) -> ExpressionError {
    let before = text.get(..at).map_or(0, |before| before.chars().count());
    ExpressionError { at: Some(before + 1), message: message.into(), hint: hint.into() }
}

fn stop_at(i: &Input<'_>, at: usize, message: impl Into<String>, hint: impl Into<String>) -> Stop {
    Stop(Some(Box::new(error_at(i.state.text, at, message, hint))))
}

fn stop(i: &Input<'_>, message: impl Into<String>, hint: impl Into<String>) -> Stop {
    stop_at(i, offset(i), message, hint)
}

/// Complains about the next word, where something else was expected.
fn expected(i: &mut Input<'_>, what: &str, hint: &str) -> Stop {
    let at = offset(i);
    let Ok(word) = alt((digits, letters, any.take())).parse_next(i) else {
        return stop_at(i, at, format!("expected {what}, found the end"), hint);
    };
    let strange = match word {
        "−" | "–" => "write - for minus",
        "×" | "·" | "⋅" => "write * for a product",
        "÷" | ":" => "write / for a quotient",
        "²" | "³" => "write ^ for a power",
        "[" | "]" | "{" | "}" => "write ( ) for brackets",
        ";" => "write a dot as the decimal mark and a comma between arguments",
        _ if word.starts_with(|c: char| c.is_alphanumeric() || "_.+-*/^(),".contains(c)) => {
            return stop_at(i, at, format!("expected {what}, found {}", quoted(word)), hint);
        }
        _ => "a formula is made of numbers, names, brackets and + - * / ^",
    };
    stop_at(i, at, format!("unexpected character {}", quoted(word)), strange)
}

fn unknown_name(i: &Input<'_>, at: usize, name: &str) -> Stop {
    if FUNCTIONS.iter().any(|&(known, _)| known == name) {
        return stop_at(i, at, format!("{name} stands without its argument"), format!("write {name}(...)"));
    }
    let hint = match NAMES.iter().find(|known| known.eq_ignore_ascii_case(name)) {
        Some(known) => format!("did you mean \"{known}\"?"),
        None => "x is the position, L the length, and pi, e and tau are numbers".to_owned(),
    };
    stop_at(i, at, format!("unknown name {}", quoted(name)), hint)
}

fn unknown_function(i: &Input<'_>, at: usize, name: &str) -> Stop {
    if NAMES.contains(&name) || name == "π" {
        return stop_at(
            i,
            at,
            format!("{name} is not a function"),
            format!("write {name}*(...) for a product"),
        );
    }
    let names = FUNCTIONS.iter().map(|&(name, _)| name);
    let hint = match name {
        "pow" => "write a^b".to_owned(),
        "ceil" | "floor" | "heaviside" | "round" | "sgn" | "sign" | "signum" | "step" => {
            "give jumps as { breaks = [..], values = [..] }".to_owned()
        }
        _ => match suggestion::nearest(name, names.clone()) {
            Some(near) => format!("did you mean \"{near}\"?"),
            None => format!("the functions are {}", listed(&names.collect::<Vec<_>>())),
        },
    };
    stop_at(i, at, format!("unknown function {}", quoted(name)), hint)
}
