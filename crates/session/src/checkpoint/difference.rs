use scenefile::SceneDesc;
use toml::{Table, Value};

use crate::hash::canonical;

/// Most differences that are told.
const MOST: usize = 8;

/// Where two descriptions differ in what decides the radiance of a pass: each as `key: this, that`.
pub(crate) fn differences(a: &SceneDesc, b: &SceneDesc) -> Vec<String> {
    let mut found = Vec::new();
    if let (Some(a), Some(b)) = (table(&canonical(a)), table(&canonical(b))) {
        compare("", &Value::Table(a), &Value::Table(b), &mut found);
    }
    // Seeds may be greater than TOML's integers; they tell passes apart though not scenes.
    if a.render.seed != b.render.seed {
        found.insert(0, format!("render.seed: {}, {}", a.render.seed, b.render.seed));
    }
    if found.len() > MOST {
        let more = found.len() - MOST;
        found.truncate(MOST);
        found.push(format!("and {more} more"));
    }
    found
}

fn table(desc: &SceneDesc) -> Option<Table> {
    scenefile::to_toml(desc).parse().ok()
}

fn compare(key: &str, a: &Value, b: &Value, found: &mut Vec<String>) {
    match (a, b) {
        (Value::Table(a), Value::Table(b)) => {
            let keys = a.keys().chain(b.keys().filter(|k| !a.contains_key(*k)));
            for name in keys {
                let key = if key.is_empty() { name.clone() } else { format!("{key}.{name}") };
                both(&key, a.get(name), b.get(name), found);
            }
        }
        (Value::Array(a), Value::Array(b)) if a.iter().chain(b).any(Value::is_table) => {
            for i in 0..a.len().max(b.len()) {
                both(&format!("{key}[{i}]"), a.get(i), b.get(i), found);
            }
        }
        _ if a == b => {}
        _ => found.push(format!("{key}: {}, {}", short(Some(a)), short(Some(b)))),
    }
}

fn both(key: &str, a: Option<&Value>, b: Option<&Value>, found: &mut Vec<String>) {
    let empty = Value::Table(Table::new());
    match (a, b) {
        (Some(a), Some(b)) => compare(key, a, b, found),
        // A table of which one holds nothing but defaults; the elements of lists are named as such.
        (Some(a @ Value::Table(_)), None) if !key.ends_with(']') => compare(key, a, &empty, found),
        (None, Some(b @ Value::Table(_))) if !key.ends_with(']') => compare(key, &empty, b, found),
        _ => found.push(format!("{key}: {}, {}", short(a), short(b))),
    }
}

/// A value in few words; defaults are not written in descriptions.
fn short(value: Option<&Value>) -> String {
    match value {
        None => "not given".into(),
        Some(Value::Table(_)) => "given".into(),
        Some(value) => {
            let text = value.to_string();
            if text.chars().count() > 60 {
                text.chars().take(57).chain("...".chars()).collect()
            } else {
                text
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use scenefile::desc::{Material, Object, Shape};

    #[test]
    fn keys_and_values_are_named() {
        let mut a = SceneDesc::default();
        let ball = |radius: f32| {
            Object::new(Shape::Sphere { center: [0.0; 3], radius }, Material::diffuse(0.5)).into()
        };
        a.objects.push(ball(3.0));
        let mut b = a.clone();
        b.render.passes = 99;
        b.film.exposure = color::Exposure::Ev(2.0);
        b.base = "elsewhere".into();
        assert_eq!(differences(&a, &b), Vec::<String>::new());
        b.render.max_depth = Some(4);
        b.render.seed = 7;
        b.objects[0] = ball(2.0);
        b.objects.push(ball(1.0));
        assert_eq!(
            differences(&a, &b),
            [
                "render.seed: 0, 7",
                "objects[0].radius: 3, 2",
                "objects[1]: not given, given",
                "render.max_depth: not given, 4",
            ]
        );
        a.render.seed = u64::MAX;
        assert!(differences(&a, &b).contains(&format!("render.seed: {}, 7", u64::MAX)));
        for i in 0..20 {
            b.objects.push(ball(i as f32));
        }
        let many = differences(&a, &b);
        assert_eq!((many.len(), many[8].as_str()), (9, "and 16 more"), "{many:?}");
    }
}
