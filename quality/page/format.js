// Words and numbers of the page, and the styles of methods.

const data = JSON.parse(document.getElementById("data").textContent);
const lacking = "–";

function escaped(text) {
  return String(text).replace(/[&<>"]/g, (c) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" })[c]);
}

/** Three digits, as "0.0123", "12.3", "1.2e-5". */
function digits(value, count = 3) {
  if (value === null || value === undefined || Number.isNaN(value)) return lacking;
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size < 1e-4 || size >= 1e6) return value.toExponential(count - 1).replace("e+", "e");
  return String(Number(value.toPrecision(count)));
}

/** What a run can be told by. `scale` makes what is shown of what is kept. */
const quantities = {
  ms: { label: "frame time", unit: "ms", scale: 1, low: "ms_low", high: "ms_high" },
  ratio: { label: "time / baseline", unit: "", scale: 1, low: "ratio_low", high: "ratio_high" },
  bytes: { label: "GPU memory", unit: "MiB", scale: 1 / 1048576 },
  rrmse: { label: "same-surface rrmse", unit: "%", scale: 100, bound: data.bound },
  flip: { label: "ꟻLIP", unit: "", scale: 1 },
  p99: { label: "p99", unit: "%", scale: 100 },
  flicker: { label: "flicker", unit: "%", scale: 100, bound: 2 * data.bound },
  wrong: { label: "wrong surface pixels", unit: "%", scale: 100, bound: data.pixel },
};

function with_unit(quantity) {
  return quantity.unit ? `${quantity.label} [${quantity.unit}]` : quantity.label;
}

function shown(run, name) {
  const value = run.figures[name], quantity = quantities[name];
  if (value === null) return lacking;
  if (quantity.bound && value <= quantity.bound) return `< ${digits(quantity.bound * quantity.scale)}`;
  return digits(value * quantity.scale);
}

function name_of(run) {
  const map = run.shadow_map ? `, shadow map ${run.shadow_map}` : "";
  return `${run.volume} × ${run.surface}${data.runs.some((other) => other.shadow_map !== run.shadow_map) ? map : ""}`;
}

/** Settings of a run that not all runs share, as "alpha=64, phi=128". */
const varying = (() => {
  const values = new Map();
  for (const run of data.runs)
    for (const [name, value] of Object.entries(run.settings)) {
      const key = `${run.method} ${name}`;
      if (!values.has(key)) values.set(key, new Set());
      values.get(key).add(value);
    }
  return (run) =>
    Object.entries(run.settings)
      .filter(([name]) => values.get(`${run.method} ${name}`).size > 1)
      .map(([name, value]) => `${name}=${value}`)
      .join(", ");
})();

// Methods are told apart by colour and by shape, since not everybody sees colours. The colours are Okabe and Ito's
// ("Color Universal Design", 2008), darker on white and lighter on black where they would fade.
const method_names = [...new Set(data.runs.map((run) => run.method))];
const light_colours = ["#0072b2", "#d55e00", "#008661", "#a8548a", "#8a6d00", "#2b8fc4", "#555555", "#8c3b00"];
const dark_colours = ["#56b4e9", "#ff8a3d", "#2fd0a0", "#e79ac6", "#f0e442", "#9fd3f2", "#bbbbbb", "#e0a070"];
const shapes = [
  (r) => `<circle r="${r}"/>`,
  (r) => `<rect x="${-r}" y="${-r}" width="${2 * r}" height="${2 * r}"/>`,
  (r) => `<path d="M0 ${-1.3 * r}L${1.2 * r} ${0.8 * r}H${-1.2 * r}Z"/>`,
  (r) => `<path d="M0 ${-1.4 * r}L${1.4 * r} 0L0 ${1.4 * r}L${-1.4 * r} 0Z"/>`,
  (r) => `<path d="M0 ${1.3 * r}L${1.2 * r} ${-0.8 * r}H${-1.2 * r}Z"/>`,
  (r) => `<path d="M${-r} ${-0.4 * r}H${-0.4 * r}V${-r}H${0.4 * r}V${-0.4 * r}H${r}V${0.4 * r}H${0.4 * r}V${r}H${-0.4 * r}V${0.4 * r}H${-r}Z" transform="scale(1.25)"/>`,
  (r) => `<path d="M${-1.3 * r} 0L${-0.65 * r} ${-1.1 * r}H${0.65 * r}L${1.3 * r} 0L${0.65 * r} ${1.1 * r}H${-0.65 * r}Z"/>`,
  (r) => `<path d="M0 ${-1.5 * r}L${0.45 * r} ${-0.45 * r}L${1.5 * r} 0L${0.45 * r} ${0.45 * r}L0 ${1.5 * r}L${-0.45 * r} ${0.45 * r}L${-1.5 * r} 0L${-0.45 * r} ${-0.45 * r}Z"/>`,
];
const is_dark = window.matchMedia("(prefers-color-scheme: dark)");
const paper_theme = { ink: "#1b1d21", faint: "#5b626d", grid: "#d9dde3", paper: "#ffffff", colours: light_colours };
const dark_theme = { ink: "#e8eaed", faint: "#a5adb8", grid: "#3a4049", paper: "#16181c", colours: dark_colours };

function theme() {
  return is_dark.matches ? dark_theme : paper_theme;
}

function colour_of(run, of_theme) {
  return of_theme.colours[method_names.indexOf(run.method) % of_theme.colours.length];
}

function shape_of(run, radius) {
  return shapes[method_names.indexOf(run.method) % shapes.length](radius);
}

/** Hands a text to the browser as a file to keep. */
function save(name, type, text) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

function file_name(what) {
  return `${data.scene.replace(/^.*[\\/]/, "").replace(/\.[^.]*$/, "").replace(/[^\w-]+/g, "_")}_${what}`;
}
