//! The examination: answers sealed, every case diagnosed, the seal opened, the replies judged.

use rand::{RngCore, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::Serialize;
use xt28_gap::diagnosis::{Diagnosis, Shrink};
use xt28_gap_plants::Seal;

use crate::CheckError;
use crate::baselines::BASELINES;
use crate::crew;
use crate::oracle::oracle;
use crate::reply::Reply;
use crate::source::Source;
use crate::truth::Truth;

/// What is done with every case.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// Whether to say how far the gap shrinks: most of the work.
    pub how_far: bool,
    /// Whether the plain rules reply too.
    pub baselines: bool,
}

/// Cases with their answers sealed.
pub struct Examination {
    sources: Vec<Source>,
    salt: [u8; 32],
    seal: Seal,
}

/// One case diagnosed, before anyone has seen its answer.
#[derive(Clone, Debug)]
pub struct Examined {
    /// Name of the case.
    pub case: String,
    /// What the diagnosis says.
    pub diagnosis: Diagnosis,
    /// The same in the form that is scored, first; then the plain rules', in the order of
    /// [`BASELINES`].
    pub replies: Vec<Reply>,
    /// Time that the diagnosis took, s; on one core where there are as many cases as cores.
    pub seconds: f64,
}

/// One case that nobody could diagnose: it is in no score.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Refused {
    /// Name of the case.
    pub case: String,
    /// What is wrong with its logs, and what to do.
    pub why: String,
}

/// One case with its answer.
#[derive(Clone, Debug)]
pub struct Judged {
    /// What was said.
    pub examined: Examined,
    /// What is so.
    pub truth: Truth,
    /// How far the gap shrinks for who knows the truth, where that was asked.
    pub oracle: Option<Shrink>,
}

/// Reads the wall clock, s from any instant: for who may.
pub type Clock<'a> = &'a (dyn Fn() -> f64 + Sync);

impl Examination {
    /// Seals the answers of `sources`, with a salt from `seed`.
    ///
    /// The salt is public once the seal is opened, so that anyone can open it again. It comes from the
    /// seed so that an examination can be repeated to the bit: what the seal proves is that nobody
    /// changed an answer after having seen a diagnosis.
    ///
    /// # Errors
    /// [`CheckError::Read`]; [`CheckError::Answer`] for what is no answer, or that of another case: it
    /// is better said now than after hours of diagnosis.
    pub fn sealed(sources: Vec<Source>, seed: u64) -> Result<Self, CheckError> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        random.set_stream(1);
        let mut salt = [0; 32];
        random.fill_bytes(&mut salt);
        let texts = texts(&sources)?;
        for (source, text) in sources.iter().zip(&texts) {
            truth(source, text)?;
        }
        let seal = Seal::on(&salt, texts.iter().map(String::as_str));
        Ok(Self { sources, salt, seal })
    }

    /// The seal on all answers, in the order of cases.
    #[must_use]
    pub fn seal(&self) -> Seal {
        self.seal
    }

    /// What opens the seal, as hexadecimal digits.
    #[must_use]
    pub fn salt(&self) -> String {
        self.salt.iter().map(|byte| format!("{byte:02x}")).collect()
    }

    /// Number of cases.
    #[must_use]
    pub fn len(&self) -> usize {
        self.sources.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.sources.is_empty()
    }

    /// Diagnoses every case on all cores, and says which could not be, as their logs cannot be made or read.
    /// `told` hears of each that is done, from any thread.
    #[must_use]
    pub fn examine(
        &self,
        options: Options,
        clock: Clock<'_>,
        told: &(dyn Fn(&Examined) + Sync),
    ) -> (Vec<Examined>, Vec<Refused>) {
        let one = |source: &Source| {
            let examined = examine(source, options, clock)
                .map_err(|error| Refused { case: source.name(), why: error.to_string() })?;
            told(&examined);
            Ok(examined)
        };
        let (mut examined, mut refused) = (Vec::new(), Vec::new());
        for case in crew::each(&self.sources, one) {
            match case {
                Ok(case) => examined.push(case),
                Err(case) => refused.push(case),
            }
        }
        (examined, refused)
    }

    /// Reads the answers again and opens the seal.
    ///
    /// # Errors
    /// [`CheckError::SealBroken`] if they are not those that were sealed.
    pub fn open(&self, examined: Vec<Examined>) -> Result<Vec<Judged>, CheckError> {
        let texts = texts(&self.sources)?;
        if !self.seal.holds(&self.salt, texts.iter().map(String::as_str)) {
            return Err(CheckError::SealBroken { seal: self.seal.to_string() });
        }
        // Cases that were refused are not there.
        let mut examined = examined.into_iter().peekable();
        let mut judged = Vec::new();
        for (source, text) in self.sources.iter().zip(&texts) {
            if let Some(examined) = examined.next_if(|examined| examined.case == source.name()) {
                judged.push(Judged { truth: truth(source, text)?, examined, oracle: None });
            }
        }
        Ok(judged)
    }

    /// The same cases with how far the gap shrinks for who knows their truth; on all cores.
    ///
    /// # Errors
    /// [`CheckError`] of the first case whose logs cannot be made, read or replayed.
    pub fn with_oracle(&self, judged: Vec<Judged>) -> Result<Vec<Judged>, CheckError> {
        let one = |judged: &Judged| {
            let case = &judged.examined.case;
            let source = self.sources.iter().find(|source| source.name() == *case);
            let oracle = source.map(|source| oracle(source, &judged.truth)).transpose()?;
            Ok(Judged { oracle: oracle.flatten(), ..judged.clone() })
        };
        crew::each(&judged, one).into_iter().collect()
    }
}

/// The truth about a case, which must be about that case.
fn truth(source: &Source, text: &str) -> Result<Truth, CheckError> {
    let (path, case) = (source.answer_path(), source.name());
    let truth = Truth::parse(text, &path)?;
    if truth.case == case {
        return Ok(truth);
    }
    let problem =
        format!("case = \"{}\" is not the answer of {case}; give each its own", truth.case);
    Err(CheckError::Answer { path, line: 1, problem })
}

/// The truth about a case, for who may know it.
pub(crate) fn truth_of(source: &Source) -> Result<Truth, CheckError> {
    truth(source, &source.answer_text()?)
}

fn texts(sources: &[Source]) -> Result<Vec<String>, CheckError> {
    sources.iter().map(Source::answer_text).collect()
}

fn examine(source: &Source, options: Options, clock: Clock<'_>) -> Result<Examined, CheckError> {
    let mut inquiry = source.inquiry()?;
    inquiry.how_far = options.how_far;
    let began = clock();
    let diagnosis = inquiry.diagnose(&|_| ());
    let seconds = clock() - began;
    let mut replies = vec![Reply::from(&diagnosis)];
    if options.baselines {
        replies.extend(BASELINES.iter().map(|baseline| baseline.reply(&inquiry)));
    }
    Ok(Examined { case: source.name(), diagnosis, replies, seconds })
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn a_changed_answer_breaks_the_seal_and_a_strange_one_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let answer = folder.path().join("one.toml");
        fs::write(&answer, "case = \"one\"\nkind = \"null\"\n").unwrap();
        let source = Source::Folder { folder: folder.path().join("one"), answer: answer.clone() };
        let sealed = Examination::sealed(vec![source], 1).unwrap();
        assert!(sealed.open(Vec::new()).is_ok());
        assert_eq!(Seal::parse(&sealed.seal().to_string()), Some(sealed.seal()));
        let unknown = "case = \"one\"\nkind = \"unknown\"\n[[truth]]\neffect = \"x\"\n";
        fs::write(&answer, unknown).unwrap();
        let error = sealed.open(Vec::new()).unwrap_err().to_string();
        assert!(error.contains("the seal is broken"), "{error}");
        assert!(error.contains(&sealed.seal().to_string()), "{error}");
        fs::write(&answer, "case = \"one\"\nkind = \"null\"\n").unwrap();
        assert!(sealed.open(Vec::new()).is_ok());
        fs::write(&answer, "case = \"two\"\nkind = \"null\"\n").unwrap();
        let source = Source::Folder { folder: folder.path().join("one"), answer };
        let error = Examination::sealed(vec![source], 1).err().unwrap().to_string();
        assert!(error.contains("case = \"two\" is not the answer of one"), "{error}");
    }
}
