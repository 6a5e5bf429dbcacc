//! Values of flags as people type them.

use std::ops::Range;
use std::time::Duration;

use nephroid::{Crop, Exposure, Extent, Film, ViewTransform, WhiteBalance, blackbody_rgb, srgb8_to_linear};

use crate::span;

/// As in scene files.
const MAX_PIXELS: u64 = 1 << 30;

/// Size of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Size {
    /// Width and height.
    Both([u32; 2]),
    /// The width; the height keeps the aspect.
    Width(u32),
}

/// 640x480, or a width alone.
///
/// # Errors
/// What is wrong, for people.
pub fn size(text: &str) -> Result<Size, String> {
    let wrong = || {
        "a size is width x height in pixels, as 640x480, or a width, as 640; each from 1 to 65536".to_owned()
    };
    let side = |s: &str| s.trim().parse::<u32>().ok().filter(|n| (1..=65536).contains(n)).ok_or_else(wrong);
    let Some((w, h)) = text.split_once(['x', 'X', '×']) else {
        return side(text).map(Size::Width);
    };
    let size = [side(w)?, side(h)?];
    if u64::from(size[0]) * u64::from(size[1]) > MAX_PIXELS {
        return Err("a picture has at most 2^30 pixels".to_owned());
    }
    Ok(Size::Both(size))
}

/// 10,20.
///
/// # Errors
/// What is wrong, for people.
pub fn pixel(text: &str) -> Result<[u32; 2], String> {
    let numbers = text.split_once(',').map(|(x, y)| (x.trim().parse(), y.trim().parse()));
    let Some((Ok(x), Ok(y))) = numbers else {
        return Err("a pixel is its column and its row, as 10,20".to_owned());
    };
    Ok([x, y])
}

/// A number of stops.
///
/// # Errors
/// What is wrong, for people.
pub fn exposure(text: &str) -> Result<Exposure, String> {
    if text == "auto" {
        return Ok(Exposure::Auto);
    }
    let wrong = |_| "an exposure is a number of stops, as 1.5 or -2, or auto".to_owned();
    let value: f32 = text.parse().map_err(wrong)?;
    if (Exposure::RANGE[0]..=Exposure::RANGE[1]).contains(&value) {
        return Ok(Exposure::Ev(value));
    }
    Err("an exposure lies between -64 and 64 EV".to_owned())
}

/// A group of lights and what its light is multiplied by, channel by channel.
#[derive(Clone, Debug, PartialEq)]
pub struct GroupFactor {
    /// The group's name.
    pub group: String,
    /// The factor.
    pub factor: [f32; 3],
}

/// GROUP=FACTOR or GROUP=FACTOR,COLOUR.
///
/// # Errors
/// What is wrong, for people.
pub fn light(text: &str) -> Result<GroupFactor, String> {
    let wrong =
        || "a light is as sun=0.5, or with a colour lamp=2,1,0.8,0.6 or lamp=2,#ffd0a0 or lamp=2,3000K";
    let (group, value) = text.split_once('=').filter(|(group, _)| !group.is_empty()).ok_or_else(wrong)?;
    let (factor, rest) = value.split_once(',').map_or((value, None), |(factor, rest)| (factor, Some(rest)));
    let number = |text: &str| text.trim().parse::<f32>().ok().filter(|v| (0.0..=1e12).contains(v));
    let factor = number(factor).ok_or_else(wrong)?;
    let colour = rest.map_or(Some([1.0; 3]), |rest| colour(rest.trim())).ok_or_else(wrong)?;
    Ok(GroupFactor { group: group.to_owned(), factor: colour.map(|c| c * factor) })
}

/// r,g,b (linear), #rrggbb (sRGB) or 3000K.
fn colour(text: &str) -> Option<[f32; 3]> {
    if let Some(digits) = text.strip_prefix('#') {
        let whole = digits.len() == 6 && digits.bytes().all(|b| b.is_ascii_hexdigit());
        let byte = |i: usize| u8::from_str_radix(digits.get(2 * i..2 * i + 2)?, 16).ok();
        return whole.then(|| Some([byte(0)?, byte(1)?, byte(2)?].map(srgb8_to_linear)))?;
    }
    if let Some(kelvin) = text.strip_suffix(['K', 'k']) {
        let kelvin = kelvin.trim().parse().ok().filter(|k| (1000.0..=40000.0).contains(k))?;
        return Some(blackbody_rgb(kelvin));
    }
    let number = |text: &str| text.trim().parse::<f32>().ok().filter(|v| (0.0..=1e6).contains(v));
    let numbers: Vec<f32> = text.split(',').map(number).collect::<Option<_>>()?;
    numbers.try_into().ok()
}

/// A white balance.
///
/// # Errors
/// What is wrong, for people.
pub fn white_balance(text: &str) -> Result<WhiteBalance, String> {
    WhiteBalance::from_text(text).ok_or_else(|| {
        "a white balance is a temperature from 1000 to 40000 K, as 3200K, an illuminant, as D50, A or F11, auto or none"
            .to_owned()
    })
}

/// A view.
///
/// # Errors
/// What is wrong, for people.
pub fn view(text: &str) -> Result<ViewTransform, String> {
    let names = || ViewTransform::ALL.map(ViewTransform::name).join(", ");
    ViewTransform::from_name(text).ok_or_else(|| format!("a view is one of {}", names()))
}

/// A number of threads; 0: one for each core.
///
/// # Errors
/// What is wrong, for people.
pub fn threads(text: &str) -> Result<usize, String> {
    text.parse().ok().filter(|n| *n <= 1024).ok_or_else(|| "threads are a number from 0 to 1024".to_owned())
}

/// 64..128.
///
/// # Errors
/// What is wrong, for people.
pub fn range(text: &str) -> Result<Range<u64>, String> {
    let numbers = text.split_once("..").map(|(a, b)| (a.trim().parse(), b.trim().parse()));
    let Some((Ok(start), Ok(end))) = numbers else {
        return Err("a range of passes is as 64..128: the first, and the one after the last".to_owned());
    };
    match start..end {
        range if range.end > Film::MAX_PASSES => {
            Err(format!("passes are numbered below {}", Film::MAX_PASSES))
        }
        range if start > end => {
            Err(format!("the range is reversed: {end}..{start} is meant?", end = range.end))
        }
        range if range.is_empty() => Err("the range is empty: its end is the pass after the last".to_owned()),
        range => Ok(range),
    }
}

/// 256, or +64.
///
/// # Errors
/// What is wrong, for people.
pub fn extent(text: &str) -> Result<Extent, String> {
    let (number, extent): (_, fn(u64) -> Extent) = match text.strip_prefix('+') {
        Some(more) => (more, Extent::More),
        None => (text, Extent::Total),
    };
    match number.parse() {
        Ok(n) if (1..=Film::MAX_PASSES).contains(&n) && number.starts_with(|c: char| c.is_ascii_digit()) => {
            Ok(extent(n))
        }
        _ => Err(format!("passes are a number from 1 to {}, or as many more, as +64", Film::MAX_PASSES)),
    }
}

/// 2%: a share of a hundredth to a hundred percent.
///
/// # Errors
/// What is wrong, for people.
pub fn noise(text: &str) -> Result<f32, String> {
    let wrong = || "a noise is in percent, as 2% or 0.5%".to_owned();
    let percent: f32 =
        text.trim().strip_suffix('%').ok_or_else(wrong)?.trim().parse().map_err(|_| wrong())?;
    if (0.01..=100.0).contains(&percent) {
        return Ok(percent / 100.0);
    }
    Err("a noise lies between 0.01% and 100%".to_owned())
}

/// 10,20,110,80 in pixels, or all in percent.
///
/// # Errors
/// What is wrong, for people.
pub fn crop(text: &str) -> Result<Crop, String> {
    let wrong = || {
        "a crop is left,top,right,bottom in pixels, as 100,50,300,200, or in percent, as 25%,0%,75%,50%"
            .to_owned()
    };
    let parts: Vec<&str> = text.split(',').map(str::trim).collect();
    let [_, _, _, _] = parts[..] else { return Err(wrong()) };
    let crop = if parts.iter().all(|part| part.ends_with('%')) {
        let share = |part: &&str| part.trim_end_matches('%').trim().parse::<f64>().ok().map(|p| p / 100.0);
        let shares: Option<Vec<f64>> = parts.iter().map(share).collect();
        let shares: [f64; 4] = shares.and_then(|s| s.try_into().ok()).ok_or_else(wrong)?;
        if !shares.iter().all(|share| (0.0..=1.0).contains(share)) {
            return Err("shares of a picture lie between 0% and 100%".to_owned());
        }
        Crop::Shares(shares)
    } else {
        let pixels: Option<Vec<u32>> = parts.iter().map(|part| part.parse().ok()).collect();
        Crop::Pixels(pixels.and_then(|p| p.try_into().ok()).ok_or_else(wrong)?)
    };
    let is_empty = match crop {
        Crop::Pixels([x0, y0, x1, y1]) => x0 >= x1 || y0 >= y1,
        Crop::Shares([x0, y0, x1, y1]) => x0 >= x1 || y0 >= y1,
    };
    if is_empty {
        Err("the crop is empty: right and bottom lie beyond left and top".to_owned())
    } else {
        Ok(crop)
    }
}

/// Values of the camera that are replaced, as --set has them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CameraSets(pub Vec<String>);

/// 0,2,5:0,1,0:40: where it stands, what it looks at, its field of view; each may be left out.
///
/// # Errors
/// What is wrong, for people.
pub fn camera(text: &str) -> Result<CameraSets, String> {
    let wrong =
        || "a camera is position:look_at:fov, as 0,2,5:0,1,0:40, of which parts may be left out".to_owned();
    let number = |part: &str| part.trim().parse::<f64>().ok().filter(|n| n.is_finite()).ok_or_else(wrong);
    let parts: Vec<&str> = text.split(':').map(str::trim).collect();
    if parts.len() > 3 || parts.iter().all(|part| part.is_empty()) {
        return Err(wrong());
    }
    let mut sets = Vec::new();
    for (part, key) in
        parts.into_iter().zip(["position", "look_at", "fov"]).filter(|(part, _)| !part.is_empty())
    {
        if key == "fov" {
            sets.push(format!("camera.fov={:?}", number(part)?));
            continue;
        }
        let point: Vec<String> =
            part.split(',').map(|n| number(n).map(|n| format!("{n:?}"))).collect::<Result<_, _>>()?;
        if point.len() != 3 {
            return Err(wrong());
        }
        sets.push(format!("camera.{key}=[{}]", point.join(", ")));
    }
    Ok(CameraSets(sets))
}

/// How often pictures are rewritten while passes come; `None`: never.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Previews(pub Option<Duration>);

/// A time, or off.
///
/// # Errors
/// What is wrong, for people.
pub fn previews(text: &str) -> Result<Previews, String> {
    match text.trim() {
        "off" => Ok(Previews(None)),
        text => span::parse(text).map(|time| Previews(Some(time))).map_err(|e| format!("{e}; or off")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crops() {
        assert_eq!(crop("1, 2,3,4"), Ok(Crop::Pixels([1, 2, 3, 4])));
        assert_eq!(crop("25%,0%,75%,50 %"), Ok(Crop::Shares([0.25, 0.0, 0.75, 0.5])));
        for wrong in
            ["", "1,2,3", "1,2,3,4,5", "3,2,3,4", "0.1,0.2,0.3,0.4", "1,2,30%,4", "0%,0%,101%,5%", "-1,0,3,4"]
        {
            assert!(crop(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn cameras() {
        let sets = |text: &str| camera(text).map(|c| c.0.join(" "));
        let whole = "camera.position=[0.0, -2.0, 5.0] camera.look_at=[0.0, 1.0, 0.0] camera.fov=40.0";
        assert_eq!(sets("0,-2,5:0,1,0:40").as_deref(), Ok(whole));
        assert_eq!(sets("0,-2,5").as_deref(), Ok("camera.position=[0.0, -2.0, 5.0]"));
        assert_eq!(sets("::25").as_deref(), Ok("camera.fov=25.0"));
        for wrong in ["", "::", "1,2", "1,2,3:4", "1,2,x", "1,2,3:4,5,6:7:8", "nan,0,0"] {
            assert!(camera(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn noises_and_previews() {
        assert_eq!(noise("2%"), Ok(0.02));
        assert_eq!(noise("0.5 %"), Ok(0.005));
        for wrong in ["", "%", "2", "0.02", "-2%", "nan%", "inf%", "0%", "101%"] {
            assert!(noise(wrong).is_err(), "{wrong}");
        }
        assert_eq!(previews("off"), Ok(Previews(None)));
        assert_eq!(previews("5s"), Ok(Previews(Some(Duration::from_secs(5)))));
        assert!(previews("never").unwrap_err().contains("off"));
    }

    #[test]
    fn sizes() {
        assert_eq!(size("640x480"), Ok(Size::Both([640, 480])));
        assert_eq!(size("7X5"), Ok(Size::Both([7, 5])));
        assert_eq!(size("640"), Ok(Size::Width(640)));
        for wrong in [
            "",
            "0",
            "-1",
            "1.5",
            "65537",
            "640x",
            "0x5",
            "5x0",
            "-1x5",
            "65537x1",
            "1x2x3",
            "axb",
            "65536x65536",
        ] {
            assert!(size(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn pixels() {
        assert_eq!(pixel("10,20"), Ok([10, 20]));
        for wrong in ["", "10", "10,", "-1,2", "1,2,3", "a,b"] {
            assert!(pixel(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn exposures() {
        assert_eq!(exposure("-1.5"), Ok(Exposure::Ev(-1.5)));
        assert_eq!(exposure("auto"), Ok(Exposure::Auto));
        assert!(view("agx-punch").unwrap_err().contains("agx-punchy"));
        assert!(white_balance("D66").unwrap_err().contains("D50"));
        for wrong in ["", "x", "nan", "inf", "65"] {
            assert!(exposure(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn lights() {
        let factor = |text: &str| light(text).map(|light| (light.group, light.factor));
        assert_eq!(factor("sun=0.5"), Ok(("sun".into(), [0.5; 3])));
        assert_eq!(factor("a b=2,1,0.5,0"), Ok(("a b".into(), [2.0, 1.0, 0.0])));
        assert_eq!(factor("lamp=3,#ff0000"), Ok(("lamp".into(), [3.0, 0.0, 0.0])));
        let [r, _, b] = factor("lamp=1,3000K").unwrap().1;
        assert!(r > 1.0 && b < 0.5);
        for wrong in
            ["sun", "=1", "sun=", "sun=-1", "sun=nan", "sun=1,#ff", "sun=1,2", "sun=1,1,2,x", "s=1,#ééé"]
        {
            assert!(light(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn ranges_of_passes() {
        assert_eq!(range("64..128"), Ok(64..128));
        assert_eq!(range("0..4194304"), Ok(0..4_194_304));
        for (wrong, said) in
            [("4..4", "empty"), ("9..3", "3..9"), ("5", "64..128"), ("..4", "64"), ("-1..4", "64")]
        {
            let message = range(wrong).unwrap_err();
            assert!(message.contains(said), "{wrong}: {message}");
        }
        assert!(range("0..4194305").is_err());
    }

    #[test]
    fn extents() {
        assert_eq!(extent("64"), Ok(Extent::Total(64)));
        assert_eq!(extent("+1"), Ok(Extent::More(1)));
        for wrong in ["", "0", "+0", "++4", "-4", "x", "4194305"] {
            assert!(extent(wrong).is_err(), "{wrong}");
        }
    }
}
