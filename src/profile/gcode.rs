//! How a machine wants macro programs counted and the blocks made of them spelled: sections `[macros]` and `[gcode]`.

use crate::keys::{KeyError, Section};
use crate::macros::form::{Form, Numbering, Point};
use crate::macros::options::{Control, Options, Pointless, Semicolon};

/// What macro programs count with.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum Arithmetic {
    /// Decimals, as the programmer wrote them.
    #[default]
    Decimal,
    /// Binary floating point, as some controls do.
    Binary,
}

/// Words of `[macros] numbers`.
const ARITHMETIC: [(&str, Arithmetic); 2] = [("decimal", Arithmetic::Decimal), ("f64", Arithmetic::Binary)];

/// Takes over what `[gcode]` gives; `given` is told of every key whether it was.
pub(super) fn form(
    form: &mut Form,
    section: &Section<'_>,
    given: &mut impl FnMut(&'static str, bool),
) -> Result<(), KeyError> {
    let decimals = section.whole("decimals", 0..=9)?;
    given("decimals", decimals.is_some());
    form.decimals[0] = decimals.map_or(form.decimals[0], |n| n as u8);
    let decimals = section.whole("decimals_inch", 0..=9)?;
    given("decimals_inch", decimals.is_some());
    form.decimals[1] = decimals.map_or(form.decimals[1], |n| n as u8);
    let point = section.word("point", &[("always", Point::Always), ("never", Point::Never)])?;
    given("point", point.is_some());
    form.point = point.unwrap_or(form.point);
    for (key, value) in [
        ("trailing_zeros", &mut form.trailing_zeros),
        ("leading_zero", &mut form.leading_zero),
        ("blanks", &mut form.blanks),
        ("comments", &mut form.remarks),
    ] {
        let switch = section.switch(key)?;
        given(key, switch.is_some());
        *value = switch.unwrap_or(*value);
    }
    let numbers = numbering(section, form.numbers)?;
    given("n_numbers", numbers.is_some());
    form.numbers = numbers.unwrap_or(form.numbers);
    let longest = section.whole("line_max", 0..=100_000)?;
    given("line_max", longest.is_some());
    if let Some(most) = longest {
        form.line_max = (most > 0).then_some(most as usize);
    }
    Ok(())
}

/// `n_numbers` with `n_step` and `n_last`, which may also change a count that stands.
fn numbering(section: &Section<'_>, now: Numbering) -> Result<Option<Numbering>, KeyError> {
    let words = [("keep", Numbering::Keep), ("strip", Numbering::Strip), ("count", COUNT)];
    let said = section.word("n_numbers", &words)?;
    let (step, last) = (section.whole("n_step", 1..=10_000)?, section.whole("n_last", 1..=999_999_999)?);
    let now = match (said, now) {
        (Some(Numbering::Count { .. }), Numbering::Count { .. }) => now,
        (Some(said), _) => said,
        (None, now) => now,
    };
    let Numbering::Count { step: step_now, last: last_now } = now else {
        return match (step, last) {
            (Some(_), _) => Err(section.error("n_step", NOT_COUNTED, None)),
            (_, Some(_)) => Err(section.error("n_last", NOT_COUNTED, None)),
            (None, None) => Ok(said),
        };
    };
    let (step, last) = (step.map_or(step_now, |n| n as u32), last.map_or(last_now, |n| n as u32));
    if step > last {
        let message = format!("`n_step` is {step}, beyond `n_last`, which is {last}");
        return Err(section.error("n_step", message, None));
    }
    Ok((said.is_some() || step != step_now || last != last_now).then_some(Numbering::Count { step, last }))
}

/// A count as it is where no step and no end are given.
const COUNT: Numbering = Numbering::Count { step: 10, last: 9999 };

const NOT_COUNTED: &str = "goes with `n_numbers = \"count\"`";

/// Takes over what `[macros]` gives; returns what it says to count with.
pub(super) fn macros(
    rules: &mut Options,
    form: &mut Form,
    section: &Section<'_>,
    given: &mut impl FnMut(&'static str, bool),
) -> Result<Option<Arithmetic>, KeyError> {
    let control = section.word("control", &[("fanuc", Control::Fanuc), ("haas", Control::Haas)])?;
    given("control", control.is_some());
    rules.control = control.unwrap_or(rules.control);
    let pointless = section.word(
        "without_point",
        &[
            ("refuse", Pointless::Refused),
            ("whole", Pointless::Whole),
            ("increment", Pointless::LeastIncrement),
        ],
    )?;
    given("without_point", pointless.is_some());
    if let Some(pointless) = pointless {
        rules.pointless = pointless;
        form.without_point = match pointless {
            Pointless::Refused => [None; 2],
            Pointless::Whole => [Some(1_000_000), Some(25_400_000)],
            Pointless::LeastIncrement => [Some(1_000), Some(2_540)],
        };
    }
    let semicolon = section.word(
        "semicolon",
        &[
            ("refuse", Semicolon::Refused),
            ("end-of-block", Semicolon::EndOfBlock),
            ("remark", Semicolon::Remark),
        ],
    )?;
    given("semicolon", semicolon.is_some());
    rules.semicolon = semicolon.unwrap_or(rules.semicolon);
    let arithmetic = section.word("numbers", &ARITHMETIC)?;
    given("numbers", arithmetic.is_some());
    Ok(arithmetic)
}
