//! How many bytes may be handed to the driver now.
//!
//! Bytes already in a driver cannot be recalled when the control says stop, so the sender keeps few of them there. How
//! many are still unsent is known from the time a character takes on the wire. The arithmetic of the ten-character
//! rule lives here: characters completed while the control's DC3 is on its way, plus those still in the driver when it
//! is seen.

use std::collections::VecDeque;
use std::time::Duration;

/// What bounds the bytes in flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pace {
    /// How long a character takes on the wire, start and stop bits included; none when the line is not paced.
    pub character: Option<Duration>,
    /// Most bytes in the driver, not yet on the wire.
    pub window: usize,
    /// Whether to leave listening gaps, so that the limit holds whatever the latency.
    pub gaps: Option<Gaps>,
    /// How long what the control sends takes to be seen here.
    pub latency: Duration,
}

/// Listening gaps: never more than `burst` characters within any `span`.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Gaps {
    /// Most characters in a span.
    pub burst: usize,
    /// The time in which a DC3 is sure to be seen and the driver to have run empty.
    pub span: Duration,
}

/// The most bytes an unpaced link is given ahead of what it took.
pub const UNPACED_WINDOW: usize = 65_536;
/// The most bytes a paced driver is given ahead, whatever the limit: what a 16550's FIFO holds.
pub const WINDOW_MAX: usize = 16;

impl Pace {
    /// No pacing: the link takes what it can.
    #[must_use]
    pub fn unpaced() -> Self {
        Self { character: None, window: UNPACED_WINDOW, gaps: None, latency: Duration::ZERO }
    }

    /// Free running. Of the characters the limit leaves beside the latency, half may wait in the driver, to keep the line
    /// busy, and half are for this process being late to hear DC3; on a fast line more wait, enough to bridge a
    /// millisecond. At least one. A window that is given is kept.
    #[must_use]
    pub fn free(character: Duration, latency: Duration, limit: usize, window: Option<usize>) -> Self {
        let left = limit.saturating_sub(characters_within(latency, character));
        let bridge = characters_within(BRIDGED, character).min(left.saturating_sub(UNNOTICED));
        let window = window.unwrap_or(left.div_ceil(2).max(bridge)).clamp(1, WINDOW_MAX);
        Self { character: Some(character), window, gaps: None, latency }
    }

    /// With listening gaps where the latency makes free running break the limit.
    #[must_use]
    pub fn strict(character: Duration, latency: Duration, limit: usize, window: Option<usize>) -> Self {
        let free = Self::free(character, latency, limit, window);
        if free.worst_overrun() <= limit {
            return free;
        }
        let window = free.window.min(STRICT_WINDOW).min(limit).max(1);
        let span = latency + character * (window as u32) + STRICT_MARGIN;
        Self { window, gaps: Some(Gaps { burst: limit.max(1), span }), ..free }
    }

    /// The most characters that can be completed after the control's DC3 has left it.
    #[must_use]
    pub fn worst_overrun(&self) -> usize {
        match (self.character, self.gaps) {
            (None, _) => self.window,
            (Some(_), Some(gaps)) => gaps.burst,
            (Some(character), None) => characters_within(self.latency, character) + UNNOTICED + self.window,
        }
    }

    /// The share of the line's time that gaps leave for sending, 0 to 1.
    #[must_use]
    pub fn best_utilisation(&self) -> f64 {
        match (self.character, self.gaps) {
            (Some(character), Some(gaps)) => {
                (character.as_secs_f64() * gaps.burst as f64 / gaps.span.as_secs_f64()).min(1.0)
            }
            _ => 1.0,
        }
    }
}

/// Characters that can be completed within a time, at the worst phase.
fn characters_within(time: Duration, character: Duration) -> usize {
    time.as_nanos().div_ceil(character.as_nanos().max(1)) as usize
}

/// A character may leave the driver between the moment DC3 can be seen and the moment this process sees it.
const UNNOTICED: usize = 1;
/// How long a full driver should keep the line busy while this process is not running. A guess at a desktop's scheduling.
const BRIDGED: Duration = Duration::from_millis(1);
/// How often the driver is refilled at most.
const REFILLED: Duration = Duration::from_micros(500);
/// In strict pacing the driver holds no more than this: enough to keep the line busy within a burst.
const STRICT_WINDOW: usize = 2;
/// Added to the span for the sender's own delay in noticing. A guess; a slower machine shows in `max_overrun_bytes`.
const STRICT_MARGIN: Duration = Duration::from_millis(1);

/// Follows what is on the wire by the time it takes.
#[derive(Clone, Debug)]
pub struct Pacer {
    pace: Pace,
    /// When the last byte handed over will have left the wire.
    free_at: Duration,
    /// When each of the last `burst` characters is completed, first first; kept only with gaps.
    completed: VecDeque<Duration>,
}

impl Pacer {
    /// A pacer for an idle line.
    #[must_use]
    pub fn new(pace: Pace) -> Self {
        Self { pace, free_at: Duration::ZERO, completed: VecDeque::new() }
    }

    /// When the line will be empty.
    #[must_use]
    pub fn free_at(&self) -> Duration {
        self.free_at
    }

    /// Bytes handed over that are not completed on the wire.
    #[must_use]
    pub fn unsent(&self, now: Duration) -> usize {
        let Some(character) = self.pace.character else { return 0 };
        characters_within(self.free_at.saturating_sub(now), character)
    }

    /// How many bytes may be handed over now.
    #[must_use]
    pub fn room(&self, now: Duration) -> usize {
        let window = self.pace.window.saturating_sub(self.unsent(now));
        let (Some(gaps), Some(character)) = (self.pace.gaps, self.pace.character) else { return window };
        let start = self.free_at.max(now);
        (0..window)
            .take_while(|&ahead| {
                let done = start + character * (ahead as u32 + 1);
                let earlier = (self.completed.len() + ahead).checked_sub(gaps.burst);
                earlier.and_then(|n| self.completed.get(n)).is_none_or(|&before| done >= before + gaps.span)
            })
            .count()
    }

    /// Records that `count` bytes were handed over.
    pub fn handed(&mut self, count: usize, now: Duration) {
        let Some(character) = self.pace.character else { return };
        let start = self.free_at.max(now);
        self.free_at = start + character * (count as u32);
        if let Some(gaps) = self.pace.gaps {
            for n in 1..=count as u32 {
                self.completed.push_back(start + character * n);
            }
            while self.completed.len() > gaps.burst {
                self.completed.pop_front();
            }
        }
    }

    /// When there will be room worth waking up for; none without pacing.
    #[must_use]
    pub fn room_at(&self, now: Duration) -> Option<Duration> {
        let character = self.pace.character?;
        // Refill as soon as a character has left; on a fast line not more often than every half millisecond.
        let keep = self.pace.window.saturating_sub(characters_within(REFILLED, character).max(1));
        let by_window = self.free_at.saturating_sub(character * (keep as u32));
        let by_gap = self.pace.gaps.and_then(|gaps| {
            let earlier = self.completed.len().checked_sub(gaps.burst)?;
            // The next character takes its own time, so it may start that much before it may be completed.
            Some((*self.completed.get(earlier)? + gaps.span).saturating_sub(character))
        });
        Some(by_window.max(by_gap.unwrap_or_default()).max(now))
    }

    /// Characters completed, or bound to be, after an instant: the overrun if the control said stop then.
    #[must_use]
    pub fn completed_after(&self, then: Duration, handed_since: usize) -> usize {
        match self.pace.character {
            None => handed_since,
            Some(character) => {
                characters_within(self.free_at.saturating_sub(then), character).min(handed_since)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: Duration = Duration::from_millis(1);

    fn character(baud: u32) -> Duration {
        Duration::from_nanos(11_000_000_000 / u64::from(baud))
    }

    #[test]
    fn the_window_leaves_room_for_the_latency() {
        let pace = Pace::free(character(4800), 16 * MS, 10, None);
        assert_eq!((pace.window, pace.worst_overrun()), (2, 10));
        let pace = Pace::free(character(9600), 4 * MS, 10, None);
        assert_eq!((pace.window, pace.worst_overrun()), (3, 8));
        let pace = Pace::free(character(9600), 16 * MS, 10, None);
        assert_eq!((pace.window, pace.worst_overrun()), (1, 16));
        let pace = Pace::free(character(115_200), Duration::ZERO, 10, None);
        assert_eq!((pace.window, pace.worst_overrun()), (9, 10));
    }

    #[test]
    fn strict_pacing_gaps_only_where_it_must() {
        assert_eq!(Pace::strict(character(4800), 16 * MS, 10, None).gaps, None);
        let pace = Pace::strict(character(9600), 16 * MS, 10, None);
        assert_eq!(pace.worst_overrun(), 10);
        assert_eq!(Pace::strict(character(9600), 16 * MS, 10, Some(16)).window, STRICT_WINDOW);
        assert!(Pace::strict(character(4800), 16 * MS, 10, Some(16)).gaps.is_some());
        assert!(pace.best_utilisation() > 0.55, "{}", pace.best_utilisation());
    }

    #[test]
    fn no_span_ever_holds_more_than_a_burst() {
        let pace = Pace::strict(character(9600), 16 * MS, 10, None);
        let (mut pacer, mut now, mut done) = (Pacer::new(pace), Duration::ZERO, Vec::new());
        while done.len() < 2000 {
            let room = pacer.room(now);
            if room > 0 {
                let start = pacer.free_at().max(now);
                pacer.handed(room, now);
                done.extend((1..=room as u32).map(|n| start + character(9600) * n));
            }
            let wake = pacer.room_at(now).unwrap();
            now = wake.max(now + Duration::from_micros(50));
        }
        for window in done.windows(11) {
            assert!(window[10] - window[0] >= pace.gaps.unwrap().span);
        }
        let busy = character(9600) * done.len() as u32;
        assert!(busy.as_secs_f64() / done.last().unwrap().as_secs_f64() > 0.55);
    }

    #[test]
    fn an_unpaced_line_has_room_at_once() {
        let mut pacer = Pacer::new(Pace::unpaced());
        pacer.handed(1_000_000, Duration::ZERO);
        assert_eq!(pacer.room(Duration::ZERO), UNPACED_WINDOW);
        assert_eq!(pacer.room_at(Duration::ZERO), None);
    }

    #[test]
    fn a_span_is_the_latency_the_window_and_a_margin_and_its_burst_is_the_share_of_the_line() {
        let pace = Pace::strict(character(9600), 16 * MS, 10, Some(16));
        let gaps = pace.gaps.unwrap();
        assert_eq!((pace.window, gaps.burst), (2, 10));
        // 11 bits at 9600 baud take 1.145833 ms.
        assert_eq!(gaps.span, Duration::from_nanos(16_000_000 + 2 * 1_145_833 + 1_000_000));
        assert!((pace.best_utilisation() - 11.45833 / 19.291_666).abs() < 1e-9);
        assert_eq!(
            Pace::free(character(9600), 16 * MS, 10, None).best_utilisation().to_bits(),
            1f64.to_bits()
        );
    }

    #[test]
    fn a_burst_may_be_followed_by_the_next_as_soon_as_its_span_is_over() {
        let gaps = Some(Gaps { burst: 4, span: 10 * MS });
        let mut pacer = Pacer::new(Pace { character: Some(MS), window: 3, gaps, latency: Duration::ZERO });
        assert_eq!(pacer.room(Duration::ZERO), 3);
        // Completed at 1, 2 and 3 ms; the fourth may be at once, the fifth not before 11 ms.
        pacer.handed(3, Duration::ZERO);
        assert_eq!((pacer.free_at(), pacer.room(2 * MS)), (3 * MS, 1));
        pacer.handed(1, 2 * MS);
        assert_eq!(pacer.free_at(), 4 * MS);
        assert_eq!(pacer.room_at(4 * MS), Some(10 * MS));
        assert_eq!(pacer.room(10 * MS - Duration::from_nanos(1)), 0);
        assert_eq!(pacer.room(10 * MS), 3);
    }

    #[test]
    fn what_is_completed_after_an_instant_is_no_more_than_was_handed_over() {
        let mut pacer = Pacer::new(Pace::free(MS, Duration::ZERO, 10, None));
        pacer.handed(6, Duration::ZERO);
        assert_eq!(pacer.completed_after(2 * MS, 6), 4);
        assert_eq!(pacer.completed_after(2 * MS, 3), 3);
        assert_eq!(pacer.completed_after(6 * MS, 6), 0);
        assert_eq!(Pacer::new(Pace::unpaced()).completed_after(MS, 70), 70);
    }
}
