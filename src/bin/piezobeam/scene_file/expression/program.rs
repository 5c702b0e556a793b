//! A formula as a list of steps on a stack of numbers, run on plain numbers or on dual ones.

use num_dual::DualNum;

/// The most numbers on the stack at once. Three may wait at each of 32 levels, as in `max(x, x + x*(`.
const STACK: usize = 128;

/// The stack that nearly all formulas make do with; a small one is set up faster.
const SMALL_STACK: usize = 8;

/// What a formula is computed with: doubles, or dual numbers, which carry derivatives along.
pub(super) trait Number: DualNum<Primitive = f64> + Copy {}
impl<D: DualNum<Primitive = f64> + Copy> Number for D {}

macro_rules! functions {
    ($($name:literal $function:ident $apply:expr),+ $(,)?) => {
        /// A function of one argument.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(super) enum Function { Negative, $($function),+ }

        /// What the functions which have a name do.
        pub(super) const FUNCTIONS: &[(&str, Step)] = &[
            $(($name, Step::Apply(Function::$function)),)+
            ("min", Step::Binary(Binary::Least)), ("max", Step::Binary(Binary::Greatest)),
        ];

        impl Function {
            fn on<D: Number>(self, v: D) -> D {
                match self { Self::Negative => -v, $(Self::$function => $apply(&v)),+ }
            }
        }
    };
}

functions! {
    "abs" Abs absolute, "acos" Acos D::acos, "acosh" Acosh D::acosh, "asin" Asin D::asin,
    "asinh" Asinh D::asinh, "atan" Atan D::atan, "atanh" Atanh D::atanh, "cbrt" Cbrt D::cbrt,
    "cos" Cos D::cos, "cosh" Cosh D::cosh, "exp" Exp D::exp, "ln" Ln ln, "log" Log ln,
    "log2" Log2 D::log2, "log10" Log10 D::log10, "sin" Sin D::sin, "sinh" Sinh D::sinh,
    "sqrt" Sqrt sqrt, "tan" Tan D::tan, "tanh" Tanh tanh,
}

/// An operation on two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Binary {
    Plus,
    Minus,
    Times,
    Over,
    Power,
    Least,
    Greatest,
}

impl Binary {
    fn on<D: Number>(self, left: D, right: D) -> D {
        match self {
            Self::Plus => left + right,
            Self::Minus => left - right,
            Self::Times => left * right,
            Self::Over => quotient(left, right),
            Self::Power => power(left, right),
            Self::Least if left.re().is_nan() || left.re() <= right.re() => left,
            Self::Greatest if left.re().is_nan() || left.re() >= right.re() => left,
            Self::Least | Self::Greatest => right,
        }
    }
}

/// The absolute value, which has no derivatives at zero, as the root of the square has none.
fn absolute<D: Number>(v: &D) -> D {
    if v.re() == 0.0 { (*v * *v).sqrt() } else { v.abs() }
}

/// The hyperbolic tangent from an exponential that cannot overflow, however steep a step it describes;
/// sinh/cosh, by which dual numbers have it, is not a number beyond about 355.
fn tanh<D: Number>(v: &D) -> D {
    if D::NDERIV == 0 {
        return v.tanh();
    }
    let side = if v.re() < 0.0 { 2.0 } else { -2.0 };
    let decay = (*v * side).exp_m1();
    decay / (decay + 2.0) * (side * 0.5)
}

/// Splits a dual number into its absolute value and what remains when measured by that. This keeps the squares
/// in the rules of derivation within range (think of `1/(1 + exp(500*x))`), and the results for the absolute
/// value are the same doubles as without derivatives.
fn measured<D: Number>(v: D) -> Option<(D, f64)> {
    let scale = v.re().abs();
    (D::NDERIV > 0 && scale.is_normal()).then(|| (v / scale, scale))
}

fn quotient<D: Number>(left: D, right: D) -> D {
    measured(right).map_or_else(|| left / right, |(unit, scale)| left / unit / scale)
}

fn ln<D: Number>(v: &D) -> D {
    measured(*v).map_or_else(|| v.ln(), |(unit, scale)| unit.ln() + scale.ln())
}

fn sqrt<D: Number>(v: &D) -> D {
    measured(*v).map_or_else(|| v.sqrt(), |(unit, scale)| unit.sqrt() * scale.sqrt())
}

fn power<D: Number>(base: D, exponent: D) -> D {
    if D::NDERIV == 0 { base.powd(exponent) } else { (ln(&base) * exponent).exp() }
}

/// The power with an exponent that does not depend on `x`.
fn fixed_power<D: Number>(base: D, exponent: f64) -> D {
    if D::NDERIV > 0 && base.re() == 0.0 && exponent < 0.0 {
        // The value at the pole is infinite and not NaN, so that `min(x^-1, 3)` is 3 there.
        return D::one() / fixed_power(base, -exponent);
    }
    if exponent.fract() == 0.0 && exponent.abs() <= 16.0 {
        #[expect(clippy::cast_possible_truncation, reason = "a small whole number")]
        let n = exponent as i32;
        return measured(base).map_or_else(|| base.powi(n), |(unit, scale)| unit.powi(n) * scale.powi(n));
    }
    match measured(base) {
        Some((unit, scale)) => unit.powf(exponent) * scale.powf(exponent),
        // At zero there are two derivatives, both zero, from the square on, and only a value below that.
        None if D::NDERIV > 0 && base.re() == 0.0 && exponent > 2.0 => D::zero(),
        None if D::NDERIV > 0 && base.re() == 0.0 && exponent > 0.0 => base.sqrt(),
        None => base.powf(exponent),
    }
}

/// What is done to the stack: a number is added, or the topmost one or two are replaced by a result.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Step {
    Constant(f64),
    Variable,
    Apply(Function),
    Binary(Binary),
    FixedPower(f64),
}

/// Why a step is not added, and a hint.
pub(super) type Refusal = (&'static str, &'static str);

pub(super) const TOO_DEEP: Refusal = ("nested more than 32 deep", "write it with fewer brackets");

const NOT_FINITE: Refusal = (
    "the result here is not a finite number",
    "check for a division by zero or a root or logarithm out of range",
);

/// The steps in the order in which they are done.
#[derive(Clone, Debug, Default)]
pub(super) struct Program {
    steps: Vec<Step>,
    /// The numbers on the stack after all steps, and the most at any step.
    depth: usize,
    deepest: usize,
}

impl Program {
    /// Adds a step. What does not depend on `x` is computed here and now, and must be finite.
    pub(super) fn add(&mut self, step: Step) -> Result<(), Refusal> {
        let (replaced, step) = match (self.steps.as_slice(), step) {
            ([.., Step::Constant(v)], Step::Apply(function)) => (1, Step::Constant(function.on(*v))),
            ([.., Step::Constant(v), Step::Constant(w)], Step::Binary(operation)) => {
                (2, Step::Constant(operation.on(*v, *w)))
            }
            ([.., Step::Constant(n)], Step::Binary(Binary::Power)) => (1, Step::FixedPower(*n)),
            _ => (0, step),
        };
        match (replaced, step) {
            (_, Step::Constant(value)) if !value.is_finite() => return Err(NOT_FINITE),
            (0, Step::Constant(_) | Step::Variable) if self.depth == STACK => return Err(TOO_DEEP),
            (0, Step::Constant(_) | Step::Variable) => self.depth += 1,
            (2, _) | (_, Step::Binary(_) | Step::FixedPower(_)) => self.depth -= 1,
            _ => {}
        }
        self.deepest = self.deepest.max(self.depth);
        self.steps.truncate(self.steps.len() - replaced);
        self.steps.push(step);
        Ok(())
    }

    /// The value of a program which does not depend on `x`.
    pub(super) fn constant(&self) -> Option<f64> {
        if let [Step::Constant(value)] = *self.steps { Some(value) } else { None }
    }

    /// The name of the first function with kinks.
    pub(super) fn kinked(&self) -> Option<&'static str> {
        self.steps.iter().find_map(|step| match step {
            Step::Apply(Function::Abs) => Some("abs"),
            Step::Binary(Binary::Least) => Some("min"),
            Step::Binary(Binary::Greatest) => Some("max"),
            _ => None,
        })
    }

    /// Does all steps; an empty program yields NaN.
    pub(super) fn run<D: Number>(&self, x: D) -> D {
        if self.deepest <= SMALL_STACK {
            self.run_on::<D, SMALL_STACK>(x)
        } else {
            self.run_on::<D, STACK>(x)
        }
    }

    fn run_on<D: Number, const SIZE: usize>(&self, x: D) -> D {
        let mut stack = [D::from(f64::NAN); SIZE];
        let mut top = 0;
        for step in &self.steps {
            match *step {
                Step::Constant(_) | Step::Variable => {
                    stack[top] = if let Step::Constant(value) = *step { D::from(value) } else { x };
                    top += 1;
                }
                Step::Apply(function) => stack[top - 1] = function.on(stack[top - 1]),
                Step::FixedPower(exponent) => stack[top - 1] = fixed_power(stack[top - 1], exponent),
                Step::Binary(operation) => {
                    top -= 1;
                    stack[top - 1] = operation.on(stack[top - 1], stack[top]);
                }
            }
        }
        stack[0]
    }
}
