// What is known of one run, and of two beside each other.

function terms(pairs) {
  return `<dl class="short">${pairs.map(([name, text]) => `<dt>${escaped(name)}</dt><dd>${escaped(text)}</dd>`).join("")}</dl>`;
}

function mebibytes(bytes) {
  return `${digits(bytes / 1048576)} MiB`;
}

function words(name) {
  return name.replaceAll("_", " ");
}

function show_details(index) {
  const run = data.runs[index];
  const lines = [];
  for (const [name, quantity] of Object.entries(quantities)) {
    if (run.figures[name] === null) continue;
    const low = run.figures[quantity.low], high = run.figures[quantity.high];
    const interval = low ? ` (${digits(low * quantity.scale)} to ${digits(high * quantity.scale)})` : "";
    lines.push([quantity.label, `${shown(run, name)}${quantity.unit ? ` ${quantity.unit}` : ""}${interval}`]);
  }
  if (run.baseline) lines.push(["baseline", run.baseline]);
  const part = (heading, entries, text) => (entries.length ? `<h4>${heading}</h4>${terms(entries.map(([name, value]) => [words(name), text(value)]))}` : "");
  const by_size = (object) => Object.entries(object ?? {}).sort((a, b) => b[1] - a[1]);
  document.getElementById("details").innerHTML =
    `<h3>${escaped(name_of(run))}</h3>${data.devices.length > 1 ? `<p>${escaped(data.devices[run.device])}</p>` : ""}${terms(lines)}` +
    part("Stages [ms]", by_size(run.stages_ms), digits) +
    part("Memory", by_size(run.bytes), mebibytes) +
    part("Counters, a pixel", Object.entries(run.counters ?? {}), digits) +
    part("Settings", Object.entries(run.settings), String) +
    part("Settings of the surface shadow", Object.entries(run.surface_settings), String) +
    `<h4>Command</h4><code tabindex="0">${escaped(run.command)}</code>`;
}

function show_pair(marked) {
  const place = document.getElementById("pair");
  const runs = marked.map((index) => data.runs[index]);
  if (!runs.length) {
    place.innerHTML = "";
    return;
  }
  const rows = [];
  const row = (name, values, ratio = "") =>
    rows.push(`<tr><th scope="row">${escaped(name)}</th>${values.map((value) => `<td>${escaped(value)}</td>`).join("")}${runs.length > 1 ? `<td>${ratio}</td>` : ""}</tr>`);
  for (const [name, quantity] of Object.entries(quantities)) {
    const values = runs.map((run) => run.figures[name]);
    if (values.every((value) => value === null)) continue;
    row(with_unit(quantity), runs.map((run) => shown(run, name)), values.length > 1 && values[0] && values[1] !== null ? digits(values[1] / values[0]) : "");
  }
  // Of settings those that both have, and otherwise.
  for (const name of Object.keys(runs[0].settings)) {
    const values = runs.map((run) => run.settings[name]);
    if (!values.includes(undefined) && new Set(values).size > 1) row(name, values);
  }
  place.innerHTML =
    `<table class="pair"><caption>${runs.length > 1 ? "The two that are compared" : "Choose another one to compare with"}</caption><thead><tr><td></td>` +
    runs.map((run, i) => `<th scope="col">${"AB"[i]}: ${escaped(name_of(run))}</th>`).join("") +
    `${runs.length > 1 ? '<th scope="col">B / A</th>' : ""}</tr></thead><tbody>${rows.join("")}</tbody></table>`;
}
