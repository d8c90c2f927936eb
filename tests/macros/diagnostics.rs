//! What is said of a program before it runs, and of one that does not end.

use dripfeed::check::Severity;
use dripfeed::macros::decimal::Decimal;
use dripfeed::macros::program::NoPrograms;
use dripfeed::macros::program::Program;

use crate::spelling::{made, options, parsed};

/// Severity, code, line and message of everything found without running.
fn found(text: &str) -> Vec<String> {
    let one = |f: &dripfeed::macros::findings::Finding| {
        let mark = if f.severity == Severity::Error { "error" } else { "warning" };
        format!("{mark} {} {}: {}", f.error.code, f.error.place.line, f.error.message)
    };
    parsed(text).check::<Decimal>().iter().map(one).collect()
}

const PRINTED: &str = "#110=0.02\n#101=25\nWHILE[#101GT25]DO1\n#101=#101-#110\n\
    #102=SQRT[25-[#101-20]*[#101-20]]+20\n#103=SQRT[40000-#101*#101]\nG01 X[#101] Y[#102] Z[#103] F200\nEND1\n";

#[test]
fn the_papers_program_as_printed_is_refused_with_its_values() {
    assert_eq!(
        found(PRINTED),
        ["error loop-never-runs 3: the loop never runs: `#101` is 25, the loop runs while `#101` GT 25"]
    );
    assert!(found(&PRINTED.replace("GT25", "GT20")).is_empty());
    // Mirrored, and in front of a value that is not known.
    let mirrored = PRINTED.replace("#101GT25", "25LT#101");
    assert!(
        found(&mirrored)[0].contains("`#101` is 25, the loop runs while `25` LT #101"),
        "{:?}",
        found(&mirrored)
    );
    let unknown = PRINTED.replace("#101=25\n", "#101=#500\n#500=#101\n");
    assert!(!found(&unknown).iter().any(|f| f.starts_with("error")), "{:?}", found(&unknown));
}

#[test]
fn a_loop_whose_bound_is_a_setting_is_only_warned_of() {
    let text = "#1=0\n#2=0\nWHILE[#1LT#2]DO1\nX#1\n#1=#1+1\nEND1\n";
    let expected = "warning loop-never-runs 3: the loop never runs: `#1` is 0, `#2` is 0, the loop runs while `#1` LT #2";
    assert_eq!(found(text), [expected]);
}

#[test]
fn a_step_of_the_wrong_sign_is_told_from_a_loop_that_never_runs() {
    let wrong = PRINTED.replace("GT25", "GT20").replace("#101-#110\n", "#101+#110\n");
    assert_eq!(
        found(&wrong),
        [
            "error loop-endless 3: the loop cannot end: `#101` is 25 and grows by 0.02 each turn, the loop runs while \
          `#101` GT 20"
        ]
    );
    for (start, condition, step, is_endless) in [
        ("0", "LT10", "+1", false),
        ("0", "LT10", "-1", true),
        ("0", "LE10", "-0.5", true),
        ("0", "LT10", "+0", true),
        ("20", "GE10", "+1", true),
        ("20", "GE10", "-1", false),
        ("0", "NE10", "+2", false),
        ("0", "NE10", "+3", true),
        ("0", "NE10", "-2", true),
        ("0", "NE1", "+0.1", false),
    ] {
        let text = format!("#1={start}\nWHILE[#1{condition}]DO1\n#1=#1{step}\nX#1\nEND1\n");
        let found = found(&text);
        assert_eq!(found.iter().any(|f| f.starts_with("error loop-endless")), is_endless, "{text} {found:?}");
    }
}

#[test]
fn ways_out_of_a_loop_are_seen() {
    let endless = |body: &str| {
        let text = format!("#1=0\nWHILE[#1LT10]DO1\n{body}\nEND1\nN9 M30\nO1\n#1=#1+1\nM99\n");
        found(&text).iter().any(|f| f.contains("loop-endless"))
    };
    assert!(endless("X1."));
    assert!(endless("IF[#1EQ5]THEN#2=1"));
    for way in ["IF[#2EQ5]GOTO9", "M98 P1", "#3000=1(NO)", "M30", "#[#2+1]=5", "#1=#1+1", "#1=#1*2", "GOTO#2"]
    {
        assert!(!endless(way), "{way}");
    }
    assert!(found("DO1\nX1.\nEND1\n")[0].contains("the loop DO1 cannot end: it has no condition"));
    assert!(found("DO1\nX1.\nIF[#1EQ1]GOTO5\nEND1\nN5 M30\n").is_empty());
}

#[test]
fn what_is_not_certain_is_not_said() {
    // Values that depend on the way are not known: a label, a call, a branch, a loop around.
    for text in [
        "#1=5\nIF[#9EQ1]GOTO1\n#1=0\nN1 WHILE[#1GT3]DO1\n#1=#1-1\nEND1\n",
        "#1=0\nIF[#9EQ1]THEN#1=5\nWHILE[#1GT3]DO1\n#1=#1-1\nEND1\n",
        "#1=0\nM98 P1\nWHILE[#1GT3]DO1\n#1=#1-1\nEND1\nM30\nO1\n#1=5\nM99\n",
        "#1=0\n#2=0\nWHILE[#2LT3]DO1\nWHILE[#1GT3]DO2\n#1=#1-1\nEND2\n#1=5\n#2=#2+1\nEND1\n",
        "#1=0\nGOTO5\nWHILE[#1GT3]DO1\n#1=#1-1\nEND1\nN5 M30\n",
    ] {
        assert!(found(text).is_empty(), "{text}: {:?}", found(text));
    }
    // And a branch that leaves the value as it is keeps it known.
    let kept = "#1=0\nIF[#9EQ1]GOTO5\nWHILE[#1GT3]DO1\n#1=#1-1\nEND1\nN5 M30\n";
    assert!(found(kept)[0].starts_with("error loop-never-runs"));
}

#[test]
fn a_budget_without_a_block_ends_a_loop_that_cannot_be_foreseen() {
    let text = "#1=1\n#2=3\nWHILE[#1LT#2]DO1\n#2=#2+1\n#1=#1+1\nEND1\n";
    let says = made(text);
    assert!(
        says.starts_with("error 3:6: 100000 steps without a block: the loop DO1 does not end; `#1` is"),
        "{says}"
    );
    assert!(says.ends_with("the loop runs while `#1` LT #2"), "{says}");
    assert!(made("N1 #1=#1+1\nGOTO1\n").contains("100000 steps without a block: the program goes round"));
    // A remark is no block.
    assert!(made("DO1\n(TURN)\nIF[#1EQ1]GOTO1\nEND1\nN1\n").ends_with("the loop DO1 does not end"));
    // Blocks count the budget anew.
    let long =
        made("#1=0\nWHILE[#1LT200]DO1\n#2=0\nWHILE[#2LT20000]DO2\n#2=#2+1\nEND2\nX#1\n#1=#1+1\nEND1\n");
    assert!(long.ends_with("X199"), "{long}");
}

#[test]
fn labels_that_stand_twice_are_said_where_one_goes_there() {
    let text = "N1 X1.\nIF[#1EQ0]GOTO1\nN1 X2.\n";
    let expected = "warning duplicate-label 2: N1 stands in lines 1 and 3; this one goes to line 3";
    assert_eq!(found(text), [expected]);
    assert!(found("N1 X1.\nN1 X2.\n").is_empty());
}

#[test]
fn variables_that_nothing_sets_are_said() {
    let text = "X#500\nIF[#<_tool>EQ1]THEN#1=#101\n";
    let found = found(text);
    assert_eq!(found.len(), 3, "{found:?}");
    assert!(found.iter().all(|f| f.contains("is read and never set")));
    assert!(found.iter().any(|f| f.contains("`#<_TOOL>`")));
}

#[test]
fn undefined_variables_in_calculations_are_said_once() {
    let program = parsed("#2=0\nWHILE[#2LT5]DO1\nX[#1+#2]\n#2=#2+1\nEND1\n");
    let mut expansion = dripfeed::macros::run::Expansion::<Decimal>::new(std::sync::Arc::new(program));
    let mut block = dripfeed::macros::block::Block::default();
    while expansion.turn(100, &mut block).unwrap() != dripfeed::macros::block::Turn::End {}
    let messages: Vec<&str> = expansion.findings().iter().map(|f| f.error.message.as_str()).collect();
    assert_eq!(messages, ["`#1` is undefined and counts as 0 in this calculation"]);
}

#[test]
fn a_loop_that_did_not_run_is_said_unless_it_ran_another_time() {
    let findings = |text: &str| {
        let mut expansion =
            dripfeed::macros::run::Expansion::<Decimal>::new(std::sync::Arc::new(parsed(text)));
        let mut block = dripfeed::macros::block::Block::default();
        while expansion.turn(100, &mut block).unwrap() != dripfeed::macros::block::Turn::End {}
        expansion.findings().iter().map(|f| f.error.message.clone()).collect::<Vec<_>>()
    };
    let text = "#1=5\nWHILE[#1GT5]DO1\n#1=#1-1\nEND1\n";
    assert_eq!(findings(text), ["the loop does not run: `#1` is 5, the loop runs while `#1` GT 5"]);
    let later = "#2=0\nWHILE[#2LT3]DO1\n#1=0\nWHILE[#1LT#2]DO2\n#1=#1+1\nEND2\n#2=#2+1\nEND1\n";
    assert!(findings(later).is_empty(), "{:?}", findings(later));
}

#[test]
fn calls_in_a_circle_and_a_main_program_without_end() {
    assert!(
        found("M98 P1\nM30\nO1\nM98 P2\nM99\nO2\nM98 P1\nM99\n")
            .iter()
            .any(|f| f.contains("warning recursion 7: O0001 calls itself through O0002"))
    );
    assert_eq!(found("M30\nO1\nM98 P1\nM99\n"), ["warning recursion 3: O0001 calls itself"]);
    assert!(found("M98 P1\nM98 P2\nM30\nO1\nM98 P2\nM99\nO2\nM99\n").is_empty());
    assert!(found("X1.\nM99\n")[0].starts_with("error endless 2: M99 in the main program"));
    assert!(found("M97 P1\nM30\nN1 X1.\nM99\n").is_empty());
}

#[test]
fn everything_wrong_is_told_in_one_run() {
    let text = "X\n#1=\nDO1\nFOO1\nX1.\n";
    let errors = Program::parse(text.as_bytes(), &mut NoPrograms, &options()).unwrap_err();
    let lines: Vec<u64> = errors.iter().map(|e| e.place.line).collect();
    assert_eq!(lines, [1, 2, 4]);
    assert!(errors.iter().all(|e| !e.help.is_empty() && e.code == "macro-syntax"));
    let many = "X\n".repeat(1000);
    assert_eq!(Program::parse(many.as_bytes(), &mut NoPrograms, &options()).unwrap_err().len(), 50);
}

#[test]
fn help_says_what_to_write() {
    for (text, help) in [
        ("ELSE\n", "write IF[…]GOTO n around what is left out"),
        ("ENDIF\n", "write IF[…]GOTO n around what is left out"),
        ("SETVN 101[A]\n", "write #<name> instead"),
        ("POPEN\n", "output to other devices is for a control to do; take it out"),
        ("X##1\n", "write #[#1]"),
        ("#3000\n", "write #1=… to set it, X#1 to use it"),
    ] {
        let errors = Program::parse(text.as_bytes(), &mut NoPrograms, &options()).unwrap_err();
        assert_eq!(errors[0].help, help, "{text}");
    }
}

#[test]
fn an_error_shows_its_line_with_a_caret() {
    let errors =
        Program::parse(b"G01 X1.\n  #1 = 2 * FOO[3] (x)\n", &mut NoPrograms, &options()).unwrap_err();
    let place = &errors[0].place;
    assert_eq!((place.line, place.column, place.excerpt.as_str()), (2, 12, "  #1 = 2 * FOO[3] (x)"));
    assert_eq!((place.caret, place.width), (11, 3));
}
