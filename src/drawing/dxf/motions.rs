//! The motions that cut a drawing's contours.
//!
//! Between two contours that do not touch the program stops for the wire to be cut, positions, and stops for it to be
//! threaded. It begins with the way to the first contour, without stops: where a program's zero is not the first start
//! hole, the wire is threaded there, whatever the format has to say of it.

use crate::drawing::contours::Contour;
use crate::geometry::{Element, Point};
use crate::motion::{Act, Motion, Stop, Travel};
use crate::place::Spot;

/// Walks over contours; holds none of what it gives out.
pub(super) struct Motions<'a> {
    contours: &'a [Contour],
    contour: usize,
    step: Step,
    at: Point,
    block: u64,
    /// Whether something has been cut, and whether the wire has been free since.
    has_cut: bool,
    is_free: bool,
}

#[derive(Clone, Copy)]
enum Step {
    Remark,
    Free,
    Approach,
    Thread,
    Element(usize),
    Over,
}

impl<'a> Motions<'a> {
    pub(super) fn of(contours: &'a [Contour]) -> Self {
        Self {
            contours,
            contour: 0,
            step: Step::Remark,
            at: Point::origin(),
            block: 0,
            has_cut: false,
            is_free: false,
        }
    }

    fn motion(&mut self, act: Act, line: u64) -> Motion {
        if matches!(act, Act::Move { .. }) {
            self.block += 1;
        }
        let spot = Spot { byte: 0, line, column: u64::from(line > 0) };
        Motion { act, block: self.block, spot }
    }

    fn pause(&mut self, line: u64) -> Motion {
        self.block += 1;
        self.motion(Act::Stop(Stop::Pause), line)
    }

    fn travel(&mut self, travel: Travel, element: Element, line: u64) -> Motion {
        self.at = element.end();
        self.motion(Act::Move { travel, element, upper: None, flag: None }, line)
    }
}

impl Iterator for Motions<'_> {
    type Item = Motion;

    fn next(&mut self) -> Option<Motion> {
        loop {
            let Some(contour) = self.contours.get(self.contour) else {
                return match self.step {
                    Step::Over => None,
                    _ => {
                        self.step = Step::Over;
                        self.block += 1;
                        Some(self.motion(Act::Stop(Stop::End), 0))
                    }
                };
            };
            match self.step {
                Step::Remark => {
                    self.step = Step::Free;
                    let remark = format!("layer {}", contour.layer).into_bytes();
                    return Some(self.motion(Act::Comment(remark.into()), contour.line));
                }
                Step::Free => {
                    self.step = Step::Approach;
                    let positions = contour.travel == Travel::Rapid || contour.path.start() != self.at;
                    if positions && self.has_cut && !self.is_free {
                        self.is_free = true;
                        return Some(self.pause(contour.line));
                    }
                }
                Step::Approach => {
                    self.step = Step::Thread;
                    let start = contour.path.start();
                    if start != self.at {
                        let way = Element::Line { start: self.at, end: start };
                        return Some(self.travel(Travel::Rapid, way, contour.line));
                    }
                }
                Step::Thread => {
                    self.step = Step::Element(0);
                    if contour.travel == Travel::Cut {
                        self.has_cut = true;
                        if std::mem::take(&mut self.is_free) {
                            return Some(self.pause(contour.line));
                        }
                    }
                }
                Step::Element(n) => {
                    if let Some(&element) = contour.path.elements().get(n) {
                        self.step = Step::Element(n + 1);
                        return Some(self.travel(contour.travel, element, contour.line));
                    }
                    (self.contour, self.step) = (self.contour + 1, Step::Remark);
                }
                Step::Over => return None,
            }
        }
    }
}
