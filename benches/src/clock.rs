//! Clocks that other programs on the machine disturb as little as may be.

use std::collections::HashMap;
use std::ffi::OsString;
use std::fs;
use std::time::Instant;

use rustix::time::{ClockId, clock_gettime};

/// Runs `f`; seconds of processor time, user and system, of all threads of this process.
pub fn processor_s<R>(f: impl FnOnce() -> R) -> (f64, R) {
    let now = || {
        let t = clock_gettime(ClockId::ProcessCPUTime);
        t.tv_sec as f64 + t.tv_nsec as f64 * 1e-9
    };
    let start = now();
    let result = f();
    (now() - start, result)
}

/// A time by the wall clock.
#[derive(Clone, Copy, Debug)]
pub struct Spell {
    /// Seconds, less those in which threads were ready and other programs had the processors.
    pub undisturbed_s: f64,
    /// Seconds as they passed.
    pub elapsed_s: f64,
}

/// Runs `f`, which keeps `threads` threads of this process busy. What others took is known on Linux; elsewhere
/// nothing is taken off.
///
/// Of each thread, time = running + waiting + idle; with the waiting gone, all threads together would be done
/// earlier by its mean. The threads must live before and after `f`.
pub fn spell(threads: usize, f: impl FnOnce()) -> Spell {
    let (waited, start) = (waited_s(), Instant::now());
    f();
    let elapsed_s = start.elapsed().as_secs_f64();
    // Threads of an earlier pool may end meanwhile: only those that are there before and after count.
    let since = |(thread, now): (OsString, f64)| waited.get(&thread).map(|before| now - before);
    let waited: f64 = waited_s().into_iter().filter_map(since).sum();
    Spell { undisturbed_s: elapsed_s - waited / threads as f64, elapsed_s }
}

/// Of each thread of this process, the seconds that it has been ready to run and did not, since it started.
fn waited_s() -> HashMap<OsString, f64> {
    let Ok(tasks) = fs::read_dir("/proc/self/task") else { return HashMap::new() };
    let waited = |task: fs::DirEntry| {
        let text = fs::read_to_string(task.path().join("schedstat")).ok()?;
        let ns: f64 = text.split_whitespace().nth(1)?.parse().ok()?;
        Some((task.file_name(), ns * 1e-9))
    };
    tasks.filter_map(|task| waited(task.ok()?)).collect()
}

/// The middle one; NaN of none.
pub fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_is_the_middle_one() {
        assert_eq!(median(&[5.0, 1.0, 3.0]), 3.0);
        assert!(median(&[]).is_nan());
    }

    #[test]
    fn processor_time_passes_with_work_and_not_with_sleep() {
        let nap = std::time::Duration::from_millis(30);
        let (asleep, ()) = processor_s(|| std::thread::sleep(nap));
        let (awake, ()) = processor_s(|| {
            let start = Instant::now();
            while start.elapsed() < 3 * nap {
                std::hint::spin_loop();
            }
        });
        assert!(asleep < 0.03, "{asleep}");
        assert!(awake > 0.0, "{awake}");
        let Spell { undisturbed_s, elapsed_s } = spell(1, || std::thread::sleep(nap));
        assert!(elapsed_s >= 0.03 && undisturbed_s <= elapsed_s);
    }
}
