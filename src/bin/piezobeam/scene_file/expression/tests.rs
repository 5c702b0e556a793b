//! Formulas read rightly, derived exactly, and mistakes explained.

use std::f64::consts::PI;

use super::program::{Binary, FUNCTIONS, Step};
use super::*;

#[track_caller]
fn formula(text: &str) -> Expression {
    Expression::parse(text, 2.0).unwrap_or_else(|error| panic!("{text}: {error:?}"))
}

/// The message, its place and its hint in one line.
#[track_caller]
fn refusal(text: &str) -> String {
    let error = Expression::parse(text, 2.0).expect_err("a refusal");
    let at = error.at.map_or(String::new(), |at| format!("{at}: "));
    format!("{at}{}; {}", error.message, error.hint)
}

/// The expected jet comes from differentiating by hand.
#[track_caller]
fn check(text: &str, x: f64, expected: [f64; 3]) {
    let formula = formula(text);
    let found = formula.jet(x);
    for (found, expected) in
        found.iter().chain(&[formula.value(x)]).zip(expected.iter().chain(&expected[..1]))
    {
        let error = (found - expected).abs();
        assert!(error <= 1e-13 * expected.abs().max(1.0), "{text} at {x}: {found} instead of {expected}");
    }
}

#[test]
fn the_rules_of_mathematics_hold() {
    let rules = "-x^2 = -9; 2*-x^2 = -18; 2^3^2 = 512; 2^-1 = 0.5; 2^-x*8 = 1; 2^-x+1 = 1.125; x^-2^2*81 = 1;
        -2*x - -x*2 = 0; 8/4/2 = 1; 8/4*2 = 4; 8-4-2 = 2; 8-4+2 = 6; 1 + 2*x = 7; (1 + 2)*x = 9; --x = 3; +x = 3;
        1e3*x = 3000; 1e-3 = 0.001; .5 + 5. + 2.5E-1 + 2e+2 = 205.75; L*x = 6; min(x, 2) + max(x, 4) = 6;
        abs(-x) = 3; x\t\n+ 1 = 4; log(e^2) = 2; log10(1000) = 3; cos(π) + tau/pi = 1";
    for rule in rules.split(';') {
        let (text, expected) = rule.split_once('=').expect("a value");
        let expected: f64 = expected.trim().parse().expect("a number");
        assert!((formula(text).value(3.0) - expected).abs() < 1e-12, "{text}");
    }
}

#[test]
fn mistakes_are_explained() {
    let mistakes = r#"
2*           => 3: expected a number, a name or "(", found the end; an example is 0.4*sin(pi*x/L)^2
2x           => 2: expected an operator, found "x"; write * for a product
2e           => 2: expected an operator, found "e"; write * for a product
1.2.3        => 4: expected an operator, found ".3"; write * for a product
(2x)         => 3: expected ")", found "x"; write * for a product
min(2x, 1)   => 6: expected ")", found "x"; write * for a product
x(1 + x)     => 1: x is not a function; write x*(...) for a product
x**2         => 3: unexpected "*"; write ^ for a power
x)           => 2: unmatched ")"; remove it or open it before
(x           => 3: expected ")", found the end; close every bracket
0,5*x        => 2: unexpected ","; write a dot as the decimal mark, 0.5
sin(0,5)     => 6: expected ")", found ","; write a dot as the decimal mark; only min and max take two arguments
min(x, 1, 2) => 9: expected ")", found ","; write a dot as the decimal mark; only min and max take two arguments
min(x)       => 1: min takes two arguments; write min(x, 0.5)
0.4*sin(y)   => 9: unknown name "y"; x is the position, L the length, and pi, e and tau are numbers
X + 1        => 1: unknown name "X"; did you mean "x"?
sin x        => 1: sin stands without its argument; write sin(...)
sinn(x)      => 1: unknown function "sinn"; did you mean "sin"?
arcsin(x)    => 1: unknown function "arcsin"; did you mean "asin"?
step(x)      => 1: unknown function "step"; give jumps as { breaks = [..], values = [..] }
pow(x, 2)    => 1: unknown function "pow"; write a^b
.            => 1: "." is not a number; write a number such as 0.5
π*1e999      => 3: "1e999" is beyond the range of double precision; use numbers up to about 1.8e308
π − 1        => 3: unexpected character "−"; write - for minus
x²           => 2: unexpected character "²"; write ^ for a power
{x}          => 1: unexpected character "{"; write ( ) for brackets
x$           => 2: unexpected character "$"; a formula is made of numbers, names, brackets and + - * / ^"#;
    for mistake in mistakes.trim().lines() {
        let (text, message) = mistake.split_once(" => ").expect("a message");
        assert_eq!(refusal(text.trim_end()), message, "{text}");
    }
    assert!(refusal("").starts_with("1: expected a number, a name or \"(\", found the end"));
    assert!(refusal("x\u{0}").starts_with("2: unexpected character \"\\u{0}\""));
    let message = "6: the result here is not a finite number; \
                   check for a division by zero or a root or logarithm out of range";
    assert_eq!(refusal("x + 1/0"), message);
    let message = "1: unknown function \"quadrature\"; the functions are abs, acos, acosh, asin, asinh, atan, \
                   atanh, cbrt, cos, cosh, exp, ln, log, log2, log10, sin, sinh, sqrt, tan, tanh, min and max";
    assert_eq!(refusal("quadrature(x)"), message);
}

#[test]
fn hostile_formulas_are_refused() {
    let deep = "nested more than 32 deep; write it with fewer brackets";
    for unit in ["(", "-", "x^", "sin(", "min(1,", "1+(x*(x^("] {
        assert!(refusal(&unit.repeat(400)).ends_with(deep), "{unit}");
    }
    assert_eq!(refusal(&"x+".repeat(4000)), "longer than 4096 bytes; give a table of x and y instead");
    let sum = format!("{}x", "x+".repeat(2000));
    assert!((formula(&sum).value(3.0) - 6003.0).abs() < 1e-9);
    assert!(Expression::parse(&format!("{}x{}", "(".repeat(32), ")".repeat(32)), 1.0).is_ok());
}

/// The bounds on nesting hold by themselves, whatever the length of the text.
#[test]
fn no_formula_exhausts_the_stack() {
    let work = || {
        for unit in ["(", "-", "+", "x^", "2^-", "sin(", "min(1,", "max(x+x*x^", "1+(x*(x^(", "-(("] {
            for text in [unit.repeat(100_000), unit.repeat(100_000) + "x" + &")".repeat(100_000)] {
                let error = parser::translate(&text, 2.0).map(|_| ()).expect_err("a refusal");
                assert!(error.message.contains("nested more than 32 deep"), "{unit}: {error:?}");
                assert!(Expression::parse(&text, 2.0).is_err());
            }
        }
        for (unit, levels) in [("max(x, x + x*", 32), ("(-(", 10), ("x^", 32), ("sin(", 32)] {
            let closing = ")".repeat(unit.matches('(').count() * levels);
            let program = parser::translate(&(unit.repeat(levels) + "x" + &closing), 2.0).expect("a formula");
            assert!(program.run(Dual2_64::from_re(0.5).derivative()).re.is_finite(), "{unit}");
        }
        for (unit, sum) in [("1+", 200_001.0), ("x+", 100_000.5), ("1*", 1.0), ("x-x+", 0.5)] {
            let last = if unit.starts_with('1') { "1" } else { "x" };
            let program = parser::translate(&(unit.repeat(200_000) + last), 2.0).expect("a sum");
            assert!((program.run(0.5_f64) - sum).abs() < 1e-6, "{unit}");
            assert!((program.run(Dual2_64::from_re(0.5).derivative()).re - sum).abs() < 1e-6, "{unit}");
        }
    };
    let thread = std::thread::Builder::new().stack_size(2 << 20).spawn(work).expect("a thread");
    thread.join().expect("no panic");
}

#[test]
fn jets_agree_with_derivatives_by_hand() {
    let x: f64 = 0.3;
    let (sine, cosine) = (PI * x).sin_cos();
    let curvature = 0.8 * PI * PI * (cosine * cosine - sine * sine);
    check("0.4*sin(pi*x)^2", x, [0.4 * sine * sine, 0.8 * PI * sine * cosine, curvature]);
    let bell = (-x * x).exp();
    check("exp(-x^2)", x, [bell, -2.0 * x * bell, (4.0 * x * x - 2.0) * bell]);
    let [x2, x3, x4] = [x.powi(2), x.powi(3), x.powi(4)];
    let jet = [4.0 * x2 - 8.0 * x3 + 4.0 * x4, 8.0 * x - 24.0 * x2 + 16.0 * x3, 8.0 - 48.0 * x + 48.0 * x2];
    check("4*x^2 - 8*x^3 + 4*x^4", x, jet);
    let y = 1.0 + x;
    check("x/(1 + x)", x, [x / y, y.powi(-2), -2.0 * y.powi(-3)]);
    let root = x.sqrt();
    let jet = [root * x.ln(), (x.ln() + 2.0) / (2.0 * root), -x.ln() / (4.0 * x * root)];
    check("sqrt(x)*ln(x)", x, jet);
    let (power, slope) = (x.powf(x), x.ln() + 1.0);
    check("x^x", x, [power, power * slope, power * (slope * slope + 1.0 / x)]);
    check("L*x + e", x, [2.0 * x + 1.0_f64.exp(), 2.0, 0.0]);
}

#[test]
fn powers_are_fine_at_zero_and_below() {
    check("x^2", 0.0, [0.0, 0.0, 2.0]);
    check("x^2", -3.0, [9.0, -6.0, 2.0]);
    check("x^1", 0.0, [0.0, 1.0, 0.0]);
    check("x^0", 0.0, [1.0, 0.0, 0.0]);
    check("x^3", 0.0, [0.0, 0.0, 0.0]);
    check("x^2.5", 0.0, [0.0, 0.0, 0.0]);
    check("x^21", -1.0, [-1.0, 21.0, -420.0]);
    check("(x - 0.5)^(1 + 1)", 0.5, [0.0, 0.0, 2.0]);
    check("0.4*sin(pi*x)^2", 0.0, [0.0, 0.0, 0.8 * PI * PI]);
    assert_eq!(formula("sqrt(x) + x^1.5").jet(0.0)[0].to_bits(), 0.0_f64.to_bits());
}

/// Steep steps written with exponentials stay numbers far from the step.
#[test]
fn steep_steps_do_not_overflow() {
    check("1/(1 + exp(1000*(x - 0.5)))", 1.0, [0.0, 0.0, 0.0]);
    check("1/cosh(500*x)", 1.0, [0.0, 0.0, 0.0]);
    for (x, value) in [(-1.0, -1.0), (1.0, 1.0), (0.0, 0.0)] {
        check("tanh(1e4*x)", x, [value, 1e4 * (1.0 - value * value), 0.0]);
    }
    check("1/x", 1e-90, [1e90, -1e180, 2e270]);
    check("ln(exp(-600*x))", 1.0, [-600.0, -600.0, 0.0]);
    check("sqrt(exp(-600*x))", 1.0, [0.0, 0.0, 0.0]);
    check("x^0.5", 1e-120, [1e-60, 0.5e60, -0.25e180]);
}

#[test]
fn poles_give_no_panic() {
    for text in ["1/x", "ln(x)", "x^(-2)", "1/(x-x)", "tan(1/x)", "x^x"] {
        let formula = formula(text);
        let _ = formula.value(0.0);
        assert!(formula.jet(0.0).iter().any(|part| !part.is_finite()), "{text}");
    }
    for text in ["ln(x)", "sqrt(x)", "asin(x - 1)", "x^0.5", "acosh(x)", "atanh(x-1)"] {
        let formula = formula(text);
        assert!(formula.value(-2.0).is_nan(), "{text}");
        assert!(formula.jet(-2.0).iter().all(|part| part.is_nan()), "{text}");
    }
}

#[test]
fn kinks_and_zeros_are_recognised() {
    assert_eq!(formula("x + abs(x)").kinked(), Some("abs"));
    assert_eq!(formula("max(x, 0.1)").kinked(), Some("max"));
    assert_eq!(formula("min(x, 0.1)").kinked(), Some("min"));
    assert_eq!(formula("x + abs(-1) + sqrt(x)").kinked(), None);
    assert!(formula("0").is_zero());
    assert!(formula("sin(0)*3").is_zero());
    assert!(!formula("x - x").is_zero());
    assert_eq!(formula(" x ").text(), " x ");
    check("abs(x - 1)^2", 0.5, [0.25, -1.0, 2.0]);
    check("max(x, 2*x)", 1.0, [2.0, 2.0, 0.0]);
    check("min(x^-1, 3) + min(1/x, 2)", 0.0, [5.0, 0.0, 0.0]);
    check("min(x^2, 1)", 0.5, [0.25, 1.0, 2.0]);
    assert!(formula("abs(x)").jet(0.0)[1].is_nan());
    assert_eq!(formula("abs(x)").value(0.0).to_bits(), 0.0_f64.to_bits());
}

/// Compares the jet with fourth-order central differences, where those of two step widths agree; tells whether
/// there was a jet where they did.
fn agrees_with_differences(text: &str, x: f64) -> Option<bool> {
    let formula = formula(text);
    let jet = formula.jet(x);
    let differences = |h: f64| {
        let [a, b, c, d, e] = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|shift| formula.value(x + shift * h));
        [c, (a - 8.0 * b + 8.0 * d - e) / (12.0 * h), (16.0 * (b + d) - a - e - 30.0 * c) / (12.0 * h * h)]
    };
    let (wide, narrow) = (differences(2e-3), differences(1e-3));
    let scale = narrow.iter().fold(1.0_f64, |scale, part| scale.max(part.abs()));
    let close = |u: [f64; 3], bound: f64| u.iter().zip(narrow).all(|(u, v)| (u - v).abs() <= bound * scale);
    if !close(wide, 1e-7) || jet.iter().any(|part| part.is_nan()) {
        return close(wide, 1e-7).then_some(false);
    }
    assert!(close(jet, 1e-6), "{text} at {x}: {jet:?} instead of {narrow:?}");
    Some(true)
}

#[test]
fn derivatives_agree_with_differences() {
    for (name, step) in FUNCTIONS {
        if matches!(step, Step::Binary(_)) {
            continue;
        }
        let agreed = [0.35, 0.7, 1.3, -0.6].map(|x| agrees_with_differences(&format!("{name}(x)"), x));
        assert!(agreed.contains(&Some(true)) && !agreed.contains(&Some(false)), "{name}");
    }
    let mut seed = 1_u64;
    let mut draw = |below: usize| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        usize::try_from(seed >> 33).unwrap_or(0) % below
    };
    let [mut agreed, mut missing] = [0, 0];
    for _ in 0..4000 {
        let (text, x) = (random_formula(&mut draw, 3), [0.37, 0.81, 1.9][draw(3)]);
        let compared = Expression::parse(&text, 2.0).ok().and_then(|_| agrees_with_differences(&text, x));
        agreed += usize::from(compared == Some(true));
        missing += usize::from(compared == Some(false));
    }
    // Jets are missing on kinks, as in abs(x - x), and where a step in between is beyond the range of doubles.
    assert!(agreed > 2000 && missing < 20, "{agreed} {missing}");
}

fn random_formula(draw: &mut impl FnMut(usize) -> usize, depth: usize) -> String {
    if depth == 0 || draw(6) == 0 {
        return ["x", "x", "L", "1.5", "0.25", "pi"][draw(6)].to_owned();
    }
    let left = random_formula(draw, depth - 1);
    let choice = draw(8);
    match choice {
        0..4 => format!("({left} {} {})", ["+", "-", "*", "/"][choice], random_formula(draw, depth - 1)),
        4 => format!("({left})^{}", ["2", "3", "-1", "2.5", "0.5", "-0.5"][draw(6)]),
        5 => format!("(-exp({left})^({}))", random_formula(draw, depth - 1)),
        _ => match FUNCTIONS[draw(FUNCTIONS.len())] {
            (name, Step::Binary(_)) => format!("{name}({left}, {})", random_formula(draw, depth - 1)),
            (name, _) => format!("{name}({left})"),
        },
    }
}

#[test]
fn constants_are_computed_once_and_stacks_are_bounded() {
    assert!(Program::default().run(1.0_f64).is_nan());
    assert_eq!(formula("-(2*3)").program.constant(), Some(-6.0));
    assert_eq!(formula("-(2*3) + x").program.constant(), None);
    assert!(refusal("ln(0)*x").contains("not a finite number"));
    let mut program = Program::default();
    assert!((0..128).all(|_| program.add(Step::Variable).is_ok()));
    assert!(program.add(Step::Variable).is_err());
    assert!((1..128).all(|_| program.add(Step::Binary(Binary::Plus)).is_ok()));
    assert_eq!(program.run(1.0_f64).to_bits(), 128.0_f64.to_bits());
}

#[test]
fn poles_on_the_beam_are_found() {
    let pole = |text: &str| Expression::parse(text, 2.0).expect("a formula").pole(2.0);
    for (text, x) in [
        ("1/(x - 0.5)", 0.5),
        ("1/(x - 0.3)", 0.3),
        ("1e-9/(x - 1.234567)^2 + 5", 1.234567),
        ("1/x", 0.0),
        ("1/(x - L)", 2.0),
        ("ln(x - 0.5)", 0.5),
        ("tan(x)", std::f64::consts::FRAC_PI_2),
        ("(x - 0.7)^-1 + 1e6", 0.7),
        ("1/sin(x - 1)", 1.0),
    ] {
        let found = pole(text).expect(text);
        assert!((found - x).abs() < 1e-6, "{text}: {found}");
    }
    for text in [
        "3",
        "0",
        "sin(x)/x",
        "sin(x - 0.3)/(x - 0.3)",
        "1/(1 + x)",
        "1/((x - 0.5)^2 + 1e-6)",
        "exp(50*x)",
        "sin(5000*x)",
        "1/(x + 1e-3)",
        "sqrt(x - 0.5)",
        "max(x, 1)",
    ] {
        assert_eq!(pole(text), None, "{text}");
    }
    assert!(pole("1e300*exp(20*x)").is_some(), "beyond the range of doubles");
}
