//! One picture of a run: the path from above, and strokes, loads, attitude and drive over time.

mod chart;
mod ground;
mod palette;
mod plan;
mod scale;
mod svg;

use chart::{Chart, Curve};
use svg::{Anchor, Svg};
use xt28_machine::{Machine, PerWheel, Wheel};

use crate::trace::DriveCommand;
use crate::{Finding, Scenario, Series, Trace};

/// Everything a picture shows.
#[derive(Clone, Copy, Debug)]
pub struct Picture<'a> {
    /// The scenario that ran.
    pub scenario: &'a Scenario,
    /// The seed it ran with.
    pub seed: u64,
    /// The machine it ran on.
    pub machine: &'a Machine,
    /// What the bus said.
    pub trace: &'a Trace,
    /// What was found.
    pub findings: &'a [Finding],
}

const WIDTH: f64 = 1200.0;
const MARGIN: f64 = 34.0;
const HEAD: f64 = 104.0;
const GAP: f64 = 30.0;
const CHART_HEIGHT: f64 = 262.0;

impl Picture<'_> {
    /// The picture as SVG text. The same run gives the same text.
    #[must_use]
    pub fn svg(&self) -> String {
        let plan = plan::Plan::new(self, WIDTH - 2.0 * MARGIN);
        let charts_y = HEAD + plan.height() + GAP;
        let height = charts_y + 2.0 * CHART_HEIGHT + GAP + MARGIN * 0.6;
        let mut svg = Svg::new(WIDTH, height);
        self.head(&mut svg);
        plan.draw(&mut svg, MARGIN, HEAD);
        let width = (WIDTH - 2.0 * MARGIN - GAP) / 2.0;
        let (left, right) = (MARGIN, MARGIN + width + GAP);
        let (upper, lower) = (charts_y, charts_y + CHART_HEIGHT + GAP);
        let (half, lowest) = (CHART_HEIGHT / 2.0, lower + CHART_HEIGHT / 2.0);
        self.strokes().draw(&mut svg, [left, upper], [width, CHART_HEIGHT]);
        self.loads().draw(&mut svg, [right, upper], [width, CHART_HEIGHT]);
        self.events(&mut svg, [left, upper], width);
        self.attitude().draw(&mut svg, [left, lower], [width, CHART_HEIGHT]);
        self.joints().draw(&mut svg, [right, lower], [width, half]);
        self.speed().draw(&mut svg, [right, lowest], [width, half]);
        svg.finish()
    }

    fn head(&self, svg: &mut Svg) {
        let s = self.scenario;
        svg.text([MARGIN, 46.0], "title", Anchor::Start, &s.title);
        let passed = self.findings.iter().filter(|finding| finding.passed()).count();
        let ground = &s.terrain;
        // A script is named after its scenario: its name says nothing more, and takes the line's room.
        let policy = s.policy.split_once(':').map_or(s.policy.as_str(), |(kind, rest)| {
            if kind == "script" || rest.is_empty() { kind } else { &s.policy }
        });
        let line = format!(
            "{} · {policy} · {ground} · seed {} · {} s · {passed} of {} expectations hold",
            s.name,
            self.seed,
            s.duration_s,
            self.findings.len()
        );
        svg.text([MARGIN, 76.0], "sub", Anchor::Start, &line);
        wheel_legend(svg, [WIDTH - MARGIN - 252.0, 24.0]);
    }

    /// Names the events above the first chart; the lines are in every chart.
    fn events(&self, svg: &mut Svg, at: [f64; 2], width: f64) {
        let time = chart::time_scale(self.scenario.duration_s, at[0], width);
        for event in &self.scenario.events {
            let what = event.what.to_string();
            svg.text([time.pixel(event.at_s), at[1] + 35.0], "tick", Anchor::Middle, &what);
        }
    }

    fn strokes(&self) -> Chart<'_> {
        let targets = Wheel::ALL.map(|wheel| {
            let target = move |v: &PerWheel<Option<f64>>| v[wheel].unwrap_or(f64::NAN);
            Curve::of(&self.trace.stroke_target_m, "", palette::of(wheel), target).dashed()
        });
        let strokes = per_wheel(&self.trace.stroke_m, 1.0);
        let curves = targets.into_iter().chain(strokes).collect();
        self.chart("Strokes (dashed: targets), m", [0.0, 0.25], curves)
    }

    fn loads(&self) -> Chart<'_> {
        let curves = per_wheel(&self.trace.cylinder_load_n, KN_PER_N).into();
        self.chart("Cylinder loads, kN", [0.0, 50.0], curves)
    }

    fn attitude(&self) -> Chart<'_> {
        let attitude = &self.trace.attitude;
        let curves = vec![
            Curve::of(attitude, "roll", palette::ROLL, |a| a.roll_rad.to_degrees()),
            Curve::of(attitude, "pitch", palette::PITCH, |a| a.pitch_rad.to_degrees()),
        ];
        self.chart("Roll and pitch, deg", [-1.0, 1.0], curves)
    }

    fn joints(&self) -> Chart<'_> {
        let t = self.trace;
        let target = |d: &DriveCommand| d.front_joint_rad.to_degrees();
        let curves = vec![
            Curve::of(&t.drive_target, "", palette::FRONT, target).dashed(),
            Curve::of(&t.joint_rad, "front", palette::FRONT, |j| j[0].to_degrees()),
            Curve::of(&t.joint_rad, "rear", palette::REAR, |j| j[1].to_degrees()),
        ];
        self.chart("Articulation, deg", [-2.0, 2.0], curves)
    }

    fn speed(&self) -> Chart<'_> {
        let t = self.trace;
        let Machine { drive, wheels, .. } = self.machine;
        let target = |d: &DriveCommand| d.throttle * drive.speed_full_m_s;
        let curves = vec![
            Curve::of(&t.drive_target, "", palette::SPEED, target).dashed(),
            Curve::of(&t.wheel_speed_rad_s, "wheels", palette::SPEED, |w| {
                w.mean() * wheels.radius_m
            }),
        ];
        self.chart("Speed, m/s", [0.0, 0.5], curves)
    }

    fn chart<'b>(&self, title: &'b str, least: [f64; 2], curves: Vec<Curve<'b>>) -> Chart<'b> {
        let Scenario { duration_s, events, .. } = self.scenario;
        let events_s = events.iter().map(|event| event.at_s).collect();
        Chart { title, duration_s: *duration_s, least, curves, events_s }
    }
}

const KN_PER_N: f64 = 1e-3;

fn per_wheel(series: &Series<PerWheel<f64>>, factor: f64) -> [Curve<'static>; 6] {
    Wheel::ALL.map(|wheel| {
        Curve::of(series, "", palette::of(wheel), |v: &PerWheel<f64>| v[wheel] * factor)
    })
}

/// The six wheel colours, laid out as the wheels are, nose to the right.
fn wheel_legend(svg: &mut Svg, [x, y]: [f64; 2]) {
    let columns = [[Wheel::Bl, Wheel::Br], [Wheel::Ml, Wheel::Mr], [Wheel::Fl, Wheel::Fr]];
    for (column, pair) in columns.into_iter().enumerate() {
        for (row, wheel) in pair.into_iter().enumerate() {
            #[allow(clippy::cast_precision_loss)] // below 3
            let at = [x + 78.0 * column as f64, y + 32.0 * row as f64];
            svg.rect(at, [34.0, 16.0], &format!("fill=\"{}\" rx=\"4\"", palette::of(wheel)));
            svg.text([at[0] + 40.0, at[1] + 13.5], "key", Anchor::Start, wheel.name());
        }
    }
    let (nose, middle) = (x + 240.0, y + 24.0);
    svg.polygon(
        &[[nose, middle - 7.0], [nose + 12.0, middle], [nose, middle + 7.0]],
        "fill=\"#888\"",
    );
}
