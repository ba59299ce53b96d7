// Shows the cells of a sample of finite elements, coloured by one of their fields, at the times at which these were stored.
"use strict";
const sampleView = (figure, data, {element, theme, digits}) => {
  const lightToDark = ["#f3f1ea", "#fdd49e", "#fc8d59", "#d7301f", "#a00000"].map(rgb);
  const set = (figure.kept ||= {field: "broken_segments_share", time: data.times.length - 1, chosen: -1});
  const box = element("div", figure.stage, {className: "sample"});
  const canvas = element("canvas", box, {tabIndex: 0});
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", figure.alternative);
  const key = element("div", box, {className: "key"});
  const controls = element("div", box, {className: "controls"});
  const slider = element("input", controls, {type: "range", min: 0, max: data.times.length - 1, step: 1, value: set.time});
  slider.setAttribute("aria-label", "Time of the test");
  const title = element("output", controls);
  const reading = element("p", box, {className: "reading"});
  reading.setAttribute("aria-live", "polite");

  const limits = [Infinity, -Infinity, Infinity, -Infinity]; // of all times, so that the slider moves no axes
  for (const points of [data.cells.map(cell => cell.rest), ...data.times.map(time => time.moved)].flat())
    points.forEach((value, k) => {
      const axis = 2 * (k % 2);
      limits[axis] = Math.min(limits[axis], value);
      limits[axis + 1] = Math.max(limits[axis + 1], value);
    });
  const [width, height] = [limits[1] - limits[0] || 1, limits[3] - limits[2] || 1];
  canvas.style.aspectRatio = `${Math.max(0.3, Math.min(3, width / height))}`;
  const onCanvas = () => {
    const size = Math.min((canvas.clientWidth - 8) / width, (canvas.clientHeight - 8) / height);
    return (x, y) => [canvas.clientWidth / 2 + size * (x - (limits[0] + limits[1]) / 2), canvas.clientHeight / 2 - size * (y - (limits[2] + limits[3]) / 2)];
  };
  const outline = (pen, points, at) => {
    pen.beginPath();
    for (let k = 0; k < points.length; k += 2)
      pen.lineTo(...at(points[k], points[k + 1]));
    pen.closePath();
  };

  const draw = () => {
    const field = data.fields.find(one => one.field === set.field) || data.fields[0];
    const values = field.values[set.time];
    const corners = data.times[set.time].moved;
    title.textContent = data.times[set.time].title;
    const known = values.filter(value => value !== null);
    const [least, most] = [Math.min(...known), Math.max(...known)];
    const far = Math.max(-least, most);
    const [ramp, from, to] = least < 0 && most > 0 ? [bothWays, -far, far] : [lightToDark, least, most];
    const pixels = devicePixelRatio || 1;
    Object.assign(canvas, {width: Math.round(canvas.clientWidth * pixels), height: Math.round(canvas.clientHeight * pixels)});
    const pen = canvas.getContext("2d");
    pen.scale(pixels, pixels);
    const at = onCanvas();
    const css = colour => `rgb(${colour.map(Math.round).join(" ")})`;
    corners.forEach((points, k) => {
      const value = values[k];
      outline(pen, points, at);
      pen.fillStyle = value === null ? theme("--card") : css(onRamp(to > from ? (value - from) / (to - from) : 0, ramp));
      pen.fill();
      pen.strokeStyle = theme("--faint");
      pen.lineWidth = 0.5;
      pen.stroke();
    });
    if (set.chosen >= 0) {
      outline(pen, corners[set.chosen], at);
      pen.strokeStyle = theme("--link");
      pen.lineWidth = 3;
      pen.stroke();
    }
    // The letters of the RVEs stand where their points are displaced to.
    pen.font = "600 13px system-ui, sans-serif";
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    for (const {letter, at: place} of set.time === data.times.length - 1 ? data.marks : []) {
      pen.beginPath();
      pen.arc(...at(...place), 9, 0, 2 * Math.PI);
      pen.fillStyle = theme("--page");
      pen.fill();
      pen.fillStyle = pen.strokeStyle = theme("--text");
      pen.lineWidth = 1;
      pen.stroke();
      pen.fillText(letter, ...at(...place));
    }
    key.textContent = "";
    const entry = element("span", key, {className: "entry"});
    entry.append(`${field.name}: ${digits(from)} `);
    element("span", entry, {className: "ramp"}).style.background = `linear-gradient(to right, ${ramp.map(css).join(", ")})`;
    entry.append(` ${digits(to)} ${field.unit}`);
  };
  const choose = k => {
    set.chosen = k;
    reading.textContent = k < 0 ? "" : `Cell ${data.cells[k].cell}: ` +
      data.fields.map(field => `${field.name} ${digits(field.values[set.time][k])} ${field.unit}`.trim()).join(", ");
    draw();
  };
  canvas.addEventListener("click", event => {
    const place = canvas.getBoundingClientRect();
    const pen = canvas.getContext("2d");
    const pixels = devicePixelRatio || 1;
    const at = onCanvas();
    choose(data.times[set.time].moved.findIndex(points => {
      outline(pen, points, at);
      return pen.isPointInPath((event.clientX - place.left) * pixels, (event.clientY - place.top) * pixels);
    }));
  });
  slider.addEventListener("input", () => {
    set.time = Number(slider.value);
    choose(set.chosen);
  });
  const fieldLabel = element("label", figure.bar, {textContent: "field "});
  const select = element("select", fieldLabel);
  for (const field of data.fields)
    element("option", select, {value: field.field, textContent: field.name + (field.unit ? ` [${field.unit}]` : "")});
  select.value = set.field;
  select.onchange = () => {
    set.field = select.value;
    draw();
  };
  figure.hint("sample", "Click a cell for its numbers.");
  const watch = new ResizeObserver(draw);
  watch.observe(canvas);
  choose(set.chosen);
  return () => watch.disconnect();
};
