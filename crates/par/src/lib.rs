//! The only threads. Work is cut into fixed-size chunks of indices, never by thread count, and results come back
//! in index order: a caller cannot observe the schedule. There is no parallel floating-point reduction here.

mod background;

use std::ops::Range;

pub use background::Background;
use rayon::prelude::*;

/// A pool of worker threads.
#[derive(Debug)]
pub struct Workers {
    pool: rayon::ThreadPool,
}

impl Workers {
    /// A pool of `threads` (0: one for each core).
    ///
    /// # Errors
    /// Where the system refuses to start a thread.
    pub fn new(threads: usize) -> Result<Self, String> {
        rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .thread_name(|i| format!("worker-{i}"))
            .build()
            .map(|pool| Self { pool })
            .map_err(|e| e.to_string())
    }

    /// Number of threads.
    pub fn threads(&self) -> usize {
        self.pool.current_num_threads()
    }

    /// Runs `f` on the pool, where [`map_chunks`], [`join`] and [`map`] use its threads.
    pub fn run<R: Send>(&self, f: impl FnOnce() -> R + Send) -> R {
        self.pool.install(f)
    }
}

/// `f` over `0..len` in chunks of `chunk` indices (the last may be shorter); results in index order.
/// Runs on the pool of the enclosing [`Workers::run`].
pub fn map_chunks<R: Send>(len: usize, chunk: usize, f: impl Fn(Range<usize>) -> R + Sync) -> Vec<R> {
    let chunk = chunk.max(1);
    (0..len.div_ceil(chunk)).into_par_iter().map(|i| f(i * chunk..((i + 1) * chunk).min(len))).collect()
}

/// `f` over the indices `0..len`, one task each; results in index order.
pub fn map<R: Send>(len: usize, f: impl Fn(usize) -> R + Sync) -> Vec<R> {
    (0..len).into_par_iter().map(&f).collect()
}

/// `f` over the pieces of `out` of `chunk` elements (the last may be shorter), each with its number.
pub fn fill_chunks<T: Send>(out: &mut [T], chunk: usize, f: impl Fn(usize, &mut [T]) + Sync) {
    out.par_chunks_mut(chunk.max(1)).enumerate().for_each(|(i, piece)| f(i, piece));
}

/// Both closures, at once where a thread is free.
pub fn join<A: Send, B: Send>(a: impl FnOnce() -> A + Send, b: impl FnOnce() -> B + Send) -> (A, B) {
    rayon::join(a, b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn order_does_not_depend_on_threads() {
        let expected: Vec<_> = (0..1003).map(|i| i * i).collect();
        for threads in [1, 2, 3, 7] {
            let workers = Workers::new(threads).unwrap();
            let mut filled = vec![0; expected.len()];
            workers.run(|| {
                fill_chunks(&mut filled, 10, |i, piece| {
                    for (k, x) in piece.iter_mut().enumerate() {
                        *x = (i * 10 + k).pow(2);
                    }
                });
            });
            assert_eq!(filled, expected);
            let chunks = workers.run(|| map_chunks(1003, 10, |r| r.map(|i| i * i).collect::<Vec<_>>()));
            assert_eq!(chunks.concat(), expected);
            assert_eq!(workers.run(|| map(1003, |i| i * i)), expected);
        }
    }
}
