//! What a drive is forecast to tell is what it tells: driven with each of the rivals, and weighed again.

use toml::Table;
use xt28_gap::diagnosis::{
    Cause, Diagnosis, Estimate, Evidence, FieldRun, Fit, Hypothesis, Inquiry, Knob, Manoeuvre,
    Onset, Signals, Verdict, next_drive,
};
use xt28_machine::Machine;
use xt28_sim::Effects;
use xt28_sim::effects::{Scope, find};

mod own_logs;

use own_logs::{Command, SETTLE, read, text_of};

/// The commands of a scripted drive, as its own script says them.
fn commands(manoeuvre: &Manoeuvre) -> impl Fn(u64) -> Command {
    let script: Table = manoeuvre.script().parse().unwrap();
    let number =
        |value: &toml::Value| value.as_float().or(value.as_integer().map(|n| n as f64)).unwrap();
    let step = |step: &toml::Value| {
        let strokes: Vec<f64> = step["stroke_mm"].as_array().unwrap().iter().map(number).collect();
        let command = (
            strokes.try_into().unwrap(),
            number(&step["throttle_percent"]),
            number(&step["front_angle_deg"]),
        );
        (number(&step["at_s"]), command)
    };
    let steps: Vec<(f64, Command)> =
        script["command"].as_array().unwrap().iter().map(step).collect();
    move |tick| {
        let s = tick.saturating_sub(SETTLE) as f64 * 0.01;
        steps.iter().rev().find(|(at_s, _)| *at_s <= s).unwrap_or(&steps[0]).1
    }
}

/// One run of the machine with `effects` on a scripted drive.
fn driven(name: &str, effects: &Effects) -> FieldRun {
    let manoeuvre = Manoeuvre::find(name).unwrap();
    let ticks = (manoeuvre.end_s * 100.0) as u64;
    read(name, &text_of(&commands(&manoeuvre), ticks, effects), true)
}

/// Both hypotheses at their best on these runs.
fn fits(runs: Vec<FieldRun>, rivals: [(Hypothesis, f64); 2]) -> ([Fit; 2], Inquiry) {
    let inquiry = Inquiry::new(Machine::xt28(), runs);
    let signals: Vec<Signals> = inquiry.runs.iter().map(|run| run.signals.clone()).collect();
    let knobs = Knob::of(&inquiry.catalogue);
    let evidence = Evidence::new(&signals, &inquiry.machine, Effects::default(), &knobs);
    (rivals.map(|(rival, from)| rival.refit(&evidence, Onset::ALWAYS, &[from])), inquiry)
}

fn cause(fit: &Fit, probability: f64) -> Cause {
    let Hypothesis { effect, scope } = fit.hypothesis;
    Cause {
        effect,
        scope,
        scopes: Vec::new(),
        values: Vec::new(),
        probability,
        parameters: vec![Estimate { name: effect.parameters[0].name, value: [fit.values[0]; 3] }],
        class: vec![effect.name],
        begins: None,
        shrink: None,
    }
}

/// A late valve or a slow one, of a machine whose arms have hardly been moved.
#[test]
fn a_drive_gives_what_it_was_forecast_to_give() {
    let rivals = ["arm-delay", "valve-lag"]
        .map(|name| (Hypothesis { effect: find(name).unwrap(), scope: Scope::All }, 0.1));
    let truth = |k: usize, fits: &[Fit; 2]| {
        let Fit { hypothesis, values, .. } = &fits[k];
        hypothesis.applied(&Effects::default(), values)
    };
    let late = rivals[0].0.applied(&Effects::default(), &[0.1]);
    let first = || driven("straight", &late);
    let (before, inquiry) = fits(vec![first()], rivals);
    let causes = vec![cause(&before[0], 0.6), cause(&before[1], 0.39)];
    let diagnosis = Diagnosis::of(Verdict::Effect, causes);
    let (next, manoeuvre) = next_drive(&inquiry, &diagnosis).unwrap().unwrap();
    let forecast = next.nats.unwrap();
    let gave = [0, 1].map(|k| {
        let (after, _) = fits(vec![first(), driven(manoeuvre.name, &truth(k, &before))], rivals);
        let apart = |fits: &[Fit; 2]| fits[k].log_evidence - fits[1 - k].log_evidence;
        apart(&after) - apart(&before)
    });
    let least = gave[0].min(gave[1]);
    assert!(least > 0.5 * forecast && least < 2.0 * forecast, "{forecast} nats, gave {gave:?}");
}
