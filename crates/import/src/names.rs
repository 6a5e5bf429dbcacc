//! Names of what is described.

use std::collections::BTreeMap;

/// A name that is not taken: the wanted one, or that with a number.
pub(crate) fn free_name<T>(taken: &BTreeMap<String, T>, wanted: &str) -> String {
    if !wanted.is_empty() && !taken.contains_key(wanted) {
        return wanted.to_owned();
    }
    // As many names as there are keys cannot all be taken; numbers begin near where they end.
    let mut n = 2;
    let mut step = 1;
    let name = |n: usize| format!("{wanted}-{n}");
    while taken.contains_key(&name(n)) {
        n += step;
        step *= 2;
    }
    name(n)
}
