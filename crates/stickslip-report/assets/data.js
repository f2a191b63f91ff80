"use strict";
// The data of the page: unpacked when they are first needed. Nothing is fetched.
const report = (() => {
  const meta = JSON.parse(document.getElementById("meta").textContent);

  function trouble(message) {
    const place = document.getElementById("trouble");
    place.hidden = false;
    place.textContent = message;
  }

  // The bytes of a packed array.
  async function bytes(key) {
    const place = document.getElementById("blob-" + key);
    const text = atob(place.textContent);
    const packed = new Uint8Array(text.length);
    for (let i = 0; i < text.length; i++) packed[i] = text.charCodeAt(i);
    if (typeof DecompressionStream === "undefined") {
      throw new Error("This browser cannot unpack the data (no DecompressionStream). Use one of 2023 or later.");
    }
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
    const buffer = await new Response(stream).arrayBuffer();
    place.remove();
    return buffer;
  }

  const singles = async (key) => new Float32Array(await bytes(key));
  const doubles = async (key) => new Float64Array(await bytes(key));
  const indices = async (key) => new Uint32Array(await bytes(key));

  // Whole numbers: all low bytes, then all high bytes.
  async function shorts(key) {
    const all = new Uint8Array(await bytes(key));
    const n = all.length / 2;
    const out = new Int16Array(n);
    for (let i = 0; i < n; i++) out[i] = all[i] | (all[n + i] << 8);
    return out;
  }

  // A number in few digits.
  function number(value, digits = 3) {
    if (value === null || Number.isNaN(value)) return "–";
    if (value === 0) return "0";
    const size = Math.abs(value);
    if (size >= 1e-3 && size < 1e6) return String(Number(value.toPrecision(digits)));
    return value.toExponential(digits - 1).replace(/\.?0*e\+?/, "e");
  }

  // A library that is kept packed until it is needed: it becomes a script of this page.
  async function library(key) {
    const script = document.createElement("script");
    script.textContent = new TextDecoder().decode(await bytes(key));
    document.head.append(script);
  }

  const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

  function element(tag, attributes = {}, ...children) {
    const made = document.createElement(tag);
    for (const [key, value] of Object.entries(attributes)) {
      if (key === "class") made.className = value;
      else if (key.startsWith("on")) made.addEventListener(key.slice(2), value);
      else if (typeof value === "boolean") made[key] = value;
      else made.setAttribute(key, value);
    }
    made.append(...children);
    return made;
  }

  // Runs what must not stop the rest of the page.
  function attempt(work) {
    Promise.resolve().then(work).catch((e) => {
      trouble("Something in this page does not work: " + (e && e.message ? e.message : e));
      console.error(e);
    });
  }

  return { meta, trouble, library, singles, doubles, indices, shorts, number, colour, element, attempt };
})();
