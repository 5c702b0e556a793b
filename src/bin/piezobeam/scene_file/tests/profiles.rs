//! Complaints about profiles.

use super::complaint;

/// The message about this load, which is on line 5.
#[track_caller]
fn profile(value: &str) -> String {
    let message = complaint(&format!("[load]\ntransverse = {value}"));
    let short = message.strip_prefix("5: load.transverse");
    short.map_or(message.clone(), str::to_owned)
}

#[test]
fn shapes_of_profiles_are_checked() {
    let forms = "give a number, a formula in quotes, { polynomial = [..] }, \
                 { breaks = [..], values = [..] }, { breaks = [..], polynomials = [..] } \
                 or { x = [..], y = [..] }";
    assert_eq!(profile("true"), format!(": expected a profile, found the boolean true; {forms}"));
    assert_eq!(profile("{}"), format!(": expected a profile, found an empty table; {forms}"));
    for (value, message) in [
        (
            "[1, 2]",
            ": expected a profile, found an array of 2 elements; \
             name what the numbers are, as in { polynomial = [1, 2] }",
        ),
        ("{ polynomial = [] }", ".polynomial: expected an array of numbers, found an empty one"),
        ("{ polynomial = 1 }", ".polynomial: expected an array of numbers, found the number 1"),
        (
            "{ breaks = [0.5] }",
            ": breaks without values; \
             add values = [..] or polynomials = [..], one more than there are breaks",
        ),
        ("{ values = [0.5] }", ": values without breaks; add breaks = [..], one fewer than there are pieces"),
        (
            "{ breaks = [0.5], values = [1, 2, 3] }",
            ".values: expected 2 entries, found 3; 1 break parts the beam into 2 pieces",
        ),
        (
            "{ breaks = [0.25, 0.5], polynomials = [[1]] }",
            ".polynomials: expected 3 entries, found 1; 2 breaks part the beam into 3 pieces",
        ),
        (
            "{ breaks = [0.5], polynomials = [1, 2] }",
            ".polynomials[0]: expected an array of numbers, found the number 1",
        ),
        (
            "{ breaks = [0.5, 0.5], values = [1, 2, 3] }",
            ".breaks[1]: 0.5 does not exceed 0.5 before it; \
             write the positions in strictly increasing order",
        ),
        (
            "{ breaks = [0.5, 1], values = [1, 2, 3] }",
            ".breaks[1]: 1 is not inside the beam; breaks lie strictly between 0 and 1",
        ),
        ("{ x = [0, 1], y = [1] }", ".y: 1 values for 2 positions; give one y for each x"),
        (
            "{ x = [0, 0.9], y = [1, 2] }",
            ".x: the table covers 0 to 0.9 of the beam only; let x reach from 0 to 1",
        ),
        ("{ x = [0, 1] }", ": x without y; add y = [..], one value for each x"),
        ("{ y = [0, 1] }", ": y without x; add x = [..], one position for each y"),
    ] {
        assert_eq!(profile(value), message, "{value}");
    }
    assert_eq!(profile("{ polynom = [1] }"), ".polynom: unknown key; did you mean \"polynomial\"?");
    assert_eq!(
        profile("{ polynomial = [1,\n 1e999] }"),
        "6: load.transverse.polynomial[1]: 1e999 is beyond the range of double precision; \
         use numbers up to about 1.8e308"
    );
    assert_eq!(
        profile("{ polynomial = [1], values = [1] }"),
        format!(": polynomial and values do not go together; {forms}")
    );
}

#[test]
fn formulas_are_checked() {
    assert_eq!(
        profile("\"0.4*sin(y)\""),
        ": in \"0.4*sin(y)\": unknown name \"y\" at character 9; \
         x is the position, L the length, and pi, e and tau are numbers"
    );
    assert_eq!(
        profile("\"2x\""),
        ": in \"2x\": expected an operator, found \"x\" at character 2; write * for a product"
    );
    assert_eq!(
        complaint("[foundation]\nstiffness = 1\ngap = \"abs(x - 0.5)\""),
        "6: foundation.gap: in \"abs(x - 0.5)\": abs has kinks, \
         and the first two derivatives are needed here; \
         give the pieces between the kinks as { breaks = [..], polynomials = [..] }"
    );
}
