// Walks through a report as who has a keyboard alone, and says in <p id="walked"> what is wrong, or "passed".

const wrong = [];
const expect = (is_so, what) => is_so || wrong.push(what);
const $ = (selector) => document.querySelector(selector);

/** Until the viewer shows what it was told to: pixels are unpacked on another thread and painted with a frame, in times that no timer here knows. */
async function settled() {
  const turn = () => new Promise((done) => {
    const { port1, port2 } = new MessageChannel();
    port1.onmessage = done;
    port2.postMessage(0);
  });
  do {
    for (let i = 0; i < 100; ++i) await turn();
    await new Promise((done) => setTimeout(done, 20));
  } while ($("#viewer").getAttribute("aria-busy") !== "false");
  await new Promise((done) => setTimeout(done, 40));
}

const press = (element, key, more = {}) => element.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true, cancelable: true, ...more }));
const choose = (select, value) => {
  select.value = value;
  select.dispatchEvent(new Event("input", { bubbles: true }));
  select.dispatchEvent(new Event("change", { bubbles: true }));
};

async function walk() {
  await settled();

  // The chart: one stop of Tab, arrows from run to run, details of each, Enter compares.
  const runs = () => [...document.querySelectorAll("#chart g.run")];
  expect(runs().length === 5, `the chart has ${runs().length} runs, not 5`);
  expect(runs().filter((run) => run.getAttribute("tabindex") === "0").length === 1, "the chart is not one stop of Tab");
  expect(runs().every((run) => run.getAttribute("aria-label")), "a run has no name");
  runs()[0].focus();
  const first = $("#details h3")?.textContent;
  expect(first, "focus shows no details");
  expect($("#details code")?.textContent.startsWith("airlight compare cornell"), "details have no command");
  press(document.activeElement, "ArrowRight");
  expect(document.activeElement === runs()[1], "an arrow does not go to the next run");
  expect($("#details h3").textContent !== first, "details do not follow");
  press(document.activeElement, "Enter");
  expect(document.activeElement.matches("g.run"), "focus is lost by comparing");
  press(document.activeElement, "End");
  press(document.activeElement, "Enter");
  await settled();
  expect(document.querySelectorAll("#pair thead th").length === 3, "two runs are not compared");
  expect(document.querySelectorAll('#chart g.run[aria-pressed="true"]').length === 2, "the compared runs are not marked");
  for (const option of $("#chart-form").y.options) {
    choose($("#chart-form").y, option.value);
    expect(runs().length > 0, `no run has ${option.value}`);
  }
  expect($("#chart").innerHTML.indexOf("NaN") < 0, "the chart has no number somewhere");
  expect($("#chart-notes").textContent.includes("Bars"), "no interval is drawn");

  // The viewer: every part, map and layout, and what the keys do.
  const form = $("#viewer form"), canvas = $("#viewer canvas");
  const picture = () => canvas.toDataURL();
  const colours = () => {
    const copy = document.createElement("canvas"), context = copy.getContext("2d", { willReadFrequently: true });
    Object.assign(copy, { width: canvas.width, height: canvas.height });
    context.drawImage(canvas, 0, 0);
    return new Set(new Uint32Array(context.getImageData(0, 0, copy.width, copy.height).data.buffer)).size;
  };
  expect(form.region.options[0].textContent.includes("largest error"), "the crop with the largest error is not the first part");
  await settled();
  for (const region of form.region.options)
    for (const layout of form.layout.options) {
      choose(form.region, region.value);
      choose(form.layout, layout.value);
      await settled();
      expect(colours() > 20, `nothing is seen of ${region.textContent}, ${layout.textContent}`);
    }
  choose(form.layout, "three");
  for (const map of ["error", "flip"]) {
    choose(form.map, map);
    await settled();
    expect($("#viewer .map-key svg"), `there is no histogram of ${map}`);
  }
  canvas.focus();
  const before = picture();
  press(canvas, "m");
  await settled();
  expect(form.map.value === "image" && picture() !== before, "M does not change what is shown");
  for (const [key, what] of [["e", "exposure"], ["t", "tone map"], ["+", "zoom"], ["ArrowLeft", "place"], ["l", "layout"]]) {
    const old = picture();
    press(canvas, key);
    await settled();
    expect(picture() !== old, `${key} does not change the ${what}`);
  }
  choose(form.layout, "one");
  await settled();
  for (const digit of [1, 2, 3]) {
    press(document.body, String(digit), { code: `Digit${digit}` });
    await settled();
    const readout = $("#viewer .readout").textContent;
    expect(readout.includes(digit === 1 ? "· truth" : form.a.options[digit - 1].textContent.slice(2)), `${digit} does not show source ${digit}: ${readout}`);
    expect(/W\/\(m² sr\)/.test(readout), "there is no radiance under the cursor");
  }
  // The truth as canvas and data have it: what is shown of no error is white.
  choose(form.layout, "slider");
  choose(form.a, "0");
  choose(form.b, "1");
  choose(form.map, "error");
  $("#viewer input[name=divider]").value = 0;
  $("#viewer input[name=divider]").dispatchEvent(new Event("input", { bubbles: true }));
  await settled();
  expect(colours() > 5, "the slider does not show B");

  // Tables sort by their headings' buttons, and numbers as numbers.
  const table = $("#overview"), button = [...table.querySelectorAll("thead button")].find((b) => b.textContent.startsWith("frame"));
  const column = [...table.tHead.rows[0].cells].indexOf(button.parentElement);
  const values = () => [...table.tBodies[0].rows].map((row) => Number(row.cells[column].dataset.value));
  button.click();
  expect(values().every((value, i, all) => !i || all[i - 1] <= value), "a table does not sort");
  button.click();
  expect(values().every((value, i, all) => !i || all[i - 1] >= value), "a table does not sort downwards");
  expect(button.parentElement.getAttribute("aria-sort") === "descending", "a table does not say how it is sorted");

  // Names for all that can be used, and nothing beyond the side.
  for (const element of document.querySelectorAll("button, select, input, canvas, [tabindex]")) {
    const name = element.getAttribute("aria-label") || element.textContent.trim() || element.labels?.[0]?.textContent.trim();
    expect(name, `${element.outerHTML.slice(0, 80)} has no name`);
  }
  expect(document.querySelectorAll(".bar").length > 0, "there are no bars of stages");
  for (const details of document.querySelectorAll("details")) details.open = true;
  const width = document.documentElement.clientWidth;
  for (const element of document.querySelectorAll("main *")) {
    const box = element.getBoundingClientRect();
    if (box.width && box.right > width + 1 && !element.closest("svg")) expect(false, `beyond the side: ${element.tagName} ${element.className} ${element.textContent.slice(0, 40)}`);
  }
  for (const each of document.querySelectorAll("table")) expect(each.scrollWidth <= each.clientWidth + 1, `the table ${each.id} scrolls`);
  expect(performance.getEntriesByName("first picture").length === 1, "the first picture is not marked");
  expect(performance.getEntriesByType("resource").length === 0, "something was asked for");
}

walk()
  .catch((error) => wrong.push(String(error)))
  .finally(() => {
    const said = document.createElement("p");
    said.id = "walked";
    said.textContent = wrong.length ? wrong.join("; ") : "passed";
    document.body.append(said);
  });
