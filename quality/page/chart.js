// The chart: every run's cost against its error, on logarithmic axes.

/** Ticks of a logarithmic axis: the fewer decades it spans, the more of each. */
function log_ticks(low, high) {
  const decades = Math.log10(high / low);
  const steps = decades > 2.5 ? [1] : decades > 1 ? [1, 2, 5] : decades > 0.5 ? [1, 1.5, 2, 3, 4, 5, 7] : [1, 1.2, 1.4, 1.6, 1.8, 2, 2.5, 3, 3.5, 4, 4.5, 5, 6, 7, 8, 9];
  const ticks = [];
  for (let decade = Math.floor(Math.log10(low)); decade <= Math.log10(high); ++decade)
    for (const step of steps) {
      const tick = step * 10 ** decade;
      if (tick >= low * 0.999 && tick <= high * 1.001) ticks.push(tick);
    }
  return ticks;
}

/** Of points those that none beats in both: the first of them costs least, the last errs least. */
function front_of(points) {
  const front = [];
  for (const point of [...points].sort((a, b) => a.x - b.x || a.y - b.y))
    if (!front.length || point.y < front[front.length - 1].y) front.push(point);
  return front;
}

/** Runs that have both quantities, and how many have not. An error within the truth's own is drawn at that. */
function chart_points(choice) {
  const x = quantities[choice.x], y = quantities[choice.y];
  const points = [];
  let zero = 0, none = 0;
  data.runs.forEach((run, index) => {
    if (run.device !== choice.device) return;
    const cost = run.figures[choice.x], kept = run.figures[choice.y];
    if (cost === null || kept === null) return void ++none;
    const is_bound = Boolean(y.bound) && kept <= y.bound;
    const error = is_bound ? y.bound : kept;
    if (!(cost > 0) || !(error > 0)) return void ++zero;
    const end = (quantity, name, scale) => (quantity[name] && run.figures[quantity[name]] > 0 ? run.figures[quantity[name]] * scale : null);
    points.push({
      run, index, is_bound,
      x: cost * x.scale, x_low: end(x, "low", x.scale), x_high: end(x, "high", x.scale),
      y: error * y.scale, y_low: end(y, "low", y.scale), y_high: end(y, "high", y.scale),
    });
  });
  return { points, zero, none };
}

function span_of(values) {
  let low = Math.min(...values), high = Math.max(...values);
  if (!(high / low > 1.5)) { low /= 1.6; high *= 1.6; }
  const margin = (high / low) ** 0.06;
  return [low / margin, high * margin];
}

/**
 * The chart as SVG.
 * @param choice {x, y, device}: names of quantities, number of the device
 * @param marked numbers of the runs that are compared
 * @returns {svg, points: in the order in which the arrow keys go}
 */
function chart_svg(choice, width, of_theme, marked = []) {
  const { points, zero, none } = chart_points(choice);
  const narrow = width < 560;
  const height = Math.round(Math.min(560, Math.max(320, width * 0.62)));
  const methods = method_names.filter((name) => points.some((point) => point.run.method === name));
  const legend_columns = narrow ? 2 : Math.min(4, Math.max(1, methods.length + 1));
  const legend_height = Math.ceil((methods.length + 1) / legend_columns) * 20 + 6;
  const left = 62, right = 14, top = legend_height, bottom = 46;
  const head = `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${width} ${height}" width="${width}" height="${height}" font-family="system-ui, -apple-system, 'Segoe UI', Helvetica, Arial, sans-serif" font-size="12">`;
  const title = `${data.scene}: ${with_unit(quantities[choice.y])} against ${with_unit(quantities[choice.x])}`;
  if (!points.length)
    return { svg: `${head}<title>${escaped(title)}</title><text x="${width / 2}" y="${height / 2}" text-anchor="middle" fill="${of_theme.faint}">no run has both figures</text></svg>`, points, zero, none };

  const [x_low, x_high] = span_of(points.flatMap((p) => [p.x, p.x_low ?? p.x, p.x_high ?? p.x]));
  const [y_low, y_high] = span_of(points.flatMap((p) => [p.y, p.y_low ?? p.y, p.y_high ?? p.y]));
  const at_x = (value) => left + ((width - left - right) * Math.log(value / x_low)) / Math.log(x_high / x_low);
  const at_y = (value) => height - bottom - ((height - top - bottom) * Math.log(value / y_low)) / Math.log(y_high / y_low);
  const px = (value) => value.toFixed(1);

  let grid = "";
  for (const tick of log_ticks(x_low, x_high))
    grid += `<path d="M${px(at_x(tick))} ${top}V${height - bottom}" stroke="${of_theme.grid}"/><text x="${px(at_x(tick))}" y="${height - bottom + 17}" text-anchor="middle">${digits(tick)}</text>`;
  for (const tick of log_ticks(y_low, y_high))
    grid += `<path d="M${left} ${px(at_y(tick))}H${width - right}" stroke="${of_theme.grid}"/><text x="${left - 7}" y="${px(at_y(tick) + 4)}" text-anchor="end">${digits(tick)}</text>`;
  const axes =
    `<g fill="${of_theme.faint}">${grid}</g><rect x="${left}" y="${top}" width="${width - left - right}" height="${height - top - bottom}" fill="none" stroke="${of_theme.faint}"/>` +
    `<text x="${(left + width - right) / 2}" y="${height - 8}" text-anchor="middle" fill="${of_theme.ink}">${escaped(with_unit(quantities[choice.x]))}</text>` +
    `<text transform="translate(14 ${(top + height - bottom) / 2}) rotate(-90)" text-anchor="middle" fill="${of_theme.ink}">${escaped(with_unit(quantities[choice.y]))}</text>`;

  const line = (front) => front.map((p, i) => `${i ? "L" : "M"}${px(at_x(p.x))} ${px(at_y(p.y))}`).join("");
  const overall = front_of(points);
  let lines = `<path class="overall" d="${line(overall)}" fill="none" stroke="${of_theme.grid}" stroke-width="9" stroke-linejoin="round" stroke-linecap="round"/>`;
  for (const name of methods) {
    const front = front_of(points.filter((point) => point.run.method === name));
    lines += `<path d="${line(front)}" fill="none" stroke="${colour_of(front[0].run, of_theme)}" stroke-width="1.5"/>`;
  }

  let marks = "";
  points.sort((a, b) => a.x - b.x || a.y - b.y);
  for (const point of points) {
    const colour = colour_of(point.run, of_theme);
    const x = at_x(point.x), y = at_y(point.y);
    let bars = "";
    if (point.x_low) bars += `<path d="M${px(at_x(point.x_low) - x)} 0H${px(at_x(point.x_high) - x)}m0 -3v6M${px(at_x(point.x_low) - x)} -3v6"/>`;
    if (point.y_low) bars += `<path d="M0 ${px(at_y(point.y_low) - y)}V${px(at_y(point.y_high) - y)}"/>`;
    const label = `${name_of(point.run)}: ${with_unit(quantities[choice.x])} ${shown(point.run, choice.x)}, ${with_unit(quantities[choice.y])} ${shown(point.run, choice.y)}${overall.includes(point) ? ", on the front" : ""}`;
    marks +=
      `<g class="run" data-run="${point.index}" transform="translate(${px(x)} ${px(y)})" role="button" tabindex="-1" aria-pressed="${marked.includes(point.index)}" aria-label="${escaped(label)}" ` +
      `fill="${point.is_bound ? of_theme.paper : colour}" stroke="${colour}" stroke-width="1.2"><circle r="11" fill="transparent" stroke="none"/>${bars}${shape_of(point.run, 4.5)}` +
      (point.is_bound ? `<path d="M0 7v7m-3 -3l3 3l3 -3" fill="none"/>` : "") +
      (overall.includes(point) ? `<circle r="8.5" fill="none" stroke="${of_theme.ink}" stroke-width="1"/>` : "") +
      (marked.includes(point.index) ? `<rect x="-11" y="-11" width="22" height="22" fill="none" stroke="${of_theme.ink}" stroke-width="2"/><text x="13" y="-7" fill="${of_theme.ink}" stroke="none" font-weight="700">${"AB"[marked.indexOf(point.index)]}</text>` : "") +
      `</g>`;
  }

  const cell = (width - left - right) / legend_columns;
  const legend = [...methods.map((name) => {
    const run = data.runs.find((other) => other.method === name), colour = colour_of(run, of_theme);
    return `<g fill="${colour}" stroke="${colour}">${shape_of(run, 4.5)}</g><text x="12" y="4">${escaped(name)}</text>`;
  }), `<path d="M-6 0H6" stroke="${of_theme.grid}" stroke-width="9" stroke-linecap="round"/><circle r="6.5" fill="none" stroke="${of_theme.ink}"/><text x="16" y="4">front of all</text>`]
    .map((entry, i) => `<g transform="translate(${px(left + 8 + (i % legend_columns) * cell)} ${12 + Math.floor(i / legend_columns) * 20})">${entry}</g>`)
    .join("");
  const svg = `${head}<title>${escaped(title)}</title>${axes}<g stroke-linejoin="round">${lines}</g>${marks}<g fill="${of_theme.ink}">${legend}</g></svg>`;
  return { svg, points, zero, none };
}

class Chart {
  /** @param on {focus(run number), choose(run number)} */
  constructor(on) {
    this.on = on;
    this.marked = [];
    this.place = document.getElementById("chart");
    this.form = document.getElementById("chart-form");
    const has = (name) => data.runs.some((run) => run.figures[name] !== null);
    const baselines = new Set(data.runs.map((run) => run.baseline_key));
    const fill = (select, names) => {
      select.innerHTML = names.map((name) => `<option value="${name}">${escaped(with_unit(quantities[name]))}</option>`).join("");
    };
    const errors = ["rrmse", "flip", "p99", "flicker"];
    fill(this.form.y, (data.compares_surfaces ? ["wrong", ...errors, "bytes"] : [...errors, "wrong", "bytes"]).filter(has));
    // Ratios to several baselines say nothing of each other.
    fill(this.form.x, ["ms", "ratio", "bytes"].filter((name) => has(name) && (name !== "ratio" || baselines.size === 1)));
    this.form.device.innerHTML = data.devices.map((name, i) => `<option value="${i}">${escaped(name)}</option>`).join("");
    this.form.querySelector(".device").hidden = data.devices.length < 2;
    this.form.addEventListener("change", () => this.draw());
    document.getElementById("save-chart").addEventListener("click", () => save(`${file_name("chart")}.svg`, "image/svg+xml", this.for_paper()));

    for (const event of ["pointerover", "focusin"])
      this.place.addEventListener(event, (e) => {
        const group = e.target.closest("g.run");
        if (group) this.on.focus(Number(group.dataset.run));
      });
    this.place.addEventListener("click", (e) => {
      const group = e.target.closest("g.run");
      if (group) this.on.choose(Number(group.dataset.run));
    });
    this.place.addEventListener("keydown", (e) => this.key(e));
    is_dark.addEventListener("change", () => this.draw());
    new ResizeObserver(() => this.draw_if_resized()).observe(this.place);
    this.draw();
  }

  choice() {
    return { x: this.form.x.value, y: this.form.y.value, device: Number(this.form.device.value) };
  }

  /** The chart for print, on white, 720 wide. */
  for_paper() {
    return chart_svg(this.choice(), 720, paper_theme).svg.replace(/ (role|tabindex|aria-[a-z]+|data-run)="[^"]*"/g, "");
  }

  draw_if_resized() {
    if (Math.abs(this.place.clientWidth - this.width) > 1) this.draw();
  }

  draw() {
    const focused = document.activeElement?.closest?.("g.run")?.dataset.run;
    this.width = Math.max(300, this.place.clientWidth);
    const { svg, points, zero, none } = chart_svg(this.choice(), this.width, theme(), this.marked);
    this.order = points.map((point) => point.index);
    this.place.innerHTML = svg;
    const drawing = this.place.firstElementChild;
    drawing.setAttribute("role", "group");
    drawing.setAttribute("aria-label", `${drawing.querySelector("title").textContent}. ${this.order.length} runs; arrow keys go from run to run, Enter compares.`);
    const first = this.group(focused ?? this.order[0]);
    if (first) first.setAttribute("tabindex", "0");
    if (focused !== undefined) this.group(focused)?.focus({ preventScroll: true });
    const notes = [];
    const y = quantities[this.choice().y];
    if (points.some((point) => point.is_bound)) notes.push(`Hollow, with an arrow: not above ${y === quantities.wrong ? "one pixel" : "the bound of the truth’s own error"}, ${digits(y.bound * y.scale)} %.`);
    if (zero) notes.push(`${zero} without error, which a logarithmic axis cannot show.`);
    if (none) notes.push(`${none} without these figures.`);
    if (points.some((point) => point.x_low)) notes.push("Bars: intervals that hold the median at 95 % or more.");
    document.getElementById("chart-notes").textContent = notes.join(" ");
  }

  group(run) {
    return this.place.querySelector(`g.run[data-run="${run}"]`);
  }

  mark(runs) {
    this.marked = runs;
    this.draw();
  }

  key(e) {
    const group = e.target.closest("g.run");
    if (!group) return;
    const here = this.order.indexOf(Number(group.dataset.run));
    const steps = { ArrowRight: here + 1, ArrowLeft: here - 1, ArrowUp: here + 1, ArrowDown: here - 1, Home: 0, End: this.order.length - 1 };
    if (e.key in steps) {
      const next = this.group(this.order[Math.min(Math.max(steps[e.key], 0), this.order.length - 1)]);
      group.setAttribute("tabindex", "-1");
      next.setAttribute("tabindex", "0");
      next.focus();
      e.preventDefault();
    } else if (e.key === "Enter" || e.key === " ") {
      this.on.choose(Number(group.dataset.run));
      e.preventDefault();
    }
  }
}
