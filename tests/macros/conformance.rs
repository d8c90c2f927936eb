//! The constructs of custom macro B, one by one: a small program each, its output worked out by hand.

use crate::spelling::made;

#[test]
fn assignments_loops_and_words() {
    let text = "#1=1\nWHILE[#1LE3]DO1\nG01 X#1 Y[#1*2] Z-#1 F200\n#1=#1+1\nEND1\nM02\n";
    let expected = "G01 X1 Y2 Z-1 F200; G01 X2 Y4 Z-2 F200; G01 X3 Y6 Z-3 F200; M02";
    assert_eq!(made(text), expected);
}

#[test]
fn the_papers_corner_in_both_readings() {
    let program = |root: u32, from: u32| {
        format!(
            "#110=0.02\n#101={from}\nWHILE[#101GT20]DO1\n#101=#101-#110\n\
             #102=SQRT[{root}-[#101-20]*[#101-20]]+20\n#103=SQRT[40000-#101*#101]\n\
             G01 X[#101] Y[#102] Z[#103] F200\nEND1\n"
        )
    };
    for (root, from, count, last) in [(25, 25, 250, "G01 X20 Y25"), (49, 27, 350, "G01 X20 Y27")] {
        let blocks = made(&program(root, from));
        let blocks: Vec<&str> = blocks.split("; ").collect();
        assert_eq!(blocks.len(), count);
        assert!(blocks[count - 1].starts_with(last), "{}", blocks[count - 1]);
    }
}
