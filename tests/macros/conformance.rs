//! The constructs of custom macro B, one by one: a small program each, its output worked out by hand.
//!
//! docs/macros.md lists them with the rule and where it is written; a row there names a test here.

use dripfeed::macros::options::{Control, Options, Pointless, Semicolon, Skip};
use dripfeed::macros::program::NoPrograms;

use crate::spelling::{Shelf, made, made_with, options};

fn with(change: impl FnOnce(&mut Options), text: &str) -> String {
    let mut options = options();
    change(&mut options);
    made_with(text, &options, &mut NoPrograms)
}

/// What an expression comes to: the number behind X, or the error without its place.
fn value(expression: &str) -> String {
    let made = made(&format!("#1=3\n#2=-2.5\n#100={expression}\nX#100\n"));
    match made.strip_prefix('X') {
        Some(value) => value.to_owned(),
        None => made.splitn(3, ": ").last().unwrap_or_default().to_owned(),
    }
}

#[test]
fn spellings() {
    // Blanks mean nothing; letters may be small; noughts in front mean nothing; remarks stand anywhere.
    let plain = made("#1=3\nWHILE[#1GT1]DO1\nG01 X#1\n#1=#1-1\nEND1\n");
    assert_eq!(plain, "G01 X3; G01 X2");
    let spaced = "# 1 = 3.0\nwhile [ #01 gt 1. ] do 1\ng01 (to the left) x #1\n#1 = # 1 (less) - 1\nend 1\n";
    assert_eq!(made(spaced), "G01 X3 (to the left); G01 X2 (to the left)");
    assert_eq!(made("X007.50 Y-.5 Z+4. A - 1.5\n"), "X007.50 Y-.5 Z+4. A- 1.5");
    assert_eq!(made("#1=2\nX-#1 Y+#1 Z-[#1+1] A[-#1] B#[1]\n"), "X-2 Y2 Z-3 A-2 B2");
    assert_eq!(made("\u{feff}%\nO0001 (NAME)\nN010 G00 X1.\nM30\n%\n"), "(NAME); N10 G00 X1.; M30");
    assert_eq!(made("X1.\r\nX2.\rX3."), "X1.; X2.; X3.");
    // Several statements in a block: in the order they stand, the words behind them all.
    assert_eq!(made("#1=1 #2=#1+1 G01 X#1 Y#2\nZ#1\n"), "G01 X1 Y2; Z1");
    for (text, says) in [
        ("X1. #1=5\n", "1:5: an assignment behind the words of a block"),
        ("X1. GOTO5\nN5\n", "GOTO behind the words of a block"),
        ("X1. IF[1EQ2]THEN#1=5\n", "IF behind the words of a block"),
        ("IF[1EQ2]GOTO5 X1.\nN5\n", "words of a block behind a branch or a loop"),
        ("DO1 X1.\nEND1\n", "words of a block behind a branch or a loop"),
        ("IF[1EQ2]THEN#1=5 #2=6\n", "a second statement behind THEN"),
    ] {
        assert!(made(text).contains(says), "{text}: {}", made(text));
    }
}

#[test]
fn a_semicolon_is_an_end_a_remark_or_refused() {
    assert_eq!(made("X1. ;\nX2. ; to the right\n"), "X1.; X2.");
    assert!(made("X1. ; X2.\n").contains("error 1:5: text behind `;` that reads as a block"));
    assert_eq!(with(|o| o.semicolon = Semicolon::EndOfBlock, "#1=1 ; #1=#1+1 ; X#1 ;\nY1."), "X2; Y1.");
    assert_eq!(with(|o| o.semicolon = Semicolon::Remark, "X1. ; X2.\n"), "X1. ( X2.)");
}

#[test]
fn operations_and_their_order() {
    for (expression, expected) in [
        ("#1+2", "5"),
        ("#1-#2", "5.5"),
        ("#1*#2", "-7.5"),
        ("#1/2", "1.5"),
        ("27 MOD 20", "7"),
        ("-#1", "-3"),
        ("-[#1+1]", "-4"),
        ("1+2*3", "7"),
        ("[1+2]*3", "9"),
        ("10-4-3", "3"),
        ("16/4/2", "2"),
        ("2*7 MOD 4", "2"),
        // Multiplication with AND, then addition with OR and XOR.
        ("1+6 AND 3", "3"),
        ("1 OR 2+4", "7"),
        ("5 XOR 3", "6"),
        ("12 AND 10", "8"),
        ("1+SIN[30]*4", "3"),
        ("[[[[[1]]]]]", "1"),
        ("#1--2", "5"),
    ] {
        assert_eq!(value(expression), expected, "{expression}");
    }
}

#[test]
fn functions() {
    for (expression, expected) in [
        ("SIN[30]", "0.5"),
        ("COS[60]", "0.5"),
        ("TAN[45]", "1"),
        ("ASIN[0.5]", "30"),
        ("ACOS[0.5]", "60"),
        ("ATAN[1]", "45"),
        ("ATAN[1]/[-1]", "135"),
        ("ATAN[-1]/[-1]", "225"),
        ("ATAN[1,-1]", "135"),
        ("ATAN[1]/2", "22.5"),
        ("SQRT[6.25]", "2.5"),
        ("SQRT[-0.000000000001]", "0"),
        ("ABS[#2]", "2.5"),
        ("FIX[-2.7]", "-2"),
        ("FUP[-2.1]", "-3"),
        ("FUP[2.1]", "3"),
        ("LN[1]", "0"),
        ("EXP[0]", "1"),
        ("POW[2,10]", "1024"),
        ("BIN[37]", "25"),
        ("BCD[25]", "37"),
        // The first two letters alone are read.
        ("SQ[16]+RO[1.6]+FI[1.6]", "7"),
    ] {
        assert_eq!(value(expression), expected, "{expression}");
    }
}

#[test]
fn round_in_an_expression_and_in_a_word() {
    // Haas 96-8000, page 374: "#1= 1.714 ; #2= ROUND[#1] ; (#2 is set to 2.0)", 3.1416 to 3.
    assert_eq!(value("ROUND[1.714]"), "2");
    assert_eq!(value("ROUND[3.1416]"), "3");
    assert_eq!(value("ROUND[-2.5]"), "-3");
    // "#1= 1.00333 ; G0 X[ ROUND[ #1 ] + ROUND[ #1 ] ] ; (Table moves to 2.0066)", in inch; A to 2.006.
    let text = "G20\n#1=1.00333\nG0 X[ROUND[#1]+ROUND[#1]] Y[#1+#1]\nG0 A[ROUND[#1]+ROUND[#1]]\n";
    assert_eq!(made(text), "G20; G0 X2.0066 Y2.00666; G0 A2.006");
    assert_eq!(made("G21\n#1=1.00333\nX[ROUND[#1]] T[ROUND[1.67]]\n"), "G21; X1.003 T2");
    // In a comparison and behind G65 as in an expression.
    assert_eq!(made("IF[ROUND[1.4]EQ1]THEN#1=7\nX#1\n"), "X7");
    assert_eq!(made("G65 P1 A[ROUND[1.4]]\nM2\nO1\nX#1\nM99\n"), "X1; M2");
}

#[test]
fn variables_by_number_by_index_and_by_name() {
    assert_eq!(
        made("#33=1\n#100=2\n#199=3\n#500=4\n#999=5\nX#33 Y#100 Z#199 A#500 B#999\n"),
        "X1 Y2 Z3 A4 B5"
    );
    assert_eq!(made("#1=100\n#[#1+1]=7\nX#101 Y#[#1+1] Z#[#[1]+1]\n"), "X7 Y7 Z7");
    // The number of a variable is rounded to a whole one.
    assert_eq!(made("#101=7\nX#[100.6]\n"), "X7");
    assert_eq!(made("#<depth>=2\n#<_feed>=#<Depth>*3\nX#<depth> F#<_feed>\n"), "X2 F6");
    for (text, says) in [
        ("#0=1\n", "1:1: #0 is always undefined"),
        ("#34=1\n", "there is no variable #34"),
        ("X#200\n", "there is no variable #200"),
        ("X##1\n", "needs brackets"),
        ("#1=#2001\n", "1:4: #2001 is an offset kept in the machine: only the machine knows it"),
        ("#1=#1000\n", "an input or output"),
        ("#1=#3001\n", "a timer"),
        ("#1=#5061\n", "where a skip signal came"),
        ("#1=3001\nX#[#1]\n", "2:2: #3001 is a timer"),
        ("#2001=0\n", "a program without macros cannot set it"),
        ("#4001=1\n", "#4001 is read only"),
        ("#5001=1\n", "#5001 is read only"),
        ("#1=5001\n#[#1]=1\n", "#5001 is read only"),
        ("#1=#3011\n", "the date or the time"),
    ] {
        assert!(made(text).contains(says), "{text}: {}", made(text));
    }
    let dated = with(|o| o.date_time = Some((20_261_129, 131_500)), "X#3011 Y#3012\n");
    assert_eq!(dated, "X20261129 Y131500");
}

#[test]
fn null_in_words_and_calculations() {
    // A word whose number is undefined is dropped; a block without words is none.
    assert_eq!(made("G00 X#1 Y1.\nX#1\nX-#1 Z2.\nX[#1] A1.\n"), "G00 Y1.; Z2.; A1.");
    // Mitsubishi M700V, 13.5: `#1 = #0` stays undefined, `#0 + 1` is 1, `#0 * 10` and `#0 + #0` are 0.
    assert_eq!(made("#1=#0\n#2=#0+1\n#4=#0*10\n#5=#0+#0\nX#1 Y#2 Z#4 A#5\n"), "Y1 Z0 A0");
    assert_eq!(made("X[#1+10] Y1000.\n"), "X10 Y1000.");
    assert_eq!(made("#1=5\n#1=#0\nX#1 Y1.\n"), "Y1.");
}

#[test]
fn null_in_comparison() {
    // Mitsubishi M700V, 13.5, conditional expressions: undefined and 0 differ to EQ and NE alone.
    let holds = |first: &str, comparison: &str| {
        let text = format!("{first}\nIF[#101{comparison}]THEN#1=1\nX[#1+0]\n");
        made(&text) == "X1"
    };
    for (comparison, null, zero) in [
        ("EQ#0", true, false),
        ("NE0", true, false),
        ("EQ0", false, true),
        ("NE#0", false, true),
        ("GE#0", true, true),
        ("GT0", false, false),
        ("LE#0", true, true),
        ("LT0", false, false),
        ("GE0", true, true),
    ] {
        assert_eq!(holds("#101=#0", comparison), null, "undefined {comparison}");
        assert_eq!(holds("#101=0", comparison), zero, "0 {comparison}");
    }
}

#[test]
fn comparisons_and_conditions_joined() {
    let holds = |condition: &str| made(&format!("#1=3\n#2=4\nIF{condition}THEN#3=1\nX[#3+0]\n"));
    for (condition, expected) in [
        ("[#1EQ3]", "X1"),
        ("[#1NE3]", "X0"),
        ("[#1GT2]", "X1"),
        ("[#1GE3]", "X1"),
        ("[#1LT3]", "X0"),
        ("[#1LE3]", "X1"),
        ("[[#1EQ3]AND[#2EQ4]]", "X1"),
        ("[[#1EQ3]AND[#2EQ5]]", "X0"),
        ("[[#1EQ0]OR[#2EQ4]]", "X1"),
        ("[[#1EQ3]XOR[#2EQ4]]", "X0"),
        ("[#1+1EQ#2]", "X1"),
        ("[ABS[#1-#2]LT1.5]", "X1"),
    ] {
        assert_eq!(holds(condition), expected, "{condition}");
    }
    // A condition is no number to Fanuc; to Haas it is 1 or 0, and a number is a condition.
    assert!(made("#1=[2GT1]\n").contains("a condition is no number here"));
    assert!(made("WHILE[#1]DO1\nEND1\n").contains("a number where a condition is needed"));
    let haas = "#1=[2GT1]\nWHILE[#1]DO1\n#1=#1-1\nX#1\nEND1\nIF[#1]GOTO9\nY#1\nN9 M2\n";
    assert_eq!(with(|o| o.control = Control::Haas, haas), "X0; Y0; N9 M2");
    let set = "#1=[2GT1]\nIF[#1]GOTO9\nX1.\nN9 X#1\n";
    assert_eq!(with(|o| o.control = Control::Haas, set), "N9 X1");
    assert!(made("IF[#1GT0AND#2GT0]GOTO1\nN1\n").contains("a second comparison"));
}

#[test]
fn if_then_and_if_goto() {
    assert_eq!(made("IF[1EQ1]THEN#1=5\nIF[1EQ2]THEN#1=6\nX#1\n"), "X5");
    assert_eq!(made("#1=1\nN1 X#1\n#1=#1+1\nIF[#1LE3]GOTO1\nY1.\n"), "N1 X1; N1 X2; N1 X3; Y1.");
    assert_eq!(made("#1=20\nIF[1EQ1]GOTO#1\nX1.\nN20 X2.\n"), "N20 X2.");
    assert!(made("IF[1EQ1]THEN X1.\n").contains("words of a block behind THEN"));
    let haas = with(|o| o.control = Control::Haas, "IF[1EQ1]THEN X1.\nIF[1EQ2]THEN X2.\nX3.\n");
    assert_eq!(haas, "X1.; X3.");
    // Haas: M99 with a condition goes to an N number of the main program.
    let haas = "#1=0\nN10 X#1\n#1=#1+1\n[#1 LT 3] M99 P10\nM30\n";
    assert_eq!(made(haas), "N10 X0; N10 X1; N10 X2; M30");
}

#[test]
fn goto_searches_forwards_first() {
    assert_eq!(made("N5 X1.\nGOTO 20\nX2.\nN20 X3.\n"), "N5 X1.; N20 X3.");
    assert_eq!(
        made("#1=0\nN7 X#1\n#1=#1+1\nIF[#1GT1]GOTO8\nGOTO[3+4]\nN7 Y1.\nN8 M2\n"),
        "N7 X0; N7 Y1.; N8 M2"
    );
    // The same number in front and behind: forwards first.
    assert_eq!(made("N1 X1.\nGOTO1\nX2.\nN1 X3.\n"), "N1 X1.; N1 X3.");
    assert!(made("GOTO 1.5\n").contains("error 1:6: an N number with a point"));
    assert!(made("GOTO 99\n").contains("error 1:1: there is no N99 in this program"));
    assert!(made("#1=99\nGOTO#1\n").contains("error 2:1: there is no N99 in the program"));
    assert!(made("GOTO5\nDO1\nN5 X1.\nEND1\n").contains("into the loop DO1 of line 2 from outside"));
    assert!(made("#1=5\nGOTO#1\nDO1\nN5 X1.\nEND1\n").contains("goes into a loop DO1 from outside"));
}

#[test]
fn loops_nest_and_numbers_are_used_again() {
    let text = "#1=0\nWHILE[#1LT2]DO1\n#2=0\nWHILE[#2LT2]DO2\nDO3\nX#1 Y#2\nGOTO1\nEND3\nN1 #2=#2+1\nEND2\n\
                #1=#1+1\nEND1\nWHILE[#1LT3]DO1\n#1=#1+1\nEND1\nZ#1\n";
    assert_eq!(made(text), "X0 Y0; X0 Y1; X1 Y0; X1 Y1; Z3");
    for (text, says) in [
        ("DO1\nDO1\nEND1\nEND1\n", "error 2:1: DO1 within the DO1 of line 1"),
        ("DO1\nDO2\nEND1\nEND2\n", "error 3:1: END1 within DO2: loops may not overlap"),
        ("END1\n", "END1 without DO1"),
        ("DO2\nEND1\nEND2\n", "END1 without DO1"),
        ("DO1\n", "error 1:1: DO1 without END1"),
        ("DO4\nEND4\n", "not 1, 2 or 3"),
        ("WHILE[1EQ1]\n", "WHILE without DO"),
    ] {
        assert!(made(text).contains(says), "{text}: {}", made(text));
    }
}

#[test]
fn arguments_of_specification_one() {
    let text = "G65 P9100 A1. B2. C3. I4. J5. K6. D7. E8. F9. H11. M13. Q17. R18. S19. T20. U21. V22. W23. X24. Y25. \
                Z26.\nM30\nO9100\nX#1 Y#2 Z#3\nX#4 Y#5 Z#6\nX#7 Y#8 Z#9\nX#11 Y#13 Z#17\nX#18 Y#19 Z#20\n\
                X#21 Y#22 Z#23\nX#24 Y#25 Z#26\nX#10 Y#12 Z#27 A0\nM99\n";
    let expected =
        "X1 Y2 Z3; X4 Y5 Z6; X7 Y8 Z9; X11 Y13 Z17; X18 Y19 Z20; X21 Y22 Z23; X24 Y25 Z26; A0; M30";
    assert_eq!(made(text), expected);
}

#[test]
fn arguments_of_specification_two() {
    let sets: String = (0..10).map(|n| format!("I{}. J{}. K{}. ", 4 + 3 * n, 5 + 3 * n, 6 + 3 * n)).collect();
    let body: String = (1..=33).map(|n| format!("X#{n}\n")).collect();
    let text = format!("G65 P1 A1. B2. C3. {sets}\nM30\nO1\n{body}M99\n");
    let expected: String = (1..=33).map(|n| format!("X{n}; ")).collect();
    assert_eq!(made(&text), expected + "M30");
    // Fanuc B-63684EN/01, page 278: `A1.0 B2.0 I-3.0 I4.0 D5.0`: the later of I4.0 and D5.0 holds.
    let mixed = "G65 P1 A1.0 B2.0 I-3.0 I4.0 D5.0\nM30\nO1\nX#1 Y#2 Z#4 A#7 B#3\nM99\n";
    assert_eq!(made(mixed), "X1 Y2 Z-3 A5; M30");
    assert!(made("G65 P1 J1. I2.\nM30\nO1\nM99\n").contains("I out of order among I, J and K"));
}

#[test]
fn an_argument_without_a_point_is_a_choice() {
    let text = "G65 P1 A5 D5 X-25 Z0 R1.5\nM30\nO1\nX#1 Y#7 Z#24 A#26 B#18\nM99\n";
    assert_eq!(with(|o| o.pointless = Pointless::Whole, text), "X5 Y5 Z-25 A0 B1.5; M30");
    assert_eq!(with(|o| o.pointless = Pointless::LeastIncrement, text), "X0.005 Y5 Z-0.025 A0 B1.5; M30");
    assert!(with(|o| o.pointless = Pointless::Refused, text).contains("an argument without a point"));
    // In inch the least increment of a length is a tenth of a thousandth, of an angle a thousandth degree.
    let inch = format!("G20\n{text}");
    let made = with(|o| o.pointless = Pointless::LeastIncrement, &inch);
    assert_eq!(made, "G20; X0.005 Y5 Z-0.0025 A0 B1.5; M30");
}

#[test]
fn g65_has_locals_of_its_own_and_repeats() {
    let text = "#1=9\n#100=1\nG65 P1 A2.\nX#1 Y#100 Z#2\nM30\nO1\nX#1 Y#2\n#1=#1+1\n#2=4\n#100=#1\nM99\n";
    assert_eq!(made(text), "X2; X9 Y3; M30");
    // Haas 96-8000, page 93: with L the arguments are set on the first repetition only.
    assert_eq!(made("G65 P1 L3 A1.\nM30\nO1\nX#1\n#1=#1+1\nM99\n"), "X1; X2; X3; M30");
    // An argument that is undefined leaves its variable undefined.
    assert_eq!(made("G65 P1 A#5 B2.\nM30\nO1\nX#1 Y#2\nM99\n"), "Y2; M30");
    assert_eq!(made("#1=2\nG65 P[#1+1] L#1 A[#1*2]\nM30\nO3\nX#1\nM99\n"), "X4; X4; M30");
    for (text, says) in [
        ("G65 A1.\n", "G65 without P"),
        ("G65 P1.5\n", "P of G65 is a whole number"),
        ("G65 P1 L0\nO1\nM99\n", "called no times"),
        ("G65 P77\n", "error 1:1: there is no program O0077"),
        ("#1=77\nG65 P#1\n", "there is no program O0077"),
        ("G01 G65 P1\nO1\nM99\n", "a word in front of G65"),
        ("G65 P1 N5\nO1\nM99\n", "N within a block"),
        ("G65 P1\nM30\nO1\nX1.\n", "error 3:1: O0001 was called and ends without M99"),
    ] {
        assert!(made(text).contains(says), "{text}: {}", made(text));
    }
}

#[test]
fn macro_calls_are_four_levels_deep() {
    let nest = |levels: u32| {
        let calls: String = (1..levels).map(|n| format!("O{n}\nG65 P{}\nX{n}.\nM99\n", n + 1)).collect();
        format!("G65 P1\nM30\n{calls}O{levels}\nX{levels}.\nM99\n")
    };
    assert_eq!(made(&nest(4)), "X4.; X3.; X2.; X1.; M30");
    assert!(made(&nest(5)).contains("macro calls more than 4 deep"));
    assert!(made("G65 P1\nM30\nO1\nG65 P1\nM99\n").contains("O0001 calls itself"));
    assert!(made("M98 P1\nM30\nO1\nM98 P1\nM99\n").contains("O0001 calls itself"));
}

#[test]
fn g66_calls_behind_every_motion() {
    let text = "G66 P1 A1.\nG00 X1.\nM08\nG04 P100\nG92 X1.\nX2. Y#5\n#2=3\nF100\nG67\nX3.\nM30\nO1\nZ#1\n#1=#1+1\nM99\n";
    // Arguments are set where G66 stands, not at each call: what the macro leaves in #1 it finds again.
    let expected = "G00 X1.; Z1; M08; G04 P100; G92 X1.; X2.; Z2; F100; X3.; M30";
    assert_eq!(made(text), expected);
    // A motion whose words are all dropped is none.
    assert_eq!(made("G66 P1\nX#1\nY2.\nG67\nM30\nO1\nZ1.\nM99\n"), "Y2.; Z1.; M30");
    assert_eq!(made("G66 P1 L2\nX1.\nG67\nM30\nO1\nZ1.\nM99\n"), "X1.; Z1.; Z1.; M30");
    // The caller's locals are untouched.
    assert_eq!(made("#1=5\nG66 P1 A2.\nX#1\nG67\nX#1\nM30\nO1\n#1=7\nM99\n"), "X5; X5; M30");
}

#[test]
fn modal_calls_in_one_another() {
    // NCT 99M, 20 (and Mitsubishi M700V, 13.5, note 2): N11 -> O2; N13 -> O3, each motion of which -> O2; N16.
    let text = "N10 G66 P2\nN11 G01 X11.\nN12 G66 P3\nN13 X13.\nN14 G67\nN15 G67\nN16 X16.\nM30\n\
                O2\nY20.\nM99\nO3\nZ30.\nZ31.\nM99\n";
    let expected = "N11 G01 X11.; Y20.; N13 X13.; Z30.; Y20.; Z31.; Y20.; N16 X16.; M30";
    assert_eq!(made(text), expected);
    assert!(made("G66 P1\nX1.\nM30\nO1\nG67\nM99\n").contains("G67 within a macro that was called by G66"));
    // G67 in a line of other codes, and without a call in force.
    assert_eq!(made("G40 G67 G80\nX1.\n"), "G40 G80; X1.");
}

#[test]
fn m98_works_with_the_locals_of_its_caller() {
    assert_eq!(made("#1=1\nM98 P1000 L2\nX#1\nM30\nO1000\nY#1\n#1=#1+1\nM99\n"), "Y1; Y2; X3; M30");
    // Other words of the block are made in front of the call, and in front of the return.
    assert_eq!(made("G00 X1. M98 P1\nM30\nO1\nY1. M99\n"), "G00 X1.; Y1.; M30");
    // Fanuc: the last four digits are the program, those in front how often.
    assert_eq!(made("M98 P30007\nM30\nO7\nY1.\nM99\n"), "Y1.; Y1.; Y1.; M30");
    assert_eq!(made("M98 P30007\nM30\nO30007\nY1.\nM99\nO7\nY2.\nM99\n"), "Y1.; M30");
    assert!(made("M98 P30007 L2\nM30\nO7\nM99\n").contains("there is no program O30007"));
    assert!(made("M98 P1 Q2\nM30\nO1\nM99\n").contains("Q in a call"));
}

#[test]
fn m99_with_p_goes_to_a_block_of_the_caller() {
    let text = "M98 P1\nX1.\nN30 X2.\nM30\nO1\nY1.\nM99 P30\nN30 Y2.\n";
    assert_eq!(made(text), "Y1.; N30 X2.; M30");
    let text = "G65 P1 L5\nX1.\nN30 X2.\nM30\nO1\nY1.\nM99 P[15*2]\n";
    assert_eq!(made(text), "Y1.; N30 X2.; M30");
    // In the main program it is a GOTO.
    assert_eq!(made("M99 P5\nX1.\nN5 X2.\nM30\n"), "N5 X2.; M30");
    assert!(made("M98 P1\nM30\nO1\nM99 P30\n").contains("there is no N30"));
}

#[test]
fn m99_of_the_main_program_needs_a_count() {
    let text = "#1=#1+1\n#100=#100+1\nX#1 Y#100\nM99\n";
    assert!(made(text).contains("M99 in the main program: it would run for ever"));
    // Locals are undefined again at every start, commons are kept.
    assert_eq!(with(|o| o.repeat = Some(3), text), "X1 Y1; X1 Y2; X1 Y3");
    assert_eq!(with(|o| o.repeat = Some(1), text), "X1 Y1");
}

#[test]
fn m97_calls_a_block_of_its_own_program() {
    let text = "M97 P100 L2\nX1.\nM30\nN100 Y1.\nM99\n";
    assert_eq!(made(text), "N100 Y1.; N100 Y1.; X1.; M30");
    assert!(made("M97 P100\nM30\n").contains("there is no N100"));
}

#[test]
fn programs_of_the_haas_manual() {
    // 96-8000, page 118: "The above macro could be used to initialize three sets of variables".
    let array = "O0300 (Initialize an array of variables) ;\nN1 IF [#2 NE #0] GOTO2 (B=base variable) ;\n\
                 #3000=1 (Base variable not given) ;\nN2 IF [#19 NE #0] GOTO3 (S=size of array);\n\
                 #3000=2 (Size of array not given) ;\nN3 WHILE [#19 GT 0] DO1 ;\n#19=#19-1 (Decrement count) ;\n\
                 #[#2+#19]=#22 (V=value to set array to) ;\nEND1 ;\nM99 ;\n";
    let calls = "#101=9\n#120=9\nG65 P300 B101. S20 (INIT 101..120 TO #0) ;\nG65 P300 B501. S5 V1 (TO 1.0) ;\n\
                 G65 P300 B550. S5 V0 (TO 0.0) ;\nX#101 Y#120 Z#501 A#505 B#506 C#554\nM30\n";
    let remark = "(Initialize an array of variables)";
    let expected = format!("{remark}; {remark}; {remark}; Z1 A1 C0; M30");
    assert_eq!(made(&format!("{calls}{array}")), expected);
    let missing = made(&format!("G65 P300 S5\nM30\n{array}"));
    assert_eq!(missing, format!("{remark}; error 5:1: the program raises alarm 1: Base variable not given"));
    // Page 217, M97 (shortened to two turns).
    let local = "O00011 (M97 CALL)\nT1 M06\nG00 G90 G54 X0 Y0 S1000 M03\nM97 P1000 L2\nG00 G90 Z1.\nM30\n\
                 N1000 G01 G91 Z-0.1\nG90 X2.\nM99\n";
    let expected = "(M97 CALL); T1 M06; G00 G90 G54 X0 Y0 S1000 M03; N1000 G01 G91 Z-0.1; G90 X2.; \
                    N1000 G01 G91 Z-0.1; G90 X2.; G00 G90 Z1.; M30";
    assert_eq!(made(local), expected);
}

#[test]
fn programs_from_beside() {
    let mut shelf = Shelf::default();
    shelf.0.insert(9100, b"%\nO9100\nX#1\nM98 P9101\nM99\n%\n".to_vec());
    shelf.0.insert(9101, b"(no number)\nY1.\nM99\n".to_vec());
    let made = |text: &str, shelf: &mut Shelf| made_with(text, &options(), shelf);
    assert_eq!(made("G65 P9100 A1.\nM30\n", &mut shelf), "X1; (no number); Y1.; M30");
    // A computed number: all of them are there.
    assert_eq!(made("#1=9101\nM98 P#1\nM30\n", &mut shelf), "(no number); Y1.; M30");
    shelf.0.insert(9103, b"O9104\nM99\n".to_vec());
    assert!(made("M98 P9103\nM30\n", &mut shelf).contains("the text of O9103 holds O9104"));
    shelf.0.insert(9102, b"X1.\nX#3001\nM99\n".to_vec());
    assert!(made("M98 P9102\nM30\n", &mut shelf).contains("error 2:2: in O9102: #3001 is a timer"));
}

#[test]
fn several_programs_in_a_text() {
    let text = "%\n(HEAD)\nO0001 (MAIN)\nM98 P2\nM30\n:0002\nX1.\nM99\n%\n";
    assert_eq!(made(text), "(HEAD); (MAIN); X1.; M30");
    assert!(made("O1\nM30\nO1\nM30\n").contains("O0001 stands here and in line 1"));
    assert!(made("%\nX1.\n%\nX2.\n").contains("text behind the end of the tape"));
    // GOTO finds numbers of its own program only.
    assert!(made("GOTO5\nM30\nO2\nN5 X1.\nM99\n").contains("there is no N5 in this program"));
}

#[test]
fn alarms_and_stops() {
    let text = "X1.\nIF[1GT0]THEN#3000=21(DEPTH TOO LARGE)\nX2.\n";
    assert_eq!(made(text), "X1.; error 2:13: the program raises alarm 21: DEPTH TOO LARGE");
    assert_eq!(made("X1.\n#3006=1(TURN THE PART)\nX2.\n"), "X1.; M0 (TURN THE PART); X2.");
    assert_eq!(made("#3006=1\n"), "M0");
}

#[test]
fn errors_of_calculation_have_their_place_and_end_the_output() {
    for (text, says) in [
        ("X1.\n#1=1/0\nX2.\n", "X1.; error 2:4: division by zero"),
        ("#1=5 MOD 0\n", "division by zero"),
        ("#1=SQRT[-1]\n", "error 1:4: SQRT of -1, a negative number"),
        ("#1=LN[0]\n", "LN of 0"),
        ("#1=ASIN[2]\n", "ASIN of 2"),
        ("#1=TAN[90]\n", "TAN of 90 degrees has no value"),
        ("#1=1.5 AND 1\n", "AND takes whole numbers"),
        ("GOTO#1\n", "a number that is undefined"),
    ] {
        assert!(made(text).starts_with(says) || made(text).contains(says), "{text}: {}", made(text));
    }
}

#[test]
fn modal_codes_and_positions() {
    let text = "G21 G91 G01 X1. F200 S5\n#1=#4001 #2=#4003 #3=#4109 #4=#4006 #5=#4119\nX#1 Y#2 Z#3 A#4 B#5\n";
    assert_eq!(made(text), "G21 G91 G01 X1. F200 S5; X1 Y91 Z200 A21 B5");
    // Kept and put back, as macros do.
    assert_eq!(made("G90\n#3=#4003\nG91 X1.\nG#3 X2.\n"), "G90; G91 X1.; G90 X2.");
    let text = "G92 X10. Y0\nG91 G01 X5.\nG90 Y7.\n#1=#5001 #2=#5002\nX[#1+1] Y#2\n";
    assert_eq!(made(text), "G92 X10. Y0; G91 G01 X5.; G90 Y7.; X16 Y7");
    // A change of the unit is followed: 25.4 mm are one inch.
    assert_eq!(made("G21 G90 X25.4\nG20\nY[#5001]\n"), "G21 G90 X25.4; G20; Y1");
    for (text, says) in [
        ("#1=#5001\n", "where X stands is not known here"),
        ("G91 X1.\n#1=#5001\n", "where X stands is not known here"),
        ("G90 X1.\nG28 X0.\n#1=#5001\n", "not known here"),
        ("#1=#4001\n", "no G code of group 1 was commanded so far"),
        ("#1=#4109\n", "no F was commanded so far"),
        ("G90 X1.\n#1=#5004\n", "names no axis 4"),
    ] {
        assert!(made(text).contains(says), "{text}: {}", made(text));
    }
}

#[test]
fn words_that_only_the_machine_can_run() {
    assert!(made("G31 X1.\n").contains("error 1:1: G31 ends where a signal comes"));
    assert!(made("#1=31\nG#1 X1.\n").contains("G31 is computed"));
    assert!(made("#1=65\nG#1 P1\n").contains("G65 is computed"));
    assert!(made("#1=99\nM#1\n").contains("M99 is computed"));
    assert!(made("G66.1 P1\n").contains("G66.1"));
    assert_eq!(made("#1=30\nM#1\nX1.\n"), "M30");
}

#[test]
fn block_skip() {
    // Not known: a block keeps its sign, what cannot keep it is refused.
    assert_eq!(made("/X1.\n/2 N5 X2.\nN6 /3 X3.\n"), "/1 X1.; /2 N5 X2.; /3 N6 X3.");
    assert!(made("/#1=1\n").contains("decided by a switch"));
    assert!(made("/M98 P1\nM30\nO1\nM99\n").contains("decided by a switch"));
    assert!(made("/M30\nX1.\n").contains("decided by a switch"));
    // Known: left out, or made without.
    let text = "#1=1\n/#1=2\n/2 #1=#1+10\n/X1.\n/2 Y2.\nX#1\n";
    assert_eq!(with(|o| o.skip = Skip::Switches(0), text), "X1.; Y2.; X12");
    assert_eq!(with(|o| o.skip = Skip::Switches(1 << 1), text), "Y2.; X11");
    assert_eq!(with(|o| o.skip = Skip::Switches(1 << 2), text), "X1.; X2");
    // Whether a block ran is not known, so its end is not either.
    assert!(made("G90 X1.\n/X2.\n#1=#5001\n").contains("where X stands is not known"));
}

#[test]
fn remarks() {
    let text = "(ONE)\nX1. (TWO)\n#1=1 (THREE)\n(FOUR) (FIVE)\n";
    assert_eq!(made(text), "(ONE); X1. (TWO); (FOUR) (FIVE)");
    assert_eq!(with(|o| o.remarks = false, text), "X1. (TWO)");
    assert!(made("X1. (ONE\n").contains("error 1:5: the remark is not closed"));
}

#[test]
fn nothing_unknown_passes() {
    for (text, says) in [
        ("X\n", "1:1: `X`: a letter without its number"),
        ("X1. X2.\n", "1:5: X: the block has this word already"),
        ("FOO1\n", "1:1: `FOO` is no word"),
        ("XSIN[1]\n", "`XSIN` is no word"),
        ("X#1+1\n", "1:4: `+` behind a word"),
        ("#1\n", "`#1` alone does nothing"),
        ("#1=\n", "the line ends where a number is needed"),
        ("#1=1+\n", "the line ends where a number is needed"),
        ("#1=[1+2\n", "where `]` is needed"),
        ("#1=FOO[1]\n", "`FOO` is no function"),
        ("#1=SIN 30\n", "is needed behind SIN"),
        ("#1=1.2.3\n", "two points"),
        ("#1=1 0\n", "1:6: a blank within a number"),
        ("#1=1234567890123456789\n", "more than 18 digits"),
        ("#1=2*-+3\n", "two signs"),
        ("THEN#1=1\n", "THEN without IF"),
        ("IF[1EQ1]\n", "without GOTO or THEN"),
        ("IF[1EQ1]THEN\n", "nothing behind it"),
        ("IF[1EQ1]THEN WHILE[1EQ1]DO1\nEND1\n", "WHILE behind THEN"),
        ("DPRNT[X#1]\n", "DPRNT is not of the language"),
        ("ELSE\n", "ELSE is not of the language"),
        ("X1. = 2\n", "`=2` begins no statement"),
        ("G01 ,R1.\n", "words of corners"),
        ("$1\n", "`$1` begins no statement"),
        ("X1. N5\n", "N within a block"),
        ("[1EQ1] X1.\n", "not M99"),
        ("M99 P1 L2\n", "L behind M99"),
    ] {
        let made = made(text);
        assert!(made.starts_with("error ") && made.contains(says), "{text}: {made}");
    }
}
