//! The last act of a program that panics: what must not go on is stopped before the panic is
//! reported as it was.

use std::panic;
use std::sync::{Arc, Mutex, MutexGuard, Once, PoisonError};

type Act = Arc<dyn Fn() + Send + Sync>;

static ACTS: Mutex<Vec<Act>> = Mutex::new(Vec::new());
static HOOK: Once = Once::new();

fn acts() -> MutexGuard<'static, Vec<Act>> {
    ACTS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// An act for the case of a panic; dropping it calls it off.
#[must_use = "dropping it calls the act off"]
pub struct OnPanic(Option<Act>);

impl std::fmt::Debug for OnPanic {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("OnPanic").finish_non_exhaustive()
    }
}

impl OnPanic {
    /// Does `act` whenever any thread of this process panics, on that thread and before the panic
    /// is reported, until what this returns is dropped.
    ///
    /// Several acts are done in the order in which they were asked for. An act must not panic, must
    /// not take what the panicking thread may hold, and should be done within a moment.
    pub fn new(act: impl Fn() + Send + Sync + 'static) -> Self {
        HOOK.call_once(|| {
            let report = panic::take_hook();
            panic::set_hook(Box::new(move |info| {
                // Not while the list is locked: an act may take its time.
                let due = acts().clone();
                for act in due {
                    act();
                }
                report(info);
            }));
        });
        let act: Act = Arc::new(act);
        acts().push(Arc::clone(&act));
        Self(Some(act))
    }

    /// Leaves the act to the rest of the process.
    pub fn for_good(mut self) {
        self.0 = None;
    }
}

impl Drop for OnPanic {
    fn drop(&mut self) {
        if let Some(act) = &self.0 {
            acts().retain(|other| !Arc::ptr_eq(other, act));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicU32, Ordering};

    #[test]
    fn acts_are_done_on_a_panic_until_they_are_called_off() {
        let count = Arc::new(AtomicU32::new(0));
        let add = |n: u32| {
            let count = Arc::clone(&count);
            OnPanic::new(move || {
                count.fetch_add(n, Ordering::SeqCst);
            })
        };
        let panics = || {
            let thread = std::thread::Builder::new().name("clumsy".to_owned());
            let spawned = thread.spawn(|| panic!("on purpose: any thread of the process"));
            assert!(spawned.unwrap().join().is_err());
        };
        let (one, ten) = (add(1), add(10));
        panics();
        assert_eq!(count.load(Ordering::SeqCst), 11);
        drop(one);
        ten.for_good();
        panics();
        assert_eq!(count.load(Ordering::SeqCst), 21);
    }
}
