"use strict";
// Plots of the history: convergence, energies, and whatever columns are chosen.
report.attempt(async () => {
  const { meta, element, colour, number } = report;
  if (!meta.history) return;
  const names = meta.history.names;
  const rows = meta.history.rows;
  const all = await report.doubles("history");
  const columns = new Map();
  names.forEach((name, i) => {
    // Missing values are gaps in a line.
    const values = Array.from(all.subarray(i * rows, (i + 1) * rows), (v) => (Number.isFinite(v) ? v : null));
    if (!columns.has(name)) columns.set(name, values);
  });
  const index = Array.from({ length: rows }, (_, i) => i + 1);
  const get = (name) => columns.get(name);

  // Told apart by people who are colour-blind (Okabe and Ito), and by dashes from the ninth on.
  const inks = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8a6d3b", "#7f7f7f"];
  const dashes = [[], [7, 4], [2, 3]];
  const made = [];

  function axis(label) {
    return {
      label, labelSize: 18, labelFont: "12px system-ui, sans-serif", font: "12px system-ui, sans-serif", stroke: () => colour("--soft"),
      grid: { stroke: () => colour("--line"), width: 1 }, ticks: { stroke: () => colour("--line"), width: 1 },
    };
  }

  // One plot. Each line: label, values, and how it is drawn.
  function plot(place, title, along, lines, options = {}) {
    const holder = element("div", { class: "plot" });
    const tools = element("span", { class: "tools" });
    holder.append(element("div", { class: "row" }, element("h4", {}, title), tools));
    place.append(holder);
    let x = along.values;
    // Lines need an order along the axis; a loop has none and is drawn as points in the order of the rows.
    const sorted = x.every((v, i) => v !== null && (i === 0 || v >= x[i - 1]));
    let order = null;
    if (!sorted) {
      order = x.map((v, i) => i).filter((i) => x[i] !== null).sort((a, b) => x[a] - x[b]);
      x = order.map((i) => x[i]);
    }
    const pick = (values) => (order ? order.map((i) => values[i]) : values);
    const log = options.log === true;
    const size = () => ({ width: Math.max(240, holder.clientWidth), height: options.height || 250 });
    const shown = (u, v) => number(v === undefined ? null : v);
    const range = (u, low, high) => {
      if (low === null || high === null) return [0, 1];
      if (low === high) return low === 0 ? [-1, 1] : [low - Math.abs(low) * 0.1, high + Math.abs(high) * 0.1];
      const room = 0.06 * (high - low);
      return [low >= 0 && low - room < 0 ? 0 : low - room, high + room];
    };
    const u = new uPlot({
      ...size(),
      legend: { live: true },
      cursor: { drag: { x: true, y: false }, sync: options.sync ? { key: options.sync } : undefined, points: { size: 6 } },
      bands: options.bands,
      scales: { x: { time: false }, y: log ? { distr: 3 } : { range } },
      axes: [axis(along.name), { ...axis(""), size: 68, values: (u, ticks) => ticks.map((t) => (t === null ? "" : number(t, 5))) }],
      series: [{ label: along.name, value: shown }, ...lines.map((line, i) => ({
        label: line.label, value: line.shown || shown, stroke: line.stroke || inks[i % inks.length], width: 1.8,
        dash: dashes[Math.floor(i / inks.length) % dashes.length], fill: line.fill,
        paths: order ? () => null : line.stepped ? uPlot.paths.stepped({ align: -1 }) : undefined,
        // Where values are few, or stand alone between gaps, a line would not show them.
        points: { show: order ? true : line.values.filter((v) => v !== null && !(log && !(v > 0))).length < 200, size: order ? 4 : rows < 60 ? 6 : 4 }, spanGaps: false,
      }))],
    }, [x, ...lines.map((line) => pick(line.values).map((v) => (log && !(v > 0) ? null : v)))], holder);
    const zoom = (scale, shift) => {
      const { min, max } = u.scales.x;
      const middle = (min + max) / 2 + shift * (max - min);
      const half = ((max - min) / 2) * scale;
      u.setScale("x", { min: Math.max(x[0], middle - half), max: Math.min(x[x.length - 1], middle + half) });
    };
    const whole = () => u.setScale("x", { min: x[0], max: x[x.length - 1] });
    for (const [sign, words, work] of [["−", "Zoom out", () => zoom(2, 0)], ["+", "Zoom in", () => zoom(0.5, 0)], ["←", "Earlier", () => zoom(1, -0.25)],
      ["→", "Later", () => zoom(1, 0.25)], ["whole", "The whole", whole]]) {
      tools.append(element("button", { type: "button", "aria-label": words + ": " + title, title: words, onclick: work }, sign));
    }
    const entry = { u, size, holder };
    made.push(entry);
    return entry;
  }

  function drop(place) {
    for (let i = made.length - 1; i >= 0; i--) {
      if (place.contains(made[i].holder)) {
        made[i].u.destroy();
        made.splice(i, 1);
      }
    }
    place.textContent = "";
  }

  new ResizeObserver(() => made.forEach(({ u, size }) => u.setSize(size()))).observe(document.querySelector("main"));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => made.forEach(({ u }) => u.redraw()));

  const line = (name, label = name) => ({ label, values: get(name) });
  const some = (values) => values && values.some((v) => v !== null && v !== 0);
  const time = { name: "TIME", values: get("TIME") || index };
  const increments = { name: "row of the history", values: index };

  const convergence = document.getElementById("convergence-plots");
  if (convergence) {
    const effort = ["ITRS", "AUGMENTATIONS"].filter((n) => some(get(n)));
    const words = { ITRS: "Newton iterations", AUGMENTATIONS: "multiplier updates" };
    const counts = effort.map((n) => ({ ...line(n, words[n]), stepped: true }));
    if (some(get("ATT")) && get("ATT").some((v) => v > 1)) {
      counts.push({ label: "cut-backs before", values: get("ATT").map((v) => (v === null ? null : v - 1)), stepped: true });
    }
    if (counts.length) plot(convergence, "Iterations of each increment", increments, counts, { sync: "rows" });
    if (get("RESIDUAL") && get("RESIDUAL").filter((v) => v > 0).length > 1) plot(convergence, "Out-of-balance at the end, relative", increments, [line("RESIDUAL", "residual")], { log: true, sync: "rows" });
    if (some(get("DT"))) plot(convergence, "Length of increments", increments, [{ ...line("DT", "DT"), stepped: true }], { log: true, sync: "rows" });
    const statuses = [["OPEN", "open", 0], ["STICK", "stick", 1], ["SLIP", "slip", 2]].filter(([n]) => get(n));
    if (statuses.some(([n]) => some(get(n)))) {
      const inkOf = (i) => ["#a8912a", "#0072b2", "#d55e00"][i];
      plot(convergence, "Contact points by status", increments, statuses.map(([n, label, i]) => ({ ...line(n, label), stroke: inkOf(i), stepped: true })), { sync: "rows" });
    }
  }

  const energy = document.getElementById("energy-plots");
  if (energy) {
    const words = {
      ALLWK: "supplied (ALLWK)", ALLSE: "strain (ALLSE)", ALLKE: "kinetic (ALLKE)", ALLCE: "interfaces (ALLCE)", ALLFD: "friction (ALLFD)",
      ALLCD: "contact damping (ALLCD)", ALLVD: "Rayleigh damping (ALLVD)", ALLND: "scheme (ALLND)", ALLAE: "artificial (ALLAE)", EINITIAL: "initial (EINITIAL)",
    };
    const known = Object.keys(words).filter((n) => some(get(n)));
    // What stores and dissipates is stacked: together it should be what was supplied.
    const parts = ["ALLSE", "ALLCE", "ALLKE", "ALLFD", "ALLCD", "ALLVD"].filter((n) => some(get(n)) && get(n).every((v) => v === null || v > -1e-12));
    if (parts.length > 1 && get("ALLWK")) {
      const sums = [];
      parts.forEach((n, i) => sums.push(get(n).map((v, k) => (v || 0) + (i ? sums[i - 1][k] : 0))));
      const layers = parts.map((n, i) => ({
        label: words[n], values: sums[i], stroke: inks[i % inks.length], fill: inks[i % inks.length] + "88",
        shown: (u, v, s, k) => number(k === null || k === undefined ? null : get(n)[k]),
      })).reverse();
      const supplied = get("ALLWK").map((v, k) => (v || 0) + ((get("EINITIAL") || [])[k] || 0));
      plot(energy, "Stored and dissipated, stacked, and what was supplied", time, [...layers, { label: "supplied", values: supplied, stroke: "#7f7f7f" }],
        { sync: "energy", bands: parts.slice(1).map((_, i) => ({ series: [i + 1, i + 2] })) });
    }
    if (known.length) plot(energy, "Energies", time, known.map((n) => line(n, words[n])), { sync: "energy" });
    if (get("ERESIDUAL")) plot(energy, "Residual of the balance", time, [line("ERESIDUAL", "residual")], { sync: "energy" });
  }

  const place = document.getElementById("history-plots");
  const list = document.getElementById("columns");
  if (!place || !list) return;
  const against = document.getElementById("against");
  for (const name of ["TIME", ...names.filter((n) => n !== "TIME")]) {
    if (columns.has(name)) against.append(element("option", { value: name }, name));
  }
  against.append(element("option", { value: "" }, "row"));
  // At first: forces of interfaces and supports that change, or what else does.
  const changes = (name) => {
    const values = get(name).filter((v) => v !== null);
    const [low, high] = [values.reduce((a, b) => Math.min(a, b), Infinity), values.reduce((a, b) => Math.max(a, b), -Infinity)];
    return high - low > 1e-3 * Math.max(Math.abs(low), Math.abs(high));
  };
  const most = (name) => get(name).reduce((m, v) => (v === null ? m : Math.max(m, Math.abs(v))), 0);
  // What is nothing beside its like is rounding.
  const tell = (list) => {
    const largest = Math.max(...list.map(most));
    return list.filter((n) => most(n) > 1e-6 * largest);
  };
  const wanted = [/\.CF[NS]\d$/, /\.RF\d$/, /\.U\d$/, /^ALL/, /\./, /^(OPEN|STICK|SLIP)$/, /^(?!STEP|INC|ATT|ITRS|TIME|DT)/];
  const first = wanted.map((p) => tell(names.filter((n) => p.test(n) && changes(n)))).find((l) => l.length) || names.slice(-1);
  const chosen = new Set(first.slice(0, 4));
  const boxes = names.map((name) => {
    const box = element("input", { type: "checkbox", onchange: () => { box.checked ? chosen.add(name) : chosen.delete(name); draw(); } });
    box.checked = chosen.has(name);
    const label = element("label", {}, box, name);
    list.append(label);
    return { name, box, label };
  });
  document.getElementById("column-filter").addEventListener("input", (e) => {
    const text = e.target.value.trim().toLowerCase();
    for (const { name, label } of boxes) label.hidden = !name.toLowerCase().includes(text);
  });
  document.getElementById("columns-none").addEventListener("click", () => {
    chosen.clear();
    for (const { box } of boxes) box.checked = false;
    draw();
  });
  const apart = document.getElementById("apart");
  const draw = () => {
    drop(place);
    const along = against.value ? { name: against.value, values: get(against.value) } : increments;
    const lines = [...chosen].map((name) => line(name));
    if (!lines.length) place.append(element("p", { class: "quiet" }, "No column is chosen."));
    else if (apart.checked) lines.forEach((one) => plot(place, one.label, along, [one], { sync: "history", height: 200 }));
    else plot(place, lines.length > 4 ? lines.length + " columns" : lines.map((l) => l.label).join(", "), along, lines, { height: 360 });
  };
  against.addEventListener("change", draw);
  apart.addEventListener("change", draw);
  draw();
  document.documentElement.dataset.plots = "ready";
});
