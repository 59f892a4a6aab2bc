// The viewer: the truth, a method and another one on one canvas, as radiance, signed error or ꟻLIP.

const viewer_layouts = { three: "side by side", slider: "slider", one: "one at a time" };
const viewer_maps = { image: "radiance", error: "signed error", flip: "ꟻLIP" };
const tallest_pane = 640; // CSS pixels

class Viewer {
  constructor(place) {
    this.place = place;
    const images = data.images;
    if (!images) {
      place.innerHTML = `<p class="note">${escaped(data.no_images)}</p>`;
      return;
    }
    this.sources = [new Source("truth", images.truth), ...Object.entries(images.runs).map(([run, json]) => new Source(name_of(data.runs[run]), json, Number(run)))];
    this.state = { region: -1, layout: this.sources.length > 2 ? "three" : "slider", map: "image", a: Math.min(1, this.sources.length - 1), b: Math.min(2, this.sources.length - 1), one: 0, divider: 0.5, stops: 0, tone: "none" };
    if (this.sources.length < 3) Object.assign(this.state, { a: 0, b: this.sources.length - 1 });
    this.view = { scale: 1, x: 0, y: 0 };
    this.sheets = new Map();
    this.pointers = new Map();
    this.build();
    this.start();
  }

  // What stands around the canvas.

  build() {
    const options = (entries) => entries.map(([value, text]) => `<option value="${value}">${escaped(text)}</option>`).join("");
    const whole = data.images.reduced > 1 ? `whole image, at 1/${data.images.reduced}` : "whole image";
    const regions = [...data.images.crops.map((_, i) => [i, i ? `crop ${i + 1}` : "crop 1: the largest error"]), [-1, whole]];
    const sources = options(this.sources.map((source, i) => [i, `${i + 1} ${source.name}`]));
    this.place.innerHTML =
      `<form class="controls" aria-label="Viewer">` +
      `<label>part <select name="region">${options(regions)}</select></label>` +
      `<label>show <select name="map">${options(Object.entries(viewer_maps))}</select></label>` +
      `<label>layout <select name="layout">${options(Object.entries(viewer_layouts))}</select></label>` +
      `<label>A <select name="a">${sources}</select></label><label>B <select name="b">${sources}</select></label>` +
      `<label>exposure <input name="stops" type="range" min="-12" max="12" step="0.1"><output name="stops_text"></output></label>` +
      `<label>tone map <select name="tone">${options(Object.keys(tone_maps).map((name) => [name, name]))}</select></label>` +
      `<span class="buttons"><button type="button" name="out" aria-label="Zoom out">−</button><button type="button" name="in" aria-label="Zoom in">+</button><button type="button" name="fit">Fit</button></span>` +
      `</form><canvas tabindex="0" role="img" aria-label="Images of the airlight. Keys 1 to 9 choose what is shown, arrows move, plus and minus zoom."></canvas>` +
      `<label class="divider">divider <input name="divider" type="range" min="0" max="1" step="0.005" value="0.5" aria-label="Where the slider divides A from B"></label>` +
      `<p class="readout" role="status"></p><div class="map-key"></div><p class="note viewer-note"></p>` +
      `<details class="keys"><summary>Keys</summary><p>1 to 9: the truth and methods, as A, or alone where one is shown at a time; with Shift as B. On the canvas: arrows move, + and − zoom, 0 fits, M changes between radiance, signed error and ꟻLIP, L the layout, C the part, T the tone map, E and Shift+E the exposure, A makes it automatic, [ and ] move the divider. A wheel zooms once the canvas has been clicked, or with Ctrl.</p></details>`;
    this.form = this.place.querySelector("form");
    this.canvas = this.place.querySelector("canvas");
    this.context = this.canvas.getContext("2d");
    this.divider = this.place.querySelector("input[name=divider]");

    this.form.addEventListener("submit", (e) => e.preventDefault());
    this.form.addEventListener("input", () => this.read_form());
    this.divider.addEventListener("input", () => this.set({ divider: Number(this.divider.value) }));
    this.form.addEventListener("click", (e) => {
      const name = e.target.name;
      if (name === "in") this.zoom(1.5);
      if (name === "out") this.zoom(1 / 1.5);
      if (name === "fit") this.fit();
    });
    this.canvas.addEventListener("keydown", (e) => this.key(e));
    document.addEventListener("keydown", (e) => this.digit_key(e));
    this.canvas.addEventListener("pointerdown", (e) => this.pointer_down(e));
    this.canvas.addEventListener("pointermove", (e) => this.pointer_move(e));
    for (const event of ["pointerup", "pointercancel"]) this.canvas.addEventListener(event, (e) => this.pointers.delete(e.pointerId));
    this.canvas.addEventListener("pointerleave", () => {
      this.cursor = null;
      this.tell();
    });
    this.canvas.addEventListener("wheel", (e) => this.wheel(e), { passive: false });
    new ResizeObserver(() => this.resize()).observe(this.place);
  }

  async start() {
    this.automatic_exposure(await this.sources[0].radiance(-1));
    this.set({});
  }

  /** The 95th percentile of the pixels' largest channel is 0.8 of white, as of previews. */
  automatic_exposure(truth) {
    const brightest = new Float32Array(truth.width * truth.height);
    for (let i = 0; i < brightest.length; ++i) brightest[i] = Math.max(truth.values[3 * i], truth.values[3 * i + 1], truth.values[3 * i + 2]);
    brightest.sort();
    const white = brightest[Math.floor((brightest.length - 1) * 0.95)] || brightest[brightest.length - 1];
    this.automatic_stops = white > 0 ? Math.log2(0.8 / (white * data.images.unit)) : 0;
    this.state.stops = 0;
  }

  read_form() {
    const form = this.form;
    this.set({ region: Number(form.region.value), map: form.map.value, layout: form.layout.value, a: Number(form.a.value), b: Number(form.b.value), stops: Number(form.stops.value), tone: form.tone.value });
  }

  /** Changes what is shown. */
  set(change) {
    const before = this.state;
    this.state = { ...before, ...change };
    const { state, form } = this;
    for (const name of ["region", "map", "layout", "a", "b", "stops", "tone"]) form[name].value = state[name];
    this.divider.value = state.divider;
    this.divider.parentElement.hidden = state.layout !== "slider";
    form.stops_text.value = `${state.stops > 0 ? "+" : ""}${Number(state.stops).toFixed(1)}`;
    if (state.stops !== before.stops || state.tone !== before.tone) this.sheets = new Map([...this.sheets].filter(([key]) => !key.startsWith("image")));
    this.load(state.region !== before.region || state.layout !== before.layout || !this.size);
  }

  /** Shows these runs as A and B, where they have images. */
  choose(runs) {
    if (!data.images) return;
    const found = runs.map((run) => this.sources.findIndex((source) => source.run === run)).filter((index) => index > 0);
    if (!found.length) return;
    this.set({ a: found[0], b: found[1] ?? (this.sources.length > 2 && this.state.b !== found[0] ? this.state.b : 0) });
  }

  // Pixels.

  /** The numbers of the sources that panes show, in their order. */
  shown() {
    const { layout, a, b, one } = this.state;
    if (layout === "one") return [one];
    return layout === "slider" ? [a, b] : [...new Set([0, a, b])];
  }

  map_of(index) {
    const { map } = this.state;
    if (index === 0 || map === "image") return "image";
    return map === "flip" && !this.sources[index].has_flip(this.state.region) ? "none" : map;
  }

  async load(refit) {
    const turn = (this.turn = (this.turn ?? 0) + 1);
    this.place.setAttribute("aria-busy", "true");
    const { region } = this.state;
    const indices = this.shown();
    const missing = indices.filter((index) => !this.sources[index].has(region) || this.map_of(index) === "none");
    const present = indices.filter((index) => !missing.includes(index));
    const [truth, ...images] = await Promise.all([this.sources[0].radiance(region), ...present.map((index) => this.sources[index].radiance(region))]);
    const flips = await Promise.all(present.map((index) => (this.map_of(index) === "flip" ? this.sources[index].flip(region) : null)));
    if (turn !== this.turn) return;
    this.loaded = turn;
    this.truth = truth;
    this.size = { width: truth.width, height: truth.height };
    this.panes = indices.map((index) => {
      const at = present.indexOf(index);
      return at < 0 ? { index } : { index, image: images[at], flip: flips[at], sheet: this.sheet(index, images[at], flips[at]) };
    });
    const notes = [];
    for (const index of missing) {
      const source = this.sources[index];
      notes.push(source.has(region) ? `${source.name}: there is no ꟻLIP against a dark truth.` : `${source.name}: kept as crops alone; choose one as part.`);
    }
    if (region < 0 && data.images.reduced > 1) notes.push(`Each pixel is the mean of ${data.images.reduced} × ${data.images.reduced}; the crops have all.`);
    if (data.images.without) notes.push(`Without images for want of room: ${data.images.without} runs.`);
    this.place.querySelector(".viewer-note").textContent = notes.join(" ");
    this.show_key();
    if (refit) this.resize(true);
    else this.paint();
  }

  /** A canvas of what a source looks like. */
  sheet(index, image, flip) {
    const { region, stops, tone } = this.state;
    const map = this.map_of(index), key = `${map} ${region} ${index}`;
    if (this.sheets.has(key)) return this.sheets.get(key);
    const pixels = new ImageData(image.width, image.height), out = pixels.data;
    const exposure = 2 ** (this.automatic_stops + stops) * data.images.unit, tone_map = tone_maps[tone];
    for (let i = 0; i < image.width * image.height; ++i) {
      let colour;
      if (map === "flip") colour = flip_colour(flip.values[i]);
      else if (map === "error") colour = error_colour(error_depth(this.error_at(image, i)));
      else colour = tone_map([0, 1, 2].map((c) => Math.max(image.values[3 * i + c] * exposure, 0))).map(srgb);
      out.set(colour, 4 * i);
      out[4 * i + 3] = 255;
    }
    const canvas = document.createElement("canvas");
    canvas.width = image.width;
    canvas.height = image.height;
    canvas.getContext("2d").putImageData(pixels, 0, 0);
    this.sheets.set(key, canvas);
    return canvas;
  }

  /** Signed, the mean over RGB, over the truth's mean. */
  error_at(image, i) {
    let sum = 0;
    for (let c = 0; c < 3; ++c) sum += image.values[3 * i + c] - this.truth.values[3 * i + c];
    return ((sum / 3) * data.images.unit) / data.images.mean;
  }

  // Scale and histogram of the maps.

  show_key() {
    const place = this.place.querySelector(".map-key"), { map } = this.state;
    const of_maps = this.panes.filter((pane) => pane.sheet && this.map_of(pane.index) === map);
    if (map === "image" || !of_maps.length) {
      place.innerHTML = "";
      return;
    }
    const bins = 60, width = 300, height = 70;
    const colour = (bin) => (map === "error" ? error_colour((2 * (bin + 0.5)) / bins - 1) : flip_colour((bin + 0.5) / bins));
    const ends = map === "error" ? ["−100 %", "±0.1 %", "+100 %"] : ["0", "0.5", "1"];
    const histogram = (pane) => {
      const counts = new Array(bins).fill(0), pixels = pane.image.width * pane.image.height;
      for (let i = 0; i < pixels; ++i) {
        const place_in = map === "error" ? (error_depth(this.error_at(pane.image, i)) + 1) / 2 : pane.flip.values[i];
        ++counts[Math.min(Math.floor(place_in * bins), bins - 1)];
      }
      const tall = (count) => (count ? (height * Math.log(1 + count)) / Math.log(1 + pixels) : 0);
      const step = width / bins;
      const bars = counts.map((count, bin) => `<rect x="${(bin * step).toFixed(1)}" y="${(height - tall(count)).toFixed(1)}" width="${step.toFixed(1)}" height="${tall(count).toFixed(1)}" fill="currentColor"/>`).join("");
      const scale = counts.map((_, bin) => `<rect x="${(bin * step).toFixed(1)}" y="${height + 2}" width="${(step + 0.5).toFixed(1)}" height="10" fill="rgb(${colour(bin)})"/>`).join("");
      const labels = ends.map((text, i) => `<text x="${(i * width) / 2}" y="${height + 25}" text-anchor="${["start", "middle", "end"][i]}" fill="currentColor" font-size="11">${text}</text>`).join("");
      return `<figure><svg viewBox="0 0 ${width} ${height + 28}" width="${width}" height="${height + 28}" role="img" aria-label="Histogram of the ${viewer_maps[map]}, pixels on a logarithmic axis">${bars}${scale}${labels}</svg><figcaption>${escaped(this.sources[pane.index].name)}: pixels, logarithmic</figcaption></figure>`;
    };
    place.innerHTML = of_maps.map(histogram).join("");
  }

  // Painting.

  /** The rectangles of the panes [CSS pixels]; those of a slider are one, and both its halves. */
  rectangles() {
    const width = this.canvas.clientWidth, count = this.panes.length;
    if (this.state.layout !== "three") return this.panes.map(() => ({ x: 0, y: 0, width, height: this.height }));
    const is_stacked = this.is_stacked();
    return this.panes.map((_, i) => (is_stacked ? { x: 0, y: (i * this.height) / count, width, height: this.height / count } : { x: (i * width) / count, y: 0, width: width / count, height: this.height }));
  }

  is_stacked() {
    return this.canvas.clientWidth < 600;
  }

  resize(refit = false) {
    if (!this.size) return;
    const width = this.canvas.clientWidth, count = this.state.layout === "three" ? this.panes.length : 1;
    if (!refit && width === this.last_width) return;
    this.last_width = width;
    const of_pane = this.is_stacked() ? width : width / count;
    const tall = Math.min((of_pane * this.size.height) / this.size.width, tallest_pane);
    this.height = Math.round(this.is_stacked() ? tall * count : tall);
    this.canvas.style.height = `${this.height}px`;
    this.fit();
  }

  fit() {
    const pane = this.rectangles()[0];
    this.fitted = Math.min(pane.width / this.size.width, pane.height / this.size.height);
    this.view = { scale: this.fitted, x: this.size.width / 2, y: this.size.height / 2 };
    this.paint();
  }

  paint() {
    if (this.is_waiting) return;
    this.is_waiting = true;
    this.place.setAttribute("aria-busy", "true");
    requestAnimationFrame(() => {
      this.is_waiting = false;
      this.paint_now();
      if (!performance.getEntriesByName("first picture").length) performance.mark("first picture");
      this.place.setAttribute("aria-busy", String(this.turn !== this.loaded));
    });
  }

  paint_now() {
    const ratio = window.devicePixelRatio || 1, { context, canvas, view, state } = this;
    canvas.width = Math.round(canvas.clientWidth * ratio);
    canvas.height = Math.round(this.height * ratio);
    context.scale(ratio, ratio);
    context.imageSmoothingEnabled = false;
    canvas.style.touchAction = view.scale > this.fitted * 1.01 ? "none" : "pan-y";
    const rectangles = this.rectangles();
    this.panes.forEach((pane, i) => {
      const { x, y, width, height } = rectangles[i];
      const edge = x + width * state.divider;
      context.save();
      context.beginPath();
      if (state.layout === "slider" && i === 1) context.rect(edge, y, width - edge, height);
      else context.rect(x, y, width, height);
      context.clip();
      context.fillStyle = "#000";
      context.fillRect(x, y, width, height);
      if (pane.sheet) {
        const left = x + width / 2 - view.x * view.scale, top = y + height / 2 - view.y * view.scale;
        context.drawImage(pane.sheet, left, top, this.size.width * view.scale, this.size.height * view.scale);
      }
      const is_right = state.layout === "slider" && i === 1;
      const name = this.sources[pane.index].name + (pane.index && state.map !== "image" ? `: ${viewer_maps[state.map]}` : "") + (pane.sheet ? "" : " (not kept)");
      this.label(name, is_right ? x + width : x, y, is_right ? "right" : "left", width);
      context.restore();
      if (is_right) {
        context.fillStyle = "#fff";
        context.fillRect(edge - 1, y, 2, height);
        context.fillStyle = "#000";
        context.fillRect(edge + 1, y, 1, height);
      }
    });
    this.tell();
  }

  label(text, x, y, side, most) {
    const { context } = this;
    context.font = "13px system-ui, sans-serif";
    const width = Math.min(context.measureText(text).width + 12, most);
    context.fillStyle = "rgb(0 0 0 / 65%)";
    context.fillRect(side === "left" ? x : x - width, y, width, 22);
    context.fillStyle = "#fff";
    context.textAlign = "left";
    context.fillText(text, (side === "left" ? x : x - width) + 6, y + 15, Math.max(most - 12, 1));
  }

  // Where the cursor is.

  /** The pixel under the cursor, or without one that in the middle. */
  pixel() {
    const { view } = this;
    let { x, y } = view;
    if (this.cursor) {
      const pane = this.rectangles().find((r) => this.cursor.x >= r.x && this.cursor.x < r.x + r.width && this.cursor.y >= r.y && this.cursor.y < r.y + r.height);
      if (!pane) return null;
      x = view.x + (this.cursor.x - pane.x - pane.width / 2) / view.scale;
      y = view.y + (this.cursor.y - pane.y - pane.height / 2) / view.scale;
    }
    const pixel = { x: Math.floor(x), y: Math.floor(y) };
    return pixel.x < 0 || pixel.y < 0 || pixel.x >= this.size.width || pixel.y >= this.size.height ? null : pixel;
  }

  tell() {
    const place = this.place.querySelector(".readout");
    const pixel = this.panes && this.pixel();
    if (!pixel) {
      place.textContent = "";
      return;
    }
    const { region } = this.state, i = pixel.y * this.size.width + pixel.x;
    const [left, top] = region < 0 ? [0, 0] : data.images.crops[region], step = region < 0 ? data.images.reduced : 1;
    const of_pane = (pane) => {
      const rgb = [0, 1, 2].map((c) => digits(pane.image.values[3 * i + c] * data.images.unit)).join(" ");
      const error = this.error_at(pane.image, i);
      const signed = pane.index && Number.isFinite(error) ? `, ${error > 0 ? "+" : ""}${digits(100 * error)} %` : "";
      return `${this.sources[pane.index].name} ${rgb}${signed}${pane.flip ? `, ꟻLIP ${digits(pane.flip.values[i])}` : ""}`;
    };
    const panes = this.panes.filter((pane) => pane.sheet);
    place.textContent = `(${left + pixel.x * step}, ${top + pixel.y * step}) [W/(m² sr)] ${this.cursor ? "" : "in the middle "}· ${panes.map(of_pane).join(" · ")}`;
  }

  // Input.

  zoom(factor, at) {
    const { view } = this, scale = Math.min(Math.max(view.scale * factor, this.fitted / 2), 64);
    if (at) {
      view.x += at.x * (1 / view.scale - 1 / scale);
      view.y += at.y * (1 / view.scale - 1 / scale);
    }
    view.scale = scale;
    this.paint();
  }

  move(x, y) {
    this.view.x += x / this.view.scale;
    this.view.y += y / this.view.scale;
    this.paint();
  }

  /** Where a pointer is, from the middle of its pane. */
  from_middle(e) {
    const { left, top } = this.canvas.getBoundingClientRect(), x = e.clientX - left, y = e.clientY - top;
    const pane = this.rectangles().find((r) => x >= r.x && x <= r.x + r.width && y >= r.y && y <= r.y + r.height) ?? this.rectangles()[0];
    return { x: x - pane.x - pane.width / 2, y: y - pane.y - pane.height / 2 };
  }

  wheel(e) {
    if (!this.size || (document.activeElement !== this.canvas && !e.ctrlKey && !e.metaKey)) return;
    e.preventDefault();
    this.zoom(1.2 ** -Math.sign(e.deltaY), this.from_middle(e));
  }

  pointer_down(e) {
    if (!this.size) return;
    this.canvas.focus({ preventScroll: true });
    this.canvas.setPointerCapture(e.pointerId);
    const x = e.clientX - this.canvas.getBoundingClientRect().left;
    const is_divider = this.state.layout === "slider" && Math.abs(x - this.state.divider * this.canvas.clientWidth) < 16;
    this.pointers.set(e.pointerId, { x: e.clientX, y: e.clientY, is_divider });
  }

  pointer_move(e) {
    if (!this.size) return;
    const { left, top, width } = this.canvas.getBoundingClientRect();
    this.cursor = { x: e.clientX - left, y: e.clientY - top };
    const held = this.pointers.get(e.pointerId);
    if (!held) return this.tell();
    if (held.is_divider) {
      this.state.divider = Math.min(Math.max(this.cursor.x / width, 0), 1);
      this.divider.value = this.state.divider;
      return this.paint();
    }
    const others = [...this.pointers].filter(([id]) => id !== e.pointerId).map(([, pointer]) => pointer);
    if (others.length) {
      const before = Math.hypot(held.x - others[0].x, held.y - others[0].y), now = Math.hypot(e.clientX - others[0].x, e.clientY - others[0].y);
      if (before > 0 && now > 0) this.zoom(now / before);
    } else this.move(held.x - e.clientX, held.y - e.clientY);
    Object.assign(held, { x: e.clientX, y: e.clientY });
  }

  digit_key(e) {
    const digit = /^(?:Digit|Numpad)([1-9])$/.exec(e.code)?.[1];
    if (!digit || e.ctrlKey || e.altKey || e.metaKey || /^(?:INPUT|SELECT|TEXTAREA)$/.test(document.activeElement?.tagName)) return;
    const index = Number(digit) - 1;
    if (index >= this.sources.length) return;
    e.preventDefault();
    if (this.state.layout === "one") this.set({ one: index });
    else this.set(e.shiftKey ? { b: index } : { a: index });
  }

  key(e) {
    if (e.ctrlKey || e.altKey || e.metaKey || !this.size) return;
    const { state } = this, step = 40;
    const next = (values, value) => values[(values.indexOf(value) + 1) % values.length];
    const regions = [...this.form.region.options].map((option) => Number(option.value));
    const actions = {
      ArrowLeft: () => this.move(-step, 0), ArrowRight: () => this.move(step, 0), ArrowUp: () => this.move(0, -step), ArrowDown: () => this.move(0, step),
      "+": () => this.zoom(1.5), "=": () => this.zoom(1.5), "-": () => this.zoom(1 / 1.5), 0: () => this.fit(),
      m: () => this.set({ map: next(Object.keys(viewer_maps), state.map) }),
      l: () => this.set({ layout: next(Object.keys(viewer_layouts), state.layout) }),
      c: () => this.set({ region: next(regions, state.region) }),
      t: () => this.set({ tone: next(Object.keys(tone_maps), state.tone) }),
      e: () => this.set({ stops: Math.min(state.stops + 0.5, 12) }), E: () => this.set({ stops: Math.max(state.stops - 0.5, -12) }), a: () => this.set({ stops: 0 }),
      "[": () => this.set({ divider: Math.max(state.divider - 0.05, 0) }), "]": () => this.set({ divider: Math.min(state.divider + 0.05, 1) }),
    };
    const action = actions[e.key];
    if (!action) return;
    e.preventDefault();
    this.cursor = null;
    action();
  }
}
