//! What was measured against what is to be reached.

use std::fmt::Write as _;

/// The bars: name, and the ratio to reach.
pub const BARS: &[(&str, f64)] = &[
    ("search.k100.vs_nanoflann", 6.0),
    ("search.k500.vs_nanoflann", 15.0),
    ("search.radius.vs_nanoflann", 8.0),
    ("search.build.vs_nanoflann", 1.7),
    ("search.memory.vs_40_bytes", 1.0),
    ("threads.search", 1.85),
    ("rays.room.incoherent.vs_embree_robust", 1.1),
    ("rays.room.camera.vs_embree_robust", 1.2),
    ("rays.displaced.incoherent.vs_embree_robust", 0.95),
    ("rays.build.vs_embree", 1.0 / 3.0),
    ("paths.box.vs_mitsuba_scalar", 3.0),
    ("paths.box.vs_mitsuba_llvm", 1.5),
    ("threads.path", 1.85),
    ("threads.photon_map", 1.85),
    ("threads.sppm", 1.85),
    ("threads.vcm", 1.85),
    ("threads.auto", 1.85),
    ("pairs.sppm", 0.5),
    ("pairs.vcm", 0.2),
    ("memory.vcm.vs_64_bytes", 1.0),
];

/// The bar of a name.
pub fn bar(name: &str) -> Option<f64> {
    BARS.iter().find(|(n, _)| *n == name).map(|(_, bar)| *bar)
}

/// One measured ratio.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Dotted name, group first.
    pub name: String,
    /// > 1: we are faster. Of names that end in `.lost`: how many rays were lost; of `pairs.*`: millions a second.
    pub ratio: f64,
    /// Our figure, the peer's, and their unit.
    pub figures: Option<(f64, f64, &'static str)>,
}

/// All that was measured, in order.
pub type Rows = Vec<Row>;

impl Row {
    /// A ratio alone.
    pub fn new(name: impl Into<String>, ratio: f64) -> Self {
        Self { name: name.into(), ratio, figures: None }
    }

    /// With the figures that it is of.
    pub fn figures(self, ours: f64, theirs: f64, unit: &'static str) -> Self {
        Self { figures: Some((ours, theirs, unit)), ..self }
    }

    /// Whether the number is a count that must be 0, and no ratio.
    pub fn is_count(&self) -> bool {
        self.name.ends_with(".lost")
    }

    fn verdict(&self) -> &'static str {
        let met = match bar(&self.name) {
            _ if self.is_count() => self.ratio == 0.0,
            Some(bar) => self.ratio >= bar,
            None => return "",
        };
        if met { "met" } else { "MISSED" }
    }
}

/// The table; names of `expected` that were not measured are said to be skipped.
pub fn table(rows: &[Row], expected: &[&str]) -> String {
    let mut out =
        format!("{:<44} {:>8} {:>6} {:<7} {:>10} {:>10}\n", "name", "ratio", "bar", "", "ours", "peer");
    for row in rows {
        let bar = match bar(&row.name) {
            Some(bar) => format!("{bar:.2}"),
            None if row.is_count() => "0".into(),
            None => String::new(),
        };
        let ratio = if row.is_count() { format!("{}", row.ratio) } else { format!("{:.3}", row.ratio) };
        let _ = write!(out, "{:<44} {ratio:>8} {bar:>6} {:<7}", row.name, row.verdict());
        if let Some((ours, theirs, unit)) = row.figures {
            let _ = write!(out, " {ours:>10.3} {theirs:>10.3} {unit}");
        }
        out.truncate(out.trim_end().len());
        out.push('\n');
    }
    for name in expected.iter().filter(|name| rows.iter().all(|row| row.name != **name)) {
        let _ =
            writeln!(out, "{name:<44} {:>8} {:>6.2} peer is missing", "skipped", bar(name).unwrap_or(1.0));
    }
    out
}

/// `{name: ratio}`; counts are no ratios and stay out.
pub fn json(rows: &[Row]) -> String {
    let ratios = rows.iter().filter(|row| !row.is_count());
    let map: serde_json::Map<_, _> = ratios.map(|row| (row.name.clone(), row.ratio.into())).collect();
    format!("{:#}\n", serde_json::Value::Object(map))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_are_met_or_missed() {
        let rows = [
            Row::new("paths.box.vs_mitsuba_llvm", 1.5).figures(3.0, 2.0, "M paths/s"),
            Row::new("threads.path", 1.84),
            Row::new("rays.room.camera.lost", 0.0),
            Row::new("rays.room.incoherent.lost", 1.0),
            Row::new("search.k100.vs_kiddo", 2.0),
        ];
        let text = table(&rows, &["threads.path", "threads.search"]);
        let words: Vec<Vec<&str>> = text.lines().map(|line| line.split_whitespace().collect()).collect();
        assert_eq!(
            words[1],
            ["paths.box.vs_mitsuba_llvm", "1.500", "1.50", "met", "3.000", "2.000", "M", "paths/s"]
        );
        assert_eq!(words[2], ["threads.path", "1.840", "1.85", "MISSED"]);
        assert_eq!(words[3], ["rays.room.camera.lost", "0", "0", "met"]);
        assert_eq!(words[4], ["rays.room.incoherent.lost", "1", "0", "MISSED"]);
        assert_eq!(words[5], ["search.k100.vs_kiddo", "2.000"]);
        assert_eq!(words[6], ["threads.search", "skipped", "1.85", "peer", "is", "missing"]);
        assert_eq!(words.len(), 7);
    }

    #[test]
    fn json_holds_ratios_alone() {
        let rows = [Row::new("threads.path", 1.9), Row::new("rays.room.camera.lost", 0.0)];
        assert_eq!(json(&rows), "{\n  \"threads.path\": 1.9\n}\n");
    }
}
