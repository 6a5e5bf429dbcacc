//! Sun and sky, by direction or by place and time.

use std::f64::consts::PI;

use scenefile::desc::SunSky;

use super::plugin::Plugin;
use crate::matrix::{Matrix, narrow, unit};
use crate::report::Report;

/// The sun and sky of `sunsky` (version 3, z up) and of `sun`, `sky` and `sunsky` (version 0.6, y up), without the albedo of a
/// ground that is a colour. `mirror`: our world from Mitsuba's. `None`: the sun's direction has no length.
pub(super) fn sun_sky(report: &mut Report, plugin: &Plugin, mirror: &Matrix) -> Option<SunSky> {
    let y_up = plugin.old;
    let mut number = |name: &str, default: f64| plugin.number_or(report, name, default);
    let turbidity = number("turbidity", 3.0).clamp(1.7, 10.0);
    let [sun_scale, sky_scale] = ["sun_scale", "sky_scale"].map(|name| number(name, 1.0));
    let scale = number("scale", 1.0);
    let aperture = number("sun_aperture", 0.5358) * number("sun_radius_scale", 1.0);
    let time = Time {
        year: number("year", 2010.0),
        month: number("month", 7.0),
        day: number("day", 10.0),
        hours: number("hour", 15.0) + number("minute", 0.0) / 60.0 + number("second", 0.0) / 3600.0,
        zone: number("timezone", 9.0),
        latitude: number("latitude", 35.6894),
        longitude: number("longitude", 139.6917),
    };
    plugin.ignore(&["stretch", "resolution", "complex_sun", "extend", "sun_samples", "window_start_time"]);
    plugin.ignore(&["window_end_time", "end_year", "end_month", "end_day"]);
    let given = plugin.triple(report, "sun_direction").and_then(unit);
    if plugin.find("sun_direction").is_some() && given.is_none() {
        report.error("degenerate", "the direction of the sun has no length", plugin.span);
        return None;
    }
    let (sun, sky) = match plugin.kind.as_str() {
        "sun" => (sun_scale * scale, 0.0),
        "sky" => (0.0, sky_scale * scale),
        _ => (sun_scale * scale, sky_scale * scale),
    };
    // Ours has +y up; a z that is up goes there.
    let upright =
        Matrix([[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, -1.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]]);
    let place = plugin.place(report, "to_world");
    let place = if y_up { place } else { place.after(&upright) };
    let direction = match given {
        // That is one of the world.
        Some(direction) => place.inverse()?.vector(direction),
        None => {
            let (elevation, azimuth) = time.sun();
            let (se, ce) = elevation.sin_cos();
            let (sa, ca) = azimuth.sin_cos();
            // Clockwise from north, which is −z in version 0.6 (east: +x) and −x in version 3 (east: −y, up: z).
            if y_up { [sa * ce, se, -ca * ce] } else { [-ca * ce, se, sa * ce] }
        }
    };
    Some(SunSky {
        sun_direction: narrow(direction),
        turbidity: turbidity as f32,
        sun_scale: sun.max(0.0) as f32 / SunSky::OVER_MITSUBA,
        sun_angle: (aperture / 2.0) as f32,
        sky_scale: sky.max(0.0) as f32 / SunSky::OVER_MITSUBA,
        transform: mirror.after(&place).steps(),
        ..SunSky::default()
    })
}

/// A place on earth and a time there.
struct Time {
    year: f64,
    month: f64,
    day: f64,
    /// Since midnight, by the clock of the zone.
    hours: f64,
    /// Hours ahead of UTC.
    zone: f64,
    /// Degrees north and east.
    latitude: f64,
    longitude: f64,
}

impl Time {
    /// Elevation of the sun and its azimuth clockwise from north, in radians (Blanco-Muriel, Alarcón-Padilla,
    /// López-Moratalla & Lara-Coira 2001, "Computing the solar vector", table 1).
    fn sun(&self) -> (f64, f64) {
        let hours = self.hours - self.zone;
        // Days since 2000-01-01 12:00 UTC.
        let (y, m) = (self.year.trunc(), self.month.trunc());
        let early = ((m - 14.0) / 12.0).trunc();
        let whole = ((1461.0 * (y + 4800.0 + early)) / 4.0).trunc()
            + ((367.0 * (m - 2.0 - 12.0 * early)) / 12.0).trunc()
            - ((3.0 * ((y + 4900.0 + early) / 100.0).trunc()) / 4.0).trunc()
            + self.day
            - 32075.0;
        let n = whole - 0.5 + hours / 24.0 - 2_451_545.0;
        let omega = 2.1429 - 0.001_039_459_4 * n;
        let mean = 4.895_063_0 + 0.017_202_791_698 * n;
        let anomaly = 6.240_060_0 + 0.017_201_969_9 * n;
        let ecliptic = mean + 0.033_416_07 * anomaly.sin() + 0.000_348_94 * (2.0 * anomaly).sin()
            - 0.000_113_4
            - 0.000_020_3 * omega.sin();
        let tilt = 0.409_092_8 - 6.2140e-9 * n + 0.000_039_6 * omega.cos();
        let ascension = (tilt.cos() * ecliptic.sin()).atan2(ecliptic.cos()).rem_euclid(2.0 * PI);
        let declination = (tilt.sin() * ecliptic.sin()).asin();
        let sidereal = 6.697_424_324_2 + 0.065_709_828_3 * n + hours;
        let hour_angle = (sidereal * 15.0 + self.longitude).to_radians() - ascension;
        let latitude = self.latitude.to_radians();
        let zenith = (latitude.cos() * hour_angle.cos() * declination.cos()
            + declination.sin() * latitude.sin())
        .clamp(-1.0, 1.0)
        .acos();
        let azimuth =
            (-hour_angle.sin()).atan2(declination.tan() * latitude.cos() - latitude.sin() * hour_angle.cos());
        // The earth's radius over its distance to the sun.
        let parallax = 6371.01 / 149_597_890.0 * zenith.sin();
        (PI / 2.0 - (zenith + parallax), azimuth.rem_euclid(2.0 * PI))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sun_stands_where_almanacs_say() {
        // Greenwich at noon of the June solstice of 2020: elevation 90° − 51.48° + 23.44°, in the south.
        let greenwich = Time {
            year: 2020.0,
            month: 6.0,
            day: 21.0,
            hours: 12.03,
            zone: 0.0,
            latitude: 51.48,
            longitude: 0.0,
        };
        let (elevation, azimuth) = greenwich.sun();
        assert!((elevation.to_degrees() - 61.96).abs() < 0.05, "{}", elevation.to_degrees());
        assert!((azimuth.to_degrees() - 180.0).abs() < 0.5, "{}", azimuth.to_degrees());
        // On the equator at an equinox the sun rises in the east, and six hours after noon it is in the west.
        let equator = Time {
            year: 2021.0,
            month: 3.0,
            day: 20.0,
            hours: 18.12,
            zone: 0.0,
            latitude: 0.0,
            longitude: 0.0,
        };
        let (elevation, azimuth) = equator.sun();
        assert!(elevation.to_degrees().abs() < 0.3 && (azimuth.to_degrees() - 270.0).abs() < 0.5);
    }
}
