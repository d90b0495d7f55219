//! The same work for many textiles, on several threads; what comes out does not depend on how
//! many.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread;

use crate::error::TextileError;
use selvedge_foundation::progress::Progress;

/// Does `work` for every id and returns the results in the order of the ids.
///
/// # Errors
/// Of the ids that failed, the error of the first in order that was reached; cancelling.
pub(crate) fn for_each<T: Send>(
    ids: &[String],
    n_threads: usize,
    progress: &mut Progress<'_>,
    work: impl Fn(&str) -> Result<T, TextileError> + Sync,
) -> Result<Vec<T>, TextileError> {
    let n = ids.len().max(1) as f64;
    let n_threads = n_threads.min(ids.len());
    let mut done: Vec<Option<Result<T, TextileError>>> = ids.iter().map(|_| None).collect();
    let next = AtomicUsize::new(0);
    let is_over = AtomicBool::new(false);
    let labour = |out: &SyncSender<(usize, Result<T, TextileError>)>| {
        while !is_over.load(Ordering::Relaxed) {
            let i = next.fetch_add(1, Ordering::Relaxed);
            let Some(id) = ids.get(i) else { break };
            let result = work(id);
            // Once something failed, what lies behind it in order is of no use.
            is_over.fetch_or(result.is_err(), Ordering::Relaxed);
            if out.send((i, result)).is_err() {
                break;
            }
        }
    };
    let heard = thread::scope(|scope| {
        let (out, results) = sync_channel(n_threads.max(1));
        let mut n_started = 0;
        for _ in 0..n_threads {
            let out = out.clone();
            let named = thread::Builder::new().name("selvedge-textiles".to_owned());
            let started = named.spawn_scoped(scope, move || labour(&out));
            n_started += usize::from(started.is_ok());
        }
        drop(out);
        let mut n_done = 0;
        let mut heard = Ok(());
        // Without a single thread the ids are left for this one, below.
        while n_started > 0
            && let Ok((i, result)) = results.recv()
        {
            n_done += 1;
            done[i] = Some(result);
            if heard.is_ok() {
                heard = progress.step(f64::from(n_done) / n, &ids[i]);
                is_over.fetch_or(heard.is_err(), Ordering::Relaxed);
            }
        }
        heard
    });
    heard?;
    let mut all = Vec::with_capacity(ids.len());
    for (id, result) in ids.iter().zip(done) {
        all.push(match result {
            Some(result) => result?,
            None => work(id)?,
        });
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_foundation::progress::{CancelFlag, Progress};

    fn ids(n: usize) -> Vec<String> {
        (0..n).map(|i| i.to_string()).collect()
    }

    #[test]
    fn results_come_in_order_whatever_the_number_of_threads() {
        let double = |id: &str| Ok(2 * id.parse::<usize>().unwrap());
        for n_threads in [0, 1, 2, 7] {
            let all = Progress::unheard(|p| for_each(&ids(20), n_threads, p, double)).unwrap();
            assert_eq!(all, (0..20).map(|i| 2 * i).collect::<Vec<_>>());
        }
        let none = Progress::unheard(|p| for_each(&[], 2, p, double)).unwrap();
        assert!(none.is_empty());
    }

    #[test]
    fn a_failure_and_a_raised_flag_end_the_work() {
        let failed = |id: &str| {
            Err::<(), _>(TextileError::Unknown {
                id: id.to_owned(),
                library: String::new(),
                known: String::new(),
            })
        };
        let error = Progress::unheard(|p| for_each(&ids(5), 2, p, failed)).unwrap_err();
        assert!(error.to_string().contains("\"0\""), "{error}");
        let flag = CancelFlag::new();
        flag.cancel();
        let mut nobody = |_: f64, _: &str| {};
        let mut progress = Progress::new(&mut nobody, flag);
        let error = for_each(&ids(50), 2, &mut progress, |_| Ok(())).unwrap_err();
        assert!(matches!(error, TextileError::Cancelled(_)), "{error}");
    }
}
