// The live page in a real browser: node live_page_test.mjs FAKE_DAEMON [FOLDER for screenshots]
// Prints "SKIP live_page: REASON" and leaves with 77 where the browser or its driver is not installed.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { existsSync, mkdirSync } from "node:fs";
import { once } from "node:events";
import { createInterface } from "node:readline";

const [daemonFile, folder = "."] = process.argv.slice(2);
const skip = reason => { console.log("SKIP live_page: " + reason); process.exit(77); };
const browserFile = "/usr/bin/chromium";
if (!existsSync(browserFile)) skip(browserFile + " is not installed");
const { chromium } = await import("playwright-core").catch(() => skip("playwright-core is not installed"));

const daemon = spawn(daemonFile, { stdio: ["pipe", "pipe", "inherit"] });
const [line] = await once(createInterface({ input: daemon.stdout }), "line");
const address = `http://127.0.0.1:${JSON.parse(line).http}/`;
const change = async patch => {
  const answer = await fetch(address + "api/v1/show?wait=shown", { method: "PATCH", body: JSON.stringify(patch),
    headers: { "Content-Type": "application/merge-patch+json" } });
  assert.ok(answer.ok, await answer.text());
};

const browser = await chromium.launch({ executablePath: browserFile, headless: true,
  args: ["--no-sandbox", "--disable-gpu", "--disable-background-networking", "--disable-component-update",
         "--disable-sync", "--no-first-run"] });
mkdirSync(folder, { recursive: true });
try {
  const page = await browser.newPage({ viewport: { width: 1100, height: 640 } });
  const complaints = [], foreign = [];
  page.on("console", message => { if (message.type() === "error") complaints.push(message.text()); });
  page.on("pageerror", error => complaints.push(String(error)));
  page.on("request", request => { if (!/^(blob:|data:|http:\/\/127\.0\.0\.1:)/.test(request.url())) foreign.push(request.url()); });
  await page.goto(address);

  // A tile for each output, with a picture of the right shape and the right colour.
  const red = name => page.evaluate(which => {
    const image = document.querySelector(`figure[data-output="${which}"] img`);
    if (!image?.naturalWidth) return null; // no tile yet, or no picture in it
    const canvas = document.createElement("canvas");
    canvas.width = canvas.height = 1;
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0, 1, 1);
    return context.getImageData(0, 0, 1, 1).data[0];
  }, name);
  const becomes = async (name, wanted) => {
    for (let i = 0; i < 300; ++i) {
      const got = await red(name);
      if (got !== null && Math.abs(got - wanted) <= 4) return;
      await page.waitForTimeout(50);
    }
    assert.fail(`the picture of ${name} is ${await red(name)} red, not ${wanted}`);
  };
  await becomes("main", 90);
  await becomes("side", 90);
  const box = await page.locator('figure[data-output="main"] .picture').boundingBox();
  assert.ok(Math.abs(box.width / box.height - 320 / 200) < 0.02, JSON.stringify(box));
  await page.waitForFunction(() => document.getElementById("link").textContent === "live");
  assert.equal(await page.textContent("#fps"), "59.9 of 60");
  assert.equal(await page.textContent("#revision"), "1");
  assert.equal(await page.textContent("#name"), "small");

  // A live change is seen.
  await change({ projections: { wall: { horizontal_fov: 320 } } });
  await becomes("main", 160);
  await page.waitForFunction(() => document.getElementById("revision").textContent === "2");
  await page.screenshot({ path: folder + "/live.png" });
  assert.deepEqual(complaints, []);

  // An output that fails says so in words, with the daemon's problems above; and comes back.
  await change({ name: "broken" });
  await page.waitForFunction(() => document.querySelectorAll("figure.failed").length === 2);
  await page.waitForFunction(() => document.querySelector("#problems li.error"));
  assert.match(await page.textContent('figure[data-output="main"] .note'), /a broken output/);
  assert.match(await page.textContent("#problems li.error"), /OUT-101 \/outputs\/main.*a monitor named LEFT/);
  await page.screenshot({ path: folder + "/failed.png" });
  await change({ name: "small" });
  await page.waitForFunction(() => document.querySelectorAll("figure.failed").length === 0);

  // Outputs that come and go.
  await change({ outputs: { side: null, "third.one": { kind: "headless", width: 200, height: 400,
    viewports: { all: { projection: "inset" } } } } });
  await page.waitForSelector('figure[data-output="third.one"] img[src^="blob:"]');
  await page.waitForSelector('figure[data-output="side"]', { state: "detached" });

  // A narrow screen shows one column and does not scroll sideways.
  await page.setViewportSize({ width: 390, height: 760 });
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
  await page.screenshot({ path: folder + "/narrow.png" });

  // Without a daemon the page says so.
  daemon.stdin.end();
  await once(daemon, "exit");
  assert.equal(daemon.exitCode, 0);
  await page.waitForFunction(() => document.getElementById("link").textContent === "lost");
  await page.waitForFunction(() => document.querySelectorAll("figure.failed").length === 2);
  await page.screenshot({ path: folder + "/lost.png" });
  assert.deepEqual(foreign, []);
  console.log("ok live_page");
} finally {
  await browser.close();
  if (daemon.exitCode === null) daemon.stdin.end();
}
