//! What the control received and cut, as it is written to `--report` and `--status`.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// The report. The fields up to `faults` are the contract of the command line; those after it are additions.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Report {
    /// Blocks executed complete; stop words are not counted.
    pub blocks: u64,
    /// Steps of one axis, 1 µm each, those of a block an alarm broke off included.
    pub pulses: u64,
    /// Where the wire stands, µm from where it stood before the first block.
    pub end_um: [i64; 2],
    /// The sum of the nominal lengths between executed ends, mm.
    pub path_length_mm: f64,
    /// Characters the receiver has completed, whatever they were.
    pub bytes: u64,
    /// Most characters received between a DC3 that asks for silence and the next DC1. A DC3 after the program's end
    /// asks for nothing.
    pub max_overrun_bytes: u64,
    /// How often a DC3 asked for silence because the buffer filled.
    pub holds: u64,
    /// Character time over elapsed minus held, first to last byte: 0 where characters take no time, `null` while no
    /// time has passed. Held: from DC3's stop bit, or the last character that came in spite of it, until DC1 has reached
    /// the sender's program.
    pub line_utilisation: Option<f64>,
    /// SHA-256 of the decoded program text, in hex.
    pub sha256: String,
    /// The alarm that stopped the control: `overrun`, `buffer-overflow`, `format`, `endless-block`, `arc-centre`,
    /// `parity`, `nak`, `nak-storm`; with an offset held `tangency`, `radius`, `side`, `flag`, `lead-in`, `taper`;
    /// with G-code `word`, `number`, `arc`, `call`, `offset`, `compensation`, `radius`, `interference`.
    pub alarm: Option<String>,
    /// The faults that really struck, by kind.
    pub faults: BTreeMap<String, u64>,

    /// What the alarm was about: block, line, column, and what was found.
    pub alarm_detail: Option<String>,
    /// Programs whose end has been reached by the cutter.
    pub programs: u64,
    /// How often the link has opened.
    pub connections: u64,
    /// Unfinished blocks dropped because the link closed.
    pub torn: u64,
    /// Resets (DC3, SYN).
    pub resets: u64,
    /// Characters that label skip discarded, `%` lines not counted.
    pub skipped: u64,
    /// Characters that came while the control was not reading: before the first DC1, after a reset or an alarm.
    pub unread: u64,
    /// Time held between the first and the last character, s.
    pub held_seconds: f64,
    /// Where the wire stands at the upper guide, as `end_um`; only with a taper.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub upper_end_um: Option<[i64; 2]>,
    /// Steps of the upper guide's axes, over the plane of the program; only with a taper.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub upper_pulses: Option<u64>,
    /// Words of G-code that were understood and not acted on (conditions, taper), and how often.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub words_passed_over: BTreeMap<String, u64>,
}
