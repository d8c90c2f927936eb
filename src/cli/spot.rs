//! The spot where a job is begun or taken up: the blocks around it, and where the wire must stand.

use super::failure::{Exit, Failure};
use super::feeding::no_such_block;
use super::source::Source;
use crate::interpolator::Model;
use crate::part::Prepared;
use crate::program::Line;
use crate::rounding::Aim;
use crate::units::Position;

/// The blocks around the one that goes first, and the position it begins at.
///
/// One past the last block is a spot too: only the stop word goes out.
pub(super) fn around(source: &Source, from_block: u64) -> Result<String, Failure> {
    let model = source.prepared().map_or(Model::Rotated, reference_model);
    let mut program = source.counted()?;
    let (mut text, mut lines, mut stands) = (Vec::new(), String::new(), Position::default());
    while program.blocks() < from_block.saturating_add(SHOWN_AFTER) {
        text.clear();
        let numbered = match program.pull(&mut text) {
            Ok(Some(numbered)) => numbered,
            Ok(None) => break,
            Err(error) => return Err(Failure::program(&source.path, error)),
        };
        let (Line::Block(made), block) = (numbered.line, numbered.block) else { continue };
        if let Some(made) = made
            && block < from_block
        {
            stands += model
                .displacement(&made)
                .map_err(|fault| Failure::new(Exit::Program, format!("block {block}: {fault}")))?;
        }
        if block + SHOWN_BEFORE >= from_block {
            let mark = if block == from_block { '>' } else { ' ' };
            lines.push_str(&format!("{mark} {block:>8}  {}\n", String::from_utf8_lossy(&text)));
        }
    }
    let blocks = program.blocks();
    if from_block > blocks + 1 {
        return Err(no_such_block(from_block, blocks));
    }
    if from_block > blocks {
        lines.push_str(&format!("> after block {blocks} only the stop word is left\n"));
    }
    let (x, y) = (stands.x.millimetres(), stands.y.millimetres());
    lines.push_str(&format!(
        "block {from_block} begins {x:.3} mm, {y:.3} mm from where the program began (by the {} model)\n",
        model.name()
    ));
    Ok(lines)
}

/// The model positions are told by; a part that serves every control has the same under all of them.
fn reference_model(prepared: &Prepared) -> Model {
    match prepared.part().aim {
        Aim::One(model) => model,
        Aim::Any => Model::Rotated,
    }
}

const SHOWN_BEFORE: u64 = 2;
const SHOWN_AFTER: u64 = 2;
