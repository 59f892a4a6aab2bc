// Tables that sort, are kept as CSV, and on a phone become a card a row. All stand in the page without this.

function cell_value(cell) {
  return cell.dataset.value === undefined ? cell.textContent : Number(cell.dataset.value);
}

function sort_table(table, column, is_ascending) {
  const body = table.tBodies[0];
  const order = (a, b) => {
    const x = cell_value(a.cells[column]), y = cell_value(b.cells[column]);
    // Words, as "dark", come after numbers, whichever way.
    if (typeof x !== typeof y) return typeof x === "number" ? -1 : 1;
    const difference = typeof x === "number" ? x - y : x.localeCompare(y, undefined, { numeric: true });
    return is_ascending ? difference : -difference;
  };
  body.append(...[...body.rows].sort(order));
  [...table.tHead.rows[0].cells].forEach((head, i) => head.setAttribute("aria-sort", i !== column ? "none" : is_ascending ? "ascending" : "descending"));
}

function csv_of(table) {
  const quoted = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
  const headings = [...table.tHead.rows[0].cells].map((head) => head.textContent.trim());
  const rows = [...table.tBodies[0].rows].map((row) => [...row.cells].map((cell) => cell.dataset.value ?? cell.textContent));
  return [headings, ...rows].map((row) => row.map(quoted).join(",")).join("\n") + "\n";
}

function enliven(table) {
  const heads = [...table.tHead.rows[0].cells];
  heads.forEach((head, column) => {
    const text = head.textContent;
    head.innerHTML = `<button type="button">${head.innerHTML}</button>`;
    head.setAttribute("aria-sort", "none");
    head.firstChild.addEventListener("click", () => sort_table(table, column, head.getAttribute("aria-sort") !== "ascending"));
    // What stands before the value where a row is a card.
    for (const row of table.tBodies[0].rows) row.cells[column].dataset.label = text;
  });
  for (const [selector, role] of [["thead, tbody", "rowgroup"], ["tr", "row"], ["tbody td", "cell"], ["tbody th", "rowheader"], ["thead th", "columnheader"]])
    for (const element of table.querySelectorAll(selector)) element.setAttribute("role", role);
  table.setAttribute("role", "table");
  table.classList.add("lively");
  const button = document.createElement("button");
  button.type = "button";
  button.textContent = "Save as CSV";
  button.setAttribute("aria-label", `Save the table ${table.id} as CSV`);
  button.addEventListener("click", () => save(`${file_name(table.id)}.csv`, "text/csv", csv_of(table)));
  table.after(button);
}

function show_tables() {
  for (const table of document.querySelectorAll("table.figures")) enliven(table);
}
