//! The numbers that a network is fed with: terms scaled and clipped, over some frames, one after another.

use std::collections::VecDeque;

use super::term::{Term, View};

/// A term as a network is trained to see it: `clamp((value - offset) * scale, clip)`.
#[derive(Clone, Debug)]
pub(super) struct Scaled {
    pub(super) term: Term,
    /// One for each of its numbers, and so below.
    pub(super) offset: Vec<f64>,
    pub(super) scale: Vec<f64>,
    /// The least and the most that it is fed with.
    pub(super) clip: [f64; 2],
}

/// Which frame of a window a network has first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    OldestFirst,
    NewestFirst,
}

/// Terms over the last few frames: frame after frame, and in each term after term.
#[derive(Clone, Debug)]
pub(super) struct Input {
    pub(super) frames: usize,
    pub(super) order: Order,
    pub(super) terms: Vec<Scaled>,
}

/// All that a network is fed with, and the frames that it was fed with before.
#[derive(Clone, Debug)]
pub(super) struct Window {
    inputs: Vec<Input>,
    /// Of each input, the newest first.
    past: Vec<VecDeque<Vec<f32>>>,
}

impl Input {
    /// How many numbers one frame of it has.
    fn frame_width(&self) -> usize {
        self.terms.iter().map(|scaled| scaled.term.width()).sum()
    }

    /// What `view` is to it; `None` where a number of it is not known.
    fn frame(&self, view: &View<'_>) -> Option<Vec<f32>> {
        let mut frame = Vec::with_capacity(self.frame_width());
        for Scaled { term, offset, scale, clip: [least, most] } in &self.terms {
            let mut each = offset.iter().zip(scale);
            term.read(view, &mut |value| {
                let (offset, scale) = each.next().expect("as many as the term has numbers");
                #[allow(clippy::cast_possible_truncation)] // what a network was trained on
                frame.push(((value - offset) * scale).clamp(*least, *most) as f32);
            })?;
        }
        frame.iter().all(|number| number.is_finite()).then_some(frame)
    }
}

impl Window {
    pub(super) fn new(inputs: Vec<Input>) -> Self {
        let past = vec![VecDeque::new(); inputs.len()];
        Self { inputs, past }
    }

    /// How many numbers a network is fed with.
    pub(super) fn width(&self) -> usize {
        self.inputs.iter().map(|input| input.frames * input.frame_width()).sum()
    }

    pub(super) fn terms(&self) -> impl Iterator<Item = Term> {
        self.inputs.iter().flat_map(|input| &input.terms).map(|scaled| scaled.term)
    }

    /// Forgets what was seen before.
    pub(super) fn clear(&mut self) {
        self.past.iter_mut().for_each(VecDeque::clear);
    }

    /// Takes one more frame, and writes what the network is fed with into `fed`. False where something of it is not
    /// known: then it is as if nothing had been seen. Before there are as many frames as it has, the first stands
    /// for those before it.
    pub(super) fn take(&mut self, view: &View<'_>, fed: &mut Vec<f32>) -> bool {
        let frames: Option<Vec<Vec<f32>>> =
            self.inputs.iter().map(|input| input.frame(view)).collect();
        let Some(frames) = frames else { return false };
        fed.clear();
        for ((input, past), frame) in self.inputs.iter().zip(&mut self.past).zip(frames) {
            past.truncate(input.frames - 1);
            past.push_front(frame);
            let nth = |age: usize| past.get(age).or(past.back()).into_iter().flatten();
            let ages = 0..input.frames;
            match input.order {
                Order::NewestFirst => fed.extend(ages.flat_map(nth)),
                Order::OldestFirst => fed.extend(ages.rev().flat_map(nth)),
            }
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::super::made_up::seen;
    use super::*;
    use crate::Action;

    fn scaled(term: Term, offset: f64, scale: f64, clip: [f64; 2]) -> Scaled {
        let width = term.width();
        Scaled { term, offset: vec![offset; width], scale: vec![scale; width], clip }
    }

    fn fed(window: &mut Window, roll_rad: f64, speed_m_s: f64) -> Option<Vec<f32>> {
        let mut seen = seen();
        seen.attitude.roll_rad = roll_rad;
        seen.wheel_speed_m_s = speed_m_s;
        let mut fed = Vec::new();
        let view =
            View { seen: &seen, goal: None, heights_m: &[], previous_action: Action::default() };
        window.take(&view, &mut fed).then_some(fed)
    }

    fn two(order: Order) -> Window {
        let wide = [f64::NEG_INFINITY, f64::INFINITY];
        let terms = vec![
            scaled(Term::RollRad, 0.0, 10.0, [-1.0, 1.0]),
            scaled(Term::SpeedMS, 1.0, 2.0, wide),
        ];
        let last = Input { frames: 1, order, terms: vec![scaled(Term::SpeedMS, 0.0, 1.0, wide)] };
        Window::new(vec![Input { frames: 2, order, terms }, last])
    }

    #[test]
    fn frames_come_in_the_order_that_the_file_says() {
        for (order, wanted) in [
            (Order::OldestFirst, [0.5, -1.0, 1.0, 1.0, 1.5]),
            (Order::NewestFirst, [1.0, 1.0, 0.5, -1.0, 1.5]),
        ] {
            let mut window = two(order);
            assert_eq!(window.width(), wanted.len());
            // The first stands for those before it.
            assert_eq!(fed(&mut window, 0.05, 0.5).unwrap(), [0.5, -1.0, 0.5, -1.0, 0.5]);
            assert_eq!(fed(&mut window, 0.20, 1.5).unwrap(), wanted, "{order:?}");
        }
    }

    #[test]
    fn what_is_not_known_leaves_no_trace() {
        let mut window = two(Order::OldestFirst);
        assert_eq!(fed(&mut window, f64::NAN, 0.5), None);
        assert_eq!(fed(&mut window, 0.05, f64::INFINITY), None);
        assert_eq!(fed(&mut window, 0.05, 0.5).unwrap(), [0.5, -1.0, 0.5, -1.0, 0.5]);
        window.clear();
        assert_eq!(fed(&mut window, 0.0, 1.0).unwrap(), [0.0, 0.0, 0.0, 0.0, 1.0]);
    }
}
