// SPDX-License-Identifier: GPL-3.0-or-later
// The report's curves and meshes.
(function () {
  "use strict";
  const data = page.data();
  const $id = (id) => document.getElementById(id);
  const title = (name) => data.titles[name] || name;

  const { css, layout, seen, fill, plotting: config } = page;

  // ---- curves
  const keys = data.curves.keys, columns = data.curves.columns;
  const heading = (name) => data.curves.headings[name] || name;

  function drawCurves() {
    const mesh = $id("curve-mesh").value, degree = $id("curve-degree").value;
    const x = $id("curve-x").value, y = $id("curve-y").value;
    const traces = page.checked("curve-methods").map((method) => {
      const rows = [];
      keys.mesh.forEach((name, i) => {
        if (name === mesh && keys.method[i] === method && keys.degree[i] === degree) rows.push(i);
      });
      const look = data.looks[method], colour = seen(look.colour);
      return { name: title(method), mode: "lines+markers", type: "scatter",
        x: rows.map((i) => columns[x][i]), y: rows.map((i) => columns[y][i]),
        line: { color: colour, dash: look.dash }, marker: { color: colour, symbol: look.symbol, size: 7, maxdisplayed: 40 },
        hovertemplate: "%{y:.6g} at %{x:.6g}<extra>" + title(method) + "</extra>" };
    });
    const axis = (name, box) => page.axis(heading(name), $id(box).checked ? "log" : "linear");
    Plotly.react("curve", traces, layout({ xaxis: axis(x, "log-x"), yaxis: axis(y, "log-y"), showlegend: true }), config);
    $id("curve-meaning").textContent = [x, y].map((name) => data.curves.meanings[name] || "").filter(Boolean).join(" ");
    $id("curve").setAttribute("aria-label", heading(y) + " against " + heading(x) + " on " + title(mesh) +
      " for " + traces.map((t) => t.name).join(", ") + "; the numbers are in the table below");
  }

  function initCurves() {
    const names = Object.keys(columns);
    fill($id("curve-mesh"), data.meshes, title);
    fill($id("curve-degree"), data.degrees.length ? data.degrees : [""]);
    fill($id("curve-x"), names.filter((name) => /iteration$|seconds$/.test(name)), heading);
    fill($id("curve-y"), names, heading);
    $id("curve-x").value = columns.smoothing_seconds ? "smoothing_seconds" : "iteration";
    $id("curve-y").value = ["h1_error", names.find((name) => /\..*error$/.test(name)), "q_mean", "q_min"]
      .find((name) => columns[name]) || names[0];
    page.addBoxes("curve-methods", data.methods.slice(1), title);
    document.querySelectorAll("#curves select, #curves input").forEach((e) => e.addEventListener("change", drawCurves));
    drawCurves();
  }

  // ---- meshes
  const decoded = new Map();
  function numbers(text, Type) {
    if (!decoded.has(text)) {
      const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
      decoded.set(text, new Type(bytes.buffer));
    }
    return decoded.get(text);
  }

  // Red to blue over yellow, as in the figures.
  const scale = [[0, "#a50026"], [0.25, "#f46d43"], [0.5, "#fee090"], [0.75, "#74add1"], [1, "#313695"]];

  function coordinates(view, state) {
    const raw = numbers(state.points, Uint16Array), n = raw.length / 3;
    return [0, 1, 2].map((d) =>
      Float64Array.from({ length: n }, (_, i) => view.lower[d] + (raw[3 * i + d] / 65535) * view.extent));
  }

  function tracesOf(view, part, state, metric, scene, withEdges) {
    const p = coordinates(view, state), triangles = numbers(part.triangles, Uint32Array);
    const cells = numbers(part.cells, Uint32Array), values = numbers(state.values[metric], Uint8Array);
    const corner = (k) => Uint32Array.from({ length: triangles.length / 3 }, (_, i) => triangles[3 * i + k]);
    const traces = [{ type: "mesh3d", scene: scene, x: p[0], y: p[1], z: p[2], i: corner(0), j: corner(1), k: corner(2),
      intensity: Float64Array.from(cells, (c) => values[c] / 255), intensitymode: "cell", cmin: 0, cmax: 1,
      colorscale: scale, showscale: scene === "scene", colorbar: { title: metric, len: 0.9 }, flatshading: true,
      lighting: { ambient: view.planar ? 1 : 0.75, diffuse: view.planar ? 0 : 0.4 }, hoverinfo: "none" }];
    if (withEdges) {
      const edges = numbers(part.edges, Uint32Array), n = edges.length / 2;
      const line = [0, 1, 2].map((d) => {
        const values = new Float64Array(3 * n);
        for (let e = 0; e < n; ++e) {
          values[3 * e] = p[d][edges[2 * e]];
          values[3 * e + 1] = p[d][edges[2 * e + 1]];
          values[3 * e + 2] = NaN;
        }
        return values;
      });
      traces.push({ type: "scatter3d", mode: "lines", scene: scene, x: line[0], y: line[1], z: line[2],
        line: { color: "#333333", width: 1 }, hoverinfo: "skip", showlegend: false });
    }
    const worst = state.worst[metric];
    traces.push({ type: "scatter3d", mode: "markers", scene: scene, x: worst.map((w) => w.at[0]),
      y: worst.map((w) => w.at[1]), z: worst.map((w) => w.at[2]), showlegend: false,
      marker: { size: 5, symbol: "circle-open", color: "#d81b60", line: { width: 2 } },
      text: worst.map((w) => "cell " + w.cell + ": " + w.value.toPrecision(4)), hovertemplate: "%{text}<extra></extra>" });
    return traces;
  }

  function flatBox(view) {
    const most = (values) => values.reduce((a, b) => Math.max(a, b)), least = (values) => values.reduce((a, b) => Math.min(a, b));
    const [x, y] = coordinates(view, view.states.initial).map((values) => most(values) - least(values));
    const size = 1.9 / Math.max(x, y);
    return { x: size * x, y: size * y, z: 0.1 };
  }

  function sceneOf(view, domain) {
    const axis = { visible: false };
    const camera = view.planar
      ? { projection: { type: "orthographic" }, eye: { x: 0, y: 0, z: 2 }, up: { x: 0, y: 1, z: 0 } }
      : { projection: { type: "perspective" }, eye: { x: 1.3, y: -1.3, z: 0.9 }, up: { x: 0, y: 0, z: 1 } };
    // Orthographic cameras see the more the smaller the box is; a flat one by itself would be too large.
    const aspect = view.planar ? { aspectmode: "manual", aspectratio: flatBox(view) } : { aspectmode: "data" };
    return Object.assign({ domain: domain, xaxis: axis, yaxis: axis, zaxis: axis, camera: camera,
      dragmode: view.planar ? "pan" : "turntable", bgcolor: css("--back") }, aspect);
  }

  function drawMeshes() {
    const mesh = $id("view-mesh").value, view = data.views[mesh];
    if (!view) return;
    const chosen = $id("view-method").value;
    fill($id("view-part"), Object.keys(view.parts));
    fill($id("view-method"), Object.keys(view.states).filter((name) => name !== "initial"), title);
    if (!chosen) $id("view-method").selectedIndex = $id("view-method").length - 1;
    fill($id("view-metric"), Object.keys(view.states.initial.values));
    const part = view.parts[$id("view-part").value], metric = $id("view-metric").value;
    const method = $id("view-method").value, withEdges = $id("view-edges").checked;
    const shown = ["initial"].concat(method ? [method] : []);
    const narrow = $id("view").clientWidth < 700;
    const traces = [], scenes = {}, notes = [];
    shown.forEach((name, k) => {
      const scene = k ? "scene2" : "scene";
      traces.push(...tracesOf(view, part, view.states[name], metric, scene, withEdges));
      const half = [k / 2, (k + 1) / 2];
      const domain = narrow ? { x: [0, 1], y: [1 - half[1], 1 - half[0]] } : { x: half, y: [0, 1] };
      scenes[scene] = sceneOf(view, domain);
      notes.push({ text: title(name), showarrow: false, xref: "paper", yref: "paper", xanchor: "left", yanchor: "top",
        x: domain.x[0], y: domain.y[1], bgcolor: css("--back") });
    });
    Plotly.react("view", traces, layout(Object.assign({ margin: { l: 0, r: 0, t: 0, b: 0 }, annotations: notes }, scenes)),
      config).then(linkCameras);
    drawWorst(view, shown, metric);
  }

  // Both meshes are seen from the same side.
  let linked = false;
  function linkCameras() {
    if (linked) return;
    linked = true;
    let busy = false;
    $id("view").on("plotly_relayout", (change) => {
      if (busy) return;
      const moved = ["scene", "scene2"].find((scene) => change[scene + ".camera"]);
      if (!moved) return;
      busy = true;
      const other = moved === "scene" ? "scene2" : "scene";
      Plotly.relayout("view", { [other + ".camera"]: change[moved + ".camera"] }).finally(() => { busy = false; });
    });
  }

  function drawWorst(view, shown, metric) {
    const tables = shown.map((name) => {
      const table = document.createElement("table");
      table.createCaption().textContent = "Worst cells by " + metric + ", " + title(name);
      const head = table.createTHead().insertRow();
      ["cell", metric, "x", "y", "z"].forEach((text) => {
        const th = document.createElement("th");
        th.scope = "col";
        th.textContent = text;
        head.append(th);
      });
      const body = table.createTBody();
      view.states[name].worst[metric].forEach((w) => {
        const row = body.insertRow();
        [String(w.cell), w.value.toPrecision(4), ...w.at.map((x) => x.toPrecision(5))].forEach((text) => {
          const cell = row.insertCell();
          cell.className = "number";
          cell.textContent = text;
        });
      });
      return table;
    });
    const pair = document.createElement("div");
    pair.className = "pair";
    pair.append(...tables);
    $id("worst").replaceChildren(pair);
  }

  function initMeshes() {
    const names = Object.keys(data.views);
    $id("no-meshes").hidden = names.length > 0;
    if (!names.length) {
      document.querySelectorAll("#meshes .controls, #view").forEach((e) => { e.hidden = true; });
      return;
    }
    fill($id("view-mesh"), names, title);
    document.querySelectorAll("#meshes select, #meshes input").forEach((e) => e.addEventListener("change", drawMeshes));
    page.whenSeen($id("view"), drawMeshes);
  }

  page.redraw = () => {
    drawCurves();
    if (decoded.size) drawMeshes();
  };

  initCurves();
  initMeshes();
})();
