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
    const source = [...document.querySelectorAll("script.live-data")].find(one => JSON.parse(one.textContent).what === "specimen");
    const specimen = source.closest("figure");
    const data = JSON.parse(source.textContent);
    specimen.scrollIntoView();
    await pause();
    const picture = specimen.querySelector("canvas"), slider = specimen.querySelector("input[type=range]");
    const words = specimen.querySelector("output"), reading = specimen.querySelector(".reading");
    const all = [atob(data.grains.fragment).length / 2, atob(data.cracks.row).length / 2];
    const whole_picture = picture.countSeen();
    claim("grains", whole_picture[0] === all[0]);
    // Segments of one joint lie side by side, some of them on others.
    claim("cracks", all[1] > 0 && whole_picture[1] > 0.7 * all[1] && whole_picture[1] <= all[1]);
    const last = words.textContent;
    slider.value = 0;
    slider.dispatchEvent(new Event("input"));
    claim("slider", words.textContent !== last && /: 0 in tension/.test(words.textContent) && picture.countSeen()[1] === 0);
    const place = new Uint16Array(Uint8Array.from(atob(data.grains.place), one => one.charCodeAt(0)).buffer);
    const spot = picture.placeOf(7);
    const frame_of_picture = picture.getBoundingClientRect();
    for (const kind of ["pointerdown", "pointerup"])
      picture.dispatchEvent(new PointerEvent(kind, {clientX: frame_of_picture.left + spot[0], clientY: frame_of_picture.top + spot[1], pointerId: 1, bubbles: true}));
    const x = data.low[0] + (data.span * place[4 * 6]) / 65535;
    claim("pick", reading.textContent.startsWith(`Grain 7 at (${Number(x.toPrecision(4))},`));
    for (let k = 0; k < 9; ++k)
      picture.dispatchEvent(new KeyboardEvent("keydown", {key: "+"}));
    claim("enlarge", picture.countSeen()[0] < all[0]);
    picture.dispatchEvent(new KeyboardEvent("keydown", {key: "0"}));
    claim("whole", picture.countSeen()[0] === all[0]);
    said.push("faces " + picture.dataset.faces);
  } catch (error) {
    said.push("-" + error);
  }
  document.title = "probed " + said.join(" ");
});
