// SPDX-License-Identifier: GPL-3.0-or-later
// What pages share: light or dark, tables to sort and filter, links to the sections that are there, the look of plots.
const page = (function () {
  "use strict";

  // ---- theme
  const isDark = () => {
    const chosen = document.documentElement.dataset.theme;
    return chosen ? chosen === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
  };
  const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

  // ---- tables
  function makeSortable(table) {
    const filtered = table.dataset.filters.split(" ").filter(Boolean).map(Number);
    const shown = jQuery(table).DataTable({ paging: false, order: [], orderCellsTop: true,
      language: { search: "Filter the rows:" } });
    filtered.forEach((column) => {
      const header = shown.column(column).header(), select = document.createElement("select");
      select.setAttribute("aria-label", "Only rows with this " + header.textContent);
      const texts = [...new Set(shown.column(column).nodes().toArray().map((cell) => cell.textContent))].sort();
      select.append(new Option("all", ""), ...texts.map((text) => new Option(text, text)));
      select.addEventListener("click", (event) => event.stopPropagation());
      select.addEventListener("change", () => shown.column(column).search(
        select.value ? "^" + jQuery.fn.dataTable.util.escapeRegex(select.value) + "$" : "", true, false).draw());
      header.append(select);
    });
  }

  // Says above a table how many of its columns are beyond the right edge.
  function hint(region) {
    const words = region.previousElementSibling;
    const update = () => {
      const edge = region.getBoundingClientRect().right, headers = [...region.querySelectorAll("th")];
      const beyond = headers.filter((th) => th.getBoundingClientRect().left > edge - 20).length;
      words.hidden = beyond === 0;
      words.textContent = beyond + " of " + headers.length + " columns are further to the right: scroll the table \u2192";
    };
    const watch = new ResizeObserver(update);
    watch.observe(region);
    watch.observe(region.querySelector("table"));
    region.addEventListener("scroll", update);
  }

  // ---- plots
  const layout = (more) => Object.assign({
    paper_bgcolor: css("--back"), plot_bgcolor: css("--back"), font: { color: css("--text") },
    margin: { l: 70, r: 15, t: 30, b: 50 },
    legend: { orientation: "h", y: innerWidth < 700 ? -0.45 : -0.2, yanchor: "top" } }, more);
  const axis = (words, type) => ({ title: words, type: type, gridcolor: css("--faint"), zeroline: false,
    exponentformat: "power" });
  // Dark lines would not be seen on dark ground: they are mixed with white.
  function seen(colour) {
    const parts = [1, 3, 5].map((k) => parseInt(colour.slice(k, k + 2), 16));
    if (!isDark() || !(0.3 * parts[0] + 0.6 * parts[1] + 0.1 * parts[2] < 90)) return colour;
    const share = colour === "#000000" ? 1 : 0.45;
    return "#" + parts.map((part) => Math.round(part + share * (255 - part)).toString(16).padStart(2, "0")).join("");
  }

  // What takes a moment is drawn when it is about to be seen, or printed.
  function whenSeen(element, draw) {
    const drawOnce = () => {
      watch.disconnect();
      removeEventListener("beforeprint", drawOnce);
      draw();
    };
    const watch = new IntersectionObserver((entries) => {
      if (entries.some((entry) => entry.isIntersecting)) drawOnce();
    }, { rootMargin: "300px" });
    watch.observe(element);
    addEventListener("beforeprint", drawOnce);
  }

  // ---- what can be chosen
  function fill(select, names, words) {
    const before = select.value;
    select.replaceChildren(...names.map((name) => new Option(words ? words(name) : name, name)));
    if (names.includes(before)) select.value = before;
  }
  function addBoxes(id, names, words) {
    names.forEach((name) => {
      const label = document.createElement("label"), box = document.createElement("input");
      Object.assign(box, { type: "checkbox", value: name, checked: true });
      label.append(box, " " + words(name));
      document.getElementById(id).append(label);
    });
  }
  const checked = (id) => [...document.querySelectorAll("#" + id + " input:checked")].map((box) => box.value);

  // redraw: what follows the colours; ready: when everything else is there.
  const shared = { isDark: isDark, css: css, layout: layout, axis: axis, seen: seen, fill: fill, addBoxes: addBoxes,
    checked: checked, whenSeen: whenSeen, plotting: { responsive: true, displaylogo: false, toImageButtonOptions: { format: "svg" } },
    data: () => JSON.parse(document.getElementById("data").textContent), redraw: () => {}, ready: () => {
      document.querySelectorAll("table.sortable").forEach((table) => whenSeen(table, () => makeSortable(table)));
      document.querySelectorAll(".scroll").forEach(hint);
      document.documentElement.dataset.ready = "yes";
    } };
  document.getElementById("theme").addEventListener("click", () => {
    document.documentElement.dataset.theme = isDark() ? "light" : "dark";
    document.getElementById("theme").setAttribute("aria-pressed", String(isDark()));
    shared.redraw();
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => shared.redraw());
  document.querySelectorAll("nav a").forEach((a) => { a.hidden = !document.querySelector(a.getAttribute("href")); });
  return shared;
})();
