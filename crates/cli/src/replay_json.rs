//! A replayed path as JSON. Numbers that are not finite become strings: "NaN", "inf", "-inf".

use nephroid::{PathEvent, ReplayKey, Replayed};
use serde_json::{Value, json};

/// One object, with a line break.
pub fn json(key: ReplayKey, path: &Replayed) -> String {
    let mut object = match key {
        ReplayKey::Pixel { pass, x, y } => json!({ "pass": pass, "pixel": [x, y] }),
        ReplayKey::Photon { pass, path: index, .. } => {
            json!({ "pass": pass, "photon": index, "map": path.kind.map(|kind| kind.name()) })
        }
    };
    object["events"] = path.record.events.iter().map(event).collect();
    if let Some(sample) = &path.record.sample {
        object["sample"] = json!({
            "direct": list(&sample.direct),
            "caustic": list(&sample.caustic),
            "indirect": list(&sample.indirect),
            "weight": number(sample.weight),
        });
    }
    format!("{object}\n")
}

fn event(event: &PathEvent) -> Value {
    match event {
        PathEvent::Start { light, position, direction, flux } => json!({
            "event": "start",
            "light": light,
            "position": list(position),
            "direction": list(direction),
            "flux": list(flux),
        }),
        PathEvent::Vertex(v) => json!({
            "event": "vertex",
            "depth": v.depth,
            "position": list(&v.position),
            "distance": number(v.distance),
            "object": v.object,
            "material": v.material,
            "scattering": v.scattering,
            "class": if v.is_diffuse { "D" } else { "S" },
            "light": v.light,
            "normal": list(&v.ng),
            "shadingNormal": list(&v.ns),
            "footprint": number(v.footprint),
            "throughput": list(&v.throughput),
        }),
        PathEvent::Light { layer, technique, from, radiance } => json!({
            "event": "light",
            "layer": layer,
            "technique": technique.name(),
            "from": from,
            "radiance": list(radiance),
        }),
        PathEvent::Joined { light_path } => json!({ "event": "joined", "lightPath": light_path }),
        PathEvent::Stored { power, caustic } => {
            json!({ "event": "stored", "power": list(power), "caustic": caustic })
        }
        PathEvent::Splat { film_position, layer, radiance } => json!({
            "event": "splat",
            "filmPosition": list(film_position),
            "layer": layer,
            "radiance": list(radiance),
        }),
        PathEvent::End(end) => json!({ "event": "end", "how": end.text() }),
    }
}

fn list(values: &[f32]) -> Value {
    values.iter().map(|v| number(*v)).collect()
}

fn number(value: f32) -> Value {
    if value.is_finite() { json!(value) } else { json!(value.to_string()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_finite_is_said() {
        let said = list(&[0.5, f32::NAN, f32::INFINITY, f32::NEG_INFINITY]).to_string();
        assert_eq!(said, r#"[0.5,"NaN","inf","-inf"]"#);
    }
}
