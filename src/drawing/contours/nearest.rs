//! The nearest of many points, while some are taken away and others come in: a tree that halves the points by x and y in
//! turn, with a count of those present under every node.

use crate::geometry::Point;

/// Points with what they stand for; none is present at first.
#[derive(Debug)]
pub(super) struct Nearest<T> {
    /// In tree order: the middle of a range is its node.
    points: Vec<(Point, T)>,
    /// How many are present in the range of each node.
    present: Vec<u32>,
    here: Vec<bool>,
}

impl<T: Copy + Ord + Send> Nearest<T> {
    pub(super) fn of(mut points: Vec<(Point, T)>) -> Self {
        halve(&mut points, true);
        let count = points.len();
        Self { points, present: vec![0; count], here: vec![false; count] }
    }

    /// What stands at each place of the tree.
    pub(super) fn places(&self) -> impl Iterator<Item = (usize, T)> {
        self.points.iter().enumerate().map(|(place, &(_, what))| (place, what))
    }

    /// Brings the point at a place of the tree in, or takes it away.
    pub(super) fn set(&mut self, place: usize, here: bool) {
        if self.here[place] == here {
            return;
        }
        self.here[place] = here;
        let (mut low, mut high) = (0, self.points.len());
        loop {
            let middle = low + (high - low) / 2;
            if here {
                self.present[middle] += 1
            } else {
                self.present[middle] -= 1
            }
            match place.cmp(&middle) {
                std::cmp::Ordering::Less => high = middle,
                std::cmp::Ordering::Equal => return,
                std::cmp::Ordering::Greater => low = middle + 1,
            }
        }
    }

    /// What stands for the nearest point present; of equally near ones the first.
    pub(super) fn find(&self, to: Point) -> Option<T> {
        let mut best = None;
        self.search(0, self.points.len(), true, to, &mut best);
        best.map(|(_, what)| what)
    }

    fn search(&self, low: usize, high: usize, by_x: bool, to: Point, best: &mut Option<(f64, T)>) {
        if low >= high {
            return;
        }
        let middle = low + (high - low) / 2;
        if self.present[middle] == 0 {
            return;
        }
        let (point, what) = self.points[middle];
        if self.here[middle] {
            let distance = (point - to).norm_squared();
            if best.is_none_or(|(least, first)| distance < least || (distance == least && what < first)) {
                *best = Some((distance, what));
            }
        }
        let off = if by_x { to.x - point.x } else { to.y - point.y };
        let (near, far) = ((low, middle), (middle + 1, high));
        let (near, far) = if off < 0.0 { (near, far) } else { (far, near) };
        self.search(near.0, near.1, !by_x, to, best);
        if best.is_none_or(|(least, _)| off * off <= least) {
            self.search(far.0, far.1, !by_x, to, best);
        }
    }
}

fn halve<T: Copy + Ord + Send>(points: &mut [(Point, T)], by_x: bool) {
    if points.len() < 2 {
        return;
    }
    let middle = points.len() / 2;
    points.select_nth_unstable_by(middle, |a, b| {
        let (a_key, b_key) = if by_x { (a.0.x, b.0.x) } else { (a.0.y, b.0.y) };
        a_key.total_cmp(&b_key).then(a.1.cmp(&b.1))
    });
    let (low, high) = points.split_at_mut(middle);
    if middle > ALONE_MAX {
        std::thread::scope(|scope| {
            scope.spawn(|| halve(low, !by_x));
            halve(&mut high[1..], !by_x);
        });
    } else {
        halve(low, !by_x);
        halve(&mut high[1..], !by_x);
    }
}

/// More points than this are worth a thread.
const ALONE_MAX: usize = 1 << 16;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_present_is_found_as_by_looking_at_all() {
        let mut state = 12345u64;
        let mut random = |below: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) % below
        };
        // Many on few columns, so that there are ties.
        let points: Vec<(Point, usize)> =
            (0..300).map(|n| (Point::new(random(12) as f64, random(40) as f64), n)).collect();
        let mut tree = Nearest::of(points.clone());
        let places: Vec<usize> = {
            let mut places = vec![0; points.len()];
            tree.places().for_each(|(place, n)| places[n] = place);
            places
        };
        let mut here = vec![false; points.len()];
        for _ in 0..4000 {
            let n = random(300) as usize;
            here[n] = !here[n];
            tree.set(places[n], here[n]);
            let to = Point::new(random(13) as f64 - 0.25, random(41) as f64 + 0.5);
            let distance = |n: usize| (points[n].0 - to).norm_squared();
            let expected = (0..300)
                .filter(|&n| here[n])
                .min_by(|&a, &b| distance(a).total_cmp(&distance(b)).then(a.cmp(&b)));
            assert_eq!(tree.find(to), expected);
        }
    }
}
