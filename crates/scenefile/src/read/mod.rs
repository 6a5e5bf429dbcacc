//! From the TOML tree to a description. What is wrong is reported and replaced by a stand-in, so that the rest can
//! still be checked; after an error the description is not given out.

mod amount;
mod light;
mod material;
mod object;
mod settings;
mod texture;

use crate::desc::{Group, SceneDesc};
use crate::diagnostic::{Diagnostic, Report, quoted};
use crate::document::{Entry, Node, Table, Value};
use crate::nearest::nearest;
use crate::preset;
use crate::reader::{Reader, as_table};
use crate::source::{Sourced, Span};
use crate::spec::{self, Form, SECTIONS, Section};

/// Reads a whole document.
pub(crate) fn scene(report: &mut Report, root: &Table) -> SceneDesc {
    let mut desc = SceneDesc::default();
    for entry in &root.entries {
        let node = &entry.node;
        match entry.key.as_str() {
            "render" => {
                with_table(report, &spec::RENDER, node, |report, r| settings::render(report, r, &mut desc))
            }
            "film" => with_table(report, &spec::FILM, node, |report, r| settings::film(report, r, &mut desc)),
            "camera" => {
                with_table(report, &spec::CAMERA, node, |report, r| settings::camera(report, r, &mut desc))
            }
            "photon_map" => with_table(report, &spec::PHOTON_MAP, node, |report, r| {
                settings::photon_map(report, r, &mut desc)
            }),
            "sppm" => with_table(report, &spec::SPPM, node, |report, r| settings::sppm(report, r, &mut desc)),
            "vcm" => with_table(report, &spec::VCM, node, |report, r| settings::vcm(report, r, &mut desc)),
            "textures" => each_named(report, &spec::TEXTURES, node, |report, entry, what| {
                let texture = texture::texture(report, what, &entry.node);
                desc.textures.insert(entry.key.clone(), Sourced::at(texture, name_span(entry)));
            }),
            "materials" => each_named(report, &spec::MATERIALS, node, |report, entry, what| {
                let material = material::material(report, what, &entry.node);
                desc.materials.insert(entry.key.clone(), Sourced::at(material, name_span(entry)));
            }),
            "objects" => each_listed(report, &spec::OBJECTS, node, |report, node, what| {
                desc.objects.push(Sourced::at(object::object(report, what, node), node.span));
            }),
            "lights" => each_listed(report, &spec::LIGHTS, node, |report, node, what| {
                if let Some(light) = light::light(report, what, node) {
                    desc.lights.push(Sourced::at(light, node.span));
                }
            }),
            "groups" => each_named(report, &spec::GROUPS, node, |report, entry, what| {
                let group = group(report, what, &entry.node);
                desc.groups.insert(entry.key.clone(), Sourced::at(group, name_span(entry)));
            }),
            "instances" => each_listed(report, &spec::INSTANCES, node, |report, node, what| {
                if let Some(instance) = object::instance(report, what, node) {
                    desc.instances.push(Sourced::at(instance, node.span));
                }
            }),
            _ => unknown_table(report, entry),
        }
    }
    desc
}

fn unknown_table(report: &mut Report, entry: &Entry) {
    if report.count_if_full() {
        return;
    }
    let names = || SECTIONS.iter().filter(|s| s.form != Form::Inline).map(|s| s.name);
    let heads = || names().chain([crate::include::KEY]);
    let kind = if matches!(entry.node.value, Value::Table(_) | Value::Array(_)) { "table" } else { "key" };
    let holder =
        SECTIONS.iter().find(|s| s.form == Form::Table && s.keys.iter().any(|k| k.name == entry.key));
    let help = match (nearest(&entry.key, heads()), holder) {
        (Some(name), _) => format!("did you mean `{name}`?"),
        (None, Some(section)) => format!("`{}` belongs below {}", entry.key, section.header()),
        (None, None) => format!("a scene has the tables {}", names().collect::<Vec<_>>().join(", ")),
    };
    let code = if kind == "table" { "unknown-table" } else { "unknown-key" };
    let message = format!("unknown {kind} {}", quoted(&entry.key));
    report.push(Diagnostic::error(code, message).at(entry.key_span).help(help));
}

/// The place that stands for a named table: its name.
fn name_span(entry: &Entry) -> Span {
    entry.key_span
}

fn with_table(
    report: &mut Report,
    section: &'static Section,
    node: &Node,
    read: impl FnOnce(&mut Report, &Reader<'_>),
) {
    let what = section.header();
    let Value::Table(table) = &node.value else {
        let message = format!("{what} is written once and holds keys; this is {}", node.type_name());
        report.push(
            Diagnostic::error("wrong-type", message)
                .at(node.span)
                .help(format!("write {what} on a line of its own")),
        );
        return;
    };
    let reader = Reader::new(report, section, what, table, node.span);
    read(report, &reader);
}

fn each_named(
    report: &mut Report,
    section: &'static Section,
    node: &Node,
    mut read: impl FnMut(&mut Report, &Entry, String),
) {
    let Value::Table(table) = &node.value else {
        let message = format!("every {} has a name; this is {}", section.noun, node.type_name());
        report.push(
            Diagnostic::error("wrong-type", message)
                .at(node.span)
                .help(format!("write {}", section.header())),
        );
        return;
    };
    for entry in &table.entries {
        let mut keys =
            section.keys.iter().chain(section.variants().iter().flat_map(|variant| variant.keys()));
        let switch = section.switch.is_some_and(|switch| switch.key == entry.key) || entry.key == preset::KEY;
        let value = !matches!(entry.node.value, Value::Table(_));
        if value && (switch || keys.any(|key| key.name == entry.key)) {
            let message = format!("a {} without a name", section.noun);
            report.push(
                Diagnostic::error("wrong-type", message)
                    .at(entry.key_span)
                    .help(format!("write {} above it", section.header())),
            );
            continue;
        }
        read(report, entry, format!("{} {}", section.noun, quoted(&entry.key)));
    }
}

/// "object `ball`", or "object 3" for one without a name.
fn listed_name(section: &Section, node: &Node, index: usize) -> String {
    let name = match &node.value {
        Value::Table(table) => table.get("name").map(|entry| &entry.node.value),
        _ => None,
    };
    match name {
        Some(Value::Text(name)) => format!("{} {}", section.noun, quoted(name)),
        _ => format!("{} {}", section.noun, index + 1),
    }
}

fn each_listed(
    report: &mut Report,
    section: &'static Section,
    node: &Node,
    mut read: impl FnMut(&mut Report, &Node, String),
) {
    let Value::Array(items) = &node.value else {
        let message = format!("there may be several of {}; this is {}", section.name, node.type_name());
        report.push(
            Diagnostic::error("wrong-type", message)
                .at(node.span)
                .help(format!("write [[{}]] with two brackets", section.name)),
        );
        return;
    };
    for (index, item) in items.iter().enumerate() {
        read(report, item, listed_name(section, item, index));
    }
}

fn group(report: &mut Report, what: String, node: &Node) -> Group {
    let mut group = Group::default();
    let Some(table) = as_table(report, &what, node) else { return group };
    let reader = Reader::new(report, &spec::GROUPS, what, table, node.span);
    match reader.given("objects") {
        None => reader.missing(report, "objects"),
        Some(entry) => match &entry.node.value {
            Value::Array(items) => {
                for (index, item) in items.iter().enumerate() {
                    let what = format!("{} of {}", listed_name(&spec::OBJECTS, item, index), reader.what);
                    group.objects.push(Sourced::at(object::object(report, what, item), item.span));
                }
            }
            _ => {
                crate::convert::wrong_type(report, &reader.label("objects"), "a list of objects", &entry.node)
            }
        },
    }
    group
}
