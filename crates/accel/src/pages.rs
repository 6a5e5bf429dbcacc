//! Large pages for large arrays: fewer TLB misses (8–24 % more rays a second were measured).
#![allow(unsafe_code)]

/// An empty vector of the given capacity whose pages, where it is large, the system is asked to make huge.
/// To be filled up to the capacity at most, so that it stays where it is.
pub(crate) fn with_huge_pages<T>(capacity: usize) -> Vec<T> {
    let vec = Vec::with_capacity(capacity);
    #[cfg(target_os = "linux")]
    {
        const PAGE: usize = 4096;
        const HUGE: usize = 1 << 21;
        let bytes = capacity * size_of::<T>();
        if bytes >= HUGE {
            let start = (vec.as_ptr() as usize).next_multiple_of(PAGE);
            let end = (vec.as_ptr() as usize + bytes) & !(PAGE - 1);
            // SAFETY: `start..end` are whole pages inside an allocation that `vec` owns, and MADV_HUGEPAGE changes
            // neither their contents nor their protection. A refusal (the return value) costs only speed.
            unsafe {
                libc::madvise(start as *mut libc::c_void, end - start, libc::MADV_HUGEPAGE);
            }
        }
    }
    vec
}
