//! Radii over passes: the schedule of Knaus and Zwicker (2011).

use super::plot::Plot;
use super::svg::{CAMERA, Canvas, FAINT, GREEN, INK, Ink, LABEL, LIGHT, VIOLET};

const DECADES: usize = 5;

/// Radius over that of the first pass, for passes 1 to 10^[`DECADES`]: r²ᵢ₊₁ = r²ᵢ·(i + α)/(i + 1).
fn radii(alpha: f64) -> Vec<f64> {
    let mut square = 1.0;
    let mut radii = vec![1.0];
    for i in 1..10usize.pow(DECADES as u32) {
        square *= (i as f64 + alpha) / (i as f64 + 1.0);
        radii.push(f64::sqrt(square));
    }
    radii
}

pub fn draw() -> Canvas {
    let mut canvas = Canvas::new([760.0, 352.0], "Radii over passes");
    canvas.text([24.0, 34.0], "Radius over that of the first pass", LABEL.bold());
    let bottom = 0.05f64;
    let plot = Plot {
        origin: [70.0, 300.0],
        size: [380.0, 240.0],
        x: [0.0, DECADES as f64],
        y: [bottom.log10(), 0.0],
    };
    let x_ticks = [(0.0, "1"), (1.0, "10"), (2.0, "100"), (3.0, "10³"), (4.0, "10⁴"), (5.0, "10⁵")];
    let y_ticks = [(1.0, "1"), (0.5, "0.5"), (0.2, "0.2"), (0.1, "0.1"), (0.05, "0.05")];
    plot.axes(&mut canvas, &x_ticks, &y_ticks.map(|(y, label)| (f64::log10(y), label)));
    canvas.text([260.0, 340.0], "pass i", LABEL.middle());
    for (alpha, label, color) in [
        (1.0, "α = 1", FAINT),
        (0.8, "α = 0.8", GREEN),
        (2.0 / 3.0, "α = ⅔, the default", LIGHT),
        (0.5, "α = ½", VIOLET),
    ] {
        let radii = radii(alpha);
        // Straight between passes, on both axes of the plot.
        let at = |x: f64| {
            let pass = (10f64.powf(x) as usize).clamp(1, radii.len() - 1);
            let [from, to] = [pass, pass + 1].map(|i| ((i as f64).log10(), radii[i - 1].log10()));
            from.1 + (to.1 - from.1) * (x - from.0) / (to.0 - from.0)
        };
        plot.curve(&mut canvas, 100, Ink::line(color).wide(if color == LIGHT { 3.0 } else { 2.0 }), at);
        let [x, y] = plot.at(5.0, at(5.0));
        canvas.text([x + 6.0, y + 5.0], label, LABEL.color(color));
    }
    // The discs of the default, to scale.
    let radii = radii(2.0 / 3.0);
    canvas.text([590.0, 34.0], "Discs, α = ⅔", LABEL.bold());
    let floor = 206.0;
    for (decade, label) in ["pass 1", "pass 10", "pass 100", "pass 1000", "pass 10⁴"].into_iter().enumerate()
    {
        let radius = 74.0 * radii[10usize.pow(decade as u32) - 1];
        let fill = Ink::line(CAMERA).filled("#cfe0f7", 0.5);
        canvas.circle([664.0, floor - radius], radius, fill);
        let y = 234.0 + 22.0 * decade as f64;
        canvas.text([668.0, y], label, LABEL.end());
        canvas.text(
            [684.0, y],
            &format!("{:.2} r₁", radii[10usize.pow(decade as u32) - 1]),
            LABEL.color(INK),
        );
    }
    canvas
}

#[cfg(test)]
mod tests {
    #[test]
    fn radii_fall_as_the_paper_says() {
        // r²ᵢ ≈ r²₁·i^(α − 1)/Γ(1 + α), with Γ(5/3) = 0.902745…
        let radii = super::radii(2.0 / 3.0);
        let expected = (1e4f64.powf(-1.0 / 3.0) / 0.902_745_292_95).sqrt();
        assert!((radii[9_999] / expected - 1.0).abs() < 1e-4);
        assert_eq!(radii[0], 1.0);
        assert!(super::radii(1.0).iter().all(|r| *r == 1.0));
    }
}
