"use strict";
// The bodies in 3D: one set of points; displacements and a field are attributes that change with time.
report.attempt(async () => {
  const model = report.meta.model;
  if (!model) return;
  const { element, number } = report;
  const by = (id) => document.getElementById(id);
  const canvas = by("canvas");
  await report.library("three");
  let renderer;
  try {
    renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
  } catch (e) {
    report.trouble("The 3D view needs WebGL, which this browser does not give. `stickslip plot` makes pictures without it.");
    by("view").hidden = true;
    return;
  }

  const n = model.points;
  const NOTHING = -32768;
  const [positions, triangles, edges, owner] = [
    await report.singles("positions"), await report.indices("triangles"), await report.indices("edges"), await report.indices("owner"),
  ];
  const motion = model.motion ? await report.shorts("motion") : null;
  const flat = model.dim === 2;
  const frames = model.times.length;
  const columns = new Map();
  const column = async (field) => {
    if (!columns.has(field.key)) columns.set(field.key, await report.shorts(field.key));
    return columns.get(field.key);
  };
  const back = (range, q) => range[0] + ((range[1] - range[0]) * (q + 32767)) / 65534;

  // Attributes shared by all bodies.
  const dynamic = (size) => new THREE.BufferAttribute(new Float32Array(size * n), size);
  const attributes = { position: new THREE.BufferAttribute(positions, 3), motion: dynamic(3), datum: dynamic(2) };

  const ramp = (anchors) => {
    const width = 256, data = new Uint8Array(4 * width);
    for (let i = 0; i < width; i++) {
      const x = (i / (width - 1)) * (anchors.length - 1), k = Math.min(Math.floor(x), anchors.length - 2), f = x - k;
      for (let c = 0; c < 3; c++) data[4 * i + c] = Math.round(anchors[k][c] + f * (anchors[k + 1][c] - anchors[k][c]));
      data[4 * i + 3] = 255;
    }
    const texture = new THREE.DataTexture(data, width, 1, THREE.RGBAFormat);
    texture.needsUpdate = true;
    return texture;
  };
  const ramps = { ordered: ramp(model.ordered), signed: ramp(model.signed), carried: ramp(model.carried) };
  const rgb = (c) => new THREE.Vector3(c[0] / 255, c[1] / 255, c[2] / 255);
  const uniforms = {
    factor: { value: 1 }, ramp: { value: ramps.ordered }, status: { value: 0 }, lit: { value: flat ? 0 : 1 }, nothing: { value: rgb(model.nothing) },
    first: { value: rgb(model.statuses[0].colour) }, second: { value: rgb(model.statuses[1].colour) }, third: { value: rgb(model.statuses[2].colour) },
    ink: { value: new THREE.Vector3() }, soft: { value: new THREE.Vector3() }, strength: { value: 0.35 }, dot: { value: 9 },
  };
  // A status is no number between others: the corner that is nearest decides.
  const vertex = `
    attribute vec3 motion; attribute vec2 datum; uniform float factor; uniform float dot;
    varying vec2 vDatum; varying vec3 vStatus; varying vec3 vPlace;
    void main() {
      vDatum = datum;
      vStatus = vec3(datum.x < 0.5, datum.x >= 0.5 && datum.x < 1.5, datum.x >= 1.5) * datum.y;
      vec4 at = modelViewMatrix * vec4(position + factor * motion, 1.0);
      vPlace = at.xyz;
      gl_PointSize = datum.y > 0.5 ? dot : 0.0;
      gl_Position = projectionMatrix * at;
    }`;
  const colouring = `
    uniform sampler2D ramp; uniform int status; uniform vec3 nothing, first, second, third;
    varying vec2 vDatum; varying vec3 vStatus; varying vec3 vPlace;
    vec3 colouring() {
      if (vDatum.y < 0.999) return nothing;
      if (status == 1) return vStatus.x >= max(vStatus.y, vStatus.z) ? first : vStatus.y >= vStatus.z ? second : third;
      return texture2D(ramp, vec2((clamp(vDatum.x, 0.0, 1.0) * 255.0 + 0.5) / 256.0, 0.5)).rgb;
    }`;
  const surface = new THREE.ShaderMaterial({
    uniforms, vertexShader: vertex, side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
    fragmentShader: colouring + `uniform float lit;
    void main() {
      vec3 normal = normalize(cross(dFdx(vPlace), dFdy(vPlace)));
      float light = mix(1.0, 0.70 + 0.26 * abs(normal.z) + 0.06 * normal.y * sign(normal.z), lit);
      gl_FragColor = vec4(colouring() * light, 1.0);
    }`,
  });
  const lines = new THREE.ShaderMaterial({
    uniforms, vertexShader: vertex, transparent: true, depthWrite: false,
    fragmentShader: "uniform vec3 ink; uniform float strength; varying vec2 vDatum; varying vec3 vStatus; varying vec3 vPlace; void main() { gl_FragColor = vec4(ink, strength); }",
  });
  const dots = new THREE.ShaderMaterial({
    uniforms, vertexShader: vertex, depthTest: false, transparent: true,
    fragmentShader: colouring + `
    void main() {
      float r = length(gl_PointCoord - 0.5);
      if (r > 0.5 || vDatum.y < 0.5) discard;
      gl_FragColor = vec4(r > 0.43 ? colouring() * 0.35 : colouring(), 1.0);
    }`,
  });

  const scene = new THREE.Scene();
  const geometry = (index) => {
    const made = new THREE.BufferGeometry();
    for (const [name, attribute] of Object.entries(attributes)) made.setAttribute(name, attribute);
    made.setIndex(new THREE.BufferAttribute(index, 1));
    return made;
  };
  const bodies = [];
  let from = [0, 0];
  model.ends.forEach((end, i) => {
    if (end[0] > from[0]) {
      const group = new THREE.Group();
      const own = triangles.subarray(3 * from[0], 3 * end[0]);
      const mesh = new THREE.Mesh(geometry(own), surface);
      const wire = new THREE.LineSegments(geometry(edges.subarray(2 * from[1], 2 * end[1])), lines);
      const points = Uint32Array.from(new Set(own));
      const marks = new THREE.Points(geometry(points), dots);
      wire.renderOrder = 1;
      marks.renderOrder = 2;
      const centre = new THREE.Vector3();
      for (const p of points) centre.add(new THREE.Vector3().fromArray(positions, 3 * p));
      centre.divideScalar(points.length);
      for (const part of [mesh, wire, marks]) {
        part.frustumCulled = false;
        group.add(part);
      }
      marks.visible = false;
      scene.add(group);
      bodies.push({ name: model.bodies[i] || "body " + (i + 1), number: i, group, wire, marks, points, own, centre });
    }
    from = end;
  });

  // Obstacles are lines. They move by the same factor as the bodies.
  let shift = null, shifts = null;
  if (model.obstacles.any) {
    const places = await report.singles("obstacles");
    const made = new THREE.BufferGeometry();
    shift = new THREE.BufferAttribute(new Float32Array(places.length), 3);
    made.setAttribute("position", new THREE.BufferAttribute(places, 3));
    made.setAttribute("motion", shift);
    made.setAttribute("datum", new THREE.BufferAttribute(new Float32Array((2 * places.length) / 3), 2));
    made.setIndex(new THREE.BufferAttribute(await report.indices("obstacle-lines"), 1));
    if (model.obstacles.move) shifts = await report.singles("obstacle-motion");
    const bold = lines.clone();
    bold.uniforms = { ...uniforms, strength: { value: 0.85 }, ink: uniforms.soft };
    const wire = new THREE.LineSegments(made, bold);
    wire.frustumCulled = false;
    scene.add(wire);
  }

  // The camera, without perspective, so that lengths can be compared.
  const radius = Math.max(model.size / 2, 1e-30);
  const camera = new THREE.OrthographicCamera(-1, 1, 1, -1, 0, 20 * radius);
  const controls = new THREE.OrbitControls(camera, canvas);
  controls.enableDamping = false;
  controls.minZoom = 0.05;
  controls.maxZoom = 5000;
  if (flat) {
    controls.enableRotate = false;
    controls.mouseButtons.LEFT = 2;
    controls.touches.ONE = 1;
  }
  let queued = false;
  const draw = () => {
    if (queued) return;
    queued = true;
    requestAnimationFrame(() => {
      queued = false;
      renderer.render(scene, camera);
      axes();
      canvas.dataset.drawn = String(Number(canvas.dataset.drawn || 0) + 1);
    });
  };
  controls.addEventListener("change", draw);

  function fit() {
    const stage = canvas.parentElement;
    const w = stage.clientWidth, h = stage.clientHeight;
    renderer.setPixelRatio(Math.min(devicePixelRatio || 1, 2));
    renderer.setSize(w, h, false);
    uniforms.dot.value = (flat ? 8 : 7) * renderer.getPixelRatio();
    const half = extent();
    // The colour bar stands at the right, and the bodies keep to the rest; on a narrow page it stands below.
    const bar = getComputedStyle(by("bar")).position === "static" ? 0 : Math.min(210, 0.3 * w);
    const tall = Math.max(half.y, (half.x * h) / (w - bar)) * 1.12;
    camera.top = tall;
    camera.bottom = -tall;
    camera.right = (tall * w) / h;
    camera.left = -camera.right;
    camera.setViewOffset(w, h, bar / 2, 0, w, h);
    camera.updateProjectionMatrix();
    draw();
  }

  // Half of the width and height of the model as the camera sees it.
  function extent() {
    if (!camera.userData.half) return { x: radius, y: radius };
    return camera.userData.half;
  }

  const up = (direction) => (Math.abs(direction.z) > 0.99 || flat ? new THREE.Vector3(0, 1, 0) : new THREE.Vector3(0, 0, 1));
  function look(direction) {
    const d = new THREE.Vector3(...direction).normalize();
    const target = new THREE.Vector3();
    const box = new THREE.Box3();
    const at = new THREE.Vector3();
    for (const body of bodies) {
      if (!body.group.visible) continue;
      for (const p of body.points) {
        at.fromArray(positions, 3 * p).add(body.group.position);
        box.expandByPoint(at);
      }
    }
    if (!box.isEmpty()) box.getCenter(target);
    camera.up.copy(up(d));
    controls.target.copy(target);
    camera.position.copy(target).addScaledVector(d, 8 * radius);
    camera.zoom = 1;
    camera.lookAt(target);
    camera.updateMatrixWorld();
    // What the picture has to hold.
    const half = { x: 1e-9 * radius, y: 1e-9 * radius };
    for (const body of bodies) {
      if (!body.group.visible) continue;
      for (const p of body.points) {
        at.fromArray(positions, 3 * p).add(body.group.position).applyMatrix4(camera.matrixWorldInverse);
        half.x = Math.max(half.x, Math.abs(at.x));
        half.y = Math.max(half.y, Math.abs(at.y));
      }
    }
    camera.userData.half = half;
    fit();
    controls.update();
    draw();
  }

  // Three arrows in the corner.
  function axes() {
    const svg = by("axes");
    const parts = [];
    for (const [i, name] of ["x", "y", "z"].entries()) {
      const d = new THREE.Vector3(i === 0 ? 1 : 0, i === 1 ? 1 : 0, i === 2 ? 1 : 0).transformDirection(camera.matrixWorldInverse);
      if (flat && i === 2) continue;
      parts.push({ name, d, ink: ["#d1495b", "#2f9e63", "#3b7dd8"][i] });
    }
    parts.sort((a, b) => a.d.z - b.d.z);
    svg.innerHTML = parts.map(({ name, d, ink }) => `<line x1="0" y1="0" x2="${(24 * d.x).toFixed(1)}" y2="${(-24 * d.y).toFixed(1)}" stroke="${ink}" stroke-width="3" stroke-linecap="round"/>`
      + `<text x="${(33 * d.x).toFixed(1)}" y="${(-33 * d.y + 4).toFixed(1)}" text-anchor="middle">${name}</text>`).join("");
  }

  // What is shown.
  const opening = Math.max(0, Math.min(frames - 1, model.start ?? frames - 1));
  const state = { frame: opening, field: null, factor: model.scale, values: null, playing: null, mode: null, phase: 0 };
  // A mode is seen at so many phases.
  const STEPS = 72;

  // Displacements Re(φ e^(iθ)) of the mode, whose largest amplitude is one.
  function swing() {
    const { values, range, parts } = state.mode;
    const angle = (2 * Math.PI * state.phase) / STEPS, c = Math.cos(angle), s = parts === 2 ? Math.sin(angle) : 0;
    const out = attributes.motion.array;
    for (let i = 0; i < 3 * n; i++) out[i] = c * back(range, values[i]) - (s === 0 ? 0 : s * back(range, values[3 * n + i]));
    attributes.motion.needsUpdate = true;
    if (shifts) {
      shift.array.fill(0);
      shift.needsUpdate = true;
    }
  }

  // The amplitude of the mode at a point.
  function amplitude(p) {
    const { values, range, parts } = state.mode;
    let sum = 0;
    for (let k = 0; k < parts; k++) {
      for (let c = 0; c < 3; c++) sum += back(range, values[3 * (k * n + p) + c]) ** 2;
    }
    return Math.sqrt(sum);
  }

  function move() {
    if (state.mode) return swing();
    const out = attributes.motion.array;
    if (motion) {
      const offset = 3 * n * state.frame;
      for (let i = 0; i < 3 * n; i++) out[i] = back(model.motion, motion[offset + i]);
    }
    attributes.motion.needsUpdate = true;
    if (shifts) {
      const size = shift.array.length;
      shift.array.set(shifts.subarray(size * state.frame, size * (state.frame + 1)));
      shift.needsUpdate = true;
    }
  }

  function colours() {
    if (state.mode) {
      const out = attributes.datum.array;
      for (let p = 0; p < n; p++) {
        out[2 * p] = amplitude(p);
        out[2 * p + 1] = 1;
      }
      attributes.datum.needsUpdate = true;
      uniforms.status.value = 0;
      uniforms.ramp.value = ramps.ordered;
      for (const body of bodies) body.marks.visible = false;
      bar({ label: "amplitude of the mode" }, [0, 1], false, 1, 0);
      return;
    }
    const { field, values } = state;
    if (!field) return;
    const offset = n * state.frame;
    const out = attributes.datum.array;
    let low = Infinity, high = -Infinity;
    for (let i = 0; i < n; i++) {
      const q = values[offset + i];
      if (q === NOTHING) continue;
      const v = back(field.range, q);
      low = Math.min(low, v);
      high = Math.max(high, v);
    }
    let span = field.span, signed = field.signed;
    if (by("own-range").checked && low <= high && !field.status) {
      const wide = Math.max(Math.abs(low), Math.abs(high));
      signed = low < -0.05 * wide && high > 0.05 * wide;
      span = signed ? [-wide, wide] : [field.carried ? Math.min(0, low) : low, high];
    }
    const width = span[1] - span[0];
    for (let i = 0; i < n; i++) {
      const q = values[offset + i];
      out[2 * i + 1] = q === NOTHING ? 0 : 1;
      if (q === NOTHING) continue;
      const v = back(field.range, q);
      out[2 * i] = field.status ? Math.round(v) : width > 0 ? (v - span[0]) / width : 0.5;
    }
    attributes.datum.needsUpdate = true;
    uniforms.status.value = field.status ? 1 : 0;
    uniforms.ramp.value = signed ? ramps.signed : field.carried ? ramps.carried : ramps.ordered;
    for (const body of bodies) body.marks.visible = flat && field.partial;
    bar(field, span, signed, low, high);
  }

  function bar(field, span, signed, low, high) {
    const place = by("bar");
    place.textContent = "";
    place.append(element("div", { class: "name" }, field.label));
    const css = (c) => `rgb(${c.join(",")})`;
    const key = (c, words) => {
      const swatch = element("span", { class: "swatch" });
      swatch.style.background = css(c);
      return element("div", { class: "key" }, swatch, words);
    };
    if (field.status) {
      // Contact points as the run has counted them: nodes of both sides would be more.
      const counts = model.counts[state.frame];
      model.statuses.forEach((s, i) => place.append(key(s.colour, counts ? `${s.name} (${counts[i]})` : s.name)));
    } else {
      const anchors = signed ? model.signed : field.carried ? model.carried : model.ordered;
      const ramp = element("div", { class: "ramp" });
      ramp.style.background = `linear-gradient(to top, ${anchors.map(css).join(", ")})`;
      const ticks = element("div", { class: "ticks" });
      for (let i = 4; i >= 0; i--) ticks.append(element("span", {}, number(span[0] + ((span[1] - span[0]) * i) / 4)));
      place.append(element("div", { class: "scale" }, ramp, ticks));
      if (low <= high) place.append(element("div", { class: "now" }, `now ${number(low)} to ${number(high)}`));
    }
    if (field.partial) place.append(key(model.nothing, "no value"));
  }

  function show(frame) {
    state.frame = Math.max(0, Math.min(frames - 1, frame));
    by("frame").value = String(state.frame);
    const words = `time ${number(model.times[state.frame], 5)} (${state.frame + 1} of ${frames})`;
    by("frame-time").textContent = words;
    by("frame").setAttribute("aria-valuetext", words);
    move();
    colours();
    draw();
  }

  function turn(phase) {
    state.phase = ((phase % STEPS) + STEPS) % STEPS;
    by("frame").value = String(state.phase);
    const words = `phase ${(360 / STEPS) * state.phase}°`;
    by("frame-time").textContent = words;
    by("frame").setAttribute("aria-valuetext", words);
    swing();
    draw();
  }

  // A mode in place of the displacements over time; none brings these back.
  const shapes = new Map();
  async function pick(index) {
    play(false);
    const mode = model.modes[index];
    if (mode && !shapes.has(mode.key)) shapes.set(mode.key, await report.shorts(mode.key));
    const values = mode && shapes.get(mode.key);
    state.mode = mode ? { ...mode, values } : null;
    const slider = by("frame");
    slider.max = String(mode ? STEPS - 1 : frames - 1);
    slider.disabled = by("play").disabled = !mode && frames < 2;
    by("parts").hidden = !mode;
    by("field").disabled = Boolean(mode);
    const factor = mode ? Number((0.05 * model.size).toPrecision(2)) : model.scale;
    by("factor").value = String(factor);
    setFactor(factor);
    if (!mode) return show(state.frame);
    colours();
    turn(0);
  }

  async function choose(name) {
    const field = model.fields.find((f) => f.name === name) || model.fields[0];
    if (!field) return;
    const values = await column(field);
    state.field = field;
    state.values = values;
    by("field").value = field.name;
    colours();
    draw();
  }

  function play(on) {
    clearInterval(state.playing);
    state.playing = null;
    if (on && state.mode) {
      state.playing = setInterval(() => turn(state.phase + 1), 40);
    } else if (on && frames > 1) {
      if (state.frame === frames - 1) show(0);
      // A run takes about five seconds, but no more than twenty pictures a second are made.
      const step = Math.max(1, Math.ceil(frames / 100));
      const pause = Math.max(50, Math.min(400, (5000 * step) / frames));
      state.playing = setInterval(() => {
        show(state.frame >= frames - 1 ? 0 : state.frame + step);
      }, pause);
    }
    by("play").textContent = state.playing ? "❚❚" : "▶";
    by("play").setAttribute("aria-label", state.playing ? "Pause" : "Play");
  }

  function apart() {
    const gap = Number(by("gap").value);
    const middle = new THREE.Vector3();
    for (const body of bodies) middle.add(body.centre);
    middle.divideScalar(bodies.length || 1);
    for (const body of bodies) {
      body.group.position.copy(body.centre).sub(middle).multiplyScalar(gap);
    }
    draw();
  }

  function setFactor(value) {
    state.factor = value;
    uniforms.factor.value = value;
    draw();
  }

  // The bodies as the picture of the contact pressure arranges them; in other reports only those whose faces carry the field, seen from where these faces look, as near as what is
  // not zero allows.
  async function contact() {
    const named = model.fields.find((f) => f.name === "CPRESS") || model.fields.find((f) => f.partial);
    if (!named) return;
    if (!state.field.partial) await choose(named.name);
    const offset = n * state.frame;
    const values = Float64Array.from({ length: n }, (_, p) => {
      const q = state.values[offset + p];
      return q === NOTHING ? NaN : Math.abs(back(state.field.range, q));
    });
    const most = values.reduce((m, v) => (v > m ? v : m), 0);
    if (flat) {
      look(home);
      near(bodies, values, most);
      return;
    }
    if (model.contact) {
      const { bodies: drawn, offsets, view } = model.contact;
      bodies.forEach((body, i) => { toggle(body, drawn[i]); body.group.position.fromArray(offsets[i]); });
      look(view);
      if (offsets.flat().every((x) => x === 0)) near(bodies.filter((body) => body.group.visible), values, most);
      return;
    }
    const sums = bodies.map((body) => {
      const [loaded, whole] = [new THREE.Vector3(), new THREE.Vector3()];
      const [a, b, c] = [new THREE.Vector3(), new THREE.Vector3(), new THREE.Vector3()];
      for (let t = 0; t < body.own.length; t += 3) {
        const corners = [body.own[t], body.own[t + 1], body.own[t + 2]];
        const weight = (values[corners[0]] + values[corners[1]] + values[corners[2]]) / 3;
        if (Number.isNaN(weight)) continue;
        a.fromArray(positions, 3 * corners[0]);
        b.fromArray(positions, 3 * corners[1]).sub(a);
        c.fromArray(positions, 3 * corners[2]).sub(a);
        whole.add(b.cross(c));
        loaded.addScaledVector(b, weight);
      }
      return loaded.length() > 0 ? loaded : whole;
    });
    const largest = sums.reduce((best, s, i) => (s.length() > sums[best].length() * 1.05 ? i : best), 0);
    const direction = sums[largest].clone();
    if (!(direction.length() > 0)) return look(home);
    bodies.forEach((body, i) => toggle(body, i === largest || sums[i].dot(direction) > 0));
    direction.normalize();
    look(Math.abs(direction.z) > 0.7 ? [direction.x + 0.35, direction.y - 0.5, direction.z] : [direction.x, direction.y, direction.z + 0.45]);
    near([bodies[largest]], values, most);
  }

  // As near to the part that carries something as shows what is around it.
  function near(those, values, most) {
    const [box, at, mid] = [new THREE.Box3(), new THREE.Vector3(), new THREE.Vector3()];
    for (const body of those) {
      for (const p of body.points) {
        if (!(values[p] > 1e-3 * most)) continue;
        for (let c = 0; c < 3; c++) at.setComponent(c, positions[3 * p + c] + state.factor * attributes.motion.array[3 * p + c]);
        box.expandByPoint(at.add(body.group.position));
      }
    }
    if (box.isEmpty()) return;
    box.getCenter(mid);
    const part = box.getSize(at).length() / 2;
    const half = camera.userData.half;
    camera.zoom = Math.min(60, Math.max(1, Math.max(half.x, half.y) / (2.2 * part)));
    if (camera.zoom > 1) {
      camera.position.add(mid).sub(controls.target);
      controls.target.copy(mid);
    }
    camera.updateProjectionMatrix();
    controls.update();
    draw();
  }

  function toggle(body, on) {
    body.group.visible = on;
    body.box.checked = on;
    draw();
  }

  // The controls.
  const select = by("field");
  for (const field of model.fields) select.append(element("option", { value: field.name }, field.label));
  select.addEventListener("change", () => report.attempt(() => choose(select.value)));
  const slider = by("frame");
  slider.max = String(frames - 1);
  slider.disabled = frames < 2;
  by("play").disabled = frames < 2;
  slider.addEventListener("input", () => { play(false); (state.mode ? turn : show)(Number(slider.value)); });
  const modes = model.modes || [];
  if (modes.length > 0) {
    const list = by("mode");
    list.append(element("option", { value: "" }, "none: displacements over time"));
    modes.forEach((mode, i) => list.append(element("option", { value: String(i) }, mode.label)));
    list.addEventListener("change", () => report.attempt(() => pick(list.value === "" ? -1 : Number(list.value))));
    by("mode-label").hidden = false;
    for (const [words, phase] of [["Real part", 0], ["Imaginary part", (3 * STEPS) / 4]]) {
      by("parts").append(element("button", { type: "button", onclick: () => { play(false); turn(phase); } }, words));
    }
  }
  by("play").addEventListener("click", () => play(!state.playing));
  by("own-range").addEventListener("change", () => { colours(); draw(); });
  by("cells").addEventListener("change", (e) => { for (const body of bodies) body.wire.visible = e.target.checked; draw(); });
  by("gap").addEventListener("input", apart);
  by("gap-label").hidden = bodies.length < 2;
  const factor = by("factor");
  factor.addEventListener("input", () => { const v = Number(factor.value); if (factor.value !== "" && Number.isFinite(v)) setFactor(v); });
  by("factor-one").addEventListener("click", () => { factor.value = "1"; setFactor(1); });
  by("factor-auto").addEventListener("click", () => { factor.value = String(model.scale); setFactor(model.scale); });
  factor.value = String(model.scale);
  uniforms.factor.value = model.scale;
  const home = flat ? [0, 0, 1] : [0.62, -0.72, 0.5];
  const views = by("views");
  const whole = () => { by("gap").value = "0"; apart(); for (const body of bodies) toggle(body, true); look(home); };
  const add = (words, work) => views.append(element("button", { type: "button", onclick: work }, words));
  add("Whole", whole);
  if (!flat) {
    for (const [words, d] of [["x", [1, 0, 0]], ["y", [0, -1, 0]], ["z", [0, 0, 1]], ["Below", [0, 0, -1]]]) add(words, () => look(d));
  }
  if (model.fields.some((f) => f.partial)) add("Contact", () => report.attempt(contact));
  for (const body of bodies) {
    body.box = element("input", { type: "checkbox", checked: true, onchange: () => toggle(body, body.box.checked) });
    if (bodies.length > 1) by("bodies").append(element("label", {}, body.box, body.name));
  }
  by("view-note").textContent = (flat ? "Drag to move, turn the wheel or pinch to zoom." : "Drag to turn, with the right button or two fingers to move, turn the wheel or pinch to zoom.")
    + " Values are at nodes, each within a 65 000th of the range.";
  canvas.addEventListener("keydown", (e) => {
    const turn = (about, angle) => {
      const arm = camera.position.clone().sub(controls.target);
      arm.applyAxisAngle(about, angle);
      camera.position.copy(controls.target).add(arm);
      controls.update();
      draw();
    };
    const side = new THREE.Vector3().setFromMatrixColumn(camera.matrixWorld, 0);
    const step = 0.12;
    const zoom = (by) => { camera.zoom *= by; camera.updateProjectionMatrix(); draw(); };
    const keys = {
      ArrowLeft: () => !flat && turn(camera.up, -step), ArrowRight: () => !flat && turn(camera.up, step),
      ArrowUp: () => !flat && turn(side, -step), ArrowDown: () => !flat && turn(side, step), "+": () => zoom(1.2), "=": () => zoom(1.2), "-": () => zoom(1 / 1.2),
    };
    if (keys[e.key]) { keys[e.key](); e.preventDefault(); }
  });

  // The nearest point under the pointer says its value.
  const tip = by("tip");
  let waiting = false;
  canvas.addEventListener("pointermove", (e) => {
    if (waiting || e.buttons) { tip.hidden = true; return; }
    waiting = true;
    requestAnimationFrame(() => { waiting = false; probe(e); });
  });
  canvas.addEventListener("pointerleave", () => { tip.hidden = true; });
  function probe(e) {
    const box = canvas.getBoundingClientRect();
    const [x, y] = [e.clientX - box.left, e.clientY - box.top];
    const at = new THREE.Vector3();
    let best = null;
    for (const body of bodies) {
      if (!body.group.visible) continue;
      for (const p of body.points) {
        const q = state.mode ? 0 : state.values[n * state.frame + p];
        if (q === NOTHING) continue;
        for (let c = 0; c < 3; c++) at.setComponent(c, positions[3 * p + c] + state.factor * attributes.motion.array[3 * p + c]);
        at.add(body.group.position).project(camera);
        const d = Math.hypot(((at.x + 1) / 2) * box.width - x, ((1 - at.y) / 2) * box.height - y);
        if (d < 9 && (!best || at.z < best.z - 1e-4 || (Math.abs(at.z - best.z) <= 1e-4 && d < best.d))) best = { p, q, d, z: at.z, body };
      }
    }
    tip.hidden = !best;
    if (!best) return;
    const v = state.mode ? amplitude(best.p) : back(state.field.range, best.q);
    tip.textContent = state.mode ? `${best.body.name}: amplitude ${number(v)}` : `${best.body.name}: ${state.field.name} ${state.field.status ? model.statuses[Math.round(v)].name : number(v)}`;
    tip.style.left = Math.min(x + 14, Math.max(0, box.width - tip.offsetWidth - 4)) + "px";
    tip.style.top = Math.max(4, y - 26) + "px";
  }

  function theme() {
    renderer.setClearColor(new THREE.Color(report.colour("--stage")), 1);
    const c = new THREE.Color(report.colour("--edge"));
    uniforms.ink.value.set(c.r, c.g, c.b);
    const s = new THREE.Color(report.colour("--soft"));
    uniforms.soft.value.set(s.r, s.g, s.b);
    draw();
  }
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", theme);
  theme();
  new ResizeObserver(fit).observe(canvas.parentElement);
  const start = ["CPRESS", "MISES", "U"].find((name) => model.fields.some((f) => f.name === name && f.range[1] > f.range[0]));
  show(opening);
  await choose(start);
  look(home);
  show(opening);
  // What surfaces carry is looked at from near, and nothing is moved to where it is not.
  if (state.field && state.field.contact) {
    factor.value = "1";
    setFactor(1);
    await contact();
  }
  canvas.dataset.ready = "yes";
});
