//! The firmware's oddities, each a switch: on as the firmware is, off as its authors will have meant.

use core::fmt;

macro_rules! quirks {
    ($($(#[doc = $doc:literal])+ $name:ident: $firmware:literal,)+) => {
        /// What to reproduce of the firmware's oddities.
        ///
        /// `docs/firmware-2016.md` has the same list, with the effect of each.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub struct Quirks {
            $($(#[doc = $doc])+ pub $name: bool,)+
        }

        impl Quirks {
            /// As the firmware is, but for what C leaves undefined.
            #[must_use]
            pub const fn firmware() -> Self {
                Self { $($name: $firmware,)+ }
            }

            /// None of them.
            #[must_use]
            pub const fn none() -> Self {
                Self { $($name: false,)+ }
            }

            /// Each switch by name, as it is set.
            #[must_use]
            pub fn list(&self) -> Vec<(&'static str, bool)> {
                vec![$((stringify!($name), self.$name),)+]
            }

            /// Sets the switch of that name.
            ///
            /// # Errors
            /// [`UnknownQuirk`] if there is none.
            pub fn set(&mut self, name: &str, on: bool) -> Result<(), UnknownQuirk> {
                match name {
                    $(stringify!($name) => self.$name = on,)+
                    _ => return Err(UnknownQuirk(name.to_owned())),
                }
                Ok(())
            }
        }
    };
}

quirks! {
    /// The force code has closed cylinders 0.82 m long, the height code 0.85 m (facts 1.4).
    /// Off: 0.85 m in both.
    force_closed_length_0_82: true,
    /// Sensors below their zero wrap to about 65535 (facts 3.2). C leaves it undefined, so it is off
    /// by default: they read 0.
    negative_readings_wrap: false,
    /// The stroke rate is filtered as if called every 20 ms, so it reads half of mm/s (facts 3.2).
    /// Off: mm/s.
    stroke_rate_for_20_ms: true,
    /// Filters keep whole numbers, so they stall short of where they go (facts 3.2, 4.5, 5).
    /// Off: they keep fractions, and cut off only what they put out.
    filters_cut_off: true,
    /// Pressures and attitude start from zero at power-up (facts 5; of pressures assumed).
    /// Off: from the first sample.
    filters_start_at_zero: true,
    /// Pitch levelling goes by the arms, parallel to the ground, not by the horizon (facts 3.5).
    /// Off: by the inertial unit, as in the paper.
    pitch_by_arm_geometry: true,
    /// Height is shared alike among the axles (facts 3.5). Off: 0.2339, 0.1694, 0.0968.
    height_shared_alike: true,
    /// Shares of pitch of front and rear are interchanged, with a slip of a digit (facts 3.5).
    /// Off: those of the pseudo-inverse.
    pitch_shares_interchanged: true,
    /// The joystick gives 300 mA one way and 245 mA the other (facts 3.8). Off: 300 mA both ways.
    joystick_lopsided: true,
    /// An armrest that never spoke reads 0 mV: the joystick fully up, and the roller seen below its
    /// start (facts 3.8, 4.9). Off: a joystick at rest, a roller not seen.
    unheard_input_reads_0_mv: true,
    /// The arm ECU takes a chair to the front for one to the back (facts 2.5). Off: it does not.
    chair_inverted: true,
    /// A press that equals the mode latched at the last release is swallowed (facts 3.8). Off: only
    /// one that equals the mode in force ends it.
    repeated_press_swallowed: true,
    /// The display's byte for the accumulators follows button 17 alone (facts 3.7). Off: it says
    /// whether any is on.
    passive_byte_by_button_17: true,
    /// The arm ECU misses its inertial unit only while levelling (facts 3.9). Off: always.
    imu_watched_in_levelling_only: true,
    /// Armrests that fall silent keep their last value in the drive ECU, and the drive ECU keeps its
    /// in the arm ECU (facts 3.9, 4.1). Off: buttons up and sticks at rest after 200 ms, brake on.
    silence_freezes_inputs: true,
    /// Wheel 1 is sent in place of wheels 2, 3 and 4 (facts 2.6). Off: each its own.
    wheel_1_sent_four_times: true,
    /// Speed inputs 5 and 6 are crossed (facts 4.8). Off: they are not.
    speed_inputs_5_6_crossed: true,
    /// Speeds count hundredths of rpm: the inputs give tenths of Hz, of which the code knows nothing
    /// (facts 4.8). Off: tenths of rpm.
    frequency_in_tenths_of_hz: true,
    /// The load offset of the speed limit has no lower end and takes four times as long to unwind
    /// as it took to wind up (facts 4.3). Off: it ends where the limit does.
    load_offset_winds_up: true,
    /// A load of 0xFF, which J1939 calls not available, is taken for 255 % (facts 2.8).
    /// Off: it is left out.
    load_not_available_is_255: true,
    /// Neutral, too, is refused while the pedal is above 150 per mille (facts 4.4). Off: never.
    neutral_refused_under_pedal: true,
    /// The slip gain of 2.6 is stored as 2 (facts 4.5). Off: 2.6.
    slip_gain_cut_to_2: true,
    /// A motor current below zero wraps, and the motor goes to least displacement (facts 4.4).
    /// Off: none flows.
    motor_current_wraps: true,
    /// The pump regulator compares the A sides, which are the high ones only in reverse (facts 4.5).
    /// Off: the sides that drive.
    pump_regulator_on_a_side: true,
    /// The rear joint's P part comes in at once at 50 counts (facts 4.6). Off: in proportion.
    follower_gate_is_a_step: true,
    /// In its dead-band the follower leaves the last currents on (facts 4.6). Off: they go to zero.
    follower_holds_current_in_dead_band: true,
    /// The follower's currents are not limited to the 500 mA of the rear valve (facts 4.6).
    /// Off: they are.
    follower_current_unlimited: true,
    /// The first press of button 15 goes from front steering straight to following (facts 4.6).
    /// Off: to combined.
    first_turn_press_skips_combined: true,
    /// The drive ECU's debug frames are sent twice a tick (facts 2.6). Off: once.
    debug_frames_sent_twice: true,
}

/// A name that is no switch's.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownQuirk(String);

impl fmt::Display for UnknownQuirk {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "no oddity {:?}; docs/firmware-2016.md lists them", self.0)
    }
}

impl core::error::Error for UnknownQuirk {}

impl Default for Quirks {
    fn default() -> Self {
        Self::firmware()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_switch_is_found_by_its_name_and_the_lists_agree() {
        let mut quirks = Quirks::none();
        for (name, _) in Quirks::firmware().list() {
            quirks.set(name, true).expect("its own name");
        }
        assert!(quirks.list().iter().all(|(_, on)| *on));
        let error = quirks.set("no_such", true).unwrap_err().to_string();
        assert_eq!(error, "no oddity \"no_such\"; docs/firmware-2016.md lists them");
        assert!(Quirks::none().list().iter().all(|(_, on)| !on));
        let off: Vec<_> = Quirks::firmware().list().into_iter().filter(|(_, on)| !on).collect();
        assert_eq!(off, [("negative_readings_wrap", false)]);
    }
}
