//! The command line, judged from outside: as a newcomer types it, and as the contract words it.
//!
//! Every run is the real program without a terminal, in a directory of its own. The complete messages of bad input lie
//! in `tests/golden/messages`; they are rewritten only when `DRIPFEED_BLESS=1` is set.

#[path = "gear/binary.rs"]
mod binary;
#[path = "cli/golden.rs"]
mod golden;
#[path = "cli/listings.rs"]
mod listings;
#[path = "cli/looking.rs"]
mod looking;
#[path = "cli/messages.rs"]
mod messages;
#[path = "cli/part_files.rs"]
mod part_files;
#[path = "cli/places.rs"]
mod places;
#[path = "cli/programs.rs"]
mod programs;
#[path = "cli/scratch.rs"]
mod scratch;
#[path = "cli/words.rs"]
mod words;
