//! Two service tools at once: an answer under way is for the one who asked.

mod bench;

use bench::Bench;
use xt28_dbc::Frame;

const ASK: [u32; 2] = [0x18DA_28F1, 0x18DA_28F2];
const ANSWER: [u32; 2] = [0x18DA_F128, 0x18DA_F228];
/// All codes that there are, an answer of many frames; tester present; go on without a pause.
const ALL_CODES: [u8; 3] = [2, 0x19, 0x0A];
const PRESENT: [u8; 3] = [2, 0x3E, 0];
const GO_ON: [u8; 3] = [0x30, 0, 0];

/// How many frames came for each of the two.
fn for_each(frames: &[Frame]) -> [usize; 2] {
    ANSWER.map(|id| frames.iter().filter(|frame| frame.id().raw() == id).count())
}

#[test]
fn an_answer_under_way_goes_to_who_asked() {
    let mut bench = Bench::new();
    bench.run(10);
    bench.offer(ASK[0], &ALL_CODES);
    assert_eq!(for_each(&bench.run(2)), [1, 0], "its first frame");
    for word in [&GO_ON, &PRESENT] {
        bench.offer(ASK[1], word);
        assert_eq!(for_each(&bench.run(5)), [0, 0], "the other is not heeded");
    }
    bench.offer(ASK[0], &GO_ON);
    let [asked, other] = for_each(&bench.run(50));
    assert!(asked > 20 && other == 0, "{asked} {other}");
    bench.offer(ASK[1], &PRESENT);
    assert_eq!(for_each(&bench.run(5)), [0, 1], "it is through");
}
