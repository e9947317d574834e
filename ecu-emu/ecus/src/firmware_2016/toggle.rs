//! The rule by which a press of an armrest button becomes a mode (facts 3.8, 4.7).

use super::pads::Pattern;

/// What the buttons of one armrest have led to.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Toggle {
    /// The button whose function runs.
    mode: Option<u8>,
    /// Mode at the last release.
    latched: Option<u8>,
    held: bool,
}

impl Toggle {
    /// Takes the newest pattern. A press counts when all buttons were up before: it makes its button
    /// the mode; one that matches no button, or the mode latched at the last release, makes it none.
    /// A press in `keeping` leaves the mode `keeper` running.
    pub(super) fn step(&mut self, pattern: Pattern, swallow: bool, keeper: u8, keeping: &[u8]) {
        let held = pattern.any();
        if held && !self.held {
            let pressed = pattern.button();
            let other = if swallow { self.latched } else { self.mode };
            let keeps = self.mode == Some(keeper) && pressed.is_some_and(|b| keeping.contains(&b));
            if !keeps {
                self.mode = pressed.filter(|_| pressed != other);
            }
        }
        if !held && self.held {
            self.latched = self.mode;
        }
        self.held = held;
    }

    /// The button whose function runs.
    pub(super) const fn mode(&self) -> Option<u8> {
        self.mode
    }

    /// Whether anything is pressed.
    pub(super) const fn is_held(&self) -> bool {
        self.held
    }

    /// Ends the function that runs, without touching the latch.
    pub(super) const fn clear(&mut self) {
        self.mode = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::firmware_2016::pads::{LEFT, Pattern};

    fn press(toggle: &mut Toggle, button: u8, swallow: bool) -> Option<u8> {
        toggle.step(Pattern::of(&LEFT, &[button]), swallow, 18, &[13, 14]);
        let mode = toggle.mode();
        toggle.step(Pattern::default(), swallow, 18, &[13, 14]);
        mode
    }

    #[test]
    fn the_same_button_ends_its_mode_and_others_take_over() {
        let mut toggle = Toggle::default();
        assert_eq!(press(&mut toggle, 18, true), Some(18));
        assert_eq!(press(&mut toggle, 13, true), Some(18), "the offset does not end levelling");
        assert_eq!(press(&mut toggle, 18, true), None);
        assert_eq!(press(&mut toggle, 13, true), Some(13));
        assert_eq!(press(&mut toggle, 1, true), Some(1));
        toggle.step(Pattern::of(&LEFT, &[10, 11]), true, 18, &[]);
        assert_eq!(toggle.mode(), None, "two in a byte are none");
    }

    #[test]
    fn nothing_is_taken_until_all_are_up() {
        let mut toggle = Toggle::default();
        toggle.step(Pattern::of(&LEFT, &[1]), true, 18, &[]);
        toggle.step(Pattern::of(&LEFT, &[1, 18]), true, 18, &[]);
        toggle.step(Pattern::of(&LEFT, &[18]), true, 18, &[]);
        assert_eq!(toggle.mode(), Some(1));
    }

    /// Facts 3.8: after an exit that a fault caused, the first press of the same button is lost.
    #[test]
    fn a_press_equal_to_the_latched_mode_is_swallowed() {
        for (swallow, first) in [(true, None), (false, Some(18))] {
            let mut toggle = Toggle::default();
            press(&mut toggle, 18, swallow);
            toggle.clear();
            assert_eq!(press(&mut toggle, 18, swallow), first);
            if swallow {
                assert_eq!(press(&mut toggle, 18, swallow), Some(18));
            }
        }
    }
}
