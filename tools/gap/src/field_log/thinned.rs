//! Whether all messages of a log lack as many frames alike, whoever sent them: then it was no node that lost them, but
//! the bus, or who wrote the log.

/// A log with fewer messages than this has not all senders in it.
const MESSAGES_MIN: usize = 10;
/// Frames that must be missing of a message before it says how many are.
const LOST_MIN: f64 = 5.0;
/// Share of the frames that is worth a word.
const SHARE_MIN: f64 = 0.005;
/// How many standard deviations of chance the loss of one message may be from that of all.
const CHANCE: f64 = 4.0;

/// Whether frames of all messages are missing alike; each message by how many of its frames are, and of how many.
#[allow(clippy::cast_precision_loss)]
pub(super) fn is_thinned(messages: &[[u64; 2]]) -> bool {
    let sum = |k: usize| messages.iter().map(|message| message[k]).sum::<u64>() as f64;
    let share = sum(0) / sum(1).max(1.0);
    let telling = messages.iter().map(|[lost, due]| (*lost as f64, share * *due as f64));
    let telling: Vec<(f64, f64)> = telling.filter(|(_, expected)| *expected >= LOST_MIN).collect();
    let alike = |(lost, expected): &(f64, f64)| (lost - expected).abs() <= CHANCE * expected.sqrt();
    share >= SHARE_MIN && telling.len() >= MESSAGES_MIN && telling.iter().all(alike)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(lost: [u64; 12]) -> bool {
        // The last two come eight times a second, as a receiver's.
        let due = |k: usize| if k < 10 { 3000 } else { 240 };
        let messages: Vec<_> =
            lost.into_iter().enumerate().map(|(k, lost)| [lost, due(k)]).collect();
        is_thinned(&messages)
    }

    #[test]
    fn a_loss_that_all_share_is_no_nodes() {
        assert!(of([150, 141, 163, 155, 139, 150, 158, 144, 149, 152, 9, 14]));
    }

    #[test]
    fn a_loss_of_one_sender_or_none_is_not() {
        assert!(!of([150, 150, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]), "commands");
        assert!(!of([150, 150, 150, 150, 150, 150, 150, 150, 10, 12, 11, 10]), "one node");
        assert!(!of([0; 12]));
        assert!(!of([1, 0, 2, 1, 0, 1, 1, 0, 1, 1, 0, 0]), "hardly any");
        assert!(!is_thinned(&[[150, 3000]; 3]), "too few say so");
    }
}
