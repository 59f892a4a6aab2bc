// Puts the parts together: what is chosen in the chart is shown everywhere.

for (const part of document.querySelectorAll(".scripted")) part.classList.remove("scripted");

const viewer = new Viewer(document.getElementById("viewer"));
let marked = [];

/** Two runs are compared; a third takes the place of the one chosen first. */
function choose(run) {
  show_details(run);
  marked = marked.includes(run) ? marked.filter((other) => other !== run) : [...marked, run].slice(-2);
  chart.mark(marked);
  show_pair(marked);
  show_stages(marked);
  viewer.choose(marked);
}

const chart = new Chart({ focus: show_details, choose });
show_stages();
show_along();
show_tables();
