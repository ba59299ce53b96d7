// Does with a page of the report as a reader with a mouse does, and names in the page's title what came of it: +hover where it
// did, -hover where it did not.
// The charts answer with the frames of the screen, which a browser without one makes as it likes.
window.requestAnimationFrame = done => setTimeout(() => done(performance.now()), 0);
addEventListener("load", async () => {
  const pause = () => new Promise(done => setTimeout(done, 300));
  const said = [];
  const claim = (name, holds) => said.push((holds ? "+" : "-") + name);
  try {
    const frame = document.querySelector("figure.live:has(.chart)");
    const canvas = frame.querySelector(".chart canvas");
    frame.scrollIntoView();
    await pause();
    const plot = Chart.getChart(canvas);
    const at = (x, y) => {
      const box = canvas.getBoundingClientRect();
      return {clientX: box.left + x, clientY: box.top + y, bubbles: true, button: 0, view: window};
    };
    const mouse = (kind, x, y, to = canvas) => to.dispatchEvent(new MouseEvent(kind, at(x, y)));
    const points = plot.getDatasetMeta(plot.data.datasets.findIndex(one => !one.silent)).data;
    const point = points[Math.floor(points.length / 2)];
    mouse("mousemove", point.x, point.y);
    await pause();
    claim("hover", plot.tooltip.opacity > 0 && plot.tooltip.body.length > 0 && / at /.test(plot.tooltip.body[0].lines[0]));
    const width = () => plot.scales.x.max - plot.scales.x.min;
    const whole = width();
    const {left, right, top, bottom} = plot.chartArea;
    const along = share => [left + share * (right - left), top + share * (bottom - top)];
    mouse("mousedown", ...along(0.25));
    mouse("mousemove", ...along(0.5), document);
    mouse("mousemove", ...along(0.75), document);
    mouse("mouseup", ...along(0.75), document);
    await pause();
    claim("zoom", Math.abs(width() / whole - 0.5) < 0.02);
    mouse("dblclick", ...along(0.5));
    await pause();
    claim("whole range", Math.abs(width() / whole - 1) < 1e-9);
    const entry = frame.querySelector(".key button");
    const n = () => plot.data.datasets.filter((one, k) => plot.isDatasetVisible(k)).length;
    const before = n();
    entry.click();
    claim("hide", n() < before && entry.getAttribute("aria-pressed") === "false");
    entry.click();
    claim("show", n() === before && entry.getAttribute("aria-pressed") === "true");
    [...frame.querySelectorAll(".bar button")].at(-1).click();
    claim("as printed", !frame.classList.contains("live") && frame.querySelector("img").checkVisibility());
    frame.querySelector(".again").click();
    claim("interactive again", frame.classList.contains("live"));
    const source = [...document.querySelectorAll("script.live-data")].find(one => JSON.parse(one.textContent).what === "cracks");
    const story = source.closest("figure");
    story.scrollIntoView();
    await pause();
    const slider = story.querySelector("input"), words = story.querySelector("output");
    const last = words.textContent;
    slider.value = 0;
    slider.dispatchEvent(new Event("input"));
    claim("slider", words.textContent !== last && /: 0 in tension/.test(words.textContent));
  } catch (error) {
    said.push("-" + error);
  }
  document.title = "probed " + said.join(" ");
});
