//! The same work on parts of an array, on several threads; the result does not depend on how many.

use std::num::NonZeroUsize;
use std::sync::Mutex;
use std::thread;

/// Threads that work is shared among when nobody says how many.
pub fn n_threads() -> usize {
    thread::available_parallelism().map_or(1, NonZeroUsize::get)
}

/// Does `work` on every piece of `len` values (the last may be shorter), on several threads.
///
/// Each gets its number and what `prepare` makes once a thread. No piece sees another, so that the
/// bytes are the same for any number of threads.
pub fn in_pieces<T: Send, S>(
    values: &mut [T],
    len: usize,
    n_threads: usize,
    prepare: impl Fn() -> S + Sync,
    work: impl Fn(&mut S, usize, &mut [T]) + Sync,
) {
    let n_threads = n_threads.clamp(1, values.len().div_ceil(len.max(1)).max(1));
    let pieces = Mutex::new(values.chunks_mut(len.max(1)).enumerate());
    let next = || pieces.lock().ok()?.next();
    let labour = || {
        let mut scratch = prepare();
        while let Some((number, piece)) = next() {
            work(&mut scratch, number, piece);
        }
    };
    thread::scope(|scope| {
        for _ in 1..n_threads {
            let named = thread::Builder::new().name("selvedge-pieces".to_owned());
            // Without a thread of its own its pieces are left for the others.
            drop(named.spawn_scoped(scope, labour));
        }
        labour();
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_piece_is_worked_on_once_whatever_the_number_of_threads() {
        for n in [0, 1, 2, 5] {
            let mut values: Vec<usize> = (0..23).collect();
            in_pieces(
                &mut values,
                4,
                n,
                Vec::<usize>::new,
                |seen, number, piece| {
                    seen.push(number);
                    for x in piece {
                        *x += 100 * number;
                    }
                },
            );
            let expected: Vec<usize> = (0..23).map(|i| i + 100 * (i / 4)).collect();
            assert_eq!(values, expected, "{n} threads");
        }
        in_pieces(&mut [0_u8; 0], 4, 3, || (), |(), _, _| {});
    }
}
