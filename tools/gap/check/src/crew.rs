//! Many cases on all cores, a case a core.
//!
//! A diagnosis is parallel inside, on the thread pool that it finds. In one pool for all, a thread
//! that waits inside one case would take up another, and no case's time would be its own. So each
//! worker has a pool to itself.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::ThreadPoolBuilder;

/// `work` on every item, results in the order of items. Where there are more cores than items, the
/// spare cores go to the work inside.
///
/// # Panics
/// Where `work` does, and where the system gives no threads.
pub(crate) fn each<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let cores = rayon::current_num_threads();
    let workers = cores.min(items.len()).max(1);
    let next = AtomicUsize::new(0);
    let done: Vec<Mutex<Option<R>>> = items.iter().map(|_| Mutex::new(None)).collect();
    let worker = || {
        let pool = ThreadPoolBuilder::new().num_threads(cores / workers).build();
        let pool = pool.expect("the system gives a thread a core");
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(item) = items.get(index) else { break };
            let result = pool.install(|| work(item));
            *done[index].lock().expect("a worker that panicked ends the scope") = Some(result);
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..workers {
            scope.spawn(worker);
        }
    });
    let take = |slot: Mutex<Option<R>>| slot.into_inner().ok().flatten();
    done.into_iter().map(|slot| take(slot).expect("every item was worked on")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_item_once_and_in_order() {
        let items: Vec<u64> = (0..100).collect();
        assert_eq!(each(&items, |i| i * i), items.iter().map(|i| i * i).collect::<Vec<_>>());
        assert!(each(&[] as &[u64], |i| *i).is_empty());
    }
}
