//! What a control understands as a block.
//!
//! One file a dialect; each gives a type for its block and an assembly that is fed one character at a time, as the
//! characters come off the line.

pub mod four_b;
pub mod gcode;
pub mod three_b;

/// What the programs are written in.
#[derive(Clone, Copy, Debug, Default, Eq, Hash, PartialEq)]
#[non_exhaustive]
pub enum Dialect {
    /// `B X B Y B J G Z`: the path of the wire's centre.
    #[default]
    ThreeB,
    /// `B X B Y B J B R D|DD G Z` among 3B blocks: the outline; the control holds the offset.
    FourB,
    /// Lines of words: the path or the outline, absolute or incremental.
    Gcode,
}

/// A block being put together, in a dialect whose blocks are recognised by their pattern.
#[derive(Clone, Debug)]
pub(crate) enum Assembly {
    ThreeB(three_b::Assembly),
    FourB(four_b::Assembly),
}

impl Assembly {
    /// `None`: a dialect of lines.
    pub(crate) fn new(dialect: Dialect) -> Option<Assembly> {
        match dialect {
            Dialect::ThreeB => Some(Assembly::ThreeB(three_b::Assembly::default())),
            Dialect::FourB => Some(Assembly::FourB(four_b::Assembly::default())),
            Dialect::Gcode => None,
        }
    }

    /// Forgets what has been put together.
    pub(crate) fn clear(&mut self) {
        match self {
            Assembly::ThreeB(assembly) => *assembly = three_b::Assembly::default(),
            Assembly::FourB(assembly) => *assembly = four_b::Assembly::default(),
        }
    }

    pub(crate) fn is_partial(&self) -> bool {
        match self {
            Assembly::ThreeB(assembly) => assembly.is_partial(),
            Assembly::FourB(assembly) => assembly.is_partial(),
        }
    }

    pub(crate) fn is_begun(&self) -> bool {
        match self {
            Assembly::ThreeB(assembly) => assembly.is_begun(),
            Assembly::FourB(assembly) => assembly.is_begun(),
        }
    }

    /// Whether a block number stands there and nothing else.
    pub(crate) fn is_number_alone(&self) -> bool {
        self.is_partial() && !self.is_begun()
    }

    /// Takes one character; a 3B block comes out as a 4B block without marks.
    pub(crate) fn push(&mut self, byte: u8) -> four_b::Step {
        match self {
            Assembly::ThreeB(assembly) => match assembly.push(byte) {
                three_b::Step::More => four_b::Step::More,
                three_b::Step::Complete(block) => four_b::Step::Complete(block.into()),
                three_b::Step::Wrong { expected } => four_b::Step::Wrong { expected },
            },
            Assembly::FourB(assembly) => assembly.push(byte),
        }
    }
}
