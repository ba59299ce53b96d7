// Shows the grains and cracks of one test by WebGL 2: in the plane polygons and lines, in space spheres and discs. Grains
// lie where the loading began, so that a crack stands where it broke. Events of acoustic emission are discs over all others,
// of a size on the screen that their magnitude alone gives. Picking draws numbers in place of colours.
// `set` has what the reader chose, for all tests of a figure; `anew` draws all, `tell` takes the words on what was picked.
"use strict";
const rgb = text => [1, 3, 5].map(k => parseInt(text.slice(k, k + 2), 16));
const ofShare = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];
const bothWays = ["#2166ac", "#92c5de", "#f0f0f0", "#f4a582", "#b2182b"].map(rgb); // compression to tension
const onRamp = (share, ramp = ofShare) => {
  const place = Math.min(0.9999, Math.max(0, share)) * (ramp.length - 1);
  const k = Math.floor(place);
  return ramp[k].map((value, c) => value + (place - k) * (ramp[k + 1][c] - value));
};
const singleGrain = [240, 226, 150];
// Radius of an event on the screen [px]: a unit of magnitude is ten times the area, up to the magnitude that is drawn at full size.
const mostWide = 14;
const eventRadius = (magnitude, fullSize) => Math.min(mostWide, Math.max(1.5, mostWide * 10 ** ((magnitude - fullSize) / 2)));
const specimenTones = dark => {
  const isDark = dark.matches;
  return {
    isDark,
    plain: isDark ? [92, 99, 108] : [206, 209, 213],
    kindTones: [[213, 94, 0], isDark ? [74, 168, 224] : [0, 114, 178], [0, 158, 115]], // tension, shear, implosion
    pieceTones: ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"].map(rgb),
  };
};
const specimenView = (parent, data, set, {tone, anew, tell, alternative, lose}, {element, theme, dark, digits, swift}) => {
  const begun = performance.now();
  const inSpace = data.space;

  // A sphere, disc or line is one point of the size that it has on the screen. Where a processor draws, each further vertex
  // costs time, and an instance more than a vertex.
  const vertexHead = `#version 300 es
    precision highp float;
    precision highp int;
    uniform highp sampler2D tones; // the colour of each shape
    uniform mat3 turn;
    uniform vec3 middle;
    uniform vec2 zoom, pan;
    uniform vec4 cut;
    uniform float depth;
    uniform uint first, chosen;
    uniform bool picking;
    flat out vec3 tone;
    vec4 placed(vec3 at, int n) {
      uint id = first + uint(n) + 1u;
      vec4 own = texelFetch(tones, ivec2(n % 2048, n / 2048), 0); // without cover: hidden
      tone = picking ? vec3(id & 255u, (id >> 8) & 255u, id >> 16) / 255.0 : id == chosen ? vec3(1.0, 0.88, 0.0) : own.rgb;
      vec3 seen = turn * at;
      return own.a == 0.0 || dot(cut.xyz, at) > cut.w ? vec4(2.0, 2.0, 2.0, 1.0) : vec4(seen.xy * zoom + pan, -seen.z * depth, 1.0);
    }`;
  const pointVertex = vertexHead + `
    layout(location = 0) in vec4 place; // and size, all as shares
    layout(location = 1) in vec4 along; // the normal of a crack, the direction of a flaw
    uniform float extent, pixels;
    uniform int form; // 0: sphere; 1: disc in space; 2: trace of a crack in the plane; 3: line; 4: event
    flat out vec3 axis;
    flat out float size, drawn; // radius, or half the length, and the radius of the point [px]
    flat out float thick, nearness;
    void main() {
      gl_Position = placed(place.xyz - middle, gl_VertexID);
      nearness = gl_Position.z;
      axis = turn * (form == 2 ? vec3(-along.y, along.x, 0.0) : along.xyz);
      if (form == 1)
        axis = normalize(vec3(axis.xy, abs(axis.z) < 0.2 ? 0.2 : axis.z)); // seen along its plane, a disc is still seen
      size = place.w * extent * pixels * (form == 0 || form == 4 ? 1.0 : form == 1 ? 0.564 : 0.5); // √(1/π)
      thick = size / pixels * depth;
      drawn = size + (form > 1 ? 2.0 : 0.5);
      gl_PointSize = 2.0 * drawn;
    }`;
  const facetVertex = vertexHead + `
    layout(location = 0) in vec2 corner;
    layout(location = 1) in float grain; // negative in its middle
    out float rim;
    void main() {
      rim = grain < 0.0 ? 0.0 : 1.0;
      gl_Position = placed(vec3(corner, 0.0) - middle, int(abs(grain)) - 1);
    }`;
  const fragmentHead = `#version 300 es
    precision highp float;
    precision highp int;
    flat in vec3 tone;
    uniform bool picking;
    out vec4 shown;
    void show(float light, float cover) {
      shown = picking ? vec4(tone, 1.0) : vec4(tone * light * cover, cover);
    }`;
  const pointFragment = fragmentHead + `
    flat in vec3 axis;
    flat in float size, drawn, thick, nearness;
    uniform int form;
    void main() {
      vec2 at = (gl_PointCoord - 0.5) * vec2(2.0, -2.0) * drawn; // [px]
      float height = 0.0, light = 1.0, cover = 1.0;
      if (form == 4) {
        float within = size - length(at);
        cover = clamp(0.5 + within, 0.0, 1.0) * (within < 1.0 + 0.06 * size ? 1.0 : 0.45);
      } else if (form > 1) {
        float length = max(length(axis.xy), 1e-3);
        vec2 line = axis.xy / length;
        vec2 over = abs(vec2(dot(at, line), dot(at, vec2(-line.y, line.x)))) -
                    vec2(size * (form == 2 ? 1.0 : length), max(form == 2 ? 1.0 : 1.3, 0.12 * size));
        cover = clamp(0.5 - over.x, 0.0, 1.0) * clamp(0.5 - over.y, 0.0, 1.0);
      } else {
        at /= size;
        float square = dot(at, at);
        if (form == 0) {
          height = sqrt(max(0.0, 1.0 - square));
          light = 0.42 + 0.62 * max(0.0, dot(vec3(at, height), vec3(-0.37, 0.47, 0.8)));
        } else {
          height = -dot(at, axis.xy) / axis.z;
          square += height * height;
          light = 0.6 + 0.4 * abs(axis.z);
        }
        cover = step(square, 1.0);
      }
      if (cover == 0.0)
        discard;
      gl_FragDepth = 0.5 + 0.5 * (nearness - height * thick);
      show(light, cover);
    }`;
  const facetFragment = fragmentHead + `
    in float rim;
    void main() {
      show(mix(1.0, 0.62, clamp((rim - 1.0) / max(fwidth(rim), 1e-6) + 1.2, 0.0, 1.0)), 1.0);
    }`;

  const box = element("div", parent, {className: "specimen"});
  const header = element("div", box, {className: "header"});
  const frame = element("div", box, {className: "view"});
  const canvas = element("canvas", frame, {tabIndex: 0});
  const gl = canvas.getContext("webgl2", {antialias: !inSpace && !swift}); // four samples a pixel are slow where a processor draws
  if (!gl)
    throw new Error("no WebGL 2");
  canvas.setAttribute("role", "application");
  canvas.setAttribute(
    "aria-label",
    alternative + " Arrow keys turn or move, plus and minus enlarge, 0 shows all, Enter reads what is in the middle.");

  const program = (vertex, fragment) => {
    const made = gl.createProgram();
    for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(made, shader);
    }
    gl.linkProgram(made);
    if (!gl.getProgramParameter(made, gl.LINK_STATUS) && !gl.isContextLost())
      throw new Error(gl.getProgramInfoLog(made) + gl.getShaderInfoLog(gl.getAttachedShaders(made)[0]));
    const at = {};
    for (const name of ["turn", "middle", "zoom", "pan", "pixels", "cut", "extent", "depth", "form", "first", "chosen", "picking", "tones"])
      at[name] = gl.getUniformLocation(made, name);
    return {made, at};
  };
  const ofPoints = program(pointVertex, pointFragment);
  const ofFacets = program(facetVertex, facetFragment);

  const decoded = (text, Kind) =>
    new Kind((Uint8Array.fromBase64?.(text) || Uint8Array.from(atob(text), one => one.charCodeAt(0))).buffer);
  const shares = 65535;
  const grains = {place: decoded(data.grains.place, Uint16Array), moved: decoded(data.grains.moved, Int16Array),
                  stress: decoded(data.grains.stress, Int16Array), fragment: decoded(data.grains.fragment, Uint16Array), tone: decoded(data.grains.tone, Uint8Array)};
  const cracks = {place: decoded(data.cracks.place, Uint16Array), normal: decoded(data.cracks.normal, Int8Array),
                  row: decoded(data.cracks.row, Uint16Array), joint: decoded(data.cracks.joint, Uint32Array), open: decoded(data.cracks.open, Uint16Array)};
  // The largest comes first: smaller ones are drawn over it.
  const events = {place: decoded(data.events.place, Uint16Array), row: decoded(data.events.row, Uint16Array), kind: decoded(data.events.kind, Uint8Array),
                  number: decoded(data.events.number, Uint32Array), breaks: decoded(data.events.breaks, Uint32Array),
                  measures: decoded(data.events.measures, Float32Array)}; // magnitude, extent [mm], energy [mJ]
  const nGrains = grains.fragment.length;
  const nCracks = cracks.row.length;
  const nEvents = events.row.length;
  for (let k = 0; k < nEvents; ++k)
    events.place[4 * k + 3] = (shares * eventRadius(events.measures[3 * k], set.fullSize)) / mostWide;
  const coordinate = (place, k, axis) => data.low[axis] + (data.span * place[4 * k + axis]) / shares; // [mm]

  // Flaws as lines of the same form as cracks, in pieces that a point has room for.
  const pieces = data.flaws.flatMap(flaw => flaw.outline.slice(1).flatMap((to, k) => {
    const from = flaw.outline[k];
    const n = Math.ceil(Math.hypot(...to.map((value, c) => value - from[c])) / (2 * data.radius)) || 1;
    const at = m => from.map((value, c) => value + ((to[c] - value) * m) / n);
    return Array.from({length: n}, (none, m) => [at(m), at(m + 1)]);
  }));
  const flaws = {place: new Uint16Array(4 * pieces.length), along: new Int8Array(4 * pieces.length)};
  pieces.forEach(([from, to], k) => {
    const length = Math.hypot(to[0] - from[0], to[1] - from[1], to[2] - from[2]) || 1;
    for (const c of [0, 1, 2]) {
      flaws.place[4 * k + c] = Math.min(1, Math.max(0, ((from[c] + to[c]) / 2 - data.low[c]) / data.span)) * shares;
      flaws.along[4 * k + c] = (127 * (to[c] - from[c])) / length;
    }
    flaws.place[4 * k + 3] = (length / (2 * data.radius)) * shares;
  });

  // Grains in the plane bounded by their faces, by arcs where there is none: fans of triangles (x, y, number).
  const facets = () => {
    const [rim, gap] = [data.radius / data.span, data.gap / data.span];
    const side = 2 * rim + gap;
    const boxes = new Map();
    const at = Array.from({length: nGrains}, (none, k) => [grains.place[4 * k] / shares, grains.place[4 * k + 1] / shares, (grains.place[4 * k + 3] / shares) * rim]);
    const boxOf = (x, y) => 4096 * (1 + Math.floor(x / side)) + 1 + Math.floor(y / side);
    at.forEach(([x, y], k) => boxes.set(boxOf(x, y), [...(boxes.get(boxOf(x, y)) || []), k]));
    const corners = [];
    let nFaces = 0;
    at.forEach(([x, y, radius], k) => {
      const faces = []; // direction, half the angle, distance
      for (let c = 0; c < 9; ++c)
        for (const other of boxes.get(boxOf(x + ((c % 3) - 1) * side, y + (Math.floor(c / 3) - 1) * side)) || []) {
          const [right, up] = [at[other][0] - x, at[other][1] - y];
          const open = Math.hypot(right, up) - radius - at[other][2];
          if (other !== k && open <= gap) {
            const far = radius + open / 2;
            faces.push([Math.atan2(up, right), Math.atan(Math.min(radius, at[other][2]) / far), far]);
          }
        }
      nFaces += faces.length;
      const whole = 2 * Math.PI;
      const apart = (one, other) => ((one - other + 3 * Math.PI) % whole) - Math.PI; // from -π to π
      const reach = angle => faces.reduce((least, face) => {
        const aside = apart(angle, face[0]);
        return Math.abs(aside) <= face[1] ? Math.min(least, face[2] / Math.cos(aside)) : least;
      }, Infinity);
      // Corners lie at the ends of faces, where two of them meet, and along arcs.
      const angles = Array.from({length: 16}, (none, n) => (n * whole) / 16);
      for (const [one, half, far] of faces) {
        angles.push(one - half, one + half);
        for (const [other, , further] of faces)
          if (other > one)
            angles.push(Math.atan2(further * Math.cos(one) - far * Math.cos(other), far * Math.sin(other) - further * Math.sin(one)),
                        Math.atan2(far * Math.cos(other) - further * Math.cos(one), further * Math.sin(one) - far * Math.sin(other)));
      }
      const sorted = angles.map(angle => (angle + 2 * whole) % whole).sort((one, other) => one - other);
      sorted.forEach((from, n) => {
        const to = n + 1 < sorted.length ? sorted[n + 1] : sorted[0] + whole;
        if (to - from < 1e-5)
          return;
        const inside = (to - from) * 1e-3;
        corners.push(x, y, -(k + 1));
        for (const [angle, within] of [[from, from + inside], [to, to - inside]]) {
          const length = reach(within);
          const far = length === Infinity ? radius : length;
          corners.push(x + far * Math.cos(angle), y + far * Math.sin(angle), k + 1);
        }
      });
    });
    return {corners: new Float32Array(corners), nFaces: nFaces / 2};
  };

  const columns = 2048; // of a texture
  const shapes = (n, ...attributes) => {
    const made = {n, tones: gl.createTexture(), parts: gl.createVertexArray()};
    gl.bindVertexArray(made.parts);
    for (const [values, place, size, type, stride, offset] of attributes) {
      if (values) {
        gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
        gl.bufferData(gl.ARRAY_BUFFER, values, gl.STATIC_DRAW);
      }
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, size, type, type !== gl.FLOAT, stride, offset);
    }
    return made;
  };
  const points = (place, along) =>
    shapes(place.length / 4, [place, 0, 4, gl.UNSIGNED_SHORT, 8, 0], ...(along ? [[along, 1, 4, gl.BYTE, 4, 0]] : []));
  const mostWithFaces = 50000; // triangles of more take long to make
  const fans = !inSpace && nGrains <= mostWithFaces ? facets() : null;
  const drawnGrains = fans ? shapes(fans.corners.length / 3, [fans.corners, 0, 2, gl.FLOAT, 12, 0], [null, 1, 1, gl.FLOAT, 12, 8]) : points(grains.place);
  const drawnCracks = points(cracks.place, cracks.normal);
  const drawnFlaws = points(flaws.place, flaws.along);
  const drawnEvents = points(events.place);

  // Colours.
  const movedBy = k => (Math.hypot(grains.moved[3 * k], grains.moved[3 * k + 1], grains.moved[3 * k + 2]) * data.grains.most_moved) / 32767; // [mm]
  // Single grains that flew off, or are pressed by a platen, would leave one colour for all others.
  const quantile = values => {
    let found = 0;
    return () => (found ||= values().sort().findLast((value, k, all) => k <= 0.98 * (all.length - 1)) || 1);
  };
  const typicalMotion = quantile(() => Float32Array.from({length: nGrains}, (none, k) => movedBy(k)));
  const sizes = new Map();
  for (const piece of grains.fragment)
    sizes.set(piece, (sizes.get(piece) || 0) + 1);
  const {isDark, plain, kindTones, pieceTones} = specimenTones(dark);
  const stressOf = k => (grains.stress[k] * data.grains.most_stress) / 32767; // [MPa]
  const typicalStress = quantile(() => Float32Array.from(grains.stress, (none, k) => Math.abs(stressOf(k))));
  const grainColours = {
    plain: () => plain,
    "mineral grain": k => [...grains.tone.subarray(3 * k, 3 * k + 3)].map(value => (isDark ? 0.55 : 1) * value),
    fragment: k => {
      const piece = grains.fragment[k];
      return piece === 0 ? plain : sizes.get(piece) === 1 ? singleGrain : pieceTones[piece % pieceTones.length];
    },
    displacement: k => onRamp(movedBy(k) / typicalMotion()),
    stress: k => onRamp(0.5 + (0.5 * stressOf(k)) / typicalStress(), bothWays),
  };
  const openBy = k => (cracks.open[k] * data.cracks.most_open) / shares; // [µm]
  const typicalOpening = quantile(() => Float32Array.from(cracks.open, (none, k) => openBy(k)));
  const isShear = k => cracks.normal[4 * k + 3] === 1;
  const ofKind = k => kindTones[cracks.normal[4 * k + 3]];
  const crackColours = {
    kind: ofKind,
    strain: k => onRamp(cracks.row[k] / (data.rows.length - 1)),
    opening: k => onRamp(openBy(k) / typicalOpening()),
    tension: k => (isShear(k) ? null : ofKind(k)),
    shear: k => (isShear(k) ? ofKind(k) : null),
  };
  const eventColours = {
    strain: k => onRamp(events.row[k] / (data.rows.length - 1)),
    mechanism: k => kindTones[events.kind[k]],
  };
  const colourAll = (shape, n, colourOf) => {
    const rows = Math.max(1, Math.ceil(n / columns));
    const tones = new Uint8Array(4 * columns * rows);
    for (let k = 0; k < n; ++k) {
      const tone = colourOf(k);
      if (tone)
        tones.set([...tone, 255], 4 * k);
    }
    gl.bindTexture(gl.TEXTURE_2D, shape.tones);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, columns, rows, 0, gl.RGBA, gl.UNSIGNED_BYTE, tones);
  };

  let highest = 0;
  data.rows.forEach((row, k) => {
    if (row[1] > data.rows[highest][1])
      highest = k;
  });
  // Way of the strain up to each row, as a share of that up to the peak: it grows where the strain goes back, too.
  const way = data.rows.map(() => 0);
  for (let k = 1; k < way.length; ++k)
    way[k] = way[k - 1] + Math.abs(data.rows[k][0] - data.rows[k - 1][0]);
  const whole_way = way[highest] || way.at(-1) || 1;
  const course = way.map(value => value / whole_way);
  let shown = data.rows.length - 1, chosen = 0;

  // Limits, in shares of the box.
  const high = [0, 0, 0];
  for (let k = 0; k < nGrains; ++k)
    for (const c of [0, 1, 2])
      high[c] = Math.max(high[c], grains.place[4 * k + c] / shares);
  const rim = data.radius / data.span;
  const middle = high.map(value => value / 2);
  const reach = Math.hypot(...middle) + rim;
  const turned = () => {
    const [ca, sa, ce, se] = [Math.cos(set.azimuth), Math.sin(set.azimuth), Math.cos(set.elevation), Math.sin(set.elevation)];
    return [[ca, sa, 0], [-sa * se, ca * se, ce], [sa * ce, -ca * ce, se]]; // to the right, upwards, to the reader
  };
  const unit = () => { // CSS pixels of the whole box at the present size
    const axes = turned();
    const half = axes.slice(0, 2).map(axis => axis.reduce((sum, value, c) => sum + Math.abs(value) * middle[c], rim));
    return set.zoom * Math.min((canvas.clientWidth - 8) / 2 / half[0], (canvas.clientHeight - 8) / 2 / half[1]);
  };
  const nBroken = () => {
    let n = nCracks;
    while (n > 0 && cracks.row[n - 1] > shown)
      --n;
    return n;
  };

  const paint = picking => {
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    const size = unit();
    // A point is left out where its middle is: the picture begins and ends one shape beyond the canvas.
    const pixels = canvas.width / width, shape = Math.max(rim, data.size / data.span);
    const beyond = Math.ceil(Math.max(shape * size, set.emission === "hidden" ? 0 : mostWide)) + 4;
    gl.viewport(-beyond * pixels, -beyond * pixels, canvas.width + 2 * beyond * pixels, canvas.height + 2 * beyond * pixels);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    (inSpace ? gl.enable : gl.disable).call(gl, gl.DEPTH_TEST);
    (inSpace || picking ? gl.disable : gl.enable).call(gl, gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    const axes = turned();
    const axis = "xyz".indexOf(set.cut);
    const outwards = axis < 0 ? 0 : axes[2][axis] > 0 ? 1 : -1; // the half towards the reader is taken away
    const show = (one, shape, n, first, form, extent, margin) => {
      gl.useProgram(one.made);
      gl.uniformMatrix3fv(one.at.turn, true, axes.flat());
      gl.uniform3fv(one.at.middle, middle);
      gl.uniform2f(one.at.zoom, size / (width / 2 + beyond), size / (height / 2 + beyond));
      gl.uniform2f(one.at.pan, set.pan[0] / (width / 2 + beyond), set.pan[1] / (height / 2 + beyond));
      gl.uniform1f(one.at.pixels, size * pixels);
      gl.uniform4fv(one.at.cut, [...[0, 1, 2].map(c => (c === axis ? outwards : 0)), outwards ? margin : 1]);
      gl.uniform1f(one.at.extent, extent);
      gl.uniform1f(one.at.depth, 0.99 / reach);
      gl.uniform1i(one.at.form, form);
      gl.uniform1ui(one.at.first, first);
      gl.uniform1ui(one.at.chosen, chosen);
      gl.uniform1i(one.at.picking, picking);
      gl.bindTexture(gl.TEXTURE_2D, shape.tones);
      gl.bindVertexArray(shape.parts);
      gl.drawArrays(one === ofFacets ? gl.TRIANGLES : gl.POINTS, 0, n);
    };
    if (set.grains !== "hidden")
      show(fans ? ofFacets : ofPoints, drawnGrains, drawnGrains.n, 0, 0, rim, 0);
    if (!picking)
      show(ofPoints, drawnFlaws, drawnFlaws.n, 0, 3, 2 * rim, 0);
    // Those at the cut are seen.
    if (set.cracks !== "hidden")
      show(ofPoints, drawnCracks, nBroken(), nGrains, inSpace ? 1 : 2, data.size / data.span, 0.5 * rim);
    if (set.emission !== "hidden") {
      gl.disable(gl.DEPTH_TEST);
      (picking ? gl.disable : gl.enable).call(gl, gl.BLEND);
      show(ofPoints, drawnEvents, nEvents, nGrains + nCracks, 4, mostWide / size, 0.5 * rim);
    }
  };

  // The picture of numbers, of the whole canvas: 0 where there is nothing.
  const numbers = (x, y, width, height) => {
    const target = gl.createFramebuffer();
    const layers = [[gl.COLOR_ATTACHMENT0, gl.RGBA8], [gl.DEPTH_ATTACHMENT, gl.DEPTH_COMPONENT24]].map(([where, format]) => {
      const layer = gl.createRenderbuffer();
      gl.bindRenderbuffer(gl.RENDERBUFFER, layer);
      gl.renderbufferStorage(gl.RENDERBUFFER, format, canvas.width, canvas.height);
      gl.bindFramebuffer(gl.FRAMEBUFFER, target);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, where, gl.RENDERBUFFER, layer);
      return layer;
    });
    paint(true);
    const bytes = new Uint8Array(4 * width * height);
    gl.readPixels(x, y, width, height, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    layers.forEach(layer => gl.deleteRenderbuffer(layer));
    gl.deleteFramebuffer(target);
    return Array.from({length: width * height}, (none, k) => bytes[4 * k] + 256 * bytes[4 * k + 1] + 65536 * bytes[4 * k + 2]);
  };

  // What stands around the canvas.
  const title = element("span", header, {className: "entry"});
  element("span", title, {className: "chip"}).style.background = tone;
  title.append(data.title);
  const scale = element("span", header, {className: "scale"});
  const arrows = inSpace ? element("canvas", frame, {className: "arrows"}) : null;
  const output = element("output", box);

  const describeAxes = () => {
    const size = unit() / data.span; // [px/mm]
    const length = [100, 50, 20, 10, 5, 2, 1, 0.5, 0.2, 0.1].find(one => one * size <= 80) || 0.05;
    scale.style.width = `${length * size}px`;
    scale.textContent = `${length} mm`;
    if (!arrows)
      return;
    const pen = arrows.getContext("2d");
    const pixels = devicePixelRatio || 1;
    arrows.width = arrows.height = 64 * pixels;
    pen.scale(pixels, pixels);
    pen.strokeStyle = pen.fillStyle = theme("--text");
    pen.font = "12px system-ui, sans-serif";
    pen.textAlign = "center";
    const axes = turned();
    for (const c of [0, 1, 2]) {
      const [x, y] = [axes[0][c], -axes[1][c]];
      if (Math.hypot(x, y) < 0.1)
        continue;
      pen.beginPath();
      pen.moveTo(32, 32);
      pen.lineTo(32 + 18 * x, 32 + 18 * y);
      pen.stroke();
      pen.fillText("xyz"[c], 32 + 26 * x, 36 + 26 * y);
    }
  };
  const draw = () => {
    const pixels = devicePixelRatio || 1;
    const [width, height] = [Math.round(canvas.clientWidth * pixels), Math.round(canvas.clientHeight * pixels)];
    if (canvas.width !== width || canvas.height !== height)
      Object.assign(canvas, {width, height});
    paint(false);
    describeAxes();
    const row = data.rows[shown];
    const short = value => digits(value && Number(value.toPrecision(3)));
    output.textContent = `${short(row[1])} MPa at ${short(row[0])}·10⁻³; broken: ${row[2]} tension, ${row[3]} shear`;
  };
  const colourEvents = () => {
    if (set.emission !== "hidden")
      colourAll(drawnEvents, nEvents, k => (events.row[k] > shown ? null : eventColours[set.emission](k)));
  };
  const colour = () => {
    if (set.grains !== "hidden")
      colourAll(drawnGrains, nGrains, grainColours[set.grains]);
    if (set.cracks !== "hidden")
      colourAll(drawnCracks, nCracks, crackColours[set.cracks]);
    colourEvents();
  };
  const standAt = row => {
    shown = row;
    colourEvents();
    draw();
  };

  const millimetres = (place, k) => `(${(inSpace ? [0, 1, 2] : [0, 1]).map(axis => digits(coordinate(place, k, axis))).join(", ")}) mm`;
  const read = id => {
    chosen = id;
    const k = id - 1 - (id > nGrains + nCracks ? nGrains + nCracks : id > nGrains ? nGrains : 0);
    if (id === 0)
      tell("");
    else if (id <= nGrains)
      tell(`Grain ${k * data.grains.every + 1} at ${millimetres(grains.place, k)}: radius ${digits((grains.place[4 * k + 3] / shares) * data.radius)} mm, ` +
        `displacement at the end ${digits(movedBy(k))} mm, ` +
        (grains.stress.length ? `mean stress at the highest load ${digits(stressOf(k))} MPa, ` : "") +
        (grains.fragment[k] ? `fragment ${grains.fragment[k]} of ${sizes.get(grains.fragment[k])} grains.` : "in the largest piece."));
    else if (id > nGrains + nCracks)
      tell(`Event ${events.number[k]}, ${["tensile", "shear", "implosive"][events.kind[k]]}, at ${millimetres(events.place, k)}: ` +
        `magnitude ${digits(events.measures[3 * k])}, ${data.strain} ${digits(data.rows[events.row[k]][0])}, breaks ${events.breaks[k]}, ` +
        `extent ${digits(events.measures[3 * k + 1])} mm, energy ${digits(events.measures[3 * k + 2])} mJ.`);
    else
      tell(`Crack ${k * data.cracks.every + 1}, ${isShear(k) ? "shear" : "tension"}, of joint ${cracks.joint[k]} at ${millimetres(cracks.place, k)}: ` +
        `size ${digits((cracks.place[4 * k + 3] / shares) * data.size)} mm, ${data.strain} ${digits(data.rows[cracks.row[k]][0])}, opening at the end ${digits(openBy(k))} µm.`);
    draw();
  };
  const pick = (x, y) => {
    // The nearest to the pointer: a trace is some two pixels wide.
    const pixels = devicePixelRatio || 1, around = Math.round(3 * pixels), side = 2 * around + 1;
    const seen = numbers(Math.round(x * pixels) - around, Math.round(canvas.height - y * pixels) - around, side, side);
    const distance = k => Math.hypot((k % side) - around, Math.floor(k / side) - around);
    let best = seen[around * side + around];
    let least = Infinity;
    seen.forEach((id, k) => {
      if (id > nGrains && distance(k) < least)
        [best, least] = [id, distance(k)];
    });
    read(best);
  };

  // How it is moved.
  const move = (right, up) => {
    set.pan[0] += right;
    set.pan[1] += up;
  };
  const rotate = (right, up) => {
    set.azimuth -= right;
    set.elevation = Math.min(Math.PI / 2, Math.max(-Math.PI / 2, set.elevation + up));
  };
  const enlarge = factor => {
    const before = set.zoom;
    // No shape is larger than the largest point.
    const most = (set.zoom / unit()) * Math.min(1024, gl.getParameter(gl.ALIASED_POINT_SIZE_RANGE)[1]) / (devicePixelRatio || 1) / 2.2;
    set.zoom = Math.min(most / Math.max(rim, data.size / data.span), Math.max(0.5, set.zoom * factor));
    set.pan = set.pan.map(value => (value * set.zoom) / before);
    anew();
  };
  const view = (azimuth, elevation) => {
    Object.assign(set, {azimuth, elevation, zoom: 1, pan: [0, 0]});
    anew();
  };
  const whole = () => view(inSpace ? -0.45 : 0, inSpace ? 0.3 : Math.PI / 2);
  let held = null;
  canvas.addEventListener("pointerdown", event => {
    held = {x: event.clientX, y: event.clientY, far: 0};
    if (event.isTrusted)
      canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", event => {
    if (!held)
      return;
    const [right, down] = [event.clientX - held.x, event.clientY - held.y];
    held = {x: event.clientX, y: event.clientY, far: held.far + Math.hypot(right, down)};
    if (inSpace && !event.shiftKey)
      rotate(right / 150, down / 150);
    else
      move(right, -down);
    requestAnimationFrame(anew);
  });
  canvas.addEventListener("pointerup", event => {
    if (held && held.far < 4) {
      const place = canvas.getBoundingClientRect();
      pick(event.clientX - place.left, event.clientY - place.top);
    }
    held = null;
  });
  canvas.addEventListener("pointercancel", () => (held = null));
  canvas.addEventListener("wheel", event => {
    if (!event.ctrlKey)
      return; // the page scrolls
    event.preventDefault();
    enlarge(Math.exp(-event.deltaY / 300));
  }, {passive: false});
  canvas.addEventListener("keydown", event => {
    const step = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]}[event.key];
    if (step && inSpace && !event.shiftKey)
      rotate(step[0] * 0.1, -step[1] * 0.1);
    else if (step)
      move(-24 * step[0], -24 * step[1]);
    else if (event.key === "+" || event.key === "=")
      enlarge(1.25);
    else if (event.key === "-")
      enlarge(0.8);
    else if (event.key === "0")
      whole();
    else if (event.key === "Enter")
      pick(canvas.clientWidth / 2, canvas.clientHeight / 2);
    else
      return;
    event.preventDefault();
    anew();
  });

  colourAll(drawnFlaws, pieces.length, () => (isDark ? [230, 233, 236] : [27, 31, 36]));
  colour();
  // As wide as there is room for, as high as the specimen asks for.
  canvas.style.aspectRatio = `${Math.max(0.3, Math.min(2, (high[0] + 2 * rim) / (high[inSpace ? 2 : 1] + 2 * rim)))}`;
  const watch = new ResizeObserver(draw);
  watch.observe(canvas);
  draw();
  if (fans)
    canvas.dataset.faces = fans.nFaces;
  canvas.dataset.firstFrame = Math.round(performance.now() - begun); // [ms]
  canvas.addEventListener("webglcontextlost", lose);
  // For tests: how many grains, cracks and events have a pixel.
  canvas.countSeen = () => {
    const seen = new Set(numbers(0, 0, canvas.width, canvas.height));
    seen.delete(0);
    const upTo = last => [...seen].filter(id => id <= last).length;
    return [upTo(nGrains), upTo(nGrains + nCracks) - upTo(nGrains), seen.size - upTo(nGrains + nCracks)];
  };
  // For tests: the place of a grain on the canvas, of which the first is 1, or of an event.
  canvas.placeOf = (id, isEvent) => {
    const at = [0, 1, 2].map(c => (isEvent ? events : grains).place[4 * (id - 1) + c] / shares - middle[c]);
    const [x, y] = turned().map(axis => axis.reduce((sum, value, c) => sum + value * at[c], 0) * unit());
    return [canvas.clientWidth / 2 + set.pan[0] + x, canvas.clientHeight / 2 - set.pan[1] - y];
  };
  return {
    draw, colour, view, whole, enlarge, course, typicalMotion, typicalStress, typicalOpening,
    hasStress: grains.stress.length > 0,
    hasMinerals: grains.tone.length > 0,
    // Shows the last row up to a share of the strain at the peak. Returns the row.
    go(share) {
      let row = 0;
      while (row + 1 < course.length && course[row + 1] <= share + 1e-9)
        ++row;
      standAt(row);
      return data.rows[row];
    },
    showRow: row => standAt(Math.min(row, data.rows.length - 1)),
    end() {
      watch.disconnect();
      canvas.removeEventListener("webglcontextlost", lose);
      gl.getExtension("WEBGL_lose_context")?.loseContext();
    },
  };
};
