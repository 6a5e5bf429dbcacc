use std::thread::JoinHandle;

/// Work on a thread of its own, beside the pools: for what waits for a disk, say, while others compute.
#[derive(Debug)]
pub struct Background<R>(JoinHandle<R>);

impl<R: Send + 'static> Background<R> {
    /// Starts the work.
    ///
    /// # Errors
    /// Where the system starts no thread; its reason. The work is then lost.
    pub fn start(work: impl FnOnce() -> R + Send + 'static) -> Result<Self, String> {
        let builder = std::thread::Builder::new().name("background".into());
        builder.spawn(work).map(Self).map_err(|e| e.to_string())
    }

    /// Whether the work is done.
    pub fn is_done(&self) -> bool {
        self.0.is_finished()
    }

    /// Waits for the result. A panic of the work goes on here.
    pub fn wait(self) -> R {
        self.0.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_result_comes_when_the_work_is_done() {
        let (send, receive) = std::sync::mpsc::channel::<u32>();
        let work = Background::start(move || receive.recv().unwrap() + 1).unwrap();
        assert!(!work.is_done());
        send.send(41).unwrap();
        assert_eq!(work.wait(), 42);
    }

    #[test]
    #[should_panic(expected = "planted")]
    fn a_panic_is_not_lost() {
        Background::start(|| panic!("planted")).unwrap().wait()
    }
}
