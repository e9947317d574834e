//! Whether a GeoTIFF is in metres, by its geo keys (OGC 19-008r4).
//!
//! A file may leave out the unit of its system, which is then whatever the registry has for the system's code:
//! metres or one of several feet. Only systems that are known to be in metres are taken at their code alone.

/// Geo keys that we look at, and their values.
const MODEL_TYPE: u16 = 1024;
const MODEL_GEOGRAPHIC: u16 = 2;
const PLAN_SYSTEM: u16 = 3072;
const PLAN_UNIT: u16 = 3076;
const HEIGHT_SYSTEM: u16 = 4096;
const HEIGHT_UNIT: u16 = 4099;
const METRE: u16 = 9001;
/// A key that is there and says nothing.
const UNDEFINED: u16 = 0;

/// Projected systems in metres, first and last code of a series (EPSG registry, 11.022): those of northern Europe and of
/// its large surveys, and UTM everywhere. Between the ends there is none in another unit.
const PLAN_IN_METRES: &[[u16; 2]] = &[
    // WGS 84 / UTM north and south, WGS 72 / UTM.
    [32601, 32660],
    [32701, 32760],
    [32201, 32260],
    [32301, 32360],
    // ETRS89, NAD83, NAD27 and ED50 / UTM.
    [25828, 25838],
    [26901, 26923],
    [26703, 26722],
    [23028, 23038],
    // SWEREF 99 and RT90; ETRS89 / TM35FIN and GK; ETRS89 / NTM.
    [3006, 3030],
    [3067, 3067],
    [3873, 3885],
    [5105, 5130],
    // ETRS89 for all of Europe, Web Mercator.
    [3034, 3035],
    [3038, 3051],
    [3857, 3857],
    // France, Britain, Ireland, the Netherlands, Germany, Switzerland, Austria, Estonia, Latvia, Lithuania, Poland.
    [2154, 2154],
    [3942, 3950],
    [27700, 27700],
    [2157, 2157],
    [28992, 28992],
    [31466, 31469],
    [2056, 2056],
    [21781, 21781],
    [31254, 31259],
    [31284, 31297],
    [3300, 3301],
    [3059, 3059],
    [3346, 3346],
    [2176, 2180],
    // Canada, Australia, New Zealand.
    [2944, 2962],
    [3153, 3159],
    [28348, 28358],
    [7846, 7859],
    [2193, 2193],
];
/// Vertical systems in metres.
const HEIGHT_IN_METRES: &[[u16; 2]] = &[
    // EGM2008, EGM96, mean sea level.
    [3855, 3855],
    [5773, 5773],
    [5714, 5714],
    // Sweden, Norway, Finland; EVRF2007 and EVRF2000.
    [5613, 5613],
    [5718, 5718],
    [5941, 5941],
    [5776, 5776],
    [3900, 3900],
    [5717, 5717],
    [5621, 5621],
    [5730, 5730],
    // Germany, France, Britain, the Netherlands, Switzerland, Denmark; Baltic 1977.
    [5783, 5783],
    [7837, 7837],
    [5720, 5720],
    [5701, 5701],
    [5709, 5709],
    [5728, 5729],
    [5799, 5799],
    [5705, 5705],
    // NAVD88 in metres, Australia.
    [5703, 5703],
    [5711, 5711],
];

/// What says in which unit plan or heights are.
struct Says {
    what: &'static str,
    unit: u16,
    system: u16,
    in_metres: &'static [[u16; 2]],
}

const BOTH: [Says; 2] = [
    Says { what: "plan", unit: PLAN_UNIT, system: PLAN_SYSTEM, in_metres: PLAN_IN_METRES },
    Says { what: "heights", unit: HEIGHT_UNIT, system: HEIGHT_SYSTEM, in_metres: HEIGHT_IN_METRES },
];

/// Refuses what is not in metres, or does not say so. A file that names no system at all is taken to be in metres, as
/// other height maps are.
///
/// # Errors
/// What is in which unit, and how to make it metres.
pub(super) fn check(keys: &[(u16, u16)]) -> Result<(), String> {
    if keys.contains(&(MODEL_TYPE, MODEL_GEOGRAPHIC)) {
        return Err("it lies in degrees; `gdalwarp -t_srs EPSG:3006` makes it metres (Sweden; elsewhere another code)".to_owned());
    }
    let value = |key: u16| {
        let found = keys.iter().find(|(found, _)| *found == key);
        found.map(|(_, value)| *value).filter(|&value| value != UNDEFINED)
    };
    for Says { what, unit, system, in_metres } in BOTH {
        match (value(unit), value(system)) {
            (Some(METRE), _) | (None, None) => {}
            (Some(code), _) => {
                return Err(format!(
                    "its {what} are in EPSG unit {code}, not in metres ({METRE}); reproject it with `gdalwarp`"
                ));
            }
            (None, Some(code))
                if in_metres.iter().any(|&[from, to]| (from..=to).contains(&code)) => {}
            (None, Some(code)) => {
                return Err(format!(
                    "its {what} are in EPSG system {code} without a word of the unit (geo key {unit}), which may be \
                     feet; `gdal_translate` writes a copy with its unit"
                ));
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const FOOT_US: u16 = 9003;

    #[test]
    fn a_system_without_its_unit_is_taken_only_if_it_is_known_to_be_in_metres() {
        // SWEREF 99 TM, WGS 84 / UTM zone 33N; RH 2000.
        for keys in [
            &[(PLAN_SYSTEM, 3006)][..],
            &[(PLAN_SYSTEM, 32633), (HEIGHT_SYSTEM, 5613)],
            &[],
            &[(PLAN_SYSTEM, UNDEFINED), (HEIGHT_SYSTEM, UNDEFINED)],
        ] {
            assert_eq!(check(keys), Ok(()), "{keys:?}");
        }
        // NAD83 / Pennsylvania South in US feet, of the user's own; NAVD88 in US feet.
        for (keys, says) in [
            (&[(PLAN_SYSTEM, 2272)][..], "plan are in EPSG system 2272"),
            (&[(PLAN_SYSTEM, 32767)], "plan are in EPSG system 32767"),
            (&[(PLAN_SYSTEM, 32633), (HEIGHT_SYSTEM, 6360)], "heights are in EPSG system 6360"),
        ] {
            let error = check(keys).unwrap_err();
            assert!(error.contains(says) && error.contains("gdal_translate"), "{error}");
        }
    }

    #[test]
    fn a_unit_that_is_said_counts_whatever_the_system() {
        assert_eq!(check(&[(PLAN_SYSTEM, 2272), (PLAN_UNIT, METRE)]), Ok(()));
        assert_eq!(check(&[(PLAN_SYSTEM, 32767), (PLAN_UNIT, METRE)]), Ok(()));
        let feet = [(PLAN_SYSTEM, 3006), (PLAN_UNIT, FOOT_US)];
        assert!(check(&feet).unwrap_err().contains("plan are in EPSG unit 9003"));
    }
}
