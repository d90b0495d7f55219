//! CPU time of the calling thread, so that a cost can be told apart from a busy machine.
//!
//! Where the system has no such clock the wall clock stands in.

/// CPU time that the calling thread has used, s, from an arbitrary origin.
#[cfg(unix)]
pub fn thread_cpu_seconds() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}

/// Wall time, s, from an arbitrary origin: this system has no clock of a thread's CPU time.
#[cfg(not(unix))]
pub fn thread_cpu_seconds() -> f64 {
    use std::sync::OnceLock;
    use std::time::Instant;

    static ORIGIN: OnceLock<Instant> = OnceLock::new();
    ORIGIN.get_or_init(Instant::now).elapsed().as_secs_f64()
}
