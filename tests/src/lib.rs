//! Closed-loop scenarios: what to run, what must hold, and the runner.
