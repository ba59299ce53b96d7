// Shows in the place of pictures what answers to the pointer: curves by Chart.js, specimens by specimens.js, samples by sample.js.
// Without it, and on paper, the page has its pictures. All texts go through the canvas or textContent.
"use strict";
(() => {
  // As gnuplot counts them.
  const marks = {1: "cross", 4: "rect", 5: "rect", 6: "circle", 7: "circle", 8: "triangle", 12: "rectRot", 13: "rectRot"};
  const openMarks = [4, 6, 8, 12];
  const dashes = {1: [], 2: [8, 5], 3: [2, 4], 4: [9, 4, 2, 4], 5: [9, 4, 2, 4, 2, 4]};
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const theme = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const explained = {};
  const drawn = []; // of each figure on the screen what draws it anew

  // The nearest point to the pointer that has a value of its own: bands and bars have none.
  Chart.Interaction.modes.telling = (plot, event) => {
    const at = Chart.helpers.getRelativePosition(event, plot);
    let nearest = [];
    let least = Infinity;
    if (!plot.isPointInArea(at))
      return nearest;
    for (const line of plot.getSortedVisibleDatasetMetas())
      if (!plot.data.datasets[line.index].silent)
        line.data.forEach((point, index) => {
          const distance = Math.hypot(point.x - at.x, point.y - at.y);
          if (distance < least && plot.isPointInArea(point)) {
            least = distance;
            nearest = [{element: point, datasetIndex: line.index, index}];
          }
        });
    return nearest;
  };

  const element = (tag, parent, properties = {}) =>
    parent.appendChild(Object.assign(document.createElement(tag), properties));

  // Black is the rock's colour and turns with the page's.
  const shade = colour => (colour === "#000000" ? theme("--text") : colour === "#332288" && dark.matches ? "#8f83e0" : colour);
  const digits = value => (value === null ? "–" : value === 0 ? "0" : Number(value.toPrecision(4)).toString().replace("-", "−"));

  function dataset(line) {
    const colour = shade(line.colour);
    const isMarks = line.kind === "marks";
    const isOpen = isMarks && openMarks.includes(line.mark);
    const area = line.kind === "area";
    return {
      label: line.label,
      goesWith: line.goes_with,
      // A gap is null there.
      data: line.points.map(point => ({x: point ? point[0] : NaN, y: point ? point[1] : NaN})),
      showLine: !isMarks,
      fill: area ? "shape" : false,
      stepped: line.kind === "steps" ? "middle" : false,
      borderColor: line.goes_with && line.width < 1 ? colour + "88" : colour,
      backgroundColor: area ? colour + "2e" : isOpen ? "transparent" : colour,
      borderWidth: area ? 0 : line.width,
      borderDash: dashes[line.dashes] || [],
      pointStyle: isMarks ? marks[line.mark] : "line",
      pointBorderWidth: 1.5,
      pointRadius: isMarks ? 4.5 : 0,
      pointHoverRadius: isMarks ? 6.5 : area || line.kind === "bars" ? 0 : 3,
      pointHitRadius: area || line.kind === "bars" ? 0 : 6,
      silent: area || line.kind === "bars",
      yAxisID: line.right ? "right" : "y",
      order: area ? 3 : line.goes_with ? 2 : 1,
    };
  }

  // What stands for a line in the key: itself.
  function sample(of) {
    const pixels = devicePixelRatio || 1;
    const canvas = document.createElement("canvas");
    canvas.width = 32 * pixels;
    canvas.height = 12 * pixels;
    const pen = canvas.getContext("2d");
    pen.scale(pixels, pixels);
    pen.strokeStyle = of.borderColor;
    pen.fillStyle = of.backgroundColor;
    if (of.showLine) {
      pen.setLineDash(of.borderDash);
      pen.lineWidth = of.borderWidth;
      pen.moveTo(0, 6);
      pen.lineTo(32, 6);
      pen.stroke();
    } else {
      pen.lineWidth = of.pointBorderWidth;
      Chart.helpers.drawPoint(pen, {pointStyle: of.pointStyle, radius: 4.5, rotation: 0, borderWidth: 1.5}, 16, 6);
    }
    return canvas;
  }

  // Beside the canvas, so that its words break where the screen is narrow.
  function key(figure, plot) {
    const list = element("div", figure.stage, {className: "key"});
    const all = plot.data.datasets;
    all.forEach((line, k) => {
      if (line.goesWith)
        return;
      const entry = element("button", list, {type: "button"});
      entry.append(sample(line), element("span", entry, {textContent: line.label}));
      entry.setAttribute("aria-pressed", "true");
      // What goes with a line comes and goes with it.
      entry.onclick = () => {
        const shown = !plot.isDatasetVisible(k);
        all.forEach((one, n) => {
          if (n === k || one.goesWith === line.label)
            plot.setDatasetVisibility(n, shown);
        });
        entry.setAttribute("aria-pressed", String(shown));
        plot.update();
      };
    });
  }

  function axis(title, position, fromZero, isLogarithmic = false) {
    const text = theme("--text");
    return {
      type: isLogarithmic ? "logarithmic" : "linear",
      position,
      min: fromZero ? 0 : undefined,
      title: {display: true, text: title, color: text},
      ticks: {color: text, maxRotation: 0, autoSkipPadding: 12, includeBounds: false},
      grid: {color: theme("--line"), drawOnChartArea: position !== "right"},
    };
  }

  function chart(figure, data) {
    const box = element("div", figure.stage, {className: "chart"});
    box.style.aspectRatio = matchMedia("(max-width: 40rem)").matches ? "1 / 0.95" : "3 / 2";
    const canvas = element("canvas", box);
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", figure.alternative);
    const scales = {
      x: axis(data.x, "bottom", false, data.logarithmic?.includes("x")),
      y: axis(data.y, "left", data.from_zero, data.logarithmic?.includes("y")),
    };
    if (data.part) {
      [scales.x.min, scales.x.max] = data.part;
      [scales.y.min, scales.y.max] = data.part.slice(2);
    }
    if (data.right)
      scales.right = axis(data.right, "right", true);
    const plot = new Chart(canvas, {
      type: "scatter",
      data: {datasets: data.lines.map(dataset)},
      options: {
        animation: false,
        responsive: true,
        maintainAspectRatio: false,
        interaction: {mode: "telling", intersect: false},
        scales,
        plugins: {
          legend: {display: false},
          tooltip: {
            callbacks: {
              title: () => "",
              label: item => `${item.dataset.label}: ${digits(item.parsed.y)} at ${digits(item.parsed.x)}`,
            },
          },
          zoom: {
            zoom: {
              drag: {enabled: true, threshold: 6},
              wheel: {enabled: true, modifierKey: "ctrl"},
              mode: "xy",
            },
          },
        },
      },
    });
    key(figure, plot);
    if (data.equal) {
      const equalise = () => {
        const {width, height} = plot.chartArea;
        const {min, max} = plot.scales.x;
        plot.options.scales.x.min = min;
        plot.options.scales.x.max = max;
        plot.options.scales.y.max = ((max - min) * height) / width;
        plot.update("none");
      };
      equalise();
      plot.options.onResize = () => requestAnimationFrame(equalise);
    }
    canvas.addEventListener("dblclick", () => plot.resetZoom());
    figure.buttons([["whole range", () => plot.resetZoom()]]);
    figure.hint("chart", "Drag a rectangle to enlarge it, double-click for the whole range; click an entry of the key to hide or show it.");
    return plot;
  }

  // The picture for paper of specimens: on white, however the page is shown.
  const onPaper = {"--text": "#1b1f24", "--card": "#ffffff", "--line": "#d5dae0"};
  const still = data => {
    const stage = element("div", document.body, {className: "still"});
    stage.style.width = `${18 * data.tests.length}rem`;
    const view = specimensView({stage, bar: document.createElement("div"), buttons() {}, hint() {}}, data, chart,
                               {element, theme: name => onPaper[name], dark: {matches: false}, digits, swift: asked});
    const picture = view.still();
    view.end();
    stage.remove();
    return picture;
  };

  // The program opens a page with a fragment, and reads what its script draws (report/page/browser.h): the first specimens
  // as a film, or all as pictures.
  const sources = [...document.querySelectorAll("script.live-data")];
  const ofSpecimens = () => sources.map(one => [one.closest("figure"), JSON.parse(one.textContent)]).filter(([, data]) => data.what === "specimens");
  const asked = ["#film", "#stills"].includes(location.hash);
  const handOver = all => document.body.replaceChildren(...all.map(textContent => Object.assign(document.createElement("pre"), {className: "drawn", textContent})));
  if (location.hash === "#stills")
    return handOver(ofSpecimens().map(([, data]) => {
      try {
        return still(data).split(",")[1];
      } catch {
        return ""; // without WebGL
      }
    }));
  const filmed = location.hash === "#film" ? sources.find(one => JSON.parse(one.textContent).what === "specimens") : null;
  if (filmed) {
    document.body.replaceChildren(filmed.closest("figure"));
    document.body.style.maxWidth = "58rem";
  }

  for (const source of filmed ? [filmed] : sources) {
    const frame = source.closest("figure");
    const image = frame.querySelector("img");
    const figure = {
      alternative: image ? image.alt : "",
      stage: null,
      kept: undefined,
    };
    const bar = (figure.bar = document.createElement("div"));
    bar.className = "bar";
    figure.buttons = all => {
      for (const [text, action] of all)
        element("button", bar, {type: "button", textContent: text, onclick: action});
    };
    // Said under the first of its kind; without a kind under each.
    figure.hint = (kind, text) => {
      if (!kind || (explained[kind] ||= frame) === frame)
        element("p", figure.stage, {className: "hint", textContent: text});
      else
        figure.stage.title = text;
    };
    let end = null;
    const begin = () => {
      const data = JSON.parse(source.textContent);
      frame.classList.add("live");
      figure.stage = document.createElement("div");
      figure.stage.className = "stage";
      frame.insertBefore(figure.stage, frame.firstChild);
      bar.textContent = "";
      try {
        if (data.what === "specimens") {
          const view = specimensView(figure, data, chart, {element, theme, dark, digits, swift: filmed});
          end = view.end;
          figure.film = view.film;
        } else if (data.what === "sample") {
          end = sampleView(figure, data, {element, theme, digits});
        } else {
          const plot = chart(figure, data);
          end = () => plot.destroy();
        }
      } catch {
        // Without WebGL: the picture stays.
        figure.stage.remove();
        frame.classList.remove("live");
        return;
      }
      if (image)
        figure.buttons([["as printed", stop]]);
      figure.stage.appendChild(bar);
    };
    const stop = () => {
      end();
      end = null;
      figure.stage.remove();
      frame.classList.remove("live");
      const again = element("button", frame, {type: "button", textContent: "interactive", className: "again"});
      again.onclick = () => {
        again.remove();
        begin();
      };
    };
    figure.printed = stop;
    drawn.push(() => {
      if (end) {
        end();
        figure.stage.remove();
        begin();
      }
    });
    // A figure is made when it comes near the screen: a long page opens at once.
    const reach = 800;
    if (filmed || frame.getBoundingClientRect().top < innerHeight + reach) {
      begin();
      const film = filmed && figure.film?.(32);
      if (film)
        handOver([btoa(Array.from(film, one => String.fromCharCode(one)).join(""))]);
      continue;
    }
    new IntersectionObserver((seen, observer) => {
      if (seen.some(one => one.isIntersecting)) {
        observer.disconnect();
        begin();
      }
    }, {rootMargin: `${reach}px`}).observe(frame);
  }
  // Tiles stand below the left figure of the first screen where that levels both sides. The curves of the lower side, up to
  // twice as high, and the frame of its last figure take what is left.
  const leads = [...document.querySelectorAll(".lead")].map(lead => ({
    lead,
    sides: [lead.querySelector(".beside"), lead.firstElementChild],
    tiles: lead.nextElementSibling?.matches(".tiles") ? lead.nextElementSibling : null,
  }));
  const level = () => {
    for (const {lead, sides, tiles} of leads) {
      const curves = sides.map(side => [...side.querySelectorAll(".specimens .chart, figure:last-child .chart")].at(-1));
      curves.forEach(one => one?.style.removeProperty("height"));
      if (tiles)
        lead.after(tiles);
      if (getComputedStyle(lead).display !== "grid" || !sides.every(side => side.lastElementChild))
        continue;
      const missing = () => {
        const [left, right] = sides.map(side => side.lastElementChild.getBoundingClientRect().bottom);
        return right - left;
      };
      lead.style.alignItems = "start";
      const before = Math.abs(missing());
      if (tiles) {
        sides[0].append(tiles);
        if (Math.abs(missing()) > before)
          lead.after(tiles);
      }
      const rest = missing();
      const growing = curves[rest > 0 ? 0 : 1];
      if (growing && !(rest > 0 && sides[0].contains(tiles)))
        growing.style.height = `${growing.clientHeight + Math.min(Math.abs(rest), growing.clientHeight)}px`;
      lead.style.removeProperty("align-items");
    }
  };
  level();
  addEventListener("resize", level);
  dark.addEventListener("change", () => {
    drawn.forEach(anew => anew());
    level();
  });
  // Specimens that came without a picture get one for paper.
  addEventListener("beforeprint", () => {
    for (const [frame, data] of ofSpecimens())
      if (!frame.querySelector("img"))
        try {
          const src = still(data);
          element("img", element("div", frame, {className: "picture"}), {src});
        } catch {
          return; // without WebGL
        }
  });

  // The picture that is shown is in the page: its link works where the page was mailed alone.
  for (const link of document.querySelectorAll("a[data-shown]")) {
    const image = link.closest("figure").querySelector("img");
    if (image) {
      link.download = link.getAttribute("href").split("/").pop();
      link.href = image.src;
    }
  }
})();
