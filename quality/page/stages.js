// Bars of the stages of each run's frame.

const stage_colours = ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#b8a800", "#7a7a7a", "#5d4fb3", "#a05a2c"];
const most_bars = 12;

/** Bars of the runs that are compared and of those on the front; of all where they are few. */
function show_stages(marked = [], all = false) {
  const place = document.getElementById("bars");
  const front = new Set(data.devices.flatMap((_, device) => front_of(chart_points({ x: "ms", y: "rrmse", device }).points).map((point) => point.index)));
  let chosen = data.runs.map((_, index) => index);
  const are_many = chosen.length > most_bars;
  if (are_many && !all) chosen = chosen.filter((index) => marked.includes(index) || front.has(index)).slice(0, Math.max(most_bars, marked.length));
  chosen.sort((a, b) => data.runs[a].figures.ms - data.runs[b].figures.ms);
  const sums = chosen.map((index) => Object.values(data.runs[index].stages_ms).reduce((sum, ms) => sum + ms, 0));
  // The slowest may be a method of the CPU, beside which the others are slivers: each is drawn to its own scale then.
  const longest = Math.max(...sums), is_even = longest < 20 * Math.min(...sums);
  const time_of = new Map();
  for (const index of chosen)
    for (const [stage, ms] of Object.entries(data.runs[index].stages_ms)) time_of.set(stage, (time_of.get(stage) ?? 0) + ms / sums[chosen.indexOf(index)]);
  const stages = [...time_of.keys()].sort((a, b) => time_of.get(b) - time_of.get(a));
  const colour = (stage) => stage_colours[stages.indexOf(stage) % stage_colours.length];

  const bar = (index, i) => {
    const run = data.runs[index];
    const parts = stages.filter((stage) => run.stages_ms[stage] > 0);
    const text = parts.map((stage) => `${words(stage)} ${digits(run.stages_ms[stage])} ms`).join(", ");
    return (
      `<div class="bar-row"><span class="bar-name">${escaped(name_of(run))}${front.has(index) ? ' <span title="on the front">●</span>' : ""}</span>` +
      `<div class="bar" role="img" aria-label="${escaped(text)}" style="width:${(100 * (is_even ? sums[i] / longest : 1)).toFixed(2)}%">` +
      parts.map((stage) => `<span style="flex:${run.stages_ms[stage]};background:${colour(stage)}" title="${escaped(words(stage))}: ${digits(run.stages_ms[stage])} ms"></span>`).join("") +
      `</div><span class="bar-sum">${digits(run.figures.ms)} ms</span></div>`
    );
  };
  place.innerHTML =
    `<p class="legend">${stages.map((stage) => `<span><i style="background:${colour(stage)}"></i>${escaped(words(stage))}</span>`).join(" ")}</p>` +
    chosen.map(bar).join("") +
    `<p class="note">${is_even ? "" : "Each bar to its own scale: times differ too much for one. "}Beside each the time of the whole frame.${are_many && !all ? " Runs on the front, and those that are compared." : ""}</p>` +
    (are_many ? `<button type="button" id="all-bars">${all ? "Show fewer" : `Show all ${data.runs.length}`}</button>` : "");
  document.getElementById("all-bars")?.addEventListener("click", () => show_stages(marked, !all));
}
