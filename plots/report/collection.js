// SPDX-License-Identifier: GPL-3.0-or-later
// The plots of a collection's report.
(function () {
  "use strict";
  const data = page.data(), $id = (id) => document.getElementById(id);
  const heading = (name) => data.headings[name];
  const scale = (box) => ($id(box).checked ? "log" : "linear");

  // ---- curves of methods
  function tracesOf(curve, isShare) {
    const look = data.looks[curve.method], colour = page.seen(look.colour), name = data.titles[curve.method];
    const line = { name: name, x: curve.x, y: curve.y, type: "scatter", mode: "lines+markers", legendgroup: name,
      line: { color: colour, dash: look.dash, shape: isShare ? "hv" : "linear" },
      marker: { color: colour, symbol: look.symbol, size: 7, maxdisplayed: 8 },
      hovertemplate: "%{y:.4g} at %{x:.4g}<extra>" + name + "</extra>" };
    if (!curve.lower) return [line];
    const band = { name: name + ", quartiles", x: curve.x.concat([...curve.x].reverse()), type: "scatter", mode: "lines",
      y: curve.upper.concat([...curve.lower].reverse()), fill: "toself", line: { width: 0, color: colour }, opacity: 0.15,
      legendgroup: name, showlegend: false, hoverinfo: "skip" };
    return [band, line];
  }

  function drawDiagram() {
    const diagram = data.diagrams.find((d) => d.name === $id("diagram-name").value);
    if (!diagram) return;
    const methods = page.checked("diagram-methods");
    const shown = diagram.curves.filter((curve) => methods.includes(curve.method));
    Plotly.react("diagram", shown.flatMap((curve) => tracesOf(curve, diagram.is_share)), page.layout({
      xaxis: page.axis(diagram.x, scale("diagram-log-x")), yaxis: page.axis(diagram.y, scale("diagram-log-y")),
      showlegend: true }), page.plotting);
    $id("diagram").setAttribute("aria-label", diagram.title + ": " + diagram.y + " against " + diagram.x + " for " +
      shown.map((curve) => data.titles[curve.method]).join(", "));
  }

  // ---- correlations and records
  const kind = () => data.kinds[$id("kind").selectedIndex];

  // Red over white to blue, as in the figures.
  const colours = [[0, "#67001f"], [0.25, "#e58368"], [0.5, "#f7f7f7"], [0.75, "#6bacd0"], [1, "#053061"]];

  function drawCorrelations() {
    const known = data.qualities.map((_, row) => row).filter((row) => kind().rho[row].some((rho) => rho !== null));
    const qualities = known.map((row) => data.qualities[row]), rho = known.map((row) => kind().rho[row]);
    const words = rho.flatMap((row, i) => row.map((value, j) => ({ x: j, y: i, showarrow: false,
      text: value === null ? "" : value.toFixed(2),
      font: { size: 10, color: Math.abs(value) > 0.6 ? "#ffffff" : "#000000" } })));
    const axis = (names) => ({ tickvals: names.map((_, i) => i), ticktext: names.map(heading), tickfont: { size: 11 },
      showgrid: false, zeroline: false });
    Plotly.react("correlations", [{ type: "heatmap", z: rho, zmin: -1, zmax: 1, colorscale: colours, xgap: 1, ygap: 1,
      text: qualities.map((quality) => data.outcomes.map((outcome) => heading(quality) + ", " + heading(outcome))),
      customdata: qualities.map((quality) => data.outcomes.map((outcome) => [quality, outcome])),
      hovertemplate: "%{text}: %{z:.3f}<extra></extra>", colorbar: { thickness: 10 } }],
    page.layout({ margin: { l: 170, r: 10, t: 30, b: 60 }, annotations: words, xaxis: axis(data.outcomes),
      yaxis: Object.assign(axis(qualities), { autorange: "reversed" }) }), page.plotting);
    $id("correlations").setAttribute("aria-label", "Rank correlations of qualities and outcomes, " + kind().name +
      "; the numbers are in the table table_prediction");
  }

  function drawRecords() {
    const quality = $id("quality").value, outcome = $id("outcome").value;
    const words = heading(outcome) + " / least of the member";
    Plotly.react("records", [{ type: "scatter", mode: "markers", x: kind().qualities[quality], y: kind().relative[outcome],
      text: kind().members, marker: { size: 4, opacity: 0.6, color: page.css("--accent") },
      hovertemplate: "%{text}<br>%{y:.4g} at %{x:.4g}<extra></extra>" }], page.layout({
      xaxis: page.axis(heading(quality), scale("records-log-x")), yaxis: page.axis(words, scale("records-log-y")) }),
    page.plotting);
    $id("records").setAttribute("aria-label", words + " against " + heading(quality) + ", " + kind().name);
  }

  let clickable = false;
  function drawPrediction() {
    drawCorrelations();
    drawRecords();
    if (clickable) return;
    clickable = true;
    $id("correlations").on("plotly_click", (event) => {
      [$id("quality").value, $id("outcome").value] = event.points[0].customdata;
      drawRecords();
    });
  }

  function onChange(ids, draw) {
    ids.forEach((id) => $id(id).addEventListener("change", draw));
  }

  page.fill($id("diagram-name"), data.diagrams.map((d) => d.name), (name) => data.diagrams.find((d) => d.name === name).title);
  page.addBoxes("diagram-methods", Object.keys(data.titles), (name) => data.titles[name]);
  page.fill($id("kind"), data.kinds.map((k) => k.name));
  page.fill($id("quality"), data.qualities, heading);
  page.fill($id("outcome"), data.outcomes, heading);
  if (data.outcomes.includes("h1_error")) $id("outcome").value = "h1_error";
  onChange(["diagram-name", "diagram-log-x", "diagram-log-y", "diagram-methods"], drawDiagram);
  onChange(["kind", "quality", "outcome", "records-log-x", "records-log-y"], drawPrediction);
  page.whenSeen($id("diagram"), drawDiagram);
  page.whenSeen($id("correlations"), drawPrediction);
  page.redraw = () => {
    drawDiagram();
    drawPrediction();
  };
})();
