// Opens reports in headless Chromium as a reader does, from disk, and uses them.
//
//   node check.mjs FOLDER_OF_PICTURES REPORT.html ...
//
// Fails on any error in the console, on any request to a network, and where a control does nothing.
import { createRequire } from "node:module";
import { mkdirSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { pathToFileURL } from "node:url";

// playwright-core may be installed in another folder: NODE_MODULES names it.
const require = createRequire(process.env.NODE_MODULES ? path.join(process.env.NODE_MODULES, "x.js") : import.meta.url);
const { chromium } = require("playwright-core");

const [pictures, ...reports] = process.argv.slice(2);
if (!pictures || reports.length === 0) {
  console.error("usage: node check.mjs FOLDER_OF_PICTURES REPORT.html ...");
  process.exit(2);
}
mkdirSync(pictures, { recursive: true });

const profile = mkdtempSync(path.join(tmpdir(), "stickslip-browser-"));
const context = await chromium.launchPersistentContext(profile, {
  executablePath: process.env.CHROMIUM || "/usr/bin/chromium",
  headless: true,
  viewport: { width: 1280, height: 900 },
  args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync"],
});

let failures = 0;
const fail = (message) => {
  failures += 1;
  console.error("FAIL " + message);
};

// The pixels of the canvas as one number, and how many colours there are.
const look = (page) => page.evaluate(() => {
  const canvas = document.getElementById("canvas");
  const copy = document.createElement("canvas");
  copy.width = canvas.width;
  copy.height = canvas.height;
  const c = copy.getContext("2d");
  c.drawImage(canvas, 0, 0);
  const data = c.getImageData(0, 0, copy.width, copy.height).data;
  let hash = 0;
  const colours = new Set();
  for (let i = 0; i < data.length; i += 4) {
    const rgb = (data[i] << 16) | (data[i + 1] << 8) | data[i + 2];
    hash = (Math.imul(hash, 31) + rgb) | 0;
    if (colours.size < 64) colours.add(rgb);
  }
  return { hash, colours: colours.size };
});

// Waits until the view has drawn what was asked for.
const settle = (page) => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done, 60)))));

async function check(file) {
  const name = path.basename(path.dirname(file)) + "-" + path.basename(file, ".html");
  const page = await context.newPage();
  const url = pathToFileURL(path.resolve(file)).href;
  page.on("console", (m) => {
    if (m.type() === "error" || m.type() === "warning") {
      // What the software renderer says of itself is no fault of the page.
      if (!/GPU stall|swiftshader|GL Driver Message/i.test(m.text())) fail(`${name}: console: ${m.text()}`);
    }
  });
  page.on("pageerror", (e) => fail(`${name}: ${e.message}`));
  page.on("request", (r) => {
    const to = r.url();
    if (to !== url && !to.startsWith(url + "#") && !to.startsWith("data:") && !to.startsWith("blob:")) fail(`${name}: request to ${to}`);
  });
  await page.goto(url);
  await page.waitForSelector("#canvas[data-ready=yes]", { timeout: 60000 });
  await page.waitForSelector("html[data-plots=ready]", { timeout: 60000 });
  await settle(page);
  const shot = (what) => page.screenshot({ path: path.join(pictures, `${name}-${what}.png`) });
  const changed = async (what, work) => {
    const before = await look(page);
    await work();
    await settle(page);
    const after = await look(page);
    if (before.hash === after.hash) fail(`${name}: the picture did not change: ${what}`);
    return after;
  };
  if (await page.isVisible("#trouble")) fail(`${name}: ${await page.textContent("#trouble")}`);
  const first = await look(page);
  if (first.colours < 4) fail(`${name}: the first picture has ${first.colours} colours only`);
  await shot("1-first");

  const flat = await page.evaluate(() => report.meta.model.dim === 2);
  const frames = await page.evaluate(() => report.meta.model.times.length);
  const canvas = page.locator("#canvas");
  await canvas.scrollIntoViewIfNeeded();
  const box = await canvas.boundingBox();
  const middle = [box.x + box.width / 2, box.y + box.height / 2];
  const drag = async () => {
    await page.mouse.move(middle[0], middle[1]);
    await page.mouse.down();
    await page.mouse.move(middle[0] + 90, middle[1] + 40, { steps: 6 });
    await page.mouse.up();
  };
  await changed(flat ? "drag moves" : "drag turns", drag);
  await shot("2-dragged");
  await changed("the wheel zooms", async () => {
    await page.mouse.move(middle[0], middle[1]);
    await page.mouse.wheel(0, -400);
  });
  await changed("the whole again", () => page.click("#views button:has-text('Whole')"));
  if (!flat) {
    await changed("an arrow key turns", async () => {
      await canvas.focus();
      await page.keyboard.press("ArrowLeft");
    });
    await page.click("#views button:has-text('Whole')");
  }

  if (frames > 1) {
    // The slider, by the keyboard as a reader would.
    const time = () => page.textContent("#frame-time");
    const last = await time();
    await changed("the slider at its beginning", async () => {
      await page.focus("#frame");
      await page.keyboard.press("Home");
    });
    const beginning = await time();
    if (beginning === last) fail(`${name}: the slider did not change the time`);
    await page.click("#play");
    await page.waitForFunction((t) => document.getElementById("frame-time").textContent !== t, beginning, { timeout: 10000 })
      .catch(() => fail(`${name}: play does not go on`));
    await page.click("#play");
    const stopped = await time();
    await page.waitForTimeout(700);
    if ((await time()) !== stopped) fail(`${name}: play does not stop`);
    await page.focus("#frame");
    await page.keyboard.press("End");
    if ((await time()) !== last) fail(`${name}: the slider does not come to its end`);
  }

  // Every field can be shown.
  const fields = await page.evaluate(() => report.meta.model.fields.map((f) => f.name));
  for (const field of fields) {
    await page.selectOption("#field", field);
    await page.waitForFunction((f) => document.querySelector("#bar .name").textContent.startsWith(f), field);
  }
  for (const field of ["CPRESS", "CSTATUS"]) {
    if (!fields.includes(field)) {
      fail(`${name}: there is no ${field}`);
      continue;
    }
    await page.selectOption("#field", field);
    await settle(page);
    if (!flat) await page.click("#views button:has-text('Contact')");
    await settle(page);
    const seen = await look(page);
    if (seen.colours < 3) fail(`${name}: ${field} shows ${seen.colours} colours`);
    await shot("3-" + field);
  }
  const status = await page.textContent("#bar");
  for (const word of ["open", "stick", "slip"]) if (!status.includes(word)) fail(`${name}: the legend of the status lacks ${word}`);
  await page.click("#views button:has-text('Whole')");
  await page.selectOption("#field", "U");
  await changed("the factor of displacements", () => page.fill("#factor", "0"));
  await page.click("#factor-auto");

  // Plots: a column more, and a zoom by dragging.
  const plots = await page.locator(".plot canvas").count();
  if (plots < 3) fail(`${name}: only ${plots} plots`);
  const boxes = page.locator("#columns input");
  const columns = await boxes.count();
  await boxes.nth(columns - 1).check();
  await page.locator("#history").scrollIntoViewIfNeeded();
  const over = page.locator("#history-plots .u-over").first();
  await over.scrollIntoViewIfNeeded();
  const area = await over.boundingBox();
  const ticks = () => page.evaluate(() => {
    const c = document.querySelector("#history-plots canvas");
    return c.toDataURL();
  });
  const unzoomed = await ticks();
  await page.mouse.move(area.x + area.width * 0.3, area.y + area.height / 2);
  await page.mouse.down();
  await page.mouse.move(area.x + area.width * 0.6, area.y + area.height / 2, { steps: 5 });
  await page.mouse.up();
  await settle(page);
  if ((await ticks()) === unzoomed) fail(`${name}: dragging over a plot does not zoom`);
  await shot("4-history");
  await page.locator("#history-plots button:has-text('whole')").first().click();

  await page.evaluate(() => scrollTo(0, 0));
  await page.screenshot({ path: path.join(pictures, `${name}-5-page.png`), fullPage: true });
  await page.emulateMedia({ colorScheme: "dark" });
  await settle(page);
  await page.screenshot({ path: path.join(pictures, `${name}-6-dark.png`), fullPage: true });
  await page.emulateMedia({ colorScheme: "light" });
  await page.setViewportSize({ width: 390, height: 844 });
  await settle(page);
  await page.waitForTimeout(300);
  const wide = await page.evaluate(() => document.documentElement.scrollWidth);
  if (wide > 390) fail(`${name}: on a telephone the page is ${wide} pixels wide`);
  await page.screenshot({ path: path.join(pictures, `${name}-7-phone.png`), fullPage: true });
  await page.close();
  console.log(`${name}: ${fields.length} fields, ${frames} times, ${plots} plots, ${columns} columns`);
}

try {
  for (const file of reports) await check(file);
} catch (e) {
  fail(e.stack || String(e));
} finally {
  await context.close();
  rmSync(profile, { recursive: true, force: true });
}
if (failures > 0) {
  console.error(`${failures} failures`);
  process.exit(1);
}
console.log("reports work");
