// Time and error of each frame of a path.

function along_svg(column, heading, scale, width) {
  const runs = data.runs.filter((run) => run.along?.[column]?.some((value) => value !== null)).slice(0, 24);
  if (!runs.length) return "";
  const of_theme = theme();
  const height = 190, left = 52, right = 10, top = 26, bottom = 24;
  const frames = Math.max(...runs.map((run) => run.along[column].length));
  const most = Math.max(...runs.flatMap((run) => run.along[column].filter((value) => value !== null))) * scale || 1;
  const at_x = (i) => left + ((width - left - right) * i) / Math.max(frames - 1, 1);
  const at_y = (value) => height - bottom - ((height - top - bottom) * value * scale) / most;
  let lines = "";
  for (const run of runs) {
    let path = "", is_open = false;
    run.along[column].forEach((value, i) => {
      if (value !== null) path += `${is_open ? "L" : "M"}${at_x(i).toFixed(1)} ${at_y(value).toFixed(1)}`;
      is_open = value !== null;
    });
    lines += `<path d="${path}" fill="none" stroke="${colour_of(run, of_theme)}" stroke-width="1.5"><title>${escaped(name_of(run))}</title></path>`;
  }
  return (
    `<svg viewBox="0 0 ${width} ${height}" width="${width}" height="${height}" font-size="12" fill="${of_theme.faint}" role="img" aria-label="${escaped(heading)} of each frame of the path">` +
    `<text x="${left}" y="16" fill="${of_theme.ink}">${escaped(heading)}</text><rect x="${left}" y="${top}" width="${width - left - right}" height="${height - top - bottom}" fill="none" stroke="${of_theme.grid}"/>` +
    `<text x="${left - 6}" y="${top + 9}" text-anchor="end">${digits(most)}</text><text x="${left - 6}" y="${height - bottom}" text-anchor="end">0</text>` +
    `<text x="${left}" y="${height - 7}">frame 0</text><text x="${width - right}" y="${height - 7}" text-anchor="end">${frames - 1}</text>${lines}</svg>`
  );
}

function show_along() {
  const place = document.getElementById("along");
  if (!place) return;
  const draw = () => {
    const width = Math.min(560, Math.max(280, place.clientWidth));
    place.innerHTML =
      along_svg("frame_ms", "frame [ms]", 1, width) +
      along_svg("same_surface_rrmse", "same-surface rrmse [%]", 100, width) +
      along_svg("flicker", "flicker [%]", 100, width) +
      `<p class="legend">${method_names.map((name) => `<span><i style="background:${colour_of(data.runs.find((run) => run.method === name), theme())}"></i>${escaped(name)}</span>`).join(" ")}</p>`;
  };
  is_dark.addEventListener("change", draw);
  window.addEventListener("resize", draw);
  draw();
}
