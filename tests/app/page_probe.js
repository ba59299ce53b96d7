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
    const source = [...document.querySelectorAll("script.live-data")].find(one => JSON.parse(one.textContent).what === "specimens");
    const specimen = source.closest("figure");
    const tests = JSON.parse(source.textContent).tests;
    const data = tests[0];
    specimen.scrollIntoView();
    await pause();
    const pictures = [...specimen.querySelectorAll(".view canvas")], slider = specimen.querySelector("input[type=range]");
    const [picture] = pictures;
    const words = specimen.querySelector(".specimen output"), reading = specimen.querySelector(".reading");
    claim(`${tests.length} tests side by side`, pictures.length === tests.length &&
      new Set(pictures.map(one => one.getBoundingClientRect().top)).size === 1);
    const all = [atob(data.grains.fragment).length / 2, atob(data.cracks.row).length / 2];
    const whole_picture = picture.countSeen();
    claim("grains", whole_picture[0] === all[0]);
    // Segments of one joint lie side by side, some of them on others.
    claim("cracks", all[1] > 0 && whole_picture[1] > 0.7 * all[1] && whole_picture[1] <= all[1]);
    // Each pane has the shape of its specimen, which fills it.
    const filled = pictures.map(one => {
      const pen = Object.assign(document.createElement("canvas"), {width: one.width, height: one.height}).getContext("2d");
      one.countSeen();
      specimen.querySelector("input[type=range]").dispatchEvent(new Event("input")); // draws
      pen.drawImage(one, 0, 0);
      return pen.getImageData(0, 0, one.width, one.height).data.filter((value, k) => k % 4 === 3 && value > 0).length / (one.width * one.height);
    });
    claim("filled", filled.every(share => share > 0.7));
    // The mark on each curve is where the map of its test is.
    const curves = Chart.getChart(specimen.querySelector(".chart canvas"));
    const isAt = rowOf => tests.every((test, k) => {
      const [mark] = curves.data.datasets[tests.length + k].data;
      return mark.x === rowOf(test)[0] && mark.y === rowOf(test)[1];
    });
    claim("marks at the end", isAt(test => test.rows.at(-1)));
    const last = words.textContent;
    slider.value = 0;
    slider.dispatchEvent(new Event("input"));
    claim("slider", words.textContent !== last && /: 0 tension/.test(words.textContent) && pictures.every(one => one.countSeen()[1] === 0));
    claim("marks at the beginning", isAt(test => test.rows[0]));
    slider.value = 1000;
    slider.dispatchEvent(new Event("input"));
    const choose = (name, value) => {
      const select = [...specimen.querySelectorAll("label")].find(one => one.textContent.startsWith(name)).querySelector("select");
      select.value = value;
      select.dispatchEvent(new Event("change"));
    };
    const nShear = atob(data.cracks.normal).split("").filter((one, k) => k % 4 === 3 && one === "\u0001").length;
    choose("cracks", "shear");
    const shear = picture.countSeen()[1];
    choose("cracks", "tension");
    const tension = picture.countSeen()[1];
    claim("filter", shear <= nShear && shear >= 0.7 * nShear && tension <= all[1] - nShear && tension >= 0.7 * (all[1] - nShear));
    const plain = picture.toDataURL();
    choose("grains", "stress");
    claim("stress", picture.toDataURL() !== plain && /stress .* MPa/.test(specimen.querySelector(".curves > .key:not(:has(button))").textContent));
    choose("grains", "plain");
    const place = new Uint16Array(Uint8Array.from(atob(data.grains.place), one => one.charCodeAt(0)).buffer);
    const spot = picture.placeOf(7);
    const frame_of_picture = picture.getBoundingClientRect();
    for (const kind of ["pointerdown", "pointerup"])
      picture.dispatchEvent(new PointerEvent(kind, {clientX: frame_of_picture.left + spot[0], clientY: frame_of_picture.top + spot[1], pointerId: 1, bubbles: true}));
    const x = data.low[0] + (data.span * place[4 * 6]) / 65535;
    claim("pick", reading.textContent.startsWith(`Grain 7 at (${Number(x.toPrecision(4))},`));
    // Events, of the test that has the most: those that began up to where the slider stands.
    const rowsOf = test => new Uint16Array(Uint8Array.from(atob(test.events.row), one => one.charCodeAt(0)).buffer);
    const most = tests.reduce((best, test, k) => (rowsOf(test).length > rowsOf(tests[best]).length ? k : best), 0);
    const [pane, events, rows] = [pictures[most], tests[most].events, rowsOf(tests[most])];
    const isSeen = n => n > 5 && pane.countSeen()[2] <= n && pane.countSeen()[2] >= 0.9 * n;
    choose("emission", "hidden");
    const without = pane.toDataURL();
    choose("emission", "mechanism");
    claim("events at the end", pane.toDataURL() !== without && isSeen(rows.length));
    const nBegun = () => {
      const [mark] = curves.data.datasets[tests.length + most].data;
      const last = tests[most].rows.findLastIndex(row => row[0] === mark.x && row[1] === mark.y);
      return rows.filter(row => row <= last).length;
    };
    for (slider.value = 1000; nBegun() > 0.7 * rows.length; slider.dispatchEvent(new Event("input")))
      slider.value -= 20;
    claim("events half way", isSeen(nBegun()));
    slider.value = 1000;
    slider.dispatchEvent(new Event("input"));
    const [across, down] = pane.placeOf(rows.length, true); // the smallest lies over the others
    const {left: from, top: above} = pane.getBoundingClientRect();
    for (const kind of ["pointerdown", "pointerup"])
      pane.dispatchEvent(new PointerEvent(kind, {clientX: from + across, clientY: above + down, pointerId: 1, bubbles: true}));
    const numbers = new Uint32Array(Uint8Array.from(atob(events.number), one => one.charCodeAt(0)).buffer);
    claim("event picked", reading.textContent.startsWith(`Event ${numbers.at(-1)}, `) && /magnitude .* breaks .* extent .* energy/.test(reading.textContent));
    choose("emission", "strain");
    choose("emission", "hidden");
    claim("emission hidden", pane.toDataURL() === without && pane.countSeen()[2] === 0);
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
