// Shows up to four tests of a rock side by side by viewer.js, their curves, and one slider over the strain for all.
"use strict";
const testTones = ["#1b9e77", "#c4569c", "#7570b3", "#a6761d"];

// Animated WebP of still ones, each shown so long [ms].
const animated = (stills, width, height, duration) => {
  const bytes = (value, n) => Array.from({length: n}, (none, k) => (value >>> (8 * k)) & 255);
  const chunk = (name, ...parts) => {
    const size = parts.reduce((sum, part) => sum + part.length, 0);
    return [[...name].map(letter => letter.charCodeAt(0)), bytes(size, 4), ...parts, size % 2 ? [0] : []];
  };
  const size = [...bytes(width - 1, 3), ...bytes(height - 1, 3)];
  const frames = stills.flatMap(still => {
    const riff = Uint8Array.from(atob(still), one => one.charCodeAt(0));
    const pictures = []; // without the parts that the film has once, or not at all
    for (let at = 12, size; at + 8 < riff.length; at += 8 + size + (size % 2)) {
      size = riff[at + 4] | (riff[at + 5] << 8) | (riff[at + 6] << 16) | (riff[at + 7] << 24);
      if (["ALPH", "VP8 ", "VP8L"].includes(String.fromCharCode(...riff.subarray(at, at + 4))))
        pictures.push(riff.subarray(at, at + 8 + size + (size % 2)));
    }
    return chunk("ANMF", bytes(0, 6), size, bytes(duration, 3), [2], ...pictures);
  });
  const film = chunk("RIFF", bytes(0x50424557, 4), ...chunk("VP8X", [2, 0, 0, 0], size), ...chunk("ANIM", bytes(0xffffffff, 4), [0, 0]), ...frames);
  const whole = new Uint8Array(film.reduce((sum, part) => sum + part.length, 0));
  film.reduce((at, part) => (whole.set(part, at), at + part.length), 0);
  return whole;
};

const specimensView = (figure, data, chart, tools) => {
  const {element, theme, dark, digits} = tools;
  const tests = data.tests;
  const inSpace = tests.some(test => test.space);
  const box = element("div", figure.stage, {className: "specimens"});
  const row = element("div", box, {className: "row"});
  row.style.setProperty("--n", tests.length);
  box.style.setProperty("--high", tests.length > 2 ? "15rem" : "20rem");
  const course = element("div", box, {className: "curves"});
  const plotBox = element("div", course);
  const key = element("div", course, {className: "key"});
  const controls = element("div", course, {className: "controls"});
  const player = element("button", controls, {type: "button", textContent: "▶ play"});
  const slider = element("input", controls, {type: "range", min: 0, max: 1000, step: 1});
  slider.setAttribute("aria-label", "Strain of all tests, relative to that at the peak");
  const place = element("output", controls);
  const reading = element("p", course, {className: "reading"});
  reading.setAttribute("aria-live", "polite");

  // What the reader set, kept while the figure is drawn anew.
  const set = (figure.kept ||= {
    share: inSpace ? 1 : null, // at the end of a test, cracks hide a body in space
    azimuth: inSpace ? -0.45 : 0,
    elevation: inSpace ? 0.3 : Math.PI / 2,
    zoom: 1,
    pan: [0, 0],
    cut: inSpace ? "y" : "whole",
    grains: data.fragments ? "fragment" : tests.some(test => test.grains.tone) ? "mineral grain" : "plain",
    cracks: data.fragments ? "hidden" : "kind",
    emission: "hidden",
    relative: false,
    fullSize: Math.max(...tests.map(test => test.events.full_size ?? -Infinity)), // magnitude
  });
  const panes = [];
  const toneOf = (test, k) => test.colour || testTones[k];
  const anew = () => panes.forEach(pane => pane.draw());
  const tell = text => (reading.textContent = text);
  tests.forEach((test, k) => panes.push(specimenView(
    row, test, set, {tone: toneOf(test, k), anew, tell, alternative: `${figure.alternative} ${test.title}.`, lose: () => figure.printed()}, tools)));
  const longest = Math.min(4, Math.max(...panes.map(pane => pane.course.at(-1))));

  // The curves, and a mark on each.
  const peaks = tests.map(test => test.rows.reduce((best, one) => (one[1] > best[1] ? one : best)));
  const onCurve = (one, k) => (one[0] === null || one[1] === null ? null : set.relative ? [one[0] / (peaks[k][0] || 1), one[1] / (peaks[k][1] || 1)] : [one[0], one[1]]);
  let plot = null;
  const drawCurves = () => {
    plot?.destroy();
    plotBox.textContent = "";
    const lines = tests.map((test, k) => ({kind: "line", label: test.title, goes_with: "", colour: toneOf(test, k), width: 2.2, dashes: 1, points: test.rows.map(one => onCurve(one, k))}));
    const marks = tests.map((test, k) => ({...lines[k], kind: "marks", mark: 7, goes_with: test.title, points: []}));
    plot = chart({...figure, stage: plotBox, buttons() {}, hint() {}}, {
      x: set.relative ? "strain over that at the peak" : "strain [10⁻³], positive as the test loads",
      y: set.relative ? "stress over the strength" : "stress [MPa]",
      // Waves of a body that came apart are not shown.
      from_zero: tests.every(test => test.rows.every(one => one[1] === null || one[1] >= -0.05 * Math.max(...peaks.map(peak => peak[1])))),
      lines: [...lines, ...marks],
    });
  };
  drawCurves();

  const {kindTones, plain, pieceTones} = specimenTones(dark);
  const css = colour => `rgb(${colour.map(Math.round).join(" ")})`;
  const describeKey = () => {
    key.textContent = "";
    const chip = (background, text) => {
      const entry = element("span", key, {className: "entry"});
      element("span", entry, {className: "chip"}).style.background = background;
      entry.append(text);
    };
    const bar = (from, to, ramp = ofShare) => {
      const entry = element("span", key, {className: "entry"});
      entry.append(from + " ");
      element("span", entry, {className: "ramp"}).style.background = `linear-gradient(to right, ${ramp.map(css).join(", ")})`;
      entry.append(" " + to);
    };
    const ofEach = name => panes.map(pane => digits(Number(pane[name]().toPrecision(2)))).join(", ");
    if (set.cracks === "kind" || set.cracks === "tension")
      chip(css(kindTones[0]), "tension crack");
    if (set.cracks === "kind" || set.cracks === "shear")
      chip(css(kindTones[1]), "shear crack");
    if (set.cracks === "strain")
      bar("cracks: begin", "end of the test");
    if (set.cracks === "opening")
      bar("cracks: opening at the end 0", `${ofEach("typicalOpening")} µm`);
    if (set.grains === "displacement")
      bar("grains: 0", `${ofEach("typicalMotion")} mm, at the end`);
    else if (set.grains === "stress")
      bar("mean stress at the highest load: compression", `tension, ± ${ofEach("typicalStress")} MPa`, bothWays);
    else if (set.grains === "mineral grain") // of mineral grains without a kind there is nothing to tell
      new Map(tests.flatMap(test => test.minerals)).forEach((colour, name) => chip(colour, name));
    else if (set.grains === "fragment") {
      chip(css(plain), "largest piece");
      chip(css(singleGrain), "single grains");
      chip(css(pieceTones[1]), "other fragments, at the end");
    }
    if (set.emission === "hidden")
      return;
    if (set.emission === "strain")
      bar("events: begin", "end of the test");
    else
      ["tensile", "shear", "implosive"].forEach((kind, k) => chip(css(kindTones[k]), `${kind} event`));
    const entry = element("span", key, {className: "entry"});
    const samples = [0, 1, 2].map(k => set.fullSize - k);
    const radii = samples.map(magnitude => eventRadius(magnitude, set.fullSize));
    const [width, height] = [2 * radii.reduce((sum, radius) => sum + radius + 2, 0), 2 * radii[0] + 2];
    const pixels = devicePixelRatio || 1;
    const canvas = element("canvas", entry, {width: width * pixels, height: height * pixels});
    Object.assign(canvas.style, {width: `${width}px`, height: `${height}px`, verticalAlign: "middle"});
    const pen = canvas.getContext("2d");
    pen.scale(pixels, pixels);
    pen.strokeStyle = theme("--text");
    radii.reduce((left, radius) => {
      pen.beginPath();
      pen.arc(left + radius, height / 2, radius, 0, 2 * Math.PI);
      pen.stroke();
      return left + 2 * radius + 4;
    }, 2);
    entry.append(` magnitude ${samples.map(one => digits(Number(one.toFixed(1)))).join(", ").replace(",", " or more,")}: ten times the area a unit`);
  };

  // All tests to one share of their strains at the peak; at the end of the slider each stands at its own end.
  const go = share => {
    set.share = share >= longest ? null : share;
    slider.value = (1000 * share) / longest;
    place.textContent = set.share === null ? "end of each test" : `${share.toFixed(2)} × strain at the peak`;
    panes.forEach((pane, k) => {
      const at = onCurve(pane.go(set.share ?? Infinity), k);
      plot.data.datasets[tests.length + k].data = at ? [{x: at[0], y: at[1]}] : [];
    });
    plot.update("none");
  };
  let playing = 0;
  const stop = () => {
    cancelAnimationFrame(playing);
    playing = 0;
    player.textContent = "▶ play";
  };
  player.onclick = () => {
    if (playing)
      return stop();
    const from = set.share ?? 0, seconds = 8;
    let start;
    const next = now => {
      const share = Math.min(longest, from + ((now - (start ??= now)) * longest) / seconds / 1000);
      playing = share < longest ? requestAnimationFrame(next) : 0;
      go(share);
      if (!playing)
        stop();
    };
    player.textContent = "❚❚ pause";
    playing = requestAnimationFrame(next);
  };
  slider.addEventListener("input", () => {
    stop();
    go((slider.value * longest) / 1000);
  });

  // Draws a part of the view as it stands on the screen, moved to the right: panes, curves and words.
  const edge = 8;
  const paste = (pen, part, right) => {
    const {left: from, top: above} = box.getBoundingClientRect();
    const at = one => {
      const {left, top, width, height} = one.getBoundingClientRect();
      return [left - from + edge + right, top - above + edge, width, height];
    };
    for (const one of part.querySelectorAll("canvas"))
      pen.drawImage(one, ...at(one));
    for (const one of part.querySelectorAll(".chip")) {
      pen.fillStyle = getComputedStyle(one).backgroundColor;
      pen.fillRect(...at(one));
    }
    // Each line of a text where it stands.
    pen.fillStyle = theme("--text");
    for (const one of part.querySelectorAll(".scale")) {
      const [left, top, width, height] = at(one);
      pen.fillRect(left, top + height - 2, width, 2);
    }
    pen.textBaseline = "middle";
    const walk = document.createTreeWalker(part, NodeFilter.SHOW_TEXT);
    for (let text; (text = walk.nextNode());) {
      if (controls.contains(text))
        continue;
      pen.font = getComputedStyle(text.parentElement).font;
      const range = document.createRange();
      let line = "", [left, top] = [0, 0];
      for (let n = 0; n <= text.length; ++n) {
        range.setStart(text, Math.min(n, text.length - 1));
        range.setEnd(text, Math.min(n + 1, text.length));
        const [x, y, , height] = at(range);
        if (n === text.length || (line && y + height / 2 > top + 4)) {
          pen.fillText(line, left, top);
          line = "";
        }
        if (!line)
          [left, top] = [x, y + height / 2];
        line += text.data[n] ?? "";
      }
    }
  };
  const sheetOf = (width, height, pixels) => {
    const sheet = document.createElement("canvas");
    Object.assign(sheet, {width: Math.ceil((width + 2 * edge) * pixels), height: Math.ceil((height + 2 * edge) * pixels)});
    const pen = sheet.getContext("2d", {alpha: false, willReadFrequently: true});
    pen.scale(pixels, pixels);
    const clear = () => {
      pen.fillStyle = theme("--card");
      pen.fillRect(0, 0, sheet.width, sheet.height);
    };
    clear();
    return {sheet, pen, clear};
  };

  // The film as WebP. Null where the browser writes none.
  const film = nFrames => {
    const frame = box.getBoundingClientRect();
    const {sheet, pen, clear} =
      sheetOf(frame.width, Math.max(row.getBoundingClientRect().bottom, key.getBoundingClientRect().bottom) - frame.top, 1);
    const stills = [];
    const before = set.share;
    for (let k = 0; k < nFrames; ++k) {
      go((k * longest) / (nFrames - 1));
      clear();
      paste(pen, box, 0);
      const still = sheet.toDataURL("image/webp", 0.85);
      if (!still.startsWith("data:image/webp"))
        return null;
      stills.push(still.split(",")[1]);
    }
    go(before ?? longest);
    return animated([...stills, ...Array(6).fill(stills.at(-1))], sheet.width, sheet.height, 200);
  };

  // The picture for paper as the address of a PNG: one test at its stages, several at their ends. The curves are gone then.
  const still = () => {
    course.replaceWith(key);
    row.querySelectorAll(".header .chip").forEach(one => one.remove()); // the colours of the curves
    const stages = tests.length > 1 ? [["", Infinity]] : data.fragments ? tests[0].stages.slice(-1) : tests[0].stages;
    const frame = box.getBoundingClientRect();
    const {sheet, pen} = sheetOf(frame.width * stages.length + 2 * edge * (stages.length - 1), frame.height, devicePixelRatio || 1);
    stages.forEach(([title, at], k) => {
      if (title)
        row.querySelector(".entry").lastChild.data = title;
      panes.forEach(pane => pane.showRow(at));
      paste(pen, row, k * (frame.width + 2 * edge));
    });
    paste(pen, key, 0);
    return sheet.toDataURL("image/png");
  };

  const choice = (name, all) => {
    const label = element("label", figure.bar, {textContent: name + " "});
    const select = element("select", label);
    for (const [value, text] of all)
      element("option", select, {value, textContent: text});
    select.value = set[name];
    select.onchange = () => {
      set[name] = select.value;
      panes.forEach(pane => pane.colour());
      describeKey();
      anew();
    };
  };
  if (inSpace) {
    figure.buttons([["XZ", () => panes[0].view(0, 0)], ["YZ", () => panes[0].view(Math.PI / 2, 0)], ["XY", () => panes[0].view(0, Math.PI / 2)]]);
    choice("cut", [["whole", "none"], ["x", "in half, across x"], ["y", "in half, across y"], ["z", "in half, across z"]]);
  }
  choice("grains", [...(panes.every(pane => pane.hasMinerals) ? [["mineral grain", tests.some(test => test.minerals.length) ? "by mineral" : "by mineral grain"]] : []), ["plain", "one colour"],
                    ["fragment", "by fragment"], ["displacement", "by displacement"],
                    ...(panes.every(pane => pane.hasStress) ? [["stress", "by mean stress"]] : []), ["hidden", "hidden"]]);
  choice("cracks", [["kind", "by kind"], ["strain", "by strain"], ["opening", "by opening"], ["tension", "tension alone"], ["shear", "shear alone"], ["hidden", "hidden"]]);
  if (set.fullSize > -Infinity)
    choice("emission", [["hidden", "hidden"], ["strain", "by strain"], ["mechanism", "by mechanism"]]);
  figure.buttons([["+", () => panes[0].enlarge(1.25)], ["−", () => panes[0].enlarge(0.8)], ["whole", () => panes[0].whole()],
                  ["curves over the peak", () => {
                    set.relative = !set.relative;
                    drawCurves();
                    go(set.share ?? longest);
                  }],
                  ["film", () => {
                    const made = film(32);
                    if (made)
                      element("a", figure.stage, {href: URL.createObjectURL(new Blob([made], {type: "image/webp"})), download: "film.webp"}).click();
                    else
                      tell("This browser writes no WebP.");
                  }]]);
  const thinned = tests.flatMap(test => [[test.grains.every, "grains"], [test.cracks.every, "cracks"]].flatMap(([every, what]) =>
    every > 1 ? [`One of ${every} ${what} of ${test.title} is shown.`] : []).concat(
    test.events.left_out ? [`The ${test.events.left_out} smallest events of ${test.title} are not shown.`] : []));
  figure.hint("specimen", (inSpace ? "Drag to turn, with Shift to move" : "Drag to move") +
    "; Ctrl and the wheel enlarge; click a grain or a crack for its numbers. Grains lie where they were when the loading began, cracks where they broke.");
  if (thinned.length)
    element("p", figure.stage, {className: "hint", textContent: thinned.join(" ")});
  describeKey();
  go(set.share ?? longest);
  return {
    film,
    still,
    end() {
      stop();
      plot.destroy();
      panes.forEach(pane => pane.end());
    },
  };
};
